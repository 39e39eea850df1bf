//! Folders that are strange: malicious, failed, cut short, large, none at all.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use super::browser::Browser;
use super::common::{made, report, slcbeam, sound};

fn change(path: &Path, act: impl FnOnce(&mut Value)) {
    let mut value: Value = serde_json::from_str(&fs::read_to_string(path).expect("a file")).expect("JSON");
    act(&mut value);
    fs::write(path, value.to_string()).expect("written");
}

#[test]
fn what_a_case_says_is_never_markup() {
    let folder = tempfile::tempdir().expect("a folder");
    made(
        folder.path(),
        &["run", "cases/dry-cantilever.json", "--set", "/time/end_s=0.02"],
    );
    let evil = "</script><img src=x onerror=\"window.hit=1\"><script>window.hit=1</script><!-- {{data}}";
    change(&folder.path().join("summary.json"), |s| {
        s["case"] = evil.into();
        s["warnings"] = json!([format!("evil: {evil}")]);
    });
    change(&folder.path().join("case.json"), |c| c["about"] = evil.into());
    let page = report(folder.path());
    let mut browser = Browser::start();
    sound(&mut browser, &page, &["scene", "motion", "histories", "case"]);
    assert_eq!(browser.text("document.querySelector('h1').textContent"), evil);
    assert_eq!(browser.text("document.querySelector('.about').textContent"), evil);
    assert!(browser.text("document.title").starts_with(evil));
    assert_eq!(
        browser.eval("window.hit === undefined && !document.querySelector('img[src=x]')"),
        true
    );
}

#[test]
fn a_run_that_failed_says_so_first() {
    let folder = tempfile::tempdir().expect("a folder");
    made(
        folder.path(),
        &["run", "cases/dry-cantilever.json", "--set", "/time/end_s=0.02"],
    );
    let history = folder.path().join("history.csv");
    let text = fs::read_to_string(&history).expect("a history");
    fs::write(&history, text.lines().next().expect("names")).expect("written");
    fs::remove_file(folder.path().join("fields.npz")).expect("removed");
    let why = "the step became smaller than round-off at t = 0.0213 s";
    change(&folder.path().join("summary.json"), |s| {
        s["status"] = "failed".into();
        s["reason"] = why.into();
        s["tables_crc32"] = json!({});
        s["quantities"]["tip_u1_m"]["max_abs"] = Value::Null;
        s["balances"]["energy_residual_relative"] = Value::Null;
    });
    let mut browser = Browser::start();
    sound(
        &mut browser,
        &report(folder.path()),
        &["reason", "scene", "energy", "work", "case"],
    );
    assert_eq!(browser.text("document.querySelector('.badge').textContent"), "failed");
    assert!(
        browser
            .text("document.getElementById('reason').textContent")
            .contains(why)
    );
    let top = "document.getElementById('reason').getBoundingClientRect().top";
    assert!(browser.number(top) < 400.0, "the reason is not in sight");

    // Killed: no summary, a last line cut short, arrays that are no archive.
    fs::remove_file(folder.path().join("summary.json")).expect("removed");
    fs::write(&history, &text[..text.len() - 9]).expect("written");
    fs::write(folder.path().join("fields.npz"), "cut short").expect("written");
    sound(
        &mut browser,
        &report(folder.path()),
        &["reason", "scene", "histories", "case"],
    );
    assert_eq!(
        browser.text("document.querySelector('.badge').textContent"),
        "interrupted"
    );
}

#[test]
fn one_output_time_is_enough() {
    let folder = tempfile::tempdir().expect("a folder");
    // Stopped at its first step, and what was recorded there cut off, as by a kill before it.
    made(folder.path(), &["run", "cases/two-bladders.json", "--max-wall", "0"]);
    let history = folder.path().join("history.csv");
    let text = fs::read_to_string(&history).expect("a history");
    let first: Vec<&str> = text.lines().take(2).collect();
    assert_eq!(text.lines().count(), 3);
    fs::write(&history, first.join("\n") + "\n").expect("written");
    change(&folder.path().join("summary.json"), |s| s["tables_crc32"] = json!({}));
    let page = report(folder.path());
    let mut browser = Browser::start();
    sound(&mut browser, &page, &["reason", "scene", "motion", "histories", "case"]);
    assert_eq!(browser.number("data.history.rows"), 1.0);
    browser.press(" ");
    browser.press("ArrowRight");
    assert_eq!(browser.problems(), Vec::<String>::new());
}

#[test]
fn four_hundred_bladders_in_a_row_and_many_output_times_stay_small() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut case: Value =
        serde_json::from_str(&fs::read_to_string("cases/wiring-1.json").expect("a case")).expect("JSON");
    let row = |sign: i64| (1..=400).map(|k| sign * k).collect::<Vec<_>>();
    case["name"] = "long".into();
    case["beam"]["length_m"] = 4.0.into();
    case["bladders"]["per_row"] = 400.into();
    case["bladders"]["coupling"] = "reciprocal".into();
    case["network"]["chains"] = json!([{"bladders": row(1)}, {"bladders": row(-1)}]);
    case["time"] = json!({"end_s": 2e-3, "output_interval_s": 2e-5});
    let path = folder.path().join("long.json");
    fs::write(&path, case.to_string()).expect("written");
    let out = folder.path().join("out");
    made(&out, &["run", &path.display().to_string()]);
    // A hundred thousand output times, with one peak that must be seen.
    let mut text = String::from("t [s],tip_u1 [m],max_pressure [Pa]\n");
    for k in 0..100_000 {
        let peak = if k == 77_777 { 5.0 } else { 1e-3 };
        let _ = writeln!(
            text,
            "{},{},{}",
            f64::from(k) * 1e-4,
            peak * (f64::from(k) * 0.01).sin().abs(),
            k % 7
        );
    }
    fs::write(out.join("history.csv"), text).expect("written");
    change(&out.join("summary.json"), |s| s["tables_crc32"] = json!({}));
    let mut browser = Browser::start();
    sound(
        &mut browser,
        &report(&out),
        &["scene", "motion", "maps", "histories", "case"],
    );
    assert!(
        browser
            .text("document.getElementById('histories').textContent")
            .contains("100 000 output times")
    );
    assert!(browser.number("document.querySelectorAll('#scene rect').length") >= 800.0);
    let most = browser.number("largest(unpackHistory(data.history).columns[0].values)");
    assert!(most > 3.0, "the peak is lost: {most}");
    assert_eq!(browser.problems(), Vec::<String>::new());
}

#[test]
fn the_same_folder_gives_the_same_bytes() {
    let folder = tempfile::tempdir().expect("a folder");
    let page = made(
        folder.path(),
        &["run", "cases/two-bladders.json", "--set", "/time/end_s=0.01"],
    );
    let first = fs::read(&page).expect("a page");
    assert_eq!(fs::read(report(folder.path())).expect("a page"), first);
    let other = folder.path().join("other.html");
    let asked = slcbeam(&[
        "report",
        &folder.path().display().to_string(),
        "--out",
        &other.display().to_string(),
        "--json",
    ]);
    let said: Value = serde_json::from_slice(&asked.stdout).expect("JSON");
    assert_eq!(said["bytes"], first.len());
    assert_eq!(said["report"], other.display().to_string());
    // Elsewhere links would lead nowhere: names stand instead.
    let elsewhere = tempfile::tempdir().expect("a folder");
    let page = elsewhere.path().join("page.html");
    slcbeam(&[
        "report",
        &folder.path().display().to_string(),
        "--out",
        &page.display().to_string(),
    ]);
    let mut browser = Browser::start();
    sound(&mut browser, &page, &["scene", "case", "files"]);
    assert_eq!(browser.number("document.querySelectorAll('#files a').length"), 0.0);
    assert!(
        browser
            .text("document.getElementById('files').textContent")
            .contains("history.csv")
    );
}

#[test]
fn no_result_is_an_error_that_helps() {
    let folder = tempfile::tempdir().expect("a folder");
    let result = folder.path().join("wiring-3");
    made(
        &result,
        &["run", "cases/two-bladders.json", "--set", "/time/end_s=0.001"],
    );
    let ask = |name: &str| {
        let output = slcbeam(&["report", &folder.path().join(name).display().to_string()]);
        assert_eq!(output.status.code(), Some(5));
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let missing = ask("wiring-2");
    assert!(
        missing.contains("no such folder") && missing.contains("did you mean") && missing.contains("wiring-3"),
        "{missing}"
    );
    fs::create_dir(folder.path().join("empty")).expect("made");
    let empty = ask("empty");
    assert!(
        empty.contains("contains no result") && empty.contains("summary.json (run)") && empty.contains("study.json"),
        "{empty}"
    );
    let parent = ask("");
    assert!(
        parent.contains("did you mean") && parent.contains("wiring-3"),
        "{parent}"
    );
}
