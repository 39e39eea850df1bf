//! Folders to report on, and what every page must do.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use super::browser::Browser;

/// Most bytes of a page.
const MOST: u64 = 5_000_000;

/// Runs the program.
pub fn slcbeam(arguments: &[&str]) -> Output {
    let program = env!("CARGO_BIN_EXE_slcbeam");
    Command::new(program)
        .args(arguments)
        .output()
        .expect("the program starts")
}

/// Runs the program into a folder of its own, which must succeed; returns the page.
pub fn made(folder: &Path, arguments: &[&str]) -> PathBuf {
    let out = folder.display().to_string();
    let mut all = arguments.to_vec();
    all.extend(["--quiet", "--out", &out]);
    let output = slcbeam(&all);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {errors}");
    folder.join("report.html")
}

/// Makes the page of a folder again.
pub fn report(folder: &Path) -> PathBuf {
    let output = slcbeam(&["report", &folder.display().to_string()]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    folder.join("report.html")
}

/// Opens a page on a wide and on a narrow screen: sections are there, nothing sticks out, nothing is wrong, it is small.
pub fn sound(browser: &mut Browser, page: &Path, sections: &[&str]) {
    let bytes = page.metadata().expect("the page").len();
    assert!(bytes < MOST, "{} bytes", bytes);
    for (width, scheme) in [(360, "dark"), (1280, "light")] {
        browser.set(width, scheme);
        browser.open(page);
        for id in sections {
            let size = browser.eval(&format!(
                "(() => {{ const e = document.getElementById({id:?}); return e ? [e.offsetWidth, e.offsetHeight] : null; }})()"
            ));
            let large = |k: usize| {
                size.get(k)
                    .and_then(serde_json::Value::as_f64)
                    .is_some_and(|x| x > 40.0)
            };
            assert!(large(0) && large(1), "{id} at {width}: {size}");
        }
        let flat = "[...document.querySelectorAll('canvas, svg.fig, .uplot')].filter(e => e.getBoundingClientRect().height < 20).length";
        assert_eq!(browser.number(flat), 0.0, "empty pictures at {width}");
        let over = "document.documentElement.scrollWidth - document.documentElement.clientWidth";
        assert_eq!(browser.number(over), 0.0, "sticks out at {width}");
        let unnamed = "[...document.querySelectorAll('canvas')].filter(e => !e.getAttribute('aria-label')).length";
        assert_eq!(browser.number(unnamed), 0.0, "pictures without names at {width}");
        readable(browser, width);
        assert_eq!(browser.problems(), Vec::<String>::new(), "at {width}");
    }
}

/// Tables of words are not cut, what scrolls sideways says so above it, and words of pictures are no smaller than 11 px on a narrow screen.
fn readable(browser: &mut Browser, width: u32) {
    let wider = "e.scrollWidth > e.clientWidth + 1";
    let cut =
        format!("[...document.querySelectorAll('.blocks, .u-legend')].filter(e => innerWidth < 640 && {wider}).length");
    assert_eq!(browser.number(&cut), 0.0, "words that are cut at {width}");
    // observers of sizes speak with the next frame
    let told = "e.previousElementSibling?.className === 'hint' && !e.previousElementSibling.hidden";
    let all = format!("[...document.querySelectorAll('.plate, .scroll')].filter(e => {wider}).every(e => {told})");
    browser.until(&all);
    let small = "[...document.querySelectorAll('.plate > svg')].flatMap(s => [...s.querySelectorAll('text')].filter(t => innerWidth < 640 && \
                 t.getAttribute('font-size') * s.clientWidth / s.viewBox.baseVal.width < 10.9)).length";
    assert_eq!(browser.number(small), 0.0, "small words in pictures at {width}");
}
