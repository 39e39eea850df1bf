//! `map.svg`: growth over frequency and amplitude of the shaking, a panel a permeability; dashed: Mathieu's equation.

use super::canvas::{Anchor, Canvas, FAINT_INK, INK, Stroke, Words, picture};
use super::colour::Colour;
use super::panel::{Panel, Place, title};
use super::ticks::Scale;
use crate::output::numbers::significant;

/// One panel.
#[derive(Clone, Debug, PartialEq)]
pub struct TonguePanel {
    /// What stands above it.
    pub name: String,
    /// Growth rates [1/s] by frequency, then by amplitude; none where no cycle was found.
    pub growth: Vec<Vec<Option<f64>>>,
}

/// All that is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Tongue {
    /// Name of the case.
    pub case: String,
    /// Frequencies [Hz], ascending.
    pub frequencies: Vec<f64>,
    /// Amplitudes [m], ascending.
    pub amplitudes: Vec<f64>,
    /// Amplitude at which Mathieu's tongue begins, at each frequency [m].
    pub onset: Option<Vec<f64>>,
    /// Frequency and amplitude of the case itself.
    pub own: (f64, f64),
    /// Panels from left to right.
    pub panels: Vec<TonguePanel>,
}

const LEFT: f64 = 84.0;
const TOP: f64 = 84.0;
const WIDTH: f64 = 330.0;
const HEIGHT: f64 = 300.0;
const GAP: f64 = 34.0;
const BAR: f64 = 96.0;
/// Growth over the largest one below which a point counts as stable in the picture.
const NOTHING: f64 = 2e-3;
const STABLE: Colour = Colour(0xee, 0xf2, 0xf6);
const MISSING: Colour = Colour(0xc9, 0xcd, 0xd2);
/// Light to dark for growth from nothing to the largest.
const GROWTH: [[u8; 3]; 5] = [
    [0xfd, 0xe8, 0xc8],
    [0xf7, 0xb8, 0x7a],
    [0xe3, 0x6f, 0x45],
    [0xb5, 0x2b, 0x2b],
    [0x5f, 0x06, 0x1a],
];

/// Draws it; `None` when there is nothing to draw.
pub fn draw(data: &Tongue) -> Option<String> {
    let (first, last) = (*data.frequencies.first()?, *data.frequencies.last()?);
    let (low, high) = (*data.amplitudes.first()?, *data.amplitudes.last()?);
    let half_x = 0.5 * (last - first) / (data.frequencies.len() - 1).max(1) as f64;
    let half_y = 0.5 * (high - low) / (data.amplitudes.len() - 1).max(1) as f64;
    let grown = data.panels.iter().flat_map(|p| &p.growth).flatten().flatten();
    let most = grown.copied().filter(|g| g.is_finite()).fold(0.0, f64::max);
    let count = data.panels.len() as f64;
    let width = LEFT + count * WIDTH + (count - 1.0) * GAP + BAR;
    Some(picture(width.max(560.0), TOP + HEIGHT + 58.0, |canvas| {
        let about = "growth rate of the largest disturbance; dashed: principal tongue of Mathieu's equation, first mode, dry; ring: the case";
        title(canvas, 16.0, &format!("{} · shaken along its axis", data.case), about);
        for (k, sheet) in data.panels.iter().enumerate() {
            let panel = Panel::new(
                Place::new(LEFT + k as f64 * (WIDTH + GAP), TOP, WIDTH, HEIGHT),
                Scale::exact(first - half_x, last + half_x, "Hz", 6),
                Scale::exact(low - half_y, high + half_y, "m", 6),
            );
            cells(canvas, &panel, data, sheet, (half_x, half_y), most);
            overlay(canvas, &panel, data);
            let mut axes = panel.clone();
            if k > 0 {
                axes.y.ticks.clear();
                axes.y.unit.clear();
            }
            axes.axes(canvas, Some("frequency"), if k == 0 { "amplitude" } else { "" });
            let at = (panel.place.left + 0.5 * WIDTH, TOP - 14.0);
            canvas.text(at, &sheet.name, Words::new(12.5, Anchor::Centre));
        }
        bar(canvas, LEFT + count * WIDTH + (count - 1.0) * GAP + 24.0, most);
    }))
}

fn cells(canvas: &mut Canvas, panel: &Panel, data: &Tongue, sheet: &TonguePanel, half: (f64, f64), most: f64) {
    for (f, column) in data.frequencies.iter().zip(&sheet.growth) {
        for (a, growth) in data.amplitudes.iter().zip(column) {
            let (x0, y0) = panel.at((f - half.0, a + half.1));
            let (x1, y1) = panel.at((f + half.0, a - half.1));
            // half a point more, so that no hairline shows between cells
            let corner = (
                (x1 + 0.5).min(panel.place.right()),
                (y1 + 0.5).min(panel.place.bottom()),
            );
            canvas.rectangle((x0, y0), corner, colour(*growth, most));
        }
    }
}

fn overlay(canvas: &mut Canvas, panel: &Panel, data: &Tongue) {
    if let Some(onset) = &data.onset {
        let inside = |a: f64| if a <= panel.y.hi { a } else { f64::NAN };
        let points = data
            .frequencies
            .iter()
            .zip(onset)
            .map(|(f, a)| panel.at((*f, inside(*a))));
        canvas.line(&points.collect::<Vec<_>>(), Stroke::dashed(INK, 1.4, (5.0, 3.0)));
    }
    let (x, y) = panel.at(data.own);
    let place = panel.place;
    if (place.left..=place.right()).contains(&x) && (place.top..=place.bottom()).contains(&y) {
        let ring: Vec<_> = (0..=16)
            .map(|k| f64::from(k) * std::f64::consts::TAU / 16.0)
            .map(|angle| (x + 5.0 * angle.cos(), y + 5.0 * angle.sin()))
            .collect();
        canvas.line(&ring, Stroke::solid(Colour(0x00, 0x72, 0xb2), 1.8));
    }
}

fn bar(canvas: &mut Canvas, left: f64, most: f64) {
    const PIECES: usize = 64;
    let height = HEIGHT / PIECES as f64;
    for k in 0..PIECES {
        let bottom = TOP + HEIGHT - k as f64 * height;
        let share = (k as f64 + 0.5) / PIECES as f64;
        canvas.rectangle((left, bottom - height - 0.4), (left + 14.0, bottom), shade(share));
    }
    for share in [0.0, 0.5, 1.0] {
        let at = (left + 20.0, TOP + HEIGHT * (1.0 - share));
        canvas.text(at, &significant(share * most, 2), Words::new(11.0, Anchor::Left));
    }
    canvas.text((left - 4.0, TOP - 14.0), "growth [1/s]", Words::new(11.0, Anchor::Left));
    let at = TOP + HEIGHT + 18.0;
    canvas.rectangle((left, at - 5.0), (left + 14.0, at + 5.0), STABLE);
    let faint = Words::new(11.0, Anchor::Left).coloured(FAINT_INK);
    canvas.text((left + 20.0, at), "stable", faint);
}

fn colour(growth: Option<f64>, most: f64) -> Colour {
    match growth {
        None => MISSING,
        Some(g) if g > NOTHING * most && most > 0.0 => shade(g / most),
        Some(_) => STABLE,
    }
}

fn shade(share: f64) -> Colour {
    let at = share.clamp(0.0, 1.0) * (GROWTH.len() - 1) as f64;
    let k = (at as usize).min(GROWTH.len() - 2);
    let w = at - k as f64;
    let mix = |i: usize| (f64::from(GROWTH[k][i]) * (1.0 - w) + f64::from(GROWTH[k + 1][i]) * w).round() as u8;
    Colour(mix(0), mix(1), mix(2))
}
