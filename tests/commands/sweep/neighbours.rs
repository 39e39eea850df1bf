//! What designs beside each other tell: modes that change places, cells of a map.

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use super::common::{json, path, rows, say, well};

/// Source: the beam of the tour, whose valves are varied: at 0.32 a mode of the fluid, nearly critically damped, lies below the beam's first. Goal:
/// the sweep says that `mode_1` is another mode there, in its words and in `sweep.json`, and the row what it is.
#[test]
fn modes_that_change_places_are_told() {
    let dir = TempDir::new().expect("a folder");
    let out = path(&dir, "valves");
    let vary = "/network/permeability_factor=0.178,0.316,0.562";
    let sweep = [
        "sweep",
        "cases/tour-wiring.json",
        "--quiet",
        "--no-mesh-errors",
        "--command",
        "modes",
        "--out",
        &out,
    ];
    let said = say(&[&sweep[..], &["--vary", vary]].concat());
    well(&said);
    assert!(
        said.out
            .contains("W034 modes change places: mode_1 of design 0 is mode_2 of design 1"),
        "{}",
        said.out
    );
    let told = json(&out, "sweep.json");
    assert!(
        told["warnings"][0]
            .as_str()
            .is_some_and(|text| text.starts_with("W034")),
        "{told}"
    );
    let rows = rows(&out);
    let strong: Vec<&str> = rows.iter().map(|row| row["mode_1.strongly_damped"].as_str()).collect();
    assert_eq!(
        strong.iter().map(|text| text.parse::<f64>().ok()).collect::<Vec<_>>(),
        [Some(0.0), Some(1.0), Some(0.0)]
    );
    // two gaps in the curve of mode_1, on both sides of it
    let picture = fs::read_to_string(Path::new(&out).join("sweep.svg")).expect("a picture");
    let first = picture.split("mode_1.frequency_hz").next().unwrap_or_default();
    assert!(!first.is_empty());
    let page = fs::read_to_string(Path::new(&out).join("report.html")).expect("a page");
    assert!(page.contains("\"code\":\"W034\""));
}

/// Goal: cells of a map reach half way to their neighbours and cover it without lying over each other, however uneven the values are; an axis of factors is
/// logarithmic. Before, all cells were of one size about their places: of 0.1, 1, 10 the second lay over most of the first.
#[test]
fn cells_of_a_map_meet_between_their_values() {
    let dir = TempDir::new().expect("a folder");
    let out = path(&dir, "map");
    let vary = [
        "/network/permeability_factor=0.1,1,10",
        "/beam/density_kg_m3=900,950,1100",
    ];
    well(&say(&[
        "sweep",
        "cases/wiring-2.json",
        "--vary",
        vary[0],
        "--vary",
        vary[1],
        "--command",
        "modes",
        "--no-mesh-errors",
        "--set",
        "/mesh/cells_per_segment=1",
        "--quiet",
        "--out",
        &out,
    ]));
    let picture = fs::read_to_string(Path::new(&out).join("map.svg")).expect("a map");
    let number = |rect: &str, key: &str| -> f64 {
        let text = rect
            .split(&format!(" {key}=\""))
            .nth(1)
            .and_then(|rest| rest.split('"').next());
        text.and_then(|text| text.parse().ok()).expect("a number")
    };
    let rects = picture
        .split("<rect")
        .skip(1)
        .map(|rect| ["x", "y", "width", "height"].map(|key| number(rect, key)));
    // the first map; the bar of colours is 14 wide, the sheet has no place
    let cells: Vec<[f64; 4]> = rects.filter(|cell| cell[2] > 20.0 && cell[2] < 330.0).take(9).collect();
    assert_eq!(cells.len(), 9, "{picture}");
    let area: f64 = cells.iter().map(|cell| cell[2] * cell[3]).sum();
    assert!(
        (area / 320.0_f64.powi(2) - 1.0).abs() < 0.01,
        "no white between them: {area}"
    );
    for (k, a) in cells.iter().enumerate() {
        for b in &cells[k + 1..] {
            let shared = |i: usize| (a[i] + a[i + 2]).min(b[i] + b[i + 2]) - a[i].max(b[i]);
            assert!(shared(0) < 0.6 || shared(1) < 0.6, "{a:?} lies over {b:?}");
        }
    }
    let widths: Vec<f64> = cells.iter().map(|cell| cell[2]).collect();
    assert!(
        widths.iter().all(|width| (width - 320.0 / 3.0).abs() < 1.0),
        "factors: {widths:?}"
    );
    let mut heights: Vec<f64> = cells.iter().map(|cell| cell[3]).collect();
    heights.sort_by(f64::total_cmp);
    // 50, 100 and 150 of 300
    assert!((heights[8] / heights[0] - 3.0).abs() < 0.1, "{heights:?}");
}

/// Goal: what designs are warned of is counted in words, page and `sweep.json`: states that are not to be trusted stood in a curve without a word.
#[test]
fn warnings_of_designs_are_counted() {
    let dir = TempDir::new().expect("a folder");
    let out = path(&dir, "strong");
    let pressure = "/network/chains/0/ends/0/pressure_pa/ramp/to=1e3,5e5,1e6";
    let said = say(&[
        "sweep",
        "cases/tour-actuator.json",
        "--quiet",
        "--no-mesh-errors",
        "--command",
        "equilibrium",
        "--set",
        "/mesh/cells_per_segment=1",
        "--vary",
        pressure,
        "--out",
        &out,
    ]);
    well(&said);
    let counted = "2 of 3 designs, the first of them design 1";
    assert!(
        said.out
            .lines()
            .any(|line| line.contains("warning: W023") && line.contains(counted)),
        "{}",
        said.out
    );
    let page = fs::read_to_string(Path::new(&out).join("report.html")).expect("a page");
    assert!(page.contains("W023") && page.contains(counted));
    let told = json(&out, "sweep.json");
    let all = told["warnings"].as_array().expect("warnings");
    assert!(
        all.iter()
            .any(|one| one.as_str().is_some_and(|text| text.starts_with("W023")))
    );
}
