//! Many designs: memory, kills at any instant. Minutes, so that they are asked for: `cargo test --release --test commands -- --ignored large`.

use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::thread;
use std::time::Duration;

use tempfile::TempDir;

use super::common::{AREA, CASE, SHORT, command, path, rows, swept, table, well};

/// Goal: killed ten times at instants of all kinds, a sweep ends with the table of one that was left alone.
#[test]
#[ignore = "half a minute"]
fn ten_kills_leave_the_table() {
    let dir = TempDir::new().expect("a folder");
    let vary = format!("{AREA}=log:1e-10:1e-9:300");
    let options = ["--vary", &vary, "--set", "/time/end_s=0.004"];
    let (whole, out) = (path(&dir, "whole"), path(&dir, "killed"));
    well(&swept(&whole, &options));
    let all = [
        &["sweep", CASE, "--quiet", "--lean", "--out", &out],
        &SHORT[..],
        &options,
    ]
    .concat();
    let (mut kills, mut state) = (0, 88_172_645_463_325_252_u64);
    while kills < 10 {
        let mut child = command(&all)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("a program");
        // xorshift: 5 to 200 ms
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        thread::sleep(Duration::from_micros(5_000 + state % 195_000));
        if child.try_wait().expect("a child").is_some() {
            break;
        }
        child.kill().expect("killed");
        child.wait().expect("ended");
        kills += 1;
    }
    assert!(kills > 5, "{kills}");
    well(&swept(&out, &options));
    assert_eq!(table(&out), table(&whole));
    // none was computed twice
    let journal = fs::read_to_string(Path::new(&out).join("designs.jsonl")).expect("lines");
    assert_eq!((journal.lines().count(), rows(&out).len()), (300, 300));
}

/// Goal: ten thousand designs need the memory of a thousand.
#[test]
#[ignore = "a minute"]
fn memory_does_not_grow_with_designs() {
    let dir = TempDir::new().expect("a folder");
    let most = |designs: usize| -> u64 {
        let out = path(&dir, &designs.to_string());
        let vary = format!("{AREA}=lin:1e-10:1e-9:{designs}");
        let all = [
            "sweep",
            CASE,
            "--quiet",
            "--lean",
            "--out",
            &out,
            "--command",
            "equilibrium",
            "--vary",
            &vary,
        ];
        let mut child = command(&all).stdout(Stdio::null()).spawn().expect("a program");
        let status = format!("/proc/{}/status", child.id());
        let mut kib = 0;
        while child.try_wait().expect("a child").is_none() {
            let text = fs::read_to_string(&status).unwrap_or_default();
            let high = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
            let number = high.and_then(|text| text.trim().strip_suffix(" kB")?.parse().ok());
            kib = number.unwrap_or(0).max(kib);
            thread::sleep(Duration::from_millis(5));
        }
        assert_eq!(rows(&out).len(), designs);
        kib
    };
    let (some, many) = (most(1000), most(10_000));
    println!("1000 designs: {some} KiB, 10 000 designs: {many} KiB");
    assert!(some > 5_000 && many < some + some / 10, "{some} {many}");
}
