//! Single bits that flip in what is read back.

use std::fs;
use std::path::{Path, PathBuf};

use crate::program::{copy, killed, run_long, same, stderr};

/// Files that a resume reads.
fn read_back(out: &Path) -> Vec<PathBuf> {
    let mut all = vec![out.join("checkpoint.json"), out.join("history.csv")];
    let raw = fs::read_dir(out.join("fields.part")).expect("raw fields");
    all.extend(raw.map(|e| e.expect("a file").path()));
    all.sort();
    all
}

/// Flips `count` bits, one a trial, spread over all files, and resumes: refused, or the same end.
fn flip(count: u64) {
    let folder = tempfile::tempdir().expect("a place");
    let (whole, begun) = (folder.path().join("whole"), folder.path().join("begun"));
    assert!(run_long(&whole, &[]).status.success());
    killed(&begun);
    let mut refused = 0;
    for trial in 0..count {
        let out = folder.path().join(format!("trial-{trial}"));
        copy(&begun, &out);
        let files = read_back(&out);
        let path = &files[trial as usize % files.len()];
        let mut bytes = fs::read(path).expect("a file");
        // places and bits spread by the golden ratio
        let bit = (trial.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 11) % (8 * bytes.len() as u64);
        bytes[(bit / 8) as usize] ^= 1 << (bit % 8);
        fs::write(path, bytes).expect("it is changed");
        let output = run_long(&out, &["--resume"]);
        if output.status.success() {
            if let Err(why) = same(&whole, &out) {
                panic!(
                    "bit {bit} of {}: {why}, without a word; {}",
                    path.display(),
                    stderr(&output)
                );
            }
        } else {
            assert_eq!(
                output.status.code(),
                Some(5),
                "bit {bit} of {}: {}",
                path.display(),
                stderr(&output)
            );
            refused += 1;
        }
        fs::remove_dir_all(&out).expect("it is removed");
    }
    println!("{count} bits flipped: {refused} refused, {} harmless", count - refused);
}

#[test]
fn flipped_bits_are_refused_or_harmless() {
    flip(26);
}

#[test]
#[ignore = "half a minute"]
fn two_hundred_flipped_bits_are_refused_or_harmless() {
    flip(200);
}
