//! Runs of one mesh and scheme over tolerances: what their sequence says of the error of the last.

use super::norms::Norms;
use super::scheme::Scheme;
use super::trial::Trial;

/// Finished runs of one line, loose to tight.
#[derive(Clone, Debug)]
pub struct ToleranceSequence<'a> {
    /// How time is integrated.
    pub scheme: Scheme,
    /// Runs.
    pub runs: Vec<&'a Trial>,
}

impl<'a> ToleranceSequence<'a> {
    /// Of a mesh and a scheme.
    pub fn of(trials: &'a [Trial], cells: usize, scheme: Scheme) -> Self {
        let mut runs: Vec<&Trial> = trials
            .iter()
            .filter(|t| t.finished() && t.line() == (cells, scheme))
            .collect();
        runs.sort_by(|a, b| b.setting.rtol.total_cmp(&a.setting.rtol));
        Self { scheme, runs }
    }

    /// Tightest run.
    pub fn last(&self) -> Option<&'a Trial> {
        self.runs.last().copied()
    }

    /// Values of a signal in the run `back` places before the last.
    fn values(&self, back: usize, signal: usize) -> Option<(&'a [f64], f64)> {
        let run = self.runs.get(self.runs.len().checked_sub(back + 1)?)?;
        let signal = run.signals.as_ref()?.get(signal)?;
        Some((&signal.values, run.setting.rtol))
    }

    /// Error of the last run in one signal: `d/(r^n - 1)`, `d` the distance to the run before it, `n` decades of tolerance
    /// away, `r` the factor that a decade gains.
    ///
    /// `r` is what the runs before gained, at most the `10^(p/(p+1))` of order `p` and at least 1.3: a sequence that does
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
