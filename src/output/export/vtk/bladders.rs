//! The bladders as boxes that move with their segments, divided across the width into their fluid cells.

use super::curve::SectionPosition;
use super::cutout::Cutout;
use super::surface::{Data, Surface};
use crate::case::wiring::bladder_index;
use crate::model::Wet;

/// A bladder and its fluid cells.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bladder {
    /// Label `R j`: positive in the upper row, negative in the lower.
    pub label: i64,
    /// Number of the network it belongs to, from 1.
    pub network: i32,
    /// Index of its first cell in the recorded fields, which run from inlet to outlet.
    pub first: usize,
    /// Side on which its inlet is: -1 or 1 along the width.
    pub inlet: f64,
}

/// All bladders in the order of the recorded fields.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CutoutLayout {
    /// The bladders.
    pub bladders: Vec<Bladder>,
    /// Fluid cells in each.
    pub cells: usize,
}

impl CutoutLayout {
    /// Arranges the bladders; `labels` is the bladder of each recorded cell. Inlets alternate sides along a chain: tubes join neighbors.
    pub fn new(wet: &Wet, labels: &[f64]) -> Self {
        let cells = labels.iter().take_while(|l| **l == labels[0]).count().max(1);
        let bladders = labels.iter().enumerate().step_by(cells).filter_map(|(first, &label)| {
            let label = label.round() as i64;
            let index = bladder_index(label, wet.per_row).filter(|index| wet.has(*index))?;
            let place = wet
                .network
                .chains
                .iter()
                .find_map(|c| c.iter().position(|b| *b == index));
            Some(Bladder {
                label,
                network: wet.network.component_of_bladder[index] as i32 + 1,
                first,
                inlet: if place.unwrap_or(0) % 2 == 0 { -1.0 } else { 1.0 },
            })
        });
        Self {
            bladders: bladders.collect(),
            cells,
        }
    }
}

/// The boxes, with pressure [Pa] and area change [m^2] of each fluid cell.
pub(super) fn surface(
    cutout: &Cutout,
    layout: &CutoutLayout,
    sections: &[SectionPosition],
    pressure: &[f64],
    area: &[f64],
) -> Surface {
    let mut out = Surface::default();
    let mut owners: Vec<(usize, usize)> = vec![];
    for (number, bladder) in layout.bladders.iter().enumerate() {
        let Some(window) = cutout.window(bladder.label) else {
            continue;
        };
        let apart = 1e-9 * cutout.length;
        let within = |s: &&SectionPosition| s.theta >= window[0] - apart && s.theta <= window[1] + apart;
        let along: Vec<&SectionPosition> = sections.iter().filter(within).collect();
        shape(&mut out, cutout, bladder, &along, layout.cells, |cell| {
            owners.push((number, cell))
        });
    }
    let of = |f: &dyn Fn(&Bladder) -> i64| owners.iter().map(|o| f(&layout.bladders[o.0]) as i32).collect();
    let field = |values: &[f64]| {
        owners
            .iter()
            .map(|o| values[layout.bladders[o.0].first + o.1])
            .collect()
    };
    out.of_cells = vec![
        Data::scalar("pressure_pa", field(pressure)),
        Data::scalar("area_change_m2", field(area)),
        Data::number("bladder", of(&|b| b.label)),
        Data::number("row", of(&|b| b.label.signum())),
        Data::number("network", of(&|b| i64::from(b.network))),
    ];
    out
}

/// Adds points and quadrilaterals of one box. Calls `owned` with the fluid cell of each quadrilateral.
fn shape(
    out: &mut Surface,
    cutout: &Cutout,
    bladder: &Bladder,
    along: &[&SectionPosition],
    cells: usize,
    mut owned: impl FnMut(usize),
) {
    let first = out.points.len();
    let [low, high] = match bladder.label > 0 {
        true => cutout.row,
        false => [-cutout.row[1], -cutout.row[0]],
    };
    // Slices run from one side of the beam to the other, on whichever side the inlet is. All faces then point outwards.
    for section in along {
        for slice in 0..=cells {
            let across = cutout.half_across * (2.0 * slice as f64 / cells as f64 - 1.0);
            out.points.extend([low, high].map(|h| section.point(h, across)));
        }
    }
    let at = |k: usize, slice: usize, top: usize| first + 2 * (k * (cells + 1) + slice) + top;
    let cell_of = |slice: usize| if bladder.inlet < 0.0 { slice } else { cells - 1 - slice };
    let last = along.len() - 1;
    for s in 0..cells {
        let mut face = |quad: [usize; 4]| {
            out.quads.push(quad);
            owned(cell_of(s));
        };
        for k in 0..last {
            face([at(k, s, 0), at(k + 1, s, 0), at(k + 1, s + 1, 0), at(k, s + 1, 0)]);
            face([at(k, s, 1), at(k, s + 1, 1), at(k + 1, s + 1, 1), at(k + 1, s, 1)]);
            if s == 0 {
                face([at(k, 0, 0), at(k, 0, 1), at(k + 1, 0, 1), at(k + 1, 0, 0)]);
            }
            if s + 1 == cells {
                face([
                    at(k, s + 1, 0),
                    at(k + 1, s + 1, 0),
                    at(k + 1, s + 1, 1),
                    at(k, s + 1, 1),
                ]);
            }
        }
        face([at(0, s, 0), at(0, s + 1, 0), at(0, s + 1, 1), at(0, s, 1)]);
        face([at(last, s, 0), at(last, s, 1), at(last, s + 1, 1), at(last, s + 1, 0)]);
    }
}
