//! Attacks on what is written and read: kills at every system call, full and failing disks, flipped bits, two programs at once,
//! folders of others. Goal: nothing lost, nothing taken, nothing half said; `docs/reliability.md`.

mod chains;
#[path = "../common/chance.rs"]
mod chance;
mod finishing;
mod flips;
mod folders;
mod full;
mod fuzz;
mod fuzz_data;
mod inputs;
mod outputs;
mod pipes;
mod power;
mod program;
mod resuming;
mod shortage;
