//! Drawing of a structure: its beams at their places, and its joints.

use serde_json::{Value, json};

use super::scene::{end, load, q};
use crate::case::Case;
use crate::case::schema::{End, Hinge, JointKind};
use crate::case::structure::{self, Place};
use crate::case::wiring::BladderLabels;
use crate::output::numbers::counted;

/// Adds beams and joints of a structure to the drawing of its case. A place along a beam is counted over all beams, one after the other:
/// that of its root is `from` [m].
pub fn add(scene: &mut Value, case: &Case) {
    let end_s = case.time.end_s;
    let (pieces, joints) = structure::pieces(case);
    let lengths: Vec<f64> = case.beams.iter().map(|beam| beam.length_m.unwrap_or(0.0)).collect();
    let from = |beam: usize| lengths[..beam].iter().sum::<f64>() + 0.0;
    let joined = |beam: usize, at_tip: bool| {
        let own = |k: &usize| pieces[k / 2].beam == beam && (k % 2 == 1) == at_tip && pieces[k / 2].at_end[k % 2];
        joints.iter().flatten().flat_map(Place::ends).any(own)
    };
    let condition = |beam: usize, k: usize| {
        let given = case.beams[beam].ends.both()[k];
        let free = End::Free(Default::default());
        let form = given.map_or("free", |given| given.form().0);
        let form = if joined(beam, k == 1) { "joined" } else { form };
        end(&given.unwrap_or(&free).resolve(), form, end_s)
    };
    let beams = case.beams.iter().enumerate().map(|(k, beam)| {
        let first = pieces.iter().find(|piece| piece.beam == k);
        let (origin, angle) = first.map_or_else(Default::default, |piece| (piece.origin, piece.angle));
        json!({
            "name": beam.name, "from": from(k), "length": lengths[k], "x": origin.x, "z": origin.z, "angle": angle,
            "ends": [condition(k, 0), condition(k, 1)],
            "loads": beam.loads.iter().map(|one| load(one, end_s)).collect::<Vec<_>>(),
        })
    });
    let of_joints = case.joints.iter().zip(&joints).map(|(joint, places)| {
        let at = places.iter().map(|place| {
            let k = place.ends()[0];
            let piece = &pieces[k / 2];
            let along = piece.from + if k % 2 == 1 { piece.length } else { 0.0 };
            let end = piece.end(k % 2 == 1);
            // nodes of the place, as parts and their ends
            json!({"along": from(piece.beam) + along, "x": end.x, "z": end.z, "part": k / 2, "tip": k % 2 == 1})
        });
        let (kind, words) = match &joint.kind {
            JointKind::Rigid(_) => ("rigid", "rigid joint".to_owned()),
            JointKind::Hinge(hinge) => ("hinge", of_hinge(hinge)),
            JointKind::Elastic(_) => ("elastic", "elastic joint".to_owned()),
            JointKind::Slider(slider) => {
                let angle = q(slider.angle_rad, "rad");
                ("slider", format!("slider, along a slot at {angle} to the first beam"))
            }
        };
        let body = match joint.mass_kg > 0.0 {
            true => format!(", with a body of {}", q(joint.mass_kg, "kg")),
            false => String::new(),
        };
        json!({"kind": kind, "at": at.collect::<Vec<_>>(), "words": format!("{}: {words}{body}", joint.at.join(" and "))})
    });
    scene["beams"] = beams.collect();
    scene["joints"] = of_joints.collect();
    scene["ends"] = json!([]);
    scene["size"] = format!(
        "{}, {} long in all, {} high, {} wide",
        counted(case.beams.len() as u64, "beam"),
        q(lengths.iter().sum(), "m"),
        q(scene["height"].as_f64().unwrap_or_default(), "m"),
        q(case.beam.width_m, "m")
    )
    .into();
    if scene["bladders"].is_object() {
        let labels = BladderLabels::from_case(case);
        scene["bladders"]["labels"] = (0..2 * labels.per_row).map(|b| labels.label(b)).collect();
    }
}

fn of_hinge(hinge: &Hinge) -> String {
    let parts = [
        (hinge.stiffness_n_m_rad, "spring", "N m/rad"),
        (hinge.damping_n_m_s_rad, "damper", "N m s/rad"),
    ];
    let parts = parts.iter().filter(|(size, ..)| *size != 0.0);
    let mut words: Vec<String> = parts
        .map(|(size, name, unit)| format!("{name} {}", q(*size, unit)))
        .collect();
    if let Some(stop) = &hinge.stop {
        words.push(format!(
            "free from {} to {}",
            q(stop.from_rad, "rad"),
            q(stop.to_rad, "rad")
        ));
    }
    match words.is_empty() {
        true => "hinge".to_owned(),
        false => format!("hinge, {}", words.join(", ")),
    }
}
