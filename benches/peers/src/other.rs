//! The integrators of the crate diffsol, on slcbeam's residual and Jacobian.

use std::cell::RefCell;
use std::rc::Rc;
use std::time::Instant;

use diffsol::{FaerSparseLU, FaerSparseMat, KLU, MatrixCommon, OdeBuilder, OdeSolverMethod};
use slcbeam::dae::{Dae, Seeds};

use crate::scene::{Ran, Scene};

/// Runs a scene with a method of diffsol; readings at the output times.
pub fn follow(scene: &Scene, name: &str, rtol: f64) -> Result<Ran, String> {
    let n = scene.y.len();
    let zero = vec![0.0; n];
    let shared = Rc::new(RefCell::new(scene.dae()));
    let mass = scene.mass();
    let rhs = {
        let (shared, zero) = (Rc::clone(&shared), zero.clone());
        move |y: &[f64], _: &[f64], t: f64, out: &mut [f64]| {
            shared.borrow_mut().residual(t, y, &zero, out).expect("a residual");
            out.iter_mut().for_each(|x| *x = -*x);
        }
    };
    // evaluate the Jacobian once per state, for any number of products
    let kept = RefCell::new((f64::NAN, vec![0.0; n], vec![0.0; shared.borrow().pattern().rows.len()]));
    let jacobian = {
        let pattern = shared.borrow().pattern().clone();
        let (shared, zero, ones) = (Rc::clone(&shared), zero.clone(), vec![1.0; n]);
        move |y: &[f64], _: &[f64], t: f64, v: &[f64], out: &mut [f64]| {
            let mut kept = kept.borrow_mut();
            let (at, of, values) = &mut *kept;
            if *at != t || of != y {
                let seeds = Seeds::Columns { y: &ones, yp: &zero };
                shared
                    .borrow_mut()
                    .jacobian(t, y, &zero, seeds, values)
                    .expect("a Jacobian");
                (*at, *of) = (t, y.to_vec());
            }
            out.fill(0.0);
            for (column, &v) in v.iter().enumerate() {
                for k in pattern.column(column) {
                    // zero values are no entries, but NaN must propagate
                    if values[k] != 0.0 || v.is_nan() {
                        out[pattern.rows[k] as usize] -= values[k] * v;
                    }
                }
            }
        }
    };
    let start = scene.y.clone();
    let mut problem = OdeBuilder::<FaerSparseMat<f64>>::new()
        .rtol(rtol)
        .atol([rtol])
        .rhs_implicit(rhs, jacobian)
        .mass(move |v: &[f64], _: &[f64], _: f64, beta: f64, out: &mut [f64]| {
            for ((out, v), m) in out.iter_mut().zip(v).zip(&mass) {
                *out = if *m == 0.0 { beta * *out } else { m * v + beta * *out };
            }
        })
        .init(move |_: &[f64], _: f64, y: &mut [f64]| y.copy_from_slice(&start), n)
        .build()
        .map_err(|e| e.to_string())?;
    problem.ode_options.max_nonlinear_solver_failures = 100_000;
    problem.ode_options.max_error_test_failures = 100_000;
    macro_rules! solve {
        ($solver:expr) => {{
            let begin = Instant::now();
            let mut solver = $solver.map_err(|e| e.to_string())?;
            let (values, _) = solver.solve_dense(&scene.times).map_err(|e| e.to_string())?;
            let seconds = begin.elapsed().as_secs_f64();
            let steps = solver.get_statistics().number_of_steps;
            let mut y = vec![0.0; n];
            let readings = (0..values.ncols()).map(|k| {
                y.iter_mut().enumerate().for_each(|(i, y)| *y = values[(i, k)]);
                scene.readings.read(&y)
            });
            let readings = readings.collect();
            Ok(Ran {
                seconds,
                readings,
                steps,
            })
        }};
    }
    match name {
        "diffsol-bdf-klu" => solve!(problem.bdf::<KLU<_>>()),
        "diffsol-trbdf2-klu" => solve!(problem.tr_bdf2::<KLU<_>>()),
        "diffsol-esdirk34-klu" => solve!(problem.esdirk34::<KLU<_>>()),
        "diffsol-bdf-faer" => solve!(problem.bdf::<FaerSparseLU<_>>()),
        "diffsol-trbdf2-faer" => solve!(problem.tr_bdf2::<FaerSparseLU<_>>()),
        "diffsol-esdirk34-faer" => solve!(problem.esdirk34::<FaerSparseLU<_>>()),
        other => Err(format!("no method {other}")),
    }
}
