//! Intermediate quantities of one evaluation; allocated once, for each scalar type.

use super::System;
use crate::numerics::Scalar;

/// Arrays over nodes, cells, segments, bladders. Names follow the equations.
#[derive(Clone, Debug)]
pub struct Workspace<T> {
    // nodes
    /// Displacements.
    pub u1: Vec<T>,
    /// Displacements.
    pub u3: Vec<T>,
    /// Velocities.
    pub v1: Vec<T>,
    /// Velocities.
    pub v3: Vec<T>,
    /// Accelerations (zero in a quasi-static solid).
    pub a1: Vec<T>,
    /// Accelerations.
    pub a3: Vec<T>,
    /// Curvature `kappa` [1/m].
    pub kappa: Vec<T>,
    /// Elastic moment M [N m].
    pub moment: Vec<T>,
    /// Viscous part of the moment [N m].
    pub viscous_moment: Vec<T>,
    /// `d kappa/dt` [1/(m s)].
    pub kappa_rate: Vec<T>,
    // cells
    /// `x'`.
    pub d3x: Vec<T>,
    /// `z'`.
    pub d3z: Vec<T>,
    /// `lambda`.
    pub stretch: Vec<T>,
    /// `lambda - 1`, without cancellation.
    pub strain: Vec<T>,
    /// Unit tangent, x.
    pub tx: Vec<T>,
    /// Unit tangent, z.
    pub tz: Vec<T>,
    /// `d lambda/dt`.
    pub stretch_rate: Vec<T>,
    /// `d phi/dt`.
    pub angle_rate: Vec<T>,
    /// Elastic normal force N [N].
    pub force: Vec<T>,
    /// Viscous part of the normal force [N].
    pub viscous_force: Vec<T>,
    /// Shear force V [N].
    pub shear: Vec<T>,
    /// Section force in x [N].
    pub sx: Vec<T>,
    /// Section force in z [N].
    pub sz: Vec<T>,
    // segments
    /// Mean moment.
    pub mean_moment: Vec<T>,
    /// Mean force.
    pub mean_force: Vec<T>,
    /// Its rate; for the balances.
    pub mean_moment_rate: Vec<T>,
    /// Rate of the mean force; for the balances.
    pub mean_force_rate: Vec<T>,
    /// `lambda_p`.
    pub pressure_stretch: Vec<T>,
    /// `alpha_p`.
    pub pressure_curvature: Vec<T>,
    // fluid
    /// Area changes of cells [m^2].
    pub area: Vec<T>,
    /// Their rates [m^2/s].
    pub area_rate: Vec<T>,
    /// Pressures of cells [Pa].
    pub pressure: Vec<T>,
    /// Mean pressures of bladders [Pa].
    pub mean_pressure: Vec<T>,
    /// Pressures of junctions [Pa].
    pub junction: Vec<T>,
    /// Pressures of pools [Pa].
    pub pool: Vec<T>,
    /// Their rates [Pa/s]; for the balances.
    pub pool_rate: Vec<T>,
    /// Turbine drops behind real rectifiers [Pa].
    pub bridge: Vec<T>,
    /// Net inflow of each cell [m^3/s].
    pub inflow: Vec<T>,
    /// Net inflow of each junction [m^3/s].
    pub junction_inflow: Vec<T>,
    /// Inflow of each component of the network that is not stored: what Newton's iteration leaves over [m^3/s].
    pub volume_defect: Vec<T>,
    /// Conductance of each component's links to pressure ports, together [m^3/(s Pa)].
    pub port_conductance: Vec<T>,
}

impl<T: Scalar> Workspace<T> {
    /// Room for a system.
    pub fn new(system: &System) -> Self {
        let zeros = |n: usize| vec![T::zero(); n];
        let (n, c) = (system.mesh.nodes, system.mesh.cells);
        let s = if system.fluid.is_some() {
            system.mesh.segments
        } else {
            0
        };
        let fluid = system.fluid.as_ref();
        let (cells, bladders) = fluid.map_or((0, 0), |f| (f.cells, f.bladders));
        let (junctions, bridges) = fluid.map_or((0, 0), |f| (f.junctions.len(), f.bridges.len()));
        let components = system.model.wet.as_ref().map_or(0, |w| w.network.components);
        let pools = fluid.map_or(0, |f| f.volume_at_start.len());
        // What is the same at all times is set here, and stays.
        let kept = fluid.map_or(&[][..], |f| &f.area_at_start);
        Self {
            u1: zeros(n),
            u3: zeros(n),
            v1: zeros(n),
            v3: zeros(n),
            a1: zeros(n),
            a3: zeros(n),
            kappa: zeros(n),
            moment: zeros(n),
            viscous_moment: zeros(n),
            kappa_rate: zeros(n),
            d3x: zeros(c),
            d3z: zeros(c),
            stretch: vec![T::constant(1.0); c],
            strain: zeros(c),
            tx: zeros(c),
            tz: vec![T::constant(1.0); c],
            stretch_rate: zeros(c),
            angle_rate: zeros(c),
            force: zeros(c),
            viscous_force: zeros(c),
            shear: zeros(c),
            sx: zeros(c),
            sz: zeros(c),
            mean_moment: zeros(s),
            mean_force: zeros(s),
            mean_moment_rate: zeros(s),
            mean_force_rate: zeros(s),
            pressure_stretch: zeros(s),
            pressure_curvature: zeros(s),
            area: kept.iter().map(|&a| T::constant(a)).collect(),
            area_rate: zeros(cells),
            pressure: zeros(cells),
            mean_pressure: zeros(bladders),
            junction: zeros(junctions),
            pool: zeros(pools),
            pool_rate: zeros(pools),
            bridge: zeros(bridges),
            inflow: zeros(cells),
            junction_inflow: zeros(junctions),
            volume_defect: zeros(components),
            port_conductance: zeros(components),
        }
    }
}
