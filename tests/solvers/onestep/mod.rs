//! One-step methods: orders, stiffness, steps and stops, faults, and the beam through them.

mod beam;
mod faults;
mod orders;
mod simulator;
mod stepping;
mod tableau;
mod undamped;
