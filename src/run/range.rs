//! Validity limits of the model: limits above which a run warns, and limits at which it ends.

use serde::{Deserialize, Serialize};

use super::cubic::Cubic;
use super::unphysical::{Unphysical, UnphysicalRecord};
use crate::case::schema::{Case, Effect};
use crate::case::spans;
use crate::discrete::System;
use crate::discrete::extrema::{MonitoredQuantity, MonitoredValues};
use crate::error::Code;
use crate::error::numbers::quantity;
use crate::model::{ContactLaw, Wet, audit};

/// Fiber strain above which a run warns.
pub const STRAIN: f64 = 0.5;
/// Reynolds number above which a run warns.
pub const REYNOLDS: f64 = 100.0;
/// Mach number above which a run warns.
pub const MACH: f64 = 0.3;
/// Fraction of the absolute ambient pressure below which gas ends a run.
const VACUUM: f64 = 1e-3;
/// Fiber strain above which a linear law is meaningless: a fiber compressed by this strain has no length left.
const STRAIN_ENDS: f64 = 1.0;
/// Ratio of pressure to Young's modulus above which the model of the body around a bladder is invalid.
const PRESSURE_ENDS: f64 = 10.0;
/// Motion of a node relative to the root, over the length of the beam, that no strain can produce.
const MOTION_ENDS: f64 = 1e3;

/// Validity limits of a case.
#[derive(Clone, Debug)]
pub struct Limits {
    /// Depth behind the face of an obstacle above which a run warns: half the beam's height, or half the bend radius at a circle [m].
    pub depth: f64,
    length: f64,
    modulus: f64,
    /// Area change at which a bladder fills the half section of its segment [m^2].
    swelling: f64,
    /// `p_u + p_d` up to which the potential is convex [Pa].
    convex_up_to: f64,
    /// `2 ρ/(π μ)`: Reynolds number of a tube over its flow by radius [s/m^2]; 0 if the model includes tube losses.
    reynolds_per_flow: f64,
    /// `√ρ_0`: Mach number of a tube over the value that is watched.
    mach_per_flow: f64,
    /// Effects of the model that limit the flow in tubes, as text.
    held_back: &'static str,
    /// Pressure at or below which gas counts as evacuated [Pa].
    vacuum: f64,
    /// True if the case starts at an equilibrium.
    pub(super) at_rest: bool,
    /// Limits of physical results.
    pub unphysical: Unphysical,
}

/// An exceeded limit: the largest value with its time and place, and the time at which the limit was first exceeded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Passed {
    largest: f64,
    t: f64,
    place: usize,
    began: Option<f64>,
}

/// Limits of the model's range that a run exceeded.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Range {
    strain: Passed,
    reynolds: Passed,
    #[serde(default)]
    mach: Passed,
    pressed: Passed,
    #[serde(default)]
    touched: Passed,
    /// Depth of the beam behind the face of an obstacle at a start that is not an equilibrium [m].
    #[serde(default)]
    begun: f64,
    #[serde(default)]
    unphysical: UnphysicalRecord,
}

impl Passed {
    /// Adds a value over a step from `before`; `factor` converts the watched value to the limited one.
    fn take(
        &mut self,
        which: MonitoredQuantity,
        factor: f64,
        limit: f64,
        before: Option<&MonitoredValues>,
        now: &MonitoredValues,
        place: usize,
    ) {
        let value = factor * now.value_and_rate(which)[0];
        if value > self.largest {
            (self.largest, self.t, self.place) = (value, now.t, place);
        }
        if value > limit && self.began.is_none() {
            let within = before.filter(|b| b.t < now.t && factor * b.value_and_rate(which)[0] <= limit);
            self.began = Some(within.map_or(now.t, |before| {
                let h = now.t - before.t;
                let cubic = Cubic::new(before.value_and_rate(which), now.value_and_rate(which), h);
                before.t + h * cubic.crosses(limit / factor, 1.0)
            }));
        }
    }

    /// Describes the largest value with its time and place, and the start of exceedance. `None` if the limit was not exceeded.
    fn excess(&self, digits: usize, place: String, limit: f64) -> Option<String> {
        let began = self.began?;
        let (largest, t) = (self.largest, self.t);
        Some(format!(
            "reached {largest:.digits$} at t = {t:.4} s{place} (above {limit} from t = {began:.4} s on)"
        ))
    }
}

fn in_tube(passed: &Passed) -> String {
    format!(" in tube {}", passed.place + 1)
}

impl Limits {
    /// Limits of a case.
    pub fn new(case: &Case, system: &System) -> Self {
        let wet = system.model.wet.as_ref();
        let convex_up_to = wet.map_or(f64::INFINITY, |wet| {
            let (bending, stretch) = audit::convex_up_to(&system.model, wet);
            bending.min(stretch)
        });
        let room = |j: usize, wet: &Wet| {
            let section = system.model.section_of(j);
            let there = || {
                wet.pair(j)
                    .into_iter()
                    .filter(|bladder| wet.has(*bladder))
                    .map(|bladder| wet.area_at_rest_of(bladder))
            };
            // the rows share the section by their areas
            let all: f64 = there().sum();
            let pitch = system.mesh.segment_lengths[j];
            let room = |area: f64| pitch * 2.0 * section.half_height * (area / all) - area;
            there().map(room).reduce(f64::min)
        };
        Self {
            depth: system
                .model
                .contacts
                .iter()
                .filter_map(ContactLaw::bend_radius)
                .fold(0.5 * case.beam.height_m, |least, radius| least.min(0.5 * radius)),
            length: system.model.length,
            modulus: match case.bladders {
                Some(_) => spans::softest_modulus(case),
                None => f64::INFINITY,
            },
            swelling: wet.map_or(f64::INFINITY, |wet| {
                (0..wet.per_row)
                    .filter_map(|j| room(j, wet))
                    .fold(f64::INFINITY, f64::min)
            }),
            convex_up_to,
            reynolds_per_flow: match &case.fluid {
                Some(f) if !system.model.effects.has(Effect::TubeLosses) => {
                    2.0 * f.density_kg_m3 / (std::f64::consts::PI * f.viscosity_pa_s)
                }
                _ => 0.0,
            },
            mach_per_flow: case.fluid.as_ref().map_or(0.0, |f| f.density_kg_m3.sqrt()),
            held_back: match [Effect::TubeInertia, Effect::TubeLosses].map(|effect| system.model.effects.has(effect)) {
                [false, false] => "friction alone",
                [true, false] => "friction and inertia alone",
                [false, true] => "friction and losses alone",
                [true, true] => "friction, losses and inertia alone",
            },
            unphysical: Unphysical::new(case, system),
            at_rest: case.start.equilibrium.is_some(),
            vacuum: wet
                .and_then(|wet| wet.compression.as_ref())
                .map_or(f64::NEG_INFINITY, |compression| compression.lowest() * (1.0 - VACUUM)),
        }
    }

    /// Reynolds number of the fastest flow through a tube in a state; 0 if the model includes tube losses.
    pub fn reynolds(&self, g: &MonitoredValues) -> f64 {
        self.reynolds_per_flow * g.value_and_rate(MonitoredQuantity::Flow)[0]
    }

    /// Mach number of the fastest flow of gas through a tube in a state.
    pub fn mach(&self, g: &MonitoredValues) -> f64 {
        self.mach_per_flow * g.value_and_rate(MonitoredQuantity::Mach)[0]
    }

    /// True if a state lies within the model's range.
    fn hold(&self, g: &MonitoredValues) -> bool {
        let value = |which| g.value_and_rate(which)[0];
        let pressure = value(MonitoredQuantity::High)
            .abs()
            .max(value(MonitoredQuantity::Low).abs());
        value(MonitoredQuantity::Opening) > 0.0
            && value(MonitoredQuantity::Low) > self.vacuum
            && g.thinnest > self.vacuum
            && value(MonitoredQuantity::Swelling) <= self.swelling
            && value(MonitoredQuantity::Strain) <= STRAIN_ENDS
            && value(MonitoredQuantity::Outermost) <= 1.0
            && pressure <= PRESSURE_ENDS * self.modulus
            && g.moved <= MOTION_ENDS * self.length
    }

    /// Describes the limit that a state exceeds, if any.
    pub fn beyond(&self, g: &MonitoredValues) -> Option<String> {
        if self.hold(g) {
            return None;
        }
        let at = match g.t {
            t if t.abs() < 1e-3 => format!("t = {}", quantity(t, "s", 4)),
            t => format!("t = {t:.6} s"),
        };
        self.beyond_at(g, &at)
    }

    /// Describes the limit that a state exceeds, if any, with the time or place `at`.
    pub fn beyond_at(&self, g: &MonitoredValues, at: &str) -> Option<String> {
        if self.hold(g) {
            return None;
        }
        let value = |which| g.value_and_rate(which)[0];
        if value(MonitoredQuantity::Opening) <= 0.0 {
            return Some(format!(
                "a bladder is closed at {at}: its cross-section h_b w_b + a1 has reached zero, the limit of the model"
            ));
        }
        if value(MonitoredQuantity::Low) <= self.vacuum {
            return Some(format!(
                "a bladder is evacuated at {at}: less than a thousandth of ambient pressure is left in it, the limit \
                 of the model"
            ));
        }
        if g.thinnest <= self.vacuum {
            return Some(format!(
                "a vessel, a junction, or the point from which a port pumps is evacuated at {at}: less than a \
                 thousandth of ambient pressure is left there. A tube passes only the gas that its pressure \
                 difference drives"
            ));
        }
        let swelling = value(MonitoredQuantity::Swelling);
        if swelling > self.swelling {
            return Some(format!(
                "a bladder has outgrown its segment at {at}: its cross-section h_b w_b + a1 has reached the half \
                 section l_seg h_s/2 that contains it (a1 = {})",
                quantity(swelling, "m^2", 4)
            ));
        }
        if value(MonitoredQuantity::Outermost) > 1.0 {
            return Some(format!(
                "a section has left the range of its strain energy at {at}: stretch, curvature and pressures, each \
                 relative to its limit in /bladders/strain_energy, have a sum of squares above 1"
            ));
        }
        let strain = value(MonitoredQuantity::Strain);
        if strain > STRAIN_ENDS {
            return Some(format!(
                "the fibre strain |lambda - 1| + |kappa| h_s/2 has reached {STRAIN_ENDS} at {at}, node {}: a law \
                 linear in the strain is invalid there",
                g.strained
            ));
        }
        let pressure = value(MonitoredQuantity::High)
            .abs()
            .max(value(MonitoredQuantity::Low).abs());
        if pressure > PRESSURE_ENDS * self.modulus {
            return Some(format!(
                "a pressure has reached {PRESSURE_ENDS} times Young's modulus at {at} ({})",
                quantity(pressure, "Pa", 4)
            ));
        }
        Some(format!(
            "a node has reached a displacement of {MOTION_ENDS} beam lengths relative to the root at {at} ({})",
            quantity(g.moved, "m", 4)
        ))
    }

    /// True if the state at a value between two steps must be evaluated. The value is then near or above a limit; if `seen` has a
    /// record of it, the value also exceeds this.
    pub fn matters(&self, which: MonitoredQuantity, value: f64, seen: &Range) -> bool {
        let larger = |largest: f64, value: f64, from: f64| value > 0.9 * from && value > 1.001 * largest;
        match which {
            MonitoredQuantity::Opening => value < 0.05,
            MonitoredQuantity::Swelling => value > 0.95 * self.swelling,
            MonitoredQuantity::Strain => larger(seen.strain.largest, value, STRAIN),
            MonitoredQuantity::Flow => larger(seen.reynolds.largest, value * self.reynolds_per_flow, REYNOLDS),
            MonitoredQuantity::Mach => larger(seen.mach.largest, value * self.mach_per_flow, MACH),
            MonitoredQuantity::Outermost => value > 0.95,
            MonitoredQuantity::Depth => larger(seen.touched.largest, value, self.depth),
            MonitoredQuantity::Pressed => larger(seen.pressed.largest, value, self.convex_up_to),
            _ => false,
        }
    }
}

impl Range {
    /// Adds a state at the end of a step that began at `before`.
    pub fn take(&mut self, limits: &Limits, before: Option<&MonitoredValues>, now: &MonitoredValues) {
        self.strain
            .take(MonitoredQuantity::Strain, 1.0, STRAIN, before, now, now.strained);
        let factor = limits.reynolds_per_flow;
        self.reynolds
            .take(MonitoredQuantity::Flow, factor, REYNOLDS, before, now, now.tube);
        self.mach.take(
            MonitoredQuantity::Mach,
            limits.mach_per_flow,
            MACH,
            before,
            now,
            now.fast,
        );
        self.pressed
            .take(MonitoredQuantity::Pressed, 1.0, limits.convex_up_to, before, now, 0);
        self.touched
            .take(MonitoredQuantity::Depth, 1.0, limits.depth, before, now, 0);
        self.unphysical.take(&limits.unphysical, now, now.t);
        if now.t == 0.0 && !limits.at_rest {
            self.begun = self.begun.max(now.value_and_rate(MonitoredQuantity::Depth)[0]);
        }
    }

    /// Warnings of the exceeded limits.
    pub fn warnings(&self, limits: &Limits) -> Vec<String> {
        let at = |t: f64| format!("t = {t:.4} s");
        let unphysical = &limits.unphysical;
        let mut all = unphysical.warnings(&self.unphysical, &at, "Reduce the load or /time/end_s");
        if let Some(excess) = self.strain.excess(2, format!(", node {}", self.strain.place), STRAIN) {
            all.push(Code::Strain.warning(format!(
                "range of the model: the largest fibre strain |lambda - 1| + |kappa| h_s/2 {excess}. The model \
                 assumes small strains. Use later shapes only qualitatively."
            )));
        }
        if let Some(excess) = self.reynolds.excess(0, in_tube(&self.reynolds), REYNOLDS) {
            all.push(Code::FastFlow.warning(format!(
                "range of the model: the Reynolds number {excess}. The model assumes creeping flow. Pressures are \
                 estimates. Use --set '/effects/tube_losses=\"on\"'."
            )));
        }
        if let Some(excess) = self.mach.excess(2, in_tube(&self.mach), MACH) {
            all.push(Code::FastGas.warning(format!(
                "range of the model: the Mach number {excess}. The model limits the flow by {}. A tube passes at most \
                 Mach 1, so the real flow is slower than the computed one.",
                limits.held_back
            )));
        }
        if self.begun > 0.0 {
            all.push(Code::BeyondRange.warning(format!(
                "contact: the beam begins {} behind the surface of an obstacle or a beam, which pushes it out. Begin in front \
                 of it, or with /start/equilibrium.",
                quantity(self.begun, "m", 4)
            )));
        }
        if let Some(began) = self.touched.began {
            all.push(Code::BeyondRange.warning(format!(
                "contact: the beam is pressed {} into an obstacle or a beam at t = {:.4} s (limit half its height or half the \
                 bend radius at a circle, {}; exceeded from t = {began:.4} s on). Use a stiffer contact.",
                quantity(self.touched.largest, "m", 4),
                self.touched.t,
                quantity(limits.depth, "m", 4)
            )));
        }
        if let Some(began) = self.pressed.began {
            all.push(Code::LostConvexity.warning(format!(
                "the kinked reciprocal potential lost convexity at t = {began:.4} s: p_u + p_d reached {} (limit {}). \
                 Later results are not reliable. Use \"reciprocal\" or a larger kink_width.",
                quantity(self.pressed.largest, "Pa", 4),
                quantity(limits.convex_up_to, "Pa", 4)
            )));
        }
        all
    }
}
