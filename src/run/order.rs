//! Which BDF order a scene can bear.
//!
//! BDF of order 1 and 2 damps every oscillation that decays; orders 3, 4 and 5 amplify waves with damping ratios below
//! 0.069, 0.287 and 0.618 (the cosines of their stability angles 86.0, 73.4 and 51.8 degrees) at steps of about their
//! period. An undamped beam always carries such waves.

use crate::case::schema::{Case, MaxOrder, Method};
use crate::discrete::System;
use crate::error::{Code, Violation};

/// Damping ratio from which on high orders are taken: measured, 5 % nearly removes the trap, 0.5 % does not.
const ENOUGH: f64 = 0.05;

/// Highest order, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct OrderChoice {
    /// 1 to 5.
    pub order: u8,
    /// In words.
    pub reason: String,
}

/// Highest order for a case: as asked, else decided from the scene.
pub fn choose(case: &Case, system: &System) -> OrderChoice {
    let chosen = |order, reason: String| OrderChoice { order, reason };
    match case.solver.max_order {
        MaxOrder::Order(order) => chosen(order, "as asked".into()),
        MaxOrder::Forced(order) => chosen(order, "forced".into()),
        MaxOrder::Auto if system.layout.waves == [false; 2] => {
            chosen(5, "no solid inertia: nothing oscillates freely".into())
        }
        MaxOrder::Auto => match least_damping_ratio(system) {
            0.0 => chosen(
                2,
                "undamped inertia: BDF beyond order 2 is unstable for its waves".into(),
            ),
            ratio if ratio < ENOUGH => chosen(
                2,
                format!(
                    "the least damped wave has a damping ratio of {ratio:.1e} < {ENOUGH}: BDF beyond order 2 is unstable for it"
                ),
            ),
            ratio => chosen(
                5,
                format!("every wave has a damping ratio of {ratio:.1e} >= {ENOUGH} or more"),
            ),
        },
    }
}

/// Why the order asked for is refused, if it is: 3 and 4 on a scene with hardly damped waves.
pub fn refusal(case: &Case, system: &System) -> Option<Violation> {
    let MaxOrder::Order(order @ (3 | 4)) = case.solver.max_order else {
        return None;
    };
    if !matches!(case.solver.method, Method::Auto | Method::Ida) {
        return None;
    }
    let ratio = if system.layout.waves != [false; 2] {
        least_damping_ratio(system)
    } else {
        return None;
    };
    (ratio < ENOUGH).then(|| {
        Violation::new(
            Code::Order, "/solver/max_order",
            format!(
                "BDF of order {order} is unstable for the waves of this beam, whose least damping ratio is {ratio:.1e}: \
                 steps become tiny or rates become garbage"
            ),
        )
        .allowed("\"auto\", 1, 2, or 5 for errors below about 1e-5")
        .hint(format!("use \"auto\"; to see what happens, force it with {{\"forced\": {order}}}"))
    })
}

/// Smallest damping ratio among the waves that the mesh carries: `ζ = c/(2 m ω) + ω τ/2`, bending and axial.
pub fn least_damping_ratio(system: &System) -> f64 {
    let s = &system.model.section;
    let (m, h, l) = (s.mass_per_length, system.mesh.h, system.model.length);
    let bending = (s.bending_stiffness / m).sqrt();
    let axial = (s.axial_stiffness / m).sqrt();
    let families = [
        (
            s.bending_damping_time,
            3.516 * bending / (l * l),
            4.0 * bending / (h * h),
        ),
        (s.axial_damping_time, 1.571 * axial / l, 2.0 * axial / h),
    ];
    let mut least = f64::INFINITY;
    let carried = families
        .into_iter()
        .zip(system.layout.waves)
        .filter(|(_, waves)| *waves);
    for ((time, slowest, fastest), _) in carried {
        let ratio = |omega: f64| s.drag / (2.0 * m * omega) + 0.5 * omega * time;
        least = least.min(ratio(slowest)).min(ratio(fastest));
        if time > 0.0 {
            let between = (s.drag / (m * time)).sqrt();
            if (slowest..fastest).contains(&between) {
                least = least.min(ratio(between));
            }
        }
    }
    least
}

/// Highest angular frequency that the mesh carries [1/s].
pub fn highest_frequency(system: &System) -> f64 {
    let s = &system.model.section;
    let h = system.mesh.h;
    let bending = 4.0 / (h * h) * (s.bending_stiffness / s.mass_per_length).sqrt();
    let axial = 2.0 / h * (s.axial_stiffness / s.mass_per_length).sqrt();
    let carried = [bending, axial].into_iter().zip(system.layout.waves);
    carried.filter(|(_, waves)| *waves).map(|(f, _)| f).fold(0.0, f64::max)
}

/// A sentence when the steps of a run were held down by stability and not by accuracy: orders beyond 2 were allowed on
/// hardly damped waves, and the mean step stayed near the period of the fastest wave.
pub fn held_by_stability(system: &System, order: u8, time: f64, steps: u64, rejected: u64) -> Option<String> {
    if order <= 2 || system.layout.waves == [false; 2] || steps < 1000 {
        return None;
    }
    let ratio = least_damping_ratio(system);
    let reach = time / steps as f64 * highest_frequency(system);
    let limited = ratio < ENOUGH && reach < 10.0;
    limited.then(|| {
        format!(
            "the steps ({:.1e} s on average, {reach:.2} over the highest frequency of the mesh, {rejected} rejected) are \
             held down by the stability of BDF order {order} and not by accuracy: set /solver/max_order to 2",
            time / steps as f64
        )
    })
}
