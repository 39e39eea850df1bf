//! A drawing as PDF 1.4 with its font embedded, as journals require. It has one page of the size of the drawing.
//!
//! The font is Liberation Sans, which has the widths of Helvetica and Arial; the file contains the used glyphs only. Fonts are subset by
//! `subsetter`, objects are written by `pdf-writer`.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use pdf_writer::types::{CidFontType, FontFlags, LineCapStyle, LineJoinStyle, SystemInfo, UnicodeCmap};
use pdf_writer::{Content, Finish as _, Name, Pdf, Rect, Ref, Str};
use subsetter::{GlyphRemapper, subset};
use ttf_parser::{Face, GlyphId};

use super::canvas::{Drawing, DrawnShape, LineStyle, TextAnchor, TextStyle};
use super::colour::Colour;
use super::style::{Rise, runs};
use crate::error::{Error, Result, usage, visible};

const LIBERATION: &[u8] = include_bytes!("font/LiberationSans-Regular.ttf");

/// Name of the font in the file, and of the opacity of shades.
const FONT: Name = Name(b"F1");
const SHADE: Name = Name(b"G1");
/// Distance of a control point of a quarter circle, relative to the radius.
const QUARTER: f64 = 0.552_285;
/// Units per em in a PDF.
const EM: f32 = 1000.0;

/// Font of a PDF.
pub struct PdfFont {
    bytes: Vec<u8>,
    name: String,
}

impl Default for PdfFont {
    fn default() -> Self {
        Self {
            bytes: LIBERATION.to_vec(),
            name: "LiberationSans".into(),
        }
    }
}

impl PdfFont {
    /// Reads a TrueType font.
    ///
    /// # Errors
    /// The file cannot be read, or it is no TrueType font.
    pub fn read(path: &Path) -> Result<Self> {
        let bytes = fs::read(path).map_err(|e| crate::output::folder::fault("read", path, e))?;
        let known = Face::parse(&bytes, 0).ok().filter(|face| face.tables().glyf.is_some());
        let Some(face) = known else {
            let path = path.display();
            return usage(format!("--font {path}: expected a TrueType font (.ttf) for a PDF"));
        };
        let named = face
            .names()
            .into_iter()
            .find(|name| name.name_id == 6)
            .and_then(|name| name.to_string());
        let kept = |c: &char| c.is_ascii_alphanumeric() || *c == '-';
        let name = named.unwrap_or_default().chars().filter(kept).collect();
        Ok(Self { bytes, name })
    }
}

/// Glyphs of a file: new number and width of each, with their characters.
struct UsedGlyphs<'a> {
    face: Face<'a>,
    remapper: GlyphRemapper,
    used: BTreeMap<u16, (char, f32)>,
    missing: Vec<char>,
}

impl UsedGlyphs<'_> {
    /// Bytes of a text in the font of the file, and its width relative to its size.
    fn encode(&mut self, text: &str) -> (Vec<u8>, f64) {
        let per_em = f32::from(self.face.units_per_em());
        let (mut bytes, mut total) = (vec![], 0.0);
        for c in text.chars() {
            let glyph = self.face.glyph_index(c).unwrap_or_else(|| {
                self.missing.push(c);
                GlyphId(0)
            });
            let width = EM * f32::from(self.face.glyph_hor_advance(glyph).unwrap_or(0)) / per_em;
            let new = self.remapper.remap(glyph.0);
            self.used.insert(new, (c, width));
            bytes.extend(new.to_be_bytes());
            total += f64::from(width / EM);
        }
        (bytes, total)
    }
}

impl Drawing {
    /// The bytes of the PDF.
    ///
    /// # Errors
    /// The font cannot be read, or it has no sign for a character.
    pub fn pdf(&self, font: &PdfFont) -> Result<Vec<u8>> {
        let unreadable = |why: String| Error::Usage(format!("font {}: {why}", font.name));
        let face = Face::parse(&font.bytes, 0).map_err(|e| unreadable(e.to_string()))?;
        let mut glyphs = UsedGlyphs {
            face,
            remapper: GlyphRemapper::new(),
            used: BTreeMap::new(),
            missing: vec![],
        };
        let content = self.content(&mut glyphs);
        if let Some(c) = glyphs.missing.first() {
            return usage(format!(
                "the font {} of the PDF has no sign for '{c}'; name a TrueType font with --font FILE.ttf, choose another --label, or write \
                 an SVG",
                font.name
            ));
        }
        let file = subset(&font.bytes, 0, &glyphs.remapper).map_err(|e| unreadable(e.to_string()))?;
        Ok(self.assembled(&content, &glyphs, &font.name, &file))
    }

    /// Objects of the file.
    fn assembled(&self, content: &[u8], glyphs: &UsedGlyphs, name: &str, file: &[u8]) -> Vec<u8> {
        let [catalog, pages, page, font, cid, descriptor, cmap, data, stream, shade] =
            [1, 2, 3, 4, 5, 6, 7, 8, 9, 10].map(Ref::new);
        // a subset is named by six letters and the font
        let base = format!("SLCBEA+{name}");
        let base = Name(base.as_bytes());
        let system = SystemInfo {
            registry: Str(b"Adobe"),
            ordering: Str(b"Identity"),
            supplement: 0,
        };
        let mut pdf = Pdf::new();
        pdf.set_version(1, 4);
        pdf.catalog(catalog).pages(pages);
        pdf.pages(pages).kids([page]).count(1);
        let mut sheet = pdf.page(page);
        let (width, height) = self.size;
        sheet.parent(pages).contents(stream);
        sheet.media_box(Rect::new(0.0, 0.0, width as f32, height as f32));
        let mut resources = sheet.resources();
        resources.fonts().pair(FONT, font);
        resources.ext_g_states().pair(SHADE, shade);
        resources.finish();
        sheet.finish();
        pdf.ext_graphics(shade).non_stroking_alpha(0.22);
        pdf.type0_font(font)
            .base_font(base)
            .encoding_predefined(Name(b"Identity-H"))
            .descendant_font(cid)
            .to_unicode(cmap);
        let mut written = pdf.cid_font(cid);
        written.subtype(CidFontType::Type2).base_font(base).system_info(system);
        written.font_descriptor(descriptor).default_width(0.0);
        written.cid_to_gid_map_predefined(Name(b"Identity"));
        let mut widths = written.widths();
        for (glyph, (_, width)) in &glyphs.used {
            widths.consecutive(*glyph, [*width]);
        }
        widths.finish();
        written.finish();
        let (face, per_em) = (&glyphs.face, f32::from(glyphs.face.units_per_em()));
        let unit = |x: i16| EM * f32::from(x) / per_em;
        let bounds = face.global_bounding_box();
        pdf.font_descriptor(descriptor)
            .name(base)
            .flags(FontFlags::SYMBOLIC)
            .bbox(Rect::new(
                unit(bounds.x_min),
                unit(bounds.y_min),
                unit(bounds.x_max),
                unit(bounds.y_max),
            ))
            .italic_angle(0.0)
            .ascent(unit(face.ascender()))
            .descent(unit(face.descender()))
            .cap_height(unit(face.capital_height().unwrap_or(face.ascender())))
            .stem_v(80.0)
            .font_file2(data);
        let mut unicode = UnicodeCmap::new(Name(b"Custom"), system);
        glyphs.used.iter().for_each(|(glyph, (c, _))| unicode.pair(*glyph, *c));
        pdf.cmap(cmap, &unicode.finish());
        pdf.stream(data, file).pair(Name(b"Length1"), file.len() as i32);
        pdf.stream(stream, content);
        pdf.finish()
    }

    /// Drawing operators. The origin of a PDF is the lower left corner.
    fn content(&self, glyphs: &mut UsedGlyphs) -> Vec<u8> {
        let mut out = PdfContent {
            content: Content::new(),
            height: self.size.1,
        };
        out.content.set_line_join(LineJoinStyle::RoundJoin);
        out.content.set_line_cap(match self.style.paper {
            true => LineCapStyle::ButtCap,
            false => LineCapStyle::RoundCap,
        });
        for shape in &self.shapes {
            match shape {
                DrawnShape::Line(points, stroke) => {
                    out.stroke(*stroke);
                    out.path(points);
                    out.content.stroke();
                }
                DrawnShape::Polygon(points, colour, opacity) => {
                    let corners = |out: &mut PdfContent| {
                        out.fill(*colour);
                        out.path(points);
                        out.content.fill_nonzero();
                    };
                    if *opacity < 1.0 {
                        out.content.save_state().set_parameters(SHADE);
                        corners(&mut out);
                        out.content.restore_state();
                    } else {
                        corners(&mut out);
                    }
                }
                DrawnShape::Rectangle(a, b, colour) => {
                    out.fill(*colour);
                    let ((x, y), [width, height]) = (out.at((a.0, b.1)), [b.0 - a.0, b.1 - a.1].map(|x| x as f32));
                    out.content.rect(x, y, width, height).fill_nonzero();
                }
                DrawnShape::Ring(centre, radius, stroke) => out.ring(*centre, *radius, *stroke),
                DrawnShape::Text(at, text, words) => out.text(*at, text, *words, glyphs),
                DrawnShape::LinkStart(..) | DrawnShape::LinkEnd => {}
            }
        }
        out.content.finish().into_vec()
    }
}

/// Operators under construction.
struct PdfContent {
    content: Content,
    height: f64,
}

impl PdfContent {
    fn at(&self, (x, y): (f64, f64)) -> (f32, f32) {
        // two decimals are finer than printers
        let fine = |x: f64| (100.0 * x).round() as f32 / 100.0;
        (fine(x), fine(self.height - y))
    }

    fn fill(&mut self, colour: Colour) {
        let [r, g, b] = shares(colour);
        self.content.set_fill_rgb(r, g, b);
    }

    fn stroke(&mut self, stroke: LineStyle) {
        let [r, g, b] = shares(stroke.colour);
        let dash = stroke.dash.map(|(dash, gap)| [dash as f32, gap as f32]);
        self.content
            .set_stroke_rgb(r, g, b)
            .set_line_width(stroke.width as f32)
            .set_dash_pattern(dash.into_iter().flatten(), 0.0);
    }

    fn path(&mut self, points: &[(f64, f64)]) {
        let mut last = None;
        for point in points {
            let (x, y) = self.at(*point);
            match last {
                None => self.content.move_to(x, y),
                Some(at) if at == (x, y) => continue,
                Some(_) => self.content.line_to(x, y),
            };
            last = Some((x, y));
        }
    }

    /// A circle of four arcs.
    fn ring(&mut self, centre: (f64, f64), radius: f64, stroke: LineStyle) {
        self.stroke(stroke);
        let at = |out: &Self, x: f64, y: f64| out.at((centre.0 + radius * x, centre.1 + radius * y));
        let (x, y) = at(self, 1.0, 0.0);
        self.content.move_to(x, y);
        let mut from = (1.0, 0.0);
        for to in [(0.0, 1.0), (-1.0, 0.0), (0.0, -1.0), (1.0, 0.0)] {
            let [a, b, end] = [
                at(self, from.0 + QUARTER * to.0, from.1 + QUARTER * to.1),
                at(self, to.0 + QUARTER * from.0, to.1 + QUARTER * from.1),
                at(self, to.0, to.1),
            ];
            self.content.cubic_to(a.0, a.1, b.0, b.1, end.0, end.1);
            from = to;
        }
        self.content.stroke();
    }

    fn text(&mut self, at: (f64, f64), text: &str, words: TextStyle, glyphs: &mut UsedGlyphs) {
        let parts: Vec<(Vec<u8>, f64, Rise)> = runs(&visible(text))
            .into_iter()
            .map(|(part, rise)| {
                let (bytes, width) = glyphs.encode(&part);
                (bytes, width * rise.size() * words.size, rise)
            })
            .collect();
        let width: f64 = parts.iter().map(|(_, width, _)| width).sum();
        let back = match words.anchor {
            TextAnchor::Left => 0.0,
            TextAnchor::Centre => 0.5 * width,
            TextAnchor::Right => width,
        };
        // half an ex and the distance of the SVG below the point
        let down = 0.35 * words.size;
        let (x, y) = match words.upright {
            true => self.at((at.0 + down, at.1 + back)),
            false => self.at((at.0 - back, at.1 + down)),
        };
        self.fill(words.colour);
        let matrix = match words.upright {
            true => [0.0, 1.0, -1.0, 0.0, x, y],
            false => [1.0, 0.0, 0.0, 1.0, x, y],
        };
        self.content.begin_text().set_text_matrix(matrix);
        if words.bold {
            let [r, g, b] = shares(words.colour);
            // the font has no bold form: its outline is drawn too
            self.content
                .set_stroke_rgb(r, g, b)
                .set_line_width(0.03 * words.size as f32)
                .set_dash_pattern([], 0.0)
                .set_text_rendering_mode(pdf_writer::types::TextRenderingMode::FillStroke);
        }
        for (bytes, _, rise) in &parts {
            let size = (rise.size() * words.size) as f32;
            self.content
                .set_font(FONT, size)
                .set_rise((rise.height() * words.size) as f32)
                .show(Str(bytes));
        }
        if words.bold {
            self.content
                .set_text_rendering_mode(pdf_writer::types::TextRenderingMode::Fill);
        }
        self.content.set_rise(0.0).end_text();
    }
}

/// Components of a color from 0 to 1, with three decimals.
fn shares(Colour(r, g, b): Colour) -> [f32; 3] {
    [r, g, b].map(|x| (1000.0 * f32::from(x) / 255.0).round() / 1000.0)
}
