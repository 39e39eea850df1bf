//! Output files of cycles besides those of a run, `cycle.json`, and `sweep.csv`, `sweep.json` and `sweep.svg`; and their text.

mod energies;

use std::fmt::Write as _;

pub use energies::{energies, headings as energy_headings, shown as energy_shown};

use super::columns::{aligned, if_any, table};
use super::folder::ResultFolder;
use super::numbers::{change, counted, quantity, shortest, significant};
use super::plot::canvas::LineStyle;
use super::plot::colour::PALETTE;
use super::plot::picture::{Glyph, Panel, Picture, PictureAxis, PictureSeries};
use super::records;
use crate::case::readable;
use crate::discrete::quantities::Interest;
use crate::error::Result;
use crate::results;
use crate::results::cycles::{CyclePath, CycleStability, ShootingRecord, SpecialKind};
use crate::results::run::Summary;
use crate::run::sensitivity::figures::FigureSensitivity;
use crate::study::stability::{CycleMember, MemberKind};

/// Stability and search of a cycle, in its result folder.
pub const CYCLE: &str = "cycle.json";

/// Quantities over the period in table and picture.
pub const SHOWN: [Interest; 3] = [Interest::TipU1, Interest::TipU3, Interest::MaxPressure];

/// Largest value of a quantity over the period.
pub fn largest(member: &CycleMember, one: Interest) -> Option<f64> {
    member.quantities.get(one.name()).and_then(|q| q.window_max_abs)
}

/// Quantities shown for cycles of a path: if the tip is held, the largest deflection in place of its own.
pub fn shown(found: &CyclePath) -> [Interest; 3] {
    let over = |one| found.members.iter().filter_map(|m| largest(m, one)).fold(0.0, f64::max);
    let held = over(Interest::TipU1) <= HELD * over(Interest::LargestU1);
    SHOWN.map(|one| {
        if held && one == Interest::TipU1 {
            Interest::LargestU1
        } else {
            one
        }
    })
}

/// Deflection of the tip, relative to the largest one, below which the tip counts as held.
const HELD: f64 = 1e-9;

/// Name of the quantity over time whose largest value is shown.
fn short(one: Interest) -> &'static str {
    match one {
        Interest::LargestU1 => "u1",
        _ => one.columns().first().map_or(one.name(), |column| column.name()),
    }
}

/// Text of `sweep.csv`: one row per cycle, in the order of the branches. Energies, mean powers and the efficiency have the names of the table of `slcbeam sweep`.
pub fn csv(found: &CyclePath) -> String {
    let parameter = format!("{} [as in the case]", found.pointer);
    let motion = "largest |tip_u1| [m],largest |tip_u3| [m],largest pressure [Pa]".split(',');
    let stability = "growth rate [1/s],multiplier real part [1],multiplier imaginary part [1],steps [1],unknowns [1],wall time [s],verdict";
    let place = "largest |u1| [m],branch [1],point,value error [as in the case]".split(',');
    let resonance = found.resonance.as_ref().map(|_| "resonance [Hz]");
    let names = energies::columns(found);
    let rows = found.members.iter().map(|m| {
        let first = m.floquet.multipliers.first();
        let number = |x: Option<f64>| x.map_or(String::new(), shortest);
        let mut row = vec![shortest(m.value)];
        row.extend(SHOWN.map(|one| number(largest(m, one))));
        let figures = energies(m);
        row.extend(names.iter().map(|name| number(energies::column(&figures, name))));
        row.extend([first.map(|f| f.growth_per_s), first.map(|f| f.re), first.map(|f| f.im)].map(number));
        let counts = [m.search.work.steps, m.unknowns as u64].map(|n| n.to_string());
        row.extend(
            counts
                .into_iter()
                .chain([shortest(m.wall_s), m.floquet.verdict.words.clone()]),
        );
        row.extend([number(largest(m, Interest::LargestU1)), m.branch.to_string()]);
        row.extend([m.kind_name().into(), number(m.special.map(|s| s.value_error))]);
        row.extend(resonance.map(|_| number(m.resonance_hz)));
        row
    });
    let headings = motion
        .chain(names.iter().map(String::as_str))
        .chain(stability.split(','))
        .chain(place)
        .chain(resonance);
    records::text([parameter.as_str()].into_iter().chain(headings), rows)
}

/// Table of the cycles, and the work.
pub fn describe(found: &CyclePath) -> String {
    let harvested = energies::harvested(found);
    let energies: String = energy_headings(&harvested)
        .map(|heading| format!(" | {heading}"))
        .collect();
    let resonance = found.resonance.as_ref().map_or("", |_| " | resonance [Hz]");
    let headings = format!(
        " | <{}{resonance} | largest |u1| [m] | largest pressure [Pa]{energies} | <verdict",
        found.pointer
    );
    let deflection = shown(found)[0];
    let listed = found.members.iter().filter(|m| m.kind != MemberKind::Between);
    let lines = listed.map(|m| {
        let number = |one| largest(m, one).map_or("–".into(), |x| significant(x, 4));
        let (tip, pressure) = (number(deflection), number(Interest::MaxPressure));
        let resonance = m.resonance_hz.map(|hz| significant(hz, 7));
        let place = [String::new(), significant(m.value, 4)].into_iter().chain(resonance);
        [
            place.chain([tip, pressure]).collect(),
            energy_shown(m, &harvested),
            vec![match m.special {
                Some(special) => special.describe(),
                None => m.floquet.verdict.words.clone(),
            }],
        ]
        .concat()
    });
    let mut text = table(&headings, lines);
    if !harvested.is_empty() {
        text += "  ±: open part of the energy balance, relative to the value; `slcbeam periodic` estimates the mesh error of each value\n";
    }
    for (value, why) in &found.missing {
        let _ = writeln!(text, "  {}: {why}", significant(*value, 4));
    }
    let steps: u64 = found.members.iter().map(|m| m.search.work.steps).sum();
    let solves: u64 = found.members.iter().map(|m| m.search.work.linear_solves).sum();
    let wall: f64 = found.members.iter().map(|m| m.wall_s).sum();
    let between = found.members.iter().filter(|m| m.kind == MemberKind::Between).count();
    let between = if_any(between, |n| format!(" ({n} between requested values)"));
    let _ = writeln!(
        text,
        "\n{}{between} in {} and {}, {} s",
        counted(found.members.len() as u64, "cycle"),
        counted(steps, "step"),
        counted(solves, "linear solve"),
        significant(wall, 3)
    );
    text
}

/// Writes the files of a sweep into a folder.
pub fn write(folder: &mut ResultFolder, found: &CyclePath) -> Result<()> {
    let files = [("sweep.csv", csv(found)), ("sweep.json", results::text(found))];
    folder.fill(files, [("sweep.svg", picture(found))])
}

/// Picture of the cycles along the parameter, one panel per quantity. Lines are dashed beside unstable cycles.
fn picture(found: &CyclePath) -> Option<String> {
    found.members.first()?;
    let (name, unit) = (
        readable::pointer_name(&found.pointer),
        readable::pointer_unit(&found.pointer),
    );
    let x = match found.resonance {
        Some(_) => PictureAxis::new("frequency at resonance", "Hz", 7),
        None => PictureAxis::new(&name, unit, 7).logarithmic(found.logarithmic),
    };
    let panel = |name: &str, unit: &str, value: &dyn Fn(&CycleMember) -> Option<f64>| {
        let point = |m: &CycleMember| Some((m.resonance_hz.unwrap_or(m.value), value(m)?));
        let points: Vec<_> = found.members.iter().map(point).collect::<Option<_>>()?;
        let of = |wanted: &dyn Fn(&CycleMember) -> bool, glyph, colour| {
            let all = points.iter().zip(&found.members).filter(|(_, m)| wanted(m));
            PictureSeries::marks(all.map(|(p, _)| *p), glyph, colour)
        };
        let requested = |m: &CycleMember| m.kind == MemberKind::Requested;
        let mut series = branch_lines(found, &points);
        series.push(of(&|m| requested(m) && !unstable(m), Glyph::Ring(3.4, 1.4), PALETTE[0]));
        series.push(of(&|m| requested(m) && unstable(m), Glyph::Ring(3.4, 1.4), PALETTE[1]));
        for (kind, glyph) in SpecialKind::ALL.iter().zip(GLYPHS) {
            let special = |m: &CycleMember| m.special.is_some_and(|special| special.kind == *kind);
            if found.members.iter().any(special) {
                series.push(of(&special, glyph, PALETTE[9]).named(kind.describe()));
            }
        }
        let y = PictureAxis::new(name, unit, 5).with(&[0.0]);
        Some(Panel::new((560.0, 170.0), x.clone(), y, series))
    };
    // an end that is held does not move
    let moves = |one: &Interest| found.members.iter().any(|m| largest(m, *one) != Some(0.0));
    let quantities = shown(found).into_iter().filter(moves);
    let quantities = quantities.map(|one| panel(&format!("largest {}", short(one)), one.unit(), &|m| largest(m, one)));
    // mean power and efficiency
    let harvested = energies::harvested(found)
        .into_iter()
        .filter(|f| matches!(f.unit, "W" | "1"));
    let harvested = harvested.map(|f| panel(f.words, f.unit, &|m| energies::column(&energies(m), &f.name)));
    let growth = panel("growth", "1/s", &|m| Some(m.floquet.verdict.growth_per_s));
    let about = match found.resonance {
        Some(_) => &*format!("rings: values of {name}, at each the resonance; dashed and orange: not stable"),
        None => "rings: requested values; dashed and orange: cycles that are not stable",
    };
    let panels = quantities.chain(harvested).chain([growth]).flatten();
    Picture::stacked(format!("{} · steady cycles", found.case), about, panels).svg()
}

/// Glyphs of special points, in the order of [`SpecialKind::ALL`].
const GLYPHS: [Glyph; 4] = [
    Glyph::Square(4.0),
    Glyph::Cross(5.0),
    Glyph::Polygon(5.0, 3, -std::f64::consts::FRAC_PI_2, true),
    Glyph::Polygon(5.0, 4, 0.0, true),
];

fn unstable(member: &CycleMember) -> bool {
    member.floquet.verdict.stability == CycleStability::Unstable
}

/// Lines along the branches, in parts of equal stability; a part ends at a special point or at the first cycle of the other stability.
fn branch_lines(found: &CyclePath, points: &[(f64, f64)]) -> Vec<PictureSeries> {
    let mut parts: Vec<(bool, Vec<(f64, f64)>)> = vec![];
    for (pair, members) in points.windows(2).zip(found.members.windows(2)) {
        let [a, b] = members else { continue };
        if a.branch != b.branch {
            continue;
        }
        // at a special point the multiplier is on the unit circle: the other end decides
        let dashed = match (a.special.is_some(), b.special.is_some()) {
            (true, _) => unstable(b),
            (_, true) => unstable(a),
            _ => unstable(a) || unstable(b),
        };
        match parts.last_mut() {
            Some((before, part)) if *before == dashed && part.last() == Some(&pair[0]) => part.push(pair[1]),
            _ => parts.push((dashed, pair.to_vec())),
        }
    }
    let line = |(dashed, part): (bool, Vec<(f64, f64)>)| {
        let stroke = match dashed {
            true => LineStyle::dashed(PALETTE[1], 1.4, (5.0, 3.0)),
            false => LineStyle::solid(PALETTE[0], 1.4),
        };
        PictureSeries::line(part, stroke)
    };
    parts.into_iter().map(line).collect()
}

/// Text of the largest values and energies over the period. An energy is followed by the open part of its balance and its relative error;
/// `error` returns the error of a figure by name.
pub fn figures(summary: &Summary, period: f64, error: &dyn Fn(&str) -> Option<f64>) -> String {
    let quantities = &summary.quantities;
    let mut lines = vec![];
    let mut line = |beam: &str, found: Option<&results::run::Quantity>, one: Interest| {
        let value = found.and_then(|q| q.window_max_abs);
        lines.extend(value.map(|x| [format!("largest {beam}{}", short(one)), quantity(x, one.unit(), 4)]));
    };
    let beams: Vec<String> = summary.beams().map(|beam| format!("{beam}.")).collect();
    for (beam, one) in beams.iter().flat_map(|beam| SHOWN.map(|one| (beam, one))) {
        line(beam, summary.probes.get(&format!("{beam}{}", one.name())), one);
    }
    let of_first = |one: &Interest| !beams.is_empty() && matches!(one, Interest::TipU1 | Interest::TipU3);
    for one in SHOWN.into_iter().filter(|one| !of_first(one)) {
        line("", quantities.get(one.name()), one);
    }
    lines.extend(energies::lines(quantities, period, error));
    aligned(&lines, &[0, 1])
}

/// Text of the relative changes of the figures over the period for an increase of each number by 1 %.
pub fn slopes(summary: &Summary) -> String {
    let of = |(pointer, by): (&String, &FigureSensitivity)| {
        let shown = SHOWN.iter().map(|one| (*one, short(*one), "largest "));
        let energies = [
            (Interest::InputEnergy, "energy put in", ""),
            (Interest::HarvestedEnergy, "energy harvested", ""),
            (Interest::Efficiency, "efficiency", ""),
        ];
        let parts = shown.chain(energies).filter_map(|(one, words, largest)| {
            let figure = |q: &results::run::Quantity| q.window.or(q.window_max_abs);
            let value = summary.quantities.get(one.name()).and_then(figure)?;
            let slope = by.quantities.get(one.name()).and_then(figure)?;
            let change = change(slope * by.value / value)?;
            Some(format!("{largest}{words} {change}"))
        });
        format!("{pointer} +1 %: {}\n", parts.collect::<Vec<_>>().join(", "))
    };
    summary.sensitivities.iter().map(of).collect()
}

/// Text of the work of the search.
pub fn search(search: &ShootingRecord) -> String {
    format!(
        "found in {} over {}: {}, {}, {}; the cycle closes to {:.1e} of the tolerance\n",
        counted(search.newton_steps, "Newton step"),
        counted(search.periods, "period"),
        counted(search.work.steps, "step"),
        counted(search.work.residual_evaluations, "residual"),
        counted(search.work.linear_solves, "linear solve"),
        search.residual
    )
}
