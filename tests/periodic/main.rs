//! Steady cycles: shooting, stability, cycles of several periods, and their commands.

mod branch;
mod command;
mod floquet;
mod shooting;
mod subharmonic;
