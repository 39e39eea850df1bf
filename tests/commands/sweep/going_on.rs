//! Threads, shards, kills, interrupts, jobs.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use slcbeam::output::sweep::JournalSummary;
use slcbeam::results::{self, sweep::SweepPlan};
use tempfile::TempDir;

use crate::chance::Random;
use crate::journals::changed;

use super::common::{AREA, CASE, SHORT, command, json, path, rows, say, swept, table, well};

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
        said.err.contains("shard 2/3 (no folder given) lacks 5 designs"),
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
    // more shards than designs
    let few = ["--vary", "/beam/length_m=0.1,0.11", "--shard", "3/3"];
    let empty = path(&dir, "empty");
    well(&swept(&empty, &few));
    assert_eq!(
        (rows(&empty).len(), &json(&empty, "sweep.json")["complete"]),
        (0, &true.into())
    );
    // parts of different sweeps
    let other = path(&dir, "other");
    well(&swept(&other, &["--vary", &format!("{AREA}=1e-10")]));
    let said = merge(&[&shards[0], &other]);
    assert_eq!(said.code, 2);
    assert!(said.err.contains("different sweeps: --vary is"), "{}", said.err);
    let said = merge(&[&path(&dir, "nowhere")]);
    assert_eq!(said.code, 5, "{}", said.err);
    assert!(
        said.err.contains("there is no such folder") && said.err.contains("a result of `slcbeam sweep` is needed"),
        "{}",
        said.err
    );
    // what is wanted and what is there, the other way round
    let said = say(&["compare", &whole, &whole]);
    assert_eq!(said.code, 2, "{}", said.err);
    assert!(
        said.err
            .contains("contains the result of `slcbeam sweep`; a result of run or periodic is needed"),
        "{}",
        said.err
    );
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
    // what is there has a page already
    well(&say(&["report", &out]));
    let page = fs::read_to_string(Path::new(&out).join("report.html")).expect("a page");
    assert!(page.contains("designs are missing") || page.contains("1 design is missing"));
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
    assert_eq!(ended.status.code(), Some(130), "{said}");
    assert!(said.contains("The same command continues with them"), "{said}");
    let told = json(&out, "sweep.json");
    let (there, missing) = (
        told["rows"].as_u64().expect("rows"),
        told["missing"].as_u64().expect("missing"),
    );
    assert_eq!((there as usize, there + missing), (rows(&out).len(), 400));
    assert!(missing > 0);
}

/// Goal: the script for GNU parallel computes and joins the shards; that of Slurm is one that a shell reads, too.
/// `scripts/install parallel` installs what is needed, `scripts/test` does so by itself.
#[test]
fn scripts_are_what_a_shell_reads() {
    let dir = TempDir::new().expect("a folder");
    let vary = format!("{AREA}=log:1e-10:1e-9:5");
    let about = ["--set", "/about=\"it's\"", "--keep-cases"];
    for kind in ["slurm", "parallel"] {
        let out = path(&dir, &format!("out of {kind}"));
        let asked = ["--vary", &vary, "--script", kind, "--shards", "2"];
        let said = swept(&out, &[&asked[..], &about].concat());
        well(&said);
        let script = path(&dir, kind);
        fs::write(&script, &said.out).expect("written");
        let run = |task: &str| {
            let mut shell = Command::new("sh");
            shell.arg(&script).env("SLURM_ARRAY_TASK_ID", task);
            let ended = shell.output().expect("a shell");
            assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));
        };
        run("1");
        let parts = ["1", "2"].map(|task| format!("{out}-shard-{task}"));
        if kind == "slurm" {
            run("2");
            well(&say(&["merge", &parts[0], &parts[1], "--lean", "--out", &out]));
        }
        assert_eq!(rows(&out).len(), 5);
        let kept = Path::new(&parts[1]).join("cases/00001.json");
        assert!(kept.exists() && !Path::new(&parts[1]).join("report.html").exists());
    }
}

/// A line of a journal without its checksum.
fn unsealed(line: &str) -> String {
    let (row, _) = line.rsplit_once(",\"crc32\":").expect("a checksum");
    format!("{row}}}")
}

/// Goal: each of 60 random changes to a journal is detected: the changed rows are named, and not used. A sweep computes their designs again, to the
/// same table; a part of a merge lacks them; the journal of another sweep has no row of this one.
#[test]
fn changed_rows_are_not_used() {
    let dir = TempDir::new().expect("a folder");
    let [out, other] = ["out", "other"].map(|name| path(&dir, name));
    let vary = ["--vary", &format!("{AREA}=1e-10,2e-10,3e-10"), "--jobs", "1"];
    well(&swept(&out, &vary));
    let whole = table(&out);
    let journal = Path::new(&out).join("designs.jsonl");
    let sound = fs::read(&journal).expect("rows");
    let text = fs::read_to_string(Path::new(&out).join("plan.json")).expect("a plan");
    let plan = results::read::<SweepPlan>(&text).expect("a plan").result;
    let mut random = Random(52);
    for trial in 0..60 {
        let (bytes, same, at) = changed(&sound, &mut random);
        fs::write(&journal, &bytes).expect("written");
        let survey = JournalSummary::read(&journal, &plan).expect("a survey");
        assert!(
            survey.damage().is_some() && survey.count() == same,
            "{trial}: byte {at}"
        );
    }
    let damaged = String::from_utf8(sound.clone())
        .expect("text")
        .replacen("\"number\":1", "\"number\":2", 1);
    fs::write(&journal, &damaged).expect("written");
    let said = say(&["merge", &out, "--lean", "--out", &path(&dir, "merged")]);
    assert_eq!(said.code, 5, "{}", said.err);
    assert!(said.err.contains("1 row is not used (line 2)"), "{}", said.err);
    let said = swept(&out, &vary);
    well(&said);
    assert!(said.err.contains("1 row is not used (line 2)"), "{}", said.err);
    assert_eq!(table(&out), whole);

    well(&swept(&other, &["--vary", &format!("{AREA}=1e-10,2e-10,4e-10")]));
    fs::copy(&journal, Path::new(&other).join("designs.jsonl")).expect("a copy");
    let said = swept(&other, &["--vary", &format!("{AREA}=1e-10,2e-10,4e-10")]);
    assert!(said.err.contains("rows are not used"), "{}", said.err);
}

/// Goal: a design that failed has its row and stays as it is, unless it is to be tried again; then the row that finished counts.
#[test]
fn what_failed_is_tried_again_on_request() {
    let dir = TempDir::new().expect("a folder");
    let out = path(&dir, "out");
    let vary = ["--vary", &format!("{AREA}=1e-10,2e-10,3e-10"), "--jobs", "1"];
    well(&swept(&out, &vary));
    let whole = table(&out);
    let journal = dir.path().join("out/designs.jsonl");
    let text = fs::read_to_string(&journal).expect("rows");
    // rows of a version before checksums, which come before those that have one
    let bare: String = text.lines().map(|line| unsealed(line) + "\n").collect();
    let failed = bare.replacen("\"finished\",\"reason\":null", "\"failed\",\"reason\":\"E001 once\"", 1);
    assert_ne!(text, failed);
    fs::write(&journal, &failed).expect("written");
    well(&swept(&out, &vary));
    assert_eq!(rows(&out)[0]["status"], "failed");
    assert_eq!(fs::read_to_string(&journal).expect("rows"), failed);
    well(&swept(&out, &[&vary[..], &["--retry"]].concat()));
    assert_eq!(table(&out), whole);
    assert_eq!(json(&out, "sweep.json")["statuses"]["finished"], 3);
}
