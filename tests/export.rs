//! `slcbeam export`: what ParaView and spreadsheets are given is what `fields.npz` holds, number for number.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use assert_cmd::Command;
use slcbeam::output::export::instants;
use slcbeam::output::reading;
use slcbeam::study::compare::Recording;
use tempfile::TempDir;

fn slcbeam(arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = Command::cargo_bin("slcbeam").unwrap().args(arguments).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code(), text(output.stdout), text(output.stderr))
}

/// A short run of a shipped case; its folder.
fn run(case: &str, dir: &Path, sets: &[&str]) {
    let path = format!("cases/{case}.json");
    let mut arguments = vec!["run", &path, "--quiet", "--out", dir.to_str().unwrap()];
    for set in sets {
        arguments.extend(["--set", set]);
    }
    let (code, _, told) = slcbeam(&arguments);
    assert_eq!(code, Some(0), "{told}");
}

fn export(dir: &Path, more: &[&str]) -> String {
    let mut arguments = vec!["export", dir.to_str().unwrap()];
    arguments.extend(more);
    let (code, said, told) = slcbeam(&arguments);
    assert_eq!(code, Some(0), "{told}");
    said
}

/// Value of an attribute in a tag.
fn attribute<'a>(tag: &'a str, name: &str) -> &'a str {
    let key = format!(" {name}=\"");
    let at = tag.find(&key).unwrap_or_else(|| panic!("no {name} in {tag}")) + key.len();
    tag[at..].split('"').next().unwrap()
}

/// A `.vtp` file: its time, and its arrays by section and name; integers as doubles.
struct Piece {
    time: f64,
    arrays: BTreeMap<String, Vec<f64>>,
}

impl Piece {
    fn read(path: &Path) -> Self {
        let bytes = fs::read(path).unwrap();
        let mark = b"<AppendedData encoding=\"raw\">\n_";
        let at = bytes.windows(mark.len()).position(|w| w == mark).unwrap();
        let (head, appended) = (std::str::from_utf8(&bytes[..at]).unwrap(), &bytes[at + mark.len()..]);
        assert!(head.contains("byte_order=\"LittleEndian\" header_type=\"UInt64\""));
        assert!(appended.ends_with(b"\n  </AppendedData>\n</VTKFile>\n"));
        let time = head
            .split("format=\"ascii\">")
            .nth(1)
            .unwrap()
            .split('<')
            .next()
            .unwrap();
        let mut arrays = BTreeMap::new();
        let mut section = "";
        for tag in head.split('<').skip(1) {
            let name = tag.split([' ', '>']).next().unwrap();
            match name {
                "PointData" | "CellData" | "Points" | "Lines" | "Polys" => section = name,
                "DataArray" if tag.contains("format=\"appended\"") => {
                    let offset: usize = attribute(tag, "offset").parse().unwrap();
                    let size = u64::from_le_bytes(appended[offset..offset + 8].try_into().unwrap()) as usize;
                    let data = &appended[offset + 8..offset + 8 + size];
                    let values = match attribute(tag, "type") {
                        "Float64" => data
                            .chunks_exact(8)
                            .map(|b| f64::from_le_bytes(b.try_into().unwrap()))
                            .collect(),
                        "Int32" => data
                            .chunks_exact(4)
                            .map(|b| f64::from(i32::from_le_bytes(b.try_into().unwrap())))
                            .collect(),
                        other => panic!("{other}"),
                    };
                    arrays.insert(format!("{section} {}", attribute(tag, "Name")), values);
                }
                _ => {}
            }
        }
        let piece = Self {
            time: time.parse().unwrap(),
            arrays,
        };
        piece.check(head);
        piece
    }

    fn get(&self, name: &str) -> &[f64] {
        self.arrays.get(name).unwrap_or_else(|| panic!("no {name}"))
    }

    fn points(&self) -> Vec<[f64; 3]> {
        let all = self.get("Points position_m").chunks_exact(3);
        all.map(|p| [p[0], p[1], p[2]]).collect()
    }

    fn quads(&self) -> Vec<[usize; 4]> {
        let all = self.get("Polys connectivity").chunks_exact(4);
        all.map(|q| [q[0] as usize, q[1] as usize, q[2] as usize, q[3] as usize])
            .collect()
    }

    /// Counts in the head are those of the arrays; every cell's points are there.
    fn check(&self, head: &str) {
        let piece = head.split('<').find(|t| t.starts_with("Piece")).unwrap();
        let count = |name: &str| attribute(piece, name).parse::<usize>().unwrap();
        let points = count("NumberOfPoints");
        assert_eq!(self.get("Points position_m").len(), 3 * points);
        let mut cells = 0;
        for (name, kind) in [("NumberOfLines", "Lines"), ("NumberOfPolys", "Polys")] {
            let (joined, ends) = (
                self.get(&format!("{kind} connectivity")),
                self.get(&format!("{kind} offsets")),
            );
            assert_eq!(ends.len(), count(name));
            assert_eq!(ends.last().copied().unwrap_or(0.0), joined.len() as f64);
            assert!(joined.iter().all(|&p| (p as usize) < points));
            cells += ends.len();
        }
        for (name, values) in &self.arrays {
            match name.split_once(' ').unwrap() {
                ("PointData", "u_m" | "v_m_s") => assert_eq!(values.len(), 3 * points, "{name}"),
                ("PointData", _) => assert_eq!(values.len(), points, "{name}"),
                ("CellData", _) => assert_eq!(values.len(), cells, "{name}"),
                _ => {}
            }
        }
    }

    /// Volume inside quadrilaterals that close and look outwards: flat ones count exactly.
    fn volume(&self) -> f64 {
        let p = self.points();
        let triple = |a: [f64; 3], b: [f64; 3], c: [f64; 3]| {
            a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
        };
        let of = |q: &[usize; 4]| triple(p[q[0]], p[q[1]], p[q[2]]) + triple(p[q[0]], p[q[2]], p[q[3]]);
        self.quads().iter().map(of).sum::<f64>() / 6.0
    }
}

/// The collection: time, part's name, file; all files are there and tell the same time.
fn collection(path: &Path) -> Vec<(f64, String, Piece)> {
    let text = fs::read_to_string(path).unwrap();
    let sets = text.split('<').filter(|t| t.starts_with("DataSet"));
    sets.map(|tag| {
        let piece = Piece::read(&path.with_file_name(attribute(tag, "file")));
        let t: f64 = attribute(tag, "timestep").parse().unwrap();
        assert_eq!(t, piece.time);
        (t, attribute(tag, "name").to_string(), piece)
    })
    .collect()
}

/// 10 and 11 instants of wiring-3, in which pressure, both rows and both networks differ.
const SHORT: [&str; 3] = [
    "/time/end_s=0.02",
    "/time/window_s=0.01",
    "/time/fields_interval_s=0.002",
];

fn the_beam(piece: &Piece, from: &Recording, k: usize) {
    let row = |name: &str| from.field(name).unwrap().row(k);
    let theta = from.axis("theta_node_m").unwrap();
    let (points, at) = (piece.points(), piece.get("PointData theta_m"));
    for (node, &x) in theta.iter().enumerate() {
        // Twelve points a section: two sides, six heights; opposite corners are the first and the last.
        let section: Vec<usize> = (0..at.len()).filter(|&i| at[i] == x).collect();
        assert_eq!(section.len(), 12, "node {node}");
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
            let moved = middle + 0.5 * (u3[4 * label.abs() as usize - 2] + u3[4 * label.abs() as usize - 2]);
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

#[test]
fn tables_hold_the_fields_number_for_number() {
    let dir = TempDir::new().unwrap();
    run("wiring-3", dir.path(), &SHORT);
    export(dir.path(), &["--format", "csv"]);
    let from = reading::read(dir.path()).unwrap();
    for field in &from.fields {
        let text = fs::read_to_string(dir.path().join(format!("csv/{}.csv", field.name))).unwrap();
        let mut lines = text.lines();
        let heading: Vec<&str> = lines.next().unwrap().split(',').collect();
        assert_eq!((heading.len(), heading[0]), (field.len + 1, "t [s]"));
        match field.name.as_str() {
            "pressure_pa" => assert_eq!(
                heading[1..4],
                ["bladder=1 s=0.0115 m", "bladder=1 s=0.0345 m", "bladder=2 s=0.0115 m"]
            ),
            "normal_force_n" => assert_eq!(heading[1], "theta=0.00125 m"),
            "u1_m" => assert_eq!((heading[1], heading[41]), ("theta=0 m", "theta=0.1 m")),
            _ => {}
        }
        let rows: Vec<Vec<f64>> = lines
            .map(|l| l.split(',').map(|x| x.parse().unwrap()).collect())
            .collect();
        assert_eq!(rows.len(), from.field_times.len());
        for (k, row) in rows.iter().enumerate() {
            assert_eq!(
                (row[0], &row[1..]),
                (from.field_times[k], field.row(k)),
                "{}",
                field.name
            );
        }
    }
}

#[test]
fn instants_are_chosen_by_time_and_number() {
    let times: Vec<f64> = (0..=10).map(|k| 0.1 * f64::from(k)).collect();
    let choose = |list: Option<&str>, every| instants::choose(&times, list, every);
    assert_eq!(choose(None, 1).unwrap().len(), 11);
    assert_eq!(choose(None, 4).unwrap(), [0, 4, 8]);
    assert_eq!(choose(Some("0.52,0.1:0.3"), 1).unwrap(), [1, 2, 3, 5]);
    assert_eq!(choose(Some("0:1"), 5).unwrap(), [0, 5, 10]);
    // 0.1 * 3 is a little more than 0.3: the range still holds it.
    assert_eq!(choose(Some("0.3:0.3"), 1).unwrap(), [3]);
    for bad in ["2", "0.3:0.1", "0.31:0.32", "x", "", "nan", "0.1:"] {
        let told = choose(Some(bad), 1).unwrap_err();
        println!("{told}");
        assert_eq!(told.exit_code(), 2);
        assert!(told.to_string().contains("from 0 s to 1 s"), "{told}");
    }
}

#[test]
fn what_cannot_be_exported_is_refused_with_a_reason() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().to_str().unwrap();
    let (code, _, told) = slcbeam(&["export", path]);
    assert_eq!(code, Some(2));
    assert!(told.contains("no case.json"), "{told}");
    run("two-bladders", dir.path(), &["/time/end_s=0.001"]);
    fs::remove_file(dir.path().join("fields.npz")).unwrap();
    let (code, _, told) = slcbeam(&["export", path]);
    assert!(code == Some(2) && told.contains("no fields.npz"), "{told}");
    fs::create_dir(dir.path().join("fields.part")).unwrap();
    let (code, _, told) = slcbeam(&["export", path]);
    assert!(code == Some(2) && told.contains("--resume"), "{told}");
    fs::write(dir.path().join("fields.npz"), "no archive").unwrap();
    let (code, _, told) = slcbeam(&["export", path]);
    assert!(code == Some(5) && told.contains("fields.npz"), "{told}");
}

/// A second run into the folder takes the exports of the first away, and nothing that is not an export.
#[test]
fn exports_do_not_outlive_their_result() {
    let dir = TempDir::new().unwrap();
    let short = ["/time/end_s=0.001"];
    run("two-bladders", dir.path(), &short);
    export(dir.path(), &[]);
    assert!(dir.path().join("csv/u1_m.csv").exists() && dir.path().join("vtk/two-bladders.pvd").exists());
    fs::write(dir.path().join("csv/notes.txt"), "mine").unwrap();
    run("two-bladders", dir.path(), &short);
    assert!(dir.path().join("csv/notes.txt").exists() && !dir.path().join("vtk").exists());

    // Elsewhere, and told as JSON.
    let other = TempDir::new().unwrap();
    let said = export(
        dir.path(),
        &["--json", "--format", "vtk", "--out", other.path().to_str().unwrap()],
    );
    let told: serde_json::Value = serde_json::from_str(&said).unwrap();
    let files = fs::read_dir(other.path().join("vtk")).unwrap().count();
    assert_eq!(told["formats"]["vtk"]["files"], files);
    assert!(!dir.path().join("vtk").exists());
    // A thinner film leaves none of the frames of the first behind.
    let thin = [
        "--format",
        "vtk",
        "--times",
        "0",
        "--out",
        other.path().to_str().unwrap(),
    ];
    export(dir.path(), &thin);
    assert_eq!(fs::read_dir(other.path().join("vtk")).unwrap().count(), 4);
}
