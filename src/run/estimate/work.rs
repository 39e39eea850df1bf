//! Errors of energies: of squares of the motion, and of what is left of work that came back.

use std::collections::BTreeMap;

use super::words::Row;
use super::{CURVED, Estimator, NOTHING, SQUARED};
use crate::discrete::quantities::{self, Interest, Observable};
use crate::run::energies::{Energies, REMAINDER};
use crate::run::summary::Quantity;

/// Below this part of the displacement along the beam one across it stores nothing that counts.
const ALONG: f64 = 0.1;
/// Slope of the tip in the first mode of a cantilever, over its deflection over the length.
const SLOPED: f64 = 1.376;
/// How much more than what is left at the end may have been stored and come back.
const MOST_BACK: f64 = 4.0;

/// Most of what was put in came back where no more than this part of it is left.
const BACK: f64 = 0.5;

/// Energies of a run of which others are parts.
#[derive(Clone, Copy, Debug, Default)]
pub struct Work {
    /// Largest energy stored [J]: what comes back of it is as wrong as what is left.
    pub stored: f64,
    /// Largest energy put in [J].
    pub put_in: f64,
    /// What went through the motion of the beam [J]: works of loads and ends, what material and drag take, what is stored in it.
    pub moved: f64,
}

impl Work {
    /// Of the largest energies, and of what is stored at the end and what went where.
    pub fn of(followed: &Energies, last: &quantities::Row) -> Self {
        let size = |of: Observable| last.get(of).unwrap_or(0.0).abs();
        let through = [
            Observable::WorkLoads,
            Observable::WorkEnds,
            Observable::DissipatedDamping,
        ]
        .map(size);
        let within = [
            Observable::KineticEnergy,
            Observable::RotaryEnergy,
            Observable::AxialEnergy,
            Observable::BendingEnergy,
        ]
        .map(size);
        Self {
            stored: followed.largest_stored,
            put_in: followed.largest_input,
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
        let (moved, which, size): (&[Interest], usize, f64) = match wide >= ALONG * long {
            true => (&[Interest::LargestU1, Interest::TipAngle], 0, wide),
            false => (&[Interest::LargestU3], 1, long),
        };
        // a tip that hardly turns while the beam moves says nothing of it
        let turned = (angle * self.floors.length / (SLOPED * wide)).min(1.0);
        let moved = rows.iter().filter(|row| moved.contains(&row.name)).cloned();
        let moved = moved.map(|row| match row.name {
            Interest::TipAngle => row.times(turned),
            _ => row,
        });
        let Some(most) = moved.max_by(|a, b| a.total().total_cmp(&b.total())) else {
            return;
        };
        let stored = self.stored[which] * size * size;
        let turbines = quantities.contains_key(Interest::HarvestedEnergy.name());
        for name in [Interest::InputEnergy, Interest::HarvestedEnergy] {
            let Some(quantity) = quantities.get(name.name()) else {
                continue;
            };
            let size = quantity.last.map_or(0.0, f64::abs);
            // beside what is stored, so little is the rounding error of works that cancel
            if !self.counts(name, size, quantities) || size < NOTHING * work.stored {
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
            // what was stored and came back was as wrong as what is left, and what the balance leaves open was lost by steps where
            // most came back; what is harvested does not come back, and is a small part of what the balance is about
            let largest = quantity.size();
            let counted = (REMAINDER * work.put_in..BACK * work.put_in).contains(&largest);
            let (came_back, open) = match name {
                Interest::InputEnergy => (
                    (work.stored / largest).clamp(1.0, MOST_BACK),
                    quantity.final_error.filter(|_| counted).unwrap_or(0.0) * size / largest,
                ),
                _ => (1.0, 0.0),
            };
            // what follows its loads comes back as it went in
            let follows = at_rest.min(errors[1]);
            let [time, space] =
                [errors[0] * came_back, follows + (errors[1] - follows) * came_back].map(|x| SQUARED * x);
            rows.push(Row {
                name,
                errors: [time.max(open), space + (CURVED - SQUARED) * at_rest],
                phase: SQUARED * came_back * phase,
                couple: SQUARED * moved * most.couple,
                ..most
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::floors::Floors;

    /// Goal: what the balance leaves open of the energy put in is in its estimate (a run of 769 s was off by 5.5 % and told 4 %, with
    /// 2.4 % open), but not where the energy is what remains of a thousand times as much that came back.
    #[test]
    fn what_the_balance_leaves_open_is_estimated() {
        let estimator = Estimator {
            floors: Floors {
                length: 1.0,
                ..Floors::default()
            },
            ..Estimator::default()
        };
        let input = Quantity {
            last: Some(2.0),
            final_error: Some(0.07),
            ..Quantity::default()
        };
        let quantities = BTreeMap::from([(Interest::InputEnergy.name().to_string(), input)]);
        let time = |put_in: f64| {
            let work = Work {
                put_in,
                ..Work::default()
            };
            let mut rows = vec![Row {
                name: Interest::LargestU1,
                errors: [0.0; 2],
                phase: 0.0,
                vibrations: 0.0,
                shift: 0.0,
                couple: 0.0,
            }];
            estimator.energies(&mut rows, &quantities, &work, [1.0, 0.0, 0.0]);
            rows[1].errors[0]
        };
        assert_eq!(time(20.0), 0.07);
        // nothing came back, or all
        assert_eq!(time(2.0), 0.0);
        assert_eq!(time(2e3), 0.0);
    }
}
