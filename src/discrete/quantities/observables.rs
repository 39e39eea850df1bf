//! Quantities over time.

use serde::{Deserialize, Serialize};

use super::evaluate::StateView;
use crate::case::schema::Effect;
use crate::discrete::System;
use crate::discrete::ledger::{EnergyRate, passed};
use crate::model::effects::DecisionCause;

/// Source of a quantity.
#[derive(Clone, Copy, Debug)]
pub enum QuantitySource {
    /// The time [s].
    Time,
    /// A state; smooth as long as extreme values stay at their fixed positions.
    State(fn(&StateView) -> f64),
    /// Integrals of [`crate::discrete::ledger::flows`] since the start.
    Integral(fn(&[f64]) -> f64),
    /// Integrals since the start, with the system that determines their index.
    Through(fn(&System, &[f64]) -> f64),
    /// Residual of the energy balance [J].
    Open,
}

/// Group of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// Time itself.
    Time,
    /// Motion of the tip.
    Tip,
    /// Pressures.
    Pressure,
    /// Powers and flows.
    Power,
    /// Other quantities of a state.
    State,
    /// Flow and volume of ports.
    Ports,
    /// Stored energy.
    Stored,
    /// Energy put in.
    PutIn,
    /// Energy added by forms of the equations.
    Added,
    /// Dissipated energy.
    Lost,
    /// Harvested energy.
    Harvested,
    /// Residual of the energy balance.
    Open,
}

impl Group {
    /// Title of the group in a list.
    pub fn title(self) -> &'static str {
        match self {
            Self::Time | Self::Power | Self::State => "More",
            Self::Ports => "Ports",
            Self::Tip => "Tip",
            Self::Pressure => "Pressure",
            Self::Stored => "Energy stored",
            Self::PutIn | Self::Added | Self::Lost | Self::Harvested => "Work done and lost",
            Self::Open => "Unexplained",
        }
    }
}

/// Role of a quantity; each includes the previous ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum QuantityRole {
    /// Recorded only.
    Recorded,
    /// Also used by studies to measure errors.
    Studied,
    /// Shown first.
    Headline,
}

fn always(_: &System) -> bool {
    true
}

fn wet(system: &System) -> bool {
    system.fluid.is_some()
}

fn filled(system: &System) -> bool {
    system.has_bladders()
}

fn attached(system: &System) -> bool {
    let joints = &system.joints;
    !system.attached.is_empty()
        || !system.foundation.is_empty()
        || !joints.hinges.is_empty()
        || !joints.elastic.is_empty()
}

fn inert(system: &System) -> bool {
    let unasked = || system.model.effects.decision(Effect::TubeInertia).cause == DecisionCause::Unasked;
    system.fluid.is_some() && !unasked()
}

fn around(system: &System) -> bool {
    let around = system.model.surroundings.as_ref();
    around.is_some_and(|around| around.stream.is_none()) && system.model.section.ambient.added_mass > 0.0
}

fn nonlinear(system: &System) -> bool {
    system.model.strain_energy().is_some()
}

fn relaxing(system: &System) -> bool {
    !system.model.relaxation.is_empty()
}

fn touching(system: &System) -> bool {
    !system.touching.is_empty()
}

fn accumulating(system: &System) -> bool {
    system
        .fluid
        .as_ref()
        .is_some_and(|fluid| fluid.accumulators.iter().any(|one| one.number.is_some()))
}

fn compressed(system: &System) -> bool {
    system.model.wet.as_ref().is_some_and(|wet| wet.compression.is_some())
}

fn open(system: &System) -> bool {
    let wet = system.model.wet.as_ref().filter(|_| system.fluid.is_some());
    wet.is_some_and(|wet| !wet.network.open.is_empty())
}

/// Total inflow volume of all open networks [m^3].
fn injected(system: &System, integrals: &[f64]) -> f64 {
    let networks = system.model.wet.as_ref().map_or(0, |wet| wet.network.open.len());
    -(0..networks).map(|network| passed(integrals, network).0).sum::<f64>()
}

/// Total inflow through all ports, exactly from the storage of their networks [m^3/s].
fn port_flow(look: &StateView) -> f64 {
    let (Some(wet), Some(fluid)) = (&look.system.model.wet, &look.system.fluid) else {
        return 0.0;
    };
    let open = |bladder: &usize| !wet.network.is_closed(wet.network.component_of_bladder[*bladder]);
    let cells = (0..fluid.bladders)
        .filter(open)
        .flat_map(|bladder| fluid.cells_of(bladder));
    let stored = cells.map(|cell| look.w.fluid.area_rate[cell]).sum::<f64>() * fluid.ds;
    let vessels = fluid.accumulators.iter().zip(&look.w.fluid.accumulated_rate);
    let vessels = vessels.filter(|(one, _)| !wet.network.is_closed(one.component));
    stored + vessels.map(|(_, rate)| rate).sum::<f64>()
}

/// One row of the table.
struct Entry {
    name: &'static str,
    unit: &'static str,
    label: &'static str,
    words: &'static str,
    about: &'static str,
    group: Group,
    role: QuantityRole,
    present: fn(&System) -> bool,
    read: QuantitySource,
}

macro_rules! observables {
    ($($id:ident: $name:literal [$unit:literal], $label:literal, $words:literal, $group:ident, $role:ident, $present:ident, $read:expr,
        $about:literal;)*) => {
        /// A quantity over time: a column of the history.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
        pub enum Observable {
            $(#[doc = $about] $id,)*
        }

        impl Observable {
            /// All observables, in the order of the history.
            pub const ALL: &[Self] = &[$(Self::$id),*];

            fn entry(self) -> &'static Entry {
                &TABLE[self as usize]
            }
        }

        static TABLE: &[Entry] = &[$(Entry {
            name: $name, unit: $unit, label: $label, words: $words, about: $about,
            group: Group::$group, role: QuantityRole::$role, present: $present, read: $read,
        }),*];
    };
}

// name [unit], label, words, group, role, condition, evaluation, description
observables! {
    Time: "t" ["s"], "time", "time", Time, Recorded, always, QuantitySource::Time,
        "time";
    TipU1: "tip_u1" ["m"], "tip u₁", "tip deflection", Tip, Headline, always, QuantitySource::State(|look| look.tip_u1()),
        "transverse displacement of the tip";
    TipU3: "tip_u3" ["m"], "tip u₃", "axial tip displacement", Tip, Headline, always, QuantitySource::State(|look| look.tip_u3()),
        "axial displacement of the tip";
    TipAngle: "tip_angle" ["rad"], "tip angle", "tip angle", Tip, Studied, always, QuantitySource::State(|look| look.tip_angle()),
        "slope angle phi of the tip, counted over full turns";
    MaxPressure: "max_pressure" ["Pa"], "largest pressure", "the largest pressure", Pressure, Headline, wet, QuantitySource::State(|look| look.max_pressure()),
        "highest pressure of all cells of bladders; without bladders, of all junctions";
    MinPressure: "min_pressure" ["Pa"], "smallest pressure", "the smallest pressure", Pressure, Studied, wet, QuantitySource::State(|look| look.min_pressure()),
        "lowest pressure of all cells of bladders; without bladders, of all junctions";
    TurbinePower: "turbine_power" ["W"], "turbine power", "turbine power", Power, Studied, wet, QuantitySource::State(|look| look.turbine_power()),
        "power of all turbines";
    LeastOpening: "least_opening" ["1"], "least opening of a bladder", "least opening of a bladder", State, Recorded, filled, QuantitySource::State(|look| look.least_opening()),
        "smallest bladder cross-section over that at rest; 0 is closed";
    PortFlow: "port_flow" ["m^3/s"], "flow through ports", "the flow through ports", Ports, Recorded, open, QuantitySource::State(port_flow),
        "flow through all ports into the networks";
    InjectedVolume: "injected_volume" ["m^3"], "injected volume", "injected volume", Ports, Recorded, open, QuantitySource::Through(injected),
        "volume injected through all ports since the start, minus the outflow";
    KineticEnergy: "kinetic_energy" ["J"], "kinetic energy", "kinetic energy", Stored, Studied, always, QuantitySource::State(|look| look.stored.kinetic),
        "kinetic energy of the beam's translation";
    RotaryEnergy: "rotary_energy" ["J"], "rotary energy", "rotary energy", Stored, Recorded, always, QuantitySource::State(|look| look.stored.rotary),
        "kinetic energy of the sections' rotation";
    AxialEnergy: "axial_energy" ["J"], "axial energy", "axial energy", Stored, Studied, always, QuantitySource::State(|look| look.stored.axial),
        "elastic energy of stretch";
    BendingEnergy: "bending_energy" ["J"], "bending energy", "bending energy", Stored, Studied, always, QuantitySource::State(|look| look.stored.bending),
        "elastic energy of bending";
    BladderEnergy: "bladder_energy" ["J"], "bladder energy", "bladder energy", Stored, Studied, always, QuantitySource::State(|look| look.stored.bladders),
        "energy stored in the bladders";
    SectionEnergy: "section_energy" ["J"], "section energy", "energy of finite strain", Stored, Recorded, nonlinear, QuantitySource::State(|look| look.stored.section),
        "energy of the section at finite strain, beyond those that are quadratic";
    RelaxingEnergy: "relaxing_energy" ["J"], "relaxing energy", "energy of relaxing branches", Stored, Recorded, relaxing, QuantitySource::State(|look| look.stored.relaxing),
        "energy of the Maxwell branches of moments and normal forces";
    AccumulatorEnergy: "accumulator_energy" ["J"], "accumulator energy", "energy in accumulators", Stored, Recorded, accumulating, QuantitySource::State(|look| look.stored.accumulators),
        "energy in accumulators";
    CompressionEnergy: "compression_energy" ["J"], "compression energy", "energy of compressed fluid", Stored, Recorded, compressed, QuantitySource::State(|look| look.stored.compression),
        "energy of compressed fluid, relative to ambient pressure";
    TubeEnergy: "tube_energy" ["J"], "tube energy", "energy of the fluid in tubes and along bladders", Stored, Recorded, inert, QuantitySource::State(|look| look.stored.tubes),
        "kinetic energy of the fluid in tubes and along bladders";
    ContactEnergy: "contact_energy" ["J"], "contact energy", "elastic energy of contacts", Stored, Recorded, touching, QuantitySource::State(|look| look.stored.contacts),
        "elastic energy of contacts";
    SpringEnergy: "spring_energy" ["J"], "spring energy", "energy of springs to ground and in joints", Stored, Recorded, attached, QuantitySource::State(|look| look.stored.springs),
        "elastic energy of springs between beam and ground";
    SurroundingEnergy: "surrounding_energy" ["J"], "energy around", "energy of the fluid around the beam", Stored, Recorded, around, QuantitySource::State(|look| look.stored.around),
        "kinetic energy of the fluid around that moves with the beam";
    WorkLoads: "work_loads" ["J"], "work of loads", "work of the loads", PutIn, Recorded, always, QuantitySource::Integral(|i| i[EnergyRate::Loads as usize]),
        "work of distributed loads and end forces";
    WorkEnds: "work_ends" ["J"], "work of ends", "work of the driven ends", PutIn, Recorded, always, QuantitySource::Integral(|i| i[EnergyRate::Ends as usize]),
        "work of driven ends and end moments";
    WorkPorts: "work_ports" ["J"], "work of ports", "work of the ports", PutIn, Recorded, always, QuantitySource::Integral(|i| i[EnergyRate::Ports as usize]),
        "work of pressure and flow ports";
    DissipatedBladders: "dissipated_bladders" ["J"], "lost in bladders", "lost to flow in the bladders", Lost, Recorded, always, QuantitySource::Integral(|i| i[EnergyRate::Bladders as usize]),
        "dissipated by flow in the bladders";
    DissipatedTubes: "dissipated_tubes" ["J"], "lost in tubes", "lost to flow in the tubes", Lost, Recorded, always, QuantitySource::Integral(|i| i[EnergyRate::Tubes as usize]),
        "dissipated by flow in the tubes";
    Harvested: "harvested" ["J"], "harvested", "harvested by the turbines", Harvested, Studied, always, QuantitySource::Integral(|i| i[EnergyRate::Turbines as usize]),
        "harvested by the turbines";
    DissipatedRectifiers: "dissipated_rectifiers" ["J"], "lost in rectifiers", "lost in check valves", Lost, Recorded, always, QuantitySource::Integral(|i| i[EnergyRate::Rectifiers as usize]),
        "dissipated in check valves";
    DissipatedDamping: "dissipated_damping" ["J"], "lost in damping", "lost to damping", Lost, Recorded, always, QuantitySource::Integral(|i| i[EnergyRate::Damping as usize]),
        "dissipated by material damping and drag";
    WorkFormulation: "work_formulation" ["J"], "published formulation", "added by the published momentum balance", Added, Recorded, always, QuantitySource::Integral(|i| i[EnergyRate::Formulation as usize]),
        "energy that the published momentum balance adds";
    WorkReciprocity: "work_reciprocity" ["J"], "lack of reciprocity", "added by a coupling without reciprocity", Added, Recorded, always, QuantitySource::Integral(|i| i[EnergyRate::Reciprocity as usize]),
        "energy that a coupling without reciprocity adds";
    EnergyResidual: "energy_residual" ["J"], "open balance", "open balance", Open, Recorded, always, QuantitySource::Open,
        "energy minus energy at the start minus all of the above: error of the integrator";
}

impl Observable {
    /// Name without unit: `tip_u1`.
    pub fn name(self) -> &'static str {
        self.entry().name
    }

    /// Unit, `1` when dimensionless.
    pub fn unit(self) -> &'static str {
        self.entry().unit
    }

    /// Label beside an axis or in a legend.
    pub fn label(self) -> &'static str {
        self.entry().label
    }

    /// Name used within a sentence.
    pub fn describe(self) -> &'static str {
        self.entry().words
    }

    /// Description in one sentence.
    pub fn about(self) -> &'static str {
        self.entry().about
    }

    /// Group of the quantity.
    pub fn group(self) -> Group {
        self.entry().group
    }

    /// Role of the quantity.
    pub fn role(self) -> QuantityRole {
        self.entry().role
    }

    /// Source of the quantity.
    pub fn read(self) -> QuantitySource {
        self.entry().read
    }

    /// Quantity of a given name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|one| one.name() == name)
    }

    /// Quantities in the history of a system.
    pub fn recorded(system: &System) -> Vec<Self> {
        let all = Self::ALL.iter().copied();
        all.filter(|one| (one.entry().present)(system)).collect()
    }

    /// Quantities of a group.
    pub fn grouped(group: Group) -> impl Iterator<Item = Self> {
        Self::ALL.iter().copied().filter(move |one| one.group() == group)
    }

    /// True for quantities that also exist for a state at rest: motion, pressures and elastic quantities.
    pub fn at_rest(self) -> bool {
        match self.group() {
            Group::Tip | Group::Pressure | Group::Power | Group::State => true,
            Group::Stored => !matches!(self, Self::KineticEnergy | Self::RotaryEnergy | Self::SurroundingEnergy),
            _ => false,
        }
    }

    /// True if it has a derivative by a number of the case: not for time, nor for the balance residual, an error of the time integration.
    pub fn has_derivative(self) -> bool {
        !matches!(self.read(), QuantitySource::Time | QuantitySource::Open)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::discrete::ledger::ENERGY_RATES;

    /// Goal: each energy flow has exactly one column, and its sign in the balance agrees with its group.
    #[test]
    fn every_energy_that_flows_has_its_column() {
        for flow in ENERGY_RATES.iter().filter(|flow| flow.energy_sign() != 0.0) {
            let mut one_joule = [0.0; ENERGY_RATES.len()];
            one_joule[*flow as usize] = 1.0;
            let has = |one: &&Observable| matches!(one.read(), QuantitySource::Integral(of) if one.unit() == "J" && of(&one_joule) == 1.0);
            let own: Vec<_> = Observable::ALL.iter().filter(has).collect();
            assert_eq!(own.len(), 1, "{flow:?}");
            let comes_in = matches!(own[0].group(), Group::PutIn | Group::Added);
            assert_eq!(comes_in, flow.energy_sign() > 0.0, "{flow:?}");
        }
    }

    /// Goal: names are unique, and each finds its own quantity.
    #[test]
    fn names_are_unique() {
        for one in Observable::ALL {
            assert_eq!(Observable::named(one.name()), Some(*one));
        }
    }
}
