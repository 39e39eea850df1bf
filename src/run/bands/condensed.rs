//! Equations of a cell at one frequency, for the unknowns that other cells contain.

use nalgebra::{Complex, DMatrix, DVector};
use slcbeam_dense::eigen;

use super::cell::RepeatingCell;

/// Numbers near which factors are searched, in this order: off the unit circle and the real axis.
const SHIFTS: [Complex<f64>; 3] = [
    Complex::new(0.53, 0.71),
    Complex::new(-0.61, 0.83),
    Complex::new(1.37, -0.29),
];
/// Size of `1/(λ - σ)`, relative to the largest, below which a factor is infinite.
const FINITE: f64 = 1e-12;
/// Newton steps for a factor, and the relative change by which they may move it.
const STEPS: usize = 4;
const SETTLED: f64 = 1e-3;

/// A factor λ with the unknowns of the cell.
pub type FactorPair = (Complex<f64>, Vec<Complex<f64>>);

/// Let r be the equations that contain unknowns of other cells, and w what these contribute to them. With `G = T_0⁻¹`
///
/// ```text
/// T_0 x + E_r w = 0        w = (T_-/λ + λ T_+)_r x        (λ + (T_- G)_rr + λ² (T_+ G)_rr) w = 0        x = -G E_r w
/// ```
pub struct Condensed {
    /// `G E_r`.
    answers: DMatrix<Complex<f64>>,
    /// `(T_- G)_rr` and `(T_+ G)_rr`.
    parts: [DMatrix<Complex<f64>>; 2],
}

impl Condensed {
    /// Equations of a cell at s. None if `T_0` is singular.
    pub fn new(cell: &RepeatingCell, s: Complex<f64>) -> Option<Self> {
        let n = cell.len();
        let mut parts = [0; 3].map(|_| DMatrix::<Complex<f64>>::zeros(n, n));
        let mut outer = vec![false; n];
        for entry in &cell.entries {
            parts[entry.cell][(entry.row, entry.column)] += s * entry.values[1] + entry.values[0];
            outer[entry.row] |= entry.cell != 1;
        }
        for row in 0..n {
            let sizes = parts
                .iter()
                .map(|part| part.row(row).iter().map(|x| x.norm_sqr()).fold(0.0, f64::max));
            let largest = sizes.fold(f64::MIN_POSITIVE, f64::max).sqrt();
            parts
                .iter_mut()
                .for_each(|part| part.row_mut(row).iter_mut().for_each(|x| *x /= largest));
        }
        let rows: Vec<usize> = (0..n).filter(|row| outer[*row]).collect();
        let [before, own, behind] = parts;
        let answers = own.lu().solve(&DMatrix::identity(n, n).select_columns(&rows))?;
        let finite = answers.iter().all(|x| x.norm().is_finite());
        finite.then(|| Self {
            parts: [before, behind].map(|part| part.select_rows(&rows) * &answers),
            answers,
        })
    }

    /// Polynomial at λ, and its derivative.
    fn at(&self, factor: Complex<f64>) -> [DMatrix<Complex<f64>>; 2] {
        let [before, behind] = &self.parts;
        let mut value = before + behind * (factor * factor);
        let mut derivative = behind * (factor * 2.0);
        for k in 0..value.nrows() {
            value[(k, k)] += factor;
            derivative[(k, k)] += 1.0;
        }
        [value, derivative]
    }

    /// Factors λ of the finite waves, with all unknowns of the cell. None if the equations are singular for every λ.
    ///
    /// With `θ = 1/(λ - σ)` the polynomial is `θ² P(σ) + θ P'(σ) + (T_+ G)_rr`, whose companion matrix has an ordinary eigenvalue problem.
    pub fn waves(&self) -> Option<Vec<FactorPair>> {
        let n = self.answers.ncols();
        let (shift, companion) = SHIFTS.iter().find_map(|&shift| {
            let [value, derivative] = self.at(shift);
            let lu = value.lu();
            let parts = [lu.solve(&self.parts[1])?, lu.solve(&derivative)?];
            let finite = parts.iter().flat_map(|part| part.iter()).all(|x| x.norm().is_finite());
            finite.then_some((shift, parts))
        })?;
        let entry = |row: usize, column: usize| match row.checked_sub(n) {
            None if column == row + n => Complex::new(1.0, 0.0),
            None => Complex::default(),
            Some(row) => -companion[column / n][(row, column % n)],
        };
        let mut all = eigen(2 * n, &entry)?;
        let largest = all.first().map_or(0.0, |(theta, _)| theta.norm());
        all.retain(|(theta, _)| theta.norm() > FINITE * largest);
        let wave = |(theta, x): (Complex<f64>, Vec<Complex<f64>>)| {
            let (factor, w) = self.refined(shift + theta.inv(), DVector::from_column_slice(&x[..n]));
            (factor, (&self.answers * w).iter().map(|x| -x).collect())
        };
        Some(all.into_iter().map(wave).collect())
    }

    /// Newton's method for a factor and its vector, started from approximations, which are returned if it moves far from them.
    fn refined(&self, start: Complex<f64>, x: DVector<Complex<f64>>) -> (Complex<f64>, DVector<Complex<f64>>) {
        let (mut factor, mut vector) = (start, x.clone());
        for _ in 0..STEPS {
            let [own, derivative] = self.at(factor);
            let Some(step) = own.lu().solve(&(derivative * &vector)) else {
                break;
            };
            let largest = step.icamax_full().0;
            let by = vector[largest] / step[largest];
            if !by.norm().is_finite() {
                break;
            }
            factor -= by;
            vector = step.unscale(step.norm());
        }
        match (factor - start).norm() < SETTLED * start.norm() {
            true => (factor, vector),
            false => (start, x),
        }
    }
}
