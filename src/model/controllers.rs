//! Controllers of a case, each with the input that it sets.

use crate::case::readable::key_unit;
use crate::case::{self, Case};
use crate::functions::control::Controller;

/// A controller with the first of the inputs that it sets.
#[derive(Clone, Debug)]
pub struct ControlledInput {
    /// JSON pointer of the controller.
    pub pointer: String,
    /// The controller.
    pub controller: Controller,
    /// Unit of its output.
    pub unit: &'static str,
}

impl ControlledInput {
    /// All controllers of a case by name, in the order of its signals.
    pub fn all(case: &Case) -> Vec<Self> {
        let mut all: Vec<Self> = vec![];
        for (pointer, controller) in case::controllers(case) {
            if all.iter().all(|one| one.controller.name != controller.name) {
                all.push(Self {
                    unit: unit(&pointer),
                    pointer,
                    controller: controller.clone(),
                });
            }
        }
        all
    }
}

/// Unit of the output of a controller at a pointer: that of its input, or 1 for a factor of a product.
fn unit(pointer: &str) -> &'static str {
    if pointer.contains("/product/") {
        return "1";
    }
    let keys = pointer.rsplit('/').filter_map(key_unit);
    keys.map(|(_, unit)| unit).next().unwrap_or("1")
}
