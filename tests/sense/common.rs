//! The published beam with sealed bladders, as `slcbeam new sensor` has it, without the load that is to be found.

use slcbeam::case::{self, Case};
use slcbeam::numerics::normal;
use slcbeam::numerics::rng::Rng;

/// No load of its own, and a mesh that is quick.
pub const QUICK: [&str; 3] = ["/loads=[]", "/mesh/cells_per_segment=2", "/mesh/cells_per_bladder=1"];

/// The case.
pub fn sensor(sets: &[&str]) -> Case {
    let sets: Vec<String> = QUICK.iter().chain(sets).map(|set| (*set).into()).collect();
    case::load("cases/tour-sensor.json".as_ref(), &sets).expect("a case")
}

/// A number drawn from the normal distribution.
pub fn normal_number(chance: &mut Rng) -> f64 {
    normal::quantile(chance.share())
}
