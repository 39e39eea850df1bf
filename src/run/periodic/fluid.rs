//! Amount of fluid in a cycle: the content of network parts without an outlet, once everything that acts is periodic.
//!
//! A cycle does not determine it, since any amount returns after a period. It is the content of the part at the start, or when the
//! last valve closed it off, plus the inflow through ports since then.

use super::scene::whole;
use crate::case::schema::Case;
use crate::dae::BeamDae;
use crate::discrete::fluid_mesh::{FluidMesh, LinkEnd, MeshLink};
use crate::discrete::{System, Workspace, start};
use crate::error::numbers::quantity;
use crate::error::{Error, Result};
use crate::functions::SmoothTime;
use crate::model::LumpedKind;
use crate::model::network::{Feed, PrescribedFlow, ResolvedNetwork};
use crate::numerics::sets::Sets;
use crate::run::drive::{settled, settles_at};
use crate::run::equilibrium::{self, EquilibriumOptions};

/// Net inflow over a period, relative to the largest flow times the period, that counts as zero.
const NOTHING: f64 = 1e-9;

/// A part of the network without an outlet.
struct Part {
    stores: Stores,
    /// Indices of the network's sources that feed it.
    sources: Vec<usize>,
}

/// Storage of a part.
enum Stores {
    /// Cells, and accumulators by their indices on the mesh.
    Of(Vec<usize>, Vec<usize>),
    /// Index of a network of one pressure that sources feed.
    Lumped(usize),
}

impl Part {
    /// Volume of a unit of each scaled unknown [m^3].
    fn weights(&self, system: &System) -> Vec<f64> {
        let l = &system.layout;
        let mut w = vec![0.0; l.len];
        let Some(fluid) = &system.fluid else { return w };
        let mut put = |unknown: usize, size: f64| w[unknown] = size * l.scales[unknown];
        match &self.stores {
            Stores::Of(cells, vessels) => {
                let k = fluid.cells_per_bladder;
                for cell in cells {
                    if let Ok(slot) = fluid.flowing.binary_search(&(cell / k)) {
                        put(l.network.area.start + slot * k + cell % k, fluid.ds);
                    }
                }
                for vessel in vessels {
                    put(l.network.junction.start + fluid.accumulators[*vessel].junction, 1.0);
                }
            }
            Stores::Lumped(k) => l.network.lumped_volume[*k]
                .into_iter()
                .for_each(|unknown| put(unknown, 1.0)),
        }
        w
    }

    /// Volume stored in a state with scaled unknowns `y` [m^3].
    fn amount(&self, system: &System, w: &Workspace<f64>, y: &[f64]) -> f64 {
        let ds = system.fluid.as_ref().map_or(0.0, |fluid| fluid.ds);
        let l = &system.layout;
        match &self.stores {
            Stores::Of(cells, vessels) => {
                let in_cells: f64 = cells.iter().map(|cell| w.fluid.area[*cell]).sum();
                ds * in_cells + vessels.iter().map(|vessel| w.fluid.accumulated[*vessel]).sum::<f64>()
            }
            // without the volume that ports of prescribed volume add, which varies with them
            Stores::Lumped(k) => l.network.lumped_volume[*k].map_or(0.0, |unknown| y[unknown] * l.scales[unknown]),
        }
    }

    /// Volume that sources add from `from`, with signals as just before or after this instant, to the instant `to` [m^3].
    fn let_in(&self, network: &ResolvedNetwork, from: SmoothTime, to: f64) -> f64 {
        let lumped = matches!(self.stores, Stores::Lumped(_));
        let of = |source: &usize| match &network.sources[*source].feed {
            Feed::Flow(flow) => flow.integral(to) - flow.integral(from.t),
            Feed::Volume(_) if lumped => 0.0,
            Feed::Volume(volume) => volume.value(to) - volume.jet(from).value,
        };
        self.sources.iter().map(of).sum()
    }
}

/// Parts without an outlet, of a system whose valves have their long-run openings.
fn parts(system: &System) -> Vec<Part> {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return vec![];
    };
    let network = &wet.network;
    let given = fluid.cells + fluid.junctions.len();
    let index = |place: LinkEnd| place_of(fluid, place);
    let shut = |link: &MeshLink| link.number.is_some_and(|number| network.links[number].is_shut());
    let mut sets = Sets::new(given + 1);
    fluid.faces().for_each(|[a, b]| sets.join(a, b));
    for link in fluid.links.iter().filter(|link| !shut(link)) {
        sets.join(index(link.from), index(link.to));
    }
    for bridge in &fluid.bridges {
        sets.join(index(bridge.from), index(bridge.to));
    }
    let k = fluid.cells_per_bladder;
    let flowing = fluid.flowing.iter().flat_map(|bladder| bladder * k..(bladder + 1) * k);
    let stores = flowing.chain(fluid.accumulators.iter().map(|one| fluid.cells + one.junction));
    let stores: Vec<usize> = stores.collect();
    let given = sets.root(given);
    let mut roots: Vec<usize> = stores.iter().map(|store| sets.root(*store)).collect();
    roots.sort_unstable();
    roots.dedup();
    let mut all = vec![];
    for root in roots.into_iter().filter(|root| *root != given) {
        let cells = stores.iter().copied().filter(|store| *store < fluid.cells);
        let cells = cells.filter(|cell| sets.root(*cell) == root).collect();
        let vessels = 0..fluid.accumulators.len();
        let of_vessel = |vessel: &usize| fluid.cells + fluid.accumulators[*vessel].junction;
        let vessels = vessels.filter(|vessel| sets.root(of_vessel(vessel)) == root).collect();
        let sources = fluid
            .sources
            .iter()
            .filter(|source| sets.root(index(source.into)) == root);
        let sources = sources.map(|source| source.number).collect();
        all.push(Part {
            stores: Stores::Of(cells, vessels),
            sources,
        });
    }
    for (k, lumped) in wet.lumped.iter().enumerate() {
        if let LumpedKind::Fed(sources) = &lumped.kind {
            all.push(Part {
                stores: Stores::Lumped(k),
                sources: sources.clone(),
            });
        }
    }
    all
}

/// Index of a place: cells, junctions, then one for all prescribed pressures.
fn place_of(fluid: &FluidMesh, place: LinkEnd) -> usize {
    match place {
        LinkEnd::Cell(c) => c,
        LinkEnd::Junction(j) => fluid.cells + j,
        LinkEnd::Port(_) => fluid.cells + fluid.junctions.len(),
    }
}

/// Volume of each part without an outlet, as a weight of every scaled unknown; the vectors are orthonormal.
pub(super) fn conserved(system: &System) -> Vec<Vec<f64>> {
    let all = parts(system);
    let all = all.iter().map(|part| part.weights(system));
    all.filter_map(|mut w| {
        let size = w.iter().map(|w| w * w).sum::<f64>().sqrt();
        w.iter_mut().for_each(|w| *w /= size);
        (size > 0.0).then_some(w)
    })
    .collect()
}

/// Sets the volumes in a long-run state to those that a run of the case has by then. Returns a warning about trapped fluid, if any.
///
/// # Errors
/// Fluid accumulates from period to period, or valves close off fluid whose volume no equilibrium determines.
pub(super) fn fill(dae: &mut BeamDae, case: &Case, period: f64, y: &mut [f64]) -> Result<Option<String>> {
    let parts = parts(dae.system());
    if parts.is_empty() {
        return Ok(None);
    }
    gathering(dae.system(), case, &parts, period)?;
    let model = whole(case)?;
    let mut latest: f64 = 0.0;
    model.each_signal(|signal| latest = latest.max(settles_at(signal)));
    let begins = period * (latest / period).ceil();
    // sources of the case itself, on the way to the long run
    let sources = model.wet.as_ref().map(|wet| wet.network.clone()).unwrap_or_default();
    let kept = equilibrium::kept(case, begins, &settled)?;
    let mut before = BeamDae::new(System::with(case, model)?);
    let outset = SmoothTime {
        t: 0.0,
        within: f64::MIN_POSITIVE,
    };
    before.enter_smooth_interval(outset.within);
    let (system, now) = before.instant(outset.t);
    let mut z = start::state(system, case, now);
    let (options, since) = match (&kept, &case.start.equilibrium) {
        (Some(kept), _) => {
            let t = kept.options.at_s;
            let since = if t > 0.0 {
                SmoothTime {
                    t,
                    within: t.next_down(),
                }
            } else {
                outset
            };
            (Some(kept.options.clone()), since)
        }
        (None, Some(start)) => (Some(EquilibriumOptions::of_start(start)), outset),
        (None, None) => (None, outset),
    };
    if let Some(options) = options {
        z = equilibrium::at_start(case, &options, &mut before, &z).map_err(|mut fault| {
            if kept.is_some() {
                fault.what = format!(
                    "the volume of fluid behind valves that have shut is unknown: {}",
                    fault.what
                );
            }
            Error::Solver(Box::new(fault))
        })?;
    }
    let rates = vec![0.0; z.len()];
    let (system, _, w) = before.evaluate(outset.t, &z, &rates);
    let amounts = parts
        .iter()
        .map(|part| part.amount(system, &w, &z) + part.let_in(&sources, since, begins));
    let amounts: Vec<f64> = amounts.collect();
    let (system, _, w) = dae.evaluate(0.0, y, &rates);
    let lacks: Vec<(Vec<f64>, f64)> = parts
        .iter()
        .zip(amounts)
        .map(|(part, amount)| (part.weights(system), amount - part.amount(system, &w, y)))
        .collect();
    for (w, lacks) in lacks {
        let square: f64 = w.iter().map(|w| w * w).sum();
        if square > 0.0 {
            y.iter_mut().zip(w).for_each(|(y, w)| *y += lacks * w / square);
        }
    }
    Ok(kept.map(|kept| kept.warning))
}

/// Rejects parts with a net inflow over a period: each period begins with more fluid than the one before.
fn gathering(system: &System, case: &Case, parts: &[Part], period: f64) -> Result<()> {
    let Some(wet) = &system.model.wet else { return Ok(()) };
    let flow = |source: &PrescribedFlow| match &source.feed {
        Feed::Flow(flow) => [flow.integral(period), flow.largest(period).value * period],
        Feed::Volume(_) => [0.0; 2],
    };
    for part in parts {
        let all = part.sources.iter().map(|source| flow(&wet.network.sources[*source]));
        let [net, most] = all.fold([0.0; 2], |[net, most], [more, size]| [net + more, most + size]);
        if net.abs() > NOTHING * most {
            let whole = case.name.as_str();
            return Err(Error::Usage(format!(
                "{whole} has no cycle: a closed network takes in {} each period, and has no outlet. Let the flows of \
                 its ports sum to zero over a period, or open it by a port with pressure_pa",
                quantity(net, "m^3", 4)
            )));
        }
    }
    Ok(())
}
