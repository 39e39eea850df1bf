//! slcbeam's integrators and alternative ones on the same equations.
//!
//! [`scene`] defines the equations, initial states and readings; [`own`], [`other`] and [`radau`] solve them; [`abi`] exports them to C,
//! [`export`] to Python. [`prices`] and [`floor`] measure single operations and large systems.

pub mod abi;
pub mod chains;
pub mod export;
pub mod floor;
pub mod other;
pub mod own;
pub mod prices;
pub mod radau;
pub mod random;
pub mod scene;
