//! References of the scenes of every test run, found once with time to spare: what they cost is not spent again, and a change
//! of the program cannot move both sides of the comparison.

use std::collections::BTreeMap;
use std::fs;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::reference::Found;
use crate::scene::Kind;

/// Where they are.
const FILE: &str = "tests/adversary/references.json";

/// The reference of a scene, and which scene that is.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Stored {
    scene: String,
    /// What was found; nothing for a scene that is refused.
    pub found: Option<Found>,
}

/// All of them by name.
pub type All = BTreeMap<String, Stored>;

/// Reads the file.
pub fn read() -> All {
    let text = fs::read_to_string(FILE).unwrap_or_default();
    serde_json::from_str(&text).unwrap_or_default()
}

/// Writes the file, a line a scene.
pub fn write(all: &All) {
    let line = |(name, one): (&String, &Stored)| {
        format!(
            "{}: {}",
            Value::from(name.as_str()),
            serde_json::to_string(one).expect("JSON")
        )
    };
    let lines: Vec<String> = all.iter().map(line).collect();
    fs::write(FILE, format!("{{\n{}\n}}\n", lines.join(",\n"))).expect("the references");
}

/// The reference for a scene as it is drawn now.
pub fn of<'a>(all: &'a All, kind: Kind, seed: u64, scene: &Value) -> Option<&'a Stored> {
    all.get(&crate::tally::name(kind, seed))
        .filter(|one| one.scene == mark(scene))
}

/// A reference to keep.
pub fn keep(scene: &Value, found: Option<Found>) -> Stored {
    Stored {
        scene: mark(scene),
        found,
    }
}

/// A number that another scene does not have (FNV-1a of its text).
fn mark(scene: &Value) -> String {
    let text = scene.to_string();
    let step = |h: u64, b: u8| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01B3);
    format!("{:016x}", text.bytes().fold(0xCBF2_9CE4_8422_2325, step))
}
