//! Limited reading of foreign files: devices, and system files that claim a size of 0, are not read forever.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read as _, Seek as _};
use std::os::unix::fs::OpenOptionsExt as _;
use std::path::Path;

use rustix::fs::OFlags;

/// Opens a file to read it. A read that would wait for data, such as of kernel messages, is an error.
///
/// # Errors
/// It cannot be opened, or is a folder, a pipe or a device.
fn open_regular(path: &Path) -> io::Result<File> {
    if !fs::metadata(path)?.is_file() {
        return Err(endless("it is not a regular file"));
    }
    OpenOptions::new()
        .read(true)
        .custom_flags(OFlags::NONBLOCK.bits() as i32)
        .open(path)
}

/// Opens a file to read it piece by piece.
///
/// # Errors
/// It cannot be opened, or has no known end: a pipe, a device, or a system file that claims to be empty and is not.
pub fn open(path: &Path) -> io::Result<File> {
    let mut file = open_regular(path)?;
    if file.metadata()?.len() == 0 && file.read(&mut [0])? > 0 {
        return Err(endless(
            "it is not a regular file: its size is 0 bytes, but it has content",
        ));
    }
    file.rewind()?;
    Ok(file)
}

/// Bytes of a file, whatever size it claims; none if there are more than `largest`.
///
/// # Errors
/// It cannot be read, or is a folder, a pipe or a device.
pub fn bytes(path: &Path, largest: u64) -> io::Result<Option<Vec<u8>>> {
    let mut bytes = vec![];
    open_regular(path)?.take(largest + 1).read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 <= largest).then_some(bytes))
}

fn endless(why: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, why)
}
