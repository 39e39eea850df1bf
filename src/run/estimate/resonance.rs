//! Drives near a vibration that the mesh misplaces.

use super::small::{self, SmallMode};
use crate::case::{Rotation, Signal, Translation};
use crate::discrete::System;
use crate::error::Code;
use crate::model::loads::LoadKind;

/// Vibrations that are looked at: the first are computed, the others follow from the spacing of their wave numbers.
const MODES: usize = 16;
/// How many times what it does at rest a vibration must answer to count beside others.
const NEAR: f64 = 3.0;
/// Change of the answer that is told.
const LARGE: f64 = 0.05;

/// What to know of a drive across the beam that comes near a vibration: with δ the relative error of its frequency on this mesh,
///
/// ```text
/// q = f/(ω² - Ω²)     Δq/q = 2 δ ω²/(ω² - Ω²)
/// ```
pub fn warning(system: &System) -> Option<String> {
    if !system.layout.waves[0] {
        return None;
    }
    let s = &system.model.section;
    let length = system.model.length;
    let unit = (s.bending_stiffness / s.mass_per_length).sqrt() / (length * length);
    let fine = (system.mesh.h / length).powi(2);
    let modes = wave_numbers(&small::bending(&system.model.ends));
    let mut worst: Option<(f64, f64, f64, f64)> = None;
    across(system, |signal| {
        let Some(tone) = signal.highest_tone_hz() else { return };
        let drive = std::f64::consts::TAU * tone;
        for (beta, mesh) in &modes {
            let omega = beta * beta * unit;
            let damping = s.drag / s.mass_per_length + s.bending_damping_time * omega * omega;
            let answer = omega * omega / (omega * omega - drive * drive).hypot(damping * drive);
            let misplaced = (mesh * fine).abs();
            let change = 2.0 * misplaced * answer;
            if answer > NEAR && change > LARGE && worst.is_none_or(|w| change > w.3) {
                worst = Some((tone, omega / std::f64::consts::TAU, misplaced, change));
            }
        }
    });
    let (tone, mode, misplaced, change) = worst?;
    let size = if change < 1.0 {
        format!("{:.0} %", 100.0 * change)
    } else {
        "all".into()
    };
    Some(Code::ErrorEstimate.warning(format!(
        "estimate: the drive at {tone:.4} Hz comes near a vibration at {mode:.4} Hz, which the mesh misplaces by {:.1} %: what it excites may \
         be off by about {size}, and largest values are off as well; more /mesh/cells_per_segment, or --accuracy, which measures",
        100.0 * misplaced
    )))
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

/// Visits what acts across the beam.
fn across(system: &System, mut visit: impl FnMut(&Signal)) {
    let model = &system.model;
    for end in &model.ends {
        let (Translation::Displacement(moves) | Translation::Force(moves)) = &end.transverse;
        let (Rotation::Slope(turns) | Rotation::Moment(turns)) = &end.rotation;
        visit(moves);
        visit(turns);
        if let Some(follower) = &end.follower {
            visit(&follower.shear);
        }
    }
    let loads = model.loads.iter().filter(|load| load.kind != LoadKind::ForceZ);
    loads.for_each(|load| visit(&load.signal));
    if let Some(wet) = &model.wet {
        wet.network.ports.iter().for_each(|port| visit(&port.pressure));
        wet.network.sources.iter().for_each(|source| visit(&source.flow));
    }
}
