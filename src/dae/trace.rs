//! The pattern of the Jacobian, found by running the residual on numbers that remember what they depend on.

use std::cell::RefCell;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use crate::discrete::{System, TimeData, Workspace, residual};
use crate::numerics::Scalar;
use crate::sparse::Pattern;

/// A number known only by the unknowns it depends on: an index into the thread's table of sorted sets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trace(u32);

thread_local! {
    static SETS: RefCell<Vec<Vec<u32>>> = const { RefCell::new(Vec::new()) };
}

const NOTHING: Trace = Trace(0);

impl Trace {
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
            let mut both: Vec<u32> = a.iter().chain(b).copied().collect();
            both.sort_unstable();
            both.dedup();
            if both.len() == a.len() {
                return self;
            }
            if both.len() == b.len() {
                return other;
            }
            sets.push(both);
            Self(sets.len() as u32 - 1)
        })
    }
}

/// Stored entries of the Jacobian of a system's residual with respect to unknowns and their rates.
pub fn pattern(system: &System, now: &TimeData) -> Pattern {
    let n = system.layout.len;
    SETS.with_borrow_mut(|sets| {
        sets.clear();
        sets.push(Vec::new());
    });
    let y: Vec<Trace> = (0..n).map(Trace::unknown).collect();
    let yp: Vec<Trace> = y
        .iter()
        .zip(&system.layout.differential)
        .map(|(&t, &d)| if d { t } else { NOTHING })
        .collect();
    let mut residual = vec![NOTHING; n];
    let mut workspace = Workspace::new(system);
    residual::residual(system, now, &y, &yp, &mut workspace, &mut residual);
    let mut columns = vec![Vec::new(); n];
    SETS.with_borrow_mut(|sets| {
        for (row, trace) in residual.iter().enumerate() {
            for &column in &sets[trace.0 as usize] {
                columns[column as usize].push(row);
            }
        }
        *sets = Vec::new();
    });
    Pattern::from_columns(&columns)
}

/// What depends on both, on one, or on what is added to it.
macro_rules! operators {
    ($($Op:ident $op:ident),*; $($Onto:ident $onto:ident),*) => {
        $(impl $Op for Trace {
            type Output = Self;
            fn $op(self, other: Self) -> Self {
                self.union(other)
            }
        }
        impl $Op<f64> for Trace {
            type Output = Self;
            fn $op(self, _: f64) -> Self {
                self
            }
        })*
        $(impl $Onto for Trace {
            fn $onto(&mut self, other: Self) {
                *self = self.union(other);
            }
        })*
    };
}

operators!(Add add, Sub sub, Mul mul, Div div; AddAssign add_assign, SubAssign sub_assign);

impl Neg for Trace {
    type Output = Self;
    fn neg(self) -> Self {
        self
    }
}

impl Scalar for Trace {
    fn constant(_: f64) -> Self {
        NOTHING
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
