//! Going on with what is another's, cut short, or of another program.

use std::fs;

use crate::program::{contents, killed, run_long, same, stderr, unchanged};

/// A resume with a number forgotten is refused, says which, and touches nothing; the right one goes on to the same end.
#[test]
fn a_refused_resume_touches_nothing() {
    let folder = tempfile::tempdir().expect("a place");
    let (whole, out) = (folder.path().join("whole"), folder.path().join("x"));
    assert!(run_long(&whole, &[]).status.success());
    killed(&out);
    let before = contents(&out);
    for (set, told) in [
        ("/mesh/cells_per_segment=2", "/mesh/cells_per_segment is 1"),
        ("/beam/young_modulus_pa=1e6", "/beam/young_modulus_pa is "),
        ("/time/output_interval_s=0.0005", "/time/output_interval_s is 0.001"),
    ] {
        let refused = run_long(&out, &["--resume", "--set", set]);
        assert_eq!(refused.status.code(), Some(2), "{}", stderr(&refused));
        assert!(stderr(&refused).contains(told), "{}", stderr(&refused));
        unchanged(&out, &before, set);
    }
    let output = run_long(&out, &["--resume"]);
    assert!(output.status.success(), "{}", stderr(&output));
    same(&whole, &out).expect("the same end");
    // once more: it has ended, which is no fault
    let again = run_long(&out, &["--resume"]);
    assert!(
        again.status.success() && stderr(&again).contains("nothing to resume"),
        "{}",
        stderr(&again)
    );
    let other = run_long(&out, &["--resume", "--set", "/beam/young_modulus_pa=1e6"]);
    assert_eq!(other.status.code(), Some(2), "{}", stderr(&other));
}

/// Streams that are shorter than the checkpoint says are not filled up.
#[test]
fn streams_cut_short_are_refused_by_name() {
    let folder = tempfile::tempdir().expect("a place");
    let out = folder.path().join("x");
    killed(&out);
    let raw = fs::read_dir(out.join("fields.part")).expect("raw fields");
    let mut names: Vec<String> = raw
        .map(|e| format!("fields.part/{}", e.expect("a file").file_name().to_string_lossy()))
        .collect();
    names.push("history.csv".into());
    assert!(names.len() > 5, "{names:?}");
    for name in &names {
        let whole = fs::read(out.join(name)).expect("a file");
        fs::write(out.join(name), &whole[..whole.len() / 2]).expect("it is cut");
        let before = contents(&out);
        let refused = run_long(&out, &["--resume"]);
        assert_eq!(refused.status.code(), Some(5), "{name}");
        assert!(stderr(&refused).contains(name.as_str()), "{name}: {}", stderr(&refused));
        unchanged(&out, &before, name);
        fs::write(out.join(name), whole).expect("it is mended");
    }
    assert!(run_long(&out, &["--resume"]).status.success());
}

/// A checkpoint that is torn or of another build is told; the one before takes its place where it is sound.
#[test]
fn of_two_checkpoints_one_is_enough() {
    let folder = tempfile::tempdir().expect("a place");
    let (whole, out) = (folder.path().join("whole"), folder.path().join("x"));
    assert!(run_long(&whole, &[]).status.success());
    killed(&out);
    let path = out.join("checkpoint.json");
    let text = fs::read(&path).expect("a checkpoint");
    fs::write(&path, &text[..text.len() / 3]).expect("it is torn");
    let output = run_long(&out, &["--resume"]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(
        stderr(&output).contains("going on from the one before"),
        "{}",
        stderr(&output)
    );
    same(&whole, &out).expect("the same end");
}

#[test]
fn another_build_does_not_go_on() {
    let folder = tempfile::tempdir().expect("a place");
    let out = folder.path().join("x");
    killed(&out);
    for name in ["checkpoint.json", "checkpoint-before.json"] {
        let path = out.join(name);
        let text = fs::read_to_string(&path).expect("a checkpoint");
        let (heading, body) = text.split_once('\n').expect("two lines");
        let mut heading: serde_json::Value = serde_json::from_str(heading).expect("JSON");
        heading["build"] = "0.1.0 1 00000000".into();
        fs::write(&path, format!("{heading}\n{body}")).expect("it is changed");
    }
    let before = contents(&out);
    let refused = run_long(&out, &["--resume"]);
    assert_eq!(refused.status.code(), Some(5), "{}", stderr(&refused));
    assert!(stderr(&refused).contains("another build"), "{}", stderr(&refused));
    unchanged(&out, &before, "left alone");
}
