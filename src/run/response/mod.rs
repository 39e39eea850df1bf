//! Frequency response of small motions about a state.
//!
//! `[E81]` About a state at rest the equations F(y, y', u, u', u'') = 0 with an input u are linear. Let A = F_y, B = F_y', and let an
//! output be z = C y + D y' + .. of the same state. With everything proportional to exp(s t), s = i ω:
//!
//! ```text
//! (A + s B) x = -(f_0 + s f_1 + s² f_2)        f_k = ∂F/∂u^(k)
//! H(s) = z/u  = (C + s D) x + d_0 + s d_1 + s² d_2
//! ```
//!
//! One complex factorization serves all outputs at a frequency. Rates of u appear if an input moves an end, since the displacements
//! of the beam are relative to it.

pub mod cycle;
mod instant;
pub mod power;
mod scaled_model;
pub mod self_test;
pub mod sensitivity;
mod shapes;
pub mod state_space;
pub mod stepwise;

use std::collections::BTreeSet;

use nalgebra::Complex;

use self::instant::Instant;
use self::sensitivity::{forced, output};
use crate::case::schema::{Choice, Effect, Effects};
use crate::case::{self, Case};
use crate::discrete::System;
use crate::discrete::quantities::{Group, Observable, probes, stations};
use crate::error::numbers::counted;
use crate::error::{Code, Error, Result, SolverError, StopPoint};
use crate::functions::Signal;
use crate::integrate::halt;
use crate::model::effects::EffectSet;
use crate::model::{Model, ResolvedNetwork};
use crate::run::modes::{Linearised, at_equilibrium, linearise};
use crate::run::record::HistoryColumn;
use crate::spectral::{Factors, SpectralError};

/// A scaled linear response from one input to outputs.
pub struct LinearResponse {
    /// The linearization.
    pub about: Linearised,
    /// True if unsteady friction of tubes was added for the response.
    pub remembers: bool,
    /// JSON pointer of the input.
    pub input: String,
    /// Outputs, in the order of their columns.
    pub outputs: Vec<HistoryColumn>,
    /// Value of the input.
    pub u0: f64,
    /// Values of the outputs.
    pub z0: Vec<f64>,
    /// Indices of the input in the system.
    places: Vec<usize>,
    /// `f_k`, one entry for each row.
    forcing: [Vec<f64>; 3],
    /// Rows of C and D, one entry for each unknown.
    of_state: Vec<[Vec<f64>; 2]>,
    /// `d_k` of each output.
    direct: Vec<[f64; 3]>,
}

impl LinearResponse {
    /// Linearizes a case about its start, or about the equilibrium under the loads at an instant [s].
    ///
    /// # Errors
    /// [`Error::Usage`] for an input or an output that the case does not have; those of [`linearise`].
    pub fn new(case: &Case, input: &str, outputs: &[String], at: Option<f64>) -> Result<Self> {
        let found = Endpoints::new(case, input, outputs)?;
        let mut about = match at {
            Some(at) => at_equilibrium(&found.case, at)?,
            None => linearise(&found.case, 0.0, None)?,
        };
        let Endpoints {
            remembers,
            input,
            signal,
            places,
            outputs: (chosen, outputs),
            ..
        } = found;
        let value = signal.jet(about.clock()).value;
        let mut instant = Instant::at_rest(&mut about, places.clone(), value, input.contains("/opening"));
        let forcing = instant.derivatives_of_residual();
        let direct = instant.derivatives_of_outputs(&chosen);
        let of_state = instant.rows(&chosen);
        let all = instant.outputs();
        let z0 = chosen.iter().map(|&place| all[place]).collect();
        Ok(Self {
            about,
            remembers,
            input,
            u0: value,
            z0,
            places,
            outputs,
            forcing,
            of_state,
            direct,
        })
    }

    /// Highest derivative of the input in the equations and outputs, the input of a state-space model: 0, 1 or 2.
    pub fn input_rate(&self) -> usize {
        let acts = |k: &usize| self.forcing[*k].iter().any(|f| *f != 0.0) || self.direct.iter().any(|d| d[*k] != 0.0);
        [2, 1].into_iter().find(acts).unwrap_or(0)
    }

    /// Error without a state-space model.
    pub fn no_model(&self, why: &str) -> Error {
        self.failure(format!("no state-space model: {why}"))
    }

    /// Creates the solver for successive frequencies.
    ///
    /// # Errors
    /// The equations cannot be factored.
    pub fn solver(&self) -> Result<Frequencies<'_>> {
        let first = Complex::new(0.0, self.about.frequency());
        let factors = Factors::new(&self.about.pencil(), first).map_err(|failure| self.failed(&failure))?;
        Ok(Frequencies { of: self, factors })
    }

    /// Error of a solution that failed.
    pub fn failed(&self, failure: &SpectralError) -> Error {
        if *failure == SpectralError::Interrupted {
            return Error::Interrupted("interrupted before the response was computed; nothing is written".into());
        }
        self.failure(format!("no response: {failure}"))
    }

    fn failure(&self, what: String) -> Error {
        Error::Solver(Box::new(SolverError {
            code: Code::NoModes,
            at: StopPoint::Time(self.about.at),
            what,
            unknown: None,
            cause: None,
            hint: None,
        }))
    }
}

/// Solver of the response at frequencies.
pub struct Frequencies<'a> {
    of: &'a LinearResponse,
    factors: Factors<'a>,
}

impl Frequencies<'_> {
    /// Transfer functions of all outputs at a frequency [Hz], each in its unit over that of the input.
    ///
    /// # Errors
    /// The frequency is a pole.
    pub fn at(&mut self, hz: f64) -> Result<Vec<Complex<f64>>> {
        let (s, x) = self.state(hz)?;
        let all = self.of.of_state.iter().zip(&self.of.direct);
        Ok(all.map(|(row, direct)| output(row, direct, s, &x)).collect())
    }

    /// `s = i ω` at a frequency [Hz], and the scaled unknowns over the input.
    ///
    /// # Errors
    /// As [`Frequencies::at`].
    pub fn state(&mut self, hz: f64) -> Result<(Complex<f64>, Vec<Complex<f64>>)> {
        let s = Complex::new(0.0, std::f64::consts::TAU * hz);
        let of = self.of;
        if halt::asked() {
            return Err(of.failed(&SpectralError::Interrupted));
        }
        let mut x: Vec<Complex<f64>> = forced(&of.forcing, s).into_iter().map(|f| -f).collect();
        self.factors.solve(s, &mut x).map_err(|failure| of.failed(&failure))?;
        Ok((s, x))
    }
}

/// Outputs of a response by their names.
///
/// # Errors
/// [`Error::Usage`] for an input or an output that the case does not have.
pub fn outputs(case: &Case, input: &str, names: &[String]) -> Result<Vec<HistoryColumn>> {
    Endpoints::new(case, input, names).map(|found| found.outputs.1)
}

/// Outputs that a response of a case can have.
///
/// # Errors
/// Those of [`System::new`].
pub fn all_outputs(case: &Case) -> Result<Vec<HistoryColumn>> {
    let (case, _) = with_memory(case.clone())?;
    let mut all = columns(&System::with(&case, Model::of_modes(&case)?)?);
    all.retain(is_linear);
    Ok(all)
}

/// Input and outputs of a response, in the case that is linearized.
struct Endpoints {
    case: Case,
    remembers: bool,
    input: String,
    signal: Signal,
    /// Indices of the signal in the system.
    places: Vec<usize>,
    /// Indices of the outputs, and their columns.
    outputs: (Vec<usize>, Vec<HistoryColumn>),
}

impl Endpoints {
    fn new(case: &Case, input: &str, outputs: &[String]) -> Result<Self> {
        System::new(case)?;
        let (case, input) = marked(case, input)?;
        let (case, remembers) = with_memory(case)?;
        let mut system = System::with(&case, Model::of_modes(&case)?)?;
        let marks = case::controls(&case);
        let found = marks.iter().find(|(pointer, ..)| *pointer == input);
        let signal = found.map(|(.., signal)| (*signal).clone());
        let places = signal.as_ref().map_or(vec![], |signal| system.places_of(signal));
        let Some(signal) = signal.filter(|_| !places.is_empty()) else {
            return Err(Error::Usage(format!(
                "--input {input}: nothing in the scene depends on it"
            )));
        };
        let columns = columns(&system);
        let chosen = find_each(&columns, outputs)?;
        let outputs = chosen.iter().map(|&place| columns[place].clone()).collect();
        Ok(Self {
            remembers,
            input,
            signal,
            places,
            outputs: (chosen, outputs),
            case,
        })
    }
}

/// Returns the case with an input that differs from all other signals, and its pointer.
fn marked(case: &Case, input: &str) -> Result<(Case, String)> {
    let all = case::controls(case);
    let below = format!("{input}/signal");
    let Some((pointer, _, signal)) = all.iter().find(|(at, ..)| *at == input || *at == below) else {
        let known = || all.iter().map(|(at, ..)| at.as_str());
        let meant = case::nearest(input, known()).map_or_else(String::new, |near| format!("; nearest is {near}"));
        let listed = known().collect::<Vec<_>>().join(", ");
        return Err(Error::Usage(match all.len() {
            0 => format!("--input {input}: the case has no signals. Add a load, a moving end, a port or a valve"),
            _ => format!("--input {input}: the case has no such signal{meant}; its signals are {listed}"),
        }));
    };
    let resolved = serde_json::to_value(case.resolved()).unwrap_or_default();
    let own = serde_json::to_value(signal).unwrap_or_default();
    let set = format!("{pointer}={}", serde_json::json!({"product": [own, 1.0]}));
    let path = &case.source.path;
    let base = path.parent().unwrap_or(path);
    let marked = case::parse(&resolved.to_string(), path, base, &[set])?;
    Ok((marked, pointer.clone()))
}

/// Returns the case with unsteady friction of tubes, and true if it was added. A search for modes omits it unless it is requested by
/// name. A response needs no search among the decays of this friction.
pub fn with_memory(case: Case) -> Result<(Case, bool)> {
    let memory = Effect::UnsteadyFriction;
    let mut choices = case.effects.choices();
    let there = EffectSet::whole(&case, ResolvedNetwork::from_case(&case)?.as_ref()).has(memory);
    if choices.choice(memory) != Choice::Auto || !there {
        return Ok((case, false));
    }
    choices.set(memory, Choice::On);
    let effects = Effects::Chosen(choices);
    Ok((Case { effects, ..case }, true))
}

/// Columns with a response of first order: motion of the tip, pressures, flows, forces, probes.
pub fn columns(system: &System) -> Vec<HistoryColumn> {
    let motion = motion(system).into_iter().map(HistoryColumn::from);
    let [at_rest, moving] = [true, false].map(|at_rest| stations::columns(system, at_rest));
    motion
        .chain(at_rest)
        .chain(probes::columns(system))
        .chain(moving)
        .collect()
}

fn motion(system: &System) -> Vec<Observable> {
    let mut all = Observable::recorded(system);
    all.retain(|one| one.group() == Group::Tip || *one == Observable::PortFlow);
    all
}

/// True if a column has a response of first order.
fn is_linear(column: &HistoryColumn) -> bool {
    // the volume through a port is an integral
    let integral = column.name.starts_with("port_") && column.unit == "m^3";
    !matches!(column.unit, "W" | "J") && !integral
}

/// Indices of outputs by their names, each once: a name with its unit is another spelling of the same output.
fn find_each(columns: &[HistoryColumn], names: &[String]) -> Result<Vec<usize>> {
    let mut chosen = vec![];
    for name in names {
        let place = find(columns, name, "linear output", is_linear)?;
        if !chosen.contains(&place) {
            chosen.push(place);
        }
    }
    Ok(chosen)
}

/// Index of an output of a kind by its name, with or without its unit, among the columns that are of this kind.
///
/// # Errors
/// [`Error::Usage`] for an unknown name.
pub fn find(columns: &[HistoryColumn], name: &str, kind: &str, is_one: fn(&HistoryColumn) -> bool) -> Result<usize> {
    let place = columns.iter().position(|column| {
        let keys = [column.key(), probes::key(&column.name, column.unit)];
        is_one(column) && (column.name == name || keys.iter().any(|key| key == name))
    });
    place.ok_or_else(|| {
        let mut keys: Vec<String> = columns
            .iter()
            .filter(|column| is_one(column))
            .map(HistoryColumn::key)
            .collect();
        keys.sort_by_key(|key| key.starts_with("bladder_"));
        let mut seen = BTreeSet::new();
        keys.retain(|key| seen.insert(key.clone()));
        let meant = case::nearest_figure(name, keys.iter().map(String::as_str));
        let meant = meant.map_or_else(String::new, |near| format!("; nearest is {near}"));
        let more = keys.len().saturating_sub(LISTED);
        keys.truncate(LISTED);
        let more = if more > 0 {
            format!(" and {}", counted(more as u64, "other"))
        } else {
            String::new()
        };
        Error::Usage(format!(
            "--output {name}: the case has no such {kind}{meant}; outputs are {}{more}; probes add others",
            keys.join(", ")
        ))
    })
}

/// Largest number of names in a message.
const LISTED: usize = 24;
