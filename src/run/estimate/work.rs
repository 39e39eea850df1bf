//! Errors of energies: of squares of the motion, and of what is left of work that came back.

use std::collections::BTreeMap;

use super::words::Row;
use super::{CURVED, Estimator, NOTHING, SQUARED};
use crate::discrete::ledger::{Energies, Flow};
use crate::run::summary::Quantity;

/// Below this part of the displacement along the beam one across it stores nothing that counts.
const ALONG: f64 = 0.1;
/// Slope of the tip in the first mode of a cantilever, over its deflection over the length.
const SLOPED: f64 = 1.376;
/// How much more than what is left at the end may have been stored and come back.
const MOST_BACK: f64 = 4.0;

/// Energies of a run of which others are parts.
#[derive(Clone, Copy, Debug, Default)]
pub struct Work {
    /// Largest energy stored [J]: what comes back of it is as wrong as what is left.
    pub stored: f64,
    /// What went through the motion of the beam [J]: works of loads and ends, what material and drag take, what is stored in it.
    pub moved: f64,
}

impl Work {
    /// Of the largest energy stored, of what is stored at the end, and of what went where.
    pub fn of(largest: f64, stored: &Energies, integrals: &[f64]) -> Self {
        let flow = |flow: Flow| integrals.get(flow as usize).map_or(0.0, |x| x.abs());
        let through = [Flow::Loads, Flow::Ends, Flow::Damping].map(flow);
        let within = [stored.kinetic, stored.rotary, stored.axial, stored.bending];
        Self {
            stored: largest,
            moved: through.into_iter().chain(within).sum(),
        }
    }
}

impl Estimator {
    /// Energies: of displacements across, or along where those are nothing beside them.
    pub(super) fn energies(
        &self,
        rows: &mut Vec<Row>,
        quantities: &BTreeMap<String, Quantity>,
        work: &Work,
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
        let turbines = quantities.contains_key("harvested_energy_j");
        for name in ["input_energy_j", "harvested_energy_j"] {
            let size = quantities.get(name).and_then(|q| q.last).map_or(0.0, f64::abs);
            if !self.counts(name, size, quantities) {
                continue;
            }
            // where fluid is pumped through a beam that hardly moves, its motion says nothing; what turbines take may be a small part
            // that follows the motion all the same
            let moved = match (stored > NOTHING * size, turbines) {
                (false, _) => 0.0,
                (true, false) => (work.moved / size).min(1.0),
                (true, true) => 1.0,
            };
            let errors = [
                moved * most.errors[0] + (1.0 - moved) * self.tolerance.gathered(),
                moved * most.errors[1],
            ];
            let at_rest = moved * self.at_rest[which];
            let phase = moved * most.phase;
            // what was stored and came back was as wrong as what is left; what is harvested does not come back
            let came_back = match name {
                "input_energy_j" => (work.stored / size).clamp(1.0, MOST_BACK),
                _ => 1.0,
            };
            // what follows its loads comes back as it went in
            let follows = at_rest.min(errors[1]);
            let [time, space] =
                [errors[0] * came_back, follows + (errors[1] - follows) * came_back].map(|x| SQUARED * x);
            rows.push(Row {
                name,
                errors: [time, space + (CURVED - SQUARED) * at_rest],
                phase: SQUARED * came_back * phase,
                ..most
            });
        }
    }
}
