//! Pictures of the pages as files: the buttons below them, with pointer and keys.

use std::thread::sleep;
use std::time::{Duration, Instant};

use serde_json::Value;

use super::browser::Browser;
use super::common::made;

/// Keeps what is downloaded instead of storing it: pairs of a name and a text.
const KEEP: &str = "window.kept = []; URL.createObjectURL = (blob) => ((window.blob = blob), 'blob:kept'); \
    HTMLAnchorElement.prototype.click = function () { const name = this.download; window.blob.text().then((text) => window.kept.push([name, text])); }; true";

/// Presses the button with this label and returns name and text of the file.
fn downloaded(browser: &mut Browser, label: &str) -> (String, String) {
    browser.eval(&format!(
        "window.kept = []; document.querySelector('[aria-label=' + JSON.stringify({label:?}) + ']').click(); true"
    ));
    browser.until("window.kept.length === 1");
    (browser.text("window.kept[0][0]"), browser.text("window.kept[0][1]"))
}

/// Problems of an SVG that stands alone: it is no XML, has no size, or needs the page.
fn unsound(browser: &mut Browser, svg: &str) -> Value {
    let text = serde_json::to_string(svg).expect("a text");
    browser.eval(&format!(
        "(() => {{ const d = new DOMParser().parseFromString({text}, 'image/svg+xml'); const s = d.documentElement; \
         return [d.querySelector('parsererror') ? 'no XML' : null, s.localName === 'svg' && s.getAttribute('viewBox') && Number(s.getAttribute('width')) > 0 ? null : 'no size', \
         d.querySelector('image, foreignObject, script') ? 'a bitmap' : null, d.querySelector('[class], [style]') ? 'styles of the page' : null, \
         d.querySelector('path, polyline, line, rect + rect') ? null : 'empty'].filter(Boolean); }})()"
    ))
}

/// Goal: the buttons below a history give its curves as a drawing and its numbers as those of `history.csv`, also in the dark theme and
/// with keys; they are not printed.
#[test]
fn a_history_is_downloaded() {
    let folder = tempfile::tempdir().expect("a folder");
    let page = made(folder.path(), &["run", "cases/two-bladders.json"]);
    let mut browser = Browser::start();
    browser.set(1280, "dark");
    browser.open(&page);
    // one file for real: the policy of the page permits it
    let stored = folder.path().join("stored");
    let behavior = serde_json::json!({"behavior": "allow", "downloadPath": stored});
    browser.call("Page.setDownloadBehavior", behavior);
    browser.click("[aria-label='Download pressure as CSV']", (0.5, 0.5));
    let file = stored.join("two-bladders-pressure.csv");
    let begin = Instant::now();
    while !file.is_file() && begin.elapsed() < Duration::from_secs(60) {
        sleep(Duration::from_millis(50));
    }
    let stored = std::fs::read_to_string(&file).expect("a stored file");
    browser.eval(KEEP);
    let (name, csv) = downloaded(&mut browser, "Download pressure as CSV");
    assert_eq!((name.as_str(), &csv), ("two-bladders-pressure.csv", &stored));
    let heading = "t [s],largest pressure [Pa],error of largest pressure [Pa],smallest pressure [Pa],error of smallest pressure [Pa]";
    assert_eq!(csv.lines().next(), Some(heading));
    let history = std::fs::read_to_string(folder.path().join("history.csv")).expect("a history");
    let numbers = |text: &str, k: usize| -> Vec<f64> {
        let cell = |line: &str| line.split(',').nth(k).and_then(|x| x.parse().ok()).unwrap_or(f64::NAN);
        text.lines().skip(1).map(cell).collect()
    };
    let column = history
        .lines()
        .next()
        .and_then(|line| line.split(',').position(|h| h == "max_pressure [Pa]"))
        .expect("a column");
    let (own, recorded) = (numbers(&csv, 1), numbers(&history, column));
    assert_eq!(own.len(), recorded.len());
    // the page stores single precision
    assert!(
        own.iter().zip(&recorded).all(|(a, b)| (a - b).abs() <= 1e-6 * b.abs()),
        "{own:?}"
    );
    // the drawing has the colours of paper, and the page stays dark
    let (name, svg) = downloaded(&mut browser, "Download pressure as SVG");
    assert_eq!(name, "two-bladders-pressure.svg");
    assert_eq!(unsound(&mut browser, &svg), serde_json::json!([]));
    assert!(
        svg.contains("fill=\"#ffffff\"") && svg.contains("rgb(0, 158, 115)") && svg.contains("pressure [kPa]"),
        "colours and names"
    );
    assert!(
        svg.contains("largest pressure") && svg.contains("fill-opacity=\"0.2\""),
        "no legend or no error band"
    );
    assert_eq!(browser.text("document.documentElement.dataset.theme"), "dark");
    // keys
    browser.eval("window.kept = []; document.querySelector('[aria-label=\"Download pressure as SVG\"]').focus(); true");
    browser.press("Enter");
    browser.until("window.kept.length === 1");
    browser.call("Emulation.setEmulatedMedia", serde_json::json!({"media": "print"}));
    assert_eq!(
        browser.text("getComputedStyle(document.querySelector('.downloads')).display"),
        "none"
    );
    assert_eq!(browser.problems(), Vec::<String>::new());
}

/// Goal: every picture of a page gives a drawing without bitmaps, and a table with a heading and rows.
#[test]
fn every_picture_is_downloaded() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: &str| folder.path().join(name);
    let pages = [
        (made(&place("run"), &["run", "cases/two-bladders.json"]), 11),
        (made(&place("curl"), &["equilibrium", "cases/curl.json"]), 5),
        (made(&place("modes"), &["modes", "cases/two-bladders.json"]), 3),
        (
            made(&place("section"), &["equilibrium", "cases/section-actuator.json"]),
            6,
        ),
    ];
    let mut browser = Browser::start();
    for (page, least) in pages {
        browser.set(1280, "light");
        browser.open(&page);
        browser.eval(KEEP);
        let labels =
            browser.eval("[...document.querySelectorAll('.downloads button')].map(b => b.getAttribute('aria-label'))");
        let labels: Vec<String> = serde_json::from_value(labels).expect("labels");
        assert!(labels.len() >= 2 * least, "{}: {labels:?}", page.display());
        // every picture has its buttons
        let bare = browser.eval(
            "[...document.querySelectorAll('canvas, svg.fig, svg.drawing')].filter(e => !e.closest('.figure, .panel')?.querySelector('.downloads')).length",
        );
        assert_eq!(bare, 0, "{}: pictures without buttons", page.display());
        for label in labels {
            let (name, text) = downloaded(&mut browser, &label);
            if label.ends_with("SVG") {
                assert_eq!(unsound(&mut browser, &text), serde_json::json!([]), "{name}");
            } else {
                let headings = text.lines().next().unwrap_or_default();
                assert!(
                    text.lines().count() > 1 && (headings.contains('[') || headings.contains("kind")),
                    "{name}: {headings}"
                );
            }
        }
        assert_eq!(browser.problems(), Vec::<String>::new(), "{}", page.display());
    }
}
