//! States that the equations permit but no data or physics supports: a beam that crosses itself or is bent beyond its table, a liquid
//! below its vapor pressure.

use serde::{Deserialize, Serialize};

use crate::case::schema::Case;
use crate::case::wiring::BladderLabels;
use crate::discrete::System;
use crate::discrete::extrema::{MonitoredQuantity, MonitoredValues};
use crate::error::Code;
use crate::error::numbers::quantity;

/// Largest elastic curvature over the end of its table, with a margin for rounding errors.
const BENT: f64 = 1.0 + 1e-6;

/// Part of the length within which a place is that of an end.
const AT_AN_END: f64 = 1e-3;

/// Limits of physical states, known before the run of a case.
#[derive(Clone, Debug, Default)]
pub struct Unphysical {
    /// Length of the beam [m].
    length: f64,
    /// Gauge pressure below which the liquid boils [Pa]; `None` for a gas.
    boils_below: Option<f64>,
    /// True if this is the vapor pressure; otherwise it is vacuum.
    known: bool,
    /// Labels of the bladders.
    labels: BladderLabels,
    /// Names of the junctions, followed by those of the ports that prescribe flow or volume.
    places: Vec<String>,
}

/// Unphysical states of a run: the instant or load factor of the first, and the lowest pressure.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct UnphysicalRecord {
    /// First crossing: both positions along the undeformed beam [m], and its instant or load factor.
    crossing: Option<([f64; 2], f64)>,
    /// Instant or load factor at which the liquid first fell below its limit.
    boiled: Option<f64>,
    /// Lowest pressure of the liquid [Pa], and its instant or load factor.
    lowest: [f64; 2],
    /// True if the lowest pressure is in a bladder, and the index of the bladder, junction or port.
    place: (bool, usize),
    /// Largest elastic curvature beyond the table of a moment-curvature law, over the end of the table; its node, its instant or load
    /// factor, and that of the first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    bent: Option<(f64, usize, [f64; 2])>,
}

impl Unphysical {
    /// Limits of a case.
    pub fn new(case: &Case, system: &System) -> Self {
        let length = system.model.length;
        let (Some(fluid), Some(wet)) = (&case.fluid, &system.model.wet) else {
            return Self {
                length,
                ..Self::default()
            };
        };
        let junctions = wet.network.junctions.iter().map(|one| format!("junction \"{one}\""));
        let sources = wet.network.sources.iter().map(|one| format!("port \"{}\"", one.name));
        Self {
            length,
            boils_below: fluid.boils_below(),
            known: fluid.vapor_pressure().is_some(),
            labels: wet.labels.clone(),
            places: junctions.chain(sources).collect(),
        }
    }

    fn place(&self, (in_bladder, place): (bool, usize)) -> String {
        if in_bladder && self.labels.per_row > 0 {
            return format!("bladder {}", self.labels.label(place));
        }
        self.places.get(place).cloned().unwrap_or_else(|| "the network".into())
    }

    /// A place along the beam [m] in words.
    fn place_along(&self, place: f64) -> String {
        match place / self.length {
            part if part < AT_AN_END => "the root".into(),
            part if part > 1.0 - AT_AN_END => "the tip".into(),
            _ => format!("{} from the root", quantity(place, "m", 4)),
        }
    }

    /// Warnings of unphysical states; `at` formats an instant or load factor, `remedy` avoids a crossing.
    pub fn warnings(&self, met: &UnphysicalRecord, at: &dyn Fn(f64) -> String, remedy: &str) -> Vec<String> {
        let crossing = met.crossing.map(|(places, when)| {
            let [first, second] = places.map(|place| self.place_along(place));
            Code::BeyondRange.warning(format!(
                "the beam crosses itself: {first} and {second} meet from {} on. The case has no contact of the beam \
                 with itself (/beam_contacts): later states are not valid. {remedy}.",
                at(when)
            ))
        });
        let boiled = met.boiled.zip(self.boils_below).map(|(first, limit)| {
            let of = if self.known { "vapor pressure" } else { "vacuum" };
            let [lowest, when] = met.lowest;
            Code::Boiling.warning(format!(
                "The liquid is below its vapor pressure: {} gauge in {} at {} (limit {}, {of}; first below it at {}). A real liquid boils there, so that later states \
                 are not physical. Check sign and unit, or reduce the suction.",
                quantity(lowest, "Pa", 4),
                self.place(met.place),
                at(when),
                quantity(limit, "Pa", 4),
                at(first)
            ))
        });
        let bent = met.bent.map(|(most, node, [when, first])| {
            Code::BeyondRange.warning(format!(
                "The beam is bent beyond its moment-curvature table: {most:.3} of the last curvature at {}, node {node} (beyond it from {} on). \
                 The moment continues straight there, without data. Extend the table, or reduce the load.",
                at(when),
                at(first)
            ))
        });
        crossing.into_iter().chain(bent).chain(boiled).collect()
    }
}

impl UnphysicalRecord {
    /// Adds a state at an instant or load factor.
    pub fn take(&mut self, of: &Unphysical, glance: &MonitoredValues, when: f64) {
        if self.crossing.is_none() {
            self.crossing = glance.crossing.map(|places| (places, when));
        }
        let (bent, node) = glance.bent;
        if bent > self.bent.map_or(BENT, |most| most.0) {
            let first = self.bent.map_or(when, |(.., [_, first])| first);
            self.bent = Some((bent, node, [when, first]));
        }
        let Some(limit) = of.boils_below else { return };
        let in_cells = glance.value_and_rate(MonitoredQuantity::Low)[0];
        let (lowest, place) = match in_cells <= glance.thinnest {
            true => (in_cells, (true, glance.lowest)),
            false => (glance.thinnest, (false, glance.thinnest_at)),
        };
        if lowest < limit {
            self.boiled.get_or_insert(when);
            if lowest < self.lowest[0] {
                (self.lowest, self.place) = ([lowest, when], place);
            }
        }
    }
}
