//! The shared library of an FMU, and the libraries that it needs.

use std::collections::BTreeMap;
use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::{Path, PathBuf};

use crate::error::{Error, Result, usage};
use crate::output::folder::fault;

/// File name of the library.
pub const LIBRARY: &str = "libslcbeam_fmu.so";

/// Text within the library that names its version.
pub const MARK: &str = concat!("slcbeam FMU library ", env!("CARGO_PKG_VERSION"), ";");

/// Variable of the environment with the path of the library.
const VARIABLE: &str = "SLCBEAM_FMU_LIBRARY";

/// Beginnings of the names of libraries that every Linux system has.
const OF_SYSTEM: [&str; 7] = [
    "libc.so",
    "libm.so",
    "libgcc_s.so",
    "libpthread.so",
    "libdl.so",
    "librt.so",
    "ld-linux",
];

/// Folders of libraries on usual systems.
const FOLDERS: [&str; 4] = [
    "/usr/lib/x86_64-linux-gnu",
    "/lib/x86_64-linux-gnu",
    "/usr/lib64",
    "/usr/lib",
];

/// Contents of the library, and of all that it needs, by file name.
pub struct Libraries {
    /// The library.
    pub own: Vec<u8>,
    /// Further libraries.
    pub needed: BTreeMap<String, Vec<u8>>,
}

impl Libraries {
    /// Reads the library beside the program, or where a package puts it, and the libraries that it needs.
    ///
    /// # Errors
    /// [`Error::Usage`] if the library is missing or of another version; a library that it needs cannot be found or read.
    pub fn find() -> Result<Self> {
        let program = std::env::current_exe().and_then(fs::canonicalize).unwrap_or_default();
        let programs = std::env::var_os("PATH").unwrap_or_default();
        let path = path(std::env::var_os(VARIABLE), &program, &programs)?;
        let own = read(&path)?;
        if !own.windows(MARK.len()).any(|part| part == MARK.as_bytes()) {
            return usage(format!(
                "--fmu: {} belongs to another version of slcbeam. Build it again: cargo build --release --package slcbeam-fmu",
                path.display()
            ));
        }
        let mut folders = loaded();
        folders.extend(path.parent().map(Path::to_owned));
        folders.extend(FOLDERS.map(PathBuf::from));
        let mut needed: BTreeMap<String, Vec<u8>> = BTreeMap::new();
        let mut open = names(&own);
        while let Some(name) = open.pop() {
            if needed.contains_key(&name) || OF_SYSTEM.iter().any(|begin| name.starts_with(begin)) {
                continue;
            }
            let file = folders
                .iter()
                .map(|folder| folder.join(&name))
                .find(|file| file.is_file());
            let bytes = read(&file.ok_or_else(|| {
                Error::Usage(format!(
                    "--fmu: the library {name}, which {LIBRARY} needs, is missing. Install it, or name its folder in LD_LIBRARY_PATH"
                ))
            })?)?;
            open.extend(names(&bytes));
            needed.insert(name, bytes);
        }
        Ok(Self { own, needed })
    }
}

fn read(path: &Path) -> Result<Vec<u8>> {
    fs::read(path).map_err(|why| fault("read", path, why))
}

/// Path of the library: that of the variable, else beside the program or where packages put it, else beside a program on the `PATH`.
fn path(given: Option<OsString>, program: &Path, programs: &OsStr) -> Result<PathBuf> {
    if let Some(path) = given {
        return Ok(path.into());
    }
    let mut folders: Vec<PathBuf> = program.parent().map(Path::to_owned).into_iter().collect();
    let on_path = std::env::split_paths(programs).filter(|folder| folder.join("slcbeam").is_file());
    folders.extend(on_path.filter_map(|folder| fs::canonicalize(folder).ok()));
    let places = |folder: &PathBuf| ["", "../lib/slcbeam", "lib"].map(|below| folder.join(below).join(LIBRARY));
    let found = folders.iter().flat_map(places).find(|path| path.is_file());
    found.ok_or_else(|| {
        Error::Usage(format!(
            "--fmu: {LIBRARY} is missing beside the program, {}. Build it: cargo build --release --package slcbeam-fmu; or set \
             {VARIABLE} to its path",
            program.display()
        ))
    })
}

/// Folders of the libraries that this process has loaded.
fn loaded() -> Vec<PathBuf> {
    let maps = fs::read_to_string("/proc/self/maps").unwrap_or_default();
    let files = maps.lines().filter_map(|line| Some(&line[line.find('/')?..]));
    let mut folders: Vec<PathBuf> = files
        .filter(|file| file.contains(".so"))
        .filter_map(|file| Some(Path::new(file).parent()?.to_owned()))
        .collect();
    folders.dedup();
    folders
}

/// Names of the libraries that an ELF file of 64 bits needs; none for other files.
///
/// The program headers locate the dynamic section (type 2) and the loaded segments (type 1). Its entries are pairs of a tag and a
/// value: 1 is a needed name, 5 the address of the names. Source: System V ABI, ELF-64 Object File Format.
fn names(bytes: &[u8]) -> Vec<String> {
    let word = |at: usize, size: usize| -> Option<usize> {
        let part = bytes.get(at..at.checked_add(size)?)?;
        Some(part.iter().rev().fold(0, |sum, byte| sum << 8 | usize::from(*byte)))
    };
    let read = || -> Option<Vec<String>> {
        if bytes.get(..5)? != b"\x7fELF\x02" {
            return None;
        }
        let (table, size, count) = (word(32, 8)?, word(54, 2)?, word(56, 2)?);
        let headers: Vec<[usize; 4]> = (0..count)
            .filter_map(|k| {
                let at = table + k * size;
                Some([word(at, 4)?, word(at + 8, 8)?, word(at + 16, 8)?, word(at + 32, 8)?])
            })
            .collect();
        let [_, start, _, length] = *headers.iter().find(|[kind, ..]| *kind == 2)?;
        let entries: Vec<[usize; 2]> = (0..length / 16)
            .filter_map(|k| Some([word(start + 16 * k, 8)?, word(start + 16 * k + 8, 8)?]))
            .collect();
        let address = entries.iter().find(|[tag, _]| *tag == 5)?[1];
        let loaded = |[kind, _, from, length]: &&[usize; 4]| *kind == 1 && (*from..from + length).contains(&address);
        let [_, offset, from, _] = *headers.iter().find(loaded)?;
        let text = address - from + offset;
        let name = |[_, at]: &[usize; 2]| {
            let rest = bytes.get(text + at..)?;
            let end = rest.iter().position(|byte| *byte == 0)?;
            Some(String::from_utf8_lossy(&rest[..end]).into_owned())
        };
        Some(entries.iter().filter(|[tag, _]| *tag == 1).filter_map(name).collect())
    };
    read().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use std::ffi::OsStr;
    use std::fs;

    use super::{LIBRARY, names, path};

    /// Goal: places of the library, in their order, and the message if there is none.
    #[test]
    fn the_library_is_found_beside_the_program_or_in_its_packages() {
        let folder = tempfile::tempdir().unwrap();
        let at = |place: &str| folder.path().join(place);
        let program = at("usr/bin/slcbeam");
        let put = |place: &str| {
            fs::create_dir_all(at(place).parent().unwrap()).unwrap();
            fs::write(at(place), "").unwrap();
            fs::canonicalize(at(place)).unwrap()
        };
        put("usr/bin/slcbeam");
        let find = |programs: &str| path(None, &program, OsStr::new(programs));
        let why = find("").unwrap_err().to_string();
        assert!(why.contains("cargo build --release --package slcbeam-fmu"), "{why}");
        put("other/slcbeam");
        let elsewhere = put(&format!("other/lib/{LIBRARY}"));
        assert_eq!(find(at("other").to_str().unwrap()).unwrap(), elsewhere);
        let packaged = put(&format!("usr/lib/slcbeam/{LIBRARY}"));
        assert_eq!(fs::canonicalize(find("").unwrap()).unwrap(), packaged);
        let beside = put(&format!("usr/bin/{LIBRARY}"));
        assert_eq!(fs::canonicalize(find("").unwrap()).unwrap(), beside);
        assert_eq!(
            path(Some("given".into()), &program, OsStr::new("")).unwrap(),
            OsStr::new("given")
        );
    }

    /// Goal: the parts of the ELF format that are read, on this test program, which needs the C library and SUNDIALS.
    #[test]
    fn needed_libraries_are_read_from_a_program() {
        let needed = names(&std::fs::read(std::env::current_exe().unwrap()).unwrap());
        assert!(needed.iter().any(|name| name == "libc.so.6"), "{needed:?}");
        assert!(needed.iter().any(|name| name.starts_with("libsundials")), "{needed:?}");
        assert!(names(b"no program").is_empty());
    }
}
