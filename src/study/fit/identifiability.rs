//! Identifiability: numbers on which no measured value depends, and combinations of numbers that the data determine
//! only in part.
//!
//! ```text
//! J  derivatives of the values over their standard deviations with respect to positions between the bounds, 0 to 1
//! a column shorter than the noise, or than the error of the derivatives: the number is not determined
//! J/|columns| = U S V^T       the spread along a column of V is 1/s; above half of the bounds' width: not determined
//! ```
//!
//! Along such a direction the logarithms of the numbers change by `a_k`. The data determine only the product
//! `p_1^(b_1) p_2^(b_2)` with `b·a = 0`.

use nalgebra::DMatrix;

use crate::study::search_bounds::ParameterBounds;

/// Estimates with bounds, derivatives and noise.
pub struct IdentificationInput<'a> {
    /// Numbers and bounds.
    pub spans: &'a [ParameterBounds],
    /// Their estimates.
    pub values: &'a [f64],
    /// Derivatives of the values over their standard deviations, with respect to positions between the bounds.
    pub jacobian: &'a DMatrix<f64>,
    /// Standard deviation of a residual, relative to that of its noise.
    pub spread: f64,
    /// Relative error of the derivatives.
    pub exact: f64,
}

/// Direction that the data do not determine.
#[derive(Clone, Debug, PartialEq)]
pub struct UndeterminedDirection {
    /// Indices of the numbers that change along it.
    pub numbers: Vec<usize>,
    /// Description, one sentence.
    pub words: String,
    /// True if even data without noise would not determine it.
    pub entirely: bool,
}

/// Largest spread of a determined estimate, as a share of the bounds' width.
const WIDE: f64 = 0.5;
/// Least component of a number that belongs to a direction, relative to the largest component.
const PART: f64 = 0.1;

/// Returns all directions that the data do not determine.
pub fn unseen(seen: &IdentificationInput) -> Vec<UndeterminedDirection> {
    let lengths: Vec<f64> = seen.jacobian.column_iter().map(|column| column.norm()).collect();
    let longest = lengths.iter().copied().fold(0.0, f64::max);
    let mut all = vec![];
    let mut left = vec![];
    for (k, length) in lengths.iter().enumerate() {
        let entirely = *length <= seen.exact * longest || *length == 0.0;
        if entirely || *length < seen.spread {
            all.push(UndeterminedDirection {
                numbers: vec![k],
                words: format!(
                    "the data do not determine {}: {}",
                    seen.spans[k].pointer,
                    match entirely {
                        true => "no measured quantity depends on it".to_owned(),
                        false =>
                            "between its bounds the measured quantities change by less than their noise".to_owned(),
                    }
                ),
                entirely,
            });
        } else {
            left.push(k);
        }
    }
    if left.len() < 2 {
        return all;
    }
    let mut own = seen.jacobian.select_columns(&left);
    for (mut column, k) in own.column_iter_mut().zip(&left) {
        column /= lengths[*k];
    }
    let svd = own.svd(false, true);
    let Some(directions) = &svd.v_t else {
        return all;
    };
    for (row, size) in svd.singular_values.iter().enumerate() {
        let along: Vec<f64> = directions.row(row).iter().copied().collect();
        let most = along.iter().map(|v| v.abs()).fold(0.0, f64::max);
        let spread = |(v, k): (&f64, &usize)| v.abs() / lengths[*k] * seen.spread / size;
        let widest = along.iter().zip(&left).map(spread).fold(0.0, f64::max);
        let entirely = *size <= seen.exact;
        if !entirely && widest < WIDE {
            continue;
        }
        let parts = along.iter().zip(&left).filter(|(v, _)| v.abs() > PART * most);
        // change of the logarithms of the numbers
        let parts: Vec<(usize, f64)> = parts
            .map(|(v, k)| {
                (
                    *k,
                    v / lengths[*k] * seen.spans[*k].slope(seen.values[*k]) / seen.values[*k],
                )
            })
            .collect();
        let names: Vec<&str> = parts.iter().map(|(k, _)| seen.spans[*k].pointer.as_str()).collect();
        let words = match parts[..] {
            [_] => format!(
                "the data hardly determine {}: the uncertainty of its estimate exceeds half of its bounds",
                names[0]
            ),
            [(_, a), (_, b)] => {
                let power = -a / b;
                match power {
                    p if (p - 1.0).abs() < 0.1 => {
                        format!("the data determine only the product of {} and {}", names[0], names[1])
                    }
                    p if (p + 1.0).abs() < 0.1 => {
                        format!("the data determine only the ratio of {} and {}", names[0], names[1])
                    }
                    p => format!(
                        "the data determine only {0} times {1} to the power of {p:.2}",
                        names[0], names[1]
                    ),
                }
            }
            _ => format!(
                "the data do not determine {} separately: they can change together and leave the measured quantities \
                 almost unchanged",
                names.join(", ")
            ),
        };
        all.push(UndeterminedDirection {
            numbers: parts.iter().map(|(k, _)| *k).collect(),
            words,
            entirely,
        });
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn describe(rows: &[[f64; 2]], spread: f64) -> Vec<String> {
        let spans = ["/a", "/b"].map(|pointer| ParameterBounds {
            pointer: pointer.into(),
            low: 1.0,
            high: 3.0,
        });
        let jacobian = DMatrix::from_fn(rows.len(), 2, |i, k| rows[i][k]);
        let seen = IdentificationInput {
            spans: &spans,
            values: &[2.0, 2.0],
            jacobian: &jacobian,
            spread,
            exact: 1e-8,
        };
        unseen(&seen).into_iter().map(|one| one.words).collect()
    }

    #[test]
    fn what_is_not_seen_is_named() {
        let both = [[10.0, 10.0], [20.0, 20.0], [5.0, 5.0]];
        assert_eq!(
            describe(&both, 1.0),
            ["the data determine only the product of /a and /b"]
        );
        let ratio = both.map(|[a, b]| [a, -b]);
        assert_eq!(
            describe(&ratio, 1.0),
            ["the data determine only the ratio of /a and /b"]
        );
        let root = both.map(|[a, b]| [2.0 * a, b]);
        assert_eq!(
            describe(&root, 1.0),
            ["the data determine only /a times /b to the power of 0.50"]
        );
        let none = [[10.0, 0.0], [20.0, 0.0]];
        assert_eq!(
            describe(&none, 1.0),
            ["the data do not determine /b: no measured quantity depends on it"]
        );
        let little = [[10.0, 0.1], [20.0, -0.1]];
        assert!(describe(&little, 1.0)[0].contains("less than their noise"));
        assert!(describe(&[[10.0, 0.0], [0.0, 10.0]], 1.0).is_empty());
    }
}
