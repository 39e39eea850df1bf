//! Outputs on their way: stopped within a step, left out before the window, differentiated and gone on with.

use std::fs;
use std::path::Path;
use std::time::Duration;

use slcbeam::run::record::{Control, Header, Progress, Recorder};
use slcbeam::run::summary::Status;

use super::{answered, told};
use crate::program::{CASE, contents, kill, run, same, slcbeam, start, stderr, unchanged, wait};

/// Takes its time for every row, and stops the run as soon as it is asked between two rows of one step.
#[derive(Default)]
struct Slow {
    within: Option<f64>,
    times: Vec<f64>,
}

impl Recorder for Slow {
    fn begin(&mut self, _: &Header) -> slcbeam::error::Result<()> {
        Ok(())
    }
    fn history(&mut self, row: &[f64]) -> slcbeam::error::Result<()> {
        std::thread::sleep(Duration::from_micros(200));
        self.times.push(row[0]);
        Ok(())
    }
    fn fields(&mut self, _: f64, _: &[&[f64]]) -> slcbeam::error::Result<()> {
        Ok(())
    }
    fn progress(&mut self, progress: &Progress) -> slcbeam::error::Result<Control> {
        // where a row was taken, and not at the end of a step
        if self.times.last() == Some(&progress.t) && progress.t > 0.0 && progress.t < 0.9 * progress.end {
            self.within = Some(progress.t);
            return Ok(Control::Stop("asked within a step".into()));
        }
        Ok(Control::Continue)
    }
}

/// However many samples a step has, whoever records it is asked in between whether to go on; what was taken until then stands.
#[test]
fn outputs_within_one_step_can_be_stopped() {
    let sets = [
        "/time/end_s=0.05",
        "/time/window_s=0.02",
        "/time/output_interval_s=1e-7",
        "/solver/rtol=1e-3",
    ];
    let case = slcbeam::case::load(Path::new(CASE), &sets.map(String::from));
    let mut slow = Slow::default();
    let outcome = slcbeam::run::dynamics::run(&case.expect("a case"), &mut slow).expect("a run");
    assert_eq!(outcome.summary.status, Status::Stopped);
    assert_eq!(outcome.summary.reason.as_deref(), Some("asked within a step"));
    let last = slow.times.last().copied();
    assert_eq!(last, slow.within, "asked where the last row was taken");
    assert_eq!(Some(outcome.summary.time_s), last, "the summary says how far it came");
}

/// The search for the start's equilibrium looks at the clock, too.
#[test]
fn outputs_of_a_search_that_is_stopped_say_so() {
    let folder = tempfile::tempdir().expect("a place");
    let out = folder.path().join("x");
    let output = run(
        &out,
        &[
            "--set",
            "/start={\"equilibrium\": {\"loads_at_s\": 0.05}}",
            "--max-wall",
            "1e-6",
        ],
    );
    assert!(output.status.success(), "{}", stderr(&output));
    let summary = fs::read_to_string(out.join("summary.json")).expect("a summary");
    assert!(
        summary.contains("in search of the equilibrium to start from"),
        "{summary}"
    );
}

/// A differentiated run that was killed goes on with its derivatives.
#[test]
fn outputs_of_derivatives_go_on() {
    let folder = tempfile::tempdir().expect("a place");
    let (whole, out) = (folder.path().join("whole"), folder.path().join("x"));
    let steep =
        r#"/loads=[{"force_x_n_m": {"signal": {"ramp": {"from": 0, "to": 1, "start_s": 0.02, "duration_s": 0.015}}}}]"#;
    let asked = [
        "--set",
        steep,
        "--sensitivity",
        "/fluid/viscosity_pa_s",
        "--sensitivity",
        "/beam/young_modulus_pa",
    ];
    let output = run(&whole, &asked);
    assert!(output.status.success(), "{}", stderr(&output));
    for limit in ["0.012", "0.02", "0.033", "0.041"] {
        stopped_after(&out, &asked, limit.parse().expect("a number"));
        let before = contents(&out);
        let refused = run(
            &out,
            &["--set", steep, "--resume", "--sensitivity", "/beam/density_kg_m3"],
        );
        assert_eq!(refused.status.code(), Some(2), "{}", stderr(&refused));
        unchanged(&out, &before, "refused");
        let output = run(&out, &["--set", steep, "--resume"]);
        assert!(output.status.success(), "{}", stderr(&output));
        same(&whole, &out).expect("the same end");
        let rows = |dir: &Path| fs::read(dir.join("sensitivities.csv")).expect("derivatives");
        assert!(
            rows(&whole) == rows(&out),
            "stopped after {limit} s: derivatives differ"
        );
        fs::remove_dir_all(&out).expect("it goes");
    }
}

/// A run that is killed once its history has come to a time [s].
fn stopped_after(out: &Path, more: &[&str], t: f64) {
    let mut child = start(out, more);
    let checkpoint = (t / 0.01).floor() * 0.01;
    let there = || {
        let text = fs::read_to_string(out.join("checkpoint.json")).unwrap_or_default();
        let at = text
            .split("\"t\":")
            .nth(1)
            .and_then(|rest| rest.split(',').next()?.parse::<f64>().ok());
        at.is_some_and(|at| at > checkpoint - 1e-9)
    };
    wait(&mut child, there);
    kill(&mut child);
    assert!(out.join("checkpoint.json").exists(), "the run is too fast to be killed");
}

/// Settings of a run whose history has the window alone, or every so manyth row before it.
const THINNED: [&str; 2] = ["/time/history=\"window\"", "/time/history={\"every\": 7}"];

/// A history of the window alone has what the whole one has there; the envelope holds all that it leaves out; a killed run goes on to
/// the same files.
#[test]
fn outputs_before_the_window_are_left_to_their_envelope() {
    let folder = tempfile::tempdir().expect("a place");
    let all = folder.path().join("all");
    assert!(run(&all, &[]).status.success());
    let table = |path: std::path::PathBuf| -> Vec<Vec<f64>> {
        let text = fs::read_to_string(&path).expect("a table");
        let rows = text.lines().skip(1);
        rows.map(|row| row.split(',').map(|x| x.parse().expect("a number")).collect())
            .collect()
    };
    let whole = table(all.join("history.csv"));
    for (thinned, every) in THINNED.into_iter().zip([usize::MAX, 7]) {
        let (out, killed) = (folder.path().join("thinned"), folder.path().join("killed"));
        let output = run(&out, &["--set", thinned]);
        assert!(output.status.success(), "{}", stderr(&output));
        let expected: Vec<_> = whole
            .iter()
            .enumerate()
            .filter(|(k, row)| k % every == 0 || row[0] > 0.03 - 1e-9)
            .map(|(_, row)| row.clone())
            .collect();
        let history = table(out.join("history.csv"));
        assert!(history.len() < whole.len() && history == expected, "{thinned}");
        let envelope = table(out.join("envelope.csv"));
        let outside: Vec<_> = whole.iter().filter(|row| row[0] < 0.03 - 1e-9).collect();
        assert_eq!(envelope.iter().map(|row| row[2]).sum::<f64>(), outside.len() as f64);
        let mut seen = 0;
        for stretch in &envelope {
            let rows: Vec<_> = outside
                .iter()
                .filter(|row| (stretch[0]..=stretch[1]).contains(&row[0]))
                .collect();
            assert_eq!(rows.len() as f64, stretch[2]);
            for k in 1..whole[0].len() {
                let values = rows.iter().map(|row| row[k]);
                let of = &stretch[3 * k..3 * k + 3];
                assert_eq!(of[0], values.clone().fold(f64::INFINITY, f64::min));
                assert_eq!(of[1], values.clone().fold(f64::NEG_INFINITY, f64::max));
                let mean = values.sum::<f64>() / rows.len() as f64;
                assert!(
                    (of[2] - mean).abs() <= 1e-12 * of[0].abs().max(of[1].abs()),
                    "{} {mean}",
                    of[2]
                );
            }
            seen += rows.len();
        }
        assert_eq!(seen, outside.len());
        stopped_after(&killed, &["--set", thinned], 0.02);
        let output = run(&killed, &["--resume", "--set", thinned]);
        assert!(output.status.success(), "{}", stderr(&output));
        same(&out, &killed).expect("the same end");
        assert!(fs::read(out.join("envelope.csv")).ok() == fs::read(killed.join("envelope.csv")).ok());
        let page = fs::read_to_string(out.join("report.html")).expect("a page");
        assert!(page.contains("of every stretch of envelope.csv"), "the page says so");
        let both = [out.display().to_string(), all.display().to_string()];
        let compared = told(&["compare", &both[0], &both[1], "--json"]);
        assert_eq!(answered(&compared, "compare"), 0);
        fs::remove_dir_all(&out).expect("it goes");
        fs::remove_dir_all(&killed).expect("it goes");
    }
}

/// Ten thousand cycles in less than 10 MB.
#[test]
#[ignore = "ten seconds"]
fn outputs_of_ten_thousand_cycles_are_small() {
    let folder = tempfile::tempdir().expect("a place");
    let out = folder.path().join("x");
    let mut program = slcbeam();
    program
        .args(["run", "cases/bend-dry.json", "--quiet", "--out"])
        .arg(&out);
    for set in [
        r#"/loads=[{"force_x_n_m": {"signal": {"sine": {"amplitude": 0.001, "frequency_hz": 18}}}}]"#,
        "/mesh/cells_per_segment=1",
        "/mesh/segments=2",
        "/solver/rtol=1e-2",
        "/solver/max_steps=100000000",
        "/time/end_s=555.6",
        "/time/output_interval_s=0.001111",
        "/time/window_s=1",
        "/time/history=\"window\"",
    ] {
        program.args(["--set", set]);
    }
    let output = program.output().expect("it starts");
    assert!(output.status.success(), "{}", stderr(&output));
    let all = contents(&out);
    let size: usize = all.iter().map(|file| file.1.len()).sum();
    println!("10 000 cycles of 50 outputs: {size} bytes");
    assert!(size < 10_000_000, "{size}");
    let rows = fs::read_to_string(out.join("envelope.csv"))
        .expect("an envelope")
        .lines()
        .count();
    assert!((1000..=2001).contains(&rows), "{rows}");
}
