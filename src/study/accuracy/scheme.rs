//! How a setting integrates in time.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::case::schema::{MaxOrder, Method, Solver};
use crate::error::{Error, Result};

/// Method and highest order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Scheme {
    /// Method; never "auto".
    pub method: Method,
    /// Highest order of IDA's; a one-step method has its own.
    pub order: u8,
}

/// Everything that can be asked for beside IDA.
const ONE_STEP: [(Method, &str, u8); 4] = [
    (Method::Trbdf2, "trbdf2", 2),
    (Method::Esdirk34, "esdirk34", 3),
    (Method::Esdirk46, "esdirk46", 4),
    (Method::Esdirk57, "esdirk57", 5),
];

impl Scheme {
    /// IDA with a highest order.
    pub fn ida(order: u8) -> Self {
        Self {
            method: Method::Ida,
            order,
        }
    }

    /// A one-step method.
    pub fn one_step(method: Method) -> Option<Self> {
        let (method, _, order) = ONE_STEP.into_iter().find(|(m, ..)| *m == method)?;
        Some(Self { method, order })
    }

    /// Schemes of a list of methods, IDA with each of the orders.
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
                        "--methods {name}: ida, {known}, comma between them"
                    )));
                }
            }
        }
        Ok(all)
    }

    /// Whether it is IDA.
    pub fn is_ida(self) -> bool {
        self.method == Method::Ida
    }

    /// Whether the waves of an undamped beam make it unstable.
    pub fn trapped(self) -> bool {
        self.is_ida() && self.order > 2
    }

    /// `2`, or `esdirk34`.
    pub fn label(self) -> String {
        let known = ONE_STEP.iter().find(|(method, ..)| *method == self.method);
        known.map_or_else(|| self.order.to_string(), |(_, name, _)| (*name).into())
    }

    /// Sets it.
    pub fn apply(self, solver: &mut Solver) {
        solver.method = self.method;
        solver.max_order = match self.order {
            _ if !self.is_ida() => MaxOrder::Auto,
            // These two are refused where they are unstable; a study may look at what they do there.
            3 | 4 => MaxOrder::Forced(self.order),
            _ => MaxOrder::Order(self.order),
        };
    }
}

/// `order 2`, or `esdirk34`.
impl fmt::Display for Scheme {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let of = if self.is_ida() { "order " } else { "" };
        write!(f, "{of}{}", self.label())
    }
}
