//! `slcbeam sweep` and `slcbeam merge` from outside: what is computed, what is kept, what is refused.
//!
//! Goal: the table depends on the designs alone, not on how many are computed at once, nor on kills, nor on shards. Nothing here
//! has a tolerance: tables are equal byte for byte but for wall times, or they are not.

mod cluster;
mod common;
mod going_on;
mod large;
mod neighbours;
mod refused;
mod rows;
