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
use crate::case::spans::{self, SegmentValues};
use crate::error::Result;
use crate::functions::Profile;
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

/// Laws of the bladders of one segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegmentLaw {
    /// Area change of a bladder cell; slopes of omitted effects are zero.
    pub area: AreaLaw,
    /// Slopes by which pressure strains the beam; those of omitted effects are zero.
    pub strains: AreaLaw,
    /// Strains caused by pressure.
    pub coupling: CouplingLaw,
    /// Cross-section of a bladder at rest [m^2].
    pub area_at_rest: f64,
    /// Permeability of a bladder over that of [`ResolvedNetwork::bladder_mobility`].
    pub mobility_ratio: f64,
}

impl SegmentLaw {
    fn new(case: &Case, values: &SegmentValues, bladders: &Bladders, section: &Section, asymmetry: bool) -> Self {
        let area = AreaLaw::new(case, bladders, section, asymmetry);
        let usual = case.bladders.as_ref().map_or(1.0, network::bladder_permeability);
        Self {
            area,
            strains: area,
            coupling: CouplingLaw::new(&values.beam, bladders),
            area_at_rest: bladders.height_m * bladders.width_m,
            mobility_ratio: network::bladder_permeability(bladders) / usual,
        }
    }
}

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
    /// Laws of the segments of a beam with spans, of which `area`, `strains` and `coupling` are those of the case; empty for a uniform
    /// beam.
    pub segments: Vec<SegmentLaw>,
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

    /// Area law of a segment.
    #[inline]
    pub fn area_of(&self, segment: usize) -> &AreaLaw {
        self.segments.get(segment).map_or(&self.area, |law| &law.area)
    }

    /// Strains of a segment by pressure, and their slopes.
    #[inline]
    pub fn strains_of(&self, segment: usize) -> (&CouplingLaw, &AreaLaw) {
        let own = self.segments.get(segment);
        own.map_or((&self.coupling, &self.strains), |law| (&law.coupling, &law.strains))
    }

    /// Cross-section of the bladders of a segment at rest [m^2].
    pub fn area_at_rest_of(&self, segment: usize) -> f64 {
        self.segments
            .get(segment)
            .map_or(self.area_at_rest, |law| law.area_at_rest)
    }

    /// Permeability of a bladder over that of most.
    pub fn mobility_ratio(&self, bladder: usize) -> f64 {
        self.segments
            .get(self.place(bladder).0)
            .map_or(1.0, |law| law.mobility_ratio)
    }

    /// Makes the areas of all bladders unknowns.
    pub fn flow_everywhere(&mut self) {
        let there = self.storage.iter_mut().filter(|storage| **storage != Storage::Absent);
        there.for_each(|storage| *storage = Storage::Flowing);
    }

    /// True if a bladder exists.
    pub fn has(&self, bladder: usize) -> bool {
        self.storage[bladder] != Storage::Absent
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

    /// Content of a cell with an area law at a pressure [m^2]; `imposed` is the area change by bending and force.
    #[inline]
    pub fn content<T: Scalar>(&self, law: &AreaLaw, pressure: T, imposed: T) -> T {
        match &self.compression {
            None => self.swelling(law, pressure, imposed),
            Some(compression) => compression.content(pressure, self.swelling(law, pressure, imposed)),
        }
    }

    /// Area change of a cell with an area law at a pressure [m^2]; `imposed` is the part by bending and force.
    #[inline]
    pub fn swelling<T: Scalar>(&self, law: &AreaLaw, pressure: T, imposed: T) -> T {
        match &self.closing {
            None => pressure * law.per_pressure + imposed,
            Some(closing) => closing.swelling(law, pressure, imposed),
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
        let values = spans::segments(case);
        let sections = Section::of_segments(case, &values);
        let segments = values.iter().zip(&sections).map(|(values, section)| {
            let own = values.bladders.as_ref().unwrap_or(bladders);
            SegmentLaw::new(case, values, own, section, effects.has(Effect::Asymmetry))
        });
        let segments = segments.collect();
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
            coupling: CouplingLaw::new(&case.beam, bladders),
            segments,
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
        let areas = self.segments.iter_mut().map(|law| &mut law.area);
        for area in areas.chain([&mut self.area]) {
            *area = area.without(!effects.has(Effect::MomentToArea), !effects.has(Effect::ForceToArea));
        }
        for link in &mut self.network.links {
            link.tube = link.tube.and_then(|tube| tube.reduced(effects));
        }
        let along = &mut self.network.along_bladders;
        *along = along.and_then(|along| along.reduced(effects));
        let [bends, stretches] =
            [Effect::PressureToCurvature, Effect::PressureToStretch].map(|effect| effects.has(effect));
        let laws = self
            .segments
            .iter_mut()
            .map(|law| (&mut law.coupling, &mut law.strains));
        for (coupling, strains) in laws.chain([(&mut self.coupling, &mut self.strains)]) {
            *coupling = coupling.without(!bends, !stretches);
            *strains = strains.without(!bends, !stretches);
        }
    }
}

/// A case resolved into physics.
#[derive(Clone, Debug)]
pub struct Model {
    /// Cross-section of the beam; with spans, the mean of their sections.
    pub section: Section,
    /// Sections of the segments of a beam with spans; empty for a uniform beam.
    pub sections: Vec<Section>,
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
    /// Stiffness of the foundation across and along [N/m^2].
    pub foundation: [Option<Profile>; 2],
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

/// Section of a case; with spans, the mean of their sections.
fn mean_section(case: &Case) -> Section {
    let sections = Section::of_segments(case, &spans::segments(case));
    Section::mean(&sections).unwrap_or_else(|| Section::new(case))
}

impl Model {
    /// Model of a checked case, with effects chosen as its settings require.
    ///
    /// # Errors
    /// Returns the errors of [`Network::of`]: a name in the network that does not exist.
    pub fn new(case: &Case) -> Result<Self> {
        let section = mean_section(case);
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
        Ok(Self::from_parts(case, mean_section(case), network, effects))
    }

    /// Model for a modal analysis: all effects, with inertia. Unsteady friction is omitted unless switched on by name,
    /// or unless fluid oscillates against a vessel too fast for Poiseuille's profile. The ten decay modes of unsteady
    /// friction per tube would crowd the spectrum.
    pub fn of_modes(case: &Case) -> Result<Self> {
        let network = ResolvedNetwork::from_case(case)?;
        let effects = EffectSet::whole(case, network.as_ref());
        let whole = Self::from_parts(case, mean_section(case), network.clone(), effects);
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
            ..Self::from_parts(case, mean_section(case), network, self.effects.clone())
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
            sections: Section::of_segments(case, &spans::segments(case)),
            length: case.beam.length_m,
            formulation: case.formulation,
            kinematics,
            effects,
            ends,
            loads,
            attachments: AttachedBody::all(case),
            foundation: case
                .foundation
                .as_ref()
                .map_or([None, None], |one| one.stiffness().map(|(_, profile)| profile.cloned())),
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

    /// For a beam with spans, the uniform beam of each segment with bladders; of equal neighbors one.
    pub fn uniform_parts(&self) -> impl Iterator<Item = (usize, Self)> + '_ {
        let wet = self.wet.as_ref().filter(|_| !self.sections.is_empty());
        let there = move |j: &usize| wet.is_some_and(|wet| wet.pair(*j).into_iter().any(|bladder| wet.has(bladder)));
        let differs = move |j: &usize| {
            let same = |wet: &Wet| wet.segments[*j] == wet.segments[j - 1] && self.sections[*j] == self.sections[j - 1];
            *j == 0 || !there(&(j - 1)) || wet.is_none_or(|wet| !same(wet))
        };
        (0..self.sections.len())
            .filter(there)
            .filter(differs)
            .map(|j| (j, self.uniform_part(j)))
    }

    /// Uniform beam with the section and the bladders of one segment.
    fn uniform_part(&self, segment: usize) -> Self {
        let mut model = self.clone();
        model.section = self.sections[segment];
        model.sections.clear();
        if let Some(wet) = &mut model.wet {
            let law = wet.segments[segment];
            (wet.area, wet.strains, wet.coupling) = (law.area, law.strains, law.coupling);
            wet.area_at_rest = law.area_at_rest;
            wet.segments.clear();
        }
        model
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
