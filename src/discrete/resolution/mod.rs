//! Resolution of loads and initial values by the mesh.
//!
//! Loads on the mesh have their exact force and moment, so that M is exact at nodes; its variation between two nodes is lost. Each shape
//! is judged by its effect on the beam. A narrow load far from supports acts only by its force. A wave shorter than a cell only causes
//! bending between the nodes. Initial values are judged by their energy, and by the phase errors of their short waves during a run.

mod initial_values;
mod load_distribution;
mod ports;
mod statics;
mod tapers;
mod vibrations;

use crate::case::schema::Case;
use crate::case::schema::Effect;
use crate::case::wiring::bladder_index;
use crate::error::Code;
use crate::functions::profile::{Integrals, Profile};
use crate::functions::signals::Signal;
use crate::model::{DistributedLoad, Model, Storage};

use super::System;
use super::shapes::{self, Cells};
use initial_values::InitialShape;
pub use ports::JumpIntoBladder;
use statics::Shape;
use tapers::Taper;

/// Relative mesh error of a shape's effect above which there is a warning.
pub const LIMIT: f64 = 0.05;

/// Largest number of cells per segment, or per bladder, in the search for a sufficient mesh.
pub const FINEST: usize = 1024;

/// Mesh error of one shape.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshFinding {
    /// JSON pointer in the case; that of the first load if several act together.
    pub pointer: String,
    /// Description of the lost quantity.
    pub what: &'static str,
    /// Relative mesh error.
    pub left_out: f64,
    /// Number of cells per segment, or per bladder, with an error below [`LIMIT`]; none if even the finest mesh exceeds it.
    pub wanted: Option<usize>,
    /// Mesh setting that determines the error.
    pub setting: &'static str,
    /// True if the error also affects a state at rest; false if it affects only changes in time.
    pub at_rest: bool,
}

/// Mesh error of one shape for a given number of cells.
pub(super) struct LeftOut {
    /// Relative mesh error.
    pub share: f64,
    /// Description of the lost quantity.
    pub what: &'static str,
    /// Same as [`Finding::at_rest`].
    pub at_rest: bool,
}

impl From<(f64, &'static str)> for LeftOut {
    /// For a shape that also exists in a state at rest.
    fn from((share, what): (f64, &'static str)) -> Self {
        let at_rest = true;
        Self { share, what, at_rest }
    }
}

/// Mesh errors of all shapes of a case, above or below [`LIMIT`].
pub fn findings(case: &Case, system: &System) -> Vec<MeshFinding> {
    of_beam_and_bladders(case, system, true)
}

/// Mesh errors at the start, and, if `later`, also those during the motion.
fn of_beam_and_bladders(case: &Case, system: &System, later: bool) -> Vec<MeshFinding> {
    let (segments, cells) = (system.mesh.segments, system.mesh.cells_per_segment);
    let along = "/mesh/cells_per_segment";
    let mut all = vec![];
    if case.is_structure() {
        return all; // shapes are those of single beams; a companion judges the mesh
    }
    for shape in loads_along(case, &system.model) {
        let on = |cells: usize| (shape.left_out(segments * cells), shape.what()).into();
        all.push(finding(shape.pointer.clone(), cells, along, on));
    }
    // a circle is not touched between two nodes of a chord
    for (k, law) in system.model.contacts.iter().enumerate() {
        let (None, Some(radius)) = (law.at, law.bend_radius()) else {
            continue;
        };
        let on = |cells: usize| {
            let turn = system.model.length / (segments * cells) as f64 / radius;
            (0.125 * turn * turn, "the distance from its center between two nodes").into()
        };
        all.push(finding(format!("/contacts/{k}/circle"), cells, along, on));
    }
    for taper in Taper::all(case) {
        let on = |cells: usize| (taper.left_out(cells), tapers::WHAT).into();
        all.push(finding(taper.pointer.clone(), cells, along, on));
    }
    for begun in InitialShape::all(case, system) {
        let on = |cells: usize| {
            let cells = segments * cells;
            match later {
                true => begun.left_out(cells).into(),
                false => begun.at_once(cells).into(),
            }
        };
        all.push(finding(begun.pointer(), cells, along, on));
    }
    if let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid)
        && system.model.effects.has(Effect::FlowAlongBladders)
    {
        let along = "/mesh/cells_per_bladder";
        for port in ports::ports(case, &system.model, wet).into_iter().filter(|_| later) {
            let on = |cells| port.left_out(cells);
            all.push(finding(port.pointer(), fluid.cells_per_bladder, along, on));
        }
        for (k, start) in case.start.pressures.iter().enumerate() {
            let mut bladders = start.bladders.iter().filter_map(|b| bladder_index(*b, wet.per_row));
            if bladders.any(|b| wet.storage[b] == Storage::Flowing) {
                let on = |cells| of_means(&start.pressure_pa, cells).into();
                let pointer = format!("/start/pressures/{k}/pressure_pa");
                all.push(finding(pointer, fluid.cells_per_bladder, along, on));
            }
        }
    }
    all
}

/// Ports whose largest flow grows without limit as the mesh is refined: their pressure jumps, and the fluid has no inertia.
pub fn jumps_into_bladders(case: &Case, model: &Model) -> Vec<JumpIntoBladder> {
    let diffuses = model.effects.has(Effect::FlowAlongBladders) && !model.effects.has(Effect::BladderInertia);
    let wet = model.wet.as_ref().filter(|_| diffuses);
    wet.map(|wet| ports::jumps_into_bladders(case, wet)).unwrap_or_default()
}

/// Mesh errors above [`LIMIT`].
pub fn unresolved(case: &Case, system: &System) -> Vec<MeshFinding> {
    let mut all = findings(case, system);
    all.retain(|finding| finding.left_out > LIMIT);
    all
}

/// Numbers of cells per segment and per bladder that resolve every shape as given; those of the case if they suffice, or if no number
/// does.
pub fn cells_that_resolve(case: &Case, system: &System) -> [usize; 2] {
    let all = of_beam_and_bladders(case, system, false);
    ["/mesh/cells_per_segment", "/mesh/cells_per_bladder"].map(|setting| {
        let those = all.iter().filter(|finding| finding.setting == setting);
        those.filter_map(|finding| finding.wanted).fold(0, usize::max)
    })
}

/// Number of cells by a mesh setting, `cells` in the case, that resolves all shapes of these findings: at least twice as many, and at most
/// `most`. None without a finding.
pub fn finer<'a>(
    findings: impl IntoIterator<Item = &'a MeshFinding>,
    setting: &str,
    cells: usize,
    most: usize,
) -> Option<usize> {
    let of = findings.into_iter().filter(|finding| finding.setting == setting);
    let wanted = of.map(|finding| finding.wanted.unwrap_or(usize::MAX)).max();
    wanted.map(|wanted| wanted.clamp(2 * cells, most))
}

/// A warning for every unresolved shape.
pub fn warnings(case: &Case, system: &System) -> Vec<String> {
    warnings_of(unresolved(case, system))
}

/// A warning for every unresolved shape that also exists in a state at rest.
pub fn warnings_at_rest(case: &Case, system: &System) -> Vec<String> {
    let mut all = unresolved(case, system);
    all.retain(|finding| finding.at_rest);
    warnings_of(all)
}

fn warnings_of(findings: Vec<MeshFinding>) -> Vec<String> {
    let warning = |finding: MeshFinding| {
        let advice = match finding.wanted {
            Some(cells) => format!("Use {cells} in {}", finding.setting),
            None => format!("Even {FINEST} in {} do not resolve it", finding.setting),
        };
        Code::Unresolved.warning(format!(
            "mesh: {} is not resolved: the error of {} is {:.0} % (limit {:.0} %). {advice}",
            finding.pointer,
            finding.what,
            100.0 * finding.left_out.min(9.99),
            100.0 * LIMIT
        ))
    };
    findings.into_iter().map(warning).collect()
}

fn finding(pointer: String, cells: usize, setting: &'static str, left_out: impl Fn(usize) -> LeftOut) -> MeshFinding {
    let here = left_out(cells);
    let doubled = std::iter::successors(Some(cells), |cells| Some(2 * cells));
    let wanted = if here.share > LIMIT {
        doubled
            .skip(1)
            .take_while(|cells| *cells <= FINEST)
            .find(|cells| left_out(*cells).share <= LIMIT)
    } else {
        Some(cells)
    };
    MeshFinding {
        pointer,
        what: here.what,
        left_out: here.share,
        wanted,
        setting,
        at_rest: here.at_rest,
    }
}

/// Active loads along the beam, combined if they have a common time function.
fn loads_along(case: &Case, model: &Model) -> Vec<Shape> {
    let mut groups: Vec<(Option<&Signal>, Shape)> = vec![];
    // the rotation of every cell by rest curvature is exact
    for (k, written) in case.loads.iter().enumerate().filter(|(_, load)| !load.is_rest()) {
        let signal = written.distributed().map(|(_, load)| &load.signal);
        // Constant loads act together, whatever their values.
        let (signal, constant) = match signal {
            Some(Signal::Constant(value)) => (None, *value),
            signal => (signal, 1.0),
        };
        for load in DistributedLoad::resolve(written, &model.section) {
            let part = Shape::new(format!("/loads/{k}"), load, constant, model);
            let known = groups
                .iter()
                .position(|(s, shape)| *s == signal && shape.acts_with(&part));
            match known {
                Some(place) => groups[place].1.join(part),
                None => groups.push((signal, part)),
            }
        }
    }
    let across = !model.effects.has(Effect::TransverseMotion);
    groups
        .into_iter()
        .map(|(_, shape)| shape)
        .filter(|shape| !(across && shape.bends()))
        .collect()
}

/// Relative error of a pressure by averaging over cells: that of its root mean square, or of its largest value, whichever is larger.
fn of_means(profile: &Profile, cells: usize) -> (f64, &'static str) {
    let means = shapes::in_cells(profile, &Cells::equal(cells));
    let square = change(means.iter().map(|p| p * p).sum::<f64>() / cells as f64, profile);
    let exact = profile.size();
    let seen = means.iter().fold(0.0, |most: f64, p| most.max(p.abs()));
    let largest = ratio((exact - seen).max(0.0), exact, exact);
    if largest > square {
        (largest, "the largest pressure along the bladder at the start")
    } else {
        (square, "the pressure along the bladder at the start")
    }
}

/// Relative error of a root mean square.
fn change(on_mesh: f64, profile: &Profile) -> f64 {
    let square = Profile::Product(vec![profile.clone(), profile.clone()]);
    let exact = Integrals::new(&square).moments(0.0, 1.0)[0].max(0.0).sqrt();
    ratio((on_mesh.sqrt() - exact).abs(), exact, exact)
}

/// Ratio to a quantity that may vanish up to rounding errors.
fn ratio(part: f64, whole: f64, scale: f64) -> f64 {
    let floor = 1e-12 * scale;
    if whole <= floor { 0.0 } else { part / whole }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::functions::signals::Polynomial;

    /// Goal: for a pressure with its maximum between two cells, the error of the root mean square is 9 %, that of the largest value a
    /// third.
    #[test]
    fn largest_values_between_cells_are_missed() {
        let hill = Profile::Polynomial(Polynomial {
            coefficients: vec![0.0, 4.0, -4.0],
        });
        let (off, what) = of_means(&hill, 2);
        assert!((off - 1.0 / 3.0).abs() < 2e-3, "{off}");
        assert!(what.contains("largest"), "{what}");
        assert!(of_means(&hill, 8).0 < LIMIT);
        assert!(of_means(&Profile::Constant(3.0), 1).0 < 1e-12);
    }
}
