//! Checks of functions of time and place: valid tables, values in range, no jumps of motions, streams, rotations or volumes.

use super::time::END;
use crate::case::faults::Violations;
use crate::case::locate::child;
use crate::case::numbers::plain;
use crate::case::schema::{Attachment, Case, ChainEnd, Distributed, End, Formulation, Load};
use crate::error::numbers::counted;
use crate::error::{Code, Violation};
use crate::functions::MOST_KNOTS;
use crate::functions::profile::Profile;
use crate::functions::signals::{Signal, Table};

/// Highest plausible frequency [Hz].
const HIGHEST_FREQUENCY: f64 = 1e6;

/// Largest steepness of a logistic step [1/s]; beyond it, the time steps become too small for the run to end.
const STEEPEST: f64 = 1e8;

/// Kind of quantity that a signal drives.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Role {
    Motion,
    Stream,
    Rotation,
    Volume,
    Opening,
    Other,
}

impl Role {
    /// Quantity that must not jump, and the quantity that a jump would make infinite.
    fn of_jumps(self) -> Option<[&'static str; 2]> {
        match self {
            Self::Motion => Some(["motion", "velocity"]),
            Self::Stream => Some(["stream", "force"]),
            Self::Rotation => Some(["angular velocity", "angular acceleration"]),
            Self::Volume => Some(["volume", "flow"]),
            Self::Opening | Self::Other => None,
        }
    }
}

/// Largest overshoot of a spline that is not reported, relative to the range of the table's values.
const SWINGS: f64 = 0.01;

/// Splines that overshoot their points, each with its pointer and its overshoot relative to the range of its values.
pub fn overshoots(case: &Case) -> Vec<(String, f64)> {
    let signals = signals(case)
        .into_iter()
        .map(|(at, _, signal)| (at, signal.overshoot()));
    let profiles = profiles(case)
        .into_iter()
        .map(|(at, profile)| (at, profile.overshoot()));
    signals.chain(profiles).filter(|(_, by)| *by > SWINGS).collect()
}

/// All signals, each with its pointer and a flag: true if the signal may jump. Motions, streams, rotations and volumes must
/// not jump.
pub fn controls(case: &Case) -> Vec<(String, bool, &Signal)> {
    let all = signals(case).into_iter();
    all.map(|(at, role, signal)| (at, role.of_jumps().is_none(), signal))
        .collect()
}

pub(super) fn check(case: &Case, faults: &mut Violations) {
    for (pointer, role, signal) in signals(case) {
        let known = faults.count();
        each_part(&pointer, signal, &mut |at, part| {
            part_faults(at, part, case.time.end_s, faults)
        });
        if faults.count() == known && faults.are_sound(&[END, &pointer]) {
            values(&pointer, role, signal, case.time.end_s, faults);
        }
    }
    for (i, _) in case.loads.iter().enumerate().filter(|(_, load)| load.is_rest()) {
        if case.formulation == Formulation::Published {
            let pointer = format!("/loads/{i}/rest_curvature_1_m");
            let fault = Violation::new(Code::Together, pointer, "a rest curvature in the published formulation");
            faults.push_at_key(
                fault.hint("the published formulation applies to straight beams only: leave \"formulation\" out"),
            );
        }
    }
    for (pointer, profile) in profiles(case) {
        let known = faults.count();
        profile_tables(&pointer, profile, faults);
        let place = (faults.count() == known).then(|| profile.overflows()).flatten();
        if let Some(x) = place {
            faults.push(Violation::new(
                Code::Function,
                pointer,
                format!("not a finite number at {x} of the length"),
            ));
        }
    }
}

/// Ends, loads and attachments of a beam: those of a single beam, or of one of a structure.
struct ActingOnBeam<'a> {
    /// Pointer of the case or of the beam.
    at: String,
    ends: [Option<&'a End>; 2],
    loads: &'a [Load],
    attachments: &'a [Attachment],
}

impl<'a> ActingOnBeam<'a> {
    fn all(case: &'a Case) -> impl Iterator<Item = Self> {
        let whole = Self {
            at: String::new(),
            ends: [Some(&case.ends.root), Some(&case.ends.tip)],
            loads: &case.loads,
            attachments: &case.attachments,
        };
        let beams = case.beams.iter().enumerate().map(|(k, beam)| Self {
            at: format!("/beams/{k}"),
            ends: beam.ends.both(),
            loads: &beam.loads,
            attachments: &beam.attachments,
        });
        std::iter::once(whole).chain(beams)
    }

    /// Distributed loads with the pointers of their keys.
    fn distributed(&self) -> impl Iterator<Item = (String, &'static str, &'a Distributed)> {
        let loads = self.loads.iter().enumerate();
        loads.filter_map(|(i, load)| {
            let (key, load) = load.distributed()?;
            Some((format!("{}/loads/{i}/{key}", self.at), key, load))
        })
    }

    fn signals(&self, damped: bool) -> Vec<(String, Role, &'a Signal)> {
        let mut all = vec![];
        for (end, name) in self.ends.into_iter().zip(["root", "tip"]) {
            let Some((form, given)) = end.map(End::form) else {
                continue;
            };
            for (key, signal) in given.given() {
                let role = if ["u1_m", "u3_m", "slope_rad"].contains(&key) {
                    Role::Motion
                } else {
                    Role::Other
                };
                all.push((format!("{}/ends/{name}/{form}/{key}", self.at), role, signal));
            }
        }
        for (at, key, load) in self.distributed() {
            // with damping of bending rates, the rest curvature must not jump
            let moves = key == "rest_curvature_1_m" && damped;
            let role = if moves { Role::Motion } else { Role::Other };
            all.push((format!("{at}/signal"), role, &load.signal));
        }
        for (i, attachment) in self.attachments.iter().enumerate() {
            let at = |key| format!("{}/attachments/{i}/{key}", self.at);
            let forces = attachment.forces();
            all.extend(forces.map(|(key, signal)| (at(key), Role::Other, signal)));
        }
        all
    }
}

/// All signals of a case, each with its pointer and its role.
fn signals(case: &Case) -> Vec<(String, Role, &Signal)> {
    let damped = case.damping_times().iter().any(|[bending, _]| *bending > 0.0);
    let mut all: Vec<_> = ActingOnBeam::all(case).flat_map(|one| one.signals(damped)).collect();
    for (key, signal) in case.surroundings.iter().flat_map(|around| around.stream()) {
        all.push((format!("/surroundings/{key}"), Role::Stream, signal));
    }
    if let Some(frame) = &case.rotating_frame {
        let at = "/rotating_frame/angular_velocity_rad_s".to_string();
        all.push((at, Role::Rotation, &frame.angular_velocity_rad_s));
    }
    let Some(network) = &case.network else {
        return all;
    };
    for (i, chain) in network.chains.iter().enumerate() {
        all.push((format!("/network/chains/{i}/opening"), Role::Opening, &chain.opening));
        for (k, end) in chain.ends.iter().enumerate() {
            let (key, signal) = match end {
                ChainEnd::PressurePa(signal) => ("pressure_pa", signal),
                ChainEnd::FlowM3S(signal) => ("flow_m3_s", signal),
                ChainEnd::VolumeM3(signal) => ("volume_m3", signal),
                ChainEnd::Sealed | ChainEnd::Connected => continue,
            };
            let role = if key == "volume_m3" { Role::Volume } else { Role::Other };
            all.push((format!("/network/chains/{i}/ends/{k}/{key}"), role, signal));
        }
    }
    for (i, tube) in network.tubes.iter().enumerate() {
        all.push((format!("/network/tubes/{i}/opening"), Role::Opening, &tube.opening));
        let pump = tube.pump.iter().filter_map(|pump| pump.signal());
        all.extend(pump.map(|(key, signal)| (format!("/network/tubes/{i}/pump/{key}"), Role::Other, signal)));
    }
    for (i, port) in network.ports.iter().enumerate() {
        let given = [
            ("pressure_pa", Role::Other, &port.pressure_pa),
            ("flow_m3_s", Role::Other, &port.flow_m3_s),
            ("volume_m3", Role::Volume, &port.volume_m3),
        ];
        for (key, role, signal) in given {
            let at = format!("/network/ports/{i}/{key}");
            all.extend(signal.iter().map(|signal| (at.clone(), role, signal)));
        }
    }
    all
}

/// All profiles of a case with their pointers.
fn profiles(case: &Case) -> Vec<(String, &Profile)> {
    let mut all = vec![];
    for acting in ActingOnBeam::all(case) {
        let loads = acting.distributed();
        all.extend(loads.map(|(at, _, load)| (format!("{at}/profile"), &load.profile)));
    }
    let start = &case.start;
    let fields = [
        ("u1_m", &start.u1_m),
        ("u3_m", &start.u3_m),
        ("u1_rate_m_s", &start.u1_rate_m_s),
        ("u3_rate_m_s", &start.u3_rate_m_s),
    ];
    for (key, profile) in fields {
        all.extend(profile.iter().map(|profile| (format!("/start/{key}"), profile)));
    }
    for (i, some) in start.pressures.iter().enumerate() {
        all.push((format!("/start/pressures/{i}/pressure_pa"), &some.pressure_pa));
    }
    all
}

/// Visits the parts of a signal that are neither sums nor products, each with its pointer.
pub(super) fn each_part<'s>(pointer: &str, signal: &'s Signal, visit: &mut dyn FnMut(&str, &'s Signal)) {
    match signal {
        Signal::Sum(parts) | Signal::Product(parts) => {
            let name = sum_or_product(matches!(signal, Signal::Sum(_)));
            for (i, part) in parts.iter().enumerate() {
                each_part(&format!("{pointer}/{name}/{i}"), part, visit);
            }
        }
        _ => visit(pointer, signal),
    }
}

pub(super) fn part_faults(pointer: &str, signal: &Signal, end: f64, faults: &mut Violations) {
    match signal {
        Signal::Sine(sine) if sine.frequency_hz > HIGHEST_FREQUENCY => {
            let what = format!("{} Hz is not a plausible frequency", plain(sine.frequency_hz));
            let fault = Violation::new(Code::Function, format!("{pointer}/sine/frequency_hz"), what);
            faults.push(fault.allowed(format!("up to {} Hz", plain(HIGHEST_FREQUENCY))));
        }
        Signal::Sigmoid(sigmoid) if sigmoid.steepness_per_s.abs() > STEEPEST => {
            let what = format!("a steepness of {} 1/s is a jump", plain(sigmoid.steepness_per_s));
            let fault = Violation::new(Code::Function, format!("{pointer}/sigmoid/steepness_per_s"), what);
            let fault = fault.allowed(format!("up to {} 1/s", plain(STEEPEST)));
            faults.push(fault.hint("for a jump use a ramp of duration 0, at which the integrator stops"));
        }
        Signal::Table(table) if !table.is_sound() => {
            let at = child(pointer, "table");
            let jumps = Some(table.repeat);
            table_fault(&at, "times_s", jumps, &table.times_s, &table.values, faults);
        }
        Signal::Table(table)
            if table
                .period_s()
                .is_some_and(|period| repeats_too_often(table, period, end)) =>
        {
            let count = plain(end / table.period_s().unwrap_or(f64::INFINITY));
            let what = format!(
                "{} points are repeated {count} times until the end of the run",
                table.times_s.len()
            );
            let fault = Violation::new(Code::Table, format!("{pointer}/table/repeat"), what);
            let fault = fault.allowed(format!("up to {MOST_KNOTS} points in the run"));
            faults.push(fault.hint("thin out the table, or write a sine"));
        }
        _ => {}
    }
}

fn repeats_too_often(table: &Table, period: f64, end: f64) -> bool {
    end / period * table.times_s.len() as f64 > MOST_KNOTS as f64
}

fn profile_tables(pointer: &str, profile: &Profile, faults: &mut Violations) {
    match profile {
        Profile::Table(table) if !table.is_sound() => {
            let at = child(pointer, "table");
            table_fault(&at, "positions", None, &table.positions, &table.values, faults);
        }
        Profile::Sum(parts) | Profile::Product(parts) => {
            let name = sum_or_product(matches!(profile, Profile::Sum(_)));
            for (i, part) in parts.iter().enumerate() {
                profile_tables(&format!("{pointer}/{name}/{i}"), part, faults);
            }
        }
        _ => {}
    }
}

fn sum_or_product(sum: bool) -> &'static str {
    if sum { "sum" } else { "product" }
}

/// Faults of the points of a table. `jumps` is none if two points at one place are forbidden; otherwise it is true if the table repeats.
fn table_fault(pointer: &str, key: &str, jumps: Option<bool>, at: &[f64], values: &[f64], faults: &mut Violations) {
    let fault = if at.is_empty() {
        Violation::new(Code::Table, pointer, "a table without points").hint(format!("give \"{key}\" and \"values\""))
    } else if at.len() != values.len() {
        let what = format!("{} {key} but {}", at.len(), counted(values.len() as u64, "value"));
        Violation::new(Code::Table, child(pointer, "values"), what)
            .allowed(format!("{}, one for each of {key}", counted(at.len() as u64, "value")))
    } else if let Some(i) = at
        .windows(2)
        .position(|w| w[0] > w[1] || (jumps.is_none() && w[0] == w[1]))
    {
        let what = format!("{} comes after {}", at[i + 1], at[i]);
        let fault = Violation::new(Code::Table, format!("{pointer}/{key}/{}", i + 1), what);
        match jumps {
            Some(_) => fault.allowed("ascending order"),
            None => fault.allowed("strictly ascending order"),
        }
    } else if let Some(i) = at.windows(3).position(|w| w[0] == w[2]) {
        let what = format!("the time {} s is given more than twice", at[i]);
        let fault = Violation::new(Code::Table, format!("{pointer}/{key}/{}", i + 2), what);
        fault.hint("for a jump write the time twice, with the values before and after it")
    } else if jumps == Some(true) && at.first() == at.last() {
        let what = "a repeated table of duration zero";
        Violation::new(Code::Table, child(pointer, "repeat"), what)
            .allowed("at least two times; the period is the time from the first to the last")
    } else {
        Violation::new(Code::Table, pointer, "a table with numbers that are not finite")
    };
    faults.push(fault);
}

/// Checks a signal over the run: no jumps of motions, finite values, openings within their range. Bounds are used instead of samples, so
/// that no pulse is missed.
fn values(pointer: &str, role: Role, signal: &Signal, end: f64, faults: &mut Violations) {
    if let Some([moves, infinite]) = role.of_jumps()
        && let Some([t, before, after]) = signal.first_jump(end)
    {
        let what = format!("the {moves} jumps from {before} to {after} at {t} s: infinite {infinite}");
        faults
            .push(Violation::new(Code::Function, pointer, what).hint("use a ramp with a duration and a smooth shape"));
        return;
    }
    if let Some(t) = signal.overflows(end) {
        faults.push(Violation::new(
            Code::Function,
            pointer,
            format!("not a finite number at {t} s"),
        ));
    } else if role == Role::Opening
        && let Some(excess) = signal.leaves(-1e-9, 1.0 + 1e-9, end)
    {
        let what = format!("an opening of {} at {} s", excess.value, excess.t);
        faults.push(Violation::new(Code::Function, pointer, what).allowed("0 (closed) to 1 (open)"));
    }
}
