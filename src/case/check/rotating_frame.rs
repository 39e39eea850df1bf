//! Checks of a rotating frame: nothing of the case may stay at rest while the frame turns.

use crate::case::faults::Violations;
use crate::case::schema::{Case, Formulation, Load};
use crate::error::{Code, Violation};

const KEY: &str = "/rotating_frame";

pub(super) fn check(case: &Case, faults: &mut Violations) {
    if case.rotating_frame.is_none() {
        return;
    }
    let damping = &case.beam.damping;
    let drag = [
        ("drag_n_s_m2", damping.drag_n_s_m2),
        ("quadratic_drag_n_s2_m3", damping.quadratic_drag_n_s2_m3),
    ];
    let gravity = case.loads.iter().position(|load| matches!(load, Load::Gravity { .. }));
    let all = [
        gravity.map(|k| {
            let at = format!("/loads/{k}/gravity");
            let hint = "at a constant angular velocity W give body_x_m_s2 and body_z_m_s2 as sines of W/(2 pi) Hz, a quarter apart; or \
                        remove gravity";
            (at, "gravity, whose direction turns in a rotating frame", hint)
        }),
        case.surroundings.as_ref().map(|_| {
            let hint = "remove surroundings, or drive the root by u1_m, u3_m and slope_rad in axes at rest";
            ("/surroundings".into(), "ambient fluid, which does not turn with a rotating frame", hint)
        }),
        drag.iter().find(|(_, size)| *size > 0.0).map(|(key, _)| {
            let hint = "use bending_time_s and axial_time_s, or dashpots in attachments, which turn with the frame";
            let at = format!("/beam/damping/{key}");
            (at, "drag of a fluid that does not turn with a rotating frame", hint)
        }),
        (case.formulation == Formulation::Published).then(|| {
            let what = "a rotating frame in the published formulation, whose rotary inertia has no kinetic energy";
            (KEY.into(), what, "leave \"formulation\" out")
        }),
    ];
    for (at, what, hint) in all.into_iter().flatten() {
        faults.push_at_key(Violation::new(Code::Together, at, what).hint(hint));
    }
}
