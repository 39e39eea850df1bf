//! Numerical methods and solvers: alone, and with the beam.

mod blocks;
mod bounds;
mod corotation;
mod numerics;
mod onestep;
mod problems;
mod sundials;
