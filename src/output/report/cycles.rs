//! Pages of `floquet`, `floquet --map` and `periodic --sweep`, and additions to the page of a cycle's run.

use serde_json::{Value, json};

use super::{FolderKind, MOST_ROWS, Page, Place, capital, cells};
use crate::discrete::quantities::Interest;
use crate::error::Result;
use crate::output::bands;
use crate::output::columns::if_any;
use crate::output::floquet::points;
use crate::output::folder::CASE;
use crate::output::numbers::{counted, significant};
use crate::output::periodic::{energies, largest, shown};
use crate::results::cycles::{CyclePath, CycleResult, CycleStability, Map};
use crate::run::floquet::Multiplier;
use crate::run::floquet::shape::EnergyPart;
use crate::study::refine::numbers;
use crate::study::stability::tongue::MapPoint;
use crate::study::stability::{CycleMember, MemberKind};

/// Name of the growth rate of a disturbance.
const GROWTH: &str = "growth_per_s";

/// Table of the multipliers.
fn multipliers(found: &CycleResult) -> Value {
    let banded = !found.bands.is_empty();
    let names: Vec<String> = numbers::named(&found.floquet).into_iter().unzip::<_, _, _, Vec<_>>().0;
    // for a cycle's run only the band of the largest rate is known
    let band = |k: usize| {
        let own = found.bands.get(&format!("{}.{GROWTH}", names[k]));
        let band = own.or_else(|| found.bands.get(GROWTH).filter(|_| k == 0))?;
        bands::between(band, &significant)
    };
    let row = |(k, m): (usize, &Multiplier)| {
        let part = match m.part {
            EnergyPart::Bending(mode) => format!("bending mode {mode}"),
            EnergyPart::Along => "motion along".into(),
            EnergyPart::Fluid => "fluid".into(),
        };
        let before = [m.re, m.im, m.modulus, m.growth_per_s].map(Value::from);
        let behind = [json!(m.frequency_hz), json!(part), json!(m.share)];
        let band = banded.then(|| json!(band(k)));
        cells(before, band.into_iter().chain(behind))
    };
    let before = ["real part", "imaginary part", "modulus", "growth [1/s]"];
    let band = banded.then_some("95 % of samples: growth [1/s]");
    let behind = ["frequency [Hz]", "mostly", "share of energy"];
    let headings: Vec<_> = before.into_iter().chain(band).chain(behind).collect();
    json!({
        "title": "Multipliers",
        "about": "A small disturbance of the cycle is multiplied by these numbers in every period. It dies away where the modulus is \
                  below 1 and grows where it is above.",
        "headings": headings,
        "rows": found.floquet.multipliers.iter().enumerate().map(row).collect::<Vec<_>>(), "file": null,
    })
}

/// Sentences about the stability of a cycle and the search for it.
pub fn answer(found: &CycleResult) -> String {
    format!(
        "{}. The {} of {} s was found in {} over {}, with {} a period.{}",
        capital(&found.floquet.verdict.words),
        match found.floquet.trivial {
            Some(_) => "self-oscillation",
            None => "cycle",
        },
        significant(found.floquet.period_s, 4),
        counted(found.cycle.newton_steps, "Newton step"),
        counted(found.cycle.periods, "period"),
        counted(found.cycle.steps_per_period as u64, "step"),
        found.floquet.trivial.as_ref().map_or(String::new(), |trivial| format!(
            " Its frequency is {} Hz. Its trivial multiplier {:.6}, of a shift in time, is left out below.",
            significant(1.0 / found.floquet.period_s, 4),
            trivial.re
        )),
    )
}

/// Additions from `cycle.json` to the page of a cycle's run.
pub fn of_cycle(found: &CycleResult) -> Value {
    json!([{"title": "Stability of the cycle", "text": answer(found), "table": multipliers(found)}])
}

/// Page of `floquet`.
pub fn floquet(place: &Place) -> Result<Page> {
    let (found, mut page) = place.begun::<CycleResult>(FolderKind::Floquet, |found| (&found.case, &found.warnings))?;
    let (word, tone) = match found.floquet.verdict.stability {
        CycleStability::Unstable => ("unstable", "bad"),
        CycleStability::Neutral => ("neutral", "fair"),
        CycleStability::Stable => ("stable", "good"),
    };
    page.fill(json!({
        "label": "Stability of the steady cycle", "status": {"word": word, "tone": tone, "reason": null}, "answer": answer(&found),
        "figures": [{
            "title": "Multipliers in the complex plane", "picture": place.picture("floquet.svg"),
            "about": "Within the circle of radius 1 disturbances die away; a mark outside it is a disturbance that grows.",
        }],
        "table": multipliers(&found), "command": format!("slcbeam floquet {CASE}"),
    }));
    Ok(page)
}

/// Page of `floquet --map`.
pub fn map(place: &Place) -> Result<Page> {
    let (found, mut page) = place.begun::<Map>(FolderKind::Map, |found| (&found.case, &found.warnings))?;
    let (mut rows, mut answers, mut all) = (vec![], vec![], 0);
    for sheet in &found.sheets {
        let factor = sheet.permeability_factor;
        let count = points(&found, sheet).count();
        let growing = points(&found, sheet).filter(|(.., point)| point.grows()).count();
        let row = |(f, a, point): (f64, f64, &MapPoint)| json!([factor, f, a, point.growth_per_s, point.words]);
        rows.extend(points(&found, sheet).take(MOST_ROWS - rows.len()).map(row));
        all += count;
        let name = factor.map_or("The dry beam".into(), |f| {
            format!("With permeabilities × {}", significant(f, 2))
        });
        answers.push(format!(
            "{name} the motion grows at {growing} of {}.",
            counted(count as u64, "point")
        ));
    }
    let (columns, lines) = (found.frequencies_hz.len(), found.amplitudes_m.len());
    let range = |v: &[f64]| format!("{}:{}", v.first().unwrap_or(&0.0), v.last().unwrap_or(&0.0));
    let (across, up) = (range(&found.frequencies_hz), range(&found.amplitudes_m));
    page.fill(json!({
        "label": "Where shaking is stable", "answer": answers.join(" "),
        "facts": [
            format!("{columns} {}", if columns == 1 { "frequency" } else { "frequencies" }),
            counted(lines as u64, "amplitude"),
        ],
        "figures": [{
            "title": "Growth over frequency and amplitude", "picture": place.picture("map.svg"),
            "about": "Each cell is one frequency and one amplitude of shaking. In the colours of growth, bending vibrations grow by \
                      themselves, although the beam is shaken along its axis only.",
        }],
        "table": {
            "title": "Every point", "about": "",
            "headings": ["permeability factor", "frequency [Hz]", "amplitude [m]", "growth [1/s]", "verdict"],
            "left_out": all - rows.len(), "rows": rows, "file": "map.csv",
        },
        "command": format!("slcbeam floquet {CASE} --map frequency,amplitude --range {across},{up} --points {columns},{lines}"),
    }));
    Ok(page)
}

/// Page of `periodic --sweep`.
pub fn sweep(place: &Place) -> Result<Page> {
    let (found, mut page) = place.begun::<CyclePath>(FolderKind::Sweep, |found| (&found.case, &found.warnings))?;
    let CyclePath {
        pointer,
        members,
        missing,
        logarithmic,
        resonance,
        ..
    } = &found;
    let unstable = |m: &&CycleMember| m.floquet.verdict.stability == CycleStability::Unstable;
    let (low, high) = members.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), m| {
        (l.min(m.value), h.max(m.value))
    });
    let without = if_any(missing.len(), |n| format!(" For {n} values none was found."));
    // all cycles of one case have the same energy figures
    let figures = members.first().map_or(vec![], energies);
    let mut headings = vec![pointer.clone()];
    headings.extend(resonance.as_ref().map(|_| "resonance [Hz]".into()));
    let quantities = shown(&found);
    let deflection = match quantities[0] {
        Interest::TipU1 => "tip u₁ [m]",
        _ => "u₁ [m]",
    };
    headings.extend([deflection, "tip u₃ [m]", "pressure [Pa]"].map(String::from));
    headings.extend(
        figures
            .iter()
            .flat_map(|f| [format!("{} [{}]", f.words, f.unit), "± of it".into()]),
    );
    headings.extend(["growth [1/s]", "verdict", "point"].map(String::from));
    let row = |m: &CycleMember| {
        let verdict = &m.floquet.verdict;
        let mut row = vec![json!(m.value)];
        row.extend(m.resonance_hz.map(|hz| json!(hz)));
        row.extend(quantities.map(|one| json!(largest(m, one))));
        row.extend(energies(m).into_iter().flat_map(|f| [json!(f.value), json!(f.open)]));
        row.extend([json!(verdict.growth_per_s), json!(verdict.words), json!(m.kind_name())]);
        row
    };
    let spread = if *logarithmic { ":log" } else { "" };
    let points = members.iter().filter_map(|m| m.special);
    let special = points.map(|point| point.kind.describe()).collect::<Vec<_>>().join(", ");
    let special = if_any(special.len(), |_| format!(" Special points: {special}."));
    let requested = members
        .iter()
        .filter(|m| m.kind == MemberKind::Requested)
        .map(|m| m.value);
    let mut requested: Vec<f64> = requested.chain(missing.iter().map(|(value, _)| *value)).collect();
    requested.sort_by(f64::total_cmp);
    requested.dedup();
    let values = requested.len();
    let option = resonance
        .as_ref()
        .map_or(String::new(), |at| format!(" --resonance {at}"));
    page.fill(json!({
        "label": if resonance.is_some() { "Backbone of a resonance" } else { "Steady cycles along a parameter" },
        "answer": format!("{} steady cycles were found for {pointer} from {} to {}; {} of them unstable.{without}{special}",
                   members.len(), significant(low, 3), significant(high, 3), members.iter().filter(unstable).count()),
        "figures": [{
            "title": if resonance.is_some() { "Backbone" } else { "Along the parameter" }, "picture": place.picture("sweep.svg"),
            "about": match resonance {
                Some(_) => "At each value of the parameter the steady cycle at which drive and motion are a quarter period apart.",
                None => "Steady cycles for each value of the parameter, without their transients. A branch is followed through its folds; \
                         dashed lines and orange rings are unstable cycles.",
            },
        }],
        "table": {
            "title": "Every cycle", "about": "Largest values within the cycle, its energies with the open part of their balance, and the growth rate of the \
                      slowest disturbance (below 0: it decays).",
            "headings": headings, "left_out": members.len().saturating_sub(MOST_ROWS),
            "rows": members.iter().take(MOST_ROWS).map(row).collect::<Vec<_>>(), "file": "sweep.csv",
        },
        "command": format!("slcbeam periodic {CASE} --sweep {pointer}={low}:{high}:{values}{spread}{option}"),
    }));
    Ok(page)
}
