//! What is said in the end.

use std::collections::BTreeMap;

use super::estimates::{At, Way, worst};
use super::search::Search;
use crate::case::schema::Effect;
use crate::discrete::{System, resolution};
use crate::error::Code;
use crate::run::summary::{Accuracy, Estimate, Figures, Judged, Summary};
use crate::study::accuracy::plan;

/// Absolute errors of all figures, or of statistics alone, by estimates relative to the largest figure of each quantity.
fn absolute(summary: &Summary, estimates: &BTreeMap<String, Estimate>, statistics: bool) -> Figures {
    let of = |(name, estimate): (&String, &Estimate)| {
        let quantity = summary.quantities.get(name).or_else(|| summary.ports.get(name))?;
        let error = estimate.total? * quantity.size();
        let judged = |figure: &str| match figure {
            "window_rms" | "window" => true,
            figure => !statistics && figure != "window_power_w",
        };
        let figures = quantity.all_figures().filter(|(figure, _)| judged(figure));
        Some((
            name.clone(),
            figures.map(|(figure, _)| (figure.into(), error)).collect(),
        ))
    };
    estimates.iter().filter_map(of).collect()
}

impl Search<'_> {
    /// Writes into the summary of the result what is known of its errors; `present` is false where candidates have since gained
    /// effects that it has not.
    pub fn conclude(self, at: At, present: bool, cut_short: Option<String>, summary: &mut Summary) {
        let (cells, decades) = at;
        let estimates = if present {
            self.runs.estimates(at)
        } else {
            Default::default()
        };
        let within = worst(&estimates) <= self.asked;
        let unseen = self.unseen(at, present);
        let reached = present && within && unseen.is_empty();
        let mut warn = |what: String| {
            let warning = Code::Accuracy.warning(format!("accuracy: {what}"));
            summary.warnings.push(warning);
        };
        if let Some(reason) = cut_short {
            warn(format!("the search was cut short: {reason}"));
        }
        if !within {
            let short = |(name, e): (&String, &Estimate)| match e.total {
                Some(total) if total > self.asked => Some(format!("{name} {total:.1e}")),
                Some(_) => None,
                None => Some(format!("{name} unknown")),
            };
            let short: Vec<String> = estimates.iter().filter_map(short).collect();
            warn(format!(
                "{:e} is not reached with {cells} cells a segment and rtol 1e-{decades}: {}",
                self.asked,
                short.join(", ")
            ));
        }
        if within {
            unseen.into_iter().for_each(&mut warn);
        }
        if let Some(lost) = &self.runs.lost {
            let grows = summary
                .growth
                .as_ref()
                .map_or(String::new(), |g| format!(" (it grows at {:.2} 1/s)", g.rate_per_s));
            let lost = Code::Accuracy.warning(format!(
                "accuracy: {lost}: the motion{grows} is one of many that start alike, or takes tighter tolerances and meshes than these to be \
                 followed to the end. Judged are root mean squares and increments over the window, not single values"
            ));
            summary.warnings.push(lost);
        }
        let statistics = self.runs.judged_by == Judged::WindowStatistics;
        summary.errors = absolute(summary, &estimates, statistics);
        summary.accuracy = Some(Accuracy {
            asked: self.asked,
            reached,
            cells_per_segment: cells,
            cells_per_bladder: plan::fluid_cells(cells),
            order: self.case.mesh.order(),
            rtol: 10_f64.powi(-decades),
            judged_by: self.runs.judged_by,
            effects: self.effects_in_words(at),
            quantities: estimates,
            pilots: self.pilots,
        });
    }

    /// What nothing is known of, a clause each.
    fn unseen(&self, at: At, present: bool) -> Vec<String> {
        let why = |way: Way| {
            let reason = self.failed.iter().rev().find(|((w, _), _)| *w == way);
            reason.map_or(String::new(), |(_, why)| format!(": {why}"))
        };
        let mut all = vec![];
        if !present {
            let taken = Effect::names(&self.taken_in, ", ");
            all.push(format!(
                "the result leaves out effects that change it by more than may be: {taken}"
            ));
        } else if self.full.is_some() && self.runs.effects(at).is_none() {
            all.push(format!(
                "what the effects that are left out change was not judged{}",
                why(Way::Full)
            ));
        }
        if present && self.runs.method(at).is_none() {
            all.push(format!("no other method was compared{}", why(Way::Method)));
        }
        let system = System::new(&self.case).ok();
        if let Some((port, t)) = system.and_then(|system| resolution::first_jump(&self.case, &system.model)) {
            all.push(format!(
                "the pressure of the port \"{port}\" jumps at t = {t} s, and meshes of few cells a bladder agree about pressures that do not go \
                 beyond it: how far max_pressure_pa does is not judged. Give it the time that it takes, a ramp, or begin with it (/start)"
            ));
        }
        all
    }

    /// What was found of the effects that are left out.
    fn effects_in_words(&self, at: At) -> String {
        let taken = match self.taken_in.as_slice() {
            [] => String::new(),
            all => format!("taken in, for what they change: {}; ", Effect::names(all, ", ")),
        };
        let left = match (&self.full, self.runs.effects(at)) {
            (None, _) => "none left out that is not exact".into(),
            (Some(full), Some((cells, decades))) => format!(
                "left out: {}; judged by a run with them, {cells} cells a segment, rtol 1e-{decades}",
                Effect::names(&full.left_out, ", ")
            ),
            (Some(full), None) => format!("left out: {}; not judged", Effect::names(&full.left_out, ", ")),
        };
        format!("{taken}{left}")
    }
}
