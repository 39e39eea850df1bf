//! Projection of interpolated states onto the volumes of lumped networks.

use super::BeamDae;
use crate::discrete::{ledger, residual};
use crate::model::Wet;

/// Newton steps that reduce the error of an interpolated pressure to rounding error.
const CORRECTIONS: usize = 3;

impl BeamDae {
    /// Sets the pressures of lumped networks in a scaled state at `t` [s] to those of their volumes, [E25]. If fluid is compressible or
    /// walls touch, interpolated pressures do not belong to those volumes. At the end of a step, their error is within the tolerance of
    /// Newton's iteration.
    pub fn keep_volumes(&mut self, t: f64, y: &mut [f64]) {
        let bent = |wet: &Wet| !wet.lumped.is_empty() && (wet.compression.is_some() || wet.closing.is_some());
        if !self.system().model.wet.as_ref().is_some_and(bent) {
            return;
        }
        let at_rest = vec![0.0; y.len()];
        let mut lacks = at_rest.clone();
        for _ in 0..CORRECTIONS {
            let scales = &self.system().layout.scales;
            let unscaled: Vec<f64> = y.iter().zip(scales).map(|(y, scale)| y * scale).collect();
            let scaled = y.to_vec();
            self.visit(t, &scaled, &at_rest, |system, now, rates, w| {
                residual::rows::lumped(system, now, &unscaled, rates, w, &mut lacks);
                for (unknown, slope) in ledger::lumped_slopes(system, w) {
                    y[unknown] -= lacks[unknown] / (slope * system.layout.scales[unknown]);
                }
            });
        }
    }
}
