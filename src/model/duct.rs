//! Permeability `q1` of straight ducts: flow for `-dp/ds = mu`, no slip at the wall.

use std::f64::consts::PI;

use crate::case::schema::CrossSection;

/// `[E4]` `q1` [m^4] of a cross-section, from `∇²u = -1` (A.12).
///
/// ```text
/// circle π r⁴/8    ellipse π a³b³/(4(a² + b²))    equilateral triangle √3 a⁴/320
/// rectangle a b³/12 [1 - (192 b/π⁵ a) Σ_{odd k} tanh(kπa/2b)/k⁵]      (White, Viscous Fluid Flow)
/// ```
pub fn permeability(section: &CrossSection) -> f64 {
    match *section {
        CrossSection::Circle { radius_m } => circle(radius_m),
        CrossSection::Rectangle { height_m, width_m } => rectangle(height_m, width_m),
        CrossSection::Ellipse {
            semi_axis_a_m: a,
            semi_axis_b_m: b,
        } => PI * (a * b).powi(3) / (4.0 * (a * a + b * b)),
        CrossSection::Triangle { side_m } => 3.0_f64.sqrt() * side_m.powi(4) / 320.0,
    }
}

/// Hagen-Poiseuille, `π r⁴/8`.
pub fn circle(radius: f64) -> f64 {
    PI * radius.powi(4) / 8.0
}

/// Radius of the circle that has a permeability.
pub fn radius(permeability: f64) -> f64 {
    (8.0 * permeability / PI).powf(0.25)
}

/// Rectangle with the given sides.
pub fn rectangle(side: f64, other: f64) -> f64 {
    let (a, b) = (side.max(other), side.min(other));
    let series: f64 = (0..40)
        .map(|i| {
            let k = f64::from(2 * i + 1);
            (k * PI * a / (2.0 * b)).tanh() / k.powi(5)
        })
        .sum();
    a * b.powi(3) / 12.0 * (1.0 - 192.0 * b / (PI.powi(5) * a) * series)
}
