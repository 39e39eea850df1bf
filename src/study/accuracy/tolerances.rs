//! Runs of one mesh and scheme over tolerances, and the error of the tightest run.

use super::norms::Norms;
use super::scheme::Scheme;
use super::trial::StudyTrial;

/// Finished runs of one line, loose to tight.
#[derive(Clone, Debug)]
pub struct ToleranceSequence<'a> {
    /// Time integration.
    pub scheme: Scheme,
    /// Runs.
    pub runs: Vec<&'a StudyTrial>,
}

impl<'a> ToleranceSequence<'a> {
    /// Collects the runs of a mesh and a scheme.
    pub fn select(trials: &'a [StudyTrial], cells: usize, scheme: Scheme) -> Self {
        let mut runs: Vec<&StudyTrial> = trials
            .iter()
            .filter(|t| t.finished() && t.line() == (cells, scheme))
            .collect();
        runs.sort_by(|a, b| b.setting.rtol.total_cmp(&a.setting.rtol));
        Self { scheme, runs }
    }

    /// Tightest run.
    pub fn last(&self) -> Option<&'a StudyTrial> {
        self.runs.last().copied()
    }

    /// Values of a signal in the run `back` places before the last, and the tolerance of that run.
    fn values(&self, back: usize, signal: usize) -> Option<(&'a [f64], f64)> {
        let run = self.runs.get(self.runs.len().checked_sub(back + 1)?)?;
        let signal = run.signals.as_ref()?.get(signal)?;
        Some((&signal.values, run.setting.rtol))
    }

    /// Estimates the error of the last run in one signal: `d/(r^n - 1)`. `d` is the distance to the run before it, `n`
    /// the decades of tolerance between the two, `r` the gain of a decade.
    ///
    /// `r` is measured with the runs before, at most `10^(p/(p+1))` of order `p` and at least 1.3: a sequence that does
    /// not converge has a large error.
    pub fn last_error(&self, signal: usize) -> Option<Norms> {
        let (x0, t0) = self.values(0, signal)?;
        let (x1, t1) = self.values(1, signal)?;
        let d0 = Norms::between(x0, x1);
        let order = f64::from(self.scheme.order);
        let best = 10_f64.powf(order / (order + 1.0));
        let gain = self.values(2, signal).map_or(2.0, |(x2, t2)| {
            let d1 = Norms::between(x1, x2);
            (d1.l2 / d0.l2).powf(1.0 / (t2 / t1).log10())
        });
        let gain = if gain.is_nan() { 2.0 } else { gain.clamp(1.3, best) };
        let ahead = gain.powf((t1 / t0).log10()) - 1.0;
        Some(d0.map(|d| d / ahead))
    }
}
