//! Random cases with random effects left out: a system of index one each time, its derivatives exact.

use std::path::Path;

use slcbeam::case::{self, schema::Effect};
use slcbeam::dae::{BeamDae, Dae};
use slcbeam::discrete::System;
use slcbeam::model::Model;

use super::differences::worst_difference;
use super::fuzz_case::text;
use crate::chance::Random;

#[test]
fn derivatives_are_exact_for_random_effects_of_random_cases() {
    let (mut refused, mut checked, mut worst) = (0, 0, 0.0_f64);
    for seed in 0..1000 {
        let mut r = Random(seed ^ 0xEFFE_C750);
        let mut sets = vec![r#"/effects={"rotary_inertia":"auto"}"#.to_string()];
        sets.extend(Effect::CHOSEN.iter().filter_map(|name| {
            let leave = r.one_in(4);
            leave.then(|| format!("/effects/{name}=\"off\""))
        }));
        let Ok(case) = case::parse(&text(seed), Path::new("random.json"), Path::new("."), &sets) else {
            continue;
        };
        let model = Model::new(&case).unwrap();
        if !model.effects.refusals.is_empty() {
            refused += 1;
            continue;
        }
        let mut dae = BeamDae::new(System::with(&case, model).unwrap());
        if dae.is_empty() {
            continue;
        }
        let off = worst_difference(&mut dae, seed, 0.03);
        worst = worst.max(off);
        checked += 1;
        assert!(off < 1e-4, "seed {seed}, {sets:?}: {off:.1e}");
    }
    println!("{checked} checked, {refused} refused, worst {worst:.1e}");
    assert!(checked > 200);
}
