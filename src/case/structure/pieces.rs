//! Pieces of a structure: single beams with their own axes.

use super::{Along, joined_place};
use crate::case::schema::{Attachment, Case, End, EndConditions, Ends, Mesh, PlacedBeam, Probe, Span, Start};
use crate::case::spans;
use crate::numerics::{Planar, Scalar};

/// A beam of a structure, or the part of one between two joints.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Number of its beam.
    pub beam: usize,
    /// First of its segments, and the one behind its last, among those of all beams.
    pub segments: [usize; 2],
    /// Place of its root along its beam [m].
    pub from: f64,
    /// Length [m].
    pub length: f64,
    /// True if it begins, and if it ends, with its beam.
    pub at_end: [bool; 2],
    /// Position of its root [m].
    pub origin: Planar<f64>,
    /// Angle from z towards x [rad].
    pub angle: f64,
}

/// A joined place: end `2 k` is the root of piece k, `2 k + 1` its tip.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// End of a beam.
    End(usize),
    /// Tip of one piece and root of the next of the same beam.
    Between([usize; 2]),
}

impl Place {
    /// Ends of pieces at the place.
    pub fn ends(&self) -> &[usize] {
        match self {
            Self::End(end) => std::slice::from_ref(end),
            Self::Between(ends) => ends,
        }
    }
}

impl Piece {
    /// Direction of the straight piece.
    pub fn direction(&self) -> Planar<f64> {
        Planar::tangent(self.angle)
    }

    /// Position of the root or the tip in the straight piece [m].
    pub fn end(&self, at_tip: bool) -> Planar<f64> {
        self.origin + self.direction() * if at_tip { self.length } else { 0.0 }
    }

    /// Components of a vector along the axes of the piece.
    pub fn own<T: Scalar>(&self, v: Planar<T>) -> Planar<T> {
        v.turned_back(self.direction())
    }

    /// Vector with these components along the axes of the piece.
    pub fn turned<T: Scalar>(&self, v: Planar<T>) -> Planar<T> {
        v.turned(self.direction())
    }

    /// The piece as a case of its own: the section of its segments, the conditions at its free ends, and the loads, attachments and probes of
    /// its beam that it has. Loads of the whole case are not included.
    pub fn case(&self, whole: &Case) -> Case {
        let beam = &whole.beams[self.beam];
        let total = beam.length_m.unwrap_or(self.length);
        let share = |at: f64| (at * total - self.from) / self.length;
        let last = self.at_end[1];
        let within = |at: f64| {
            let here = share(at);
            here >= -NEAR && (here < 1.0 - NEAR || (last && here <= 1.0 + NEAR))
        };
        let own = |at: f64| share(at).clamp(0.0, 1.0);
        let end = |k: usize| -> End {
            let own = beam.ends.both()[k].filter(|_| self.at_end[k]);
            own.cloned().unwrap_or_else(|| End::Free(EndConditions::default()))
        };
        let attachments = beam.attachments.iter().filter(|one| within(one.at));
        let probes = beam.probes.iter().filter(|one| within(one.at));
        let segments = self.segments[1] - self.segments[0];
        let mut of_beam = whole.beam.clone();
        of_beam.length_m = self.length;
        Case {
            spans: self.spans(whole),
            beam: of_beam,
            bladders: whole.bladders.clone().map(|mut bladders| {
                bladders.per_row = segments;
                bladders
            }),
            mesh: Mesh {
                segments: Some(segments),
                ..whole.mesh.clone()
            },
            beams: vec![],
            joints: vec![],
            ends: Ends {
                root: end(0),
                tip: end(1),
            },
            loads: beam.loads.clone(),
            attachments: attachments
                .map(|one| Attachment {
                    at: own(one.at),
                    ..one.clone()
                })
                .collect(),
            probes: probes
                .map(|one| Probe {
                    at: own(one.at),
                    ..one.clone()
                })
                .collect(),
            network: None,
            start: Start {
                pressures: whole.start.pressures.clone(),
                ..Start::default()
            },
            contacts: vec![],
            ..whole.clone()
        }
    }

    /// Spans of the segments of the piece.
    fn spans(&self, whole: &Case) -> Vec<Span> {
        let (mut all, mut first) = (vec![], 0);
        for span in &whole.spans {
            let count = span.segments.unwrap_or(1);
            let [from, to] = [self.segments[0].max(first), self.segments[1].min(first + count)];
            if from < to {
                all.push(Span {
                    segments: Some(to - from),
                    length_m: span.length_m.map(|length| match to - from == count {
                        true => length,
                        false => length * (to - from) as f64 / count as f64,
                    }),
                    ..span.clone()
                });
            }
            first += count;
        }
        all
    }
}

/// Relative distance of places that counts as rounding.
const NEAR: f64 = 1e-9;

/// Number of the first segment of each beam, and of all segments.
fn first_segments(case: &Case) -> Vec<usize> {
    let mut first = vec![0];
    for beam in &case.beams {
        first.push(first[first.len() - 1] + beam.segments.unwrap_or(1));
    }
    first
}

/// Pieces of a structure, and the places of each joint; places that do not exist are left out.
pub fn pieces(case: &Case) -> (Vec<Piece>, Vec<Vec<Place>>) {
    let lengths = spans::segment_lengths(case);
    let first = first_segments(case);
    let named = |name: &str| case.beams.iter().position(|beam| beam.name == name);
    let count = |beam: usize| first[beam + 1] - first[beam];
    // within a beam, the numbers of segments behind which joints are
    let inside = |written: &str| {
        let (name, along) = joined_place(written)?;
        let beam = named(name)?;
        match along {
            Along::Behind(behind) if behind < count(beam) => Some((beam, behind)),
            _ => None,
        }
    };
    let places = || case.joints.iter().flat_map(|joint| &joint.at);
    let origins = origins(case);
    let mut all = vec![];
    for (k, beam) in case.beams.iter().enumerate() {
        let mut cuts: Vec<usize> = places()
            .filter_map(|at| inside(at))
            .filter(|(b, _)| *b == k)
            .map(|(_, cut)| cut)
            .collect();
        cuts.extend([0, count(k)]);
        cuts.sort_unstable();
        cuts.dedup();
        pieces_of(
            (k, beam),
            origins[k].unwrap_or_default(),
            &cuts,
            first[k],
            &lengths,
            &mut all,
        );
    }
    let end = |written: &String| {
        let (name, along) = joined_place(written)?;
        let beam = named(name)?;
        let of = |piece: &Piece| piece.beam == beam;
        let (root, tip) = (all.iter().position(of)?, all.iter().rposition(of)?);
        Some(match along {
            Along::Root => Place::End(2 * root),
            Along::Tip => Place::End(2 * tip + 1),
            Along::Behind(behind) if behind == count(beam) => Place::End(2 * tip + 1),
            Along::Behind(behind) => {
                let next = all
                    .iter()
                    .position(|piece| of(piece) && piece.segments[0] == first[beam] + behind)?;
                Place::Between([2 * next - 1, 2 * next])
            }
        })
    };
    let joints = case
        .joints
        .iter()
        .map(|joint| joint.at.iter().filter_map(end).collect())
        .collect();
    (all, joints)
}

/// Position of the root of each beam [m]: as given, of the first beam 0, of others where a joint puts it; none for a beam that nothing places.
pub fn origins(case: &Case) -> Vec<Option<Planar<f64>>> {
    let first = first_segments(case);
    let lengths = spans::segment_lengths(case);
    let mut origins: Vec<_> = case
        .beams
        .iter()
        .map(|beam| beam.origin_m.map(|[x, z]| Planar { x, z }))
        .collect();
    if let Some(origin) = origins.first_mut() {
        origin.get_or_insert_default();
    }
    // beam of a place, and the vector from its root
    let along = |written: &String| {
        let (name, along) = joined_place(written)?;
        let beam = case.beams.iter().position(|beam| beam.name == name)?;
        let (count, own) = (first[beam + 1] - first[beam], &case.beams[beam]);
        let distance = match along {
            Along::Root => 0.0,
            Along::Behind(behind) if behind < count => lengths.get(first[beam]..first[beam] + behind)?.iter().sum(),
            Along::Tip | Along::Behind(_) => own.length_m.unwrap_or(case.beam.length_m),
        };
        Some((beam, Planar::tangent(own.angle_rad) * distance))
    };
    let joints: Vec<Vec<_>> = case
        .joints
        .iter()
        .map(|joint| joint.at.iter().filter_map(along).collect())
        .collect();
    let mut placed = true;
    while std::mem::take(&mut placed) {
        for joint in &joints {
            let known = joint.iter().find_map(|(beam, by)| Some(origins[*beam]? + *by));
            let Some(at) = known else { continue };
            for (beam, by) in joint {
                if origins[*beam].is_none() {
                    origins[*beam] = Some(at - *by);
                    placed = true;
                }
            }
        }
    }
    origins
}

/// Adds the pieces of a beam between cuts.
fn pieces_of(
    (number, beam): (usize, &PlacedBeam),
    origin: Planar<f64>,
    cuts: &[usize],
    first: usize,
    lengths: &[f64],
    all: &mut Vec<Piece>,
) {
    let direction = Planar::tangent(beam.angle_rad);
    let mut from = 0.0;
    for (k, cut) in cuts.windows(2).enumerate() {
        let own = first + cut[0]..first + cut[1];
        let whole = cuts.len() == 2;
        let length = match beam.length_m.filter(|_| whole) {
            Some(length) => length,
            None => lengths.get(own.clone()).into_iter().flatten().sum(),
        };
        all.push(Piece {
            beam: number,
            segments: [own.start, own.end],
            from,
            length,
            at_end: [k == 0, k + 2 == cuts.len()],
            origin: origin + direction * from,
            angle: beam.angle_rad,
        });
        from += length;
    }
}
