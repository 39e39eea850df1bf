//! What a run watches and says of itself, beside what it computes.

mod estimate;
mod estimate_words;
mod probes;
#[path = "../common/scene.rs"]
mod scene;
mod step_response;
mod told;
mod turning;
mod unphysical;
mod watch;
mod waves;
