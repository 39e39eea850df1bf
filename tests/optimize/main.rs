//! Numbers that are sought: derivatives of cycles, and `slcbeam optimize`.

#[path = "../common/program.rs"]
mod program;

mod best;
mod common;
mod cycles;
mod flat;
mod refused;
mod responses;
mod rugged;
mod stress;
mod wirings;
