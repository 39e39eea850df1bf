//! One structure described in several ways, and joints with values of their own.
//!
//! Source: the same structure; statics of a cantilever with a hinge.

use serde_json::{Value, json};
use slcbeam::run::modes::{ModeOptions, modes};

use crate::balances::close;
use crate::plans::{at_rest, beam, extrapolated, held, joint, near, section, structure};
use crate::scene::{finished, parse};

/// Wet beams of 0.01 m per segment under gravity; bladders in the order of one chain.
fn wet(beams: Vec<Value>, joints: Vec<Value>, bladders: &[&str]) -> Value {
    json!({
        "name": "wet", "preset": "matia-gat-beam", "bladders": {"coupling": "reciprocal"},
        "beam": {"damping": {"bending_time_s": 5e-3, "axial_time_s": 5e-3}},
        "beams": beams, "joints": joints,
        "network": {"chains": [{"bladders": bladders, "ends": [{"pressure_pa": 6000}, "sealed"]}]},
        "loads": [{"gravity": {"x_m_s2": -9.81, "z_m_s2": 3.0}}], "effects": "full", "companion": "off",
        "mesh": {"cells_per_segment": 2}, "time": {"end_s": 0.02}, "solver": {"rtol": 1e-9}
    })
}

fn part(name: &str, degrees: f64, segments: usize) -> Value {
    beam(name, 0.01 * segments as f64, degrees, segments)
}

fn clamped(beam: Value) -> Value {
    held(beam, "root", json!("clamped"))
}

/// Asserts that places of two structures at rest agree to rounding.
fn same(what: &str, ours: &Value, theirs: &Value, columns: &[(&str, &str)]) {
    let (ours, theirs) = (at_rest(ours), at_rest(theirs));
    for (own, other) in columns {
        let (a, b) = (ours(own), theirs(other));
        println!("{what}: {own} {a:e}, {other} {b:e}");
        assert!(
            a.abs() > 1e-5 && (a - b).abs() < 1e-11 * a.abs().max(0.01),
            "{what}: {own} {a:e}, {other} {b:e}"
        );
    }
}

/// A T: three segments, a branch at 70 degrees, three further segments, divided into two beams.
fn tee() -> Value {
    wet(
        vec![clamped(part("a", 10.0, 3)), part("rest", 10.0, 3), part("c", 80.0, 2)],
        vec![joint("rigid", &["a.tip", "rest.root", "c.root"])],
        &["a:1", "a:2", "a:3", "rest:1", "rest:2", "rest:3", "c:1", "c:2"],
    )
}

/// Goal: a branch within a beam divides it as if it were two; a stiff spring in a hinge is a rigid joint.
#[test]
fn a_joint_within_a_beam_divides_it() {
    let row = ["a:1", "a:2", "a:3", "a:4", "a:5", "a:6", "c:1", "c:2"];
    let of = |joint: Value| wet(vec![clamped(part("a", 10.0, 6)), part("c", 80.0, 2)], vec![joint], &row);
    let within = of(joint("rigid", &["a.3", "c.root"]));
    same(
        "within",
        &within,
        &tee(),
        &[
            ("a.tip_u1", "rest.tip_u1"),
            ("a.tip_x", "rest.tip_x"),
            ("c.tip_u1", "c.tip_u1"),
            ("c.tip_angle", "c.tip_angle"),
        ],
    );
    let mut hinge = joint("hinge", &["a.3", "c.root"]);
    hinge["kind"]["hinge"] = json!({"stiffness_n_m_rad": 1e4});
    let (stiff, rigid) = (at_rest(&of(hinge.clone())), at_rest(&within));
    for name in ["a.tip_u1", "c.tip_u1", "c.tip_angle"] {
        // the couple of 0.02 m of beam over the spring: 1e-6 of the angle
        near(name, stiff(name), rigid(name), 1e-4);
    }
    hinge["kind"]["hinge"] = json!({"stiffness_n_m_rad": 1.0});
    let soft = at_rest(&of(hinge));
    assert!((soft("c.tip_angle") / rigid("c.tip_angle") - 1.0).abs() > 1e-2);
}

/// Goal: the order of beams, and of the places of a joint, changes nothing.
#[test]
fn order_of_beams_and_places_is_free() {
    let row = ["a:1", "a:2", "a:3", "rest:1", "rest:2", "rest:3", "c:1", "c:2"];
    let columns = ["a.tip_u1", "rest.tip_u1", "rest.tip_angle", "c.tip_u1", "c.tip_u3"].map(|name| (name, name));
    for order in [["c.root", "rest.root", "a.tip"], ["rest.root", "a.tip", "c.root"]] {
        let mut first = part("c", 80.0, 2);
        let (sin, cos) = 10.0_f64.to_radians().sin_cos();
        first["origin_m"] = json!([0.03 * sin, 0.03 * cos]);
        let beams = vec![first, part("rest", 10.0, 3), clamped(part("a", 10.0, 3))];
        same(
            "order",
            &tee(),
            &wet(beams, vec![joint("rigid", &order)], &row),
            &columns,
        );
    }
}

/// Goal: a beam from its other end is the same beam; its upper bladders are its lower ones then.
#[test]
fn beams_may_begin_at_either_end() {
    let row = ["a:1", "a:2", "a:3", "rest:-3", "rest:-2", "rest:-1", "c:-2", "c:-1"];
    let beams = vec![clamped(part("a", 10.0, 3)), part("rest", 190.0, 3), part("c", 260.0, 2)];
    let other = wet(beams, vec![joint("rigid", &["a.tip", "rest.tip", "c.tip"])], &row);
    same(
        "reversed",
        &tee(),
        &other,
        &[
            ("a.tip_u1", "a.tip_u1"),
            ("a.tip_angle", "a.tip_angle"),
            ("bending_energy", "bending_energy"),
        ],
    );
    let [ours, theirs] = [tee(), other].map(|case| finished(&case).0);
    let [ours, theirs] = [ours, theirs].map(|memory| memory.column("a.tip_u1").unwrap());
    let size = ours.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    for (a, b) in ours.iter().zip(&theirs) {
        assert!((a - b).abs() < 1e-8 * size, "{a:e} {b:e}");
    }
}

/// A beam with a body at 0.6 of its length, attached or at a joint.
fn with_body(attached: bool, rotary: f64, cells: usize) -> Value {
    let solid = section([1e4, 1.0, 1.0]);
    let body = |mut one: Value| {
        one["mass_kg"] = json!(0.7);
        one["rotary_inertia_kg_m2"] = json!(rotary);
        one
    };
    let mut case = if attached {
        let mut whole = clamped(beam("a", 1.0, 30.0, 5 * cells));
        whole["attachments"] = json!([body(json!({"at": 0.6}))]);
        structure(solid, vec![whole], vec![])
    } else {
        let parts = vec![
            clamped(beam("a", 0.6, 30.0, 3 * cells)),
            beam("b", 0.4, 30.0, 2 * cells),
        ];
        structure(solid, parts, vec![body(joint("rigid", &["a.tip", "b.root"]))])
    };
    case["effects"] = json!("full");
    case
}

/// Goal: a body at a joint is a body attached to the beam without a joint: at rest under gravity, and in its modes. Its rotation is that of the
/// joint, or the mean of the cells beside it: the same in the limit of fine meshes.
#[test]
fn a_body_at_a_joint_is_an_attached_one() {
    let [one, two] = [true, false].map(|attached| {
        let mut case = with_body(attached, 0.02, 4);
        case["loads"] = json!([{"gravity": {"x_m_s2": -0.8, "z_m_s2": 0.3}}]);
        case
    });
    same(
        "body",
        &one,
        &two,
        &[
            ("a.tip_u1", "b.tip_u1"),
            ("a.tip_x", "b.tip_x"),
            ("a.tip_angle", "b.tip_angle"),
        ],
    );
    let frequencies = |attached: bool, rotary: f64, cells: usize| -> Vec<f64> {
        let options = ModeOptions {
            count: 5,
            near_hz: 0.0,
            limits: false,
        };
        let found = modes(&parse(&with_body(attached, rotary, cells)), &options).unwrap();
        found.modes.iter().map(|mode| mode.s.im.abs()).collect()
    };
    for (one, two) in frequencies(true, 0.0, 4).into_iter().zip(frequencies(false, 0.0, 4)) {
        assert!(one > 0.1);
        near("mode with a point mass", two, one, 1e-9);
    }
    let [one, two] = [true, false].map(|attached| [8, 16].map(|cells| frequencies(attached, 0.02, cells)));
    for k in 0..4 {
        let [one, two] = [&one, &two].map(|meshes| extrapolated([meshes[0][k], meshes[1][k]]));
        near("mode with a body", two, one, 3e-5);
    }
}

/// Source: the cantilever of two beams with a hinge: the spring turns by `F b/k`, up to a stop by its own stiffness, which begins after half
/// the angle over which it comes in. The loads are small.
#[test]
fn a_hinge_yields_by_its_spring_and_its_stop() {
    let (force, far) = (1e-4, 0.4);
    let moment = force * far;
    for (law, turn) in [
        (json!({"stiffness_n_m_rad": 0.5}), moment / 0.5),
        (json!({"stiffness_n_m_rad": 0.5, "rest_rad": 1e-4}), moment / 0.5 + 1e-4),
        (
            json!({"stiffness_n_m_rad": 0.5, "rest_rad": -0.8}),
            moment * 0.8_f64.cos() / 0.5 - 0.8,
        ),
        (
            json!({"stiffness_n_m_rad": 0.5, "stop": {"from_rad": -1.0, "to_rad": 2e-5, "stiffness_n_m_rad": 2.0, "smoothing_rad": 1e-5}}),
            (moment + 2.0 * 2.5e-5) / 2.5,
        ),
        (
            // within the beginning of the stop: M = k β + k_s β²/(2 d)
            json!({"stiffness_n_m_rad": 0.5, "stop": {"from_rad": -1.0, "to_rad": 0.0, "stiffness_n_m_rad": 2.0, "smoothing_rad": 1e-3}}),
            (-0.5 + (0.25 + 4.0 * 1e3 * moment).sqrt()) / 2e3,
        ),
    ] {
        let mut hinge = joint("hinge", &["a.tip", "b.root"]);
        hinge["kind"]["hinge"] = law.clone();
        let tip = held(beam("b", far, 0.0, 4), "tip", json!({"free": {"force_x_n": force}}));
        let last = at_rest(&structure(
            section([1e4, 1.0, 1.0]),
            vec![clamped(beam("a", 0.6, 0.0, 6)), tip],
            vec![hinge],
        ));
        near(&format!("{law}"), last("hinge_1_angle"), turn, 1e-6);
    }
}

/// Goal: a run with hinge, damper, stop and body closes its balances, and a run from the equilibrium remains there.
#[test]
fn a_jointed_run_closes_its_balances_and_rests_in_its_equilibrium() {
    let mut body = joint("rigid", &["a.tip", "rest.root"]);
    body["mass_kg"] = json!(0.02);
    body["rotary_inertia_kg_m2"] = json!(1e-5);
    let mut hinge = joint("hinge", &["rest.tip", "c.root"]);
    hinge["kind"]["hinge"] = json!({"stiffness_n_m_rad": 0.02, "damping_n_m_s_rad": 1e-3,
        "stop": {"from_rad": -0.02, "to_rad": 0.02, "stiffness_n_m_rad": 0.5, "smoothing_rad": 0.01}});
    let mut apart = part("c", 80.0, 2);
    apart["attachments"] = json!([{"at": 1.0, "mass_kg": 0.01}]);
    let mut case = wet(
        vec![clamped(part("a", 10.0, 3)), part("rest", 40.0, 3), apart],
        vec![body, hinge],
        &["a:1", "a:2", "a:3", "rest:1", "rest:2", "rest:3"],
    );
    case["time"]["end_s"] = json!(0.1);
    let (memory, summary) = finished(&case);
    close("jointed", &summary, 1e-6);
    let angle = memory.column("hinge_1_angle").unwrap();
    assert!(angle.iter().any(|angle| angle.abs() > 0.02), "the stop is reached");
    case["start"] = json!({"equilibrium": {}});
    let tip = finished(&case).0.column("c.tip_u1").unwrap();
    let off = tip.iter().map(|u| (u - tip[0]).abs()).fold(0.0, f64::max);
    println!("moves by {off:.1e} of {:.1e}", tip[0]);
    assert!(
        tip[0].abs() > 1e-4 && off < 1e-8 * tip[0].abs(),
        "{off:e} of {:e}",
        tip[0]
    );
}

/// Goal: the energies of all beams, those of a divided one together, are the energies of the whole.
#[test]
fn energies_of_beams_sum_to_the_whole() {
    let mut case = tee();
    case["joints"][0]["at"] = json!(["a.2", "c.root"]);
    case["beams"][1]["origin_m"] = json!([0.1, 0.0]);
    case["beams"][1]["ends"] = json!({"root": "clamped"});
    case["time"]["end_s"] = json!(0.01);
    let (memory, _) = finished(&case);
    let last = |name: &str| *memory.column(name).unwrap().last().unwrap();
    for (parts, whole) in [
        ("kinetic_energy", ["kinetic_energy", "rotary_energy"]),
        ("elastic_energy", ["axial_energy", "bending_energy"]),
    ] {
        let sum: f64 = ["a", "rest", "c"]
            .map(|beam| last(&format!("{beam}.{parts}")))
            .iter()
            .sum();
        let whole: f64 = whole.map(last).iter().sum();
        println!("{parts}: {sum} for {whole}");
        assert!(
            whole > 1e-9 && (sum - whole).abs() < 1e-12 * whole,
            "{parts}: {sum} for {whole}"
        );
    }
}

/// Goal: a signal of a load of the case is one input of all beams, whatever their angles: a turned structure with a turned load responds alike.
#[test]
fn an_input_acts_on_all_beams() {
    let of = |turn: f64, axis: &str| {
        let stem = clamped(part("a", turn, 3));
        let arm = part("c", 70.0 + turn, 2);
        let mut case = wet(
            vec![stem, arm],
            vec![joint("rigid", &["a.tip", "c.root"])],
            &["a:1", "a:2", "a:3", "c:1", "c:2"],
        );
        case["loads"] = json!([{axis: {"signal": {"sine": {"amplitude": 1.0, "frequency_hz": 3.0}}}}]);
        let case = parse(&case);
        let mut system = slcbeam::discrete::System::new(&case).unwrap();
        let signal = case.loads[0].distributed().unwrap().1.signal.clone();
        (system.places_of(&signal).len(), system.loads.len())
    };
    // two components on each beam, of which those across a turned axis vanish
    assert_eq!(of(20.0, "force_x_n_m"), (8, 4));
    assert_eq!(of(0.0, "force_x_n_m"), (6, 3));
}
