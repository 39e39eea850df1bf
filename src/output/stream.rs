//! Files that grow with a run, and marks from which they are known again: so many bytes, with such a checksum.

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
pub struct Mark {
    /// Its length [byte].
    pub bytes: u64,
    /// CRC-32 (ISO-HDLC) of it.
    pub crc32: u32,
}

/// A file that is appended to, with the checksum of all that went into it.
#[derive(Debug)]
pub struct Stream {
    path: PathBuf,
    file: File,
    bytes: u64,
    sum: crc32fast::Hasher,
}

impl Mark {
    /// Of all that a reader has.
    pub fn of(mut from: impl Read) -> io::Result<Self> {
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
    /// Makes the file, empty.
    pub fn create(path: &Path) -> Result<Self> {
        let file = create(path).map_err(|e| fault("create", path, e))?;
        Ok(Self {
            path: path.to_path_buf(),
            file,
            bytes: 0,
            sum: crc32fast::Hasher::new(),
        })
    }

    /// Checks that a file still begins with what was marked; changes nothing.
    ///
    /// # Errors
    ///
    /// It is not there, is shorter, or holds something else.
    pub fn verify(path: &Path, mark: Mark) -> Result<()> {
        let verify = || -> io::Result<()> {
            let file = open(path)?;
            let there = file.metadata()?.len();
            if there < mark.bytes {
                return Err(damaged(format!(
                    "{there} bytes are left of the {} that the checkpoint needs; what there is can be read, but no run goes on from it",
                    mark.bytes
                )));
            }
            if Mark::of(file.take(mark.bytes))? != mark {
                return Err(damaged(
                    "it is not what was written up to the checkpoint (its checksum differs); no run goes on from it",
                ));
            }
            Ok(())
        };
        verify().map_err(|e| fault("go on with", path, e))
    }

    /// Opens a file that is verified and drops what came after the mark.
    pub fn reopen(path: &Path, mark: Mark) -> Result<Self> {
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

    /// Brings what was written to the disk itself.
    pub fn secure(&self) -> Result<Mark> {
        self.file.sync_data().map_err(|e| fault("write", &self.path, e))?;
        Ok(self.mark())
    }

    /// All that was written.
    pub fn mark(&self) -> Mark {
        Mark {
            bytes: self.bytes,
            crc32: self.sum.clone().finalize(),
        }
    }

    /// Where it is.
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
