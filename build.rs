//! Finds SUNDIALS 6 and KLU, declares functions that `sundials-sys` lacks (KLU, version query) to Rust, and passes on the commit of the
//! sources.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What brings everything the build needs.
const HELP: &str = "run scripts/test, or apt-get install libsundials-dev libsuitesparse-dev libclang-dev pkg-config";

/// What the program is made of.
const SOURCES: [&str; 4] = ["src", "build.rs", "Cargo.toml", "Cargo.lock"];

fn main() {
    for source in SOURCES {
        println!("cargo::rerun-if-changed={source}");
    }
    if let Some(commit) = commit() {
        println!("cargo::rustc-env=SLCBEAM_COMMIT={commit}");
    }
    for name in ["SUNDIALS_INCLUDE_DIR", "KLU_INCLUDE_DIR", "KLU_LIBRARY_DIR"] {
        println!("cargo::rerun-if-env-changed={name}");
    }
    if let Err(what) = declare() {
        println!("cargo::error={what} ({HELP})");
    }
}

/// Commit at which the sources were taken, `+` behind it where they had been changed; none outside a checkout of their own.
fn commit() -> Option<String> {
    let git = |arguments: &[&str]| {
        let told = Command::new("git")
            .arg("--no-optional-locks")
            .args(arguments)
            .output()
            .ok()?;
        let text = String::from_utf8_lossy(&told.stdout).trim().to_owned();
        told.status.success().then_some(text)
    };
    // Sources that were unpacked within the checkout of something else have no commit.
    if !git(&["rev-parse", "--show-prefix"])?.is_empty() {
        return None;
    }
    let commit = git(&["rev-parse", "--short=12", "HEAD"])?;
    let changed = git(&[&["status", "--porcelain", "--"], &SOURCES[..]].concat())?;
    Some(if changed.is_empty() { commit } else { commit + "+" })
}

/// Checks the headers, links KLU and writes `bindings.rs`; the error is one line.
fn declare() -> Result<(), String> {
    let sundials = sundials()?;
    let klu = klu()?;
    if let Ok(dir) = env::var("KLU_LIBRARY_DIR") {
        println!("cargo::rustc-link-search=native={dir}");
    }
    println!("cargo::rustc-link-lib=dylib=klu");
    write(&[sundials, klu])
}

/// Folders in which headers are looked for; `variable` names one more, to be tried first.
fn folders(variable: &str) -> Vec<PathBuf> {
    let usual = ["/usr/include", "/usr/local/include", "/opt/homebrew/include"];
    env::var(variable)
        .into_iter()
        .map(PathBuf::from)
        .chain(usual.map(PathBuf::from))
        .collect()
}

/// Folder that holds `sundials/sundials_config.h` of a SUNDIALS 6 with doubles and 64-bit indices.
fn sundials() -> Result<PathBuf, String> {
    let config = |folder: &PathBuf| folder.join("sundials/sundials_config.h");
    let folder = folders("SUNDIALS_INCLUDE_DIR")
        .into_iter()
        .find(|folder| config(folder).is_file())
        .ok_or("SUNDIALS is missing: no sundials/sundials_config.h")?;
    let text = read(&config(&folder))?;
    let version = defined(&text, "SUNDIALS_VERSION")
        .unwrap_or("unknown")
        .trim_matches('"');
    if defined(&text, "SUNDIALS_VERSION_MAJOR") != Some("6") {
        return Err(format!("SUNDIALS 6 is needed, {} holds {version}", folder.display()));
    }
    if defined(&text, "SUNDIALS_DOUBLE_PRECISION") != Some("1") || defined(&text, "SUNDIALS_INT64_T") != Some("1") {
        return Err(format!(
            "SUNDIALS {version} in {} is not built for doubles and 64-bit indices",
            folder.display()
        ));
    }
    Ok(folder)
}

/// Folder that holds `klu.h` of KLU 1.3 or a later 1 or 2.
fn klu() -> Result<PathBuf, String> {
    let mut folders: Vec<PathBuf> = folders("KLU_INCLUDE_DIR")
        .into_iter()
        .flat_map(|folder| [folder.join("suitesparse"), folder])
        .collect();
    let here = |folder: &PathBuf| folder.join("klu.h").is_file();
    if !folders.iter().any(here) {
        folders = pkg_config::probe_library("KLU")
            .map(|library| library.include_paths)
            .unwrap_or_default();
    }
    let folder = folders.into_iter().find(here).ok_or("KLU is missing: no klu.h")?;
    let text = read(&folder.join("klu.h"))?;
    let number = |name| {
        defined(&text, name)
            .and_then(|word| word.parse::<u32>().ok())
            .unwrap_or(0)
    };
    let version = (number("KLU_MAIN_VERSION"), number("KLU_SUB_VERSION"));
    if version < (1, 3) || version.0 > 2 {
        return Err(format!(
            "KLU 1.3 to 2 is needed, {} holds {}.{}",
            folder.display(),
            version.0,
            version.1
        ));
    }
    Ok(folder)
}

fn read(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|error| format!("cannot read {}: {error}", path.display()))
}

/// First word of the value of `#define name value`.
fn defined<'t>(text: &'t str, name: &str) -> Option<&'t str> {
    text.lines().find_map(|line| {
        let mut words = line.split_whitespace();
        (words.next() == Some("#define") && words.next() == Some(name))
            .then(|| words.next())
            .flatten()
    })
}

/// Writes the declarations; libclang is loaded at run time and its absence is a panic inside bindgen, made a line here.
fn write(folders: &[PathBuf]) -> Result<(), String> {
    let output = PathBuf::from(env::var("OUT_DIR").map_err(|_| "OUT_DIR is not set: not run by cargo")?);
    let builder = bindgen::Builder::default()
        .header_contents("needed.h", "#include <klu.h>\n#include <sundials/sundials_version.h>\n")
        .clang_args(folders.iter().map(|folder| format!("-I{}", folder.display())))
        .allowlist_function(
            "klu_(l_(defaults|analyze|refactor|rgrowth|rcond|condest|free_symbolic)|z?l_(factor|solve|free_numeric)|zl_tsolve)",
        )
        .allowlist_function("SUNDIALSGetVersionNumber")
        .allowlist_var("KLU_(OK|SINGULAR|OUT_OF_MEMORY|INVALID|TOO_LARGE)|SUITESPARSE_(MAIN|SUB|SUBSUB)_VERSION")
        .generate_comments(false)
        .layout_tests(false);
    std::panic::set_hook(Box::new(|_| {}));
    let bindings = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| builder.generate()));
    drop(std::panic::take_hook());
    bindings
        .map_err(|_| "libclang is missing".to_owned())?
        .map_err(|error| {
            format!(
                "klu.h or sundials_version.h cannot be read: {}",
                error.to_string().replace('\n', " ")
            )
        })?
        .write_to_file(output.join("bindings.rs"))
        .map_err(|error| format!("cannot write bindings.rs: {error}"))
}
