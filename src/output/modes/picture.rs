//! Picture of the shapes of modes, with pressures.

use nalgebra::Complex;

use super::{Report, table};
use crate::discrete::quantities::{FieldAxis, PlacedNodes};
use crate::output::plot::canvas::{INK, LineStyle};
use crate::output::plot::colour::{Colour, PALETTE};
use crate::output::plot::deflection::structure_panel;
use crate::output::plot::picture::{Panel, Picture, PictureAxis, PictureSeries};
use crate::run::modes::{Mode, ModeShape};

/// Largest number of modes drawn.
const DRAWN: usize = 8;

/// Picture of the shapes: displacements on the left, pressures on the right.
pub(super) fn drawn(report: &Report) -> Option<String> {
    let system = report.found.about.system();
    let theta = FieldAxis::Nodes.values(system, 0.0);
    let placed = PlacedNodes::new(system);
    let per_row = system.model.wet.as_ref().map_or(0, |w| w.per_row);
    let numbers: Vec<f64> = (1..=per_row).map(|j| j as f64).collect();
    let along = PictureAxis::new("material coordinate θ", "m", 6).between(*theta.first()?, *theta.last()?);
    let row = |(k, mode): (usize, &Mode)| {
        let shape = &mode.shape;
        let beam = [(&shape.u1[..], "u₁ across"), (&shape.u3, "u₃ along")];
        let mut left = match &placed {
            Some(placed) => structure_shape(placed, shape)?,
            None => complex(along.clone(), &theta, beam, ("u", "m")),
        };
        left.heading.1.bold = true;
        left.heading.1.colour = if mode.kind.grows() { UNSTABLE } else { INK };
        left = left.headed(format!("{}  {}", k + 1, table::describe(mode)));
        let wet = per_row > 0 && shape.pressure.len() == 2 * per_row;
        let right = wet.then(|| {
            let (upper, lower) = shape.pressure.split_at(per_row);
            let name = if placed.is_some() {
                "bladder, along all beams"
            } else {
                "bladder"
            };
            let x = PictureAxis::new(name, "1", 10).between(0.5, per_row as f64 + 0.5);
            complex(x, &numbers, [(upper, "upper row"), (lower, "lower row")], ("p", "Pa"))
        });
        Some([left].into_iter().chain(right).collect())
    };
    let lines = match &placed {
        Some(_) => {
            "shapes enlarged, two opposite instants; of pressures full lines in phase, dashed a quarter of a period behind"
        }
        None => "full lines in phase, dashed a quarter of a period behind",
    };
    let modes = report.found.modes.iter();
    let picture = Picture {
        title: format!("{} · modes", report.case),
        about: format!("about {}; {lines}", report.about()),
        rows: modes.take(DRAWN).enumerate().map(row).collect::<Option<_>>()?,
    };
    picture.svg()
}

/// Largest displacement of a drawn mode shape, relative to the size of the structure.
const ENLARGED: f64 = 0.12;

/// Panel of the shape of a structure at the instant of its largest real part, and half a period later.
fn structure_shape(placed: &PlacedNodes, shape: &ModeShape) -> Option<Panel> {
    let all = || shape.u1.iter().chain(&shape.u3);
    let largest = all().fold(0.0_f64, |most, u| most.max(u.norm()));
    let turn = all()
        .max_by(|a, b| a.norm().total_cmp(&b.norm()))
        .map_or(0.0, |u| u.arg());
    let factor = if largest > 0.0 {
        ENLARGED * placed.size() / largest
    } else {
        0.0
    };
    let at = |size: f64, colour: Colour| {
        let real = |u: &[Complex<f64>]| -> Vec<f64> {
            let of = |u: &Complex<f64>| size * (u * Complex::from_polar(1.0, -turn)).re;
            u.iter().map(of).collect()
        };
        let line = placed.line(&real(&shape.u1), &real(&shape.u3));
        PictureSeries::line(line, LineStyle::solid(colour, 1.6))
    };
    let both = vec![at(-factor, PALETTE[1]), at(factor, PALETTE[0])];
    structure_panel(placed, both, 260.0)
}

/// Panel of two complex curves over an axis.
fn complex(x: PictureAxis, xs: &[f64], lines: [(&[Complex<f64>], &str); 2], (name, unit): (&str, &str)) -> Panel {
    let all = lines.iter().flat_map(|(y, _)| y.iter());
    let size = all.fold(0.0_f64, |m, y| m.max(y.re.abs()).max(y.im.abs()));
    let mut series = vec![];
    for ((y, name), colour) in lines.into_iter().zip(PALETTE) {
        let part = |of: fn(&Complex<f64>) -> f64| xs.iter().copied().zip(y.iter().map(of));
        // a curve that is in phase throughout has no imaginary part to draw
        if y.iter().any(|y| y.im.abs() > 1e-3 * size) {
            let behind = LineStyle::dashed(colour, 1.1, (4.0, 3.0));
            series.push(PictureSeries::line(part(|y| y.im), behind));
        }
        let ahead = PictureSeries::line(part(|y| y.re), LineStyle::solid(colour, 1.6));
        series.push(ahead.named(name));
    }
    let floor = (1e-3 * size).max(f64::MIN_POSITIVE.sqrt());
    let y = PictureAxis::new(name, unit, 3).with(&[0.0]).above(floor);
    Panel::new((380.0, 112.0), x, y, series)
}

const UNSTABLE: Colour = Colour(0xb0, 0x1c, 0x2e);
