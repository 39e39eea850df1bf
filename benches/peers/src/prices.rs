//! Cost of single operations.

use std::time::Instant;

use serde_json::{Value, json};
use slcbeam::dae::{Dae, Seeds};
use slcbeam::sparse::Lu;

use crate::scene::{Bare, Scene};

/// Names of the operations, in their order of dependence.
pub const OPERATIONS: [&str; 4] = ["residual", "jacobian", "factor", "solve"];

/// Workspace of the operations.
pub struct Bench<'a> {
    scene: &'a Scene,
    dae: Bare,
    lu: Lu,
    values: Vec<f64>,
    r: Vec<f64>,
}

impl<'a> Bench<'a> {
    pub fn new(scene: &'a Scene) -> Self {
        let mut dae = scene.dae();
        let n = scene.y.len();
        let mut values = vec![0.0; dae.pattern().entries()];
        let mut lu = Lu::new(dae.pattern()).expect("factors");
        let seeds = Seeds::Step { cj: 1e3 };
        dae.jacobian(0.0, &scene.y, &scene.yp, seeds, &mut values)
            .expect("a Jacobian");
        lu.factor(&values).expect("factors");
        Self {
            scene,
            dae,
            lu,
            values,
            r: vec![0.0; n],
        }
    }

    /// Executes one of [`OPERATIONS`] `count` times.
    pub fn work(&mut self, what: &str, count: usize) {
        let Self {
            scene,
            dae,
            lu,
            values,
            r,
        } = self;
        let (y, yp) = (&scene.y[..], &scene.yp[..]);
        match what {
            "residual" => (0..count).for_each(|_| dae.residual(0.0, y, yp, r).expect("a residual")),
            "jacobian" => (0..count).for_each(|_| {
                dae.jacobian(0.0, y, yp, Seeds::Step { cj: 1e3 }, values)
                    .expect("a Jacobian");
            }),
            "factor" => (0..count).for_each(|_| lu.factor(values).expect("factors")),
            "solve" => (0..count).for_each(|_| {
                r.fill(1.0);
                assert!(lu.solve(r));
            }),
            other => panic!("no operation {other}"),
        }
    }

    /// Seconds of one operation: the median of nine batches, each of 10 ms or of one operation.
    pub fn price(&mut self, what: &str) -> f64 {
        let once = {
            let begin = Instant::now();
            self.work(what, 1);
            begin.elapsed().as_secs_f64()
        };
        let count = ((1e-2 / once) as usize).clamp(1, 10_000);
        let mut batches: Vec<f64> = (0..9)
            .map(|_| {
                let begin = Instant::now();
                self.work(what, count);
                begin.elapsed().as_secs_f64() / count as f64
            })
            .collect();
        batches.sort_by(f64::total_cmp);
        batches[4]
    }

    /// Bytes of the factors that one linear solution reads.
    pub fn factor_bytes(&self) -> usize {
        self.lu.bytes()
    }

    /// Seconds of each of [`OPERATIONS`].
    pub fn prices(&mut self) -> [f64; 4] {
        OPERATIONS.map(|what| self.price(what))
    }
}

/// Prices of a scene, in seconds.
pub fn table(scene: &Scene) -> Value {
    let mut bench = Bench::new(scene);
    let [residual, jacobian, factor, solve] = bench.prices();
    json!({
        "unknowns": scene.y.len(), "entries": bench.values.len(),
        "residual": residual, "jacobian": jacobian, "factor": factor, "solve": solve,
    })
}
