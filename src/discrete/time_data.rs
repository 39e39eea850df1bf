//! Data that depend only on time, evaluated once per instant.

use super::angle_unwrapping::AngleUnwrapping;
use super::{Statics, System, ValveTangents};
use crate::case::{Rotation, Translation};
use crate::functions::signals::{Jet, Signal, SmoothTime};
use crate::model::attachments::ForceDirection;
use crate::model::loads::LoadKind;
use crate::model::network::Feed;
use crate::numerics::Planar;

/// Opening of a closed valve on a tube whose flow is an unknown.
pub(super) const TIGHT: f64 = 1e-9;

/// Given values at one end of the beam.
#[derive(Clone, Copy, Debug, Default)]
pub struct EndData {
    /// Prescribed transverse and axial displacements, if the motion is prescribed.
    pub u: [Option<Jet>; 2],
    /// Prescribed slope, if the slope is prescribed.
    pub slope: Option<Jet>,
    /// Number of the angle of a joint that the end has, among those of the structure.
    pub joint: Option<usize>,
    /// Prescribed moment (zero if the slope is prescribed).
    pub moment: Jet,
    /// Dead force on the end [N].
    pub force: Planar<f64>,
    /// Section forces N and V along the end's tangent and normal.
    pub follower: Option<(f64, f64)>,
}

/// Forces at an attachment [N].
#[derive(Clone, Copy, Debug, Default)]
pub struct PointForces {
    /// Components in lab axes.
    pub dead: Planar<f64>,
    /// Components along `e_n` and `e_t` of the place.
    pub follower: Planar<f64>,
    /// Part of `dead` that acts on the mass.
    pub weight: Planar<f64>,
}

/// Motion of the straight line through the prescribed displacements of the ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    root: Jet,
    /// Tip less root.
    lean: Jet,
}

impl EndData {
    /// True if the angle of the end does not follow from its moment: it is given, or that of a joint.
    #[inline]
    pub fn turns(&self) -> bool {
        self.slope.is_some() || self.joint.is_some()
    }
}

impl Frame {
    /// Line through both driven ends, or the motion of a single driven end; `None` without driven ends.
    fn through(root: Option<Jet>, tip: Option<Jet>) -> Option<Self> {
        let alone = |root: Jet| Self {
            root,
            lean: Jet::default(),
        };
        match (root, tip) {
            (Some(root), Some(tip)) => Some(Self {
                root,
                lean: Jet {
                    value: tip.value - root.value,
                    rate: tip.rate - root.rate,
                    acceleration: tip.acceleration - root.acceleration,
                    jerk: tip.jerk - root.jerk,
                },
            }),
            (Some(end), None) | (None, Some(end)) => Some(alone(end)),
            (None, None) => None,
        }
    }

    /// True if the two ends move differently.
    #[inline]
    pub fn leans(&self) -> bool {
        self.lean != Jet::default()
    }

    /// Displacement, velocity and acceleration at a fraction of the length, 0 at the root and 1 at the tip.
    #[inline]
    pub fn at(&self, share: f64) -> Jet {
        Jet {
            value: self.root.value + share * self.lean.value,
            rate: self.root.rate + share * self.lean.rate,
            acceleration: self.root.acceleration + share * self.lean.acceleration,
            jerk: self.root.jerk + share * self.lean.jerk,
        }
    }
}

/// Values at one instant.
#[derive(Clone, Debug)]
pub struct TimeData {
    clock: Option<SmoothTime>,
    /// `c_j` of the attempted implicit step, [`crate::dae::Dae::approach`]; 0 before the first [1/s].
    pub cj: f64,
    /// Unwrapped angles of the last state.
    pub turns: AngleUnwrapping,
    /// Tangents of valves, for derivatives.
    pub tangents: ValveTangents,
    /// Root and tip of each beam.
    pub ends: Vec<EndData>,
    /// Nodes of the ends, ascending.
    end_nodes: Vec<usize>,
    /// Force per length at each node [N/m].
    pub force: Vec<Planar<f64>>,
    /// First moment per length in each cell [N].
    pub moment: Vec<Planar<f64>>,
    /// Force per length of each node along its normal (x) and its tangent (z) [N/m]; empty without such loads.
    pub follower: Vec<Planar<f64>>,
    /// Rest curvature of the beam at each node [1/m], and its rate [1/(m s)]; empty if it is straight.
    pub rest_curvature: [Vec<f64>; 2],
    /// Forces at attachments, in the order of the model.
    pub point_force: Vec<PointForces>,
    /// Velocity of the surrounding stream [m/s].
    pub stream: Planar<f64>,
    /// Rate of the stream velocity [m/s^2].
    pub stream_rate: Planar<f64>,
    /// Angular velocity of the rotating frame [rad/s]; zero without one.
    pub frame_rotation: Jet,
    /// Normal forces from loads alone, by statics; empty if the beam can stretch.
    pub statics: Statics,
    /// Conductance of each link [m^3/(s Pa)].
    pub conductance: Vec<f64>,
    /// Resistance of each link between its half cells, including its valve [Pa s/m^3]; infinite if closed.
    pub resistance: Vec<f64>,
    /// Opening of each link's valve.
    pub opening: Vec<f64>,
    /// Prescribed pressure of each port [Pa].
    pub port_pressure: Vec<f64>,
    /// Rate of the prescribed pressures [Pa/s].
    pub port_pressure_rate: Vec<f64>,
    /// Prescribed flow of each source [m^3/s].
    pub source_flow: Vec<f64>,
    /// Volume injected by each source with prescribed volume [m^3]; 0 for other sources.
    pub source_volume: Vec<f64>,
    /// Share of the rest angles of hinges, [`crate::model::Structure::rest`].
    pub hinge_rest: f64,
    /// Part of gravity that acts on the fluid, [`crate::model::ResolvedNetwork::gravity`].
    pub gravity: f64,
    /// Pressure of each pump without flow [Pa], or the factor of its curve.
    pub pump_pressure: Vec<f64>,
}

impl TimeData {
    /// Allocates the data of a system, without evaluating them.
    pub fn new(system: &System) -> Self {
        let network = system.model.wet.as_ref().map(|wet| &wet.network);
        let (ports, sources) = network.map_or((0, 0), |network| (network.ports.len(), network.sources.len()));
        let links = system.fluid.as_ref().map_or(0, |fluid| fluid.links.len());
        let curved = system.loads.iter().any(|load| load.kind == LoadKind::RestCurvature);
        Self {
            clock: None,
            cj: 0.0,
            turns: AngleUnwrapping::default(),
            tangents: ValveTangents::default(),
            ends: {
                let of = |end: usize| EndData {
                    joint: system.joints.angle_of(end),
                    ..EndData::default()
                };
                (0..system.model.ends.len()).map(of).collect()
            },
            end_nodes: system.mesh.ends().map(|(_, end)| end.node).collect(),
            force: vec![Planar::default(); system.mesh.nodes],
            moment: vec![Planar::default(); system.mesh.cells],
            follower: vec![Planar::default(); if system.followed { system.mesh.nodes } else { 0 }],
            rest_curvature: [(); 2].map(|()| vec![0.0; if curved { system.mesh.nodes } else { 0 }]),
            point_force: vec![PointForces::default(); system.model.attachments.len()],
            stream: Planar::default(),
            stream_rate: Planar::default(),
            frame_rotation: Jet::default(),
            statics: Statics::new(system),
            conductance: vec![0.0; links],
            resistance: vec![0.0; links],
            opening: vec![1.0; links],
            port_pressure: vec![0.0; ports],
            port_pressure_rate: vec![0.0; ports],
            source_flow: vec![0.0; sources],
            source_volume: vec![0.0; sources],
            hinge_rest: 1.0,
            gravity: 0.0,
            pump_pressure: vec![0.0; system.fluid.as_ref().map_or(0, |fluid| fluid.pumps.len())],
        }
    }

    /// Given values at a node, if it is an end.
    #[inline]
    pub fn end(&self, node: usize) -> Option<&EndData> {
        self.end_nodes.binary_search(&node).ok().map(|k| &self.ends[k])
    }

    /// Rest curvature of the beam at a node [1/m].
    #[inline]
    pub fn rest_curvature(&self, node: usize) -> f64 {
        self.rest_curvature[0].get(node).copied().unwrap_or(0.0)
    }

    /// Rate of the rest curvature [1/(m s)].
    #[inline]
    pub fn rest_curvature_rate(&self, node: usize) -> f64 {
        self.rest_curvature[1].get(node).copied().unwrap_or(0.0)
    }

    /// Frame of the transverse (0) or axial (1) displacements.
    #[inline]
    pub fn frame(&self, axis: usize) -> Option<Frame> {
        match self.ends[..] {
            [root, tip] => Frame::through(root.u[axis], tip.u[axis]),
            _ => None,
        }
    }

    /// Motion of the transverse (0) or axial (1) frame at a fraction of the length, 0 at the root and 1 at the tip; zero without driven
    /// ends.
    #[inline]
    pub fn carried(&self, axis: usize, share: f64) -> Jet {
        self.frame(axis).map_or_else(Jet::default, |frame| frame.at(share))
    }

    /// True if the ends' prescribed motions equal those of another instance.
    pub fn moves_like(&self, other: &Self) -> bool {
        self.ends.iter().zip(&other.ends).all(|(one, two)| one.u == two.u)
    }

    /// True if all quantities that do work in zero time equal those of another instance: motions and moments of ends, rest curvature,
    /// injected volumes, and normal forces by statics.
    pub fn works_like(&self, other: &Self) -> bool {
        let ends = self.ends.iter().zip(&other.ends);
        self.moves_like(other)
            && ends
                .into_iter()
                .all(|(one, two)| (one.slope, one.moment) == (two.slope, two.moment))
            && self.rest_curvature == other.rest_curvature
            && self.source_volume == other.source_volume
            && (&self.statics.force, &self.statics.mean) == (&other.statics.force, &other.statics.mean)
    }

    /// Time to which the data belong.
    pub fn clock(&self) -> SmoothTime {
        self.clock.unwrap_or(SmoothTime { t: 0.0, within: 0.0 })
    }

    /// Forces the evaluation of all signals by the next update.
    pub fn forget(&mut self) {
        self.clock = None;
    }

    /// Evaluates every signal at `clock`, unless the data already belong to it.
    pub fn update(&mut self, system: &System, clock: SmoothTime) {
        if self.clock == Some(clock) {
            return;
        }
        let first = self.clock.replace(clock).is_none();
        let jet = |s: &Signal| system.model.jet(s, clock);
        for (values, end) in self.ends.iter_mut().zip(&system.model.ends) {
            let motion = |m: &Translation| match m {
                Translation::Displacement(s) => (Some(jet(s)), 0.0),
                Translation::Force(s) => (None, s.jet(clock).value),
            };
            (values.u[0], values.force.x) = motion(&end.transverse);
            (values.u[1], values.force.z) = motion(&end.axial);
            (values.slope, values.moment) = match &end.rotation {
                Rotation::Slope(s) => (Some(jet(s)), Jet::default()),
                Rotation::Moment(s) => (None, jet(s)),
            };
            values.follower = end
                .follower
                .as_ref()
                .map(|f| (f.normal.jet(clock).value, f.shear.jet(clock).value));
        }
        self.hinge_rest = system.model.structure.as_ref().map_or(1.0, |one| jet(&one.rest).value);
        self.loads(system, clock);
        self.point_forces(system, clock);
        let around = system.model.surroundings.as_ref();
        if let Some([x, z]) = around.and_then(|around| around.stream.as_ref()) {
            let [x, z] = [x, z].map(jet);
            self.stream = Planar::new(x.value, z.value);
            self.stream_rate = Planar::new(x.rate, z.rate);
        }
        if let Some(frame) = &system.model.frame {
            self.frame_rotation = jet(&frame.angular_velocity);
        }
        self.statics.update(system, self.frame(1), clock);
        self.network(system, clock, first);
    }

    fn loads(&mut self, system: &System, clock: SmoothTime) {
        if system.loads.is_empty() {
            return;
        }
        self.force.fill(Planar::default());
        self.moment.fill(Planar::default());
        self.follower.fill(Planar::default());
        self.rest_curvature.iter_mut().for_each(|values| values.fill(0.0));
        for load in &system.loads {
            let jet = load.signal.jet(clock);
            let factor = jet.value;
            let (array, axis) = match load.kind {
                LoadKind::ForceX => (&mut self.force, 0),
                LoadKind::ForceZ => (&mut self.force, 1),
                LoadKind::Normal => (&mut self.follower, 0),
                LoadKind::Tangential => (&mut self.follower, 1),
                LoadKind::MomentX => (&mut self.moment, 0),
                LoadKind::MomentZ => (&mut self.moment, 1),
                LoadKind::RestCurvature => {
                    for (values, factor) in self.rest_curvature.iter_mut().zip([jet.value, jet.rate]) {
                        let shaped = values[load.first..].iter_mut().zip(&load.shape);
                        shaped.for_each(|(value, shape)| *value += factor * shape);
                    }
                    continue;
                }
            };
            for (value, shape) in array[load.first..].iter_mut().zip(&load.shape) {
                value[axis] += factor * shape;
            }
        }
    }

    fn point_forces(&mut self, system: &System, clock: SmoothTime) {
        self.point_force.fill(PointForces::default());
        for (total, attachment) in self.point_force.iter_mut().zip(&system.model.attachments) {
            for given in &attachment.forces {
                let size = given.factor * given.signal.jet(clock).value;
                match given.acting {
                    ForceDirection::Dead => total.dead[given.axis] += size,
                    ForceDirection::Weight => {
                        total.dead[given.axis] += size;
                        total.weight[given.axis] += size;
                    }
                    ForceDirection::Follower => total.follower[given.axis] += size,
                }
            }
        }
    }

    fn network(&mut self, system: &System, clock: SmoothTime, first: bool) {
        let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
            return;
        };
        if first {
            for (k, link) in fluid.links.iter().enumerate() {
                self.conductance[k] = 1.0 / link.in_series();
                self.resistance[k] = link.resistance;
            }
        }
        for &k in &fluid.sorted.valves {
            let link = &fluid.links[k];
            let valve = link
                .number
                .and_then(|number| wet.network.links[number].opening.as_ref());
            let mut o = valve.map_or(1.0, |opening| opening.jet(clock).value.clamp(0.0, 1.0));
            if link.flow.is_some() {
                o = o.max(TIGHT);
            }
            self.opening[k] = o;
            self.conductance[k] = o / (o * (link.half_cells + link.of_pump) + link.resistance);
            self.resistance[k] = link.resistance / o;
        }
        for (k, port) in wet.network.ports.iter().enumerate() {
            let pressure = port.pressure.jet(clock);
            (self.port_pressure[k], self.port_pressure_rate[k]) = (pressure.value, pressure.rate);
        }
        for (k, source) in wet.network.sources.iter().enumerate() {
            match &source.feed {
                Feed::Flow(flow) => self.source_flow[k] = flow.jet(clock).value,
                Feed::Volume(volume) => {
                    let volume = volume.jet(clock);
                    self.source_volume[k] = volume.value;
                    self.source_flow[k] = if wet.network.still { 0.0 } else { volume.rate };
                }
            }
        }
        self.gravity = wet.network.gravity.as_ref().map_or(0.0, |part| part.jet(clock).value);
        for (value, &link) in self.pump_pressure.iter_mut().zip(&fluid.pumps) {
            let pump = wet.network.links[link].pump.as_ref();
            *value = pump.map_or(0.0, |pump| pump.pressure.jet(clock).value);
        }
    }
}
