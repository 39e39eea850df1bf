//! Corotation: reuse of Newton's matrix for a rotating beam.

use std::ops::Range;

use super::Dae;
use crate::numerics::{Planar, wide};

/// Sine of the angle above which a matrix is rotated. Cases with smaller rotations avoid the work without needing more matrices.
const LITTLE: f64 = 1e-2;

/// Unknowns that are vectors in the plane, one per node; their equations are vectors as well.
#[derive(Clone, Debug, PartialEq)]
pub struct RotatedVectors {
    /// Indices of their transverse components, in the order of the nodes.
    pub across: Range<usize>,
    /// Indices of their axial components: equally many, higher than those of `across`.
    pub along: Range<usize>,
    /// Node of the first vector.
    pub node: usize,
    /// True if no node is held. Momentum is then conserved, by incomplete iterations to rounding error only if all
    /// nodes rotate equally.
    pub free: bool,
    /// Size of an axial unknown relative to a transverse one.
    pub size: f64,
    /// Size of an axial equation relative to a transverse one.
    pub row_size: f64,
}

/// Rotation of each node since a matrix was computed, and its effect on solutions.
///
/// `[E80]` The forces of a beam rotated as a whole rotate with it: `F(Q y, Q y') = Q F(y, y')`, and therefore
///
/// ```text
/// J(Q y) = Q J(y) Qᵀ      J(y) ≈ Q J₀ Qᵀ      J⁻¹ r ≈ Q J₀⁻¹ Qᵀ r      Q: each node's vectors turned by φ_i - φ_i0
/// ```
///
/// for the matrix `J₀` of another state. This is exact if all nodes have rotated equally and only the beam itself acts. Without it a
/// matrix is too old once the axial stiffness has a different direction: after an angle of `(ω_b/ω_a)²`, the squared ratio of bending to
/// stretch frequencies.
#[derive(Clone, Debug)]
pub struct Corotation {
    vectors: Vec<RotatedVectors>,
    /// Directions of nodes at which the matrix was computed.
    made: Vec<Planar<f64>>,
    /// Present directions of nodes.
    now: Vec<Planar<f64>>,
    /// Cosines and sines of the angles between them.
    turn: [Vec<f64>; 2],
    /// True if any of these angles is large enough for a rotation.
    turned: bool,
    /// True if the next state is that of the matrix.
    renewed: bool,
}

impl Corotation {
    /// Creates the corotation of equations that have no matrix yet.
    pub fn new<D: Dae>(dae: &D) -> Self {
        let vectors = dae.vectors();
        let nodes = vectors.iter().map(|v| v.node + v.across.len()).max().unwrap_or(0);
        let straight = vec![Planar::new(0.0, 1.0); nodes];
        Self {
            vectors,
            made: straight.clone(),
            now: straight,
            turn: [vec![1.0; nodes], vec![0.0; nodes]],
            turned: false,
            renewed: true,
        }
    }

    /// Records that a new matrix is computed; its state is that of the next [`Corotation::look`].
    pub fn renew(&mut self) {
        self.renewed = true;
    }

    /// Reads the directions of the beam at the last residual evaluation.
    pub fn look<D: Dae>(&mut self, dae: &D) {
        if self.vectors.is_empty() {
            return;
        }
        dae.directions(&mut self.now);
        if self.vectors.iter().any(|vectors| vectors.free) {
            let all = self.now.iter().fold(Planar::zero(), |sum, &one| sum + one);
            self.now.fill(all.unit());
        }
        if std::mem::take(&mut self.renewed) {
            self.made.copy_from_slice(&self.now);
            self.turned = false;
            return;
        }
        let [cos, sin] = &mut self.turn;
        wide!(angles(&self.made, &self.now, cos, sin));
        self.turned = sin.iter().zip(cos).any(|(sin, cos)| sin.abs() > LITTLE || *cos < 0.0);
    }

    /// True if the matrix is rotated.
    pub fn turned(&self) -> bool {
        self.turned
    }

    /// `r ← Qᵀ r`, for a residual.
    pub fn back(&self, r: &mut [f64]) {
        self.apply(r, |vectors| vectors.row_size, -1.0);
    }

    /// `x ← Q x`, for unknowns.
    pub fn forth(&self, x: &mut [f64]) {
        self.apply(x, |vectors| vectors.size, 1.0);
    }

    fn apply(&self, v: &mut [f64], size: fn(&RotatedVectors) -> f64, sense: f64) {
        if !self.turned {
            return;
        }
        for vectors in &self.vectors {
            let (before, behind) = v.split_at_mut(vectors.along.start);
            let (x, z) = (&mut before[vectors.across.clone()], &mut behind[..vectors.along.len()]);
            let nodes = vectors.node..vectors.node + x.len();
            let [cos, sin] = self.turn.each_ref().map(|of| &of[nodes.clone()]);
            let size = size(vectors);
            wide!(turn(x, z, [cos, sin], [sense * size, sense / size]));
        }
    }
}

/// Cosines and sines of the angles from the unit vectors `from` to `to`.
#[inline(always)]
fn angles(from: &[Planar<f64>], to: &[Planar<f64>], cos: &mut [f64], sin: &mut [f64]) {
    for (((from, to), cos), sin) in from.iter().zip(to).zip(cos).zip(sin) {
        *cos = from.dot(*to);
        *sin = from.cross(*to);
    }
}

/// Rotates vectors `(x, z)` whose z has a unit of its own.
#[inline(always)]
fn turn(x: &mut [f64], z: &mut [f64], [cos, sin]: [&[f64]; 2], [along, across]: [f64; 2]) {
    for (((x, z), cos), sin) in x.iter_mut().zip(z).zip(cos).zip(sin) {
        (*x, *z) = (cos * *x + along * sin * *z, cos * *z - across * sin * *x);
    }
}
