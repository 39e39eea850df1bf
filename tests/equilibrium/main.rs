//! Equilibria along the load path: KINSOL, arc length, limit points, branches, steady networks, starts of runs, derivatives.

mod command;
mod common;
mod derivatives;
mod fluid;
mod paths;
mod stages;
mod trapped;
