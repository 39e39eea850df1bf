//! Modes of a solid that relaxes, and of flow in tubes with unsteady friction.

use std::f64::consts::FRAC_1_SQRT_2;

use nalgebra::Complex;

use super::{FluidBehavior, Linearised, Mode, ModeOptions, Shapes, Tally, likeness, mode, near_to};
use crate::case::relaxation::{dynamic_modulus, vibration};
use crate::case::schema::Effect;
use crate::error::Result;
use crate::model::effects::DecisionCause;
use crate::spectral::{self, EigenvalueOptions, Pencil};

/// Numbers of pairs searched around the place where one is expected, in this order.
const AROUND: [usize; 2] = [1, 4];

/// True if there are branches of a solid that relaxes, or of unsteady friction that is not requested by name.
pub fn relaxes(about: &Linearised) -> bool {
    let system = about.system();
    let asked = system.model.effects.decision(Effect::UnsteadyFriction).cause == DecisionCause::Asked;
    !system.model.relaxation.is_empty() || (!asked && !system.layout.network.branch.is_empty())
}

/// Finds modes with branches of relaxation or unsteady friction. A relaxing branch has one decay per node, a tube with unsteady
/// friction ten, in clusters in which a search would not converge. Modes are therefore first searched with the long-term stiffness,
/// at which the branches follow at once. Each is then searched again in the full pencil near its frequency by [`vibration`].
/// Decays of the material alone are omitted; modes that are not found again are counted.
///
/// # Errors
/// Those of the first search.
pub fn search(
    about: &Linearised,
    fluid: FluidBehavior,
    [a, b]: [&[f64]; 2],
    plan: &ModeOptions,
    tally: &mut Tally,
) -> Result<Vec<Mode>> {
    let branches = &about.system().model.relaxation;
    let layout = &about.system().layout;
    let own = &layout.relaxation;
    let pattern = about.pencil().pattern;
    let mut followed = b.to_vec();
    for column in 0..pattern.columns() {
        for entry in pattern.column(column) {
            let row = pattern.rows[entry] as usize;
            if own.curvature.contains(&row) || own.stretch.contains(&row) || layout.network.branch.contains(&row) {
                followed[entry] = 0.0;
            }
        }
    }
    let target = plan.target();
    let softer = ModeOptions {
        near_hz: plan.near_hz / dynamic_modulus(branches, target.im)[0].sqrt(),
        ..*plan
    };
    let long_term = near_to(about, fluid, [a, &followed], &softer, tally)?;
    let pencil = Pencil { a, b, ..about.pencil() };
    let mut modes: Vec<Mode> = vec![];
    for expected in long_term {
        if expected.kind.stays() {
            modes.push(expected);
            continue;
        }
        let shift = match expected.kind.swings() {
            true => {
                let [frequency, decay] = vibration(branches, expected.s.im);
                Complex::new(expected.s.re - decay, frequency)
            }
            false => expected.s,
        };
        let again = AROUND.into_iter().find_map(|count| {
            let found = spectral::nearest(&pencil, shift, count, &EigenvalueOptions::default()).ok()?;
            tally.factorizations += found.factorizations;
            tally.solves += found.solves;
            let mut shapes = Shapes::new(about);
            let modes = found.pairs.iter().filter_map(|pair| mode(about, &mut shapes, pair));
            // fluid that oscillates past bladders has no shape, and the nearest mode counts
            let unseen = expected.shape.displacement() == 0.0 && expected.shape.largest_pressure() == 0.0;
            let alike = |found: &Mode| match unseen {
                true => 1.0 / (1.0 + (found.s - shift).norm() / shift.norm()),
                false => likeness(&found.shape, &expected.shape),
            };
            modes
                .filter(|found| found.kind.swings() == expected.kind.swings())
                .max_by(|a, b| alike(a).total_cmp(&alike(b)))
                .filter(|found| alike(found) > FRAC_1_SQRT_2)
        });
        match again {
            Some(found) => modes.push(found),
            None => tally.lost += 1,
        }
    }
    modes.sort_by(|a, b| (a.s - target).norm().total_cmp(&(b.s - target).norm()));
    Ok(modes)
}
