//! Numbers that are sought: derivatives of cycles, and `slcbeam optimize`.

mod best;
mod common;
mod cycles;
mod flat;
mod refused;
mod wirings;
