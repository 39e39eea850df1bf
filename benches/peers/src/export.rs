//! Exports the parameters of a scene to independent implementations, with residuals at random states for comparison.

use serde_json::{Value, json};
use slcbeam::dae::Dae;

use crate::random::Random;
use crate::scene::Scene;

/// Number of states at which equations are compared.
const STATES: usize = 5;

/// Resolved case, section, scales and positions of the unknowns, pattern, initial state, and residuals at random states.
pub fn scene(scene: &Scene) -> Value {
    let mut dae = scene.dae();
    let n = scene.y.len();
    let mut random = Random(7);
    let mut states = vec![];
    for k in 0..STATES {
        let t = scene.end() * (k as f64 + 0.3) / STATES as f64;
        let (y, yp) = (random.vector(n, 0.3), random.vector(n, 100.0));
        let mut residual = vec![0.0; n];
        dae.residual(t, &y, &yp, &mut residual).expect("a residual");
        states.push(json!({"t": t, "y": y, "yp": yp, "residual": residual}));
    }
    let system = dae.0.system();
    let (l, section) = (&system.layout, &system.model.section);
    let block = |range: &std::ops::Range<usize>| [range.start, range.end];
    json!({
        "case": serde_json::to_value(&scene.case).expect("a case"),
        "section": {
            "mass_per_length": section.mass_per_length, "axial_stiffness": section.axial_stiffness,
            "bending_stiffness": section.bending_stiffness, "shear_stiffness": scene.case.beam.shear_stiffness_n,
            "gyration_radius_squared": section.gyration_radius_squared,
        },
        "mesh": {
            "segments": system.mesh.segments, "cells_per_segment": system.mesh.cells_per_segment,
            "cells_per_bladder": system.fluid.as_ref().map_or(0, |fluid| fluid.cells_per_bladder),
        },
        "layout": {
            "u1": block(&l.lines[0].u), "u3": block(&l.lines[1].u),
            "v1": l.lines[0].v.as_ref().map(block), "v3": l.lines[1].v.as_ref().map(block),
            "angle": block(&l.turning.angle), "mean_moment": block(&l.coupling.mean_moment), "mean_force": block(&l.coupling.mean_force),
            "area": block(&l.network.area), "flowing": system.fluid.as_ref().map(|fluid| &fluid.flowing),
            "kept_area": system.fluid.as_ref().map(|fluid| &fluid.area_at_start),
        },
        "scales": l.scales, "row_scales": l.row_scales, "differential": l.differential,
        "pattern": {"starts": dae.pattern().starts, "rows": dae.pattern().rows},
        "mass": scene.mass(),
        "start": {"y": scene.y, "yp": scene.yp}, "times": scene.times, "largest_step": scene.largest_step,
        "states": states,
    })
}
