//! Tables of moment-curvature laws: curve, energy and inverse, numbers of the case, warnings and mistakes.

use serde_json::{Value, json};
use slcbeam::case::parameter::Parameter;
use slcbeam::discrete::System;
use slcbeam::error::Error;
use slcbeam::model::BendingLaw;
use slcbeam::run::equilibrium::{EquilibriumOptions, follow};
use slcbeam::run::modes::{self, ModeOptions};
use slcbeam::run::record::Control;
use slcbeam::run::response::LinearResponse;
use slcbeam::run::stop::StopFlag;
use slcbeam::study::refine::numbers;

use crate::moment_curvature::{PLATEAU, UNLIKE, cantilever, moment, table};
use crate::spans::{faults, parse, run};

/// Goal: the energy is the integral of the moment, and the inverse is that of the law, at both sides, within and beyond the table.
#[test]
fn the_energy_is_the_integral_of_the_moment() {
    for table_of in [PLATEAU, UNLIKE] {
        let (curvature, moments) = table_of;
        let written = serde_json::from_value(json!({"curvature_1_m": curvature, "moment_n_m": moments})).unwrap();
        let law = BendingLaw::new(&written).unwrap();
        for sign in [1.0, -1.0] {
            let (mut before, mut energy) = (0.0, 0.0);
            for k in 1..=600 {
                let x = sign * 0.01 * f64::from(k);
                // Gauss's two points are exact for the cubics between points
                let (middle, half) = (0.5 * (x + before), 0.5 * (x - before));
                let gauss = [-1.0, 1.0].map(|side| moment(table_of, middle + side * half / 3.0_f64.sqrt()));
                energy += half * (gauss[0] + gauss[1]);
                let at = law.at(x);
                assert!((at.moment - moment(table_of, x)).abs() < 1e-13, "{x}");
                assert!((law.curvature(at.moment) - x).abs() < 1e-12, "{x}");
                assert!((at.energy - energy).abs() < 1e-12, "{x}: {} for {energy}", at.energy);
                let slope = (moment(table_of, x + 1e-6) - moment(table_of, x - 1e-6)) / 2e-6;
                assert!((at.stiffness - slope).abs() < 1e-5, "{x}");
                assert!(at.stiffness > 0.0 && at.stiffness <= law.steepest() * (1.0 + 1e-15));
                before = x;
            }
        }
    }
}

/// Goal: a point of the table is a number of the case like others; the table follows the modulus of the beam.
#[test]
fn a_point_of_the_table_is_a_number_of_the_case() {
    let case = parse(&cantilever(4, &table(PLATEAU), &json!({})));
    let point = Parameter::find(&case, "/beam/moment_curvature/moment_n_m/3").unwrap();
    let law = |case: &slcbeam::case::Case| case.beam.moment_curvature.clone().unwrap();
    assert_eq!(law(&point.changed(&case, 0.91).unwrap()).moment_n_m[3], 0.91);
    let modulus = Parameter::find(&case, "/beam/young_modulus_pa").unwrap();
    let stiffer = law(&modulus.changed(&case, 2e11).unwrap());
    assert_eq!(stiffer.moment_n_m, PLATEAU.1.map(|moment| 2.0 * moment));
    assert_eq!(stiffer.curvature_1_m, PLATEAU.0);
}

/// Goal: a state beyond the table is reported with its place, in runs and at rest.
#[test]
fn a_state_beyond_the_table_is_reported() {
    let mut case = cantilever(8, &table(PLATEAU), &json!({"moment_n_m": 1.9}));
    let path = follow(&parse(&case), &EquilibriumOptions::at(1.0), &mut |_| Control::Continue).unwrap();
    let said = path.warnings().join("\n");
    assert!(
        said.contains("beyond its moment-curvature table: 1.250 of the last curvature"),
        "{said}"
    );
    case["ends"]["tip"]["free"]["moment_n_m"] = json!({"ramp": {"to": 1.9, "start_s": 0, "duration_s": 0.3}});
    let said = run(&case).1.warnings.join("\n");
    assert!(said.contains("beyond its moment-curvature table"), "{said}");
    case["ends"]["tip"]["free"]["moment_n_m"] = json!(0.2);
    let path = follow(&parse(&case), &EquilibriumOptions::at(1.0), &mut |_| Control::Continue).unwrap();
    assert!(!path.warnings().join("\n").contains("table"));
}

/// Goal: small motions and cycles report a state beyond the table, and only such a state.
#[test]
fn linear_motions_and_cycles_beyond_the_table_are_reported() {
    let said = |moment: f64| {
        let mut case = cantilever(4, &table(PLATEAU), &json!({"moment_n_m": moment}));
        let plan = ModeOptions {
            count: 2,
            near_hz: 0.0,
            limits: false,
        };
        let about = modes::at_equilibrium(&parse(&case), 1.0).unwrap();
        let small = modes::compute(about, &plan).unwrap().warnings("the state").join("\n");
        let output = ["tip_u1".to_owned()];
        let response = LinearResponse::new(&parse(&case), "/ends/tip/free/moment_n_m", &output, Some(1.0)).unwrap();
        let response = response.about.range.join("\n");
        let slow = json!({"sine": {"amplitude": moment, "frequency_hz": 2.0}});
        case["ends"]["tip"]["free"]["moment_n_m"] = slow;
        case["beam"]["damping"] = json!({"bending_time_s": 0.5, "axial_time_s": 0.5});
        case["solver"]["rtol"] = json!(1e-4);
        let case = parse(&case);
        let (scene, mut cycle) = numbers::cycle(&case, None, &StopFlag::default()).unwrap();
        [small, response, cycle.range(&case, &scene).join("\n")]
    };
    for said in said(1.9) {
        assert!(
            said.contains("W023") && said.contains("beyond its moment-curvature table"),
            "{said}"
        );
    }
    for said in said(0.2) {
        assert!(!said.contains("W023"), "{said}");
    }
}

/// Goal: tables that are no increasing curve through zero, and settings that need a linear section, are rejected with the remedy.
#[test]
fn mistakes_are_named() {
    let with = |curvature: Value, moment: Value| {
        let law = json!({"curvature_1_m": curvature, "moment_n_m": moment});
        faults(&cantilever(4, &law, &json!({})))
    };
    for (curvature, moment, words) in [
        (json!([0, 1, 2]), json!([0, 1]), "3 curvatures for 2 moments"),
        (json!([0, 2, 1]), json!([0, 1, 2]), "ascending curvatures"),
        (json!([0, 1, 2]), json!([0, 1, 0.5]), "snap-through"),
        (json!([0, 1, 2]), json!([0, 1, 1]), "rising moments"),
        (
            json!([0, 1, 2]),
            json!([0, 1e-9, 1]),
            "a slope of 1.00·10⁻⁹ N m^2, below a millionth",
        ),
        (json!([0, 1, 2]), json!([0.1, 1, 2]), "rest_curvature_1_m"),
        (json!([1, 2]), json!([1, 2]), "no curvature 0"),
        (json!([-1, 0]), json!([-1, 0]), "no curvature 0"),
        (json!([0, 1]), json!([0, 1e9]), "N mm"),
    ] {
        let said = with(curvature, moment);
        assert!(said.contains(words), "{words}: {said}");
    }
    let mut twice = cantilever(4, &table(PLATEAU), &json!({}));
    twice["beam"]["bending_stiffness_factor"] = json!(0.6);
    assert!(faults(&twice).contains("slope of the law at zero"));
    let mut span = cantilever(4, &table(PLATEAU), &json!({}));
    span["spans"] = json!([{"beam": {"bending_stiffness_factor": 0.6}}]);
    assert!(faults(&span).contains("slope of the law at zero"));
    let mut published = cantilever(4, &table(PLATEAU), &json!({}));
    published["formulation"] = json!("published");
    assert!(faults(&published).contains("the published form with a moment-curvature law"));
    let mut fourth = cantilever(8, &table(PLATEAU), &json!({}));
    fourth["mesh"]["order"] = json!(4);
    match System::new(&parse(&fourth)) {
        Err(Error::Case(fault)) => assert!(
            fault.violations[0]
                .what
                .contains("a moment-curvature law needs a mesh of second order")
        ),
        other => panic!("{:?}", other.map(|_| ())),
    }
}
