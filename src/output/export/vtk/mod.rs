//! `vtk/NAME.pvd`, with one `.vtm` per instant and one `.vtp` per part of it: ParaView opens them as an animation of named blocks.
//!
//! ```text
//! surface   points, quadrilaterals, lines and their data, as VTK's XML
//! curve     the reference curve at an instant: position and slope of each section
//! cutout    rows and windows: positions of the bladders in the beam
//! beam      the beam's surface, open beside the bladders
//! bladders  the bladders as boxes that move with their segments
//! tubes     tubes and turbines as lines
//! ```
//!
//! VTK's axes: X along the straight beam (the model's z), Y the deflection (the model's x), Z across the width. In ParaView's initial view
//! the beam lies on its side and bends up and down. Beams of a structure are at their places, with their numbers in `/beams` as data.

mod beam;
mod bladders;
mod curve;
mod cutout;
mod surface;
mod tubes;

use std::fs;
use std::ops::Range;
use std::path::Path;

use super::ExportedFiles;
use super::staged_folder::StagedFolder;
use crate::case::Case;
use crate::case::structure::{self, Piece};
use crate::discrete::System;
use crate::discrete::quantities::{BeamField, FieldAxis, PlacedNodes};
use crate::error::Result;
use crate::model::Model;
use crate::numerics::Planar;
use crate::output::folder::{CASE, FIELDS, VTK, damaged, fault};
use crate::output::numbers::shortest;
use crate::run::observe::Observer;
use crate::study::compare::Recording;
use curve::Curve;
use cutout::Cutout;
use surface::{Data, Surface};

/// Parts of the drawing, each one file per instant.
const PARTS: [&str; 3] = ["beam", "bladders", "tubes"];
/// Prefix of the files that join the parts of an instant.
const JOINED: &str = "scene";

/// Difference, relative to the size of an axis, below which two axes are equal: programs round differently.
const SAME: f64 = 1e-9;

/// Writes `dir/vtk` in place of older files of the same kind. Returns the files written, with the path of the `.pvd`.
pub fn write(dir: &Path, case: &Case, from: &Recording, instants: &[usize]) -> Result<ExportedFiles> {
    fits(case, from)?;
    let staged = StagedFolder::new(dir, VTK)?;
    let scene = Scene::new(case, from)?;
    let digits = from.field_times.len().to_string().len();
    let collection = format!("{}.pvd", case.name);
    let mut written = ExportedFiles::new(staged.target().join(&collection));
    let mut sets = String::new();
    for &k in instants {
        let t = from.field_times[k];
        let mut blocks = String::new();
        for (part, surface) in scene.at(k).into_iter().enumerate() {
            let name = PARTS[part];
            let file = format!("{name}-{k:0digits$}.vtp");
            written.count(put(&staged.path(&file), &surface.file(t))?);
            blocks += &format!("    <DataSet index=\"{part}\" name=\"{name}\" file=\"{file}\"/>\n");
        }
        let file = format!("{JOINED}-{k:0digits$}.vtm");
        let text = xml("vtkMultiBlockDataSet", &blocks);
        written.count(put(&staged.path(&file), text.as_bytes())?);
        sets += &format!("    <DataSet timestep=\"{}\" file=\"{file}\"/>\n", shortest(t));
    }
    let text = xml("Collection", &sets);
    written.count(put(&staged.path(&collection), text.as_bytes())?);
    // older files of other instants would mix with these
    let of = |name: &str, part: &str, ending: &str| name.starts_with(&format!("{part}-")) && name.ends_with(ending);
    staged.place(|name| PARTS.iter().any(|part| of(name, part, ".vtp")) || of(name, JOINED, ".vtm"))?;
    Ok(written)
}

/// A file of type `kind` that lists other files.
fn xml(kind: &str, sets: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\">\n  <{kind}>\n{sets}  </{kind}>\n</VTKFile>\n"
    )
}

/// Checks that the arrays belong to the case: the drawing uses both.
fn fits(case: &Case, from: &Recording) -> Result<()> {
    let header = Observer::header(case, &System::new(case)?);
    let path = Path::new(&from.label).join(FIELDS);
    let other = |why: String| Err(fault("read", &path, damaged(why)));
    for expected in &header.axes {
        let there = from.axis(expected.name).unwrap_or_default();
        let size = expected.values.iter().fold(0.0_f64, |s, x| s.max(x.abs()));
        let near = |(a, b): (&f64, &f64)| (a - b).abs() <= SAME * size;
        if there.len() != expected.values.len() || !there.iter().zip(&expected.values).all(near) {
            return other(format!("its {} is not that of {CASE}", expected.name));
        }
    }
    for expected in &header.fields {
        let there = from.field(expected.name).map_or(0, |f| f.len);
        if there != expected.len {
            return other(format!(
                "its {} has {there} places, {CASE} makes {}",
                expected.name, expected.len
            ));
        }
    }
    Ok(())
}

fn put(path: &Path, bytes: &[u8]) -> Result<u64> {
    fs::write(path, bytes).map_err(|e| fault("write", path, e))?;
    Ok(bytes.len() as u64)
}

/// A single beam, or a part of a structure.
struct ScenePart {
    cutout: Cutout,
    stations: Vec<f64>,
    /// Its nodes and its cells in the recorded fields.
    nodes: Range<usize>,
    cells: Range<usize>,
    /// Root and angle of its beam, and the number of the beam from 1; none for a single beam.
    place: Option<(Planar<f64>, f64, i32)>,
}

/// Data that do not move: sizes, windows, positions of bladders, ends of tubes.
struct Scene<'a> {
    from: &'a Recording,
    parts: Vec<ScenePart>,
    wet: Option<(bladders::CutoutLayout, Vec<tubes::TubeArc>)>,
}

impl ScenePart {
    /// The beam of a case, or the parts of its structure, with the coordinates of all nodes.
    fn all(case: &Case, theta: &[f64], placed: Option<&PlacedNodes>) -> Vec<Self> {
        let part = |cutout: Cutout, nodes: Range<usize>, before: usize, place| Self {
            stations: cutout.stations(&theta[nodes.clone()]),
            cells: nodes.start - before..(nodes.end - before).saturating_sub(1),
            cutout,
            nodes,
            place,
        };
        let Some(placed) = placed else {
            return vec![part(Cutout::new(case), 0..theta.len(), 0, None)];
        };
        let pieces = structure::pieces(case).0;
        let each = pieces.iter().zip(placed.parts()).enumerate();
        let of = |(k, (piece, nodes)): (usize, (&Piece, Range<usize>))| {
            let root = piece.origin - piece.direction() * piece.from;
            let place = (root, piece.angle, piece.beam as i32 + 1);
            part(Cutout::of_part(case, piece), nodes, k, Some(place))
        };
        each.map(of).collect()
    }

    /// Values of a recorded field on the part.
    fn values<'a>(&self, name: &str, row: &'a [f64]) -> &'a [f64] {
        let range = match BeamField::named(name).map(BeamField::axis) {
            Some(FieldAxis::Cells) => &self.cells,
            _ => &self.nodes,
        };
        row.get(range.clone()).unwrap_or_default()
    }
}

impl<'a> Scene<'a> {
    fn new(case: &Case, from: &'a Recording) -> Result<Self> {
        let placed = PlacedNodes::from_axes(|axis| from.axis(axis.name()).map(<[f64]>::to_vec));
        let theta = from.axis(FieldAxis::Nodes.name()).unwrap_or_default();
        let parts = ScenePart::all(case, theta, placed.as_ref());
        let model = Model::new(case)?;
        let wet = model.wet.as_ref().zip(from.axis("bladder")).map(|(wet, labels)| {
            let layout = bladders::CutoutLayout::new(wet, labels);
            let cutouts: Vec<&Cutout> = parts.iter().map(|part| &part.cutout).collect();
            let tubes = tubes::all(case, wet, &cutouts, &layout);
            (layout, tubes)
        });
        Ok(Self { from, parts, wet })
    }

    /// Parts at an instant, in the order of [`PARTS`]; a dry beam has only the first.
    fn at(&self, instant: usize) -> Vec<Surface> {
        let row = |name: &str| self.from.field(name).map_or(&[][..], |f| f.row(instant));
        let theta = self.from.axis(FieldAxis::Nodes.name()).unwrap_or_default();
        let (pressure, area) = (row("pressure_pa"), row("area_change_m2"));
        let (mut beams, mut boxes, mut curves) = (Surface::default(), Surface::default(), vec![]);
        for part in &self.parts {
            let own = |name: &str| part.values(name, row(name));
            let angles = own("section_angle_rad");
            let line = Curve::new(
                &theta[part.nodes.clone()],
                own("u1_m"),
                own("u3_m"),
                own("curvature_1_m"),
                angles,
            );
            let (curve, turn) = match part.place {
                None => (line, 0.0),
                Some((root, angle, _)) => (line.placed(root, angle), angle),
            };
            let sections = curve.sections(&part.stations);
            let numbered = |mut surface: Surface| {
                if let Some((.., beam)) = part.place {
                    let cells = surface.lines.len() + surface.quads.len();
                    surface.of_cells.push(Data::number("beam", vec![beam; cells]));
                }
                surface
            };
            beams.append(numbered(beam::surface(&part.cutout, &curve, &sections, &own, turn)));
            if let Some((layout, _)) = &self.wet {
                let own = bladders::surface(&part.cutout, layout, &sections, pressure, area);
                boxes.append(numbered(own));
            }
            curves.push(curve);
        }
        let mut all = vec![beams];
        if let Some((_, tubes)) = &self.wet {
            all.extend([boxes, tubes::lines(tubes, &curves, pressure)]);
        }
        all
    }
}
