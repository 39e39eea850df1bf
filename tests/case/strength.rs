//! Loads, pressures, flows and coefficients that no such beam bears are refused when the case is read; what one may ask for is
//! not. All were valid before: 60 m^3/s ended with a beam of 211 km, 6e10 Pa kept the solver busy for 19 s.

use std::path::Path;

use slcbeam::case;
use slcbeam::error::Error;

const SCENE: &str = r#"{
  "name": "scene", "preset": "matia-gat-beam",
  "bladders": {"coupling": {"published": {"slope_per_pressure_rad": 0.0038, "length_per_pressure_m": 0.01}}},
  "network": {
    "chains": [{"bladders": [1, 2, 3], "ends": [{"pressure_pa": 1e4}, "sealed"]},
               {"bladders": [-1, -2], "ends": [{"flow_m3_s": 1e-6}, "connected"]}],
    "ports": [{"at": {"bladder": -2, "end": "outlet"}, "flow_m3_s": -1e-6}],
    "turbines": [{"from": {"bladder": 5, "end": "inlet"}, "to": {"bladder": -5, "end": "inlet"}, "conductance": {"m3_s_pa": 1e-9},
      "rectifier": {"check_valves": {"cracking_pressure_pa": 10, "forward_conductance_m3_s_pa": 1e-8,
        "reverse_conductance_m3_s_pa": 1e-12, "smoothing_pa": 10}}}]
  },
  "loads": [{"force_x_n_m": {"signal": 1, "profile": {"polynomial": {"coefficients": [1, -1]}}}}, {"body_z_m_s2": {"signal": 9.81}},
            {"gravity": {"x_m_s2": -9.81}}, {"moment_z_n": {"signal": 0.1}}],
  "ends": {"root": "clamped", "tip": {"free": {"force_x_n": 0.1, "moment_n_m": 0.01, "follower_normal_n": -1}}},
  "start": {"pressures": [{"bladders": [1], "pressure_pa": 1e3}]},
  "time": {"end_s": 1}
}"#;

/// Codes, places and texts of the faults.
fn faults(sets: &[&str]) -> Vec<(String, String, String)> {
    let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
    match case::parse(SCENE, Path::new("x.json"), Path::new(""), &sets) {
        Ok(_) => vec![],
        Err(Error::Case(fault)) => fault
            .violations
            .iter()
            .map(|v| {
                let words = format!(
                    "{} {}",
                    v.allowed.clone().unwrap_or_default(),
                    v.hint.clone().unwrap_or_default()
                );
                (v.code.id().to_owned(), v.pointer.clone(), words)
            })
            .collect(),
        Err(other) => panic!("{other}"),
    }
}

#[test]
fn what_no_beam_bears_is_refused_with_range_and_hint() {
    assert_eq!(faults(&[]), []);
    for (pointer, value) in [
        ("/network/chains/0/ends/0/pressure_pa", "6e10"),
        (
            "/network/chains/0/ends/0/pressure_pa",
            r#"{"ramp": {"to": -1e8, "start_s": 0.5, "duration_s": 1e-6}}"#,
        ),
        (
            "/network/chains/0/ends/0/pressure_pa",
            r#"{"sine": {"amplitude": 3e7, "frequency_hz": 50}}"#,
        ),
        ("/network/chains/1/ends/0/flow_m3_s", "60"),
        ("/network/ports/0/flow_m3_s", "-60"),
        ("/network/turbines/0/rectifier/check_valves/cracking_pressure_pa", "1e9"),
        ("/loads/0/force_x_n_m/signal", "1e7"),
        ("/loads/1/body_z_m_s2/signal", "1e7"),
        ("/loads/2/gravity/x_m_s2", "-1e7"),
        ("/loads/3/moment_z_n/signal", "1e7"),
        ("/ends/tip/free/force_x_n", "1e6"),
        ("/ends/tip/free/follower_normal_n", "-1e6"),
        ("/ends/tip/free/moment_n_m", "1e3"),
        ("/start/pressures/0/pressure_pa", "1e10"),
        ("/bladders/area_per_pressure_m2_per_pa", "1.75e-4"),
        ("/bladders/area_per_moment_m2_per_n_m/closing", "6.54"),
        ("/bladders/area_per_force_m2_per_n/compression", "6.31e-2"),
        ("/bladders/coupling/published/slope_per_pressure_rad", "3.8e4"),
        ("/bladders/coupling/published/length_per_pressure_m", "1e4"),
        ("/bladders/permeability_m4", "1e-3"),
        ("/tubes/permeability_m4", "6.72e-1"),
    ] {
        let told = faults(&[&format!("{pointer}={value}")]);
        let place = pointer.trim_end_matches("/signal");
        let found = told.iter().find(|(code, at, _)| code == "E010" && at == place);
        let (_, _, words) = found.unwrap_or_else(|| panic!("{pointer}={value}: {told:?}"));
        assert!(words.starts_with("up to ") && words.len() > 20, "{pointer}: {words}");
    }
    let body = |inertia: &str| format!(r#"/attachments=[{{"at": 1, "rotary_inertia_kg_m2": {inertia}}}]"#);
    assert_eq!(faults(&[&body("1e-3")]), []);
    let told = faults(&[&body("1e3")]);
    let at = "/attachments/0/rotary_inertia_kg_m2";
    assert!(
        matches!(&told[..], [(code, place, _)] if code == "E010" && place == at),
        "{told:?}"
    );
}

/// A flow that goes in for long without a way out presses more in than there is room for; in circles it may go on for ever.
#[test]
fn what_flows_leave_in_bladders_is_bounded() {
    let closed = r#"/network={"chains": [{"bladders": [1, 2], "ends": [{"flow_m3_s": FLOW}, {"flow_m3_s": BACK}]}]}"#;
    let with = |flow: &str, back: &str, end: &str| {
        let network = closed.replace("FLOW", flow).replace("BACK", back);
        faults(&[&network, &format!("/time/end_s={end}")])
    };
    assert_eq!(with("1e-6", "0", "100"), []);
    let told = with("1e-4", "0", "100");
    assert!(
        told.iter()
            .any(|(code, at, _)| code == "E010" && at == "/network/chains/0/ends/0/flow_m3_s"),
        "{told:?}"
    );
    assert_eq!(with("1e-4", "-1e-4", "1e4"), [], "what goes in comes out");
    let sine = r#"{"sine": {"amplitude": 1e-4, "frequency_hz": 10}}"#;
    assert_eq!(with(sine, "0", "1e4"), [], "a mean of zero leaves nothing");
    let open = r#"/network/chains/0/ends/1={"pressure_pa": 0}"#;
    let network = closed.replace("FLOW", "1e-4").replace("BACK", "0");
    assert_eq!(faults(&[&network, open, "/time/end_s=1e4"]), []);
}

/// Generous: half of ten times the modulus, a beam wound up by its end's moment, a load that stretches it by half.
#[test]
fn what_can_be_asked_for_is_not_refused() {
    for set in [
        "/network/chains/0/ends/0/pressure_pa=1e7",
        "/ends/tip/free/moment_n_m=6.0",
        "/ends/tip/free/force_x_n=1e3",
        "/loads/0/force_x_n_m/signal=1e4",
        "/network/chains/1/ends/0/flow_m3_s=1e-3",
        "/bladders/area_per_pressure_m2_per_pa=1.75e-8",
        "/bladders/permeability_m4=1e-9",
    ] {
        assert_eq!(faults(&[set]), [], "{set}");
    }
}
