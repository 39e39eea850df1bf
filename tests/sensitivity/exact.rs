//! What holds to round-off.

use slcbeam::case::Case;
use slcbeam::case::parameter::{Parameter, STEPS, change};
use slcbeam::dae::{BeamDae, Dae, EvaluationError, PerturbedSystems, Seeds};
use slcbeam::discrete::{System, start};
use slcbeam::integrate::{AbsoluteTolerances, StartOptions, consistent_sensitivities, consistent_start};
use slcbeam::sparse::Pattern;
use slcbeam::sundials::Ida;
use slcbeam::sundials::IdaOptions;

use super::common::{beam, parse, wet};

/// The systems of a case with one number changed beside its own.
fn with_parameter(case: &Case, pointer: &str) -> BeamDae {
    let dae = BeamDae::new(System::new(case).unwrap());
    let parameter = Parameter::find(case, pointer).unwrap();
    let systems = STEPS.map(|(step, _)| {
        let changed = parameter
            .changed(case, parameter.value * (1.0 + step * change(case)))
            .unwrap();
        dae.system().like(&changed).unwrap().expect("the same unknowns")
    });
    let perturbed = PerturbedSystems::new(&dae, systems, change(case));
    dae.with_perturbed(vec![perturbed])
}

/// The volume of a closed network is kept whatever the viscosity: the sum of its areas' sensitivities stays zero, to the round-off
/// and Newton's tolerance of some hundred steps (1e-9 of the largest of them).
#[test]
fn closed_network_keeps_its_volume() {
    let case = parse(&wet(0.01), &[]);
    let mut dae = with_parameter(&case, "/fluid/viscosity_pa_s");
    let (system, now) = dae.instant(0.0);
    let layout = system.layout.clone();
    let chain: Vec<usize> = (0..2 * system.fluid.as_ref().unwrap().cells_per_bladder)
        .map(|i| layout.network.area.start + i)
        .collect();
    let mut y = start::state(system, &case, now);
    let mut yp = vec![0.0; y.len()];
    consistent_start(&mut dae, 0.0, &mut y, &mut yp, &StartOptions::default()).unwrap();
    let (mut s, mut sp) = (vec![vec![0.0; y.len()]], vec![vec![0.0; y.len()]]);
    consistent_sensitivities(&mut dae, 0.0, [&y, &yp], &mut s, &mut sp).unwrap();
    let options = IdaOptions {
        relative: 1e-6,
        absolute: AbsoluteTolerances::Same(1e-6),
        ..IdaOptions::default()
    };
    let mut ida = Ida::new(dae, 0.0, &y, &yp, &options).unwrap();
    ida.carry(&s, &sp, true).unwrap();
    let (mut largest, mut lost) = (0.0_f64, 0.0_f64);
    while !ida.step(0.01).unwrap().stopped {
        let t = ida.time();
        ida.sensitivity(0, t, [&mut s[0], &mut sp[0]]).unwrap();
        largest = chain.iter().fold(largest, |m, &i| m.max(s[0][i].abs()));
        lost = lost.max(chain.iter().map(|&i| s[0][i]).sum::<f64>().abs());
    }
    println!("{lost:e} of {largest:e}");
    assert!(largest > 1e-3 && lost < 1e-9 * largest, "{lost:e} of {largest:e}");
}

/// The beam without its own `tangent`.
struct Plain(BeamDae);

impl Dae for Plain {
    fn len(&self) -> usize {
        self.0.len()
    }
    fn differential(&self) -> &[bool] {
        self.0.differential()
    }
    fn pattern(&self) -> &Pattern {
        self.0.pattern()
    }
    fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], residual: &mut [f64]) -> Result<(), EvaluationError> {
        self.0.residual(t, y, yp, residual)
    }
    fn jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        seeds: Seeds<'_>,
        values: &mut [f64],
    ) -> Result<(), EvaluationError> {
        self.0.jacobian(t, y, yp, seeds, values)
    }
    fn name(&self, unknown: usize) -> String {
        self.0.name(unknown)
    }
}

/// `[E41]` `F_y s + F_y' s'` by dual numbers is what the Jacobian's columns add up to, for more directions than fit a sweep: exact
/// both, so to round-off of a sum (1e-12 of its largest term or so).
#[test]
fn tangent_is_the_jacobian_applied() {
    let dae = BeamDae::new(System::new(&parse(&wet(0.01), &[])).unwrap());
    let n = dae.len();
    let wave = |k: usize| -> Vec<f64> { (0..n).map(|i| ((i * (k + 2)) as f64).sin()).collect() };
    let (y, yp): (Vec<f64>, Vec<f64>) = (wave(50).iter().map(|y| 0.1 * y).collect(), wave(51));
    let (along, rates): (Vec<_>, Vec<_>) = ((0..11).map(wave).collect(), (20..31).map(wave).collect());
    let (along, rates): (Vec<&[f64]>, Vec<&[f64]>) = (
        along.iter().map(Vec::as_slice).collect(),
        rates.iter().map(Vec::as_slice).collect(),
    );
    let all = |dae: &mut dyn FnMut(&mut [&mut [f64]])| {
        let mut out = vec![vec![f64::NAN; n]; 11];
        dae(&mut out.iter_mut().map(Vec::as_mut_slice).collect::<Vec<_>>());
        out
    };
    let (mut own, mut plain) = (dae.clone(), Plain(dae));
    let swept = all(&mut |out| own.tangent(0.001, &y, &yp, [&along, &rates], out).unwrap());
    let summed = all(&mut |out| plain.tangent(0.001, &y, &yp, [&along, &rates], out).unwrap());
    for (a, b) in swept.iter().flatten().zip(summed.iter().flatten()) {
        assert!((a - b).abs() <= 1e-11 * (1.0 + a.abs().max(b.abs())), "{a} {b}");
    }
}

/// `[E40]` The difference formula: exact for p⁴, in error by 4 ε⁴ for 1/p; and the residual's slope by the modulus against its own
/// exact value, stiffness being proportional to it: `F(2 E) - F(E)` at the same unknowns and scales.
#[test]
fn difference_formula_is_of_fourth_order() {
    let case = parse(&wet(0.01), &[]);
    let mut dae = with_parameter(&case, "/beam/density_kg_m3");
    let slope = |dae: &mut BeamDae, f: fn(f64) -> f64| {
        let mut out = [0.0];
        let change = dae.perturbed_mut()[0].change();
        let done = dae.perturbed_mut()[0].derivative(&mut out, |j, _, out| {
            out[0] = f(1.0 + change * STEPS[j].0);
            Ok::<(), ()>(())
        });
        assert_eq!(done, Ok(()));
        out[0]
    };
    assert!((slope(&mut dae, |p| p.powi(4)) - 4.0).abs() < 1e-11);
    let error = slope(&mut dae, |p| 1.0 / p) + 1.0;
    assert!(error.abs() < 1e-11 && error.abs() > 1e-13, "{error:e}");

    // a dry beam without damping by time is linear in E, but for the damping, which is proportional to E as well
    let case = parse(&beam(0.01), &[]);
    let mut dae = with_parameter(&case, "/beam/young_modulus_pa");
    let double = parse(&beam(0.01), &["/beam/young_modulus_pa=4e6".into()]);
    let mut twice = BeamDae::new(dae.system().like(&double).unwrap().unwrap());
    let n = dae.len();
    let y: Vec<f64> = (0..n).map(|i| 0.1 * (i as f64).sin()).collect();
    let yp: Vec<f64> = (0..n).map(|i| (i as f64).cos()).collect();
    let (mut f, mut g, mut out) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    dae.residual(0.0, &y, &yp, &mut f).unwrap();
    twice.residual(0.0, &y, &yp, &mut g).unwrap();
    dae.parameter_derivative(0, 0.0, &y, &yp, &mut out).unwrap();
    let largest = f.iter().chain(&g).fold(0.0_f64, |m, x| m.max(x.abs()));
    for i in 0..n {
        assert!(
            (out[i] - (g[i] - f[i])).abs() < 1e-11 * largest,
            "{}: {} {}",
            dae.name(i),
            out[i],
            g[i] - f[i]
        );
    }
}
