//! Designs and their cases, from the arguments.

use std::path::{Path, PathBuf};

use super::overridden;
use crate::case::{self, Case};
use crate::cli::arguments::{SweepArguments, parse_all};
use crate::cli::{progress_line, resources, terminal};
use crate::error::{Result, usage};
use crate::study::sweep::plan::{SweepPlan, SweptCase};
use crate::study::sweep::table::DesignTable;
use crate::study::sweep::{Design, Designs, Draw, VariedNumber};

/// Pointers of the values that an accuracy determines.
const CHOSEN: [&str; 3] = ["/mesh/cells_per_segment", "/mesh/cells_per_bladder", "/solver/rtol"];

/// Source of the cases of designs.
pub struct DesignSource {
    /// Files and their texts.
    texts: Vec<(PathBuf, String)>,
    sets: Vec<String>,
    /// The designs.
    pub designs: Designs,
    /// Plan of the designs.
    pub plan: SweepPlan,
    /// Case of the first design.
    pub first: Case,
}

impl DesignSource {
    /// Reads everything, and checks the first design of every case.
    ///
    /// # Errors
    /// Contradictory arguments, or invalid cases.
    pub fn read(asked: &SweepArguments) -> Result<Self> {
        let accuracy = asked.accuracy.map(progress_line::accuracy).transpose()?;
        let draw = Draw::parse(&asked.design)?;
        let varied = parse_all(&asked.vary, VariedNumber::parse)?;
        if varied.is_empty() && asked.designs.is_none() && asked.cases.len() == 1 {
            let what = "only one case, and no number is varied: give --vary POINTER=SPEC, --designs FILE.csv, or \
                        several cases";
            return usage(what);
        }
        let texts = asked.cases.iter().map(|path| Ok((path.clone(), case::text(path)?)));
        let texts = texts.collect::<Result<Vec<_>>>()?;
        let mut table = None;
        let (designs, specs) = match &asked.designs {
            Some(path) => {
                let read = DesignTable::read(path)?;
                table = Some((path.display().to_string(), read.crc32));
                let specs = vec![None; read.pointers.len()];
                (Designs::listed(texts.len(), read)?, specs)
            }
            None => {
                let specs = varied.iter().map(|vary| Some(vary.spec.clone())).collect();
                (Designs::crossed(texts.len(), &varied, draw, asked.seed)?, specs)
            }
        };
        overridden(&asked.sets, designs.pointers(), |varied| format!("{varied} is varied"))?;
        let chosen = designs
            .pointers()
            .iter()
            .find(|pointer| CHOSEN.iter().any(|one| case::is_below(one, pointer)));
        if let (Some(pointer), Some(_)) = (chosen, accuracy) {
            let what = format!(
                "--accuracy chooses mesh and tolerance of every design, so that {pointer} would have no effect"
            );
            return usage(format!("{what}; leave one of them out"));
        }
        let mut plan = SweepPlan {
            case: String::new(),
            command: asked.analysis.analysis()?,
            cases: vec![],
            sets: asked.sets.clone(),
            axes: SweepPlan::axes_of(&designs, &specs),
            table,
            design: draw,
            seed: asked.seed,
            accuracy,
            mesh_errors: !asked.no_mesh_errors,
            designs: designs.count(),
            shard: asked.shard,
        };
        let each = designs.count() / texts.len();
        let mut first = None;
        for (k, (path, text)) in texts.iter().enumerate() {
            let design = designs.design(k * each);
            let case = name_faulty(parse(path, text, &asked.sets, &designs, &design), &designs, &design)?;
            let written = case.written();
            let resolved = written
                .tables
                .iter()
                .fold(written.json, |all, (name, text)| all + name + text);
            plan.cases.push(SweptCase {
                name: case.name.clone(),
                file: path.display().to_string(),
                crc32: [text.as_bytes(), resolved.as_bytes()].map(crc32fast::hash),
            });
            first.get_or_insert(case);
        }
        let Some(first) = first else {
            return usage("no case");
        };
        plan.case.clone_from(&first.name);
        alike(&plan.cases)?;
        Ok(Self {
            texts,
            sets: asked.sets.clone(),
            designs,
            plan,
            first,
        })
    }

    /// Returns the case of a design.
    ///
    /// # Errors
    /// The case is invalid.
    pub fn case(&self, design: &Design) -> Result<Case> {
        let (path, text) = &self.texts[design.case];
        parse(path, text, &self.sets, &self.designs, design)
    }

    /// Checks a design as its command would before it begins.
    ///
    /// # Errors
    /// Those of the command; or `jobs` copies of the case exceed the memory.
    pub fn check(&self, number: usize, jobs: usize) -> Result<()> {
        let case = self.case(&self.designs.design(number))?;
        resources::fits(&case, 0, jobs)?;
        self.plan.command.analysis().check(&case)
    }

    /// Prints the design to which an error belongs.
    pub fn name_design(&self, number: usize, more: usize) {
        name(&self.designs, &self.designs.design(number), more);
    }
}

fn parse(path: &Path, text: &str, sets: &[String], designs: &Designs, design: &Design) -> Result<Case> {
    let own: Vec<String> = design.sets(designs.pointers()).collect();
    let found = case::parse_varied(text, path, path.parent().unwrap_or(Path::new("")), sets, &own);
    found.map_err(|error| error.by(designs.option(), &own))
}

/// Prints the design if its case has an error.
fn name_faulty<T>(found: Result<T>, designs: &Designs, design: &Design) -> Result<T> {
    if found.is_err() {
        name(designs, design, 0);
    }
    found
}

fn name(designs: &Designs, design: &Design, more: usize) {
    let values = design.describe(designs.pointers());
    let place = if values.is_empty() {
        values
    } else {
        format!(" ({values})")
    };
    let more = match more {
        0 => String::new(),
        n => format!(", and {n} more like it"),
    };
    let (number, count) = (design.number, designs.count());
    terminal::print_line(&format!(
        "slcbeam: design {number} of {count}{place} cannot be computed{more}; no design was started"
    ));
}

/// Checks that the names of the cases differ.
fn alike(cases: &[SweptCase]) -> Result<()> {
    for (k, case) in cases.iter().enumerate() {
        if let Some(other) = cases[..k].iter().find(|other| other.name == case.name) {
            return usage(format!(
                "{} and {} both have the name {}, by which rows of the table are distinguished; rename one of the cases",
                other.file, case.file, case.name
            ));
        }
    }
    Ok(())
}
