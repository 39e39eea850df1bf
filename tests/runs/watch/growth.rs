//! Growth: motion that outgrows its drive.

use super::common::{BEAM, finished, shipped, warning, written};

/// Goal: neither a load that rises linearly, with and without inertia, nor spreading pressure is reported as an instability.
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

/// Goal: motion in a Mathieu tongue is reported as parametric growth.
#[test]
fn a_mathieu_tongue_is_growth() {
    let s = finished(&shipped("hard/mathieu", &[]));
    let text = warning(&s, "W007").expect("it grows");
    assert!(text.contains("parametric") && !text.contains("loads ("), "{text}");
}
