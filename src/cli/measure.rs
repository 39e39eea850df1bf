//! `slcbeam measure`: coefficients of a beam from measurements, with errors.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use clap::builder::PossibleValuesParser;
use serde_json::{Value, json};

use crate::case;
use crate::error::{Error, Result};
use crate::output::columns::table;
use crate::output::folder::replace_alike;
use crate::output::numbers::{counted, pretty_unit, significant};
use crate::output::plot::canvas::LineStyle;
use crate::output::plot::colour::{Colour, PALETTE};
use crate::output::plot::extent;
use crate::output::plot::picture::{Glyph, Panel, Picture, PictureAxis, PictureSeries};
use crate::study::measure::table;
use crate::study::measure::{Experiment, MeasureOptions, MeasuredNumber, Measurement, SIGNIFICANT, measure as fit};

/// `measure`.
#[derive(Debug, Args)]
pub struct MeasureArguments {
    /// Table (CSV) with units in its header, such as `pressure [kPa],volume [ml]`
    pub data: PathBuf,
    /// Measured quantities: the first was set, the second followed; of flow-pressure the pressure was set
    #[arg(long = "as", value_name = "EXPERIMENT", value_parser = PossibleValuesParser::new(Experiment::ALL.map(Experiment::name)))]
    pub experiment: String,
    /// The case whose sizes, modulus and fluid are those of the specimen
    #[arg(long, value_name = "CASE")]
    pub of: PathBuf,
    /// Change a value of the case, repeatable: a JSON pointer and a JSON value, such as /beam/length_m=0.12
    #[arg(long = "set", value_name = "POINTER=JSON")]
    pub sets: Vec<String>,
    /// Bladders whose volume was measured [default: those of one row]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub bladders: Option<u32>,
    /// The duct of flow-pressure is a bladder, not a tube
    #[arg(long)]
    pub through_bladder: bool,
    /// The line goes through zero: instruments have no offset
    #[arg(long)]
    pub through_zero: bool,
    /// Fit a cubic term beside the slope, which then is that at zero
    #[arg(long)]
    pub cubic: bool,
    /// Draw data, fit with its band of 95 % and residuals (SVG)
    #[arg(long, value_name = "FILE", value_parser = super::progress_line::output_path())]
    pub plot: Option<PathBuf>,
    /// Print as JSON
    #[arg(long)]
    pub json: bool,
}

/// Fits and prints the coefficients.
pub fn measure(asked: &MeasureArguments) -> Result<ExitCode> {
    let experiment = Experiment::ALL.into_iter().find(|e| e.name() == asked.experiment);
    let experiment = experiment.ok_or_else(|| Error::Usage(format!("no experiment {}", asked.experiment)))?;
    let case = case::load(&asked.of, &asked.sets)?;
    let [x, y] = experiment.columns();
    let points = table::read(&asked.data, &case::text(&asked.data)?, x, y)?;
    let options = MeasureOptions {
        through_zero: asked.through_zero,
        cubic: asked.cubic,
        bladders: asked.bladders,
        through_bladder: asked.through_bladder,
    };
    let found = fit(experiment, points, &case, options)?;
    super::answer(asked.json, || in_json(&found), || in_words(&found))?;
    if let Some(path) = &asked.plot
        && let Some(text) = picture(&found)
    {
        replace_alike(path, &text, &["<svg"])?;
    }
    Ok(ExitCode::SUCCESS)
}

/// The coefficients in the form of a case.
fn keys(found: &Measurement) -> Value {
    let mut all = json!({});
    for one in found
        .coefficients
        .iter()
        .filter(|one| !one.pointer.contains("/published/"))
    {
        let mut at = &mut all;
        for key in one.pointer.split('/').skip(1) {
            at = &mut at[key];
        }
        *at = json!(one.estimate.value);
    }
    all
}

fn estimate(of: &MeasuredNumber) -> Value {
    json!({"value": of.value, "standard_error": of.error, "interval_95": of.interval})
}

fn in_json(found: &Measurement) -> Value {
    let [_, y] = found.experiment.columns();
    let coefficients = found.coefficients.iter().map(|one| {
        let mut object = estimate(&one.estimate);
        object["unit"] = json!(one.unit);
        (one.pointer.to_owned(), object)
    });
    json!({
        "experiment": found.experiment.name(), "points": found.points.x.len(), "degrees_of_freedom": found.fit.freedom,
        "slope": estimate(&found.slope), "offset": found.offset.as_ref().map(estimate),
        "residual_deviation": {"value": found.fit.deviation, "unit": y.unit()}, "explained": found.explained,
        "cubic_chance": found.cubic_chance,
        "sides": found.sides.map(|s| json!({"chance": s.chance, "above": estimate(&s.above), "below": estimate(&s.below)})),
        "coefficients": coefficients.collect::<serde_json::Map<_, _>>(), "case": keys(found),
    })
}

/// Quotient of two units.
fn per(unit: &str, under: &str) -> String {
    let whole = |unit: &str| {
        if unit.contains([' ', '/']) {
            format!("({unit})")
        } else {
            unit.to_owned()
        }
    };
    format!("{}/{}", whole(unit), whole(under))
}

fn in_words(found: &Measurement) -> String {
    let [x, y] = found.experiment.columns();
    let line = |name: &str, of: &MeasuredNumber, unit: &str| {
        let [low, high] = of.interval.map(|x| significant(x, 5));
        [
            name.to_owned(),
            significant(of.value, 5),
            significant(of.error, 2),
            format!("{low} to {high}"),
            unit.to_owned(),
        ]
    };
    let mut lines = vec![line("slope", &found.slope, &per(y.unit(), x.unit()))];
    lines.extend(found.offset.as_ref().map(|offset| line("offset", offset, y.unit())));
    let key = |pointer: &'static str| pointer.trim_start_matches('/');
    lines.extend(
        found
            .coefficients
            .iter()
            .map(|one| line(key(one.pointer), &one.estimate, one.unit)),
    );
    let chance = |p: f64| {
        if p < 1e-4 {
            "below 1e-4".to_owned()
        } else {
            significant(p, 2)
        }
    };
    let verdict = |p: f64| {
        if p < SIGNIFICANT {
            "significantly different"
        } else {
            "not significantly different"
        }
    };
    let mut text = format!(
        "{}: {}, {} over {}; residuals of {} {}, R² {}\n\n{}\n",
        found.experiment.name(),
        counted(found.points.x.len() as u64, "point"),
        y.name(),
        x.name(),
        significant(found.fit.deviation, 3),
        y.unit(),
        significant(found.explained, 6),
        table("< | value | standard error | 95 % | <unit", lines)
    );
    if let Some(p) = found.cubic_chance {
        text += &format!("cubic term {} from zero (p {})\n", verdict(p), chance(p));
    }
    if let Some(sides) = &found.sides {
        let [above, below] = [sides.above, sides.below].map(|side| significant(side.value, 5));
        let verdict = verdict(sides.chance);
        text += &format!(
            "slopes above zero, {above}, and below, {below}, are {verdict} (p {})\n",
            chance(sides.chance)
        );
    }
    let chances = [found.cubic_chance, found.sides.map(|s| s.chance)]
        .into_iter()
        .flatten();
    if chances.fold(1.0, f64::min) < SIGNIFICANT {
        text += "the data do not follow a straight line: use smaller loads, or --cubic for the slope at zero\n";
    }
    text + &format!("\nin the case:\n{:#}\n", keys(found))
}

/// Data, fit with its band of 95 %, and residuals.
fn picture(found: &Measurement) -> Option<String> {
    /// Points of the curve.
    const COUNT: usize = 100;
    const BAND: Colour = Colour(0xd5, 0xe3, 0xf0);
    let (xs, ys) = (&found.points.x, &found.points.y);
    let (low, high) = extent(xs.iter().copied()).filter(|_| xs.len() > 1)?;
    let places = (0..=COUNT).map(|k| low + (high - low) * k as f64 / COUNT as f64);
    let fit: Vec<_> = places.map(|x| (x, found.at(x)[0], found.at(x)[1])).collect();
    let about = found.coefficients.first().map_or_else(String::new, |one| {
        let [value, error] =
            [(one.estimate.value, 5), (one.estimate.error, 2)].map(|(x, digits)| significant(x, digits));
        let name = one.pointer.splitn(3, '/').last().unwrap_or_default();
        format!("{name} = {value} ± {error} {}", pretty_unit(one.unit))
    });
    let [x, y] = found.experiment.columns();
    let x = PictureAxis::new(x.name(), x.unit(), 7);
    let panel = |height: f64, name: &str, ticks: usize, about_fit: f64, values: &[f64]| {
        let band: Vec<_> = fit
            .iter()
            .map(|(x, y, half)| (*x, about_fit * y - half, about_fit * y + half))
            .collect();
        let rings = xs.iter().copied().zip(values.iter().copied());
        let series = vec![
            PictureSeries::band(&band, BAND),
            PictureSeries::marks(rings, Glyph::Ring(2.6, 1.1), PALETTE[1]),
        ];
        Panel::new(
            (520.0, height),
            x.clone(),
            PictureAxis::new(name, y.unit(), ticks),
            series,
        )
    };
    let mut data = panel(280.0, y.name(), 7, 1.0, ys);
    let line = fit.iter().map(|(x, y, _)| (*x, *y));
    data.series
        .insert(1, PictureSeries::line(line, LineStyle::solid(PALETTE[0], 1.6)));
    let residuals = panel(130.0, "residual", 4, 0.0, &found.fit.residuals);
    Picture::stacked(found.experiment.name().to_owned(), about, [data, residuals]).svg()
}
