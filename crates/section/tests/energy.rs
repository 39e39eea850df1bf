//! The polynomial of the energy at finite strain, compared with its cell.

mod common;

use common::{finest, paper};
use slcbeam_section::finite::energy::monomials;
use slcbeam_section::finite::{Drive, FiniteCell, Law, SectionState, StrainEnergy};
use slcbeam_section::input::{Row, Section};

fn section(law: Option<Law>) -> Section {
    of_ratio(0.49, law)
}

fn of_ratio(poisson_ratio: f64, law: Option<Law>) -> Section {
    let mut section = paper(poisson_ratio, 0.0025);
    section.material.law = law;
    section
}

fn cell(section: &Section, meshes: usize) -> FiniteCell {
    FiniteCell::new(section, finest(section, meshes), section.material.law.unwrap()).unwrap()
}

/// P at z, by its definition.
fn value(energy: &StrainEnergy, z: [f64; 4]) -> f64 {
    let term = |k: [usize; 4]| (0..4).map(|i| z[i].powi(k[i] as i32)).product::<f64>();
    let terms = monomials(energy.degree, energy.mirrored).map(term);
    terms.zip(&energy.coefficients_n).map(|(term, c)| term * c).sum()
}

/// z at y.
fn scaled(energy: &StrainEnergy, y: [f64; 4]) -> [f64; 4] {
    let largest = |of: &[[f64; 2]]| of.iter().flatten().fold(0.0_f64, |most, end| end.abs().max(most));
    let [e, k, p] = [&energy.limits[..1], &energy.limits[1..2], &energy.limits[2..]].map(largest);
    [y[0] / e, y[1] / k, (y[2] + y[3]) / (2.0 * p), (y[2] - y[3]) / (2.0 * p)]
}

/// A cell's state at rest; its tangent gives the strains by pressure, and thus the strains by loads y_1, y_2.
struct Rest(SectionState);

impl Rest {
    fn from_cell(cell: &FiniteCell) -> Self {
        Self(cell.equilibrium(Drive::Strain([0.0; 2]), [0.0; 2]).unwrap())
    }

    /// Error of the polynomial relative to the energy of the cell at y, over the quadratic part.
    fn off(&self, energy: &StrainEnergy, cell: &FiniteCell, y: [f64; 4]) -> f64 {
        let p = [y[2], y[3]];
        let at = cell.equilibrium(Drive::Strain(self.strain(energy, y)), p).unwrap();
        let (found, exact) = (value(energy, scaled(energy, y)), self.beyond(&at));
        let off = (found - exact).abs() / self.size(&at);
        println!("{y:?}: {found:.5} {exact:.5}, off by {off:.1e} of the quadratic part");
        off
    }

    /// Stretch and curvature of the cell at y, of which the first is that of the neutral axis.
    fn strain(&self, energy: &StrainEnergy, y: [f64; 4]) -> [f64; 2] {
        let t = &self.0.tangent;
        let neutral = if energy.mirrored { 0.0 } else { -t[0][1] / t[0][0] };
        let cross = if energy.mirrored { 0.0 } else { t[0][1] };
        let [n, m] = [0, 1].map(|i| -(t[i][2] * y[2] + t[i][3] * y[3]));
        let det = t[0][0] * t[1][1] - cross * cross;
        let [stretch, curvature] = [(n * t[1][1] - m * cross) / det, (m * t[0][0] - n * cross) / det];
        [y[0] + neutral * y[1] + stretch, y[1] + curvature]
    }

    /// Sum of the magnitudes of the quadratic terms, which differ in sign.
    fn size(&self, at: &SectionState) -> f64 {
        let x = [at.strain[0], at.strain[1], at.pressures_pa[0], at.pressures_pa[1]];
        (0..4).map(|i| 0.5 * self.0.tangent[i][i].abs() * x[i] * x[i]).sum()
    }

    /// Omega without its quadratic part.
    fn beyond(&self, at: &SectionState) -> f64 {
        let x = [at.strain[0], at.strain[1], at.pressures_pa[0], at.pressures_pa[1]];
        let quadratic: f64 = (0..4)
            .map(|i| (0..4).map(|j| x[i] * x[j] * self.0.tangent[i][j]).sum::<f64>())
            .sum();
        at.potential_n - 0.5 * quadratic
    }
}

/// Compares a polynomial with its cell in directions without symmetry, inside the ellipsoid.
fn between(section: &Section, energy: &StrainEnergy) {
    let cell = cell(section, 1);
    let rest = Rest::from_cell(&cell);
    for direction in [
        [0.6, 0.3, 0.4, 0.1],
        [-0.3, 0.5, 0.6, 0.2],
        [0.1, -0.2, -0.3, 0.8],
        [-0.4, -0.4, 0.4, -0.3],
    ] {
        let y: [f64; 4] =
            std::array::from_fn(|i| direction[i] * energy.limits[i][usize::from(direction[i] > 0.0)].abs());
        let off = rest.off(energy, &cell, y);
        assert!(off < 5e-3, "{y:?}: {off}");
    }
}

#[test]
fn the_polynomial_is_the_energy_of_the_cell_between_the_states_that_it_was_fitted_to() {
    for law in [
        Law::NeoHookean,
        Law::SaintVenantKirchhoff,
        Law::MooneyRivlin { second: 0.2 },
    ] {
        let section = section(Some(law));
        let energy = section.strain_energy().unwrap().unwrap();
        assert!(energy.error < 1e-2, "{law:?}: {}", energy.error);
        between(&section, &energy);
    }
}

#[test]
fn the_energy_is_that_of_a_finer_mesh() {
    let section = section(Some(Law::NeoHookean));
    let energy = section.strain_energy().unwrap().unwrap();
    let fine = cell(&section, 2);
    let rest = Rest::from_cell(&fine);
    for direction in [
        [0.7, 0.0, 0.0, 0.0],
        [0.0, 0.8, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.8],
        [0.4, 0.4, 0.4, 0.4],
    ] {
        let y: [f64; 4] = std::array::from_fn(|i| direction[i] * energy.limits[i][1]);
        let off = rest.off(&energy, &fine, y);
        assert!(off < 1e-2, "{y:?}: {off}");
    }
}

#[test]
fn nearer_to_incompressible_little_changes() {
    let section = of_ratio(0.4999, Some(Law::NeoHookean));
    let energy = section.strain_energy().unwrap().unwrap();
    let cell = cell(&section, 1);
    let rest = Rest::from_cell(&cell);
    for direction in [
        [0.7, 0.0, 0.0, 0.0],
        [0.0, 0.8, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.8],
        [-0.4, 0.4, 0.4, 0.4],
    ] {
        let y: [f64; 4] = std::array::from_fn(|i| direction[i] * energy.limits[i][1]);
        let off = rest.off(&energy, &cell, y);
        assert!(off < 1e-2, "{y:?}: {off}");
    }
}

#[test]
fn a_section_without_a_law_has_none() {
    assert_eq!(section(None).strain_energy().unwrap(), None);
}

#[test]
fn one_row_and_unlike_rows_have_their_own_terms() {
    let mut one_row = section(Some(Law::NeoHookean));
    one_row.bladders.lower = Row::None;
    let mut unlike = section(Some(Law::NeoHookean));
    if let Row::Bladder(upper) = &unlike.bladders.upper {
        let mut lower = upper.clone();
        lower.center_m *= -0.9;
        unlike.bladders.lower = Row::Bladder(lower);
    }
    for section in [one_row, unlike] {
        let energy = section.strain_energy().unwrap().unwrap();
        assert!(!energy.mirrored && energy.error < 1e-2, "{}", energy.error);
        between(&section, &energy);
    }
}
