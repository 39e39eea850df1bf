//! Modes of a straight beam without bladders, for given end conditions, in units of its length, mass per length and stiffness.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Matrix4;

use crate::case::{ResolvedEnd, Rotation, Translation};

/// Exponent below which an evanescent wave is neglected.
const GONE: f64 = -40.0;

/// Mode `a cos βx + b sin βx + c e^{-βx} + d e^{-β(1-x)}` for length 1.
#[derive(Clone, Copy, Debug)]
pub struct StraightMode {
    /// Wave number times length.
    pub beta: f64,
    factors: [f64; 4],
}

impl StraightMode {
    /// Displacement at a fraction of the length.
    pub fn at(&self, x: f64) -> f64 {
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

/// Orthogonal rigid motions that the end conditions permit.
pub fn rigid(ends: &[ResolvedEnd; 2], bends: bool) -> Vec<fn(f64) -> f64> {
    let [root, tip] = [0, 1].map(|end| {
        let end = &ends[end];
        let motion = if bends { &end.transverse } else { &end.axial };
        matches!(motion, Translation::Displacement(_))
    });
    let turns = bends && !ends.iter().any(|end| matches!(end.rotation, Rotation::Slope(_)));
    match (root, tip) {
        (false, false) if turns => vec![|_| 1.0, |x| x - 0.5],
        (false, false) => vec![|_| 1.0],
        (true, false) if turns => vec![|x| x],
        (false, true) if turns => vec![|x| 1.0 - x],
        _ => vec![],
    }
}

/// The first `count` axial modes, for held or free ends.
pub fn axial(ends: &[ResolvedEnd; 2], count: usize) -> Vec<StraightMode> {
    let held = [0, 1].map(|end| matches!(ends[end].axial, Translation::Displacement(_)));
    let shift = if held[0] == held[1] { 0.0 } else { FRAC_PI_2 };
    let one = |k: usize| StraightMode {
        beta: k as f64 * PI - shift,
        factors: if held[0] {
            [0.0, 1.0, 0.0, 0.0]
        } else {
            [1.0, 0.0, 0.0, 0.0]
        },
    };
    (1..=count).map(one).collect()
}

/// The first `count` modes of an Euler-Bernoulli beam, without rigid motions. Wave numbers differ by about π, except
/// for the first.
pub fn bending(ends: &[ResolvedEnd; 2], count: usize) -> Vec<StraightMode> {
    let held = [0, 1].map(|end| held_across(&ends[end]));
    let value = |beta: f64| conditions(&held, beta).determinant();
    const FIRST: f64 = 1.0;
    const STEP: f64 = 0.4;
    const HALVINGS: usize = 40;
    let mut modes = vec![];
    let mut from = FIRST;
    let mut before = value(from);
    while modes.len() < count && from < PI * (count + 2) as f64 {
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
                modes.push(StraightMode { beta, factors });
            }
        }
        (from, before) = (to, after);
    }
    modes
}

/// True for a given transverse displacement, and for a given slope, of an end.
fn held_across(end: &ResolvedEnd) -> [bool; 2] {
    [
        matches!(end.transverse, Translation::Displacement(_)),
        matches!(end.rotation, Rotation::Slope(_)),
    ]
}

/// Conditions `u = 0` or `u''' = 0`, `u' = 0` or `u'' = 0` at both ends, divided by powers of β.
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

    /// Ends from their names.
    pub(super) fn ends(root: &str, tip: &str) -> [ResolvedEnd; 2] {
        let text = format!(
            r#"{{"name": "x", "beam": {{"length_m": 1, "height_m": 0.01, "width_m": 0.01, "young_modulus_pa": 1e9,
                "density_kg_m3": 1e3}}, "ends": {{"root": "{root}", "tip": "{tip}"}}, "time": {{"end_s": 1}}}}"#
        );
        let case: Case = serde_json::from_str(&text).unwrap();
        [case.ends.root.resolve(), case.ends.tip.resolve()]
    }

    /// Source: roots of `cos β cosh β = -1`, `= 1`, of `tan β = tanh β` and of `sin β`. Goal: every mode is found exactly once, with the
    /// accuracy of forty bisections.
    #[test]
    fn wave_numbers_are_those_of_the_books() {
        const MODES: usize = 96;
        for (root, tip, first, last) in [
            ("clamped", "free", [1.875104069, 4.694091133], 95.5),
            ("clamped", "clamped", [4.730040745, 7.853204624], 96.5),
            ("free", "free", [4.730040745, 7.853204624], 96.5),
            ("clamped", "pinned", [3.926602312, 7.068582746], 96.25),
            ("pinned", "pinned", [PI, 2.0 * PI], 96.0),
        ] {
            let found = bending(&ends(root, tip), MODES);
            assert_eq!(found.len(), MODES);
            let betas = [found[0].beta, found[1].beta, found[MODES - 1].beta];
            for (beta, exact) in betas.iter().zip([first[0], first[1], last * PI]) {
                assert!((beta / exact - 1.0).abs() < 1e-8, "{root} {tip}: {beta} {exact}");
            }
        }
    }
}
