//! Momentum of the fluid along bladders, [E74], and friction with a memory in ducts that are not round, [E72] [E73].

use std::f64::consts::PI;
use std::path::Path;

use crate::differences::worst_difference;
use crate::secant::root;
use nalgebra::Complex;
use slcbeam::case::schema::{CrossSection, Effect};
use slcbeam::case::{self, Case};
use slcbeam::dae::{BeamDae, Dae};
use slcbeam::discrete::System;
use slcbeam::model::effects::DecisionCause;
use slcbeam::model::network::{FlowLaw, ResolvedNetwork};
use slcbeam::model::{Model, duct};
use slcbeam::run::dynamics;
use slcbeam::run::modes::{self, ModeOptions};
use slcbeam::run::record::Memory;
use slcbeam::run::summary::Status;

type C = Complex<f64>;

/// One row of bladders of water whose areas do not feel the beam; the network and what else is set complete it.
fn read(network: &str, sets: &[&str]) -> Case {
    let text = format!(
        r#"{{"name": "sloshing", "preset": "matia-gat-beam", "bladders": {{"coupling": "reciprocal"}}, "network": {network},
            "ends": {{"root": "clamped", "tip": "free"}},
            "effects": {{"tube_inertia": "on", "bladder_inertia": "on", "unsteady_friction": "on", "flow_along_bladders": "on", "tube_losses": "off",
                         "moment_to_area": "off", "force_to_area": "off"}},
            "time": {{"end_s": 0.1}}}}"#
    );
    let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
    case::parse(&text, Path::new("mine.json"), Path::new(""), &sets).unwrap()
}

/// Bladder 1 with pressure 0 at its inlet.
const OPEN: &str = r#"{"ports": [{"name": "open", "at": {"bladder": 1, "end": "inlet"}, "pressure_pa": 0}]}"#;

/// The impedance of a length of 1 m of a rectangular duct, sides a and b: modes of the flow across one side in closed form along the other.
fn rectangle(s: C, a: f64, b: f64, viscosity: f64, density: f64) -> C {
    let terms = (0..2000).map(|i| {
        let m = f64::from(2 * i + 1);
        let g = (s * (density / viscosity) + (m * PI / b).powi(2)).sqrt();
        let z = g * (0.5 * a);
        // tanh without overflow
        let e = (z * -2.0).exp();
        let tanh = (C::new(1.0, 0.0) - e) / (C::new(1.0, 0.0) + e);
        (C::new(1.0, 0.0) - tanh / z) / (g * g) * (8.0 * a * b / (PI * PI * m * m * viscosity))
    });
    terms.sum::<C>().inv()
}

/// What flow along 1 m of the bladders of a case has beyond the resistance of creeping flow.
fn along(case: &Case) -> FlowLaw {
    let network = ResolvedNetwork::from_case(case).unwrap().unwrap();
    network.along_bladders.unwrap().over(1.0)
}

fn ladder(law: &FlowLaw, s: C) -> C {
    let branches = law.branches().map(|(resistance, rate)| s * resistance / (s + rate));
    s * law.inertance + branches.sum::<C>()
}

/// Source: the duct's Poisson equation at a complex frequency, solved by series. Goal: the impedance of the ladder within 0.7 % from `r √(ω/ν)` = 0.1 to 100,
/// for rectangles from a square to a slit, and steady momentum to 1e-4 as the series says, the ladder's to 2e-3.
#[test]
fn the_impedance_of_a_rectangular_duct_is_exact_at_both_ends() {
    let mut case = read(OPEN, &[]);
    let (density, viscosity) = case
        .fluid
        .as_ref()
        .map(|f| (f.density_kg_m3, f.viscosity_pa_s))
        .unwrap();
    for ratio in [1.0, 1.5, 2.0, 3.0, 5.0, 10.0, 100.0] {
        let (a, b) = (ratio * 2e-3, 2e-3);
        let bladders = case.bladders.as_mut().unwrap();
        (
            bladders.height_m,
            bladders.width_m,
            bladders.cross_section,
            bladders.permeability_m4,
        ) = (b, a, None, None);
        let (law, resistance) = (along(&case), viscosity / duct::rectangle(a, b));
        let radius = a * b / (a + b);
        let mut worst = 0.0_f64;
        for k in 0..=60 {
            let wo = 0.1 * 10.0_f64.powf(0.05 * f64::from(k));
            let s = C::new(0.0, wo * wo * viscosity / (density * radius * radius));
            let exact = rectangle(s, a, b, viscosity, density);
            worst = worst.max(((ladder(&law, s) + resistance) / exact - 1.0).norm());
        }
        let slow = C::new(0.0, 1e-3 * viscosity / (density * radius * radius));
        let steady = rectangle(slow, a, b, viscosity, density).im / slow.im * a * b / density;
        let section = CrossSection::Rectangle {
            height_m: b,
            width_m: a,
        };
        println!("{ratio} {worst:e} {steady}");
        assert!(worst < 7e-3, "{ratio}: {worst}");
        assert!(
            (duct::momentum_factor(&section) / steady - 1.0).abs() < 1e-4,
            "{ratio}: {steady}"
        );
        assert!(
            (ladder(&law, slow).im / slow.im * a * b / (density * steady) - 1.0).abs() < 2e-3,
            "{ratio}"
        );
    }
    // profiles in closed form
    let close =
        |section: CrossSection, factor: f64| assert!((duct::momentum_factor(&section) / factor - 1.0).abs() < 1e-5);
    close(
        CrossSection::Rectangle {
            height_m: 1.0,
            width_m: 1e6,
        },
        1.2,
    );
    close(CrossSection::Circle { radius_m: 1.0 }, 4.0 / 3.0);
}

/// Source: a line of impedance Z and compliance C a length, `cosh(γ l) = 0` with one end open and `sinh(γ l) = 0` with both, `γ² = s Z C`. Goal: frequency and
/// decay of fluid that swings along a bladder converge in second order to those of the ladder, whose impedance is within 0.7 % of a square duct's.
#[test]
fn fluid_swings_along_a_bladder() {
    let both = r#"{"ports": [{"name": "open", "at": {"bladder": 1, "end": "inlet"}, "pressure_pa": 0},
                             {"name": "too", "at": {"bladder": 1, "end": "outlet"}, "pressure_pa": 0}]}"#;
    for (network, gamma_l) in [(OPEN, 0.5 * PI), (both, PI)] {
        let errors = [8, 16, 32].map(|cells| {
            let case = read(network, &[&format!("/mesh/cells_per_bladder={cells}")]);
            let model = Model::of_modes(&case).unwrap();
            let wet = model.wet.as_ref().unwrap();
            let (law, resistance) = (along(&case), 1.0 / wet.network.bladder_mobility);
            let length = wet.bladder_length;
            let wave = (gamma_l / length).powi(2) / wet.area[0].per_pressure;
            let plan = ModeOptions {
                count: 1,
                near_hz: (wave / law.inertance).sqrt() / (2.0 * PI),
                limits: false,
            };
            let found = modes::modes(&case, &plan).unwrap().modes[0].s;
            let by_ladder = root(|s| s * (ladder(&law, s) + resistance) + wave, found);
            println!("{cells} {found} {by_ladder}");
            (found - by_ladder).norm() / found.norm()
        });
        println!("{errors:?}");
        assert!(errors[2] < 6e-4, "{errors:?}");
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            assert!((1.8..2.2).contains(&order), "{errors:?}");
        }
    }
}

/// A row of bladders behind each other with a tee, a valve and a turbine, the root shaken.
const ROWS: &str = r#"{"junctions": ["tee"],
    "chains": [{"bladders": [1, 2, 3, 4]}, {"bladders": [-1, -2, -3, -4]}],
    "tubes": [{"from": {"bladder": 5, "end": "outlet"}, "to": {"junction": "tee"}, "length_m": 0.02, "cross_section": {"circle": {"radius_m": 1e-3}}},
              {"from": {"junction": "tee"}, "to": {"bladder": 6, "end": "inlet"}, "length_m": 0.02, "cross_section": {"circle": {"radius_m": 1e-3}}},
              {"from": {"junction": "tee"}, "to": {"bladder": -6, "end": "inlet"}, "length_m": 0.02, "cross_section": {"circle": {"radius_m": 1e-3}},
               "check_valve": {"cracking_pressure_pa": 0, "forward_conductance_m3_s_pa": 1e-7, "reverse_conductance_m3_s_pa": 1e-13, "smoothing_pa": 10}}],
    "ports": [{"name": "in", "at": {"bladder": 6, "end": "outlet"}, "pressure_pa": {"sine": {"amplitude": 500, "frequency_hz": 8}}},
              {"name": "fed", "at": {"bladder": 5, "end": "inlet"}, "flow_m3_s": {"sine": {"amplitude": 1e-8, "frequency_hz": 5}}}]}"#;

/// Goal: with momentum along bladders balances of energy and volume close to the integrator's error, and the Jacobian is the residual's, for water and air,
/// steady friction and friction with a memory, one cell a bladder and four.
#[test]
fn balances_close_and_the_jacobian_is_that_of_the_residual() {
    let air = r#"/fluid={"preset": "air"}"#;
    for fluid in [None, Some(air)] {
        for memory in ["on", "off"] {
            for cells in [1, 4] {
                let effects = format!(
                    r#"/effects={{"tube_inertia": "on", "bladder_inertia": "on", "unsteady_friction": "{memory}", "tube_losses": "on", "flow_along_bladders": "on"}}"#
                );
                let cells = format!("/mesh/cells_per_bladder={cells}");
                let mut sets = vec![effects.as_str(), cells.as_str(), "/solver/rtol=1e-7"];
                sets.extend(fluid);
                let case = read(ROWS, &sets);
                let mut dae = BeamDae::new(System::new(&case).unwrap());
                let off = worst_difference(&mut dae, 7, 0.1);
                let summary = dynamics::run(&case, &mut Memory::default()).unwrap().summary;
                assert_eq!(summary.status, Status::Finished, "{sets:?}: {:?}", summary.reason);
                let balances = (
                    summary.balances.energy_residual_relative,
                    summary.balances.volume_residual_relative,
                );
                println!("{sets:?} {off:e} {balances:?}");
                assert!(off < 1e-6, "{sets:?}: {off}");
                assert!(
                    balances.0.abs() < 1e-6 && balances.1.abs() < 1e-9,
                    "{sets:?}: {balances:?}"
                );
            }
        }
    }
}

/// Goal: each face is one unknown, ten more with a memory; none is there without the effect, nor in the published form where it is not named, nor of a fluid
/// without mass; and by itself it is there where fluid swings along bladders about as fast as the scene moves, not where it swings much faster.
#[test]
fn it_is_there_where_it_is_called_for() {
    let size = |memory: &str, inertia: &str| {
        let effects = format!(
            r#"/effects={{"tube_inertia": "on", "bladder_inertia": "{inertia}", "unsteady_friction": "{memory}", "flow_along_bladders": "on"}}"#
        );
        let system = System::new(&read(OPEN, &[&effects, "/mesh/cells_per_bladder=4"])).unwrap();
        BeamDae::new(system).len()
    };
    let without = size("off", "off");
    // the opening and three faces
    assert_eq!(size("off", "on"), without + 4);
    assert_eq!(size("on", "on"), without + 44);
    let numbers = |viscosity: f64, frequency: f64| {
        let shaken = format!(
            r#"/ends/root={{"clamped": {{"u1_m": {{"sine": {{"amplitude": 1e-3, "frequency_hz": {frequency}, "ramp_cycles": 2}}}}}}}}"#
        );
        let fluid = format!("/fluid/viscosity_pa_s={viscosity}");
        let case = case::parse(SHAKEN, Path::new("mine.json"), Path::new(""), &[shaken, fluid]).unwrap();
        let set = System::new(&case).unwrap().model.effects;
        let DecisionCause::Weighed(weighed) = set.decision(Effect::BladderInertia).cause else {
            panic!("{:?}", set.decision(Effect::BladderInertia));
        };
        (weighed.on(), weighed.value)
    };
    // twice as fast, four times as much
    let [slow, fast] = [0.02, 0.04].map(|frequency| numbers(100.0, frequency));
    assert!(!slow.0 && (fast.1 / slow.1 - 4.0).abs() < 1e-6, "{slow:?} {fast:?}");
    assert!(numbers(1e-3, 10.0).0);
    // cells along a bladder are there where fluid swings along it, however little friction holds it back
    let case = case::parse(
        SHAKEN,
        Path::new("mine.json"),
        Path::new(""),
        &[
            "/fluid/viscosity_pa_s=1e-6".to_owned(),
            r#"/ends/root={"clamped": {"u1_m": {"sine": {"amplitude": 1e-3, "frequency_hz": 10}}}}"#.to_owned(),
        ],
    )
    .unwrap();
    let set = System::new(&case).unwrap().model.effects;
    assert!(set.has(Effect::BladderInertia) && set.has(Effect::FlowAlongBladders));
    // by name it brings inertia in tubes along, in the published form, too
    for formulation in ["published", "conservative"] {
        let sets = [
            format!("/formulation={formulation:?}"),
            r#"/effects={"bladder_inertia": "on"}"#.to_owned(),
            "/fluid/viscosity_pa_s=100".to_owned(),
        ];
        let case = case::parse(SHAKEN, Path::new("mine.json"), Path::new(""), &sets).unwrap();
        let set = System::new(&case).unwrap().model.effects;
        assert!(
            set.has(Effect::BladderInertia) && set.has(Effect::TubeInertia),
            "{formulation}"
        );
    }
    let published = "/formulation=\"published\"".to_owned();
    let case = case::parse(
        SHAKEN,
        Path::new("mine.json"),
        Path::new(""),
        &[published, "/effects=\"full\"".to_owned()],
    )
    .unwrap();
    assert!(!System::new(&case).unwrap().model.effects.has(Effect::BladderInertia));
}

/// Bladders in a row; without inertia of the solid nothing swings by itself.
const SHAKEN: &str = r#"{"name": "shaken", "preset": "matia-gat-beam", "bladders": {"coupling": "reciprocal"},
    "network": {"chains": [{"bladders": [1, 2, 3, 4]}]}, "ends": {"root": {"clamped": {"u1_m": 0}}, "tip": "free"},
    "effects": {"solid_inertia": "off", "tube_inertia": "on"}, "time": {"end_s": 100}}"#;

/// Goal: what momentum along bladders does vanishes in proportion to the density of the fluid.
#[test]
fn it_vanishes_with_the_density_of_the_fluid() {
    let errors = [1000.0, 100.0, 10.0].map(|density| {
        let pressures = ["on", "off"].map(|inertia| {
            let network = r#"/network={"chains": [{"bladders": [1, 2, 3], "ends": [{"pressure_pa": {"sine": {"amplitude": 1000, "frequency_hz": 2, "ramp_cycles": 1}}}, "sealed"]}]}"#;
            let effects = format!(
                r#"/effects={{"solid_inertia": "off", "tube_inertia": "on", "bladder_inertia": "{inertia}", "unsteady_friction": "off", "tube_losses": "off"}}"#
            );
            let density = format!("/fluid/density_kg_m3={density}");
            let sets = [network, &effects, &density, "/time/end_s=1", "/time/output_interval_s=0.01", "/solver/rtol=1e-9"];
            let sets = sets.map(str::to_owned);
            let case = case::parse(SHAKEN, Path::new("mine.json"), Path::new(""), &sets).unwrap();
            let mut memory = Memory::default();
            assert_eq!(dynamics::run(&case, &mut memory).unwrap().summary.status, Status::Finished);
            memory.column("tip_u1").unwrap()
        });
        let [on, off] = &pressures;
        let largest = on.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let off = on.iter().zip(off).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        off / largest
    });
    println!("{errors:?}");
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log10();
        assert!((order - 1.0).abs() < 0.1, "{errors:?}");
    }
}
