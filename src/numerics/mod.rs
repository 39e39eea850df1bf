//! Numerical methods, independent of beams.
//!
//! | file | content |
//! |---|---|
//! | [`scalar`] | number types in which equations are written |
//! | [`dual`] | dual numbers |
//! | [`angle`] | angles of vectors |
//! | [`planar`] | vectors in the plane |
//! | [`kernels`] | loops over vectors |
//! | `simd` | loops in the widest vector registers |
//! | [`threads`] | work in several threads |
//! | `gauss` | Gauss quadrature |
//! | `ramp` | ramp with a smooth start |
//! | [`regression`], [`student_t`] | least squares with covariance, intervals by Student's distribution |
//! | [`golden_section`] | search for a maximum |
//! | [`levenberg`] | bounded nonlinear least squares |
//! | [`bayesian_least_squares`] | Bayesian linear least squares, observability |
//! | [`sqp`] | minimization with bounds and inequalities |
//! | [`rng`], [`sobol`] | pseudo-random numbers, Sobol sequences |
//! | [`normal`] | quantiles of the normal distribution |
//! | [`krylov`] | linear systems and eigenvalues of a map given as a function |
//! | [`shifted`] | linear systems of such a map with many complex shifts |
//! | [`rational`] | rational functions through samples |

pub mod angle;
pub mod bayesian_least_squares;
pub mod dual;
pub mod gauss;
pub mod golden_section;
pub mod kernels;
pub mod krylov;
pub mod levenberg;
pub mod normal;
pub mod planar;
mod ramp;
pub mod rational;
pub mod regression;
pub mod rng;
pub mod scalar;
pub mod sets;
pub mod shifted;
mod simd;
pub mod sobol;
pub mod sqp;
pub mod student_t;
pub mod threads;

pub use dual::Dual;
pub use planar::Planar;
pub use ramp::{ramp, ramp_integral};
pub use scalar::Scalar;
pub(crate) use simd::wide;
