//! Frames at rest under large and small loads.

use serde_json::{Value, json};
use slcbeam::run::equilibrium::EventKind;

use crate::plans::{at_rest, beam, extrapolated, held, joint, near, path_of, section, structure};

/// Lee's frame under the force P at a fifth of its beam: legs of 120, hinged at both ends. A = 6, I = 2, E = 7.2e6.
fn lee(segments: usize, force: f64) -> Value {
    let leg = held(beam("leg", 120.0, 90.0, segments), "root", json!("pinned"));
    let mut top = held(beam("top", 120.0, 0.0, segments), "tip", json!("pinned"));
    top["attachments"] = json!([{"at": 0.2, "force_x_n": -force}]);
    top["probes"] = json!([{"name": "load", "at": 0.2}]);
    structure(
        section([4.32e7, 1.44e7, 1.0]),
        vec![leg, top],
        vec![joint("rigid", &["leg.tip", "top.root"])],
    )
}

/// Source: shooting in the exact elastica equations with pseudo-arc length, all digits converged. Goal: first limit load, and states before
/// it at displacements of 20 and 40.
#[test]
fn lees_frame_follows_its_path() {
    let meshes = [20, 40];
    for (force, across, along) in [(13457.911339, 20.0, 5.25517927), (17807.824644, 40.0, 17.557619869)] {
        let found = meshes.map(|n| at_rest(&lee(n, force)));
        let of = |name: &str| extrapolated(found.each_ref().map(|last| last(name)));
        near("down", -of("top.load_u1"), across, 1e-4);
        near("along", of("top.load_u3"), along, 1e-4);
        near("corner", found[1]("leg.tip_angle"), found[1]("top.tip_angle"), 10.0);
    }
    let limits = meshes.map(|n| {
        let (path, _) = path_of(&lee(n, 20000.0));
        let first = path.events.first().expect("a limit point");
        assert_eq!(first.kind, EventKind::LimitPoint);
        20000.0 * first.share
    });
    near("limit load", extrapolated(limits), 18556.727538, 1e-4);
}
