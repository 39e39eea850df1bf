//! `slcbeam plot`: pictures of quantities for papers, read back as numbers.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;
use tempfile::TempDir;

use super::program::say;

/// Points per millimeter.
const POINT: f64 = 72.0 / 25.4;

/// Result of a command in a folder of its own.
fn made(inside: &TempDir, name: &str, arguments: &[&str]) -> String {
    let dir = inside.path().join(name).display().to_string();
    let said = say(&[arguments, &["--quiet", "--out", &dir]].concat());
    assert_eq!(said.code, 0, "{arguments:?}: {}", said.err);
    dir
}

fn run_of(inside: &TempDir) -> String {
    made(inside, "first", &["run", "cases/two-bladders.json"])
}

/// Path of a picture that is drawn with these arguments.
fn drawn(inside: &TempDir, name: &str, arguments: &[&str]) -> PathBuf {
    let path = inside.path().join(name);
    let said = say(&[&["plot"], arguments, &["--out", &path.display().to_string()]].concat());
    assert_eq!(said.code, 0, "{arguments:?}: {}", said.err);
    path
}

/// The error of arguments that must be refused, with its exit code.
fn refused(arguments: &[&str]) -> (i32, String) {
    let said = say(&[&["plot"], arguments].concat());
    assert_ne!(said.code, 0, "{arguments:?}");
    (said.code, said.err)
}

fn attribute(line: &str, name: &str) -> f64 {
    let text = line.split_once(&format!(" {name}=\"")).expect("an attribute").1;
    text.split('"')
        .next()
        .and_then(|x| x.trim_end_matches("mm").parse().ok())
        .expect("a number")
}

/// Numbers of a column of a table.
fn column(table: &Path, heading: &str) -> Vec<f64> {
    let text = fs::read_to_string(table).expect("a table");
    let k = text
        .lines()
        .next()
        .expect("headings")
        .split(',')
        .position(|own| own == heading)
        .expect("a column");
    text.lines()
        .skip(1)
        .map(|line| line.split(',').nth(k).and_then(|x| x.parse().ok()).expect("a number"))
        .collect()
}

/// Position and number of tick labels with this anchor.
fn ticks(svg: &str, anchor: &str, side: &str) -> Vec<(f64, f64)> {
    let labels = svg
        .lines()
        .filter(|line| line.starts_with("<text") && line.contains(&format!("anchor=\"{anchor}\"")));
    labels
        .filter_map(|line| {
            let text = line.split_once('>')?.1.strip_suffix("</text>")?.replace('−', "-");
            Some((attribute(line, side), text.parse().ok()?))
        })
        .collect()
}

/// Value at a position between ticks.
fn value(ticks: &[(f64, f64)], at: f64) -> f64 {
    let ((a, first), (b, last)) = (ticks[0], ticks[ticks.len() - 1]);
    first + (last - first) * (at - a) / (b - a)
}

/// Goal: a picture has the requested width, names with units and prefixes, and its curve is the column of `history.csv`: positions between
/// the ticks return the numbers to the resolution of a hundredth of a point.
#[test]
fn a_curve_is_the_column_of_its_table() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = run_of(&folder);
    let path = drawn(&folder, "tip.svg", &[&run, "-q", "tip_u1", "--columns", "2"]);
    let svg = fs::read_to_string(path).expect("a picture");
    let head = svg.lines().next().expect("a head");
    assert_eq!(attribute(head, "width"), 174.0);
    let height = attribute(head, "height");
    assert!(
        head.contains(&format!("viewBox=\"0 0 493.23 {:.2}", height * POINT)),
        "{head}"
    );
    assert!(
        svg.contains(
            ">tip deflection u<tspan dy=\"1.36\" font-size=\"5.6\">1</tspan><tspan dy=\"-1.36\"> [nm]</tspan><"
        )
    );
    assert!(
        svg.contains(">time [ms]<") && svg.contains("fill-opacity"),
        "no unit or no error band"
    );
    let curve = svg
        .lines()
        .find(|line| line.starts_with("<polyline") && line.contains("#0072B2"))
        .expect("a curve");
    assert_eq!(attribute(curve, "stroke-width"), 0.8);
    let points = curve
        .split_once("points=\"")
        .expect("points")
        .1
        .trim_end_matches("\"/>");
    let points: Vec<(f64, f64)> = points
        .split(' ')
        .map(|p| {
            p.split_once(',')
                .map(|(x, y)| (x.parse().expect("x"), y.parse().expect("y")))
                .expect("a point")
        })
        .collect();
    let table = Path::new(&run).join("history.csv");
    let (times, tips) = (column(&table, "t [s]"), column(&table, "tip_u1 [m]"));
    assert_eq!(points.len(), times.len());
    let (x, y) = (ticks(&svg, "middle", "x"), ticks(&svg, "end", "y"));
    // text is 0.09 of its size below its point
    let lower = 0.09 * 8.0;
    for ((at, t), u) in points.iter().zip(&times).zip(&tips) {
        // a hundredth of a point of 493 for 2 ms, and of about 200 for 130 nm
        let (dt, du) = (value(&x, at.0) * 1e-3 - t, value(&y, at.1 + lower) * 1e-9 - u);
        assert!(dt.abs() < 1e-7 && du.abs() < 3e-11, "{at:?} {t} {u}: {dt:e} {du:e}");
    }
}

/// Goal: a PDF is complete: every object is where its table says, the page has the requested size, and the font is embedded.
#[test]
fn a_pdf_has_size_and_font() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = run_of(&folder);
    let arguments = [&run, "-q", "tip_u1,max_pressure", "--width", "120", "--height", "90"];
    let path = drawn(&folder, "both.pdf", &arguments);
    let bytes = fs::read(path).expect("a picture");
    let text = String::from_utf8_lossy(&bytes);
    assert!(bytes.starts_with(b"%PDF-1.4"), "{:?}", &bytes[..8]);
    let find = |wanted: &[u8]| bytes.windows(wanted.len()).rposition(|part| part == wanted);
    let start = find(b"startxref").expect("a start");
    let number = |from: usize| -> usize {
        let digits = bytes[from..]
            .iter()
            .skip_while(|b| !b.is_ascii_digit())
            .take_while(|b| b.is_ascii_digit());
        String::from_utf8(digits.copied().collect())
            .expect("digits")
            .parse()
            .expect("a number")
    };
    let table = number(start);
    assert!(bytes[table..].starts_with(b"xref"));
    let listed = String::from_utf8_lossy(&bytes[table..start]);
    let entries = listed.lines().filter(|line| line.trim_end().ends_with(" n"));
    let objects = entries
        .enumerate()
        .map(|(k, line)| (k + 1, line[..10].parse::<usize>().expect("an offset")));
    let objects: Vec<_> = objects.collect();
    assert_eq!(objects.len(), 10);
    for (number, offset) in objects {
        assert!(
            bytes[offset..].starts_with(format!("{number} 0 obj").as_bytes()),
            "object {number}"
        );
    }
    let sheet = text.split_once("/MediaBox [").expect("a sheet").1;
    let sheet: Vec<f64> = sheet
        .split([']', ' '])
        .take(4)
        .map(|x| x.parse().expect("a side"))
        .collect();
    assert!(
        (sheet[2] - 120.0 * POINT).abs() < 0.01 && (sheet[3] - 90.0 * POINT).abs() < 0.01,
        "{sheet:?}"
    );
    for wanted in ["/FontFile2", "/ToUnicode", "LiberationSans", "/ca 0.22"] {
        assert!(text.contains(wanted), "{wanted}");
    }
}

/// Goal: curves of several results differ in color and dashes, and the legend has their names; quantities of one unit share a panel.
#[test]
fn results_are_drawn_over_each_other() {
    let folder = tempfile::tempdir().expect("a folder");
    let first = run_of(&folder);
    let set = [
        "run",
        "cases/two-bladders.json",
        "--set",
        "/network/permeability_factor=0.5",
    ];
    let second = made(&folder, "half", &set);
    let svg =
        fs::read_to_string(drawn(&folder, "two.svg", &[&first, &second, "-q", "max_pressure"])).expect("a picture");
    assert!(svg.contains(">first<") && svg.contains(">half<"));
    assert!(svg.contains("stroke=\"#D55E00\" stroke-width=\"0.8\" stroke-dasharray=\"4 1.6\""));
    let named = drawn(
        &folder,
        "named.svg",
        &[&first, &second, "--label", "κ = 1", "--label", "κ < 1"],
    );
    let named = fs::read_to_string(named).expect("a picture");
    assert!(named.contains(">κ = 1<") && named.contains(">κ &lt; 1<"));
    let both = drawn(
        &folder,
        "both.svg",
        &[&first, "-q", "max_pressure,min_pressure", "--together"],
    );
    let both = fs::read_to_string(both).expect("a picture");
    assert!(both.contains(">largest pressure<") && both.contains(">smallest pressure<") && both.contains(">[kPa]<"));
    let (code, why) = refused(&[&first, "-q", "tip_u1,max_pressure", "--together"]);
    assert!(
        code == 2 && why.contains("quantities of one panel have one unit"),
        "{why}"
    );
}

/// Goal: every kind of result has a usual picture with names and units.
#[test]
fn every_kind_has_a_usual_picture() {
    let folder = tempfile::tempdir().expect("a folder");
    let response = [
        "response",
        "cases/shaken-sealed.json",
        "--input",
        "/ends/root/clamped/u3_m",
        "--output",
        "tip_u1",
        "--to",
        "60",
    ];
    let vary = "/bladders/area_per_pressure_m2_per_pa=log:1e-10:1e-9:3";
    let sweep = [
        "sweep",
        "cases/two-bladders.json",
        "--vary",
        vary,
        "--command",
        "equilibrium",
        "--no-mesh-errors",
    ];
    let all: [(&str, &[&str], &str, &str); 3] = [
        (
            "equilibrium",
            &["equilibrium", "cases/bend-dry.json"],
            "tip deflection u₁ [m]",
            "load factor [1]",
        ),
        (
            "response",
            &response,
            "amplitude of tip deflection [m/input]",
            "frequency [Hz]",
        ),
        (
            "designs",
            &sweep,
            "tip deflection [m]",
            "bladders: area per pressure [m^2/Pa]",
        ),
    ];
    for (name, arguments, y, x) in all {
        let dir = made(&folder, name, arguments);
        let out = folder.path().join(format!("{name}.pdf")).display().to_string();
        let said = say(&["plot", &dir, "--json", "--out", &out]);
        assert_eq!(said.code, 0, "{name}: {}", said.err);
        let found: Value = serde_json::from_str(&said.out).expect("JSON");
        let axis = |side: &str| {
            let panel = &found["panels"][0];
            format!(
                "{} [{}]",
                panel[side].as_str().unwrap_or(""),
                panel[format!("{side}_unit")].as_str().unwrap_or("")
            )
        };
        assert_eq!((axis("y").as_str(), axis("x").as_str()), (y, x), "{name}");
        let list = say(&["plot", &dir, "--list"]);
        assert!(
            list.code == 0 && list.out.starts_with("quantity"),
            "{name}: {}",
            list.out
        );
    }
}

/// Goal: rows of modes and waves are points, one color and symbol for each kind; a kind without numbers has no entry in the legend.
#[test]
fn points_are_split_by_their_kinds() {
    let folder = tempfile::tempdir().expect("a folder");
    let tables = [
        (
            "modes",
            "mode [1],kind,frequency [Hz],damping ratio [1]\n1,oscillation,10,0.1\n2,flutter,20,-0.2\n3,kept volume,,\n",
        ),
        (
            "bands",
            "frequency [Hz],wave number [rad/cell],motion\n1,0.1,oscillation\n2,0.2,flutter\n3,0.3,flutter\n",
        ),
    ];
    for (name, table) in tables {
        let dir = folder.path().join(name);
        fs::create_dir(&dir).expect("a folder");
        fs::write(dir.join(format!("{name}.csv")), table).expect("a table");
        fs::write(dir.join(format!("{name}.json")), "{}").expect("a result");
        let svg = drawn(&folder, &format!("{name}.svg"), &[&dir.display().to_string()]);
        let svg = fs::read_to_string(svg).expect("a picture");
        assert!(
            svg.contains(">oscillation<") && svg.contains(">flutter<") && !svg.contains("kept volume"),
            "{name}"
        );
        // a ring in the legend too
        assert_eq!(svg.matches("<circle").count(), 2, "{name}");
    }
}

/// Goal: curves along the beam at instants: before the fluid flows, one bladder has the pressure of the start and the other none.
#[test]
fn fields_are_drawn_at_instants() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = run_of(&folder);
    let svg = drawn(&folder, "at.svg", &[&run, "--at", "0,0.002", "-q", "pressure,shape"]);
    let svg = fs::read_to_string(svg).expect("a picture");
    assert!(
        svg.contains(">pressure [kPa]<") && svg.contains(">0 s<") && svg.contains(">2 ms<") && svg.contains(">z [mm]<")
    );
    let first = svg
        .lines()
        .find(|line| line.starts_with("<polyline") && line.contains("#0072B2"))
        .expect("a curve");
    let y = ticks(&svg, "end", "y");
    let at = first
        .rsplit_once(',')
        .and_then(|(_, end)| end.trim_end_matches("\"/>").parse::<f64>().ok())
        .expect("a point");
    assert!(
        (value(&y[..2], at + 0.72) - 1.0).abs() < 1e-3,
        "{}",
        value(&y[..2], at + 0.72)
    );
    let (code, why) = refused(&[&run, "--at", "3"]);
    assert!(code == 2 && why.contains("instants from 0 s to 2 ms"), "{why}");
    let (_, why) = refused(&[&run, "--at", "0", "-q", "presure"]);
    assert!(why.contains("did you mean pressure_pa?"), "{why}");
}

/// Goal: what cannot be drawn is refused with the reason and a remedy; an existing file stays.
#[test]
fn wrong_requests_are_explained() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = run_of(&folder);
    let modes = made(&folder, "rest", &["equilibrium", "cases/bend-dry.json"]);
    let cases: [(&[&str], &str); 12] = [
        (&[&run, "-q", "tip_u2"], "has no such column; did you mean tip_u"),
        (&[&run, &modes], "results of one kind share a picture"),
        (&[&run, &run, "--label", "a"], "1 for 2 results"),
        (&[&run, "--label", "a\nb"], "has a line break"),
        (&[&run, "--from", "1", "--to", "0.5"], "--from must be below --to"),
        (&[&run, "--from", "1"], "nothing to draw within this range"),
        (&[&run, "--width", "5"], "expected 20 to 1000"),
        (
            &[&run, "--width", "25", "--font-size", "14"],
            "leave no room for the curves",
        ),
        (&[&run, "--font-size", "1"], "expected 3 to 72"),
        (&[&run, "--out", "tip.png"], "ends in .svg or .pdf"),
        (&[&run, "--out", "/tmp/x.pdf", "--label", "漢"], "has no sign for '漢'"),
        (
            &[&run, "--out", "/tmp/x.pdf", "--font", "cases/README.md"],
            "expected a TrueType font",
        ),
    ];
    for (arguments, wanted) in cases {
        let (code, why) = refused(arguments);
        assert!(code == 2 && why.contains(wanted), "{arguments:?}: {why}");
    }
    let path = drawn(&folder, "tip.svg", &[&run]);
    let name = path.display().to_string();
    let before = fs::read(&path).expect("a picture");
    let (code, why) = refused(&[&run, "-q", "tip_u3", "--out", &name]);
    assert!(code == 5 && why.contains("replace it with --force"), "{why}");
    assert_eq!(fs::read(&path).expect("a picture"), before);
    drawn(&folder, "tip.svg", &[&run, "-q", "tip_u3", "--force"]);
    assert_ne!(fs::read(&path).expect("a picture"), before);
    // --force replaces pictures only
    fs::write(&path, "notes").expect("a file");
    let (code, _) = refused(&[&run, "--force", "--out", &name]);
    assert!(code == 5 && fs::read(&path).expect("the file") == b"notes");
}
