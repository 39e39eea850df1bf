//! Labels of points without overlap.

/// Positions of labels of one size. A label that would overlap an earlier one is omitted.
#[derive(Clone, Debug)]
pub struct LabelRoom {
    /// Width and height of a label.
    size: (f64, f64),
    taken: Vec<(f64, f64)>,
}

impl LabelRoom {
    /// For labels of a width and height; none is placed yet.
    pub fn new(size: (f64, f64)) -> Self {
        Self { size, taken: vec![] }
    }

    /// Reserves the place of a label. Returns false if it would overlap an earlier one.
    pub fn claim(&mut self, at: (f64, f64)) -> bool {
        let apart = |other: &(f64, f64)| (at.0 - other.0).abs() > self.size.0 || (at.1 - other.1).abs() > self.size.1;
        let free = self.taken.iter().all(apart);
        if free {
            self.taken.push(at);
        }
        free
    }
}

#[cfg(test)]
mod tests {
    use super::LabelRoom;

    #[test]
    fn labels_that_would_overlap_are_left_out() {
        let mut room = LabelRoom::new((10.0, 5.0));
        let claimed = [(0.0, 0.0), (9.0, 0.0), (9.0, 6.0), (20.0, 0.0)].map(|at| room.claim(at));
        assert_eq!(claimed, [true, false, true, true]);
    }
}
