//! Pages of a structure: every beam is at its place, and a single beam is drawn as before.

use std::fs;
use std::path::Path;

use serde_json::Value;

use super::browser::Browser;
use super::common::{made, sound};

const ELL: &str = "tests/data/ell.json";

/// Data of a page.
fn data(page: &Path) -> Value {
    let text = fs::read_to_string(page).expect("a page");
    let begin = text.find("application/json").expect("data");
    let from = begin + text[begin..].find('>').expect("an element") + 1;
    let to = from + text[from..].find("</script>").expect("its end");
    serde_json::from_str(&text[from..to]).expect("JSON")
}

/// Goal: scene, film, shapes, curves and maps show each beam of a structure, without errors of scripts.
#[test]
fn structures_are_shown_with_all_beams() {
    let dir = tempfile::tempdir().expect("a folder");
    let mut browser = Browser::start();
    let run = made(&dir.path().join("run"), &["run", ELL]);
    sound(
        &mut browser,
        &run,
        &["scene", "motion", "profiles", "maps", "histories"],
    );
    // one open circle and one dot, each at both places that meet there
    let joints = "[...document.querySelectorAll('#scene svg.fig circle.joint')].map(c => [c.getAttribute('cx'), c.getAttribute('cy')].map(x => Math.round(x)).join())";
    assert_eq!(browser.number(&format!("{joints}.length")), 4.0);
    assert_eq!(browser.number(&format!("new Set({joints}).size")), 2.0);
    let names = "[...document.querySelectorAll('#scene svg text')].map(t => t.textContent)";
    for beam in ["left", "up", "arm"] {
        assert_eq!(
            browser.number(&format!("{names}.filter(t => t === {beam:?}).length")),
            1.0,
            "{beam}"
        );
        let titles = "[...document.querySelectorAll('#profiles h3, #maps h3')].map(t => t.textContent)";
        let own = browser.number(&format!("{titles}.filter(t => t.endsWith(' {beam}')).length"));
        assert!(own >= 4.0, "{own} pictures of {beam}");
    }
    let legend = "document.querySelector('#scene .legend').textContent";
    for words in [
        "from bladder left:3 to bladder up:1",
        "Port A at bladder left:−1",
        "left.2 and arm.root: rigid joint",
    ] {
        assert!(
            browser.eval(&format!("{legend}.includes({words:?})")) == true,
            "{words}"
        );
    }
    // the upright beam reaches into the upper third of the film, of which it covers a part
    let upper = "(() => { const c = document.querySelector('#motion canvas'); const d = c.getContext('2d').getImageData(0, 0, c.width, Math.floor(c.height / 3)).data; let n = 0; for (let k = 3; k < d.length; k += 4) n += d[k] > 200; return n / (d.length / 4); })()";
    let covered = browser.number(upper);
    assert!((0.002..0.2).contains(&covered), "{covered}");
    let equilibrium = made(&dir.path().join("equilibrium"), &["equilibrium", ELL]);
    sound(&mut browser, &equilibrium, &["path", "scene"]);
    let short = [
        "/time/end_s=0.02",
        "/time/output_interval_s=0.002",
        "/time/window_s=0.01",
    ];
    let sets = short.iter().flat_map(|set| ["--set", set]);
    let gripper: Vec<&str> = ["run", "cases/gripper.json"].into_iter().chain(sets.clone()).collect();
    let gripper = made(&dir.path().join("gripper"), &gripper);
    sound(&mut browser, &gripper, &["scene", "motion", "profiles", "maps"]);
    // all segments alike
    let branched: Vec<&str> = ["run", "cases/branched-actuator.json"]
        .into_iter()
        .chain(sets)
        .collect();
    let branched = made(&dir.path().join("branched"), &branched);
    sound(&mut browser, &branched, &["scene", "motion", "profiles"]);
    let modes = made(&dir.path().join("modes"), &["modes", ELL, "--count", "3"]);
    sound(&mut browser, &modes, &["shapes", "scene"]);
}

/// Goal: places of nodes are those of the case, and pages of single beams have no such data.
#[test]
fn places_are_data_of_structures_only() {
    let dir = tempfile::tempdir().expect("a folder");
    let page = data(&made(&dir.path().join("run"), &["run", ELL]));
    let scene = &page["scene"];
    let texts = |list: &str, key: &str| -> Vec<&str> {
        let all = scene[list].as_array().expect(list).iter();
        all.filter_map(|one| one[key].as_str()).collect()
    };
    assert_eq!(texts("beams", "name"), ["left", "up", "arm"]);
    assert_eq!(texts("joints", "kind"), ["hinge", "rigid"]);
    assert_eq!(scene["joints"][0]["at"][1]["z"], 0.05);
    assert_eq!(scene["bladders"]["labels"][4], "up:1");
    assert_eq!(scene["bladders"]["labels"][9 + 7], "arm:-1");
    // left is divided by a joint: four parts, with two cells per segment
    assert_eq!(page["motion"]["placed"]["starts"], serde_json::json!([0, 5, 10, 17]));
    let labels: Vec<&str> = page["tiles"]
        .as_array()
        .expect("tiles")
        .iter()
        .filter_map(|t| t["label"].as_str())
        .collect();
    assert!(
        labels.contains(&"Tip of up, u₁") && !labels.contains(&"Tip, across"),
        "{labels:?}"
    );
    let single = data(&made(
        &dir.path().join("single"),
        &["run", "cases/two-bladders.json", "--set", "/time/end_s=0.001"],
    ));
    for (part, key) in [("scene", "beams"), ("scene", "joints"), ("motion", "placed")] {
        assert!(single[part].get(key).is_none(), "{part}/{key}");
    }
}
