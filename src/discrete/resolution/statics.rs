//! Static response of a beam to a load, and its mesh error.

use crate::case::{Rotation, Translation};
use crate::functions::profile::Integrals;
use crate::model::loads::LoadKind;
use crate::model::{DistributedLoad, Model};

use super::load_distribution::{self, Part};
use super::ratio;
use crate::discrete::shapes::Cells;

/// Number of parts of a cell in which its moments are evaluated.
const PARTS: f64 = 8.0;

/// Maximum number of such parts, whatever the number of waves.
const MOST: f64 = 64.0;

/// Loads with a common time function that bend the beam, stretch it, or rotate it if it is bent.
pub(super) struct Shape {
    /// JSON pointer of the first load.
    pub pointer: String,
    /// Loads with their factors, for a beam of length 1: forces per length times `l_s`, moments per length unchanged.
    loads: Vec<(DistributedLoad, f64)>,
    /// True for given u1, slope and u3 at root and tip.
    held: [[bool; 3]; 2],
}

impl Shape {
    pub fn new(pointer: String, load: DistributedLoad, constant: f64, model: &Model) -> Self {
        let length = match load.kind {
            LoadKind::ForceX | LoadKind::ForceZ | LoadKind::Normal | LoadKind::Tangential => model.length,
            LoadKind::MomentX | LoadKind::MomentZ | LoadKind::RestCurvature => 1.0,
        };
        let factor = load.factor * constant * length;
        let held = [0, 1].map(|end| {
            let end = &model.ends[end];
            [
                matches!(end.transverse, Translation::Displacement(_)),
                matches!(end.rotation, Rotation::Slope(_)),
                matches!(end.axial, Translation::Displacement(_)),
            ]
        });
        Self {
            pointer,
            loads: vec![(load, factor)],
            held,
        }
    }

    /// True if the loads act transversely.
    pub fn bends(&self) -> bool {
        !matches!(self.loads[0].0.kind, LoadKind::ForceZ | LoadKind::Tangential)
    }

    /// Description of the quantity lost on a mesh.
    pub fn what(&self) -> &'static str {
        if self.bends() {
            "the bending moment of this load between the nodes"
        } else {
            "the normal force of this load within the cells"
        }
    }

    /// True if both have the same kind of effect on a straight beam. A transverse first moment acts only on a bent
    /// beam.
    pub fn acts_with(&self, other: &Self) -> bool {
        let kind = |shape: &Self| match shape.loads[0].0.kind {
            LoadKind::ForceX | LoadKind::Normal | LoadKind::MomentZ | LoadKind::RestCurvature => 0,
            LoadKind::ForceZ | LoadKind::Tangential => 1,
            LoadKind::MomentX => 2,
        };
        kind(self) == kind(other)
    }

    pub fn join(&mut self, other: Self) {
        self.loads.extend(other.loads);
    }

    /// Relative error of the static moments or normal forces on a mesh. It is the larger of two errors: the largest change of an angle,
    /// i.e. of `∫ M` from the root, over the largest angle; and the change of the root mean square, i.e. of the energy.
    ///
    /// ```text
    /// on the mesh   ∫_c M = h (M_c + M_{c+1})/2, ∫_c M² = h (M_c² + M_{c+1}²)/2        N_c = mean of N
    /// ```
    pub fn left_out(&self, cells: usize) -> f64 {
        let (mut parts, shear, scale) = self.cantilever(cells);
        load_distribution::hold(&self.held, self.bends(), shear, &mut parts);
        let (mut turned, mut largest, mut off, mut most_off) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
        let (mut on_mesh, mut exact) = (0.0, 0.0);
        for cell in parts.chunk_by(|p, q| p.cell == q.cell) {
            let (first, last) = (cell[0], cell[cell.len() - 1]);
            let h = last.b - first.a;
            let integral: f64 = cell.iter().map(Part::integral).sum();
            for part in cell {
                turned += part.integral();
                largest = largest.max(turned.abs());
            }
            exact += cell.iter().map(Part::square).sum::<f64>();
            if self.bends() {
                off += integral - 0.5 * h * (first.from + last.to);
                most_off = most_off.max(off.abs());
                on_mesh += 0.5 * h * (first.from * first.from + last.to * last.to);
            } else {
                on_mesh += integral * integral / h;
            }
        }
        let (on_mesh, exact) = (on_mesh.max(0.0).sqrt(), exact.max(0.0).sqrt());
        ratio(most_off, largest, scale).max(ratio((on_mesh - exact).abs(), exact, scale))
    }

    /// M or N of a cantilever held at the root, its shear force at the root, and the largest load.
    ///
    /// ```text
    /// V' = -p, M'' = p, M' = -c        N' = -p
    /// ```
    fn cantilever(&self, cells: usize) -> (Vec<Part>, f64, f64) {
        let integrals: Vec<_> = self
            .loads
            .iter()
            .map(|(load, _)| Integrals::new(&load.profile))
            .collect();
        let mut parts = divided(&integrals, cells);
        let (mut shear, mut value, mut scale) = (0.0, 0.0, 0.0_f64);
        for part in parts.iter_mut().rev() {
            let length = part.b - part.a;
            let mut gained = 0.0;
            let (mut mean, mut across) = (0.0, 0.0);
            for ((load, factor), integrals) in self.loads.iter().zip(&integrals) {
                let [m0, m1, m2] = integrals.moments(part.a, part.b).map(|m| factor * m);
                for x in [part.a, 0.5 * (part.a + part.b)] {
                    scale = scale.max((factor * load.profile.value(x)).abs());
                }
                match load.kind {
                    LoadKind::ForceX | LoadKind::Normal => {
                        gained += length * m1;
                        mean += 0.5 * length * m2;
                        across += m0;
                    }
                    LoadKind::ForceZ | LoadKind::Tangential => {
                        gained += m0;
                        mean += m1;
                    }
                    LoadKind::RestCurvature => {}
                    LoadKind::MomentX | LoadKind::MomentZ => {
                        gained -= m0;
                        mean -= m1;
                    }
                }
            }
            part.to = value;
            part.mean = value + 0.5 * length * shear + mean;
            value += length * shear + gained;
            part.from = value;
            shear += across;
        }
        (parts, shear, scale)
    }
}

/// Divides cells at knots and evenly.
fn divided(integrals: &[Integrals], cells: usize) -> Vec<Part> {
    let mut parts = vec![];
    for (cell, (a, b)) in Cells::equal(cells).ends().enumerate() {
        let half_waves = integrals.iter().map(|i| i.half_waves(b - a)).fold(0.0, f64::max);
        let even = (PARTS * (half_waves + 1.0)).min(MOST).ceil();
        let mut places: Vec<f64> = integrals.iter().flat_map(|i| i.knots_in(a, b)).copied().collect();
        places.extend((1..even as usize).map(|k| a + (b - a) * k as f64 / even));
        places.push(b);
        places.sort_by(f64::total_cmp);
        places.dedup();
        let mut from = a;
        for to in places {
            parts.push(Part {
                a: from,
                b: to,
                cell,
                ..Part::default()
            });
            from = to;
        }
    }
    parts
}
