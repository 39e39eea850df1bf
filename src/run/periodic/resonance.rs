//! Cycle at a resonance: the phase of the motion is given, the frequency of the drive is a further unknown of shooting.

use nalgebra::Complex;
use serde::{Deserialize, Serialize};

use super::family::{CycleFamily, FamilyMember, FamilyState};
use super::scene::PeriodicScene;
use super::shooting::{Cycle, ShootingRecord, attempt, lost, pass, shoot};
use crate::dae::BeamDae;
use crate::discrete::layout::LineLayout;
use crate::numerics::kernels::dot;
use crate::onestep::step_map::StepError;

/// Largest change of the frequency, as its logarithm, from the first guess to the resonance, and between neighbouring ones.
const FARTHEST: f64 = 0.3;

/// First and smallest step along the response in the search for the resonance, in units of the motion, and largest number of steps.
const STEP: f64 = 0.3;
const SHORTEST: f64 = 1e-3;
const MOST_STEPS: usize = 60;

/// Condition that drive and motion are a quarter period apart: where the drive passes zero, at the beginning of the period, the velocity
/// relative to the ends is zero in the mean over the beam, weighted by the shape of the motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PhaseCondition {
    /// Weight of each scaled unknown, zero except for velocities; of norm one.
    weights: Vec<f64>,
}

impl PhaseCondition {
    /// Condition with the shape of the cycle of a scene, that of its first harmonic; also the cycle as a state at the coordinate 0.
    ///
    /// # Errors
    /// The scene has no cycle, or the beam does not move in it.
    pub fn of(scene: &PeriodicScene) -> Result<(Self, FamilyState), StepError> {
        let mut cycle = shoot(scene, None)?;
        let first = harmonic(scene, &mut cycle)?;
        // the phase at which most of the motion is in its largest deflection
        let square: Complex<f64> = first.iter().map(|x| x * x).sum();
        let turn = Complex::from_polar(1.0, -0.5 * square.arg());
        let l = &scene.system.layout;
        let mut weights = vec![0.0; first.len()];
        for (_, u, v) in l.lines.iter().flat_map(LineLayout::unknowns) {
            if let Some(v) = v {
                weights[v] = (first[u] * turn).re * l.scales[u] * l.scales[v];
            }
        }
        let norm = dot(&weights, &weights).sqrt();
        if !(norm.is_finite() && norm > 0.0) {
            return Err(lost(
                "the beam does not move with the drive, or it has no inertia".into(),
            ));
        }
        weights.iter_mut().for_each(|weight| *weight /= norm);
        let state = FamilyState {
            coordinate: 0.0,
            size: pass(scene, &mut cycle.march, &cycle.y)?.size,
            tangent: vec![0.0; cycle.y.len()],
            slope: 1.0,
            y: cycle.y,
        };
        Ok((Self { weights }, state))
    }

    /// Weighted velocities of the ends' motion at the beginning of the period.
    fn carried(&self, scene: &PeriodicScene) -> f64 {
        let mut dae = scene.dae();
        let (system, now) = dae.instant(0.0);
        let l = &system.layout;
        let of_line = |(axis, line): (usize, &LineLayout)| -> f64 {
            let velocity = |(node, _, v): (usize, usize, Option<usize>)| {
                v.map(|v| self.weights[v] * now.carried(axis, system.mesh.share(node)).rate / l.scales[v])
            };
            line.unknowns().filter_map(velocity).sum()
        };
        l.lines.iter().enumerate().map(of_line).sum()
    }

    /// Weighted velocity at the beginning of the period relative to the ends, over the size of the motion.
    fn velocity(&self, scene: &PeriodicScene, state: &FamilyState) -> f64 {
        (dot(&self.weights, &state.y) - self.carried(scene)) / state.size
    }

    /// `[E100]` Finds the cycle at the resonance near a state. The family is one over the frequency f of the drive, in logarithms:
    ///
    /// ```text
    /// P(y, c) = y     Σ φᵢ (vᵢ - v̄ᵢ) = 0 at t = 0     c = ln f
    /// ```
    ///
    /// φ is the shape, v̄ the velocity of the ends' motion. The drive passes zero at the beginning of the period. Without damping and
    /// drive these cycles are the nonlinear normal modes; with them, the backbone of the response (Peeters, Kerschen, Golinval 2011).
    ///
    /// # Errors
    /// No such cycle was found near the state.
    pub fn meet(&self, family: &CycleFamily, near: &FamilyState) -> Result<FamilyMember, StepError> {
        let (_, scene) = family.at(family.scale.value(near.coordinate))?;
        // the velocity of driven ends is proportional to the frequency
        let by_coordinate = -self.carried(&scene) / near.size;
        let direction: Vec<f64> = self.weights.iter().copied().chain([by_coordinate]).collect();
        let off = |scene: &PeriodicScene, y: &[f64], _: f64| (dot(&self.weights, y) - self.carried(scene)) / near.size;
        let found = family.meet(near, &direction, &off)?;
        match (found.state.coordinate - near.coordinate).abs() * family.scale.step < FARTHEST {
            true => Ok(found),
            false => Err(lost("Newton's iteration ends at another resonance".into())),
        }
    }

    /// Finds the resonance from the cycle of the reference. If it is too far for Newton's iteration, follows the response over the frequency
    /// until this passes the resonance.
    ///
    /// # Errors
    /// The response cannot be followed, or has no resonance near.
    pub fn approach(&self, family: &CycleFamily, begin: &FamilyState) -> Result<FamilyMember, StepError> {
        if let Ok(found) = self.meet(family, begin) {
            return Ok(found);
        }
        let scene = &family.reference;
        let mut cycle = attempt(scene, begin.y.clone(), &mut ShootingRecord::default())?;
        let mut here = family.position(scene, &mut cycle, begin.coordinate, None)?;
        let mut velocity = self.velocity(scene, &here);
        if velocity * dot(&self.weights, &here.tangent) > 0.0 {
            here = here.reversed();
        }
        let mut step = STEP;
        for _ in 0..MOST_STEPS {
            let direction = here.direction(here.size);
            match family.across(&here.shifted(&direction, step), &direction) {
                Err(error) if step < SHORTEST || family.reference.stop.raised() => return Err(error),
                Err(_) => step *= 0.5,
                Ok(there) => {
                    let next = self.velocity(&there.scene, &there.state);
                    if next * velocity <= 0.0 {
                        return self.meet(family, &here.shifted(&direction, step * velocity / (velocity - next)));
                    }
                    (here, velocity) = (there.state, next);
                }
            }
        }
        Err(lost("the response has no resonance near the mode".into()))
    }
}

/// First harmonic of the displacements relative to the ends' motion, `∫ u exp(-2πit/T) dt`, at the index of each unknown.
fn harmonic(scene: &PeriodicScene, cycle: &mut Cycle) -> Result<Vec<Complex<f64>>, StepError> {
    let turns = std::f64::consts::TAU / scene.drive.period;
    let (mut y, mut yp) = (cycle.y.clone(), cycle.yp.clone());
    let mut sum = vec![Complex::new(0.0, 0.0); y.len()];
    let displacements = |dae: &mut BeamDae, t: f64, y: &[f64]| -> Vec<(usize, f64)> {
        let (system, now) = dae.instant(t);
        let l = &system.layout;
        let of_line = |(axis, line): (usize, &LineLayout)| {
            let of = |(node, u, _)| (u, y[u] - now.carried(axis, system.mesh.share(node)).value / l.scales[u]);
            line.unknowns().map(of).collect::<Vec<_>>()
        };
        l.lines.iter().enumerate().flat_map(of_line).collect()
    };
    let start = displacements(&mut scene.dae(), 0.0, &y);
    let mut before = (0.0, start.clone());
    cycle.march.go(&mut y, &mut yp, &mut |dae, t, y| {
        let here = displacements(dae, t, y);
        let weight = 0.5 * (t - before.0);
        for (((u, now), (_, old)), (_, first)) in here.iter().zip(&before.1).zip(&start) {
            let turned = |t: f64, u: f64| Complex::from_polar(u - first, -turns * t);
            sum[*u] += weight * (turned(before.0, *old) + turned(t, *now));
        }
        before = (t, here);
    })?;
    Ok(sum)
}
