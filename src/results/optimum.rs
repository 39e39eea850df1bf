//! `optimum.json`: the numbers of a case for which a figure is largest or smallest.

use super::Kept;
pub use crate::study::optimize::found::*;

impl Kept for Optimum {
    const FORMAT: u32 = 2;
}
