//! What does not fit together is told before anything is computed, and nothing is written.

use crate::common::*;

#[test]
fn what_makes_no_sense_is_refused() {
    let dir = tempfile::tempdir().expect("a folder");
    let out = path(&dir, "out");
    let young = ["--vary", "/beam/young_modulus_pa=1e6:1e7"];
    let tip = ["--maximize", "tip_u1_m"];
    let with = |parts: &[&[&'static str]]| parts.concat();
    for (asked, code, words) in [
        (tip.to_vec(), 2, "no number to vary: give --vary POINTER=LOW:HIGH"),
        (young.to_vec(), 2, "--maximize"),
        (
            with(&[&young, &tip, &["--choose", "/beam/young_modulus_pa=1e6|2e6"]]),
            2,
            "must be of different parts",
        ),
        (
            with(&[&young, &tip, &["--minimize", "tip_u3_m"]]),
            2,
            "cannot be used with",
        ),
        (with(&[&young, &["--maximize", "tip_u1"]]), 2, "nearest is tip_u1_m"),
        (
            with(&[&young, &["--maximize", "harvested_power_w"]]),
            2,
            "`run` computes no such figure",
        ),
        (
            with(&[&young, &tip, &["--subject-to", "tip_u3_m=1"]]),
            2,
            "expected a figure and its limit",
        ),
        (
            with(&[&young, &tip, &["--subject-to", "tip_u3<=1"]]),
            2,
            "nearest is tip_u3_m",
        ),
        (
            with(&[
                &young,
                &tip,
                &["--subject-to", "tip_u3_m>=2", "--subject-to", "tip_u3_m<=1"],
            ]),
            2,
            "tip_u3_m.max_abs cannot be at least 2 and at most 1",
        ),
        (
            with(&[&["--vary", "/beam/young_modulus_pa=1e7:1e6"], &tip]),
            2,
            "is not below",
        ),
        (with(&[&["--vary", "/beam/young=1:2"], &tip]), 2, "nearest is /beam/"),
        (
            with(&[&["--vary", "/bladders/per_row=1:2"], &tip]),
            2,
            "a count has no derivative",
        ),
        (
            with(&[&["--vary", "/solver/rtol=1e-6:1e-4"], &tip]),
            2,
            "not a part of the model",
        ),
        (with(&[&["--vary", "/beam/length_m=-1:1"], &tip]), 3, "length_m"),
        (with(&[&young, &young, &tip]), 2, "set the same number"),
        (with(&[&young, &tip, &["--starts", "0"]]), 2, "--starts"),
        (
            with(&[&tip, &["--choose", "/beam/young_modulus_pa=1e6|much"]]),
            2,
            "--choose '/beam/young_modulus_pa=much'",
        ),
        (
            with(&[&tip, &["--choose", "/beam/young_modulus_pa=1e6|2e6|1000000"]]),
            2,
            "1000000 is given twice",
        ),
        (
            with(&[&tip, &["--choose", "/beam/young_modulus_pa=1e6|-1e6"]]),
            3,
            "--> --choose at /beam/young_modulus_pa",
        ),
    ] {
        let case = "cases/two-bladders.json";
        let said = say(&[&["optimize", case, "--out", &out, "--quiet"], &asked[..]].concat());
        // however the terminal breaks lines
        let plain = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(said.code, code, "{asked:?}: {plain}");
        assert!(plain.contains(words), "{asked:?}: {plain}");
        assert!(!dir.path().join("out").exists(), "{asked:?}: something was written");
    }
}

/// Goal: a case without an answer is a matter of the solver, exit code 4, as with the command itself: a pump that fills what nothing empties.
#[test]
fn a_start_that_cannot_be_computed_is_the_solvers() {
    let dir = tempfile::tempdir().expect("a folder");
    let out = path(&dir, "out");
    let fed = "/network/chains/1/ends=[{\"flow_m3_s\": 1e-7}, \"sealed\"]";
    let sets = ["--set", fed, "--set", "/start={}"];
    let asked = [
        "--vary",
        "/beam/young_modulus_pa=1e6:1e7",
        "--maximize",
        "tip_u1_m",
        "--command",
        "equilibrium",
    ];
    let own = say(&[&["equilibrium", "cases/pluck.json", "--out", &out], &sets[..]].concat());
    let said = say(&[
        &["optimize", "cases/pluck.json", "--out", &out, "--quiet"],
        &sets[..],
        &asked,
    ]
    .concat());
    assert_eq!((own.code, said.code), (4, 4), "{}", said.err);
    assert!(said.err.contains("the designs at all starts fail"), "{}", said.err);
}
