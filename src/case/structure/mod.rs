//! Structures of beams: their places, their bladders' numbers, and the single beams of which they consist.
//!
//! The segments of all beams are numbered one after the other. A joint between two segments of a beam divides it: a *piece* is a beam or
//! the part of one between joints.

use super::schema::Case;

mod fill;
mod pieces;

pub use fill::{fill, unknown_bladders};
pub use pieces::{Piece, Place, origins, pieces};

/// Pointer of a value of a span of all beams, as it is written in its beam; none for other pointers.
pub fn written_span(case: &Case, pointer: &str) -> Option<String> {
    if pointer == "/spans" {
        return Some("/beams".into());
    }
    let rest = pointer.strip_prefix("/spans/")?;
    let (number, rest) = rest
        .split_once('/')
        .map_or((rest, String::new()), |(number, rest)| (number, format!("/{rest}")));
    let mut left: usize = number.parse().ok()?;
    for (k, beam) in case.beams.iter().enumerate() {
        let own = beam.spans.len().max(1);
        if left < own {
            return Some(match beam.spans.is_empty() {
                true => format!("/beams/{k}{rest}"),
                false => format!("/beams/{k}/spans/{left}{rest}"),
            });
        }
        left -= own;
    }
    None
}

/// Pointer of a span of all beams, as it is written.
pub fn span_pointer(case: &Case, span: usize) -> String {
    let pointer = format!("/spans/{span}");
    written_span(case, &pointer).unwrap_or(pointer)
}

/// A joined place as written: `"left.tip"`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// The root.
    Root,
    /// The tip.
    Tip,
    /// The place behind this many segments.
    Behind(usize),
}

/// Name of the beam and place of a joined place as written; none if it is neither.
pub fn joined_place(written: &str) -> Option<(&str, Along)> {
    let (beam, place) = written.rsplit_once('.')?;
    let along = match place {
        "root" => Along::Root,
        "tip" => Along::Tip,
        number => Along::Behind(number.parse().ok().filter(|number| *number > 0)?),
    };
    Some((beam, along))
}
