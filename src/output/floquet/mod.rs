//! What stability leaves behind: `floquet.csv`, `floquet.json`, `floquet.svg` of one case, `map.csv`, `map.json`, `map.svg` of
//! a map, and their words.

use std::fmt::Write as _;
use std::path::PathBuf;

use serde_json::json;

use super::accuracy::{with_accuracy, with_meshes, with_warnings};
use super::folder::ResultFolder;
use super::numbers::{shortest, significant};
use super::plot::multipliers::{self, Dot, Multipliers};
use super::plot::tongue::{self, Tongue, TonguePanel};
use crate::error::Result;
use crate::run::floquet::Floquet;
use crate::run::periodic::Search;
use crate::run::periodic::settle::Refined;
use crate::run::summary::Accuracy;
use crate::study::refine::meshes::Meshes;
use crate::study::stability::Map;

/// The stability of one case's cycle.
#[derive(Clone, Copy, Debug)]
pub struct Found<'a> {
    /// Name of the case.
    pub case: &'a str,
    /// How the cycle was found.
    pub search: &'a Search,
    /// Its multipliers.
    pub floquet: &'a Floquet,
    /// Estimated errors, when an accuracy was asked for.
    pub accuracy: Option<&'a Accuracy>,
    /// Why the tolerance of the cycle is not the case's own.
    pub refined: Option<&'a Refined>,
    /// What meshes do to it, where no accuracy was asked for.
    pub meshes: Option<&'a Meshes>,
    /// What to know of case and cycle.
    pub warnings: &'a [String],
}

/// The text of `floquet.json`.
pub fn json(found: &Found) -> String {
    let mut value = json!({
        "case": found.case, "cycle": found.search, "floquet": found.floquet, "warnings": found.warnings
    });
    if let (Some(object), Some(refined)) = (value.as_object_mut(), found.refined) {
        object.insert("refined".into(), serde_json::to_value(refined).unwrap_or_default());
    }
    let value = with_meshes(with_accuracy(value, found.accuracy), found.meshes);
    format!("{value:#}\n")
}

/// The text of `floquet.csv`: one row a multiplier.
pub fn csv(floquet: &Floquet) -> String {
    let mut text = String::from(
        "real part [1],imaginary part [1],modulus [1],growth rate [1/s],frequency [Hz],part,share of energy [1],numerical \
         damping [1/s],residual [1]\n",
    );
    for m in &floquet.multipliers {
        let numbers = [m.re, m.im, m.modulus, m.growth_per_s, m.frequency_hz]
            .map(shortest)
            .join(",");
        let rest = [m.share, m.numerical_damping_per_s, m.residual].map(shortest).join(",");
        let _ = writeln!(text, "{numbers},{},{rest}", m.part);
    }
    text
}

/// The table and the verdict.
pub fn words(found: &Found) -> String {
    let Floquet {
        multipliers,
        conserved,
        verdict,
        period_s,
        ..
    } = found.floquet;
    let mut text = format!(
        "{}: period {} s, {} steps\n\n  multiplier                 modulus    growth [1/s]   frequency [Hz]   by steps [1/s]   part\n",
        found.case,
        significant(*period_s, 6),
        found.search.steps_per_period
    );
    for m in multipliers {
        let value = if m.im > 0.0 {
            format!("{:.6} ± {:.6} i", m.re, m.im)
        } else {
            format!("{:.6}", m.re)
        };
        let _ = writeln!(
            text,
            "  {value:<24} {:>9.6} {:>15.5} {:>16.4} {:>16.1e}   {} ({:.0} %)",
            m.modulus,
            m.growth_per_s,
            m.frequency_hz,
            -m.numerical_damping_per_s,
            m.part,
            100.0 * m.share
        );
    }
    if *conserved == 1 {
        text += "\nleft out: the multiplier 1 of a conserved volume\n";
    } else if *conserved > 1 {
        let _ = writeln!(text, "\nleft out: the multiplier 1 of {conserved} conserved volumes");
    }
    let _ = writeln!(text, "\n{}", verdict.words);
    if let Some(refined) = found.refined {
        let _ = writeln!(text, "\n{}", refined.words());
    }
    if let Some(accuracy) = found.accuracy {
        let _ = write!(text, "\n{}", super::accuracy::words(accuracy));
    }
    if let Some(words) = found.meshes.and_then(Meshes::words) {
        let _ = writeln!(text, "\n{words}");
    }
    for warning in found.warnings {
        let _ = writeln!(text, "warning: {warning}");
    }
    text
}

/// Writes the files of one case into a folder.
pub fn write(folder: &mut ResultFolder, found: &Found) -> Result<Vec<PathBuf>> {
    let dots = found.floquet.multipliers.iter().map(|m| Dot {
        re: m.re,
        im: m.im,
        name: m.part.to_string(),
    });
    let picture = multipliers::draw(&Multipliers {
        case: found.case.into(),
        words: found.floquet.verdict.words.clone(),
        dots: dots.collect(),
    });
    let mut files = vec![("floquet.csv", csv(found.floquet)), ("floquet.json", json(found))];
    files.extend(picture.map(|text| ("floquet.svg", text)));
    folder.fill(files)
}

/// The text of `map.json`, with what to know of the case.
pub fn map_json(map: &Map, warnings: &[String]) -> String {
    let value = with_warnings(serde_json::to_value(map).unwrap_or_default(), warnings);
    format!("{value:#}\n")
}

/// The text of `map.csv`: one row a point.
pub fn map_csv(map: &Map) -> String {
    let mut text = String::from(
        "permeability factor [1],frequency [Hz],amplitude [m],growth rate [1/s],real part [1],imaginary part [1],verdict\n",
    );
    for sheet in &map.sheets {
        for (f, column) in map.frequencies_hz.iter().zip(&sheet.points) {
            for (a, point) in map.amplitudes_m.iter().zip(column) {
                let number = |x: Option<f64>| x.map_or(String::new(), shortest);
                let _ = writeln!(
                    text,
                    "{},{},{},{},{},{},\"{}\"",
                    number(sheet.permeability_factor),
                    shortest(*f),
                    shortest(*a),
                    number(point.growth_per_s),
                    number(point.multiplier.map(|m| m.0)),
                    number(point.multiplier.map(|m| m.1)),
                    point.words.replace('"', "'")
                );
            }
        }
    }
    text
}

/// For each sheet the least amplitude that grows, and where.
pub fn map_words(map: &Map) -> String {
    let mut text = String::new();
    for sheet in &map.sheets {
        let name = sheet
            .permeability_factor
            .map_or("dry".into(), |f| format!("permeability factor {}", shortest(f)));
        let grows = |growth: Option<f64>| growth.is_some_and(|g| g > 0.0);
        let mut least: Option<(f64, f64)> = None;
        let (mut growing, mut missing, mut count) = (0, 0, 0);
        let mut largest = (0.0, 0.0, 0.0);
        for (f, column) in map.frequencies_hz.iter().zip(&sheet.points) {
            for (a, point) in map.amplitudes_m.iter().zip(column) {
                count += 1;
                missing += usize::from(point.growth_per_s.is_none());
                if !grows(point.growth_per_s) || point.words.starts_with("neutral") {
                    continue;
                }
                growing += 1;
                if least.is_none_or(|(_, before)| *a < before) {
                    least = Some((*f, *a));
                }
                let rate = point.growth_per_s.unwrap_or(0.0);
                if rate > largest.2 {
                    largest = (*f, *a, rate);
                }
            }
        }
        let _ = match least {
            None => writeln!(text, "{name}: no point of {count} grows, {missing} without a cycle"),
            Some((f, a)) => writeln!(
                text,
                "{name}: {growing} of {count} points grow, {missing} without a cycle; the least amplitude is {} m at {} Hz, the \
                 fastest growth {} /s at {} Hz and {} m",
                significant(a, 3),
                significant(f, 4),
                significant(largest.2, 3),
                significant(largest.0, 4),
                significant(largest.1, 3)
            ),
        };
    }
    text
}

/// Writes the files of a map into a folder.
pub fn write_map(folder: &mut ResultFolder, map: &Map, warnings: &[String]) -> Result<Vec<PathBuf>> {
    let panels = map.sheets.iter().map(|sheet| TonguePanel {
        name: sheet
            .permeability_factor
            .map_or("dry".into(), |f| format!("permeabilities × {}", shortest(f))),
        growth: sheet
            .points
            .iter()
            .map(|column| column.iter().map(|p| p.growth_per_s).collect())
            .collect(),
    });
    let picture = tongue::draw(&Tongue {
        case: map.case.clone(),
        frequencies: map.frequencies_hz.clone(),
        amplitudes: map.amplitudes_m.clone(),
        onset: map.mathieu.as_ref().map(|m| m.onset_m.clone()),
        own: map.own,
        panels: panels.collect(),
    });
    let mut files = vec![("map.csv", map_csv(map)), ("map.json", map_json(map, warnings))];
    files.extend(picture.map(|text| ("map.svg", text)));
    folder.fill(files)
}
