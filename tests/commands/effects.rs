//! Ablation: what each effect does to a case. No clock decides: without repeats, work alone does.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use assert_cmd::Command;
use serde_json::{Value, json};
use slcbeam::case::schema::Effect;
use slcbeam::case::{self, Case};
use slcbeam::output::ResultFolder;
use slcbeam::output::effects::{self as files, ShownQuantity};
use slcbeam::output::kind::FolderKind;
use slcbeam::study::effects::choices::{effects, without};
use slcbeam::study::effects::figure_change::{ModelMeasure, Size, judge, largest};
use slcbeam::study::effects::{Ablation, AblationRow, EffectVerdict, TrialPlan, ablate};
use slcbeam::study::evaluations::Evaluations;
use tempfile::TempDir;

/// A slender cantilever under a load that bends it by a hundredth of its length and less: rotations small, sections thin.
const SLENDER: &str = r#"{
  "name": "slender",
  "beam": {"length_m": 0.1, "height_m": 0.002, "width_m": 0.05, "young_modulus_pa": 2e7, "density_kg_m3": 950},
  "loads": [{"force_x_n_m": {"signal": {"sine": {"amplitude": 0.05, "frequency_hz": 2, "ramp_cycles": 1}}}}],
  "ends": {"root": "clamped", "tip": "free"},
  "mesh": {"segments": 3, "cells_per_segment": 2},
  "solver": {"rtol": 1e-6},
  "time": {"end_s": 0.5, "output_interval_s": 0.005}
}
"#;

/// Two bladders of unequal slopes in a beam bent to and fro by an even load.
const KINKED: &str = r#"{
  "name": "kinked",
  "beam": {"length_m": 0.1, "height_m": 0.0216, "width_m": 0.05, "young_modulus_pa": 2e6, "density_kg_m3": 950},
  "fluid": {"density_kg_m3": 1000, "viscosity_pa_s": 8.68e-4},
  "bladders": {
    "per_row": 1, "length_m": 0.046, "height_m": 0.0078, "width_m": 0.0078, "permeability_m4": 1.55e-12,
    "area_per_pressure_m2_per_pa": 1.75e-10,
    "area_per_moment_m2_per_n_m": {"opening": 3.75e-6, "closing": 6.54e-6},
    "area_per_force_m2_per_n": {"tension": 3.64e-8, "compression": 6.31e-8},
    "coupling": {"published": {"slope_per_pressure_rad": 0.00381467, "length_per_pressure_m": 0.01}}
  },
  "tubes": {"length_m": 0.02, "radius_m": 0.001, "permeability_m4": 6.72e-13},
  "network": {"tubes": [{"from": {"bladder": 1, "end": "outlet"}, "to": {"bladder": -1, "end": "inlet"}}]},
  "loads": [{"force_x_n_m": {"signal": {"sine": {"amplitude": 20, "frequency_hz": 5, "ramp_cycles": 1}}}}],
  "ends": {"root": "clamped", "tip": "free"},
  "time": {"end_s": 0.2, "output_interval_s": 0.002}
}
"#;

fn parsed(text: &str) -> Case {
    case::parse(text, Path::new("case.json"), Path::new("."), &[]).unwrap()
}

fn ablated(text: &str, budget_s: f64) -> Ablation {
    let plan = TrialPlan { repeats: 0, budget_s };
    ablate(&parsed(text), plan, None, &Evaluations::default(), &|_| {}).unwrap()
}

/// Goal: the full model has what the case can have: inertia of tubes with compressed fluid, too, but none where a port feeds tubes of incompressible
/// fluid alone. It runs, and without compression nothing else comes in.
#[test]
fn the_full_model_has_what_is_possible() {
    let gas = KINKED.replace(r#""fluid": {"#, r#""fluid": {"kind": "gas", "#);
    let fed = KINKED.replace(
        r#""network": {"tubes": [{"from": {"bladder": 1, "end": "outlet"}, "to": {"bladder": -1, "end": "inlet"}}]}"#,
        r#""network": {"junctions": ["tee"], "ports": [{"name": "pump", "at": {"junction": "tee"}, "flow_m3_s": 1e-8}],
            "tubes": [{"from": {"bladder": 1, "end": "outlet"}, "to": {"junction": "tee"}},
                      {"from": {"bladder": -1, "end": "inlet"}, "to": {"junction": "tee"}}]}"#,
    );
    for (text, inertia) in [(gas, "on"), (fed, "off")] {
        let found = ablated(&text, 60.0);
        let whole = found
            .full
            .summary
            .as_ref()
            .unwrap_or_else(|| panic!("{:?}", found.full));
        assert_eq!(whole.effects["tube_inertia"].value, inertia);
        // what a port feeds is lost in tubes as it is anywhere
        assert_eq!(whole.effects["tube_losses"].value, "on");
        assert!(row(&found, Effect::MomentToArea).left_out.is_some());
    }
    let without = without(
        &parsed(&KINKED.replace(r#""fluid": {"#, r#""fluid": {"kind": "gas", "#)),
        &[Effect::Compressibility],
    );
    let set = effects(&without.unwrap()).unwrap();
    assert!(!set.has(Effect::Compressibility) && set.has(Effect::TubeInertia) && set.refusals.is_empty());
}

fn row(found: &Ablation, name: Effect) -> &AblationRow {
    found.rows.iter().find(|r| r.name == name).unwrap()
}

#[test]
fn a_slender_beam_does_without_rotary_inertia_and_finite_rotations() {
    let found = ablated(SLENDER, 600.0);
    println!(
        "{}\n{}",
        files::table(&found, &ShownQuantity::Largest),
        files::sentence(&found)
    );
    let names: Vec<Effect> = found.rows.iter().map(|r| r.name).collect();
    assert_eq!(names, Effect::ALL, "every effect once, in the order of the table");
    for name in [Effect::RotaryInertia, Effect::FiniteRotation] {
        let verdict = row(&found, name).verdict;
        assert!(
            matches!(verdict, EffectVerdict::Harmless | EffectVerdict::Saves),
            "{name}: {verdict:?}"
        );
    }
    // Only without finite rotations can the beam be inextensible; both models that are compared are without them.
    let stretch = row(&found, Effect::AxialStretch);
    assert_eq!(stretch.without, [Effect::FiniteRotation]);
    assert_eq!(stretch.takes, [Effect::AxialInertia]);
    assert_eq!(stretch.verdict, EffectVerdict::Saves);
    let compared = stretch.left_out.as_ref().unwrap();
    assert_eq!(compared.against, "without finite_rotation");
    assert_eq!(compared.unknowns, -(found.full.unknowns as i64) / 2, "u3 and v3");
    let across = row(&found, Effect::TransverseMotion);
    assert_eq!(across.verdict, EffectVerdict::Kept);
    assert!(
        across.reason.as_ref().unwrap().contains("/loads/0"),
        "{:?}",
        across.reason
    );
    assert_eq!(row(&found, Effect::Fluid).verdict, EffectVerdict::Absent);

    // What is recommended is what was run: fewer unknowns, changes below the tolerance.
    let recommended = found.recommendation.as_ref().unwrap();
    assert!(recommended.off.contains(&Effect::AxialStretch) && recommended.off.contains(&Effect::FiniteRotation));
    let run = recommended.run.as_ref().unwrap();
    assert!(run.unknowns < 0 && run.work < 0.95, "{} {}", run.unknowns, run.work);
    assert!(run.largest.as_ref().unwrap().1 < found.tolerance);
    let mut said: Value = serde_json::from_str(SLENDER).unwrap();
    said["effects"] = recommended.effects.clone();
    let chosen = effects(&parsed(&said.to_string())).unwrap();
    assert!(chosen.refusals.is_empty());
    for &name in Effect::CHOSEN {
        if recommended.off.contains(&name) {
            assert!(!chosen.has(name), "{name} is recommended off");
        } else if row(&found, name).verdict == EffectVerdict::Needed || row(&found, name).auto {
            let taken = recommended
                .off
                .iter()
                .any(|off| row(&found, *off).takes.contains(&name));
            let there = row(&found, name).verdict != EffectVerdict::Absent;
            assert!(chosen.has(name) == (there && !taken), "{name} stays on");
        }
    }
}

#[test]
fn unequal_slopes_are_needed_and_nothing_that_is_needed_is_recommended_off() {
    let found = ablated(KINKED, 600.0);
    let shown = ShownQuantity::choose(&found, None);
    let table = files::table(&found, &shown);
    println!("{table}\n{}", files::sentence(&found));
    let asymmetry = row(&found, Effect::Asymmetry);
    assert_eq!(asymmetry.verdict, EffectVerdict::Needed);
    assert!(
        asymmetry.auto && asymmetry.number.contains("0.27, not below 0.001"),
        "{}",
        asymmetry.number
    );
    let fluid = row(&found, Effect::Fluid);
    assert!(fluid.takes.contains(&Effect::Flow) && fluid.takes.contains(&Effect::Asymmetry));
    let recommended = found.recommendation.as_ref().unwrap();
    for off in &recommended.off {
        assert_ne!(row(&found, *off).verdict, EffectVerdict::Needed, "{off}");
    }
    // What makes no difference is left to the program, but where it costs a third of the work: momentum and memory at every face along a bladder.
    assert_eq!(
        row(&found, Effect::PressureToCurvature).verdict,
        EffectVerdict::Harmless
    );
    assert_eq!(recommended.off, [Effect::FlowAlongBladders]);
    // Files: rows of equal length, everything in the picture, text that is JSON.
    let csv = files::csv(&found);
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let records: Vec<_> = reader.records().map(|r| r.unwrap()).collect();
    assert!(records.iter().filter(|r| &r[0] == "asymmetry").count() == found.measures.len());
    let json: Value = serde_json::from_str(&files::json(&found)).unwrap();
    assert_eq!(json["rows"].as_array().unwrap().len(), Effect::ALL.len());
    assert!(json["sentence"].as_str().unwrap().contains("\"effects\": "));
    let dir = TempDir::new().unwrap();
    let mut folder = ResultFolder::claim(dir.path(), FolderKind::Effects, false).unwrap();
    files::write(&mut folder, &found, &shown).unwrap();
    let written = [files::CSV, files::JSON, files::PICTURE].map(|name| dir.path().join(name).is_file());
    assert_eq!(written, [true; 3]);
    let picture = fs::read_to_string(dir.path().join(files::PICTURE)).unwrap();
    for r in found.rows.iter().filter(|r| r.left_out.is_some()) {
        assert!(
            picture.contains(r.name.name()) && table.contains(r.name.name()),
            "{}",
            r.name
        );
    }
    assert!(picture.contains("recommended") && picture.contains("tolerance 1e-3"));
}

/// A straight beam that is pressed beyond its buckling load stays straight, as nothing disturbs it: a bar does the same at less
/// cost, and is not recommended.
#[test]
fn what_is_kept_for_stability_is_not_recommended_off() {
    let found = ablated(
        &SLENDER
            .replace("force_x_n_m", "force_z_n_m")
            .replace("0.05, \"freq", "2, \"freq"),
        600.0,
    );
    println!(
        "{}\n{}",
        files::table(&found, &ShownQuantity::Largest),
        files::sentence(&found)
    );
    let across = row(&found, Effect::TransverseMotion);
    assert_eq!(across.verdict, EffectVerdict::Saves);
    assert!(across.number.contains("buckling load"), "{}", across.number);
    let recommended = found.recommendation.as_ref().unwrap();
    assert!(
        !recommended.off.contains(&Effect::TransverseMotion),
        "{:?}",
        recommended.off
    );
    let (_, why) = recommended
        .dropped
        .iter()
        .find(|d| d.0 == Effect::TransverseMotion)
        .unwrap();
    assert!(why.contains("buckling load"), "{why}");
}

#[test]
fn changes_are_judged_beside_the_integrators_own_error() {
    let measure = |name: &str, own| ModelMeasure {
        name: name.into(),
        size: 1.0,
        own: Some(own),
    };
    let measures = [measure("a", 1e-5), measure("b", 1e-2)];
    let changes = |a: f64, b: f64| BTreeMap::from([("a".to_string(), a), ("b".to_string(), b)]);
    assert_eq!(judge(&changes(2e-3, 0.0), &measures, 1e-3), Size::Large);
    assert_eq!(judge(&changes(5e-4, 9e-4), &measures, 1e-3), Size::Small);
    assert_eq!(judge(&changes(5e-4, 5e-3), &measures, 1e-3), Size::Hidden);
    assert_eq!(judge(&changes(2e-3, 5e-3), &measures, 1e-3), Size::Large);
    // What changes most is looked for among what is no error of the integrator.
    let most = |changes, tolerance| largest(&changes, &measures, tolerance).unwrap().0.name.clone();
    assert_eq!(most(changes(5e-4, 5e-3), 6e-3), "a");
    assert_eq!(most(changes(5e-6, 5e-3), 6e-3), "b");
    assert_eq!(
        most(changes(5e-4, 5e-3), 1e-3),
        "b",
        "it hides whether the tolerance is kept"
    );
}

#[test]
fn without_a_full_model_there_is_nothing_to_compare() {
    let found = ablated(SLENDER, 0.0);
    assert!(found.full.summary.is_none() && found.rows.is_empty() && found.recommendation.is_none());
    assert!(files::table(&found, &ShownQuantity::Largest).contains("the budget is used up"));
    let plan = TrialPlan {
        repeats: 0,
        budget_s: 600.0,
    };
    let wrong = ablate(
        &parsed(SLENDER),
        plan,
        Some("tip_u9_m"),
        &Evaluations::default(),
        &|_| {},
    )
    .unwrap_err();
    assert_eq!(wrong.exit_code(), 2);
    assert!(wrong.to_string().contains("largest, input_energy_j"), "{wrong}");
}

/// Exit code and both streams of `slcbeam` with arguments.
fn say(arguments: &[&str]) -> (i32, String, String) {
    let output = Command::cargo_bin("slcbeam").unwrap().args(arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

#[test]
fn a_recommendation_is_written_and_everything_else_stays() {
    let dir = TempDir::new().unwrap();
    let file = dir.path().join("slender.json");
    // Odd spaces, tabs and a value that is spelled unusually stay as they are.
    let text = SLENDER.replace("\"mesh\"", "\t \"mesh\"").replace("950}", "9.50e2 }");
    fs::write(&file, &text).unwrap();
    let out = dir.path().join("out");
    let arguments = [
        "effects",
        file.to_str().unwrap(),
        "--out",
        out.to_str().unwrap(),
        "--repeats=0",
        "--quiet",
        "--write",
    ];
    let (code, said, err) = say(&arguments);
    assert_eq!((code, err.as_str()), (0, ""), "{said}");
    let line = said.lines().find(|l| l.starts_with("\"effects\": {")).unwrap();
    assert!(said.contains("written into"), "{said}");
    let written = fs::read_to_string(&file).unwrap();
    let end = text.trim_end().strip_suffix("\n}").unwrap();
    assert_eq!(written, format!("{end},\n  {line}\n}}\n"));
    let (code, checked, err) = say(&["check", file.to_str().unwrap()]);
    assert_eq!((code, err.as_str()), (0, ""));
    assert!(checked.contains("switched off by name"), "{checked}");
    for name in [files::CSV, files::JSON, files::PICTURE] {
        assert!(out.join(name).exists(), "{name}");
    }
    // Again: the same is found, nothing is written; another choice is replaced where it stands.
    let (code, said, _) = say(&arguments);
    assert_eq!(code, 0);
    assert!(
        said.contains("already has these effects") && said.contains("as in the case"),
        "{said}"
    );
    assert_eq!(fs::read_to_string(&file).unwrap(), written);
    let full = text.replacen("\"name\"", "\"effects\" :  \"full\" ,\n \"name\"", 1);
    fs::write(&file, &full).unwrap();
    assert_eq!(say(&arguments).0, 0);
    let value = line.strip_prefix("\"effects\": ").unwrap();
    assert_eq!(fs::read_to_string(&file).unwrap(), full.replace("\"full\"", value));
    let names: Vec<_> = fs::read_dir(dir.path())
        .unwrap()
        .map(|e| e.unwrap().file_name())
        .collect();
    assert_eq!(names.len(), 2, "nothing is left beside the case: {names:?}");
}

#[test]
fn wrong_uses_say_what_is_wrong_and_write_nothing() {
    let dir = TempDir::new().unwrap();
    let file = dir.path().join("slender.json");
    fs::write(&file, SLENDER).unwrap();
    let (case, out) = (file.to_str().unwrap(), dir.path().join("out"));
    let out = out.to_str().unwrap();
    let broken = dir.path().join("broken.json");
    fs::write(&broken, SLENDER.replace("clamped", "glued")).unwrap();
    for (more, code) in [
        (&[case, "--write", "--set", "/solver/rtol=1e-5"][..], 2),
        (&[case, "--measure", "tip"], 2),
        (&[case, "--budget", "soon"], 2),
        (&[case, "--repeats", "-1"], 2),
        (&[], 2),
        (&["no-such-file.json"], 2),
        (&[broken.to_str().unwrap()], 3),
        (&[case, "--set", "/effects={\"transverse_motion\":\"off\"}"], 3),
    ] {
        let (said, told, err) = say(&[&["effects", "--quiet", "--out", out], more].concat());
        assert_eq!(said, code, "{more:?}: {err}");
        assert!(told.is_empty() && !err.is_empty(), "{more:?}");
    }
    assert!(!Path::new(out).exists());
    // No time for the full model: nothing to compare, nothing to write.
    let (code, told, _) = say(&["effects", case, "--out", out, "--quiet", "--budget", "1e-9", "--write"]);
    assert_eq!(code, 4, "{told}");
    assert_eq!(fs::read_to_string(&file).unwrap(), SLENDER);
    let (code, told, _) = say(&["effects", case, "--out", out, "--quiet", "--repeats", "0", "--json"]);
    assert_eq!(code, 0);
    let told: Value = serde_json::from_str(&told).unwrap();
    assert_eq!(told["case"], json!("slender"));
}

#[test]
fn the_page_has_the_table_and_its_pictures() {
    let page = fs::read_to_string("docs/effects.md").unwrap();
    let section = page.split("\n## ").find(|s| s.starts_with("The table")).unwrap();
    let rows: Vec<Vec<&str>> = section
        .lines()
        .filter(|l| l.starts_with("| `"))
        .map(|l| l.trim_matches('|').split('|').map(str::trim).collect())
        .collect();
    let wanted: Vec<String> = Effect::ALL.iter().map(|effect| format!("`{effect}`")).collect();
    let found: Vec<&str> = rows.iter().map(|row| row[0]).collect();
    assert_eq!(found, wanted);
    // what it adds, what it brings, the number that decides, what it costs
    assert!(
        rows.iter()
            .all(|row| row.len() == 5 && row.iter().all(|cell| !cell.is_empty()))
    );
    for part in page.split("](pictures/").skip(1) {
        let name = part.split(')').next().unwrap();
        assert!(Path::new("docs/pictures").join(name).exists(), "{name}");
    }
}
