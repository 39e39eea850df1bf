//! Bound of the free vibration excited by a signal: the deviation of an oscillator from its static response.
//!
//! ```text
//! q'' + w² q = w² s,  r = q - s:   r(t) = -∫ s'(τ) cos w(t - τ) dτ,  jumps of s and of the value held before it among s'
//! ```
//! The result bounds `|r|` for all `w >= ω` and all times, in units of the signal. It is a sum over the tones
//! `g E(t) sin(W t + φ)` of the signal:
//!
//! - A start away from the value `held` before it contributes `|s(0) - held|`; an initial rate contributes `|s'(0)|/ω`.
//! - A steady slow tone, `W < 0.4 ω`: `r'' + w² r = g W² sin(W t + φ)` has the forced solution `g c sin(W t + φ)`,
//!   `c = W²/(w² - W²)`. The free vibration cancels it at the start. Together they are at most `g c (2 + W/w)`.
//! - A slow tone with an amplitude `E` that changes from 0: `s' = g Re[G e^(iWτ)]`, `|G^(k)| <= |E^(k+1)| + W |E^(k)|`.
//!   The product with `cos w(t - τ)` has the frequencies `w ± W`. After `k` integrations by parts, boundary terms and
//!   jumps of order `m` are divided by `(w - W)^(m+1)`, the remaining integral by `(w - W)^k`. At `τ = t` the two
//!   frequencies cancel to first order except for `W/(w² - W²)`. The result is the smallest bound of `k` = 0 to 3. For
//!   `W = 0` it is the bound by total variations of a signal without sines.
//! - A fast tone, `W >= 0.4 ω`, may resonate with some `w >= ω`: `g (|E| + ∫ |E'| + W ∫ |E|)`, which grows in time.

use super::interval::Bounded;
use super::tones::{Factor, Tone, ToneProduct};
use super::variation::Variation;
use crate::functions::signals::{RampShape, Signal};

/// Ratio of a tone's frequency to `ω` above which resonance is possible.
pub const NEAR: f64 = 0.4;

/// A signal prepared for evaluation at several frequencies.
#[derive(Clone, Debug)]
pub struct Excitation {
    /// `|s(0) - held|`, `|s'(0)|` and `|s''(0)|`.
    start: [f64; 3],
    tones: Vec<Part>,
}

#[derive(Clone, Debug)]
struct Part {
    gain: f64,
    omega: f64,
    envelope: Variation,
    /// `∫ |E''''| dt` between jumps.
    fourth: f64,
}

impl Excitation {
    /// Excitation by a signal until `end` [s], with the value `held` before the start.
    pub fn from_signal(signal: &Signal, end: f64, held: f64) -> Self {
        let mut breaks = vec![];
        signal.breaks(end, &mut breaks);
        let first = breaks.into_iter().filter(|t| *t > 0.0).fold(end, f64::min);
        let jet = signal.exactly(0.0, 0.5 * first);
        let part = |tone: Tone| Part {
            gain: tone.gain.abs(),
            omega: tone.omega,
            fourth: fourth(&tone.envelope),
            envelope: if tone.envelope.0.is_empty() {
                Variation {
                    size: [1.0, 0.0, 0.0, 0.0],
                    start: [1.0, 0.0, 0.0, 0.0],
                    integral: [end, 0.0, 0.0, 0.0],
                    ..Variation::default()
                }
            } else {
                Variation::up_to(&tone.envelope, end)
            },
        };
        Self {
            start: [(jet.value - held).abs(), jet.rate.abs(), jet.acceleration.abs()],
            tones: Tone::all(signal).into_iter().map(part).collect(),
        }
    }

    /// Upper bound for all angular frequencies from `omega` [1/s], in units of the signal.
    pub fn above(&self, omega: f64) -> f64 {
        let tones: f64 = self.tones.iter().map(|part| part.above(omega)).sum();
        self.start[0] + self.start[1] / omega + tones
    }

    /// Upper bound for an oscillator driven by the acceleration, in units of the signal over s².
    pub fn waves_above(&self, omega: f64) -> f64 {
        let tones: f64 = self.tones.iter().map(|part| part.waves_above(omega)).sum();
        self.start[1] * omega + self.start[2] + tones
    }

    /// True if a tone may resonate with a frequency from `omega` [1/s].
    pub fn resonates(&self, omega: f64) -> bool {
        self.tones
            .iter()
            .any(|part| part.gain > 0.0 && part.omega >= NEAR * omega)
    }
}

impl Part {
    fn above(&self, w: f64) -> f64 {
        let v = &self.envelope;
        if self.omega >= NEAR * w {
            return self.gain * (v.size[0] + v.jumps[0] + v.integral[1] + self.omega * v.integral[0]);
        }
        let [i1, i2, i3] = [v.integral[1], v.integral[2], v.integral[3]];
        let changing = Changing {
            size: [
                (v.size[0] + v.start[0]).min(i1 + v.jumps[0]),
                v.size[1],
                v.size[2],
                v.size[3],
            ],
            start: [v.start[1], v.start[2], v.start[3]],
            jumps: v.jumps,
            integral: [i1, i2, i3, self.fourth],
            around: v.integral[0],
        };
        self.gain * (self.steady(w) + changing.above(self.omega, w))
    }

    /// `(E e^(iWt))'' = (E'' + 2 i W E' - W² E) e^(iWt)`: the last term as above, the others by bounds of `E''` and
    /// `E'`.
    fn waves_above(&self, w: f64) -> f64 {
        let (v, big) = (&self.envelope, self.omega);
        let [i0, i1, i2, i3] = v.integral;
        let [j0, j1, j2, j3] = v.jumps;
        let [_, e1, e2, e3] = v.size;
        let kicks = w * j1 + if j0 > 0.0 { f64::INFINITY } else { 0.0 };
        if big >= NEAR * w {
            let all = i3 + 3.0 * big * i2 + 3.0 * big * big * i1 + big.powi(3) * i0;
            return self.gain * (big * big * v.size[0] + 2.0 * big * e1 + e2 + j2 + 3.0 * big * j1 + kicks + all);
        }
        let both = |a: f64, b: f64| a + 2.0 * big * b;
        let rest = Changing {
            size: [both(e2, e1), both(e3, e2), f64::INFINITY, f64::INFINITY],
            start: [both(v.start[3], v.start[2]), f64::INFINITY, f64::INFINITY],
            jumps: [both(j2, j1), both(j3, j2), f64::INFINITY, f64::INFINITY],
            integral: [both(i3, i2), both(self.fourth, i3), f64::INFINITY, f64::INFINITY],
            around: both(i2, i1),
        };
        let begins = both(v.start[2], v.start[1]);
        kicks + big * big * self.above(w) + self.gain * (begins + rest.above(big, w))
    }

    /// Contribution of a slow tone with the constant amplitude at its start.
    fn steady(&self, w: f64) -> f64 {
        let big = self.omega;
        big * big / (w * w - big * big) * (2.0 + big / w) * self.envelope.start[0]
    }
}

/// An amplitude that starts from zero.
struct Changing {
    /// Largest magnitudes of value and derivatives.
    size: [f64; 4],
    /// Magnitudes of the derivatives at the start.
    start: [f64; 3],
    /// Sums of the jumps of value and derivatives.
    jumps: [f64; 4],
    /// `∫ |E^(k)|`, k = 1 to 4.
    integral: [f64; 4],
    /// `∫ |E|`.
    around: f64,
}

impl Changing {
    /// Bound at `w` for a tone of frequency `big`.
    fn above(&self, big: f64, w: f64) -> f64 {
        let ([e0, e1, e2, e3], [s1, s2, s3]) = (self.size, self.start);
        let ([j0, j1, j2, j3], [i1, i2, i3, i4]) = (self.jumps, self.integral);
        if e0 == 0.0 {
            return 0.0;
        }
        let with = |of: f64, below: f64| of + if big > 0.0 { big * below } else { 0.0 };
        let (near, beat) = (w - big, w / (w * w - big * big));
        let forced = big * big / (w * w - big * big);
        let first = j0 + forced * e0 + with(0.0, e1) * beat / w + s1 * (1.0 / near - 1.0 / w) + with(j1, j0) * beat;
        let second = first + with(e2 + s2 + j2, e1 + s1 + j1) / (near * near);
        let third = second + with(e3 + s3 + j3 + i4, e2 + s2 + j2 + i3) / near.powi(3);
        let bounds = [
            with(j0 + i1, self.around),
            first + with(i2, i1) * beat,
            second + with(i3, i2) / (near * near),
            third,
        ];
        bounds.into_iter().filter(|b| !b.is_nan()).fold(f64::INFINITY, f64::min)
    }
}

/// `∫ |E''''| dt` between jumps; infinite if unknown.
fn fourth(envelope: &ToneProduct) -> f64 {
    match envelope.0.as_slice() {
        [] => 0.0,
        [Factor::Start(ramp)] => 180.0 / ramp.duration_s.powi(3),
        [Factor::Given(signal)] => fourth_of(signal),
        _ => f64::INFINITY,
    }
}

/// The third derivative of a smooth step varies from 60 to -30 and back; that of a logistic step has a total variation
/// of 5/12.
fn fourth_of(signal: &Signal) -> f64 {
    match signal {
        Signal::Constant(_) | Signal::Table(_) => 0.0,
        Signal::Ramp(ramp) if ramp.shape == RampShape::Linear || ramp.duration_s <= 0.0 => 0.0,
        Signal::Ramp(ramp) => 180.0 * (ramp.to - ramp.from).abs() / ramp.duration_s.powi(3),
        Signal::Sigmoid(sigmoid) => 5.0 / 12.0 * sigmoid.amplitude.abs() * sigmoid.steepness_per_s.abs().powi(3),
        Signal::Polynomial(polynomial) if polynomial.coefficients.len() <= 4 => 0.0,
        Signal::Sum(terms) => terms.iter().map(fourth_of).sum(),
        Signal::Product(factors) => match factors.as_slice() {
            [one] => fourth_of(one),
            _ => f64::INFINITY,
        },
        _ => f64::INFINITY,
    }
}
