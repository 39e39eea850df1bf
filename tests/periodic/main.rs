//! Steady cycles: found by shooting, whether they hold, those of several periods, and the commands that look for them.

mod command;
mod floquet;
mod shooting;
mod subharmonic;
