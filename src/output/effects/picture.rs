//! `effects.svg`: one bar per effect for the change of results without it, on a logarithmic scale, and one for the remaining work.

use super::{ShownQuantity, table};
use crate::case::schema::Effect;
use crate::output::numbers::significant;
use crate::output::plot::canvas::{FAINT_INK, INK, LineStyle, TextAnchor, TextStyle};
use crate::output::plot::colour::Colour;
use crate::output::plot::extent;
use crate::output::plot::picture::{Glyph, Panel, Picture, PictureAxis, PictureSeries};
use crate::study::effects::ablation::ComparedRun;
use crate::study::effects::{Ablation, EffectVerdict};

/// A model that is compared with the full one.
#[derive(Clone, Debug, PartialEq)]
pub struct Bar {
    /// Omitted effect.
    pub name: String,
    /// Relative change of the measure; absent if the model failed.
    pub change: Option<f64>,
    /// Largest relative change of any quantity.
    pub largest: Option<f64>,
    /// Work, relative to that of the model it is compared with.
    pub work: f64,
    /// Verdict on an effect; absent for combined choices.
    pub verdict: Option<EffectVerdict>,
}

/// Bars from top to bottom.
pub fn bars(found: &Ablation, shown: &ShownQuantity) -> Vec<Bar> {
    let bar = |name: &str, compared: &ComparedRun, verdict: Option<EffectVerdict>| Bar {
        name: name.into(),
        change: shown.change(compared),
        largest: compared.largest.as_ref().map(|l| l.1),
        work: compared.work,
        verdict,
    };
    let effects = found.rows.iter().filter_map(|row| {
        let name = match row.without.as_slice() {
            [] => row.name.to_string(),
            others => format!("{} (no {})", row.name, Effect::names(others, ", ")),
        };
        Some(bar(&name, row.left_out.as_ref()?, Some(row.verdict)))
    });
    effects
        .chain(table::beside(found).map(|(name, c)| bar(name, c, None)))
        .collect()
}

/// Height of a row [pt].
const PITCH: f64 = 24.0;
/// Smallest change drawn; smaller changes are drawn with this value.
const LEAST: f64 = 1e-9;
/// Largest relative work drawn.
const MOST: f64 = 2.0;

const NEEDED: Colour = Colour(0xc4, 0x4e, 0x36);
const WORK: Colour = Colour(0xc3, 0xc9, 0xd0);
const SHADE: Colour = Colour(0xf4, 0xf2, 0xec);

/// Draws the picture; `None` if there is nothing to draw.
pub fn draw(found: &Ablation, shown: &ShownQuantity) -> Option<String> {
    let (bars, own) = (bars(found, shown), shown.own(found));
    let drawn = bars.iter().flat_map(|b| [b.change, b.largest]).flatten();
    let drawn = drawn.chain(own).filter(|x| *x > 0.0).chain([found.tolerance]);
    let (lo, hi) = extent(drawn.map(|x| x.max(LEAST).log10()))?;
    let (lo, hi) = (10_f64.powf((lo - 0.5).floor()), 10_f64.powf((hi + 0.2).ceil()));
    let finite = bars.iter().map(|b| b.work).filter(|w| w.is_finite());
    let most = finite.fold(1.2, f64::max).min(MOST);
    let count = bars.len() as f64;
    let row = |k: usize| count - k as f64 - 0.5;
    let mut changes = vec![];
    if let Some(own) = own {
        changes.push(PictureSeries::band(
            &[(lo, 0.0, count), (own.clamp(lo, hi), 0.0, count)],
            SHADE,
        ));
    }
    let mut work = vec![];
    for (k, bar) in bars.iter().enumerate() {
        let [below, at, above] = [-0.32, 0.0, 0.32].map(|off| row(k) + off);
        let small = TextStyle::new(10.0, TextAnchor::Left);
        let word =
            |text: &str, colour: Colour| PictureSeries::label((lo, at), (6.0, 0.0), text, small.coloured(colour));
        changes.push(match bar.change {
            Some(change) if change > 0.0 => {
                let (name, colour) = meaning(bar.verdict);
                PictureSeries::cell([(lo, below), (change.clamp(lo, hi), above)], colour).named(name)
            }
            Some(_) => word("nothing", FAINT_INK),
            None => word("failed", NEEDED),
        });
        let ring = bar.largest.filter(|x| *x > 0.0).map(|x| (x.clamp(lo, hi), at));
        changes.push(PictureSeries::marks(ring, Glyph::Ring(4.0, 1.2), INK));
        if bar.work.is_finite() {
            work.push(PictureSeries::cell([(0.0, below), (bar.work.min(most), above)], WORK));
            work.push(PictureSeries::label(
                (most, at),
                (6.0, 0.0),
                significant(bar.work, 2),
                TextStyle::new(11.0, TextAnchor::Left),
            ));
        }
    }
    let dashed = LineStyle::dashed(INK, 1.2, (5.0, 3.0));
    let tolerance = PictureSeries::line([(found.tolerance, 0.0), (found.tolerance, count)], dashed);
    changes.push(tolerance.named(format!("tolerance {:e}", found.tolerance)));
    work.push(PictureSeries::line(
        [(1.0, 0.0), (1.0, count)],
        LineStyle::solid(FAINT_INK, 1.0),
    ));
    let names = bars.iter().enumerate().map(|(k, bar)| (row(k), bar.name.clone()));
    let y = PictureAxis {
        labels: Some(names.collect()),
        ..PictureAxis::default().between(0.0, count)
    };
    let name = "relative change; shaded: the integrator's own error";
    let x = PictureAxis::new(name, "1", 8).between(lo, hi).logarithmic(true);
    let beside = PictureAxis::new("work, relative", "1", 5).between(0.0, 1.4 * most);
    let height = PITCH * count;
    let picture = Picture {
        title: format!("{} · what each effect does", found.case),
        about: format!(
            "relative change of {} without it (ring: the quantity that changes most)",
            shown.describe()
        ),
        rows: vec![vec![
            Panel::new((360.0, height), x, y.clone(), changes),
            Panel::new((150.0, height), beside, y, work),
        ]],
    };
    picture.svg()
}

/// Meaning and color of a bar.
fn meaning(verdict: Option<EffectVerdict>) -> (&'static str, Colour) {
    match verdict {
        Some(EffectVerdict::Needed | EffectVerdict::Failed) => ("needed", NEEDED),
        Some(EffectVerdict::Saves) => ("saves", Colour(0x2f, 0x85, 0x5a)),
        Some(EffectVerdict::Harmless) => ("harmless", Colour(0x8b, 0xa6, 0xc1)),
        Some(_) => ("undecided", Colour(0xb9, 0xb3, 0xa6)),
        None => ("a choice as a whole", Colour(0x3b, 0x5b, 0x8c)),
    }
}
