//! Pressures, their strains of the beam, and flows.

use std::ops::Range;

use crate::case::schema::Effect;
use crate::discrete::fluid_mesh::{LinkEnd, MeshBridge, MeshLink, MeshSource};
use crate::discrete::{FluidMesh, System, TimeData, Workspace};
use crate::model::{AreaLaw, Compression, ROWS, Storage, Wet};
use crate::numerics::Scalar;

/// `[E8]` Pressure of each cell from its area, and the mean of each bladder (A.15, A.16 solved for p):
///
/// ```text
/// p = (a1 - R A_M(Mbar_j) - A_N(Nbar_j))/a_p
/// ```
///
/// A bladder that keeps its volume has one pressure; a bladder that shares its pressure has one area, `[E23]`.
pub fn pressures<T: Scalar>(system: &System, w: &mut Workspace<T>) {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return;
    };
    let share = 1.0 / fluid.cells_per_bladder as f64;
    for j in 0..wet.per_row {
        let (force, moment) = (w.coupling.mean_force[j], w.coupling.mean_moment[j]);
        for (bladder, row) in wet.pair(j).into_iter().zip(ROWS) {
            let law = wet.area_of(bladder);
            let mut imposed = law.of_force(force) + law.of_moment(moment, row);
            if let Some(excess) = w.coupling.excess_area.get(bladder) {
                imposed += *excess;
            }
            if !wet.has(bladder) {
                continue;
            }
            let cells = fluid.cells_of(bladder);
            if let Some(compression) = &wet.compression {
                w.fluid.mean_pressure[bladder] = compressed(wet, compression, bladder, cells, imposed, w);
                continue;
            }
            w.fluid.mean_pressure[bladder] = match wet.storage[bladder] {
                Storage::Flowing => {
                    let mut sum = T::zero();
                    for cell in cells {
                        let p = law.pressure(w.fluid.area[cell], imposed);
                        w.fluid.pressure[cell] = pressed(wet, law, p, w.fluid.area[cell]);
                        sum += p;
                    }
                    sum * share
                }
                Storage::Kept => {
                    let area = w.fluid.area[cells.start];
                    let p = law.pressure(area, imposed);
                    w.fluid.pressure[cells].fill(pressed(wet, law, p, area));
                    p
                }
                Storage::Shared(lumped) => {
                    let p = w.fluid.lumped[lumped];
                    let area = wet.swelling(law, p, imposed);
                    w.fluid.area[cells.clone()].fill(area);
                    w.fluid.pressure[cells].fill(p);
                    straining(wet, law, p, area)
                }
                Storage::Absent => T::zero(),
            };
        }
    }
}

/// Pressures of a compressible fluid in a bladder, [E54], and the potentials of its flow, [E55].
#[inline(never)] // so that its constants are not made where fluid is not
fn compressed<T: Scalar>(
    wet: &Wet,
    compression: &Compression,
    bladder: usize,
    cells: Range<usize>,
    imposed: T,
    w: &mut Workspace<T>,
) -> T {
    let own = &mut w.fluid;
    let law = wet.area_of(bladder);
    let (p, in_walls, area) = match wet.storage[bladder] {
        Storage::Flowing => {
            let share = 1.0 / cells.len() as f64;
            let mut sum = T::zero();
            for cell in cells {
                let (p, in_walls, area) = of_content(wet, law, compression, own.area[cell], imposed);
                own.pressure[cell] = p;
                own.swelling[cell] = area;
                own.potential[cell] = compression.potential(p);
                sum += in_walls;
            }
            return sum * share;
        }
        Storage::Kept => of_content(wet, law, compression, own.area[cells.start], imposed),
        Storage::Shared(lumped) => {
            let p = own.lumped[lumped];
            let area = wet.swelling(law, p, imposed);
            own.area[cells.clone()].fill(compression.content(law, p, area));
            (p, straining(wet, law, p, area), area)
        }
        Storage::Absent => return T::zero(),
    };
    own.pressure[cells.clone()].fill(p);
    own.swelling[cells].fill(area);
    in_walls
}

/// Pressure of the fluid, pressure on the walls, and area change of a cell, from its content.
#[inline]
fn of_content<T: Scalar>(wet: &Wet, law: &AreaLaw, compression: &Compression, content: T, imposed: T) -> (T, T, T) {
    match &wet.closing {
        None => {
            let p = compression.pressure(law, content, imposed);
            (p, p, p * law.per_pressure + imposed)
        }
        Some(closing) => {
            let area = closing.swelling_of(law, compression, content, imposed);
            let in_walls = law.pressure(area, imposed);
            (in_walls - closing.pressure(law, area), in_walls, area)
        }
    }
}

/// Pressure on the walls of a cell from that of its fluid: the inverse of [`pressed`].
#[inline]
fn straining<T: Scalar>(wet: &Wet, law: &AreaLaw, fluid: T, area: T) -> T {
    match &wet.closing {
        None => fluid,
        Some(closing) => fluid + closing.pressure(law, area),
    }
}

/// Pressure of the fluid in a cell from that on its walls.
#[inline]
fn pressed<T: Scalar>(wet: &Wet, law: &AreaLaw, in_walls: T, area: T) -> T {
    match &wet.closing {
        None => in_walls,
        Some(closing) => in_walls - closing.pressure(law, area),
    }
}

/// Stretch and curvature of each segment by pressure, `[E3]`.
pub fn pressure_strains<T: Scalar>(system: &System, w: &mut Workspace<T>) {
    let Some(wet) = &system.model.wet else { return };
    let effects = &system.model.effects;
    for j in 0..wet.per_row {
        let [upper, lower] = wet.pair(j).map(|bladder| w.fluid.mean_pressure[bladder]);
        let (coupling, strains) = wet.strains_of(j);
        if effects.has(Effect::PressureToStretch) && effects.has(Effect::AxialStretch) {
            w.coupling.pressure_stretch[j] = coupling.stretch(strains, w.coupling.mean_force[j], upper, lower);
        }
        if effects.has(Effect::PressureToCurvature) {
            w.coupling.pressure_curvature[j] = coupling.curvature(strains, w.coupling.mean_moment[j], upper, lower);
        }
    }
}

/// Pressure at a cell, junction or port.
#[inline]
pub fn pressure_at<T: Scalar>(place: LinkEnd, now: &TimeData, w: &Workspace<T>) -> T {
    match place {
        LinkEnd::Cell(c) => w.fluid.pressure[c],
        LinkEnd::Junction(j) => w.fluid.junction[j],
        LinkEnd::Port(p) => T::constant(now.port_pressure[p]),
    }
}

/// `[E9]` Net inflow of each cell and junction (A.13):
///
/// ```text
/// q = -(q1b/μ) dp/ds inside a bladder, q = g (p_a - p_b) along a link, prescribed at a source
/// ```
pub fn flows<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return;
    };
    if !wet.flows {
        return;
    }
    w.fluid.inflow.fill(T::zero());
    w.fluid.junction_inflow.fill(T::zero());
    let own = &mut w.fluid;
    let compressed = wet.compression.is_some();
    let driven_by = if compressed { &own.potential } else { &own.pressure };
    for [from, to] in fluid.creeping_faces() {
        let q = (driven_by[from] - driven_by[to]) * fluid.conductance_of(wet, from / fluid.cells_per_bladder);
        own.inflow[from] -= q;
        own.inflow[to] += q;
    }
    for &[k, from, to] in &fluid.sorted.between_cells {
        let [k, from, to] = [k, from, to].map(|number| number as usize);
        let drop = driven_by[from] - driven_by[to];
        // [E55], which allows Newton's iteration to reach vacuum
        let q = drop * now.conductance[k];
        if !compressed {
            own.drop[k] = drop;
        }
        own.flow[k] = q;
        own.inflow[from] -= q;
        own.inflow[to] += q;
    }
    for &k in &fluid.sorted.others {
        let link = &fluid.links[k];
        let q = match (link.flow, &wet.compression) {
            (None, Some(compression)) if link.is_plain() => {
                let ends = [link.from, link.to].map(|place| potential_at(compression, place, now, w));
                (ends[0] - ends[1]) * link.conductance(now, w, k)
            }
            (None, _) => {
                look_along(wet, link, now, w, k);
                let driving = driving(link, now, w, k);
                let volume = match &link.check_valve {
                    None => driving * link.conductance(now, w, k),
                    Some(_) if now.conductance[k] == 0.0 => T::zero(),
                    Some(valve) => now.tangents.behind(k, valve, 1.0 / now.conductance[k], driving),
                };
                w.fluid.at_ambient_density(k, volume)
            }
            (Some(flow), _) => {
                look_along(wet, link, now, w, k);
                let moving = w.fluid.moving[flow.number];
                w.fluid.root_of_density(k).map_or(moving, |root| moving * root)
            }
        };
        w.fluid.flow[k] = q;
        deliver(link.from, -q, w);
        deliver(link.to, q, w);
    }
    for &MeshSource { number, into, .. } in &fluid.sources {
        deliver(into, T::constant(now.source_flow[number]), w);
    }
    for (k, &MeshBridge { from, to, .. }) in fluid.bridges.iter().enumerate() {
        let q = through_bridge(wet, fluid, k, now, w);
        deliver(from, -q, w);
        deliver(to, q, w);
    }
}

/// `[E88]` Driving pressure of a link between points of the heights z: the pressure drop D, the weight of the fluid, and the pressure of
/// its pump:
///
/// ```text
/// D + r̄ ρ_0 g (z_a - z_b) + p_pump
/// ```
///
/// r̄ is the mean density of [E64] relative to `ρ_0`, 1 for an incompressible fluid. With `h_a - h_b = -ρ_0 g (z_a - z_b)` nothing flows:
/// `dp = -ρ g dz` for every law of the density. The weight works `ρ_0 g (z_a - z_b) q`, which counts as work of loads.
#[inline]
pub fn driving<T: Scalar>(link: &MeshLink, now: &TimeData, w: &Workspace<T>, k: usize) -> T {
    let mut driving = w.fluid.drop[k];
    if link.head != 0.0 {
        driving += w.fluid.at_ambient_density(k, T::constant(link.head * now.gravity));
    }
    match link.pump {
        None => driving,
        Some(pump) => driving + pump_pressure(link, pump, now, w, k),
    }
}

/// Pressure that the pump of a link adds, [E87], without the linear resistance.
#[inline]
pub fn pump_pressure<T: Scalar>(link: &MeshLink, pump: usize, now: &TimeData, w: &Workspace<T>, k: usize) -> T {
    let signal = now.pump_pressure[pump];
    match &link.pump_curve {
        None => T::constant(signal),
        Some(curve) => curve.pressure(w.fluid.at_mean_density(k, w.fluid.flow[k])) * signal,
    }
}

/// `[E64]` Pressure drop between two places of a compressible fluid, and the mean density between them relative to ambient density:
///
/// ```text
/// r̄² = (Ψ_a - Ψ_b)/(h_a - h_b)      D = r̄ (h_a - h_b) = (Ψ_a - Ψ_b)/r̄      q = r̄ Q
/// ```
///
/// Q is the volume flow at that density. Then `Q = D/R` is [E55], and `q (h_a - h_b) = Q D`: all elements between the places respond to
/// the pressure drop D and the flow Q as with incompressible fluid, also in energy.
#[inline]
pub fn along<T: Scalar>(wet: &Wet, from: LinkEnd, to: LinkEnd, now: &TimeData, w: &Workspace<T>) -> (T, Option<T>) {
    let (a, b) = (pressure_at(from, now, w), pressure_at(to, now, w));
    match &wet.compression {
        None => (a - b, None),
        Some(compression) => {
            let density = compression.mean_density(a, b);
            (
                (compression.brought(a) - compression.brought(b)) * density,
                Some(density),
            )
        }
    }
}

/// Writes the result of [`along`] for a link to the workspace.
#[inline]
pub fn look_along<T: Scalar>(wet: &Wet, link: &MeshLink, now: &TimeData, w: &mut Workspace<T>, k: usize) {
    let (drop, density) = along(wet, link.from, link.to, now, w);
    w.fluid.drop[k] = drop;
    if let Some(density) = density {
        w.fluid.density[k] = density;
    }
}

/// Potential `Ψ` at a place.
#[inline]
fn potential_at<T: Scalar>(compression: &Compression, place: LinkEnd, now: &TimeData, w: &Workspace<T>) -> T {
    match place {
        LinkEnd::Cell(c) => w.fluid.potential[c],
        LinkEnd::Junction(_) | LinkEnd::Port(_) => compression.potential(pressure_at(place, now, w)),
    }
}

/// Pressure drops over the two pairs of valves of a bridge, and mean density, [E10] [E64].
#[inline]
pub fn over_bridge<T: Scalar>(
    wet: &Wet,
    fluid: &FluidMesh,
    k: usize,
    now: &TimeData,
    w: &Workspace<T>,
) -> ((T, T), Option<T>) {
    let MeshBridge { number, from, to } = fluid.bridges[k];
    let (mut drop, density) = along(wet, from, to, now, w);
    let head = wet.network.bridges[number].head;
    if head != 0.0 {
        drop += density.unwrap_or(T::constant(1.0)) * (head * now.gravity);
    }
    (bridge_drops(drop, w.fluid.bridge[k]), density)
}

/// Flow through a bridge, at ambient density [m^3/s].
#[inline]
pub fn through_bridge<T: Scalar>(wet: &Wet, fluid: &FluidMesh, k: usize, now: &TimeData, w: &Workspace<T>) -> T {
    let valve = &wet.network.bridges[fluid.bridges[k].number].valve;
    let (drops, density) = over_bridge(wet, fluid, k, now, w);
    let (forward, backward) = now.tangents.through(k, valve, drops);
    let volume = forward - backward;
    density.map_or(volume, |density| volume * density)
}

/// `[E10]` Pressure drops over the two pairs of valves of a symmetric bridge: `(d - w)/2` and `(-d - w)/2`, with `d`
/// between its ports and `w` over the turbine.
#[inline]
pub fn bridge_drops<T: Scalar>(d: T, turbine: T) -> (T, T) {
    ((d - turbine) * 0.5, (-d - turbine) * 0.5)
}

#[inline]
fn deliver<T: Scalar>(place: LinkEnd, flow: T, w: &mut Workspace<T>) {
    match place {
        LinkEnd::Cell(c) => w.fluid.inflow[c] += flow,
        LinkEnd::Junction(j) => w.fluid.junction_inflow[j] += flow,
        LinkEnd::Port(_) => {}
    }
}
