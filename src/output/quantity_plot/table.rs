//! Columns of a result: the table of each kind, with its usual abscissa and quantities.

use std::path::Path;

use crate::case::nearest;
use crate::discrete::quantities::probes::key;
use crate::error::{Result, usage};
use crate::output::folder::{HISTORY, SUMMARY, fault, open};
use crate::output::kind::FolderKind;
use crate::output::summary;
use crate::output::sweep::pictures;

/// Number of rows that determine if a column is text.
const LOOKED_AT: usize = 100;
/// Table of a sweep.
pub(super) const SWEEP: &str = "sweep.csv";

/// The table of a kind of result.
pub(super) struct TableKind {
    /// Name of the file.
    pub(super) file: &'static str,
    /// Usual abscissa; empty: the first column of numbers.
    over: &'static str,
    /// Usual quantities; empty: the first column behind the abscissa.
    shown: &'static [&'static str],
    /// Text column whose values are curves of their own.
    pub(super) split: Option<&'static str>,
    /// True if rows are points instead of a curve.
    pub(super) marks: bool,
    /// True for logarithmic axes.
    pub(super) logarithmic: [bool; 2],
}

fn table_of(kind: FolderKind) -> TableKind {
    let curve = |file, over, shown| TableKind {
        file,
        over,
        shown,
        split: None,
        marks: false,
        logarithmic: [false; 2],
    };
    let points = |file, over, shown, split| TableKind {
        split,
        marks: true,
        ..curve(file, over, shown)
    };
    match kind {
        FolderKind::Run | FolderKind::Cycle => curve(HISTORY, "t", &["tip_u1"]),
        FolderKind::Equilibrium => curve("path.csv", "load_factor", &["tip_u1"]),
        FolderKind::Modes => points("modes.csv", "frequency", &["damping ratio"], Some("kind")),
        FolderKind::Response => TableKind {
            logarithmic: [true, false],
            ..curve("response.csv", "frequency", &["amplitude", "phase"])
        },
        FolderKind::Bands => points("bands.csv", "wave number", &["frequency"], Some("motion")),
        FolderKind::Floquet => points("floquet.csv", "real part", &["imaginary part"], Some("part")),
        FolderKind::Map => points("map.csv", "frequency", &["amplitude"], Some("verdict")),
        FolderKind::Sweep => curve(SWEEP, "", &[]),
        FolderKind::Designs => points(SWEEP, "", &[], Some("case")),
        FolderKind::Study => TableKind {
            logarithmic: [true; 2],
            ..points("study.csv", "wall_median", &["total_l2"], Some("measure"))
        },
        FolderKind::Effects => points("effects.csv", "steps", &[], Some("left_out")),
        FolderKind::Fit => curve("fit.csv", "", &[]),
        FolderKind::Sense => curve("sense.csv", "t", &[]),
        FolderKind::Optimum => points("designs.csv", "design", &[], Some("search")),
    }
}

/// A path as one word of a shell.
pub fn shell_word(path: &Path) -> String {
    let text = path.display().to_string();
    let plain = |c: char| c.is_alphanumeric() || "/._-+=:@%,".contains(c);
    match !text.is_empty() && text.chars().all(plain) {
        true => text,
        false => format!("'{}'", text.replace('\'', r"'\''")),
    }
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct TableColumn {
    /// Name without unit.
    pub name: String,
    /// Unit; `1` if dimensionless.
    pub unit: String,
    /// True for text or empty cells.
    pub text: bool,
    /// True if all cells are empty.
    pub empty: bool,
}

impl TableColumn {
    /// Heading: `tip_u1 [m]`.
    pub fn heading(&self) -> String {
        format!("{} [{}]", self.name, self.unit)
    }

    /// True if a name means this column: its name, its heading, or its key with unit; blanks and underscores are equal.
    fn is_named(&self, name: &str) -> bool {
        let plain = |text: &str| text.trim().to_lowercase().replace(' ', "_");
        let wanted = plain(name);
        [self.name.clone(), self.heading(), key(&self.name, &self.unit)]
            .iter()
            .any(|own| plain(own) == wanted)
    }
}

/// The table of a result folder.
pub struct ResultTable<'a> {
    pub(super) dir: &'a Path,
    kind: FolderKind,
    pub(super) known: TableKind,
    /// All columns.
    pub columns: Vec<TableColumn>,
}

impl<'a> ResultTable<'a> {
    /// Reads the headings.
    ///
    /// # Errors
    /// The folder has no result or no table, or the table cannot be read.
    pub fn open(dir: &'a Path) -> Result<Self> {
        let kind = FolderKind::find("draw", dir)?;
        let known = table_of(kind);
        let path = dir.join(known.file);
        if !path.is_file() {
            return usage(format!(
                "{}: the result of `slcbeam {}` has no {}, whose columns could be drawn",
                dir.display(),
                kind.command(),
                known.file
            ));
        }
        if known.file == HISTORY && dir.join(SUMMARY).is_file() {
            summary::verify_table(dir, HISTORY, &summary::read(dir)?)?;
        }
        let failed = |e: csv::Error| fault("read", &path, e.into());
        let mut reader = csv::ReaderBuilder::new()
            .flexible(true)
            .from_reader(open(&path).map_err(|e| fault("read", &path, e))?);
        let headings = reader.headers().map_err(failed)?.clone();
        let mut text = vec![false; headings.len()];
        let mut numbers = vec![false; headings.len()];
        for record in reader.records().take(LOOKED_AT) {
            for (k, cell) in record.map_err(failed)?.iter().enumerate().take(headings.len()) {
                let number = cell.trim().parse::<f64>().is_ok();
                numbers[k] |= number;
                text[k] |= !number && !cell.trim().is_empty();
            }
        }
        let columns = headings.iter().zip(text).zip(numbers).map(|((heading, text), number)| {
            let (name, unit) = match heading.trim().strip_suffix(']').and_then(|h| h.rsplit_once(" [")) {
                Some((name, unit)) => (name, unit),
                None => (heading.trim(), "1"),
            };
            TableColumn {
                name: name.into(),
                unit: unit.into(),
                text: text || !number,
                empty: !text && !number,
            }
        });
        let columns = columns.collect();
        Ok(Self {
            dir,
            kind,
            known,
            columns,
        })
    }

    /// Command whose result this is.
    pub fn command(&self) -> &'static str {
        self.kind.command()
    }

    /// True if curves of both may share a panel.
    pub fn is_like(&self, other: &Self) -> bool {
        self.known.file == other.known.file
    }

    /// Columns of numbers.
    pub fn numbers(&self) -> impl Iterator<Item = &TableColumn> {
        self.columns.iter().filter(|column| !column.text)
    }

    /// Index of a quantity.
    ///
    /// # Errors
    /// There is none of this name; the message has the nearest one.
    pub fn find(&self, name: &str) -> Result<usize> {
        if let Some(k) = self.columns.iter().position(|column| column.is_named(name)) {
            let column = &self.columns[k];
            let contents = if column.empty { "no values" } else { "text, not numbers" };
            return match column.text {
                false => Ok(k),
                true => usage(format!(
                    "--quantity {name}: this column of {} has {contents}",
                    self.known.file
                )),
            };
        }
        let (dir, list) = (self.dir.display(), shell_word(self.dir));
        let near = nearest(name, self.numbers().map(|column| column.name.as_str()));
        let near = near.map_or_else(String::new, |near| format!("; did you mean {near}?"));
        usage(format!(
            "--quantity {name}: {dir}, a result of `slcbeam {}`, has no such column{near}; `slcbeam plot {list} --list` prints all names",
            self.kind.command()
        ))
    }

    /// Usual abscissa.
    pub(super) fn abscissa(&self) -> Option<usize> {
        let named = || {
            self.columns
                .iter()
                .position(|column| column.name == self.known.over && !column.text)
        };
        let varied = || {
            self.columns
                .iter()
                .position(|column| column.name.starts_with('/') && !column.text)
        };
        named()
            .or_else(varied)
            .or_else(|| self.columns.iter().position(|column| !column.text))
    }

    /// Usual quantities.
    ///
    /// # Errors
    /// The folder has a picture of its own, and no single column of the table is the result.
    pub fn usual(&self) -> Result<Vec<usize>> {
        use FolderKind::{Effects, Fit, Map, Optimum, Sense, Study};
        if ![Study, Effects, Fit, Sense, Optimum, Map].contains(&self.kind) {
            return Ok(self.main());
        }
        let dir = shell_word(self.dir);
        let there = |name: &&str| name.ends_with(".svg") && self.dir.join(name).is_file();
        let pictures: Vec<&str> = self.kind.files().into_iter().filter(there).collect();
        let has = match pictures.as_slice() {
            [] => String::new(),
            pictures => format!("its picture is {} in that folder; ", pictures.join(", ")),
        };
        usage(format!(
            "{}: the result of `slcbeam {}` has no usual quantity; {has}--quantity draws columns of {}, and `slcbeam plot {dir} --list` \
             prints their names",
            self.dir.display(),
            self.kind.command(),
            self.known.file
        ))
    }

    fn main(&self) -> Vec<usize> {
        let shown = self.known.shown.iter().filter_map(|name| {
            let begins = |column: &TableColumn| column.name == *name || column.name.starts_with(&format!("{name} "));
            self.columns.iter().position(|column| begins(column) && !column.text)
        });
        let shown: Vec<usize> = shown.collect();
        if !shown.is_empty() {
            return shown;
        }
        let preferred = pictures::FIRST.iter().find_map(|name| {
            self.columns
                .iter()
                .position(|column| column.name == *name && !column.text)
        });
        if let Some(k) = preferred {
            return vec![k];
        }
        let after = self
            .columns
            .iter()
            .position(|column| ["status", "reason"].contains(&column.name.as_str()));
        let first = after.or_else(|| self.abscissa()).map_or(0, |k| k + 1);
        let next = (first..self.columns.len()).find(|k| !self.columns[*k].text);
        next.into_iter().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    /// Goal: a result with a picture of its own names it instead of a useless curve; its columns remain.
    #[test]
    fn some_results_have_pictures_of_their_own() {
        let folder = tempfile::tempdir().expect("a folder");
        let dir = folder.path().join("a study");
        fs::create_dir(&dir).expect("a folder");
        let files = [
            ("study.json", "{}"),
            ("study.csv", "nodes [1],wall_median [s],total_l2 [1],none\n3,0.1,0.2,\n"),
            ("study.svg", ""),
        ];
        for (name, text) in files {
            fs::write(dir.join(name), text).expect("a file");
        }
        let table = ResultTable::open(&dir).expect("a table");
        let why = table.usual().expect_err("no usual quantity").to_string();
        let hint = format!("slcbeam plot '{}' --list", dir.display());
        for part in ["study.svg", "study.csv", &hint] {
            assert!(why.contains(part), "{part}: {why}");
        }
        assert!(table.find("total_l2").is_ok());
        let why = table.find("none").expect_err("an empty column").to_string();
        assert!(why.contains("has no values"), "{why}");
    }

    #[test]
    fn paths_are_words_of_a_shell() {
        assert_eq!(shell_word(Path::new("out/first-2")), "out/first-2");
        assert_eq!(shell_word(Path::new("it's $1")), r"'it'\''s $1'");
    }
}
