//! The Jacobian from derivatives on both sides of a cut: what pressure does to the beam.

use super::beam::Buffers;
use super::trace::Dependence;
use crate::discrete::{System, TimeData, residual};
use crate::numerics::Dual;
use crate::sparse::{Pattern, colour};

/// Directions differentiated in one sweep.
pub(super) const LANES: usize = 8;

/// How the Jacobian is put together.
///
/// Every node of a segment feels every cell of its bladders, but only by the two strains `s` due to pressure, [E3]; and the means of a segment,
/// [E16], know its nodes and cells only by the sums of M and N. With these strains as unknowns of their own beside y, and M and N among what
/// is differentiated, few columns share a row, and few sweeps do:
///
/// ```text
/// dF/dy = ∂F/∂y + ∂F/∂s ds/dy        d(mean)/dy = Σ weight dM/dy
/// ```
#[derive(Clone, Debug)]
pub(super) struct Chain {
    sweeps: Vec<Sweep>,
    /// Entries with the products that are added to them, each of two of [`Chain::parts`].
    products: Vec<(u32, [u32; 2])>,
    /// `∂F/∂s` and `ds/dy`.
    parts: Vec<f64>,
    /// Entries of means by themselves, with these.
    means: Vec<(usize, usize)>,
}

/// What is differentiated together.
#[derive(Clone, Debug, Default)]
struct Sweep {
    /// Unknowns, each with its lane.
    unknowns: Vec<(usize, usize)>,
    /// Strains, likewise.
    strains: Vec<(usize, usize)>,
    /// What goes into entries.
    entries: Vec<Reading>,
    /// What goes into [`Chain::parts`].
    parts: Vec<Reading>,
}

/// A derivative with the factor by which it goes to its place.
#[derive(Clone, Copy, Debug)]
struct Reading {
    into: u32,
    /// Row and lane in one number.
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

/// Where what is differentiated stands: equations, moments of nodes, normal forces of cells, strains.
#[derive(Clone, Copy, Debug)]
struct Places {
    moments: usize,
    forces: usize,
    strains: usize,
    len: usize,
}

impl Places {
    fn new(system: &System) -> Self {
        let moments = system.layout.len;
        let forces = moments + system.mesh.nodes;
        let strains = forces + system.mesh.cells;
        Self {
            moments,
            forces,
            strains,
            len: strains + 2 * system.model.wet.as_ref().map_or(0, |wet| wet.per_row),
        }
    }
}

/// Numbers of what is differentiated.
pub(super) fn width(system: &System) -> usize {
    Places::new(system).len
}

impl Chain {
    /// The pattern of the Jacobian, and the way to its entries; one over the size of each equation.
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
        stand(places.forces, &on.forces, &|_| own.mean_force.is_empty());
        stand(places.strains, &on.strains, &|_| false);
        let (colour, count) = colour::colours(&Pattern::from_columns(&columns));
        let mut chain = Self {
            sweeps: vec![Sweep::default(); count.div_ceil(LANES)],
            products: vec![],
            parts: vec![],
            means: vec![],
        };
        // rows and places of ∂F/∂s, columns and places of ds/dy, strain by strain
        let mut by_strain: Vec<Vec<(usize, usize)>> = vec![vec![]; on.strains.len()];
        let mut of_strain = by_strain.clone();
        let k = system.mesh.cells_per_segment;
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
                } else if row < places.forces {
                    let node = row - places.moments;
                    let (left, right) = system.mesh.segments_of_node(node);
                    for j in left..=right {
                        read(own.mean_moment.start + j, -system.mesh.moment_weight(node - j * k));
                    }
                } else if row < places.strains {
                    let cell = row - places.forces;
                    read(own.mean_force.start + cell / k, -1.0 / k as f64);
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

    /// Writes the Jacobian at what stands in the buffers, which have no derivatives and get none; `seeds` are those of an unknown and of its
    /// rate, `per_row` as in [`Chain::new`].
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
            b.residual[places.moments..places.forces].copy_from_slice(&w.forces.moment);
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

/// Place of a stored entry.
fn entry(pattern: &Pattern, row: usize, column: usize) -> usize {
    let entries = pattern.column(column);
    entries.start + pattern.rows[entries].partition_point(|&at| (at as usize) < row)
}
