//! Modes as a table, for readers and as CSV. Numbers have as many digits as their error bounds permit.

use std::fmt::Write as _;

use super::{Report, moves};
use crate::case::schema::Effect;
use crate::output::columns::{aligned, cells, if_any};
use crate::output::numbers::{counted, percent, quantity, significant};
use crate::output::records::{self, number};
use crate::run::modes::{LimitingMode, Mode, TimeBehavior};

/// Largest number of digits shown.
const DIGITS: f64 = 6.0;

const HEADINGS: &str = " | mode | moves | frequency | mesh error | effects error | damping ratio | growth rate | its mesh error | its effects error | \
                        time constant | undrained | drained";

/// Table of the modes, with a heading above and a legend below.
pub fn table(report: &Report) -> String {
    let found = report.found;
    let mut text = format!(
        "{}: small motions about {}, signals held as at t = {} s\n{}, {}, listed: {}; {} factorizations, {} solves\n\n",
        report.case,
        report.about(),
        found.about.at,
        counted(found.about.y.len() as u64, "unknown"),
        counted(found.finite as u64, "finite eigenvalue"),
        if report.plan.near_hz > 0.0 {
            format!("those nearest {} Hz", report.plan.near_hz)
        } else {
            "the slowest".into()
        } + &report
            .sort
            .map_or(String::new(), |sort| format!(" of the kind {}", sort.word())),
        found.factorizations,
        found.solves
    );
    let mut lines = vec![cells::<13>(HEADINGS).map(String::from)];
    let moving = found.modes.iter().enumerate().filter(|(_, mode)| !mode.kind.stays());
    lines.extend(moving.map(|(k, mode)| line(k + 1, mode)));
    // omits columns that are empty for all modes
    let shown: Vec<usize> = (0..lines[0].len())
        .filter(|&k| k == 0 || lines[1..].iter().any(|l| !l[k].is_empty()))
        .collect();
    let lines: Vec<Vec<String>> = lines
        .iter()
        .map(|l| shown.iter().map(|&k| l[k].clone()).collect())
        .collect();
    let words: Vec<usize> = (0..shown.len()).filter(|&k| matches!(shown[k], 1 | 2)).collect();
    if lines.len() > 1 {
        text += &aligned(&lines, &words);
    }
    text += &staying(report);
    let compared = |finer| {
        let mut by_mesh = found.modes.iter().map(|mode| mode.by_mesh);
        by_mesh.any(|by| by.beam.is_some() && by.finer == finer)
    };
    let cells = match [compared(false), compared(true)] {
        [true, false] => Some("half"),
        [false, true] => Some("twice"),
        [true, true] => Some("half or twice"),
        [false, false] => None,
    };
    if let Some(cells) = cells {
        let bladders = if found.bladders_compared {
            " and twice those of each bladder"
        } else {
            ""
        };
        let _ = writeln!(
            text,
            "\nmesh error: estimate from {cells} the cells of the beam{bladders}"
        );
    }
    if !found.left_out.is_empty() {
        let _ = writeln!(
            text,
            "effects error: change with {}",
            Effect::names(&found.left_out, ", ")
        );
    }
    if let Some(reason) = &found.excluded {
        let _ = writeln!(text, "{reason}");
    }
    if found.modes.iter().any(|m| m.undrained.is_some() || m.drained.is_some()) {
        text += "\nundrained: the same shape with every bladder sealed; drained: with networks of one pressure\n";
    }
    text
}

/// Counts of the modes that do not move.
fn staying(report: &Report) -> String {
    let described = |(kind, what): (TimeBehavior, &str)| {
        let one = kind.word();
        match report.found.modes.iter().filter(|mode| mode.kind == kind).count() {
            0 => None,
            1 => Some(format!("1 {one} ({what})")),
            n => Some(format!("{n} {one}s ({what})")),
        }
    };
    let kinds = [
        (TimeBehavior::Rigid, "nothing holds them"),
        (TimeBehavior::Volume, "fluid of closed networks"),
    ];
    let all = kinds.into_iter().filter_map(described).collect::<Vec<_>>();
    if_any(all.len(), |_| format!("and with s = 0: {}\n", all.join(", ")))
}

fn line(number: usize, mode: &Mode) -> [String; 13] {
    let cell = |value: Option<f64>, error: f64, unit: &str| {
        value.map_or(String::new(), |value| quantity(value, unit, digits(value, error)))
    };
    let limit = |limit: &Option<LimitingMode>| limit.map_or(String::new(), |l| quantity(l.frequency_hz, "Hz", 5));
    let size = mode.s.norm();
    [
        number.to_string(),
        mode.kind.word().into(),
        moves(mode).into(),
        cell(mode.frequency_hz(), mode.error / std::f64::consts::TAU, "Hz"),
        mode.mesh_error().map_or(String::new(), percent),
        mode.effects_error().map_or(String::new(), percent),
        mode.damping_ratio()
            .map_or(String::new(), |z| significant(z, digits(z, mode.error / size).min(4))),
        if mode.kind.stays() {
            String::new()
        } else {
            format!("{} 1/s", significant(mode.s.re, digits(mode.s.re, mode.error)))
        },
        mode.rate_error().map_or(String::new(), percent),
        mode.rate_effects_error().map_or(String::new(), percent),
        cell(mode.time_s(), mode.error / mode.s.re.powi(2), "s"),
        limit(&mode.undrained),
        limit(&mode.drained),
    ]
}

/// Number of digits of a value that its error permits, at least one.
fn digits(value: f64, error: f64) -> usize {
    let known = (value.abs() / error).log10();
    if known.is_finite() {
        known.clamp(1.0, DIGITS) as usize
    } else {
        DIGITS as usize
    }
}

/// Short text of a mode.
pub fn describe(mode: &Mode) -> String {
    let kind = mode.kind.word();
    match (mode.frequency_hz(), mode.time_s()) {
        (Some(f), Some(_)) => {
            let ratio = significant(mode.damping_ratio().unwrap_or(0.0), 3);
            format!("{kind}, {}, damping ratio {ratio}", quantity(f, "Hz", 4))
        }
        (Some(f), None) => format!("{kind}, {}, undamped", quantity(f, "Hz", 4)),
        (None, Some(t)) => format!("{kind}, {}", quantity(t, "s", 4)),
        (None, None) => kind.into(),
    }
}

/// Heading and number of a column.
type ModeColumn = (&'static str, fn(&Mode) -> Option<f64>);

/// Columns of numbers in `modes.csv`.
#[rustfmt::skip]
const COLUMNS: [ModeColumn; 14] = [
    ("frequency [Hz]", |mode| mode.frequency_hz()),
    ("damping ratio [1]", |mode| mode.damping_ratio()),
    ("growth rate [1/s]", |mode| Some(mode.s.re)),
    ("time constant [s]", |mode| mode.time_s()),
    ("error bound [1/s]", |mode| Some(mode.error)),
    ("residual [1]", |mode| Some(mode.residual)),
    ("transverse share [1]", |mode| Some(mode.shape.transverse())),
    ("undrained frequency [Hz]", |mode| mode.undrained.map(|l| l.frequency_hz)),
    ("undrained likeness [1]", |mode| mode.undrained.map(|l| l.likeness)),
    ("drained frequency [Hz]", |mode| mode.drained.map(|l| l.frequency_hz)),
    ("drained likeness [1]", |mode| mode.drained.map(|l| l.likeness)),
    ("frequency on half the cells [Hz]", |mode| mode.coarse.map(|l| l.frequency_hz)),
    ("extrapolated frequency [Hz]", |mode| mode.extrapolated_hz()),
    ("extrapolated growth rate [1/s]", |mode| mode.extrapolated().map(|s| s.re)),
];

/// Text of `modes.csv`: one row per mode; cells without a number are empty.
pub fn csv(report: &Report) -> String {
    let headings = ["mode [1]", "kind"]
        .into_iter()
        .chain(COLUMNS.map(|(heading, _)| heading));
    let rows = report.found.modes.iter().enumerate().map(|(k, mode)| {
        let first = [(k + 1).to_string(), mode.kind.word().into()];
        first
            .into_iter()
            .chain(COLUMNS.map(|(_, of)| number(of(mode))))
            .collect()
    });
    records::text(headings, rows)
}
