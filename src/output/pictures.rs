//! Converts recorded files to the data of each picture.

use super::arrays::ArraysWriter;
use super::envelope::Envelope;
use super::plot::{self, Deflection, Energy, HistoryPlot, PlottedCurve, Pressure};
use crate::case::{Case, CaseText};
use crate::discrete::quantities::{BeamField, FieldAxis, Observable};
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
}

impl Labels {
    /// Labels of a case.
    pub fn from_case(case: &Case) -> Self {
        Self {
            case_name: case.name.clone(),
            case: case.written(),
            frequency_hz: characteristic::forcing_period(case).map(|period| 1.0 / period),
        }
    }
}

/// Name of a picture, and its SVG.
pub type NamedSvg = (&'static str, String);

/// `history.svg` and `energy.svg`, if their columns exist, with error bands.
pub fn over_time(case: &str, history: &Envelope, band: &ErrorBand) -> Vec<NamedSvg> {
    let mut shown = HistoryPlot {
        case: case.to_string(),
        ..HistoryPlot::default()
    };
    let mut ledger = Energy {
        case: case.to_string(),
        ..Energy::default()
    };
    for (k, (name, unit)) in history.names().iter().enumerate() {
        let Some(one) = Observable::named(name) else { continue };
        let curve = || PlottedCurve {
            name: name.clone(),
            unit: unit.clone(),
            points: history.points(k),
            widths: band.column_widths(name).unwrap_or_default(),
        };
        if plot::history::belongs(one) {
            shown.curves.push(curve());
        }
        if plot::energy::belongs(one) {
            ledger.curves.push(curve());
        }
    }
    let pictures = [
        ("history.svg", plot::history::draw(&shown)),
        ("energy.svg", plot::energy::draw(&ledger)),
    ];
    present(pictures)
}

/// `deflection.svg` and `pressure.svg` over the last cycle of the drive, or over the whole run without one.
pub fn over_space(case: &str, frequency_hz: Option<f64>, arrays: &ArraysWriter) -> Result<Vec<NamedSvg>> {
    let all = arrays.times()?;
    let (span, instants) = plot::instants(&all, frequency_hz, CURVES);
    let times: Vec<f64> = instants.iter().map(|&i| all[i]).collect();
    let axis = |axis: FieldAxis| arrays.axis(axis.name()).map(<[f64]>::to_vec).unwrap_or_default();
    let integers = |x: Vec<f64>| x.into_iter().map(|x| x.round() as i64).collect();
    let deflection = Deflection {
        case: case.to_string(),
        span,
        times: times.clone(),
        theta: axis(FieldAxis::Nodes),
        u1: arrays.read(BeamField::U1.name(), &instants)?.unwrap_or_default(),
        u3: arrays.read(BeamField::U3.name(), &instants)?.unwrap_or_default(),
    };
    let pressure = Pressure {
        case: case.to_string(),
        span,
        times,
        x_f: axis(FieldAxis::Network),
        bladder: integers(axis(FieldAxis::Bladder)),
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
