//! Pictures of chosen quantities of any result, alone or of several results over each other.
//!
//! ```text
//! table    columns of the table of a result, its usual abscissa and quantities
//! curves   columns as curves with their error bands
//! profile  curves along the beam at instants
//! series   curves as lines, symbols and bands of a panel
//! names    names of columns for readers
//! ```

mod curves;
pub mod names;
pub mod profile;
mod series;
pub mod table;

use std::path::{Path, PathBuf};

use super::folder::name_of;
use super::plot::canvas::Drawing;
use super::plot::picture::{Panel, Picture, PictureAxis};
use super::plot::style::{POINTS_PER_MM, PictureStyle};
use super::plot::{extent, width_of};
use crate::error::{Error, Result, usage};
use table::ResultTable;

/// Height of a single panel relative to its width, and of one of several.
const SINGLE: f64 = 0.68;
const SEVERAL: f64 = 0.42;
/// Smallest width and height of a frame, in units of the layout.
const LEAST: f64 = 40.0;
/// Largest height of a page [mm].
const MOST_MM: f64 = 1000.0;

/// A curve and its name in the legend.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedCurve {
    /// Name in the legend; empty for a single curve.
    pub label: String,
    /// Points; broken where a coordinate is not finite.
    pub points: Vec<(f64, f64)>,
    /// Error band: abscissa, lower and upper limit; empty if unknown.
    pub band: Vec<(f64, f64, f64)>,
}

impl NamedCurve {
    /// A curve without band.
    pub fn new(label: String, points: Vec<(f64, f64)>) -> Self {
        Self {
            label,
            points,
            band: vec![],
        }
    }
}

/// Curves of one quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct QuantityPanel {
    /// Name and unit of the abscissa.
    pub x: (String, String),
    /// Name and unit of the quantity.
    pub y: (String, String),
    /// Curves.
    pub curves: Vec<NamedCurve>,
    /// True for points without line.
    pub marks: bool,
    /// True for logarithmic axes.
    pub logarithmic: [bool; 2],
    /// True if both axes have one scale.
    pub equal: bool,
}

impl QuantityPanel {
    /// Lines over linear axes.
    pub fn curves(x: (String, String), y: (String, String), curves: Vec<NamedCurve>) -> Self {
        Self {
            x,
            y,
            curves,
            marks: false,
            logarithmic: [false; 2],
            equal: false,
        }
    }

    /// Shapes of the beam to scale.
    pub fn shape(curves: Vec<NamedCurve>) -> Self {
        let axis = |name: &str| (name.to_string(), "m".to_string());
        Self {
            equal: true,
            ..Self::curves(axis("z"), axis("x"), curves)
        }
    }
}

/// A requested picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PictureRequest {
    /// Quantities; the usual ones if empty.
    pub quantities: Vec<String>,
    /// Abscissa; the usual one if absent.
    pub over: Option<String>,
    /// Instants, load factors or modes of curves along the beam; none for curves of the table.
    pub at: Vec<f64>,
    /// Names in the legend; those of the folders if empty.
    pub labels: Vec<String>,
    /// Least and largest abscissa.
    pub within: [Option<f64>; 2],
    /// True if all quantities share one panel.
    pub together: bool,
}

/// Panels of the requested quantities of results.
///
/// # Errors
/// A result or a quantity does not exist, or the results are of different kinds.
pub fn panels(results: &[PathBuf], asked: &PictureRequest) -> Result<Vec<QuantityPanel>> {
    let labels = labels(results, &asked.labels)?;
    let mut all: Vec<QuantityPanel> = vec![];
    let mut first: Option<(String, ResultTable)> = None;
    for (dir, label) in results.iter().zip(&labels) {
        let own = match asked.at.as_slice() {
            [] => {
                let table = ResultTable::open(dir)?;
                if let Some((name, before)) = first.as_ref().filter(|(_, before)| !before.is_like(&table)) {
                    return usage(format!(
                        "{name} has a result of `slcbeam {}`, {} one of `slcbeam {}`: results of one kind share a picture; draw them apart",
                        before.command(),
                        dir.display(),
                        table.command()
                    ));
                }
                let quantities = match asked.quantities.as_slice() {
                    [] => table.usual()?,
                    names => names.iter().map(|name| table.find(name)).collect::<Result<_>>()?,
                };
                let own = table.panels(&quantities, asked.over.as_deref(), label, asked.within)?;
                first.get_or_insert((dir.display().to_string(), table));
                own
            }
            at => {
                let usual = [profile::SHAPE.to_string()];
                let names = if asked.quantities.is_empty() {
                    &usual[..]
                } else {
                    &asked.quantities
                };
                profile::panels(dir, names, at, label)?
            }
        };
        match all.is_empty() {
            true => all = own,
            false => all
                .iter_mut()
                .zip(own)
                .for_each(|(panel, own)| panel.curves.extend(own.curves)),
        }
    }
    if asked.together {
        all = vec![together(all)?];
    }
    for panel in &mut all {
        let drawn = |curve: &NamedCurve| curve.points.iter().any(|p| p.0.is_finite() && p.1.is_finite());
        panel.curves.retain(drawn);
    }
    match all.iter().find(|panel| panel.curves.is_empty()) {
        Some(panel) => usage(format!(
            "{} over {}: nothing to draw within this range",
            panel.y.0, panel.x.0
        )),
        None => Ok(all),
    }
}

/// Names of results in the legend: given ones, or the names of the folders; empty for a single result.
fn labels(results: &[PathBuf], given: &[String]) -> Result<Vec<String>> {
    for (k, label) in given.iter().enumerate() {
        let why = match label {
            label if label.trim().is_empty() => "is empty",
            label if label.chars().any(char::is_control) => "has a line break or another control character",
            label if given[..k].contains(label) => "is the name of two results",
            _ => continue,
        };
        return usage(format!(
            "--label {label:?}: {why}; each result needs a name of its own in one line"
        ));
    }
    if !given.is_empty() && given.len() != results.len() {
        return usage(format!(
            "--label: {} for {} results; give one to each, in their order",
            given.len(),
            results.len()
        ));
    }
    if !given.is_empty() || results.len() < 2 {
        return Ok(if given.is_empty() {
            vec![String::new()]
        } else {
            given.to_vec()
        });
    }
    let names: Vec<String> = results.iter().map(|dir| name_of(dir)).collect();
    let alike = |name: &String| names.iter().filter(|other| *other == name).count() > 1 || name.is_empty();
    let full = |dir: &Path| dir.display().to_string();
    let each = names.iter().zip(results);
    Ok(each
        .map(|(name, dir)| if alike(name) { full(dir) } else { name.clone() })
        .collect())
}

/// One panel with the curves of all, named by their quantities.
fn together(all: Vec<QuantityPanel>) -> Result<QuantityPanel> {
    let mut panels = all.into_iter();
    let mut one = panels.next().ok_or_else(|| Error::Usage("nothing to draw".into()))?;
    let named = |panel: &QuantityPanel, curves: Vec<NamedCurve>| -> Vec<NamedCurve> {
        let name = |curve: NamedCurve| NamedCurve {
            label: match curve.label.as_str() {
                "" => panel.y.0.clone(),
                label => format!("{}, {label}", panel.y.0),
            },
            ..curve
        };
        curves.into_iter().map(name).collect()
    };
    let own = std::mem::take(&mut one.curves);
    one.curves = named(&one, own);
    let first = one.y.clone();
    for mut panel in panels {
        if panel.y.1 != first.1 {
            return usage(format!(
                "--together: {} has the unit {}, {} has {}; quantities of one panel have one unit",
                first.0, first.1, panel.y.0, panel.y.1
            ));
        }
        one.y.0 = String::new();
        let own = std::mem::take(&mut panel.curves);
        one.curves.extend(named(&panel, own));
    }
    Ok(one)
}

/// The drawing of panels on a sheet.
///
/// # Errors
/// The sheet is too small.
pub fn drawing(
    all: &[QuantityPanel],
    style: &PictureStyle,
    (width_mm, height_mm): (f64, Option<f64>),
) -> Result<Drawing> {
    let width = width_mm * POINTS_PER_MM / style.scale;
    let mut size = (width - 80.0, 100.0);
    let mut sheet = (width, 0.0);
    // the room for labels depends on the sizes, hardly, so that repetition converges
    for _ in 0..4 {
        let picture = picture(all, style, size);
        let free = PictureStyle {
            sheet: None,
            ..style.clone()
        };
        let (wide, high) = picture.size(&free);
        let besides = high - size.1 * all.len() as f64;
        size.0 += width - wide;
        size.1 = match height_mm {
            Some(height) => (height * POINTS_PER_MM / style.scale - besides) / all.len() as f64,
            None => (size.0 * shape_of(all)).max(longest_name(all, style)),
        };
        sheet.1 = besides + size.1 * all.len() as f64;
    }
    let height = sheet.1 * style.scale / POINTS_PER_MM;
    if height > MOST_MM {
        return usage(format!(
            "--quantity: {} panels need a height of {height:.0} mm, {MOST_MM} mm at most; draw fewer, or those of one unit with --together",
            all.len()
        ));
    }
    if size.0 < LEAST || size.1 < LEAST {
        let (side, missing) = match size.0 < LEAST {
            true => ("width", width_mm + (LEAST - size.0) * style.scale / POINTS_PER_MM),
            false => {
                let room = all.len() as f64 * (LEAST - size.1);
                ("height", (sheet.1 + room) * style.scale / POINTS_PER_MM)
            }
        };
        return usage(format!(
            "--{side}: the labels leave no room for the curves; at least {missing:.0} mm are needed, or a smaller --font-size"
        ));
    }
    let sheet = PictureStyle {
        sheet: Some((sheet.0 * style.scale, sheet.1 * style.scale)),
        ..style.clone()
    };
    let drawing = picture(all, &sheet, size).drawing(&sheet);
    drawing.ok_or_else(|| Error::Usage("nothing to draw".into()))
}

/// Height that holds the longest name of a vertical axis with its unit.
fn longest_name(all: &[QuantityPanel], style: &PictureStyle) -> f64 {
    let length = |panel: &QuantityPanel| width_of(&format!("{} [{}]mm", panel.y.0, panel.y.1), style.normal);
    all.iter().map(length).fold(0.0, f64::max)
}

/// Height of a panel relative to its width.
fn shape_of(all: &[QuantityPanel]) -> f64 {
    match all {
        [one] if one.equal => {
            let over =
                |of: fn(&(f64, f64)) -> f64| extent(one.curves.iter().flat_map(|curve| curve.points.iter().map(of)));
            let length = |range: Option<(f64, f64)>| range.map_or(0.0, |(lo, hi)| hi - lo);
            let ratio = length(over(|p| p.1)) / length(over(|p| p.0)).max(1e-300);
            ratio.clamp(0.3, 1.2)
        }
        [_] => SINGLE,
        _ => SEVERAL,
    }
}

/// The picture with frames of a size, one panel above the other.
fn picture(all: &[QuantityPanel], style: &PictureStyle, (width, height): (f64, f64)) -> Picture {
    let panels = all.iter().map(|one| {
        let ticks = |length: f64, each: f64| ((length / (each * style.small)) as usize).max(2);
        let axis = |(name, unit): &(String, String), count: usize, logarithmic: bool| {
            PictureAxis::new(name, unit, count).logarithmic(logarithmic)
        };
        let mut x = axis(&one.x, ticks(width, 5.0), one.logarithmic[0]);
        let mut y = axis(&one.y, ticks(height, 2.6), one.logarithmic[1]);
        let points = || one.curves.iter().flat_map(|curve| &curve.points);
        if one.equal {
            (x, y) = equally(x, y, points().copied(), (width, height));
        } else if let Some((lo, hi)) = extent(points().map(|p| p.0)).filter(|(lo, hi)| !one.marks && hi > lo) {
            x = x.between(lo, hi);
        }
        Panel::new((width, height), x, y, series::series(one, style))
    });
    Picture::stacked(String::new(), String::new(), panels)
}

/// Axes with one scale around all points.
fn equally(
    x: PictureAxis,
    y: PictureAxis,
    points: impl Iterator<Item = (f64, f64)> + Clone,
    (width, height): (f64, f64),
) -> (PictureAxis, PictureAxis) {
    let range = |of: fn((f64, f64)) -> f64| extent(points.clone().map(of)).unwrap_or_default();
    let (along, up) = (range(|p| p.0), range(|p| p.1));
    let length = |(lo, hi): (f64, f64)| 1.1 * (hi - lo);
    let per_unit = (length(along) / width).max(length(up) / height).max(1e-300);
    let about = |axis: PictureAxis, (lo, hi): (f64, f64), size: f64| {
        let half = 0.5 * size * per_unit;
        axis.between(0.5 * (lo + hi) - half, 0.5 * (lo + hi) + half)
    };
    (about(x, along, width), about(y, up, height))
}
