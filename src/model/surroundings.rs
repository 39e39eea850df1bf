//! What the beam moves through.

use std::f64::consts::PI;

use crate::case::schema::{Beam, Case, Surroundings as Written};
use crate::functions::signals::Signal;

/// A fluid around the beam.
#[derive(Clone, Debug)]
pub struct Surroundings {
    /// `c = C_d ρ w/2` of its drag across [kg/m^2].
    pub drag: f64,
    /// `m_a = C_a π ρ w²/4` of its inertia across [kg/m].
    pub added_mass: f64,
    /// Mass of the fluid that the beam displaces, per length [kg/m].
    pub displaced: f64,
    /// Velocity in x and z, where it streams [m/s].
    pub stream: Option<[Signal; 2]>,
}

impl Surroundings {
    /// Around the beam of a case, where something is.
    pub fn of(case: &Case) -> Option<Self> {
        case.surroundings.as_ref().map(|written| Self::new(written, &case.beam))
    }

    fn new(written: &Written, beam: &Beam) -> Self {
        let (density, width) = (written.density_kg_m3, beam.width_m);
        let given = |signal: &Option<Signal>| signal.clone().unwrap_or(Signal::Constant(0.0));
        let streams = written.stream().next().is_some();
        Self {
            drag: 0.5 * written.drag_coefficient * density * width,
            added_mass: 0.25 * PI * written.added_mass_coefficient * density * width * width,
            displaced: displaced(Some(written), beam),
            stream: streams.then(|| [given(&written.stream_x_m_s), given(&written.stream_z_m_s)]),
        }
    }
}

/// Mass of the fluid that a beam displaces, per length [kg/m]: gravity acts on the beam's own less this (Archimedes).
pub fn displaced(written: Option<&Written>, beam: &Beam) -> f64 {
    written.map_or(0.0, |s| s.density_kg_m3 * beam.width_m * beam.height_m)
}
