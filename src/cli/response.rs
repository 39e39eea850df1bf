//! `slcbeam response`: the frequency response of small motions.

use std::process::ExitCode;

use clap::Args;

use super::arguments::{CaseArguments, ResultArguments, UncertainArguments};
use super::uncertain::{self, Uncertain};
use super::{cycle_response, resources, response_shapes, terminal};
use crate::case::parameter::Parameter;
use crate::case::{Case, inherited};
use crate::discrete::ledger::EnergyRate;
use crate::error::numbers::{error_percent, significant};
use crate::error::{Code, Result, usage};
use crate::output::kind::FolderKind;
use crate::output::response as files;
use crate::results;
use crate::results::ordered::Ordered;
use crate::results::response::{
    LinearisedState, OutputDerivatives, PeakDerivatives, PowerCurve, ResponseCurve, ResponseDerivatives, ResponsePeak,
    ResponsePole, ResponseRecord, ResponseValue, ValueDerivatives,
};
use crate::run::control_loop;
use crate::run::response::power::MeanPowers;
use crate::study::analysis::{AnalysisKind, ResponseAnalysis};
use crate::study::response::derivatives::{ResponseSensitivity, at_frequencies, differentiate};
use crate::study::response::power::powers;
use crate::study::response::{self, BandResponse, Request, cautions, respond};

/// `response`.
#[derive(Debug, Args)]
pub struct ResponseArguments {
    /// The case.
    #[command(flatten)]
    pub case: CaseArguments,
    /// Input: the JSON pointer of a signal of the case, such as /ends/root/clamped/u1_m or /network/ports/0/pressure_pa
    #[arg(long, value_name = "POINTER")]
    pub input: String,
    /// Output: a quantity or a probe, such as tip_u1; repeatable
    #[arg(long, value_name = "NAME", required = true, value_delimiter = ',')]
    pub output: Vec<String>,
    /// First frequency [Hz]
    #[arg(long, value_name = "HZ", default_value_t = DEFAULT_BAND[0], allow_negative_numbers = true, value_parser = crate::cli::progress_line::frequency)]
    pub from: f64,
    /// Last frequency [Hz]
    #[arg(long, value_name = "HZ", default_value_t = DEFAULT_BAND[1], allow_negative_numbers = true, value_parser = crate::cli::progress_line::frequency)]
    pub to: f64,
    /// Frequencies at least; more are added beside poles and where the response changes
    #[arg(long, value_name = "COUNT", default_value_t = 200, value_parser = crate::cli::progress_line::count)]
    pub points: usize,
    /// About the equilibrium under the loads at this instant [s] [default: about the start]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = crate::cli::progress_line::instant)]
    pub at: Option<f64>,
    /// Frequency [Hz] at which the response is printed, besides the peaks; repeatable
    #[arg(long, value_name = "HZ", value_delimiter = ',', allow_negative_numbers = true, value_parser = crate::cli::progress_line::frequency)]
    pub frequency: Vec<f64>,
    /// Differentiate peaks and printed values with respect to a number of the case, repeatable: its JSON pointer
    #[arg(long, value_name = "POINTER")]
    pub sensitivity: Vec<String>,
    /// Also compute mean powers over a cycle: put in, harvested by turbines, and lost, per squared input
    #[arg(long)]
    pub power: bool,
    /// Uncertain numbers.
    #[command(flatten)]
    pub uncertain: UncertainArguments,
    /// About the steady cycle of a case that loads, end motions or valves vary periodically
    #[arg(long, conflicts_with_all = ["at", "frequency", "sensitivity", "power", "uncertain"])]
    pub about_cycle: bool,
    /// Largest harmonic K: outputs at the input frequency plus -K to K times that of the cycle; 0: direct transmission only
    #[arg(long, value_name = "K", default_value_t = 1, requires = "about_cycle", value_parser = crate::cli::progress_line::count)]
    pub harmonics: usize,
    /// Folder, time limit and output.
    #[command(flatten)]
    pub result: ResultArguments,
    /// Print response.json instead of the table
    #[arg(long)]
    pub json: bool,
}

/// First and last frequency [Hz] of a response if none are given.
pub const DEFAULT_BAND: [f64; 2] = [1.0, 200.0];
/// Median error of a response above which a warning is issued.
const LARGE: f64 = 0.05;
/// Largest number of frequencies.
const MOST: usize = 100_000;

/// Computes the response, writes the folder, prints the peaks.
pub fn response(asked: &ResponseArguments) -> Result<ExitCode> {
    let request = request(asked)?;
    if asked.about_cycle {
        return cycle_response::response(asked, request);
    }
    let frequencies = each_frequency(&asked.frequency)?;
    let case = resources::load(&asked.case)?;
    let parameters = Parameter::find_all(&case, &asked.sensitivity)?;
    let uncertain = uncertain(asked, &request, &frequencies, &case)?;
    // an input or output that does not exist is reported before a folder is created
    let linear = request.compute(&case)?;
    let mut folder = asked.result.place.claim(&case, FolderKind::Response)?;
    asked.result.wall.flag();
    if !asked.result.quiet {
        terminal::print_line(&format!("response of {}", case.name));
    }
    let found = respond(&case, &request, linear)?;
    let mut answer = answer(&case.name, &request, &found)?;
    add_values(&mut answer, &case, request.at, &found, (&frequencies, &parameters))?;
    answer.shapes = response_shapes::shapes(&found, &frequencies)?;
    if asked.power {
        let powers = powers(&found.response, &found.frequencies)?;
        answer.powers = power_curves(&powers);
        answer.warnings.extend(open_balance(&powers, &found.frequencies));
    }
    let varied = inherited::varied(&case, asked.sensitivity.iter().map(String::as_str));
    answer.warnings.extend(varied);
    let written = files::write(&mut folder, &answer);
    let uncertainty = uncertain::compute(uncertain.as_ref(), Some(&folder))?;
    let written = uncertain::complete(uncertainty.as_ref(), (&folder, &case), written, &[]);
    let (text, words) = (
        || results::text(&answer),
        || files::describe(&answer) + &uncertain::below(uncertainty.as_ref()),
    );
    super::print_result(asked.json, folder.dir(), written, text, words)
}

/// The request of `--uncertain`, whose figures are those of [`ResponseAnalysis`].
fn uncertain(
    asked: &ResponseArguments,
    request: &Request,
    frequencies: &[f64],
    case: &Case,
) -> Result<Option<Uncertain>> {
    let alone = "--uncertain applies to peaks about the start in a band: it cannot be combined with --at, or with one \
                 frequency as the band";
    let single = asked.from == asked.to;
    asked.uncertain.refuse(asked.at.is_some() || single, alone)?;
    let what = AnalysisKind::Response(ResponseAnalysis {
        input: request.input.clone(),
        outputs: request.outputs.clone(),
        band: request.band,
        frequencies: frequencies.to_vec(),
    });
    asked.uncertain.begin(&asked.case, case, what, asked.result.quiet)
}

/// Checks first and last frequency [Hz], whose order is `ordered` if the first is `relation` the second, and the number of samples.
pub fn check_band([from, to]: [f64; 2], points: usize, ordered: bool, relation: &str) -> Result<()> {
    if !(from > 0.0 && ordered && to.is_finite()) {
        return usage(format!(
            "--from {from} --to {to}: expected two frequencies [Hz], the first above 0 and {relation} the second"
        ));
    }
    if !(2..=MOST).contains(&points) {
        return usage(format!("--points {points}: expected 2 to {MOST} frequencies"));
    }
    Ok(())
}

/// Values without repetitions.
pub fn each_once<T: Clone + PartialEq>(values: &[T]) -> Vec<T> {
    let mut all: Vec<T> = vec![];
    for value in values {
        if !all.contains(value) {
            all.push(value.clone());
        }
    }
    all
}

/// Checks frequencies of `--frequency` [Hz], and returns each once.
pub fn each_frequency(frequencies: &[f64]) -> Result<Vec<f64>> {
    match frequencies.iter().find(|hz| !(**hz > 0.0 && hz.is_finite())) {
        Some(hz) => usage(format!("--frequency {hz}: expected a frequency above 0 Hz")),
        None => Ok(each_once(frequencies)),
    }
}

fn request(asked: &ResponseArguments) -> Result<Request> {
    let band = [asked.from, asked.to];
    check_band(band, asked.points, asked.from <= asked.to, "not above")?;
    Ok(Request {
        input: asked.input.clone(),
        outputs: each_once(&asked.output),
        at: asked.at,
        band,
        points: asked.points,
    })
}

fn answer(case: &str, request: &Request, found: &BandResponse) -> Result<ResponseRecord> {
    let mut curves = found.curves.iter().map(curve);
    let Some(first) = curves.next() else {
        return usage("--output: expected at least one");
    };
    let about = &found.response.about;
    let unknown = found.unknown.iter();
    let unknown = unknown.map(|why| Code::ErrorEstimate.warning(format!("not known: {why}")));
    let mut warnings = cautions(found.growing, about.moving());
    warnings.extend(control_loop::held(about.system()));
    warnings.extend(about.range.iter().cloned().chain(unknown));
    let mut answer = ResponseRecord {
        case: case.into(),
        input: found.response.input.clone(),
        state: match request.at {
            Some(_) => LinearisedState::Equilibrium,
            None => LinearisedState::Start,
        },
        cycle: None,
        at_s: about.at,
        unknowns: about.y.len(),
        frequency_hz: found.frequencies.clone(),
        first,
        further: curves.collect(),
        poles: found.poles.iter().map(pole).collect(),
        shapes: None,
        powers: vec![],
        sensitivities: Ordered::default(),
        warnings,
    };
    answer.warnings.extend(coarse(&answer));
    Ok(answer)
}

/// Warnings of outputs with a large error.
pub fn coarse(answer: &ResponseRecord) -> Vec<String> {
    let cause = match answer.cycle {
        Some(_) => "mesh and steps",
        None => "the mesh",
    };
    let warning = |curve: &ResponseCurve| {
        let [median, _] = curve
            .errors(&answer.frequency_hz)
            .filter(|[median, _]| *median > LARGE)?;
        Some(Code::ErrorEstimate.warning(format!(
            "error of {} by {cause}: {} in the median over frequencies. Use a finer mesh (/mesh/cells_per_segment, /mesh/cells_per_bladder) or a lower --to.",
            curve.output,
            error_percent(median)
        )))
    };
    answer.curves().filter_map(warning).collect()
}

fn curve(curve: &response::OutputResponse) -> ResponseCurve {
    let peak = |peak: &response::BandPeak| ResponsePeak {
        frequency_hz: peak.frequency_hz,
        amplitude: peak.value.norm(),
        phase_deg: peak.value.arg().to_degrees(),
        damping_ratio: peak.damping_ratio(),
    };
    ResponseCurve {
        output: curve.output.key(),
        unit: curve.output.unit.into(),
        real: curve.values.iter().map(|value| value.re).collect(),
        imag: curve.values.iter().map(|value| value.im).collect(),
        error: curve.errors.clone(),
        peaks: curve.peaks.iter().map(peak).collect(),
        at: vec![],
        sidebands: vec![],
    }
}

fn pole(pole: &response::BandPole) -> ResponsePole {
    ResponsePole {
        re: pole.s.re,
        im: pole.s.im,
        frequency_hz: pole.s.im / std::f64::consts::TAU,
        damping_ratio: -pole.s.re / pole.s.norm(),
    }
}

/// Kinds of mean power besides that put in.
const POWERS: [(&str, EnergyRate); 7] = [
    ("harvested", EnergyRate::Turbines),
    ("dissipated_bladders", EnergyRate::Bladders),
    ("dissipated_tubes", EnergyRate::Tubes),
    ("dissipated_rectifiers", EnergyRate::Rectifiers),
    ("dissipated_damping", EnergyRate::Damping),
    ("added_by_formulation", EnergyRate::Formulation),
    ("added_by_coupling", EnergyRate::Reciprocity),
];
/// Power, relative to the largest, that is a rounding error.
const NOTHING: f64 = 1e-12;

/// Residual of the balance of mean powers, relative to the largest at a frequency, above which a warning is issued.
const OPEN: f64 = 0.01;

/// Warning that mean powers do not add up.
fn open_balance(all: &[MeanPowers], frequencies: &[f64]) -> Option<String> {
    let share = |powers: &MeanPowers| {
        let parts = POWERS.iter().map(|(_, rate)| powers.power(*rate).abs());
        powers.residual().abs() / parts.fold(powers.input().abs(), f64::max)
    };
    let shares = all.iter().map(share).zip(frequencies);
    let (worst, hz) = shares
        .filter(|(share, _)| *share > OPEN)
        .max_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(Code::EnergyFigure.warning(format!(
        "mean powers do not add up: {} of the largest is missing at {} Hz. Without losses they are rounding errors; beside a kink of a law, \
         as of a sharp check valve, use slcbeam periodic",
        error_percent(worst),
        significant(*hz, 4)
    )))
}

/// Curves of the mean powers that are not zero.
fn power_curves(all: &[MeanPowers]) -> Vec<PowerCurve> {
    let curve = |power: &str, of: &dyn Fn(&MeanPowers) -> f64| PowerCurve {
        power: power.into(),
        mean_w: all.iter().map(of).collect(),
    };
    let further = POWERS.map(|(power, rate)| curve(power, &move |powers| powers.power(rate)));
    let mut curves: Vec<PowerCurve> = [curve("input", &MeanPowers::input)]
        .into_iter()
        .chain(further)
        .collect();
    let size = |curve: &PowerCurve| curve.mean_w.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let largest = curves.iter().map(size).fold(0.0, f64::max);
    curves.retain(|curve| curve.power == "input" || size(curve) > NOTHING * largest);
    curves
}

/// Adds the response at requested frequencies, and derivatives by numbers of the case.
fn add_values(
    answer: &mut ResponseRecord,
    case: &Case,
    at: Option<f64>,
    found: &BandResponse,
    (frequencies, parameters): (&[f64], &[Parameter]),
) -> Result<()> {
    let jets = at_frequencies(&found.response, frequencies, &[])?;
    let value = |place: usize| {
        let all = frequencies.iter().zip(&jets);
        all.map(move |(hz, jets)| (*hz, jets[place].value)).collect::<Vec<_>>()
    };
    let values: Vec<_> = (0..found.curves.len()).map(value).collect();
    let curves = std::iter::once(&mut answer.first).chain(&mut answer.further);
    for (curve, values) in curves.zip(&values) {
        let at = values.iter().map(|(frequency_hz, value)| ResponseValue {
            frequency_hz: *frequency_hz,
            real: value.re,
            imag: value.im,
            amplitude: value.norm(),
            phase_deg: value.arg().to_degrees(),
        });
        curve.at = at.collect();
    }
    let slopes = differentiate(case, at, found, frequencies, parameters)?;
    let of = |slopes: &ResponseSensitivity| {
        let output = |(place, curve): (usize, &response::OutputResponse)| {
            let known = |x: f64| Some(x).filter(|x| x.is_finite());
            let peaks = slopes.peaks[place].iter().map(|peak| PeakDerivatives {
                frequency_hz: known(peak.frequency_hz),
                amplitude: known(peak.amplitude),
                damping_ratio: peak.damping_ratio.and_then(known),
            });
            let at = slopes.values[place]
                .iter()
                .zip(&values[place])
                .map(|(slope, (_, value))| {
                    let relative = slope / value;
                    ValueDerivatives {
                        real: slope.re,
                        imag: slope.im,
                        amplitude: known(relative.re * value.norm()),
                        phase_deg: known(relative.im.to_degrees()),
                    }
                });
            let derivatives = OutputDerivatives {
                peaks: peaks.collect(),
                at: at.collect(),
            };
            (curve.output.key(), derivatives)
        };
        let derivatives = ResponseDerivatives {
            value: slopes.parameter.value,
            outputs: found.curves.iter().enumerate().map(output).collect(),
        };
        (slopes.parameter.pointer.clone(), derivatives)
    };
    answer.sensitivities = slopes.iter().map(of).collect();
    Ok(())
}
