//! Simple laws fitted to a growing series: an exponential, a straight line, a power of time.

/// Points `(t, d)` with `t, d > 0`.
type Points<'a> = &'a [(f64, f64)];

/// Rate of the exponential through the points, and the squared correlation of its logarithm with time.
pub fn exponential(points: Points<'_>) -> Option<(f64, f64)> {
    if points.len() < 4 {
        return None;
    }
    let logarithms: Vec<(f64, f64)> = points.iter().map(|(t, d)| (*t, d.ln())).collect();
    let (_, slope, correlation) = line(&logarithms, |_| 1.0)?;
    Some((slope, correlation))
}

/// True if an exponential fits the points better than a straight line and a power of time, by the sum of squared relative
/// deviations.
pub fn is_exponential(points: Points<'_>) -> bool {
    let misses = |law: &dyn Fn(f64) -> f64| -> f64 { points.iter().map(|(t, d)| (law(*t) / d - 1.0).powi(2)).sum() };
    let of_logarithms = |abscissa: &dyn Fn(f64) -> f64| {
        let logs: Vec<(f64, f64)> = points.iter().map(|(t, d)| (abscissa(*t), d.ln())).collect();
        line(&logs, |_| 1.0)
    };
    let Some((a, b, _)) = of_logarithms(&|t| t) else {
        return false;
    };
    let exponential = misses(&|t| (a + b * t).exp());
    let straight = line(points, |d| 1.0 / (d * d)).map_or(f64::INFINITY, |(a, b, _)| misses(&|t| a + b * t));
    let power = of_logarithms(&f64::ln).map_or(f64::INFINITY, |(a, b, _)| misses(&|t| (a + b * t.ln()).exp()));
    exponential < straight.min(power)
}

/// Straight line by weighted least squares, with weights from the ordinate: value at zero, slope, squared correlation.
fn line(points: &[(f64, f64)], weight: impl Fn(f64) -> f64) -> Option<(f64, f64, f64)> {
    let total: f64 = points.iter().map(|p| weight(p.1)).sum();
    let mean = |f: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(|p| weight(p.1) * f(p)).sum::<f64>() / total;
    let (mt, md) = (mean(&|p| p.0), mean(&|p| p.1));
    let stt = mean(&|p| (p.0 - mt).powi(2));
    let sdd = mean(&|p| (p.1 - md).powi(2));
    let std = mean(&|p| (p.0 - mt) * (p.1 - md));
    (stt > 0.0 && sdd > 0.0).then(|| (md - std / stt * mt, std / stt, std * std / (stt * sdd)))
}
