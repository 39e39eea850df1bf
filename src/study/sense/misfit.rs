//! Goodness of fit: compares the residuals of measured pressures with their noise.

use crate::numerics::normal;
use crate::numerics::student_t::log_gamma;

/// Significance level of the upper and lower chi-square tests.
const UNLIKELY: f64 = 1e-3;
/// Residuals over noise below which the pressures come from the model itself, or all are 0.
const EXACT: f64 = 1e-12;
/// Residuals over noise below which the given noise may be too large.
const LITTLE: f64 = 0.1;

/// Residuals of all values.
#[derive(Clone, Copy, Debug)]
pub struct Misfit {
    /// Sum of the squared residuals over the given noise.
    pub data: f64,
    /// Roughness of the loads over its prior deviation, squared and summed.
    pub rough: f64,
    /// Number of values.
    pub values: usize,
    /// Degrees of freedom of `data + rough`: number of values less that of fitted parameters.
    pub freedom: f64,
    /// True if smoothing was chosen by the discrepancy principle; the roughness then is not chi-square distributed.
    pub by_discrepancy: bool,
}

impl Misfit {
    /// Sum of data misfit and roughness.
    pub fn sum(&self) -> f64 {
        self.data + self.rough
    }

    /// The chi-square statistic of a good fit, and its degrees of freedom.
    pub fn judged(&self) -> [f64; 2] {
        match self.by_discrepancy {
            true => [self.data, self.values as f64],
            false => [self.sum(), self.freedom],
        }
    }

    /// Residuals over noise, root mean square over the degrees of freedom, if they exceed the 99.9 % quantile.
    pub fn beyond_chance(&self) -> Option<f64> {
        let [sum, f] = self.judged();
        if f < 0.5 {
            return None;
        }
        // Wilson-Hilferty approximation of the chi-square quantile
        let share = 2.0 / (9.0 * f);
        let limit = f * (1.0 - share - normal::quantile(UNLIKELY) * share.sqrt()).powi(3);
        (sum > limit).then(|| (sum / f).sqrt())
    }

    /// Residuals over noise, root mean square, if they are below a tenth of the noise and below the 0.1 % quantile.
    pub fn below_chance(&self) -> Option<f64> {
        let [sum, f] = self.judged();
        let share = (sum / f).sqrt();
        if f < 0.5 || !(share > EXACT && share < LITTLE) {
            return None;
        }
        // upper bound of the chi-square distribution at x: (x/2)^(f/2)/Γ(1 + f/2)
        let chance = 0.5 * f * (0.5 * sum).ln() - log_gamma(1.0 + 0.5 * f);
        (chance < UNLIKELY.ln()).then_some(share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn misfit(data: f64, rough: f64, by_discrepancy: bool) -> Misfit {
        Misfit {
            data,
            rough,
            values: 5,
            freedom: 3.0,
            by_discrepancy,
        }
    }

    /// Source: tables of chi-square: 99.9 % lie below 16.27 on 3 degrees of freedom, below 20.52 on 5. Tolerance: Wilson-Hilferty
    /// approximation, 1 %.
    #[test]
    fn one_in_a_thousand_is_beyond_chance() {
        assert!(misfit(16.0, 0.0, false).beyond_chance().is_none());
        let beyond = misfit(10.0, 6.6, false).beyond_chance();
        assert_eq!(beyond, Some((16.6_f64 / 3.0).sqrt()));
        // by discrepancy the residuals remain as large as the noise, at any roughness
        assert!(misfit(5.0, 40.0, true).beyond_chance().is_none());
        assert!(misfit(20.8, 0.0, true).beyond_chance().is_some());
    }

    /// Source: tables of chi-square: 0.1 % lie below 0.0243 on 3 degrees of freedom. Goal: detects noise given in kilopascals instead of
    /// pascals, but neither half of the noise nor exact data.
    #[test]
    fn far_less_than_the_noise_is_told() {
        assert!(misfit(0.0247, 0.0, false).below_chance().is_none());
        assert_eq!(misfit(0.024, 0.0, false).below_chance(), Some((0.024_f64 / 3.0).sqrt()));
        assert!(misfit(3e-6, 0.0, false).below_chance().is_some());
        assert!(misfit(0.75, 0.0, false).below_chance().is_none() && misfit(0.0, 0.0, false).below_chance().is_none());
    }
}
