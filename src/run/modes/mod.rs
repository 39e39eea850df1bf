//! Modes: frequencies, damping, shapes and growth of small motions about a state.
//!
//! ```text
//! linearise   the pencil of a case about a state, with the fluid as it is, held, or free
//! shape       displacements and pressures of an eigenvector; likeness of two
//! meshes       the same modes on other meshes
//! clustered    those beside a cluster of decays
//! relaxing     those of a solid that relaxes
//! sensitivity  derivatives by numbers of the case
//! kind        oscillation, decay, growth, rigid motion, kept volume
//! sort        those of one sort, and the order in which they are told
//! warnings    what to know before trusting them
//! ```

mod clustered;
pub mod kind;
pub mod linearise;
pub mod meshes;
mod relaxing;
pub mod sensitivity;
pub mod shape;
pub mod sort;
mod warnings;

use nalgebra::Complex;
use serde::{Deserialize, Serialize};

use crate::case::Case;
use crate::error::{At, Code, Error, Result, SolverError};
use crate::run::null;
use crate::spectral::{self, Options, Pair, Pencil, SpectralError};

use clustered::Clustered;
pub use kind::Kind;
pub use linearise::{Fluid, Linearised, at_equilibrium, linearise};
pub use meshes::{ByMesh, compare_meshes};
pub use sensitivity::{Sensitivity, differentiate};
pub use shape::{Shape, Shapes, likeness};
pub use sort::Sort;

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

impl Plan {
    /// `2πi near` [1/s].
    fn target(&self) -> Complex<f64> {
        Complex::new(0.0, std::f64::consts::TAU * self.near_hz)
    }
}

/// The same mode with the fluid held or free.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limit {
    /// Frequency [Hz].
    #[serde(deserialize_with = "null::number")]
    pub frequency_hz: f64,
    /// Likeness of the shapes, [E33].
    #[serde(deserialize_with = "null::number")]
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
    /// What meshes do to it.
    pub by_mesh: ByMesh,
}

impl Mode {
    /// Frequency [Hz]; None where nothing swings.
    pub fn frequency_hz(&self) -> Option<f64> {
        self.kind.swings().then(|| self.s.im / std::f64::consts::TAU)
    }

    /// `[E45]` What other meshes say of these (Richardson, second order): the eigenvalue to which half the cells of the beam and
    /// twice those of a bladder point [1/s],
    ///
    /// ```text
    /// s ≈ s(h, g) + (s(h, g) - s(2h, g))/3 + 4 (s(h, g/2) - s(h, g))/3        h: cells of the beam, g: of a bladder
    /// ```
    ///
    /// and a 15th of the difference on a beam of fourth order, [E77]. None where the beam could not be compared.
    pub fn extrapolated(&self) -> Option<Complex<f64>> {
        let ByMesh { beam, bladders, .. } = self.by_mesh;
        Some(self.s + beam? + bladders.unwrap_or_default())
    }

    /// The frequency to which meshes point [Hz]; None where nothing swings or no other mesh has such a mode.
    pub fn extrapolated_hz(&self) -> Option<f64> {
        self.frequency_hz()?;
        Some(self.extrapolated()?.im / std::f64::consts::TAU)
    }

    /// Error that meshes make of the frequency, relative to it, one beside the other.
    pub fn mesh_error(&self) -> Option<f64> {
        self.frequency_hz()?;
        self.off(|s| s.im, self.s.im)
    }

    /// Error that meshes make of the growth or decay, relative to it, likewise. None where there is none; a damping ratio below 1e-6
    /// is none.
    pub fn rate_error(&self) -> Option<f64> {
        let rate = self.s.re.abs();
        (rate > UNDAMPED * self.s.norm())
            .then(|| self.off(|s| s.re, rate))
            .flatten()
    }

    fn off(&self, part: fn(Complex<f64>) -> f64, of: f64) -> Option<f64> {
        self.by_mesh.beam?;
        let both = self.by_mesh.off();
        both.map(|more| part(more).abs())
            .reduce(|a, b| a + b)
            .map(|off| off / of.abs())
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

/// Damping ratio below which a mode is not damped.
const UNDAMPED: f64 = 1e-6;

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
    /// Modes of the long term that were not found again where the solid relaxes.
    pub lost: usize,
    /// Whether decays lie in a cluster at which the search from zero ended.
    pub clustered: bool,
    /// Whether there is a mesh along bladders that could be compared with another.
    pub bladders_compared: bool,
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
    let (lost, clustered) = (tally.lost, tally.clustered);
    if plan.limits && about.flows() {
        let wider = Plan {
            count: plan.count + 4,
            ..*plan
        };
        for fluid in [Fluid::Sealed, Fluid::Free] {
            // more than asked for may be more than converge; a limit that is not found is not shown
            let Ok(others) =
                search(&about, fluid, &wider, &mut tally).or_else(|_| search(&about, fluid, plan, &mut tally))
            else {
                continue;
            };
            for (k, j, likeness) in matched(&modes, &others) {
                let Some(frequency_hz) = others[j].frequency_hz() else {
                    continue;
                };
                let limit = Limit { frequency_hz, likeness };
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
        lost,
        clustered,
        bladders_compared: false,
    })
}

#[derive(Default)]
struct Tally {
    finite: usize,
    factorizations: u64,
    solves: u64,
    dense: bool,
    lost: usize,
    clustered: bool,
}

/// Share of the beam's own frequency at which a search from zero begins: beside zero, where closed networks and free beams
/// have their eigenvalues, and nearer to it than anything else is likely to be.
const BESIDE: f64 = 0.1;

fn search(about: &Linearised, fluid: Fluid, plan: &Plan, tally: &mut Tally) -> Result<Vec<Mode>> {
    let (a, b) = about.with(fluid);
    match relaxing::relaxes(about) {
        false => near_to(about, fluid, [&a, &b], plan, tally),
        true => relaxing::search(about, fluid, [&a, &b], plan, tally),
    }
}

/// Size up to which all eigenvalues are computed within a second or two, rather than those beside a cluster alone.
const QUICK: usize = 500;

/// Modes of entries A and B, as planned.
fn near_to(about: &Linearised, fluid: Fluid, [a, b]: [&[f64]; 2], plan: &Plan, tally: &mut Tally) -> Result<Vec<Mode>> {
    let pencil = Pencil { a, b, ..about.pencil() };
    let target = plan.target();
    let shift = if plan.near_hz > 0.0 {
        target
    } else {
        Complex::new(BESIDE * about.frequency(), 0.0)
    };
    let options = match plan.near_hz > 0.0 {
        true => Options::default(),
        false => Options {
            at_last_dense_up_to: QUICK,
            ..Options::default()
        },
    };
    let mut asked = plan.count + 2;
    loop {
        // conjugates come along and count once
        let (mut modes, complete) = match spectral::nearest(&pencil, shift, 2 * asked, &options) {
            Ok(found) => {
                tally.factorizations += found.factorizations;
                tally.solves += found.solves;
                if fluid == Fluid::Flowing {
                    (tally.finite, tally.dense) = (found.finite, found.dense);
                }
                let mut shapes = Shapes::new(about);
                let modes: Vec<Mode> = found.pairs.iter().filter_map(|p| mode(about, &mut shapes, p)).collect();
                (modes, found.pairs.len() < 2 * asked)
            }
            Err(SpectralError::Slow { converged, .. }) if plan.near_hz == 0.0 && converged > 1 => {
                tally.clustered |= fluid == Fluid::Flowing;
                let wanted = plan.count;
                let search = Clustered {
                    shift,
                    converged,
                    wanted,
                };
                (search.modes(about, fluid, &pencil, tally)?, true)
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
        by_mesh: ByMesh::default(),
    })
}

/// Pairs oscillations with those of other equations: places in both lists, and the likeness of the shapes.
fn matched(modes: &[Mode], others: &[Mode]) -> Vec<(usize, usize, f64)> {
    paired(
        modes,
        others,
        |mode| mode.kind.swings(),
        |a, b| likeness(&a.shape, &b.shape),
    )
}

/// Likeness above which two modes may be the same.
const ALIKE: f64 = 0.5;

/// Pairs modes of a sort, the most alike first, each at most once.
fn paired(
    modes: &[Mode],
    others: &[Mode],
    of_sort: impl Fn(&Mode) -> bool,
    alike: impl Fn(&Mode, &Mode) -> f64,
) -> Vec<(usize, usize, f64)> {
    let mut all = vec![];
    for (k, mode) in modes.iter().enumerate().filter(|m| of_sort(m.1)) {
        for (j, other) in others.iter().enumerate().filter(|m| of_sort(m.1)) {
            all.push((k, j, alike(mode, other)));
        }
    }
    all.sort_by(|a, b| b.2.total_cmp(&a.2));
    let (mut taken, mut given) = (vec![false; modes.len()], vec![false; others.len()]);
    all.retain(|&(k, j, alike)| {
        let new = !taken[k] && !given[j] && alike > ALIKE;
        if new {
            (taken[k], given[j]) = (true, true);
        }
        new
    });
    all
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
        at: At::Time(about.at),
        what: format!("no modes: {failure}"),
        unknown,
        cause: None,
        hint: None,
    }))
}
