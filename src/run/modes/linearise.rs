//! Linearization of a case about a state.

use crate::case::Case;
use crate::dae::{BeamDae, Dae as _, EvaluationError, Seeds};
use crate::discrete::{System, start};
use crate::error::{Code, Error, Result, SolverError, StopPoint};
use crate::functions::signals::SmoothTime;
use crate::integrate::{StartOptions, consistent_start};
use crate::model::Model;
use crate::run::equilibrium::{self, EquilibriumOptions};
use crate::run::state_range::StateRange;
use crate::spectral::Pencil;

/// Behavior of the fluid in the linearized equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FluidBehavior {
    /// The fluid flows.
    Flowing,
    /// The fluid does not flow: every bladder keeps its volume (undrained, μ → ∞).
    Sealed,
    /// The fluid flows without resistance: connected parts have one pressure (drained, μ → 0).
    Free,
}

/// Factor of the flows that represents zero resistance; the remaining pressure differences are its inverse.
const FREE: f64 = 1e6;

/// `[E31]` Small motions of the scaled unknowns about a state at rest, with constant signals:
///
/// ```text
/// F(t, y + δy, δy') = 0        A = ∂F/∂y, B = ∂F/∂y'        δy = x e^{s t}        (A + s B) x = 0
/// f = Im s/2π        ζ = -Re s/|s|        growth Re s        time constant -1/s, s real
/// ```
pub struct Linearised {
    /// The equations.
    pub dae: BeamDae,
    /// Instant whose signals are used [s].
    pub at: f64,
    /// Scaled unknowns, velocities zero.
    pub y: Vec<f64>,
    /// Entries of A in the order of the pattern.
    pub a: Vec<f64>,
    /// Entries of B.
    pub b: Vec<f64>,
    /// Largest rate of change of the state, each unknown over its characteristic size [1/s]; 0 at an equilibrium.
    pub rate: f64,
    /// Warnings that the state is outside the range of the model.
    pub range: Vec<String>,
}

/// Linearizes the full case, with constant signals of the instant `at` [s]. The state is `state` (scaled unknowns of
/// `System::with(case, Model::of_modes(case))`, velocities zero). Without it, the state is the start, which may be an equilibrium
/// under loads of another instant.
///
/// # Errors
/// [`Error::Solver`] if there are no consistent pressures, or if derivatives are not finite.
pub fn linearise(case: &Case, at: f64, state: Option<&[f64]>) -> Result<Linearised> {
    if let (None, Some(start)) = (state, &case.start.equilibrium) {
        return about_equilibrium(case, &EquilibriumOptions::of_start(start));
    }
    let mut dae = held(case, at)?;
    let (system, now) = dae.instant(at);
    let y = state.map_or_else(|| start::state(system, case, now), <[f64]>::to_vec);
    about(case, dae, y, at, false)
}

/// Linearizes the full case about the equilibrium under the loads at an instant [s].
///
/// # Errors
/// As [`linearise`], and [`Error::Solver`] if there is no equilibrium.
pub fn at_equilibrium(case: &Case, at: f64) -> Result<Linearised> {
    about_equilibrium(case, &EquilibriumOptions::at(at))
}

fn about_equilibrium(case: &Case, options: &EquilibriumOptions) -> Result<Linearised> {
    let at = options.at_s;
    let mut dae = held(case, at)?;
    let at_rest = vec![0.0; dae.len()];
    let y = equilibrium::at_start(case, options, &mut dae, &at_rest).map_err(|mut fault| {
        fault.at = StopPoint::Time(at);
        Error::Solver(Box::new(fault))
    })?;
    about(case, dae, y, at, true)
}

/// Equations of the full case, with constant signals of an instant [s].
fn held(case: &Case, at: f64) -> Result<BeamDae> {
    let mut model = Model::of_modes(case)?;
    model.freeze(at);
    let mut dae = BeamDae::new(System::with(case, model)?);
    dae.enter_smooth_interval(at);
    Ok(dae)
}

fn about(case: &Case, mut dae: BeamDae, mut y: Vec<f64>, at: f64, settled: bool) -> Result<Linearised> {
    let l = dae.system().layout.clone();
    for velocity in l.velocities() {
        y[velocity] = 0.0;
    }
    let mut yp = vec![0.0; l.len];
    let fault = |what: String, unknown| {
        Error::Solver(Box::new(SolverError {
            code: Code::NoStart,
            at: StopPoint::Time(at),
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
    let mut range = StateRange::new(case, dae.system(), settled);
    range.add(&mut dae, at, &y);
    let (ones, zeros) = (vec![1.0; l.len], vec![0.0; l.len]);
    let entries = dae.pattern().entries();
    let mut parts = [vec![0.0; entries], vec![0.0; entries]];
    for (values, (of_y, of_yp)) in parts.iter_mut().zip([(&ones, &zeros), (&zeros, &ones)]) {
        let seeds = Seeds::Columns { y: of_y, yp: of_yp };
        dae.jacobian(at, &y, &yp, seeds, values)
            .map_err(|(EvaluationError::Recoverable(what) | EvaluationError::Fatal(what))| fault(what, None))?;
    }
    let [a, b] = parts;
    Ok(Linearised {
        dae,
        at,
        y,
        a,
        b,
        rate,
        range: range.warnings(),
    })
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

    /// Reference for angular frequencies of the beam, `√(EI/(m l_s⁴))` [1/s].
    pub fn frequency(&self) -> f64 {
        let model = &self.system().model;
        let section = &model.section;
        (section.bending_stiffness / section.mass_per_length).sqrt() / model.length.powi(2)
    }

    /// Entries of A and B with another behavior of the fluid. The rows of storage, `Δs a' - inflow`, become `a = 0` if the fluid is
    /// sealed; their flows are multiplied by a factor if it is free. No second model is needed, whatever valves and turbines there are.
    pub fn with(&self, fluid: FluidBehavior) -> (Vec<f64>, Vec<f64>) {
        let (mut a, mut b) = (self.a.clone(), self.b.clone());
        let (pattern, l) = (self.dae.pattern(), &self.system().layout);
        let storage = l.network.area.clone();
        for column in 0..pattern.columns() {
            for entry in pattern.column(column) {
                let row = pattern.rows[entry] as usize;
                match fluid {
                    FluidBehavior::Flowing => {}
                    _ if !storage.contains(&row) => {}
                    FluidBehavior::Sealed => (a[entry], b[entry]) = (f64::from(u8::from(row == column)), 0.0),
                    FluidBehavior::Free => a[entry] *= FREE,
                }
            }
        }
        (a, b)
    }

    /// True if there are flows that can be sealed or freed.
    pub fn flows(&self) -> bool {
        !self.system().layout.network.area.is_empty()
    }

    /// True if the state changes noticeably in the characteristic time of the beam. An equilibrium from Newton's iteration
    /// has rates of a
    /// few thousandths: residual forces act on stiff axial waves, which hardly move.
    pub fn moving(&self) -> bool {
        self.rate > 1e-2 * self.frequency()
    }

    /// Clock of the linearization.
    pub fn clock(&self) -> SmoothTime {
        SmoothTime {
            t: self.at,
            within: self.at,
        }
    }
}
