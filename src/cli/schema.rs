//! `slcbeam schema`.

use std::process::ExitCode;

use crate::case::schema_json;
use crate::error::Result;

/// Prints the JSON Schema of a case.
pub fn schema() -> Result<ExitCode> {
    super::print(&format!("{:#}\n", schema_json()))?;
    Ok(ExitCode::SUCCESS)
}
