//! Numerical kernels without beams: vectors, Krylov spaces, cubics, fits.

mod kernels {
    use slcbeam::numerics::kernels::*;

    /// Pseudo-random numbers of order one and of both signs.
    fn numbers(n: usize, seed: u64) -> Vec<f64> {
        let mut state = seed;
        let mut next = || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        (0..n).map(|_| next()).collect()
    }

    /// Reductions equal plain loops. Tolerance: the rounding of n additions, n ε Σ|terms|.
    #[test]
    fn reductions_equal_plain_loops() {
        for n in [0, 1, 7, 8, 9, 64, 1001] {
            let (x, w, id) = (numbers(n, 1), numbers(n, 2), numbers(n, 3));
            let close = |a: f64, b: f64| (a - b).abs() <= n as f64 * f64::EPSILON * n as f64;
            let pairs = || x.iter().zip(&w);
            assert!(close(dot(&x, &w), pairs().map(|(a, b)| a * b).sum()));
            assert!(close(
                weighted_square(&x, &w),
                pairs().map(|(a, b)| (a * b).powi(2)).sum()
            ));
            let masked = pairs()
                .zip(&id)
                .filter(|&(_, &keep)| keep > 0.0)
                .map(|((a, b), _)| (a * b).powi(2))
                .sum();
            assert!(close(weighted_square_masked(&x, &w, &id), masked));
            assert!(close(sum_abs(&x), x.iter().map(|a| a.abs()).sum()));
            assert_eq!(max_abs(&x), x.iter().fold(0.0, |m: f64, a| m.max(a.abs())));
            assert_eq!(min(&x), x.iter().fold(f64::INFINITY, |m: f64, &a| m.min(a)));
        }
    }

    /// Goal: a bad entry is found at every index, in whole chunks and in the remainder; large finite numbers are accepted.
    #[test]
    fn non_finite_entries_are_found() {
        for n in [1, 8, 19] {
            let clean = vec![f64::MAX; n];
            assert_eq!(first_not_finite(&clean), None);
            for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                for place in 0..n {
                    let mut x = clean.clone();
                    x[place] = bad;
                    assert_eq!(first_not_finite(&x), Some(place));
                }
            }
        }
    }

    /// Goal: weights follow their formula; infinite or undefined unknowns are rejected.
    #[test]
    fn error_weights_follow_their_formula() {
        let mut w = [0.0; 2];
        assert!(error_weights(&[-2.0, 0.0], 0.5, &[1.0, 0.25], &mut w));
        assert_eq!(w, [0.5, 4.0]);
        assert!(!error_weights(&[f64::NAN, 0.0], 0.5, &[1.0, 0.25], &mut w));
        assert!(!error_weights(&[f64::INFINITY, 0.0], 0.5, &[1.0, 0.25], &mut w));
    }
}

mod krylov {
    use nalgebra::{Complex, DMatrix, DVector};
    use slcbeam::numerics::krylov::{everything, largest, solve};

    fn matrix() -> DMatrix<f64> {
        // a rotation by 1 rad that grows by 1.3, and a decaying remainder, in a skew basis
        let n = 12;
        let mut block = DMatrix::from_fn(n, n, |i, j| if i == j { 0.8_f64.powi(i as i32) * 0.7 } else { 0.0 });
        let (s, c) = 1.0_f64.sin_cos();
        for (i, j, x) in [(0, 0, c), (0, 1, -s), (1, 0, s), (1, 1, c)] {
            block[(i, j)] = 1.3 * x;
        }
        let skew = DMatrix::from_fn(n, n, |i, j| if i == j { 1.0 } else { 0.3 / (1.0 + (i + 2 * j) as f64) });
        let inverse = skew.clone().try_inverse().unwrap();
        skew * block * inverse
    }

    /// Tolerances: round-off of 12 by 12 products, condition of the basis about 3.
    #[test]
    fn eigenvalues_of_a_known_matrix() {
        let m = matrix();
        let map = |v: &mut [f64]| v.copy_from_slice((&m * DVector::from_row_slice(v)).as_slice());
        let found = largest(map, &everything(12), 3, 1e-10, 12);
        let expected = [
            (1.3 * 1.0_f64.cos(), 1.3 * 1.0_f64.sin()),
            (0.7 * 0.64, 0.0),
            (0.7 * 0.512, 0.0),
        ];
        for (eigen, (re, im)) in found.iter().zip(expected) {
            assert!((eigen.value - Complex::new(re, im)).norm() < 1e-12, "{:?}", eigen.value);
            let [a, b] = eigen.vector.clone().map(DVector::from_vec);
            let gap = (&m * &a - (&a * re - &b * im)).norm() + (&m * &b - (&a * im + &b * re)).norm();
            assert!(gap < 1e-9, "{gap:e}");
        }
    }

    #[test]
    fn a_system_is_solved_as_far_as_asked() {
        let m = matrix();
        let map = |v: &mut [f64]| v.copy_from_slice((&m * DVector::from_row_slice(v)).as_slice());
        let b = everything(12);
        for tolerance in [1e-2, 1e-11] {
            let (x, residual) = solve(map, &b, tolerance, 12);
            let x = DVector::from_vec(x);
            let left = (&x - &m * &x - DVector::from_vec(b.clone())).norm() / DVector::from_vec(b.clone()).norm();
            assert!(left <= 1.001 * tolerance + 1e-13, "{left:e}");
            assert!((left - residual).abs() < 1e-13);
        }
    }
}

mod cubics {
    use slcbeam::run::cubic::{Cubic, integral};

    #[test]
    fn a_quarter_of_a_sine_between_its_ends() {
        let (a, b) = (0.3_f64, 2.4_f64);
        let cubic = Cubic::new([a.sin(), a.cos()], [b.sin(), b.cos()], b - a);
        let turns: Vec<f64> = cubic.turns().collect();
        assert_eq!(turns.len(), 1);
        assert!((cubic.at(turns[0]) - 1.0).abs() < 0.06, "{}", cubic.at(turns[0]));
        let crossing = a + (b - a) * cubic.crosses(0.6, turns[0]);
        assert!((crossing.sin() - 0.6).abs() < 0.06, "{crossing}");
    }

    #[test]
    fn squares_of_cubics_are_integrated_exactly() {
        let f = |x: f64| (1.0 - 2.0 * x + 3.0 * x * x - x * x * x).powi(2);
        // by hand: coefficients of the square over powers
        let square = [1.0, -4.0, 10.0, -14.0, 13.0, -6.0, 1.0];
        let primitive = |x: f64| -> f64 {
            square
                .iter()
                .enumerate()
                .map(|(k, c)| c * x.powi(k as i32 + 1) / (k as f64 + 1.0))
                .sum()
        };
        for from in [0.0, 0.25, 0.9] {
            assert!((integral(from, f) - (primitive(1.0) - primitive(from))).abs() < 1e-14);
        }
    }
}

mod fits {
    use slcbeam::run::fit::{exponential, is_exponential};

    fn series(law: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        // ripples of a few per cent, as in largest values over windows
        let ripple = |k: usize| 1.0 + 0.04 * ((k * 7919) as f64).sin();
        (4..16)
            .map(|k| (k as f64 + 0.5, law(k as f64 + 0.5) * ripple(k)))
            .collect()
    }

    /// Goal: ramps, beats that rise in proportion to time and accelerated motion are not exponentials; exponentials are, from a factor of 3
    /// over the span on.
    #[test]
    fn ramps_and_powers_are_no_exponentials() {
        for power in [0.5, 1.0, 1.5, 2.0, 3.0] {
            assert!(!is_exponential(&series(|t| 1e-3 * t.powf(power))), "power {power}");
        }
        assert!(!is_exponential(&series(|t| 1e-3 * (t - 3.0))));
        for rate in [0.1, 0.3, 1.0, 3.0] {
            let points = series(|t| 1e-6 * (rate * t).exp());
            assert!(is_exponential(&points), "rate {rate}");
            let (found, _) = exponential(&points).unwrap();
            assert!((found / rate - 1.0).abs() < 0.1, "{found} {rate}");
        }
    }
}

/// Goal: tiled sums of vectors equal sums of their entries in the order of the terms, bit for bit, for lengths around those of tiles.
#[test]
fn sums_of_vectors_are_those_of_their_entries() {
    use slcbeam::numerics::kernels::combine;
    for n in [0, 1, 511, 512, 513, 1300] {
        let vectors: Vec<Vec<f64>> = (1..4)
            .map(|k| (0..n).map(|i| ((i * 7919 + k) as f64).sin()).collect())
            .collect();
        let factors = [0.3, -1.7, 1e-3];
        for count in 0..=3 {
            let terms: Vec<(f64, &[f64])> = (0..count).map(|k| (factors[k], &vectors[k][..])).collect();
            let mut out = vec![7.0; n];
            combine(&mut out, &terms);
            for (i, out) in out.iter().enumerate() {
                let expected = terms
                    .iter()
                    .map(|(factor, v)| factor * v[i])
                    .reduce(|sum, term| sum + term);
                assert_eq!(*out, expected.unwrap_or(0.0), "{n} {count} {i}");
            }
        }
    }
}

mod angles {
    use slcbeam::numerics::angle::atan2;

    /// Goal: the angle of a vector agrees with the C library within 2 units in the last place (one of them its own): in all octants, on
    /// their borders, near the axes, for sizes from 1e-140 to 1e140, with signs of zeros, and for NaN.
    #[test]
    fn angles_equal_those_of_the_c_library() {
        let mut worst = 0.0_f64;
        let mut check = |y: f64, x: f64| {
            let (ours, known) = (atan2(y, x), y.atan2(x));
            assert_eq!(ours.is_sign_negative(), known.is_sign_negative(), "{y:e} {x:e}");
            assert!(ours.abs() <= std::f64::consts::PI);
            let unit = f64::from_bits(known.abs().to_bits() + 1) - known.abs();
            worst = worst.max((ours - known).abs() / unit);
        };
        let count = 200_000;
        for k in 0..count {
            let angle = std::f64::consts::TAU * (k as f64 + 0.37) / count as f64;
            let size = 10_f64.powi(k % 281 - 140);
            check(size * angle.sin(), size * angle.cos());
        }
        // small and steep slopes on both sides of both axes, and the borders between octants and their halves
        for k in -2000..=2000 {
            let slope = 10_f64.powf(0.07 * f64::from(k));
            for (y, x) in [(slope, 1.0), (1.0, slope), (slope, -1.0), (-1.0, slope), (-slope, -1.0)] {
                check(y, x);
            }
            let near = 1.0 + 1e-3 * f64::from(k) * f64::EPSILON;
            for border in [1.0, 0.5, 2.0] {
                check(near * border, 1.0);
                check(near * border, -1.0);
            }
        }
        for zero in [0.0, -0.0] {
            for other in [0.0, -0.0, 3.0, -3.0] {
                check(zero, other);
                check(other, zero);
            }
        }
        println!("{worst}");
        assert!(worst <= 2.0, "{worst}");
        assert!(atan2(f64::NAN, 1.0).is_nan() && atan2(1.0, f64::NAN).is_nan() && atan2(f64::NAN, 0.0).is_nan());
    }
}
