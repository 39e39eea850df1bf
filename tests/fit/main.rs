//! `slcbeam fit` and `slcbeam compare RUN DATA.csv`: numbers of a case from measured values.
//!
//! Goal: what made the data is found again, within intervals that hold it as often as they say; what data do not tell is named; what does
//! not fit together is told before anything is computed. Data are made by the program itself with noise drawn by SplitMix64 and the normal
//! quantile, so that every run of a test has the same.

#[path = "../common/program.rs"]
mod program;

mod beside;
mod common;
mod found;
mod refused;
mod responses;
mod runs;
mod unseen;
mod volumes;
