//! Sparse Jacobian by the chain rule: the strains by pressure are intermediate variables.

use super::beam::Buffers;
use super::sparsity_tracer::Dependence;
use crate::discrete::{System, TimeData, residual};
use crate::numerics::Dual;
use crate::sparse::{Pattern, colour};

/// Number of directions differentiated in one sweep.
pub(super) const LANES: usize = 8;

/// Assembly of the Jacobian.
///
/// Every node of a segment depends on every cell of its bladders, but only via the two strains `s` by pressure, [E3]. The means of a
/// segment, [E16], depend on its nodes and cells only via the sums of M and N. The strains are therefore additional unknowns beside y,
/// and M and N additional outputs. Then few columns share a row, and few sweeps suffice:
///
/// ```text
/// dF/dy = ∂F/∂y + ∂F/∂s ds/dy        d(mean)/dy = Σ weight dM/dy
/// ```
#[derive(Clone, Debug)]
pub(super) struct ChainRule {
    sweeps: Vec<Sweep>,
    /// Entries and the products added to them, each of two of [`ChainRule::parts`].
    products: Vec<(u32, [u32; 2])>,
    /// Entries of `∂F/∂s` and `ds/dy`.
    parts: Vec<f64>,
    /// Diagonal entries of means, with their unknowns.
    means: Vec<(usize, usize)>,
}

/// Unknowns and strains differentiated in one sweep.
#[derive(Clone, Debug, Default)]
struct Sweep {
    /// Unknowns, each with its lane.
    unknowns: Vec<(usize, usize)>,
    /// Strains, each with its lane.
    strains: Vec<(usize, usize)>,
    /// Derivatives added to entries of the Jacobian.
    entries: Vec<Reading>,
    /// Derivatives added to [`ChainRule::parts`].
    parts: Vec<Reading>,
}

/// A derivative, its destination and its factor.
#[derive(Clone, Copy, Debug)]
struct Reading {
    into: u32,
    /// Row and lane as one index.
    from: u32,
    factor: f64,
}

impl Reading {
    #[inline(always)]
    fn add(&self, from: &[Dual<LANES>], to: &mut [f64]) {
        let place = self.from as usize;
        to[self.into as usize] += self.factor * from[place / LANES].derivative[place % LANES];
    }
}

/// Index ranges of the differentiated outputs: equations, moments of nodes and of both sides of some, normal forces of cells, strains.
#[derive(Clone, Copy, Debug)]
struct Places {
    moments: usize,
    sides: usize,
    forces: usize,
    strains: usize,
    len: usize,
}

impl Places {
    fn new(system: &System) -> Self {
        let moments = system.layout.len;
        let sides = moments + system.mesh.nodes;
        let forces = sides + 2 * system.sections.offset_borders.len();
        let strains = forces + system.mesh.cells;
        Self {
            moments,
            sides,
            forces,
            strains,
            len: strains + 2 * system.model.wet.as_ref().map_or(0, |wet| wet.per_row),
        }
    }
}

/// Number of differentiated outputs.
pub(super) fn width(system: &System) -> usize {
    Places::new(system).len
}

impl ChainRule {
    /// Returns the pattern of the Jacobian and its assembly; `per_row` is the inverse size of each equation.
    pub(super) fn new(system: &System, on: &Dependence, per_row: &[f64]) -> (Pattern, Self) {
        let (n, places) = (system.layout.len, Places::new(system));
        let own = &system.layout.coupling;
        let is_mean = |row: usize| own.mean_moment.contains(&row) || own.mean_force.contains(&row);
        let mut whole = vec![Vec::new(); n];
        for (row, on_row) in on.equations.iter().enumerate() {
            for &column in on_row {
                match on.strains.get((column as usize).wrapping_sub(n)) {
                    None => whole[column as usize].push(row),
                    Some(through) => through.iter().for_each(|&column| whole[column as usize].push(row)),
                }
            }
        }
        let pattern = Pattern::from_columns(&whole);
        let mut columns = vec![Vec::new(); places.len.max(n + on.strains.len())];
        let mut stand = |first: usize, all: &[Vec<u32>], skip: &dyn Fn(usize) -> bool| {
            for (k, on_row) in all.iter().enumerate().filter(|(k, _)| !skip(*k)) {
                on_row
                    .iter()
                    .for_each(|&column| columns[column as usize].push(first + k));
            }
        };
        stand(0, &on.equations, &is_mean);
        stand(places.moments, &on.moments, &|_| own.mean_moment.is_empty());
        stand(places.sides, &on.side_moments, &|_| own.mean_moment.is_empty());
        stand(places.forces, &on.forces, &|_| own.mean_force.is_empty());
        stand(places.strains, &on.strains, &|_| false);
        let (colour, count) = colour::colours(&Pattern::from_columns(&columns));
        let mut chain = Self {
            sweeps: vec![Sweep::default(); count.div_ceil(LANES)],
            products: vec![],
            parts: vec![],
            means: vec![],
        };
        // for each strain: rows and indices of ∂F/∂s, columns and indices of ds/dy
        let mut by_strain: Vec<Vec<(usize, usize)>> = vec![vec![]; on.strains.len()];
        let mut of_strain = by_strain.clone();
        let (mesh, borders) = (&system.mesh, &system.sections.offset_borders);
        let k = mesh.cells_per_segment;
        for (column, rows) in columns.iter().enumerate().filter(|(_, rows)| !rows.is_empty()) {
            let lane = colour[column] % LANES;
            let sweep = &mut chain.sweeps[colour[column] / LANES];
            match column < n {
                true => sweep.unknowns.push((column, lane)),
                false => sweep.strains.push((column - n, lane)),
            }
            for &row in rows {
                let from = (row * LANES + lane) as u32;
                let mut read = |equation: usize, factor: f64| {
                    let factor = factor * per_row[equation];
                    let reading = |into: usize| Reading {
                        into: into as u32,
                        from,
                        factor,
                    };
                    if column < n {
                        sweep.entries.push(reading(entry(&pattern, equation, column)));
                        return;
                    }
                    let parts = &mut by_strain[column - n];
                    let known = parts.iter().find(|(row, _)| *row == equation).map(|(_, part)| *part);
                    let part = known.unwrap_or_else(|| {
                        parts.push((equation, chain.parts.len()));
                        chain.parts.push(0.0);
                        chain.parts.len() - 1
                    });
                    sweep.parts.push(reading(part));
                };
                if row < places.moments {
                    read(row, 1.0);
                } else if row < places.sides {
                    let node = row - places.moments;
                    if system.sections.offset_border(node).is_some() {
                        continue;
                    }
                    let (left, right) = mesh.segments_of_node(node);
                    for j in left..=right {
                        read(
                            own.mean_moment.start + j,
                            -mesh.moment_weight(node - mesh.cells_of(j).start),
                        );
                    }
                } else if row < places.forces {
                    let side = row - places.sides;
                    let (left, right) = mesh.segments_of_node(borders[side / 2]);
                    let j = [left, right][side % 2];
                    read(own.mean_moment.start + j, -mesh.moment_weight(0));
                } else if row < places.strains {
                    let cell = row - places.forces;
                    if !mesh.is_gap(cell) {
                        read(own.mean_force.start + mesh.segment_of(cell), -1.0 / k as f64);
                    }
                } else {
                    of_strain[row - places.strains].push((column, chain.parts.len()));
                    sweep.parts.push(Reading {
                        into: chain.parts.len() as u32,
                        from,
                        factor: 1.0,
                    });
                    chain.parts.push(0.0);
                }
            }
        }
        for (by, of) in by_strain.iter().zip(&of_strain) {
            for &(row, by) in by {
                let entries = of
                    .iter()
                    .map(|&(column, of)| (entry(&pattern, row, column) as u32, [by as u32, of as u32]));
                chain.products.extend(entries);
            }
        }
        let means = own.mean_moment.clone().chain(own.mean_force.clone());
        chain.means = means.map(|row| (entry(&pattern, row, row), row)).collect();
        (pattern, chain)
    }

    /// Computes the Jacobian at the state in the buffers, whose derivatives are zero before and after. `seeds` are those of an unknown
    /// and of its rate, `per_row` as in [`ChainRule::new`].
    pub(super) fn differentiate(
        &mut self,
        (system, now): (&System, &TimeData),
        b: &mut Buffers<Dual<LANES>>,
        seeds: impl Fn(usize) -> [f64; 2],
        per_row: &[f64],
        values: &mut [f64],
    ) {
        let places = Places::new(system);
        values.fill(0.0);
        self.parts.fill(0.0);
        for sweep in &self.sweeps {
            for &(column, lane) in &sweep.unknowns {
                [b.y[column].derivative[lane], b.yp[column].derivative[lane]] = seeds(column);
            }
            let w = &mut b.workspace;
            residual::until_strains(system, now, &b.y, &b.yp, w);
            for (k, strain) in w.coupling.strains_mut().enumerate() {
                b.residual[places.strains + k] = *strain;
                strain.derivative = [0.0; LANES];
            }
            for &(strain, lane) in &sweep.strains {
                w.coupling.strain_mut(strain).derivative[lane] = 1.0;
            }
            residual::beyond_strains(system, now, w);
            residual::equations(system, now, &b.y, &b.yp, w, &mut b.residual[..places.moments]);
            b.residual[places.moments..places.sides].copy_from_slice(&w.forces.moment);
            b.residual[places.sides..places.forces].copy_from_slice(w.forces.side_moment.as_flattened());
            b.residual[places.forces..places.strains].copy_from_slice(&w.forces.normal);
            sweep.entries.iter().for_each(|one| one.add(&b.residual, values));
            sweep.parts.iter().for_each(|one| one.add(&b.residual, &mut self.parts));
            for &(column, _) in &sweep.unknowns {
                b.y[column].derivative = [0.0; LANES];
                b.yp[column].derivative = [0.0; LANES];
            }
        }
        for &(entry, [by, of]) in &self.products {
            values[entry as usize] += self.parts[by as usize] * self.parts[of as usize];
        }
        for &(entry, unknown) in &self.means {
            values[entry] += seeds(unknown)[0] * per_row[unknown];
        }
    }
}

/// Index of a stored entry.
fn entry(pattern: &Pattern, row: usize, column: usize) -> usize {
    let entries = pattern.column(column);
    entries.start + pattern.rows[entries].partition_point(|&at| (at as usize) < row)
}
