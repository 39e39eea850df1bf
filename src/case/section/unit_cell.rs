//! Values of beam and bladders from one unit cell.

use serde_json::{Value, json};
use slcbeam_section::coefficients::RowCoefficients;
use slcbeam_section::input::{Row, Section};

use super::neutral_axis::AboutNeutralAxis;
use super::violations;
use crate::case::computed;
use crate::case::schema::SpanRows;
use crate::error::{Code, Violation};

/// Largest difference of the rows, and largest coupling of force and curvature, of a section that counts as mirror-symmetric.
pub(super) const ALIKE: f64 = 1e-3;
/// Largest accepted relative error of a coefficient.
const COARSE: f64 = 0.02;
/// Smallest area per pressure of the other row, over that per own pressure, that a case takes from its section: the accepted error of
/// coefficients. A smaller one changes no result by more, and costs an unknown for each bladder.
const CROSS: f64 = COARSE;
/// Largest accepted relative error for a cell in three dimensions, whose meshes are coarser; the plane cell omits more.
const COARSE_IN_SPACE: f64 = 0.06;

/// Rows of a section that have bladders.
pub fn rows(section: &Section) -> SpanRows {
    let [upper, lower] = [&section.bladders.upper, &section.bladders.lower];
    let upper = matches!(upper, Row::Bladder(_));
    match (upper, lower) {
        (true, Row::None) => SpanRows::Upper,
        (true, _) => SpanRows::Both,
        (false, Row::Bladder(_)) => SpanRows::Lower,
        (false, _) => SpanRows::None,
    }
}

/// Values of a section at a pointer, in the form of a case, and the faults of inaccurate ones. A bladder has its size along the beam as width,
/// and the height of a rectangle of equal area, so that volumes and masses are correct. Of a single row, the values are those of its bladders.
///
/// # Errors
/// The section is invalid, or its cell has no solution.
pub(super) fn values(section: &Section, at: &str) -> Result<(Value, Vec<Violation>), Vec<Violation>> {
    let found = computed::coefficients(section).map_err(|error| violations(error, at))?;
    let (c, e) = (&found.numbers, &found.errors);
    let worst = [
        ("axial_stiffness_factor", e.axial_stiffness_factor),
        ("bending_stiffness_factor", e.bending_stiffness_factor),
        ("shear_stiffness_n", e.shear_stiffness_n),
        ("area_per_pressure_m2_per_pa", e.area_per_pressure_m2_per_pa),
        ("area_per_other_pressure_m2_per_pa", e.area_per_other_pressure_m2_per_pa),
        ("area_per_moment_m2_per_n_m", e.area_per_moment_m2_per_n_m),
        ("area_per_force_m2_per_n", e.area_per_force_m2_per_n),
        ("permeability_m4", e.permeability_m4),
    ];
    let most = if section.three_d { COARSE_IN_SPACE } else { COARSE };
    let coarse = worst.into_iter().filter(|(_, error)| *error > most);
    let faults = coarse.map(|(name, error)| {
        let what = format!("{name} has an estimated error of {:.1} %", 100.0 * error);
        Violation::new(Code::Range, at, what).allowed(format!("at most {:.0} %", 100.0 * most))
    });
    let faults = faults.collect();
    let solid = section.height_m * section.width_m - c.fluid_volume_per_length_m2;
    let density = match section.regions.is_empty() {
        true => section.material.density_kg_m3,
        false => c.solid_mass_kg_per_m / solid,
    };
    let mut values = json!({"beam": {
        "height_m": section.height_m,
        "width_m": section.width_m,
        "young_modulus_pa": section.material.young_modulus_pa,
        "density_kg_m3": density,
        "axial_stiffness_factor": c.axial_stiffness_factor,
        "bending_stiffness_factor": c.bending_stiffness_factor,
        "shear_stiffness_n": c.shear_stiffness_n,
    }});
    let about = AboutNeutralAxis::new(section, c);
    let mirrored = about.offset == 0.0;
    if !mirrored {
        values["beam"]["axial_stiffness_factor"] = about.axial_stiffness_factor.into();
        values["beam"]["neutral_axis_m"] = about.offset.into();
    }
    let along = section.bladders.along();
    let slopes = |(of_moment, of_force): (f64, f64)| {
        json!({
            "area_per_moment_m2_per_n_m": {"opening": of_moment, "closing": of_moment},
            "area_per_force_m2_per_n": {"tension": of_force, "compression": of_force},
        })
    };
    let of_row = |row: &RowCoefficients, sign: f64| {
        let mut own = slopes(about.slopes(row, sign));
        own["height_m"] = (row.area_m2 / along).into();
        own["permeability_m4"] = row.permeability_m4.into();
        own["area_per_pressure_m2_per_pa"] = row.area_per_pressure_m2_per_pa.into();
        own
    };
    let own = match (&c.upper, &c.lower) {
        (None, None) => return Ok((values, faults)),
        (Some(upper), None) => {
            let mut own = of_row(upper, 1.0);
            own["lower"] = json!("none");
            own
        }
        (None, Some(lower)) => of_row(lower, -1.0),
        (Some(upper), Some(lower)) => {
            let cross = c.area_per_other_pressure_m2_per_pa;
            let cross = (cross.abs() > CROSS * c.area_per_pressure_m2_per_pa).then_some(cross);
            let ratio = lower.area_per_moment_m2_per_n_m / upper.area_per_moment_m2_per_n_m;
            let mut own = match mirrored && (ratio - 1.0).abs() <= ALIKE {
                true => {
                    let mut own = slopes((c.area_per_moment_m2_per_n_m, c.area_per_force_m2_per_n));
                    own["height_m"] = (upper.area_m2 / along).into();
                    own["permeability_m4"] = c.permeability_m4.into();
                    own["area_per_pressure_m2_per_pa"] = c.area_per_pressure_m2_per_pa.into();
                    own
                }
                false => {
                    let mut own = of_row(upper, 1.0);
                    own["lower"] = json!({"unlike": of_row(lower, -1.0)});
                    own
                }
            };
            if let Some(cross) = cross {
                own["area_per_other_pressure_m2_per_pa"] = cross.into();
            }
            own
        }
    };
    values["bladders"] = json!({"length_m": section.bladders.length_m, "width_m": along});
    if let (Some(all), Value::Object(own)) = (values["bladders"].as_object_mut(), own) {
        all.extend(own);
    }
    Ok((values, faults))
}

/// `f_m` of a section with a fluid of this density [kg/m^3]: mass of solid and fluid over that of a full section of the solid.
pub(super) fn mass_factor(section: &Section, values: &Value, fluid_density: f64) -> Option<f64> {
    let full = values.pointer("/beam/density_kg_m3")?.as_f64()? * section.height_m * section.width_m;
    let c = computed::coefficients(section).ok()?.numbers;
    Some((c.solid_mass_kg_per_m + fluid_density * c.fluid_volume_per_length_m2) / full)
}
