//! Searches that are killed among their evaluations and resumed by the same command; commands that the clock ends.

use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

use serde_json::Value;
use slcbeam::case;
use slcbeam::output::ResultFolder;
use slcbeam::output::evaluations::{self as files, EVALUATIONS};
use slcbeam::output::kind::FolderKind;
use slcbeam::study::evaluations::Evaluations;
use tempfile::TempDir;

use crate::chance::Random;
use crate::program::{command, say};

/// Rows after which a search is killed.
const ROWS: usize = 4;

const SMALL: &str = "cases/two-bladders.json --set /time/end_s=0.005 --set /mesh/cells_per_segment=4";
const WIRED: &str =
    "cases/wiring-2.json --set /time/end_s=0.1 --set /mesh/cells_per_segment=1 --set /mesh/cells_per_bladder=1";
const SHAKEN: &str = "cases/valves-open.json --set /mesh/cells_per_segment=1";
const MODULUS: &str = "/beam/young_modulus_pa=1e6:4e6";

fn describe(text: &str) -> Vec<&str> {
    text.split_whitespace().collect()
}

/// A result without what a clock measured: wall times, and what is concluded from them.
fn timeless(value: &mut Value) {
    const MEASURED: [&str; 13] = [
        "wall_s",
        "walls_s",
        "wall_min_s",
        "wall_median_s",
        "wall",
        "cost",
        "spent",
        "spent_s",
        "front",
        "on_front",
        "answers",
        "feet",
        "balances",
    ];
    match value {
        Value::Object(entries) => {
            entries.retain(|key, _| !MEASURED.contains(&key.as_str()) && key != "sentence");
            entries.values_mut().for_each(timeless);
        }
        Value::Array(entries) => entries.iter_mut().for_each(timeless),
        _ => {}
    }
}

fn result(dir: &Path, name: &str) -> Value {
    let text = fs::read_to_string(dir.join(name)).expect("a result");
    let mut value = serde_json::from_str(&text).expect("JSON");
    timeless(&mut value);
    value
}

/// Kills a search once its journal has some rows, and resumes it by the same command: it reads these rows, computes fewer evaluations than
/// there are, ends with the answer of an undisturbed search, and leaves no journal.
fn killed_and_resumed(asked: &str, file: &str) {
    let dir = TempDir::new().expect("a folder");
    let [whole, out] = ["whole", "killed"].map(|name| dir.path().join(name));
    let all = |out: &Path| {
        let mut all: Vec<String> = describe(asked).into_iter().map(String::from).collect();
        all.extend(["--quiet".into(), "--out".into(), out.display().to_string()]);
        all
    };
    let ended = |out: &Path| {
        let all = all(out);
        let said = say(&all.iter().map(String::as_str).collect::<Vec<_>>());
        assert_eq!(said.code, 0, "{}\n{}", said.out, said.err);
        assert!(!out.join(EVALUATIONS).exists(), "a complete search keeps a journal");
        said.err
    };
    let told = ended(&whole);
    assert!(!told.contains("resumed"), "{told}");
    let journal = out.join(EVALUATIONS);
    // a row counts once its line is complete
    let rows = || fs::read_to_string(&journal).map_or(0, |text| text.matches('\n').count());
    let all_words = all(&out);
    let mut child = command(&all_words.iter().map(String::as_str).collect::<Vec<_>>())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("a program");
    let begun = Instant::now();
    while rows() < ROWS && child.try_wait().expect("a child").is_none() {
        assert!(begun.elapsed() < Duration::from_secs(120), "{} rows", rows());
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().expect("killed");
    child.wait().expect("ended");
    let kept = rows();
    assert!(kept >= ROWS, "it ended with {kept} rows");
    let told = ended(&out);
    let counts: Vec<usize> = told
        .lines()
        .find_map(|line| line.split_once("resumed: "))
        .unwrap_or_else(|| panic!("not resumed: {told}"))
        .1
        .split(' ')
        .filter_map(|word| word.parse().ok())
        .collect();
    assert!(counts[0] >= ROWS && counts[1] > counts[0], "{told}");
    assert_eq!(result(&out, file), result(&whole, file), "{asked}");
}

/// A journal with a byte changed or lost: its bytes, the number of lines that are as they were, and the place of the change.
pub fn changed(sound: &[u8], random: &mut Random) -> (Vec<u8>, usize, usize) {
    let mut bytes = sound.to_vec();
    let at = random.below(bytes.len() - 1);
    match random.below(3) {
        0 => bytes[at] ^= 1 << random.below(8),
        1 => bytes[at] = if bytes[at] == b'7' { b'8' } else { b'7' },
        _ => drop(bytes.remove(at)),
    }
    let sound: Vec<&[u8]> = sound.split(|b| *b == b'\n').collect();
    let lines = bytes.split(|b| *b == b'\n').filter(|line| !line.is_empty());
    let same = lines.filter(|line| sound.contains(line)).count();
    (bytes, same, at)
}

#[test]
fn a_killed_optimization_goes_on() {
    let asked = format!("optimize {SMALL} --vary {MODULUS} --minimize tip_u1_m.max_abs --starts 6 --jobs 1");
    killed_and_resumed(&asked, "optimum.json");
}

#[test]
fn a_killed_fit_goes_on() {
    let dir = TempDir::new().expect("a folder");
    let data = dir.path().join("data.csv");
    let rows = (1..20).map(|k| format!("{},{}\n", 0.00025 * f64::from(k), 0.001 * f64::from(k)));
    fs::write(&data, format!("t_s,tip_mm\n{}", rows.collect::<String>())).expect("written");
    let asked = format!(
        "fit {} {} --vary {MODULUS} --match tip_mm=tip_u1 --starts 8 --jobs 1",
        SMALL.replace("segment=4", "segment=16"),
        data.display()
    );
    killed_and_resumed(&asked, "fit.json");
}

#[test]
fn killed_cycles_along_a_parameter_go_on() {
    let asked = format!("periodic {SHAKEN} --sweep /network/permeability_factor=0.01:1:12:log");
    killed_and_resumed(&asked, "sweep.json");
}

#[test]
fn a_killed_map_goes_on() {
    for command in ["floquet", "modes"] {
        let asked = format!("{command} {SHAKEN} --map frequency,amplitude --points 3,4 --permeability 1");
        killed_and_resumed(&asked, "map.json");
    }
}

#[test]
fn a_killed_study_goes_on() {
    let asked =
        format!("study {WIRED} --repeats 1 --budget 300s --rtol 1e-3,1e-4 --cells 1,2 --methods ida --orders 2,5");
    killed_and_resumed(&asked, "study.json");
}

#[test]
fn killed_effects_go_on() {
    killed_and_resumed(&format!("effects {WIRED} --repeats 0 --budget 300s"), "effects.json");
}

#[test]
fn killed_samples_go_on() {
    let uncertain = "--uncertain /beam/young_modulus_pa=normal:2e6:1e5 --samples 32 --jobs 1";
    let fine = SMALL.replace("segment=4", "segment=32");
    for command in ["run", "modes"] {
        killed_and_resumed(&format!("{command} {fine} {uncertain}"), "uncertainty.json");
    }
}

/// Goal: each of 60 random changes to a journal of evaluations is detected, and the changed rows are not used; rows of another case, of
/// other settings or of another command are not used either.
#[test]
fn changed_evaluations_are_not_used() {
    let dir = TempDir::new().expect("a folder");
    let folder = ResultFolder::claim(dir.path(), FolderKind::Optimum, false).expect("claimed");
    let load = |set: &str| case::load(Path::new("cases/two-bladders.json"), &[set.to_owned()]).expect("a case");
    let own = load("/time/end_s=0.005");
    let begin = |of: (&str, &case::Case, &str)| {
        let evaluations = Evaluations::default();
        let damage = files::begin(&evaluations, &folder, of).expect("a journal");
        (evaluations, damage)
    };
    let ask = |evaluations: &Evaluations| {
        for k in 0..5 {
            evaluations.get(&("plain", k), &|| false, || vec![f64::from(k).sqrt(), 1.0 / 3.0]);
        }
        evaluations.counts().read
    };
    let (first, _) = begin(("optimize", &own, "--starts 1"));
    assert_eq!(ask(&first), 0);
    let path = files::path(&folder);
    let sound = fs::read(&path).expect("rows");
    let mut random = Random(53);
    for trial in 0..60 {
        let (bytes, same, at) = changed(&sound, &mut random);
        fs::write(&path, &bytes).expect("written");
        let (again, damage) = begin(("optimize", &own, "--starts 1"));
        assert!(damage.is_some() && ask(&again) == same, "{trial}: byte {at}");
    }
    fs::write(&path, &sound).expect("written");
    let other = load("/time/end_s=0.006");
    for of in [
        ("optimize", &other, "--starts 1"),
        ("optimize", &own, "--starts 2"),
        ("fit", &own, "--starts 1"),
    ] {
        let (again, damage) = begin(of);
        let damage = damage.unwrap_or_default();
        assert!(damage.contains("5 rows are not used"), "{damage}");
        assert_eq!(ask(&again), 0);
        fs::write(&path, &sound).expect("written");
    }
    let (again, damage) = begin(("optimize", &own, "--starts 1"));
    assert_eq!((ask(&again), damage), (5, None));
}

/// Goal: the clock ends every command soon and says so: with exit code 0 where there is a part of a result, 4 where there is none.
#[test]
fn the_clock_ends_every_command() {
    let dir = TempDir::new().expect("a folder");
    let data = dir.path().join("data.csv");
    fs::write(&data, "t_s,tip_mm\n0.001,0.1\n0.002,0.2\n0.004,0.4\n").expect("written");
    let long = "cases/wiring-2.json --set /mesh/cells_per_segment=16 --set /solver/rtol=1e-9 --set /time/end_s=50";
    let fine = "cases/wiring-2.json --set /mesh/cells_per_segment=64 --set /mesh/cells_per_bladder=32";
    let uncertain = "--uncertain /beam/young_modulus_pa=normal:2e6:1e5 --samples 4000";
    let driven = "cases/valves-open.json --set /mesh/cells_per_segment=16 --set /solver/rtol=1e-9";
    let commands = [
        (
            format!("optimize {long} --vary {MODULUS} --minimize tip_u1_m.max_abs"),
            "optimum.json",
        ),
        (
            format!("fit {long} {} --vary {MODULUS} --match tip_mm=tip_u1", data.display()),
            "fit.json",
        ),
        (
            format!("periodic {driven} --sweep /network/permeability_factor=0.01:1:200:log"),
            "sweep.json",
        ),
        (format!("periodic {driven}"), "cycle.json"),
        (format!("floquet {driven}"), "floquet.json"),
        (format!("floquet {driven} --map frequency,amplitude"), "map.json"),
        (format!("modes {fine} --count 200"), "modes.json"),
        (format!("study {long} --budget 300s"), "study.json"),
        (format!("effects {long} --budget 300s"), "effects.json"),
        (format!("equilibrium {fine} --points 400"), "equilibrium.json"),
        (
            format!("sweep {long} --vary /beam/length_m=lin:0.1:0.2:50 --lean"),
            "sweep.json",
        ),
        (format!("run {SMALL} {uncertain}"), "summary.json"),
    ];
    for (k, (asked, file)) in commands.iter().enumerate() {
        let out = dir.path().join(format!("{k}"));
        let place = out.display().to_string();
        let all = [&describe(asked)[..], &["--max-wall", "0.7", "--quiet", "--out", &place]].concat();
        let begun = Instant::now();
        let said = say(&all);
        assert!(
            begun.elapsed() < Duration::from_secs(60),
            "{asked}: {:?}",
            begun.elapsed()
        );
        assert!(
            said.err.contains("the wall time allowed (--max-wall) is used up"),
            "{asked}: {}",
            said.err
        );
        // a sweep without a cycle, a study without a run and effects without the full model have files, and nothing in them
        let empty = ["sweep.json", "study.json", "effects.json"].contains(file) && said.code == 4;
        let part = out.join(file).exists();
        assert_eq!(
            said.code,
            if part && !empty { 0 } else { 4 },
            "{asked}: {part}\n{}\n{}",
            said.out,
            said.err
        );
        println!("{asked}: {} after {:?}", said.code, begun.elapsed());
    }
    let said = say(&["verify", "--max-wall", "0.7"]);
    assert!(
        said.err.contains("interrupted after ") && said.out.contains("exact results reproduced"),
        "{}",
        said.err
    );
}
