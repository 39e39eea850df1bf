//! Files of VTK read back, as far as `slcbeam export` writes them.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Value of an attribute in a tag.
fn attribute<'a>(tag: &'a str, name: &str) -> &'a str {
    let key = format!(" {name}=\"");
    let at = tag.find(&key).unwrap_or_else(|| panic!("no {name} in {tag}")) + key.len();
    tag[at..].split('"').next().unwrap()
}

/// A `.vtp` file: its time, and its arrays by section and name; integers as doubles.
pub struct Piece {
    time: f64,
    arrays: BTreeMap<String, Vec<f64>>,
}

impl Piece {
    fn read(path: &Path) -> Self {
        let bytes = fs::read(path).unwrap();
        let mark = b"<AppendedData encoding=\"raw\">\n_";
        let at = bytes.windows(mark.len()).position(|w| w == mark).unwrap();
        let (head, appended) = (std::str::from_utf8(&bytes[..at]).unwrap(), &bytes[at + mark.len()..]);
        assert!(head.contains("byte_order=\"LittleEndian\" header_type=\"UInt64\""));
        assert!(appended.ends_with(b"\n  </AppendedData>\n</VTKFile>\n"));
        let time = head
            .split("format=\"ascii\">")
            .nth(1)
            .unwrap()
            .split('<')
            .next()
            .unwrap();
        let mut arrays = BTreeMap::new();
        let mut section = "";
        for tag in head.split('<').skip(1) {
            let name = tag.split([' ', '>']).next().unwrap();
            match name {
                "PointData" | "CellData" | "Points" | "Lines" | "Polys" => section = name,
                "DataArray" if tag.contains("format=\"appended\"") => {
                    let offset: usize = attribute(tag, "offset").parse().unwrap();
                    let size = u64::from_le_bytes(appended[offset..offset + 8].try_into().unwrap()) as usize;
                    let data = &appended[offset + 8..offset + 8 + size];
                    let values = match attribute(tag, "type") {
                        "Float64" => data
                            .chunks_exact(8)
                            .map(|b| f64::from_le_bytes(b.try_into().unwrap()))
                            .collect(),
                        "Int32" => data
                            .chunks_exact(4)
                            .map(|b| f64::from(i32::from_le_bytes(b.try_into().unwrap())))
                            .collect(),
                        other => panic!("{other}"),
                    };
                    arrays.insert(format!("{section} {}", attribute(tag, "Name")), values);
                }
                _ => {}
            }
        }
        let piece = Self {
            time: time.parse().unwrap(),
            arrays,
        };
        piece.check(head);
        piece
    }

    pub fn get(&self, name: &str) -> &[f64] {
        self.arrays.get(name).unwrap_or_else(|| panic!("no {name}"))
    }

    pub fn points(&self) -> Vec<[f64; 3]> {
        let all = self.get("Points position_m").chunks_exact(3);
        all.map(|p| [p[0], p[1], p[2]]).collect()
    }

    pub fn quads(&self) -> Vec<[usize; 4]> {
        let all = self.get("Polys connectivity").chunks_exact(4);
        all.map(|q| [q[0] as usize, q[1] as usize, q[2] as usize, q[3] as usize])
            .collect()
    }

    /// Counts in the head are those of the arrays; every cell's points are there.
    fn check(&self, head: &str) {
        let piece = head.split('<').find(|t| t.starts_with("Piece")).unwrap();
        let count = |name: &str| attribute(piece, name).parse::<usize>().unwrap();
        let points = count("NumberOfPoints");
        assert_eq!(self.get("Points position_m").len(), 3 * points);
        let mut cells = 0;
        for (name, kind) in [("NumberOfLines", "Lines"), ("NumberOfPolys", "Polys")] {
            let (joined, ends) = (
                self.get(&format!("{kind} connectivity")),
                self.get(&format!("{kind} offsets")),
            );
            assert_eq!(ends.len(), count(name));
            assert_eq!(ends.last().copied().unwrap_or(0.0), joined.len() as f64);
            assert!(joined.iter().all(|&p| (p as usize) < points));
            cells += ends.len();
        }
        for (name, values) in &self.arrays {
            match name.split_once(' ').unwrap() {
                ("PointData", "u_m" | "v_m_s") => assert_eq!(values.len(), 3 * points, "{name}"),
                ("PointData", _) => assert_eq!(values.len(), points, "{name}"),
                ("CellData", _) => assert_eq!(values.len(), cells, "{name}"),
                _ => {}
            }
        }
    }

    /// Volume inside quadrilaterals that close and look outwards: flat ones count exactly.
    pub fn volume(&self) -> f64 {
        let p = self.points();
        let triple = |a: [f64; 3], b: [f64; 3], c: [f64; 3]| {
            a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
        };
        let of = |q: &[usize; 4]| triple(p[q[0]], p[q[1]], p[q[2]]) + triple(p[q[0]], p[q[2]], p[q[3]]);
        self.quads().iter().map(of).sum::<f64>() / 6.0
    }
}

/// The collection: time, part's name, file; all files are there and tell the same time.
pub fn collection(path: &Path) -> Vec<(f64, String, Piece)> {
    let mut all = vec![];
    for instant in tags(path) {
        let t: f64 = attribute(&instant, "timestep").parse().unwrap();
        for (k, block) in tags(&path.with_file_name(attribute(&instant, "file")))
            .iter()
            .enumerate()
        {
            assert_eq!(attribute(block, "index"), k.to_string());
            let piece = Piece::read(&path.with_file_name(attribute(block, "file")));
            assert_eq!(t, piece.time);
            all.push((t, attribute(block, "name").to_string(), piece));
        }
    }
    all
}

/// What a file lists.
fn tags(path: &Path) -> Vec<String> {
    let text = fs::read_to_string(path).unwrap();
    let sets = text.split('<').filter(|t| t.starts_with("DataSet"));
    sets.map(str::to_owned).collect()
}
