//! Surfaces and lines against the recorded fields.

use slcbeam::output::reading;
use slcbeam::study::compare::Recording;
use tempfile::TempDir;

use super::piece::{Piece, collection};
use super::{SHORT, export, run};

fn the_beam(piece: &Piece, from: &Recording, k: usize) {
    let row = |name: &str| from.field(name).unwrap().row(k);
    let theta = from.axis("theta_node_m").unwrap();
    let (points, at) = (piece.points(), piece.get("PointData theta_m"));
    for (node, &x) in theta.iter().enumerate() {
        // Twelve points a section on the beam's sides, at six heights, before those of the windows' walls.
        let section: Vec<usize> = (0..at.len()).filter(|&i| at[i] == x).collect();
        assert!(section.len() >= 12, "node {node}");
        for &i in &section {
            let vector = |name: &str| &piece.get(name)[3 * i..3 * i + 3];
            assert_eq!(vector("PointData u_m"), [row("u3_m")[node], row("u1_m")[node], 0.0]);
            assert_eq!(
                vector("PointData v_m_s"),
                [row("v3_m_s")[node], row("v1_m_s")[node], 0.0]
            );
            assert_eq!(piece.get("PointData curvature_1_m")[i], row("curvature_1_m")[node]);
            assert_eq!(piece.get("PointData moment_n_m")[i], row("moment_n_m")[node]);
        }
        let (a, b) = (points[section[0]], points[section[11]]);
        let centre = [0, 1, 2].map(|c| 0.5 * (a[c] + b[c]));
        let wanted = [x + row("u3_m")[node], row("u1_m")[node], 0.0];
        // Round-off of coordinates of a tenth of a metre.
        assert!(
            (0..3).all(|c| (centre[c] - wanted[c]).abs() < 1e-16),
            "node {node}: {centre:?}"
        );
        let size = (0..3).map(|c| (a[c] - b[c]).powi(2)).sum::<f64>().sqrt();
        assert!((size - 0.0216_f64.hypot(0.05)).abs() < 1e-15);
    }
    let forces = piece.get("CellData normal_force_n");
    assert!(row("normal_force_n").iter().all(|f| forces.contains(f)));
    assert!(forces.iter().all(|f| row("normal_force_n").contains(f)));
}

fn the_bladders(piece: &Piece, from: &Recording, k: usize) {
    let labels = from.axis("bladder").unwrap();
    let (points, quads) = (piece.points(), piece.quads());
    for (name, array) in [
        ("pressure_pa", "CellData pressure_pa"),
        ("area_change_m2", "CellData area_change_m2"),
    ] {
        let (row, drawn) = (from.field(name).unwrap().row(k), piece.get(array));
        for (cell, &label) in labels.iter().enumerate() {
            let own: Vec<usize> = (0..quads.len())
                .filter(|&q| piece.get("CellData bladder")[q] == label)
                .collect();
            let here: Vec<usize> = own.iter().copied().filter(|&q| drawn[q] == row[cell]).collect();
            // Two cells, each half of the faces; at the start both are at rest.
            assert!(
                here.len() == own.len() / 2 || row.iter().all(|v| *v == row[0]),
                "{name} of cell {cell}"
            );
            // The segment of the bladder.
            let middle = (label.abs() - 0.5) * 0.01;
            let u3 = from.field("u3_m").unwrap().row(k);
            let moved = middle + u3[4 * label.abs() as usize - 2];
            let mean = own.iter().flat_map(|&q| quads[q]).map(|p| points[p][0]);
            let (sum, count) = mean.fold((0.0, 0.0), |(s, n), x| (s + x, n + 1.0));
            // Strains reach some per cent over half a bladder, 4 mm.
            assert!((sum / count - moved).abs() < 4e-4, "bladder {label}");
            let upper = own.iter().flat_map(|&q| quads[q]).all(|p| points[p][1] * label > 0.0);
            assert!(upper, "row of bladder {label}");
        }
    }
}

#[test]
fn paraview_is_given_what_the_fields_hold() {
    let dir = TempDir::new().unwrap();
    run("wiring-3", dir.path(), &SHORT);
    let said = export(dir.path(), &["--format", "vtk"]);
    assert!(said.contains("wiring-3.pvd") && said.contains("11 instants"), "{said}");
    assert!(!dir.path().join("csv").exists());
    let from = reading::read(dir.path()).unwrap();
    let parts = collection(&dir.path().join("vtk/wiring-3.pvd"));
    assert_eq!(parts.len(), 3 * 11);
    for (n, (t, name, piece)) in parts.iter().enumerate() {
        let k = n / 3;
        assert_eq!(*t, from.field_times[k]);
        match n % 3 {
            0 => {
                assert_eq!(name, "beam");
                the_beam(piece, &from, k);
            }
            1 => {
                assert_eq!(name, "bladders");
                the_bladders(piece, &from, k);
                if k == 0 {
                    // Straight boxes: their volume to round-off, so that they close and look outwards.
                    let volume = 20.0 * 0.046 * 0.0078 * 0.0078;
                    assert!((piece.volume() / volume - 1.0).abs() < 1e-12, "{}", piece.volume());
                }
            }
            _ => {
                assert_eq!(name, "tubes");
                let pressure = piece.get("CellData pressure_pa");
                assert_eq!(pressure.len(), 18);
                // Chain {1, 2, ..}: two cells a bladder, the first tube joins the second and the third.
                let row = from.field("pressure_pa").unwrap().row(k);
                assert_eq!(pressure[0], 0.5 * (row[1] + row[2]));
            }
        }
    }
    let rows = parts[1]
        .2
        .get("CellData row")
        .iter()
        .zip(parts[1].2.get("CellData bladder"));
    assert!(rows.into_iter().all(|(row, bladder)| *row == bladder.signum()));
}

/// A tube's line has the tube's length: half ellipses, whose perimeter the usual formula gives within 5 %.
#[test]
fn tubes_on_one_side_are_as_long_as_they_are() {
    let dir = TempDir::new().unwrap();
    run(
        "valves-open",
        dir.path(),
        &["/time/end_s=0.001", "/time/window_s=0.001"],
    );
    export(dir.path(), &["--format", "vtk", "--times", "0"]);
    let parts = collection(&dir.path().join("vtk/valves-open.pvd"));
    let points = parts[2].2.points();
    for line in points.chunks_exact(points.len() / 9) {
        let step = |w: &[[f64; 3]]| (0..3).map(|c| (w[1][c] - w[0][c]).powi(2)).sum::<f64>().sqrt();
        let length: f64 = line.windows(2).map(step).sum();
        println!("tube of 20 mm drawn as {:.2} mm", 1e3 * length);
        assert!((length / 0.02 - 1.0).abs() < 0.05);
    }
}

#[test]
fn a_dry_beam_is_a_closed_block() {
    let dir = TempDir::new().unwrap();
    run("bend-dry", dir.path(), &["/time/end_s=0.01"]);
    export(dir.path(), &["--every", "5"]);
    let parts = collection(&dir.path().join("vtk/bend-dry.pvd"));
    assert!(parts.iter().all(|(_, name, _)| name == "beam"));
    let volume = parts[0].2.volume();
    println!("volume of the straight beam {volume:e} m^3");
    assert!((volume / (0.1 * 0.0216 * 0.05) - 1.0).abs() < 1e-12);
}

/// Junctions, ports, a closing valve and a rectified turbine are drawn too, with what is known of them.
#[test]
fn every_kind_of_connection_is_drawn() {
    let dir = TempDir::new().unwrap();
    run("network-tour", dir.path(), &["/time/end_s=0.01", "/time/window_s=0.01"]);
    export(dir.path(), &["--every", "5"]);
    let parts = collection(&dir.path().join("vtk/network-tour.pvd"));
    let (_, _, tubes) = &parts[2];
    let turbines = tubes.get("CellData turbine").iter().filter(|t| **t == 1.0).count();
    println!("{} lines, {turbines} turbine", tubes.get("Lines offsets").len());
    assert_eq!(turbines, 1);
    assert!(tubes.get("Points position_m").iter().all(|x| x.is_finite()));
}
