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
