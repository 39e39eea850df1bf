//! Equilibrium as a system without derivatives; the load factor replaces time.

use super::{BeamDae, Dae, EvaluationError, Pattern, Seeds};
use crate::discrete::fluid_mesh::{FluidMesh, LinkEnd};
use crate::discrete::{System, ValveTangents};
use crate::numerics::sets::Sets;

/// `[E29]` Equations of a [`System`] without inertia and without rates, where `t` is the load factor:
///
/// ```text
/// F(t, y, 0) = 0,        and for each set of joined cells that no prescribed pressure reaches
/// Σ Δs (a1 - t a1(0)) + Σ (V - t V(0)) = Σ V_port  in place of the storage of one of its cells
/// ```
///
/// V are the volumes of accumulators, `V_port` the volumes injected by ports that prescribe a volume or a flow. In such sets the storage
/// equations are dependent: flows inside a closed network sum to zero for all pressures. A network with a steady flow driven by ports or
/// turbines is in equilibrium as well. Load paths that start at an equilibrium ([`StaticBeam::from_state`]) keep the volumes of that
/// state for all t. Optional additions are constant forces on unknowns (an imperfection), and a resistance to motion from a state
/// ([`StaticBeam::resist`]).
#[derive(Clone, Debug)]
pub struct StaticBeam {
    beam: BeamDae,
    closed: Vec<Closed>,
    pattern: Pattern,
    /// Source of each entry: the beam's own pattern, or a volume.
    from: Vec<Entry>,
    zeros: Vec<f64>,
    beam_values: Vec<f64>,
    none: Vec<bool>,
    /// True if volumes exist at t = 0 and do not grow with t.
    kept: bool,
    /// Volume injected by each source that prescribes a flow, at t = 0 and at t = 1 [m^3].
    pumped: Vec<[f64; 2]>,
    /// Residual of the state at t = 0; it is reduced in proportion as t grows to 1. Empty if there is none.
    left: Vec<f64>,
    /// Force added to the residual.
    pub imperfection: Vec<f64>,
    /// Resistance to motion, if any.
    resistance: Option<Resistance>,
}

/// Resistance `ρ D (y - y_0)` to motion away from a state; D is the mass of each node, in its momentum equation.
#[derive(Clone, Debug)]
struct Resistance {
    /// `ρ D` by unknown.
    weights: Vec<f64>,
    /// `y_0`.
    state: Vec<f64>,
    /// Column and diagonal entry of each unknown with mass.
    diagonal: Vec<(usize, usize)>,
}

/// An entry of the static Jacobian.
#[derive(Clone, Copy, Debug)]
enum Entry {
    /// Entry of the beam, by its index.
    Own(usize),
    /// Derivative of a volume by the unknown, over the scale of volumes.
    Volume(f64),
    /// Diagonal entry used only by a resistance to motion.
    Empty,
}

/// Cells and accumulators that share a volume, which only ports of volume or flow can change.
#[derive(Clone, Debug)]
struct Closed {
    /// Equation replaced by the volume: that of its first unknown.
    row: usize,
    /// Unknowns of its cells and accumulators, ascending, each with its volume relative to that of a cell.
    parts: Vec<(usize, f64)>,
    /// Sum of their volumes at the start, relative to the volume of a cell.
    sum: f64,
    /// Sources that prescribe volumes or flows.
    sources: Vec<usize>,
    /// Reference volume of a cell [m^3].
    unit: f64,
    /// Total flow of ports with prescribed flow into them at t = 1 [m^3/s].
    inflow: f64,
}

impl StaticBeam {
    /// Equilibria of loads applied to an equilibrium `state`, in scaled unknowns of the same system. Closed networks keep their volumes
    /// of that state. Ports of prescribed volume add the volume injected from there on, ports of prescribed flow add `pumped` [m^3], for
    /// every source at t = 0 and at t = 1.
    pub fn from_state(system: System, state: &[f64], pumped: &[[f64; 2]]) -> Self {
        Self::from_system(system, state, pumped, true)
    }

    /// Equilibria of loads applied from zero: volumes grow with t to those of `start`; the pumped volume is complete at t = 1.
    pub fn from_nothing(system: System, start: &[f64], pumped: &[[f64; 2]]) -> Self {
        Self::from_system(system, start, pumped, false)
    }

    fn from_system(system: System, start: &[f64], pumped: &[[f64; 2]], kept: bool) -> Self {
        let mut beam = BeamDae::new(system);
        beam.find_turns(0.0, start, &vec![0.0; start.len()]);
        let mut closed = closed(&mut beam, start);
        if kept {
            let volumes = &beam.instant(0.0).1.source_volume;
            for one in &mut closed {
                one.sum -= let_in(one, volumes, pumped, 0.0) / one.unit;
            }
        }
        let inner = beam.pattern();
        let n = beam.len();
        let masses = if beam.system().touching.is_empty() {
            vec![0.0; n]
        } else {
            beam.system().nodal_masses()
        };
        let replaced = |row: usize| closed.iter().position(|c| c.row == row);
        let mut starts = vec![0];
        let (mut rows, mut from) = (vec![], vec![]);
        for (column, mass) in masses.iter().enumerate() {
            let kept = inner.column(column).map(|e| (inner.rows[e], e));
            let kept = kept.filter(|(row, _)| replaced(*row as usize).is_none());
            let mut entries: Vec<(i64, Entry)> = kept.map(|(row, entry)| (row, Entry::Own(entry))).collect();
            let weight = |c: &Closed| {
                let found = c.parts.binary_search_by_key(&column, |(part, _)| *part);
                found.ok().map(|k| c.parts[k].1)
            };
            let volumes = closed.iter().filter_map(|c| Some((c.row as i64, weight(c)?)));
            entries.extend(volumes.map(|(row, weight)| (row, Entry::Volume(weight))));
            if *mass > 0.0 && entries.iter().all(|(row, _)| *row != column as i64) {
                entries.push((column as i64, Entry::Empty));
            }
            entries.sort_unstable_by_key(|(row, _)| *row);
            rows.extend(entries.iter().map(|e| e.0));
            from.extend(entries.iter().map(|e| e.1));
            starts.push(rows.len() as i64);
        }
        let beam_values = vec![0.0; inner.entries()];
        Self {
            beam,
            closed,
            pattern: Pattern { starts, rows },
            from,
            zeros: vec![0.0; n],
            beam_values,
            none: vec![false; n],
            kept,
            pumped: pumped.to_vec(),
            left: vec![],
            imperfection: vec![0.0; n],
            resistance: None,
        }
    }

    /// Adds the resistance `ρ D (y - y_0)` to motion away from a state, with `ρ` in 1/s^2 and the mass D of each node: one step of a
    /// motion without inertia. A resistance of 0 removes it. Only systems with walls have entries for it.
    pub fn resist(&mut self, rho: f64, state: &[f64]) {
        if rho == 0.0 {
            self.resistance = None;
            return;
        }
        let mut weights = self.system().nodal_masses();
        weights.iter_mut().for_each(|w| *w *= rho);
        let diagonal = (0..self.len()).filter_map(|column| {
            let mut entries = self.pattern.column(column);
            let own = entries.find(|&entry| self.pattern.rows[entry] == column as i64);
            own.filter(|_| weights[column] > 0.0).map(|entry| (column, entry))
        });
        self.resistance = Some(Resistance {
            diagonal: diagonal.collect(),
            state: state.to_vec(),
            weights,
        });
    }

    /// Reduces the residual of a state at t = 0 in proportion to 1 - t: the state is the first one of a path that ends in equilibrium at
    /// t = 1. Returns false if the equations cannot be evaluated.
    pub fn relax_from(&mut self, state: &[f64]) -> bool {
        let mut left = vec![0.0; self.len()];
        self.left.clear();
        let evaluated = self.residual(0.0, state, &[], &mut left).is_ok();
        self.left = left;
        evaluated
    }

    /// The beam as a DAE.
    pub fn beam(&mut self) -> &mut BeamDae {
        &mut self.beam
    }

    /// Replaces valves by their tangents at the last evaluated state, or restores their characteristics.
    pub fn linearize_valves(&mut self, linear: bool) {
        let beam = &mut self.beam;
        beam.now.tangents = match linear {
            true => ValveTangents::new(&beam.system, &beam.now, &beam.plain.workspace),
            false => ValveTangents::default(),
        };
    }

    /// Flow of ports into a closed network without outflow [m^3/s]; no equilibrium exists then.
    pub fn fed(&self) -> Option<f64> {
        self.closed.iter().map(|c| c.inflow).find(|inflow| *inflow != 0.0)
    }

    /// Characteristic size of each equation, in SI units.
    pub fn equation_scales(&self) -> Vec<f64> {
        let layout = &self.system().layout;
        let mut scales = layout.row_scales.clone();
        for closed in &self.closed {
            scales[closed.row] = closed.unit;
        }
        scales
    }

    /// The system.
    pub fn system(&self) -> &System {
        self.beam.system()
    }
}

/// Sets of connected cells without a prescribed pressure, for the connections open at t = 1.
fn closed(beam: &mut BeamDae, start: &[f64]) -> Vec<Closed> {
    let (system, now) = beam.instant(1.0);
    let (Some(fluid), layout) = (&system.fluid, &system.layout) else {
        return vec![];
    };
    // Indices: cells, then junctions, then a common one for all prescribed pressures.
    let given = fluid.cells + fluid.junctions.len();
    let mut sets = Sets::new(given + 1);
    let index = |place: LinkEnd| match place {
        LinkEnd::Cell(c) => c,
        LinkEnd::Junction(j) => fluid.cells + j,
        LinkEnd::Port(_) => given,
    };
    fluid.creeping_faces().for_each(|[a, b]| sets.join(a, b));
    for (link, &conductance) in fluid.links.iter().zip(&now.conductance) {
        if conductance > 0.0 {
            sets.join(index(link.from), index(link.to));
        }
    }
    for bridge in &fluid.bridges {
        sets.join(index(bridge.from), index(bridge.to));
    }
    let given = sets.root(given);
    let mut closed: Vec<(usize, Closed)> = vec![];
    let unit = layout
        .network
        .area
        .clone()
        .next()
        .map_or(1.0, |cell| layout.scales[cell] * fluid.ds);
    let cells = layout.network.area.clone().zip(flowing_cells(fluid));
    let vessels = fluid.accumulators.iter().map(|one| {
        let unknown = layout.network.junction.start + one.junction;
        (unknown, fluid.cells + one.junction, layout.scales[unknown] / unit)
    });
    for (unknown, place, weight) in cells.map(|(unknown, cell)| (unknown, cell, 1.0)).chain(vessels) {
        let root = sets.root(place);
        if root == given {
            continue;
        }
        let known = closed.iter().position(|(r, _)| *r == root).unwrap_or_else(|| {
            let empty = Closed {
                row: unknown,
                parts: vec![],
                sum: 0.0,
                sources: vec![],
                unit,
                inflow: 0.0,
            };
            closed.push((root, empty));
            closed.len() - 1
        });
        let own = &mut closed[known].1;
        own.parts.push((unknown, weight));
        own.sum += weight * start[unknown];
    }
    // A sum of flows that is zero up to rounding errors is set to zero.
    let mut passed = vec![0.0; closed.len()];
    for source in &fluid.sources {
        let root = sets.root(index(source.into));
        if let Some(k) = closed.iter().position(|(r, _)| *r == root) {
            closed[k].1.sources.push(source.number);
            closed[k].1.inflow += now.source_flow[source.number];
            passed[k] += now.source_flow[source.number].abs();
        }
    }
    for ((_, c), passed) in closed.iter_mut().zip(passed) {
        if c.inflow.abs() <= 1e-12 * passed {
            c.inflow = 0.0;
        }
    }
    closed.into_iter().map(|(_, c)| c).collect()
}

/// Volume injected by ports into closed cells [m^3]: `volumes` of ports that prescribe one, and the volumes pumped by
/// the others.
fn let_in(closed: &Closed, volumes: &[f64], pumped: &[[f64; 2]], t: f64) -> f64 {
    let by_flow = |source: usize| pumped.get(source).map_or(0.0, |[from, to]| from + t * (to - from));
    closed
        .sources
        .iter()
        .map(|&source| volumes[source] + by_flow(source))
        .sum()
}

/// Cells whose areas are unknowns, in the order of the unknowns.
fn flowing_cells(fluid: &FluidMesh) -> impl Iterator<Item = usize> + '_ {
    fluid.runs.iter().cloned().flatten()
}

impl Dae for StaticBeam {
    fn len(&self) -> usize {
        self.beam.len()
    }

    fn differential(&self) -> &[bool] {
        &self.none
    }

    fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    fn residual(&mut self, t: f64, y: &[f64], _: &[f64], residual: &mut [f64]) -> Result<(), EvaluationError> {
        self.beam.residual(t, y, &self.zeros, residual)?;
        for closed in &self.closed {
            let sum: f64 = closed.parts.iter().map(|&(part, weight)| weight * y[part]).sum();
            let let_in = let_in(closed, &self.beam.now().source_volume, &self.pumped, t);
            let grown = if self.kept { 1.0 } else { t };
            residual[closed.row] = sum - grown * closed.sum - let_in / closed.unit;
        }
        for (r, left) in residual.iter_mut().zip(&self.left) {
            *r -= (1.0 - t) * left;
        }
        for (r, more) in residual.iter_mut().zip(&self.imperfection) {
            *r += more;
        }
        if let Some(against) = &self.resistance {
            for &(k, _) in &against.diagonal {
                residual[k] += against.weights[k] * (y[k] - against.state[k]);
            }
        }
        Ok(())
    }

    fn jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        _: &[f64],
        _: Seeds<'_>,
        values: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let seeds = Seeds::Step { cj: 0.0 };
        self.beam.jacobian(t, y, &self.zeros, seeds, &mut self.beam_values)?;
        for (value, from) in values.iter_mut().zip(&self.from) {
            *value = match *from {
                Entry::Own(entry) => self.beam_values[entry],
                Entry::Volume(weight) => weight,
                Entry::Empty => 0.0,
            };
        }
        if let Some(against) = &self.resistance {
            for &(k, entry) in &against.diagonal {
                values[entry] += against.weights[k];
            }
        }
        Ok(())
    }

    fn name(&self, unknown: usize) -> String {
        self.beam.name(unknown)
    }
}
