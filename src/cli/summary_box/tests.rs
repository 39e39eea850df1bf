use super::*;
use crate::run::summary::{Balances, Counters, WallTimes};

fn summary(status: Status) -> Summary {
    let quantity = |max| Quantity {
        max_abs: Some(max),
        last: Some(max),
        ..Quantity::default()
    };
    Summary {
        case: "wiring-2".to_string(),
        status,
        reason: None,
        time_s: 0.5,
        unknowns: 371,
        quantities: [
            ("tip_u1_m", 1.23e-4),
            ("tip_u3_m", 1.25e-3),
            ("max_pressure_pa", 9010.0),
        ]
        .map(|(name, max)| (name.to_string(), quantity(max)))
        .into(),
        balances: Balances {
            energy_residual_relative: 3e-8,
            ..Balances::default()
        },
        solver: Counters {
            steps: 12345,
            steps_by_order: vec![12, 300, 2033, 10000],
            ..Counters::default()
        },
        wall_s: WallTimes {
            total: 12.3,
            residual: 4.0,
            jacobian: 3.0,
            linear_solver: 4.0,
            output: 0.5,
        },
        effects: Default::default(),
        characteristic: Default::default(),
        origins: Default::default(),
        growth: None,
        accuracy: None,
        estimate: None,
        sensitivities: Default::default(),
        warnings: Vec::new(),
    }
}

fn is_a_box(text: &str, width: usize) -> bool {
    text.lines().all(|l| l.chars().count() == width)
}

#[test]
fn a_finished_run_in_a_glance() {
    let text = render(&summary(Status::Finished), Path::new("out/wiring-2"), false, 76);
    insta::assert_snapshot!(text, @r"
    ╭─ wiring-2 ──────────────────────────────────────────────────── finished ─╮
    │ deflection  tip, largest: u₁ 123 µm · u₃ 1.25 mm                         │
    │ pressure    largest: 9.01 kPa                                            │
    │ balances    open by (relative): energy 3.0·10⁻⁸                          │
    │ integrator  12 345 steps, mostly of order 4 · 0 rejected · 371 unknowns  │
    │ time        500 ms simulated in 12.3 s · 24.6 s for a simulated second   │
    │ spent on    residual 33 % · Jacobian 24 % · linear solver 33 % ·         │
    │             output 4 %                                                   │
    ╰─ report.html and data in out/wiring-2 ───────────────────────────────────╯
    ");
    assert!(is_a_box(&text, 76));
}

#[test]
fn a_failure_says_why_and_warnings_come_first() {
    let mut failed = summary(Status::Failed);
    failed.reason = Some("the step became smaller than round-off at t = 0.0213 s".to_string());
    failed.warnings = (1..=5)
        .map(|k| format!("warning number {k} that goes on for quite a few words"))
        .collect();
    failed.balances.volume_residual_relative = f64::NAN;
    let text = render(&failed, Path::new("out/wiring-2"), false, 60);
    insta::assert_snapshot!(text, @r"
    ╭─ wiring-2 ────────────────────────────────────── FAILED ─╮
    │ why         the step became smaller than round-off at t  │
    │             = 0.0213 s                                   │
    │ warning     warning number 1 that goes on for quite a    │
    │             few words                                    │
    │ warning     warning number 2 that goes on for quite a    │
    │             few words                                    │
    │ warning     warning number 3 that goes on for quite a    │
    │             few words                                    │
    │             and 2 more in summary.json; slcbeam explain  │
    │             says more of each number                     │
    │ deflection  tip, largest: u₁ 123 µm · u₃ 1.25 mm         │
    │ pressure    largest: 9.01 kPa                            │
    │ balances    open by (relative): energy 3.0·10⁻⁸ ·        │
    │             volume –                                     │
    │ integrator  12 345 steps, mostly of order 4 ·            │
    │             0 rejected · 371 unknowns                    │
    │ time        500 ms simulated in 12.3 s · 24.6 s for a    │
    │             simulated second                             │
    ╰─ report.html and data in out/wiring-2 ───────────────────╯
    ");
    assert!(is_a_box(&text, 60));
    let painted = render(&failed, Path::new("out/wiring-2"), true, 60);
    assert!(painted.contains("\u{1b}[1;31mFAILED"));
}

#[test]
fn a_long_path_is_not_cut() {
    let path = "out/".to_string() + &"long/".repeat(20);
    assert!(render(&summary(Status::Finished), Path::new(&path), false, 60).contains(&path));
}
