//! Error bands of histories compared with the true errors over time, from a run on finer meshes at a tighter tolerance.

use slcbeam::case::Case;
use slcbeam::case::schema::{Companion, Thinning};
use slcbeam::discrete::System;
use slcbeam::model::characteristic::forcing_period;
use slcbeam::run::dynamics;
use slcbeam::run::record::{Memory, ThinnedRows};
use slcbeam::run::summary::{Status, Summary, largest_error};
use slcbeam::study::companion;
use slcbeam::study::companion::band::{ErrorBand, width_at};

use super::shipped;

/// Columns with figures, and the names of these.
const COLUMNS: [(&str, &str); 4] = [
    ("tip_u1", "tip_u1_m"),
    ("tip_u3", "tip_u3_m"),
    ("tip_angle", "tip_angle_rad"),
    ("max_pressure", "max_pressure_pa"),
];

fn thinned(memory: &Memory) -> ThinnedRows {
    let mut rows = ThinnedRows::new(&memory.header.columns);
    memory.rows.iter().for_each(|row| rows.push(row));
    rows
}

/// A run with its error band.
fn banded(case: &Case) -> (Memory, Summary, Option<ErrorBand>) {
    let mut memory = Memory::default();
    let outcome = companion::run(case, System::new(case).expect("a system"), &[], &mut memory).expect("a run");
    assert_eq!(outcome.summary.status, Status::Finished, "{:?}", outcome.summary.reason);
    let rows = memory.companion.take();
    let band = rows.and_then(|rows| ErrorBand::new(&thinned(&memory), &rows, &outcome.summary, forcing_period(case)));
    (memory, outcome.summary, band)
}

/// Asserts that a band belongs to the bars of its run, and returns the part of the output times at which it covers a third of the error.
fn covered(name: &str, sets: &[&str], finer: &[&str]) -> f64 {
    let (own, summary, band) = banded(&shipped(name, sets));
    let band = band.expect("a band");
    let mut exact = Memory::default();
    dynamics::run(&shipped(name, &[sets, finer].concat()), &mut exact).expect("a reference");
    let times = own.column("t").expect("times");
    let (mut judged, mut within) = (0_u32, 0_u32);
    for (column, figure) in COLUMNS {
        let (Some(values), Some(right)) = (own.column(column), exact.column(column)) else {
            continue;
        };
        let widths = band.column_widths(column).expect("a band of each column");
        let (_, last) = widths.last().copied().expect("an end");
        let bar = summary.error(figure, "final").expect("a bar");
        assert!(last >= bar, "{name}: {column} ends with {last:e}, bar {bar:e}");
        let largest = widths.iter().fold(0.0_f64, |most, (_, width)| most.max(*width));
        let bars = largest_error(&summary.errors[figure]).expect("bars");
        assert!(largest >= bars, "{name}: {column} is {largest:e} wide, bar {bars:e}");
        let size = right.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let of_column = times
            .iter()
            .zip(values.iter().zip(&right))
            .filter_map(|(t, (x, truth))| {
                let error = (x - truth).abs();
                let width = width_at(&widths, *t).expect("a width within the run");
                (error > 1e-3 * size).then_some(3.0 * width >= error)
            });
        let of_column: Vec<bool> = of_column.collect();
        let inside = of_column.iter().filter(|inside| **inside).count();
        println!(
            "{name}: {column} {inside} of {}, largest {:.1e} of {size:.1e}",
            of_column.len(),
            largest
        );
        judged += of_column.len() as u32;
        within += inside as u32;
    }
    assert!(judged > 100, "{name}: {judged} values have an error");
    f64::from(within) / f64::from(judged)
}

/// Goal: bands cover free and driven motion with phase errors, a relaxing pressure, and an oscillation with a loose tolerance.
#[test]
fn bands_cover_errors_over_time() {
    let scenes: [(&str, &[&str], &[&str]); 3] = [
        (
            "two-bladders",
            &[],
            &[
                "/mesh/cells_per_segment=16",
                "/mesh/cells_per_bladder=8",
                "/solver/rtol=1e-7",
            ],
        ),
        (
            "dry-cantilever",
            &["/time/end_s=0.1", "/solver/rtol=1e-2"],
            &["/mesh/cells_per_segment=4", "/solver/rtol=1e-5"],
        ),
        (
            "wiring-2",
            &["/time/end_s=0.1", "/mesh/cells_per_segment=1"],
            &["/mesh/cells_per_segment=4", "/solver/rtol=1e-5"],
        ),
    ];
    for (name, sets, finer) in scenes {
        let part = covered(name, sets, finer);
        println!("{name}: {part}");
        assert!(part > 0.98, "{name}: {part}");
    }
}

/// Goal: a run of more outputs than a band has rows has one of bounded size, a run in a window one over the window, and a run without
/// companion none.
#[test]
fn bands_are_bounded_and_follow_the_recording() {
    let many = ["/time/end_s=0.02", "/time/output_interval_s=4e-6"];
    let (memory, _, band) = banded(&shipped("dry-cantilever", &many));
    let band = band.expect("a band");
    assert!(
        memory.rows.len() > 5000 && band.rows.len() <= ThinnedRows::MOST + 1,
        "{}",
        band.rows.len()
    );
    assert_eq!(band.rows.last().map(|row| row[0]), memory.rows.last().map(|row| row[0]));
    assert!(band.column_widths("energy_residual").is_none() && band.column_widths("kinetic_energy").is_some());
    let mut case = shipped("dry-cantilever", &["/time/end_s=0.02", "/time/window_s=0.005"]);
    case.time.history = Thinning::Window;
    let (memory, _, band) = banded(&case);
    assert_eq!(band.expect("a band").rows.len(), memory.rows.len());
    case.companion = Companion::Off;
    assert!(banded(&case).2.is_none());
}
