//! What the scene does to the beam, in the numbers by which effects are left out: each estimates the relative error that
//! leaving one out makes.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::case::schema::{BladderEnd, Case, Formulation};
use crate::case::{Clock, ResolvedEnd, Rotation, Signal, Translation};
use crate::model::characteristic::{MATHIEU_COUPLING, first_wave_number, mathieu_growth};
use crate::model::network::{Link, Node};
use crate::model::scales::{Drive, largest};
use crate::model::{Load, Network, Scales, Section, Wet, each_signal};

/// A scene, before anything is left out.
pub struct Scene<'a> {
    case: &'a Case,
    section: &'a Section,
    wet: Option<&'a Wet>,
    ends: [ResolvedEnd; 2],
    loads: Vec<Load>,
    scales: Scales,
    drive: Drive,
    /// First bending frequency of the drained beam [1/s].
    bending: f64,
    /// First axial frequency [1/s].
    axial: f64,
    /// Least buckling load that the ends allow [N].
    buckling: f64,
}

/// Force beyond which, as a part of the buckling load, nothing that bends is left out.
const SAFE_COMPRESSION: f64 = 0.3;

impl<'a> Scene<'a> {
    /// Of a case; `wet` with every effect.
    pub fn new(case: &'a Case, section: &'a Section, wet: Option<&'a Wet>) -> Self {
        let ends = [case.ends.root.resolve(), case.ends.tip.resolve()];
        let mass = section.mass_per_length;
        let length = case.beam.length_m;
        let drive = Drive::of(case, section, &ends);
        let held = |e: &ResolvedEnd| matches!(e.axial, Translation::Displacement(_));
        let quarter = if held(&ends[0]) == held(&ends[1]) {
            PI
        } else {
            FRAC_PI_2
        };
        let beta = first_wave_number(&ends).unwrap_or(FRAC_PI_2) / length;
        Self {
            wet,
            loads: case.loads.iter().flat_map(|load| Load::resolve(load, mass)).collect(),
            scales: Scales::estimate(case, section, wet),
            bending: beta * beta * (section.bending_stiffness / mass).sqrt(),
            axial: quarter / length * (section.axial_stiffness / mass).sqrt(),
            buckling: FRAC_PI_2.powi(2) * section.bending_stiffness / (length * length),
            drive,
            ends,
            case,
            section,
        }
    }

    fn network(&self) -> Option<&Network> {
        self.wet.map(|wet| &wet.network)
    }

    fn signals(&self, visit: impl FnMut(&Signal)) {
        each_signal(&self.ends, &self.loads, self.network(), visit);
    }

    /// Whether the beam begins bent, stretched, moving, or with bladders under pressure.
    fn begins_displaced(&self) -> bool {
        let s = &self.case.start;
        let given = [&s.u1_m, &s.u3_m, &s.u1_rate_m_s, &s.u3_rate_m_s];
        given.iter().any(|profile| profile.is_some()) || !s.pressures.is_empty()
    }

    /// Whether an end moves otherwise than at rest, which acts on the beam by its inertia.
    pub fn driven(&self) -> bool {
        let moves = |motion: &Translation| matches!(motion, Translation::Displacement(s) if !s.is_constant());
        let turns = |turn: &Rotation| matches!(turn, Rotation::Slope(s) if !s.is_constant());
        let driven = |e: &ResolvedEnd| moves(&e.transverse) || moves(&e.axial) || turns(&e.rotation);
        self.ends.iter().any(driven)
    }

    /// How much of its motion something of the angular frequency `ω` owes to inertia, when everything acts on it that the case
    /// prescribes: `s''/(ω² s)` of a smooth signal, `Δs'/(ω s)` and `Δs/s` where it jumps, as it does at the start.
    fn haste(&self, omega: f64) -> f64 {
        if self.begins_displaced() {
            return 1.0;
        }
        let end = self.case.time.end_s;
        let mut most = 0.0_f64;
        self.signals(|signal| {
            let (size, _, acceleration) = largest(signal, end);
            if size == 0.0 {
                return;
            }
            most = most.max(acceleration / (omega * omega * size));
            let mut before = (0.0, 0.0);
            for (from, to) in signal.smooth_intervals(end) {
                let within = 0.5 * (from + to);
                let (a, b) = [from, to].map(|t| signal.jet(Clock { t, within })).into();
                most = most.max((a.value - before.0).abs() / size);
                most = most.max((a.rate - before.1).abs() / (omega * size));
                before = (b.value, b.rate);
            }
        });
        most
    }

    /// Free bending vibrations and the inertia of forced ones, relative to the static deflection.
    pub fn bending_inertia(&self) -> f64 {
        self.haste(self.bending)
    }

    /// Axial waves, relative to the stretch without them; a driven end acts by its acceleration, which must begin smoothly.
    pub fn axial_waves(&self) -> f64 {
        let mut waves = self.haste_of_loads();
        for end in &self.ends {
            let Translation::Displacement(signal) = &end.axial else {
                continue;
            };
            let (_, _, acceleration) = largest(signal, self.case.time.end_s);
            if acceleration == 0.0 {
                continue;
            }
            let period = signal.fastest_period_s().unwrap_or(f64::INFINITY);
            let mut before = (0.0, 0.0);
            for (from, to) in signal.smooth_intervals(self.case.time.end_s) {
                let within = 0.5 * (from + to);
                let (a, b) = [from, to].map(|t| signal.jet(Clock { t, within })).into();
                waves = waves.max((a.rate - before.0).abs() * self.axial / acceleration);
                waves = waves.max((a.acceleration - before.1).abs() / acceleration);
                before = (b.rate, b.acceleration);
            }
            waves = waves.max((2.0 * PI / (period * self.axial)).powi(2));
        }
        waves
    }

    /// [`Self::haste`] of what is not a driven end, for axial waves.
    fn haste_of_loads(&self) -> f64 {
        let mut others = Self {
            ends: self.ends.clone(),
            loads: self.loads.clone(),
            ..Self::new(self.case, self.section, self.wet)
        };
        for end in &mut others.ends {
            if matches!(end.axial, Translation::Displacement(_)) {
                end.axial = Translation::Displacement(Signal::Constant(0.0));
            }
        }
        others.haste(self.axial)
    }

    /// `(u1/l_s)²`: how much bending shortens the beam.
    pub fn shortening(&self) -> f64 {
        (self.scales.transverse / self.case.beam.length_m).powi(2)
    }

    /// `φ²`, of the largest angle that a cantilever of this deflection has.
    pub fn rotation(&self) -> f64 {
        (2.0 * self.scales.transverse / self.case.beam.length_m)
            .max(self.drive.slope)
            .powi(2)
    }

    /// `y11 k²/2`, what rotary inertia changes the second bending frequency by.
    pub fn rotary(&self) -> f64 {
        let wave_number = 4.694_091_132_974 / self.case.beam.length_m;
        0.5 * self.section.gyration_radius_squared * wave_number * wave_number
    }

    /// Largest normal force over the buckling load.
    pub fn compression(&self) -> f64 {
        self.scales.force / self.buckling
    }

    /// Stretch over how much bending draws the beam in.
    pub fn stretch(&self) -> f64 {
        let (l, w) = (self.case.beam.length_m, self.scales.transverse);
        self.scales.force * l / self.section.axial_stiffness / (0.5 * w * w / l)
    }

    /// What speaks against leaving out how the beam bends, if anything does: buckling, follower loads, parametric excitation,
    /// resonance, a coupling that gives energy.
    pub fn unstable(&self) -> Option<String> {
        let compression = self.compression();
        if compression > SAFE_COMPRESSION {
            return Some(format!(
                "normal forces may reach {compression:.1e} of the buckling load"
            ));
        }
        if self.ends.iter().any(|e| e.follower.is_some()) {
            return Some("follower loads may make it flutter".into());
        }
        let shaken = self.ends.iter().find_map(|e| match &e.axial {
            Translation::Displacement(signal) if !signal.is_constant() => Some(signal),
            _ => None,
        });
        if let Some(signal) = shaken
            && let Some(why) = self.tongue(signal)
        {
            return Some(why);
        }
        let excess = self.wet.map_or(0.0, |wet| {
            let sum = wet.coupling.curvature(&wet.area, 0.0, 1.0, 0.0) * self.section.bending_stiffness;
            2.0 * sum * wet.area.moment_mean / wet.area.per_pressure
        });
        (excess > 0.5).then(|| format!("pressure feeds {excess:.1e} of a bending moment back"))
    }

    /// Whether shaking along the beam may make it bend: Mathieu's equation, with margin in size, frequency and stiffness.
    fn tongue(&self, signal: &Signal) -> Option<String> {
        let Signal::Sine(sine) = signal else {
            return Some("it is shaken along, by more than a sine".into());
        };
        let omega = 2.0 * PI * sine.frequency_hz;
        let pull = MATHIEU_COUPLING * sine.amplitude.abs() * omega * omega / self.case.beam.length_m;
        let stiffer = 1.0 + self.stiffening();
        for amplitude in [1.0, 1.5] {
            for part in [0.8, 0.9, 1.0, 1.1, 1.25] {
                for stiffness in [1.0, stiffer] {
                    let growth = mathieu_growth(stiffness * self.bending.powi(2), amplitude * pull, part * omega);
                    if growth > 0.0 {
                        return Some(format!(
                            "shaking along grows bending at {growth:.1} 1/s, {amplitude} times as strong and {part} times as fast"
                        ));
                    }
                }
            }
        }
        None
    }

    /// `2 EI φ_b l_b am²/a_p`, how much sealed bladders stiffen the beam.
    fn stiffening(&self) -> f64 {
        self.wet.map_or(0.0, |wet| {
            let area = &wet.area;
            let density = wet.per_row as f64 / self.case.beam.length_m * wet.bladder_length;
            2.0 * self.section.bending_stiffness * density * area.moment_mean.powi(2) / area.per_pressure
        })
    }

    /// Whether a drive comes near the first bending frequency, which then swings up to more than the loads alone tell.
    pub fn resonant(&self) -> bool {
        let mut near = false;
        self.signals(|signal| {
            if let Some(period) = signal.fastest_period_s() {
                near |= 2.0 * PI / period > 0.4 * self.bending;
            }
        });
        near
    }

    /// Whether the ends hold the beam without its inertia.
    pub fn held(&self) -> bool {
        let across = |e: &ResolvedEnd| matches!(e.transverse, Translation::Displacement(_));
        let turned = |e: &ResolvedEnd| matches!(e.rotation, Rotation::Slope(_));
        let along = |e: &ResolvedEnd| matches!(e.axial, Translation::Displacement(_));
        let clamped = self.ends.iter().any(|e| across(e) && turned(e));
        (clamped || self.ends.iter().all(across)) && self.ends.iter().any(along)
    }

    /// Whether upper and lower row are each other's mirror image: tubes, ports, start.
    pub fn mirrored(&self) -> bool {
        let Some(wet) = self.wet else { return true };
        let network = &wet.network;
        let plain = network.junctions.is_empty() && network.bridges.is_empty() && network.sources.is_empty();
        let quiet_start = self.case.start.pressures.is_empty();
        let other = |bladder: usize| (bladder + wet.per_row) % (2 * wet.per_row);
        // a link by what it does: its ends in any order, whatever way a bladder is passed
        let seen = |link: &Link, mirror: bool| {
            let end = |node: Node| match node {
                Node::Cell { bladder, end } => {
                    let bladder = if mirror { other(bladder) } else { bladder };
                    (0, bladder, usize::from(end == BladderEnd::Outlet), 0)
                }
                Node::Junction(j) => (1, j, 0, 0),
                Node::Port(p) => {
                    let signal = &network.ports[p].pressure;
                    let constant = if signal.is_constant() {
                        signal.value(0.0).to_bits()
                    } else {
                        u64::MAX
                    };
                    (2, 0, 0, constant)
                }
            };
            let mut ends = [end(link.from), end(link.to)];
            ends.sort_unstable();
            (ends, link.resistance.to_bits())
        };
        let sorted = |mirror: bool| {
            let mut all: Vec<_> = network.links.iter().map(|link| seen(link, mirror)).collect();
            all.sort_unstable();
            all
        };
        let steady = network.ports.iter().all(|p| p.pressure.is_constant());
        let fixed = network.links.iter().all(|link| link.opening.is_none());
        plain && quiet_start && steady && fixed && sorted(false) == sorted(true)
    }

    /// Part of a bladder's volume that its fastest neighbours take in the whole run: bounded by the sum of conductances.
    pub fn leakage(&self) -> f64 {
        let Some(wet) = self.wet else { return 0.0 };
        let mut most = vec![0.0; 2 * wet.per_row];
        for link in &wet.network.links {
            for node in [link.from, link.to] {
                if let Node::Cell { bladder, .. } = node {
                    most[bladder] += 1.0 / link.resistance.max(0.5 * self.bladder_resistance(wet));
                }
            }
        }
        let conductance = most.into_iter().fold(0.0, f64::max);
        2.0 * conductance * self.case.time.end_s / (wet.area.per_pressure * wet.bladder_length)
    }

    fn bladder_resistance(&self, wet: &Wet) -> f64 {
        wet.bladder_length / wet.network.bladder_mobility
    }

    /// `ω a_p l_b² μ/(π² q1b)`, ω of the fastest motion that is excited.
    pub fn lag_along_bladders(&self, tolerance: f64) -> f64 {
        let Some(wet) = self.wet else { return 0.0 };
        let mut omega = 0.0_f64;
        self.signals(|signal| {
            if let Some(period) = signal.fastest_period_s() {
                omega = omega.max(2.0 * PI / period);
            }
        });
        for (inertia, free) in [(self.bending_inertia(), self.bending), (self.axial_waves(), self.axial)] {
            if inertia > tolerance {
                omega = omega.max(free);
            }
        }
        omega * wet.area.per_pressure * wet.bladder_length.powi(2) / (PI * PI * wet.network.bladder_mobility)
    }

    /// Moment and force that pressure causes, over those of the loads; over the whole run where vibrations are damped by it.
    pub fn strains_of_pressure(&self) -> [f64; 2] {
        let Some(wet) = self.wet else { return [0.0; 2] };
        let p = self.scales.pressure;
        let moment = self.section.bending_stiffness * wet.coupling.curvature(&wet.area, 0.0, p, 0.0).abs();
        let force = self.section.axial_stiffness * wet.coupling.stretch(&wet.area, 0.0, p, p).abs();
        let swings = 1.0 + self.bending * self.case.time.end_s;
        let l = self.case.beam.length_m;
        let d = &self.drive;
        let moment_of_loads = d.moment + d.transverse_force * l + 0.5 * d.transverse_load * l * l;
        let force_of_loads = d.axial_force + d.axial_load * l + self.section.mass_per_length * l * d.axial_acceleration;
        let over = |part: f64, loads: f64| if part > 0.0 { swings * part / loads } else { 0.0 };
        [over(moment, moment_of_loads), over(force, force_of_loads)]
    }

    /// `dm/am`, `dn/an`.
    pub fn asymmetries(&self) -> [f64; 2] {
        let Some(b) = &self.case.bladders else { return [0.0; 2] };
        let (m, n) = (&b.area_per_moment_m2_per_n_m, &b.area_per_force_m2_per_n);
        let ratio = |large: f64, small: f64| {
            if large + small > 0.0 {
                (large - small) / (large + small)
            } else {
                0.0
            }
        };
        [ratio(m.closing, m.opening), ratio(n.compression, n.tension)]
    }

    /// Whether the momentum balance is the published one.
    pub fn published(&self) -> bool {
        self.case.formulation == Formulation::Published
    }
}
