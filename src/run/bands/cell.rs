//! The repeating cell of a beam, read from the middle of its linearized equations.

use std::collections::BTreeMap;

use crate::error::{Error, Result};
use crate::run::modes::Linearised;

/// Relative difference of equal equations.
const EQUAL: f64 = 1e-8;
/// Smallest number of cells along a beam: two that are compared, and one beside each.
const CELLS: usize = 4;
/// Mesh cells in a segment beyond which no difference formula of the beam reaches.
const FEWEST: usize = 4;
/// Segments at each end of a longer beam whose equations the end may change.
const ENDS: usize = 2;

/// A cell of the beam that repeats along it: one or several segments, their bladders, and the tubes that lead from it toward the tip.
#[derive(Clone, Debug, PartialEq)]
pub struct RepeatingCell {
    /// Segments of the cell.
    pub segments: usize,
    /// First segment of the cell.
    pub first: usize,
    /// Length of the cell [m].
    pub length: f64,
    /// First segments of other cells that differ, apart from the ends of the beam.
    pub others: Vec<usize>,
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
    /// The shortest cell that repeats along the beam, or else in its middle.
    ///
    /// # Errors
    /// [`Error::Usage`] if no cell repeats, with the reason for a cell of one segment.
    pub fn new(about: &Linearised) -> Result<Self> {
        if about.system().model.structure.is_some() {
            let what = "bands: the case has several beams, but waves are those of one. Use a case without /beams";
            return Err(Error::Usage(what.into()));
        }
        let segments = about.system().mesh.segments;
        let (mut reason, mut in_the_middle) = (None, None::<Self>);
        for period in 1..=segments / CELLS {
            match Self::of_segments(about, period) {
                // a longer cell is one only if cells in it differ
                Ok(cell) if cell.others.is_empty() => match &in_the_middle {
                    Some(shorter) if !cell.contains_any(&shorter.others) => {}
                    _ => return Ok(cell),
                },
                Ok(cell) => _ = in_the_middle.get_or_insert(cell),
                Err(why) => _ = reason.get_or_insert(why),
            }
            // with few mesh cells in a segment its difference formulas reach beyond the adjacent ones
            if about.system().mesh.cells_per_segment < FEWEST && reason.is_some() {
                break;
            }
        }
        if let Some(cell) = in_the_middle {
            return Ok(cell);
        }
        let why = reason.unwrap_or_else(|| format!("the beam has {segments} of at least {CELLS} segments"));
        Err(Error::Usage(format!(
            "bands: no cell repeats along the beam: {why}. Bands need a straight start (--set /start=null), several equal cells \
             (/mesh/segments), the same wiring in each (/network/chains), and some mesh cells in each (/mesh/cells_per_segment)"
        )))
    }

    fn of_segments(about: &Linearised, period: usize) -> std::result::Result<Self, String> {
        let system = about.system();
        let segments = system.mesh.segments;
        let first = (segments - CELLS * period) / 2 + period;
        let place = Places::new(about, first, period);
        let unknowns = [-1, 0, 1].map(|cell| place.cells.get(&cell).cloned().unwrap_or_default());
        let entries = place.entries(about, 0)?;
        // the ends change the equations of the segments beside them
        let ends = if segments >= CELLS * period + 2 * ENDS { ENDS } else { 1 };
        let ends = ends as i64;
        let segment = |cell: i64| first as i64 + cell * period as i64;
        let inside = |cell: &i64| {
            let [before, own, behind, last] = [-1, 0, 1, 2].map(|k| segment(cell + k));
            before >= 0 && own >= ends && behind <= segments as i64 - ends && last <= segments as i64
        };
        let unlike = |cell: i64| -> Option<String> {
            if place.count(cell) != place.count(0) || place.count(cell + 1) != place.count(1) {
                return Some("the segments have unlike unknowns".into());
            }
            let row = match place.entries(about, cell) {
                Ok(other) => differing(&entries, &other)?,
                Err(why) => return Some(why),
            };
            let name = system.layout.name(unknowns[1][row]);
            Some(format!("the equation of {name} is not repeated in each cell"))
        };
        if place.count(-1) != place.count(0) || place.count(0) == 0 {
            return Err("the segments in its middle have unlike unknowns".into());
        }
        if let Some(why) = unlike(1) {
            return Err(why);
        }
        let others = place.cells.keys().copied().filter(inside);
        let others = others
            .filter(|cell| unlike(*cell).is_some())
            .map(|cell| segment(cell) as usize);
        let others = others.collect();
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
            others,
            unknowns,
            entries: entries.collect(),
        })
    }

    /// True if one of the segments is in the cell.
    fn contains_any(&self, segments: &[usize]) -> bool {
        let own = self.first..self.first + self.segments;
        segments.iter().any(|segment| own.contains(segment))
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

/// Equation in which two cells differ by more than rounding errors.
fn differing(one: &EntriesByPlace, other: &EntriesByPlace) -> Option<usize> {
    let mut largest = BTreeMap::<usize, [f64; 2]>::new();
    for ((row, ..), values) in one {
        let largest = largest.entry(*row).or_default();
        *largest = [0, 1].map(|k| values[k].abs().max(largest[k]));
    }
    let at = |entries: &EntriesByPlace, key| entries.get(key).copied().unwrap_or_default();
    let keys = one.keys().chain(other.keys());
    let mut unlike = keys.filter(|key| {
        let [a, b] = [at(one, key), at(other, key)];
        let largest = largest.get(&key.0).copied().unwrap_or_default();
        (0..2).any(|k| (a[k] - b[k]).abs() > EQUAL * largest[k])
    });
    unlike.next().map(|key| key.0)
}

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
