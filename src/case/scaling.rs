//! Scaling laws of the coefficients of a section with Young's modulus and the dimensions of beam, bladders and tubes.
//!
//! A coefficient belongs to the modulus and the dimensions that it is given with. For sections of one shape and one material, coefficients
//! are powers of modulus and size, so that one value gives all others. After a change of shape the same powers are used, but they are not
//! exact: [`super::inherited`] warns of it.

use std::collections::BTreeMap;

use serde_json::Value;

use super::faults::is_below;
use super::schema::{Span, SpanLengths};

/// Relative difference of a ratio of dimensions above which two sections have different shapes.
const SAME: f64 = 1e-3;

/// Modulus and dimensions to which coefficients belong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sizes {
    /// Young's modulus [Pa].
    pub modulus: f64,
    /// Height and width of the beam's section [m].
    pub section: [f64; 2],
    /// Densities of solid and fluid [kg/m³].
    densities: [Option<f64>; 2],
    pub bladders: Option<InBeam>,
    /// Bladders of a lower row with sizes of its own.
    lower: Option<InBeam>,
    /// Radius of tubes [m].
    radius: Option<f64>,
}

/// Length of the segments to which the coefficients of a case in JSON belong [m].
fn pitch(case: &Value, length: f64, per_row: f64) -> f64 {
    let spans = Span::outlines(case);
    match spans.is_empty() {
        true => length / per_row,
        false => SpanLengths::resolve(&spans, length, per_row as usize).pitch,
    }
}

/// Bladders in the beam [m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct InBeam {
    /// Length of the beam per bladder of a row.
    pub pitch: f64,
    pub length: f64,
    pub height: f64,
    pub width: f64,
}

impl Sizes {
    /// Dimensions of a case in JSON that has all its numbers; none if a number is missing or not positive.
    pub fn from_case(case: &Value) -> Option<Self> {
        let number = |pointer: &str| case.pointer(pointer).and_then(Value::as_f64).filter(|x| *x > 0.0);
        let bladders = match case.get("bladders") {
            Some(Value::Object(_)) => Some(InBeam {
                pitch: pitch(case, number("/beam/length_m")?, number("/bladders/per_row")?),
                length: number("/bladders/length_m")?,
                height: number("/bladders/height_m")?,
                width: number("/bladders/width_m")?,
            }),
            _ => None,
        };
        let own = |key: &str| number(&format!("/bladders/lower/unlike/{key}"));
        let lower = bladders.map(|upper| InBeam {
            height: own("height_m").unwrap_or(upper.height),
            width: own("width_m").unwrap_or(upper.width),
            ..upper
        });
        Some(Self {
            lower,
            modulus: number("/beam/young_modulus_pa")?,
            section: [number("/beam/height_m")?, number("/beam/width_m")?],
            densities: [number("/beam/density_kg_m3"), number("/fluid/density_kg_m3")],
            bladders,
            radius: number("/tubes/radius_m"),
        })
    }

    /// Cross-section of a bladder [m²].
    fn bladder_area(&self) -> Option<f64> {
        self.bladders.map(|b| b.height * b.width)
    }

    /// `h_b w_b/E`, to which areas per pressure are proportional [m²/Pa].
    pub fn area_per_pressure(&self) -> Option<f64> {
        Some(self.bladder_area()? / self.modulus)
    }

    /// `h_b w_b/(E w_s h_s)`, to which areas per normal force are proportional [m²/N].
    pub fn area_per_force(&self) -> Option<f64> {
        let [h, w] = self.section;
        Some(self.area_per_pressure()? / (w * h))
    }

    /// `h_b w_b/(E w_s h_s²)`, to which areas per bending moment are proportional [m²/(N m)].
    pub fn area_per_moment(&self) -> Option<f64> {
        Some(self.area_per_force()? / self.section[0])
    }

    /// These sizes with the bladders of the lower row.
    fn of_lower(&self) -> Self {
        Self {
            bladders: self.lower,
            ..*self
        }
    }

    /// `l_b h_b w_b/(w_s h_s)`, to which the length of a segment per p/E is proportional [m].
    fn length_per_pressure(&self) -> Option<f64> {
        let [h, w] = self.section;
        Some(self.bladders?.length * self.bladder_area()? / (w * h))
    }

    /// Proportions of the plane cell.
    fn cell(&self) -> Option<Vec<f64>> {
        let (b, [h, _]) = (self.bladders?, self.section);
        Some(vec![b.height / h, b.width / b.pitch, b.pitch / h])
    }

    /// Proportions of the section and its cell; without bladders, those of the section.
    fn whole(&self) -> Option<Vec<f64>> {
        let Some(b) = self.bladders else {
            return self.outline();
        };
        let [_, w] = self.section;
        Some([self.cell()?, vec![b.length / w]].concat())
    }

    /// Width over height of the section.
    fn outline(&self) -> Option<Vec<f64>> {
        let [h, w] = self.section;
        Some(vec![w / h])
    }

    /// Proportions as in `whole`, and 1 plus the density ratio of fluid to solid; without bladders, the fluid counts as 0.
    fn massive(&self) -> Option<Vec<f64>> {
        let [solid, fluid] = self.densities;
        let fluid = self.bladders.and(fluid).unwrap_or(0.0);
        Some([self.whole()?, vec![1.0 + fluid / solid?]].concat())
    }
}

/// Scaling law of a coefficient, or of an array of them.
pub(super) struct Law {
    /// JSON pointer.
    pub pointer: &'static str,
    /// Quantity to which the coefficient is proportional.
    scale: fn(&Sizes) -> Option<f64>,
    /// Ratios of dimensions that must not change for the law to be exact.
    shape: fn(&Sizes) -> Option<Vec<f64>>,
}

const fn law(pointer: &'static str, scale: fn(&Sizes) -> Option<f64>, shape: fn(&Sizes) -> Option<Vec<f64>>) -> Law {
    Law { pointer, scale, shape }
}

/// `h_b³ w_b³/(h_b² + w_b²)`, to which permeabilities are proportional [m⁴].
fn permeability(s: &Sizes) -> Option<f64> {
    let b = s.bladders?;
    Some((b.height * b.width).powi(3) / (b.height.powi(2) + b.width.powi(2)))
}

fn ratio(_: &Sizes) -> Option<f64> {
    Some(1.0)
}

/// Scaling laws of coefficients.
///
/// ```text
/// f_e, f_i, f_m ~ 1        z_n ~ h_s        kGA, P_k ~ E w_s h_s        ψ' ~ l_b h_b w_b/(w_s h_s²)     ζ' ~ l_b h_b w_b/(w_s h_s)
/// a_p, a_x ~ h_b w_b/E     aN ~ h_b w_b/(E w_s h_s)    aM ~ h_b w_b/(E w_s h_s²)
/// q1b ~ h_b³ w_b³/(h_b² + w_b²)                        q1c ~ r_c⁴
/// ```
pub(super) const LAWS: [Law; 27] = [
    law("/beam/axial_stiffness_factor", ratio, Sizes::whole),
    law("/beam/bending_stiffness_factor", ratio, Sizes::whole),
    law(
        "/beam/moment_curvature/curvature_1_m",
        |s| Some(s.section[0].recip()),
        Sizes::whole,
    ),
    law(
        "/beam/moment_curvature/moment_n_m",
        |s| Some(s.modulus * s.section[0].powi(2) * s.section[1]),
        Sizes::whole,
    ),
    law("/beam/neutral_axis_m", |s| Some(s.section[0]), Sizes::whole),
    law(
        "/beam/shear_stiffness_n",
        |s| Some(s.modulus * s.section[0] * s.section[1]),
        Sizes::whole,
    ),
    law("/beam/mass_factor", ratio, Sizes::massive),
    law(
        "/bladders/area_per_pressure_m2_per_pa",
        Sizes::area_per_pressure,
        Sizes::cell,
    ),
    law(
        "/bladders/area_per_other_pressure_m2_per_pa",
        Sizes::area_per_pressure,
        Sizes::cell,
    ),
    law(
        "/bladders/area_per_moment_m2_per_n_m/opening",
        Sizes::area_per_moment,
        Sizes::whole,
    ),
    law(
        "/bladders/area_per_moment_m2_per_n_m/closing",
        Sizes::area_per_moment,
        Sizes::whole,
    ),
    law(
        "/bladders/area_per_force_m2_per_n/tension",
        Sizes::area_per_force,
        Sizes::whole,
    ),
    law(
        "/bladders/area_per_force_m2_per_n/compression",
        Sizes::area_per_force,
        Sizes::whole,
    ),
    law(
        "/bladders/lower/unlike/area_per_pressure_m2_per_pa",
        |s| s.of_lower().area_per_pressure(),
        |s| s.of_lower().cell(),
    ),
    law(
        "/bladders/lower/unlike/area_per_moment_m2_per_n_m/opening",
        |s| s.of_lower().area_per_moment(),
        |s| s.of_lower().whole(),
    ),
    law(
        "/bladders/lower/unlike/area_per_moment_m2_per_n_m/closing",
        |s| s.of_lower().area_per_moment(),
        |s| s.of_lower().whole(),
    ),
    law(
        "/bladders/lower/unlike/area_per_force_m2_per_n/tension",
        |s| s.of_lower().area_per_force(),
        |s| s.of_lower().whole(),
    ),
    law(
        "/bladders/lower/unlike/area_per_force_m2_per_n/compression",
        |s| s.of_lower().area_per_force(),
        |s| s.of_lower().whole(),
    ),
    law(
        "/bladders/coupling/published/slope_per_pressure_rad",
        |s| Some(s.length_per_pressure()? / s.section[0]),
        Sizes::whole,
    ),
    law(
        "/bladders/coupling/published/length_per_pressure_m",
        Sizes::length_per_pressure,
        Sizes::whole,
    ),
    law(
        "/bladders/strain_energy/coefficients_n",
        |s| Some(s.modulus * s.section[0] * s.section[1]),
        Sizes::whole,
    ),
    law(
        "/bladders/strain_energy/curvature_1_m",
        |s| Some(s.section[0].recip()),
        Sizes::whole,
    ),
    law(
        "/bladders/strain_energy/upper_pressure_pa",
        |s| Some(s.modulus),
        Sizes::whole,
    ),
    law(
        "/bladders/strain_energy/lower_pressure_pa",
        |s| Some(s.modulus),
        Sizes::whole,
    ),
    law("/bladders/permeability_m4", permeability, |s| {
        s.bladders.map(|b| vec![b.height / b.width])
    }),
    law(
        "/bladders/lower/unlike/permeability_m4",
        |s| permeability(&s.of_lower()),
        |s| s.lower.map(|b| vec![b.height / b.width]),
    ),
    law("/tubes/permeability_m4", |s| Some(s.radius?.powi(4)), |_| None),
];

impl Law {
    /// Ratio of the coefficient with the dimensions `now` to that with `then`.
    fn factor(&self, now: &Sizes, then: &Sizes) -> f64 {
        let pair = (self.scale)(now).zip((self.scale)(then));
        pair.map_or(1.0, |(now, then)| now / then)
    }

    /// True if the law is exact between `now` and `then`. If `now` has no bladders, only the sections are compared.
    pub fn is_exact(&self, now: &Sizes, then: &Sizes) -> bool {
        let bladders = then.bladders.filter(|_| now.bladders.is_some());
        match ((self.shape)(now), (self.shape)(&Sizes { bladders, ..*then })) {
            (Some(now), Some(then)) => {
                now.len() == then.len() && now.iter().zip(&then).all(|(a, b)| (a - b).abs() <= SAME * b.abs())
            }
            _ => true,
        }
    }
}

/// True if a `POINTER=JSON` argument may change the dimensions to which coefficients belong.
pub(super) fn may_change_sizes(argument: &str) -> bool {
    let pointer = argument.split('=').next().unwrap_or_default();
    let parts = ["/beam", "/bladders", "/fluid", "/tubes", "/section", "/preset"];
    parts.iter().any(|part| is_below(pointer, part))
}

/// Dimensions to which coefficients belong, by pointer, and those of the case.
#[derive(Clone, Debug, Default)]
pub(super) struct CoefficientSizes {
    then: BTreeMap<&'static str, Sizes>,
    now: Option<Sizes>,
}

impl CoefficientSizes {
    /// Records that the coefficients at, above or below the pointers belong to these dimensions.
    pub fn note<'a>(&mut self, pointers: impl Iterator<Item = &'a str> + Clone, sizes: Option<Sizes>) {
        let touches = |law: &&Law| {
            let mut pointers = pointers.clone();
            pointers.any(|p| is_below(law.pointer, p) || is_below(p, law.pointer))
        };
        for law in LAWS.iter().filter(touches) {
            match sizes {
                Some(sizes) => self.then.insert(law.pointer, sizes),
                None => self.then.remove(law.pointer),
            };
        }
    }

    /// Dimensions of the case, and those to which the coefficient of a law belongs.
    pub fn pair(&self, law: &Law) -> Option<(&Sizes, &Sizes)> {
        self.now.as_ref().zip(self.then.get(law.pointer))
    }

    /// Factor by which the coefficient at a pointer was multiplied.
    pub fn factor(&self, pointer: &str) -> f64 {
        let law = LAWS.iter().find(|law| law.pointer == pointer);
        let factor = |law: &Law| self.pair(law).map(|(now, then)| law.factor(now, then));
        law.and_then(factor).unwrap_or(1.0)
    }

    /// Scales the coefficients of a case in JSON from the dimensions to which they belong to those of the case.
    pub fn scale(&mut self, case: &mut Value) {
        self.now = Sizes::from_case(case);
        for pointer in self.then.keys() {
            if let Some(value) = case.pointer_mut(pointer) {
                multiply(value, self.factor(pointer));
            }
        }
    }

    /// Sets numbers at pointers of a case in JSON that has the dimensions of `self`, and scales its other coefficients.
    pub fn change(&mut self, case: &mut Value, numbers: &[(&str, f64)]) {
        let mut step = Self::default();
        step.note(LAWS.iter().map(|law| law.pointer), Sizes::from_case(case));
        for (pointer, number) in numbers {
            if let Some(place) = case.pointer_mut(pointer) {
                *place = (*number).into();
            }
        }
        let pointers = numbers.iter().map(|(pointer, _)| *pointer);
        step.note(pointers.clone(), None);
        step.scale(case);
        self.now = step.now;
        self.note(pointers, step.now);
    }
}

/// Multiplies a number, or every number of an array.
fn multiply(value: &mut Value, factor: f64) {
    match value {
        Value::Array(items) => items.iter_mut().for_each(|item| multiply(item, factor)),
        Value::Number(number) if factor != 1.0 => {
            if let Some(x) = number.as_f64() {
                *value = (factor * x).into();
            }
        }
        _ => {}
    }
}
