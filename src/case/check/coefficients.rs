//! Coefficients far beyond the magnitude that the dimensions of their section suggest: almost always a wrong unit.

use std::f64::consts::PI;

use crate::case::faults::Violations;
use crate::case::numbers::{digits, plain};
use crate::case::schema::{Bladders, Case, Coupling, LowerRow};
use crate::case::spans;
use crate::error::numbers::significant;
use crate::error::{Code, Violation};

/// Largest accepted ratio of a coefficient to its estimate. Thin walls make bladders some hundred times softer than a block of their size.
/// A millimeter in place of a meter gives a factor of 1e3, its square 1e6.
const BEYOND: f64 = 1e5;

/// Pointers of the values from which the coefficients of bladders are estimated.
const SIZES: [&str; 6] = [
    "/beam/young_modulus_pa",
    "/beam/height_m",
    "/beam/width_m",
    "/bladders/height_m",
    "/bladders/width_m",
    "/bladders/length_m",
];

/// Compares each coefficient with its estimate from the dimensions and the modulus of its section.
///
/// ```text
/// a_p ~ h_b w_b/E    aN ~ h_b w_b/(E w_s h_s)    aM ~ h_b w_b/(E w_s h_s²)    ζ' ~ l_b E aN    ψ' ~ l_b E aM
/// q1 ~ A²/(8π), the value of a circle of the same area, which no other shape exceeds
/// ```
pub(super) fn check(case: &Case, faults: &mut Violations) {
    let mut look = |pointer: &str, value: f64, (suggested, by): (f64, &[&str]), unit: &str, hint: &str| {
        let largest = BEYOND * suggested;
        if value > largest && largest.is_finite() {
            let what = format!(
                "{} {unit} is {:.0e} times the estimate from the sizes",
                plain(value),
                value / suggested
            );
            let fault = Violation::new(Code::Implausible, pointer, what);
            let fault = fault.allowed(format!("up to {} {unit}", digits(largest)));
            faults.push_beside(by, fault.hint(hint));
        }
    };
    let duct = "permeabilities are in m^4; a circle has pi r^4/8, r in metres";
    if let Some(tubes) = &case.tubes
        && let Some(permeability) = tubes.permeability_m4
    {
        let own = PI * tubes.radius_m.powi(4) / 8.0;
        let own = (own, &["/tubes/radius_m"][..]);
        look("/tubes/permeability_m4", permeability, own, "m^4", duct);
    }
    let Some(b) = &case.bladders else {
        return;
    };
    let beam = &case.beam;
    let area = b.height_m * b.width_m;
    let soft = area / beam.young_modulus_pa;
    let per_force = soft / (beam.width_m * beam.height_m);
    let per_moment = per_force / beam.height_m;
    let [soft, per_force, per_moment] = [soft, per_force, per_moment].map(|x| (x, &SIZES[..]));
    let squares = "areas are in m^2; is this in mm^2?";
    look(
        "/bladders/area_per_pressure_m2_per_pa",
        b.area_per_pressure_m2_per_pa,
        soft,
        "m^2/Pa",
        "area in m^2 per pressure in Pa; is this per MPa or in mm^2?",
    );
    let (m, n) = (&b.area_per_moment_m2_per_n_m, &b.area_per_force_m2_per_n);
    for (key, value) in [("opening", m.opening), ("closing", m.closing)] {
        let pointer = format!("/bladders/area_per_moment_m2_per_n_m/{key}");
        look(&pointer, value, per_moment, "m^2/(N m)", squares);
    }
    for (key, value) in [("tension", n.tension), ("compression", n.compression)] {
        let pointer = format!("/bladders/area_per_force_m2_per_n/{key}");
        look(&pointer, value, per_force, "m^2/N", squares);
    }
    if let Coupling::Published(c) = &b.coupling {
        let at = "/bladders/coupling/published";
        let strain = b.length_m * beam.young_modulus_pa;
        let [slope, length] = [per_moment, per_force].map(|(x, by)| (strain * x, by));
        let hint = "per unit of pressure/E, not per Pa";
        let pointer = format!("{at}/slope_per_pressure_rad");
        look(&pointer, c.slope_per_pressure_rad, slope, "rad", hint);
        look(
            &format!("{at}/length_per_pressure_m"),
            c.length_per_pressure_m,
            length,
            "m",
            hint,
        );
    }
    if let Some(permeability) = b.permeability_m4 {
        let circle = (area * area / (8.0 * PI), &SIZES[..]);
        look("/bladders/permeability_m4", permeability, circle, "m^4", duct);
    }
}

/// Checks the area per pressure of the other row.
pub(super) fn other_pressure(case: &Case, bladders: &Bladders, faults: &mut Violations) {
    let at = "/bladders/area_per_other_pressure_m2_per_pa";
    if bladders.lower == LowerRow::None && bladders.area_per_other_pressure_m2_per_pa != 0.0 {
        let what = "an area per pressure of the other row, in a beam with one row";
        faults.push(Violation::new(Code::Together, at, what).hint("remove it, or /bladders/lower"));
    } else if let Some(lower) = spans::lower_bladders(case)
        && let Some(fault) = not_passive(bladders, &lower, at)
    {
        faults.push_beside(&["/bladders/area_per_pressure_m2_per_pa"], fault);
    }
}

/// Fault at a pointer if pressures in both rows release energy: `a_x² >= a_p,u a_p,d`.
pub(super) fn not_passive(upper: &Bladders, lower: &Bladders, at: &str) -> Option<Violation> {
    let cross = upper.area_per_other_pressure_m2_per_pa;
    let own = [upper, lower].map(|row| row.area_per_pressure_m2_per_pa);
    let most = (own[0] * own[1]).sqrt();
    (cross != 0.0 && cross.abs() >= most).then(|| {
        let what = format!(
            "the area per pressure of the other row is {} m^2/Pa, that per own pressure {} m^2/Pa. Pressures in both rows release energy",
            significant(cross, 3),
            significant(most, 3)
        );
        let fault = Violation::new(Code::Slopes, at, what);
        fault
            .allowed(format!("below {} m^2/Pa in size", significant(most, 3)))
            .hint("a wall between two bladders opens one by less than the other closes")
    })
}
