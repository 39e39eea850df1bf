//! Chooses recorded times: all, ranges, single times, every n-th.

use crate::error::{Result, usage};

/// Indices of the instants in `times` that `list` names (`0.1,0.45:0.5` [s]; absent: all), thinned to every `every`-th.
///
/// A single time selects the nearest instant, a range all instants from its start to its end.
///
/// # Errors
/// [`Error::Usage`] if the list cannot be read, exceeds the recorded span, or contains no instant.
pub fn choose(times: &[f64], list: Option<&str>, every: usize) -> Result<Vec<usize>> {
    let mut chosen: Vec<usize> = match list {
        None => (0..times.len()).collect(),
        Some(list) => {
            let mut all = Vec::new();
            for piece in list.split(',') {
                all.extend(named(times, piece.trim())?);
            }
            all.sort_unstable();
            all.dedup();
            all
        }
    };
    chosen = chosen.into_iter().step_by(every.max(1)).collect();
    if chosen.is_empty() {
        return usage("the result holds no instant of its fields");
    }
    Ok(chosen)
}

fn named(times: &[f64], piece: &str) -> Result<Vec<usize>> {
    let (first, last) = (times.first().copied(), times.last().copied());
    let (first, last) = (first.unwrap_or(0.0), last.unwrap_or(0.0));
    let refuse = |what: &str| {
        usage(format!(
            "--times {piece}: {what}; fields are recorded from {first} s to {last} s; give times and ranges such as 0.1,0.45:0.5"
        ))
    };
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|t| t.is_finite());
    // A time typed with fewer digits than recorded may be slightly outside.
    let slack = 1e-9 * (last - first);
    let recorded = |t: f64| t >= first - slack && t <= last + slack;
    match piece.split_once(':') {
        None => match number(piece) {
            Some(t) if recorded(t) => {
                let nearer = |a: &usize, b: &usize| (times[*a] - t).abs().total_cmp(&(times[*b] - t).abs());
                Ok((0..times.len()).min_by(nearer).into_iter().collect())
            }
            Some(_) => refuse("outside of what is recorded"),
            None => refuse("no time"),
        },
        Some((from, to)) => match (number(from), number(to)) {
            (Some(from), Some(to)) if from <= to => {
                let within = |k: &usize| times[*k] >= from - slack && times[*k] <= to + slack;
                let all: Vec<usize> = (0..times.len()).filter(within).collect();
                if all.is_empty() {
                    return refuse("no instant lies within");
                }
                Ok(all)
            }
            (Some(_), Some(_)) => refuse("the range ends before it starts"),
            _ => refuse("no range of times"),
        },
    }
}
