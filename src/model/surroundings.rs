//! Ambient fluid of the beam.

use std::f64::consts::PI;

use crate::case::schema::{Beam, Case, Surroundings as Written};
use crate::case::spans;
use crate::functions::signals::Signal;

/// Ambient fluid.
#[derive(Clone, Debug)]
pub struct AmbientFluid {
    /// Around the mean section.
    pub section: AmbientSection,
    /// Around the sections of segments; empty for a uniform beam.
    pub segments: Vec<AmbientSection>,
    /// Stream velocity in x and z [m/s]; none without a stream.
    pub stream: Option<[Signal; 2]>,
}

/// Ambient fluid of one section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmbientSection {
    /// Transverse drag constant `c = C_d ρ w/2` [kg/m^2].
    pub drag: f64,
    /// Transverse added mass `m_a = C_a π ρ w²/4` [kg/m].
    pub added_mass: f64,
    /// Mass of displaced fluid per length [kg/m].
    pub displaced: f64,
}

impl AmbientSection {
    fn new(written: &Written, beam: &Beam) -> Self {
        let (density, width) = (written.density_kg_m3, beam.width_m);
        Self {
            drag: 0.5 * written.drag_coefficient * density * width,
            added_mass: 0.25 * PI * written.added_mass_coefficient * density * width * width,
            displaced: displaced(Some(written), beam),
        }
    }

    /// Mean of two sections with their shares.
    pub fn mean(self, other: Self, shares: [f64; 2]) -> Self {
        if self == other {
            return self;
        }
        let mean = |of: fn(Self) -> f64| shares[0] * of(self) + shares[1] * of(other);
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
        let values = spans::segments(case);
        let segments: Vec<_> = values
            .iter()
            .map(|one| AmbientSection::new(written, &one.beam))
            .collect();
        let own = segments
            .iter()
            .zip(spans::segment_lengths(case))
            .scan(0.0, |before, (one, length)| {
                let shares = [*before / (*before + length), length / (*before + length)];
                *before += length;
                Some((*one, shares))
            });
        let mean = own.fold(None, |mean: Option<AmbientSection>, (one, shares)| {
            Some(mean.map_or(one, |mean| mean.mean(one, shares)))
        });
        let given = |signal: &Option<Signal>| signal.clone().unwrap_or(Signal::Constant(0.0));
        let streams = written.stream().next().is_some();
        Some(Self {
            section: mean.unwrap_or_else(|| AmbientSection::new(written, &case.beam)),
            segments,
            stream: streams.then(|| [given(&written.stream_x_m_s), given(&written.stream_z_m_s)]),
        })
    }
}

/// Mass of fluid displaced by a beam, per length [kg/m]. Gravity acts on the beam's mass less this (Archimedes).
pub fn displaced(written: Option<&Written>, beam: &Beam) -> f64 {
    written.map_or(0.0, |s| s.density_kg_m3 * beam.width_m * beam.height_m)
}
