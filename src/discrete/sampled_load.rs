//! Distributed loads and elastic foundations on a mesh.

use super::{MeshSections, shapes};
use crate::functions::profile::Profile;
use crate::functions::signals::Signal;
use crate::model::loads::{LoadKind, LoadMeasure};
use crate::model::{DistributedLoad, Model};

/// A load on a mesh: forces at nodes, moments in cells.
///
/// `[E46]` Forces are weighted by the hat functions of the nodes, moments by their cells,
///
/// ```text
/// h_i b_i = ∫ b hat_i dθ        h (m b1)_c = ∫_c m b1 dθ
/// ```
///
/// with exact integrals ([`crate::functions::profile::Integrals`]). Force, moment about any point and couple are exact on every mesh. So
/// are M at nodes and the mean of N in each cell of a statically determinate beam, but not M between nodes ([`super::resolution`]).
#[derive(Clone, Debug)]
pub struct SampledLoad {
    /// Kind of the load.
    pub kind: LoadKind,
    /// Time function.
    pub signal: Signal,
    /// First node or cell on which it acts.
    pub first: usize,
    /// Factor at each node or cell from the first on, in the unit of the load.
    pub shape: Vec<f64>,
}

impl SampledLoad {
    /// Discretizes a load on a mesh.
    pub fn new(load: &DistributedLoad, model: &Model, sections: &MeshSections, mesh: &super::BeamMesh) -> Self {
        let mut shape = match load.kind {
            LoadKind::ForceX | LoadKind::ForceZ | LoadKind::Normal | LoadKind::Tangential => {
                forces_at_nodes(&load.profile, mesh)
            }
            LoadKind::RestCurvature => shapes::at_nodes(&load.profile, &mesh.shares()),
            LoadKind::MomentX | LoadKind::MomentZ => shapes::in_cells(&load.profile, &mesh.shares()),
        };
        let graded = match load.per {
            LoadMeasure::Mass(acceleration) => Some((&sections.mass, acceleration)),
            LoadMeasure::Weight(acceleration) => Some((&sections.weighing, acceleration)),
            LoadMeasure::Length => None,
        };
        match graded.filter(|_| !model.sections.is_empty()) {
            Some((masses, acceleration)) => {
                let nodes = shape.iter_mut().zip(masses);
                nodes.for_each(|(value, mass)| *value *= mass * acceleration);
            }
            None => shape.iter_mut().for_each(|value| *value *= load.factor),
        }
        Self {
            kind: load.kind,
            signal: load.signal.clone(),
            first: 0,
            shape,
        }
    }
}

/// `[E84]` Stiffness of an elastic foundation at the nodes [N/m], with the weights of [E46] and [E78]; empty without a foundation:
///
/// ```text
/// k_i = ∫ k hat_i dθ        f_i = -k_i u_i        E gains Σ k_i u_i²/2
/// ```
pub fn foundation(model: &Model, mesh: &super::BeamMesh) -> Vec<[f64; 2]> {
    if model.foundation.iter().all(Option::is_none) {
        return vec![];
    }
    let mut stiffness = vec![[0.0; 2]; mesh.nodes];
    for (axis, profile) in model.foundation.iter().enumerate() {
        let Some(profile) = profile else { continue };
        for (node, value) in forces_at_nodes(profile, mesh).into_iter().enumerate() {
            stiffness[node][axis] = value * mesh.node_lengths[node];
        }
    }
    stiffness
}

/// Force per length `b_i` of each node.
fn forces_at_nodes(profile: &Profile, mesh: &super::BeamMesh) -> Vec<f64> {
    let mut values = shapes::at_nodes(profile, &mesh.shares());
    if !mesh.fourth {
        return values;
    }
    let scaled = |values: &mut [f64], by: &dyn Fn(f64) -> f64| {
        let all = values.iter_mut().enumerate();
        all.for_each(|(node, value)| *value *= by(mesh.node_lengths[node]));
    };
    scaled(&mut values, &|length| length);
    mesh.lump(&mut values);
    scaled(&mut values, &|length| 1.0 / length);
    values
}
