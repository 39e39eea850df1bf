//! Drives near a vibration that the mesh misplaces.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::words::LARGE;
use crate::case::schema::Effect;
use crate::case::{Rotation, Translation, relaxation};
use crate::discrete::System;
use crate::discrete::straight::meshed::{self, SmallMode};
use crate::functions::Signal;
use crate::model::loads::LoadKind;

/// Vibrations that are looked at: the first are computed, the others follow from the spacing of their wave numbers.
const MODES: usize = 16;
/// How many times what it does at rest a vibration must answer to count beside others.
const NEAR: f64 = 3.0;

/// A drive near a vibration.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Near {
    /// Of the drive [Hz].
    pub drive_hz: f64,
    /// Of the vibration without fluid [Hz].
    pub vibration_hz: f64,
    /// Relative error of that on this mesh.
    pub misplaced: f64,
    /// Relative change of what the drive excites.
    pub change: f64,
    /// Wave number of the vibration [1/m].
    pub wave_number: f64,
}

impl Near {
    /// Relative change of a displacement of a size [m], or of a slope (`turned`), in a motion whose accelerations are no larger than given
    /// [m/s^2]: no more than `a/Ω²` of it is at the drive's frequency.
    pub fn of(&self, size: f64, turned: bool, acceleration: f64) -> f64 {
        let swing = acceleration / (TAU * self.drive_hz).powi(2);
        let swing = if turned { swing * self.wave_number } else { swing };
        self.change * (swing / size.max(f64::MIN_POSITIVE)).min(1.0)
    }
}

/// The drive across the beam that comes so near a vibration that the mesh changes most what it excites: with δ the relative error of
/// its frequency on this mesh,
///
/// ```text
/// q = f/(ω² - Ω²)     Δq/q = 2 δ ω²/(ω² - Ω²)
/// ```
///
/// Where the solid relaxes ω² stands with its dynamic modulus at Ω.
pub fn nearest(system: &System) -> Option<Near> {
    system.layout.lines[0].v.as_ref()?;
    let s = &system.model.section;
    let length = system.model.length;
    let unit = (s.bending_stiffness / s.mass_per_length).sqrt() / (length * length);
    let fine = (system.mesh.h / length).powi(2);
    let sheared = system.model.effects.has(Effect::Shear);
    let modes = wave_numbers(&meshed::bending(&system.model.ends));
    let mut worst: Option<Near> = None;
    for drive_hz in tones(system)[0].iter().copied() {
        let drive = TAU * drive_hz;
        for (beta, mesh) in &modes {
            let rigid = beta * beta * unit;
            let omega = if sheared { s.sheared(rigid) } else { rigid };
            let damping = s.drag / s.mass_per_length + s.bending_damping_time * omega * omega;
            let [storage, loss] =
                relaxation::dynamic_modulus(&system.model.relaxation, drive).map(|e| e * omega * omega);
            let answer = omega * omega / (storage - drive * drive).hypot(damping * drive + loss);
            let misplaced = (mesh * fine).abs();
            let change = 2.0 * misplaced * answer;
            if answer > NEAR && change > LARGE && worst.is_none_or(|w| change > w.change) {
                worst = Some(Near {
                    drive_hz,
                    vibration_hz: relaxation::vibration(&system.model.relaxation, omega)[0] / TAU,
                    misplaced,
                    change,
                    wave_number: beta / length,
                });
            }
        }
    }
    worst
}

/// Tones of what acts across and along the beam [Hz].
pub fn tones(system: &System) -> [Vec<f64>; 2] {
    let model = &system.model;
    let (mut across, mut along) = (vec![], vec![]);
    let hear = |tones: &mut Vec<f64>, signal: &Signal| tones.extend(signal.highest_tone_hz());
    for end in &model.ends {
        let (Translation::Displacement(moves) | Translation::Force(moves)) = &end.transverse;
        let (Rotation::Slope(turns) | Rotation::Moment(turns)) = &end.rotation;
        hear(&mut across, moves);
        hear(&mut across, turns);
        let (Translation::Displacement(moves) | Translation::Force(moves)) = &end.axial;
        hear(&mut along, moves);
        if let Some(follower) = &end.follower {
            hear(&mut across, &follower.shear);
            hear(&mut along, &follower.normal);
        }
    }
    for force in model.attachments.iter().flat_map(|attachment| &attachment.forces) {
        let tones = if force.axis == 1 { &mut along } else { &mut across };
        hear(tones, &force.signal);
    }
    for load in &model.loads {
        let tones = if load.kind == LoadKind::ForceZ {
            &mut along
        } else {
            &mut across
        };
        hear(tones, &load.signal);
    }
    if let Some(wet) = &model.wet {
        let network = &wet.network;
        let ports = network.ports.iter().map(|port| &port.pressure);
        let sources = network.sources.iter().map(|source| source.feed.signal());
        let pumps = network.links.iter().filter_map(|link| link.pump.as_ref());
        for signal in ports.chain(sources).chain(pumps.map(|pump| &pump.pressure)) {
            hear(&mut across, signal);
            hear(&mut along, signal);
        }
    }
    [across, along]
}

/// `β` and the factor of the mesh's error of the frequency; beyond the computed ones `β` rises by π and the error with `β²`.
fn wave_numbers(computed: &[SmallMode]) -> Vec<(f64, f64)> {
    let mut all: Vec<(f64, f64)> = computed.iter().map(|m| (m.frequency.sqrt(), m.mesh)).collect();
    if let Some(&(beta, mesh)) = all.last() {
        for k in 1..=MODES.saturating_sub(all.len()) {
            let next = beta + k as f64 * std::f64::consts::PI;
            all.push((next, mesh * (next / beta).powi(2)));
        }
    }
    all
}
