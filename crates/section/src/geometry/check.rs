//! Check of all rules of a section at once.

use super::meeting::{meeting, meeting_lines, overlap};
use super::outline::Outline;
use super::rules::{MOST, Rules};
use crate::error::Fault;
use crate::input::{Row, Section};

/// Range of sizes of a section [m].
const SIZES: [f64; 2] = [1e-7, 100.0];
/// Largest ratio between pitch and height; more slender cells need too many triangles.
const LONGEST: f64 = 50.0;
/// Smallest wall thickness over the smallest outer size. Thinner walls are too thin for a mesh of single triangles.
const THINNEST: f64 = 1e-3;

/// Returns all violated rules of the section, in the order of its keys.
pub fn check(section: &Section) -> Vec<Fault> {
    let mut rules = Rules { faults: Vec::new() };
    let sizes = [
        ("/height_m", section.height_m),
        ("/width_m", section.width_m),
        ("/pitch_m", section.pitch_m),
    ];
    let mut good = true;
    for (place, value) in sizes {
        good &= rules.positive(place.to_owned(), value);
        rules.between(place, value, SIZES, "m");
    }
    let long = (section.pitch_m / section.height_m).max(section.height_m / section.pitch_m);
    if good && long > LONGEST {
        let (place, other) = if section.pitch_m > section.height_m {
            ("/pitch_m", "height")
        } else {
            ("/height_m", "pitch")
        };
        rules.fault(
            place,
            format!("is {long:.0} times the {other} (at most {LONGEST} times)"),
        );
    }
    if section.regions.len() > MOST / 4 {
        rules.fault(
            "/regions",
            format!("{} regions, at most {}", section.regions.len(), MOST / 4),
        );
    }
    good &= rules.faults.is_empty();
    rules.material("/material", &section.material);
    let length = section.bladders.length_m;
    if rules.positive("/bladders/length_m".to_owned(), length) && 0.0 < section.width_m && section.width_m < length {
        let what = format!(
            "the bladder length {length} m exceeds the beam's width {} m",
            section.width_m
        );
        rules.fault("/bladders/length_m", what);
    }
    let mut rows = Vec::new();
    match &section.bladders.upper {
        Row::Bladder(bladder) => rows.extend(
            rules
                .bladder("/bladders/upper", bladder)
                .map(|o| ("/bladders/upper".to_owned(), o)),
        ),
        Row::Mirrored => rules.fault("/bladders/upper", "only the lower row can be mirrored"),
        Row::None => {}
    }
    match &section.bladders.lower {
        Row::Bladder(bladder) => rows.extend(
            rules
                .bladder("/bladders/lower", bladder)
                .map(|o| ("/bladders/lower".to_owned(), o)),
        ),
        Row::Mirrored => {
            if let Some((_, upper)) = rows.first() {
                rows.push(("/bladders/lower".to_owned(), upper.mirrored()));
            }
        }
        Row::None => {}
    }
    let height = |row: &Row| match row {
        Row::Bladder(bladder) => Some(bladder.center_m),
        Row::None | Row::Mirrored => None,
    };
    match (height(&section.bladders.upper), height(&section.bladders.lower)) {
        (Some(upper), Some(lower)) if upper < lower => {
            rules.fault(
                "/bladders/upper/center_m",
                format!("{upper} m is not above the lower row at {lower} m"),
            );
        }
        (Some(upper), None) if upper <= 0.0 && section.bladders.lower == Row::Mirrored => {
            rules.fault(
                "/bladders/upper/center_m",
                format!("{upper} m is not above the mid-plane, where it is mirrored"),
            );
        }
        _ => {}
    }
    let mut regions = Vec::new();
    for (k, region) in section.regions.iter().enumerate() {
        rules.material(&format!("/regions/{k}/material"), &region.material);
        let place = format!("/regions/{k}/shape");
        regions.extend(rules.region(&place, &region.shape, section.pitch_m).map(|o| (place, o)));
    }
    if good {
        room(&mut rules, section, &rows, &regions);
    }
    rules.faults
}

/// A computed number without the rounding error of its binary representation.
fn rounded(number: f64) -> f64 {
    format!("{number:.8e}").parse().unwrap_or(number)
}

/// Checks for shapes that are outside, touch or overlap.
fn room(rules: &mut Rules, section: &Section, rows: &[(String, Outline)], regions: &[(String, Outline)]) {
    let half = [section.pitch_m / 2.0, section.height_m / 2.0];
    let least = THINNEST * section.pitch_m.min(section.height_m);
    // a mirrored row has the faults of the other row
    let mirrored = section.bladders.lower == Row::Mirrored;
    for (place, outline) in rows.iter().take(if mirrored { 1 } else { 2 }) {
        let chords = outline.chords();
        let size = |k: usize| {
            let most = chords.iter().fold(f64::NEG_INFINITY, |m, p| m.max(p[k]));
            most - chords.iter().fold(f64::INFINITY, |m, p| m.min(p[k]))
        };
        if size(0).min(size(1)) < least {
            rules.fault(
                place.as_str(),
                format!("has a size of {:.1e} m (at least {least:.1e} m)", size(0).min(size(1))),
            );
        }
        let most = |k: usize| outline.chords().iter().fold(0.0_f64, |m, p| m.max(p[k].abs()));
        if half[0] - most(0) < least {
            let what = format!(
                "reaches {} m along the beam (its neighbour begins at half the pitch, {} m)",
                rounded(most(0)),
                rounded(half[0])
            );
            rules.fault(place, what);
        }
        if half[1] - most(1) < least {
            rules.fault(
                place,
                format!(
                    "reaches {} m from the mid-plane (the beam's surface is at {} m)",
                    rounded(most(1)),
                    rounded(half[1])
                ),
            );
        }
    }
    let sound = |rules: &Rules, at: &str| !rules.faults.iter().any(|fault| fault.place == at);
    if let [(above, upper), (place, lower)] = rows
        && (!mirrored || sound(rules, above))
    {
        match meeting(upper, lower) {
            gap if gap >= least => {}
            gap if gap > 0.0 => rules.fault(
                place,
                format!(
                    "the wall to the upper bladder is {} m thick (at least {} m)",
                    rounded(gap),
                    rounded(least)
                ),
            ),
            _ => rules.fault(place, "overlaps the upper bladder"),
        }
    }
    for (k, (place, outline)) in regions.iter().enumerate() {
        let outside = outline
            .chords()
            .iter()
            .any(|p| (0..2).any(|c| p[c].abs() > half[c] * (1.0 + 1e-9)));
        if outside {
            rules.fault(
                place,
                format!(
                    "reaches beyond the cell of {} m x {} m",
                    section.pitch_m, section.height_m
                ),
            );
        }
        for (other, row) in rows {
            if meeting_lines(outline, row) < least {
                rules.fault(place, format!("crosses or touches the bladder at {other}"));
            }
        }
        for (other, before) in &regions[..k] {
            if overlap(outline, before, 1e-6 * half[0].min(half[1])) {
                rules.fault(place, format!("overlaps the region at {other}"));
            }
        }
    }
}
