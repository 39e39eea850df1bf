//! Characteristic sizes of the unknowns, estimated from the loads and motions of a case.

use std::f64::consts::PI;

use super::attachments::ForceDirection;
use super::{AttachedBody, Section, Wet};
use crate::case::schema::{Case, Distributed, Load};
use crate::case::{ResolvedEnd, Rotation, Translation};
use crate::functions::profile::Profile;
use crate::functions::signals::{Signal, SmoothTime};
use crate::model::network::Feed;

/// Smallest strain that sets the scales of axial motion.
const LEAST_STRAIN: f64 = 1e-6;

/// Smallest scale of pressures without bladders [Pa].
const LEAST_PRESSURE: f64 = 1e-3;

/// Sizes for relative tolerances, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    /// Transverse displacement, relative to the driven ends [m].
    pub transverse: f64,
    /// Axial displacement, relative to the driven ends [m].
    pub axial: f64,
    /// Transverse velocity [m/s].
    pub transverse_rate: f64,
    /// Axial velocity [m/s].
    pub axial_rate: f64,
    /// Transverse force on a cell [N].
    pub transverse_force: f64,
    /// Axial force on a cell [N].
    pub axial_force: f64,
    /// Bending moment [N m].
    pub moment: f64,
    /// Normal force [N].
    pub force: f64,
    /// Pressure [Pa].
    pub pressure: f64,
    /// Angular frequency [1/s].
    pub frequency: f64,
}

/// Magnitudes of loads and prescribed motions.
#[derive(Clone, Copy, Debug, Default)]
pub struct DriveScales {
    /// Force per length across [N/m].
    pub transverse_load: f64,
    /// Force per length along [N/m].
    pub axial_load: f64,
    /// Forces on the ends across [N].
    pub transverse_force: f64,
    /// Forces on the ends along [N].
    pub axial_force: f64,
    /// Moments [N m].
    pub moment: f64,
    /// Motion of a driven end across [m].
    pub transverse_motion: f64,
    /// Its acceleration [m/s^2].
    pub transverse_acceleration: f64,
    /// Acceleration of a driven end along [m/s^2].
    pub axial_acceleration: f64,
    /// Initial velocity of a driven axial motion from rest [m/s].
    pub axial_jump: f64,
    /// Sum of the axial motions of both ends if both are driven [m].
    pub axial_pull: f64,
    /// Prescribed slope [rad].
    pub slope: f64,
    /// Initial and port pressures [Pa].
    pub pressure: f64,
    /// Highest angular frequency [1/s].
    pub frequency: f64,
}

impl DriveScales {
    /// Drive of a case with the given ends.
    pub fn from_case(case: &Case, section: &Section, ends: &[ResolvedEnd; 2]) -> Self {
        let end = case.time.end_s;
        let length = case.beam.length_m;
        let mut d = Self::default();
        let first_mode = 3.516 / (length * length) * (section.bending_stiffness / section.mass_per_length).sqrt();
        let size = |s: &Signal| s.largest(end).value.max(case.held_at_start(s).abs());
        // A pulse much shorter than the first period bends the beam by its impulse.
        let bends = |s: &Signal| match case.held_at_start(s) {
            0.0 => size(s).min(first_mode * s.impulse(end)),
            _ => size(s),
        };
        for load in &case.loads {
            let m = section.mass_per_length;
            let dist = |l: &Distributed| bends(&l.signal) * l.profile.size();
            let along = |l: &Distributed| size(&l.signal) * l.profile.size();
            match load {
                Load::ForceXNM(l) | Load::ForceNormalNM(l) => d.transverse_load += dist(l),
                Load::ForceZNM(l) | Load::ForceTangentialNM(l) => d.axial_load += along(l),
                Load::MomentXN(l) | Load::MomentZN(l) => d.moment += dist(l) * length,
                Load::BodyXMS2(l) => d.transverse_load += m * dist(l),
                Load::BodyZMS2(l) => d.axial_load += m * along(l),
                Load::RestCurvature(l) => d.moment += section.bending_stiffness * size(&l.signal) * l.profile.size(),
                Load::Gravity { x_m_s2, z_m_s2 } => {
                    d.transverse_load += m * x_m_s2.abs();
                    d.axial_load += m * z_m_s2.abs();
                }
            }
            if let Some((_, l)) = load
                .distributed()
                .filter(|_| !load.is_body() && !matches!(load, Load::MomentXN(_)))
            {
                d.hear(&l.signal, end);
            }
        }
        if let Some(frame) = &case.rotating_frame {
            let most = frame.angular_velocity_rad_s.largest(end);
            let speed = most.value.max(case.held_at_start(&frame.angular_velocity_rad_s).abs());
            let [across, along, distance] = frame.reach(length);
            let (m, square) = (section.mass_per_length, speed * speed);
            let attached: f64 = case.attachments.iter().map(|one| one.mass_kg).sum();
            let [transverse, axial] = [
                square * across + most.rate * distance,
                square * along + most.rate * across,
            ];
            d.transverse_load += m * transverse;
            d.axial_load += m * axial;
            d.transverse_force += attached * transverse;
            d.axial_force += attached * axial;
            d.frequency = d.frequency.max(speed);
            d.hear(&frame.angular_velocity_rad_s, end);
        }
        for attachment in AttachedBody::all(case) {
            for force in &attachment.forces {
                if force.acting == ForceDirection::Weight {
                    let arm = attachment.offset.x.hypot(attachment.offset.z);
                    d.moment += arm * force.factor.abs() * size(&force.signal);
                }
                match force.axis {
                    0 => d.transverse_force += force.factor.abs() * bends(&force.signal),
                    _ => d.axial_force += force.factor.abs() * size(&force.signal),
                }
                d.hear(&force.signal, end);
            }
            d.axial_force += attachment.mass * d.axial_acceleration;
        }
        let both = ends.iter().all(|e| matches!(e.axial, Translation::Displacement(_)));
        for e in ends {
            match &e.transverse {
                Translation::Displacement(s) => {
                    let most = s.largest(end);
                    d.transverse_motion = d.transverse_motion.max(most.value);
                    d.transverse_acceleration = d.transverse_acceleration.max(most.acceleration);
                    d.hear(s, end);
                }
                Translation::Force(s) => d.transverse_force += bends(s),
            }
            match &e.axial {
                Translation::Displacement(s) => {
                    let most = s.largest(end);
                    let start = s.jet(SmoothTime { t: 0.0, within: 0.0 });
                    d.axial_jump = d.axial_jump.max(start.rate.abs());
                    if both {
                        d.axial_pull += most.value;
                    }
                    d.axial_acceleration = d.axial_acceleration.max(most.acceleration);
                    d.hear(s, end);
                }
                Translation::Force(s) => d.axial_force += size(s),
            }
            match &e.rotation {
                Rotation::Slope(s) => d.slope = d.slope.max(size(s)),
                Rotation::Moment(s) => d.moment += bends(s),
            }
            if let Some(f) = &e.follower {
                d.axial_force += size(&f.normal);
                d.transverse_force += bends(&f.shear);
            }
        }
        for start in &case.start.pressures {
            d.pressure = d.pressure.max(start.pressure_pa.size());
        }
        d
    }

    fn hear(&mut self, signal: &Signal, end: f64) {
        if let Some(period) = signal.shortest_unmarked_time_s(end) {
            self.frequency = self.frequency.max(2.0 * PI / period);
        }
    }
}

impl Scales {
    /// The larger of both scales, each.
    pub fn larger(&self, other: &Self) -> Self {
        Self {
            transverse: self.transverse.max(other.transverse),
            axial: self.axial.max(other.axial),
            transverse_rate: self.transverse_rate.max(other.transverse_rate),
            axial_rate: self.axial_rate.max(other.axial_rate),
            transverse_force: self.transverse_force.max(other.transverse_force),
            axial_force: self.axial_force.max(other.axial_force),
            moment: self.moment.max(other.moment),
            force: self.force.max(other.force),
            pressure: self.pressure.max(other.pressure),
            frequency: self.frequency.max(other.frequency),
        }
    }

    /// Estimates all sizes: motions by loads from the linear cantilever, pressures by forces from the sealed bladder,
    /// deflections by pressures. Each has a lower limit.
    pub fn estimate(case: &Case, section: &Section, wet: Option<&Wet>) -> Self {
        Self::pumped(case, section, wet, 0.0)
    }

    /// [`Self::estimate`] with an additional pressure by pumping [Pa].
    pub fn pumped(case: &Case, section: &Section, wet: Option<&Wet>, pressure: f64) -> Self {
        let ends = [case.ends.root.resolve(), case.ends.tip.resolve()];
        let mut d = DriveScales::from_case(case, section, &ends);
        let l = case.beam.length_m;
        let (ea, ei, m) = (
            section.axial_stiffness,
            section.bending_stiffness,
            section.mass_per_length,
        );
        let size = |p: &Option<Profile>| p.as_ref().map_or(0.0, Profile::size);
        let first_mode = 3.516 / (l * l) * (ei / m).sqrt();

        let started = size(&case.start.u1_m).max(size(&case.start.u1_rate_m_s) / first_mode);
        let moment_of_loads = d.moment + d.transverse_force * l + 0.5 * d.transverse_load * l * l + d.slope * ei / l;
        let force_of_loads = d.axial_force
            + d.axial_load * l
            + m * l * d.axial_acceleration
            + d.axial_jump * (ea * m).sqrt()
            + d.axial_pull * ea / l
            + size(&case.start.u3_rate_m_s) * (ea * m).sqrt()
            + size(&case.start.u3_m) * ea / l;
        let (mut curvature, mut stretch) = (0.0, 0.0);
        if let Some(wet) = wet {
            for port in &wet.network.ports {
                let held = case.held_at_start(&port.pressure).abs();
                d.pressure = d.pressure.max(port.pressure.largest(case.time.end_s).value).max(held);
            }
            d.pressure = d.pressure.max(pressure);
            for pump in wet.network.links.iter().filter_map(|link| link.pump.as_ref()) {
                let held = case.held_at_start(&pump.pressure).abs();
                let largest = pump.pressure.largest(case.time.end_s).value.max(held);
                d.pressure = d.pressure.max(pump.largest(largest));
            }
            let heads = wet.network.links.iter().map(|link| link.head.abs());
            d.pressure = heads.fold(d.pressure, f64::max);
            for one in &wet.network.accumulators {
                d.pressure = d.pressure.max(one.start_pressure.abs());
            }
            for source in &wet.network.sources {
                if let Feed::Volume(volume) = &source.feed {
                    let volume = volume
                        .largest(case.time.end_s)
                        .value
                        .max(case.held_at_start(volume).abs());
                    // without storage, only the pressure to drive the flow counts
                    let compliance = wet.network.compliance_at(source.into, wet);
                    if compliance > 0.0 {
                        d.pressure = d.pressure.max(volume / compliance);
                    }
                }
            }
            let moment = moment_of_loads + ei * started / (l * l);
            let sealed =
                (wet.area[0].force_mean * force_of_loads + wet.area[0].moment_mean * moment) / wet.compliance();
            let least = match wet.network.is_dry() {
                true => wet.network.pumped_pressure(wet, case.time.end_s).max(LEAST_PRESSURE),
                false => 1e-7 * case.beam.young_modulus_pa,
            };
            d.pressure = d.pressure.max(sealed).max(least);
            curvature = wet.coupling.curvature(&wet.area, 0.0, d.pressure, 0.0).abs();
            stretch = wet.coupling.stretch(&wet.area, 0.0, d.pressure, 0.0).abs();
        }
        // Relative to driven ends: a beam lags behind one end by at most its motion; two driven ends bend it.
        let both = ends
            .iter()
            .all(|e| matches!(e.transverse, Translation::Displacement(_)));
        let lag = if both {
            d.transverse_motion
        } else {
            d.transverse_motion
                .min(m * d.transverse_acceleration * l.powi(4) / (8.0 * ei))
        };
        let by_load = moment_of_loads * l * l / (3.0 * ei);
        let transverse = case
            .solver
            .transverse_scale_m
            .unwrap_or((lag + by_load + 0.5 * curvature * l * l + started).clamp(1e-5 * l, l));
        // Bending shortens the beam and causes an inertial force along it; pressure stretches it.
        let foreshortening = 0.5 * transverse * transverse / l;
        let force = (force_of_loads
            + (d.transverse_force + d.transverse_load * l) * transverse / l
            + m * l * foreshortening * first_mode * first_mode
            + ea * stretch)
            .max(LEAST_STRAIN * ea);
        let axial = (force * l / ea + foreshortening + size(&case.start.u3_m)).clamp(LEAST_STRAIN * l, 10.0 * l);
        let frequency = first_mode.max(d.frequency);
        // The smallest axial motion counts as a wave: its velocity has the energy of its stretch, up to that of
        // bending.
        let least_axial_rate = (LEAST_STRAIN * 0.5 * PI * (ea / m).sqrt()).min(transverse * frequency);
        Self {
            transverse,
            axial,
            transverse_rate: transverse * frequency,
            axial_rate: (axial * frequency).max(least_axial_rate),
            transverse_force: (ei * transverse / l.powi(3)).max(1e-9 * ei / (l * l)),
            axial_force: force,
            moment: (ei * transverse / (l * l)).max(moment_of_loads).max(1e-6 * ei / l),
            force,
            pressure: d.pressure.max(f64::MIN_POSITIVE),
            frequency,
        }
    }
}
