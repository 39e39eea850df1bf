//! The cell at finite strain.

mod common;

use common::paper;
use slcbeam_section::cell::Cell;
use slcbeam_section::coefficients::Options;
use slcbeam_section::finite::{Drive, FiniteCell, Law};
use slcbeam_section::level::Level;

fn cell(fillet: f64, law: Law) -> (FiniteCell, Level) {
    let section = paper(0.49, fillet);
    let meshes = section
        .meshes(&Options {
            meshes: 1,
            ..Options::default()
        })
        .unwrap();
    let cell = Cell::new(&section, &meshes[0]);
    let level = Level::new(&section, &cell).unwrap();
    (FiniteCell::new(&section, cell, law).unwrap(), level)
}

#[test]
fn secants() {
    for fillet in [0.001, 0.0025] {
        for law in [
            Law::NeoHookean,
            Law::MooneyRivlin { second: 0.2 },
            Law::Yeoh {
                second: 0.1,
                third: 0.01,
            },
            Law::SaintVenantKirchhoff,
        ] {
            let (cell, level) = cell(fillet, law);
            let start = std::time::Instant::now();
            let rest = cell.equilibrium(Drive::Load([0.0, 0.0]), [0.0; 2]).unwrap();
            println!(
                "{fillet} {law:?} tangent {:e} {:e} against {:e}",
                rest.tangent[0][0] * level.compliance[0][0],
                rest.tangent[1][1] * level.compliance[1][1],
                rest.tangent[2][2]
            );
            for load in [[100.0, 0.0], [-100.0, 0.0], [0.0, 0.28], [0.0, -0.28], [300.0, 0.0]] {
                match cell.equilibrium(Drive::Load(load), [0.0; 2]) {
                    Ok(s) => println!(
                        "{load:?}: strain {:?} resultants {:?} areas per load {:e} {:e} iterations {}",
                        s.strain,
                        s.resultants,
                        s.areas_m2[0] / (load[0] + load[1]),
                        s.areas_m2[1] / (load[0] + load[1]),
                        s.iterations
                    ),
                    Err(e) => println!("{load:?} {e}"),
                }
            }
            println!("{:?}", start.elapsed());
        }
    }
}
