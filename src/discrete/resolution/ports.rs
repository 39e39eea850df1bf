//! Pressures and flows of ports that change faster than they get through a cell of the bladder behind them.

use std::f64::consts::TAU;

use crate::case::schema::Case;
use crate::case::signals::Signal;
use crate::model::Wet;

/// Part of the depth that a wave gets into a bladder which half a cell of that depth leaves out; measured with 1 to 32 cells.
const LEFT_OUT: f64 = 1.0 / 3.0;
/// What comes back to less than this part of its largest value is a pulse.
const BACK: f64 = 0.5;

/// What goes to and fro at a port.
pub struct Pulse {
    name: String,
    /// Length of a bladder over the depth that it gets into one.
    depths: f64,
}

impl Pulse {
    /// Where it stands in the case.
    pub fn pointer(&self) -> String {
        format!("the port \"{}\"", self.name)
    }

    /// Share of the pressure behind the port that so many cells along a bladder leave out.
    pub fn left_out(&self, cells: usize) -> f64 {
        (LEFT_OUT * self.depths / cells as f64).min(1.0)
    }
}

/// Of every port whose pressure or flow goes to and fro, its depth in a bladder:
///
/// ```text
/// a_p dp/dt = (q1b/μ) d²p/ds²     δ = (q1b/(μ a_p ω))^(1/2),   ω of its highest tone or its shortest time
/// ```
pub fn pulses(case: &Case, wet: &Wet) -> Vec<Pulse> {
    let end = case.time.end_s;
    let network = &wet.network;
    let pressures = network.ports.iter().map(|port| (&port.name, &port.pressure));
    let flows = network.sources.iter().map(|source| (&source.name, &source.flow));
    let of = |(name, signal): (&String, &Signal)| {
        let omega = fastest(signal, end)?;
        let depth = (network.bladder_mobility / (wet.area.per_pressure * omega)).sqrt();
        Some(Pulse {
            name: name.clone(),
            depths: wet.bladder_length / depth,
        })
    };
    pressures.chain(flows).filter_map(of).collect()
}

/// Angular frequency of what goes to and fro [1/s], of a pulse one over its time; none of what comes and stays.
fn fastest(signal: &Signal, end: f64) -> Option<f64> {
    let tone = signal.highest_tone_hz().map(|f| TAU * f);
    let back = signal.value(end).abs() < BACK * signal.largest(end).value;
    let pulse = signal.shortest_time_s(end).filter(|_| back).map(f64::recip);
    tone.into_iter().chain(pulse).reduce(f64::max)
}
