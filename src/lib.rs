//! Elastic beams with rows of fluid-filled bladders joined by slender tubes, after Matia & Gat.
//!
//! Beam, bladders and network are one stiff differential-algebraic system of index one, `F(t, y, y') = 0`, integrated by
//! SUNDIALS' IDA with error control and exact sparse Jacobians. The model in equations, with every decision, is
//! `docs/model.md`; a case as the user writes it is [`case::schema`]; the program is `slcbeam`.
//!
//! # Rooms
//!
//! A file imports from its own room and from rooms above it, never from below; `tests/architecture.rs` verifies this.
//!
//! | room | content |
//! |---|---|
//! | [`error`] | errors that end a command, with exit codes |
//! | [`numerics`] | numerical methods independent of beams: dual numbers, kernels, quadrature, Krylov spaces |
//! | [`functions`] | functions of time and place, with bounds |
//! | [`sparse`] | sparse matrices: patterns, LU factors in dense blocks along a line, and a safe type for SuiteSparse's KLU |
//! | [`case`] | cases as written: schema, and a check that reports all faults at once |
//! | [`model`] | physics of one cross-section, one bladder, one network: pure functions generic over the scalar; choice of effects |
//! | [`discrete`] | space: mesh, unknowns with their scales, the residual in the paper's order, the exact balances |
//! | [`dae`] | the trait [`dae::Dae`], its implementation for the beam, and the Jacobian; independent of solvers |
//! | [`integrate`] | common parts of integrators: tolerances, consistent starts, counters, failures |
//! | [`sundials`] | safe types for IDA and KINSOL; depends only on [`dae::Dae`] |
//! | [`onestep`] | A-stable one-step methods of order 2 to 5, with the interface of [`sundials::Ida`] |
//! | [`spectral`] | eigenvalues of sparse pencils nearest a shift, with error bounds |
//! | [`run`] | a run in time, equilibria, modes, cycles: samples, balances, range checks. Emits events, prints nothing |
//! | [`study`] | studies of many runs: exact results, accuracy against cost, effects, comparison, many designs |
//! | [`results`] | result types, one per kind, for writers and readers |
//! | [`output`] | result folders: history, arrays, summary, pictures, the page |
//! | [`cli`] | one file per subcommand; the only room that prints |
//!
//! Data flow in one direction: text → schema → checked [`case::Case`] → [`model::Model`] → [`discrete::System`] →
//! [`dae::BeamDae`] → [`sundials::Ida`] → samples → files. An absent effect adds no unknown and no term; this is
//! decided once, when the model is built.
//!
//! ```no_run
//! use slcbeam::{case, run::{dynamics, record::Memory}};
//! # fn main() -> slcbeam::error::Result<()> {
//! let case = case::load("cases/wiring-2.json".as_ref(), &["/time/end_s=0.1".to_string()])?;
//! let mut record = Memory::default();
//! let outcome = dynamics::run(&case, &mut record)?;
//! println!("{:?} at t = {} s", outcome.summary.status, outcome.summary.time_s);
//! let tip = record.column("tip_u1").unwrap_or_default();
//! # let _ = tip;
//! # Ok(())
//! # }
//! ```
//!
#![doc = include_str!("../docs/glossary.md")]

pub mod case;
pub mod cli;
pub mod dae;
pub mod discrete;
pub mod error;
pub mod functions;
pub mod integrate;
pub mod model;
pub mod numerics;
pub mod onestep;
pub mod output;
pub mod results;
pub mod run;
pub mod sparse;
pub mod spectral;
pub mod study;
pub mod sundials;
