//! Surface of the beam: its rectangular section swept along the deformed curve, with windows that show the bladders.

use super::curve::{Curve, SectionPosition};
use super::cutout::Cutout;
use super::surface::{Data, Surface};
use crate::numerics::Planar;

/// Surface of the beam. Points have the data of their section's center, quadrilaterals those of their beam cell; `field` returns a recorded
/// field at the instant, `turn` is the angle from z towards x of the straight beam [rad].
pub(super) fn surface<'a>(
    cutout: &Cutout,
    curve: &Curve,
    sections: &[SectionPosition],
    field: &dyn Fn(&str) -> &'a [f64],
    turn: f64,
) -> Surface {
    let force = field("normal_force_n");
    let heights = cutout.heights();
    let m = heights.len();
    let mut out = Surface::default();
    // Station of each point.
    let mut stations = vec![];
    for (k, section) in sections.iter().enumerate() {
        for side in [-1.0, 1.0] {
            let across = side * cutout.half_width;
            out.points.extend(heights.iter().map(|&h| section.point(h, across)));
        }
        stations.resize(out.points.len(), k);
    }
    // Point at a station, on the left (0) or right (1) side, at a height.
    let at = |k: usize, side: usize, i: usize| (2 * k + side) * m + i;
    let mut cells = vec![];
    for (k, pair) in sections.windows(2).enumerate() {
        let open = cutout.beside_bladder(pair[0].theta, pair[1].theta);
        // The sides are divided at the edges of the rows; every second strip is a row.
        let mut face = |corners: [usize; 4]| out.quads.push(corners);
        for i in (0..m - 1).filter(|i| !(open && i % 2 == 1)) {
            face([at(k, 1, i), at(k + 1, 1, i), at(k + 1, 1, i + 1), at(k, 1, i + 1)]);
            face([at(k, 0, i), at(k, 0, i + 1), at(k + 1, 0, i + 1), at(k + 1, 0, i)]);
        }
        let top = m - 1;
        face([at(k, 0, 0), at(k + 1, 0, 0), at(k + 1, 1, 0), at(k, 1, 0)]);
        face([at(k, 0, top), at(k, 1, top), at(k + 1, 1, top), at(k + 1, 0, top)]);
        cells.resize(out.quads.len(), curve.cell(pair[0].theta, pair[1].theta));
    }
    let last = sections.len() - 1;
    out.quads
        .extend((0..m - 1).map(|i| [at(0, 0, i), at(0, 1, i), at(0, 1, i + 1), at(0, 0, i + 1)]));
    cells.resize(out.quads.len(), 0);
    out.quads
        .extend((0..m - 1).map(|i| [at(last, 0, i), at(last, 0, i + 1), at(last, 1, i + 1), at(last, 1, i)]));
    cells.resize(out.quads.len(), force.len() - 1);

    reveals(&mut out, cutout, sections, &mut stations, |from, to| {
        cells.push(curve.cell(from, to))
    });

    let each = |name: &str| -> Vec<f64> {
        let at_station = sections.iter().map(|s| curve.interpolate(s.theta, field(name)));
        let at_station: Vec<f64> = at_station.collect();
        stations.iter().map(|&k| at_station[k]).collect()
    };
    let vector = |axial: &str, transverse: &str| -> Vec<f64> {
        let both = each(axial).into_iter().zip(each(transverse));
        let direction = Planar::tangent(turn);
        let placed = both.map(|(a, t)| Planar::new(t, a).turned(direction));
        placed.flat_map(|v| [v.z, v.x, 0.0]).collect()
    };
    out.of_points = vec![
        Data::vector("u_m", vector("u3_m", "u1_m")),
        Data::vector("v_m_s", vector("v3_m_s", "v1_m_s")),
        Data::scalar("curvature_1_m", each("curvature_1_m")),
        Data::scalar("moment_n_m", each("moment_n_m")),
        Data::scalar("theta_m", stations.iter().map(|&k| sections[k].theta).collect()),
    ];
    let forces = cells.iter().map(|&c| force[c]).collect();
    out.of_cells = vec![Data::scalar("normal_force_n", forces)];
    out
}

/// Walls of the windows, from the beam's sides to the bladders' ends. Calls `owned` with the coordinates between which each wall lies.
fn reveals(
    out: &mut Surface,
    cutout: &Cutout,
    sections: &[SectionPosition],
    stations: &mut Vec<usize>,
    mut owned: impl FnMut(f64, f64),
) {
    let apart = 1e-9 * cutout.length;
    let rows = [[-cutout.row[1], -cutout.row[0]], cutout.row];
    let depths = [cutout.half_width, cutout.half_across];
    if depths[0] - depths[1] <= apart {
        return;
    }
    for window in cutout.windows.iter().filter(|window| window[0] < window[1]) {
        let within = |k: &usize| (window[0] - apart..=window[1] + apart).contains(&sections[*k].theta);
        let along: Vec<usize> = (0..sections.len()).filter(within).collect();
        let last = along.len() - 1;
        let theta = |k: usize| sections[along[k]].theta;
        for (side, row) in [-1.0, 1.0].into_iter().flat_map(|side| rows.map(|row| (side, row))) {
            let first = out.points.len();
            for &k in &along {
                for across in depths {
                    out.points.extend(row.map(|h| sections[k].point(h, side * across)));
                }
                stations.resize(out.points.len(), k);
            }
            // Point at a station of the window, outer (0) or inner (1), low (0) or high (1).
            let at = |k: usize, depth: usize, top: usize| first + 4 * k + 2 * depth + top;
            for (k, top) in (0..last).flat_map(|k| [(k, 0), (k, 1)]) {
                out.quads
                    .push([at(k, 0, top), at(k + 1, 0, top), at(k + 1, 1, top), at(k, 1, top)]);
                owned(theta(k), theta(k + 1));
            }
            for (k, next) in [(0, 1), (last, last - 1)] {
                out.quads.push([at(k, 0, 0), at(k, 0, 1), at(k, 1, 1), at(k, 1, 0)]);
                owned(theta(k), theta(next));
            }
        }
    }
}
