//! Modes: frequencies, damping, shapes and growth of small motions about a state.
//!
//! ```text
//! linearise    pencil of a case about a state, with the fluid as it is, sealed, or free
//! shape        displacements and pressures of an eigenvector; likeness of two shapes
//! limits       the same modes with sealed or free fluid
//! meshes       the same modes on other meshes
//! clustered    modes beside a cluster of decays
//! relaxation   modes of a solid that relaxes
//! sensitivity  derivatives by numbers of the case
//! kind         oscillation, decay, growth, rigid motion, kept volume
//! sort         modes of one sort, and the order of output
//! warnings     warnings about modes
//! ```

mod clustered;
pub mod kind;
mod limits;
pub mod linearise;
pub mod meshes;
mod relaxation;
pub mod sensitivity;
pub mod shape;
pub mod sort;
mod warnings;

use nalgebra::Complex;
use serde::{Deserialize, Serialize};

use crate::case::Case;
use crate::case::schema::Effect;
use crate::error::{Code, Error, Result, SolverError, StopPoint};
use crate::run::json_null;
use crate::spectral::{self, EigenPair, EigenvalueOptions, Pencil, SpectralError};

use clustered::PartialSearch;
pub use kind::TimeBehavior;
pub use linearise::{FluidBehavior, Linearised, at_equilibrium, linearise};
pub use meshes::{ByMesh, compare_effects, compare_meshes};
pub use sensitivity::{ModeSensitivity, differentiate};
pub use shape::{ModeShape, Shapes, likeness};
pub use sort::ModeFilter;

/// Options of a search for modes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeOptions {
    /// Number of modes, not counting those with s = 0.
    pub count: usize,
    /// Frequency near which modes are searched [Hz].
    pub near_hz: f64,
    /// True if the modes with sealed and with free fluid are computed too.
    pub limits: bool,
}

impl ModeOptions {
    /// `2πi near` [1/s].
    fn target(&self) -> Complex<f64> {
        Complex::new(0.0, std::f64::consts::TAU * self.near_hz)
    }
}

/// The same mode with sealed or free fluid, or on another mesh.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LimitingMode {
    /// Frequency [Hz].
    #[serde(deserialize_with = "json_null::number")]
    pub frequency_hz: f64,
    /// Likeness of the shapes, [E33].
    #[serde(deserialize_with = "json_null::number")]
    pub likeness: f64,
}

/// A mode; of a pair of conjugates the one with positive frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Kind of the mode.
    pub kind: TimeBehavior,
    /// s [1/s], without parts that are round-off.
    pub s: Complex<f64>,
    /// Bound of the error of s, to first order [1/s].
    pub error: f64,
    /// Backward error of the pair.
    pub residual: f64,
    /// Shape of the mode.
    pub shape: ModeShape,
    /// The mode with every bladder sealed.
    pub undrained: Option<LimitingMode>,
    /// The mode with networks of one pressure.
    pub drained: Option<LimitingMode>,
    /// The mode on a mesh of half the cells.
    pub coarse: Option<LimitingMode>,
    /// Errors due to the meshes.
    pub by_mesh: ByMesh,
}

impl Mode {
    /// Frequency [Hz]; None if the mode does not oscillate.
    pub fn frequency_hz(&self) -> Option<f64> {
        self.kind.swings().then(|| self.s.im / std::f64::consts::TAU)
    }

    /// `[E45]` Eigenvalue extrapolated (Richardson, second order) from half the cells of the beam and twice those of a bladder [1/s],
    ///
    /// ```text
    /// s ≈ s(h, g) + (s(h, g) - s(2h, g))/3 + 4 (s(h, g/2) - s(h, g))/3        h: cells of the beam, g: of a bladder
    /// ```
    ///
    /// and a 15th of the difference on a beam of fourth order, [E77]; from twice the cells of the beam as for a bladder. None if the
    /// beam could not be compared.
    pub fn extrapolated(&self) -> Option<Complex<f64>> {
        let ByMesh { beam, bladders, .. } = self.by_mesh;
        Some(self.s + beam? + bladders.unwrap_or_default())
    }

    /// Extrapolated frequency [Hz]; None if the mode does not oscillate or was not found on the other mesh.
    pub fn extrapolated_hz(&self) -> Option<f64> {
        self.frequency_hz()?;
        Some(self.extrapolated()?.im / std::f64::consts::TAU)
    }

    /// Error of the frequency due to the meshes, relative to the frequency; magnitudes of both meshes are added.
    pub fn mesh_error(&self) -> Option<f64> {
        self.frequency_hz()?;
        self.off(|s| s.im, self.s.im)
    }

    /// Error of the growth or decay rate due to the meshes, relative to the rate; magnitudes of both meshes are added. None
    /// if the damping
    /// ratio is below 1e-6.
    pub fn rate_error(&self) -> Option<f64> {
        self.off(|s| s.re, self.s.re.abs()).filter(|_| self.is_damped())
    }

    /// Error of the frequency due to the effects left out, relative to the frequency; None if it is unknown or no effect is left out.
    pub fn effects_error(&self) -> Option<f64> {
        let effects = self.by_mesh.effects?;
        Some(effects.im.abs() / self.s.im.abs()).filter(|_| self.kind.swings())
    }

    /// Error of the growth or decay rate due to the effects left out, as [`Mode::rate_error`].
    pub fn rate_effects_error(&self) -> Option<f64> {
        let effects = self.by_mesh.effects?;
        Some(effects.re.abs() / self.s.re.abs()).filter(|_| self.is_damped())
    }

    /// Errors of frequency and of rate due to meshes and effects; None if the error due to the meshes is unknown.
    pub fn errors(&self) -> [Option<f64>; 2] {
        let sum = |by_mesh: Option<f64>, by_effects: Option<f64>| Some(by_mesh? + by_effects.unwrap_or(0.0));
        [
            sum(self.mesh_error(), self.effects_error()),
            sum(self.rate_error(), self.rate_effects_error()),
        ]
    }

    /// True if the rate is no rounding error.
    fn is_damped(&self) -> bool {
        self.s.re.abs() > UNDAMPED * self.s.norm()
    }

    /// True if the mode moves and its error due to the mesh of the beam is not known.
    fn lacks_beam_error(&self) -> bool {
        !self.kind.stays() && self.by_mesh.beam.is_none()
    }

    fn off(&self, part: fn(Complex<f64>) -> f64, of: f64) -> Option<f64> {
        self.by_mesh.beam?;
        let both = self.by_mesh.off();
        both.map(|more| part(more).abs())
            .reduce(|a, b| a + b)
            .map(|off| off / of.abs())
    }

    /// Damping ratio, negative for growth; None if the mode does not oscillate.
    pub fn damping_ratio(&self) -> Option<f64> {
        // + 0 makes an undamped mode's ratio 0 and not -0
        self.kind.swings().then(|| -self.s.re / self.s.norm() + 0.0)
    }

    /// Time in which the mode decays or grows by the factor e [s]; None if it does neither.
    pub fn time_s(&self) -> Option<f64> {
        (self.s.re != 0.0).then(|| 1.0 / self.s.re.abs())
    }
}

/// Damping ratio below which a mode counts as undamped.
const UNDAMPED: f64 = 1e-6;

/// The modes of a case about a state.
pub struct Modes {
    /// The linearized equations.
    pub about: Linearised,
    /// Modes, nearest to the requested frequency first, by |s - 2πi near|.
    pub modes: Vec<Mode>,
    /// Number of finite eigenvalues.
    pub finite: usize,
    /// Number of sparse factorizations.
    pub factorizations: u64,
    /// Number of sparse solves.
    pub solves: u64,
    /// True if all eigenvalues were computed at once.
    pub dense: bool,
    /// Distance from 2πi near within which every mode is listed [1/s]; infinite if there are no other modes.
    pub radius: f64,
    /// Number of long-term modes that were not found again in the solid that relaxes.
    pub lost: usize,
    /// True if decays form a cluster at which the search from zero ended.
    pub clustered: bool,
    /// True if comparisons with other meshes were made.
    pub compared: bool,
    /// True if there is a mesh along bladders that could be compared with another.
    pub bladders_compared: bool,
    /// Effects that the modes leave out and that are compared.
    pub left_out: Vec<Effect>,
    /// Reason why errors exclude effects that are left out.
    pub excluded: Option<String>,
}

/// Modes of the full case about its start.
///
/// # Errors
/// As [`linearise`], and [`Error::Solver`] if eigenvalues do not converge.
pub fn modes(case: &Case, plan: &ModeOptions) -> Result<Modes> {
    compute(linearise(case, 0.0, None)?, plan)
}

/// Modes of a linearisation.
///
/// # Errors
/// [`Error::Solver`] if eigenvalues do not converge.
pub fn compute(about: Linearised, plan: &ModeOptions) -> Result<Modes> {
    let mut tally = Tally::default();
    let modes = search(&about, FluidBehavior::Flowing, plan, &mut tally)?;
    let mut found = Modes {
        about,
        modes,
        finite: tally.finite,
        factorizations: tally.factorizations,
        solves: tally.solves,
        dense: tally.dense,
        radius: tally.radius,
        lost: tally.lost,
        clustered: tally.clustered,
        compared: false,
        bladders_compared: false,
        left_out: vec![],
        excluded: None,
    };
    if plan.limits {
        limits::find(&mut found, plan);
    }
    Ok(found)
}

#[derive(Default)]
struct Tally {
    finite: usize,
    factorizations: u64,
    solves: u64,
    dense: bool,
    radius: f64,
    lost: usize,
    clustered: bool,
}

/// Fraction of the beam's own frequency at which a search from zero begins. It avoids zero, where closed networks and free beams have
/// their eigenvalues, and is probably nearer to zero than all others.
const BESIDE: f64 = 0.1;

fn search(about: &Linearised, fluid: FluidBehavior, plan: &ModeOptions, tally: &mut Tally) -> Result<Vec<Mode>> {
    let (a, b) = about.with(fluid);
    match relaxation::relaxes(about) {
        false => near_to(about, fluid, [&a, &b], plan, tally),
        true => relaxation::search(about, fluid, [&a, &b], plan, tally),
    }
}

/// Size up to which all eigenvalues are computed, within a second or two, instead of only those beside a cluster.
const QUICK: usize = 500;

/// Finds the planned modes of a pencil with entries A and B.
fn near_to(
    about: &Linearised,
    fluid: FluidBehavior,
    [a, b]: [&[f64]; 2],
    plan: &ModeOptions,
    tally: &mut Tally,
) -> Result<Vec<Mode>> {
    let pencil = Pencil { a, b, ..about.pencil() };
    let target = plan.target();
    let shift = if plan.near_hz > 0.0 {
        target
    } else {
        Complex::new(BESIDE * about.frequency(), 0.0)
    };
    let options = match plan.near_hz > 0.0 {
        true => EigenvalueOptions::default(),
        false => EigenvalueOptions {
            at_last_dense_up_to: QUICK,
            ..EigenvalueOptions::default()
        },
    };
    let mut asked = plan.count + 2;
    loop {
        // conjugates are found too and count once
        let (mut modes, complete, mut radius) = match spectral::nearest(&pencil, shift, 2 * asked, &options) {
            Ok(found) => {
                tally.factorizations += found.factorizations;
                tally.solves += found.solves;
                if fluid == FluidBehavior::Flowing {
                    (tally.finite, tally.dense) = (found.finite, found.dense);
                }
                let mut shapes = Shapes::new(about);
                let modes: Vec<Mode> = found.pairs.iter().filter_map(|p| mode(about, &mut shapes, p)).collect();
                let complete = found.pairs.len() < 2 * asked;
                let radius = if complete {
                    f64::INFINITY
                } else {
                    reach(&found.pairs, shift, target)
                };
                (modes, complete, radius)
            }
            Err(SpectralError::Slow { converged, .. }) if plan.near_hz == 0.0 && converged > 1 => {
                tally.clustered |= fluid == FluidBehavior::Flowing;
                let wanted = plan.count;
                let search = PartialSearch {
                    shift,
                    converged,
                    wanted,
                };
                let (modes, radius) = search.modes(about, fluid, &pencil, tally)?;
                (modes, true, radius)
            }
            Err(failure) => return Err(failed(about, &failure)),
        };
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
            if moving > plan.count {
                radius = modes.iter().map(far).fold(0.0, f64::max).min(radius);
            }
            if fluid == FluidBehavior::Flowing {
                tally.radius = radius;
            }
            return Ok(modes);
        }
        asked = 2 * asked + plan.count - moving;
    }
}

/// Distance from the target within which the pairs nearest a shift are all that there are.
fn reach(pairs: &[EigenPair], shift: Complex<f64>, target: Complex<f64>) -> f64 {
    let farthest = pairs.iter().map(|pair| (pair.s - shift).norm()).fold(0.0, f64::max);
    farthest - (shift - target).norm()
}

/// Mode of a pair; None for the second of two conjugates.
fn mode(about: &Linearised, shapes: &mut Shapes, pair: &EigenPair) -> Option<Mode> {
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
        by_mesh: ByMesh::default(),
    })
}

fn failed(about: &Linearised, failure: &SpectralError) -> Error {
    if *failure == SpectralError::Interrupted {
        return Error::Interrupted(format!("{failure} before modes were found; nothing is written"));
    }
    let unknown = match failure {
        SpectralError::Singular { column } => Some(about.system().layout.name(*column)),
        _ => None,
    };
    Error::Solver(Box::new(SolverError {
        code: Code::NoModes,
        at: StopPoint::Time(about.at),
        what: format!("no modes: {failure}"),
        unknown,
        cause: None,
        hint: None,
    }))
}
