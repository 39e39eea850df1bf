//! Checks of structures: names, joints, and the parts that each beam has by itself.

use std::collections::HashMap;

use super::{attachments, contacts, ends, probes};
use crate::case::faults::{Violations, is_below};
use crate::case::schema::{Case, End, Ends, Formulation, Joint, JointKind, PlacedBeam, Start, StartPressure};
use crate::case::structure::{self, Along, Piece, joined_place};
use crate::case::wording::nearest;
use crate::error::{Code, Violation};
use crate::functions::{Signal, SmoothTime};

/// Distance of joined places relative to the length of a beam that counts as rounding.
const NEAR: f64 = 1e-6;

/// Parts of a beam that are checked as those of a single beam.
const OF_A_BEAM: [&str; 4] = ["ends", "loads", "attachments", "probes"];

pub(super) fn check(case: &Case, faults: &mut Violations) {
    beam_contacts(case, faults);
    if !case.is_structure() {
        if !case.joints.is_empty() {
            let fault = Violation::new(Code::Together, "/joints", "joints without \"beams\"");
            faults.push_at_key(fault.hint("list the beams that they join in /beams"));
        }
        return;
    }
    let known = faults.count();
    names(case, faults);
    misplaced(case, faults);
    joints(case, faults);
    if faults.count() > known {
        return;
    }
    let uncut = Case {
        joints: vec![],
        ..case.clone()
    };
    for (k, piece) in structure::pieces(&uncut).0.iter().enumerate() {
        let mut own = Violations::default();
        let single = piece.case(case);
        for rule in [ends::check, attachments::check, probes::check] {
            rule(&single, &mut own);
        }
        let of_beam = |pointer: &str| OF_A_BEAM.iter().any(|part| is_below(pointer, &format!("/{part}")));
        faults.take_in(own, |pointer| of_beam(pointer).then(|| format!("/beams/{k}{pointer}")));
        no_jumps(k, &case.beams[k], faults);
    }
    places(case, faults);
}

fn beam_contacts(case: &Case, faults: &mut Violations) {
    let mut known = HashMap::new();
    for (k, contact) in case.beam_contacts.iter().enumerate() {
        let pointer = format!("/beam_contacts/{k}");
        contacts::named_once(&mut known, (&contact.name, &pointer), faults);
        contacts::friction(
            &pointer,
            contact.friction_coefficient,
            contact.friction_velocity_m_s,
            faults,
        );
        for (i, name) in contact.between.iter().flatten().enumerate() {
            if !case.is_structure() {
                let fault = Violation::new(Code::Name, format!("{pointer}/between"), "a case without \"beams\"");
                faults.push_at_key(fault.hint("leave \"between\" out: the beam touches itself"));
                break;
            }
            beam_named(case, name, &format!("{pointer}/between/{i}"), faults);
        }
    }
}

fn names(case: &Case, faults: &mut Violations) {
    let good = |c: char| c.is_ascii_alphanumeric() || "-_".contains(c);
    let mut known = HashMap::new();
    for (k, beam) in case.beams.iter().enumerate() {
        let name = &beam.name;
        let mut fault = |what: String| {
            let fault = Violation::new(Code::CaseName, format!("/beams/{k}/name"), what);
            faults.push(fault.allowed("letters, digits, `-` and `_`, a name for each beam"));
        };
        if name.is_empty() || !name.chars().all(good) {
            fault(format!("\"{name}\" cannot begin the name of a quantity"));
        }
        if let Some(first) = known.insert(name, k) {
            fault(format!(
                "two beams have the name \"{name}\", the first is /beams/{first}"
            ));
        }
        let beside = [
            ("rows", beam.rows.is_some()),
            ("beam", beam.beam.is_some()),
            ("bladders", beam.bladders.is_some()),
        ];
        for (key, _) in beside.iter().filter(|(_, given)| *given && !beam.spans.is_empty()) {
            let fault = Violation::new(
                Code::Together,
                format!("/beams/{k}/{key}"),
                format!("\"{key}\" beside \"spans\""),
            );
            faults.push_at_key(fault.hint("give it in each of the spans"));
        }
        if let Some(j) = beam.spans.iter().position(|span| span.section.is_some()) {
            let what = "a section in a span of a structure";
            let fault = Violation::new(Code::Together, format!("/beams/{k}/spans/{j}/section"), what);
            faults.push_at_key(fault.hint(
                "give its coefficients, as `slcbeam coefficients` prints them, or one section for all beams in /section",
            ));
        }
    }
}

/// Reports parts of the case that belong to a beam, and those that a structure does not have.
fn misplaced(case: &Case, faults: &mut Violations) {
    let start = Start {
        pressures: Vec::<StartPressure>::new(),
        equilibrium: None,
        ..case.start.clone()
    };
    let of_beams = [
        ("attachments", !case.attachments.is_empty()),
        ("probes", !case.probes.is_empty()),
        ("ends", case.ends != Ends::default()),
    ];
    for (key, _) in of_beams.iter().filter(|(_, given)| *given) {
        let what = format!("\"{key}\" of a case with several beams");
        let fault = Violation::new(Code::Together, format!("/{key}"), what);
        faults.push_at_key(fault.hint(format!("give them in the beam that they belong to: /beams/0/{key}")));
    }
    let missing = [
        ("foundation", case.foundation.is_some(), "attach springs to the beams"),
        (
            "surroundings",
            case.surroundings.is_some(),
            "use /beam/damping/drag_n_s_m2",
        ),
        ("rotating_frame", case.rotating_frame.is_some(), "turn the supports"),
        (
            "step_response",
            case.step_response.is_some(),
            "read it from the history",
        ),
        (
            "start",
            start != Start::default(),
            "start with \"equilibrium\", or give \"pressures\" only",
        ),
        (
            "formulation",
            case.formulation == Formulation::Published,
            "use the conservative form",
        ),
        ("mesh/order", case.mesh.order == Some(4), "use more cells of order 2"),
    ];
    for (key, _, hint) in missing.iter().filter(|(_, given, _)| *given) {
        let what = match *key {
            "start" => "displacements or velocities at the start of a structure".to_owned(),
            "formulation" => "the published form of a structure".to_owned(),
            "mesh/order" => "a mesh of fourth order of a structure".to_owned(),
            key => format!("\"{key}\" of a structure"),
        };
        let fault = Violation::new(Code::Together, format!("/{key}"), what);
        faults.push_at_key(fault.hint(format!("it is for single beams; {hint}")));
    }
}

fn joints(case: &Case, faults: &mut Violations) {
    let mut joined: HashMap<(usize, usize), String> = HashMap::new();
    for (j, joint) in case.joints.iter().enumerate() {
        if joint.at.len() < 2 {
            let fault = Violation::new(Code::Count, format!("/joints/{j}/at"), "a joint of one place");
            faults.push(
                fault
                    .allowed("two places or more")
                    .hint("a support is a condition in the \"ends\" of a beam"),
            );
        }
        for (i, written) in joint.at.iter().enumerate() {
            let pointer = format!("/joints/{j}/at/{i}");
            let Some((beam, place)) = located(case, written, &pointer, faults) else {
                continue;
            };
            if let Some(first) = joined.insert((beam, place), pointer.clone()) {
                let what = format!("\"{written}\" is joined twice, first in {first}");
                let fault = Violation::new(Code::Together, &pointer, what);
                faults.push(fault.hint("list all that is joined there in one joint"));
            }
            let segments = case.beams[beam].segments.unwrap_or(1);
            let own = &case.beams[beam].ends;
            for (at, end, name) in [(0, &own.root, "root"), (segments, &own.tip, "tip")] {
                if place == at && end.is_some() {
                    let what = format!("the {name} of \"{}\" has conditions and a joint", case.beams[beam].name);
                    let fault = Violation::new(Code::Together, format!("/beams/{beam}/ends/{name}"), what);
                    faults.push_at_key(fault.hint(format!("remove the conditions, or the place from {pointer}")));
                }
            }
        }
        values(j, joint, faults);
    }
}

/// Number of the beam of this name.
fn beam_named(case: &Case, name: &str, pointer: &str, faults: &mut Violations) -> Option<usize> {
    let names = || case.beams.iter().map(|beam| beam.name.as_str());
    let found = names().position(|known| known == name);
    if found.is_none() {
        let fault = Violation::new(Code::Name, pointer, format!("there is no beam \"{name}\""));
        faults.push(Violation {
            nearest: nearest(name, names()),
            ..fault.allowed(names().collect::<Vec<_>>().join(", "))
        });
    }
    found
}

/// Beam and number of segments before a joined place.
fn located(case: &Case, written: &str, pointer: &str, faults: &mut Violations) -> Option<(usize, usize)> {
    let allowed = "the name of a beam with .root, .tip, or .3 for the place behind its third segment";
    let Some((name, along)) = joined_place(written) else {
        let fault = Violation::new(Code::Name, pointer, format!("\"{written}\" is not a place of a beam"));
        faults.push(fault.allowed(allowed));
        return None;
    };
    let beam = beam_named(case, name, pointer, faults)?;
    let segments = case.beams[beam].segments.unwrap_or(1);
    match along {
        Along::Root => Some((beam, 0)),
        Along::Tip => Some((beam, segments)),
        Along::Behind(behind) if behind <= segments => Some((beam, behind)),
        Along::Behind(behind) => {
            let what = format!("\"{name}\" has {segments} segments, not {behind}");
            faults.push(Violation::new(Code::Name, pointer, what).allowed(allowed));
            None
        }
    }
}

fn values(j: usize, joint: &Joint, faults: &mut Violations) {
    if let JointKind::Elastic(elastic) = &joint.kind {
        for (key, matrix) in [("stiffness", &elastic.stiffness), ("damping", &elastic.damping)] {
            if let Some(what) = no_energy(matrix) {
                let fault = Violation::new(Code::Range, format!("/joints/{j}/kind/elastic/{key}"), what);
                faults.push(
                    fault.allowed("a symmetric matrix without negative eigenvalues: [[a, 0, 0], [0, b, 0], [0, 0, c]]"),
                );
            }
        }
    }
    if let JointKind::Hinge(hinge) = &joint.kind
        && let Some(stop) = &hinge.stop
        && stop.from_rad >= stop.to_rad
    {
        let pointer = format!("/joints/{j}/kind/hinge/stop/to_rad");
        let what = format!(
            "the range of the hinge ends at {}, where it begins at {}",
            stop.to_rad, stop.from_rad
        );
        faults.push(Violation::new(Code::Range, pointer, what).allowed("from_rad below to_rad"));
    }
}

/// Reason that a matrix is not that of an energy; none if it is.
fn no_energy(matrix: &[[f64; 3]; 3]) -> Option<String> {
    for (i, j) in [(0, 1), (0, 2), (1, 2)] {
        if matrix[i][j] != matrix[j][i] {
            return Some(format!("rows {} and {} of the matrix are not symmetric", i + 1, j + 1));
        }
    }
    let of = nalgebra::Matrix3::from_fn(|i, j| matrix[i][j]);
    let values = of.symmetric_eigenvalues();
    let (least, most) = (values.min(), values.amax());
    (least < -1e-12 * most).then(|| format!("the matrix has the negative eigenvalue {least:.3e}"))
}

/// Checks that hinged places meet, and that joints do not divide spans with values along them.
fn places(case: &Case, faults: &mut Violations) {
    for (k, origin) in structure::origins(case).iter().enumerate() {
        if origin.is_none() {
            let what = format!("the position of \"{}\" is not given", case.beams[k].name);
            let fault = Violation::new(Code::Missing, format!("/beams/{k}"), what);
            faults.push_at_key(fault.hint("give origin_m, or join it to another beam"));
        }
    }
    let (pieces, joined) = structure::pieces(case);
    for (j, (joint, places)) in case.joints.iter().zip(&joined).enumerate() {
        let at = |place: &structure::Place| {
            let end = place.ends()[0];
            pieces[end / 2].end(end % 2 == 1)
        };
        let Some(first) = places.first().map(at) else { continue };
        let length = pieces.iter().map(|piece| piece.length).fold(f64::INFINITY, f64::min);
        for (i, place) in places.iter().enumerate() {
            let apart = (at(place) - first).squared().sqrt();
            if matches!(joint.kind, JointKind::Hinge(_)) && apart > NEAR * length {
                let what = format!(
                    "\"{}\" is {apart:.3e} m away from \"{}\", but a hinge has one position",
                    joint.at[i], joint.at[0]
                );
                let fault = Violation::new(Code::Geometry, format!("/joints/{j}/at/{i}"), what);
                faults.push(
                    fault.hint("leave out origin_m of one beam, which puts it at its joint, or change its angle_rad"),
                );
            }
        }
    }
    for piece in pieces.iter().filter(|piece| piece.at_end != [true; 2]) {
        divided(case, piece, faults);
    }
}

/// Reports values along a divided span or beam.
fn divided(case: &Case, piece: &Piece, faults: &mut Violations) {
    let mut first = 0;
    for (k, span) in case.spans.iter().enumerate() {
        let all = first..first + span.segments.unwrap_or(1);
        first = all.end;
        let cut = |segment: usize| segment > all.start && segment < all.end;
        let graded = span.given().any(|(_, _, profile)| profile.uniform().is_none());
        if graded && piece.segments.into_iter().any(cut) {
            let what = "a joint divides a span whose values are functions of the place";
            let fault = Violation::new(Code::Together, format!("/spans/{k}"), what);
            faults.push(fault.hint("divide the span at the joint"));
        }
    }
    let beam = &case.beams[piece.beam];
    let shaped = beam.loads.iter().filter_map(|load| load.distributed());
    let shaped = shaped.filter(|(_, load)| load.profile.uniform().is_none());
    if beam.attachments.iter().any(|one| one.mass_kg > 0.0)
        && let Some((key, _)) = shaped.into_iter().find(|(key, _)| key.starts_with("body"))
    {
        let what = format!("{key} with a shape, on a divided beam with attached masses");
        let fault = Violation::new(Code::Together, format!("/beams/{}/loads", piece.beam), what);
        faults.push(fault.hint("give the forces on the masses as those of attachments"));
    }
}

/// Reports given motions of ends that begin with a velocity: they would strike the beam.
fn no_jumps(k: usize, beam: &PlacedBeam, faults: &mut Violations) {
    for (end, name) in beam.ends.both().into_iter().zip(["root", "tip"]) {
        let Some(end) = end else { continue };
        let (form, given) = End::form(end);
        for (key, signal) in given.given().filter(|(key, _)| ["u1_m", "u3_m"].contains(key)) {
            if !begins_at_rest(signal) {
                let pointer = format!("/beams/{k}/ends/{name}/{form}/{key}");
                let what = "the motion of an end of a structure begins with a jump of its velocity";
                let fault = Violation::new(Code::Function, pointer, what);
                faults.push(fault.hint("begin smoothly: with \"ramp_cycles\" of a sine, or a smooth table"));
            }
        }
    }
}

/// True for a signal without velocity at t = 0, and without later jumps of its velocity.
fn begins_at_rest(signal: &Signal) -> bool {
    let jet = |t: f64, within: f64| signal.jet(SmoothTime { t, within });
    let mut breaks = vec![];
    signal.breaks(f64::MAX, &mut breaks);
    let smooth = |t: &f64| {
        let by = 1e-9 * t.abs().max(1e-9);
        let [before, after] = [t - by, t + by].map(|within| jet(*t, within));
        let rates = [before.rate, after.rate];
        (rates[0] - rates[1]).abs() <= 1e-9 * rates[0].abs().max(rates[1].abs())
    };
    jet(0.0, 0.0).rate == 0.0 && breaks.iter().all(smooth)
}
