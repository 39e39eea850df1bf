//! Text about figures with their uncertainty bands.

use super::numbers::{count, counted, quantity, significant};
use crate::results::run::{Band, Bands};

/// Smallest and largest number of digits of the ends of a band.
const DIGITS: (f64, f64) = (3.0, 8.0);
/// Relative difference below which a displayed figure and one with a band are the same.
const SAME: f64 = 1e-9;
/// Fraction of a figure below which its numerical error is round-off.
const ROUND_OFF: f64 = 1e-9;

/// Finds the band of a displayed value: that of a figure with equal magnitude, preferably with equal sign. Skips an extreme whose band
/// contains zero: its sign changes between samples, so its magnitude is more informative.
pub fn find<'a>(bands: &'a Bands, name: &str, figures: &[&str], value: f64) -> Option<&'a Band> {
    let all = figures.iter().filter_map(|figure| {
        let band = bands.get(&format!("{name}.{figure}"))?;
        let sided = *figure != "extreme" || band.low * band.high >= 0.0;
        (sided && same(band.value.abs(), value.abs())).then_some(band)
    });
    all.min_by_key(|band| band.value.is_sign_negative() != value.is_sign_negative())
}

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME * a.max(b)
}

/// Text of a band beside a value, formatted by `text`: `95 % of samples: 21.4 mm … 23.9 mm; numerical error ± 0.1 mm`.
pub fn beside(band: &Band, value: f64, text: &dyn Fn(f64, usize) -> String) -> String {
    let magnitude = if band.value * value < 0.0 { " in magnitude" } else { "" };
    let error = error(band, text).map_or(String::new(), |error| format!("; numerical error {error}"));
    let outside = match (band.low..=band.high).contains(&band.value) {
        true => "",
        false => ", the case itself outside",
    };
    match between(band, text) {
        Some(ends) => format!("95 % of {}: {ends}{magnitude}{outside}{error}", samples(band)),
        None => format!("it does not depend on the uncertain numbers{error}"),
    }
}

/// Short text of a band with its unit: `−21.6 nm … −18.2 nm (± 2.1 nm numerically)`; `None` if the figure does not spread.
pub fn short(band: &Band, unit: &str) -> Option<String> {
    let text = |x: f64, digits: usize| quantity(x, unit, digits);
    let error = error(band, &text).map_or(String::new(), |error| format!(" ({error} numerically)"));
    Some(between(band, &text)? + &error)
}

/// Samples of a band, with their number if some are missing.
fn samples(band: &Band) -> String {
    match band.samples < band.drawn {
        true => format!(
            "{} of {}",
            count(band.samples as u64),
            counted(band.drawn as u64, "sample")
        ),
        false => "samples".into(),
    }
}

/// Both ends of a band, with enough digits to distinguish them; `None` if the figure does not spread.
pub fn between(band: &Band, text: &dyn Fn(f64, usize) -> String) -> Option<String> {
    if band.sd == 0.0 {
        return None;
    }
    let digits = digits(band.low, band.high);
    Some(format!("{} … {}", text(band.low, digits), text(band.high, digits)))
}

/// Number of digits that distinguish the ends of a band.
pub fn digits(low: f64, high: f64) -> usize {
    let wanted = 2.0 + (low.abs().max(high.abs()) / (high - low)).log10().floor();
    match wanted.is_finite() {
        true => wanted.clamp(DIGITS.0, DIGITS.1) as usize,
        false => DIGITS.1 as usize,
    }
}

/// Numerical error, if known.
fn error(band: &Band, text: &dyn Fn(f64, usize) -> String) -> Option<String> {
    let error = band.numerical_error?;
    Some(match error <= ROUND_OFF * band.value.abs() {
        true => format!("below {} of it", significant(ROUND_OFF, 1)),
        false => format!("± {}", text(error, 2)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn band(value: f64, low: f64, high: f64) -> Band {
        Band {
            value,
            numerical_error: Some(1e-4),
            sd: 0.25 * (high - low),
            low,
            high,
            samples: 64,
            drawn: 64,
        }
    }

    fn metres(x: f64, digits: usize) -> String {
        quantity(x, "m", digits)
    }

    /// Goal: the ends of a band are distinguishable, a negligible error has no row of digits, and magnitudes are marked as such.
    #[test]
    fn a_band_is_shown_beside_its_error() {
        let text = |band: &Band, value: f64| beside(band, value, &metres);
        assert_eq!(
            text(&band(0.02, 0.019, 0.0212), 0.02),
            "95 % of samples: 19.0 mm … 21.2 mm; numerical error ± 100 µm"
        );
        assert_eq!(
            text(&band(0.02, 0.019999, 0.020001), -0.02),
            "95 % of samples: 19.9990 mm … 20.0010 mm in magnitude; numerical error ± 100 µm"
        );
        let lost = Band {
            samples: 60,
            ..band(0.03, 0.019, 0.0212)
        };
        assert_eq!(
            text(&lost, 0.03),
            "95 % of 60 of 64 samples: 19.0 mm … 21.2 mm, the case itself outside; numerical error ± 100 µm"
        );
        let exact = Band {
            numerical_error: Some(1e-20),
            ..band(0.02, 0.02, 0.02)
        };
        assert_eq!(
            text(&exact, 0.02),
            "it does not depend on the uncertain numbers; numerical error below 1·10⁻⁹ of it"
        );
        assert_eq!(short(&exact, "m"), None);
    }

    /// Goal: a tile shows the band of its own figure, not that of another figure of the quantity.
    #[test]
    fn a_value_has_the_band_of_its_own_figure() {
        let all: Bands = [
            ("tip_u1_m.extreme", band(-0.02, -0.021, 0.02)),
            ("tip_u1_m.max_abs", band(0.02, 0.019, 0.021)),
            ("tip_u1_m.final", band(0.01, 0.009, 0.011)),
        ]
        .map(|(name, band)| (name.to_owned(), band))
        .into();
        let found = find(&all, "tip_u1_m", &["extreme", "max_abs"], -0.02).expect("a band");
        assert!(found.low > 0.0, "{found:?}");
        assert_eq!(find(&all, "tip_u1_m", &["extreme", "max_abs"], 0.01), None);
        assert_eq!(find(&all, "tip_u3_m", &["final"], 0.01), None);
    }
}
