//! Reasons for each effect decision; the text is in `Display` only.

use std::fmt::{self, Display, Formatter};

use super::obstacles::Obstacle;
use crate::case::schema::Effect;
use crate::error::numbers::significant;

/// Reason for a decision on an effect.
#[derive(Clone, Debug, PartialEq)]
pub enum DecisionCause {
    /// The full model is requested.
    Full,
    /// Switched on by name.
    Asked,
    /// Switched off by name.
    LeftOut,
    /// Switched off by name, which an obstacle prevents.
    Refused(Obstacle),
    /// Off unless switched on by name.
    Unasked,
    /// A port's flow enters a junction of tubes only, whose inertia prevents it.
    FedJunction,
    /// The published form has no shear.
    Unsheared,
    /// The fluid has no mass.
    Massless,
    /// The case gives the effect's data, or does not.
    Given(bool),
    /// The case gives what the effect needs of bladders and fluid, or does not.
    Filled(bool),
    /// Requires another effect, which is off.
    Needs(Effect),
    /// The reciprocal coupling has no kinks.
    NoKinks,
    /// The case contains an input that requires the effect.
    Obstacle(Obstacle),
    /// Omitting it might hide an instability.
    Unstable(String),
    /// Kept regardless of its number.
    Kept(Keeps),
    /// Number compared with the tolerance.
    Weighed(MeasuredAgainst),
    /// No load acts across; fraction of the buckling load reached by compression.
    Straight(f64),
    /// All bladders are sealed; their number.
    Sealed(usize),
    /// Some bladders are sealed, and the leakage of the others decides.
    PartlySealed {
        /// Number of sealed bladders.
        sealed: usize,
        /// Number of all bladders.
        all: usize,
        /// Leakage of the others.
        leaks: MeasuredAgainst,
    },
}

/// A number with its tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredAgainst {
    /// Kind of number.
    pub what: DecisiveNumber,
    /// Its value.
    pub value: f64,
    /// Value below which the effect may be omitted.
    pub tolerance: f64,
}

impl MeasuredAgainst {
    /// True if the effect is kept; an unknown number keeps it.
    pub fn on(&self) -> bool {
        self.value.is_nan() || self.value >= self.tolerance
    }
}

/// Numbers that decide on effects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DecisiveNumber {
    /// Square of the largest angle.
    Rotation,
    /// Shortening by bending over stretch.
    DrawnIn,
    /// Normal force over the buckling load.
    NormalForce,
    /// Stretch over shortening by bending.
    Stretch,
    /// Inertia of bending over its stiffness.
    BendingInertia,
    /// Axial waves over the stretch without them.
    AxialWaves,
    /// Phase of the second bending mode over the whole run.
    RotaryInertia,
    /// Shear in the second bending mode, at rest and over the whole run.
    Shear,
    /// Leakage over the whole run.
    Leakage,
    /// Time constant of a bladder over that of the motion.
    LagAlongBladders,
    /// Largest inertia of the fluid in a tube over its resistance.
    Inertance,
    /// Largest inertia of the fluid along bladders over the storage that receives its flow.
    Sloshing,
    /// Largest error of a steady velocity profile in a tube or a bladder.
    UnsteadyFriction,
    /// Largest losses of a tube over its laminar friction.
    TubeLosses,
    /// Strains by pressure over those by loads.
    PressureStrain,
    /// Larger of dm/am and dn/an.
    Asymmetry,
    /// Storage by compression over storage by bladder walls.
    Compression,
    /// Largest energy beyond the quadratic part over the quadratic energy.
    StrainEnergy,
}

/// Reasons to keep an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keeps {
    /// The rows of bladders differ.
    RowsDiffer,
    /// A load acts near or above the first bending frequency.
    Resonance,
    /// Driven ends load the beam by inertia.
    DrivenEnds,
    /// The ends do not support the beam.
    NotHeld,
    /// A load acts suddenly.
    Sudden,
    /// Ports or turbines exchange fluid.
    Fed,
    /// An effect that requires it is switched on by name.
    AskedWithInertia,
    /// It is the only dissipation of the fluid.
    Dissipation,
    /// The initial pressure differs along a bladder.
    UnevenStart,
    /// It generates pressure.
    MakesPressure,
    /// The fluid is a gas.
    Gas,
    /// Attachments, which the scene's numbers exclude.
    Attachments,
    /// Contacts, which the scene's numbers exclude.
    Contacts,
    /// Ambient fluid, which the scene's numbers exclude.
    Surroundings,
    /// Rest curvature, which the scene's numbers exclude.
    RestCurvature,
    /// Relaxation of the solid, which the scene's numbers exclude.
    Viscoelasticity,
    /// Moment-curvature law, which the scene's numbers exclude.
    MomentCurvature,
    /// The section is nonlinear at the scene's loads.
    FiniteStrain,
}

impl Display for DecisionCause {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        match self {
            Self::Full => f.write_str("full model requested"),
            Self::Asked => f.write_str("switched on by name"),
            Self::LeftOut => f.write_str("switched off by name"),
            Self::Refused(obstacle) => write!(f, "cannot be left out: {}", obstacle.what),
            Self::Unasked => f.write_str("tube flow is creeping in the published form; switch this on by name"),
            Self::Unsheared => f.write_str("the published form has no shear"),
            Self::Massless => f.write_str("the fluid has no mass"),
            Self::FedJunction => f.write_str("left out: the flow of a port enters a junction of tubes only"),
            Self::Given(true) => f.write_str("given"),
            Self::Given(false) => f.write_str("not given"),
            Self::Filled(true) => f.write_str("fluid is given"),
            Self::Filled(false) => f.write_str("no bladders or no fluid"),
            Self::Needs(Effect::NetworkPressureDifferences) => f.write_str("each network has one pressure"),
            Self::Needs(effect) => write!(f, "no {}", effect.name().replace('_', " ")),
            Self::NoKinks => {
                f.write_str("the reciprocal coupling uses mean slopes, because a potential with different slopes for opening and closing is not convex")
            }
            Self::Obstacle(obstacle) => write!(f, "kept: {}", obstacle.what),
            Self::Unstable(why) => write!(f, "kept: {why}"),
            Self::Kept(keeps) => write!(f, "kept: {keeps}"),
            Self::Weighed(weighed) => weighed.fmt(f),
            Self::Straight(pressed) => write!(
                f,
                "no transverse load, mirrored rows, compression {} of the buckling load",
                significant(*pressed, 2)
            ),
            Self::Sealed(all) => write!(f, "all {all} bladders are sealed, which is exact without unknowns"),
            Self::PartlySealed { sealed, all, leaks } => write!(f, "{sealed} of {all} bladders are sealed; {leaks}"),
        }
    }
}

impl Display for MeasuredAgainst {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let value = match self.value.is_finite() {
            true => significant(self.value, 2),
            false => "infinite".into(),
        };
        let side = if self.on() { "not below" } else { "below" };
        write!(f, "{}: {value}, {side} {}", self.what, significant(self.tolerance, 1))
    }
}

impl Display for DecisiveNumber {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Rotation => "square of the largest angle",
            Self::DrawnIn => "shortening by bending over stretch",
            Self::NormalForce => "normal force over the buckling load",
            Self::Stretch => "stretch over shortening by bending",
            Self::BendingInertia => "inertia of bending over bending stiffness",
            Self::AxialWaves => "axial waves over static stretch",
            Self::RotaryInertia => "phase shift of the second bending mode over the whole run",
            Self::Shear => "effect of shear on deflection and phase of the second bending mode",
            Self::Leakage => "leakage over the whole run",
            Self::LagAlongBladders => "time constant of a bladder over that of the motion",
            Self::Inertance => "inertia of the fluid in a tube over its resistance",
            Self::Sloshing => "inertia of the fluid along bladders",
            Self::UnsteadyFriction => "error of a steady velocity profile in a tube or a bladder",
            Self::TubeLosses => "losses of a tube over its laminar friction",
            Self::PressureStrain => "strain by pressure over strain by loads",
            Self::Asymmetry => "larger of dm/am, dn/an",
            Self::Compression => "storage by compression over storage by bladder walls",
            Self::StrainEnergy => "largest energy beyond the quadratic part over the quadratic energy",
        })
    }
}

impl Display for Keeps {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::RowsDiffer => "the rows of bladders are not mirror images",
            Self::Resonance => "a load acts near or above the first bending frequency",
            Self::DrivenEnds => "driven ends load the beam by inertia",
            Self::NotHeld => "the ends do not support the beam without it",
            Self::Sudden => "a sudden load excites waves of all lengths",
            Self::Fed => "ports or turbines drive flow through the network",
            Self::AskedWithInertia => "an effect that needs it is switched on by name",
            Self::Dissipation => "it is the only dissipation of the fluid",
            Self::UnevenStart => "the initial pressure differs along a bladder",
            Self::FiniteStrain => "the section is nonlinear at these loads",
            Self::Attachments => {
                "no bound is known for attachments, foundations, rotating frames and loads that turn with the beam"
            }
            Self::Contacts => "no bound is known for walls",
            Self::Gas => "the fluid is a gas",
            Self::Surroundings => "no bound is known for ambient fluid",
            Self::RestCurvature => "no bound is known for a rest curvature",
            Self::Viscoelasticity => "no bound is known for a viscoelastic solid",
            Self::MomentCurvature => "no bound is known for a moment-curvature law",
            Self::MakesPressure => "it generates the pressure",
        })
    }
}
