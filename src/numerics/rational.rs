//! Rational functions with real coefficients through samples on the imaginary axis.
//!
//! Y. Nakatsukasa, O. Sète, L. N. Trefethen, *The AAA algorithm for rational approximation*, SIAM J. Sci. Comput. 40 (2018) A1494-A1522,
//! for several functions with common poles and with nodes in conjugate pairs:
//!
//! ```text
//! r(s) = Σⱼ [wⱼ fⱼ/(s - i ωⱼ) + w̄ⱼ f̄ⱼ/(s + i ωⱼ)] / Σⱼ [wⱼ/(s - i ωⱼ) + w̄ⱼ/(s + i ωⱼ)]
//! ```

use nalgebra::{Complex, DMatrix};
use slcbeam_dense::real_eigenvalues;

type C = Complex<f64>;

/// Values of several functions at angular frequencies in ascending order. The first frequency may be 0.
#[derive(Clone, Debug, Default)]
pub struct AxisSamples {
    /// Angular frequencies.
    pub omega: Vec<f64>,
    /// Values of all functions at each.
    pub values: Vec<Vec<C>>,
}

impl AxisSamples {
    /// Adds a sample, in its place.
    pub fn insert(&mut self, omega: f64, values: Vec<C>) {
        let place = self.omega.partition_point(|other| *other < omega);
        self.omega.insert(place, omega);
        self.values.insert(place, values);
    }

    /// Median amplitude of each function.
    pub fn medians(&self) -> Vec<f64> {
        let functions = self.values.first().map_or(0, Vec::len);
        let median = |p: usize| {
            let mut all: Vec<f64> = self.values.iter().map(|values| values[p].norm()).collect();
            all.sort_by(f64::total_cmp);
            all[all.len() / 2].max(f64::MIN_POSITIVE)
        };
        (0..functions).map(median).collect()
    }
}

/// Largest error of values, relative to the exact ones, or to those in `least` if they are larger.
pub fn relative_error(found: &[C], exact: &[C], least: &[f64]) -> f64 {
    let all = found.iter().zip(exact).zip(least);
    let errors = all.map(|((found, exact), least)| (found - exact).norm() / exact.norm().max(*least));
    errors.fold(0.0, |m: f64, x| if x.is_nan() { f64::INFINITY } else { m.max(x) })
}

/// A rational function with an interpolation node at some of the samples.
#[derive(Clone, Debug)]
pub struct RationalFit {
    /// Angular frequency, weight and values at each node.
    nodes: Vec<(f64, C, Vec<C>)>,
    /// Largest [`relative_error`] at the samples.
    pub error: f64,
}

/// Share of the nodes that is added at once.
const BATCH: usize = 10;
/// Ratio of numbers of nodes over which an error that does not decrease counts as rounding error, and the least such number.
const STALLED: [usize; 2] = [2, 16];
/// Largest number of nodes.
const MOST: usize = 100;

impl RationalFit {
    /// Fits samples; further nodes are added where the [`relative_error`] is largest, until it is below the tolerance. Half of the
    /// samples at most are nodes.
    pub fn new(samples: &AxisSamples, least: &[f64], tolerance: f64) -> Self {
        let count = samples.omega.len();
        let mut nodes: Vec<usize> = (0..count.min(1)).collect();
        let mut best: Option<Self> = None;
        loop {
            let fit = Self::through(samples, &nodes, least);
            let mut errors: Vec<f64> = (0..count)
                .map(|k| match nodes.contains(&k) {
                    true => 0.0,
                    false => relative_error(&fit.at(samples.omega[k]), &samples.values[k], least),
                })
                .collect();
            let error = errors.iter().copied().fold(0.0, f64::max);
            if best.as_ref().is_none_or(|best| error < best.error) {
                best = Some(Self { error, ..fit });
            }
            let of_best = best.as_ref().map_or(0, |best| best.nodes.len());
            let stalled = nodes.len() > STALLED[0] * of_best + STALLED[1];
            if error <= tolerance || stalled || nodes.len() >= MOST || 2 * nodes.len() >= count {
                break;
            }
            for _ in 0..1 + nodes.len() / BATCH {
                let Some(worst) = (0..count).max_by(|a, b| errors[*a].total_cmp(&errors[*b])) else {
                    break;
                };
                if errors[worst] <= tolerance {
                    break;
                }
                nodes.push(worst);
                errors[worst.saturating_sub(1)..count.min(worst + 2)].fill(0.0);
            }
        }
        best.unwrap_or(Self {
            nodes: vec![],
            error: f64::INFINITY,
        })
    }

    /// Weights of the smallest linearized error: the last right singular vector of a Loewner matrix in real arithmetic.
    fn through(samples: &AxisSamples, nodes: &[usize], least: &[f64]) -> Self {
        let others: Vec<usize> = (0..samples.omega.len()).filter(|k| !nodes.contains(k)).collect();
        let columns = 2 * nodes.len();
        let rows = 2 * others.len() * least.len();
        let mut matrix = DMatrix::<f64>::zeros(rows.max(columns), columns);
        let mut row = 0;
        for &k in &others {
            let s = C::new(0.0, samples.omega[k]);
            for (p, least) in least.iter().enumerate() {
                let own = samples.values[k][p];
                let weight = 1.0 / own.norm().max(*least);
                for (j, &node) in nodes.iter().enumerate() {
                    let (at, value) = (C::new(0.0, samples.omega[node]), samples.values[node][p]);
                    let a = weight * (own - value) / (s - at);
                    let b = match samples.omega[node] == 0.0 {
                        true => C::default(),
                        false => weight * (own - value.conj()) / (s + at),
                    };
                    let (real, imaginary) = (a + b, C::i() * (a - b));
                    matrix[(row, 2 * j)] = real.re;
                    matrix[(row + 1, 2 * j)] = real.im;
                    if samples.omega[node] != 0.0 {
                        matrix[(row, 2 * j + 1)] = imaginary.re;
                        matrix[(row + 1, 2 * j + 1)] = imaginary.im;
                    }
                }
                row += 2;
            }
        }
        // a node at 0 has a real weight: its second column is none
        let used: Vec<usize> = (0..columns)
            .filter(|c| c % 2 == 0 || samples.omega[nodes[c / 2]] != 0.0)
            .collect();
        let svd = matrix.select_columns(&used).qr().r().svd(false, true);
        let mut weights = vec![C::new(1.0, 0.0); nodes.len()];
        if let Some(v) = svd.v_t.filter(|v| rows > 0 && v.iter().all(|x| x.is_finite())) {
            weights.fill(C::default());
            for (k, &column) in used.iter().enumerate() {
                let part = v[(v.nrows() - 1, k)];
                let unit = if column % 2 == 0 { C::new(1.0, 0.0) } else { C::i() };
                weights[column / 2] += unit * part;
            }
        }
        let each = nodes.iter().zip(weights);
        Self {
            nodes: each
                .map(|(&node, weight)| (samples.omega[node], weight, samples.values[node].clone()))
                .collect(),
            error: f64::INFINITY,
        }
    }

    /// Values at an angular frequency.
    pub fn at(&self, omega: f64) -> Vec<C> {
        if let Some((.., values)) = self.nodes.iter().find(|(node, ..)| *node == omega) {
            return values.clone();
        }
        let functions = self.nodes.first().map_or(0, |(.., values)| values.len());
        let (mut above, mut below) = (vec![C::default(); functions], C::default());
        let s = C::new(0.0, omega);
        for (node, weight, values) in &self.nodes {
            let pair = usize::from(*node != 0.0) + 1;
            for (side, sign) in [1.0, -1.0].into_iter().enumerate().take(pair) {
                let conjugated = |x: C| if side == 0 { x } else { x.conj() };
                let part = conjugated(*weight) / (s - C::new(0.0, sign * node));
                below += part;
                above
                    .iter_mut()
                    .zip(values)
                    .for_each(|(sum, value)| *sum += part * conjugated(*value));
            }
        }
        above.into_iter().map(|sum| sum / below).collect()
    }

    /// Poles, the zeros of the denominator, in conjugate pairs; none if they cannot be computed. With nodes `Z` in real blocks, they are
    /// the eigenvalues of `(1 - e cᵀ/cᵀe) Z`. The shift σ moves the additional eigenvalue, 0, away from them.
    pub fn poles(&self) -> Vec<C> {
        let unit = self.nodes.iter().map(|(node, ..)| *node).fold(0.0, f64::max);
        if unit == 0.0 {
            return vec![];
        }
        let shift = 3.0;
        // blocks [0 ω; -ω 0] with e = (1, 0) and c = (2 Re w, 2 Im w)
        let (mut e, mut c, mut partner) = (vec![], vec![], vec![]);
        for (node, weight, _) in &self.nodes {
            let at = e.len();
            if *node == 0.0 {
                e.push(1.0);
                c.push(weight.re);
                partner.push((at, 0.0));
            } else {
                e.extend([1.0, 0.0]);
                c.extend([2.0 * weight.re, 2.0 * weight.im]);
                partner.extend([(at + 1, node / unit), (at, -node / unit)]);
            }
        }
        let n = e.len();
        let ce: f64 = e.iter().zip(&c).map(|(e, c)| e * c).sum();
        let ce = if ce == 0.0 { f64::EPSILON } else { ce };
        // column j of Z - σ has the entry of the partner's row and the diagonal
        let z = |i: usize, j: usize| {
            let (column, entry) = partner[i];
            (if i == j { -shift } else { 0.0 }) + if column == j { entry } else { 0.0 }
        };
        let cz: Vec<f64> = (0..n)
            .map(|j| {
                c[j] * z(j, j)
                    + if partner[j].0 == j {
                        0.0
                    } else {
                        c[partner[j].0] * z(partner[j].0, j)
                    }
            })
            .collect();
        let Some(mut all) = real_eigenvalues(n, &|i, j| z(i, j) - e[i] * cz[j] / ce) else {
            return vec![];
        };
        all.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
        all.into_iter().skip(1).map(|s| unit * (s + shift)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Source: Re and Im of two functions given by poles and residues.
    #[test]
    fn poles_and_values_are_those_of_a_rational_function() {
        let poles = [C::new(-0.1, 3.0), C::new(-1e-4, 11.0), C::new(-2.0, 0.0)];
        let exact = |omega: f64| -> Vec<C> {
            let s = C::new(0.0, omega);
            let term = |p: &C, r: f64| r / (s - p) + if p.im == 0.0 { C::default() } else { r / (s - p.conj()) };
            [[1.0, 0.3, 2.0], [0.0, 0.01, -1.0]]
                .map(|r| poles.iter().zip(r).map(|(p, r)| term(p, r)).sum::<C>() + 0.2)
                .to_vec()
        };
        let omega: Vec<f64> = (0..40).map(|k| 0.5 * f64::from(k)).collect();
        let samples = AxisSamples {
            values: omega.iter().map(|w| exact(*w)).collect(),
            omega,
        };
        let least = samples.medians();
        let fit = RationalFit::new(&samples, &least, 1e-10);
        assert!(fit.error < 1e-10, "{}", fit.error);
        for omega in [0.1, 2.9, 11.0, 30.0] {
            let error = relative_error(&fit.at(omega), &exact(omega), &least);
            assert!(error < 1e-7, "{omega}: {error}");
        }
        let found = fit.poles();
        for pole in poles {
            let near = found.iter().map(|p| (p - pole).norm()).fold(f64::INFINITY, f64::min);
            assert!(near < 1e-7, "{pole} in {found:?}");
        }
    }
}
