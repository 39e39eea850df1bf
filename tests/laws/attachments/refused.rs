//! What cannot be attached, and what cannot be left out then.

use std::path::Path;

use serde_json::json;
use slcbeam::case;
use slcbeam::discrete::System;
use slcbeam::error::{Error, Violation};

use super::{parse, slender};

/// What is wrong with a case.
fn faults(error: &Error) -> &[Violation] {
    match error {
        Error::Case(fault) => &fault.violations,
        other => panic!("{other:?}"),
    }
}

fn places(faults: &[Violation]) -> Vec<&str> {
    faults.iter().map(|fault| fault.pointer.as_str()).collect()
}

/// Goal: an entry that attaches nothing, a place off the beam, negative sizes are refused where they stand.
#[test]
fn what_cannot_be_attached_is_refused() {
    for (attachment, pointer) in [
        (json!({"at": 0.5}), "/attachments/0"),
        (json!({"at": 1.5, "mass_kg": 1}), "/attachments/0/at"),
        (json!({"at": 0.5, "mass_kg": -1}), "/attachments/0/mass_kg"),
        (
            json!({"at": 0.5, "stiffness_x_n_m": -1}),
            "/attachments/0/stiffness_x_n_m",
        ),
        (json!({"at": 0.5, "force_x_n": 1e12}), "/attachments/0/force_x_n"),
        (
            json!({"at": 0.5, "rotary_inertia_kg_m2": -1}),
            "/attachments/0/rotary_inertia_kg_m2",
        ),
        (
            json!({"at": 0.5, "stiffness_x_n_m": 1, "offset_along_m": 0.1}),
            "/attachments/0/offset_along_m",
        ),
        (
            json!({"at": 0.5, "mass_kg": 1, "offset_across_m": -11}),
            "/attachments/0/offset_across_m",
        ),
        (
            json!({"at": 0.5, "force_tangential_n": 1e12}),
            "/attachments/0/force_tangential_n",
        ),
    ] {
        let case = slender(json!("clamped"), json!("free"), json!([attachment]), 4);
        let error = case::parse(&case.to_string(), Path::new("test.json"), Path::new(""), &[]).unwrap_err();
        assert_eq!(places(faults(&error)), [pointer], "{attachment}");
    }
}

/// Goal: what an attachment has a meaning with cannot be left out, and the case says why.
#[test]
fn effects_that_attachments_need_stay() {
    for (effects, attachment, kept) in [
        (
            json!({"transverse_motion": "off"}),
            json!({"at": 0.5, "force_x_n": 1e-3}),
            "/effects/transverse_motion",
        ),
        (
            json!({"transverse_motion": "off"}),
            json!({"at": 0.5, "force_normal_n": 1e-3}),
            "/effects/transverse_motion",
        ),
        (
            json!({"transverse_motion": "off"}),
            json!({"at": 0.5, "mass_kg": 0.1, "offset_across_m": 0.1}),
            "/effects/transverse_motion",
        ),
        (
            json!({"axial_inertia": "off"}),
            json!({"at": 0.5, "rotary_inertia_kg_m2": 1e-3}),
            "/effects/axial_inertia",
        ),
        (
            json!({"finite_rotation": "off", "axial_stretch": "off"}),
            json!({"at": 0.5, "mass_kg": 0.1, "offset_along_m": 0.1}),
            "/effects/axial_stretch",
        ),
        (
            json!({"shear": "on", "rotary_inertia": "off"}),
            json!({"at": 0.5, "rotary_inertia_kg_m2": 1e-3}),
            "/effects/rotary_inertia",
        ),
        (
            json!({"solid_inertia": "off"}),
            json!({"at": 0.5, "damping_x_n_s_m": 1}),
            "/effects/solid_inertia",
        ),
        (
            json!({"axial_inertia": "off"}),
            json!({"at": 0.5, "damping_z_n_s_m": 1}),
            "/effects/axial_inertia",
        ),
        (
            json!({"finite_rotation": "off", "axial_stretch": "off"}),
            json!({"at": 0.5, "stiffness_z_n_m": 1}),
            "/effects/axial_stretch",
        ),
    ] {
        let mut case = slender(json!("clamped"), json!("free"), json!([attachment]), 4);
        if effects["shear"] == "on" {
            case["beam"]["shear_stiffness_n"] = json!(5e4);
        }
        case["effects"] = effects;
        let error = System::new(&parse(&case)).unwrap_err();
        assert_eq!(places(faults(&error)), [kept]);
        assert!(faults(&error)[0].what.contains("/attachments/0"));
    }
}
