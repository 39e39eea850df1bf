//! Self-oscillation: a cycle of a case that nothing drives periodically. Its period is a further unknown of shooting.

use std::f64::consts::TAU;

use super::PeriodicScene;
use super::family::{Border, fill};
use super::scene::{fault, system};
use super::shooting::{Convergence, Cycle, FullSteps, Ranges, ShootingRecord, finish, lost, pass, smallest};
use crate::case::schema::Case;
use crate::discrete::layout::LineLayout;
use crate::error::numbers::quantity;
use crate::error::{Code, Error, Result, SolverError, StopPoint};
use crate::numerics::kernels::dot;
use crate::onestep::step_map::StepError;
use crate::run::checkpoint::Checkpoint;
use crate::run::drive::settles_at;
use crate::run::dynamics;
use crate::run::modes::{self, ModeOptions};
use crate::run::record::{Control, Progress, Recorder};
use crate::run::stop::StopFlag;

/// Share of the time of the case that is simulated before the motion is examined.
const TRANSIENT: f64 = 0.75;
/// Largest distance of a state that counts as a return, relative to the largest distance on the way.
const RETURN: f64 = 0.3;
/// Size of a motion, over the tolerance, below which it counts as rest.
const REST: f64 = 10.0;
/// Largest number of attempts, and number of periods simulated between two of them.
const TRIES: (usize, usize) = (8, 24);
/// Relative decrease of the amplitude between two attempts above which the motion decays.
const DECAY: f64 = 0.01;
/// Largest number of Newton steps.
const ITERATIONS: usize = 20;
/// Largest relative change of the period in a Newton step.
const LONGEST: f64 = 0.2;
/// Number of modes in the message about a motion that decays.
const MODES: usize = 6;

/// Motion at the end of a stretch of time.
struct Motion {
    /// State of fastest motion.
    y: Vec<f64>,
    /// Unit vector along its flow, without velocities.
    flow: Vec<f64>,
    /// Largest half range of a displacement [m].
    amplitude: f64,
    /// Norm of half the range of all unknowns, over the tolerance.
    size: f64,
}

/// Finds the self-oscillation that a case approaches from its start. The motion is simulated over the case's own time. Its
/// last oscillation gives state and period for Newton's iteration.
///
/// # Errors
/// [`Error::Solver`] if the motion decays to rest or no cycle was found; [`Error::Usage`] if nothing dissipates energy; those of [`PeriodicScene::new`] and of a run.
pub fn find(case: &Case, stop: &StopFlag) -> Result<(PeriodicScene, Cycle)> {
    let mut scene = PeriodicScene::new(case, Some(case.time.end_s))?.heeding(stop);
    scene.held(&case.name)?;
    scene.free_period = true;
    let mut y = transient(case, &scene)?;
    let mut window = (1.0 - TRANSIENT) * case.time.end_s;
    let mut search = ShootingRecord::default();
    let (mut before, mut amplitude) = (f64::INFINITY, 0.0);
    let mut reason = None;
    for _ in 0..TRIES.0 {
        let motion = observe(&scene, &y, window).map_err(fault)?;
        let extent = if motion.amplitude > 0.0 {
            motion.amplitude
        } else {
            motion.size
        };
        if motion.size < REST || reason.is_some() && extent < before * (1.0 - DECAY) {
            return Err(rest(case, motion.amplitude));
        }
        (before, amplitude) = (extent, motion.amplitude);
        let Some(period) = returns(&scene, &motion, case.time.end_s).map_err(fault)? else {
            let reason = "its last state does not return".to_string();
            return Err(none(case, motion.amplitude, &reason));
        };
        scene.drive.period = period;
        match attempt(&mut scene, &motion.y, &motion.flow, &mut search) {
            Ok(cycle) => return Ok((scene, cycle)),
            Err(error) if stop.raised() => return Err(fault(error)),
            Err(error) => reason = Some(error.what),
        }
        scene.drive.period = period;
        y = scene.go_on(&motion.y, TRIES.1, &mut search).map_err(fault)?;
        window = 3.0 * period;
    }
    Err(none(case, amplitude, &reason.unwrap_or_default()))
}

/// Finds a known self-oscillation again, at the tolerance of the scene.
///
/// # Errors
/// No cycle was found.
pub(super) fn refine(scene: &mut PeriodicScene, known: &Cycle) -> std::result::Result<Cycle, StepError> {
    let flow = section(scene, &known.yp);
    let norm = dot(&flow, &flow).sqrt();
    let flow: Vec<f64> = flow.iter().map(|f| f / norm).collect();
    attempt(scene, &known.y, &flow, &mut ShootingRecord::default())
}

/// `[E97]` Newton's iteration for state and period, with a phase condition (Seydel):
///
/// ```text
/// P(y, T) = y     (1 - M) δ - T f(P) τ = P(y, T) - y     f₀ · δ = 0     τ = δT/T
/// ```
///
/// f is the rate of the state, f₀ that of the first guess without velocities. Every shift in time of a cycle is a cycle; the last
/// equation selects one, and the matrix is regular although `1 - M` maps f to zero.
fn attempt(
    scene: &mut PeriodicScene,
    from: &[f64],
    flow: &[f64],
    search: &mut ShootingRecord,
) -> std::result::Result<Cycle, StepError> {
    let n = from.len();
    let mut y = from.to_vec();
    fill(scene, &mut y);
    let mut march = scene.map(scene.dae(), &y)?;
    let direction: Vec<f64> = flow.iter().copied().chain([0.0]).collect();
    let mut steps = FullSteps::new();
    for _ in 0..ITERATIONS {
        let here = pass(scene, &mut march, &y)?;
        search.periods += 1;
        if here.size < REST * smallest(scene) {
            return Err(lost("Newton's iteration ends at rest".into()));
        }
        let by_period: Vec<f64> = here.rates.iter().map(|rate| rate * scene.drive.period).collect();
        let right: Vec<f64> = here.open.iter().map(|x| x / here.size).chain([0.0]).collect();
        let border = Border {
            by_coordinate: &by_period,
            size: here.size,
            direction: &direction,
        };
        let step = border.solve(scene, &mut march, &right)?;
        search.newton_steps += 1;
        let part = (LONGEST / step[n].abs()).min(1.0);
        let change: Vec<f64> = step[..n].iter().map(|x| part * x * here.size).collect();
        let correction = scene.size(&change, &y).max(step[n].abs() / scene.rtol);
        let convergence = steps.judge(correction);
        match convergence {
            Convergence::Found => {
                let residual = scene.size(&here.open, &y);
                return finish(scene, march, y, search, [correction, residual]);
            }
            Convergence::Lost => break,
            Convergence::Near | Convergence::Far => {}
        }
        y.iter_mut().zip(&change).for_each(|(y, change)| *y += change);
        let factor = 1.0 + part * step[n];
        scene.drive.period *= factor;
        if let Convergence::Near = convergence {
            search.work += march.work();
            march = scene.map(march.into_dae(), &y)?;
        } else {
            march.replace(scene.dae(), factor);
        }
    }
    Err(lost("Newton's iteration for state and period did not converge".into()))
}

/// State of the case, in the scales of the scene, once its signals are constant and a large part of its time has passed.
fn transient(case: &Case, scene: &PeriodicScene) -> Result<Vec<f64>> {
    let system = system(case)?;
    let mut constant = 0.0_f64;
    system
        .model
        .each_signal(|signal| constant = constant.max(settles_at(signal)));
    let mut run = case.clone();
    let instant = constant.max(TRANSIENT * case.time.end_s);
    // the only checkpoint before the end
    run.time.end_s = instant / TRANSIENT;
    run.time.checkpoint_interval_s = Some(instant);
    let mut recorder = FirstCheckpoint {
        stop: scene.stop.clone(),
        y: None,
    };
    let outcome = dynamics::run_with(&run, system.clone(), &[], &mut recorder)?;
    let energies = &outcome.summary.balances.energy_j;
    let lost = |name: &str| name.starts_with("dissipated") || name == "harvested";
    let lost = energies.iter().filter(|(name, _)| lost(name)).map(|(_, x)| x.abs());
    if recorder.y.is_some() && lost.fold(0.0, f64::max) == 0.0 {
        return Err(Error::Usage(format!(
            "{} has no period: nothing drives it periodically, and nothing dissipates energy, so a free motion of any amplitude \
             goes on. Use a periodic signal, add damping, or compute the frequencies by `slcbeam modes`",
            case.name
        )));
    }
    let reached = recorder.y.and_then(|y| scene.convert(&system, &y));
    reached.ok_or_else(|| match outcome.fault {
        Some(fault) => Error::Solver(Box::new(fault)),
        None => Error::Interrupted(outcome.summary.reason.unwrap_or_default()),
    })
}

/// Ends a run at its first checkpoint and stores the unknowns there.
struct FirstCheckpoint {
    stop: StopFlag,
    y: Option<Vec<f64>>,
}

impl Recorder for FirstCheckpoint {
    fn examines_waves(&self) -> bool {
        false
    }
    fn progress(&mut self, _: &Progress) -> Result<Control> {
        Ok(match self.y.is_some() || self.stop.raised() {
            true => Control::Stop(crate::run::stop::INTERRUPTED.into()),
            false => Control::Continue,
        })
    }

    fn checkpoint(&mut self, checkpoint: &Checkpoint) -> Result<()> {
        self.y = Some(checkpoint.y.clone());
        Ok(())
    }
}

/// Follows the motion for a time [s].
fn observe(scene: &PeriodicScene, y: &[f64], time: f64) -> std::result::Result<Motion, StepError> {
    let mut ranges = Ranges::new(y);
    let mut fastest = (0.0, y.to_vec(), vec![0.0; y.len()]);
    scene.follow(y, time, &mut |_, y, yp| {
        ranges.add(y);
        let flow = section(scene, yp);
        let speed = dot(&flow, &flow).sqrt();
        if speed > fastest.0 {
            fastest = (speed, y.to_vec(), flow);
        }
        true
    })?;
    let mut half = ranges.half();
    let l = &scene.system.layout;
    let moved = l.lines.iter().flat_map(LineLayout::unknowns);
    let amplitude = moved.map(|(_, u, _)| half[u] * l.scales[u]).fold(0.0, f64::max);
    scene.admit(&mut half);
    let (speed, y, flow) = fastest;
    Ok(Motion {
        y,
        flow: flow.iter().map(|f| f / speed.max(f64::MIN_POSITIVE)).collect(),
        amplitude,
        size: dot(&half, &half).sqrt() / smallest(scene),
    })
}

/// Time [s] after which the motion passes again, near the state and in the same sense, the plane across the flow there. `None`
/// if it does not do so within `most` [s].
fn returns(scene: &PeriodicScene, motion: &Motion, most: f64) -> std::result::Result<Option<f64>, StepError> {
    let mut before = (0.0, 0.0, vec![0.0; motion.y.len()]);
    let (mut farthest, mut found) = (0.0_f64, None);
    scene.follow(&motion.y, most, &mut |t, y, _| {
        let change: Vec<f64> = y.iter().zip(&motion.y).map(|(y, from)| y - from).collect();
        let change = section(scene, &change);
        let ahead = dot(&motion.flow, &change);
        farthest = farthest.max(dot(&change, &change).sqrt());
        if before.1 < 0.0 && ahead >= 0.0 {
            let share = -before.1 / (ahead - before.1);
            let between = |(a, b): (&f64, &f64)| a + share * (b - a);
            let there: Vec<f64> = before.2.iter().zip(&change).map(between).collect();
            if dot(&there, &there).sqrt() <= RETURN * farthest {
                found = Some(before.0 + share * (t - before.0));
            }
        }
        before = (t, ahead, change);
        found.is_none()
    })?;
    Ok(found)
}

/// Change of the differential unknowns without velocities, which fast waves dominate.
fn section(scene: &PeriodicScene, change: &[f64]) -> Vec<f64> {
    let mut kept = change.to_vec();
    scene.admit(&mut kept);
    let velocities = scene.system.layout.lines.iter().flat_map(LineLayout::unknowns);
    velocities.filter_map(|(.., v)| v).for_each(|v| kept[v] = 0.0);
    kept
}

/// Error of a motion that decays.
fn rest(case: &Case, amplitude: f64) -> Error {
    none(case, amplitude, "the motion comes to rest")
}

/// Error of a case without self-oscillation, with the modes about its equilibrium.
fn none(case: &Case, amplitude: f64, reason: &str) -> Error {
    let plan = ModeOptions {
        count: MODES,
        near_hz: 0.0,
        limits: false,
    };
    let at = case.time.end_s;
    let found = modes::at_equilibrium(case, at).and_then(|about| modes::compute(about, &plan));
    let slowest = found.ok().and_then(|found| {
        let modes = found.modes.iter().filter(|mode| !mode.kind.stays());
        let slowest = modes.max_by(|a, b| a.s.re.total_cmp(&b.s.re))?;
        Some((found.modes.len(), slowest.s))
    });
    let cause = slowest.map(|(count, s)| {
        let verb = if s.re > 0.0 { "grows" } else { "decays" };
        format!(
            "of the {count} slowest modes about the equilibrium, the least damped, at {:.4} Hz, {verb} at {:.4} /s",
            s.im.abs() / TAU,
            s.re.abs()
        )
    });
    let hint = match slowest {
        Some((_, s)) if s.re > 0.0 => {
            "a longer /time/end_s, a larger displacement in /start, or a tighter /solver/rtol".into()
        }
        _ => format!(
            "a longer /time/end_s or a larger /start may reach a self-oscillation; `slcbeam modes --at {at}` lists the modes"
        ),
    };
    Error::Solver(Box::new(SolverError {
        code: Code::NoCycle,
        at: StopPoint::Time(0.0),
        what: format!(
            "no self-oscillation was found: nothing drives {} periodically, and {reason}{}",
            case.name,
            match amplitude > 0.0 {
                true => format!(". Amplitude at the end: {}", quantity(amplitude, "m", 3)),
                // of a network beside a beam at rest
                false => String::new(),
            }
        ),
        unknown: None,
        cause,
        hint: Some(hint),
    }))
}
