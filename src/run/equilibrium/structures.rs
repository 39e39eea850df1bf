//! Displacements of a structure from the directions and lengths of its cells.

use crate::discrete::System;
use crate::numerics::Planar;

/// Replaces the displacements `u` along the axes of each beam by those of a structure with the given cells, `(x, z)` from node to node.
/// Beams are assembled from supports on: a beam begins at a support or at a beam that is already there, and what is missing at its other
/// end, if that is held as well, is distributed along it.
pub fn assemble(system: &System, cells: &[Planar<f64>], joint_angles: &[f64], u: &mut [Planar<f64>]) {
    let (mesh, joints) = (&system.mesh, &system.joints);
    let held = |node: usize| joints.driven.iter().filter(|(_, driven, _)| *driven == node).count() == 2;
    let mut there = vec![false; mesh.beams.len()];
    let supported = |beam: usize| mesh.beams[beam].ends().into_iter().any(|end| held(end.node));
    let mut order: Vec<usize> = (0..mesh.beams.len()).filter(|beam| supported(*beam)).collect();
    if order.is_empty() {
        order.push(0);
    }
    let mut next = 0;
    loop {
        let Some(&beam) = order.get(next) else {
            // beams without a joint to those before
            match there.iter().position(|there| !there) {
                Some(beam) => order.push(beam),
                None => return,
            }
            continue;
        };
        next += 1;
        if std::mem::replace(&mut there[beam], true) {
            continue;
        }
        let ends = mesh.beams[beam].ends();
        let mut known = ends.map(|end| held(end.node).then(|| u[end.node]));
        for (known, end) in known.iter_mut().zip(&ends) {
            for tie in &joints.ties {
                let other = if tie.node == end.node { tie.to } else { tie.node };
                let own = tie.node == end.node || tie.to == end.node;
                if own && other != end.node && there[mesh.beam_of_node(other)] && mesh.beam_of_node(other) != beam {
                    *known = Some(match tie.node == end.node {
                        true => tie.from_first(u[other], joint_angles),
                        false => tie.to_first(u[other], joint_angles),
                    });
                }
            }
        }
        lay(system, beam, cells, known, u);
        for tie in &joints.ties {
            let beams = [tie.node, tie.to].map(|node| mesh.beam_of_node(node));
            if beams.contains(&beam) {
                order.extend(beams.into_iter().filter(|other| !there[*other]));
            }
        }
    }
}

/// Lays the cells of a beam from a known end to the other one.
fn lay(system: &System, beam: usize, cells: &[Planar<f64>], known: [Option<Planar<f64>>; 2], u: &mut [Planar<f64>]) {
    let mesh = &system.mesh;
    let nodes = mesh.beams[beam].nodes.clone();
    let stretched = |cell: usize| {
        cells[cell]
            - Planar {
                x: 0.0,
                z: mesh.lengths[cell],
            }
    };
    let [root, tip] = [nodes.start, nodes.end - 1];
    match known {
        [None, Some(at_tip)] => {
            u[tip] = at_tip;
            for node in (root..tip).rev() {
                u[node] = u[node + 1] - stretched(node);
            }
        }
        [at_root, at_tip] => {
            u[root] = at_root.unwrap_or(u[root]);
            for node in root..tip {
                u[node + 1] = u[node] + stretched(node);
            }
            if let Some(at_tip) = at_tip {
                let missing = at_tip - u[tip];
                let whole = mesh.node_coordinate(tip);
                for (node, u) in nodes.zip(&mut u[root..=tip]) {
                    *u += missing * (mesh.node_coordinate(node) / whole);
                }
            }
        }
    }
}
