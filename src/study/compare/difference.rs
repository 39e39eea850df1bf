//! Differences between two recordings.

use serde::{Deserialize, Serialize};

use super::align::{self, FieldPositions};
use super::changes::{self, Change};
use super::interpolate::cubic;
use super::recording::{Array, Recording, Series};
use crate::discrete::quantities::Observable;
use crate::error::numbers::rounded;
use crate::run::json_null;
use crate::run::schedule::SAME;
use crate::study::accuracy::Norms;

/// Difference of one field or column.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Difference {
    /// Name.
    pub name: String,
    /// Unit; empty for a field, whose name contains it.
    pub unit: String,
    /// Norms of the difference, relative to the larger norms of the two.
    pub relative: Norms,
    /// Size to which the norms refer.
    pub size: Norms,
    /// Time of the largest difference [s].
    #[serde(deserialize_with = "json_null::number")]
    pub at_s: f64,
    /// Position of the largest difference, a share of the beam's length or of the network; fields only.
    pub place: Option<f64>,
    /// Estimated error of interpolation in time, relative as the largest difference; 0 if the times coincide.
    #[serde(deserialize_with = "json_null::number")]
    pub interpolation: f64,
    /// Number of instants compared.
    pub instants: usize,
}

/// Difference of one figure of the summary.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FigureDifference {
    /// Name, such as `tip_u1_m.max_abs`.
    pub name: String,
    /// Value in the first result.
    pub a: f64,
    /// Value in the second result.
    pub b: f64,
    /// Difference relative to the largest figure of the quantity.
    pub relative: f64,
    /// Second minus first, relative to the size of the first; `None` if that is 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub change: Option<f64>,
    /// Sum of the absolute errors of both, if both are known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub errors: Option<f64>,
}

impl FigureDifference {
    /// True if the difference is not larger than the errors of both; `None` if these are unknown.
    pub fn is_within_errors(&self) -> Option<bool> {
        Some((self.a - self.b).abs() <= self.errors?)
    }
}

/// Cost of both runs by one measure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    /// Name of the measure.
    pub name: String,
    /// Cost of the first run.
    pub a: f64,
    /// Cost of the second run.
    pub b: f64,
}

/// Comparison of two results.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// The two folders.
    pub folders: [String; 2],
    /// Start of the time that both cover [s].
    pub from_s: f64,
    /// End of the time that both cover [s].
    pub to_s: f64,
    /// Differences in the physics; if there are any, differences of results are not errors.
    pub physics: Vec<Change>,
    /// Differences in the numerics.
    pub numerics: Vec<Change>,
    /// Histories.
    pub histories: Vec<Difference>,
    /// Fields.
    pub fields: Vec<Difference>,
    /// Figures of the summaries.
    pub figures: Vec<FigureDifference>,
    /// Wall time and work.
    pub costs: Vec<Cost>,
    /// Data that could not be compared, with reasons.
    pub left_out: Vec<String>,
    /// Remarks on the reliability of the comparison: different end times, short histories.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub remarks: Vec<String>,
}

/// Values below this share of the largest one of the same unit are rounding errors.
const NOTHING: f64 = 1e-9;

/// Compares two recordings.
pub fn compare(a: &Recording, b: &Recording) -> Comparison {
    let end = |times: &[f64]| times.last().copied().unwrap_or(0.0);
    let start = |times: &[f64]| times.first().copied().unwrap_or(0.0);
    let (physics, numerics) = changes::changes(&a.case, &b.case);
    let mut out = Comparison {
        folders: [a.label.clone(), b.label.clone()],
        from_s: start(&a.times).max(start(&b.times)),
        to_s: end(&a.times).min(end(&b.times)),
        physics,
        numerics,
        histories: vec![],
        fields: vec![],
        figures: figures(a, b),
        costs: costs(a, b),
        left_out: vec![],
        remarks: remarks(a, b),
    };
    let largest = |unit: &str| {
        let alike = [a, b].into_iter().flat_map(|r| &r.columns).filter(|c| c.unit == unit);
        alike.flat_map(|c| &c.values).fold(0.0, |m: f64, x| m.max(x.abs()))
    };
    // The energy residual is an error itself and is not compared.
    for column in a.columns.iter().filter(|c| c.name != Observable::EnergyResidual.name()) {
        match b
            .column(&column.name)
            .and_then(|other| history((a, column), (b, other)))
        {
            Some(d) if d.size.max > NOTHING * largest(&column.unit) => out.histories.push(d),
            Some(d) if d.size.max > 0.0 => out
                .left_out
                .push(format!("{}: only rounding errors in both", column.name)),
            Some(_) => {}
            None => out
                .left_out
                .push(format!("{}: missing in one of them, or no common times", column.name)),
        }
    }
    for array in &a.fields {
        match b
            .field(&array.name)
            .ok_or("missing in one of them")
            .and_then(|other| field((a, array), (b, other)))
        {
            Ok(d) if d.size.max > NOTHING * largest_field(a, b, &array.name) => out.fields.push(d),
            Ok(d) if d.size.max > 0.0 => out
                .left_out
                .push(format!("{}: only rounding errors in both", array.name)),
            Ok(_) => {}
            Err(why) => out.left_out.push(format!("{}: {why}", array.name)),
        }
    }
    out
}

/// Reports figures taken at different end times, and histories that end before their runs.
fn remarks(a: &Recording, b: &Recording) -> Vec<String> {
    let short = |one: &Recording| {
        let (end, run) = (one.times.last().copied().unwrap_or(0.0), one.summary.time_s);
        let every = one.times.windows(2).map(|t| t[1] - t[0]).fold(0.0, f64::max);
        (run - end > every * (1.0 + SAME)).then(|| {
            format!(
                "{}: the history ends at t = {} s, but the run ended at {} s. The missing part is not compared",
                one.label,
                rounded(end, 6),
                rounded(run, 6)
            )
        })
    };
    let [from, to] = [a, b].map(|one| one.summary.time_s);
    let apart = ((from - to).abs() > SAME * from.abs().max(to.abs())).then(|| {
        format!(
            "{} ends at t = {} s, {} at {} s. Figures at the end, of the window and of the whole run refer to \
             different times",
            a.label,
            rounded(from, 6),
            b.label,
            rounded(to, 6)
        )
    });
    apart.into_iter().chain([a, b].into_iter().filter_map(short)).collect()
}

/// Largest value among the fields of the same unit, which is the part of the name after the first underscore.
fn largest_field(a: &Recording, b: &Recording, name: &str) -> f64 {
    let unit = |name: &str| name.split_once('_').map(|n| n.1.to_string());
    let alike = [a, b]
        .into_iter()
        .flat_map(|r| &r.fields)
        .filter(|f| unit(&f.name) == unit(name));
    alike.flat_map(|f| &f.values).fold(0.0, |m: f64, x| m.max(x.abs()))
}

/// Returns the instants that both cover, of the recording with fewer of them; true if that is the first recording.
fn shared(a: &[f64], b: &[f64]) -> (Vec<f64>, bool) {
    let (Some(from), Some(to)) = (a.first().zip(b.first()), a.last().zip(b.last())) else {
        return (vec![], true);
    };
    let (from, to) = (from.0.max(*from.1), to.0.min(*to.1));
    // Tolerance for ends that differ by rounding errors.
    let hair = 1e-9 * (to - from).abs();
    let within = |times: &[f64]| -> Vec<f64> {
        times
            .iter()
            .copied()
            .filter(|t| (from - hair..=to + hair).contains(t))
            .collect()
    };
    let (of_a, of_b) = (within(a), within(b));
    if of_a.len() <= of_b.len() {
        (of_a, true)
    } else {
        (of_b, false)
    }
}

/// Norms of a difference, accumulated over instants.
#[derive(Default)]
struct Sum {
    squares: [f64; 3],
    largest: [f64; 3],
    count: usize,
    at: f64,
    place: usize,
}

impl Sum {
    fn take(&mut self, t: f64, a: &[f64], b: &[f64]) {
        for (k, (&a, &b)) in a.iter().zip(b).enumerate() {
            let off = (a - b).abs();
            if off > self.largest[2] {
                (self.at, self.place) = (t, k);
            }
            for (i, x) in [a.abs(), b.abs(), off].into_iter().enumerate() {
                self.squares[i] += x * x;
                self.largest[i] = self.largest[i].max(x);
            }
            self.count += 1;
        }
    }

    fn norms(&self, i: usize) -> Norms {
        Norms {
            l2: (self.squares[i] / self.count.max(1) as f64).sqrt(),
            max: self.largest[i],
        }
    }

    fn difference(&self, name: &str, unit: &str, interpolation: f64, instants: usize) -> Difference {
        let size = self.norms(0).or_larger(self.norms(1));
        Difference {
            name: name.into(),
            unit: unit.into(),
            relative: self.norms(2).over(size),
            size,
            at_s: self.at,
            place: None,
            interpolation: if size.max > 0.0 { interpolation / size.max } else { 0.0 },
            instants,
        }
    }
}

fn history((a, of_a): (&Recording, &Series), (b, of_b): (&Recording, &Series)) -> Option<Difference> {
    let (times, a_is_coarse) = shared(&a.times, &b.times);
    if times.is_empty() {
        return None;
    }
    let mut sum = Sum::default();
    let mut exact = true;
    for &t in &times {
        let mut at = |times: &[f64], series: &Series| {
            let weights = cubic(times, t);
            exact &= weights.is_exact();
            weights.mean(|k| series.values[k])
        };
        sum.take(t, &[at(&a.times, of_a)], &[at(&b.times, of_b)]);
    }
    let (dense, series) = if a_is_coarse { (b, of_b) } else { (a, of_a) };
    let added = if exact {
        0.0
    } else {
        align::column_interpolation_error(&dense.times, &series.values)
    };
    Some(sum.difference(&of_a.name, &of_a.unit, added, times.len()))
}

fn field((a, of_a): (&Recording, &Array), (b, of_b): (&Recording, &Array)) -> Result<Difference, &'static str> {
    let (times, a_is_coarse) = shared(&a.field_times, &b.field_times);
    if times.is_empty() {
        return Err("no common times");
    }
    let places = |r, f| FieldPositions::find(r, f).ok_or("its coordinate is missing");
    let (at_a, at_b) = (places(a, of_a)?, places(b, of_b)?);
    if !at_a.alike(&at_b) {
        return Err("the networks differ");
    }
    let coarse = if at_a.x.len() <= at_b.x.len() { &at_a } else { &at_b };
    let mut sum = Sum::default();
    let mut exact = true;
    for &t in &times {
        exact &= cubic(&a.field_times, t).is_exact() && cubic(&b.field_times, t).is_exact();
        let row_a = at_a.bring(&align::row_at(a, of_a, t), coarse);
        let row_b = at_b.bring(&align::row_at(b, of_b, t), coarse);
        sum.take(t, &row_a, &row_b);
    }
    let (dense, array) = if a_is_coarse { (b, of_b) } else { (a, of_a) };
    let added = if exact {
        0.0
    } else {
        align::field_interpolation_error(dense, array)
    };
    Ok(Difference {
        place: Some(coarse.x[sum.place]),
        ..sum.difference(&of_a.name, "", added, times.len())
    })
}

fn figures(a: &Recording, b: &Recording) -> Vec<FigureDifference> {
    let mut all = vec![];
    for (name, of_a) in &a.summary.quantities {
        let Some(of_b) = b.summary.quantities.get(name) else {
            continue;
        };
        let of_b = |figure: &str| of_b.figures().find(|(name, _)| *name == figure);
        let pairs: Vec<_> = of_a
            .figures()
            .filter_map(|(figure, a)| Some((figure, a, of_b(figure)?.1)))
            .collect();
        let size = pairs.iter().fold(0.0, |s: f64, (_, a, b)| s.max(a.abs()).max(b.abs()));
        let errors = |figure: &str| Some(a.summary.error(name, figure)? + b.summary.error(name, figure)?);
        all.extend(
            pairs
                .into_iter()
                .filter(|_| size > 0.0)
                .map(|(figure, of_a, of_b)| FigureDifference {
                    name: format!("{name}.{figure}"),
                    errors: errors(figure),
                    a: of_a,
                    b: of_b,
                    relative: (of_a - of_b).abs() / size,
                    change: (of_a != 0.0).then(|| (of_b - of_a) / of_a.abs()),
                }),
        );
    }
    all
}

fn costs(a: &Recording, b: &Recording) -> Vec<Cost> {
    let of = |r: &Recording| {
        let (s, w) = (&r.summary.solver, &r.summary.wall_s);
        [
            ("wall time [s]", w.total),
            ("steps", s.steps as f64),
            ("residuals", s.residual_evaluations as f64),
            ("factorisations", s.factorizations as f64),
            ("unknowns", r.summary.unknowns as f64),
        ]
    };
    of(a)
        .into_iter()
        .zip(of(b))
        .map(|((name, a), (_, b))| Cost {
            name: name.into(),
            a,
            b,
        })
        .collect()
}
