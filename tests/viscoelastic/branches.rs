//! What a case may say of them.

use std::f64::consts::TAU;
use std::path::Path;

use serde_json::json;
use slcbeam::case;
use slcbeam::case::relaxation::dynamic_modulus;
use slcbeam::case::schema::Viscoelasticity;

use crate::{prony, strip};

/// Goal: loss factors up to 0.5 over up to four decades are met within 2 % everywhere in the band, between the frequencies of the fit too.
#[test]
fn loss_factors_are_constant_over_their_band() {
    for value in [0.01, 0.1, 0.3, 0.5] {
        for to_hz in [2.0, 10.0, 300.0] {
            let written = json!({"loss_factor": {"value": value, "from_hz": 1.0, "to_hz": to_hz}});
            let branches = serde_json::from_value::<Viscoelasticity>(written)
                .unwrap()
                .branches()
                .unwrap();
            for k in 0..=997 {
                let omega = TAU * f64::powf(to_hz, f64::from(k) / 997.0);
                let [storage, loss] = dynamic_modulus(&branches, omega);
                assert!(
                    (loss / storage / value - 1.0).abs() < 0.02,
                    "{value} {to_hz}: {}",
                    loss / storage
                );
            }
        }
    }
}

/// Goal: each mistake in `viscoelasticity` is told at its place.
#[test]
fn mistakes_are_told_at_their_place() {
    let band = |value: f64, from: f64, to: f64| json!({"loss_factor": {"value": value, "from_hz": from, "to_hz": to}});
    let both = json!({"prony": [{"modulus_ratio": 0.1, "time_s": 1}], "loss_factor": {"value": 0.1, "from_hz": 1, "to_hz": 3}});
    for (written, pointer) in [
        (json!({}), ""),
        (json!({"prony": []}), ""),
        (both, "/prony"),
        (band(0.9, 1.0, 1000.0), "/loss_factor/value"),
        (band(0.1, 10.0, 10.0), "/loss_factor/to_hz"),
        (band(0.1, 1e-9, 1e9), "/loss_factor/to_hz"),
        (prony(&[[0.0, 1.0]]), "/prony/0/modulus_ratio"),
        (prony(&[[1.0, 0.0]]), "/prony/0/time_s"),
        (prony(&[[1.0, 1e-15]]), "/prony/0/time_s"),
    ] {
        let text = strip(written.clone(), json!({})).to_string();
        let Err(faults) = case::parse(&text, Path::new("test.json"), Path::new(""), &[]) else {
            panic!("{written} is taken")
        };
        let told = format!("{faults:?}");
        assert!(
            told.contains(&format!("\"/beam/viscoelasticity{pointer}\"")),
            "{written}: {told}"
        );
    }
}
