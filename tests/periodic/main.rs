//! Steady cycles: shooting, stability, cycles of several periods, and their commands.

mod backbone;
mod branch;
mod command;
mod floquet;
mod harmonic;
mod self_oscillation;
mod shooting;
mod subharmonic;
