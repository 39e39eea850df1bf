//! Of how many short waves a shape consists, and what a mesh does to them while they swing.

use std::f64::consts::{FRAC_PI_2, SQRT_2};

use crate::case::relaxation;
use crate::case::schema::Branch;
use crate::discrete::shapes;
use crate::discrete::straight::{self, Mode};
use crate::functions::profile::Profile;
use crate::model::Model;

/// Vibrations into which a shape is taken apart.
const MODES: usize = 96;
/// The first ones, which a run follows and judges by itself.
const FOLLOWED: usize = 4;
/// Cells on which shape and vibrations are compared, eight a half-wave of the shortest.
const CELLS: usize = 8 * MODES;
/// Part of a shape below which a vibration in it is round-off.
const NOTHING: f64 = 1e-9;

/// What a shape excites in a straight beam without bladders, and for how long it swings.
pub(super) struct Vibrations {
    /// Wave number times length, and what is in it, as a displacement.
    content: Vec<(f64, f64)>,
    /// Whether it bends; or stretches.
    bends: bool,
    /// Unit of the frequencies: `(EI/m)^(1/2)/l²` or `(EA/m)^(1/2)/l` [1/s].
    unit: f64,
    /// Of a solid that relaxes.
    relaxation: Vec<Branch>,
    /// Of damping: drag per mass [1/s], and the time of the material [s].
    damping: [f64; 2],
    /// End of the run [s].
    end: f64,
    /// Whether the mesh is of fourth order.
    fourth: bool,
}

impl Vibrations {
    /// Of a displacement, or of a velocity, over the length.
    pub fn new(profile: &Profile, displacement: bool, bends: bool, model: &Model, end: f64, fourth: bool) -> Self {
        let s = &model.section;
        let length = model.length;
        let (unit, material) = if bends {
            (
                (s.bending_stiffness / s.mass_per_length).sqrt() / (length * length),
                s.bending_damping_time,
            )
        } else {
            (
                (s.axial_stiffness / s.mass_per_length).sqrt() / length,
                s.axial_damping_time,
            )
        };
        let modes = if bends {
            straight::bending(&model.ends, MODES)
        } else {
            straight::axial(&model.ends, MODES)
        };
        let mut given = shapes::at_nodes(profile, CELLS);
        let largest = given.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        for rigid in straight::rigid(&model.ends, bends) {
            let [part, square] = products(&given, rigid);
            let removed = part / square;
            let values = given.iter_mut().enumerate();
            values.for_each(|(k, value)| *value -= removed * rigid(k as f64 / CELLS as f64));
        }
        let one = |mode: &Mode| {
            let [part, square] = products(&given, |x| mode.at(x));
            let amplitude = part / (CELLS as f64 * square).sqrt();
            let amplitude = if amplitude.abs() > NOTHING * largest {
                amplitude
            } else {
                0.0
            };
            let swings = if bends { mode.beta * mode.beta } else { mode.beta };
            (mode.beta, if displacement { amplitude } else { amplitude / swings })
        };
        Self {
            content: modes.iter().map(one).collect(),
            bends,
            unit,
            relaxation: model.relaxation.clone(),
            damping: [s.drag / s.mass_per_length, material],
            end,
            fourth,
        }
    }

    /// Share of the motion, in the mean square, that so many cells have at another place at the end of the run. The first vibrations
    /// are not counted. Waves between nodes are slowed down,
    ///
    /// ```text
    /// stretch  ω_h = ω sin x/x,   bending  ω_h = ω (sin x/x)²,   x = β h/2        lost: 2 sin(δ/2),  δ = (ω - ω_h) t
    /// ```
    ///
    /// t the run, or the time in which damping takes them; beyond half a cell they are not there at all. A phase beyond half a turn is any.
    /// Those of fourth order, [E77], are as much faster as their energy is more: by `(1 + 2 sin²x/3)^(1/2)` and `(1 + sin²x/3)^(1/2)`.
    pub fn left_out(&self, cells: usize) -> f64 {
        let (mut lost, mut whole) = (0.0, 0.0);
        for (k, &(beta, amplitude)) in self.content.iter().enumerate() {
            let square = amplitude * amplitude;
            whole += square;
            if k >= FOLLOWED {
                let share = self.misplaced(beta, cells);
                lost += square * share * share;
            }
        }
        if whole > 0.0 { (lost / whole).sqrt() } else { 0.0 }
    }

    fn misplaced(&self, beta: f64, cells: usize) -> f64 {
        let x = 0.5 * beta / cells as f64;
        if x >= FRAC_PI_2 {
            return 1.0;
        }
        let slower = x.sin() / x;
        let square = if self.fourth { x.sin() * x.sin() / 3.0 } else { 0.0 };
        let (omega, ratio) = if self.bends {
            (beta * beta * self.unit, slower * slower * (1.0 + 2.0 * square).sqrt())
        } else {
            (beta * self.unit, slower * (1.0 + square).sqrt())
        };
        let [omega, relaxing] = relaxation::vibration(&self.relaxation, omega);
        let decay = relaxing + 0.5 * (self.damping[0] + self.damping[1] * omega * omega);
        let time = self.end.min(1.0 / decay.max(f64::MIN_POSITIVE));
        let phase = omega * (1.0 - ratio).abs() * time;
        if phase < FRAC_PI_2 {
            2.0 * (0.5 * phase).sin()
        } else {
            SQRT_2
        }
    }
}

/// `Σ f g` and `Σ g²` over nodes, half at the ends.
fn products(f: &[f64], g: impl Fn(f64) -> f64) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for (k, value) in f.iter().enumerate() {
        let share = if k == 0 || k == CELLS { 0.5 } else { 1.0 };
        let shape = g(k as f64 / CELLS as f64);
        sums[0] += share * value * shape;
        sums[1] += share * shape * shape;
    }
    sums
}
