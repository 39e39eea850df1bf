//! Whatever the file holds: an answer, never a panic.

use std::path::Path;

use proptest::prelude::*;
use slcbeam::case;
use slcbeam::error::{Error, Result};

const CASES: [&str; 3] = [
    include_str!("../../cases/network-tour.json"),
    include_str!("../../cases/wiring-3.json"),
    include_str!("../../cases/roll-up.json"),
];

/// Reads, renders, and looks that every fault has a place.
fn read(text: &str, sets: &[String]) -> Result<()> {
    let answer = case::parse(text, Path::new("x.json"), Path::new("cases"), sets);
    if let Err(Error::Case(fault)) = &answer {
        assert!(!fault.violations.is_empty());
        assert!(fault.violations.iter().all(|violation| violation.span.is_some()));
        let _ = case::render(fault, true, 80);
    }
    answer.map(drop)
}

fn pointers(value: &serde_json::Value, at: &str, out: &mut Vec<String>) {
    out.push(at.to_owned());
    match value {
        serde_json::Value::Array(items) => {
            items
                .iter()
                .enumerate()
                .for_each(|(i, item)| pointers(item, &format!("{at}/{i}"), out));
        }
        serde_json::Value::Object(members) => {
            members
                .iter()
                .for_each(|(key, item)| pointers(item, &format!("{at}/{key}"), out));
        }
        _ => {}
    }
}

fn odd_value() -> impl Strategy<Value = String> {
    prop_oneof![
        Just("null".to_owned()),
        Just("true".to_owned()),
        Just("{}".to_owned()),
        Just("[]".to_owned()),
        Just("[[1]]".to_owned()),
        Just("{\"sine\": 3}".to_owned()),
        Just("\"free\"".to_owned()),
        any::<i64>().prop_map(|n| n.to_string()),
        (-400..400i32).prop_map(|e| format!("-1e{e}")),
        (-300..300i32).prop_map(|e| format!("3e{e}")),
        any::<f64>().prop_map(|x| format!("{x:e}")),
        "[a-z_\"]{0,12}".prop_map(|text| serde_json::Value::from(text).to_string()),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, ..ProptestConfig::default() })]

    #[test]
    fn random_text(text in "\\PC*") {
        let _ = read(&text, &[]);
    }

    #[test]
    fn random_json_like_text(text in "[\\[\\]{}:,\"\\\\a-e0-9.+\\- \n]{0,80}") {
        let _ = read(&text, &[]);
    }

    #[test]
    fn a_case_with_some_bytes_changed(
        which in 0..CASES.len(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4),
    ) {
        let mut bytes = CASES[which].as_bytes().to_vec();
        for (place, byte) in changes {
            let i = place.index(bytes.len());
            bytes[i] = byte;
        }
        let _ = read(&String::from_utf8_lossy(&bytes), &[]);
    }

    #[test]
    fn a_case_with_a_part_left_out(which in 0..CASES.len(), from in any::<prop::sample::Index>(), length in 1..200usize) {
        let text = CASES[which];
        let start = from.index(text.len());
        let _ = read(&format!("{}{}", &text[..start], &text[(start + length).min(text.len())..]), &[]);
    }

    #[test]
    fn a_case_with_a_value_exchanged(which in 0..CASES.len(), place in any::<prop::sample::Index>(), odd in odd_value()) {
        let mut all = vec![];
        pointers(&serde_json::from_str(CASES[which]).unwrap(), "", &mut all);
        let pointer = &all[place.index(all.len())];
        let _ = read(CASES[which], &[format!("{pointer}={odd}")]);
    }
}

#[test]
fn random_bytes_in_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.json");
    let mut state = 1u64;
    for length in 0..300 {
        let mut next = || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 33) as u8
        };
        let bytes: Vec<u8> = (0..length).map(|_| next()).collect();
        std::fs::write(&path, &bytes).unwrap();
        assert!(case::load(&path, &[]).is_err());
    }
}
