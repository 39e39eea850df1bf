//! What stability leaves behind: `floquet.csv`, `floquet.json`, `floquet.svg` of one case, `map.csv`, `map.json`, `map.svg` of
//! a map, and their words.

use std::fmt::Write as _;
use std::path::PathBuf;

use super::columns::{aligned, cells, warnings};
use super::folder::ResultFolder;
use super::numbers::{counted, shortest, significant};
use super::plot::multipliers::{self, Dot, Multipliers};
use super::plot::tongue::{self, Tongue, TonguePanel};
use super::records;
use crate::error::Result;
use crate::results;
use crate::results::cycles::{Cycle, Floquet, Map};
use crate::study::refine::meshes::Meshes;

/// The text of `floquet.csv`: one row a multiplier.
pub fn csv(floquet: &Floquet) -> String {
    let headings = "real part [1],imaginary part [1],modulus [1],growth rate [1/s],frequency [Hz],part,share of energy [1],\
                    numerical damping [1/s],residual [1]";
    let rows = floquet.multipliers.iter().map(|m| {
        let mut row = [m.re, m.im, m.modulus, m.growth_per_s, m.frequency_hz]
            .map(shortest)
            .to_vec();
        row.push(m.part.to_string());
        row.extend([m.share, m.numerical_damping_per_s, m.residual].map(shortest));
        row
    });
    records::text(headings.split(','), rows)
}

/// The table and the verdict.
pub fn words(found: &Cycle) -> String {
    let Floquet {
        multipliers,
        conserved,
        verdict,
        period_s,
        ..
    } = &found.floquet;
    let mut text = format!(
        "{}: period {} s, {}\n\n",
        found.case,
        significant(*period_s, 6),
        counted(found.cycle.steps_per_period as u64, "step")
    );
    let headings = cells::<7>(" | multiplier | modulus | growth [1/s] | frequency [Hz] | by steps [1/s] | part");
    let mut lines = vec![headings.map(String::from)];
    lines.extend(multipliers.iter().map(|m| {
        [
            String::new(),
            if m.im > 0.0 {
                format!("{:.6} ± {:.6} i", m.re, m.im)
            } else {
                format!("{:.6}", m.re)
            },
            format!("{:.6}", m.modulus),
            format!("{:.5}", m.growth_per_s),
            format!("{:.4}", m.frequency_hz),
            format!("{:.1e}", -m.numerical_damping_per_s),
            format!("{} ({:.0} %)", m.part, 100.0 * m.share),
        ]
    }));
    text += &aligned(&lines, &[1, 6]);
    if let Some(periods) = &found.periods {
        let _ = writeln!(text, "\n{}", periods.words());
    }
    if *conserved == 1 {
        text += "\nleft out: the multiplier 1 of a conserved volume\n";
    } else if *conserved > 1 {
        let _ = writeln!(text, "\nleft out: the multiplier 1 of {conserved} conserved volumes");
    }
    let _ = writeln!(text, "\n{}", verdict.words);
    if let Some(refined) = &found.refined {
        let _ = writeln!(text, "\n{}", refined.words());
    }
    if let Some(accuracy) = &found.accuracy {
        let _ = write!(text, "\n{}", super::accuracy::words(accuracy));
    }
    if let Some(words) = found.meshes.as_ref().and_then(Meshes::words) {
        let _ = writeln!(text, "\n{words}");
    }
    text += &warnings(&found.warnings);
    text
}

/// Writes the files of one case into a folder.
pub fn write(folder: &mut ResultFolder, found: &Cycle) -> Result<Vec<PathBuf>> {
    let dots = found.floquet.multipliers.iter().map(|m| Dot {
        re: m.re,
        im: m.im,
        name: m.part.to_string(),
    });
    let picture = multipliers::draw(&Multipliers {
        case: found.case.clone(),
        words: found.floquet.verdict.words.clone(),
        dots: dots.collect(),
    });
    let mut files = vec![
        ("floquet.csv", csv(&found.floquet)),
        ("floquet.json", results::text(found)),
    ];
    files.extend(picture.map(|text| ("floquet.svg", text)));
    folder.fill(files)
}

/// The text of `map.csv`: one row a point.
pub fn map_csv(map: &Map) -> String {
    let headings = "permeability factor [1],frequency [Hz],amplitude [m],growth rate [1/s],real part [1],imaginary part [1],verdict";
    let mut rows = vec![];
    for sheet in &map.sheets {
        for (f, column) in map.frequencies_hz.iter().zip(&sheet.points) {
            for (a, point) in map.amplitudes_m.iter().zip(column) {
                let (re, im) = point.multiplier.unzip();
                let numbers = [
                    sheet.permeability_factor,
                    Some(*f),
                    Some(*a),
                    point.growth_per_s,
                    re,
                    im,
                ];
                let mut row = numbers.map(|x| x.map_or(String::new(), shortest)).to_vec();
                row.push(point.words.clone());
                rows.push(row);
            }
        }
    }
    records::text(headings.split(','), rows)
}

/// For each sheet the least amplitude that grows, and where.
pub fn map_words(map: &Map) -> String {
    let mut text = String::new();
    for sheet in &map.sheets {
        let name = sheet
            .permeability_factor
            .map_or("dry".into(), |f| format!("permeability factor {}", shortest(f)));
        let mut least: Option<(f64, f64)> = None;
        let (mut growing, mut missing, mut count) = (0, 0, 0);
        let mut largest = (0.0, 0.0, 0.0);
        for (f, column) in map.frequencies_hz.iter().zip(&sheet.points) {
            for (a, point) in map.amplitudes_m.iter().zip(column) {
                count += 1;
                missing += usize::from(point.growth_per_s.is_none());
                if !point.grows() {
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
pub fn write_map(folder: &mut ResultFolder, map: &Map) -> Result<Vec<PathBuf>> {
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
    let mut files = vec![("map.csv", map_csv(map)), ("map.json", results::text(map))];
    files.extend(picture.map(|text| ("map.svg", text)));
    folder.fill(files)
}
