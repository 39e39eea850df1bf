//! Radau IIA of order 5 (Hairer & Wanner, *Solving ODEs II*, IV.8) for `M y' = f(t, y)` with constant diagonal `M`.
//!
//! The three stages are solved as one real system of 3n unknowns. Numbers of steps, iterations and factorizations are those of the method;
//! the time is not. An implementation that splits the system into a real and a complex one of n unknowns needs, per iteration, three
//! residuals, a real and a complex solution; per factorization, a real and a complex one.

use slcbeam::dae::{Dae, Seeds};
use slcbeam::sparse::{Klu, Pattern};

use crate::prices::Bench;
use crate::scene::{Ran, Scene};

/// Largest number of iterations in a step.
const ITERATIONS: u32 = 7;

/// Work counters.
#[derive(Clone, Copy, Debug, Default)]
pub struct Work {
    pub steps: usize,
    pub iterations: usize,
    pub factorizations: usize,
    pub jacobians: usize,
    pub estimates: usize,
}

pub struct Radau<'a, D: Dae> {
    dae: D,
    mass: &'a [f64],
    jacobian: Vec<f64>,
    pattern: Pattern,
    blocks: Klu,
    block: Klu,
    tolerance: f64,
    pub work: Work,
}

fn a() -> [[f64; 3]; 3] {
    let s = 6.0_f64.sqrt();
    [
        [
            (88.0 - 7.0 * s) / 360.0,
            (296.0 - 169.0 * s) / 1800.0,
            (-2.0 + 3.0 * s) / 225.0,
        ],
        [
            (296.0 + 169.0 * s) / 1800.0,
            (88.0 + 7.0 * s) / 360.0,
            (-2.0 - 3.0 * s) / 225.0,
        ],
        [(16.0 - s) / 36.0, (16.0 + s) / 36.0, 1.0 / 9.0],
    ]
}

fn c() -> [f64; 3] {
    let s = 6.0_f64.sqrt();
    [(4.0 - s) / 10.0, (4.0 + s) / 10.0, 1.0]
}

/// The real eigenvalue of `A⁻¹`.
fn gamma() -> f64 {
    30.0 / (6.0 + 81.0_f64.cbrt() - 9.0_f64.cbrt())
}

/// Value at `x` of the polynomial through `(0, 0)` and `(c, z)`.
fn collocation(z: &[Vec<f64>; 3], unknown: usize, x: f64) -> f64 {
    let nodes = [0.0, c()[0], c()[1], 1.0];
    (1..4)
        .map(|k| {
            let others = (0..4).filter(|&m| m != k);
            z[k - 1][unknown] * others.map(|m| (x - nodes[m]) / (nodes[k] - nodes[m])).product::<f64>()
        })
        .sum()
}

impl Work {
    /// Modelled time of this work, if the system is split into a real and a complex one; complex operations cost four times as much. The
    /// arguments are the times of a residual, a real solution, a real factorization and a Jacobian.
    pub fn time(&self, [residual, solution, factorization, jacobian]: [f64; 4]) -> f64 {
        let residuals = (3 * self.iterations + self.estimates) as f64;
        let solutions = (5 * self.iterations + self.estimates) as f64;
        let factorizations = (5 * self.factorizations) as f64;
        residuals * residual + solutions * solution + factorizations * factorization + self.jacobians as f64 * jacobian
    }
}

/// Readings and work of a run, with its modelled seconds from measured prices.
pub fn follow(scene: &Scene, rtol: f64) -> Ran {
    let mass = scene.mass();
    let [residual, jacobian, factor, solve] = Bench::new(scene).prices();
    let mut radau = Radau::new(scene.dae(), &mass, rtol);
    let readings = radau.solve(scene);
    Ran {
        seconds: radau.work.time([residual, solve, factor, jacobian]),
        readings,
        steps: radau.work.steps,
    }
}

impl<'a, D: Dae> Radau<'a, D> {
    pub fn new(dae: D, mass: &'a [f64], tolerance: f64) -> Self {
        let pattern = dae.pattern().clone();
        let n = dae.len();
        let (mut starts, mut rows) = (vec![0], vec![]);
        for _ in 0..3 {
            for column in 0..n {
                for row_block in 0..3 {
                    let range = pattern.starts[column] as usize..pattern.starts[column + 1] as usize;
                    rows.extend(pattern.rows[range].iter().map(|r| r + (row_block * n) as i64));
                }
                starts.push(rows.len() as i64);
            }
        }
        Self {
            blocks: Klu::new(&Pattern { starts, rows }).expect("factors"),
            block: Klu::new(&pattern).expect("factors"),
            jacobian: vec![0.0; pattern.rows.len()],
            pattern,
            dae,
            mass,
            tolerance,
            work: Work::default(),
        }
    }

    fn f(&mut self, t: f64, y: &[f64], out: &mut [f64]) {
        let zero = vec![0.0; y.len()];
        self.dae.residual(t, y, &zero, out).expect("a residual");
        out.iter_mut().for_each(|x| *x = -*x);
    }

    fn differentiate(&mut self, t: f64, y: &[f64]) {
        self.work.jacobians += 1;
        let (ones, zero) = (vec![1.0; y.len()], vec![0.0; y.len()]);
        let seeds = Seeds::Columns { y: &ones, yp: &zero };
        self.dae
            .jacobian(t, y, &zero, seeds, &mut self.jacobian)
            .expect("a Jacobian");
    }

    /// Factors of `δ M + h a ∂F/∂y`, and of `γ/h M + ∂F/∂y`.
    fn factor(&mut self, h: f64) {
        self.work.factorizations += 1;
        let n = self.mass.len();
        let mut values = vec![];
        let mut single = vec![0.0; self.jacobian.len()];
        for column_block in 0..3 {
            for column in 0..n {
                for (row_block, a) in a().iter().enumerate() {
                    for k in self.pattern.column(column) {
                        let diagonal = self.pattern.rows[k] as usize == column;
                        let mass = if diagonal { self.mass[column] } else { 0.0 };
                        let of_mass = if row_block == column_block { mass } else { 0.0 };
                        values.push(of_mass + h * a[column_block] * self.jacobian[k]);
                        single[k] = gamma() / h * mass + self.jacobian[k];
                    }
                }
            }
        }
        self.blocks.factor(&values).expect("factors");
        self.block.factor(&single).expect("factors");
    }

    /// Readings at the output times.
    pub fn solve(&mut self, scene: &Scene) -> Vec<[f64; 2]> {
        let (y0, times, largest) = (&scene.y[..], &scene.times[..], scene.largest_step);
        let n = y0.len();
        let (mut y, mut t, mut h) = (y0.to_vec(), 0.0_f64, 1e-5_f64);
        let end = *times.last().expect("times");
        let mut out = vec![];
        let mut z: [Vec<f64>; 3] = std::array::from_fn(|_| vec![0.0; n]);
        let mut before: Option<(f64, [Vec<f64>; 3])> = None;
        let (mut stale, mut factored, mut first) = (true, 0.0, true);
        let mut f0 = vec![0.0; n];
        let mut right = vec![0.0; 3 * n];
        let mut stage = vec![0.0; n];
        let mut values = vec![0.0; n];
        while t < end * (1.0 - 1e-12) {
            h = h.min(end - t).min(largest);
            if stale {
                self.differentiate(t, &y);
            }
            if stale || factored != h {
                self.factor(h);
                factored = h;
            }
            for (k, z) in z.iter_mut().enumerate() {
                for (i, z) in z.iter_mut().enumerate() {
                    *z = before
                        .as_ref()
                        .map_or(0.0, |(hp, zp)| collocation(zp, i, 1.0 + c()[k] * h / hp) - zp[2][i]);
                }
            }
            let (mut last, mut converged, mut rate): (f64, bool, f64) = (f64::NAN, false, 1.0);
            let mut count = 0;
            while count < ITERATIONS && !converged {
                count += 1;
                self.work.iterations += 1;
                right.fill(0.0);
                for k in 0..3 {
                    for i in 0..n {
                        stage[i] = y[i] + z[k][i];
                    }
                    self.f(t + c()[k] * h, &stage, &mut values);
                    for (row, a) in a().iter().enumerate() {
                        for i in 0..n {
                            right[row * n + i] += h * a[k] * values[i];
                        }
                    }
                    for i in 0..n {
                        right[k * n + i] -= self.mass[i] * z[k][i];
                    }
                }
                self.blocks.solve(&mut right);
                let mut sum = 0.0;
                for k in 0..3 {
                    for i in 0..n {
                        z[k][i] += right[k * n + i];
                        sum += (right[k * n + i] / (self.tolerance * (1.0 + y[i].abs()))).powi(2);
                    }
                }
                let size = (sum / (3 * n) as f64).sqrt();
                if count > 1 {
                    rate = size / last;
                    if rate >= 0.99 {
                        break;
                    }
                    converged = rate / (1.0 - rate) * size <= 0.02;
                } else {
                    converged = size <= 1e-4;
                }
                last = size;
            }
            if !converged {
                if stale {
                    h *= 0.5;
                }
                stale = true;
                continue;
            }
            // error estimate: (γ/h M - J)⁻¹ (f(y0) + M (e·z)/h)
            self.work.estimates += 1;
            let s = 6.0_f64.sqrt();
            let e = [-(13.0 + 7.0 * s) / 3.0, (-13.0 + 7.0 * s) / 3.0, -1.0 / 3.0];
            self.f(t, &y, &mut f0);
            for i in 0..n {
                f0[i] += self.mass[i] * (e[0] * z[0][i] + e[1] * z[1][i] + e[2] * z[2][i]) / h;
            }
            self.block.solve(&mut f0);
            let tolerance = self.tolerance;
            let norm = |v: &[f64]| {
                let sum: f64 = v
                    .iter()
                    .zip(&y)
                    .map(|(e, y)| (e / (tolerance * (1.0 + y.abs()))).powi(2))
                    .sum();
                (sum / n as f64).sqrt()
            };
            let mut error = norm(&f0);
            if error >= 1.0 {
                for i in 0..n {
                    stage[i] = y[i] + f0[i];
                }
                self.f(t, &stage, &mut values);
                for i in 0..n {
                    values[i] += self.mass[i] * (e[0] * z[0][i] + e[1] * z[1][i] + e[2] * z[2][i]) / h;
                }
                self.block.solve(&mut values);
                error = norm(&values);
            }
            let safety = 0.9 * f64::from(2 * ITERATIONS + 1) / f64::from(2 * ITERATIONS + count);
            let factor = (safety * error.max(1e-10).powf(-0.25)).clamp(0.2, if first { 100.0 } else { 8.0 });
            if error > 1.0 {
                h *= factor.min(0.9);
                continue;
            }
            first = false;
            self.work.steps += 1;
            while let Some(&at) = times.get(out.len()).filter(|at| **at <= t + h * (1.0 + 1e-9)) {
                let x = (at - t) / h;
                (0..n).for_each(|i| stage[i] = y[i] + collocation(&z, i, x));
                out.push(scene.readings.read(&stage));
            }
            for i in 0..n {
                y[i] += z[2][i];
            }
            t += h;
            before = Some((h, z.clone()));
            stale = rate > 1e-3 && count > 1;
            if !(1.0..=1.2).contains(&factor) {
                h *= factor;
            }
        }
        out
    }
}
