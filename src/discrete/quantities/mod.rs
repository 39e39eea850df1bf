//! Output quantities of a run: tables of quantities over time, quantities of interest, and fields.
//!
//! ```text
//! observables  over time: the columns of the history, from which its derivatives, pictures, comparisons and the energy balance follow
//! interest     in the end: the quantities of the summary
//! fields       along the beam and the network, with their axes
//! column       name, unit and description of a column
//! probes       over time, at places that the case names
//! stations     over time, at ports, in accumulators and at walls
//! placed_nodes places of the nodes of a structure
//! reactions    over time, of what holds the beam
//! evaluate     how a state is read
//! row          the values of all of them at one instant
//! ```
//!
//! A quantity is added by a row of its table, which alone defines its name, unit, place in reports and evaluation; a test compares
//! `docs/data.md` with the tables.

mod column;
pub mod evaluate;
pub mod fields;
pub mod interest;
pub mod observables;
mod placed_nodes;
pub mod probes;
mod reactions;
pub mod row;
pub mod stations;

pub use evaluate::{Extremes, StateView};
pub use fields::{BeamField, FieldAxis};
pub use interest::{Interest, InterestSource};
pub use observables::{Group, Observable, QuantityRole, QuantitySource};
pub use placed_nodes::PlacedNodes;
pub use probes::MeshProbe;
pub use row::ObservableRow;
