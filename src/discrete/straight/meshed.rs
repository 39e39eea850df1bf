//! The first vibrations, and what a mesh does to their frequencies.

use std::f64::consts::SQRT_2;

use nalgebra::DMatrix;

use super::held_across;
use crate::case::ResolvedEnd;

/// Cells of the finer of two small meshes from which shapes and errors are taken.
const CELLS: usize = 32;
/// Modes told.
pub const MODES: usize = 4;
/// Below this a frequency is a rigid motion's.
const RIGID: f64 = 1e-3;

/// One mode.
#[derive(Clone, Debug)]
pub struct SmallMode {
    /// Angular frequency over `√(EI/m)/l²`, or `√(EA/m)/l`.
    pub frequency: f64,
    /// `c` of the relative error `c (h/l)²` of the frequency on a mesh of cells of length h.
    pub mesh: f64,
    /// At evenly spaced places from root to tip, of mean square one.
    pub shape: Vec<f64>,
}

impl SmallMode {
    /// The shape at a share of the length.
    pub fn at(&self, share: f64) -> f64 {
        let cells = self.shape.len() - 1;
        let place = share.clamp(0.0, 1.0) * cells as f64;
        let cell = (place as usize).min(cells - 1);
        let part = place - cell as f64;
        self.shape[cell] * (1.0 - part) + self.shape[cell + 1] * part
    }

    /// The largest displacement anywhere.
    pub fn most(&self) -> f64 {
        self.shape.iter().fold(0.0, |most, u| most.max(u.abs()))
    }

    /// Its slope at the tip, per length.
    pub fn tip_slope(&self) -> f64 {
        let cells = self.shape.len() - 1;
        (self.shape[cells] - self.shape[cells - 1]) * cells as f64
    }
}

/// The first bending modes that are no rigid motion, on the mesh of `docs/model.md` section 7: `u` at nodes, half a cell at the ends.
///
/// ```text
/// φ = Δu/h    κ_i = -Δφ/h,  κ_0 = -φ_{1/2}/(h/2) where the slope is given, 0 where the moment is    Σ h_i κ_i² u = ω² Σ h_i u_i²
/// ```
///
/// The error of the mesh is second order: two meshes tell its factor.
pub fn bending(ends: &[ResolvedEnd; 2]) -> Vec<SmallMode> {
    let (coarse, fine) = (bending_on(ends, CELLS / 2), bending_on(ends, CELLS));
    let pairs = coarse.into_iter().zip(fine);
    pairs
        .take(MODES)
        .map(|((half, _), (found, shape))| {
            let limit = found + (found - half) / 3.0;
            SmallMode {
                frequency: limit,
                mesh: (found / limit - 1.0) * (CELLS * CELLS) as f64,
                shape,
            }
        })
        .collect()
}

fn bending_on(ends: &[ResolvedEnd; 2], cells: usize) -> Vec<(f64, Vec<f64>)> {
    let h = 1.0 / cells as f64;
    let [[root_held, root_turned], [tip_held, tip_turned]] = [0, 1].map(|end| held_across(&ends[end]));
    let share = |node: usize| if node == 0 || node == cells { 0.5 * h } else { h };
    // rows: curvature of each node times the root of its length; columns: displacement of each node
    let mut curvature = DMatrix::<f64>::zeros(cells + 1, cells + 1);
    for node in 0..=cells {
        let weight = share(node).sqrt();
        let mut slope = |cell: usize, factor: f64| {
            curvature[(node, cell + 1)] += weight * factor / h;
            curvature[(node, cell)] -= weight * factor / h;
        };
        match node {
            0 if root_turned => slope(0, 2.0 / h),
            n if n == cells && tip_turned => slope(cells - 1, -2.0 / h),
            n if n == 0 || n == cells => {}
            n => {
                slope(n, 1.0 / h);
                slope(n - 1, -1.0 / h);
            }
        }
    }
    let free: Vec<usize> = (usize::from(root_held)..=cells - usize::from(tip_held)).collect();
    let stiffness = DMatrix::from_fn(free.len(), free.len(), |i, j| {
        let (a, b) = (curvature.column(free[i]), curvature.column(free[j]));
        a.dot(&b) / (share(free[i]) * share(free[j])).sqrt()
    });
    let eigen = stiffness.symmetric_eigen();
    let mut all: Vec<(f64, Vec<f64>)> = (0..free.len())
        .map(|k| {
            let mut shape = vec![0.0; cells + 1];
            for (i, &node) in free.iter().enumerate() {
                shape[node] = eigen.eigenvectors[(i, k)] / share(node).sqrt();
            }
            (eigen.eigenvalues[k].max(0.0).sqrt(), shape)
        })
        .filter(|(frequency, _)| *frequency > RIGID * (cells * cells) as f64)
        .collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all
}

/// The first axial modes, which cells of length h slow down by `(βh)²/24`.
pub fn axial(ends: &[ResolvedEnd; 2]) -> Vec<SmallMode> {
    let one = |mode: super::Mode| SmallMode {
        frequency: mode.beta,
        mesh: -mode.beta * mode.beta / 24.0,
        shape: (0..=CELLS)
            .map(|place| SQRT_2 * mode.at(place as f64 / CELLS as f64))
            .collect(),
    };
    super::axial(ends, MODES).into_iter().map(one).collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::discrete::straight;
    use crate::discrete::straight::tests::ends;

    /// Goal: frequencies to 1e-3 of the exact ones for the first modes, and of pinned ends the error of the mesh, `-(βh)²/12`.
    #[test]
    fn frequencies_of_the_small_meshes() {
        for (root, tip) in [
            ("clamped", "free"),
            ("clamped", "clamped"),
            ("free", "free"),
            ("pinned", "pinned"),
        ] {
            let modes = bending(&ends(root, tip));
            for (mode, exact) in modes.iter().zip(straight::bending(&ends(root, tip), 2)) {
                let off = mode.frequency / (exact.beta * exact.beta) - 1.0;
                assert!(off.abs() < 1e-3, "{root}-{tip} {}: {off:e}", exact.beta);
                let ends = 0.5 * (mode.shape[0].powi(2) + mode.shape[CELLS].powi(2));
                let square = (mode.shape.iter().map(|x| x * x).sum::<f64>() - ends) / CELLS as f64;
                assert!((square - 1.0).abs() < 1e-9, "{square}");
            }
        }
        // pinned ends have no half cells that count: u'''' of a sine on the staggered mesh
        let pinned = &bending(&ends("pinned", "pinned"))[0];
        assert!((pinned.mesh + PI * PI / 12.0).abs() < 0.02, "{}", pinned.mesh);
    }
}
