//! Disjoint sets.

/// Numbers from 0 on, each in one of disjoint sets, which is known by its smallest member.
pub struct Sets(Vec<usize>);

impl Sets {
    /// Each number by itself.
    pub fn new(len: usize) -> Self {
        Self((0..len).collect())
    }

    /// The smallest member of the set of a number.
    pub fn root(&mut self, mut i: usize) -> usize {
        while self.0[i] != i {
            self.0[i] = self.0[self.0[i]];
            i = self.0[i];
        }
        i
    }

    /// Makes the sets of two numbers one.
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b)] = a.min(b);
    }
}
