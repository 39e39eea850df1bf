//! Student's distribution of a mean's deviation in units of its standard error.

/// Probability of a magnitude of at least `|t|` for the degrees of freedom n: the incomplete beta function I_x(n/2,
/// 1/2) at x = n/(n + t^2).
pub fn two_sided(t: f64, freedom: f64) -> f64 {
    if !t.is_finite() {
        return 0.0;
    }
    incomplete_beta(freedom / (freedom + t * t), 0.5 * freedom, 0.5)
}

/// Magnitude exceeded with a given probability.
pub fn quantile(chance: f64, freedom: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    while two_sided(high, freedom) > chance && high < 1e12 {
        high *= 2.0;
    }
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if two_sided(middle, freedom) > chance {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Regularized incomplete beta function, by Lentz' continued fraction (DLMF 8.17.22) on the side of fast convergence.
fn incomplete_beta(x: f64, a: f64, b: f64) -> f64 {
    if x <= 0.0 || x >= 1.0 {
        return x.clamp(0.0, 1.0);
    }
    let front = (a * x.ln() + b * (-x).ln_1p() + log_gamma(a + b) - log_gamma(a) - log_gamma(b)).exp();
    if x < (a + 1.0) / (a + b + 2.0) {
        front * fraction(x, a, b) / a
    } else {
        1.0 - front * fraction(1.0 - x, b, a) / b
    }
}

fn fraction(x: f64, a: f64, b: f64) -> f64 {
    const LEAST: f64 = 1e-300;
    let away = |y: f64| if y.abs() < LEAST { LEAST } else { y };
    let (mut c, mut d) = (1.0, away(1.0 - (a + b) * x / (a + 1.0)).recip());
    let mut h = d;
    for m in 1..500 {
        let m = f64::from(m);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        for term in [even, odd] {
            d = away(1.0 + term * d).recip();
            c = away(1.0 + term / c);
            h *= d * c;
        }
        if (d * c - 1.0).abs() < 1e-15 {
            break;
        }
    }
    h
}

/// Logarithm of the gamma function by Lanczos' series (g = 7, nine terms), relative error 1e-15.
pub fn log_gamma(x: f64) -> f64 {
    const TERMS: [f64; 9] = [
        0.999_999_999_999_809_9,
        676.520_368_121_885_1,
        -1_259.139_216_722_402_8,
        771.323_428_777_653_1,
        -176.615_029_162_140_6,
        12.507_343_278_686_905,
        -0.138_571_095_265_720_12,
        9.984_369_578_019_572e-6,
        1.505_632_735_149_311_6e-7,
    ];
    let x = x - 1.0;
    let sum = TERMS
        .iter()
        .enumerate()
        .skip(1)
        .fold(TERMS[0], |sum, (k, c)| sum + c / (x + k as f64));
    let t = x + 7.5;
    0.5 * (2.0 * std::f64::consts::PI).ln() + (x + 0.5) * t.ln() - t + sum.ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Source: tables of Student's distribution; one degree of freedom is Cauchy's, 1 - 2 atan(t)/pi, two have 1 - t/sqrt(2 + t^2).
    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (freedom, table) in [
            (1.0, 12.706_204_736),
            (2.0, 4.302_652_730),
            (10.0, 2.228_138_852),
            (100.0, 1.983_971_519),
        ] {
            assert!((quantile(0.05, freedom) / table - 1.0).abs() < 1e-9, "{freedom}");
        }
        for t in [0.1, 1.0, 7.0] {
            let (one, two) = (
                1.0 - 2.0 * f64::atan(t) / std::f64::consts::PI,
                1.0 - t / (2.0 + t * t).sqrt(),
            );
            assert!((two_sided(t, 1.0) - one).abs() < 1e-13 && (two_sided(t, 2.0) - two).abs() < 1e-13);
        }
        assert_eq!(two_sided(f64::INFINITY, 3.0), 0.0);
    }
}
