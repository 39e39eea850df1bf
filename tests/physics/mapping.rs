//! Source: Matia & Gat, tables A.1 and A.2, as in `tests/data/mapping`.
//! Goal: the maps between the beam's and the network's coordinate agree with the printed ones, bladder by bladder.
//! Tolerance: none. The tables print six significant digits; the library's numbers must round to the printed ones, and the command must
//! print the same text.

use assert_cmd::Command;
use slcbeam::model::Model;
use slcbeam::model::mapping::network_coordinate;

use super::common::shipped;

/// Printed table, and the case with its wiring.
const WIRINGS: [(&str, &str); 3] = [
    ("upper-serpentine", "valves-open"),
    ("parallel-serpentine", "wiring-1"),
    ("crossover", "wiring-3"),
];

fn printed(direction: &str, wiring: &str) -> String {
    std::fs::read_to_string(format!("tests/data/mapping/{direction}-{wiring}.csv")).unwrap()
}

/// A number with six significant digits.
fn six_digits(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap()
}

fn agree(rows: &[(f64, f64, i64)], printed: &str) {
    let lines: Vec<&str> = printed.lines().skip(1).collect();
    assert_eq!(rows.len(), lines.len());
    for ((a, b, bladder), line) in rows.iter().zip(lines) {
        let cells: Vec<f64> = line.split(',').map(|c| c.parse().unwrap()).collect();
        assert_eq!([six_digits(*a), six_digits(*b), *bladder as f64], cells[..], "{line}");
    }
}

#[test]
fn the_six_printed_tables_come_out_to_every_digit() {
    for (wiring, case) in WIRINGS {
        let case = shipped::<&str>(case, &[]);
        let model = Model::new(&case).unwrap();
        let map = network_coordinate(&case, model.wet.as_ref().unwrap());
        agree(&map.theta_to_xf(), &printed("theta-to-xf", wiring));
        agree(&map.xf_to_theta(), &printed("xf-to-theta", wiring));
        println!("{wiring}: {} bladders, both directions as printed", map.spans.len());
    }
}

/// Goal: a case with one row lists its bladders only, along a network of their total length.
#[test]
fn one_row_is_mapped_by_itself() {
    let case = shipped(
        "valves-open",
        &[
            "/bladders/coupling=\"reciprocal\"",
            "/formulation=\"conservative\"",
            "/bladders/lower=\"none\"",
            "/network={\"chains\":[{\"bladders\":[1,2,3,4,5,6,7,8,9,10],\"ends\":[{\"pressure_pa\":1},\"sealed\"]}]}",
        ],
    );
    let model = Model::new(&case).unwrap();
    let map = network_coordinate(&case, model.wet.as_ref().unwrap());
    for rows in [map.theta_to_xf(), map.xf_to_theta()] {
        assert_eq!(rows.len(), 20);
        assert!(rows.iter().all(|row| row.2 > 0), "{rows:?}");
    }
    let end = map.xf_to_theta()[19].0;
    assert!((end - 1.0).abs() < 1e-12, "{end}");
}

#[test]
fn the_command_prints_the_six_tables() {
    for (wiring, case) in WIRINGS {
        for direction in ["theta-to-xf", "xf-to-theta"] {
            let path = format!("cases/{case}.json");
            let output = Command::cargo_bin("slcbeam")
                .unwrap()
                .args(["mapping", &path, "--table", direction])
                .output()
                .unwrap();
            assert!(output.status.success());
            let text = String::from_utf8(output.stdout).unwrap();
            assert_eq!(text, printed(direction, wiring), "{direction} {wiring}");
        }
    }
}
