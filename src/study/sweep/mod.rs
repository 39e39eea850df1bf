//! Many designs of a case, one row each: grids, lists, ranges, samples.
//!
//! ```text
//! vary     POINTER=SPEC: the values of one number
//! table    designs from a CSV file
//! designs  which values design number k has, and its case
//! plan     everything that decides what the rows are
//! row      figures of a design
//! unit     units of figures, by their names
//! exchanged modes that change places from one design to the next
//! pool     designs on all cores
//! ```
//!
//! A design is known by its number alone, and what it computes by its case: rows depend neither on how many are computed at once
//! nor on which came first.

pub mod designs;
pub mod exchanged;
pub mod plan;
pub mod pool;
pub mod row;
pub mod table;
pub mod unit;
pub mod vary;

pub use designs::{Design, Designs};
pub use plan::{Plan, Shard};
pub use row::Row;
pub use vary::{Draw, Vary};
