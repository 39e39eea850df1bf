//! Modes with sealed or free fluid, and pairs of modes of two systems.

use super::{FluidBehavior, LimitingMode, Mode, ModeOptions, Modes, Tally, likeness, search};

/// Finds the same modes with sealed and with free fluid. Limits that are not found remain unknown.
pub(super) fn find(found: &mut Modes, plan: &ModeOptions) {
    if !found.about.flows() {
        return;
    }
    let wider = ModeOptions {
        count: plan.count + 4,
        ..*plan
    };
    let mut tally = Tally::default();
    for fluid in [FluidBehavior::Sealed, FluidBehavior::Free] {
        // the larger number may not converge
        let mut try_plan = |plan| search(&found.about, fluid, plan, &mut tally);
        let Ok(others) = try_plan(&wider).or_else(|_| try_plan(plan)) else {
            continue;
        };
        for (k, j, likeness) in matched(&found.modes, &others) {
            let Some(frequency_hz) = others[j].frequency_hz() else {
                continue;
            };
            let limit = LimitingMode { frequency_hz, likeness };
            match fluid {
                FluidBehavior::Sealed => found.modes[k].undrained = Some(limit),
                _ => found.modes[k].drained = Some(limit),
            }
        }
    }
    found.factorizations += tally.factorizations;
    found.solves += tally.solves;
}

/// Pairs oscillations with those of other equations: indices in both lists, and the likeness of the shapes.
fn matched(modes: &[Mode], others: &[Mode]) -> Vec<(usize, usize, f64)> {
    paired(
        modes,
        others,
        |mode| mode.kind.swings(),
        |a, b| likeness(&a.shape, &b.shape),
    )
}

/// Likeness above which two modes may be the same.
const ALIKE: f64 = 0.5;

/// Pairs modes of a sort, the most alike first, each at most once.
pub(super) fn paired(
    modes: &[Mode],
    others: &[Mode],
    of_sort: impl Fn(&Mode) -> bool,
    alike: impl Fn(&Mode, &Mode) -> f64,
) -> Vec<(usize, usize, f64)> {
    let mut all = vec![];
    for (k, mode) in modes.iter().enumerate().filter(|m| of_sort(m.1)) {
        for (j, other) in others.iter().enumerate().filter(|m| of_sort(m.1)) {
            all.push((k, j, alike(mode, other)));
        }
    }
    all.sort_by(|a, b| b.2.total_cmp(&a.2));
    let (mut taken, mut given) = (vec![false; modes.len()], vec![false; others.len()]);
    all.retain(|&(k, j, alike)| {
        let new = !taken[k] && !given[j] && alike > ALIKE;
        if new {
            (taken[k], given[j]) = (true, true);
        }
        new
    });
    all
}
