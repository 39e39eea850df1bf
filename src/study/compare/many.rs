//! Several results beside one of them.

use serde::{Deserialize, Serialize};

use super::difference::{Comparison, compare};
use super::interpolate::cubic;
use super::recording::Recording;

/// Several results beside one of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Beside {
    /// Folder that the others are compared with.
    pub reference: String,
    /// Each of the others with it, in the order in which they were named; the reference is the first of each.
    pub comparisons: Vec<Comparison>,
}

/// A figure of all results.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// `tip_u1_m.max_abs`.
    pub name: String,
    /// In the reference.
    pub reference: f64,
    /// In each of the others, with the difference over the size of the reference's, where that is not 0; nothing where it has none.
    pub others: Vec<Option<(f64, Option<f64>)>>,
}

impl Beside {
    /// Compares all but the reference, by its place, with it.
    pub fn of(all: &[Recording], reference: usize) -> Self {
        let others = all.iter().enumerate().filter(|(k, _)| *k != reference);
        Self {
            reference: all[reference].label.clone(),
            comparisons: others.map(|(_, other)| compare(&all[reference], other)).collect(),
        }
    }

    /// Folders, the reference first.
    pub fn folders(&self) -> Vec<&str> {
        let others = self.comparisons.iter().map(|one| one.folders[1].as_str());
        std::iter::once(self.reference.as_str()).chain(others).collect()
    }

    /// What to know of all before one believes a number, each once.
    pub fn remarks(&self) -> Vec<&str> {
        let mut all: Vec<&str> = vec![];
        for remark in self.comparisons.iter().flat_map(|one| &one.remarks) {
            if !all.contains(&remark.as_str()) {
                all.push(remark);
            }
        }
        all
    }

    /// Figures that the reference shares with one of the others at least.
    pub fn figures(&self) -> Vec<Figure> {
        let mut all: Vec<Figure> = vec![];
        for (k, one) in self.comparisons.iter().enumerate() {
            for figure in &one.figures {
                let at = all.iter().position(|own| own.name == figure.name).unwrap_or_else(|| {
                    all.push(Figure {
                        name: figure.name.clone(),
                        reference: figure.a,
                        others: vec![None; self.comparisons.len()],
                    });
                    all.len() - 1
                });
                all[at].others[k] = Some((figure.b, figure.change));
            }
        }
        all
    }

    /// Histories and fields by name, with the relative L2 norm of each difference from the reference, where there is one.
    pub fn norms(&self) -> Vec<(String, Vec<Option<f64>>)> {
        let mut all: Vec<(String, Vec<Option<f64>>)> = vec![];
        for (k, one) in self.comparisons.iter().enumerate() {
            for found in one.histories.iter().chain(&one.fields) {
                let at = all.iter().position(|own| own.0 == found.name).unwrap_or_else(|| {
                    all.push((found.name.clone(), vec![None; self.comparisons.len()]));
                    all.len() - 1
                });
                all[at].1[k] = Some(found.relative.l2);
            }
        }
        all
    }
}

/// A column of a result at other times [s], by cubics; NaN where it has none.
pub fn column_at(one: &Recording, name: &str, times: &[f64]) -> Option<Vec<f64>> {
    let series = one.column(name)?;
    let (first, last) = (*one.times.first()?, *one.times.last()?);
    let hair = 1e-9 * (last - first).abs();
    let at = |t: &f64| {
        if (first - hair..=last + hair).contains(t) {
            cubic(&one.times, *t).mean(|k| series.values[k])
        } else {
            f64::NAN
        }
    };
    Some(times.iter().map(at).collect())
}
