//! Level structures of a graph: sets of nodes, each adjacent only to the set before and the set after it.

use crate::sparse::groups::groups;

/// Maximum number of searches for a node far from the others.
const SEARCHES: usize = 6;

/// Neighbours of every node: those of node k are `to[starts[k]..starts[k + 1]]`.
pub(super) struct Graph {
    pub starts: Vec<usize>,
    pub to: Vec<u32>,
}

impl Graph {
    /// Stores both directions of every edge between two nodes.
    pub fn new(nodes: usize, edges: &[[u32; 2]]) -> Self {
        let ends = edges.iter().filter(|[a, b]| a != b);
        let (to, starts) = groups(nodes, ends.flat_map(|&[a, b]| [(a, b), (b, a)]));
        Self { starts, to }
    }

    pub fn neighbours(&self, node: u32) -> &[u32] {
        &self.to[self.starts[node as usize]..self.starts[node as usize + 1]]
    }

    /// Levels of every connected component, one after the other; each begins at a node far from the rest of its component (George & Liu
    /// 1979).
    pub fn levels(&self) -> Vec<Vec<u32>> {
        let nodes = self.starts.len() - 1;
        let mut mark = vec![0_u32; nodes];
        let mut round = 0;
        let mut done = vec![false; nodes];
        let mut all = vec![];
        for start in 0..nodes as u32 {
            if done[start as usize] {
                continue;
            }
            round += 1;
            let mut levels = self.from(start, round, &mut mark);
            for _ in 0..SEARCHES {
                let Some(end) = levels
                    .last()
                    .and_then(|last| last.iter().min_by_key(|k| self.neighbours(**k).len()))
                else {
                    break;
                };
                round += 1;
                let other = self.from(*end, round, &mut mark);
                let deeper = other.len() > levels.len();
                if deeper || other.len() == levels.len() && width(&other) < width(&levels) {
                    levels = other;
                }
                if !deeper {
                    break;
                }
            }
            levels.iter().flatten().for_each(|k| done[*k as usize] = true);
            all.extend(levels);
        }
        all
    }

    /// Levels by distance from a node.
    fn from(&self, start: u32, round: u32, mark: &mut [u32]) -> Vec<Vec<u32>> {
        mark[start as usize] = round;
        let mut levels = vec![vec![start]];
        loop {
            let mut next = vec![];
            for node in &levels[levels.len() - 1] {
                for other in self.neighbours(*node) {
                    if mark[*other as usize] != round {
                        mark[*other as usize] = round;
                        next.push(*other);
                    }
                }
            }
            if next.is_empty() {
                return levels;
            }
            levels.push(next);
        }
    }
}

fn width(levels: &[Vec<u32>]) -> usize {
    levels.iter().map(Vec::len).max().unwrap_or(0)
}
