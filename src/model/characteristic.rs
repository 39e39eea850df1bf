//! Characteristic numbers of a case, printed before a run (`docs/model.md` section 11).

use std::collections::BTreeMap;
use std::f64::consts::PI;

use nalgebra::Matrix2;

use super::network::LinkKind;
use super::{
    AmbientFluid, AttachedBody, DistributedLoad, FrameRotation, Model, each_signal, parametric_growth, relaxation_times,
};
use crate::case::relaxation::{self, dynamic_modulus};
use crate::case::schema::Effect;
use crate::case::schema::{Case, ChainEnd};
use crate::case::{ResolvedEnd, Rotation, Translation};
use crate::functions::Signal;

/// `κ_1` of the clamped-free beam under axial base acceleration.
pub const MATHIEU_COUPLING: f64 = 1.570_878_189_99;

/// Parametric excitation of the first bending mode by axial base motion:
/// `q'' + [ω1² - κ_1 a(t)/l_s] q = 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MathieuTongue {
    /// Amplitude of `a(t)` [m/s^2].
    pub acceleration: f64,
    /// Frequency of `a(t)` [Hz].
    pub frequency: f64,
    /// `ε = κ_1 a/(l_s ω1²)`.
    pub modulation: f64,
    /// Growth rate of the undamped single mode with the bladders drained [1/s]; 0 when stable.
    pub growth_rate: f64,
    /// Upper bound of the growth rate, with axial stretch and rotary inertia [1/s].
    pub growth_bound: f64,
}

/// Characteristic numbers by name; the name contains the SI unit.
pub fn numbers(case: &Case, model: &Model) -> BTreeMap<String, f64> {
    numbers_with(case, model, mathieu(model).as_ref())
}

/// Numbers of a single beam, which a structure does not have.
const OF_ONE_BEAM: [&str; 11] = [
    "shear_flexibility",
    "t_s_s",
    "first_bending_frequency_hz",
    "first_bending_frequency_in_shear_hz",
    "first_bending_frequency_relaxing_hz",
    "first_bending_damping_ratio",
    "first_bending_frequency_in_fluid_hz",
    "first_axial_frequency_hz",
    "euler_load_n",
    "self_weight_buckling_load_n_m",
    "largest_strain_estimate",
];

/// [`numbers`] with Mathieu's parameters given.
pub fn numbers_with(case: &Case, model: &Model, mathieu: Option<&MathieuTongue>) -> BTreeMap<String, f64> {
    let mut all = of_one_beam(case, model, mathieu);
    if let Some(structure) = &model.structure {
        all.retain(|name, _| !OF_ONE_BEAM.contains(&name.as_str()));
        // of the stubbiest beam
        let beams = structure.beams.iter();
        let slender = beams.map(|beam| beam.whole / (2.0 * beam.model.section.half_height));
        all.insert("slenderness".into(), slender.fold(f64::INFINITY, f64::min));
    }
    all
}

fn of_one_beam(case: &Case, model: &Model, mathieu: Option<&MathieuTongue>) -> BTreeMap<String, f64> {
    let mut all = BTreeMap::new();
    let mut put = |name: &str, value: f64| {
        if value.is_finite() {
            all.insert(name.to_string(), value);
        }
    };
    let s = &model.section;
    let (l, m, ea, ei) = (model.length, s.mass_per_length, s.axial_stiffness, s.bending_stiffness);
    put("mass_factor", s.mass_factor);
    put("mass_per_length_kg_m", m);
    put("axial_stiffness_n", ea);
    put("bending_stiffness_n_m2", ei);
    put("gyration_radius_squared_m2", s.gyration_radius_squared);
    if s.shear_stiffness.is_finite() {
        put("shear_stiffness_n", s.shear_stiffness);
        put("shear_flexibility", ei / (s.shear_stiffness * l * l));
    }
    put("slenderness", l / (2.0 * s.half_height));
    let solid_time = (m * l.powi(4) / ei).sqrt();
    put("t_s_s", solid_time);
    let first = first_wave_number(model.root_and_tip());
    if !model.relaxation.is_empty() {
        put("instantaneous_modulus_pa", s.stiffening * case.beam.young_modulus_pa);
    }
    let loss_factor = case.beam.viscoelasticity.as_ref().and_then(|v| v.loss_factor);
    if let Some(band) = loss_factor {
        let at = |hertz: f64| dynamic_modulus(&model.relaxation, 2.0 * PI * hertz);
        put(
            "storage_modulus_from_pa",
            at(band.from_hz)[0] * case.beam.young_modulus_pa,
        );
        put("storage_modulus_to_pa", at(band.to_hz)[0] * case.beam.young_modulus_pa);
    }
    if let Some(beta) = first {
        let dry = beta * beta / (2.0 * PI * solid_time);
        put("first_bending_frequency_hz", dry);
        if model.effects.has(Effect::Shear) {
            put(
                "first_bending_frequency_in_shear_hz",
                s.sheared(2.0 * PI * dry) / (2.0 * PI),
            );
        }
        if !model.relaxation.is_empty() {
            let [omega, decay] = relaxation::vibration(&model.relaxation, 2.0 * PI * dry);
            put("first_bending_frequency_relaxing_hz", omega / (2.0 * PI));
            put("first_bending_damping_ratio", decay / omega.hypot(decay));
        }
        if model.surroundings.is_some() {
            put("added_mass_kg_m", s.ambient.added_mass);
            put(
                "first_bending_frequency_in_fluid_hz",
                dry / (1.0 + s.ambient.added_mass / m).sqrt(),
            );
        }
    }
    put("first_axial_frequency_hz", first_axial_frequency(model) / (2.0 * PI));
    if is_cantilever(model) {
        put("euler_load_n", PI * PI * ei / (4.0 * l * l));
        put("self_weight_buckling_load_n_m", 7.837_347_438_94 * ei / l.powi(3));
    }
    if let Some(a) = mathieu {
        put("base_acceleration_m_s2", a.acceleration);
        put("inertial_compression_n_m", m * a.acceleration);
        put("mathieu_modulation", a.modulation);
        put(
            "mathieu_frequency_ratio",
            a.frequency * 2.0 * PI * solid_time / (2.0 * first.unwrap_or(1.875).powi(2)),
        );
        put("mathieu_growth_rate_per_s", a.growth_rate);
        put("mathieu_growth_bound_per_s", a.growth_bound);
    }
    let forcing = forcing_frequency(case);
    if let Some(f) = forcing {
        put("forcing_frequency_hz", f);
    }
    if let (Some(wet), Some(bladders), Some(fluid)) = (&model.wet, &case.bladders, &case.fluid) {
        put(
            "bladder_compliance_m3_pa",
            wet.area[0].per_pressure * wet.bladder_length,
        );
        let bladder_resistance = wet.bladder_length / wet.network.bladder_mobility;
        put("bladder_resistance_pa_s_m3", bladder_resistance);
        if let Some(tubes) = &case.tubes {
            let in_one = wet
                .network
                .chains
                .iter()
                .map(|c| c.len() - 1)
                .max()
                .unwrap_or(wet.network.tubes)
                .max(1);
            let slender = 2.0 * tubes.radius_m / (tubes.length_m * in_one as f64);
            let fluid_time = fluid.viscosity_pa_s * wet.area[0].per_pressure
                / (PI * tubes.radius_m * tubes.radius_m * slender * slender);
            put("t_f_s", fluid_time);
            put("t_s_over_t_f", solid_time / fluid_time);
            if let Some(f) = forcing {
                put("f_u", f * fluid_time);
            }
            let tube = wet.network.links.iter().find(|link| link.kind == LinkKind::Tube);
            if let Some(tube) = tube {
                put("tube_resistance_pa_s_m3", tube.resistance);
                put(
                    "bladder_tube_time_s",
                    wet.compliance() * wet.bladder_length * (bladder_resistance + tube.resistance),
                );
            }
        }
        let tubes = wet
            .network
            .links
            .iter()
            .filter(|link| link.kind == LinkKind::Tube && !link.is_shut());
        if let Some([narrow, wide]) = tubes
            .map(|tube| [tube.radius; 2])
            .reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
        {
            if let Some(f) = forcing {
                put(
                    "womersley",
                    wide * (2.0 * PI * f * fluid.density_kg_m3 / fluid.viscosity_pa_s).sqrt(),
                );
            }
            let pumped = model.scales.frequency * wet.compliance() * wet.bladder_length * model.scales.pressure;
            let flow = pumped.max(wet.network.fed_tubes(case.time.end_s));
            put(
                "reynolds_estimate",
                2.0 * fluid.density_kg_m3 * flow / (PI * fluid.viscosity_pa_s * narrow),
            );
        }
        for (k, time) in relaxation_times::times(wet).into_iter().enumerate() {
            if let Some(time) = time {
                put(&format!("slowest_time_of_network_{}_s", k + 1), time);
            }
        }
        put(
            "bladder_fill",
            2.0 * bladders.per_row as f64 * bladders.width_m / (2.0 * l),
        );
        let closing = wet.area[0].per_pressure * model.scales.pressure / wet.area[0].at_rest;
        put("area_change_estimate", closing);
    }
    put("force_scale_n", model.scales.force);
    put("largest_strain_estimate", {
        let laws = model.bending.iter().map(|law| law.curvature(model.scales.moment));
        let curvature = laws.reduce(f64::max).unwrap_or(model.scales.moment / ei);
        model.scales.force / ea + curvature * model.section.half_height
    });
    all
}

/// True if the root is clamped and the tip free.
fn is_cantilever(model: &Model) -> bool {
    let kind = |k: usize| end_kind(&model.ends[k]);
    kind(0) == (true, true) && kind(1) == (false, false)
}

/// Flags of an end: displacement across prescribed, slope prescribed.
fn end_kind(e: &ResolvedEnd) -> (bool, bool) {
    (
        matches!(e.transverse, Translation::Displacement(_)),
        matches!(e.rotation, Rotation::Slope(_)),
    )
}

/// `β l_s` of the first bending mode with a frequency above zero.
pub fn first_wave_number(ends: &[ResolvedEnd; 2]) -> Option<f64> {
    let (a, b) = (end_kind(&ends[0]), end_kind(&ends[1]));
    let clamped = (true, true);
    let pinned = (true, false);
    let guided = (false, true);
    let free = (false, false);
    Some(match (a, b) {
        (x, y) if (x, y) == (clamped, free) || (x, y) == (free, clamped) => 1.875_104_068_712,
        (x, y) if x == y && (x == clamped || x == free) => 4.730_040_744_862_7,
        (x, y) if x == y => PI,
        (x, y) if [(clamped, pinned), (pinned, clamped), (free, pinned), (pinned, free)].contains(&(x, y)) => {
            3.926_602_312_047_9
        }
        (x, y) if [(clamped, guided), (guided, clamped), (free, guided), (guided, free)].contains(&(x, y)) => {
            2.365_020_372_431_4
        }
        _ => 0.5 * PI,
    })
}

/// Angular frequency of the first axial mode [1/s].
pub fn first_axial_frequency(model: &Model) -> f64 {
    let section = &model.section;
    axial_wave_number(model) / model.length * (section.axial_stiffness / section.mass_per_length).sqrt()
}

/// `k l_s` of the first axial mode.
fn axial_wave_number(model: &Model) -> f64 {
    let held = |k: usize| matches!(model.ends[k].axial, Translation::Displacement(_));
    if held(0) == held(1) { PI } else { 0.5 * PI }
}

/// Highest frequency among all sines of the case, including those inside sums and products [Hz].
pub fn forcing_frequency(case: &Case) -> Option<f64> {
    let mut highest: Option<f64> = None;
    let mut hear = |s: &Signal| {
        if let Some(f) = s.highest_tone_hz() {
            highest = Some(highest.map_or(f, |h| h.max(f)));
        }
    };
    let ends = [case.ends.root.resolve(), case.ends.tip.resolve()];
    let loads: Vec<DistributedLoad> = case
        .loads
        .iter()
        .flat_map(|load| DistributedLoad::on(load, [1.0; 2]))
        .collect();
    let around = AmbientFluid::from_case(case);
    each_signal(
        &ends,
        &loads,
        &AttachedBody::all(case),
        around.as_ref(),
        FrameRotation::from_case(case).as_ref(),
        None,
        &mut hear,
    );
    if let Some(network) = &case.network {
        for chain in &network.chains {
            hear(&chain.opening);
            for end in &chain.ends {
                if let ChainEnd::PressurePa(signal) | ChainEnd::FlowM3S(signal) = end {
                    hear(signal);
                }
            }
        }
        network.tubes.iter().for_each(|tube| hear(&tube.opening));
        for port in &network.ports {
            port.pressure_pa.iter().chain(&port.flow_m3_s).for_each(&mut hear);
        }
    }
    highest
}

/// Shortest period of the case's sines [s].
pub fn forcing_period(case: &Case) -> Option<f64> {
    forcing_frequency(case).filter(|f| *f > 0.0).map(|f| 1.0 / f)
}

/// Mathieu's parameters of a cantilever with an axial sine motion of its root.
pub fn mathieu(model: &Model) -> Option<MathieuTongue> {
    // a relaxing solid has no single stiffness
    if !is_cantilever(model) || !model.effects.has(Effect::SolidInertia) || !model.relaxation.is_empty() {
        return None;
    }
    let Translation::Displacement(Signal::Sine(sine)) = &model.ends[0].axial else {
        return None;
    };
    let omega = 2.0 * PI * sine.frequency_hz;
    let acceleration = sine.amplitude.abs() * omega * omega;
    if acceleration == 0.0 {
        return None;
    }
    let s = &model.section;
    let first = 1.875_104_068_712_f64.powi(2) / (model.length * model.length)
        * (s.bending_stiffness / s.mass_per_length).sqrt();
    Some(MathieuTongue {
        acceleration,
        frequency: sine.frequency_hz,
        modulation: MATHIEU_COUPLING * acceleration / (model.length * first * first),
        growth_rate: mathieu_growth(first * first, MATHIEU_COUPLING * acceleration / model.length, omega),
        growth_bound: parametric_growth::growth_bound(
            s,
            model.length,
            sine.amplitude,
            omega,
            model.effects.has(Effect::Shear),
        ),
    })
}

/// Growth rate of `q'' + [w2 - a sin(Ω t)] q = 0` [1/s] from the trace of its monodromy matrix; 0 when stable.
///
/// Integrates with the classical Runge-Kutta method. With `n` steps over a period T, the error is about
/// `(ωT)⁵/(120 n⁴)`, ω the largest frequency. It is 1e-12 where 4000 steps suffice.
pub fn mathieu_growth(w2: f64, a: f64, omega: f64) -> f64 {
    let period = 2.0 * PI / omega;
    let turns = (w2.abs() + a.abs()).sqrt() * period;
    let steps = (300.0 * turns.powf(1.25)).clamp(400.0, 4000.0) as u32;
    let h = period / f64::from(steps);
    let stiffness = |t: f64| a * (omega * t).sin() - w2;
    let rate = |of: f64, state: &Matrix2<f64>| {
        let [[q1, v1], [q2, v2]] = state.data.0;
        Matrix2::new(v1, v2, of * q1, of * q2)
    };
    let mut monodromy = Matrix2::identity();
    let mut end = stiffness(0.0);
    for k in 0..steps {
        let t = h * f64::from(k);
        let start = end;
        let middle = stiffness(t + 0.5 * h);
        end = stiffness(t + h);
        let k1 = rate(start, &monodromy);
        let k2 = rate(middle, &(monodromy + 0.5 * h * k1));
        let k3 = rate(middle, &(monodromy + 0.5 * h * k2));
        let k4 = rate(end, &(monodromy + h * k3));
        monodromy += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
    let half_trace = 0.5 * monodromy.trace().abs();
    if half_trace <= 1.0 + 1e-9 {
        0.0
    } else {
        half_trace.acosh() / period
    }
}
