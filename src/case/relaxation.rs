//! Branches of a viscoelastic solid, from the values of a case.

use std::f64::consts::TAU;

use nalgebra::{Complex, DMatrix, DVector};

use super::schema::{Branch, LossFactor, Viscoelasticity};

/// Branches per decade of a loss factor's band, and decades by which the branches extend beyond each of its ends.
const PER_DECADE: f64 = 2.0;
const BEYOND: f64 = 0.5;
/// Number of fitted frequencies per branch.
const FITTED: usize = 20;
/// Largest accepted relative error of a loss factor.
const GOOD: f64 = 0.02;

impl Viscoelasticity {
    /// Branches of the solid; none if no series has this loss factor.
    pub fn branches(&self) -> Option<Vec<Branch>> {
        match &self.loss_factor {
            None => Some(self.prony.clone()),
            Some(loss_factor) => loss_factor.branches(),
        }
    }
}

impl LossFactor {
    /// `[E57]` Branches whose loss factor is constant to 2 % over the band: with relaxation times spaced evenly in log τ,
    ///
    /// ```text
    /// Σ g_k (x_k - η x_k²)/(1 + x_k²) = η        x_k = ω τ_k
    /// ```
    ///
    /// is solved by least squares over log ω. None if a spring would have negative stiffness, from a loss factor of about 0.5 on.
    fn branches(&self) -> Option<Vec<Branch>> {
        let decades = (self.to_hz / self.from_hz).log10();
        let count = ((decades + 2.0 * BEYOND) * PER_DECADE).ceil() as usize + 1;
        let spread =
            |low: f64, decades: f64, k: usize, of: usize| low * 10_f64.powf(decades * k as f64 / (of - 1) as f64);
        let slowest = self.from_hz * 10_f64.powf(-BEYOND);
        let times: Vec<f64> = (0..count)
            .map(|k| 1.0 / (TAU * spread(slowest, decades + 2.0 * BEYOND, k, count)))
            .collect();
        let fitted = FITTED * count;
        let omegas: Vec<f64> = (0..fitted)
            .map(|k| TAU * spread(self.from_hz, decades, k, fitted))
            .collect();
        let matrix = DMatrix::from_fn(fitted, count, |i, k| {
            let x = omegas[i] * times[k];
            (x - self.value * x * x) / (1.0 + x * x)
        });
        let ratios = matrix
            .svd(true, true)
            .solve(&DVector::from_element(fitted, self.value), 1e-14);
        let ratios = ratios.ok().filter(|ratios| ratios.iter().all(|&g| g > 0.0))?;
        let branches: Vec<Branch> = ratios
            .iter()
            .zip(times)
            .map(|(&modulus_ratio, time_s)| Branch { modulus_ratio, time_s })
            .collect();
        let good = |&omega: &f64| {
            let [storage, loss] = dynamic_modulus(&branches, omega);
            (loss / storage / self.value - 1.0).abs() <= GOOD
        };
        omegas.iter().all(good).then_some(branches)
    }
}

/// Storage and loss modulus at an angular frequency [1/s], relative to the long-term modulus: `1 + Σ g x²/(1 + x²)`, `Σ g x/(1 + x²)`, x =
/// ω τ.
pub fn dynamic_modulus(branches: &[Branch], omega: f64) -> [f64; 2] {
    branches.iter().fold([1.0, 0.0], |[storage, loss], branch| {
        let x = omega * branch.time_s;
        // 1/(1/x + x) neither overflows nor divides by zero
        let share = branch.modulus_ratio / (1.0 / x + x);
        [storage + share * x, loss + share]
    })
}

/// Angular frequency and decay rate [1/s] of a vibration whose long-term frequency is ω: the root of
///
/// ```text
/// s² + ω² (1 + Σ g s τ/(1 + s τ)) = 0
/// ```
///
/// If no root is found near the frequency from the storage modulus alone, returns that frequency without decay, which is on the safe side.
pub fn vibration(branches: &[Branch], omega: f64) -> [f64; 2] {
    if branches.is_empty() {
        return [omega, 0.0];
    }
    // storage grows with frequency: the iteration converges from below
    let stored = (0..SETTLED).fold(omega, |at, _| omega * dynamic_modulus(branches, at)[0].sqrt());
    let one = Complex::new(1.0, 0.0);
    let mut s = Complex::new(0.0, stored);
    for _ in 0..SETTLED {
        let (mut stiffness, mut slope) = (one, Complex::new(0.0, 0.0));
        for &Branch { modulus_ratio, time_s } in branches {
            let relaxing = one + s * time_s;
            stiffness += s * (modulus_ratio * time_s) / relaxing;
            slope += (relaxing * relaxing).inv() * (modulus_ratio * time_s);
        }
        s -= (s * s + stiffness * omega * omega) / (s * 2.0 + slope * omega * omega);
    }
    let near = (0.5..2.0).contains(&(s.im / stored)) && s.re <= 0.0;
    if near { [s.im, -s.re] } else { [stored, 0.0] }
}

/// Number of steps of iterations that converge in a few.
const SETTLED: usize = 20;
