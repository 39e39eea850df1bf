//! What a run watches on its way, not only at its output times: largest values, limits of the model, balances, growth.

mod balances;
mod common;
mod energies;
mod growth;
mod motion;
mod range;
mod strides;
mod window;
