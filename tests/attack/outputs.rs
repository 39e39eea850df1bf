//! Results that are damaged, or made to harm whoever reads them; outputs that never end.

use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use slcbeam::run::record::{Control, Header, Progress, Recorder};
use slcbeam::run::summary::Status;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use crate::program::{contents, run, same, slcbeam, stderr, unchanged};

/// Address space of a program under attack [KiB].
const MOST_MEMORY: u64 = 4 << 20;
/// Time that it has to answer.
const PATIENCE: Duration = Duration::from_secs(20);

/// The program with bounded memory and time.
fn bounded(arguments: &[&str]) -> Output {
    let mut child = Command::new("sh")
        .args(["-c", &format!("ulimit -v {MOST_MEMORY}; exec \"$0\" \"$@\"")])
        .arg(env!("CARGO_BIN_EXE_slcbeam"))
        .args(arguments)
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("it starts");
    let begin = Instant::now();
    while child.try_wait().expect("its state").is_none() {
        if begin.elapsed() > PATIENCE {
            child.kill().expect("it is killed");
            panic!("no answer within {PATIENCE:?}: {arguments:?}");
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    child.wait_with_output().expect("its end")
}

/// That it neither panicked nor was aborted; its exit code.
fn answered(output: &Output, what: &str) -> i32 {
    let told = stderr(output);
    let code = output.status.code();
    assert!(
        !told.contains("panicked") && code.is_some_and(|code| code < 100),
        "{what}: {code:?} {told}"
    );
    code.unwrap_or_default()
}

/// `export`, `report` and `compare` of a folder, beside a sound one; the codes of the three.
fn read_by_all(dir: &Path, sound: &Path, what: &str) -> [i32; 3] {
    let path = |p: &Path| p.display().to_string();
    let (dir, sound) = (path(dir), path(sound));
    let out = format!("{dir}-exported");
    let commands: [&[&str]; 3] = [
        &["export", &dir, "--out", &out],
        &["report", &dir],
        &["compare", &dir, &sound],
    ];
    commands.map(|command| answered(&bounded(command), what))
}

fn copied(from: &Path, to: &Path) {
    let _ = fs::remove_dir_all(to);
    fs::create_dir_all(to).expect("a folder");
    for (name, bytes) in contents(from) {
        fs::write(to.join(name), bytes).expect("a copy");
    }
}

/// An archive of arrays with any descriptions.
fn archive(path: &Path, entries: &[(&str, String, usize)]) {
    let mut npz = ZipWriter::new(fs::File::create(path).expect("a file"));
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    for (name, description, numbers) in entries {
        npz.start_file(*name, options).expect("an entry");
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((description.len() as u16).to_le_bytes());
        bytes.extend(description.as_bytes());
        bytes.extend((0..*numbers).flat_map(|k| (k as f64).to_le_bytes()));
        npz.write_all(&bytes).expect("it is written");
    }
    npz.finish().expect("its end");
}

fn described(shape: &str) -> String {
    format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}\n")
}

/// Arrays that say that they are larger than their file, are of other kinds, or would be written elsewhere.
#[test]
fn outputs_that_lie_about_their_size_are_refused() {
    let folder = tempfile::tempdir().expect("a place");
    let (sound, bad) = (folder.path().join("sound"), folder.path().join("bad"));
    assert!(run(&sound, &[]).status.success());
    let times = described("(11,)");
    let nested = format!(
        "{{'descr': {}, 'fortran_order': False, 'shape': (11,), }}",
        "(".repeat(60_000)
    );
    let lies: [(&str, Vec<(&str, String, usize)>); 9] = [
        (
            "24 GB of times",
            vec![("t_fields_s.npy", described("(3000000000,)"), 11)],
        ),
        (
            "a product beyond 64 bits",
            vec![
                ("t_fields_s.npy", times.clone(), 11),
                ("u1_m.npy", described("(4294967296, 4294967296)"), 11),
            ],
        ),
        (
            "34 GB of places",
            vec![
                ("t_fields_s.npy", times.clone(), 11),
                ("u1_m.npy", described("(11, 400000000)"), 11),
            ],
        ),
        (
            "endless places of no instant",
            vec![
                ("t_fields_s.npy", described("(0,)"), 0),
                ("u1_m.npy", described("(0, 9223372036854775807)"), 0),
            ],
        ),
        (
            "fewer instants than times",
            vec![
                ("t_fields_s.npy", times.clone(), 11),
                ("theta_node_m.npy", described("(5,)"), 5),
                ("u1_m.npy", described("(2, 5)"), 10),
            ],
        ),
        (
            "columns first",
            vec![("t_fields_s.npy", described("(11,)").replace("False", "True"), 11)],
        ),
        ("brackets in brackets", vec![("t_fields_s.npy", nested.clone(), 11)]),
        (
            "a name that leads elsewhere",
            vec![
                ("t_fields_s.npy", times.clone(), 11),
                ("../../u1_m.npy", described("(11, 1)"), 11),
            ],
        ),
        ("no arrays but times", vec![("t_fields_s.npy", times.clone(), 11)]),
    ];
    for (what, entries) in &lies {
        copied(&sound, &bad);
        archive(&bad.join("fields.npz"), entries);
        let [export, _, compare] = read_by_all(&bad, &sound, what);
        assert_eq!(export, 5, "{what}");
        assert!(compare == 5 || *what == "no arrays but times", "{what}: {compare}");
        let told = stderr(&bounded(&["export", &bad.display().to_string()]));
        assert!(told.contains("E050") && told.contains("fields.npz"), "{what}: {told}");
    }
}

/// Entries that lie over each other make a small file endless.
#[test]
fn outputs_that_lie_over_each_other_are_refused() {
    let folder = tempfile::tempdir().expect("a place");
    let (sound, bad) = (folder.path().join("sound"), folder.path().join("bad"));
    assert!(run(&sound, &[]).status.success());
    copied(&sound, &bad);
    let path = bad.join("fields.npz");
    let count = 400;
    archive(&path, &[("t_fields_s.npy", described("(200000,)"), 200_000)]);
    // one entry, and a directory that names it many times
    let bytes = fs::read(&path).expect("a file");
    let start = bytes.windows(4).rposition(|w| w == b"PK\x01\x02").expect("a directory");
    let end = bytes.windows(4).rposition(|w| w == b"PK\x05\x06").expect("an end");
    let entry = &bytes[start..end];
    let at = entry.windows(10).position(|w| w == b"t_fields_s").expect("a name");
    let mut all = bytes[..start].to_vec();
    for k in 0..count {
        let mut one = entry.to_vec();
        one[at..at + 10].copy_from_slice(format!("a{k:09}").as_bytes());
        all.extend(one);
    }
    let mut last = bytes[end..].to_vec();
    last[8..10].copy_from_slice(&(count as u16).to_le_bytes());
    last[10..12].copy_from_slice(&(count as u16).to_le_bytes());
    last[12..16].copy_from_slice(&((count * entry.len()) as u32).to_le_bytes());
    all.extend(last);
    fs::write(&path, all).expect("it is changed");
    let begin = Instant::now();
    let [export, _, compare] = read_by_all(&bad, &sound, "overlapping");
    assert_eq!([export, compare], [5, 5]);
    assert!(begin.elapsed() < Duration::from_secs(10), "{:?}", begin.elapsed());
}

/// A number that has changed in the arrays is not taken for a result.
#[test]
fn outputs_that_changed_are_refused() {
    let folder = tempfile::tempdir().expect("a place");
    let (sound, bad) = (folder.path().join("sound"), folder.path().join("bad"));
    assert!(run(&sound, &[]).status.success());
    copied(&sound, &bad);
    let mut bytes = fs::read(bad.join("fields.npz")).expect("a file");
    let name = b"u1_m.npy";
    let begin = bytes
        .windows(name.len())
        .position(|w| w == name)
        .expect("displacements");
    bytes[begin + 600] ^= 64;
    fs::write(bad.join("fields.npz"), bytes).expect("it is changed");
    let [export, report, compare] = read_by_all(&bad, &sound, "one bit");
    assert_eq!([export, report, compare], [5, 0, 5]);
    let page = fs::read_to_string(bad.join("report.html")).expect("a page");
    assert!(page.contains("fields.npz cannot be read"), "the page says so");
}

/// What is no file has no end.
#[test]
fn outputs_without_an_end_are_refused() {
    let folder = tempfile::tempdir().expect("a place");
    let (sound, bad) = (folder.path().join("sound"), folder.path().join("bad"));
    assert!(run(&sound, &[]).status.success());
    for name in ["fields.npz", "history.csv", "summary.json", "history.svg"] {
        for endless in ["/dev/zero", "fifo"] {
            copied(&sound, &bad);
            fs::remove_file(bad.join(name)).expect("it goes");
            if endless == "fifo" {
                let made = Command::new("mkfifo").arg(bad.join(name)).status().expect("it starts");
                assert!(made.success());
            } else {
                std::os::unix::fs::symlink(endless, bad.join(name)).expect("a link");
            }
            read_by_all(&bad, &sound, &format!("{name} is {endless}"));
        }
    }
}

/// A generator of numbers that is the same everywhere (splitmix64).
struct Dice(u64);

impl Dice {
    fn roll(&mut self, sides: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) % sides.max(1) as u64) as usize
    }
}

/// Flips, cuts, overwrites or repeats some bytes.
fn mutate(bytes: &mut Vec<u8>, dice: &mut Dice) {
    let at = dice.roll(bytes.len());
    match dice.roll(5) {
        0 => bytes[at] ^= 1 << dice.roll(8),
        1 => bytes.truncate(at),
        2 => {
            let end = (at + 1 + dice.roll(16)).min(bytes.len());
            let with = [0, 255, 127, b'9'][dice.roll(4)];
            bytes[at..end].fill(with);
        }
        3 => {
            // in a description or in the directory
            let marks = [&b"shape"[..], b"NUMPY", b"PK\x01\x02", b"PK\x03\x04", b"PK\x05\x06"];
            let mark = marks[dice.roll(marks.len())];
            let places: Vec<usize> = bytes
                .windows(mark.len())
                .enumerate()
                .filter(|w| w.1 == mark)
                .map(|w| w.0)
                .collect();
            let begin = places.get(dice.roll(places.len())).copied().unwrap_or(at);
            let at = (begin + dice.roll(48)).min(bytes.len() - 1);
            bytes[at] = [0, 255, b'9', dice.roll(256) as u8][dice.roll(4)];
        }
        _ => {
            let end = (at + dice.roll(400)).min(bytes.len());
            let again = bytes[at..end].to_vec();
            bytes.splice(at..at, again);
        }
    }
}

/// Damages one file a trial and reads the folder by all commands that read folders.
fn fuzz(trials: u64) {
    let folder = tempfile::tempdir().expect("a place");
    let (sound, modes, bad) = (
        folder.path().join("sound"),
        folder.path().join("modes"),
        folder.path().join("bad"),
    );
    assert!(run(&sound, &[]).status.success());
    let found = slcbeam()
        .args([
            "modes",
            crate::program::CASE,
            "--quiet",
            "--set",
            "/mesh/cells_per_segment=1",
            "--out",
        ])
        .arg(&modes)
        .output()
        .expect("it starts");
    assert!(found.status.success(), "{}", stderr(&found));
    let (mut refused, mut taken) = (0, 0);
    for trial in 0..trials {
        let mut dice = Dice(trial);
        let of_modes = trial % 5 == 4;
        let (from, names): (_, &[&str]) = if of_modes {
            (
                &modes,
                &["modes.npz", "modes.npz", "modes.json", "modes.csv", "case.json"],
            )
        } else {
            (
                &sound,
                &[
                    "fields.npz",
                    "fields.npz",
                    "fields.npz",
                    "history.csv",
                    "summary.json",
                    "case.json",
                ],
            )
        };
        copied(from, &bad);
        let path = bad.join(names[dice.roll(names.len())]);
        let mut bytes = fs::read(&path).expect("a file");
        for _ in 0..=dice.roll(3) {
            if !bytes.is_empty() {
                mutate(&mut bytes, &mut dice);
            }
        }
        fs::write(&path, bytes).expect("it is changed");
        let what = format!("trial {trial}, {}", path.display());
        let codes = if of_modes {
            vec![answered(&bounded(&["report", &bad.display().to_string()]), &what)]
        } else {
            read_by_all(&bad, &sound, &what).to_vec()
        };
        refused += codes.iter().filter(|code| **code != 0).count();
        taken += codes.iter().filter(|code| **code == 0).count();
    }
    println!("{trials} damaged results: {refused} times refused, {taken} times read, 0 panics, 0 hangs");
}

#[test]
fn damaged_outputs_are_refused_or_read() {
    fuzz(40);
}

#[test]
#[ignore = "a minute"]
fn a_thousand_damaged_outputs_are_refused_or_read() {
    fuzz(1000);
}

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
    let case = slcbeam::case::load(Path::new(crate::program::CASE), &sets.map(String::from));
    let mut slow = Slow::default();
    let outcome = slcbeam::run::dynamics::run(&case.expect("a case").case, &mut slow).expect("a run");
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
    let mut child = slcbeam()
        .args(crate::program::arguments())
        .args(more)
        .arg("--out")
        .arg(out)
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::null())
        .spawn()
        .expect("it starts");
    let checkpoint = (t / 0.01).floor() * 0.01;
    let there = || {
        let text = fs::read_to_string(out.join("checkpoint.json")).unwrap_or_default();
        let at = text
            .split("\"t\":")
            .nth(1)
            .and_then(|rest| rest.split(',').next()?.parse::<f64>().ok());
        at.is_some_and(|at| at > checkpoint - 1e-9)
    };
    while !there() && child.try_wait().expect("its state").is_none() {
        std::thread::sleep(Duration::from_micros(200));
    }
    child.kill().expect("it is killed");
    child.wait().expect("it ends");
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
        let compared = bounded(&["compare", &both[0], &both[1], "--json"]);
        assert_eq!(answered(&compared, "compare"), 0);
        fs::remove_dir_all(&out).expect("it goes");
        fs::remove_dir_all(&killed).expect("it goes");
    }
}
