//! Words of others on the way to the terminal, and words of the command line.

use std::fs;
use std::os::unix::ffi::OsStrExt as _;
use std::process::Output;

use serde_json::{Value, json};

use super::{beam, check, folder, put, stdout};
use crate::program::{slcbeam, stderr};

/// What a terminal would obey or be turned by.
const ORDERS: &str = "\u{1b}]0;owned\u{7}\u{9b}31m\u{202e}\u{2066}";

#[track_caller]
fn harmless(output: &Output, what: &str) {
    for text in [stdout(output), stderr(output)] {
        let orders = |c: &char| ORDERS.contains(*c) && !c.is_ascii_alphanumeric() && !"];".contains(*c);
        assert_eq!(text.chars().find(orders), None, "{what}: {text:?}");
    }
}

/// Goal: words of a case, names, keys, headings and file names are seen, not obeyed.
#[test]
fn words_of_others_are_not_obeyed() {
    let dir = folder();
    let mut case = beam();
    case["about"] = ORDERS.into();
    let good = put(dir.path(), &case);
    for more in [&[][..], &["--json"]] {
        let answer = check(&good, more);
        assert!(answer.status.success());
        harmless(&answer, "about");
    }
    let text = stdout(&check(&good, &[]));
    assert!(text.contains("\\u001b]0;owned\\u0007"), "about is not shown: {text}");
    let told: Value = serde_json::from_slice(&check(&good, &["--json"]).stdout).expect("still JSON");
    assert_eq!(told["case"], "dry");

    let mut faulty: Vec<(&str, Value)> = vec![];
    for key in ["name", "preset", "formulation"] {
        let mut case = beam();
        case[key] = ORDERS.into();
        faulty.push((key, case));
    }
    let mut keyed = beam();
    keyed[ORDERS] = json!(1);
    faulty.push(("a key", keyed));
    let mut headed = beam();
    let table = json!({"csv": "headed.csv", "time_column": "none"});
    fs::write(dir.path().join("headed.csv"), format!("t,{}\n0,1\n", ORDERS)).expect("a table");
    headed["loads"] = json!([{"force_x_n_m": {"signal": {"table": table}}}]);
    faulty.push(("a heading", headed));
    let mut lost = beam();
    lost["loads"] = json!([{"force_x_n_m": {"signal": {"table": {"csv": format!("{ORDERS}.csv")}}}}]);
    faulty.push(("a lost table", lost));
    for (what, case) in faulty {
        let path = put(dir.path(), &case);
        for more in [&[][..], &["--json"]] {
            let answer = check(&path, more);
            assert_eq!(answer.status.code(), Some(3), "{what}");
            harmless(&answer, what);
        }
    }

    let named = dir
        .path()
        .join(std::ffi::OsStr::from_bytes(ORDERS.replace('/', "").as_bytes()));
    harmless(&check(&named, &["--json"]), "a lost file");
    fs::write(&named, "{").expect("a case");
    harmless(&check(&named, &[]), "a file name");
    fs::write(&named, beam().to_string()).expect("a case");
    let out = dir.path().join(format!("out{ORDERS}"));
    let run = slcbeam()
        .arg("run")
        .arg(&named)
        .arg("--quiet")
        .arg("--out")
        .arg(&out)
        .output()
        .expect("it starts");
    assert_eq!(run.status.code(), Some(2), "{}", stderr(&run));
    harmless(&run, "a folder's name");
    assert!(!out.exists());
    for arguments in [
        vec!["report"],
        vec!["explain"],
        vec!["check", "--set"],
        vec!["run", "--bogus"],
    ] {
        let answer = slcbeam().args(&arguments).arg(ORDERS).output().expect("it starts");
        harmless(&answer, arguments[0]);
    }
}

/// Goal: a script that asks for JSON gets some, whatever is wrong with the command line.
#[test]
fn usage_errors_answer_scripts() {
    for arguments in [
        vec!["run", "--json"],
        vec!["check", "x.json", "--json", "--bogus"],
        vec!["--json"],
        vec!["frobnicate", "--json"],
        vec!["run", "cases/wiring-2.json", "--max-wall", "nan", "--json"],
        vec!["check", "cases/none.json", "--json"],
    ] {
        let answer = slcbeam().args(&arguments).output().expect("it starts");
        assert_eq!(answer.status.code(), Some(2), "{arguments:?}");
        let told: Value = serde_json::from_slice(&answer.stdout).expect("JSON");
        assert_eq!(
            (&told["exit_code"], &told["code"]),
            (&json!(2), &json!("E030")),
            "{arguments:?}"
        );
        assert_eq!(told["status"], "failed");
        assert!(told["what"].as_str().is_some_and(|w| !w.is_empty()));
    }
    let help = slcbeam().args(["run", "--help", "--json"]).output().expect("it starts");
    assert!(help.status.success() && stdout(&help).contains("Usage"));
}
