//! Properties of a tube: its own values, or the defaults of `/tubes`.

use crate::case::schema::{self, CrossSection, TubeDefaults};
use crate::case::wiring::PermeabilitySource;

/// Default loss of a tube, in dynamic pressures of its mean velocity: sharp entrance 0.5, exit 1.
const SHARP_EDGED: f64 = 1.5;

/// Radius of a circular tube: its own, or that of `/tubes` if the tube has neither a cross-section nor a permeability.
pub(super) fn radius(tube: &schema::Tube, usual: Option<&TubeDefaults>) -> Option<f64> {
    match (&tube.cross_section, tube.permeability_m4) {
        (Some(CrossSection::Circle { radius_m }), _) => Some(*radius_m),
        (None, None) => usual.map(|usual| usual.radius_m),
        _ => None,
    }
}

/// Loss coefficient of a tube: its own, that of `/tubes`, or that of sharp edges.
pub(super) fn loss_coefficient(own: Option<f64>, usual: Option<&TubeDefaults>) -> f64 {
    own.or_else(|| usual?.loss_coefficient).unwrap_or(SHARP_EDGED)
}

/// Roughness of a tube's wall [m]: its own, that of `/tubes`, or 0.
pub(super) fn roughness(own: Option<f64>, usual: Option<&TubeDefaults>) -> f64 {
    own.or_else(|| usual?.roughness_m).unwrap_or(0.0)
}

/// Length [m] and bore of a tube: its own, or those of `/tubes`.
pub(super) fn size<'a>(tube: &'a schema::Tube, usual: Option<&TubeDefaults>) -> Option<(f64, PermeabilitySource<'a>)> {
    let own = tube.permeability_m4.map(PermeabilitySource::Permeability);
    let bore = own
        .or_else(|| tube.cross_section.as_ref().map(PermeabilitySource::CrossSection))
        .or_else(|| usual.map(PermeabilitySource::usual))?;
    Some((tube.length_m.or_else(|| usual.map(|tubes| tubes.length_m))?, bore))
}
