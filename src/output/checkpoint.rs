//! `checkpoint.json`: a checkpoint with marks of its files, in two generations.
//!
//! The file has two lines: a heading with length and checksum of the second line, and the checkpoint. A new checkpoint gets its final name
//! only when it is safe on disk. The previous one stays as `checkpoint-before.json`.

use std::fs::{self, File};
use std::io::{self, Read as _};
use std::path::Path;
use std::sync::OnceLock;

use serde::{Deserialize, Serialize};

use super::downsampled_history::SyncedPart;
use super::folder::{CHECKPOINT, CHECKPOINT_BEFORE, ResultFolder, damaged, fault, open};
use super::stream::StreamMark;
use crate::error::Result;
use crate::run::checkpoint::Checkpoint;

/// Format number. Increase it whenever a key of the file or its meaning changes (tests/formats.rs).
const FORMAT: u32 = 14;

/// A checkpoint on disk.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SavedCheckpoint {
    /// Marks of its files.
    #[serde(flatten)]
    pub files: SyncedPart,
    /// The run.
    pub run: Checkpoint,
}

/// The first line.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Heading {
    format: u32,
    /// The program that wrote it, [`build`].
    build: String,
    /// Mark of the second line.
    #[serde(flatten)]
    body: StreamMark,
}

/// Writes a checkpoint completely or not at all; the previous one stays.
pub fn write(folder: &ResultFolder, saved: &SavedCheckpoint) -> Result<()> {
    let path = folder.path(CHECKPOINT);
    let body = serde_json::to_vec(saved).map_err(|e| fault("write", &path, e.into()))?;
    let heading = Heading {
        format: FORMAT,
        build: build(),
        body: StreamMark::from_reader(&body[..]).map_err(|e| fault("write", &path, e))?,
    };
    let mut text = serde_json::to_vec(&heading).map_err(|e| fault("write", &path, e.into()))?;
    text.push(b'\n');
    text.extend(body);
    match fs::rename(&path, folder.path(CHECKPOINT_BEFORE)) {
        Err(e) if e.kind() != io::ErrorKind::NotFound => return Err(fault("rename", &path, e)),
        _ => {}
    }
    folder.write(CHECKPOINT, &text)?;
    folder.secure()
}

/// Reads the newest intact checkpoint of a folder, and the fault of a newer damaged one; `None` if there is no checkpoint.
///
/// # Errors
///
/// Checkpoints exist, but none is usable.
pub fn read(dir: &Path) -> Result<Option<(SavedCheckpoint, Option<String>)>> {
    let newest = one(&dir.join(CHECKPOINT));
    let before = || one(&dir.join(CHECKPOINT_BEFORE));
    match newest {
        Ok(Some(saved)) => Ok(Some((saved, None))),
        Ok(None) => Ok(before()?.map(|saved| (saved, None))),
        Err(e) => match before() {
            Ok(Some(saved)) => Ok(Some((saved, Some(e.to_string())))),
            _ => Err(e),
        },
    }
}

fn one(path: &Path) -> Result<Option<SavedCheckpoint>> {
    let mut text = vec![];
    match open(path).and_then(|mut file| file.read_to_end(&mut text)) {
        Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(e) => return Err(fault("read", path, e)),
        Ok(_) => {}
    }
    let refused = |why: &str| Err(fault("resume from", path, damaged(why)));
    let other = |format: u32| {
        format!("it has format {format} of another version of the program; this one resumes from format {FORMAT}")
    };
    let end = text.iter().position(|&b| b == b'\n').unwrap_or(text.len());
    let (heading, body) = (&text[..end], text.get(end + 1..).unwrap_or_default());
    let Ok(heading) = serde_json::from_slice::<Heading>(heading) else {
        return refused("its first line is not the header of a checkpoint of this version");
    };
    if heading.format != FORMAT {
        return refused(&other(heading.format));
    }
    if StreamMark::from_reader(body).ok() != Some(heading.body) {
        return refused("it is cut short or changed: its checksum differs");
    }
    if heading.build != build() {
        return refused("another build of the program wrote it, so the resumed run may differ; resume with that build");
    }
    serde_json::from_slice(body)
        .map(Some)
        .map_err(|e| fault("resume from", path, e.into()))
}

/// Identifies this build: version, and length and checksum of the executable.
pub fn build() -> String {
    static BUILD: OnceLock<String> = OnceLock::new();
    let name = || {
        let program = std::env::current_exe()
            .and_then(File::open)
            .and_then(StreamMark::from_reader);
        let (bytes, sum) = program.map_or((0, 0), |mark| (mark.bytes, mark.crc32));
        format!("{} {bytes} {sum:08x}", env!("CARGO_PKG_VERSION"))
    };
    BUILD.get_or_init(name).clone()
}
