//! Finite volumes along the bladders, and the conductances between them.

use crate::case::schema::BladderEnd;
use crate::model::Wet;
use crate::model::network::{LinkKind, Node};

/// Where a link ends, on the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A cell, with the resistance of half of it in the way.
    Cell(usize),
    /// An unknown junction pressure.
    Junction(usize),
    /// A prescribed pressure.
    Port(usize),
}

/// A link on the mesh.
#[derive(Clone, Debug)]
pub struct MeshLink {
    /// Where positive flow comes from.
    pub from: Place,
    /// Where it goes.
    pub to: Place,
    /// Resistance of the half cells at its ends [Pa s/m^3].
    pub half_cells: f64,
    /// Resistance in between [Pa s/m^3].
    pub resistance: f64,
    /// What it is.
    pub kind: LinkKind,
}

/// Cells of all bladders: bladder b holds cells `b cells_per_bladder ..`, inlet to outlet; upper row first.
#[derive(Clone, Debug)]
pub struct FluidMesh {
    /// Bladders, `n`.
    pub bladders: usize,
    /// Finite volumes in each.
    pub cells_per_bladder: usize,
    /// All cells.
    pub cells: usize,
    /// Length of a cell `ds` [m].
    pub ds: f64,
    /// Conductance between neighbouring cells of a bladder, `q1b/(mu ds)` [m^3/(s Pa)].
    pub conductance: f64,
    /// Links, in the order of the network's.
    pub links: Vec<MeshLink>,
    /// Where the network's sources enter.
    pub sources: Vec<Place>,
    /// Ends of the network's bridges.
    pub bridges: Vec<(Place, Place)>,
}

impl FluidMesh {
    /// Cells and links of the network.
    pub fn new(wet: &Wet, cells_per_bladder: usize) -> Self {
        let bladders = 2 * wet.per_row;
        let ds = wet.bladder_length / cells_per_bladder as f64;
        let conductance = wet.network.bladder_mobility / ds;
        let half = 0.5 / conductance;
        let place = |node: Node| match node {
            Node::Cell { bladder, end } => Place::Cell(match end {
                BladderEnd::Inlet => bladder * cells_per_bladder,
                BladderEnd::Outlet => (bladder + 1) * cells_per_bladder - 1,
            }),
            Node::Junction(j) => Place::Junction(j),
            Node::Port(p) => Place::Port(p),
        };
        let half_of = |p: Place| if let Place::Cell(_) = p { half } else { 0.0 };
        let links = wet
            .network
            .links
            .iter()
            .map(|link| {
                let (from, to) = (place(link.from), place(link.to));
                MeshLink {
                    from,
                    to,
                    half_cells: half_of(from) + half_of(to),
                    resistance: link.resistance,
                    kind: link.kind,
                }
            })
            .collect();
        Self {
            bladders,
            cells_per_bladder,
            cells: bladders * cells_per_bladder,
            ds,
            conductance,
            links,
            sources: wet.network.sources.iter().map(|s| place(s.into)).collect(),
            bridges: wet
                .network
                .bridges
                .iter()
                .map(|b| (place(b.from), place(b.to)))
                .collect(),
        }
    }

    /// Cells of a bladder.
    #[inline]
    pub fn cells_of(&self, bladder: usize) -> std::ops::Range<usize> {
        bladder * self.cells_per_bladder..(bladder + 1) * self.cells_per_bladder
    }
}
