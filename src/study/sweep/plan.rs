//! All settings that determine the rows: `plan.json`.

use serde::{Deserialize, Serialize};

use super::designs::Designs;
use super::row::SweepRow;
use super::vary::Draw;
use crate::study::analysis::AnalysisKind;

/// Part of the designs: those whose number leaves the remainder `index - 1` when divided by `of`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    /// Index, from 1.
    pub index: usize,
    /// Number of shards.
    pub of: usize,
}

impl Shard {
    /// Parses `2/8`.
    pub fn parse(text: &str) -> std::result::Result<Self, String> {
        let parts = text
            .split_once('/')
            .and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
        match parts {
            Some((index, of)) if (1..=of).contains(&index) => Ok(Self { index, of }),
            _ => Err("expected I/N with I from 1 to N: 2/8 is the second of eight shards".into()),
        }
    }

    /// True if a design belongs to the shard.
    pub fn has(self, number: usize) -> bool {
        number % self.of == self.index - 1
    }

    /// Formats the shard as typed.
    pub fn describe(self) -> String {
        format!("{}/{}", self.index, self.of)
    }
}

/// A case of a sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweptCase {
    /// Its name.
    pub name: String,
    /// Its file, as typed.
    pub file: String,
    /// Checksums of its text, and of its first design as resolved.
    pub crc32: [u32; 2],
}

/// Varied number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepAxis {
    /// JSON pointer.
    pub pointer: String,
    /// Specification of its values; `None` if a table contains them.
    pub spec: Option<String>,
}

/// Requested sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepPlan {
    /// Name of the first case.
    pub case: String,
    /// Analysis of each design.
    pub command: AnalysisKind,
    /// The cases.
    pub cases: Vec<SweptCase>,
    /// Changes to all cases.
    pub sets: Vec<String>,
    /// Varied numbers.
    pub axes: Vec<SweepAxis>,
    /// File that lists designs, and its checksum.
    pub table: Option<(String, u32)>,
    /// Sampling of the designs.
    pub design: Draw,
    /// Seed, if given.
    pub seed: Option<u64>,
    /// Requested relative error.
    pub accuracy: Option<f64>,
    /// True if errors due to meshes are estimated.
    pub mesh_errors: bool,
    /// Number of designs of the whole sweep.
    pub designs: usize,
    /// Shard that is computed here; `None` for all designs.
    pub shard: Option<Shard>,
}

impl SweepPlan {
    /// Name of the varied case; of two cases both names, of more cases the first name and the number of the others.
    pub fn title(&self) -> String {
        match &self.cases[..] {
            [one, other] => format!("{} and {}", one.name, other.name),
            [one, _, others @ ..] => format!("{} and {} other cases", one.name, others.len() + 1),
            _ => self.case.clone(),
        }
    }

    /// True if a design is computed here.
    pub fn has(&self, number: usize) -> bool {
        self.shard.is_none_or(|shard| shard.has(number))
    }

    /// Number of designs computed here.
    pub fn share(&self) -> usize {
        (0..self.designs).filter(|number| self.has(*number)).count()
    }

    /// Returns the plan without its shard.
    pub fn whole(&self) -> Self {
        Self {
            shard: None,
            ..self.clone()
        }
    }

    /// CRC-32 of everything that determines the rows of all shards, without the names of files. Checksums of rows begin
    /// with it.
    pub fn crc32(&self) -> u32 {
        let mut plan = self.whole();
        plan.cases.iter_mut().for_each(|case| case.file.clear());
        if let Some((file, _)) = &mut plan.table {
            file.clear();
        }
        crc32fast::hash(&serde_json::to_vec(&plan).unwrap_or_default())
    }

    /// Describes the first difference between two plans, except names of files.
    pub fn difference(&self, other: &Self) -> Option<String> {
        let differ = |what: &str, here: String, there: String| {
            (here != there).then(|| format!("{what} is {there} there and {here} here"))
        };
        let cases = |plan: &Self| {
            plan.cases
                .iter()
                .map(|case| case.name.clone())
                .collect::<Vec<_>>()
                .join(", ")
        };
        let axes = |plan: &Self| {
            let spec = |axis: &SweepAxis| format!("{}={}", axis.pointer, axis.spec.as_deref().unwrap_or(".."));
            optional_list(&plan.axes.iter().map(spec).collect::<Vec<_>>())
        };
        let optional = |text: Option<String>| text.unwrap_or_else(|| "none".into());
        let changed = self.cases.iter().zip(&other.cases).find(|(a, b)| a.crc32 != b.crc32);
        differ("--command", self.command.describe(), other.command.describe())
            .or_else(|| differ("the list of cases", cases(self), cases(other)))
            .or_else(|| differ("--vary", axes(self), axes(other)))
            .or_else(|| differ("--design", self.design.describe(), other.design.describe()))
            .or_else(|| {
                let seed = |plan: &Self| optional(plan.seed.map(|seed| seed.to_string()));
                differ("--seed", seed(self), seed(other))
            })
            .or_else(|| differ("--set", optional_list(&self.sets), optional_list(&other.sets)))
            .or_else(|| {
                let accuracy = |plan: &Self| optional(plan.accuracy.map(|x| x.to_string()));
                differ("--accuracy", accuracy(self), accuracy(other))
            })
            .or_else(|| {
                (self.mesh_errors != other.mesh_errors).then(|| "--no-mesh-errors is given for only one of them".into())
            })
            .or_else(|| {
                let shard = |plan: &Self| optional(plan.shard.map(Shard::describe));
                differ("--shard", shard(self), shard(other))
            })
            .or_else(|| {
                let sum = |plan: &Self| plan.table.as_ref().map(|(_, crc32)| *crc32);
                (sum(self) != sum(other)).then(|| "the table of designs has changed".into())
            })
            .or_else(|| changed.map(|(case, _)| format!("the case {} has changed", case.name)))
            .or_else(|| {
                differ(
                    "the number of designs",
                    self.designs.to_string(),
                    other.designs.to_string(),
                )
            })
    }

    /// Returns the options that request the same sweep, without `--shard`, `--out` and `--jobs`.
    pub fn options(&self) -> Vec<String> {
        let mut all: Vec<String> = self.cases.iter().map(|case| case.file.clone()).collect();
        let mut put = |option: &str, value: String| all.extend([option.to_owned(), value]);
        for axis in &self.axes {
            if let Some(spec) = &axis.spec {
                put("--vary", format!("{}={spec}", axis.pointer));
            }
        }
        if let Some((file, _)) = &self.table {
            put("--designs", file.clone());
        }
        put("--command", self.command.word().into());
        all.extend(self.command.options());
        let mut put = |option: &str, value: String| all.extend([option.to_owned(), value]);
        if self.design != Draw::Grid {
            put("--design", self.design.describe());
        }
        if let Some(seed) = self.seed {
            put("--seed", seed.to_string());
        }
        for set in &self.sets {
            put("--set", set.clone());
        }
        if let Some(accuracy) = self.accuracy {
            put("--accuracy", accuracy.to_string());
        }
        if !self.mesh_errors {
            all.push("--no-mesh-errors".into());
        }
        all
    }

    /// Returns a command line, quoted for a shell.
    pub fn command_line(&self, more: &[&str]) -> String {
        let head = ["slcbeam".to_owned(), "sweep".to_owned()];
        let options = self.options();
        let words = head
            .into_iter()
            .chain(options)
            .chain(more.iter().map(|word| (*word).to_owned()));
        words.map(|word| quoted(&word)).collect::<Vec<_>>().join(" ")
    }

    /// Returns the command line that computes one design alone, quoted for a shell.
    pub fn design_line(&self, row: &SweepRow) -> String {
        let mut words = vec!["slcbeam".to_owned(), self.command.word().to_owned()];
        words.extend(self.cases.get(row.case).map(|case| case.file.clone()));
        let varied = self.axes.iter().zip(&row.values);
        let varied = varied.map(|(axis, value)| format!("{}={value}", axis.pointer));
        for set in self.sets.iter().cloned().chain(varied) {
            words.extend(["--set".to_owned(), set]);
        }
        words.extend(self.command.options());
        if let Some(accuracy) = self.accuracy.filter(|_| self.command.has_accuracy()) {
            words.extend(["--accuracy".to_owned(), accuracy.to_string()]);
        }
        words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ")
    }

    /// JSON pointers of the varied numbers.
    pub fn pointers(&self) -> Vec<String> {
        self.axes.iter().map(|axis| axis.pointer.clone()).collect()
    }

    /// True if the values of an axis are ordered, as those of a list or a range.
    pub fn listed(&self, axis: usize) -> bool {
        let spec = self.axes.get(axis).and_then(|axis| axis.spec.as_deref());
        spec.is_some_and(|spec| !spec.starts_with("uniform:") && !spec.starts_with("normal:"))
    }

    /// True if the values of an axis are evenly spaced in their logarithms.
    pub fn logarithmic(&self, axis: usize) -> bool {
        let spec = self.axes.get(axis).and_then(|axis| axis.spec.as_deref());
        spec.is_some_and(|spec| spec.starts_with("log:"))
    }

    /// Creates the axes of designs.
    pub fn axes_of(designs: &Designs, specs: &[Option<String>]) -> Vec<SweepAxis> {
        let pointers = designs.pointers().iter().cloned();
        pointers
            .zip(specs)
            .map(|(pointer, spec)| SweepAxis {
                pointer,
                spec: spec.clone(),
            })
            .collect()
    }
}

fn optional_list(all: &[String]) -> String {
    if all.is_empty() { "none".into() } else { all.join(" ") }
}

/// Quotes a word for a shell.
pub fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "_-./=:,%+@".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.into()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}
