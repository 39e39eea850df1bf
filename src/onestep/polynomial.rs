//! Lagrange's polynomial through a few nodes: weights for values and for derivatives.

/// Maximum number of nodes.
pub const NODES: usize = 8;

/// Weights `wₖ` with `p(x) = Σ wₖ p(xₖ)`; at most [`NODES`] different nodes.
pub fn value(nodes: &[f64], x: f64) -> [f64; NODES] {
    let mut out = [0.0; NODES];
    for (k, out) in out.iter_mut().enumerate().take(nodes.len()) {
        *out = others(nodes, k).map(|(xk, xm)| (x - xm) / (xk - xm)).product();
    }
    out
}

/// Weights `wₖ` with `p'(x) = Σ wₖ p(xₖ)`.
pub fn slope(nodes: &[f64], x: f64) -> [f64; NODES] {
    let mut out = [0.0; NODES];
    for (k, out) in out.iter_mut().enumerate().take(nodes.len()) {
        *out = others(nodes, k)
            .enumerate()
            .map(|(skip, (xk, xm))| {
                let rest = others(nodes, k).enumerate().filter(|(m, _)| *m != skip);
                rest.map(|(_, (xk, xn))| (x - xn) / (xk - xn)).product::<f64>() / (xk - xm)
            })
            .sum();
    }
    out
}

/// Pairs of node `k` with every other node.
fn others(nodes: &[f64], k: usize) -> impl Iterator<Item = (f64, f64)> {
    let at = nodes[k];
    let rest = nodes.iter().enumerate().filter(move |(m, _)| *m != k);
    rest.map(move |(_, &xm)| (at, xm))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cubics through four nodes are exact. Tolerance: rounding.
    #[test]
    fn cubics_are_exact() {
        let nodes = [0.0, 0.6, 0.87, 1.0];
        let p = |x: f64| 1.0 - x + 2.0 * x * x - 3.0 * x * x * x;
        let dp = |x: f64| -1.0 + 4.0 * x - 9.0 * x * x;
        for x in [-0.5, 0.0, 0.3, 1.0, 1.9] {
            let sum = |w: [f64; NODES]| nodes.iter().zip(w).map(|(&n, w)| w * p(n)).sum::<f64>();
            assert!((sum(value(&nodes, x)) - p(x)).abs() < 1e-12);
            assert!((sum(slope(&nodes, x)) - dp(x)).abs() < 1e-12);
        }
    }
}
