//! Special points of a branch of cycles: folds and loss of stability, located between two cycles.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use crate::run::floquet::Floquet;
use crate::run::periodic::family::FamilyState;

/// Value of a test function, over the larger one at the ends of the step, at which a point counts as located.
pub const LOCATED: f64 = 1e-3;
/// Share of the step to which a point is located at least.
pub const SHARE: f64 = 1e-4;
/// Value of a test function, over the larger one at the ends of the step, above which it jumps and has no zero.
pub const JUMP: f64 = 0.05;
/// Largest number of cycles for one location.
pub const TRIES: usize = 12;
/// Distance of a multiplier from the unit circle that is within the error of the steps.
const NEUTRAL: f64 = 1e-5;
/// Slope of the coordinate along the branch below which a multiplier near 1 is that of a fold.
const FLAT: f64 = 0.02;
/// Angle [rad] from the real axis within which a multiplier counts as real.
const REAL: f64 = 1e-6;

/// Kind of a special point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SpecialKind {
    /// The parameter has an extremum; a multiplier is 1.
    Fold,
    /// A multiplier passes 1 without a fold: another branch crosses, often one of lower symmetry.
    Crossing,
    /// A multiplier passes -1: a cycle of two periods begins.
    PeriodDoubling,
    /// A complex pair passes the unit circle: a motion with a second frequency begins.
    NeimarkSacker,
}

impl SpecialKind {
    /// All kinds.
    pub const ALL: [Self; 4] = [Self::Fold, Self::Crossing, Self::PeriodDoubling, Self::NeimarkSacker];

    /// Name in tables.
    pub fn describe(self) -> &'static str {
        match self {
            Self::Fold => "fold",
            Self::Crossing => "crossing branch",
            Self::PeriodDoubling => "period doubling",
            Self::NeimarkSacker => "Neimark-Sacker",
        }
    }

    /// Multiplier, real and imaginary part, nearest to the place where those of this kind pass the unit circle.
    pub fn multiplier(self, floquet: &Floquet) -> Option<(f64, f64)> {
        let distance = |(re, im): &(f64, f64)| match self {
            Self::Fold | Self::Crossing => (re - 1.0).hypot(*im),
            Self::PeriodDoubling => (re + 1.0).hypot(*im),
            Self::NeimarkSacker => (re.hypot(*im) - 1.0).abs(),
        };
        let all = floquet.multipliers.iter().map(|m| (m.re, m.im));
        let all = all.filter(|(re, im)| self != Self::NeimarkSacker || oscillates(*re, *im));
        all.min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }

    /// Test function, whose sign changes at a point of this kind:
    ///
    /// ```text
    /// fold               slope of the coordinate along the branch
    /// crossing           Π (1 - μ)      period doubling  Π (1 + μ)      with both of a complex pair: continuous where pairs become real
    /// Neimark-Sacker     largest |μ| - 1 of a complex pair
    /// ```
    pub fn test(self, state: &FamilyState, floquet: &Floquet) -> f64 {
        let from = |place: f64| {
            let factor = |re: f64, im: f64| {
                if im == 0.0 {
                    1.0 - re * place
                } else {
                    (1.0 - re * place).powi(2) + im * im
                }
            };
            floquet.multipliers.iter().map(|m| factor(m.re, m.im)).product()
        };
        match self {
            Self::Fold => state.slope / state.slope.hypot(length(state)),
            Self::Crossing => from(1.0),
            Self::PeriodDoubling => from(-1.0),
            Self::NeimarkSacker => {
                let pairs = floquet.multipliers.iter().filter(|m| oscillates(m.re, m.im));
                pairs.map(|m| m.modulus - 1.0).fold(-1.0, f64::max)
            }
        }
    }
}

/// True for a multiplier of a complex pair.
fn oscillates(re: f64, im: f64) -> bool {
    (REAL..=PI - REAL).contains(&im.atan2(re))
}

/// Length of the change of state along the tangent, in its unit.
fn length(state: &FamilyState) -> f64 {
    state
        .tangent
        .iter()
        .map(|x| (x / state.size).powi(2))
        .sum::<f64>()
        .sqrt()
}

/// A located special point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpecialPoint {
    /// Kind.
    pub kind: SpecialKind,
    /// Multiplier, real and imaginary part >= 0, if it is among those computed.
    pub multiplier: Option<(f64, f64)>,
    /// Last correction of the value in the location.
    pub value_error: f64,
}

impl SpecialPoint {
    /// Description in a table.
    pub fn describe(&self) -> String {
        let multiplier = match self.multiplier {
            Some((re, 0.0)) => format!(", multiplier {re:.4}"),
            Some((re, im)) => format!(", multipliers {re:.4} ± {im:.4} i"),
            None => String::new(),
        };
        let name = self.kind.describe();
        format!("{name} (value located to {:.0e}){multiplier}", self.value_error)
    }
}

/// Kinds whose test functions change their sign between two cycles, with both values. A fold also moves a multiplier through 1.
pub fn between(a: (&FamilyState, &Floquet), b: (&FamilyState, &Floquet)) -> Vec<(SpecialKind, [f64; 2])> {
    let values = |kind: SpecialKind| [kind.test(a.0, a.1), kind.test(b.0, b.1)];
    let [first, second] = values(SpecialKind::Fold);
    let fold = first * second < 0.0 || first.abs().min(second.abs()) < FLAT;
    let all = SpecialKind::ALL.map(|kind| (kind, values(kind))).into_iter();
    let changes = all.filter(|(kind, [a, b])| match kind {
        SpecialKind::Fold => a * b < 0.0,
        SpecialKind::Crossing if fold => false,
        _ => a * b < 0.0 && a.abs().max(b.abs()) > NEUTRAL,
    });
    changes.collect()
}
