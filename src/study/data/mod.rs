//! Measured data: a table of numbers, and the assignment of its columns to quantities of a simulation.
//!
//! ```text
//! table     a CSV file: one line of headings, then numbers
//! matching  COLUMN=QUANTITY[@PLACE]: assigns a column to a column of a result
//! places    positions of quantities along the beam and in the network
//! ```

pub mod matching;
pub mod places;
pub mod table;

pub use matching::{Match, Matched};
pub use table::DataTable;
