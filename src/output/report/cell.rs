//! The cells of a case's sections under each of their four loads, and the outlines of bladders.

use serde_json::{Value, json};
use slcbeam_section::cell::bladders;
use slcbeam_section::coefficients::Options;
use slcbeam_section::geometry::outline::Outline;
use slcbeam_section::input::Section;
use slcbeam_section::picture::Picture;

use super::base64;
use crate::case::Case;
use crate::output::numbers::significant;
use crate::output::plot::cell;

const LOADS: [(&str, &str); 4] = [
    ("Normal force", "N"),
    ("Bending moment", "N m"),
    ("Pressure, upper row", "Pa"),
    ("Pressure, lower row", "Pa"),
];

/// Largest number of sections with pictures.
const MOST: usize = 4;

/// Pictures of the section of a case and of the first other ones of its spans.
pub fn of_case(case: &Case) -> Vec<Value> {
    let mut all: Vec<(String, &Section)> = case.section.iter().map(|own| (String::new(), own)).collect();
    for (k, span) in case.spans.iter().enumerate() {
        let new = |own: &&Section| all.iter().all(|(_, known)| known != own);
        if let Some(own) = span.section.as_ref().filter(new) {
            all.push((format!(", /spans/{k}"), own));
        }
    }
    let shown = all.iter().take(MOST);
    shown.flat_map(|(at, section)| pictures(section, at)).collect()
}

/// One picture for each load that moves the cell, with an ending of their titles; empty if the cell cannot be solved.
fn pictures(section: &Section, ending: &str) -> Vec<Value> {
    let options = Options {
        meshes: 2,
        ..Options::default()
    };
    let Ok(found) = section.picture(&options) else {
        return vec![];
    };
    let one = |(load, (name, unit)): (usize, (&str, &str))| {
        let (factor, drawn) = cell::draw(&found, load)?;
        Some(json!({
            "title": format!("{name}{ending}"),
            "picture": base64::svg(drawn.as_bytes()),
            "about": format!("1 {unit}, displacements × {}", significant(factor, 1)),
            "nodes": base64::numbers(nodes(&found, load)),
        }))
    };
    LOADS.into_iter().enumerate().filter_map(one).collect()
}

/// Place and displacement of each node, both along and high [m].
fn nodes(found: &Picture, load: usize) -> impl Iterator<Item = f64> {
    let moved = found.displacements_m.get(load).into_iter().flatten();
    found
        .nodes_m
        .iter()
        .zip(moved)
        .flat_map(|(place, u)| [place[0], place[1], u[0], u[1]])
}

/// Outlines of an upper and a lower bladder about the middle of a pitch on the mid-plane, points `[along, high]` [m].
pub fn outlines(section: &Section) -> Option<[Vec<[f64; 2]>; 2]> {
    let [upper, lower] = bladders(section).map(|outline| outline.as_ref().map(Outline::chords));
    Some([upper?, lower?])
}
