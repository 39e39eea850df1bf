//! Powers and efficiency over the preceding period, at every output time of a driven run.

use serde_json::{Value, json};

use super::base64;
use super::history::ReportHistory;
use crate::discrete::quantities::{Group, Observable};
use crate::run::energies::ROUNDING;

/// Energy, relative to the largest input in a period, below which a ratio of energies is meaningless.
const LEAST: f64 = 1e-9;

/// Columns of mean input power, mean harvested power, and `H/(H + D - P)`, each over the period before its time. Empty if the history is
/// shorter than a period, was thinned, or has no harvest.
pub fn columns(history: &ReportHistory, period: f64) -> Vec<Value> {
    let times = history.times();
    let (Some(first), Some(last)) = (times.first(), times.last()) else {
        return vec![];
    };
    let harvests = Observable::grouped(Group::Harvested).any(|one| history.column(one.name()).is_some());
    if history.joined() || !harvests || last - first < period {
        return vec![];
    }
    let sum = |group: Group| -> Vec<f64> {
        let mut all = vec![0.0; times.len()];
        for values in Observable::grouped(group).filter_map(|one| history.column(one.name())) {
            all.iter_mut().zip(values).for_each(|(sum, x)| *sum += x);
        }
        all
    };
    let gains = |group: Group| gained(times, &sum(group), period);
    let [put_in, harvested, lost, added] = [Group::PutIn, Group::Harvested, Group::Lost, Group::Added].map(gains);
    let largest = put_in
        .iter()
        .filter(|x| x.is_finite())
        .fold(0.0, |m: f64, x| m.max(x.abs()));
    let stored = sum(Group::Stored).iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let least = (LEAST * largest).max(ROUNDING * stored);
    let ratio = (0..times.len()).map(|k| {
        let spent = harvested[k] + lost[k] - added[k];
        if spent.abs() > least {
            harvested[k] / spent
        } else {
            f64::NAN
        }
    });
    let over = |energy: &[f64]| energy.iter().map(|x| x / period).collect::<Vec<_>>();
    let column = |name: &str, unit: &str, label: &str, about: &str, values: Vec<f64>| {
        json!({
            "name": name, "unit": unit, "group": "Over the last cycle", "label": label, "about": about, "usual": false,
            "values": base64::numbers(values),
        })
    };
    vec![
        column(
            "cycle_power_in",
            "W",
            "power put in",
            "mean over the period before",
            over(&put_in),
        ),
        column(
            "cycle_power_harvested",
            "W",
            "power harvested",
            "mean over the period before",
            over(&harvested),
        ),
        column(
            "cycle_efficiency",
            "1",
            "efficiency",
            "harvested over harvested and lost in the period before",
            ratio.collect(),
        ),
    ]
}

/// Increase of a quantity over the period before each time; NaN in the first period.
fn gained(times: &[f64], values: &[f64], period: f64) -> Vec<f64> {
    let mut before = 0;
    let at = |k: usize| {
        let t = times[k] - period;
        // tolerance for a first period that ends at an output time
        if t < times[0] - 1e-9 * period {
            return f64::NAN;
        }
        while before + 2 < times.len() && times[before + 1] < t {
            before += 1;
        }
        let (from, to) = (times[before], times[before + 1]);
        let share = ((t - from) / (to - from)).clamp(0.0, 1.0);
        values[k] - (values[before] + share * (values[before + 1] - values[before]))
    };
    let mut at = at;
    (0..times.len()).map(&mut at).collect()
}

#[cfg(test)]
mod tests {
    use super::gained;

    /// Goal: a steadily growing quantity gains the same in every period, and has no value before the end of the first.
    #[test]
    fn gains_are_those_of_a_period() {
        let times: Vec<f64> = (0..=10).map(|k| 0.1 * f64::from(k)).collect();
        let values: Vec<f64> = times.iter().map(|t| 3.0 * t).collect();
        let found = gained(&times, &values, 0.25);
        assert!(found[..3].iter().all(|x| x.is_nan()));
        assert!(found[3..].iter().all(|x| (x - 0.75).abs() < 1e-12), "{found:?}");
    }
}
