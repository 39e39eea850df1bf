//! Shapes of a response, as stored.

use nalgebra::Complex;

use crate::discrete::quantities::{FieldAxis, PlacedNodes};
use crate::error::Result;
use crate::results::response::{ResponseShape, ResponseShapes};
use crate::run::modes::ModeShape;
use crate::study::response::BandResponse;

/// Relative distance of two peaks that share a shape, and largest number of shapes.
const SHARED: f64 = 1e-3;
const MOST_SHAPES: usize = 60;

/// Shapes at requested frequencies [Hz] and at peaks.
///
/// # Errors
/// The computation was interrupted.
pub fn shapes(found: &BandResponse, frequencies: &[f64]) -> Result<Option<ResponseShapes>> {
    let mut all = frequencies.to_vec();
    for peak in found.curves.iter().flat_map(|curve| &curve.peaks) {
        let hz = peak.frequency_hz;
        if all.iter().all(|other| (other - hz).abs() > SHARED * hz) {
            all.push(hz);
        }
    }
    all.truncate(MOST_SHAPES);
    all.sort_by(f64::total_cmp);
    let computed = found.response.shapes(&all)?;
    let parts = |values: &[Complex<f64>]| {
        let digits = |part: fn(&Complex<f64>) -> f64| values.iter().map(|value| rounded(part(value))).collect();
        [digits(|value| value.re), digits(|value| value.im)]
    };
    let shape = |(hz, shape): (&f64, Option<ModeShape>)| {
        shape.map(|shape| ResponseShape {
            frequency_hz: *hz,
            u1: parts(&shape.u1),
            u3: parts(&shape.u3),
            pressure: parts(&shape.pressure),
        })
    };
    let at: Vec<ResponseShape> = all.iter().zip(computed).filter_map(shape).collect();
    let system = found.response.about.system();
    let theta_m = FieldAxis::Nodes.values(system, 0.0).into_iter().map(rounded).collect();
    let beam = PlacedNodes::new(system).map_or_else(Vec::new, |placed| placed.beam);
    let beam = beam.into_iter().map(|beam| beam + 1).collect();
    Ok((!at.is_empty()).then_some(ResponseShapes { theta_m, beam, at }))
}

/// A number with six digits.
fn rounded(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}
