//! `slcbeam plot`: pictures of quantities of results, as vector graphics for papers.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, ValueEnum};
use serde_json::json;

use super::progress_line::output_path;
use crate::error::{Result, usage};
use crate::output::columns;
use crate::output::folder::{name_of, replace_picture};
use crate::output::plot::pdf::PdfFont;
use crate::output::plot::style::PictureStyle;
use crate::output::quantity_plot::names::for_readers;
use crate::output::quantity_plot::table::{ResultTable, TableColumn, shell_word};
use crate::output::quantity_plot::{self, PictureRequest, QuantityPanel, profile};

/// Width of one and of two columns of a journal [mm].
const COLUMNS_MM: [f64; 2] = [85.0, 174.0];
/// Limits of width and height [mm], and of the size of texts [pt].
const SIDES_MM: std::ops::RangeInclusive<f64> = 20.0..=1000.0;
const FONT_SIZES: std::ops::RangeInclusive<f64> = 3.0..=72.0;

/// `plot`.
#[derive(Debug, Args)]
pub struct PlotArguments {
    /// Result folders of one kind; their curves are drawn over each other
    #[arg(value_name = "RESULT", required = true)]
    pub results: Vec<PathBuf>,
    /// Quantities, each in its own panel: names of columns, such as tip_u1,max_pressure [default: the usual ones of the result]
    #[arg(short, long = "quantity", value_name = "LIST", value_delimiter = ',')]
    pub quantities: Vec<String>,
    /// Print the names of all quantities instead
    #[arg(long)]
    pub list: bool,
    /// Quantity of the horizontal axis [default: time, load factor, frequency or the first varied number]
    #[arg(long, value_name = "QUANTITY", conflicts_with = "at")]
    pub over: Option<String>,
    /// Curves along the beam: instants of a run [s], load factors of an equilibrium, or numbers of modes; quantities are then shape,
    /// u1, pressure and other fields
    #[arg(long, value_name = "LIST", value_delimiter = ',', allow_negative_numbers = true)]
    pub at: Vec<f64>,
    /// Least value of the horizontal axis, in its SI unit
    #[arg(long, value_name = "NUMBER", allow_negative_numbers = true, conflicts_with = "at")]
    pub from: Option<f64>,
    /// Largest value of the horizontal axis, in its SI unit
    #[arg(long, value_name = "NUMBER", allow_negative_numbers = true, conflicts_with = "at")]
    pub to: Option<f64>,
    /// Draw all quantities in one panel
    #[arg(long)]
    pub together: bool,
    /// Name in the legend, one for each result [default: names of the folders]
    #[arg(long = "label", value_name = "TEXT")]
    pub labels: Vec<String>,
    /// Style: paper (fine lines, dashes, ticks inside, no grid) or screen
    #[arg(long, value_enum, value_name = "STYLE", default_value = "paper")]
    pub style: Style,
    /// Width as columns of a journal: 1 (85 mm) or 2 (174 mm)
    #[arg(long, value_name = "COUNT", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=2))]
    pub columns: u8,
    /// Width [mm] [default: that of --columns]
    #[arg(long, value_name = "MM", conflicts_with = "columns")]
    pub width: Option<f64>,
    /// Height [mm] [default: follows from width and number of panels]
    #[arg(long, value_name = "MM")]
    pub height: Option<f64>,
    /// Font family of an SVG; TrueType file that a PDF embeds [default: Helvetica or Arial; Liberation Sans in a PDF]
    #[arg(long, value_name = "NAME")]
    pub font: Option<String>,
    /// Size of all texts [pt]
    #[arg(long, value_name = "PT", default_value_t = 8.0)]
    pub font_size: f64,
    /// File to write; its ending, .svg or .pdf, selects the format [default: RESULT-QUANTITY.svg in the current folder]
    #[arg(short, long, value_name = "FILE", value_parser = output_path())]
    pub out: Option<PathBuf>,
    /// Replace an existing picture
    #[arg(long)]
    pub force: bool,
    /// Print what was drawn as JSON
    #[arg(long)]
    pub json: bool,
}

/// Number of characters beyond which a file name lists no further quantities.
const LONGEST_NAME: usize = 80;

/// Styles of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Style {
    /// For papers.
    Paper,
    /// As in result folders.
    Screen,
}

/// Formats of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Svg,
    Pdf,
}

/// Draws the picture and prints its path.
pub fn plot(asked: &PlotArguments) -> Result<ExitCode> {
    if asked.list {
        return list(asked);
    }
    for (name, value, limits) in [
        ("--width", asked.width, SIDES_MM),
        ("--height", asked.height, SIDES_MM),
        ("--font-size", Some(asked.font_size), FONT_SIZES),
    ] {
        if let Some(value) = value.filter(|value| !limits.contains(value)) {
            let (low, high) = limits.into_inner();
            return usage(format!("{name} {value}: expected {low} to {high}"));
        }
    }
    if let (Some(from), Some(to)) = (asked.from, asked.to)
        && from >= to
    {
        return usage(format!("--from {from} --to {to}: --from must be below --to"));
    }
    let request = PictureRequest {
        quantities: asked.quantities.clone(),
        over: asked.over.clone(),
        at: asked.at.clone(),
        labels: asked.labels.clone(),
        within: [asked.from, asked.to],
        together: asked.together,
    };
    let panels = quantity_plot::panels(&asked.results, &request)?;
    let path = asked.out.clone().unwrap_or_else(|| default_path(asked));
    let format = format_of(&path)?;
    let width = asked.width.unwrap_or(COLUMNS_MM[usize::from(asked.columns) - 1]);
    let style = match asked.style {
        Style::Paper => PictureStyle::paper(asked.font_size),
        Style::Screen => PictureStyle::screen().sized(asked.font_size),
    };
    let (style, font) = fonts(asked, format, style)?;
    let drawing = quantity_plot::drawing(&panels, &style, (width, asked.height))?;
    let bytes = match format {
        Format::Svg => drawing.svg().into_bytes(),
        Format::Pdf => drawing.pdf(&font)?,
    };
    replace_picture(&path, &bytes, asked.force)?;
    answer(asked, &path, bytes.len(), &panels, drawing.size_mm())
}

/// Style with the requested font, and the font of a PDF.
fn fonts(asked: &PlotArguments, format: Format, style: PictureStyle) -> Result<(PictureStyle, PdfFont)> {
    match (&asked.font, format) {
        (None, _) => Ok((style, PdfFont::default())),
        (Some(name), Format::Svg) => Ok((style.with_font(name), PdfFont::default())),
        (Some(file), Format::Pdf) => Ok((style, PdfFont::read(Path::new(file))?)),
    }
}

/// Format by the ending of a file.
fn format_of(path: &Path) -> Result<Format> {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    match ending.as_deref() {
        Some("svg") => Ok(Format::Svg),
        Some("pdf") => Ok(Format::Pdf),
        _ => usage(format!(
            "--out {}: expected a file that ends in .svg or .pdf",
            path.display()
        )),
    }
}

/// File in the current folder, named by result and quantity.
fn default_path(asked: &PlotArguments) -> PathBuf {
    let whole = asked.results.first().and_then(|dir| fs::canonicalize(dir).ok());
    let mut name = whole.as_deref().map_or_else(String::new, name_of);
    let mut drawn = 0;
    for quantity in &asked.quantities {
        if name.chars().count() + quantity.chars().count() > LONGEST_NAME {
            break;
        }
        drawn += 1;
        name += "-";
        name.extend(quantity.chars().map(|c| {
            if c.is_alphanumeric() || "_-.".contains(c) {
                c
            } else {
                '-'
            }
        }));
    }
    match asked.quantities.len() - drawn {
        0 => {}
        more => name += &format!("-and-{more}-more"),
    }
    PathBuf::from(format!("{name}.svg"))
}

fn answer(
    asked: &PlotArguments,
    path: &Path,
    bytes: usize,
    panels: &[QuantityPanel],
    size: [f64; 2],
) -> Result<ExitCode> {
    let [width, height] = size.map(|x| (10.0 * x).round() / 10.0);
    let value = || {
        let drawn = panels.iter().map(|panel| {
            let ((x, x_unit), (y, y_unit)) = (&panel.x, &panel.y);
            let curves: Vec<_> = panel.curves.iter().map(|curve| &curve.label).collect();
            json!({"x": x, "x_unit": x_unit, "y": y, "y_unit": y_unit, "curves": curves})
        });
        json!({"path": path, "bytes": bytes, "width_mm": width, "height_mm": height, "panels": drawn.collect::<Vec<_>>()})
    };
    let text = || {
        let named = |panel: &QuantityPanel| match panel.y.0.as_str() {
            "" => columns::joined(panel.curves.iter().map(|curve| curve.label.clone()), ", "),
            name => name.to_string(),
        };
        let drawn = columns::joined(panels.iter().map(named), "; ");
        let over = panels.first().map_or("", |panel| panel.x.0.as_str());
        let text = format!("{}: {drawn} over {over}, {width} x {height} mm\n", path.display());
        match asked.results.first() {
            Some(dir) if asked.quantities.is_empty() && asked.at.is_empty() => {
                format!("{text}other quantities: slcbeam plot {} --list\n", shell_word(dir))
            }
            _ => text,
        }
    };
    super::answer(asked.json, value, text)
}

/// Prints names, units and meanings of the quantities of the first result.
fn list(asked: &PlotArguments) -> Result<ExitCode> {
    let Some(dir) = asked.results.first() else {
        return usage("expected a result folder");
    };
    let rows: Vec<[String; 3]> = match asked.at.is_empty() {
        false => profile::names(dir)?,
        true => {
            let table = ResultTable::open(dir)?;
            let row = |column: &TableColumn| {
                let (words, unit) = for_readers(&column.name, &column.unit);
                [column.name.clone(), unit, words]
            };
            table.numbers().map(row).collect()
        }
    };
    let value = |[name, unit, words]: &[String; 3]| json!({"quantity": name, "unit": unit, "name": words});
    let text = || columns::table("<quantity | <unit | <name", &rows);
    super::answer(asked.json, || rows.iter().map(value).collect(), text)
}
