//! What a mesh does not see of loads and of the start.
//!
//! Loads reach the mesh with the force and the moment that they have, so that M is right at nodes; how it goes between two nodes is
//! left out. Each shape is judged by what that does to the beam: a narrow load far from what holds the beam is nothing but its force,
//! a wave shorter than a cell is all bending between the nodes.

mod held;
mod ports;
mod statics;

use crate::case::profile::{Integrals, Profile};
use crate::case::schema::Case;
use crate::case::signals::Signal;
use crate::error::Code;
use crate::model::network::bladder_index;
use crate::model::{Load, Model, Storage};

use super::{System, shapes};
use statics::Shape;

/// Share of a shape's effect beyond which leaving it out is told.
pub const LIMIT: f64 = 0.05;

/// Cells in a segment, or in a bladder, up to which a mesh that resolves is looked for.
const FINEST: usize = 1024;

/// How much of one shape the mesh leaves out.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Where it stands in the case; of several loads that act together, of the first.
    pub pointer: String,
    /// What is left out, in words.
    pub what: &'static str,
    /// The share of it that is left out.
    pub left_out: f64,
    /// Cells in a segment, or in a bladder, that leave out less than [`LIMIT`]; nothing where no mesh up to the finest does.
    pub wanted: Option<usize>,
    /// Setting of the mesh that decides.
    pub setting: &'static str,
}

/// Everything that the mesh of a system leaves out of the shapes of its case, by more than [`LIMIT`] or not.
pub fn findings(case: &Case, system: &System) -> Vec<Finding> {
    let (segments, cells) = (system.mesh.segments, system.mesh.cells_per_segment);
    let mut all = vec![];
    for shape in shapes_along(case, &system.model) {
        let on = |cells: usize| shape.left_out(segments * cells);
        all.push(finding(
            shape.pointer(),
            shape.what(),
            cells,
            "/mesh/cells_per_segment",
            on,
        ));
    }
    if let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid)
        && system.model.effects.flow_along_bladders
    {
        for pulse in ports::pulses(case, wet) {
            all.push(finding(
                pulse.pointer(),
                "pressure along the bladder behind it",
                fluid.cells_per_bladder,
                "/mesh/cells_per_bladder",
                |cells| pulse.left_out(cells),
            ));
        }
        for (k, start) in case.start.pressures.iter().enumerate() {
            let flows = |b: &i64| wet.storage[bladder_index(*b, wet.per_row)] == Storage::Flowing;
            if start.bladders.iter().any(flows) {
                all.push(finding(
                    format!("/start/pressures/{k}/pressure_pa"),
                    "pressure along the bladder at the start",
                    fluid.cells_per_bladder,
                    "/mesh/cells_per_bladder",
                    |cells| of_means(&start.pressure_pa, cells),
                ));
            }
        }
    }
    all
}

/// What the mesh leaves out by more than [`LIMIT`].
pub fn unresolved(case: &Case, system: &System) -> Vec<Finding> {
    let mut all = findings(case, system);
    all.retain(|finding| finding.left_out > LIMIT);
    all
}

/// Cells in a segment that resolve every shape along the beam; those of the case where they do, or where none do.
pub fn cells_that_resolve(case: &Case, system: &System) -> usize {
    unresolved(case, system)
        .iter()
        .filter(|finding| finding.setting == "/mesh/cells_per_segment")
        .filter_map(|finding| finding.wanted)
        .fold(system.mesh.cells_per_segment, usize::max)
}

/// A warning for every shape that is not resolved.
pub fn warnings(case: &Case, system: &System) -> Vec<String> {
    let told = |finding: Finding| {
        let advice = match finding.wanted {
            Some(cells) => format!("{cells} in {} resolve it", finding.setting),
            None => format!("{FINEST} in {} would not resolve it", finding.setting),
        };
        Code::Unresolved.warning(format!(
            "mesh: {} is not resolved: {} is off by {:.0} % of itself; {advice}",
            finding.pointer,
            finding.what,
            100.0 * finding.left_out.min(9.99)
        ))
    };
    unresolved(case, system).into_iter().map(told).collect()
}

fn finding(
    pointer: String,
    what: &'static str,
    cells: usize,
    setting: &'static str,
    left_out: impl Fn(usize) -> f64,
) -> Finding {
    let here = left_out(cells);
    let doubled = std::iter::successors(Some(cells), |cells| Some(2 * cells));
    let wanted = if here > LIMIT {
        doubled
            .skip(1)
            .take_while(|cells| *cells <= FINEST)
            .find(|cells| left_out(*cells) <= LIMIT)
    } else {
        Some(cells)
    };
    Finding {
        pointer,
        what,
        left_out: here,
        wanted,
        setting,
    }
}

/// Shapes along the beam that take part: loads of one time function together, for they act together.
fn shapes_along<'a>(case: &'a Case, model: &Model) -> Vec<Along<'a>> {
    let mut groups: Vec<(Option<&'a Signal>, Shape)> = vec![];
    for (k, written) in case.loads.iter().enumerate() {
        let signal = written.distributed().map(|(_, load)| &load.signal);
        // Loads that never change act together whatever their values.
        let (signal, constant) = match signal {
            Some(Signal::Constant(value)) => (None, *value),
            signal => (signal, 1.0),
        };
        for load in Load::resolve(written, model.section.mass_per_length) {
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
    let across = !model.effects.transverse_motion;
    let mut all: Vec<Along> = groups
        .into_iter()
        .map(|(_, shape)| shape)
        .filter(|shape| !(across && shape.bends()))
        .map(Along::Load)
        .collect();
    let start = &case.start;
    let given = [
        ("u1_m", &start.u1_m, true),
        ("u3_m", &start.u3_m, true),
        ("u1_rate_m_s", &start.u1_rate_m_s, false),
        ("u3_rate_m_s", &start.u3_rate_m_s, false),
    ];
    for (key, profile, displacement) in given {
        if let Some(profile) = profile {
            all.push(if displacement {
                Along::Displacement(key, profile)
            } else {
                Along::Velocity(key, profile)
            });
        }
    }
    all
}

/// Something along the beam that the mesh resolves or not.
enum Along<'a> {
    Load(Shape),
    Displacement(&'static str, &'a Profile),
    Velocity(&'static str, &'a Profile),
}

impl Along<'_> {
    fn pointer(&self) -> String {
        match self {
            Self::Load(shape) => shape.pointer.clone(),
            Self::Displacement(key, _) | Self::Velocity(key, _) => format!("/start/{key}"),
        }
    }

    fn what(&self) -> &'static str {
        match self {
            Self::Load(shape) if shape.bends() => "the bending moment of this load between the nodes",
            Self::Load(_) => "the normal force of this load within the cells",
            Self::Displacement(..) => "the displacement between the nodes",
            Self::Velocity(..) => "the velocity between the nodes",
        }
    }

    fn left_out(&self, cells: usize) -> f64 {
        match self {
            Self::Load(shape) => shape.left_out(cells),
            Self::Displacement(_, profile) => of_lines(profile, cells),
            Self::Velocity(_, profile) => of_squares(profile, cells),
        }
    }
}

/// Largest distance of a function from the lines through its values at the nodes, over its largest distance from the line
/// through its ends: moving and turning the beam as a whole costs no mesh anything.
fn of_lines(profile: &Profile, cells: usize) -> f64 {
    let integrals = Integrals::of(profile);
    let line = |a: f64, b: f64, x: f64| {
        let t = (x - a) / (b - a);
        profile.value(a) * (1.0 - t) + profile.value(b) * t
    };
    let (mut lost, mut whole, mut largest) = (0.0_f64, 0.0_f64, 0.0_f64);
    for (a, b) in (0..cells).map(|c| shapes::within(c, cells)) {
        for x in shapes::places(&integrals, a, b).into_iter().chain([a, b]) {
            let value = profile.value(x);
            lost = lost.max((value - line(a, b, x)).abs());
            whole = whole.max((value - line(0.0, 1.0, x)).abs());
            largest = largest.max(value.abs());
        }
    }
    ratio(lost, whole, largest)
}

/// Change of the root of the mean square of a velocity: the root of its kinetic energy.
fn of_squares(profile: &Profile, cells: usize) -> f64 {
    let values = shapes::nearest(profile, cells);
    let inner: f64 = values[1..cells].iter().map(|v| v * v).sum();
    let ends = 0.5 * (values[0] * values[0] + values[cells] * values[cells]);
    change((inner + ends) / cells as f64, profile)
}

/// Change of the root of the mean square of a pressure by taking means over cells.
fn of_means(profile: &Profile, cells: usize) -> f64 {
    let means = shapes::in_cells(profile, cells);
    change(means.iter().map(|p| p * p).sum::<f64>() / cells as f64, profile)
}

/// Change of a root of a mean square.
fn change(on_mesh: f64, profile: &Profile) -> f64 {
    let square = Profile::Product(vec![profile.clone(), profile.clone()]);
    let exact = Integrals::of(&square).moments(0.0, 1.0)[0].max(0.0).sqrt();
    ratio((on_mesh.sqrt() - exact).abs(), exact, exact)
}

/// A share of something that may vanish to round-off.
fn ratio(part: f64, whole: f64, scale: f64) -> f64 {
    let floor = 1e-12 * scale;
    if whole <= floor { 0.0 } else { part / whole }
}
