//! Studies of what accuracy costs. Work is counted in steps: no clock decides.

use slcbeam::output::ResultFolder;
use slcbeam::output::kind::FolderKind;
use slcbeam::output::study as files;
use slcbeam::study::accuracy::pareto_front::{self, CostMark};
use slcbeam::study::accuracy::study::Study;
use slcbeam::study::accuracy::trial::{RunPurpose, TrialOutcome};
use slcbeam::study::accuracy::{Budget, Scheme, StudyPlan, study};
use slcbeam::study::evaluations::Evaluations;

use super::swung::{DRY, WET, parsed};

fn plan(rtols: &[f64], cells: &[usize], orders: &[u8], budget: Budget) -> StudyPlan {
    let plan = StudyPlan {
        rtols: rtols.to_vec(),
        cells: cells.to_vec(),
        schemes: orders.iter().map(|&order| Scheme::ida(order)).collect(),
        repeats: 1,
        budget,
        parallel: false,
    };
    plan.checked().unwrap()
}

const PLENTY: Budget = Budget::Steps(2_000_000);

fn studied(text: &str, plan: StudyPlan) -> Study {
    study(&parsed(text, &[]), plan, None, &Evaluations::default(), &|_| {}).unwrap()
}

#[test]
fn errors_fall_with_tolerance_and_mesh_size_and_the_reference_knows_its_own() {
    let found = studied(DRY, plan(&[1e-3, 1e-4, 1e-5], &[2, 4, 8], &[2], PLENTY));
    let measure = found.measure().unwrap();
    assert_eq!(measure.name, "tip_u1");
    for cells in [2, 4, 8] {
        let line = found.line(cells, Scheme::ida(2));
        let in_time: Vec<f64> = line
            .iter()
            .map(|&k| found.error(k).unwrap().temporal.unwrap().l2)
            .collect();
        assert_eq!(in_time.len(), 3);
        // Order 2 gains a factor of 10^(2/3) a decade; a half of that is asked for.
        assert!(
            in_time.windows(2).all(|w| w[1] < 0.5 * w[0]),
            "{cells} cells: {in_time:?}"
        );
    }
    // The mesh is of the second order; errors in time are well below what it is taken from.
    let order = measure.order.unwrap();
    assert!((1.8..2.2).contains(&order) && measure.order_is_clean, "{order}");
    assert_eq!(measure.extrapolated_with, Some(2.0));
    // A fourth mesh beyond the finest, each with a check by another order.
    assert_eq!(
        found.references.iter().map(|r| r.cells).collect::<Vec<_>>(),
        [2, 4, 8, 16]
    );
    for r in &found.references {
        assert!(r.checked_by.is_some() && r.by_tolerance[0].is_some() && r.by_order[0].is_some());
        assert!(
            r.own[found.headline].max < 1e-4,
            "{} cells: {:?}",
            r.cells,
            r.own[found.headline]
        );
    }
    let own = measure.own();
    assert!(own.max > 0.0 && own.max < 1e-3, "{own:?}");
    // Spatial errors fall by four from mesh to mesh.
    let spatial = [2, 4, 8].map(|cells| {
        found
            .error(found.line(cells, Scheme::ida(2))[0])
            .unwrap()
            .spatial
            .unwrap()
            .l2
    });
    assert!(
        spatial.windows(2).all(|w| (3.3..4.7).contains(&(w[0] / w[1]))),
        "{spatial:?}"
    );
    // Whatever an error is judged by is ten times better.
    for (k, point) in found.points.iter().enumerate().filter(|(_, p)| p.errors.is_some()) {
        let e = found.error(k).unwrap();
        assert_eq!(e.judged, e.total.max >= 10.0 * own.max, "{:?}", point.trial.setting);
        assert!(e.bound.max >= e.total.max);
    }
}

#[test]
fn a_wet_beam_is_studied_in_its_pressures_too() {
    let found = studied(WET, plan(&[1e-3, 1e-5], &[2, 4], &[2, 5], PLENTY));
    let names: Vec<&str> = found.measures.iter().map(|m| m.name.as_str()).collect();
    for wanted in [
        "tip_u1",
        "max_pressure",
        "v1_m_s",
        "u3_m",
        "max_pressure_pa.max_abs",
        "input_energy_j.final",
    ] {
        assert!(names.contains(&wanted), "{wanted} is not among {names:?}");
    }
    assert!(found.left_out.contains(&"harvested".to_string()), "there is no turbine");
    assert_eq!(
        found
            .points
            .iter()
            .filter(|p| p.trial.role == RunPurpose::Point)
            .count(),
        8
    );
    let text = files::table(&found);
    assert!(
        text.contains("reference of each mesh") && text.contains("its tolerances"),
        "{text}"
    );
    let rows = files::csv(&found);
    let columns = rows.lines().next().unwrap().split(',').count();
    let finished = rows.lines().filter(|l| l.contains(",finished,")).count();
    assert_eq!(finished % found.measures.len(), 0);
    assert!(rows.lines().all(|l| l.split(',').count() == columns));
    let json: serde_json::Value = serde_json::from_str(&files::json(&found)).unwrap();
    assert!(
        json["sentence"].as_str().is_some_and(|s| s.contains("tip deflection")),
        "{json}"
    );
    let dir = tempfile::tempdir().unwrap();
    let mut folder = ResultFolder::claim(dir.path(), FolderKind::Study, false).unwrap();
    files::write(&mut folder, &found).unwrap();
    let written = [files::CSV, files::JSON, files::PICTURE].map(|name| dir.path().join(name).is_file());
    assert_eq!(written, [true; 3]);
}

#[test]
fn a_budget_is_kept_and_what_is_left_out_has_a_reason() {
    let budget = 6000;
    let found = studied(
        DRY,
        plan(&[1e-2, 1e-3, 1e-6, 1e-8], &[1, 2, 4], &[2], Budget::Steps(budget)),
    );
    let steps: u64 = found.points.iter().map(|p| p.trial.counters.steps).sum();
    assert!(steps <= budget && found.spent <= budget as f64, "{steps} of {budget}");
    let points: Vec<_> = found
        .points
        .iter()
        .filter(|p| p.trial.role == RunPurpose::Point)
        .collect();
    assert_eq!(points.len(), 12, "a row each");
    let unfinished: Vec<_> = points
        .iter()
        .filter(|p| p.trial.ending != TrialOutcome::Finished)
        .collect();
    assert!(!unfinished.is_empty() && unfinished.len() < 12);
    assert!(unfinished.iter().all(|p| p.trial.reason.is_some()));
    assert!(files::table(&found).contains("not finished"));
}

#[test]
fn a_budget_too_small_for_anything_is_no_failure() {
    let found = studied(DRY, plan(&[1e-3], &[2], &[2], Budget::Steps(10)));
    assert!(found.measure().is_none() && found.front.is_empty());
    assert_eq!(files::sentence(&found), "No accuracy is known: no run finished.");
    assert!(files::draw(&found).is_none());
}

#[test]
fn runs_at_once_find_the_same() {
    let one = plan(&[1e-3, 1e-4], &[2, 4], &[2], PLENTY);
    let many = StudyPlan {
        parallel: true,
        ..one.clone()
    };
    let errors = |found: &Study| -> Vec<Option<f64>> {
        (0..found.points.len())
            .filter(|&k| found.points[k].trial.role == RunPurpose::Point)
            .map(|k| found.error(k).and_then(|e| e.temporal).map(|t| t.max))
            .collect()
    };
    let (one, many) = (studied(DRY, one), studied(DRY, many));
    for (a, b) in errors(&one).into_iter().zip(errors(&many)) {
        // References may be of other tolerances, as the budget fell; the errors of points hardly feel it.
        let (a, b) = (a.unwrap(), b.unwrap());
        assert!((a - b).abs() < 0.05 * a, "{a} {b}");
    }
}

#[test]
fn senseless_plans_are_refused() {
    let good = plan(&[1e-3], &[2], &[2], PLENTY);
    let wrong = [
        StudyPlan {
            rtols: vec![],
            ..good.clone()
        },
        StudyPlan {
            rtols: vec![1.0],
            ..good.clone()
        },
        StudyPlan {
            cells: vec![0],
            ..good.clone()
        },
        StudyPlan {
            schemes: vec![Scheme::ida(6)],
            ..good.clone()
        },
        StudyPlan {
            repeats: 0,
            ..good.clone()
        },
        StudyPlan {
            budget: Budget::Wall(f64::NAN),
            ..good.clone()
        },
    ];
    for plan in wrong {
        assert_eq!(plan.checked().map_err(|e| e.exit_code()), Err(2));
    }
    let unknown = study(&parsed(DRY, &[]), good, Some("tip"), &Evaluations::default(), &|_| {});
    assert!(unknown.is_err_and(|e| e.to_string().contains("tip_u1")));
}

/// One-step methods are lines of their own, in the table, in the file and in the picture, and judge each other.
#[test]
fn one_step_methods_stand_beside_orders() {
    let names = ["ida", "esdirk34", "esdirk46"].map(String::from);
    let plan = StudyPlan {
        schemes: Scheme::list(&names, &[2]).unwrap(),
        ..plan(&[1e-3, 1e-4, 1e-5], &[2], &[2], PLENTY)
    };
    let found = studied(DRY, plan.checked().unwrap());
    for (scheme, name) in found.plan.schemes.iter().zip(["2", "esdirk34", "esdirk46"]) {
        assert_eq!(scheme.label(), name);
        let line = found.line(2, *scheme);
        let error = |k: usize| found.error(line[k]).unwrap().total.l2;
        // A hundredth of the tolerance gains at least what order 2 promises, 100^(2/3) = 22, with some room.
        assert!(
            line.len() == 3 && error(2) < 0.1 * error(0),
            "{name}: {} {}",
            error(0),
            error(2)
        );
    }
    assert!(files::table(&found).contains("esdirk46") && files::csv(&found).contains(",esdirk34,3,"));
    let picture = files::draw(&found).unwrap();
    assert!(picture.contains("2 cells, esdirk34") && picture.contains("2 cells, order 2"));
    assert_eq!(Scheme::list(&["rk4".into()], &[2]).map_err(|e| e.exit_code()), Err(2));
}

fn marks(all: &[(f64, f64)]) -> Vec<CostMark> {
    all.iter().map(|&(error, cost)| CostMark { error, cost }).collect()
}

#[test]
fn the_front_holds_what_no_other_beats() {
    let points = marks(&[
        (1e-1, 1.0),
        (1e-2, 2.0),
        (2e-2, 3.0),
        (1e-3, 4.0),
        (1e-3, 5.0),
        (f64::NAN, 0.1),
        (2e-1, 1.0),
    ]);
    let front = pareto_front::front(&points);
    assert_eq!(front, [0, 1, 3]);
    let answers = pareto_front::answers(&points, &front, &[0.5, 5e-2, 1e-3, 1e-4]);
    assert_eq!(
        answers.iter().map(|a| a.point).collect::<Vec<_>>(),
        [Some(0), Some(1), Some(3), None]
    );
    assert!(pareto_front::front(&[]).is_empty());
}

#[test]
fn the_foot_and_the_balance_of_a_line() {
    let cost = [3.0, 1.0, 2.0, 4.0];
    let foot = pareto_front::cost_minimum(&[0, 1, 2, 3], &cost, &[30.0, 10.0, 20.0, 40.0]).unwrap();
    assert_eq!((foot.cheapest, foot.looser, foot.factor), (1, 0, 3.0));
    // A clock that had an accident is no foot.
    assert_eq!(
        pareto_front::cost_minimum(&[0, 1, 2, 3], &cost, &[10.0, 10.0, 20.0, 40.0]),
        None
    );
    assert_eq!(pareto_front::cost_minimum(&[0, 1], &[1.0, 2.0], &[1.0, 2.0]), None);
    // Temporal error 1e-1, 1e-2, 1e-4 against 1e-3 in space: halfway between the last two in logarithms.
    let line = [
        (1e-2, 1e-1, 1e-1, 1.0),
        (1e-3, 1e-2, 1e-2, 10.0),
        (1e-4, 1e-4, 1e-3, 100.0),
    ];
    let at = pareto_front::balance(&line, 1e-3).unwrap();
    assert!((at.rtol / 1e-3_f64.powf(0.5) / 1e-4_f64.powf(0.5) - 1.0).abs() < 1e-12);
    assert!((at.cost / 1000_f64.sqrt() - 1.0).abs() < 1e-12);
    assert_eq!(pareto_front::balance(&line, 1e-6), None);
}

#[test]
fn the_sentence_says_what_an_accuracy_costs() {
    let mut found = studied(DRY, plan(&[1e-2, 1e-3, 1e-4], &[2, 4], &[2], PLENTY));
    let at = |found: &Study, cells, rtol| {
        found
            .points
            .iter()
            .position(|p| p.trial.setting.cells == cells && p.trial.setting.rtol == rtol)
            .unwrap()
    };
    let (coarse, fine) = (at(&found, 2, 1e-3), at(&found, 4, 1e-4));
    found.points[coarse].trial.wall_min_s = 0.03;
    found.points[fine].trial.wall_min_s = 0.4;
    let answer = |accuracy, point| pareto_front::CheapestPoint { accuracy, point };
    found.answers = vec![
        answer(1e-1, Some(coarse)),
        answer(1e-2, Some(coarse)),
        answer(1e-3, Some(fine)),
        answer(1e-4, None),
    ];
    found.feet = vec![pareto_front::CostMinimum {
        cheapest: coarse,
        looser: at(&found, 2, 1e-2),
        factor: 3.0,
    }];
    assert_eq!(
        files::sentence(&found),
        "1 % of tip deflection costs 0.030 s (2 cells, rtol 1e-3); 0.1 % costs 0.40 s (4 cells, rtol 1e-4); 0.01 % is not \
         reached, or cannot be judged within this budget; looser than rtol 1e-3 costs more, not less (up to 3.0 times)."
    );
    found.answers = vec![answer(1e-2, None)];
    found.feet = vec![];
    assert_eq!(files::sentence(&found), "no setting has 1 % of tip deflection.");
}

/// Goal: a quantity that a driven end prescribes has no error, and no setting is judged by it.
#[test]
fn what_an_end_prescribes_is_not_judged() {
    let driven = DRY.replace(
        r#""tip": "free""#,
        r#""tip": {"guided": {"u3_m": {"ramp": {"to": -1e-4, "duration_s": 0.01}}}}"#,
    );
    assert_ne!(driven, DRY);
    let found = studied(&driven, plan(&[1e-3, 1e-4], &[2, 4], &[2], PLENTY));
    assert!(
        found.left_out.iter().any(|name| name == "tip_u3"),
        "{:?}",
        found.left_out
    );
    let judged = found.measures.iter().map(|limit| limit.name.as_str());
    assert!(
        judged.clone().count() > 0
            && judged
                .clone()
                .all(|name| !name.starts_with("tip_u3") && !name.starts_with("tip_angle"))
    );
}
