//! The page of a run, used as a person does.

use std::thread::sleep;
use std::time::Duration;

use super::browser::Browser;
use super::common::{made, sound};

/// Sum over the pixels of the animation: another picture has another sum.
const PIXELS: &str = "(() => { const c = document.querySelector('#motion canvas'); \
    const own = document.createElement('canvas'); own.width = c.width; own.height = c.height; \
    const x = own.getContext('2d', {willReadFrequently: true}); x.drawImage(c, 0, 0); \
    const d = x.getImageData(0, 0, c.width, c.height).data; let s = 0; \
    for (let k = 0; k < d.length; k++) s = (s * 31 + d[k]) % 1000000007; return s; })()";

const INDEX: &str = "Number(document.getElementById('time').value)";

#[test]
fn the_page_of_a_shaken_beam_is_alive() {
    let folder = tempfile::tempdir().expect("a folder");
    let page = made(
        folder.path(),
        &["run", "cases/wiring-3.json", "--set", "/time/end_s=0.1"],
    );
    let mut browser = Browser::start();
    let sections = [
        "scene",
        "motion",
        "profiles",
        "maps",
        "histories",
        "energy",
        "effects",
        "work",
        "case",
        "files",
    ];
    sound(&mut browser, &page, &sections);
    assert_eq!(browser.text("document.querySelector('h1').textContent"), "wiring-3");
    // What hangs on neighbouring places is drawn beside one another, within the beam.
    assert_eq!(browser.text("JSON.stringify(apart([1, 1, 0], 0.25, 1))"), "[0.75,1,0]");
    // Warnings stand before every figure.
    assert!(browser.eval("document.getElementById('warnings').getBoundingClientRect().top < document.getElementById('scene').getBoundingClientRect().top") == true);

    // What errors may be stands first.
    let warnings = browser.text("[...document.querySelectorAll('#warnings li')].map(li => li.textContent).join('|')");
    let (first, others) = warnings.split_once('|').expect("two warnings");
    assert!(first.contains("What this means (W021)"), "{first}");
    assert!(
        others.contains("share one potential") && others.contains("What this means (W001)"),
        "{others}"
    );

    // The slider moves beam, profiles, maps and histories.
    let profile = "document.querySelector('#profiles .present').getAttribute('d')";
    let mark = "document.querySelector('.map .now').style.left";
    browser.eval(
        "(() => { const s = document.getElementById('time'); s.value = 10; s.dispatchEvent(new Event('input')); })()",
    );
    let (pixels, line, at) = (browser.number(PIXELS), browser.text(profile), browser.text(mark));
    browser.eval(
        "(() => { const s = document.getElementById('time'); s.value = 60; s.dispatchEvent(new Event('input')); })()",
    );
    assert_ne!(browser.number(PIXELS), pixels, "the beam does not move");
    assert_ne!(browser.text(profile), line, "the profile does not move");
    assert_ne!(browser.text(mark), at, "the mark in the map does not move");

    // Keys: arrows step, the space bar plays and pauses.
    browser.eval("document.activeElement.blur()");
    let before = browser.number(INDEX);
    browser.press("ArrowRight");
    assert_eq!(browser.number(INDEX), before + 1.0);
    browser.press("ArrowLeft");
    browser.press("ArrowLeft");
    assert_eq!(browser.number(INDEX), before - 1.0);
    let time = "document.querySelector('.player .numbers b').textContent";
    let paused = browser.text(time);
    browser.press(" ");
    browser.until(&format!("{time} !== {paused:?}"));
    assert_eq!(
        browser.text("document.querySelector('.player .main').getAttribute('aria-label')"),
        "Pause"
    );
    browser.press(" ");
    let stopped = (browser.text(time), browser.number(PIXELS));
    sleep(Duration::from_millis(300));
    assert_eq!((browser.text(time), browser.number(PIXELS)), stopped, "it plays on");

    // A click into a map sets the time: two thirds of the way.
    browser.click(".map", (2.0 / 3.0, 0.5));
    let share =
        browser.number("Number(document.getElementById('time').value)/Number(document.getElementById('time').max)");
    assert!((share - 2.0 / 3.0).abs() < 0.03, "{share}");
    assert!(
        browser
            .text("document.querySelector('.maphead span').textContent")
            .contains("t =")
    );

    // Zoom by button, whole run by Escape; a chip adds a picture.
    let shown = "(() => { const t = [...document.querySelectorAll('#histories .u-axis')]; return document.querySelectorAll('#histories .uplot').length; })()";
    let plots = browser.number(shown);
    browser.eval("document.querySelector('[data-column=\"tip_angle\"]').click()");
    assert_eq!(browser.number(shown), plots + 1.0);
    let line = "document.querySelector('#histories .nowline').style.left";
    let whole = browser.text(line);
    browser.eval("document.querySelector('#histories [aria-label=\"Zoom in\"]').click()");
    assert_ne!(browser.text(line), whole, "the zoom does nothing");
    browser.eval("document.activeElement.blur()");
    browser.press("Escape");
    assert_eq!(browser.text(line), whole, "Escape does not show the whole run");

    // Bladders can be read by keys.
    browser.eval("document.querySelector('#scene svg.fig').focus({preventScroll: true})");
    browser.press("ArrowRight");
    browser.press("ArrowDown");
    let words = browser.text("document.querySelector('#scene .readout').textContent");
    assert!(
        words.starts_with("Bladder −2 (lower row)") && words.contains("Pressure now"),
        "{words}"
    );
    assert_eq!(browser.problems(), Vec::<String>::new());
}

#[test]
fn light_and_dark_differ_and_less_motion_is_honoured() {
    let folder = tempfile::tempdir().expect("a folder");
    let page = made(
        folder.path(),
        &["run", "cases/dry-cantilever.json", "--set", "/time/end_s=0.05"],
    );
    let mut browser = Browser::start();
    sound(
        &mut browser,
        &page,
        &["scene", "motion", "profiles", "maps", "histories", "energy", "case"],
    );
    let paper = "getComputedStyle(document.body).backgroundColor";
    let mut seen = vec![];
    for scheme in ["light", "dark"] {
        browser.set(1280, scheme);
        browser.open(&page);
        seen.push((browser.text(paper), browser.number(PIXELS)));
    }
    assert_ne!(seen[0].0, seen[1].0);
    assert_ne!(seen[0].1, seen[1].1, "the picture keeps its colours");
    browser.eval("document.getElementById('theme').click()");
    assert_eq!(browser.text(paper), seen[0].0, "the button does not switch");
    let features = serde_json::json!({"features": [{"name": "prefers-reduced-motion", "value": "reduce"}]});
    browser.call("Emulation.setEmulatedMedia", features);
    // Pictures a second while it plays: at most the four that are promised, and one at the start.
    let pictures = "new Promise(done => { let n = 0, last = null; const s = document.getElementById('time'); \
        const look = () => { if (s.value !== last) { n++; last = s.value; } }; const timer = setInterval(look, 10); \
        document.querySelector('.player .main').click(); \
        setTimeout(() => { clearInterval(timer); document.querySelector('.player .main').click(); done(n); }, 1500); })";
    let pictures = browser.number(pictures);
    assert!((2.0..=8.0).contains(&pictures), "{pictures}");
    assert_eq!(browser.problems(), Vec::<String>::new());
}

#[test]
fn a_harvester_shows_turbine_loads_and_efficiency() {
    let folder = tempfile::tempdir().expect("a folder");
    let page = made(
        folder.path(),
        &["run", "cases/harvester-crossover-wave.json", "--set", "/time/end_s=1.2"],
    );
    let mut browser = Browser::start();
    sound(
        &mut browser,
        &page,
        &["scene", "motion", "maps", "histories", "energy", "effects", "work"],
    );
    let tiles = browser.text("document.getElementById('tiles').textContent");
    assert!(tiles.contains("Harvested") && tiles.contains("Efficiency"), "{tiles}");
    assert!(
        tiles.contains("Power harvested") && tiles.contains("mean over the last part; put in"),
        "{tiles}"
    );
    let cycles = browser
        .text("data.history.columns.filter(c => c.group === 'Over the last cycle').map(c => c.label).join('; ')");
    assert_eq!(cycles, "power put in; power harvested; efficiency");
    let legend = browser.text("document.querySelector('#scene .legend').textContent");
    assert!(legend.contains("Turbine") && legend.contains("Load"), "{legend}");
    // What the ledger says should be there is what is there.
    let sums = "[...document.querySelectorAll('#energy tr.sum td.n')].map(e => e.textContent)";
    let sums = browser.eval(sums);
    let head = |k: usize| sums[k].as_str().map(|s| s.chars().take(4).collect::<String>());
    assert_eq!(head(0), head(1), "{sums}");
}

/// Goal: what acts stands beside what comes of it, sized over the run itself: a profile of 60 ms is not looked for over minutes. Turn, rise and
/// powers have tiles of their own.
#[test]
fn inputs_stand_beside_outputs() {
    let folder = tempfile::tempdir().expect("a folder");
    let profile = "{\"flow_m3_s\": {\"table\": {\"times_s\": [0, 0.02, 0.04, 0.06], \"values\": [0, 4e-8, 4e-8, 0], \"interpolation\": \"linear\"}}}";
    let page = made(
        folder.path(),
        &[
            "run",
            "cases/pluck.json",
            "--set",
            &format!("/network/chains/0/ends/0={profile}"),
            "--set",
            "/start={}",
            "--set",
            "/time={\"end_s\": 0.06, \"output_interval_s\": 0.001}",
            "--set",
            "/step_response={}",
        ],
    );
    let text = std::fs::read_to_string(&page).expect("the page");
    assert!(text.contains("flow up to 40.0 µl/s"), "its size is that of the run");
    let mut browser = Browser::start();
    sound(&mut browser, &page, &["scene", "motion", "histories"]);
    let labels = browser.text("data.history.columns.filter(c => c.group === 'What acts').map(c => c.label).join('; ')");
    assert_eq!(labels, "tip: force x; flow into inlet of bladder 1");
    let largest = browser
        .number("Math.max(...floats(data.history.columns.find(c => c.label.startsWith('flow into')).values)) * 1e9");
    assert!((largest - 40.0).abs() < 1e-3, "{largest}");
    // axes write flows and volumes in the units of the drawing
    let units = browser.text("['m^3/s', 'm^3'].map(u => scaledUnit(4e-8, u)[1]).join(', ')");
    assert_eq!(units, "µl/s, µl");
    let tiles = browser.text("document.getElementById('tiles').textContent");
    assert!(
        tiles.contains("Turn of the tip") && tiles.contains("largest slope angle, 2.34°, at"),
        "{tiles}"
    );
    // the end beside the largest, numbers held to their units
    let answer = browser.text("document.querySelector('.answer').textContent");
    assert!(
        answer.contains("Final tip deflection u₁ = −2.07\u{a0}mm; largest "),
        "{answer}"
    );
    // what is lost is less than nothing, and no sign stands before a sign
    let lost = "[...document.querySelectorAll('#energy tr')].find(e => e.textContent.startsWith('lost to flow')).querySelector('td.n').textContent";
    assert!(browser.text(lost).starts_with('−'), "{}", browser.text(lost));
    let columns = browser.text("data.history.columns.map(c => c.label).filter(l => l.startsWith('port')).join('; ')");
    assert!(columns.contains("port inlet of bladder 1 flow"), "{columns}");
}

/// Goal: the rise of a step has a tile.
#[test]
fn a_step_rises_on_the_page() {
    let folder = tempfile::tempdir().expect("a folder");
    let page = made(
        folder.path(),
        &[
            "run",
            "cases/dry-cantilever.json",
            "--set",
            "/start={}",
            "--set",
            "/beam/damping={\"bending_time_s\": 0.02}",
            "--set",
            "/loads=[{\"force_x_n_m\": {\"signal\": {\"ramp\": {\"to\": 1, \"duration_s\": 0.005}}}}]",
            "--set",
            "/step_response={}",
        ],
    );
    let text = std::fs::read_to_string(&page).expect("the page");
    assert!(text.contains("\"Rise time\"") && text.contains("from 10 to 90 % of its way; within 5 % after"));
}

#[test]
fn the_tab_key_leads_through_the_page() {
    let folder = tempfile::tempdir().expect("a folder");
    let page = made(folder.path(), &["run", "cases/two-bladders.json"]);
    let mut browser = Browser::start();
    browser.set(1280, "light");
    browser.open(&page);
    browser.eval("document.body.focus()");
    let mut seen = vec![];
    for _ in 0..40 {
        browser.press("Tab");
        let what = "(() => { const e = document.activeElement; const s = getComputedStyle(e); \
            return [e.className.baseVal ?? e.className, e.id, e.getAttribute('aria-label') ?? e.textContent.slice(0, 40), s.outlineStyle]; })()";
        seen.push(browser.eval(what));
    }
    let at = |k: usize, wanted: &str| {
        let found = seen
            .iter()
            .position(|s| s[k].as_str().is_some_and(|text| text.starts_with(wanted)));
        found.unwrap_or_else(|| panic!("never {wanted}: {seen:?}"))
    };
    let order = [
        at(0, "skip"),
        at(1, "theme"),
        at(2, "Side view"),
        at(2, "Play"),
        at(1, "time"),
        at(2, "Speed"),
        at(0, "map"),
    ];
    assert!(order.windows(2).all(|w| w[0] < w[1]), "{order:?} in {seen:?}");
    assert!(
        seen.iter().all(|s| s[3] != "none"),
        "a focus that cannot be seen: {seen:?}"
    );
    // What has the focus can be used: Enter on Play plays.
    browser.eval("document.querySelector('.player .main').focus()");
    browser.press("Enter");
    browser.until("document.querySelector('.player .main').getAttribute('aria-label') === 'Pause'");
    assert_eq!(browser.problems(), Vec::<String>::new());
}

/// Goal: histories have their error bands in a file, in the pictures and on the page; a run without companion has none and removes those
/// of an earlier one.
#[test]
fn histories_have_error_bands() {
    let folder = tempfile::tempdir().expect("a folder");
    let arguments = ["run", "cases/two-bladders.json"];
    let page = made(folder.path(), &arguments);
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name));
    let heading = |name: &str| {
        read(name)
            .expect("a table")
            .lines()
            .next()
            .expect("headings")
            .to_owned()
    };
    let (bands, columns) = (heading("errors.csv"), heading("history.csv"));
    let columns: Vec<&str> = columns.split(',').collect();
    assert!(
        bands.starts_with("t [s],tip_u1 [m]") && bands.split(',').all(|one| columns.contains(&one)),
        "{bands}"
    );
    for picture in ["history.svg", "energy.svg"] {
        assert!(read(picture).expect("a picture").contains("fill-opacity"), "{picture}");
    }
    let mut browser = Browser::start();
    sound(&mut browser, &page, &["histories"]);
    assert!(
        browser.eval("document.getElementById('histories').textContent.includes('is its estimated error')") == true
    );
    let widths = "(() => { const h = unpackHistory(data.history); const c = h.columns.find(c => c.name === 'tip_u1'); \
        return c.widths.length === h.times.length ? Math.max(...c.widths) : -1; })()";
    let widest = browser.number(widths);
    assert!((1e-8..1e-7).contains(&widest), "{widest:e}");
    made(
        folder.path(),
        &[&arguments[..], &["--set", "/companion=\"off\""]].concat(),
    );
    assert!(read("errors.csv").is_err() && !read("history.svg").expect("a picture").contains("fill-opacity"));
}

/// Goal: the page of a response states the values at the pointer, and moves the beam at the peak that is clicked.
#[test]
fn a_response_is_read_at_the_pointer() {
    let folder = tempfile::tempdir().expect("a folder");
    let asked = [
        "response",
        "cases/wiring-3.json",
        "--input",
        "/ends/root/clamped/u3_m",
        "--output",
        "tip_u3",
        "--frequency",
        "5",
        "--to",
        "110",
    ];
    let page = made(folder.path(), &asked);
    let mut browser = Browser::start();
    sound(&mut browser, &page, &["answer", "shapes", "table", "scene", "case"]);
    let chosen = "document.querySelector('#frequency').selectedOptions[0].text";
    assert_eq!(browser.text(chosen), "5.0000 Hz");
    browser.click(".u-over", (0.97, 0.5));
    assert_ne!(browser.text(chosen), "5.0000 Hz", "a click chooses nothing");
    let figures = browser.text("document.querySelector('.u-legend').textContent");
    assert!(figures.contains("dB ±") && figures.contains("tip_u3_m"), "{figures}");
    assert!(
        browser
            .text("document.querySelector('#shapes .figure .caption').textContent")
            .contains("per unit of the input: largest displacement")
    );
}

/// Goal: the page of bands states the wave at a mark.
#[test]
fn a_wave_is_read_at_its_mark() {
    let folder = tempfile::tempdir().expect("a folder");
    let asked = ["bands", "cases/metamaterial.json", "--to", "60", "--points", "20"];
    let page = made(folder.path(), &asked);
    let mut browser = Browser::start();
    sound(&mut browser, &page, &["answer", "table", "scene", "case"]);
    let readout = "document.querySelector('#answer .readout').textContent";
    browser.eval("document.querySelector('#answer .chart').focus()");
    browser.press("ArrowRight");
    let words = browser.text(readout);
    assert!(
        words.contains("bending at 1.0000 Hz: phase") && words.contains("dB per cell"),
        "{words}"
    );
}
