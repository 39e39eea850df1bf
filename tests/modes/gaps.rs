//! Gaps as figures of designs: names, derivatives, errors; what rounding hides is no gap.

use serde_json::json;
use slcbeam::case::Case;
use slcbeam::case::parameter::Parameter;
use slcbeam::study::analysis::derivatives::FigureSlopes;
use slcbeam::study::analysis::{AnalysisKind, AnalysisOutcome, AnalysisRequest, found};

use super::bands::{beam, papers};
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
