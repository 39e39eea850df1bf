//! Derivatives of cycles by numbers of their case.

use slcbeam::case::parameter::{Parameter, STEPS};
use slcbeam::case::{self, Case};
use slcbeam::error::Result;
use slcbeam::run::dynamics::Outcome;
use slcbeam::run::periodic::sensitivity::differentiate;
use slcbeam::run::periodic::{PeriodicScene, Settled, record, settle, shoot};
use slcbeam::run::record::{Control, Unrecorded};
use slcbeam::run::summary::{Status, Summary};

use crate::common::*;

/// Relative change of a number in the difference.
const CHANGE: f64 = 2e-2;

/// Two bladders that a closed network joins through a turbine, on the coarsest mesh.
fn harvester(sets: &[&str]) -> Case {
    let coarse = ["/mesh/cells_per_segment=1", "/mesh/cells_per_bladder=1"];
    let sets: Vec<String> = coarse.iter().chain(sets).map(|set| (*set).to_owned()).collect();
    case::load("cases/tour-harvester.json".as_ref(), &sets).unwrap()
}

fn cycle(case: &Case) -> Settled {
    let scene = PeriodicScene::new(case, None).unwrap();
    let found = shoot(&scene, None).unwrap();
    settle(case, scene, found).unwrap()
}

fn summary(outcome: Result<Outcome>) -> Summary {
    let summary = outcome.unwrap().summary;
    assert_eq!(summary.status, Status::Finished);
    summary
}

fn derivatives(case: &Case, pointer: &str) -> Result<Outcome> {
    let parameter = Parameter::find(case, pointer).unwrap();
    let nothing = &mut Unrecorded(|_: &_| Control::Continue);
    differentiate(&mut cycle(case), &[parameter], nothing)
}

/// Goal: derivatives of figures of a cycle are those of cycles found again at other values. Differences of fourth order are wrong by some
/// `CHANGE`⁴ = 2e-7, of second by `CHANGE`²/6 = 7e-5, and both by the errors of cycles, over `CHANGE`: at rtol 1e-7 those of motions are below
/// 2e-6, while energies, of which steps are not controlled, are open by 4e-5. `within` is for motions and for energies.
fn agrees(case: &Case, pointer: &str, quantities: &[&str], steps: &[(f64, f64)], within: [f64; 2]) {
    let parameter = Parameter::find(case, pointer).unwrap();
    let own = summary(derivatives(case, pointer));
    let beside = steps.iter().map(|(step, weight)| {
        let value = parameter.value * (1.0 + step * CHANGE);
        let other = cycle(&parameter.changed(case, value).unwrap());
        let nothing = &mut Unrecorded(|_: &_| Control::Continue);
        let other = record::record(&other.case, &other.scene, &other.cycle, nothing);
        (weight / (CHANGE * parameter.value), summary(other))
    });
    let beside: Vec<(f64, Summary)> = beside.collect();
    for quantity in quantities {
        let slopes = &own.sensitivities[pointer].quantities[*quantity];
        let mut compared = 0;
        for (figure, slope) in slopes.figures().filter(|(figure, _)| figure.starts_with("window")) {
            let of = |summary: &Summary| {
                let mut all = summary.quantities[*quantity].figures();
                all.find(|(own, _)| *own == figure).map(|(_, x)| x).unwrap()
            };
            let difference: f64 = beside.iter().map(|(weight, one)| weight * of(one)).sum();
            let within = within[usize::from(figure == "window")];
            let size = (of(&own) / parameter.value).abs().max(difference.abs());
            assert!(
                (slope - difference).abs() <= within * size,
                "{pointer} {quantity}.{figure}: {slope} and {difference} by differences, of {size}"
            );
            compared += 1;
        }
        assert!(compared > 0, "{pointer}: nothing of {quantity}");
    }
}

const CONDUCTANCE: &str = "/network/turbines/0/conductance/m3_s_pa";
const FIGURES: [&str; 5] = [
    "tip_u1_m",
    "tip_u3_m",
    "harvested_energy_j",
    "input_energy_j",
    "efficiency",
];

/// `[E75]` `[E76]`
#[test]
fn derivatives_of_a_cycle_are_those_of_differences() {
    let case = harvester(&["/solver/rtol=1e-7"]);
    agrees(&case, CONDUCTANCE, &FIGURES, &STEPS, [1e-4, 2e-3]);
}

/// What is conserved comes from the start of the case, and so does its derivative.
#[test]
fn a_cycle_goes_with_the_volume_of_its_start() {
    let start = "/start={\"pressures\": [{\"bladders\": [1, 2], \"pressure_pa\": 2000.0}]}";
    let case = harvester(&["/solver/rtol=1e-7", start]);
    let central = [(1.0, 0.5), (-1.0, -0.5)];
    let pointer = "/start/pressures/0/pressure_pa";
    agrees(
        &case,
        pointer,
        &["tip_u3_m", "tip_u1_m", "input_energy_j"],
        &central,
        [1e-3, 2e-3],
    );
}

#[test]
fn a_number_that_moves_the_period_is_refused() {
    let pointer = "/loads/0/force_x_n_m/signal/sine/frequency_hz";
    let error = derivatives(&harvester(&[]), pointer)
        .err()
        .map(|error| error.to_string());
    let error = error.unwrap_or_default();
    assert!(
        error.contains(pointer) && error.contains("changes the period"),
        "{error}"
    );
}

/// Goal: the command tells derivatives in words and files, and refuses before anything is written.
#[test]
fn the_command_tells_derivatives_of_the_cycle() {
    let dir = tempfile::tempdir().unwrap();
    let ask = |pointer: &str, out: &str| {
        let coarse = [
            "--set",
            "/mesh/cells_per_segment=1",
            "--set",
            "/mesh/cells_per_bladder=1",
        ];
        let asked = [
            "periodic",
            "cases/tour-harvester.json",
            "--sensitivity",
            pointer,
            "--quiet",
            "--out",
            out,
        ];
        say(&[&asked[..], &coarse].concat())
    };
    let out = path(&dir, "out");
    let said = ask(CONDUCTANCE, &out);
    assert_eq!(said.code, 0, "{}", said.err);
    let line = said
        .out
        .lines()
        .find(|line| line.starts_with(CONDUCTANCE))
        .unwrap_or_default();
    assert!(
        line.contains("+1 %: ") && line.contains("energy harvested −0.8"),
        "{}",
        said.out
    );
    let summary: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(format!("{out}/summary.json")).unwrap()).unwrap();
    let slope = &summary["sensitivities"][CONDUCTANCE]["quantities"]["harvested_energy_j"]["window"];
    assert!(number(slope) < 0.0);
    let table = std::fs::read_to_string(format!("{out}/sensitivities.csv")).unwrap();
    assert!(
        table.starts_with("t [s],d tip_u1/d"),
        "{}",
        table.lines().next().unwrap_or_default()
    );
    let beside = path(&dir, "beside");
    let said = ask("/loads/0/force_x_n_m/signal/sine/frequency_hz", &beside);
    assert!(said.code == 2 && said.err.contains("changes the"), "{}", said.err);
    assert!(!std::path::Path::new(&beside).exists());
}
