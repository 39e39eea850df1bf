//! Physics: one cross-section, one bladder, one network, as pure functions generic over the scalar.
//!
//! A [`Model`] is the resolved case: chosen effects, laws as closed enums, signals in place. It is independent of the
//! mesh.

pub mod attachments;
pub mod audit;
pub mod beam;
pub mod bladder;
pub mod bladder_wall_contact;
pub mod characteristic;
pub mod compression;
pub mod contact;
pub mod coupling;
pub mod duct;
pub mod effects;
pub mod kinematics;
pub mod loads;
pub mod mapping;
pub mod network;
pub mod parametric_growth;
pub mod passivity;
pub mod relaxation_times;
pub mod scales;
mod signals;
pub mod storage;
pub mod strain_energy;
mod supports;
pub mod surroundings;
mod vessels;
pub mod water_hammer;

use crate::case::ResolvedEnd;
use crate::case::schema::Effect;
use crate::case::schema::{Bladders, Branch, Case, Effects, Formulation, Viscoelasticity};
use crate::error::Result;
use crate::numerics::Scalar;

pub use attachments::AttachedBody;
pub use beam::Section;
pub use bladder::AreaLaw;
pub use bladder_wall_contact::WallClosing;
pub use compression::Compression;
pub use contact::ContactWall;
pub use coupling::CouplingLaw;
pub use effects::{Decision, EffectScene, EffectSet};
pub use kinematics::Kinematics;
pub use loads::DistributedLoad;
pub use network::ResolvedNetwork;
pub use scales::Scales;
pub use signals::each_signal;
pub use storage::{LumpedKind, LumpedNetwork, Storage};
pub use strain_energy::StrainPotential;
pub use surroundings::AmbientFluid;

/// Bladders with their fluid and network.
#[derive(Clone, Debug)]
pub struct Wet {
    /// Bladders in a row, `n/2`.
    pub per_row: usize,
    /// Length `l_b` of a bladder [m].
    pub bladder_length: f64,
    /// Cross-section at rest `h_b w_b` [m^2].
    pub area_at_rest: f64,
    /// Area change of a bladder cell; slopes of omitted effects are zero.
    pub area: AreaLaw,
    /// Contact between the walls of a bladder; none if omitted.
    pub closing: Option<WallClosing>,
    /// Compression of the fluid; none for incompressible fluid.
    pub compression: Option<Compression>,
    /// Slopes by which pressure strains the beam; those of omitted effects are zero.
    pub strains: AreaLaw,
    /// Strains caused by pressure.
    pub coupling: CouplingLaw,
    /// Tubes, junctions, ports, turbines.
    pub network: ResolvedNetwork,
    /// True if fluid flows.
    pub flows: bool,
    /// Storage law of each bladder.
    pub storage: Vec<Storage>,
    /// Groups of bladders with a common pressure.
    pub lumped: Vec<LumpedNetwork>,
    /// True if a law depends on mean moments, which are then unknowns.
    pub takes_moments: bool,
    /// True if a law depends on mean forces, which are then unknowns.
    pub takes_forces: bool,
    /// Energy of the section beyond its quadratic part.
    pub strain_energy: Option<StrainPotential>,
}

/// `R` of the rows: upper, lower.
pub const ROWS: [f64; 2] = [1.0, -1.0];

impl Wet {
    /// The bladders of a segment: upper, lower.
    pub fn pair(&self, segment: usize) -> [usize; 2] {
        [segment, self.per_row + segment]
    }

    /// Segment and row `R` of a bladder.
    pub fn place(&self, bladder: usize) -> (usize, f64) {
        let row = bladder / self.per_row;
        (bladder - row * self.per_row, ROWS[row])
    }

    /// `φ_b l_b` for a beam length.
    pub fn length_ratio(&self, length: f64) -> f64 {
        self.bladder_length * self.per_row as f64 / length
    }

    /// Area stored per pressure at ambient pressure [m^2/Pa], with compression.
    pub fn compliance(&self) -> f64 {
        self.compliance_at(0.0)
    }

    /// Area stored per pressure at a pressure [Pa], with compression. Gas stiffens with pressure.
    pub fn compliance_at(&self, pressure: f64) -> f64 {
        match &self.compression {
            None => self.area.per_pressure,
            Some(compression) => self.area.per_pressure + compression.compliance(pressure),
        }
    }

    /// Content of a cell at a pressure [m^2]; `imposed` is the area change by bending and force.
    #[inline]
    pub fn content<T: Scalar>(&self, pressure: T, imposed: T) -> T {
        match &self.compression {
            None => self.swelling(pressure, imposed),
            Some(compression) => compression.content(pressure, self.swelling(pressure, imposed)),
        }
    }

    /// Area change of a cell at a pressure [m^2]; `imposed` is the part by bending and force.
    #[inline]
    pub fn swelling<T: Scalar>(&self, pressure: T, imposed: T) -> T {
        match &self.closing {
            None => pressure * self.area.per_pressure + imposed,
            Some(closing) => closing.swelling(&self.area, pressure, imposed),
        }
    }

    /// Flow potential at a pressure, [E55].
    #[inline]
    pub fn potential<T: Scalar>(&self, pressure: T) -> T {
        match &self.compression {
            None => pressure,
            Some(compression) => compression.potential(pressure),
        }
    }

    /// Energy carried per volume at ambient density [Pa], [E56].
    pub fn enthalpy(&self, pressure: f64) -> f64 {
        self.compression.as_ref().map_or(pressure, |c| c.enthalpy(pressure))
    }

    /// Bladders of a case with all couplings.
    fn new(case: &Case, bladders: &Bladders, section: &Section, network: ResolvedNetwork, effects: &EffectSet) -> Self {
        let area = AreaLaw::new(case, bladders, section, effects.has(Effect::Asymmetry));
        let area_at_rest = bladders.height_m * bladders.width_m;
        let fluid = case.fluid.as_ref().filter(|_| effects.has(Effect::Compressibility));
        let (storage, lumped) = storage::of_bladders(case, &network, effects);
        Self {
            per_row: bladders.per_row,
            bladder_length: bladders.length_m,
            area_at_rest,
            area,
            closing: bladders
                .closing
                .as_ref()
                .map(|written| WallClosing::new(written, area_at_rest)),
            compression: fluid.and_then(|fluid| Compression::new(fluid, area_at_rest)),
            strains: area,
            coupling: CouplingLaw::new(case, bladders),
            network,
            flows: effects.has(Effect::Flow),
            storage,
            lumped,
            takes_moments: true,
            takes_forces: true,
            strain_energy: bladders.strain_energy.as_ref().map(StrainPotential::new),
        }
    }

    /// Removes the couplings of omitted effects. Pressure strains the beam by its own slopes, which depend on M and N
    /// where these are kinked.
    fn reduce(&mut self, effects: &EffectSet) {
        let reciprocal = matches!(self.coupling, CouplingLaw::Reciprocal { .. });
        let bends = effects.has(Effect::PressureToCurvature) && reciprocal && self.strains.moment_half_difference > 0.0;
        let stretches =
            effects.has(Effect::PressureToStretch) && reciprocal && self.strains.force_half_difference > 0.0;
        self.takes_moments = effects.has(Effect::MomentToArea) || bends;
        self.strain_energy = self
            .strain_energy
            .take()
            .filter(|_| effects.has(Effect::NonlinearSection));
        self.takes_forces = effects.has(Effect::AxialStretch) && (effects.has(Effect::ForceToArea) || stretches);
        self.area = self
            .area
            .without(!effects.has(Effect::MomentToArea), !effects.has(Effect::ForceToArea));
        for link in &mut self.network.links {
            link.tube = link.tube.and_then(|tube| tube.reduced(effects));
        }
        let along = &mut self.network.along_bladders;
        *along = along.and_then(|along| along.reduced(effects));
        self.strains = self.strains.without(
            !effects.has(Effect::PressureToCurvature),
            !effects.has(Effect::PressureToStretch),
        );
        self.coupling = self.coupling.without(
            !effects.has(Effect::PressureToCurvature),
            !effects.has(Effect::PressureToStretch),
        );
    }
}

/// A case resolved into physics.
#[derive(Clone, Debug)]
pub struct Model {
    /// Cross-section of the beam.
    pub section: Section,
    /// Length `l_s` [m].
    pub length: f64,
    /// Form of the momentum balance.
    pub formulation: Formulation,
    /// Strain-displacement relations.
    pub kinematics: Kinematics,
    /// Effects that are simulated.
    pub effects: EffectSet,
    /// Conditions at root and tip.
    pub ends: [ResolvedEnd; 2],
    /// Distributed loads.
    pub loads: Vec<DistributedLoad>,
    /// Point masses, springs, dashpots and forces.
    pub attachments: Vec<AttachedBody>,
    /// Walls for contact.
    pub contacts: Vec<ContactWall>,
    /// Branches of a relaxing solid.
    pub relaxation: Vec<Branch>,
    /// Ambient fluid.
    pub surroundings: Option<AmbientFluid>,
    /// Fluid and bladders; none for a dry beam.
    pub wet: Option<Wet>,
    /// Characteristic size of every kind of unknown.
    pub scales: Scales,
    /// True if ends and streams have zero velocity despite their signals: for equilibria, whose time is the load
    /// factor.
    pub still: bool,
}

impl Model {
    /// Model of a checked case, with effects chosen as its settings require.
    ///
    /// # Errors
    /// Returns the errors of [`Network::of`]: a name in the network that does not exist.
    pub fn new(case: &Case) -> Result<Self> {
        let section = Section::new(case);
        let network = ResolvedNetwork::from_case(case)?;
        let mut effects = EffectSet::whole(case, network.as_ref());
        if case.effects != Effects::Full {
            let whole = case.bladders.as_ref().zip(network.clone());
            let whole = whole.map(|(bladders, network)| Wet::new(case, bladders, &section, network, &effects));
            effects = EffectSet::choose(
                case,
                network.as_ref(),
                &EffectScene::new(case, &section, whole.as_ref()),
            );
        }
        let network = network.map(|network| ResolvedNetwork { paced: true, ..network });
        Ok(Self::from_parts(case, section, network, effects))
    }

    /// Model with all effects that a checked case does not switch off by name; `inertia` includes inertia of the solid.
    pub fn whole(case: &Case, inertia: bool) -> Result<Self> {
        let network = ResolvedNetwork::from_case(case)?;
        let effects = EffectSet::whole(case, network.as_ref());
        let effects = if inertia { effects } else { effects.at_rest() };
        Ok(Self::from_parts(case, Section::new(case), network, effects))
    }

    /// Model for a modal analysis: all effects, with inertia. Unsteady friction is omitted unless switched on by name,
    /// or unless fluid oscillates against a vessel too fast for Poiseuille's profile. The ten decay modes of unsteady
    /// friction per tube would crowd the spectrum.
    pub fn of_modes(case: &Case) -> Result<Self> {
        let network = ResolvedNetwork::from_case(case)?;
        let effects = EffectSet::whole(case, network.as_ref());
        let whole = Self::from_parts(case, Section::new(case), network.clone(), effects);
        if whole.wet.as_ref().is_some_and(Wet::swings_fast) {
            return Ok(whole);
        }
        Ok(Self::from_parts(
            case,
            whole.section,
            network,
            whole.effects.forgetting(),
        ))
    }

    /// Model of a changed case with the effects and scales of this model.
    pub fn like(&self, case: &Case) -> Result<Self> {
        let paced = self.wet.as_ref().is_some_and(|wet| wet.network.paced);
        let network = ResolvedNetwork::from_case(case)?.map(|network| ResolvedNetwork { paced, ..network });
        Ok(Self {
            scales: self.scales,
            ..Self::from_parts(case, Section::new(case), network, self.effects.clone())
        })
    }

    /// Model of a case with the effects of this model, without inertia of the solid.
    pub fn at_rest(&self, case: &Case) -> Result<Self> {
        let effects = self.effects.clone().at_rest();
        Ok(Self::from_parts(
            case,
            self.section,
            ResolvedNetwork::from_case(case)?,
            effects,
        ))
    }

    fn from_parts(case: &Case, section: Section, network: Option<ResolvedNetwork>, effects: EffectSet) -> Self {
        let mut wet = case
            .bladders
            .as_ref()
            .zip(network)
            .filter(|_| effects.has(Effect::Fluid))
            .map(|(bladders, network)| Wet::new(case, bladders, &section, network, &effects));
        let loads = case
            .loads
            .iter()
            .flat_map(|load| DistributedLoad::resolve(load, &section))
            .collect();
        let ends = [case.ends.root.resolve(), case.ends.tip.resolve()];
        let scales = Scales::estimate(case, &section, wet.as_ref());
        if let Some(wet) = &mut wet {
            wet.reduce(&effects);
        }
        let kinematics = Kinematics::from_effects(&effects);
        Self {
            section,
            length: case.beam.length_m,
            formulation: case.formulation,
            kinematics,
            effects,
            ends,
            loads,
            attachments: AttachedBody::all(case),
            contacts: ContactWall::all(case),
            relaxation: (case.beam.viscoelasticity.as_ref())
                .and_then(Viscoelasticity::branches)
                .unwrap_or_default(),
            surroundings: AmbientFluid::from_case(case),
            wet,
            scales,
            still: false,
        }
    }

    /// Finite volumes per bladder: the mesh setting, or one without flow along bladders.
    pub fn cells_per_bladder(&self, case: &Case) -> usize {
        if self.effects.has(Effect::FlowAlongBladders) {
            case.mesh.cells_per_bladder
        } else {
            1
        }
    }

    /// Bladders and the section's energy beyond its quadratic part, if simulated.
    #[inline]
    pub fn strain_energy(&self) -> Option<(&Wet, &StrainPotential)> {
        let wet = self.wet.as_ref()?;
        Some((wet, wet.strain_energy.as_ref()?))
    }

    /// True if the additional forces of the published form act.
    pub fn published(&self) -> bool {
        self.formulation == Formulation::Published && self.kinematics == Kinematics::FiniteRotation
    }
}
