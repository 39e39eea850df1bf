//! What may make the beam bend more than its loads tell: buckling, flutter, parametric excitation, resonance.

use std::f64::consts::PI;

use super::Scene;
use crate::case::{Clock, Signal, Translation};
use crate::model::characteristic::{MATHIEU_COUPLING, mathieu_growth};
use crate::model::loads::LoadKind;

/// Force beyond which, as a part of the buckling load, nothing that bends is left out.
const SAFE_COMPRESSION: f64 = 0.3;

/// Least and largest value of a signal over the run.
fn extremes(signal: &Signal, end: f64) -> (f64, f64) {
    let mut found = (f64::INFINITY, f64::NEG_INFINITY);
    for (from, to) in signal.smooth_intervals(end) {
        for k in 0..=200 {
            let t = from + (to - from) * f64::from(k) / 200.0;
            let value = signal
                .jet(Clock {
                    t,
                    within: 0.5 * (from + to),
                })
                .value;
            found = (found.0.min(value), found.1.max(value));
        }
    }
    found
}

impl Scene<'_> {
    /// Largest compression over the buckling load: from loads and end forces by their signs, from shaking, from waves of a start at
    /// once, from what both ends hold, and from how a bent beam draws its end in and swings.
    pub fn compression(&self) -> f64 {
        let (l, section, d) = (self.case.beam.length_m, self.section, &self.drive);
        let [root, tip] = [0, 1].map(|k| matches!(self.ends[k].axial, Translation::Displacement(_)));
        let pressed = |along: f64, against: f64| match (root, tip) {
            (true, false) => against,
            (false, true) => along,
            _ => along.max(against),
        };
        let end = self.case.time.end_s;
        let mut force = 0.0;
        for load in self.loads.iter().filter(|load| load.kind == LoadKind::ForceZ) {
            let (least, most) = extremes(&load.signal, end);
            let part = |sign: f64| {
                let sum: f64 = (0..64)
                    .map(|k| (sign * load.factor * load.profile.value((f64::from(k) + 0.5) / 64.0)).max(0.0))
                    .sum();
                sum * l / 64.0
            };
            let (positive, negative) = (most.max(0.0), (-least).max(0.0));
            let along = positive * part(1.0) + negative * part(-1.0);
            let against = positive * part(-1.0) + negative * part(1.0);
            force += pressed(along, against);
        }
        for end_of_beam in &self.ends {
            if let Translation::Force(signal) = &end_of_beam.axial {
                let (least, most) = extremes(signal, end);
                force += pressed(most.max(0.0), (-least).max(0.0));
            }
        }
        let (ea, m) = (section.axial_stiffness, section.mass_per_length);
        force += m * l * d.axial_acceleration + d.axial_jump * (ea * m).sqrt() + d.axial_pull * ea / l;
        if root && tip {
            force += self.scales.force;
        }
        if self.begins_displaced() {
            force += self.scales.force;
        }
        let swing = self.scales.transverse * self.bending * self.bending_inertia().min(1.0);
        (force + 0.5 * m * swing * swing) / self.buckling
    }

    /// What speaks against leaving out how the beam bends, if anything does: buckling, follower loads, parametric excitation,
    /// resonance, a coupling that gives energy.
    pub fn unstable(&self) -> Option<String> {
        self.instability.get_or_init(|| self.instability()).clone()
    }

    fn instability(&self) -> Option<String> {
        let compression = self.compression();
        if compression > SAFE_COMPRESSION {
            return Some(format!(
                "normal forces may reach {compression:.1e} of the buckling load"
            ));
        }
        if self.ends.iter().any(|e| e.follower.is_some()) {
            return Some("follower loads may make it flutter".into());
        }
        let shaken = self.ends.iter().find_map(|e| match &e.axial {
            Translation::Displacement(signal) if !signal.is_constant() => Some(signal),
            _ => None,
        });
        if let Some(signal) = shaken
            && let Some(why) = self.tongue(signal)
        {
            return Some(why);
        }
        let excess = self.wet.map_or(0.0, |wet| {
            let sum = wet.coupling.curvature(&wet.area, 0.0, 1.0, 0.0) * self.section.bending_stiffness;
            2.0 * sum * wet.area.moment_mean / wet.area.per_pressure
        });
        (excess > 0.5).then(|| format!("pressure feeds {excess:.1e} of a bending moment back"))
    }

    /// Whether shaking along the beam may make it bend: Mathieu's equation, with margin in size, frequency and stiffness.
    fn tongue(&self, signal: &Signal) -> Option<String> {
        let Signal::Sine(sine) = signal else {
            return Some("it is shaken along, by more than a sine".into());
        };
        let omega = 2.0 * PI * sine.frequency_hz;
        let pull = MATHIEU_COUPLING * sine.amplitude.abs() * omega * omega / self.case.beam.length_m;
        let stiffer = 1.0 + self.stiffening();
        for amplitude in [1.0, 1.5] {
            for part in [0.8, 0.9, 1.0, 1.1, 1.25] {
                for stiffness in [1.0, stiffer] {
                    let growth = mathieu_growth(stiffness * self.bending.powi(2), amplitude * pull, part * omega);
                    if growth > 0.0 {
                        return Some(format!(
                            "shaking along grows bending at {growth:.1} 1/s, {amplitude} times as strong and {part} times as fast"
                        ));
                    }
                }
            }
        }
        None
    }

    /// `2 EI φ_b l_b am²/a_p`, how much sealed bladders stiffen the beam.
    fn stiffening(&self) -> f64 {
        self.wet.map_or(0.0, |wet| {
            let area = &wet.area;
            let density = wet.per_row as f64 / self.case.beam.length_m * wet.bladder_length;
            2.0 * self.section.bending_stiffness * density * area.moment_mean.powi(2) / area.per_pressure
        })
    }

    /// Whether a drive comes near the first bending frequency, which then swings up to more than the loads alone tell.
    pub fn resonant(&self) -> bool {
        let mut near = false;
        self.signals(|signal| {
            if let Some(period) = signal.fastest_period_s() {
                near |= 2.0 * PI / period > 0.4 * self.bending;
            }
        });
        near
    }
}
