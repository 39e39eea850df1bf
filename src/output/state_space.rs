//! A state-space model as a file: arrays for NumPy, or JSON.

use std::io::{self, Write as _};
use std::path::Path;

use serde::Serialize;
use zip::ZipWriter;

use super::arrays::write_array;
use super::folder::{fault, put_whole};
use crate::error::{Error, Result};
use crate::run::response::state_space::StateSpace;

/// A model with the names of its case, input and outputs.
#[derive(Serialize)]
struct Named<'a> {
    case: &'a str,
    /// Signal of the case.
    input: &'a str,
    /// Derivative of the signal that is the input of the model: 0 (its value), 1 or 2.
    input_rate: usize,
    outputs: Vec<String>,
    states: &'a [String],
    at_s: f64,
    a: &'a [Vec<f64>],
    b: &'a [f64],
    c: &'a [Vec<f64>],
    d: &'a [f64],
    x0: &'a [f64],
    u0: f64,
    z0: &'a [f64],
}

/// Writes a model to a file, `.npz` or `.json`.
///
/// # Errors
/// The ending is neither `.npz` nor `.json`, or the file cannot be written.
pub fn write(path: &Path, case: &str, input: &str, outputs: Vec<String>, at_s: f64, model: &StateSpace) -> Result<()> {
    let bytes = match path.extension().and_then(|ending| ending.to_str()) {
        Some("npz") => arrays(model).map_err(|why| fault("write", path, why))?,
        Some("json") => {
            let named = Named {
                case,
                input,
                input_rate: model.input_rate,
                outputs,
                states: &model.states,
                at_s,
                a: &model.a,
                b: &model.b,
                c: &model.c,
                d: &model.d,
                x0: &model.x0,
                u0: model.u0,
                z0: &model.z0,
            };
            (serde_json::to_string(&named).unwrap_or_default() + "\n").into_bytes()
        }
        _ => {
            let what = format!(
                "--state-space {}: a file that ends in .npz or .json is wanted",
                path.display()
            );
            return Err(Error::Usage(what));
        }
    };
    put_whole(path, |file| file.write_all(&bytes))
}

/// Arrays `A`, `B`, `C`, `D`, `input_rate`, `x0`, `u0`, `z0`.
fn arrays(model: &StateSpace) -> io::Result<Vec<u8>> {
    let mut npz = ZipWriter::new(io::Cursor::new(Vec::new()));
    let [n, outputs] = [model.b.len() as u64, model.d.len() as u64];
    let all = |rows: &[Vec<f64>]| rows.iter().flatten().copied().collect::<Vec<f64>>();
    write_array(&mut npz, "A", &[n, n], all(&model.a))?;
    write_array(&mut npz, "B", &[n, 1], model.b.clone())?;
    write_array(&mut npz, "C", &[outputs, n], all(&model.c))?;
    write_array(&mut npz, "D", &[outputs, 1], model.d.clone())?;
    write_array(&mut npz, "input_rate", &[1], [model.input_rate as f64])?;
    write_array(&mut npz, "x0", &[n], model.x0.clone())?;
    write_array(&mut npz, "u0", &[1], [model.u0])?;
    write_array(&mut npz, "z0", &[outputs], model.z0.clone())?;
    Ok(npz.finish()?.into_inner())
}
