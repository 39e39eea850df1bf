//! Mathematics and solvers that know nothing of beams, and the beam through them.

mod blocks;
mod bounds;
mod corotation;
mod numerics;
mod onestep;
mod problems;
mod sundials;
