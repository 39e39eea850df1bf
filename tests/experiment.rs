//! A published actuator, predicted from its drawing and its material without fitting: docs/experiment.md.
//!
//! Source: `cases/ecoflex-actuator.csv` and `cases/ecoflex-tension.csv`, whose heads say where they are from. Angles are differences from
//! 12 kPa: the source sets its zero near 10 kPa and jumps there. Bands of measured over predicted are what was found, 4 % to both sides: no
//! goal of accuracy, but a change of the model, or of how it is asked, shows.

use std::path::Path;
use std::sync::LazyLock;

use slcbeam::case::{self, Case};
use slcbeam::run::equilibrium::{self, EquilibriumOptions};
use slcbeam::run::record::Control;
use slcbeam_section::cell::Cell;
use slcbeam_section::coefficients::{Numbers, Options as Meshes};
use slcbeam_section::finite::{Drive, FiniteCell, Law};
use slcbeam_section::input::Section;
use slcbeam_section::mesh::Fineness;

const SECTION: &str = include_str!("../cases/sections/ecoflex-actuator.json");
const CASE: &str = include_str!("../cases/ecoflex-actuator.json");
const MEASURED: &str = include_str!("../cases/ecoflex-actuator.csv");
const TENSION: &str = include_str!("../cases/ecoflex-tension.csv");

/// Thickness of the film and of the silicone between it and a chamber [m].
const FILM: f64 = 5e-5;
/// Length of a chamber along the beam, its width and height [m].
const CHAMBER: [f64; 3] = [0.002, 0.008, 0.008];
/// Pressures at which angles are compared [kPa], the first where the differences begin.
const AT: [f64; 4] = [12.0, 15.0, 20.0, 25.0];

/// The section of the source with walls of 7 mm.
fn thin() -> Section {
    serde_json::from_str(SECTION).unwrap()
}

/// The section of the source with walls of this thickness [m].
fn section(wall: f64) -> Section {
    let mut section = thin();
    let old = section.pitch_m - CHAMBER[0];
    let mut value = serde_json::to_value(&section).unwrap();
    let bottom = -(CHAMBER[2] + wall + FILM) / 2.0;
    value["regions"][0]["shape"]["layer"]["high_m"] = serde_json::json!([bottom, bottom + FILM]);
    value["bladders"]["upper"]["center_m"] = (bottom + 1.5 * FILM + CHAMBER[2] / 2.0).into();
    section = serde_json::from_value(value).unwrap();
    section.pitch_m += wall - old;
    section.height_m += wall - old;
    section.width_m += 2.0 * (wall - old);
    section
}

/// A material by its modulus [Pa] and law.
#[derive(Clone, Copy)]
struct Reading {
    what: &'static str,
    young: f64,
    /// None: small strains.
    law: Option<Law>,
    /// Measured over predicted rise, of each specimen to each pressure of [AT] behind the first; 0 where there is no prediction.
    found: [[f64; 3]; 3],
}

/// Yeoh's law with the constants [Pa] as they are printed.
fn yeoh(what: &'static str, [c1, c2, c3]: [f64; 3], found: [[f64; 3]; 3]) -> Reading {
    Reading {
        what,
        young: 6.0 * c1,
        law: Some(Law::Yeoh {
            second: c2 / c1,
            third: c3 / c1,
        }),
        found,
    }
}

/// Rows of a table under its head.
fn rows(table: &str) -> impl Iterator<Item = Vec<&str>> {
    let lines = table.lines().filter(|line| !line.starts_with('#')).skip(1);
    lines.map(|line| line.split(',').collect())
}

/// The neo-Hookean modulus of the first half of a stretch, by least squares: a specimen of 50 mm, 15 mm^2.
fn first_stretch() -> f64 {
    let (mut up, mut down) = (0.0, 0.0);
    for row in rows(TENSION) {
        let [length, force] = [0, 1].map(|k| row[k].parse::<f64>().unwrap());
        let stretch = length / 50.0;
        let shape = stretch - stretch.powi(-2);
        up += shape * force / 15e-6;
        down += shape * shape;
    }
    3.0 * up / down
}

fn readings() -> [Reading; 4] {
    [
        Reading {
            what: "fit to tension, small strains",
            young: 79337.3723514,
            law: None,
            found: [[1.66, 2.15, 2.76], [1.51, 2.04, 2.77], [1.91, 2.16, 2.76]],
        },
        yeoh(
            "fit to tension",
            [13222.8953919, -142.340890598, 20.1153264248],
            [[1.19, 1.40, 1.60], [1.08, 1.32, 1.60], [1.31, 1.33, 1.52]],
        ),
        yeoh(
            "fit to planar tension",
            [11112.2390596, -108.690462634, 23.3374558269],
            [[0.92, 1.04, 1.14], [0.83, 0.98, 1.14], [1.01, 1.00, 1.11]],
        ),
        Reading {
            what: "tension from its beginning",
            young: first_stretch(),
            law: Some(Law::NeoHookean),
            found: [[0.82, 0.92, 0.97], [0.75, 0.87, 0.98], [0.91, 0.89, 0.97]],
        },
    ]
}

/// By how much more the plane cell bends at finite strain than linearly, at each kPa from 1 to `most`; None from where it has no
/// equilibrium. The core is as wide as a chamber; beside it stand bars of silicone, which stretch by a few percent and count as linear.
fn growth(section: &Section, reading: &Reading, most: usize) -> Vec<Option<f64>> {
    let Some(law) = reading.law else {
        return vec![Some(1.0); most];
    };
    let mut core = section.clone();
    core.width_m = core.bladders.length_m;
    core.material.young_modulus_pa = reading.young;
    core.material.poisson_ratio = 0.49;
    core.material.law = Some(law);
    // the mesh hardly matters to a growth
    let fineness = Fineness {
        largest: 0.5,
        corner: 0.05,
        wall: 1.4,
        arc: 0.8,
        growth: 1.2,
    };
    let one = Meshes { fineness, meshes: 1 };
    let mesh = core.meshes(&one).unwrap().remove(0);
    let cell = FiniteCell::new(&core, Cell::new(&core, &mesh), law).unwrap();
    let (low, high) = (FILM - section.height_m / 2.0, section.height_m / 2.0);
    let bars = reading.young * (section.width_m - core.width_m);
    let moment = |k: i32| bars * (high.powi(k) - low.powi(k)) / f64::from(k);
    let (mut state, mut before) = (cell.rest(), [0.0; 2]);
    let mut strain = [0.0; 2];
    // Newton's steps of stretch and curvature, by which forces and moments of core and bars cancel
    let mut at = |pressure: f64| {
        let larger = if before[0] > 0.0 { pressure / before[0] } else { 1.0 };
        strain = strain.map(|part| part * larger);
        for _ in 0..20 {
            let now = [pressure, 0.0];
            let found = cell.follow(&mut state, before, Drive::Strain(strain), now).ok()?;
            before = now;
            let s = |i: usize, j: usize| found.tangent[i][j] + moment(1 + (i + j) as i32);
            let bar = |i: usize| (0..2).map(|j| moment(1 + (i + j) as i32) * strain[j]).sum::<f64>();
            let off = [0, 1].map(|i| found.resultants[i] + bar(i));
            let det = s(0, 0) * s(1, 1) - s(0, 1) * s(1, 0);
            let step = [
                (s(0, 1) * off[1] - s(1, 1) * off[0]) / det,
                (s(1, 0) * off[0] - s(0, 0) * off[1]) / det,
            ];
            (0..2).for_each(|i| strain[i] += step[i]);
            if step[1].abs() < 1e-4 * strain[1].abs() {
                return Some(strain[1] / pressure);
            }
        }
        None
    };
    let small = at(100.0).unwrap();
    let mut lost = false;
    let found = (1..=most).map(|kpa| {
        let bent = if lost { None } else { at(1e3 * kpa as f64) };
        lost = bent.is_none();
        Some(bent? / small)
    });
    found.collect()
}

/// Degrees of the chord of so many pitches of a curvature: half of what the tip turns by. Half a wall at each end stays straight, which
/// does not change the chord.
fn chord(chambers: f64, pitch: f64, curvature: f64) -> f64 {
    (chambers * pitch * curvature / 2.0).to_degrees()
}

struct Specimen {
    name: &'static str,
    chambers: f64,
    /// Which of the two sections.
    wall: usize,
}

const SPECIMENS: [Specimen; 3] = [
    Specimen {
        name: "c5-w7",
        chambers: 5.0,
        wall: 0,
    },
    Specimen {
        name: "c7-w7",
        chambers: 7.0,
        wall: 0,
    },
    Specimen {
        name: "c5-w10",
        chambers: 5.0,
        wall: 1,
    },
];

/// Measured angle at a pressure [kPa], above a zero of its own [degrees].
fn angle(name: &str, pressure: f64) -> f64 {
    let found = rows(MEASURED).find(|row| row[0] == name && row[1].parse::<f64>().unwrap() == pressure);
    found.unwrap()[2].parse().unwrap()
}

fn in_space(section: &Section) -> Numbers {
    section.coefficients(&Meshes::default()).unwrap().numbers
}

/// Of thin walls, in space, and the growth of the softest reading beyond where its cell ends: seconds each, and wanted by several tests.
static THIN: LazyLock<Numbers> = LazyLock::new(|| in_space(&thin()));
static SOFTEST: LazyLock<Vec<Option<f64>>> = LazyLock::new(|| growth(&thin(), &readings()[3], 28));

/// Curvature by pressure [1/(m Pa)].
fn per_pressure(numbers: &Numbers) -> f64 {
    numbers.compliance[1][2]
}

fn case() -> Case {
    case::parse(CASE, Path::new("mine.json"), Path::new(""), &[]).unwrap()
}

/// Goal: the numbers of the case are those of its section: of six digits, about the axis where force and curvature part.
#[test]
fn the_case_has_the_numbers_of_its_section() {
    let (section, numbers) = (thin(), &*THIN);
    let c = &numbers.compliance;
    let (axis, case) = (-c[0][1] / c[1][1], case());
    assert!((axis + section.height_m / 2.0 - FILM / 2.0).abs() < FILM, "{axis}");
    let (bladders, fill) = (
        case.bladders.as_ref().unwrap(),
        section.bladders.length_m / section.pitch_m,
    );
    let full = section.material.young_modulus_pa * section.height_m * section.width_m;
    let pairs = [
        (case.beam.height_m, section.height_m),
        (case.beam.neutral_axis_m, axis),
        (case.beam.width_m, section.width_m),
        (case.beam.young_modulus_pa, section.material.young_modulus_pa),
        (case.beam.length_m, 7.0 * section.pitch_m),
        (
            case.beam.axial_stiffness_factor,
            1.0 / (c[0][0] - c[0][1] * c[0][1] / c[1][1]) / full,
        ),
        (
            case.beam.bending_stiffness_factor,
            12.0 / (c[1][1] * full * section.height_m.powi(2)),
        ),
        (
            case.beam.mass_factor.unwrap(),
            numbers.solid_mass_kg_per_m * section.material.young_modulus_pa / (1070.0 * full),
        ),
        (
            bladders.area_per_pressure_m2_per_pa,
            numbers.area_per_pressure_m2_per_pa,
        ),
        (bladders.area_per_moment_m2_per_n_m.opening, c[1][2] / fill),
        (
            bladders.area_per_force_m2_per_n.tension,
            (c[0][2] + axis * c[1][2]) / fill,
        ),
        (bladders.permeability_m4.unwrap(), numbers.permeability_m4),
    ];
    for (k, (given, own)) in pairs.into_iter().enumerate() {
        // the area by force about the axis is a small difference of large numbers
        let goal = if k == 10 { 1e-2 } else { 1e-5 };
        assert!((given / own - 1.0).abs() < goal, "{k}: {given} {own}");
    }
}

/// Goal: the beam of the case bends by the curvature of its cell, and its chord is half of what its tip turns by: 0.1 %, for six digits
/// and the length of an arc.
#[test]
fn the_beam_bends_by_what_its_section_says() {
    let case = case();
    let path = equilibrium::follow(&case, &EquilibriumOptions::at(2.4), &mut |_| Control::Continue).unwrap();
    assert!(path.fault.is_none(), "{:?}", path.fault);
    let columns = equilibrium::columns(&equilibrium::system(&case, 2.4).unwrap());
    let tip = |name: &str| path.last().row[columns.iter().position(|c| c.name == name).unwrap()];
    let own = chord(7.0, thin().pitch_m, 20e3 * per_pressure(&THIN));
    let found = -(tip("tip_u1") / (0.063 + tip("tip_u3"))).atan().to_degrees();
    println!("chord at 20 kPa by the linear section: {own:.3} degrees, beam {found:.3}");
    assert!((found / own - 1.0).abs() < 1e-3, "{found} {own}");
    assert!((tip("tip_angle").to_degrees() / own / 2.0 + 1.0).abs() < 1e-3);
}

/// Goal: measured over predicted rise of the chord from 12 kPa, for every specimen, reading of the material and pressure: as they were
/// found, 4 % to both sides.
#[test]
fn measured_over_predicted_is_what_it_was() {
    let sections = [thin(), section(0.010)];
    let readings = readings();
    let (linear, growths) = std::thread::scope(|scope| {
        let sections = &sections;
        let grown = |reading| sections.each_ref().map(|s| growth(s, reading, AT[3] as usize));
        let running: Vec<_> = readings[..3].iter().map(|r| scope.spawn(move || grown(r))).collect();
        let softest = [SOFTEST.clone(), growth(&sections[1], &readings[3], AT[3] as usize)];
        let linear = [per_pressure(&THIN), per_pressure(&in_space(&sections[1]))];
        let mut all: Vec<_> = running.into_iter().map(|r| r.join().unwrap()).collect();
        all.push(softest);
        (linear, all)
    });
    println!("linear, 3-D: {linear:?} 1/(m Pa)");
    for (reading, grown) in readings.iter().zip(&growths) {
        println!("{}, E {:.0} Pa", reading.what, reading.young);
        for (n, specimen) in SPECIMENS.iter().enumerate() {
            let (w, pitch) = (specimen.wall, sections[specimen.wall].pitch_m);
            // beside a film so stiff the compliance goes with 1/E
            let softer = sections[w].material.young_modulus_pa / reading.young;
            let bent = |k: usize| {
                Some(chord(
                    specimen.chambers,
                    pitch,
                    1e3 * AT[k] * linear[w] * softer * grown[w][AT[k] as usize - 1]?,
                ))
            };
            for (k, &kpa) in AT.iter().enumerate().skip(1) {
                let seen = angle(specimen.name, kpa) - angle(specimen.name, AT[0]);
                let ratio = bent(k).map(|own| seen / (own - bent(0).unwrap()));
                println!(
                    "  {} {kpa} kPa: measured {seen:.2}, over predicted {ratio:.3?}",
                    specimen.name
                );
                let wanted = reading.found[n][k - 1];
                assert_eq!(ratio.is_some(), wanted > 0.0);
                if let Some(ratio) = ratio {
                    assert!((ratio / wanted - 1.0).abs() < 0.04, "{ratio} {wanted}");
                }
            }
        }
    }
}

/// Goal: what the prediction leaves out is as small as docs/experiment.md says: the tunnel between the chambers, 2 mm high and wide along the
/// film, bends by 2 to 3 % more; weight that hangs straightens by 2 to 8 %, by first order in `w L^3/EI`; an angle to the far corner of the
/// tip, and not to the film there, is 4 to 8 % larger.
#[test]
fn what_is_left_out_is_small() {
    let walls = [0.007, 0.010];
    let plane = walls.map(|wall| Section {
        three_d: false,
        ..section(wall)
    });
    let all = plane.each_ref().map(in_space);
    for specimen in &SPECIMENS {
        let (wall, section, numbers) = (walls[specimen.wall], &plane[specimen.wall], &all[specimen.wall]);
        let c = &numbers.compliance;
        let tunnel = 4e-9 * (wall / section.pitch_m) * c[1][1] / c[1][2];
        let (length, height) = (specimen.chambers * section.pitch_m + wall, 0.008 + wall);
        let weight = 7.0 / 60.0 * 9.81 * numbers.solid_mass_kg_per_m * length.powi(3) * c[1][1];
        let corner = (length.powi(2) + 2.0 * height.powi(2)) / (length.powi(2) + height.powi(2)) - 1.0;
        println!(
            "{}: tunnel {tunnel:.3}, weight {weight:.3}, corner {corner:.3}",
            specimen.name
        );
        assert!((0.015..0.035).contains(&tunnel), "{tunnel}");
        assert!((0.02..0.08).contains(&weight), "{weight}");
        assert!((0.04..0.08).contains(&corner), "{corner}");
    }
}

/// Goal: the two runs of one specimen agree from 20 to 25 kPa and differ threefold from 25 to 30: nothing above 25 kPa is held against the model.
#[test]
fn the_measurement_repeats_up_to_25_kpa() {
    let rise = |name: &str, from: f64, to: f64| angle(name, to) - angle(name, from);
    let [once, again] = ["c7-w7", "c7-w7-steps"].map(|name| [rise(name, 20.0, 25.0), rise(name, 25.0, 30.0)]);
    println!("{once:?} {again:?}");
    assert!((once[0] / again[0] - 1.0).abs() < 0.03);
    assert!(once[1] / again[1] > 3.0);
}

/// Goal: where the plane cell ends, as docs/experiment.md says, with walls of 7 mm of the softest reading.
#[test]
fn the_cell_balloons_near_27_kpa() {
    println!("{:?}", *SOFTEST);
    assert!(SOFTEST[25].is_some() && SOFTEST[27].is_none());
    assert!((0.41..0.45).contains(&(27e3 / readings()[3].young)));
}
