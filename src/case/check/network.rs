//! The network: every name and index leads somewhere, nothing is joined twice, ends are what they say.

use std::collections::{BTreeMap, HashMap};

use super::bladders::two_permeabilities;
use super::junctions;
use crate::case::faults::Faults;
use crate::case::schema::{BladderEnd, Case, ChainEnd, Endpoint, Network};
use crate::case::wording::nearest;
use crate::error::{Code, Violation};

/// A point of the network.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum Point {
    Bladder(i64, BladderEnd),
    Junction(String),
}

impl std::fmt::Display for Point {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Self::Bladder(index, BladderEnd::Inlet) => write!(f, "the inlet of bladder {index}"),
            Self::Bladder(index, BladderEnd::Outlet) => write!(f, "the outlet of bladder {index}"),
            Self::Junction(name) => write!(f, "junction \"{name}\""),
        }
    }
}

pub(super) fn check(case: &Case, faults: &mut Faults) {
    let (Some(bladders), Some(network)) = (&case.bladders, &case.network) else {
        return;
    };
    let mut rules = Rules {
        network,
        per_row: bladders.per_row,
        attached: BTreeMap::new(),
        lost: false,
        faults,
    };
    rules.junction_names();
    rules.tubes(case);
    rules.ports();
    rules.turbines();
    rules.chains(case);
    if !rules.lost {
        junctions::check(case, network, &rules.attached, rules.faults);
    }
}

/// Whether there is a bladder of that index; a fault if not.
pub(super) fn exists(index: i64, per_row: usize, pointer: &str, faults: &mut Faults) -> bool {
    let exists = index != 0 && index.unsigned_abs() <= per_row as u64;
    if !exists {
        let fault = Violation::new(Code::Wiring, pointer, format!("there is no bladder {index}"));
        let allowed = format!("1 to {per_row} (upper row) and -1 to -{per_row} (lower row)");
        faults.push(fault.allowed(allowed));
    }
    exists
}

struct Rules<'a> {
    network: &'a Network,
    per_row: usize,
    /// What is attached to each point: pointers of tubes, ports and turbines.
    attached: BTreeMap<Point, Vec<String>>,
    /// Some end leads nowhere: what is not attached may have been meant by it.
    lost: bool,
    faults: &'a mut Faults,
}

impl Rules<'_> {
    fn junction_names(&mut self) {
        let mut known = HashMap::new();
        for (i, name) in self.network.junctions.iter().enumerate() {
            if let Some(first) = known.insert(name, i) {
                let what = format!("junction \"{name}\" is declared twice, first at /network/junctions/{first}");
                self.faults
                    .push(Violation::new(Code::Wiring, format!("/network/junctions/{i}"), what));
            }
        }
    }

    /// The point an end of a tube, port or turbine names, and a note of who is attached there.
    fn point(&mut self, endpoint: &Endpoint, pointer: &str, owner: &str) -> Option<Point> {
        let point = self.named(endpoint, pointer);
        match &point {
            Some(point) => self.attached.entry(point.clone()).or_default().push(owner.to_owned()),
            None => self.lost = true,
        }
        point
    }

    fn named(&mut self, endpoint: &Endpoint, pointer: &str) -> Option<Point> {
        let what = match (endpoint.bladder, endpoint.end, &endpoint.junction) {
            (Some(index), Some(end), None) => {
                let pointer = format!("{pointer}/bladder");
                let exists = exists(index, self.per_row, &pointer, self.faults);
                return exists.then_some(Point::Bladder(index, end));
            }
            (None, None, Some(name)) if self.network.junctions.contains(name) => {
                return Some(Point::Junction(name.clone()));
            }
            (None, None, Some(name)) => {
                self.undeclared(name, pointer);
                return None;
            }
            (_, _, Some(_)) => "a bladder end and a junction at once",
            (Some(_), None, None) => "a bladder without saying which end",
            (None, Some(_), None) => "an end without its bladder",
            (None, None, None) => "a point that is neither a bladder end nor a junction",
        };
        let form = "{\"bladder\": 3, \"end\": \"outlet\"} or {\"junction\": \"name\"}";
        self.faults
            .push_at_key(Violation::new(Code::Wiring, pointer, what).allowed(form));
        None
    }

    fn undeclared(&mut self, name: &str, pointer: &str) {
        let names: Vec<&str> = self.network.junctions.iter().map(String::as_str).collect();
        let what = format!("junction \"{name}\" is not declared");
        let fault = Violation::new(Code::Wiring, format!("{pointer}/junction"), what);
        self.faults.push(Violation {
            nearest: nearest(name, names.iter().copied()),
            allowed: (!names.is_empty()).then(|| names.join(", ")),
            ..fault.hint("declare it under /network/junctions")
        });
    }

    /// The points of a tube or turbine, which must differ.
    fn two_points(&mut self, from: &Endpoint, to: &Endpoint, pointer: &str, what: &str) {
        let from = self.point(from, &format!("{pointer}/from"), pointer);
        let to = self.point(to, &format!("{pointer}/to"), pointer);
        if let (Some(from), true) = (&from, from == to) {
            self.faults.push(Violation::new(
                Code::Wiring,
                format!("{pointer}/to"),
                format!("a {what} from {from} to itself"),
            ));
        }
    }

    fn tubes(&mut self, case: &Case) {
        for (i, tube) in self.network.tubes.iter().enumerate() {
            let pointer = format!("/network/tubes/{i}");
            self.two_points(&tube.from, &tube.to, &pointer, "tube");
            if tube.permeability_m4.is_some() && tube.cross_section.is_some() {
                two_permeabilities(&pointer, self.faults);
            }
            let permeable = tube.permeability_m4.is_some() || tube.cross_section.is_some();
            if case.tubes.is_none() && !(permeable && tube.length_m.is_some()) {
                let missing = if permeable { "length" } else { "permeability" };
                let fault = Violation::new(
                    Code::TubeSize,
                    pointer,
                    format!("a tube without {missing}, and no /tubes to take it from"),
                );
                self.faults
                    .push(fault.hint("add \"tubes\" to the case, or \"length_m\" and \"permeability_m4\" to the tube"));
            }
        }
    }

    fn ports(&mut self) {
        let mut known: HashMap<Point, String> = HashMap::new();
        for (i, chain) in self.network.chains.iter().enumerate() {
            for (k, end) in chain.ends.iter().enumerate() {
                if matches!(end, ChainEnd::PressurePa(_) | ChainEnd::FlowM3S(_)) {
                    known.extend(end_point(&chain.bladders, k).map(|p| (p, format!("/network/chains/{i}/ends/{k}"))));
                }
            }
        }
        for (i, port) in self.network.ports.iter().enumerate() {
            let pointer = format!("/network/ports/{i}");
            let what = match (&port.pressure_pa, &port.flow_m3_s) {
                (Some(_), Some(_)) => Some("a port with pressure and flow"),
                (None, None) => Some("a port with neither pressure nor flow"),
                _ => None,
            };
            if let Some(what) = what {
                let fault = Violation::new(Code::Wiring, pointer.clone(), what);
                self.faults
                    .push(fault.allowed("exactly one of pressure_pa and flow_m3_s"));
            }
            let Some(point) = self.point(&port.at, &format!("{pointer}/at"), &pointer) else {
                continue;
            };
            if let Some(first) = known.get(&point) {
                let what = format!("a second port at {point}, the first is {first}");
                self.faults
                    .push(Violation::new(Code::Wiring, format!("{pointer}/at"), what));
            }
            known.entry(point).or_insert(pointer);
        }
    }

    fn turbines(&mut self) {
        for (i, turbine) in self.network.turbines.iter().enumerate() {
            self.two_points(&turbine.from, &turbine.to, &format!("/network/turbines/{i}"), "turbine");
        }
    }

    fn chains(&mut self, case: &Case) {
        let mut used: HashMap<i64, String> = HashMap::new();
        for (i, chain) in self.network.chains.iter().enumerate() {
            for (k, &index) in chain.bladders.iter().enumerate() {
                let pointer = format!("/network/chains/{i}/bladders/{k}");
                if !exists(index, self.per_row, &pointer, self.faults) {
                    continue;
                }
                if let Some(first) = used.get(&index) {
                    let what = format!("bladder {index} is used twice, first at {first}");
                    self.faults.push(
                        Violation::new(Code::Wiring, pointer, what).allowed("every bladder in one chain at most"),
                    );
                } else {
                    used.insert(index, pointer);
                }
            }
            if case.tubes.is_none() && chain.bladders.len() > 1 {
                let fault = Violation::new(
                    Code::TubeSize,
                    format!("/network/chains/{i}"),
                    "a chain without tubes to join its bladders",
                );
                self.faults
                    .push(fault.hint("add \"tubes\" with length and radius to the case"));
            }
            for (k, end) in chain.ends.iter().enumerate() {
                let Some(point) = end_point(&chain.bladders, k) else {
                    continue;
                };
                let pointer = format!("/network/chains/{i}/ends/{k}");
                match (end, self.attached.get(&point)) {
                    (ChainEnd::Sealed, Some(owners)) => {
                        let what = format!("{point} is sealed, but {} is attached there", owners[0]);
                        self.faults.push(
                            Violation::new(Code::Wiring, pointer, what)
                                .hint("write \"connected\" instead of \"sealed\""),
                        );
                    }
                    (ChainEnd::Connected, None) if !self.lost => {
                        let what = format!("nothing is connected to {point}");
                        let hint = "add a tube, port or turbine there, or write \"sealed\"";
                        self.faults.push(Violation::new(Code::Wiring, pointer, what).hint(hint));
                    }
                    _ => {}
                }
            }
        }
    }
}

/// The point at the first (0) or second (1) end of a chain.
pub(super) fn end_point(bladders: &[i64], end: usize) -> Option<Point> {
    match end {
        0 => bladders.first().map(|index| Point::Bladder(*index, BladderEnd::Inlet)),
        _ => bladders.last().map(|index| Point::Bladder(*index, BladderEnd::Outlet)),
    }
}
