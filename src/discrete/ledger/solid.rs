//! The beam's part of the balances.

use super::{Energies, Flow, add};
use crate::case::schema::Effect;
use crate::discrete::residual::rows::{end_force, published_force};
use crate::discrete::residual::solid::{couple, node_stretch};
use crate::discrete::time_data::Frame;
use crate::discrete::{System, TimeData, Workspace};
use crate::model::Kinematics;

/// Powers and impulses of loads, ends, damping, and of the published form.
pub fn flows(
    system: &System,
    now: &TimeData,
    curvature_rate: impl Fn(&Workspace<f64>, usize) -> f64,
    w: &Workspace<f64>,
    out: &mut [f64],
) {
    let (mesh, section, l) = (&system.mesh, &system.model.section, &system.layout);
    let last = mesh.nodes - 1;
    let published = system.model.published();
    let frame = now.frame_3();
    for i in 0..=last {
        let length = mesh.node_length(i);
        let (mut fx, mut fz) = (length * now.force_x[i], length * now.force_z[i]);
        if i == 0 || i == last {
            let (ex, ez) = end_force(system, now, w, i);
            fx += ex;
            fz += ez;
        }
        add(out, Flow::Loads, fx * w.v1[i] + fz * w.v3[i]);
        if published {
            let (cx, cz) = published_force(system, w, i);
            add(out, Flow::Formulation, cx * w.v1[i] + cz * w.v3[i]);
            fx += cx;
            fz += cz;
        }
        if section.drag > 0.0 {
            let along = if system.model.effects.has(Effect::AxialStretch) {
                w.v3[i]
            } else {
                carried(system, frame, w, i)
            };
            let (dx, dz) = (length * section.drag * w.v1[i], length * section.drag * along);
            add(out, Flow::Damping, dx * w.v1[i] + dz * w.v3[i]);
            fx -= dx;
            fz -= dz;
        }
        // Reaction of a driven end: what is missing in its momentum balance.
        let inertia = section.mass_per_length * length;
        let right = if i < last { (w.sx[i], w.sz[i]) } else { (0.0, 0.0) };
        let left = if i > 0 { (w.sx[i - 1], w.sz[i - 1]) } else { (0.0, 0.0) };
        if !l.free_u1.contains(&i) {
            let reaction = inertia * w.a1[i] - fx - right.0 + left.0;
            add(out, Flow::Ends, reaction * w.v1[i]);
            fx += reaction;
        }
        if l.inertia && !l.waves[1] {
            add(
                out,
                Flow::Ends,
                -inertia * w.a3[i] * (w.v3[i] - carried(system, frame, w, i)),
            );
        }
        if !l.free_u3.contains(&i) {
            let reaction = inertia * w.a3[i] - fz - right.1 + left.1;
            add(out, Flow::Ends, reaction * w.v3[i]);
            fz += reaction;
        }
        let ([x, z], [x_t, z_t]) = arms(system, w, i);
        add(out, Flow::ImpulseX, fx);
        add(out, Flow::ImpulseZ, fz);
        let turning = if l.inertia {
            inertia * (z_t * w.v1[i] - x_t * carried(system, frame, w, i))
        } else {
            0.0
        };
        add(out, Flow::AngularImpulse, z * fx - x * fz + turning);
        if system.model.kinematics != Kinematics::Bar {
            bending(system, now, &curvature_rate, w, i, out);
        }
    }
    cells(system, now, w, published, out);
}

/// End moments, viscous moments, and the published curvature measure, at one node.
fn bending(
    system: &System,
    now: &TimeData,
    curvature_rate: &impl Fn(&Workspace<f64>, usize) -> f64,
    w: &Workspace<f64>,
    i: usize,
    out: &mut [f64],
) {
    let (mesh, section) = (&system.mesh, &system.model.section);
    let last = mesh.nodes - 1;
    let length = mesh.node_length(i);
    let published = system.model.published();
    let end = match i {
        0 => Some(&now.ends[0]),
        _ if i == last => Some(&now.ends[1]),
        _ => None,
    };
    let (stretch, stretch_rate) = if published {
        let (a, b) = (i.saturating_sub(1), i.min(last - 1));
        (node_stretch(w, i, last), 0.5 * (w.stretch_rate[a] + w.stretch_rate[b]))
    } else {
        (1.0, 0.0)
    };
    // Where the moment is given, the curvature follows from it.
    let kappa_rate = match end {
        Some(e) if e.slope.is_none() => {
            let alpha_rate = e.moment.rate / section.bending_stiffness + curvature_rate(w, i);
            (alpha_rate - w.kappa[i] * stretch_rate) / stretch
        }
        _ => w.kappa_rate[i],
    };
    if let Some(e) = end {
        let (sign, cell) = if i == 0 { (1.0, 0) } else { (-1.0, last - 1) };
        let angle_rate = match e.slope {
            Some(slope) => slope.rate,
            None => w.angle_rate[cell] + sign * 0.5 * mesh.h * kappa_rate,
        };
        let moment = w.moment[i] + w.viscous_moment[i];
        add(out, Flow::Ends, sign * moment * angle_rate);
        add(out, Flow::AngularImpulse, sign * moment);
    }
    add(out, Flow::Damping, length * w.viscous_moment[i] * kappa_rate);
    if published {
        // d/dt (λ κ - κ)
        let excess_rate = (stretch - 1.0) * kappa_rate + w.kappa[i] * stretch_rate;
        add(out, Flow::Formulation, length * w.moment[i] * excess_rate);
    }
}

/// Distributed moments, viscous forces, and the published rotary term, over the cells.
fn cells(system: &System, now: &TimeData, w: &Workspace<f64>, published: bool, out: &mut [f64]) {
    let (h, section) = (system.mesh.h, &system.model.section);
    let rotary = section.mass_per_length * section.gyration_radius_squared;
    for c in 0..system.mesh.cells {
        if system.has_moments {
            let couple = couple(system, now, w, c);
            add(out, Flow::Loads, -h * couple * w.angle_rate[c]);
            add(out, Flow::AngularImpulse, -h * couple);
        }
        add(out, Flow::Damping, h * w.viscous_force[c] * w.stretch_rate[c]);
        if turned_across(system) {
            let turning = (w.v3[c + 1] - w.v3[c]) * turning_rate(system, w, c);
            add(out, Flow::AngularImpulse, rotary * turning);
        } else if published && system.model.effects.has(Effect::RotaryInertia) {
            let spurious = rotary * w.stretch[c] * w.stretch_rate[c] * w.angle_rate[c].powi(2);
            add(out, Flow::Formulation, -h * spurious);
        }
    }
}

/// Velocity along with which a node carries its mass: its own, without axial inertia that of the frame, `[E27]`.
fn carried(system: &System, frame: Option<Frame>, w: &Workspace<f64>, node: usize) -> f64 {
    if system.layout.waves[1] {
        return w.v3[node];
    }
    let share = node as f64 / (system.mesh.nodes - 1) as f64;
    frame.map_or(0.0, |frame| frame.at(share).rate)
}

/// Whether sections turn finitely but have the rotary inertia of `[E27]`.
fn turned_across(system: &System) -> bool {
    let finite = system.model.kinematics == Kinematics::FiniteRotation;
    finite && system.model.effects.has(Effect::RotaryInertia) && !system.layout.waves[1]
}

/// Rate of turning that rotary inertia resists: `φ_t`, without axial inertia `x'_t`.
fn turning_rate(system: &System, w: &Workspace<f64>, c: usize) -> f64 {
    if turned_across(system) {
        (w.v1[c + 1] - w.v1[c]) / system.mesh.h
    } else {
        w.angle_rate[c]
    }
}

/// Kinetic and elastic energy.
pub fn energies(system: &System, now: &TimeData, w: &Workspace<f64>) -> Energies {
    let (mesh, section) = (&system.mesh, &system.model.section);
    let mut e = Energies::default();
    let frame = now.frame_3();
    for i in 0..mesh.nodes {
        let length = mesh.node_length(i);
        if system.layout.inertia {
            let along = carried(system, frame, w, i);
            e.kinetic += 0.5 * section.mass_per_length * length * (w.v1[i] * w.v1[i] + along * along);
        }
        e.bending += 0.5 * length * w.moment[i] * w.moment[i] / section.bending_stiffness;
    }
    for c in 0..mesh.cells {
        if system.model.effects.has(Effect::AxialStretch) {
            e.axial += 0.5 * mesh.h * w.force[c] * w.force[c] / section.axial_stiffness;
        }
        if system.model.effects.has(Effect::RotaryInertia) {
            e.rotary += 0.5 * mesh.h * spin(system, w, c) * turning_rate(system, w, c);
        }
    }
    e
}

/// Angular momentum of a cell's rotation per length and turning: `m y11 φ_t`, published `m y11 λ² φ_t`.
fn spin(system: &System, w: &Workspace<f64>, c: usize) -> f64 {
    let section = &system.model.section;
    let factor = if system.model.published() && system.layout.waves[1] {
        w.stretch[c] * w.stretch[c]
    } else {
        1.0
    };
    section.mass_per_length * section.gyration_radius_squared * factor * turning_rate(system, w, c)
}

/// Arms (x, z) with which a node's momentum and force turn about the origin, and their rates: its position. A small
/// rotation ε moves a node by (ε θ, -ε g u1), whatever u3 is: that is what the potential of `[E26]` does not feel.
pub fn arms(system: &System, w: &Workspace<f64>, i: usize) -> ([f64; 2], [f64; 2]) {
    let theta = system.mesh.node_coordinate(i);
    match system.model.kinematics {
        Kinematics::Bar | Kinematics::FiniteRotation => ([w.u1[i], theta + w.u3[i]], [w.v1[i], w.v3[i]]),
        Kinematics::SmallRotation => ([w.u1[i], theta], [w.v1[i], 0.0]),
        Kinematics::Linear => ([0.0, theta], [0.0, 0.0]),
    }
}

/// Momentum (x, z) and angular momentum about the origin.
pub fn momenta(system: &System, now: &TimeData, w: &Workspace<f64>) -> ([f64; 2], f64) {
    let (mesh, section) = (&system.mesh, &system.model.section);
    let (mut momentum, mut angular) = ([0.0; 2], 0.0);
    if !system.layout.inertia {
        return (momentum, angular);
    }
    let frame = now.frame_3();
    for i in 0..mesh.nodes {
        let mass = section.mass_per_length * mesh.node_length(i);
        momentum[0] += mass * w.v1[i];
        let along = carried(system, frame, w, i);
        momentum[1] += mass * along;
        let ([x, z], _) = arms(system, w, i);
        angular += mass * (z * w.v1[i] - x * along);
    }
    if system.model.effects.has(Effect::RotaryInertia) {
        let arm = |c: usize| if turned_across(system) { w.d3z[c] } else { 1.0 };
        let cells = (0..mesh.cells).map(|c| mesh.h * arm(c) * spin(system, w, c));
        angular += cells.sum::<f64>();
    }
    (momentum, angular)
}
