//! Lower bounds of the response to loads, for use in denominators.
//!
//! Model: the linear drained beam at rest, under the loads at the instants of each signal's maximum. A beam departs
//! from its static response by at most a fraction `h`. Sealed bladders and tension (as a fraction of the buckling load)
//! stiffen it. Its response is at least `(1 - h)/(1 + stiffening)` of the static one.
//!
//! The bound is zero if ends are moved, loads are couples along the beam, the departure `h` is 0.5 or more, or a load
//! is too narrow for the quadrature.

use nalgebra::{DMatrix, DVector};

use super::EffectScene;
use crate::case::{Rotation, Translation};
use crate::functions::Signal;
use crate::model::loads::LoadKind;

const ELEMENTS: usize = 32;
/// Largest number of instants.
const INSTANTS: usize = 12;
/// Gauss points and weights in [0, 1].
const GAUSS: [(f64, f64); 3] = [
    (0.112_701_665_379_258_3, 5.0 / 18.0),
    (0.5, 4.0 / 9.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];
/// Safety factor; discretization errors are far smaller than its margin.
const MARGIN: f64 = 0.9;

/// Lower bounds of the largest magnitudes over the run.
#[derive(Clone, Copy, Debug, Default)]
pub struct ResponseBounds {
    /// Shortening by bending, `∫ φ²/2` [m].
    pub drawn_in: f64,
    /// Bending moment [N m].
    pub moment: f64,
    /// Stretch of the whole beam [m].
    pub stretch: f64,
    /// Normal force [N].
    pub force: f64,
}

/// Static response to a unit signal: deflections and slopes at nodes, normal forces in elements.
struct Unit<'a> {
    signal: &'a Signal,
    across: DVector<f64>,
    along: [f64; ELEMENTS],
}

impl ResponseBounds {
    /// Lower bounds for a scene.
    pub fn from_scene(scene: &EffectScene) -> Self {
        let (across, along) = (Self::across(scene), Self::along(scene));
        let (h, w) = (scene.bending_inertia(), scene.axial_waves());
        let follows = |departure: f64| if departure < 0.5 { 1.0 - departure } else { 0.0 };
        let [bending, stretching] = scene.stiffenings();
        let (across_part, along_part) = (
            MARGIN * follows(h) / (1.0 + bending + scene.normal_force()),
            MARGIN * follows(w) / (1.0 + stretching),
        );
        Self {
            drawn_in: across[0] * across_part * across_part,
            moment: across[1] * across_part,
            stretch: along[0] * along_part,
            force: along[1] * along_part,
        }
    }

    /// Shortening by bending, and moment.
    fn across(scene: &EffectScene) -> [f64; 2] {
        let still = scene.ends.iter().all(|e| {
            let across = matches!(&e.transverse, Translation::Displacement(s) if !s.is_zero());
            let turned = matches!(&e.rotation, Rotation::Slope(s) if !s.is_zero());
            !across && !turned && e.follower.is_none()
        });
        let couples = |kind| matches!(kind, LoadKind::MomentX | LoadKind::MomentZ);
        if !still
            || scene
                .loads
                .iter()
                .any(|load| couples(load.kind) && !load.signal.is_zero())
        {
            return [0.0; 2];
        }
        let Some(units) = bent(scene) else { return [0.0; 2] };
        let h = scene.case.beam.length_m / ELEMENTS as f64;
        most(scene, &units, |sum: &[f64], k| {
            let sum: Vec<f64> = (0..2 * ELEMENTS + 2)
                .map(|i| units.iter().zip(sum).map(|(unit, s)| s * unit.across[i]).sum())
                .collect();
            let slope = |i: usize| sum[2 * i + 1];
            match k {
                0 => {
                    (0..ELEMENTS)
                        .map(|i| 0.25 * h * (slope(i).powi(2).min(slope(i + 1).powi(2))))
                        .sum::<f64>()
                        * 2.0
                }
                _ => {
                    let bend = (0..ELEMENTS)
                        .map(|i| ((slope(i + 1) - slope(i)) / h).abs())
                        .fold(0.0, f64::max);
                    bend * scene.section.bending_stiffness
                }
            }
        })
    }

    /// Stretch and normal force.
    fn along(scene: &EffectScene) -> [f64; 2] {
        let held: Vec<bool> = scene
            .ends
            .iter()
            .map(|e| matches!(&e.axial, Translation::Displacement(s) if s.is_zero()))
            .collect();
        if held[0] == held[1] || scene.ends.iter().any(|e| e.follower.is_some()) {
            return [0.0; 2];
        }
        let driven = |e: &crate::case::ResolvedEnd| matches!(&e.axial, Translation::Displacement(s) if !s.is_zero());
        if scene.ends.iter().any(driven) {
            return [0.0; 2];
        }
        let Some(units) = stretched(scene, held[0]) else {
            return [0.0; 2];
        };
        let h = scene.case.beam.length_m / ELEMENTS as f64;
        most(scene, &units, |sum: &[f64], k| {
            let force = |i: usize| units.iter().zip(sum).map(|(unit, s)| s * unit.along[i]).sum::<f64>();
            match k {
                0 => (0..ELEMENTS).map(force).sum::<f64>().abs() * h / scene.section.axial_stiffness,
                _ => (0..ELEMENTS).map(|i| force(i).abs()).fold(0.0, f64::max),
            }
        })
    }
}

/// Largest values of two measures over the instants at which a signal has its maximum.
fn most(scene: &EffectScene, units: &[Unit], measure: impl Fn(&[f64], usize) -> f64) -> [f64; 2] {
    let end = scene.case.time.end_s;
    let mut found = [0.0_f64; 2];
    for at in units.iter().take(INSTANTS).map(|unit| unit.signal.peak(end)) {
        let now: Vec<f64> = units.iter().map(|unit| unit.signal.value(at)).collect();
        for (k, most) in found.iter_mut().enumerate() {
            let value = measure(&now, k);
            *most = if value.is_finite() { most.max(value) } else { 0.0 };
        }
    }
    found
}

/// Nodal forces and moments of a profile on each element; none where the profile is too narrow for the quadrature.
fn forces(profile: &crate::functions::Profile, length: f64) -> Option<Vec<[f64; 4]>> {
    let h = 1.0 / ELEMENTS as f64;
    let mut amount = 0.0;
    let all = (0..ELEMENTS)
        .map(|i| {
            let mut nodal = [0.0; 4];
            for (s, weight) in GAUSS {
                let value = profile.value((i as f64 + s) * h);
                amount += value.abs() * weight * h;
                let part = value * weight * h * length;
                let (a, b) = (1.0 - s, s);
                let shapes = [
                    a * a * (1.0 + 2.0 * b),
                    a * a * b * h * length,
                    b * b * (1.0 + 2.0 * a),
                    -a * b * b * h * length,
                ];
                for (sum, shape) in nodal.iter_mut().zip(shapes) {
                    *sum += part * shape;
                }
            }
            nodal
        })
        .collect();
    let whole = profile.amount();
    (amount <= 1.1 * whole && whole <= 1.3 * amount).then_some(all)
}

/// Unit responses of the bending beam.
fn bent<'a>(scene: &'a EffectScene) -> Option<Vec<Unit<'a>>> {
    let n = 2 * ELEMENTS + 2;
    let h = scene.case.beam.length_m / ELEMENTS as f64;
    let k = scene.section.bending_stiffness / h.powi(3);
    let mut matrix = DMatrix::<f64>::zeros(n, n);
    let element = [
        [12.0, 6.0 * h, -12.0, 6.0 * h],
        [6.0 * h, 4.0 * h * h, -6.0 * h, 2.0 * h * h],
        [-12.0, -6.0 * h, 12.0, -6.0 * h],
        [6.0 * h, 2.0 * h * h, -6.0 * h, 4.0 * h * h],
    ];
    for i in 0..ELEMENTS {
        for (a, row) in element.iter().enumerate() {
            for (b, entry) in row.iter().enumerate() {
                matrix[(2 * i + a, 2 * i + b)] += k * entry;
            }
        }
    }
    let mut held = vec![];
    for (end, node) in [(&scene.ends[0], 0), (&scene.ends[1], ELEMENTS)] {
        if matches!(end.transverse, Translation::Displacement(_)) {
            held.push(2 * node);
        }
        if matches!(end.rotation, Rotation::Slope(_)) {
            held.push(2 * node + 1);
        }
    }
    for &i in &held {
        matrix.row_mut(i).fill(0.0);
        matrix[(i, i)] = 1.0;
    }
    let solver = matrix.lu();
    let mut units = vec![];
    let mut add = |signal: &'a Signal, mut load: DVector<f64>| {
        held.iter().for_each(|&i| load[i] = 0.0);
        let across = solver.solve(&load)?;
        units.push(Unit {
            signal,
            across,
            along: [0.0; ELEMENTS],
        });
        Some(())
    };
    for load in scene
        .loads
        .iter()
        .filter(|load| load.kind == LoadKind::ForceX && !load.signal.is_zero())
    {
        let mut right = DVector::zeros(n);
        for (i, nodal) in forces(&load.profile, scene.case.beam.length_m)?.iter().enumerate() {
            for (a, part) in nodal.iter().enumerate() {
                right[2 * i + a] += load.factor * part;
            }
        }
        add(&load.signal, right)?;
    }
    for (end, node) in [(&scene.ends[0], 0), (&scene.ends[1], ELEMENTS)] {
        if let Translation::Force(signal) = &end.transverse
            && !signal.is_zero()
        {
            let mut right = DVector::zeros(n);
            right[2 * node] = 1.0;
            add(signal, right)?;
        }
        if let Rotation::Moment(signal) = &end.rotation
            && !signal.is_zero()
        {
            let mut right = DVector::zeros(n);
            right[2 * node + 1] = 1.0;
            add(signal, right)?;
        }
    }
    Some(units)
}

/// Unit responses of the stretching beam, held at its root or its tip.
fn stretched<'a>(scene: &'a EffectScene, root: bool) -> Option<Vec<Unit<'a>>> {
    let mut units = vec![];
    let mut add = |signal: &'a Signal, parts: [f64; ELEMENTS]| {
        // sum of the forces between the element and the free end
        let along = std::array::from_fn(|i| {
            if root {
                0.5 * parts[i] + parts[i + 1..].iter().sum::<f64>()
            } else {
                -0.5 * parts[i] - parts[..i].iter().sum::<f64>()
            }
        });
        units.push(Unit {
            signal,
            across: DVector::zeros(0),
            along,
        });
    };
    for load in scene
        .loads
        .iter()
        .filter(|load| load.kind == LoadKind::ForceZ && !load.signal.is_zero())
    {
        let forces = forces(&load.profile, scene.case.beam.length_m)?;
        add(
            &load.signal,
            std::array::from_fn(|i| load.factor * (forces[i][0] + forces[i][2])),
        );
    }
    let free = usize::from(root);
    if let Translation::Force(signal) = &scene.ends[free].axial
        && !signal.is_zero()
    {
        let along = [if root { 1.0 } else { -1.0 }; ELEMENTS];
        units.push(Unit {
            signal,
            across: DVector::zeros(0),
            along,
        });
    }
    Some(units)
}
