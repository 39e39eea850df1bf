//! `slcbeam report`: a result folder as one page.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use serde_json::json;

use crate::error::Result;
use crate::output::report;

/// `report`.
#[derive(Debug, Args)]
pub struct ReportArguments {
    /// Result folder
    #[arg(value_name = "DIR")]
    pub dir: PathBuf,
    /// Write the page here [default: report.html in the folder]
    #[arg(short, long, value_name = "FILE", value_parser = super::progress_line::output_path())]
    pub out: Option<PathBuf>,
    /// Print the page's path and size as JSON
    #[arg(long)]
    pub json: bool,
}

/// Writes the page and prints its path.
pub fn report(asked: &ReportArguments) -> Result<ExitCode> {
    let page = report::write(&asked.dir, asked.out.as_deref())?;
    let path = page.path.display().to_string();
    let text = || format!("{path}: {} kB; open it in a browser\n", page.bytes.div_ceil(1000));
    super::answer(asked.json, || json!({"report": path, "bytes": page.bytes}), text)
}
