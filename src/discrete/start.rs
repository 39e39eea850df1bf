//! The state at t = 0 (A.55-A.58, A.70).

use super::shapes::Cells;
use super::{System, TimeData, Workspace, initial_angles, residual, shapes};
use crate::case::schema::Case;
use crate::case::wiring::bladder_index;
use crate::functions::profile::Profile;
use crate::functions::signals::SmoothTime;
use crate::model::ROWS;
use crate::numerics::Planar;

/// Scaled unknowns at the start. Displacements of nodes are as given, velocities are nearest to the given ones, and areas follow from the
/// means of the given pressures over each cell. Momentum and volume are thus exact on every mesh. Rates and algebraic unknowns are only
/// estimates for the subsequent consistent start.
pub fn state(system: &System, case: &Case, now: &TimeData) -> Vec<f64> {
    let l = &system.layout;
    let mut y = vec![0.0; l.len];
    let length = system.model.length;
    let at = |profile: &Option<Profile>, node: usize| {
        profile
            .as_ref()
            .map_or(0.0, |p| p.value(system.mesh.node_coordinate(node) / length))
    };
    let given = [
        (&case.start.u1_m, &case.start.u1_rate_m_s),
        (&case.start.u3_m, &case.start.u3_rate_m_s),
    ];
    for (axis, (line, (displacement, velocity))) in l.lines.iter().zip(given).enumerate() {
        let moving = velocity.as_ref().map(|v| velocities(system, v));
        for (node, u, v) in line.unknowns() {
            let frame = now.carried(axis, system.mesh.share(node));
            y[u] = at(displacement, node) - frame.value;
            if let Some(v) = v {
                y[v] = moving.as_ref().map_or(0.0, |v| v[node]) - frame.rate;
            }
        }
    }
    let mut w = Workspace::new(system);
    initial_angles::across(system, now, &mut y, &mut w);
    if !system.model.relaxation.is_empty() {
        residual::evaluate(system, now, &y, &vec![0.0; l.len], &mut w);
        residual::relaxation::settle(system, now, &w, &mut y);
    }
    fill_bladders(system, case, now, &mut y, &mut w);
    if !l.turning.angle.is_empty() {
        initial_angles::balance(system, now, &mut y, &mut w);
        residual::relaxation::settle(system, now, &w, &mut y);
        fill_bladders(system, case, now, &mut y, &mut w);
    }
    for (value, scale) in y.iter_mut().zip(&l.scales) {
        *value /= scale;
    }
    y
}

/// Velocities of nodes: nearest to the given ones; on a fourth-order mesh nodal values, if the profile is smooth.
fn velocities(system: &System, given: &Profile) -> Vec<f64> {
    let cells = system.mesh.shares();
    let nearest = shapes::nearest(given, &cells);
    if !system.mesh.fourth {
        return nearest;
    }
    let at_nodes: Vec<f64> = cells.nodes.iter().map(|place| given.value(*place)).collect();
    let most = at_nodes.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    let apart = |(a, b): (&f64, &f64)| (a - b).abs() <= SMOOTH * most;
    match at_nodes.iter().zip(&nearest).all(apart) {
        true => at_nodes,
        false => nearest,
    }
}

/// Largest difference of both velocities for a smooth profile, relative to the largest velocity: that of six cells per
/// wave.
const SMOOTH: f64 = 0.1;

/// Area change of every cell at the start [m^2], for a system in which those of all bladders are unknowns.
pub fn areas(system: &System, case: &Case) -> Vec<f64> {
    let mut now = TimeData::new(system);
    now.update(system, SmoothTime { t: 0.0, within: 0.0 });
    let (l, y) = (&system.layout, state(system, case, &now));
    let mut areas = vec![0.0; system.fluid.as_ref().map_or(0, |fluid| fluid.cells)];
    let cells = system
        .fluid
        .iter()
        .flat_map(|fluid| fluid.runs.iter().cloned().flatten());
    for (cell, unknown) in cells.zip(l.network.area.clone()) {
        areas[cell] = y[unknown] * l.scales[unknown];
    }
    areas
}

/// Computes areas from the prescribed pressures, and the resulting means: a fixed-point iteration, exact after one
/// iteration unless the coupling depends on the means.
fn fill_bladders(system: &System, case: &Case, now: &TimeData, y: &mut [f64], w: &mut Workspace<f64>) {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return;
    };
    let l = &system.layout;
    let k = fluid.cells_per_bladder;
    let mut pressure = vec![0.0; fluid.cells];
    for start in &case.start.pressures {
        let means = shapes::in_cells(&start.pressure_pa, &Cells::equal(k));
        for bladder in start.bladders.iter().filter_map(|b| bladder_index(*b, wet.per_row)) {
            pressure[fluid.cells_of(bladder)].copy_from_slice(&means);
        }
    }
    for (k, lumped) in wet.lumped.iter().enumerate() {
        if let Some(unknown) = l.network.lumped_pressure[k] {
            let cells = lumped.bladders.iter().flat_map(|&b| fluid.cells_of(b));
            y[unknown] =
                cells.map(|c| pressure[c]).sum::<f64>() / (lumped.bladders.len() * fluid.cells_per_bladder) as f64;
        }
        if let Some(unknown) = l.network.lumped_volume[k] {
            y[unknown] = fluid.volume_at_start[k];
        }
    }
    let yp = vec![0.0; y.len()];
    let mut residual = vec![0.0; y.len()];
    for _ in 0..20 {
        for j in 0..wet.per_row {
            let [moment, force] = [&l.coupling.mean_moment, &l.coupling.mean_force]
                .map(|means| means.clone().nth(j).map_or(0.0, |unknown| y[unknown]));
            for (bladder, row) in wet.pair(j).into_iter().zip(ROWS) {
                let excess = l.coupling.excess_of(bladder).map_or(0.0, |unknown| y[unknown]);
                let law = wet.area_of(bladder);
                let imposed = law.of_moment(moment, row) + law.of_force(force) + excess;
                if let Ok(slot) = fluid.flowing.binary_search(&bladder) {
                    for (k, cell) in fluid.cells_of(bladder).enumerate() {
                        y[l.network.area.start + slot * fluid.cells_per_bladder + k] =
                            wet.content(law, pressure[cell], imposed);
                    }
                }
            }
        }
        residual::residual(system, now, y, &yp, w, &mut residual);
        residual::relaxation::settle(system, now, w, y);
        // The residual of a mean is its error.
        let own = &l.coupling;
        let means = own.mean_moment.clone().chain(own.mean_force.clone());
        let means = means.chain(own.excess_area.clone());
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
    for (junction, value) in y[l.network.junction.clone()].iter_mut().enumerate() {
        *value = w.fluid.junction.get(junction).map_or(0.0, |&p| wet.potential(p));
    }
    for one in &fluid.accumulators {
        let pressure = match one.number {
            Some(number) => wet.network.accumulators[number].start_pressure,
            None => fluid.around(one.junction, &pressure, &now.port_pressure),
        };
        y[l.network.junction.start + one.junction] = wet.vessel_content(&one.law, pressure);
    }
}

/// Adds velocity jumps [m/s] to the velocities of free nodes.
pub fn speed_up(system: &System, jumps: &[Planar<f64>], y: &mut [f64]) {
    let l = &system.layout;
    for (axis, line) in l.lines.iter().enumerate() {
        for (node, _, v) in line.unknowns() {
            if let Some(v) = v {
                y[v] += jumps[node][axis] / l.scales[v];
            }
        }
    }
}

/// Keeps displacements and velocities constant while the signals of ends change from one smooth branch to the next.
pub fn change_frame(system: &System, before: &TimeData, after: &TimeData, y: &mut [f64]) {
    let l = &system.layout;
    for (axis, line) in l.lines.iter().enumerate() {
        let Some((before, after)) = before.frame(axis).zip(after.frame(axis)) else {
            continue;
        };
        for (node, u, v) in line.unknowns() {
            let (old, new) = (before.at(system.mesh.share(node)), after.at(system.mesh.share(node)));
            y[u] += (old.value - new.value) / l.scales[u];
            if let Some(v) = v {
                y[v] += (old.rate - new.rate) / l.scales[v];
            }
        }
    }
}
