//! Evaluation of quantities of a state.

use crate::discrete::angle_unwrapping::{nearest, tip_angle};
use crate::discrete::extrema::Moving;
use crate::discrete::fluid_mesh::{LinkEnd, MeshLink};
use crate::discrete::ledger::{self, StoredEnergies};
use crate::discrete::residual::fluid::pressure_at;
use crate::discrete::residual::solid::node_stretch;
use crate::discrete::{CompleteState, System, TimeData, Workspace};
use crate::model::network::LinkKind;

/// Positions of the largest and smallest values of a state, and its slope angle at the tip; kept fixed for derivatives.
#[derive(Clone, Copy, Debug, Default)]
pub struct Extremes {
    high: usize,
    low: usize,
    closed: usize,
    angle: f64,
}

impl Extremes {
    /// Extremes of the state in the workspace.
    pub fn new(system: &System, now: &TimeData, w: &Workspace<f64>) -> Self {
        let there = |cell: &usize| system.has_cell(*cell);
        let place = |values: &[f64], sign: f64| {
            let all = values.iter().enumerate().filter(|(cell, _)| there(cell));
            all.max_by(|a, b| (sign * a.1).total_cmp(&(sign * b.1)))
                .map_or(0, |(i, _)| i)
        };
        Self {
            high: place(w.fluid.pressures(), 1.0),
            low: place(w.fluid.pressures(), -1.0),
            closed: system.most_closed(w.fluid.area_changes()),
            angle: tip_angle(system, now, w, system.first_tip()),
        }
    }
}

/// A state to be evaluated.
#[derive(Clone, Copy, Debug)]
pub struct StateView<'a> {
    /// Model and mesh.
    pub system: &'a System,
    /// Time data of the state.
    pub now: &'a TimeData,
    /// The state.
    pub w: CompleteState<'a>,
    /// Stored energies.
    pub stored: StoredEnergies,
    /// Positions at which extreme values are read.
    pub at: Extremes,
}

impl<'a> StateView<'a> {
    /// Creates the evaluation of a state with these energies, at its own extremes.
    pub fn new(system: &'a System, now: &'a TimeData, w: CompleteState<'a>, stored: StoredEnergies) -> Self {
        let at = Extremes::new(system, now, &w);
        Self {
            system,
            now,
            w,
            stored,
            at,
        }
    }
}

impl StateView<'_> {
    fn tip(&self) -> usize {
        self.system.mesh.beams[self.system.first_tip()].nodes.end - 1
    }

    pub(super) fn tip_u1(&self) -> f64 {
        self.w.motion.u[self.tip()].x
    }

    pub(super) fn tip_u3(&self) -> f64 {
        self.w.motion.u[self.tip()].z
    }

    /// Angle of the tip, unwrapped to the fixed reference angle.
    pub(super) fn tip_angle(&self) -> f64 {
        nearest(
            tip_angle(self.system, self.now, &self.w, self.system.first_tip()),
            self.at.angle,
        )
    }

    pub(super) fn max_pressure(&self) -> f64 {
        self.w.fluid.pressures().get(self.at.high).copied().unwrap_or(0.0)
    }

    pub(super) fn min_pressure(&self) -> f64 {
        self.w.fluid.pressures().get(self.at.low).copied().unwrap_or(0.0)
    }

    /// Least relative opening of a bladder, `(h_b w_b + a1)/(h_b w_b)`.
    pub(super) fn least_opening(&self) -> f64 {
        let cell = self.at.closed;
        let areas = self.w.fluid.area_changes();
        areas
            .get(cell)
            .map_or(1.0, |area| 1.0 + area / self.system.area_at_rest(cell))
    }

    /// Turbine power: `Σ R q²` of turbines between bladders, `Σ g Δp²` of those in bridges.
    pub(super) fn turbine_power(&self) -> f64 {
        let Self { system, w, .. } = *self;
        let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
            return 0.0;
        };
        let mut power = 0.0;
        for (k, (link, &q)) in fluid.links.iter().zip(&w.fluid.flow).enumerate() {
            if matches!(link.kind, Some(LinkKind::Turbine(_))) {
                let volume = w.fluid.at_mean_density(k, q);
                power += volume * volume * link.resistance;
            }
        }
        for (bridge, drop) in fluid.bridges.iter().zip(&w.fluid.bridge) {
            let turbine = wet.network.bridges[bridge.number].turbine;
            power += wet.network.turbines[turbine].conductance * drop * drop;
        }
        power
    }
}

/// Largest `|q|/r` of a tube, r its radius [m^2/s]; times `2 ρ_0/(π μ)` it is the Reynolds number.
pub fn largest_flow(system: &System, now: &TimeData, w: &Workspace<f64>) -> Option<(Moving, usize)> {
    largest_in_tubes(system, now, w, |_, radius| radius.recip())
}

/// Largest `|q| √r'/(r A)` of a tube, r the density over `ρ_0` at the end of lowest density, A the cross-section [m/(s Pa^(1/2))]. Times
/// `√ρ_0` it is the Mach number. None if the fluid is incompressible.
pub fn largest_mach(system: &System, now: &TimeData, w: &Workspace<f64>) -> Option<(Moving, usize)> {
    let compression = system.model.wet.as_ref()?.compression.as_ref()?;
    largest_in_tubes(system, now, w, |link, radius| {
        let [a, b] = [link.from, link.to].map(|place| pressure_at(place, now, w));
        let (density, slope) = compression.density(a.min(b));
        slope.sqrt() / (density * std::f64::consts::PI * radius * radius)
    })
}

/// Lowest pressure of junctions, accumulators, and ports that prescribe flow or volume [Pa], at most 0, and its index: junctions come
/// first.
pub fn thinnest(system: &System, now: &TimeData, w: &Workspace<f64>) -> (f64, usize) {
    let Some(wet) = system.model.wet.as_ref() else {
        return (0.0, 0);
    };
    let ports = wet.network.ports.len();
    let sources = now.source_flow.iter().enumerate();
    let sources = sources.map(|(source, &flow)| ledger::ports::pressure(system, now, w, ports + source, flow));
    let all = w.fluid.junction.iter().copied().chain(sources).enumerate();
    all.fold((0.0, 0), |least, (k, p)| if p < least.0 { (p, k) } else { least })
}

/// Flow times a factor (of link and radius), for the tube in which this is largest. Returns its magnitude with the rate caused by changes
/// of flow or of pressures in bladders and ports, and the number of the tube.
fn largest_in_tubes(
    system: &System,
    now: &TimeData,
    w: &Workspace<f64>,
    factor: impl Fn(&MeshLink, f64) -> f64,
) -> Option<(Moving, usize)> {
    let (wet, fluid) = (system.model.wet.as_ref()?, system.fluid.as_ref()?);
    let links = fluid.links.iter().zip(&now.conductance).zip(&w.fluid.flow);
    let tubes = links.filter_map(|((link, g), q)| {
        let number = link.number.filter(|_| link.kind == Some(LinkKind::Tube))?;
        let factor = factor(link, wet.network.links[number].radius);
        Some((factor * q, factor, link, g, number))
    });
    let (value, factor, link, g, number) = tubes.reduce(|a, b| if b.0.abs() > a.0.abs() { b } else { a })?;
    let density = |p: f64| wet.compression.as_ref().map_or(1.0, |c| c.density(p).0);
    let rate = |place: LinkEnd| match place {
        LinkEnd::Cell(cell) => density(w.fluid.pressure[cell]) * ledger::pressure_rate(wet, fluid, w, cell),
        LinkEnd::Port(port) => density(now.port_pressure[port]) * now.port_pressure_rate[port],
        LinkEnd::Junction(_) => 0.0,
    };
    let rate = match link.flow.filter(|flow| flow.law.inertance > 0.0) {
        Some(flow) => w.fluid.moving_rate[flow.number],
        None => g * (rate(link.from) - rate(link.to)),
    };
    let moving = [value.abs(), value.signum() * factor * rate];
    Some((moving, wet.network.tube(number)))
}

/// Largest strain of a fibre, `|λ - 1| + |κ| h_s/2`, κ relative to the rest curvature, and its node.
pub fn largest_strain(system: &System, now: &TimeData, w: &Workspace<f64>) -> (f64, usize) {
    let mesh = &system.mesh;
    (0..mesh.nodes)
        .map(|i| {
            (
                (node_stretch(mesh, w, i) - 1.0).abs()
                    + (w.curvature()[i] - now.rest_curvature(i)).abs() * system.sections.fiber_of_curvature[i],
                i,
            )
        })
        .fold((0.0, 0), |a, b| if b.0 > a.0 { b } else { a })
}
