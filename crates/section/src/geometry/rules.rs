//! Rules of single numbers, shapes and materials.

use super::meeting::crossing;
use super::outline::{Outline, signed_area};
use crate::error::Fault;
use crate::input::{Bladder, Material, Point, RegionShape, Shape};

/// Range of Young's moduli [Pa].
const MODULI: [f64; 2] = [1.0, 1e13];
/// Largest number of polygon corners, and of four times the regions; the cost grows with their square.
pub(super) const MOST: usize = 200;

/// Collects violated rules.
pub(super) struct Rules {
    pub(super) faults: Vec<Fault>,
}

impl Rules {
    pub(super) fn fault(&mut self, place: impl Into<String>, what: impl Into<String>) {
        self.faults.push(Fault {
            place: place.into(),
            what: what.into(),
        });
    }

    pub(super) fn positive(&mut self, place: String, value: f64) -> bool {
        let good = value.is_finite() && value > 0.0;
        if !good {
            self.fault(place, format!("must be a finite number above 0, is {value}"));
        }
        good
    }

    /// Checks the plausible range of a positive number.
    pub(super) fn between(&mut self, place: &str, value: f64, [least, most]: [f64; 2], unit: &str) {
        if value > 0.0 && value.is_finite() && !(least..=most).contains(&value) {
            self.fault(
                place,
                format!("must lie between {least:e} and {most:e} {unit}, is {value:e}"),
            );
        }
    }

    pub(super) fn finite(&mut self, place: String, values: &[f64]) -> bool {
        let good = values.iter().all(|v| v.is_finite());
        if !good {
            self.fault(place, "must be finite");
        }
        good
    }

    pub(super) fn material(&mut self, place: &str, material: &Material) {
        self.positive(format!("{place}/young_modulus_pa"), material.young_modulus_pa);
        self.positive(format!("{place}/density_kg_m3"), material.density_kg_m3);
        self.between(
            &format!("{place}/young_modulus_pa"),
            material.young_modulus_pa,
            MODULI,
            "Pa",
        );
        let nu = material.poisson_ratio;
        if !(nu > -1.0 && nu < 0.5) {
            let hint = if nu >= 0.5 {
                "; use 0.4999 for an incompressible material"
            } else {
                ""
            };
            self.fault(
                format!("{place}/poisson_ratio"),
                format!("must lie above -1 and below 0.5, is {nu}{hint}"),
            );
        }
    }

    pub(super) fn polygon(&mut self, place: &str, points: &[Point]) -> bool {
        if points.len() > MOST {
            self.fault(
                place,
                format!("the polygon has {} corners (at most {MOST})", points.len()),
            );
            return false;
        }
        if let Some(i) = (0..points.len()).find(|&i| points.len() > 3 && points[i] == points[(i + 1) % points.len()]) {
            self.fault(place, format!("corner {} repeats corner {i}", (i + 1) % points.len()));
            return false;
        }
        if points.len() < 3 {
            self.fault(place, "a polygon needs at least three corners");
            return false;
        }
        if !self.finite(place.to_owned(), points.as_flattened()) {
            return false;
        }
        if let Some((i, j)) = crossing(points) {
            self.fault(
                place,
                format!("the sides from corner {i} and from corner {j} cross or touch"),
            );
            return false;
        }
        let extent = points
            .iter()
            .flat_map(|p| points.iter().map(move |q| (p[0] - q[0]).hypot(p[1] - q[1])))
            .fold(0.0, f64::max);
        if signed_area(points).abs() < 1e-9 * extent * extent {
            self.fault(place, "the polygon has no area");
            return false;
        }
        true
    }

    pub(super) fn shape(&mut self, place: &str, shape: &Shape) -> bool {
        match shape {
            Shape::Circle { radius_m } => self.positive(format!("{place}/circle/radius_m"), *radius_m),
            Shape::Ellipse { along_m, high_m } => {
                let along = self.positive(format!("{place}/ellipse/along_m"), *along_m);
                self.positive(format!("{place}/ellipse/high_m"), *high_m) && along
            }
            Shape::RoundedRectangle {
                along_m,
                high_m,
                fillet_m,
            } => {
                let along = self.positive(format!("{place}/rounded_rectangle/along_m"), *along_m);
                let sizes = self.positive(format!("{place}/rounded_rectangle/high_m"), *high_m) && along;
                let most = along_m.min(*high_m) / 2.0;
                let fillet = (0.0..=most * (1.0 + 1e-9)).contains(fillet_m);
                if sizes && !fillet {
                    let what = format!("must lie between 0 and half of the shorter side, {most} m, is {fillet_m}");
                    self.fault(format!("{place}/rounded_rectangle/fillet_m"), what);
                }
                sizes && fillet
            }
            Shape::Polygon { points_m } => self.polygon(&format!("{place}/polygon/points_m"), points_m),
        }
    }

    pub(super) fn bladder(&mut self, place: &str, bladder: &Bladder) -> Option<Outline> {
        let center = self.finite(format!("{place}/center_m"), &[bladder.center_m]);
        (self.shape(&format!("{place}/shape"), &bladder.shape) && center).then(|| Outline::bladder(bladder))
    }

    pub(super) fn region(&mut self, place: &str, shape: &RegionShape, pitch: f64) -> Option<Outline> {
        let ordered = |r: &[f64; 2]| r[0].is_finite() && r[1].is_finite() && r[0] < r[1];
        let mut range = |name: &str, r: &[f64; 2]| {
            if !ordered(r) {
                self.fault(
                    format!("{place}/{name}"),
                    format!("must be two increasing numbers, is {r:?}"),
                );
            }
            ordered(r)
        };
        let good = match shape {
            RegionShape::Layer { high_m } => range("layer/high_m", high_m),
            RegionShape::Rectangle { along_m, high_m } => {
                let along = range("rectangle/along_m", along_m);
                range("rectangle/high_m", high_m) && along
            }
            RegionShape::Circle { center_m, radius_m } => {
                let center = self.finite(format!("{place}/circle/center_m"), center_m);
                self.positive(format!("{place}/circle/radius_m"), *radius_m) && center
            }
            RegionShape::Polygon { points_m } => self.polygon(&format!("{place}/polygon/points_m"), points_m),
        };
        good.then(|| Outline::region(shape, pitch))
    }
}
