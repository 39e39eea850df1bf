//! The paper's figures: the scripts run, draw what they say, and the pages' numbers are theirs.
//!
//! They need Debian's `/usr/bin/python3` with numpy and matplotlib, which `scripts/test` installs.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;
use slcbeam::case;
use slcbeam::discrete::System;
use slcbeam::run::observe::Observer;
use tempfile::TempDir;

const FIGURES: [&str; 9] = ["4", "5", "6", "A.4", "A.5", "A.6", "A.7", "A.9", "cell"];

/// Runs a Python script; its success, output and complaints.
fn python(arguments: &[&str], results: &Path) -> (bool, String, String) {
    let done = Command::new("/usr/bin/python3")
        .args(arguments)
        .env("SLCBEAM", assert_cmd::cargo::cargo_bin("slcbeam"))
        .env("SLCBEAM_RESULTS", results)
        .output()
        .expect("/usr/bin/python3: install it with the Debian package python3");
    let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
    (done.status.success(), text(done.stdout), text(done.stderr))
}

/// Draws figures into a folder; their numbers.
fn draw(names: &[&str], to: &Path) -> Value {
    let out = to.to_str().unwrap();
    let (good, said, told) = python(
        &[&["scripts/figures.py", "--out", out], names].concat(),
        &to.join("results"),
    );
    assert!(good, "{said}{told}");
    for name in names {
        let file = format!("figure-{}.svg", name.to_lowercase().replace('.', ""));
        let text = fs::read_to_string(to.join(&file)).unwrap();
        assert!(text.contains("<svg") && text.trim_end().ends_with("</svg>"), "{file}");
    }
    read(&to.join("numbers.json"))
}

fn read(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn the_script_knows_every_figure_and_no_other() {
    let dir = TempDir::new().unwrap();
    let (good, said, told) = python(&["scripts/figures.py", "--list"], dir.path());
    assert!(good, "{told}");
    assert_eq!(said.lines().collect::<Vec<_>>(), FIGURES);
    let (good, _, told) = python(&["scripts/figures.py", "A.8"], dir.path());
    assert!(
        !good && told.contains("no figure A.8") && told.contains("A.9"),
        "{told}"
    );
    let page = fs::read_to_string("docs/figures/README.md").unwrap();
    let numbers = read(Path::new("docs/figures/numbers.json"));
    for name in FIGURES {
        let file = format!("figure-{}.svg", name.to_lowercase().replace('.', ""));
        assert!(page.contains(&format!("![Fig. {name}]({file})")), "{name}");
        assert!(
            Path::new("docs/figures").join(&file).is_file() && numbers.get(name).is_some(),
            "{file}"
        );
    }
}

#[test]
fn the_maps_are_drawn_from_the_printed_tables() {
    let dir = TempDir::new().unwrap();
    let numbers = draw(&["A.4", "A.5"], dir.path());
    for (figure, panel) in ["A.4", "A.5"].iter().flat_map(|f| ["a", "b", "c"].map(|p| (f, p))) {
        let found = &numbers[figure][panel];
        assert_eq!(
            (&found["rows"], &found["equal_to_the_printed_table"]),
            (&40.into(), &true.into()),
            "{figure} {panel}"
        );
    }
}

/// Compares all numbers below two values; those that differ by more than `tolerance`, relative.
fn differences(a: &Value, b: &Value, at: &str, tolerance: f64, found: &mut Vec<String>) {
    match (a, b) {
        (Value::Object(x), Value::Object(y)) => {
            assert!(x.keys().eq(y.keys()), "{at}: {:?} and {:?}", x.keys(), y.keys());
            for (key, value) in x {
                differences(value, &y[key], &format!("{at}/{key}"), tolerance, found);
            }
        }
        _ => {
            let (x, y) = (a.as_f64().unwrap(), b.as_f64().unwrap());
            if (x - y).abs() > tolerance * y.abs() {
                found.push(format!("{at}: {x}, on the page {y}"));
            }
        }
    }
}

/// The cheap figures, run and drawn anew. 5 %: errors at the tolerances of the cases depend on the steps, which another
/// build may choose otherwise.
#[test]
fn the_numbers_of_the_cheap_figures_come_out_again() {
    let dir = TempDir::new().unwrap();
    let names = ["6", "A.6", "A.7", "cell"];
    let (now, kept) = (draw(&names, dir.path()), read(Path::new("docs/figures/numbers.json")));
    let mut found = vec![];
    for name in names {
        differences(&now[name], &kept[name], name, 0.05, &mut found);
    }
    assert!(
        found.is_empty(),
        "scripts/figures {} draws them anew:\n{}",
        names.join(" "),
        found.join("\n")
    );
}

/// Every row of the page's tables is the number in `numbers.json` to the digits shown, and its ratio the quotient.
#[test]
fn the_pages_tables_are_the_numbers() {
    let page = fs::read_to_string("docs/figures/README.md").unwrap();
    let numbers = read(Path::new("docs/figures/numbers.json"));
    let mut rows = 0;
    for line in page.lines().filter(|l| l.starts_with("| ")) {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        let Ok([_, printed, computed, ratio, place]) = <[&str; 5]>::try_from(cells) else {
            continue;
        };
        let Ok(computed) = computed.parse::<f64>() else {
            continue;
        };
        let kept = numbers.pointer(&format!("/{place}")).and_then(Value::as_f64);
        let kept = kept.unwrap_or_else(|| panic!("nothing at {place}"));
        assert_eq!(computed, kept, "{place}");
        if let Ok(printed) = printed.parse::<f64>() {
            // Three decimals are shown.
            let shown: f64 = ratio.parse().unwrap();
            assert!(
                (computed / printed - shown).abs() < 6e-4,
                "{place}: {}",
                computed / printed
            );
        }
        rows += 1;
    }
    assert!(rows > 40, "{rows} rows");
}

fn run(case: &str, dir: &Path) {
    let done = assert_cmd::Command::cargo_bin("slcbeam")
        .unwrap()
        .args([
            "run",
            &format!("cases/{case}.json"),
            "--quiet",
            "--set",
            "/time/end_s=0.05",
        ])
        .args(["--set", "/time/window_s=0.05", "--out", dir.to_str().unwrap()])
        .output()
        .unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
}

#[test]
fn the_figures_say_what_they_miss() {
    let dir = TempDir::new().unwrap();
    let empty = dir.path().to_str().unwrap();
    // Without site-packages: as on a machine where nothing is installed.
    let (good, _, told) = python(&["-I", "-S", "scripts/figures.py", empty], dir.path());
    assert!(
        !good && told.contains("scripts/install python3-numpy python3-matplotlib"),
        "{told}"
    );
}

/// docs/data.md names every column with its unit, every array and coordinate; its first Python example runs.
#[test]
fn the_page_of_data_names_everything() {
    let page = fs::read_to_string("docs/data.md").unwrap();
    let case = case::load(Path::new("cases/wiring-3.json"), &[]).unwrap();
    let header = Observer::header(&case, &System::new(&case).unwrap());
    // columns of ports are told once for all
    let named = |name: &str| match (name.strip_prefix("port_"), name.rsplit_once('_')) {
        (Some(rest), Some((_, what))) if rest != "flow" => format!("port_NAME_{what}"),
        _ => name.to_owned(),
    };
    let columns = header
        .columns
        .iter()
        .map(|c| format!("`{} [{}]`", named(&c.name), c.unit));
    let axes = header.axes.iter().map(|a| format!("`{}`", a.name));
    let fields = header.fields.iter().map(|f| format!("`{}`", f.name));
    let missing: Vec<String> = columns
        .chain(axes)
        .chain(fields)
        .filter(|name| !page.contains(name))
        .collect();
    assert!(missing.is_empty(), "not on the page: {missing:?}");

    let dir = TempDir::new().unwrap();
    run("wiring-3", dir.path());
    let example = page.split("```python\n").nth(1).unwrap().split("```").next().unwrap();
    let example = example.replace("out/wiring-3", dir.path().to_str().unwrap());
    let (good, said, told) = python(&["-c", &example], dir.path());
    assert!(good && said.contains("(51, 41) largest deflection"), "{said}{told}");
}
