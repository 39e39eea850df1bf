//! Formats numbers for readers (SI prefixes, significant digits, durations) and for programs (shortest exact text).

/// SI prefixes by power of a thousand, from pico to giga.
const PREFIXES: [&str; 8] = ["p", "n", "µ", "m", "", "k", "M", "G"];
/// Index of the empty prefix.
const PLAIN: i32 = 4;

/// True if a unit accepts an SI prefix.
fn takes_prefix(unit: &str) -> bool {
    matches!(
        unit,
        "m" | "s" | "Pa" | "J" | "W" | "N" | "N m" | "Hz" | "rad" | "m/s" | "Pa s" | "N/m"
    )
}

/// Factor and prefixed unit in which a magnitude reads as 1 to 1000: `(1e-3, "mm")` for 0.012 m.
///
/// Units without prefix get a power of ten: `(1e-6, "10⁻⁶ m³/s")`. Dimensionless numbers get only the power.
pub fn scaled_unit(magnitude: f64, unit: &str) -> (f64, String) {
    let thousands = thousands(magnitude);
    if takes_prefix(unit) {
        // Seconds and radians get no prefix above one: kiloseconds are unusual.
        let top = if matches!(unit, "s" | "rad") { 0 } else { 3 };
        let k = thousands.clamp(-PLAIN, top);
        let prefix = PREFIXES[(k + PLAIN) as usize];
        return (10f64.powi(3 * k), format!("{prefix}{unit}"));
    }
    let unit = pretty_unit(unit);
    // Magnitudes from 0.1 to 10⁴ need no power of ten.
    let k = if (0.1..1e4).contains(&magnitude.abs()) || magnitude == 0.0 || !magnitude.is_finite() {
        0
    } else {
        thousands
    };
    let power = if k == 0 {
        String::new()
    } else {
        format!("10{}", superscript(3 * k))
    };
    let joined = match (power.is_empty(), unit.is_empty()) {
        (true, _) => unit,
        (false, true) => power,
        (false, false) => format!("{power} {unit}"),
    };
    (10f64.powi(3 * k), joined)
}

/// A unit with raised exponents: `m³/s` for `m^3/s`; empty for `1`.
pub fn pretty_unit(unit: &str) -> String {
    if unit == "1" {
        return String::new();
    }
    let mut out = String::new();
    let mut raised = false;
    for c in unit.chars() {
        match c {
            '^' => raised = true,
            '0'..='9' | '-' if raised => out.push(raise(c)),
            _ => {
                raised = false;
                out.push(c);
            }
        }
    }
    out
}

/// An integer as superscript: `⁻⁶`.
pub fn superscript(n: i32) -> String {
    n.to_string().chars().map(raise).collect()
}

fn raise(c: char) -> char {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    c.to_digit(10).map_or('⁻', |d| DIGITS[d as usize])
}

/// Power of a thousand of a magnitude; 0 for zero and for numbers that are not finite.
fn thousands(magnitude: f64) -> i32 {
    let magnitude = magnitude.abs();
    if magnitude == 0.0 || !magnitude.is_finite() {
        return 0;
    }
    // Allowance for rounding errors: the logarithm of 1e-3 may be slightly below -3.
    (magnitude.log10() / 3.0 + 1e-12).floor() as i32
}

/// A quantity with unit and SI prefix: `12.3 mm`, `−4.07 kPa`; an en dash when it is not finite.
pub fn quantity(value: f64, unit: &str, digits: usize) -> String {
    if !value.is_finite() {
        return "–".to_string();
    }
    let (factor, unit) = scaled_unit(value, unit);
    let number = significant(value / factor, digits);
    if unit.is_empty() {
        number
    } else if let Some(power) = unit.strip_prefix("10").filter(|p| !p.is_empty()) {
        format!("{number}·10{power}")
    } else {
        format!("{number} {unit}")
    }
}

/// Largest number of significant digits of a value shown with an error.
const MOST_DIGITS: i32 = 4;

/// A value with its absolute error, rounded to the same place, and their unit: `21.5 ± 0.4 mm`. The error is rounded up to one digit, or to
/// two if the first is 1, and never finer than the fourth digit of the value.
pub fn with_error(value: f64, error: f64, unit: &str) -> String {
    if !value.is_finite() || !error.is_finite() {
        return quantity(value, unit, 3);
    }
    let largest = value.abs().max(error);
    if largest == 0.0 {
        return quantity(value, unit, 3);
    }
    let plain = unit.to_string();
    let (factor, unit) = scaled_unit(largest, unit);
    let (value, error) = (value / factor, error / factor);
    let place = |x: f64| x.abs().log10().floor() as i32;
    let last = place(largest / factor) + 1 - MOST_DIGITS;
    let last = match error > 0.0 {
        true => {
            let first = place(error);
            let leading = error / 10_f64.powi(first);
            last.max(if leading < 2.0 { first - 1 } else { first })
        }
        false => last,
    };
    // if the error exceeds the value, the value keeps two digits
    let last = match value != 0.0 && error >= value.abs() {
        true => last.min(place(value) - 1).max(place(error) - 2),
        false => last,
    };
    if last < -MOST_DIGITS {
        let pair = [(value, 2), (error, 1)].map(|(x, digits)| quantity(x * factor, &plain, digits));
        return pair.join(" ± ");
    }
    let step = 10_f64.powi(last);
    let error = ((error / step - 1e-9).ceil().max(1.0)) * step;
    let decimals = (-last).max(0) as usize;
    let value = (value / step).round() * step;
    let value = if value == 0.0 { 0.0 } else { value };
    let pair = format!("{value:.decimals$} ± {error:.decimals$}").replacen('-', "−", 1);
    match unit.strip_prefix("10").filter(|power| !power.is_empty()) {
        _ if unit.is_empty() => pair,
        Some(power) => format!("({pair})·10{power}"),
        None => format!("{pair} {unit}"),
    }
}

/// Removes trailing zeros behind the decimal point: `450 ms` for `450.0 ms`.
pub fn trimmed(quantity: &str) -> String {
    let (number, rest) = quantity.split_once(' ').unwrap_or((quantity, ""));
    let number = match number.contains('.') {
        true => number.trim_end_matches('0').trim_end_matches('.'),
        false => number,
    };
    format!("{number} {rest}").trim_end().to_string()
}

/// Formats a number with `digits` significant digits: `0.0123`, `4070`, `1.2·10⁻⁷`, with a true minus sign.
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_string();
    }
    if !value.is_finite() {
        return "–".to_string();
    }
    let digits = digits.max(1);
    let scientific = format!("{:.*e}", digits - 1, value);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let text = if (-3..6).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        format!("{value:.decimals$}")
    } else {
        format!("{mantissa}·10{}", superscript(exponent))
    };
    text.replacen('-', "−", 1)
}

/// Rounds a number to `digits` significant digits.
pub fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().unwrap_or(value)
}

/// A share as percent: `4.2 %`.
pub fn percent(share: f64) -> String {
    format!("{} %", significant(100.0 * share, 3))
}

/// A change in percent with its sign: `+4.2 %`. `None` if it is not finite.
pub fn change(percent: f64) -> Option<String> {
    let sign = if percent > 0.0 { "+" } else { "" };
    percent
        .is_finite()
        .then(|| format!("{sign}{} %", significant(percent, 3)))
}

/// A relative error as percent, with one to three digits depending on its size: `4 %`, `42 %`.
pub fn error_percent(error: f64) -> String {
    let digits = match error {
        x if x >= 10.0 => return "over 1000 %".into(),
        x if x < 1e-12 => return "0 %".into(),
        x if x < 0.095 => 1,
        x if x < 1.0 => 2,
        _ => 3,
    };
    format!("{} %", significant(100.0 * error, digits))
}

/// A count with spaces between thousands: `1 234 567`.
pub fn count(n: u64) -> String {
    let digits = n.to_string();
    let mut out = String::with_capacity(digits.len() + digits.len() / 3);
    for (k, c) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            out.push(' ');
        }
        out.push(c);
    }
    out
}

/// A count with its noun, `1 row`, `1 234 rows`; plurals end in `s` or `es`.
pub fn counted(n: u64, noun: &str) -> String {
    let plural = match n {
        1 => "",
        _ if noun.ends_with("ch") => "es",
        _ => "s",
    };
    format!("{} {noun}{plural}", count(n))
}

/// A duration: `850 ms`, `12.3 s`, `3 min 20 s`, `2 h 05 min`.
pub fn duration(seconds: f64) -> String {
    if !seconds.is_finite() || seconds < 0.0 {
        return "–".to_string();
    }
    if seconds < 59.95 {
        return quantity(seconds, "s", 3);
    }
    let whole = seconds.round() as u64;
    let (hours, minutes, rest) = (whole / 3600, whole / 60 % 60, whole % 60);
    match hours {
        0 => format!("{minutes} min {rest:02} s"),
        1..48 => format!("{hours} h {minutes:02} min"),
        _ => format!("{} d {:02} h", hours / 24, hours % 24),
    }
}

/// The shortest text that reads back as the same number, without long rows of zeros.
pub fn shortest(value: f64) -> String {
    shortest_in(&mut zmij::Buffer::new(), value).into()
}

/// Writes the text of [`shortest`] into a buffer.
pub fn shortest_in(room: &mut zmij::Buffer, value: f64) -> &str {
    if value.is_nan() {
        return "nan";
    }
    let text = room.format(value);
    text.strip_suffix(".0").unwrap_or(text)
}
