//! The cell of a case's section under each of its four loads, and the outlines of its bladders.

use serde_json::{Value, json};
use slcbeam_section::cell::bladders;
use slcbeam_section::coefficients::Options;
use slcbeam_section::geometry::outline::Outline;
use slcbeam_section::input::Section;

use super::base64;
use crate::output::numbers::significant;
use crate::output::plot::cell;

const LOADS: [(&str, &str); 4] = [
    ("Normal force", "N"),
    ("Bending moment", "N m"),
    ("Pressure, upper row", "Pa"),
    ("Pressure, lower row", "Pa"),
];

/// One picture for each load that moves the cell; empty if the cell cannot be solved.
pub fn pictures(section: &Section) -> Vec<Value> {
    let options = Options {
        meshes: 2,
        ..Options::default()
    };
    let Ok(found) = section.picture(&options) else {
        return vec![];
    };
    let one = |(load, (name, unit)): (usize, (&str, &str))| {
        let drawn = cell::draw(&found, load)?;
        Some(json!({
            "title": name,
            "picture": base64::image("image/svg+xml", drawn.svg.as_bytes()),
            "about": format!("1 {unit}, displacements × {}", significant(drawn.factor, 1)),
        }))
    };
    LOADS.into_iter().enumerate().filter_map(one).collect()
}

/// Outlines of an upper and a lower bladder about the middle of a pitch on the mid-plane, points `[along, high]` [m].
pub fn outlines(section: &Section) -> Option<[Vec<[f64; 2]>; 2]> {
    let [upper, lower] = bladders(section).map(|outline| outline.as_ref().map(Outline::chords));
    Some([upper?, lower?])
}
