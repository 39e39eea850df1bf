//! Files that grow with a run, and marks that identify their content: a length with a checksum.

use std::fs::File;
use std::io::{self, Read, Seek as _, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::folder::{create, damaged, fault, open};
use crate::error::Result;

/// Bytes read at once.
const BLOCK: usize = 1 << 16;

/// The part of a file that was safe on disk at a checkpoint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct StreamMark {
    /// Its length [byte].
    pub bytes: u64,
    /// CRC-32 (ISO-HDLC) of it.
    pub crc32: u32,
}

/// A file for appending, with the checksum of its content.
#[derive(Debug)]
pub struct Stream {
    path: PathBuf,
    file: File,
    bytes: u64,
    sum: crc32fast::Hasher,
}

impl StreamMark {
    /// Mark of the entire content of a reader.
    pub fn from_reader(mut from: impl Read) -> io::Result<Self> {
        let (mut sum, mut bytes, mut block) = (crc32fast::Hasher::new(), 0, [0; BLOCK]);
        loop {
            match from.read(&mut block)? {
                0 => {
                    let crc32 = sum.finalize();
                    return Ok(Self { bytes, crc32 });
                }
                n => {
                    sum.update(&block[..n]);
                    bytes += n as u64;
                }
            }
        }
    }
}

impl Stream {
    /// Creates an empty file.
    pub fn create(path: &Path) -> Result<Self> {
        let file = create(path).map_err(|e| fault("create", path, e))?;
        Ok(Self {
            path: path.to_path_buf(),
            file,
            bytes: 0,
            sum: crc32fast::Hasher::new(),
        })
    }

    /// Checks that a file still begins with the marked content; changes nothing.
    ///
    /// # Errors
    ///
    /// The file is missing, too short, or has other content.
    pub fn verify(path: &Path, mark: StreamMark) -> Result<()> {
        let verify = || -> io::Result<()> {
            let file = open(path)?;
            let there = file.metadata()?.len();
            if there < mark.bytes {
                return Err(damaged(format!(
                    "it has {there} bytes (the checkpoint needs {}); its content can be read, but the run cannot be resumed",
                    mark.bytes
                )));
            }
            if StreamMark::from_reader(file.take(mark.bytes))? != mark {
                return Err(damaged(
                    "its checksum differs from that at the checkpoint; the run cannot be resumed",
                ));
            }
            Ok(())
        };
        verify().map_err(|e| fault("resume with", path, e))
    }

    /// Opens a verified file and truncates it at the mark.
    pub fn reopen(path: &Path, mark: StreamMark) -> Result<Self> {
        let open = || -> io::Result<File> {
            let mut file = File::options().write(true).open(path)?;
            file.set_len(mark.bytes)?;
            file.seek(SeekFrom::End(0))?;
            Ok(file)
        };
        Ok(Self {
            path: path.to_path_buf(),
            file: open().map_err(|e| fault("open", path, e))?,
            bytes: mark.bytes,
            sum: crc32fast::Hasher::new_with_initial_len(mark.crc32, mark.bytes),
        })
    }

    /// Syncs the written content to the disk and returns its mark.
    pub fn secure(&self) -> Result<StreamMark> {
        self.file.sync_data().map_err(|e| fault("write", &self.path, e))?;
        Ok(self.mark())
    }

    /// Mark of all written content.
    pub fn mark(&self) -> StreamMark {
        StreamMark {
            bytes: self.bytes,
            crc32: self.sum.clone().finalize(),
        }
    }

    /// Path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl Write for Stream {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        let written = self.file.write(buffer)?;
        self.sum.update(&buffer[..written]);
        self.bytes += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}
