//! What a scene is judged against: everything simulated, order 5 at a tight tolerance, two fine meshes and their limit.
//!
//! A figure on meshes of `K` and `2K` cells a segment is taken to `x(2K) + (x(2K) - x(K))/3`, which is exact for errors of second
//! order. Its error is counted as twice the change that this makes, all that errors of first order would leave, plus twice what
//! another method of another order at ten times the tolerance changes.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;
use slcbeam::case::Case;
use slcbeam::case::schema::Method;
use slcbeam::run::summary::Summary;

use crate::run::{Figures, Work, exact, figures, finished};

/// A figure and its error, and for each quantity the size that errors refer to.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Value and error of every figure.
    pub figures: BTreeMap<String, BTreeMap<String, (f64, f64)>>,
    /// Largest figure of a quantity, at least its rounding level.
    pub sizes: BTreeMap<String, f64>,
    /// Quantities whose largest figure is below their rounding level.
    pub negligible: BTreeSet<String>,
    /// Cells a segment of the finer mesh.
    pub cells: usize,
}

/// What came of it.
#[derive(Clone, Debug)]
pub enum Found {
    /// Figures.
    Known(Box<Reference>),
    /// All runs end early, at about this time, for a reason of the model.
    Ends(String),
    /// Not known, and why.
    Unknown(String),
}

/// How a reason begins where runs of the reference fail, or end at different times.
pub const FAILED: &str = "failed";
/// Tolerance, and that of the check.
const TOLERANCES: [(f64, f64); 2] = [(1e-8, 1e-7), (1e-7, 1e-6)];
/// Largest mesh: cells a segment.
const FINEST: usize = 64;
/// Cells in the shortest detail of a shape.
const DETAIL: f64 = 1.0;

/// Finds the reference; `coarse` is the coarser mesh, `unknowns` their number on a mesh of `4` cells a segment, `close` the
/// relative error that is small enough.
pub fn find(case: &Case, scene: &Value, coarse: usize, unknowns: f64, close: f64, work: &mut Work) -> Found {
    let needed = DETAIL / (details(scene) * case.segments() as f64);
    let mut cells = coarse;
    while (cells as f64) < needed && cells < FINEST / 2 {
        cells *= 2;
    }
    let fastest = fastest(scene);
    let mut last = Found::Unknown("too long".into());
    for (rtol, check) in TOLERANCES {
        last = on_meshes(case, cells, [rtol, check], unknowns, fastest, close, work);
        match &last {
            Found::Unknown(why) if why.starts_with(FAILED) => {}
            _ => return last,
        }
    }
    last
}

fn on_meshes(
    case: &Case,
    cells: usize,
    rtol: [f64; 2],
    unknowns: f64,
    fastest: f64,
    close: f64,
    work: &mut Work,
) -> Found {
    let price = |cells: usize| unknowns * cells as f64 / 4.0;
    let run = |work: &mut Work, cells: usize, method: Method, rtol: f64| {
        work.run(&exact(case, cells, method, rtol, fastest), price(cells))
    };
    let too_long = || Found::Unknown("too long".into());
    let Some(check) = run(work, cells, Method::Esdirk46, rtol[1]) else {
        return too_long();
    };
    if !finished(&check) {
        let Some(again) = run(work, cells, Method::Esdirk57, rtol[0]) else {
            return too_long();
        };
        return ended(&check, &again);
    }
    // Order 5 at a tenth of the tolerance takes about half as many steps again, each of seven stages, here and on twice the cells.
    let expected = 1.5 * check.solver.steps as f64 * price(cells) * 7.0 * 3.0;
    if expected > work.left {
        return too_long();
    }
    let Some(coarse) = run(work, cells, Method::Esdirk57, rtol[0]) else {
        return too_long();
    };
    let Some(fine) = run(work, 2 * cells, Method::Esdirk57, rtol[0]) else {
        return too_long();
    };
    for one in [&coarse, &fine] {
        if !finished(one) {
            return ended(&check, one);
        }
    }
    let mut found = limit(case, [&check, &coarse, &fine], 2 * cells);
    let mut meshes = [coarse, fine];
    let mut cells = 2 * cells;
    while cells < FINEST && found.worst(|_| true) > close {
        let Some(finer) = run(work, 2 * cells, Method::Esdirk57, rtol[0]) else {
            break;
        };
        if !finished(&finer) {
            break;
        }
        cells *= 2;
        let [first, second] = meshes;
        let next = limit_with_time(case, [&check, &first], [&second, &finer], cells);
        meshes = [second, finer];
        found = next;
        // The check stands for the mesh it was made on.
        if found.worst(|_| true) <= close {
            break;
        }
    }
    Found::Known(Box::new(found))
}

/// Runs that do not reach the end agree on that, or nothing is known.
fn ended(a: &Summary, b: &Summary) -> Found {
    let stopped = |s: &Summary| s.reason.clone().unwrap_or_default();
    let alike = !finished(a) && !finished(b) && (a.time_s - b.time_s).abs() <= 0.05 * a.time_s.max(b.time_s);
    match alike && a.status == b.status && a.status != slcbeam::run::summary::Status::Failed {
        true => Found::Ends(stopped(b)),
        false => Found::Unknown(format!("{FAILED}: {} / {}", stopped(a), stopped(b))),
    }
}

fn limit(case: &Case, [check, coarse, fine]: [&Summary; 3], cells: usize) -> Reference {
    limit_with_time(case, [check, coarse], [coarse, fine], cells)
}

/// The limit of two meshes; what time leaves is the difference of the first two.
fn limit_with_time(case: &Case, time: [&Summary; 2], meshes: [&Summary; 2], cells: usize) -> Reference {
    let [check, same, coarse, fine] = [time[0], time[1], meshes[0], meshes[1]].map(figures);
    let (sizes, negligible) = sizes(case, meshes[1], &fine);
    let at = |from: &Figures, quantity: &str, figure: &str| from.get(quantity).and_then(|q| q.get(figure)).copied();
    let mut all = BTreeMap::new();
    for (quantity, of) in &fine {
        let mut known = BTreeMap::new();
        for (figure, &value) in of {
            let difference = |a: &Figures, b: &Figures| match (at(a, quantity, figure), at(b, quantity, figure)) {
                (Some(a), Some(b)) => a - b,
                _ => f64::INFINITY,
            };
            let change = difference(&fine, &coarse) / 3.0;
            let error = 2.0 * change.abs() + 2.0 * difference(&check, &same).abs();
            known.insert(
                figure.clone(),
                if change.is_finite() {
                    (value + change, error)
                } else {
                    (value, f64::INFINITY)
                },
            );
        }
        all.insert(quantity.clone(), known);
    }
    Reference {
        figures: all,
        sizes,
        negligible,
        cells,
    }
}

/// Largest figures, at least their rounding levels: 1e-9 of the length, 1e-6 of others of the same unit. The second result has quantities
/// below their level.
fn sizes(case: &Case, summary: &Summary, figures: &Figures) -> (BTreeMap<String, f64>, BTreeSet<String>) {
    let unit = |name: &str| name.rsplit('_').next().unwrap_or_default().to_owned();
    let length = case.beam.length_m;
    let most = |wanted: &str| {
        let alike = figures.iter().filter(|(name, _)| unit(name) == wanted);
        alike.map(|(_, of)| largest(of)).fold(0.0, f64::max)
    };
    let moved = most("m").max(most("rad") * length);
    let energy = summary.balances.energy_j.values().fold(0.0_f64, |m, e| m.max(e.abs()));
    let floor = |name: &str| match unit(name).as_str() {
        "m" => (1e-9 * length).max(1e-6 * moved),
        "rad" => 1e-9_f64.max(1e-6 * moved / length),
        "j" => {
            1e-6 * energy + 1e-15 * case.beam.young_modulus_pa * length * case.beam.height_m * case.beam.width_m * 1e-6
        }
        "pa" => 1e-12 * case.beam.young_modulus_pa,
        _ => 1e-3,
    };
    let of = |(name, of): (&String, &BTreeMap<String, f64>)| (name.clone(), largest(of).max(floor(name)));
    let below = |(name, of): &(&String, &BTreeMap<String, f64>)| largest(of) < floor(name);
    let negligible = figures.iter().filter(below).map(|(name, _)| name.clone());
    (figures.iter().map(of).collect(), negligible.collect())
}

fn largest(figures: &BTreeMap<String, f64>) -> f64 {
    figures.values().fold(0.0, |most, x| most.max(x.abs()))
}

impl Reference {
    /// True if a quantity is below its rounding level here and in other figures: `docs/accuracy.md` excludes it from error bars.
    pub fn is_negligible(&self, quantity: &str, figures: &Figures) -> bool {
        let other = figures.get(quantity).map_or(0.0, largest);
        self.negligible.contains(quantity) && other < self.sizes[quantity]
    }

    /// Largest relative error of the reference itself, over some quantities.
    pub fn worst(&self, quantities: impl Fn(&str) -> bool) -> f64 {
        let of = |(name, all): (&String, &BTreeMap<String, (f64, f64)>)| {
            all.values().map(|(_, e)| e / self.sizes[name]).fold(0.0, f64::max)
        };
        self.figures
            .iter()
            .filter(|(name, _)| quantities(name))
            .map(of)
            .fold(0.0, f64::max)
    }
}

/// Shortest detail of any shape along the beam, over its length.
pub fn details(scene: &Value) -> f64 {
    let mut shortest = 1.0_f64;
    walk(scene, &mut |key, value| {
        let found = match key {
            "waves" => value.as_f64().map(|w| 1.0 / w.abs().max(1.0) * 0.7),
            "positions" => value.as_array().map(|at| {
                let at: Vec<f64> = at.iter().filter_map(Value::as_f64).collect();
                // Edges of a piece matter little: its width counts.
                at.windows(3).map(|w| w[2] - w[0]).fold(1.0, f64::min)
            }),
            _ => None,
        };
        shortest = found.map_or(shortest, |f| shortest.min(f));
    });
    shortest.max(1e-3)
}

/// Longest step over which nothing in the scene's signals can be missed [s]; what switching times mark, points of tables among
/// them, does not count: every run stops there.
fn fastest(scene: &Value) -> f64 {
    let mut shortest = f64::INFINITY;
    walk(scene, &mut |key, value| {
        let found = match key {
            "frequency_hz" => value.as_f64().map(|f| 0.5 / f.abs()),
            "steepness_per_s" => value.as_f64().map(|k| 6.0 / k.abs()),
            _ => None,
        };
        shortest = found.map_or(shortest, |f| shortest.min(f));
    });
    shortest
}

fn walk(value: &Value, see: &mut dyn FnMut(&str, &Value)) {
    match value {
        Value::Object(members) => members.iter().for_each(|(key, inner)| {
            see(key, inner);
            walk(inner, see);
        }),
        Value::Array(items) => items.iter().for_each(|item| walk(item, see)),
        _ => {}
    }
}
