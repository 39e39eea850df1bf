//! Measured data: a table of numbers and what of a simulation its columns are.
//!
//! ```text
//! table     a CSV file: one line of headings, then numbers
//! matching  COLUMN=QUANTITY[@PLACE]: a column beside a column of a result
//! places    where along the beam and the network a quantity is
//! ```

pub mod matching;
pub mod places;
pub mod table;

pub use matching::{Match, Matched};
pub use table::Table;
