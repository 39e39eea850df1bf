//! Laws of beam, bladders and network, each against what it was derived from, closed forms, balances and differences.

mod around;
mod attachments;
#[path = "../common/balances.rs"]
mod balances;
#[path = "../common/chance.rs"]
mod chance;
mod closing;
#[path = "../differences/mod.rs"]
mod differences;
mod eccentric;
mod eccentric_borders;
mod foundation;
mod jacobian;
#[path = "../common/kinematics.rs"]
mod kinematics;
mod moment_curvature;
mod moment_tables;
mod network;
mod nonlinear;
mod other_pressure;
mod pump_curves;
mod reactions;
mod rotating_frame;
#[path = "../common/scene.rs"]
mod scene;
#[path = "../common/secant.rs"]
mod secant;
mod segments;
mod sloshing;
mod smooth_parts;
mod snapping;
mod span_damping;
mod spans;
mod surroundings;
mod tubes;
