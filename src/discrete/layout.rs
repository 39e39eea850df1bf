//! Which unknowns there are, in which order, what they are called and how large they are.
//!
//! An absent effect is an absent unknown: a driven end has no position, a quasi-static solid no velocities, a dry beam
//! no fluid. Equation i belongs to unknown i. Unknowns come in blocks, [`Line`], [`Coupling`], [`Network`]; each knows its own.

use std::ops::Range;

use super::fluid_mesh::{MeshFlow, MeshLink};
use super::{FluidMesh, Mesh};
use crate::case::Translation;
use crate::case::schema::Effect;
use crate::case::wiring::bladder_label;
use crate::model::{Kinematics, LumpedKind, Model, Wet};

/// Blocks of unknowns, in this order; what each unknown is.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Motion of the beam across (`u1`) and along (`u3`).
    pub lines: [Line; 2],
    /// What a solid that relaxes remembers.
    pub relaxation: Relaxation,
    /// What beam and bladders know of each other.
    pub coupling: Coupling,
    /// Bladders and what joins them.
    pub network: Network,
    /// Number of unknowns.
    pub len: usize,
    /// Whether masses resist acceleration.
    pub inertia: bool,
    /// Characteristic size of each unknown, in its unit.
    pub scales: Vec<f64>,
    /// Characteristic size of each equation.
    pub row_scales: Vec<f64>,
    /// Whether each unknown is differential.
    pub differential: Vec<bool>,
    names: Vec<Name>,
    per_row: usize,
}

/// Motion of the nodes in one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Nodes whose displacement is unknown.
    pub free: Range<usize>,
    /// Their displacements.
    pub u: Range<usize>,
    /// Their velocities; none without inertia, and along a beam without axial waves.
    pub v: Option<Range<usize>>,
}

/// Curvatures and stretches to which the branches of a solid have relaxed, branch by branch.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Relaxation {
    /// At nodes.
    pub curvature: Range<usize>,
    /// In cells.
    pub stretch: Range<usize>,
}

/// Means of segments that bladders feel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Coupling {
    /// Mean moments `Mbar_j`.
    pub mean_moment: Range<usize>,
    /// Mean forces `Nbar_j`.
    pub mean_force: Range<usize>,
    /// Area changes of bladders that the section's energy beyond its quadratic part makes.
    pub nonlinear_area: Range<usize>,
}

/// Unknowns of the fluid.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Network {
    /// Stored areas of cells.
    pub area: Range<usize>,
    /// Pressures of junctions; of those that are accumulators, their volumes.
    pub junction: Range<usize>,
    /// Pressure drops of turbines behind real rectifiers.
    pub bridge: Range<usize>,
    /// Flows of tubes that do not follow from pressures alone.
    pub flow: Range<usize>,
    /// Flows of the branches of their friction.
    pub branch: Range<usize>,
    /// Pressure of each lumped network, where it is unknown.
    pub lumped_pressure: Vec<Option<usize>>,
    /// Volume of each lumped network, where it is unknown.
    pub lumped_volume: Vec<Option<usize>>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Name {
    Node(&'static str, usize),
    Relaxed(&'static str, usize, usize),
    Segment(&'static str, usize),
    Area(usize, usize),
    NonlinearArea(usize),
    Junction(usize),
    Accumulator(usize),
    Bridge(usize),
    Flow(&'static str, usize),
    LumpedNetwork(&'static str, usize),
}

impl Line {
    /// Every free node with its displacement and, where it is an unknown, its velocity.
    pub fn unknowns(&self) -> impl Iterator<Item = (usize, usize, Option<usize>)> {
        let velocity = self.v.as_ref().map(|v| v.start);
        let (free, u) = (self.free.clone(), self.u.start);
        free.enumerate()
            .map(move |(k, node)| (node, u + k, velocity.map(|v| v + k)))
    }

    /// The balance of momentum of a node; none where its motion is given.
    #[inline]
    pub fn momentum(&self, node: usize) -> Option<usize> {
        let rows = self.v.as_ref().unwrap_or(&self.u);
        self.free.contains(&node).then(|| rows.start + node - self.free.start)
    }
}

impl Layout {
    /// Unknowns of a model on a mesh.
    pub fn new(model: &Model, mesh: &Mesh, fluid: Option<&FluidMesh>) -> Self {
        let mut build = Builder::default();
        let lines = Line::both(model, mesh, &mut build);
        let relaxation = Relaxation::new(model, mesh, &mut build);
        let wet = model.wet.as_ref().zip(fluid);
        let coupling = wet.map_or_else(Default::default, |(wet, _)| Coupling::new(model, wet, mesh, &mut build));
        let network = wet.map_or_else(Default::default, |(wet, fluid)| {
            Network::new(model, wet, fluid, &mut build)
        });
        Self {
            lines,
            relaxation,
            coupling,
            network,
            len: build.len(),
            inertia: model.effects.has(Effect::SolidInertia),
            scales: build.scales,
            row_scales: build.row_scales,
            differential: build.differential,
            names: build.names,
            per_row: wet.map_or(0, |(wet, _)| wet.per_row),
        }
    }

    /// Whether velocities across and along are unknowns.
    pub fn waves(&self) -> [bool; 2] {
        self.lines.each_ref().map(|line| line.v.is_some())
    }

    /// Name of an unknown with unit and place.
    pub fn name(&self, unknown: usize) -> String {
        let bladder = |b: usize| bladder_label(b, self.per_row);
        match self.names[unknown] {
            Name::Node(what, node) => format!("{what} of node {node}"),
            Name::Relaxed(what, branch, place) => format!("{what} {place} in branch {} of relaxation", branch + 1),
            Name::Segment(what, segment) => format!("{what} of segment {}", segment + 1),
            Name::Area(b, cell) => format!("area change [m^2] of bladder {}, cell {}", bladder(b), cell + 1),
            Name::NonlinearArea(b) => format!("nonlinear area change [m^2] of bladder {}", bladder(b)),
            Name::Junction(j) => format!("pressure [Pa] of junction {}", j + 1),
            Name::Accumulator(k) => format!("volume [m^3] in accumulator {}", k + 1),
            Name::LumpedNetwork(what, component) => format!("{what} of network {}", component + 1),
            Name::Flow(what, tube) => format!("{what} of tube {}", tube + 1),
            Name::Bridge(k) => format!("pressure drop [Pa] of turbine behind rectifier {}", k + 1),
        }
    }
}

impl Line {
    /// Across and along; displacements of both stand before velocities.
    fn both(model: &Model, mesh: &Mesh, build: &mut Builder) -> [Self; 2] {
        let driven = |motion: &Translation| usize::from(matches!(motion, Translation::Displacement(_)));
        let [root, tip] = &model.ends;
        let free = |root: &Translation, tip: &Translation| driven(root)..mesh.nodes - driven(tip);
        let bar = model.kinematics == Kinematics::Bar;
        let across = if bar {
            0..0
        } else {
            free(&root.transverse, &tip.transverse)
        };
        let along = if model.effects.has(Effect::AxialStretch) {
            free(&root.axial, &tip.axial)
        } else {
            0..0
        };
        let inertia = model.effects.has(Effect::SolidInertia);
        let waves = [inertia && !bar, inertia && model.effects.has(Effect::AxialInertia)];
        let damped = model.section.resists_motion();
        let bent = model.section.bending_damping_time > 0.0;
        // Without waves the damping of bending alone does not make u3 differential: in a straight beam it acts across.
        let differential = [inertia || damped || bent, waves[1] || damped || (bent && !inertia)];
        let s = &model.scales;
        let (sizes, rates) = ([s.transverse, s.axial], [s.transverse_rate, s.axial_rate]);
        let forces = [s.transverse_force, s.axial_force].map(|force| force.max(1e-12));
        let free = [across, along];
        let mut lines = [0, 1].map(|k| {
            let row = if waves[k] { rates[k] } else { forces[k] };
            let u = build.nodes(["u1 [m]", "u3 [m]"][k], &free[k], sizes[k], row, differential[k]);
            let free = free[k].clone();
            Self { free, u, v: None }
        });
        for (k, line) in lines.iter_mut().enumerate().filter(|(k, _)| waves[*k]) {
            let acceleration = model.section.mass_per_length * mesh.h * rates[k] * s.frequency;
            line.v = Some(build.nodes(["v1 [m/s]", "v3 [m/s]"][k], &line.free, rates[k], acceleration, true));
        }
        lines
    }
}

impl Relaxation {
    fn new(model: &Model, mesh: &Mesh, build: &mut Builder) -> Self {
        let (s, section) = (&model.scales, &model.section);
        let mut of = |there: bool, what: &'static str, places: usize, scale: f64| {
            build.block(|build| {
                for (k, branch) in model.relaxation.iter().enumerate().filter(|_| there) {
                    for place in 0..places {
                        let rate = scale * s.frequency.max(1.0 / branch.time_s);
                        build.push(Name::Relaxed(what, k, place), scale, rate, true);
                    }
                }
            })
        };
        let bends = model.kinematics != Kinematics::Bar;
        let stretches = model.effects.has(Effect::AxialStretch);
        Self {
            curvature: of(
                bends,
                "curvature [1/m] of node",
                mesh.nodes,
                s.moment / section.bending_stiffness,
            ),
            stretch: of(
                stretches,
                "stretch of cell",
                mesh.cells,
                s.force / section.axial_stiffness,
            ),
        }
    }
}

impl Coupling {
    fn new(model: &Model, wet: &Wet, mesh: &Mesh, build: &mut Builder) -> Self {
        let segments = |takes: bool| if takes { mesh.segments } else { 0 };
        Self {
            mean_moment: build.segments("mean moment [N m]", segments(wet.takes_moments), model.scales.moment),
            mean_force: build.segments("mean normal force [N]", segments(wet.takes_forces), model.scales.force),
            nonlinear_area: build.block(|build| {
                let scale = wet.area.per_pressure * model.scales.pressure;
                for bladder in (0..2 * wet.per_row).filter(|_| wet.strain_energy.is_some()) {
                    build.push(Name::NonlinearArea(bladder), scale, scale, false);
                }
            }),
        }
    }
}

impl Network {
    fn new(model: &Model, wet: &Wet, fluid: &FluidMesh, build: &mut Builder) -> Self {
        let s = &model.scales;
        let stored = wet.compliance() * s.pressure;
        let area = build.block(|build| {
            for &bladder in &fluid.flowing {
                for cell in 0..fluid.cells_per_bladder {
                    let name = Name::Area(bladder, cell);
                    build.push(name, stored, stored * fluid.ds * s.frequency, true);
                }
            }
        });
        let junction = build.block(|build| {
            for (k, &j) in fluid.junctions.iter().enumerate() {
                match fluid.accumulators.iter().find(|one| one.junction == k) {
                    None => build.push(Name::Junction(j), s.pressure, s.pressure * fluid.conductance, false),
                    Some(one) => {
                        let volume = one.law.volume(s.pressure);
                        build.push(Name::Accumulator(one.number), volume, volume * s.frequency, true)
                    }
                };
            }
        });
        let bridge = build.block(|build| {
            for bridge in &fluid.bridges {
                let turbine = wet.network.bridges[bridge.number].turbine;
                let conductance = wet.network.turbines[turbine].conductance;
                build.push(Name::Bridge(bridge.number), s.pressure, s.pressure * conductance, false);
            }
        });
        let moved = |link: &MeshLink| (stored * wet.bladder_length * s.frequency).min(s.pressure / link.in_series());
        let flows = || fluid.links.iter().filter_map(|link| Some((link, link.flow?)));
        let flow = build.block(|build| {
            for (link, MeshFlow { tube, .. }) in flows() {
                let name = Name::Flow("flow [m^3/s]", wet.network.tube(link.number));
                let row = if link.check_valve.is_some() {
                    moved(link)
                } else {
                    s.pressure
                };
                build.push(name, moved(link), row, tube.inertance > 0.0);
            }
        });
        let branch = build.block(|build| {
            for (link, MeshFlow { tube, .. }) in flows().filter(|(_, flow)| flow.branch.is_some()) {
                let name = Name::Flow("flow [m^3/s] in the memory of friction", wet.network.tube(link.number));
                for (_, rate) in tube.branches() {
                    build.push(name, moved(link), moved(link) * rate.max(s.frequency), true);
                }
            }
        });
        let (mut lumped_pressure, mut lumped_volume) = (vec![], vec![]);
        for lumped in &wet.lumped {
            let volume = stored * wet.bladder_length * lumped.bladders.len() as f64;
            let name = |what| Name::LumpedNetwork(what, lumped.component);
            let closed = lumped.kind == LumpedKind::Closed;
            let fed = matches!(lumped.kind, LumpedKind::Fed(_));
            lumped_pressure.push((closed || fed).then(|| build.push(name("pressure [Pa]"), s.pressure, volume, false)));
            let rate = volume * s.frequency;
            lumped_volume.push(fed.then(|| build.push(name("volume change [m^3]"), volume, rate, true)));
        }
        Self {
            area,
            junction,
            bridge,
            flow,
            branch,
            lumped_pressure,
            lumped_volume,
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

    /// What `add` adds.
    fn block(&mut self, add: impl FnOnce(&mut Self)) -> Range<usize> {
        let first = self.len();
        add(self);
        first..self.len()
    }

    fn nodes(
        &mut self,
        what: &'static str,
        nodes: &Range<usize>,
        scale: f64,
        row: f64,
        differential: bool,
    ) -> Range<usize> {
        self.block(|build| {
            for node in nodes.clone() {
                build.push(Name::Node(what, node), scale, row, differential);
            }
        })
    }

    fn segments(&mut self, what: &'static str, segments: usize, scale: f64) -> Range<usize> {
        self.block(|build| {
            for segment in 0..segments {
                build.push(Name::Segment(what, segment), scale, scale, false);
            }
        })
    }
}
