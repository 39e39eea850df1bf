//! Coefficients of a preset in a case whose beam is another one, and of a plane cell where bladders are short.

use std::f64::consts::PI;

use serde_json::Value;

use super::computed;
use super::numbers::digits;
use super::origins::Origin;
use super::own_cell::OwnCell;
use super::presets::Preset;
use super::schema::Case;
use crate::error::Code;

/// Relative change of a size beyond which it is another beam's.
const SAME: f64 = 1e-3;

/// What coefficients belong to [m, Pa].
#[derive(Clone, Copy)]
struct Sizes {
    modulus: f64,
    /// Height and width of the beam's section.
    section: [f64; 2],
    bladders: Option<InBeam>,
    radius: Option<f64>,
}

/// Bladders in the beam [m].
#[derive(Clone, Copy)]
struct InBeam {
    /// Length of beam to each bladder of a row.
    pitch: f64,
    length: f64,
    height: f64,
    width: f64,
}

/// Coefficients and what they belong to.
struct Group {
    coefficients: &'static [&'static str],
    sizes: fn(&Sizes) -> Option<Vec<f64>>,
}

/// Groups that are told together: how what they belong to is called, and what to do.
struct Part {
    groups: &'static [Group],
    words: fn(&Sizes) -> String,
    advice: &'static str,
    own: fn(&Case, &[Inherited]) -> Option<String>,
}

/// A coefficient of the preset: where it stands, and its value.
type Inherited = (&'static str, f64);

const OWN_OR_NULL: &str = "give your own, or null to have it computed from the cross-section";

/// Which coefficients belong to which sizes. Stiffness factors are ratios: they stay when everything is scaled alike, and
/// whatever the modulus is. Areas go with `1/E`.
const PARTS: [Part; 3] = [
    Part {
        groups: &[
            Group {
                coefficients: &["/beam/axial_stiffness_factor", "/beam/bending_stiffness_factor"],
                sizes: |s| {
                    let [h, w] = s.section;
                    // a beam without bladders has only its section to be told by
                    Some(s.bladders.map_or(vec![h, w], |b| {
                        vec![b.height / h, b.width / b.pitch, b.length / w, b.pitch / h]
                    }))
                },
            },
            Group {
                coefficients: &["/bladders/area_per_pressure_m2_per_pa"],
                sizes: |s| {
                    let b = s.bladders?;
                    Some(vec![s.modulus, s.section[0], b.pitch, b.height, b.width])
                },
            },
            Group {
                coefficients: &[
                    "/bladders/area_per_moment_m2_per_n_m/opening",
                    "/bladders/area_per_moment_m2_per_n_m/closing",
                    "/bladders/area_per_force_m2_per_n/tension",
                    "/bladders/area_per_force_m2_per_n/compression",
                ],
                sizes: |s| {
                    let b = s.bladders?;
                    let [h, w] = s.section;
                    Some(vec![s.modulus, h, w, b.pitch, b.height, b.width, b.length])
                },
            },
        ],
        words: section,
        advice: "give those of your own beam",
        own: of_cell,
    },
    Part {
        groups: &[Group {
            coefficients: &["/bladders/permeability_m4"],
            sizes: |s| s.bladders.map(|b| vec![b.height, b.width]),
        }],
        words: |s| {
            let sides = s.bladders.map_or([0.0; 2], |b| [b.height, b.width]);
            format!("a bladder of {} mm", millimetres(&sides))
        },
        advice: OWN_OR_NULL,
        own: of_cell,
    },
    Part {
        groups: &[Group {
            coefficients: &["/tubes/permeability_m4"],
            sizes: |s| s.radius.map(|r| vec![r]),
        }],
        words: |s| format!("a tube of radius {} mm", millimetres(&[s.radius.unwrap_or_default()])),
        advice: OWN_OR_NULL,
        own: of_tube,
    },
];

/// Warnings about coefficients that the case takes from its preset while it changes what they belong to, and about those of a plane cell.
pub fn warnings(case: &Case) -> Vec<String> {
    let mine = of_case(case);
    let parts = PARTS.iter().filter_map(|part| warning(case, &mine, part));
    parts.chain(plane_cell(case)).chain(cross_term(case)).collect()
}

/// Area of a row per pressure in the other row, over that per its own pressure, above which the model leaves out too much.
const CROSS: f64 = 0.02;

fn cross_term(case: &Case) -> Option<String> {
    let pointer = "/bladders/area_per_pressure_m2_per_pa";
    let computed = matches!(case.origins.get(pointer), Some(Origin::Section { .. }));
    let section = case.section.as_ref().filter(|_| computed)?;
    let numbers = computed::coefficients(section).ok()?.numbers;
    let [own, other] = [
        numbers.area_per_pressure_m2_per_pa,
        numbers.area_per_other_pressure_m2_per_pa,
    ];
    let ratio = (other / own).abs();
    (ratio > CROSS).then(|| {
        Code::CrossTerm.warning(format!(
            "The model leaves out the area of one row per pressure in the other: {other:.3e} m^2/Pa, {:.1} % of area_per_pressure_m2_per_pa (limit {:.0} \
             %). Where both rows are under pressure, areas, and pressures of closed bladders, are off by up to this share of the larger pressure. \
             Use larger fillets, or move the bladders away from the mid-plane, to make it smaller.",
            100.0 * ratio,
            100.0 * CROSS
        ))
    })
}

/// What the ends of bladders take off areas per moment, over their size over their length: measured with sections of the paper's and others.
const ENDS: f64 = 0.5;
/// Part above which that is told.
const TOLD: f64 = 0.05;

fn plane_cell(case: &Case) -> Option<String> {
    let bladders = case.bladders.as_ref()?;
    let areas = [
        "/bladders/area_per_moment_m2_per_n_m/opening",
        "/bladders/area_per_moment_m2_per_n_m/closing",
        "/bladders/area_per_force_m2_per_n/tension",
        "/bladders/area_per_force_m2_per_n/compression",
    ];
    let plane = |pointer: &str| case.origins.get(pointer) == Some(Origin::Section { three_d: false });
    // without side walls the ends are open
    let of_plane = areas.into_iter().any(plane) && bladders.length_m < case.beam.width_m;
    let off = ENDS * bladders.height_m.max(bladders.width_m) / bladders.length_m;
    (of_plane && off > TOLD).then(|| {
        Code::PlaneCell.warning(format!(
            "coefficients of a plane cell leave out the ends of bladders: areas per moment and force are about {:.0} % too large; \
             \"three_d\": true in /section",
            100.0 * off
        ))
    })
}

fn warning(case: &Case, mine: &Sizes, part: &Part) -> Option<String> {
    let (mut names, mut of) = (vec![], None);
    let mut inherited: Vec<Inherited> = vec![];
    for group in part.groups {
        for pointer in group.coefficients {
            let Some(Origin::Preset(preset)) = case.origins.get(pointer) else {
                continue;
            };
            let theirs = of_preset(preset, mine.bladders.is_some())?;
            if !same((group.sizes)(mine), (group.sizes)(&theirs)) {
                names.push(*pointer);
                let value = preset.values().pointer(pointer).and_then(Value::as_f64);
                inherited.extend(value.map(|value| (*pointer, value)));
                of = Some((preset, theirs));
            }
        }
    }
    let (preset, theirs) = of?;
    let verb = if names.len() == 1 { "belongs" } else { "belong" };
    Some(Code::Inherited.warning(format!(
        "coefficients of preset {}: {} {verb} to {}, here it is {}: {}{}",
        preset.name(),
        names.join(", "),
        (part.words)(&theirs),
        (part.words)(mine),
        part.advice,
        (part.own)(case, &inherited).map_or_else(String::new, |own| format!("; {own}"))
    )))
}

/// What the cell of the case's own sizes would give in place of what is inherited; nothing for a beam without bladders.
fn of_cell(case: &Case, inherited: &[Inherited]) -> Option<String> {
    let cell = OwnCell::of(case)?;
    let beside = |&(pointer, value): &Inherited| Ok(cell.coefficient(pointer)?.map(|own| instead(pointer, own, value)));
    let all: Result<Vec<_>, &str> = inherited.iter().map(beside).collect();
    Some(match all {
        Ok(all) => {
            let all: Vec<String> = all.into_iter().flatten().collect();
            format!("{} gives {}", cell.assumed, all.join(", "))
        }
        Err(why) => format!("{} gives nothing to compare with: {why}", cell.assumed),
    })
}

/// Hagen and Poiseuille's permeability of a round tube.
fn of_tube(case: &Case, inherited: &[Inherited]) -> Option<String> {
    let radius = case.tubes.as_ref()?.radius_m;
    let own = PI / 8.0 * radius.powi(4);
    let all: Vec<String> = inherited
        .iter()
        .map(|&(pointer, value)| instead(pointer, own, value))
        .collect();
    Some(format!("a round tube has {}", all.join(", ")))
}

/// A coefficient beside the one that is inherited, and how many times as large it is.
fn instead(pointer: &str, own: f64, inherited: f64) -> String {
    let name = pointer.split_once('/').and_then(|(_, rest)| rest.split_once('/'));
    let (name, times) = (name.map_or(pointer, |(_, name)| name), digits(own / inherited));
    format!(
        "{name} {} instead of {} ({times} times)",
        digits(own),
        digits(inherited)
    )
}

fn same(mine: Option<Vec<f64>>, theirs: Option<Vec<f64>>) -> bool {
    let (Some(mine), Some(theirs)) = (mine, theirs) else {
        return true;
    };
    mine.iter().zip(&theirs).all(|(a, b)| (a - b).abs() <= SAME * b.abs())
}

fn of_case(case: &Case) -> Sizes {
    let beam = &case.beam;
    Sizes {
        modulus: beam.young_modulus_pa,
        section: [beam.height_m, beam.width_m],
        bladders: case.bladders.as_ref().map(|b| InBeam {
            pitch: beam.length_m / b.per_row.max(1) as f64,
            length: b.length_m,
            height: b.height_m,
            width: b.width_m,
        }),
        radius: case.tubes.as_ref().map(|t| t.radius_m),
    }
}

/// Sizes of the preset, with its bladders or without.
fn of_preset(preset: Preset, wet: bool) -> Option<Sizes> {
    let values = preset.values();
    let number = |pointer: &str| values.pointer(pointer).and_then(Value::as_f64);
    Some(Sizes {
        modulus: number("/beam/young_modulus_pa")?,
        section: [number("/beam/height_m")?, number("/beam/width_m")?],
        bladders: match wet {
            true => Some(InBeam {
                pitch: number("/beam/length_m")? / number("/bladders/per_row")?,
                length: number("/bladders/length_m")?,
                height: number("/bladders/height_m")?,
                width: number("/bladders/width_m")?,
            }),
            false => None,
        },
        radius: number("/tubes/radius_m"),
    })
}

/// The beam with its bladders in words.
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

/// Four digits, without the zeros behind.
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
