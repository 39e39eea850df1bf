//! A rough estimate of the errors of final values in time and in space, made from the run itself.
//!
//! ```text
//! vibration  one of the straight beam followed along the run
//! off        what several of them together make of a figure
//! resonance  a drive that comes near one which the mesh misplaces
//! coupled    what sealed fluid does to them
//! tolerance  what steps make of their tolerance
//! turning    how far they turn a beam wrongly that nothing turns back
//! strikes    what steps leave of a motion that strikes walls
//! couple     a rotational spring at an end whose moment is given
//! unstable   growth of the deflection and compression
//! work       energies that were put in and harvested
//! young      a wave that has only begun to run along the beam
//! words      what is said of it
//! ```
//!
//! What a mesh and what steps change of a beam that vibrates freely is first of all its phase, and that grows with every period. So
//! the first modes are read off the state after every step; of each it is known how much it turns too slowly on this mesh, and
//! what a step of this method does to it. Where a motion follows what drives it there is no phase to lose: there the mesh changes
//! the deflection by twice what it changes the first frequency, and steps by about their tolerance.
//!
//! Energies go as squares of the motion. Where the deflection grows by itself, errors of the first moments grow with it, and so does what
//! the mesh changes of the rate: all errors are taken to be larger by as much as the deflection has grown.
//!
//! It is an order of magnitude, by linear theory: waves in the fluid and large rotations do more than it sees. Two runs on
//! two meshes measure; `slcbeam run --accuracy` does that.

pub mod couple;
pub mod coupled;
pub mod off;
pub mod resonance;
pub mod strikes;
pub mod tolerance;
pub mod turning;
mod unstable;
pub mod vibration;
pub mod words;
pub mod work;
pub mod young;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::floors::Floors;
use super::summary::Quantity;
use crate::case::relaxation;
use crate::case::schema::{Case, Effect};
use crate::discrete::ledger::EnergyBalance;
use crate::discrete::quantities::Interest;
use crate::discrete::straight::meshed::{self, SmallMode};
use crate::discrete::{State, System, TimeData};
use crate::onestep::Method;
use crate::sundials::Step;

use couple::Couple;
use off::Off;
use resonance::Near;
use strikes::Strikes;
use tolerance::Tolerance;
use turning::Turning;
pub use unstable::Unstable;
use vibration::{Known, Place, Vibration};
pub use words::Estimated;
use words::Row;
pub use work::Work;

/// How much a slope takes the tip along that turns with the deflection of the first mode, on average over phases of both.
const DRAWN: f64 = 0.5;
/// How much more than its deflection a mesh changes a beam's work and the pressures in it: these go with curvatures, of which higher
/// modes have more. Measured on random beams of 8 to 16 cells.
const CURVED: f64 = 3.0;
/// An energy is the square of a motion, and so is what a deflection draws in.
const SQUARED: f64 = 2.0;
/// Part of the largest deflection whose error is left where deflections cancel.
const CANCELS: f64 = 0.02;
/// Figures below this part of others are nothing to be accurate about.
const NOTHING: f64 = 1e-6;

/// Follows the first modes of bending and of stretch.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Estimator {
    bending: Vec<Vibration>,
    axial: Vec<Vibration>,
    /// What the mesh makes of a deflection at rest, of a stretch at rest.
    at_rest: [f64; 2],
    /// How many times as large the square of the wave number is, of what ends and pulses send out, as that of the first vibration.
    young: [f64; 2],
    /// One over the square of the first wave number times length, that of bending.
    first: f64,
    tolerance: Tolerance,
    /// The beam as a whole, where it turns freely.
    #[serde(default)]
    turning: Option<Turning>,
    /// Swings between walls, where there are any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    strikes: Option<Strikes>,
    /// Rotational springs at ends.
    #[serde(default)]
    couple: Couple,
    near: Option<Near>,
    /// Velocities across: first unknown, number, size [m/s]; largest acceleration seen [m/s^2].
    velocities: (usize, usize, f64),
    acceleration: f64,
    floors: Floors,
    /// Pressures that a deflection and a stretch cause, of the shapes of the first modes [Pa/m].
    pressed: [f64; 2],
    /// Energies that they store, of the same shapes, over squares of these [J/m^2].
    stored: [f64; 2],
    /// Part of the run that the window is.
    window: f64,
    /// Cells a segment, and tolerance.
    settings: (usize, f64),
}

impl Estimator {
    /// Of a system of the case, and what is round-off in it.
    pub fn new(case: &Case, system: &System, floors: Floors) -> Self {
        let (model, layout) = (&system.model, &system.layout);
        let s = &model.section;
        let length = model.length;
        // of angular frequencies of bending and of stretch [1/s]
        let units = [
            (s.bending_stiffness / s.mass_per_length).sqrt() / (length * length),
            (s.axial_stiffness / s.mass_per_length).sqrt() / length,
        ];
        let fine = (system.mesh.h / length).powi(2);
        let stiffer = coupled::sealed(system);
        let pressed = coupled::pressed(system);
        let tones = resonance::tones(system);
        let across = if layout.lines[0].free.is_empty() {
            vec![]
        } else {
            meshed::bending(&model.ends)
        };
        let along = if layout.lines[1].free.is_empty() {
            vec![]
        } else {
            meshed::axial(&model.ends)
        };
        let first = [&across, &along].map(|modes| modes.first().map_or((0.0, 0.0), |m| (m.mesh.abs(), m.frequency)));
        let one = |mode: SmallMode, which: usize| {
            let line = &layout.lines[which];
            let [size, rate] = [Some(&line.u), line.v.as_ref()].map(|of| of.map_or(1.0, |of| layout.scales[of.start]));
            let rigid = mode.frequency * units[which];
            let sheared = which == 0 && model.effects.has(Effect::Shear);
            let frequency = if sheared { s.sheared(rigid) } else { rigid };
            let [frequency, relaxing] = relaxation::vibration(&model.relaxation, frequency);
            let frequencies = [frequency, frequency * stiffer[which]];
            let material = [s.bending_damping_time, s.axial_damping_time][which];
            let weight = |node: usize| {
                let place = system.mesh.node_coordinate(node) / length;
                mode.at(place) * system.mesh.node_length(node) / length * size
            };
            let [low, high] = vibration::band(frequencies);
            Vibration::new(Known {
                first: [Some(&line.u), line.v.as_ref()].map(|of| of.map_or(0, |of| of.start)),
                weights: line.free.clone().map(weight).collect(),
                rate: rate / size,
                frequencies,
                mesh: mode.mesh * fine,
                damping: 0.5 * s.drag / s.mass_per_length + 0.5 * material * frequency * frequency + relaxing,
                places: [
                    mode.at(1.0),
                    mode.tip_slope() / length,
                    mode.most(),
                    mode.at(0.5),
                    pressed[which] * mode.frequency * mode.most(),
                ],
                driven: tones[which]
                    .iter()
                    .any(|tone| (low..high).contains(&(std::f64::consts::TAU * tone))),
            })
        };
        let follow = |modes: Vec<SmallMode>, which: usize| -> Vec<Vibration> {
            let all = modes.into_iter().filter(|_| layout.lines[which].v.is_some());
            all.map(|mode| one(mode, which)).collect()
        };
        Self {
            bending: follow(across, 0),
            axial: follow(along, 1),
            at_rest: first.map(|(mesh, _)| 2.0 * mesh * fine),
            young: young::shorter(case, system, [0, 1].map(|k| units[k] * first[k].1)),
            first: if first[0].1 > 0.0 { first[0].1.recip() } else { 0.0 },
            tolerance: Tolerance::new(case.solver.rtol, &model.scales, layout),
            turning: Turning::of(system),
            strikes: Strikes::of(system),
            couple: Couple::of(system, case.time.end_s),
            near: resonance::nearest(system),
            velocities: (layout.lines[0].v.as_ref())
                .map_or((0, 0, 0.0), |v| (v.start, v.len(), model.scales.transverse_rate)),
            acceleration: 0.0,
            floors,
            pressed: [0, 1].map(|which| pressed[which] * first[which].1),
            stored: [
                s.bending_stiffness / length.powi(3) * first[0].1.powi(2),
                s.axial_stiffness / length * first[1].1.powi(2),
            ],
            window: case.time.window() / case.time.end_s,
            settings: (case.mesh.cells_per_segment, case.solver.rtol),
        }
    }

    /// Takes an accepted step, with the unknowns and their rates at its end; `None`: of BDF.
    pub fn step(&mut self, method: Option<Method>, step: &Step, values: [&[f64]; 2]) {
        let (first, number, size) = self.velocities;
        let fastest = values[1][first..first + number]
            .iter()
            .fold(0.0_f64, |most, a| most.max(a.abs()));
        self.acceleration = self.acceleration.max(size * fastest);
        let tableau = vibration::tableau(method);
        for mode in self.bending.iter_mut().chain(&mut self.axial) {
            mode.step(tableau.as_ref(), step, values);
        }
        if let Some(turning) = &mut self.turning {
            turning.step(tableau.as_ref(), step);
        }
    }

    /// Takes the state at the end of a step of a size [s], with the balance of energy and what that of angular momentum leaves open [N m s].
    pub fn see(
        &mut self,
        system: &System,
        now: &TimeData,
        w: State,
        size: f64,
        (energy, angular): (&EnergyBalance, f64),
    ) {
        if let Some(turning) = &mut self.turning {
            turning.see(system, now, w, size, angular);
        }
        if let Some(strikes) = &mut self.strikes {
            strikes.see(system, w, energy);
        }
    }

    /// Takes what the same step, of a size [s], is estimated to have added to the errors of the scaled unknowns; none where that is not known.
    pub fn erred(&mut self, size: f64, errors: &[f64]) {
        self.tolerance.step(size, errors);
    }

    /// Errors of the final values, as far as they can be told, none where nothing moves, and what to know of them.
    pub fn judge(
        &self,
        quantities: &BTreeMap<String, Quantity>,
        unstable: &Unstable,
        work: &Work,
    ) -> (Option<Estimated>, Option<String>) {
        let rows = self.rows(quantities, unstable, work);
        let found = Estimated::of(&rows, unstable, self.near, self.young[0].max(self.young[1]));
        let found = found.map(|found| Estimated {
            turning: self.turning.as_ref().map(Turning::ended),
            struck: self.strikes.as_ref().and_then(Strikes::struck),
            ..found
        });
        let (cells, rtol) = self.settings;
        let warning = found.as_ref().and_then(|found| found.warning(&rows, cells, rtol));
        (found, warning)
    }

    fn rows(&self, quantities: &BTreeMap<String, Quantity>, unstable: &Unstable, work: &Work) -> Vec<Row> {
        let grown = unstable.grown;
        let largest = |one: Interest| quantities.get(one.name()).and_then(|q| q.max_abs).unwrap_or(0.0);
        let [wide, long, angle] = [Interest::LargestU1, Interest::LargestU3, Interest::TipAngle].map(largest);
        let length = self.floors.length;
        let [bending, axial] =
            [&self.bending, &self.axial].map(|all| all.iter().map(Vibration::ended).collect::<Vec<_>>());
        // a tip that has turned moves along as well, and so does what has bent between ends that hold it
        let drawn = |place: Place, slope: f64| Off::of(&bending, place).times(DRAWN * slope.min(1.0));
        let anywhere = Off::of(&bending, Place::Anywhere);
        let [bent, stretched] = self.at_rest;
        let shorter = unstable.softened.max(self.young[0]).max(unstable.crushed * self.first);
        let bent = (bent * shorter).min(1.0).max(bent);
        let stretched = (stretched * self.young[1]).min(1.0).max(stretched);
        let nearly = |size: f64, turned: bool| self.near.map_or(0.0, |near| near.of(size, turned, self.acceleration));
        let near = nearly(wide, false);
        let within = |which: usize, size: f64| self.tolerance.of(which, size);
        // what follows a deflection that is wrong by so much, as what it draws in does, about the square of its slope
        let of_wide = [
            within(0, wide),
            bent + near,
            self.more(
                anywhere.errors.iter().sum::<f64>() / wide.max(f64::MIN_POSITIVE) + within(0, wide) + bent + near,
                grown,
            ),
        ];
        let mut rows = vec![];
        let mut row = |name: Interest, size: f64, off: Off, extra: [f64; 2], grown: f64| {
            if self.counts(name, size, quantities) {
                rows.push(self.row(name, size, off, extra, grown));
            }
        };
        for (name, place, unit) in [
            (Interest::TipU1, Place::Tip, 1.0),
            (Interest::TipAngle, Place::Slope, length),
            (Interest::MidspanU1, Place::Middle, 1.0),
            (Interest::LargestU1, Place::Anywhere, 1.0),
        ] {
            let size = largest(name);
            // a place that hardly moves beside others is where larger motions cancel
            let cancels = 1.0 + CANCELS * wide / (size * unit);
            let extra = [
                within(0, size * unit),
                bent * cancels + nearly(size, place == Place::Slope),
            ];
            row(name, size, Off::of(&bending, place), extra, grown);
        }
        for (name, place, slope) in [
            (Interest::TipU3, Place::Tip, angle),
            (Interest::LargestU3, Place::Anywhere, 2.0 * wide / length),
        ] {
            let size = largest(name);
            let turned = slope.max(angle).max(2.0 * wide / length);
            let share = SQUARED * (turned.powi(2) * length / size).min(1.0);
            let off = Off::of(&axial, place).and(drawn(place, slope));
            let extra = [
                within(1, size) + share * of_wide[0],
                bent.max(stretched).max(share * bent) + share * (near + of_wide[2]),
            ];
            row(name, size, off, extra, 1.0);
        }
        let size = largest(Interest::MaxPressure);
        let share = [self.pressed[0] * wide / size, self.pressed[1] * long / size].map(|x| x.min(1.0));
        let off = Off::of(&bending, Place::Pressure).and(Off::of(&axial, Place::Pressure));
        let extra = [
            self.tolerance.gathered() + share[0] * of_wide[0],
            share[0] * (CURVED * bent + near + of_wide[2]) + share[1] * CURVED * stretched,
        ];
        row(Interest::MaxPressure, size, off, extra, 1.0);
        self.couple.add(&mut rows, [angle, 2.0 * wide / length]);
        // what is put into a beam that nothing pulls does not depend on where it has turned
        let pulled = self.turning.as_ref().is_some_and(Turning::pulled);
        if pulled {
            self.turn(&mut rows, quantities);
        }
        self.energies(&mut rows, quantities, work, [wide, long, angle]);
        if !pulled {
            self.turn(&mut rows, quantities);
        }
        if let Some(strikes) = &self.strikes {
            let displacements = rows
                .iter_mut()
                .filter(|row| row.name.unit() != "J" && row.name.unit() != "Pa");
            displacements.for_each(|row| {
                row.errors = [row.errors[0] + strikes.off(), strikes.multiplied(row.errors[1])];
            });
        }
        self.couple.tell(&mut rows);
        rows
    }

    /// Adds what steps turn the beam wrongly, where it turns freely: a phase, of which largest values hardly know.
    fn turn(&self, rows: &mut [Row], quantities: &BTreeMap<String, Quantity>) {
        let Some(turning) = &self.turning else { return };
        for row in rows {
            let size = quantities.get(row.name.name()).and_then(|q| q.max_abs).unwrap_or(0.0);
            let off = turning.changes(row.name, size, self.floors.length);
            row.errors[0] += off;
            row.phase += off;
        }
    }

    /// True if a quantity of a size is more than round-off, of what the case does and beside others: twice the tolerance of the largest of its unit
    /// is nothing that the run has to resolve.
    fn counts(&self, name: Interest, size: f64, quantities: &BTreeMap<String, Quantity>) -> bool {
        let (unit, own) = self.floors.weighed(name.name(), size);
        let alike = quantities.iter().filter_map(|(other, q)| {
            let (of, size) = self.floors.weighed(other, q.max_abs.or(q.last)?.abs());
            (of == unit).then_some(size)
        });
        let beside = alike.fold(0.0, f64::max);
        let least = (2.0 * self.settings.1).clamp(NOTHING, 1e-4);
        own.is_finite() && own > (least * beside).max(self.floors.of_unit(unit, 0.0))
    }

    /// What an error gains where the deflection grows, no more than all.
    fn more(&self, error: f64, grown: f64) -> f64 {
        (grown * error).min(1.0).max(error) - error
    }

    fn row(&self, name: Interest, size: f64, off: Off, extra: [f64; 2], grown: f64) -> Row {
        let phase = off.errors.map(|x| x / size);
        let errors = [0, 1].map(|k| phase[k] + extra[k]);
        let more = self.more(errors[0] + errors[1], grown);
        Row {
            name,
            errors: [errors[0], errors[1] + more],
            // less than a vibration in the window: its root mean square knows of the phase
            phase: match off.vibrations * self.window < 1.0 {
                true => 0.0,
                false => (phase[0] + phase[1] - off.peaks / size).max(0.0),
            },
            vibrations: off.vibrations,
            shift: off.shift,
            couple: 0.0,
        }
    }
}
