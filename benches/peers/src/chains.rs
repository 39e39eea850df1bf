//! Long beams with many bladders: segments of the paper in any number, with several wirings.

use slcbeam::case::{self, Case};

use crate::random::Random;

/// Text of `/network` for `per_row` bladders per row.
fn network(wiring: &str, per_row: usize) -> String {
    let n = per_row as i64;
    let row = |sign: i64| {
        let all: Vec<String> = (1..=n).map(|k| (sign * k).to_string()).collect();
        all.join(",")
    };
    let tube = |from: i64, out: &str, to: i64, into: &str| {
        format!(r#"{{"from":{{"bladder":{from},"end":"{out}"}},"to":{{"bladder":{to},"end":"{into}"}}}}"#)
    };
    let chain = |sign: i64, ends: &str| format!(r#"{{"bladders":[{}],"ends":[{ends}]}}"#, row(sign));
    let (sealed, joined) = (r#""sealed","sealed""#, r#""connected","connected""#);
    let at_root = r#""connected","sealed""#;
    let (chains, tubes) = match wiring {
        "chain" => (vec![chain(1, sealed)], vec![]),
        "ring" => (
            vec![chain(1, joined), chain(-1, joined)],
            vec![tube(1, "inlet", -1, "inlet"), tube(n, "outlet", -n, "outlet")],
        ),
        "ladder" => (
            vec![chain(1, at_root), chain(-1, at_root)],
            (1..=n).map(|k| tube(k, "inlet", -k, "inlet")).collect(),
        ),
        "tree" => (vec![], (2..=n).map(|k| tube(k / 2, "outlet", k, "inlet")).collect()),
        "random" => {
            let mut random = Random(1);
            let mut any = || 2 + ((random.bits() >> 33) % (per_row as u64 - 2)) as i64;
            let long = (0..per_row / 5).filter_map(|_| {
                let (a, b) = (any(), any());
                (a != b).then(|| tube(a, "outlet", b, "inlet"))
            });
            (vec![chain(1, sealed), chain(-1, sealed)], long.collect())
        }
        other => panic!("no wiring {other}"),
    };
    format!(r#"{{"chains":[{}],"tubes":[{}]}}"#, chains.join(","), tubes.join(","))
}

/// A beam of `per_row` segments like those of the paper, each 8 mm long. Its root shakes with 0.1 mm at 20 Hz after a smooth start.
pub fn case(wiring: &str, per_row: usize) -> Case {
    let text = format!(
        r#"{{"name":"{wiring}-{per_row}","preset":"matia-gat-beam","plausibility":"off","beam":{{"length_m":{}}},
        "bladders":{{"per_row":{per_row}}},"network":{},"formulation":"conservative",
        "ends":{{"root":{{"clamped":{{"u1_m":{{"sine":{{"amplitude":1e-4,"frequency_hz":20,"ramp_cycles":1}}}}}}}},"tip":"free"}},
        "effects":{{"rotary_inertia":"off","finite_rotation":"on","axial_stretch":"on","axial_inertia":"on","network_pressure_differences":"on","flow_along_bladders":"on","flow":"on","tube_inertia":"off","tube_losses":"off"}},
        "mesh":{{"cells_per_segment":4,"cells_per_bladder":2}},"time":{{"end_s":0.2,"output_interval_s":0.001}}}}"#,
        0.008 * per_row as f64,
        network(wiring, per_row),
    );
    let here = std::path::Path::new("chain.json");
    case::parse(&text, here, std::path::Path::new("."), &[]).unwrap_or_else(|e| panic!("{wiring}: {e}"))
}
