//! Ambient fluid of the beam.

use std::f64::consts::PI;

use crate::case::schema::{Beam, Case, Surroundings as Written};
use crate::functions::signals::Signal;

/// Ambient fluid.
#[derive(Clone, Debug)]
pub struct AmbientFluid {
    /// Stream velocity in x and z [m/s]; none without a stream.
    pub stream: Option<[Signal; 2]>,
}

/// Ambient fluid of one section; zeros without one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AmbientSection {
    /// Transverse drag constant `c = C_d ρ w/2` [kg/m^2].
    pub drag: f64,
    /// Transverse added mass `m_a = C_a π ρ w²/4` [kg/m].
    pub added_mass: f64,
    /// Mass of displaced fluid per length [kg/m]. Gravity acts on the beam's mass less this (Archimedes).
    pub displaced: f64,
}

impl AmbientSection {
    /// Ambient fluid of a section.
    pub fn new(written: &Written, beam: &Beam) -> Self {
        let (density, width) = (written.density_kg_m3, beam.width_m);
        Self {
            drag: 0.5 * written.drag_coefficient * density * width,
            added_mass: 0.25 * PI * written.added_mass_coefficient * density * width * width,
            displaced: density * width * beam.height_m,
        }
    }

    /// The values that `mean` returns of each value.
    pub fn mean(mean: impl Fn(fn(&Self) -> f64) -> f64) -> Self {
        Self {
            drag: mean(|one| one.drag),
            added_mass: mean(|one| one.added_mass),
            displaced: mean(|one| one.displaced),
        }
    }
}

impl AmbientFluid {
    /// Surroundings of a case, if given.
    pub fn from_case(case: &Case) -> Option<Self> {
        let written = case.surroundings.as_ref()?;
        let given = |signal: &Option<Signal>| signal.clone().unwrap_or(Signal::Constant(0.0));
        let streams = written.stream().next().is_some();
        Some(Self {
            stream: streams.then(|| [given(&written.stream_x_m_s), given(&written.stream_z_m_s)]),
        })
    }
}
