//! The linearisation of a case about a state.

use crate::case::Case;
use crate::dae::{BeamDae, Dae as _, EvaluationError, Seeds};
use crate::discrete::{System, start};
use crate::error::{At, Code, Error, Result, SolverError};
use crate::functions::signals::Clock;
use crate::integrate::{StartOptions, consistent_start};
use crate::model::Model;
use crate::run::equilibrium::{self, Options};
use crate::spectral::Pencil;

/// What the fluid does in the linearised equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fluid {
    /// It flows.
    Flowing,
    /// It does not: every bladder keeps its volume (undrained, μ → ∞).
    Sealed,
    /// It flows without resistance: what is joined has one pressure (drained, μ → 0).
    Free,
}

/// Factor of the flows that stands for none of their resistance: the pressure differences left are its inverse.
const FREE: f64 = 1e6;

/// `[E31]` Small motions about a state at rest, of the scaled unknowns, with all signals held:
///
/// ```text
/// F(t, y + δy, δy') = 0        A = ∂F/∂y, B = ∂F/∂y'        δy = x e^{s t}        (A + s B) x = 0
/// f = Im s/2π        ζ = -Re s/|s|        growth Re s        time constant -1/s, s real
/// ```
pub struct Linearised {
    /// The equations.
    pub dae: BeamDae,
    /// Instant at which signals are held [s].
    pub at: f64,
    /// Scaled unknowns, velocities zero.
    pub y: Vec<f64>,
    /// Entries of A in the order of the pattern.
    pub a: Vec<f64>,
    /// Entries of B.
    pub b: Vec<f64>,
    /// Largest rate with which the state would change, each unknown over its characteristic size [1/s]: 0 at an equilibrium.
    pub rate: f64,
}

/// Linearises everything that a case describes, with signals held at `at` [s], about `state` (scaled unknowns of
/// `System::with(case, Model::of_modes(case))`, velocities zero) or about the start, which may be an equilibrium under
/// loads of another instant.
///
/// # Errors
/// [`Error::Solver`] when there are no consistent pressures, or derivatives are not finite.
pub fn linearise(case: &Case, at: f64, state: Option<&[f64]>) -> Result<Linearised> {
    if let (None, Some(start)) = (state, &case.start.equilibrium) {
        return about_equilibrium(case, &Options::of_start(start));
    }
    let mut dae = held(case, at)?;
    let (system, now) = dae.instant(at);
    let y = state.map_or_else(|| start::state(system, case, now), <[f64]>::to_vec);
    about(dae, at, y)
}

/// Linearises everything that a case describes about the equilibrium under the loads at an instant [s].
///
/// # Errors
/// As [`linearise`], and [`Error::Solver`] when there is no equilibrium.
pub fn at_equilibrium(case: &Case, at: f64) -> Result<Linearised> {
    about_equilibrium(case, &Options::at(at))
}

fn about_equilibrium(case: &Case, options: &Options) -> Result<Linearised> {
    let at = options.at_s;
    let mut dae = held(case, at)?;
    let at_rest = vec![0.0; dae.len()];
    let y = equilibrium::at_start(case, options, &mut dae, &at_rest).map_err(|mut fault| {
        fault.at = At::Time(at);
        Error::Solver(Box::new(fault))
    })?;
    about(dae, at, y)
}

/// Everything that a case describes, signals held at an instant [s].
fn held(case: &Case, at: f64) -> Result<BeamDae> {
    let mut model = Model::of_modes(case)?;
    model.freeze(at);
    let mut dae = BeamDae::new(System::with(case, model)?);
    dae.enter_smooth_interval(at);
    Ok(dae)
}

fn about(mut dae: BeamDae, at: f64, mut y: Vec<f64>) -> Result<Linearised> {
    let l = dae.system().layout.clone();
    for velocity in l.velocities() {
        y[velocity] = 0.0;
    }
    let mut yp = vec![0.0; l.len];
    let fault = |what: String, unknown| {
        Error::Solver(Box::new(SolverError {
            code: Code::NoStart,
            at: At::Time(at),
            what,
            unknown,
            cause: None,
            hint: None,
        }))
    };
    consistent_start(&mut dae, at, &mut y, &mut yp, &StartOptions::default())
        .map_err(|f| fault(f.to_string(), f.worst.clone().map(|w| w.1)))?;
    let rate = yp.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    yp.fill(0.0);
    let (ones, zeros) = (vec![1.0; l.len], vec![0.0; l.len]);
    let entries = dae.pattern().entries();
    let mut parts = [vec![0.0; entries], vec![0.0; entries]];
    for (values, (of_y, of_yp)) in parts.iter_mut().zip([(&ones, &zeros), (&zeros, &ones)]) {
        let seeds = Seeds::Columns { y: of_y, yp: of_yp };
        dae.jacobian(at, &y, &yp, seeds, values)
            .map_err(|(EvaluationError::Recoverable(what) | EvaluationError::Fatal(what))| fault(what, None))?;
    }
    let [a, b] = parts;
    Ok(Linearised { dae, at, y, a, b, rate })
}

impl Linearised {
    /// The system.
    pub fn system(&self) -> &System {
        self.dae.system()
    }

    /// A and B.
    pub fn pencil(&self) -> Pencil<'_> {
        Pencil {
            pattern: self.dae.pattern(),
            a: &self.a,
            b: &self.b,
        }
    }

    /// Angular frequency by which those of the beam are measured, `√(EI/(m l_s⁴))` [1/s].
    pub fn frequency(&self) -> f64 {
        let model = &self.system().model;
        let section = &model.section;
        (section.bending_stiffness / section.mass_per_length).sqrt() / model.length.powi(2)
    }

    /// Entries of A and B with another behaviour of the fluid. The rows of storage, `Δs a' - inflow`, become `a = 0` where
    /// nothing flows, and have their flows multiplied where nothing resists; so it needs no second model, whatever valves
    /// and turbines there are.
    pub fn with(&self, fluid: Fluid) -> (Vec<f64>, Vec<f64>) {
        let (mut a, mut b) = (self.a.clone(), self.b.clone());
        let (pattern, l) = (self.dae.pattern(), &self.system().layout);
        let storage = l.network.area.clone();
        for column in 0..pattern.columns() {
            for entry in pattern.column(column) {
                let row = pattern.rows[entry] as usize;
                match fluid {
                    Fluid::Flowing => {}
                    _ if !storage.contains(&row) => {}
                    Fluid::Sealed => (a[entry], b[entry]) = (f64::from(u8::from(row == column)), 0.0),
                    Fluid::Free => a[entry] *= FREE,
                }
            }
        }
        (a, b)
    }

    /// Whether there are flows that could be held or freed.
    pub fn flows(&self) -> bool {
        !self.system().layout.network.area.is_empty()
    }

    /// Whether the state would change noticeably in the time of the beam. An equilibrium as Newton's iteration leaves it has
    /// rates of a few thousandths: what is left of forces acts on stiff axial waves, which hardly move for it.
    pub fn moving(&self) -> bool {
        self.rate > 1e-2 * self.frequency()
    }

    /// The clock of the linearisation.
    pub fn clock(&self) -> Clock {
        Clock {
            t: self.at,
            within: self.at,
        }
    }
}
