//! Several results compared with one of them.

use serde::{Deserialize, Serialize};

use super::difference::{Comparison, compare};
use super::interpolate::cubic;
use super::recording::Recording;

/// Several results compared with one of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ManyComparison {
    /// Folder of the reference.
    pub reference: String,
    /// Comparisons of the reference, always the first, with each of the others, in the order in which these were named.
    pub comparisons: Vec<Comparison>,
}

/// Figure of all results.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedFigure {
    /// `tip_u1_m.max_abs`.
    pub name: String,
    /// Value in the reference.
    pub reference: f64,
    /// Value in each of the others, with the change relative to the size of the reference value unless that is 0;
    /// `None` if it has none.
    pub others: Vec<Option<(f64, Option<f64>)>>,
}

impl ManyComparison {
    /// Compares all other recordings with the reference, given by its index.
    pub fn new(all: &[Recording], reference: usize) -> Self {
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

    /// Remarks on the reliability of all comparisons, each once.
    pub fn remarks(&self) -> Vec<&str> {
        let mut all: Vec<&str> = vec![];
        for remark in self.comparisons.iter().flat_map(|one| &one.remarks) {
            if !all.contains(&remark.as_str()) {
                all.push(remark);
            }
        }
        all
    }

    /// Figures that the reference shares with at least one of the others.
    pub fn figures(&self) -> Vec<ComparedFigure> {
        let mut all: Vec<ComparedFigure> = vec![];
        for (k, one) in self.comparisons.iter().enumerate() {
            for figure in &one.figures {
                let at = all.iter().position(|own| own.name == figure.name).unwrap_or_else(|| {
                    all.push(ComparedFigure {
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

    /// Names of histories and fields, with the relative L2 norm of each difference from the reference, if there is one.
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

/// Interpolates a column of a result to other times [s] by cubics; NaN outside its times.
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
