//! What the fluid in sealed bladders does to small vibrations.

use crate::discrete::System;

/// How much higher the frequencies of bending and of stretch are where fluid cannot leave its bladders, at least 1.
///
/// ```text
/// p_R = -(R am M + an N)/a_p     ω_sealed/ω = (1 + EI α_p(p)/M)^(-1/2),  (1 + EA λ_p(p)/N)^(-1/2)
/// ```
pub fn sealed(system: &System) -> [f64; 2] {
    let (model, s) = (&system.model, &system.model.section);
    let Some(wet) = &model.wet else { return [1.0; 2] };
    let (area, coupling) = (&wet.area, &wet.coupling);
    let bent = area.moment_mean / wet.compliance();
    let stretched = area.force_mean / wet.compliance();
    let soft = [
        s.bending_stiffness * coupling.curvature(area, 0.0, -bent, bent),
        s.axial_stiffness * coupling.stretch(area, 0.0, -stretched, -stretched),
    ];
    soft.map(|soft| (1.0 / (1.0 + soft).clamp(0.05, 1.0)).sqrt())
}

/// Pressures [Pa] that a unit of curvature over the squared length, and of stretch over the length, cause in sealed bladders, both for
/// a displacement of a metre: `am EI/(a_p l²)`, `an EA/(a_p l)`.
pub fn pressed(system: &System) -> [f64; 2] {
    let (model, s) = (&system.model, &system.model.section);
    let Some(wet) = &model.wet else { return [0.0; 2] };
    let area = &wet.area;
    [
        (area.moment_mean / wet.compliance() * s.bending_stiffness / model.length.powi(2)).abs(),
        (area.force_mean / wet.compliance() * s.axial_stiffness / model.length).abs(),
    ]
}
