//! The state at t = 0 (A.55-A.58, A.70).

use super::{System, TimeData, Workspace, residual, shapes};
use crate::case::schema::Case;
use crate::case::wiring::bladder_index;
use crate::functions::profile::Profile;
use crate::functions::signals::Clock;

/// Scaled unknowns at the start: displacements of nodes as given, velocities nearest to those given, areas from the means of the given
/// pressures over each cell, so that momentum and volume are those of the start on every mesh.
/// Rates and whatever is algebraic are only guessed; a consistent start follows from these.
pub fn state(system: &System, case: &Case, now: &TimeData) -> Vec<f64> {
    let l = &system.layout;
    let mut y = vec![0.0; l.len];
    let length = system.model.length;
    let at = |profile: &Option<Profile>, node: usize| {
        profile
            .as_ref()
            .map_or(0.0, |p| p.value(system.mesh.node_coordinate(node) / length))
    };
    let last = (system.mesh.nodes - 1) as f64;
    let lines = [
        (
            now.frame_1(),
            &l.free_u1,
            l.u1,
            l.v1,
            l.waves[0],
            &case.start.u1_m,
            &case.start.u1_rate_m_s,
        ),
        (
            now.frame_3(),
            &l.free_u3,
            l.u3,
            l.v3,
            l.waves[1],
            &case.start.u3_m,
            &case.start.u3_rate_m_s,
        ),
    ];
    for (frame, free, u, v, waves, displacement, velocity) in lines {
        let moving = velocity.as_ref().map(|v| shapes::nearest(v, system.mesh.cells));
        for (k, node) in free.clone().enumerate() {
            let frame = frame.map_or(Default::default(), |f| f.at(node as f64 / last));
            y[u + k] = at(displacement, node) - frame.value;
            if waves {
                y[v + k] = moving.as_ref().map_or(0.0, |v| v[node]) - frame.rate;
            }
        }
    }
    fill_bladders(system, case, now, &mut y);
    for (value, scale) in y.iter_mut().zip(&l.scales) {
        *value /= scale;
    }
    y
}

/// Area change of every cell at the start [m^2], of a system in which all of them are unknowns.
pub fn areas(system: &System, case: &Case) -> Vec<f64> {
    let mut now = TimeData::new(system);
    now.update(system, Clock { t: 0.0, within: 0.0 });
    let (l, y) = (&system.layout, state(system, case, &now));
    (l.area..l.junction).map(|k| y[k] * l.scales[k]).collect()
}

/// Areas that give the prescribed pressures, with the means that follow from them: a fixed point, exact after one
/// round unless the coupling depends on the means.
fn fill_bladders(system: &System, case: &Case, now: &TimeData, y: &mut [f64]) {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return;
    };
    let l = &system.layout;
    let k = fluid.cells_per_bladder;
    let mut pressure = vec![0.0; fluid.cells];
    for start in &case.start.pressures {
        let means = shapes::in_cells(&start.pressure_pa, k);
        for bladder in start.bladders.iter().filter_map(|b| bladder_index(*b, wet.per_row)) {
            pressure[fluid.cells_of(bladder)].copy_from_slice(&means);
        }
    }
    for (k, pool) in wet.pools.iter().enumerate() {
        if let Some(unknown) = l.pool_pressure[k] {
            let cells = pool.bladders.iter().flat_map(|&b| fluid.cells_of(b));
            y[unknown] =
                cells.map(|c| pressure[c]).sum::<f64>() / (pool.bladders.len() * fluid.cells_per_bladder) as f64;
        }
        if let Some(unknown) = l.pool_volume[k] {
            y[unknown] = fluid.volume_at_start[k];
        }
    }
    let yp = vec![0.0; y.len()];
    let mut w = Workspace::new(system);
    let mut residual = vec![0.0; y.len()];
    for _ in 0..20 {
        for j in 0..wet.per_row {
            let mean = |takes: bool, first: usize| if takes { y[first + j] } else { 0.0 };
            let (moment, force) = (
                mean(wet.takes_moments, l.mean_moment),
                mean(wet.takes_forces, l.mean_force),
            );
            for (bladder, row) in [(j, 1.0), (wet.per_row + j, -1.0)] {
                let imposed = wet.area.of_moment(moment, row) + wet.area.of_force(force);
                if let Ok(slot) = fluid.flowing.binary_search(&bladder) {
                    for (k, cell) in fluid.cells_of(bladder).enumerate() {
                        y[l.area + slot * fluid.cells_per_bladder + k] =
                            wet.area.per_pressure * pressure[cell] + imposed;
                    }
                }
            }
        }
        residual::residual(system, now, y, &yp, &mut w, &mut residual);
        // The residual of a mean is what it lacks.
        let means = l.mean_moment..l.area;
        let worst = means
            .clone()
            .map(|i| (residual[i] / l.scales[i]).abs())
            .fold(0.0, f64::max);
        for i in means {
            y[i] -= residual[i];
        }
        if worst < 1e-15 {
            break;
        }
    }
    for (junction, value) in y[l.junction..l.bridge].iter_mut().enumerate() {
        *value = w.junction.get(junction).copied().unwrap_or(0.0);
    }
}

/// Adds jumps [m/s] to the velocities of free nodes.
pub fn speed_up(system: &System, jumps: &[[f64; 2]], y: &mut [f64]) {
    let l = &system.layout;
    let lines = [(&l.free_u1, l.v1, l.waves[0]), (&l.free_u3, l.v3, l.waves[1])];
    for (k, (free, v, _)) in lines.into_iter().enumerate().filter(|(_, line)| line.2) {
        for (unknown, node) in free.clone().enumerate() {
            y[v + unknown] += jumps[node][k] / l.scales[v + unknown];
        }
    }
}

/// Keeps displacements and velocities what they are while the ends' signals pass from one smooth branch to the next.
pub fn change_frame(system: &System, before: &TimeData, after: &TimeData, y: &mut [f64]) {
    let l = &system.layout;
    let last = (system.mesh.nodes - 1) as f64;
    let lines = [
        (before.frame_1(), after.frame_1(), &l.free_u1, l.u1, l.v1, l.waves[0]),
        (before.frame_3(), after.frame_3(), &l.free_u3, l.u3, l.v3, l.waves[1]),
    ];
    for (before, after, free, u, v, waves) in lines {
        let (Some(before), Some(after)) = (before, after) else {
            continue;
        };
        for (k, node) in free.clone().enumerate() {
            let (old, new) = (before.at(node as f64 / last), after.at(node as f64 / last));
            y[u + k] += (old.value - new.value) / l.scales[u + k];
            if waves {
                y[v + k] += (old.rate - new.rate) / l.scales[v + k];
            }
        }
    }
}
