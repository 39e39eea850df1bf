//! Driven ends whose velocity jumps, and what sections that turn hand on of it.
//!
//! In no time only impulses count. Masses alone leave every free node as fast as it was; rotary inertia couples neighbours, `[E13]`
//! and `[E27]`:
//!
//! ```text
//! m h_i Δv_i = ΔS_{i+1/2} - ΔS_{i-1/2} (+ P_i, of a driven end)      ΔS = J/h n n·(Δv_{i+1} - Δv_i)
//! J = m y11/λ² (conservative), m y11 (published), n = (cos φ, -sin φ);  m y11, n = (1, 0) where rotary inertia has no axial part
//! ```
//!
//! Along a straight beam it is `Δv = Δv_0 exp(-θ/√y11)` on fine meshes, and the end takes `m √y11` along. The energy gains
//! `P·(v⁻ + v⁺)/2` at driven ends and nothing elsewhere, the angular momentum what the impulses turn, both exactly.

use super::{System, TimeData, Workspace};
use crate::case::schema::Effect;
use crate::model::Kinematics;

/// Velocities or impulses of all nodes, x and z.
pub type Nodal = Vec<[f64; 2]>;

type Block = [[f64; 2]; 2];

/// Velocities of nodes in the workspace [m/s].
pub fn velocities(w: &Workspace<f64>) -> Nodal {
    w.v1.iter().zip(&w.v3).map(|(x, z)| [*x, *z]).collect()
}

/// Jumps of velocity of all nodes [m/s] that follow from those of driven ends; none where no sections turn. The workspace holds
/// the place of the beam.
pub fn spread(system: &System, [before, after]: [&TimeData; 2], w: &Workspace<f64>) -> Option<Nodal> {
    let l = &system.layout;
    if !l.inertia || !system.model.effects.has(Effect::RotaryInertia) || system.model.kinematics == Kinematics::Bar {
        return None;
    }
    let last = system.mesh.nodes - 1;
    let mut given = vec![[None; 2]; last + 1];
    for (node, end) in [(0, 0), (last, 1)] {
        let (from, to) = (&before.ends[end], &after.ends[end]);
        for (k, from, to) in [(0, from.u1, to.u1), (1, from.u3, to.u3)] {
            given[node][k] = from.zip(to).map(|(from, to)| to.rate - from.rate);
        }
    }
    if !l.waves[1] {
        given.iter_mut().for_each(|node| node[1] = Some(0.0));
    }
    let jumps = given.iter().flatten().flatten().any(|jump| *jump != 0.0);
    jumps.then(|| solve(system, &given, w))
}

/// Impulses of nodes [kg m/s] over jumps of their velocities: what outer forces have given them.
pub fn impulses(system: &System, jumps: &[[f64; 2]], w: &Workspace<f64>) -> Nodal {
    let (mesh, mass) = (&system.mesh, system.model.section.mass_per_length);
    let mut all: Nodal = (0..mesh.nodes)
        .map(|i| jumps[i].map(|jump| mass * mesh.node_length(i) * jump))
        .collect();
    for c in 0..mesh.cells {
        let coupled = coupling(system, w, c);
        for k in 0..2 {
            let handed: f64 = (0..2).map(|j| coupled[k][j] * (jumps[c + 1][j] - jumps[c][j])).sum();
            all[c][k] -= handed;
            all[c + 1][k] += handed;
        }
    }
    all
}

/// `J/h n nᵀ` of a cell.
fn coupling(system: &System, w: &Workspace<f64>, c: usize) -> Block {
    let section = &system.model.section;
    if !system.model.effects.has(Effect::RotaryInertia) || system.model.kinematics == Kinematics::Bar {
        return [[0.0; 2]; 2];
    }
    let mut inertia = section.mass_per_length * section.gyration_radius_squared / system.mesh.h;
    let turned = system.model.kinematics == Kinematics::FiniteRotation && system.layout.waves[1];
    let n = if turned { [w.tz[c], -w.tx[c]] } else { [1.0, 0.0] };
    if turned && !system.model.published() {
        inertia /= w.stretch[c] * w.stretch[c];
    }
    n.map(|a| n.map(|b| inertia * a * b))
}

/// Thomas' algorithm, node by node: no impulse where no jump is given.
fn solve(system: &System, given: &[[Option<f64>; 2]], w: &Workspace<f64>) -> Nodal {
    let (mesh, mass) = (&system.mesh, system.model.section.mass_per_length);
    let mut upper: Vec<Block> = vec![[[0.0; 2]; 2]; mesh.nodes];
    let mut jumps: Nodal = vec![[0.0; 2]; mesh.nodes];
    for i in 0..mesh.nodes {
        let left = if i > 0 {
            coupling(system, w, i - 1)
        } else {
            [[0.0; 2]; 2]
        };
        let right = if i < mesh.cells {
            coupling(system, w, i)
        } else {
            [[0.0; 2]; 2]
        };
        let (mut pivot, mut next, mut sum) = ([[0.0; 2]; 2], [[0.0; 2]; 2], [0.0; 2]);
        for k in 0..2 {
            if let Some(jump) = given[i][k] {
                (pivot[k][k], sum[k]) = (1.0, jump);
                continue;
            }
            for j in 0..2 {
                pivot[k][j] = left[k][j] + right[k][j];
                next[k][j] = -right[k][j];
                if i > 0 {
                    sum[k] += left[k][j] * jumps[i - 1][j];
                    (0..2).for_each(|m| pivot[k][m] += left[k][j] * upper[i - 1][j][m]);
                }
            }
            pivot[k][k] += mass * mesh.node_length(i);
        }
        let inverse = inverse(pivot);
        upper[i] = inverse.map(|row| [0, 1].map(|j| row[0] * next[0][j] + row[1] * next[1][j]));
        jumps[i] = inverse.map(|row| row[0] * sum[0] + row[1] * sum[1]);
    }
    for i in (0..mesh.cells).rev() {
        let ahead = jumps[i + 1];
        for k in 0..2 {
            jumps[i][k] -= upper[i][k][0] * ahead[0] + upper[i][k][1] * ahead[1];
        }
    }
    jumps
}

fn inverse([[a, b], [c, d]]: Block) -> Block {
    let determinant = a * d - b * c;
    [[d, -b], [-c, a]].map(|row| row.map(|x| x / determinant))
}
