//! Prediction of the next point of a path.

/// Points of a path, each with its distance from the first along the path.
#[derive(Clone, Debug, Default)]
pub struct RecentPoints {
    points: Vec<(f64, Vec<f64>)>,
}

/// Number of points that a prediction uses: a cubic.
const POINTS: usize = 4;

impl RecentPoints {
    /// Creates the trail of two points at a distance.
    pub fn through(first: Vec<f64>, distance: f64, second: Vec<f64>) -> Self {
        Self {
            points: vec![(0.0, first), (distance, second)],
        }
    }

    /// Adds a point that lies `step` beyond the last one.
    pub fn push(&mut self, step: f64, x: Vec<f64>) {
        let at = self.points.last().map_or(0.0, |p| p.0) + step;
        self.points.push((at, x));
        if self.points.len() > POINTS {
            self.points.remove(0);
        }
    }

    /// The last point.
    pub fn last(&self) -> &[f64] {
        self.points.last().map_or(&[], |p| &p.1)
    }

    /// Change of the last coordinate over the last step.
    pub fn last_change(&self) -> f64 {
        let mut values = self.points.iter().rev().filter_map(|p| p.1.last());
        match (values.next(), values.next()) {
            (Some(last), Some(before)) => last - before,
            _ => 0.0,
        }
    }

    /// Degree of the polynomial through the points.
    pub fn degree(&self) -> u8 {
        self.points.len() as u8 - 1
    }

    /// Extrapolates the polynomial through the points (Lagrange) to `step` beyond the last one.
    pub fn beyond(&self, step: f64) -> Vec<f64> {
        let at = self.points.last().map_or(0.0, |p| p.0) + step;
        let mut x = vec![0.0; self.last().len()];
        for (i, (here, values)) in self.points.iter().enumerate() {
            let others = self.points.iter().enumerate().filter(|(j, _)| *j != i);
            let weight: f64 = others.map(|(_, (there, _))| (at - there) / (here - there)).product();
            x.iter_mut().zip(values).for_each(|(x, v)| *x += weight * v);
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::RecentPoints;

    #[test]
    fn cubics_are_predicted_exactly() {
        let f = |t: f64| vec![1.0 + t - 2.0 * t * t + 0.5 * t * t * t];
        let mut trail = RecentPoints::through(f(-0.1), 0.1, f(0.0));
        let mut t = 0.0;
        for step in [0.1, 0.25, 0.2, 0.4, 0.1] {
            t += step;
            trail.push(step, f(t));
        }
        assert!((trail.beyond(0.3)[0] - f(t + 0.3)[0]).abs() < 1e-13);
        assert_eq!(trail.degree(), 3);
    }
}
