//! `slcbeam schema`.

use std::process::ExitCode;

use clap::Args;

use crate::case::schema_json;
use crate::error::Result;

/// `schema`.
#[derive(Debug, Args)]
pub struct SchemaArguments {
    /// It is JSON with or without this
    #[arg(long)]
    pub json: bool,
}

/// Prints the JSON Schema of a case.
pub fn schema() -> Result<ExitCode> {
    super::print(&format!("{:#}\n", schema_json()))?;
    Ok(ExitCode::SUCCESS)
}
