//! Figures by name, as in the table of `slcbeam sweep`.

use crate::case::nearest_figure;
use crate::error::{Error, Result};
use crate::study::analysis::AnalysisKind;

/// Figures that the bare name of a quantity may refer to, in order of priority.
const MEANT: [&str; 7] = [
    "mean",
    "max_abs",
    "final",
    "frequency_hz",
    "window_max_abs",
    "window",
    "window_rms",
];
/// Largest number of names listed in a message.
const LISTED: usize = 24;

/// Returns the figure that a text names: by its full name, or the main figure of a quantity.
///
/// # Errors
/// [`Error::Usage`] with the nearest name if there is no such figure.
pub fn resolve(option: &str, text: &str, what: &AnalysisKind, names: &[String]) -> Result<String> {
    let text = text.trim();
    let meant = MEANT.iter().map(|figure| format!("{text}.{figure}"));
    let mut asked = std::iter::once(text.to_owned()).chain(meant);
    if let Some(found) = asked.find(|asked| names.contains(asked)) {
        return Ok(found);
    }
    let quantity = |name: &String| name.rsplit_once('.').map_or(name.as_str(), |(own, _)| own).to_owned();
    let mut quantities: Vec<String> = names.iter().map(quantity).collect();
    quantities.dedup();
    let all = names.iter().chain(&quantities).map(String::as_str);
    let own: Vec<&str> = names
        .iter()
        .map(String::as_str)
        .filter(|name| name.starts_with(&format!("{text}.")))
        .collect();
    let hint = match nearest_figure(text, all) {
        Some(_) if !own.is_empty() => {
            let more = if own.len() > LISTED { ", .." } else { "" };
            format!("its figures are {}{more}", own[..own.len().min(LISTED)].join(", "))
        }
        Some(meant) => format!("nearest is {meant}"),
        None => {
            let more = if quantities.len() > LISTED { ", .." } else { "" };
            quantities.truncate(LISTED);
            format!("there are {}{more}", quantities.join(", "))
        }
    };
    let elsewhere = match what {
        AnalysisKind::Run if text.starts_with("mode_") => "; `--command modes` computes figures of modes",
        AnalysisKind::Run if text.ends_with(".mean") => "; `--command periodic` computes means over a steady cycle",
        _ => "",
    };
    Err(Error::Usage(format!(
        "{option} {text}: `{}` computes no such figure; {hint}{elsewhere}",
        what.word()
    )))
}
