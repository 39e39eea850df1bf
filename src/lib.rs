//! Elastic beams with rows of fluid-filled bladders joined by slender tubes, after Matia & Gat.
//!
//! Beam, bladders and network are one stiff differential-algebraic system of index one, `F(t, y, y') = 0`, integrated by
//! SUNDIALS' IDA with error control and exact sparse Jacobians. The model in equations, with every decision, is
//! `docs/model.md`; a case as the user writes it is [`case::schema`]; the program is `slcbeam`.
//!
//! # Rooms
//!
//! A file imports from its own room and from rooms above it, never from below; `tests/architecture.rs` holds this.
//!
//! | room | what it knows |
//! |---|---|
//! | [`error`] | everything that ends a command without success, and its exit code |
//! | [`case`] | what the user wrote: schema, check with all faults at once, functions of time and place |
//! | [`model`] | physics of one cross-section, one bladder, one network: pure functions generic over the scalar; effects chosen |
//! | [`discrete`] | space: mesh, unknowns with their scales, the residual in the paper's order, the exact balances |
//! | [`dae`] | the trait [`dae::Dae`]; the beam as one; dual numbers, pattern, Jacobian. Knows no solver |
//! | [`sundials`] | IDA, KINSOL and KLU behind safe types; the only `unsafe` code; knows only [`dae::Dae`] |
//! | [`onestep`] | A-stable one-step methods of order 2 to 5, with the interface of [`sundials::Ida`] |
//! | [`spectral`] | eigenvalues of sparse pencils nearest a shift, with bounds of their errors |
//! | [`run`] | a run in time, equilibria, modes, cycles: samples, balances, range checks. Emits what happens, prints nothing |
//! | [`study`] | many runs to answer one question: exact results, accuracy against cost, effects, comparison |
//! | [`output`] | result folders: history, arrays, summary, pictures |
//! | [`cli`] | one file a subcommand; the only place that prints |
//!
//! Data flow one way: text → schema → checked [`case::Case`] → [`model::Model`] → [`discrete::System`] →
//! [`dae::BeamDae`] → [`sundials::Ida`] → samples → files. An effect that is absent is an absent unknown and an absent
//! term, decided once, when the model is built.
//!
//! ```no_run
//! use slcbeam::{case, run::{dynamics, record::Memory}};
//! # fn main() -> slcbeam::error::Result<()> {
//! let loaded = case::load("cases/wiring-2.json".as_ref(), &["/time/end_s=0.1".to_string()])?;
//! let mut record = Memory::default();
//! let outcome = dynamics::run(&loaded.case, &mut record)?;
//! println!("{:?} at t = {} s", outcome.summary.status, outcome.summary.time_s);
//! let tip = record.column("tip_u1").unwrap_or_default();
//! # let _ = tip;
//! # Ok(())
//! # }
//! ```
//!
//! # Symbols
//!
//! The names below are those of the equations in doc comments. Tags name equations: `[E9]` stands once at the definition
//! in the source, once in `docs/model.md`, and in `tests/equations.rs` with the test that covers it.
//!
//! Coordinates and beam:
//!
//! | symbol | name | unit | where |
//! |---|---|---|---|
//! | t, θ | time, material coordinate along the beam | s, m | |
//! | x, z | position across and along | m | E11 |
//! | u1, u3 | displacements, `x` and `z - θ` | m | E11 |
//! | λ, φ, κ | stretch, tangent angle, curvature `-φ'` | 1, rad, 1/m | E11 |
//! | e_t, e_n | unit tangent and normal | 1 | E11 |
//! | d1, d3 | directors across and along, length λ | 1 | E11 |
//! | l_s, h_s, w_s | length, height, width of the beam | m | E1 |
//! | E, ρ_s | Young's modulus, density of the solid | Pa, kg/m³ | E1 |
//! | f_e, f_i, f_m | axial, bending, mass factor of the honeycomb | 1 | E1 |
//! | m, EA, EI | mass per length, axial and bending stiffness | kg/m, N, N m² | E1 |
//! | y11 | squared radius of gyration | m² | E1 |
//! | τ_a, τ_b, c | damping times of stretch and bending, drag | s, s, N s/m² | E12, E14 |
//! | N, M, V | normal force, bending moment, shear force | N, N m, N | E12 |
//! | λ_p, α_p | stretch and curvature due to pressure | 1, 1/m | E3 |
//! | α | bending strain: κ, or λκ in the published form | 1/m | E12 |
//! | n, r | section force in lab axes, its rotary part over d1 | N | E13 |
//! | b, m b1 | load per length, its first moment over the section | N/m, N | E5, E13 |
//! | c_i | force on a node that the published form adds | N | E15 |
//! | g, U | 1 where the normal force acts on bending, else 0; motion of the driven ends along the beam | 1, m | E26, E27, E28 |
//!
//! Fluid and network:
//!
//! | symbol | name | unit | where |
//! |---|---|---|---|
//! | n/2, j, R | bladders in a row, segment, row (+1 upper, -1 lower) | 1 | |
//! | l_b, h_b, w_b | length, height, width of a bladder | m | E1 |
//! | l_seg, φ_b | length of a segment, its inverse | m, 1/m | E3 |
//! | s | coordinate along a bladder, inlet to outlet | m | |
//! | ρ_f, μ | density and viscosity of the fluid | kg/m³, Pa s | E1, E9 |
//! | a1, p, q | area change, pressure, flow | m², Pa, m³/s | E2, E8, E9 |
//! | p_u, p_d | mean pressure of the upper and lower bladder of a segment | Pa | E3 |
//! | a_p | area per pressure | m²/Pa | E2 |
//! | aM-, aM+; am, dm | area per moment, opening and closing; mean, half difference | m²/(N m) | E2 |
//! | aN-, aN+; an, dn | area per force, tension and compression; mean, half difference | m²/N | E2 |
//! | σ, d | smoothed absolute value and its width | as its argument | E2 |
//! | ψ', ζ' | published slope and length per pressure over E | rad, m | E3 |
//! | g* | complementary energy per length of the reciprocal coupling | N | E3 |
//! | a0, V | area and volume change that is kept | m², m³ | E23, E25 |
//! | Mbar, Nbar | means over a segment | N m, N | E16 |
//! | q1b, q1c | permeability of bladder and tube | m⁴ | E4 |
//! | l_c, r_c | length and radius of a tube | m | E6 |
//! | o, g, R | opening of a valve, conductance, resistance | 1, m³/(s Pa), Pa s/m³ | E6 |
//! | p_c, G_f, G_r, w | cracking pressure, conductances, width of a check valve | Pa, m³/(s Pa), m³/(s Pa), Pa | E7 |
//! | G | conductance of a turbine | m³/(s Pa) | E18 |
//! | d, w | pressure drop over a bridge and over its turbine | Pa | E10, E18 |
//!
//! Discretisation and balances:
//!
//! | symbol | name | unit | where |
//! |---|---|---|---|
//! | K, h, h_i | cells a segment, cell length, length of a node | 1, m, m | E11, E14 |
//! | w_ji | weight of node i in the mean of segment j | 1 | E16 |
//! | Δs | length of a fluid cell | m | E17 |
//! | E | stored energy (where no modulus is meant) | J | E19 |
//! | P, D | powers put in, powers dissipated or harvested | W | E19 |
//! | t_s*, t_f*, F_u | time of solid and fluid, forcing frequency times t_f* | s, s, 1 | E20 |

pub mod case;
pub mod cli;
pub mod dae;
pub mod discrete;
pub mod error;
pub mod model;
pub mod onestep;
pub mod output;
pub mod run;
pub mod spectral;
pub mod study;
pub mod sundials;
