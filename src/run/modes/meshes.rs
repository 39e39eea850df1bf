//! Effect of the meshes along the beam and along the bladders on modes, and of effects left out: a comparison with half the cells of the
//! beam, with twice the cells of a bladder, and with all effects.
//!
//! Half the cells of the beam may not resolve a mode, or may be of another order. Such a mode is compared with twice the cells. A
//! bladder has few cells: half of them are often zero, and cannot represent flow within a bladder.

use nalgebra::Complex;

use super::limits::paired;
use super::shape::{alike, likeness};
use super::{
    FluidBehavior, LimitingMode, Linearised, Mode, ModeOptions, Modes, Tally, at_equilibrium, linearise, search,
};
use crate::case::Case;
use crate::case::schema::Effect;
use crate::discrete::resolution::LIMIT as LARGE;
use crate::error::{Code, Result};

/// Error over the difference to half or to twice the cells, for a mesh of second or fourth order.
fn share(finer: bool, fourth: bool) -> f64 {
    let by = if fourth { 16.0 } else { 4.0 };
    if finer { by / (by - 1.0) } else { 1.0 / (by - 1.0) }
}

/// Errors due to the meshes: `s` in the limit of fine meshes minus `s` [1/s]. `None` if the mesh was not changed, or if the other mesh
/// has no such mode.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ByMesh {
    /// Along the beam.
    pub beam: Option<Complex<f64>>,
    /// Along bladders.
    pub bladders: Option<Complex<f64>>,
    /// Effects left out: `s` with all effects minus `s` [1/s].
    pub effects: Option<Complex<f64>>,
    /// True if beam cells are of fourth order. A part of their error may be of second order, so the error may be as large as for that.
    pub fourth: bool,
    /// True if the beam was compared with twice the cells, false with half of them.
    pub finer: bool,
}

impl ByMesh {
    /// Possible errors along the beam and along bladders [1/s].
    pub fn off(&self) -> impl Iterator<Item = Complex<f64>> {
        let by = share(self.finer, false) / share(self.finer, self.fourth);
        self.beam.map(|beam| beam * by).into_iter().chain(self.bladders)
    }
}

/// Finds the same modes on other meshes, about the start or the equilibrium under the loads of an instant [s].
///
/// # Errors
/// None: if a mesh has no modes, or not these, its effect remains unknown.
pub fn compare_meshes(case: &Case, at_rest_under: Option<f64>, plan: &ModeOptions, found: &mut Modes) {
    let at = found.about.at;
    let about = |case: &Case| about_state(case, at, at_rest_under);
    found.compared = true;
    let enough = found.about.system().mesh.cells >= 2 * FEWEST;
    if let Some(coarse) = halved(case).filter(|_| enough) {
        along_the_beam(about(&coarse), plan, false, found);
    }
    if found.modes.iter().any(|mode| mode.lacks_beam_error()) {
        along_the_beam(
            about(&doubled(case, found.about.system().mesh.fourth)),
            plan,
            true,
            found,
        );
    }
    let flows = found.about.flows() && found.about.system().model.effects.has(Effect::FlowAlongBladders);
    found.bladders_compared = flows;
    if flows {
        let mut fine = case.clone();
        fine.mesh.cells_per_bladder *= 2;
        along_bladders(about(&fine), plan, found);
    }
}

/// Linearization about the start with the signals of an instant [s], or about the equilibrium under the loads of another.
fn about_state(case: &Case, at: f64, at_rest_under: Option<f64>) -> Result<Linearised> {
    match at_rest_under {
        Some(at) => at_equilibrium(case, at),
        None => linearise(case, at, None),
    }
}

/// Minimum number of cells of a beam that is compared as the half of another.
const FEWEST: usize = 8;

/// The case with half the cells, if they can be halved.
fn halved(case: &Case) -> Option<Case> {
    let mut case = case.clone();
    let mesh = &mut case.mesh;
    match (&case.bladders, mesh.segments) {
        _ if mesh.cells_per_segment.is_multiple_of(2) => mesh.cells_per_segment /= 2,
        (None, Some(segments)) if segments.is_multiple_of(2) => mesh.segments = Some(segments / 2),
        _ => return None,
    }
    Some(case)
}

/// The case with twice the cells, of the same order: a mesh of few cells has order 2.
fn doubled(case: &Case, fourth: bool) -> Case {
    let mut case = case.clone();
    case.mesh.cells_per_segment *= 2;
    case.mesh.order = Some(if fourth { 4 } else { 2 });
    case
}

/// Half the cells resolve an oscillation above this likeness and below this relative difference. Otherwise the difference may be too
/// small by chance.
const RESOLVED: f64 = 0.98;
const SMALL: f64 = 0.15;

/// Likeness above which an oscillation on twice the cells is the same.
const SAME: f64 = 0.8;

/// Compares those modes whose error is not known with another mesh of the beam.
fn along_the_beam(about: Result<Linearised>, plan: &ModeOptions, finer: bool, found: &mut Modes) {
    let fourth = found.about.system().mesh.fourth;
    // a mesh of few cells has another order
    let Some(about) = about.ok().filter(|other| other.system().mesh.fourth == fourth) else {
        return;
    };
    let every_other = |modes: &[Mode]| -> Vec<Mode> {
        let coarser = |mode: &Mode| Mode {
            shape: mode.shape.on_every_other_node(),
            ..mode.clone()
        };
        modes.iter().map(coarser).collect()
    };
    let Some(others) = elsewhere(&about, plan, found) else {
        return;
    };
    let (length, modes) = (found.about.system().model.length, &found.modes);
    let pairs = match finer {
        true => pairs(modes, &every_other(&others), length),
        false => pairs(&every_other(modes), &others, length),
    };
    for (k, j, likeness) in pairs {
        let (mode, other) = (&mut found.modes[k], &others[j]);
        let change = if finer { other.s - mode.s } else { mode.s - other.s };
        let resolved = match finer {
            true => likeness > SAME,
            false => likeness > RESOLVED && change.norm() < SMALL * mode.s.norm(),
        };
        if !mode.lacks_beam_error() || mode.kind.swings() && !resolved {
            continue;
        }
        mode.by_mesh = ByMesh {
            beam: Some(change * share(finer, fourth)),
            fourth,
            finer,
            ..mode.by_mesh
        };
        mode.coarse = other
            .frequency_hz()
            .filter(|_| !finer)
            .map(|frequency_hz| LimitingMode { frequency_hz, likeness });
    }
}

fn along_bladders(about: Result<Linearised>, plan: &ModeOptions, found: &mut Modes) {
    let Some(others) = about.ok().and_then(|about| elsewhere(&about, plan, found)) else {
        return;
    };
    for (k, j, _) in pairs(&found.modes, &others, found.about.system().model.length) {
        let mode = &mut found.modes[k];
        mode.by_mesh.bladders = Some((others[j].s - mode.s) * share(true, false));
    }
}

/// Compares with the modes of a case with all effects, as [`compare_meshes`]. Unsteady friction adds decays that crowd the slowest modes:
/// oscillations are then searched at their own frequencies, as many as three times the work allows.
pub fn compare_effects(full: &Case, at_rest_under: Option<f64>, plan: &ModeOptions, found: &mut Modes) {
    let Ok(about) = about_state(full, found.about.at, at_rest_under) else {
        return;
    };
    let most = (1 + MOST_WORK) * found.factorizations;
    if !found.left_out.contains(&Effect::UnsteadyFriction) {
        with_effects(&about, plan, None, found);
    }
    let lacks = |mode: &Mode| mode.kind.swings() && mode.by_mesh.effects.is_none();
    let mut open: Vec<usize> = (0..found.modes.len()).filter(|&k| lacks(&found.modes[k])).collect();
    open.sort_by(|a, b| found.modes[*a].s.im.total_cmp(&found.modes[*b].s.im));
    for k in open {
        let near = ModeOptions {
            count: 1,
            near_hz: found.modes[k].s.im / std::f64::consts::TAU,
            ..*plan
        };
        with_effects(&about, &near, Some(k), found);
        if found.factorizations > most {
            break;
        }
    }
}

/// Compares all modes, or only one, with those about a state with all effects.
fn with_effects(about: &Linearised, plan: &ModeOptions, only: Option<usize>, found: &mut Modes) {
    let Some(others) = elsewhere(about, plan, found) else {
        return;
    };
    for (k, j, likeness) in pairs(&found.modes, &others, found.about.system().model.length) {
        let mode = &mut found.modes[k];
        let same = !mode.kind.swings() || likeness > SAME;
        if same && only.is_none_or(|only| only == k) {
            mode.by_mesh.effects = Some(others[j].s - mode.s);
        }
    }
}

/// Largest number of factorizations with all effects over that of the modes.
const MOST_WORK: u64 = 3;

/// Number of additional modes, since the last ones may change their order.
const MORE: usize = 4;

/// Modes about a state on another mesh or with other effects.
fn elsewhere(about: &Linearised, plan: &ModeOptions, found: &mut Modes) -> Option<Vec<Mode>> {
    let mut tally = Tally::default();
    let others = [MORE, 0].into_iter().find_map(|more| {
        let plan = ModeOptions {
            count: plan.count + more,
            ..*plan
        };
        search(about, FluidBehavior::Flowing, &plan, &mut tally).ok()
    });
    found.factorizations += tally.factorizations;
    found.solves += tally.solves;
    others
}

/// Pairs of modes on two meshes with the likeness of their shapes; length of the beam [m].
fn pairs(modes: &[Mode], others: &[Mode], length: f64) -> Vec<(usize, usize, f64)> {
    let mut pairs = swinging(modes, others);
    pairs.extend(real(modes, others, length));
    pairs
}

/// Similarity of |s| of two modes; 1 if they are equal.
fn as_fast(a: &Mode, b: &Mode) -> f64 {
    let [a, b] = [a, b].map(|mode| mode.s.norm());
    (a * b).sqrt() * 2.0 / (a + b)
}

/// Power of [`as_fast`] beside the likeness of shapes: 20 % difference in frequency then costs 6 %, and 50 % costs 28 %.
const SHARP: i32 = 16;

/// Pairs of oscillations with the likeness of their shapes: those most alike in displacements and in |s|. Oscillations of
/// the fluid move
/// the beam only a little, and all in a similar shape.
fn swinging(modes: &[Mode], others: &[Mode]) -> Vec<(usize, usize, f64)> {
    let swings = |mode: &Mode| mode.kind.swings();
    let pairs = paired(modes, others, swings, |a, b| {
        likeness(&a.shape, &b.shape) * as_fast(a, b).powi(SHARP)
    });
    let with_likeness = |(k, j, _): (usize, usize, f64)| (k, j, likeness(&modes[k].shape, &others[j].shape));
    pairs.into_iter().map(with_likeness).collect()
}

/// Pairs of modes that decay or grow without oscillation: those most alike in displacements and pressures together, and in rate. For
/// flow within bladders neither is distinctive, so the remaining modes are paired in the order in which they were found.
fn real(modes: &[Mode], others: &[Mode], length: f64) -> Vec<(usize, usize, f64)> {
    let real = |mode: &Mode| !mode.kind.swings() && !mode.kind.stays();
    let mut pairs = paired(modes, others, real, |a, b| {
        alike(&a.shape, &b.shape, length) * as_fast(a, b)
    });
    let left = |all: &[Mode], taken: &dyn Fn(usize) -> bool| -> Vec<usize> {
        let open = all.iter().enumerate().filter(|(k, mode)| real(mode) && !taken(*k));
        open.map(|(k, _)| k).collect()
    };
    let here = left(modes, &|k| pairs.iter().any(|pair| pair.0 == k));
    let there = left(others, &|j| pairs.iter().any(|pair| pair.1 == j));
    pairs.extend(here.into_iter().zip(there).map(|(k, j)| (k, j, 0.0)));
    pairs
}

/// Largest number of modes that the warning names.
const LISTED: usize = 4;

/// Warns of modes that depend strongly on the meshes or on effects left out, or whose dependence is unknown.
pub fn warning(found: &Modes) -> Option<String> {
    if !found.compared {
        return None;
    }
    // by meshes, by effects
    let mut large: [Vec<(usize, f64, &str)>; 2] = Default::default();
    let mut unknown: [Vec<String>; 2] = Default::default();
    for (k, mode) in found.modes.iter().enumerate().filter(|(_, mode)| !mode.kind.stays()) {
        let effects = [mode.effects_error(), mode.rate_effects_error()].map(|error| error.unwrap_or(0.0));
        let worst = ["frequency", "rate"]
            .into_iter()
            .zip(mode.errors().into_iter().zip(effects))
            .filter_map(|(what, (error, effects))| Some((what, error?, usize::from(2.0 * effects > error?))))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        match worst {
            Some((what, error, cause)) if error > LARGE => large[cause].push((k + 1, error, what)),
            _ if mode.lacks_beam_error() || found.bladders_compared && mode.by_mesh.bladders.is_none() => {
                unknown[0].push((k + 1).to_string());
            }
            _ if lacks_effects_error(found, mode) => unknown[1].push((k + 1).to_string()),
            _ => {}
        }
    }
    let effects = Effect::names(&found.left_out, ", ");
    let plural = |all: &[String]| if all.len() == 1 { "" } else { "s" };
    let mut sentences = vec![];
    let by_effects = format!("errors by effects left out ({effects})");
    for (cause, all) in ["errors of the meshes", &by_effects].into_iter().zip(&large) {
        sentences.extend((!all.is_empty()).then(|| format!("{cause}: {}", listed(all))));
    }
    let without = ["finer meshes lack".to_owned(), format!("were not found with {effects}")];
    let kinds = ["of the meshes", "by effects left out"].into_iter().zip(without);
    for ((kind, without), all) in kinds.zip(&unknown).filter(|(_, all)| !all.is_empty()) {
        sentences.push(format!(
            "the error {kind} is not known for mode{} {}, which {without}",
            plural(all),
            all.join(", ")
        ));
    }
    let finer = "Increase /mesh/cells_per_bladder or /mesh/cells_per_segment, or use --accuracy, which refines both.";
    let on = |effect: &Effect| format!("--set '/effects/{effect}=\"on\"'");
    let on: Vec<String> = found.left_out.iter().map(on).collect();
    let remedies = [
        (!(large[0].is_empty() && unknown[0].is_empty())).then(|| finer.to_owned()),
        (!(large[1].is_empty() && unknown[1].is_empty())).then(|| format!("Use {}.", on.join(" "))),
    ];
    let remedies: Vec<String> = remedies.into_iter().flatten().collect();
    (!sentences.is_empty())
        .then(|| Code::ErrorEstimate.warning(format!("estimate: {}. {}", sentences.join("; "), remedies.join(" "))))
}

/// True if the error of a mode by effects left out is not known. Decays are not compared with unsteady friction, which has decays of its own.
fn lacks_effects_error(found: &Modes, mode: &Mode) -> bool {
    let compared = mode.kind.swings() || !found.left_out.contains(&Effect::UnsteadyFriction);
    compared && !found.left_out.is_empty() && mode.by_mesh.effects.is_none()
}

/// Text of the largest errors: number of the mode, error, name of the figure.
fn listed(large: &[(usize, f64, &str)]) -> String {
    let mut large = large.to_vec();
    large.sort_by(|a, b| b.1.total_cmp(&a.1));
    let more = large.len().saturating_sub(LISTED);
    let each = large
        .into_iter()
        .take(LISTED)
        .map(|(k, error, what)| match error >= 1.0 {
            true => format!("{what} of mode {k} larger than itself"),
            false => format!("{what} of mode {k} about {:.0} %", 100.0 * error),
        });
    let more = (more > 0).then(|| format!("{more} more"));
    each.chain(more).collect::<Vec<_>>().join(", ")
}
