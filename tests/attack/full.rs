//! Full disks: a limit on the size of files stands in for one. Goal: an answer that was computed is in the folder or printed.

use std::fs;
use std::path::Path;
use std::process::Output;

use serde_json::Value;

use crate::program::SETS;

/// Commands that fill a folder, each with the file that contains its answer; meshes are coarse and windows short.
const COMMANDS: [(&str, &str); 12] = [
    ("run cases/wiring-2.json SETS", "summary.json"),
    ("equilibrium cases/wiring-2.json SETS", "equilibrium.json"),
    (
        "equilibrium cases/dry-cantilever.json --uncertain /beam/height_m=normal:0.02:0.0001 --samples 16",
        "equilibrium.json",
    ),
    ("modes cases/wiring-2.json SETS", "modes.json"),
    (
        "optimize cases/dry-cantilever.json --command modes --maximize mode_1.frequency_hz --vary /beam/height_m=0.018:0.02 --starts 1",
        "optimum.json",
    ),
    (
        "fit cases/tour-actuator.json cases/actuator-angles.csv --command equilibrium --drive p_kpa=/network/chains/0/ends/0/pressure_pa \
         --vary /beam/young_modulus_pa=1e6:4e6 --match angle_deg=tip_angle --starts 1 --set /mesh/cells_per_segment=1",
        "fit.json",
    ),
    (
        "periodic cases/valves-open.json --sweep /ends/root/clamped/u3_m/sine/amplitude=0.001:0.002:2 --set /mesh/cells_per_segment=1",
        "sweep.json",
    ),
    (
        "floquet cases/valves-open.json --set /mesh/cells_per_segment=1",
        "floquet.json",
    ),
    (
        "floquet cases/valves-open.json --map frequency,amplitude --points 2,1 --set /mesh/cells_per_segment=1",
        "map.json",
    ),
    (
        "study cases/dry-cantilever.json --set /time/end_s=0.02 --rtol 1e-3,1e-4 --cells 1,2",
        "study.json",
    ),
    (
        "effects cases/dry-cantilever.json --set /time/end_s=0.02 --repeats 1",
        "effects.json",
    ),
    (
        "sweep cases/wiring-2.json SETS --command equilibrium --vary /network/permeability_factor=1,2 --no-mesh-errors",
        "sweep.json",
    ),
];

/// A command where no file may be larger than so many KiB.
fn on_a_disk_of(size: u32, command: &str, out: &Path) -> Output {
    let sets = SETS[1..].iter().fold(String::new(), |text, set| text + " --set " + set);
    let script = format!(
        "trap '' XFSZ; ulimit -f {size}; exec {} {} --quiet --json --out {}",
        env!("CARGO_BIN_EXE_slcbeam"),
        command.replace("SETS", &sets),
        out.display()
    );
    std::process::Command::new("bash")
        .args(["-c", &script])
        .output()
        .expect("it starts")
}

/// Every command that fills a folder prints its answer, one JSON document, where no file of it can be written, and ends with code 5.
#[test]
fn an_answer_that_cannot_be_written_is_printed() {
    let place = tempfile::tempdir().expect("a place");
    for (k, (command, sign)) in COMMANDS.iter().enumerate() {
        // the table of a run is under way before there is an answer, and so is the journal of a sweep
        let size = match *sign {
            "summary.json" => 200,
            "sweep.json" if command.starts_with("sweep") => 10,
            _ => 1,
        };
        let output = on_a_disk_of(size, command, &place.path().join(k.to_string()));
        let [out, error] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text).into_owned());
        assert_eq!(output.status.code(), Some(5), "{command}: {error}");
        let answer: Value = serde_json::from_str(&out).unwrap_or_else(|e| panic!("{command}: {e}\n{out}{error}"));
        assert!(
            answer["format"].is_number() && answer["case"].is_string(),
            "{command}: {out}"
        );
    }
}

/// Where there is room for numbers alone, they are in the folder: pictures and the page come after them, and none of an older result
/// is left beside them.
#[test]
fn numbers_are_written_before_pictures() {
    let place = tempfile::tempdir().expect("a place");
    let out = place.path().join("out");
    let (command, sign) = COMMANDS[2];
    assert_eq!(on_a_disk_of(100_000, command, &out).status.code(), Some(0));
    let other = command.replace("cantilever.json", "cantilever.json --set /beam/young_modulus_pa=3e6");
    // the path of one state is a table of few bytes, and the page has the scripts of all pages in it
    assert_eq!(on_a_disk_of(16, &other, &out).status.code(), Some(5));
    let text = fs::read_to_string(out.join(sign)).expect("numbers");
    let written: Value = serde_json::from_str(&text).expect("JSON");
    let printed = on_a_disk_of(100_000, &other, &place.path().join("whole")).stdout;
    let printed: Value = serde_json::from_slice(&printed).expect("JSON");
    assert_eq!(written["quantities"], printed["quantities"]);
    assert!(!out.join("report.html").exists());
}
