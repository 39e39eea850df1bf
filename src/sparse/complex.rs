//! LU factors of complex matrices: static condensation, exchange of rows, then KLU.
//!
//! The memory of unsteady friction in a tube is expressed by its flow ([`condense`](super::condense)): half of the unknowns of a beam with
//! two rows of bladders.
//!
//! ```text
//! [D C] [x_e]   [b_r]        x_e = D⁻¹ (b_r - C x_o)        D diagonal
//! [F G] [x_o] = [b_k]        (G - F D⁻¹ C) x_o = b_k - F D⁻¹ b_r
//! ```

use nalgebra::Complex;

use super::Pattern;
use super::condense::{CondensedMatrix, Elimination};
use super::exchange::Exchanged;
use super::klu::KluError;
use super::klu::complex::ComplexKlu;

type C = Complex<f64>;

/// Smallest pivot of a pair relative to the other entry of its row, on selection and later.
const SELECTED: f64 = 1.0;
const PIVOT: f64 = 0.01;
/// Number of an eliminated unknown or row among the remaining ones.
const NONE: usize = usize::MAX;

/// LU factors of complex matrices with a common pattern.
pub struct ComplexLu {
    condensation: Condensation,
    exchanged: Exchanged,
    /// Entries of the condensed matrix after the exchange of rows.
    reordered: Vec<C>,
    klu: ComplexKlu,
    /// Numerical factorizations.
    pub factorizations: u64,
    /// Right-hand sides solved for.
    pub solves: u64,
}

/// The condensed matrix and its right-hand side.
struct Condensation {
    pattern: Pattern,
    condensed: CondensedMatrix,
    /// Remaining unknowns; number of each unknown, and of the row paired with it, among them.
    kept: Vec<usize>,
    unknowns: Vec<usize>,
    rows: Vec<usize>,
    places: Vec<Destination>,
    /// Entries of F: remaining row and pair, and their values.
    shifts: Vec<[usize; 2]>,
    shifted: Vec<C>,
    /// `D⁻¹`, `-D⁻¹ C`, and `D⁻¹ b_r` of the present right-hand side.
    per: Vec<C>,
    ratio: Vec<C>,
    given: Vec<C>,
    /// Entries of the condensed matrix.
    values: Vec<C>,
    right: Vec<C>,
}

/// Destination of an entry of the matrix.
#[derive(Clone, Copy)]
enum Destination {
    /// None: it is in the row of a pair.
    Pair,
    /// Entry of the condensed matrix.
    Entry(usize),
    /// Pair whose ratio multiplies it, and entry of the condensed matrix.
    Folded(usize, usize),
}

impl ComplexLu {
    /// Analyzes a square pattern. Pairs and exchanges of rows are selected for these values.
    ///
    /// # Errors
    /// KLU cannot analyze the pattern.
    pub fn new(pattern: &Pattern, values: &[C]) -> Result<Self, KluError> {
        let suitable = |pair: &Elimination| pair.row == pair.given.0 && has_pivot(pair, values, SELECTED);
        Self::with(pattern, values, CondensedMatrix::new(pattern, suitable))
    }

    fn with(pattern: &Pattern, values: &[C], pairs: CondensedMatrix) -> Result<Self, KluError> {
        let (mut condensation, reduced) = Condensation::new(pattern, pairs);
        condensation.condense(values);
        let exchanged = Exchanged::new(&reduced, &condensation.values);
        Ok(Self {
            reordered: Vec::with_capacity(reduced.entries()),
            klu: ComplexKlu::new(&exchanged.pattern)?,
            condensation,
            exchanged,
            factorizations: 0,
            solves: 0,
        })
    }

    /// Factors the matrix with the entries `values`, in the order of the pattern.
    ///
    /// # Errors
    /// The matrix is singular; there are no factors then. Panics if the number of values differs from that of the pattern.
    pub fn factor(&mut self, values: &[C]) -> Result<(), KluError> {
        let of = &self.condensation;
        assert_eq!(values.len(), of.places.len(), "values of another pattern");
        self.factorizations += 1;
        if !of.condensed.pairs.iter().all(|pair| has_pivot(pair, values, PIVOT)) {
            let former = [self.factorizations, self.solves];
            *self = Self::with(&of.pattern, values, CondensedMatrix::new(&of.pattern, |_| false))?;
            [self.factorizations, self.solves] = former;
        }
        self.condensation.condense(values);
        self.exchanged.values(&self.condensation.values, &mut self.reordered);
        self.klu.factor(&self.reordered).map_err(|fault| match fault {
            KluError::Singular { column } => KluError::Singular {
                column: self.condensation.kept.get(column).copied().unwrap_or(column),
            },
            package @ KluError::Package { .. } => package,
        })
    }

    /// Replaces `b` by the solution of `A x = b`; returns false without factors. Panics if `b` has a wrong length.
    pub fn solve(&mut self, b: &mut [C]) -> bool {
        self.solves += 1;
        self.condensation.reduce(b);
        self.exchanged.rows(&mut self.condensation.right);
        let done = self.klu.solve(&mut self.condensation.right);
        self.condensation.complete(b);
        done
    }

    /// Replaces `b` by the solution of `Aᴴ x = b`; returns false without factors. Panics if `b` has a wrong length.
    pub fn solve_adjoint(&mut self, b: &mut [C]) -> bool {
        self.solves += 1;
        self.condensation.reduce_adjoint(b);
        let done = self.klu.solve_adjoint(&mut self.condensation.right);
        self.exchanged.rows(&mut self.condensation.right);
        self.condensation.complete_adjoint(b);
        done
    }
}

impl Condensation {
    /// The condensation by pairs, and the pattern of the condensed matrix.
    fn new(pattern: &Pattern, condensed: CondensedMatrix) -> (Self, Pattern) {
        let n = pattern.columns();
        let kept: Vec<usize> = (0..n).filter(|&unknown| condensed.by[unknown].is_none()).collect();
        let (mut unknowns, mut rows) = (vec![NONE; n], vec![NONE; n]);
        for (k, &unknown) in kept.iter().enumerate() {
            unknowns[unknown] = k;
            rows[condensed.row[unknown] as usize] = k;
        }
        let column_of = |column: usize| unknowns[condensed.joins(column)];
        let row_of = |entry: usize| rows[pattern.rows[entry] as usize];
        let mut columns = vec![vec![]; kept.len()];
        for column in 0..n {
            let own = pattern.column(column).map(row_of).filter(|row| *row != NONE);
            columns[column_of(column)].extend(own);
        }
        let reduced = Pattern::from_columns(&columns);
        let (mut places, mut shifts) = (Vec::with_capacity(pattern.entries()), vec![]);
        for column in 0..n {
            let to = reduced.column(column_of(column));
            for entry in pattern.column(column) {
                let row = row_of(entry);
                let found = reduced.rows[to.clone()].binary_search(&(row as i64));
                places.push(match (found, condensed.by[column]) {
                    (Err(_), _) => Destination::Pair,
                    (Ok(k), None) => Destination::Entry(to.start + k),
                    (Ok(k), Some(pair)) => {
                        shifts.push([row, pair as usize]);
                        Destination::Folded(pair as usize, to.start + k)
                    }
                });
            }
        }
        let pairs = || vec![C::default(); condensed.pairs.len()];
        let this = Self {
            pattern: pattern.clone(),
            unknowns,
            rows,
            places,
            shifted: vec![C::default(); shifts.len()],
            shifts,
            per: pairs(),
            ratio: pairs(),
            given: pairs(),
            values: vec![C::default(); reduced.entries()],
            right: vec![C::default(); kept.len()],
            kept,
            condensed,
        };
        (this, reduced)
    }

    /// Computes the condensed matrix.
    fn condense(&mut self, values: &[C]) {
        for ((pair, per), ratio) in self.condensed.pairs.iter().zip(&mut self.per).zip(&mut self.ratio) {
            *per = values[pair.given.1 as usize].inv();
            *ratio = -*per * values[pair.kept.1 as usize];
        }
        self.values.fill(C::default());
        let mut shifted = self.shifted.iter_mut();
        for (place, value) in self.places.iter().zip(values) {
            match *place {
                Destination::Pair => {}
                Destination::Entry(place) => self.values[place] += value,
                Destination::Folded(pair, place) => {
                    self.values[place] += self.ratio[pair] * value;
                    shifted.next().into_iter().for_each(|shifted| *shifted = *value);
                }
            }
        }
    }

    /// Computes the condensed right-hand side of `A x = b`.
    fn reduce(&mut self, b: &[C]) {
        assert_eq!(b.len(), self.rows.len(), "right-hand side of another size");
        for (row, value) in self.rows.iter().zip(b).filter(|(row, _)| **row != NONE) {
            self.right[*row] = *value;
        }
        for ((pair, per), given) in self.condensed.pairs.iter().zip(&self.per).zip(&mut self.given) {
            *given = per * b[pair.row as usize];
        }
        for ([row, pair], value) in self.shifts.iter().zip(&self.shifted) {
            self.right[*row] -= value * self.given[*pair];
        }
    }

    /// Writes the solution of all unknowns.
    fn complete(&self, b: &mut [C]) {
        for (unknown, value) in self.kept.iter().zip(&self.right) {
            b[*unknown] = *value;
        }
        for ((pair, given), ratio) in self.condensed.pairs.iter().zip(&self.given).zip(&self.ratio) {
            b[pair.given.0 as usize] = given + ratio * b[pair.kept.0 as usize];
        }
    }

    /// Computes the condensed right-hand side of `Aᴴ x = b`.
    fn reduce_adjoint(&mut self, b: &[C]) {
        assert_eq!(b.len(), self.rows.len(), "right-hand side of another size");
        for (unknown, right) in self.kept.iter().zip(&mut self.right) {
            *right = b[*unknown];
        }
        for ((pair, given), ratio) in self.condensed.pairs.iter().zip(&mut self.given).zip(&self.ratio) {
            *given = b[pair.given.0 as usize];
            self.right[self.unknowns[pair.kept.0 as usize]] += ratio.conj() * *given;
        }
    }

    /// Writes the solution of all rows.
    fn complete_adjoint(&mut self, b: &mut [C]) {
        for ([row, pair], value) in self.shifts.iter().zip(&self.shifted) {
            self.given[*pair] -= value.conj() * self.right[*row];
        }
        for (row, value) in self.rows.iter().zip(&mut *b).filter(|(row, _)| **row != NONE) {
            *value = self.right[*row];
        }
        for ((pair, given), per) in self.condensed.pairs.iter().zip(&self.given).zip(&self.per) {
            b[pair.row as usize] = per.conj() * given;
        }
    }
}

/// True if the pivot of a pair is at least `ratio` times the other entry of its row.
fn has_pivot(pair: &Elimination, values: &[C], ratio: f64) -> bool {
    let size = |entry: u32| values[entry as usize].norm();
    size(pair.given.1) >= ratio * size(pair.kept.1) && size(pair.given.1) > 0.0
}
