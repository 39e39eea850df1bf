//! Values, derivatives, switching times and time scales of signals.

use std::f64::consts::TAU;

use super::curve::Interpolation;
use super::signals::{Jet, Polynomial, Ramp, RampShape, Sigmoid, Signal, Sine, SmoothTime, Table};

/// Largest number of switching times of a repeated table; case checks reject more.
pub const MOST_KNOTS: usize = 1_000_000;

impl Signal {
    /// Value with its first three derivatives; does not allocate.
    pub fn jet(&self, clock: SmoothTime) -> Jet {
        match self {
            Self::Constant(value) => Jet::constant(*value),
            Self::Sine(sine) => sine.jet(clock.t),
            Self::Sigmoid(sigmoid) => sigmoid.jet(clock.t),
            Self::Ramp(ramp) => ramp.jet(clock),
            Self::Polynomial(polynomial) => polynomial.jet(clock.t),
            Self::Table(table) => table.jet(clock),
            Self::Sum(terms) => terms.iter().fold(Jet::default(), |sum, term| sum + term.jet(clock)),
            Self::Product(factors) => factors
                .iter()
                .fold(Jet::constant(1.0), |product, f| product * f.jet(clock)),
            Self::Controller(controller) => controller.jet(clock),
        }
    }

    /// Value at an instant that is not a switching time.
    pub fn value(&self, t: f64) -> f64 {
        self.jet(SmoothTime { t, within: t }).value
    }

    /// Appends the times [s] at which the signal or one of its first three derivatives jumps; those of repeated tables
    /// up to `until`. Omits joins that are twice continuously differentiable and harmless to an integrator: inner knots
    /// of splines, and the end of a sine's smooth start.
    pub fn breaks(&self, until: f64, out: &mut Vec<f64>) {
        match self {
            Self::Constant(_) | Self::Sine(_) | Self::Sigmoid(_) | Self::Polynomial(_) | Self::Controller(_) => {}
            Self::Ramp(ramp) if ramp.duration_s > 0.0 => out.extend([ramp.start_s, ramp.start_s + ramp.duration_s]),
            Self::Ramp(ramp) => out.push(ramp.start_s),
            Self::Table(table) if table.times_s.len() < 2 => {}
            Self::Table(table) => table.breaks(until, out),
            Self::Sum(parts) | Self::Product(parts) => parts.iter().for_each(|part| part.breaks(until, out)),
        }
    }

    /// Largest overshoot of a spline in the signal, relative to the range of its values; 0 without splines.
    pub fn overshoot(&self) -> f64 {
        match self {
            Self::Table(table) => table.curve.overshoot(),
            Self::Sum(parts) | Self::Product(parts) => parts.iter().map(Self::overshoot).fold(0.0, f64::max),
            _ => 0.0,
        }
    }

    /// The intervals of `[0, end]` between switching times, in order; at least one.
    pub fn smooth_intervals(&self, end: f64) -> Vec<(f64, f64)> {
        let mut times = vec![0.0, end];
        self.breaks(end, &mut times);
        times.retain(|t| (0.0..=end).contains(t));
        times.sort_by(f64::total_cmp);
        times.dedup();
        if times.len() < 2 {
            return vec![(0.0, end)];
        }
        times.windows(2).map(|w| (w[0], w[1])).collect()
    }

    /// Time of the first jump of the value until `end` [s], and the values before and after.
    pub fn first_jump(&self, end: f64) -> Option<[f64; 3]> {
        self.each_jump(end).next()
    }

    /// Times of all jumps of the value until `end` [s], and the values before and after, in order of time.
    pub fn each_jump(&self, end: f64) -> impl Iterator<Item = [f64; 3]> {
        let mut last: Option<f64> = None;
        self.smooth_intervals(end).into_iter().filter_map(move |(start, stop)| {
            let at = |t: f64| {
                let within = 0.5 * (start + stop);
                self.jet(SmoothTime { t, within }).value
            };
            let first = at(start);
            let before = last.replace(at(stop))?;
            ((first - before).abs() > 1e-9 * (first.abs() + before.abs())).then_some([start, before, first])
        })
    }

    /// Shortest time scale [s]: period or smooth start of a sine, duration of a ramp, `4/steepness` of a sigmoid,
    /// smallest spacing of a table. Frequencies of factors add.
    pub fn fastest_period_s(&self) -> Option<f64> {
        let scale = match self {
            _ if self.is_constant() => None,
            Self::Constant(_) | Self::Polynomial(_) | Self::Controller(_) => None,
            Self::Sine(sine) if sine.ramp_cycles > 0.0 => Some(sine.ramp_cycles.min(1.0) / sine.frequency_hz),
            Self::Sine(sine) => Some(1.0 / sine.frequency_hz),
            Self::Sigmoid(sigmoid) => Some(4.0 / sigmoid.steepness_per_s.abs()),
            Self::Ramp(ramp) => Some(ramp.duration_s),
            Self::Table(table) => table.curve.smallest_spacing(),
            Self::Sum(terms) => terms.iter().filter_map(Self::fastest_period_s).reduce(f64::min),
            Self::Product(factors) => {
                let frequency: f64 = factors.iter().filter_map(Self::fastest_period_s).map(f64::recip).sum();
                Some(frequency.recip())
            }
        };
        scale.filter(|s| s.is_finite() && *s > 0.0)
    }

    /// [`Self::fastest_period_s`] without changes that switching times mark. Between its switching times a ramp or a
    /// piece of a table is smooth, however short it is.
    pub fn fastest_unmarked_period_s(&self) -> Option<f64> {
        match self {
            Self::Ramp(_) => None,
            Self::Table(table) if table.interpolation != Interpolation::Cubic => None,
            Self::Sum(terms) => terms
                .iter()
                .filter_map(Self::fastest_unmarked_period_s)
                .reduce(f64::min),
            Self::Product(factors) => {
                let frequency: f64 = factors
                    .iter()
                    .filter_map(Self::fastest_unmarked_period_s)
                    .map(f64::recip)
                    .sum();
                Some(frequency.recip()).filter(|s| s.is_finite())
            }
            _ => self.fastest_period_s(),
        }
    }

    /// True if the signal is zero at all times.
    pub fn is_zero(&self) -> bool {
        self.is_constant() && self.value(0.0) == 0.0
    }

    /// True if the signal is constant.
    pub fn is_constant(&self) -> bool {
        match self {
            Self::Constant(_) => true,
            Self::Sine(sine) => sine.amplitude == 0.0 || sine.frequency_hz == 0.0,
            Self::Sigmoid(sigmoid) => sigmoid.amplitude == 0.0 || sigmoid.steepness_per_s == 0.0,
            Self::Ramp(ramp) => ramp.from == ramp.to,
            Self::Polynomial(polynomial) => polynomial.coefficients.iter().skip(1).all(|c| *c == 0.0),
            Self::Table(table) => table.curve.is_constant(),
            Self::Sum(parts) | Self::Product(parts) => parts.iter().all(Self::is_constant),
            Self::Controller(controller) => controller.limits() == [controller.start; 2],
        }
    }
}

impl Sine {
    fn jet(&self, t: f64) -> Jet {
        let w = TAU * self.frequency_hz;
        let (sin, cos) = (w * t + self.phase_rad).sin_cos();
        let a = self.amplitude;
        let sine = Jet {
            value: a * sin,
            rate: a * w * cos,
            acceleration: -a * w * w * sin,
            jerk: -a * w * w * w * cos,
        };
        let s = t * self.frequency_hz / self.ramp_cycles;
        if self.ramp_cycles <= 0.0 || s >= 1.0 {
            sine
        } else if s <= 0.0 {
            Jet::default()
        } else {
            sine * Jet::smooth_step(t, 0.0, self.ramp_cycles / self.frequency_hz)
        }
    }
}

impl Sigmoid {
    /// `y = A g`, `y' = A k g h`, `y'' = A k^2 g h (h - g)`, `y''' = A k^3 g h (h^2 - 4 g h + g^2)` with
    /// `g = 1/(1 + e^-z)`, `h = 1 - g`, `z = k (t - t0)`. Computes only `e^-|z|`, which cannot overflow.
    pub(super) fn jet(&self, t: f64) -> Jet {
        let (a, k) = (self.amplitude, self.steepness_per_s);
        let z = k * (t - self.midpoint_s);
        let small = (-z.abs()).exp();
        let (near, far) = (1.0 / (1.0 + small), small / (1.0 + small));
        let (g, h) = if z >= 0.0 { (near, far) } else { (far, near) };
        Jet {
            value: a * g,
            rate: a * k * g * h,
            acceleration: a * k * k * g * h * (h - g),
            jerk: a * k * k * k * g * h * (h * h - 4.0 * g * h + g * g),
        }
    }
}

impl Ramp {
    pub(super) fn jet(&self, clock: SmoothTime) -> Jet {
        if clock.within <= self.start_s && (self.duration_s > 0.0 || clock.within < self.start_s) {
            return Jet::constant(self.from);
        }
        if clock.within >= self.start_s + self.duration_s {
            return Jet::constant(self.to);
        }
        let part = match self.shape {
            RampShape::Smooth => Jet::smooth_step(clock.t, self.start_s, self.duration_s),
            RampShape::Linear => Jet {
                value: (clock.t - self.start_s) / self.duration_s,
                rate: 1.0 / self.duration_s,
                acceleration: 0.0,
                jerk: 0.0,
            },
        };
        Jet::constant(self.from) + part.scaled(self.to - self.from)
    }
}

impl Table {
    /// Value and derivatives in the period that contains the clock's time.
    fn jet(&self, clock: SmoothTime) -> Jet {
        let (Some(period), Some([first, last])) = (self.period_s(), self.curve.ends()) else {
            return self.curve.jet(clock.t, clock.within, self.interpolation);
        };
        // without switching times an interval may be longer than a period
        let within = if self.is_smooth() { clock.t } else { clock.within };
        let before = period * ((within - first) / period).floor();
        let [x, within] = [clock.t - before, (within - before).clamp(first, last)];
        self.curve.inside(x, within, self.interpolation)
    }

    /// True for a repeated table that is twice continuously differentiable everywhere.
    pub fn is_smooth(&self) -> bool {
        self.repeat && self.interpolation == Interpolation::Cubic && self.curve.jumps().is_empty() && self.curve.joins()
    }

    fn breaks(&self, until: f64, out: &mut Vec<f64>) {
        if self.is_smooth() {
            return;
        }
        match (self.interpolation, self.curve.ends()) {
            (Interpolation::Cubic, Some(ends)) => {
                self.knots_until(until, &ends, out);
                self.knots_until(until, self.curve.jumps(), out);
            }
            _ => self.knots_until(until, self.curve.knots(), out),
        }
    }

    /// Appends times of the table [s]; for a repeated table, those of every period until `until`.
    pub(super) fn knots_until(&self, until: f64, times: &[f64], out: &mut Vec<f64>) {
        let (Some(period), Some([first, _])) = (self.period_s(), self.curve.ends()) else {
            return out.extend(times);
        };
        let mut k = (-first / period).floor().min(0.0);
        while first + k * period <= until && out.len() < MOST_KNOTS {
            out.extend(times.iter().map(|t| t + k * period));
            k += 1.0;
        }
    }
}

impl Polynomial {
    /// Evaluates value and derivatives by Horner's rule.
    pub(super) fn jet(&self, x: f64) -> Jet {
        self.coefficients.iter().rev().fold(Jet::default(), |p, &c| Jet {
            value: p.value * x + c,
            rate: p.rate * x + p.value,
            acceleration: p.acceleration * x + 2.0 * p.rate,
            jerk: p.jerk * x + 3.0 * p.acceleration,
        })
    }
}
