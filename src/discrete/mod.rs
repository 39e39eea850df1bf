//! Discretization in space: the mesh, the unknowns, the semi-discrete equations in the paper's order, and their exact
//! balances.

pub mod angle_unwrapping;
pub mod attached;
pub mod beam_contacts;
pub mod bodies;
mod cell_boxes;
pub mod contact_points;
mod controllers;
pub mod crossing;
pub mod euler_bernoulli_modes;
pub mod extrema;
pub mod fluid_mesh;
pub mod initial_angles;
pub mod injected_volume;
pub mod joints;
pub mod layout;
pub mod ledger;
pub mod mesh;
mod mesh_links;
pub mod quantities;
pub mod readings;
pub mod residual;
pub mod resolution;
mod sampled_load;
pub mod sections;
pub mod shapes;
mod smooth_parts;
pub mod sorted_links;
pub mod start;
pub mod statics;
pub mod structure;
pub mod time_data;
pub mod valve_tangents;
pub mod velocity_jump;
pub mod waves;
pub mod workspace;

use crate::case::schema::{Case, Effect};
use crate::error::{Code, Result, Violation};
use crate::functions::Signal;
use crate::model::loads::LoadKind;
use crate::model::{Model, Storage, audit};
use crate::numerics::Scalar;

pub use attached::MeshedAttachment;
use beam_contacts::MeshBeamContact;
pub use bodies::MeshedBody;
pub use contact_points::ContactPoint;
pub use fluid_mesh::FluidMesh;
pub use joints::MeshJoints;
pub use layout::Layout;
pub use mesh::BeamMesh;
pub use quantities::MeshProbe;
pub use sampled_load::SampledLoad;
pub use sections::MeshSections;
pub use statics::Statics;
use structure::BeamParts;
pub use time_data::TimeData;
pub use valve_tangents::ValveTangents;
pub use workspace::{CompleteState, Workspace};

/// A model on a mesh: all data of the residual except time and state.
#[derive(Clone, Debug)]
pub struct System {
    /// Physics.
    pub model: Model,
    /// Beam mesh.
    pub mesh: BeamMesh,
    /// Bladder cells and links; absent in a dry beam.
    pub fluid: Option<FluidMesh>,
    /// Unknowns and equations.
    pub layout: Layout,
    /// Joints of a structure.
    pub joints: MeshJoints,
    /// Sections of cells and nodes.
    pub sections: MeshSections,
    /// Distributed loads, sampled.
    pub loads: Vec<SampledLoad>,
    /// Attachments of the beam, ordered by place.
    pub attached: Vec<MeshedAttachment>,
    /// Attached bodies with rotary inertia.
    pub bodies: Vec<MeshedBody>,
    /// Contacts of beams with each other.
    pub beam_contacts: Vec<MeshBeamContact>,
    /// Contact points of the beam, ordered by place.
    pub touching: Vec<ContactPoint>,
    /// Stiffness of the foundation at the nodes, across and along [N/m]; empty without a foundation.
    pub foundation: Vec<[f64; 2]>,
    /// Recorded places.
    pub probes: Vec<MeshProbe>,
    /// Masses of the nodes [kg].
    pub masses: Vec<f64>,
    /// Masses of the nodes with those that follow them, of which the own mass is 0 [kg].
    pub masses_in_motion: Vec<f64>,
    /// Lengths over which mass and surroundings act on the nodes [m].
    pub lengths: Vec<f64>,
    /// True if only loads, ends and sections act on nodes: the beam has no surroundings, rotating frame, attachments
    /// or contacts.
    pub stands_alone: bool,
    /// True if a distributed load turns with the beam.
    pub followed: bool,
    /// True if any load is a distributed moment, or the frame rotates sections with rotary inertia.
    pub has_moments: bool,
    /// True if there is material damping.
    pub damped: bool,
}

impl System {
    /// Discretizes a checked case with its chosen effects. Bladders that keep their volume have that of the same system at the start,
    /// computed with areas as unknowns.
    ///
    /// # Errors
    /// [`Error::Case`](crate::error::Error::Case) with every error that only the model reveals, see [`System::accepted`].
    pub fn new(case: &Case) -> Result<Self> {
        Self::chosen(case, Model::new(case)?)
    }

    /// Like [`System::new`], with the model already chosen for the case.
    ///
    /// # Errors
    /// Those of [`System::new`].
    pub fn chosen(case: &Case, model: Model) -> Result<Self> {
        Self::starting(case, model, |model| Ok(model.clone()))?.accepted(case)
    }

    /// True if the fluid fills bladders; false also for a network that only its ports bound.
    pub fn has_bladders(&self) -> bool {
        self.fluid.as_ref().is_some_and(|fluid| fluid.bladders > 0)
    }

    /// Mean pressure of the fluid in each bladder [Pa].
    pub fn pressures_of_fluid<'a, T: Scalar>(&'a self, w: &'a Workspace<T>) -> impl Iterator<Item = T> + 'a {
        (0..w.fluid.mean_pressure.len()).map(|bladder| self.pressure_of_fluid(w, bladder))
    }

    /// Mean pressure of the fluid in a bladder, which touching walls exceed by their own pressure [Pa].
    pub fn pressure_of_fluid<T: Scalar>(&self, w: &Workspace<T>, bladder: usize) -> T {
        let closing = self.model.wet.as_ref().is_some_and(|wet| wet.closing.is_some());
        let Some(fluid) = self.fluid.as_ref().filter(|_| closing) else {
            return w.fluid.mean_pressure[bladder];
        };
        let cells = &w.fluid.pressure[fluid.cells_of(bladder)];
        let mut sum = T::zero();
        cells.iter().for_each(|pressure| sum += *pressure);
        sum * (1.0 / cells.len() as f64)
    }

    /// Discretizes another model of a checked case; bladders keep their volume at the start of the case.
    pub fn with(case: &Case, model: Model) -> Result<Self> {
        Self::starting(case, model, |_| Model::new(case))
    }

    /// Discretizes a changed case with the effects of this system and its scales of unknowns and equations; `None` if the unknowns
    /// differ.
    pub fn like(&self, case: &Case) -> Result<Option<Self>> {
        self.like_with(case, |_| ())
    }

    /// Like [`System::like`], for a model modified by `change`.
    pub fn like_with(&self, case: &Case, change: impl FnOnce(&mut Model)) -> Result<Option<Self>> {
        let mut model = self.model.like(case)?;
        change(&mut model);
        let mut system = Self::starting(case, model, |model| Ok(model.clone()))?;
        let same =
            system.layout.differential == self.layout.differential && system.layout.waves() == self.layout.waves();
        system.layout = self.layout.clone();
        Ok(same.then_some(system))
    }

    /// Mass of each node, at the unknowns of its displacements, in the scales of unknowns and equations [s^2]; 0 at all other unknowns.
    pub fn nodal_masses(&self) -> Vec<f64> {
        let l = &self.layout;
        let mut masses = vec![0.0; l.len];
        for (node, unknown, _) in l.lines.iter().flat_map(layout::LineLayout::unknowns) {
            masses[unknown] = self.masses_in_motion[node] * l.scales[unknown] / l.row_scales[unknown];
        }
        masses
    }

    /// Visits every active signal, always in the same order.
    fn each_signal_mut(&mut self, mut visit: impl FnMut(&mut Signal)) {
        self.model.each_signal_mut(|signal, _| visit(signal));
        self.loads.iter_mut().for_each(|load| visit(&mut load.signal));
    }

    /// Indices, in the order of visits, of the signals equal to `like`.
    pub fn places_of(&mut self, like: &Signal) -> Vec<usize> {
        let (mut all, mut place) = (vec![], 0);
        self.each_signal_mut(|signal| {
            if *signal == *like {
                all.push(place);
            }
            place += 1;
        });
        all
    }

    /// Replaces the signals at the indices from [`System::places_of`].
    pub fn put_signal(&mut self, places: &[usize], given: &Signal) {
        let mut place = 0;
        self.each_signal_mut(|signal| {
            if places.contains(&place) {
                signal.clone_from(given);
            }
            place += 1;
        });
    }

    /// Returns the system if its case can be simulated.
    ///
    /// # Errors
    /// [`Error::Case`](crate::error::Error::Case) for an order of the integrator at which waves are unstable, a coupling that loses
    /// convexity, or effects that cannot be omitted as requested. All errors are reported at once, each with its place.
    pub fn accepted(self, case: &Case) -> Result<Self> {
        let mut faults: Vec<_> = waves::refusal(case, &self).into_iter().collect();
        faults.extend(audit::refusals(case, &self.model));
        faults.extend(self.model.effects.refusals.iter().cloned());
        faults.extend(self.fed_junction());
        faults.extend(self.unheld_start(case));
        faults.extend(self.unmeasured());
        faults.extend(residual::fourth_order::refusal(&self.model, &self.mesh));
        match faults.is_empty() {
            true => Ok(self),
            false => Err(case.source.fault(faults)),
        }
    }

    /// True if rotary inertia acts on the rotation of the beam's line; sections that shear rotate independently.
    #[inline]
    pub fn turns_with_its_line(&self) -> bool {
        self.model.effects.has(Effect::RotaryInertia) && !self.model.effects.has(Effect::Shear)
    }

    /// True if a cell of the fluid belongs to a bladder that exists.
    #[inline]
    pub fn has_cell(&self, cell: usize) -> bool {
        let wet = self.model.wet.as_ref().filter(|wet| !wet.segments.is_empty());
        let both = wet.zip(self.fluid.as_ref());
        both.is_none_or(|(wet, fluid)| wet.has(cell / fluid.cells_per_bladder))
    }

    /// Cross-section of a cell of the fluid at rest [m^2].
    pub fn area_at_rest(&self, cell: usize) -> f64 {
        let both = self.model.wet.as_ref().zip(self.fluid.as_ref());
        both.map_or(1.0, |(wet, fluid)| wet.area_at_rest_of(cell / fluid.cells_per_bladder))
    }

    /// Cell whose cross-section is the smallest relative to that at rest.
    pub fn most_closed(&self, areas: &[f64]) -> usize {
        let (mut least, mut cell) = (f64::INFINITY, 0);
        for (k, area) in areas.iter().enumerate().filter(|(k, _)| self.has_cell(*k)) {
            let relative = match self.model.wet.as_ref().is_some_and(|wet| wet.segments.is_empty()) {
                true => *area,
                false => area / self.area_at_rest(k),
            };
            if relative < least {
                (least, cell) = (relative, k);
            }
        }
        cell
    }

    /// Error if an unsupported beam should start in equilibrium.
    fn unheld_start(&self, case: &Case) -> Option<Violation> {
        let directions = self.model.unheld();
        case.start.equilibrium.as_ref().filter(|_| !directions.is_empty())?;
        let what = format!(
            "nothing holds the beam {}: it has no equilibrium to start from",
            directions.join(" and ")
        );
        let fault = Violation::new(Code::Together, "/start/equilibrium", what);
        Some(fault.hint("hold an end in /ends or attach a spring to ground; or omit the equilibrium, so that the beam starts straight"))
    }

    /// Error if a port prescribes the flow into a junction of tubes with inertia alone: the tubes' flow would have to jump with it.
    fn fed_junction(&self) -> Option<Violation> {
        let wet = self
            .model
            .wet
            .as_ref()
            .filter(|wet| self.model.effects.has(Effect::TubeInertia) && wet.compression.is_none())?;
        let name = &wet.network.fed_junction()?.name;
        let what = format!("the flow of port \"{name}\" enters a junction of tubes with inertia only");
        let fault = Violation::new(Code::Effect, "/effects/tube_inertia", what);
        Some(fault.hint("put the port at a bladder's end, or leave tube_inertia off"))
    }

    /// `start` returns the model at the start of the case; it is called only if part of the start is kept.
    fn starting(case: &Case, model: Model, start: impl FnOnce(&Model) -> Result<Model>) -> Result<Self> {
        let mut system = Self::from_model(case, model);
        if let (Some(wet), Some(fluid)) = (&system.model.wet, &mut system.fluid)
            && wet.storage.iter().any(|s| *s != Storage::Flowing)
        {
            fluid.keep(&Self::areas_at_start(case, start(&system.model)?), wet);
        }
        Ok(system)
    }

    /// Area change of every cell at the start [m^2].
    fn areas_at_start(case: &Case, mut model: Model) -> Vec<f64> {
        if let Some(wet) = &mut model.wet {
            wet.flows = true;
            wet.flow_everywhere();
            wet.lumped.clear();
        }
        start::areas(&Self::from_model(case, model), case)
    }

    fn from_model(case: &Case, model: Model) -> Self {
        let parts = BeamParts::new(case, &model);
        let mesh = parts.mesh;
        let fluid = model
            .wet
            .as_ref()
            .map(|wet| FluidMesh::new(wet, model.cells_per_bladder(case)));
        let joints = MeshJoints::new(&model, &mesh);
        let layout = Layout::new(&model, &mesh, &joints, fluid.as_ref());
        let loads = parts.loads;
        let has_moments = loads
            .iter()
            .any(|l| matches!(l.kind, LoadKind::MomentX | LoadKind::MomentZ))
            || (model.frame.is_some() && model.effects.has(Effect::RotaryInertia));
        let followed = loads
            .iter()
            .any(|l| matches!(l.kind, LoadKind::Normal | LoadKind::Tangential));
        let damped = model.section.axial_damping_time > 0.0 || model.section.bending_damping_time > 0.0;
        let nothing_attached = !followed
            && parts.foundation.is_empty()
            && parts.attached.is_empty()
            && parts.bodies.is_empty()
            && parts.touching.is_empty()
            && model.beam_contacts.is_empty();
        let surrounded = model.surroundings.is_some() || model.frame.is_some();
        let mut masses_in_motion = parts.masses.clone();
        for tie in &joints.ties {
            masses_in_motion[tie.to] += std::mem::take(&mut masses_in_motion[tie.node]);
        }
        let beam_contacts = MeshBeamContact::all(&model, &mesh, &parts.sections);
        Self {
            stands_alone: nothing_attached && !model.section.resists_motion() && !surrounded,
            model,
            probes: parts.probes,
            mesh,
            fluid,
            layout,
            joints,
            sections: parts.sections,
            loads,
            attached: parts.attached,
            bodies: parts.bodies,
            beam_contacts,
            touching: parts.touching,
            foundation: parts.foundation,
            masses: parts.masses,
            masses_in_motion,
            lengths: parts.lengths,
            followed,
            has_moments,
            damped,
        }
    }
}
