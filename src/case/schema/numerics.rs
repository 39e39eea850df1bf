//! Numerical options of a case: formulation, mesh, time and integration.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Form of the momentum balance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Formulation {
    /// `m a = b + (N e_t + V e_n + r d1)'`: conserves momentum and energy.
    #[default]
    Conservative,
    /// (A.5) to the letter.
    Published,
}

/// Treatment of sizes that hardly any beam has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Plausibility {
    /// They are faults of the case: almost always a unit is wrong.
    #[default]
    On,
    /// They are intended: an analysis without units, a beam of a hundred thousand bladders.
    Off,
}

impl Plausibility {
    /// True for the default, which a case may omit.
    pub fn is_on(&self) -> bool {
        *self == Self::On
    }
}

/// Error bars of figures by a companion run in a second thread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Companion {
    /// The companion runs.
    #[default]
    On,
    /// No companion: figures have no error bars.
    Off,
}

impl Companion {
    /// True for the default, which a case may omit.
    pub fn is_on(&self) -> bool {
        *self == Self::On
    }
}

/// Resolution in space.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mesh {
    /// `K`: beam cells per segment.
    #[serde(default = "four")]
    #[schemars(range(min = 1, max = 1000))]
    pub cells_per_segment: usize,
    /// Finite volumes along each bladder.
    #[serde(default = "two")]
    #[schemars(range(min = 1, max = 1000))]
    pub cells_per_bladder: usize,
    /// Order of what the beam's cells leave out, 2 or 4: halved cells leave a quarter, or a sixteenth. On fewer than
    /// six cells, or on one cell between two jumps of the section, it is 2. Absent: 2, and with `--accuracy` 4 where the beam has it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("enum" = [2, 4]))]
    pub order: Option<u8>,
    /// Segments of a dry beam; with bladders it is their number per row. Absent: 10.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 100000))]
    pub segments: Option<usize>,
}

impl Mesh {
    /// [`Mesh::order`], or its default.
    pub fn order(&self) -> u8 {
        self.order.unwrap_or(2)
    }
}

impl Default for Mesh {
    fn default() -> Self {
        Self {
            cells_per_segment: 4,
            cells_per_bladder: 2,
            order: None,
            segments: None,
        }
    }
}

/// Simulated time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// End of the run [s].
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub end_s: f64,
    /// Interval between rows of `history.csv` [s]; absent: a thousandth of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub output_interval_s: Option<f64>,
    /// Interval between entries of `fields.npz` [s], a multiple of the output interval; absent: the same.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub fields_interval_s: Option<f64>,
    /// Last part of the run over which "window" figures are taken [s]; absent: a tenth of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub window_s: Option<f64>,
    /// Interval between checkpoints [s], from which `run --resume` goes on; the integrator starts afresh at each.
    /// Absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub checkpoint_interval_s: Option<f64>,
    /// Output times before the window that are written; absent: all. If some are omitted, `envelope.csv` has the least, the greatest
    /// and the mean value of each column over each cycle of the drive, or over each thousandth of the run.
    #[serde(default, skip_serializing_if = "Thinning::is_none")]
    pub history: Thinning,
}

/// Output times before the window that are written to history and fields, besides the first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Thinning {
    /// All output times.
    #[default]
    All,
    /// Only those of the window.
    Window,
    /// Every n-th output time.
    Every(#[schemars(range(min = 1))] u64),
}

impl Thinning {
    /// True if all output times are written.
    pub fn is_none(&self) -> bool {
        *self == Self::All
    }

    /// True if the output with this number before the window is written.
    pub fn keeps(self, number: u64) -> bool {
        match self {
            Self::All => true,
            Self::Window => number == 0,
            Self::Every(count) => number.is_multiple_of(count.max(1)),
        }
    }
}

impl Time {
    /// Interval between rows of the history [s].
    pub fn output_interval(&self) -> f64 {
        self.output_interval_s.unwrap_or(self.end_s / 1000.0)
    }

    /// Interval between entries of the fields [s].
    pub fn fields_interval(&self) -> f64 {
        self.fields_interval_s.unwrap_or(self.output_interval())
    }

    /// Largest number of outputs at this interval [s] that are written: all in the window, and those before it that `history` keeps.
    pub fn written(&self, interval: f64) -> f64 {
        let window = self.window().min(self.end_s);
        let before = self.end_s - window;
        let kept = match self.history {
            Thinning::All => before / interval,
            Thinning::Window => 0.0,
            Thinning::Every(count) => before / interval.max(self.output_interval() * count.max(1) as f64),
        };
        kept + window / interval
    }

    /// Length of the window at the end of the run [s].
    pub fn window(&self) -> f64 {
        self.window_s.unwrap_or(self.end_s / 10.0)
    }
}

/// Time integration.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Solver {
    /// Tolerance relative to each unknown's scale.
    #[serde(default = "default_rtol")]
    #[schemars(range(min = 1e-13, max = 0.1))]
    pub rtol: f64,
    /// Method of time integration.
    #[serde(default)]
    pub method: Method,
    /// Highest BDF order; of no meaning to other methods.
    #[serde(default)]
    pub max_order: MaxOrder,
    /// Safety factor of Newton's convergence test. With IDA its nonlinear convergence coefficient; absent: 0.033 with solid
    /// inertia, 1e-4 without, where what Newton leaves over is noise to the error test. With one-step methods the part
    /// of the tolerance that Newton may leave over; absent: 0.02, from `rtol` 1e-4 down less, so that undamped motion gains no energy.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0), range(max = 1.0))]
    pub nonlinear_coefficient: Option<f64>,
    /// Relative change of the step coefficient that asks for a new Jacobian (IDA's `dcj`); of no meaning to other methods.
    #[serde(default = "default_delta_cj")]
    #[schemars(extend("exclusiveMinimum" = 0), extend("exclusiveMaximum" = 1))]
    pub delta_cj_setup: f64,
    /// First step [s]; absent: IDA's choice.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub initial_step_s: Option<f64>,
    /// Largest step [s]; absent: a tenth of the run (a hundredth without inertia), at most a 16th of the shortest period that
    /// signals have at the time, more where `rtol` is looser than 1e-3.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub max_step_s: Option<f64>,
    /// Stop, with everything computed so far, after this many steps.
    #[serde(default = "default_max_steps")]
    #[schemars(range(min = 1))]
    pub max_steps: u64,
    /// Characteristic transverse displacement [m] to which `rtol` refers; absent: estimated from the case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub transverse_scale_m: Option<f64>,
}

impl Default for Solver {
    fn default() -> Self {
        Self {
            rtol: default_rtol(),
            method: Method::Auto,
            max_order: MaxOrder::Auto,
            nonlinear_coefficient: None,
            delta_cj_setup: default_delta_cj(),
            initial_step_s: None,
            max_step_s: None,
            max_steps: default_max_steps(),
            transverse_scale_m: None,
        }
    }
}

/// Method of time integration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Chosen by the program: `esdirk46` where undamped waves would keep BDF at order 2 and rtol is 1e-3 or less, else IDA.
    #[default]
    Auto,
    /// Variable-order BDF: many cheap steps; of order 2 where waves are not damped.
    Ida,
    /// One-step method TR-BDF2 of order 2, L-stable.
    Trbdf2,
    /// One-step method ESDIRK3(2)4L[2]SA of order 3, L-stable: few steps of three stages each.
    Esdirk34,
    /// One-step method ESDIRK4(3)6L[2]SA of order 4, L-stable: for small errors.
    Esdirk46,
    /// One-step method ESDIRK5(4)7L[2]SA2 of order 5, L-stable: for smaller errors still.
    Esdirk57,
}

/// Highest BDF order: `"auto"` or 1 to 5.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MaxOrder {
    /// Decided from the scene: 2 with undamped inertia, 5 without inertia.
    #[default]
    Auto,
    /// As given; 3 and 4 are refused where hardly damped waves make them unstable.
    Order(u8),
    /// As given, whatever the stability.
    Forced(u8),
}

fn two() -> usize {
    2
}

fn four() -> usize {
    4
}

fn default_rtol() -> f64 {
    1e-5
}

fn default_delta_cj() -> f64 {
    0.25
}

fn default_max_steps() -> u64 {
    1_000_000_000_000
}
