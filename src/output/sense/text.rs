//! Text of loads estimated from pressures.

use crate::error;
use crate::output::columns::{if_any, joined, table as table_of, warnings};
use crate::output::numbers::{count, counted, significant, trimmed};
use crate::results::sense::{BandKind, Banded, NoiseFrom, Sensed, Unknown};
use crate::study::sense::basis::Basis;

/// Largest number of rows of a table.
const ROWS: usize = 12;
/// Largest number of lines of a kind that are listed one by one.
const MANY: usize = 6;

/// Observability, loads, fit, selection of bladders, and warnings.
pub fn describe(found: &Sensed) -> String {
    let mut text = about_sight(found);
    if !found.rows.is_empty() {
        if !found.doubts.is_empty() {
            text += &format!("\n{}", warnings(&found.doubts));
        }
        let (headings, rows) = table(found);
        // over time some instants from start to end, otherwise the first rows
        let every = match found.over_time {
            Some(_) => rows.len().div_ceil(ROWS),
            None => 1,
        };
        let all = rows.len();
        let lines: Vec<_> = rows.into_iter().step_by(every.max(1)).take(ROWS).collect();
        let more = if_any(all - lines.len(), |n| {
            format!("{} in sense.csv\n", counted(n as u64, "more row"))
        });
        text += &format!("\n{}{more}", table_of(&format!("<{}", headings.join(" | ")), lines));
        text += &format!("\n{}\n", about_noise(found));
    }
    if !found.choice.is_empty() {
        text += &format!("\n{}", sensors(found));
    }
    if !found.left_alone.is_empty() {
        let names = error::listed(found.left_alone.iter().map(String::as_str));
        text += &format!("columns left alone: {names}\n");
    }
    let others = found.warnings.iter().filter(|one| !found.doubts.contains(one));
    text + &warnings(others)
}

/// Observability of the loads from the pressures of the bladders.
pub fn about_sight(found: &Sensed) -> String {
    let loads: Vec<String> = found.loads.iter().map(ToString::to_string).collect();
    let bladders = counted(found.bladders.len() as u64, "bladder");
    let straight = match found.loads.iter().any(|load| matches!(load, Basis::Profile(_))) {
        true => "; loads are linear between the places of the profile:",
        false => "",
    };
    let mut text = format!(
        "{}: {} from the pressures of {bladders} {}{straight}\n",
        found.case,
        loads.join(" + "),
        match found.over_time {
            Some(_) => "over time; for constant loads:",
            None => "at rest",
        }
    );
    if !found.own_loads.is_empty() {
        text += &format!(
            "  loads of the case also act, with their values at t = {} s: {}; the loads found add to them\n",
            trimmed(&significant(found.loads_at_s, 4)),
            found.own_loads.join(", ")
        );
    }
    let alone = |a: &&Unknown| a.error_per_pa.is_some();
    let determined: Vec<&Unknown> = found.amplitudes.iter().filter(alone).collect();
    if determined.len() > MANY {
        text += &format!("  determined individually: {}\n", listed(&determined));
    } else {
        for Unknown {
            name,
            unit,
            error_per_pa,
            ..
        } in determined
        {
            let error = significant(error_per_pa.unwrap_or_default(), 3);
            text += &format!("  {name} is determined: its standard error is {error} {unit} per Pa of noise\n");
        }
    }
    let lost: Vec<&Unknown> = found.amplitudes.iter().filter(|a| !alone(a)).collect();
    if !lost.is_empty() {
        text += &format!("  not determined by these pressures alone: {}\n", listed(&lost));
    }
    let (together, blind) = (&found.seen.together, &found.seen.blind);
    if together.len() > MANY {
        let in_any = |k: usize| together.iter().any(|one| one.factors.get(k).is_some_and(|c| *c != 0.0));
        text += &format!(
            "  determined only together: {} sums of {}\n",
            together.len(),
            listed(&select(found, &in_any))
        );
    } else {
        for one in together {
            let (name, unit) = (&one.name, &one.unit);
            text += &format!("  determined only together: {name} [{unit}], numbers in SI units\n");
        }
    }
    if blind.len() > MANY {
        let in_any = |k: usize| blind.iter().any(|change| change.get(k).is_some_and(|c| *c != 0.0));
        text += &format!(
            "  not observable: {} independent combinations of {}; listed in sense.json\n",
            blind.len(),
            listed(&select(found, &in_any))
        );
        return text;
    }
    for change in blind {
        let parts = change.iter().zip(&found.amplitudes).filter(|(c, _)| **c != 0.0);
        let parts = parts.map(|(c, a)| format!("{} {} of {}", significant(*c, 4), a.unit, a.name));
        text += &format!("  not observable: {}\n", joined(parts, " with "));
    }
    text
}

/// Amplitudes that satisfy a condition on their index.
fn select<'a>(found: &'a Sensed, holds: &dyn Fn(usize) -> bool) -> Vec<&'a Unknown> {
    let all = found.amplitudes.iter().enumerate();
    all.filter(|(k, _)| holds(*k)).map(|(_, a)| a).collect()
}

/// Names of amplitudes; many places of a profile are summarized by their number and range.
fn listed(all: &[&Unknown]) -> String {
    let (places, others): (Vec<&Unknown>, Vec<&Unknown>) = all.iter().partition(|a| a.place.is_some());
    let (from_places, rest) = match places.as_slice() {
        [first, .., last] if places.len() > MANY => {
            let range = format!("{} places of a profile, {} to {}", places.len(), first.name, last.name);
            (Some(range), others)
        }
        _ => (None, all.to_vec()),
    };
    let names = rest.into_iter().map(|a| a.name.clone());
    joined(names.chain(from_places), ", ")
}

/// A load with the half width of its band.
fn banded(one: Option<&Banded>) -> String {
    match one {
        Some(one) => format!(
            "{} ± {}",
            significant(one.value, 4),
            significant(one.high - one.value, 2)
        ),
        None => "not determined".into(),
    }
}

/// Headings and rows: one line per load for a single row of measurements, else one line per row.
pub fn table(found: &Sensed) -> (Vec<String>, Vec<Vec<String>>) {
    // sums are useful where their terms are not determined
    let lost = found.rows.iter().any(|row| row.amplitudes.contains(&None));
    let means = found.band == BandKind::LocalMean;
    let sums = || found.seen.together.iter().filter(|_| lost && !means);
    let names = || {
        let amplitudes = found.amplitudes.iter().map(|a| (&a.name, &a.unit));
        amplitudes.chain(sums().map(|one| (&one.name, &one.unit)))
    };
    if let [row] = found.rows.as_slice() {
        let value = match means {
            true => "mean around its place ± half of the band of 95 %",
            false => "value ± half of the band of 95 %",
        };
        let headings = ["load", value, "from", "to", "unit"].map(String::from);
        let all = row.amplitudes.iter().chain(&row.together);
        let lines = names().zip(all).map(|((name, unit), one)| {
            let end = |x: Option<f64>| x.map_or("–".into(), |x| significant(x, 4));
            let (low, high) = one.as_ref().map(|one| (one.low, one.high)).unzip();
            vec![name.clone(), banded(one.as_ref()), end(low), end(high), unit.clone()]
        });
        return (headings.into(), lines.collect());
    }
    let timed = found.rows.iter().all(|row| row.t_s.is_some());
    let mut headings = vec![if timed { "t [s]" } else { "line" }.to_owned()];
    headings.extend(names().map(|(name, unit)| format!("{name} [{unit}]")));
    let lines = found.rows.iter().map(|row| {
        let first = match row.t_s.filter(|_| timed) {
            Some(t) => significant(t, 6),
            None => row.line.to_string(),
        };
        let all = row
            .amplitudes
            .iter()
            .chain(&row.together)
            .map(|one| banded(one.as_ref()));
        [first].into_iter().chain(all).collect()
    });
    (headings, lines.collect())
}

/// Meaning of the bands, in a sentence.
pub fn about_band(found: &Sensed) -> String {
    let text = match found.band {
        BandKind::AssumedForm => {
            let check = match &found.noise {
                _ if !found.doubts.is_empty() => "The pressures do not fit that: loads may lie outside.",
                Some(noise) if noise.from == NoiseFrom::Estimated => "Other loads count as noise.",
                Some(noise) if noise.freedom < 0.5 => "No pressure is left to check that.",
                _ => "χ² checks that.",
            };
            return format!("95 % bands assume loads of the given places and forms: noise is the only error. {check}");
        }
        BandKind::LocalMean => {
            "95 % bands contain the mean of the load around each place, for pads, points, smooth and rough loads. The weight of the mean falls linearly to 0 \
             at the next places. Pressures do not determine the load at a point. A mean is not determined if only assumptions would bound it"
        }
        BandKind::AssumedSmoothness => {
            "95 % bands contain only loads that are linear between the places and as smooth as assumed. Omit --smoothing for bands of \
             loads of any shape"
        }
        BandKind::SmoothInTime => {
            "95 % bands contain loads of the given places that change as smoothly as estimated. Loads that jump may lie outside"
        }
    };
    text.into()
}

/// Noise, fit, and prior assumptions.
pub fn about_noise(found: &Sensed) -> String {
    let Some(noise) = &found.noise else {
        return String::new();
    };
    let sd = noise
        .sd_pa
        .map_or(String::new(), |sd| format!("{} Pa", significant(sd, 3)));
    let freedom = match noise.freedom.round() {
        1.0 => "1 degree".to_owned(),
        many => format!("{many} degrees"),
    };
    let mut text = match noise.from {
        NoiseFrom::Estimated => format!(
            "noise: {sd}, estimated from the residuals of the pressures ({freedom} of freedom); bands from Student's t-distribution"
        ),
        NoiseFrom::Given => format!("noise: {sd}, as given"),
        NoiseFrom::Table => "noise: as given with the measurements".to_owned(),
    };
    if noise.from != NoiseFrom::Estimated {
        let sum = significant(noise.chi_square, 3);
        text += &match found.smoothing {
            None => format!("; the residuals have χ² = {sum} with {freedom} of freedom"),
            Some(_) => {
                let values = found.rows.iter().flat_map(|row| &row.measured_pa).flatten().count();
                format!(
                    "; the residuals of {} have χ² = {}, the roughness of the loads adds {}: {sum} with {freedom} of freedom",
                    counted(values as u64, "pressure"),
                    significant(noise.misfit, 3),
                    significant(noise.roughness, 3)
                )
            }
        };
    }
    text += &format!("\n{}", about_band(found));
    if let Some(smoothed) = &found.smoothing {
        text += "\nprior: ";
        text += &match (smoothed.deviation_n_m, smoothed.load_deviation_n_m) {
            (_, Some(deviation)) => format!(
                "the load is a Gaussian process of unknown scale and length, most likely with a standard deviation of {} N/m; bands include this \
                 uncertainty",
                significant(deviation, 3)
            ),
            (Some(deviation), _) => format!(
                "second differences of the profile have a standard deviation of {} N/m; bands include it",
                significant(deviation, 3)
            ),
            _ => "loads are as smooth over time as the pressures suggest; bands include it".into(),
        };
    }
    if let Some(over_time) = &found.over_time {
        let determined = found.amplitudes.iter().zip(&over_time.determined);
        let determined = determined.map(|(a, count)| format!("{} of {}", significant(*count, 3), a.name));
        text += &format!(
            "\nover time: {} values of each load, one every {} s, joined by a smooth curve; the pressures determine {}; {}",
            over_time.knots,
            significant(over_time.every_s, 3),
            joined(determined, ", "),
            counted(u64::from(over_time.runs), "run")
        );
    } else if found.rows.iter().any(|row| row.t_s.is_some()) {
        text += "\neach row is treated as an equilibrium, without inertia and flow";
    }
    text
}

/// Bladders, separated by spaces.
pub fn list(bladders: &[i64]) -> String {
    joined(bladders.iter().map(ToString::to_string), " ")
}

/// Table of the best bladders to measure.
fn sensors(found: &Sensed) -> String {
    let amplitudes = found.amplitudes.iter();
    let errors: String = amplitudes.map(|a| format!(" | {} [{}]", a.name, a.unit)).collect();
    let error = |e: &Option<f64>| e.map_or("not determined".into(), |e| significant(e, 3));
    let lines = found.choice.iter().take(ROWS).map(|one| {
        let mut line = vec![one.bladders.len().to_string()];
        line.extend(one.errors.iter().map(error));
        line.push(list(&one.bladders));
        line
    });
    let more = if_any(found.choice.len().saturating_sub(ROWS), |n| {
        format!("{n} more in sensors.csv\n")
    });
    format!(
        "the best bladders to measure, and the standard errors of the loads for a noise of {} Pa\n{}{more}",
        significant(found.choice_noise_pa, 3),
        table_of(&format!("sensors{errors} | <bladders"), lines)
    )
}

/// Answer in one sentence.
pub fn answer(found: &Sensed) -> String {
    match (found.rows.as_slice(), found.choice.first(), found.choice.last()) {
        ([row], ..) => {
            let loads = found.amplitudes.iter().zip(&row.amplitudes);
            let loads: Vec<String> = loads
                .filter_map(|(a, one)| Some(format!("{} {} {}", a.name, banded(Some(one.as_ref()?)), a.unit)))
                .take(4)
                .collect();
            match loads.is_empty() {
                true => "These pressures determine no single load, only combinations of loads.".into(),
                false if !found.doubts.is_empty() => format!(
                    "The loads are not reliable: {}. The closest fit is {}.",
                    found.doubts.join("; "),
                    loads.join(", ")
                ),
                false => format!("The pressures correspond to {}.", loads.join(", ")),
            }
        }
        ([], Some(least), Some(most)) => format!(
            "The best set of {} to measure is {}. All {} together give the smallest errors.",
            counted(least.bladders.len() as u64, "bladder"),
            list(&least.bladders).replace(' ', ", "),
            most.bladders.len()
        ),
        (rows, ..) => format!("Loads from {} rows of pressures.", count(rows.len() as u64)),
    }
}
