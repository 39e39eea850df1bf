//! Hard cases: every physically sensible case ends with a right answer or with a diagnosis and a remedy.
//!
//! Every test prints a line `case | steps | energy | volume | figures` for the table of `docs/stability.md`:
//!
//! ```text
//! cargo test --release --test stability -- --nocapture
//! SLCBEAM_FUZZ=2000 cargo test --release --test stability fuzz -- --nocapture
//! ```
//!
//! Bounds on work are in steps, not in wall time.

#[path = "../common/chance.rs"]
mod chance;
mod chooser;
mod fluid;
mod fuzz;
mod fuzz_case;
mod fuzz_text;
mod gas;
mod growth;
mod harness;
mod limits;
mod midpoint;
mod size;
mod solid;
