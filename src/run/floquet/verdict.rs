//! Stability of a cycle and its cause, as text.

use serde::{Deserialize, Serialize};

use super::Multiplier;
use super::shape::EnergyPart;
use crate::run::json_null;
use crate::run::periodic::PeriodicScene;

/// Growth over a period below which a disturbance counts as neutral: the effect of the steps' own error on a multiplier of one.
const NEUTRAL: f64 = 1e-5;
/// Angle [rad] from the real axis within which a multiplier counts as real.
const REAL: f64 = 1e-6;

/// Stability of a cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CycleStability {
    /// All disturbances decay.
    Stable,
    /// No disturbance grows, but some do not decay.
    Neutral,
    /// A disturbance grows.
    Unstable,
}

/// Verdict on a cycle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CycleVerdict {
    /// Stability class.
    pub stability: CycleStability,
    /// Growth rate of the largest multiplier [1/s].
    #[serde(deserialize_with = "json_null::number")]
    pub growth_per_s: f64,
    /// Description in a sentence.
    pub words: String,
}

/// Derives the verdict from the largest multiplier.
pub fn judge(multipliers: &[Multiplier], scene: &PeriodicScene) -> CycleVerdict {
    let Some(first) = multipliers.first() else {
        return CycleVerdict {
            stability: CycleStability::Stable,
            growth_per_s: f64::NEG_INFINITY,
            words: "stable: every disturbance decays within one period".into(),
        };
    };
    let growth = first.growth_per_s;
    let threshold = NEUTRAL.max(scene.rtol) / scene.drive.period;
    let (stability, words) = if growth > threshold {
        (CycleStability::Unstable, unstable(first, scene))
    } else if growth > -threshold {
        let words = format!(
            "neutral: {} neither grows nor decays (modulus of the multiplier 1 within {:.0e})",
            at(first),
            (first.modulus - 1.0).abs().max(1e-16)
        );
        (CycleStability::Neutral, words)
    } else {
        let words = format!(
            "stable: the slowest disturbance, {}, decays at {:.4} /s",
            at(first),
            -growth
        );
        (CycleStability::Stable, words)
    };
    CycleVerdict {
        stability,
        growth_per_s: growth,
        words,
    }
}

/// Describes the part that oscillates, and its frequency; creeping fluid does not oscillate.
fn at(m: &Multiplier) -> String {
    match m.frequency_hz > 0.0 {
        true => format!("{} at {:.4} Hz", m.part, m.frequency_hz),
        false => format!("{} without oscillation", m.part),
    }
}

fn unstable(m: &Multiplier, scene: &PeriodicScene) -> String {
    let rate = format!("with growth {:.4} /s", m.growth_per_s);
    let angle = m.im.atan2(m.re);
    let (kind, value) = if angle < REAL {
        ("harmonic", format!("{:.4}", m.re))
    } else if std::f64::consts::PI - angle < REAL {
        ("subharmonic", format!("{:.4}", m.re))
    } else {
        let degrees = angle.to_degrees();
        (
            "at a frequency of its own",
            format!("{:.4} at {degrees:.1} deg", m.modulus),
        )
    };
    let kind = format!("{kind}, multiplier {value}");
    match (m.part, scene.drive.driven) {
        _ if scene.free_period => format!("instability of {} ({kind}) {rate}", m.part),
        (EnergyPart::Bending(_), true) => format!("parametric resonance of {} ({kind}) {rate}", m.part),
        (_, true) => format!("instability of {} ({kind}) {rate}", m.part),
        (_, false) if angle < REAL => format!("divergence of {} {rate}", m.part),
        (_, false) => format!("flutter of {} {rate}", at(m)),
    }
}
