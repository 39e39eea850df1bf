//! The program from outside: exit codes, streams, files. Cases are small: the tests are about the command line.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

/// Two bladders and a tube, a millisecond.
const SMALL: &str = "cases/two-bladders.json";

/// The program with arguments.
fn slcbeam(arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("slcbeam").unwrap();
    command.args(arguments);
    command
}

/// What a finished program said.
struct Said {
    code: i32,
    out: String,
    err: String,
}

fn say(arguments: &[&str]) -> Said {
    let output = slcbeam(arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Said {
        code: output.status.code().unwrap(),
        out: text(output.stdout),
        err: text(output.stderr),
    }
}

/// `run` of the small case into a folder, with more arguments.
fn run(folder: &Path, more: &[&str]) -> Said {
    let mut arguments = vec!["run", SMALL, "--out", folder.to_str().unwrap(), "--quiet"];
    arguments.extend(more);
    say(&arguments)
}

fn json(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

#[test]
fn a_run_fills_a_result_folder() {
    let dir = TempDir::new().unwrap();
    let folder = dir.path().join("deep/result");
    let said = run(&folder, &[]);
    assert_eq!((said.code, said.err.as_str()), (0, ""), "quiet means silent");
    assert!(
        said.out.contains("two-bladders") && said.out.contains("finished"),
        "{}",
        said.out
    );
    assert!(
        said.out.contains(folder.to_str().unwrap()),
        "the box says where the files are: {}",
        said.out
    );
    let files = [
        ".slcbeam.case",
        "case.json",
        "deflection.svg",
        "energy.svg",
        "errors.csv",
        "fields.npz",
        "history.csv",
        "history.svg",
        "pressure.svg",
        "report.html",
        "summary.json",
    ];
    assert_eq!(names(&folder), files);

    let summary = json(&folder.join("summary.json"));
    for key in [
        "case",
        "status",
        "reason",
        "time_s",
        "unknowns",
        "quantities",
        "balances",
        "solver",
        "wall_s",
        "effects",
        "characteristic",
        "warnings",
    ] {
        assert!(summary.get(key).is_some(), "summary.json lacks {key}");
    }
    assert_eq!(
        (&summary["case"], &summary["status"]),
        (&"two-bladders".into(), &"finished".into())
    );
    assert_eq!(summary["time_s"].as_f64(), Some(0.002));
    for quantity in ["tip_u1_m", "tip_u3_m", "max_pressure_pa"] {
        let all = [
            "final",
            "max_abs",
            "max_abs_at_s",
            "extreme",
            "window_max_abs",
            "window_extreme",
            "window_rms",
        ];
        assert_eq!(keys(&summary["quantities"][quantity]), all, "{quantity}");
        let of = |key: &str| summary["quantities"][quantity][key].as_f64();
        assert_eq!(of("extreme").map(f64::abs), of("max_abs"));
    }
    assert_eq!(
        keys(&summary["quantities"]["input_energy_j"]),
        ["final", "window", "window_power_w"]
    );
    for key in ["energy_residual_relative", "volume_residual_relative", "energy_j"] {
        assert!(!summary["balances"][key].is_null(), "balances lack {key}");
    }
    let counters = [
        "steps",
        "residual_evaluations",
        "jacobian_evaluations",
        "factorizations",
        "pivot_refreshes",
        "error_test_failures",
        "newton_failures",
        "max_order",
    ];
    for key in counters {
        assert!(summary["solver"][key].is_u64(), "solver lacks {key}");
    }
    let by_order: u64 = summary["solver"]["steps_by_order"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(Value::as_u64)
        .sum();
    assert_eq!(by_order, summary["solver"]["steps"].as_u64().unwrap());
    let wall = summary["wall_s"].as_object().unwrap();
    for key in ["total", "residual", "jacobian", "linear_solver", "output", "report"] {
        assert!(wall[key].as_f64().unwrap() > 0.0, "wall_s lacks {key}");
    }
    assert!(
        summary["effects"]
            .as_object()
            .unwrap()
            .values()
            .all(|e| e["value"].is_string() && e["reason"].is_string())
    );

    let history = fs::read_to_string(folder.join("history.csv")).unwrap();
    assert!(
        history.starts_with("t [s],tip_u1 [m],"),
        "{}",
        history.lines().next().unwrap()
    );
    // 0 to 2 ms in steps of 2 us, both ends included.
    assert_eq!(history.lines().count(), 1 + 1001);
}

#[test]
fn a_resolved_case_runs_to_the_same_result() {
    let dir = TempDir::new().unwrap();
    let (first, second) = (dir.path().join("first"), dir.path().join("second"));
    assert_eq!(run(&first, &["--set", "/time/end_s=0.0005"]).code, 0);
    let resolved = first.join("case.json");
    let said = say(&[
        "run",
        resolved.to_str().unwrap(),
        "--out",
        second.to_str().unwrap(),
        "--quiet",
    ]);
    assert_eq!(said.code, 0, "{}", said.err);
    let history = |folder: &Path| fs::read_to_string(folder.join("history.csv")).unwrap();
    assert_eq!(history(&first), history(&second));
}

#[test]
fn json_on_request() {
    let dir = TempDir::new().unwrap();
    let folder = dir.path().join("result");
    let said = run(&folder, &["--json", "--set", "/time/end_s=0.0002"]);
    let printed: Value = serde_json::from_str(&said.out).unwrap();
    assert_eq!(printed, json(&folder.join("summary.json")));
    let checked: Value = serde_json::from_str(&say(&["check", SMALL, "--json"]).out).unwrap();
    for key in [
        "case",
        "unknowns",
        "characteristic",
        "audit",
        "effects",
        "max_order",
        "warnings",
    ] {
        assert!(checked.get(key).is_some(), "check --json lacks {key}");
    }
}

#[test]
fn check_prints_and_writes_nothing() {
    let dir = TempDir::new().unwrap();
    let case = fs::canonicalize("cases/wiring-2.json").unwrap();
    let output = slcbeam(&["check", "--verbose", case.to_str().unwrap()])
        .current_dir(dir.path())
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success() && text.starts_with("wiring-2: valid"), "{text}");
    for part in [
        "characteristic numbers",
        "coupling",
        "effects",
        "warnings",
        "t_f_s",
        "124.08",
    ] {
        assert!(text.contains(part), "check lacks {part}: {text}");
    }
    assert!(names(dir.path()).is_empty());
}

/// Goal: without `--verbose` a terminal shows all of it, columns of words begin at one place, and equal networks share a line.
#[test]
fn check_fits_into_sixty_lines() {
    for name in ["wiring-1", "tour-harvester", "wiring-2", "valves-half", "tour-sensor"] {
        let output = slcbeam(&["check", &format!("cases/{name}.json")]).output().unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(text.lines().count() < 60, "{}: {text}", text.lines().count());
        let slowest = text.lines().filter(|line| line.contains("slowest_time_of_network"));
        assert!(slowest.count() <= 3, "{text}");
        let about = |line: &str, words: &str| line.find(words).map(|at| line[..at].chars().count());
        let places = ["resistance to bending", "lowest frequency of bending"]
            .map(|words| text.lines().find_map(|l| about(l, words)));
        assert!(places[0].is_some() && places[0] == places[1], "{text}");
    }
}

#[test]
fn mapping_prints_the_tables() {
    let tables = say(&["mapping", "cases/wiring-3.json"]);
    assert_eq!(tables.code, 0, "{}", tables.err);
    let (first, second) = tables.out.split_once("\n\n").expect("a blank line between the tables");
    for (table, heading, name) in [
        (first, "theta_r,x_f,bladder", "theta-to-xf"),
        (second, "x_f,theta,bladder", "xf-to-theta"),
    ] {
        assert_eq!(table.lines().next(), Some(heading));
        // Two rows for each of 20 bladders.
        assert_eq!(table.trim_end().lines().count(), 1 + 40, "{name}");
        assert_eq!(
            say(&["mapping", "cases/wiring-3.json", "--table", name]).out.trim_end(),
            table.trim_end()
        );
    }
    let dry = say(&["mapping", "cases/bend-dry.json"]);
    assert_eq!(dry.code, 2, "there is nothing to map in a dry beam");
}

#[test]
fn the_schema_is_the_committed_one() {
    let said = say(&["schema"]);
    assert_eq!(said.code, 0);
    let committed = fs::read_to_string("cases/schema.json").unwrap();
    assert!(said.out == committed, "they differ: slcbeam schema > cases/schema.json");
}

#[test]
fn usage_errors() {
    for arguments in [
        &["fly"][..],
        &[],
        &["run"],
        &["run", SMALL, "--no-such"],
        &["run", SMALL, "--set", "rtol"],
    ] {
        let said = say(arguments);
        assert_eq!(said.code, 2, "{arguments:?}: {}", said.err);
        assert!(said.out.is_empty() && !said.err.is_empty(), "{arguments:?}");
    }
    assert_eq!(say(&["--help"]).code, 0);
    assert_eq!(
        say(&["--version"]).out.trim(),
        concat!("slcbeam ", env!("CARGO_PKG_VERSION"))
    );
}

#[test]
fn an_invalid_case_is_explained_and_leaves_no_trace() {
    let dir = TempDir::new().unwrap();
    let folder = dir.path().join("result");
    let said = run(&folder, &["--set", "/beam/length_m=-1"]);
    assert_eq!(said.code, 3, "{}", said.err);
    assert!(said.err.contains("length_m") && said.out.is_empty(), "{}", said.err);
    assert!(!folder.exists());

    let file = dir.path().join("wrong.json");
    fs::write(&file, "{\"name\": \"wrong\", \"beem\": {}}").unwrap();
    let said = say(&["run", file.to_str().unwrap(), "--out", folder.to_str().unwrap()]);
    assert_eq!(said.code, 3, "{}", said.err);
    assert!(
        said.err.contains("beem") && said.err.contains("beam"),
        "the nearest key is named: {}",
        said.err
    );
    assert!(!folder.exists());

    let missing = say(&["check", "no-such-file.json"]);
    assert!(
        missing.code != 0 && missing.err.contains("no-such-file.json"),
        "{}",
        missing.err
    );
}

#[test]
fn values_are_set_from_the_command_line() {
    let dir = TempDir::new().unwrap();
    let folder = dir.path().join("result");
    let said = run(
        &folder,
        &[
            "--set",
            "/solver/rtol=1e-4",
            "--set",
            "/time/end_s=0.0003",
            "--set",
            "/name=\"other\"",
        ],
    );
    assert_eq!(said.code, 0, "{}", said.err);
    let resolved = json(&folder.join("case.json"));
    assert_eq!(
        (resolved["solver"]["rtol"].as_f64(), resolved["time"]["end_s"].as_f64()),
        (Some(1e-4), Some(0.0003))
    );
    assert_eq!(json(&folder.join("summary.json"))["case"], "other");
}

#[test]
fn the_default_folder_has_the_name_of_the_case() {
    let dir = TempDir::new().unwrap();
    let case = fs::canonicalize(SMALL).unwrap();
    let said = slcbeam(&["run", case.to_str().unwrap(), "--quiet", "--set", "/time/end_s=0.0001"])
        .current_dir(dir.path())
        .output()
        .unwrap();
    assert!(said.status.success());
    assert!(dir.path().join("out/two-bladders/summary.json").is_file());
}

/// Goal: a case comes from standard input as from a file, and its result goes by its name; without one the fault says that it names the folder.
#[test]
fn a_case_on_standard_input_is_run() {
    let folder = TempDir::new().unwrap();
    let text = fs::read_to_string(SMALL).unwrap();
    let piped = |text: &str| {
        let mut command = slcbeam(&["run", "-", "--quiet"]);
        command.current_dir(folder.path()).write_stdin(text).output().unwrap()
    };
    let ended = piped(&text);
    assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));
    assert!(folder.path().join("out/two-bladders/summary.json").is_file());
    let ended = piped(&text.replace("\"name\": \"two-bladders\",", ""));
    let told = String::from_utf8_lossy(&ended.stderr);
    assert_eq!(ended.status.code(), Some(3));
    assert!(
        told.contains("1 fault in standard input")
            && told.contains("\"name\"")
            && told.contains("the default result folder is"),
        "{told}"
    );
}

#[test]
fn a_second_run_replaces_the_first() {
    let dir = TempDir::new().unwrap();
    let folder = dir.path().join("result");
    assert_eq!(run(&folder, &[]).code, 0);
    let note = folder.join("note.txt");
    fs::write(&note, "mine").unwrap();
    assert_eq!(run(&folder, &["--set", "/time/end_s=0.001"]).code, 0);
    assert_eq!(json(&folder.join("summary.json"))["time_s"].as_f64(), Some(0.001));
    assert_eq!(
        fs::read_to_string(note).unwrap(),
        "mine",
        "what the program did not write stays"
    );
}

#[test]
fn a_folder_with_other_files_is_refused() {
    let dir = TempDir::new().unwrap();
    fs::write(dir.path().join("thesis.tex"), "years of work").unwrap();
    let said = run(dir.path(), &[]);
    assert_eq!(said.code, 5, "{}", said.err);
    assert!(said.err.contains("--out"), "says what to do: {}", said.err);
    assert_eq!(names(dir.path()), ["thesis.tex"]);

    let file = dir.path().join("thesis.tex");
    assert_eq!(run(&file, &[]).code, 5, "a file is no folder");
}

#[test]
fn a_run_stops_where_a_bladder_closes() {
    // 60.84 mm^2 at rest less 1.75e-10 m^2/Pa times 400 kPa would leave nothing.
    let dir = TempDir::new().unwrap();
    let folder = dir.path().join("result");
    let pump = r#"/network/ports=[{"name": "pump", "at": {"bladder": 1, "end": "inlet"}, "pressure_pa": {"ramp": {"to": -400000, "duration_s": 0.01}}}]"#;
    let said = run(
        &folder,
        &[
            "--set",
            "/start={}",
            "--set",
            "/time/end_s=0.02",
            "--set",
            pump,
            "--set",
            "/solver/rtol=1e-4",
        ],
    );
    assert_eq!(said.code, 4, "{}", said.err);
    assert!(said.err.contains("E048"), "{}", said.err);
    let summary = json(&folder.join("summary.json"));
    assert_eq!(summary["status"], "out_of_range", "{summary:#}");
    assert!(
        summary["reason"].as_str().unwrap().contains("closed"),
        "{}",
        summary["reason"]
    );
    let t = summary["time_s"].as_f64().unwrap();
    assert!(0.0 < t && t < 0.02, "{t}");
    let history = fs::read_to_string(folder.join("history.csv")).unwrap();
    assert!(history.lines().count() > 10 && folder.join("fields.npz").is_file());
}

#[test]
fn a_failing_solver_leaves_the_result_so_far() {
    let dir = TempDir::new().unwrap();
    let folder = dir.path().join("result");
    let said = run(&folder, &["--set", "/solver/max_steps=10"]);
    assert_eq!(said.code, 4, "{}", said.err);
    assert!(
        said.err.contains("failed at t = ") && said.err.contains("/solver/max_steps"),
        "{}",
        said.err
    );
    let summary = json(&folder.join("summary.json"));
    assert_eq!(summary["status"], "failed");
    assert_eq!(summary["solver"]["steps"], 10);
    let reached = summary["time_s"].as_f64().unwrap();
    let history = fs::read_to_string(folder.join("history.csv")).unwrap();
    let last: f64 = history
        .lines()
        .last()
        .unwrap()
        .split(',')
        .next()
        .unwrap()
        .parse()
        .unwrap();
    // The last row is the last output time, a multiple of 2 us, that was passed.
    assert!(
        reached > 0.0 && last <= reached && reached - last < 2e-6,
        "{last} {reached}"
    );
    assert!(folder.join("fields.npz").is_file());
}

#[test]
fn a_wall_time_limit_stops_with_what_there_is() {
    let dir = TempDir::new().unwrap();
    let folder = dir.path().join("result");
    let said = run(&folder, &["--max-wall", "0 s"]);
    assert_eq!(said.code, 0, "{}", said.err);
    let summary = json(&folder.join("summary.json"));
    assert_eq!(summary["status"], "stopped");
    assert!(
        summary["reason"].as_str().unwrap().contains("wall time"),
        "{}",
        summary["reason"]
    );
}

/// The published law with a thousand times its slope has no unique state once bladders are under high pressure.
#[test]
fn a_run_that_cannot_start_says_so_and_moves_the_older_result() {
    let dir = TempDir::new().unwrap();
    let folder = dir.path().join("result");
    let out = folder.to_str().unwrap();
    let common = ["run", "cases/wiring-2.json", "--quiet", "--out", out];
    let common = [
        &common[..],
        &["--set", "/time={\"end_s\":0.001,\"output_interval_s\":1e-4}"],
    ]
    .concat();
    assert_eq!(say(&common).code, 0);
    let before = std::fs::read(folder.join("summary.json")).unwrap();
    let impossible = r#"/bladders/coupling={"published":{"slope_per_pressure_rad":5,"length_per_pressure_m":0.01}}"#;
    let pressed = r#"/start={"pressures":[{"bladders":[1,2,3,-1,-2],"pressure_pa":1.9e7}]}"#;
    let impossible = [
        "--set",
        impossible,
        "--set",
        pressed,
        "--set",
        r#"/effects={"solid_inertia":"off"}"#,
    ];
    for more in [&[][..], &["--accuracy", "0.1"]] {
        let said = say(&[&common[..], &impossible, more].concat());
        assert_eq!(said.code, 4, "{}", said.err);
        assert_eq!(said.err.matches("no consistent start").count(), 1, "{}", said.err);
        let aside = dir.path().join("result.older");
        assert!(said.err.contains("result.older"), "{}", said.err);
        assert_eq!(std::fs::read(aside.join("summary.json")).unwrap(), before);
        let told = std::fs::read_to_string(folder.join("summary.json")).unwrap();
        assert!(
            told.contains("\"failed\"") && !folder.join("history.csv").exists(),
            "{told}"
        );
        assert_eq!(names(dir.path()), ["result", "result.older"]);
        std::fs::remove_dir_all(&folder).unwrap();
        std::fs::rename(&aside, &folder).unwrap();
    }
}

#[test]
fn an_accuracy_is_asked_for() {
    let dir = TempDir::new().unwrap();
    let folder = dir.path().join("result");
    let out = folder.to_str().unwrap();
    let said = say(&[
        "run",
        "cases/bend-dry.json",
        "--out",
        out,
        "--quiet",
        "--accuracy",
        "0.05",
    ]);
    assert_eq!(said.code, 0, "{}", said.err);
    assert!(said.out.contains("5 % reached with "), "{}", said.out);
    let summary = json(&folder.join("summary.json"));
    assert_eq!(summary["accuracy"]["reached"], true, "{summary:#}");
    let case = json(&folder.join("case.json"));
    assert_eq!(case["solver"]["rtol"], summary["accuracy"]["rtol"]);
    assert_eq!(names(dir.path()), ["result"], "nothing is left beside the result");

    for wrong in ["0", "-1", "2", "nan"] {
        let accuracy = format!("--accuracy={wrong}");
        let said = say(&["run", "cases/bend-dry.json", "--out", out, &accuracy]);
        assert_eq!(said.code, 2, "{wrong}: {}", said.err);
    }
    let said = say(&[
        "run",
        "cases/bend-dry.json",
        "--out",
        out,
        "--accuracy",
        "0.1",
        "--resume",
    ]);
    assert_eq!(said.code, 2, "{}", said.err);
}

/// Derivatives: a file with a column for each of the history's and each number, an entry of the summary, a line of the box; not
/// together with what they cannot be had with.
#[test]
fn a_run_gives_derivatives() {
    let dir = TempDir::new().unwrap();
    let folder = dir.path().join("result");
    let pointer = "/fluid/viscosity_pa_s";
    let asked = ["--sensitivity", pointer, "--sensitivity", "/beam/young_modulus_pa"];
    let said = run(&folder, &asked);
    assert_eq!((said.code, said.err.as_str()), (0, ""));
    assert!(
        said.out.contains("sensitivity") && said.out.contains(pointer),
        "{}",
        said.out
    );
    let text = fs::read_to_string(folder.join("sensitivities.csv")).unwrap();
    let first = text.lines().next().unwrap();
    assert!(
        first.starts_with("t [s],d tip_u1/d /fluid/viscosity_pa_s [m per unit],"),
        "{first}"
    );
    let history = fs::read_to_string(folder.join("history.csv")).unwrap();
    let columns = |text: &str| text.lines().next().unwrap().split(',').count();
    // each of the history's but for time and the residual, twice, and time
    assert_eq!(columns(&text), 2 * (columns(&history) - 2) + 1);
    assert_eq!(text.lines().count(), history.lines().count());
    let summary = json(&folder.join("summary.json"));
    let slope = &summary["sensitivities"][pointer]["quantities"]["max_pressure_pa"]["final"];
    assert!(
        slope.as_f64().is_some_and(|x| x > 0.0),
        "more viscous fluid flows off later: {slope}"
    );

    // a run without them leaves no old ones behind
    assert_eq!(run(&folder, &["--set", "/time/end_s=0.0002"]).code, 0);
    assert!(!folder.join("sensitivities.csv").exists());
    for more in [&["--resume"][..], &["--accuracy", "0.01"]] {
        let said = run(&folder, &[&asked[..], more].concat());
        assert_eq!(said.code, 2, "{}", said.err);
    }
    let said = run(&folder, &["--sensitivity", "/fluid/viscosty_pa_s"]);
    assert_eq!(said.code, 2);
    assert!(said.err.contains("nearest is /fluid/viscosity_pa_s"), "{}", said.err);
}

/// Goal: the usual folder of a name is that of one case file. Before, the result of another file with the same name was replaced without a word.
#[test]
fn the_result_of_another_case_file_is_not_replaced() {
    let dir = TempDir::new().unwrap();
    let (here, there) = (dir.path().join("here"), dir.path().join("there"));
    fs::create_dir(&here).unwrap();
    let text = fs::read_to_string(SMALL).unwrap();
    for (name, end) in [("a.json", 1.0), ("b.json", 0.5), ("c.json", 1.0)] {
        let mut case: Value = serde_json::from_str(&text).unwrap();
        case["time"]["end_s"] = (end * case["time"]["end_s"].as_f64().unwrap()).into();
        fs::write(here.join(name), case.to_string()).unwrap();
    }
    let run = |folder: &Path, arguments: &[&str]| {
        let mut command = slcbeam(&["run", "--lean", "--quiet"]);
        let output = command.args(arguments).current_dir(folder).output().unwrap();
        (output.status.code().unwrap(), String::from_utf8(output.stderr).unwrap())
    };
    let well = (0, String::new());
    assert_eq!(run(&here, &["a.json"]), well);
    assert_eq!(
        run(&here, &["./a.json", "--set", "/solver/rtol=1e-5"]),
        well,
        "the same file"
    );
    assert_eq!(run(&here, &["a.json"]), well);
    assert_eq!(run(&here, &["c.json"]), well, "the same case");
    let before = fs::read(here.join("out/two-bladders/summary.json")).unwrap();
    let (code, said) = run(&here, &["b.json"]);
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        code == 5 && said.contains("the result of another case file, c.json"),
        "{code} {said}"
    );
    assert!(said.contains("--out") && said.contains("--force"), "{said}");
    assert_eq!(fs::read(here.join("out/two-bladders/summary.json")).unwrap(), before);
    assert_eq!(run(&here, &["b.json", "--force"]), well);
    // moved together they still belong together
    fs::rename(&here, &there).unwrap();
    assert_eq!(run(&there, &["b.json"]), well);
    let (code, said) = run(&there, &["a.json", "--out", "out/two-bladders"]);
    assert!(
        code == 0 && said.contains("out/two-bladders contained the result of b.json"),
        "{code} {said}"
    );
    assert_eq!(
        run(&there, &["out/two-bladders/case.json"]),
        well,
        "a result's own case"
    );
}
