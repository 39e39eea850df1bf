//! Fields, shapes and exports of a structure give the places of its beams.

use std::fs;
use std::path::Path;

use slcbeam::output::reading;
use slcbeam::study::compare::Recording;
use tempfile::TempDir;

use super::piece::collection;
use super::{export, slcbeam};

const ELL: &str = "tests/data/ell.json";
const BEAMS: [&str; 3] = ["left", "up", "arm"];

/// Runs the structure; its recording.
fn recorded(dir: &Path) -> Recording {
    let (code, _, stderr) = slcbeam(&["run", ELL, "--quiet", "--out", dir.to_str().unwrap()]);
    assert_eq!(code, Some(0), "{stderr}");
    reading::read(dir).unwrap()
}

/// Position of the tip of a beam at the last output time [m].
fn tip(from: &Recording, beam: &str) -> [f64; 2] {
    ["x", "z"].map(|axis| {
        *from
            .column(&format!("{beam}.tip_{axis}"))
            .unwrap()
            .values
            .last()
            .unwrap()
    })
}

/// Last node of a beam.
fn last_node(from: &Recording, beam: usize) -> usize {
    let number = from.axis("beam_node").unwrap();
    number.iter().rposition(|one| *one as usize == beam + 1).unwrap()
}

#[test]
fn fields_and_columns_place_the_tips() {
    let dir = TempDir::new().unwrap();
    let from = recorded(dir.path());
    let last = from.field_times.len() - 1;
    assert_eq!(from.field_times[last], *from.times.last().unwrap());
    for (k, beam) in BEAMS.iter().enumerate() {
        let node = last_node(&from, k);
        let at = |axis: &str| from.axis(axis).unwrap()[node];
        let u = ["u1_m", "u3_m"].map(|field| from.field(field).unwrap().row(last)[node]);
        let (sin, cos) = at("angle_node_rad").sin_cos();
        let found = [
            at("x_node_m") + u[0] * cos + u[1] * sin,
            at("z_node_m") + u[1] * cos - u[0] * sin,
        ];
        let wanted = tip(&from, beam);
        assert!(
            (0..2).all(|axis| (found[axis] - wanted[axis]).abs() < 1e-15),
            "{beam}: {found:?} {wanted:?}"
        );
    }
    // the headline tip is that of the first beam, not of its part before the joint
    assert_eq!(
        from.column("tip_u1").unwrap().values,
        from.column("left.tip_u1").unwrap().values
    );
    let cells = from.axis("theta_cell_m").unwrap();
    assert_eq!((cells.len(), from.field("normal_force_n").unwrap().len), (18, 18));
}

#[test]
fn exports_name_beams_and_place_them() {
    let dir = TempDir::new().unwrap();
    let from = recorded(dir.path());
    export(dir.path(), &[]);
    let heading = |field: &str| {
        let text = fs::read_to_string(dir.path().join(format!("csv/{field}.csv"))).unwrap();
        text.lines().next().unwrap().to_owned()
    };
    let u1 = heading("u1_m");
    assert!(u1.starts_with("t [s],beam=left theta=0 m,"), "{u1}");
    assert!(
        u1.contains(",beam=left theta=0.025 m,beam=left theta=0.025 m behind the joint,"),
        "{u1}"
    );
    assert!(
        u1.contains(",beam=up theta=0 m,") && u1.contains(",beam=arm theta=0.03 m"),
        "{u1}"
    );
    assert!(heading("normal_force_n").contains("beam=up theta=0.0"));
    assert!(heading("pressure_pa").contains("bladder=left:3 s=0.0015 m"));

    let film = collection(&dir.path().join("vtk/ell.pvd"));
    let piece = &film.iter().rfind(|(_, part, _)| part == "beam").unwrap().2;
    let (points, theta) = (piece.points(), piece.get("PointData theta_m"));
    for (k, beam) in BEAMS.iter().enumerate() {
        // the centre of the last section of the beam, between its upper and its lower edge
        let length = from.axis("theta_node_m").unwrap()[last_node(&from, k)];
        let [x, z] = tip(&from, beam);
        let near = |i: &usize| {
            let [axial, transverse, _] = points[*i];
            theta[*i] == length && (axial - z).hypot(transverse - x) < 0.0021
        };
        let section: Vec<usize> = (0..points.len()).filter(near).collect();
        assert!(section.len() >= 12, "{beam}: {}", section.len());
        for axis in [0, 1] {
            let mean = section.iter().map(|i| points[*i][axis]).sum::<f64>() / section.len() as f64;
            assert!((mean - [z, x][axis]).abs() < 1e-12, "{beam}: {mean}");
        }
    }
    let numbers = piece.get("CellData beam");
    assert!((1..=3).all(|k| numbers.contains(&f64::from(k))));
}

#[test]
fn shapes_of_equilibria_are_in_the_axes_of_the_case() {
    let dir = TempDir::new().unwrap();
    let (code, stdout, stderr) = slcbeam(&["equilibrium", ELL, "--out", dir.path().to_str().unwrap()]);
    assert_eq!(code, Some(0), "{stderr}");
    assert!(stdout.contains("up.tip_u1"), "{stdout}");
    let read = |file: &str| {
        let mut reader = csv::Reader::from_path(dir.path().join(file)).unwrap();
        let heads: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
        let rows: Vec<Vec<String>> = reader
            .records()
            .map(|r| r.unwrap().iter().map(str::to_owned).collect())
            .collect();
        (heads, rows)
    };
    let ((heads, shapes), (columns, path)) = (read("shapes.csv"), read("path.csv"));
    assert_eq!(heads[..2], ["beam", "theta [m]"]);
    for beam in BEAMS {
        let row = shapes.iter().rfind(|row| row[0] == beam).unwrap();
        for (back, axis) in [(2, "x"), (1, "z")] {
            let column = columns
                .iter()
                .position(|name| *name == format!("{beam}.tip_{axis} [m]"))
                .unwrap();
            let [found, wanted] =
                [&row[row.len() - back], &path[path.len() - 1][column]].map(|x| x.parse::<f64>().unwrap());
            assert!((found - wanted).abs() < 1e-15, "{beam} {axis}: {found} {wanted}");
        }
    }
}

/// Goal: analyses of one beam refuse a structure, and name what they need.
#[test]
fn analyses_of_one_beam_refuse_structures() {
    for command in ["mapping", "bands", "sense"] {
        let (code, _, stderr) = slcbeam(&[command, ELL]);
        let refused = code == Some(2) && stderr.contains("a single one is needed");
        assert!(refused, "{command}: {code:?} {stderr}");
    }
}
