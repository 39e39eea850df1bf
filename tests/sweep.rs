//! `slcbeam sweep` and `slcbeam merge` from outside: what is computed, what is kept, what is refused.
//!
//! Goal: the table depends on the designs alone, not on how many are computed at once, nor on kills, nor on shards. Nothing here
//! has a tolerance: tables are equal byte for byte but for wall times, or they are not.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;
use slcbeam::output::npz::Npz;
use tempfile::TempDir;

const CASE: &str = "cases/two-bladders.json";
const AREA: &str = "/bladders/area_per_pressure_m2_per_pa";
const SHORT: [&str; 4] = ["--set", "/time/end_s=0.0005", "--set", "/mesh/cells_per_segment=4"];

struct Said {
    code: i32,
    out: String,
    err: String,
}

fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_slcbeam"));
    command.args(arguments);
    command
}

fn say(arguments: &[&str]) -> Said {
    let output = command(arguments).output().expect("a program");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    Said {
        code: output.status.code().unwrap_or(-1),
        out: text(output.stdout),
        err: text(output.stderr),
    }
}

fn path(dir: &TempDir, name: &str) -> String {
    dir.path().join(name).display().to_string()
}

/// Sweeps the small case with these options besides.
fn swept(out: &str, more: &[&str]) -> Said {
    say(&[&["sweep", CASE, "--quiet", "--lean", "--out", out], &SHORT[..], more].concat())
}

fn well(said: &Said) {
    assert_eq!(said.code, 0, "{}\n{}", said.out, said.err);
}

/// Rows of a table by heading.
fn rows(out: &str) -> Vec<std::collections::BTreeMap<String, String>> {
    let mut table = csv::Reader::from_path(Path::new(out).join("sweep.csv")).expect("a table");
    let names = table.headers().expect("headings").clone();
    let row = |record: csv::StringRecord| {
        names
            .iter()
            .map(String::from)
            .zip(record.iter().map(String::from))
            .collect()
    };
    table.records().map(|record| row(record.expect("a row"))).collect()
}

/// A table without its last column, the wall times.
fn table(out: &str) -> String {
    let text = fs::read_to_string(Path::new(out).join("sweep.csv")).expect("a table");
    assert!(text.lines().next().is_some_and(|line| line.ends_with(",wall_s")));
    text.lines()
        .map(|line| line.rsplit_once(',').map_or(line, |(rest, _)| rest).to_owned() + "\n")
        .collect()
}

fn json(out: &str, name: &str) -> Value {
    let text = fs::read_to_string(Path::new(out).join(name)).expect("a file");
    serde_json::from_str(&text).expect("JSON")
}

/// Source: summaries of single runs. Goal: a row has every figure of the summary of the same case, bit for bit, with its error.
#[test]
fn a_row_is_what_the_run_tells() {
    let dir = TempDir::new().expect("a folder");
    let (out, alone) = (path(&dir, "sweep"), path(&dir, "alone"));
    let vary = format!("{AREA}=log:1e-10:1e-9:3");
    well(&swept(&out, &["--vary", &vary]));
    let rows = rows(&out);
    assert_eq!(rows.len(), 3);
    let set = format!("{AREA}={}", rows[1][AREA]);
    well(&say(&[
        &["run", CASE, "--quiet", "--lean", "--out", &alone, "--set", &set],
        &SHORT[..],
    ]
    .concat()));
    let summary = json(&alone, "summary.json");
    let mut compared = 0;
    for (name, quantity) in summary["quantities"].as_object().expect("quantities") {
        for (figure, value) in quantity.as_object().expect("figures") {
            let there: f64 = rows[1][&format!("{name}.{figure}")].parse().expect("a number");
            assert_eq!(Some(there), value.as_f64(), "{name}.{figure}");
            compared += 1;
        }
    }
    assert!(compared > 20, "{compared}");
    let error = &summary["estimate"]["quantities"]["tip_u3_m"]["total"];
    assert_eq!(rows[1]["tip_u3_m.error"].parse().ok(), error.as_f64());
    assert_eq!(rows[1]["steps"], summary["solver"]["steps"].to_string());
    // the arrays are the table's
    let mut npz = Npz::open(&Path::new(&out).join("sweep.npz")).expect("arrays");
    let told = json(&out, "sweep.json");
    assert_eq!(
        (&told["complete"], &told["rows"], &told["statuses"]["finished"]),
        (&true.into(), &3.into(), &3.into())
    );
    for column in told["columns"].as_array().expect("columns") {
        let (Some(name), Some(array)) = (column["name"].as_str(), column["array"].as_str()) else {
            continue;
        };
        if ["status", "case"].contains(&name) {
            continue;
        }
        let values = npz.read(array).expect("an array");
        for (row, value) in rows.iter().zip(values) {
            assert_eq!(
                row[name].parse::<f64>().unwrap_or(f64::NAN).to_bits(),
                value.to_bits(),
                "{name}"
            );
        }
    }
}

/// Goal: figures of the other commands are those that the commands tell.
#[test]
fn other_commands_tell_their_figures() {
    let dir = TempDir::new().expect("a folder");
    let vary = format!("{AREA}=2e-10,4e-10");
    for (what, file, names) in [
        ("equilibrium", "equilibrium.json", ["tip_u3_m", "max_pressure_pa"]),
        ("modes", "modes.json", ["mode_1.frequency_hz", "mode_1.damping_ratio"]),
    ] {
        let (out, alone) = (path(&dir, what), path(&dir, &format!("{what}-alone")));
        well(&swept(&out, &["--vary", &vary, "--command", what]));
        let set = format!("{AREA}=4e-10");
        well(&say(&[
            &[what, CASE, "--quiet", "--out", &alone, "--set", &set],
            &SHORT[..],
        ]
        .concat()));
        let (rows, told) = (rows(&out), json(&alone, file));
        for name in names {
            let there = match what {
                "equilibrium" => told["quantities"][name].as_f64(),
                _ => {
                    let modes = told["modes"].as_array().expect("modes").iter();
                    let swinging = modes.filter(|mode| mode["frequency_hz"].is_number());
                    let hz = |mode: &&Value| mode["frequency_hz"].as_f64().expect("a frequency");
                    let lowest = swinging.min_by(|a, b| hz(a).total_cmp(&hz(b))).expect("one swings");
                    lowest[name.trim_start_matches("mode_1.")].as_f64()
                }
            };
            assert_eq!(rows[1][name].parse().ok(), there, "{name}");
        }
        assert_eq!(rows[1]["stable"], "1");
        let error = if what == "modes" {
            "mode_1.frequency_hz.error"
        } else {
            "max_pressure_pa.error"
        };
        assert!(rows[1][error].parse::<f64>().expect("an error") < 0.1);
    }
}

/// Goal: a cycle tells harvested energy, mean power and efficiency with how far their balance is open.
#[test]
fn cycles_tell_what_is_harvested() {
    let dir = TempDir::new().expect("a folder");
    let out = path(&dir, "cycles");
    let more = [
        "--quiet",
        "--lean",
        "--out",
        &out,
        "--set",
        "/mesh/cells_per_segment=1",
        "--set",
        "/mesh/cells_per_bladder=1",
        "--vary",
        "/network/permeability_factor=0.5,1",
        "--command",
        "periodic",
        "--no-mesh-errors",
    ];
    well(&say(
        &[&["sweep", "cases/harvester-parallel-uniform.json"], &more[..]].concat()
    ));
    for row in rows(&out) {
        let number = |name: &str| row[name].parse::<f64>().expect("a number");
        let (energy, period) = (number("harvested_energy_j.window"), number("period_s"));
        assert_eq!(number("harvested_power_w.mean"), energy / period);
        assert!(energy > 0.0 && number("harvested_energy_j.window_error") >= 0.0);
        let efficiency = number("efficiency.window");
        assert!(
            (efficiency / (energy / number("input_energy_j.window")) - 1.0).abs() < 0.01,
            "{efficiency}"
        );
        assert!(
            !row.contains_key("harvested_energy_j.window.error"),
            "no meshes were asked for"
        );
    }
}

/// Goal: one thread and two, in one piece and in shards, make the same table; a shard that is lost is named with what computes it.
#[test]
fn shards_and_threads_make_the_same_table() {
    let dir = TempDir::new().expect("a folder");
    let vary = [
        "--vary",
        "/bladders/area_per_pressure_m2_per_pa=uniform:1e-10:9e-10",
        "--design",
        "sobol:7",
    ];
    let cases = ["--vary", "/effects/tube_inertia=\"on\",\"off\""];
    let options = [&vary[..], &cases[..]].concat();
    let [one, two, whole] = ["one", "two", "whole"].map(|name| path(&dir, name));
    well(&swept(&one, &[&options[..], &["--jobs", "1"]].concat()));
    well(&swept(&two, &[&options[..], &["--jobs", "2"]].concat()));
    assert_eq!(table(&one), table(&two));
    assert_eq!(rows(&one).len(), 14);
    let shards = ["shard-1", "shard-2", "shard-3"].map(|name| path(&dir, name));
    for (k, shard) in shards.iter().enumerate().filter(|(k, _)| *k != 1) {
        well(&swept(
            shard,
            &[&options[..], &["--shard", &format!("{}/3", k + 1)]].concat(),
        ));
    }
    let merge = |parts: &[&str]| say(&[&["merge"], parts, &["--lean", "--out", &whole]].concat());
    let said = merge(&[&shards[0], &shards[2]]);
    assert_eq!(said.code, 5, "{}", said.err);
    assert!(
        said.err
            .contains("shard 2/3, of which no folder was given, lacks 5 designs"),
        "{}",
        said.err
    );
    assert_eq!(rows(&whole).len(), 9);
    assert_eq!(json(&whole, "sweep.json")["missing"], 5);
    // the command that is told computes the shard, as a shell reads it
    let told = said
        .err
        .lines()
        .find_map(|line| line.trim().strip_prefix("slcbeam sweep"))
        .expect("a command");
    let program = env!("CARGO_BIN_EXE_slcbeam");
    let status = Command::new("sh")
        .args(["-c", &format!("{program} sweep{told} --quiet --lean")])
        .stdout(Stdio::null())
        .status();
    assert!(status.expect("a shell").success());
    assert_eq!(rows(&shards[1]).len(), 5);
    well(&merge(&[&shards[0], &shards[1], &shards[2]]));
    assert_eq!(table(&whole), table(&one));
    // parts of different sweeps
    let other = path(&dir, "other");
    well(&swept(&other, &["--vary", &format!("{AREA}=1e-10")]));
    let said = merge(&[&shards[0], &other]);
    assert_eq!(said.code, 2);
    assert!(said.err.contains("different sweeps: --vary is"), "{}", said.err);
    let said = merge(&[&path(&dir, "nowhere")]);
    assert_eq!(said.code, 5, "{}", said.err);
}

/// Goal: what is killed goes on after what is there, as does what was cut in the middle of a line, and ends with the same table.
#[test]
fn killed_sweeps_go_on() {
    let dir = TempDir::new().expect("a folder");
    let vary = format!("{AREA}=log:1e-10:1e-9:30");
    let options = ["--vary", &vary, "--set", "/time/end_s=0.004"];
    let (whole, out) = (path(&dir, "whole"), path(&dir, "killed"));
    well(&swept(&whole, &options));
    let journal = Path::new(&out).join("designs.jsonl");
    let lines = || fs::read_to_string(&journal).map_or(0, |text| text.lines().count());
    let mut kills = 0;
    for round in 1..=3 {
        let all = [
            &["sweep", CASE, "--quiet", "--lean", "--out", &out],
            &SHORT[..],
            &options,
        ]
        .concat();
        let mut child = command(&all)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("a program");
        let begun = Instant::now();
        while lines() < 5 * round && begun.elapsed() < Duration::from_secs(60) {
            if child.try_wait().expect("a child").is_some() {
                break;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        kills += usize::from(child.try_wait().expect("a child").is_none());
        child.kill().expect("killed");
        child.wait().expect("ended");
        // as a power cut leaves it
        let text = fs::read(&journal).expect("lines");
        let cut = text.len() - 17 * usize::from(round == 2 && text.len() > 17);
        fs::write(&journal, &text[..cut]).expect("cut");
    }
    assert!(kills > 0);
    let before = lines();
    well(&swept(&out, &options));
    assert!(before < 30, "{before}");
    assert_eq!(table(&out), table(&whole));
    // again: nothing is left to do
    let journal_before = fs::read(&journal).expect("lines");
    well(&swept(&out, &options));
    assert_eq!(fs::read(&journal).expect("lines"), journal_before);
}

/// Goal: an interrupt ends in order with the table of what is there.
#[test]
fn an_interrupt_leaves_a_table() {
    let dir = TempDir::new().expect("a folder");
    let out = path(&dir, "out");
    let vary = format!("{AREA}=log:1e-10:1e-9:400");
    let all = [
        &["sweep", CASE, "--lean", "--out", &out, "--vary", &vary, "--jobs", "1"],
        &SHORT[2..],
    ]
    .concat();
    let child = command(&all)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("a program");
    let journal = Path::new(&out).join("designs.jsonl");
    let begun = Instant::now();
    while fs::metadata(&journal).map_or(0, |there| there.len()) == 0 && begun.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(1));
    }
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(killed.expect("a command").success());
    let ended = child.wait_with_output().expect("ended");
    let said = String::from_utf8_lossy(&ended.stderr).into_owned();
    assert_eq!(ended.status.code(), Some(0), "{said}");
    assert!(said.contains("the same command goes on with them"), "{said}");
    let told = json(&out, "sweep.json");
    let (there, missing) = (
        told["rows"].as_u64().expect("rows"),
        told["missing"].as_u64().expect("missing"),
    );
    assert_eq!((there as usize, there + missing), (rows(&out).len(), 400));
    assert!(missing > 0);
}

/// Goal: what fails while it is computed is a row with its reason, and the others are there.
#[test]
fn failures_are_rows() {
    let dir = TempDir::new().expect("a folder");
    let out = path(&dir, "out");
    well(&swept(&out, &["--vary", "/solver/max_steps=5,100000"]));
    let rows = rows(&out);
    assert_eq!(
        (rows[0]["status"].as_str(), rows[1]["status"].as_str()),
        ("failed", "finished")
    );
    assert!(rows[0]["reason"].contains("steps"), "{}", rows[0]["reason"]);
    let none = path(&dir, "none");
    let said = swept(&none, &["--vary", "/solver/max_steps=5,6"]);
    assert_eq!(said.code, 4, "{}", said.err);
    assert!(
        said.out.contains("design 0 (/solver/max_steps = 5): failed: "),
        "{}",
        said.out
    );
}

/// Goal: a table of designs, several cases, kept cases and folders.
#[test]
fn tables_cases_and_folders() {
    let dir = TempDir::new().expect("a folder");
    let (out, list) = (path(&dir, "out"), path(&dir, "designs.csv"));
    fs::write(
        &list,
        format!("{AREA},/effects/tube_inertia\n2e-10,off\n3e-10,\"\"\"on\"\"\"\n"),
    )
    .expect("written");
    well(&swept(&out, &["--designs", &list, "--keep-cases", "--keep-folders"]));
    let found = rows(&out);
    assert_eq!(
        (found[1][AREA].as_str(), found[1]["/effects/tube_inertia"].as_str()),
        ("3e-10", "on")
    );
    // a kept case is the design, in a folder of its own and by itself
    let (kept, alone) = (format!("{out}/cases/00001.json"), path(&dir, "alone"));
    well(&say(&["run", &kept, "--quiet", "--lean", "--out", &alone]));
    let inside = format!("{out}/designs/00001");
    for quantity in ["tip_u3_m", "max_pressure_pa"] {
        let last = json(&alone, "summary.json")["quantities"][quantity]["final"].as_f64();
        assert_eq!(
            json(&inside, "summary.json")["quantities"][quantity]["final"].as_f64(),
            last
        );
        assert_eq!(found[1][&format!("{quantity}.final")].parse().ok(), last);
    }
    let several = path(&dir, "several");
    let coarse = [
        "--set",
        "/mesh/cells_per_segment=1",
        "--set",
        "/time/end_s=0.01",
        "--set",
        "/time/window_s=0.01",
    ];
    let cases = [
        "sweep",
        "cases/wiring-1.json",
        "cases/wiring-2.json",
        "--vary",
        "/network/permeability_factor=0.5,1",
    ];
    well(&say(&[&cases[..], &coarse, &["--out", &several, "--quiet"]].concat()));
    let names: Vec<String> = rows(&several).iter().map(|row| row["case"].clone()).collect();
    assert_eq!(names, ["wiring-1", "wiring-1", "wiring-2", "wiring-2"]);
    let page = fs::read_to_string(Path::new(&several).join("report.html")).expect("a page");
    assert!(page.contains("4 designs went through") && page.contains("/network/permeability_factor"));
}

/// Goal: what cannot be a sweep is refused before anything is computed or written, with the code and the place.
#[test]
fn what_makes_no_sense_is_refused() {
    let dir = TempDir::new().expect("a folder");
    let (out, list) = (path(&dir, "out"), path(&dir, "list.csv"));
    for (text, word) in [
        ("", "no columns"),
        ("beam\n1\n", "starts with `/`"),
        ("/beam/length_m\n", "no designs"),
        (
            "/beam/length_m,/beam/width_m\n0.1,\n",
            "design 0 (row 2 of the table) has no /beam/width_m",
        ),
        ("/beam/length_m\nNaN\n", "no JSON value"),
        ("/beam/length_m,/beam/width_m\n0.1\n", "fields"),
    ] {
        fs::write(&list, text).expect("written");
        let said = swept(&out, &["--designs", &list]);
        assert!(
            said.code == 2 && said.err.contains(word),
            "{text:?}: {} {}",
            said.code,
            said.err
        );
    }
    for (more, code, word) in [
        (vec![], 2, "nothing varied"),
        (
            vec!["--vary", "/beam/length_m=uniform:2:1", "--design", "latin:3"],
            2,
            "2 is not below 1",
        ),
        (
            vec!["--vary", "/beam/length_m=uniform:1:2"],
            2,
            "--design latin:N or sobol:N",
        ),
        (vec!["--vary", "/beam/length_m=0.1 m"], 2, "without units"),
        (
            vec!["--vary", "/beam/length_m=0.1", "--design", "latin:0"],
            2,
            "latin:100",
        ),
        (vec!["--vary", "/beam/lenght_m=0.1"], 3, "E004"),
        (vec!["--vary", "/beam/length_m=0.1,-0.1"], 3, "/beam/length_m"),
        (
            vec!["--vary", "/beam/length_m=0.1,100"],
            3,
            "design 1 of 2 (/beam/length_m = 100)",
        ),
        (
            vec!["--vary", "/beam/length_m=0.1", "--shard", "3/2"],
            2,
            "I from 1 to N",
        ),
        (vec!["--vary", "/beam/length_m=0.1", "--jobs", "0"], 2, "1 or more"),
        (
            vec!["--vary", "/beam/length_m=0.1", "--command", "periodic"],
            2,
            "period",
        ),
        (
            vec!["--vary", "/beam/length_m=0.1", "--command", "modes", "--keep-folders"],
            2,
            "--keep-cases",
        ),
    ] {
        let said = swept(&out, &more);
        assert!(
            said.code == code && said.err.contains(word),
            "{more:?}: {} {}",
            said.code,
            said.err
        );
    }
    assert!(!Path::new(&out).exists());
}

/// Goal: a folder of another sweep, or with something else, is left as it is until it is said otherwise.
#[test]
fn folders_of_others_stay() {
    let dir = TempDir::new().expect("a folder");
    let (out, other) = (path(&dir, "out"), path(&dir, "other"));
    let [first, second] = ["2e-10", "3e-10"].map(|value| format!("{AREA}={value}"));
    well(&swept(&out, &["--vary", &first, "--keep-cases"]));
    let before = table(&out);
    let said = swept(&out, &["--vary", &second]);
    assert!(
        said.code == 2 && said.err.contains("holds another sweep: --vary is"),
        "{}",
        said.err
    );
    assert_eq!(table(&out), before);
    well(&swept(&out, &["--vary", &second, "--restart"]));
    assert_ne!(table(&out), before);
    assert!(!Path::new(&out).join("cases").exists(), "the cases of the sweep before");
    fs::create_dir(&other).expect("a folder");
    fs::write(Path::new(&other).join("letter.txt"), "mine").expect("written");
    let said = swept(&other, &["--vary", &first]);
    assert!(said.code == 5 && said.err.contains("no slcbeam result"), "{}", said.err);
    // a sweep is no run, and a run no sweep
    let said = say(&["run", CASE, "--quiet", "--out", &out]);
    assert!(said.code == 5 && said.err.contains("slcbeam sweep"), "{}", said.err);
}

/// Goal: the script for GNU parallel computes and joins the shards wherever it is there; that of Slurm is one that a shell reads.
#[test]
fn scripts_are_what_a_shell_reads() {
    let dir = TempDir::new().expect("a folder");
    let out = path(&dir, "a folder");
    let vary = format!("{AREA}=log:1e-10:1e-9:5");
    for kind in ["slurm", "parallel"] {
        let said = swept(
            &out,
            &[
                "--vary",
                &vary,
                "--set",
                "/about=\"it's\"",
                "--script",
                kind,
                "--shards",
                "2",
            ],
        );
        well(&said);
        let script = path(&dir, kind);
        fs::write(&script, &said.out).expect("written");
        assert!(
            Command::new("sh")
                .args(["-n", &script])
                .status()
                .expect("a shell")
                .success()
        );
        let run = |more: &[(&str, &str)]| {
            Command::new("sh")
                .arg(&script)
                .envs(more.iter().copied())
                .output()
                .expect("a shell")
        };
        if kind == "slurm" {
            for task in ["1", "2"] {
                let ended = run(&[("SLURM_ARRAY_TASK_ID", task)]);
                assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));
            }
            let parts = ["1", "2"].map(|task| format!("{out}-shard-{task}"));
            well(&say(&["merge", &parts[0], &parts[1], "--lean", "--out", &out]));
        } else if Command::new("parallel").arg("--version").output().is_ok() {
            let ended = run(&[]);
            assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));
        }
        assert_eq!(rows(&out).len(), 5);
    }
}
