//! Coefficients of the methods: order conditions, form, stability.

use slcbeam::onestep::tableau::{STAGES, Tableau, TableauMethod};

/// Rooted trees up to order five, each a list of its branches.
#[derive(Clone)]
struct Tree(Vec<Tree>);

impl Tree {
    fn size(&self) -> usize {
        1 + self.0.iter().map(Tree::size).sum::<usize>()
    }
    fn density(&self) -> f64 {
        self.size() as f64 * self.0.iter().map(Tree::density).product::<f64>()
    }
    /// Elementary weight at every stage, without the sum of the root.
    fn weights(&self, t: &Tableau) -> [f64; STAGES] {
        let mut out = [1.0; STAGES];
        for branch in &self.0 {
            let inner = branch.weights(t);
            for (out, a) in out.iter_mut().zip(&t.a) {
                *out *= a.iter().zip(&inner).map(|(a, x)| a * x).sum::<f64>();
            }
        }
        out
    }
}

/// All trees of one size; branch lists may repeat in several orders, which is harmless.
fn trees(size: usize) -> Vec<Tree> {
    fn forests(size: usize) -> Vec<Vec<Tree>> {
        if size == 0 {
            return vec![vec![]];
        }
        let mut all = vec![];
        for first in 1..=size {
            for tree in trees(first) {
                for rest in forests(size - first) {
                    all.push([vec![tree.clone()], rest].concat());
                }
            }
        }
        all
    }
    forests(size - 1).into_iter().map(Tree).collect()
}

fn defect(t: &Tableau, b: &[f64; STAGES], order: usize) -> f64 {
    let one = |tree: &Tree| {
        let sum: f64 = tree.weights(t).iter().zip(b).map(|(x, b)| x * b).sum();
        (sum - 1.0 / tree.density()).abs()
    };
    (1..=order).flat_map(trees).map(|tree| one(&tree)).fold(0.0, f64::max)
}

/// Goal: Butcher's order conditions hold, and those of the next order do not. Source: Hairer, Nørsett & Wanner I, II.2. Tolerance: rounding
/// of products of at most five sums of seven coefficients, the largest 2.5.
#[test]
fn order_conditions_hold() {
    for method in TableauMethod::ALL {
        let t = method.tableau();
        let order = usize::from(method.order());
        assert!(defect(&t, &t.b(), order) < 1e-14, "{method}");
        assert!(defect(&t, &t.b(), order + 1) > 1e-5, "{method}");
        let embedded = if method == TableauMethod::TrBdf2 { 3 } else { order - 1 };
        assert!(defect(&t, &t.embedded, embedded) < 1e-14, "{method}, embedded");
        assert_eq!(usize::from(t.power), order.min(embedded) + 1);
    }
}

/// Goal: rows sum to their times, the form is as the solver requires, and the second stage is of second order.
#[test]
fn form_is_singly_diagonal_and_stiffly_accurate() {
    for method in TableauMethod::ALL {
        let t = method.tableau();
        for i in 0..t.stages {
            let sum: f64 = t.a[i].iter().sum();
            assert!((sum - t.c[i]).abs() < 1e-15 * 8.0, "{method} row {i}");
            assert_eq!(t.a[i][i], if i == 0 { 0.0 } else { t.gamma() });
            let second: f64 = t.a[i].iter().zip(&t.c).map(|(a, c)| a * c).sum();
            assert!((second - 0.5 * t.c[i] * t.c[i]).abs() < 1e-14, "{method} stage {i}");
        }
        assert_eq!(t.c[t.stages - 1], 1.0);
        assert!(
            t.c.iter().all(|c| (0.0..=1.0).contains(c)),
            "{method}: no stage beyond the step"
        );
        assert!(t.nodes.contains(&0) && t.nodes.contains(&(t.stages - 1)));
    }
}

/// Goal: `1 - |R(iω)|` follows the power [`Tableau::damping`], which determines the accepted remainder of Newton's iteration. Tolerance:
/// 0.1 of the power between ω = 0.2 and 0.4, where rounding is below 1e-6 of it. At rtol 1e-4 and looser the remainder is 0.02, at 1e-6
/// less by `100^(damping/power - 1)`.
#[test]
fn damping_goes_with_its_power() {
    for method in TableauMethod::ALL {
        let t = method.tableau();
        let loss = |omega: f64| {
            let (re, im) = t.stability((0.0, omega));
            1.0 - re.hypot(im)
        };
        let power = (loss(0.4) / loss(0.2)).log2();
        assert!((power - f64::from(t.damping)).abs() < 0.1, "{method}: {power}");
        assert_eq!([t.newton_tolerance(1e-2), t.newton_tolerance(1e-4)], [0.02; 2]);
        let fall = 100_f64.powf(f64::from(t.damping) / f64::from(t.power) - 1.0);
        assert!((t.newton_tolerance(1e-6) * fall / 0.02 - 1.0).abs() < 1e-12, "{method}");
    }
}

/// `|R(iω)| <= 1` and `R(-∞) = 0`, where `R(z) = 1 + z bᵀ(1 - zA)⁻¹ 1`.
///
/// With all poles in the right half plane (γ > 0) the first is A-stability. Tolerance: rounding of the forward
/// substitution, whose numbers reach some hundred.
#[test]
fn methods_are_l_stable() {
    let growth = |t: &Tableau, z: (f64, f64)| {
        let (re, im) = t.stability(z);
        re.hypot(im)
    };
    for method in TableauMethod::ALL {
        let t = method.tableau();
        for k in 0..4000 {
            let omega = 10_f64.powf(-3.0 + 0.002 * f64::from(k));
            let r = growth(&t, (0.0, omega));
            assert!(r <= 1.0 + 1e-12, "{method}: |R({omega}i)| = {r}");
        }
        assert!(growth(&t, (-1e12, 0.0)) < 1e-10, "{method}");
    }
}
