//! Contact of the beam with fixed walls.

use crate::case::schema::{Case, Contact as Written};
use crate::numerics::{Planar, Scalar, ramp};

/// `[E61]` A wall: the half-plane behind the face through `x_0` with the outward normal n. The surface of the beam is
/// at the distance r from its center line. The contact acts where the surface is behind the face by
/// `g = n·(x_0 - x) + r > 0`, per length or at one place. k is the stiffness, d the smoothing length:
///
/// ```text
/// f = k s(g) [m(1 + c g_t) n - μ m(1 + c g_t) v_t/√(v_t² + v_0²) t]      s(g) = g²/(2d) up to d, g - d/2 beyond      m(1) = 1
/// E = k S(g),  S' = s      D = k s [(m - 1) g_t + μ m v_t²/√(v_t² + v_0²)]
/// ```
///
/// t is along the face. `m(y)` is y, smoothly kept above 0: a wall never pulls. k s(g) stores energy. Damping (Hunt &
/// Crossley, J. Appl. Mech. 42 (1975) 440) and friction dissipate it: D ≥ 0.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactWall {
    /// Name.
    pub name: String,
    /// Place `θ/l_s` of the contact; none: along the whole beam.
    pub at: Option<f64>,
    /// `x_0` [m].
    pub point: Planar<f64>,
    /// `r` [m].
    pub reach: f64,
    /// `n`, of length 1.
    pub normal: Planar<f64>,
    /// `k` [Pa]; at one place [N/m].
    pub stiffness: f64,
    /// `d` [m].
    pub smoothing: f64,
    /// `c` [s/m].
    pub damping: f64,
    /// `μ`.
    pub friction: f64,
    /// `v_0` [m/s].
    pub slow: f64,
}

/// Contact forces per unit weight: elastic, damping and friction.
#[derive(Clone, Copy, Debug)]
pub struct ContactForces<T> {
    /// Elastic force along the normal.
    pub elastic: Planar<T>,
    /// Damping force along the normal.
    pub damping: Planar<T>,
    /// Friction force along the face.
    pub friction: Planar<T>,
}

impl ContactWall {
    /// Returns all contacts of a case.
    pub fn all(case: &Case) -> Vec<Self> {
        let reach = 0.5 * case.beam.height_m;
        case.contacts.iter().map(|written| Self::new(written, reach)).collect()
    }

    fn new(written: &Written, reach: f64) -> Self {
        let [x, z] = written.normal;
        let length = x.hypot(z);
        Self {
            name: written.name.clone(),
            at: written.at,
            point: Planar {
                x: written.point_m[0],
                z: written.point_m[1],
            },
            reach: written.reach_m.unwrap_or(reach),
            normal: Planar {
                x: x / length,
                z: z / length,
            },
            stiffness: written.stiffness_pa.or(written.stiffness_n_m).unwrap_or(0.0),
            smoothing: written.smoothing_m,
            damping: written.damping_s_m,
            friction: written.friction_coefficient,
            slow: written.friction_velocity_m_s.unwrap_or(1.0),
        }
    }

    /// True if the wall dissipates energy.
    pub fn is_lossy(&self) -> bool {
        self.damping > 0.0 || self.friction > 0.0
    }

    /// Depth of the beam's surface behind the face for a point of the center line [m]; negative in front of the face.
    #[inline]
    pub fn depth<T: Scalar>(&self, at: Planar<T>) -> T {
        (Planar::constant(self.point) - at).dot(Planar::constant(self.normal)) + self.reach
    }

    /// Contact forces on a moving point.
    #[inline]
    pub fn forces<T: Scalar>(&self, at: Planar<T>, velocity: Planar<T>) -> ContactForces<T> {
        let normal = Planar::constant(self.normal);
        let elastic = self.depth(at).lift(|g| ramp(g, self.smoothing)) * self.stiffness;
        let mut pressed = ContactForces {
            elastic: normal.times(elastic),
            damping: Planar::zero(),
            friction: Planar::zero(),
        };
        let mut whole = elastic;
        if self.damping > 0.0 {
            let more = (velocity.dot(normal) * -self.damping).lift(not_below) * elastic;
            pressed.damping = normal.times(more);
            whole += more;
        }
        if self.friction > 0.0 {
            let face = normal.normal();
            let along = velocity.dot(face);
            let share = along / (along.squared() + self.slow * self.slow).sqrt();
            pressed.friction = face.times(share * whole * -self.friction);
        }
        pressed
    }

    /// `k S(g)`.
    pub fn energy(&self, depth: f64) -> f64 {
        let d = self.smoothing;
        let stored = match depth {
            g if g <= 0.0 => 0.0,
            g if g < d => g * g * g / (6.0 * d),
            g => 0.5 * g * (g - d) + d * d / 6.0,
        };
        self.stiffness * stored
    }
}

/// `m(1 + x) - 1` and its slope: x above -1/2, a parabola from -1/2 to -3/2, and -1 below.
fn not_below(x: f64) -> (f64, f64) {
    match x {
        x if x >= -0.5 => (x, 1.0),
        x if x > -1.5 => (0.5 * (x + 1.5) * (x + 1.5) - 1.0, x + 1.5),
        _ => (-1.0, 0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WALL: ContactWall = ContactWall {
        name: String::new(),
        at: None,
        point: Planar { x: 0.1, z: 0.0 },
        reach: 0.0,
        normal: Planar { x: -0.6, z: 0.8 },
        stiffness: 1e5,
        smoothing: 1e-3,
        damping: 2.0,
        friction: 0.3,
        slow: 1e-3,
    };

    /// Goal: no force in front of the wall, and no tension behind it. The energy is the work of the elastic part.
    /// Damping and friction only dissipate.
    #[test]
    fn a_wall_presses_and_never_pulls() {
        let face = WALL.normal.normal();
        for depth in [-1.0, 0.0, 1e-5, 5e-4, 1e-3, 2e-3, 0.1] {
            let at = WALL.point - WALL.normal * depth;
            assert!((WALL.depth(at) - depth).abs() < 1e-15);
            for (inwards, along) in [(0.0, 0.0), (10.0, 1.0), (-0.1, -1.0), (-0.4, 1e-4), (-10.0, 5.0)] {
                let velocity = WALL.normal * -inwards + face * along;
                let f = WALL.forces(at, velocity);
                let whole = (f.elastic + f.damping).dot(WALL.normal);
                assert!(
                    whole >= -1e-12 && (depth > 0.0 || whole == 0.0),
                    "{depth} {inwards}: {whole}"
                );
                assert!(f.damping.dot(velocity) <= 0.0 && f.friction.dot(velocity) <= 0.0);
                assert!(f.friction.squared().sqrt() <= 0.3 * whole + 1e-12);
            }
            let h = 1e-7;
            let power = (WALL.energy(depth + h) - WALL.energy(depth - h)) / (2.0 * h);
            let elastic = WALL.forces(at, Planar::default()).elastic.dot(WALL.normal);
            assert!(
                (power - elastic).abs() < 1e-3 * (1.0 + elastic),
                "{depth}: {power} {elastic}"
            );
        }
    }

    /// Goal: the damping factor and its slope are continuous.
    #[test]
    fn damping_has_no_kinks() {
        for seam in [-0.5, -1.5] {
            let (a, b) = (not_below(seam - 1e-9), not_below(seam + 1e-9));
            assert!(
                (a.0 - b.0).abs() < 1e-8 && (a.1 - b.1).abs() < 1e-8,
                "{seam}: {a:?} {b:?}"
            );
        }
    }
}
