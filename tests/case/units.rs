//! Units in cases: headings of tables that a case names, and keys with another unit than the case has.

use std::path::Path;

use crate::faulty::WIRING;
use slcbeam::case;
use slcbeam::error::Error;

/// Goal: a table of a file is read in the units of its headings, which must be of what its key is; without any in SI units. Before, all was
/// taken for SI units: 60 kPa for 60 Pa, milliseconds for seconds, a flow for a pressure.
#[test]
fn tables_from_files_are_in_the_units_of_their_headings() {
    let dir = tempfile::tempdir().unwrap();
    let read = |at: &str, text: &str, more: &str| {
        std::fs::write(dir.path().join("mine.csv"), text).unwrap();
        let table = format!(r#"{{"table": {{"csv": "mine.csv"{more}}}}}"#);
        case::parse(
            WIRING,
            Path::new("good.json"),
            dir.path(),
            &[at.replace("TABLE", &table)],
        )
    };
    let pump = r#"/network/chains/1/ends/0={"pressure_pa": TABLE}"#;
    let times_product = r#"/network/chains/1/ends/0={"pressure_pa": {"product": [TABLE, 1]}}"#;
    let syringe = r#"/network/chains/1/ends/0={"volume_m3": TABLE}"#;
    let valve = r#"/network/chains/1/opening=TABLE"#;
    let load = r#"/loads=[{"force_x_n_m": {"signal": TABLE}}]"#;
    for (at, text, more, values) in [
        (pump, "t_s,p_kpa\n0,0\n0.5,60\n", "", [0.0, 60e3]),
        (pump, "t [ms]; p (kPa)\n0; 0\n500; 60\n", "", [0.0, 60e3]),
        (
            pump,
            "t_ms\tx\tp_mbar\n0\t9\t0\n500\t9\t600\n",
            r#", "value_column": "p_mbar""#,
            [0.0, 60e3],
        ),
        (pump, "time,pressure_in\n0,0\n0.5,60000\n", "", [0.0, 60e3]),
        (pump, "t,p\n0,0\n0.5,60000\n", "", [0.0, 60e3]),
        (pump, "t in ms,p in kPa\n0,0\n500,60\n", "", [0.0, 60e3]),
        (pump, "t ms,p kpa\n0,0\n500,60\n", "", [0.0, 60e3]),
        (pump, "\"t, ms\",p / kPa\n0,0\n500,60\n", "", [0.0, 60e3]),
        (pump, "t {ms},p-kPa\n0,0\n500,60\n", "", [0.0, 60e3]),
        (times_product, "t_s,share_percent\n0,0\n0.5,50\n", "", [0.0, 0.5]),
        (syringe, "t_ms,volume_ml\n0,0\n500,2\n", "", [0.0, 2e-6]),
        (valve, "t_s,opening [%]\n0,0\n0.5,40\n", "", [0.0, 0.4]),
        (load, "t_s,q_n_mm\n0,0\n0.5,0.002\n", "", [0.0, 2.0]),
    ] {
        let case = read(at, text, more).unwrap_or_else(|e| panic!("{text}: {e:?}"));
        let all: serde_json::Value = serde_json::from_str(&case.resolved_json()).unwrap();
        let (pointer, shape) = at.split_once('=').unwrap();
        let within = if shape.contains("force") || shape.contains("rest") {
            "/0"
        } else {
            ""
        };
        let inner = all.pointer(&format!("{pointer}{within}")).unwrap().to_string();
        let near = |key: &str, wanted: [f64; 2]| {
            let found = inner
                .split(&format!("\"{key}\":["))
                .nth(1)
                .unwrap()
                .split(']')
                .next()
                .unwrap();
            let found: Vec<f64> = found.split(',').map(|x| x.parse().unwrap()).collect();
            assert!(
                (0..2).all(|k| (found[k] - wanted[k]).abs() <= 1e-12 * wanted[k]),
                "{text}: {found:?}"
            );
        };
        near("times_s", [0.0, 0.5]);
        near("values", values);
    }
    for (at, text, what, hint) in [
        (
            pump,
            "t_s,flow_ml_s\n0,0\n1,1\n",
            "the column flow_ml_s is in ml/s, but pressure_pa is in Pa, kPa",
            "",
        ),
        (
            pump,
            "t_mm,p_kpa\n0,0\n1,1\n",
            "the column t_mm is in mm, but time is in s, ms",
            "",
        ),
        (
            pump,
            "t_s,p_inhg\n0,0\n1,1\n",
            "the unit inhg at the end of p_inhg is not known",
            "",
        ),
        (pump, "t_s,p [atm]\n0,0\n1,1\n", "the unit [atm] of the column", ""),
        (
            pump,
            "t in ms,p in mPa\n0,0\n1,1\n",
            "the unit mPa at the end of p in mPa is not known; units of pressure_pa are Pa, kPa",
            "",
        ),
        (valve, "t_s,opening_mm\n0,0\n1,1\n", "but opening is in no unit", ""),
        (
            times_product,
            "t_s,share_ml\n0,0\n1,1\n",
            "is in ml, but pressure_pa",
            "",
        ),
        (
            pump,
            "t_s;p_kpa\n0;0\n0,5;1,5\n",
            "line 3: \"0,5\" is not a number",
            "write decimals with a point",
        ),
    ] {
        let Error::Case(fault) = read(at, text, "").expect_err(text) else {
            panic!("{text}")
        };
        let [found] = &fault.violations[..] else {
            panic!("{text}")
        };
        assert!(
            found.what.contains(what) && found.pointer.ends_with("/table/csv"),
            "{}",
            found.what
        );
        assert_eq!(found.hint.as_deref().unwrap_or_default(), hint, "{text}");
    }
}

/// Goal: a pressure, flow or volume of an end in another unit is told with its number; what is set besides a key that is there, too. Before, the key
/// alone was named: to follow it was a factor of a thousand.
#[test]
fn forms_and_what_is_set_are_told_with_their_factor() {
    let of = |set: &str| match case::parse(WIRING, Path::new("good.json"), Path::new("cases"), &[set.into()]) {
        Err(Error::Case(fault)) => {
            let [found] = &fault.violations[..] else {
                panic!("{}", case::render(&fault, false, 100))
            };
            (
                found.nearest.clone().unwrap_or_default(),
                found.hint.clone().unwrap_or_default(),
            )
        }
        other => panic!("{set}: {:?}", other.err()),
    };
    for (set, meant, hint) in [
        (
            r#"/network/chains/1/ends/0={"pressure_kpa": 60}"#,
            "pressure_pa",
            r#"write "pressure_pa": 60000, which is 60 kPa"#,
        ),
        (
            r#"/network/chains/1/ends/0={"pressure_bar": 2}"#,
            "pressure_pa",
            r#"write "pressure_pa": 200000, which is 2 bar"#,
        ),
        (
            r#"/network/chains/1/ends/0={"flow_ml_min": 6}"#,
            "flow_m3_s",
            r#"write "flow_m3_s": 1e-7, which is 6 ml/min"#,
        ),
        (
            r#"/network/chains/1/ends/0={"volume_ml": 2}"#,
            "volume_m3",
            r#"write "volume_m3": 2e-6, which is 2 ml"#,
        ),
        (
            "/fluid/viscosity_cp=300",
            "viscosity_pa_s",
            r#"write "viscosity_pa_s": 0.3, which is 300 cP"#,
        ),
        ("/fluid/viscosity=300", "viscosity_pa_s", ""),
        (
            r#"/ends/root={"clamped": {"angle_deg": 180}}"#,
            "slope_rad",
            r#"write "slope_rad": 3.14159265359, which is 180 deg"#,
        ),
    ] {
        assert_eq!(of(set), (meant.to_owned(), hint.to_owned()), "{set}");
    }
}
