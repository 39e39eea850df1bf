//! A state-space model as a file: arrays for NumPy or MATLAB, or JSON.

use std::io::{self, Write as _};
use std::path::Path;

use serde::Serialize;
use zip::ZipWriter;

use super::arrays::write_array;
use super::folder::{fault, put_whole};
use crate::error::{Result, usage};
use crate::run::response::self_test::SelfTest;
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
    /// First and last frequency of a reduced model, and its largest error over them.
    #[serde(skip_serializing_if = "Option::is_none")]
    band_hz: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<f64>,
    /// Comparison with the nonlinear equations, if there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    self_test: Option<&'a SelfTest>,
}

/// Writes a model to a file, `.npz`, `.mat` or `.json`.
///
/// # Errors
/// The file has another ending, or the file cannot be written.
pub fn write(
    path: &Path,
    case: &str,
    input: &str,
    outputs: Vec<String>,
    at_s: f64,
    (model, tested): (&StateSpace, Option<&SelfTest>),
) -> Result<()> {
    let bytes = match path.extension().and_then(|ending| ending.to_str()) {
        Some("npz") => npz(model, tested).map_err(|why| fault("write", path, why))?,
        Some("mat") => mat(model, tested),
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
                band_hz: model.reduction.map(|reduction| reduction.band),
                error: model.reduction.map(|reduction| reduction.error),
                self_test: tested,
            };
            (serde_json::to_string(&named).unwrap_or_default() + "\n").into_bytes()
        }
        _ => {
            let what = format!(
                "--state-space {}: a file that ends in .npz, .mat or .json is wanted",
                path.display()
            );
            return usage(what);
        }
    };
    put_whole(path, |file| file.write_all(&bytes))
}

/// Matrices of a file: name, rows, columns, entries row by row.
fn matrices(model: &StateSpace, tested: Option<&SelfTest>) -> Vec<(&'static str, [usize; 2], Vec<f64>)> {
    let [n, outputs] = [model.b.len(), model.d.len()];
    let all = |rows: &[Vec<f64>]| rows.iter().flatten().copied().collect::<Vec<f64>>();
    let mut matrices = vec![
        ("A", [n, n], all(&model.a)),
        ("B", [n, 1], model.b.clone()),
        ("C", [outputs, n], all(&model.c)),
        ("D", [outputs, 1], model.d.clone()),
        ("input_rate", [1, 1], vec![model.input_rate as f64]),
        ("x0", [n, 1], model.x0.clone()),
        ("u0", [1, 1], vec![model.u0]),
        ("z0", [outputs, 1], model.z0.clone()),
    ];
    if let Some(reduction) = model.reduction {
        matrices.push(("band_hz", [2, 1], reduction.band.to_vec()));
        matrices.push(("error", [1, 1], vec![reduction.error]));
    }
    if let Some(test) = tested {
        matrices.push(("self_test_step", [1, 1], vec![test.step]));
        matrices.push(("self_test_time_s", [1, 1], vec![test.time_s]));
        matrices.push(("self_test_difference", [outputs, 1], test.difference.clone()));
    }
    matrices
}

fn npz(model: &StateSpace, tested: Option<&SelfTest>) -> io::Result<Vec<u8>> {
    let mut npz = ZipWriter::new(io::Cursor::new(Vec::new()));
    for (name, [rows, columns], entries) in matrices(model, tested) {
        let vector = !["A", "B", "C", "D"].contains(&name);
        let shape = [rows as u64, columns as u64];
        write_array(&mut npz, name, if vector { &shape[..1] } else { &shape }, entries)?;
    }
    Ok(npz.finish()?.into_inner())
}

/// A MATLAB file of level 4: for each matrix five integers (type, rows, columns, no imaginary part, length of the name), the name, and
/// the entries column by column, all little-endian. Source: MATLAB, MAT-File Format.
fn mat(model: &StateSpace, tested: Option<&SelfTest>) -> Vec<u8> {
    let mut bytes = vec![];
    for (name, [rows, columns], entries) in matrices(model, tested) {
        for number in [0, rows, columns, 0, name.len() + 1] {
            bytes.extend((number as u32).to_le_bytes());
        }
        bytes.extend(name.bytes().chain([0]));
        let transposed = (0..columns).flat_map(|column| (0..rows).map(move |row| row * columns + column));
        bytes.extend(transposed.flat_map(|place| entries[place].to_le_bytes()));
    }
    bytes
}
