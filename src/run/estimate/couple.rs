//! What a mesh makes of a rotational spring at an end whose moment is given: an error of first order.

use serde::{Deserialize, Serialize};

use super::SQUARED;
use super::words::Row;
use crate::case::Rotation;
use crate::discrete::System;
use crate::discrete::quantities::Interest;

/// Angles by which the half cells beside such ends are wrong.
///
/// A spring k takes the angle of its cell and is in series with the half cell as its own couple bends it. What the given moment M, or
/// pressure, bends there is not in that, and the angle of the tip is told as if nothing but M bent the half cell:
///
/// ```text
/// couple missing    k h κ/2,  κ = M/EI         angle of the tip    x/(1 + x) of itself,  x = k h/(2 EI)
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Couple {
    /// What the missing couple turns the beam by at most [rad].
    turns: f64,
    /// The missing couple over the moment that is given: no more is missing of what that does.
    missing: f64,
    /// Part of the tip's angle that is missing in what is told of it.
    told: f64,
}

impl Couple {
    /// Of a system in a run until `end` [s].
    pub fn of(system: &System, end: f64) -> Self {
        let (model, mesh) = (&system.model, &system.mesh);
        let bends = model.section.bending_stiffness;
        let springs = |which: usize| {
            let near = move |at: f64| (at - which as f64).abs() * mesh.cells as f64 <= 0.5;
            let all = model.attachments.iter().filter(move |one| near(one.at));
            all.map(|one| one.turning_stiffness).sum::<f64>()
        };
        // where something else holds the beam's angle it bends under the couple, otherwise the spring alone takes it
        let slope = model.ends.iter().any(|end| matches!(end.rotation, Rotation::Slope(_)));
        let turned_back = model.attachments.iter().filter(|one| one.turning_stiffness > 0.0);
        let held = slope || turned_back.count() > 1;
        let mut all = Self::default();
        for (which, at) in model.ends.iter().enumerate() {
            let (stiffness, Rotation::Moment(moment)) = (springs(which), &at.rotation) else {
                continue;
            };
            if stiffness <= 0.0 {
                continue;
            }
            let half = 0.5 * mesh.h * stiffness / bends;
            let eased = if held {
                stiffness * model.length / (bends + stiffness * model.length)
            } else {
                1.0
            };
            all.turns += 0.5 * mesh.h / bends * moment.range(0.0, end).size() * eased;
            all.missing += half;
            if which == 1 {
                all.told = half / (1.0 + half);
            }
        }
        all
    }

    /// Adds what the missing couple does to what follows the tip's angle, which is `angle` [rad] at most, and a deflection, which is that of a
    /// mean `slope`: at most all.
    pub fn add(&self, rows: &mut [Row], [angle, slope]: [f64; 2]) {
        let part = |size: f64| (self.turns / size.max(f64::MIN_POSITIVE)).min(self.missing).min(1.0);
        self.to(rows, |name| match name {
            Interest::TipAngle => part(angle),
            Interest::TipU1 | Interest::MidspanU1 | Interest::LargestU1 => part(slope),
            Interest::TipU3 | Interest::LargestU3 => (SQUARED * part(slope)).min(1.0),
            _ => 0.0,
        });
    }

    /// Adds what is told wrongly of the tip's angle, while everything else is right.
    pub fn tell(&self, rows: &mut [Row]) {
        let told = |name| if name == Interest::TipAngle { self.told } else { 0.0 };
        self.to(rows, told);
    }

    fn to(&self, rows: &mut [Row], more: impl Fn(Interest) -> f64) {
        if *self == Self::default() {
            return;
        }
        for row in rows {
            let more = more(row.name);
            row.couple += more;
            row.errors[1] += more;
        }
    }
}
