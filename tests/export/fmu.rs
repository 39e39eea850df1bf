//! `slcbeam export --fmu`: the contents of an FMU, and what is refused. `python/tests/test_fmu.py` simulates FMUs.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::Read as _;
use std::path::Path;

use assert_cmd::Command;
use slcbeam::output::fmu::{FmuSetup, MARK};
use tempfile::TempDir;
use zip::ZipArchive;

const CASE: &str = "cases/tour-actuator.json";
const INLET: &str = "/network/chains/0/ends/0/pressure_pa";

/// Exports with a library that is a text, which serves all but simulations.
fn export(folder: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    let library = folder.join("library.so");
    if !library.exists() {
        fs::write(&library, MARK).unwrap();
    }
    let mut command = Command::cargo_bin("slcbeam").unwrap();
    command
        .arg("export")
        .args(arguments)
        .env("SLCBEAM_FMU_LIBRARY", &library);
    let output = command.output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code(), text(output.stdout), text(output.stderr))
}

fn files(path: &Path) -> BTreeMap<String, String> {
    let mut archive = ZipArchive::new(File::open(path).unwrap()).unwrap();
    let names: Vec<String> = archive.file_names().map(|name| name.unwrap().into_owned()).collect();
    let read = |name: String| {
        let mut bytes = vec![];
        archive.by_name(&name).unwrap().read_to_end(&mut bytes).unwrap();
        (name, String::from_utf8_lossy(&bytes).into_owned())
    };
    names.into_iter().map(read).collect()
}

/// The element of a variable.
fn variable<'t>(description: &'t str, name: &str) -> &'t str {
    let key = format!("name=\"{name}\"");
    let found = description
        .lines()
        .find(|line| line.contains("<Float64") && line.contains(&key));
    found.unwrap_or_else(|| panic!("no variable {name}"))
}

#[test]
fn the_description_names_variables_with_units_ranges_and_meanings() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("finger.fmu");
    let (code, said, told) = export(
        folder.path(),
        &[
            CASE,
            "--fmu",
            path.to_str().unwrap(),
            "--input",
            &format!("{INLET}=0,7e4"),
            "--input",
            "/network/chains/1/opening",
            "--output",
            "tip_u1,tip_angle_rad,port_flow",
        ],
    );
    assert_eq!(code, Some(0), "{told}");
    assert!(
        said.contains("input network.chains[0].ends[0].pressure_pa [Pa]: 0 at the start"),
        "{said}"
    );
    let all = files(&path);
    let description = &all["modelDescription.xml"];
    let input = variable(description, "network.chains[0].ends[0].pressure_pa");
    for part in [
        "causality=\"input\"",
        "unit=\"Pa\"",
        "min=\"0.0\"",
        "max=\"70000.0\"",
        "start=\"0.0\"",
        "valueReference=\"1\"",
    ] {
        assert!(input.contains(part), "{part}: {input}");
    }
    assert!(variable(description, "network.chains[1].opening").contains("min=\"0.0\" max=\"1.0\" start=\"1.0\""));
    let output = variable(description, "tip_angle");
    assert!(
        output.contains("causality=\"output\"") && output.contains("unit=\"rad\"") && output.contains("slope angle")
    );
    assert!(!description.contains("kinetic_energy"));
    assert!(description.contains("<Unit name=\"Pa\"><BaseUnit kg=\"1\" m=\"-1\" s=\"-2\"/></Unit>"));
    assert!(description.contains("<DefaultExperiment startTime=\"0.0\" stopTime=\"1.5\" stepSize=\"0.002\"/>"));
    assert_eq!(description.matches("<Output ").count(), 3);
    let setup: FmuSetup = serde_json::from_str(&all["resources/fmu.json"]).unwrap();
    assert!(description.contains(&format!("instantiationToken=\"{}\"", setup.token)));
    assert_eq!(setup.outputs, ["tip_u1", "tip_angle", "port_flow"]);
    let case = folder.path().join("case.json");
    fs::write(&case, &all["resources/case.json"]).unwrap();
    assert_eq!(slcbeam::case::load(&case, &[]).unwrap().name, "tour-actuator");
    assert!(
        all.contains_key("binaries/x86_64-linux/tour_actuator.so")
            && all.contains_key("documentation/licenses/libraries.txt")
    );
}

/// Goal: equal arguments give equal bytes, another case another token.
#[test]
fn an_fmu_depends_on_its_arguments_alone() {
    let folder = TempDir::new().unwrap();
    let write = |name: &str, set: &str| {
        let path = folder.path().join(name);
        let input = format!("{INLET}=0,7e4");
        let arguments = [CASE, "--set", set, "--fmu", path.to_str().unwrap(), "--input", &input];
        assert_eq!(export(folder.path(), &arguments).0, Some(0));
        fs::read(path).unwrap()
    };
    let first = write("a.fmu", "/time/end_s=1");
    assert!(first == write("b.fmu", "/time/end_s=1"));
    assert!(first != write("c.fmu", "/time/end_s=1.25"));
}

#[test]
fn invalid_fmus_are_refused_with_a_reason() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.fmu");
    let path = path.to_str().unwrap();
    let input = format!("{INLET}=0,7e4");
    let refused = |arguments: &[&str], part: &str| {
        let (code, _, told) = export(folder.path(), arguments);
        assert!(code == Some(2) && told.contains(part), "{arguments:?}: {told}");
        assert!(!Path::new(path).exists());
    };
    refused(
        &[CASE, "--fmu", path],
        &format!("choose inputs with --input; the signals of the case are /network/chains/0/opening, {INLET}"),
    );
    refused(&[CASE, "--fmu", "a.zip", "--input", &input], "ends in .fmu");
    refused(
        &[
            CASE,
            "--fmu",
            path,
            "--input",
            "/network/chains/0/ends/0/presure_pa=0,1",
        ],
        &format!("nearest is {INLET}"),
    );
    refused(
        &[CASE, "--fmu", path, "--input", "/network/chains/1/ends/0/pressure_pa"],
        "the signal is constant in the case",
    );
    refused(
        &[CASE, "--fmu", path, "--input", &format!("{INLET}=0")],
        "expected the smallest and the largest value",
    );
    refused(
        &[CASE, "--fmu", path, "--input", &format!("{INLET}=1,2")],
        "must contain the initial value of the case, 0",
    );
    refused(
        &[CASE, "--fmu", path, "--input", &input, "--output", "tip_u2"],
        "the case has no such output; nearest is tip_u",
    );
    refused(
        &[CASE, "--fmu", path, "--input", &input, "--at", "1"],
        "belong to a linear model",
    );
    refused(
        &[CASE, "--fmu", path, "--input", &input, "--error", "0.01"],
        "name the outputs of the linear model",
    );
    let twice = [
        "--input",
        INLET,
        "--input",
        "/network/chains/0/opening",
        "--output",
        "tip_u1",
    ];
    refused(
        &[&[CASE, "--fmu", path, "--error", "0.01"][..], &twice].concat(),
        "has one --input, not 2",
    );
    refused(
        &[&[CASE, "--state-space", "a.npz"][..], &twice].concat(),
        "one --input is needed, not 2",
    );
    fs::write(folder.path().join("library.so"), "another version").unwrap();
    refused(
        &[CASE, "--fmu", path, "--input", &input],
        "belongs to another version of slcbeam",
    );
    fs::write(path, "a file").unwrap();
    let (code, _, told) = export(folder.path(), &[CASE, "--fmu", path, "--input", &input]);
    assert!(code == Some(2) && told.contains("--force"), "{told}");
    assert_eq!(fs::read_to_string(path).unwrap(), "a file");
}
