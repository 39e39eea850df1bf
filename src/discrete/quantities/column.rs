//! Columns of the history, and their names.

use super::Observable;

/// A column of the history: one number per output time.
#[derive(Clone, Debug, PartialEq)]
pub struct HistoryColumn {
    /// Name without unit, snake case: `tip_u1`.
    pub name: String,
    /// Unit: `m`; `1` when dimensionless.
    pub unit: &'static str,
    /// Description in one sentence.
    pub about: String,
}

impl HistoryColumn {
    /// Name with unit, for keys of equilibria: `tip_u1_m`. The summary of a run uses [`key`].
    pub fn key(&self) -> String {
        let unit = match self.unit {
            "1" => return self.name.clone(),
            "Pa" => "pa",
            "J" => "j",
            "W" => "w",
            other => other,
        };
        format!("{}_{unit}", self.name)
    }

    /// True if a name is that of the column, with or without its unit.
    pub fn is_named(&self, name: &str) -> bool {
        self.name == name || self.key() == name || key(&self.name, self.unit) == name
    }
}

impl From<Observable> for HistoryColumn {
    fn from(one: Observable) -> Self {
        Self {
            name: one.name().into(),
            unit: one.unit(),
            about: one.about().into(),
        }
    }
}

/// Name with unit, for keys of probes and ports in the summary: `middle_u1_m`, `port_inlet_flow_m3_s`.
pub fn key(name: &str, unit: &str) -> String {
    match unit {
        "1" => name.into(),
        unit => format!(
            "{name}_{}",
            unit.to_lowercase()
                .replace("1/", "per_")
                .replace([' ', '/'], "_")
                .replace('^', "")
        ),
    }
}

/// Beam and quantity of the column or figure of a tip of a structure: `left` and `u1` of `left.tip_u1`, `u1_m` of `left.tip_u1_m`.
pub fn tip_of_beam(name: &str) -> Option<(&str, &str)> {
    name.split_once(".tip_")
}

/// True if the name of a column is that of a stress of the solid. It has the unit of fluid pressures but another order
/// of magnitude.
pub fn is_stress(name: &str) -> bool {
    name.ends_with("_stress_upper") || name.ends_with("_stress_lower")
}
