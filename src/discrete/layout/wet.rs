//! Unknowns of bladders and of their network.

use std::ops::Range;

use super::{Builder, Name};
use crate::discrete::fluid_mesh::{LinkEnd, MeshFlow, MeshLink};
use crate::discrete::{BeamMesh, FluidMesh, injected_volume};
use crate::model::{LumpedKind, Model, Wet};

/// Scale of an injected volume relative to its size: it is one of many unknowns in the error test, and all work follows from it.
const CLOSELY: f64 = 0.1;

/// Coupling variables of segments and bladders.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CouplingUnknowns {
    /// Mean moments `Mbar_j`.
    pub mean_moment: Range<usize>,
    /// Mean forces `Nbar_j`.
    pub mean_force: Range<usize>,
    /// Area changes of bladders by the section's energy at finite strain, and by the pressure of the other bladder.
    pub excess_area: Range<usize>,
    /// The bladders of these unknowns.
    pub excess_bladders: Vec<usize>,
}

/// Unknowns of the fluid.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NetworkUnknowns {
    /// Stored areas of cells.
    pub area: Range<usize>,
    /// Pressures of junctions, or volumes of junctions with an accumulator.
    pub junction: Range<usize>,
    /// Pressure drops of turbines behind bridges of check valves.
    pub bridge: Range<usize>,
    /// Flows of tubes that are not given by pressures alone.
    pub flow: Range<usize>,
    /// Flows of their friction branches.
    pub branch: Range<usize>,
    /// Pressure of each lumped network, if it is unknown.
    pub lumped_pressure: Vec<Option<usize>>,
    /// Volume of each lumped network, if it is unknown.
    pub lumped_volume: Vec<Option<usize>>,
    /// Injected volume of each source of prescribed volume, with its number; no equation contains it, but its error controls the steps.
    pub let_in: Vec<(usize, usize)>,
}

impl CouplingUnknowns {
    pub(super) fn new(model: &Model, wet: &Wet, mesh: &BeamMesh, build: &mut Builder) -> Self {
        let segments = |takes: bool| if takes { mesh.segments } else { 0 };
        let excess_bladders: Vec<usize> = (0..2 * wet.per_row).filter(|b| wet.has_excess(*b)).collect();
        Self {
            mean_moment: build.segments("mean moment [N m]", segments(wet.takes_moments), model.scales.moment),
            mean_force: build.segments("mean normal force [N]", segments(wet.takes_forces), model.scales.force),
            excess_area: build.block(|build| {
                let scale = wet.area[0].per_pressure * model.scales.pressure;
                for &bladder in &excess_bladders {
                    build.push(Name::ExcessArea(bladder), scale, scale, false);
                }
            }),
            excess_bladders,
        }
    }

    /// Unknown excess of the area of a bladder.
    pub fn excess_of(&self, bladder: usize) -> Option<usize> {
        let place = self.excess_bladders.binary_search(&bladder).ok()?;
        Some(self.excess_area.start + place)
    }

    /// Bladders with an unknown excess of area, each with the unknown.
    pub fn excess(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.excess_bladders.iter().copied().zip(self.excess_area.clone())
    }
}

impl NetworkUnknowns {
    pub(super) fn new(model: &Model, wet: &Wet, fluid: &FluidMesh, build: &mut Builder) -> Self {
        let s = &model.scales;
        let stored = wet.compliance() * s.pressure;
        // the remaining cross-section of touching walls must be as accurate as pressures
        let area_size = wet
            .closing
            .map_or(stored, |closing| stored.min(closing.touching(&wet.area[0])));
        let area = build.block(|build| {
            for &bladder in &fluid.flowing {
                for cell in 0..fluid.cells_per_bladder {
                    let name = Name::Area(bladder, cell);
                    build.push(name, area_size, area_size * fluid.ds * s.frequency, true);
                }
            }
        });
        let junction = build.block(|build| {
            for (k, &j) in fluid.junctions.iter().enumerate() {
                match fluid.accumulators.iter().find(|one| one.junction == k) {
                    None => build.push(Name::Junction(j), s.pressure, s.pressure * fluid.conductance, false),
                    Some(one) => {
                        let name = one.number.map_or(Name::Stored(j), Name::Accumulator);
                        let volume = wet.vessel_content(&one.law, s.pressure);
                        build.push(name, volume, volume * s.frequency, true)
                    }
                };
            }
        });
        let bridge = build.block(|build| {
            for bridge in &fluid.bridges {
                let turbine = wet.network.bridges[bridge.number].turbine;
                let conductance = wet.network.turbines[turbine].conductance;
                build.push(Name::Bridge(bridge.number), s.pressure, s.pressure * conductance, false);
            }
        });
        let tubes = wet.network.tube_numbers();
        let name = |link: &MeshLink, what: &'static str| match (link.number, link.to) {
            (None, LinkEnd::Cell(to)) => Name::Face(what, to / fluid.cells_per_bladder, to % fluid.cells_per_bladder),
            (number, _) => Name::Flow(what, number.map_or(0, |number| tubes[number])),
        };
        let moved = |link: &MeshLink| (stored * wet.bladder_length * s.frequency).min(s.pressure / link.in_series());
        let flows = || fluid.links.iter().filter_map(|link| Some((link, link.flow?)));
        let flow = build.block(|build| {
            for (link, MeshFlow { law, .. }) in flows() {
                let name = name(link, "flow [m^3/s]");
                let row = if link.check_valve.is_some() {
                    moved(link)
                } else {
                    s.pressure
                };
                build.push(name, moved(link), row, law.inertance > 0.0);
            }
        });
        let branch = build.block(|build| {
            for (link, MeshFlow { law, .. }) in flows() {
                let name = name(link, "flow [m^3/s] in the memory of friction");
                for (_, rate) in law.branches() {
                    build.push(name, moved(link), moved(link) * rate.max(s.frequency), true);
                }
            }
        });
        let (mut lumped_pressure, mut lumped_volume) = (vec![], vec![]);
        for lumped in &wet.lumped {
            let volume = stored * wet.bladder_length * lumped.bladders.len() as f64;
            let name = |what| Name::LumpedNetwork(what, lumped.component);
            let closed = lumped.kind == LumpedKind::Closed;
            let fed = matches!(lumped.kind, LumpedKind::Fed(_));
            lumped_pressure.push((closed || fed).then(|| build.push(name("pressure [Pa]"), s.pressure, volume, false)));
            let rate = volume * s.frequency;
            lumped_volume.push(fed.then(|| build.push(name("volume change [m^3]"), volume, rate, true)));
        }
        let sources = 0..wet.network.sources.len();
        let paced =
            sources.filter(|&source| wet.flows && wet.network.paced && injected_volume::is_kept(&wet.network, source));
        let let_in = paced.map(|source| {
            let compliance = wet.network.compliance_at(wet.network.sources[source].into, wet);
            let volume = CLOSELY * (compliance * s.pressure).max(stored * fluid.ds);
            (
                build.push(Name::LetIn(source), volume, volume * s.frequency, true),
                source,
            )
        });
        let let_in = let_in.collect();
        Self {
            area,
            junction,
            bridge,
            flow,
            branch,
            lumped_pressure,
            lumped_volume,
            let_in,
        }
    }
}
