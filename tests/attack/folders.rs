//! Folders of others, and of another process.

use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

use crate::program::{CASE, contents, run, slcbeam, stderr, unchanged};

const COMMANDS: [&[&str]; 6] = [
    &["run"],
    &["equilibrium"],
    &["modes", "--count", "2"],
    &["study", "--budget", "1s"],
    &["effects", "--budget", "1s"],
    &["periodic"],
];

fn into(command: &[&str], case: &Path, out: &Path, more: &[&str]) -> std::process::Output {
    slcbeam()
        .args(&command[..1])
        .arg(case)
        .args(&command[1..])
        .args(["--quiet", "--set", "/time/end_s=0.01"])
        .args(more)
        .arg("--out")
        .arg(out)
        .output()
        .expect("it starts")
}

/// Every command leaves a folder alone that holds a case and notes of the user.
#[test]
fn no_command_writes_into_a_folder_of_the_user() {
    let folder = tempfile::tempdir().expect("a place");
    let case = folder.path().join("case.json");
    fs::copy("cases/two-bladders.json", &case).expect("a case");
    fs::write(folder.path().join("notes.txt"), "mine").expect("notes");
    let before = contents(folder.path());
    for command in COMMANDS {
        let output = into(command, &case, folder.path(), &[]);
        assert!(!output.status.success(), "{command:?}");
        assert!(stderr(&output).contains("name another folder"), "{}", stderr(&output));
        unchanged(folder.path(), &before, &format!("{command:?}"));
        // not even by force over the case itself
        let output = into(command, &case, folder.path(), &["--force"]);
        assert_eq!(output.status.code(), Some(2), "{command:?}: {}", stderr(&output));
        unchanged(folder.path(), &before, &format!("{command:?} by force"));
    }
}

/// A command leaves the result of another alone, and takes it when told to.
#[test]
fn results_of_other_commands_stay() {
    let folder = tempfile::tempdir().expect("a place");
    let case = Path::new("cases/two-bladders.json");
    let out = folder.path().join("result");
    assert!(into(&["run"], case, &out, &[]).status.success());
    let before = contents(&out);
    for command in &COMMANDS[1..] {
        let output = into(command, case, &out, &[]);
        assert_eq!(output.status.code(), Some(5), "{command:?}");
        assert!(
            stderr(&output).contains("it holds the result of `slcbeam run`"),
            "{}",
            stderr(&output)
        );
        unchanged(&out, &before, &format!("{command:?}"));
    }
    assert!(into(COMMANDS[2], case, &out, &["--force"]).status.success());
    assert!(out.join("modes.json").exists() && !out.join("summary.json").exists());
    assert!(
        !out.join("fields.npz").exists(),
        "nothing of the run is left to be taken for modes"
    );
    // and its own again, without being told
    assert!(into(COMMANDS[2], case, &out, &[]).status.success());
}

/// Of two runs in one folder the second is refused, and told whose it is; a lock that was left by a killed one holds nobody up.
#[test]
fn two_runs_do_not_mix() {
    let folder = tempfile::tempdir().expect("a place");
    let out = folder.path().join("one");
    let mut first = slcbeam()
        .args(["run", CASE, "--quiet", "--set", "/time/end_s=1000"])
        // few rows, so that they fit on any disk
        .args([
            "--set",
            "/time/output_interval_s=0.1",
            "--set",
            "/time/fields_interval_s=0.1",
            "--out",
        ])
        .arg(&out)
        .stdout(Stdio::null())
        .spawn()
        .expect("it starts");
    let deadline = Instant::now() + Duration::from_secs(60);
    while !out.join("history.csv").exists() {
        assert!(Instant::now() < deadline, "no history within a minute");
        std::thread::sleep(Duration::from_millis(5));
    }
    for more in [&[][..], &["--force"][..], &["--resume"][..], &["--accuracy", "0.1"][..]] {
        let second = run(&out, more);
        let told = stderr(&second);
        assert_eq!(second.status.code(), Some(5), "{more:?}: {told}");
        assert!(
            told.contains(&format!("process {} on ", first.id())),
            "{more:?}: {told}"
        );
    }
    first.kill().expect("it is killed");
    first.wait().expect("it ends");
    assert!(out.join(".slcbeam.lock").exists(), "a killed run leaves its file");
    let third = run(&out, &[]);
    assert!(third.status.success(), "{}", stderr(&third));
    assert!(!out.join(".slcbeam.lock").exists());
}

/// `--accuracy` works inside its folder: what lies beside it is not its own.
#[test]
fn an_accuracy_takes_no_folder_beside() {
    let folder = tempfile::tempdir().expect("a place");
    let beside = folder.path().join("x.next");
    fs::create_dir(&beside).expect("a folder");
    fs::write(
        beside.join("summary.json"),
        "{\"case\": \"mine\", \"status\": \"finished\"}",
    )
    .expect("a file");
    let before = contents(&beside);
    let out = folder.path().join("x");
    let output = run(
        &out,
        &["--accuracy", "0.1", "--set", "/time/checkpoint_interval_s=null"],
    );
    assert!(output.status.success(), "{}", stderr(&output));
    unchanged(&beside, &before, "left alone");
    let left: Vec<_> = contents(&out)
        .into_iter()
        .map(|f| f.0)
        .filter(|n| n.starts_with('.'))
        .collect();
    assert_eq!(left, [".slcbeam.case"]);
}

/// What a killed process had half written goes with the next run; what a user keeps hidden stays.
#[test]
fn halves_are_swept() {
    let folder = tempfile::tempdir().expect("a place");
    let out = folder.path().join("x");
    assert!(run(&out, &[]).status.success());
    for half in [".summary.json.123.part", ".fields.npz.99.part"] {
        fs::write(out.join(half), "half").expect("a file");
    }
    fs::create_dir(out.join(".next-abc")).expect("a folder");
    fs::write(out.join(".next-abc/history.csv"), "t [s]").expect("a file");
    fs::write(out.join(".notes.part"), "mine").expect("a file");
    assert!(run(&out, &[]).status.success());
    let hidden: Vec<_> = contents(&out)
        .into_iter()
        .map(|f| f.0)
        .filter(|n| n.starts_with('.'))
        .collect();
    assert_eq!(hidden, [".notes.part", ".slcbeam.case"]);
}

/// A run that was killed before its first row does not hold up the next.
#[test]
fn an_empty_history_is_no_obstacle() {
    let folder = tempfile::tempdir().expect("a place");
    let out = folder.path().join("x");
    fs::create_dir(&out).expect("a folder");
    fs::write(out.join("history.csv"), "").expect("a file");
    assert!(run(&out, &[]).status.success());
}

/// Tables and films of one result do not come to lie in another.
#[test]
fn exports_stay_out_of_other_results() {
    let folder = tempfile::tempdir().expect("a place");
    let (a, b) = (folder.path().join("a"), folder.path().join("b"));
    assert!(run(&a, &[]).status.success() && run(&b, &[]).status.success());
    let before = contents(&b);
    let export = |out: &Path| {
        slcbeam()
            .arg("export")
            .arg(&a)
            .arg("--out")
            .arg(out)
            .output()
            .expect("it starts")
    };
    let refused = export(&b);
    assert_eq!(refused.status.code(), Some(2), "{}", stderr(&refused));
    unchanged(&b, &before, "export");
    for out in [&a, &folder.path().join("new")] {
        let output = export(out);
        assert!(output.status.success(), "{}", stderr(&output));
    }
}

/// A page or picture takes the place of another, and of nothing else; a case that was changed by hand is not written over either, nor
/// one that lies where an older result's files go.
#[test]
fn files_of_the_user_are_not_written_over() {
    let folder = tempfile::tempdir().expect("a place");
    let out = folder.path().join("x");
    assert!(run(&out, &[]).status.success());
    let before = contents(&out);
    for file in ["case.json", "fields.npz", "history.csv", "summary.json"] {
        for command in ["report", "compare"] {
            let mut asked = slcbeam();
            asked.arg(command).arg(&out);
            if command == "compare" {
                asked.arg(&out);
            }
            let output = asked.arg("--out").arg(out.join(file)).output().expect("it starts");
            assert_eq!(output.status.code(), Some(5), "{command} {file}: {}", stderr(&output));
        }
    }
    unchanged(&out, &before, "pages and pictures");
    let page = folder.path().join("page.html");
    for _ in 0..2 {
        let output = slcbeam()
            .arg("report")
            .arg(&out)
            .arg("--out")
            .arg(&page)
            .output()
            .expect("it starts");
        assert!(output.status.success(), "{}", stderr(&output));
    }
    let again = |case: &Path| {
        slcbeam()
            .arg("run")
            .arg(case)
            .args(["--quiet", "--force", "--out"])
            .arg(&out)
            .output()
            .expect("it starts")
    };
    let case = out.join("case.json");
    assert!(again(&case).status.success(), "a result's own case, as it is");
    let text = fs::read_to_string(&case).expect("a case");
    fs::write(&case, format!("\n{text}")).expect("it is changed");
    let below = out.join("fields.part/c.json");
    fs::create_dir_all(out.join("fields.part")).expect("a folder");
    fs::copy(&case, &below).expect("a case");
    for case in [&case, &below] {
        let kept = fs::read(case).expect("a case");
        let refused = again(case);
        assert_eq!(refused.status.code(), Some(2), "{}", stderr(&refused));
        assert_eq!(fs::read(case).expect("a case"), kept);
    }
}

/// A file in the way is a message, not a loss.
#[test]
fn a_file_in_place_of_the_folder_stays() {
    let mut file = tempfile::NamedTempFile::new().expect("a file");
    file.write_all(b"mine").expect("it is written");
    let output = run(file.path(), &[]);
    assert_eq!(output.status.code(), Some(5));
    assert_eq!(fs::read(file.path()).expect("it is read"), b"mine");
}

/// Goal: nothing is written through a symbolic link that lies in place of a file of a result, and files that a kill left half written are
/// removed by the next command in the folder, those of other commands and of pages too.
#[test]
fn links_are_replaced_and_leftovers_removed() {
    use slcbeam::output::folder::{ResultFolder, replace};
    use slcbeam::output::kind::FolderKind;
    let place = tempfile::tempdir().expect("a place");
    let (out, outside) = (place.path().join("out"), place.path().join("outside"));
    fs::create_dir(&outside).expect("a folder");
    fs::create_dir(&out).expect("a folder");
    let links = [
        "history.csv",
        "summary.json",
        "case.json",
        "fields.npz",
        "report.html",
        ".slcbeam.lock",
        "history.svg",
    ];
    for name in links {
        fs::write(
            outside.join(name),
            if name == "history.csv" {
                "t [s]\n"
            } else {
                "{\"case\": \"x\"}"
            },
        )
        .expect("a file");
        std::os::unix::fs::symlink(outside.join(name), out.join(name)).expect("a link");
    }
    for name in [
        ".report.html.4000001.part",
        ".optimum.json.4000002.part",
        ".history.csv.7.part",
        ".origin.7.part",
    ] {
        fs::write(out.join(name), "half").expect("a file");
    }
    let before = contents(&outside);
    let output = run(&out, &[]);
    assert!(output.status.success(), "{}", stderr(&output));
    unchanged(&outside, &before, "what links point to");
    for name in links.into_iter().filter(|name| *name != ".slcbeam.lock") {
        assert!(
            fs::symlink_metadata(out.join(name)).expect("a file").is_file(),
            "{name}"
        );
    }
    let left: Vec<String> = contents(&out).into_iter().map(|file| file.0).collect();
    // a file that no command writes under this name is somebody else's
    assert_eq!(
        left.iter().filter(|name| name.ends_with(".part")).collect::<Vec<_>>(),
        [".origin.7.part"]
    );
    drop(ResultFolder::claim(&out, FolderKind::Run, false).expect("a folder"));
    // a file that the user names is written through a link, on purpose
    let (link, target) = (place.path().join("link.json"), place.path().join("target.json"));
    fs::write(&target, "old").expect("a file");
    std::os::unix::fs::symlink(&target, &link).expect("a link");
    replace(&link, "new").expect("written");
    assert_eq!(fs::read_to_string(&target).expect("a file"), "new");
}
