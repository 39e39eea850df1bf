//! `report.html`: a result folder as a single page that needs neither network nor program.
//!
//! ```text
//! kind        kind of result in a folder
//! page        shell, style, scripts and data as one text
//! base64      arrays as base64
//! frames      fields of a run at chosen instants
//! cell        the cell of the section under its loads
//! history     history.csv, thinned to the resolution of a screen
//! scene       the drawing: beam, bladders, tubes, ports, loads, ends
//! signals     functions of time as text
//! inputs      functions of time as columns beside the history
//! per_cycle   powers and efficiency over the preceding period
//! run         the page of a run or a cycle
//! energy_balance  the energy ledger, its entries and their sum
//! facts       effects, solver, wall time, characteristic numbers as text
//! parameters  the case as a table, described by its schema
//! csv_table   CSV files as tables
//! warnings    warnings with titles and explanations
//! compared    pages that compare several results, or one result with measured data
//! equilibrium, modes, studies, cycles, designs, fit, sense, optimum   the pages of the other commands
//! vendor      uPlot, which draws histories
//! ```
//!
//! The data of a page is JSON in a script element that is not executed. The scripts insert every text of a case as text, so that none of it
//! is parsed as markup. The same folder gives the same bytes.

mod bands;
mod base64;
mod cell;
mod compared;
mod csv_table;
mod cycles;
mod designs;
mod energy_balance;
mod equilibrium;
pub mod facts;
mod fit;
mod frames;
mod history;
mod inputs;
mod modes;
mod optimum;
mod page;
mod parameters;
mod per_cycle;
mod placed;
mod response;
mod run;
mod scene;
mod sense;
mod signals;
mod structure;
mod studies;
mod warnings;

use std::fs;
use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::thread;

use serde_json::{Map, Value, json};

pub use compared::{compared, over_data};

use super::envelope::HistoryInMemory;
use super::folder::{CASE, REPORT, ResultFolder, entries, name_of, open, put_whole, replace_alike, text_of};
use super::kind::FolderKind;
use super::uncertainty::{self, UNCERTAINTY};
use crate::case::{self, Case};
use crate::error::Result;
use crate::integrate::halt;
use crate::numerics::threads::begin;
use crate::results::uncertainty::Uncertainty;
use crate::results::{Head, ResultFile, StoredResult};

/// Size from which a picture or the text of a case is not embedded [byte].
const LARGEST_TEXT: usize = 800_000;

/// Largest number of rows of a table; the file contains the rest.
const MOST_ROWS: usize = 1000;

/// A written page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenPage {
    /// The file.
    pub path: PathBuf,
    /// Size [byte].
    pub bytes: usize,
}

/// Writes the page of a result folder to `out`, or into the folder itself.
///
/// # Errors
///
/// The folder contains no result, a file of it cannot be read, or the page cannot be written.
pub fn write(dir: &Path, out: Option<&Path>) -> Result<WrittenPage> {
    let kind = FolderKind::find("report on", dir)?;
    let path = out.map_or_else(|| dir.join(REPORT), Path::to_path_buf);
    let elsewhere = folder_of(&path) != fs::canonicalize(dir).ok();
    let text = halt::complete(|| text(&Place::new(dir, None), kind, elsewhere))?;
    match out {
        Some(_) => replace_alike(&path, &text, &["<!doctype html"])?,
        None => put_whole(&path, |file| file.write_all(text.as_bytes()))?,
    }
    Ok(WrittenPage {
        path,
        bytes: text.len(),
    })
}

/// Completes a folder that a command has filled: adds the resolved case and the page.
pub fn complete(folder: &ResultFolder, case: &Case) -> Result<()> {
    folder.write_case(&case.written())?;
    write(folder.dir(), None)?;
    folder.secure()
}

/// Lays the page of a run beside its files ([`ResultFolder::lay`]). Reads the history unless it was kept in memory.
///
/// # Errors
///
/// As [`write`].
pub fn lay(folder: &ResultFolder, history: Option<&HistoryInMemory>) -> Result<()> {
    let dir = folder.dir();
    let text = halt::complete(|| text(&Place::new(dir, history), FolderKind::find("report on", dir)?, false))?;
    folder.lay(REPORT, text.as_bytes()).map(|_| ())
}

/// Content of the page of a kind.
fn data(place: &Place, kind: FolderKind) -> Result<Page> {
    match kind {
        FolderKind::Run | FolderKind::Cycle => run::data(place),
        FolderKind::Equilibrium => equilibrium::data(place),
        FolderKind::Modes => modes::data(place),
        FolderKind::Study => studies::study(place),
        FolderKind::Effects => studies::effects(place),
        FolderKind::Floquet => cycles::floquet(place),
        FolderKind::Map => cycles::map(place),
        FolderKind::Sweep => cycles::sweep(place),
        FolderKind::Designs => designs::data(place),
        FolderKind::Fit => fit::data(place),
        FolderKind::Sense => sense::data(place),
        FolderKind::Optimum => optimum::data(place),
        FolderKind::Response => response::data(place),
        FolderKind::Bands => bands::data(place),
    }
}

/// Text of the page.
fn text(place: &Place, kind: FolderKind, elsewhere: bool) -> Result<String> {
    // the table of the parameters takes longest, so a thread computes it
    let (page, parameters) = thread::scope(|scope| {
        let rows = begin(scope, || place.case_text.as_deref().map(parameters::rows));
        let page = data(place, kind);
        (page, rows.join())
    });
    let mut page = page?;
    page.put("parameters", parameters.unwrap_or_default());
    if kind.files().contains(&UNCERTAINTY) && place.path(UNCERTAINTY).is_file() {
        let found = place.result::<Uncertainty>(UNCERTAINTY)?.result;
        page.put("uncertainty", uncertainty::section(&found));
    }
    // Readers of the page need the warnings with explanations; codes alone are not enough.
    page.put("warnings", warnings::groups(&page.warnings));
    if elsewhere {
        page.put("elsewhere", true);
    }
    Ok(page::assemble(&page))
}

/// A folder under report, with its case if readable.
struct Place<'a> {
    dir: &'a Path,
    /// The history of a run that has just ended.
    history: Option<&'a HistoryInMemory>,
    case: Option<Case>,
    case_text: Option<String>,
}

impl<'a> Place<'a> {
    fn new(dir: &'a Path, history: Option<&'a HistoryInMemory>) -> Self {
        let path = dir.join(CASE);
        Self {
            dir,
            history,
            // A case of an older or newer program may be invalid. The page then omits everything that needs it.
            case: case::load(&path, &[]).ok(),
            case_text: text_of(&path).ok(),
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.dir.join(name)
    }

    /// Reads a result of the folder.
    fn result<T: ResultFile>(&self, name: &str) -> Result<StoredResult<T>> {
        super::folder::result(&self.path(name))
    }

    /// Reads the result that identifies a kind and begins its page; `about` returns its case and its warnings.
    fn begun<T: ResultFile>(&self, kind: FolderKind, about: impl Fn(&T) -> (&str, &[String])) -> Result<(T, Page)> {
        let StoredResult { result, head } = self.result::<T>(kind.sign())?;
        let (case, warnings) = about(&result);
        let mut page = self.page(kind, case, Some(&head));
        page.warnings = warnings.to_vec();
        Ok((result, page))
    }

    /// A picture of the folder as image data; for one that is too large, its file and size.
    fn picture(&self, name: &str) -> Option<Value> {
        let mut bytes = vec![];
        let file = open(&self.path(name)).ok()?;
        file.take(LARGEST_TEXT as u64).read_to_end(&mut bytes).ok()?;
        if bytes.len() == LARGEST_TEXT {
            let size = fs::metadata(self.path(name)).ok()?.len();
            return Some(json!({"file": name, "bytes": size}));
        }
        Some(base64::svg(&bytes).into())
    }

    /// Files beside the page, sorted by name; omits hidden files and folders.
    fn files(&self) -> Vec<String> {
        let all = entries(self.dir).unwrap_or_default();
        let names = all.iter().filter(|path| path.is_file()).map(|path| name_of(path));
        names.filter(|n| !n.starts_with('.') && n != REPORT).collect()
    }

    /// Common part of every page, with the given name.
    fn page(&self, kind: FolderKind, name: &str, head: Option<&Head>) -> Page {
        self.page_with(kind, name, head, None)
    }

    /// [`Place::page`] with given rows of characteristic numbers, by default those of the case.
    fn page_with(&self, kind: FolderKind, name: &str, head: Option<&Head>, numbers: Option<Vec<Value>>) -> Page {
        let numbers = numbers.or_else(|| self.case.as_ref().map(facts::characteristic_of));
        let mut page = Page {
            name: name.into(),
            ..Page::default()
        };
        let text = self.case_text.as_ref().filter(|text| text.len() < LARGEST_TEXT);
        page.fill(json!({
            "kind": kind.name(), "version": env!("CARGO_PKG_VERSION"), "made": head.map(Head::describe), "name": name,
            "about": self.case.as_ref().map_or("", |c| c.about.as_str()), "files": self.files(),
            "cell": self.case.as_ref().map_or_else(Vec::new, cell::of_case), "scene": self.case.as_ref().and_then(scene::to_json),
            // placeholder: see `text`
            "parameters": null, "case_text": text, "characteristic": numbers.unwrap_or_default(),
        }));
        page
    }
}

/// Content of a page.
#[derive(Default)]
struct Page {
    /// Title of the page.
    name: String,
    /// Warnings.
    warnings: Vec<String>,
    /// Data for the scripts.
    data: Map<String, Value>,
}

impl Page {
    /// Adds the members of an object.
    fn fill(&mut self, members: Value) {
        if let Value::Object(members) = members {
            self.data.extend(members);
        }
    }

    fn put(&mut self, key: &str, value: impl Into<Value>) {
        self.data.insert(key.into(), value.into());
    }
}

/// Cells of a row of a table.
fn cells(first: impl IntoIterator<Item = Value>, others: impl IntoIterator<Item = Value>) -> Value {
    first.into_iter().chain(others).collect()
}

/// Folder of a file that exists or will be written.
fn folder_of(path: &Path) -> Option<PathBuf> {
    let parent = path.parent().filter(|p| !p.as_os_str().is_empty());
    fs::canonicalize(parent.unwrap_or(Path::new("."))).ok()
}

/// Capitalizes the first letter.
fn capital(text: &str) -> String {
    let mut all = text.chars();
    all.next()
        .map_or(String::new(), |first| first.to_uppercase().chain(all).collect())
}
