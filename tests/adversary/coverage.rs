//! Coverage of error bars: errors of figures beside the bars that runs give them.

use std::sync::Mutex;

use serde_json::{Value, json};
use slcbeam::discrete::System;
use slcbeam::run::summary::Summary;
use slcbeam::study::companion;

use crate::judge::{self, KNOWN, errors, guess};
use crate::reference::Found;
use crate::run::{each_seed, figures, finished, steps};
use crate::scene::{self, Kind};

/// Steps times unknowns of a scene's run, and of its reference.
const WORK: [f64; 2] = [2e6, 1.5e7];

/// A figure that is wrong by more than one part in a thousand.
#[derive(Clone, Copy)]
pub struct Covered {
    /// Error relative to the quantity.
    pub error: f64,
    /// Error bar, likewise.
    pub bar: f64,
}

/// Errors and bars of the scenes of seeds.
pub fn run(kind: Kind, first: u64, count: u64) -> Vec<Covered> {
    let (seeds, all): (Vec<u64>, _) = ((first..first + count).collect(), Mutex::new(vec![]));
    each_seed(&seeds, |seed| {
        let found = one(kind, seed);
        all.lock().expect("no thread panics").extend(found);
    });
    all.into_inner().expect("no thread panics")
}

fn one(kind: Kind, seed: u64) -> Vec<Covered> {
    let scene = scene::draw(seed, kind);
    let close = 2e-3;
    let (Ok(case), Some(Found::Known(reference))) = (judge::read(&scene), judge::reference(&scene, close, WORK[1]))
    else {
        return vec![];
    };
    let system = System::new(&case).expect("a case that was read");
    let mut recorder = steps((WORK[0] / guess(&case) / 6.0) as u64);
    let Ok(outcome) = companion::run(&case, system, &[], &mut recorder) else {
        return vec![];
    };
    let run = outcome.summary;
    if !finished(&run) {
        return vec![];
    }
    let bar = |quantity: &str, figure: &str| run.errors.get(quantity)?.get(figure).copied();
    let off = errors(&figures(&run), &reference, |_| true);
    let lines = off.iter().map(|one| {
        json!({"seed": seed, "quantity": one.quantity, "figure": one.figure, "error": one.error, "doubt": one.doubt,
            "bar": bar(&one.quantity, &one.figure).map(|bar| bar / reference.sizes[&one.quantity])})
    });
    let lines: Vec<Value> = lines.collect();
    println!("{}", json!({"seed": seed, "scene": told(&run), "rows": lines}));
    let wrong = off
        .iter()
        .filter(|one| one.error > 1e-3 && one.doubt <= KNOWN * one.error);
    wrong
        .map(|one| Covered {
            error: one.error,
            bar: bar(&one.quantity, &one.figure).unwrap_or(0.0) / reference.sizes[&one.quantity],
        })
        .collect()
}

fn told(run: &Summary) -> Value {
    let companion = run.companion.clone().unwrap_or_default();
    json!({"steps": run.solver.steps, "unknowns": run.unknowns, "companion_steps": companion.steps,
        "companion_unknowns": companion.unknowns, "reason": companion.reason, "added": companion.added_effects,
        "evaluations": [run.solver.residual_evaluations, companion.residual_evaluations], "warnings": run.warnings})
}

/// Shares of figures whose bar is at least a third of the error, and at most four times it beside.
pub fn shares(all: &[Covered]) -> [f64; 2] {
    let share =
        |keep: &dyn Fn(&Covered) -> bool| all.iter().filter(|one| keep(one)).count() as f64 / all.len().max(1) as f64;
    let covered = |one: &Covered| one.bar >= one.error / 3.0;
    [
        share(&covered),
        share(&|one| covered(one) && one.bar <= 4.0 * one.error),
    ]
}

/// Coverage and sharpness as a table.
pub fn table(all: &[Covered]) -> String {
    let mut text = "| errors above | figures | bar at least a third | and at most four times | bar below 1 % |\n|---|---|---|---|---|\n".to_string();
    for least in [1e-3, 2e-2, 5e-2] {
        let wrong: Vec<Covered> = all.iter().filter(|one| one.error > least).copied().collect();
        let [covered, sharp] = shares(&wrong);
        let small = wrong.iter().filter(|one| one.bar < 0.01).count();
        text += &format!(
            "| {least:e} | {} | {covered:.3} | {sharp:.3} | {small} |\n",
            wrong.len()
        );
    }
    text
}
