//! Checks of the state at t = 0: existing bladders, and agreement with the conditions of the ends.

use std::collections::HashMap;

use super::bladders::{PER_ROW, existing};
use super::strength::inlets;
use super::time::END;
use crate::case::ends::{Rotation, Translation};
use crate::case::faults::Violations;
use crate::case::locate::child;
use crate::case::schema::{Case, End};
use crate::case::wiring::BladderLabels;
use crate::error::{Code, Violation};
use crate::functions::profile::Profile;
use crate::functions::signals::{Signal, SmoothTime};

pub(super) fn check(case: &Case, faults: &mut Violations) {
    pressures(case, faults);
    equilibrium(case, faults);
    volumes(case, faults);
    agreement(&case.ends.root, "root", 0.0, case, faults);
    agreement(&case.ends.tip, "tip", 1.0, case, faults);
}

fn pressures(case: &Case, faults: &mut Violations) {
    if case.bladders.is_none() || !faults.are_sound(&[PER_ROW]) {
        return;
    }
    let mut known = HashMap::new();
    for (i, some) in case.start.pressures.iter().enumerate() {
        for (k, &index) in some.bladders.iter().enumerate() {
            let pointer = format!("/start/pressures/{i}/bladders/{k}");
            if existing(index, case, &pointer, faults).is_some()
                && let Some(first) = known.insert(index, pointer.clone())
            {
                let label = BladderLabels::from_case(case).of_number(index);
                let what = format!("the pressure of bladder {label} is given twice, first at {first}");
                faults.push(Violation::new(Code::Together, pointer, what));
            }
        }
    }
}

/// Checks that prescribed volumes begin at the volume that the network contains at the start.
fn volumes(case: &Case, faults: &mut Violations) {
    for (pointer, signal) in inlets(case).volumes {
        if !faults.are_sound(&[END, &pointer]) {
            continue;
        }
        let (begins, holds) = (signal.value(0.0), case.held_at_start(signal));
        if (begins - holds).abs() > 1e-9 * signal.largest(case.time.end_s).value.max(holds.abs()) {
            let what = format!("the volume signal begins at {begins} m^3, but the start contains {holds} m^3");
            let hint = match case.start.equilibrium {
                None => {
                    "begin at 0, because bladders start at the pressures of /start; or give /start/equilibrium: --set \
                     '/start/equilibrium={}'"
                }
                Some(_) => "give /start/equilibrium with loads_at_s 0, or the same volume at both instants",
            };
            faults.push(Violation::new(Code::Together, pointer, what).hint(hint));
        }
    }
}

/// Checks a start from equilibrium: valid instants, and no prescribed displacements.
fn equilibrium(case: &Case, faults: &mut Violations) {
    let Some(start) = &case.start.equilibrium else { return };
    if !start.loads_at_s.is_finite() {
        faults.push(Violation::new(
            Code::Together,
            "/start/equilibrium/loads_at_s",
            "the instant is not a finite number",
        ));
    }
    for (i, &instant) in start.via_s.iter().enumerate() {
        // signals beyond the end of the run are not checked elsewhere
        if !(instant.is_finite() && instant <= case.time.end_s) {
            let pointer = format!("/start/equilibrium/via_s/{i}");
            let what = format!("the instant {instant} s is not before the end of the run");
            let allowed = format!("finite, at most {} s", case.time.end_s);
            faults.push_beside(&[END], Violation::new(Code::Together, pointer, what).allowed(allowed));
        }
    }
    for (key, given) in [("u1_m", &case.start.u1_m), ("u3_m", &case.start.u3_m)] {
        if given.is_some() {
            let what = format!("{key} is given, but /start/equilibrium finds the displacements");
            faults.push(Violation::new(Code::Together, format!("/start/{key}"), what).hint("remove one of the two"));
        }
    }
}

/// Compares the displacement and slope of the start with those that drive an end.
fn agreement(end: &End, name: &str, x: f64, case: &Case, faults: &mut Violations) {
    let (form, given) = end.form();
    if !faults.are_sound(&[END, "/beam/length_m", &format!("/ends/{name}")]) {
        return;
    }
    let length = case.beam.length_m;
    let resolved = end.resolve();
    let mut compare = |key: &str, start_key: &str, starts: f64, signal: &Signal, tolerance: f64, unit: &str| {
        let driven = signal.at_start(case.time.end_s);
        let starts = case.start.equilibrium.as_ref().map_or(starts, |start| {
            let t = start.loads_at_s;
            signal.jet(SmoothTime { t, within: t }).value
        });
        if (starts - driven).abs() > tolerance {
            let by_hand = given.given().any(|(k, _)| k == key);
            let pointer = if by_hand {
                child(&format!("/ends/{name}/{form}"), key)
            } else {
                format!("/start/{start_key}")
            };
            let what =
                format!("at t = 0 the {name} is driven to {key} = {driven} {unit}, but the start has {starts} {unit}");
            // A start from equilibrium is reported at its own pointer.
            let pointer = if case.start.equilibrium.is_some() {
                "/start/equilibrium".into()
            } else {
                pointer
            };
            let hint = format!("start the signal at {starts}, or change /start/{start_key}");
            faults.push(
                Violation::new(Code::Together, pointer, what)
                    .allowed(format!("agreement within {tolerance:.1e} {unit}"))
                    .hint(hint),
            );
        }
    };
    let value = |profile: &Option<Profile>| profile.as_ref().map_or(0.0, |p| p.value(x));
    let rate = |profile: &Option<Profile>| profile.as_ref().map_or(0.0, |p| p.slope(x) / length);
    if let Translation::Displacement(signal) = &resolved.transverse {
        compare("u1_m", "u1_m", value(&case.start.u1_m), signal, 1e-6 * length, "m");
    }
    if let Translation::Displacement(signal) = &resolved.axial {
        compare("u3_m", "u3_m", value(&case.start.u3_m), signal, 1e-6 * length, "m");
    }
    if let Rotation::Slope(signal) = &resolved.rotation {
        // Looser: a table of measured points has no exact slope at its end.
        let slope = rate(&case.start.u1_m).atan2(1.0 + rate(&case.start.u3_m));
        compare("slope_rad", "u1_m", slope, signal, 1e-3, "rad");
    }
}

impl Signal {
    /// Value at t = 0, taken in the first smooth interval.
    fn at_start(&self, end: f64) -> f64 {
        let (_, stop) = self.smooth_intervals(end)[0];
        self.jet(SmoothTime {
            t: 0.0,
            within: 0.5 * stop,
        })
        .value
    }
}
