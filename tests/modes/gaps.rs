//! Gaps as figures of designs: names, derivatives, errors; what rounding hides is no gap.

use nalgebra::Complex;
use serde_json::json;
use slcbeam::case::Case;
use slcbeam::case::parameter::Parameter;
use slcbeam::study::analysis::derivatives::FigureSlopes;
use slcbeam::study::analysis::{AnalysisKind, AnalysisOutcome, AnalysisRequest, found};

use super::bands::{beam, cosine, lattice, limit, papers};
use super::common::checked;

fn derivatives(case: &Case, pointer: &str) -> (AnalysisOutcome, FigureSlopes) {
    let parameters = Parameter::all(case, &[pointer.into()]).unwrap();
    let analysis = AnalysisKind::Bands.analysis();
    analysis.derivatives(case, &parameters, None, &|| false).unwrap()
}

fn figures(case: &Case, meshes: bool) -> AnalysisOutcome {
    let ask = AnalysisRequest {
        what: &AnalysisKind::Bands,
        accuracy: None,
        from: None,
        meshes,
        waves: false,
    };
    found(case, ask, &|| false, &|_| unreachable!("no run is needed")).unwrap()
}

/// Goal: without damping every frequency of a beam with masses grows as the square root of Young's modulus, and so do the edges of its
/// gaps, to 1e-7; the relative width of a gap stays.
#[test]
fn edges_without_losses_grow_as_the_root_of_the_modulus() {
    let case = checked(&beam(4, &json!({"mass_kg": 0.1})));
    let (found, slopes) = derivatives(&case, "/beam/young_modulus_pa");
    for name in ["bending_gap_1", "bending_gap_2"] {
        for edge in ["from_hz", "to_hz"] {
            let name = format!("{name}.{edge}");
            let scaled = slopes[&name][0] * 2.0 * 1.2e9 / found.figure(&name).unwrap();
            assert!((scaled - 1.0).abs() < 1e-7, "{name}: {scaled}");
        }
        let width = slopes[&format!("{name}.relative_width")][0] * 1.2e9;
        assert!(width.abs() < 1e-7, "{name}: {width}");
    }
}

/// Goal: edges at 1 dB per cell, where water resonates in tubes with losses, move with the radius of the tubes as those of wider and
/// narrower tubes say, to 1e-3, and the coupling number does not.
#[test]
fn edges_with_losses_move_as_differences_say() {
    let with = |radius: f64| {
        let mut case = papers("pairs", [4, 2]);
        case["fluid"] = json!({"viscosity_pa_s": 1e-5});
        case["tubes"]["radius_m"] = json!(radius);
        case["effects"] = json!({"unsteady_friction": "off", "bladder_inertia": "off", "tube_inertia": "on"});
        checked(&case)
    };
    let radius = 1e-3;
    let (_, slopes) = derivatives(&with(radius), "/tubes/radius_m");
    let [wider, narrower] = [1.001, 0.999].map(|part| figures(&with(part * radius), false));
    for name in ["bending_gap_1.from_hz", "bending_gap_1.to_hz"] {
        let [a, b] = [&wider, &narrower].map(|found| found.figure(name).unwrap());
        let difference = (a - b) / (0.002 * radius);
        let slope = slopes[name][0];
        assert!(
            (slope - difference).abs() < 1e-3 * slope.abs(),
            "{name}: {slope} {difference}"
        );
    }
    assert!(slopes["coupling_number"][0].abs() < 1e-9);
}

/// Goal: figures of designs have the errors of their meshes, and names that are known before.
#[test]
fn gaps_of_designs_have_names_and_errors() {
    let case = checked(&beam(8, &json!({"mass_kg": 0.1})));
    let found = figures(&case, true);
    let names = AnalysisKind::Bands.analysis().names(&case).unwrap();
    for (name, _) in &found.figures {
        let known = name.strip_suffix(".error").unwrap_or(name);
        assert!(names.iter().any(|own| own == known), "{name}");
    }
    let error = found.figure("bending_gap_1.to_hz.error").unwrap();
    assert!((1e-6..0.05).contains(&error), "{error}");
}

/// Source: Liu & Hussein 2012, a resonator at each cell: c = cos μ with
/// (c - cos b)(c - cosh b) = D/(4 b³) [sin b (c - cosh b) - sinh b (c - cos b)], D = -r b⁴/(1 - w²), b² = w, for a mass ratio r = 1/2 and the
/// resonance at w = 1. A gap begins at w = 0.994780133695 (c = -1). At one frequency the resonator acts as a mass below its resonance, as a
/// spring to ground above.
///
/// Goal: the waves below, at the edge of, in and above the gap. Tolerance: 1e-8 after extrapolation.
#[test]
fn a_beam_with_resonators_has_the_waves_of_its_closed_form() {
    let (unit, mass) = (100.0, 0.05);
    for w in [0.5, 0.9, 0.994780133695, 1.1, 2.0, 5.0_f64] {
        let b = w.sqrt();
        let acting = 1.0 / (1.0 - w * w);
        let s = -0.5 * acting * b / 4.0;
        let half = 0.5 * (b.cos() + b.cosh() + s * (b.sin() - b.sinh()));
        let product = b.cos() * b.cosh() + s * (b.sin() * b.cosh() - b.sinh() * b.cos());
        let root = Complex::new(half * half - product, 0.0).sqrt();
        let attached = if w < 1.0 {
            json!({"mass_kg": mass * acting})
        } else {
            json!({"stiffness_x_n_m": -mass * acting * (unit * w).powi(2)})
        };
        for exact in [half + root, half - root] {
            let hz = unit * w / std::f64::consts::TAU;
            let of = |cells| cosine(&lattice(&beam(cells, &attached)), false, hz, exact);
            let found = limit(of, [8, 16, 32, 64]);
            assert!(
                (found - exact).norm() < 1e-8 * exact.norm().max(1.0),
                "{w}: {found} for {exact}"
            );
        }
    }
}
