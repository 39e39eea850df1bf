//! Damaged and hostile results, read by every command that reads them.

use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::{answered, read_by_all, told};
use crate::chance::Random;
use crate::program::{CASE, copy, run, slcbeam, stderr};

/// Name, description and count of the numbers of an array.
type Told = (&'static str, String, usize);

/// An archive of arrays with any descriptions.
fn archive(path: &Path, entries: &[Told]) {
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
    let lies: [(&str, Vec<Told>); 9] = [
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
        copy(&sound, &bad);
        archive(&bad.join("fields.npz"), entries);
        let [export, _, compare] = read_by_all(&bad, &sound, what);
        assert_eq!(export, 5, "{what}");
        assert!(compare == 5 || *what == "no arrays but times", "{what}: {compare}");
        let told = stderr(&told(&["export", &bad.display().to_string()]));
        assert!(told.contains("E050") && told.contains("fields.npz"), "{what}: {told}");
    }
}

/// Entries that lie over each other make a small file endless.
#[test]
fn outputs_that_lie_over_each_other_are_refused() {
    let folder = tempfile::tempdir().expect("a place");
    let (sound, bad) = (folder.path().join("sound"), folder.path().join("bad"));
    assert!(run(&sound, &[]).status.success());
    copy(&sound, &bad);
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
    copy(&sound, &bad);
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

/// Each of 27 changes to the history of a run is detected by its checksum in the summary, wherever the history is read; without a checksum,
/// as in results of earlier versions, it is read.
#[test]
fn a_history_that_was_changed_is_refused() {
    let folder = tempfile::tempdir().expect("a place");
    let (sound, bad) = (folder.path().join("sound"), folder.path().join("bad"));
    assert!(run(&sound, &[]).status.success());
    let mut random = Random(14);
    for trial in 0..27 {
        copy(&sound, &bad);
        let path = bad.join("history.csv");
        let mut bytes = fs::read(&path).expect("a history");
        let at = random.below(bytes.len());
        match random.below(4) {
            0 => bytes[at] ^= 1 << random.below(8),
            1 => bytes.truncate(at),
            2 => bytes[at] = if bytes[at] == b'7' { b'8' } else { b'7' },
            _ => drop(bytes.remove(at)),
        }
        fs::write(&path, bytes).expect("it is changed");
        let [_, report, compare] = read_by_all(&bad, &sound, "a changed history");
        assert_eq!([report, compare], [5, 5], "{trial}: byte {at}");
    }
    copy(&sound, &bad);
    let summary = bad.join("summary.json");
    let text = fs::read_to_string(&summary).expect("a summary");
    let mut old: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert!(old.as_object_mut().expect("an object").remove("tables_crc32").is_some());
    fs::write(&summary, old.to_string()).expect("it is changed");
    assert_eq!(read_by_all(&bad, &sound, "an old summary"), [0, 0, 0]);
}

/// What is no file has no end.
#[test]
fn outputs_without_an_end_are_refused() {
    let folder = tempfile::tempdir().expect("a place");
    let (sound, bad) = (folder.path().join("sound"), folder.path().join("bad"));
    assert!(run(&sound, &[]).status.success());
    for name in ["fields.npz", "history.csv", "summary.json", "history.svg"] {
        for endless in ["/dev/zero", "fifo"] {
            copy(&sound, &bad);
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

/// Flips, cuts, overwrites or repeats some bytes.
fn mutate(bytes: &mut Vec<u8>, dice: &mut Random) {
    let at = dice.below(bytes.len());
    match dice.below(5) {
        0 => bytes[at] ^= 1 << dice.below(8),
        1 => bytes.truncate(at),
        2 => {
            let end = (at + 1 + dice.below(16)).min(bytes.len());
            let with = [0, 255, 127, b'9'][dice.below(4)];
            bytes[at..end].fill(with);
        }
        3 => {
            // in a description or in the directory
            let marks = [&b"shape"[..], b"NUMPY", b"PK\x01\x02", b"PK\x03\x04", b"PK\x05\x06"];
            let mark = marks[dice.below(marks.len())];
            let places: Vec<usize> = bytes
                .windows(mark.len())
                .enumerate()
                .filter(|w| w.1 == mark)
                .map(|w| w.0)
                .collect();
            let begin = places.get(dice.below(places.len())).copied().unwrap_or(at);
            let at = (begin + dice.below(48)).min(bytes.len() - 1);
            bytes[at] = [0, 255, b'9', dice.below(256) as u8][dice.below(4)];
        }
        _ => {
            let end = (at + dice.below(400)).min(bytes.len());
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
        .args(["modes", CASE, "--quiet", "--set", "/mesh/cells_per_segment=1", "--out"])
        .arg(&modes)
        .output()
        .expect("it starts");
    assert!(found.status.success(), "{}", stderr(&found));
    let (mut refused, mut taken) = (0, 0);
    for trial in 0..trials {
        let mut dice = Random(trial);
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
        copy(from, &bad);
        let path = bad.join(names[dice.below(names.len())]);
        let mut bytes = fs::read(&path).expect("a file");
        for _ in 0..=dice.below(3) {
            if !bytes.is_empty() {
                mutate(&mut bytes, &mut dice);
            }
        }
        fs::write(&path, bytes).expect("it is changed");
        let what = format!("trial {trial}, {}", path.display());
        let codes = if of_modes {
            vec![answered(&told(&["report", &bad.display().to_string()]), &what)]
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
