//! What is read off a state: the columns of the history and the fields.

use super::fluid_mesh::Place;
use super::{Instant, System, Workspace};
use crate::discrete::ledger::{self, Energies, FLOWS};
use crate::discrete::recipe::fluid::pressure_at;
use crate::discrete::recipe::solid::node_stretch;
use crate::model::Kinematics;
use crate::model::mapping::{NetworkCoordinate, TABLE_TUBE_RATIO};
use crate::model::network::{LinkKind, bladder_label};

/// A column: name, unit, one sentence.
pub type ColumnText = (&'static str, &'static str, &'static str);

/// Columns of the beam alone.
const BEAM: [ColumnText; 4] = [
    ("t", "s", "time"),
    ("tip_u1", "m", "transverse displacement of the tip"),
    ("tip_u3", "m", "axial displacement of the tip"),
    (
        "tip_angle",
        "rad",
        "slope angle phi of the tip, counted over full turns",
    ),
];

/// Columns of the fluid.
const FLUID: [ColumnText; 4] = [
    ("max_pressure", "Pa", "pressure of the cell with the highest pressure"),
    ("min_pressure", "Pa", "pressure of the cell with the lowest pressure"),
    ("turbine_power", "W", "power of all turbines"),
    (
        "least_opening",
        "1",
        "smallest bladder cross-section over that at rest; 0 is closed",
    ),
];

/// Columns of the balances.
const BALANCE: [ColumnText; 16] = [
    ("kinetic_energy", "J", "kinetic energy of the beam's translation"),
    ("rotary_energy", "J", "kinetic energy of the sections' rotation"),
    ("axial_energy", "J", "elastic energy of stretch"),
    ("bending_energy", "J", "elastic energy of bending"),
    ("bladder_energy", "J", "energy stored in the bladders"),
    ("work_loads", "J", "work of distributed loads and end forces"),
    ("work_ends", "J", "work of driven ends and end moments"),
    ("work_ports", "J", "work of pressure and flow ports"),
    ("dissipated_bladders", "J", "dissipated by flow in the bladders"),
    ("dissipated_tubes", "J", "dissipated by flow in the tubes"),
    ("harvested", "J", "harvested by the turbines"),
    ("dissipated_rectifiers", "J", "dissipated in check valves"),
    ("dissipated_damping", "J", "dissipated by material damping and drag"),
    (
        "work_formulation",
        "J",
        "energy that the published momentum balance adds",
    ),
    (
        "work_reciprocity",
        "J",
        "energy that a coupling without reciprocity adds",
    ),
    (
        "energy_residual",
        "J",
        "energy now less energy at the start less all of the above: the integrator's error",
    ),
];

/// All columns of a system's history.
pub fn columns(system: &System) -> Vec<ColumnText> {
    let mut all = BEAM.to_vec();
    if system.fluid.is_some() {
        all.extend(FLUID);
    }
    all.extend(BALANCE);
    all
}

/// Balance of energy at an instant.
#[derive(Clone, Copy, Debug, Default)]
pub struct EnergyBalance {
    /// Stored now.
    pub stored: Energies,
    /// Residual [J].
    pub residual: f64,
}

/// Energy now, less at the start, less all that came in and went out (`integrals` of [`FLOWS`]).
pub fn energy_balance(stored: Energies, at_start: f64, integrals: &[f64]) -> EnergyBalance {
    let passed: f64 = FLOWS.iter().map(|f| f.energy_sign() * integrals[*f as usize]).sum();
    EnergyBalance {
        stored,
        residual: stored.total() - at_start - passed,
    }
}

/// One row of the history. The workspace holds the evaluated state.
pub fn row(
    system: &System,
    now: &Instant,
    t: f64,
    w: &Workspace<f64>,
    balance: &EnergyBalance,
    integrals: &[f64],
    row: &mut Vec<f64>,
) {
    let last = system.mesh.nodes - 1;
    row.clear();
    row.extend([t, w.u1[last], w.u3[last], tip_angle(system, w)]);
    if system.fluid.is_some() {
        let high = w.pressure.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let low = w.pressure.iter().copied().fold(f64::INFINITY, f64::min);
        row.extend([high, low, turbine_power(system, now, w), least_opening(system, w)]);
    }
    let e = &balance.stored;
    row.extend([e.kinetic, e.rotary, e.axial, e.bending, e.bladders]);
    // The columns of works and losses are in the order of FLOWS.
    row.extend(
        FLOWS
            .iter()
            .filter(|f| f.energy_sign() != 0.0)
            .map(|f| integrals[*f as usize]),
    );
    row.push(balance.residual);
}

/// Where the largest and smallest values of a state are, and its slope angle at the tip: what a derivative holds on to.
#[derive(Clone, Copy, Debug, Default)]
pub struct Extremes {
    high: usize,
    low: usize,
    closed: usize,
    angle: f64,
}

/// Of the state in the workspace.
pub fn extremes(system: &System, w: &Workspace<f64>) -> Extremes {
    let place = |values: &[f64], sign: f64| {
        let all = values.iter().enumerate();
        all.max_by(|a, b| (sign * a.1).total_cmp(&(sign * b.1)))
            .map_or(0, |(i, _)| i)
    };
    Extremes {
        high: place(&w.pressure, 1.0),
        low: place(&w.pressure, -1.0),
        closed: place(&w.area, -1.0),
        angle: tip_angle(system, w),
    }
}

/// What a [`row`] reads off a state after time and before the integrals, smooth in the state: largest and smallest values where
/// they are at `extremes`, the angle without full turns between. The workspace must hold [`ledger::complete`] of the state.
pub fn instantaneous(system: &System, now: &Instant, w: &Workspace<f64>, at: &Extremes, out: &mut [f64]) {
    let last = system.mesh.nodes - 1;
    let turn = std::f64::consts::TAU;
    let angle = tip_angle(system, w);
    let angle = angle - turn * ((angle - at.angle) / turn).round();
    let mut all = vec![w.u1[last], w.u3[last], angle];
    if let Some(wet) = &system.model.wet {
        let opening = 1.0 + w.area[at.closed] / wet.area_at_rest;
        all.extend([
            w.pressure[at.high],
            w.pressure[at.low],
            turbine_power(system, now, w),
            opening,
        ]);
    }
    let e = ledger::energies(system, now, w);
    all.extend([e.kinetic, e.rotary, e.axial, e.bending, e.bladders]);
    out.copy_from_slice(&all);
}

/// `φ` of the tip, followed along the beam so that full turns count.
pub(super) fn tip_angle(system: &System, w: &Workspace<f64>) -> f64 {
    let last = system.mesh.nodes - 1;
    let interior: f64 = w.kappa[1..last].iter().sum();
    let first = match system.model.kinematics {
        Kinematics::Bar | Kinematics::FiniteRotation => w.tx[0].atan2(w.tz[0]),
        Kinematics::Linear | Kinematics::SmallRotation => w.d3x[0],
    };
    first - system.mesh.h * (interior + 0.5 * w.kappa[last])
}

fn turbine_power(system: &System, now: &Instant, w: &Workspace<f64>) -> f64 {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return 0.0;
    };
    let mut power = 0.0;
    for (link, &conductance) in fluid.links.iter().zip(&now.conductance) {
        if matches!(link.kind, LinkKind::Turbine(_)) {
            let q = conductance * (pressure_at(link.from, now, w) - pressure_at(link.to, now, w));
            power += q * q * link.resistance;
        }
    }
    for (bridge, drop) in fluid.bridges.iter().zip(&w.bridge) {
        let turbine = wet.network.bridges[bridge.number].turbine;
        power += wet.network.turbines[turbine].conductance * drop * drop;
    }
    power
}

/// Largest flow through a tube [m^3/s], its rate as far as bladders and ports make it, and the tube's number among the tubes.
pub fn largest_flow(system: &System, now: &Instant, w: &Workspace<f64>) -> Option<(f64, f64, usize)> {
    let (wet, fluid) = (system.model.wet.as_ref()?, system.fluid.as_ref()?);
    let tubes = fluid
        .links
        .iter()
        .zip(&now.conductance)
        .filter(|(link, _)| link.kind == LinkKind::Tube);
    let (q, link, g) = tubes
        .map(|(link, g)| {
            let drop = pressure_at(link.from, now, w) - pressure_at(link.to, now, w);
            (g * drop, link, g)
        })
        .reduce(|a, b| if b.0.abs() > a.0.abs() { b } else { a })?;
    let rate = |place: Place| match place {
        Place::Cell(cell) => ledger::pressure_rate(wet, fluid, w, cell),
        Place::Port(port) => now.port_pressure_rate[port],
        Place::Junction(_) => 0.0,
    };
    let before = wet.network.links[..link.number]
        .iter()
        .filter(|l| l.kind == LinkKind::Tube);
    let rate = q.signum() * g * (rate(link.from) - rate(link.to));
    Some((q.abs(), rate, before.count()))
}

/// Smallest `(h_b w_b + a1)/(h_b w_b)`.
pub fn least_opening(system: &System, w: &Workspace<f64>) -> f64 {
    let Some(wet) = &system.model.wet else { return 1.0 };
    let least = w.area.iter().copied().fold(f64::INFINITY, f64::min);
    1.0 + least / wet.area_at_rest
}

/// Largest strain of a fibre, `|λ - 1| + |κ| h_s/2`, and the node where it is.
pub fn largest_strain(system: &System, half_height: f64, w: &Workspace<f64>) -> (f64, usize) {
    let last = system.mesh.nodes - 1;
    (0..=last)
        .map(|i| {
            (
                (node_stretch(w, i, last) - 1.0).abs() + w.kappa[i].abs() * half_height,
                i,
            )
        })
        .fold((0.0, 0), |a, b| if b.0 > a.0 { b } else { a })
}

/// A coordinate: array name, unit, one sentence, values.
pub type AxisText = (&'static str, &'static str, &'static str, Vec<f64>);

/// Coordinates of the fields.
pub fn axes(system: &System, tube_length: f64) -> Vec<AxisText> {
    let mesh = &system.mesh;
    let mut all = vec![
        (
            "theta_node_m",
            "m",
            "material coordinate of the nodes",
            (0..mesh.nodes).map(|i| mesh.node_coordinate(i)).collect(),
        ),
        (
            "theta_cell_m",
            "m",
            "material coordinate of the cells' midpoints",
            (0..mesh.cells).map(|c| mesh.cell_coordinate(c)).collect(),
        ),
    ];
    if let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) {
        let k = fluid.cells_per_bladder;
        let map = NetworkCoordinate::new(
            &wet.network,
            wet.per_row,
            wet.bladder_length,
            TABLE_TUBE_RATIO * tube_length,
        );
        let order = cell_order(system, &map);
        let x = |cell: usize| {
            let (start, end) = map.spans[cell / k];
            start + (end - start) * ((cell % k) as f64 + 0.5) / k as f64
        };
        let array_of = |bladder: usize| map.arrays.iter().position(|a| a.contains(&bladder)).unwrap_or(0) as f64;
        all.push((
            "x_f",
            "1",
            "network coordinate of the bladder cells, array by array",
            order.iter().map(|&c| x(c)).collect(),
        ));
        all.push((
            "bladder",
            "1",
            "bladder index R j of each cell along x_f",
            order
                .iter()
                .map(|&c| bladder_label(c / k, wet.per_row) as f64)
                .collect(),
        ));
        all.push((
            "array",
            "1",
            "number of the connected array of each cell along x_f",
            order.iter().map(|&c| array_of(c / k)).collect(),
        ));
    }
    all
}

/// Cells in the order of `X_f`.
pub fn cell_order(system: &System, map: &NetworkCoordinate) -> Vec<usize> {
    let Some(fluid) = &system.fluid else { return vec![] };
    map.arrays
        .iter()
        .flatten()
        .flat_map(|&bladder| fluid.cells_of(bladder))
        .collect()
}
