//! Controllers of a system: columns that they measure, and their outputs.

use super::System;
use super::quantities::stations;
use crate::case;
use crate::error::{Code, Violation};
use crate::functions::control::ControlState;

impl System {
    /// Index of the column of the history that a controller measures; none if there is no such column.
    pub fn measured(&self, name: &str) -> Option<usize> {
        let all = stations::measurable(self);
        all.iter()
            .find(|(_, column)| column.is_named(name))
            .map(|(place, _)| *place)
    }

    /// Sets the output of the controller at an index among those of the model.
    pub fn hold_output(&mut self, controller: usize, state: &ControlState) {
        let one = &mut self.model.controllers[controller].controller;
        one.hold(state);
        let name = one.name.clone();
        self.each_signal_mut(|signal| {
            signal.hold(&name, state);
        });
    }

    /// Errors of controllers that measure a quantity which the history does not have.
    pub(super) fn unmeasured(&self) -> Vec<Violation> {
        let controllers = self.model.controllers.iter();
        let unknown = controllers.filter(|one| self.measured(&one.controller.measures).is_none());
        let fault = |one: &crate::model::ControlledInput| {
            let name = &one.controller.measures;
            let all = stations::measurable(self);
            let names = all.iter().map(|(_, column)| column.name.as_str());
            let what = format!("a run of this case records no quantity \"{name}\" that a controller can measure");
            let fault = Violation::new(Code::Name, format!("{}/measures", one.pointer), what);
            let known = names.clone().collect::<Vec<_>>().join(", ");
            match case::nearest(name, names) {
                Some(near) => fault.hint(format!("nearest is \"{near}\"")),
                None => fault.hint(format!("it records {known}")),
            }
        };
        unknown.map(fault).collect()
    }
}
