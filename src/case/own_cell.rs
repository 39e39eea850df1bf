//! What a case's own sizes would give in place of coefficients that it inherits: by the plane cell with the published shape, scaled.
//!
//! A case knows size and material of its bladders, not their outline, height above the mid-plane and Poisson's ratio. They are taken as those of
//! the published cell that fit its coefficients best: fillets of 2.5 mm in a square of 7.8 mm, a third of the free height towards the
//! mid-plane, ν 0.49.

use slcbeam_section::coefficients::Numbers;
use slcbeam_section::input::{Bladder, Bladders, Material, Row, Section, Shape};

use super::computed;
use super::schema::Case;

/// Poisson's ratio.
const RATIO: f64 = 0.49;
/// Fillet over the shorter side of a bladder.
const FILLET: f64 = 2.5 / 7.8;
/// Part of the free height of a half that lies between bladder and mid-plane.
const INNER: f64 = 1.0 / 3.0;

/// Modulus [Pa] and density [kg/m³] of the cell that is solved: cases that differ in these alone share it, as areas go with `1/E` and nothing
/// else does.
const SOLVED: [f64; 2] = [1e6, 1e3];

/// The cell of a case's sizes.
pub(super) struct OwnCell {
    numbers: Result<Numbers, String>,
    /// Areas of the case's material over those of the cell.
    softer: f64,
    /// What was assumed, in words.
    pub(super) assumed: String,
}

impl OwnCell {
    /// Solves it; none for a beam without bladders, which may be full or have empty ones.
    pub(super) fn of(case: &Case) -> Option<Self> {
        let (section, assumed) = section(case, SOLVED)?;
        let numbers = computed::coefficients(&section).map(|found| found.numbers);
        Some(Self {
            numbers: numbers.map_err(|error| error.to_string().replace('\n', "; ")),
            softer: SOLVED[0] / case.beam.young_modulus_pa,
            assumed,
        })
    }

    /// The coefficient that stands at a pointer of a case, where it is one of the cell's.
    pub(super) fn coefficient(&self, pointer: &str) -> Result<Option<f64>, &str> {
        let numbers = self.numbers.as_ref().map_err(String::as_str)?;
        let key = pointer.split('/').nth(2).unwrap_or_default();
        Ok(match key {
            "axial_stiffness_factor" => Some(numbers.axial_stiffness_factor),
            "bending_stiffness_factor" => Some(numbers.bending_stiffness_factor),
            "area_per_pressure_m2_per_pa" => Some(self.softer * numbers.area_per_pressure_m2_per_pa),
            "area_per_moment_m2_per_n_m" => Some(self.softer * numbers.area_per_moment_m2_per_n_m),
            "area_per_force_m2_per_n" => Some(self.softer * numbers.area_per_force_m2_per_n),
            "permeability_m4" => Some(numbers.permeability_m4),
            _ => None,
        })
    }
}

/// The cell of a case's sizes, of a material of this modulus and density, and what was assumed of it in words.
fn section(case: &Case, [young_modulus_pa, density_kg_m3]: [f64; 2]) -> Option<(Section, String)> {
    let (beam, of) = (&case.beam, case.bladders.as_ref()?);
    let fillet_m = FILLET * of.height_m.min(of.width_m);
    let center_m = of.height_m / 2.0 + INNER * (beam.height_m / 2.0 - of.height_m);
    let shape = Shape::RoundedRectangle {
        along_m: of.width_m,
        high_m: of.height_m,
        fillet_m,
    };
    let section = Section {
        height_m: beam.height_m,
        width_m: beam.width_m,
        pitch_m: beam.length_m / of.per_row.max(1) as f64,
        material: Material {
            young_modulus_pa,
            poisson_ratio: RATIO,
            density_kg_m3,
            law: None,
        },
        bladders: Bladders {
            length_m: of.length_m,
            upper: Row::Bladder(Bladder { center_m, shape }),
            lower: Row::Mirrored,
        },
        regions: vec![],
        three_d: false,
    };
    let assumed = format!(
        "a plane cell with a Poisson's ratio of {RATIO}, fillets of {:.3} mm and centres {:.3} mm off the mid-plane",
        1e3 * fillet_m,
        1e3 * center_m
    );
    Some((section, assumed))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case;

    /// Goal: a cell of another modulus and density is the same cell; its areas go with `1/E`, factors stay.
    #[test]
    fn cells_of_other_moduli_are_one() {
        let load = |modulus: &str| {
            let set = [
                format!("/beam/young_modulus_pa={modulus}"),
                "/beam/density_kg_m3=900".into(),
            ];
            case::load("cases/wiring-2.json".as_ref(), &set).expect("a case")
        };
        let of = |modulus: &str| OwnCell::of(&load(modulus)).expect("a cell");
        let (soft, stiff) = (of("1e6"), of("8e6"));
        for (pointer, ratio) in [
            ("/bladders/area_per_pressure_m2_per_pa", 8.0),
            ("/bladders/area_per_moment_m2_per_n_m/opening", 8.0),
            ("/bladders/area_per_force_m2_per_n/tension", 8.0),
            ("/beam/bending_stiffness_factor", 1.0),
            ("/bladders/permeability_m4", 1.0),
        ] {
            let at = |cell: &OwnCell| cell.coefficient(pointer).expect("solved").expect("one of the cell's");
            assert_eq!(at(&soft) / at(&stiff), ratio, "{pointer}");
        }
        // as the cell of the modulus itself has it
        let (section, _) = section(&load("8e6"), [8e6, 900.0]).expect("a cell");
        let own = computed::coefficients(&section)
            .expect("solved")
            .numbers
            .area_per_pressure_m2_per_pa;
        let told = stiff.coefficient("/bladders/area_per_pressure_m2_per_pa");
        let told = told.expect("solved").expect("one of the cell's");
        assert!((told / own - 1.0).abs() < 1e-9, "{told} {own}");
    }
}
