//! Water hammer: valves that shut before a pressure wave returns.

use std::f64::consts::PI;

use super::network::{Link, NetworkNode, TubeEnd};
use super::{Compression, Model, ResolvedNetwork};
use crate::case::schema::{Case, Effect};
use crate::error::Code;
use crate::error::numbers::{counted, quantity};
use crate::functions::Signal;
use crate::functions::signals::SmoothTime;

/// Bulk modulus of water [Pa], for liquids without a given one.
const WATER: f64 = 2.2e9;
/// Closing time over the travel time of a wave in one part of a tube above which the parts resolve the wave.
const RESOLVES: f64 = 3.0;
/// Largest number of tube parts that a warning proposes.
const MOST_PARTS: f64 = 100.0;
/// Ratio of valve resistance to wave impedance, `ρ c/A`, above which the valve stops the flow. At three, a quarter of
/// the flow remains.
const THROTTLES: f64 = 3.0;
/// Pressure rise over the driving pressure below which there is no warning.
const SMALL: f64 = 0.05;
/// Opening over the largest opening below which a valve is shut.
const SHUT: f64 = 0.01;
/// Samples of a valve between two switching times.
const LOOKS: usize = 64;

/// Tubes in series in front of a valve.
struct Column<'a> {
    tubes: Vec<&'a Link>,
}

impl Column<'_> {
    fn length(&self) -> f64 {
        self.tubes.iter().map(|tube| length(tube)).sum()
    }

    fn longest(&self) -> f64 {
        self.tubes.iter().map(|tube| length(tube)).fold(0.0, f64::max)
    }
}

/// Cross-section of a tube [m^2].
fn area(tube: &Link) -> f64 {
    PI * tube.radius * tube.radius
}

/// Length of a tube with inertia [m].
fn length(tube: &Link) -> f64 {
    tube.tube.map_or(0.0, |flow| flow.volume / area(tube))
}

/// A closing of a valve in a tube with inertia.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValveClosing {
    /// Number of the tube among the links of the network.
    pub link: usize,
    /// Begin and end of the valve's closing [s].
    pub times: [f64; 2],
    /// Largest opening over the steepest closing rate [s].
    shuts: f64,
}

/// Returns all closings of all valves, in order of links and time.
pub fn closings(case: &Case, model: &Model) -> Vec<ValveClosing> {
    let links = model.wet.iter().flat_map(|wet| wet.network.links.iter().enumerate());
    let of = |(link, valve): (usize, &Link)| {
        let opening = valve.opening.as_ref().filter(|_| valve.inertance() > 0.0);
        let falls = opening
            .map(|opening| falls(opening, case.time.end_s))
            .unwrap_or_default();
        falls
            .into_iter()
            .map(move |(times, shuts)| ValveClosing { link, times, shuts })
    };
    links.flat_map(of).collect()
}

/// Warns of valves that shut in less than `2 l/c`, if the tubes in front do not resolve the wave. The pressure rises by
/// `ρ c Δv` (Joukowsky 1898), `c = 1/√(ρ κ)`. Before a run, `Δv` is bounded by the largest steady flow.
pub fn warnings(case: &Case, model: &Model) -> Vec<String> {
    let Some(line) = Line::new(case, model) else {
        return vec![];
    };
    let of = |closing: ValveClosing| line.hammer(&closing, None);
    line.described(closings(case, model).into_iter().filter_map(of))
}

/// [`warnings`] after a run until `reached` [s], with the flow through each valve as it shut [m^3/s], in the order of
/// [`closings`].
pub fn confirmed(case: &Case, model: &Model, reached: f64, flows: &[f64]) -> Vec<String> {
    let Some(line) = Line::new(case, model) else {
        return vec![];
    };
    let all = closings(case, model).into_iter().zip(flows);
    let begun = all.filter(|(closing, _)| closing.times[0] <= reached);
    line.described(begun.filter_map(|(closing, flow)| line.hammer(&closing, Some(*flow))))
}

/// Data common to all valves of a network.
struct Line<'a> {
    network: &'a ResolvedNetwork,
    /// Stiff ends of tubes.
    ends: Vec<TubeEnd>,
    /// Density [kg/m^3] and velocity of sound [m/s].
    density: f64,
    c: f64,
    /// Largest pressure difference [Pa].
    drive: f64,
    /// Largest prescribed flow into a network component with tubes [m^3/s].
    fed: f64,
    /// True if the model has compressed fluid.
    compressed: bool,
}

impl<'a> Line<'a> {
    fn new(case: &Case, model: &'a Model) -> Option<Self> {
        let (network, fluid) = (&model.wet.as_ref()?.network, case.fluid.as_ref()?);
        let softness = Compression::new(fluid).map_or(1.0 / WATER, |own| own.compressibility(0.0));
        let stiff = |end: &TubeEnd| {
            let walls = end
                .vessel
                .as_ref()
                .map_or(0.0, |law| law.compliance(0.0) + law.volume_at_rest() * softness);
            walls < end.in_tubes * softness
        };
        Some(Self {
            network,
            ends: network.tube_ends().into_iter().filter(stiff).collect(),
            density: fluid.density_kg_m3,
            c: 1.0 / (fluid.density_kg_m3 * softness).sqrt(),
            drive: driving(case, network),
            fed: network.fed_tubes(case.time.end_s),
            compressed: model.effects.has(Effect::Compressibility),
        })
    }

    /// Water hammer of a closing, if it stops a flow [m^3/s] before a wave returns. Without `flow`, uses the largest
    /// steady flow.
    fn hammer(&self, closing: &ValveClosing, flow: Option<f64>) -> Option<Hammer> {
        let (network, c) = (self.network, self.c);
        let valve = &network.links[closing.link];
        let sides = [valve.from, valve.to].map(|node| (node, column(network, &self.ends, valve, node)));
        let (node, column) = sides
            .into_iter()
            .max_by(|(_, a), (_, b)| a.length().total_cmp(&b.length()))?;
        let l = column.length() + length(valve);
        let tubes = || column.tubes.iter().copied().chain([valve]);
        let begins = flow.map(|_| closing.times[0]);
        let flow = flow.unwrap_or_else(|| steady_flow(tubes(), self.drive) + self.fed);
        let narrowest = tubes().map(area).fold(f64::INFINITY, f64::min);
        // the wave enters all tubes in front of the valve
        let front = match node {
            NetworkNode::Junction(junction) if !column.tubes.is_empty() => {
                let others = network.tubes_at(junction).filter(|tube| !std::ptr::eq(*tube, valve));
                others.map(area).sum()
            }
            _ => narrowest,
        };
        let impedance = self.density * c / front;
        // a valve stops flow only where its resistance exceeds the wave impedance
        let resists = valve.resistance
            + valve
                .tube
                .map_or(0.0, |tube| tube.law.loss(flow) / flow.max(f64::MIN_POSITIVE));
        let hammer = Hammer {
            link: closing.link,
            parts: column.tubes.len().max(1),
            shuts: closing.shuts,
            stops: closing.shuts * (THROTTLES * resists / impedance).min(1.0),
            l,
            c,
            rise: impedance * flow,
            velocity: flow / front,
            begins,
            compressed: self.compressed,
        };
        let longest = column.longest().max(length(valve));
        let follows = hammer.compressed && RESOLVES * longest <= c * hammer.stops;
        (hammer.stops < 2.0 * l / c && hammer.rise > SMALL * self.drive && !follows).then_some(hammer)
    }

    /// One warning per valve, for its closing with the largest pressure rise.
    fn described(&self, all: impl Iterator<Item = Hammer>) -> Vec<String> {
        let mut worst: Vec<Hammer> = vec![];
        for hammer in all {
            match worst.last_mut().filter(|last| last.link == hammer.link) {
                Some(last) if last.rise >= hammer.rise => {}
                Some(last) => *last = hammer,
                None => worst.push(hammer),
            }
        }
        let descriptions = worst.iter().map(|hammer| hammer.describe(self.network));
        descriptions.map(|text| Code::WaterHammer.warning(text)).collect()
    }
}

/// A valve that shuts faster than a pressure wave returns.
struct Hammer {
    /// Number of its tube among the links.
    link: usize,
    /// Tubes in series in front of it.
    parts: usize,
    /// Time to shut, and time to stop the flow [s].
    shuts: f64,
    stops: f64,
    /// Length of the tubes in front of it [m].
    l: f64,
    /// Velocity of sound [m/s].
    c: f64,
    /// Pressure rise [Pa].
    rise: f64,
    /// Velocity change [m/s].
    velocity: f64,
    /// Begin of the closing [s], if the velocity is from a run.
    begins: Option<f64>,
    /// True if the model has compressed fluid.
    compressed: bool,
}

impl Hammer {
    fn describe(&self, network: &ResolvedNetwork) -> String {
        let tube = network.tube(self.link) + 1;
        let when = match self.begins {
            Some(t) => format!("when the valve begins to shut at {}", quantity(t, "s", 3)),
            None => "the largest steady velocity".into(),
        };
        let needed = RESOLVES * self.l / (self.c * self.stops);
        let consequence = match (self.compressed, needed <= MOST_PARTS) {
            (false, _) => "The model has no compressible fluid, so pressures at the valve grow without limit as it shuts faster. Give \
                           /fluid/bulk_modulus_pa (water: 2.2e9)"
                .into(),
            (true, true) => format!(
                "The wave is not resolved by {} of tube: pressures at the valve overshoot by up to 50 %. Split the tubes in front of the valve by \
                 junctions into {} parts of equal length",
                counted(self.parts as u64, "part"),
                needed.ceil()
            ),
            (true, false) => format!(
                "The wave is not resolved by {} of tube, nor by {MOST_PARTS}: pressures at the valve overshoot by up to 50 %. Use the rise of this \
                 message. Or stop the flow in {} or more, and split the tubes in front of the valve into {MOST_PARTS} parts",
                counted(self.parts as u64, "part"),
                quantity(RESOLVES * self.l / (self.c * MOST_PARTS), "s", 2)
            ),
        };
        format!(
            "water hammer: the valve of tube {tube} shuts in {} and stops the flow in {} (limit {}, the return time 2 l/c of a pressure wave, l = {}, \
             c = {}). DerivativeParameters Joukowsky, the pressure rises by up to {} (rho c v, v = {}, {when}). {consequence}",
            quantity(self.shuts, "s", 3),
            quantity(self.stops, "s", 3),
            quantity(2.0 * self.l / self.c, "s", 3),
            quantity(self.l, "m", 3),
            quantity(self.c, "m/s", 3),
            quantity(self.rise, "Pa", 3),
            quantity(self.velocity, "m/s", 3),
        )
    }
}

/// Closings of a valve until `end` [s]: begin and end of each, and the largest opening over its steepest rate [s].
fn falls(opening: &Signal, end: f64) -> Vec<([f64; 2], f64)> {
    let most = opening.largest(end).value;
    let mut before: Option<f64> = None;
    // begin and steepest rate of the current fall
    let mut falling: Option<(f64, f64)> = None;
    let mut all: Vec<([f64; 2], f64)> = vec![];
    for (from, to) in opening.smooth_intervals(end) {
        let within = 0.5 * (from + to);
        for k in 0..=LOOKS {
            let t = from + (to - from) * k as f64 / LOOKS as f64;
            let jet = opening.jet(SmoothTime { t, within });
            let jumped = k == 0 && before.is_some_and(|before| jet.value < before - SHUT * most);
            let rate = if jumped { f64::INFINITY } else { -jet.rate };
            falling = (rate > 0.0).then(|| falling.map_or((t, rate), |(begin, steepest)| (begin, steepest.max(rate))));
            if let Some((begin, steepest)) = falling.filter(|_| jet.value <= SHUT * most) {
                let shuts = most / steepest;
                match all.last_mut().filter(|([from, _], _)| *from == begin) {
                    Some((_, fastest)) => *fastest = shuts,
                    None => all.push(([begin, t], shuts)),
                }
            }
            before = Some(jet.value);
        }
    }
    all
}

/// Tubes in series from one side of a valve, up to the first storage other than their own fluid.
fn column<'a>(network: &'a ResolvedNetwork, ends: &[TubeEnd], valve: &'a Link, side: NetworkNode) -> Column<'a> {
    let (mut tubes, mut last, mut here): (Vec<&Link>, &Link, NetworkNode) = (vec![], valve, side);
    while let NetworkNode::Junction(junction) = here {
        if tubes.len() >= network.links.len() || !ends.iter().any(|end| end.junctions.contains(&junction)) {
            break;
        }
        let onward = network.tubes_at(junction).filter(|tube| !std::ptr::eq(*tube, last));
        let Some(next) = onward.max_by(|a, b| length(a).total_cmp(&length(b))) else {
            break;
        };
        tubes.push(next);
        here = if next.from == here { next.to } else { next.from };
        last = next;
    }
    Column { tubes }
}

/// Largest driving pressure difference [Pa], from ports, vessels, bladders at ambient pressure, and pumps.
fn driving(case: &Case, network: &ResolvedNetwork) -> f64 {
    let end = case.time.end_s;
    let ports = network.ports.iter().map(|port| port.pressure.range(0.0, end));
    let given = ports.flat_map(|range| [range.low, range.high]);
    let stored = network.accumulators.iter().map(|one| one.start_pressure);
    let (low, high) = given
        .chain(stored)
        .fold((0.0_f64, 0.0_f64), |(low, high), p| (low.min(p), high.max(p)));
    let pumps = network.links.iter().filter_map(|link| link.pump.as_ref());
    let heads = network.links.iter().map(|link| link.head.abs());
    high - low
        + pumps
            .map(|pump| pump.largest(pump.pressure.largest(end).value))
            .sum::<f64>()
        + heads.sum::<f64>()
}

/// Steady flow through tubes in series under a pressure difference [m^3/s].
fn steady_flow<'a>(tubes: impl Iterator<Item = &'a Link> + Clone, drive: f64) -> f64 {
    let resistance: f64 = tubes.clone().map(|tube| tube.resistance).sum();
    let (mut low, mut high) = (0.0, drive / resistance);
    for _ in 0..60 {
        let flow = 0.5 * (low + high);
        let losses: f64 = tubes
            .clone()
            .filter_map(|tube| tube.tube)
            .map(|tube| tube.law.loss(flow))
            .sum();
        if resistance * flow + losses > drive {
            high = flow;
        } else {
            low = flow;
        }
    }
    low
}
