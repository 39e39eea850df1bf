//! The repeating cell of a beam, read from the middle of its linearized equations.

use std::collections::BTreeMap;

use crate::error::{Error, Result};
use crate::run::modes::Linearised;

/// Relative difference of equal equations.
const EQUAL: f64 = 1e-8;
/// Smallest number of cells along a beam: two that are compared, and one beside each.
const CELLS: usize = 4;

/// A cell of the beam that repeats along it: one or several segments, their bladders, and the tubes that lead from it toward the tip.
#[derive(Clone, Debug, PartialEq)]
pub struct RepeatingCell {
    /// Segments of the cell.
    pub segments: usize,
    /// First segment of the cell.
    pub first: usize,
    /// Length of the cell [m].
    pub length: f64,
    /// Unknowns of the cell before it, of the cell and of the cell behind it, by their numbers in the beam, in the same order.
    pub unknowns: [Vec<usize>; 3],
    /// Entries of its equations.
    pub entries: Vec<CellEntry>,
}

/// An entry of the equations of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellEntry {
    /// Equation.
    pub row: usize,
    /// Unknown of the cell in which it is.
    pub column: usize,
    /// 0 for an unknown of the cell toward the root, 1 of the cell, 2 of the cell toward the tip.
    pub cell: usize,
    /// Entries of A and B.
    pub values: [f64; 2],
}

impl RepeatingCell {
    /// The shortest cell that repeats in the middle of a beam.
    ///
    /// # Errors
    /// [`Error::Usage`] if no cell repeats, with the reason for a cell of one segment.
    pub fn new(about: &Linearised) -> Result<Self> {
        let segments = about.system().mesh.segments;
        let mut reason = None;
        for period in 1..=segments / CELLS {
            match Self::of_segments(about, period) {
                Ok(cell) => return Ok(cell),
                Err(why) => _ = reason.get_or_insert(why),
            }
        }
        let why = reason.unwrap_or_else(|| format!("the beam has {segments} of at least {CELLS} segments"));
        Err(Error::Usage(format!(
            "bands: no cell repeats along the beam: {why}. Bands need a straight start (--set /start=null), several equal cells \
             (/mesh/segments), the same wiring in each (/network/chains), and some mesh cells in each (/mesh/cells_per_segment)"
        )))
    }

    fn of_segments(about: &Linearised, period: usize) -> std::result::Result<Self, String> {
        let system = about.system();
        let before = (system.mesh.segments - CELLS * period) / 2;
        let first = before + period;
        let place = Places::new(about, first, period);
        let [all @ .., _] = [-1, 0, 1, 2].map(|cell| place.cells.get(&cell).cloned().unwrap_or_default());
        let name = |unknown: usize| system.layout.name(unknown);
        let [entries, next] = [0, 1].map(|cell| place.entries(about, cell));
        let (entries, next) = (entries?, next?);
        let alike = (-1..2).all(|cell| place.count(cell) == place.count(cell + 1));
        let largest = |k: usize| entries.values().map(|values| values[k].abs()).fold(0.0, f64::max);
        let largest = [0, 1].map(largest);
        let differing = entries.iter().find(|(key, values)| {
            let close = |other: &[f64; 2]| (0..2).all(|k| (values[k] - other[k]).abs() <= EQUAL * largest[k]);
            !next.get(key).is_some_and(close)
        });
        let more = next.keys().find(|key| !entries.contains_key(key));
        let unlike = differing.map(|(key, _)| key).or(more);
        if let Some(&(row, ..)) = unlike
            && let Some(row) = all[1].get(row)
        {
            return Err(format!(
                "the equation of {} is not repeated in the next cell",
                name(*row)
            ));
        }
        if !alike || unlike.is_some() || all[1].is_empty() {
            return Err("the segments in its middle have unlike unknowns".into());
        }
        let entries = entries.into_iter().map(|((row, cell, column), values)| CellEntry {
            row,
            column,
            cell,
            values,
        });
        Ok(Self {
            segments: period,
            first,
            length: system.mesh.segment_lengths[first..first + period].iter().sum(),
            unknowns: all,
            entries: entries.collect(),
        })
    }

    /// Number of unknowns.
    pub fn len(&self) -> usize {
        self.unknowns[1].len()
    }

    /// True without unknowns.
    pub fn is_empty(&self) -> bool {
        self.unknowns[1].is_empty()
    }
}

/// Entries of A and B by row, cell and column.
type EntriesByPlace = BTreeMap<(usize, usize, usize), [f64; 2]>;

/// Cells of unknowns, counted from the first one in the middle, and places in them.
struct Places {
    cells: BTreeMap<i64, Vec<usize>>,
    of: Vec<Option<(i64, usize)>>,
}

impl Places {
    /// Unknowns of beam and bladders have a segment. Those of the network belong to the first cell to which they are connected, in the
    /// order of their connections.
    fn new(about: &Linearised, first: usize, period: usize) -> Self {
        let system = about.system();
        let (layout, pencil) = (&system.layout, about.pencil());
        let per_segment = system.mesh.cells_per_segment;
        let mut places = Self {
            cells: BTreeMap::new(),
            of: vec![None; layout.len],
        };
        for unknown in 0..layout.len {
            if let Some(segment) = layout.segment(unknown, per_segment) {
                places.add((segment as i64 - first as i64).div_euclid(period as i64), unknown);
            }
        }
        let mut beside = vec![vec![]; layout.len];
        for column in 0..layout.len {
            for entry in pencil.pattern.column(column) {
                let row = pencil.pattern.rows[entry] as usize;
                if pencil.a[entry] != 0.0 || pencil.b[entry] != 0.0 {
                    beside[row].push(column);
                    beside[column].push(row);
                }
            }
        }
        loop {
            let connected = |unknown: usize| {
                let mut all: Vec<(i64, usize)> = beside[unknown].iter().filter_map(|k| places.of[*k]).collect();
                all.sort_unstable();
                all.dedup();
                let cell = all.first()?.0;
                all.iter_mut().for_each(|(other, _)| *other -= cell);
                Some((cell, all, unknown))
            };
            let open = (0..layout.len).filter(|unknown| places.of[*unknown].is_none());
            let mut found: Vec<_> = open.filter_map(connected).collect();
            if found.is_empty() {
                return places;
            }
            found.sort();
            for (cell, _, unknown) in found {
                places.add(cell, unknown);
            }
        }
    }

    fn add(&mut self, cell: i64, unknown: usize) {
        let all = self.cells.entry(cell).or_default();
        self.of[unknown] = Some((cell, all.len()));
        all.push(unknown);
    }

    fn count(&self, cell: i64) -> usize {
        self.cells.get(&cell).map_or(0, Vec::len)
    }

    /// Entries of the equations of a cell, or the reason why they reach beyond the adjacent cells.
    fn entries(&self, about: &Linearised, own: i64) -> std::result::Result<EntriesByPlace, String> {
        let (pencil, layout) = (about.pencil(), &about.system().layout);
        let mut all = BTreeMap::new();
        for column in 0..layout.len {
            for entry in pencil.pattern.column(column) {
                let unknown = pencil.pattern.rows[entry] as usize;
                let Some((cell, row)) = self.of[unknown].filter(|(cell, _)| *cell == own) else {
                    continue;
                };
                let values = [pencil.a[entry], pencil.b[entry]];
                if values == [0.0; 2] {
                    continue;
                }
                let place = self.of[column].map(|(other, place)| (other - cell + 1, place));
                let Some((beside @ 0..=2, place)) = place else {
                    return Err(format!(
                        "the equation of {} contains {}, which is not in an adjacent cell",
                        layout.name(unknown),
                        layout.name(column)
                    ));
                };
                all.insert((row, beside as usize, place), values);
            }
        }
        Ok(all)
    }
}
