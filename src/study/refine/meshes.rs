//! What the meshes of a case do to its numbers: half the cells of the beam, and twice those of a bladder, beside it.
//!
//! ```text
//! beam      second order   e = S |x(K) - x(K/2)|/3,  or 4 S |x(2K) - x(K)|/3 where cells cannot be halved
//! bladders  first order    e = 2 |x(2G) - x(G)|
//! ```
//!
//! What is largest along a bladder is that of a cell, whose middle is half a cell from its end: of first order. A bladder has few cells;
//! half of them say nothing of what a pressure does within one.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{Numbers, SAFETY, has_cells_along_bladders};
use crate::case::Case;
use crate::discrete::resolution::LIMIT as LARGE;
use crate::error::{Code, Error, Result};

/// What meshes do to one number, relative to it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Share {
    /// Cells of the beam; nothing where the other mesh has no such number.
    pub beam: Option<f64>,
    /// Cells along bladders, likewise.
    pub bladders: Option<f64>,
}

impl Share {
    /// Both.
    pub fn total(&self) -> f64 {
        self.beam.unwrap_or(0.0) + self.bladders.unwrap_or(0.0)
    }

    /// Whether one of them is.
    pub fn known(&self) -> bool {
        self.beam.is_some() || self.bladders.is_some()
    }
}

/// What meshes do to numbers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Meshes {
    /// By name.
    pub quantities: BTreeMap<String, Share>,
    /// Why a mesh could not be compared.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unknown: Vec<String>,
}

/// Computes a case on other meshes; `here` are its numbers on its own.
pub fn judge(case: &Case, here: &Numbers, compute: &mut dyn FnMut(&Case) -> Result<Numbers>) -> Result<Meshes> {
    let mut found = Meshes::default();
    let mut other = case.clone();
    let halved = case.mesh.cells_per_segment.is_multiple_of(2);
    let factor = if halved {
        other.mesh.cells_per_segment /= 2;
        SAFETY / 3.0
    } else {
        other.mesh.cells_per_segment *= 2;
        SAFETY * 4.0 / 3.0
    };
    found.compare("beam", here, compute(&other), factor, |share| &mut share.beam);
    if has_cells_along_bladders(case)? {
        let mut other = case.clone();
        other.mesh.cells_per_bladder *= 2;
        found.compare("bladders", here, compute(&other), 2.0, |share| &mut share.bladders);
    }
    Ok(found)
}

impl Meshes {
    fn compare(
        &mut self,
        which: &str,
        here: &Numbers,
        there: Result<Numbers>,
        factor: f64,
        part: fn(&mut Share) -> &mut Option<f64>,
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
            let size = number.value.abs().max(number.size).max(f64::MIN_POSITIVE);
            let error = there
                .get(name)
                .map(|other| factor * (other.value - number.value).abs() / size);
            *part(self.quantities.entry(name.clone()).or_default()) = error.filter(|e| e.is_finite());
        }
    }

    fn worst(&self) -> Option<(&String, &Share)> {
        self.quantities
            .iter()
            .max_by(|a, b| a.1.total().total_cmp(&b.1.total()))
    }

    /// The worst of them, in a line.
    pub fn words(&self) -> Option<String> {
        let (name, share) = self.worst()?;
        Some(format!(
            "mesh error: at most about {}, that of {name}{}",
            percent(share.total()),
            share.parts()
        ))
    }

    /// What to know where it is large, or not known.
    pub fn warning(&self) -> Option<String> {
        let large = self.worst().filter(|(_, share)| share.total() > LARGE);
        let large = large.map(|(name, share)| {
            let cells = if share.bladders > share.beam {
                "/mesh/cells_per_bladder"
            } else {
                "/mesh/cells_per_segment"
            };
            let many = self.quantities.values().filter(|share| share.total() > LARGE).count();
            let others = match many {
                1 => String::new(),
                2 => ", and another figure by more than 5 %".into(),
                _ => format!(", and {} other figures by more than 5 %", many - 1),
            };
            format!(
                "{name} may be off by about {} of itself{}{others}; more {cells}",
                percent(share.total()),
                share.parts()
            )
        });
        let unknown = self
            .unknown
            .first()
            .map(|why| format!("what a mesh does is not known, of the {why}"));
        let all: Vec<String> = large.into_iter().chain(unknown).collect();
        (!all.is_empty()).then(|| {
            Code::ErrorEstimate.warning(format!(
                "estimate: {}, or --accuracy, which refines the meshes",
                all.join("; ")
            ))
        })
    }
}

impl Share {
    fn parts(&self) -> String {
        match self.bladders {
            None => " (by the cells of the beam)".into(),
            Some(bladders) => format!(
                " ({} by the cells of the beam, {} by those along bladders)",
                percent(self.beam.unwrap_or(0.0)),
                percent(bladders)
            ),
        }
    }
}

fn percent(x: f64) -> String {
    if x < 0.1 {
        format!("{:.1} %", 100.0 * x)
    } else if x < 10.0 {
        format!("{:.0} %", 100.0 * x)
    } else {
        "all".into()
    }
}
