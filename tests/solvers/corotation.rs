//! Newton's matrix, rotated with a turning beam.
//!
//! Source: internal forces rotate with a beam. Goal: the matrix of a rotated beam is the rotated matrix, so runs with large rotations need
//! few new ones.

use std::path::Path;

use serde_json::{Value, json};
use slcbeam::case;
use slcbeam::dae::{BeamDae, Corotation, Dae, RotatedVectors, Seeds};
use slcbeam::discrete::System;
use slcbeam::run::{dynamics, record::Memory, summary::Status};
use slcbeam::sparse::Lu;

use super::sundials::chance::Random;

const CJ: f64 = 900.0;

fn beam(form: &Value) -> BeamDae {
    let mut case = json!({
        "name": "turned", "preset": "matia-gat-beam",
        "network": {"chains": [{"bladders": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10], "ends": ["sealed", "sealed"]}]},
        "ends": {"root": "pinned", "tip": "free"},
        "time": {"end_s": 0.1, "output_interval_s": 0.001}
    });
    case["effects"] =
        json!({"finite_rotation": "on", "axial_stretch": "on", "axial_inertia": "on", "rotary_inertia": "off"});
    for (key, value) in form.as_object().unwrap() {
        match (key.as_str(), value.as_object()) {
            ("effects", Some(effects)) => effects
                .iter()
                .for_each(|(key, value)| case["effects"][key] = value.clone()),
            _ => case[key] = value.clone(),
        }
    }
    let case = case::parse(&case.to_string(), Path::new("test.json"), Path::new(""), &[]).unwrap();
    BeamDae::new(System::new(&case).unwrap())
}

/// Rotates the vectors of a scaled state by an angle; adds `along`, the axial position of each node, to convert displacements to positions.
fn turned(of: &RotatedVectors, v: &mut [f64], angle: f64, scale: f64, along: impl Fn(usize) -> f64) {
    let (sin, cos) = angle.sin_cos();
    for k in 0..of.across.len() {
        let (i, j) = (of.across.start + k, of.along.start + k);
        let (x, z) = (v[i] * scale, v[j] * scale * of.size + along(of.node + k));
        v[i] = (cos * x + sin * z) / scale;
        v[j] = (cos * z - sin * x - along(of.node + k)) / (scale * of.size);
    }
}

/// `[E80]` Goal: a pinned beam, bent, stretched, filled and in random motion, is rotated about its pin. Its residual is the rotated
/// residual, and solutions with the old matrix, rotated, agree with those of its own. Tolerance: rounding errors. Published and
/// conservative form, second and fourth order, with rotary inertia, without any inertia, and with shear.
#[test]
fn a_matrix_turns_with_the_beam() {
    let forms = [
        json!({"formulation": "published"}),
        json!({"formulation": "conservative"}),
        json!({"mesh": {"order": 4, "cells_per_segment": 2}}),
        json!({"effects": {"rotary_inertia": "on"}}),
        json!({"effects": {"solid_inertia": "off", "axial_inertia": "off"}}),
        json!({"effects": {"rotary_inertia": "on", "shear": "on"}, "formulation": "conservative", "beam": {"shear_stiffness_n": 300}}),
    ];
    let mut random = Random(80);
    for form in forms {
        let mut dae = beam(&form);
        let n = dae.len();
        let vectors = dae.vectors();
        assert!(!vectors.is_empty(), "{form}");
        let (h, scales) = (dae.system().mesh.shortest, dae.system().layout.scales.clone());
        let state = |random: &mut Random| -> Vec<f64> { (0..n).map(|_| 0.1 * random.between(-1.0, 1.0)).collect() };
        let (mut y, mut yp) = (state(&mut random), state(&mut random));
        for i in vectors.iter().flat_map(|v| v.across.clone().chain(v.along.clone())) {
            y[i] *= (0.5 * h / scales[i]).min(1.0);
        }
        let mut corotation = Corotation::new(&dae);
        let (mut residual, mut values) = (vec![0.0; n], vec![0.0; dae.pattern().entries()]);
        let mut lu = Lu::sparse(dae.pattern()).unwrap();
        let mut matrix = |dae: &mut BeamDae, y: &[f64], yp: &[f64]| {
            dae.residual(0.0, y, yp, &mut residual).unwrap();
            dae.jacobian(0.0, y, yp, Seeds::Step { cj: CJ }, &mut values).unwrap();
            (residual.clone(), values.clone())
        };
        let (before, old) = matrix(&mut dae, &y, &yp);
        corotation.renew();
        corotation.look(&dae);
        for (k, v) in vectors.iter().enumerate() {
            let scale = scales[v.across.start];
            turned(v, &mut y, 2.5, scale, |node| if k == 0 { node as f64 * h } else { 0.0 });
            turned(v, &mut yp, 2.5, scale, |_| 0.0);
        }
        for angle in dae.system().layout.turning.angle.clone() {
            y[angle] += 2.5 / scales[angle];
        }
        let (after, new) = matrix(&mut dae, &y, &yp);
        corotation.look(&dae);
        let mut back = after.clone();
        corotation.back(&mut back);
        let size = before.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for (back, before) in back.iter().zip(&before) {
            assert!(
                (back - before).abs() <= 1e-9 * size,
                "{form}: {back:e} for {before:e} of {size:e}"
            );
        }
        let mut carried = after.clone();
        lu.factor(&old).unwrap();
        corotation.back(&mut carried);
        assert!(lu.solve(&mut carried));
        corotation.forth(&mut carried);
        let (mut product, mut size) = (vec![0.0; n], after.iter().map(|r| r.abs()).collect::<Vec<f64>>());
        for (j, x) in carried.iter().enumerate() {
            for entry in dae.pattern().column(j) {
                let i = dae.pattern().rows[entry] as usize;
                product[i] += new[entry] * x;
                size[i] += (new[entry] * x).abs();
            }
        }
        for ((product, right), size) in product.iter().zip(&after).zip(&size) {
            assert!(
                (product - right).abs() <= 1e-8 * size,
                "{form}: {product:e} for {right:e} of {size:e}"
            );
        }
    }
}

/// Goal: beams whose forces do not rotate with them have no vectors: with small rotations, with only transverse inertia, or with an end
/// that keeps momentum in one direction. A free beam rotates as a whole.
#[test]
fn what_does_not_turn_has_no_vectors() {
    let guided = json!({"root": "guided", "tip": "free"});
    for form in [
        json!({"effects": {"finite_rotation": "off"}}),
        json!({"effects": {"axial_inertia": "off"}}),
        json!({ "ends": guided }),
    ] {
        assert!(beam(&form).vectors().is_empty(), "{form}");
    }
    let free = beam(&json!({"ends": {"root": "free", "tip": "free"}})).vectors();
    assert!(free.len() == 2 && free.iter().all(|vectors| vectors.free));
}

/// Work of a run: steps, failures of Newton's iteration, matrices.
fn work(name: &str, sets: &[&str]) -> [u64; 3] {
    let sets: Vec<String> = sets.iter().map(|&set| set.to_owned()).collect();
    let case = case::load(Path::new(&format!("cases/{name}.json")), &sets).unwrap();
    let outcome = dynamics::run(&case, &mut Memory::default()).unwrap();
    assert_eq!(outcome.summary.status, Status::Finished, "{:?}", outcome.fault);
    let done = &outcome.summary.solver;
    println!(
        "{name} {sets:?}: {} steps, {} iterations",
        done.steps, done.newton_iterations
    );
    println!(
        "    {} not solved, {} matrices",
        done.newton_failures, done.jacobian_evaluations
    );
    [done.steps, done.newton_failures, done.jacobian_evaluations]
}

/// Goal: an arm that turns by 78 rad: Newton's iteration fails in less than one of twenty steps, and less than one of five needs a new
/// matrix. Without rotated matrices, `esdirk46` needed more than one for each of 3462 steps, and failed 970 times.
#[test]
fn what_turns_needs_few_matrices() {
    for method in ["trbdf2", "esdirk46", "esdirk57"] {
        let method = format!("/solver/method=\"{method}\"");
        let [steps, failures, matrices] = work("spin-up", &["/solver/rtol=1e-5", &method]);
        assert!(steps < 2500 && 20 * failures <= steps && 5 * matrices <= steps);
    }
}
