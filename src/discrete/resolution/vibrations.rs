//! Short waves in initial values, and their phase errors on a mesh.

use std::f64::consts::{FRAC_PI_2, SQRT_2};

use crate::case::relaxation;
use crate::case::schema::Branch;
use crate::discrete::euler_bernoulli_modes::{self, StraightMode};
use crate::discrete::shapes::{self, Cells};
use crate::functions::profile::Profile;
use crate::model::Model;

/// Number of modes in the expansion of a shape.
const MODES: usize = 96;
/// Number of first modes that are excluded, because a run monitors them itself.
const FOLLOWED: usize = 4;
/// Number of cells for the expansion: eight per half-wave of the shortest mode.
const CELLS: usize = 8 * MODES;
/// Relative amplitude below which a mode is rounding error.
const NOTHING: f64 = 1e-9;

/// Modal content of a shape in a straight beam without bladders, with the duration of its vibrations.
pub(super) struct Vibrations {
    /// Wave number times length, and amplitude as a displacement, of each mode.
    content: Vec<(f64, f64)>,
    /// True for bending, false for stretch.
    bends: bool,
    /// Unit of the frequencies: `(EI/m)^(1/2)/l²` or `(EA/m)^(1/2)/l` [1/s].
    unit: f64,
    /// Branches of a solid with stress relaxation.
    relaxation: Vec<Branch>,
    /// Damping: drag per mass [1/s], and damping time of the material [s].
    damping: [f64; 2],
    /// End of the run [s].
    end: f64,
    /// True if the mesh is of fourth order.
    fourth: bool,
}

impl Vibrations {
    /// Expands a displacement or a velocity along the beam.
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
            euler_bernoulli_modes::bending(model.root_and_tip(), MODES)
        } else {
            euler_bernoulli_modes::axial(model.root_and_tip(), MODES)
        };
        let mut given = shapes::at_nodes(profile, &Cells::equal(CELLS));
        let largest = given.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        for rigid in euler_bernoulli_modes::rigid(model.root_and_tip(), bends) {
            let [part, square] = products(&given, rigid);
            let removed = part / square;
            let values = given.iter_mut().enumerate();
            values.for_each(|(k, value)| *value -= removed * rigid(k as f64 / CELLS as f64));
        }
        let one = |mode: &StraightMode| {
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

    /// Relative mean square of the motion that is out of place at the end of the run, on a mesh of the given number of cells. The first
    /// modes are excluded. Waves on a mesh are too slow,
    ///
    /// ```text
    /// stretch  ω_h = ω sin x/x,   bending  ω_h = ω (sin x/x)²,   x = β h/2        lost: 2 sin(δ/2),  δ = (ω - ω_h) t
    /// ```
    ///
    /// t is the duration of the run, or the decay time. Waves shorter than two cells are lost entirely. A phase error above a quarter
    /// turn counts as uncorrelated. Waves on a fourth-order mesh, [E77], are faster because of their higher energy: by
    /// `(1 + 2 sin²x/3)^(1/2)` and `(1 + sin²x/3)^(1/2)`.
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

/// `Σ f g` and `Σ g²` over nodes, with half weights at the ends.
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
