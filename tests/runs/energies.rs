//! Figures of energy, and the verdict of their balance.

use slcbeam::run::summary::Summary;

use super::{run, shipped};

fn warned(summary: &Summary, code: &str) -> bool {
    summary.warnings.iter().any(|w| w.starts_with(code))
}

/// Source: Fig. 6 of Matia & Gat. Goal: for the reciprocal, conservative beam with earlier energy input, `run` printed 193 % in the window.
/// Of the energy spent in it the turbine has 59 % (70 % with creeping tube flow), and never more than all for a passive beam. With the
/// published coupling, the origin of an efficiency above one is named.
#[test]
fn an_efficiency_counts_what_was_spent() {
    let passive = [r#"/bladders/coupling="reciprocal""#, r#"/formulation="conservative""#];
    let sound = run(&shipped("harvester-crossover-uniform", &passive));
    let efficiency = sound.quantities["efficiency"];
    let window = efficiency.window.unwrap();
    assert!((0.5..0.7).contains(&window), "{efficiency:?}");
    assert!(efficiency.window_error.unwrap() < 0.05, "{efficiency:?}");
    assert!(!warned(&sound, "W020"), "{:?}", sound.warnings);
    let published = run(&shipped("harvester-crossover-uniform", &[]));
    let words: Vec<&String> = published.warnings.iter().filter(|w| w.starts_with("W020")).collect();
    assert_eq!(words.len(), 1, "{words:?}");
    assert!(
        words[0].contains("above one") && words[0].contains("published"),
        "{words:?}"
    );
}

/// Goal: under a wave, the same beam does a thirtieth of the work. At the default tolerance the balance is open by a large part of the
/// energy input, though closed to 2e-3 of the stored energy; a message beside the figures states it. The efficiency in the window still
/// agrees with that of a tighter run to a fifth.
#[test]
fn open_balances_are_told_beside_their_figures() {
    let wave = |rtol: &str| {
        run(&shipped(
            "harvester-parallel-wave",
            &[
                r#"/bladders/coupling="reciprocal""#,
                r#"/formulation="conservative""#,
                r#"/effects={"tube_inertia":"off","tube_losses":"off"}"#,
                rtol,
            ],
        ))
    };
    let (usual, tight) = (wave("/solver/rtol=1e-5"), wave("/solver/rtol=1e-7"));
    let input = usual.quantities["input_energy_j"];
    assert!(input.window_error.unwrap() > 0.03, "{input:?}");
    assert!(usual.balances.energy_residual_relative < 0.01);
    assert!(warned(&usual, "W020"), "{:?}", usual.warnings);
    let window = |s: &Summary| s.quantities["efficiency"].window.unwrap();
    assert!(
        (window(&usual) / window(&tight) - 1.0).abs() < 0.2,
        "{} {}",
        window(&usual),
        window(&tight)
    );
    assert!(tight.quantities["input_energy_j"].window_error.unwrap() < 0.5 * input.window_error.unwrap());
}
