//! Numbers that are sought: derivatives of cycles.

mod cycles;
