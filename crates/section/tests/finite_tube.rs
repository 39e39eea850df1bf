//! A long tube with closed ends, inflated to 1.5 times its bore: closed form of rubber elasticity.
//!
//! Rivlin, Phil. Trans. A 242 (1949): an incompressible tube under inner pressure remains a tube. With radius R at
//! rest, deformed radius r and axial stretch l, r^2 - r_i^2 = (R^2 - R_i^2)/l. The principal stretches are r/R, R/(r
//! l), l. The energy per rest length depends only on r_i and l, and p does the work p (l pi r_i^2). Both derivatives
//! therefore give p.

mod common;

use common::with_shapes;
use slcbeam_section::cell::{Cell, Part};
use slcbeam_section::finite::{Drive, FiniteCell, Law};
use slcbeam_section::geometry::outline::{Outline, inside};
use slcbeam_section::input::{Row, Section};
use slcbeam_section::mesh::{Domain, Fineness, Mesh};
use std::f64::consts::PI;

const INNER: f64 = 2e-3;
const OUTER: f64 = 5e-3;

fn radius(at_rest: f64, inner: f64, stretch: f64) -> f64 {
    (inner * inner + (at_rest * at_rest - INNER * INNER) / stretch).sqrt()
}

/// Energy of the neo-Hookean tube per rest length, over the shear modulus; the error of the midpoint rule on 4000 rings
/// is 1e-7.
fn energy(inner: f64, stretch: f64) -> f64 {
    let n = 4000;
    let step = (OUTER - INNER) / f64::from(n);
    let ring = |k: i32| {
        let big = INNER + (f64::from(k) + 0.5) * step;
        let r = radius(big, inner, stretch);
        let around = r / big;
        PI * big * step * (around.powi(2) + (around * stretch).powi(-2) + stretch.powi(2) - 3.0)
    };
    (0..n).map(ring).sum()
}

/// Axial stretch, and pressure over the shear modulus, for a deformed bore.
fn exact(inner: f64) -> (f64, f64) {
    let by_bore = |l: f64| {
        let d = 1e-5 * inner;
        (energy(inner + d, l) - energy(inner - d, l)) / (2.0 * d) / (2.0 * PI * inner * l)
    };
    let by_length = |l: f64| (energy(inner, l + 1e-5) - energy(inner, l - 1e-5)) / 2e-5 / (PI * inner * inner);
    let (mut low, mut high) = (0.7, 1.3);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if by_length(middle) < by_bore(middle) {
            low = middle
        } else {
            high = middle
        }
    }
    (low, by_bore(low))
}

/// Cell of the tube's diameter in length; each face of the period is a single node.
fn tube(section: &Section, meshes: usize) -> FiniteCell {
    let rings = [OUTER, INNER].map(|r| Outline::ellipse([0.0; 2], [r; 2]));
    let bore = rings[1].chords();
    let part = |p| {
        Some(if inside(&bore, p) {
            Part::Upper(0)
        } else {
            Part::Solid(0)
        })
    };
    let domain = Domain {
        outlines: rings.to_vec(),
        half_pitch: None,
        mirrored: false,
    };
    let mut mesh = Mesh::new(&domain, &Fineness::default(), &part).unwrap();
    (1..meshes).for_each(|_| mesh = mesh.refined());
    let cell = Cell {
        mesh: mesh.quadratic(),
        materials: vec![section.material],
        size: [2.0 * OUTER, 2.0 * OUTER],
    };
    FiniteCell::new(section, cell, Law::NeoHookean).unwrap()
}

#[test]
fn a_tube_blown_up_by_half_its_bore() {
    // mu/K is 2e-4; the effect of compressibility is of this size.
    let mut section = with_shapes(0.4999, None, None);
    section.bladders.length_m = section.width_m;
    section.bladders.lower = Row::None;
    let mu = section.material.shear_modulus();
    let inner = 1.5 * INNER;
    let (stretch, pressure) = exact(inner);
    let grown = radius(OUTER, inner, stretch) / OUTER - 1.0;
    let volume = PI * (inner * inner * stretch - INNER * INNER);
    let mut errors = Vec::new();
    for meshes in 1..=3 {
        let s = tube(&section, meshes)
            .equilibrium(Drive::Strain([grown, 0.0]), [pressure * mu, 0.0])
            .unwrap();
        errors.push((s.areas_m2[0] / volume - 1.0).abs());
        println!(
            "{meshes}: volume off by {:e}, axial strain {} exact {}",
            errors[errors.len() - 1],
            s.lateral[0],
            stretch - 1.0
        );
    }
    assert!(errors[2] < 2e-3 && errors[2] < errors[0] / 4.0, "{errors:?}");
}
