//! Disjoint sets.

/// Disjoint sets of the integers below a limit; the smallest member identifies a set.
pub struct Sets(Vec<usize>);

impl Sets {
    /// Sets of one number each.
    pub fn new(len: usize) -> Self {
        Self((0..len).collect())
    }

    /// Smallest member of a number's set.
    pub fn root(&mut self, mut i: usize) -> usize {
        while self.0[i] != i {
            self.0[i] = self.0[self.0[i]];
            i = self.0[i];
        }
        i
    }

    /// Merges the sets of two numbers.
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b)] = a.min(b);
    }
}
