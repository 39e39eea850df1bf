//! Instabilities that may bend the beam more than its loads: buckling, flutter, parametric excitation, resonance.

use std::f64::consts::PI;

use super::EffectScene;
use super::pace::SignalExcitation;
use crate::case::Translation;
use crate::case::schema::Load;
use crate::error::numbers::significant;
use crate::functions::Signal;
use crate::model::AttachedBody;
use crate::model::characteristic::{MATHIEU_COUPLING, mathieu_growth};
use crate::model::loads::LoadKind;

/// Force over the buckling load above which all bending effects are kept.
pub const SAFE_COMPRESSION: f64 = 0.3;

/// Largest ratio of neighboring stiffnesses (from drained to sealed, without and with shear) in the search for growth.
/// The frequency margins of the search exceed the frequency step of this ratio.
const FINER: f64 = 1.2;

impl EffectScene<'_> {
    /// Largest compression over the buckling load. It includes loads and end forces with their signs, base motion,
    /// waves from a sudden start, the reaction between two held ends, and the swing of the bent beam.
    pub fn compression(&self) -> f64 {
        let (m, transverse) = (self.section.mass_per_length, self.scales.transverse);
        let swing = transverse * self.bending * self.bending_inertia().min(1.0);
        self.pressed() + 0.5 * m * swing * swing / self.buckling
    }

    /// [`Self::compression`] without the swing of the bent beam. Sudden loads count up to twice.
    pub fn pressed(&self) -> f64 {
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
            let values = load.signal.range(0.0, end);
            let [up, down] = load.profile.amounts().map(|part| part * load.factor.abs() * l);
            let part = |sign: f64| if sign * load.factor > 0.0 { up } else { down };
            let (positive, negative) = (values.high.max(0.0), (-values.low).max(0.0));
            let along = positive * part(1.0) + negative * part(-1.0);
            let against = positive * part(-1.0) + negative * part(1.0);
            force += pressed(along, against);
        }
        for end_of_beam in &self.ends {
            if let Translation::Force(signal) = &end_of_beam.axial {
                let values = signal.range(0.0, end);
                force += pressed(values.high.max(0.0), (-values.low).max(0.0));
            }
        }
        let (ea, m) = (section.axial_stiffness, section.mass_per_length);
        if force > 0.0 {
            force *= 1.0 + self.inertia_ratio_of(self.others.iter(), self.axial).min(1.0);
        }
        force += m * l * d.axial_acceleration + d.axial_jump * (ea * m).sqrt() + d.axial_pull * ea / l;
        if root && tip {
            force += self.scales.force;
        }
        if self.begins_displaced() {
            force += self.scales.force;
        }
        force / self.buckling
    }

    /// Reason to keep bending effects, if any: buckling, follower loads, parametric excitation, or a coupling that
    /// releases energy.
    pub fn unstable(&self) -> Option<String> {
        self.instability.get_or_init(|| self.instability()).clone()
    }

    fn instability(&self) -> Option<String> {
        let compression = self.compression();
        if compression > SAFE_COMPRESSION {
            return Some(format!(
                "normal forces may reach {} of the buckling load",
                significant(compression, 2)
            ));
        }
        let turns = self.case.loads.iter().any(Load::follows);
        if turns || self.ends.iter().any(|e| e.follower.is_some()) || self.attachments.iter().any(AttachedBody::follows)
        {
            return Some("follower loads may cause flutter".into());
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
        if let Some(growth) = self.pulsates() {
            return Some(format!(
                "pulsating axial forces may amplify bending by a factor e^{}",
                significant(growth, 2)
            ));
        }
        let excess = self.wet.map_or(0.0, |wet| {
            let sum = wet.coupling.curvature(&wet.area, 0.0, 1.0, 0.0) * self.section.bending_stiffness;
            2.0 * sum * wet.area[0].moment_mean / self.compliances(wet)[0]
        });
        (excess > 0.5).then(|| format!("pressure feeds back {} of a bending moment", significant(excess, 2)))
    }

    /// Reason to keep bending effects under axial base motion: Mathieu's equation, with margins in amplitude, frequency
    /// and stiffness.
    fn tongue(&self, signal: &Signal) -> Option<String> {
        let Signal::Sine(sine) = signal else {
            return Some("axial shaking is not a single sine".into());
        };
        let omega = 2.0 * PI * sine.frequency_hz;
        let pull = MATHIEU_COUPLING * sine.amplitude.abs() * omega * omega / self.case.beam.length_m;
        let most = (1.0 + self.stiffening()) * self.softened;
        let steps = (most.ln() / FINER.ln()).ceil().max(1.0);
        for amplitude in [1.0, 1.5] {
            for part in [0.8, 0.9, 1.0, 1.1, 1.25] {
                for step in 0..=steps as u32 {
                    let stiffness = most.powf(f64::from(step) / steps);
                    let growth = mathieu_growth(stiffness * self.bending.powi(2), amplitude * pull, part * omega);
                    if growth > 0.0 {
                        return Some(format!(
                            "axial shaking at {amplitude} times its amplitude and {part} times its frequency amplifies bending at {growth:.1} 1/s"
                        ));
                    }
                }
            }
        }
        None
    }

    /// Growth exponent of bending over the whole run under axial forces that pulsate near twice the bending frequency
    /// or its subharmonics: the worst case `P/(4 P_cr) ω1 T` of Mathieu's equation. None below one.
    fn pulsates(&self) -> Option<f64> {
        let end = self.case.time.end_s;
        let mut swing = 0.0;
        let mut hear = |signal: &Signal, part: f64| {
            if let Some(pace) = SignalExcitation::from_signal(signal, end, self.case.held_at_start(signal))
                && pace.resonates(self.bending)
            {
                let values = signal.range(0.0, end);
                swing += 0.5 * (values.high - values.low) * part;
            }
        };
        for load in self.loads.iter().filter(|load| load.kind == LoadKind::ForceZ) {
            hear(
                &load.signal,
                load.factor.abs() * load.profile.amount() * self.case.beam.length_m,
            );
        }
        for end_of_beam in &self.ends {
            if let Translation::Force(signal) = &end_of_beam.axial {
                hear(signal, 1.0);
            }
        }
        let growth = 0.25 * swing / self.buckling * self.bending * end;
        (growth > 1.0).then_some(growth)
    }

    /// Relative stiffening of bending and stretch by sealed bladders.
    pub fn stiffenings(&self) -> [f64; 2] {
        let along = self.wet.map_or(0.0, |wet| {
            let area = &wet.area[0];
            let density = wet.per_row as f64 / self.case.beam.length_m * wet.bladder_length;
            2.0 * self.section.axial_stiffness * density * area.force_mean.powi(2) / self.compliances(wet)[0]
        });
        [self.stiffening(), along]
    }

    /// `2 EI φ_b l_b am²/a_p`: relative stiffening of bending by sealed bladders.
    fn stiffening(&self) -> f64 {
        self.wet.map_or(0.0, |wet| {
            let area = &wet.area[0];
            let density = wet.per_row as f64 / self.case.beam.length_m * wet.bladder_length;
            2.0 * self.section.bending_stiffness * density * area.moment_mean.powi(2) / self.compliances(wet)[0]
        })
    }

    /// True if a signal acts near or above the first bending frequency, where the response exceeds the static one.
    pub fn resonant(&self) -> bool {
        let mut near = false;
        self.signals(|signal| {
            if let Some(period) = signal.shortest_time_s(self.case.time.end_s) {
                near |= 2.0 * PI / period > 0.4 * self.bending;
            }
        });
        near
    }
}
