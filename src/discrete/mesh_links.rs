//! Links, sources and vessels of a network on the mesh.

use super::time_data::TIGHT;
use super::{TimeData, Workspace};
use crate::model::network::{AccumulatorLaw, CheckValveLaw, FlowLaw, LinkKind, PumpCharacteristic, ValvePilot};
use crate::numerics::Scalar;

/// End of a link on the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LinkEnd {
    /// A cell; half of its resistance is in series.
    Cell(usize),
    /// An unknown junction pressure.
    Junction(usize),
    /// A prescribed pressure.
    Port(usize),
}

/// A link on the mesh.
#[derive(Clone, Debug)]
pub struct MeshLink {
    /// Number among the network's links; none for a face between cells.
    pub number: Option<usize>,
    /// Source of positive flow.
    pub from: LinkEnd,
    /// Destination of positive flow.
    pub to: LinkEnd,
    /// Resistance of the half cells at its ends [Pa s/m^3]; for a face the total resistance.
    pub half_cells: f64,
    /// Resistance in between, scaled by the opening of a valve [Pa s/m^3].
    pub resistance: f64,
    /// Resistance of the link's pump [Pa s/m^3].
    pub of_pump: f64,
    /// Number of the link's pump among all pumps.
    pub pump: Option<usize>,
    /// Characteristic of the link's pump; none for a linear pump.
    pub pump_curve: Option<PumpCharacteristic>,
    /// Hydrostatic pressure difference between its ends [Pa].
    pub head: f64,
    /// Check valve of the link.
    pub check_valve: Option<CheckValveLaw>,
    /// Kind of the link; none for a face between cells.
    pub kind: Option<LinkKind>,
    /// Vessel that opens the valve of the link.
    pub pilot: Option<MeshPilot>,
    /// Law of a flow that is not given by pressures alone.
    pub flow: Option<MeshFlow>,
}

impl LinkEnd {
    /// Bladder of a cell.
    pub(super) fn bladder(self, cells_per_bladder: usize) -> Option<usize> {
        match self {
            Self::Cell(cell) => Some(cell / cells_per_bladder),
            Self::Junction(_) | Self::Port(_) => None,
        }
    }
}

impl MeshLink {
    /// True if the link is only a resistance.
    pub fn is_plain(&self) -> bool {
        self.flow.is_none() && self.check_valve.is_none() && self.pump.is_none() && self.head == 0.0
    }

    /// Opening of the valve by signal and pilot.
    #[inline]
    pub fn opening<T: Scalar>(&self, now: &TimeData, w: &Workspace<T>, k: usize) -> T {
        let by_signal = T::constant(now.opening[k]);
        let Some(pilot) = &self.pilot else { return by_signal };
        let volume = w.fluid.accumulated[pilot.vessel];
        let volume = match &pilot.law {
            None => volume,
            Some(law) => w.fluid.junction[pilot.junction].lift(|p| (law.volume(p), law.compliance(p))),
        };
        let opening = by_signal * pilot.valve.opening(volume);
        match self.flow {
            None => opening,
            Some(_) => opening * (1.0 - TIGHT) + TIGHT,
        }
    }

    /// Conductance [m^3/(s Pa)], [E6], at the opening of the valve; k is the index of the link.
    #[inline]
    pub fn conductance<T: Scalar>(&self, now: &TimeData, w: &Workspace<T>, k: usize) -> T {
        match &self.pilot {
            None => T::constant(now.conductance[k]),
            Some(_) => {
                let opening = self.opening(now, w, k);
                opening / (opening * (self.half_cells + self.of_pump) + self.resistance)
            }
        }
    }

    /// Total resistance with open valves [Pa s/m^3].
    pub fn in_series(&self) -> f64 {
        self.half_cells + self.of_pump + self.resistance
    }
}

/// Vessel on the mesh that opens the valve of a link.
#[derive(Clone, Debug)]
pub struct MeshPilot {
    /// Index of the vessel among the accumulators of the mesh.
    pub vessel: usize,
    /// Its index among the junctions of the mesh.
    pub junction: usize,
    /// Its law if the fluid is compressible: its volume then follows from its pressure.
    pub law: Option<AccumulatorLaw>,
    /// Law of the valve.
    pub valve: ValvePilot,
}

/// A flow that is an unknown.
#[derive(Clone, Copy, Debug)]
pub struct MeshFlow {
    /// Number among the flows that are unknowns.
    pub number: usize,
    /// Number of its first friction branch among all.
    pub branch: usize,
    /// Law of the flow.
    pub law: FlowLaw,
}

/// A prescribed flow on the mesh.
#[derive(Clone, Copy, Debug)]
pub struct MeshSource {
    /// Number among the network's sources.
    pub number: usize,
    /// Cell or junction that it enters.
    pub into: LinkEnd,
    /// Resistance of the half cell behind the port [Pa s/m^3].
    pub half_cell: f64,
}

/// An accumulator on the mesh, or the storage of compressible fluid at a junction of tubes with inertia.
#[derive(Clone, Debug)]
pub struct MeshAccumulator {
    /// Number among the network's accumulators; none for a junction of tubes.
    pub number: Option<usize>,
    /// Its index among the junctions of the mesh.
    pub junction: usize,
    /// Component of the network to which it belongs.
    pub component: usize,
    /// Law of the accumulator.
    pub law: AccumulatorLaw,
}

/// A bridge on the mesh.
#[derive(Clone, Copy, Debug)]
pub struct MeshBridge {
    /// Number among the network's bridges.
    pub number: usize,
    /// One port.
    pub from: LinkEnd,
    /// The other.
    pub to: LinkEnd,
}
