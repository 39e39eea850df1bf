//! `effects.svg`: what each effect does. A bar an effect: how much results change without it, in logarithms, and beside it the
//! work that is left.

use super::canvas::{Anchor, Canvas, FAINT_INK, INK, Stroke, Words, picture};
use super::colour::Colour;
use super::extent;
use super::panel::{Panel, Place, title};
use super::ticks::Scale;
use crate::output::numbers::{significant, superscript};
use crate::study::effects::Verdict;

/// A model beside the full one.
#[derive(Clone, Debug, PartialEq)]
pub struct Bar {
    /// What is left out.
    pub name: String,
    /// Relative change of the measure; absent where the model failed.
    pub change: Option<f64>,
    /// Largest relative change of any quantity.
    pub largest: Option<f64>,
    /// Work over work.
    pub work: f64,
    /// What is said of it; nothing of choices as a whole.
    pub verdict: Option<Verdict>,
}

/// All that is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct AblationBars {
    /// Name of the case.
    pub case: String,
    /// What the change is of.
    pub measure: String,
    /// Changes below it are nothing.
    pub tolerance: f64,
    /// The integrator's own error.
    pub own: Option<f64>,
    /// Bars from top to bottom.
    pub bars: Vec<Bar>,
}

const TOP: f64 = 78.0;
const LEFT: f64 = 300.0;
const WIDTH: f64 = 360.0;
const GAP: f64 = 26.0;
const BESIDE: f64 = 130.0;
/// Of a row.
const PITCH: f64 = 24.0;
const SHEET: f64 = LEFT + WIDTH + GAP + BESIDE + 62.0;
/// Changes below are drawn there.
const LEAST: f64 = 1e-9;
/// Work is shown up to this.
const MOST: f64 = 2.0;

const NEEDED: Colour = Colour(0xc4, 0x4e, 0x36);
const SAVES: Colour = Colour(0x2f, 0x85, 0x5a);
const HARMLESS: Colour = Colour(0x8b, 0xa6, 0xc1);
const UNDECIDED: Colour = Colour(0xb9, 0xb3, 0xa6);
const WHOLE: Colour = Colour(0x3b, 0x5b, 0x8c);
const WORK: Colour = Colour(0xc3, 0xc9, 0xd0);
const SHADE: Colour = Colour(0xf4, 0xf2, 0xec);
const GRID: Colour = Colour(0xe4, 0xe7, 0xea);

/// Draws it; `None` when there is nothing to draw.
pub fn draw(data: &AblationBars) -> Option<String> {
    let shown = data.bars.iter().flat_map(|b| [b.change, b.largest]).flatten();
    let shown = shown.chain(data.own).filter(|x| *x > 0.0).chain([data.tolerance]);
    let (lo, hi) = extent(shown.map(|x| x.max(LEAST).log10()))?;
    let (lo, hi) = ((lo - 0.5).floor(), (hi + 0.2).ceil());
    // More than eight labels would stand on each other.
    let every = if hi - lo > 8.0 { 2 } else { 1 };
    let ticks = (lo as i32..=hi as i32).filter(|n| n.rem_euclid(every) == 0);
    let height = PITCH * data.bars.len() as f64;
    let place = Place::new(LEFT, TOP, WIDTH, height);
    let none = |lo: f64, hi: f64| Scale {
        lo,
        hi,
        ticks: vec![],
        unit: String::new(),
    };
    let changes = Panel {
        place,
        x: Scale {
            ticks: ticks.map(|n| (f64::from(n), format!("10{}", superscript(n)))).collect(),
            ..none(lo, hi)
        },
        y: none(0.0, 1.0),
    };
    let most = data
        .bars
        .iter()
        .map(|b| b.work)
        .filter(|w| w.is_finite())
        .fold(1.2, f64::max)
        .min(MOST);
    let work = Panel {
        place: Place {
            left: LEFT + WIDTH + GAP,
            width: BESIDE,
            ..place
        },
        x: Scale {
            ticks: [0.0, 0.5, 1.0, 1.5, 2.0]
                .into_iter()
                .filter(|x| *x <= most)
                .map(|x| (x, x.to_string()))
                .collect(),
            ..none(0.0, most)
        },
        y: none(0.0, 1.0),
    };
    Some(picture(SHEET, TOP + height + 78.0, |canvas| {
        let what = format!(
            "relative change of {} without it (ring: the quantity that changes most)",
            data.measure
        );
        title(canvas, 16.0, &format!("{} · what each effect does", data.case), &what);
        if let Some(own) = data.own {
            let edge = changes.at((own.max(LEAST).log10(), 0.0)).0.min(place.right());
            if edge > place.left {
                canvas.rectangle((place.left, place.top), (edge, place.bottom()), SHADE);
            }
        }
        changes.grid(canvas);
        work.grid(canvas);
        for (k, bar) in data.bars.iter().enumerate() {
            row(canvas, &changes, &work, bar, TOP + (k as f64 + 0.5) * PITCH);
        }
        let tolerance = changes.at((data.tolerance.log10(), 0.0)).0;
        canvas.line(
            &[(tolerance, place.top - 6.0), (tolerance, place.bottom())],
            Stroke::dashed(INK, 1.2, (5.0, 3.0)),
        );
        let small = Words::new(10.0, Anchor::Centre).coloured(FAINT_INK);
        canvas.text(
            (tolerance, place.top - 12.0),
            &format!("tolerance {:e}", data.tolerance),
            small,
        );
        let one = work.at((1.0, 0.0)).0;
        canvas.line(
            &[(one, place.top), (one, place.bottom())],
            Stroke::solid(FAINT_INK, 1.0),
        );
        changes.axes(canvas, Some("relative change; shaded: the integrator's own error"), "");
        work.axes(canvas, Some("work, relative"), "");
        legend(canvas, place.bottom() + 60.0);
    }))
}

fn row(canvas: &mut Canvas, changes: &Panel, work: &Panel, bar: &Bar, y: f64) {
    let place = changes.place;
    canvas.text((LEFT - 10.0, y), &bar.name, Words::new(11.5, Anchor::Right));
    let half = 0.32 * PITCH;
    let at = |x: f64| {
        changes
            .at((x.max(LEAST).log10(), 0.0))
            .0
            .clamp(place.left, place.right())
    };
    match bar.change {
        Some(change) if change > 0.0 => {
            canvas.rectangle((place.left, y - half), (at(change), y + half), colour(bar.verdict));
        }
        Some(_) => canvas.text(
            (place.left + 6.0, y),
            "nothing",
            Words::new(10.0, Anchor::Left).coloured(FAINT_INK),
        ),
        None => canvas.text(
            (place.left + 6.0, y),
            "failed",
            Words::new(10.0, Anchor::Left).coloured(NEEDED),
        ),
    }
    if let Some(largest) = bar.largest.filter(|x| *x > 0.0) {
        canvas.ring((at(largest), y), 4.0, Stroke::solid(INK, 1.2));
    }
    if bar.work.is_finite() {
        let end = work.at((bar.work.min(work.x.hi), 0.0)).0;
        canvas.rectangle((work.place.left, y - half), (end, y + half), WORK);
        let label = significant(bar.work, 2);
        canvas.text((work.place.right() + 8.0, y), &label, Words::new(11.0, Anchor::Left));
    }
    let lower = y + 0.5 * PITCH;
    canvas.line(
        &[(place.left, lower), (work.place.right(), lower)],
        Stroke::solid(GRID, 0.5),
    );
}

fn colour(verdict: Option<Verdict>) -> Colour {
    match verdict {
        Some(Verdict::Needed | Verdict::Failed) => NEEDED,
        Some(Verdict::Saves) => SAVES,
        Some(Verdict::Harmless) => HARMLESS,
        Some(_) => UNDECIDED,
        None => WHOLE,
    }
}

fn legend(canvas: &mut Canvas, y: f64) {
    let mut x = LEFT - 60.0;
    for (word, verdict) in [
        ("needed", Some(Verdict::Needed)),
        ("saves", Some(Verdict::Saves)),
        ("harmless", Some(Verdict::Harmless)),
        ("undecided", Some(Verdict::Undecided)),
        ("a choice as a whole", None),
    ] {
        canvas.rectangle((x, y - 5.0), (x + 14.0, y + 5.0), colour(verdict));
        canvas.text((x + 20.0, y), word, Words::new(11.0, Anchor::Left));
        x += 90.0;
    }
}
