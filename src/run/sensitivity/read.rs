//! Derivatives read from the sensitivities within a step: of the history at output times, and of values at which they are largest.

use super::forward::ForwardSensitivities;
use crate::dae::BeamDae;
use crate::discrete::ledger;
use crate::discrete::quantities::{Extremes, Observable, ObservableRow, QuantitySource, StateView, probes, stations};
use crate::integrate::IntegrationError;
use crate::sundials::Ida;

/// Functions that read a number from a state.
type Reads = Vec<fn(&StateView) -> f64>;

impl ForwardSensitivities<'_> {
    /// Reads sensitivities from the integrator at time `t` [s] within its last step, and those of integrals into `integrals`.
    pub(super) fn read(
        &mut self,
        ida: &mut Ida<BeamDae>,
        t: f64,
        integrals: &mut [Vec<f64>],
    ) -> std::result::Result<(), Box<IntegrationError>> {
        for (k, integrals) in integrals.iter_mut().enumerate() {
            ida.sensitivity(k, t, [&mut self.s[k], &mut self.sp[k]])?;
            ida.integral_sensitivity(k, t, integrals)?;
            for (total, carried) in integrals.iter_mut().zip(&self.carried[k]) {
                *total += carried;
            }
        }
        Ok(())
    }

    /// Adds a sample at a state within the last step, whose row of the history is `row`. Returns the row of derivatives.
    pub fn sample(
        &mut self,
        ida: &mut Ida<BeamDae>,
        t: f64,
        state: [&[f64]; 2],
        row: &ObservableRow,
    ) -> std::result::Result<&[f64], Box<IntegrationError>> {
        self.derive(ida, t, state)?;
        if self.states_only {
            return Ok(&self.row);
        }
        let (columns, each, behind) = (&self.columns, self.each(), self.before_probes());
        for (figures, derivatives) in self.figures.iter_mut().zip(parts(&self.row, each)) {
            let probed = derivatives[behind..].iter().zip(row.at_probes());
            figures.take_probes(t, probed.map(|(slope, value)| [*value, *slope]));
            figures.take(t, |which| {
                let i = columns.iter().position(|one| *one == which)?;
                Some([row.get(which)?, derivatives[i]])
            });
        }
        Ok(&self.row)
    }

    /// Records a state within the last step at which a value is larger than before. The derivative there is that of the largest value:
    /// at an extremum, a shift of its time has no effect.
    pub fn see(
        &mut self,
        ida: &mut Ida<BeamDae>,
        t: f64,
        state: [&[f64]; 2],
    ) -> std::result::Result<(), Box<IntegrationError>> {
        if self.states_only {
            return Ok(());
        }
        self.derive(ida, t, state)?;
        let reads = self.reads();
        let (system, now, w) = ida.dae_mut().evaluate(t, state[0], state[1]);
        let look = StateView::new(system, now, w, ledger::energies(system, now, w));
        let own: Vec<f64> = reads.iter().map(|read| read(&look)).collect();
        let probed: Vec<f64> = probes::values(&look).collect();
        let (columns, each, behind) = (&self.columns, self.each(), self.before_probes());
        let read_off = |one: &&Observable| matches!(one.read(), QuantitySource::State(_));
        for (figures, derivatives) in self.figures.iter_mut().zip(parts(&self.row, each)) {
            let value = |which| {
                let k = columns.iter().filter(read_off).position(|one| *one == which)?;
                Some([own[k], derivatives[columns.iter().position(|one| *one == which)?]])
            };
            let slopes = &derivatives[behind..];
            figures.see(
                t,
                value,
                probed.iter().zip(slopes).map(|(value, slope)| [*value, *slope]),
            );
        }
        Ok(())
    }

    /// Number of derivatives by one number in a row.
    fn each(&self) -> usize {
        self.before_probes() + self.probes.len()
    }

    fn before_probes(&self) -> usize {
        self.columns.len() + self.stations.len()
    }

    fn reads(&self) -> Reads {
        let reads = self.columns.iter().filter_map(|one| match one.read() {
            QuantitySource::State(read) => Some(read),
            _ => None,
        });
        reads.collect()
    }

    /// Fills the row of derivatives at a state within the last step: its time, then for each number those of the columns and at probes.
    fn derive(
        &mut self,
        ida: &mut Ida<BeamDae>,
        t: f64,
        [y, yp]: [&[f64]; 2],
    ) -> std::result::Result<(), Box<IntegrationError>> {
        let mut integrals = self.carried.clone();
        self.read(ida, t, &mut integrals)?;
        let dae = ida.dae_mut();
        let (system, now, w) = dae.evaluate(t, y, yp);
        let at = Extremes::new(system, now, &w);
        let reads = self.reads();
        self.row.clear();
        self.row.push(t);
        let mut slopes = vec![0.0; reads.len() + self.stations.len() + self.probes.len()];
        for (k, (parameter, integrals)) in self.parameters.iter().zip(&integrals).enumerate() {
            dae.read_slope(
                k,
                t,
                [y, yp],
                [&self.s[k], &self.sp[k]],
                &mut slopes,
                |system, now, rates, w, out| {
                    let w = ledger::complete(system, now, rates, w);
                    let stored = ledger::energies(system, now, w);
                    let look = StateView {
                        system,
                        now,
                        w,
                        stored,
                        at,
                    };
                    let (own, rest) = out.split_at_mut(reads.len());
                    let (at_stations, probed) = rest.split_at_mut(self.stations.len());
                    own.iter_mut().zip(&reads).for_each(|(out, read)| *out = read(&look));
                    // integrals are set below
                    stations::values(&look, Some(&[]), at_stations);
                    let values = probes::values(&look);
                    probed.iter_mut().zip(values).for_each(|(out, value)| *out = value);
                },
            );
            let mut slopes = slopes.iter().copied();
            let of = |one: &Observable| match one.read() {
                QuantitySource::Integral(of) => of(integrals),
                QuantitySource::Through(of) => of(dae.system(), integrals),
                _ => slopes.next().unwrap_or(0.0),
            };
            let derivatives = self.columns.iter().map(of).map(|slope| slope / parameter.value);
            self.row.extend(derivatives);
            let sums = self
                .integrated
                .iter()
                .map(Vec::as_slice)
                .chain(std::iter::repeat(&[][..]));
            let behind = slopes.zip(sums).map(|(slope, sum)| match sum {
                [] => slope,
                sum => sum.iter().map(|one| integrals[*one]).sum(),
            });
            self.row.extend(behind.map(|slope| slope / parameter.value));
        }
        Ok(())
    }
}

/// Splits a row of derivatives into the parts of each number.
fn parts(row: &[f64], each: usize) -> std::slice::ChunksExact<'_, f64> {
    row[1..].chunks_exact(each.max(1))
}
