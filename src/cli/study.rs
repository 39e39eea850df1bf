//! `slcbeam study`: cost of accuracy.

use std::process::ExitCode;
use std::sync::Mutex;
use std::time::Duration;

use super::arguments::StudyArguments;
use super::progress_line::ProgressLine;
use super::{interrupt, journal, resources, terminal};
use crate::discrete::System;
use crate::error::{Error, Result};
use crate::integrate::halt;
use crate::numerics::threads;
use crate::output::kind::FolderKind;
use crate::output::numbers::{counted, duration};
use crate::output::report;
use crate::output::study as files;
use crate::study::accuracy::trial::RunPurpose;
use crate::study::accuracy::{Budget, Scheme, StudyEvent, StudyPlan, study as run_study};
use crate::study::evaluations::Evaluations;

/// Runs the settings, writes the folder, prints the table and the sentence.
pub fn study(asked: &StudyArguments) -> Result<ExitCode> {
    let case = &resources::load(&asked.case)?;
    System::new(case)?;
    let plan = StudyPlan {
        rtols: asked.rtol.clone(),
        cells: asked.cells.clone(),
        schemes: Scheme::list(&asked.methods, &asked.orders)?,
        repeats: asked.repeats,
        budget: Budget::Wall(seconds(&asked.budget)?),
        parallel: asked.parallel,
    }
    .checked()?;
    let mut folder = asked.result.place.claim(case, FolderKind::Study)?;
    let evaluations = Evaluations::default();
    journal::begin(&evaluations, &folder, ("study", case, &format!("{plan:?}")))?;
    let flag = asked.result.wall.flag();
    let progress = Progress::new(asked.result.quiet);
    // a started run reacts late to a stop request: the program ends in time without it, and resumes from its journal
    let found = halt::heard().during(|| {
        run_study(case, plan, asked.measure.as_deref(), &evaluations, &|event| {
            progress.show(event);
        })
    });
    drop(progress);
    let stopped = interrupt::raised(&flag);
    let found = journal::outcome(found, &folder, stopped)?;
    let written = files::write(&mut folder, &found).and(report::complete(&folder, case));
    let written = journal::end(&evaluations, &folder, stopped, written);
    let words = || {
        let notes: String = found.notes.iter().map(|n| format!("note: {n}\n")).collect();
        format!("{}\n{notes}{}\n", files::table(&found), files::sentence(&found))
    };
    super::print_result(asked.json, folder.dir(), written, || files::json(&found), words)?;
    Ok(ExitCode::from(if found.references.is_empty() { 4 } else { 0 }))
}

/// Converts `120`, `120s`, `2m` or `1h` to seconds.
pub fn seconds(text: &str) -> Result<f64> {
    let (number, unit) = match text.trim().strip_suffix(['s', 'm', 'h']) {
        Some(number) => (number, text.trim().chars().last()),
        None => (text.trim(), None),
    };
    let factor = match unit {
        Some('m') => 60.0,
        Some('h') => 3600.0,
        _ => 1.0,
    };
    let value = number
        .trim()
        .parse::<f64>()
        .ok()
        .map(|n| n * factor)
        .filter(|s| s.is_finite() && *s > 0.0);
    value.ok_or_else(|| {
        Error::Usage(format!(
            "--budget {text}: expected a time above zero, such as 120s or 2m"
        ))
    })
}

/// A bar on a terminal, a line per mesh and method elsewhere.
struct Progress {
    shown: ProgressLine,
    last: Mutex<Option<(usize, Scheme, RunPurpose)>>,
}

impl Progress {
    fn new(quiet: bool) -> Self {
        let shown = ProgressLine::new(quiet, "{pos}/{len} {wide_bar:.blue/dim} {msg}");
        if let Some(bar) = &shown.bar
            && threads::granted()
        {
            bar.enable_steady_tick(Duration::from_millis(200));
        }
        let last = Mutex::new(None);
        Self { shown, last }
    }

    fn show(&self, event: &StudyEvent) {
        let s = event.setting;
        let what = match event.role {
            RunPurpose::Point => "",
            RunPurpose::Reference => "reference, ",
        };
        let expected = event
            .expected
            .map_or(String::new(), |cost| format!(", about {}", duration(cost)));
        let spent = format!("{} of {} used", duration(event.spent), duration(event.budget.size()));
        if let Some(bar) = &self.shown.bar {
            bar.set_length(event.of as u64);
            bar.set_position(event.done as u64);
            bar.set_message(format!(
                "{what}{}, {}, rtol {:e}{expected} · {spent}",
                counted(s.cells as u64, "cell"),
                s.scheme,
                s.rtol
            ));
        } else if self.shown.lines {
            let now = Some((s.cells, s.scheme, event.role));
            let mut last = self.last.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            if *last != now {
                *last = now;
                let (done, of) = (event.done, event.of);
                terminal::print_line(&format!(
                    "{done}/{of}: {what}{}, {}{expected} each or more; {spent}",
                    counted(s.cells as u64, "cell"),
                    s.scheme
                ));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn budgets_are_times() {
        assert_eq!(seconds("120s").ok(), Some(120.0));
        assert_eq!(seconds("2m").ok(), Some(120.0));
        assert_eq!(seconds("90").ok(), Some(90.0));
        assert_eq!(seconds("0.5h").ok(), Some(1800.0));
        for wrong in ["", "s", "-3s", "2 days", "nan"] {
            assert_eq!(seconds(wrong).map_err(|e| e.exit_code()), Err(2), "{wrong}");
        }
    }
}
