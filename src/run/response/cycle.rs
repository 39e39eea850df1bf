//! Harmonic transfer functions of a steady cycle: small motions about a state that changes periodically.

use std::f64::consts::TAU;

use nalgebra::Complex;

use super::instant::Instant;
use super::{columns, find_each, marked};
use crate::case::{self, Case};
use crate::dae::BeamDae;
use crate::discrete::System;
use crate::error::{Error, Result};
use crate::functions::Signal;
use crate::integrate::{StartOptions, consistent_start};
use crate::numerics::krylov;
use crate::numerics::shifted::ShiftedSolver;
use crate::onestep::StepMap;
use crate::onestep::forced::MarchStage;
use crate::onestep::step_map::StepError;
use crate::run::drive::{comes_to_rest, drive, settled, settled_opening};
use crate::run::floquet::{self, Floquet};
use crate::run::periodic::scene::{fault, whole};
use crate::run::periodic::{PeriodicScene, ShootingRecord, shoot};
use crate::run::record::HistoryColumn;
use crate::run::stop::{INTERRUPTED, StopFlag};

/// Number of multipliers of a cycle.
const MULTIPLIERS: usize = 6;
/// Relative residual of the linear equations.
const LINEAR: f64 = 1e-11;
/// Relative residual above which a frequency counts as a pole.
const POLE: f64 = 1e-6;
/// Largest number of Newton steps on other steps than those of the search.
const CORRECTIONS: usize = 5;
/// Relative residual of their linear equations, and largest number of disturbances propagated in each.
const CORRECTION: (f64, usize) = (1e-3, 300);

/// A steady cycle with an input and outputs.
pub struct DrivenCycle {
    /// JSON pointer of the input.
    pub input: String,
    /// Outputs, in the order of their columns.
    pub outputs: Vec<HistoryColumn>,
    /// Periodic scene.
    pub scene: PeriodicScene,
    /// Search for the cycle.
    pub search: ShootingRecord,
    /// Multipliers of the cycle.
    pub floquet: Floquet,
    /// Warnings of states outside the range of the model.
    pub range: Vec<String>,
    /// Steps of the search [s].
    times: Vec<f64>,
    y: Vec<f64>,
    places: Vec<usize>,
    signal: Signal,
    chosen: Vec<usize>,
}

impl DrivenCycle {
    /// Finds the cycle of a case, or its state at rest if only its equations vary periodically.
    ///
    /// # Errors
    /// [`Error::Usage`] for an input or an output that the case does not have; those of [`PeriodicScene::new`] and [`shoot`].
    pub fn find(case: &Case, input: &str, outputs: &[String], stop: &StopFlag) -> Result<Self> {
        System::new(case)?;
        let (case, input) = marked(case, input)?;
        let mark = case::controls(&case)
            .into_iter()
            .find(|(pointer, ..)| *pointer == input);
        let mark = mark.map(|(.., signal)| signal.clone()).unwrap_or(Signal::Constant(0.0));
        let mut model = whole(&case)?;
        if comes_to_rest(&model) {
            let what =
                "nothing in the case varies periodically. Without this option the response is that about the start";
            return Err(Error::Usage(format!("--about-cycle: {what}")));
        }
        let drive = drive(&case, &model, None)?;
        // the product distinguishes the input from signals with the same values
        let product = |signal: Signal| Signal::Product(vec![signal, Signal::Constant(1.0)]);
        let opens = input.contains("/opening");
        let signal = product(if opens { settled_opening(&mark) } else { settled(&mark) });
        model.replace_signals(
            |one| if *one == mark { signal.clone() } else { settled(one) },
            |one| {
                if *one == mark {
                    signal.clone()
                } else {
                    settled_opening(one)
                }
            },
        );
        let mut scene = PeriodicScene::with_model(&case, model, drive)?.heeding(stop);
        let places = scene.system.places_of(&signal);
        if places.is_empty() {
            return Err(Error::Usage(format!(
                "--input {input}: nothing in the scene depends on it"
            )));
        }
        let columns = columns(&scene.system);
        let chosen = find_each(&columns, outputs)?;
        scene.held(&case.name)?;
        let mut cycle = shoot(&scene, None).map_err(fault)?;
        Ok(Self {
            input,
            outputs: chosen.iter().map(|&place| columns[place].clone()).collect(),
            floquet: floquet::multipliers(&scene, &mut cycle, MULTIPLIERS),
            range: cycle.range(&case, &scene),
            search: cycle.search,
            times: cycle.march.times().to_vec(),
            y: cycle.y,
            scene,
            places,
            signal,
            chosen,
        })
    }

    /// Period [s].
    pub fn period(&self) -> f64 {
        self.scene.drive.period
    }

    /// Linearization along the steps of the search, divided into steps of at most `longest` [s] each, and these into `parts`.
    ///
    /// # Errors
    /// The cycle cannot be followed on these steps.
    pub fn linearize(&self, longest: f64, parts: usize) -> Result<CycleResponse> {
        let mut times = vec![self.times[0]];
        for pair in self.times.windows(2) {
            let count = parts * (((pair[1] - pair[0]) / longest).ceil() as usize).max(1);
            let length = (pair[1] - pair[0]) / count as f64;
            times.extend((1..count).map(|k| pair[0] + k as f64 * length));
            times.push(pair[1]);
        }
        let scene = &self.scene;
        let march = StepMap::new(scene.dae(), scene.method, times);
        let mut march = march.map_err(|error| {
            let what = format!(
                "{}, or a lower --to or fewer --harmonics, which need fewer steps",
                error.what
            );
            fault(StepError { what, ..error })
        })?;
        let [y, yp] = self.close(&mut march).map_err(fault)?;
        let mut dae = scene.dae();
        let mut instant = Instant::new(&mut dae, self.places.clone(), self.signal.clone(), self.opens());
        let mut stages = vec![];
        let mut read = |stage: MarchStage, state: [&[f64]; 2]| {
            if scene.stop.raised() {
                return Err(StepError::new(stage.time, INTERRUPTED));
            }
            instant.approach(stage.cj);
            instant.enter(stage.time, state);
            stages.push(StageLinearization {
                time: stage.time,
                weight: stage.weight,
                forcing: instant.derivatives_of_residual().map(|f| sparse(&f)),
                direct: instant.derivatives_of_outputs(&self.chosen),
                of_state: instant
                    .rows(&self.chosen)
                    .iter()
                    .map(|both| both.each_ref().map(|row| sparse(row)))
                    .collect(),
            });
            Ok(())
        };
        march.each_stage([&y, &yp], &mut read).map_err(fault)?;
        Ok(CycleResponse {
            march,
            stages,
            solver: ShiftedSolver::default(),
            period: self.period(),
            unknowns: y.len(),
            dimension: scene.dimension() + scene.conserved.len(),
        })
    }

    fn opens(&self) -> bool {
        self.input.contains("/opening")
    }

    /// Corrects the cycle on the steps of a march, to the tolerance of the scene. Returns its first state and rates.
    fn close(&self, march: &mut StepMap<BeamDae>) -> std::result::Result<[Vec<f64>; 2], StepError> {
        let (scene, mut y) = (&self.scene, self.y.clone());
        for correction in 0.. {
            let (mut begin, mut end, mut yp) = (y.clone(), y.clone(), vec![0.0; y.len()]);
            march.go(&mut end, &mut yp, &mut |_, _, _| {})?;
            let mut open: Vec<f64> = end.iter().zip(&y).map(|(end, y)| end - y).collect();
            scene.admit(&mut open);
            if scene.size(&open, &y) <= 1.0 || correction == CORRECTIONS {
                let mut dae = scene.dae();
                let options = StartOptions::default();
                consistent_start(&mut dae, 0.0, &mut begin, &mut yp, &options)
                    .map_err(|failure| StepError::new(0.0, failure.to_string()))?;
                return Ok([begin, yp]);
            }
            let (tolerance, most) = CORRECTION;
            let map = |v: &mut [f64]| {
                march.propagate(v);
                scene.admit(v);
            };
            let (step, _) = krylov::solve(map, &open, tolerance, most.min(scene.dimension()));
            y.iter_mut().zip(&step).for_each(|(y, step)| *y += step);
        }
        Err(StepError::new(0.0, "no cycle"))
    }
}

/// Entries that are not zero, with their indices.
type SparseVector = Vec<(usize, f64)>;

fn sparse(values: &[f64]) -> SparseVector {
    let entries = values.iter().copied().enumerate();
    entries.filter(|(_, value)| *value != 0.0).collect()
}

/// Derivatives at one stage.
struct StageLinearization {
    time: f64,
    weight: f64,
    /// Of the residual by the input and its first two rates.
    forcing: [SparseVector; 3],
    /// Of each output by unknowns and rates.
    of_state: Vec<[SparseVector; 2]>,
    /// Of each output by the input and its first two rates.
    direct: Vec<[f64; 3]>,
}

/// Linearization of a cycle with an input and outputs.
pub struct CycleResponse {
    march: StepMap<BeamDae>,
    stages: Vec<StageLinearization>,
    solver: ShiftedSolver,
    period: f64,
    /// Unknowns, and those with rates.
    unknowns: usize,
    dimension: usize,
}

/// Harmonic transfer functions at one frequency.
pub struct HarmonicResponse {
    /// `H_k` of each output, k from -K to K, in its unit over that of the input.
    pub values: Vec<Vec<Complex<f64>>>,
    /// Relative residual of the equations for the state at the start.
    pub residual: f64,
}

impl CycleResponse {
    /// Number of steps.
    pub fn steps(&self) -> usize {
        self.march.times().len() - 1
    }

    /// `[E99]` Harmonic transfer functions at a frequency [Hz], for harmonics -K to K. The input u = exp(s t), s = i ω, causes a small
    /// motion x about the cycle that is exp(s t) times a function of its period T:
    ///
    /// ```text
    /// F_y x + F_y' x' = -(f_0 + s f_1 + s² f_2) exp(s t)      f_k = ∂F/∂u^(k)      x(T) = exp(s T) x(0)
    /// (exp(s T) - M) x(0) = g      z = C x + D x' + (d_0 + s d_1 + s² d_2) exp(s t)      Ω = 2π/T
    /// H_k(ω) = 1/T ∫ z exp(-i (ω + k Ω) t) dt over a period
    /// ```
    ///
    /// The output is Σ H_k exp(i (ω + k Ω) t). M is the derivative of the period map, g the motion at T from rest. Stages of the
    /// method give the integral to its order.
    ///
    /// # Errors
    /// The frequency is a pole.
    pub fn at(&mut self, hz: f64, harmonics: usize) -> Result<HarmonicResponse> {
        let (w, period) = (TAU * hz, self.period);
        let s = Complex::new(0.0, w);
        let turn = |angle: f64| Complex::from_polar(1.0, angle);
        let n = self.unknowns;
        let stages = &self.stages;
        let powers = [Complex::new(1.0, 0.0), s, s * s];
        let mut force = |slot: usize, out: &mut [Complex<f64>]| {
            let stage = &stages[slot];
            let now = turn(w * stage.time);
            for (forcing, power) in stage.forcing.iter().zip(powers) {
                forcing.iter().for_each(|(row, f)| out[*row] += power * now * *f);
            }
        };
        let mut from_rest = vec![Complex::new(0.0, 0.0); n];
        self.march.force_along(&mut from_rest, &mut force, &mut |_, _| {});
        let march = &mut self.march;
        let (mut x, residual) = self.solver.solve(
            &mut |v| march.propagate(v),
            turn(w * period),
            &from_rest,
            LINEAR,
            self.dimension,
        );
        if !(residual <= POLE && x.iter().all(|x| x.is_finite())) {
            let what = format!("no response at {hz} Hz: the residual of its equations is {residual:.1e}");
            return Err(fault(StepError::new(0.0, what)));
        }
        let mut values = vec![vec![Complex::new(0.0, 0.0); 2 * harmonics + 1]; stages[0].direct.len()];
        let mut look = |slot: usize, [x, rates]: [&[Complex<f64>]; 2]| {
            let stage = &stages[slot];
            let now = turn(w * stage.time);
            for ((all, [c, d]), direct) in values.iter_mut().zip(&stage.of_state).zip(&stage.direct) {
                let sum =
                    |row: &SparseVector, x: &[Complex<f64>]| row.iter().map(|(k, c)| x[*k] * *c).sum::<Complex<f64>>();
                let of_input: Complex<f64> = direct.iter().zip(powers).map(|(d, power)| power * *d).sum();
                let z = sum(c, x) + sum(d, rates) + now * of_input;
                for (k, value) in all.iter_mut().enumerate() {
                    let order = k as f64 - harmonics as f64;
                    *value += z * turn(-(w + order * TAU / period) * stage.time) * (stage.weight / period);
                }
            }
        };
        march.force_along(&mut x, &mut force, &mut look);
        Ok(HarmonicResponse { values, residual })
    }
}
