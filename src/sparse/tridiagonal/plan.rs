//! Assignment of unknowns to blocks, and the destination of every matrix entry.

use std::ops::Range;

use super::dense::{LANES, padded, place};
use super::levels::Graph;
use crate::numerics::threads::LARGE;
use crate::sparse::condense::CondensedMatrix;
use crate::sparse::{Pattern, groups::groups};

/// Largest number of unknowns of a block merged from neighboring levels.
const TOGETHER: usize = 12;

/// Unknowns of a block, and its coupling to the next one on the way to the twist.
#[derive(Clone, Debug, Default)]
pub(super) struct Block {
    /// Index of its first unknown among all.
    pub at: usize,
    /// Number of its unknowns.
    pub size: usize,
    /// Number of its unknowns, padded.
    pub rows: usize,
    /// Its unknowns that are coupled to the next block.
    pub mine: Range<usize>,
    /// Unknowns of the next block that are coupled to this one.
    pub theirs: Range<usize>,
    /// Start of its values: inverse followed by its contribution to the next block; contribution of the next block.
    pub numbers: [usize; 2],
    /// Its range of [`Plan::sources`] and of [`Plan::folded`].
    pub sources: Range<usize>,
    pub folded: Range<usize>,
}

impl Block {
    /// Sizes of the square block, and of the entries beside it in its rows and in its columns, during assembly.
    pub fn room(&self) -> [usize; 3] {
        let (mine, theirs) = (self.mine.len(), self.theirs.len());
        [self.rows * self.size, mine * theirs, padded(theirs) * mine]
    }

    /// Number of products that a solution needs.
    pub fn products(&self) -> usize {
        self.rows * (self.size + self.theirs.len()) + padded(self.theirs.len()) * self.mine.len()
    }
}

/// An unknown that is not eliminated.
#[derive(Clone, Copy, Debug)]
pub(super) struct RetainedUnknown {
    /// Its index in the blocks.
    pub at: u32,
    /// Its row, and the unknown itself.
    pub row: u32,
    pub unknown: u32,
}

pub(super) struct Plan {
    pub condensed: CondensedMatrix,
    pub blocks: Vec<Block>,
    /// Block at which elimination from both ends meets.
    pub twist: usize,
    /// Number of unknowns including padding.
    pub places: usize,
    /// Every block except the twist, paired with its next one, in the order of elimination. The order alternates between both ends, so
    /// that consecutive steps are independent. If two threads share the work, the steps from the left come first.
    pub steps: Vec<[u32; 2]>,
    /// True if two threads share the steps.
    pub apart: bool,
    /// Numbers of factor values, in the order in which they are read: on the way to the twist, and back.
    pub numbers: [usize; 2],
    pub kept: Vec<RetainedUnknown>,
    /// Destination and entry, block by block.
    pub sources: Vec<[u32; 2]>,
    /// Destination, entry and pair of the entries in the column of an eliminated unknown.
    pub folded: Vec<[u32; 3]>,
    /// Row index, pair and entry of each entry in the column of an eliminated unknown.
    pub shifts: Vec<[u32; 3]>,
}

impl Plan {
    /// None if a solution would need more than `most` products, if a number exceeds 32 bits, or if there are no unknowns for blocks.
    pub fn new(pattern: &Pattern, most: usize) -> Option<Self> {
        let n = pattern.columns();
        u32::try_from(pattern.entries()).ok()?;
        let condensed = CondensedMatrix::new(pattern, |_| true);
        let (node_of, unknown_of) = nodes(&condensed, n);
        let row_node = row_nodes(&condensed, &node_of);
        let edges = edges(pattern, &condensed, &node_of, &row_node);
        let graph = Graph::new(unknown_of.len(), &edges);
        let levels = together(graph.levels());
        if levels.is_empty() {
            return None;
        }
        let mut level_of = vec![0_u32; unknown_of.len()];
        for (level, nodes) in levels.iter().enumerate() {
            nodes.iter().for_each(|k| level_of[*k as usize] = level as u32);
        }
        let twist = middle(&levels);
        let mut blocks = vec![Block::default(); levels.len()];
        let mut place_of = vec![0_u32; unknown_of.len()];
        let mut at = 0;
        let mut reaches = vec![[0..0, 0..0]; levels.len()];
        for (j, nodes) in levels.iter().enumerate() {
            let neighbours = if j <= twist {
                [j.wrapping_sub(1), j + 1]
            } else {
                [j + 1, j - 1]
            };
            let touches = |node: u32, level: usize| {
                graph
                    .neighbours(node)
                    .iter()
                    .any(|other| level_of[*other as usize] as usize == level)
            };
            let [mut first, mut both, mut second, mut rest] = [vec![], vec![], vec![], vec![]];
            for &node in nodes {
                let to = match neighbours.map(|level| touches(node, level)) {
                    [true, false] => &mut first,
                    [true, true] => &mut both,
                    [false, true] => &mut second,
                    [false, false] => &mut rest,
                };
                to.push(node);
            }
            let outer = 0..first.len() + both.len();
            let inner = first.len()..first.len() + both.len() + second.len();
            reaches[j] = [outer, inner];
            let own = first.iter().chain(&both).chain(&second).chain(&rest);
            for (k, node) in own.enumerate() {
                place_of[*node as usize] = u32::try_from(at + k).ok()?;
            }
            let filling = if j == twist { LANES } else { 0 };
            blocks[j] = Block {
                at,
                size: nodes.len(),
                rows: padded(nodes.len()) + filling,
                ..Block::default()
            };
            at += blocks[j].rows;
        }
        let apart = at >= LARGE / 2;
        let steps = if apart {
            left_first(blocks.len(), twist)
        } else {
            steps(blocks.len(), twist)
        };
        let mut numbers = [0, 0];
        for &[j, inner] in &steps {
            let side = usize::from(inner as usize == twist && j > inner);
            let theirs = reaches[inner as usize][side].clone();
            let block = &mut blocks[j as usize];
            (block.mine, block.theirs) = (reaches[j as usize][1].clone(), theirs);
            let [square, _, column] = block.room();
            block.numbers[0] = numbers[0];
            numbers[0] += square + column;
        }
        for &[j, _] in steps.iter().rev() {
            let block = &mut blocks[j as usize];
            block.numbers[1] = numbers[1];
            numbers[1] += block.rows * block.theirs.len();
        }
        blocks[twist].numbers = numbers;
        numbers[0] += blocks[twist].room()[0];
        if blocks.iter().map(Block::products).sum::<usize>() > most {
            return None;
        }
        let kept = unknown_of.iter().enumerate().map(|(node, &unknown)| RetainedUnknown {
            at: place_of[node],
            row: condensed.row[unknown as usize],
            unknown,
        });
        let mut kept: Vec<RetainedUnknown> = kept.collect();
        kept.sort_unstable_by_key(|kept| kept.at);
        let mut this = Self {
            kept,
            blocks,
            twist,
            places: at,
            steps,
            apart,
            numbers,
            sources: vec![],
            folded: vec![],
            shifts: vec![],
            condensed,
        };
        this.lay(pattern, [&node_of, &row_node, &place_of, &level_of])?;
        Some(this)
    }

    /// Computes the destination of every entry.
    fn lay(&mut self, pattern: &Pattern, [node_of, row_node, place_of, level_of]: [&[u32]; 4]) -> Option<()> {
        let mut sources: Vec<(u32, [u32; 2])> = vec![];
        let mut folded: Vec<(u32, [u32; 3])> = vec![];
        for column in 0..pattern.columns() {
            let pair = self.condensed.by[column];
            let to = node_of[self.condensed.joins(column)] as usize;
            for entry in pattern.column(column) {
                let from = row_node[pattern.rows[entry] as usize];
                if from == NONE {
                    continue;
                }
                let from = from as usize;
                let (level, destination) =
                    self.destination([(level_of[from], place_of[from]), (level_of[to], place_of[to])])?;
                match pair {
                    None => sources.push((level, [destination, entry as u32])),
                    Some(pair) => {
                        folded.push((level, [destination, entry as u32, pair]));
                        self.shifts.push([place_of[from], pair, entry as u32]);
                    }
                }
            }
        }
        let blocks = self.blocks.len();
        let (sources, ends) = groups(blocks, sources.into_iter());
        let (folded, folded_ends) = groups(blocks, folded.into_iter());
        for (level, block) in self.blocks.iter_mut().enumerate() {
            block.sources = ends[level]..ends[level + 1];
            block.folded = folded_ends[level]..folded_ends[level + 1];
        }
        (self.sources, self.folded) = (sources, folded);
        Some(())
    }

    /// Returns the block that assembles an entry, and the position in its work space, see [`Block::room`]. Row and column are given by
    /// level and place.
    fn destination(&self, [row, column]: [(u32, u32); 2]) -> Option<(u32, u32)> {
        let of = |(level, place): (u32, u32)| {
            let block = &self.blocks[level as usize];
            (block, place as usize - block.at)
        };
        let ((row_block, r), (column_block, c)) = (of(row), of(column));
        let far = |level: u32| (level as usize).abs_diff(self.twist);
        let (level, to) = if row.0 == column.0 {
            (row.0, c * row_block.rows + r)
        } else if far(row.0) > far(column.0) {
            // beside the block, in its rows
            let [square, ..] = row_block.room();
            let (r, c) = (r - row_block.mine.start, c - row_block.theirs.start);
            (row.0, square + c * row_block.mine.len() + r)
        } else {
            let block = column_block;
            let [square, beside, _] = block.room();
            let (r, c) = (r - block.theirs.start, c - block.mine.start);
            let rows = padded(block.theirs.len());
            (column.0, square + beside + place(r, c, rows, block.mine.len()))
        };
        Some((level, u32::try_from(to).ok()?))
    }
}

const NONE: u32 = u32::MAX;

/// Number of each unknown among the remaining ones, and the list of remaining unknowns.
fn nodes(condensed: &CondensedMatrix, n: usize) -> (Vec<u32>, Vec<u32>) {
    let mut node_of = vec![NONE; n];
    let mut unknown_of = vec![];
    for unknown in (0..n).filter(|&k| condensed.by[k].is_none()) {
        node_of[unknown] = unknown_of.len() as u32;
        unknown_of.push(unknown as u32);
    }
    (node_of, unknown_of)
}

/// Remaining unknown paired with each row.
fn row_nodes(condensed: &CondensedMatrix, node_of: &[u32]) -> Vec<u32> {
    let mut row_node = vec![NONE; node_of.len()];
    for (unknown, &node) in node_of.iter().enumerate().filter(|(_, node)| **node != NONE) {
        row_node[condensed.row[unknown] as usize] = node;
    }
    row_node
}

fn edges(pattern: &Pattern, condensed: &CondensedMatrix, node_of: &[u32], row_node: &[u32]) -> Vec<[u32; 2]> {
    let mut edges = vec![];
    for column in 0..pattern.columns() {
        let to = node_of[condensed.joins(column)];
        for entry in pattern.column(column) {
            let from = row_node[pattern.rows[entry] as usize];
            if from != NONE && from != to {
                edges.push([from, to]);
            }
        }
    }
    edges
}

/// Merges small neighboring levels.
fn together(levels: Vec<Vec<u32>>) -> Vec<Vec<u32>> {
    let mut joined: Vec<Vec<u32>> = vec![];
    for level in levels {
        match joined.last_mut() {
            Some(last) if last.len() + level.len() <= TOGETHER => last.extend(level),
            _ => joined.push(level),
        }
    }
    joined
}

fn steps(blocks: usize, twist: usize) -> Vec<[u32; 2]> {
    let last = blocks - 1;
    let mut steps = vec![];
    for turn in 0..twist.max(last - twist) {
        if turn < twist {
            steps.push([turn as u32, turn as u32 + 1]);
        }
        if turn < last - twist {
            steps.push([(last - turn) as u32, (last - turn) as u32 - 1]);
        }
    }
    steps
}

/// Steps in the order from the left end first, then from the right end.
fn left_first(blocks: usize, twist: usize) -> Vec<[u32; 2]> {
    let left = (0..twist as u32).map(|j| [j, j + 1]);
    let right = (twist as u32 + 1..blocks as u32).rev().map(|j| [j, j - 1]);
    left.chain(right).collect()
}

/// Level at which the work before and after it is balanced.
fn middle(levels: &[Vec<u32>]) -> usize {
    let work = |level: &Vec<u32>| (level.len() * level.len()) as u64;
    let all: u64 = levels.iter().map(work).sum();
    let mut before = 0;
    for (k, level) in levels.iter().enumerate() {
        before += work(level);
        if 2 * before >= all {
            return k;
        }
    }
    levels.len() - 1
}
