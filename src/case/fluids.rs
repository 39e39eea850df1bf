//! Fluids by name and temperature: density and viscosity at atmospheric pressure by published formulas.
//!
//! t is the temperature in C, T in K, w the mass fraction of glycerol.
//!
//! ```text
//! water            rho  Kell 1975, J. Chem. Eng. Data 20, 97, doi:10.1021/je60064a005                  0 to 100 C
//!                  mu   IAPWS SR6-08(2011), equation 7, 1 % or better                                  0 to 100 C
//! glycerol_water   rho  Volk and Kaehler 2018, Exp. Fluids 59, 75, doi:10.1007/s00348-018-2527-y       15 to 30 C
//!                  mu   Cheng 2008, Ind. Eng. Chem. Res. 47, 3285, doi:10.1021/ie071349z, 1.3 to 5 %    0 to 100 C
//! silicone_oil     mu, rho  Shin-Etsu, Silicone Fluid KF-96, performance test results, from 100 mm2/s   -25 to 250 C
//! air              mu   Sutherland, U.S. Standard Atmosphere 1976, 2 %                                 -50 to 500 C
//!                  rho  ideal gas, p/(R T), R = 287.05 J/(kg K), at the ambient pressure
//! ```

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::faults::Violations;
use super::schema::{ATMOSPHERE, FluidKind};
use crate::error::{Code, Violation};

/// Key of the fluid in a case.
const KEY: &str = "fluid";
const TEMPERATURE: &str = "/fluid/temperature_c";
const ZERO_CELSIUS_K: f64 = 273.15;

/// Fluids by name.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[schemars(rename = "FluidPreset")]
pub enum NamedFluid {
    /// Water at atmospheric pressure, 0 to 100 C: density by Kell 1975, doi:10.1021/je60064a005, viscosity by IAPWS SR6-08(2011).
    Water,
    /// Air at ambient pressure, -50 to 500 C: a gas, ideal, viscosity by Sutherland's law (U.S. Standard Atmosphere 1976).
    Air,
    /// Glycerol in water, 15 to 30 C: density by Volk and Kaehler 2018, doi:10.1007/s00348-018-2527-y, viscosity by Cheng 2008, doi:10.1021/ie071349z.
    GlycerolWater {
        /// Glycerol over the whole, by mass.
        #[schemars(range(min = 0.0, max = 1.0))]
        glycerol_mass_fraction: f64,
    },
    /// Silicone oil (dimethyl), -25 to 250 C: Shin-Etsu, Silicone Fluid KF-96, performance test results.
    SiliconeOil {
        /// Kinematic viscosity at 25 C, by which oils are sold [m^2/s]: 1e-4 is 100 cSt. Formulas hold from there on.
        #[schemars(range(min = 1e-4, max = 1.0))]
        kinematic_viscosity_at_25_c_m2_s: f64,
    },
}

/// Density [kg/m^3] and dynamic viscosity [Pa s].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Properties {
    /// Density [kg/m^3].
    pub density_kg_m3: f64,
    /// Dynamic viscosity [Pa s].
    pub viscosity_pa_s: f64,
}

impl NamedFluid {
    /// Name in a case file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Water => "water",
            Self::Air => "air",
            Self::GlycerolWater { .. } => "glycerol_water",
            Self::SiliconeOil { .. } => "silicone_oil",
        }
    }

    /// Sources of the density and viscosity.
    pub fn sources(self) -> [&'static str; 2] {
        match self {
            Self::Water => ["Kell 1975", "IAPWS SR6-08(2011)"],
            Self::Air => ["ideal gas", "Sutherland, U.S. Standard Atmosphere 1976"],
            Self::GlycerolWater { .. } => ["Volk and Kaehler 2018", "Cheng 2008"],
            Self::SiliconeOil { .. } => ["Shin-Etsu KF-96", "Shin-Etsu KF-96"],
        }
    }

    /// Range of temperatures in which both formulas are valid [C].
    pub fn range_c(self) -> [f64; 2] {
        match self {
            Self::Water => [0.0, 100.0],
            Self::Air => [-50.0, 500.0],
            Self::GlycerolWater { .. } => [15.0, 30.0],
            Self::SiliconeOil { .. } => [-25.0, 250.0],
        }
    }

    /// State of matter: gas or liquid.
    pub fn kind(self) -> FluidKind {
        match self {
            Self::Air => FluidKind::Gas,
            Self::Water | Self::GlycerolWater { .. } | Self::SiliconeOil { .. } => FluidKind::Liquid,
        }
    }

    /// Density and viscosity at a temperature [C] in [`Self::range_c`] and at an absolute pressure [Pa]. Only the density of a gas depends
    /// on the pressure.
    pub fn at_pressure(self, t: f64, pressure: f64) -> Properties {
        let standard = self.at(t);
        match self.kind() {
            FluidKind::Gas => Properties {
                density_kg_m3: standard.density_kg_m3 * pressure / ATMOSPHERE,
                ..standard
            },
            FluidKind::Liquid => standard,
        }
    }

    /// Vapor pressure, absolute [Pa], at a temperature [C] in [`Self::range_c`], if a formula is known. Water: Buck 1981, J. Appl.
    /// Meteorol. 20, 1527, 0.5 % or better up to 50 C and 1 % up to 100 C.
    pub fn vapor_pressure(self, t: f64) -> Option<f64> {
        matches!(self, Self::Water).then(|| 611.21 * ((18.678 - t / 234.5) * t / (257.14 + t)).exp())
    }

    /// Density and viscosity at a temperature [C] in [`Self::range_c`], at 101325 Pa.
    pub fn at(self, t: f64) -> Properties {
        let kelvin = t + ZERO_CELSIUS_K;
        let (density_kg_m3, viscosity_pa_s) = match self {
            Self::Water => (water_density(t), water_viscosity(kelvin)),
            Self::Air => (
                ATMOSPHERE / (287.05 * kelvin),
                1.458e-6 * kelvin.powf(1.5) / (kelvin + 110.4),
            ),
            Self::GlycerolWater {
                glycerol_mass_fraction: w,
            } => (mixture_density(w, t), mixture_viscosity(w, t)),
            Self::SiliconeOil {
                kinematic_viscosity_at_25_c_m2_s: nu,
            } => {
                let density = 970.0 / (1.0 + 9.5e-4 * (t - 25.0));
                (density, density * nu * 10f64.powf(763.1 / (273.0 + t) - 2.559))
            }
        };
        Properties {
            density_kg_m3,
            viscosity_pa_s,
        }
    }
}

fn water_density(t: f64) -> f64 {
    let top = [
        999.839_52,
        16.945_176,
        -7.987_040_1e-3,
        -46.170_461e-6,
        105.563_02e-9,
        -280.542_53e-12,
    ];
    top.iter().rev().fold(0.0, |sum, c| sum * t + c) / (1.0 + 16.879_850e-3 * t)
}

fn water_viscosity(kelvin: f64) -> f64 {
    let terms = [(280.68, -1.9), (511.45, -7.7), (61.131, -19.6), (0.459_03, -40.0)];
    let ratio = kelvin / 300.0;
    1e-6 * terms.iter().map(|(a, b)| a * ratio.powf(*b)).sum::<f64>()
}

fn mixture_density(w: f64, t: f64) -> f64 {
    let water = 1000.0 * (1.0 - ((t - 3.98) / 615.0).abs().powf(1.71));
    let glycerol = 1273.3 - 0.6121 * t;
    let contraction = 1.78e-6 * t * t - 1.82e-4 * t + 1.41e-2;
    let swing = (w.powf(1.31) * std::f64::consts::PI).sin().max(0.0).powf(0.81);
    let volume_fraction = w / (w + glycerol / water * (1.0 - w));
    (1.0 + contraction * swing) * (water + (glycerol - water) * volume_fraction)
}

fn mixture_viscosity(w: f64, t: f64) -> f64 {
    let water = 1.790e-3 * ((-1230.0 - t) * t / (36_100.0 + 360.0 * t)).exp();
    let glycerol = 12.100 * ((-1233.0 + t) * t / (9900.0 + 70.0 * t)).exp();
    let a = 0.705 - 0.0017 * t;
    let b = (4.9 + 0.036 * t) * a.powf(2.5);
    let part = 1.0 - w + a * b * w * (1.0 - w) / (a * w + b * (1.0 - w));
    water.powf(part) * glycerol.powf(1.0 - part)
}

/// Default temperature [C].
pub const ROOM_C: f64 = 20.0;

/// Values that the name of a fluid adds to its case.
#[derive(Debug)]
pub(super) struct FluidValues {
    /// The fluid, if its name is known.
    pub fluid: Option<NamedFluid>,
    /// Density, viscosity and kind as in a case file; those of water if the formulas give none, so that the rest of the case can be
    /// checked.
    pub values: Value,
    temperature_c: f64,
}

/// Returns the values of the fluid of a case, if a preset names it.
pub(super) fn preset_values(case: &Value) -> Option<FluidValues> {
    let fluid = case.get(KEY)?;
    let named: Option<NamedFluid> = serde_json::from_value(fluid.get("preset")?.clone()).ok();
    let temperature_c = fluid
        .get("temperature_c")
        .map_or(Some(ROOM_C), Value::as_f64)
        .unwrap_or(ROOM_C);
    let in_range = named.filter(|fluid| {
        let [low, high] = fluid.range_c();
        (low..=high).contains(&temperature_c)
    });
    let ambient = fluid.get("ambient_pressure_pa").and_then(Value::as_f64);
    let ambient = ambient.filter(|pressure| *pressure > 0.0).unwrap_or(ATMOSPHERE);
    let found = in_range.map(|fluid| fluid.at_pressure(temperature_c, ambient));
    let found = found.filter(|p| p.density_kg_m3.is_normal() && p.density_kg_m3 > 0.0 && p.viscosity_pa_s.is_normal());
    let found = found.unwrap_or(NamedFluid::Water.at(ROOM_C));
    let mut values = json!({"density_kg_m3": found.density_kg_m3, "viscosity_pa_s": found.viscosity_pa_s});
    if named.is_some_and(|fluid| fluid.kind() == FluidKind::Gas) {
        values["kind"] = json!(FluidKind::Gas);
    }
    Some(FluidValues {
        fluid: named,
        values: json!({KEY: values}),
        temperature_c,
    })
}

/// Reports an unused temperature, in a case `own` whose fluid has no name.
pub(super) fn report_unnamed(own: &Value, faults: &mut Violations) {
    if own.pointer(TEMPERATURE).is_some_and(|given| !given.is_null()) {
        let what = "a temperature of a fluid without a name";
        let hint = "name the fluid by \"preset\", or leave it out: density and viscosity are given";
        faults.push_at_key(Violation::new(Code::Together, TEMPERATURE, what).hint(hint));
    }
}

impl FluidValues {
    /// Reports a temperature outside the range of the formulas.
    pub(super) fn report(&self, faults: &mut Violations) {
        let Some(fluid) = self.fluid.filter(|_| !faults.any_below("/fluid")) else {
            return;
        };
        let [low, high] = fluid.range_c();
        if !(low..=high).contains(&self.temperature_c) {
            let what = format!(
                "the formulas of {} are not valid at {} C",
                fluid.name(),
                self.temperature_c
            );
            let fault = Violation::new(Code::Range, TEMPERATURE, what).allowed(format!("{low} to {high} C"));
            faults.push(fault.hint("give density_kg_m3 and viscosity_pa_s in place of a preset"));
        }
    }
}
