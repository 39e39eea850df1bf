//! Cases that break a rule of physics or of the network: every fault is told, once, where it is.

use std::path::Path;

use crate::faulty::{TOUR, WIRING, assert_fault, fault_of, one, only, replaced};
use slcbeam::case;

#[test]
fn a_wrong_unit_is_suspected() {
    let fault = fault_of(&replaced(
        WIRING,
        &[("\"young_modulus_pa\": 2e6", "\"young_modulus_pa\": 2")],
    ));
    insta::assert_snapshot!(case::render(&fault, false, 80), @r#"
    fault[E010]: 2 Pa is not a plausible size
     --> bad.json:6:79 at /beam/young_modulus_pa
    6 | ...idth_m": 0.05, "young_modulus_pa": 2, "density_kg_m3": 950,
      |                                       ^
      = allowed: 100 to 1e13 Pa
      = hint: moduli are in Pa; is this in MPa or GPa?

    1 fault in bad.json
    more about the first: slcbeam explain E010
    "#);
    assert_fault(
        one(&[("\"length_m\": 0.1,", "\"length_m\": 100,")]),
        "/beam/length_m",
        "100",
        "4630 times as long",
    );
    assert_fault(
        one(&[("\"radius_m\": 0.001", "\"radius_m\": 1")]),
        "/tubes/radius_m",
        "1",
        "not a plausible size",
    );
    assert_fault(
        one(&[("\"length_m\": 0.02,", "\"length_m\": 20,")]),
        "/tubes/length_m",
        "20",
        "a tube of 20 m",
    );
}

/// Goal: who means such sizes says so, and only sizes are meant by it. An analysis without units: E, density, viscosity and length are 1.
#[test]
fn sizes_that_are_meant_are_taken() {
    let odd = [
        ("\"young_modulus_pa\": 2e6", "\"young_modulus_pa\": 2"),
        ("\"radius_m\": 0.001", "\"radius_m\": 1"),
        ("\"length_m\": 0.02,", "\"length_m\": 20,"),
        (
            "\"area_per_pressure_m2_per_pa\": 1.75e-10",
            "\"area_per_pressure_m2_per_pa\": 1.75e-2",
        ),
    ];
    let meant = [odd.as_slice(), &[("{", "{\"plausibility\": \"off\",")]].concat();
    let read = |text: &str| case::parse(text, Path::new("odd.json"), Path::new("cases"), &[]);
    assert_eq!(fault_of(&replaced(WIRING, &odd)).violations.len(), 4);
    let taken = read(&replaced(WIRING, &meant)).expect("sizes as they are meant");
    assert_eq!(taken.beam.young_modulus_pa, 2.0);
    let negative = [
        meant.as_slice(),
        &[("\"density_kg_m3\": 950", "\"density_kg_m3\": -950")],
    ]
    .concat();
    assert_eq!(only(&replaced(WIRING, &negative)).0, "/beam/density_kg_m3");
}

#[test]
fn bladders_and_tubes_lead_somewhere() {
    let at = "/network/chains/0/bladders/4";
    assert_fault(
        one(&[("4, 5, 6", "4, 4, 6")]),
        at,
        "4",
        "bladder 4 is used twice, first at /network/chains/0/bladders/3",
    );
    assert_fault(one(&[("4, 5, 6", "4, 0, 6")]), at, "0", "there is no bladder 0");
    assert_fault(
        one(&[("-10]", "-11]")]),
        "/network/chains/1/bladders/9",
        "-11",
        "there is no bladder -11",
    );
    let tour = |from, to| only(&replaced(TOUR, &[(from, to)]));
    assert_fault(
        tour(
            "{\"junction\": \"tee\"}, \"to\": {\"bladder\": 4,",
            "{\"junction\": \"tea\"}, \"to\": {\"bladder\": 4,",
        ),
        "/network/tubes/1/from/junction",
        "\"tea\"",
        "junction \"tea\" is not declared",
    );
    let tube = "\"from\": {\"bladder\": 3, \"end\": \"outlet\"}";
    let looped = [
        (tube, "\"from\": {\"junction\": \"tee\"}"),
        ("[\"connected\", \"connected\"]", "[\"connected\", \"sealed\"]"),
    ];
    assert_fault(
        only(&replaced(TOUR, &looped)),
        "/network/tubes/0/to",
        "{\"junction\": \"tee\"}",
        "to itself",
    );
    assert_fault(
        tour(
            "\"inlet\"}, \"length_m\": 0.01}",
            "\"inlet\", \"junction\": \"tee\"}, \"length_m\": 0.01}",
        ),
        "/network/tubes/1/to",
        "\"to\"",
        "a bladder end and a junction at once",
    );
}

#[test]
fn a_tube_to_nowhere() {
    let tubes =
        "\"tubes\": [{\"from\": {\"bladder\": 1, \"end\": \"inlet\"}, \"to\": {\"bladder\": 12, \"end\": \"inlet\"}}]";
    let text = replaced(
        WIRING,
        &[
            ("\"network\": {", &format!("\"network\": {{ {tubes},")),
            ("\"sealed\"", "\"connected\""),
        ],
    );
    assert_fault(
        only(&text),
        "/network/tubes/0/to/bladder",
        "12",
        "there is no bladder 12",
    );
}

#[test]
fn junctions_chain_ends_and_ports() {
    let tour = |changes: &[(&str, &str)]| only(&replaced(TOUR, changes));
    let declared = ("\"junctions\": [\"tee\"]", "\"junctions\": [\"tee\", \"tee\"]");
    assert_fault(tour(&[declared]), "/network/junctions/1", "\"tee\"", "declared twice");
    let unused = ("\"junctions\": [\"tee\"]", "\"junctions\": [\"tee\", \"lost\"]");
    assert_fault(tour(&[unused]), "/network/junctions/1", "\"lost\"", "not used");
    assert_fault(
        tour(&[(
            "\"ends\": [\"connected\", \"sealed\"]",
            "\"ends\": [\"sealed\", \"sealed\"]",
        )]),
        "/network/chains/1/ends/0",
        "\"sealed\"",
        "the inlet of bladder 4 is sealed, but /network/tubes/1",
    );
    assert_fault(
        tour(&[(
            "\"ends\": [\"connected\", \"sealed\"]",
            "\"ends\": [\"connected\", \"connected\"]",
        )]),
        "/network/chains/1/ends/1",
        "\"connected\"",
        "nothing is connected to the outlet of bladder 7",
    );
    let (pointer, _, what) = tour(&[("\"flow_m3_s\"", "\"pressure_pa\": 0, \"flow_m3_s\"")]);
    assert_eq!(
        (pointer.as_str(), what.as_str()),
        (
            "/network/ports/1",
            "a port with more than one of pressure, flow and volume"
        )
    );
    let (pointer, _, what) = tour(&[(
        "{\"bladder\": -10, \"end\": \"outlet\"}",
        "{\"bladder\": 1, \"end\": \"inlet\"}",
    )]);
    assert_eq!(pointer, "/network/ports/1/at");
    assert!(what.contains("a second port at the inlet of bladder 1"), "{what}");
}

#[test]
fn a_junction_that_is_cut_off_is_dead() {
    let valve = "\"opening\": {\"ramp\": {\"from\": 1, \"to\": 0, \"start_s\": 0.15, \"duration_s\": 0.1}}";
    let closing = format!("\"to\": {{\"junction\": \"tee\"}}, {valve}");
    let text = replaced(
        TOUR,
        &[
            ("\"to\": {\"junction\": \"tee\"}", &closing),
            ("\"length_m\": 0.01}", &format!("\"length_m\": 0.01, {valve}}}")),
        ],
    );
    assert_fault(
        only(&text),
        "/network/junctions/0",
        "\"tee\"",
        "reaches no bladder, accumulator or pressure port at 0.25",
    );
}

#[test]
fn ends_have_one_of_each_pair() {
    let tip = |given: &str| {
        one(&[(
            "\"tip\": \"free\"",
            &format!("\"tip\": {{\"conditions\": {{{given}}}}}"),
        )])
    };
    assert_fault(
        tip("\"u1_m\": 0, \"slope_rad\": 0"),
        "/ends/tip/conditions",
        "\"conditions\"",
        "neither u3_m nor force_z_n",
    );
    assert_fault(
        tip("\"u1_m\": 0, \"slope_rad\": 0, \"moment_n_m\": 1, \"u3_m\": 0"),
        "/ends/tip/conditions/moment_n_m",
        "\"moment_n_m\"",
        "slope_rad and moment_n_m are both given",
    );
    assert_fault(
        tip("\"u1_m\": 0, \"moment_n_m\": 1, \"force_z_n\": 0, \"follower_normal_n\": 1"),
        "/ends/tip/conditions/follower_normal_n",
        "\"follower_normal_n\"",
        "acts on an end whose motion u1_m prescribes",
    );
    let clamped = one(&[("\"tip\": \"free\"", "\"tip\": {\"clamped\": {\"force_x_n\": 1}}")]);
    assert_fault(clamped, "/ends/tip/clamped/force_x_n", "\"force_x_n\"", "unknown key");
}

#[test]
fn motions_do_not_jump_and_agree_with_the_start() {
    let u3 = "{\"sine\": {\"amplitude\": 0.012, \"frequency_hz\": 20}}";
    let at = "/ends/root/clamped/u3_m";
    let step = "{\"ramp\": {\"to\": 0.01, \"start_s\": 0.1, \"duration_s\": 0}}";
    assert_fault(one(&[(u3, step)]), at, step, "jumps from 0 to 0.01 at 0.1 s");
    assert_fault(one(&[(u3, "0.01")]), at, "0.01", "but the start has 0 m");
    let table = "{\"table\": {\"times_s\": [0, 2, 1], \"values\": [0, 1, 2]}}";
    let (pointer, marked, _) = one(&[(u3, table)]);
    assert_eq!((pointer, marked), (format!("{at}/table/times_s/2"), "1".to_owned()));
    let table = "{\"table\": {\"times_s\": [0, 1, 2], \"values\": [0, 1]}}";
    assert_fault(
        one(&[(u3, table)]),
        &format!("{at}/table/values"),
        "[0, 1]",
        "3 times_s but 2 values",
    );
    let opening = "\"ends\": [\"sealed\", \"sealed\"], \"opening\": 1.5";
    assert_fault(
        one(&[("\"ends\": [\"sealed\", \"sealed\"]", opening)]),
        "/network/chains/0/opening",
        "1.5",
        "an opening of 1.5",
    );
}

#[test]
fn what_belongs_together() {
    let start = WIRING.find("  \"fluid\"").unwrap();
    let end = start + WIRING[start..].find('\n').unwrap() + 1;
    let dry = format!("{}{}", &WIRING[..start], &WIRING[end..]);
    assert_fault(only(&dry), "/bladders", "\"bladders\"", "without a fluid");
    assert_fault(
        one(&[("\"closing\": 6.54e-6", "\"closing\": 6.54e-7")]),
        "/bladders/area_per_moment_m2_per_n_m/closing",
        "6.54e-7",
        "smaller than opening",
    );
    assert_fault(
        one(&[("\"width_m\": 0.0078", "\"width_m\": 0.0178")]),
        "/bladders/width_m",
        "0.0178",
        "no room along the beam",
    );
    assert_fault(
        one(&[("\"fields_interval_s\": 0.001", "\"fields_interval_s\": 0.0012")]),
        "/time/fields_interval_s",
        "0.0012",
        "not a multiple",
    );
    assert_fault(
        one(&[("\"window_s\": 0.1", "\"window_s\": 1")]),
        "/time/window_s",
        "1",
        "longer than the run",
    );
    assert_fault(
        one(&[("\"name\": \"wiring-2\"", "\"name\": \"../x\"")]),
        "/name",
        "\"../x\"",
        "a name that a folder cannot have",
    );
}

#[test]
fn tables_from_files() {
    let tour = |from, to| only(&replaced(TOUR, &[(from, to)]));
    let table = "/loads/0/force_x_n_m/signal/table";
    assert_fault(
        tour("\"force [N/m]\"", "\"force\""),
        &format!("{table}/value_column"),
        "\"force\"",
        "no column \"force\"",
    );
    assert_fault(
        tour("network-tour.csv", "nowhere.csv"),
        &format!("{table}/csv"),
        "\"nowhere.csv\"",
        "cannot read",
    );
}
