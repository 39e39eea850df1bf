//! Contact of the beam with fixed walls and circles.

use crate::case::schema::{BeamContact, Case, Contact as Written};
use crate::case::spans::SegmentValues;
use crate::numerics::{Planar, Scalar, ramp, ramp_integral};

/// Distance from the center below which the normal of a circle fades, in radii: no force depends on it, since `1 + 1e-16 = 1`.
const CORE: f64 = 1e-8;

/// Shape of an obstacle: depth g of the beam's surface behind the face, and outward normal n of the face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ContactFace {
    /// The half-plane behind the face through `x_0`: `g = n·(x_0 - x) + r`.
    Wall {
        /// `x_0` [m].
        point: Planar<f64>,
        /// `n`, of length 1.
        normal: Planar<f64>,
    },
    /// `[E85]` A circle of radius R around c, s = 1 for a disc beside the beam and -1 for a room around it:
    ///
    /// ```text
    /// g = s (R - |x - c|) + r      n = s (x - c)/|x - c| = -∂g/∂x      R → ∞ is a wall
    /// ```
    Circle {
        /// `c` [m].
        center: Planar<f64>,
        /// `R` [m].
        radius: f64,
        /// `s`.
        side: f64,
    },
}

/// `[E61]` An obstacle. The surface of the beam is at the distance r from its center line. The contact acts where the surface is behind
/// the face, `g > 0`, per length or at one place. k is the stiffness, d the smoothing length:
///
/// ```text
/// f = k s(g) [m(1 + c g_t) n - μ m(1 + c g_t) v_t/√(v_t² + v_0²) t]      s(g) = g²/(2d) up to d, g - d/2 beyond      m(1) = 1
/// E = k S(g),  S' = s      D = k s [(m - 1) g_t + μ m v_t²/√(v_t² + v_0²)]
/// ```
///
/// t is along the face. `m(y)` is y, smoothly kept above 0: an obstacle never pulls. k s(g) stores energy. Damping (Hunt &
/// Crossley, J. Appl. Mech. 42 (1975) 440) and friction dissipate it: D ≥ 0.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactLaw {
    /// Name.
    pub name: String,
    /// Place `θ/l_s` of the contact; none: along the whole beam.
    pub at: Option<f64>,
    /// Shape.
    pub face: ContactFace,
    /// `r`; if it follows the section, that of the highest section [m].
    pub reach: f64,
    /// True if r is half the height of the section at each place.
    pub follows_section: bool,
    /// Forces.
    pub pressing: PressingLaw,
}

/// Contact of beams with each other.
#[derive(Clone, Debug, PartialEq)]
pub struct BeamContactLaw {
    /// Name.
    pub name: String,
    /// Names of both beams; none: all.
    pub between: Option<[String; 2]>,
    /// Forces per length.
    pub pressing: PressingLaw,
}

impl BeamContactLaw {
    /// Law of a contact as written.
    pub fn new(written: &BeamContact) -> Self {
        Self {
            name: written.name.clone(),
            between: written.between.clone(),
            pressing: PressingLaw {
                stiffness: written.stiffness_pa,
                smoothing: written.smoothing_m,
                damping: written.damping_s_m,
                friction: written.friction_coefficient,
                slow: written.friction_velocity_m_s.unwrap_or(1.0),
            },
        }
    }
}

/// Forces of surfaces that press on each other, [E61]: elastic ones, damping and friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressingLaw {
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

impl ContactLaw {
    /// Returns all contacts of a case with the values of its segments.
    pub fn all(case: &Case, segments: &[SegmentValues]) -> Vec<Self> {
        let heights = segments.iter().map(|values| values.beam.height_m);
        let reach = 0.5 * heights.reduce(f64::max).unwrap_or(case.beam.height_m);
        case.contacts.iter().map(|written| Self::new(written, reach)).collect()
    }

    fn new(written: &Written, reach: f64) -> Self {
        let planar = |[x, z]: [f64; 2]| Planar { x, z };
        let face = match &written.circle {
            Some(circle) => ContactFace::Circle {
                center: planar(circle.center_m),
                radius: circle.radius_m,
                side: if circle.inside { -1.0 } else { 1.0 },
            },
            None => {
                let [x, z] = written.normal.unwrap_or([1.0, 0.0]);
                let length = x.hypot(z);
                ContactFace::Wall {
                    point: planar(written.point_m.unwrap_or_default()),
                    normal: planar([x / length, z / length]),
                }
            }
        };
        Self {
            name: written.name.clone(),
            at: written.at,
            face,
            reach: written.reach_m.unwrap_or(reach),
            follows_section: written.reach_m.is_none(),
            pressing: PressingLaw {
                stiffness: written.stiffness_pa.or(written.stiffness_n_m).unwrap_or(0.0),
                smoothing: written.smoothing_m,
                damping: written.damping_s_m,
                friction: written.friction_coefficient,
                slow: written.friction_velocity_m_s.unwrap_or(1.0),
            },
        }
    }

    /// Term of its shape.
    pub fn kind(&self) -> &'static str {
        match self.face {
            ContactFace::Wall { .. } => "wall",
            ContactFace::Circle { .. } => "circle",
        }
    }

    /// Radius of the circle on which the center line of the beam lies in contact [m]; none for walls.
    pub fn bend_radius(&self) -> Option<f64> {
        match self.face {
            ContactFace::Wall { .. } => None,
            ContactFace::Circle { radius, side, .. } => Some(radius + side * self.reach),
        }
    }

    /// True if the contact dissipates energy.
    pub fn is_lossy(&self) -> bool {
        self.pressing.damping > 0.0 || self.pressing.friction > 0.0
    }

    /// Depth of the beam's surface, `reach` [m] from its line, behind the face for a point of the line [m], negative in front of the face,
    /// and normal.
    #[inline]
    pub fn depth<T: Scalar>(&self, at: Planar<T>, reach: f64) -> (T, Planar<T>) {
        match self.face {
            ContactFace::Wall { point, normal } => {
                let normal = Planar::constant(normal);
                ((Planar::constant(point) - at).dot(normal) + reach, normal)
            }
            ContactFace::Circle { center, radius, side } => {
                let off = at - Planar::constant(center);
                let core = CORE * radius;
                let distance = (off.squared() + core * core).sqrt();
                let depth = (distance - radius) * -side + reach;
                (depth, off.times(T::constant(side) / distance))
            }
        }
    }

    /// Contact forces on a moving point of the line, `reach` [m] from the surface.
    #[inline]
    pub fn forces<T: Scalar>(&self, at: Planar<T>, velocity: Planar<T>, reach: f64) -> ContactForces<T> {
        let (depth, normal) = self.depth(at, reach);
        self.pressing.forces(depth, normal, velocity)
    }

    /// `k S(g)`.
    pub fn energy(&self, depth: f64) -> f64 {
        self.pressing.energy(depth)
    }
}

impl PressingLaw {
    /// Contact forces at a depth [m] along a normal, with the velocity of the pressed point relative to the face [m/s].
    #[inline]
    pub fn forces<T: Scalar>(&self, depth: T, normal: Planar<T>, velocity: Planar<T>) -> ContactForces<T> {
        let elastic = depth.lift(|g| ramp(g, self.smoothing)) * self.stiffness;
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
        self.stiffness * ramp_integral(depth, self.smoothing)
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

    const NORMAL: Planar<f64> = Planar { x: -0.6, z: 0.8 };
    const POINT: Planar<f64> = Planar { x: 0.1, z: 0.0 };
    const WALL: ContactLaw = ContactLaw {
        name: String::new(),
        at: None,
        face: ContactFace::Wall {
            point: POINT,
            normal: NORMAL,
        },
        reach: 0.0,
        follows_section: false,
        pressing: PressingLaw {
            stiffness: 1e5,
            smoothing: 1e-3,
            damping: 2.0,
            friction: 0.3,
            slow: 1e-3,
        },
    };

    /// Circles around a center along the normal have the wall as tangent at the same point.
    fn tangent(radius: f64, side: f64) -> ContactLaw {
        let center = POINT - NORMAL * (side * radius);
        let face = ContactFace::Circle { center, radius, side };
        ContactLaw { face, ..WALL.clone() }
    }

    /// Goal: no force in front of the face, and no tension behind it. The energy is the work of the elastic part.
    /// Damping and friction only dissipate.
    #[test]
    fn an_obstacle_presses_and_never_pulls() {
        for law in [WALL, tangent(0.2, 1.0), tangent(0.2, -1.0)] {
            presses(&law);
        }
    }

    fn presses(law: &ContactLaw) {
        let face = NORMAL.normal();
        for depth in [-1.0, 0.0, 1e-5, 5e-4, 1e-3, 2e-3, 0.1] {
            let at = POINT - NORMAL * depth;
            if law.depth(at, law.reach).0 > depth + 1e-9 {
                assert!(depth < -0.1, "beyond the center of a room");
                continue;
            }
            assert!((law.depth(at, law.reach).0 - depth).abs() < 1e-15);
            for (inwards, along) in [(0.0, 0.0), (10.0, 1.0), (-0.1, -1.0), (-0.4, 1e-4), (-10.0, 5.0)] {
                let velocity = NORMAL * -inwards + face * along;
                let f = law.forces(at, velocity, law.reach);
                let whole = (f.elastic + f.damping).dot(NORMAL);
                assert!(
                    whole >= -1e-12 && (depth > 0.0 || whole < 1e-20),
                    "{depth} {inwards}: {whole}"
                );
                assert!(f.damping.dot(velocity) <= 0.0 && f.friction.dot(velocity) <= 0.0);
                assert!(f.friction.squared().sqrt() <= 0.3 * whole + 1e-12);
            }
            let h = 1e-7;
            let power = (law.energy(depth + h) - law.energy(depth - h)) / (2.0 * h);
            let elastic = law.forces(at, Planar::default(), law.reach).elastic.dot(NORMAL);
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
