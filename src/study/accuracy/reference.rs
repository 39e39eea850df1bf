//! References of points: the best run on each mesh, and the limit of vanishing mesh size.

use serde::{Deserialize, Serialize};

use super::norms::Norms;
use super::scheme::Scheme;
use super::signals::{ComparedSignal, SignalKind};
use super::tolerances::ToleranceSequence;
use super::trial::StudyTrial;
use crate::run::json_null;

/// The best run on a mesh.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct BestOnMesh {
    /// Beam cells per segment.
    pub cells: usize,
    /// Time integration of the run.
    pub scheme: Scheme,
    /// Its tolerance.
    pub rtol: f64,
    /// Its wall time [s].
    #[serde(deserialize_with = "json_null::number")]
    pub wall_s: f64,
    /// Scheme and tolerance of the run that checks it.
    pub checked_by: Option<(Scheme, f64)>,
    /// Estimated error of each signal from the run's own sequence of tolerances, relative.
    pub by_tolerance: Vec<Option<Norms>>,
    /// Distance of each signal from the checking run, relative.
    pub by_order: Vec<Option<Norms>>,
    /// Accepted error of each signal, relative: combines the two estimates above.
    pub own: Vec<Norms>,
    /// Values.
    #[serde(skip)]
    pub values: Vec<Vec<f64>>,
}

/// Largest distance from the checking run that the errors of both explain, in multiples of their sum.
const DISAGREE: f64 = 3.0;

/// Largest ratio of the tolerance of the checking run to that of the reference.
const LOOSER: f64 = 1e4;

/// Returns the best run on a mesh; `None` if none finished. `sizes` are the sizes of the signals; `headline` is the
/// signal by which runs are ranked.
pub fn temporal(
    trials: &[StudyTrial],
    cells: usize,
    schemes: &[Scheme],
    sizes: &[Norms],
    headline: usize,
) -> Option<BestOnMesh> {
    let mut sequences: Vec<(f64, ToleranceSequence)> = schemes
        .iter()
        .map(|&scheme| ToleranceSequence::select(trials, cells, scheme))
        .filter(|sequence| !sequence.runs.is_empty())
        .map(|sequence| (sequence.last_error(headline).map_or(f64::INFINITY, |e| e.max), sequence))
        .collect();
    sequences.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut sequences = sequences.into_iter().map(|(_, sequence)| sequence);
    let main = sequences.next()?;
    let best = main.last()?;
    let signals = best.signals.as_ref()?;
    // A much looser run is no check.
    let sharp = |sequence: &ToleranceSequence| {
        sequence
            .last()
            .is_some_and(|t| t.setting.rtol <= LOOSER * best.setting.rtol)
    };
    let check = sequences.find(sharp);
    let checking = check.as_ref().and_then(ToleranceSequence::last);
    let relative = |norms: Option<Norms>, k: usize| norms.map(|n| n.over(sizes[k]));
    let by_tolerance: Vec<_> = (0..signals.len()).map(|k| relative(main.last_error(k), k)).collect();
    let by_order: Vec<_> = (0..signals.len())
        .map(|k| {
            let other = checking?.signals.as_ref()?.get(k)?;
            relative(Some(Norms::between(&signals[k].values, &other.values)), k)
        })
        .collect();
    let own = (0..signals.len())
        .map(|k| {
            let expected = check.as_ref().and_then(|c| relative(c.last_error(k), k));
            believed(by_tolerance[k], by_order[k], expected)
        })
        .collect();
    Some(BestOnMesh {
        cells,
        scheme: best.setting.scheme,
        rtol: best.setting.rtol,
        wall_s: best.wall_min_s,
        checked_by: checking.map(|t| (t.setting.scheme, t.setting.rtol)),
        by_tolerance,
        by_order,
        own,
        values: signals.iter().map(|s| s.values.clone()).collect(),
    })
}

/// Combines the two error estimates of a reference; `expected` is the own error of the checking run.
///
/// If the errors of both runs explain their distance, the smaller of two bounds applies: the error by the reference's
/// own tolerances, or the distance plus the error of the checking run. Otherwise the larger estimate applies.
fn believed(by_tolerance: Option<Norms>, by_order: Option<Norms>, expected: Option<Norms>) -> Norms {
    match (by_tolerance, by_order) {
        (Some(t), Some(o)) => {
            let expected = expected.unwrap_or(o);
            let one = |t: f64, o: f64, e: f64| {
                if o <= DISAGREE * (e + t) {
                    t.min(o + e)
                } else {
                    t.max(o)
                }
            };
            Norms {
                l2: one(t.l2, o.l2, expected.l2),
                max: one(t.max, o.max, expected.max),
            }
        }
        (Some(one), None) | (None, Some(one)) => one,
        (None, None) => Norms::both(f64::INFINITY),
    }
}

/// One signal in the limit of vanishing mesh size.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct MeshLimit {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Kind.
    pub kind: SignalKind,
    /// Size to which errors refer.
    pub size: Norms,
    /// Order of convergence in the mesh size, from the three finest meshes.
    pub order: Option<f64>,
    /// True if temporal errors are below a tenth of the differences from which the order is computed.
    pub order_is_clean: bool,
    /// Exponent of the Richardson extrapolation; `None` if the finest mesh replaces the limit.
    pub extrapolated_with: Option<f64>,
    /// Error of the limit due to the meshes, relative.
    pub own_spatial: Option<Norms>,
    /// Error of the limit due to the temporal errors of the references, relative.
    pub own_temporal: Norms,
    /// Values.
    #[serde(skip)]
    pub values: Vec<f64>,
}

impl MeshLimit {
    /// Error of the limit, relative.
    pub fn own(&self) -> Norms {
        self.own_temporal
            .with(self.own_spatial.unwrap_or_default(), |a, b| a + b)
    }
}

/// Computes the limit of signal `k` from the references of the meshes, coarse to fine; `None` without references.
pub fn limit(meshes: &[BestOnMesh], signal: &ComparedSignal, k: usize, size: Norms) -> Option<MeshLimit> {
    let finest = meshes.last()?;
    let mut limit = MeshLimit {
        name: signal.name.clone(),
        unit: signal.unit.clone(),
        kind: signal.kind,
        size,
        order: None,
        order_is_clean: false,
        extrapolated_with: None,
        own_spatial: None,
        own_temporal: finest.own[k],
        values: finest.values[k].clone(),
    };
    let [.., coarse, fine] = meshes else { return Some(limit) };
    let between = |a: &BestOnMesh, b: &BestOnMesh| Norms::between(&a.values[k], &b.values[k]).over(size);
    let ratio = fine.cells as f64 / coarse.cells as f64;
    let near = between(fine, coarse);
    // With two meshes the order is unknown; first order is the cautious assumption.
    limit.own_spatial = Some(near.map(|d| d / (ratio - 1.0).min(1.0)));
    let [.., coarsest, _, _] = meshes else {
        return Some(limit);
    };
    let ratio_before = coarse.cells as f64 / coarsest.cells as f64;
    if (ratio - ratio_before).abs() > 1e-9 {
        return Some(limit);
    }
    let far = between(coarse, coarsest);
    let order = (far.l2 / near.l2).ln() / ratio.ln();
    if !order.is_finite() {
        return Some(limit);
    }
    limit.order = Some(order);
    let noise = fine.own[k].l2 + coarse.own[k].l2;
    limit.order_is_clean = noise <= 0.1 * near.l2 && coarse.own[k].l2 + coarsest.own[k].l2 <= 0.1 * far.l2;
    let exponent = match order {
        // Nominal order of the scheme.
        1.5..2.6 => 2.0,
        0.8..1.5 => order,
        _ => return Some(limit),
    };
    let gain = ratio.powf(exponent) - 1.0;
    let extrapolate = |fine: &[f64], coarse: &[f64]| -> Vec<f64> {
        fine.iter().zip(coarse).map(|(f, c)| f + (f - c) / gain).collect()
    };
    limit.values = extrapolate(&fine.values[k], &coarse.values[k]);
    let before = extrapolate(&coarse.values[k], &coarsest.values[k]);
    // Factor by which the error falls from one limit to the next: 4, or the measured factor if there is a fourth mesh,
    // from 2 to 8 (third order).
    let apart = Norms::between(&limit.values, &before);
    let falls = match meshes {
        [.., first, _, _, _] if (coarsest.cells as f64 / first.cells as f64 - ratio).abs() < 1e-9 => {
            let earlier = extrapolate(&coarsest.values[k], &first.values[k]);
            (Norms::between(&before, &earlier).l2 / apart.l2).clamp(2.0, 8.0)
        }
        _ => 4.0,
    };
    let falls = if falls.is_nan() { 4.0 } else { falls };
    let left = apart.over(size).map(|d| d / (falls - 1.0));
    // A fitted exponent makes the limits agree by construction. Half the distance to the limit is then the cautious
    // estimate.
    let way = Norms::between(&limit.values, &fine.values[k])
        .over(size)
        .map(|d| 0.5 * d);
    limit.own_spatial = Some(if exponent == 2.0 { left } else { left.or_larger(way) });
    limit.own_temporal = fine.own[k].with(coarse.own[k], |f, c| ((gain + 1.0) * f + c) / gain);
    limit.extrapolated_with = Some(exponent);
    Some(limit)
}
