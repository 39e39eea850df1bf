//! Exact reductions: the same answers with fewer unknowns.
//!
//! Tolerance: both run at rtol 1e-9; 1e-6 of the largest value leaves room for their own errors.

use super::common::{Run, difference, run, shipped, written};

const TOLERANCE: f64 = 1e-6;

fn same(a: &Run, b: &Run, columns: &[&str]) {
    for column in columns {
        let off = difference(&a.column(column), &b.column(column));
        println!(
            "{column}: {off:.1e} with {} for {} unknowns",
            a.summary.unknowns, b.summary.unknowns
        );
        assert!(off < TOLERANCE, "{column}: {off:.1e}");
    }
}

/// Bladders that are wired symmetrically do not bend a beam that is shaken along (Fig. 5, I).
#[test]
fn a_beam_shaken_along_is_a_bar() {
    let of = |effects: &str| {
        run(&shipped(
            "wiring-1",
            &["/time/end_s=0.02", "/time/window_s=0.01", "/solver/rtol=1e-9", effects],
        ))
    };
    let (bar, beam) = (of(r#"/effects={"transverse_motion":"off"}"#), of(r#"/effects="auto""#));
    assert!(
        beam.column("tip_u1").iter().all(|u| u.abs() < 1e-12),
        "nothing bends it"
    );
    same(
        &bar,
        &beam,
        &["tip_u3", "max_pressure", "axial_energy", "bladder_energy"],
    );
    assert!(bar.summary.unknowns < beam.summary.unknowns * 2 / 3);
}

/// A bladder that stands under uneven pressure is no exception, but evens out: it keeps its unknowns. One joined by a tube
/// so narrow that nothing passes has all its unknowns and no flow: the answer is that of the sealed one.
#[test]
fn sealed_bladders_need_no_unknowns() {
    let of = |sets: &[&str]| {
        let mut all = vec![
            "/time/end_s=0.02",
            "/time/window_s=0.01",
            "/solver/rtol=1e-9",
            "/network={}",
            r#"/effects={"flow":"on","flow_along_bladders":"on"}"#,
            r#"/loads=[{"force_x_n_m":{"signal":{"sine":{"amplitude":5,"frequency_hz":30}}}}]"#,
        ];
        all.extend(sets);
        run(&shipped("wiring-2", &all))
    };
    let sealed = of(&[]);
    let narrow = of(&[
        r#"/network={"chains":[{"bladders":[1,2,3,4,5,6,7,8,9,10,-10,-9,-8,-7,-6,-5,-4,-3,-2,-1]}],"permeability_factor":1e-9}"#,
    ]);
    same(
        &sealed,
        &narrow,
        &["tip_u1", "tip_u3", "max_pressure", "bladder_energy"],
    );
    let segments = 10;
    assert_eq!(narrow.summary.unknowns - sealed.summary.unknowns, 2 * segments * 2);
    let shut = of(&[r#"/network={"chains":[{"bladders":[1,2,3,-3,-2,-1],"opening":0}]}"#]);
    assert_eq!(shut.summary.unknowns, sealed.summary.unknowns);
    let uneven = of(&[r#"/start/pressures=[{"bladders":[4],"pressure_pa":{"polynomial":{"coefficients":[0,1000]}}}]"#]);
    assert_eq!(uneven.summary.unknowns, sealed.summary.unknowns + 2);
}

/// Sealed bladders start with the pressure that is given, whatever the beam's strains are then.
#[test]
fn sealed_bladders_start_with_their_pressure() {
    let text = super::common::EVERYTHING;
    let sets = [
        "/network={}",
        r#"/start={"u1_m":{"polynomial":{"coefficients":[0,0,0.01]}},"pressures":[{"bladders":[2,-4],"pressure_pa":1000}]}"#,
        r#"/ends={"root":"clamped","tip":"free"}"#,
    ];
    let run = run(&written(text, &sets));
    for (bladder, expected) in [(2, 1000.0), (-4, 1000.0), (1, 0.0), (-2, 0.0)] {
        let p = run.bladder_pressure(bladder)[0];
        assert!((p - expected).abs() < 1e-6, "bladder {bladder}: {p} Pa");
    }
}
