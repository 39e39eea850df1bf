//! Decomposition of a signal into sines with time-dependent amplitudes: `s = Σ g E(t) sin(W t + φ)`. `E` is a product
//! of factors without sines. A term without sine has `W = 0` and `φ = π/2`.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::interval::{Bounded, JetSpan};
use super::search::{IntervalSearch, sizes};
use crate::functions::jet::{Jet, SmoothTime};
use crate::functions::signals::{Ramp, RampShape, Signal};

/// Largest number of tones; products with more are not expanded.
const MOST_TONES: usize = 64;

/// A factor of an envelope.
#[derive(Clone, Debug)]
pub enum Factor<'a> {
    /// A signal.
    Given(&'a Signal),
    /// The smooth start of a sine.
    Start(Ramp),
}

/// `g E(t) sin(W t + φ)`.
#[derive(Clone, Debug)]
pub struct Tone<'a> {
    /// Constant factor `g`.
    pub gain: f64,
    /// Angular frequency `W` [1/s], not negative.
    pub omega: f64,
    /// Phase `φ` [rad].
    pub phase: f64,
    /// Envelope `E`; 1 if empty.
    pub envelope: ToneProduct<'a>,
}

/// A product of factors.
#[derive(Clone, Debug, Default)]
pub struct ToneProduct<'a>(pub Vec<Factor<'a>>);

impl<'a> Tone<'a> {
    fn steady(gain: f64) -> Self {
        Self {
            gain,
            omega: 0.0,
            phase: FRAC_PI_2,
            envelope: ToneProduct::default(),
        }
    }

    /// Returns all tones of a signal.
    pub fn all(signal: &'a Signal) -> Vec<Self> {
        match signal {
            Signal::Constant(value) => vec![Self::steady(*value)],
            Signal::Sine(sine) if sine.frequency_hz <= 0.0 && sine.ramp_cycles > 0.0 => vec![],
            Signal::Sine(sine) if sine.frequency_hz <= 0.0 => vec![Self::steady(sine.amplitude * sine.phase_rad.sin())],
            Signal::Sine(sine) => {
                let start = Ramp {
                    from: 0.0,
                    to: 1.0,
                    start_s: 0.0,
                    duration_s: sine.ramp_cycles / sine.frequency_hz,
                    shape: RampShape::Smooth,
                };
                let start = (sine.ramp_cycles > 0.0).then_some(Factor::Start(start));
                vec![Self {
                    gain: sine.amplitude,
                    omega: TAU * sine.frequency_hz,
                    phase: sine.phase_rad,
                    envelope: ToneProduct(start.into_iter().collect()),
                }]
            }
            Signal::Sum(terms) => terms.iter().flat_map(Self::all).collect(),
            Signal::Product(factors) if factors.iter().any(has_sines) => {
                let mut all = vec![Self::steady(1.0)];
                for factor in factors {
                    let parts = match factor {
                        Signal::Sum(_) if !has_sines(factor) => vec![Self::slow(factor)],
                        _ => Self::all(factor),
                    };
                    if all.len() * parts.len() > MOST_TONES {
                        return vec![Self::slow(signal)];
                    }
                    all = all.iter().flat_map(|a| parts.iter().flat_map(|b| a.times(b))).collect();
                }
                all
            }
            other => vec![Self::slow(other)],
        }
    }

    /// Tone of a signal without sines.
    fn slow(signal: &'a Signal) -> Self {
        Self {
            envelope: ToneProduct(vec![Factor::Given(signal)]),
            ..Self::steady(1.0)
        }
    }

    /// `sin a sin b = (cos(a - b) - cos(a + b))/2`.
    fn times(&self, other: &Self) -> Vec<Self> {
        let factors = self.envelope.0.iter().chain(&other.envelope.0).cloned();
        let envelope = ToneProduct(factors.collect());
        let gain = self.gain * other.gain;
        let tone = |gain: f64, omega: f64, phase: f64| match omega {
            // sin(-x) = sin(x + π); a sine of zero frequency is a number
            0.0 => Self {
                gain: gain * phase.sin(),
                envelope: envelope.clone(),
                ..Self::steady(1.0)
            },
            _ => Self {
                gain,
                omega: omega.abs(),
                phase: if omega > 0.0 { phase } else { 2.0 * FRAC_PI_2 - phase },
                envelope: envelope.clone(),
            },
        };
        match (self.omega, other.omega) {
            (0.0, 0.0) => vec![tone(gain * self.phase.sin() * other.phase.sin(), 0.0, FRAC_PI_2)],
            (0.0, omega) => vec![tone(gain * self.phase.sin(), omega, other.phase)],
            (omega, 0.0) => vec![tone(gain * other.phase.sin(), omega, self.phase)],
            (a, b) => vec![
                tone(0.5 * gain, a - b, self.phase - other.phase + FRAC_PI_2),
                tone(-0.5 * gain, a + b, self.phase + other.phase + FRAC_PI_2),
            ],
        }
    }
}

/// A constant, and bounds of value and derivatives of the rest, from the sum of the magnitudes of all tones. Many
/// cycles of sines without common period come close to these bounds.
pub fn together(signal: &Signal, from: f64, to: f64) -> (f64, [f64; 4]) {
    const BINOMIAL: [[f64; 4]; 4] = [
        [1.0, 0.0, 0.0, 0.0],
        [1.0, 1.0, 0.0, 0.0],
        [1.0, 2.0, 1.0, 0.0],
        [1.0, 3.0, 3.0, 1.0],
    ];
    let (mut offset, mut most) = (0.0, [0.0; 4]);
    for tone in Tone::all(signal) {
        if tone.omega == 0.0 && tone.envelope.0.is_empty() {
            offset += tone.gain * tone.phase.sin();
            continue;
        }
        let envelope = if tone.envelope.0.is_empty() {
            [1.0, 0.0, 0.0, 0.0]
        } else {
            sizes(&IntervalSearch::new(&tone.envelope, from, to)).0
        };
        for (k, most) in most.iter_mut().enumerate() {
            let terms = (0..=k).filter(|j| envelope[*j] > 0.0);
            let sum: f64 = terms
                .map(|j| BINOMIAL[k][j] * envelope[j] * tone.omega.powi((k - j) as i32))
                .sum();
            *most += tone.gain.abs() * sum;
        }
    }
    (offset, most)
}

/// True if the signal contains a sine.
fn has_sines(signal: &Signal) -> bool {
    match signal {
        Signal::Sine(sine) => sine.frequency_hz > 0.0,
        Signal::Sum(parts) | Signal::Product(parts) => parts.iter().any(has_sines),
        _ => false,
    }
}

impl Bounded for ToneProduct<'_> {
    fn exactly(&self, t: f64, within: f64) -> Jet {
        let jets = self.0.iter().map(|factor| match factor {
            Factor::Given(signal) => signal.exactly(t, within),
            Factor::Start(ramp) => ramp.jet(SmoothTime { t, within }),
        });
        jets.reduce(|a, b| a * b).unwrap_or(Jet::constant(1.0))
    }

    fn span(&self, from: f64, to: f64) -> JetSpan {
        let spans = self.0.iter().map(|factor| match factor {
            Factor::Given(signal) => signal.span(from, to),
            Factor::Start(ramp) => ramp.span(from, to),
        });
        JetSpan::product(spans)
    }

    fn is_elementary(&self) -> bool {
        match self.0.as_slice() {
            [] | [Factor::Start(_)] => true,
            [Factor::Given(one)] => one.is_elementary(),
            _ => false,
        }
    }

    fn parted(&self, to: f64, out: &mut Vec<f64>) {
        for factor in &self.0 {
            match factor {
                Factor::Given(signal) => signal.breaks(to, out),
                Factor::Start(ramp) => out.push(ramp.duration_s),
            }
        }
    }

    fn joined(&self, to: f64, out: &mut Vec<f64>) {
        for factor in &self.0 {
            match factor {
                Factor::Given(signal) => signal.joined(to, out),
                Factor::Start(ramp) => out.push(ramp.duration_s),
            }
        }
    }

    fn crests(&self, from: f64, to: f64, visit: &mut dyn FnMut(f64)) {
        for factor in &self.0 {
            if let Factor::Given(signal) = factor {
                signal.crests(from, to, visit);
            }
        }
    }
}
