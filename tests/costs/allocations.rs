//! What is done at every step allocates nothing: residual, Jacobian, integrands and tangents of the beam, residual and Jacobian of
//! its equilibria.
//!
//! Source: the promises of `src/dae/mod.rs`. Goal: after two calls for warming up a hundred further calls ask the system for no memory, in
//! every case and both formulations, at times all over the run, so that every signal, valve and port has its turn.

use std::path::PathBuf;

use crate::chance::Random;
use slcbeam::case;
use slcbeam::dae::{BeamDae, Dae, Seeds, StaticBeam};
use slcbeam::discrete::{System, start};

/// Calls before those that count, and those.
const WARM: usize = 2;
const CALLS: usize = 100;
/// Directions of a tangent: more than one sweep takes.
const DIRECTIONS: usize = 9;
/// Random parts of a state, in units of the scales of its unknowns: no cell folds over.
const SIZE: f64 = 1e-3;

fn cases() -> Vec<PathBuf> {
    let mut files: Vec<_> = ["cases", "cases/hard"]
        .iter()
        .flat_map(|folder| std::fs::read_dir(folder).unwrap())
        .map(|f| f.unwrap().path())
        .filter(|p| p.extension().is_some_and(|e| e == "json") && p.file_stem().unwrap() != "schema")
        .collect();
    files.sort();
    files
}

/// Times that allocations were asked for while something was called again and again.
fn allocations(mut call: impl FnMut(usize)) -> u64 {
    (0..WARM).for_each(&mut call);
    allocation_counter::measure(|| (WARM..WARM + CALLS).for_each(&mut call)).count_total
}

fn vectors(random: &mut Random, around: &[f64], count: usize) -> Vec<Vec<f64>> {
    let mut one = || around.iter().map(|x| x + random.between(-SIZE, SIZE)).collect();
    (0..count).map(|_| one()).collect()
}

/// The counter counts at all.
#[test]
fn a_vector_is_counted() {
    let mut kept = vec![];
    assert_eq!(allocations(|k| kept = vec![k; 3]), CALLS as u64);
    assert_eq!(kept.len(), 3);
}

#[test]
fn nothing_is_allocated_at_a_step() {
    let mut found = vec![];
    for path in cases() {
        for formulation in ["conservative", "published"] {
            let case = match case::load(&path, &[format!("/formulation=\"{formulation}\"")]) {
                // finite strain, curvature at rest and rotating frames have one formulation
                Err(_) if formulation == "published" => continue,
                loaded => loaded.unwrap(),
            };
            let end = case.time.end_s;
            let time = |call: usize| end * call as f64 / (WARM + CALLS) as f64;
            let mut dae = BeamDae::new(System::new(&case).unwrap());
            let (system, now) = dae.instant(0.0);
            let begin = start::state(system, &case, now);
            let n = dae.len();
            let random = &mut Random(1);
            let states = vectors(random, &begin, WARM + CALLS);
            let rates = vectors(random, &vec![0.0; n], WARM + CALLS);
            let directions = vectors(random, &vec![0.0; n], 2 * DIRECTIONS);
            let directions: Vec<&[f64]> = directions.iter().map(Vec::as_slice).collect();
            let (along, along_rates) = directions.split_at(DIRECTIONS);
            let mut out = vec![0.0; n];
            let mut outs = vec![vec![0.0; n]; DIRECTIONS];
            let mut outs: Vec<&mut [f64]> = outs.iter_mut().map(Vec::as_mut_slice).collect();
            let mut values = vec![0.0; dae.pattern().entries()];
            let mut integrands = vec![0.0; dae.integrals()];
            let mut told = |what: &str, count: u64| {
                if count > 0 {
                    found.push(format!(
                        "{} {formulation}: {what}: {count} in {CALLS} calls",
                        path.display()
                    ));
                }
            };
            let step = Seeds::Step { cj: 37.0 };
            let count = allocations(|k| dae.residual(time(k), &states[k], &rates[k], &mut out).unwrap());
            told("residual", count);
            let count = allocations(|k| dae.jacobian(time(k), &states[k], &rates[k], step, &mut values).unwrap());
            told("Jacobian", count);
            let count = allocations(|k| dae.integrands(time(k), &states[k], &rates[k], &mut integrands).unwrap());
            told("integrands", count);
            let count = allocations(|k| {
                dae.tangent(time(k), &states[k], &rates[k], [along, along_rates], &mut outs)
                    .unwrap();
            });
            told("tangent", count);
            let mut still = StaticBeam::from_nothing(dae.system().clone(), &begin, &[]);
            let mut values = vec![0.0; still.pattern().entries()];
            let share = |call: usize| call as f64 / (WARM + CALLS) as f64;
            let count = allocations(|k| still.residual(share(k), &states[k], &rates[k], &mut out).unwrap());
            told("residual at rest", count);
            let count = allocations(|k| {
                still
                    .jacobian(share(k), &states[k], &rates[k], step, &mut values)
                    .unwrap()
            });
            told("Jacobian at rest", count);
        }
    }
    assert!(found.is_empty(), "{} allocate:\n{}", found.len(), found.join("\n"));
}
