//! A smooth piece of a profile as a sum of polynomials times waves, with integrals in closed form.

use std::f64::consts::{PI, TAU};

use super::{Polynomial, Profile, Wave};
use crate::numerics::gauss::Gauss;

/// Largest number of waves in an expanded product.
const MOST: usize = 64;

/// Coefficients of a polynomial in t, as real and imaginary parts.
type Coefficients = Vec<(f64, f64)>;

/// `Re Σ c_k(t) exp(i θ_k t)`, t in [0, 1] along the piece; all θ_k are distinct and nonnegative.
#[derive(Clone, Debug)]
pub(super) struct Waves(Vec<(f64, Coefficients)>);

impl Waves {
    /// Expands a profile between `p` and `q` without knots; none for a sum or product of too many waves.
    pub fn decompose(profile: &Profile, p: f64, q: f64) -> Option<Self> {
        let length = q - p;
        let wave = |wave: &Wave, quarter: f64| {
            // a cos(k x + φ) = Re a exp(i (k p + φ)) exp(i k (q - p) t)
            let k = TAU * wave.waves;
            let (sin, cos) = (k * p + wave.phase_rad - quarter).sin_cos();
            let mut one = Self(vec![]);
            one.add(k * length, &[(wave.amplitude * cos, wave.amplitude * sin)]);
            Some(one)
        };
        let real = |c: Vec<f64>| Some(Self(vec![(0.0, c.into_iter().map(|c| (c, 0.0)).collect())]));
        match profile {
            Profile::Constant(value) => real(vec![*value]),
            Profile::Cosine(cosine) => wave(cosine, 0.0),
            Profile::Sine(sine) => wave(sine, 0.5 * PI),
            Profile::Linear([root, tip]) => real(shifted(&[*root, tip - root], p, length)),
            Profile::Polynomial(Polynomial { coefficients }) => real(shifted(coefficients, p, length)),
            Profile::Table(table) => {
                // The cubic of the piece, from its derivatives in the middle.
                let jet = table.curve.at(0.5 * (p + q));
                let half = 0.5 * length;
                let about = [jet.value, jet.rate * half, jet.acceleration * half * half / 2.0];
                let about = [about[0], about[1], about[2], jet.jerk * half * half * half / 6.0];
                real(shifted(&about, -1.0, 2.0))
            }
            Profile::Sum(terms) => {
                let mut sum = Self(vec![]);
                for term in terms {
                    for (theta, c) in Self::decompose(term, p, q)?.0 {
                        sum.add(theta, &c);
                    }
                }
                (sum.0.len() <= MOST).then_some(sum)
            }
            Profile::Product(factors) => {
                let mut product = real(vec![1.0])?;
                for factor in factors {
                    product = product.times(&Self::decompose(factor, p, q)?);
                    if product.0.len() > MOST {
                        return None;
                    }
                }
                Some(product)
            }
        }
    }

    /// Adds `Re c(t) exp(i θ t)`.
    fn add(&mut self, theta: f64, c: &[(f64, f64)]) {
        // Re z = Re z̄
        let sign = if theta < 0.0 { -1.0 } else { 1.0 };
        let place = self.0.iter().position(|(known, _)| *known == theta.abs());
        let place = place.unwrap_or_else(|| {
            self.0.push((theta.abs(), vec![]));
            self.0.len() - 1
        });
        let sum = &mut self.0[place].1;
        sum.resize(sum.len().max(c.len()), (0.0, 0.0));
        for (sum, (re, im)) in sum.iter_mut().zip(c) {
            *sum = (sum.0 + re, sum.1 + sign * im);
        }
    }

    /// `Re A e^{iα} Re B e^{iβ} = Re [A B e^{i(α+β)} + A B̄ e^{i(α-β)}]/2`
    fn times(&self, other: &Self) -> Self {
        let mut product = Self(vec![]);
        for (alpha, a) in &self.0 {
            for (beta, b) in &other.0 {
                for sign in [1.0, -1.0] {
                    let mut c = vec![(0.0, 0.0); (a.len() + b.len()).saturating_sub(1)];
                    for (i, a) in a.iter().enumerate() {
                        for (j, b) in b.iter().enumerate() {
                            let (re, im) = times(*a, (0.5 * b.0, 0.5 * sign * b.1));
                            c[i + j] = (c[i + j].0 + re, c[i + j].1 + im);
                        }
                    }
                    product.add(alpha + sign * beta, &c);
                }
            }
        }
        product
    }

    /// `∫ f dt`, `∫ f t dt` and `∫ f t^2 dt` over [0, 1].
    pub fn moments(&self) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (theta, c) in &self.0 {
            for (power, sum) in sum.iter_mut().enumerate() {
                let mut c = c.clone();
                c.splice(0..0, std::iter::repeat_n((0.0, 0.0), power));
                *sum += integral(*theta, &c);
            }
        }
        sum
    }
}

/// `Re ∫ c(t) e^{iθt} dt` over [0, 1]. For waves short against the polynomial, by parts, a finite sum:
///
/// ```text
/// ∫ c e^{iθt} = [e^{iθt} (c/(iθ) - c'/(iθ)² + c''/(iθ)³ - ..)]
/// ```
///
/// Otherwise by Gauss quadrature on half waves.
fn integral(theta: f64, c: &[(f64, f64)]) -> f64 {
    let degree = c.len().saturating_sub(1);
    if theta > (2 * degree * degree).max(64) as f64 {
        let mut derivative = c.to_vec();
        let (sin, cos) = theta.sin_cos();
        // 1/(iθ)
        let mut factor = (0.0, -1.0 / theta);
        let mut sum = 0.0;
        while let Some(&first) = derivative.first() {
            let last = derivative.iter().fold((0.0, 0.0), |s, c| (s.0 + c.0, s.1 + c.1));
            let turned = times(last, (cos, sin));
            sum += times((turned.0 - first.0, turned.1 - first.1), factor).0;
            factor = times(factor, (0.0, 1.0 / theta));
            derivative = derivative
                .iter()
                .enumerate()
                .skip(1)
                .map(|(k, c)| (k as f64 * c.0, k as f64 * c.1))
                .collect();
        }
        return sum;
    }
    let parts = (theta / PI).ceil().max(1.0);
    let rule = Gauss::new(degree / 2 + 12);
    let mut sum = 0.0;
    for k in 0..parts as usize {
        for (t, weight) in rule.on(k as f64 / parts, (k as f64 + 1.0) / parts) {
            let value = c.iter().rev().fold((0.0, 0.0), |v, c| (v.0 * t + c.0, v.1 * t + c.1));
            let (sin, cos) = (theta * t).sin_cos();
            sum += weight * (value.0 * cos - value.1 * sin);
        }
    }
    sum
}

fn times(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

/// Coefficients in t of a polynomial in `x = p + length t`, by Horner's scheme.
fn shifted(coefficients: &[f64], p: f64, length: f64) -> Vec<f64> {
    let mut out: Vec<f64> = vec![];
    for c in coefficients.iter().rev() {
        // out = out (p + length t) + c
        let mut next = vec![0.0; out.len() + 1];
        for (k, o) in out.iter().enumerate() {
            next[k] += o * p;
            next[k + 1] += o * length;
        }
        next[0] += c;
        out = next;
    }
    out
}
