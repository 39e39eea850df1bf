//! Figures by name, as the table of `slcbeam sweep` has them.

use crate::case::{Case, nearest};
use crate::discrete::System;
use crate::discrete::quantities::{Interest, Source, probes};
use crate::error::{Error, Result};
use crate::run::equilibrium;
use crate::study::sweep::What;
use crate::study::sweep::compute::MODES;
use crate::study::sweep::power::POWERS;

/// Which figure of a quantity is meant where none is named, the first that there is.
const MEANT: [&str; 7] = [
    "mean",
    "max_abs",
    "final",
    "frequency_hz",
    "window_max_abs",
    "window",
    "window_rms",
];
/// Names listed in a message at most.
const LISTED: usize = 24;

/// Figures of a case by a command.
///
/// # Errors
/// Those of [`System::new`].
pub fn names(case: &Case, what: What) -> Result<Vec<String>> {
    let of = |all: &mut Vec<String>, names: &[&str], quantity: &str| {
        all.extend(names.iter().map(|name| format!("{quantity}.{name}")));
    };
    let mut all = vec![];
    match what {
        What::Equilibrium => {
            let columns = equilibrium::columns(&equilibrium::system(case, case.time.end_s)?);
            all.extend(
                columns
                    .iter()
                    .map(|column| column.key())
                    .filter(|key| key != "load_factor"),
            );
        }
        What::Modes => {
            for k in 1..=MODES {
                let figures = ["frequency_hz", "growth_per_s", "damping_ratio"];
                of(&mut all, &figures, &format!("mode_{k}"));
            }
        }
        What::Floquet => all.push("growth_per_s".into()),
        What::Run | What::Periodic => {
            let system = System::new(case)?;
            let network = system.model.wet.as_ref().map(|wet| &wet.network);
            let turbines = network.is_some_and(|network| !network.turbines.is_empty());
            let cycle = what == What::Periodic;
            let motion: &[&str] = match cycle {
                true => &["window_max_abs", "window_rms"],
                false => &["max_abs", "final", "window_max_abs", "window_rms"],
            };
            for one in Interest::of([network.is_some(), turbines]) {
                let figures = match one.source() {
                    Source::Motion(_) => motion,
                    _ if cycle => &["window"],
                    _ => &["final", "window"],
                };
                of(&mut all, figures, one.name());
            }
            if cycle {
                all.extend(POWERS[usize::from(!turbines)..].iter().map(|(_, name)| (*name).into()));
            }
            for probe in probes::columns(&system) {
                of(&mut all, motion, &probes::key(&probe.name, probe.unit));
            }
        }
    }
    Ok(all)
}

/// The figure that a text means: one by its whole name, or the foremost of a quantity.
///
/// # Errors
/// [`Error::Usage`] with the nearest where there is none of that name.
pub fn resolve(option: &str, text: &str, what: What, names: &[String]) -> Result<String> {
    let text = text.trim();
    let meant = MEANT.iter().map(|figure| format!("{text}.{figure}"));
    let mut asked = std::iter::once(text.to_owned()).chain(meant);
    if let Some(found) = asked.find(|asked| names.contains(asked)) {
        return Ok(found);
    }
    let quantity = |name: &String| name.split('.').next().unwrap_or_default().to_owned();
    let mut quantities: Vec<String> = names.iter().map(quantity).collect();
    quantities.dedup();
    let all = names.iter().chain(&quantities).map(String::as_str);
    let told = match nearest(text, all) {
        Some(meant) => format!("nearest is {meant}"),
        None => {
            let more = if quantities.len() > LISTED { ", .." } else { "" };
            quantities.truncate(LISTED);
            format!("there are {}{more}", quantities.join(", "))
        }
    };
    Err(Error::Usage(format!(
        "{option} {text}: `{}` tells no such figure; {told}",
        what.word()
    )))
}
