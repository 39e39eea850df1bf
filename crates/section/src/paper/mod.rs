//! The cell of Matia and Gat's honeycomb, compared with their printed coefficients (A.4.1, A.4.2).
//!
//! The paper gives the size of the bladders, 7.8 mm square and 46 mm long, and of the beam. It does not give the height
//! of the bladders above the mid-plane, their fillets, or Poisson's ratio. The wall thickness allows a center between
//! 3.9 and 6.9 mm. The paper's plus and minus compliances are secants at large loads; a linear cell has a single value
//! in between.

mod secants;

use crate::coefficients::{Numbers, Options};
use crate::error::Error;
use crate::input::{Bladder, Bladders, Material, Row, Section, Shape};
use crate::permeability::{Channel, permeability};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use secants::{Experiment, Secants};

/// A printed coefficient: a value, or a range between its plus and minus secants.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Printed {
    /// Name of the number, as in [Numbers].
    pub name: &'static str,
    /// Smallest printed value.
    pub low: f64,
    /// Largest printed value.
    pub high: f64,
    /// True if a cell can be expected to reproduce it.
    pub fitted: bool,
}

/// The printed coefficients.
pub const PRINTED: [Printed; 8] = [
    Printed {
        name: "axial_stiffness_factor",
        low: 0.53,
        high: 0.53,
        fitted: true,
    },
    Printed {
        name: "bending_stiffness_factor",
        low: 0.60,
        high: 0.60,
        fitted: true,
    },
    Printed {
        name: "area_per_pressure_m2_per_pa",
        low: 1.75e-10,
        high: 1.75e-10,
        fitted: true,
    },
    Printed {
        name: "area_per_moment_m2_per_n_m",
        low: 3.75e-6,
        high: 6.54e-6,
        fitted: true,
    },
    Printed {
        name: "area_per_force_m2_per_n",
        low: 3.64e-8,
        high: 6.31e-8,
        fitted: true,
    },
    Printed {
        name: "slope_per_pressure_rad",
        low: 0.00381467,
        high: 0.00381467,
        fitted: false,
    },
    Printed {
        name: "length_per_pressure_m",
        low: 0.01,
        high: 0.01,
        fitted: false,
    },
    Printed {
        name: "permeability_m4",
        low: 1.55e-12,
        high: 1.55e-12,
        fitted: false,
    },
];

/// A variant of the cell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Variant {
    /// Poisson's ratio.
    pub poisson_ratio: f64,
    /// Fillet of the square [m].
    pub fillet_m: f64,
    /// Height of the square's center above the mid-plane [m].
    pub center_m: f64,
    /// Values in the order of [PRINTED].
    pub computed: [f64; 8],
    /// Root mean square of ln(computed / printed) over the fitted coefficients; a range counts as its geometric mean.
    pub misfit: f64,
}

/// Comparison of variants with the printed coefficients.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PaperTable {
    /// All variants.
    pub variants: Vec<Variant>,
    /// Index of the variant with the smallest misfit.
    pub best: usize,
    /// Values of the best variant in three dimensions: the first seven of [PRINTED].
    pub spatial: [f64; 7],
    /// Radius of a round tube with the printed q1c = 6.72e-13 m^4 [m]; the paper's radius is 1 mm.
    pub tube_radius_m: f64,
    /// Side of a square bladder with the printed q1b = 1.55e-12 m^4 [m]; the paper's side is 7.8 mm.
    pub square_side_m: f64,
}

/// The paper's section with square bladders of this fillet at this height.
pub fn section(poisson_ratio: f64, fillet_m: f64, center_m: f64) -> Section {
    let shape = Shape::RoundedRectangle {
        along_m: 0.0078,
        high_m: 0.0078,
        fillet_m,
    };
    Section {
        height_m: 0.0216,
        width_m: 0.05,
        pitch_m: 0.01,
        material: Material {
            young_modulus_pa: 2e6,
            poisson_ratio,
            density_kg_m3: 950.0,
            law: None,
        },
        bladders: Bladders {
            length_m: 0.046,
            upper: Row::Bladder(Bladder { center_m, shape }),
            lower: Row::Mirrored,
        },
        regions: Vec::new(),
        three_d: false,
    }
}

fn values(n: &Numbers) -> [f64; 8] {
    [
        n.axial_stiffness_factor,
        n.bending_stiffness_factor,
        n.area_per_pressure_m2_per_pa,
        n.area_per_moment_m2_per_n_m,
        n.area_per_force_m2_per_n,
        n.slope_per_pressure_rad,
        n.length_per_pressure_m,
        n.permeability_m4,
    ]
}

/// The first seven of [PRINTED] from the compliance of a section with mirrored rows, [K1] to [K3].
fn spread(section: &Section, c: &[[f64; 4]; 4]) -> [f64; 7] {
    let (e, w, h) = (section.material.young_modulus_pa, section.width_m, section.height_m);
    let length = section.bladders.length_m;
    let per_cell = length / section.pitch_m;
    let [pressure, moment, force] = [c[2][2], c[1][2], c[0][2]].map(|entry| entry / per_cell);
    let factors = [1.0 / (c[0][0] * e * w * h), 12.0 / (c[1][1] * e * w * h.powi(3))];
    [
        factors[0],
        factors[1],
        pressure,
        moment,
        force,
        length * e * moment,
        length * e * force,
    ]
}

/// Computes the comparison for all combinations of ratios, fillets and heights.
pub fn paper_table(ratios: &[f64], fillets_m: &[f64], centers_m: &[f64]) -> Result<PaperTable, Error> {
    let options = Options {
        meshes: 2,
        ..Options::default()
    };
    let mut variants = Vec::new();
    for &poisson_ratio in ratios {
        for &fillet_m in fillets_m {
            for &center_m in centers_m {
                let computed = values(
                    &section(poisson_ratio, fillet_m, center_m)
                        .coefficients(&options)?
                        .numbers,
                );
                let fitted = PRINTED.iter().zip(computed).filter(|(p, _)| p.fitted);
                let squares: Vec<f64> = fitted
                    .map(|(p, c)| (c / (p.low * p.high).sqrt()).ln().powi(2))
                    .collect();
                let misfit = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
                variants.push(Variant {
                    poisson_ratio,
                    fillet_m,
                    center_m,
                    computed,
                    misfit,
                });
            }
        }
    }
    let best = (0..variants.len())
        .min_by(|&a, &b| variants[a].misfit.total_cmp(&variants[b].misfit))
        .unwrap_or(0);
    let chosen = &variants[best];
    let section = section(chosen.poisson_ratio, chosen.fillet_m, chosen.center_m);
    let spatial = spread(&section, &section.three_dimensional()?.compliance);
    // q1 is proportional to the fourth power of a shape's size.
    let unit = |shape| permeability(&Channel::Open(shape)).map(|q| q.value);
    let square = unit(Shape::RoundedRectangle {
        along_m: 1.0,
        high_m: 1.0,
        fillet_m: 0.0,
    })?;
    let round = unit(Shape::Circle { radius_m: 1.0 })?;
    Ok(PaperTable {
        variants,
        best,
        spatial,
        tube_radius_m: (6.72e-13 / round).powf(0.25),
        square_side_m: (1.55e-12 / square).powf(0.25),
    })
}
