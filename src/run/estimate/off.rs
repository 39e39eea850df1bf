//! Errors of a figure by the phases of several modes.

use super::vibration::{Place, Vibration};

/// Part of a displacement's error that is seen at an instant, on average over phases.
const SEEN: f64 = 0.7;
/// How much more than the last mode that is followed all beyond it are in errors by steps: their shares fall with the fourth power
/// of the wave number.
const BEYOND: f64 = 2.0;

/// Errors of a figure, in its unit.
#[derive(Clone, Copy, Debug, Default)]
pub struct Off {
    /// By steps and by the mesh.
    pub errors: [f64; 2],
    /// Of all modes but the one that swings most, and of those that are driven: how they meet, and how near they are to what drives
    /// them, makes the largest values.
    pub peaks: f64,
    /// Vibrations of the mode that does most.
    pub vibrations: f64,
    /// Its shift [rad].
    pub shift: f64,
    /// What it does.
    most: f64,
}

impl Off {
    /// Of what the modes do at a place. Phases of modes are nobody's: their errors add like squares.
    pub fn of(modes: &[Vibration], place: Place) -> Self {
        let mut all = Self::default();
        let swing = |mode: &Vibration| mode.places[place as usize].abs() * mode.amplitude();
        let widest = (0..modes.len()).max_by(|a, b| swing(&modes[*a]).total_cmp(&swing(&modes[*b])));
        for (k, mode) in modes.iter().enumerate() {
            let [time, space] = mode.off().map(|x| SEEN * mode.places[place as usize].abs() * x);
            let time = if k + 1 == modes.len() { BEYOND * time } else { time };
            all.errors = [all.errors[0].hypot(time), all.errors[1].hypot(space)];
            if Some(k) != widest || mode.driven {
                all.peaks = all.peaks.hypot(time + space);
            }
            if time + space > all.most {
                let [steps, mesh, turned] = mode.turned;
                (all.vibrations, all.shift) = (turned / std::f64::consts::TAU, steps.abs() + mesh.abs());
                all.most = time + space;
            }
        }
        all
    }

    /// Times a factor.
    pub fn times(mut self, factor: f64) -> Self {
        self.errors = self.errors.map(|x| factor * x);
        self.most *= factor;
        self.peaks *= factor;
        self
    }

    /// With those of other modes.
    pub fn and(self, other: Self) -> Self {
        let errors = [0, 1].map(|k| self.errors[k].hypot(other.errors[k]));
        let most = if self.most >= other.most { self } else { other };
        Self {
            errors,
            peaks: self.peaks.hypot(other.peaks),
            ..most
        }
    }
}
