//! Origins of the coefficients of a case.

use std::collections::BTreeMap;
use std::fmt;

use serde_json::Value;

use slcbeam_section::materials::Preset as Elastomer;

use super::faults::{SetValue, is_below};
use super::fluids;
use super::numbers::digits;
use super::presets::Preset;
use super::scaling::CoefficientSizes;
use super::section::{SectionValues, SpanSections};

/// Origin of a coefficient.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// Given in the file.
    Case,
    /// Given in the preset only.
    Preset(Preset),
    /// Given by a `--set` argument.
    Set,
    /// Not given: the default.
    Default,
    /// Computed from the section, by its plane cell or its cell in three dimensions.
    Section {
        /// True for the cell in three dimensions.
        three_d: bool,
    },
    /// Computed from the named values.
    Computed(&'static str),
    /// Property of a named fluid: name of the fluid, and source.
    Fluid(&'static str, &'static str),
    /// Property of a named elastomer.
    Elastomer(Elastomer),
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Case => f.write_str("case"),
            Self::Preset(preset) => write!(f, "preset {}", preset.name()),
            Self::Set => f.write_str("--set"),
            Self::Default => f.write_str("default"),
            Self::Section { three_d: false } => f.write_str("computed from section"),
            Self::Section { three_d: true } => f.write_str("computed from section in 3-D"),
            Self::Computed(from) => write!(f, "computed from {from}"),
            Self::Fluid(name, source) => write!(f, "preset {name} ({source})"),
            Self::Elastomer(preset) => write!(f, "preset {}", preset.name()),
        }
    }
}

/// Origins of coefficients by their JSON pointers. They are not part of the case: two cases with the same numbers are equal whatever the
/// origins of the numbers.
#[derive(Clone, Debug, Default)]
pub struct Origins {
    known: BTreeMap<String, Origin>,
    /// Dimensions to which the coefficients belong.
    pub(super) given: CoefficientSizes,
}

impl PartialEq for Origins {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// Coefficients of the section that the program takes as given, although they follow from dimensions and material.
const COEFFICIENTS: [&str; 14] = [
    "/beam/axial_stiffness_factor",
    "/beam/bending_stiffness_factor",
    "/beam/shear_stiffness_n",
    "/beam/mass_factor",
    "/bladders/permeability_m4",
    "/bladders/area_per_pressure_m2_per_pa",
    "/bladders/area_per_other_pressure_m2_per_pa",
    "/bladders/area_per_moment_m2_per_n_m/opening",
    "/bladders/area_per_moment_m2_per_n_m/closing",
    "/bladders/area_per_force_m2_per_n/tension",
    "/bladders/area_per_force_m2_per_n/compression",
    "/bladders/coupling/published/slope_per_pressure_rad",
    "/bladders/coupling/published/length_per_pressure_m",
    "/tubes/permeability_m4",
];

impl Origins {
    /// Origins in a case read from `own`, which includes the arguments `sets`; `whole` also includes the values of its sections and its
    /// preset.
    pub(super) fn new(
        own: &Value,
        whole: &Value,
        sets: &[SetValue],
        preset: Option<Preset>,
        (of_section, of_spans): (Option<&SectionValues>, &SpanSections),
        given: CoefficientSizes,
    ) -> Self {
        let single = whole.pointer("/network/tubes").and_then(Value::as_array);
        let single = (0..single.map_or(0, Vec::len)).map(|i| format!("/network/tubes/{i}/permeability_m4"));
        let pointers = COEFFICIENTS.into_iter().map(str::to_owned).chain(single);
        let known = pointers.filter_map(|pointer| {
            let section = pointer.split('/').nth(1)?;
            whole.get(section)?;
            let set = || is_set(sets, &pointer);
            let brought = of_section.filter(|s| s.values.pointer(&pointer).is_some());
            let origin = match (whole.pointer(&pointer), own.pointer(&pointer), brought, preset) {
                (None, ..) => absent(whole, &pointer)?,
                (_, Some(_), ..) if set() => Origin::Set,
                (_, Some(own), Some(brought), _) if brought.gives(&pointer, own) => brought.origin(),
                (_, Some(_), ..) => Origin::Case,
                (_, None, Some(brought), _) => brought.origin(),
                (_, None, None, Some(preset)) => Origin::Preset(preset),
                (_, None, None, None) => return None,
            };
            Some((pointer, origin))
        });
        let in_spans = of_spans.origins(own, whole, &COEFFICIENTS).into_iter();
        let in_spans = in_spans.map(|(pointer, origin)| match is_set(sets, &pointer) {
            true if origin == Origin::Case => (pointer, Origin::Set),
            _ => (pointer, origin),
        });
        Self {
            known: known.chain(in_spans).chain(named(own)).collect(),
            given,
        }
    }

    /// Drops the origin of a coefficient whose value has changed.
    pub(super) fn forget(&mut self, pointer: &str) {
        self.known.remove(pointer);
    }

    /// Origin of the coefficient at a pointer; none if there is no such coefficient.
    pub fn get(&self, pointer: &str) -> Option<Origin> {
        self.known.get(pointer).copied()
    }

    /// Texts of all origins, by pointer.
    pub fn describe(&self) -> BTreeMap<String, String> {
        let words = |(pointer, origin): (&String, &Origin)| {
            let factor = self.given.factor(pointer);
            let scaled = match (factor - 1.0).abs() > 1e-9 {
                true => format!(", x {} to follow modulus and sizes", digits(factor)),
                false => String::new(),
            };
            (pointer.clone(), format!("{origin}{scaled}"))
        };
        self.known.iter().map(words).collect()
    }
}

/// True if an argument gives the value at a pointer.
fn is_set(sets: &[SetValue], pointer: &str) -> bool {
    sets.iter()
        .any(|set| set.node.is_some() && is_below(pointer, &set.pointer))
}

/// Origins of the numbers of named fluids and elastomers.
fn named(own: &Value) -> Vec<(String, Origin)> {
    let mut found = vec![];
    if let Some(fluid) = fluids::preset_values(own).and_then(|brought| brought.fluid) {
        let keys = ["/fluid/density_kg_m3", "/fluid/viscosity_pa_s"]
            .into_iter()
            .zip(fluid.sources());
        let own = keys.filter(|(pointer, _)| own.pointer(pointer).is_none());
        found.extend(own.map(|(pointer, source)| (pointer.to_owned(), Origin::Fluid(fluid.name(), source))));
    }
    let spans = own.get("spans").and_then(Value::as_array).map_or(0, Vec::len);
    let in_spans = (0..spans).map(|k| format!("/spans/{k}/section"));
    let materials = std::iter::once("/section".to_owned())
        .chain(in_spans)
        .flat_map(|section| {
            let regions = own.pointer(&format!("{section}/regions")).and_then(Value::as_array);
            let own = format!("{section}/material");
            let places = (0..regions.map_or(0, Vec::len)).map(move |i| format!("{section}/regions/{i}/material"));
            std::iter::once(own).chain(places)
        });
    for pointer in materials {
        let name = own.pointer(&pointer).and_then(|material| material.get("preset"));
        if let Some(preset) = name.and_then(|name| serde_json::from_value(name.clone()).ok()) {
            found.push((pointer, Origin::Elastomer(preset)));
        }
    }
    found
}

/// Origin of a coefficient that is not given.
fn absent(whole: &Value, pointer: &str) -> Option<Origin> {
    let beside = |key: &str| {
        let object = pointer.rsplit_once('/').and_then(|(object, _)| whole.pointer(object));
        object.is_some_and(|o| o.get(key).is_some())
    };
    match pointer {
        "/beam/axial_stiffness_factor" | "/beam/bending_stiffness_factor" => Some(Origin::Default),
        "/beam/mass_factor" if whole.get("bladders").is_some() => Some(Origin::Computed("bladders and fluid")),
        "/beam/mass_factor" => Some(Origin::Default),
        "/tubes/permeability_m4" => Some(Origin::Computed("radius_m")),
        _ if !pointer.ends_with("/permeability_m4") => None,
        _ if beside("cross_section") => Some(Origin::Computed("cross_section")),
        "/bladders/permeability_m4" => Some(Origin::Computed("cross_section height_m x width_m")),
        _ => Some(Origin::Computed("tubes")),
    }
}
