//! Time integration of a setting: method and order.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::case::schema::{MaxOrder, Method, Solver};
use crate::error::{Error, Result};

/// Method and highest order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Scheme {
    /// Method; never "auto".
    pub method: Method,
    /// Highest order of IDA, or the order of a one-step method.
    pub order: u8,
}

/// One-step methods with names and orders.
const ONE_STEP: [(Method, &str, u8); 4] = [
    (Method::Trbdf2, "trbdf2", 2),
    (Method::Esdirk34, "esdirk34", 3),
    (Method::Esdirk46, "esdirk46", 4),
    (Method::Esdirk57, "esdirk57", 5),
];

impl Scheme {
    /// Returns IDA with a highest order.
    pub fn ida(order: u8) -> Self {
        Self {
            method: Method::Ida,
            order,
        }
    }

    /// Returns the scheme of a one-step method; `None` for any other method.
    pub fn one_step(method: Method) -> Option<Self> {
        let (method, _, order) = ONE_STEP.into_iter().find(|(m, ..)| *m == method)?;
        Some(Self { method, order })
    }

    /// Returns the schemes of a list of methods, IDA once per order.
    ///
    /// # Errors
    /// [`Error::Usage`] for an unknown name.
    pub fn list(methods: &[String], orders: &[u8]) -> Result<Vec<Self>> {
        let mut all = vec![];
        for name in methods {
            match ONE_STEP.iter().find(|(_, known, _)| known == name) {
                Some(&(method, _, order)) => all.push(Self { method, order }),
                None if name == "ida" => all.extend(orders.iter().map(|&order| Self::ida(order))),
                None => {
                    let known = ONE_STEP.map(|(_, known, _)| known).join(", ");
                    return Err(Error::Usage(format!(
                        "--methods {name}: unknown method. Use ida, {known}, separated by commas"
                    )));
                }
            }
        }
        Ok(all)
    }

    /// True if the method is IDA.
    pub fn is_ida(self) -> bool {
        self.method == Method::Ida
    }

    /// True if the waves of an undamped beam make the scheme unstable.
    pub fn trapped(self) -> bool {
        self.is_ida() && self.order > 2
    }

    /// Label: `2` (highest order of IDA), or `esdirk34`.
    pub fn label(self) -> String {
        let known = ONE_STEP.iter().find(|(method, ..)| *method == self.method);
        known.map_or_else(|| self.order.to_string(), |(_, name, _)| (*name).into())
    }

    /// Sets method and order of a solver.
    pub fn apply(self, solver: &mut Solver) {
        solver.method = self.method;
        solver.max_order = match self.order {
            _ if !self.is_ida() => MaxOrder::Auto,
            // Orders 3 and 4 are rejected where they are unstable; a study may still examine them.
            3 | 4 => MaxOrder::Forced(self.order),
            _ => MaxOrder::Order(self.order),
        };
    }
}

/// Writes `order 2`, or `esdirk34`.
impl fmt::Display for Scheme {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let of = if self.is_ida() { "order " } else { "" };
        write!(f, "{of}{}", self.label())
    }
}
