//! Controllers: signals whose value follows from a measured quantity, at the instants of a sampled law.
//!
//! ```text
//! e_k = r(t_k) - y(t_k)      t_k = k T, k = 0, 1, 2 ..      r: setpoint, y: measured quantity, T: sample interval
//! ```
//!
//! The measured quantity is that on the left side of the sample. The law gives an output `u_k` for the time until the next sample.

use std::borrow::Cow;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::jet::{Jet, SmoothTime};
use super::signals::{Ramp, RampShape, Signal};

/// Relative round-off of a sample instant.
const ROUND_OFF: f64 = 1e-9;

/// A sampled controller, whose output is the value of the signal: it measures a quantity and sets this input.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Controller {
    /// Beginning of the names of its columns: letters, digits, `-` and `_`. Inputs with the same controller share its output.
    pub name: String,
    /// Measured quantity: the name of a column of the history, such as `tip_u1`, `port_inlet_flow` or `middle_curvature` of a probe; also
    /// with its unit, `tip_u1_m`.
    pub measures: String,
    /// Value that the measured quantity should have, in its unit; may vary in time.
    pub setpoint: Signal,
    /// Time between two samples [s]; the first is at t = 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub sample_interval_s: f64,
    /// Law from the measured quantity to the output.
    pub law: ControlLaw,
    /// Output before the first sample, in the unit of the input: equilibria and small motions have it. A PI law adds to it; of a relay it is
    /// one of the two outputs.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub start: f64,
    /// Output between two samples.
    #[serde(default, skip_serializing_if = "Hold::is_step")]
    pub hold: Hold,
    /// Output before and after the last sample, during a run.
    #[serde(skip)]
    #[schemars(skip)]
    pub(crate) held: Option<[Ramp; 2]>,
}

/// Law of a controller.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ControlLaw {
    /// Proportional and integral control, with saturation.
    Pi(PiLaw),
    /// Two outputs, with hysteresis.
    Relay(RelayLaw),
}

/// `[E109]` PI law with saturation and conditional integration:
///
/// ```text
/// v_k = u_0 + K (e_k + s_k)      u_k = min(max(v_k, u_min), u_max)
/// s_(k+1) = s_k + (T/T_i) e_k,   but s_k if v_k is beyond a limit and K e_k leads further beyond
/// ```
///
/// `u_0` is the output before the first sample, `s_0 = 0`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PiLaw {
    /// `K`: output per error, in the unit of the input per unit of the measured quantity; below 0 where the quantity falls as the input rises.
    pub gain: f64,
    /// `T_i`: time in which the integral of a constant error adds as much as the error itself [s]; absent: no integral.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub integral_time_s: Option<f64>,
    /// Lowest output, in the unit of the input.
    pub lowest: f64,
    /// Highest output, in the unit of the input.
    pub highest: f64,
}

/// `[E110]` Relay with a band of hysteresis `h` around the setpoint:
///
/// ```text
/// u_k = u_below if e_k > h/2,   u_above if e_k < -h/2,   else u_(k-1)
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RelayLaw {
    /// Output while the quantity is below the band, in the unit of the input.
    pub output_below: f64,
    /// Output while the quantity is above the band, in the unit of the input.
    pub output_above: f64,
    /// Width of the band around the setpoint in which the output remains, in the unit of the measured quantity.
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub hysteresis: f64,
}

/// `[E111]` Output between the samples `t_k` and `t_(k+1)`:
///
/// ```text
/// step:   u(t) = u_k
/// ramp:   u(t) = u(t_k) + (u_k - u(t_k)) (t - t_k)/T
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Hold {
    /// The output jumps at samples.
    #[default]
    Step,
    /// The output reaches its value at the next sample along a straight line, for inputs that must not jump.
    Ramp,
}

impl Hold {
    fn is_step(&self) -> bool {
        *self == Self::Step
    }
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// State of a controller during a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ControlState {
    /// Number of the next sample.
    pub next: u64,
    /// Sum of errors over the integral time, `s_k`, in the unit of the measured quantity.
    sum: f64,
    /// Last output of the law; `None` before the first sample.
    output: Option<f64>,
    /// Output before and after the last sample.
    held: Option<[Ramp; 2]>,
}

impl ControlState {
    /// True if the output has changed.
    pub fn has_acted(&self) -> bool {
        self.held.is_some()
    }
}

impl Controller {
    /// Value with its derivatives: the output of the last sample, or that before the first one at t = 0.
    pub(super) fn jet(&self, clock: SmoothTime) -> Jet {
        match &self.held {
            _ if clock.within <= 0.0 => Jet::constant(self.start),
            None => Jet::constant(self.start),
            Some([before, after]) if clock.within < after.start_s => before.jet(clock),
            Some([_, after]) => after.jet(clock),
        }
    }

    /// Sets the output to that of a state.
    pub fn hold(&mut self, state: &ControlState) {
        self.held.clone_from(&state.held);
    }

    /// Output at a time.
    pub fn output(&self, clock: SmoothTime) -> f64 {
        self.jet(clock).value
    }

    /// Smallest and largest output.
    pub fn limits(&self) -> [f64; 2] {
        let [a, b] = match &self.law {
            ControlLaw::Pi(law) => [law.lowest, law.highest],
            ControlLaw::Relay(law) => [law.output_below, law.output_above],
        };
        [a.min(b), a.max(b)]
    }

    /// Time of a sample [s].
    pub fn sample_time(&self, number: u64) -> f64 {
        number as f64 * self.sample_interval_s
    }

    /// Instants of the samples after the first one until `end` [s].
    pub fn sample_times(&self, end: f64) -> impl Iterator<Item = f64> + '_ {
        (1..=(end / self.sample_interval_s).ceil() as u64).map(|number| self.sample_time(number))
    }

    /// Takes a sample at time `t` [s] of the measured quantity. Returns true if the output changes.
    pub fn sample(&self, state: &mut ControlState, t: f64, measured: f64) -> bool {
        let first = state.next == 0;
        // the setpoint on the right side of a jump
        let within = self.sample_time(state.next).max(t) + ROUND_OFF * self.sample_interval_s;
        let at = SmoothTime { t, within };
        let error = self.setpoint.jet(at).value - measured;
        let output = match &self.law {
            ControlLaw::Pi(law) => law.output(self, error, &mut state.sum),
            ControlLaw::Relay(law) => law.output(error, state.output.unwrap_or(self.start)),
        };
        state.next += 1;
        state.output = Some(output);
        let now = state
            .held
            .as_ref()
            .map_or(self.start, |[_, after]| after.jet(SmoothTime { t, within: t }).value);
        let still = state
            .held
            .as_ref()
            .is_none_or(|[_, after]| after.from == after.to || after.duration_s <= 0.0);
        if output == now && still {
            return false;
        }
        let step = self.hold.is_step();
        let after = Ramp {
            // before the first sample there is no time
            from: if first && step { output } else { now },
            to: output,
            start_s: t,
            duration_s: if step { 0.0 } else { self.sample_interval_s },
            shape: RampShape::Linear,
        };
        let before = match state.held.take() {
            Some([_, before]) => before,
            None => Ramp {
                to: after.from,
                duration_s: 0.0,
                ..after.clone()
            },
        };
        state.held = Some([before, after]);
        true
    }
}

impl PiLaw {
    fn output(&self, of: &Controller, error: f64, sum: &mut f64) -> f64 {
        let wanted = of.start + self.gain * (error + *sum);
        let output = wanted.max(self.lowest).min(self.highest);
        let winds_up = (wanted - output) * self.gain * error > 0.0;
        if let (Some(time), false) = (self.integral_time_s, winds_up) {
            *sum += of.sample_interval_s / time * error;
        }
        output
    }
}

impl RelayLaw {
    fn output(&self, error: f64, before: f64) -> f64 {
        match 0.5 * self.hysteresis {
            half if error > half => self.output_below,
            half if error < -half => self.output_above,
            _ => before,
        }
    }
}

impl Signal {
    /// Visits all controllers in the signal.
    pub fn each_controller<'s>(&'s self, visit: &mut dyn FnMut(&'s Controller)) {
        match self {
            Self::Controller(controller) => visit(controller),
            Self::Sum(parts) | Self::Product(parts) => parts.iter().for_each(|part| part.each_controller(visit)),
            _ => {}
        }
    }

    /// True if a controller sets the signal or a part of it.
    pub fn is_controlled(&self) -> bool {
        let mut found = false;
        self.each_controller(&mut |_| found = true);
        found
    }

    /// True if a controller sets it by jumps at its samples.
    pub fn jumps_at_samples(&self) -> bool {
        let mut found = false;
        self.each_controller(&mut |one| found |= one.hold.is_step());
        found
    }

    /// Sets the output of the controllers with a name. Returns true if there are any.
    pub fn hold(&mut self, name: &str, state: &ControlState) -> bool {
        match self {
            Self::Controller(one) if one.name == name => {
                one.hold(state);
                true
            }
            Self::Sum(parts) | Self::Product(parts) => {
                let held = parts.iter_mut().map(|part| part.hold(name, state));
                held.fold(false, |any, one| any | one)
            }
            _ => false,
        }
    }

    /// The signal with a table in place of each controller, which spans the outputs until `end` [s]: for bounds.
    pub(super) fn spanned(&self, end: f64) -> Cow<'_, Self> {
        let mut names = vec![];
        self.each_controller(&mut |one| names.push(one.name.clone()));
        self.spanned_beside(end, &names)
    }

    /// The same beside other signals, so that the controllers with these names reach all combinations of their limits.
    pub(crate) fn spanned_beside(&self, end: f64, names: &[String]) -> Cow<'_, Self> {
        let each = |parts: &[Self]| {
            parts
                .iter()
                .map(|part| part.spanned_beside(end, names).into_owned())
                .collect()
        };
        match self {
            Self::Controller(one) => Cow::Owned(one.spanned(end, names)),
            Self::Sum(parts) if self.is_controlled() => Cow::Owned(Self::Sum(each(parts))),
            Self::Product(parts) if self.is_controlled() => Cow::Owned(Self::Product(each(parts))),
            _ => Cow::Borrowed(self),
        }
    }
}

/// Part of the run after which a table that spans the outputs of a controller may change.
const CHANGE: f64 = 0.01;
/// Most controllers whose limits are combined; others reach their limits together with one of these.
const COMBINED: usize = 6;

impl Controller {
    /// A table that begins with the first output, has both limits in all combinations with those of the other controllers, and remains at
    /// the larger of them.
    fn spanned(&self, end: f64, names: &[String]) -> Signal {
        let [low, high] = self.limits();
        let [other, largest] = if high.abs() >= low.abs() {
            [low, high]
        } else {
            [high, low]
        };
        let mut all: Vec<&String> = vec![];
        for name in names {
            if !all.contains(&name) {
                all.push(name);
            }
        }
        let own = all.iter().position(|name| **name == self.name).unwrap_or(0) % COMBINED;
        let slow = match self.hold {
            Hold::Step => 0.0,
            Hold::Ramp => self.sample_interval_s.min(CHANGE * end),
        };
        let (mut times, mut values) = (vec![0.0], vec![self.start]);
        let combinations = 1_u32 << all.len().clamp(1, COMBINED);
        for (k, combination) in (0..combinations).rev().enumerate() {
            let (t, before) = (CHANGE * (k + 1) as f64 * end, values[values.len() - 1]);
            let value = if combination >> own & 1 == 1 { other } else { largest };
            times.extend([t, t + slow]);
            values.extend([before, value]);
        }
        times.push(2.0 * end);
        values.push(largest);
        Signal::Table(super::signals::Table::new(
            times,
            values,
            super::curve::Interpolation::Linear,
        ))
    }
}
