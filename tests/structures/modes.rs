//! Frequencies of frames.
//!
//! Source: dynamic stiffness (exact Euler-Bernoulli beams and rods), a Wittrick-Williams count, roots in 40 digits; checked with spectral
//! elements to 2.5e-9. EI = 1, EA = 1e4, mass per length 1, angular frequencies [rad/s].

use serde_json::{Value, json};
use slcbeam::run::modes::{ModeOptions, modes};

use crate::plans::{beam, extrapolated, held, joint, near, section, structure};
use crate::scene::parse;

/// Angular frequencies of the six slowest modes.
fn six(case: &Value) -> Vec<f64> {
    let options = ModeOptions {
        count: 6,
        near_hz: 0.0,
        limits: false,
    };
    let found = modes(&parse(case), &options).unwrap();
    found.modes.iter().map(|mode| mode.s.im.abs()).collect()
}

/// Compares the extrapolation from two meshes with a reference.
fn agrees(what: &str, of: impl Fn(usize) -> Value, reference: [f64; 6], within: f64) {
    let [coarse, fine] = [1, 2].map(|k| six(&of(k)));
    for (k, reference) in reference.into_iter().enumerate() {
        near(
            &format!("{what} {}", k + 1),
            extrapolated([coarse[k], fine[k]]),
            reference,
            within,
        );
    }
}

fn frame(beams: Vec<Value>, joints: Vec<Value>) -> Value {
    structure(section([1e4, 1.0, 1.0]), beams, joints)
}

/// Goal: an L, its column clamped.
#[test]
fn an_l_swings_as_by_dynamic_stiffness() {
    let of = |k: usize| {
        let column = held(beam("column", 1.0, 90.0, 24 * k), "root", json!("clamped"));
        frame(
            vec![column, beam("arm", 1.0, 0.0, 24 * k)],
            vec![joint("rigid", &["column.tip", "arm.root"])],
        )
    };
    let reference = [
        1.1717400228594,
        3.1902174771869,
        15.734770050882,
        23.033248738566,
        50.190114905563,
        62.0944409843,
    ];
    agrees("L", of, reference, 1e-4);
}

/// Goal: a fork of a clamped stem and two tines at 30 degrees.
#[test]
fn a_fork_swings_as_by_dynamic_stiffness() {
    let of = |k: usize| {
        let stem = held(beam("stem", 1.0, 0.0, 24 * k), "root", json!("clamped"));
        let tines = [("left", 30.0), ("right", -30.0)].map(|(name, degrees)| beam(name, 0.7, degrees, 16 * k));
        let [left, right] = tines;
        frame(
            vec![stem, left, right],
            vec![joint("rigid", &["stem.tip", "left.root", "right.root"])],
        )
    };
    let reference = [
        0.91512472629709,
        6.2541837837684,
        7.1715495907697,
        21.124337525391,
        39.229887573151,
        44.548744482473,
    ];
    agrees("fork", of, reference, 1e-4);
}

fn portal(kind: &str, k: usize) -> Value {
    let clamped = |name, degrees, end| held(beam(name, 1.0, degrees, 24 * k), end, json!("clamped"));
    frame(
        vec![
            clamped("left", 90.0, "root"),
            beam("girder", 1.0, 0.0, 24 * k),
            clamped("right", -90.0, "tip"),
        ],
        vec![
            joint(kind, &["left.tip", "girder.root"]),
            joint(kind, &["girder.tip", "right.root"]),
        ],
    )
}

/// Goal: a portal of clamped columns with rigid corners.
#[test]
fn a_rigid_portal_swings_as_by_dynamic_stiffness() {
    let reference = [
        3.2036879965415,
        12.620725507556,
        20.623310711085,
        22.275678903797,
        44.794840149152,
        54.952225413439,
    ];
    agrees("rigid portal", |k| portal("rigid", k), reference, 1e-4);
}

/// Goal: the same with hinges at both corners.
#[test]
fn a_hinged_portal_swings_as_by_dynamic_stiffness() {
    let reference = [
        2.0162759094326,
        9.8500991562638,
        15.40694030331,
        16.898654401794,
        39.150271413012,
        49.836502587981,
    ];
    agrees("hinged portal", |k| portal("hinge", k), reference, 1e-4);
}
