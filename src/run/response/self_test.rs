//! Self-test of a state-space model: a small change of the input, in the model and in the nonlinear equations.
//!
//! The input moves smoothly from its value at the operating point by δ. The nonlinear equations are those of the linearization, with
//! their effects. Their change is half the difference of runs with δ and -δ, in which drift and quadratic terms cancel. Openings move
//! towards the middle of their range only.

use std::f64::consts::TAU;

use serde::Serialize;

use super::instant::Instant;
use super::scaled_model::{EARLY, ScaledModel};
use super::state_space::{StateSpace, dynamic};
use super::{LinearResponse, columns};
use crate::dae::{BeamDae, Dae};
use crate::error::numbers::significant;
use crate::functions::signals::{Ramp, RampShape, Signal};
use crate::integrate::{AbsoluteTolerances, IntegrationError, halt};
use crate::numerics::threads;
use crate::onestep::{OneStep, OneStepOptions, TableauMethod};

/// Largest displacement relative to the beam, and of a moving end, over the length of the beam; its parts in successive tests.
const SIZE: f64 = 1e-3;
const PARTS: [f64; 3] = [1.0, 0.1, 0.01];
/// Largest change of an opening.
const OPENING: f64 = 0.01;
/// Motion, over that of the test, that is rounding error.
const NOTHING: f64 = 1e-9;
/// Frequencies at which sizes of unknowns are computed, and their ratio; smallest size over the largest.
const FREQUENCIES: usize = 16;
const PER_FREQUENCY: f64 = 1.8;
const SMALL: f64 = 1e-4;
/// Cycles of the last frequency of the model during the change; its spectrum there is 0.4 % of that of a step.
const CYCLES: f64 = 5.0;
/// Last frequency of a model with all states, over the reference of the beam's angular frequencies.
const WITHOUT_BAND: f64 = 9.0;
/// Tolerance of the integration, relative to the sizes of the unknowns, and to their values.
pub(super) const TOLERANCE: f64 = 1e-6;
const RELATIVE: f64 = 1e-12;
/// Largest number of steps in an integration.
pub(super) const STEPS: u64 = 2000;
/// Frequency of the static gain over the reference of the beam's frequencies, and ratio of imaginary to real part up to which it is one.
const STATIC: f64 = 1e-7;
const QUASI_STATIC: f64 = 1e-2;
/// Permitted difference: the stated error of the model times a factor for peaks, plus the tolerance.
const OF_ERROR: f64 = 5.0;
const PERMITTED: f64 = 2e-3;

/// Difference between a state-space model and the nonlinear equations for a small change of the input.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SelfTest {
    /// Change of the input, in its unit.
    pub step: f64,
    /// Duration of the change [s].
    pub ramp_s: f64,
    /// Simulated time [s].
    pub time_s: f64,
    /// Largest difference of each output, relative to its largest change; 0 if neither responds.
    pub difference: Vec<f64>,
    /// Largest change of each output, in its unit.
    pub change: Vec<f64>,
    /// Largest permitted difference.
    pub limit: f64,
}

impl SelfTest {
    /// Tests a model of a response.
    ///
    /// # Errors
    /// The reason why there is no test, as text: the state or the input does not permit it, or an integration failed.
    pub fn new(response: &LinearResponse, model: &StateSpace, growing: usize) -> std::result::Result<Self, String> {
        if response.about.moving() {
            return Err("the state is not an equilibrium".into());
        }
        if growing > 0 {
            return Err("small motions about the state grow".into());
        }
        // differences by nonlinearity vanish with the change, those by errors of the model do not
        let mut best: Option<Self> = None;
        for part in PARTS {
            let test = Self::with(response, model, part)?;
            let better = best.as_ref().is_none_or(|best| test.worst().1 < best.worst().1);
            let passed = test.passed();
            if better {
                best = Some(test);
            }
            if passed || !better {
                break;
            }
        }
        best.ok_or_else(|| "no test".into())
    }

    /// True if the differences are permitted.
    pub fn passed(&self) -> bool {
        self.worst().1 <= self.limit
    }

    /// Index of the output with the largest difference, and the difference.
    pub fn worst(&self) -> (usize, f64) {
        let all = self.difference.iter().copied().enumerate();
        all.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0))
    }

    fn with(response: &LinearResponse, model: &StateSpace, part: f64) -> std::result::Result<Self, String> {
        let last_hz = match model.reduction {
            Some(reduction) => reduction.band[1],
            None => WITHOUT_BAND * response.about.frequency(),
        };
        let ramp_s = CYCLES / last_hz;
        let opens = response.input.contains("/opening");
        let towards = if opens && response.u0 > 0.5 { -1.0 } else { 1.0 };
        let motion = SmallMotion::new(response, [last_hz, ramp_s], part)?;
        let step = towards * motion.step;
        let moved = |by: f64| Ramp {
            from: response.u0,
            to: response.u0 + by,
            start_s: 0.0,
            duration_s: ramp_s,
            shape: RampShape::Smooth,
        };
        let sizes = match model.reduction {
            // states of a reduced model are of the size of its input
            Some(_) => vec![step.abs(); model.b.len()],
            None => motion.states(response),
        };
        let linear = ScaledModel::new(model, moved(step), sizes).simulated(static_gain(response)?)?;
        let times: Vec<f64> = linear.iter().map(|(t, _)| *t).collect();
        let heard = &halt::heard();
        let opposite = if opens { 0.0 } else { -step };
        let run = |by: f64| simulated(response, moved(by), &times, &motion);
        let (up, down) = threads::both(|| heard.during(|| run(step)), || run(opposite));
        let (up, down) = (up?, down?);
        let count = up.len().min(down.len());
        let share = step / (step - opposite);
        let outputs = response.outputs.len();
        let (mut difference, mut change) = (vec![0.0_f64; outputs], vec![0.0_f64; outputs]);
        let mut noise = vec![0.0_f64; outputs];
        for ((up, down), (_, linear)) in up.iter().zip(&down).zip(&linear) {
            for p in 0..outputs {
                let exact = share * (up[p] - down[p]);
                difference[p] = difference[p].max((linear[p] - exact).abs());
                change[p] = change[p].max(exact.abs()).max(linear[p].abs());
                noise[p] = noise[p].max((0.5 * (up[p] + down[p]) - response.z0[p]).abs());
            }
        }
        for p in 0..outputs {
            let silent = linear.iter().all(|(_, z)| z[p] == 0.0) && change[p] <= 10.0 * noise[p];
            difference[p] = if silent || change[p] == 0.0 {
                0.0
            } else {
                difference[p] / change[p]
            };
        }
        let error = model.reduction.map_or(0.0, |reduction| reduction.error);
        Ok(Self {
            step,
            ramp_s,
            time_s: times[count - 1],
            difference,
            change,
            limit: OF_ERROR * error + PERMITTED,
        })
    }
}

/// A change of the input, and the sizes of the scaled unknowns during it.
struct SmallMotion {
    step: f64,
    sizes: Vec<f64>,
}

impl SmallMotion {
    /// `part` is the size of the change over the usual one.
    fn new(response: &LinearResponse, [last_hz, ramp_s]: [f64; 2], part: f64) -> std::result::Result<Self, String> {
        let system = response.about.system();
        let mut sizes = vec![0.0_f64; system.layout.len];
        let mut solver = response.solver().map_err(|fault| fault.to_string())?;
        for k in 0..FREQUENCIES {
            let hz = last_hz * PER_FREQUENCY.powi(-(k as i32));
            let (_, x) = solver.state(hz).map_err(|fault| fault.to_string())?;
            // envelope of the spectrum of the change over that of a step
            let weight = 1.0 / (1.0 + (TAU * hz * ramp_s).powi(3) / 120.0);
            for (size, x) in sizes.iter_mut().zip(&x) {
                *size = size.max(weight * x.norm());
            }
        }
        let nodes = system.layout.lines.iter().flat_map(|line| line.u.clone());
        let moved = nodes.map(|k| sizes[k] * system.layout.scales[k] / system.model.length);
        let largest = match moved.fold(0.0, f64::max) {
            0.0 => sizes.iter().copied().fold(0.0, f64::max),
            moved => moved,
        };
        let own = match response.input.rsplit('/').next() {
            Some("u1_m" | "u3_m") => system.model.length,
            Some("slope_rad") => 1.0,
            _ if response.input.contains("/opening") => OPENING / SIZE,
            _ => f64::INFINITY,
        };
        let step = part * SIZE * largest.recip().min(own);
        if !step.is_finite() || step * largest < NOTHING * part * SIZE {
            return Err("nothing moves with the input".into());
        }
        let least = SMALL * sizes.iter().copied().fold(0.0, f64::max);
        sizes.iter_mut().for_each(|size| *size = step * size.max(least));
        Ok(Self { step, sizes })
    }

    /// Sizes of the states of a model with all states.
    fn states(&self, response: &LinearResponse) -> Vec<f64> {
        let dynamic = dynamic(&response.about.pencil()).into_iter();
        let sizes = self.sizes.iter().zip(&response.about.system().layout.scales);
        let all = dynamic.zip(sizes).filter(|(dynamic, _)| *dynamic);
        all.map(|(_, (size, scale))| size * scale).collect()
    }
}

/// Static gain of each output, if there is one.
fn static_gain(response: &LinearResponse) -> std::result::Result<Vec<Option<f64>>, String> {
    let slow = STATIC * response.about.frequency();
    let values = response.solver().and_then(|mut solver| solver.at(slow));
    let values = values.map_err(|fault| fault.to_string())?;
    let gain = |value: &nalgebra::Complex<f64>| (value.im.abs() <= QUASI_STATIC * value.re.abs()).then_some(value.re);
    Ok(values.iter().map(gain).collect())
}

pub(super) fn options(absolute: AbsoluteTolerances) -> OneStepOptions {
    OneStepOptions {
        method: TableauMethod::Esdirk46,
        relative: RELATIVE,
        absolute,
        ..OneStepOptions::default()
    }
}

pub(super) fn failed(fault: &IntegrationError) -> String {
    format!("the integrator failed at {:.3} s: {}", fault.time, fault.meaning)
}

/// Outputs of the nonlinear equations at instants, up to a number of steps; `part` is the size of the change over the usual one.
fn simulated(
    response: &LinearResponse,
    change: Ramp,
    times: &[f64],
    motion: &SmallMotion,
) -> std::result::Result<Vec<Vec<f64>>, String> {
    let columns = columns(response.about.system());
    let place = |output| columns.iter().position(|column| column == output);
    let chosen: Option<Vec<usize>> = response.outputs.iter().map(place).collect();
    let chosen = chosen.ok_or("an output is not one of the case")?;
    let ramp_s = change.duration_s;
    let signal = Signal::Ramp(change);
    let mut dae = response.about.dae.clone();
    dae.put_signal(&response.places, &signal);
    dae.enter_smooth_interval(0.5 * ramp_s);
    let y = &response.about.y;
    let absolute = motion.sizes.iter().map(|size| TOLERANCE * size).collect();
    let options = options(AbsoluteTolerances::Each(absolute));
    let mut solver =
        OneStep::<BeamDae>::new(dae, 0.0, y, &vec![0.0; y.len()], &options).map_err(|fault| failed(&fault))?;
    let mut rows = vec![];
    for &t in times {
        if !reached(&mut solver, t)? {
            break;
        }
        let (y, yp) = (solver.y().to_vec(), solver.yp().to_vec());
        let mut instant = Instant::new(solver.dae_mut(), response.places.clone(), signal.clone(), false);
        instant.enter(t, [&y, &yp]);
        let all = instant.outputs();
        rows.push(chosen.iter().map(|&place| all[place]).collect());
        if solver.dae().within() < ramp_s && t >= ramp_s * (1.0 - 1e-12) {
            let size = solver.size();
            solver.dae_mut().enter_smooth_interval(2.0 * ramp_s);
            solver.go_on(t, &y, &yp).map_err(|fault| failed(&fault))?;
            solver.propose(size);
        }
    }
    match rows.len() {
        short if short < EARLY => Err(format!(
            "{STEPS} steps end before {} s",
            significant(times[EARLY - 1], 3)
        )),
        _ => Ok(rows),
    }
}

/// Steps to an instant [s]; false if the steps do not suffice.
pub(super) fn reached<D: Dae>(solver: &mut OneStep<D>, t: f64) -> std::result::Result<bool, String> {
    while solver.time() < t {
        if halt::asked() {
            return Err("interrupted".into());
        }
        if solver.steps() >= STEPS {
            return Ok(false);
        }
        solver.step(t).map_err(|fault| failed(&fault))?;
    }
    Ok(true)
}
