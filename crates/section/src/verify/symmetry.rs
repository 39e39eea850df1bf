//! Comparison: the compliance of a passive section is symmetric (Maxwell and Betti) and positive definite.

use super::{Comparison, material};
use crate::coefficients::Options;
use crate::error::Error;
use crate::input::{Bladder, Bladders, Region, RegionShape, Row, Section, Shape};

/// Largest accepted asymmetry.
const RECIPROCAL: f64 = 1e-12;

fn bladder(center_m: f64, shape: Shape) -> Row {
    Row::Bladder(Bladder { center_m, shape })
}

fn section(nu: f64, upper: Row, lower: Row) -> Section {
    Section {
        height_m: 0.02,
        width_m: 0.018,
        pitch_m: 0.008,
        material: material(5e5, nu),
        bladders: Bladders {
            length_m: 0.014,
            upper,
            lower,
        },
        regions: Vec::new(),
        three_d: false,
    }
}

/// Sections with all kinds of outlines, with equal and with different halves.
fn sections() -> Vec<(&'static str, Section)> {
    let circle = || bladder(0.0052, Shape::Circle { radius_m: 0.0028 });
    let square = |fillet_m| {
        let (along_m, high_m) = (0.0052, 0.0052);
        let shape = Shape::RoundedRectangle {
            along_m,
            high_m,
            fillet_m,
        };
        bladder(0.005, shape)
    };
    let ellipse = Shape::Ellipse {
        along_m: 0.003,
        high_m: 0.006,
    };
    let triangle = Shape::Polygon {
        points_m: vec![[-0.0025, -0.002], [0.003, -0.0015], [0.0005, 0.003]],
    };
    let sheet = Region {
        shape: RegionShape::Layer { high_m: [-0.001, 0.0] },
        material: material(5e8, 0.3),
    };
    let mut with_sheet = section(0.49, circle(), Row::None);
    with_sheet.regions.push(sheet);
    vec![
        ("circles, nu 0.3", section(0.3, circle(), Row::Mirrored)),
        ("circles, nu 0.4999", section(0.4999, circle(), Row::Mirrored)),
        ("sharp squares", section(0.49, square(0.0), Row::Mirrored)),
        ("rounded squares", section(0.49, square(0.002), Row::Mirrored)),
        (
            "an ellipse and a triangle",
            section(0.45, bladder(0.005, ellipse), bladder(-0.005, triangle)),
        ),
        ("one circle and a stiff sheet", with_sheet),
    ]
}

/// Number of non-positive pivots of Gaussian elimination, equal to that of non-positive eigenvalues (Sylvester).
fn not_positive(mut a: [[f64; 4]; 4]) -> usize {
    for k in 0..4 {
        for i in k + 1..4 {
            let factor = a[i][k] / a[k][k];
            (k..4).for_each(|j| a[i][j] -= factor * a[k][j]);
        }
    }
    (0..4).filter(|&k| a[k][k].is_nan() || a[k][k] <= 0.0).count()
}

/// Compares sections of six outlines.
pub fn compare() -> Result<Vec<Comparison>, Error> {
    let mut rows = vec![];
    for (name, section) in sections() {
        let levels = section.levels(&Options::default())?;
        let asymmetry = levels.iter().map(|l| l.asymmetry).collect();
        let counts = levels.iter().map(|l| {
            let mut c = l.compliance;
            // A row without bladders has no area, and its pressure does no work.
            (2..4)
                .filter(|&k| l.cavities[k - 2][0] == 0.0)
                .for_each(|k| c[k][k] = 1.0);
            not_positive(c) as f64
        });
        let counts = counts.collect();
        rows.push(
            Comparison::new(format!("{name}: asymmetry [1]"), "Maxwell, Betti", 0.0, asymmetry).within(RECIPROCAL),
        );
        let name = format!("{name}: eigenvalues not above zero [1]");
        rows.push(Comparison::new(name, "energy is positive", 0.0, counts).within(0.0));
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::not_positive;

    #[test]
    fn eigenvalues_below_zero_are_counted() {
        let with = |a: f64, b: f64| {
            [
                [2.0, a, 0.0, 0.0],
                [a, 2.0, 0.0, 0.0],
                [0.0, 0.0, b, 0.0],
                [0.0, 0.0, 0.0, 1.0],
            ]
        };
        assert_eq!(
            [(1.0, 1.0), (3.0, 1.0), (3.0, -1.0)].map(|(a, b)| not_positive(with(a, b))),
            [0, 1, 2]
        );
    }
}
