//! What the user wrote: read, checked as a whole, every fault with its place.
//!
//! text -> [`parse`](mod@parse) -> JSON with places -> `--set` -> [`presets`] -> [`validate`] against the schema -> CSV tables ->
//! [`schema::Case`] -> [`check`], which finds what the network names: [`wiring`]

pub mod bounds;
mod check;
mod choices;
mod counts;
mod curve;
mod ends;
mod evaluate;
mod faults;
pub mod inherited;
mod jet;
mod load;
pub mod locate;
mod meanings;
mod number_or_object;
mod numbers;
mod origins;
pub mod parameter;
mod parse;
mod places;
mod presets;
pub mod profile;
mod render;
mod rewrite;
pub mod schema;
mod schema_json;
mod sets;
pub mod signals;
mod tables;
mod validate;
pub mod wiring;
mod wording;
mod written;

pub use curve::{Curve, Interpolation};
pub use ends::{Follower, ResolvedEnd, Rotation, Translation};
pub use faults::Source;
pub use load::{load, parse};
pub use meanings::{Meaning, meanings};
pub use origins::{Origin, Origins};
pub use places::Places;
pub use presets::Preset;
pub use profile::Profile;
pub use render::render;
pub use rewrite::{rewrite, spaced};
pub use schema::Case;
pub use schema_json::schema_json;
pub use signals::{Clock, Jet, Signal};
pub use wording::nearest;
pub use written::{Written, is_table};
