//! `optimum.json`: the numbers of a case with which a figure is largest or least.

use super::Kept;
pub use crate::study::optimize::found::*;

impl Kept for Optimum {
    const FORMAT: u32 = 2;
}
