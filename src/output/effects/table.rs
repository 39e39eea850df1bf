//! Table of an ablation, for the terminal and as CSV, and its closing sentence.

use std::fmt::Write as _;

use super::ShownQuantity;
use crate::case::schema::Effect;
use crate::output::columns;
use crate::output::numbers::{counted, percent, significant};
use crate::output::records::{self, number};
use crate::study::accuracy::trial::TrialOutcome;
use crate::study::effects::ablation::ComparedRun;
use crate::study::effects::figure_change::ComparedFigures;
use crate::study::effects::{Ablation, AblationRow, EffectVerdict};

const HEADINGS: &str = "<left out | <verdict | change | largest | <in | unknowns | steps | work | time | <decides";

/// Table of the changes of one quantity: one line per effect, the combined choices, and a legend.
pub fn table(found: &Ablation, shown: &ShownQuantity) -> String {
    let full = &found.full;
    let mut text = format!("{}: what each effect does, to {}\n", found.case, shown.describe());
    let Some(_) = &full.summary else {
        let why = full.reason.as_deref().unwrap_or("no reason given");
        let _ = writeln!(text, "\nthe full model did not run to the end: {why}");
        return text;
    };
    let _ = writeln!(
        text,
        "full model: {}, {}, {}, {} s\n",
        counted(full.unknowns as u64, "unknown"),
        counted(full.counters.steps, "step"),
        counted(full.counters.residual_evaluations, "residual"),
        significant(full.wall_s(), 3)
    );
    let mut lines = vec![];
    for row in &found.rows {
        if let Some(compared) = &row.left_out {
            let number = format!("auto {}: {}", if row.auto { "on" } else { "off" }, row.number);
            lines.push(line(found, shown, &name(row), said(row), compared, number));
        }
    }
    lines.extend(beside(found).map(|(name, c)| line(found, shown, name, "", c, String::new())));
    text += &columns::table(HEADINGS, lines);
    text += &legend(found, shown);
    let mut reasons = vec![];
    for row in &found.rows {
        match row.verdict {
            EffectVerdict::Kept | EffectVerdict::Failed => {
                let why = row.reason.as_deref().unwrap_or("no reason given");
                reasons.push(format!("{}: {}: {why}", row.name, said(row)));
            }
            _ if !row.takes.is_empty() => reasons.push(format!(
                "leaving out {} also leaves out {}",
                row.name,
                Effect::names(&row.takes, ", ")
            )),
            _ => {}
        }
    }
    let absent = found.rows.iter().filter(|r| r.verdict == EffectVerdict::Absent);
    let absent: Vec<Effect> = absent.map(|r| r.name).collect();
    if !absent.is_empty() {
        reasons.push(format!("not in the full model: {}", Effect::names(&absent, ", ")));
    }
    if !reasons.is_empty() {
        let _ = writeln!(text, "\n{}", reasons.join("\n"));
    }
    text
}

/// Runs besides those of single effects: the case's own choice, the program's and the recommended one, if they exist.
pub(super) fn beside(found: &Ablation) -> impl Iterator<Item = (&'static str, &ComparedRun)> {
    let recommended = found.recommendation.as_ref().and_then(|r| r.run.as_ref());
    let all = [
        ("as in the case", found.given.as_ref()),
        ("auto", found.auto.as_ref()),
        ("recommended", recommended),
    ];
    all.into_iter().filter_map(|(name, compared)| Some((name, compared?)))
}

fn legend(found: &Ablation, shown: &ShownQuantity) -> String {
    let own = |x: Option<f64>| x.map_or_else(|| "unknown".into(), |x| format!("{x:.1e}"));
    let all = found.measures.iter().filter_map(|m| Some((m.own?, &m.name)));
    let worst = all.max_by(|a, b| a.0.total_cmp(&b.0));
    let mut text = format!(
        "\nchange: relative to the quantity's largest figure; tolerance {:e}; ~ below the integrator's own error, which at rtol {:e}\n\
         is {} of {}",
        found.tolerance,
        found.rtol,
        own(shown.own(found)),
        shown.describe(),
    );
    if let Some((error, name)) = worst {
        let _ = write!(text, ", at most {error:.1e} ({name})");
    }
    text += "\nwork: residual evaluations times unknowns, time: least wall time; both over those of the model compared with\n";
    if found.judged_by == ComparedFigures::WindowStatistics {
        text += "the motion cannot be computed to the end at this tolerance: root mean squares and increments over the window are compared instead\n";
    }
    text
}

fn name(row: &AblationRow) -> String {
    match row.without.as_slice() {
        [] => row.name.to_string(),
        others => format!("{} (both without {})", row.name, Effect::names(others, ", ")),
    }
}

/// Verdict of an effect, or `not run`.
fn said(row: &AblationRow) -> &'static str {
    match &row.left_out {
        Some(c) if c.trial.ending == TrialOutcome::Skipped => "not run",
        _ => word(row.verdict),
    }
}

/// Word for a verdict.
pub fn word(verdict: EffectVerdict) -> &'static str {
    match verdict {
        EffectVerdict::Needed => "needed",
        EffectVerdict::Harmless => "harmless",
        EffectVerdict::Saves => "saves",
        EffectVerdict::Undecided => "undecided",
        EffectVerdict::Failed => "failed",
        EffectVerdict::Kept => "cannot be left out",
        EffectVerdict::Absent => "absent",
    }
}

fn line(
    found: &Ablation,
    shown: &ShownQuantity,
    name: &str,
    verdict: &str,
    c: &ComparedRun,
    number: String,
) -> [String; 10] {
    if c.trial.summary.is_none() {
        let verdict = if verdict.is_empty() { "failed" } else { verdict };
        let mut line: [String; 10] = Default::default();
        (line[0], line[1], line[9]) = (name.into(), verdict.into(), number);
        return line;
    }
    let small = |x: f64, own: bool| format!("{}{x:.1e}", if own || x == 0.0 { "" } else { "~" });
    let change = shown.change(c);
    let own = shown.own(found).unwrap_or(0.0);
    let largest = c.largest.as_ref().filter(|l| l.1 > 0.0);
    [
        name.into(),
        verdict.into(),
        change.map_or("-".into(), |x| small(x, x > own)),
        largest.map_or("-".into(), |l| small(l.1, c.above_own_error)),
        largest.map_or(String::new(), |l| l.0.clone()),
        format!("{:+}", c.unknowns),
        c.trial.counters.steps.to_string(),
        format!("{:.2}", c.work),
        format!("{:.2}", c.wall),
        number,
    ]
}

/// Recommendation with the JSON of the key `effects`: `Without rotary_inertia the model needs ... "effects": {...}`
pub fn sentence(found: &Ablation) -> String {
    let Some(r) = &found.recommendation else {
        return "No recommendation: the full model did not run to the end.".into();
    };
    let mut text = match (r.off.as_slice(), &r.run) {
        ([], _) if r.dropped.is_empty() => "No effect that can be left out saves work.".to_string(),
        ([], _) => "Nothing should be left out.".to_string(),
        (off, Some(run)) => {
            let change = |(name, x): &(String, f64)| format!(" {name} changes most, by {x:.1e}.");
            let change = run.largest.as_ref().map_or(String::new(), change);
            let (off, work) = (Effect::names(off, ", "), percent(run.work));
            format!("Without {off} the model needs {work} of the work.{change}")
        }
        (off, None) => format!("Leave out {}.", Effect::names(off, ", ")),
    };
    for (name, why) in &r.dropped {
        let _ = write!(text, " {name} would save work but is kept: {why}.");
    }
    let _ = write!(text, "\n\"effects\": {}", crate::case::spaced(&r.effects));
    text
}

/// Text of `effects.csv`: one row per effect and quantity. An effect that was not run or did not finish has one row without changes.
pub fn csv(found: &Ablation) -> String {
    let headings = "left_out,verdict,reason,auto,number,without,takes,unknowns,steps,residual_evaluations,jacobian_evaluations,\
                    factorizations,wall_min [s],repeats,work_ratio,wall_ratio,quantity,size,change,own_error";
    let effects = found.rows.iter().map(|row| {
        let first = [
            row.name.to_string(),
            said(row).into(),
            row.reason.clone().unwrap_or_default(),
            if row.auto { "on" } else { "off" }.into(),
            row.number.clone(),
            Effect::names(&row.without, " "),
            Effect::names(&row.takes, " "),
        ];
        (first, row.left_out.as_ref())
    });
    let beside = beside(found).map(|(name, compared)| {
        let mut first: [String; 7] = Default::default();
        first[0] = name.into();
        first[2] = compared.trial.reason.clone().unwrap_or_default();
        (first, Some(compared))
    });
    let rows = effects.chain(beside).flat_map(|(first, compared)| {
        let rest = compared.map_or_else(|| vec![[const { String::new() }; 13]], |c| cells(found, c));
        rest.into_iter().map(move |rest| [&first[..], &rest].concat())
    });
    records::text(headings.split(','), rows)
}

/// Cost and changes of a comparison, one row per quantity; a single row without changes if there are none.
fn cells(found: &Ablation, c: &ComparedRun) -> Vec<[String; 13]> {
    let n = &c.trial.counters;
    let row = |name: &str, numbers: [Option<f64>; 3]| {
        let [size, change, own] = numbers.map(number);
        [
            c.trial.unknowns.to_string(),
            n.steps.to_string(),
            n.residual_evaluations.to_string(),
            n.jacobian_evaluations.to_string(),
            n.factorizations.to_string(),
            number(Some(c.trial.wall_s())),
            c.trial.repeats.to_string(),
            number(Some(c.work)),
            number(Some(c.wall)),
            name.into(),
            size,
            change,
            own,
        ]
    };
    if c.changes.is_empty() {
        return vec![row("", [None; 3])];
    }
    let change = |name| c.changes.get(name).copied();
    let measures = found.measures.iter();
    measures
        .map(|m| row(&m.name, [Some(m.size), change(&m.name), m.own]))
        .collect()
}
