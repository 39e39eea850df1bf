//! Finite volumes along the bladders, and the conductances between them.

use std::ops::Range;

use super::injected_volume::{self, InjectedShare};
pub use super::mesh_links::{LinkEnd, MeshAccumulator, MeshBridge, MeshFlow, MeshLink, MeshPilot, MeshSource};
use super::sorted_links::SortedLinks;
use crate::case::schema::BladderEnd;
use crate::model::network::{AccumulatorLaw, FlowLaw, Link, NetworkNode};
use crate::model::{Storage, Wet};

/// Cells of all bladders: bladder b has the cells from `b cells_per_bladder`, inlet to outlet; upper row first.
#[derive(Clone, Debug)]
pub struct FluidMesh {
    /// Number of bladders, `n`.
    pub bladders: usize,
    /// Number of finite volumes in each bladder.
    pub cells_per_bladder: usize,
    /// Total number of cells.
    pub cells: usize,
    /// Length of a cell `ds` [m].
    pub ds: f64,
    /// Conductance between neighboring cells of a bladder, `q1b/(mu ds)` [m^3/(s Pa)]; with spans, of most bladders.
    pub conductance: f64,
    /// True if flow between cells is creeping and given by their pressures; otherwise the faces are links.
    pub creeping: bool,
    /// Bladders whose cells' areas are unknowns, ascending.
    pub flowing: Vec<usize>,
    /// Ranges of their cells, merged for neighboring bladders: the unknowns are in this order.
    pub runs: Vec<Range<usize>>,
    /// Junctions whose pressures are unknowns, by their numbers in the network.
    pub junctions: Vec<usize>,
    /// For each of these junctions in a group from which only tubes with inertia lead, the first junction of the group. The pressure
    /// level of such a group is determined by accelerations.
    pub adrift: Vec<Option<usize>>,
    /// Number of flows that are unknowns.
    pub flows: usize,
    /// Number of friction branches of all flows.
    pub branches: usize,
    /// Links with flow: those of the network, followed by faces between cells.
    pub links: Vec<MeshLink>,
    /// Links by type.
    pub sorted: SortedLinks,
    /// Prescribed flows.
    pub sources: Vec<MeshSource>,
    /// Bridges of check valves.
    pub bridges: Vec<MeshBridge>,
    /// Cells and accumulators whose unknowns are relative to the volume from ports of prescribed volume.
    pub shares: Vec<InjectedShare>,
    /// Accumulators; the unknowns of their junctions are volumes.
    pub accumulators: Vec<MeshAccumulator>,
    /// Links with a pump, in ascending order.
    pub pumps: Vec<usize>,
    /// Volume change of each lumped network at the start [m^3].
    pub volume_at_start: Vec<f64>,
    /// Area change of each cell at the start, for cells that keep it [m^2].
    pub area_at_start: Vec<f64>,
}

impl FluidMesh {
    /// Creates the cells and links of the network that are simulated.
    pub fn new(wet: &Wet, cells_per_bladder: usize) -> Self {
        let network = &wet.network;
        let bladders = 2 * wet.per_row;
        let ds = wet.bladder_length / cells_per_bladder as f64;
        let conductance = network.bladder_mobility / ds;
        let half = |cell: usize| 0.5 / (conductance * wet.mobility_ratio(cell / cells_per_bladder));
        let flows = |bladder: usize| wet.storage[bladder] == Storage::Flowing;
        let pooled = |component: usize| wet.lumped.iter().any(|lumped| lumped.component == component);
        let flowing: Vec<usize> = (0..bladders).filter(|&b| flows(b)).collect();
        let junctions: Vec<usize> = (0..network.junctions.len())
            .filter(|&j| wet.flows && !pooled(network.component_of_junction[j]))
            .collect();
        // End of a link; none in a bladder without flow.
        let place = |node: NetworkNode| match node {
            NetworkNode::Cell { bladder, .. } if !flows(bladder) => None,
            NetworkNode::Cell { bladder, end } => Some(LinkEnd::Cell(match end {
                BladderEnd::Inlet => bladder * cells_per_bladder,
                BladderEnd::Outlet => (bladder + 1) * cells_per_bladder - 1,
            })),
            NetworkNode::Junction(j) => junctions.binary_search(&j).ok().map(LinkEnd::Junction),
            NetworkNode::Port(p) => wet.flows.then_some(LinkEnd::Port(p)),
        };
        let half_of = |p: LinkEnd| if let LinkEnd::Cell(cell) = p { half(cell) } else { 0.0 };
        let (mut count, mut branches) = (0, 0);
        let mut flow = |law: FlowLaw| {
            let (number, branch) = (count, branches);
            count += 1;
            branches += law.branches().count();
            MeshFlow { number, branch, law }
        };
        // Law of a tube, or of another connection of bladders and ports, including the half cells at its ends. Other links than tubes at
        // a
        // junction remain creeping, so that the junction's pressure follows from flows.
        let along = network.along_bladders.as_ref();
        let law = |link: &Link, ends: [LinkEnd; 2]| {
            let own = link.tube.map(|tube| tube.law);
            let bladders: Vec<usize> = ends.iter().filter_map(|end| end.bladder(cells_per_bladder)).collect();
            let cells = bladders.len();
            let at_junction = ends.iter().any(|end| matches!(end, LinkEnd::Junction(_)));
            match along.filter(|_| cells > 0 && (own.is_some() || !at_junction)) {
                None => own,
                Some(along) => {
                    let own_parts: Vec<_> = bladders.iter().filter_map(|bladder| wet.along(*bladder)).collect();
                    let first = own_parts
                        .first()
                        .copied()
                        .filter(|first| own_parts.iter().all(|one| one == first));
                    let mut part = first.unwrap_or(along).over(0.5 * cells as f64 * ds);
                    if first.is_none() {
                        part.inertance = own_parts.iter().map(|along| along.over(0.5 * ds).inertance).sum();
                    }
                    Some(own.unwrap_or_default().behind(&part))
                }
            }
        };
        let mut pumps = vec![];
        let open = network.links.iter().enumerate().filter(|(_, link)| !link.is_shut());
        let links = open.filter_map(|(number, link)| {
            let (from, to) = (place(link.from)?, place(link.to)?);
            let pump = link.pump.as_ref().map(|_| {
                pumps.push(number);
                pumps.len() - 1
            });
            let pump_curve = link.pump.as_ref().and_then(|pump| pump.curve.clone());
            Some(MeshLink {
                number: Some(number),
                from,
                to,
                half_cells: half_of(from) + half_of(to),
                resistance: link.resistance,
                of_pump: link.pump.as_ref().map_or(0.0, |pump| pump.resistance),
                pump,
                head: link.head,
                check_valve: link.check_valve,
                pilot: None,
                kind: Some(link.kind),
                flow: law(link, [from, to])
                    .or_else(|| pump_curve.as_ref().map(|_| FlowLaw::default()))
                    .map(&mut flow),
                pump_curve,
            })
        });
        let mut links: Vec<MeshLink> = links.collect();
        if let Some(along) = along {
            let faces = faces(&flowing, cells_per_bladder);
            links.extend(faces.map(|[from, to]| MeshLink {
                number: None,
                from: LinkEnd::Cell(from),
                to: LinkEnd::Cell(to),
                half_cells: 2.0 * half(from),
                resistance: 0.0,
                of_pump: 0.0,
                pump: None,
                pump_curve: None,
                head: 0.0,
                check_valve: None,
                pilot: None,
                kind: None,
                flow: Some(flow(wet.along(from / cells_per_bladder).unwrap_or(along).over(ds))),
            }));
        }
        let sources = network.sources.iter().enumerate().filter_map(|(number, source)| {
            let into = place(source.into)?;
            let half_cell = half_of(into);
            Some(MeshSource {
                number,
                into,
                half_cell,
            })
        });
        let bridges = network.bridges.iter().enumerate().filter_map(|(number, bridge)| {
            let (from, to) = (place(bridge.from)?, place(bridge.to)?);
            Some(MeshBridge { number, from, to })
        });
        let bridges: Vec<MeshBridge> = bridges.collect();
        let accumulators = network.accumulators.iter().enumerate();
        let accumulators = accumulators.filter_map(|(number, one)| {
            let junction = junctions.binary_search(&one.junction).ok()?;
            Some(MeshAccumulator {
                number: Some(number),
                junction,
                component: network.component_of_junction[one.junction],
                law: match wet.compression {
                    None => one.law.clone(),
                    Some(_) => one.law.clone().holding(network.halves_of_tubes(one.junction)),
                },
            })
        });
        let mut accumulators: Vec<MeshAccumulator> = accumulators.collect();
        let mut adrift = vec![None; junctions.len()];
        for group in network.adrift() {
            let members: Vec<usize> = group.iter().filter_map(|j| junctions.binary_search(j).ok()).collect();
            let Some(&first) = members.first() else { continue };
            if wet.compression.is_some() {
                accumulators.push(MeshAccumulator {
                    number: None,
                    junction: first,
                    component: network.component_of_junction[junctions[first]],
                    law: AccumulatorLaw::Rigid {
                        holds: group.iter().map(|&j| network.halves_of_tubes(j)).sum(),
                    },
                });
            } else {
                members.into_iter().for_each(|k| adrift[k] = Some(first));
            }
        }
        // order of the accumulators' unknowns
        accumulators.sort_by_key(|one| one.junction);
        for link in &mut links {
            let valve = link.number.and_then(|number| network.links[number].pilot);
            link.pilot = valve.and_then(|valve| {
                let vessel = accumulators.iter().position(|one| one.number == Some(valve.vessel))?;
                let MeshAccumulator { junction, law, .. } = &accumulators[vessel];
                Some(MeshPilot {
                    vessel,
                    junction: *junction,
                    law: wet.compression.as_ref().map(|_| law.clone()),
                    valve,
                })
            });
        }
        let mut mesh = Self {
            bladders,
            cells_per_bladder,
            cells: bladders * cells_per_bladder,
            ds,
            conductance,
            creeping: along.is_none(),
            runs: runs(&flowing, cells_per_bladder),
            flowing,
            flows: count,
            branches,
            adrift,
            sorted: SortedLinks::new(&links, network),
            links,
            sources: sources.collect(),
            bridges,
            accumulators,
            pumps,
            junctions: junctions.clone(),
            volume_at_start: vec![0.0; wet.lumped.len()],
            area_at_start: vec![0.0; bladders * cells_per_bladder],
            shares: vec![],
        };
        mesh.shares = injected_volume::shares(&mesh, wet);
        mesh
    }

    /// Stores the volumes at the start for bladders and lumped networks that keep theirs. `areas` may have another number of cells per
    /// bladder; their means are used.
    pub fn keep(&mut self, areas: &[f64], wet: &Wet) {
        let given = areas.len().checked_div(self.bladders).unwrap_or(0);
        let mean = |bladder: usize| areas[bladder * given..(bladder + 1) * given].iter().sum::<f64>() / given as f64;
        let length = self.ds * self.cells_per_bladder as f64;
        for bladder in 0..self.bladders {
            let cells = self.cells_of(bladder);
            if wet.storage[bladder] == Storage::Kept {
                self.area_at_start[cells].fill(mean(bladder));
            }
        }
        for (volume, lumped) in self.volume_at_start.iter_mut().zip(&wet.lumped) {
            *volume = lumped.bladders.iter().map(|&bladder| mean(bladder)).sum::<f64>() * length;
        }
    }

    /// Mean pressure at the other ends of the links at a junction, of cells and ports only [Pa].
    pub fn around(&self, junction: usize, cells: &[f64], ports: &[f64]) -> f64 {
        let here = LinkEnd::Junction(junction);
        let known = self.links.iter().filter_map(|link| {
            let other = match here {
                _ if link.from == here => link.to,
                _ if link.to == here => link.from,
                _ => return None,
            };
            match other {
                LinkEnd::Cell(cell) => Some(cells[cell]),
                LinkEnd::Port(port) => Some(ports[port]),
                LinkEnd::Junction(_) => None,
            }
        });
        let (sum, count) = known.fold((0.0, 0), |(sum, count), pressure| (sum + pressure, count + 1));
        sum / f64::from(count.max(1))
    }

    /// Conductance between neighboring cells of a bladder [m^3/(s Pa)].
    #[inline]
    pub fn conductance_of(&self, wet: &Wet, bladder: usize) -> f64 {
        match wet.segments.is_empty() {
            true => self.conductance,
            false => self.conductance * wet.mobility_ratio(bladder),
        }
    }

    /// Faces between cells of bladders, as pairs of adjacent cells.
    pub fn faces(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        faces(&self.flowing, self.cells_per_bladder)
    }

    /// Faces with creeping flow between cells of a bladder, as pairs of adjacent cells.
    #[inline]
    pub fn creeping_faces(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        let bladders = if self.creeping { &self.flowing[..] } else { &[] };
        faces(bladders, self.cells_per_bladder)
    }

    /// Cells of a bladder.
    #[inline]
    pub fn cells_of(&self, bladder: usize) -> Range<usize> {
        bladder * self.cells_per_bladder..(bladder + 1) * self.cells_per_bladder
    }
}

/// Faces between cells of the given bladders, as pairs of adjacent cells.
#[inline]
fn faces(bladders: &[usize], cells_per_bladder: usize) -> impl Iterator<Item = [usize; 2]> + '_ {
    let of = move |&bladder: &usize| bladder * cells_per_bladder + 1..(bladder + 1) * cells_per_bladder;
    bladders.iter().flat_map(of).map(|cell| [cell - 1, cell])
}

/// Ranges of the cells of bladders, merged for neighboring bladders.
fn runs(bladders: &[usize], cells_per_bladder: usize) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = vec![];
    for &bladder in bladders {
        let (start, end) = (bladder * cells_per_bladder, (bladder + 1) * cells_per_bladder);
        match runs.last_mut() {
            Some(run) if run.end == start => run.end = end,
            _ => runs.push(start..end),
        }
    }
    runs
}
