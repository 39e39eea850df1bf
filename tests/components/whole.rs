//! What holds of all components together.

use slcbeam::case;
use slcbeam::case::schema::Effect;
use slcbeam::dae::{BeamDae, Dae as _};
use slcbeam::discrete::System;
use slcbeam::error::Error;
use slcbeam::model::effects::{DecisionCause, Keeps};

use super::differences::worst_difference;
use super::{read, run};

const PUMP: &str = include_str!("../../cases/bladder-pump.json");
const FINGER: &str = include_str!("../../cases/syringe-finger.json");
const TOUR: &str = include_str!("../../cases/network-tour.json");

/// Goal: the Jacobian is that of the residual, valves open and shut, flow creeping and not.
#[test]
fn the_jacobian_is_that_of_the_residual() {
    for text in [PUMP, FINGER] {
        for effects in [
            r#"/effects={"tube_inertia": "on", "unsteady_friction": "on", "tube_losses": "on"}"#,
            r#"/effects={"tube_inertia": "off", "tube_losses": "off"}"#,
            r#"/effects={"tube_inertia": "off", "tube_losses": "on"}"#,
        ] {
            for seed in 1..=4 {
                let mut dae = BeamDae::new(System::new(&read(text, &[effects])).unwrap());
                if seed % 2 == 0 {
                    dae.approach(37.0);
                }
                let off = worst_difference(&mut dae, seed, 0.1);
                assert!(off < 1e-6, "{effects} {seed}: {off:e}");
            }
        }
    }
}

/// Goal: an accumulator is one unknown in place of its junction's pressure; pumps and valves are none.
#[test]
fn unknowns_are_those_of_the_network_alone() {
    let size = |sets: &[&str]| BeamDae::new(System::new(&read(FINGER, sets)).unwrap()).len();
    let creeping = r#"/effects={"tube_inertia": "off", "tube_losses": "off"}"#;
    let all = size(&[creeping]);
    let tank = r#"/network/tubes/1={"from": {"junction": "tank"}, "to": {"bladder": -1, "end": "inlet"}}"#;
    assert_eq!(size(&[creeping, tank]), all);
    let bare = size(&[creeping, "/network/accumulators=[]", tank]);
    assert_eq!(bare, all);
}

/// Goal: balances close with every kind of flow, asked for more as the tolerance is tightened; what ports let in together is what the
/// networks have taken in, and their powers are the rate of their work.
#[test]
fn balances_close_and_ports_add_up() {
    for text in [PUMP, FINGER] {
        for effects in [
            r#"/effects={"tube_inertia": "on", "unsteady_friction": "on", "tube_losses": "on"}"#,
            r#"/effects={"tube_inertia": "off", "tube_losses": "off"}"#,
        ] {
            let (memory, summary) = run(text, &[effects, "/solver/rtol=1e-8", "/time/end_s=0.4"]);
            let (energy, volume) = (
                summary.balances.energy_residual_relative,
                summary.balances.volume_residual_relative,
            );
            println!("{effects}: {energy:e} {volume:e}");
            assert!(
                energy.abs() < 1e-6 && volume.abs() < 1e-6,
                "{effects}: {energy:e} {volume:e}"
            );
            let ports = if text == PUMP {
                vec!["reservoir"]
            } else {
                vec!["syringe", "tank"]
            };
            let let_in: f64 = ports
                .iter()
                .map(|port| *memory.column(&format!("port_{port}_volume")).unwrap().last().unwrap())
                .sum();
            let taken = *memory.column("injected_volume").unwrap().last().unwrap();
            assert!((let_in / taken - 1.0).abs() < 1e-5, "{effects}: {let_in:e} {taken:e}");
        }
    }
}

/// Goal: what cannot be is refused in the words of the check, with its place.
#[test]
fn what_cannot_be_is_refused() {
    let refused = |text: &str, set: &str, pointer: &str, words: &str| {
        let sets = [set.to_owned()];
        let case = case::parse(text, "mine.json".as_ref(), "".as_ref(), &sets);
        let Err(Error::Case(told)) = case.and_then(|case| System::new(&case)) else {
            panic!("{set} is taken");
        };
        let found = told.violations.iter();
        let mut found = found.filter(|v| v.pointer.starts_with(pointer) && v.what.contains(words));
        assert!(found.next().is_some(), "{set}: {:?}", told.violations);
    };
    let both = r#"/network/ports/0={"name": "both", "at": {"junction": "line"}, "volume_m3": 0, "flow_m3_s": 0}"#;
    refused(FINGER, both, "/network/ports/0", "more than one of");
    let jumps = r#"/network/ports/0/volume_m3={"ramp": {"from": 0, "to": 1e-7, "start_s": 1, "duration_s": 0}}"#;
    refused(FINGER, jumps, "/network/ports/0/volume_m3", "the volume jumps");
    refused(
        FINGER,
        "/network/ports/0/volume_m3=1e-7",
        "/network/ports/0/volume_m3",
        "begins at",
    );
    let twice =
        r#"/network/accumulators/-={"at": {"junction": "line"}, "kind": {"elastic": {"compliance_m3_pa": 1e-12}}}"#;
    refused(FINGER, twice, "/network/accumulators/1/at", "a second accumulator");
    let held = r#"/network/accumulators/0/at={"junction": "tank"}"#;
    refused(FINGER, held, "/network/accumulators/0/at", "a port gives the pressure");
    let litres = r#"/network/ports/0/volume_m3={"ramp": {"from": 0, "to": 1, "start_s": 0, "duration_s": 1, "shape": "smooth"}}"#;
    refused(FINGER, litres, "/network/ports/0/volume_m3", "before sound has crossed");
    let at = r#"{"name": "tank", "at": {"junction": "tank"}"#;
    let no_way_out = FINGER.replace(&format!("{at}, \"pressure_pa\": 0"), &format!("{at}, \"volume_m3\": 0"));
    let slowly = r#"/network/ports/0/volume_m3={"ramp": {"from": 0, "to": 0.01, "start_s": 0, "duration_s": 4, "shape": "smooth"}}"#;
    refused(
        &no_way_out,
        slowly,
        "/network/ports/0/volume_m3",
        "injected into bladders",
    );
    // a large accumulator has room for it
    let roomy = "/network/accumulators/0/kind/elastic/compliance_m3_pa=2e-8";
    let sets = [slowly.to_owned(), roomy.to_owned()];
    case::parse(&no_way_out, "mine.json".as_ref(), "".as_ref(), &sets).unwrap();
    let turned = "/network/tubes/0/check_valve/reverse_conductance_m3_s_pa=1e-8";
    refused(
        PUMP,
        turned,
        "/network/tubes/0/check_valve/reverse_conductance_m3_s_pa",
        "larger reverse than forward conductance",
    );
    let in_bridge = "/network/turbines/0/rectifier/check_valves/reverse_conductance_m3_s_pa";
    refused(
        TOUR,
        &format!("{in_bridge}=1e-7"),
        in_bridge,
        "larger reverse than forward conductance",
    );
    let vacuum = "/network/accumulators/0/start_pressure_pa=-2e5";
    refused(PUMP, vacuum, "/network/accumulators/0/start_pressure_pa", "vacuum");
    for text in [PUMP, FINGER] {
        let text = text.replace("\"time\":", "\"effects\": \"auto\", \"time\":");
        let lumped = "/effects={\"network_pressure_differences\": \"off\"}";
        refused(&text, lumped, "/effects", "needs pressure differences");
    }
}

/// Goal: flow that alone tells one row from the other is not left out, however little of it there is: a beam that buckles goes where it
/// says. (Found by random scenes: shaken along until it buckled, the beam stayed straight.)
#[test]
fn what_alone_bends_a_beam_is_kept() {
    let one_sided = r#"{
        "name": "one-sided", "preset": "matia-gat-beam", "bladders": {"coupling": "reciprocal"}, "fluid": {"viscosity_pa_s": 1e5},
        "network": {"junctions": ["vessel"], "tubes": [{"from": {"junction": "vessel"}, "to": {"bladder": 1, "end": "inlet"}}],
                    "accumulators": [{"at": {"junction": "vessel"}, "kind": {"elastic": {"compliance_m3_pa": 1e-9}}}]},
        "ends": {"root": {"clamped": {"u3_m": {"sine": {"amplitude": 1e-3, "frequency_hz": 5, "ramp_cycles": 1}}}}, "tip": "pinned"},
        "time": {"end_s": 1e-3}
    }"#;
    let system = System::new(&read(one_sided, &[])).unwrap();
    let decision = system.model.effects.decision(Effect::Flow);
    assert_eq!(decision.cause, DecisionCause::Kept(Keeps::RowsDiffer));
    // what loads the beam across bends it anyway: then it is weighed
    let loaded = r#"/loads=[{"force_x_n_m": {"signal": 1}}]"#;
    let system = System::new(&read(one_sided, &[loaded])).unwrap();
    assert!(!system.model.effects.has(Effect::Flow));
}
