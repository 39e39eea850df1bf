//! Growth is what outgrows its drive.

use super::common::{BEAM, finished, shipped, warning, written};

/// Goal: a load that rises along a straight line, with and without inertia, is no instability; nor is pressure that spreads.
#[test]
fn a_ramp_is_no_growth() {
    let ramp = r#"/loads=[{"force_x_n_m": {"signal": {"ramp": {"to": 5, "duration_s": 1, "shape": "linear"}}}}]"#;
    for effects in [r#"/effects={"solid_inertia": "off"}"#, "/effects={}"] {
        let s = finished(&written(BEAM, &[ramp, effects]));
        assert_eq!(warning(&s, "W007"), None);
    }
    for case in ["ring-network", "stretch-wet"] {
        let s = finished(&shipped(case, &[]));
        assert_eq!(warning(&s, "W007"), None, "{case}");
    }
}

/// Goal: the motion in a Mathieu tongue is growth, and is said to be parametric.
#[test]
fn a_mathieu_tongue_is_growth() {
    let s = finished(&shipped("hard/mathieu", &[]));
    let text = warning(&s, "W007").expect("it grows");
    assert!(text.contains("parametric") && !text.contains("loads ("), "{text}");
}
