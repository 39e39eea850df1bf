//! Tolerances of integrators.

/// Absolute tolerances, in the unit of the unknowns.
#[derive(Clone, Debug, PartialEq)]
pub enum AbsoluteTolerances {
    /// One value for all unknowns.
    Same(f64),
    /// One value for each unknown.
    Each(Vec<f64>),
}

impl AbsoluteTolerances {
    /// Checks the tolerances for `n` unknowns; the error names the first invalid one.
    pub fn check(&self, relative: f64, n: usize) -> Result<(), String> {
        let positive = |value: f64| value.is_finite() && value > 0.0;
        if !positive(relative) {
            return Err(format!("the relative tolerance must be positive, it is {}", relative));
        }
        match self {
            AbsoluteTolerances::Same(value) if !positive(*value) => {
                return Err(format!("the absolute tolerance must be positive, it is {value}"));
            }
            AbsoluteTolerances::Each(values) if values.len() != n => {
                return Err(format!(
                    "{} absolute tolerances were given for {n} unknowns",
                    values.len()
                ));
            }
            AbsoluteTolerances::Each(values) => {
                if let Some(i) = values.iter().position(|&value| !positive(value)) {
                    return Err(format!(
                        "the absolute tolerance of unknown {i} must be positive, it is {}",
                        values[i]
                    ));
                }
            }
            AbsoluteTolerances::Same(_) => {}
        }
        Ok(())
    }

    /// Returns one tolerance for each of `n` unknowns.
    pub fn each(&self, n: usize) -> Vec<f64> {
        match self {
            Self::Same(value) => vec![*value; n],
            Self::Each(values) => values.clone(),
        }
    }
}
