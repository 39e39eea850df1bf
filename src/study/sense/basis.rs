//! Loads of known position and unknown amplitude.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::case::schema::{Attachment, Case, Distributed, Load};
use crate::case::{Rotation, Translation, nearest};
use crate::error::{Error, Result};
use crate::functions::{Interpolation, Signal};

use crate::functions::profile::{PlaceTable, Profile};

/// Kind of load, with one or several amplitudes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Basis {
    /// Transverse dead force on the tip.
    TipForce,
    /// Moment on the tip.
    TipMoment,
    /// Axial dead force on the tip.
    TipAxial,
    /// Uniform transverse force per length.
    Uniform,
    /// Uniform axial force per length.
    UniformAxial,
    /// Transverse force per length, piecewise linear between this many equally spaced places from root to tip.
    Profile(usize),
    /// Transverse dead force at this share of the length.
    Point(f64),
}

/// Pointers of the case's own loads that act at an instant [s], in addition to the estimated ones.
pub fn own(case: &Case, at_s: f64) -> Vec<String> {
    let acts = |signal: &Signal| signal.value(at_s) != 0.0;
    let mut all = vec![];
    for (i, load) in case.loads.iter().enumerate() {
        match (load, load.distributed()) {
            (Load::Gravity { x_m_s2, z_m_s2 }, _) if *x_m_s2 != 0.0 || *z_m_s2 != 0.0 => {
                all.push(format!("/loads/{i}/gravity"));
            }
            (_, Some((key, given))) if acts(&given.signal) => all.push(format!("/loads/{i}/{key}")),
            _ => {}
        }
    }
    for (i, attachment) in case.attachments.iter().enumerate() {
        let forces = attachment.forces().filter(|(_, signal)| acts(signal));
        all.extend(forces.map(|(key, _)| format!("/attachments/{i}/{key}")));
    }
    for (end, name) in [(&case.ends.root, "root"), (&case.ends.tip, "tip")] {
        let (form, given) = end.form();
        let forces = [
            "force_x_n",
            "force_z_n",
            "moment_n_m",
            "follower_normal_n",
            "follower_shear_n",
        ];
        let given = given
            .given()
            .filter(|(key, signal)| forces.contains(key) && acts(signal));
        all.extend(given.map(|(key, _)| format!("/ends/{name}/{form}/{key}")));
    }
    all
}

/// Largest number of places of a profile.
const MOST: usize = 200;

/// Names of the loads, for error messages.
const WANTED: &str = "tip-force, tip-moment, tip-axial, uniform, uniform-axial, profile:N with N places, point:S at a \
                      share S of the length";

impl Basis {
    /// Parses the name of a load.
    ///
    /// # Errors
    /// [`Error::Usage`] with the names there are.
    pub fn parse(text: &str) -> Result<Self> {
        let wrong = |what: String| Error::Usage(format!("--load '{text}': {what}"));
        let (name, number) = text.split_once(':').unwrap_or((text, ""));
        let plain = [
            Self::TipForce,
            Self::TipMoment,
            Self::TipAxial,
            Self::Uniform,
            Self::UniformAxial,
        ];
        match name {
            "profile" => match number.parse() {
                Ok(places @ 2..=MOST) => Ok(Self::Profile(places)),
                _ => Err(wrong(format!("profile:N needs from 2 to {MOST} places"))),
            },
            "point" => match number.parse() {
                Ok(at) if (0.0..=1.0).contains(&at) => Ok(Self::Point(at)),
                _ => Err(wrong(
                    "S of point:S must be a share of the length (0 at the root to 1 at the tip)".into(),
                )),
            },
            _ => plain.into_iter().find(|one| one.to_string() == text).ok_or_else(|| {
                let names = plain.map(|one| one.to_string());
                let names = names.iter().map(String::as_str).chain(["profile:N", "point:S"]);
                let meant = nearest(text, names).map_or(String::new(), |meant| format!("; nearest is {meant}"));
                wrong(format!("unknown load{meant}. Known loads: {WANTED}"))
            }),
        }
    }

    /// Loads to estimate by default: a transverse force on the tip, if it can move transversely, and a uniform load.
    pub fn usual(case: &Case) -> Vec<Self> {
        let free = matches!(case.ends.tip.resolve().transverse, Translation::Force(_));
        let both = [free.then_some(Self::TipForce), Some(Self::Uniform)];
        both.into_iter().flatten().collect()
    }

    /// Amplitudes of this load.
    fn amplitudes(self, case: &Case) -> Vec<Amplitude> {
        let length = case.beam.length_m;
        let stiffness =
            case.beam.young_modulus_pa * case.beam.width_m * case.beam.height_m.powi(3) * case.beam.bending_factor()
                / 12.0;
        let (force, moment, spread) = (
            stiffness / length.powi(2),
            stiffness / length,
            stiffness / length.powi(3),
        );
        let one = |name: String, unit, size, acts| Amplitude {
            name,
            unit,
            size,
            acts,
            place: None,
        };
        match self {
            Self::TipForce => vec![one("tip_force".into(), "N", force, Acts::TipForce)],
            Self::TipMoment => vec![one("tip_moment".into(), "N m", moment, Acts::TipMoment)],
            Self::TipAxial => vec![one("tip_axial".into(), "N", force, Acts::TipAxial)],
            Self::Uniform => vec![one("uniform".into(), "N/m", spread, Acts::Across(Profile::one()))],
            Self::UniformAxial => vec![one("uniform_axial".into(), "N/m", spread, Acts::Along(Profile::one()))],
            Self::Point(at) => vec![Amplitude {
                place: Some(at),
                ..one(format!("point_{at}"), "N", force, Acts::Point(at))
            }],
            Self::Profile(places) => (0..places)
                .map(|k| Amplitude {
                    place: Some(k as f64 / (places - 1) as f64),
                    ..one(
                        format!("profile_{}", k + 1),
                        "N/m",
                        spread,
                        Acts::Across(hat(k, places)),
                    )
                })
                .collect(),
        }
    }
}

impl fmt::Display for Basis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TipForce => f.write_str("tip-force"),
            Self::TipMoment => f.write_str("tip-moment"),
            Self::TipAxial => f.write_str("tip-axial"),
            Self::Uniform => f.write_str("uniform"),
            Self::UniformAxial => f.write_str("uniform-axial"),
            Self::Profile(places) => write!(f, "profile:{places}"),
            Self::Point(at) => write!(f, "point:{at}"),
        }
    }
}

impl TryFrom<String> for Basis {
    type Error = Error;
    fn try_from(text: String) -> Result<Self> {
        Self::parse(&text)
    }
}

impl From<Basis> for String {
    fn from(one: Basis) -> Self {
        one.to_string()
    }
}

/// Hat function: 1 at place `k` of equally spaced places, 0 at the others, linear between them.
fn hat(k: usize, places: usize) -> Profile {
    let at = |k: usize| k as f64 / (places - 1) as f64;
    let near: Vec<usize> = (k.saturating_sub(1)..=(k + 1).min(places - 1)).collect();
    Profile::Table(PlaceTable::new(
        near.iter().map(|j| at(*j)).collect(),
        near.iter().map(|j| f64::from(u8::from(*j == k))).collect(),
        Interpolation::Linear,
    ))
}

/// Position and direction of a load of amplitude 1.
#[derive(Clone, Debug, PartialEq)]
enum Acts {
    TipForce,
    TipMoment,
    TipAxial,
    Across(Profile),
    Along(Profile),
    Point(f64),
}

/// Amplitude of one load.
#[derive(Clone, Debug, PartialEq)]
pub struct Amplitude {
    /// Name without unit.
    pub name: String,
    /// Unit.
    pub unit: &'static str,
    /// Size that bends the beam by about its length, in `unit`: `EI/l^2` of forces, `EI/l` of moments, `EI/l^3` of forces per length.
    pub size: f64,
    /// Share of the length at which the load acts, if it has a place.
    pub place: Option<f64>,
    acts: Acts,
}

/// Amplitudes of all loads.
///
/// # Errors
/// [`Error::Usage`] for a load that is given twice, a second profile, or a load on a fixed degree of freedom of the tip.
pub fn amplitudes(case: &Case, loads: &[Basis]) -> Result<Vec<Amplitude>> {
    case.single("sense")?;
    let tip = case.ends.tip.resolve();
    for (k, load) in loads.iter().enumerate() {
        let wrong = |what: &str| Err(Error::Usage(format!("--load {load}: {what}")));
        if loads[..k].contains(load) {
            return wrong("asked for twice");
        }
        let profiles = |one: &&Basis| matches!(one, Basis::Profile(_));
        if loads[..=k].iter().filter(profiles).count() > 1 {
            return wrong("only one profile across the beam is possible");
        }
        let held = match load {
            Basis::TipForce => matches!(tip.transverse, Translation::Displacement(_)),
            Basis::TipAxial => matches!(tip.axial, Translation::Displacement(_)),
            Basis::TipMoment => matches!(tip.rotation, Rotation::Slope(_)),
            _ => false,
        };
        if held {
            return wrong("the tip is fixed in this direction: its support carries the load, and no bladder responds");
        }
    }
    Ok(loads.iter().flat_map(|load| load.amplitudes(case)).collect())
}

/// Adds loads to a case, with one signal per amplitude.
pub fn loaded(case: &Case, amplitudes: &[Amplitude], signals: impl IntoIterator<Item = Signal>) -> Case {
    let mut case = case.clone();
    for (amplitude, signal) in amplitudes.iter().zip(signals) {
        amplitude.act(&mut case, signal);
    }
    case
}

impl Amplitude {
    fn act(&self, case: &mut Case, signal: Signal) {
        let tip = case.ends.tip.given_mut();
        let add = |there: &mut Option<Signal>, more: Signal| {
            *there = Some(match there.take() {
                Some(own) => Signal::Sum(vec![own, more]),
                None => more,
            });
        };
        let spread = |profile: &Profile, signal| Distributed {
            signal,
            profile: profile.clone(),
        };
        match &self.acts {
            Acts::TipForce => add(&mut tip.force_x_n, signal),
            Acts::TipMoment => add(&mut tip.moment_n_m, signal),
            Acts::TipAxial => add(&mut tip.force_z_n, signal),
            Acts::Across(profile) => case.loads.push(Load::ForceXNM(spread(profile, signal))),
            Acts::Along(profile) => case.loads.push(Load::ForceZNM(spread(profile, signal))),
            Acts::Point(at) => case.attachments.push(Attachment {
                force_x_n: Some(signal),
                ..Attachment::at(*at)
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_that_are_written() {
        for text in [
            "tip-force",
            "tip-moment",
            "tip-axial",
            "uniform",
            "uniform-axial",
            "profile:7",
            "point:0.25",
        ] {
            assert_eq!(Basis::parse(text).expect(text).to_string(), text);
        }
        for (text, said) in [
            ("tip-forse", "nearest is tip-force"),
            ("profile:1", "from 2 to"),
            ("profile", "from 2 to"),
            ("point:1.5", "a share of the length"),
        ] {
            let error = Basis::parse(text).expect_err(text).to_string();
            assert!(error.contains(said), "{error}");
        }
    }

    #[test]
    fn hats_sum_to_one() {
        for x in [0.0, 0.1, 1.0 / 3.0, 0.5, 0.99, 1.0] {
            let sum: f64 = (0..4).map(|k| hat(k, 4).value(x)).sum();
            assert!((sum - 1.0).abs() < 1e-14, "{x}: {sum}");
        }
    }
}
