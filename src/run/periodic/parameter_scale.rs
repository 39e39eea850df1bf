//! Values of a number of the case over a coordinate.

/// Values of the number over a coordinate that increases by one from each requested value to the next.
#[derive(Clone, Copy, Debug)]
pub struct ParameterScale {
    /// Value at the coordinate zero.
    pub from: f64,
    /// Difference of neighbouring values, or of their logarithms.
    pub step: f64,
    /// True if the values are evenly spaced in their logarithms.
    pub logarithmic: bool,
}

impl ParameterScale {
    /// Scale of evenly spaced values, at least two.
    pub fn new(values: &[f64], logarithmic: bool) -> Self {
        let (from, to) = (values[0], values[values.len() - 1]);
        let whole = if logarithmic { (to / from).ln() } else { to - from };
        Self {
            from,
            step: whole / (values.len() - 1) as f64,
            logarithmic,
        }
    }

    /// Value at a coordinate.
    pub fn value(&self, coordinate: f64) -> f64 {
        match self.logarithmic {
            true => self.from * (self.step * coordinate).exp(),
            false => self.from + self.step * coordinate,
        }
    }

    /// Unit of a tolerance of the value.
    pub(super) fn unit(&self, coordinate: f64) -> f64 {
        match self.logarithmic {
            true => self.value(coordinate).abs(),
            false => self.value(coordinate).abs().max(self.step.abs()),
        }
    }
}
