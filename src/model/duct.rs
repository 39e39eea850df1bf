//! Straight ducts with no slip at the wall: permeability `q1`, the flow for `-dp/ds = mu`, and the momentum factor of
//! creeping flow.

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

/// `[E73]` β, the momentum factor of creeping flow: mean squared velocity over the square of the mean velocity:
///
/// ```text
/// circle, ellipse 4/3    equilateral triangle 10/7    rectangle a > b, z = mπa/2b, m odd:
/// (π²/8) Σ [1 - 3 tanh z/2z + 1/(2 cosh² z)]/m⁶ / (Σ [1 - tanh z/z]/m⁴)²        6/5 between plates
/// ```
pub fn momentum_factor(section: &CrossSection) -> f64 {
    match *section {
        CrossSection::Circle { .. } | CrossSection::Ellipse { .. } => 4.0 / 3.0,
        CrossSection::Triangle { .. } => 10.0 / 7.0,
        CrossSection::Rectangle { height_m, width_m } => {
            let ratio = height_m.max(width_m) / height_m.min(width_m);
            let (mut flow, mut squares) = (0.0, 0.0);
            for i in 0..40 {
                let m = f64::from(2 * i + 1);
                let z = m * PI * ratio / 2.0;
                let (mean, edge) = (z.tanh() / z, 1.0 - z.tanh().powi(2));
                flow += (1.0 - mean) / m.powi(4);
                squares += (1.0 - 1.5 * mean + 0.5 * edge) / m.powi(6);
            }
            PI * PI / 8.0 * squares / (flow * flow)
        }
    }
}

/// `2A/P` of a cross-section [m], equal to the radius for a circle. The perimeter of an ellipse uses Ramanujan's
/// formula.
pub fn hydraulic_radius(section: &CrossSection) -> f64 {
    match *section {
        CrossSection::Circle { radius_m } => radius_m,
        CrossSection::Rectangle { height_m, width_m } => height_m * width_m / (height_m + width_m),
        CrossSection::Ellipse {
            semi_axis_a_m: a,
            semi_axis_b_m: b,
        } => 2.0 * a * b / (3.0 * (a + b) - ((3.0 * a + b) * (a + 3.0 * b)).sqrt()),
        CrossSection::Triangle { side_m } => side_m / 12.0_f64.sqrt(),
    }
}

/// Permeability of a circle (Hagen-Poiseuille), `π r⁴/8`.
pub fn circle(radius: f64) -> f64 {
    PI * radius.powi(4) / 8.0
}

/// Radius of the circle with a given permeability.
pub fn radius(permeability: f64) -> f64 {
    (8.0 * permeability / PI).powf(0.25)
}

/// Permeability of a rectangle.
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
