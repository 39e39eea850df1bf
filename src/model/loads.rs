//! Distributed loads.

use super::Section;
use crate::case::schema::{Case, Distributed, Load as Written};
use crate::functions::profile::Profile;
use crate::functions::signals::Signal;
use crate::numerics::Planar;

/// Quantity prescribed by a load.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoadKind {
    /// Force per length in x [N/m].
    ForceX,
    /// Force per length in z [N/m].
    ForceZ,
    /// Force per length along the normal, which turns with the beam [N/m].
    Normal,
    /// Force per length along the tangent [N/m].
    Tangential,
    /// First moment per length `m b1_x` [N].
    MomentX,
    /// First moment per length `m b1_z` [N].
    MomentZ,
    /// Curvature of the beam at rest [1/m].
    RestCurvature,
}

/// Quantity of the beam to which a load is proportional along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LoadMeasure {
    /// Length.
    Length,
    /// Mass, with an acceleration [m/s^2].
    Mass(f64),
    /// Mass less that of the displaced ambient fluid, with an acceleration [m/s^2].
    Weight(f64),
}

/// `factor signal(t) profile(θ/l_s)`; on a beam with spans the factor is that of the mean section.
#[derive(Clone, Debug)]
pub struct DistributedLoad {
    /// Prescribed quantity.
    pub kind: LoadKind,
    /// Constant factor: 1 for contact loads, `m` for body forces.
    pub factor: f64,
    /// Quantity of the beam in the factor.
    pub per: LoadMeasure,
    /// Time function.
    pub signal: Signal,
    /// Shape along the beam.
    pub profile: Profile,
}

/// Rotation of the axes of a case.
#[derive(Clone, Debug)]
pub struct FrameRotation {
    /// Axis of rotation [m].
    pub center: Planar<f64>,
    /// Angular velocity in the sense of growing φ [rad/s].
    pub angular_velocity: Signal,
}

impl FrameRotation {
    /// Rotation of the axes of a case, if given.
    pub fn from_case(case: &Case) -> Option<Self> {
        case.rotating_frame.as_ref().map(|written| Self {
            center: Planar::new(written.center_m[0], written.center_m[1]),
            angular_velocity: written.angular_velocity_rad_s.clone(),
        })
    }
}

impl DistributedLoad {
    /// `[E5]` (A.6, A.7) with `b` in N/m: contact loads as given, body forces times `m`, gravity times `m` less the
    /// mass of displaced fluid.
    pub fn resolve(written: &Written, section: &Section) -> Vec<Self> {
        Self::on(written, [section.mass_per_length, section.weighing_per_length()])
    }

    /// Loads on a mass, or a mass per length; `weighing` is its part subject to gravity.
    pub fn on(written: &Written, [mass, weighing]: [f64; 2]) -> Vec<Self> {
        let given = |kind, factor, per, d: &Distributed| {
            vec![Self {
                kind,
                factor,
                per,
                signal: d.signal.clone(),
                profile: d.profile.clone(),
            }]
        };
        let one = |kind, d| given(kind, 1.0, LoadMeasure::Length, d);
        match written {
            Written::ForceXNM(d) => one(LoadKind::ForceX, d),
            Written::ForceZNM(d) => one(LoadKind::ForceZ, d),
            Written::ForceNormalNM(d) => one(LoadKind::Normal, d),
            Written::ForceTangentialNM(d) => one(LoadKind::Tangential, d),
            Written::MomentXN(d) => one(LoadKind::MomentX, d),
            Written::MomentZN(d) => one(LoadKind::MomentZ, d),
            Written::BodyXMS2(d) => given(LoadKind::ForceX, mass, LoadMeasure::Mass(1.0), d),
            Written::BodyZMS2(d) => given(LoadKind::ForceZ, mass, LoadMeasure::Mass(1.0), d),
            Written::RestCurvature(d) => one(LoadKind::RestCurvature, d),
            Written::Gravity { x_m_s2, z_m_s2 } => [(LoadKind::ForceX, *x_m_s2), (LoadKind::ForceZ, *z_m_s2)]
                .into_iter()
                .filter(|(_, g)| *g != 0.0)
                .map(|(kind, g)| Self {
                    kind,
                    factor: weighing * g,
                    per: LoadMeasure::Weight(g),
                    signal: Signal::one(),
                    profile: Profile::one(),
                })
                .collect(),
        }
    }
}
