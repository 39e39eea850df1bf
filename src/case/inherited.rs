//! Warnings about estimated coefficients: those scaled to another shape of section, where the scaling laws are not exact, and those of a
//! plane cell with short bladders.

use serde_json::Value;

use super::numbers::digits;
use super::origins::Origin;
use super::own_cell::OwnCell;
use super::scaling::{LAWS, Law, Sizes};
use super::schema::{Case, SpanRows};
use super::{spans, structure};
use crate::error::{Code, listed};

/// Pointer of a coefficient, and its value if it is a number.
type Coefficient = (&'static str, Option<f64>);

/// Pointer of the permeability of bladders, which depends on their cross-section only.
const DUCT: &str = "/bladders/permeability_m4";

const EXACT: &str = "They follow by scaling laws, which are exact for similar sections of one material only.";

/// Warnings about coefficients that were scaled to another shape of section, and about those of a plane cell.
pub fn warnings(case: &Case) -> Vec<String> {
    let given = &case.origins.given;
    let moved = |law: &&Law| given.pair(law).is_some_and(|(now, then)| !law.is_exact(now, then));
    let mut moved: Vec<&Law> = LAWS.iter().filter(moved).collect();
    let resolved = match moved.is_empty() {
        true => Value::Null,
        false => serde_json::to_value(case).unwrap_or_default(),
    };
    moved.retain(|law| belongs(&resolved, law));
    // laws in one group share their advice and their origin
    let key = |law: &Law| (law.pointer == DUCT, case.origins.get(law.pointer));
    let mut groups: Vec<Vec<&Law>> = vec![];
    for law in moved {
        match groups.iter_mut().find(|group| key(group[0]) == key(law)) {
            Some(group) => group.push(law),
            None => groups.push(vec![law]),
        }
    }
    let warnings = groups.iter().filter_map(|laws| warning(case, &resolved, laws));
    let in_spans = in_spans(case);
    warnings.chain(in_spans).chain(plane_cell(case)).collect()
}

/// Warning about coefficients that follow the sizes of a span to another shape of section.
fn in_spans(case: &Case) -> Option<String> {
    if case.spans.is_empty() {
        return None;
    }
    let resolved = serde_json::to_value(case).ok()?;
    let usual = Sizes::from_case(&resolved)?;
    let (mut names, mut shaping) = (vec![], vec![]);
    for (_, span, uniform) in spans::uniform_cases(case) {
        let written = &case.spans[span];
        let own = serde_json::to_value(written).unwrap_or_default();
        let here = serde_json::to_value(uniform).ok();
        let Some(here) = here.and_then(|here| Sizes::from_case(&here)) else {
            continue;
        };
        let moved = LAWS
            .iter()
            .filter(|law| !law.is_exact(&here, &usual) && belongs(&resolved, law));
        let moved = moved.filter(|law| own.pointer(law.pointer).is_none());
        // without bladders the section is full
        let used = moved.filter(|_| written.rows != SpanRows::None);
        let before = names.len();
        names.extend(used.map(|law| law.pointer));
        if names.len() > before && !shaping.contains(&span) {
            shaping.push(span);
        }
    }
    names.sort_unstable();
    names.dedup();
    let shaping: Vec<String> = shaping
        .iter()
        .map(|span| structure::span_pointer(case, *span))
        .collect();
    (!names.is_empty()).then(|| {
        Code::Inherited.warning(format!(
            "coefficients of another shape of section: {} changes the shape to which {} belong. {EXACT} Give the \
             coefficients of the span, or use the result as an estimate.",
            shaping.join(", "),
            names.join(", ")
        ))
    })
}

/// Warning about varied or differentiated numbers that change the shape of the section on their own.
pub fn varied<'a>(case: &Case, pointers: impl Iterator<Item = &'a str> + Clone) -> Option<String> {
    let resolved = serde_json::to_value(case).unwrap_or_default();
    let now = Sizes::from_case(&resolved)?;
    let (mut shaping, mut names) = (vec![], vec![]);
    for pointer in pointers.clone() {
        let mut other = resolved.clone();
        let number = other.pointer(pointer).and_then(Value::as_f64);
        let (Some(number), Some(place)) = (number, other.pointer_mut(pointer)) else {
            continue;
        };
        *place = (ASIDE * number).into();
        let Some(aside) = Sizes::from_case(&other) else {
            continue;
        };
        let moved = |law: &&Law| !law.is_exact(&aside, &now) && !pointers.clone().any(|p| p == law.pointer);
        let moved = LAWS.iter().filter(moved).filter(|law| belongs(&resolved, law));
        let before = names.len();
        names.extend(moved.map(|law| law.pointer));
        if names.len() > before {
            shaping.push(pointer);
        }
    }
    names.sort_unstable();
    names.dedup();
    (!names.is_empty()).then(|| {
        Code::Inherited.warning(format!(
            "coefficients of another shape of section: {} changes the shape to which {} belong. {EXACT} Give the \
             section by its geometry in /section, or use the result as an estimate.",
            shaping.join(", "),
            names.join(", ")
        ))
    })
}

/// Factor by which a number is varied to detect a change of shape.
const ASIDE: f64 = 1.01;

/// True if a case has the coefficient of a law. False for the value 1 of a beam without bladders, which is the same in every shape.
fn belongs(resolved: &Value, law: &Law) -> bool {
    let value = resolved.pointer(law.pointer);
    let full = resolved.get("bladders").is_none() && value.and_then(Value::as_f64) == Some(1.0);
    value.is_some() && !full
}

/// Relative reduction of areas per moment by the ends of bladders, divided by size over length of a bladder. Measured with sections of the
/// paper and others.
const ENDS: f64 = 0.5;
/// Relative reduction above which a warning is issued.
const WARNING_LIMIT: f64 = 0.05;

/// Relative excess of areas per moment and force of a plane cell with bladders of this size and length, if it exceeds the limit.
pub fn plane_cell_excess(size: f64, length: f64) -> Option<f64> {
    Some(ENDS * size / length).filter(|excess| *excess > WARNING_LIMIT)
}

/// Excess of areas that a case or a span, at a pointer, has from a plane cell with these bladders (height, width, length) in a beam of this
/// width [m].
fn of_plane_cell(case: &Case, at: &str, [height, width, length]: [f64; 3], beam_width: f64) -> Option<f64> {
    let areas = [
        "/bladders/area_per_moment_m2_per_n_m/opening",
        "/bladders/area_per_moment_m2_per_n_m/closing",
        "/bladders/area_per_force_m2_per_n/tension",
        "/bladders/area_per_force_m2_per_n/compression",
    ];
    let plane = |key: &str| case.origins.get(&format!("{at}{key}")) == Some(Origin::Section { three_d: false });
    // without side walls the ends are open
    let closed = areas.into_iter().any(plane) && length < beam_width;
    plane_cell_excess(height.max(width), length).filter(|_| closed)
}

/// Warning about ends of bladders that plane cells leave out.
fn plane_cell(case: &Case) -> Option<String> {
    let bladders = case.bladders.as_ref()?;
    let sizes = [bladders.height_m, bladders.width_m, bladders.length_m];
    let of_case = of_plane_cell(case, "", sizes, case.beam.width_m).map(|excess| ("/section".to_owned(), excess));
    let in_spans = case.spans.iter().enumerate().filter_map(|(k, span)| {
        let (own, at) = (span.section.as_ref()?, format!("/spans/{k}"));
        let height = span.bladders.height_m.as_ref()?.value(0.5);
        let sizes = [height, own.bladders.along(), own.bladders.length_m];
        let excess = of_plane_cell(case, &at, sizes, own.width_m)?;
        Some((format!("{at}/section"), excess))
    });
    let all: Vec<(String, f64)> = of_case.into_iter().chain(in_spans).collect();
    let largest = all.iter().map(|(_, excess)| *excess).reduce(f64::max)?;
    Some(Code::PlaneCell.warning(format!(
        "coefficients of a plane cell leave out the ends of bladders: areas per moment and force are about {:.0} % too \
         large (limit {:.0} %). Set \"three_d\": true in {}",
        100.0 * largest,
        100.0 * WARNING_LIMIT,
        listed(all.iter().map(|(at, _)| at.as_str()))
    )))
}

/// Warning about the coefficients of laws that are not exact for this case.
fn warning(case: &Case, resolved: &Value, laws: &[&Law]) -> Option<String> {
    let first = laws.first()?;
    let (mine, theirs) = case.origins.given.pair(first)?;
    let origin = case.origins.get(first.pointer);
    let value = |law: &&Law| (law.pointer, resolved.pointer(law.pointer).and_then(Value::as_f64));
    let all: Vec<Coefficient> = laws.iter().map(value).collect();
    let names: Vec<&str> = all.iter().map(|(name, _)| *name).collect();
    let verb = if names.len() == 1 { "belongs" } else { "belong" };
    let (describe, advice): (fn(&Sizes) -> String, _) = match first.pointer == DUCT {
        true => (
            bladder,
            "Give your own, or null to have it computed from the cross-section",
        ),
        false => (
            section,
            "Give those of your own beam, or its section by its geometry in /section",
        ),
    };
    let of_preset = matches!(origin, Some(Origin::Preset(_)));
    let by = origin
        .filter(|_| of_preset)
        .map_or_else(String::new, |origin| format!(" of {origin}"));
    // the assumed cell has the shape of the preset's cell
    let own = of_preset.then(|| of_cell(case, &all)).flatten();
    let own = own.map_or_else(String::new, |own| format!(": {own}"));
    Some(Code::Inherited.warning(format!(
        "coefficients of another shape of section: {}{by} {verb} to {}, here it is {}. {EXACT} {advice}{own}.",
        names.join(", "),
        describe(theirs),
        describe(mine),
    )))
}

fn bladder(sizes: &Sizes) -> String {
    let sides = sizes.bladders.map_or([0.0; 2], |b| [b.height, b.width]);
    format!("a bladder of {} mm", millimetres(&sides))
}

/// Coefficients that a cell of the case's own dimensions would give instead of the inherited ones; none for a beam without bladders.
fn of_cell(case: &Case, inherited: &[Coefficient]) -> Option<String> {
    let cell = OwnCell::from_case(case)?;
    let beside = |&(pointer, value): &Coefficient| {
        let own = cell.coefficient(pointer)?;
        Ok(own.zip(value).map(|(own, value)| instead(pointer, own, value)))
    };
    let all: Result<Vec<_>, &str> = inherited.iter().map(beside).collect();
    Some(match all {
        Ok(all) => {
            let all: Vec<String> = all.into_iter().flatten().collect();
            format!("{} gives {}", cell.assumed, all.join(", "))
        }
        Err(why) => format!("{} is not available for comparison: {why}", cell.assumed),
    })
}

/// Text of a coefficient next to the inherited one, with their ratio.
fn instead(pointer: &str, own: f64, inherited: f64) -> String {
    let name = pointer.split_once('/').and_then(|(_, rest)| rest.split_once('/'));
    let (name, times) = (name.map_or(pointer, |(_, name)| name), digits(own / inherited));
    format!(
        "{name} {} instead of {} ({times} times)",
        digits(own),
        digits(inherited)
    )
}

/// Description of the beam with its bladders.
fn section(sizes: &Sizes) -> String {
    let (modulus, section) = (short(sizes.modulus * 1e-6), millimetres(&sizes.section));
    let beam = format!("a beam of {modulus} MPa, {section} mm");
    match sizes.bladders {
        None => beam,
        Some(b) => {
            let (size, pitch) = (millimetres(&[b.height, b.width, b.length]), millimetres(&[b.pitch]));
            format!("{beam}, with bladders of {size} mm every {pitch} mm")
        }
    }
}

fn millimetres(lengths: &[f64]) -> String {
    let all: Vec<String> = lengths.iter().map(|x| short(x * 1e3)).collect();
    all.join(" x ")
}

/// Formats four significant digits without trailing zeros.
fn short(x: f64) -> String {
    let digits = (3 - x.abs().log10().floor().clamp(-9.0, 9.0) as i32).max(0) as usize;
    let text = format!("{x:.digits$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(
            [7.8e-3 * 1e3, 20.0, 0.0104, 1234.5, 2e4].map(short),
            ["7.8", "20", "0.0104", "1234", "20000"]
        );
    }
}
