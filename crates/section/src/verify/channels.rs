//! Comparison: permeability of channels with closed forms.

use super::Comparison;
use crate::error::Error;
use crate::input::Shape;
use crate::permeability::{Channel, levels};
use std::f64::consts::PI;

/// q1 = a b^3/12 [1 - 192 b/(pi^5 a) sum over odd n of tanh(n pi a/2b)/n^5]; terms decrease with n^-5.
fn rectangle(a: f64, b: f64) -> f64 {
    let sum: f64 = (0..200)
        .map(|k| f64::from(2 * k + 1))
        .map(|n| (n * PI * a / (2.0 * b)).tanh() / n.powi(5))
        .sum();
    a * b.powi(3) / 12.0 * (1.0 - 192.0 * b / (PI.powi(5) * a) * sum)
}

/// Compares channels of six outlines.
pub fn compare() -> Result<Vec<Comparison>, Error> {
    let sharp = |along_m, high_m| {
        Channel::Open(Shape::RoundedRectangle {
            along_m,
            high_m,
            fillet_m: 0.0,
        })
    };
    let (r, i) = (1e-3_f64, 4e-4_f64);
    let annulus = PI / 8.0 * (r.powi(4) - i.powi(4) - (r * r - i * i).powi(2) / (r / i).ln());
    let (a, b) = (3e-3_f64, 1.5e-3_f64);
    let all = [
        (
            "circle",
            "Hagen-Poiseuille",
            PI / 8.0 * r.powi(4),
            Channel::Open(Shape::Circle { radius_m: r }),
        ),
        (
            "ellipse 2:1",
            "Boussinesq",
            PI * (a * b).powi(3) / (4.0 * (a * a + b * b)),
            {
                Channel::Open(Shape::Ellipse {
                    along_m: 2.0 * a,
                    high_m: 2.0 * b,
                })
            },
        ),
        (
            "square",
            "Fourier series",
            rectangle(7.8e-3, 7.8e-3),
            sharp(7.8e-3, 7.8e-3),
        ),
        (
            "rectangle 3:1",
            "Fourier series",
            rectangle(3e-3, 1e-3),
            sharp(3e-3, 1e-3),
        ),
        (
            "triangle",
            "Boussinesq: 3^(1/2)/320 side^4",
            3.0_f64.sqrt() / 320.0 * 1e-12,
            {
                Channel::Open(Shape::Polygon {
                    points_m: vec![[0.0, 0.0], [1e-3, 0.0], [5e-4, 1e-3 * 0.75_f64.sqrt()]],
                })
            },
        ),
        (
            "annulus 0.4",
            "Lamb",
            annulus,
            Channel::Annulus { inner_m: i, outer_m: r },
        ),
    ];
    let row = |(name, source, exact, channel): (&str, &str, f64, Channel)| {
        Ok(Comparison::new(
            format!("permeability, {name} [m^4]"),
            source,
            exact,
            levels(&channel, 3)?,
        ))
    };
    all.into_iter().map(row).collect()
}
