//! Cycle at a resonance: the phase of the motion is given, the frequency of the drive is a further unknown of shooting.

use nalgebra::Complex;
use serde::{Deserialize, Serialize};

use super::family::{CycleFamily, FamilyMember, FamilyState};
use super::scene::PeriodicScene;
use super::shooting::{Cycle, ShootingRecord, attempt, lost, pass, shoot};
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
/// relative to driven ends is zero in the mean over the beam, weighted by the shape of the motion.
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
    pub fn from_scene(scene: &PeriodicScene) -> Result<(Self, FamilyState), StepError> {
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

    /// Weighted velocity at the beginning of the period, over the size of the motion.
    fn velocity(&self, state: &FamilyState) -> f64 {
        dot(&self.weights, &state.y) / state.size
    }

    /// `[E100]` Finds the cycle at the resonance near a state. The family is one over the frequency f of the drive, in logarithms:
    ///
    /// ```text
    /// P(y, c) = y     Σ φᵢ vᵢ = 0 at t = 0     c = ln f
    /// ```
    ///
    /// φ is the shape. The velocities v, as all unknowns, are relative to the motion of the ends. The drive passes zero at the beginning of the period. Without damping and
    /// drive these cycles are the nonlinear normal modes; with them, the backbone of the response (Peeters, Kerschen, Golinval 2011).
    ///
    /// # Errors
    /// No such cycle was found near the state.
    pub fn meet(&self, family: &CycleFamily, near: &FamilyState) -> Result<FamilyMember, StepError> {
        let direction: Vec<f64> = self.weights.iter().copied().chain([0.0]).collect();
        let velocity = dot(&self.weights, &near.y);
        let mut still = near.clone();
        still
            .y
            .iter_mut()
            .zip(&self.weights)
            .for_each(|(y, weight)| *y -= velocity * weight);
        let found = family.across(&still, &direction)?;
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
        let mut velocity = self.velocity(&here);
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
                    let next = self.velocity(&there.state);
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

/// First harmonic of the unknowns, `∫ y exp(-2πit/T) dt`.
fn harmonic(scene: &PeriodicScene, cycle: &mut Cycle) -> Result<Vec<Complex<f64>>, StepError> {
    let turns = std::f64::consts::TAU / scene.drive.period;
    let (mut y, mut yp) = (cycle.y.clone(), cycle.yp.clone());
    let mut sum = vec![Complex::new(0.0, 0.0); y.len()];
    let start = y.clone();
    let mut before = (0.0, start.clone());
    cycle.march.go(&mut y, &mut yp, &mut |_, t, y| {
        let weight = 0.5 * (t - before.0);
        for (k, sum) in sum.iter_mut().enumerate() {
            let turned = |t: f64, y: f64| Complex::from_polar(y - start[k], -turns * t);
            *sum += weight * (turned(before.0, before.1[k]) + turned(t, y[k]));
        }
        before = (t, y.to_vec());
    })?;
    Ok(sum)
}
