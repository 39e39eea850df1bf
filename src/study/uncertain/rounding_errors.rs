//! Figures that are rounding errors: neither their samples nor their derivatives are significant.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use super::{FigureSpread, FirstOrder};
use crate::study::analysis::AnalysisOutcome;
use crate::study::sweep::unit::unit;

/// Share of the size of its kind below which a figure is a rounding error.
const NOTHING: f64 = 1e-9;

/// Kind of a figure, by which it is compared with others: its unit, or its own name if it has none.
fn kind(name: &str) -> &str {
    match unit(name) {
        "1" => name.rsplit('.').next().unwrap_or(name),
        unit => unit,
    }
}

/// Sets figures to zero that are rounding errors compared with others of their unit. Growth rates are compared with
/// frequencies, damping ratios with one, angles with displacements over a length [m] of the beam. Forces and couples
/// are compared with the work that they would do over that length.
pub(super) fn without_round_off(
    mut figures: BTreeMap<String, FigureSpread>,
    own: &AnalysisOutcome,
    length: f64,
) -> BTreeMap<String, FigureSpread> {
    let size = |one: &FigureSpread| {
        [one.value, one.mean, one.low, one.high]
            .iter()
            .fold(one.sd, |s, x| s.max(x.abs()))
    };
    let mut largest: BTreeMap<String, f64> = BTreeMap::new();
    for (name, one) in &figures {
        let entry = largest.entry(kind(name).to_owned()).or_default();
        *entry = entry.max(size(one));
    }
    let swings = own.figures.iter().filter(|(name, _)| name.ends_with("frequency_hz"));
    let swings = swings.fold(0.0_f64, |s, (_, hz)| s.max(TAU * hz.abs()));
    let most = |kind: &str| largest.get(kind).copied().unwrap_or(0.0);
    let displacement = most("m").max(length * most("rad"));
    let work = most("J").max(length * most("N")).max(most("N m"));
    for (name, one) in &mut figures {
        let beside = match kind(name) {
            "damping_ratio" => 1.0,
            "1/s" => most("1/s").max(swings),
            "m" => displacement,
            "rad" => displacement / length,
            "N" => work / length,
            "N m" => work,
            kind => most(kind),
        };
        let first = one.first_order.as_ref().map_or(0.0, |first| first.sd);
        if one.sd.max(first) <= NOTHING * size(one) {
            // constant except for rounding errors: the pressure of a port, a reaction by statics alone
            (one.sd, one.sd_error, one.low, one.high) = (0.0, 0.0, one.value, one.value);
            one.indices = None;
            if let Some(first) = &mut one.first_order {
                first.sd = 0.0;
                first.shares.fill(0.0);
            }
        }
        if size(one) <= NOTHING * beside {
            *one = FigureSpread {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn spread_at(x: f64) -> FigureSpread {
        FigureSpread {
            value: x,
            numerical_error: None,
            first_order: None,
            samples: 16,
            mean: x,
            sd: 0.1 * x.abs(),
            sd_error: 0.0,
            low: x,
            high: x,
            indices: None,
        }
    }

    /// Goal: a figure without others of its unit is compared with its causes and effects, not with itself. A beam
    /// compressed along its axis neither rotates nor pulls at its root, whatever the spread of its rounding errors.
    #[test]
    fn round_off_that_is_alone_with_its_unit_is_nothing() {
        let all = [
            ("tip_u3_m", 2e-6),
            ("tip_u1_m", -3e-52),
            ("tip_angle_rad", 4.5e-51),
            ("bladder_energy_j", 2e-6),
            ("reaction_root_x_N", 2.6e-50),
            ("reaction_root_z_N", 3.5e-18),
            ("reaction_root_couple_N m", 4e-51),
        ];
        let figures = all.map(|(name, x)| (name.to_owned(), spread_at(x))).into();
        let own = AnalysisOutcome::finished();
        let left = without_round_off(figures, &own, 0.1);
        let names: Vec<&str> = left
            .iter()
            .filter(|(_, one)| one.sd > 0.0)
            .map(|(name, _)| name.as_str())
            .collect();
        assert_eq!(names, ["bladder_energy_j", "tip_u3_m"]);
        // the pressure of a port has no spread
        let held = FigureSpread {
            sd: 1e-8,
            first_order: Some(FirstOrder {
                sd: 2e-8,
                shares: vec![1.0],
            }),
            ..spread_at(6e4)
        };
        let figures = [("bladder__1_pressure_pa".to_owned(), held)].into();
        let left = without_round_off(figures, &own, 0.1);
        let held = &left["bladder__1_pressure_pa"];
        let first = held.first_order.as_ref().map(|first| (first.sd, first.shares[0]));
        assert_eq!((held.value, held.sd, first), (6e4, 0.0, Some((0.0, 0.0))));
    }
}
