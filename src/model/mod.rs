//! Physics: one cross-section, one bladder, one network, as pure functions generic over the scalar.
//!
//! A [`Model`] is the case resolved: effects chosen, every law a closed enum, every signal in place. It knows no mesh.

pub mod audit;
pub mod beam;
pub mod bladder;
pub mod characteristic;
pub mod coupling;
pub mod duct;
pub mod effects;
pub mod loads;
pub mod mapping;
pub mod network;
pub mod scalar;
pub mod scales;

use crate::case::ResolvedEnd;
use crate::case::schema::{Case, Formulation};

pub use beam::Section;
pub use bladder::AreaLaw;
pub use coupling::Coupling;
pub use effects::{Decision, EffectSet};
pub use loads::Load;
pub use network::Network;
pub use scalar::Scalar;
pub use scales::Scales;

/// The bladders and what they are filled with and joined by.
#[derive(Clone, Debug)]
pub struct Wet {
    /// Bladders in a row, `n/2`.
    pub per_row: usize,
    /// Length `l_b` of a bladder [m].
    pub bladder_length: f64,
    /// Cross-section at rest `h_b w_b` [m^2].
    pub area_at_rest: f64,
    /// Area change of a bladder cell.
    pub area: AreaLaw,
    /// Strains caused by pressure.
    pub coupling: Coupling,
    /// Tubes, junctions, ports, turbines.
    pub network: Network,
}

/// A case resolved into physics.
#[derive(Clone, Debug)]
pub struct Model {
    /// Cross-section of the beam.
    pub section: Section,
    /// Length `l_s` [m].
    pub length: f64,
    /// Form of the momentum balance.
    pub formulation: Formulation,
    /// Effects that are simulated.
    pub effects: EffectSet,
    /// Conditions at root and tip.
    pub ends: [ResolvedEnd; 2],
    /// Distributed loads.
    pub loads: Vec<Load>,
    /// Fluid and bladders; absent in a dry beam.
    pub wet: Option<Wet>,
    /// Characteristic size of every kind of unknown.
    pub scales: Scales,
}

impl Model {
    /// The model of a checked case.
    pub fn new(case: &Case) -> Self {
        let section = Section::new(case);
        let effects = EffectSet::choose(case, &section);
        let wet = case
            .fluid
            .as_ref()
            .zip(case.bladders.as_ref())
            .map(|(fluid, bladders)| Wet {
                per_row: bladders.per_row,
                bladder_length: bladders.length_m,
                area_at_rest: bladders.height_m * bladders.width_m,
                area: AreaLaw::new(case, bladders, &section, effects.asymmetry),
                coupling: Coupling::new(case, bladders),
                network: Network::new(case, fluid, bladders),
            });
        let loads = case
            .loads
            .iter()
            .flat_map(|load| Load::resolve(load, section.mass_per_length))
            .collect();
        let ends = [case.ends.root.resolve(), case.ends.tip.resolve()];
        let scales = Scales::estimate(case, &section, wet.as_ref());
        Self {
            section,
            length: case.beam.length_m,
            formulation: case.formulation,
            effects,
            ends,
            loads,
            wet,
            scales,
        }
    }
}
