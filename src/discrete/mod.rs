//! Space: the mesh, the unknowns, the semi-discrete equations in the paper's order, and their exact balances.

pub mod attached;
pub mod bodies;
pub mod crossing;
pub mod fluid_mesh;
pub mod glance;
pub mod kick;
pub mod layout;
pub mod ledger;
pub mod let_in;
pub mod mesh;
pub mod quantities;
pub mod readings;
pub mod residual;
pub mod resolution;
pub mod shapes;
pub mod sorted_links;
pub mod start;
pub mod statics;
pub mod straight;
pub mod time_data;
pub mod touching;
pub mod turning;
pub mod turns;
pub mod valve_tangents;
pub mod waves;
pub mod workspace;

use crate::case::schema::{Case, Effect};
use crate::error::{Code, Result, Violation};
use crate::functions::Signal;
use crate::model::loads::LoadKind;
use crate::model::{Model, Storage, audit};

pub use attached::Attached;
pub use bodies::Body;
pub use fluid_mesh::FluidMesh;
pub use layout::Layout;
pub use mesh::Mesh;
pub use quantities::Probe;
pub use statics::Statics;
pub use time_data::{SampledLoad, TimeData};
pub use touching::Touching;
pub use valve_tangents::ValveTangents;
pub use workspace::{State, Workspace};

/// A model on a mesh: everything the residual needs besides time and state.
#[derive(Clone, Debug)]
pub struct System {
    /// Physics.
    pub model: Model,
    /// Beam mesh.
    pub mesh: Mesh,
    /// Bladder cells and links; absent in a dry beam.
    pub fluid: Option<FluidMesh>,
    /// Unknowns and equations.
    pub layout: Layout,
    /// Distributed loads, sampled.
    pub loads: Vec<SampledLoad>,
    /// What is attached to the beam, in the order of places.
    pub attached: Vec<Attached>,
    /// Those of them that resist turning.
    pub bodies: Vec<Body>,
    /// Where walls are felt, in the order of places.
    pub touching: Vec<Touching>,
    /// Places that are recorded.
    pub probes: Vec<Probe>,
    /// Masses of the nodes [kg].
    pub masses: Vec<f64>,
    /// Lengths whose mass nodes have, and over which what surrounds the beam acts on them [m].
    pub lengths: Vec<f64>,
    /// Whether nothing but loads, ends and sections acts on nodes: nothing surrounds the beam, is attached to it or touched by it.
    pub stands_alone: bool,
    /// Whether any load is a distributed moment.
    pub has_moments: bool,
    /// Whether material damping acts.
    pub damped: bool,
}

impl System {
    /// Discretises a checked case with the effects that it chooses. Bladders that keep their volume keep what the same system
    /// with areas as unknowns starts with.
    ///
    /// # Errors
    /// [`Error::Case`](crate::error::Error::Case) with every fault that only the model shows: [`System::accepted`].
    pub fn new(case: &Case) -> Result<Self> {
        Self::chosen(case, Model::new(case)?)
    }

    /// The same with the model that has been chosen for the case already.
    ///
    /// # Errors
    /// As of [`System::new`].
    pub fn chosen(case: &Case, model: Model) -> Result<Self> {
        Self::starting(case, model, |model| Ok(model.clone()))?.accepted(case)
    }

    /// Discretises another model of a checked case; bladders keep the volume that they have at the start of the case.
    pub fn with(case: &Case, model: Model) -> Result<Self> {
        Self::starting(case, model, |_| Model::new(case))
    }

    /// Discretises a changed case with the effects of this system and its scales of unknowns and equations; `None` when the
    /// unknowns are then others.
    pub fn like(&self, case: &Case) -> Result<Option<Self>> {
        self.like_with(case, |_| ())
    }

    /// The same of a model that is changed before.
    pub fn like_with(&self, case: &Case, change: impl FnOnce(&mut Model)) -> Result<Option<Self>> {
        let mut model = self.model.like(case)?;
        change(&mut model);
        let mut system = Self::starting(case, model, |model| Ok(model.clone()))?;
        let same =
            system.layout.differential == self.layout.differential && system.layout.waves() == self.layout.waves();
        system.layout = self.layout.clone();
        Ok(same.then_some(system))
    }

    /// The mass of each node at its displacements, in the scales of unknowns and equations [s^2]; 0 at all other unknowns.
    pub fn nodal_masses(&self) -> Vec<f64> {
        let l = &self.layout;
        let mut masses = vec![0.0; l.len];
        for (node, unknown, _) in l.lines.iter().flat_map(layout::Line::unknowns) {
            masses[unknown] = self.masses[node] * l.scales[unknown] / l.row_scales[unknown];
        }
        masses
    }

    /// Visits every signal that acts, always in the same order.
    fn each_signal_mut(&mut self, mut visit: impl FnMut(&mut Signal)) {
        self.model.each_signal_mut(|signal, _| visit(signal));
        self.loads.iter_mut().for_each(|load| visit(&mut load.signal));
    }

    /// Where in the order of its signals this system has one like another.
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

    /// Puts a signal at places of [`System::places_of`].
    pub fn put_signal(&mut self, places: &[usize], given: &Signal) {
        let mut place = 0;
        self.each_signal_mut(|signal| {
            if places.contains(&place) {
                signal.clone_from(given);
            }
            place += 1;
        });
    }

    /// The system of a case that can be simulated.
    ///
    /// # Errors
    /// [`Error::Case`](crate::error::Error::Case) for an order of the integrator that its waves make unstable, a coupling that
    /// loses convexity, effects that were to be left out and cannot be; all at once, each with its place.
    pub fn accepted(self, case: &Case) -> Result<Self> {
        let mut faults: Vec<_> = waves::refusal(case, &self).into_iter().collect();
        faults.extend(audit::refusals(case, &self.model));
        faults.extend(self.model.effects.refusals.iter().cloned());
        faults.extend(self.fed_junction());
        faults.extend(self.unheld_start(case));
        faults.extend(residual::fourth::refusal(&self.model, &self.mesh));
        match faults.is_empty() {
            true => Ok(self),
            false => Err(case.source.fault(faults)),
        }
    }

    /// Whether rotary inertia resists the turning of the beam's line: sections that shear turn by themselves.
    #[inline]
    pub fn turns_with_its_line(&self) -> bool {
        self.model.effects.has(Effect::RotaryInertia) && !self.model.effects.has(Effect::Shear)
    }

    /// A start in equilibrium of a beam that nothing holds.
    fn unheld_start(&self, case: &Case) -> Option<Violation> {
        let directions = self.model.unheld();
        case.start.equilibrium.as_ref().filter(|_| !directions.is_empty())?;
        let what = format!(
            "nothing holds the beam {}: it has no equilibrium to start from",
            directions.join(" and ")
        );
        let fault = Violation::new(Code::Together, "/start/equilibrium", what);
        Some(fault.hint("hold an end in /ends or attach a spring to ground; or leave the equilibrium out, and the straight beam is let go"))
    }

    /// A junction of tubes with inertia alone into which a port prescribes the flow: the tubes would have to jump with it.
    fn fed_junction(&self) -> Option<Violation> {
        let wet = self
            .model
            .wet
            .as_ref()
            .filter(|wet| self.model.effects.has(Effect::TubeInertia) && wet.compression.is_none())?;
        let name = &wet.network.fed_junction()?.name;
        let what = format!("the flow of port \"{name}\" enters a junction where only tubes with inertia meet");
        let fault = Violation::new(Code::Effect, "/effects/tube_inertia", what);
        Some(fault.hint("put the port at a bladder's end, or leave tube_inertia off"))
    }

    /// `start` gives the model with which the case starts; it is asked only where something of the start is kept.
    fn starting(case: &Case, model: Model, start: impl FnOnce(&Model) -> Result<Model>) -> Result<Self> {
        let mut system = Self::of(case, model);
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
            wet.storage.fill(Storage::Flowing);
            wet.lumped.clear();
        }
        start::areas(&Self::of(case, model), case)
    }

    fn of(case: &Case, model: Model) -> Self {
        let mesh = Mesh::new(model.length, case.segments(), case.mesh.cells_per_segment).of_order(case.mesh.order());
        let fluid = model
            .wet
            .as_ref()
            .map(|wet| FluidMesh::new(wet, model.cells_per_bladder(case)));
        let layout = Layout::new(&model, &mesh, fluid.as_ref());
        let loads: Vec<_> = model.loads.iter().map(|load| SampledLoad::new(load, &mesh)).collect();
        let has_moments = loads
            .iter()
            .any(|l| matches!(l.kind, LoadKind::MomentX | LoadKind::MomentZ));
        let mut lengths: Vec<_> = (0..mesh.nodes).map(|node| mesh.node_length(node)).collect();
        mesh.lump(&mut lengths);
        let (attached, masses) = Attached::all(&model.attachments, &model.section, &mesh, &lengths);
        let bodies = Body::all(&model.attachments, &model.ends, model.kinematics, &mesh);
        let touching = Touching::all(&model.contacts, &mesh);
        let damped = model.section.axial_damping_time > 0.0 || model.section.bending_damping_time > 0.0;
        let nothing_attached = attached.is_empty() && bodies.is_empty() && touching.is_empty();
        Self {
            stands_alone: nothing_attached && !model.section.resists_motion() && model.surroundings.is_none(),
            model,
            probes: Probe::all(case, &mesh),
            mesh,
            fluid,
            layout,
            loads,
            attached,
            bodies,
            touching,
            masses,
            lengths,
            has_moments,
            damped,
        }
    }
}
