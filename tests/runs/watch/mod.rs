//! Quantities monitored between output times: extrema, limits of the model, balances, growth.

mod balances;
mod common;
mod energies;
mod growth;
mod motion;
mod range;
mod strides;
mod window;
