//! `slcbeam sense`: loads from measured pressures, with bands; observability of loads; choice of the pressures to measure.

use std::process::ExitCode;

use super::arguments::{SenseArguments, parse_all};
use super::{interrupt, progress_line, resources};
use crate::error::{Result, usage};
use crate::output::folder::CASE;
use crate::output::kind::FolderKind;
use crate::output::{report, sense as files};
use crate::results;
use crate::study::sense::basis::{Basis, amplitudes};
use crate::study::sense::choose::Criterion;
use crate::study::sense::estimate::Smoothing;
use crate::study::sense::estimate_at_rest::{SenseOptions, TimeDependentOptions, find};
use crate::study::sense::pressures::PressureTable;
use crate::study::sense::pressures_at_rest::probed;
use crate::study::sweep::plan::quoted;

/// Reads the measurements, estimates the loads, writes the folder, prints the table.
pub fn sense(asked: &SenseArguments) -> Result<ExitCode> {
    let case = &resources::load(&asked.case)?;
    let question = question(asked, case.time.end_s)?;
    amplitudes(case, &question.loads)?;
    probed(case)?;
    let measured = asked.pressures.as_ref().map(|path| PressureTable::read(path, case));
    let measured = measured.transpose()?;
    if question.noise_pa.is_some() && measured.as_ref().is_some_and(|one| one.deviations.is_some()) {
        let what = "--noise: the measurements contain columns with the standard deviation of each pressure; leave out \
                    one of the two";
        return usage(what);
    }
    let mut folder = asked.result.place.claim(case, FolderKind::Sense)?;
    let bar = progress_line::line(asked.result.quiet);
    bar.set_message("searching for the loads");
    bar.tick();
    let flag = asked.result.wall.flag();
    let found = find(case, measured.as_ref(), &question, &|| interrupt::raised(&flag));
    bar.finish_and_clear();
    let mut found = found?;
    found.command = again(asked);
    found.data = asked.pressures.as_ref().map(|path| path.display().to_string());
    if let Some(measured) = &measured {
        found.left_alone.clone_from(&measured.left_alone);
    }
    let written = files::write(&mut folder, &found).and(report::complete(&folder, case));
    let (text, words) = (|| results::text(&found), || files::describe(&found));
    super::print_result(asked.json, folder.dir(), written, text, words)
}

/// Command that repeats the search inside the folder of the result.
fn again(asked: &SenseArguments) -> String {
    let data = asked.pressures.as_ref().map(|path| {
        let whole = std::fs::canonicalize(path).unwrap_or_else(|_| path.clone());
        whole.display().to_string()
    });
    let option = |name: &str, value: Option<String>| value.map(|value| format!("--{name}={value}"));
    let words = [CASE.to_owned()].into_iter().chain(data);
    let words = words.chain(asked.loads.iter().filter_map(|load| option("load", Some(load.clone()))));
    let words = words.chain(
        [
            option("noise", asked.noise.map(|noise| noise.to_string())),
            option("smoothing", asked.smoothing.clone()),
            asked.dynamic.then(|| "--dynamic".into()),
            option("knots", asked.knots.map(|knots| knots.to_string())),
            option("at", asked.at.map(|at| at.to_string())),
            option("choose", asked.choose.clone()),
        ]
        .into_iter()
        .flatten(),
    );
    words.fold("slcbeam sense".into(), |text, word| text + " " + &quoted(&word))
}

fn question(asked: &SenseArguments, end_s: f64) -> Result<SenseOptions> {
    if let Some(noise) = asked.noise.filter(|noise| !(1e-6..=1e9).contains(noise)) {
        return usage(format!(
            "--noise {noise}: expected a standard deviation in Pa, from 1e-6 to 1e9"
        ));
    }
    let at_s = asked.at.unwrap_or(end_s);
    if !at_s.is_finite() {
        return usage(format!("--at {at_s}: an instant in seconds"));
    }
    let smoothing = match asked.smoothing.as_deref().unwrap_or("likelihood") {
        "likelihood" => Smoothing::Likelihood,
        "discrepancy" => Smoothing::Discrepancy,
        "off" => Smoothing::Off,
        other => match other.parse::<f64>() {
            Ok(deviation) if deviation.is_finite() && deviation > 0.0 => Smoothing::Fixed(deviation),
            _ => {
                let wanted = "likelihood, discrepancy, off, or a standard deviation in N/m above 0";
                return usage(format!("--smoothing {other}: {wanted}"));
            }
        },
    };
    // without measurements, the pressures to measure are chosen
    let by = asked
        .choose
        .as_deref()
        .or(asked.pressures.is_none().then_some("variances"));
    let loads: Vec<Basis> = parse_all(&asked.loads, Basis::parse)?;
    let profile = loads.iter().any(|load| matches!(load, Basis::Profile(_)));
    if let (Smoothing::Fixed(deviation), true) = (smoothing, asked.dynamic) {
        return usage(format!(
            "--smoothing {deviation}: a number applies to a profile at rest only; with --dynamic, use likelihood, \
             discrepancy or off"
        ));
    }
    if let Some(how) = asked.smoothing.as_ref().filter(|_| !profile && !asked.dynamic) {
        return usage(format!(
            "--smoothing {how}: smoothing applies to a profile or to a load over time, and neither is requested. \
             Request one (--load profile:10, --dynamic), or leave --smoothing out"
        ));
    }
    Ok(SenseOptions {
        loads,
        noise_pa: asked.noise,
        smoothing,
        at_s,
        dynamic: asked.dynamic.then(|| TimeDependentOptions {
            knots: asked.knots.map(usize::from),
        }),
        choose: by.map(|by| match by {
            "volume" => Criterion::Volume,
            _ => Criterion::Variances,
        }),
    })
}
