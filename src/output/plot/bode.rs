//! `response.svg`: amplitude and phase over frequency.

use super::canvas::{Anchor, Stroke, Words, picture};
use super::colour::PALETTE;
use super::panel::{Panel, Place, title};
use super::ticks::Scale;

/// One output.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Its name.
    pub name: String,
    /// Real part at each frequency.
    pub real: Vec<f64>,
    /// Imaginary part at each frequency.
    pub imag: Vec<f64>,
}

/// All that is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Bode {
    /// Name of the case.
    pub case: String,
    /// The input.
    pub input: String,
    /// Frequencies [Hz].
    pub frequencies: Vec<f64>,
    /// Outputs.
    pub lines: Vec<Line>,
}

const LEFT: f64 = 84.0;
const TOP: f64 = 84.0;
const WIDTH: f64 = 620.0;
const HEIGHT: [f64; 2] = [250.0, 150.0];
const GAP: f64 = 22.0;
/// Decades below the largest amplitude that are drawn [dB].
const DEEPEST: f64 = 160.0;

/// Draws it; `None` when there is nothing to draw.
pub fn draw(data: &Bode) -> Option<String> {
    let (from, to) = (*data.frequencies.first()?, *data.frequencies.last()?);
    let x = Scale::logarithmic((from, to), 1.0, &[1.0, 2.0, 5.0], ("Hz", 8));
    let decibel = |line: &Line| -> Vec<f64> {
        let parts = line.real.iter().zip(&line.imag);
        parts.map(|(re, im)| 20.0 * re.hypot(*im).log10()).collect()
    };
    let amplitudes: Vec<Vec<f64>> = data.lines.iter().map(decibel).collect();
    let finite = || amplitudes.iter().flatten().copied().filter(|a| a.is_finite());
    let highest = finite().reduce(f64::max)?;
    let lowest = finite().fold(highest - 20.0, f64::min).max(highest - DEEPEST);
    let places = [
        Place::new(LEFT, TOP, WIDTH, HEIGHT[0]),
        Place::new(LEFT, TOP + HEIGHT[0] + GAP, WIDTH, HEIGHT[1]),
    ];
    let panels = [
        Panel::new(places[0], x.clone(), Scale::exact(lowest - 5.0, highest + 5.0, "dB", 6)),
        Panel::new(places[1], x, Scale::exact(-190.0, 190.0, "°", 5)),
    ];
    Some(picture(LEFT + WIDTH + 30.0, places[1].bottom() + 52.0, |canvas| {
        title(
            canvas,
            16.0,
            &format!("{} · frequency response", data.case),
            &format!("to {}", data.input),
        );
        panels.iter().for_each(|panel| panel.grid(canvas));
        let mut left = LEFT;
        for ((line, amplitude), colour) in data.lines.iter().zip(&amplitudes).zip(PALETTE.iter().cycle()) {
            let stroke = Stroke::solid(*colour, 1.6);
            let clipped = amplitude.iter().map(|a| a.max(lowest - 5.0));
            panels[0].curve(canvas, data.frequencies.iter().copied().zip(clipped), stroke);
            let phase: Vec<f64> = line
                .real
                .iter()
                .zip(&line.imag)
                .map(|(re, im)| im.atan2(*re).to_degrees())
                .collect();
            // a jump of a full turn is no part of the curve
            let mut begin = 0;
            for k in 1..=phase.len() {
                if k == phase.len() || (phase[k] - phase[k - 1]).abs() > 270.0 {
                    let part = data.frequencies[begin..k]
                        .iter()
                        .copied()
                        .zip(phase[begin..k].iter().copied());
                    panels[1].curve(canvas, part, stroke);
                    begin = k;
                }
            }
            canvas.line(&[(left, TOP - 16.0), (left + 18.0, TOP - 16.0)], stroke);
            canvas.text((left + 24.0, TOP - 16.0), &line.name, Words::new(11.5, Anchor::Left));
            left += 44.0 + 6.6 * line.name.chars().count() as f64;
        }
        panels[0].axes(canvas, None, "amplitude");
        panels[1].axes(canvas, Some("frequency"), "phase");
    }))
}
