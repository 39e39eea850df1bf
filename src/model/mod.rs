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
mod controllers;
mod convexity;
pub mod coupling;
pub mod duct;
pub mod effects;
pub mod kinematics;
pub mod loads;
pub mod mapping;
pub mod moment_curvature;
pub mod network;
pub mod parametric_growth;
pub mod passivity;
pub mod relaxation_times;
pub mod scales;
mod signals;
pub mod storage;
pub mod strain_energy;
pub mod structure;
mod supports;
pub mod surroundings;
mod vessels;
pub mod water_hammer;
mod wet;

use std::sync::Arc;

use crate::case::ResolvedEnd;
use crate::case::schema::Effect;
use crate::case::schema::{Branch, Case, Effects, Formulation, Viscoelasticity};
use crate::case::spans;
use crate::error::Result;
use crate::functions::Profile;

pub use attachments::AttachedBody;
pub use beam::Section;
pub use bladder::AreaLaw;
pub use bladder_wall_contact::WallClosing;
pub use compression::Compression;
pub use contact::{BeamContactLaw, ContactFace, ContactLaw};
pub use controllers::ControlledInput;
pub use coupling::CouplingLaw;
pub use effects::{Decision, EffectScene, EffectSet};
pub use kinematics::Kinematics;
pub use loads::{DistributedLoad, FrameRotation};
pub use moment_curvature::{BendingLaw, NodeBending};
pub use network::{AlongBladder, ResolvedNetwork};
pub use scales::Scales;
pub use signals::each_signal;
pub use storage::{LumpedKind, LumpedNetwork, Storage};
pub use strain_energy::StrainPotential;
pub use structure::Structure;
pub use surroundings::AmbientFluid;
pub use wet::{ROWS, SegmentLaw, Wet};

/// A case resolved into physics.
#[derive(Clone, Debug)]
pub struct Model {
    /// Cross-section of the beam; with spans, the mean of their sections.
    pub section: Section,
    /// Sections of the segments of a beam with spans; empty for a uniform beam.
    pub sections: Vec<Section>,
    /// Sections within the segments of tapers, at the ends and the midpoints of their cells alternately; empty for a segment with constant
    /// values, and for a beam without tapers.
    pub within: Vec<Vec<Section>>,
    /// Moment-curvature laws of the segments, of a uniform beam one; empty if all are linear.
    pub bending: Vec<Arc<BendingLaw>>,
    /// Length `l_s` [m].
    pub length: f64,
    /// Form of the momentum balance.
    pub formulation: Formulation,
    /// Strain-displacement relations.
    pub kinematics: Kinematics,
    /// Effects that are simulated.
    pub effects: EffectSet,
    /// Conditions at root and tip of each beam; ends with a joint are free.
    pub ends: Vec<ResolvedEnd>,
    /// Pieces of a structure and its joints; none for a single beam.
    pub structure: Option<Structure>,
    /// Distributed loads.
    pub loads: Vec<DistributedLoad>,
    /// Point masses, springs, dashpots and forces.
    pub attachments: Vec<AttachedBody>,
    /// Stiffness of the foundation across and along [N/m^2].
    pub foundation: [Option<Profile>; 2],
    /// Walls and circles for contact.
    pub contacts: Vec<ContactLaw>,
    /// Contact of beams with each other.
    pub beam_contacts: Vec<BeamContactLaw>,
    /// Branches of a relaxing solid.
    pub relaxation: Vec<Branch>,
    /// Ambient fluid.
    pub surroundings: Option<AmbientFluid>,
    /// Rotation of the axes.
    pub frame: Option<FrameRotation>,
    /// Fluid and bladders; none for a dry beam.
    pub wet: Option<Wet>,
    /// Controllers of signals.
    pub controllers: Vec<ControlledInput>,
    /// Characteristic size of every kind of unknown.
    pub scales: Scales,
    /// True if ends and streams have zero velocity despite their signals: for equilibria, whose time is the load
    /// factor.
    pub still: bool,
}

/// Section of a case; with spans, the mean of their sections.
fn mean_section(case: &Case) -> Section {
    let sections = Section::of_segments(case, &spans::segments(case));
    Section::mean(&sections, &spans::segment_lengths(case)).unwrap_or_else(|| Section::new(case))
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
        if case.effects != Effects::Full && !case.is_structure() {
            let case = &*case.with_spanned_outputs();
            let network = ResolvedNetwork::from_case(case)?;
            let whole = case.network_bladders().zip(network.clone());
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
            .network_bladders()
            .zip(network)
            .filter(|_| effects.has(Effect::Fluid))
            .map(|(bladders, network)| Wet::new(case, bladders, &section, network, &effects));
        let loads = case
            .loads
            .iter()
            .flat_map(|load| DistributedLoad::resolve(load, &section))
            .collect();
        let structure = Structure::from_case(case, &effects);
        let scales = match &structure {
            None => Scales::estimate(case, &section, wet.as_ref()),
            Some(structure) => structure.scales(case, &section, wet.as_ref()),
        };
        if let Some(wet) = &mut wet {
            wet.reduce(&effects);
        }
        let kinematics = Kinematics::from_effects(&effects);
        let segments = spans::segments(case);
        let single = Self {
            section,
            sections: Section::of_segments(case, &segments),
            within: Section::within_segments(case, &segments),
            bending: BendingLaw::of_segments(case, &segments),
            length: case.beam.length_m,
            formulation: case.formulation,
            kinematics,
            effects,
            ends: vec![case.ends.root.resolve(), case.ends.tip.resolve()],
            structure,
            loads,
            attachments: AttachedBody::all(case),
            foundation: case
                .foundation
                .as_ref()
                .map_or([None, None], |one| one.stiffness().map(|(_, profile)| profile.cloned())),
            contacts: ContactLaw::all(case, &segments),
            beam_contacts: case.beam_contacts.iter().map(BeamContactLaw::new).collect(),
            relaxation: (case.beam.viscoelasticity.as_ref())
                .and_then(Viscoelasticity::branches)
                .unwrap_or_default(),
            surroundings: AmbientFluid::from_case(case),
            frame: FrameRotation::from_case(case),
            wet,
            controllers: ControlledInput::all(case),
            scales,
            still: false,
        };
        single.joined()
    }

    /// With the ends, loads, attachments and contacts of all beams of its structure.
    fn joined(mut self) -> Self {
        let Some(structure) = &self.structure else {
            return self;
        };
        let models = || structure.beams.iter().map(|beam| &beam.model);
        self.ends = models().flat_map(|model| model.ends.clone()).collect();
        self.loads = models().flat_map(|model| model.loads.clone()).collect();
        self.attachments = models().flat_map(|model| model.attachments.clone()).collect();
        self.contacts = models().flat_map(|model| model.contacts.clone()).collect();
        self
    }

    /// Conditions at root and tip of the only beam, or of the first one.
    pub fn root_and_tip(&self) -> &[ResolvedEnd; 2] {
        static FREE: [ResolvedEnd; 2] = [ResolvedEnd::FREE, ResolvedEnd::FREE];
        self.ends.first_chunk().unwrap_or(&FREE)
    }

    /// Section of a segment.
    #[inline]
    pub fn section_of(&self, segment: usize) -> &Section {
        self.sections.get(segment).unwrap_or(&self.section)
    }

    /// True if a segment has a bladder.
    fn has_bladders(&self, segment: usize) -> bool {
        let wet = self.wet.as_ref().filter(|wet| wet.per_row > 0);
        wet.is_some_and(|wet| wet.pair(segment).into_iter().any(|bladder| wet.has(bladder)))
    }

    /// For a beam with spans, the uniform beam of each segment with bladders; of equal neighbors one.
    pub fn uniform_parts(&self) -> impl Iterator<Item = Self> + '_ {
        let there = |j: &usize| self.has_bladders(*j);
        let differs = move |j: &usize| {
            let same = |wet: &Wet| wet.segments[*j] == wet.segments[j - 1] && self.sections[*j] == self.sections[j - 1];
            *j == 0 || !there(&(j - 1)) || !self.wet.as_ref().is_some_and(same)
        };
        (0..self.sections.len())
            .filter(there)
            .filter(differs)
            .map(|j| self.uniform_part(j))
    }

    /// Uniform beam with the section and the bladders of one segment.
    fn uniform_part(&self, segment: usize) -> Self {
        let mut model = self.clone();
        model.section = self.sections[segment];
        model.sections.clear();
        model.within.clear();
        if let Some(law) = self.bending.get(segment) {
            model.bending = vec![law.clone()];
        }
        if let Some(wet) = &mut model.wet {
            let law = wet.segments[segment];
            (wet.area, wet.strains, wet.coupling) = (law.area, law.strains, law.coupling);
            // the length of a beam of such segments
            model.length = wet.bladder_length * wet.per_row as f64 / law.length_ratio;
            wet.per_other_pressure = law.per_other_pressure;
            let there = wet.pair(segment).map(|bladder| wet.storage[bladder]);
            for (row, storage) in wet.storage.chunks_mut(wet.per_row).zip(there) {
                row.fill(storage);
            }
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
