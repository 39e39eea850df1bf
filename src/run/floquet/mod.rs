//! Floquet multipliers of a cycle: the factors by which small disturbances change from one period to the next.
//!
//! ```text
//! shape    parts of a disturbance
//! verdict  stability and its cause, as text
//! ```

pub mod shape;
pub mod verdict;

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::periodic::{Cycle, PeriodicScene};
use crate::numerics::{kernels, krylov};
use shape::{DryBendingModes, EnergyPart};

pub use verdict::{CycleStability, CycleVerdict};

/// Residual of a multiplier's vector, relative to one.
const RESIDUAL: f64 = 1e-8;
/// Multipliers below this decay within a period: no frequency or rate can be read from them.
const DEAD: f64 = 1e-9;
/// Largest distance from 1 of the multiplier of a shift in time; the second if its vector is parallel to the flow. Where a motion snaps,
/// the steps displace this multiplier most.
const TRIVIAL: [f64; 2] = [0.01, 0.25];
/// Cosine above which a vector is parallel to the flow.
const PARALLEL: f64 = 0.99;
/// Largest number of vectors of the Krylov space.
const MOST_VECTORS: usize = 600;

/// A multiplier; of a complex pair the one with positive angle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Multiplier {
    /// Real part.
    pub re: f64,
    /// Imaginary part, >= 0.
    pub im: f64,
    /// Modulus.
    pub modulus: f64,
    /// Growth rate [1/s], negative for decay.
    pub growth_per_s: f64,
    /// Frequency [Hz], which the angle determines up to multiples of the drive frequency. It is the candidate nearest to the measured
    /// rotation of the disturbance within a period. If steps are too long to follow it, it is the one nearest to the dry frequency of
    /// its part.
    pub frequency_hz: f64,
    /// Part with most of its energy.
    pub part: EnergyPart,
    /// Fraction of the energy in this part.
    pub share: f64,
    /// Rate by which the integrator's steps damp the motion beyond its own decay [1/s]; must be far below the growth rate.
    pub numerical_damping_per_s: f64,
    /// `|M v - μ v|` for its vector of norm one.
    pub residual: f64,
}

/// Stability of a cycle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Floquet {
    /// Period [s].
    pub period_s: f64,
    /// True if any signal drives the case.
    pub driven: bool,
    /// Number of multipliers that are exactly one because a volume is conserved; omitted below.
    pub conserved: usize,
    /// Multiplier of a shift in time along a self-oscillation: one, except for the error of the steps; omitted below.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trivial: Option<Multiplier>,
    /// Other multipliers, largest first.
    pub multipliers: Vec<Multiplier>,
    /// Stability and its cause.
    pub verdict: CycleVerdict,
}

/// `[E38]` The `count` largest multipliers of a cycle.
///
/// ```text
/// M v = μ v     growth ln|μ|/T     frequency (arg μ + 2π k)/(2π T), k whole
/// ```
///
/// M is the derivative of the discrete period map. Each conserved volume has a left vector with `wᵀ M = wᵀ`. M maps the states
/// orthogonal to these vectors to such states, and their multipliers, exactly one, do not occur there.
pub fn multipliers(scene: &PeriodicScene, cycle: &mut Cycle, count: usize) -> Floquet {
    let mut start = krylov::everything(cycle.y.len());
    scene.admit(&mut start);
    let modes = DryBendingModes::new(&scene.system, &cycle.y);
    let most = scene.dimension().min(MOST_VECTORS);
    let found = krylov::largest(
        |v| {
            cycle.march.propagate(v);
            scene.admit(v);
        },
        &start,
        (count + usize::from(scene.free_period)).min(most),
        RESIDUAL,
        most,
    );
    let period = scene.drive.period;
    let shift = scene.free_period.then(|| along_flow(scene, cycle, &found)).flatten();
    let mut multipliers: Vec<Multiplier> = found
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
    let trivial = shift.map(|k| multipliers.remove(k));
    multipliers.truncate(count);
    let verdict = verdict::judge(&multipliers, scene);
    Floquet {
        period_s: period,
        driven: scene.drive.driven,
        conserved: scene.conserved.len(),
        trivial,
        multipliers,
        verdict,
    }
}

/// Index of the multiplier of a shift in time: the one near 1 whose vector is most parallel to the flow `y'` at the start.
fn along_flow(scene: &PeriodicScene, cycle: &Cycle, found: &[krylov::Eigen]) -> Option<usize> {
    let mut flow = cycle.yp.clone();
    scene.admit(&mut flow);
    let speed = kernels::dot(&flow, &flow).sqrt();
    let parallel = |eigen: &krylov::Eigen| {
        let parts = [0, 1].map(|k| kernels::dot(&flow, &eigen.vector[k]));
        parts[0].hypot(parts[1]) / speed
    };
    let near = |eigen: &krylov::Eigen| {
        let [always, along] = TRIVIAL;
        let limit = if parallel(eigen) > PARALLEL { along } else { always };
        (eigen.value - 1.0).norm() < limit
    };
    let candidates = found.iter().enumerate().filter(|(_, eigen)| near(eigen));
    let best = candidates.max_by(|a, b| parallel(a.1).total_cmp(&parallel(b.1)));
    best.map(|(k, _)| k)
}

/// Largest angle [rad] by which a part may turn in a step, at its dry frequency, for its turns to be counted.
const FOLLOWED: f64 = 2.0;

/// Angular frequency [1/s] of a disturbance `a + ib` in a part of the beam: its rotation there over a period, summed step by step.
/// The sum includes whole turns, which the multiplier does not contain. `None` if steps are too long to follow the rotation, or
/// if nothing rotates.
///
/// ```text
/// Σₙ arg⟨cₙ, cₙ₊₁⟩ / T     c coordinates whose squares are twice the energy
/// ```
fn turns(
    scene: &PeriodicScene,
    cycle: &mut Cycle,
    modes: &DryBendingModes,
    part: EnergyPart,
    v: &[Vec<f64>; 2],
    dry: f64,
) -> Option<f64> {
    let longest = cycle.march.times().windows(2).map(|t| t[1] - t[0]).fold(0.0, f64::max);
    let n = v[0].len();
    if part == EnergyPart::Fluid || dry * longest > FOLLOWED || v[1].iter().all(|x| *x == 0.0) {
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

/// Angular frequency [1/s] of the form `(±angle + 2π k)/period` that is nearest to `own`.
fn nearest(angle: f64, period: f64, own: f64) -> f64 {
    let candidate = |angle: f64| {
        let k = ((own * period - angle) / TAU).round();
        ((angle + TAU * k) / period).abs()
    };
    let (a, b) = (candidate(angle), candidate(-angle));
    if (a - own).abs() <= (b - own).abs() { a } else { b }
}

/// Rate [1/s] by which the steps damp a motion of given growth rate and angular frequency [1/s] beyond its own decay.
fn numerical_damping(scene: &PeriodicScene, times: &[f64], [growth, w]: [f64; 2]) -> f64 {
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
