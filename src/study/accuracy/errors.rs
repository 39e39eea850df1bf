//! Errors of a point: temporal, spatial and total.

use serde::{Deserialize, Serialize};

use super::norms::Norms;
use super::reference::{BestOnMesh, MeshLimit};
use super::trial::StudyTrial;

/// Relative errors of one signal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SignalErrors {
    /// Temporal error: difference from the best run on the same mesh. For that run itself, its own estimated error.
    pub temporal: Option<Norms>,
    /// Spatial error: difference of the best run on the mesh from the limit. Equal for all points of a mesh; `None`
    /// with one mesh only.
    pub spatial: Option<Norms>,
    /// Total error: difference from the limit.
    pub total: Norms,
    /// Error bound: total error plus the error of the limit itself. At least the temporal and the spatial error, which
    /// may cancel each other in the total.
    pub bound: Norms,
    /// True if the total error is at least ten times the error of the limit itself, in the maximum norm.
    pub judged: bool,
}

/// Least ratio of the total error of a judged point to the error of the limit itself.
pub const BETTER: f64 = 10.0;

/// Computes the errors of every signal of a finished run.
pub fn errors(trial: &StudyTrial, meshes: &[BestOnMesh], limits: &[MeshLimit]) -> Option<Vec<SignalErrors>> {
    let signals = trial.signals.as_ref()?;
    let mesh = meshes.iter().find(|m| m.cells == trial.setting.cells);
    let one = |(k, limit): (usize, &MeshLimit)| {
        let values = &signals[k].values;
        let own = limit.own();
        // Without extrapolation the finest mesh replaces the limit. No error is then below the spatial error of that
        // mesh.
        let least = match limit.extrapolated_with {
            None => limit.own_spatial.unwrap_or_default(),
            Some(_) => Norms::default(),
        };
        let itself = mesh.filter(|m| m.scheme == trial.setting.scheme && m.rtol == trial.setting.rtol);
        let temporal = match (itself, mesh) {
            (Some(m), _) => Some(m.own[k]),
            (None, Some(m)) => Some(Norms::between(values, &m.values[k]).over(limit.size)),
            (None, None) => None,
        };
        let spatial = mesh.filter(|_| meshes.len() > 1).map(|m| {
            Norms::between(&m.values[k], &limit.values)
                .over(limit.size)
                .or_larger(least)
        });
        let total = Norms::between(values, &limit.values).over(limit.size).or_larger(least);
        let total = itself.map_or(total, |m| total.or_larger(m.own[k]));
        let parts = temporal.unwrap_or_default().or_larger(spatial.unwrap_or_default());
        let bound = total.with(own, |t, o| t + o).or_larger(parts);
        SignalErrors {
            temporal,
            spatial,
            total,
            bound,
            judged: total.max >= BETTER * own.max,
        }
    };
    Some(limits.iter().enumerate().map(one).collect())
}
