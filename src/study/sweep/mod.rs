//! Many designs of a case, one row each: grids, lists, ranges, samples.
//!
//! ```text
//! vary       POINTER=SPEC: the values of one number
//! table      designs from a CSV file
//! designs    values and case of each design, by its number
//! plan       all settings that determine the rows
//! row        figures of a design
//! unit       units of figures, by their names
//! exchanged  modes that change places between designs
//! pool       parallel computation of designs
//! ```
//!
//! The number of a design alone determines the design, and its case alone determines its results. Rows depend neither
//! on the number of parallel computations nor on their order.

pub mod designs;
pub mod exchanged;
pub mod plan;
pub mod pool;
pub mod row;
pub mod table;
pub mod unit;
pub mod vary;

pub use designs::{Design, Designs};
pub use plan::{Shard, SweepPlan};
pub use row::SweepRow;
pub use vary::{Draw, VariedNumber};
