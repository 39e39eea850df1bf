//! Which unknowns there are, in which order, what they are called and how large they are.
//!
//! An absent effect is an absent unknown: a driven end has no position, a quasi-static solid no velocities, a dry beam
//! no fluid. Equation i belongs to unknown i.

use std::ops::Range;

use super::{FluidMesh, Mesh};
use crate::case::Translation;
use crate::case::schema::Effect;
use crate::case::wiring::bladder_label;
use crate::model::{Kinematics, Model, PoolKind};

/// Blocks of unknowns, in this order.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Nodes whose `u1` is unknown.
    pub free_u1: Range<usize>,
    /// Nodes whose `u3` is unknown.
    pub free_u3: Range<usize>,
    /// First `u1`.
    pub u1: usize,
    /// First `u3`.
    pub u3: usize,
    /// First `v1`, where it is an unknown.
    pub v1: usize,
    /// First `v3`, where it is an unknown.
    pub v3: usize,
    /// First mean moment `Mbar_j`.
    pub mean_moment: usize,
    /// First mean force `Nbar_j`.
    pub mean_force: usize,
    /// First stored area.
    pub area: usize,
    /// First junction pressure.
    pub junction: usize,
    /// First turbine pressure drop behind a real rectifier.
    pub bridge: usize,
    /// Pressure of each pool, where it is unknown.
    pub pool_pressure: Vec<Option<usize>>,
    /// Volume of each pool, where it is unknown.
    pub pool_volume: Vec<Option<usize>>,
    /// Number of unknowns.
    pub len: usize,
    /// Whether masses resist acceleration.
    pub inertia: bool,
    /// Whether `v1` and `v3` are unknowns: with inertia, but not along a beam without axial waves.
    pub waves: [bool; 2],
    /// Characteristic size of each unknown, in its unit.
    pub scales: Vec<f64>,
    /// Characteristic size of each equation.
    pub row_scales: Vec<f64>,
    /// Whether each unknown is differential.
    pub differential: Vec<bool>,
    names: Vec<Name>,
    per_row: usize,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Name {
    Node(&'static str, usize),
    Segment(&'static str, usize),
    Area(usize, usize),
    Junction(usize),
    Bridge(usize),
    Pool(&'static str, usize),
}

impl Layout {
    /// Unknowns of a model on a mesh.
    pub fn new(model: &Model, mesh: &Mesh, fluid: Option<&FluidMesh>) -> Self {
        let driven = |motion: &Translation| matches!(motion, Translation::Displacement(_));
        let [root, tip] = &model.ends;
        let free =
            |root: &Translation, tip: &Translation| usize::from(driven(root))..mesh.nodes - usize::from(driven(tip));
        let bar = model.kinematics == Kinematics::Bar;
        let free_u1 = if bar {
            0..0
        } else {
            free(&root.transverse, &tip.transverse)
        };
        let free_u3 = if model.effects.has(Effect::AxialStretch) {
            free(&root.axial, &tip.axial)
        } else {
            0..0
        };
        let inertia = model.effects.has(Effect::SolidInertia);
        let waves = [inertia && !bar, inertia && model.effects.has(Effect::AxialInertia)];
        let damped = model.section.drag > 0.0 || model.section.axial_damping_time > 0.0;
        let bent = model.section.bending_damping_time > 0.0;
        let s = &model.scales;
        let cell_mass = model.section.mass_per_length * mesh.h;
        let mut build = Builder::default();

        let force_1 = s.transverse_force.max(1e-12);
        let force_3 = s.axial_force.max(1e-12);
        let row = |waves, rate, force| if waves { rate } else { force };
        let u1 = build.nodes(
            "u1 [m]",
            &free_u1,
            s.transverse,
            row(waves[0], s.transverse_rate, force_1),
            inertia || damped || bent,
        );
        // Without waves the damping of bending alone does not make u3 differential: in a straight beam it acts across.
        let u3 = build.nodes(
            "u3 [m]",
            &free_u3,
            s.axial,
            row(waves[1], s.axial_rate, force_3),
            waves[1] || damped || (bent && !inertia),
        );
        let acceleration = |rate: f64| cell_mass * rate * s.frequency;
        let none = 0..0;
        let v1 = build.nodes(
            "v1 [m/s]",
            if waves[0] { &free_u1 } else { &none },
            s.transverse_rate,
            acceleration(s.transverse_rate),
            true,
        );
        let v3 = build.nodes(
            "v3 [m/s]",
            if waves[1] { &free_u3 } else { &none },
            s.axial_rate,
            acceleration(s.axial_rate),
            true,
        );
        let mut mean_moment = build.len();
        let mut mean_force = mean_moment;
        let (mut area, mut junction, mut bridge) = (mean_moment, mean_moment, mean_moment);
        let (mut pool_pressure, mut pool_volume) = (vec![], vec![]);
        let mut per_row = 0;
        if let (Some(wet), Some(fluid)) = (&model.wet, fluid) {
            per_row = wet.per_row;
            let segments = |takes: bool| if takes { mesh.segments } else { 0 };
            mean_moment = build.segments("mean moment [N m]", segments(wet.takes_moments), s.moment);
            mean_force = build.segments("mean normal force [N]", segments(wet.takes_forces), s.force);
            let stored = wet.area.per_pressure * s.pressure;
            area = build.len();
            for &bladder in &fluid.flowing {
                for cell in 0..fluid.cells_per_bladder {
                    let name = Name::Area(bladder, cell);
                    build.push(name, stored, stored * fluid.ds * s.frequency, true);
                }
            }
            junction = build.len();
            for &j in &fluid.junctions {
                build.push(Name::Junction(j), s.pressure, s.pressure * fluid.conductance, false);
            }
            bridge = build.len();
            for bridge in &fluid.bridges {
                let turbine = wet.network.bridges[bridge.number].turbine;
                let conductance = wet.network.turbines[turbine].conductance;
                build.push(Name::Bridge(bridge.number), s.pressure, s.pressure * conductance, false);
            }
            for pool in &wet.pools {
                let volume = stored * wet.bladder_length * pool.bladders.len() as f64;
                let name = |what| Name::Pool(what, pool.component);
                let closed = pool.kind == PoolKind::Closed;
                let fed = matches!(pool.kind, PoolKind::Fed(_));
                pool_pressure
                    .push((closed || fed).then(|| build.push(name("pressure [Pa]"), s.pressure, volume, false)));
                let rate = volume * s.frequency;
                pool_volume.push(fed.then(|| build.push(name("volume change [m^3]"), volume, rate, true)));
            }
        }
        Self {
            free_u1,
            free_u3,
            u1,
            u3,
            v1,
            v3,
            mean_moment,
            mean_force,
            area,
            junction,
            bridge,
            pool_pressure,
            pool_volume,
            len: build.len(),
            inertia,
            waves,
            scales: build.scales,
            row_scales: build.row_scales,
            differential: build.differential,
            names: build.names,
            per_row,
        }
    }

    /// Name of an unknown with unit and place.
    pub fn name(&self, unknown: usize) -> String {
        let bladder = |b: usize| bladder_label(b, self.per_row);
        match self.names[unknown] {
            Name::Node(what, node) => format!("{what} of node {node}"),
            Name::Segment(what, segment) => format!("{what} of segment {}", segment + 1),
            Name::Area(b, cell) => format!("area change [m^2] of bladder {}, cell {}", bladder(b), cell + 1),
            Name::Junction(j) => format!("pressure [Pa] of junction {}", j + 1),
            Name::Pool(what, component) => format!("{what} of network {}", component + 1),
            Name::Bridge(k) => format!("pressure drop [Pa] of turbine behind rectifier {}", k + 1),
        }
    }
}

#[derive(Default)]
struct Builder {
    scales: Vec<f64>,
    row_scales: Vec<f64>,
    differential: Vec<bool>,
    names: Vec<Name>,
}

impl Builder {
    fn len(&self) -> usize {
        self.scales.len()
    }

    /// Adds an unknown; its index.
    fn push(&mut self, name: Name, scale: f64, row_scale: f64, differential: bool) -> usize {
        self.scales.push(scale);
        self.row_scales.push(row_scale);
        self.differential.push(differential);
        self.names.push(name);
        self.len() - 1
    }

    fn nodes(&mut self, what: &'static str, nodes: &Range<usize>, scale: f64, row: f64, differential: bool) -> usize {
        let first = self.len();
        for node in nodes.clone() {
            self.push(Name::Node(what, node), scale, row, differential);
        }
        first
    }

    fn segments(&mut self, what: &'static str, segments: usize, scale: f64) -> usize {
        let first = self.len();
        for segment in 0..segments {
            self.push(Name::Segment(what, segment), scale, scale, false);
        }
        first
    }
}
