//! Why an effect is simulated or not; words stand in `Display` alone.

use std::fmt::{self, Display, Formatter};

use super::obstacles::Obstacle;
use crate::case::schema::Effect;
use crate::error::numbers::significant;

/// What decided on an effect.
#[derive(Clone, Debug, PartialEq)]
pub enum Cause {
    /// The full model was asked for.
    Full,
    /// It was asked for by name.
    Asked,
    /// It was left out by name.
    LeftOut,
    /// It was to be left out, and cannot be.
    Refused(Obstacle),
    /// It comes by name only, and was not asked for.
    Unasked,
    /// A port's flow enters a junction where only tubes meet, whose inertia does not let it.
    FedJunction,
    /// The published form has no shear.
    Unsheared,
    /// The fluid has no mass.
    Massless,
    /// The case gives it, or not.
    Given(bool),
    /// The case gives bladders and fluid, or not.
    Filled(bool),
    /// It has no meaning without another.
    Needs(Effect),
    /// The reciprocal coupling has no kinks.
    NoKinks,
    /// Something in the case has a meaning only with it.
    Obstacle(Obstacle),
    /// Without it an instability might not show.
    Unstable(String),
    /// It is kept whatever its number.
    Kept(Keeps),
    /// Its number beside the tolerance.
    Weighed(Weighed),
    /// Nothing acts across: part of the buckling load that compression reaches.
    Straight(f64),
    /// All bladders, so many, are sealed.
    Sealed(usize),
    /// Some of all bladders are sealed, and the others are weighed.
    PartlySealed {
        /// Of all.
        sealed: usize,
        /// All.
        all: usize,
        /// What the others leak.
        leaks: Weighed,
    },
}

/// A number that decides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weighed {
    /// What it is.
    pub what: Number,
    /// Its value.
    pub value: f64,
    /// Below this the effect may be left out.
    pub tolerance: f64,
}

impl Weighed {
    /// Whether the effect stays; what is unknown does.
    pub fn on(&self) -> bool {
        self.value.is_nan() || self.value >= self.tolerance
    }
}

/// Numbers that decide.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Number {
    /// Square of the largest angle.
    Rotation,
    /// How much bending draws in over the stretch.
    DrawnIn,
    /// Normal force over the buckling load.
    NormalForce,
    /// Stretch over how much bending draws in.
    Stretch,
    /// Inertia of bending over its stiffness.
    BendingInertia,
    /// Axial waves over the stretch without them.
    AxialWaves,
    /// Phase of the second bending mode in the whole run.
    RotaryInertia,
    /// Shear in the second bending mode, at rest and in the whole run.
    Shear,
    /// What leaks in the whole run.
    Leakage,
    /// A bladder's own time against that of the motion.
    LagAlongBladders,
    /// Inertia of the fluid in a tube over its resistance, at most.
    Inertance,
    /// Inertia of the fluid along bladders over what takes up its flow, at most.
    Sloshing,
    /// Error of a steady profile in a tube or a bladder, at most.
    UnsteadyFriction,
    /// Losses of a tube over its laminar friction, at most.
    TubeLosses,
    /// What pressure does over what loads do.
    PressureStrain,
    /// Larger of dm/am, dn/an.
    Asymmetry,
    /// What compression stores over what the walls of bladders do.
    Compression,
    /// Energy beyond the quadratic part over the quadratic one, at most.
    StrainEnergy,
}

/// What keeps an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keeps {
    /// The rows of bladders differ.
    RowsDiffer,
    /// Something acts near or above the first bending frequency.
    Resonance,
    /// Driven ends act by inertia.
    DrivenEnds,
    /// The ends do not hold the beam.
    NotHeld,
    /// Something acts suddenly.
    Sudden,
    /// Ports or turbines take fluid.
    Fed,
    /// Something that has a meaning only with it is asked for by name.
    AskedWithInertia,
    /// It is all that the fluid dissipates.
    Dissipation,
    /// The start has differences along a bladder.
    UnevenStart,
    /// It makes pressure.
    MakesPressure,
    /// The fluid is a gas.
    Gas,
    /// Something is attached to the beam, which the scene's numbers do not know.
    Attachments,
    /// The beam may strike walls, which the scene's numbers do not know.
    Contacts,
    /// A fluid is around the beam, which the scene's numbers do not know.
    Surroundings,
    /// The beam is curved at rest, which the scene's numbers do not know.
    RestCurvature,
    /// The solid relaxes, which the scene's numbers do not know.
    Viscoelasticity,
    /// The section is not linear at the scene's loads.
    FiniteStrain,
}

impl Display for Cause {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        match self {
            Self::Full => f.write_str("full model asked for"),
            Self::Asked => f.write_str("asked for"),
            Self::LeftOut => f.write_str("left out as asked"),
            Self::Refused(obstacle) => write!(f, "cannot be left out: {}", obstacle.what),
            Self::Unasked => {
                f.write_str("flow in tubes creeps in the published form, unless this is asked for by name")
            }
            Self::Unsheared => f.write_str("the published form does not shear"),
            Self::Massless => f.write_str("the fluid has no mass"),
            Self::FedJunction => f.write_str("left out: the flow of a port enters a junction where only tubes meet"),
            Self::Given(true) => f.write_str("given"),
            Self::Given(false) => f.write_str("not given"),
            Self::Filled(true) => f.write_str("bladders and fluid are given"),
            Self::Filled(false) => f.write_str("no bladders, no fluid"),
            Self::Needs(Effect::NetworkPressureDifferences) => f.write_str("each network has one pressure"),
            Self::Needs(effect) => write!(f, "no {}", effect.name().replace('_', " ")),
            Self::NoKinks => {
                f.write_str("the reciprocal coupling takes mean slopes: the kinked potential is not convex")
            }
            Self::Obstacle(obstacle) => write!(f, "kept: {}", obstacle.what),
            Self::Unstable(why) => write!(f, "kept: {why}"),
            Self::Kept(keeps) => write!(f, "kept: {keeps}"),
            Self::Weighed(weighed) => weighed.fmt(f),
            Self::Straight(pressed) => write!(
                f,
                "nothing acts across, the rows mirror each other, {} of the buckling load",
                significant(*pressed, 2)
            ),
            Self::Sealed(all) => write!(f, "all {all} bladders are sealed: exact without unknowns"),
            Self::PartlySealed { sealed, all, leaks } => write!(f, "{sealed} of {all} bladders are sealed; {leaks}"),
        }
    }
}

impl Display for Weighed {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let value = match self.value.is_finite() {
            true => significant(self.value, 2),
            false => "without bound".into(),
        };
        let side = if self.on() { "not below" } else { "below" };
        write!(f, "{}: {value}, {side} {}", self.what, significant(self.tolerance, 1))
    }
}

impl Display for Number {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Rotation => "square of the largest angle",
            Self::DrawnIn => "how much bending draws in over the stretch",
            Self::NormalForce => "normal force over the buckling load",
            Self::Stretch => "stretch over how much bending draws in",
            Self::BendingInertia => "inertia of bending over its stiffness",
            Self::AxialWaves => "axial waves over the stretch without them",
            Self::RotaryInertia => "phase of the second bending mode in the whole run",
            Self::Shear => "deflection and phase of the second bending mode by shear",
            Self::Leakage => "what leaks in the whole run",
            Self::LagAlongBladders => "a bladder's own time against that of the motion",
            Self::Inertance => "inertia of the fluid in a tube over its resistance",
            Self::Sloshing => "inertia of the fluid along bladders",
            Self::UnsteadyFriction => "error of a steady profile in a tube or a bladder",
            Self::TubeLosses => "losses of a tube over its laminar friction",
            Self::PressureStrain => "what pressure does over what loads do",
            Self::Asymmetry => "larger of dm/am, dn/an",
            Self::Compression => "compression over what the walls of bladders store",
            Self::StrainEnergy => "strain energy beyond the quadratic part over that, at most",
        })
    }
}

impl Display for Keeps {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::RowsDiffer => "the rows of bladders are not each other's mirror image",
            Self::Resonance => "something acts near or above the first bending frequency",
            Self::DrivenEnds => "driven ends act by inertia",
            Self::NotHeld => "the ends do not hold the beam without it",
            Self::Sudden => "something acts suddenly and excites waves of every length",
            Self::Fed => "ports or turbines take fluid through the network",
            Self::AskedWithInertia => "something that needs it is asked for by name",
            Self::Dissipation => "all that the fluid dissipates goes with them",
            Self::UnevenStart => "the start has differences along a bladder",
            Self::FiniteStrain => "the section is not linear at these loads",
            Self::Attachments => "what is attached to the beam has no bound here",
            Self::Contacts => "what walls do to the beam has no bound here",
            Self::Gas => "the fluid is a gas",
            Self::Surroundings => "the fluid around the beam has no bound here",
            Self::RestCurvature => "a beam that is curved at rest has no bound here",
            Self::Viscoelasticity => "a solid that relaxes has no bound here",
            Self::MakesPressure => "it is what makes pressure",
        })
    }
}
