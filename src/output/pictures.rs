//! Converts recorded files to the data of each picture.

use super::arrays::ArraysWriter;
use super::envelope::Envelope;
use super::plot::{self, Deflection, PlottedCurve, Pressure};
use crate::case::wiring::BladderLabels;
use crate::case::{Case, CaseText};
use crate::discrete::quantities::{BeamField, FieldAxis, Observable, PlacedNodes};
use crate::error::Result;
use crate::model::characteristic;
use crate::study::companion::band::ErrorBand;

/// Number of curves in a picture over space.
const CURVES: usize = 24;
/// Number of stretches of time kept of a history; more than the pixels across.
pub const STRETCHES: usize = 1200;

/// Data recorded in addition to the run itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Labels {
    /// Name of the case, for the pictures.
    pub case_name: String,
    /// The resolved case.
    pub case: CaseText,
    /// Frequency of the drive [Hz]; pictures over space then show its last cycle.
    pub frequency_hz: Option<f64>,
    /// Labels of beams and bladders.
    pub bladders: BladderLabels,
}

impl Labels {
    /// Labels of a case.
    pub fn from_case(case: &Case) -> Self {
        Self {
            case_name: case.name.clone(),
            case: case.written(),
            frequency_hz: characteristic::forcing_period(case).map(|period| 1.0 / period),
            bladders: BladderLabels::from_case(case),
        }
    }
}

/// Name of a picture, and its SVG.
pub type NamedSvg = (&'static str, String);

/// `history.svg` and `energy.svg`, if their columns exist, with error bands.
pub fn over_time(case: &str, history: &Envelope, band: &ErrorBand) -> Vec<NamedSvg> {
    let curve = |(k, (name, unit)): (usize, &(String, String))| PlottedCurve {
        name: name.clone(),
        unit: unit.clone(),
        points: history.points(k),
        widths: band.column_widths(name).unwrap_or_default(),
    };
    let curves = |belongs: fn(Observable) -> bool| -> Vec<PlottedCurve> {
        let all = history.names().iter().enumerate();
        let own = all.filter(|(_, (name, _))| Observable::named(name).is_some_and(belongs));
        own.map(curve).collect()
    };
    present([
        (
            "history.svg",
            plot::history::draw(case, &curves(plot::history::belongs)),
        ),
        ("energy.svg", plot::energy::draw(case, &curves(plot::energy::belongs))),
    ])
}

/// `deflection.svg` and `pressure.svg` over the last cycle of the drive, or over the whole run without one.
pub fn over_space(labels: &Labels, arrays: &ArraysWriter) -> Result<Vec<NamedSvg>> {
    let (all, case) = (arrays.times()?, &labels.case_name);
    let (span, instants) = plot::instants(&all, labels.frequency_hz, CURVES);
    let times: Vec<f64> = instants.iter().map(|&i| all[i]).collect();
    let axis = |axis: FieldAxis| arrays.axis(axis.name()).map(<[f64]>::to_vec).unwrap_or_default();
    let integers = |x: Vec<f64>| -> Vec<i64> { x.into_iter().map(|x| x.round() as i64).collect() };
    let placed = PlacedNodes::from_axes(|axis| arrays.axis(axis.name()).map(<[f64]>::to_vec));
    let deflection = Deflection {
        case: case.to_string(),
        span,
        times: times.clone(),
        theta: axis(FieldAxis::Nodes),
        u1: arrays.read(BeamField::U1.name(), &instants)?.unwrap_or_default(),
        u3: arrays.read(BeamField::U3.name(), &instants)?.unwrap_or_default(),
        structure: placed.map(|nodes| (nodes, labels.bladders.beams().map(str::to_owned).collect())),
    };
    let pressure = Pressure {
        case: case.to_string(),
        span,
        times,
        x_f: axis(FieldAxis::Network),
        bladder: integers(axis(FieldAxis::Bladder))
            .into_iter()
            .map(|number| labels.bladders.of_number(number))
            .collect(),
        network: integers(axis(FieldAxis::Array)),
        pressure: arrays.read(BeamField::Pressure.name(), &instants)?.unwrap_or_default(),
    };
    Ok(present([
        ("deflection.svg", plot::deflection::draw(&deflection)),
        ("pressure.svg", plot::pressure::draw(&pressure)),
    ]))
}

fn present<const N: usize>(pictures: [(&'static str, Option<String>); N]) -> Vec<NamedSvg> {
    pictures
        .into_iter()
        .filter_map(|(name, text)| Some((name, text?)))
        .collect()
}
