//! Physics tests: the model against closed forms, conserved quantities, and the numbers of `docs/exact-results.md`.
//!
//! Every test prints its measurements; `cargo test --release --test physics -- --nocapture` shows the numbers.

mod balances;
mod common;
mod convergence;
mod flight;
mod harvester;
mod ledger;
mod loads;
mod mapping;
mod meshes;
mod networks;
mod numbers;
mod resolution;
mod statics;
mod valves;
mod wiring;
