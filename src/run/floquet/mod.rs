//! Floquet multipliers of a cycle: what a small disturbance is multiplied by from one period to the next.
//!
//! ```text
//! shape    what a disturbance is made of
//! verdict  stable or not, and by what, in words
//! ```

pub mod shape;
pub mod verdict;

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::periodic::{Cycle, Scene};
use crate::numerics::krylov;
use shape::{Modes, Part};

pub use verdict::{Stability, Verdict};

/// Residual of a multiplier's vector, relative to one.
const RESIDUAL: f64 = 1e-8;
/// Multipliers below this have died before a period is over: no frequency or rate can be read from them.
const DEAD: f64 = 1e-9;
/// Vectors of the Krylov space at most.
const MOST_VECTORS: usize = 600;

/// One multiplier; of a complex pair the one with positive angle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Multiplier {
    /// Real part.
    pub re: f64,
    /// Imaginary part, >= 0.
    pub im: f64,
    /// Modulus.
    pub modulus: f64,
    /// Growth rate [1/s], negative when it decays.
    pub growth_per_s: f64,
    /// Frequency [Hz]: of those that the angle allows, which differ by multiples of the drive, the nearest to that at which the disturbance
    /// turns within a period; where steps are too long to follow it, to that of its part when dry.
    pub frequency_hz: f64,
    /// What most of its energy is in.
    pub part: Part,
    /// Its share of the energy.
    pub share: f64,
    /// Rate by which the integrator's steps damp that motion more than it decays by itself [1/s]: to be far below the growth rate.
    pub numerical_damping_per_s: f64,
    /// `|M v - μ v|` of its vector of norm one.
    pub residual: f64,
}

/// What is known of a cycle's stability.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Floquet {
    /// Period [s].
    pub period_s: f64,
    /// Whether anything is driven.
    pub driven: bool,
    /// Multipliers exactly one that stand for conserved volumes; left out below.
    pub conserved: usize,
    /// The others, largest first.
    pub multipliers: Vec<Multiplier>,
    /// Stable or not, and by what.
    pub verdict: Verdict,
}

/// `[E38]` The `count` largest multipliers of a cycle.
///
/// ```text
/// M v = μ v     growth ln|μ|/T     frequency (arg μ + 2π k)/(2π T), k whole
/// ```
///
/// M is the derivative of the period map as its steps are. Conserved volumes make as many left vectors `wᵀ M = wᵀ`; M leaves
/// the states across them to themselves, and there their multipliers, exactly one, do not occur.
pub fn multipliers(scene: &Scene, cycle: &mut Cycle, count: usize) -> Floquet {
    let mut start = krylov::everything(cycle.y.len());
    scene.admit(&mut start);
    let modes = Modes::new(&scene.system, &cycle.y);
    let most = scene.dimension().min(MOST_VECTORS);
    let found = krylov::largest(
        |v| {
            cycle.march.propagate(v);
            scene.admit(v);
        },
        &start,
        count.min(most),
        RESIDUAL,
        most,
    );
    let period = scene.drive.period;
    let multipliers: Vec<Multiplier> = found
        .into_iter()
        .filter(|eigen| eigen.value.norm() > DEAD)
        .map(|eigen| {
            let (part, share) = modes.dominant(&scene.system, &eigen.vector);
            let dry = modes.frequency(&scene.system, part, &eigen.vector);
            let own = turns(scene, cycle, &modes, part, &eigen.vector, dry).unwrap_or(dry);
            let frequency = nearest(eigen.value.arg(), period, own);
            let growth = eigen.value.norm().ln() / period;
            Multiplier {
                re: eigen.value.re,
                im: eigen.value.im,
                modulus: eigen.value.norm(),
                growth_per_s: growth,
                frequency_hz: frequency / TAU,
                part,
                share,
                numerical_damping_per_s: numerical_damping(scene, cycle.march.times(), [growth, frequency]),
                residual: eigen.residual,
            }
        })
        .collect();
    let verdict = verdict::judge(&multipliers, scene.drive.driven, scene.rtol, period);
    Floquet {
        period_s: period,
        driven: scene.drive.driven,
        conserved: scene.conserved.len(),
        multipliers,
        verdict,
    }
}

/// Angle that a part may turn by in a step [rad], by its frequency when dry, for its turns to be counted.
const FOLLOWED: f64 = 2.0;

/// How fast a disturbance `a + ib` swings in a part of the beam [1/s]: the angle by which it turns there over a period, step by step, whole
/// turns included, which the multiplier does not tell. None where steps are too long to follow it, or nothing turns.
///
/// ```text
/// Σₙ arg⟨cₙ, cₙ₊₁⟩ / T     c coordinates whose squares are twice the energy
/// ```
fn turns(scene: &Scene, cycle: &mut Cycle, modes: &Modes, part: Part, v: &[Vec<f64>; 2], dry: f64) -> Option<f64> {
    let longest = cycle.march.times().windows(2).map(|t| t[1] - t[0]).fold(0.0, f64::max);
    let n = v[0].len();
    if part == Part::Fluid || dry * longest > FOLLOWED || v[1].iter().all(|x| *x == 0.0) {
        return None;
    }
    let mut block = [&v[0][..], &v[1]].concat();
    let mut before: Option<[Vec<f64>; 2]> = None;
    let mut total = 0.0;
    cycle.march.propagate_by_steps(&mut block, &mut |block| {
        let now = [0, 1].map(|k| modes.coordinates(&scene.system, part, &block[k * n..(k + 1) * n]));
        if let Some([a, b]) = &before {
            let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
            let [c, d] = &now;
            total += (dot(a, d) - dot(b, c)).atan2(dot(a, c) + dot(b, d));
        }
        before = Some(now);
    });
    Some(total.abs() / scene.drive.period)
}

/// The angular frequency [1/s] `(±angle + 2π k)/period` nearest to `own`.
fn nearest(angle: f64, period: f64, own: f64) -> f64 {
    let candidate = |angle: f64| {
        let k = ((own * period - angle) / TAU).round();
        ((angle + TAU * k) / period).abs()
    };
    let (a, b) = (candidate(angle), candidate(-angle));
    if (a - own).abs() <= (b - own).abs() { a } else { b }
}

/// Rate [1/s] by which the steps damp what grows at a rate and turns at an angular frequency [1/s] more than it decays by itself.
fn numerical_damping(scene: &Scene, times: &[f64], [growth, w]: [f64; 2]) -> f64 {
    let tableau = scene.method.tableau();
    let lost: f64 = times
        .windows(2)
        .map(|t| {
            let h = t[1] - t[0];
            let (re, im) = tableau.stability((growth * h, w * h));
            growth * h - re.hypot(im).ln()
        })
        .sum();
    lost / scene.drive.period
}
