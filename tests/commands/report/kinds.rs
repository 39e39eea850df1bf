//! The pages of all other commands.

use super::browser::Browser;
use super::common::{made, report, sound};

/// The first column of the page's table, after a click on its first heading and after another.
fn sorted_both_ways(browser: &mut Browser) {
    let click = "document.querySelector('#table th button').click()";
    let first = "[...document.querySelectorAll('#table tbody tr')].map(r => r.children[0].textContent)";
    browser.eval(click);
    let up = browser.eval(first);
    browser.eval(click);
    let down = browser.eval(first);
    let (up, down) = (
        up.as_array().expect("rows").clone(),
        down.as_array().expect("rows").clone(),
    );
    assert_eq!(up.len(), down.len());
    if up.iter().any(|x| *x != up[0]) {
        assert_ne!(up, down, "a click on the heading does not sort");
    }
}

#[test]
fn equilibrium_walks_along_its_path() {
    let folder = tempfile::tempdir().expect("a folder");
    let page = made(folder.path(), &["equilibrium", "cases/elastica.json", "--at", "0"]);
    let mut browser = Browser::start();
    sound(&mut browser, &page, &["path", "events", "table", "scene", "case"]);
    let words = "document.getElementById('state-words').textContent";
    let last = browser.text(words);
    browser.eval("document.getElementById('state').focus()");
    for _ in 0..4 {
        browser.press("ArrowLeft");
    }
    assert_ne!(browser.text(words), last, "the slider does nothing");
    sorted_both_ways(&mut browser);
    assert_eq!(browser.problems(), Vec::<String>::new());
}

#[test]
fn modes_move() {
    let folder = tempfile::tempdir().expect("a folder");
    let page = made(folder.path(), &["modes", "cases/pluck.json", "--count", "6"]);
    let mut browser = Browser::start();
    sound(&mut browser, &page, &["shapes", "table", "picture", "scene", "case"]);
    let phase = "document.querySelector('#shapes input').value";
    let begin = browser.text(phase);
    browser.until(&format!("{phase} !== {begin:?}"));
    browser.eval(
        "(() => { const s = document.getElementById('mode'); s.value = 1; s.dispatchEvent(new Event('change')); })()",
    );
    assert!(
        browser
            .text("document.querySelector('#shapes .caption').textContent")
            .starts_with("Mode 2 ")
    );
    sorted_both_ways(&mut browser);
}

/// Goal: the table of a page has the modes that the terminal shows, and the sentence counts them.
#[test]
fn a_page_of_modes_lists_what_moves() {
    let folder = tempfile::tempdir().expect("a folder");
    let page = made(folder.path(), &["modes", "cases/wiring-2.json", "--count", "4"]);
    let text = std::fs::read_to_string(page).expect("a page");
    assert!(text.contains("no growth in the 4 modes shown"));
    assert!(!text.contains("\"kept volume\""));
}

#[test]
fn studies_say_what_they_found_first() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut browser = Browser::start();
    let (study, effects) = (folder.path().join("study"), folder.path().join("effects"));
    let short = ["--set", "/time/end_s=0.02"];
    let page = made(
        &study,
        &[
            &["study", "cases/dry-cantilever.json", "--budget", "4s", "--cells", "1,2"][..],
            &short,
        ]
        .concat(),
    );
    sound(&mut browser, &page, &["answer", "table", "scene", "case"]);
    assert!(
        !browser
            .text("document.querySelector('p.answer').textContent")
            .is_empty()
    );
    // the picture is a drawing with a name, whose marks are read with the arrow keys, and whose series are switched
    let name = browser.text("document.querySelector('#answer svg.fig').getAttribute('aria-label')");
    assert!(
        name.starts_with("Error and time: least wall time over relative error, "),
        "{name}"
    );
    let marks = "document.querySelectorAll('#answer svg.fig g circle').length";
    let all = browser.number(marks);
    assert!(all > 3.0, "{all} marks");
    browser.eval("document.querySelector('#answer .chart').focus()");
    let readout = "document.querySelector('#answer .readout').textContent";
    browser.press("ArrowRight");
    let first = browser.text(readout);
    browser.press("ArrowRight");
    assert!(first.contains("a segment") && browser.text(readout) != first, "{first}");
    browser.eval("document.querySelector('#answer .chips button').click()");
    assert!(browser.number(marks) < all);
    sorted_both_ways(&mut browser);
    let page = made(
        &effects,
        &[&["effects", "cases/dry-cantilever.json", "--budget", "4s"][..], &short].concat(),
    );
    sound(&mut browser, &page, &["answer", "table", "scene", "case"]);
    assert!(
        browser
            .text("document.getElementById('table').textContent")
            .contains("finite_rotation")
    );
    // an entry a bar, each with its words, put in order by buttons
    let rows = "[...document.querySelectorAll('#answer .bars li')].map(r => r.textContent).join('|')";
    let listed = browser.text(rows);
    assert!(
        listed.contains("finite rotation") && listed.contains("of the work"),
        "{listed}"
    );
    browser.eval("document.querySelectorAll('#answer .chips button')[2].click()");
    let ordered = browser.text(rows);
    let sorted = |text: &str| {
        let mut all: Vec<String> = text.split('|').map(String::from).collect();
        all.sort();
        all
    };
    assert_eq!(sorted(&ordered), sorted(&listed));
    sorted_both_ways(&mut browser);
}

#[test]
fn cycles_say_whether_they_are_stable() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut browser = Browser::start();
    let case = "cases/harvester-crossover-wave.json";
    let page = made(&folder.path().join("floquet"), &["floquet", case]);
    sound(&mut browser, &page, &["answer", "table", "scene", "case"]);
    assert!(
        browser
            .text("document.querySelector('p.answer').textContent")
            .contains("table:")
    );
    let page = made(&folder.path().join("periodic"), &["periodic", case]);
    sound(
        &mut browser,
        &page,
        &["scene", "motion", "maps", "histories", "energy", "cycle"],
    );
    assert!(
        browser
            .text("document.querySelector('#case code').textContent")
            .starts_with("slcbeam periodic")
    );
    let sweep = ["periodic", case, "--sweep", "/network/permeability_factor=0.5:1:2"];
    let page = made(&folder.path().join("sweep"), &sweep);
    sound(&mut browser, &page, &["answer", "table", "scene", "case"]);
    assert_eq!(
        browser.number("document.querySelectorAll('#table tbody tr').length"),
        2.0
    );
    let map = [
        "floquet",
        "cases/wiring-3.json",
        "--map",
        "frequency,amplitude",
        "--points",
        "2,2",
        "--permeability",
        "1",
    ];
    let page = made(&folder.path().join("map"), &map);
    sound(&mut browser, &page, &["answer", "table", "scene", "case"]);
    assert_eq!(
        browser.number("document.querySelectorAll('#table tbody tr').length"),
        4.0
    );
}

/// Goal: a fit has its picture, and a row for each number with its error, whose headings sort.
#[test]
fn a_fit_stands_over_its_data() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut browser = Browser::start();
    let asked = [
        "fit",
        "cases/tour-actuator.json",
        "cases/actuator-step.csv",
        "--vary",
        "/fluid/viscosity_pa_s=0.05:2",
        "--vary",
        "/beam/young_modulus_pa=5e5:1e7",
        "--match",
        "tip_mm=tip_u1",
    ];
    let page = made(folder.path(), &asked);
    sound(&mut browser, &page, &["answer", "table", "scene", "case"]);
    assert_eq!(
        browser.number("document.querySelectorAll('#table tbody tr').length"),
        2.0
    );
    sorted_both_ways(&mut browser);
    assert_eq!(browser.problems(), Vec::<String>::new());
}

/// Goal: designs have a picture of what was varied, and a row each that sorts.
#[test]
fn designs_stand_in_a_table() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut browser = Browser::start();
    let pressed = "/start/pressures/0/pressure_pa=lin:1000:2000:3";
    let young = "/beam/young_modulus_pa=2e6,3e6";
    let length = "/beam/length_m=0.1,0.12";
    for (k, varied) in [&[pressed][..], &[pressed, young], &[pressed, young, length]]
        .iter()
        .enumerate()
    {
        let mut all = vec!["sweep", "cases/two-bladders.json", "--set", "/time/end_s=0.0005"];
        all.extend(varied.iter().flat_map(|one| ["--vary", one]));
        let page = made(&folder.path().join(k.to_string()), &all);
        // three numbers have no picture
        let drawn = varied.len() < 3;
        let sections = &["answer", "table", "scene", "case"][usize::from(!drawn)..];
        sound(&mut browser, &page, sections);
        let rows = browser.number("document.querySelectorAll('#table tbody tr').length");
        assert_eq!(rows, [3.0, 6.0, 12.0][k]);
        if drawn {
            assert!(browser.number("document.querySelector('.plate svg').clientWidth") > 100.0);
            // the page's own letters are not the picture's
            let ink = browser.text("getComputedStyle(document.querySelector('.plate text')).fill");
            assert_eq!(ink, "rgb(34, 38, 43)");
            // every point says what it is and leads to its row
            let led = "[...document.querySelectorAll('.plate a')].filter(a => document.getElementById(a.getAttribute('href').slice(1)) && \
                   a.querySelector('title').textContent.startsWith(a.getAttribute('href').slice(1).replace('-', ' ') + ': pressures 0: pressure')).length";
            assert!(browser.number(led) >= rows, "{k}");
        }
        let command = browser.text("document.querySelector('#design-1 button').title");
        assert!(
            command.starts_with("slcbeam run case.json --set /time/end_s=0.0005 --set /start/pressures/0/pressure_pa="),
            "{command}"
        );
    }
    let kept = made(
        &folder.path().join("kept"),
        &[
            "sweep",
            "cases/two-bladders.json",
            "--set",
            "/time/end_s=0.0005",
            "--vary",
            pressed,
            "--keep-cases",
        ],
    );
    browser.open(&kept);
    let link = browser.text("document.querySelector('#design-1 a').getAttribute('href')");
    assert_eq!(link, "cases/00001.json");
    sorted_both_ways(&mut browser);
    // a picture that is too large is named where it would stand
    let folder = folder.path().join("kept");
    let file = folder.join("sweep.svg");
    let drawn = std::fs::read_to_string(&file).expect("the picture");
    std::fs::write(&file, drawn + &" ".repeat(800_000)).expect("a larger picture");
    browser.open(&report(&folder));
    let said = browser.text("document.querySelector('#answer .caption').textContent");
    assert!(
        said.starts_with("The picture has 0.8") && said.ends_with("left out of the page: sweep.svg."),
        "{said}"
    );
    assert_eq!(browser.problems(), Vec::<String>::new());
}

/// Goal: a page of two cases is named after both.
#[test]
fn designs_of_two_cases_have_both_names() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = [
        "sweep",
        "cases/two-bladders.json",
        "cases/dry-cantilever.json",
        "--command",
        "modes",
    ];
    let page = made(folder.path(), &cases);
    let text = std::fs::read_to_string(page).expect("the page");
    assert!(text.contains("<title>two-bladders and dry-cantilever · slcbeam</title>"));
}

/// Goal: loads from pressures have their bands in a picture and a table; without measurements these are of the best bladders.
#[test]
fn loads_from_pressures_stand_with_their_bands() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut browser = Browser::start();
    let data = folder.path().join("pressures.csv");
    std::fs::write(&data, "t_s,pressure_1_kpa,pressure_4_kpa\n0,-2.9,-1.6\n1,-1.4,-0.8\n").expect("written");
    let beam = [
        "sense",
        "cases/tour-sensor.json",
        "--set",
        "/loads=[]",
        "--load",
        "tip-force",
    ];
    let measured = [&beam[..], &[data.to_str().expect("a path"), "--noise", "200"]].concat();
    for (k, (asked, rows)) in [(measured, 2.0), (beam.to_vec(), 20.0)].into_iter().enumerate() {
        let page = made(&folder.path().join(k.to_string()), &asked);
        sound(&mut browser, &page, &["answer", "table", "scene", "case"]);
        assert!(browser.number("document.querySelector('.plate svg').clientWidth") > 100.0);
        let found = browser.number("document.querySelectorAll('#table tbody tr').length");
        assert_eq!(found, rows);
    }
    sorted_both_ways(&mut browser);
}

/// Goal: a case with a section shows its cell under each of the four loads, and bladders by their outlines.
#[test]
fn the_cell_of_a_section_is_drawn_under_its_loads() {
    let folder = tempfile::tempdir().expect("a folder");
    let page = made(
        folder.path(),
        &["run", "cases/section-actuator.json", "--set", "/time/end_s=0.02"],
    );
    let mut browser = Browser::start();
    sound(&mut browser, &page, &["scene", "motion", "cell", "case"]);
    let drawn =
        "[...document.querySelectorAll('#cell svg')].filter(i => i.clientWidth > 50 && i.clientHeight > 50).length";
    assert_eq!(browser.number(drawn), 4.0);
    let words = browser.text("document.querySelector('#cell .caption').textContent");
    assert!(words.starts_with("1 N, displacements × "), "{words}");
    // A circle has many corners.
    let outlines = "[...document.querySelectorAll('#scene svg.fig path')].filter(p => p.getAttribute('d').split('L').length > 12).length";
    assert_eq!(browser.number(outlines), 20.0);
}

/// Goal: the page of a run over data has the picture and a row for each column of the data.
#[test]
fn a_run_stands_over_its_data() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut browser = Browser::start();
    let [run, out] = ["run", "page"].map(|name| folder.path().join(name).display().to_string());
    made(
        std::path::Path::new(&run),
        &["run", "cases/tour-actuator.json", "--set", "/mesh/cells_per_segment=1"],
    );
    let data = "cases/actuator-step.csv";
    let said = super::common::slcbeam(&["compare", &run, data, "--match", "tip_mm=tip_u1", "--out", &out]);
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    sound(
        &mut browser,
        &folder.path().join("page/report.html"),
        &["answer", "table"],
    );
    assert_eq!(
        browser.number("document.querySelectorAll('#table tbody tr').length"),
        1.0
    );
}

/// Goal: the page of three results has their histories over each other, a curve each with its name, and tables with a column each.
#[test]
fn results_stand_side_by_side() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut browser = Browser::start();
    let names = ["thin", "usual", "thick"];
    let runs = names.map(|name| folder.path().join(name).display().to_string());
    for (run, height) in runs.iter().zip(["0.018", "0.02", "0.022"]) {
        let set = format!("/beam/height_m={height}");
        let all = [
            "run",
            "cases/dry-cantilever.json",
            "--set",
            "/time/end_s=0.02",
            "--set",
            &set,
        ];
        made(std::path::Path::new(run), &all);
    }
    let out = folder.path().join("page");
    let words = out.display().to_string();
    let said = super::common::slcbeam(&[
        "compare", &runs[0], &runs[1], &runs[2], "--with", &runs[1], "--out", &words,
    ]);
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    let page = out.join("report.html");
    sound(&mut browser, &page, &["histories", "table-1", "table-2", "table-3"]);
    let legend = browser.text("document.querySelector('#histories .u-legend').textContent");
    let at = |name: &str| legend.find(name).unwrap_or_else(|| panic!("{name}: {legend}"));
    assert!(at("usual") < at("thin") && at("thin") < at("thick"));
    let panels = "document.querySelectorAll('#histories .uplot').length";
    let before = browser.number(panels);
    browser.eval("[...document.querySelectorAll('#histories .chips button')].find(b => b.getAttribute('aria-pressed') === 'false').click()");
    assert_eq!(browser.number(panels), before + 1.0);
    assert_eq!(browser.problems(), Vec::<String>::new());
}
