//! The cell from which coefficients of a section are computed: [`slcbeam_section::verify`].

use slcbeam_section::verify::{self, Compare, Comparison, LEAST_ORDER, ROUND_OFF};

use super::figure::ExactFigure;
use super::problem::SolvedProblem;
use crate::error::Error;

const APPROACHED: &str = "a thousandth on the third of three coarse meshes, the goal of every coefficient; quadratic elements \
    converge with an order above 3.3 (4 on fine meshes), and what the meshes show covers the error";

/// All rows.
pub fn rows() -> Vec<SolvedProblem> {
    vec![
        row(
            "section-layers",
            [
                "Saint-Venant: extension, bending and anticlastic curvature of prisms and of layers of one Poisson's ratio; shear stress by equilibrium",
                "stretch, curvature and lateral strain up to a Poisson's ratio of 0.4999, composites, side walls; shear stiffness",
                "stresses that elements hold exactly: round-off. Shear stiffness: within a thousandth, with an order above 3.3",
            ],
            verify::layers,
        ),
        row(
            "section-patch",
            [
                "uniform and linear stress",
                "regions of the same material change the mesh and nothing else",
                "exact on every mesh: round-off",
            ],
            verify::patches,
        ),
        row(
            "section-tube",
            [
                "Lame 1852: thick-walled tube under inner and outer pressure, held and with closed ends",
                "pressure on curved walls without locking up to a Poisson's ratio of 0.4999",
                APPROACHED,
            ],
            verify::tubes,
        ),
        row(
            "section-channels",
            [
                "Hagen-Poiseuille (circle), Boussinesq (ellipse, triangle), Fourier series (square, rectangle), Lamb (annulus)",
                "permeabilities by the Poisson problem on a mesh",
                APPROACHED,
            ],
            verify::channels,
        ),
        row(
            "section-finite-strain",
            [
                "uniaxial stress of each material at a stretch of 30 %",
                "energies and equilibria at finite strain",
                "uniform strain, which elements hold exactly: round-off",
            ],
            verify::finite_strain,
        ),
        row(
            "section-three-d",
            [
                "Saint-Venant",
                "bricks of the cell in three dimensions, core and side walls",
                "stresses that elements hold exactly: round-off",
            ],
            verify::three_dimensions,
        ),
        row(
            "section-symmetry",
            [
                "Maxwell and Betti: reciprocity; energy is positive",
                "the compliance over (N, M, p_u, p_l), before it is made symmetric, of sections whose halves are alike and unlike",
                "1e-12 of the root of the product of diagonal entries: round-off of the factors; a count of eigenvalues has no error",
            ],
            verify::symmetry,
        ),
    ]
}

fn row(name: &str, words: [&'static str; 3], compare: Compare) -> SolvedProblem {
    SolvedProblem::new(name, words, move || {
        let found = compare().map_err(|error| Error::Usage(error.to_string()))?;
        Ok(found.iter().map(figure).collect())
    })
}

fn figure(found: &Comparison) -> ExactFigure {
    let of = if found.exact == 0.0 {
        ExactFigure::absolute
    } else {
        ExactFigure::relative
    };
    let finest = found.computed.last().copied().unwrap_or(f64::NAN);
    let figure = of(&found.name, finest, found.exact, found.tolerance);
    match found.estimate() {
        None => figure,
        Some(shown) => ExactFigure {
            order: found.order,
            orders: LEAST_ORDER..=f64::INFINITY,
            estimate: Some((shown, ROUND_OFF)),
            ..figure
        },
    }
}
