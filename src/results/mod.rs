//! Results as stored in files: one type per kind, which writers fill and readers return.
//!
//! | module | content |
//! |---|---|
//! | [`run`] | `summary.json` |
//! | [`equilibrium`] | `equilibrium.json` |
//! | [`modes`] | `modes.json` |
//! | [`response`] | `response.json` |
//! | [`bands`] | `bands.json` |
//! | [`cycles`] | `floquet.json` and `cycle.json`, `map.json`, `sweep.json` |
//! | [`studies`] | `study.json`, `effects.json`, output of `compare --json` |
//! | [`sense`] | `sense.json` |
//! | [`sweep`] | `plan.json` and `sweep.json` of `slcbeam sweep` |
//! | [`uncertainty`] | `uncertainty.json`, beside the result of any command that has figures |
//! | [`fit`] | `fit.json`, output of `compare --json` for a run over data |
//! | [`optimum`] | `optimum.json` |
//! | [`verify`] | a row of the output of `verify --json` |
//! | [`provenance`] | origin of a result |
//! | [`ordered`] | values by name, in their own order |
//!
//! A result is one object: the number of its format, its provenance, and the keys of its type. A number that is not finite is null. A key
//! that is missing or has another type is an error, which names the place.

pub mod bands;
pub mod cycles;
pub mod equilibrium;
pub mod fit;
pub mod modes;
pub mod optimum;
pub mod ordered;
pub mod provenance;
pub mod response;
pub mod run;
pub mod sense;
pub mod studies;
pub mod sweep;
pub mod uncertainty;
pub mod verify;

use std::io;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

pub use provenance::{IntegratorRecord, Provenance};

/// A result stored in a file.
pub trait ResultFile: Serialize + DeserializeOwned {
    /// Format number. Increase it when a key is removed or changes its meaning, not when a key is added. Results without a number precede
    /// format 1.
    const FORMAT: u32 = 1;

    /// Method of time integration, if one method applies to the entire result.
    fn integrator(&self) -> Option<IntegratorRecord> {
        None
    }
}

/// Complete content of the file of a result.
#[derive(Serialize)]
struct Whole<'a, T: ResultFile> {
    format: u32,
    provenance: Provenance,
    #[serde(flatten)]
    found: &'a T,
    #[serde(skip_serializing_if = "Option::is_none")]
    sentence: Option<&'a str>,
}

impl<'a, T: ResultFile> Whole<'a, T> {
    fn new(found: &'a T, sentence: Option<&'a str>) -> Self {
        Self {
            format: T::FORMAT,
            provenance: Provenance::new(found.integrator()),
            found,
            sentence,
        }
    }
}

/// JSON text of a result.
pub fn text<T: ResultFile>(found: &T) -> String {
    text_with(found, None)
}

/// JSON text of a result with a closing sentence about it.
pub fn text_with<T: ResultFile>(found: &T, sentence: Option<&str>) -> String {
    // Serialization fails only for keys that are not text, and there are none.
    serde_json::to_string_pretty(&Whole::new(found, sentence)).unwrap_or_default() + "\n"
}

/// JSON value of a result, as a part of something larger.
pub fn value<T: ResultFile>(found: &T) -> Value {
    serde_json::to_value(Whole::new(found, None)).unwrap_or_default()
}

/// A result that was read.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredResult<T> {
    /// The result.
    pub result: T,
    /// Header of the result.
    pub head: Head,
}

/// Header of a result; empty for results of versions without headers.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Head {
    /// Number of its format.
    pub format: Option<u32>,
    /// Origin of the result.
    pub provenance: Option<Provenance>,
}

impl Head {
    /// Header as a sentence.
    pub fn describe(&self) -> String {
        let by = self.provenance.as_ref().map(Provenance::describe);
        match (self.format, by) {
            (Some(format), Some(by)) => format!("The result has format {format} and was computed by {by}."),
            (Some(format), None) => {
                format!("The result has format {format}; the program that computed it is not recorded.")
            }
            (None, _) => "The result has no format number: a version before format 1 wrote it.".into(),
        }
    }
}

/// Reads a result.
///
/// # Errors
///
/// The text is not JSON, a key is missing or has another type, or a later version wrote it. The error names the place.
pub fn read<T: ResultFile>(text: &str) -> io::Result<StoredResult<T>> {
    let head: Head = parse(text)?;
    if let Some(format) = head.format.filter(|format| *format > T::FORMAT) {
        return Err(damaged(format!(
            "it has format {format} of a later version of the program; this one reads formats up to {}",
            T::FORMAT
        )));
    }
    match parsed(text) {
        Ok(result) => Ok(StoredResult { result, head }),
        Err(why) if head.format.is_none() => Err(damaged(format!(
            "{why}; it has no format number, so that a version before format 1 may have written it"
        ))),
        Err(why) => Err(damaged(why)),
    }
}

/// True if a text is that of a result: a JSON object with the name of a case.
pub fn is_one(text: &str) -> bool {
    #[derive(Deserialize)]
    struct Named {
        #[serde(rename = "case")]
        _case: String,
    }
    parsed::<Named>(text).is_ok()
}

/// Parses JSON.
///
/// # Errors
///
/// As of [`read`].
pub fn parse<T: DeserializeOwned>(text: &str) -> io::Result<T> {
    parsed(text).map_err(damaged)
}

/// Parses JSON. The error has a JSON pointer to the place, unless this is the top.
fn parsed<T: DeserializeOwned>(text: &str) -> Result<T, String> {
    let mut reader = serde_json::Deserializer::from_str(text);
    let value = serde_path_to_error::deserialize(&mut reader).map_err(|e| {
        let place: String = e
            .path()
            .iter()
            .map(|part| format!("/{part}").replace(['[', ']'], ""))
            .collect();
        match place.as_str() {
            "" | "/?" => e.inner().to_string(),
            place => format!("{place}: {}", e.inner()),
        }
    })?;
    reader.end().map_err(|e| e.to_string())?;
    Ok(value)
}

fn damaged(why: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, why)
}
