//! Coefficients follow Young's modulus and the sizes that they are given with. Source: similarity. Plane and solid elasticity know no length,
//! so that in sections of one shape, s times as large, areas per pressure go with s²/E, per moment with 1/(sE), per force with 1/E, permeabilities
//! with s⁴, and ratios stay.

use std::path::Path;

use serde_json::{Value, json};
use slcbeam::case::parameter::{self, Parameter};
use slcbeam::case::{self, Case, inherited};
use slcbeam::run::equilibrium::{EquilibriumOptions, columns, differentiate, follow, system};
use slcbeam::run::record::Control;

use super::origins::{numbers, shipped};

const MODULUS: &str = "/beam/young_modulus_pa";
const PER_PRESSURE: &str = "/bladders/area_per_pressure_m2_per_pa";
const OPENING: &str = "/bladders/area_per_moment_m2_per_n_m/opening";
const TENSION: &str = "/bladders/area_per_force_m2_per_n/tension";
const SHEAR: &str = "/beam/shear_stiffness_n";
const SLOPE: &str = "/bladders/coupling/published/slope_per_pressure_rad";
const LENGTH: &str = "/bladders/coupling/published/length_per_pressure_m";

/// Coefficients with the powers of E and of s that they go with.
const POWERS: [(&str, i32, i32); 13] = [
    ("/beam/axial_stiffness_factor", 0, 0),
    ("/beam/bending_stiffness_factor", 0, 0),
    ("/beam/mass_factor", 0, 0),
    (SHEAR, 1, 2),
    (PER_PRESSURE, -1, 2),
    (OPENING, -1, -1),
    ("/bladders/area_per_moment_m2_per_n_m/closing", -1, -1),
    (TENSION, -1, 0),
    ("/bladders/area_per_force_m2_per_n/compression", -1, 0),
    (SLOPE, 0, 0),
    (LENGTH, 0, 1),
    ("/bladders/permeability_m4", 0, 4),
    ("/tubes/permeability_m4", 0, 4),
];

/// Sizes of a section with its bladders and tubes [m].
const SIZES: [&str; 7] = [
    "/beam/length_m",
    "/beam/height_m",
    "/beam/width_m",
    "/bladders/length_m",
    "/bladders/height_m",
    "/bladders/width_m",
    "/tubes/radius_m",
];

fn whole() -> Value {
    json!({
        "name": "whole", "preset": "matia-gat-beam", "beam": {"shear_stiffness_n": 90.0, "mass_factor": 0.8},
        "bladders": {"coupling": {"published": {"slope_per_pressure_rad": 0.4, "length_per_pressure_m": 0.003}}},
        "ends": {"root": "clamped", "tip": "free"}, "time": {"end_s": 1.0}
    })
}

fn read(case: &Value, sets: &[String], varied: &[String]) -> Case {
    let (here, base) = (Path::new("mine.json"), Path::new(""));
    case::parse_varied(&case.to_string(), here, base, sets, varied).unwrap_or_else(|e| panic!("{sets:?}: {e}"))
}

fn resolved(case: &Case) -> Value {
    serde_json::from_str(&case.resolved_json()).expect("JSON")
}

fn number(case: &Value, pointer: &str) -> f64 {
    case.pointer(pointer)
        .and_then(Value::as_f64)
        .unwrap_or_else(|| panic!("{pointer} is missing"))
}

/// Goal: modulus and similar sizes move all coefficients as similarity has it and nothing warns, whether a preset brings them, the file has them
/// in absolute form, a number of a study is changed, or a sample follows after other arguments. Powers of floating-point numbers: 1e-12.
#[test]
fn coefficients_follow_modulus_and_similar_sizes() {
    let plain = resolved(&read(&whole(), &[], &[]));
    let mut absolute = plain.clone();
    absolute.as_object_mut().expect("an object").remove("preset");
    let (softer, larger) = (0.37, 1.7);
    let mut changes = vec![(MODULUS, softer * number(&plain, MODULUS))];
    changes.extend(SIZES.map(|size| (size, larger * number(&plain, size))));
    let sets: Vec<String> = changes.iter().map(|(at, value)| format!("{at}={value:e}")).collect();
    for (name, case) in [
        ("preset", read(&whole(), &sets, &[])),
        ("absolute", read(&absolute, &sets, &[])),
        ("varied", read(&absolute, &["/name=\"other\"".into()], &sets)),
        (
            "changed",
            parameter::with(&read(&whole(), &[], &[]), &changes).expect("valid"),
        ),
        ("one by one", read(&whole(), &sets[..4], &sets[4..])),
    ] {
        let found = resolved(&case);
        for (pointer, of_modulus, of_size) in POWERS {
            let wanted = number(&plain, pointer) * softer.powi(of_modulus) * larger.powi(of_size);
            let ratio = number(&found, pointer) / wanted;
            assert!((ratio - 1.0).abs() < 1e-12, "{name} {pointer}: {ratio}");
        }
        assert_eq!(inherited::warnings(&case), [""; 0], "{name}");
    }
}

/// Goal: what is given together stands as given; what was given before follows.
#[test]
fn coefficients_given_with_a_modulus_belong_to_it() {
    let [own, softer] = [format!("{PER_PRESSURE}=3e-10"), format!("{MODULUS}=1e6")];
    let both = [own.clone(), softer.clone()];
    let area = |sets: &[String], varied: &[String]| number(&resolved(&read(&whole(), sets, varied)), PER_PRESSURE);
    assert_eq!(area(&both, &[]), 3e-10);
    assert_eq!(area(&[], &both), 3e-10);
    assert_eq!(area(&[own], &[softer]), 6e-10);
    let case = read(&whole(), &both[..1], &[]);
    let changed = parameter::with(&case, &[(MODULUS, 1e6)]).expect("valid");
    assert_eq!(number(&resolved(&changed), PER_PRESSURE), 6e-10);
    let changed = parameter::with(&case, &[(MODULUS, 1e6), (PER_PRESSURE, 2e-10)]).expect("valid");
    assert_eq!(number(&resolved(&changed), PER_PRESSURE), 2e-10);
    assert_eq!(number(&resolved(&changed), TENSION), 2.0 * 3.64e-8);
    let mut own = whole();
    own["beam"]["young_modulus_pa"] = json!(1e6);
    own["bladders"]["area_per_pressure_m2_per_pa"] = json!(3e-10);
    let own = resolved(&read(&own, &[], &[]));
    assert_eq!(
        [number(&own, PER_PRESSURE), number(&own, TENSION)],
        [3e-10, 2.0 * 3.64e-8]
    );
    let words = read(&whole(), &["/beam/young_modulus_pa=1e6".into()], &[])
        .origins
        .describe();
    assert_eq!(
        words[PER_PRESSURE],
        "preset matia-gat-beam, x 2 to follow modulus and sizes"
    );
}

/// Coefficients that depend on a number of a case, written down from what they are.
fn dependents(pointer: &str) -> Vec<&'static str> {
    let all = |wanted: &dyn Fn(&str) -> bool| POWERS.iter().map(|law| law.0).filter(|p| wanted(p)).collect();
    let duct = |p: &str| p.ends_with("permeability_m4");
    match pointer {
        MODULUS => all(&|p| p == SHEAR || p.contains("/area_per_")),
        "/beam/length_m" => all(&|p| !duct(p)),
        "/beam/height_m" => all(&|p| !duct(p)),
        "/beam/width_m" | "/bladders/length_m" => all(&|p| !duct(p) && p != PER_PRESSURE),
        "/bladders/height_m" | "/bladders/width_m" => all(&|p| p != "/tubes/permeability_m4"),
        "/tubes/radius_m" => vec!["/tubes/permeability_m4"],
        "/beam/density_kg_m3" | "/fluid/density_kg_m3" => vec!["/beam/mass_factor"],
        _ => vec![],
    }
}

/// Goal: of every number of every shipped case, a tenth more of it by `--set` moves the coefficients that depend on it, warns of those, or is
/// refused; others stay to the last digit. Numbers of a section compute coefficients anew; long arrays are looked at in part.
#[test]
fn every_number_moves_what_depends_on_it() {
    let (mut looked_at, mut moved, mut warned) = (0, 0, 0);
    for path in shipped() {
        let (text, base) = (
            std::fs::read_to_string(&path).expect("text"),
            path.parent().expect("folder"),
        );
        let own = case::parse(&text, &path, base, &[]).expect("valid");
        let before = resolved(&own);
        let mut all = vec![];
        numbers(&before, String::new(), &mut all);
        let late = |p: &str| {
            p.rsplit('/')
                .next()
                .and_then(|k| k.parse::<usize>().ok())
                .is_some_and(|k| k > 3)
        };
        all.retain(|(p, text)| !p.starts_with("/section/") && !late(p) && text.contains(['.', 'e']));
        for (pointer, value) in all {
            let more = 1.1 * value.parse::<f64>().expect("a number");
            let set = format!("{pointer}={more:e}");
            let Ok(case) = case::parse(&text, &path, base, std::slice::from_ref(&set)) else {
                continue;
            };
            looked_at += 1;
            let after = resolved(&case);
            let told = inherited::warnings(&case).join("\n");
            let by_it = dependents(&pointer);
            for (coefficient, ..) in POWERS.iter().filter(|law| law.0 != pointer) {
                let [Some(was), Some(is)] = [&before, &after].map(|of| of.pointer(coefficient).and_then(Value::as_f64))
                else {
                    continue;
                };
                // the factors of a full section are 1 in every shape; gas in place of liquid weighs nothing
                let full = before.get("bladders").is_none() && was == 1.0;
                let light =
                    number_of(&before, "/fluid/density_kg_m3") < 0.01 * number_of(&before, "/beam/density_kg_m3");
                let free = full || light && pointer.ends_with("density_kg_m3");
                // a beam without bladders has a shape of two sides; one with its section has more bladders where it is longer; those of a
                // structure have lengths of their own
                let own = |key: &str| before.get(key).is_some();
                let alike = !own("bladders") || own("section") || own("beams");
                let free = free || alike && pointer == "/beam/length_m";
                match by_it.contains(coefficient) && !free {
                    true if told.contains(coefficient) => warned += 1,
                    true => {
                        assert!(
                            (is / was - 1.0).abs() > 1e-3,
                            "{path:?} {set}: {coefficient} stays {was}"
                        );
                        moved += 1;
                    }
                    false => assert_eq!(was, is, "{path:?} {set}: {coefficient}"),
                }
            }
        }
    }
    println!("{looked_at} numbers, {moved} coefficients moved, {warned} warned of");
    assert!(
        looked_at > 800 && moved > 150 && warned > 500,
        "{looked_at} {moved} {warned}"
    );
}

fn number_of(case: &Value, pointer: &str) -> f64 {
    case.pointer(pointer).and_then(Value::as_f64).unwrap_or_default()
}

/// Goal: the tip of the tour's actuator is that of its modulus, 9.16, 4.56 and 0.91 mm of 1, 2 and 10 MPa, and its derivative by the modulus is
/// that of two `--set`: central differences of 1e-3 leave 1e-6.
#[test]
fn a_softer_actuator_bends_further() {
    let read = |modulus: f64| {
        let set = [format!("{MODULUS}={modulus:e}")];
        case::load("cases/tour-actuator.json".as_ref(), &set).expect("a case")
    };
    let options = |case: &Case| EquilibriumOptions {
        points: Some(1),
        ..EquilibriumOptions::at(case.time.end_s)
    };
    let path = |case: &Case| follow(case, &options(case), &mut |_| Control::Continue).expect("a path");
    let case = read(2e6);
    let names = columns(&system(&case, case.time.end_s).expect("a system"));
    let place = names.iter().position(|one| one.name == "tip_u1").expect("the tip");
    let tip = |modulus: f64| path(&read(modulus)).last().row[place];
    for (modulus, wanted) in [(1e6, 9.16e-3), (2e6, 4.56e-3), (1e7, 0.91e-3)] {
        let found = tip(modulus);
        assert!((found - wanted).abs() < 0.5e-5, "{modulus:e}: {found:e}");
    }
    let by = Parameter::find(&case, MODULUS).expect("a number");
    let slopes = differentiate(&case, &options(&case), &path(&case), &[by]).expect("derivatives");
    let difference = (tip(2.002e6) - tip(1.998e6)) / 4e3;
    let found = slopes[0].row[place];
    assert!(
        found < 0.0 && (found / difference - 1.0).abs() < 1e-4,
        "{found:e} {difference:e}"
    );
}

/// Goal: numbers that change the shape of the section are told where results are differentiated by them; those that do not are not.
#[test]
fn derivatives_by_a_shape_are_told() {
    let case = read(&whole(), &[], &[]);
    let told = |pointer: &str| inherited::varied(&case, [pointer].into_iter());
    let height = told("/beam/height_m").expect("a warning");
    assert!(height.starts_with("W017") && height.contains(OPENING), "{height}");
    for other in [MODULUS, "/tubes/radius_m", OPENING, "/fluid/viscosity_pa_s"] {
        assert_eq!(told(other), None, "{other}");
    }
}
