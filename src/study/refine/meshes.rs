//! Errors of a case's numbers due to its meshes and to omitted effects: comparison with half the cells of the beam,
//! twice the cells of a bladder, and all effects.
//!
//! ```text
//! beam      second order   e = S |x(K) - x(K/2)|/3,  or 4 S |x(2K) - x(K)|/3 where cells cannot be halved, or do not resolve a shape
//! bladders  first order    e = 2 |x(2G) - x(G)|
//! ```
//!
//! The largest value along a bladder is that of a cell, whose center is half a cell from its end: first order. A
//! bladder has few cells; half of them do not resolve the pressure within it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{RefinedNumbers, SAFETY, finer_along_bladders};
use crate::case::Case;
use crate::case::schema::Effect;
use crate::discrete::System;
use crate::discrete::resolution::{self, LIMIT as LARGE};
use crate::error::numbers::error_percent as percent;
use crate::error::{Code, Error, Result};
use crate::model::Model;
use crate::run::modes::{ModeOptions, Modes, compare_effects, compare_meshes};
use crate::study::effects::full_model::{Full, full_of};

/// Largest number of unknowns with all effects over that of an analysis: cost is proportional to unknowns.
const MOST_WORK: usize = 3;
/// Relative error from which a figure is not resolved: a percentage of it has no meaning.
const UNRESOLVED: f64 = 1.0;

/// Errors of one number due to meshes and effects, relative to it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ErrorShare {
    /// Error due to the cells of the beam; `None` if the other mesh has no such number.
    pub beam: Option<f64>,
    /// Error due to the cells along bladders; `None` as for `beam`.
    pub bladders: Option<f64>,
    /// Error due to omitted effects, for equilibria; cycles omit none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub effects: Option<f64>,
}

impl ErrorShare {
    /// Sum of all errors.
    pub fn total(&self) -> f64 {
        let parts = [self.beam, self.bladders, self.effects];
        parts.into_iter().flatten().sum()
    }

    /// True if the error of a mesh is known.
    pub fn known(&self) -> bool {
        self.beam.is_some() || self.bladders.is_some()
    }
}

/// Errors of numbers due to meshes and effects.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Meshes {
    /// Relative errors by name.
    pub quantities: BTreeMap<String, ErrorShare>,
    /// Absolute errors by name, each in the unit of its number.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub errors: BTreeMap<String, f64>,
    /// Effects that the analysis leaves out and that errors include.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<String>,
    /// Reason why errors exclude effects that are left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub excluded: Option<String>,
    /// Reasons why a mesh could not be compared.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unknown: Vec<String>,
}

/// Compares a case with other meshes; `here` are its numbers on its own mesh.
///
/// # Errors
/// As [`System::new`](crate::discrete::System::new).
pub fn judge(
    case: &Case,
    here: &RefinedNumbers,
    compute: &mut dyn FnMut(&Case) -> Result<RefinedNumbers>,
) -> Result<Meshes> {
    let mut found = Meshes::default();
    let mut other = case.clone();
    let cells = case.mesh.cells_per_segment;
    let unresolved = resolution::unresolved(case, &System::new(case)?);
    let at_rest = unresolved.iter().filter(|finding| finding.at_rest);
    let most = resolution::FINEST.max(2 * cells);
    let finer = resolution::finer(at_rest, "/mesh/cells_per_segment", cells, most);
    let halved = cells.is_multiple_of(2) && finer.is_none();
    let factor = if halved {
        other.mesh.cells_per_segment /= 2;
        SAFETY / 3.0
    } else {
        other.mesh.cells_per_segment = finer.unwrap_or(2 * cells);
        SAFETY * 4.0 / 3.0
    };
    found.compare("beam", here, compute(&other), factor, |share| &mut share.beam);
    if let Some(other) = finer_along_bladders(case)? {
        found.compare("bladders", here, compute(&other), 2.0, |share| &mut share.bladders);
    }
    found.sum(here);
    Ok(found)
}

/// The case with all effects for an analysis that builds its model by `model`, or the reason why it is not computed. `None` if the
/// analysis leaves nothing out.
///
/// # Errors
/// As [`System::new`](crate::discrete::System::new).
fn affordable(
    case: &Case,
    model: &dyn Fn(&Case) -> Result<Model>,
) -> Result<Option<std::result::Result<Full, String>>> {
    let Some(full) = full_of(case, model)? else {
        return Ok(None);
    };
    let unknowns = |case: &Case| Ok::<_, Error>(System::with(case, model(case)?)?.layout.len);
    let (own, all) = (unknowns(case)?, unknowns(&full.case)?);
    Ok(Some(match all <= MOST_WORK * own {
        true => Ok(full),
        false => Err(format!(
            "errors exclude the effects left out ({}): with them there are {all} unknowns instead of {own}",
            Effect::names(&full.left_out, ", ")
        )),
    }))
}

/// Adds the errors due to meshes and omitted effects to modes about the start, or about the equilibrium under the loads of an instant [s].
///
/// # Errors
/// As [`System::new`](crate::discrete::System::new).
pub fn judge_modes(case: &Case, at_rest_under: Option<f64>, plan: &ModeOptions, found: &mut Modes) -> Result<()> {
    compare_meshes(case, at_rest_under, plan, found);
    match affordable(case, &Model::of_modes)? {
        None => {}
        Some(Err(reason)) => found.excluded = Some(reason),
        Some(Ok(full)) => {
            found.left_out.clone_from(&full.left_out);
            compare_effects(&full.case, at_rest_under, plan, found);
        }
    }
    Ok(())
}

impl Meshes {
    /// Adds the errors due to the effects that a case omits.
    ///
    /// # Errors
    /// As [`System::new`](crate::discrete::System::new).
    pub fn with_effects(
        mut self,
        case: &Case,
        here: &RefinedNumbers,
        compute: &mut dyn FnMut(&Case) -> Result<RefinedNumbers>,
    ) -> Result<Self> {
        match affordable(case, &Model::new)? {
            None => {}
            Some(Err(reason)) => self.excluded = Some(reason),
            Some(Ok(full)) => {
                self.compare("effects", here, compute(&full.case), 1.0, |share| &mut share.effects);
                self.left_out = full.left_out.iter().map(Effect::to_string).collect();
                self.sum(here);
            }
        }
        Ok(self)
    }

    fn compare(
        &mut self,
        which: &str,
        here: &RefinedNumbers,
        there: Result<RefinedNumbers>,
        factor: f64,
        part: fn(&mut ErrorShare) -> &mut Option<f64>,
    ) {
        let there = match there {
            Ok(numbers) => numbers,
            Err(error) => {
                let what = match error {
                    Error::Solver(fault) => fault.what,
                    other => other.to_string(),
                };
                self.unknown.push(format!("{which}: {what}"));
                return;
            }
        };
        for (name, number) in here {
            let size = number.counted();
            let error = there
                .get(name)
                .map(|other| factor * (other.value - number.value).abs() / size);
            *part(self.quantities.entry(name.clone()).or_default()) = error.filter(|e| e.is_finite());
        }
    }

    /// Computes the absolute errors from the relative ones.
    fn sum(&mut self, here: &RefinedNumbers) {
        let known = self.quantities.iter().filter(|(_, share)| share.known());
        let error = known.filter_map(|(name, share)| Some((name.clone(), share.total() * here.get(name)?.counted())));
        self.errors = error.filter(|(_, error)| error.is_finite()).collect();
    }

    fn worst(&self) -> Option<(&String, &ErrorShare)> {
        self.quantities
            .iter()
            .max_by(|a, b| a.1.total().total_cmp(&b.1.total()))
    }

    /// Describes the largest error in one line.
    pub fn describe(&self) -> Option<String> {
        let (name, share) = self.worst()?;
        let excluded = self
            .excluded
            .as_ref()
            .map_or(String::new(), |reason| format!("; {reason}"));
        Some(format!(
            "largest estimated error: {} of {name}{}{excluded}",
            match share.total() >= UNRESOLVED {
                true => "more than the value".to_owned(),
                false => format!("about {}", percent(share.total())),
            },
            share.parts(&self.left_out)
        ))
    }

    /// Warns of a large or unknown error.
    pub fn warning(&self) -> Option<String> {
        let large = self.worst().filter(|(_, share)| share.total() > LARGE);
        let remedy = large.map_or("", |(_, share)| share.remedy());
        let large = large.map(|(name, share)| {
            let many = self.quantities.values().filter(|share| share.total() > LARGE).count();
            let others = match many {
                1 => String::new(),
                2 => "; another figure has more than 5 %".into(),
                _ => format!("; {} other figures have more than 5 %", many - 1),
            };
            match share.total() >= UNRESOLVED {
                true => format!(
                    "{name} is not resolved: its estimated error is larger than itself{}{others}",
                    share.parts(&self.left_out)
                ),
                false => format!(
                    "{name} has a relative error of about {}{}{others}",
                    percent(share.total()),
                    share.parts(&self.left_out)
                ),
            }
        });
        let unknown = self
            .unknown
            .first()
            .map(|why| format!("the error is unknown for the {why}"));
        let all: Vec<String> = large.into_iter().chain(unknown).collect();
        (!all.is_empty()).then(|| {
            Code::ErrorEstimate.warning(format!(
                "estimate: {}. Use {}--accuracy, which refines the meshes",
                all.join("; "),
                remedy
            ))
        })
    }
}

impl ErrorShare {
    /// Beginning of the advice: the setting that reduces the largest part of the error.
    fn remedy(&self) -> &'static str {
        let by_meshes = self.beam.unwrap_or(0.0).max(self.bladders.unwrap_or(0.0));
        if self.effects.unwrap_or(0.0) > by_meshes {
            "\"effects\": \"full\", or "
        } else if self.bladders > self.beam {
            "more /mesh/cells_per_bladder, or "
        } else {
            "more /mesh/cells_per_segment, or "
        }
    }

    fn parts(&self, left_out: &[String]) -> String {
        let effects = match left_out {
            [] => "effects left out".into(),
            all => format!("effects left out: {}", all.join(", ")),
        };
        let parts = [
            (self.beam, "the cells of the beam"),
            (self.bladders, "those along bladders"),
            (self.effects, &*effects),
        ];
        let parts = parts.into_iter().filter_map(|(part, what)| Some((part?, what)));
        let parts: Vec<_> = parts.collect();
        match parts.as_slice() {
            [] => String::new(),
            [(_, what)] => format!(" (by {what})"),
            all => {
                let each = all.iter().map(|(part, what)| format!("{} by {what}", percent(*part)));
                format!(" ({})", each.collect::<Vec<_>>().join(", "))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Goal: an error above the figure itself is stated as such, without a percentage of it.
    #[test]
    fn a_figure_within_its_error_is_not_resolved() {
        let said = |beam: f64| {
            let share = ErrorShare {
                beam: Some(beam),
                ..ErrorShare::default()
            };
            let found = Meshes {
                quantities: [("tip_u1".to_owned(), share)].into(),
                ..Meshes::default()
            };
            [found.warning(), found.describe()].map(Option::unwrap_or_default)
        };
        for said in said(20.0) {
            assert!(!said.contains('%') && said.contains("than"), "{said}");
        }
        let [warning, described] = said(0.2);
        assert!(warning.contains("relative error of about 20 %"), "{warning}");
        assert!(described.contains("about 20 % of tip_u1"), "{described}");
    }
}
