//! Sensitivities along runs against differences of complete runs, exact identities, and what is refused.

mod common;
mod exact;
mod limits;
mod runs;
