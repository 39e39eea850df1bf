//! Elastic moments of sections over their curvature, given as tables.

use std::sync::Arc;

use crate::case::schema::{self, Beam, Case};
use crate::case::spans::SegmentValues;
use crate::functions::Interpolation;
use crate::numerics::Scalar;

/// Maximum number of iterations of a scalar equation; bisection alone needs about 60.
const ITERATIONS: usize = 100;

/// `[E91]` Moment over the elastic curvature `e = κ - α_p - κ_0`, through given points:
///
/// ```text
/// M = f(e)      EI = f'(0)      E gains Σ h_i W(e_i),  W = ∫ f de
/// f monotone cubics, straight beyond the points; odd if these have one sign
/// ```
///
/// At an end with a given moment M, `e = f⁻¹(M)`, with branches of [E58] the root of `f(e) + EI Σ g_k (e + α_p - κ_k) = M`. At a node
/// between two segments the moment is continuous: `M = f_l(x) = f_r((e - s_l x)/s_r)`, with the shares s of [E83].
#[derive(Clone, Debug, PartialEq)]
pub struct BendingLaw {
    /// Pieces of positive and of negative curvatures, by their magnitude, ascending.
    sides: [Vec<Piece>; 2],
    /// Largest curvatures of the table of both signs, by their magnitude [1/m]; infinite for a linear law.
    ends: [f64; 2],
}

/// A cubic from one curvature to the next, about its lower end.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    /// Curvature at its lower end [1/m].
    from: f64,
    /// Moment there and its derivatives.
    taylor: [f64; 4],
    /// Energy per length there [J/m].
    energy: f64,
}

/// Moment, its slope, and the energy per length at a curvature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElasticBending {
    /// Moment [N m].
    pub moment: f64,
    /// Its slope [N m^2].
    pub stiffness: f64,
    /// Energy per length [J/m].
    pub energy: f64,
}

impl Piece {
    fn at(&self, curvature: f64) -> ElasticBending {
        let x = curvature - self.from;
        let [m, k, bend, jerk] = self.taylor;
        ElasticBending {
            moment: m + x * (k + x * (bend / 2.0 + x * jerk / 6.0)),
            stiffness: k + x * (bend + x * jerk / 2.0),
            energy: self.energy + x * (m + x * (k / 2.0 + x * (bend / 6.0 + x * jerk / 24.0))),
        }
    }
}

impl BendingLaw {
    /// Law of a checked table.
    pub fn new(table: &schema::MomentCurvature) -> Option<Self> {
        let curve = table.curve()?;
        let given = |sign: f64| {
            let all = table.curvature_1_m.iter().map(move |curvature| sign * curvature);
            all.filter(|magnitude| *magnitude > 0.0)
        };
        let side = |sign: f64| {
            // a table of one sign is odd
            let own = if given(sign).next().is_some() { sign } else { -sign };
            let mut knots: Vec<f64> = given(own).chain([0.0]).collect();
            knots.sort_by(f64::total_cmp);
            let last = knots[knots.len() - 1];
            let mut pieces: Vec<Piece> = vec![];
            for (k, &from) in knots.iter().enumerate() {
                // inside of the piece, or in the straight one beyond the table
                let within = match knots.get(k + 1) {
                    Some(next) => 0.5 * (from + next),
                    None => 1.5 * from - 0.5 * knots[k - 1],
                };
                let jet = curve.inside(own * from, own * within, Interpolation::Monotone);
                let bends = if from == last { 0.0 } else { 1.0 };
                pieces.push(Piece {
                    from,
                    taylor: [
                        own * jet.value,
                        jet.rate,
                        own * bends * jet.acceleration,
                        bends * jet.jerk,
                    ],
                    energy: pieces.last().map_or(0.0, |before| before.at(from).energy),
                });
            }
            (pieces, last)
        };
        let [(positive, up), (negative, down)] = [1.0, -1.0].map(side);
        Some(Self {
            sides: [positive, negative],
            ends: [up, down],
        })
    }

    /// Linear law.
    fn linear(stiffness: f64) -> Self {
        let piece = Piece {
            from: 0.0,
            taylor: [0.0, stiffness, 0.0, 0.0],
            energy: 0.0,
        };
        Self {
            sides: [vec![piece], vec![piece]],
            ends: [f64::INFINITY; 2],
        }
    }

    /// Laws of the segments of a case, of a uniform beam one; empty if all are linear.
    pub fn of_segments(case: &Case, segments: &[SegmentValues]) -> Vec<Arc<Self>> {
        let beams: Vec<&Beam> = match segments {
            [] => vec![&case.beam],
            all => all.iter().map(|one| &one.beam).collect(),
        };
        if beams.iter().all(|beam| beam.moment_curvature.is_none()) {
            return vec![];
        }
        let mut laws: Vec<Arc<Self>> = vec![];
        for (k, beam) in beams.iter().enumerate() {
            let same = k > 0 && beams[k - 1] == *beam;
            let law = || {
                let table = beam.moment_curvature.as_ref().and_then(Self::new);
                Arc::new(table.unwrap_or_else(|| Self::linear(beam.young_modulus_pa * beam.second_moment())))
            };
            laws.push(if same { laws[k - 1].clone() } else { law() });
        }
        laws
    }

    /// Moment, slope and energy at an elastic curvature [1/m].
    pub fn at(&self, curvature: f64) -> ElasticBending {
        let (pieces, size) = (self.side(curvature), curvature.abs());
        let next = pieces.partition_point(|piece| piece.from <= size);
        let at = pieces[next.saturating_sub(1)].at(size);
        ElasticBending {
            moment: at.moment.copysign(curvature),
            ..at
        }
    }

    /// Curvature by a moment [1/m].
    pub fn curvature(&self, moment: f64) -> f64 {
        self.inverse(moment, 0.0).0
    }

    /// Largest slope [N m^2].
    pub fn steepest(&self) -> f64 {
        let slopes = self.sides.iter().flat_map(|pieces| {
            pieces.iter().enumerate().map(|(k, piece)| {
                let end = pieces.get(k + 1).map_or(piece.from, |next| next.from);
                let [_, _, bend, jerk] = piece.taylor;
                let top = (piece.from - bend / jerk).clamp(piece.from, end);
                let places = [piece.from, end, if top.is_nan() { end } else { top }];
                places.map(|x| piece.at(x).stiffness).into_iter().fold(0.0, f64::max)
            })
        });
        slopes.fold(0.0, f64::max)
    }

    /// Root e of `f(e) + c e = M`, with the slope of its left side.
    fn inverse(&self, moment: f64, parallel: f64) -> (f64, f64) {
        let (pieces, size) = (self.side(moment), moment.abs());
        let whole = |piece: &Piece, curvature: f64| {
            let at = piece.at(curvature);
            (at.moment + parallel * curvature, at.stiffness + parallel)
        };
        let next = pieces.partition_point(|piece| whole(piece, piece.from).0 <= size);
        let piece = &pieces[next.saturating_sub(1)];
        let end = pieces.get(next).map_or(f64::INFINITY, |next| next.from);
        let curvature = root(piece.from, end, |curvature| {
            let (value, slope) = whole(piece, curvature);
            (value - size, slope)
        });
        (curvature.copysign(moment), whole(piece, curvature).1)
    }

    fn side(&self, sign: f64) -> &[Piece] {
        &self.sides[usize::from(sign < 0.0)]
    }

    /// Magnitude of a curvature over the end of the table on its side.
    fn share(&self, curvature: f64) -> f64 {
        curvature.abs() / self.ends[usize::from(curvature < 0.0)]
    }
}

/// Law of a node: that of its segment, or of the halves of two segments in series.
#[derive(Clone, Debug, PartialEq)]
pub struct NodeBending {
    left: Arc<BendingLaw>,
    /// Law on the other side, with the shares of both sides in the length of the node.
    right: Option<(Arc<BendingLaw>, [f64; 2])>,
}

impl NodeBending {
    /// Law between two segments with these shares in the length of the node.
    pub fn new(left: &Arc<BendingLaw>, right: &Arc<BendingLaw>, shares: [f64; 2]) -> Self {
        Self {
            left: left.clone(),
            right: (left != right).then(|| (right.clone(), shares)),
        }
    }

    /// Root e of `f(e) + c e = M`, at an end of the beam.
    #[inline]
    pub fn inverse<T: Scalar>(&self, moment: T, parallel: f64) -> T {
        moment.lift(|moment| {
            let (curvature, slope) = self.left.inverse(moment, parallel);
            (curvature, slope.recip())
        })
    }

    /// Moment, slope and energy at the mean of the curvatures of both halves.
    pub fn at(&self, curvature: f64) -> ElasticBending {
        let Some((right, shares)) = &self.right else {
            return self.left.at(curvature);
        };
        let [a, b] = self.halves(right, *shares, curvature);
        let [a, b] = [self.left.at(a), right.at(b)];
        ElasticBending {
            moment: a.moment,
            stiffness: 1.0 / (shares[0] / a.stiffness + shares[1] / b.stiffness),
            energy: shares[0] * a.energy + shares[1] * b.energy,
        }
    }

    /// Moment at a curvature.
    #[inline]
    pub fn moment<T: Scalar>(&self, curvature: T) -> T {
        curvature.lift(|e| {
            let at = self.at(e);
            (at.moment, at.stiffness)
        })
    }

    /// Magnitude of the curvature over the end of its table, the larger one of both halves.
    pub fn share(&self, curvature: f64) -> f64 {
        match &self.right {
            None => self.left.share(curvature),
            Some((right, shares)) => {
                let [a, b] = self.halves(right, *shares, curvature);
                self.left.share(a).max(right.share(b))
            }
        }
    }

    /// Curvatures of both sides, with one moment.
    fn halves(&self, right: &BendingLaw, [here, there]: [f64; 2], curvature: f64) -> [f64; 2] {
        let whole = curvature.abs();
        let other = |x: f64| ((whole - here * x) / there).max(0.0);
        let own = root(0.0, whole / here, |x| {
            let a = self.left.at(x.copysign(curvature));
            let b = right.at(other(x).copysign(curvature));
            (
                a.moment.abs() - b.moment.abs(),
                a.stiffness + b.stiffness * (here / there),
            )
        });
        [own, other(own)].map(|size| size.copysign(curvature))
    }
}

/// Root of an increasing function, given by value and slope, between a place at or below it and one at or above it: Newton's method with
/// bisection.
fn root(mut low: f64, mut high: f64, function: impl Fn(f64) -> (f64, f64)) -> f64 {
    let mut x = low;
    for _ in 0..ITERATIONS {
        let (value, slope) = function(x);
        let next = x - value / slope;
        if next.is_nan() || (next - x).abs() <= 2.0 * f64::EPSILON * x.abs() {
            return next;
        }
        if value < 0.0 {
            low = x;
        } else {
            high = x;
        }
        x = match (low..=high).contains(&next) {
            true => next,
            false => 0.5 * (low + high),
        };
    }
    x
}
