//! Errors of energies: of squares of the motion, and of what is left of work that came back.

use std::collections::BTreeMap;

use super::words::{LARGE, Row};
use super::{CURVED, Estimator, NOTHING, SQUARED, Unstable};
use crate::run::summary::Quantity;

/// Below this part of the displacement along the beam one across it stores nothing that counts.
const ALONG: f64 = 0.1;
/// Slope of the tip in the first mode of a cantilever, over its deflection over the length.
const SLOPED: f64 = 1.376;
/// How many times as large as others an error of loads' and ends' work may be told to be before it is warned of.
const ALONE: f64 = 2.0;
/// Part of what went in over the window that is most of it.
const MOST: f64 = 0.5;
/// How much more than what is left at the end may have been stored and come back.
const MOST_BACK: f64 = 4.0;

impl Estimator {
    /// Energies: of displacements across, or along where those are nothing beside them.
    pub(super) fn energies(
        &self,
        rows: &mut Vec<Row>,
        quantities: &BTreeMap<String, Quantity>,
        unstable: &Unstable,
        [wide, long, angle]: [f64; 3],
    ) {
        // ends that are driven along the beam move all of it, and store nothing
        let (moved, which, size): (&[&str], usize, f64) = match wide >= ALONG * long {
            true => (&["largest_u1_m", "tip_angle_rad"], 0, wide),
            false => (&["largest_u3_m"], 1, long),
        };
        // a tip that hardly turns while the beam moves says nothing of it
        let turned = (angle * self.floors.length / (SLOPED * wide)).min(1.0);
        let moved = rows.iter().filter(|row| moved.contains(&row.name)).cloned();
        let moved = moved.map(|row| match row.name {
            "tip_angle_rad" => row.times(turned),
            _ => row,
        });
        let Some(most) = moved.max_by(|a, b| a.total().total_cmp(&b.total())) else {
            return;
        };
        let stored = self.stored[which] * size * size;
        for name in ["input_energy_j", "harvested_energy_j"] {
            let size = quantities.get(name).and_then(|q| q.last).map_or(0.0, f64::abs);
            if !self.counts(name, size, quantities) {
                continue;
            }
            // where fluid is pumped through a beam that hardly moves, its motion says nothing
            let (errors, phase) = match stored > NOTHING * size {
                true => (most.errors, most.phase),
                false => ([self.tolerance.gathered(), 0.0], 0.0),
            };
            // what was stored and came back was as wrong as what is left; what is harvested does not come back
            let came_back = match name {
                "input_energy_j" => (unstable.stored / size).clamp(1.0, MOST_BACK),
                _ => 1.0,
            };
            // what follows its loads comes back as it went in
            let follows = self.at_rest[which].min(errors[1]);
            let [time, space] =
                [errors[0] * came_back, follows + (errors[1] - follows) * came_back].map(|x| SQUARED * x);
            // nothing but loads and ends: mostly off by much less than it is told, three times as much as a displacement; unless what
            // went in and out over the window is so near nothing that the error is most of it
            let window = quantities.get(name).and_then(|q| q.window).map_or(0.0, f64::abs);
            let all_of_it = (time + space) * size > MOST * window && window > NOTHING * size;
            let alone = !quantities.contains_key("harvested_energy_j") && !all_of_it;
            rows.push(Row {
                name,
                enough: if alone { ALONE * LARGE } else { LARGE },
                errors: [time, space + (CURVED - SQUARED) * self.at_rest[which]],
                phase: SQUARED * came_back * phase,
                ..most
            });
        }
    }
}
