//! Parts of the beam with values of their own.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use slcbeam_section::input::Section;

use super::{AreaPerForce, AreaPerMoment, Case, Damping, MomentCurvature, given};
use crate::case::numbers::rounded;
use crate::functions::profile::Profile;

/// Relative deviation of a span's length from whole segments that counts as rounding.
const WHOLE: f64 = 1e-6;

/// Relative deviation of lengths that counts as rounding of decimal fractions.
pub const ROUNDING: f64 = 1e-9;

/// A part of the beam with values of its own, a whole number of segments. Values that it does not give are those of `beam` and
/// `bladders`. Coefficients that it does not give follow its modulus and sizes by the scaling laws of their section.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Span {
    /// Length [m]; absent in one span: the rest of the beam.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub length_m: Option<f64>,
    /// Number of its segments, which share its length equally; absent: segments as long as in all spans without this number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 1000000))]
    pub segments: Option<usize>,
    /// Section of the span by its geometry. The span does not give sizes, material, coefficients and rows itself: they are computed from
    /// this unit cell, as in `/section`. The pitch of bladders determines the number of segments.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub section: Option<Section>,
    /// Rows that have bladders here. Without bladders the section is full: its factors of mass and stiffness are 1 unless given.
    #[serde(default, skip_serializing_if = "SpanRows::is_both")]
    pub rows: SpanRows,
    /// Values of the solid.
    #[serde(default, skip_serializing_if = "SpanBeam::is_empty")]
    pub beam: SpanBeam,
    /// Values of the bladders.
    #[serde(default, skip_serializing_if = "SpanBladders::is_empty")]
    pub bladders: SpanBladders,
}

impl Span {
    /// Lengths, numbers of segments, rows and readable sections of the spans of a case in JSON; none if another of these is unreadable.
    pub fn outlines(case: &Value) -> Vec<Self> {
        let read = |span: &Value| {
            let keys = ["length_m", "segments", "rows", "section"];
            let outline = keys
                .into_iter()
                .filter_map(|key| Some((key.to_owned(), span.get(key)?.clone())));
            let mut outline: Map<String, Value> = outline.collect();
            Self::deserialize(&Value::Object(outline.clone())).or_else(|_| {
                outline.shift_remove("section");
                Self::deserialize(Value::Object(outline))
            })
        };
        let spans = case.get("spans").and_then(Value::as_array);
        let spans: Result<_, _> = spans.into_iter().flatten().map(read).collect();
        spans.unwrap_or_default()
    }

    /// Length of each span of a beam of this length [m].
    pub fn lengths(spans: &[Self], total: f64) -> Vec<f64> {
        let given: f64 = spans.iter().filter_map(|span| span.length_m).sum();
        spans
            .iter()
            .map(|span| span.length_m.unwrap_or(total - given))
            .collect()
    }

    /// Given values that are functions of the place, with the key of their part and their own.
    pub fn given(&self) -> impl Iterator<Item = (&'static str, &'static str, &Profile)> {
        let in_beam = self.beam.given().map(|(key, profile)| ("beam", key, profile));
        in_beam.chain(self.bladders.given().map(|(key, profile)| ("bladders", key, profile)))
    }
}

/// Rows that have bladders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SpanRows {
    /// The upper and the lower row.
    #[default]
    Both,
    /// The upper row only.
    Upper,
    /// The lower row only.
    Lower,
    /// No row.
    None,
}

impl SpanRows {
    /// True for the upper and the lower row.
    pub fn has(self) -> [bool; 2] {
        [
            matches!(self, Self::Both | Self::Upper),
            matches!(self, Self::Both | Self::Lower),
        ]
    }

    fn is_both(&self) -> bool {
        *self == Self::Both
    }
}

/// Values of the solid in a span, as in `beam`. Each but the law of the moment is a number, or a function of the place within the span from
/// 0 to 1, which is evaluated at the nodes and cells of the mesh.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpanBeam {
    /// Height of the cross-section [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height_m: Option<Profile>,
    /// Width of the cross-section [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width_m: Option<Profile>,
    /// Young's modulus [Pa].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub young_modulus_pa: Option<Profile>,
    /// Density of the solid [kg/m^3].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density_kg_m3: Option<Profile>,
    /// `f_e`: axial stiffness over that of the full section.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axial_stiffness_factor: Option<Profile>,
    /// `f_i`: bending stiffness over that of the full section.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bending_stiffness_factor: Option<Profile>,
    /// Moment over curvature; absent: that of the beam, which follows the modulus and sizes of the span.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moment_curvature: Option<MomentCurvature>,
    /// `z_n`: height of the neutral axis above mid-height [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub neutral_axis_m: Option<Profile>,
    /// `z_r`: height of the beam's line above mid-height; absent: that of the beam [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference_axis_m: Option<Profile>,
    /// `kGA` [N]; only for beams that shear.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shear_stiffness_n: Option<Profile>,
    /// `f_m`: mass over that of a full section of the solid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass_factor: Option<Profile>,
    /// Damping of the material.
    #[serde(default, skip_serializing_if = "SpanDamping::is_empty")]
    pub damping: SpanDamping,
}

/// Damping of the material of a span, as in `/beam/damping`; the drag is that of the whole beam.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpanDamping {
    /// `tau_a`: `N_total = N + EA tau_a d(lambda)/dt` [s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub axial_time_s: Option<f64>,
    /// `tau_b`: `M_total = M + EI tau_b d(kappa)/dt` [s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub bending_time_s: Option<f64>,
}

impl SpanDamping {
    fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Sets the given times of a beam.
    pub fn apply(&self, damping: &mut Damping) {
        damping.axial_time_s = self.axial_time_s.unwrap_or(damping.axial_time_s);
        damping.bending_time_s = self.bending_time_s.unwrap_or(damping.bending_time_s);
    }
}

impl SpanBeam {
    /// Given values, with their keys.
    pub fn given(&self) -> impl Iterator<Item = (&'static str, &Profile)> {
        given([
            ("height_m", &self.height_m),
            ("width_m", &self.width_m),
            ("young_modulus_pa", &self.young_modulus_pa),
            ("density_kg_m3", &self.density_kg_m3),
            ("axial_stiffness_factor", &self.axial_stiffness_factor),
            ("bending_stiffness_factor", &self.bending_stiffness_factor),
            ("neutral_axis_m", &self.neutral_axis_m),
            ("reference_axis_m", &self.reference_axis_m),
            ("shear_stiffness_n", &self.shear_stiffness_n),
            ("mass_factor", &self.mass_factor),
        ])
    }

    fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// Values of the bladders in a span, as in `bladders`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpanBladders {
    /// Height of the bladders [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height_m: Option<Profile>,
    /// Width of the bladders, along the beam [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width_m: Option<Profile>,
    /// `a_p`: area per pressure [m^2/Pa].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub area_per_pressure_m2_per_pa: Option<Profile>,
    /// `a_x`: area per pressure of the other bladder of the segment [m^2/Pa]; only where both rows have bladders.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub area_per_other_pressure_m2_per_pa: Option<Profile>,
    /// `q1b`: permeability [m^4].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub permeability_m4: Option<Profile>,
    /// Area per bending moment [m^2/(N m)].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub area_per_moment_m2_per_n_m: Option<AreaPerMoment>,
    /// Area per normal force [m^2/N].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub area_per_force_m2_per_n: Option<AreaPerForce>,
}

impl SpanBladders {
    /// Given values that are functions of the place, with their keys.
    fn given(&self) -> impl Iterator<Item = (&'static str, &Profile)> {
        given([
            ("height_m", &self.height_m),
            ("width_m", &self.width_m),
            ("area_per_pressure_m2_per_pa", &self.area_per_pressure_m2_per_pa),
            (
                "area_per_other_pressure_m2_per_pa",
                &self.area_per_other_pressure_m2_per_pa,
            ),
            ("permeability_m4", &self.permeability_m4),
        ])
    }

    /// True if the span gives no value.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// Lengths of the spans of a beam and of their segments.
#[derive(Clone, Debug, PartialEq)]
pub struct SpanLengths {
    /// Length of each span [m]: its own, or the rest of the beam.
    pub lengths: Vec<f64>,
    /// Number of segments of each span; none for a length that is not a whole number of segments, or if nothing is left for a span.
    pub counts: Vec<Option<usize>>,
    /// Length of the segments to which the coefficients of the case belong [m]: those of spans that give no number of them; if all spans
    /// give it, those of the first span with bladders, if possible without a section of its own.
    pub pitch: f64,
    /// Segments left for spans that give no number of them.
    pub left: usize,
}

impl SpanLengths {
    /// Lengths of a case with an allowed number of segments.
    pub fn new(case: &Case) -> Self {
        Self::resolve(&case.spans, case.beam.length_m, case.segments())
    }

    /// Lengths of the spans of a beam of this length [m] with an allowed number of segments.
    pub fn resolve(spans: &[Span], total: f64, segments: usize) -> Self {
        let lengths = Span::lengths(spans, total);
        let (counted, rest) = counted_and_rest(spans, total);
        let left = segments.saturating_sub(counted);
        let mixed = counted > 0 && spans.iter().any(|span| span.segments.is_none());
        let with_bladders = spans.iter().position(of_case).or(spans.iter().position(has_bladders));
        let with_bladders = with_bladders.unwrap_or(0);
        let first = spans
            .get(with_bladders)
            .and_then(|span| Some(lengths[with_bladders] / span.segments? as f64));
        let equal = total / segments as f64;
        let pitch = match first {
            _ if mixed => rest / left as f64,
            Some(first) if (first - equal).abs() > ROUNDING * equal => first,
            _ => equal,
        };
        let whole = |length: f64| {
            let count = (length / pitch).round();
            let fits = count >= 1.0 && count <= left as f64;
            (fits && (length / pitch - count).abs() <= WHOLE * count).then_some(count as usize)
        };
        let count = |(span, length): (&Span, &f64)| match span.segments {
            Some(count) => (*length > 0.0).then_some(count),
            None => whole(*length),
        };
        let counts = spans.iter().zip(&lengths).map(count).collect();
        Self {
            lengths,
            counts,
            pitch,
            left,
        }
    }

    /// Length of the segments of a span [m]; that of the case if both differ by rounding.
    pub fn pitch_of(&self, span: usize) -> f64 {
        let own = self.counts[span].map(|count| self.lengths[span] / count as f64);
        let own = own.filter(|own| (own - self.pitch).abs() > ROUNDING * self.pitch);
        own.unwrap_or(self.pitch)
    }
}

/// Number of segments of a beam of this length [m], of which those without a number of their own have this pitch [m]; `given` is the number
/// that the case gives.
///
/// # Errors
/// Explains lengths that do not fit.
pub fn segments_of_pitch(spans: &[Span], length: f64, given: Option<f64>, pitch: f64) -> Result<u64, String> {
    let (counted, rest) = counted_and_rest(spans, length);
    if counted > 0 && spans.iter().all(|span| span.segments.is_some()) {
        let own = SpanLengths::resolve(spans, length, counted).pitch;
        return match (own - pitch).abs() <= WHOLE * pitch || !spans.iter().any(of_case) {
            true => Ok(counted as u64),
            false => Err(format!(
                "the segments of the first span with bladders of the case are {} m long, but the pitch of its section is {pitch} m",
                rounded(own)
            )),
        };
    }
    let (own, count) = (counted as f64, (rest / pitch).round().max(1.0));
    match given.map_or(count, |given| given - own) {
        number if (number * pitch - rest).abs() <= WHOLE * length => Ok((own + count) as u64),
        number => Err(format!(
            "{number} segments with a pitch of {pitch} m need {} m, but the beam is {} m long{}",
            rounded(number * pitch),
            rounded(rest),
            match counted {
                0 => "",
                _ => " beside spans with a number of segments",
            }
        )),
    }
}

/// Number of pitches of a section in a span of this length [m].
///
/// # Errors
/// The nearest number, if the length is not a whole number of pitches.
pub fn whole_pitches(length: f64, pitch: f64) -> Result<u64, u64> {
    let count = (length / pitch).round().max(1.0);
    match (count * pitch - length).abs() <= WHOLE * length {
        true => Ok(count as u64),
        false => Err(count as u64),
    }
}

/// True for a span with bladders.
fn has_bladders(span: &Span) -> bool {
    span.rows != SpanRows::None
}

/// True for a span with bladders of the section of the case.
fn of_case(span: &Span) -> bool {
    has_bladders(span) && span.section.is_none()
}

/// Segments of the spans that give their number, and the length of the other spans [m], for a beam of this length [m].
fn counted_and_rest(spans: &[Span], total: f64) -> (usize, f64) {
    let counted = spans
        .iter()
        .filter_map(|span| span.segments)
        .fold(0, usize::saturating_add);
    let own = spans
        .iter()
        .zip(Span::lengths(spans, total))
        .filter(|(span, _)| span.segments.is_some());
    (counted, total - own.map(|(_, length)| length).sum::<f64>())
}
