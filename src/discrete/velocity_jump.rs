//! Velocity jumps of driven ends, and their transmission along the beam by rotary inertia.
//!
//! At a jump only impulses matter. With point masses alone, free nodes keep their velocities; rotary inertia couples neighbors, `[E13]`
//! and `[E27]`:
//!
//! ```text
//! m h_i Δv_i + m_a h_i e_n e_n·Δv_i = ΔS_{i+1/2} - ΔS_{i-1/2} (+ P_i, of a driven end)      ΔS = J/h n n·(Δv_{i+1} - Δv_i)
//! J = m y11/λ² (conservative), m y11 (published), n = (cos φ, -sin φ);  m y11, n = (1, 0) where rotary inertia has no axial part
//! ```
//!
//! Bodies that rotate with the beam, `[E69]` and `[E70]`, couple the nodes of their cells. The equations are then solved by conjugate
//! gradients, a few iterations per body, with the equations above as the preconditioner.
//!
//! Along a straight beam this is `Δv = Δv_0 exp(-θ/√y11)` on fine meshes, and the end moves the mass `m √y11` with it. The energy gains
//! `P·(v⁻ + v⁺)/2` at driven ends and nothing elsewhere; the angular momentum gains the moment of the impulses. Both are exact.

use nalgebra::{Matrix2, Vector2};

use super::residual::ambient_fluid::node_tangent;
use super::{MeshedBody, System, TimeData, Workspace};
use crate::case::schema::Effect;
use crate::model::Kinematics;
use crate::numerics::Planar;

/// Largest error of the conjugate gradients relative to the impulses.
const CLOSE: f64 = 1e-14;
/// Maximum number of iterations per body: a body adds three search directions, rounding errors add more.
const TRIES: usize = 8;

/// Velocities or impulses of all nodes.
pub type Nodal = Vec<Planar<f64>>;

/// Velocities of nodes in the workspace [m/s].
pub fn velocities(w: &Workspace<f64>) -> Nodal {
    w.motion.v.clone()
}

/// Velocity jumps of all nodes [m/s] caused by those of driven ends; none if nothing couples nodes or directions. The workspace contains
/// the position of the beam.
pub fn spread(system: &System, [before, after]: [&TimeData; 2], w: &Workspace<f64>) -> Option<Nodal> {
    let l = &system.layout;
    if system.model.structure.is_some() {
        return None; // its driven ends do not jump
    }
    // the surrounding fluid couples both directions of a node, rotating sections couple nodes
    let added = system.model.section.ambient.added_mass > 0.0;
    let coupled = system.turns_with_its_line() || added || turned(system).is_some();
    if !l.inertia || !coupled || system.model.kinematics == Kinematics::Bar {
        return None;
    }
    let last = system.mesh.nodes - 1;
    let mut given = vec![[None; 2]; last + 1];
    for (node, end) in [(0, 0), (last, 1)] {
        let (from, to) = (&before.ends[end], &after.ends[end]);
        given[node] = [0, 1].map(|k| from.u[k].zip(to.u[k]).map(|(from, to)| to.rate - from.rate));
    }
    if l.lines[1].v.is_none() {
        given.iter_mut().for_each(|node| node[1] = Some(0.0));
    }
    let jumps = given.iter().flatten().flatten().any(|jump| *jump != 0.0);
    jumps.then(|| {
        let alone = solve(system, &given, None, w);
        match turned(system) {
            Some(_) => with_bodies(system, &given, alone, w),
            None => alone,
        }
    })
}

/// Bodies that rotate with the beam's line, if any; on sections that shear, bodies rotate with these.
fn turned(system: &System) -> Option<&[MeshedBody]> {
    let with_line = !system.model.effects.has(Effect::Shear) && !system.bodies.is_empty();
    with_line.then_some(&system.bodies)
}

/// Conjugate gradients, starting from the jumps without bodies; reduces the remaining impulses of free nodes to zero.
fn with_bodies(system: &System, given: &[[Option<f64>; 2]], mut jumps: Nodal, w: &Workspace<f64>) -> Nodal {
    let still: Vec<_> = given.iter().map(|node| node.map(|jump| jump.map(|_| 0.0))).collect();
    let taken = |jumps: &Nodal| {
        let mut all = impulses(system, jumps, w);
        for ((all, around), given) in all.iter_mut().zip(taken_around(system, jumps, w)).zip(given) {
            *all += around;
            *all = Planar {
                x: if given[0].is_some() { 0.0 } else { all.x },
                z: if given[1].is_some() { 0.0 } else { all.z },
            };
        }
        all
    };
    let dot = |a: &Nodal, b: &Nodal| a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum::<f64>();
    let mut left: Nodal = taken(&jumps).into_iter().map(|impulse| -impulse).collect();
    let mut way = solve(system, &still, Some(&left), w);
    let mut size = dot(&left, &way);
    let enough = size * CLOSE * CLOSE;
    for _ in 0..TRIES * system.bodies.len() {
        if size <= enough {
            break;
        }
        let more = taken(&way);
        let step = size / dot(&way, &more);
        for (((jump, left), way), more) in jumps.iter_mut().zip(&mut left).zip(&way).zip(&more) {
            *jump += *way * step;
            *left -= *more * step;
        }
        let next = solve(system, &still, Some(&left), w);
        let before = std::mem::replace(&mut size, dot(&left, &next));
        for (way, next) in way.iter_mut().zip(next) {
            *way = next + *way * (size / before);
        }
    }
    jumps
}

/// Impulses [kg m/s] that nodes transfer to the surrounding fluid by velocity jumps.
pub fn taken_around(system: &System, jumps: &[Planar<f64>], w: &Workspace<f64>) -> Nodal {
    let of = |(node, jump): (usize, &Planar<f64>)| planar(added(system, w, node) * vector(*jump));
    jumps.iter().enumerate().map(of).collect()
}

/// Impulses of nodes [kg m/s] by velocity jumps, caused by external forces.
pub fn impulses(system: &System, jumps: &[Planar<f64>], w: &Workspace<f64>) -> Nodal {
    let mesh = &system.mesh;
    let mut all: Nodal = jumps
        .iter()
        .zip(&system.masses)
        .map(|(jump, mass)| *jump * *mass)
        .collect();
    for c in 0..mesh.cells {
        let handed = planar(coupling(system, w, c) * vector(jumps[c + 1] - jumps[c]));
        all[c] -= handed;
        all[c + 1] += handed;
    }
    for body in turned(system).unwrap_or_default() {
        body.add_impulses(system, w, jumps, &mut all);
    }
    all
}

fn vector(v: Planar<f64>) -> Vector2<f64> {
    Vector2::new(v.x, v.z)
}

fn planar(v: Vector2<f64>) -> Planar<f64> {
    Planar { x: v.x, z: v.y }
}

/// `m_a h_i n nᵀ` of a node, [E53].
fn added(system: &System, w: &Workspace<f64>, node: usize) -> Matrix2<f64> {
    let added = system
        .sections
        .ambient
        .get(node)
        .map_or(0.0, |around| around.added_mass);
    let n = vector(node_tangent(system, w, node).normal());
    system.lengths[node] * added * n * n.transpose()
}

/// `J/h n nᵀ` of a cell.
fn coupling(system: &System, w: &Workspace<f64>, c: usize) -> Matrix2<f64> {
    if !system.turns_with_its_line() || system.model.kinematics == Kinematics::Bar || system.mesh.is_gap(c) {
        return Matrix2::zeros();
    }
    let mut inertia = system.sections.rotary[c] / system.mesh.lengths[c];
    let turned = system.model.kinematics == Kinematics::FiniteRotation && system.layout.lines[1].v.is_some();
    let n = if turned {
        -vector(w.shape.tangent[c].normal())
    } else {
        Vector2::x()
    };
    if turned && !system.model.published() {
        inertia /= w.shape.stretch[c] * w.shape.stretch[c];
    }
    inertia * n * n.transpose()
}

/// Thomas' algorithm, node by node, without bodies. The right-hand side consists of the given jumps, and of `impulses`
/// or zero elsewhere.
fn solve(system: &System, given: &[[Option<f64>; 2]], impulses: Option<&Nodal>, w: &Workspace<f64>) -> Nodal {
    let mesh = &system.mesh;
    let beside = |cell: Option<usize>| cell.map_or(Matrix2::zeros(), |cell| coupling(system, w, cell));
    // jumps[i] = sums[i] - upper[i] jumps[i + 1]
    let (mut upper, mut sums) = (Matrix2::zeros(), Vector2::zeros());
    let mut eliminated = Vec::with_capacity(mesh.nodes);
    for (i, given) in given.iter().enumerate() {
        let left = beside(i.checked_sub(1));
        let right = beside(Some(i).filter(|i| *i < mesh.cells));
        let mut pivot = left + right + left * upper + Matrix2::identity() * system.masses[i] + added(system, w, i);
        let (mut next, mut sum) = (-right, left * sums);
        if let Some(impulses) = impulses {
            sum += vector(impulses[i]);
        }
        for (k, jump) in given.iter().enumerate() {
            if let Some(jump) = jump {
                pivot.set_row(k, &Matrix2::identity().row(k));
                next.row_mut(k).fill(0.0);
                sum[k] = *jump;
            }
        }
        // positive definite because of the masses
        let inverse = pivot.try_inverse().unwrap_or_default();
        (upper, sums) = (inverse * next, inverse * sum);
        eliminated.push((upper, sums));
    }
    let mut jumps = vec![Planar::default(); mesh.nodes];
    let mut ahead = Vector2::zeros();
    for (jump, (upper, sums)) in jumps.iter_mut().zip(eliminated).rev() {
        ahead = sums - upper * ahead;
        *jump = planar(ahead);
    }
    jumps
}
