//! Of how many short waves a shape consists, and what a mesh does to them while they swing.

use std::f64::consts::{FRAC_PI_2, PI, SQRT_2};

use nalgebra::Matrix4;

use crate::case::profile::Profile;
use crate::case::{Rotation, Translation};
use crate::discrete::shapes;
use crate::model::Model;

/// Vibrations into which a shape is taken apart.
const MODES: usize = 96;
/// The first ones, which a run follows and judges by itself.
const FOLLOWED: usize = 4;
/// Cells on which shape and vibrations are compared, eight a half-wave of the shortest.
const CELLS: usize = 8 * MODES;
/// Part of a shape below which a vibration in it is round-off.
const NOTHING: f64 = 1e-9;
/// Below this exponent a wave that dies away from an end is gone.
const GONE: f64 = -40.0;

/// What a shape excites in a straight beam without bladders, and for how long it swings.
pub(super) struct Vibrations {
    /// Wave number times length, and what is in it, as a displacement.
    content: Vec<(f64, f64)>,
    /// Whether it bends; or stretches.
    bends: bool,
    /// Unit of the frequencies: `(EI/m)^(1/2)/l²` or `(EA/m)^(1/2)/l` [1/s].
    unit: f64,
    /// Of damping: drag per mass [1/s], and the time of the material [s].
    damping: [f64; 2],
    /// End of the run [s].
    end: f64,
}

impl Vibrations {
    /// Of a displacement, or of a velocity, over the length.
    pub fn new(profile: &Profile, displacement: bool, bends: bool, model: &Model, end: f64) -> Self {
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
        let modes = if bends { bending(model) } else { axial(model) };
        let mut given = shapes::at_nodes(profile, CELLS);
        let largest = given.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        for rigid in rigid(model, bends) {
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
            damping: [s.drag / s.mass_per_length, material],
            end,
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
        let (omega, ratio) = if self.bends {
            (beta * beta * self.unit, slower * slower)
        } else {
            (beta * self.unit, slower)
        };
        let decay = 0.5 * (self.damping[0] + self.damping[1] * omega * omega);
        let time = self.end.min(1.0 / decay.max(f64::MIN_POSITIVE));
        let phase = omega * (1.0 - ratio) * time;
        if phase < FRAC_PI_2 {
            2.0 * (0.5 * phase).sin()
        } else {
            SQRT_2
        }
    }
}

/// `a cos βx + b sin βx + c e^{-βx} + d e^{-β(1-x)}`, the length being 1.
struct Mode {
    beta: f64,
    factors: [f64; 4],
}

impl Mode {
    fn at(&self, x: f64) -> f64 {
        let [a, b, c, d] = self.factors;
        let (sin, cos) = (self.beta * x).sin_cos();
        let dying = |factor: f64, distance: f64| {
            let exponent = -self.beta * distance;
            if factor == 0.0 || exponent < GONE {
                0.0
            } else {
                factor * exponent.exp()
            }
        };
        a * cos + b * sin + dying(c, x) + dying(d, 1.0 - x)
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

/// Motions of the beam as a whole that its ends let it do, across each other.
fn rigid(model: &Model, bends: bool) -> Vec<fn(f64) -> f64> {
    let [root, tip] = [0, 1].map(|end| {
        let end = &model.ends[end];
        let motion = if bends { &end.transverse } else { &end.axial };
        matches!(motion, Translation::Displacement(_))
    });
    let turns = bends && !model.ends.iter().any(|end| matches!(end.rotation, Rotation::Slope(_)));
    match (root, tip) {
        (false, false) if turns => vec![|_| 1.0, |x| x - 0.5],
        (false, false) => vec![|_| 1.0],
        (true, false) if turns => vec![|x| x],
        (false, true) if turns => vec![|x| 1.0 - x],
        _ => vec![],
    }
}

fn axial(model: &Model) -> Vec<Mode> {
    let held = [0, 1].map(|end| matches!(model.ends[end].axial, Translation::Displacement(_)));
    let shift = if held[0] == held[1] { 0.0 } else { FRAC_PI_2 };
    let one = |k: usize| Mode {
        beta: k as f64 * PI - shift,
        factors: if held[0] {
            [0.0, 1.0, 0.0, 0.0]
        } else {
            [1.0, 0.0, 0.0, 0.0]
        },
    };
    (1..=MODES).map(one).collect()
}

/// Those of Euler's beam between its ends; rigid motions left out. Wave numbers are π apart but for the first.
fn bending(model: &Model) -> Vec<Mode> {
    let held = [0, 1].map(|end| {
        let end = &model.ends[end];
        [
            matches!(end.transverse, Translation::Displacement(_)),
            matches!(end.rotation, Rotation::Slope(_)),
        ]
    });
    let value = |beta: f64| conditions(&held, beta).determinant();
    const FIRST: f64 = 1.0;
    const STEP: f64 = 0.4;
    const HALVINGS: usize = 40;
    let mut modes = vec![];
    let mut from = FIRST;
    let mut before = value(from);
    while modes.len() < MODES && from < PI * (MODES + 2) as f64 {
        let to = from + STEP;
        let after = value(to);
        if (before > 0.0) != (after > 0.0) {
            let (mut low, mut high) = (from, to);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if (value(middle) > 0.0) == (before > 0.0) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            let beta = 0.5 * (low + high);
            if let Some(vectors) = conditions(&held, beta).svd(false, true).v_t {
                let factors = std::array::from_fn(|k| vectors[(3, k)]);
                modes.push(Mode { beta, factors });
            }
        }
        (from, before) = (to, after);
    }
    modes
}

/// `u = 0` or `u''' = 0`, `u' = 0` or `u'' = 0` at both ends, over powers of β.
fn conditions(held: &[[bool; 2]; 2], beta: f64) -> Matrix4<f64> {
    let rows = [0, 1].map(|end| {
        let (sin, cos) = (beta * end as f64).sin_cos();
        let far = (-beta).exp();
        let (first, last) = if end == 0 { (1.0, far) } else { (far, 1.0) };
        let [held, turned] = held[end];
        let across = if held {
            [cos, sin, first, last]
        } else {
            [sin, -cos, -first, last]
        };
        let turning = if turned {
            [-sin, cos, -first, last]
        } else {
            [-cos, -sin, first, last]
        };
        [across, turning]
    });
    Matrix4::from_fn(|row, column| rows[row / 2][row % 2][column])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::schema::Case;

    fn model(root: &str, tip: &str) -> Model {
        let text = format!(
            r#"{{"name": "x", "beam": {{"length_m": 1, "height_m": 0.01, "width_m": 0.01, "young_modulus_pa": 1e9,
                "density_kg_m3": 1e3}}, "ends": {{"root": "{root}", "tip": "{tip}"}}, "time": {{"end_s": 1}}}}"#
        );
        let case: Case = serde_json::from_str(&text).unwrap();
        Model::whole(&case, true)
    }

    /// Source: roots of `cos β cosh β = -1`, `= 1`, of `tan β = tanh β` and of `sin β`. Goal: every vibration is found, none twice, to
    /// what forty halvings leave.
    #[test]
    fn wave_numbers_are_those_of_the_books() {
        for (root, tip, first, last) in [
            ("clamped", "free", [1.875104069, 4.694091133], 95.5),
            ("clamped", "clamped", [4.730040745, 7.853204624], 96.5),
            ("free", "free", [4.730040745, 7.853204624], 96.5),
            ("clamped", "pinned", [3.926602312, 7.068582746], 96.25),
            ("pinned", "pinned", [PI, 2.0 * PI], 96.0),
        ] {
            let found = bending(&model(root, tip));
            assert_eq!(found.len(), MODES);
            let betas = [found[0].beta, found[1].beta, found[MODES - 1].beta];
            for (beta, exact) in betas.iter().zip([first[0], first[1], last * PI]) {
                assert!((beta / exact - 1.0).abs() < 1e-8, "{root} {tip}: {beta} {exact}");
            }
        }
    }
}
