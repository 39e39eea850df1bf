//! Conservative bound of the growth of the first bending mode under axial base motion.

use std::f64::consts::FRAC_PI_2;

use super::Section;
use super::characteristic::mathieu_growth;

/// Margin for higher modes and finite stretch: twice the 1 % found for the published beam at 18 Hz
/// (`slcbeam verify floquet-drained`).
const MARGIN: f64 = 1.02;
/// Margin for the parametric force on a shearing beam: 10 % more for the mode shape of pure shear than for that of
/// bending.
const SHEARED: f64 = 1.15;
/// Number of squared frequencies, between those of bending and of Dunkerley's formula, in the search for growth besides
/// those of the tongues.
const BETWEEN: u32 = 24;
/// Smallest distance to the axial resonance, as |cos k|; damping bounds the response closer to it.
const NEAREST: f64 = 0.1;
/// Intervals of Simpson's rule.
const PARTS: u32 = 100;
const BETA: f64 = 1.875_104_068_712;

/// Upper bound of the growth rate of a cantilever's first bending mode [1/s]; undamped, bladders drained. The root
/// moves axially by `amplitude` [m] at `omega` [rad/s]. Mathieu's equation of an inextensible axis underestimates
/// growth. This one includes the standing axial wave, rotary inertia, and a margin for the rest:
///
/// ```text
/// q'' (1 + y11/l² ∫φ'²) + [ω1² - Ω² U/l ∫ g φ'² sin Ωt] q = 0    g = sin k(1-x)/(k cos k),  k = Ω l √(m/EA)
/// ```
///
/// With shear, ω1 is between the frequency of bending and Dunkerley's, `1/ω1² <= 1/ω_b² + 1/ω_s²`,
/// `ω_s² = (π/2)² kGA/(m l²)`. The bound is the largest growth between the two.
pub fn growth_bound(section: &Section, length: f64, amplitude: f64, omega: f64, shears: bool) -> f64 {
    let k = omega * length * (section.mass_per_length / section.axial_stiffness).sqrt();
    let cosine = if k.cos().abs() < NEAREST {
        NEAREST.copysign(k.cos())
    } else {
        k.cos()
    };
    let ratio = (BETA.cosh() + BETA.cos()) / (BETA.sinh() + BETA.sin());
    let (mut pull, mut turn) = (0.0, 0.0);
    for i in 0..=PARTS {
        let weight = match i {
            0 | PARTS => 1.0,
            _ if i % 2 == 1 => 4.0,
            _ => 2.0,
        } / (3.0 * f64::from(PARTS));
        let x = f64::from(i) / f64::from(PARTS);
        let b = BETA * x;
        let slope = BETA * (b.sinh() + b.sin() - ratio * (b.cosh() - b.cos()));
        let along = if k > 1e-3 {
            (k * (1.0 - x)).sin() / (k * cosine)
        } else {
            1.0 - x
        };
        pull += weight * along * slope * slope;
        turn += weight * slope * slope;
    }
    let heavier = 1.0 + section.gyration_radius_squared / (length * length) * turn;
    let first = BETA.powi(4) * section.bending_stiffness / (section.mass_per_length * length.powi(4)) / heavier;
    let shaking = amplitude.abs() * omega * omega / length * pull / heavier;
    if !shears {
        return mathieu_growth(first, MARGIN * shaking, omega);
    }
    let in_shear = FRAC_PI_2.powi(2) * section.shear_stiffness / (section.mass_per_length * length * length);
    let least = first / (1.0 + first / in_shear);
    let tongues = [0.5, 1.0, 1.5].map(|part| (part * omega).powi(2).clamp(least, first));
    let between = (0..=BETWEEN).map(|k| least + (first - least) * f64::from(k) / f64::from(BETWEEN));
    let growth = |squared: f64| mathieu_growth(squared, SHEARED * MARGIN * shaking, omega);
    tongues.into_iter().chain(between).map(growth).fold(0.0, f64::max)
}
