//! Reading and checking of cases: the user's text is checked as a whole, and every fault has its place.
//!
//! text -> [`parse`](mod@parse) -> JSON with places -> `--set` -> [`presets`] -> [`validate`] against the schema -> CSV tables ->
//! [`schema::Case`] -> [`check`], which resolves the network: [`wiring`]

pub mod amounts;
pub mod bladder_numbers;
mod check;
mod choices;
mod computed;
mod counts;
mod ends;
mod faults;
pub mod fluids;
pub mod heading;
pub mod inherited;
mod load;
pub mod locate;
mod meanings;
pub(crate) mod numbers;
mod origins;
mod own_cell;
pub mod parameter;
mod parse;
mod places;
mod presets;
pub mod readable;
pub mod reading;
pub mod relaxation;
mod render;
mod rewrite;
mod scaling;
pub mod schema;
mod schema_json;
mod schema_words;
pub mod section;
mod separated;
mod sets;
mod spanned_outputs;
pub mod spans;
pub mod structure;
pub mod synonyms;
mod tables;
mod unit_mistakes;
pub mod units;
pub mod unknown;
mod validate;
pub mod wiring;
mod wording;
mod written;
mod wrong_kind;

pub use check::controllers::controllers;
pub use check::functions::{controls, overshoots};
pub use check::rarely_intended;
pub use ends::{Follower, ResolvedEnd, Rotation, Translation};
pub use faults::{CaseSource, is_below};
pub use load::{load, parse, parse_varied, text};
pub use meanings::{KeyDescription, meanings};
pub use origins::{Origin, Origins};
pub use places::LineColumns;
pub use presets::Preset;
pub use render::render;
pub use rewrite::{rewrite, spaced};
pub use schema::Case;
pub use schema_json::{schema_json, schema_of_resolved};
pub use tables::unclosed_quote;
pub use wording::{nearest, nearest_figure, short};
pub use written::{CaseText, is_table};
