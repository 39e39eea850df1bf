//! Resolution of functions of the place in spans.

use crate::case::schema::{Case, Span, SpanLengths};
use crate::functions::Profile;

/// Points of a span in integrals that count as exact, and those of one of its segments.
const FINE: usize = 65_536;
const PER_SEGMENT: [usize; 2] = [64, 1024];

/// A value of the solid that varies within a span.
pub(super) struct Taper<'a> {
    profile: &'a Profile,
    /// Number of segments of the span.
    segments: usize,
    /// Power of the value in the compliance or mass of a section.
    power: i32,
    /// JSON pointer.
    pub pointer: String,
    /// Integral over each segment.
    exact: Vec<f64>,
}

/// Description of the lost quantity.
pub(super) const WHAT: &str = "the compliance or mass of a part of the span";

impl<'a> Taper<'a> {
    /// Varying values of all spans. Straight ones are resolved as smooth ones are.
    pub fn all(case: &'a Case) -> Vec<Self> {
        let counts = SpanLengths::new(case).counts;
        let spans = case.spans.iter().zip(counts).enumerate();
        let of = |(k, (span, segments)): (usize, (&'a Span, Option<usize>))| {
            let curved = |profile: &Profile| profile.uniform().is_none() && !matches!(profile, Profile::Linear(_));
            let given = span.beam.given().filter(move |(_, profile)| curved(profile));
            given.filter_map(move |(key, profile)| {
                let power = match key {
                    "height_m" => -3,
                    "density_kg_m3" | "mass_factor" => 1,
                    "neutral_axis_m" | "reference_axis_m" => return None,
                    _ => -1,
                };
                let mut one = Self {
                    profile,
                    segments: segments?,
                    power,
                    pointer: format!("/spans/{k}/beam/{key}"),
                    exact: vec![],
                };
                let points = (FINE / one.segments.max(1)).clamp(PER_SEGMENT[0], PER_SEGMENT[1]);
                one.exact = (0..one.segments).map(|j| one.integral(j, points, 0.5)).collect();
                Some(one)
            })
        };
        spans.flat_map(of).collect()
    }

    /// Mean over a segment from points in the middle of `parts` equal parts, or elsewhere in them.
    fn integral(&self, segment: usize, parts: usize, place: f64) -> f64 {
        let at = |part: usize| {
            let x = (segment as f64 + (part as f64 + place) / parts as f64) / self.segments as f64;
            self.profile.value(x).powi(self.power)
        };
        (0..parts).map(at).sum::<f64>() / parts as f64
    }

    /// Error of nodes and of cells, relative to the integral over the span; a part near a clamp counts three times its share.
    pub fn left_out(&self, cells: usize) -> f64 {
        let whole: f64 = self.exact.iter().sum();
        let error = |place: f64| {
            let each = self.exact.iter().enumerate();
            each.map(|(j, exact)| {
                let at_ends = [place, 1.0 - place].map(|place| self.integral(j, cells, place));
                (0.5 * (at_ends[0] + at_ends[1]) - exact).abs()
            })
            .sum::<f64>()
        };
        3.0 * error(0.0).max(error(0.5)) / whole
    }
}
