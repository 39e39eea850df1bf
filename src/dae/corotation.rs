//! Newton's matrix, carried along by a beam that turns.

use std::ops::Range;

use super::Dae;
use crate::numerics::{Planar, wide};

/// Sines of angles from which on a matrix is turned: scenes in which nothing turns as far are spared the work, and turn no fewer matrices for it.
const LITTLE: f64 = 1e-2;

/// Unknowns that are vectors in the plane, one a node; their equations are vectors likewise.
#[derive(Clone, Debug, PartialEq)]
pub struct Vectors {
    /// Where their components across stand, in the order of the nodes.
    pub across: Range<usize>,
    /// Where those along stand: as many, further behind.
    pub along: Range<usize>,
    /// Node of the first.
    pub node: usize,
    /// Whether no node is held: momentum is kept then, and by iterations to round-off only where all nodes turn alike.
    pub free: bool,
    /// Size of an unknown along, over that of one across.
    pub size: f64,
    /// Size of an equation along, over that of one across.
    pub row_size: f64,
}

/// How far each node has turned since a matrix was made, and what that makes of its solutions.
///
/// `[E80]` A beam that is turned as a whole has the same forces, turned: `F(Q y, Q y') = Q F(y, y')`, and so
///
/// ```text
/// J(Q y) = Q J(y) Qᵀ      J(y) ≈ Q J₀ Qᵀ      J⁻¹ r ≈ Q J₀⁻¹ Qᵀ r      Q: each node's vectors turned by φ_i - φ_i0
/// ```
///
/// of the matrix `J₀` of another state, exactly where all nodes have turned alike and nothing but the beam itself acts. Without it a matrix is too old when
/// axial stiffness points elsewhere: after an angle of `(ω_b/ω_a)²`, the square of frequencies of bending over those of stretch.
#[derive(Clone, Debug)]
pub struct Corotation {
    vectors: Vec<Vectors>,
    /// Directions of nodes where the matrix was made.
    made: Vec<Planar<f64>>,
    /// And where it is used.
    now: Vec<Planar<f64>>,
    /// Cosines and sines of the angles in between.
    turn: [Vec<f64>; 2],
    /// Whether any of these is anything.
    turned: bool,
    /// Whether the next state is that of the matrix.
    renewed: bool,
}

impl Corotation {
    /// Of equations without a matrix.
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

    /// A new matrix is made: its state is that of the next [`Corotation::look`].
    pub fn renew(&mut self) {
        self.renewed = true;
    }

    /// Takes up how the beam stands where the residual was evaluated last.
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

    /// Whether the matrix is turned.
    pub fn turned(&self) -> bool {
        self.turned
    }

    /// `r ← Qᵀ r`, of a residual.
    pub fn back(&self, r: &mut [f64]) {
        self.apply(r, |vectors| vectors.row_size, -1.0);
    }

    /// `x ← Q x`, of unknowns.
    pub fn forth(&self, x: &mut [f64]) {
        self.apply(x, |vectors| vectors.size, 1.0);
    }

    fn apply(&self, v: &mut [f64], size: fn(&Vectors) -> f64, sense: f64) {
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

/// Cosines and sines of the angles from unit vectors to others.
#[inline(always)]
fn angles(from: &[Planar<f64>], to: &[Planar<f64>], cos: &mut [f64], sin: &mut [f64]) {
    for (((from, to), cos), sin) in from.iter().zip(to).zip(cos).zip(sin) {
        *cos = from.dot(*to);
        *sin = from.cross(*to);
    }
}

/// Turns vectors `(x, z)` of which z counts in units of its own.
#[inline(always)]
fn turn(x: &mut [f64], z: &mut [f64], [cos, sin]: [&[f64]; 2], [along, across]: [f64; 2]) {
    for (((x, z), cos), sin) in x.iter_mut().zip(z).zip(cos).zip(sin) {
        (*x, *z) = (cos * *x + along * sin * *z, cos * *z - across * sin * *x);
    }
}
