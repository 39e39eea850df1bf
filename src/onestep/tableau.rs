//! Coefficients of stiffly accurate, singly diagonally implicit methods with an explicit first stage.

use std::fmt;

/// The methods, all L-stable; `p(q)s` are the order, the order of the estimate and the number of stages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableauMethod {
    /// TR-BDF2, 2(3)3: Bank et al. 1985; Hosea & Shampine 1996.
    TrBdf2,
    /// ESDIRK3(2)4L\[2\]SA: Kennedy & Carpenter 2003, the implicit half of ARK3(2)4L\[2\]SA, with their embedding of 2019.
    Esdirk34,
    /// ESDIRK4(3)6L\[2\]SA: Kennedy & Carpenter 2003, the implicit half of ARK4(3)6L\[2\]SA.
    Esdirk46,
    /// ESDIRK5(4)7L\[2\]SA2: Kennedy & Carpenter 2019.
    Esdirk57,
}

impl TableauMethod {
    /// All methods, by ascending order.
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

impl fmt::Display for TableauMethod {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::TrBdf2 => "TR-BDF2",
            Self::Esdirk34 => "ESDIRK3(2)4",
            Self::Esdirk46 => "ESDIRK4(3)6",
            Self::Esdirk57 => "ESDIRK5(4)7",
        })
    }
}

/// Largest remaining error of Newton's iteration, as a fraction of the tolerance.
pub(super) const LEFTOVER: f64 = 0.02;
/// Relative tolerance above which this fraction suffices.
const LEFTOVER_TOLERANCE: f64 = 1e-4;
/// Smallest remaining error that is required, relative to the unknowns: rounding errors of a stage stay below it.
const LEAST_LEFTOVER: f64 = 2e-12;

/// Maximum number of stages of a method.
pub const STAGES: usize = 7;

/// Coefficients of a method; only the first [`Tableau::stages`] entries of each array are used.
///
/// The first row of `a` is zero, the diagonal of the others is `γ`, the last row is `b`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tableau {
    /// Number of stages, including the explicit first one.
    pub stages: usize,
    /// The error estimate is proportional to `h^power`.
    pub power: u8,
    /// Power of `h ω` with which a step damps an undamped oscillation: `1 - |R(i h ω)| ~ (h ω)^damping`.
    pub damping: u8,
    /// Times of the stages within the step.
    pub c: [f64; STAGES],
    /// Weights of the previous stages and of the stage itself.
    pub a: [[f64; STAGES]; STAGES],
    /// Weights of the embedded method.
    pub embedded: [f64; STAGES],
    /// Stages through which algebraic unknowns are interpolated: well separated, including both ends.
    pub nodes: &'static [usize],
}

impl Tableau {
    /// Diagonal element γ.
    pub fn gamma(&self) -> f64 {
        self.a[1][1]
    }

    /// Remaining error of Newton's iteration as a fraction κ of the tolerance.
    ///
    /// The error test chooses `(h ω)^power ~ rtol`, and a step removes `(h ω)^damping` of the amplitude of an undamped oscillation. The
    /// remaining error has either sign. With `κ rtol ~ rtol^(damping/power)` it stays below that loss, and energy does not grow.
    pub fn newton_tolerance(&self, relative: f64) -> f64 {
        let excess = f64::from(self.damping) / f64::from(self.power) - 1.0;
        let share = LEFTOVER * (relative / LEFTOVER_TOLERANCE).min(1.0).powf(excess);
        share.max(LEAST_LEFTOVER / relative).min(LEFTOVER)
    }

    /// Factor by which a step multiplies the solution of `y' = λ y`, for `z = h λ` as real and imaginary part: `1 + z bᵀ(1 - zA)⁻¹ 1`.
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

/// Array that begins with the given entries; the rest is zero.
const fn row(first: &[f64]) -> [f64; STAGES] {
    let mut row = [0.0; STAGES];
    let (begin, _) = row.split_at_mut(first.len());
    begin.copy_from_slice(first);
    row
}

fn trbdf2() -> Tableau {
    let root = std::f64::consts::SQRT_2;
    let (gamma, w) = (1.0 - 0.5 * root, 0.25 * root);
    let mut a = [[0.0; STAGES]; STAGES];
    a[1] = row(&[gamma, gamma]);
    a[2] = row(&[w, w, gamma]);
    Tableau {
        stages: 3,
        power: 3,
        damping: 4,
        c: row(&[0.0, 2.0 * gamma, 1.0]),
        a,
        embedded: row(&[(1.0 - w) / 3.0, (1.0 + 3.0 * w) / 3.0, gamma / 3.0]),
        nodes: &[0, 1, 2],
    }
}

const ESDIRK34: Tableau = Tableau {
    stages: 4,
    power: 3,
    damping: 4,
    c: row(&[0.0, 0.871733043016918, 0.6, 1.0]),
    a: [
        [0.0; STAGES],
        row(&[0.435866521508459, 0.435866521508459]),
        row(&[0.2576482460664272, -0.09351476757488625, 0.435866521508459]),
        row(&[
            0.18764102434672383,
            -0.595297473576955,
            0.9717899277217721,
            0.435866521508459,
        ]),
        [0.0; STAGES],
        [0.0; STAGES],
        [0.0; STAGES],
    ],
    embedded: row(&[
        0.10889661761586122,
        -0.9153258118707118,
        1.2712735973021543,
        0.5351555969526962,
    ]),
    nodes: &[0, 2, 1, 3],
};

const ESDIRK46: Tableau = Tableau {
    stages: 6,
    power: 4,
    damping: 6,
    c: row(&[0.0, 0.5, 0.332, 0.62, 0.85, 1.0]),
    a: [
        [0.0; STAGES],
        row(&[0.25, 0.25]),
        row(&[0.137776, -0.055776, 0.25]),
        row(&[0.14463686602698217, -0.22393190761334475, 0.4492950415863626, 0.25]),
        row(&[
            0.09825878328356477,
            -0.5915442428196704,
            0.8101210538282996,
            0.283164405707806,
            0.25,
        ]),
        row(&[
            0.15791629516167136,
            0.0,
            0.18675894052400077,
            0.6805652953093346,
            -0.27524053099500667,
            0.25,
        ]),
        [0.0; STAGES],
    ],
    embedded: row(&[
        0.15471180076321217,
        0.0,
        0.18920519166068023,
        0.7020453712289219,
        -0.3191873990635791,
        0.27322503541076487,
    ]),
    nodes: &[0, 2, 3, 5],
};

const ESDIRK57: Tableau = Tableau {
    stages: 7,
    power: 5,
    damping: 6,
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
        [0.0; STAGES],
        row(&[0.184, 0.184]),
        row(&[0.2221076477383247, 0.22210764773832475, 0.184]),
        row(&[
            -0.014049475381926274,
            -0.014049475381926283,
            -0.01709085093586415,
            0.184,
        ]),
        row(&[
            -0.40838859254931487,
            -0.40838859254931464,
            0.16646399821362964,
            1.1662718062895745,
            0.184,
        ]),
        row(&[
            -0.5392907235588111,
            -0.5392907235588114,
            -0.242234428845425,
            1.4888806111225146,
            0.5563122281913184,
            0.184,
        ]),
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
