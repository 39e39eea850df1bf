//! Highest BDF order that is stable for a scene.
//!
//! BDF of order 1 and 2 damps every oscillation that decays. At steps of about their period, orders 3, 4 and 5 amplify waves with
//! damping ratios below 0.069, 0.287 and 0.618 (cosines of their stability angles 86.0, 73.4 and 51.8 degrees). An undamped
//! beam always has such waves.

use crate::case::schema::{Case, MaxOrder};
use crate::discrete::System;
use crate::discrete::waves::{ENOUGH, carries, highest_frequency, least_damping_ratio};
use crate::error::numbers::{quantity, significant};

/// Highest order and its reason.
#[derive(Clone, Debug, PartialEq)]
pub struct OrderChoice {
    /// 1 to 5.
    pub order: u8,
    /// Reason, as text.
    pub reason: String,
}

/// Chooses the highest order for a case: the requested one, else one derived from the scene.
pub fn choose(case: &Case, system: &System) -> OrderChoice {
    let chosen = |order, reason: String| OrderChoice { order, reason };
    match case.solver.max_order {
        MaxOrder::Order(order) => chosen(order, "as requested".into()),
        MaxOrder::Forced(order) => chosen(order, "forced".into()),
        MaxOrder::Auto if !carries(system) => chosen(5, "no inertia: nothing oscillates freely".into()),
        MaxOrder::Auto => match least_damping_ratio(system) {
            0.0 => chosen(
                2,
                "undamped inertia: BDF beyond order 2 is unstable for its waves".into(),
            ),
            ratio if ratio < ENOUGH => chosen(
                2,
                format!(
                    "the least damped wave has a damping ratio of {}, below {ENOUGH}: BDF beyond order 2 is unstable for it",
                    significant(ratio, 2)
                ),
            ),
            ratio => chosen(
                5,
                format!(
                    "every wave has a damping ratio of {} or more ({ENOUGH} suffices)",
                    significant(ratio, 2)
                ),
            ),
        },
    }
}

/// Warns if stability and not accuracy limited the steps of a run. Orders above 2 were then allowed for weakly damped waves, and
/// the mean step stayed near the period of the fastest wave.
pub fn held_by_stability(system: &System, order: u8, time: f64, steps: u64, rejected: u64) -> Option<String> {
    if order <= 2 || !carries(system) || steps < 1000 {
        return None;
    }
    let ratio = least_damping_ratio(system);
    let reach = time / steps as f64 * highest_frequency(system);
    let limited = ratio < ENOUGH && reach < 10.0;
    limited.then(|| {
        format!(
            "the steps ({} on average, {reach:.2} over the highest frequency of the mesh, {rejected} rejected) are \
             limited by the stability of BDF order {order}, not by accuracy. Set /solver/max_order to 2.",
            quantity(time / steps as f64, "s", 2)
        )
    })
}

/// Least number of steps for a warning about rejections, and the rejected fraction above which it is given.
const MANY: u64 = 200;
const TOO_MANY: f64 = 1.0 / 3.0;

/// Warns if BDF's error test rejected more than a third of many steps: steps stay short and of low order, and the error is
/// unknown. `chosen` is true if the program chose the method.
pub fn stuck(steps: u64, rejected: u64, chosen: bool) -> Option<String> {
    let often = steps >= MANY && rejected as f64 > TOO_MANY * steps as f64;
    let instead = if chosen { "esdirk46" } else { "auto" };
    often.then(|| {
        format!(
            "IDA is stuck: its error test rejected {rejected} steps and accepted {steps}. Steps are short, their \
             order is low, and the error is unknown. Set /solver/method to {instead}."
        )
    })
}
