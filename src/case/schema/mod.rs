//! The case as the user writes it: these structures define the JSON format (externally tagged enums, unknown keys rejected). Every key is
//! in SI units and has its unit in its name. The JSON Schema for editors is generated from these files, including the doc comments.
//! `case.json` of a result folder is this structure with every default filled in.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use slcbeam_section::input::Section;

use crate::case::amounts::GRAVITY;
use crate::case::faults::CaseSource;
use crate::case::origins::Origins;
use crate::case::presets::Preset;
use crate::functions::signals::{Signal, SmoothTime};

mod attachments;
mod beam;
mod bladders;
mod contacts;
mod effects;
mod loads;
mod network;
mod numerics;
mod probes;
mod spans;
mod structures;
mod surroundings;
mod viscoelasticity;

pub use attachments::*;
pub use beam::*;
pub use bladders::*;
pub use contacts::*;
pub use effects::*;
pub use loads::*;
pub use network::*;
pub use numerics::*;
pub use probes::*;
pub use spans::*;
pub use structures::*;
pub use surroundings::*;
pub use viscoelasticity::*;

/// A case: a beam or a structure of beams, its bladders and tubes, what is done to it, and how it is to be solved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "slcbeam case")]
pub struct Case {
    /// The JSON Schema that describes this file, for editors; not read.
    #[serde(rename = "$schema", default, skip_serializing_if = "Option::is_none")]
    pub schema: Option<String>,
    /// Short name; the default result folder is `out/<name>`. Letters, digits, `-`, `_` and `.`.
    pub name: String,
    /// Purpose and origin of the case.
    #[serde(default)]
    pub about: String,
    /// Material and sizes to start from: what the case does not give of `beam`, `fluid`, `bladders` and `tubes` is taken from
    /// there, and `"fluid": null, "bladders": null, "tubes": null` leave them out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub preset: Option<Preset>,
    /// The beam's section by its geometry: what the case does not give of sizes, material and coefficients in `beam` and `bladders`
    /// is computed from one unit cell, by finite elements; `slcbeam coefficients` has the numbers with their errors. The case of a result
    /// has the section beside its numbers, which stand as they are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub section: Option<Section>,
    /// The beam: length, cross-section and material.
    pub beam: Beam,
    /// The fluid that fills bladders and tubes. Absent together with `bladders` and `network`: a dry beam.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fluid: Option<Fluid>,
    /// The two rows of bladders. Absent: a dry beam, beside the network if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bladders: Option<Bladders>,
    /// Parts of the beam, root to tip, with values of their own. Absent: a uniform beam.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1000))]
    pub spans: Vec<Span>,
    /// Beams of a structure, which share the network; `beam` and `bladders` then have the values that they have in common. Absent: one
    /// beam.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1000))]
    pub beams: Vec<PlacedBeam>,
    /// Joints of the beams.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1000))]
    pub joints: Vec<Joint>,
    /// Default properties of tubes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tubes: Option<TubeDefaults>,
    /// Connections of the bladders, or of junctions alone. Absent: every bladder is sealed singly.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub network: Option<Network>,
    /// Distributed forces and moments, body force, gravity. They add.
    #[serde(default)]
    #[schemars(length(max = 10000))]
    pub loads: Vec<Load>,
    /// Point masses, springs, dashpots and forces at places along the beam.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1000))]
    pub attachments: Vec<Attachment>,
    /// Elastic foundation along the beam. Absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub foundation: Option<Foundation>,
    /// Walls and circles that the beam may come to lie against.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 100))]
    pub contacts: Vec<Contact>,
    /// Contact of beams with each other, and of a beam with itself.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 100))]
    pub beam_contacts: Vec<BeamContact>,
    /// Medium around the beam. Absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub surroundings: Option<Surroundings>,
    /// Rotation of the axes of the case. Absent: axes at rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotating_frame: Option<RotatingFrame>,
    /// Conditions at the root (theta = 0) and the tip (theta = length); those of a structure are in its beams.
    pub ends: Ends,
    /// State at t = 0; what is not given is zero.
    #[serde(default)]
    pub start: Start,
    /// Form of the momentum balance.
    #[serde(default)]
    pub formulation: Formulation,
    /// Rejection of sizes, proportions and strengths that hardly any beam has.
    #[serde(default, skip_serializing_if = "Plausibility::is_on")]
    pub plausibility: Plausibility,
    /// Simulated physical effects.
    #[serde(default)]
    pub effects: Effects,
    /// Relative change of results that an effect may make and still be left out by `"auto"`. Absent: a tenth of the accuracy that
    /// is asked for, or 1e-3.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-12, max = 0.5))]
    pub effects_tolerance: Option<f64>,
    /// Resolution in space.
    #[serde(default)]
    pub mesh: Mesh,
    /// Simulated time and output times.
    pub time: Time,
    /// Time integration.
    #[serde(default)]
    pub solver: Solver,
    /// Error bars of all figures by a companion run: the same case with other meshes, a looser tolerance and all effects, in a second
    /// thread.
    #[serde(default, skip_serializing_if = "Companion::is_on")]
    pub companion: Companion,
    /// Places of the beam that are recorded over time.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1000))]
    pub probes: Vec<Probe>,
    /// Reports rise time, settling times and overshoot of the tip and at probes. Absent: no report.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step_response: Option<Step>,
    /// Origins of the coefficients; neither serialized nor compared.
    #[serde(skip)]
    #[schemars(skip)]
    pub origins: Origins,
    /// Text from which the case was read, for the places of faults; neither serialized nor compared.
    #[serde(skip)]
    #[schemars(skip)]
    pub source: Arc<CaseSource>,
}

impl Case {
    /// Segments along the beam: bladders per row, or the segments of the mesh of a dry beam.
    pub fn segments(&self) -> usize {
        self.bladders
            .as_ref()
            .map_or(self.mesh.segments.unwrap_or(10), |bladders| bladders.per_row)
    }

    /// Damping times of bending and of stretching [s]: those of each span, or of a beam without spans.
    pub fn damping_times(&self) -> Vec<[f64; 2]> {
        let times = |span: Option<&Span>| {
            let mut damping = self.beam.damping.clone();
            span.into_iter().for_each(|span| span.beam.damping.apply(&mut damping));
            [damping.bending_time_s, damping.axial_time_s]
        };
        match self.spans.is_empty() {
            true => vec![times(None)],
            false => self.spans.iter().map(|span| times(Some(span))).collect(),
        }
    }

    /// Bladders of the network, [`NO_BLADDERS`] for a network without; none for a dry beam without network.
    pub fn network_bladders(&self) -> Option<&Bladders> {
        let network = self.network.as_ref();
        self.bladders.as_ref().or(network.map(|_| &NO_BLADDERS))
    }

    /// Acceleration of the fluid by gravity [m/s^2]: that of the loads, else standard gravity.
    pub fn gravity(&self) -> f64 {
        let given = self.loads.iter().filter_map(|load| match load {
            Load::Gravity { x_m_s2, z_m_s2 } => Some([*x_m_s2, *z_m_s2]),
            _ => None,
        });
        let sum = given.reduce(|a, b| [a[0] + b[0], a[1] + b[1]]);
        sum.map_or(GRAVITY, |[x, z]| x.hypot(z))
    }

    /// Value of a signal at which the beam rests when the run begins: 0, or the value in the equilibrium of the start.
    pub fn held_at_start(&self, signal: &Signal) -> f64 {
        let value = |t: f64| signal.jet(SmoothTime { t, within: t }).value;
        self.start
            .equilibrium
            .as_ref()
            .map_or(0.0, |start| value(start.loads_at_s))
    }

    /// Largest relative change of results by an effect that may be omitted.
    pub fn effects_tolerance(&self) -> f64 {
        self.effects_tolerance.unwrap_or(1e-3)
    }

    /// Returns the case with every default filled in. Omits the editor's schema, which result folders lack, and presets, whose values are
    /// included.
    pub fn resolved(&self) -> Self {
        let mut case = self.clone();
        case.schema = None;
        case.preset = None;
        if let Some(fluid) = &mut case.fluid {
            (fluid.preset, fluid.temperature_c) = (None, None);
        }
        case.time.output_interval_s = Some(self.time.output_interval());
        case.time.fields_interval_s = Some(self.time.fields_interval());
        case.time.window_s = Some(self.time.window());
        case.mesh.segments = Some(self.segments());
        if self.is_structure() {
            case.spans.clear();
        }
        case.effects_tolerance = Some(self.effects_tolerance());
        case
    }
}

/// The default of factors.
fn one() -> f64 {
    1.0
}

/// Given signals or profiles, with their keys.
fn given<'a, T, const N: usize>(
    all: [(&'static str, &'a Option<T>); N],
) -> impl Iterator<Item = (&'static str, &'a T)> {
    all.into_iter().filter_map(|(key, value)| Some((key, value.as_ref()?)))
}

/// True if a choice is false, the default that a case may omit.
fn is_false(value: &bool) -> bool {
    !value
}

/// True if a number is 0, the default that a case may omit.
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}
