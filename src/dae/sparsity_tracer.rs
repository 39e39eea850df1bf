//! Sparsity tracer: evaluates the residual with numbers that record their dependence on unknowns.

use std::cell::RefCell;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use crate::discrete::{System, TimeData, Workspace, residual};
use crate::numerics::Scalar;

/// A number represented only by the unknowns it depends on: an index into the thread's table of sorted sets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DependencyTracer(u32);

thread_local! {
    static SETS: RefCell<Vec<Vec<u32>>> = const { RefCell::new(Vec::new()) };
}

const NOTHING: DependencyTracer = DependencyTracer(0);

impl DependencyTracer {
    fn unknown(index: usize) -> Self {
        SETS.with_borrow_mut(|sets| {
            sets.push(vec![index as u32]);
            Self(sets.len() as u32 - 1)
        })
    }

    fn union(self, other: Self) -> Self {
        if self == other || other == NOTHING {
            return self;
        }
        if self == NOTHING {
            return other;
        }
        SETS.with_borrow_mut(|sets| {
            let (a, b) = (&sets[self.0 as usize], &sets[other.0 as usize]);
            if includes(a, b) {
                return self;
            }
            if includes(b, a) {
                return other;
            }
            let mut both: Vec<u32> = a.iter().chain(b).copied().collect();
            both.sort_unstable();
            both.dedup();
            sets.push(both);
            Self(sets.len() as u32 - 1)
        })
    }
}

/// True if an ascending set includes another one. Most unions are of such sets.
fn includes(whole: &[u32], part: &[u32]) -> bool {
    let mut rest = whole.iter();
    part.len() <= whole.len() && part.iter().all(|one| rest.any(|other| other == one))
}

/// Dependence of each output of an evaluation on unknowns, and on strains by pressure, which are numbered after the unknowns; ascending.
#[derive(Clone, Debug)]
pub struct Dependence {
    /// Equations.
    pub equations: Vec<Vec<u32>>,
    /// Moments of nodes.
    pub moments: Vec<Vec<u32>>,
    /// Moments of both sides of nodes where neutral axes jump.
    pub side_moments: Vec<Vec<u32>>,
    /// Normal forces of cells.
    pub forces: Vec<Vec<u32>>,
    /// The strains by pressure, in the order of [`crate::discrete::workspace::Coupling::strains_mut`].
    pub strains: Vec<Vec<u32>>,
}

impl Dependence {
    /// Traces a system's residual as a function of unknowns and rates.
    pub fn new(system: &System, now: &TimeData) -> Self {
        let n = system.layout.len;
        SETS.with_borrow_mut(|sets| {
            sets.clear();
            sets.push(Vec::new());
        });
        let y: Vec<DependencyTracer> = (0..n).map(DependencyTracer::unknown).collect();
        let yp: Vec<DependencyTracer> = y
            .iter()
            .zip(&system.layout.differential)
            .map(|(&t, &d)| if d { t } else { NOTHING })
            .collect();
        let mut residual = vec![NOTHING; n];
        let mut workspace = Workspace::new(system);
        residual::until_strains(system, now, &y, &yp, &mut workspace);
        let strains: Vec<DependencyTracer> = workspace.coupling.strains_mut().map(|strain| *strain).collect();
        for (k, strain) in workspace.coupling.strains_mut().enumerate() {
            if *strain != NOTHING {
                *strain = DependencyTracer::unknown(n + k);
            }
        }
        residual::beyond_strains(system, now, &mut workspace);
        residual::equations(system, now, &y, &yp, &workspace, &mut residual);
        SETS.with_borrow_mut(|sets| {
            let known = |all: &[DependencyTracer]| all.iter().map(|trace| sets[trace.0 as usize].clone()).collect();
            let on = Self {
                equations: known(&residual),
                moments: known(&workspace.forces.moment),
                side_moments: known(workspace.forces.side_moment.as_flattened()),
                forces: known(&workspace.forces.normal),
                strains: known(&strains),
            };
            *sets = Vec::new();
            on
        })
    }
}

/// Operators whose result depends on both operands, or on one operand and a constant.
macro_rules! operators {
    ($($Op:ident $op:ident),*; $($Onto:ident $onto:ident),*) => {
        $(impl $Op for DependencyTracer {
            type Output = Self;
            fn $op(self, other: Self) -> Self {
                self.union(other)
            }
        }
        impl $Op<f64> for DependencyTracer {
            type Output = Self;
            fn $op(self, _: f64) -> Self {
                self
            }
        })*
        $(impl $Onto for DependencyTracer {
            fn $onto(&mut self, other: Self) {
                *self = self.union(other);
            }
        })*
    };
}

operators!(Add add, Sub sub, Mul mul, Div div; AddAssign add_assign, SubAssign sub_assign);

impl Neg for DependencyTracer {
    type Output = Self;
    fn neg(self) -> Self {
        self
    }
}

impl Scalar for DependencyTracer {
    fn constant(_: f64) -> Self {
        NOTHING
    }
    fn value(&self) -> Option<f64> {
        None
    }
    fn sqrt(self) -> Self {
        self
    }
    fn atan2(self, x: Self) -> Self {
        self.union(x)
    }
    fn sin_cos(self) -> (Self, Self) {
        (self, self)
    }
    fn lift(self, _: impl Fn(f64) -> (f64, f64)) -> Self {
        self
    }
    fn lift_with(self, other: Self, _: impl Fn(f64, f64) -> (f64, [f64; 2])) -> Self {
        self.union(other)
    }
}
