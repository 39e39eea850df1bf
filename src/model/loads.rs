//! Distributed loads.

use super::Section;
use crate::case::schema::{Distributed, Load as Written};
use crate::functions::profile::Profile;
use crate::functions::signals::Signal;

/// Quantity prescribed by a load.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoadKind {
    /// Force per length in x [N/m].
    ForceX,
    /// Force per length in z [N/m].
    ForceZ,
    /// First moment per length `m b1_x` [N].
    MomentX,
    /// First moment per length `m b1_z` [N].
    MomentZ,
    /// Curvature of the beam at rest [1/m].
    RestCurvature,
}

/// `factor signal(t) profile(θ/l_s)`.
#[derive(Clone, Debug)]
pub struct DistributedLoad {
    /// Prescribed quantity.
    pub kind: LoadKind,
    /// Constant factor: 1 for contact loads, `m` for body forces.
    pub factor: f64,
    /// Time function.
    pub signal: Signal,
    /// Shape along the beam.
    pub profile: Profile,
}

impl DistributedLoad {
    /// `[E5]` (A.6, A.7) with `b` in N/m: contact loads as given, body forces times `m`, gravity times `m` less the
    /// mass of displaced fluid.
    pub fn resolve(written: &Written, section: &Section) -> Vec<Self> {
        Self::on(written, [section.mass_per_length, section.weighing_per_length])
    }

    /// Loads on a mass, or a mass per length; `weighing` is its part subject to gravity.
    pub fn on(written: &Written, [mass, weighing]: [f64; 2]) -> Vec<Self> {
        let one = |kind, factor, d: &Distributed| {
            vec![Self {
                kind,
                factor,
                signal: d.signal.clone(),
                profile: d.profile.clone(),
            }]
        };
        match written {
            Written::ForceXNM(d) => one(LoadKind::ForceX, 1.0, d),
            Written::ForceZNM(d) => one(LoadKind::ForceZ, 1.0, d),
            Written::MomentXN(d) => one(LoadKind::MomentX, 1.0, d),
            Written::MomentZN(d) => one(LoadKind::MomentZ, 1.0, d),
            Written::BodyXMS2(d) => one(LoadKind::ForceX, mass, d),
            Written::BodyZMS2(d) => one(LoadKind::ForceZ, mass, d),
            Written::RestCurvature(d) => one(LoadKind::RestCurvature, 1.0, d),
            Written::Gravity { x_m_s2, z_m_s2 } => [(LoadKind::ForceX, *x_m_s2), (LoadKind::ForceZ, *z_m_s2)]
                .into_iter()
                .filter(|(_, g)| *g != 0.0)
                .map(|(kind, g)| Self {
                    kind,
                    factor: weighing * g,
                    signal: Signal::one(),
                    profile: Profile::one(),
                })
                .collect(),
        }
    }
}
