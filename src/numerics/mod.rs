//! Numerical methods, independent of beams.
//!
//! | file | content |
//! |---|---|
//! | [`scalar`] | number types in which equations are written |
//! | [`dual`] | dual numbers |
//! | [`angle`] | angles of vectors |
//! | [`planar`] | vectors in the plane |
//! | [`kernels`] | loops over vectors |
//! | `wide` | loops in the widest vector registers |
//! | [`threads`] | work in several threads |
//! | `gauss` | Gauss quadrature |
//! | `ramp` | ramp with a smooth start |
//! | [`regression`], [`student`] | least squares with covariance, intervals by Student's distribution |
//! | [`levenberg`] | bounded nonlinear least squares |
//! | [`inverse`] | Bayesian linear least squares, observability |
//! | [`sqp`] | minimization with bounds and inequalities |
//! | [`chance`], [`sobol`] | pseudo-random numbers, Sobol sequences |
//! | [`normal`] | quantiles of the normal distribution |
//! | [`krylov`] | linear systems and eigenvalues of a map given as a function |

pub mod angle;
pub mod chance;
pub mod dual;
pub mod gauss;
pub mod inverse;
pub mod kernels;
pub mod krylov;
pub mod levenberg;
pub mod normal;
pub mod planar;
mod ramp;
pub mod regression;
pub mod scalar;
pub mod sets;
pub mod sobol;
pub mod sqp;
pub mod student;
pub mod threads;
mod wide;

pub use dual::Dual;
pub use planar::Planar;
pub use ramp::ramp;
pub use scalar::Scalar;
pub(crate) use wide::wide;
