//! Derivatives of a frequency response by its frequency and by numbers of the case.

use nalgebra::Complex;

use super::{Frequencies, LinearResponse};
use crate::case::Case;
use crate::case::parameter::{Parameter, STEPS, change};
use crate::error::Result;
use crate::run::modes::sensitivity::add;
use crate::spectral::Pencil;

/// Derivatives of the equations of a response by one parameter, in the scales of the response, per unit of the parameter.
#[derive(Clone, Debug)]
pub struct EquationSlopes {
    /// The parameter.
    pub parameter: Parameter,
    /// Entries of dA/dp, in the order of the pattern.
    pub a: Vec<f64>,
    /// Entries of dB/dp.
    pub b: Vec<f64>,
    forcing: [Vec<f64>; 3],
    of_state: Vec<[Vec<f64>; 2]>,
    direct: Vec<[f64; 3]>,
}

impl EquationSlopes {
    /// Derivatives of the equations of a response of `case` by a parameter; `at` is the instant [s] of its equilibrium, if it is not about
    /// the start. They include the change of the state, and are differences of fourth order as in [E44].
    ///
    /// # Errors
    /// A changed case is not valid, has other unknowns or no such state.
    pub fn new(case: &Case, at: Option<f64>, about: &LinearResponse, parameter: &Parameter) -> Result<Self> {
        let entries = vec![0.0; about.about.a.len()];
        let unknowns = vec![0.0; about.about.y.len()];
        let mut all = Self {
            parameter: parameter.clone(),
            a: entries.clone(),
            b: entries,
            forcing: [0, 1, 2].map(|_| unknowns.clone()),
            of_state: vec![[unknowns.clone(), unknowns]; about.outputs.len()],
            direct: vec![[0.0; 3]; about.outputs.len()],
        };
        let outputs: Vec<String> = about.outputs.iter().map(|output| output.key()).collect();
        let step = change(case);
        for (steps, weight) in STEPS {
            let case = parameter.changed(case, parameter.value * (1.0 + steps * step))?;
            let changed = LinearResponse::new(&case, &about.input, &outputs, at)?;
            all.add(weight / (step * parameter.value), about, &changed)?;
        }
        Ok(all)
    }

    fn add(&mut self, weight: f64, about: &LinearResponse, changed: &LinearResponse) -> Result<()> {
        let parts = [&mut self.a[..], &mut self.b];
        add(parts, weight, &about.about, &changed.about, &self.parameter)?;
        let [here, there] = [about, changed].map(|one| &one.about.system().layout);
        for (sum, forcing) in self.forcing.iter_mut().zip(&changed.forcing) {
            for (row, sum) in sum.iter_mut().enumerate() {
                *sum += weight * forcing[row] * there.row_scales[row] / here.row_scales[row];
            }
        }
        let rows = self.of_state.iter_mut().flatten();
        for (sum, of_state) in rows.zip(changed.of_state.iter().flatten()) {
            for (column, sum) in sum.iter_mut().enumerate() {
                *sum += weight * of_state[column] * here.scales[column] / there.scales[column];
            }
        }
        let direct = self.direct.iter_mut().flatten();
        direct
            .zip(changed.direct.iter().flatten())
            .for_each(|(sum, direct)| *sum += weight * direct);
        Ok(())
    }
}

/// A transfer function H(s) with its derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct ResponseJet {
    /// H.
    pub value: Complex<f64>,
    /// dH/ds.
    pub rate: Complex<f64>,
    /// d²H/ds².
    pub curvature: Complex<f64>,
    /// dH/dp and d²H/ds dp for each parameter p.
    pub slopes: Vec<[Complex<f64>; 2]>,
}

impl Frequencies<'_> {
    /// `[E98]` Transfer functions of all outputs at a frequency [Hz] with their derivatives, from solutions with the same factors,
    ///
    /// ```text
    /// (A + s B) x = -f        (A + s B) x' = -f' - B x        (A + s B) x'' = -f'' - 2 B x'        f = f_0 + s f_1 + s² f_2
    /// dH/dp = dc·x + dd - λ·r        (A + s B)ᵀ λ = c        c = C + s D        r = (dA + s dB) x + df
    /// ```
    ///
    /// ' is the derivative by s; that of dH/dp has `(A + s B)ᵀ λ' = D - Bᵀ λ`.
    ///
    /// # Errors
    /// The frequency is a pole.
    pub fn jets(&mut self, hz: f64, slopes: &[EquationSlopes]) -> Result<Vec<ResponseJet>> {
        let s = Complex::new(0.0, std::f64::consts::TAU * hz);
        let of = self.of;
        let pencil = of.about.pencil();
        let x = self.solved(s, negative(&forced(&of.forcing, s)))?;
        let mut rhs = negative(&forced_rate(&of.forcing, s));
        subtract(&mut rhs, 1.0, &pencil.products(&x).1);
        let rate = self.solved(s, rhs)?;
        let mut rhs: Vec<Complex<f64>> = of.forcing[2].iter().map(|f2| Complex::from(-2.0 * f2)).collect();
        subtract(&mut rhs, 2.0, &pencil.products(&rate).1);
        let curvature = self.solved(s, rhs)?;
        let residuals: Vec<[Vec<Complex<f64>>; 2]> = slopes
            .iter()
            .map(|one| one.residuals(&pencil, s, [&x, &rate]))
            .collect();
        let mut jets = vec![];
        for (place, (row, direct)) in of.of_state.iter().zip(&of.direct).enumerate() {
            let second = 2.0 * dot(&row[1], &rate) + dot(&combined(row, s), &curvature) + 2.0 * direct[2];
            let mut jet = ResponseJet {
                value: output(row, direct, s, &x),
                rate: output_rate(row, direct, s, [&x, &rate]),
                curvature: second,
                slopes: vec![],
            };
            if !slopes.is_empty() {
                let left = self.transposed(s, combined(row, s))?;
                let mut rhs: Vec<Complex<f64>> = row[1].iter().map(|d| Complex::from(*d)).collect();
                subtract(&mut rhs, 1.0, &transposed_product(&pencil, &left));
                let left_rate = self.transposed(s, rhs)?;
                for (slope, [r, r_rate]) in slopes.iter().zip(&residuals) {
                    let (row, direct) = (&slope.of_state[place], &slope.direct[place]);
                    let own_rate = output_rate(row, direct, s, [&x, &rate]);
                    jet.slopes.push([
                        output(row, direct, s, &x) - dot(&left, r),
                        own_rate - dot(&left_rate, r) - dot(&left, r_rate),
                    ]);
                }
            }
            jets.push(jet);
        }
        Ok(jets)
    }

    fn solved(&mut self, s: Complex<f64>, mut b: Vec<Complex<f64>>) -> Result<Vec<Complex<f64>>> {
        let of = self.of;
        self.factors.solve(s, &mut b).map_err(|failure| of.failed(&failure))?;
        Ok(b)
    }

    fn transposed(&mut self, s: Complex<f64>, mut b: Vec<Complex<f64>>) -> Result<Vec<Complex<f64>>> {
        let of = self.of;
        let solved = self.factors.solve_transposed(s, &mut b);
        solved.map_err(|failure| of.failed(&failure)).map(|()| b)
    }
}

impl EquationSlopes {
    /// r and its derivative by s.
    fn residuals(&self, about: &Pencil, s: Complex<f64>, [x, rate]: [&[Complex<f64>]; 2]) -> [Vec<Complex<f64>>; 2] {
        let own = Pencil {
            pattern: about.pattern,
            a: &self.a,
            b: &self.b,
        };
        let ((ax, bx), (ar, br)) = (own.products(x), own.products(rate));
        let sum = |parts: [Vec<Complex<f64>>; 3]| {
            let [first, second, third] = parts;
            let all = first.into_iter().zip(second).zip(third);
            all.map(|((a, b), c)| a + b + c).collect()
        };
        let times = |all: &[Complex<f64>]| all.iter().map(|x| s * x).collect::<Vec<_>>();
        let r = sum([ax, times(&bx), forced(&self.forcing, s)]);
        let own_rate: Vec<Complex<f64>> = bx.iter().zip(&br).map(|(b, br)| b + s * br).collect();
        [r, sum([own_rate, ar, forced_rate(&self.forcing, s)])]
    }
}

/// f.
pub(super) fn forced([f0, f1, f2]: &[Vec<f64>; 3], s: Complex<f64>) -> Vec<Complex<f64>> {
    let all = f0.iter().zip(f1).zip(f2);
    all.map(|((f0, f1), f2)| s * s * *f2 + s * *f1 + f0).collect()
}

/// df/ds.
fn forced_rate([_, f1, f2]: &[Vec<f64>; 3], s: Complex<f64>) -> Vec<Complex<f64>> {
    f1.iter().zip(f2).map(|(f1, f2)| s * (2.0 * f2) + f1).collect()
}

/// `c = C + s D` of an output.
fn combined([c, d]: &[Vec<f64>; 2], s: Complex<f64>) -> Vec<Complex<f64>> {
    c.iter().zip(d).map(|(c, d)| s * *d + c).collect()
}

/// `c·x + d` of an output with the rows C and D.
pub(super) fn output(row: &[Vec<f64>; 2], direct: &[f64; 3], s: Complex<f64>, x: &[Complex<f64>]) -> Complex<f64> {
    dot(&combined(row, s), x) + s * s * direct[2] + s * direct[1] + direct[0]
}

/// Its derivative by s; `rate` is that of x.
fn output_rate(
    row: &[Vec<f64>; 2],
    direct: &[f64; 3],
    s: Complex<f64>,
    [x, rate]: [&[Complex<f64>]; 2],
) -> Complex<f64> {
    dot(&row[1], x) + dot(&combined(row, s), rate) + s * (2.0 * direct[2]) + direct[1]
}

fn dot<T: Copy>(row: &[T], x: &[Complex<f64>]) -> Complex<f64>
where
    Complex<f64>: std::ops::Mul<T, Output = Complex<f64>>,
{
    x.iter().zip(row).map(|(x, c)| *x * *c).sum()
}

fn negative(all: &[Complex<f64>]) -> Vec<Complex<f64>> {
    all.iter().map(|x| -x).collect()
}

fn subtract(from: &mut [Complex<f64>], times: f64, all: &[Complex<f64>]) {
    from.iter_mut().zip(all).for_each(|(x, y)| *x -= y * times);
}

/// `Bᵀ λ`.
fn transposed_product(pencil: &Pencil, left: &[Complex<f64>]) -> Vec<Complex<f64>> {
    let column = |column: usize| {
        let entries = pencil.pattern.column(column);
        entries
            .map(|entry| left[pencil.pattern.rows[entry] as usize] * pencil.b[entry])
            .sum()
    };
    (0..left.len()).map(column).collect()
}
