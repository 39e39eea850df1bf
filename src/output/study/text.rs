//! The sentence at the end of a study.

use crate::discrete::quantities::Observable;
use crate::output::numbers::{counted, significant, trimmed};
use crate::study::accuracy::{Scheme, Study, StudySetting};

/// A measure as text.
pub fn spoken(name: &str) -> String {
    Observable::named(name).map_or_else(|| name.replace('_', " "), |one| one.describe().into())
}

/// Closing sentence: `1 % of tip deflection costs 0.03 s (2 cells, rtol 1e-3); ...; looser than rtol 1e-3 costs more, not less.`
pub fn sentence(study: &Study) -> String {
    let Some(measure) = study.measure() else {
        return "No accuracy is known: no run finished.".into();
    };
    let schemes: Vec<Scheme> = study.plan.schemes.clone();
    let mut parts: Vec<String> = vec![];
    let mut missing = vec![];
    let mut last = None;
    for answer in &study.answers {
        let accuracy = format!("{} %", trimmed(&significant(100.0 * answer.accuracy, 2)));
        let Some(k) = answer.point else {
            missing.push(accuracy);
            continue;
        };
        let trial = &study.points[k].trial;
        if last == Some(k) {
            // The cheapest run of all is more accurate than requested, so it also answers the looser question.
            parts.pop();
        }
        let of = match parts.is_empty() {
            true => format!(" of {}", spoken(&measure.name)),
            false => String::new(),
        };
        let price = price(trial.wall_min_s, trial.setting, &schemes);
        parts.push(format!("{accuracy}{of} costs {price}"));
        last = Some(k);
    }
    if parts.is_empty() {
        parts.push(format!(
            "no setting has {} of {}",
            missing.join(" or "),
            spoken(&measure.name)
        ));
    } else if !missing.is_empty() {
        let are = if missing.len() > 1 { "are" } else { "is" };
        parts.push(format!(
            "{} {are} not reached, or cannot be judged within this budget",
            missing.join(" and ")
        ));
    }
    parts.extend(foot(study));
    parts.extend(trap(study));
    let mut text = parts.join("; ");
    text.push('.');
    text
}

fn price(seconds: f64, setting: StudySetting, schemes: &[Scheme]) -> String {
    let StudySetting { scheme, cells, rtol } = setting;
    let scheme = if schemes.len() > 1 {
        format!(", {scheme}")
    } else {
        String::new()
    };
    let (seconds, cells) = (significant(seconds, 2), counted(cells as u64, "cell"));
    format!("{seconds} s ({cells}{scheme}, rtol {rtol:e})")
}

/// Sentence about the tolerance above which cost increases most: on a line with an answer, else on any line, which is then named.
fn foot(study: &Study) -> Option<String> {
    let line = |k: usize| study.points[k].trial.line();
    let lines: Vec<_> = study.answers.iter().filter_map(|a| a.point).map(line).collect();
    let worst = |answering: bool| {
        let feet = study
            .feet
            .iter()
            .filter(|f| lines.contains(&line(f.cheapest)) == answering);
        feet.max_by(|a, b| a.factor.total_cmp(&b.factor))
    };
    let (foot, answering) = worst(true)
        .map(|f| (f, true))
        .or_else(|| worst(false).map(|f| (f, false)))?;
    let setting = study.points[foot.cheapest].trial.setting;
    let factor = significant(foot.factor, 2);
    let cells = counted(setting.cells as u64, "cell");
    let with = match answering {
        true => String::new(),
        false => format!(" with {cells} and {}", setting.scheme),
    };
    Some(format!(
        "looser than rtol {:e} costs more, not less{with} (up to {factor} times)",
        setting.rtol
    ))
}

/// Cost of orders above 2 relative to others, at the first accuracy that both reach; `None` up to a factor of 2.
fn trap(study: &Study) -> Option<String> {
    let cheapest = |high: bool, accuracy: f64| {
        let all = study.points.iter().enumerate().filter(|(k, p)| {
            p.trial.setting.scheme.trapped() == high && study.error(*k).is_some_and(|e| e.bound.max <= accuracy)
        });
        all.map(|(_, p)| p.trial.wall_min_s).reduce(f64::min)
    };
    let answer = study
        .answers
        .iter()
        .filter(|a| a.point.is_some() && a.accuracy < 0.05)
        .map(|a| a.accuracy);
    let (accuracy, factor) = answer
        .filter_map(|accuracy| Some((accuracy, cheapest(true, accuracy)? / cheapest(false, accuracy)?)))
        .next()?;
    (factor > 2.0).then(|| {
        let percent = trimmed(&significant(100.0 * accuracy, 2));
        format!(
            "BDF orders beyond 2 cost {} times as much at {percent} %",
            significant(factor, 2)
        )
    })
}
