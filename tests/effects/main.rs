//! Effects: what is left out is gone, what is left in is right, and what was left out was small.
//!
//! Every test prints what it measures; `cargo test --release --test effects -- --nocapture` reprints the numbers.

#[path = "../common/chance.rs"]
mod chance;
#[allow(dead_code)] // shared with the tests of physics
#[path = "../physics/common.rs"]
mod common;
#[path = "../differences/mod.rs"]
mod differences;

#[allow(dead_code)] // shared with the tests of stability
#[path = "../stability/fuzz_case.rs"]
mod fuzz_case;

mod choices;
mod coupling;
mod exact;
mod limits;
mod random;
mod refusals;
mod rotary;
mod rotation;
mod runs;
mod sizes;
mod stretch;
mod sudden;
mod undrained;
mod uniform;
mod waves;
