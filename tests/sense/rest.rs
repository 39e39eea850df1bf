//! Loads at rest.

use nalgebra::DVector;
use slcbeam::run::equilibrium::EquilibriumOptions;
use slcbeam::study::sense::basis::{self, Basis};
use slcbeam::study::sense::estimate::ForwardModel as _;
use slcbeam::study::sense::pressures_at_rest::{AtRest, probed};

use crate::common::sensor;

#[test]
fn derivatives_are_those_of_differences() {
    let loads = [
        Basis::TipForce,
        Basis::TipMoment,
        Basis::Uniform,
        Basis::TipAxial,
        Basis::Point(0.6),
    ];
    let case = sensor(&[]);
    let amplitudes = basis::amplitudes(&case, &loads).unwrap();
    let (probed, names) = probed(&case).unwrap();
    let options = EquilibriumOptions::at(case.time.end_s);
    let mut model = AtRest::new(&probed, &names, &amplitudes, &options).unwrap();
    // a force across on the tip presses the upper bladders and draws at the lower ones
    let (pressed, _) = model.at(&[0.1, 0.0, 0.0, 0.0, 0.0]).unwrap();
    assert!(
        pressed[0] > 0.0 && pressed[10] < 0.0 && (pressed[0] / pressed[10] + 1.0).abs() < 0.05,
        "{pressed}"
    );
    let at = [0.3, 0.1, 0.2, 0.1, 0.1];
    let (values, jacobian) = model.at(&at).unwrap();
    let (followed, _) = model.followed(&at).unwrap();
    assert!((followed - &values).norm() < 1e-9 * values.norm());
    for k in 0..at.len() {
        let moved = |d: f64| -> DVector<f64> {
            let mut there = at;
            there[k] += d;
            model.clone().go(&there).unwrap()
        };
        let difference = (moved(1e-3) - moved(-1e-3)) * (8.0 / 12e-3) - (moved(2e-3) - moved(-2e-3)) / 12e-3;
        let off = (&difference - jacobian.column(k)).norm();
        assert!(off < 1e-7 * difference.norm(), "{k}: {off} of {}", difference.norm());
    }
}
