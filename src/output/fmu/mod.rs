//! FMUs of FMI 3.0: a case as a model for co-simulation in other programs.
//!
//! An FMU is a ZIP file: `modelDescription.xml`, a shared library (crate `slcbeam-fmu`) with the libraries that it needs, and the
//! model: the case, or the matrices of small motions.

mod description;
mod library;
mod units;

use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

pub use library::{LIBRARY, Libraries, MARK};

use super::folder::{fault, put_whole};
use crate::case::Case;
use crate::case::readable::{pointer_name, pointer_unit};
use crate::error::Result;
use crate::run::record::HistoryColumn;
use crate::run::response::state_space::StateSpace;

/// File of the variables within `resources/`.
pub const SETUP: &str = "fmu.json";
/// File of the case within `resources/`.
pub const CASE: &str = "case.json";
/// File of the matrices within `resources/`.
pub const LINEAR: &str = "linear.json";

/// Folder of the libraries.
const BINARIES: &str = "binaries/x86_64-linux";

/// Copyright texts of the libraries, where packages have them.
const COPYRIGHTS: [(&str, &str); 2] = [
    ("/usr/share/doc/libklu1/copyright", "suitesparse.txt"),
    ("/usr/share/doc/libsundials-idas5/copyright", "sundials.txt"),
];

/// Licences of the libraries in short.
const NOTICE: &str = "\
The libraries in binaries/ besides that of the model, and their licences:
  libsundials_*                                BSD-3-Clause
  libklu, libbtf                               LGPL-2.1-or-later
  libamd, libcolamd, libsuitesparseconfig      BSD-3-Clause
  libmetis                                     Apache-2.0
Each is a separate file, which may be replaced by another build of the same version.
";

/// An input of an FMU.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FmuInput {
    /// JSON pointer of the signal in the case.
    pub pointer: String,
    /// Smallest and largest value; none for a linear model.
    pub range: Option<[f64; 2]>,
    /// Value at the start.
    pub start: f64,
}

impl FmuInput {
    /// Name of the variable: `network.chains[0].ends[0].pressure_pa` for `/network/chains/0/ends/0/pressure_pa`.
    pub fn name(&self) -> String {
        let pointer = self.pointer.strip_suffix("/signal").unwrap_or(&self.pointer);
        pointer.split('/').skip(1).fold(String::new(), |name, key| {
            match key.bytes().all(|byte| byte.is_ascii_digit()) {
                true => format!("{name}[{key}]"),
                false if name.is_empty() => key.to_owned(),
                false => format!("{name}.{key}"),
            }
        })
    }

    /// Unit of the variable, in the form of result columns.
    pub fn unit(&self) -> &'static str {
        pointer_unit(self.pointer.strip_suffix("/signal").unwrap_or(&self.pointer))
    }

    /// Description of the variable.
    fn about(&self) -> String {
        format!("{} (signal {} of the case)", pointer_name(&self.pointer), self.pointer)
    }
}

/// Variables of an FMU: value reference 0 is the time, then follow the inputs, then the outputs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FmuSetup {
    /// Identifies the model for the importer.
    pub token: String,
    /// Inputs.
    pub inputs: Vec<FmuInput>,
    /// Names of the history's columns that are outputs.
    pub outputs: Vec<String>,
}

/// Contents of an FMU besides its library.
pub struct FmuContents<'a> {
    /// The case.
    pub case: &'a Case,
    /// Inputs.
    pub inputs: Vec<FmuInput>,
    /// Columns of the outputs.
    pub outputs: Vec<HistoryColumn>,
    /// Matrices of a linear model; the case itself is then left out.
    pub linear: Option<StateSpace>,
}

impl FmuContents<'_> {
    /// File of the model in `resources/`, and its text.
    fn model(&self) -> (&'static str, String) {
        let text = match &self.linear {
            Some(model) => serde_json::to_string(model),
            None => serde_json::to_string_pretty(&self.case.resolved()),
        };
        let name = if self.linear.is_some() { LINEAR } else { CASE };
        (name, text.unwrap_or_default() + "\n")
    }

    /// Variables, with a token that identifies the model and them.
    pub fn setup(&self) -> FmuSetup {
        let mut setup = FmuSetup {
            token: String::new(),
            inputs: self.inputs.clone(),
            outputs: self.outputs.iter().map(|column| column.name.clone()).collect(),
        };
        let mut hasher = DefaultHasher::new();
        (MARK, self.model(), serde_json::to_string(&setup).unwrap_or_default()).hash(&mut hasher);
        setup.token = format!("slcbeam-{:016x}", hasher.finish());
        setup
    }

    /// Identifier of the model in C: the name of the case with other characters replaced.
    pub fn identifier(&self) -> String {
        let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
        let name: String = self.case.name.chars().map(plain).collect();
        match name.starts_with(|c: char| c.is_ascii_alphabetic()) {
            true => name,
            false => format!("case_{name}"),
        }
    }

    /// Text of `modelDescription.xml`.
    pub fn description(&self) -> String {
        description::text(self)
    }

    /// Writes the FMU and returns its size [byte].
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, path: &Path, libraries: &Libraries) -> Result<u64> {
        let bytes = self.archive(libraries).map_err(|why| fault("write", path, why))?;
        put_whole(path, |file| file.write_all(&bytes))?;
        Ok(bytes.len() as u64)
    }

    fn archive(&self, libraries: &Libraries) -> io::Result<Vec<u8>> {
        let mut zip = ZipWriter::new(io::Cursor::new(Vec::new()));
        let mut put = |name: &str, mode: u32, bytes: &[u8]| -> io::Result<()> {
            let options = SimpleFileOptions::default()
                .compression_method(CompressionMethod::Stored)
                .last_modified_time(DateTime::default())
                .unix_permissions(mode);
            zip.start_file(name, options)?;
            zip.write_all(bytes)
        };
        let (name, model) = self.model();
        let setup = serde_json::to_string_pretty(&self.setup()).unwrap_or_default() + "\n";
        put("modelDescription.xml", 0o644, self.description().as_bytes())?;
        put(&format!("resources/{name}"), 0o644, model.as_bytes())?;
        put(&format!("resources/{SETUP}"), 0o644, setup.as_bytes())?;
        put(&format!("{BINARIES}/{}.so", self.identifier()), 0o755, &libraries.own)?;
        for (name, bytes) in &libraries.needed {
            put(&format!("{BINARIES}/{name}"), 0o755, bytes)?;
        }
        let licences = "documentation/licenses";
        put(
            &format!("{licences}/license.txt"),
            0o644,
            include_bytes!("../../../LICENSE"),
        )?;
        put(&format!("{licences}/libraries.txt"), 0o644, NOTICE.as_bytes())?;
        for (path, name) in COPYRIGHTS {
            if let Ok(text) = std::fs::read(PathBuf::from(path)) {
                put(&format!("{licences}/{name}"), 0o644, &text)?;
            }
        }
        Ok(zip.finish()?.into_inner())
    }
}
