//! `checkpoint.json`: a checkpoint with the sizes of the streams that belong to it.

use std::fs;
use std::io;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::folder::{CHECKPOINT, ResultFolder, fault};
use crate::error::Result;
use crate::run::checkpoint::Checkpoint;

/// A checkpoint on disk.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Saved {
    /// Bytes of `history.csv` that belong to it.
    pub history_bytes: u64,
    /// Instants of the raw fields that belong to it.
    pub instants: u64,
    /// The run.
    pub run: Checkpoint,
}

/// Writes it whole or not at all.
pub fn write(folder: &ResultFolder, saved: &Saved) -> Result<()> {
    let text = serde_json::to_vec(saved).map_err(|e| fault("write", &folder.path(CHECKPOINT), e.into()))?;
    folder.write(CHECKPOINT, &text).map(|_| ())
}

/// The checkpoint of a folder; `None` when there is none.
pub fn read(dir: &Path) -> Result<Option<Saved>> {
    let path = dir.join(CHECKPOINT);
    match fs::read(&path) {
        Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(e) => Err(fault("read", &path, e)),
        Ok(text) => serde_json::from_slice(&text)
            .map(Some)
            .map_err(|e| fault("read", &path, e.into())),
    }
}
