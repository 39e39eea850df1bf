//! Mathematics that knows nothing of beams.
//!
//! | file | what stands there |
//! |---|---|
//! | [`scalar`] | the numbers in which equations are written |
//! | [`dual`] | a number with its derivatives |
//! | [`planar`] | vectors in the plane |
//! | [`kernels`] | loops over vectors |
//! | `gauss` | Gauss' quadrature |
//! | [`krylov`] | linear systems and eigenvalues of a map known only by what it does |

pub mod dual;
pub mod gauss;
pub mod kernels;
pub mod krylov;
pub mod planar;
pub mod scalar;

pub use dual::Dual;
pub use planar::Planar;
pub use scalar::Scalar;
