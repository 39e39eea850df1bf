//! Case of a result, and its tables.

use std::fs;
use std::path::PathBuf;

use super::{CASE, ResultFolder, entries, name_of, remove, text_of};
use crate::case::{CaseText, is_table};
use crate::error::Result;

impl ResultFolder {
    /// Writes the case after its tables, so that an existing case always has all its tables; then removes all other tables. The files are
    /// on the disk after [`ResultFolder::secure`].
    pub fn write_case(&self, case: &CaseText) -> Result<()> {
        self.write_tables(case)?;
        self.write_once(CASE, &case.json)?;
        self.remove_other_tables(case)
    }

    /// Writes the tables of a case.
    pub(super) fn write_tables(&self, case: &CaseText) -> Result<()> {
        for (name, text) in &case.tables {
            self.write_once(name, text)?;
        }
        Ok(())
    }

    /// Writes a file, unless a regular file with the same text is there.
    fn write_once(&self, name: &str, text: &str) -> Result<()> {
        let path = self.path(name);
        let own = fs::symlink_metadata(&path).is_ok_and(|there| there.is_file());
        if own && text_of(&path).is_ok_and(|there| there == text) {
            return self.record_origin();
        }
        self.lay(name, text.as_bytes()).map(|_| ())
    }

    /// Removes tables of an older case.
    pub(super) fn remove_other_tables(&self, case: &CaseText) -> Result<()> {
        let named = |path: &PathBuf| case.tables.iter().any(|(name, _)| self.path(name) == *path);
        let all = self.tables()?;
        all.iter()
            .filter(|path| !named(path))
            .try_for_each(|path| remove(path).map(|_| ()))
    }

    /// The tables of cases in the folder.
    pub(super) fn tables(&self) -> Result<Vec<PathBuf>> {
        let mut all = entries(&self.dir)?;
        all.retain(|path| is_table(&name_of(path)));
        Ok(all)
    }
}
