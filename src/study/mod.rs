//! Studies: many runs that answer one question. This module prints nothing.

pub mod accuracy;
pub mod analysis;
pub mod bands;
pub mod companion;
pub mod compare;
pub mod data;
pub mod effects;
pub mod evaluations;
pub mod fit;
pub mod followed;
pub mod measure;
pub mod optimize;
pub mod refine;
pub mod response;
pub mod search_bounds;
pub mod sense;
pub mod significant;
pub mod stability;
pub mod sweep;
pub mod target;
pub mod uncertain;
pub mod verify;

use crate::error::Result;
use crate::integrate::halt;
use crate::numerics::threads;

/// Results of a list, computed in two threads, each of which computes one half.
fn in_halves<T: Sync, R: Send>(all: &[T], part: impl Fn(&[T]) -> Result<Vec<R>> + Sync) -> Result<Vec<R>> {
    in_halves_by(&mut [(), ()], all, |(), half| part(half))
}

/// Results of a list, computed in two threads, each of which computes one half by a solver of its own.
fn in_halves_by<S: Send, T: Sync, R: Send>(
    [one, other]: &mut [S; 2],
    all: &[T],
    part: impl Fn(&mut S, &[T]) -> Result<Vec<R>> + Sync,
) -> Result<Vec<R>> {
    let (first, second) = all.split_at(all.len() / 2);
    let heard = &halt::heard();
    let (first, second) = threads::both(|| heard.during(|| part(one, first)), || part(other, second));
    Ok([first?, second?].into_iter().flatten().collect())
}
