//! One-step methods for `F(t, y, y') = 0` of index one: singly diagonally implicit, A-stable at every order.
//!
//! ```text
//! Kᵢ = y' at stage i        Yᵢ = yₙ + h Σ_{j<i} aᵢⱼ Kⱼ + h γ Kᵢ        F(tₙ + cᵢ h, Yᵢ, Kᵢ) = 0
//! ```
//!
//! for the differential unknowns; algebraic ones are solved for in `Yᵢ` itself, since their derivative never appears. The
//! first stage is the last one of the step before (`a₁₁ = 0`, `c₁ = 0`), the last stage is the result (`b = aₛ`): values and
//! rates fulfil the equations at the end of every step. Newton's matrix is `∂F/∂y + 1/(h γ) ∂F/∂y'`, the same for all stages.
//!
//! | file | what stands there |
//! |---|---|
//! | [`tableau`] | the methods: coefficients, orders |
//! | [`options`] | what can be asked |
//! | [`integrator`] | one accepted step at a time |
//! | [`step_map`] | a march over a fixed grid and its exact derivative |
//! | [`forced`] | that derivative by a number of the equations |
//! | `stages` | Newton's iteration from stage to stage, and the estimate of the error |
//! | `matrix` | Newton's matrix, its factors, and when they are too old |
//! | `control` | the size of the next step |
//! | `dense` | values, rates and integrals inside a step |
//! | `polynomial` | weights of interpolation and differentiation |
//! | `equations` | the system, counted, timed, its faults kept |
//!
//! Sources: Hairer & Wanner, *Solving Ordinary Differential Equations II*, IV.6, IV.8 and VI.1; Kennedy & Carpenter,
//! *Diagonally implicit Runge-Kutta methods for ordinary differential equations*, NASA/TM-2016-219173.

mod control;
mod dense;
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
pub use tableau::{Method, Tableau};
