//! Warnings of every command about a case and its meshes. Source: the same cases on finer meshes. Goal: an error above 5 % in a figure of a
//! default mesh is always warned of, with the affected figure.

use std::path::Path;

use assert_cmd::Command;
use serde_json::{Value, json};
use tempfile::TempDir;

/// Two bladders of the paper's beam in a row with a thick fluid: pressure does not cross a cell in time.
fn thick(ends: [Value; 2]) -> Value {
    json!({
        "name": "thick", "preset": "matia-gat-beam", "fluid": {"viscosity_pa_s": 1.0},
        "beam": {"damping": {"bending_time_s": 0.002, "axial_time_s": 0.002}},
        "network": {"chains": [{"bladders": [1, 2], "ends": ends}]},
        "ends": {"root": "clamped", "tip": "free"}, "time": {"end_s": 0.5}
    })
}

fn through() -> Value {
    thick([json!({"pressure_pa": 5000}), json!({"pressure_pa": 0})])
}

fn to_and_fro() -> Value {
    let sine = json!({"sine": {"amplitude": 5000, "frequency_hz": 3}});
    thick([json!({"pressure_pa": sine}), json!("sealed")])
}

/// Output of a command, and its answer with `--json`.
struct Said {
    out: String,
    json: Value,
    folder: TempDir,
}

fn say(command: &str, case: &Value, more: &[&str]) -> Said {
    let (folder, beside) = (TempDir::new().unwrap(), TempDir::new().unwrap());
    let path = beside.path().join("case.json");
    std::fs::write(&path, case.to_string()).unwrap();
    let ask = |json: bool| {
        let mut asked = Command::cargo_bin("slcbeam").unwrap();
        asked.arg(command).arg(&path).args(more).args(["--quiet", "--out"]);
        asked.arg(folder.path().join("result"));
        if json {
            asked.arg("--json");
        }
        let output = asked.output().unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        let (out, err) = (text(output.stdout), text(output.stderr));
        assert_eq!(output.status.code(), Some(0), "{command} {more:?}: {out}{err}");
        out
    };
    let (out, json) = (ask(false), serde_json::from_str(&ask(true)).unwrap());
    Said { out, json, folder }
}

fn warned(said: &Said, code: &str) -> Option<String> {
    let all = said.json["warnings"].as_array().expect("warnings");
    let found = all.iter().filter_map(Value::as_str).find(|w| w.starts_with(code));
    assert_eq!(
        found.is_some(),
        said.out.contains(&format!("warning: {code}")),
        "{}",
        said.out
    );
    found.map(String::from)
}

fn written(folder: &Path, name: &str) -> Value {
    serde_json::from_str(&std::fs::read_to_string(folder.join("result").join(name)).unwrap()).unwrap()
}

/// Goal: coefficients of another section shape are warned of by every command, on the screen, as JSON and in the folder.
#[test]
fn every_command_tells_what_is_known_of_a_case() {
    let mut case = to_and_fro();
    case["beam"]["height_m"] = json!(0.025);
    let coarse = ["--set", "/mesh/cells_per_segment=1"];
    for (command, file) in [
        ("modes", "modes.json"),
        ("equilibrium", "equilibrium.json"),
        ("floquet", "floquet.json"),
        ("periodic", "cycle.json"),
    ] {
        let said = say(command, &case, &coarse);
        let told = warned(&said, "W017").unwrap_or_else(|| panic!("{command}: {}", said.out));
        let in_folder = written(said.folder.path(), file);
        assert!(
            in_folder["warnings"].as_array().unwrap().contains(&json!(told)),
            "{command}: {in_folder:#}"
        );
    }
    let swept = [&coarse[..], &["--sweep", "/fluid/viscosity_pa_s=0.5:1:2"]].concat();
    assert!(warned(&say("periodic", &case, &swept), "W017").is_some());
}

/// Goal: decay rates on two cells per bladder have errors of 5 to 60 %. The warning names the mode, and the estimate is no smaller than the
/// error; the extrapolated limit is closer.
#[test]
fn modes_tell_what_cells_along_bladders_do_to_rates() {
    let said = say("modes", &through(), &["--count", "2", "--kind", "decay"]);
    let fine = say(
        "modes",
        &through(),
        &["--count", "2", "--kind", "decay", "--set", "/mesh/cells_per_bladder=16"],
    );
    assert!(
        warned(&said, "W021").is_some_and(|w| w.contains("rate of mode 2 about")),
        "{}",
        said.out
    );
    for k in 0..2 {
        let number = |said: &Said, key: &str| said.json["modes"][k][key].as_f64().unwrap();
        let (here, exact) = (number(&said, "growth_per_s"), number(&fine, "growth_per_s"));
        let extrapolated = number(&said, "extrapolated_growth_per_s");
        let (error, told) = ((exact / here - 1.0).abs(), number(&said, "rate_mesh_error"));
        println!(
            "rate {here:.3} 1/s, extrapolated {extrapolated:.3}, on 16 cells {exact:.3}: off by {error:.3}, told {told:.3}"
        );
        assert!(told > 0.8 * error && told < 3.0 * error);
        assert!((extrapolated - exact).abs() < 0.35 * (here - exact).abs());
    }
    assert!(warned(&fine, "W021").is_none(), "{}", fine.out);
}

/// Goal: the largest pressure of a flow through bladders is at the center of the first cell, a sixth of a bladder below that of the port.
#[test]
fn equilibria_and_cycles_tell_what_meshes_do() {
    let said = say("equilibrium", &through(), &[]);
    let told = warned(&said, "W021").unwrap_or_else(|| panic!("{}", said.out));
    assert!(
        told.contains("max_pressure") && told.contains("/mesh/cells_per_bladder"),
        "{told}"
    );
    // relative to the largest pressure, that of the port
    let error = 1.0 - said.json["quantities"]["max_pressure_pa"].as_f64().unwrap() / 5000.0;
    let share = &said.json["meshes"]["quantities"]["max_pressure"];
    let by_bladders = share["bladders"].as_f64().unwrap();
    assert!(
        (by_bladders / error - 1.0).abs() < 0.05 && error > 0.05,
        "{error} {share}"
    );
    let fine = say("equilibrium", &through(), &["--set", "/mesh/cells_per_bladder=16"]);
    assert!(warned(&fine, "W021").is_none(), "{}", fine.out);

    let said = say("periodic", &to_and_fro(), &[]);
    let told = warned(&said, "W021").unwrap_or_else(|| panic!("{}", said.out));
    assert!(told.contains("/mesh/cells_per_bladder"), "{told}");
    let summary = written(said.folder.path(), "summary.json");
    assert!(summary["warnings"].as_array().unwrap().contains(&json!(told)));
    let fine = say("periodic", &to_and_fro(), &["--set", "/mesh/cells_per_bladder=32"]);
    let largest = |said: &Said| {
        written(said.folder.path(), "summary.json")["quantities"]["max_pressure_pa"]["window_max_abs"]
            .as_f64()
            .unwrap()
    };
    let (off, share) = (
        largest(&fine) / largest(&said) - 1.0,
        said.json["meshes"]["quantities"]["max_pressure_pa.window_max_abs"]["bladders"]
            .as_f64()
            .unwrap(),
    );
    println!("largest pressure off by {off:.3}, told {share:.3}");
    assert!(off > 0.1 && share > 0.8 * off, "{off} {share}");
}

/// Coarse meshes have fewer modes than requested.
#[test]
fn modes_are_refined_where_coarse_meshes_have_fewer() {
    let said = say("modes", &through(), &["--count", "4", "--accuracy", "0.1"]);
    let accuracy = &said.json["accuracy"];
    assert_eq!(accuracy["reached"], true, "{accuracy:#}");
    assert!(accuracy["cells_per_bladder"].as_u64().unwrap() >= 4, "{accuracy:#}");
}

/// Goal: for a thick fluid, the warning suggests more cells in the bladders, not along the beam.
#[test]
fn cells_are_refined_where_it_helps() {
    let said = say("periodic", &to_and_fro(), &["--accuracy", "0.1"]);
    let accuracy = &said.json["accuracy"];
    assert_eq!(accuracy["reached"], true, "{accuracy:#}");
    let cells = |key: &str| accuracy[key].as_u64().unwrap();
    assert!(
        cells("cells_per_segment") <= 8 && cells("cells_per_bladder") >= 8,
        "{accuracy:#}"
    );
}

/// The paper's beam with a chain between two ports.
fn joined(fluid: Value, ends: [Value; 2], effects: Value) -> Value {
    json!({
        "name": "joined", "preset": "matia-gat-beam", "fluid": fluid,
        "network": {"chains": [{"bladders": [1, 2, 3, 4], "ends": ends}]}, "effects": effects,
        "ends": {"root": "clamped", "tip": "free"}, "probes": [{"name": "far", "at": 0.95}], "time": {"end_s": 0.5}
    })
}

/// Goal: fluid at rest has no flow, and a beam bent by pressure no forces. What remains is rounding error and causes no warning of a coarse
/// mesh or a fast flow. Before, air at rest gave a Reynolds number of 6767 and mesh errors of 1e286.
#[test]
fn rest_is_told_nothing_of_flows() {
    let at = json!({"pressure_pa": 4e4});
    for fluid in [json!({"preset": "air"}), json!({"preset": "water"})] {
        for ends in [[at.clone(), json!("sealed")], [at.clone(), at.clone()]] {
            let case = joined(fluid.clone(), ends, json!("auto"));
            let said = say("equilibrium", &case, &[]);
            for code in ["W003", "W021"] {
                let found = warned(&said, code);
                assert!(found.is_none(), "{fluid}: {found:?}");
            }
            // small oscillations about rest have no definite amplitude
            let modes = say("modes", &case, &["--at", "0.5", "--count", "2"]);
            assert!(!modes.out.contains("Reynolds number expected"), "{}", modes.out);
        }
    }
}

/// Source: Kirchhoff's equations of equal resistances. Goal: an equilibrium with a steady flow reports the Reynolds number of that flow if
/// the model does not include its consequences.
#[test]
fn steady_flow_is_told_when_fast() {
    let ends = [json!({"pressure_pa": 1000}), json!({"pressure_pa": 0})];
    let creeping = json!({"tube_inertia": "off", "tube_losses": "off"});
    let water = json!({"density_kg_m3": 1000, "viscosity_pa_s": 8.68e-4});
    let said = say("equilibrium", &joined(water.clone(), ends.clone(), creeping), &[]);
    let told = warned(&said, "W003").expect("a warning");
    let resistance = 8.68e-4 * (4.0 * 0.046 / 1.55e-12 + 3.0 * 0.020 / 6.72e-13);
    let reynolds = 2.0 * 1000.0 / (std::f64::consts::PI * 8.68e-4 * 1e-3) * 1000.0 / resistance;
    assert!(
        told.contains(&format!("reached {reynolds:.0} at load factor 1.0")),
        "{reynolds}: {told}"
    );
    let said = say("equilibrium", &joined(water, ends, json!("full")), &[]);
    assert!(warned(&said, "W003").is_none());
}

/// Goal: `check` reports prescribed port flows: at least the largest of them in a network with tubes, and none if no tube carries it.
#[test]
fn prescribed_flows_have_a_reynolds_number() {
    let water = json!({"density_kg_m3": 1000, "viscosity_pa_s": 8.68e-4});
    let sine = json!({"flow_m3_s": {"sine": {"amplitude": 3e-4, "frequency_hz": 0.1}}});
    let creeping = json!({"tube_inertia": "off", "tube_losses": "off"});
    let case = joined(water, [sine.clone(), json!({"pressure_pa": 0})], creeping);
    // a tenth of a hertz over half a second: sin(0.1 π) of the amplitude
    let flow = 3e-4 * (0.1 * std::f64::consts::PI).sin();
    let wanted = 2.0 * 1000.0 * flow / (std::f64::consts::PI * 8.68e-4 * 1e-3);
    let estimate = |case: &Value| {
        let case = slcbeam::case::parse(&case.to_string(), Path::new("joined.json"), Path::new(""), &[]).unwrap();
        let model = slcbeam::model::Model::new(&case).unwrap();
        slcbeam::model::characteristic::numbers(&case, &model)["reynolds_estimate"]
    };
    let found = estimate(&case);
    assert!((found / wanted - 1.0).abs() < 1e-3, "{found:.1}, wanted {wanted:.1}");
    let mut apart = case.clone();
    apart["network"]["chains"] = json!([{"bladders": [1], "ends": [sine, {"pressure_pa": 0}]}, {"bladders": [2, 3]}]);
    let found = estimate(&apart);
    assert!(found < 0.1 * wanted, "{found:.1}");
}

/// Goal: named effects that contradict each other or lack data are rejected with their pointer and a remedy. If the program itself omits an
/// effect, it also omits those that need it.
#[test]
fn effects_that_contradict_are_refused() {
    let water = json!({"density_kg_m3": 1000, "viscosity_pa_s": 8.68e-4});
    let ends = [json!("sealed"), json!("sealed")];
    let of = |effects: Value| {
        let text = joined(water.clone(), ends.clone(), effects).to_string();
        let case = slcbeam::case::parse(&text, Path::new("joined.json"), Path::new(""), &[]).unwrap();
        slcbeam::discrete::System::new(&case).map(|_| ())
    };
    for (effects, pointer, hint) in [
        (
            json!({"unsteady_friction": "on", "tube_inertia": "off"}),
            "unsteady_friction",
            "tube_inertia",
        ),
        (
            json!({"unsteady_friction": "on", "flow": "off"}),
            "unsteady_friction",
            "set flow to \"on\"",
        ),
        (
            json!({"rotary_inertia": "on", "solid_inertia": "off"}),
            "rotary_inertia",
            "solid_inertia",
        ),
        (json!({"compressibility": "on"}), "compressibility", "bulk_modulus_pa"),
        (
            json!({"nonlinear_section": "on"}),
            "nonlinear_section",
            "/bladders/strain_energy",
        ),
    ] {
        match of(effects.clone()) {
            Err(slcbeam::error::Error::Case(fault)) => {
                let all = &fault.violations;
                assert_eq!(all.len(), 1, "{effects}: {all:?}");
                assert_eq!(all[0].pointer, format!("/effects/{pointer}"));
                assert!(all[0].hint.as_ref().unwrap().contains(hint), "{effects}: {all:?}");
            }
            other => panic!("{effects}: {other:?}"),
        }
    }
    for effects in [
        json!({"unsteady_friction": "on", "tube_inertia": "on"}),
        json!({"unsteady_friction": "off", "tube_inertia": "off", "compressibility": "off"}),
        json!({"solid_inertia": "off", "rotary_inertia": "off"}),
    ] {
        assert!(of(effects.clone()).is_ok(), "{effects}");
    }
}

/// Goal: a pump that starts within a millisecond as a spline is warned of for overshoot beyond its points; a linear table stays within
/// them.
#[test]
fn a_spline_beyond_its_points_is_told() {
    let told = |interpolation: &[(&str, &str)]| {
        let mut table = json!({"times_s": [0, 0.01, 0.011, 0.02], "values": [0, 0, 1e-9, 1e-9]});
        for (key, kind) in interpolation {
            table[key] = json!(kind);
        }
        let mut case = thick([json!({"flow_m3_s": {"table": table}}), json!({"pressure_pa": 0})]);
        case["time"]["end_s"] = json!(0.03);
        let warnings = say("run", &case, &[]).json["warnings"].clone();
        let all = warnings.as_array().expect("warnings").iter().filter_map(Value::as_str);
        all.filter(|w| w.starts_with("W028"))
            .map(String::from)
            .collect::<Vec<_>>()
    };
    assert!(told(&[("interpolation", "cubic")])[0].starts_with("W028 /network/chains/0/ends/0/flow_m3_s: "));
    assert!(told(&[]).is_empty());
}

/// Goal: implausible numbers are warned of with their pointers before any computation; usual ones are not.
#[test]
fn what_is_seldom_meant_is_told() {
    let told = |sets: &[(&str, Value)]| {
        let mut case = through();
        for (pointer, value) in sets {
            let (parent, key) = pointer.rsplit_once('/').unwrap();
            case.pointer_mut(parent).expect("a place")[key] = value.clone();
        }
        let folder = TempDir::new().unwrap();
        let path = folder.path().join("case.json");
        std::fs::write(&path, case.to_string()).unwrap();
        let output = Command::cargo_bin("slcbeam")
            .unwrap()
            .args(["check", path.to_str().unwrap(), "--json"])
            .output()
            .unwrap();
        let json: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        let all = json["warnings"]
            .as_array()
            .expect("warnings")
            .iter()
            .filter_map(Value::as_str);
        all.filter(|w| w.starts_with("W031"))
            .map(String::from)
            .collect::<Vec<_>>()
    };
    let end = "/network/chains/0/ends";
    let pump = |signal: Value| vec![(end, json!([{"pressure_pa": signal}, {"pressure_pa": 0}]))];
    assert!(told(&[]).is_empty());
    assert!(told(&pump(json!({"ramp": {"to": 5000, "start_s": 0.4, "duration_s": 1}}))).is_empty());
    for (sets, said) in [
        (
            pump(json!({"ramp": {"to": 5000, "start_s": 0.5, "duration_s": 1}})),
            "/network/chains/0/ends/0/pressure_pa/ramp: it begins at 0.5 s, but the run ends at 0.5 s",
        ),
        (
            pump(json!({"sum": [1, {"table": {"times_s": [0, 500, 1000], "values": [0, 0, 5000]}}]})),
            "/network/chains/0/ends/0/pressure_pa/sum/1/table: it begins at 500 s",
        ),
        (
            vec![("/beam/density_kg_m3", json!(1.07))],
            "/beam/density_kg_m3: a solid of 1.07 kg/m^3",
        ),
        (
            vec![("/fluid/viscosity_pa_s", json!(300))],
            "/fluid/viscosity_pa_s: a viscosity of 300 Pa s",
        ),
        (
            vec![(
                "/ends/root",
                json!({"clamped": {"u1_m": {"sine": {"amplitude": 3, "frequency_hz": 3}}}}),
            )],
            "/ends/root/clamped/u1_m: the end moves to",
        ),
    ] {
        let found = told(&sets);
        assert!(found.len() == 1 && found[0].contains(said), "{said}: {found:?}");
    }
}
