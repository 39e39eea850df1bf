//! Bloch waves of a beam whose segments repeat.
//!
//! `[E92]` Small motions about a state at rest obey `(A + s B) x = 0`. In the middle of a beam of equal cells the equations of a cell
//! contain its own unknowns x and those of the cells beside it, and are the same in each. A wave has the factor λ from cell to cell:
//!
//! ```text
//! (T_-/λ + T_0 + λ T_+) x = 0        T = A + s B        λ = exp(-i Re μ - Im μ)
//! ```
//!
//! At a real frequency, s = i ω, a wave toward the tip lags by `Re μ` from cell to cell and is attenuated by `Im μ` nepers, 8.69 dB each.
//! At a real μ the eigenvalues s are frequencies and growth rates; those of μ = 0 and μ = π bound the gaps of a lossless cell.
//!
//! ```text
//! cell         cell of the linearized equations, read from the middle of the beam
//! condensed    its equations for the unknowns that other cells contain
//! waves        waves at a frequency, frequencies at a wave number, energies of both
//! ```

pub mod cell;
mod condensed;
pub mod waves;
