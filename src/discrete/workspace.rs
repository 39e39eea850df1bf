//! Intermediate quantities of one evaluation, stage by stage; allocated once, for each scalar type.

use super::System;
use super::cell_boxes::CellBoxes;
use super::joints::JointMotion;
use super::readings::FourthOrderReadings;
use super::residual::fourth_order;
use crate::model::Kinematics;
use crate::numerics::{Planar, Scalar};

/// Intermediate quantities of an evaluation, in the order of their computation. Names follow the equations.
#[derive(Clone, Debug)]
pub struct Workspace<T> {
    /// Output values that differ from those of the equations.
    pub readings: FourthOrderReadings,
    /// Motion of the nodes.
    pub motion: Motion<T>,
    /// Curvature and stretch of the beam.
    pub shape: BeamShape<T>,
    /// Relaxed strains of the solid.
    pub relaxed: Relaxed<T>,
    /// Section forces.
    pub forces: Forces<T>,
    /// Coupling variables of beam and bladders.
    pub coupling: CouplingVariables<T>,
    /// Pressures and flows.
    pub fluid: FluidState<T>,
}

/// Motion of nodes.
#[derive(Clone, Debug)]
pub struct Motion<T> {
    /// Displacements.
    pub u: Vec<Planar<T>>,
    /// Velocities.
    pub v: Vec<Planar<T>>,
    /// Accelerations (zero in a quasi-static solid).
    pub a: Vec<Planar<T>>,
}

/// Shape of the beam: curvatures at nodes, all others in cells.
#[derive(Clone, Debug)]
pub struct BeamShape<T> {
    /// Director `d3 = (x', z')`.
    pub d3: Vec<Planar<T>>,
    /// `lambda`.
    pub stretch: Vec<T>,
    /// Inverse stretch `1/lambda`, for finite rotations.
    pub per_stretch: Vec<T>,
    /// `lambda - 1`, without cancellation.
    pub strain: Vec<T>,
    /// Unit tangent `e_t` of the beam's line.
    pub tangent: Vec<Planar<T>>,
    /// `d lambda/dt`.
    pub stretch_rate: Vec<T>,
    /// `d phi/dt`, or `d theta/dt` if sections shear.
    pub angle_rate: Vec<T>,
    /// Curvature `kappa` [1/m].
    pub kappa: Vec<T>,
    /// Curvature of the left and the right side of nodes where neutral axes jump [1/m].
    pub side_curvature: Vec<[T; 2]>,
    /// `d kappa/dt` [1/(m s)].
    pub kappa_rate: Vec<T>,
    /// Rotation of the joints of a structure.
    pub joints: JointMotion<T>,
    /// Rotation of sections that shear.
    pub sections: Sections<T>,
}

/// Sections of cells that shear; empty if sections remain perpendicular to the beam.
#[derive(Clone, Debug)]
pub struct Sections<T> {
    /// Section angles θ [rad].
    pub angle: Vec<T>,
    /// `d²θ/dt²` [rad/s^2], with rotary inertia.
    pub acceleration: Vec<T>,
    /// Section normals `(sin θ, cos θ)`.
    pub normal: Vec<Planar<T>>,
    /// Shear strain γ.
    pub shear: Vec<T>,
    /// `d gamma/dt` [1/s], from the ends of cells.
    pub shear_rate: Vec<T>,
    /// `(d3·e_n, d3·e_t)` if it differs from (γ, 1 + ε), [E79]; otherwise empty.
    pub line: Vec<Planar<T>>,
}

/// Relaxed strains of all branches, one branch after the other; empty without relaxation.
#[derive(Clone, Debug)]
pub struct Relaxed<T> {
    /// Curvatures `κ_k` of nodes [1/m].
    pub curvature: Vec<T>,
    /// Rates of these curvatures [1/(m s)].
    pub curvature_rate: Vec<T>,
    /// Stretches `ε_k` of cells.
    pub stretch: Vec<T>,
    /// Rates of these stretches [1/s].
    pub stretch_rate: Vec<T>,
    /// Shear strains `γ_k` of cells.
    pub shear: Vec<T>,
    /// Rates of these shear strains [1/s].
    pub shear_rate: Vec<T>,
}

/// Section forces: moments at nodes, forces in cells.
#[derive(Clone, Debug)]
pub struct Forces<T> {
    /// Elastic moment M [N m].
    pub moment: Vec<T>,
    /// Viscous part of the moment [N m].
    pub viscous_moment: Vec<T>,
    /// Elastic normal force N [N].
    pub normal: Vec<T>,
    /// Viscous part of the normal force [N].
    pub viscous_normal: Vec<T>,
    /// Shear force V [N].
    pub shear: Vec<T>,
    /// Viscous part of the shear force [N], on a fourth-order mesh; otherwise empty.
    pub viscous_shear: Vec<T>,
    /// Addition of [E79] to (V, N), or for small rotations to the transverse force [N]; empty without it.
    pub arc_section: Vec<Planar<T>>,
    /// Section force in lab axes [N].
    pub section: Vec<Planar<T>>,
    /// Additional node force of the published form, [E15] [N]; empty in the conservative form.
    pub formulation: Vec<Planar<T>>,
    /// Relaxing part of the moment [N m]; empty without relaxation.
    pub relaxing_moment: Vec<T>,
    /// Relaxing part of the normal force [N].
    pub relaxing_normal: Vec<T>,
    /// Relaxing part of the shear force [N].
    pub relaxing_shear: Vec<T>,
    /// Forces of beams on each other at nodes, elastic ones and those with losses [N]; empty without.
    pub between: Vec<[Planar<T>; 2]>,
    /// Places of nodes and boxes around cells, for contacts of beams.
    pub boxes: CellBoxes,
    /// Moment that rotates the section of each cell [N m]; empty without shear.
    pub turning: Vec<T>,
    /// Addition of the normal force to the moment in bent cells, [E79] [N m]; empty without it.
    pub arc_moment: Vec<T>,
    /// Moment of the normal forces about neutral axes beside the beam's line at nodes, [E89] [N m].
    pub offset_moment: Vec<T>,
    /// Moments about both neutral axes, left and right, at nodes where they jump [N m].
    pub side_moment: Vec<[T; 2]>,
    /// Addition to the moment by the section's energy at finite strain [N m]; empty without it.
    pub nonlinear_moment: Vec<T>,
    /// Addition to the normal force by the section's energy at finite strain [N].
    pub nonlinear_normal: Vec<T>,
}

/// Coupling variables of segments and bladders.
#[derive(Clone, Debug)]
pub struct CouplingVariables<T> {
    /// Mean moment.
    pub mean_moment: Vec<T>,
    /// Mean force.
    pub mean_force: Vec<T>,
    /// Rate of the mean moment, for the balances.
    pub mean_moment_rate: Vec<T>,
    /// Rate of the mean force, for the balances.
    pub mean_force_rate: Vec<T>,
    /// `lambda_p`.
    pub pressure_stretch: Vec<T>,
    /// `alpha_p`.
    pub pressure_curvature: Vec<T>,
    /// Area changes of bladders by finite strain and by the pressure of the other bladder, as unknowns [m^2]; empty without them.
    pub excess_area: Vec<T>,
    /// Rates of these area changes [m^2/s], for the balances.
    pub excess_area_rate: Vec<T>,
    /// Area changes of bladders by the section's energy at finite strain [m^2].
    pub nonlinear_area: Vec<T>,
    /// Integral of the section's energy at finite strain over each segment [J].
    pub nonlinear_energy: Vec<T>,
}

/// State of the cells of bladders and of the network.
#[derive(Clone, Debug)]
pub struct FluidState<T> {
    /// Content of cells per length at ambient density [m^2]: their area changes, unless the fluid is compressible.
    pub area: Vec<T>,
    /// Rates of the contents [m^2/s].
    pub area_rate: Vec<T>,
    /// Area changes of cells if the fluid is compressible [m^2]; otherwise empty.
    pub swelling: Vec<T>,
    /// Potential Ψ of the flow from cells if the fluid is compressible [Pa], [E55]; otherwise empty.
    pub potential: Vec<T>,
    /// Pressures of cells [Pa].
    pub pressure: Vec<T>,
    /// Mean pressures of bladders [Pa].
    pub mean_pressure: Vec<T>,
    /// Pressures of junctions [Pa].
    pub junction: Vec<T>,
    /// Volumes in accumulators [m^3].
    pub accumulated: Vec<T>,
    /// Rates of these volumes [m^3/s].
    pub accumulated_rate: Vec<T>,
    /// Pressures of lumped networks [Pa].
    pub lumped: Vec<T>,
    /// Rates of these pressures [Pa/s], for the balances.
    pub lumped_rate: Vec<T>,
    /// Pressure drops of turbines behind bridges of check valves [Pa].
    pub bridge: Vec<T>,
    /// Pressure drop over each link, that of [E64] if the fluid is compressible [Pa].
    pub drop: Vec<T>,
    /// Mean density along each link relative to ambient density, [E64]; empty if the fluid is incompressible.
    pub density: Vec<T>,
    /// Flow of each link, positive towards its end, at ambient density [m^3/s].
    pub flow: Vec<T>,
    /// Flows that are unknowns, divided by the square root of the mean density [m^3/s].
    pub moving: Vec<T>,
    /// Rates of these flows [m^3/s^2].
    pub moving_rate: Vec<T>,
    /// Flows of their friction branches [m^3/s].
    pub branch: Vec<T>,
    /// Rates of the branch flows [m^3/s^2].
    pub branch_rate: Vec<T>,
    /// Net inflow of each cell [m^3/s].
    pub inflow: Vec<T>,
    /// Net inflow of each junction [m^3/s].
    pub junction_inflow: Vec<T>,
    /// Inflow of each component of the network that is not stored: the remaining error of Newton's iteration [m^3/s].
    pub volume_defect: Vec<T>,
    /// Total conductance of each component's links to pressure ports [m^3/(s Pa)].
    pub port_conductance: Vec<T>,
}

/// A workspace with the complete state for balances and samples, including rates that appear in no equation. Only
/// [`super::ledger::complete`] and [`super::ledger::complete_after_flows`] create one.
#[derive(Clone, Copy, Debug)]
pub struct CompleteState<'w>(pub(super) &'w Workspace<f64>);

impl std::ops::Deref for CompleteState<'_> {
    type Target = Workspace<f64>;
    fn deref(&self) -> &Workspace<f64> {
        self.0
    }
}

impl<T: Scalar> FluidState<T> {
    /// Converts a flow along a link from ambient density to the link's mean density [m^3/s].
    #[inline]
    pub fn at_mean_density(&self, link: usize, flow: T) -> T {
        self.density.get(link).map_or(flow, |density| flow / *density)
    }

    /// Converts a volume flow along a link from the link's mean density to ambient density [m^3/s].
    #[inline]
    pub fn at_ambient_density(&self, link: usize, volume: T) -> T {
        self.density.get(link).map_or(volume, |density| volume * *density)
    }

    /// Square root of the mean density along a link; none if the fluid is incompressible.
    #[inline]
    pub fn root_of_density(&self, link: usize) -> Option<T> {
        self.density.get(link).map(|density| density.sqrt())
    }
}

impl<T> CouplingVariables<T> {
    /// Strains by pressure: stretches of all segments, then curvatures.
    pub fn strains_mut(&mut self) -> impl Iterator<Item = &mut T> {
        self.pressure_stretch.iter_mut().chain(&mut self.pressure_curvature)
    }

    /// Strain by pressure of index `k` in the order of `strains_mut`.
    pub fn strain_mut(&mut self, k: usize) -> &mut T {
        match k.checked_sub(self.pressure_stretch.len()) {
            None => &mut self.pressure_stretch[k],
            Some(k) => &mut self.pressure_curvature[k],
        }
    }
}

impl<T: Scalar> Workspace<T> {
    /// Allocates a workspace for a system.
    pub fn new(system: &System) -> Self {
        let zeros = |n: usize| vec![T::zero(); n];
        let vectors = |n: usize| vec![Planar::zero(); n];
        let (n, c) = (system.mesh.nodes, system.mesh.cells);
        let s = system.fluid.as_ref().map_or(0, |fluid| fluid.bladders / 2);
        let relaxation = &system.layout.relaxation;
        let sheared = system.layout.turning.angle.len();
        let bent = fourth_order::bends_its_cells(system);
        let finite = system.model.kinematics == Kinematics::FiniteRotation;
        let fluid = system.fluid.as_ref();
        let (cells, bladders) = fluid.map_or((0, 0), |f| (f.cells, f.bladders));
        let (junctions, bridges) = fluid.map_or((0, 0), |f| (f.junctions.len(), f.bridges.len()));
        let (accumulators, links) = fluid.map_or((0, 0), |f| (f.accumulators.len(), f.links.len()));
        let components = system.model.wet.as_ref().map_or(0, |w| w.network.components);
        let lumped = fluid.map_or(0, |f| f.volume_at_start.len());
        let wet = system.model.wet.as_ref();
        let compressed = usize::from(wet.is_some_and(|wet| wet.compression.is_some()));
        let nonlinear = usize::from(system.model.strain_energy().is_some());
        let excess = usize::from(!system.layout.coupling.excess_area.is_empty());
        let touching = if system.beam_contacts.is_empty() { 0 } else { n };
        let viscous = usize::from(system.mesh.fourth && system.damped) * sheared;
        // Constant values are set here.
        let kept = fluid.map_or(&[][..], |f| &f.area_at_start);
        Self {
            readings: FourthOrderReadings::new(system),
            motion: Motion {
                u: vectors(n),
                v: vectors(n),
                a: vectors(n),
            },
            shape: BeamShape {
                d3: vectors(c),
                stretch: vec![T::constant(1.0); c],
                per_stretch: vec![T::constant(1.0); c],
                strain: zeros(c),
                tangent: vec![Planar::constant(Planar { x: 0.0, z: 1.0 }); c],
                stretch_rate: zeros(c),
                angle_rate: zeros(c),
                kappa: zeros(n),
                side_curvature: vec![[T::zero(); 2]; system.sections.offset_borders.len()],
                kappa_rate: zeros(n),
                joints: JointMotion::new(&system.joints),
                sections: Sections {
                    angle: zeros(sheared),
                    acceleration: zeros(sheared),
                    normal: vectors(sheared),
                    shear: zeros(sheared),
                    shear_rate: zeros(sheared),
                    line: vectors(if bent && finite { sheared } else { 0 }),
                },
            },
            relaxed: Relaxed {
                curvature: zeros(relaxation.curvature.len()),
                curvature_rate: zeros(relaxation.curvature.len()),
                stretch: zeros(relaxation.stretch.len()),
                stretch_rate: zeros(relaxation.stretch.len()),
                shear: zeros(relaxation.shear.len()),
                shear_rate: zeros(relaxation.shear.len()),
            },
            forces: Forces {
                moment: zeros(n),
                viscous_moment: zeros(n),
                normal: zeros(c),
                viscous_normal: zeros(c),
                shear: zeros(c),
                viscous_shear: zeros(viscous),
                arc_section: vectors(if bent { sheared } else { 0 }),
                section: vectors(c),
                formulation: vectors(if system.model.published() { n } else { 0 }),
                relaxing_moment: zeros(relaxation.curvature.len().min(n)),
                relaxing_normal: zeros(relaxation.stretch.len().min(c)),
                relaxing_shear: zeros(relaxation.shear.len().min(c)),
                between: vec![[Planar::zero(); 2]; touching],
                boxes: CellBoxes::new(system),
                turning: zeros(sheared),
                arc_moment: zeros(if bent { n } else { 0 }),
                side_moment: vec![[T::zero(); 2]; system.sections.offset_borders.len()],
                offset_moment: zeros(if system.sections.offset.is_empty() { 0 } else { n }),
                nonlinear_moment: zeros(nonlinear * n),
                nonlinear_normal: zeros(nonlinear * c),
            },
            coupling: CouplingVariables {
                mean_moment: zeros(s),
                mean_force: zeros(s),
                mean_moment_rate: zeros(s),
                mean_force_rate: zeros(s),
                pressure_stretch: zeros(s),
                pressure_curvature: zeros(s),
                excess_area: zeros(excess * bladders),
                excess_area_rate: zeros(excess * bladders),
                nonlinear_area: zeros(nonlinear * bladders),
                nonlinear_energy: zeros(nonlinear * s),
            },
            fluid: FluidState {
                area: kept.iter().map(|&a| T::constant(a)).collect(),
                area_rate: zeros(cells),
                swelling: zeros(compressed * cells),
                potential: zeros(compressed * cells),
                pressure: zeros(cells),
                mean_pressure: zeros(bladders),
                junction: zeros(junctions),
                accumulated: zeros(accumulators),
                accumulated_rate: zeros(accumulators),
                lumped: zeros(lumped),
                lumped_rate: zeros(lumped),
                bridge: zeros(bridges),
                drop: zeros(links),
                density: zeros(compressed * links),
                flow: zeros(links),
                moving: zeros(fluid.map_or(0, |f| f.flows)),
                moving_rate: zeros(fluid.map_or(0, |f| f.flows)),
                branch: zeros(fluid.map_or(0, |f| f.branches)),
                branch_rate: zeros(fluid.map_or(0, |f| f.branches)),
                inflow: zeros(cells),
                junction_inflow: zeros(junctions),
                volume_defect: zeros(components),
                port_conductance: zeros(components),
            },
        }
    }
}
