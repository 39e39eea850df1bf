//! Modes of small motions: eigenvalues of pencils, physics of beams and bladders, and the command that prints them.

mod bands;
mod cli;
mod common;
mod exact_responses;
mod fourth;
mod gaps;
mod left_out;
mod physics;
mod power;
mod reduced;
mod response;
mod response_derivatives;
mod selection;
mod sizes;
mod small_cycles;
mod spectral;
