//! Enclosures of all signal forms over a time span, by interval arithmetic on the composition.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::interval::{Bounded, Interval, JetSpan};
use crate::functions::curve::Interpolation;
use crate::functions::jet::{Jet, SmoothTime};
use crate::functions::signals::{Polynomial, Ramp, RampShape, Sigmoid, Signal, Sine, Table};

impl Bounded for Signal {
    fn exactly(&self, t: f64, within: f64) -> Jet {
        self.jet(SmoothTime { t, within })
    }

    fn span(&self, from: f64, to: f64) -> JetSpan {
        match self {
            Self::Constant(value) => JetSpan::at(Jet::constant(*value)),
            Self::Sine(sine) => sine.span(from, to),
            Self::Sigmoid(sigmoid) => sigmoid.span(from, to),
            Self::Ramp(ramp) => ramp.span(from, to),
            Self::Polynomial(polynomial) => polynomial.span(from, to),
            Self::Table(table) => table.span(from, to),
            Self::Sum(terms) => JetSpan::sum(terms.iter().map(|term| term.span(from, to))),
            Self::Product(factors) => JetSpan::product(factors.iter().map(|factor| factor.span(from, to))),
            Self::Controller(_) => JetSpan::at(self.exactly(from, from)),
        }
    }

    fn is_elementary(&self) -> bool {
        match self {
            Self::Constant(_) | Self::Sigmoid(_) | Self::Ramp(_) | Self::Table(_) | Self::Controller(_) => true,
            Self::Sine(sine) => sine.ramp_cycles <= 0.0,
            Self::Polynomial(polynomial) => polynomial.coefficients.len() < 3,
            Self::Sum(parts) | Self::Product(parts) => matches!(parts.as_slice(), [one] if one.is_elementary()),
        }
    }

    fn parted(&self, to: f64, out: &mut Vec<f64>) {
        self.breaks(to, out);
    }

    fn joined(&self, to: f64, out: &mut Vec<f64>) {
        match self {
            Self::Table(table) => table.knots_until(to, table.curve.knots(), out),
            Self::Sine(sine) if sine.ramp_cycles > 0.0 && sine.frequency_hz > 0.0 => {
                out.push(sine.ramp_cycles / sine.frequency_hz);
            }
            Self::Sum(parts) | Self::Product(parts) => parts.iter().for_each(|part| part.joined(to, out)),
            other => other.breaks(to, out),
        }
    }

    fn crests(&self, from: f64, to: f64, visit: &mut dyn FnMut(f64)) {
        match self {
            Self::Sine(sine) if sine.frequency_hz > 0.0 => {
                crests(TAU * sine.frequency_hz, sine.phase_rad, from, to, visit)
            }
            Self::Sigmoid(sigmoid) => {
                for z in [0.0, SIGMOID_ACCELERATION, -SIGMOID_ACCELERATION] {
                    let t = sigmoid.midpoint_s + z / sigmoid.steepness_per_s;
                    if from < t && t < to {
                        visit(t);
                    }
                }
            }
            Self::Sum(parts) | Self::Product(parts) => parts.iter().for_each(|part| part.crests(from, to, visit)),
            _ => {}
        }
    }
}

/// First and last extremum and zero of `sin(ω t + φ)` in `[from, to]`.
pub fn crests(omega: f64, phase: f64, from: f64, to: f64, visit: &mut dyn FnMut(f64)) {
    for quarter in [0.0, FRAC_PI_2] {
        let first = ((omega * from + phase - quarter) / PI).ceil();
        let last = ((omega * to + phase - quarter) / PI).floor();
        if first <= last {
            visit((first * PI + quarter - phase) / omega);
            visit((last * PI + quarter - phase) / omega);
        }
    }
}

/// Range of `sin` over `[p, q]`.
fn sines(p: f64, q: f64) -> Interval {
    let holds = |crest: f64| ((p - crest) / TAU).ceil() <= ((q - crest) / TAU).floor();
    let ends = Interval::between(p.sin(), q.sin());
    Interval {
        low: if holds(-FRAC_PI_2) { -1.0 } else { ends.low },
        high: if holds(FRAC_PI_2) { 1.0 } else { ends.high },
    }
}

/// `amplitude sin(ω t + phase)` and its derivatives.
pub fn wave(amplitude: f64, omega: f64, phase: f64, from: f64, to: f64) -> JetSpan {
    let mut size = amplitude;
    JetSpan(std::array::from_fn(|k| {
        let turned = phase + FRAC_PI_2 * k as f64;
        let range = sines(omega * from + turned, omega * to + turned).scaled(size);
        size *= omega;
        range
    }))
}

impl Sine {
    fn span(&self, from: f64, to: f64) -> JetSpan {
        let plain = |from: f64, to: f64| wave(self.amplitude, TAU * self.frequency_hz, self.phase_rad, from, to);
        if self.ramp_cycles <= 0.0 {
            return plain(from, to);
        }
        if self.frequency_hz <= 0.0 {
            return JetSpan::at(Jet::default());
        }
        let start = Ramp {
            from: 0.0,
            to: 1.0,
            start_s: 0.0,
            duration_s: self.ramp_cycles / self.frequency_hz,
            shape: RampShape::Smooth,
        };
        let mut all = JetSpan::EMPTY;
        if from < start.duration_s {
            let to = to.min(start.duration_s);
            all = all.hull(start.span(from, to) * plain(from, to));
        }
        if to > start.duration_s {
            all = all.hull(plain(from.max(start.duration_s), to));
        }
        all
    }
}

/// Hull of a function's values at both ends and at the given interior places. This is its range if the places include
/// all extrema of its value and derivatives.
fn hull(at: impl Fn(f64) -> Jet, from: f64, to: f64, extreme: impl IntoIterator<Item = f64>) -> JetSpan {
    let ends = JetSpan::at(at(from)).hull(JetSpan::at(at(to)));
    let inside = extreme.into_iter().filter(|x| from < *x && *x < to);
    inside.fold(ends, |all, x| all.hull(JetSpan::at(at(x))))
}

/// `ln(2 + sqrt 3)`: extremum of the acceleration of a logistic step.
const SIGMOID_ACCELERATION: f64 = 1.316_957_896_924_816_6;
/// `ln(5 + 2 sqrt 6)`: extremum of its third derivative.
const SIGMOID_JERK: f64 = 2.292_431_669_561_178;

impl Sigmoid {
    fn span(&self, from: f64, to: f64) -> JetSpan {
        let extreme = [
            0.0,
            SIGMOID_ACCELERATION,
            -SIGMOID_ACCELERATION,
            SIGMOID_JERK,
            -SIGMOID_JERK,
        ];
        let at = |t: f64| self.jet(t);
        hull(
            at,
            from,
            to,
            extreme.map(|z| self.midpoint_s + z / self.steepness_per_s),
        )
    }
}

/// Extrema of the derivatives of a smooth step: of the acceleration (first, last), `(1 ± 1/sqrt 3)/2`, and of the
/// others, 1/2.
const STEP_EXTREMES: [f64; 3] = [0.211_324_865_405_187_1, 0.5, 0.788_675_134_594_812_9];

impl Ramp {
    pub(super) fn span(&self, from: f64, to: f64) -> JetSpan {
        let stop = self.start_s + self.duration_s;
        let mut all = JetSpan::EMPTY;
        if from < self.start_s {
            all = all.hull(JetSpan::at(Jet::constant(self.from)));
        }
        if to > stop {
            all = all.hull(JetSpan::at(Jet::constant(self.to)));
        }
        if from < stop && to > self.start_s {
            let within = self.start_s + 0.5 * self.duration_s;
            let at = |t: f64| self.jet(SmoothTime { t, within });
            let places = STEP_EXTREMES.map(|s| self.start_s + s * self.duration_s);
            all = all.hull(hull(at, from.max(self.start_s), to.min(stop), places));
        }
        if all == JetSpan::EMPTY {
            let after = from >= stop;
            return JetSpan::at(Jet::constant(if after { self.to } else { self.from }));
        }
        all
    }
}

impl Polynomial {
    /// Encloses by a Taylor series about the middle.
    pub(super) fn span(&self, from: f64, to: f64) -> JetSpan {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let mut c = self.coefficients.clone();
        let n = c.len();
        for i in 0..n {
            for j in (i..n.saturating_sub(1)).rev() {
                c[j] += middle * c[j + 1];
            }
        }
        JetSpan(std::array::from_fn(|k| {
            let mut sum = Interval::point(0.0);
            let mut power = 1.0;
            for (i, x) in c.iter().enumerate().skip(k) {
                let falling: f64 = (0..k).map(|j| (i - j) as f64).product();
                let size = x * falling * power;
                sum = sum
                    + match (i - k) % 2 {
                        _ if i == k => Interval::point(size),
                        0 => Interval::between(0.0, size),
                        _ => Interval::between(-size, size),
                    };
                power *= half;
            }
            sum
        }))
    }
}

impl Table {
    /// Encloses the table in `[from, to]`; a repeated table by the parts of its period inside.
    fn span(&self, from: f64, to: f64) -> JetSpan {
        let (Some(period), Some([first, last])) = (self.period_s(), self.curve.ends()) else {
            return self.curve.span(from, to);
        };
        if to - from >= period {
            return self.curve.span(first, last);
        }
        let begin = from - period * ((from - first) / period).floor();
        let end = begin + (to - from);
        let all = self.curve.span(begin.clamp(first, last), end.min(last));
        if end <= last {
            return all;
        }
        all.hull(self.curve.span(first, end - period))
    }
}

impl crate::functions::curve::PiecewiseCurve {
    /// Encloses the curve in `[from, to]`, piece by piece.
    pub(super) fn span(&self, from: f64, to: f64) -> JetSpan {
        let knots = self.knots();
        let (Some(&first), Some(&last)) = (knots.first(), knots.last()) else {
            return JetSpan::at(Jet::default());
        };
        let mut all = JetSpan::EMPTY;
        if from < first || knots.len() == 1 {
            all = all.hull(JetSpan::at(self.jet(first, first, Interpolation::Cubic)));
        }
        if to > last {
            all = all.hull(JetSpan::at(self.jet(last, last, Interpolation::Cubic)));
        }
        for i in self.pieces(from, to).filter(|i| knots[*i] < knots[i + 1]) {
            let at = |x: f64| self.piece(i, x);
            let (a, b) = (knots[i].max(from), knots[i + 1].min(to));
            all = all.hull(hull(at, a, b, self.extremes(i)));
        }
        if all == JetSpan::EMPTY {
            return JetSpan::at(self.jet(from, from, Interpolation::Cubic));
        }
        all
    }
}
