//! Files of the repository.

use std::fs;
use std::path::{Path, PathBuf};

/// All files under a folder with one of the endings, or with any if none is given, sorted; paths relative to the repository.
pub fn files(dir: &str, endings: &[&str]) -> Vec<PathBuf> {
    let mut all = Vec::new();
    let mut todo = vec![PathBuf::from(dir)];
    while let Some(dir) = todo.pop() {
        for entry in fs::read_dir(&dir).unwrap() {
            let path = entry.unwrap().path();
            let hidden = path.file_name().unwrap().to_string_lossy().starts_with('.');
            if path.is_dir() {
                // build output is in a `target` here and in benches/peers
                if !hidden && !path.ends_with("target") && path != Path::new("./out") {
                    todo.push(path);
                }
            } else if endings.is_empty()
                || path
                    .extension()
                    .is_some_and(|e| endings.contains(&&*e.to_string_lossy()))
            {
                all.push(path);
            }
        }
    }
    all.sort();
    all
}
