//! A rough estimate of the errors of final values in time and in space, made from the run itself.
//!
//! ```text
//! small      vibrations of the straight beam, and what a mesh does to their frequencies
//! vibration  one of them followed along the run
//! resonance  a drive that comes near one which the mesh misplaces
//! ```
//!
//! What a mesh and what steps change of a beam that vibrates freely is first of all its phase, and that grows with every period. So
//! the first modes are read off the state after every step; of each it is known how much it turns too slowly on this mesh, and
//! what a step of this method does to it. Where a motion follows what drives it there is no phase to lose: there the mesh changes
//! the deflection by twice what it changes the first frequency, and steps by about their tolerance.
//!
//! It is an order of magnitude, by linear theory: growth, waves in the fluid and large rotations do more than it sees. Two runs on
//! two meshes measure; `slcbeam run --accuracy` does that.

pub mod resonance;
pub mod small;
pub mod vibration;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::summary::{Estimate, Quantity};
use crate::case::schema::Case;
use crate::discrete::System;
use crate::error::Code;
use crate::onestep::Method;
use crate::sundials::Step;

use small::SmallMode;
use vibration::{Known, Vibration};

/// Above this a final value is warned of.
const LARGE: f64 = 0.05;
/// What steps make of a tolerance of 1 in a motion that they follow, at least, and of its root at most: what is measured with stiff
/// and soft beams at tolerances from 1e-7 to 1e-2. Between the two it gathers like the root of their number.
const AT_LEAST: f64 = 2.0;
const AT_MOST: f64 = 0.05;
/// Part of a displacement's error that is seen at an instant, on average over phases.
const SEEN: f64 = 0.7;
/// How much a slope takes the tip along that turns with the deflection of the first mode, on average over phases of both.
const DRAWN: f64 = 0.5;
/// How much more than the last mode that is followed all beyond it are in errors by steps: their shares fall with the fourth power
/// of the wave number.
const BEYOND: f64 = 2.0;
/// How much more than its deflection a mesh changes a beam's work and the pressures in it: these go with curvatures, of which higher
/// modes have more. Measured on random beams of 8 to 16 cells.
const CURVED: f64 = 3.0;
/// Below this part of the displacement along the beam one across it stores nothing that counts.
const ALONG: f64 = 0.1;
/// An energy is the square of a motion.
const SQUARED: f64 = 2.0;
/// Figures below this part of others are nothing to be accurate about.
const NOTHING: f64 = 1e-6;

/// What the estimate says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimated {
    /// By steps, of the figure that is off most, relative to the largest value of its quantity.
    pub time: f64,
    /// By the mesh, likewise.
    pub space: f64,
    /// The quantity whose final value that is.
    pub of: String,
    /// Part of it that is phase of one vibration: it is in final values, and hardly in largest values or root mean squares.
    pub phase: f64,
    /// Vibrations gone, of the mode that is off most.
    pub vibrations: f64,
    /// By what angle mesh and steps have shifted it [rad].
    pub shift_rad: f64,
    /// All quantities.
    pub quantities: BTreeMap<String, Estimate>,
}

impl Estimated {
    /// What to know where it is large.
    pub fn warning(&self) -> Option<String> {
        let total = self.time + self.space;
        if total <= LARGE {
            return None;
        }
        let size = |x: f64| {
            if x >= 1.0 {
                "all".to_string()
            } else {
                format!("{:.0} %", 100.0 * x)
            }
        };
        let because = if total - self.phase <= LARGE && self.phase > 0.5 * total {
            format!(
                "after {:.0} vibrations mesh and steps have shifted the phase by {:.2} rad; largest values and root mean squares are \
                 hardly affected",
                self.vibrations, self.shift_rad
            )
        } else {
            "the mesh is coarse, or the tolerance loose, for what the beam does, and largest values are off as well, energies and pressures most"
                .into()
        };
        Some(Code::ErrorEstimate.warning(format!(
            "estimate: the final {} may be off by about {} of its largest value ({} by steps, {} by the mesh): {because}; --accuracy \
             measures",
            self.of,
            size(total),
            size(self.time),
            size(self.space)
        )))
    }
}

/// Follows the first modes of bending and of stretch.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Estimator {
    bending: Vec<Vibration>,
    axial: Vec<Vibration>,
    /// What the mesh makes of a deflection at rest, of a stretch at rest.
    at_rest: [f64; 2],
    rtol: f64,
    /// Steps taken.
    steps: u64,
    /// Sizes of displacements to which the tolerance refers [m].
    scales: [f64; 2],
    /// Length of the beam [m].
    length: f64,
    /// Part of the run that the window is.
    window: f64,
}

impl Estimator {
    /// Of a system of the case.
    pub fn new(case: &Case, system: &System) -> Self {
        let (model, layout) = (&system.model, &system.layout);
        let s = &model.section;
        let length = model.length;
        let fine = (system.mesh.h / length).powi(2);
        let stiffer = sealed(system);
        let across = if layout.free_u1.is_empty() {
            vec![]
        } else {
            small::bending(&model.ends)
        };
        let along = if layout.free_u3.is_empty() {
            vec![]
        } else {
            small::axial(&model.ends)
        };
        let at_rest = [&across, &along].map(|modes| modes.first().map_or(0.0, |m| 2.0 * m.mesh.abs() * fine));
        let one = |mode: SmallMode, across: bool| {
            let (free, first, unit, more) = if across {
                let unit = (s.bending_stiffness / s.mass_per_length).sqrt() / (length * length);
                (&layout.free_u1, [layout.u1, layout.v1], unit, stiffer[0])
            } else {
                let unit = (s.axial_stiffness / s.mass_per_length).sqrt() / length;
                (&layout.free_u3, [layout.u3, layout.v3], unit, stiffer[1])
            };
            let [size, rate] = first.map(|k| layout.scales[k]);
            let frequency = mode.frequency * unit;
            let material = if across {
                s.bending_damping_time
            } else {
                s.axial_damping_time
            };
            let weight = |node: usize| {
                let place = system.mesh.node_coordinate(node) / length;
                mode.at(place) * system.mesh.node_length(node) / length * size
            };
            Vibration::new(Known {
                first,
                weights: free.clone().map(weight).collect(),
                rate: rate / size,
                frequencies: [frequency, frequency * more],
                mesh: mode.mesh * fine,
                damping: 0.5 * s.drag / s.mass_per_length + 0.5 * material * frequency * frequency,
                places: [mode.at(1.0), mode.tip_slope() / length, mode.most()],
            })
        };
        let follow = |modes: Vec<SmallMode>, waves: bool, across: bool| -> Vec<Vibration> {
            modes
                .into_iter()
                .filter(|_| waves)
                .map(|mode| one(mode, across))
                .collect()
        };
        Self {
            bending: follow(across, layout.waves[0], true),
            axial: follow(along, layout.waves[1], false),
            at_rest,
            rtol: case.solver.rtol,
            steps: 0,
            scales: [model.scales.transverse, model.scales.axial],
            length,
            window: case.time.window() / case.time.end_s,
        }
    }

    /// Takes an accepted step, with the unknowns and their rates at its end; `None`: of BDF.
    pub fn step(&mut self, method: Option<Method>, step: &Step, values: [&[f64]; 2]) {
        self.steps += 1;
        let tableau = vibration::tableau(method);
        for mode in self.bending.iter_mut().chain(&mut self.axial) {
            mode.step(tableau.as_ref(), step, values);
        }
    }

    /// What the steps make of their tolerance where they follow the motion, relative to what it refers to.
    fn gathered(&self) -> f64 {
        let more = self.rtol * (self.steps as f64).sqrt();
        more.min(AT_MOST * self.rtol.sqrt()).max(AT_LEAST * self.rtol)
    }

    /// Errors of the final values, as far as they can be told; none where nothing moves.
    pub fn judge(&self, quantities: &BTreeMap<String, Quantity>) -> Option<Estimated> {
        let largest = |name: &str| quantities.get(name).and_then(|q| q.max_abs).unwrap_or(0.0);
        let [u1, u3, angle] = ["tip_u1_m", "tip_u3_m", "tip_angle_rad"].map(largest);
        let [wide_u1, wide_u3] = ["largest_u1_m", "largest_u3_m"].map(largest);
        let [bending, axial] =
            [&self.bending, &self.axial].map(|all| all.iter().map(Vibration::ended).collect::<Vec<_>>());
        let [across, turn, anywhere] = [0, 1, 2].map(|what| Off::of(&bending, what));
        let [along, along_anywhere] = [0, 2].map(|what| Off::of(&axial, what));
        // a tip that has turned moves along as well, and so does what has bent between ends that hold it
        let drawn = across.times(DRAWN * angle.min(1.0));
        let mean_slope = 2.0 * wide_u1 / self.length;
        let drawn_anywhere = anywhere.times(DRAWN * mean_slope.min(1.0));
        // an end that is held has round-off, which is no motion
        let everything = u1.max(u3).max(wide_u1).max(wide_u3).max(angle * self.length);
        let mut found: Option<Estimated> = None;
        let mut all = BTreeMap::new();
        let [bent, stretched] = self.at_rest;
        let [wide, long] = self.scales;
        let both = bent.max(stretched);
        for (name, size, off, at_rest, scale, unit) in [
            ("tip_u1_m", u1, across, bent, wide, 1.0),
            ("tip_u3_m", u3, along.and(drawn), both, long, 1.0),
            ("tip_angle_rad", angle, turn, bent, wide / self.length, self.length),
            ("largest_u1_m", wide_u1, anywhere, bent, wide, 1.0),
            (
                "largest_u3_m",
                wide_u3,
                along_anywhere.and(drawn_anywhere),
                both,
                long,
                1.0,
            ),
        ] {
            if size * unit <= NOTHING * everything || size == 0.0 || !size.is_finite() {
                continue;
            }
            let phase = off.errors.map(|x| x / size);
            let time = phase[0] + (self.gathered() * (1.0 + scale / size)).min(1.0);
            let space = phase[1] + at_rest;
            all.insert(name.to_string(), estimate(time, space));
            if found.as_ref().is_none_or(|f| time + space > f.time + f.space) {
                found = Some(Estimated {
                    time,
                    space,
                    of: name.into(),
                    // less than a vibration in the window: its root mean square knows of the phase
                    phase: match off.vibrations * self.window < 1.0 {
                        true => 0.0,
                        false => (phase[0] + phase[1] - off.peaks / size).max(0.0),
                    },
                    vibrations: off.vibrations,
                    shift_rad: off.shift,
                    quantities: BTreeMap::new(),
                });
            }
        }
        let mut found = found?;
        let worked = quantities.get("input_energy_j").and_then(|q| q.last).unwrap_or(0.0);
        if worked != 0.0 && worked.is_finite() {
            // ends that are driven along the beam move all of it, and store nothing
            let (off, size, at_rest) = match wide_u1 >= ALONG * wide_u3 {
                true => (anywhere, wide_u1, bent),
                false => (along_anywhere, wide_u3, stretched),
            };
            let phase = off.errors.map(|x| SQUARED * x / size.max(f64::MIN_POSITIVE));
            let (time, space) = (
                phase[0] + (SQUARED * self.gathered()).min(1.0),
                phase[1] + CURVED * at_rest,
            );
            all.insert("input_energy_j".into(), estimate(time, space));
            // one that has lost its phase names the displacement: that says more
            if found.time + found.space <= LARGE && time + space > LARGE {
                found = Estimated {
                    time,
                    space,
                    of: "input_energy_j".into(),
                    phase: 0.0,
                    vibrations: off.vibrations,
                    shift_rad: off.shift,
                    quantities: BTreeMap::new(),
                };
            }
        }
        found.quantities = all;
        Some(found)
    }
}

fn estimate(time: f64, space: f64) -> Estimate {
    Estimate {
        time: Some(time),
        space: Some(space),
        total: Some(time + space),
        ..Estimate::default()
    }
}

/// Errors of a figure by the phases of several modes.
#[derive(Clone, Copy, Debug, Default)]
struct Off {
    /// By steps and by the mesh.
    errors: [f64; 2],
    /// Of all modes but the one that swings most: how they meet makes the largest values.
    peaks: f64,
    /// Vibrations of the mode that does most, its shift [rad], and what it does.
    vibrations: f64,
    shift: f64,
    most: f64,
}

impl Off {
    /// Of the tip's displacement (0) or slope (1), or of the displacement anywhere (2). Phases of modes are nobody's: their errors add like squares.
    fn of(modes: &[Vibration], what: usize) -> Self {
        let mut all = Self::default();
        let swing = |mode: &Vibration| mode.places[what].abs() * mode.amplitude();
        let widest = (0..modes.len()).max_by(|a, b| swing(&modes[*a]).total_cmp(&swing(&modes[*b])));
        for (k, mode) in modes.iter().enumerate() {
            let [time, space] = mode.off().map(|x| SEEN * mode.places[what].abs() * x);
            let time = if k + 1 == modes.len() { BEYOND * time } else { time };
            all.errors = [all.errors[0].hypot(time), all.errors[1].hypot(space)];
            if Some(k) != widest {
                all.peaks = all.peaks.hypot(time + space);
            }
            if time + space > all.most {
                let [steps, mesh, turned] = mode.turned;
                (all.vibrations, all.shift) = (turned / std::f64::consts::TAU, steps.abs() + mesh.abs());
                all.most = time + space;
            }
        }
        all
    }

    fn times(mut self, factor: f64) -> Self {
        self.errors = self.errors.map(|x| factor * x);
        self.most *= factor;
        self.peaks *= factor;
        self
    }

    fn and(self, other: Self) -> Self {
        let errors = [0, 1].map(|k| self.errors[k].hypot(other.errors[k]));
        let most = if self.most >= other.most { self } else { other };
        Self {
            errors,
            peaks: self.peaks.hypot(other.peaks),
            ..most
        }
    }
}

/// How much higher the frequencies of bending and of stretch are where fluid cannot leave its bladders, at least 1.
///
/// ```text
/// p_R = -(R am M + an N)/a_p     ω_sealed/ω = (1 + EI α_p(p)/M)^(-1/2),  (1 + EA λ_p(p)/N)^(-1/2)
/// ```
fn sealed(system: &System) -> [f64; 2] {
    let (model, s) = (&system.model, &system.model.section);
    let Some(wet) = &model.wet else { return [1.0; 2] };
    let (area, coupling) = (&wet.area, &wet.coupling);
    let bent = area.moment_mean / area.per_pressure;
    let stretched = area.force_mean / area.per_pressure;
    let soft = [
        s.bending_stiffness * coupling.curvature(area, 0.0, -bent, bent),
        s.axial_stiffness * coupling.stretch(area, 0.0, -stretched, -stretched),
    ];
    soft.map(|soft| (1.0 / (1.0 + soft).clamp(0.05, 1.0)).sqrt())
}
