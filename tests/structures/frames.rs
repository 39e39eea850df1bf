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

/// Loads of the limit points of a path.
fn limit_loads(case: &Value, largest: f64) -> Vec<f64> {
    let (path, _) = path_of(case);
    let limits = path.events.iter().filter(|event| event.kind == EventKind::LimitPoint);
    limits.map(|event| largest * event.share).collect()
}

/// Source: shooting in the exact elastica equations with pseudo-arc length, all digits converged. Goal: both limit loads,
/// the first also of beams that shear, and states before it at displacements of 20 and 40.
#[test]
fn lees_frame_follows_its_path() {
    let meshes = [20, 40];
    for (force, across, along, corner) in [
        (13457.911339, 20.0, 5.25517927, 0.57684785974),
        (17807.824644, 40.0, 17.557619869, 0.90600387105),
    ] {
        let found = meshes.map(|n| at_rest(&lee(n, force)));
        let of = |name: &str| extrapolated(found.each_ref().map(|last| last(name)));
        near("down", -of("top.load_u1"), across, 1e-4);
        near("along", of("top.load_u3"), along, 1e-4);
        near("corner", -of("leg.tip_angle"), corner, 1e-4);
    }
    let limits = meshes.map(|n| limit_loads(&lee(n, 20000.0), 20000.0));
    for (k, exact) in [18556.727538, -9414.4315556].into_iter().enumerate() {
        near(
            "limit load",
            extrapolated(limits.each_ref().map(|loads| loads[k])),
            exact,
            1e-4,
        );
    }
    let sheared = meshes.map(|n| {
        let mut case = lee(n, 20000.0);
        case["beam"]["shear_stiffness_n"] = json!(4.32e7 * 5.0 / 6.0 / 2.6);
        limit_loads(&case, 20000.0)[0]
    });
    near("limit load with shear", extrapolated(sheared), 18544.527094, 1e-4);
}

/// Goal: the path is stable up to its first limit load, has one unstable direction between both and is stable behind the second.
#[test]
fn lees_frame_is_unstable_between_its_limit_loads() {
    let (path, _) = path_of(&lee(20, 20000.0));
    let states = &path.states;
    // the load turns back at the second limit, where it is least, and at the first one, where it is largest before
    let least = (0..states.len())
        .min_by(|a, b| states[*a].share.total_cmp(&states[*b].share))
        .unwrap();
    let most = (0..least)
        .max_by(|a, b| states[*a].share.total_cmp(&states[*b].share))
        .unwrap();
    assert!(most > 5 && least > most + 5 && states.len() > least + 5);
    for (k, state) in states
        .iter()
        .enumerate()
        .filter(|(k, _)| k.abs_diff(most) > 1 && k.abs_diff(least) > 1)
    {
        let unstable = state.stability.expect("eigenvalues").unstable;
        assert_eq!(unstable, usize::from(k > most && k < least), "{k}: {}", state.share);
    }
}

/// Source: sway of a portal with clamped columns and a girder of the same length and stiffness: `k/tan k = -6`, `P = k² EI/L²`, k = 2.71646;
/// the stretch of the columns changes it by `P/EA`. Goal: columns under two forces buckle at this load, and sway.
#[test]
fn a_portal_buckles_by_sway() {
    let of = |segments: usize| {
        let clamped = |name, degrees, end| held(beam(name, 1.0, degrees, segments), end, json!("clamped"));
        let mut left = clamped("left", 90.0, "root");
        left["attachments"] = json!([{"at": 1.0, "force_z_n": -9.0}]);
        let mut right = clamped("right", -90.0, "tip");
        right["attachments"] = json!([{"at": 0.0, "force_z_n": 9.0}]);
        let joints = vec![
            joint("rigid", &["left.tip", "girder.root"]),
            joint("rigid", &["girder.tip", "right.root"]),
        ];
        structure(
            section([1e6, 1.0, 1.0]),
            vec![left, beam("girder", 1.0, 0.0, segments), right],
            joints,
        )
    };
    let k = (0..60).fold([2.0_f64, 3.0], |[low, high], _| {
        let k = 0.5 * (low + high);
        if k / k.tan() > -6.0 { [k, high] } else { [low, k] }
    });
    let loads = [16, 32].map(|n| {
        let (path, names) = path_of(&of(n));
        let first = path.events.first().expect("buckling");
        assert_eq!(first.kind, EventKind::Bifurcation);
        let sway = names.iter().position(|name| name == "left.tip_u1").unwrap();
        assert!(path.last().row[sway].abs() > 0.1, "it sways");
        9.0 * first.share
    });
    near("buckling load", extrapolated(loads), k[0] * k[0], 1e-4);
}

/// Deep arch of 215 degrees and radius 1 as a polygon, clamped at its left end and hinged at the right one, with a force at its crown.
fn arch(sides: usize, force: f64) -> Value {
    let each = 215.0 / sides as f64;
    let chord = 2.0 * (0.5 * each.to_radians()).sin();
    let names: Vec<String> = (0..sides).map(|k| format!("s{k}")).collect();
    let mut beams: Vec<Value> = (0..sides)
        .map(|k| beam(&names[k], chord, 107.5 - (k as f64 + 0.5) * each, 2))
        .collect();
    beams[0]["ends"]["root"] = json!("clamped");
    beams[sides - 1]["ends"]["tip"] = json!("pinned");
    // at the root that follows the tip before it, in its own axes
    let angle = (-0.5 * each).to_radians();
    beams[sides / 2]["attachments"] =
        json!([{"at": 0.0, "force_x_n": -force * angle.cos(), "force_z_n": -force * angle.sin()}]);
    let joints = (1..sides).map(|k| joint("rigid", &[&format!("s{}.tip", k - 1), &format!("s{k}.root")]));
    let mut case = structure(section([1e4, 1.0, 1.0]), beams, joints.collect());
    case["beams"][0]["origin_m"] = json!([107.5_f64.to_radians().cos(), -107.5_f64.to_radians().sin()]);
    case
}

/// Source: shooting, 10 digits; 8.97 of DaDeppo and Schmidt (1975) without stretch. Goal: first limit load, and the crown at 6 EI/R².
#[test]
fn deep_arch_snaps_at_its_limit_load() {
    let meshes = [24, 48];
    let found = meshes.map(|n| at_rest(&arch(n, 6.0)));
    let crown = meshes.map(|n| format!("s{}", n / 2 - 1));
    let of = |column: &str| extrapolated([0, 1].map(|k| found[k](&format!("{}.{column}", crown[k]))));
    near("along", of("tip_z"), 0.43298256143, 1e-4);
    near("down", 1.0 - of("tip_x"), 0.58585613629, 1e-4);
    near("rotation", of("tip_angle"), 0.096373745719, 1e-4);
    let limits = meshes.map(|n| limit_loads(&arch(n, 10.0), 10.0)[0]);
    near("limit load", extrapolated(limits), 8.9591053039, 1e-4);
}

/// Source: the stiffness matrix of three members of lengths 1, 0.8, 1.3 and EI 1, 2, 0.5 with EA = 1000, at 90, 210, 330 degrees. Goal: a
/// small force at their joint moves and turns it.
#[test]
fn a_y_yields_as_by_its_stiffness_matrix() {
    let of = |segments: usize| {
        let members = [("a", 90.0, 1.0, 1.0), ("b", 210.0, 0.8, 2.0), ("c", 330.0, 1.3, 0.5)];
        let beams = members.map(|(name, degrees, length, ei)| {
            let mut member = held(beam(name, length, degrees + 180.0, segments), "root", json!("clamped"));
            member["beam"] = section([1000.0, ei, 1.0]);
            member["origin_m"] = json!([
                length * f64::to_radians(degrees).sin(),
                length * f64::to_radians(degrees).cos()
            ]);
            member
        });
        let [mut a, b, c] = beams;
        a["attachments"] = json!([{"at": 1.0, "force_x_n": 6e-4, "force_z_n": -8e-4}]);
        structure(
            section([1000.0, 1.0, 1.0]),
            vec![a, b, c],
            vec![joint("rigid", &["a.tip", "b.tip", "c.tip"])],
        )
    };
    let found = [16, 32].map(|n| at_rest(&of(n)));
    let of = |name: &str| extrapolated(found.each_ref().map(|last| last(name)));
    near("to the right", of("a.tip_u1"), 3.296926502900054e-07, 1e-5);
    near("upwards", -of("a.tip_u3"), 4.818633099170407e-07, 1e-5);
    near("rotation", of("b.tip_angle"), 3.654394000579e-07, 1e-5);
}

/// Goal: a parallelogram of hinged beams, driven at a crank, moves as a rigid mechanism: no energy, exact places.
#[test]
fn a_parallelogram_moves_without_energy() {
    let turn = 1.1;
    let crank = held(
        beam("crank", 0.4, 70.0, 4),
        "root",
        json!({"clamped": {"slope_rad": -turn}}),
    );
    let rocker = held(beam("rocker", 0.4, 250.0, 4), "tip", json!("pinned"));
    let joints = vec![
        joint("hinge", &["crank.tip", "coupler.root"]),
        joint("hinge", &["coupler.tip", "rocker.root"]),
    ];
    let case = structure(
        section([1e4, 1.0, 1.0]),
        vec![crank, beam("coupler", 0.7, 0.0, 6), rocker],
        joints,
    );
    let last = at_rest(&case);
    let angle = 70.0_f64.to_radians() - turn;
    for (name, exact) in [
        ("crank.tip_z", 0.4 * angle.cos()),
        ("crank.tip_x", 0.4 * angle.sin()),
        ("coupler.tip_z", 0.7 + 0.4 * angle.cos()),
        ("coupler.tip_x", 0.4 * angle.sin()),
        ("rocker.tip_z", 0.7),
        ("rocker.tip_x", 0.0),
        ("coupler.tip_angle", 0.0),
        ("rocker.tip_angle", -turn),
    ] {
        assert!((last(name) - exact).abs() < 1e-10, "{name}: {} for {exact}", last(name));
    }
    assert!(last("bending_energy").abs() + last("axial_energy").abs() < 1e-16);
}
