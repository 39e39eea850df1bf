//! `slcbeam response --about-cycle`: harmonic transfer functions of small motions about a steady cycle.

use std::process::ExitCode;

use nalgebra::Complex;

use super::response::{ResponseArguments, coarse};
use super::{interrupt, progress_line, resources, terminal};
use crate::error::{Code, Result, usage};
use crate::output::kind::FolderKind;
use crate::output::report;
use crate::output::response as files;
use crate::results;
use crate::results::ordered::Ordered;
use crate::results::response::{
    LinearisedState, ResponseCurve, ResponseCycle, ResponsePeak, ResponseRecord, ResponseSideband,
};
use crate::run::floquet::CycleStability;
use crate::study::response::Request;
use crate::study::response::cycle::{CycleBand, CycleRequest, HarmonicCurves};

/// Computes the response, writes the folder, prints peaks and sidebands.
pub fn response(asked: &ResponseArguments, request: Request) -> Result<ExitCode> {
    let request = CycleRequest {
        input: request.input,
        outputs: request.outputs,
        band: request.band,
        points: request.points,
        harmonics: asked.harmonics,
    };
    let case = resources::load(&asked.case)?;
    let stop = asked.result.wall.stop();
    if !asked.result.quiet {
        terminal::print_line(&format!("response of {}", case.name));
    }
    let bar = progress_line::line(asked.result.quiet);
    bar.set_message("searching for the cycle");
    let cycle = interrupt::before_a_cycle(request.find(&case, &stop), &stop)?;
    let mut folder = asked.result.place.claim(&case, FolderKind::Response)?;
    bar.set_message("integrating disturbances over one period");
    let found = interrupt::before_a_cycle(request.respond(&case, cycle, &stop), &stop)?;
    bar.finish_and_clear();
    let answer = answer(&case.name, &found)?;
    let written = files::write(&mut folder, &answer).and(report::complete(&folder, &case));
    let (text, words) = (|| results::text(&answer), || files::describe(&answer));
    super::print_result(asked.json, folder.dir(), written, text, words)
}

fn answer(case: &str, found: &CycleBand) -> Result<ResponseRecord> {
    let mut curves = found.curves.iter().map(curve);
    let Some(first) = curves.next() else {
        return usage("--output: expected at least one");
    };
    let cycle = &found.cycle;
    let mut warnings = cycle.range.clone();
    warnings.extend(cycle.scene.trapped.clone());
    if cycle.floquet.verdict.stability == CycleStability::Unstable {
        warnings.push(Code::Growth.warning(
            "the cycle is unstable: small motions grow. The response is not that of a steady state; see slcbeam floquet",
        ));
    }
    let unknown = found.unknown.iter();
    warnings.extend(unknown.map(|why| Code::ErrorEstimate.warning(format!("not known: {why}"))));
    let mut answer = ResponseRecord {
        case: case.into(),
        input: cycle.input.clone(),
        state: LinearisedState::Cycle,
        cycle: Some(ResponseCycle {
            period_s: cycle.period(),
            steps: found.steps,
            residual: found.residual,
            largest_multiplier: cycle.floquet.multipliers.first().map(|one| one.modulus),
        }),
        at_s: 0.0,
        unknowns: cycle.scene.system.layout.len,
        frequency_hz: found.frequencies.clone(),
        first,
        further: curves.collect(),
        poles: vec![],
        shapes: None,
        powers: vec![],
        sensitivities: Ordered::default(),
        warnings,
    };
    answer.warnings.extend(coarse(&answer));
    Ok(answer)
}

fn curve(curve: &HarmonicCurves) -> ResponseCurve {
    let parts = |values: &[Complex<f64>]| {
        let real = values.iter().map(|z| z.re).collect::<Vec<f64>>();
        [real, values.iter().map(|z| z.im).collect()]
    };
    let errors = |k: usize| curve.errors.get(k).cloned().unwrap_or_default();
    let middle = curve.values.len() / 2;
    let sideband = |k: usize| {
        let [real, imag] = parts(&curve.values[k]);
        ResponseSideband {
            harmonic: k as i32 - middle as i32,
            real,
            imag,
            error: errors(k),
        }
    };
    let peak = |(frequency_hz, value): &(f64, Complex<f64>)| ResponsePeak {
        frequency_hz: *frequency_hz,
        amplitude: value.norm(),
        phase_deg: value.arg().to_degrees(),
        damping_ratio: None,
    };
    let [real, imag] = parts(&curve.values[middle]);
    ResponseCurve {
        output: curve.output.key(),
        unit: curve.output.unit.into(),
        real,
        imag,
        error: errors(middle),
        peaks: curve.peaks.iter().map(peak).collect(),
        at: vec![],
        sidebands: (0..curve.values.len()).filter(|k| *k != middle).map(sideband).collect(),
    }
}
