//! Runs with a budget, checks of every sound run, and the printed lines.

use std::path::Path;
use std::time::{Duration, Instant};

use slcbeam::case::{self, Case};
use slcbeam::error::{Result, SolverError};
use slcbeam::run::dynamics;
use slcbeam::run::record::{Control, Header, Memory, Progress, Recorder};
use slcbeam::run::summary::{Status, Summary};

/// Reason of a run that stopped because its budget was used up, not because of a failure.
pub const BUDGET: &str = "budget";

/// The published coupling of the paper.
pub const PUBLISHED: &str =
    r#"/bladders/coupling={"published": {"slope_per_pressure_rad": 0.00381467, "length_per_pressure_m": 0.01}}"#;

/// Creeping flow in tubes.
pub const CREEPING: &str = r#"/effects={"tube_inertia":"off","tube_losses":"off"}"#;

/// Every formulation with every coupling, with a name.
pub const COMBINATIONS: [(&str, [&str; 2]); 4] = [
    (
        "conservative, reciprocal",
        [r#"/formulation="conservative""#, r#"/bladders/coupling="reciprocal""#],
    ),
    ("conservative, published", [r#"/formulation="conservative""#, PUBLISHED]),
    (
        "published, reciprocal",
        [r#"/formulation="published""#, r#"/bladders/coupling="reciprocal""#],
    ),
    ("published, published", [r#"/formulation="published""#, PUBLISHED]),
];

/// Errors of single steps, each below rtol of the scales, add up over the characteristic times of a run. No hard case needs more than 1000
/// of them, so that the energy balance closes within `1000 rtol` of the largest energy.
pub const ENERGY_PER_RTOL: f64 = 1000.0;

/// Closed networks lose volume only by rounding errors: 1e-16 per step, random, over at most 10^6 steps, with a margin.
pub const VOLUME: f64 = 1e-12;

/// Rounding errors of flows between nearly equal pressures: 1e-16 times step over time constant, here up to 10^7, random, in each of some
/// thousand steps.
pub const STIFF_VOLUME: f64 = 3e-8;

/// Recorder that keeps everything in memory and stops when the steps or the time are used up.
pub struct Budget {
    /// The recorded data.
    pub memory: Memory,
    steps: u64,
    until: Instant,
}

impl Budget {
    /// Steps and seconds allowed.
    pub fn new(steps: u64, seconds: f64) -> Self {
        Self {
            memory: Memory::default(),
            steps,
            until: Instant::now() + Duration::from_secs_f64(seconds),
        }
    }
}

impl Recorder for Budget {
    fn begin(&mut self, header: &Header) -> Result<()> {
        self.memory.begin(header)
    }
    fn history(&mut self, row: &[f64]) -> Result<()> {
        self.memory.history(row)
    }
    fn fields(&mut self, t: f64, arrays: &[&[f64]]) -> Result<()> {
        self.memory.fields(t, arrays)
    }
    fn progress(&mut self, progress: &Progress) -> Result<Control> {
        let used_up =
            progress.steps >= self.steps || (progress.steps.is_multiple_of(64) && Instant::now() > self.until);
        Ok(if used_up {
            Control::Stop(BUDGET.into())
        } else {
            Control::Continue
        })
    }
}

/// A run, however it ended.
pub struct Ran {
    /// File and settings, for messages.
    pub name: String,
    /// Tolerance of the case.
    pub rtol: f64,
    /// Summary.
    pub summary: Summary,
    /// Fault of the solver.
    pub fault: Option<SolverError>,
    /// The recorded data.
    pub record: Memory,
}

/// A case of `cases/hard` (or of `cases`, as `../name`) with settings.
pub fn case(file: &str, sets: &[&str]) -> Case {
    let sets: Vec<String> = sets.iter().map(|s| s.to_string()).collect();
    let path = format!("cases/hard/{file}.json");
    match case::load(Path::new(&path), &sets) {
        Ok(case) => case,
        Err(slcbeam::error::Error::Case(fault)) => panic!("{}", case::render(&fault, false, 100)),
        Err(other) => panic!("{path}: {other}"),
    }
}

/// Runs a hard case with settings; more than three million steps or a minute are a failure of the suite.
pub fn run(file: &str, sets: &[&str]) -> Ran {
    let case = case(file, sets);
    let mut recorder = Budget::new(3_000_000, 60.0);
    let outcome = dynamics::run(&case, &mut recorder).expect("a recorder in memory does not fail");
    let name = format!("{file} {}", sets.join(" "));
    Ran {
        name,
        rtol: case.solver.rtol,
        summary: outcome.summary,
        fault: outcome.fault,
        record: recorder.memory,
    }
}

impl Ran {
    /// Asserts that the run finished with finite numbers and closed balances.
    pub fn sound(self) -> Self {
        self.sound_with(ENERGY_PER_RTOL, VOLUME)
    }

    /// Like [`Ran::sound`], with other bounds on the energy residual, in units of rtol, and on the volume loss of closed networks.
    pub fn sound_with(self, energy_per_rtol: f64, closed_volume: f64) -> Self {
        let (s, b) = (&self.summary, &self.summary.balances);
        assert_eq!(s.status, Status::Finished, "{}: {:?}", self.name, s.reason);
        assert!(
            self.record.rows.iter().flatten().all(|v| v.is_finite()),
            "{}: numbers not finite",
            self.name
        );
        let energy = b.energy_residual_relative;
        assert!(
            energy <= energy_per_rtol * self.rtol,
            "{}: energy residual {energy:.1e}",
            self.name
        );
        let volume = b.closed_volume_residual_relative;
        assert!(
            volume <= closed_volume,
            "{}: closed volume residual {volume:.1e}",
            self.name
        );
        self
    }

    /// Asserts a number of steps within a band around the value measured when the suite was written.
    pub fn steps_within(self, low: u64, high: u64) -> Self {
        let steps = self.steps();
        assert!(
            (low..=high).contains(&steps),
            "{}: {steps} steps, expected {low} to {high}",
            self.name
        );
        self
    }

    /// Prints the line of this run.
    pub fn line(self, figures: &str) -> Self {
        let b = &self.summary.balances;
        println!(
            "{} | {} steps | energy {:.1e} | closed volume {:.1e} | {figures}",
            self.name.trim(),
            self.steps(),
            b.energy_residual_relative,
            b.closed_volume_residual_relative
        );
        self
    }

    /// Accepted steps.
    pub fn steps(&self) -> u64 {
        self.summary.solver.steps
    }

    /// A column of the history.
    pub fn column(&self, name: &str) -> Vec<f64> {
        self.record
            .column(name)
            .unwrap_or_else(|| panic!("{}: no column {name}", self.name))
    }

    /// Largest absolute value of a column.
    pub fn largest(&self, name: &str) -> f64 {
        self.column(name).iter().fold(0.0, |m: f64, v| m.max(v.abs()))
    }

    /// Last value of a column.
    pub fn last(&self, name: &str) -> f64 {
        *self.column(name).last().expect("a run has at least one row")
    }
}

/// Largest difference of a column between two runs with the same output times, relative to its largest value.
pub fn distance(a: &Ran, b: &Ran, column: &str) -> f64 {
    let (x, y) = (a.column(column), b.column(column));
    assert_eq!(x.len(), y.len(), "{} and {}", a.name, b.name);
    let size = a.largest(column).max(b.largest(column)).max(f64::MIN_POSITIVE);
    x.iter().zip(&y).fold(0.0_f64, |m, (x, y)| m.max((x - y).abs())) / size
}

/// `|value/reference - 1|`.
pub fn off(value: f64, reference: f64) -> f64 {
    (value / reference - 1.0).abs()
}
