//! Steady cycles: shooting, stability, cycles of several periods, and their commands.

mod backbone;
mod branch;
mod command;
mod floquet;
mod harmonic;
mod relaxation_oscillator;
mod self_oscillation;
mod shooting;
mod subharmonic;
