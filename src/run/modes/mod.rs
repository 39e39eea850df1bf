//! Modes: frequencies, damping, shapes and growth of small motions about a state.
//!
//! ```text
//! linearise   the pencil of a case about a state, with the fluid as it is, held, or free
//! shape       displacements and pressures of an eigenvector; likeness of two
//! sensitivity  derivatives by numbers of the case
//! kind        oscillation, decay, growth, rigid motion, kept volume
//! ```

pub mod kind;
pub mod linearise;
pub mod sensitivity;
pub mod shape;

use nalgebra::Complex;

use crate::case::Case;
use crate::error::{Code, Error, Result, SolverFault};
use crate::spectral::{self, Failure, Options, Pair, Pencil};

pub use kind::Kind;
pub use linearise::{Fluid, Linearised, at_equilibrium, linearise};
pub use sensitivity::{Sensitivity, differentiate};
pub use shape::{Shape, Shapes, likeness};

/// What is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// Modes, those with s = 0 not counted.
    pub count: usize,
    /// Frequency near which they are looked for [Hz].
    pub near_hz: f64,
    /// Whether the fluid is held and freed too.
    pub limits: bool,
}

/// The same mode with the fluid held or free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// Frequency [Hz].
    pub frequency_hz: f64,
    /// Likeness of the shapes, [E33].
    pub likeness: f64,
}

/// One mode; of a pair of conjugates that with positive frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// What it does.
    pub kind: Kind,
    /// s [1/s], without what is round-off.
    pub s: Complex<f64>,
    /// Bound of its error, to first order [1/s].
    pub error: f64,
    /// Backward error of the pair.
    pub residual: f64,
    /// What it looks like.
    pub shape: Shape,
    /// With every bladder sealed.
    pub undrained: Option<Limit>,
    /// With networks of one pressure.
    pub drained: Option<Limit>,
    /// On a mesh of half the cells.
    pub coarse: Option<Limit>,
}

impl Mode {
    /// Frequency [Hz]; None where nothing swings.
    pub fn frequency_hz(&self) -> Option<f64> {
        self.kind.swings().then(|| self.s.im / std::f64::consts::TAU)
    }

    /// `[E45]` What halving the cells says of the mesh (Richardson, second order): the frequency to which the two point [Hz],
    ///
    /// ```text
    /// f(h) = f + c h² + ..        f ≈ f(h) + (f(h) - f(2h))/3
    /// ```
    ///
    /// None where nothing swings or the coarser mesh has no such mode.
    pub fn extrapolated_hz(&self) -> Option<f64> {
        let (fine, coarse) = (self.frequency_hz()?, self.coarse?.frequency_hz);
        Some(fine + (fine - coarse) / 3.0)
    }

    /// Error that the mesh makes of the frequency, relative to it, as [`Mode::extrapolated_hz`] has it.
    pub fn mesh_error(&self) -> Option<f64> {
        let fine = self.frequency_hz()?;
        Some((self.extrapolated_hz()? - fine).abs() / fine)
    }

    /// Damping ratio, negative where the mode grows; None where nothing swings.
    pub fn damping_ratio(&self) -> Option<f64> {
        // + 0 makes an undamped mode's ratio 0 and not -0
        self.kind.swings().then(|| -self.s.re / self.s.norm() + 0.0)
    }

    /// Time in which it falls, or grows, by e [s]; None where it does neither.
    pub fn time_s(&self) -> Option<f64> {
        (self.s.re != 0.0).then(|| 1.0 / self.s.re.abs())
    }
}

/// The modes of a case about a state.
pub struct Modes {
    /// The linearised equations.
    pub about: Linearised,
    /// Nearest to what was asked first, by |s - 2πi near|.
    pub modes: Vec<Mode>,
    /// Finite eigenvalues that there are.
    pub finite: usize,
    /// Sparse factorisations.
    pub factorizations: u64,
    /// Sparse solves.
    pub solves: u64,
    /// Whether all eigenvalues were computed at once.
    pub dense: bool,
}

/// Modes of everything that a case describes, about its start.
///
/// # Errors
/// As [`linearise`], and [`Error::Solver`] when eigenvalues do not converge.
pub fn modes(case: &Case, plan: &Plan) -> Result<Modes> {
    of(linearise(case, 0.0, None)?, plan)
}

/// Modes of a linearisation.
///
/// # Errors
/// [`Error::Solver`] when eigenvalues do not converge.
pub fn of(about: Linearised, plan: &Plan) -> Result<Modes> {
    let mut tally = Tally::default();
    let mut modes = search(&about, Fluid::Flowing, plan, &mut tally)?;
    if plan.limits && about.flows() {
        let wider = Plan {
            count: plan.count + 4,
            ..*plan
        };
        for fluid in [Fluid::Sealed, Fluid::Free] {
            let others = search(&about, fluid, &wider, &mut tally)?;
            for (k, limit) in matched(&modes, &others) {
                match fluid {
                    Fluid::Sealed => modes[k].undrained = Some(limit),
                    _ => modes[k].drained = Some(limit),
                }
            }
        }
    }
    Ok(Modes {
        about,
        modes,
        finite: tally.finite,
        factorizations: tally.factorizations,
        solves: tally.solves,
        dense: tally.dense,
    })
}

/// Looks for the same modes on half the cells, about the start or the equilibrium under the loads of an instant [s]: what the mesh
/// does to them. Does nothing where the cells cannot be halved.
///
/// # Errors
/// As [`modes`] and [`at_equilibrium`].
pub fn halve_the_mesh(case: &Case, at_rest_under: Option<f64>, plan: &Plan, found: &mut Modes) -> Result<()> {
    let mut case = case.clone();
    let mesh = &mut case.mesh;
    match (&case.bladders, mesh.segments) {
        _ if mesh.cells_per_segment.is_multiple_of(2) => mesh.cells_per_segment /= 2,
        (None, Some(segments)) if segments.is_multiple_of(2) => mesh.segments = Some(segments / 2),
        _ => return Ok(()),
    }
    let about = match at_rest_under {
        Some(at) => at_equilibrium(&case, at)?,
        None => linearise(&case, found.about.at, None)?,
    };
    let wider = Plan {
        count: plan.count + 4,
        ..*plan
    };
    let mut tally = Tally::default();
    let others = search(&about, Fluid::Flowing, &wider, &mut tally)?;
    let every_other: Vec<Mode> = found
        .modes
        .iter()
        .map(|mode| Mode {
            shape: mode.shape.on_every_other_node(),
            ..mode.clone()
        })
        .collect();
    for (k, limit) in matched(&every_other, &others) {
        found.modes[k].coarse = Some(limit);
    }
    found.factorizations += tally.factorizations;
    found.solves += tally.solves;
    Ok(())
}

#[derive(Default)]
struct Tally {
    finite: usize,
    factorizations: u64,
    solves: u64,
    dense: bool,
}

/// Share of the beam's own frequency at which a search from zero begins: beside zero, where closed networks and free beams
/// have their eigenvalues, and nearer to it than anything else is likely to be.
const BESIDE: f64 = 0.1;

fn search(about: &Linearised, fluid: Fluid, plan: &Plan, tally: &mut Tally) -> Result<Vec<Mode>> {
    let (a, b) = about.with(fluid);
    let pencil = Pencil {
        a: &a,
        b: &b,
        ..about.pencil()
    };
    let frequency = about.frequency();
    let target = Complex::new(0.0, std::f64::consts::TAU * plan.near_hz);
    let shift = if plan.near_hz > 0.0 {
        target
    } else {
        Complex::new(BESIDE * frequency, 0.0)
    };
    let mut asked = plan.count + 2;
    loop {
        // conjugates come along and count once
        let found = spectral::nearest(&pencil, shift, 2 * asked, &Options::default()).map_err(|f| failed(about, &f))?;
        tally.factorizations += found.factorizations;
        tally.solves += found.solves;
        if fluid == Fluid::Flowing {
            (tally.finite, tally.dense) = (found.finite, found.dense);
        }
        let complete = found.pairs.len() < 2 * asked;
        let mut shapes = Shapes::new(about);
        let mut modes: Vec<Mode> = found.pairs.iter().filter_map(|p| mode(about, &mut shapes, p)).collect();
        let far = |mode: &Mode| (mode.s - target).norm();
        modes.sort_by(|a, b| far(a).total_cmp(&far(b)));
        let moving = modes.iter().filter(|mode| !mode.kind.stays()).count();
        if moving >= plan.count || complete {
            let mut left = plan.count;
            modes.retain(|mode| {
                let kept = mode.kind.stays() || left > 0;
                left -= usize::from(kept && !mode.kind.stays());
                kept
            });
            return Ok(modes);
        }
        asked = 2 * asked + plan.count - moving;
    }
}

/// The mode of a pair; None for the second of two conjugates.
fn mode(about: &Linearised, shapes: &mut Shapes, pair: &Pair) -> Option<Mode> {
    let length = about.system().model.length;
    let shape = shapes.shape(&pair.x);
    let (kind, s) = kind::judge(pair, &shape, about.frequency(), length);
    (s.im >= 0.0).then_some(Mode {
        kind,
        s,
        error: pair.error,
        residual: pair.residual,
        shape,
        undrained: None,
        drained: None,
        coarse: None,
    })
}

/// Pairs oscillations with those of other equations, the most alike first, each at most once.
fn matched(modes: &[Mode], others: &[Mode]) -> Vec<(usize, Limit)> {
    let swinging = |m: &&(usize, &Mode)| m.1.kind.swings();
    let mut all = vec![];
    for (k, mode) in modes.iter().enumerate().filter(|m| swinging(&m)) {
        for (j, other) in others.iter().enumerate().filter(|m| swinging(&m)) {
            all.push((likeness(&mode.shape, &other.shape), k, j));
        }
    }
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    let (mut taken, mut given) = (vec![false; modes.len()], vec![false; others.len()]);
    let mut found = vec![];
    for (likeness, k, j) in all {
        if let Some(frequency_hz) = others[j].frequency_hz()
            && !taken[k]
            && !given[j]
            && likeness > 0.5
        {
            (taken[k], given[j]) = (true, true);
            found.push((k, Limit { frequency_hz, likeness }));
        }
    }
    found
}

fn failed(about: &Linearised, failure: &Failure) -> Error {
    let unknown = match failure {
        Failure::Singular { column } => Some(about.system().layout.name(*column)),
        _ => None,
    };
    Error::Solver(Box::new(SolverFault {
        code: Code::NoModes,
        time_s: about.at,
        what: format!("no modes: {failure}"),
        unknown,
        cause: None,
        hint: None,
    }))
}
