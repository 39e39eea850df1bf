//! Waves on a mesh: frequencies, damping, and orders of BDF that are unstable for them.

use nalgebra::Complex;

use super::fluid_mesh::LinkEnd;
use super::{FluidMesh, System};
use crate::case::schema::{Case, MaxOrder, Method};
use crate::error::numbers::significant;
use crate::error::{Code, Violation};

/// Damping ratio above which high orders are used: in measurements 5 % nearly removes the instability, 0.5 % does not.
pub const ENOUGH: f64 = 0.05;

/// Error if the requested order is 3 or 4 and the waves are weakly damped.
pub fn refusal(case: &Case, system: &System) -> Option<Violation> {
    let MaxOrder::Order(order @ (3 | 4)) = case.solver.max_order else {
        return None;
    };
    if !matches!(case.solver.method, Method::Auto | Method::Ida) || !carries(system) {
        return None;
    }
    let ratio = least_damping_ratio(system);
    (ratio < ENOUGH).then(|| {
        Violation::new(
            Code::Range,
            "/solver/max_order",
            format!(
                "BDF of order {order} is unstable for the waves of this scene: smallest damping ratio {} (limit {ENOUGH}). \
                 Steps become very small, or rates wrong",
                significant(ratio, 2)
            ),
        )
        .allowed("\"auto\", 1, 2, or 5 for errors below about 1e-5")
        .hint(format!(
            "use \"auto\", or force the order with {{\"forced\": {order}}}"
        ))
    })
}

/// True if the mesh has waves of the solid or of the fluid.
pub fn carries(system: &System) -> bool {
    system.layout.waves() != [false; 2] || in_fluid(system).next().is_some()
}

/// Damping ratios and angular frequencies [1/s] of fluid that oscillates through one link against the compliance of its cells, all others
/// at rest. The highest frequency in which a link participates is at most √2 times this one, with similar damping. `ζ = Re Z/(2 Im Z)` at
/// `Im Z = 1/(ω C)`, Z the link's impedance, computed from inertance alone.
fn in_fluid(system: &System) -> impl Iterator<Item = [f64; 2]> + '_ {
    let wet = system.model.wet.as_ref().zip(system.fluid.as_ref());
    wet.into_iter().flat_map(move |(wet, fluid): (_, &FluidMesh)| {
        fluid.links.iter().filter_map(move |link| {
            let law = link.flow.map(|flow| flow.law).filter(|law| law.inertance > 0.0)?;
            let cells = [link.from, link.to]
                .into_iter()
                .filter(|end| matches!(end, LinkEnd::Cell(_)))
                .count();
            let stiffness = cells as f64 / (wet.compliance() * fluid.ds);
            let omega = (stiffness / law.inertance).sqrt();
            let s = Complex::new(0.0, omega);
            let branches = law.branches().map(|(resistance, rate)| s * resistance / (s + rate));
            let impedance = s * law.inertance + link.in_series() + branches.sum::<Complex<f64>>();
            (cells > 0).then(|| [0.5 * impedance.re / impedance.im, omega])
        })
    })
}

/// Smallest damping ratio of the waves on the mesh: `ζ = c/(2 m ω) + ω τ/2` for bending and axial waves, and that of waves of the fluid.
/// Zero with attached masses and springs, because their smaller damping is unknown. Zero also for sections that shear, unless bending is
/// damped.
pub fn least_damping_ratio(system: &System) -> f64 {
    in_fluid(system).fold(of_solid(system), |least, [ratio, _]| least.min(ratio))
}

fn of_solid(system: &System) -> f64 {
    let attached = !system.attached.is_empty() || !system.touching.is_empty() || !system.foundation.is_empty();
    if attached || system.model.frame.is_some() {
        return 0.0;
    }
    let s = &system.model.section;
    let swings = system.layout.turning.rate.is_some();
    if swings && s.bending_damping_time == 0.0 {
        return 0.0;
    }
    let (m, h, l) = (s.mass_per_length, system.mesh.shortest, system.model.length);
    let bending = (s.bending_stiffness / m).sqrt();
    let axial = (s.axial_stiffness / m).sqrt();
    let stiffer = stiffer(system);
    let families = [
        (
            s.bending_damping_time,
            3.516 * bending / (l * l),
            if swings {
                shearing(system)
            } else {
                4.0 * bending / (h * h) * stiffer[0]
            },
        ),
        (s.axial_damping_time, 1.571 * axial / l, 2.0 * axial / h * stiffer[1]),
    ];
    let mut least = f64::INFINITY;
    let carried = families
        .into_iter()
        .zip(system.layout.waves())
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

/// Ratio of the frequencies of the shortest bending and axial waves with [E77] to those without, or an upper limit of it.
fn stiffer(system: &System) -> [f64; 2] {
    if system.mesh.fourth {
        // beside a node between two parts, absolute weights add up to at most 2
        let bending = if system.mesh.parts.len() > 1 { 2.0 } else { 5.0 / 3.0 };
        [f64::sqrt(bending), f64::sqrt(4.0 / 3.0)]
    } else {
        [1.0; 2]
    }
}

/// Highest angular frequency on the mesh [1/s].
pub fn highest_frequency(system: &System) -> f64 {
    let s = &system.model.section;
    let h = system.mesh.shortest;
    let stiffer = stiffer(system);
    let bending = match system.layout.turning.rate {
        Some(_) => s.stiffening.sqrt() * shearing(system),
        None => stiffer[0] * 4.0 / (h * h) * (s.stiffening * s.steepest_bending / s.mass_per_length).sqrt(),
    };
    let axial = stiffer[1] * 2.0 / h * (s.stiffening * s.axial_stiffness / s.mass_per_length).sqrt();
    let carried = [bending, axial].into_iter().zip(system.layout.waves());
    let carried = carried.filter(|(_, waves)| *waves).map(|(frequency, _)| frequency);
    carried
        .chain(in_fluid(system).map(|[_, frequency]| frequency))
        .fold(0.0, f64::max)
}

/// Upper limit of the angular frequency of sections that shear [1/s]: `ω² ≤ 4 kGA/(h² m) + kGA/(m y11) + 4 EI/(h² m y11)`, the sum of the
/// limits of displacements and angles alone.
fn shearing(system: &System) -> f64 {
    let (s, h) = (&system.model.section, system.mesh.shortest);
    let (m, rotary) = (s.mass_per_length, s.mass_per_length * s.gyration_radius_squared);
    let per = 4.0 / (h * h);
    let [bending, shear] = stiffer(system).map(|more| more * more);
    (shear * per * s.shear_stiffness / m + s.shear_stiffness / rotary + bending * per * s.steepest_bending / rotary)
        .sqrt()
}
