//! Checks of ends: exactly one of each pair of conditions.

use crate::case::faults::Violations;
use crate::case::schema::{Case, End, EndConditions};
use crate::error::{Code, Violation};

const PAIRS: [[&str; 2]; 3] = [
    ["u1_m", "force_x_n"],
    ["slope_rad", "moment_n_m"],
    ["u3_m", "force_z_n"],
];
const ALLOWED: &str = "exactly one of each pair: u1_m or force_x_n, slope_rad or moment_n_m, u3_m or force_z_n";

pub(super) fn check(case: &Case, faults: &mut Violations) {
    for (end, name) in [(&case.ends.root, "root"), (&case.ends.tip, "tip")] {
        let (form, given) = end.form();
        let pointer = format!("/ends/{name}/{form}");
        let keys: Vec<&str> = given.given().map(|(key, _)| key).collect();
        for pair in PAIRS.iter().filter(|pair| pair.iter().all(|key| keys.contains(key))) {
            let what = format!(
                "the {name} is over-determined: {} and {} are both given",
                pair[0], pair[1]
            );
            faults.push_at_key(
                Violation::new(Code::Together, format!("{pointer}/{}", pair[1]), what)
                    .allowed(ALLOWED)
                    .hint("keep one"),
            );
        }
        if let End::Conditions(given) = end {
            complete(name, &pointer, given, &keys, faults);
        }
    }
}

/// Reports missing conditions, and follower forces on held ends. Follower forces may replace both dead forces.
fn complete(name: &str, pointer: &str, given: &EndConditions, keys: &[&str], faults: &mut Violations) {
    let follower = ["follower_normal_n", "follower_shear_n"]
        .into_iter()
        .find(|key| keys.contains(key));
    let instead = follower.is_some() && given.force_x_n.is_none() && given.force_z_n.is_none();
    for pair in PAIRS.iter().filter(|pair| !pair.iter().any(|key| keys.contains(key))) {
        if instead && pair[0] != "slope_rad" {
            continue;
        }
        let what = format!(
            "a condition of the {name} is missing: neither {} nor {} is given",
            pair[0], pair[1]
        );
        let hint = format!(
            "add {} for a free end, or {} for a fixed or driven end; the value may be 0",
            pair[1], pair[0]
        );
        faults.push_at_key(
            Violation::new(Code::Together, pointer, what)
                .allowed(ALLOWED)
                .hint(hint),
        );
    }
    for key in ["u1_m", "u3_m"].iter().filter(|key| keys.contains(key)) {
        if let Some(follower) = follower {
            let what = format!("{follower} acts on an end whose motion {key} prescribes");
            let fault = Violation::new(Code::Together, format!("{pointer}/{follower}"), what);
            faults.push_at_key(fault.hint(format!("remove {follower}, or give a force instead of {key}")));
        }
    }
}
