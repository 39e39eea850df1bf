//! Cases: what ships, what may be written, what is made of it, and how every fault is told.

#[path = "../common/chance.rs"]
mod chance;
mod comfort;
mod faults;
mod faulty;
mod materials;
mod measure;
mod mistakes;
mod origins;
#[path = "../common/program.rs"]
mod program;
mod robust;
mod rules;
mod scaling;
mod section;
mod shipped;
mod signals;
mod span_sections;
mod strength;
mod units;
