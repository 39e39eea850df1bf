//! Pressures that the loads do not explain, and those that they explain as well as noise lets them.

use slcbeam::numerics::rng::Rng;
use slcbeam::study::sense::basis::Basis;

use crate::command::{file, found, number, pressures, sense};
use crate::common::normal_number;

/// Pressures of another load than the one that is looked for: W032 with the worst bladder; with the noise left open a wide band, and how much is taken
/// for noise; nothing of the load that acts.
#[test]
fn pressures_that_no_load_explains_are_told() {
    let dir = tempfile::tempdir().unwrap();
    let (text, _) = pressures(&[], &[Basis::Point(0.4)], &[&[0.5]], &[1, 2, 3, 4, 5, 6, 7]);
    let path = file(&dir, &text);
    let own = found(&dir, &[&path, "--load", "tip-force", "--noise", "5"]);
    let warning = own["warnings"][0].as_str().unwrap();
    assert!(
        warning.starts_with("W032 the pressures do not fit tip-force") && warning.contains("bladder "),
        "{warning}"
    );
    // bands are wider by the root of what is left over its degrees of freedom, as the warning says
    let noise = &own["noise"];
    let widened = number(&noise["widened"]);
    assert!((widened - (number(&noise["chi_square"]) / number(&noise["freedom"])).sqrt()).abs() < 1e-9 * widened);
    let sd = 5.0 * number(&own["amplitudes"][0]["error_per_pa"]);
    let told = number(&own["rows"][0]["amplitudes"][0]["sd"]);
    assert!(
        widened > 2.0 && (told - widened * sd).abs() < 1e-6 * told,
        "{told}, not {widened} times {sd}"
    );
    let open = found(&dir, &[&path, "--load", "tip-force"]);
    let taken = open["warnings"][0].as_str().unwrap();
    assert!(
        taken.starts_with("W032 ")
            && taken.contains("% of the pressures are not explained by tip-force, and count as noise"),
        "{taken}"
    );
    assert!(number(&open["noise"]["sd_pa"]) > 50.0);
    let own = found(&dir, &[&path, "--load", "point:0.4"]);
    assert_eq!(own["warnings"], serde_json::json!([]));
    let again = format!(
        "slcbeam sense case.json {} --load=tip-force --noise=5",
        std::fs::canonicalize(&path).unwrap().display()
    );
    assert_eq!(
        found(&dir, &[&path, "--load", "tip-force", "--noise", "5"])["command"],
        again.as_str()
    );
    // a line with pressures that no beam has is named
    let wild = text
        .lines()
        .next()
        .unwrap()
        .split(',')
        .map(|_| "-7e9")
        .collect::<Vec<_>>()
        .join(",");
    let other = tempfile::tempdir().unwrap();
    let said = sense(
        &other,
        &[
            &file(&other, &format!("{text}{wild}\n")),
            "--load",
            "tip-force",
            "--noise",
            "5",
        ],
    );
    assert!(
        said.code == 0 && said.out.contains("W033 line 3 of the measurements"),
        "{}{}",
        said.out,
        said.err
    );
    // pressures to a thousandth of a pascal: noise of as much is right, of kilopascals given as pascals it is not, and is told as none of theirs
    let right = found(&dir, &[&path, "--load", "point:0.4", "--noise", "0.001"]);
    assert_eq!(right["warnings"], serde_json::json!([]));
    let large = found(&dir, &[&path, "--load", "point:0.4", "--noise", "1"])["warnings"].to_string();
    assert!(
        large.contains("W032 the residual of the pressures") && large.contains("Check its unit"),
        "{large}"
    );
    assert_eq!(number(&right["noise"]["widened"]), 1.0);
    // pressures in Pa under headings in kPa: no answer, and that is said before any number
    let text =
        "pressure_1_kpa,pressure_2_kpa,pressure_4_kpa,pressure_6_kpa,pressure_8_kpa\n-2870,-2420,-1560,-680,-50\n";
    let path = file(&dir, text);
    let said = sense(&dir, &[&path, "--load", "point:0.7", "--noise", "20"]);
    let (before, after) = said.out.split_once("value ± half").expect("a table");
    assert!(
        before.contains("W032 the pressures do not fit point:0.7")
            && before.contains("Do not use these loads")
            && before.contains("times those that bend the beam by about its length")
            && !after.contains("W032"),
        "{}",
        said.out
    );
}

/// By the discrepancy principle what is left of the pressures is their noise: the sum of its squares over the noise is the number of pressures,
/// and the roughness of the profile stands apart. Tolerance: the weight is found to 2 % of itself.
#[test]
fn discrepancy_leaves_the_noise() {
    let dir = tempfile::tempdir().unwrap();
    let bladders = [1, 2, 3, 4, 5, 6, 7, 8];
    let (text, _) = pressures(&[], &[Basis::Point(0.4)], &[&[0.5], &[-0.3]], &bladders);
    // what the mesh and a profile of few places leave is below it
    let mut chance = Rng::new(5, 0);
    let mut noisy = vec![];
    for (k, line) in text.lines().enumerate() {
        let cell = |cell: &str| match k {
            0 => cell.to_owned(),
            _ => format!("{}", cell.parse::<f64>().unwrap() + 0.02 * normal_number(&mut chance)),
        };
        noisy.push(line.split(',').map(cell).collect::<Vec<_>>().join(","));
    }
    let path = file(&dir, &(noisy.join("\n") + "\n"));
    let asked = [
        &path[..],
        "--load",
        "profile:12",
        "--noise",
        "20",
        "--smoothing",
        "discrepancy",
    ];
    let found = found(&dir, &asked);
    let noise = &found["noise"];
    let mut left = 0.0;
    for row in found["rows"].as_array().unwrap() {
        let pairs = row["measured_pa"]
            .as_array()
            .unwrap()
            .iter()
            .zip(row["modelled_pa"].as_array().unwrap());
        left += pairs
            .map(|(a, b)| ((number(a) - number(b)) / 20.0).powi(2))
            .sum::<f64>();
    }
    assert!((left / 16.0 - 1.0).abs() < 0.05, "{left} of 16 pressures");
    assert!(
        (number(&noise["misfit"]) / left - 1.0).abs() < 1e-3,
        "{noise} and {left}"
    );
    let sum = number(&noise["misfit"]) + number(&noise["roughness"]);
    assert!(number(&noise["roughness"]) > 0.0 && (number(&noise["chi_square"]) / sum - 1.0).abs() < 1e-9);
    let said = sense(&dir, &asked).out;
    assert!(
        said.contains("the residuals of 16 pressures have χ² = ") && said.contains("the roughness of the loads adds "),
        "{said}"
    );
}
