//! What the meshes along the beam and along the bladders do to modes: the same modes on half the cells of a beam, on twice those of a
//! bladder.
//!
//! A bladder has few cells: half of them are often none at all, and have none of the flows to and fro within one.

use nalgebra::Complex;

use super::shape::{alike, likeness};
use super::{Fluid, Limit, Linearised, Mode, Modes, Plan, Tally, at_equilibrium, linearise, search};
use crate::case::Case;
use crate::case::schema::Effect;
use crate::discrete::resolution::LIMIT as LARGE;
use crate::error::{Code, Result};

/// What meshes of second and of fourth order leave of a difference to half the cells, and of second to twice the cells.
const TO_HALF: [f64; 2] = [1.0 / 3.0, 1.0 / 15.0];
const TO_TWICE: f64 = 4.0 / 3.0;

/// By how much meshes are off, `s` of an ever finer one less `s` [1/s]; none where the mesh was not changed, or where the other one has no
/// such mode.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ByMesh {
    /// Along the beam.
    pub beam: Option<Complex<f64>>,
    /// Along bladders.
    pub bladders: Option<Complex<f64>>,
    /// Whether cells of the beam are of fourth order: a part of what they leave out may then be of second, and their error be as large as that.
    pub fourth: bool,
}

impl ByMesh {
    /// What it may be off by: along the beam, and along bladders [1/s].
    pub fn off(&self) -> impl Iterator<Item = Complex<f64>> {
        let [second, fourth] = TO_HALF;
        let by = if self.fourth { second / fourth } else { 1.0 };
        self.beam.map(|beam| beam * by).into_iter().chain(self.bladders)
    }
}

/// Looks for the same modes on other meshes, about the start or the equilibrium under the loads of an instant [s].
///
/// # Errors
/// None: a mesh on which there are no modes, or not these, leaves what it does unknown.
pub fn compare_meshes(case: &Case, at_rest_under: Option<f64>, plan: &Plan, found: &mut Modes) {
    let at = found.about.at;
    let about = |case: &Case| match at_rest_under {
        Some(at) => at_equilibrium(case, at),
        None => linearise(case, at, None),
    };
    if let Some(coarse) = halved(case) {
        along_the_beam(about(&coarse), plan, found);
    }
    let flows = found.about.flows() && found.about.system().model.effects.has(Effect::FlowAlongBladders);
    found.bladders_compared = flows;
    if flows {
        let mut fine = case.clone();
        fine.mesh.cells_per_bladder *= 2;
        along_bladders(about(&fine), plan, found);
    }
}

/// The case on half the cells, where they can be halved.
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

fn along_the_beam(about: Result<Linearised>, plan: &Plan, found: &mut Modes) {
    let fourth = found.about.system().mesh.fourth;
    // a mesh of few cells is of another order
    if about.as_ref().is_ok_and(|other| other.system().mesh.fourth != fourth) {
        return;
    }
    let every_other: Vec<Mode> = found
        .modes
        .iter()
        .map(|mode| Mode {
            shape: mode.shape.on_every_other_node(),
            ..mode.clone()
        })
        .collect();
    let Some((others, pairs)) = elsewhere(about, plan, &every_other, found) else {
        return;
    };
    for (k, j, likeness) in pairs {
        let (mode, other) = (&mut found.modes[k], &others[j]);
        mode.by_mesh.beam = Some((mode.s - other.s) * TO_HALF[usize::from(fourth)]);
        mode.by_mesh.fourth = fourth;
        mode.coarse = other
            .frequency_hz()
            .map(|frequency_hz| Limit { frequency_hz, likeness });
    }
}

fn along_bladders(about: Result<Linearised>, plan: &Plan, found: &mut Modes) {
    let modes = found.modes.clone();
    let Some((others, pairs)) = elsewhere(about, plan, &modes, found) else {
        return;
    };
    for (k, j, _) in pairs {
        let mode = &mut found.modes[k];
        mode.by_mesh.bladders = Some((others[j].s - mode.s) * TO_TWICE);
    }
}

/// More modes than are asked for, since the last ones may change places.
const MORE: usize = 4;

/// Modes about a state on another mesh, and which of them are which.
#[allow(clippy::type_complexity)]
fn elsewhere(
    about: Result<Linearised>,
    plan: &Plan,
    modes: &[Mode],
    found: &mut Modes,
) -> Option<(Vec<Mode>, Vec<(usize, usize, f64)>)> {
    let about = about.ok()?;
    let mut tally = Tally::default();
    let others = [MORE, 0].into_iter().find_map(|more| {
        let plan = Plan {
            count: plan.count + more,
            ..*plan
        };
        search(&about, Fluid::Flowing, &plan, &mut tally).ok()
    })?;
    found.factorizations += tally.factorizations;
    found.solves += tally.solves;
    let mut pairs = swinging(modes, &others);
    pairs.extend(real(modes, &others, about.system().model.length));
    Some((others, pairs))
}

/// How near each other two modes are in how fast they are: 1 where they are the same.
fn as_fast(a: &Mode, b: &Mode) -> f64 {
    let [a, b] = [a, b].map(|mode| mode.s.norm());
    (a * b).sqrt() * 2.0 / (a + b)
}

/// Power of [`as_fast`] beside the likeness of shapes: a fifth in frequency then costs 6 %, half of it 28 %.
const SHARP: i32 = 16;

/// Pairs of what swings, with the likeness of their shapes: the most alike in displacements and in how fast they are. What swings in the fluid moves the beam
/// a little, and all of it much alike.
fn swinging(modes: &[Mode], others: &[Mode]) -> Vec<(usize, usize, f64)> {
    let swings = |mode: &Mode| mode.kind.swings();
    let pairs = super::paired(modes, others, swings, |a, b| {
        likeness(&a.shape, &b.shape) * as_fast(a, b).powi(SHARP)
    });
    let with_likeness = |(k, j, _): (usize, usize, f64)| (k, j, likeness(&modes[k].shape, &others[j].shape));
    pairs.into_iter().map(with_likeness).collect()
}

/// Pairs of what decays, or grows, without swinging: the most alike in displacements and pressures together, and in how fast they do. Of
/// flows to and fro within bladders neither tells much: what is left goes in the order in which it was found.
fn real(modes: &[Mode], others: &[Mode], length: f64) -> Vec<(usize, usize, f64)> {
    let real = |mode: &Mode| !mode.kind.swings() && !mode.kind.stays();
    let mut pairs = super::paired(modes, others, real, |a, b| {
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

/// Modes told by name.
const TOLD: usize = 4;

/// What to know of modes that meshes change by much, or of which it is not known.
pub fn warning(found: &Modes) -> Option<String> {
    let mut large: Vec<(usize, f64, &str)> = vec![];
    let mut unknown: Vec<String> = vec![];
    for (k, mode) in found.modes.iter().enumerate().filter(|(_, mode)| !mode.kind.stays()) {
        let worst = [("frequency", mode.mesh_error()), ("rate", mode.rate_error())]
            .into_iter()
            .filter_map(|(what, error)| Some((what, error?)))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        match worst {
            Some((what, error)) if error > LARGE => large.push((k + 1, error, what)),
            _ if found.bladders_compared && mode.by_mesh.bladders.is_none() => unknown.push((k + 1).to_string()),
            _ => {}
        }
    }
    large.sort_by(|a, b| b.1.total_cmp(&a.1));
    let more = large.len().saturating_sub(TOLD);
    let mut told: Vec<String> = large
        .into_iter()
        .take(TOLD)
        .map(|(k, error, what)| format!("the {what} of mode {k} by about {:.0} %", 100.0 * error))
        .collect();
    if more > 0 {
        told.push(format!("{more} more"));
    }
    let mut sentences = vec![];
    if !told.is_empty() {
        sentences.push(format!("meshes may be off in {}", told.join(", ")));
    }
    if !unknown.is_empty() {
        let plural = if unknown.len() == 1 { "" } else { "s" };
        sentences.push(format!(
            "what the mesh along bladders does to mode{plural} {} is not known",
            unknown.join(", ")
        ));
    }
    (!sentences.is_empty()).then(|| {
        Code::ErrorEstimate.warning(format!(
            "estimate: {}; more /mesh/cells_per_bladder or /mesh/cells_per_segment, or --accuracy, which refines both",
            sentences.join("; ")
        ))
    })
}
