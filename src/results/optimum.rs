//! `optimum.json`: the numbers of a case for which a figure is largest or smallest.

use super::ResultFile;
pub use crate::study::optimize::outcome::*;

impl ResultFile for Optimum {
    const FORMAT: u32 = 2;
}
