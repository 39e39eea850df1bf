//! Checks of the network: every name and index exists, no point is used twice, and ends agree with their connections.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::bladders::{PER_ROW, existing, two_permeabilities};
use super::tubes::{loss_coefficient, radius, roughness, size};
use super::{junctions, tubes, vessels};
use crate::case::faults::Violations;
use crate::case::numbers::plain;
use crate::case::schema::{self, BladderEnd, Case, ChainEnd, CheckValve, Endpoint, Network, Rectifier, TubeDefaults};
use crate::case::wiring::{
    BladderLabels, PermeabilitySource, PortQuantity, Wiring, WiringPoint, WiringPort, WiringTube, bladder_index,
};
use crate::error::{Code, Violation};
use crate::functions::signals::Signal;

static SHUT: Signal = Signal::Constant(0.0);

pub(super) fn check(case: &Case, faults: &mut Violations) {
    // without a valid number of bladders, indices cannot be checked
    if !faults.are_sound(&[PER_ROW]) {
        return;
    }
    let (_, joined) = resolve(case, faults);
    if !joined.lost {
        junctions::check(case, &joined, faults);
    }
}

/// Connections of the network, by point.
#[derive(Default)]
pub struct ConnectionTable<'a> {
    /// Pointers of everything attached to each point.
    pub attached: BTreeMap<WiringPoint, Vec<String>>,
    /// Single tubes with their opening signals, and turbines.
    pub branches: Vec<([WiringPoint; 2], Option<&'a Signal>)>,
    /// Points of ports with a pressure.
    pub held: BTreeSet<WiringPoint>,
    /// Points of accumulators.
    pub stores: BTreeSet<WiringPoint>,
    /// True if an endpoint is invalid; unattached ends and junctions are then not reported.
    lost: bool,
}

/// Resolves the network without its faulty parts, and reports the faults.
pub fn resolve<'a>(case: &'a Case, faults: &mut Violations) -> (Wiring<'a>, ConnectionTable<'a>) {
    let Some(network) = &case.network else {
        return Default::default();
    };
    let labels = BladderLabels::from_case(case);
    let mut rules = Rules {
        case,
        network,
        usual: case.tubes.as_ref(),
        labels: labels.clone(),
        joined: ConnectionTable::default(),
        faults,
    };
    rules.junction_names();
    junctions::elevations(network, rules.faults);
    let mut wiring = Wiring {
        labels,
        junctions: &network.junctions,
        elevations: &network.elevations,
        tubes: rules.tubes(),
        ports: rules.ports(),
        turbines: rules.turbines(),
        accumulators: rules.accumulators(),
        ..Wiring::default()
    };
    rules.chains(&mut wiring);
    (wiring, rules.joined)
}

/// Number of the bladder at the first (0) or second (1) end of a chain, and which of its ends.
fn chain_end(chain: &schema::Chain, k: usize) -> Option<(i64, BladderEnd)> {
    match k {
        0 => Some((*chain.bladders.first()?, BladderEnd::Inlet)),
        _ => Some((*chain.bladders.last()?, BladderEnd::Outlet)),
    }
}

struct Rules<'a, 'f> {
    case: &'a Case,
    network: &'a Network,
    usual: Option<&'a TubeDefaults>,
    labels: BladderLabels,
    joined: ConnectionTable<'a>,
    faults: &'f mut Violations,
}

impl<'a> Rules<'a, '_> {
    fn fault(&mut self, pointer: impl Into<String>, what: impl Into<String>) {
        self.faults.push(Violation::new(Code::Wiring, pointer, what));
    }

    fn describe(&self, point: WiringPoint) -> String {
        match point {
            WiringPoint::Bladder(index, end) => format!("the {end} of bladder {}", self.labels.label(index)),
            WiringPoint::Junction(j) => format!("junction \"{}\"", self.network.junctions[j]),
        }
    }

    fn end_of(&self, number: i64, end: BladderEnd) -> Option<WiringPoint> {
        bladder_index(number, self.labels.per_row).map(|index| WiringPoint::Bladder(index, end))
    }

    fn junction_names(&mut self) {
        let mut known = HashMap::new();
        for (i, name) in self.network.junctions.iter().enumerate() {
            if let Some(first) = known.insert(name, i) {
                let what = format!("junction \"{name}\" is declared twice, first at /network/junctions/{first}");
                self.fault(format!("/network/junctions/{i}"), what);
            }
        }
    }

    /// Resolves the point that an endpoint names, and records its owner as attached there.
    fn point(&mut self, endpoint: &Endpoint, pointer: &str, owner: &str) -> Option<WiringPoint> {
        let point = self.named(endpoint, pointer);
        match point {
            Some(point) => self.joined.attached.entry(point).or_default().push(owner.to_owned()),
            None => self.joined.lost = true,
        }
        point
    }

    fn named(&mut self, endpoint: &Endpoint, pointer: &str) -> Option<WiringPoint> {
        let what = match (endpoint.bladder, endpoint.end, &endpoint.junction) {
            (Some(number), Some(end), None) => {
                let index = existing(number, self.case, &format!("{pointer}/bladder"), self.faults);
                return index.map(|index| WiringPoint::Bladder(index, end));
            }
            (None, None, Some(name)) => {
                let place = self.network.junctions.iter().position(|known| known == name);
                if place.is_none() {
                    junctions::undeclared(&self.network.junctions, name, pointer, self.faults);
                }
                return place.map(WiringPoint::Junction);
            }
            (_, _, Some(_)) => "a bladder end and a junction at once",
            (Some(_), None, None) => "a bladder without its end",
            (None, Some(_), None) => "an end without its bladder",
            (None, None, None) => "a point that is neither a bladder end nor a junction",
        };
        let form = "{\"bladder\": 3, \"end\": \"outlet\"} or {\"junction\": \"name\"}";
        self.faults
            .push_at_key(Violation::new(Code::Wiring, pointer, what).allowed(form));
        None
    }

    /// Resolves the two points of a tube or turbine, which must differ.
    fn branch(
        &mut self,
        [from, to]: [&Endpoint; 2],
        opening: Option<&'a Signal>,
        pointer: &str,
        what: &str,
    ) -> Option<[WiringPoint; 2]> {
        let from = self.point(from, &format!("{pointer}/from"), pointer);
        let to = self.point(to, &format!("{pointer}/to"), pointer);
        let points = [from?, to?];
        if points[0] == points[1] {
            let what = format!("a {what} from {} to itself", self.describe(points[0]));
            self.fault(format!("{pointer}/to"), what);
        }
        self.joined.branches.push((points, opening));
        Some(points)
    }

    fn tubes(&mut self) -> Vec<WiringTube<'a>> {
        let mut found = vec![];
        for (i, tube) in self.network.tubes.iter().enumerate() {
            let pointer = format!("/network/tubes/{i}");
            // a junction behind a valve that a vessel may close has no pressure then
            let opening = tube.pilot.as_ref().map_or(&tube.opening, |_| &SHUT);
            let points = self.branch([&tube.from, &tube.to], Some(opening), &pointer, "tube");
            let pilot = tubes::pilot(self.case, tube, &pointer, self.faults);
            if let Some(valve) = &tube.check_valve {
                self.valve(valve, &format!("{pointer}/check_valve"));
            }
            if let Some(pump) = &tube.pump {
                tubes::pump(self.case, pump, &format!("{pointer}/pump"), self.faults);
            }
            if tube.permeability_m4.is_some() && tube.cross_section.is_some() {
                two_permeabilities(&pointer, self.faults);
            }
            let Some((length_m, bore)) = size(tube, self.usual) else {
                let permeable = tube.permeability_m4.is_some() || tube.cross_section.is_some();
                let missing = if permeable { "length" } else { "permeability" };
                let what = format!("a tube without {missing}, and no default in /tubes");
                let hint = "add \"tubes\" to the case, or \"length_m\" and \"permeability_m4\" to the tube";
                self.faults.push(Violation::new(Code::Wiring, pointer, what).hint(hint));
                continue;
            };
            found.extend(points.map(|points| WiringTube {
                points,
                length_m,
                bore,
                radius_m: radius(tube, self.usual),
                loss_coefficient: loss_coefficient(tube.loss_coefficient, self.usual),
                roughness_m: roughness(tube.roughness_m, self.usual),
                opening: &tube.opening,
                pilot,
                check_valve: tube.check_valve.as_ref(),
                pump: tube.pump.as_ref(),
            }));
        }
        found
    }

    fn ports(&mut self) -> Vec<WiringPort<'a>> {
        let mut known: HashMap<WiringPoint, String> = HashMap::new();
        for (i, chain) in self.network.chains.iter().enumerate() {
            for (k, end) in chain.ends.iter().enumerate() {
                let point = chain_end(chain, k).and_then(|(number, end)| self.end_of(number, end));
                let gives = !matches!(end, ChainEnd::Sealed | ChainEnd::Connected);
                known.extend(
                    point
                        .filter(|_| gives)
                        .map(|point| (point, format!("/network/chains/{i}/ends/{k}"))),
                );
            }
        }
        let mut found = vec![];
        for (i, port) in self.network.ports.iter().enumerate() {
            let pointer = format!("/network/ports/{i}");
            let pressure = port.pressure_pa.as_ref().map(PortQuantity::Pressure);
            let flow = port.flow_m3_s.as_ref().map(PortQuantity::Flow);
            let volume = port.volume_m3.as_ref().map(PortQuantity::Volume);
            let given: Vec<PortQuantity> = [pressure, flow, volume].into_iter().flatten().collect();
            if given.len() != 1 {
                let what = match given.len() {
                    0 => "a port with neither pressure, flow nor volume",
                    _ => "a port with more than one of pressure, flow and volume",
                };
                let fault = Violation::new(Code::Wiring, pointer.clone(), what);
                self.faults
                    .push(fault.allowed("exactly one of pressure_pa, flow_m3_s and volume_m3"));
            }
            let Some(at) = self.point(&port.at, &format!("{pointer}/at"), &pointer) else {
                continue;
            };
            if let Some(first) = known.get(&at) {
                let what = format!("a second port at {}, the first is {first}", self.describe(at));
                self.fault(format!("{pointer}/at"), what);
            }
            known.entry(at).or_insert(pointer);
            if port.pressure_pa.is_some() {
                self.joined.held.insert(at);
            }
            let name = port.name.as_deref();
            found.extend(given.into_iter().take(1).map(|given| WiringPort { at, name, given }));
        }
        found
    }

    fn accumulators(&mut self) -> Vec<(WiringPoint, &'a schema::Accumulator)> {
        let mut found: Vec<(WiringPoint, &schema::Accumulator)> = vec![];
        for (i, accumulator) in self.network.accumulators.iter().enumerate() {
            let pointer = format!("/network/accumulators/{i}");
            let Some(at) = self.point(&accumulator.at, &format!("{pointer}/at"), &pointer) else {
                continue;
            };
            if let Some(first) = found.iter().position(|(other, _)| *other == at) {
                let what = format!(
                    "a second accumulator at {}, the first is /network/accumulators/{first}",
                    self.describe(at)
                );
                self.fault(format!("{pointer}/at"), what);
            }
            if self.joined.held.contains(&at) {
                let what = format!(
                    "an accumulator at {}, where a port gives the pressure",
                    self.describe(at)
                );
                self.fault(format!("{pointer}/at"), what);
            }
            vessels::curve(accumulator, &pointer, self.faults);
            self.joined.stores.insert(at);
            found.push((at, accumulator));
        }
        found
    }

    fn turbines(&mut self) -> Vec<([WiringPoint; 2], &'a schema::Turbine)> {
        let mut found = vec![];
        for (i, turbine) in self.network.turbines.iter().enumerate() {
            let pointer = format!("/network/turbines/{i}");
            let points = self.branch([&turbine.from, &turbine.to], None, &pointer, "turbine");
            if let Rectifier::CheckValves(valve) = &turbine.rectifier {
                self.valve(valve, &format!("{pointer}/rectifier/check_valves"));
            }
            found.extend(points.map(|points| (points, turbine)));
        }
        found
    }

    /// Checks that the reverse conductance of a valve does not exceed its forward conductance.
    fn valve(&mut self, valve: &CheckValve, pointer: &str) {
        if valve.reverse_conductance_m3_s_pa > valve.forward_conductance_m3_s_pa {
            let what = "a check valve with a larger reverse than forward conductance";
            let fault = Violation::new(Code::Wiring, format!("{pointer}/reverse_conductance_m3_s_pa"), what);
            let allowed = format!(
                "up to its forward conductance, {}",
                plain(valve.forward_conductance_m3_s_pa)
            );
            let hint = "are the two conductances exchanged? The valve of a tube opens from \"from\" to \"to\"";
            let forward = format!("{pointer}/forward_conductance_m3_s_pa");
            self.faults.push_beside(&[&forward], fault.allowed(allowed).hint(hint));
        }
    }

    fn chains(&mut self, wiring: &mut Wiring<'a>) {
        let mut used: HashMap<usize, String> = HashMap::new();
        for (i, chain) in self.network.chains.iter().enumerate() {
            let mut row = vec![];
            for (k, &number) in chain.bladders.iter().enumerate() {
                let pointer = format!("/network/chains/{i}/bladders/{k}");
                let Some(index) = existing(number, self.case, &pointer, self.faults) else {
                    continue;
                };
                row.push(index);
                if let Some(first) = used.get(&index) {
                    let label = self.labels.of_number(number);
                    let what = format!("bladder {label} is used twice, first at {first}");
                    let fault = Violation::new(Code::Wiring, pointer, what);
                    self.faults.push(fault.allowed("each bladder in at most one chain"));
                } else {
                    used.insert(index, pointer);
                }
            }
            match self.usual {
                Some(usual) => wiring.chain_tubes.extend(row.windows(2).map(|pair| WiringTube {
                    points: [
                        WiringPoint::Bladder(pair[0], BladderEnd::Outlet),
                        WiringPoint::Bladder(pair[1], BladderEnd::Inlet),
                    ],
                    length_m: usual.length_m,
                    bore: PermeabilitySource::usual(usual),
                    radius_m: Some(usual.radius_m),
                    loss_coefficient: loss_coefficient(None, self.usual),
                    roughness_m: roughness(None, self.usual),
                    opening: &chain.opening,
                    pilot: None,
                    check_valve: None,
                    pump: None,
                })),
                None if chain.bladders.len() > 1 => {
                    let what = "a chain without tubes to join its bladders";
                    let fault = Violation::new(Code::Wiring, format!("/network/chains/{i}"), what);
                    self.faults
                        .push(fault.hint("add \"tubes\" with length and radius to the case"));
                }
                None => {}
            }
            wiring.chains.push(row);
            for k in 0..chain.ends.len() {
                wiring.chain_ports.extend(self.end(i, chain, k));
            }
        }
    }

    /// Returns the port that one end of a chain prescribes, if any. Reports an end that contradicts its connections.
    fn end(&mut self, i: usize, chain: &'a schema::Chain, k: usize) -> Option<WiringPort<'a>> {
        let (number, end) = chain_end(chain, k)?;
        let at = self.end_of(number, end);
        let owners = at.and_then(|at| self.joined.attached.get(&at));
        let fault = |what| Violation::new(Code::Wiring, format!("/network/chains/{i}/ends/{k}"), what);
        let label = self.labels.of_number(number);
        let given = match (&chain.ends[k], owners) {
            (ChainEnd::Sealed, Some(owners)) => {
                let what = format!(
                    "the {end} of bladder {label} is sealed, but {} is attached there",
                    owners[0]
                );
                self.faults
                    .push(fault(what).hint("write \"connected\" instead of \"sealed\""));
                return None;
            }
            (ChainEnd::Connected, None) if !self.joined.lost => {
                let what = format!("nothing is connected to the {end} of bladder {label}");
                let hint = "add a tube, port or turbine there, or write \"sealed\"";
                self.faults.push(fault(what).hint(hint));
                return None;
            }
            (ChainEnd::Sealed | ChainEnd::Connected, _) => return None,
            (ChainEnd::PressurePa(pressure), _) => PortQuantity::Pressure(pressure),
            (ChainEnd::FlowM3S(flow), _) => PortQuantity::Flow(flow),
            (ChainEnd::VolumeM3(volume), _) => PortQuantity::Volume(volume),
        };
        Some(WiringPort {
            at: at?,
            name: None,
            given,
        })
    }
}
