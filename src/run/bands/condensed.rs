//! Equations of a cell at one frequency, for the unknowns that other cells contain.

use nalgebra::{Complex, DMatrix, DVector};
use slcbeam_dense::eigen;

use super::cell::RepeatingCell;
use crate::sparse::Pattern;
use crate::sparse::klu::complex::ComplexKlu;

/// Numbers near which factors are searched, in this order: off the unit circle and the real axis.
const SHIFTS: [Complex<f64>; 3] = [
    Complex::new(0.53, 0.71),
    Complex::new(-0.61, 0.83),
    Complex::new(1.37, -0.29),
];
/// Size of `1/(λ - σ)`, relative to the largest, below which a factor is infinite.
const FINITE: f64 = 1e-12;
/// Sweeps of the scaling of rows and columns.
const SWEEPS: usize = 4;
/// Residual of an equation, relative to its terms, of a wave that needs no further Newton step.
const RESIDUAL: f64 = 1e-13;
/// Largest attenuation [neper per cell] of the waves that are computed.
pub const MOST: f64 = 7.0;
/// Newton steps for a wave, and the largest relative one.
const STEPS: usize = 4;
const NEAR: f64 = 0.1;

/// A factor λ.
#[derive(Clone, Debug, PartialEq)]
pub struct BlochFactor {
    /// λ.
    pub factor: Complex<f64>,
    /// Bound of its rounding errors, to first order, over |λ|: with the left vector y
    /// `|y|·(|T x| + ε |T| |x|) / |λ yᴴ T' x|`.
    pub rounding: f64,
    /// Unknowns of the cell.
    pub x: Vec<Complex<f64>>,
}

/// Let r be the equations that contain unknowns of other cells, and w what these contribute to them. With `G = T_0⁻¹`
///
/// ```text
/// T_0 x + E_r w = 0        w = (T_-/λ + λ T_+)_r x        (λ + (T_- G)_rr + λ² (T_+ G)_rr) w = 0        x = -G E_r w
/// ```
pub struct Condensed {
    /// Entries of `T_-`, `T_0` and `T_+`, with scaled rows and columns, their pattern, and the scales of the columns.
    entries: Vec<[Complex<f64>; 3]>,
    pattern: Pattern,
    columns: Vec<f64>,
    /// `G E_r`.
    answers: DMatrix<Complex<f64>>,
    /// `(T_- G)_rr` and `(T_+ G)_rr`.
    parts: [DMatrix<Complex<f64>>; 2],
}

/// Scales rows and columns of all parts to largest entries near 1 (Ruiz 2001); returns the scales of the columns.
fn equilibrate(parts: &mut [DMatrix<Complex<f64>>; 3]) -> Vec<f64> {
    let n = parts[0].nrows();
    let mut columns = vec![1.0; n];
    let scale = |largest: [f64; 3]| match largest.into_iter().fold(0.0, f64::max) {
        0.0 => 1.0,
        largest => largest.sqrt().recip(),
    };
    for _ in 0..SWEEPS {
        let of_rows: Vec<f64> = (0..n)
            .map(|k| scale(parts.each_ref().map(|part| part.row(k).camax())))
            .collect();
        let of_columns: Vec<f64> = (0..n)
            .map(|k| scale(parts.each_ref().map(|part| part.column(k).camax())))
            .collect();
        for k in 0..n {
            for part in parts.iter_mut() {
                part.row_mut(k).scale_mut(of_rows[k]);
                part.column_mut(k).scale_mut(of_columns[k]);
            }
            columns[k] *= of_columns[k];
        }
    }
    columns
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
        let columns = equilibrate(&mut parts);
        let rows: Vec<usize> = (0..n).filter(|row| outer[*row]).collect();
        let [before, own, behind] = &parts;
        let answers = own.clone().lu().solve(&DMatrix::identity(n, n).select_columns(&rows))?;
        let finite = answers.iter().all(|x| x.norm().is_finite());
        let at = |row: usize, column: usize| parts.each_ref().map(|part| part[(row, column)]);
        let filled =
            |column: usize| (0..n).filter(move |row| at(*row, column).iter().any(|x| *x != Complex::default()));
        let rows_of: Vec<Vec<usize>> = (0..n).map(|column| filled(column).collect()).collect();
        let all = rows_of.iter().enumerate();
        finite.then(|| Self {
            entries: all
                .flat_map(|(column, rows)| rows.iter().map(move |row| at(*row, column)))
                .collect(),
            pattern: Pattern::from_columns(&rows_of),
            parts: [before, behind].map(|part| part.select_rows(&rows) * &answers),
            answers,
            columns,
        })
    }

    /// Polynomial of w at λ, and its derivative.
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

    /// Waves that are attenuated by at most [`MOST`]. None if the equations are singular for every λ.
    ///
    /// With `θ = 1/(λ - σ)` the polynomial is `θ² P(σ) + θ P'(σ) + (T_+ G)_rr`, whose companion matrix has an ordinary eigenvalue problem.
    pub fn waves(&self) -> Option<Vec<BlochFactor>> {
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
        let factor = |theta: Complex<f64>| shift + theta.inv();
        all.retain(|(theta, _)| factor(*theta).norm().ln().abs() <= MOST);
        let wave = |(theta, w): (Complex<f64>, Vec<Complex<f64>>)| {
            self.wave(factor(theta), &self.answers * -DVector::from_column_slice(&w[..n]))
        };
        Some(all.into_iter().map(wave).collect())
    }

    /// A wave by Newton's method in the equations of the cell, since those of the few unknowns w have larger rounding errors.
    fn wave(&self, mut factor: Complex<f64>, x: DVector<Complex<f64>>) -> BlochFactor {
        let mut x: Vec<Complex<f64>> = x.iter().copied().collect();
        let mut klu = ComplexKlu::new(&self.pattern).ok();
        for _ in 0..STEPS {
            let values = self.values(factor);
            let (product, sizes) = self.product(&values, &x);
            let residual = product.iter().map(|residual| residual.norm()).fold(0.0, f64::max);
            if residual < RESIDUAL * sizes.iter().copied().fold(f64::MIN_POSITIVE, f64::max) {
                break;
            }
            let (mut step, _) = self.product(&self.derivatives(factor), &x);
            let solved = klu
                .as_mut()
                .is_some_and(|klu| klu.factor(&values).is_ok() && klu.solve(&mut step));
            let largest = (0..step.len())
                .max_by(|a, b| step[*a].norm_sqr().total_cmp(&step[*b].norm_sqr()))
                .unwrap_or(0);
            let by = x[largest] / step[largest];
            if !solved || by.norm().is_nan() || by.norm() > NEAR * factor.norm() {
                break;
            }
            factor -= by;
            let length = step[largest].norm();
            x = step.into_iter().map(|x| x / length).collect();
        }
        BlochFactor {
            factor,
            rounding: klu.map_or(f64::INFINITY, |klu| self.rounding(klu, factor, &x)),
            x: x.iter().zip(&self.columns).map(|(x, scale)| x * scale).collect(),
        }
    }

    /// Entries of `T_- + λ T_0 + λ² T_+`.
    fn values(&self, factor: Complex<f64>) -> Vec<Complex<f64>> {
        let value = |[before, own, behind]: &[Complex<f64>; 3]| before + factor * own + factor * factor * behind;
        self.entries.iter().map(value).collect()
    }

    /// Entries of its derivative by λ.
    fn derivatives(&self, factor: Complex<f64>) -> Vec<Complex<f64>> {
        let derivative = |[_, own, behind]: &[Complex<f64>; 3]| own + 2.0 * factor * behind;
        self.entries.iter().map(derivative).collect()
    }

    /// Bound of the relative error of a factor by the residual, but at least by rounding errors.
    fn rounding(&self, mut klu: ComplexKlu, factor: Complex<f64>, x: &[Complex<f64>]) -> f64 {
        // beside the factor, where the matrix is not quite singular
        let beside = factor * (1.0 + 1e-13);
        let values = self.values(beside);
        let (product, sizes) = self.product(&values, x);
        let mut left = x.to_vec();
        if klu.factor(&values).is_err() || !klu.solve_adjoint(&mut left) {
            return f64::INFINITY;
        }
        let (change, _) = self.product(&self.derivatives(beside), x);
        let change: Complex<f64> = left.iter().zip(&change).map(|(y, change)| y.conj() * change).sum();
        let errors = product
            .iter()
            .zip(&sizes)
            .map(|(residual, size)| residual.norm() + f64::EPSILON * size);
        let terms: f64 = left.iter().zip(errors).map(|(y, error)| y.norm() * error).sum();
        let bound = terms / (change.norm() * factor.norm());
        if bound.is_finite() { bound } else { f64::INFINITY }
    }

    /// Product with a vector, and the sums of the sizes of its terms.
    fn product(&self, values: &[Complex<f64>], x: &[Complex<f64>]) -> (Vec<Complex<f64>>, Vec<f64>) {
        let (mut product, mut sizes) = (vec![Complex::default(); x.len()], vec![0.0; x.len()]);
        for (column, x) in x.iter().enumerate() {
            for entry in self.pattern.column(column) {
                let row = self.pattern.rows[entry] as usize;
                product[row] += values[entry] * x;
                sizes[row] += values[entry].norm() * x.norm();
            }
        }
        (product, sizes)
    }
}
