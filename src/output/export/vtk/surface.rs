//! Points, quadrilaterals and lines with data, as an XML file of VTK with appended raw arrays.
//!
//! The format is VTK's "PolyData" (`.vtp`, version 1.0): a header with the name and offset of each array, then `_` and the arrays. Each
//! array follows its size as a `UInt64`; all numbers are little-endian.

use std::fmt::Write as _;

use crate::output::numbers::shortest;

/// Numbers of an array.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum SurfaceValues {
    /// Doubles.
    Double(Vec<f64>),
    /// Integers.
    Whole(Vec<i32>),
}

/// An array of data. `components` names the numbers of a point or cell; it is empty for a scalar.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Data {
    /// Name with unit.
    pub name: &'static str,
    /// Names of the components of a vector.
    pub components: &'static [&'static str],
    /// The numbers.
    pub values: SurfaceValues,
}

impl Data {
    /// One double per point or cell.
    pub fn scalar(name: &'static str, values: Vec<f64>) -> Self {
        Self::new(name, &[], SurfaceValues::Double(values))
    }

    /// One integer per point or cell.
    pub fn number(name: &'static str, values: Vec<i32>) -> Self {
        Self::new(name, &[], SurfaceValues::Whole(values))
    }

    /// A vector in VTK's axes.
    pub fn vector(name: &'static str, values: Vec<f64>) -> Self {
        Self::new(name, &["axial", "transverse", "across"], SurfaceValues::Double(values))
    }

    fn new(name: &'static str, components: &'static [&'static str], values: SurfaceValues) -> Self {
        Self {
            name,
            components,
            values,
        }
    }
}

/// Quadrilaterals and lines on points. In the data of cells lines precede, as VTK requires.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Surface {
    /// Positions [m].
    pub points: Vec<[f64; 3]>,
    /// Lines, by their points.
    pub lines: Vec<Vec<usize>>,
    /// Quadrilaterals, counter-clockwise seen from outside.
    pub quads: Vec<[usize; 4]>,
    /// Data of the points.
    pub of_points: Vec<Data>,
    /// Data of lines and quadrilaterals.
    pub of_cells: Vec<Data>,
}

/// Appended arrays; the header stores their offsets.
#[derive(Default)]
struct Appended {
    bytes: Vec<u8>,
}

impl Appended {
    fn array(&mut self, name: &str, components: &[&str], values: &SurfaceValues) -> String {
        let (kind, bytes): (&str, Vec<u8>) = match values {
            SurfaceValues::Double(all) => ("Float64", all.iter().flat_map(|x| x.to_le_bytes()).collect()),
            SurfaceValues::Whole(all) => ("Int32", all.iter().flat_map(|x| x.to_le_bytes()).collect()),
        };
        let mut tag = format!("<DataArray type=\"{kind}\" Name=\"{name}\"");
        if !components.is_empty() {
            let _ = write!(tag, " NumberOfComponents=\"{}\"", components.len());
        }
        for (k, component) in components.iter().enumerate() {
            let _ = write!(tag, " ComponentName{k}=\"{component}\"");
        }
        let _ = write!(tag, " format=\"appended\" offset=\"{}\"/>", self.bytes.len());
        self.bytes.extend((bytes.len() as u64).to_le_bytes());
        self.bytes.extend(bytes);
        tag
    }

    fn group(&mut self, name: &str, arrays: &[Data]) -> String {
        let tags: String = arrays
            .iter()
            .map(|d| format!("        {}\n", self.array(d.name, d.components, &d.values)))
            .collect();
        format!("      <{name}>\n{tags}      </{name}>\n")
    }

    fn cells<'a>(&mut self, name: &str, cells: impl Iterator<Item = &'a [usize]>) -> String {
        let (mut joined, mut ends) = (vec![], vec![]);
        for cell in cells {
            joined.extend(cell.iter().map(|&p| p as i32));
            ends.push(joined.len() as i32);
        }
        let arrays = [Data::number("connectivity", joined), Data::number("offsets", ends)];
        self.group(name, &arrays)
    }
}

impl Surface {
    /// Adds the points, cells and data of another surface with the same data.
    pub fn append(&mut self, other: Self) {
        let first = self.points.len();
        if self.of_points.is_empty() && self.of_cells.is_empty() {
            *self = other;
            return;
        }
        self.points.extend(other.points);
        let lines = other.lines.into_iter();
        self.lines
            .extend(lines.map(|line| line.into_iter().map(|p| p + first).collect()));
        self.quads
            .extend(other.quads.into_iter().map(|quad| quad.map(|p| p + first)));
        let own = self.of_points.iter_mut().chain(&mut self.of_cells);
        for (own, other) in own.zip(other.of_points.into_iter().chain(other.of_cells)) {
            match (&mut own.values, other.values) {
                (SurfaceValues::Double(own), SurfaceValues::Double(other)) => own.extend(other),
                (SurfaceValues::Whole(own), SurfaceValues::Whole(other)) => own.extend(other),
                _ => {}
            }
        }
    }

    /// Content of the file for the time `t` [s].
    pub fn file(&self, t: f64) -> Vec<u8> {
        let mut appended = Appended::default();
        let points = SurfaceValues::Double(self.points.iter().flatten().copied().collect());
        let pieces = [
            appended.group("PointData", &self.of_points),
            appended.group("CellData", &self.of_cells),
            format!(
                "      <Points>\n        {}\n      </Points>\n",
                appended.array("position_m", &["axial", "transverse", "across"], &points)
            ),
            appended.cells("Lines", self.lines.iter().map(Vec::as_slice)),
            appended.cells("Polys", self.quads.iter().map(|q| &q[..])),
        ]
        .concat();
        let head = format!(
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n  <PolyData>\n    \
             <FieldData>\n      <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{}</DataArray>\n    \
             </FieldData>\n    \
             <Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n\
             {pieces}    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_",
            shortest(t),
            self.points.len(),
            self.lines.len(),
            self.quads.len()
        );
        [head.as_bytes(), &appended.bytes, b"\n  </AppendedData>\n</VTKFile>\n"].concat()
    }
}
