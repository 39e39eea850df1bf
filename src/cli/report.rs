//! `slcbeam report`: a result folder as one page.

use std::process::ExitCode;

use serde_json::json;

use super::arguments::ReportArguments;
use crate::error::Result;
use crate::output::report;

/// Writes the page and says where it is.
pub fn report(asked: &ReportArguments) -> Result<ExitCode> {
    let page = report::write(&asked.dir, asked.out.as_deref())?;
    let path = page.path.display().to_string();
    super::print(&if asked.json {
        format!("{:#}\n", json!({"report": path, "bytes": page.bytes}))
    } else {
        format!("{path}: {} kB; open it in a browser\n", page.bytes.div_ceil(1000))
    })?;
    Ok(ExitCode::SUCCESS)
}
