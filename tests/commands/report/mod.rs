//! `slcbeam report`: the pages, opened and used in a real browser.

mod browser;
mod common;
mod downloads;
mod folders;
mod kinds;
mod run;
mod structure;
