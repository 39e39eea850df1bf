//! What data do not tell is named.

use serde_json::Value;

use crate::common::*;

const PUSHED: [&str; 3] = [
    "/ends/tip={\"free\": {\"force_x_n\": 0.1}}",
    "/mesh/cells_per_segment=1",
    "/start={}",
];

/// Deflections of a dry cantilever over forces, fitted by these numbers.
fn fitted(vary: &[&str], more: &[&str]) -> Value {
    let dir = tempfile::tempdir().expect("a folder");
    let case = load("cases/dry-cantilever.json", &PUSHED);
    let mut noise = noise(21);
    let mut text = String::from("f_n,u_mm\n");
    for k in 1..=10 {
        let force = 0.05 * f64::from(k);
        let u = 1e3 * at_rest(&case, &[(FORCE, force)], "tip_u1");
        text += &format!("{force},{}\n", u + 0.01 * noise());
    }
    let data = file(&dir, "pushed.csv", &text);
    let (drive, out) = (format!("f_n={FORCE}"), path(&dir, "fitted"));
    let mut asked = vec![
        "fit",
        "cases/dry-cantilever.json",
        &data,
        "--match",
        "u_mm=tip_u1",
        "--drive",
        &drive,
        "--out",
        &out,
    ];
    asked.extend(PUSHED.iter().flat_map(|set| ["--set", set]));
    asked.extend(vary.iter().flat_map(|vary| ["--vary", vary]));
    asked.extend(more);
    json(&asked)
}

fn unseen(found: &Value) -> Vec<&str> {
    found["unseen"]
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(Value::as_str)
        .collect()
}

/// Goal: the density does nothing at rest without weight: it is named and has no error, and the modulus has one.
#[test]
fn a_number_that_nothing_depends_on() {
    let found = fitted(&["/beam/young_modulus_pa=3e5:1e7", "/beam/density_kg_m3=500:2000"], &[]);
    assert_eq!(
        unseen(&found),
        ["the data do not determine /beam/density_kg_m3: no measured quantity depends on it"]
    );
    assert!(
        found["parameters"][1]["standard_error"].is_null() && off(&found, 0, 2e6) < 3.0,
        "{found:#}"
    );
}

/// Goal: of modulus and bending stiffness factor deflections see the product, in which both stand.
#[test]
fn two_numbers_of_which_the_product_is_seen() {
    let found = fitted(
        &["/beam/young_modulus_pa=3e5:1e7", "/beam/bending_stiffness_factor=0.1:5"],
        &["--starts", "3"],
    );
    assert_eq!(
        unseen(&found),
        ["the data determine only the product of /beam/young_modulus_pa and /beam/bending_stiffness_factor"]
    );
    let value = |k: usize| number(&found["parameters"][k]["value"]);
    assert!((value(0) * value(1) / 1.2e6 - 1.0).abs() < 0.02, "{found:#}");
    assert_eq!(found["starts"].as_array().map(Vec::len), Some(3));
}

/// Goal: an estimate that would leave its bounds is said to be at one, and has no error.
#[test]
fn a_number_at_its_bound() {
    let found = fitted(&["/beam/young_modulus_pa=3e6:1e7"], &[]);
    assert_eq!(found["parameters"][0]["at_bound"], "low");
    assert_eq!(found["parameters"][0]["value"], 3e6);
    let warnings = found["warnings"].to_string();
    assert!(
        warnings.contains("W029") && warnings.contains("lies at its lower bound"),
        "{warnings}"
    );
}
