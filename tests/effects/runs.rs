//! Runs of reduced models: they go on from checkpoints bit for bit, and every output is there.

use slcbeam::discrete::System;
use slcbeam::run::{dynamics, record::Memory};

use super::common::shipped;

const REDUCED: [&str; 5] = [
    r#"{"network_pressure_differences":"off"}"#,
    r#"{"flow":"off","axial_inertia":"off"}"#,
    r#"{"flow_along_bladders":"off","moment_to_area":"off","force_to_area":"off"}"#,
    r#"{"finite_rotation":"off","axial_stretch":"off"}"#,
    r#"{"transverse_motion":"off"}"#,
];

#[test]
fn resumed_runs_of_reduced_models_repeat_uninterrupted_ones() {
    for effects in REDUCED {
        let effects = format!("/effects={effects}");
        let sets = [
            "/time/end_s=0.04",
            "/time/window_s=0.01",
            "/time/checkpoint_interval_s=0.02",
            "/formulation=\"conservative\"",
            "/mesh/cells_per_segment=2",
            &effects,
        ];
        let case = shipped("wiring-2", &sets);
        let mut whole = Memory::default();
        let outcome = dynamics::run(&case, &mut whole).unwrap();
        assert_eq!(whole.checkpoints.len(), 1, "{effects}: {:?}", outcome.summary.reason);
        let checkpoint = &whole.checkpoints[0];
        let mut rest = Memory::default();
        let resumed = dynamics::resume(&case, System::new(&case).unwrap(), checkpoint, &mut rest).unwrap();
        assert_eq!(
            whole.rows[checkpoint.next_output as usize..],
            rest.rows[..],
            "{effects}"
        );
        assert_eq!(outcome.summary.balances, resumed.summary.balances, "{effects}");
    }
}

/// Columns and fields are those of the full model, whatever is an unknown.
#[test]
fn reduced_models_give_every_output() {
    let outputs = |effects: &str| {
        let effects = format!("/effects={effects}");
        let sets = [
            "/time/end_s=0.002",
            "/time/window_s=0.001",
            "/formulation=\"conservative\"",
            &effects,
        ];
        let mut memory = Memory::default();
        let outcome = dynamics::run(&shipped("wiring-2", &sets), &mut memory).unwrap();
        let columns: Vec<_> = memory.header.columns.iter().map(|c| format!("{c:?}")).collect();
        (columns, memory.header.axes.len(), outcome.summary.quantities.len())
    };
    let full = outputs("\"auto\"");
    for effects in REDUCED {
        assert_eq!(outputs(effects), full, "{effects}");
    }
}
