//! Warnings about permitted values that are rarely intended.

use std::f64::consts::TAU;

use super::functions::{controls, each_part};
use super::strength::inlets;
use crate::case::locate::child;
use crate::case::numbers::{digits, plain};
use crate::case::schema::{Case, FluidKind, Load};
use crate::functions::Profile;
use crate::functions::signals::Signal;

/// Pointer of the area per pressure of bladders.
const PER_PRESSURE: &str = "/bladders/area_per_pressure_m2_per_pa";

/// Density of the solid below which g/cm^3 is suspected [kg/m^3]; silicones and rubbers have about 1000.
const LIGHT: f64 = 100.0;

/// Viscosity above which mPa s is suspected [Pa s]; honey has 10.
const THICK: f64 = 100.0;

/// Gravity above which mm/s^2 is suspected [m/s^2]; the earth's is 9.81.
const HEAVY: f64 = 100.0;

/// Density of a liquid below which g/cm^3 is suspected [kg/m^3]; oils have 700 and more.
const THIN: f64 = 100.0;

/// Atmospheric pressure [Pa]: the standard value, and a common rounding of it.
const ATMOSPHERE: [f64; 2] = [101_325.0, 101_300.0];

/// Pressures that are multiples of this value count as round [Pa].
const ROUND_PRESSURE: f64 = 500.0;

/// Air pressures at inhabited altitudes [Pa]; a recording that begins in this range is of absolute pressure.
const AMBIENT: std::ops::Range<f64> = 95e3..106e3;

/// Area per pressure times Young's modulus over the section of a bladder, above which another unit is suspected. Thick-walled cells have 1
/// to 10; a cell with a wall of a fifth of its width has 100.
const SOFT: f64 = 100.0;

/// Values whose unit is probably wrong, each with its pointer and a message.
pub fn sizes(case: &Case) -> Vec<(String, String)> {
    if !case.plausibility.is_on() {
        return vec![];
    }
    let mut all = vec![];
    let density = case.beam.density_kg_m3;
    if density < LIGHT {
        let what = format!(
            "a solid of {} kg/m^3 is lighter than foam; silicone has about 1000: is this in g/cm^3?",
            plain(density)
        );
        all.push(("/beam/density_kg_m3".to_owned(), what));
    }
    if let Some(fluid) = case.fluid.as_ref().filter(|fluid| fluid.viscosity_pa_s > THICK) {
        let viscosity = plain(fluid.viscosity_pa_s);
        let what = format!(
            "a viscosity of {viscosity} Pa s is ten times that of honey and more; water has 1e-3: is this in mPa s?"
        );
        all.push(("/fluid/viscosity_pa_s".to_owned(), what));
    }
    if let Some(fluid) = case.fluid.as_ref()
        && fluid.kind == FluidKind::Liquid
        && (f64::MIN_POSITIVE..THIN).contains(&fluid.density_kg_m3)
    {
        let what = format!(
            "a liquid of {} kg/m^3 is lighter than any liquid at room temperature; water has 1000: is this in g/cm^3? A gas has \"kind\": \"gas\"",
            plain(fluid.density_kg_m3)
        );
        all.push(("/fluid/density_kg_m3".to_owned(), what));
    }
    if let Some(bladders) = &case.bladders {
        let section = bladders.height_m * bladders.width_m;
        let soft = bladders.area_per_pressure_m2_per_pa * case.beam.young_modulus_pa / section;
        if soft > SOFT {
            let what = format!(
                "an area per pressure of {} m^2/Pa is {} times the section of a bladder over Young's modulus; 1 to 10 times is usual: is this per kPa, \
                 or in mm^2?",
                plain(bladders.area_per_pressure_m2_per_pa),
                digits(soft)
            );
            all.push((PER_PRESSURE.to_owned(), what));
        }
    }
    pressures(case, &mut all);
    angles(case, &mut all);
    for (k, load) in case.loads.iter().enumerate() {
        let Load::Gravity { x_m_s2, z_m_s2 } = load else {
            continue;
        };
        for (key, size) in [("x_m_s2", *x_m_s2), ("z_m_s2", *z_m_s2)] {
            if size.abs() > HEAVY {
                let what = format!(
                    "a gravity of {} m/s^2 is {} times that of the earth, 9.81 m/s^2: is this in mm/s^2?",
                    plain(size),
                    digits(size.abs() / 9.81)
                );
                all.push((format!("/loads/{k}/gravity/{key}"), what));
            }
        }
    }
    let length = case.beam.length_m;
    for (pointer, _, signal) in controls(case) {
        let moves = pointer.starts_with("/ends/") && ["/u1_m", "/u3_m"].iter().any(|key| pointer.ends_with(key));
        if let Some(far) = signal.leaves(-length, length, case.time.end_s).filter(|_| moves) {
            let what = format!(
                "the end moves to {} m at {} s, farther than the beam is long, {} m: is this in millimetres?",
                plain(far.value),
                plain(far.t),
                plain(length)
            );
            all.push((pointer, what));
        }
    }
    all
}

/// Warns of pressures whose digits suggest that they are absolute.
fn pressures(case: &Case, all: &mut Vec<(String, String)>) {
    let mut given: Vec<(String, f64)> = vec![];
    for (pointer, signal) in inlets(case).pressures {
        each_value(&pointer, signal, &mut |at, value| given.push((at, value)));
    }
    for (k, vessel) in case
        .network
        .iter()
        .flat_map(|network| &network.accumulators)
        .enumerate()
    {
        given.push((
            format!("/network/accumulators/{k}/start_pressure_pa"),
            vessel.start_pressure_pa,
        ));
    }
    for (k, some) in case.start.pressures.iter().enumerate() {
        if let Profile::Constant(value) = some.pressure_pa {
            given.push((format!("/start/pressures/{k}/pressure_pa"), value));
        }
    }
    for (pointer, value) in given.into_iter().filter(|(at, value)| is_absolute(at, *value)) {
        let what = format!(
            "a pressure of {} Pa seems to be absolute, {} Pa above the atmosphere: pressures of a case are relative to the surroundings",
            plain(value),
            plain(value - ATMOSPHERE[0])
        );
        all.push((pointer, what));
    }
}

/// True if a pressure is atmospheric plus a round amount, or is the first value of a recording at ambient pressure and not round.
fn is_absolute(pointer: &str, value: f64) -> bool {
    let above = value - ATMOSPHERE[0];
    let round = |x: f64| (x / ROUND_PRESSURE - (x / ROUND_PRESSURE).round()).abs() < 1e-9;
    let recorded = pointer.ends_with("/values/0") && AMBIENT.contains(&value) && !round(value);
    (above >= 0.0 && round(above)) || ATMOSPHERE.contains(&value) || recorded
}

/// Warns of angles that are probably degrees: more than a turn, and whole or half numbers.
fn angles(case: &Case, all: &mut Vec<(String, String)>) {
    let is_degrees = |angle: f64| angle.abs() > TAU && (2.0 * angle).fract() == 0.0;
    let mut warn = |pointer: String, angle: f64| {
        let (turns, meant) = (digits(angle.abs() / TAU), digits(angle.to_radians()));
        let what = format!(
            "{} rad is {turns} turns; {} degrees are {meant} rad: is this in degrees?",
            plain(angle),
            plain(angle)
        );
        all.push((pointer, what));
    };
    for (pointer, _, signal) in controls(case) {
        if pointer.ends_with("/slope_rad") {
            each_value(&pointer, signal, &mut |at, value| {
                if is_degrees(value) {
                    warn(at, value);
                }
            });
        }
        each_part(&pointer, signal, &mut |at, part| {
            if let Signal::Sine(sine) = part
                && is_degrees(sine.phase_rad)
            {
                warn(format!("{at}/sine/phase_rad"), sine.phase_rad);
            }
        });
    }
}

/// Visits the values of a signal in its own unit: constants, ends of ramps, amplitudes, first and last values of tables. Skips products.
fn each_value(pointer: &str, signal: &Signal, visit: &mut dyn FnMut(String, f64)) {
    each_part(pointer, signal, &mut |at, part| {
        let mut visit = |key: &str, value: f64| visit(format!("{at}{key}"), value);
        match part {
            _ if at[pointer.len()..].contains("/product/") => {}
            Signal::Constant(value) => visit("", *value),
            Signal::Ramp(ramp) => {
                visit("/ramp/from", ramp.from);
                visit("/ramp/to", ramp.to);
            }
            Signal::Sine(sine) => visit("/sine/amplitude", sine.amplitude),
            Signal::Sigmoid(sigmoid) => visit("/sigmoid/amplitude", sigmoid.amplitude),
            Signal::Table(table) => {
                for k in [Some(0), table.values.len().checked_sub(1)].into_iter().flatten() {
                    if let Some(value) = table.values.get(k) {
                        visit(&format!("/table/values/{k}"), *value);
                    }
                }
            }
            _ => {}
        }
    });
}

/// Warnings about damping times longer than the period of the first bending mode, whose frequency is `first` [Hz]: no mode oscillates.
pub fn damping(case: &Case, first: Option<f64>) -> Vec<(String, String)> {
    let Some(frequency) = first.filter(|_| case.plausibility.is_on()) else {
        return vec![];
    };
    let damping = &case.beam.damping;
    let times = [
        ("bending_time_s", damping.bending_time_s),
        ("axial_time_s", damping.axial_time_s),
    ];
    let long = times.into_iter().filter(|(_, time)| time * frequency > 1.0);
    let warnings = long.map(|(key, time)| {
        let what = format!(
            "a damping time of {} s is longer than the period of the first bending mode, {} s. The mode does not \
             oscillate. Is this in ms?",
            plain(time),
            digits(1.0 / frequency)
        );
        (format!("/beam/damping/{key}"), what)
    });
    warnings.collect()
}

/// Warning that no support holds the beam in some directions.
pub fn unheld(case: &Case, directions: &[&str]) -> Option<(String, String)> {
    if directions.is_empty() || !case.plausibility.is_on() {
        return None;
    }
    let what = format!(
        "no support holds the beam {}: loads accelerate it as a rigid body. Hold an end or attach a spring to ground, \
         unless this is intended",
        directions.join(" and ")
    );
    Some(("/ends".to_owned(), what))
}

/// Warning about a requested instant `at` [s] outside the run.
pub fn instant(case: &Case, at: f64) -> Option<String> {
    let end = case.time.end_s;
    let (side, limit) = match at {
        _ if at < 0.0 => ("before the start", 0.0),
        _ if at > end * (1.0 + 1e-9) => ("after the end", end),
        _ => return None,
    };
    Some(format!(
        "--at {} s is {side} of the run ({} s). Signals are extrapolated to this instant",
        plain(at),
        plain(limit)
    ))
}

/// Ramps and tables that begin at or after the end of the run, each with its pointer and a message.
pub fn late(case: &Case) -> Vec<(String, String)> {
    let mut all = vec![];
    for (pointer, _, signal) in controls(case) {
        each_part(&pointer, signal, &mut |at, part| {
            if let Some((key, start)) = begins(part).filter(|(_, start)| *start >= case.time.end_s) {
                let end = plain(case.time.end_s);
                all.push((
                    child(at, key),
                    format!(
                        "it begins at {} s, but the run ends at {end} s: it has no effect",
                        plain(start)
                    ),
                ));
            }
        });
    }
    all
}

/// Key of a part of a signal, and the time at which the part begins to change [s].
fn begins(part: &Signal) -> Option<(&'static str, f64)> {
    match part {
        Signal::Ramp(ramp) if ramp.from != ramp.to => Some(("ramp", ramp.start_s)),
        Signal::Table(table) if !table.repeat => {
            let changes = table.values.windows(2).position(|pair| pair[0] != pair[1])?;
            Some(("table", *table.times_s.get(changes)?))
        }
        _ => None,
    }
}
