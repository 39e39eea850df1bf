//! Problems with a known solution.

use super::figure::ExactFigure;
use crate::error::{Result, usage};

/// Function that computes the figures of a row.
type Work = Box<dyn Fn() -> Result<Vec<ExactFigure>> + Send + Sync>;

/// Problem with a known solution.
pub struct SolvedProblem {
    /// Name, lower case with dashes: `tip-load-5`.
    pub name: String,
    /// Source of the solution.
    pub source: &'static str,
    /// Property that it verifies.
    pub goal: &'static str,
    /// Reason for the tolerance.
    pub reason: &'static str,
    work: Work,
}

impl SolvedProblem {
    /// Creates a row from its name, its source, goal and reason for the tolerance, and the function that computes it.
    pub fn new(
        name: impl Into<String>,
        [source, goal, reason]: [&'static str; 3],
        work: impl Fn() -> Result<Vec<ExactFigure>> + Send + Sync + 'static,
    ) -> Self {
        Self {
            name: name.into(),
            source,
            goal,
            reason,
            work: Box::new(work),
        }
    }

    /// Computes the row's figures.
    ///
    /// # Errors
    /// One of its runs fails.
    pub fn figures(&self) -> Result<Vec<ExactFigure>> {
        (self.work)()
    }
}

/// Returns the rows whose name contains `part`.
///
/// # Errors
/// [`Error::Usage`] with the nearest name if there is none.
pub fn choose(rows: Vec<SolvedProblem>, part: &str) -> Result<Vec<SolvedProblem>> {
    let names: Vec<String> = rows.iter().map(|row| row.name.clone()).collect();
    let chosen: Vec<SolvedProblem> = rows.into_iter().filter(|row| row.name.contains(part)).collect();
    if !chosen.is_empty() {
        return Ok(chosen);
    }
    let likeness = |name: &String| strsim::jaro_winkler(&part.to_lowercase(), name);
    let nearest = names
        .iter()
        .max_by(|a, b| likeness(a).total_cmp(&likeness(b)))
        .map_or("", String::as_str);
    usage(format!(
        "no exact result has \"{part}\" in its name; the nearest is \"{nearest}\"\nall: {}",
        names.join(", ")
    ))
}
