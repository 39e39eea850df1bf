//! What cannot be left out is refused, with its place, a reason and what to do; what has no meaning is off anyhow.

use std::path::Path;

use slcbeam::case;
use slcbeam::case::schema::Effect;
use slcbeam::model::{EffectSet, Model};

use super::common::{EVERYTHING, written};

fn effects(sets: &[&str]) -> EffectSet {
    Model::new(&written(EVERYTHING, sets)).unwrap().effects
}

fn refused(sets: &[&str], pointer: &str, what: &str) {
    let refusals = effects(sets).refusals;
    let texts: Vec<_> = refusals.iter().map(|r| (r.pointer.as_str(), r.what.as_str())).collect();
    assert!(
        texts.iter().any(|(at, why)| *at == pointer && why.contains(what)),
        "{texts:?}"
    );
    assert!(refusals.iter().all(|r| r.hint.is_some()));
}

const DRY_STRAIGHT: [&str; 4] = [
    "/effects={\"transverse_motion\":\"off\"}",
    "/loads=[]",
    "/start={}",
    "/ends={\"root\":\"clamped\",\"tip\":\"free\"}",
];

#[test]
fn a_beam_that_is_moved_across_is_no_bar() {
    let with = |set: &'static str| [DRY_STRAIGHT[0], DRY_STRAIGHT[1], DRY_STRAIGHT[2], DRY_STRAIGHT[3], set];
    assert!(effects(&DRY_STRAIGHT).refusals.is_empty());
    let at = "/effects/transverse_motion";
    refused(
        &with(r#"/loads=[{"gravity":{"z_m_s2":9.81}},{"gravity":{"x_m_s2":1}}]"#),
        at,
        "/loads/1",
    );
    refused(&with(r#"/ends/tip={"free":{"force_x_n":1}}"#), at, "the tip");
    refused(&with(r#"/ends/tip={"free":{"moment_n_m":1}}"#), at, "the tip");
    refused(
        &with(r#"/ends/root={"pinned":{"u1_m":{"sine":{"amplitude":1e-3,"frequency_hz":1}}}}"#),
        at,
        "the root",
    );
    refused(&with(r#"/start={"u1_rate_m_s":1}"#), at, "starts");
    let kept = effects(&with(r#"/start={"u1_rate_m_s":1}"#));
    assert!(kept.has(Effect::TransverseMotion), "kept until the case is mended");
}

#[test]
fn the_published_form_turns_and_what_turns_bears_its_normal_force() {
    let published = "/formulation=\"published\"";
    let small = "/effects={\"finite_rotation\":\"off\"}";
    refused(&[published, small], "/effects/finite_rotation", "published form");
    let linear = "/effects={\"axial_force_on_bending\":\"off\"}";
    refused(&[linear], "/effects/axial_force_on_bending", "finite_rotation is on");
    assert!(effects(&[small]).refusals.is_empty());
}

/// Goal: material damping of one of two motions needs inertia, which stays unless it is switched off by name; damping of both does not.
#[test]
fn half_a_damping_needs_inertia() {
    let off = r#"/effects={"solid_inertia":"off"}"#;
    let at = "/effects/solid_inertia";
    let damped = |times: &str| format!("/beam/damping={{{times}}}");
    let [bending, axial] = ["\"bending_time_s\":0.01", "\"axial_time_s\":0.01"];
    refused(&[off, &damped(bending)], at, "damps bending only");
    refused(&[off, &damped(axial)], at, "damps stretching only");
    for whole in [
        format!("{bending},{axial}"),
        format!("{bending},\"drag_n_s_m2\":0.01"),
        String::new(),
    ] {
        assert!(effects(&[off, &damped(&whole)]).refusals.is_empty(), "{whole}");
    }
    let bar = r#"/effects={"solid_inertia":"off","finite_rotation":"off","axial_stretch":"off"}"#;
    assert!(effects(&[bar, &damped(bending)]).refusals.is_empty());
    assert!(effects(&["/effects=\"auto\"", &damped(bending)]).has(Effect::SolidInertia));
}

#[test]
fn a_beam_without_axial_inertia_is_carried_by_an_end() {
    let free = r#"/ends={"root":"free","tip":"free"}"#;
    refused(
        &[free, "/effects={\"axial_inertia\":\"off\"}"],
        "/effects/axial_inertia",
        "neither end",
    );
}

#[test]
fn a_beam_that_does_not_stretch_is_held_by_one_end() {
    let off = r#"/effects={"finite_rotation":"off","axial_stretch":"off"}"#;
    let at = "/effects/axial_stretch";
    assert!(effects(&[off]).refusals.is_empty());
    refused(&[r#"/ends={"root":"free","tip":"free"}"#, off], at, "neither end");
    refused(&[r#"/ends={"root":"clamped","tip":"clamped"}"#, off], at, "both ends");
    refused(&[r#"/effects={"axial_stretch":"off"}"#], at, "finite_rotation is on");
}

#[test]
fn a_prescribed_flow_needs_flow() {
    refused(&["/effects={\"flow\":\"off\"}"], "/effects/flow", "prescribes a flow");
}

#[test]
fn networks_with_turbines_valves_or_different_ports_have_pressure_differences() {
    let off = "/effects={\"network_pressure_differences\":\"off\"}";
    let at = "/effects/network_pressure_differences";
    let turbine = r#"/network={"turbines":[{"from":{"bladder":1,"end":"inlet"},"to":{"bladder":2,"end":"inlet"},
        "conductance":{"m3_s_pa":1e-9}}]}"#;
    refused(&[off, turbine], at, "a turbine");
    let network = |parts: &str| format!("/network={{\"chains\":[{{\"bladders\":[1,2],{parts}}}]}}");
    let valve = network(r#""opening":{"sine":{"amplitude":0.5,"frequency_hz":1}}"#);
    refused(&[off, &valve], at, "a valve moves");
    refused(
        &[off, &network(r#""ends":[{"pressure_pa":1},{"pressure_pa":2}]"#)],
        at,
        "different pressures",
    );
    let same = network(r#""ends":[{"pressure_pa":1},{"pressure_pa":1}]"#);
    assert!(effects(&[off, &same]).refusals.is_empty());
}

#[test]
fn the_table_and_the_decisions_name_the_same_effects() {
    let set = effects(&[]);
    let decided: Vec<_> = set.decisions.iter().map(|d| d.effect).collect();
    assert_eq!(decided, Effect::ALL);
    for &effect in Effect::ALL {
        assert_eq!(set.decision(effect).effect, effect);
    }
}

#[test]
fn what_has_no_meaning_is_off_whatever_is_asked() {
    let dry = effects(&["/effects={\"fluid\":\"off\",\"flow\":\"on\",\"moment_to_area\":\"on\"}"]);
    assert!(
        !dry.has(Effect::Fluid) && !dry.has(Effect::Flow) && !dry.has(Effect::MomentToArea) && dry.refusals.is_empty()
    );
}

/// The rotation of sections with shear has no rates of its own without rotary inertia.
#[test]
fn what_needs_the_rotation_of_sections_keeps_its_inertia() {
    let off = r#"/effects={"shear":"on","rotary_inertia":"off"}"#;
    let stiff = "/beam/shear_stiffness_n=300";
    let at = "/effects/rotary_inertia";
    let damped = |bending: &'static str| {
        [
            off,
            stiff,
            "/attachments=[]",
            "/beam/damping/axial_time_s=1e-3",
            bending,
        ]
    };
    refused(
        &damped("/beam/damping/bending_time_s=0"),
        at,
        "axial_time_s without bending_time_s",
    );
    assert!(
        effects(&damped("/beam/damping/bending_time_s=1e-3"))
            .refusals
            .is_empty()
    );
    let structure = r#"{"name": "two", "beam": {"length_m": 0.1, "height_m": 0.01, "width_m": 0.02, "young_modulus_pa": 1e6,
        "density_kg_m3": 1000, "shear_stiffness_n": 60}, "beams": [{"name": "a", "ends": {"root": "clamped"},
        "attachments": [{"at": 0.5, "rotary_inertia_kg_m2": 1e-6}]}], "effects": {"shear": "on", "rotary_inertia": "off"},
        "time": {"end_s": 0.1}}"#;
    let case = case::parse(structure, Path::new("two.json"), Path::new(""), &[]).unwrap();
    let refusals = Model::new(&case).unwrap().effects.refusals;
    assert!(refusals[0].what.contains("/beams/0/attachments/0"), "{refusals:?}");
}
