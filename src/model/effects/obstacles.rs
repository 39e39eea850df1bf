//! Obstacles to omitting an effect: inputs of a case that require it.

use crate::case::schema::{Attachment, Case, Contact, Effect, Formulation, Load};
use crate::case::{ResolvedEnd, Rotation, Translation, spans};
use crate::functions::profile::Profile;
use crate::model::network::{AccumulatorLaw, Feed, Link};
use crate::model::{LumpedNetwork, ResolvedNetwork};

/// Reason that an effect must stay, with a remedy.
#[derive(Clone, Debug, PartialEq)]
pub struct Obstacle {
    /// Reason, as one clause.
    pub what: String,
    /// Remedy.
    pub hint: String,
}

fn obstacle(what: impl Into<String>, hint: &str) -> Option<Obstacle> {
    Some(Obstacle {
        what: what.into(),
        hint: hint.into(),
    })
}

/// Effects that a structure keeps: its beams have different axes.
pub const OF_STRUCTURES: [Effect; 4] = [
    Effect::TransverseMotion,
    Effect::FiniteRotation,
    Effect::AxialStretch,
    Effect::AxialInertia,
];

/// Obstacle: several beams.
pub fn structure() -> Obstacle {
    Obstacle {
        what: "motion across one beam of a structure is motion along another".into(),
        hint: "leave it on".into(),
    }
}

/// Obstacle: a motion or load across the beam.
pub fn transverse_motion(case: &Case) -> Option<Obstacle> {
    const HINT: &str = "remove it, or leave transverse_motion on";
    let across = |load: &Load| match load {
        Load::ForceNormalNM(d) => !d.signal.is_zero(),
        Load::ForceXNM(d) | Load::BodyXMS2(d) | Load::MomentXN(d) | Load::MomentZN(d) | Load::RestCurvature(d) => {
            !d.signal.is_zero()
        }
        Load::Gravity { x_m_s2, .. } => *x_m_s2 != 0.0,
        Load::ForceZNM(_) | Load::ForceTangentialNM(_) | Load::BodyZMS2(_) => false,
    };
    if let Some(what) = off_axis(case) {
        return obstacle(what, HINT);
    }
    if let Some(k) = case.loads.iter().position(across) {
        return obstacle(format!("/loads/{k} acts across the beam"), HINT);
    }
    if let Some(wall) = case.contacts.first() {
        return obstacle(
            format!("the {} \"{}\" may push the beam sideways", wall.kind(), wall.name),
            HINT,
        );
    }
    if case.rotating_frame.is_some() {
        return obstacle("the rotating frame accelerates the beam across", HINT);
    }
    let pushed = |a: &Attachment| {
        let across = [&a.force_x_n, &a.force_normal_n];
        across.into_iter().flatten().any(|signal| !signal.is_zero())
    };
    if let Some(k) = case.attachments.iter().position(pushed) {
        return obstacle(format!("/attachments/{k} pushes the beam sideways"), HINT);
    }
    if let Some(k) = case.attachments.iter().position(|a| a.offset_across_m != 0.0) {
        return obstacle(
            format!("the mass of /attachments/{k} is eccentric and bends the beam"),
            HINT,
        );
    }
    if case
        .surroundings
        .as_ref()
        .is_some_and(|around| around.stream().next().is_some())
    {
        return obstacle("/surroundings has a stream across the beam", HINT);
    }
    for (end, name) in [(&case.ends.root, "root"), (&case.ends.tip, "tip")] {
        let ResolvedEnd {
            transverse,
            rotation,
            follower,
            ..
        } = end.resolve();
        let (Translation::Displacement(moves) | Translation::Force(moves)) = &transverse;
        let (Rotation::Slope(turns) | Rotation::Moment(turns)) = &rotation;
        if !moves.is_zero() || !turns.is_zero() || follower.is_some_and(|f| !f.shear.is_zero()) {
            return obstacle(
                format!("the {name} has a transverse motion, a rotation or a transverse load"),
                HINT,
            );
        }
    }
    let begins = |profile: &Option<Profile>| profile.as_ref().is_some_and(|p| *p != Profile::Constant(0.0));
    if begins(&case.start.u1_m) || begins(&case.start.u1_rate_m_s) {
        return obstacle("the beam starts with a deflection or a transverse velocity", HINT);
    }
    None
}

/// Reason to keep bending and stretch together: a neutral axis beside the beam's line.
fn off_axis(case: &Case) -> Option<String> {
    spans::is_eccentric(case)
        .then(|| "the neutral axis is not at the beam's line, so that forces along it bend the beam".to_owned())
}

/// Obstacle: the published form, which has finite rotations.
pub fn finite_rotation(case: &Case) -> Option<Obstacle> {
    if case.formulation == Formulation::Conservative {
        return None;
    }
    obstacle(
        "the published form has no potential for small rotations",
        "set \"formulation\" to \"conservative\", or leave finite_rotation on",
    )
}

/// Obstacle: a rotating frame, or finite rotations, which turn the normal force with the beam.
pub fn axial_force_on_bending(case: &Case, finite_rotation: bool) -> Option<Obstacle> {
    if case.rotating_frame.is_some() {
        let what = "centrifugal forces of the rotating frame stiffen the beam by its normal force";
        return obstacle(what, "leave axial_force_on_bending on");
    }
    let turns = finite_rotation.then_some("finite_rotation is on, which rotates the normal force with the beam")?;
    obstacle(
        turns,
        "switch finite_rotation off too, or leave axial_force_on_bending on",
    )
}

/// Obstacle: a dashpot or a lossy contact, which acts only on moving masses; or damping of the material that leaves one of the motions
/// across and along undamped, so that a part of the equations has rates and the other none.
pub fn solid_inertia(case: &Case, moves: [bool; 2]) -> Option<Obstacle> {
    let damping = &case.beam.damping;
    let times = case.damping_times();
    let damped = times.iter().flatten().any(|time| *time > 0.0);
    let all = case.surroundings.is_some() || damping.drag_n_s_m2 > 0.0 || damping.quadratic_drag_n_s2_m3 > 0.0;
    let undamped = (0..2).find(|axis| moves[*axis] && times.iter().any(|times| times[*axis] == 0.0));
    if let Some(axis) = undamped.filter(|_| !all && damped) {
        let [damped, other] = [["stretching", "bending_time_s"], ["bending", "axial_time_s"]][axis];
        return obstacle(
            match case.spans.is_empty() {
                true => format!("/beam/damping damps {damped} only, and without inertia the other motion has no rates"),
                false => format!("a span has no {other}, and without inertia a motion without damping has no rates"),
            },
            &format!("give {other} too, remove the damping, or leave solid_inertia on"),
        );
    }
    if let Some(wall) = lossy(case) {
        return obstacle(
            format!(
                "the {} \"{}\" has damping or friction, which has no effect without inertia",
                wall.kind(),
                wall.name
            ),
            "remove them, or leave solid_inertia on",
        );
    }
    let damped = |a: &Attachment| a.damping_x_n_s_m > 0.0 || a.damping_z_n_s_m > 0.0;
    let at = first_attachment(case, damped)?;
    obstacle(
        format!("{at} has a dashpot, which has no effect without inertia"),
        "remove it, or leave solid_inertia on",
    )
}

/// Pointer of the first attachment with a property, of the case or of its beams.
fn first_attachment(case: &Case, of: impl Fn(&Attachment) -> bool) -> Option<String> {
    let beams = case.beams.iter().enumerate();
    let beams = beams.map(|(k, beam)| (format!("/beams/{k}"), &beam.attachments));
    let mut all = std::iter::once((String::new(), &case.attachments)).chain(beams);
    all.find_map(|(owner, attachments)| {
        let k = attachments.iter().position(&of)?;
        Some(format!("{owner}/attachments/{k}"))
    })
}

/// Obstacle: an attachment that resists the rotation of shearing sections, which have rates only with rotary inertia; or axial damping
/// alone, whose force depends on this rotation, weakly in a straight beam.
pub fn rotary_inertia(case: &Case, sheared: bool) -> Option<Obstacle> {
    if !sheared {
        return None;
    }
    let turned = |a: &Attachment| a.is_eccentric() || a.rotary_inertia_kg_m2 > 0.0;
    if let Some(at) = first_attachment(case, turned) {
        return obstacle(
            format!("{at} resists the rotation of sections with shear"),
            "leave rotary_inertia on, or switch shear off",
        );
    }
    let alone = |[bending, axial]: &[f64; 2]| *axial > 0.0 && *bending == 0.0;
    if case.damping_times().iter().any(alone) {
        return obstacle(
            "axial_time_s without bending_time_s acts on the rotation of sections with shear",
            "leave rotary_inertia on, switch shear off, or give bending_time_s",
        );
    }
    None
}

/// Obstacle: axial motion that the remaining equations do not determine, or that an attachment, a contact or ambient fluid
/// resists.
pub fn axial_inertia(case: &Case, finite_rotation: bool) -> Option<Obstacle> {
    let inert = case
        .surroundings
        .as_ref()
        .is_some_and(|s| s.added_mass_coefficient > 0.0);
    if inert && finite_rotation {
        return obstacle(
            "ambient fluid has added mass, which acts axially at finite rotations",
            "switch finite_rotation off too, or leave axial_inertia on",
        );
    }
    if case.rotating_frame.is_some() {
        let what = "Coriolis forces of the rotating frame couple axial and transverse motion";
        return obstacle(what, "leave axial_inertia on");
    }
    if let Some(wall) = lossy(case) {
        return obstacle(
            format!("the {} \"{}\" has damping or friction", wall.kind(), wall.name),
            "remove them, or leave axial_inertia on",
        );
    }
    if let Some(k) = case.attachments.iter().position(|a| a.damping_z_n_s_m > 0.0) {
        return obstacle(
            format!("/attachments/{k} has an axial dashpot"),
            "remove damping_z_n_s_m, or leave axial_inertia on",
        );
    }
    let turned = |a: &Attachment| a.is_eccentric() || finite_rotation && a.rotary_inertia_kg_m2 > 0.0;
    if let Some(k) = case.attachments.iter().position(turned) {
        return obstacle(
            format!("/attachments/{k} has inertia that rotates with the beam"),
            "leave axial_inertia on",
        );
    }
    let held = [&case.ends.root, &case.ends.tip].map(|end| end.resolve().axial);
    if held.iter().any(|axial| matches!(axial, Translation::Displacement(_))) {
        return None;
    }
    obstacle(
        "neither end holds u3, so only inertia determines the axial position of the beam",
        "give u3_m at an end, or leave axial_inertia on",
    )
}

/// First contact with damping or friction.
fn lossy(case: &Case) -> Option<&Contact> {
    let lossy = |wall: &&Contact| wall.damping_s_m > 0.0 || wall.friction_coefficient > 0.0;
    case.contacts.iter().find(lossy)
}

/// Obstacle: a normal force that does not follow from the loads.
pub fn axial_stretch(case: &Case, transverse_motion: bool, finite_rotation: bool) -> Option<Obstacle> {
    const HINT: &str = "leave axial_stretch on";
    if !transverse_motion {
        return obstacle("a beam that neither bends nor stretches is rigid", HINT);
    }
    if let Some(what) = off_axis(case) {
        return obstacle(what, HINT);
    }
    if finite_rotation {
        return obstacle(
            "finite_rotation is on, which couples stretch and bending",
            "switch finite_rotation off too",
        );
    }
    if case.rotating_frame.is_some() {
        let what = "centrifugal forces of the rotating frame depend on the motion, so the loads alone do not determine the normal force";
        return obstacle(what, HINT);
    }
    if let Some(wall) = case.contacts.first() {
        let what = format!(
            "the {} \"{}\" may push the beam axially, so the loads alone do not determine the normal force",
            wall.kind(),
            wall.name
        );
        return obstacle(what, HINT);
    }
    if let Some(k) = case.loads.iter().position(Load::follows) {
        let what = format!("/loads/{k} turns with the beam, so the loads alone do not determine the normal force");
        return obstacle(what, HINT);
    }
    if let Some(k) = case.attachments.iter().position(Attachment::is_eccentric) {
        return obstacle(
            format!(
                "the mass of /attachments/{k} pushes the beam axially as it rotates, so the loads alone do not determine the normal force"
            ),
            HINT,
        );
    }
    let holds = |a: &Attachment| a.stiffness_z_n_m > 0.0 || a.damping_z_n_s_m > 0.0;
    if let Some(k) = case.attachments.iter().position(holds) {
        return obstacle(
            format!("/attachments/{k} supports the beam axially, so the loads alone do not determine the normal force"),
            HINT,
        );
    }
    if case
        .foundation
        .as_ref()
        .is_some_and(|bed| bed.stiffness_z_n_m2.is_some())
    {
        let what = "the foundation supports the beam axially, so the loads alone do not determine the normal force";
        return obstacle(what, HINT);
    }
    let held = [&case.ends.root, &case.ends.tip].map(|end| end.resolve().axial);
    match held
        .iter()
        .filter(|axial| matches!(axial, Translation::Displacement(_)))
        .count()
    {
        1 => None,
        0 => obstacle("neither end holds u3", HINT),
        _ => obstacle(
            "both ends hold u3, so the loads alone do not determine the normal force",
            HINT,
        ),
    }
}

/// Obstacle: a prescribed flow or a pump.
pub fn flow(network: &ResolvedNetwork) -> Option<Obstacle> {
    if let Some(source) = network.sources.first() {
        let given = match source.feed {
            Feed::Flow(_) => "flow",
            Feed::Volume(_) => "volume",
        };
        let what = format!("the port \"{}\" prescribes a {given}", source.name);
        return obstacle(what, "remove the port, or leave flow on");
    }
    if network.links.iter().any(|link| link.pump.is_some()) {
        return obstacle("a pump drives the flow", "remove the pump, or leave flow on");
    }
    if network.gravity.is_some() {
        return obstacle(
            "gravity drives the flow",
            "remove /network/elevations, or leave flow on",
        );
    }
    None
}

/// Obstacle: a pump whose pressure increases with flow by more than its tube resists, so that only inertia determines the flow.
pub fn tube_inertia(case: &Case, network: &ResolvedNetwork) -> Option<Obstacle> {
    let rises = |link: &Link| {
        let pump = link.pump.as_ref();
        pump.is_some_and(|pump| pump.steepest_rise(case.time.end_s) >= link.resistance)
    };
    network.links.iter().find(|link| rises(link))?;
    obstacle(
        "the pressure of a pump increases with flow by more than its tube resists",
        "give a falling curve or a narrower tube, or leave tube_inertia on",
    )
}

/// Obstacle: a rigid tank, which stores only compressed fluid.
pub fn compressibility(network: &ResolvedNetwork) -> Option<Obstacle> {
    let rigid = |law: &AccumulatorLaw| matches!(law, AccumulatorLaw::Rigid { .. });
    let tank = network.accumulators.iter().find(|one| rigid(&one.law))?;
    let what = format!("the tank \"{}\" stores nothing without compression", tank.name);
    obstacle(what, "remove the tank, or leave compressibility on")
}

/// Obstacle: a network that cannot have a single pressure.
pub fn network_pressure_differences(network: &ResolvedNetwork) -> Option<Obstacle> {
    let why = LumpedNetwork::all(network).find_map(Result::err)?;
    obstacle(why, "remove it, or leave network_pressure_differences on")
}
