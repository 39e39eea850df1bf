//! Figures by name, as the table of `slcbeam sweep` has them.

use crate::case::nearest;
use crate::error::{Error, Result};
use crate::study::analysis::AnalysisKind;

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

/// The figure that a text means: one by its whole name, or the foremost of a quantity.
///
/// # Errors
/// [`Error::Usage`] with the nearest where there is none of that name.
pub fn resolve(option: &str, text: &str, what: AnalysisKind, names: &[String]) -> Result<String> {
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
