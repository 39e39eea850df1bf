//! The beam as a sensor: loads from pressures.

mod any_shape;
mod command;
mod common;
mod coverage;
mod doubts;
mod over_time;
mod rest;
