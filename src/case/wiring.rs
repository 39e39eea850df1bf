//! Resolved network of a case: every number, end and name is a point, every tube has its dimensions, every port prescribes one quantity.

use super::check;
use super::faults::Violations;
use super::schema::{
    Accumulator, BladderEnd, Case, CheckValve, CrossSection, Elevation, Pilot, Pump, TubeDefaults, Turbine,
};
use crate::error::Result;
use crate::functions::Signal;

/// A point of the network.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum WiringPoint {
    /// An end of a bladder, `0..n`: upper row first.
    Bladder(usize, BladderEnd),
    /// A junction, by its place under `/network/junctions`.
    Junction(usize),
}

/// A tube.
#[derive(Clone, Debug)]
pub struct WiringTube<'a> {
    /// Start and end.
    pub points: [WiringPoint; 2],
    /// Length `l_c` [m].
    pub length_m: f64,
    /// Source of its permeability.
    pub bore: PermeabilitySource<'a>,
    /// Radius of its circle, if given [m].
    pub radius_m: Option<f64>,
    /// Losses at its ends and along it, in dynamic pressures of its mean velocity.
    pub loss_coefficient: f64,
    /// Roughness of its wall [m].
    pub roughness_m: f64,
    /// Opening of its valve.
    pub opening: &'a Signal,
    /// Accumulator that opens the valve, with its volumes.
    pub pilot: Option<(usize, &'a Pilot)>,
    /// Its check valve.
    pub check_valve: Option<&'a CheckValve>,
    /// Its pump.
    pub pump: Option<&'a Pump>,
}

/// Source of the permeability of a tube.
#[derive(Clone, Copy, Debug)]
pub enum PermeabilitySource<'a> {
    /// The permeability itself, `q1c` [m^4].
    Permeability(f64),
    /// A cross-section.
    CrossSection(&'a CrossSection),
    /// The radius of a circle [m].
    Radius(f64),
}

impl PermeabilitySource<'_> {
    /// Bore of a tube without values of its own.
    pub(super) fn usual(tubes: &TubeDefaults) -> Self {
        tubes
            .permeability_m4
            .map_or(Self::Radius(tubes.radius_m), Self::Permeability)
    }
}

/// Quantity that a port prescribes.
#[derive(Clone, Copy, Debug)]
pub enum PortQuantity<'a> {
    /// A pressure [Pa].
    Pressure(&'a Signal),
    /// A flow into the network [m^3/s].
    Flow(&'a Signal),
    /// A volume injected into the network [m^3].
    Volume(&'a Signal),
}

/// A port, or a prescribed condition at the end of a chain.
#[derive(Clone, Debug)]
pub struct WiringPort<'a> {
    /// Point of the port.
    pub at: WiringPoint,
    /// Name, if given.
    pub name: Option<&'a str>,
    /// Prescribed quantity.
    pub given: PortQuantity<'a>,
}

/// A resolved network; empty for a case without one, whose bladders are sealed singly.
#[derive(Clone, Debug, Default)]
pub struct Wiring<'a> {
    /// Labels of the bladders.
    pub labels: BladderLabels,
    /// Names of the junctions.
    pub junctions: &'a [String],
    /// Heights of junctions.
    pub elevations: &'a [Elevation],
    /// Bladders of every chain.
    pub chains: Vec<Vec<usize>>,
    /// Tubes of the chains.
    pub chain_tubes: Vec<WiringTube<'a>>,
    /// Ports at the ends of chains.
    pub chain_ports: Vec<WiringPort<'a>>,
    /// Single tubes.
    pub tubes: Vec<WiringTube<'a>>,
    /// Ports.
    pub ports: Vec<WiringPort<'a>>,
    /// Turbines, each with its two points.
    pub turbines: Vec<([WiringPoint; 2], &'a Turbine)>,
    /// Accumulators, each with its point.
    pub accumulators: Vec<(WiringPoint, &'a Accumulator)>,
}

impl<'a> Wiring<'a> {
    /// Resolves the network of a case.
    ///
    /// # Errors
    /// [`Error::Case`](crate::error::Error::Case) with every invalid reference, in the words of the check of the case.
    pub fn from_case(case: &'a Case) -> Result<Self> {
        let mut faults = Violations::default();
        let wiring = check::network::resolve(case, &mut faults).0;
        match faults.is_empty() {
            true => Ok(wiring),
            false => Err(case.source.error(faults.placed(&case.source))),
        }
    }

    /// Height of a point above the bladders [m].
    pub fn elevation(&self, point: WiringPoint) -> f64 {
        let WiringPoint::Junction(j) = point else { return 0.0 };
        let own = self.elevations.iter().find(|one| one.junction == self.junctions[j]);
        own.map_or(0.0, |one| one.elevation_m)
    }

    /// Name of a point: `inlet of bladder -3`, or that of the junction.
    pub fn label(&self, point: WiringPoint) -> String {
        match point {
            WiringPoint::Bladder(bladder, end) => format!("{end} of bladder {}", self.labels.label(bladder)),
            WiringPoint::Junction(j) => self.junctions[j].clone(),
        }
    }
}

/// Index of a bladder `R j` in `0..n`, upper row first; none if there is no such bladder.
pub fn bladder_index(signed: i64, per_row: usize) -> Option<usize> {
    let j = usize::try_from(signed.unsigned_abs())
        .ok()
        .filter(|j| (1..=per_row).contains(j))?
        - 1;
    Some(if signed > 0 { j } else { per_row + j })
}

/// Number `R j` of a bladder index.
pub fn bladder_label(index: usize, per_row: usize) -> i64 {
    if index < per_row {
        index as i64 + 1
    } else {
        -((index - per_row) as i64 + 1)
    }
}

/// Labels of bladders in texts: `3` and `-3`, in a structure `left:3` and `left:-3`, counted along each beam.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BladderLabels {
    /// Bladders in a row.
    pub per_row: usize,
    /// Name of each beam of a structure, and the number behind its last segment among those of all beams.
    beams: Vec<(String, usize)>,
}

impl BladderLabels {
    /// Labels of a case.
    pub fn from_case(case: &Case) -> Self {
        let beams = case.beams.iter();
        let per_row = case.bladders.as_ref().map_or(0, |bladders| bladders.per_row);
        Self::new(
            per_row,
            beams.map(|beam| (beam.name.clone(), beam.segments.unwrap_or(1))),
        )
    }

    /// Labels for a number of bladders in a row, and for the names and numbers of segments of the beams of a structure.
    pub fn new(per_row: usize, beams: impl Iterator<Item = (String, usize)>) -> Self {
        let mut behind = 0;
        let beams = beams.map(|(name, segments)| {
            behind += segments;
            (name, behind)
        });
        let beams = beams.collect();
        Self { per_row, beams }
    }

    /// Names of the beams of a structure.
    pub fn beams(&self) -> impl ExactSizeIterator<Item = &str> {
        self.beams.iter().map(|(name, _)| name.as_str())
    }

    /// Beam of a segment in a structure, from 0, and the number of the segment there, from 0.
    pub fn in_beam(&self, segment: usize) -> Option<(usize, usize)> {
        let beam = self.beams.iter().position(|(_, behind)| segment < *behind)?;
        let first = if beam > 0 { self.beams[beam - 1].1 } else { 0 };
        Some((beam, segment - first))
    }

    /// Label of a bladder index `0..n`, upper row first.
    pub fn label(&self, index: usize) -> String {
        self.of_number(bladder_label(index, self.per_row))
    }

    /// Label of a bladder `R j`; of one that does not exist, its number.
    pub fn of_number(&self, number: i64) -> String {
        let segment = (number.unsigned_abs() as usize).checked_sub(1);
        match segment.and_then(|segment| self.in_beam(segment)) {
            Some((beam, own)) => format!("{}:{}", self.beams[beam].0, number.signum() * (own as i64 + 1)),
            None => number.to_string(),
        }
    }
}
