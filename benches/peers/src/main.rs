//! Error against time of slcbeam's integrators and of diffsol's, on the same residual and Jacobian, side by side.
//!
//! The scene is `cases/shaken-sealed.json` without rotary inertia, so that `F(t, y, y') = M y' - f(t, y)` with a constant
//! diagonal `M`, the form that diffsol takes. Energies are not integrated along. Errors are of the tip's deflection over all
//! output times, relative to its maximum, against ESDIRK5(4)7 at rtol 1e-9 on the same mesh. Times are medians of alternating runs.

mod radau;

use std::cell::RefCell;
use std::rc::Rc;
use std::time::Instant;

use diffsol::{FaerSparseMat, KLU, MatrixCommon, OdeBuilder, OdeSolverMethod};
use slcbeam::case::{self, Case};
use slcbeam::dae::{BeamDae, Dae, EvaluationError, Seeds};
use slcbeam::sparse::Pattern;
use slcbeam::discrete::{System, start};
use slcbeam::onestep::{Method, OneStepOptions};
use slcbeam::run::method::{Integrator, Options};
use slcbeam::integrate::start::{StartOptions, consistent_start};
use slcbeam::integrate::Absolute;
use slcbeam::sundials::IdaOptions;
use slcbeam::sparse::Klu;

use radau::{Radau, Work};

/// Runs of each setting.
const REPEATS: usize = 5;
/// Accuracies at which methods are compared.
const ACCURACIES: [f64; 3] = [1e-2, 1e-3, 1e-4];

/// The beam without its ledger.
struct Bare(BeamDae);

impl Dae for Bare {
    fn len(&self) -> usize {
        self.0.len()
    }
    fn differential(&self) -> &[bool] {
        self.0.differential()
    }
    fn pattern(&self) -> &Pattern {
        self.0.pattern()
    }
    fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), EvaluationError> {
        self.0.enter_smooth_interval(t);
        self.0.residual(t, y, yp, r)
    }
    fn jacobian(&mut self, t: f64, y: &[f64], yp: &[f64], seeds: Seeds<'_>, values: &mut [f64]) -> Result<(), EvaluationError> {
        self.0.enter_smooth_interval(t);
        self.0.jacobian(t, y, yp, seeds, values)
    }
    fn name(&self, unknown: usize) -> String {
        self.0.name(unknown)
    }
}

/// The scene, its start, and where the tip's deflection is.
struct Scene {
    case: Case,
    y: Vec<f64>,
    yp: Vec<f64>,
    tip: usize,
    times: Vec<f64>,
    largest_step: f64,
}

impl Scene {
    fn new(path: &str) -> Self {
        let set = r#"/effects={"rotary_inertia":"off"}"#.to_owned();
        let case = case::load(path.as_ref(), &[set]).expect("a case");
        let system = System::new(&case).unwrap();
        let tip = system.layout.u1 + system.layout.free_u1.len() - 1;
        let mut dae = BeamDae::new(system);
        dae.enter_smooth_interval(0.0);
        let (system, now) = dae.instant(0.0);
        let mut y = start::state(system, &case, now);
        let mut yp = vec![0.0; y.len()];
        consistent_start(&mut dae, 0.0, &mut y, &mut yp, &StartOptions::default()).expect("a start");
        let (end, interval) = (case.time.end_s, case.time.output_interval());
        let times = (1..=(end / interval).round() as usize)
            .map(|k| k as f64 * interval)
            .collect();
        let largest_step = slcbeam::run::strides::Strides::new(&case, dae.system()).least();
        Self {
            case,
            y,
            yp,
            tip,
            times,
            largest_step,
        }
    }

    fn dae(&self) -> Bare {
        Bare(BeamDae::new(System::new(&self.case).unwrap()))
    }

    fn one_step(&self, method: Method, rtol: f64) -> (Vec<f64>, usize) {
        self.follow(&Options::OneStep(OneStepOptions {
            method,
            relative: rtol,
            absolute: Absolute::Same(rtol),
            max_step: Some(self.largest_step),
            ..OneStepOptions::default()
        }))
    }

    fn ida(&self, rtol: f64) -> (Vec<f64>, usize) {
        self.follow(&Options::Ida(IdaOptions {
            relative: rtol,
            absolute: Absolute::Same(rtol),
            max_order: 2,
            max_step: Some(self.largest_step),
            nonlinear_coefficient: 0.033,
            ..IdaOptions::default()
        }))
    }

    /// Deflections at the output times, and steps.
    fn follow(&self, options: &Options) -> (Vec<f64>, usize) {
        let mut solver = Integrator::new(self.dae(), 0.0, &self.y, &self.yp, options).expect("an integrator");
        let mut y = self.y.clone();
        let mut tip = vec![];
        let end = *self.times.last().expect("times");
        while tip.len() < self.times.len() {
            let at = solver.step(end).expect("a step").time;
            while let Some(&t) = self.times.get(tip.len()).filter(|t| **t <= at) {
                solver.interpolate(t, 0, &mut y).expect("a value");
                tip.push(y[self.tip]);
            }
        }
        (tip, solver.steps() as usize)
    }

    /// Times of a residual, a solution, a factorisation and a Jacobian [s].
    fn prices(&self) -> [f64; 4] {
        let mut dae = self.dae();
        let n = self.y.len();
        let mut r = vec![0.0; n];
        let mut values = vec![0.0; dae.pattern().rows.len()];
        let mut klu = Klu::new(dae.pattern()).expect("factors");
        let seeds = Seeds::Step { cj: 1e3 };
        dae.jacobian(0.0, &self.y, &self.yp, seeds, &mut values)
            .expect("a Jacobian");
        klu.factor(&values).expect("factors");
        let price = |work: &mut dyn FnMut()| {
            let begin = Instant::now();
            (0..1000).for_each(|_| work());
            begin.elapsed().as_secs_f64() / 1000.0
        };
        [
            price(&mut || dae.residual(0.0, &self.y, &self.yp, &mut r).expect("a residual")),
            price(&mut || assert!(klu.solve(&mut vec![1.0; n]))),
            price(&mut || klu.factor(&values).expect("factors")),
            price(&mut || {
                dae.jacobian(0.0, &self.y, &self.yp, seeds, &mut values)
                    .expect("a Jacobian")
            }),
        ]
    }

    /// `M`, from the residual's change with each rate; it is diagonal, so with all at once.
    fn mass(&self) -> Vec<f64> {
        let n = self.y.len();
        let (mut with, mut without) = (vec![0.0; n], vec![0.0; n]);
        let mut dae = self.dae();
        dae.residual(0.0, &self.y, &vec![1.0; n], &mut with)
            .expect("a residual");
        dae.residual(0.0, &self.y, &vec![0.0; n], &mut without)
            .expect("a residual");
        with.iter().zip(&without).map(|(w, o)| w - o).collect()
    }

    fn diffsol(&self, peer: Peer, rtol: f64) -> (Vec<f64>, usize) {
        let n = self.y.len();
        let zero = vec![0.0; n];
        let shared = Rc::new(RefCell::new(self.dae()));
        let mass = self.mass();
        let rhs = {
            let (shared, zero) = (Rc::clone(&shared), zero.clone());
            move |y: &[f64], _: &[f64], t: f64, out: &mut [f64]| {
                shared.borrow_mut().residual(t, y, &zero, out).expect("a residual");
                out.iter_mut().for_each(|x| *x = -*x);
            }
        };
        // the Jacobian once a state, however many products are asked for
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
                for column in 0..v.len() {
                    for k in pattern.starts[column] as usize..pattern.starts[column + 1] as usize {
                        // what is zero is no entry, NaN or not
                        if values[k] != 0.0 || v[column].is_nan() {
                            out[pattern.rows[k] as usize] -= values[k] * v[column];
                        }
                    }
                }
            }
        };
        let start = self.y.clone();
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
            .expect("a problem");
        problem.ode_options.max_nonlinear_solver_failures = 100_000;
        problem.ode_options.max_error_test_failures = 100_000;
        macro_rules! solve {
            ($solver:expr) => {{
                let mut solver = $solver.expect("a solver");
                let (values, _) = solver.solve_dense(&self.times).expect("a solution");
                let steps = solver.get_statistics().number_of_steps;
                (
                    (0..values.ncols()).map(|k| values[(self.tip, k)]).collect(),
                    steps,
                )
            }};
        }
        match peer {
            Peer::Esdirk34 => solve!(problem.esdirk34::<KLU<_>>()),
            Peer::TrBdf2 => solve!(problem.tr_bdf2::<KLU<_>>()),
        }
    }
}

#[derive(Clone, Copy)]
enum Peer {
    Esdirk34,
    TrBdf2,
}

/// Time at which a method has an accuracy, along its points in logarithms.
fn cost(points: &[(f64, f64)], accuracy: f64) -> Option<f64> {
    let pair = points.windows(2).find(|p| p[0].0 >= accuracy && p[1].0 <= accuracy)?;
    let part = (pair[0].0 / accuracy).ln() / (pair[0].0 / pair[1].0).ln();
    Some((pair[0].1.ln() + part * (pair[1].1 / pair[0].1).ln()).exp())
}

fn main() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/shaken-sealed.json");
    let scene = Scene::new(path);
    type Run<'a> = Box<dyn Fn(f64) -> (Vec<f64>, usize) + 'a>;
    let methods: Vec<(&str, Run)> = vec![
        ("IDA, order 2", Box::new(|rtol| scene.ida(rtol))),
        ("ESDIRK3(2)4", Box::new(|rtol| scene.one_step(Method::Esdirk34, rtol))),
        ("ESDIRK4(3)6", Box::new(|rtol| scene.one_step(Method::Esdirk46, rtol))),
        ("ESDIRK5(4)7", Box::new(|rtol| scene.one_step(Method::Esdirk57, rtol))),
        ("diffsol ESDIRK34", Box::new(|rtol| scene.diffsol(Peer::Esdirk34, rtol))),
        ("diffsol TR-BDF2", Box::new(|rtol| scene.diffsol(Peer::TrBdf2, rtol))),
    ];
    let exact = scene.one_step(Method::Esdirk57, 1e-9).0;
    let size = exact.iter().fold(0.0_f64, |s, x| s.max(x.abs()));
    let error = |tip: &[f64]| tip.iter().zip(&exact).fold(0.0_f64, |e, (a, b)| e.max((a - b).abs())) / size;
    println!("{} unknowns, {} output times", scene.y.len(), scene.times.len());
    let settings: Vec<f64> = (4..=13).map(|k| 10_f64.powf(-0.5 * f64::from(k))).collect();
    let mut curves = vec![vec![]; methods.len()];
    println!("{:<18}{:>9}{:>8}{:>10}{:>10}", "method", "rtol", "steps", "error", "ms");
    for &rtol in &settings {
        let mut times = vec![vec![]; methods.len()];
        let mut results = vec![(0.0, 0); methods.len()];
        for _ in 0..REPEATS {
            for (m, (_, run)) in methods.iter().enumerate() {
                let begin = Instant::now();
                let (tip, steps) = run(rtol);
                times[m].push(begin.elapsed().as_secs_f64());
                results[m] = (error(&tip), steps);
            }
        }
        for (m, (name, _)) in methods.iter().enumerate() {
            times[m].sort_by(f64::total_cmp);
            let (time, (error, steps)) = (times[m][REPEATS / 2], results[m]);
            curves[m].push((error, time));
            println!("{name:<18}{rtol:>9.1e}{steps:>8}{error:>10.1e}{:>10.2}", 1e3 * time);
        }
    }
    let prices = scene.prices();
    println!(
        "\nRadau IIA of order 5: work, and the ms it would take at {:.1?} us for a",
        prices.map(|p| 1e6 * p)
    );
    println!("residual, solution, factorisation, Jacobian, complex ones four times as much");
    println!(
        "{:>9}{:>8}{:>12}{:>9}{:>10}{:>10}",
        "rtol", "steps", "iterations", "factors", "error", "ms"
    );
    let mass = scene.mass();
    let mut radau_curve = vec![];
    for &rtol in &settings {
        let mut radau = Radau::new(scene.dae(), &mass, rtol);
        let tip = radau.solve(&scene.y, &scene.times, scene.tip, scene.largest_step);
        let Work {
            steps,
            iterations,
            factorizations,
            ..
        } = radau.work;
        let (error, time) = (error(&tip), radau.work.time(prices));
        radau_curve.push((error, time));
        println!(
            "{rtol:>9.1e}{steps:>8}{iterations:>12}{factorizations:>9}{error:>10.1e}{:>10.2}",
            1e3 * time
        );
    }
    curves.push(radau_curve);
    println!("\nms at an error of, and part of diffsol's ESDIRK34");
    println!("{:<18}{:>16}{:>16}{:>16}", "method", "1e-2", "1e-3", "1e-4");
    let names = methods.iter().map(|m| m.0).chain(["(Radau IIA)"]);
    for (name, curve) in names.zip(&curves) {
        let cells = ACCURACIES.map(|a| match (cost(curve, a), cost(&curves[4], a)) {
            (Some(time), Some(peer)) => format!("{:.1} ({:.2})", 1e3 * time, time / peer),
            (Some(time), None) => format!("{:.1}", 1e3 * time),
            _ => "–".into(),
        });
        println!("{name:<18}{:>16}{:>16}{:>16}", cells[0], cells[1], cells[2]);
    }
}
