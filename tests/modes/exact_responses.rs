//! Sources: transfer matrices of Rayleigh and Timoshenko beams; the resonance of a tube before a vessel; passivity.
//! Goal: responses include rotary inertia, shear and the inertia of tubes, and no frequency gives power to a passive structure.
//! Tolerance: 1e-6 after extrapolation; rounding errors for networks.

use nalgebra::{Complex, Matrix2, Matrix4};
use serde_json::{Value, json};
use slcbeam::run::response::LinearResponse;

use super::bands::papers;
use super::common::checked;

const TAU: f64 = std::f64::consts::TAU;

fn responses(case: &Value, input: &str, output: &str, frequencies: &[f64]) -> Vec<Complex<f64>> {
    let response = LinearResponse::new(&checked(case), input, &[output.into()], None).unwrap();
    let mut solver = response.solver().unwrap();
    frequencies.iter().map(|hz| solver.at(*hz).unwrap()[0]).collect()
}

/// Length 1 m, EI 1 N m^2, 1 kg/m; a square section of 0.1 m, whose rotary inertia and shear are large.
fn stout(cells: usize, shear: Option<f64>) -> Value {
    let mut case = json!({
        "name": "stout",
        "beam": {"length_m": 1.0, "height_m": 0.1, "width_m": 0.1, "young_modulus_pa": 1.2e5, "density_kg_m3": 100},
        "ends": {"root": {"clamped": {"u1_m": 0.0}}, "tip": "free"},
        "effects": {"rotary_inertia": "on"}, "mesh": {"segments": cells, "cells_per_segment": 1, "order": 4},
        "time": {"end_s": 1.0}
    });
    if let Some(shear) = shear {
        case["beam"]["shear_stiffness_n"] = json!(shear);
    }
    case
}

/// Source: `w' = φ + V/S, φ' = M/EI, M' = -V - ρI ω² φ, V' = -m ω² w`, a transverse shake of the root: `M = V = 0` at the tip. Without
/// shear, `1/S = 0`, it is Rayleigh's beam.
fn shaken(hz: f64, compliance: f64) -> f64 {
    let square = (TAU * hz).powi(2);
    let rotary = 100.0 * 0.1_f64.powi(4) / 12.0;
    #[rustfmt::skip]
    let rates = Matrix4::new(
        0.0, 1.0, 0.0, compliance,
        0.0, 0.0, 1.0, 0.0,
        0.0, -rotary * square, 0.0, -1.0,
        -square, 0.0, 0.0, 0.0,
    );
    let along = rates.exp();
    let free = Matrix2::new(along[(2, 2)], along[(2, 3)], along[(3, 2)], along[(3, 3)]);
    let held = free.try_inverse().unwrap() * nalgebra::Vector2::new(along[(2, 0)], along[(3, 0)]);
    along[(0, 0)] - along[(0, 2)] * held.x - along[(0, 3)] * held.y
}

#[test]
fn stout_beams_answer_as_rayleigh_and_timoshenko_say() {
    let frequencies = [0.3, 0.9, 2.5, 6.0];
    for shear in [None, Some(40.0)] {
        let [coarse, fine] = [64, 128].map(|cells| {
            let case = stout(cells, shear);
            responses(&case, "/ends/root/clamped/u1_m", "tip_u1", &frequencies)
        });
        for (k, hz) in frequencies.into_iter().enumerate() {
            let (found, exact) = (
                fine[k] + (fine[k] - coarse[k]) / 15.0,
                shaken(hz, shear.map_or(0.0, f64::recip)),
            );
            assert!(
                (found - exact).norm() < 1e-6 * exact.abs(),
                "{shear:?} {hz} Hz: {found} for {exact}"
            );
        }
    }
}

/// Source: a tube of resistance `R = 8 μ l/(π r⁴)` and inertance `I = 4/3 ρ l/(π r²)` before a vessel of compliance C, the fluid's Helmholtz
/// resonator: `p/p_port = 1/(1 - ω² I C + i ω R C)`.
#[test]
fn a_vessel_behind_a_tube_resonates() {
    let (length, radius, compliance) = (0.5, 2e-3, 1e-10);
    let case = json!({
        "name": "resonator", "ends": {"root": "clamped", "tip": "free"},
        "beam": {"length_m": 0.1, "height_m": 0.01, "width_m": 0.01, "young_modulus_pa": 1e6, "density_kg_m3": 1000},
        "fluid": {"density_kg_m3": 1000, "viscosity_pa_s": 1e-3}, "tubes": {"length_m": length, "radius_m": radius},
        "network": {"junctions": ["in", "vessel"], "tubes": [{"from": {"junction": "in"}, "to": {"junction": "vessel"}}],
            "ports": [{"name": "in", "at": {"junction": "in"}, "pressure_pa": 0.0}],
            "accumulators": [{"name": "vessel", "at": {"junction": "vessel"},
                "kind": {"elastic": {"compliance_m3_pa": compliance}}}]},
        "effects": {"tube_inertia": "on", "unsteady_friction": "off", "tube_losses": "off"},
        "time": {"end_s": 1.0}
    });
    let area = std::f64::consts::PI * radius * radius;
    let resistance = 8.0 * 1e-3 * length / (area * radius * radius);
    let inertance = 4.0 / 3.0 * 1000.0 * length / area;
    let frequencies = [0.5, 5.0, 20.0, 21.9, 40.0];
    let found = responses(
        &case,
        "/network/ports/0/pressure_pa",
        "accumulator_vessel_pressure",
        &frequencies,
    );
    for (hz, found) in frequencies.into_iter().zip(found) {
        let s = Complex::new(0.0, TAU * hz);
        let exact = (s * s * inertance * compliance + s * resistance * compliance + 1.0).inv();
        assert!(
            (found - exact).norm() < 1e-9 * exact.norm(),
            "{hz} Hz: {found} for {exact}"
        );
    }
}

/// Goal: with reciprocal coupling no frequency takes power from a structure at rest: the flow into a port has no part against its
/// pressure, nor the velocity of the tip against its force, beyond rounding errors; with and without inertia and memory of the fluid.
#[test]
fn a_passive_structure_takes_power_at_every_frequency() {
    let frequencies: Vec<f64> = (0..150).map(|k| 0.1 * 1e4_f64.powf(f64::from(k) / 149.0)).collect();
    for effects in [
        json!({"tube_inertia": "off"}),
        json!({"tube_inertia": "on", "unsteady_friction": "on", "bladder_inertia": "on"}),
    ] {
        let mut case = papers("chains", [4, 2]);
        case["effects"] = effects.clone();
        case["network"]["chains"][0]["ends"] = json!([{"pressure_pa": 0.0}, "sealed"]);
        let into = responses(
            &case,
            "/network/chains/0/ends/0/pressure_pa",
            "port_inlet_of_bladder_1_flow",
            &frequencies,
        );
        case["ends"]["tip"] = json!({"free": {"force_x_n": 0.0}});
        let moved = responses(&case, "/ends/tip/free/force_x_n", "tip_u1", &frequencies);
        for (hz, (flow, motion)) in frequencies.iter().zip(into.iter().zip(moved)) {
            let velocity = motion * Complex::new(0.0, TAU * hz);
            for (what, taken) in [("port", *flow), ("tip", velocity)] {
                assert!(taken.re > -1e-9 * taken.norm(), "{effects} {what} {hz} Hz: {taken}");
            }
        }
    }
}
