//! `slcbeam response`: the frequency response of small motions.

use std::process::ExitCode;

use clap::Args;

use super::arguments::{CaseArguments, ResultArguments};
use super::{cycle_response, resources, terminal};
use crate::error::numbers::{counted, error_percent};
use crate::error::{Code, Error, Result};
use crate::output::kind::FolderKind;
use crate::output::report;
use crate::output::response as files;
use crate::results;
use crate::results::response::{LinearisedState, ResponseCurve, ResponsePeak, ResponsePole, ResponseRecord};
use crate::study::response::{self, BandResponse, Request, respond};

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
    #[arg(long, value_name = "HZ", default_value_t = 1.0, allow_negative_numbers = true, value_parser = crate::cli::progress_line::frequency)]
    pub from: f64,
    /// Last frequency [Hz]
    #[arg(long, value_name = "HZ", default_value_t = 200.0, allow_negative_numbers = true, value_parser = crate::cli::progress_line::frequency)]
    pub to: f64,
    /// Frequencies at least; more are added beside poles and where the response changes
    #[arg(long, value_name = "COUNT", default_value_t = 200, value_parser = crate::cli::progress_line::count)]
    pub points: usize,
    /// About the equilibrium under the loads at this instant [s] [default: about the start]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = crate::cli::progress_line::instant)]
    pub at: Option<f64>,
    /// About the steady cycle of a case that loads, end motions or valves vary periodically
    #[arg(long, conflicts_with = "at")]
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
    let case = resources::load(&asked.case)?;
    // an input or output that does not exist is reported before a folder is created
    let linear = request.compute(&case)?;
    let mut folder = asked.result.place.claim(&case, FolderKind::Response)?;
    asked.result.wall.flag();
    if !asked.result.quiet {
        terminal::print_line(&format!("response of {}", case.name));
    }
    let found = respond(&case, &request, linear)?;
    let answer = answer(&case.name, &request, &found)?;
    let written = files::write(&mut folder, &answer).map(|_| ());
    let written = written.and(report::complete(&folder, &case));
    super::print_result(
        asked.json,
        folder.dir(),
        written,
        || results::text(&answer),
        || files::describe(&answer),
    )?;
    Ok(ExitCode::SUCCESS)
}

/// Checks first and last frequency [Hz], whose order is `ordered` if the first is `relation` the second, and the number of samples.
pub fn check_band([from, to]: [f64; 2], points: usize, ordered: bool, relation: &str) -> Result<()> {
    if !(from > 0.0 && ordered && to.is_finite()) {
        return Err(Error::Usage(format!(
            "--from {from} --to {to}: expected two frequencies [Hz], the first above 0 and {relation} the second"
        )));
    }
    if !(2..=MOST).contains(&points) {
        return Err(Error::Usage(format!(
            "--points {points}: expected 2 to {MOST} frequencies"
        )));
    }
    Ok(())
}

fn request(asked: &ResponseArguments) -> Result<Request> {
    let band = [asked.from, asked.to];
    check_band(band, asked.points, asked.from <= asked.to, "not above")?;
    let mut outputs: Vec<String> = vec![];
    for name in &asked.output {
        if !outputs.contains(name) {
            outputs.push(name.clone());
        }
    }
    Ok(Request {
        input: asked.input.clone(),
        outputs,
        at: asked.at,
        band,
        points: asked.points,
    })
}

fn answer(case: &str, request: &Request, found: &BandResponse) -> Result<ResponseRecord> {
    let mut curves = found.curves.iter().map(curve);
    let Some(first) = curves.next() else {
        return Err(Error::Usage("--output: expected at least one".into()));
    };
    let about = &found.response.about;
    let mut warnings = cautions(found.growing, about.moving());
    warnings.extend(about.range.iter().cloned());
    warnings.extend(
        found
            .unknown
            .iter()
            .map(|why| Code::ErrorEstimate.warning(format!("not known: {why}"))),
    );
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
        warnings,
    };
    answer.warnings.extend(coarse(&answer));
    Ok(answer)
}

/// Warnings of outputs with a large error.
pub fn coarse(answer: &ResponseRecord) -> Vec<String> {
    let warning = |curve: &ResponseCurve| {
        let [median, _] = curve
            .errors(&answer.frequency_hz)
            .filter(|[median, _]| *median > LARGE)?;
        Some(Code::ErrorEstimate.warning(format!(
            "error of {} by the mesh: {} in the median over frequencies. Use a finer mesh (/mesh/cells_per_segment, /mesh/cells_per_bladder) or a lower --to.",
            curve.output,
            error_percent(median)
        )))
    };
    answer.curves().filter_map(warning).collect()
}

/// Warnings of a state about which motions do not stay small.
pub fn cautions(growing: usize, moving: bool) -> Vec<String> {
    let mut warnings = vec![];
    if growing > 0 {
        warnings.push(Code::Growth.warning(format!(
            "{} with a positive real part: small motions grow. The response is not that of a steady state",
            counted(growing as u64, "pole")
        )));
    }
    if moving {
        warnings.push(Code::NotAtRest.warning(
            "the state is not an equilibrium: the beam would start to move. Use --at SECONDS for the equilibrium \
             under the loads of an instant.",
        ));
    }
    warnings
}

fn curve(curve: &response::OutputResponse) -> ResponseCurve {
    let peak = |peak: &response::BandPeak| ResponsePeak {
        frequency_hz: peak.frequency_hz,
        amplitude: peak.value.norm(),
        phase_deg: peak.value.arg().to_degrees(),
        damping_ratio: peak.damping_ratio,
    };
    ResponseCurve {
        output: curve.output.key(),
        unit: curve.output.unit.into(),
        real: curve.values.iter().map(|value| value.re).collect(),
        imag: curve.values.iter().map(|value| value.im).collect(),
        error: curve.errors.clone(),
        peaks: curve.peaks.iter().map(peak).collect(),
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
