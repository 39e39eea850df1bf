//! Two results side by side: aligned in time and space, and how far apart they are.

use std::path::Path;

use slcbeam::output::kind::FolderKind;
use slcbeam::output::{FolderRecorder, Labels, ResultFolder, comparison, reading};
use slcbeam::run::dynamics;
use slcbeam::run::record::Control;
use slcbeam::study::compare::{self, interpolate};

use super::swung::{DRY, WET, parsed};

/// Runs into a folder.
fn run_into(dir: &Path, text: &str, sets: &[&str]) -> compare::Recording {
    let case = parsed(text, sets);
    let labels = Labels {
        case_name: case.name.clone(),
        case: case.written(),
        frequency_hz: None,
        bladders: Default::default(),
    };
    let mut recorder = FolderRecorder::new(
        ResultFolder::claim(dir, FolderKind::Run, false).unwrap(),
        labels,
        Box::new(|_| Control::Continue),
    );
    let outcome = dynamics::run(&case, &mut recorder).unwrap();
    recorder.finish(&outcome.summary).unwrap().close().unwrap();
    reading::read(dir).unwrap()
}

/// Goal: a figure's change is told over the first, besides over the quantity's largest figure.
#[test]
fn a_change_is_told_over_the_first() {
    let dir = tempfile::tempdir().unwrap();
    let [one, two] = ["one", "two"].map(|name| dir.path().join(name));
    let a = run_into(&one, DRY, &[]);
    let b = run_into(&two, DRY, &["/loads/0/force_x_n_m/signal/sine/amplitude=15"]);
    let found = compare::compare(&a, &b);
    let largest = found.figures.iter().find(|f| f.name == "tip_u1_m.max_abs").unwrap();
    let change = largest.change.unwrap();
    assert_eq!(change, (largest.b - largest.a) / largest.a);
    // three halves of the load, small deflections: to 1 % of that
    assert!((change - 0.5).abs() < 5e-3, "{change}");
    assert!((largest.relative - 1.0 / 3.0).abs() < 5e-3, "{}", largest.relative);
    let said = std::process::Command::new(env!("CARGO_BIN_EXE_slcbeam"))
        .arg("compare")
        .args([one, two])
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&said.stdout);
    assert!(
        text.contains("(B − A)/|A|") && text.contains("|B − A| over the quantity's largest"),
        "{text}"
    );
    let row = text.lines().find(|line| line.starts_with("tip_u1_m.max_abs")).unwrap();
    let told = format!("+{:.1} %", 100.0 * change);
    assert!(row.contains(&told), "{row}: {told}");
}

#[test]
fn a_run_equals_itself_and_nearly_its_other_meshes_and_times() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    let tight = "/solver/rtol=1e-8";
    let first = run_into(
        &at("first"),
        WET,
        &["/mesh/cells_per_segment=8", "/mesh/cells_per_bladder=4", tight],
    );
    let itself = compare::compare(&first, &first);
    assert!(itself.physics.is_empty() && itself.numerics.is_empty() && itself.left_out.len() < 5);
    for d in itself.histories.iter().chain(&itself.fields) {
        assert_eq!(
            (d.relative.l2, d.relative.max, d.interpolation),
            (0.0, 0.0, 0.0),
            "{}",
            d.name
        );
    }
    assert!(itself.fields.iter().any(|d| d.name == "pressure_pa") && itself.histories.len() > 6);

    // Twice as fine a mesh: a quarter of the error of the second order is left, well below 5 %.
    let finer = run_into(
        &at("finer"),
        WET,
        &["/mesh/cells_per_segment=16", "/mesh/cells_per_bladder=8", tight],
    );
    let meshes = compare::compare(&first, &finer);
    assert!(meshes.physics.is_empty() && !meshes.numerics.is_empty());
    let named = |c: &compare::Comparison, name: &str| {
        let all = c.histories.iter().chain(&c.fields);
        all.clone()
            .find(|d| d.name == name)
            .cloned()
            .unwrap_or_else(|| panic!("no {name}"))
    };
    for name in ["tip_u1", "u1_m", "v1_m_s", "moment_n_m", "pressure_pa"] {
        let d = named(&meshes, name);
        assert!(d.relative.l2 > 0.0 && d.relative.l2 < 0.05, "{name}: {:?}", d.relative);
    }
    assert!(
        named(&meshes, "u1_m").place.is_some_and(|x| x > 0.5),
        "largest near the tip"
    );

    // Other output times: same steps, so only interpolation is in between, and it says how much.
    let shifted = [
        "/mesh/cells_per_segment=8",
        "/mesh/cells_per_bladder=4",
        tight,
        "/time/output_interval_s=0.0007",
    ];
    let shifted = run_into(&at("shifted"), WET, &shifted);
    let times = compare::compare(&first, &shifted);
    for (name, most) in [("tip_u1", 1e-5), ("u1_m", 1e-5), ("u3_m", 1e-4), ("v1_m_s", 1e-3)] {
        let d = named(&times, name);
        assert!(d.relative.max < most, "{name}: {:?}", d.relative);
        assert!(
            d.interpolation > 0.0 && d.relative.max < 20.0 * d.interpolation + 1e-7,
            "{name}: {d:?}"
        );
    }
    // Fewer instants are those of the first run.
    assert!(named(&times, "tip_u1").instants <= first.times.len());
    assert!(comparison::picture(&first, &shifted, &times).is_some_and(|svg| svg.contains("the first less the second")));
}

#[test]
fn another_problem_is_called_one() {
    let dir = tempfile::tempdir().unwrap();
    let a = run_into(&dir.path().join("a"), DRY, &[]);
    let b = run_into(&dir.path().join("b"), DRY, &["/beam/length_m=0.11", "/time/end_s=0.12"]);
    let found = compare::compare(&a, &b);
    let pointers: Vec<&str> = found.physics.iter().map(|c| c.pointer.as_str()).collect();
    assert_eq!(pointers, ["/beam/length_m", "/time/end_s"]);
    assert!((found.to_s - 0.12).abs() < 1e-12);
    assert!(
        found
            .histories
            .iter()
            .any(|d| d.name == "tip_u1" && d.relative.max > 0.05)
    );
}

#[test]
fn cubics_are_exact_for_cubics_and_kinks_do_not_ring() {
    let xs = [0.0, 1.0, 2.5, 3.0, 4.5, 6.0];
    let f = |x: f64| 1.0 - 2.0 * x + 0.5 * x * x - 0.1 * x * x * x;
    for x in [0.2, 1.0, 1.7, 2.9, 4.0, 5.9] {
        assert!(
            (interpolate::cubic(&xs, x).mean(|k| f(xs[k])) - f(x)).abs() < 1e-12,
            "{x}"
        );
    }
    let slope = |x: f64| -2.0 + x - 0.3 * x * x;
    let w = interpolate::hermite(0.3, 1.5);
    let (a, b) = (1.0, 2.5);
    let between = w[0] * f(a) + w[1] * f(b) + w[2] * slope(a) + w[3] * slope(b);
    assert!((between - f(1.45)).abs() < 1e-12);
    let step = [0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
    for k in 0..=60 {
        let y = interpolate::monotone(&xs, &step, 0.1 * f64::from(k));
        assert!((0.0..=1.0).contains(&y), "{y}");
    }
}

/// Goal: of results that do not end together figures are of other instants, and a history that was cut off is short: both are told. Of the page, which
/// quantity of all differs most.
#[test]
fn other_ends_and_short_histories_are_told() {
    let dir = tempfile::tempdir().unwrap();
    let [short, long] = ["short", "long"].map(|name| dir.path().join(name));
    let one = run_into(&short, DRY, &["/time/end_s=0.03"]);
    let other = run_into(&long, DRY, &["/time/end_s=0.06"]);
    let found = compare::compare(&one, &other);
    assert_eq!(found.remarks.len(), 1, "{:?}", found.remarks);
    assert!(
        found.remarks[0].contains("short ends at t = 0.03 s") && found.remarks[0].ends_with("refer to different times"),
        "{:?}",
        found.remarks
    );
    let history = std::fs::read_to_string(long.join("history.csv")).unwrap();
    let cut: Vec<&str> = history.lines().take(21).collect();
    std::fs::write(long.join("history.csv"), cut.join("\n") + "\n").unwrap();
    // as an earlier version leaves it, which kept no checksum
    let mut summary: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(long.join("summary.json")).unwrap()).unwrap();
    summary.as_object_mut().unwrap().remove("tables_crc32");
    std::fs::write(long.join("summary.json"), summary.to_string()).unwrap();
    let cut = compare::compare(&one, &reading::read(&long).unwrap());
    assert!(
        cut.remarks[1].contains("the history ends at t = 0.0285 s"),
        "{:?}",
        cut.remarks
    );
    let page = dir.path().join("page");
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_slcbeam"))
        .args(["compare", "short", "long", "--out", "page"])
        .current_dir(dir.path())
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    let page = std::fs::read_to_string(page.join("report.html")).unwrap();
    assert!(page.contains("Of the quantities that matter most"));
}

/// Goal: of several results each is compared with the first, or with the one that is named, as two are; nonsense is refused.
#[test]
fn several_are_compared_with_one() {
    let dir = tempfile::tempdir().unwrap();
    let load = "/loads/0/force_x_n_m/signal/sine/amplitude";
    let names = ["weak", "usual", "strong"];
    let all: Vec<_> = names
        .iter()
        .zip([5, 10, 15])
        .map(|(name, n)| {
            run_into(
                &dir.path().join(name),
                DRY,
                &[&format!("{load}={n}"), "/time/end_s=0.03"],
            )
        })
        .collect();
    let found = compare::ManyComparison::new(&all, 1);
    assert_eq!(found.comparisons[0], compare::compare(&all[1], &all[0]));
    assert_eq!(found.comparisons[1], compare::compare(&all[1], &all[2]));
    let said = |more: &[&str]| {
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_slcbeam"))
            .arg("compare")
            .args(names)
            .args(more)
            .current_dir(dir.path())
            .output()
            .unwrap();
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        (output.status.code(), text(&output.stdout), text(&output.stderr))
    };
    assert!(found.remarks().is_empty());
    let (code, out, _) = said(&["--with", "./usual/"]);
    assert_eq!(code, Some(0));
    // small deflections: half and three halves of the load, to a percent of that
    let row = out.lines().find(|line| line.starts_with("tip_u1_m.max_abs")).unwrap();
    let change = |percent: &str| -> f64 {
        percent
            .trim()
            .trim_start_matches('+')
            .replace('−', "-")
            .parse()
            .unwrap()
    };
    let told: Vec<f64> = row
        .split('(')
        .skip(1)
        .map(|part| change(part.split('%').next().unwrap()))
        .collect();
    assert!((told[0] + 50.0).abs() < 0.5 && (told[1] - 50.0).abs() < 0.5, "{row}");
    assert!(out.starts_with("A  usual\nB  weak\nC  strong\n"), "{out}");
    let (_, out, _) = said(&["--json"]);
    let json: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!(
        (&json["reference"], json["comparisons"].as_array().unwrap().len()),
        (&"weak".into(), 2)
    );
    for (more, words) in [
        (&["--with", "other"][..], "it is not one of the compared folders"),
        (&["--out", "picture.svg"], "a picture shows two results only"),
        (&["--out", "page.html"], "name the folder, such as page"),
        (&["--out", "usual"], "contains a result whose page would be overwritten"),
        (
            &["--match", "a=tip_u1"],
            "one result folder and one file of data, not 3",
        ),
    ] {
        let (code, _, err) = said(more);
        assert!(code == Some(2) && err.contains(words), "{code:?} {err}");
    }
}
