//! Errors of a point: in time, in space, together.

use serde::Serialize;

use super::norms::Norms;
use super::reference::{Limit, Temporal};
use super::trial::Trial;

/// Relative errors of one signal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Errors {
    /// Against the best run on the same mesh.
    pub temporal: Option<Norms>,
    /// Of that run against the limit; the same for all points of a mesh. `None` with one mesh only.
    pub spatial: Option<Norms>,
    /// Against the limit.
    pub total: Norms,
    /// Whether the total is at least ten times the error of the limit itself, in the maximum norm.
    pub judged: bool,
}

/// How much better than a point its reference must be.
pub const BETTER: f64 = 10.0;

/// Errors of every signal of a finished run.
pub fn errors(trial: &Trial, meshes: &[Temporal], limits: &[Limit]) -> Option<Vec<Errors>> {
    let signals = trial.signals.as_ref()?;
    let mesh = meshes.iter().find(|m| m.cells == trial.setting.cells);
    let one = |(k, limit): (usize, &Limit)| {
        let values = &signals[k].values;
        let temporal = mesh.map(|m| {
            let itself = m.order == trial.setting.order && m.rtol == trial.setting.rtol;
            if itself { m.own[k] } else { Norms::between(values, &m.values[k]).over(limit.size) }
        });
        let spatial = mesh
            .filter(|_| meshes.len() > 1)
            .map(|m| Norms::between(&m.values[k], &limit.values).over(limit.size));
        // The finest mesh has no distance to a limit that is itself; what is believed of the limit counts then.
        let spatial = spatial.map(|s| match limit.own_spatial {
            Some(own) if limit.extrapolated_with.is_none() => s.or_larger(own),
            _ => s,
        });
        let distance = Norms::between(values, &limit.values).over(limit.size);
        let total = if limit.extrapolated_with.is_none() && meshes.len() > 1 {
            distance.or_larger(limit.own_spatial.unwrap_or_default())
        } else {
            distance
        };
        let judged = total.max >= BETTER * limit.own().max;
        // A run that is its own reference has at least the error that is believed of it.
        let total = total.or_larger(mesh.filter(|_| temporal == mesh.map(|m| m.own[k])).map_or(total, |m| m.own[k]));
        Errors { temporal, spatial, total, judged }
    };
    Some(limits.iter().enumerate().map(one).collect())
}
