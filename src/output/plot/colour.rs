//! Colors.

use std::fmt;

/// Red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colour(pub u8, pub u8, pub u8);

impl fmt::Display for Colour {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{:02X}{:02X}{:02X}", self.0, self.1, self.2)
    }
}

/// Dark blue to dark red, with even steps in lightness up to a light center that is still visible on white.
const TIME: [(f64, [u8; 3]); 7] = [
    (0.0, [0x0b, 0x24, 0x6b]),
    (0.18, [0x1f, 0x5f, 0xb4]),
    (0.36, [0x6f, 0xa6, 0xd8]),
    (0.5, [0xbd, 0xbb, 0xc4]),
    (0.64, [0xe8, 0x9a, 0x7d]),
    (0.82, [0xc9, 0x3a, 0x32]),
    (1.0, [0x6e, 0x08, 0x1b]),
];

/// Color of a time, `s` from 0 (dark blue) to 1 (dark red).
pub fn of_time(s: f64) -> Colour {
    mixed(&TIME, s)
}

fn mixed(stops: &[(f64, [u8; 3])], s: f64) -> Colour {
    let s = s.clamp(0.0, 1.0);
    let k = stops
        .iter()
        .skip(1)
        .position(|(at, _)| s <= *at)
        .unwrap_or(stops.len() - 2);
    let ((a, from), (b, to)) = (stops[k], stops[k + 1]);
    let w = (s - a) / (b - a);
    let mix = |i: usize| (f64::from(from[i]) * (1.0 - w) + f64::from(to[i]) * w).round() as u8;
    Colour(mix(0), mix(1), mix(2))
}

/// Light to dark blue, with even steps in lightness; the light end is still visible on white.
const ONE_SIGN: [(f64, [u8; 3]); 4] = [
    (0.0, [0xc3, 0xdc, 0xef]),
    (0.35, [0x72, 0xb0, 0xd8]),
    (0.7, [0x1f, 0x67, 0xad]),
    (1.0, [0x08, 0x26, 0x5a]),
];

/// Color of a value on a scale from `low` to `high`: light to dark if all values have one sign, blue to red around zero if both signs
/// occur.
pub fn of_value(value: f64, low: f64, high: f64) -> Colour {
    if low < 0.0 && high > 0.0 {
        return of_time(0.5 + 0.5 * value / high.max(-low));
    }
    let share = if high > low { (value - low) / (high - low) } else { 0.5 };
    // the largest magnitude is the darkest, also for negative values
    mixed(&ONE_SIGN, if high <= 0.0 { 1.0 - share } else { share })
}

/// Light to dark red, for growth from zero to the largest.
const GROWTH: [(f64, [u8; 3]); 5] = [
    (0.0, [0xfd, 0xe8, 0xc8]),
    (0.25, [0xf7, 0xb8, 0x7a]),
    (0.5, [0xe3, 0x6f, 0x45]),
    (0.75, [0xb5, 0x2b, 0x2b]),
    (1.0, [0x5f, 0x06, 0x1a]),
];

/// Color of a growth, relative to the largest growth.
pub fn of_growth(share: f64) -> Colour {
    mixed(&GROWTH, share)
}

/// Colors of a scale from 0 to 1.
pub fn scale(of: impl Fn(f64) -> Colour) -> Vec<Colour> {
    const PIECES: usize = 96;
    (0..PIECES).map(|k| of((k as f64 + 0.5) / PIECES as f64)).collect()
}

/// Colors of lines that every reader can distinguish: Okabe and Ito's without yellow (invisible on white), and three of Tol's.
pub const PALETTE: [Colour; 10] = [
    Colour(0x00, 0x72, 0xb2),
    Colour(0xd5, 0x5e, 0x00),
    Colour(0x00, 0x9e, 0x73),
    Colour(0xcc, 0x79, 0xa7),
    Colour(0xe6, 0x9f, 0x00),
    Colour(0x56, 0xb4, 0xe9),
    Colour(0x33, 0x22, 0x88),
    Colour(0x88, 0x22, 0x55),
    Colour(0x99, 0x99, 0x33),
    Colour(0x44, 0x44, 0x44),
];
