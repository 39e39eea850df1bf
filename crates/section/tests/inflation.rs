//! A section pumped up at finite strain: growths over the linear law, limit points, layers beside the core [F7].

mod common;

use common::{finest, paper};
use slcbeam_section::error::Error;
use slcbeam_section::finite::inflation::Inflation;
use slcbeam_section::finite::{Drive, FiniteCell, Law};
use slcbeam_section::input::{Material, Region, RegionShape, Row, Section};
use slcbeam_section::level::Level;

/// The paper's cell with one row and a law, in a rubber of this modulus [Pa].
fn cell(modulus: f64) -> Section {
    let mut section = paper(0.49, 0.0);
    section.bladders.lower = Row::None;
    section.material.young_modulus_pa = modulus;
    section.material.law = Some(Law::NeoHookean);
    section
}

fn inflate(section: &Section, pressures: &[f64]) -> Inflation {
    section.inflate(pressures).unwrap().unwrap()
}

/// Goal: free curvature, area and blocked moment are those of the cell in equilibrium on a fine mesh over those of its linear law: 1 %, for
/// the coarse mesh of the growths.
#[test]
fn growths_are_those_of_the_cell() {
    let section = cell(2e6);
    let pressure = 6e4;
    let found = inflate(&section, &[pressure]).growths[0];
    let mesh = finest(&section, 1);
    let linear = Level::new(&section, &mesh).unwrap().compliance;
    let fine = FiniteCell::new(&section, mesh, Law::NeoHookean).unwrap();
    let free = fine.equilibrium(Drive::Load([0.0; 2]), [pressure, 0.0]).unwrap();
    let curvature = free.strain[1] / (linear[1][2] * pressure);
    let per_length = section.bladders.length_m / section.pitch_m;
    let area = free.areas_m2[0] * per_length / (linear[2][2] * pressure);
    // the stretch without axial force, by Newton's steps
    let mut stretch = 0.0;
    let mut held = fine.equilibrium(Drive::Strain([0.0; 2]), [pressure, 0.0]).unwrap();
    for _ in 0..5 {
        stretch -= held.resultants[0] / held.tangent[0][0];
        held = fine
            .equilibrium(Drive::Strain([stretch, 0.0]), [pressure, 0.0])
            .unwrap();
    }
    let c = &linear;
    // N = 0 and kappa = 0: M about mid-height, with the stretch left free
    let moment = held.resultants[1] / (-c[1][2] / c[1][1] * pressure);
    assert!(curvature > 1.02 && moment > 1.02, "{curvature} {moment}");
    let pairs = [(found.curvature, curvature), (found.area, area), (found.moment, moment)];
    for (own, exact) in pairs {
        assert!((own.unwrap() / exact - 1.0).abs() < 0.01, "{own:?} {exact}");
    }
}

/// Goal: small pressures follow the linear law; growth rises up to a limit point, beyond which no state is reported, and the limit is
/// proportional to the modulus, since nothing else has that unit: to the bisection of a step, 0.1 % of E.
#[test]
fn chambers_balloon_at_a_limit_pressure() {
    let at = |modulus: f64| {
        inflate(
            &cell(modulus),
            &[0.002, 0.02, 0.04, 0.05, 3.0].map(|part| part * modulus),
        )
    };
    let (soft, hard) = (at(1e5), at(2e5));
    let curvatures: Vec<f64> = soft.growths.iter().filter_map(|growth| growth.curvature).collect();
    assert!((curvatures[0] - 1.0).abs() < 0.02, "{curvatures:?}");
    assert!(curvatures.windows(2).all(|pair| pair[0] < pair[1]), "{curvatures:?}");
    let limit = soft.limit_pa.unwrap();
    assert!(soft.growths.last().unwrap().curvature.is_none() && limit < 3e5);
    assert!(
        (hard.limit_pa.unwrap() / limit - 2.0).abs() < 0.01,
        "{limit} {:?}",
        hard.limit_pa
    );
    let near = inflate(&cell(1e5), &[0.97 * limit, 1.03 * limit]);
    assert!(near.growths[0].curvature.is_some() && near.growths[1].curvature.is_none());
}

/// Goal: a layer of the section's own material beside chambers shorter than the beam is wide changes nothing but its lumping: 2 %.
#[test]
fn layers_beside_the_core_are_lumped_into_it() {
    let mut section = cell(1e5);
    section.bladders.length_m = 0.03;
    let plain = inflate(&section, &[3e3]).growths[0];
    section.regions.push(Region {
        shape: RegionShape::Layer {
            high_m: [-0.0108, -0.008],
        },
        material: section.material,
    });
    let layered = inflate(&section, &[3e3]).growths[0];
    for (one, other) in [(plain.curvature, layered.curvature), (plain.moment, layered.moment)] {
        assert!((one.unwrap() / other.unwrap() - 1.0).abs() < 0.02, "{one:?} {other:?}");
    }
    let stiff = Material {
        young_modulus_pa: 1e9,
        ..section.material
    };
    section.regions[0] = Region {
        shape: RegionShape::Circle {
            center_m: [0.0, -0.008],
            radius_m: 0.001,
        },
        material: stiff,
    };
    match section.inflate(&[3e3]) {
        Err(Error::Section(faults)) => assert!(faults[0].what.contains("other than layers"), "{faults:?}"),
        other => panic!("{other:?}"),
    }
    section.material.law = None;
    assert_eq!(section.inflate(&[3e3]).unwrap(), None);
}
