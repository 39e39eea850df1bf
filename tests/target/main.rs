//! An accuracy asked for: chosen meshes and tolerances hold it, estimates are honest.

#[path = "../common/chance.rs"]
mod chance;
mod estimates;
mod models;
mod scenes;

use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Duration, Instant};

use slcbeam::case::schema::{Effects, Method};
use slcbeam::case::{self, Case};
use slcbeam::discrete::System;
use slcbeam::run::dynamics::{self, Outcome};
use slcbeam::run::record::{Control, Progress, Unrecorded};
use slcbeam::run::rounding_scales::RoundingScales;
use slcbeam::run::summary::{Status, Summary};
use slcbeam::study::accuracy::plan;
use slcbeam::study::companion::{self, Accurate, error};
use slcbeam::study::target;
use slcbeam::study::target::effects::Annotate;

fn load(name: &str, sets: &[&str]) -> Case {
    let sets: Vec<String> = sets.iter().map(ToString::to_string).collect();
    match case::load(Path::new(&format!("cases/{name}.json")), &sets) {
        Ok(case) => case,
        Err(error) => panic!("{error}: {error:?}"),
    }
}

/// Runs without keeping anything, until time is up.
fn record(case: &Case, until: Instant) -> Outcome {
    let mut until = Unrecorded(|_: &Progress| stop_after(until));
    dynamics::run(case, &mut until).expect("a recorder that keeps nothing does not fail")
}

fn stop_after(until: Instant) -> Control {
    if Instant::now() < until {
        Control::Continue
    } else {
        Control::Stop("time is up".into())
    }
}

/// Reaches an accuracy within a time.
fn reach(case: &Case, asked: f64, until: Instant) -> Outcome {
    let mut measured = |case: &Case, accuracy: &Accurate| {
        let mut until = Unrecorded(|_: &Progress| stop_after(until));
        companion::measured(case, System::new(case)?, accuracy, &mut until)
    };
    target::reach(case, asked, None, &mut measured).expect("memory")
}

/// All figures of a quantity, a probe or a port.
fn figures(name: &str, summary: &Summary) -> Vec<f64> {
    let all = [&summary.quantities, &summary.probes, &summary.ports];
    let quantity = all.into_iter().find_map(|of| of.get(name));
    quantity.map_or(vec![], |q| q.figures().map(|f| f.1).collect())
}

/// Factors of the sizes of quantities that an accuracy of a run refers to.
fn factors<'a>(case: &Case, run: &'a Summary) -> BTreeMap<&'a str, f64> {
    let floors = RoundingScales::from_case(case).expect("a case that runs");
    error::factors_of_sizes(run, &floors, error::SMALL)
}

/// Largest error of a quantity's figures, relative to the largest of them.
fn largest_error(name: &str, run: &Summary, reference: &Summary) -> f64 {
    let (a, b) = (figures(name, run), figures(name, reference));
    let size = b.iter().fold(0.0_f64, |s, x| s.max(x.abs()));
    a.iter().zip(&b).fold(0.0_f64, |e, (x, y)| e.max((x - y).abs())) / size
}

/// Goal: of smooth scenes, dry and wet, driven, loaded and harvesting, at 10 % and 1 %: the true error, against a mesh
/// twice as fine as the finest used and a hundredth of the tightest tolerance, is below the one asked in 95 % of the
/// quantities, and the estimate of a quantity is no less than a third of it in 80 %. Flows into the open ends of `wiring-2`, which are
/// wrong by more than themselves on coarse meshes, are not pursued, and that is said. (The published coupling is left out of
/// `bend-wet`: its short waves grow at tight tolerances, so that there is no limit to be accurate about.)
#[test]
fn estimates_are_honest() {
    let both: &[f64] = &[1e-1, 1e-2];
    let scenes: [(&str, &[&str], &[f64]); 7] = [
        ("stretch-dry", &[], both),
        ("bend-dry", &[], both),
        ("roll-up", &[], both),
        ("bend-wet", &[r#"/bladders/coupling="reciprocal""#], both),
        ("hard/kinks", &["/time/end_s=0.2"], both),
        (
            "harvester-crossover-uniform",
            &[r#"/bladders/coupling="reciprocal""#],
            &[1e-1],
        ),
        (
            "wiring-2",
            &["/ends/root/clamped/u3_m/sine/ramp_cycles=2", "/time/end_s=0.25"],
            &[1e-1],
        ),
    ];
    let mut tally = Tally::default();
    for (name, sets, accuracies) in scenes {
        let unreached = tally.judge(name, &load(name, sets), accuracies, Duration::from_secs(600));
        assert_eq!(unreached, usize::from(name == "wiring-2"), "{name}");
    }
    tally.assert();
}

/// Goal: the same over every shipped case at 10 %, 1 % and 0.1 %, as far as half a minute each goes; what is not reached must
/// be said. Takes an hour: `cargo test --release --test target -- --ignored --nocapture`.
#[test]
#[ignore = "an hour"]
fn estimates_are_honest_for_every_shipped_case() {
    let mut names: Vec<String> = std::fs::read_dir("cases")
        .expect("cases")
        .filter_map(|entry| {
            entry
                .ok()?
                .file_name()
                .to_str()?
                .strip_suffix(".json")
                .map(String::from)
        })
        .filter(|name| name != "schema")
        .collect();
    names.sort();
    let mut tally = Tally::default();
    let mut unreached = 0;
    for name in &names {
        unreached += tally.judge(name, &load(name, &[]), &[1e-1, 1e-2, 1e-3], Duration::from_secs(30));
    }
    println!("{unreached} of {} not reached, and said so", 3 * names.len());
    tally.assert();
}

/// Quantities, and how their estimates fared.
#[derive(Default)]
struct Tally {
    all: usize,
    held: usize,
    covered: usize,
    near: usize,
}

impl Tally {
    /// Reaches accuracies of a case, each within the time, and compares with a run on twice the finest mesh at a hundredth of
    /// the tightest tolerance, if there is time for that. Returns how many were not reached.
    fn judge(&mut self, name: &str, case: &Case, accuracies: &[f64], time: Duration) -> usize {
        let mut runs: Vec<(f64, Summary)> = vec![];
        for &asked in accuracies {
            let until = Instant::now() + time;
            let summary = reach(case, asked, until).summary;
            let accuracy = summary.accuracy.as_ref();
            let told = accuracy.map_or("nothing is known".into(), |a| {
                let work = |unknowns: usize, steps: u64| unknowns as f64 * steps as f64;
                let pilots: f64 = a.pilots.iter().map(|p| work(p.unknowns, p.steps)).sum();
                format!(
                    "{} with {} cells, rtol {:.0e}, {} pilots of {:.1} times its work, {}",
                    if a.reached { "reached" } else { "not reached" },
                    a.cells_per_segment,
                    a.rtol,
                    a.pilots.len(),
                    pilots / work(summary.unknowns, summary.solver.steps),
                    a.effects,
                )
            });
            println!("{name}, asked {asked}: {told}");
            if accuracy.is_some_and(|a| a.reached) {
                runs.push((asked, summary));
            } else {
                assert!(
                    summary.warnings.iter().any(|w| w.contains("accuracy")),
                    "{name}: silent"
                );
            }
        }
        let unreached = accuracies.len() - runs.len();
        let found = |s: &Summary| s.accuracy.clone().expect("reached");
        let finest = runs.iter().map(|r| found(&r.1).cells_per_segment).max().unwrap_or(1);
        let tightest = runs.iter().map(|r| found(&r.1).rtol).fold(1.0, f64::min);
        let reference = plan::refined(case, 2 * finest, (0.01 * tightest).max(1e-8));
        let reference = record(&reference, Instant::now() + 4 * time).summary;
        if reference.status != Status::Finished {
            println!("    no time for a reference");
            return unreached;
        }
        for (asked, summary) in &runs {
            let (accuracy, factors) = (found(summary), factors(case, summary));
            for (quantity, estimate) in &accuracy.quantities {
                let total = estimate.total.expect("reached, so known");
                let true_error = largest_error(quantity, summary, &reference) / factors[quantity.as_str()];
                println!("    {quantity} at {asked}: error {true_error:.1e}, estimate {total:.1e}");
                self.all += 1;
                self.held += usize::from(true_error <= *asked);
                self.covered += usize::from(true_error <= 3.0 * total + 1e-12);
                self.near += usize::from(
                    true_error <= 3.0 * total && 3.0 * true_error >= total || total.max(true_error) < 0.01 * asked,
                );
            }
        }
        unreached
    }

    fn assert(&self) {
        let Self {
            all,
            held,
            covered,
            near,
        } = self;
        println!(
            "{all} quantities: {held} held, {covered} not underestimated, {near} within a factor of 3 or a hundredth of what was asked"
        );
        assert!(20 * held >= 19 * all, "{held} of {all}");
        assert!(5 * covered >= 4 * all, "{covered} of {all}");
    }
}

/// Cells a segment of a reference: on many more round-off grows to what is asked.
const FINEST: usize = 32;

/// What random scenes came to.
#[derive(Default)]
struct Promises {
    asked: usize,
    reached: usize,
    kept: usize,
    quantities: usize,
    near: usize,
    broken: Vec<String>,
}

impl Promises {
    /// Asks for accuracies of a scene and compares what is reached with all effects on twice the finest mesh, by a method of
    /// order 5 at 1e-4 of the tightest tolerance (where a load of 16 waves leaves little of a motion a hundredth is not enough),
    /// extrapolated from that mesh and the one half as fine. Every second scene is on meshes of second order; of the others, whose
    /// order the program chooses, estimates are on the safe side, and it is not asked how near they are.
    fn ask(&mut self, number: u64, accuracies: &[f64], time: Duration) {
        let (kind, mut case) = scenes::scene(number);
        let sharp = number % 2 == 1;
        case.mesh.order = sharp.then_some(2);
        let mut runs: Vec<(f64, Summary)> = vec![];
        for &asked in accuracies {
            let until = Instant::now() + time;
            let summary = reach(&case, asked, until).summary;
            self.asked += 1;
            match &summary.accuracy {
                Some(found) if found.reached => runs.push((asked, summary)),
                _ => {
                    let said: Vec<_> = summary.warnings.iter().filter(|w| w.contains("accuracy")).collect();
                    println!("{number} {kind} at {asked}: not reached, {said:?}");
                    assert!(!said.is_empty(), "{number} {kind}: silent");
                }
            }
        }
        let found = |s: &Summary| s.accuracy.clone().expect("reached");
        let finest = runs
            .iter()
            .map(|r| found(&r.1).cells_per_segment)
            .max()
            .unwrap_or(1)
            .clamp(4, FINEST);
        let tightest = runs.iter().map(|r| found(&r.1).rtol).fold(1e-4, f64::min);
        let best = |cells: usize| {
            let mut case = plan::refined(&case, cells, (1e-4 * tightest).max(1e-9));
            (case.solver.method, case.effects) = (Method::Esdirk57, Effects::Full);
            let run = record(&case, Instant::now() + 4 * time).summary;
            (run.status == Status::Finished).then_some(run)
        };
        let (Some(coarse), Some(fine)) = (best(finest), best(2 * finest)) else {
            println!("{number} {kind}: no time for a reference");
            return;
        };
        for (asked, summary) in &runs {
            self.reached += 1;
            let (found, factors) = (found(summary), factors(&case, summary));
            let mut kept = true;
            for (name, estimate) in &found.quantities {
                let total = estimate.total.expect("reached, so known");
                assert!(
                    total <= *asked,
                    "{number} {kind}: {name} {total} is said to be within {asked}"
                );
                let error = beyond(name, summary, [&coarse, &fine]) / factors[name.as_str()];
                self.quantities += usize::from(sharp);
                let near = error <= 5.0 * total && total <= 5.0 * error || total.max(error) < 0.1 * asked;
                self.near += usize::from(near && sharp);
                if !near && sharp {
                    println!("{number} {kind} at {asked}: {name} off by {error:.1e}, estimate {total:.1e}");
                }
                if error > *asked {
                    kept = false;
                    let told = format!(
                        "{number} {kind} at {asked}: {name} off by {error:.1e}, estimate {estimate:?}, {}",
                        found.effects
                    );
                    println!("{told}");
                    self.broken.push(told);
                }
            }
            self.kept += usize::from(kept);
        }
    }

    fn told(&self) -> String {
        format!(
            "{} asked, {} reached, {} kept; {} of {} estimates within a factor of 5 or a tenth of what was asked",
            self.asked, self.reached, self.kept, self.near, self.quantities
        )
    }
}

/// Largest error of a quantity's figures against the limit to which two meshes point, relative to the largest of them.
fn beyond(name: &str, run: &Summary, [coarse, fine]: [&Summary; 2]) -> f64 {
    let of = |s: &Summary| figures(name, s);
    let limit = of(coarse).into_iter().zip(of(fine)).map(|(c, f)| f + (f - c) / 3.0);
    let limit: Vec<f64> = limit.collect();
    let size = limit.iter().fold(0.0_f64, |s, x| s.max(x.abs()));
    of(run)
        .iter()
        .zip(&limit)
        .fold(0.0_f64, |e, (x, y)| e.max((x - y).abs()))
        / size
}

/// A force of 1 N that ramps within 0.1 ms in a run of 2 s, for which the program leaves out inertia, as samples of the force do not show
/// it: the tip swings to twice the static deflection, 11.94 mm.
fn sudden() -> Case {
    let text = r#"{"name": "sudden", "beam": {"length_m": 0.2, "height_m": 0.01, "width_m": 0.02, "young_modulus_pa": 2.6e8,
        "density_kg_m3": 1100, "damping": {"bending_time_s": 1e-4, "axial_time_s": 1e-4}},
        "ends": {"root": "clamped", "tip": {"free": {"force_x_n": {"ramp": {"to": 1, "start_s": 0.61, "duration_s": 1e-4}}}}},
        "time": {"end_s": 2}}"#;
    let path = Path::new("sudden.json");
    let case = case::parse(text, path, path, &[]);
    case.unwrap_or_else(|error| panic!("{error}: {error:?}"))
}

/// Goal: a run whose companion shows that effects matter is repeated with them; the summary has the runs before, and why the effects are on.
/// Without losses of tubes the largest pressure is off by 2 %.
#[test]
fn a_run_is_repeated_with_effects_that_matter() {
    const PRESSURE: &str = "max_pressure_pa";
    let case = load("tour-wiring", &[]);
    let unrecorded = || Unrecorded(|_: &Progress| Control::Continue);
    let run = |case: &Case| companion::run(case, System::new(case)?, &[], &mut unrecorded());
    let first = run(&case).expect("memory");
    assert_eq!(first.summary.effects["tube_losses"].value, "off");
    let pressure = |summary: &Summary| summary.quantities[PRESSURE].max_abs.expect("known");
    let before = pressure(&first.summary);
    let mut runs = 0;
    let mut again = |case: &Case, annotate: Annotate| {
        runs += 1;
        let mut outcome = run(case)?;
        annotate(&mut outcome.summary);
        Ok(outcome)
    };
    let summary = target::effects::settle(&case, first, &mut again)
        .expect("memory")
        .summary;
    let full = load("tour-wiring", &[r#"/effects="full""#]);
    let full = pressure(&dynamics::run(&full, &mut unrecorded()).expect("memory").summary);
    let off = |pressure: f64| (pressure / full - 1.0).abs();
    assert!(
        off(before) > 0.01 && off(pressure(&summary)) < 1e-3,
        "{before} {full} {}",
        pressure(&summary)
    );
    let inertia = &summary.effects["tube_losses"];
    assert!(
        inertia.value == "on" && inertia.reason.starts_with("measured: without it "),
        "{inertia:?}"
    );
    let companion = summary.companion.expect("one that ran");
    assert!(
        (1..=2).contains(&runs) && companion.earlier_runs.len() == runs,
        "{runs}"
    );
    let earlier = &companion.earlier_runs[0];
    assert!(
        earlier.added_effects.contains(&"tube_losses".to_string()),
        "{earlier:?}"
    );
    assert_eq!(earlier.figures[PRESSURE]["max_abs"], before);
}

/// Goal: a search that begins where that of the same case ended takes one run, and the same figures.
#[test]
fn searches_share_what_they_found() {
    let case = load("bend-dry", &[]);
    let mut measured = |case: &Case, accuracy: &Accurate| {
        let mut unrecorded = Unrecorded(|_: &Progress| Control::Continue);
        companion::measured(case, System::new(case)?, accuracy, &mut unrecorded)
    };
    let first = target::reach(&case, 0.01, None, &mut measured).expect("memory").summary;
    let found = first.accuracy.expect("known");
    assert!(found.reached && !found.pilots.is_empty(), "{found:?}");
    let setting = target::ReachedSetting::found(&found);
    let again = target::reach(&case, 0.01, Some(&setting), &mut measured)
        .expect("memory")
        .summary;
    let accuracy = again.accuracy.expect("known");
    assert!(accuracy.reached && accuracy.pilots.is_empty(), "{accuracy:?}");
    assert_eq!(again.quantities, first.quantities);
}

/// Goal: a scene whose figures no affordable run has ends with an error bar for each of its figures, and names those that are not reached.
/// The paper's sudden start: `--accuracy 0.01` took a minute and a half of pilots, and then a run of minutes.
#[test]
fn a_sudden_start_has_an_answer_for_every_figure() {
    let case = load("wiring-3", &[]);
    let mut work = 0;
    let mut measured = |case: &Case, accuracy: &Accurate| {
        let mut unrecorded = Unrecorded(|_: &Progress| Control::Continue);
        let outcome = companion::measured(case, System::new(case)?, accuracy, &mut unrecorded)?;
        work += outcome.summary.solver.steps * outcome.summary.unknowns as u64;
        Ok(outcome)
    };
    let summary = target::reach(&case, 0.01, None, &mut measured).expect("memory").summary;
    let accuracy = summary.accuracy.as_ref().expect("known");
    let names = summary.quantities.keys().chain(summary.ports.keys());
    for name in names.filter(|name| *name != "efficiency") {
        assert!(summary.errors.contains_key(name), "{name}");
    }
    let short: Vec<&String> = accuracy
        .quantities
        .iter()
        .filter(|(_, e)| e.total.is_none_or(|total| total > 0.01))
        .map(|(name, _)| name)
        .collect();
    assert_eq!(accuracy.reached, short.is_empty());
    let told = summary.warnings.iter().find(|warning| warning.starts_with("W012"));
    for name in short {
        assert!(
            told.is_some_and(|told| told.contains(name.as_str())),
            "{name}: {told:?}"
        );
    }
    assert!(work < 8_000_000, "{work}");
}

/// Goal: a result to 1 % has the inertia that the program leaves out at first.
#[test]
fn effects_left_out_are_judged() {
    let case = sudden();
    let until = Instant::now() + Duration::from_secs(100);
    let summary = reach(&case, 0.01, until).summary;
    let largest = summary.quantities["tip_u1_m"].max_abs.expect("known");
    assert!((largest / 11.943e-3 - 1.0).abs() < 0.01, "{largest}");
    assert!(summary.accuracy.is_some_and(|a| a.reached), "{:?}", summary.warnings);
}

/// Goal: of random scenes with what few samples miss, at 10 % and 1 %, none that is said to be reached is not, and 90 % of the
/// estimates are within a factor of 5 of the error.
#[test]
fn promises_are_kept_in_random_scenes() {
    let mut promises = Promises::default();
    for number in 0..12 {
        promises.ask(number, &[1e-1, 1e-2], Duration::from_secs(60));
    }
    println!("{}", promises.told());
    assert_eq!(promises.kept, promises.reached, "{:#?}", promises.broken);
    assert!(10 * promises.near >= 9 * promises.quantities, "{}", promises.told());
    assert!(3 * promises.reached >= 2 * promises.asked, "{}", promises.told());
}

/// Goal: the same of 500, promises kept in 99 %. `SCENES=40..80` takes others: `cargo test --release --test target
/// promises_are_kept_in_500 -- --ignored --nocapture`.
#[test]
#[ignore = "an hour"]
fn promises_are_kept_in_500_random_scenes() {
    let asked = std::env::var("SCENES").ok();
    let range = asked.as_deref().and_then(|all| all.split_once(".."));
    let range = range.and_then(|(from, to)| Some(from.parse().ok()?..to.parse().ok()?));
    let mut promises = Promises::default();
    for number in range.unwrap_or(0..500) {
        promises.ask(number, &[1e-1, 1e-2], Duration::from_secs(60));
        println!("{number}: {}", promises.told());
    }
    assert!(100 * promises.kept >= 99 * promises.reached, "{:#?}", promises.broken);
    assert!(10 * promises.near >= 9 * promises.quantities, "{}", promises.told());
}
