//! The network as a graph: bladder ends, junctions and ports joined by conductances.

use std::collections::BTreeMap;

use super::duct;
use crate::case::schema::{
    BladderEnd, Bladders, Case, ChainEnd, Endpoint, Fluid, Network as Written, Rectifier, TurbineConductance,
};
use crate::case::signals::Signal;

/// A point of the graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Node {
    /// The outermost cell of a bladder, behind its half-cell resistance.
    Cell {
        /// Bladder, `0..n`: upper row first.
        bladder: usize,
        /// Which of its ends.
        end: BladderEnd,
    },
    /// A junction without storage; its pressure is an unknown.
    Junction(usize),
    /// A point with prescribed pressure.
    Port(usize),
}

/// What resists the flow along a link besides half cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LinkKind {
    /// Nothing: a bladder's end that is a junction or a port.
    Opening,
    /// A tube.
    Tube,
    /// A turbine; index.
    Turbine(usize),
}

/// `[E6]` Two points and what lies between them (A.13, A.67), a valve of opening `o` included:
///
/// ```text
/// q = g (p_a - p_b)    g = o/(o (R_half,a + R_half,b) + R)    R = μ l_c/q1c
/// ```
#[derive(Clone, Debug)]
pub struct Link {
    /// Where positive flow comes from.
    pub from: Node,
    /// Where it goes to.
    pub to: Node,
    /// Resistance between the points, half cells excluded [Pa s/m^3].
    pub resistance: f64,
    /// Opening of the valve; `None`: always open.
    pub opening: Option<Signal>,
    /// What it is.
    pub kind: LinkKind,
}

impl Link {
    /// A valve that never opens.
    pub fn is_shut(&self) -> bool {
        let shut = |o: &Signal| o.is_constant() && o.value(0.0) <= 0.0;
        self.opening.as_ref().is_some_and(shut)
    }
}

/// Prescribed flow into a cell or a junction.
#[derive(Clone, Debug)]
pub struct Source {
    /// Where it enters: a cell or a junction.
    pub into: Node,
    /// Flow [m^3/s].
    pub flow: Signal,
    /// Name.
    pub name: String,
}

/// A prescribed pressure.
#[derive(Clone, Debug)]
pub struct PressurePort {
    /// Pressure [Pa].
    pub pressure: Signal,
    /// Name.
    pub name: String,
}

/// A bridge of four equal real check valves in front of a turbine, between two junctions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bridge {
    /// One port: a junction or a pressure port.
    pub from: Node,
    /// The other.
    pub to: Node,
    /// Turbine that it feeds.
    pub turbine: usize,
    /// Law of one valve.
    pub valve: CheckValve,
}

/// `[E7]` A real check valve, smooth over `width`:
///
/// ```text
/// q(Δ) = G_r Δ + (G_f - G_r) w [ln(1 + e^((Δ - p_c)/w)) - ln(1 + e^(-p_c/w))]
/// ```
///
/// so that `q(0) = 0`, and `q Δ ≥ 0` always.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CheckValve {
    /// `p_c` [Pa].
    pub cracking_pressure: f64,
    /// `G_f` [m^3/(s Pa)].
    pub forward: f64,
    /// `G_r` [m^3/(s Pa)].
    pub reverse: f64,
    /// `w` [Pa].
    pub width: f64,
}

impl CheckValve {
    /// Flow under the pressure drop `drop`.
    #[inline]
    pub fn flow<T: super::Scalar>(&self, drop: T) -> T {
        let closed = f64::ln_1p((-self.cracking_pressure / self.width).exp());
        let open = ((drop - self.cracking_pressure) * (1.0 / self.width)).softplus() - closed;
        drop * self.reverse + open * ((self.forward - self.reverse) * self.width)
    }
}

/// A turbine: conductance and name.
#[derive(Clone, Debug, PartialEq)]
pub struct Turbine {
    /// Name in outputs.
    pub name: String,
    /// `G` [m^3/(s Pa)].
    pub conductance: f64,
}

/// The resolved network.
#[derive(Clone, Debug)]
pub struct Network {
    /// `q1b/mu`, permeability factor included [m^4/(Pa s)].
    pub bladder_mobility: f64,
    /// Conductances between points.
    pub links: Vec<Link>,
    /// Prescribed flows.
    pub sources: Vec<Source>,
    /// Prescribed pressures.
    pub ports: Vec<PressurePort>,
    /// Names of the junctions whose pressures are unknowns.
    pub junctions: Vec<String>,
    /// Turbines.
    pub turbines: Vec<Turbine>,
    /// Real rectifiers.
    pub bridges: Vec<Bridge>,
    /// Component of each bladder; components are joined by links, not through pressure ports.
    pub component_of_bladder: Vec<usize>,
    /// Component of each junction.
    pub component_of_junction: Vec<usize>,
    /// Number of components.
    pub components: usize,
    /// Components that a port or a source touches.
    pub open: Vec<usize>,
    /// Chains of bladders as written: the network coordinate follows them.
    pub chains: Vec<Vec<usize>>,
    /// Tubes of all chains and free tubes, `n_c`.
    pub tubes: usize,
}

/// Index of a bladder `R j` in `0..n`: upper row first.
pub fn bladder_index(signed: i64, per_row: usize) -> usize {
    let j = signed.unsigned_abs() as usize - 1;
    if signed > 0 { j } else { per_row + j }
}

/// `R j` of a bladder index.
pub fn bladder_label(index: usize, per_row: usize) -> i64 {
    if index < per_row {
        index as i64 + 1
    } else {
        -((index - per_row) as i64 + 1)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Point {
    Bladder(usize, BladderEnd),
    Junction(usize),
}

enum Attachment<'a> {
    Tube {
        other: Point,
        resistance: f64,
        opening: &'a Signal,
    },
    Turbine {
        other: Point,
        index: usize,
    },
    Pressure {
        port: usize,
    },
    Flow {
        name: String,
        flow: &'a Signal,
    },
}

impl Network {
    /// Network of a checked case.
    pub fn new(case: &Case, fluid: &Fluid, bladders: &Bladders) -> Self {
        let none = Written::default();
        let written = case.network.as_ref().unwrap_or(&none);
        Builder::new(case, written, fluid, bladders).build()
    }

    /// True when no port or flow source touches the component.
    pub fn is_closed(&self, component: usize) -> bool {
        !self.open.contains(&component)
    }

    /// Of each bladder, whether nothing can ever flow into it or out of it.
    pub fn sealed(&self) -> impl Iterator<Item = bool> + '_ {
        let joined = |bladder: usize| {
            let here = |node: Node| matches!(node, Node::Cell { bladder: b, .. } if b == bladder);
            let links = self.links.iter().filter(|l| !l.is_shut());
            links.into_iter().any(|l| here(l.from) || here(l.to)) || self.sources.iter().any(|s| here(s.into))
        };
        (0..self.component_of_bladder.len()).map(move |bladder| !joined(bladder))
    }

    fn touched_by_a_port(&self, component: usize) -> bool {
        let touches = |node: Node| self.component_of(node) == Some(component);
        let joins =
            |a: Node, b: Node| (touches(a) && matches!(b, Node::Port(_))) || (touches(b) && matches!(a, Node::Port(_)));
        self.sources.iter().any(|s| touches(s.into))
            || self.links.iter().any(|l| !l.is_shut() && joins(l.from, l.to))
            || self.bridges.iter().any(|b| joins(b.from, b.to))
    }

    /// Component of a point; `None` for a pressure port.
    pub fn component_of(&self, node: Node) -> Option<usize> {
        match node {
            Node::Cell { bladder, .. } => Some(self.component_of_bladder[bladder]),
            Node::Junction(j) => Some(self.component_of_junction[j]),
            Node::Port(_) => None,
        }
    }
}

/// Resistance of a tube, `μ l_c/q1c` [Pa s/m^3].
fn tube_resistance(viscosity: f64, length: f64, permeability: f64) -> f64 {
    viscosity * length / permeability
}

/// Unscaled permeability `q1b` of the bladders [m^4].
pub fn bladder_permeability(bladders: &Bladders) -> f64 {
    bladders
        .permeability_m4
        .unwrap_or_else(|| match &bladders.cross_section {
            Some(section) => duct::permeability(section),
            None => duct::rectangle(bladders.height_m, bladders.width_m),
        })
}

struct Builder<'a> {
    case: &'a Case,
    written: &'a Written,
    viscosity: f64,
    permeability: f64,
    per_row: usize,
    bladder_length: f64,
    attachments: BTreeMap<Point, Vec<Attachment<'a>>>,
    ports: Vec<PressurePort>,
    turbines: Vec<Turbine>,
}

impl<'a> Builder<'a> {
    fn new(case: &'a Case, written: &'a Written, fluid: &Fluid, bladders: &Bladders) -> Self {
        Self {
            case,
            written,
            viscosity: fluid.viscosity_pa_s,
            permeability: bladder_permeability(bladders),
            per_row: bladders.per_row,
            bladder_length: bladders.length_m,
            attachments: BTreeMap::new(),
            ports: vec![],
            turbines: vec![],
        }
    }

    fn point(&self, endpoint: &Endpoint) -> Point {
        match (&endpoint.junction, endpoint.bladder, endpoint.end) {
            (Some(name), ..) => Point::Junction(
                self.written
                    .junctions
                    .iter()
                    .position(|j| j == name)
                    .unwrap_or(usize::MAX),
            ),
            (None, bladder, end) => Point::Bladder(
                bladder_index(bladder.unwrap_or(1), self.per_row),
                end.unwrap_or(BladderEnd::Inlet),
            ),
        }
    }

    fn label(&self, point: Point) -> String {
        match point {
            Point::Bladder(b, BladderEnd::Inlet) => format!("inlet of bladder {}", bladder_label(b, self.per_row)),
            Point::Bladder(b, BladderEnd::Outlet) => format!("outlet of bladder {}", bladder_label(b, self.per_row)),
            Point::Junction(j) => self.written.junctions.get(j).cloned().unwrap_or_default(),
        }
    }

    fn attach(&mut self, point: Point, attachment: Attachment<'a>) {
        self.attachments.entry(point).or_default().push(attachment);
    }

    fn pressure(&mut self, point: Point, name: Option<&String>, pressure: &Signal) {
        let name = name.cloned().unwrap_or_else(|| self.label(point));
        self.ports.push(PressurePort {
            pressure: pressure.clone(),
            name,
        });
        self.attach(
            point,
            Attachment::Pressure {
                port: self.ports.len() - 1,
            },
        );
    }

    fn flow(&mut self, point: Point, name: Option<&String>, flow: &'a Signal) {
        let name = name.cloned().unwrap_or_else(|| self.label(point));
        self.attach(point, Attachment::Flow { name, flow });
    }

    fn default_tube(&self) -> (f64, f64) {
        self.case.tubes.as_ref().map_or((1.0, 1.0), |t| {
            (
                t.length_m,
                t.permeability_m4.unwrap_or_else(|| duct::circle(t.radius_m)),
            )
        })
    }

    fn chains(&mut self) -> (Vec<Vec<usize>>, usize) {
        let factor = self.written.permeability_factor;
        let (length, permeability) = self.default_tube();
        let resistance = tube_resistance(self.viscosity, length, permeability * factor);
        let mut tubes = 0;
        let mut chains = vec![];
        for chain in &self.written.chains {
            let row: Vec<usize> = chain.bladders.iter().map(|&b| bladder_index(b, self.per_row)).collect();
            for pair in row.windows(2) {
                let from = Point::Bladder(pair[0], BladderEnd::Outlet);
                let other = Point::Bladder(pair[1], BladderEnd::Inlet);
                self.attach(
                    from,
                    Attachment::Tube {
                        other,
                        resistance,
                        opening: &chain.opening,
                    },
                );
                tubes += 1;
            }
            let first = Point::Bladder(row[0], BladderEnd::Inlet);
            let last = Point::Bladder(row[row.len() - 1], BladderEnd::Outlet);
            for (point, end) in [first, last].into_iter().zip(&chain.ends) {
                match end {
                    ChainEnd::Sealed | ChainEnd::Connected => {}
                    ChainEnd::PressurePa(p) => self.pressure(point, None, p),
                    ChainEnd::FlowM3S(q) => self.flow(point, None, q),
                }
            }
            chains.push(row);
        }
        (chains, tubes)
    }

    fn free_parts(&mut self, chain_tubes: usize) {
        let factor = self.written.permeability_factor;
        let (length, permeability) = self.default_tube();
        for tube in &self.written.tubes {
            let own = tube
                .permeability_m4
                .or_else(|| tube.cross_section.as_ref().map(duct::permeability));
            let resistance = tube_resistance(
                self.viscosity,
                tube.length_m.unwrap_or(length),
                own.unwrap_or(permeability) * factor,
            );
            let (from, other) = (self.point(&tube.from), self.point(&tube.to));
            self.attach(
                from,
                Attachment::Tube {
                    other,
                    resistance,
                    opening: &tube.opening,
                },
            );
        }
        for port in &self.written.ports {
            let point = self.point(&port.at);
            match (&port.pressure_pa, &port.flow_m3_s) {
                (Some(p), _) => self.pressure(point, port.name.as_ref(), p),
                (None, Some(q)) => self.flow(point, port.name.as_ref(), q),
                (None, None) => {}
            }
        }
        for (index, turbine) in self.written.turbines.iter().enumerate() {
            let conductance = match turbine.conductance {
                TurbineConductance::M3SPa(g) => g,
                TurbineConductance::Kappa {
                    kappa,
                    network_length_m,
                } => {
                    let tube = self.case.tubes.as_ref().map_or(0.0, |t| t.length_m);
                    let length = network_length_m
                        .unwrap_or(self.bladder_length * 2.0 * self.per_row as f64 + 0.92 * tube * chain_tubes as f64);
                    self.permeability * kappa / (self.viscosity * length)
                }
            };
            let name = turbine.name.clone().unwrap_or_else(|| format!("turbine-{}", index + 1));
            self.turbines.push(Turbine { name, conductance });
            let (from, other) = (self.point(&turbine.from), self.point(&turbine.to));
            self.attach(from, Attachment::Turbine { other, index });
        }
    }

    fn build(mut self) -> Network {
        let (chains, chain_tubes) = self.chains();
        self.free_parts(chain_tubes);
        let tubes = chain_tubes + self.written.tubes.len();

        // How many things meet at each point, and whether one of them needs a pressure of its own there.
        let mut meeting: BTreeMap<Point, (usize, bool)> = BTreeMap::new();
        let mut count = |point: Point, needs_node: bool| {
            let entry = meeting.entry(point).or_default();
            entry.0 += 1;
            entry.1 |= needs_node;
        };
        let real = |index: usize| matches!(self.written.turbines[index].rectifier, Rectifier::CheckValves { .. });
        for (point, list) in &self.attachments {
            for attachment in list {
                match attachment {
                    Attachment::Tube { other, .. } => {
                        count(*point, false);
                        count(*other, false);
                    }
                    Attachment::Turbine { other, index } => {
                        count(*point, real(*index));
                        count(*other, real(*index));
                    }
                    Attachment::Pressure { .. } | Attachment::Flow { .. } => count(*point, false),
                }
            }
        }

        let mut network = Network {
            bladder_mobility: self.permeability * self.written.permeability_factor / self.viscosity,
            links: vec![],
            sources: vec![],
            ports: std::mem::take(&mut self.ports),
            junctions: vec![],
            turbines: std::mem::take(&mut self.turbines),
            bridges: vec![],
            component_of_bladder: vec![],
            component_of_junction: vec![],
            components: 0,
            open: vec![],
            chains,
            tubes,
        };
        let nodes: BTreeMap<Point, Node> = meeting
            .iter()
            .map(|(&point, &(things, needs_node))| (point, self.node(&mut network, point, things, needs_node)))
            .collect();
        for (point, list) in &self.attachments {
            for attachment in list {
                self.join(&mut network, &nodes, *point, attachment);
            }
        }
        components(&mut network, 2 * self.per_row);
        network.open = (0..network.components)
            .filter(|&c| network.touched_by_a_port(c))
            .collect();
        network
    }

    /// The graph node of a point where `things` meet.
    fn node(&self, network: &mut Network, point: Point, things: usize, needs_node: bool) -> Node {
        let pressure = self.attachments.get(&point).and_then(|list| {
            list.iter().find_map(|a| match a {
                Attachment::Pressure { port } => Some(*port),
                _ => None,
            })
        });
        match (point, pressure) {
            (Point::Bladder(bladder, end), _) if things == 1 && !needs_node => Node::Cell { bladder, end },
            (Point::Bladder(bladder, end), _) => {
                let here = self.shared_node(network, point, pressure);
                network.links.push(Link {
                    from: Node::Cell { bladder, end },
                    to: here,
                    resistance: 0.0,
                    opening: None,
                    kind: LinkKind::Opening,
                });
                here
            }
            (Point::Junction(_), _) => self.shared_node(network, point, pressure),
        }
    }

    fn shared_node(&self, network: &mut Network, point: Point, pressure: Option<usize>) -> Node {
        match pressure {
            Some(port) => Node::Port(port),
            None => {
                network.junctions.push(self.label(point));
                Node::Junction(network.junctions.len() - 1)
            }
        }
    }

    fn join(&self, network: &mut Network, nodes: &BTreeMap<Point, Node>, point: Point, attachment: &Attachment<'a>) {
        let from = nodes[&point];
        match attachment {
            Attachment::Tube {
                other,
                resistance,
                opening,
            } => network.links.push(Link {
                from,
                to: nodes[other],
                resistance: *resistance,
                opening: (!opening.is_one()).then(|| (*opening).clone()),
                kind: LinkKind::Tube,
            }),
            Attachment::Turbine { other, index } => {
                let to = nodes[other];
                match self.written.turbines[*index].rectifier {
                    Rectifier::Ideal => network.links.push(Link {
                        from,
                        to,
                        resistance: 1.0 / network.turbines[*index].conductance,
                        opening: None,
                        kind: LinkKind::Turbine(*index),
                    }),
                    Rectifier::CheckValves {
                        cracking_pressure_pa,
                        forward_conductance_m3_s_pa,
                        reverse_conductance_m3_s_pa,
                        smoothing_pa,
                    } => network.bridges.push(Bridge {
                        from,
                        to,
                        turbine: *index,
                        valve: CheckValve {
                            cracking_pressure: cracking_pressure_pa,
                            forward: forward_conductance_m3_s_pa,
                            reverse: reverse_conductance_m3_s_pa,
                            width: smoothing_pa,
                        },
                    }),
                }
            }
            Attachment::Pressure { port } => {
                if let Node::Cell { .. } = from {
                    network.links.push(Link {
                        from,
                        to: Node::Port(*port),
                        resistance: 0.0,
                        opening: None,
                        kind: LinkKind::Opening,
                    });
                }
            }
            Attachment::Flow { name, flow } => {
                network.sources.push(Source {
                    into: from,
                    flow: (*flow).clone(),
                    name: name.clone(),
                });
            }
        }
    }
}

/// Connected components of bladders and junctions.
fn components(network: &mut Network, bladders: usize) {
    let junctions = network.junctions.len();
    let mut parent: Vec<usize> = (0..bladders + junctions).collect();
    fn root(parent: &mut [usize], mut i: usize) -> usize {
        while parent[i] != i {
            parent[i] = parent[parent[i]];
            i = parent[i];
        }
        i
    }
    let slot = |node: Node| match node {
        Node::Cell { bladder, .. } => Some(bladder),
        Node::Junction(j) => Some(bladders + j),
        Node::Port(_) => None,
    };
    let pairs = network
        .links
        .iter()
        .filter(|l| !l.is_shut())
        .map(|l| (l.from, l.to))
        .chain(network.bridges.iter().map(|b| (b.from, b.to)));
    for (from, to) in pairs {
        if let (Some(a), Some(b)) = (slot(from), slot(to)) {
            let (a, b) = (root(&mut parent, a), root(&mut parent, b));
            parent[a.max(b)] = a.min(b);
        }
    }
    let mut number = vec![usize::MAX; parent.len()];
    let mut next = 0;
    let mut component = Vec::with_capacity(parent.len());
    for i in 0..parent.len() {
        let r = root(&mut parent, i);
        if number[r] == usize::MAX {
            number[r] = next;
            next += 1;
        }
        component.push(number[r]);
    }
    network.component_of_junction = component.split_off(bladders);
    network.component_of_bladder = component;
    network.components = next;
}
