//! A family of cycles over one number of the case: shooting with this number as a further unknown.

use serde::{Deserialize, Serialize};

use super::parameter_scale::ParameterScale;
use super::scene::PeriodicScene;
use super::shooting::{
    Convergence, Cycle, FullSteps, MOST_DISTURBANCES, PeriodPass, ShootingRecord, attempt, finish, lost, pass,
};
use crate::case::schema::Case;
use crate::dae::BeamDae;
use crate::numerics::kernels::dot;
use crate::numerics::krylov;
use crate::onestep::StepMap;
use crate::onestep::step_map::StepError;
use crate::run::stop::INTERRUPTED;

/// Step of the coordinate for the derivative of the period map.
const DIFFERENCE: f64 = 1e-4;
/// Largest number of Newton steps for a cycle near a prediction.
const ITERATIONS: usize = 10;
/// Relative residual of the bordered equations; unknowns of fast waves dominate the residual, and the slow ones matter.
const BORDERED: f64 = 1e-6;
/// Excess of the relative change of the period over that of the number above which the common period counts as another one.
const PERIOD: f64 = 0.01;

/// A cycle of a family and its position there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FamilyState {
    /// Coordinate of the number.
    pub coordinate: f64,
    /// State at the beginning of the period, scaled.
    pub y: Vec<f64>,
    /// Norm of half the range of every unknown over the period: the unit of changes of state.
    pub size: f64,
    /// Change of state along the tangent, scaled.
    pub tangent: Vec<f64>,
    /// Change of the coordinate along the tangent.
    pub slope: f64,
}

impl FamilyState {
    /// Tangent in units of `size` for the state, of norm one; the coordinate is its last entry.
    pub fn direction(&self, size: f64) -> Vec<f64> {
        unit(&self.tangent, self.slope, size)
    }

    /// State at a distance along a direction.
    pub fn shifted(&self, direction: &[f64], distance: f64) -> Self {
        let (change, slope) = direction.split_at(self.y.len());
        let moved = self.y.iter().zip(change).map(|(y, d)| y + distance * self.size * d);
        Self {
            y: moved.collect(),
            coordinate: self.coordinate + distance * slope[0],
            ..self.clone()
        }
    }

    /// The state with the opposite tangent.
    pub fn reversed(&self) -> Self {
        Self {
            tangent: self.tangent.iter().map(|x| -x).collect(),
            slope: -self.slope,
            ..self.clone()
        }
    }
}

/// Vector of norm one along a change of state, in units of `size`, and of the coordinate.
pub fn unit(change: &[f64], slope: f64, size: f64) -> Vec<f64> {
    let mut all: Vec<f64> = change.iter().map(|x| x / size).chain([slope]).collect();
    let norm = dot(&all, &all).sqrt();
    all.iter_mut().for_each(|x| *x /= norm);
    all
}

/// A cycle of a family with its case and scene.
pub struct FamilyMember {
    /// Position in the family.
    pub state: FamilyState,
    /// The case.
    pub case: Case,
    /// Its scene.
    pub scene: PeriodicScene,
    /// The cycle.
    pub cycle: Cycle,
}

/// Family of cycles over one number of the case.
#[derive(Clone)]
pub struct CycleFamily<'a> {
    /// Scene whose unknowns and scales all scenes of the family have.
    pub reference: PeriodicScene,
    /// Returns the case for a value.
    pub case_at: &'a dyn Fn(f64) -> crate::error::Result<Case>,
    /// Scale of the values.
    pub scale: ParameterScale,
}

impl CycleFamily<'_> {
    /// Case and scene for a value.
    ///
    /// # Errors
    /// The case is not valid for this value, its unknowns differ, or its common period is another one.
    pub fn at(&self, value: f64) -> Result<(Case, PeriodicScene), StepError> {
        let refuse = |what: String| StepError::new(0.0, what);
        let case = (self.case_at)(value).map_err(|error| refuse(error.to_string()))?;
        let scene = self.reference.alike(&case).map_err(|error| refuse(error.to_string()))?;
        let scene = scene.ok_or_else(|| refuse(format!("the case for {value} has other unknowns")))?;
        let change = (scene.drive.period / self.reference.drive.period).ln().abs();
        let most = (value / self.scale.from).ln().abs() * (1.0 + PERIOD);
        if change > most.max(1e-9) {
            return Err(refuse(format!("the common period of the signals jumps before {value}")));
        }
        Ok((case, scene))
    }

    /// Vector from a state to another in units of `size`: differential unknowns, which determine the others, then the coordinate.
    pub fn chord(&self, from: &FamilyState, to: &FamilyState, size: f64) -> Vec<f64> {
        let differential = &self.reference.system.layout.differential;
        let changes = to.y.iter().zip(&from.y).zip(differential);
        let changes = changes.map(|((to, from), differential)| if *differential { (to - from) / size } else { 0.0 });
        changes.chain([to.coordinate - from.coordinate]).collect()
    }

    /// Finds the cycle for a value from a state near it. `along` is a tangent whose sense the new one has.
    ///
    /// # Errors
    /// No cycle was found.
    pub fn at_value(
        &self,
        (coordinate, value): (f64, f64),
        near: &FamilyState,
        along: &FamilyState,
    ) -> Result<FamilyMember, StepError> {
        let (case, scene) = self.at(value)?;
        let mut from = near.y.clone();
        fill(&scene, &mut from);
        let mut cycle = attempt(&scene, from, &mut ShootingRecord::default())?;
        let state = self.position(&scene, &mut cycle, coordinate, Some(along))?;
        Ok(FamilyMember {
            state,
            case,
            scene,
            cycle,
        })
    }

    /// Position of a cycle in the family, with its tangent. Without `along` the coordinate increases along it.
    ///
    /// # Errors
    /// The cycle cannot be followed for a neighbouring value; the cycle remains as it is.
    pub fn position(
        &self,
        scene: &PeriodicScene,
        cycle: &mut Cycle,
        coordinate: f64,
        along: Option<&FamilyState>,
    ) -> Result<FamilyState, StepError> {
        let slope = self.slope(scene, &mut cycle.march, &cycle.y, coordinate)?;
        let border = match along {
            Some(along) => along.direction(slope.size),
            None => unit(&vec![0.0; cycle.y.len()], 1.0, 1.0),
        };
        self.tangent(scene, cycle, &slope, &border, coordinate)
    }

    /// `[E94]` Finds the cycle on the plane through a predicted state across a direction (Keller's pseudo-arclength):
    ///
    /// ```text
    /// (1 - M) δ - P_c δc = P(y, c) - y      d · (δ, δc) = d · (ŷ - y, ĉ - c)      w · y = w · y₀(c)
    /// ```
    ///
    /// c is the coordinate of the number, P_c the derivative of the period map by c on steps that keep their shares of the period, and
    /// (ŷ, ĉ) the prediction. The matrix is regular at a fold, in contrast to that of [E37].
    ///
    /// # Errors
    /// No cycle was found near the prediction.
    pub fn across(&self, predicted: &FamilyState, direction: &[f64]) -> Result<FamilyMember, StepError> {
        let n = predicted.y.len();
        let unit_size = predicted.size;
        let (mut y, mut coordinate) = (predicted.y.clone(), predicted.coordinate);
        let mut search = ShootingRecord::default();
        let (mut case, mut scene) = self.at(self.scale.value(coordinate))?;
        fill(&scene, &mut y);
        let mut march = scene.map(scene.dae(), &y)?;
        let mut steps = FullSteps::new();
        for _ in 0..ITERATIONS {
            let slope = self.slope(&scene, &mut march, &y, coordinate)?;
            search.periods += 2;
            let off: f64 = dot(&direction[..n], &y) - dot(&direction[..n], &predicted.y);
            let off = off / unit_size + direction[n] * (coordinate - predicted.coordinate);
            let right: Vec<f64> = slope.open.iter().map(|x| x / unit_size).chain([-off]).collect();
            let border = Border {
                by_coordinate: &slope.by_coordinate,
                size: unit_size,
                direction,
            };
            let step = border.solve(&scene, &mut march, &right)?;
            search.newton_steps += 1;
            let change: Vec<f64> = step[..n].iter().map(|x| x * unit_size).collect();
            let value = |coordinate: f64| self.scale.value(coordinate);
            let moved = value(coordinate + step[n]) - value(coordinate);
            let correction = scene
                .size(&change, &y)
                .max(moved.abs() / (scene.rtol * self.scale.unit(coordinate)));
            let convergence = steps.judge(correction);
            if let Convergence::Found = convergence {
                let residual = scene.size(&slope.open, &y);
                let mut cycle = finish(&scene, march, y, &mut search, [correction, residual])?;
                let state = self.tangent(&scene, &mut cycle, &slope, direction, coordinate)?;
                return Ok(FamilyMember {
                    state,
                    case,
                    scene,
                    cycle,
                });
            }
            if let Convergence::Lost = convergence {
                break;
            }
            y.iter_mut().zip(&change).for_each(|(y, change)| *y += change);
            coordinate += step[n];
            let old = scene.drive.period;
            (case, scene) = self.at(value(coordinate))?;
            fill(&scene, &mut y);
            if let Convergence::Near = convergence {
                search.work += march.work();
                march = scene.map(scene.dae(), &y)?;
            } else {
                march.replace(scene.dae(), scene.drive.period / old);
            }
        }
        Err(lost("Newton's iteration along the branch did not converge".into()))
    }

    /// Period map at a state and its derivative by the coordinate; afterwards the march is the one at the state.
    fn slope(
        &self,
        scene: &PeriodicScene,
        march: &mut StepMap<BeamDae>,
        y: &[f64],
        coordinate: f64,
    ) -> Result<MapSlope, StepError> {
        let (_, beside) = self.at(self.scale.value(coordinate + DIFFERENCE))?;
        let mut moved = y.to_vec();
        fill(&beside, &mut moved);
        let factor = beside.drive.period / scene.drive.period;
        march.replace(beside.dae(), factor);
        let there = pass(&beside, march, &moved);
        march.replace(scene.dae(), 1.0 / factor);
        let PeriodPass { open, size, .. } = pass(scene, march, y)?;
        let there = there?.open;
        let by_coordinate = there.iter().zip(&open).map(|(there, here)| (there - here) / DIFFERENCE);
        Ok(MapSlope {
            by_coordinate: by_coordinate.collect(),
            open,
            size,
        })
    }

    /// Position of a cycle with its tangent, in the sense of `border`, a vector of norm one.
    fn tangent(
        &self,
        scene: &PeriodicScene,
        cycle: &mut Cycle,
        slope: &MapSlope,
        border: &[f64],
        coordinate: f64,
    ) -> Result<FamilyState, StepError> {
        let n = cycle.y.len();
        let size = slope.size;
        let equations = Border {
            by_coordinate: &slope.by_coordinate,
            size,
            direction: border,
        };
        let right = unit(&vec![0.0; n], 1.0, 1.0);
        let found = equations.solve(scene, &mut cycle.march, &right)?;
        let norm = dot(&found, &found).sqrt();
        if !(norm.is_finite() && norm > 0.0) {
            return Err(lost("the tangent of the branch is not defined".into()));
        }
        Ok(FamilyState {
            coordinate,
            y: cycle.y.clone(),
            size,
            tangent: found[..n].iter().map(|x| x * size / norm).collect(),
            slope: found[n] / norm,
        })
    }
}

/// Period map at a state.
struct MapSlope {
    /// Final state minus the initial one.
    open: Vec<f64>,
    /// Derivative of it by the coordinate.
    by_coordinate: Vec<f64>,
    /// Norm of half the range of every unknown.
    size: f64,
}

/// Bordered equations of a Newton step.
pub(super) struct Border<'a> {
    /// Derivative of the period map by the further unknown.
    pub(super) by_coordinate: &'a [f64],
    /// Unit of changes of state.
    pub(super) size: f64,
    /// Last row of the equations.
    pub(super) direction: &'a [f64],
}

impl Border<'_> {
    /// Solves the bordered equations by GMRES.
    pub(super) fn solve(
        &self,
        scene: &PeriodicScene,
        march: &mut StepMap<BeamDae>,
        right: &[f64],
    ) -> Result<Vec<f64>, StepError> {
        let n = self.by_coordinate.len();
        let most = (scene.dimension() + 1).min(MOST_DISTURBANCES);
        let map = |x: &mut [f64]| {
            let along = dot(self.direction, x);
            let (v, last) = x.split_at_mut(n);
            scene.carry(march, v);
            let by = last[0] / self.size;
            v.iter_mut()
                .zip(self.by_coordinate)
                .for_each(|(v, slope)| *v += by * slope);
            last[0] -= along;
        };
        let (x, _) = krylov::solve(map, right, BORDERED, most);
        match scene.stop.raised() {
            true => Err(StepError::new(0.0, INTERRUPTED)),
            false => Ok(x),
        }
    }
}

/// Sets the conserved volumes of a state to those of a scene.
pub(super) fn fill(scene: &PeriodicScene, y: &mut [f64]) {
    for w in &scene.conserved {
        let lost = dot(w, &scene.guess) - dot(w, y);
        y.iter_mut().zip(w).for_each(|(y, w)| *y += lost * w);
    }
}
