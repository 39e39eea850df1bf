//! Output files of a stability analysis, `floquet.csv`, `floquet.json` and `floquet.svg` of one case, `map.csv`, `map.json` and `map.svg`
//! of a map, and their text.

use std::f64::consts::TAU;
use std::fmt::Write as _;

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
use crate::study::stability::tongue::MapPoint;

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
        trivial,
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
    if let Some(trivial) = trivial {
        let _ = writeln!(
            text,
            "\nself-oscillation at {} Hz; left out: its trivial multiplier {:.6} (a shift in time; 1 without the error of the steps)",
            significant(1.0 / period_s, 6),
            trivial.re
        );
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
pub fn write(folder: &mut ResultFolder, found: &CycleResult) -> Result<()> {
    let files = [
        ("floquet.csv", csv(&found.floquet)),
        ("floquet.json", results::text(found)),
    ];
    folder.fill(files, [("floquet.svg", multipliers(found))])
}

/// Points of a sheet with their frequencies [Hz] and amplitudes [m].
pub fn points<'a>(map: &'a Map, sheet: &'a Sheet) -> impl Iterator<Item = (f64, f64, &'a MapPoint)> {
    let columns = map.frequencies_hz.iter().zip(&sheet.points);
    columns.flat_map(|(f, column)| {
        let lines = map.amplitudes_m.iter().zip(column);
        lines.map(|(a, point)| (*f, *a, point))
    })
}

/// Text of `map.csv`: one row per point.
pub fn map_csv(map: &Map) -> String {
    let headings = "permeability factor [1],frequency [Hz],amplitude [m],growth rate [1/s],real part [1],imaginary part [1],verdict";
    let rows = map.sheets.iter().flat_map(|sheet| {
        points(map, sheet).map(|(f, a, point)| {
            let (re, im) = point.multiplier.unzip();
            let (factor, growth) = (sheet.permeability_factor, point.growth_per_s);
            let numbers = [factor, Some(f), Some(a), growth, re, im];
            let numbers = numbers.map(|x| x.map_or(String::new(), shortest));
            numbers.into_iter().chain([point.words.clone()]).collect()
        })
    });
    records::text(headings.split(','), rows)
}

/// For each sheet the smallest amplitude that grows, and the fastest growth.
pub fn map_words(map: &Map) -> String {
    let mut text = String::new();
    for sheet in &map.sheets {
        let name = sheet
            .permeability_factor
            .map_or("dry".into(), |f| format!("permeability factor {}", shortest(f)));
        let count = points(map, sheet).count();
        let missing = points(map, sheet)
            .filter(|(.., point)| point.growth_per_s.is_none())
            .count();
        let growing = points(map, sheet).filter(|(.., point)| point.grows());
        let growing: Vec<_> = growing
            .map(|(f, a, point)| (f, a, point.growth_per_s.unwrap_or(0.0)))
            .collect();
        let least = growing.iter().min_by(|x, y| x.1.total_cmp(&y.1));
        // the first of several that grow equally fast
        let fastest = growing.iter().rev().max_by(|x, y| x.2.total_cmp(&y.2));
        let _ = match least.zip(fastest) {
            None => writeln!(text, "{name}: no point of {count} grows, {missing} without a cycle"),
            Some(((f, a, _), (at, with, rate))) => writeln!(
                text,
                "{name}: {} of {count} points grow, {missing} without a cycle; the least amplitude is {} m at {} Hz, the \
                 fastest growth {} /s at {} Hz and {} m",
                growing.len(),
                significant(*a, 3),
                significant(*f, 4),
                significant(*rate, 3),
                significant(*at, 4),
                significant(*with, 3)
            ),
        };
    }
    text
}

/// Writes the files of a map into a folder.
pub fn write_map(folder: &mut ResultFolder, map: &Map) -> Result<()> {
    let files = [("map.csv", map_csv(map)), ("map.json", results::text(map))];
    folder.fill(files, [("map.svg", tongues(map))])
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
    let all = map.sheets.iter().flat_map(|sheet| sheet.points.iter().flatten());
    let grown = all.filter_map(|point| point.growth_per_s).filter(|g| g.is_finite());
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
        let cell = |(f, a, point): (f64, f64, &MapPoint)| {
            let corners = [(f - half_x, a - half_y), (f + half_x, a + half_y)];
            PictureSeries::cell(corners, colour(point.growth_per_s))
        };
        let mut series: Vec<_> = points(map, sheet).map(cell).collect();
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
