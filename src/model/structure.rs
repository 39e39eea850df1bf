//! Structures: single beams with their own axes, and their joints.

use std::ops::Range;

use super::attachments::PointForce;
use super::loads::{LoadKind, LoadMeasure};
use super::{DistributedLoad, EffectSet, Model, Scales, Section, Wet, mean_section};
use crate::case::Translation;
use crate::case::schema::{Attachment, Case, Contact, ElasticJoint, Hinge, JointKind, Load};
use crate::case::structure::{self, Piece};
use crate::functions::Signal;
use crate::numerics::{Planar, Scalar, ramp, ramp_integral};

/// Beams of a structure, each with its own model, and their joints.
#[derive(Clone, Debug)]
pub struct Structure {
    /// Beams, and parts of beams between joints.
    pub beams: Vec<BeamOfStructure>,
    /// Joints.
    pub joints: Vec<JointOfEnds>,
    /// Share of the rest angles of hinges: 1, and from 0 on along the path of equilibria, as for loads.
    pub rest: Signal,
}

/// A beam of a structure, or a part of one between two joints.
#[derive(Clone, Debug)]
pub struct BeamOfStructure {
    /// Name of the beam.
    pub name: String,
    /// Its place.
    pub piece: Piece,
    /// Length of its whole beam [m].
    pub whole: f64,
    /// It as a case of its own.
    pub case: Case,
    /// The model of that case.
    pub model: Model,
    /// Its loads, attachments and contacts among those of the structure.
    pub of_structure: [Range<usize>; 3],
}

/// A joint of ends; end `2 k` is the root of beam k, `2 k + 1` its tip.
#[derive(Clone, Debug)]
pub struct JointOfEnds {
    /// Ends that turn alike, for each part of the joint that turns by itself.
    pub groups: Vec<Vec<usize>>,
    /// Spring, damper and stop between the first group and each other one.
    pub hinge: Option<Hinge>,
    /// Forces and moments between the first group and each other one; none if all are at one place or rigid.
    pub elastic: Option<ElasticJoint>,
    /// Rotary inertia of the body [kg m^2].
    pub inertia: f64,
}

impl JointOfEnds {
    /// All ends of the joint; the first one is that of the body.
    pub fn ends(&self) -> impl Iterator<Item = usize> + '_ {
        self.groups.iter().flatten().copied()
    }
}

impl Structure {
    /// Structure of a case with these effects; none for a single beam.
    pub fn from_case(case: &Case, effects: &EffectSet) -> Option<Self> {
        if !case.is_structure() {
            return None;
        }
        let (pieces, joined) = structure::pieces(case);
        let mut firsts = [0; 3];
        let bodies = case.joints.iter().zip(&joined).filter(|(joint, _)| joint.mass_kg > 0.0);
        let bodies: Vec<(usize, f64)> = bodies
            .filter_map(|(joint, places)| Some((places.first()?.ends()[0], joint.mass_kg)))
            .collect();
        let beams = pieces.into_iter().enumerate().map(|(number, piece)| {
            let mut own = piece.case(case);
            let name = &case.beams[piece.beam].name;
            own.probes
                .iter_mut()
                .for_each(|probe| probe.name = format!("{name}.{}", probe.name));
            // the mass of a body acts at the end of its joint
            own.attachments.extend(
                bodies
                    .iter()
                    .filter(|(end, _)| end / 2 == number)
                    .map(|(end, mass)| Attachment {
                        mass_kg: *mass,
                        ..Attachment::at((end % 2) as f64)
                    }),
            );
            own.contacts = case
                .contacts
                .iter()
                .map(|contact| in_own_axes(contact, &piece, case))
                .collect();
            let mut model = Model::from_parts(&own, mean_section(&own), None, effects.clone());
            add_loads(case, &piece, &mut model);
            // sizes of motion depend on the loads of the case as well
            own.loads
                .extend(case.loads.iter().flat_map(|load| along_own_axes(load, &piece)));
            let counts = [model.loads.len(), model.attachments.len(), model.contacts.len()];
            let of_structure = [0, 1, 2].map(|k| firsts[k]..firsts[k] + counts[k]);
            firsts = [0, 1, 2].map(|k| of_structure[k].end);
            BeamOfStructure {
                name: case.beams[piece.beam].name.clone(),
                whole: case.beams[piece.beam].length_m.unwrap_or(piece.length),
                piece,
                case: own,
                model,
                of_structure,
            }
        });
        let beams = beams.collect();
        let joints = case.joints.iter().zip(joined).map(|(written, places)| {
            let each = places.iter().map(|place| place.ends().to_vec());
            let (hinge, elastic) = match &written.kind {
                JointKind::Rigid(_) => (None, None),
                JointKind::Hinge(hinge) => (Some(*hinge), None),
                JointKind::Elastic(elastic) => (None, Some(*elastic)),
                JointKind::Slider(slider) => (None, Some(slider.elastic())),
            };
            JointOfEnds {
                groups: match written.kind {
                    JointKind::Rigid(_) => vec![each.flatten().collect()],
                    _ => each.collect(),
                },
                hinge,
                elastic,
                inertia: written.rotary_inertia_kg_m2,
            }
        });
        let joints = joints.collect();
        Some(Self {
            beams,
            joints,
            rest: Signal::Constant(1.0),
        })
    }

    /// Largest scales of its beams, and of the motion to the rest angles of hinges. A beam counts as one with those that continue it,
    /// [`Self::reaches`].
    pub fn scales(&self, case: &Case, section: &Section, wet: Option<&Wet>) -> Scales {
        let reaches = self.reaches();
        let each = self.beams.iter().zip(&reaches).map(|(beam, reach)| {
            let mut case = beam.case.clone();
            case.beam.length_m = *reach;
            Scales::estimate(&case, &beam.model.section, wet)
        });
        let mut all = each
            .reduce(|all, one| all.larger(&one))
            .unwrap_or_else(|| Scales::estimate(case, section, wet));
        let sprung = self.joints.iter().filter_map(|joint| joint.hinge);
        let sprung = sprung.filter(|hinge| hinge.stiffness_n_m_rad > 0.0);
        let rest = sprung.map(|hinge| hinge.rest_rad.abs()).fold(0.0, f64::max);
        let longest = reaches.iter().copied().fold(0.0, f64::max);
        all.transverse = all.transverse.max(rest * longest);
        all.transverse_rate = all.transverse_rate.max(rest * longest * all.frequency);
        all
    }

    /// Length of each beam with those that continue it in joints of two ends: the way from a support to the farthest end, the least of all
    /// supports; without support the longest way between two ends [m].
    fn reaches(&self) -> Vec<f64> {
        let supported = |end: &usize| {
            let ends = &self.beams[end / 2].case.ends;
            let motion = [&ends.root, &ends.tip][end % 2].resolve();
            [motion.transverse, motion.axial]
                .iter()
                .any(|along| matches!(along, Translation::Displacement(_)))
        };
        let mut reaches = vec![0.0; self.beams.len()];
        for first in 0..self.beams.len() {
            if reaches[first] > 0.0 {
                continue;
            }
            let ways = self.ways(2 * first);
            let ends: Vec<usize> = (0..ways.len()).filter(|end| ways[*end].is_finite()).collect();
            let farthest = |from: usize| {
                let ways = self.ways(from);
                ends.iter().map(|end| ways[*end]).fold(0.0, f64::max)
            };
            let held = ends.iter().copied().filter(supported).map(farthest).reduce(f64::min);
            let reach = held.unwrap_or_else(|| ends.iter().copied().map(farthest).fold(0.0, f64::max));
            for end in ends {
                reaches[end / 2] = reach;
            }
        }
        reaches
    }

    /// Shortest way along beams and through joints of two ends, from an end to every other [m]; infinite without a way.
    fn ways(&self, from: usize) -> Vec<f64> {
        let mut ways = vec![f64::INFINITY; 2 * self.beams.len()];
        ways[from] = 0.0;
        let mut shorter = true;
        while shorter {
            shorter = false;
            let mut pass = |one: usize, other: usize, length: f64| {
                for (from, to) in [(one, other), (other, one)] {
                    if ways[from] + length < ways[to] {
                        ways[to] = ways[from] + length;
                        shorter = true;
                    }
                }
            };
            for (k, beam) in self.beams.iter().enumerate() {
                pass(2 * k, 2 * k + 1, beam.piece.length);
            }
            for joint in &self.joints {
                let mut ends = joint.ends();
                if let (Some(one), Some(other), None) = (ends.next(), ends.next(), ends.next()) {
                    pass(one, other, (self.place_of(other) - self.place_of(one)).squared().sqrt());
                }
            }
        }
        ways
    }

    /// Place of an end in the straight structure [m].
    pub fn place_of(&self, end: usize) -> Planar<f64> {
        self.beams[end / 2].piece.end(end % 2 == 1)
    }
}

/// Adds the loads of the case to a beam and its masses, along its axes. Their signals remain those of the case.
fn add_loads(case: &Case, piece: &Piece, model: &mut Model) {
    let section = model.section;
    for written in &case.loads {
        let loads = DistributedLoad::resolve(written, &section);
        model
            .loads
            .extend(loads.into_iter().flat_map(|load| turned(load, piece)));
        for body in model
            .attachments
            .iter_mut()
            .filter(|body| body.mass > 0.0 && written.is_body())
        {
            let loads = DistributedLoad::on(written, [body.mass; 2]);
            let at = body.at;
            let own = loads.into_iter().flat_map(|load| turned(load, piece));
            body.forces.extend(own.map(|load| PointForce::weight(load, at)));
        }
    }
}

/// Parts of a load along the axes of a beam.
fn turned(load: DistributedLoad, piece: &Piece) -> Vec<DistributedLoad> {
    let along = match load.kind {
        LoadKind::ForceX | LoadKind::MomentX => Planar { x: 1.0, z: 0.0 },
        LoadKind::ForceZ | LoadKind::MomentZ => Planar { x: 0.0, z: 1.0 },
        _ => return vec![load],
    };
    let kinds = match load.kind {
        LoadKind::ForceX | LoadKind::ForceZ => [LoadKind::ForceX, LoadKind::ForceZ],
        _ => [LoadKind::MomentX, LoadKind::MomentZ],
    };
    let own = piece.own(along);
    let part = |(kind, share): (LoadKind, f64)| DistributedLoad {
        kind,
        factor: load.factor * share,
        per: match load.per {
            LoadMeasure::Length => LoadMeasure::Length,
            LoadMeasure::Mass(acceleration) => LoadMeasure::Mass(acceleration * share),
            LoadMeasure::Weight(acceleration) => LoadMeasure::Weight(acceleration * share),
        },
        ..load.clone()
    };
    let parts = kinds.into_iter().zip([own.x, own.z]);
    parts.filter(|(_, share)| *share != 0.0).map(part).collect()
}

/// A load along the axes of the case, along those of a beam.
fn along_own_axes(load: &Load, piece: &Piece) -> Vec<Load> {
    let parts = |x: f64, z: f64, written: &crate::case::schema::Distributed| {
        let own = piece.own(Planar { x, z });
        let scaled = |factor: f64| {
            let mut part = written.clone();
            if factor != 1.0 {
                part.signal = Signal::Product(vec![Signal::Constant(factor), part.signal]);
            }
            (factor != 0.0).then_some(part)
        };
        [scaled(own.x), scaled(own.z)]
    };
    let both = |[x, z]: [Option<_>; 2], across: fn(_) -> Load, along: fn(_) -> Load| -> Vec<Load> {
        x.map(across).into_iter().chain(z.map(along)).collect()
    };
    match load {
        Load::ForceXNM(written) => both(parts(1.0, 0.0, written), Load::ForceXNM, Load::ForceZNM),
        Load::ForceZNM(written) => both(parts(0.0, 1.0, written), Load::ForceXNM, Load::ForceZNM),
        Load::MomentXN(written) => both(parts(1.0, 0.0, written), Load::MomentXN, Load::MomentZN),
        Load::MomentZN(written) => both(parts(0.0, 1.0, written), Load::MomentXN, Load::MomentZN),
        Load::BodyXMS2(written) => both(parts(1.0, 0.0, written), Load::BodyXMS2, Load::BodyZMS2),
        Load::BodyZMS2(written) => both(parts(0.0, 1.0, written), Load::BodyXMS2, Load::BodyZMS2),
        Load::Gravity { x_m_s2, z_m_s2 } => {
            let own = piece.own(Planar { x: *x_m_s2, z: *z_m_s2 });
            vec![Load::Gravity {
                x_m_s2: own.x,
                z_m_s2: own.z,
            }]
        }
        other => vec![other.clone()],
    }
}

/// A wall or circle in the axes of a beam.
fn in_own_axes(contact: &Contact, piece: &Piece, case: &Case) -> Contact {
    let mut own = contact.clone();
    let place = |[x, z]: [f64; 2]| {
        let own = piece.own(Planar { x, z } - piece.origin);
        [own.x, own.z]
    };
    own.name = format!("{}.{}", case.beams[piece.beam].name, contact.name);
    own.point_m = own.point_m.map(place);
    own.normal = own.normal.map(|[x, z]| {
        let own = piece.own(Planar { x, z });
        [own.x, own.z]
    });
    if let Some(circle) = &mut own.circle {
        circle.center_m = place(circle.center_m);
    }
    own
}

/// `[E104]` Moment of a hinge at the relative angle β and its rate, and its energy: a spring, a damper, and stops beyond `β_- .. β_+`,
///
/// ```text
/// M = k (β - β_0) + c β_t + k_s (s(β - β_+) - s(β_- - β))        s(x) = 0 below 0,  x²/(2 d) up to d,  x - d/2 beyond
/// E = k (β - β_0)²/2 + k_s (S(β - β_+) + S(β_- - β))             S' = s
/// ```
#[derive(Clone, Copy, Debug)]
pub struct HingeMoments<T> {
    /// Elastic moment [N m].
    pub elastic: T,
    /// Moment of the damper [N m].
    pub damping: T,
}

/// Moments of a hinge, [`HingeMoments`].
#[inline]
pub fn hinge_moments<T: Scalar>(hinge: &Hinge, angle: T, rate: T) -> HingeMoments<T> {
    let mut elastic = (angle - T::constant(hinge.rest_rad)) * hinge.stiffness_n_m_rad;
    if let Some(stop) = &hinge.stop {
        let stops = |beyond: T| beyond.lift(|x| ramp(x, stop.smoothing_rad));
        let [upper, lower] = [angle - T::constant(stop.to_rad), T::constant(stop.from_rad) - angle].map(stops);
        elastic += (upper - lower) * stop.stiffness_n_m_rad;
    }
    HingeMoments {
        elastic,
        damping: rate * hinge.damping_n_m_s_rad,
    }
}

/// `[E106]` Force and moment of an elastic joint: those of the displacement d and the rotation β of its second place relative to the first,
/// along the axes of the first beam, which turn with the angle φ_1 of the joint there,
///
/// ```text
/// d = R(-φ_1) (x_2 - x_1) - (X_2 - X_1)      β = φ_2 - φ_1      (F, M) = K (d, β) + C (d, β)_t      E = (d, β)·K (d, β)/2
/// ```
#[inline]
pub fn elastic_forces<T: Scalar>(law: &ElasticJoint, by: [T; 3], rates: [T; 3]) -> [T; 3] {
    let row = |matrix: &[[f64; 3]; 3], of: &[T; 3], i: usize| {
        of[0] * matrix[i][0] + of[1] * matrix[i][1] + of[2] * matrix[i][2]
    };
    [0, 1, 2].map(|i| row(&law.stiffness, &by, i) + row(&law.damping, &rates, i))
}

/// Energy of a hinge [J].
pub fn hinge_energy(hinge: &Hinge, angle: f64) -> f64 {
    let apart = angle - hinge.rest_rad;
    let stopped = hinge.stop.as_ref().map_or(0.0, |stop| {
        let stored = |beyond: f64| ramp_integral(beyond, stop.smoothing_rad);
        stop.stiffness_n_m_rad * (stored(angle - stop.to_rad) + stored(stop.from_rad - angle))
    });
    0.5 * hinge.stiffness_n_m_rad * apart * apart + stopped
}
