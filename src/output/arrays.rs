//! `fields.npz`: each field is streamed into a raw file; at the end all raw files are packed. Memory use stays constant.
//!
//! During a run `fields.part/NAME.f64` contains little-endian doubles, instant after instant, and `fields.part/t_fields_s.f64` the times.
//! `numpy.fromfile` reads these files after a killed run.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, BufWriter, Seek, Write};
use std::os::unix::fs::FileExt as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

use npyz::{DType, NpyWriter, WriterBuilder as _};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use super::folder::{AtomicFile, damaged, fault};
use super::history::FLUSH;
use super::stream::{Stream, StreamMark};
use crate::error::Result;
use crate::run::record::{Header, RecordedAxis, RecordedField};

/// Name of the array of times.
pub const TIMES: &str = "t_fields_s";

/// Size of read and write buffers [byte].
const BLOCK: usize = 1 << 16;

/// Part of each raw file that was safe on disk at a checkpoint.
pub type Marks = BTreeMap<String, StreamMark>;

/// Streams fields into raw files and packs these.
#[derive(Debug)]
pub struct ArraysWriter {
    dir: PathBuf,
    axes: Vec<RecordedAxis>,
    fields: Vec<RecordedField>,
    times: RawFile,
    raw: Vec<RawFile>,
    instants: u64,
    flushed: Instant,
}

impl ArraysWriter {
    /// Creates the folder `dir` and the raw files in it.
    pub fn create(dir: &Path, header: &Header) -> Result<Self> {
        fs::create_dir_all(dir).map_err(|e| fault("create", dir, e))?;
        Self::open(dir, header, 0, |name| RawFile::create(dir, name))
    }

    fn open(dir: &Path, header: &Header, instants: u64, file: impl Fn(&str) -> Result<RawFile>) -> Result<Self> {
        let raw = header.fields.iter().map(|f| file(f.name));
        Ok(Self {
            dir: dir.to_path_buf(),
            axes: header.axes.clone(),
            fields: header.fields.clone(),
            raw: raw.collect::<Result<_>>()?,
            times: file(TIMES)?,
            instants,
            flushed: Instant::now(),
        })
    }

    /// Checks that the raw files of an interrupted run still contain the marked parts, with an equal number of instants of each field.
    pub fn verify(dir: &Path, header: &Header, marks: &Marks) -> Result<()> {
        let instants = marks.get(TIMES).map_or(0, |mark| mark.bytes / 8);
        let fields = header.fields.iter().map(|f| (f.name, f.len as u64));
        for (name, len) in fields.chain([(TIMES, 1)]) {
            let path = RawFile::path(dir, name);
            match marks.get(name) {
                Some(mark) if mark.bytes == 8 * len * instants => Stream::verify(&path, *mark)?,
                _ => {
                    let why = "the checkpoint has another number of instants of it";
                    return Err(fault("resume with", &path, damaged(why)));
                }
            }
        }
        Ok(())
    }

    /// Opens the verified raw files of an interrupted run and truncates them at the marks.
    pub fn reopen(dir: &Path, header: &Header, marks: &Marks) -> Result<Self> {
        let mark = |name: &str| marks.get(name).copied().unwrap_or(StreamMark { bytes: 0, crc32: 0 });
        let instants = mark(TIMES).bytes / 8;
        Self::open(dir, header, instants, |name| RawFile::reopen(dir, name, mark(name)))
    }

    /// Syncs all instants to the disk and returns the marks.
    pub fn secure(&mut self) -> Result<Marks> {
        self.flush()?;
        let names = self.fields.iter().map(|f| f.name).chain([TIMES]);
        let raw = self.raw.iter().chain([&self.times]);
        names
            .zip(raw)
            .map(|(name, raw)| Ok((name.to_string(), raw.out.get_ref().secure()?)))
            .collect()
    }

    /// Appends one instant: its time, then all fields in the order of the header.
    pub fn append(&mut self, instant: &[f64]) -> Result<()> {
        if instant.len() != self.numbers() {
            let why = "the arrays do not have the lengths announced";
            return Err(fault(
                "write",
                &self.dir,
                io::Error::new(io::ErrorKind::InvalidInput, why),
            ));
        }
        let (time, mut rest) = instant.split_at(1);
        for (raw, field) in self.raw.iter_mut().zip(&self.fields) {
            let (array, behind) = rest.split_at(field.len);
            raw.append(array)?;
            rest = behind;
        }
        self.times.append(time)?;
        self.instants += 1;
        if self.flushed.elapsed() >= FLUSH {
            self.flush()?;
        }
        Ok(())
    }

    /// Flushes all buffers to the files.
    pub fn flush(&mut self) -> Result<()> {
        self.flushed = Instant::now();
        for raw in &mut self.raw {
            raw.flush()?;
        }
        self.times.flush()
    }

    /// Number of values of an instant: its time and all fields.
    pub(super) fn numbers(&self) -> usize {
        1 + self.fields.iter().map(|f| f.len).sum::<usize>()
    }

    /// All times [s], read back from disk; requires a flush before.
    pub fn times(&self) -> Result<Vec<f64>> {
        let mut all = self.times.read(self.instants as usize, &[0])?;
        Ok(all.pop().unwrap_or_default())
    }

    /// Coordinates of an axis.
    pub fn axis(&self, name: &str) -> Option<&[f64]> {
        self.axes.iter().find(|a| a.name == name).map(|a| a.values.as_slice())
    }

    /// One field at chosen instants, read back from disk; requires a flush before. `None` if there is no such field.
    pub fn read(&self, name: &str, instants: &[usize]) -> Result<Option<Vec<Vec<f64>>>> {
        let Some(k) = self.fields.iter().position(|f| f.name == name) else {
            return Ok(None);
        };
        self.raw[k].read(self.fields[k].len, instants).map(Some)
    }

    /// Packs axes, times and fields into a file that is to become `target`; requires a flush before. The raw files stay.
    ///
    /// Arrays are stored without compression: doubles of a simulation hardly shrink, and stored arrays load faster.
    pub(super) fn packed(&self, target: &Path) -> Result<AtomicFile> {
        AtomicFile::fill(target, |file| self.pack(file))
    }

    fn pack(&self, file: &mut File) -> io::Result<()> {
        let mut npz = ZipWriter::new(BufWriter::new(FirstErrorWriter::new(file)));
        for axis in &self.axes {
            let shape = [axis.values.len() as u64];
            write_array(&mut npz, axis.name, &shape, axis.values.iter().copied())?;
        }
        self.times.pack(&mut npz, TIMES, &[self.instants])?;
        for (field, raw) in self.fields.iter().zip(&self.raw) {
            raw.pack(&mut npz, field.name, &[self.instants, field.len as u64])?;
        }
        npz.finish()?.flush()
    }
}

/// Writer that reports only its first error; later failures count as success. An abandoned archive then prints no message of its own.
pub(super) struct FirstErrorWriter<W> {
    out: W,
    failed: bool,
}

impl<W> FirstErrorWriter<W> {
    pub(super) fn new(out: W) -> Self {
        Self { out, failed: false }
    }

    fn report_once<T>(&mut self, done: io::Result<T>, instead: T) -> io::Result<T> {
        let reported = self.failed;
        self.failed |= done.as_ref().is_err_and(|e| e.kind() != io::ErrorKind::Interrupted);
        if reported { done.or(Ok(instead)) } else { done }
    }
}

impl<W: Write> Write for FirstErrorWriter<W> {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        let done = self.out.write(buffer);
        self.report_once(done, buffer.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        let done = self.out.flush();
        self.report_once(done, ())
    }
}

impl<W: Seek> Seek for FirstErrorWriter<W> {
    fn seek(&mut self, to: io::SeekFrom) -> io::Result<u64> {
        let done = self.out.seek(to);
        self.report_once(done, 0)
    }
}

/// Writes one array into a zip archive of arrays.
pub(super) fn write_array<W: Write + Seek>(
    npz: &mut ZipWriter<W>,
    name: &str,
    shape: &[u64],
    values: impl IntoIterator<Item = f64>,
) -> io::Result<()> {
    let mut blocks = start_array(npz, name, shape)?;
    let mut array = begin(&mut blocks, shape)?;
    for value in values {
        array.push(&value)?;
    }
    array.finish()?;
    blocks.flush()
}

fn start_array<'a, W: Write + Seek>(
    npz: &'a mut ZipWriter<W>,
    name: &str,
    shape: &[u64],
) -> io::Result<BufWriter<&'a mut ZipWriter<W>>> {
    // Archives need larger headers beyond 4 GiB.
    let large = shape.iter().product::<u64>() * 8 > u64::from(u32::MAX) / 2;
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Stored)
        // The same run gives the same file at any time.
        .last_modified_time(DateTime::default())
        .large_file(large);
    npz.start_file(format!("{name}.npy"), options)?;
    Ok(BufWriter::with_capacity(BLOCK, npz))
}

/// Writes the header of an array of little-endian doubles.
fn begin<W: Write>(out: W, shape: &[u64]) -> io::Result<NpyWriter<f64, W>> {
    let doubles = DType::Plain("<f8".parse().map_err(io::Error::other)?);
    npyz::WriteOptions::new()
        .dtype(doubles)
        .shape(shape)
        .writer(out)
        .begin_nd()
}

/// File of little-endian doubles, appended and read back.
#[derive(Debug)]
struct RawFile {
    path: PathBuf,
    out: BufWriter<Stream>,
    bytes: Vec<u8>,
}

impl RawFile {
    fn path(dir: &Path, name: &str) -> PathBuf {
        dir.join(format!("{name}.f64"))
    }

    fn create(dir: &Path, name: &str) -> Result<Self> {
        Ok(Self::new(Stream::create(&Self::path(dir, name))?))
    }

    fn reopen(dir: &Path, name: &str, mark: StreamMark) -> Result<Self> {
        Ok(Self::new(Stream::reopen(&Self::path(dir, name), mark)?))
    }

    fn new(stream: Stream) -> Self {
        Self {
            path: stream.path().to_path_buf(),
            out: BufWriter::with_capacity(BLOCK, stream),
            bytes: Vec::new(),
        }
    }

    fn append(&mut self, values: &[f64]) -> Result<()> {
        self.bytes.clear();
        self.bytes.extend(values.iter().flat_map(|x| x.to_le_bytes()));
        self.out
            .write_all(&self.bytes)
            .map_err(|e| fault("write", &self.path, e))
    }

    fn flush(&mut self) -> Result<()> {
        self.out.flush().map_err(|e| fault("write", &self.path, e))
    }

    /// Reads the given instants, `len` values each.
    fn read(&self, len: usize, instants: &[usize]) -> Result<Vec<Vec<f64>>> {
        let get = || -> io::Result<Vec<Vec<f64>>> {
            let file = File::open(&self.path)?;
            let mut bytes = vec![0; 8 * len];
            let one = |&instant: &usize| {
                file.read_exact_at(&mut bytes, 8 * (instant * len) as u64)?;
                Ok(bytes.as_chunks().0.iter().map(|b| f64::from_le_bytes(*b)).collect())
            };
            instants.iter().map(one).collect()
        };
        get().map_err(|e| fault("read", &self.path, e))
    }

    /// Copies the entire file into a zip archive as an array; requires a flush before.
    fn pack<W: Write + Seek>(&self, npz: &mut ZipWriter<W>, name: &str, shape: &[u64]) -> io::Result<()> {
        let mut blocks = start_array(npz, name, shape)?;
        // only the header: the file already contains the numbers as bytes
        drop(begin(&mut blocks, shape)?);
        let (numbers, bytes) = (
            shape.iter().product::<u64>(),
            io::copy(&mut File::open(&self.path)?, &mut blocks)?,
        );
        if bytes != 8 * numbers {
            return Err(damaged(format!("it holds {bytes} bytes and not {numbers} doubles")));
        }
        blocks.flush()
    }
}
