//! Volume injected by ports of prescribed volume, and the unknowns that are relative to it.

use super::fluid_mesh::{FluidMesh, LinkEnd, MeshLink};
use super::{System, TimeData};
use crate::model::network::{Feed, PrescribedFlow, ResolvedNetwork};
use crate::model::{LumpedKind, LumpedNetwork, Wet};
use crate::numerics::sets::Sets;

/// Storage of fluid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Store {
    /// A cell; its unknown is an area.
    Cell(usize),
    /// An accumulator, by its number on the mesh; its unknown is a volume.
    Vessel(usize),
}

/// A store whose unknown is relative to a share of the volume injected by a source, [E22].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InjectedShare {
    /// Number among the network's sources.
    pub source: usize,
    /// Store that receives the share.
    pub store: Store,
    /// Change of the store's unknown with that volume: 1/m for a cell, 1 for an accumulator that receives everything.
    pub share: f64,
}

/// Shares of all sources that prescribe a volume. The volume is distributed by compliance over the stores connected without valves, or,
/// if there are none, over all connected stores. The unknown of each store is therefore small, and exact if a valve closes. There are no
/// shares if a port of given pressure releases the volume again, because little of it may remain.
pub fn shares(fluid: &FluidMesh, wet: &Wet) -> Vec<InjectedShare> {
    let network = &wet.network;
    let mut all = vec![];
    if network.still {
        return all;
    }
    let opens = |link: &&MeshLink| {
        let opening = link.number.and_then(|number| network.links[number].opening.as_ref());
        link.check_valve.is_none() && opening.is_none()
    };
    for source in &fluid.sources {
        if !is_kept(network, source.number) {
            continue;
        }
        let open = joined(
            fluid,
            source.into,
            fluid.links.iter().filter(opens).map(|l| (l.from, l.to)),
        );
        let links = fluid.links.iter().map(|l| (l.from, l.to));
        let bridged = fluid.bridges.iter().map(|b| (b.from, b.to));
        for places in [open, joined(fluid, source.into, links.chain(bridged))] {
            let stores = stores(fluid, wet, &places);
            let sum: f64 = stores.iter().map(|(_, compliance)| compliance).sum();
            if sum > 0.0 {
                all.extend(stores.into_iter().map(|(store, compliance)| InjectedShare {
                    source: source.number,
                    store,
                    share: compliance / sum / if let Store::Cell(_) = store { fluid.ds } else { 1.0 },
                }));
                break;
            }
        }
    }
    all
}

/// True if a source prescribes a volume, and no port of given pressure releases it from its network.
pub fn is_kept(network: &ResolvedNetwork, source: usize) -> bool {
    let PrescribedFlow { into, feed, .. } = &network.sources[source];
    matches!(feed, Feed::Volume(_)) && network.component_of(*into).is_some_and(|own| !network.lets_out(own))
}

/// For each cell, then each junction: true if links connect it to the place `to`; neighboring cells of a bladder are connected.
fn joined(fluid: &FluidMesh, to: LinkEnd, links: impl Iterator<Item = (LinkEnd, LinkEnd)>) -> Vec<bool> {
    let index = |place: LinkEnd| match place {
        LinkEnd::Cell(c) => Some(c),
        LinkEnd::Junction(j) => Some(fluid.cells + j),
        LinkEnd::Port(_) => None,
    };
    let mut sets = Sets::new(fluid.cells + fluid.junctions.len());
    for [a, b] in fluid.faces() {
        sets.join(a, b);
    }
    for (a, b) in links.filter_map(|(a, b)| index(a).zip(index(b))) {
        sets.join(a, b);
    }
    let own = index(to).map(|place| sets.root(place));
    let places = 0..fluid.cells + fluid.junctions.len();
    places.map(|place| Some(sets.root(place)) == own).collect()
}

/// Stores in connected places, with their compliances [m^3/Pa].
fn stores(fluid: &FluidMesh, wet: &Wet, reached: &[bool]) -> Vec<(Store, f64)> {
    let cells = (0..fluid.cells).filter(|&c| reached[c]);
    let cells = cells.map(|c| (Store::Cell(c), wet.compliance() * fluid.ds));
    let vessels = fluid.accumulators.iter().enumerate();
    let vessels = vessels.filter(|(_, one)| reached[fluid.cells + one.junction]);
    let vessels = vessels.map(|(k, one)| (Store::Vessel(k), wet.vessel_compliance(&one.law, 0.0)));
    cells.chain(vessels).collect()
}

/// Volume injected into a lumped network by ports of prescribed volume [m^3], and its rate [m^3/s].
pub fn into_lumped(wet: &Wet, lumped: &LumpedNetwork, now: &TimeData) -> [f64; 2] {
    let LumpedKind::Fed(sources) = &lumped.kind else {
        return [0.0; 2];
    };
    let network = &wet.network;
    let all = sources.iter().filter(|&&s| !network.still && is_kept(network, s));
    all.fold([0.0; 2], |[volume, rate], &s| {
        [volume + now.source_volume[s], rate + now.source_flow[s]]
    })
}

/// Pressure of the injected volume by the compliance of the bladders [Pa], and its rate [Pa/s]; the unknown pressure is relative to it,
/// [E22].
pub fn pressing(wet: &Wet, lumped: &LumpedNetwork, now: &TimeData) -> [f64; 2] {
    let compliance = wet.compliance() * wet.bladder_length * lumped.bladders.len() as f64;
    into_lumped(wet, lumped, now).map(|volume| volume / compliance)
}

/// Subtracts the injected volumes from contents to obtain unknowns. SI units.
pub fn count_from(system: &System, now: &TimeData, y: &mut [f64]) {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return;
    };
    let l = &system.layout.network;
    let k = fluid.cells_per_bladder;
    for &InjectedShare { source, store, share } in &fluid.shares {
        let unknown = match store {
            Store::Vessel(k) => Some(l.junction.start + fluid.accumulators[k].junction),
            Store::Cell(c) => {
                let slot = fluid.flowing.binary_search(&(c / k));
                slot.ok().map(|slot| l.area.start + slot * k + c % k)
            }
        };
        if let Some(unknown) = unknown {
            y[unknown] -= share * now.source_volume[source];
        }
    }
    for (k, lumped) in wet.lumped.iter().enumerate() {
        if let Some(unknown) = l.lumped_volume[k] {
            y[unknown] -= into_lumped(wet, lumped, now)[0];
        }
        if let Some(unknown) = l.lumped_pressure[k] {
            y[unknown] -= pressing(wet, lumped, now)[0];
        }
    }
}
