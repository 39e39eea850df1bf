//! `slcbeam equilibrium` from outside.

use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

fn slcbeam(arguments: &[&str], out: &Path) -> std::process::Output {
    let mut command = Command::cargo_bin("slcbeam").expect("the program");
    command
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(arguments)
        .arg("--out")
        .arg(out)
        .arg("--quiet");
    command.output().expect("it runs")
}

/// Goal: the command writes table, shapes, numbers and diagram, and reports the path on standard output.
#[test]
fn command_fills_its_folder() {
    let out = tempfile::tempdir().expect("a folder");
    let run = slcbeam(
        &[
            "equilibrium",
            "cases/elastica.json",
            "--at",
            "0",
            "--sensitivity",
            "/beam/young_modulus_pa",
        ],
        out.path(),
    );
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let text = String::from_utf8_lossy(&run.stdout);
    for word in [
        "bifurcation",
        "stable",
        "derivatives by /beam/young_modulus_pa",
        "files in",
    ] {
        assert!(text.contains(word), "{word}: {text}");
    }
    for file in ["path.csv", "shapes.csv", "equilibrium.json", "path.svg", "case.json"] {
        assert!(out.path().join(file).exists(), "{file}");
    }
    let json = std::fs::read_to_string(out.path().join("equilibrium.json")).expect("a file");
    let json: Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(json["status"], "finished");
    assert!(json["stability"]["stable"].as_bool().expect("a verdict"));
    assert!(json["quantities"]["tip_u1_m"].as_f64().expect("a number") > 0.5);
    let table = std::fs::read_to_string(out.path().join("path.csv")).expect("a file");
    let head = "load_factor [1],tip_u1 [m],tip_u3 [m],tip_angle [rad],axial_energy [J],bending_energy [J],bladder_energy [J],reaction_root_x [N],reaction_root_z [N],reaction_root_couple [N m],unstable_modes [1]";
    assert_eq!(table.lines().next(), Some(head));
}

/// Goal: a figure that is nearly zero compared with others of its kind is judged relative to them. Under suction, the largest cell pressure
/// beside an open port tends to zero with more cells, so that no mesh would suffice.
#[test]
fn next_to_nothing_is_judged_beside_its_kind() {
    let out = tempfile::tempdir().expect("a folder");
    let suck = [
        "equilibrium",
        "cases/tour-actuator.json",
        "--set",
        "/network/chains/0/ends/0={\"pressure_pa\":-20000}",
        "--set",
        "/network/chains/1/ends/0={\"pressure_pa\":-10000}",
    ];
    for more in [&[][..], &["--accuracy", "0.05"]] {
        let run = slcbeam(&[&suck[..], more].concat(), out.path());
        let text = [run.stdout, run.stderr].concat();
        let text = String::from_utf8_lossy(&text);
        assert!(
            run.status.success() && !text.contains("max_pressure has a relative error"),
            "{text}"
        );
        assert!(!text.contains("is not reached"), "{text}");
    }
}

/// Goal: files, text and page include the stages.
#[test]
fn command_tells_stages() {
    let out = tempfile::tempdir().expect("a folder");
    let run = slcbeam(
        &["equilibrium", "cases/snap-strip.json", "--via", "-2,-1,0"],
        out.path(),
    );
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let text = String::from_utf8_lossy(&run.stdout);
    assert!(
        text.contains("of stage 4: limit point") && text.contains("1.00000 of stage 4"),
        "{text}"
    );
    let read = |name: &str| std::fs::read_to_string(out.path().join(name)).expect("a file");
    let json: Value = serde_json::from_str(&read("equilibrium.json")).expect("JSON");
    assert_eq!(
        (&json["load_factor"], &json["via_s"]),
        (&4.0.into(), &serde_json::json!([-2.0, -1.0, 0.0]))
    );
    assert_eq!(json["events"][0]["stage"], 4);
    let table = read("path.csv");
    let head = table.lines().next().expect("a heading");
    assert!(head.ends_with("unstable_modes [1],stage [1]"), "{head}");
    assert!(table.lines().last().expect("a row").ends_with(",4"));
    assert!(read("path.svg").contains("loads at t = -2 s, -1 s, 0 s, 1 s, one after the other"));
}

/// Goal: an accuracy is reached on a mesh of its own; file and text contain the estimates.
#[test]
fn command_refines_until_it_is_accurate() {
    let out = tempfile::tempdir().expect("a folder");
    let run = slcbeam(
        &["equilibrium", "cases/elastica.json", "--at", "0", "--accuracy", "0.01"],
        out.path(),
    );
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    assert!(String::from_utf8_lossy(&run.stdout).contains("accuracy 1 % reached"));
    let json = std::fs::read_to_string(out.path().join("equilibrium.json")).expect("a file");
    let json: Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(json["accuracy"]["reached"], true);
    assert!(
        json["accuracy"]["quantities"]["tip_u1"]["total"]
            .as_f64()
            .expect("a number")
            < 0.01
    );
}

/// Goal: if fluid settles later than the run ends, every command for states at rest warns with its time constant, that of the slowest mode:
/// 5.54 s with open valves, 1e7 times that almost closed. A longer run needs no warning.
#[test]
fn fluid_that_comes_to_rest_late_is_told() {
    let dir = tempfile::tempdir().expect("a folder");
    let say = |command: &str, more: &[&str]| {
        let out = dir.path().join(command);
        let coarse = [
            "--set",
            "/mesh/cells_per_segment=1",
            "--set",
            "/mesh/cells_per_bladder=1",
        ];
        let mut asked = assert_cmd::Command::cargo_bin("slcbeam").expect("built");
        asked
            .args([command, "cases/tour-actuator.json"])
            .args(coarse)
            .args(more);
        if command != "check" {
            asked.args(["--quiet", "--force", "--out"]).arg(out);
        }
        let said = asked.output().expect("runs");
        assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
        String::from_utf8_lossy(&said.stdout).into_owned()
    };
    let shut = ["--set", "/network/permeability_factor=1e-7"];
    for command in ["equilibrium", "check"] {
        let told = say(command, &shut);
        assert!(
            told.contains("W037 the slowest flow of the network (time constant 641 days, mainly between ")
                && told.contains("lags by 100 % at 1.5 s"),
            "{told}"
        );
        assert!(say(command, &[]).contains("W037 the slowest flow of the network (time constant 5.54 s, "));
        // ten seconds leave a sixth, twenty almost nothing; a steadily rising pressure is followed with a lag
        let ten = say(command, &["--set", "/time/end_s=10"]);
        assert!(ten.contains("lags by 17 % at 10 s"), "{ten}");
        let slow = [
            "--set",
            "/time/end_s=20",
            "--set",
            "/network/chains/0/ends/0/pressure_pa/ramp/duration_s=20",
        ];
        let slow = say(command, &slow);
        assert!(slow.contains("lags by 21 % at 20 s"), "{slow}");
        let rest = "/network/chains/0/ends/0/pressure_pa=60000";
        for silent in ["/time/end_s=20", rest] {
            let told = say(command, &["--set", silent]);
            assert!(!told.contains("W037"), "{command} {silent}: {told}");
        }
    }
    let vary = "/network/permeability_factor=1e-7,100";
    say(
        "sweep",
        &["--command", "equilibrium", "--no-mesh-errors", "--lean", "--vary", vary],
    );
    let table = std::fs::read_to_string(dir.path().join("sweep/sweep.csv")).expect("a table");
    let late: Vec<bool> = table.lines().skip(1).map(|row| row.contains("W037")).collect();
    assert_eq!(late, [true, false], "{table}");
}

/// Goal: an error gives one message and the usual exit code; a path that ends early keeps its states.
#[test]
fn command_says_what_cannot_be() {
    let out = tempfile::tempdir().expect("a folder");
    for (arguments, code, words) in [
        (
            vec![
                "equilibrium",
                "cases/elastica.json",
                "--sensitivity",
                "/beam/young_modulus",
            ],
            2,
            "young_modulus_pa",
        ),
        (
            vec!["equilibrium", "cases/elastica.json", "--load-factor", "0"],
            2,
            "--load-factor",
        ),
        (
            vec!["equilibrium", "cases/elastica.json", "--set", "/ends/root=\"free\""],
            3,
            "nothing holds",
        ),
        (
            vec![
                "equilibrium",
                "cases/tour-actuator.json",
                "--set",
                "/ends/root=\"free\"",
            ],
            3,
            "nothing holds the beam along and across",
        ),
        (
            vec![
                "equilibrium",
                "cases/tour-actuator.json",
                "--set",
                "/ends/root=\"free\"",
                "--set",
                "/start={}",
            ],
            4,
            "nothing holds the beam along and across",
        ),
        (
            vec!["equilibrium", "cases/elastica.json", "--set", "/beam/length=1"],
            3,
            "length_m",
        ),
        (
            vec!["equilibrium", "cases/pluck.json", "--set", "/start/u1_m=0.001"],
            3,
            "/start/equilibrium finds",
        ),
        (
            vec!["equilibrium", "cases/pluck.json", "--via", "soon"],
            2,
            "--via soon",
        ),
        (
            vec!["equilibrium", "cases/pluck.json", "--via", ""],
            2,
            "instants in seconds",
        ),
        (
            vec!["equilibrium", "cases/pluck.json", "--via", "0.5,1.5"],
            2,
            "after the end of the run at 1 s",
        ),
        (
            vec![
                "equilibrium",
                "cases/pluck.json",
                "--set",
                "/start/equilibrium/via_s=[0, 2]",
            ],
            3,
            "the instant 2 s is not before the end of the run",
        ),
    ] {
        let run = slcbeam(&arguments, out.path());
        let text = String::from_utf8_lossy(&run.stderr);
        assert_eq!(run.status.code(), Some(code), "{arguments:?}: {text}");
        assert!(text.contains(words), "{arguments:?}: {text}");
    }
}

/// Goal: rounding errors are printed as zero, and a state without loads is reported as such. While a pump fills a closed network, the
/// command names an instant to use; then there is neither a table of states nor a list of files.
#[test]
fn command_tells_what_is_nothing() {
    let out = tempfile::tempdir().expect("a folder");
    let port = "/network/chains/0/ends/0={\"flow_m3_s\":{\"table\":{\"times_s\":[0,0.5,1],\"values\":[0,4e-7,0],\"interpolation\":\"linear\"}}}";
    let asked = |more: &[&str]| {
        let run = slcbeam(
            &[&["equilibrium", "cases/pluck.json", "--set", "/start={}"], more].concat(),
            out.path(),
        );
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        (run.status.code(), text(&run.stdout), text(&run.stderr))
    };
    let (code, table, _) = asked(&["--set", port, "--set", "/time/end_s=2"]);
    assert_eq!(code, Some(0));
    let last = table.lines().find(|line| line.trim_start().starts_with("1.00000 "));
    let cells: Vec<&str> = last.expect("a row").split_whitespace().collect();
    assert_eq!(cells[5], "0", "the least pressure: {table}");
    assert!(!table.contains("nothing acts"), "{table}");
    let (code, words, fault) = asked(&["--set", port, "--at", "0.75"]);
    assert_eq!(code, Some(4));
    assert_eq!(words, "");
    assert!(fault.contains("takes in 2.000e-7 m^3/s at that instant"), "{fault}");
    assert!(fault.contains("at which the flow has stopped (--at)"), "{fault}");
    let (_, words, _) = asked(&[
        "--set",
        "/loads=[]",
        "--set",
        "/ends={\"root\":\"clamped\",\"tip\":\"free\"}",
    ]);
    assert!(words.contains("nothing acts at t = 1.00000 s"), "{words}");
}

/// Goal: an angle of a ten-thousandth of the motion over the beam's length, which is the mesh error of zero, causes no warning.
#[test]
fn an_angle_counts_beside_the_deflection() {
    let out = tempfile::tempdir().expect("a folder");
    let run = slcbeam(&["equilibrium", "tests/faults/lying-on-wall.json"], out.path());
    let text = String::from_utf8_lossy(&run.stdout);
    assert!(
        run.status.success() && text.contains("largest estimated error"),
        "{text}"
    );
    assert!(
        !text.contains("tip_angle has a relative error") && !text.contains("% of tip_angle"),
        "{text}"
    );
}
