//! Golden-section search.

/// Number of steps after which an interval is at most as wide as wanted.
pub fn steps(width: f64, wanted: f64) -> usize {
    ((width / wanted).ln() / (1.0 / share()).ln()).ceil().max(0.0) as usize
}

/// Place of the maximum of a function with one maximum in an interval, which each step shortens to 0.618 of its length.
///
/// # Errors
/// Those of the function.
pub fn maximum<E>(
    [mut low, mut high]: [f64; 2],
    steps: usize,
    mut f: impl FnMut(f64) -> Result<f64, E>,
) -> Result<f64, E> {
    let share = share();
    let mut inner = [high - share * (high - low), low + share * (high - low)];
    let mut found = [f(inner[0])?, f(inner[1])?];
    for _ in 0..steps {
        if found[0] > found[1] {
            high = inner[1];
            inner = [high - share * (high - low), inner[0]];
            found = [f(inner[0])?, found[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + share * (high - low)];
            found = [found[1], f(inner[1])?];
        }
    }
    Ok(0.5 * (low + high))
}

fn share() -> f64 {
    0.5 * (5.0_f64.sqrt() - 1.0)
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use super::*;

    #[test]
    fn a_maximum_is_found_to_the_width() {
        let count = steps(3.0, 1e-3);
        let Ok(found) = maximum([-1.0, 2.0], count, |x| Ok::<_, Infallible>(-(x - 0.3) * (x - 0.3)));
        assert!((found - 0.3).abs() < 1e-3 && count == 17, "{found} after {count}");
    }
}
