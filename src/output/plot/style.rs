//! Styles of pictures: for screens, and for papers.

use super::canvas::LineStyle;

/// Fonts that exist in browsers and in converters from SVG to PDF.
const FONT: &str = "Helvetica Neue, Helvetica, Arial, Liberation Sans, DejaVu Sans, sans-serif";
/// Points per millimeter.
pub const POINTS_PER_MM: f64 = 72.0 / 25.4;
/// Size of texts in the layout of a paper; [`PictureStyle::scale`] converts it to that on paper.
const TEXT: f64 = 11.0;
/// Width of the curves of a paper [pt].
const CURVE: f64 = 0.8;
/// Dash patterns of the curves of a paper [pt]; curves of one color never share one.
const DASHES: [Option<(f64, f64)>; 4] = [None, Some((4.0, 1.6)), Some((1.0, 1.5)), Some((7.0, 2.0))];

/// Style of a picture. Lengths are in units of the layout.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureStyle {
    /// Points per unit of the layout.
    pub scale: f64,
    /// Size of tick labels and legends.
    pub small: f64,
    /// Size of axis names.
    pub normal: f64,
    /// Font family with its replacements.
    pub font: String,
    /// True for a picture of a paper: ticks inside of the frame, no grid, size in millimeters.
    pub paper: bool,
    /// True if raised and lowered digits are smaller digits of the same font.
    pub typeset: bool,
    /// Decimals of coordinates in points.
    pub digits: i32,
    /// True if the size of an SVG is given in millimeters.
    pub millimetres: bool,
    /// Width and height of the sheet [pt]; by default those of the panels.
    pub sheet: Option<(f64, f64)>,
}

impl Default for PictureStyle {
    fn default() -> Self {
        Self::screen()
    }
}

impl PictureStyle {
    /// Style of result folders and pages.
    pub fn screen() -> Self {
        Self {
            scale: 1.0,
            small: TEXT,
            normal: 12.5,
            font: FONT.into(),
            paper: false,
            typeset: false,
            digits: 1,
            millimetres: false,
            sheet: None,
        }
    }

    /// Style of papers with texts of a size [pt].
    pub fn paper(font_size: f64) -> Self {
        Self {
            scale: font_size / TEXT,
            normal: TEXT,
            paper: true,
            typeset: true,
            digits: 2,
            millimetres: true,
            ..Self::screen()
        }
    }

    /// Sets the size of the texts [pt].
    pub fn sized(self, font_size: f64) -> Self {
        Self {
            scale: font_size / self.normal,
            digits: 2,
            ..self
        }
    }

    /// Sets the font; the others replace it where it does not exist.
    pub fn with_font(self, name: &str) -> Self {
        let quoted = name.replace('\'', "");
        Self {
            font: format!("'{quoted}', {FONT}"),
            ..self
        }
    }

    /// Line of the curve number `k`.
    pub fn curve(&self, k: usize) -> LineStyle {
        let colour = super::colour::PALETTE[k % super::colour::PALETTE.len()];
        match self.paper {
            true => LineStyle {
                dash: DASHES[k % DASHES.len()].map(|(dash, gap)| (dash / self.scale, gap / self.scale)),
                ..LineStyle::solid(colour, CURVE / self.scale)
            },
            false => LineStyle::solid(colour, 1.4),
        }
    }

    /// End of a line: round ends would fill the gaps of fine dashes.
    pub(super) fn cap(&self) -> &'static str {
        if self.paper { "butt" } else { "round" }
    }
}

/// Height of a part of a text above its line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rise {
    /// On the line.
    None,
    /// Raised: an exponent.
    Raised,
    /// Lowered: an index.
    Lowered,
}

impl Rise {
    /// Height above the line relative to the size of the text.
    pub fn height(self) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Raised => 0.35,
            Self::Lowered => -0.17,
        }
    }

    /// Size relative to that of the text.
    pub fn size(self) -> f64 {
        if self == Self::None { 1.0 } else { 0.7 }
    }
}

/// Parts of a text with their heights. Raised and lowered digits become plain ones.
pub fn runs(text: &str) -> Vec<(String, Rise)> {
    const RAISED: [char; 11] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹', '⁻'];
    const LOWERED: [char; 10] = ['₀', '₁', '₂', '₃', '₄', '₅', '₆', '₇', '₈', '₉'];
    const PLAIN: [char; 11] = ['0', '1', '2', '3', '4', '5', '6', '7', '8', '9', '−'];
    let mut all: Vec<(String, Rise)> = vec![];
    for c in text.chars() {
        let within = |list: &[char]| list.iter().position(|one| *one == c).map(|k| PLAIN[k]);
        let (c, rise) = match (within(&RAISED), within(&LOWERED)) {
            (Some(c), _) => (c, Rise::Raised),
            (_, Some(c)) => (c, Rise::Lowered),
            _ => (c, Rise::None),
        };
        match all.last_mut().filter(|last| last.1 == rise) {
            Some(last) => last.0.push(c),
            None => all.push((c.into(), rise)),
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_raised_and_lowered() {
        let parts = runs("u₁ [10⁻⁶ m³/s]");
        let all: Vec<(&str, Rise)> = parts.iter().map(|(text, rise)| (text.as_str(), *rise)).collect();
        let expected = [
            ("u", Rise::None),
            ("1", Rise::Lowered),
            (" [10", Rise::None),
            ("−6", Rise::Raised),
            (" m", Rise::None),
            ("3", Rise::Raised),
            ("/s]", Rise::None),
        ];
        assert_eq!(all, expected);
    }

    /// Goal: twenty curves of one panel differ in color or dashes.
    #[test]
    fn curves_of_a_paper_differ() {
        let style = PictureStyle::paper(8.0);
        let all: Vec<LineStyle> = (0..20).map(|k| style.curve(k)).collect();
        assert!(all.iter().enumerate().all(|(k, one)| !all[..k].contains(one)));
    }
}
