//! The program from outside: commands, streams, files and pages.

#[path = "../common/chance.rs"]
mod chance;
mod cli;
mod compare;
mod effects;
mod interruption;
mod journals;
mod names;
mod output;
mod plot;
#[path = "../common/program.rs"]
mod program;
mod repeated;
mod report;
mod signals;
mod study;
mod sweep;
mod swung;
mod text;
mod uncertain;
mod verify;
