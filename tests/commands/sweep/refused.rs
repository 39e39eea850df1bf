//! What is refused, and what stays as it is.

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use super::common::{AREA, CASE, path, say, swept, table, well};

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
        ("/beam/length_m\nNaN\n", "not a JSON value"),
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
    let negative = path(&dir, "negative.csv");
    fs::write(&negative, "/beam/length_m\n-0.1\n").expect("written");
    for (more, code, word) in [
        (vec![], 2, "no number is varied"),
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
        (vec!["--vary", "/beam/length_m=0.1 m"], 2, "0.1 m is 0.1 here"),
        (
            vec!["--vary", "/beam/length_m=lognormal:1:2", "--design", "latin:3"],
            2,
            "unknown form `lognormal:`. Use lin:LOW:HIGH:COUNT",
        ),
        (
            vec!["--vary", "/beam/length_m=unifrom:1:2"],
            2,
            "did you mean uniform:..?",
        ),
        (
            vec!["--vary", "/beam/length_m=0.1", "--design", "latin:0"],
            2,
            "latin:100",
        ),
        (
            vec!["--vary", "/time/end_s=0.001,0.002"],
            2,
            "no effect, because /time/end_s is varied",
        ),
        (
            vec![
                "--vary",
                "/start/pressures/0/pressure_pa=1,2",
                "--vary",
                "/start/pressures/00/pressure_pa=5",
            ],
            2,
            "`00` is not an array index",
        ),
        (
            vec!["--vary", "/solver/rtol=1e-3,1e-5", "--accuracy", "0.05"],
            2,
            "so that /solver/rtol would have no effect",
        ),
        (vec!["--vary", "/beam/lenght_m=0.1"], 3, "E004"),
        (
            vec!["--vary", "/beam/length_m=0.1,-0.1"],
            3,
            "--> --vary at /beam/length_m",
        ),
        (vec!["--designs", &negative], 3, "--> --designs at /beam/length_m"),
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
        (vec!["--vary", "/beam/length_m=0.1", "--jobs", "0"], 2, "from 1 to 1024"),
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
    // without a signal that repeats, each design is searched for a self-oscillation
    let said = swept(&out, &["--vary", "/beam/length_m=0.1", "--command", "periodic"]);
    assert!(
        said.code == 4 && said.out.contains("no self-oscillation was found"),
        "{} {}",
        said.code,
        said.out
    );
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
        said.code == 2 && said.err.contains("contains another sweep: --vary is"),
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

/// Goal: a part is not written over by the whole that is made of it, not even by force.
#[test]
fn a_part_is_no_place_for_the_whole() {
    let dir = TempDir::new().expect("a folder");
    let parts = ["1", "2"].map(|k| path(&dir, k));
    for (part, shard) in parts.iter().zip(["1/2", "2/2"]) {
        well(&swept(
            part,
            &["--vary", &format!("{AREA}=1e-10,2e-10,3e-10"), "--shard", shard],
        ));
    }
    let before = table(&parts[0]);
    let said = say(&["merge", &parts[0], &parts[1], "--out", &parts[0], "--force"]);
    assert!(
        said.code == 2 && said.err.contains("is one of the shards"),
        "{} {}",
        said.code,
        said.err
    );
    assert_eq!(table(&parts[0]), before);
}

/// Goal: parts that have one design with other figures are refused, with the design, the figure and the folders, and nothing is written; a row
/// that finished takes the place of one that did not, whichever comes first.
#[test]
fn parts_that_differ_are_not_merged() {
    let dir = TempDir::new().expect("a folder");
    let [one, two, whole] = ["one", "two", "whole"].map(|name| path(&dir, name));
    for part in [&one, &two] {
        well(&swept(part, &["--vary", &format!("{AREA}=1e-10,2e-10")]));
    }
    let merge = |whole: &str| say(&["merge", &one, &two, "--lean", "--out", whole]);
    well(&merge(&whole));
    let journal = Path::new(&two).join("designs.jsonl");
    let text = fs::read_to_string(&journal).expect("rows");
    let mut lines: Vec<serde_json::Value> = text.lines().map(|l| serde_json::from_str(l).expect("a row")).collect();
    let second = lines.iter_mut().find(|row| row["number"] == 1).expect("the second");
    let figure = second["figures"][0].clone();
    let put = |rows: &[serde_json::Value]| {
        // rows of a version before checksums
        let bare = rows.iter().cloned().map(|mut row| {
            row.as_object_mut().expect("a row").shift_remove("crc32");
            row
        });
        let text: String = bare.map(|row| format!("{row}\n")).collect();
        fs::write(&journal, text).expect("written");
    };
    second["figures"][0][1] = (1.01 * figure[1].as_f64().expect("a number") + 1.0).into();
    put(&lines);
    let other = path(&dir, "other");
    let said = merge(&other);
    let name = figure[0].as_str().expect("a name");
    assert_eq!(said.code, 2, "{}", said.err);
    for part in ["design 1 is there twice", name, &one, &two] {
        assert!(said.err.contains(part), "{part}: {}", said.err);
    }
    assert!(!Path::new(&other).join("sweep.csv").exists());
    // one that did not finish is no conflict, and gives way
    let second = lines.iter_mut().find(|row| row["number"] == 1).expect("the second");
    second["status"] = "failed".into();
    put(&lines);
    let turned = path(&dir, "turned");
    well(&say(&["merge", &two, &one, "--lean", "--out", &turned]));
    assert_eq!(table(&turned), table(&whole));
}

/// Goal: no name becomes a command of a job script, and none becomes that of another file.
#[test]
fn names_that_no_script_can_hold_are_refused() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt as _;
    let vary = "/beam/length_m=0.1,0.11";
    for kind in ["slurm", "parallel"] {
        for name in [&b"x\ntouch P\n#"[..], b"x\rtouch P", b"bad-\xff"] {
            let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_slcbeam"));
            command.args([
                "sweep", CASE, "--vary", vary, "--script", kind, "--shards", "2", "--out",
            ]);
            let output = command.arg(OsStr::from_bytes(name)).output().expect("it starts");
            let told = String::from_utf8_lossy(&output.stderr).into_owned();
            assert!(
                output.status.code() == Some(2) && output.stdout.is_empty(),
                "{name:?}: {told}"
            );
            let reason = ["must not contain control characters", "cannot be named in a script"];
            assert!(reason.iter().any(|reason| told.contains(reason)), "{told}");
        }
    }
}
