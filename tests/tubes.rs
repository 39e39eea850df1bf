//! Flow in tubes that does not creep: inertia and unsteady friction, [E51], losses, [E52].

#[path = "common/chance.rs"]
mod chance;
mod differences;

use std::path::Path;

use differences::worst_difference;
use nalgebra::Complex;
use slcbeam::case::{self, Case};
use slcbeam::dae::{BeamDae, Dae};
use slcbeam::discrete::System;
use slcbeam::model::network::TubeFlow;
use slcbeam::model::network::tube::friction_ratio;
use slcbeam::run::dynamics;
use slcbeam::run::record::Memory;
use slcbeam::run::summary::{Status, Summary};

const CASE: &str = include_str!("../cases/water-in-tubes.json");

fn read(sets: &[&str]) -> Case {
    let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
    case::parse(CASE, Path::new("mine.json"), Path::new(""), &sets).unwrap()
}

fn run(sets: &[&str]) -> Summary {
    dynamics::run(&read(sets), &mut Memory::default()).unwrap().summary
}

fn tube(sets: &[&str]) -> TubeFlow {
    let system = System::new(&read(sets)).unwrap();
    let links = &system.model.wet.as_ref().unwrap().network.links;
    links.iter().find_map(|link| link.tube).unwrap()
}

/// `1 - 2 J1(z)/(z J0(z))`, the ratio of Bessel functions by its continued fraction `z/(2 - z²/(4 - z²/(6 - ..)))`.
fn womersley(z: Complex<f64>) -> Complex<f64> {
    let square = z * z;
    let mut tail = Complex::new(1200.0, 0.0);
    for k in (1..600).rev() {
        tail = Complex::new(2.0 * f64::from(k), 0.0) - square / tail;
    }
    Complex::new(1.0, 0.0) - Complex::new(2.0, 0.0) / tail
}

/// Source: Womersley 1955, `Z = iω ρ l/A/(1 - 2 J1(z)/(z J0(z)))`, `z = i^(3/2) Wo`. Goal: within 0.2 % for Womersley numbers 0.1 to 100 with
/// unsteady friction; without it within 1.2 % up to 2, and far off above.
#[test]
fn the_impedance_of_a_tube_is_womersleys() {
    let off = r#"/effects={"tube_inertia": "on"}"#;
    let (with, without) = (tube(&[]), tube(&[off]));
    let plug = 0.75 * without.inertance;
    assert!((with.inertance / plug - 1.0).abs() < 1e-14);
    // R of Poiseuille's law, of which the branches are parts: r_1 = R_0/2
    let poiseuille = 2.0 * with.branches().next().unwrap().0;
    let error = |wo: f64, tube: &TubeFlow| {
        let omega = wo * wo * tube.viscous_rate;
        let i_omega = Complex::new(0.0, omega);
        let mut ours = i_omega * tube.inertance + poiseuille;
        if tube.remembers() {
            for (resistance, rate) in tube.branches() {
                ours += i_omega * resistance / (i_omega + rate);
            }
        }
        let z = Complex::new(-1.0, 1.0) * (wo / 2.0_f64.sqrt());
        let exact = i_omega * plug / womersley(z);
        ((ours - exact) / exact).norm()
    };
    for k in 0..=60 {
        let wo = 0.1 * 10.0_f64.powf(0.05 * f64::from(k));
        assert!(error(wo, &with) < 2e-3, "Wo {wo}: {}", error(wo, &with));
    }
    assert!(error(2.0, &without) < 1.2e-2);
    assert!(error(20.0, &without) > 0.2);
}

/// Source: Colebrook's equation, solved here by iteration, and 64/Re. Goal: laminar flow exactly; turbulent flow within 3 %, what Churchill's
/// formula is from Colebrook's, over Reynolds numbers 1 to 1e7 and roughness 0 to 1 %.
#[test]
fn friction_is_churchills() {
    for reynolds in [1.0, 10.0, 100.0, 1000.0] {
        assert!((friction_ratio(reynolds, 0.0).0 - 1.0).abs() < 2e-3, "Re {reynolds}");
    }
    for reynolds in [1e4, 1e5, 1e6, 1e7] {
        for roughness in [0.0, 1e-4, 1e-2] {
            let mut root = 8.0; // 1/√f
            for _ in 0..50 {
                root = -2.0 * f64::log10(roughness / 3.7 + 2.51 * root / reynolds);
            }
            let ours = friction_ratio(reynolds, roughness).0 * 64.0 / reynolds;
            assert!(
                (ours * root * root - 1.0).abs() < 0.035,
                "Re {reynolds}, e/D {roughness}: {}",
                ours * root * root
            );
        }
    }
}

/// Goal: each effect alone and all together close the balances of energy and volume to the integrator's error.
#[test]
fn balances_close_with_every_effect() {
    let valve = r#"/network/chains/0/opening={"ramp": {"from": 1, "to": 0, "start_s": 0.1, "duration_s": 0.05}}"#;
    for effects in [
        r#"{"tube_inertia": "on"}"#,
        r#"{"tube_losses": "on"}"#,
        r#"{"tube_inertia": "on", "unsteady_friction": "on"}"#,
        r#"{"tube_inertia": "on", "unsteady_friction": "on", "tube_losses": "on"}"#,
    ] {
        for more in [&[][..], &[valve]] {
            let effects = format!("/effects={effects}");
            let sets = [&[effects.as_str(), "/time/end_s=0.2", "/solver/rtol=1e-7"][..], more].concat();
            let summary = run(&sets);
            assert_eq!(summary.status, Status::Finished, "{sets:?}: {:?}", summary.reason);
            let (energy, volume) = (
                summary.balances.energy_residual_relative,
                summary.balances.volume_residual_relative,
            );
            assert!(
                energy.abs() < 1e-6 && volume.abs() < 1e-12,
                "{sets:?}: {energy:e} {volume:e}"
            );
        }
    }
}

/// Goal: the Jacobian is that of the residual; each flow and each branch is one unknown, and none is there without the effects.
#[test]
fn unknowns_and_their_jacobian() {
    let size = |effects: &str| BeamDae::new(System::new(&read(&[&format!("/effects={effects}")])).unwrap()).len();
    let creeping = size(r#""full""#);
    assert_eq!(size(r#"{"tube_losses": "on"}"#), creeping + 18);
    assert_eq!(size(r#"{"tube_inertia": "on"}"#), creeping + 18);
    assert_eq!(
        size(r#"{"tube_inertia": "on", "unsteady_friction": "on"}"#),
        creeping + 18 * 11
    );
    let mut dae = BeamDae::new(System::new(&read(&[])).unwrap());
    assert!(worst_difference(&mut dae, 7, 0.1) < 1e-6);
}
