//! Floquet multipliers: the derivative of the period map, Mathieu's equation, modes of what nothing drives.

use std::path::Path;
use std::time::Instant;

use serde_json::{Value, json};
use slcbeam::case::{self, Case};
use slcbeam::run::floquet::{self, Stability};
use slcbeam::run::periodic::{Scene, shoot};

fn case_of(value: &Value) -> Case {
    case::parse(&value.to_string(), Path::new("test.json"), Path::new(""), &[])
        .unwrap()
        .case
}

fn shipped(name: &str, sets: &[&str]) -> Case {
    let sets: Vec<String> = sets.iter().map(|s| s.to_string()).collect();
    case::load(format!("cases/{name}.json").as_ref(), &sets).unwrap().case
}

#[test]
fn probe() {
    for (name, sets) in [
        ("wiring-2", vec![]),
        ("wiring-2", vec!["/formulation=\"conservative\""]),
        ("valves-open", vec![]),
        ("valves-hundredth", vec![]),
    ] {
        let case = shipped(name, &sets);
        let begin = Instant::now();
        let scene = Scene::new(&case, None).unwrap();
        println!(
            "{name}: {} unknowns, dimension {}",
            scene.system.layout.len,
            scene.dimension()
        );
        match shoot(&scene, None) {
            Ok(mut cycle) => {
                println!("{:?} {:?}", cycle.search, begin.elapsed());
                let f = floquet::multipliers(&scene, &mut cycle, 10);
                println!("{:?} {}", begin.elapsed(), f.verdict.words);
                for m in &f.multipliers {
                    println!("  {:?}", m);
                }
            }
            Err(e) => println!("{e:?} {:?}", begin.elapsed()),
        }
    }
    let _ = (case_of(&json!({})), Stability::Stable);
}
