//! Whether what loads leave of measured pressures is their noise.

use crate::numerics::normal;
use crate::numerics::student::log_gamma;

/// Chance of a sum of squares above which the loads do not explain the data, and of one below which the noise is none of theirs.
const UNLIKELY: f64 = 1e-3;
/// The same below which pressures are those of the model itself, computed or all 0.
const EXACT: f64 = 1e-12;
/// Share of the noise that is left, from which on it is said to be too little.
const LITTLE: f64 = 0.1;

/// What is left of all values.
#[derive(Clone, Copy, Debug)]
pub struct Misfit {
    /// Sum of the squares of what is left of the values, over the noise that was given.
    pub data: f64,
    /// What the roughness of the loads adds, over what was known of it.
    pub rough: f64,
    /// Values.
    pub values: usize,
    /// Degrees of freedom of both together: values less what was taken from them.
    pub freedom: f64,
    /// Whether smoothing was chosen so that the values keep just their noise: roughness then is no draw of what was known.
    pub by_discrepancy: bool,
}

impl Misfit {
    /// Both together.
    pub fn sum(&self) -> f64 {
        self.data + self.rough
    }

    /// The sum that is chi-square where the loads explain the data, and its degrees of freedom.
    pub fn judged(&self) -> [f64; 2] {
        match self.by_discrepancy {
            true => [self.data, self.values as f64],
            false => [self.sum(), self.freedom],
        }
    }

    /// How many times the noise is left, root mean square over the degrees of freedom, where that is more than chance explains: one
    /// time in a thousand.
    pub fn beyond_chance(&self) -> Option<f64> {
        let [sum, f] = self.judged();
        if f < 0.5 {
            return None;
        }
        // Wilson and Hilferty's quantile of the sum of squares
        let share = 2.0 / (9.0 * f);
        let limit = f * (1.0 - share - normal::quantile(UNLIKELY) * share.sqrt()).powi(3);
        (sum > limit).then(|| (sum / f).sqrt())
    }

    /// The same where what is left is less than a tenth of the noise, and than chance explains: one time in a thousand.
    pub fn below_chance(&self) -> Option<f64> {
        let [sum, f] = self.judged();
        let share = (sum / f).sqrt();
        if f < 0.5 || !(share > EXACT && share < LITTLE) {
            return None;
        }
        // the chance of a sum below x is at most (x/2)^(f/2)/Γ(1 + f/2)
        let chance = 0.5 * f * (0.5 * sum).ln() - log_gamma(1.0 + 0.5 * f);
        (chance < UNLIKELY.ln()).then_some(share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(data: f64, rough: f64, by_discrepancy: bool) -> Misfit {
        Misfit {
            data,
            rough,
            values: 5,
            freedom: 3.0,
            by_discrepancy,
        }
    }

    /// Source: tables of chi-square: 99.9 % lie below 16.27 on 3 degrees of freedom, below 20.52 on 5. Tolerance: Wilson and Hilferty's, 1 %.
    #[test]
    fn one_in_a_thousand_is_beyond_chance() {
        assert!(of(16.0, 0.0, false).beyond_chance().is_none());
        let beyond = of(10.0, 6.6, false).beyond_chance();
        assert_eq!(beyond, Some((16.6_f64 / 3.0).sqrt()));
        // by discrepancy the values keep their noise, whatever roughness that takes
        assert!(of(5.0, 40.0, true).beyond_chance().is_none());
        assert!(of(20.8, 0.0, true).beyond_chance().is_some());
    }

    /// Source: tables of chi-square: 0.1 % lie below 0.0243 on 3 degrees of freedom. Goal: noise in pascals that was given in kilopascals is told,
    /// half of it and none at all are not.
    #[test]
    fn far_less_than_the_noise_is_told() {
        assert!(of(0.0247, 0.0, false).below_chance().is_none());
        assert_eq!(of(0.024, 0.0, false).below_chance(), Some((0.024_f64 / 3.0).sqrt()));
        assert!(of(3e-6, 0.0, false).below_chance().is_some());
        assert!(of(0.75, 0.0, false).below_chance().is_none() && of(0.0, 0.0, false).below_chance().is_none());
    }
}
