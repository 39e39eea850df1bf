//! A made-up run through the recorder: a standing wave in a beam with two networks of ten bladders.

use std::f64::consts::PI;
use std::fs;
use std::path::Path;

use slcbeam::case::CaseText;
use slcbeam::output::envelope::{Envelope, HistorySource, RowOrigin};
use slcbeam::output::kind::FolderKind;
use slcbeam::output::recorder::Finished;
use slcbeam::output::{FolderRecorder, Labels, ResultFolder, folder, pictures, plot, report, summary};
use slcbeam::run::record::{Control, Header, HistoryColumn, Progress, RecordedAxis, RecordedField, Recorder};
use slcbeam::run::summary::{Quantity, Status, Summary};
use slcbeam::study::companion::band::ErrorBand;

const FREQUENCY: f64 = 20.0;
const LENGTH: f64 = 0.1;
const COLUMNS: [(&str, &str); 13] = [
    ("t", "s"),
    ("tip_u1", "m"),
    ("tip_u3", "m"),
    ("max_pressure", "Pa"),
    ("min_pressure", "Pa"),
    ("kinetic_energy", "J"),
    ("bending_energy", "J"),
    ("work_ends", "J"),
    ("dissipated_bladders", "J"),
    ("dissipated_tubes", "J"),
    ("harvested", "J"),
    ("energy_residual", "J"),
    ("turbine_power", "W"),
];

fn header() -> Header {
    let theta: Vec<f64> = (0..=40).map(|k| LENGTH * f64::from(k) / 40.0).collect();
    // Two cells a bladder, tubes of 0.02 m between bladders of 0.046 m, none between the networks.
    let (mut x, mut x_f, mut bladder) = (0.0, Vec::new(), Vec::new());
    for row in [1.0, -1.0] {
        for j in 1..=10 {
            x_f.extend([x + 0.0115, x + 0.0345]);
            bladder.extend([row * f64::from(j); 2]);
            x += if j < 10 { 0.066 } else { 0.046 };
        }
    }
    x_f.iter_mut().for_each(|v| *v /= x);
    let axis = |name, unit, values| RecordedAxis {
        name,
        unit,
        about: "",
        values,
    };
    let field = |name, unit, axis, len| RecordedField {
        name,
        unit,
        axis,
        about: "",
        len,
    };
    Header {
        envelope: vec![],
        columns: COLUMNS
            .map(|(name, unit)| HistoryColumn {
                name: name.into(),
                unit,
                about: String::new(),
            })
            .to_vec(),
        axes: vec![
            axis("theta_node_m", "m", theta),
            axis("x_f", "1", x_f),
            axis("bladder", "1", bladder),
        ],
        fields: vec![
            field("u1_m", "m", "theta_node_m", 41),
            field("u3_m", "m", "theta_node_m", 41),
            field("pressure_pa", "Pa", "x_f", 40),
        ],
        sensitivities: vec![],
    }
}

fn u1(theta: f64, t: f64) -> f64 {
    let s = theta / LENGTH;
    let second_mode = (4.694 * s).cosh() - (4.694 * s).cos() - 1.0185 * ((4.694 * s).sinh() - (4.694 * s).sin());
    1e-4 * second_mode * (2.0 * PI * FREQUENCY * t).sin() * (1.0 - (-8.0 * t).exp())
}

fn u3(theta: f64, t: f64) -> f64 {
    let w = 2.0 * PI * FREQUENCY;
    0.0012 * (w * t).sin() * (1.0 + 0.3 * (0.5 * PI * theta / LENGTH).sin() * (w * t).cos())
}

fn pressure(bladder: f64, x: f64, t: f64) -> f64 {
    let w = 2.0 * PI * FREQUENCY;
    if bladder > 0.0 {
        9.0e3 * (w * t).sin() * (1.0 + 0.15 * (2.0 * PI * x).cos())
    } else {
        3.0e3 * (w * t).sin() * (2.0 * PI * (x - 0.5)).sin().abs()
    }
}

/// One row of the history and one instant of the fields.
fn sample(recorder: &mut dyn Recorder, header: &Header, t: f64, scale: f64) {
    let w = 2.0 * PI * FREQUENCY;
    let (s2, c2) = ((w * t).sin().powi(2), (w * t).cos().powi(2));
    let row = [
        t,
        scale * u1(LENGTH, t),
        scale * u3(LENGTH, t),
        9e3 * s2,
        -7e3 * c2,
        2e-3 * c2,
        1.7e-3 * s2 + 1e-4,
        2.1e-3 + 0.02 * t,
        0.011 * t,
        0.005 * t,
        0.004 * t,
        3e-10 * (5.0 * t).sin() + 2e-10 * t,
        0.008 * s2,
    ];
    recorder.history(&row).expect("a row is written");
    let along = |f: fn(f64, f64) -> f64| {
        header.axes[0]
            .values
            .iter()
            .map(|&x| scale * f(x, t))
            .collect::<Vec<f64>>()
    };
    let cells = header.axes[1].values.iter().zip(&header.axes[2].values);
    let p: Vec<f64> = cells.map(|(&x, &b)| pressure(b, x, t)).collect();
    recorder
        .fields(t, &[&along(u1), &along(u3), &p])
        .expect("fields are written");
}

fn recorder(dir: &Path) -> FolderRecorder {
    let labels = Labels {
        case_name: "wiring-3 <&>".to_string(),
        case: CaseText {
            json: "{\"name\": \"wiring-3\"}\n".to_string(),
            tables: vec![],
        },
        frequency_hz: Some(FREQUENCY),
        bladders: Default::default(),
    };
    let folder = ResultFolder::claim(dir, FolderKind::Run, false).expect("a folder");
    FolderRecorder::new(folder, labels, Box::new(|_| Control::Continue))
}

fn summary_of(status: Status) -> Summary {
    Summary {
        case: "wiring-3".to_string(),
        status,
        reason: None,
        time_s: 0.5,
        unknowns: 371,
        quantities: [(
            "tip_u1_m".to_string(),
            Quantity {
                last: Some(1e-4),
                max_abs: Some(f64::NAN),
                ..Quantity::default()
            },
        )]
        .into(),
        balances: Default::default(),
        solver: Default::default(),
        wall_s: Default::default(),
        effects: Default::default(),
        characteristic: [("f_u".to_string(), f64::INFINITY), ("t_s_s".to_string(), 0.0457)].into(),
        origins: Default::default(),
        growth: None,
        growing_wave: None,
        tables_crc32: Default::default(),
        accuracy: None,
        errors: Default::default(),
        companion: None,
        sensitivities: Default::default(),
        probes: Default::default(),
        ports: Default::default(),
        step_response: Default::default(),
        bands: Default::default(),
        warnings: Vec::new(),
    }
}

/// Records `count` instants, a thousand to half a second.
fn record(dir: &Path, count: u32, scale: f64) -> FolderRecorder {
    let header = header();
    let mut recorder = recorder(dir);
    recorder.begin(&header).expect("it begins");
    for k in 0..count {
        sample(&mut recorder, &header, 0.5 * f64::from(k) / 1000.0, scale);
    }
    recorder
}

fn read(dir: &Path, name: &str) -> String {
    fs::read_to_string(dir.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// Tags close in the order in which they opened, attributes are quoted, and no bare `&` or `<` is left.
fn is_well_formed(xml: &str) -> bool {
    let mut open = Vec::new();
    for piece in xml.split('<').skip(1) {
        let Some((tag, text)) = piece.split_once('>') else {
            return false;
        };
        let bare = text.split('&').skip(1).any(|rest| {
            !["amp;", "lt;", "gt;", "quot;", "apos;"]
                .iter()
                .any(|e| rest.starts_with(e))
        });
        if bare || tag.matches('"').count() % 2 != 0 {
            return false;
        }
        match tag.strip_prefix('/') {
            Some(name) => {
                if open.pop() != Some(name) {
                    return false;
                }
            }
            None if tag.ends_with('/') => {}
            None => open.push(tag.split_whitespace().next().unwrap_or_default()),
        }
    }
    open.is_empty()
}

#[test]
fn a_run_makes_all_files_of_a_result() {
    let dir = tempfile::tempdir().expect("a place");
    let out = dir.path().join("out/wiring-3");
    record(&out, 1001, 1.0)
        .finish(&summary_of(Status::Finished))
        .and_then(Finished::close)
        .expect("it finishes");
    let mut names: Vec<_> = fs::read_dir(&out)
        .expect("a folder")
        .map(|e| e.expect("a file").file_name())
        .collect();
    names.sort();
    let expected = [
        "case.json",
        "deflection.svg",
        "energy.svg",
        "fields.npz",
        "history.csv",
        "history.svg",
        "pressure.svg",
        "summary.json",
    ];
    assert_eq!(names, expected, "no temporary files are left");
}

/// Page and pictures of a run that has just ended are drawn of rows in memory: they are those of its files.
#[test]
fn what_was_kept_in_memory_is_what_files_say() {
    let dir = tempfile::tempdir().expect("a place");
    let out = dir.path();
    let mut recorder = record(out, 1500, 1.0);
    let odd = [
        0.76,
        -0.0,
        -f64::NAN,
        f64::INFINITY,
        5e-324,
        1e300,
        0.1,
        0.2,
        0.3,
        1e-7,
        1e21,
        f64::NEG_INFINITY,
        0.0,
    ];
    recorder.history(&odd).expect("a row is written");
    let finished = recorder.finish(&summary_of(Status::Finished)).expect("it finishes");
    finished.page().expect("a page");
    finished.close().expect("it is closed");
    let page = read(out, "report.html");
    report::write(out, None).expect("the same page");
    assert!(page == read(out, "report.html"), "the page of the folder is another");
    let rows = Envelope::read(HistorySource::Folder(out), pictures::STRETCHES).expect("rows");
    let drawn = pictures::over_time("wiring-3 <&>", &rows, &ErrorBand::default());
    assert_eq!(drawn.len(), 2);
    for (name, picture) in drawn {
        assert!(picture == read(out, name), "{name} of the folder is another");
    }
}

#[test]
fn the_history_reads_back_exactly() {
    let dir = tempfile::tempdir().expect("a place");
    record(dir.path(), 101, 1.0)
        .finish(&summary_of(Status::Finished))
        .and_then(Finished::close)
        .expect("it finishes");
    let mut reader = csv::Reader::from_path(dir.path().join("history.csv")).expect("a table");
    assert_eq!(
        reader.headers().expect("names").iter().take(2).collect::<Vec<_>>(),
        ["t [s]", "tip_u1 [m]"]
    );
    let rows: Vec<Vec<f64>> = reader.deserialize().collect::<Result<_, _>>().expect("numbers");
    assert_eq!(rows.len(), 101);
    for row in &rows {
        // Shortest round trip: not one bit is lost.
        assert_eq!(row[1].to_bits(), u1(LENGTH, row[0]).to_bits());
    }
}

#[test]
fn the_arrays_read_back_exactly() {
    let dir = tempfile::tempdir().expect("a place");
    record(dir.path(), 57, 1.0)
        .finish(&summary_of(Status::Finished))
        .and_then(Finished::close)
        .expect("it finishes");
    let file = std::fs::File::open(dir.path().join("fields.npz")).expect("a file");
    let mut npz = zip::ZipArchive::new(file).expect("an archive");
    let mut get = |name: &str| {
        let entry = npz
            .by_name(&format!("{name}.npy"))
            .unwrap_or_else(|_| panic!("no {name}"));
        let array = npyz::NpyFile::new(entry).expect("an array");
        (array.shape().to_vec(), array.into_vec::<f64>().expect("doubles"))
    };
    let (shape, times) = get("t_fields_s");
    assert_eq!((shape, times.len()), (vec![57], 57));
    let (_, theta) = get("theta_node_m");
    assert_eq!(theta, header().axes[0].values);
    assert_eq!(get("bladder").1, header().axes[2].values);
    let (shape, values) = get("u1_m");
    assert_eq!(shape, [57, 41]);
    assert_eq!(values[41 * 50 + 40].to_bits(), u1(LENGTH, times[50]).to_bits());
    assert_eq!(get("pressure_pa").0, [57, 40]);
}

#[test]
fn numbers_that_are_not_finite_stay_out_of_json() {
    let dir = tempfile::tempdir().expect("a place");
    let mut failed = summary_of(Status::Failed);
    failed.balances.energy_residual_relative = f64::NAN;
    record(dir.path(), 3, 1.0)
        .finish(&failed)
        .and_then(Finished::close)
        .expect("it finishes");
    let text = read(dir.path(), "summary.json");
    assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
    let value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert!(value["balances"]["energy_residual_relative"].is_null());
    assert!(value["characteristic"].get("f_u").is_none());
    assert_eq!(value["quantities"]["tip_u1_m"], serde_json::json!({"final": 1e-4}));
    let back = summary::read(dir.path()).expect("it reads back");
    assert!(back.balances.energy_residual_relative.is_nan());
    assert_eq!(back.status, Status::Failed);
}

#[test]
fn an_interrupted_run_stays_readable() {
    let dir = tempfile::tempdir().expect("a place");
    drop(record(dir.path(), 40, 1.0));
    let rows = csv::Reader::from_path(dir.path().join("history.csv"))
        .expect("a table")
        .into_records()
        .count();
    assert_eq!(rows, 40);
    let times = fs::read(dir.path().join("fields.part/t_fields_s.f64")).expect("raw times");
    let u1 = fs::read(dir.path().join("fields.part/u1_m.f64")).expect("a raw field");
    assert_eq!((times.len(), u1.len()), (40 * 8, 40 * 41 * 8));
    assert!(!dir.path().join("summary.json").exists());
    // And the next run takes the folder over.
    record(dir.path(), 5, 1.0)
        .finish(&summary_of(Status::Finished))
        .and_then(Finished::close)
        .expect("it finishes");
    assert!(!dir.path().join("fields.part").exists());
}

#[test]
fn a_run_without_a_single_instant_finishes_too() {
    let dir = tempfile::tempdir().expect("a place");
    record(dir.path(), 0, 1.0)
        .finish(&summary_of(Status::Failed))
        .and_then(Finished::close)
        .expect("it finishes");
    assert!(dir.path().join("fields.npz").exists());
    assert!(!dir.path().join("deflection.svg").exists());
    assert_eq!(summary::read(dir.path()).expect("a summary").status, Status::Failed);
}

#[test]
fn a_run_that_does_not_begin_moves_an_older_result_aside() {
    let dir = tempfile::tempdir().expect("a place");
    record(dir.path(), 20, 1.0)
        .finish(&summary_of(Status::Finished))
        .and_then(Finished::close)
        .expect("it finishes");
    let (history, text) = (read(dir.path(), "history.csv"), read(dir.path(), "summary.json"));
    let finished = recorder(dir.path())
        .finish(&summary_of(Status::Failed))
        .expect("it finishes");
    // The older result is moved, whole, and the failure is on record.
    let aside = finished.aside.clone().expect("a place for the older result");
    finished.close().expect("it closes");
    assert_eq!(
        (history, text),
        (read(&aside, "history.csv"), read(&aside, "summary.json"))
    );
    assert!(!dir.path().join("history.csv").exists());
    assert_eq!(summary::read(dir.path()).expect("a summary").status, Status::Failed);
    fs::remove_dir_all(aside).expect("it is removed");
    // In a new folder the failure is on record.
    let new = dir.path().join("new");
    recorder(&new)
        .finish(&summary_of(Status::Failed))
        .and_then(Finished::close)
        .expect("it finishes");
    assert_eq!(summary::read(&new).expect("a summary").status, Status::Failed);
}

#[test]
fn folders_with_other_files_are_refused() {
    let dir = tempfile::tempdir().expect("a place");
    fs::write(dir.path().join("case.json"), "{\"name\": \"mine\"}").expect("a file");
    let refused = ResultFolder::claim(dir.path(), FolderKind::Run, false).expect_err("not a result");
    assert_eq!(refused.exit_code(), 5);
    assert!(refused.to_string().contains("--out"), "{refused}");
    assert_eq!(read(dir.path(), "case.json"), "{\"name\": \"mine\"}");
    // Nor does a file make a folder.
    assert!(ResultFolder::claim(&dir.path().join("case.json"), FolderKind::Run, false).is_err());
}

#[test]
fn a_new_result_replaces_an_older_one_and_nothing_else() {
    let dir = tempfile::tempdir().expect("a place");
    record(dir.path(), 20, 1.0)
        .finish(&summary_of(Status::Finished))
        .and_then(Finished::close)
        .expect("it finishes");
    fs::write(dir.path().join("checkpoint.bin"), "kept").expect("a file");
    fs::write(dir.path().join(folder::REPORT), "stale").expect("a file");
    record(dir.path(), 10, 1.0)
        .finish(&summary_of(Status::Finished))
        .and_then(Finished::close)
        .expect("it finishes");
    assert_eq!(read(dir.path(), "checkpoint.bin"), "kept");
    assert!(!dir.path().join(folder::REPORT).exists());
    assert_eq!(read(dir.path(), "history.csv").lines().count(), 11);
}

#[test]
fn the_hook_decides_whether_to_go_on() {
    let dir = tempfile::tempdir().expect("a place");
    let folder = ResultFolder::claim(dir.path(), FolderKind::Run, false).expect("a folder");
    let labels = Labels {
        case_name: "x".into(),
        case: CaseText {
            json: "{}".into(),
            tables: vec![],
        },
        frequency_hz: None,
        bladders: Default::default(),
    };
    let stop = Control::Stop("enough".into());
    let answer = stop.clone();
    let mut recorder = FolderRecorder::new(folder, labels, Box::new(move |_| answer.clone()));
    let progress = Progress {
        t: 0.1,
        end: 0.5,
        steps: 3,
        step: 1e-3,
        order: 2,
    };
    assert_eq!(recorder.progress(&progress).expect("an answer"), stop);
}

#[test]
fn pictures_are_well_formed_and_labelled() {
    let dir = tempfile::tempdir().expect("a place");
    // Large displacements, so that the shape is drawn too.
    record(dir.path(), 1001, 60.0)
        .finish(&summary_of(Status::Finished))
        .and_then(Finished::close)
        .expect("it finishes");
    let labels: [(&str, &[&str]); 4] = [
        (
            "deflection.svg",
            &[
                "transverse u₁ [mm]",
                "axial u₃ [mm]",
                "shape: z = θ + u₃ [mm]",
                "last cycle",
                "t [ms]",
            ],
        ),
        (
            "pressure.svg",
            &["pressure p [kPa]", "[1]", "[10]", "[−1]", "[−10]", "t [ms]"],
        ),
        (
            "history.svg",
            &[
                "tip u₁ [mm]",
                "tip u₃ [mm]",
                "max, min p [kPa]",
                "turbine power [mW]",
                "time t [ms]",
            ],
        ),
        (
            "energy.svg",
            &[
                "energy [mJ]",
                "kinetic energy",
                "work of ends",
                "lost in tubes",
                "harvested",
                "residual [10⁻⁹]",
            ],
        ),
    ];
    for (name, expected) in labels {
        let svg = read(dir.path(), name);
        assert!(is_well_formed(&svg), "{name}");
        assert!(svg.contains("wiring-3 &lt;&amp;&gt;"), "{name} names its case");
        for label in expected {
            assert!(
                svg.contains(&format!("\n{label}")) || svg.contains(label),
                "{name} lacks {label}"
            );
        }
        assert!(!svg.contains("NaN"), "{name}");
    }
}

#[test]
fn pressure_curves_break_between_networks() {
    let x_f: Vec<f64> = header().axes[1].values.clone();
    let bladder: Vec<i64> = header().axes[2].values.iter().map(|&b| b as i64).collect();
    let data = plot::Pressure {
        case: "two".into(),
        span: plot::TimeSpan::WholeRun,
        times: vec![0.0, 1.0],
        network: bladder.iter().map(|b| b.signum()).collect(),
        bladder: bladder.iter().map(i64::to_string).collect(),
        pressure: vec![x_f.clone(), vec![0.5; x_f.len()]],
        x_f,
    };
    let lines = |svg: &str, colour: &str| svg.matches(&format!("stroke=\"{colour}\"")).count();
    let two = plot::pressure::draw(&data).expect("a picture");
    // Dark blue and dark red: a piece for each of the two networks.
    assert_eq!((lines(&two, "#0B246B"), lines(&two, "#6E081B")), (2, 2));
    let one = plot::Pressure {
        network: vec![7; data.x_f.len()],
        ..data
    };
    assert_eq!(lines(&plot::pressure::draw(&one).expect("a picture"), "#0B246B"), 1);
}

/// Goal: the subtitle names error bands only where one is drawn; a line hides a narrow one.
#[test]
fn a_picture_names_its_error_bands() {
    let curve = |width: f64| plot::PlottedCurve {
        name: "tip_u1".into(),
        unit: "m".into(),
        points: vec![(0.0, 0.0), (1.0, 1.0)],
        widths: vec![(0.0, 0.0), (1.0, width)],
    };
    let named = |width: f64| {
        let svg = plot::history::draw("one", &[curve(width)]).expect("a picture");
        let [shade, subtitle] = ["fill-opacity", "bands: estimated error"].map(|part| svg.contains(part));
        assert_eq!(shade, subtitle, "{width}");
        subtitle
    };
    assert!(named(0.1) && !named(1e-4) && !named(0.0));
}

#[test]
fn absent_data_make_no_picture() {
    assert_eq!(plot::history::draw("none", &[]), None);
    assert_eq!(plot::energy::draw("none", &[]), None);
    let dry = Header {
        columns: vec![HistoryColumn {
            name: "t".into(),
            unit: "s",
            about: String::new(),
        }],
        ..Header::default()
    };
    let dir = tempfile::tempdir().expect("a place");
    let mut recorder = recorder(dir.path());
    recorder.begin(&dry).expect("it begins");
    recorder.history(&[0.0]).expect("a row");
    recorder
        .finish(&summary_of(Status::Finished))
        .and_then(Finished::close)
        .expect("it finishes");
    for name in folder::PICTURES {
        assert!(!dir.path().join(name).exists(), "{name}");
    }
}

#[test]
fn instants_cover_the_last_cycle_or_everything() {
    let times: Vec<f64> = (0..=1000).map(|k| 5e-4 * f64::from(k)).collect();
    let (span, cycle) = plot::instants(&times, Some(20.0), 24);
    assert_eq!((span, cycle.len()), (plot::TimeSpan::LastCycle, 24));
    assert_eq!((cycle[0], cycle[23]), (900, 1000));
    let (span, all) = plot::instants(&times, None, 24);
    assert_eq!((span, all[0], all[23]), (plot::TimeSpan::WholeRun, 0, 1000));
    let (span, _) = plot::instants(&times, Some(0.5), 24);
    assert_eq!(span, plot::TimeSpan::WholeRun, "less than a cycle was run");
    assert_eq!(plot::instants(&times[..3], None, 24).1, [0, 1, 2]);
    assert!(plot::instants(&[], None, 24).1.is_empty());
}

#[test]
fn no_extreme_is_lost_and_memory_is_bounded() {
    let names = vec![("t".to_string(), "s".to_string()), ("y".to_string(), "m".to_string())];
    let mut envelope = Envelope::new(101);
    for k in 0..12_345 {
        let y = if k == 7_777 { 5.0 } else { (f64::from(k) * 0.7).sin() };
        envelope.add(&names, RowOrigin::History, &[f64::from(k), y]);
    }
    let points = envelope.points(1);
    assert!(points.len() <= 202, "{}", points.len());
    assert!(points.contains(&(7777.0, 5.0)));
    assert!(points.windows(2).all(|w| w[0].0 < w[1].0), "in order of time");
    assert_eq!(envelope.points(0).last(), Some(&(12_344.0, 12_344.0)));
    let columns = envelope.columns();
    assert!(columns[0].len() <= 202 && columns[0].len() == columns[1].len());
    assert!(columns[0].windows(2).all(|w| w[0] < w[1]), "in order of time");
    assert!(columns[1].contains(&5.0));
}

#[test]
fn a_short_history_is_kept_as_it_is() {
    let names = vec![("t".to_string(), "s".to_string()), ("y".to_string(), "m".to_string())];
    let mut envelope = Envelope::new(100);
    envelope.add(&names, RowOrigin::History, &[0.0, 1.0]);
    envelope.add(&names, RowOrigin::History, &[1.0, f64::NAN]);
    envelope.add(&names, RowOrigin::History, &[2.0, 1.0]);
    let points = envelope.points(1);
    assert_eq!(points.len(), 3);
    assert!(points[1].1.is_nan());
}

/// Goal: what could not be written whole is not said to be: the summary says that it failed, and why.
#[test]
fn a_folder_that_could_not_be_completed_says_so() {
    let dir = tempfile::tempdir().expect("a folder");
    let mut open = recorder(dir.path());
    open.begin(&header()).expect("begun");
    fs::remove_dir_all(dir.path().join(folder::RAW_FIELDS)).expect("taken away");
    let failed = open
        .finish(&summary_of(Status::Finished))
        .expect_err("no arrays")
        .to_string();
    let told = summary::read(dir.path()).expect("a summary");
    assert_eq!(told.status, Status::Failed);
    assert!(told.reason.is_some_and(|reason| reason == failed), "{failed}");
    assert!(!dir.path().join(folder::FIELDS).exists());
}
