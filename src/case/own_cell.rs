//! Coefficients for a case's own dimensions, to compare with inherited ones: from the plane cell with the published shape, scaled.
//!
//! A case gives the size and material of its bladders, but not their outline, their height above the mid-plane or Poisson's ratio. These
//! are taken from the published cell that fits its coefficients best: fillets of 2.5 mm in a square of 7.8 mm, a third of the free height
//! towards the mid-plane, ν 0.49.

use slcbeam_section::coefficients::Numbers;
use slcbeam_section::input::{Bladder, Bladders, Material, Row, Section, Shape};

use super::computed;
use super::schema::{Case, SpanLengths};

/// Poisson's ratio.
const RATIO: f64 = 0.49;
/// Fillet over the shorter side of a bladder.
const FILLET: f64 = 2.5 / 7.8;
/// Fraction of the free height of a half that is between bladder and mid-plane.
const INNER: f64 = 1.0 / 3.0;

/// Modulus [Pa] and density [kg/m³] of the solved cell. Cases that differ only in these values share one solution, because areas scale with
/// `1/E` and nothing else depends on them.
const SOLVED: [f64; 2] = [1e6, 1e3];

/// The cell with a case's dimensions.
pub(super) struct OwnCell {
    numbers: Result<Numbers, String>,
    /// Ratio of areas with the case's material to those of the solved cell.
    softer: f64,
    /// Assumptions, as text.
    pub(super) assumed: String,
}

impl OwnCell {
    /// Solves the cell; none for a beam without bladders, which may be solid or have empty ones.
    pub(super) fn from_case(case: &Case) -> Option<Self> {
        let (section, assumed) = section(case, SOLVED)?;
        let numbers = computed::coefficients(&section).map(|found| found.numbers);
        Some(Self {
            numbers: numbers.map_err(|error| error.to_string().replace('\n', "; ")),
            softer: SOLVED[0] / case.beam.young_modulus_pa,
            assumed,
        })
    }

    /// The coefficient at a pointer of a case, if the cell has it.
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

/// Section with a case's dimensions and a material of this modulus and density, and its assumptions as text.
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
        pitch_m: SpanLengths::new(case).pitch,
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

    /// Goal: cells that differ only in modulus and density share one solution; areas scale with `1/E`, factors do not change.
    #[test]
    fn cells_of_other_moduli_are_one() {
        let load = |modulus: &str| {
            let set = [
                format!("/beam/young_modulus_pa={modulus}"),
                "/beam/density_kg_m3=900".into(),
            ];
            case::load("cases/wiring-2.json".as_ref(), &set).expect("a case")
        };
        let of = |modulus: &str| OwnCell::from_case(&load(modulus)).expect("a cell");
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
        // compared with a cell that is solved with this modulus
        let (section, _) = section(&load("8e6"), [8e6, 900.0]).expect("a cell");
        let own = computed::coefficients(&section)
            .expect("solved")
            .numbers
            .area_per_pressure_m2_per_pa;
        let value = stiff.coefficient("/bladders/area_per_pressure_m2_per_pa");
        let value = value.expect("solved").expect("one of the cell's");
        assert!((value / own - 1.0).abs() < 1e-9, "{value} {own}");
    }
}
