//! Equilibrium of the cell by Newton's method, with load steps that are halved on failure.

use super::assemble::System;
use super::{Drive, FiniteCell, SectionState, State};
use crate::dense::{dot, solve};
use crate::error::Error;
use crate::sparse::Pattern;

/// Step length over the pitch that ends the iteration. Convergence is quadratic, so the state is then exact to
/// rounding.
const SHORT: f64 = 1e-9;
/// Largest number of iterations in a load step.
const ITERATIONS: usize = 12;
/// Smallest load step.
const SMALLEST: f64 = 1.0 / 256.0;

/// System without w: over q and pressures as in [L4].
struct Reduced {
    s: [[f64; 4]; 4],
    /// Derivative of the areas by q, with w in equilibrium.
    t: [[f64; 4]; 2],
    r: [[f64; 2]; 2],
    /// Residual over q after elimination of w.
    rest: [f64; 4],
    fields: Vec<Vec<f64>>,
}

fn reduce(cell: &FiniteCell, system: &System) -> Option<Reduced> {
    let pattern = match cell.pattern.get() {
        Some(pattern) => pattern,
        None => {
            let found = Pattern::new(system.force.len(), &system.entries).ok()?;
            cell.pattern.get_or_init(|| found)
        }
    };
    let factor = pattern.factor(&system.entries).ok()?;
    let mut sides = system.border.clone();
    sides.extend(system.area_by_w.iter().cloned());
    sides.push(system.force.clone());
    let x = factor.solve(&sides);
    let mean = |i: usize, j: usize| (dot(&sides[i], &x[j]) + dot(&sides[j], &x[i])) / 2.0;
    Some(Reduced {
        s: std::array::from_fn(|i| std::array::from_fn(|j| system.corner[i][j] - mean(i, j))),
        t: std::array::from_fn(|c| std::array::from_fn(|j| system.area_by_q[c][j] - mean(4 + c, j))),
        r: std::array::from_fn(|c| std::array::from_fn(|d| mean(4 + c, 4 + d))),
        rest: std::array::from_fn(|j| system.by_q[j] - dot(&sides[j], &x[6])),
        fields: x,
    })
}

impl FiniteCell {
    /// Equilibrium of the section under a drive and pressures, from rest.
    pub fn equilibrium(&self, drive: Drive, pressures: [f64; 2]) -> Result<SectionState, Error> {
        self.follow(&mut self.rest(), [0.0; 2], drive, pressures)
    }

    /// Equilibrium of the section under a drive and pressures, from a `state` in equilibrium under the pressures
    /// `before`. Updates `state`.
    pub fn follow(
        &self,
        state: &mut State,
        before: [f64; 2],
        drive: Drive,
        pressures: [f64; 2],
    ) -> Result<SectionState, Error> {
        let start = match drive {
            Drive::Strain(_) => [state.q[0], state.q[1]],
            Drive::Load(_) => self.resultants(state, before).ok_or(Error::Singular)?,
        };
        let between = |a: [f64; 2], b: [f64; 2], f: f64| [a[0] + f * (b[0] - a[0]), a[1] + f * (b[1] - a[1])];
        let (mut done, mut step, mut iterations) = (0.0, 1.0_f64, 0);
        loop {
            let factor = (done + step).min(1.0);
            let p = between(before, pressures, factor);
            let target = match drive {
                Drive::Strain(end) => Drive::Strain(between(start, end, factor)),
                Drive::Load(end) => Drive::Load(between(start, end, factor)),
            };
            let mut trial = state.clone();
            match self.newton(&mut trial, target, p, &mut iterations) {
                Some(()) => {
                    *state = trial;
                    done = factor;
                    step *= 2.0;
                    if done >= 1.0 {
                        return self.report(state, pressures, iterations).ok_or(Error::Singular);
                    }
                }
                None if step > SMALLEST => step /= 2.0,
                None => {
                    return Err(Error::Equilibrium {
                        factor: done,
                        iterations,
                    });
                }
            }
        }
    }

    /// Newton's iteration at a fixed load. None if it does not converge.
    fn newton(&self, state: &mut State, target: Drive, pressures: [f64; 2], iterations: &mut usize) -> Option<()> {
        let [pitch, height] = self.cell.size;
        for _ in 0..ITERATIONS {
            *iterations += 1;
            let system = self.assemble(state, pressures)?;
            let reduced = reduce(self, &system)?;
            let mut change = [0.0; 4];
            match target {
                Drive::Strain(end) => {
                    let known = [end[0] - state.q[0], end[1] - state.q[1]];
                    let s = &reduced.s;
                    let right = |i: usize| -reduced.rest[i] - s[i][0] * known[0] - s[i][1] * known[1];
                    let g = solve([[s[2][2], s[2][3]], [s[3][2], s[3][3]]], [right(2), right(3)])?;
                    change = [known[0], known[1], g[0], g[1]];
                }
                Drive::Load(end) => {
                    let mut right = reduced.rest.map(|r| -r);
                    (0..2).for_each(|i| right[i] += end[i] * pitch / self.width);
                    change.copy_from_slice(&solve(reduced.s, right)?);
                }
            }
            let x = &reduced.fields;
            let mut longest = 0.0_f64;
            for k in 0..state.w.len() {
                let d = -x[6][k] - (0..4).map(|a| change[a] * x[a][k]).sum::<f64>();
                state.w[k] += d;
                longest = longest.max(d.abs());
            }
            (0..4).for_each(|a| state.q[a] += change[a]);
            let strain = (0..4)
                .map(|a| change[a].abs() * if a % 2 == 0 { 1.0 } else { height })
                .fold(0.0, f64::max);
            if !longest.is_finite() || strain > 1.0 {
                return None;
            }
            if longest < SHORT * pitch && strain < SHORT {
                return Some(());
            }
        }
        None
    }

    /// N and M of an equilibrium state.
    fn resultants(&self, state: &State, pressures: [f64; 2]) -> Option<[f64; 2]> {
        let system = self.assemble(state, pressures)?;
        let scale = self.width / self.cell.size[0];
        Some([system.by_q[0] * scale, system.by_q[1] * scale])
    }

    fn report(&self, state: &State, pressures: [f64; 2], iterations: usize) -> Option<SectionState> {
        let system = self.assemble(state, pressures)?;
        let reduced = reduce(self, &system)?;
        let rest = self.areas;
        let scale = self.width / self.cell.size[0];
        let areas = [system.areas[0] - rest[0], system.areas[1] - rest[1]];
        // Over (e, kappa, p_u, p_l), without g0 and g1: Omega's Hessian is S, -T^T, -R.
        let (s, t, r) = (&reduced.s, &reduced.t, &reduced.r);
        let over = |i: usize, j: usize| match (i, j) {
            (0..2, 0..2) => s[i][j],
            (2.., 0..2) => -t[i - 2][j],
            (0..2, _) => -t[j - 2][i],
            _ => -r[i - 2][j - 2],
        };
        let lateral = |i: usize| {
            if i < 2 {
                [s[i][2], s[i][3]]
            } else {
                [-t[i - 2][2], -t[i - 2][3]]
            }
        };
        let block = [[s[2][2], s[2][3]], [s[3][2], s[3][3]]];
        let mut tangent = [[0.0; 4]; 4];
        for j in 0..4 {
            let g = solve(block, lateral(j))?;
            for i in 0..4 {
                let l = lateral(i);
                tangent[i][j] = scale * (over(i, j) - l[0] * g[0] - l[1] * g[1]);
            }
        }
        let work: f64 = (0..2).map(|c| pressures[c] * rest[c]).sum();
        Some(SectionState {
            strain: [state.q[0], state.q[1]],
            lateral: [state.q[2], state.q[3]],
            pressures_pa: pressures,
            potential_n: scale * (system.energy + work),
            resultants: [system.by_q[0] * scale, system.by_q[1] * scale],
            areas_m2: areas,
            tangent,
            iterations,
        })
    }
}
