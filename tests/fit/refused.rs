//! What does not fit together is told before anything is computed, and nothing is written.

use slcbeam::study::data::DataTable;
use slcbeam::study::fit::left_alone;

use crate::common::*;

const CASE: &str = "cases/two-bladders.json";
const VARY: &str = "/tubes/permeability_m4=1e-13:1e-11";

/// Goal: bounds that no case can take are refused before anything is computed, of runs and of equilibria.
#[test]
fn bounds_that_no_case_takes() {
    let run = "t_s,u_mm\n0.0005,1\n0.001,1\n0.0015,1\n";
    let rest = "p_kpa,u_mm\n1,1\n2,2\n3,3\n";
    let drive = ["--drive", "p_kpa=/start/pressures/0/pressure_pa"];
    for (bounds, key) in [
        ("/beam/young_modulus_pa=-1e6:1e7", "young_modulus_pa"),
        ("/beam/length_m=-1:1", "length_m"),
        ("/tubes/permeability_m4=-1e-13:1e-11", "permeability_m4"),
    ] {
        for (text, more) in [(run, &[][..]), (rest, &drive)] {
            let asked = [&["--vary", bounds, "--match", "u_mm=tip_u1"], more].concat();
            let (code, told) = refused(text, &asked);
            assert!(code == 3 && told.contains(key), "{bounds}: {code}: {told}");
        }
    }
}

/// Says what is wrong with a table and options besides; the exit code and the words.
fn refused(text: &str, more: &[&str]) -> (i32, String) {
    let dir = tempfile::tempdir().expect("a folder");
    let data = file(&dir, "data.csv", text);
    let out = path(&dir, "out");
    let said = say(&[&["fit", CASE, &data, "--out", &out, "--quiet"], more].concat());
    assert!(!dir.path().join("out").exists(), "something was written: {}", said.err);
    // however the terminal breaks lines
    let plain = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
    (said.code, plain)
}

#[test]
fn data_and_options_that_do_not_go_together() {
    let good = "t_s,u_mm,p_kpa\n0.0005,1,2\n0.001,1,2\n0.0015,1,2\n";
    let vary = ["--vary", VARY];
    let tip = ["--vary", VARY, "--match", "u_mm=tip_u1"];
    let with = |more: &[&'static str]| [&tip[..], more].concat();
    for (text, asked, code, words) in [
        ("", tip.to_vec(), 3, "no headings"),
        ("t_s,u_mm\n", tip.to_vec(), 3, "no rows below the headings"),
        ("t_s,u_mm\n0.001,\n", tip.to_vec(), 2, "contains no number"),
        (
            "t_s,u_mm\n0.001,much\n",
            tip.to_vec(),
            3,
            "line 2, column u_mm: \"much\" is not a finite number",
        ),
        (
            "t_s,u_mm\n0.001,1\n0.0005,2\n",
            tip.to_vec(),
            3,
            "line 3, column t_s: 0.0005 s is not later than 0.001 s",
        ),
        (
            "t_s,u_mm\n0.001,1\n0.5,2\n",
            tip.to_vec(),
            3,
            "0.5 s is after the end of the run at 0.002 s",
        ),
        (
            "t_s,u_mm,u_mm\n0.001,1,2\n",
            tip.to_vec(),
            3,
            "a second column named u_mm",
        ),
        ("u_mm\n1\n2\n3\n", tip.to_vec(), 2, "has no column t_s or time_s"),
        (
            "t_s,u_mm\n0.001,1\n",
            tip.to_vec(),
            2,
            "1 measured value cannot determine 1 number",
        ),
        (good, vary.to_vec(), 2, "--match COLUMN=QUANTITY"),
        (good, vec!["--match", "u_mm=tip_u1"], 2, "--vary POINTER=LOW:HIGH"),
        (
            good,
            [&vary[..], &["--match", "u_m=tip_u1"]].concat(),
            2,
            "has no column u_m; nearest is u_mm",
        ),
        (
            good,
            [&vary[..], &["--match", "u_mm=tip_u2"]].concat(),
            2,
            "the result has no quantity tip_u2; nearest is tip_u",
        ),
        // where nothing is near, what there is
        (
            good,
            [&vary[..], &["--match", "u_mm=volume_let_in"]].concat(),
            2,
            "the result has no quantity volume_let_in; there are tip_u1, tip_u3",
        ),
        (
            good,
            [&vary[..], &["--match", "u_mm=tip_angle"]].concat(),
            2,
            "the column u_mm is in mm, but tip_angle is in rad, mrad, deg",
        ),
        (
            good,
            [&vary[..], &["--match", "p_kpa=pressure@bladder 7"]].concat(),
            2,
            "there is no bladder 7. The case has bladders 1 (upper row)",
        ),
        (
            good,
            [&vary[..], &["--match", "u_mm=u1@1.5"]].concat(),
            2,
            "1.5 is not a share of the length",
        ),
        (
            good,
            [&vary[..], &["--match", "u_mm=u1@tipp"]].concat(),
            2,
            "the case has no place tipp; nearest is tip",
        ),
        (
            good,
            [&vary[..], &["--match", "u_mm"]].concat(),
            2,
            "expected COLUMN=QUANTITY[@PLACE]",
        ),
        (
            good,
            with(&["--match", "u_mm=tip_u3"]),
            2,
            "the column u_mm is matched twice",
        ),
        (good, with(&["--vary", VARY]), 2, "set the same number"),
        (good, with(&["--time", "when"]), 2, "--time: "),
        (
            good,
            with(&["--noise", "p_kpa=1"]),
            2,
            "the column is not matched to anything",
        ),
        (
            good,
            with(&["--noise", "u_mm=0"]),
            2,
            "the standard deviation must be above 0",
        ),
        (
            good,
            with(&["--command", "equilibrium"]),
            2,
            "needs --drive COLUMN=POINTER",
        ),
        (
            good,
            with(&["--command", "run", "--drive", "p_kpa=/start/pressures/0/pressure_pa"]),
            2,
            "rows of a run are instants",
        ),
        (
            good,
            with(&["--drive", "p_kpa=/start/pressures/0/presure_pa"]),
            2,
            "nearest is /start/pressures/0/pressure_pa",
        ),
        (
            good,
            with(&["--drive", "u_mm=/start/pressures/0/pressure_pa"]),
            2,
            "the column u_mm is in mm, but",
        ),
        // a unit that is not known is refused as in brackets
        (
            "t_s,u_in,u_mm\n0.0005,1,1\n0.001,1,1\n",
            [&vary[..], &["--match", "u_in=tip_u1"]].concat(),
            2,
            "the unit in at the end of u_in is not known; units of tip_u1 are m, cm, mm, um",
        ),
        (
            "t_s,a_degrees\n0.0005,1\n0.001,1\n",
            [&vary[..], &["--match", "a_degrees=tip_angle"]].concat(),
            2,
            "the unit degrees at the end of a_degrees is not known",
        ),
        (
            "t_s,u_mm,u_sd_inch\n0.0005,1,1\n0.001,1,1\n0.0015,1,1\n",
            [&vary[..], &["--match", "u_mm=tip_u1"]].concat(),
            2,
            "the unit inch at the end of u_sd_inch is not known",
        ),
        (
            "p_inhg,u_mm\n1,1\n2,1\n3,1\n",
            with(&["--drive", "p_inhg=/start/pressures/0/pressure_pa"]),
            2,
            "the unit inhg at the end of p_inhg is not known",
        ),
        (
            "l_mm,u_mm\n1,1\n2,1\n3,1\n",
            with(&["--drive", "l_mm=/bladders/area_per_pressure_m2_per_pa"]),
            2,
            "the column l_mm has the unit mm, but the unit of area_per_pressure_m2_per_pa is unknown",
        ),
        (
            good,
            [&vary[..], &["--match", "u_mm=angle"]].concat(),
            2,
            "the result has no quantity angle; nearest is tip_angle",
        ),
        (
            good,
            vec!["--vary", "/tubes/permeability_m4=1e-13,1e-11", "--match", "u_mm=tip_u1"],
            2,
            "POINTER=LOW:HIGH with a colon between the bounds: /tubes/permeability_m4=1e-13:1e-11",
        ),
        (
            good,
            vec!["--vary", "/tubes/permeability_m5=1:2", "--match", "u_mm=tip_u1"],
            2,
            "nearest is /tubes/permeability_m4",
        ),
        (
            good,
            vec!["--vary", "/mesh/cells_per_segment=1:2", "--match", "u_mm=tip_u1"],
            2,
            "is not a part of the model",
        ),
    ] {
        let (got, said) = refused(text, &asked);
        assert!(
            got == code && said.contains(words),
            "{asked:?}\nwanted {code}: {words}\ngot {got}: {said}"
        );
    }
}

/// Goal: columns that say nothing are named: noise under a heading that no column has was passed over without a word.
#[test]
fn columns_that_say_nothing_are_named() {
    let text = "t_s,u_mm,u_mm_sd,v_um,v_mm_sd\n0.0005,1,0.1,2,0.1\n0.001,1,0.1,2,0.1\n";
    let table = DataTable::parse("data.csv".as_ref(), text).expect("a table");
    let asked = by_squares(&[], &["u_mm=tip_u1", "v_um=tip_u3"]);
    assert_eq!(left_alone(&table, &asked), ["v_mm_sd"]);
}

/// Goal: values that no instrument gives are faults of their rows; a fit whose sums are not finite could not be read again.
#[test]
fn absurd_values_are_faults_of_their_rows() {
    let text = "t_s,u_mm\n0.0005,1\n0.001,1e300\n0.0015,1\n";
    let (code, told) = refused(text, &["--vary", VARY, "--match", "u_mm=tip_u1"]);
    assert!(
        code == 3 && told.contains("line 3, column u_mm: 1e300 is too large for a measured value"),
        "{code}: {told}"
    );
}

/// Goal: very many columns, or very long headings, are no long message.
#[test]
fn messages_do_not_list_all_headings() {
    let headings: Vec<String> = (0..20_000).map(|k| format!("column_{k}")).collect();
    let text = format!("t_s,{}\n0.001{}\n", headings.join(","), ",1".repeat(headings.len()));
    let long = format!("t_s,{}\n0.001,1\n", "u".repeat(60_000));
    for text in [text, long] {
        let (code, told) = refused(&text, &["--vary", VARY, "--match", "@@=tip_u1"]);
        assert!(code == 2 && told.len() < 3000, "{code}: {} characters", told.len());
    }
}
