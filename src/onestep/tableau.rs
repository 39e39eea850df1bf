//! Coefficients of stiffly accurate, singly diagonally implicit methods with an explicit first stage.

use std::fmt;

/// The methods, all L-stable, `p(q)s`: order, order of the estimate, stages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// TR-BDF2, 2(3)3: Bank et al. 1985; Hosea & Shampine 1996.
    TrBdf2,
    /// ESDIRK3(2)4L\[2\]SA: Kennedy & Carpenter 2003, the implicit half of ARK3(2)4L\[2\]SA, with their embedding of 2019.
    Esdirk34,
    /// ESDIRK4(3)6L\[2\]SA: Kennedy & Carpenter 2003, the implicit half of ARK4(3)6L\[2\]SA.
    Esdirk46,
    /// ESDIRK5(4)7L\[2\]SA2: Kennedy & Carpenter 2019.
    Esdirk57,
}

impl Method {
    /// All, by rising order.
    pub const ALL: [Self; 4] = [Self::TrBdf2, Self::Esdirk34, Self::Esdirk46, Self::Esdirk57];

    /// Order of the result.
    pub fn order(self) -> u8 {
        match self {
            Self::TrBdf2 => 2,
            Self::Esdirk34 => 3,
            Self::Esdirk46 => 4,
            Self::Esdirk57 => 5,
        }
    }

    /// Coefficients.
    pub fn tableau(self) -> Tableau {
        match self {
            Self::TrBdf2 => trbdf2(),
            Self::Esdirk34 => ESDIRK34,
            Self::Esdirk46 => ESDIRK46,
            Self::Esdirk57 => ESDIRK57,
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::TrBdf2 => "TR-BDF2",
            Self::Esdirk34 => "ESDIRK3(2)4",
            Self::Esdirk46 => "ESDIRK4(3)6",
            Self::Esdirk57 => "ESDIRK5(4)7",
        })
    }
}

/// Most stages of a method.
pub const STAGES: usize = 7;

/// A method's coefficients; of each array the first [`Tableau::stages`] entries count.
///
/// The first row of `a` is zero, the diagonal of the others is `γ`, the last row is `b`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tableau {
    /// Number of stages, the explicit first one included.
    pub stages: usize,
    /// `h^power` is what the estimate of the error falls with.
    pub power: u8,
    /// Times of the stages within the step.
    pub c: [f64; STAGES],
    /// Weights of the stages before and of each itself.
    pub a: [[f64; STAGES]; STAGES],
    /// Weights of the embedded method.
    pub embedded: [f64; STAGES],
    /// Stages through which algebraic unknowns are interpolated: well apart, both ends included.
    pub nodes: &'static [usize],
}

impl Tableau {
    /// The diagonal.
    pub fn gamma(&self) -> f64 {
        self.a[1][1]
    }

    /// Factor by which a step multiplies the solution of `y' = λ y`, `z = h λ`, real and imaginary part: `1 + z bᵀ(1 - zA)⁻¹ 1`.
    pub fn stability(&self, (re, im): (f64, f64)) -> (f64, f64) {
        let mul = |a: (f64, f64), b: (f64, f64)| (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
        let mut u = [(0.0, 0.0); STAGES];
        for i in 0..self.stages {
            let before = (0..i).fold((0.0, 0.0), |s, j| {
                (s.0 + self.a[i][j] * u[j].0, s.1 + self.a[i][j] * u[j].1)
            });
            let before = mul((re, im), before);
            let (p, q) = (1.0 - self.a[i][i] * re, -self.a[i][i] * im);
            let square = p * p + q * q;
            u[i] = mul((1.0 + before.0, before.1), (p / square, -q / square));
        }
        u[self.stages - 1]
    }

    /// Weights of the result.
    pub fn b(&self) -> [f64; STAGES] {
        self.a[self.stages - 1]
    }
}

fn trbdf2() -> Tableau {
    let root = std::f64::consts::SQRT_2;
    let (gamma, w) = (1.0 - 0.5 * root, 0.25 * root);
    let row = |x: &[f64]| {
        let mut row = [0.0; STAGES];
        row[..x.len()].copy_from_slice(x);
        row
    };
    let mut a = [[0.0; STAGES]; STAGES];
    a[1] = row(&[gamma, gamma]);
    a[2] = row(&[w, w, gamma]);
    Tableau {
        stages: 3,
        power: 3,
        c: row(&[0.0, 2.0 * gamma, 1.0]),
        a,
        embedded: row(&[(1.0 - w) / 3.0, (1.0 + 3.0 * w) / 3.0, gamma / 3.0]),
        nodes: &[0, 1, 2],
    }
}

const ESDIRK34: Tableau = Tableau {
    stages: 4,
    power: 3,
    c: [0.0, 0.871733043016918, 0.6, 1.0, 0.0, 0.0, 0.0],
    a: [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.435866521508459, 0.435866521508459, 0.0, 0.0, 0.0, 0.0, 0.0],
        [
            0.2576482460664272,
            -0.09351476757488625,
            0.435866521508459,
            0.0,
            0.0,
            0.0,
            0.0,
        ],
        [
            0.18764102434672383,
            -0.595297473576955,
            0.9717899277217721,
            0.435866521508459,
            0.0,
            0.0,
            0.0,
        ],
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    ],
    embedded: [
        0.10889661761586122,
        -0.9153258118707118,
        1.2712735973021543,
        0.5351555969526962,
        0.0,
        0.0,
        0.0,
    ],
    nodes: &[0, 2, 1, 3],
};

const ESDIRK46: Tableau = Tableau {
    stages: 6,
    power: 4,
    c: [0.0, 0.5, 0.332, 0.62, 0.85, 1.0, 0.0],
    a: [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.25, 0.25, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.137776, -0.055776, 0.25, 0.0, 0.0, 0.0, 0.0],
        [
            0.14463686602698217,
            -0.22393190761334475,
            0.4492950415863626,
            0.25,
            0.0,
            0.0,
            0.0,
        ],
        [
            0.09825878328356477,
            -0.5915442428196704,
            0.8101210538282996,
            0.283164405707806,
            0.25,
            0.0,
            0.0,
        ],
        [
            0.15791629516167136,
            0.0,
            0.18675894052400077,
            0.6805652953093346,
            -0.27524053099500667,
            0.25,
            0.0,
        ],
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    ],
    embedded: [
        0.15471180076321217,
        0.0,
        0.18920519166068023,
        0.7020453712289219,
        -0.3191873990635791,
        0.27322503541076487,
        0.0,
    ],
    nodes: &[0, 2, 3, 5],
};

const ESDIRK57: Tableau = Tableau {
    stages: 7,
    power: 5,
    c: [
        0.0,
        0.368,
        0.6282152954766494,
        0.1388101983002833,
        0.6999586194045747,
        0.9083769633507853,
        1.0,
    ],
    a: [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.184, 0.184, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.2221076477383247, 0.22210764773832475, 0.184, 0.0, 0.0, 0.0, 0.0],
        [
            -0.014049475381926274,
            -0.014049475381926283,
            -0.01709085093586415,
            0.184,
            0.0,
            0.0,
            0.0,
        ],
        [
            -0.40838859254931487,
            -0.40838859254931464,
            0.16646399821362964,
            1.1662718062895745,
            0.184,
            0.0,
            0.0,
        ],
        [
            -0.5392907235588111,
            -0.5392907235588114,
            -0.242234428845425,
            1.4888806111225146,
            0.5563122281913184,
            0.184,
            0.0,
        ],
        [
            -0.03946606910974035,
            -0.03946606910974026,
            0.27263649025024267,
            0.4321651725202882,
            0.3524160862328891,
            -0.16228561078393952,
            0.184,
        ],
    ],
    embedded: [
        -0.08068946656664727,
        -0.08068946656664744,
        0.18289968461343553,
        0.517013873766231,
        0.4265997313024543,
        -0.10432685796713498,
        0.13919250141830897,
    ],
    nodes: &[0, 1, 4, 6],
};

#[cfg(test)]
mod tests {
    use super::*;

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
        /// Elementary weight at every stage, without the root's own sum.
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

    /// All trees of one size; a branch list may come in several orders, which does no harm.
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

    /// Butcher's order conditions. Source: Hairer, Nørsett & Wanner I, II.2. Tolerance: rounding of products of at most five
    /// sums of seven coefficients, the largest 2.5; and the next order is not reached.
    #[test]
    fn order_conditions_hold() {
        for method in Method::ALL {
            let t = method.tableau();
            let order = usize::from(method.order());
            assert!(defect(&t, &t.b(), order) < 1e-14, "{method}");
            assert!(defect(&t, &t.b(), order + 1) > 1e-5, "{method}");
            let embedded = if method == Method::TrBdf2 { 3 } else { order - 1 };
            assert!(defect(&t, &t.embedded, embedded) < 1e-14, "{method}, embedded");
            assert_eq!(usize::from(t.power), order.min(embedded) + 1);
        }
    }

    /// Rows sum to their times, the form is the one the solver relies on, and the second stage is of second order.
    #[test]
    fn form_is_singly_diagonal_and_stiffly_accurate() {
        for method in Method::ALL {
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
        for method in Method::ALL {
            let t = method.tableau();
            for k in 0..4000 {
                let omega = 10_f64.powf(-3.0 + 0.002 * f64::from(k));
                let r = growth(&t, (0.0, omega));
                assert!(r <= 1.0 + 1e-12, "{method}: |R({omega}i)| = {r}");
            }
            assert!(growth(&t, (-1e12, 0.0)) < 1e-10, "{method}");
        }
    }
}
