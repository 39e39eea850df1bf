//! One decision after the other.

use super::obstacles::Obstacle;
use super::{Decision, Scene};
use crate::case::schema::{Case, Choice, Load};
use crate::error::{Code, Violation};
use crate::model::Network;

/// What the program chooses by itself, and why.
pub type Automatic = (bool, String);

/// Kept, and why.
pub fn kept(why: &str) -> Automatic {
    (true, format!("kept: {why}"))
}

/// Left out where what that changes is below the tolerance.
pub fn weigh(number: f64, tolerance: f64, what: &str) -> Automatic {
    let on = number.is_nan() || number >= tolerance;
    let sign = if on { ">=" } else { "<" };
    (on, format!("{what}: {number:.1e} {sign} {tolerance:.0e}"))
}

/// Decisions as they are made.
pub struct Decisions<'a> {
    /// What automatic choices look at; without it everything is kept.
    pub scene: Option<&'a Scene<'a>>,
    /// In the order in which they are made.
    pub decisions: Vec<Decision>,
    /// What was asked for and cannot be.
    pub refusals: Vec<Violation>,
}

impl Decisions<'_> {
    /// Decides on one effect. Where it has no meaning (`possible` says why not) it is off, whatever was asked; where
    /// something stands against leaving it out it stays, and the case is refused if that was asked for.
    pub fn decide(
        &mut self,
        name: &'static str,
        choice: Choice,
        possible: Result<(), &str>,
        obstacle: impl FnOnce() -> Option<Obstacle>,
        automatic: impl FnOnce(&Scene) -> Automatic,
    ) -> bool {
        let (on, reason) = match (possible, choice) {
            (Err(why), _) => (false, why.to_string()),
            (Ok(()), Choice::Auto) => match (self.scene, self.scene.and_then(|_| obstacle())) {
                (None, _) => (true, "full model asked for".to_string()),
                (_, Some(obstacle)) => kept(&obstacle.what),
                (Some(scene), None) => automatic(scene),
            },
            (Ok(()), Choice::On) => (true, "asked for".to_string()),
            (Ok(()), Choice::Off) => match obstacle() {
                Some(obstacle) => {
                    self.refusals.push(
                        Violation::new(
                            Code::Effect,
                            format!("/effects/{name}"),
                            format!("{name} cannot be left out: {}", obstacle.what),
                        )
                        .hint(obstacle.hint),
                    );
                    (true, format!("cannot be left out: {}", obstacle.what))
                }
                None => (false, "left out as asked".to_string()),
            },
        };
        self.decisions.push(Decision { name, on, reason });
        on
    }

    /// Effects that are there where the case gives them, and only there.
    pub fn report(&mut self, case: &Case, network: Option<&Network>) {
        let damping = &case.beam.damping;
        let gravity = |load: &Load| matches!(load, Load::Gravity { .. });
        let wet = self.decisions.iter().any(|d| d.name == "fluid" && d.on);
        let network = network.filter(|_| wet);
        let present = [
            (
                "damping",
                damping.axial_time_s > 0.0 || damping.bending_time_s > 0.0 || damping.drag_n_s_m2 > 0.0,
            ),
            (
                "valves",
                network.is_some_and(|n| n.links.iter().any(|l| l.opening.is_some())),
            ),
            ("turbines", network.is_some_and(|n| !n.turbines.is_empty())),
            ("loads", case.loads.iter().any(|load| !gravity(load))),
            ("gravity", case.loads.iter().any(gravity)),
        ];
        for (name, on) in present {
            let reason = if on { "given" } else { "not given" }.to_string();
            self.decisions.push(Decision { name, on, reason });
        }
    }
}
