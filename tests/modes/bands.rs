//! Sources: closed forms and transfer matrices of periodic beams and bars, in extended precision.
//! Goal: waves of a repeating cell, read from the middle of a beam, are those of the infinite beam.
//! Tolerance: 1e-8 of cos μ after extrapolation.

use std::f64::consts::{PI, TAU};
use std::fs;

use nalgebra::Complex;
use serde_json::{Value, json};
use slcbeam::run::bands::waves::{BlochWave, Lattice};
use slcbeam::run::response::LinearResponse;
use slcbeam::study::bands::{bands, coupling_number, spectrum};

use tempfile::TempDir;

use super::cli::run;
use super::common::checked;

/// Length 1 m, EI 1 N m^2, 1 kg/m, EA 1.2e5 N, ten segments, with attachments at the ends of segments.
pub(super) fn beam(cells: usize, attached: &Value) -> Value {
    let attachments: Vec<Value> = (1..10)
        .map(|k| {
            let mut one = attached.clone();
            one["at"] = json!(f64::from(k) / 10.0);
            one
        })
        .collect();
    json!({
        "name": "periodic",
        "beam": {"length_m": 1.0, "height_m": 0.01, "width_m": 0.01, "young_modulus_pa": 1.2e9, "density_kg_m3": 1e4},
        "attachments": attachments, "ends": {"root": "clamped", "tip": "free"}, "effects": {"rotary_inertia": "off"},
        "mesh": {"segments": 10, "cells_per_segment": cells}, "time": {"end_s": 1.0}
    })
}

pub(super) fn lattice(case: &Value) -> Lattice {
    Lattice::new(&checked(case)).unwrap()
}

fn waves(lattice: &Lattice, hz: f64) -> Vec<BlochWave> {
    lattice.waves(Complex::new(0.0, TAU * hz))
}

/// `cos μ` of the wave of bending, or of stretch, that has the nearest one.
pub(super) fn cosine(lattice: &Lattice, stretch: bool, hz: f64, near: Complex<f64>) -> Complex<f64> {
    let own = |wave: &BlochWave| {
        let energy = lattice.energy(wave);
        (energy.stretch > energy.bending) == stretch
    };
    let cosines = waves(lattice, hz)
        .into_iter()
        .filter(own)
        .map(|wave| 0.5 * (wave.factor + wave.factor.inv()));
    cosines
        .min_by(|a, b| (a - near).norm().total_cmp(&(b - near).norm()))
        .unwrap()
}

/// Limit of four meshes of second order, each of twice as many cells (Richardson).
pub(super) fn limit(of: impl Fn(usize) -> Complex<f64>, cells: [usize; 4]) -> Complex<f64> {
    let between = |row: Vec<Complex<f64>>, weight: f64| -> Vec<Complex<f64>> {
        row.windows(2)
            .map(|pair| pair[1] + (pair[1] - pair[0]) / weight)
            .collect()
    };
    [3.0, 15.0, 63.0].into_iter().fold(cells.map(of).to_vec(), between)[0]
}

/// Source: Mead 1970, beam on periodic supports: cos μ = (sinh b cos b - cosh b sin b)/(sinh b - sin b), b^4 = m w^2 a^4/EI. The supports are
/// springs 1e11 times as stiff as a cell.
#[test]
fn a_beam_on_supports_has_the_waves_of_its_closed_form() {
    for b in [2.0, 3.0, 3.9, 5.5_f64] {
        let exact = (b.sinh() * b.cos() - b.cosh() * b.sin()) / (b.sinh() - b.sin());
        let hz = (b / 0.1).powi(2) / TAU;
        let supported = |cells| lattice(&beam(cells, &json!({"stiffness_x_n_m": 1e14})));
        let of = |cells| cosine(&supported(cells), false, hz, exact.into());
        let found = limit(of, [16, 32, 64, 128]);
        assert!(
            (found - exact).norm() < 1e-8 * exact.abs().max(1.0),
            "{b}: {found} for {exact}"
        );
    }
}

/// Source: a bar with a mass of r bars at each cell: cos μ = cos W - (r W/2) sin W, W = w a sqrt(m/EA); its gaps begin at W = 1.720667178039,
/// 4.057515676221 for r = 1 and end at multiples of π.
#[test]
fn a_bar_with_masses_has_the_gaps_of_its_closed_form() {
    let hz = |w: f64| w / 0.1 * 1.2e5_f64.sqrt() / TAU;
    let loaded = |cells| lattice(&beam(cells, &json!({"mass_kg": 0.1})));
    for w in [0.4, 1.0, 2.5_f64] {
        let exact = w.cos() - 0.5 * w * w.sin();
        let found = limit(
            |cells| cosine(&loaded(cells), true, hz(w), exact.into()),
            [8, 16, 32, 64],
        );
        assert!((found - exact).norm() < 1e-8, "{w}: {found} for {exact}");
    }
    for (w, number) in [(1.720667178039, PI), (PI, PI), (4.057515676221, 0.0), (TAU, 0.0)] {
        let of = |cells| {
            let bounds = [0.97, 1.03].map(|by| TAU * by * hz(w));
            let lattice = loaded(cells);
            let mut axial = lattice.frequencies(number, bounds).into_iter();
            let axial = axial.find(|wave| lattice.energy(wave).stretch > 0.5).unwrap();
            axial.s / TAU
        };
        let found = limit(of, [8, 16, 32, 64]);
        assert!(
            (found.im - hz(w)).abs() < 1e-8 * hz(w),
            "{w}: {} for {}",
            found.im,
            hz(w)
        );
    }
}

/// The paper's beam without rotary inertia and inertia of the fluid; bladders sealed, joined in pairs across the beam, or in chains.
pub(super) fn papers(wiring: &str, [cells, along]: [usize; 2]) -> Value {
    let ends = json!(["sealed", "sealed"]);
    let all = |sign: i64| (1..=10).map(|k| sign * k).collect::<Vec<i64>>();
    let lists: Vec<Vec<i64>> = match wiring {
        "pairs" => (1..=10).map(|k| vec![k, -k]).collect(),
        "chains" => vec![all(1), all(-1)],
        _ => all(1).into_iter().chain(all(-1)).map(|k| vec![k]).collect(),
    };
    let chains: Vec<Value> = lists
        .iter()
        .map(|list| json!({"bladders": list, "ends": ends}))
        .collect();
    json!({
        "name": "papers", "preset": "matia-gat-beam", "network": {"chains": chains}, "formulation": "conservative",
        "bladders": {"coupling": "reciprocal", "area_per_moment_m2_per_n_m": {"opening": 5.145e-6, "closing": 5.145e-6}},
        "effects": {"rotary_inertia": "off", "tube_inertia": "off"}, "ends": {"root": "clamped", "tip": "free"},
        "mesh": {"cells_per_segment": cells, "cells_per_bladder": along}, "time": {"end_s": 1.0}
    })
}

/// Source: products of transfer matrices of an Euler-Bernoulli line whose mean curvature in a segment drives diffusion lines of pressure.
#[test]
fn the_papers_beam_has_the_waves_of_its_transfer_matrix() {
    for (wiring, hz, number) in [
        ("sealed", 10.0, (0.1664720398, 0.0)),
        ("sealed", 50.0, (0.3723072654, 0.0)),
        ("sealed", 100.0, (0.5266350246, 0.0)),
        ("pairs", 10.0, (0.1695176675, 3.224e-5)),
        ("pairs", 50.0, (0.3790343511, 3.55990e-4)),
        ("pairs", 100.0, (0.5359552312, 9.86023e-4)),
        ("chains", 10.0, (0.1681612657, 1.54090e-3)),
        ("chains", 50.0, (0.3760483738, 3.404986e-3)),
        ("chains", 10.0, (0.1118922151, 0.1119655498)),
        ("chains", 50.0, (0.2498670427, 0.2506868311)),
    ] {
        let exact = Complex::new(number.0, -number.1).cos();
        let of = |along: usize| {
            limit(
                |cells| cosine(&lattice(&papers(wiring, [cells, along])), false, hz, exact),
                [2, 4, 8, 16],
            )
        };
        let found = match wiring {
            "sealed" => of(2),
            _ => {
                let [coarse, fine] = [8, 16].map(of);
                fine + (fine - coarse) / 3.0
            }
        };
        assert!(
            (found - exact).norm() < 1e-8,
            "{wiring} {hz} Hz: cos μ {found} for {exact}"
        );
        let found = (0.5 - 0.5 * found).sqrt().asin() * 2.0;
        let error = (found - Complex::new(number.0, -number.1)).norm();
        assert!(error < 1e-7 * found.norm(), "{wiring} {hz} Hz: {found} for {number:?}");
    }
}

/// Source: [E92] without losses; water without viscosity in tubes with the inertia `β ρ l/(π r²)`, β 4/3, resonates at
/// `w_r² = 2/(I a_p l_b)`. The cell's gap is exactly from w_r to `w_r/√(1 - κ)`.
#[test]
fn a_resonance_of_tubes_opens_a_gap() {
    let mut case = papers("pairs", [8, 2]);
    case["fluid"] = json!({"viscosity_pa_s": 1e-6});
    case["effects"] = json!({"rotary_inertia": "off", "unsteady_friction": "off", "bladder_inertia": "off"});
    let case = checked(&case);
    let found = bands(&case, Lattice::new(&case).unwrap(), [25.0, 30.0], 40, true).unwrap();
    let coupling = coupling_number(&found.lattice).unwrap();
    assert!((coupling - 0.0701216).abs() < 1e-5, "{coupling}");
    let edges: Vec<f64> = found.standing.iter().map(|mode| mode.s.im / TAU).collect();
    assert!(
        (edges[0] - 27.22870474).abs() < 1e-5 && (edges[1] - 28.236735886).abs() < 1e-4,
        "{edges:?}"
    );
    let gap = found
        .gaps
        .iter()
        .max_by(|a, b| a.attenuation.total_cmp(&b.attenuation))
        .unwrap();
    assert!(
        gap.edges[0] > 27.0 && gap.edges[1] < 28.3 && !gap.motion.stretch,
        "{gap:?}"
    );
}

/// Goal: the gap of sealed bladders has exact edges with errors that cover them.
#[test]
fn edges_of_gaps_are_covered_by_their_errors() {
    let case = checked(&papers("sealed", [16, 2]));
    let found = bands(&case, Lattice::new(&case).unwrap(), [3000.0, 4000.0], 60, true).unwrap();
    let gap = found.gaps.iter().find(|gap| !gap.motion.stretch).unwrap();
    for (place, exact) in [3434.535, 3536.501].into_iter().enumerate() {
        let error = (gap.edges[place] - exact).abs();
        assert!(error < 0.02 && error < gap.errors[place].unwrap(), "{gap:?}");
    }
    assert!(found.reciprocal);
}

/// Goal: a passive beam has no wave that grows away from its source, in any wiring.
#[test]
fn waves_of_a_passive_beam_decay() {
    for wiring in ["sealed", "pairs", "chains"] {
        let case = checked(&papers(wiring, [4, 2]));
        let found = bands(&case, Lattice::new(&case).unwrap(), [1.0, 300.0], 60, true).unwrap();
        assert!(
            found.reciprocal && found.waves.iter().all(|wave| wave.wave_number.im >= 0.0),
            "{wiring}"
        );
        assert!(
            spectrum(&found.lattice, [1.0, 300.0])
                .iter()
                .all(|mode| mode.s.re < 1e-9 * mode.s.norm()),
            "{wiring}"
        );
    }
}

/// Goal: the cell of alternating segments has two of them; a beam whose segments differ has none, with a reason.
#[test]
fn the_cell_is_found_or_the_reason_why_not() {
    let mut case = papers("sealed", [4, 2]);
    case["network"]["chains"] = (1..=5)
        .map(|k| json!({"bladders": [2 * k - 1, 2 * k], "ends": ["sealed", "sealed"]}))
        .chain((1..=10).map(|k| json!({"bladders": [-k], "ends": ["sealed", "sealed"]})))
        .collect();
    assert_eq!(lattice(&case).cell.segments, 2);
    assert!(lattice(&case).cell.others.is_empty());
    // a mass at every fourth of twenty segments: two equal segments in the middle are not the cell
    let mut loaded = beam(4, &json!({}));
    loaded["mesh"]["segments"] = json!(20);
    loaded["attachments"] = (1..5)
        .map(|k| json!({"at": f64::from(k) / 5.0, "mass_kg": 0.1}))
        .collect();
    assert_eq!(lattice(&loaded).cell.segments, 4);
    // one defect
    loaded["attachments"] = json!([{"at": 0.2, "mass_kg": 0.1}]);
    let defect = lattice(&loaded).cell;
    assert_eq!((defect.segments, defect.others.len()), (1, 1), "{:?}", defect.others);
    case["loads"] = json!([{"gravity": {"x_m_s2": -9.81}}]);
    case["start"] = json!({"equilibrium": {"loads_at_s": 0}});
    let refused = Lattice::new(&checked(&case)).err().unwrap().to_string();
    assert!(
        refused.contains("no cell repeats") && refused.contains("/start"),
        "{refused}"
    );
}

/// Goal: `slcbeam bands` fills a folder with a table, a picture and a page, and prints gaps that the finite beam has, too; what does not
/// repeat is refused before a folder is created.
#[test]
fn bands_have_files_and_gaps() {
    let dir = TempDir::new().unwrap();
    let out = dir.path().join("bands");
    let folder = out.to_str().unwrap();
    let asked = [
        "bands",
        "cases/metamaterial.json",
        "--to",
        "60",
        "--quiet",
        "--out",
        folder,
    ];
    let (code, said, error) = run(&asked);
    assert_eq!((code, error.as_str()), (0, ""));
    assert!(
        said.contains("coupling number 0.4") && said.contains("standing wave"),
        "{said}"
    );
    let read = |name: &str| fs::read_to_string(out.join(name)).unwrap();
    let json: Value = serde_json::from_str(&read("bands.json")).unwrap();
    let gap = &json["gaps"][0];
    let number = |key: &str| gap[key].as_f64().unwrap();
    assert!(
        (number("from_hz") - 29.34).abs() < 0.1 && (number("to_hz") - 37.92).abs() < 0.1,
        "{gap}"
    );
    let rows = json["waves"].as_array().unwrap().len();
    assert_eq!(read("bands.csv").lines().count(), rows + 1);
    assert!(
        read("bands.svg").contains("attenuation per cell")
            && read("report.html").contains("Waves of the repeating cell")
    );
    for (wrong, what) in [
        (vec!["cases/tour-actuator.json"], "--set /start=null"),
        (vec!["cases/two-bladders.json"], "1 of at least 4 segments"),
        (vec!["cases/curl.json", "--from", "9", "--to", "3"], "--from 9 --to 3"),
        (vec!["cases/curl.json", "--points", "1"], "--points 1"),
    ] {
        let nowhere = dir.path().join("nowhere");
        let (code, _, error) = run(&[&["bands"], &wrong[..], &["--out", nowhere.to_str().unwrap()]].concat());
        assert!(code == 2 && error.contains(what) && !nowhere.exists(), "{code} {error}");
    }
}

/// Goal: in the middle of a long shaken beam pressures change from cell to cell as the two waves that bend it: two waves obey
/// `p_2 = (a + b) p_1 - a b p_0` with their factors a, b.
#[test]
fn a_finite_beam_attenuates_as_its_cell() {
    let cells = 80_i64;
    let mut case: Value = serde_json::from_str(include_str!("../../cases/metamaterial.json")).unwrap();
    case["beam"]["length_m"] = (0.008 * cells as f64).into();
    case["bladders"]["per_row"] = cells.into();
    let pair = |k: i64| json!({"bladders": [k, -k], "ends": ["sealed", "sealed"]});
    case["network"]["chains"] = (1..=cells).map(pair).collect();
    case.as_object_mut().unwrap().remove("$schema");
    let case = checked(&case);
    let outputs = [20, 21, 22, 23].map(|k| format!("bladder_{k}_pressure_pa"));
    let response = LinearResponse::new(&case, "/ends/root/clamped/u1_m", &outputs, None).unwrap();
    let p = response.solver().unwrap().at(32.0).unwrap();
    let determinant = p[0] * p[2] - p[1] * p[1];
    let [sum, product] = [p[0] * p[3] - p[1] * p[2], p[1] * p[3] - p[2] * p[2]].map(|x| x / determinant);
    let root = (sum * sum * 0.25 - product).sqrt();
    let lattice = Lattice::new(&case).unwrap();
    for factor in [sum * 0.5 + root, sum * 0.5 - root] {
        let away = waves(&lattice, 32.0)
            .into_iter()
            .map(|wave| (wave.factor - factor).norm());
        let nearest = away.fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-6 * factor.norm(), "{factor}: {nearest}");
    }
}

/// Goal: neither the scales of unknowns, which follow the drive, nor fine meshes change the waves.
#[test]
fn waves_do_not_depend_on_scales_and_cells() {
    let bending = |lattice: &Lattice, hz: f64| {
        let own = waves(lattice, hz)
            .into_iter()
            .filter(|wave| lattice.energy(wave).bending > 0.5);
        let numbers = own.map(|wave| wave.wave_number()).filter(|number| number.re > 0.1);
        numbers.min_by(|a, b| a.im.abs().total_cmp(&b.im.abs())).unwrap()
    };
    let driven = |hz: f64| {
        let set = format!("/ends/root/clamped/u1_m/sine/frequency_hz={hz}");
        let case = slcbeam::case::load("cases/water-in-tubes.json".as_ref(), &[set]).unwrap();
        bending(&Lattice::new(&case).unwrap(), 50.0)
    };
    let [slow, fast] = [1.0, 10.0].map(driven);
    assert!((slow - fast).norm() < 1e-8 * slow.norm(), "{slow} {fast}");
    let mut case = beam(64, &json!({}));
    case["attachments"] = json!([]);
    let found = bending(&lattice(&case), 1.0);
    assert!((found - 0.1 * TAU.sqrt()).norm() < 1e-5, "{found}");
}

/// Goal: no gap is reported where waves pass: in a uniform beam, also beyond what its mesh resolves, and below the gap of a damped one.
#[test]
fn no_gap_is_invented() {
    let mut uniform = beam(4, &json!({}));
    uniform["attachments"] = json!([]);
    let metamaterial: Value = serde_json::from_str(include_str!("../../cases/metamaterial.json")).unwrap();
    for (mut case, to) in [(uniform.clone(), 60.0), (uniform, 2600.0), (metamaterial, 20.0)] {
        case.as_object_mut().unwrap().remove("$schema");
        let case = checked(&case);
        let found = bands(&case, Lattice::new(&case).unwrap(), [1.0, to], 60, true).unwrap();
        assert!(found.gaps.is_empty(), "{} to {to}: {:?}", case.name, found.gaps);
    }
}

/// Source: transfer matrices of a beam of alternating segments, EI 1 and 4 N m^2: its gaps of bending without losses.
#[test]
fn alternating_segments_have_the_gaps_of_their_transfer_matrix() {
    let mut case = beam(8, &json!({}));
    case["attachments"] = json!([]);
    case["mesh"]["segments"] = json!(24);
    let modulus = |k: i32| if k % 2 == 0 { 1.2e9 } else { 4.8e9 };
    let span = |k: i32| json!({"segments": 1, "beam": {"young_modulus_pa": modulus(k)}});
    case["spans"] = (0..24).map(span).collect();
    // the last span takes what is left of the length
    (0..23).for_each(|k| case["spans"][k]["length_m"] = json!(1.0 / 24.0));
    let case = checked(&case);
    for to in [600.0, 2000.0] {
        let found = bands(&case, Lattice::new(&case).unwrap(), [1.0, to], 60, true).unwrap();
        let gap = found.gaps.iter().find(|gap| !gap.motion.stretch).unwrap();
        for (edge, exact) in gap.edges.into_iter().zip([243.267, 363.060]) {
            assert!((edge - exact).abs() < 0.1, "to {to}: {gap:?}");
        }
    }
}
