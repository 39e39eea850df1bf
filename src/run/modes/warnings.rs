//! Warnings about modes.

use super::{Modes, meshes};
use crate::case::schema::Effect;
use crate::error::Code;
use crate::error::numbers::significant;

/// Error of a tube's impedance above which a warning is given.
const FORGOTTEN: f64 = 0.01;

impl Modes {
    /// Warnings about the modes; `about` describes the state. Only comparisons that were made are included.
    pub fn warnings(&self, about: &str) -> Vec<String> {
        let state = &self.about;
        let moving = state.moving().then(|| {
            Code::NotAtRest.warning(format!(
                "{about} is no equilibrium under the loads at t = {} s: unknowns would change at up to {} of their \
                 size per second. The modes are those of the state held fixed.",
                state.at,
                significant(state.rate, 3)
            ))
        });
        let by_mesh = meshes::warning(self).into_iter().chain(self.forgotten());
        moving
            .into_iter()
            .chain(state.range.iter().cloned())
            .chain(by_mesh)
            .chain(self.missing())
            .chain(self.beside())
            .collect()
    }

    /// Warns of missing modes of a solid that relaxes, if there are any.
    pub fn missing(&self) -> Option<String> {
        (self.lost > 0).then(|| {
            Code::LostModes.warning(format!(
                "{} of the long-term modes of the beam were not found again with its relaxation. They are damped too \
                 strongly to oscillate, or lie far from their expected frequency.",
                self.lost
            ))
        })
    }

    /// Warns of omitted decays of a cluster, if there is one.
    pub fn beside(&self) -> Option<String> {
        self.clustered.then(|| {
            Code::LostModes.warning(
                "many decays have nearly the same rate, as those of an overdamped solid, and the search does not \
                 converge among them. Decays beyond the first ones are not listed, and oscillations beyond were \
                 searched along the imaginary axis. Use fewer cells or --near to list more.",
            )
        })
    }

    /// Warns if Poiseuille's friction in tubes is inaccurate for the fastest oscillation: error of the impedance `Wo⁴/1152`.
    pub fn forgotten(&self) -> Option<String> {
        let model = &self.about.system().model;
        let has = |effect| model.effects.has(effect);
        if !has(Effect::TubeInertia) || has(Effect::UnsteadyFriction) {
            return None;
        }
        let tubes = model.wet.iter().flat_map(|wet| &wet.network.links);
        let rates = tubes.filter_map(|link| Some(link.tube.as_ref()?.viscous_rate));
        let along = model.wet.iter().filter_map(|wet| wet.network.along_bladders.as_ref());
        let rates = rates.chain(along.map(|along| along.viscous_rate));
        let slowest = rates.fold(f64::INFINITY, f64::min);
        let swinging = self.modes.iter().filter(|mode| mode.kind.swings());
        let womersley = swinging
            .map(|mode| (mode.s.im.abs() / slowest).sqrt())
            .fold(0.0, f64::max);
        (womersley.powi(4) / 1152.0 > FORGOTTEN).then(|| {
            Code::FastFlow.warning(format!(
                "fluid friction is that of steady velocity profiles, although Womersley numbers reach {womersley:.1}: \
                 frequencies and damping of modes that move much fluid are inaccurate. Use --set \
                 '/effects/unsteady_friction=\"on\"', which adds decays of its own."
            ))
        })
    }
}
