//! Cell at finite strain: laws, limits, derivatives, closed forms.

mod common;

use common::{finest, paper, with_shapes};
use slcbeam_section::finite::{Drive, FiniteCell, Law, SectionState, cavity};
use slcbeam_section::input::{Row, Section, Shape};
use slcbeam_section::level::Level;

const LAWS: [Law; 4] = [
    Law::NeoHookean,
    Law::MooneyRivlin { second: 0.3 },
    Law::Yeoh {
        second: -0.02,
        third: 0.003,
    },
    Law::SaintVenantKirchhoff,
];

fn cells(section: &Section, law: Law, meshes: usize) -> (FiniteCell, Level) {
    let cell = finest(section, meshes);
    let level = Level::new(section, &cell).unwrap();
    (FiniteCell::new(section, cell, law).unwrap(), level)
}

/// A block without bladders and side walls.
fn block(nu: f64, pitch_m: f64) -> Section {
    let mut section = with_shapes(nu, None, None);
    section.bladders.length_m = section.width_m;
    section.bladders.lower = Row::None;
    Section { pitch_m, ..section }
}

/// Compliance from Omega's Hessian, comparable to that of the linear cell.
fn compliance(h: &[[f64; 4]; 4]) -> [[f64; 4]; 4] {
    let det = h[0][0] * h[1][1] - h[0][1] * h[1][0];
    let inverse = [[h[1][1] / det, -h[0][1] / det], [-h[1][0] / det, h[0][0] / det]];
    let strain = |load: usize, i: usize| -> f64 {
        let right = |k: usize| if load < 2 { f64::from(load == k) } else { -h[k][load] };
        inverse[i][0] * right(0) + inverse[i][1] * right(1)
    };
    std::array::from_fn(|i| {
        std::array::from_fn(|j| match i {
            0 | 1 => strain(j, i),
            _ => -h[i][0] * strain(j, 0) - h[i][1] * strain(j, 1) - if j < 2 { 0.0 } else { h[i][j] },
        })
    })
}

#[test]
fn small_strains_are_those_of_the_linear_cell() {
    // With straight sides, quadratic elements represent the macroscopic parabola exactly: both cells agree to rounding
    // errors.
    let section = paper(0.49, 0.0);
    for law in LAWS {
        let (cell, level) = cells(&section, law, 1);
        let rest = cell.equilibrium(Drive::Strain([0.0; 2]), [0.0; 2]).unwrap();
        let (ours, linear) = (compliance(&rest.tangent), level.compliance);
        for i in 0..4 {
            for j in 0..4 {
                let scale = (linear[i][i] * linear[j][j]).sqrt();
                assert!(
                    (ours[i][j] - linear[i][j]).abs() < 1e-8 * scale,
                    "{law:?} {i} {j} {} {}",
                    ours[i][j],
                    linear[i][j]
                );
            }
        }
        let small = cell.equilibrium(Drive::Load([1e-3, 2e-6]), [0.05, -0.02]).unwrap();
        let loads = [1e-3, 2e-6, 0.05, -0.02];
        let strain: f64 = (0..4).map(|j| linear[0][j] * loads[j]).sum();
        // At strains of 1e-6, the next order is a millionth of the first.
        assert!(
            (small.strain[0] / strain - 1.0).abs() < 1e-4,
            "{} {strain}",
            small.strain[0]
        );
    }
}

#[test]
fn resultants_areas_and_tangent_are_derivatives_of_one_potential() {
    let section = paper(0.48, 0.002);
    let x = [0.06, 4.0, 6e3, -3e3];
    // Central differences: the error decreases with the square of these steps; rounding errors of 1e-12 stay below it.
    let steps = [1e-4, 1e-2, 20.0, 20.0];
    for law in LAWS {
        let (cell, _) = cells(&section, law, 1);
        let at = |x: [f64; 4]| cell.equilibrium(Drive::Strain([x[0], x[1]]), [x[2], x[3]]).unwrap();
        let per_area = 0.046 / 0.01;
        let first = |s: &SectionState| {
            [
                s.resultants[0],
                s.resultants[1],
                -per_area * s.areas_m2[0],
                -per_area * s.areas_m2[1],
            ]
        };
        let middle = at(x);
        for k in 0..4 {
            let moved = |sign: f64| {
                let mut y = x;
                y[k] += sign * steps[k];
                at(y)
            };
            let (a, b) = (moved(-1.0), moved(1.0));
            let slope = (b.potential_n - a.potential_n) / (2.0 * steps[k]);
            let own = first(&middle)[k];
            let scale = (middle.tangent[k][k].abs() * middle.potential_n.abs()).sqrt();
            assert!((slope - own).abs() < 1e-5 * scale, "{law:?} {k}: {slope} {own}");
            for j in 0..4 {
                let second = (first(&b)[j] - first(&a)[j]) / (2.0 * steps[k]);
                let scale = (middle.tangent[k][k] * middle.tangent[j][j]).abs().sqrt();
                assert!(
                    (second - middle.tangent[j][k]).abs() < 1e-5 * scale,
                    "{law:?} {j} {k}: {second} {}",
                    middle.tangent[j][k]
                );
                assert!((middle.tangent[j][k] - middle.tangent[k][j]).abs() < 1e-10 * scale);
            }
        }
    }
}

#[test]
fn laws_derive_from_their_energies() {
    let f = [1.2, 0.1, -0.15, 0.85, 1.05];
    for law in LAWS {
        let middle = law.at(f).unwrap();
        for k in 0..5 {
            let moved = |sign: f64| {
                let mut g = f;
                g[k] += sign * 1e-5;
                law.at(g).unwrap()
            };
            let (a, b) = (moved(-1.0), moved(1.0));
            for part in 0..2 {
                let slope = (b[part].v - a[part].v) / 2e-5;
                // Central differences of smooth functions of order one: error 1e-10, rounding error 1e-16/1e-5.
                assert!((slope - middle[part].g[k]).abs() < 1e-8, "{law:?}");
                for j in 0..5 {
                    let second = (b[part].g[j] - a[part].g[j]) / 2e-5;
                    assert!((second - middle[part].h[j][k]).abs() < 1e-7, "{law:?}");
                }
            }
        }
    }
}

#[test]
fn a_turned_solid_stores_nothing() {
    let (s, c) = 0.7_f64.sin_cos();
    for law in LAWS {
        let [shape, theta] = law.at([c, s, -s, c, 1.0]).unwrap();
        assert!(shape.v.abs() < 1e-15 && theta.v.abs() < 1e-15);
        assert!(shape.g.iter().all(|g| g.abs() < 1e-14));
    }
}

#[test]
fn a_block_in_extension_is_a_bar() {
    for law in LAWS {
        let section = block(0.4999, 0.01);
        let (cell, _) = cells(&section, law, 1);
        let area = section.width_m * section.height_m;
        let (mu, bulk) = (section.material.shear_modulus(), section.material.bulk_modulus());
        for e in [-0.2, 0.3] {
            let s = cell.equilibrium(Drive::Strain([e, 0.0]), [0.0; 2]).unwrap();
            let [energy, stress, _] = law.bar(mu, bulk, 1.0 + e).unwrap();
            assert!((s.resultants[0] / (area * stress) - 1.0).abs() < 1e-8, "{law:?}");
            assert!((s.potential_n / (area * energy) - 1.0).abs() < 1e-8);
            if law == Law::NeoHookean {
                // Incompressible: mu (lambda - lambda^-2); mu/K is 2e-4.
                let l = 1.0 + e;
                assert!((s.resultants[0] / (area * mu * (l - l.powi(-2))) - 1.0).abs() < 2e-4);
            }
        }
    }
}

#[test]
fn a_block_bends_to_the_same_arc_whatever_the_pitch() {
    let at = |pitch| {
        let (cell, _) = cells(&block(0.45, pitch), Law::NeoHookean, 2);
        cell.equilibrium(Drive::Load([0.0, 2.0]), [0.0; 2]).unwrap()
    };
    // The field is constant along the arc and equal in both cells. Their meshes differ; the error is of fourth order in
    // the rotation of 0.1 per element.
    let (a, b) = (at(0.01), at(0.017));
    assert!(a.strain[1] > 20.0, "{:?}", a.strain);
    assert!(
        (a.potential_n / b.potential_n - 1.0).abs() < 1e-5,
        "{} {}",
        a.potential_n,
        b.potential_n
    );
    assert!((a.strain[1] / b.strain[1] - 1.0).abs() < 1e-5);
    assert!(
        (a.strain[0] / b.strain[0] - 1.0).abs() < 1e-3,
        "{} {}",
        a.strain[0],
        b.strain[0]
    );
    // Every fibre is a bar at its rest height, the assumption for side walls. The change of height is neglected; it is
    // of second order in the strain of the outer fibre.
    let fibres = |law: Law, e: f64, kappa: f64| {
        let section = block(0.45, 0.01);
        let (mu, bulk, n) = (section.material.shear_modulus(), section.material.bulk_modulus(), 2000);
        let place = |k: i32| ((f64::from(k) + 0.5) / f64::from(n) - 0.5) * section.height_m;
        let energy = |x: f64| law.bar(mu, bulk, 1.0 + e + kappa * x).unwrap()[0];
        (0..n).map(|k| energy(place(k))).sum::<f64>() / f64::from(n) * section.height_m * section.width_m
    };
    let bars = fibres(Law::NeoHookean, a.strain[0], a.strain[1]);
    let outer = a.strain[1] * 0.0216 / 2.0;
    assert!(
        (a.potential_n / bars - 1.0).abs() < outer * outer,
        "block {} bars {bars}",
        a.potential_n
    );
}

#[test]
fn opposite_curvatures_swap_the_rows() {
    let (cell, _) = cells(&paper(0.49, 0.002), Law::NeoHookean, 1);
    let a = cell.equilibrium(Drive::Load([10.0, 0.2]), [4e3, 1e3]).unwrap();
    let b = cell.equilibrium(Drive::Load([10.0, -0.2]), [1e3, 4e3]).unwrap();
    assert!((a.strain[1] + b.strain[1]).abs() < 1e-8 * a.strain[1].abs());
    assert!((a.areas_m2[0] / b.areas_m2[1] - 1.0).abs() < 1e-8);
}

#[test]
fn the_state_does_not_depend_on_the_way() {
    let (cell, _) = cells(&paper(0.49, 0.002), Law::NeoHookean, 1);
    let direct = cell.equilibrium(Drive::Load([30.0, 0.1]), [5e3, 0.0]).unwrap();
    let mut state = cell.rest();
    cell.follow(&mut state, [0.0; 2], Drive::Strain([-0.03, -2.0]), [0.0, 4e3])
        .unwrap();
    let around = cell
        .follow(&mut state, [0.0, 4e3], Drive::Load([30.0, 0.1]), [5e3, 0.0])
        .unwrap();
    assert!((direct.potential_n / around.potential_n - 1.0).abs() < 1e-8);
    assert!((direct.strain[1] / around.strain[1] - 1.0).abs() < 1e-8);
}

#[test]
fn a_cavitys_volume_is_that_of_its_outline() {
    // A rectangle of 2 by 3 with its centroid at height 5.
    let corners = [[-1.0, 3.5], [1.0, 3.5], [1.0, 6.5], [-1.0, 6.5]];
    let (g0, g1) = (0.1, -0.03);
    let part = |k: usize| {
        let (a, b): ([f64; 2], [f64; 2]) = (corners[k], corners[(k + 1) % 4]);
        cavity::edge([a, [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0], b], g0, g1).value
    };
    let whole: f64 = (0..4).map(part).sum();
    assert!((whole - 6.0 * (1.0 + g0 + g1 * 5.0)).abs() < 1e-13);
}

/// A section whose rows are rectangular pockets beside a wall of this thickness [m].
fn pockets(wall: f64, heights: [f64; 2]) -> Section {
    let pocket = |height: f64, sign: f64| {
        let shape = Shape::RoundedRectangle {
            along_m: 0.006,
            high_m: height,
            fillet_m: 0.2 * wall,
        };
        Some((sign * 0.5 * (wall + height), shape))
    };
    let mut section = with_shapes(0.45, pocket(heights[0], 1.0), pocket(heights[1], -1.0));
    section.bladders.length_m = section.width_m;
    section
}

/// Source: Maxwell. Goal: pressure in either of two unlike rows changes the area of the other alike, by finite elements under both loads, as the
/// linear cell has it.
#[test]
fn pressure_in_one_row_acts_on_the_other_reciprocally() {
    let (cell, level) = cells(&pockets(0.001, [0.005, 0.003]), Law::SaintVenantKirchhoff, 1);
    let slope = |pressures: [f64; 2], row: usize| {
        let area = |sign: f64| {
            let found = cell.equilibrium(Drive::Load([0.0; 2]), pressures.map(|p| sign * p));
            found.unwrap().areas_m2[row]
        };
        (area(1.0) - area(-1.0)) / 200.0
    };
    let [lower, upper] = [slope([100.0, 0.0], 1), slope([0.0, 100.0], 0)];
    println!("{lower:e} {upper:e}");
    assert!((lower / upper - 1.0).abs() < 1e-4 && lower < 0.0, "{lower:e} {upper:e}");
    let linear = level.compliance[2][3] * 0.01 / 0.05;
    assert!((lower / linear - 1.0).abs() < 1e-4, "{lower:e} {linear:e}");
}

/// Source: a clamped strip under pressure bulges by `(1 - ν²) L⁵/(60 E t³)`. Goal: the wall between two pockets does so into the other one,
/// the closer the thinner it is; shear and the give of its clamps go with t/L.
#[test]
fn a_thin_wall_between_the_rows_bulges_as_a_plate() {
    let off = [0.0006, 0.0003].map(|wall| {
        let section = pockets(wall, [0.004; 2]);
        let (_, level) = cells(&section, Law::NeoHookean, 2);
        let per_cell = section.bladders.length_m / section.pitch_m;
        let plate =
            (1.0 - 0.45_f64.powi(2)) * 0.006_f64.powi(5) / (60.0 * section.material.young_modulus_pa * wall.powi(3));
        -level.compliance[2][3] / per_cell / plate - 1.0
    });
    println!("{off:?}");
    assert!(off[1] > 0.0 && off[1] < 0.2 && off[1] < 0.6 * off[0], "{off:?}");
}

/// Goal: no iteration stops early at small pressures, that of the side walls' lateral stretch included. Areas per pressure at p and 2 p, extrapolated to zero, are those of the
/// tangent at rest. Tolerance: rounding errors of the areas, 1e-20 m^2.
#[test]
fn small_pressures_have_the_areas_of_the_tangent() {
    let per_area = 0.046 / 0.01;
    for law in LAWS {
        let (cell, _) = cells(&paper(0.48, 0.0), law, 1);
        let at = |drive, p: f64| cell.equilibrium(drive, [p, 0.0]).unwrap();
        let rest = at(Drive::Strain([0.0; 2]), 0.0);
        for (drive, exact) in [
            (Drive::Strain([0.0; 2]), -rest.tangent[2][2]),
            (Drive::Load([0.0; 2]), compliance(&rest.tangent)[2][2]),
        ] {
            for p in [0.05, 0.1, 0.5] {
                let [one, two] = [p, 2.0 * p].map(|p| per_area * at(drive, p).areas_m2[0] / p);
                assert!(
                    ((2.0 * one - two) / exact - 1.0).abs() < 1e-8,
                    "{law:?} {p} {one} {exact}"
                );
            }
        }
    }
}
