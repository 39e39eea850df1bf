//! Puts the cases beside what is built, from where the wheel takes them.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

const CASES: &str = "../cases";

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed={CASES}");
    println!("cargo::rerun-if-changed=build.rs");
    let out = PathBuf::from(env::var("OUT_DIR").map_err(io::Error::other)?).join("cases");
    if out.exists() {
        fs::remove_dir_all(&out)?;
    }
    copy(Path::new(CASES), &out)
}

/// Cases and their tables, folder by folder.
fn copy(from: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let path = entry?.path();
        let target = to.join(path.file_name().unwrap_or_default());
        if path.is_dir() {
            copy(&path, &target)?;
        } else if path.extension().is_some_and(|end| end == "json" || end == "csv") {
            fs::copy(&path, &target)?;
        }
    }
    Ok(())
}
