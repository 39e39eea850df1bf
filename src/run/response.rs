//! Frequency response of small motions about a state.
//!
//! `[E81]` About a state at rest the equations F(y, y', u, u', u'') = 0 with an input u are linear. With A = F_y, B = F_y', an output
//! z = C y + D y' + .. of the same state, and everything proportional to exp(s t), s = i ω:
//!
//! ```text
//! (A + s B) x = -(f_0 + s f_1 + s² f_2)        f_k = ∂F/∂u^(k)
//! H(s) = z/u  = (C + s D) x + d_0 + s d_1 + s² d_2
//! ```
//!
//! One complex factorisation serves all outputs at a frequency. The rates of u come in where an input moves an end: the displacements of the
//! beam are those relative to it.

use nalgebra::Complex;

use crate::case::schema::{Choice, Effect, Effects};
use crate::case::{self, Case};
use crate::dae::{BeamDae, Dae as _};
use crate::discrete::System;
use crate::discrete::ledger;
use crate::discrete::quantities::Extremes;
use crate::discrete::quantities::{Group, Look, Observable, Row, probes, stations};
use crate::error::numbers::counted;
use crate::error::{At, Code, Error, Result, SolverError};
use crate::functions::Signal;
use crate::functions::signals::Polynomial;
use crate::model::effects::EffectSet;
use crate::model::{Model, Network};
use crate::run::modes::{Linearised, at_equilibrium, linearise};
use crate::run::record::Column;
use crate::spectral::{Factors, SpectralError};

/// Changes of the scaled residual over which an input is differentiated: the longer one where both agree to [`ALIKE`].
const STEPS: [f64; 2] = [1e-4, 1e-8];
const ALIKE: f64 = 1e-6;
/// Change of a scaled unknown by which outputs are differentiated.
const OF_OUTPUTS: f64 = 1e-5;
/// Change of an opening, which lies between 0 and 1.
const OF_OPENINGS: f64 = 1e-5;

/// A scaled linear response from one input to outputs.
pub struct Response {
    /// The linearisation.
    pub about: Linearised,
    /// JSON pointer of the input.
    pub input: String,
    /// Outputs, in the order of their columns.
    pub outputs: Vec<Column>,
    /// Value of the input.
    pub u0: f64,
    /// Values of the outputs.
    pub z0: Vec<f64>,
    /// `f_k` of the rows.
    pub(super) forcing: [Vec<f64>; 3],
    /// Rows of C and D, one entry an unknown.
    pub(super) of_state: Vec<[Vec<f64>; 2]>,
    /// `d_k` of each output.
    pub(super) direct: Vec<[f64; 3]>,
}

impl Response {
    /// Linearises a case about its start, or about the equilibrium under the loads at an instant [s].
    ///
    /// # Errors
    /// [`Error::Usage`] for an input or an output that the case does not have; those of [`linearise`].
    pub fn new(case: &Case, input: &str, outputs: &[String], at: Option<f64>) -> Result<Self> {
        let (case, input) = marked(case, input)?;
        let mut system = System::with(&case, Model::of_modes(&case)?)?;
        let marks = case::controls(&case);
        let nothing = || Error::Usage(format!("--input {input}: nothing in the scene depends on it"));
        let (.., signal) = marks
            .iter()
            .find(|(pointer, ..)| *pointer == input)
            .ok_or_else(nothing)?;
        let places = system.places_of(signal);
        if places.is_empty() {
            return Err(nothing());
        }
        let mut about = match at {
            Some(at) => at_equilibrium(&case, at)?,
            None => linearise(&case, 0.0, None)?,
        };
        let columns = columns(about.system());
        let chosen = outputs
            .iter()
            .map(|name| find(&columns, name))
            .collect::<Result<Vec<usize>>>()?;
        let value = signal.jet(about.clock()).value;
        let mut instant = Instant::new(&mut about, places, value, input.contains("/opening"));
        let forcing = instant.derivatives_of_residual();
        let direct = instant.derivatives_of_outputs(&chosen);
        let of_state = instant.rows(&chosen);
        let all = instant.outputs();
        let z0 = chosen.iter().map(|&place| all[place]).collect();
        Ok(Self {
            about,
            input,
            u0: value,
            z0,
            outputs: chosen.into_iter().map(|place| columns[place].clone()).collect(),
            forcing,
            of_state,
            direct,
        })
    }

    /// Factors for one frequency after the other.
    ///
    /// # Errors
    /// No factors exist.
    pub fn solver(&self) -> Result<Frequencies<'_>> {
        let first = Complex::new(0.0, self.about.frequency());
        let factors = Factors::new(&self.about.pencil(), first).map_err(|failure| self.failed(&failure))?;
        Ok(Frequencies { of: self, factors })
    }

    fn failed(&self, failure: &SpectralError) -> Error {
        if *failure == SpectralError::Interrupted {
            return Error::Interrupted("interrupted before the response was computed; nothing is written".into());
        }
        Error::Solver(Box::new(SolverError {
            code: Code::NoModes,
            at: At::Time(self.about.at),
            what: format!("no response: {failure}"),
            unknown: None,
            cause: None,
            hint: None,
        }))
    }
}

/// The response at frequencies.
pub struct Frequencies<'a> {
    of: &'a Response,
    factors: Factors<'a>,
}

impl Frequencies<'_> {
    /// Transfer functions of all outputs at a frequency [Hz], each in its unit over that of the input.
    ///
    /// # Errors
    /// The frequency is a pole.
    pub fn at(&mut self, hz: f64) -> Result<Vec<Complex<f64>>> {
        let s = Complex::new(0.0, std::f64::consts::TAU * hz);
        let of = self.of;
        let [f0, f1, f2] = &of.forcing;
        let forcing = f0
            .iter()
            .zip(f1)
            .zip(f2)
            .map(|((f0, f1), f2)| -(s * s * *f2 + s * *f1 + f0));
        let mut x: Vec<Complex<f64>> = forcing.collect();
        self.factors.solve(s, &mut x).map_err(|failure| of.failed(&failure))?;
        let output = |([c, d], direct): (&[Vec<f64>; 2], &[f64; 3])| {
            let of_state: Complex<f64> = x.iter().zip(c.iter().zip(d)).map(|(x, (c, d))| x * (s * *d + c)).sum();
            of_state + s * s * direct[2] + s * direct[1] + direct[0]
        };
        Ok(of.of_state.iter().zip(&of.direct).map(output).collect())
    }
}

/// The case with an input that no other signal is like, and its pointer.
fn marked(case: &Case, input: &str) -> Result<(Case, String)> {
    let all = case::controls(case);
    let below = format!("{input}/signal");
    let Some((pointer, _, signal)) = all.iter().find(|(at, ..)| *at == input || *at == below) else {
        let known = || all.iter().map(|(at, ..)| at.as_str());
        let meant = case::nearest(input, known()).map_or_else(String::new, |near| format!("; nearest is {near}"));
        let listed = known().collect::<Vec<_>>().join(", ");
        return Err(Error::Usage(match all.len() {
            0 => format!("--input {input}: the case has no signals: give a load, a moving end, a port or a valve"),
            _ => format!("--input {input}: the case has no such signal{meant}; its signals are {listed}"),
        }));
    };
    let resolved = serde_json::to_value(case.resolved()).unwrap_or_default();
    let own = serde_json::to_value(signal).unwrap_or_default();
    let set = format!("{pointer}={}", serde_json::json!({"product": [own, 1.0]}));
    let path = &case.source.path;
    let base = path.parent().unwrap_or(path);
    let marked = case::parse(&resolved.to_string(), path, base, &[set])?;
    Ok((with_memory(marked)?, pointer.clone()))
}

/// The case with unsteady friction of tubes, which a search for modes leaves out unless it is named: a response needs no search among the
/// decays of its memory.
fn with_memory(case: Case) -> Result<Case> {
    let memory = Effect::UnsteadyFriction;
    let mut choices = case.effects.choices();
    let there = EffectSet::whole(&case, Network::of(&case)?.as_ref()).has(memory);
    if choices.of(memory) != Choice::Auto || !there {
        return Ok(case);
    }
    choices.set(memory, Choice::On);
    Ok(Case {
        effects: Effects::Chosen(choices),
        ..case
    })
}

/// Everything that has a response of first order: motion of the tip, pressures, flows, forces, probes.
pub fn columns(system: &System) -> Vec<Column> {
    let motion = motion(system).into_iter().map(Column::from);
    let at_rest = stations::columns(system, true).into_iter().map(Column::from);
    let moving = stations::columns(system, false).into_iter().map(Column::from);
    let probes = probes::columns(system).map(Column::from);
    motion.chain(at_rest).chain(probes).chain(moving).collect()
}

fn motion(system: &System) -> Vec<Observable> {
    let mut all = Observable::of(system);
    all.retain(|one| one.group() == Group::Tip || *one == Observable::PortFlow);
    all
}

/// The place of an output by its name, with or without its unit.
fn find(columns: &[Column], name: &str) -> Result<usize> {
    let known = |column: &Column| column.unit != "W" && column.unit != "J";
    let place = columns
        .iter()
        .position(|column| known(column) && (column.name == name || column.key() == name));
    place.ok_or_else(|| {
        let mut keys: Vec<String> = columns.iter().filter(|column| known(column)).map(Column::key).collect();
        keys.dedup();
        let meant = case::nearest(name, keys.iter().map(String::as_str));
        let meant = meant.map_or_else(String::new, |near| format!("; nearest is {near}"));
        let more = keys.len().saturating_sub(LISTED);
        keys.truncate(LISTED);
        let more = if more > 0 {
            format!(" and {}", counted(more as u64, "other"))
        } else {
            String::new()
        };
        Error::Usage(format!(
            "--output {name}: the case has no such linear output{meant}; outputs are {}{more}; probes add others",
            keys.join(", ")
        ))
    })
}

/// Names listed in a message at most.
const LISTED: usize = 24;

/// The state and the signals about it.
struct Instant<'a> {
    dae: &'a mut BeamDae,
    at: f64,
    y: Vec<f64>,
    yp: Vec<f64>,
    places: Vec<usize>,
    /// Value of the input, and the range to which it is limited.
    value: f64,
    opens: bool,
    rows: [Row; 2],
    integrals: Vec<f64>,
}

impl<'a> Instant<'a> {
    fn new(about: &'a mut Linearised, places: Vec<usize>, value: f64, opens: bool) -> Self {
        let dae = &mut about.dae;
        // all signals are held: at 0 a polynomial of the input has its value without rounding
        dae.enter_smooth_interval(0.0);
        let system = dae.system();
        let probed = probes::columns(system).count();
        let rows = [
            Row::new(motion(system), [stations::columns(system, true).len(), probed]),
            Row::new(vec![], [stations::columns(system, false).len(), 0]),
        ];
        Self {
            at: 0.0,
            yp: vec![0.0; about.y.len()],
            y: about.y.clone(),
            integrals: vec![0.0; dae.integrals()],
            dae,
            places,
            value,
            opens,
            rows,
        }
    }

    /// Puts the input at `value + x t^k/k!`.
    fn put(&mut self, k: usize, x: f64) {
        let coefficients = match k {
            0 => vec![self.value + x],
            1 => vec![self.value, x],
            _ => vec![self.value, 0.0, 0.5 * x],
        };
        let places = self.places.clone();
        self.dae
            .put_signal(&places, &Signal::Polynomial(Polynomial { coefficients }));
    }

    fn residual(&mut self) -> Vec<f64> {
        let mut values = vec![0.0; self.y.len()];
        // what cannot be evaluated has no derivative, and the solution is not finite
        if self.dae.residual(self.at, &self.y, &self.yp, &mut values).is_err() {
            values.fill(f64::NAN);
        }
        values
    }

    fn outputs(&mut self) -> Vec<f64> {
        let (system, now, state) = self.dae.evaluate(self.at, &self.y, &self.yp);
        let look = Look {
            system,
            now,
            w: state,
            stored: ledger::energies(system, now, state),
            at: Extremes::of(system, now, &state),
        };
        let [first, second] = &mut self.rows;
        first.take(self.at, &look, &[], 0.0);
        second.take(self.at, &look, &self.integrals, 0.0);
        first.values().iter().chain(second.values()).copied().collect()
    }

    /// Derivatives of `read` by the input and its first two rates.
    fn derivatives(&mut self, read: fn(&mut Self) -> Vec<f64>) -> [Vec<f64>; 3] {
        [0, 1, 2].map(|k| {
            let found = match self.opens {
                true => self.one_sided(k, read),
                false => self.central(k, read),
            };
            self.put(0, 0.0);
            found
        })
    }

    /// Towards the middle of the range of an opening, to second order.
    fn one_sided(&mut self, k: usize, read: fn(&mut Self) -> Vec<f64>) -> Vec<f64> {
        let step = if self.value > 0.5 { -OF_OPENINGS } else { OF_OPENINGS };
        let [none, one, two] = [0.0, step, 2.0 * step].map(|x| {
            self.put(k, x);
            read(self)
        });
        let all = none.iter().zip(&one).zip(&two);
        all.map(|((none, one), two)| (4.0 * one - 3.0 * none - two) / (2.0 * step))
            .collect()
    }

    /// Central differences. A law with a kink in its slope, as of a check valve at rest, has an error of first order in the step, which two
    /// short steps remove.
    fn central(&mut self, k: usize, read: fn(&mut Self) -> Vec<f64>) -> Vec<f64> {
        let change = self.change(k);
        let mut over = |step: f64| -> Vec<f64> {
            let [before, after] = [-step, step].map(|x| {
                self.put(k, x);
                read(self)
            });
            before
                .iter()
                .zip(&after)
                .map(|(before, after)| (after - before) / (2.0 * step))
                .collect()
        };
        if change == 0.0 {
            return over(1.0);
        }
        let [long, short] = STEPS.map(|step| over(step / change));
        let largest = long.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        if long.iter().zip(&short).all(|(a, b)| (a - b).abs() <= ALIKE * largest) {
            return long;
        }
        let half = over(0.5 * STEPS[1] / change);
        half.iter()
            .zip(&short)
            .map(|(half, whole)| 2.0 * half - whole)
            .collect()
    }

    /// Largest change of the scaled residual by a unit of the input, or of a rate of it.
    fn change(&mut self, k: usize) -> f64 {
        let [none, one] = [0.0, 1.0].map(|x| {
            self.put(k, x);
            self.residual()
        });
        none.iter().zip(&one).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()))
    }

    fn derivatives_of_residual(&mut self) -> [Vec<f64>; 3] {
        self.derivatives(Self::residual)
    }

    fn derivatives_of_outputs(&mut self, chosen: &[usize]) -> Vec<[f64; 3]> {
        let all = self.derivatives(Self::outputs);
        chosen
            .iter()
            .map(|&place| [0, 1, 2].map(|k: usize| all[k][place]))
            .collect()
    }

    /// Rows of C and D.
    fn rows(&mut self, chosen: &[usize]) -> Vec<[Vec<f64>; 2]> {
        let n = self.y.len();
        let mut rows = vec![[vec![0.0; n], vec![0.0; n]]; chosen.len()];
        for column in 0..n {
            for rate in [false, true] {
                let mut at = |x: f64| {
                    let state = if rate { &mut self.yp } else { &mut self.y };
                    let own = state[column];
                    state[column] = own + x;
                    let values = self.outputs();
                    let state = if rate { &mut self.yp } else { &mut self.y };
                    state[column] = own;
                    values
                };
                let [before, after] = [-OF_OUTPUTS, OF_OUTPUTS].map(&mut at);
                for (row, &place) in rows.iter_mut().zip(chosen) {
                    row[usize::from(rate)][column] = (after[place] - before[place]) / (2.0 * OF_OUTPUTS);
                }
            }
        }
        rows
    }
}
