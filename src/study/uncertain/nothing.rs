//! Figures that are round-off: neither their samples nor their derivatives say anything.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use super::{FirstOrder, Spread};
use crate::study::sweep::row::Found;

/// Beside others of its unit a figure of this part is round-off.
const NOTHING: f64 = 1e-9;
/// Ends of names that are units, the longer ones first.
const UNITS: [&str; 14] = [
    "_m3_s",
    "_per_m",
    "_per_s",
    "_n_m",
    "_m_s",
    "_m3",
    "_rad",
    "_pa",
    "_hz",
    "_m",
    "_n",
    "_j",
    "_w",
    "damping_ratio",
];

/// The unit of a figure by the end of its name; what has none is beside its likes alone.
fn unit(name: &str) -> &str {
    let quantity = name.split('.').next().unwrap_or(name);
    let own = name.rsplit('.').next().unwrap_or(name);
    let end = |name: &'static str| {
        [quantity, own]
            .into_iter()
            .any(|one| one.ends_with(name))
            .then_some(name)
    };
    UNITS.iter().find_map(|unit| end(unit)).unwrap_or(own)
}

/// Figures with nothing in place of what is round-off beside others of their unit, growth beside what swings, and damping that is none.
pub(super) fn without_round_off(mut figures: BTreeMap<String, Spread>, own: &Found) -> BTreeMap<String, Spread> {
    let size = |one: &Spread| {
        [one.value, one.mean, one.low, one.high]
            .iter()
            .fold(one.sd, |s, x| s.max(x.abs()))
    };
    let mut largest: BTreeMap<String, f64> = BTreeMap::new();
    for (name, one) in &figures {
        let entry = largest.entry(unit(name).to_owned()).or_default();
        *entry = entry.max(size(one));
    }
    let swings = own.figures.iter().filter(|(name, _)| name.ends_with("frequency_hz"));
    let swings = swings.fold(0.0_f64, |s, (_, hz)| s.max(TAU * hz.abs()));
    for (name, one) in &mut figures {
        let beside = match unit(name) {
            "damping_ratio" => 1.0,
            "_per_s" => largest["_per_s"].max(swings),
            unit => largest[unit],
        };
        if size(one) <= NOTHING * beside {
            *one = Spread {
                numerical_error: None,
                first_order: one.first_order.is_some().then(|| FirstOrder {
                    sd: 0.0,
                    shares: vec![0.0; one.first_order.as_ref().map_or(0, |first| first.shares.len())],
                }),
                indices: None,
                samples: one.samples,
                value: 0.0,
                mean: 0.0,
                sd: 0.0,
                sd_error: 0.0,
                low: 0.0,
                high: 0.0,
            };
        }
    }
    figures
}
