//! Output files of a stability analysis, `floquet.csv`, `floquet.json` and `floquet.svg` of one case, `map.csv`, `map.json` and `map.svg`
//! of a map, and their text.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::PathBuf;

use super::columns::{table, warnings};
use super::folder::ResultFolder;
use super::numbers::{counted, shortest, significant};
use super::plot::canvas::{INK, LineStyle};
use super::plot::colour::{self, Colour, PALETTE};
use super::plot::picture::{ColourBar, Glyph, Panel, Picture, PictureAxis, PictureSeries};
use super::records;
use crate::error::Result;
use crate::results;
use crate::results::cycles::{CycleResult, Floquet, Map};
use crate::study::refine::meshes::Meshes;
use crate::study::stability::Sheet;

/// Text of `floquet.csv`: one row per multiplier.
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

/// Table of the multipliers, and the verdict.
pub fn describe(found: &CycleResult) -> String {
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
    let rows = multipliers.iter().map(|m| {
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
    });
    let headings = " | <multiplier | modulus | growth [1/s] | frequency [Hz] | by steps [1/s] | <part";
    text += &table(headings, rows);
    if let Some(periods) = &found.periods {
        let _ = writeln!(text, "\n{}", periods.describe());
    }
    if *conserved == 1 {
        text += "\nleft out: the multiplier 1 of a conserved volume\n";
    } else if *conserved > 1 {
        let _ = writeln!(text, "\nleft out: the multiplier 1 of {conserved} conserved volumes");
    }
    let _ = writeln!(text, "\n{}", verdict.words);
    if let Some(refined) = &found.refined {
        let _ = writeln!(text, "\n{}", refined.describe());
    }
    if let Some(accuracy) = &found.accuracy {
        let _ = write!(text, "\n{}", super::accuracy::describe(accuracy));
    }
    if let Some(words) = found.meshes.as_ref().and_then(Meshes::describe) {
        let _ = writeln!(text, "\n{words}");
    }
    text += &warnings(&found.warnings);
    text
}

/// Writes the files of one case into a folder.
pub fn write(folder: &mut ResultFolder, found: &CycleResult) -> Result<Vec<PathBuf>> {
    let mut files = vec![
        ("floquet.csv", csv(&found.floquet)),
        ("floquet.json", results::text(found)),
    ];
    files.extend(multipliers(found).map(|text| ("floquet.svg", text)));
    folder.fill(files)
}

/// Text of `map.csv`: one row per point.
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

/// For each sheet the smallest amplitude that grows, and the fastest growth.
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
    let mut files = vec![("map.csv", map_csv(map)), ("map.json", results::text(map))];
    files.extend(tongues(map).map(|text| ("map.svg", text)));
    folder.fill(files)
}

/// Largest number of multipliers named in the picture.
const NAMED: usize = 6;

/// Picture of the multipliers and the unit circle.
fn multipliers(found: &CycleResult) -> Option<String> {
    let all = &found.floquet.multipliers;
    let reach = 1.15 * all.first()?.modulus.max(1.0);
    let circle = (0..=180)
        .map(|k| f64::from(k) * TAU / 180.0)
        .map(|a| (a.cos(), a.sin()));
    let mut series = vec![PictureSeries::line(
        circle,
        LineStyle::solid(Colour(0x6b, 0x72, 0x7a), 1.2),
    )];
    for (k, m) in all.iter().enumerate() {
        let colour = if m.modulus > 1.0 { UNSTABLE } else { PALETTE[0] };
        let dots = PictureSeries::marks(
            [(m.re, m.im), (m.re, -m.im)],
            Glyph::Polygon(3.6, 16, 0.0, true),
            colour,
        );
        let im = if m.im > 0.0 {
            format!(" ± {:.4} i", m.im)
        } else {
            String::new()
        };
        let value = format!("{:.4}{im}", m.re).replacen('-', "−", 1);
        let name = if k < NAMED {
            format!("{}\n{value}", m.part)
        } else {
            String::new()
        };
        series.push(dots.named(name));
    }
    let axis = |name: &str| PictureAxis::new(name, "1", 6).between(-reach, reach);
    let panel = Panel {
        legend_beside: true,
        ..Panel::new((420.0, 420.0), axis("real part"), axis("imaginary part"), series)
    };
    let title = format!("{} · Floquet multipliers", found.case);
    Picture::stacked(title, &*found.floquet.verdict.words, [panel]).svg()
}

/// Fraction of the largest growth below which a point is drawn as stable.
const NOTHING: f64 = 2e-3;
const UNSTABLE: Colour = Colour(0xb5, 0x2b, 0x2b);
const STABLE: Colour = Colour(0xee, 0xf2, 0xf6);
const MISSING: Colour = Colour(0xc9, 0xcd, 0xd2);

/// Picture of the growth over frequency and amplitude of the shaking, one panel per permeability; dashed: Mathieu's equation.
fn tongues(map: &Map) -> Option<String> {
    let range = |all: &[f64]| {
        let (first, last) = (*all.first()?, *all.last()?);
        Some((first, last, 0.5 * (last - first) / (all.len() - 1).max(1) as f64))
    };
    let (across, up) = (range(&map.frequencies_hz)?, range(&map.amplitudes_m)?);
    let points = map.sheets.iter().flat_map(|sheet| sheet.points.iter().flatten());
    let grown = points.filter_map(|point| point.growth_per_s).filter(|g| g.is_finite());
    let most = grown.fold(0.0, f64::max);
    let colour = |growth: Option<f64>| match growth {
        None => MISSING,
        Some(g) if g > NOTHING * most && most > 0.0 => colour::of_growth(g / most),
        Some(_) => STABLE,
    };
    let axis = |name: &str, unit: &str, (first, last, half): (f64, f64, f64)| {
        PictureAxis::new(name, unit, 6).between(first - half, last + half)
    };
    let (x, y) = (axis("frequency", "Hz", across), axis("amplitude", "m", up));
    let (half_x, half_y) = (across.2, up.2);
    let panel = |(k, sheet): (usize, &Sheet)| {
        let mut series = vec![];
        for (f, column) in map.frequencies_hz.iter().zip(&sheet.points) {
            for (a, point) in map.amplitudes_m.iter().zip(column) {
                let corners = [(f - half_x, a - half_y), (f + half_x, a + half_y)];
                series.push(PictureSeries::cell(corners, colour(point.growth_per_s)));
            }
        }
        let within = |a: f64| if a <= up.1 + half_y { a } else { f64::NAN };
        let onset = map
            .mathieu
            .iter()
            .flat_map(|m| map.frequencies_hz.iter().zip(&m.onset_m));
        let dashed = LineStyle::dashed(INK, 1.4, (5.0, 3.0));
        series.push(PictureSeries::line(onset.map(|(f, a)| (*f, within(*a))), dashed));
        let inside = |value: f64, (first, last, half): (f64, f64, f64)| (first - half..=last + half).contains(&value);
        let own = (inside(map.own.0, across) && inside(map.own.1, up)).then_some(map.own);
        series.push(PictureSeries::marks(own, Glyph::Ring(5.0, 1.8), PALETTE[0]));
        let name = sheet
            .permeability_factor
            .map_or("dry".into(), |f| format!("permeabilities × {}", shortest(f)));
        let bar = (k + 1 == map.sheets.len()).then(|| ColourBar {
            colours: colour::scale(colour::of_growth),
            axis: PictureAxis::new("growth", "1/s", 5).between(0.0, most),
            besides: Some((STABLE, "stable".into())),
        });
        Panel {
            bar,
            ..Panel::new((330.0, 300.0), x.clone(), y.clone(), series).headed(name)
        }
    };
    Picture {
        title: format!("{} · shaken along its axis", map.case),
        about: "growth rate of the largest disturbance; dashed: principal tongue of Mathieu's equation, first mode, dry; ring: the case".into(),
        rows: vec![map.sheets.iter().enumerate().map(panel).collect()],
    }
    .svg()
}
