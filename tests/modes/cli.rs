//! `slcbeam modes` from outside: exit codes, streams, files.

use std::fs;

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

const SMALL: &str = "cases/two-bladders.json";

/// Exit code, standard output and standard error of the program.
pub fn run(arguments: &[&str]) -> (i32, String, String) {
    let output = Command::cargo_bin("slcbeam").unwrap().args(arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

/// That of `slcbeam modes`.
pub fn modes(arguments: &[&str]) -> (i32, String, String) {
    run(&[&["modes"], arguments].concat())
}

#[test]
fn a_folder_is_filled_and_a_table_printed() {
    let dir = TempDir::new().unwrap();
    let out = dir.path().join("deep/modes");
    let (code, said, error) = modes(&[SMALL, "--count", "5", "--quiet", "--out", out.to_str().unwrap()]);
    assert_eq!((code, error.as_str()), (0, ""), "quiet means silent");
    for word in [
        "oscillation",
        "Hz",
        "undrained",
        "no growth in the",
        "coupling is passive: no cycle",
        out.to_str().unwrap(),
    ] {
        assert!(said.contains(word), "{word}: {said}");
    }
    let csv = fs::read_to_string(out.join("modes.csv")).unwrap();
    assert!(csv.starts_with("mode [1],kind,frequency [Hz],damping ratio [1],growth rate [1/s],"));
    let widths: Vec<usize> = csv.lines().map(|l| l.split(',').count()).collect();
    assert!(widths.iter().all(|w| *w == 16), "{csv}");
    let json: Value = serde_json::from_str(&fs::read_to_string(out.join("modes.json")).unwrap()).unwrap();
    let all = json["modes"].as_array().unwrap();
    assert_eq!(all.len() + 1, csv.lines().count());
    let moving = all.iter().filter(|m| m["kind"] != "volume").count();
    assert_eq!((moving, &json["stable"]), (5, &Value::Bool(true)));
    assert!(json["coupling"]["least_eigenvalue"].as_f64().unwrap() > 0.0);
    let svg = fs::read_to_string(out.join("modes.svg")).unwrap();
    assert!(svg.starts_with("<svg") && svg.contains("two-bladders") && svg.contains("upper row"));
    let mut npz = zip::ZipArchive::new(fs::File::open(out.join("modes.npz")).unwrap()).unwrap();
    let names: Vec<String> = (0..npz.len())
        .map(|k| npz.by_index(k).unwrap().name().unwrap().into_owned())
        .collect();
    for name in [
        "theta_m",
        "u1_amplitude_m",
        "u1_phase_rad",
        "pressure_amplitude_pa",
        "growth_per_s",
    ] {
        assert!(names.contains(&format!("{name}.npy")), "{names:?}");
    }
}

/// Goal: oscillations come first, then decays, and quantities conserved by closed networks take one line. A kind has as many modes as
/// requested, the same as among all.
#[test]
fn modes_stand_by_kind() {
    let dir = TempDir::new().unwrap();
    let out = dir.path().to_str().unwrap();
    let wet = "cases/wiring-2.json";
    let small = [
        "--set",
        "/mesh/cells_per_segment=2",
        "--set",
        "/mesh/cells_per_bladder=1",
        "--quiet",
        "--out",
        out,
    ];
    let with = |more: &[&str]| modes(&[&[wet], more, &small].concat());
    let (code, said, error) = with(&["--count", "6"]);
    assert_eq!((code, error.as_str()), (0, ""));
    assert!(
        said.contains("and with s = 0: 1 kept volume (fluid of closed networks)\n"),
        "{said}"
    );
    let rows = |said: &str| -> Vec<Vec<String>> {
        let lines = said.lines().skip_while(|line| !line.contains("moves")).skip(1);
        let lines = lines.take_while(|line| line.starts_with(|c: char| c.is_ascii_digit() || c == ' '));
        lines
            .map(|line| line.split_whitespace().map(str::to_owned).collect())
            .collect()
    };
    let all = rows(&said);
    assert_eq!(all.len(), 6, "{said}");
    let kinds: Vec<&str> = all.iter().map(|row| row[1].as_str()).collect();
    // oscillations come first, even if decays are slower
    assert_eq!(kinds, ["oscillation"; 6], "{said}");
    let csv = fs::read_to_string(dir.path().join("modes.csv")).unwrap();
    assert!(
        csv.lines().nth(1).unwrap().starts_with("1,oscillation,") && csv.contains("\n7,kept volume,"),
        "{csv}"
    );
    let (code, said, _) = with(&["--count", "4", "--kind", "oscillation"]);
    let swinging = rows(&said);
    assert!(
        code == 0 && swinging.len() == 4 && swinging.iter().all(|row| row[1] == "oscillation"),
        "{said}"
    );
    assert_eq!(
        swinging[..3].iter().map(|row| &row[3]).collect::<Vec<_>>(),
        all[..3].iter().map(|row| &row[3]).collect::<Vec<_>>()
    );
    let (code, said, _) = with(&["--count", "2", "--kind", "growth"]);
    assert!(
        code == 0 && said.contains("there are no modes of the kind growth"),
        "{said}"
    );
    let json: Value = serde_json::from_str(&fs::read_to_string(dir.path().join("modes.json")).unwrap()).unwrap();
    assert_eq!((&json["of_kind"], &json["stable"]), (&"growth".into(), &true.into()));
}

#[test]
fn modes_near_a_frequency_as_json() {
    let dir = TempDir::new().unwrap();
    let out = dir.path().join("m");
    let (code, said, _) = modes(&[
        SMALL,
        "--count",
        "1",
        "--near",
        "70",
        "--json",
        "--out",
        out.to_str().unwrap(),
    ]);
    let json: Value = serde_json::from_str(&said).unwrap();
    assert_eq!(code, 0);
    let frequency = json["modes"][0]["frequency_hz"].as_f64().unwrap();
    assert!((60.0..90.0).contains(&frequency), "{said}");
}

#[test]
fn a_dry_beam_has_no_pressures() {
    let dir = TempDir::new().unwrap();
    let out = dir.path().join("m");
    let (code, said, _) = modes(&["cases/dry-cantilever.json", "--quiet", "--out", out.to_str().unwrap()]);
    assert!(
        code == 0 && !said.contains("undrained") && !said.contains("coupling"),
        "{said}"
    );
    assert!(!fs::read_to_string(out.join("modes.svg")).unwrap().contains("upper row"));
}

#[test]
fn bad_input_is_told() {
    for (arguments, code, words) in [
        (&["--count", "0"][..], 2, "--count 0"),
        (&["--count", "1001"], 2, "from 1 to 1000"),
        (&["--near", "-1"], 2, "--near -1: expected a frequency of 0 Hz or more"),
        (&["--near", "nan"], 2, "expected a frequency in Hz"),
        (&["--at", "-0.5"], 2, "--at -0.5: expected a time of 0 s or more"),
        (&["--set", "/beam/length_m=-1"], 3, "length"),
    ] {
        let said = modes(&[&[SMALL, "--out", "/nowhere/to/write"], arguments].concat());
        assert_eq!(said.0, code, "{arguments:?}: {}", said.2);
        assert!(said.2.contains(words) && said.1.is_empty(), "{arguments:?}: {}", said.2);
    }
    // a folder that cannot be written has its own message
    let said = modes(&[SMALL, "--count", "1", "--out", "/dev/null/modes"]);
    assert_eq!(said.0, 5, "{}", said.2);
}

/// Goal: an accuracy of frequencies and rates is reached on a mesh of its own; text and file contain the estimates.
#[test]
fn an_accuracy_is_reached_or_not() {
    let dir = TempDir::new().unwrap();
    let out = dir.path().to_str().unwrap();
    let asked = [
        "cases/dry-cantilever.json",
        "--count",
        "3",
        "--accuracy",
        "0.01",
        "--quiet",
        "--out",
        out,
    ];
    let (code, said, error) = modes(&asked);
    assert_eq!((code, error.as_str()), (0, ""));
    assert!(said.contains("accuracy 1 % reached"), "{said}");
    let json: Value = serde_json::from_str(&fs::read_to_string(dir.path().join("modes.json")).unwrap()).unwrap();
    let accuracy = &json["accuracy"];
    assert_eq!(accuracy["reached"], true);
    assert!(
        accuracy["quantities"]["across_1_frequency_hz"]["total"]
            .as_f64()
            .unwrap()
            < 0.01
    );
}

/// Goal: the table names the other mesh of the beam, twice the cells if they cannot be halved.
#[test]
fn the_table_names_the_compared_mesh() {
    let dir = TempDir::new().unwrap();
    let said = |cells: &str| {
        let set = format!("/mesh/cells_per_segment={cells}");
        let out = dir.path().join(cells);
        let arguments = [
            "cases/bend-wet.json",
            "--set",
            &set,
            "--count",
            "4",
            "--out",
            out.to_str().unwrap(),
        ];
        modes(&arguments).1
    };
    let (odd, even) = (said("3"), said("2"));
    assert!(
        odd.contains("twice the cells of the beam") && !odd.contains("half"),
        "{odd}"
    );
    assert!(
        even.contains("half the cells of the beam") && !even.contains("twice the cells of the beam"),
        "{even}"
    );
}

/// Goal: `slcbeam response` fills a folder with a table, a diagram and a page, and prints peaks; `export --state-space` writes the
/// matrices.
#[test]
fn responses_have_files_and_a_model() {
    let dir = TempDir::new().unwrap();
    let out = dir.path().join("response");
    let folder = out.to_str().unwrap();
    let of = ["--input", "/ends/root/clamped/u3_m", "--output", "tip_u3,tip_u1_m"];
    let asked = [
        &["response", "cases/wiring-3.json"],
        &of[..],
        &["--to", "110", "--quiet", "--out", folder],
    ]
    .concat();
    let (code, said, error) = run(&asked);
    assert_eq!((code, error.as_str()), (0, ""));
    assert!(
        said.contains("tip_u3_m") && said.contains("damping ratio") && said.contains("poles found in the band"),
        "{said}"
    );
    let json: Value = serde_json::from_str(&fs::read_to_string(out.join("response.json")).unwrap()).unwrap();
    let count = json["frequency_hz"].as_array().unwrap().len();
    for key in ["real", "imag", "error"] {
        assert_eq!(json[key].as_array().unwrap().len(), count, "{key}");
    }
    let near = |pole: &Value| (pole["frequency_hz"].as_f64().unwrap() - 12.165).abs() < 0.01;
    assert!(json["poles"].as_array().unwrap().iter().any(near), "{}", json["poles"]);
    assert_eq!(
        fs::read_to_string(out.join("response.csv")).unwrap().lines().count(),
        count + 1
    );
    assert!(
        fs::read_to_string(out.join("response.svg"))
            .unwrap()
            .contains("frequency response")
    );
    assert!(
        fs::read_to_string(out.join("report.html"))
            .unwrap()
            .contains("Frequency response of small motions")
    );
    let precious = dir.path().join("case.json");
    fs::copy("cases/wiring-3.json", &precious).unwrap();
    let over = [
        "export",
        "cases/wiring-3.json",
        "--force",
        "--state-space",
        precious.to_str().unwrap(),
    ];
    let (code, _, error) = run(&[&over[..], &of[..]].concat());
    assert!(
        code == 2 && error.contains("something else than a state-space model"),
        "{code} {error}"
    );
    assert_eq!(fs::read(&precious).unwrap(), fs::read("cases/wiring-3.json").unwrap());
    let file = dir.path().join("model.npz");
    let export = [
        &["export", "cases/wiring-3.json", "--state-space", file.to_str().unwrap()],
        &of[..],
    ]
    .concat();
    fs::write(&file, "kept").unwrap();
    let (code, _, error) = run(&export);
    assert!(code == 2 && error.contains("--force"), "{code} {error}");
    assert_eq!(fs::read_to_string(&file).unwrap(), "kept");
    let (code, said, error) = run(&[&export[..], &["--force"]].concat());
    assert_eq!((code, error.as_str()), (0, ""));
    assert!(said.contains("second rate of /ends/root/clamped/u3_m"), "{said}");
    let mut npz = zip::ZipArchive::new(fs::File::open(&file).unwrap()).unwrap();
    assert!(
        ["A", "B", "C", "D", "x0"]
            .iter()
            .all(|name| npz.by_name(&format!("{name}.npy")).is_ok())
    );
    // the same matrices for MATLAB: type, rows, columns, no imaginary part, length of the name
    let mat = dir.path().join("model.mat");
    let for_matlab = [
        &["export", "cases/wiring-3.json", "--state-space", mat.to_str().unwrap()],
        &of[..],
    ]
    .concat();
    assert_eq!(run(&for_matlab).0, 0);
    let bytes = fs::read(&mat).unwrap();
    let integer = |k: usize| u32::from_le_bytes(bytes[4 * k..4 * k + 4].try_into().unwrap()) as usize;
    let states = integer(1);
    assert_eq!([0, 2, 3, 4].map(integer), [0, states, 0, 2]);
    assert_eq!(&bytes[20..22], b"A\0");
    let mut a = vec![];
    std::io::Read::read_to_end(&mut npz.by_name("A.npy").unwrap(), &mut a).unwrap();
    let entry = |bytes: &[u8], place: usize| f64::from_le_bytes(bytes[place..place + 8].try_into().unwrap());
    let start = a.len() - 8 * states * states;
    for (row, column) in [(0, 1), (1, 0), (2, 5), (states - 1, 3)] {
        assert_eq!(
            entry(&bytes, 22 + 8 * (column * states + row)),
            entry(&a, start + 8 * (row * states + column))
        );
    }
    // a model of small motions holds the outputs of controllers, and says so
    let held = dir.path().join("held.json");
    let of_controlled = ["--input", "/attachments/0/force_x_n", "--output", "tip_u1"];
    let controlled = [
        "export",
        "cases/regulated-actuator.json",
        "--no-self-test",
        "--state-space",
    ];
    let (code, said, _) = run(&[&controlled[..], &[held.to_str().unwrap()], &of_controlled].concat());
    assert!(code == 0 && said.contains("W044"), "{code} {said}");
    // at zero flow an opening has no effect, and rounding errors give no peaks
    let nothing = dir.path().join("nothing");
    let (code, said, _) = run(&[
        "response",
        "cases/network-tour.json",
        "--input",
        "/network/tubes/2/opening",
        "--output",
        "tip_u1",
        "--quiet",
        "--out",
        nothing.to_str().unwrap(),
    ]);
    assert!(code == 0 && said.contains("none"), "{code} {said}");
    for (wrong, what) in [
        (
            vec!["--input", "/ends/root", "--output", "tip_u1"],
            "its signals are /ends/root/clamped/u3_m",
        ),
        (
            vec!["--input", "/ends/root/clamped/u3_m", "--output", "tip"],
            "nearest is tip_u3_m",
        ),
        (
            vec![
                "--input",
                "/ends/root/clamped/u3_m",
                "--output",
                "tip_u1",
                "--from",
                "9",
                "--to",
                "3",
            ],
            "--from 9 --to 3",
        ),
    ] {
        let nowhere = dir.path().join("nowhere");
        let (code, _, error) = run(&[
            &["response", "cases/wiring-3.json", "--out", nowhere.to_str().unwrap()],
            &wrong[..],
        ]
        .concat());
        assert!(code == 2 && error.contains(what) && !nowhere.exists(), "{code} {error}");
    }
}
