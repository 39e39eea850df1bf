//! Estimates of the relative error caused by omitting each effect, from the loads and motions of a case (its scene).

mod compression;
mod free_flow;
mod mirror_symmetry;
mod pace;
mod response_bounds;
mod sections;
mod stability;
mod tubes;

use std::cell::OnceCell;
use std::f64::consts::{FRAC_PI_2, PI};

use crate::case::schema::Case;
use crate::case::{ResolvedEnd, Rotation, Translation, spans};
use crate::functions::Signal;
use crate::model::characteristic::first_wave_number;
use crate::model::network::NetworkNode;
use crate::model::scales::DriveScales;
use crate::model::{
    AmbientFluid, AttachedBody, DistributedLoad, FrameRotation, ResolvedNetwork, Scales, Section, Wet, each_signal,
};

use pace::SignalExcitation;
use response_bounds::ResponseBounds;
use stability::SAFE_COMPRESSION;
use tubes::Tubes;

/// The scene of a case, with all effects.
pub struct EffectScene<'a> {
    case: &'a Case,
    section: &'a Section,
    wet: Option<&'a Wet>,
    ends: [ResolvedEnd; 2],
    loads: Vec<DistributedLoad>,
    attachments: Vec<AttachedBody>,
    around: Option<AmbientFluid>,
    scales: Scales,
    drive: DriveScales,
    /// First bending frequency of the drained beam [1/s]; with shear, a lower bound (Dunkerley).
    bending: f64,
    /// Square of the ratio of the bending frequency without shear to that with shear.
    softened: f64,
    /// First axial frequency [1/s].
    axial: f64,
    /// Lowest buckling load of the ends, with shear by Engesser [N].
    buckling: f64,
    /// Paces of axial motions prescribed at ends.
    driven_along: Vec<SignalExcitation>,
    /// Paces of all other signals.
    others: Vec<SignalExcitation>,
    /// Paces of the signals of a network without bladders.
    of_network: Vec<SignalExcitation>,
    instability: OnceCell<Option<String>>,
    least: OnceCell<ResponseBounds>,
    tubes: OnceCell<Tubes>,
}

impl<'a> EffectScene<'a> {
    /// Scene of a case; `wet` contains every effect.
    pub fn new(case: &'a Case, section: &'a Section, wet: Option<&'a Wet>) -> Self {
        let ends = [case.ends.root.resolve(), case.ends.tip.resolve()];
        let mass = section.mass_per_length;
        let length = case.beam.length_m;
        let drive = DriveScales::from_case(case, section, &ends);
        let held = |e: &ResolvedEnd| matches!(e.axial, Translation::Displacement(_));
        let quarter = if held(&ends[0]) == held(&ends[1]) {
            PI
        } else {
            FRAC_PI_2
        };
        let beta = first_wave_number(&ends).unwrap_or(FRAC_PI_2) / length;
        let loads: Vec<DistributedLoad> = case
            .loads
            .iter()
            .flat_map(|load| DistributedLoad::resolve(load, section))
            .collect();
        let mut undriven = ends.clone();
        let mut driven_along = vec![];
        for end in &mut undriven {
            if let Translation::Displacement(signal) = &mut end.axial {
                driven_along.extend(SignalExcitation::from_signal(
                    signal,
                    case.time.end_s,
                    case.held_at_start(signal),
                ));
                *signal = Signal::Constant(0.0);
            }
        }
        let attachments = AttachedBody::all(case);
        let around = AmbientFluid::from_case(case);
        let excitations = |network: Option<&ResolvedNetwork>| {
            let mut all = vec![];
            let frame = FrameRotation::from_case(case);
            each_signal(
                &undriven,
                &loads,
                &attachments,
                around.as_ref(),
                frame.as_ref(),
                network,
                |signal| {
                    let held = case.held_at_start(signal);
                    all.extend(SignalExcitation::from_signal(signal, case.time.end_s, held));
                },
            );
            all
        };
        // a network without bladders does not move the beam; its signals are the last
        let network = wet.map(|wet| &wet.network);
        let others = excitations(network.filter(|network| !network.is_dry()));
        let of_network = excitations(network).split_off(others.len());
        let unsheared = beta * beta * (section.bending_stiffness / mass).sqrt();
        let in_shear = FRAC_PI_2 / length * (section.shear_stiffness / mass).sqrt();
        let softened = 1.0 + (unsheared / in_shear).powi(2);
        let euler = FRAC_PI_2.powi(2) * section.bending_stiffness / (length * length);
        let pumped = wet.map_or(0.0, |wet| wet.network.pumped_pressure(wet, case.time.end_s));
        Self {
            wet,
            loads,
            attachments,
            around,
            driven_along,
            others,
            of_network,
            instability: OnceCell::new(),
            least: OnceCell::new(),
            tubes: OnceCell::new(),
            scales: Scales::pumped(case, section, wet, pumped),
            bending: unsheared / softened.sqrt(),
            softened,
            axial: quarter / length * (section.axial_stiffness / mass).sqrt(),
            buckling: euler / (1.0 + euler / section.shear_stiffness),
            drive,
            ends,
            case,
            section,
        }
    }

    fn network(&self) -> Option<&ResolvedNetwork> {
        self.wet.map(|wet| &wet.network)
    }

    fn signals(&self, visit: impl FnMut(&Signal)) {
        each_signal(
            &self.ends,
            &self.loads,
            &self.attachments,
            self.around.as_ref(),
            FrameRotation::from_case(self.case).as_ref(),
            self.network(),
            visit,
        );
    }

    /// True if the beam starts bent, stretched or moving, or with bladders under pressure.
    fn begins_displaced(&self) -> bool {
        let s = &self.case.start;
        let given = [&s.u1_m, &s.u3_m, &s.u1_rate_m_s, &s.u3_rate_m_s];
        given.iter().any(|profile| profile.is_some()) || self.begins_pressed(true)
    }

    /// True if an end moves, which loads the beam by inertia.
    pub fn driven(&self) -> bool {
        let moves = |motion: &Translation| matches!(motion, Translation::Displacement(s) if !s.is_constant());
        let turns = |turn: &Rotation| matches!(turn, Rotation::Slope(s) if !s.is_constant());
        let driven = |e: &ResolvedEnd| moves(&e.transverse) || moves(&e.axial) || turns(&e.rotation);
        self.ends.iter().any(driven)
    }

    /// Sum of [`SignalExcitation::inertia_ratio`] over all signals; 1 where the beam starts displaced.
    fn inertia_ratio(&self, omega: f64) -> f64 {
        self.inertia_ratio_of(self.others.iter().chain(&self.driven_along), omega)
    }

    fn inertia_ratio_of<'p>(&self, paces: impl Iterator<Item = &'p SignalExcitation>, omega: f64) -> f64 {
        if self.begins_displaced() {
            return 1.0;
        }
        paces.map(|pace| pace.inertia_ratio(omega)).sum()
    }

    /// Inertia of free and forced bending vibrations relative to the static deflection.
    pub fn bending_inertia(&self) -> f64 {
        // compression lowers the frequency; beyond this limit the beam counts as unstable
        let slower = (1.0 - self.pressed().min(SAFE_COMPRESSION)).sqrt();
        self.inertia_ratio(self.bending * slower)
    }

    /// Axial waves relative to the stretch without them. A driven end acts by its acceleration, which must start
    /// smoothly.
    pub fn axial_waves(&self) -> f64 {
        let waves = self.driven_along.iter().map(|pace| pace.waves(self.axial));
        waves.fold(self.inertia_ratio_of(self.others.iter(), self.axial), f64::max)
    }

    /// `(u1/l_s)²`: relative shortening by bending.
    pub fn shortening(&self) -> f64 {
        (self.scales.transverse / self.case.beam.length_m).powi(2)
    }

    /// `φ²` of the largest angle of a cantilever at rest with this deflection or these moments. Sudden loads enlarge
    /// the angle up to threefold. Infinite where the ends do not prevent rotation.
    pub fn rotation(&self) -> f64 {
        let across = |e: &ResolvedEnd| matches!(e.transverse, Translation::Displacement(_));
        let turned = |e: &ResolvedEnd| matches!(e.rotation, Rotation::Slope(_));
        if !self.ends.iter().any(turned) && !self.ends.iter().all(across) {
            return f64::INFINITY;
        }
        let (l, d) = (self.case.beam.length_m, &self.drive);
        let moment = d.moment + d.transverse_force * l + 0.5 * d.transverse_load * l * l;
        let begins = self
            .case
            .start
            .u1_m
            .as_ref()
            .map_or(0.0, |profile| profile.steepness() / l);
        let angle = (2.0 * self.scales.transverse / l).max(moment * l / self.section.bending_stiffness);
        (angle * (1.0 + self.inertia_ratio(self.bending).min(2.0)) + begins + d.slope).powi(2)
    }

    /// Lower bounds of the response to loads.
    fn least(&self) -> &ResponseBounds {
        self.least.get_or_init(|| ResponseBounds::from_scene(self))
    }

    /// True if the initial pressure varies along a bladder.
    pub fn uneven_start(&self) -> bool {
        self.case
            .start
            .pressures
            .iter()
            .any(|start| !start.pressure_pa.is_uniform())
    }

    /// Largest magnitude of the normal force over the buckling load.
    pub fn normal_force(&self) -> f64 {
        self.largest_force() / self.buckling
    }

    /// Largest magnitude of the normal force; up to twice the static value for sudden loads [N].
    fn largest_force(&self) -> f64 {
        self.scales.force * (1.0 + self.inertia_ratio_of(self.others.iter(), self.axial).min(1.0))
    }

    /// Upper bound of the stretch over the lower bound of the shortening by bending.
    pub fn stretch(&self) -> f64 {
        self.largest_force() * self.case.beam.length_m / self.section.axial_stiffness / self.least().drawn_in
    }

    /// Upper bound of the shortening by bending over the lower bound of the stretch; 0 without bending.
    pub fn drawn_in(&self) -> f64 {
        let l = self.case.beam.length_m;
        // shortening if the slope is the largest angle everywhere
        let most = 0.5 * self.rotation() * l;
        if most > 0.0 { most / self.least().stretch } else { 0.0 }
    }

    /// True if the ends support the beam without its inertia.
    pub fn held(&self) -> bool {
        let across = |e: &ResolvedEnd| matches!(e.transverse, Translation::Displacement(_));
        let turned = |e: &ResolvedEnd| matches!(e.rotation, Rotation::Slope(_));
        let along = |e: &ResolvedEnd| matches!(e.axial, Translation::Displacement(_));
        let clamped = self.ends.iter().any(|e| across(e) && turned(e));
        (clamped || self.ends.iter().all(across)) && self.ends.iter().any(along)
    }

    /// True if fluid exchanges energy with the outside: ports with pressure, sources, turbines, pumps, charged
    /// accumulators.
    pub fn fed(&self) -> bool {
        self.network().is_some_and(|n| {
            let pressed = |signal: &Signal| {
                signal.largest(self.case.time.end_s).value > 0.0 || self.case.held_at_start(signal) != 0.0
            };
            n.ports.iter().any(|p| pressed(&p.pressure))
                || !n.sources.is_empty()
                || !n.turbines.is_empty()
                || n.gravity.is_some()
                || n.links.iter().any(|link| link.pump.is_some())
                || n.accumulators.iter().any(|one| one.start_pressure != 0.0)
        })
    }

    /// Fraction of a bladder's volume that its neighbors receive over the whole run, bounded by the sum of
    /// conductances.
    pub fn leakage(&self) -> f64 {
        let Some(wet) = self.wet else { return 0.0 };
        let mut most = vec![0.0; 2 * wet.per_row];
        for link in &wet.network.links {
            for node in [link.from, link.to] {
                if let NetworkNode::Cell { bladder, .. } = node {
                    most[bladder] += 1.0 / link.resistance.max(0.5 * self.bladder_resistance(wet));
                }
            }
        }
        let conductance = most.into_iter().fold(0.0, f64::max);
        2.0 * conductance * self.case.time.end_s / (self.compliances(wet)[0] * wet.bladder_length)
    }

    fn bladder_resistance(&self, wet: &Wet) -> f64 {
        wet.bladder_length / wet.network.bladder_mobility
    }

    /// Smallest and largest area stored per pressure at the scene's pressures [m^2/Pa].
    pub(super) fn compliances(&self, wet: &Wet) -> [f64; 2] {
        let bulging = wet.pressure_correlation().abs();
        [1.0, -1.0].map(|sign| wet.compliance_at(sign * self.scales.pressure) * (1.0 - sign * bulging))
    }

    /// A frequency of the beam with its instantaneous stiffness if the solid relaxes [1/s].
    fn at_once(&self, frequency: f64) -> f64 {
        frequency * self.section.stiffening.sqrt()
    }

    /// Moment and force by pressure over the lower bounds of those by loads, times the phase of the first mode over the
    /// run, since they damp vibrations.
    pub fn strains_of_pressure(&self) -> [f64; 2] {
        let Some(wet) = self.wet else { return [0.0; 2] };
        if wet.network.pumped() {
            return [f64::INFINITY; 2];
        }
        let p = self.scales.pressure;
        let moment = self.section.bending_stiffness * wet.coupling.curvature(&wet.area, 0.0, p, 0.0).abs();
        let force = self.section.axial_stiffness * wet.coupling.stretch(&wet.area, 0.0, p, p).abs();
        let swings = 1.0 + self.bending * self.case.time.end_s;
        let ResponseBounds {
            moment: by_loads,
            force: along,
            ..
        } = *self.least();
        let over = |part: f64, loads: f64| if part > 0.0 { swings * part / loads } else { 0.0 };
        [over(moment, by_loads), over(force, along)]
    }

    /// Bound of the section's energy beyond its quadratic part over the quadratic energy. It covers all states up to
    /// the expected stretch, curvature and pressure. Sudden loads enlarge curvature and pressure up to threefold.
    pub fn strain_energy(&self) -> f64 {
        let law = self.wet.and_then(|wet| Some((wet, wet.strain_energy.as_ref()?)));
        let Some((wet, law)) = law else { return 0.0 };
        // sections without bladders have no such energy
        let sections = Section::of_segments(self.case, &spans::segments(self.case));
        let own = (0..wet.per_row).find(|j| wet.strain_energy_of(*j).is_some());
        let own = own.and_then(|j| sections.get(j)).unwrap_or(self.section);
        let (ea, ei) = (own.axial_stiffness, own.bending_stiffness);
        let sudden = 1.0 + self.inertia_ratio(self.bending).min(2.0);
        let pressure = self.scales.pressure * sudden;
        let stored = wet.length_ratio(self.case.beam.length_m) * wet.area[0].per_pressure;
        law.share(
            [ea, ei, stored],
            [self.largest_force() / ea, sudden * self.scales.moment / ei, pressure],
        )
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
}
