//! Properties of every section.

mod common;

use common::{paper, with_shapes};
use proptest::prelude::*;
use slcbeam_section::coefficients::{Coefficients, Options};
use slcbeam_section::input::{Bladder, Material, Region, RegionShape, Row, Section, Shape};

fn solve(section: &Section) -> Coefficients {
    section.coefficients(&Options::default()).unwrap()
}

fn coarse(section: &Section) -> Coefficients {
    section
        .coefficients(&Options {
            meshes: 1,
            ..Options::default()
        })
        .unwrap()
}

fn is_positive_definite(mut a: [[f64; 4]; 4], rows: usize) -> bool {
    for k in 0..rows {
        if a[k][k] <= 0.0 {
            return false;
        }
        for i in k + 1..rows {
            let factor = a[i][k] / a[k][k];
            (k..rows).for_each(|j| a[i][j] -= factor * a[k][j]);
        }
    }
    true
}

#[test]
fn every_coefficient_of_the_papers_cell_is_within_a_thousandth() {
    for fillet in [0.0, 0.0025] {
        for nu in [0.45, 0.49, 0.4999] {
            let c = solve(&paper(nu, fillet));
            println!("{nu} {fillet}: {:#?}", c.errors);
            let e = &c.errors;
            let all = [
                e.axial_stiffness_factor,
                e.bending_stiffness_factor,
                e.area_per_pressure_m2_per_pa,
                e.area_per_other_pressure_m2_per_pa,
                e.area_per_moment_m2_per_n_m,
                e.area_per_force_m2_per_n,
                e.shear_stiffness_n,
                e.permeability_m4,
                e.solid_mass_kg_per_m,
                e.fluid_second_moment_m4,
            ];
            assert!(all.iter().all(|&e| e < 1e-3), "{nu} {fillet} {e:?}");
        }
    }
}

#[test]
fn the_estimate_covers_the_error_at_sharp_corners() {
    let section = paper(0.49, 0.0);
    let three = solve(&section);
    let five = section
        .coefficients(&Options {
            meshes: 5,
            ..Options::default()
        })
        .unwrap();
    let pairs = [
        (
            three.numbers.axial_stiffness_factor,
            five.numbers.axial_stiffness_factor,
            three.errors.axial_stiffness_factor,
        ),
        (
            three.numbers.area_per_pressure_m2_per_pa,
            five.numbers.area_per_pressure_m2_per_pa,
            three.errors.area_per_pressure_m2_per_pa,
        ),
        (
            three.numbers.area_per_moment_m2_per_n_m,
            five.numbers.area_per_moment_m2_per_n_m,
            three.errors.area_per_moment_m2_per_n_m,
        ),
        (
            three.numbers.area_per_force_m2_per_n,
            five.numbers.area_per_force_m2_per_n,
            three.errors.area_per_force_m2_per_n,
        ),
        (
            three.numbers.shear_stiffness_n,
            five.numbers.shear_stiffness_n,
            three.errors.shear_stiffness_n,
        ),
    ];
    for (coarse, fine, error) in pairs {
        println!(
            "{coarse:e} {fine:e} {:e} estimated {error:e}",
            (coarse / fine - 1.0).abs()
        );
        assert!((coarse / fine - 1.0).abs() < error);
    }
}

#[test]
fn reciprocity_holds_and_the_compliance_is_positive_definite() {
    for fillet in [0.0, 0.002] {
        let c = solve(&paper(0.4999, fillet));
        assert!(c.asymmetry < 1e-12, "{}", c.asymmetry);
        assert!(is_positive_definite(c.numbers.compliance, 4));
    }
}

#[test]
fn mirrored_rows_leave_no_coupling_and_equal_numbers() {
    let c = solve(&paper(0.49, 0.001)).numbers;
    assert!(
        c.force_curvature_coupling.abs() < 1e-11,
        "{}",
        c.force_curvature_coupling
    );
    let (upper, lower) = (c.upper.unwrap(), c.lower.unwrap());
    for (a, b) in [
        (upper.area_per_pressure_m2_per_pa, lower.area_per_pressure_m2_per_pa),
        (upper.area_per_moment_m2_per_n_m, lower.area_per_moment_m2_per_n_m),
        (upper.area_per_force_m2_per_n, lower.area_per_force_m2_per_n),
    ] {
        // Rounding error of a nearly incompressible cell.
        assert!((a / b - 1.0).abs() < 1e-10, "{a} {b}");
    }
    assert!((upper.centroid_m + lower.centroid_m).abs() < 1e-15);
}

#[test]
fn a_lower_row_given_as_its_own_is_that_of_the_mirror() {
    let shape = || Shape::Ellipse {
        along_m: 0.007,
        high_m: 0.006,
    };
    let own = solve(&with_shapes(0.45, Some((0.005, shape())), Some((-0.005, shape()))));
    let mirrored = solve(&with_shapes(0.45, Some((0.005, shape())), None));
    let (a, b) = (own.numbers, mirrored.numbers);
    // Another mesh of the same cell: equal within the sum of their errors.
    let within = |x: f64, y: f64, e: f64| assert!((x / y - 1.0).abs() < 2.0 * e, "{x} {y} {e}");
    within(
        a.axial_stiffness_factor,
        b.axial_stiffness_factor,
        own.errors.axial_stiffness_factor,
    );
    within(
        a.area_per_pressure_m2_per_pa,
        b.area_per_pressure_m2_per_pa,
        own.errors.area_per_pressure_m2_per_pa,
    );
    within(
        a.area_per_moment_m2_per_n_m,
        b.area_per_moment_m2_per_n_m,
        own.errors.area_per_moment_m2_per_n_m,
    );
}

#[test]
fn one_row_alone_bends_the_beam_it_stretches() {
    let mut section = paper(0.45, 0.001);
    section.bladders.lower = Row::None;
    let c = solve(&section).numbers;
    assert!(c.lower.is_none());
    assert!(is_positive_definite(c.compliance, 3));
    // The upper side is weaker: tension stretches it more, which is a positive curvature.
    assert!(c.compliance[0][1] > 0.0);
    assert!(c.area_per_moment_m2_per_n_m > 0.0 && c.area_per_force_m2_per_n > 0.0);
}

#[test]
fn coefficients_scale_with_size_and_modulus() {
    let one = paper(0.49, 0.001);
    let (k, stiff) = (3.0, 7.0);
    let mut other = one.clone();
    other.height_m *= k;
    other.width_m *= k;
    other.pitch_m *= k;
    other.bladders.length_m *= k;
    other.material.young_modulus_pa *= stiff;
    let shape = Shape::RoundedRectangle {
        along_m: 0.0078 * k,
        high_m: 0.0078 * k,
        fillet_m: 0.001 * k,
    };
    other.bladders.upper = Row::Bladder(Bladder {
        center_m: 0.0049 * k,
        shape,
    });
    let (a, b) = (coarse(&one).numbers, coarse(&other).numbers);
    let same = |x: f64, y: f64| assert!((x / y - 1.0).abs() < 1e-9, "{x} {y}");
    same(a.axial_stiffness_factor, b.axial_stiffness_factor);
    same(a.bending_stiffness_factor, b.bending_stiffness_factor);
    same(
        a.area_per_pressure_m2_per_pa * k * k / stiff,
        b.area_per_pressure_m2_per_pa,
    );
    same(a.area_per_moment_m2_per_n_m / k / stiff, b.area_per_moment_m2_per_n_m);
    same(a.area_per_force_m2_per_n / stiff, b.area_per_force_m2_per_n);
    same(a.slope_per_pressure_rad, b.slope_per_pressure_rad);
    same(a.length_per_pressure_m * k, b.length_per_pressure_m);
    same(a.shear_stiffness_n * stiff * k * k, b.shear_stiffness_n);
    same(a.permeability_m4 * k.powi(4), b.permeability_m4);
}

#[test]
fn nothing_locks_towards_incompressibility() {
    let at = |nu| solve(&paper(nu, 0.002)).numbers.bending_stiffness_factor;
    let (a, b, c) = (at(0.49), at(0.499), at(0.4999));
    // 1/K decreases tenfold from one to the next, and so must the change; a locking element stiffens without bound.
    let ratio = (b - a) / (c - b);
    assert!((ratio - 10.0).abs() < 1.0, "{ratio}");
}

#[test]
fn mass_is_that_of_the_outline() {
    let c = solve(&paper(0.45, 0.0)).numbers;
    let (square, pitch) = (0.0078_f64, 0.01);
    let fluid = 2.0 * square * square * 0.046 / pitch;
    let second = 2.0 * (square.powi(4) / 12.0 + square * square * 0.0049_f64.powi(2)) * 0.046 / pitch;
    let same = |x: f64, y: f64| assert!((x / y - 1.0).abs() < 1e-12, "{x} {y}");
    same(c.fluid_volume_per_length_m2, fluid);
    same(c.fluid_second_moment_m4, second);
    same(c.solid_mass_kg_per_m, 950.0 * (0.05 * 0.0216 - fluid));
    same(
        c.solid_rotary_inertia_kg_m,
        950.0 * (0.05 * 0.0216_f64.powi(3) / 12.0 - second),
    );
}

fn shape() -> impl Strategy<Value = Shape> {
    prop_oneof![
        (0.5e-3..3.5e-3_f64).prop_map(|radius_m| Shape::Circle { radius_m }),
        (1e-3..8.5e-3_f64, 1e-3..8e-3_f64).prop_map(|(along_m, high_m)| Shape::Ellipse { along_m, high_m }),
        (1e-3..8.5e-3_f64, 1e-3..8e-3_f64, 0.0..1.0_f64).prop_map(|(along_m, high_m, f)| {
            let fillet_m = if f < 0.3 {
                0.0
            } else {
                (0.2 + 0.8 * f) / 2.0 * along_m.min(high_m)
            };
            Shape::RoundedRectangle {
                along_m,
                high_m,
                fillet_m,
            }
        }),
        proptest::collection::vec(0.4..1.0_f64, 3..9).prop_map(|radii| {
            let n = radii.len() as f64;
            let corner = |(k, r): (usize, &f64)| {
                let a = k as f64 / n * std::f64::consts::TAU;
                [4.2e-3 * r * a.cos(), 4e-3 * r * a.sin()]
            };
            Shape::Polygon {
                points_m: radii.iter().enumerate().map(corner).collect(),
            }
        }),
    ]
}

proptest! {
    // One cell takes about ten milliseconds.
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn any_section_is_reciprocal_and_positive_definite(
        upper in shape(), lower in shape(), nu in 0.0..0.4999_f64, skin in 0.0..1.0_f64, length in 0.01..0.05_f64,
    ) {
        let mut section = with_shapes(nu, Some((0.0053, upper)), Some((-0.0051, lower)));
        section.bladders.length_m = length;
        if skin > 0.5 {
            let material = Material { young_modulus_pa: 2e8, poisson_ratio: 0.35, density_kg_m3: 1200.0, law: None };
            let shape = RegionShape::Layer { high_m: [-0.0108, -0.0104] };
            section.regions = vec![Region { shape, material }];
        }
        prop_assert_eq!(section.faults(), vec![]);
        // the coarsest mesh of flat shapes, and of rectangles rounded to nearly a half circle, may fold, which is reported
        let found = section.coefficients(&Options { meshes: 1, ..Options::default() });
        let folds = ["folded", "not positive definite"];
        let reported = found.as_ref().err().map(ToString::to_string).unwrap_or_default();
        prop_assume!(!folds.iter().any(|what| reported.contains(what)));
        let c = found.unwrap();
        prop_assert!(c.asymmetry < 1e-12, "{}", c.asymmetry);
        prop_assert!(is_positive_definite(c.numbers.compliance, 4));
        prop_assert!(c.numbers.shear_stiffness_n > 0.0 && c.numbers.permeability_m4 > 0.0);
        prop_assert!(c.numbers.axial_stiffness_factor > 0.0);
    }
}

#[test]
fn regions_of_the_same_material_change_nothing() {
    let round = |center, radius_m| Some((center, Shape::Circle { radius_m }));
    let plain = with_shapes(0.49, round(0.0054, 0.0038), round(-0.0054, 0.0038));
    let same = |shape| Region {
        shape,
        material: plain.material,
    };
    let regions = vec![
        // Regions: around a bladder; on one face of the period only; a fibre.
        same(RegionShape::Circle {
            center_m: [0.0, 0.0054],
            radius_m: 0.0044,
        }),
        same(RegionShape::Rectangle {
            along_m: [-0.005, -0.002],
            high_m: [-0.0004, 0.0004],
        }),
        same(RegionShape::Circle {
            center_m: [0.002, 0.0],
            radius_m: 0.0003,
        }),
        same(RegionShape::Layer {
            high_m: [-0.0108, -0.0102],
        }),
    ];
    let divided = Section {
        regions,
        ..plain.clone()
    };
    assert_eq!(divided.faults(), vec![]);
    let (a, b) = (solve(&plain), solve(&divided));
    for i in 0..4 {
        for j in 0..4 {
            let (x, y) = (&a.numbers.compliance, &b.numbers.compliance);
            let error = a.errors.compliance[i][j] + b.errors.compliance[i][j];
            // Twice the sum of the errors, plus rounding errors where an entry vanishes by symmetry.
            assert!(
                (x[i][j] - y[i][j]).abs() < (2.0 * error + 1e-9) * (x[i][i] * x[j][j]).sqrt(),
                "{i} {j}"
            );
        }
    }
    let close = |x: f64, y: f64| assert!((x / y - 1.0).abs() < 1e-3, "{x} {y}");
    close(a.numbers.shear_stiffness_n, b.numbers.shear_stiffness_n);
    close(a.numbers.solid_mass_kg_per_m, b.numbers.solid_mass_kg_per_m);
    close(a.numbers.permeability_m4, b.numbers.permeability_m4);
}

#[test]
fn a_stiff_liner_around_a_bladder_holds_it() {
    let plain = paper(0.49, 0.001);
    let mut lined = with_shapes(
        0.49,
        Some((0.0053, Shape::Circle { radius_m: 0.0038 })),
        Some((-0.0053, Shape::Circle { radius_m: 0.0038 })),
    );
    let material = Material {
        young_modulus_pa: 2e9,
        ..plain.material
    };
    let free = solve(&lined).numbers.upper.unwrap().area_per_pressure_m2_per_pa;
    lined.regions = vec![Region {
        shape: RegionShape::Circle {
            center_m: [0.0, 0.0053],
            radius_m: 0.0041,
        },
        material,
    }];
    let c = solve(&lined).numbers;
    assert!(c.upper.unwrap().area_per_pressure_m2_per_pa < 0.05 * free);
    assert!(c.lower.unwrap().area_per_pressure_m2_per_pa > 0.7 * free);
    // The upper side is stiffer now: tension stretches it less.
    assert!(c.compliance[0][1] < 0.0);
}

#[test]
fn a_cell_of_two_pitches_is_as_stiff_in_shear_as_one() {
    // Stiff or soft rods across the beam: [L5] to [L7] must not depend on their number in a cell.
    let with_rods = |young_modulus_pa: f64, count: i32| {
        let mut section = with_shapes(0.4, None, None);
        section.bladders.lower = Row::None;
        section.bladders.length_m = section.width_m;
        let material = Material {
            young_modulus_pa,
            ..section.material
        };
        let pitch = section.pitch_m;
        section.pitch_m *= f64::from(count);
        let rod = |k: i32| {
            let along = (f64::from(k) - f64::from(count - 1) / 2.0) * pitch;
            let shape = |high| RegionShape::Circle {
                center_m: [along, high],
                radius_m: 0.003,
            };
            [0.005, -0.006].map(|high| Region {
                shape: shape(high),
                material,
            })
        };
        section.regions = (0..count).flat_map(rod).collect();
        solve(&section)
    };
    for young in [1e8, 1e3] {
        let (one, two) = (with_rods(young, 1), with_rods(young, 2));
        let error = one.errors.shear_stiffness_n + two.errors.shear_stiffness_n;
        let (a, b) = (one.numbers.shear_stiffness_n, two.numbers.shear_stiffness_n);
        assert!((a / b - 1.0).abs() < error, "{a} {b} {error:e}");
    }
}
