//! Curves along the beam: fields of a run at instants, shapes of equilibria and modes.

use std::path::Path;

use super::names::{field, for_readers};
use super::{NamedCurve, QuantityPanel};
use crate::case::nearest;
use crate::discrete::quantities::{BeamField, FieldAxis, PlacedNodes};
use crate::error::{Error, Result, usage};
use crate::output::arrays::TIMES;
use crate::output::folder::{FIELDS, fault, open};
use crate::output::kind::FolderKind;
use crate::output::npz::Npz;
use crate::output::numbers::{quantity, significant, trimmed};

/// Name of the deflected shape.
pub const SHAPE: &str = "shape";
/// Displacements of modes.
const MODES: [&str; 2] = ["u1", "u3"];

/// Arrays of a result with one row per instant or mode.
struct Rows {
    npz: Npz,
    path: std::path::PathBuf,
}

impl Rows {
    fn open(dir: &Path, name: &str) -> Result<Self> {
        let path = dir.join(name);
        let npz = Npz::open(&path).map_err(|e| fault("read", &path, e))?;
        Ok(Self { npz, path })
    }

    fn axis(&mut self, name: &str) -> Result<Option<Vec<f64>>> {
        if self.npz.entry(name).is_none() {
            return Ok(None);
        }
        self.npz.read(name).map(Some).map_err(|e| fault("read", &self.path, e))
    }

    /// Some rows of an array, by ascending number.
    fn rows(&mut self, name: &str, wanted: &[usize]) -> Result<Vec<Vec<f64>>> {
        let mut all = vec![];
        let found = self.npz.chosen(name, wanted, &mut |row| all.push(row.to_vec()));
        found.map_err(|e| fault("read", &self.path, e))?;
        Ok(all)
    }
}

/// Numbers of the entries nearest to the wanted values, ascending.
///
/// # Errors
/// A value is outside of those that exist.
fn nearest_of(all: &[f64], wanted: &[f64], words: &str, unit: &str) -> Result<Vec<usize>> {
    let shown = |x: f64| trimmed(&quantity(x, unit, 4));
    let (Some(first), Some(last)) = (all.first(), all.last()) else {
        return usage(format!("--at: the result has no {words}"));
    };
    let room = 1e-9 * (last - first).abs();
    let mut found = vec![];
    for at in wanted {
        if !(first.min(*last) - room..=last.max(*first) + room).contains(at) {
            return usage(format!(
                "--at {}: the result has {words} from {} to {}",
                significant(*at, 6),
                shown(*first),
                shown(*last)
            ));
        }
        let far = |k: &usize| (all[*k] - at).abs();
        found.extend((0..all.len()).min_by(|a, b| far(a).total_cmp(&far(b))));
    }
    found.sort_unstable();
    found.dedup();
    Ok(found)
}

/// Label of a curve: that of its result, then the instant.
fn joined(label: &str, at: String) -> String {
    match label {
        "" => at,
        label => format!("{label}, {at}"),
    }
}

/// Panels of quantities along the beam: of a run at instants [s], of an equilibrium at load factors, of modes by their numbers.
///
/// # Errors
/// The result has no shapes, or a quantity is unknown.
pub fn panels(dir: &Path, quantities: &[String], at: &[f64], label: &str) -> Result<Vec<QuantityPanel>> {
    match FolderKind::find("draw", dir)? {
        FolderKind::Run | FolderKind::Cycle => run(dir, quantities, at, label),
        FolderKind::Equilibrium => equilibrium(dir, quantities, at, label),
        FolderKind::Modes => modes(dir, quantities, at, label),
        kind => Err(no_shapes(dir, kind)),
    }
}

/// Quantities that can be drawn along the beam.
///
/// # Errors
/// The result has no shapes.
pub fn names(dir: &Path) -> Result<Vec<[String; 3]>> {
    let row = |name: &str, unit: &str, words: String| [name.to_string(), unit.to_string(), words];
    let shape = || row(SHAPE, "m", "deflected shape to scale".into());
    Ok(match FolderKind::find("draw", dir)? {
        FolderKind::Run | FolderKind::Cycle => {
            let file = Rows::open(dir, FIELDS)?;
            let there = BeamField::ALL
                .into_iter()
                .filter(|one| file.npz.entry(one.name()).is_some());
            let fields = there.map(|one| row(one.name(), one.unit(), field(one)));
            [shape()].into_iter().chain(fields).collect()
        }
        FolderKind::Equilibrium => vec![shape()],
        FolderKind::Modes => MODES
            .map(|name| {
                row(
                    name,
                    "1",
                    format!("{} / largest displacement", for_readers(name, "m").0),
                )
            })
            .to_vec(),
        kind => return Err(no_shapes(dir, kind)),
    })
}

fn no_shapes(dir: &Path, kind: FolderKind) -> Error {
    Error::Usage(format!(
        "--at: {} has a result of `slcbeam {}` without shapes; run, periodic, equilibrium and modes have them",
        dir.display(),
        kind.command()
    ))
}

fn unknown(name: &str, known: &[&str]) -> Error {
    let near = nearest(name, known.iter().copied()).map_or_else(String::new, |near| format!("; did you mean {near}?"));
    Error::Usage(format!(
        "--quantity {name}: with --at the quantities are {}{near}",
        known.join(", ")
    ))
}

fn run(dir: &Path, quantities: &[String], at: &[f64], label: &str) -> Result<Vec<QuantityPanel>> {
    let mut file = Rows::open(dir, FIELDS)?;
    let times = file.axis(TIMES)?.unwrap_or_default();
    let chosen = nearest_of(&times, at, "instants", "s")?;
    let name_of = |k: &usize| joined(label, trimmed(&quantity(times[*k], "s", 4)));
    let mut panels = vec![];
    let there: Vec<&str> = BeamField::ALL
        .into_iter()
        .map(BeamField::name)
        .filter(|name| file.npz.entry(name).is_some())
        .chain([SHAPE])
        .collect();
    for wanted in quantities {
        if wanted == SHAPE {
            let mut read = |axis: FieldAxis| file.axis(axis.name()).ok().flatten();
            let placed = PlacedNodes::from_axes(&mut read);
            let theta = read(FieldAxis::Nodes).unwrap_or_default();
            let (u1, u3) = (file.rows("u1_m", &chosen)?, file.rows("u3_m", &chosen)?);
            let line = |(u1, u3): (&Vec<f64>, &Vec<f64>)| match &placed {
                Some(nodes) => nodes.line(u1, u3),
                None => {
                    let z = theta.iter().zip(u3).map(|(theta, u)| theta + u);
                    z.zip(u1.iter().copied()).collect()
                }
            };
            let curves = chosen.iter().zip(u1.iter().zip(&u3));
            let curves = curves.map(|(k, both)| NamedCurve::new(name_of(k), line(both)));
            panels.push(QuantityPanel::shape(curves.collect()));
            continue;
        }
        let one = BeamField::ALL.into_iter().find(|one| {
            let bare = one.name().strip_suffix("_m").unwrap_or(one.name());
            [one.name(), bare].contains(&wanted.as_str()) || one.name().split('_').next() == Some(wanted)
        });
        let one = one
            .filter(|one| there.contains(&one.name()))
            .ok_or_else(|| unknown(wanted, &there))?;
        let x = file.axis(one.axis().name())?.unwrap_or_default();
        // where another beam or network begins, the curve breaks
        let parts = match one.axis() {
            FieldAxis::Network => FieldAxis::Array,
            FieldAxis::Cells => FieldAxis::BeamOfCell,
            _ => FieldAxis::BeamOfNode,
        };
        let part = file.axis(parts.name())?.unwrap_or_default();
        let curves = chosen.iter().zip(file.rows(one.name(), &chosen)?).map(|(k, values)| {
            let mut points = vec![];
            for (i, (x, y)) in x.iter().zip(values).enumerate() {
                if i > 0 && part.get(i) != part.get(i - 1) {
                    points.push((f64::NAN, f64::NAN));
                }
                points.push((*x, y));
            }
            NamedCurve::new(name_of(k), points)
        });
        let x_name = match one.axis() {
            FieldAxis::Network => ("network coordinate".into(), "1".into()),
            _ => along(),
        };
        panels.push(QuantityPanel::curves(
            x_name,
            (field(one), one.unit().into()),
            curves.collect(),
        ));
    }
    Ok(panels)
}

/// Name and unit of the place along the beam.
fn along() -> (String, String) {
    ("material coordinate θ".into(), "m".into())
}

fn equilibrium(dir: &Path, quantities: &[String], at: &[f64], label: &str) -> Result<Vec<QuantityPanel>> {
    const SHAPES: &str = "shapes.csv";
    if let Some(other) = quantities.iter().find(|name| *name != SHAPE) {
        return Err(unknown(other, &[SHAPE]));
    }
    let path = dir.join(SHAPES);
    let failed = |e: csv::Error| fault("read", &path, e.into());
    let file = open(&path).map_err(|e| fault("read", &path, e))?;
    let mut reader = csv::Reader::from_reader(file);
    let headings = reader.headers().map_err(failed)?.clone();
    let factor = |heading: &str| heading.strip_prefix("x at ")?.strip_suffix(" [m]")?.parse::<f64>().ok();
    let states: Vec<(usize, f64)> = headings
        .iter()
        .enumerate()
        .filter_map(|(k, heading)| Some((k, factor(heading)?)))
        .collect();
    let factors: Vec<f64> = states.iter().map(|state| state.1).collect();
    let chosen = nearest_of(&factors, at, "load factors", "1")?;
    let mut curves: Vec<NamedCurve> = chosen
        .iter()
        .map(|k| {
            NamedCurve::new(
                joined(label, format!("load factor {}", significant(factors[*k], 3))),
                vec![],
            )
        })
        .collect();
    let mut beam = String::new();
    for record in reader.records() {
        let record = record.map_err(failed)?;
        let own = if headings.get(0) == Some("beam") {
            record.get(0).unwrap_or_default()
        } else {
            ""
        };
        let number = |k: usize| record.get(k).and_then(|cell| cell.parse().ok()).unwrap_or(f64::NAN);
        for (curve, k) in curves.iter_mut().zip(&chosen) {
            if own != beam {
                curve.points.push((f64::NAN, f64::NAN));
            }
            let x = states[*k].0;
            curve.points.push((number(x + 1), number(x)));
        }
        beam = own.into();
    }
    Ok(vec![QuantityPanel::shape(curves)])
}

/// Displacements of a mode at the instant of its largest one, relative to that; `all` has amplitude and phase of both displacements.
fn relative(own: &[(f64, f64)], all: &[(f64, f64)]) -> Vec<f64> {
    let largest = all.iter().copied().max_by(|p, q| p.0.total_cmp(&q.0));
    let (size, start) = largest.filter(|p| p.0 > 0.0).unwrap_or((1.0, 0.0));
    own.iter().map(|(a, phase)| a * (phase - start).cos() / size).collect()
}

fn modes(dir: &Path, quantities: &[String], at: &[f64], label: &str) -> Result<Vec<QuantityPanel>> {
    let mut file = Rows::open(dir, "modes.npz")?;
    let theta = file.axis("theta_m")?.unwrap_or_default();
    let named = |wanted: &String| {
        let name = if wanted == SHAPE {
            "u1"
        } else {
            wanted.strip_suffix("_m").unwrap_or(wanted)
        };
        let known = MODES.iter().find(|known| **known == name);
        known.copied().ok_or_else(|| unknown(wanted, &MODES))
    };
    let names: Vec<&str> = quantities.iter().map(named).collect::<Result<_>>()?;
    let count = file
        .npz
        .entry("u1_amplitude_m")
        .map_or(0, crate::output::npz::Entry::rows);
    let numbers: Vec<f64> = (1..=count).map(|k| k as f64).collect();
    let chosen = nearest_of(&numbers, at, "modes", "1")?;
    let mut read = |name: &str| -> Result<_> {
        let amplitudes = file.rows(&format!("{name}_amplitude_m"), &chosen)?;
        Ok((amplitudes, file.rows(&format!("{name}_phase_rad"), &chosen)?))
    };
    let (u1, u3) = (read("u1")?, read("u3")?);
    let mut panels = vec![];
    for name in names {
        let own = if name == "u1" { &u1 } else { &u3 };
        let curves = chosen.iter().enumerate().map(|(row, k)| {
            let pairs = |(a, phase): &(Vec<Vec<f64>>, Vec<Vec<f64>>)| -> Vec<(f64, f64)> {
                a[row].iter().copied().zip(phase[row].iter().copied()).collect()
            };
            let values = relative(&pairs(own), &[pairs(&u1), pairs(&u3)].concat());
            NamedCurve::new(
                joined(label, format!("mode {}", k + 1)),
                theta.iter().copied().zip(values).collect(),
            )
        });
        let y = for_readers(name, "m").0;
        panels.push(QuantityPanel::curves(
            along(),
            (format!("{y} / largest displacement"), "1".into()),
            curves.collect(),
        ));
    }
    Ok(panels)
}

#[cfg(test)]
mod tests {
    use super::relative;

    /// Goal: the bending of an axial mode stays small.
    #[test]
    fn modes_are_relative_to_their_largest_displacement() {
        let (u1, u3) = (vec![(0.0, 0.0), (2e-12, 3.0)], vec![(0.5, 0.3), (2.0, 0.3)]);
        let all = [u1.clone(), u3.clone()].concat();
        assert!(relative(&u1, &all).iter().all(|y| y.abs() < 1.1e-12));
        assert_eq!(relative(&u3, &all), [0.25, 1.0]);
    }
}
