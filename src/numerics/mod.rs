//! Mathematics that knows nothing of beams.
//!
//! | file | what stands there |
//! |---|---|
//! | [`scalar`] | the numbers in which equations are written |
//! | [`dual`] | a number with its derivatives |
//! | [`angle`] | angles of vectors |
//! | [`planar`] | vectors in the plane |
//! | [`kernels`] | loops over vectors |
//! | `wide` | the same in vectors as wide as the processor has |
//! | [`threads`] | and in two threads |
//! | `gauss` | Gauss' quadrature |
//! | `ramp` | a ramp with a round foot |
//! | [`regression`], [`student`] | least squares with covariance, and intervals by Student's distribution |
//! | [`levenberg`] | nonlinear least squares between bounds |
//! | [`inverse`] | linear problems whose answer may not be told by their data: what is, and how surely |
//! | [`sqp`] | least values between bounds under inequalities |
//! | [`chance`], [`sobol`] | numbers by chance, and points that fill a cube evenly |
//! | [`normal`] | quantiles of the normal distribution |
//! | [`krylov`] | linear systems and eigenvalues of a map known only by what it does |

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
