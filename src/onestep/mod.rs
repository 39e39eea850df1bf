//! One-step methods for `F(t, y, y') = 0` of index one: singly diagonally implicit, A-stable at every order.
//!
//! ```text
//! Kᵢ = y' at stage i        Yᵢ = yₙ + h Σ_{j<i} aᵢⱼ Kⱼ + h γ Kᵢ        F(tₙ + cᵢ h, Yᵢ, Kᵢ) = 0
//! ```
//!
//! holds for the differential unknowns. Algebraic ones are solved for in `Yᵢ` itself, since their derivatives do not appear. The first
//! stage is the last one of the previous step (`a₁₁ = 0`, `c₁ = 0`); the last stage is the result (`b = aₛ`). Values and rates therefore
//! satisfy the equations at the end of every step. Newton's matrix `∂F/∂y + 1/(h γ) ∂F/∂y'` is equal for all stages.
//!
//! | file | content |
//! |---|---|
//! | [`tableau`] | the methods: coefficients, orders |
//! | [`options`] | settings |
//! | [`integrator`] | integrator, one accepted step at a time |
//! | [`step_map`] | march over a fixed grid |
//! | `disturbance` | derivative of a march by its beginning |
//! | [`forced`] | response of a march to a forcing |
//! | `stages` | Newton's iteration from stage to stage, and the error estimate |
//! | `matrix` | Newton's matrix, its factors, and the criteria for renewing it |
//! | `control` | step size control |
//! | `dense` | dense output: values, rates and integrals within a step |
//! | `polynomial` | weights of interpolation and differentiation |
//! | `equations` | system of equations with counters, timers and errors |
//!
//! Sources: Hairer & Wanner, *Solving Ordinary Differential Equations II*, IV.6, IV.8 and VI.1; Kennedy & Carpenter,
//! *Diagonally implicit Runge-Kutta methods for ordinary differential equations*, NASA/TM-2016-219173.

mod control;
mod dense;
mod disturbance;
mod equations;
pub mod forced;
pub mod integrator;
mod matrix;
pub mod options;
mod polynomial;
mod stages;
pub mod step_map;
pub mod tableau;

pub use integrator::OneStep;
pub use options::OneStepOptions;
pub use step_map::StepMap;
pub use tableau::{Tableau, TableauMethod};
