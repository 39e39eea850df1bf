//! Sections common to several tests.
#![allow(dead_code)]

use slcbeam_section::cell::Cell;
use slcbeam_section::coefficients::Options;
use slcbeam_section::input::{Bladder, Bladders, Material, Row, Section, Shape};

/// The paper's cell with square bladders of the given fillet.
pub fn paper(nu: f64, fillet_m: f64) -> Section {
    let shape = Shape::RoundedRectangle {
        along_m: 0.0078,
        high_m: 0.0078,
        fillet_m,
    };
    with_shapes(nu, Some((0.0049, shape)), None)
}

/// Section of the paper's outer sizes with these bladders; without a lower one, the upper is mirrored.
pub fn with_shapes(nu: f64, upper: Option<(f64, Shape)>, lower: Option<(f64, Shape)>) -> Section {
    let row = |given: Option<(f64, Shape)>, none| {
        given.map_or(none, |(center_m, shape)| Row::Bladder(Bladder { center_m, shape }))
    };
    Section {
        height_m: 0.0216,
        width_m: 0.05,
        pitch_m: 0.01,
        material: Material {
            young_modulus_pa: 2e6,
            poisson_ratio: nu,
            density_kg_m3: 950.0,
            law: None,
        },
        bladders: Bladders {
            length_m: 0.046,
            upper: row(upper, Row::None),
            lower: row(lower, Row::Mirrored),
        },
        regions: Vec::new(),
        three_d: false,
    }
}

/// Cell on the finest of `meshes` meshes.
pub fn finest(section: &Section, meshes: usize) -> Cell {
    let options = Options {
        meshes,
        ..Options::default()
    };
    let meshes = section.meshes(&options).unwrap();
    Cell::new(section, &meshes[meshes.len() - 1])
}
