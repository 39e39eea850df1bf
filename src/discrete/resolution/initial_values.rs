//! Mesh errors of the initial displacements and velocities of a beam.

use crate::case::schema::Case;
use crate::case::{Rotation, Translation};
use crate::discrete::System;
use crate::discrete::shapes::{self, Cells};
use crate::functions::profile::{Integrals, Profile};
use crate::functions::signals::SmoothTime;
use crate::model::Model;

use super::ratio;
use super::vibrations::Vibrations;

/// Refinement of the mesh whose energy serves as reference.
const FINER: usize = 4;

/// An initial displacement or velocity.
pub(super) struct InitialShape<'a> {
    key: &'static str,
    profile: &'a Profile,
    what: What,
    vibrations: Option<Vibrations>,
}

enum What {
    Displacement(Held),
    Velocity,
}

/// End conditions of a displacement.
struct Held {
    /// Displacements of root and tip [m], if given.
    ends: [Option<f64>; 2],
    /// Slopes of root and tip times the length, if given, for bending; none for stretch.
    slopes: Option<[Option<f64>; 2]>,
}

impl<'a> InitialShape<'a> {
    /// Initial displacements and velocities of a case.
    pub fn all(case: &'a Case, system: &System) -> Vec<Self> {
        let start = &case.start;
        let given = [
            ("u1_m", &start.u1_m, true, true),
            ("u3_m", &start.u3_m, true, false),
            ("u1_rate_m_s", &start.u1_rate_m_s, false, true),
            ("u3_rate_m_s", &start.u3_rate_m_s, false, false),
        ];
        let model = &system.model;
        let of = |(key, profile, displacement, bends): (&'static str, &'a Option<Profile>, bool, bool)| {
            let profile = profile.as_ref()?;
            let line = &system.layout.lines[usize::from(!bends)];
            let waves = line.v.is_some() && !line.free.is_empty();
            Some(Self {
                key,
                profile,
                what: if displacement {
                    What::Displacement(Held::from_model(model, bends))
                } else {
                    What::Velocity
                },
                vibrations: waves
                    .then(|| Vibrations::new(profile, displacement, bends, model, case.time.end_s, system.mesh.fourth)),
            })
        };
        given.into_iter().filter_map(of).collect()
    }

    /// JSON pointer in the case.
    pub fn pointer(&self) -> String {
        format!("/start/{}", self.key)
    }

    /// Relative mesh error, at the start and during the motion, and its description.
    pub fn left_out(&self, cells: usize) -> (f64, &'static str) {
        let there = self.at_once(cells);
        match self.vibrations.as_ref().map(|v| v.left_out(cells)) {
            Some(later) if later > there.0 => (later, "the motion by its short waves, which are too slow on the mesh,"),
            _ => there,
        }
    }

    /// Relative mesh error at the start, and its description.
    pub fn at_once(&self, cells: usize) -> (f64, &'static str) {
        match &self.what {
            What::Displacement(held) => {
                let between = of_lines(self.profile, cells);
                // a displacement that the mesh does not resolve has no meaningful energy
                let energy = if between > super::LIMIT {
                    0.0
                } else {
                    held.energy_left_out(self.profile, cells)
                };
                if energy > between {
                    (energy, "the square root of the elastic energy of the displacement")
                } else {
                    (between, "the displacement between the nodes")
                }
            }
            What::Velocity => (of_squares(self.profile, cells), "the velocity between the nodes"),
        }
    }
}

impl Held {
    fn from_model(model: &Model, bends: bool) -> Self {
        let clock = SmoothTime { t: 0.0, within: 0.0 };
        let moved = |motion: &Translation| match motion {
            Translation::Displacement(signal) => Some(signal.jet(clock).value),
            Translation::Force(_) => None,
        };
        let turned = |rotation: &Rotation| match rotation {
            Rotation::Slope(signal) => Some(signal.jet(clock).value * model.length),
            Rotation::Moment(_) => None,
        };
        let ends = [0, 1].map(|k| {
            let end = &model.ends[k];
            moved(if bends { &end.transverse } else { &end.axial })
        });
        Self {
            ends,
            slopes: bends.then(|| [0, 1].map(|k| turned(&model.ends[k].rotation))),
        }
    }

    /// Relative change of the root of the elastic energy between a mesh and a finer one. For a kink in bending or a jump in stretch this
    /// change remains large on any mesh.
    fn energy_left_out(&self, profile: &Profile, cells: usize) -> f64 {
        let [(here, scale), (there, _)] = [cells, FINER * cells].map(|cells| self.energy(profile, cells));
        ratio((there.sqrt() - here.sqrt()).abs(), there.sqrt(), scale)
    }

    /// Elastic energy on a mesh, times 2 over the stiffness, for length 1, and the scale of its rounding errors.
    ///
    /// ```text
    /// φ = Δu/h    stretch  Σ h φ²    bending  Σ h_i κ_i²,  κ_i = Δφ/h,  κ_0 = (φ_{1/2} - φ_0)/(h/2) where the slope is given
    /// ```
    fn energy(&self, profile: &Profile, cells: usize) -> (f64, f64) {
        let h = 1.0 / cells as f64;
        let mut u: Vec<f64> = (0..=cells).map(|i| profile.value(i as f64 * h)).collect();
        let [root, tip] = self.ends;
        u[0] = root.unwrap_or(u[0]);
        u[cells] = tip.unwrap_or(u[cells]);
        let largest = u.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
        let slopes: Vec<f64> = u.windows(2).map(|u| (u[1] - u[0]) / h).collect();
        let Some([at_root, at_tip]) = self.slopes else {
            return (slopes.iter().map(|s| h * s * s).sum(), largest);
        };
        let inner: f64 = slopes.windows(2).map(|s| (s[1] - s[0]).powi(2) / h).sum();
        let end = |given: Option<f64>, slope: f64| given.map_or(0.0, |given| 2.0 * (slope - given).powi(2) / h);
        (
            inner + end(at_root, slopes[0]) + end(at_tip, slopes[cells - 1]),
            largest / h,
        )
    }
}

/// Largest distance of a function from the lines through its nodal values, over its largest distance from the line through its ends. A
/// rigid motion of the beam thus has no error.
fn of_lines(profile: &Profile, cells: usize) -> f64 {
    let integrals = Integrals::new(profile);
    let line = |a: f64, b: f64, x: f64| {
        let t = (x - a) / (b - a);
        profile.value(a) * (1.0 - t) + profile.value(b) * t
    };
    let (mut lost, mut whole, mut largest) = (0.0_f64, 0.0_f64, 0.0_f64);
    for (a, b) in Cells::equal(cells).ends() {
        for x in shapes::places(&integrals, a, b).into_iter().chain([a, b]) {
            let value = profile.value(x);
            lost = lost.max((value - line(a, b, x)).abs());
            whole = whole.max((value - line(0.0, 1.0, x)).abs());
            largest = largest.max(value.abs());
        }
    }
    ratio(lost, whole, largest)
}

/// Relative mesh error of the root of the kinetic energy: by the difference of the velocity v and its lines w on the mesh, and by lumping
/// their mass. Both are added, because opposite signs would be accidental:
///
/// ```text
/// 1 - (1 - ∫(v - w)²/∫v²)^(1/2) + |(Σ h_i w_i²)^(1/2) - (∫w²)^(1/2)|/(∫v²)^(1/2)
/// ```
fn of_squares(profile: &Profile, cells: usize) -> f64 {
    let equal = Cells::equal(cells);
    let (w, means) = (shapes::nearest(profile, &equal), shapes::at_nodes(profile, &equal));
    let h = 1.0 / cells as f64;
    let length = |i: usize| if i == 0 || i == cells { 0.5 * h } else { h };
    let over_nodes = |of: &dyn Fn(usize) -> f64| (0..=cells).map(|i| length(i) * of(i)).sum::<f64>();
    let both = over_nodes(&|i| w[i] * means[i]);
    let lumped = over_nodes(&|i| w[i] * w[i]);
    let lines = w
        .windows(2)
        .map(|w| h / 3.0 * (w[0] * (w[0] + w[1]) + w[1] * w[1]))
        .sum::<f64>();
    let square = Profile::Product(vec![profile.clone(), profile.clone()]);
    let exact = Integrals::new(&square).moments(0.0, 1.0)[0].max(0.0);
    if exact <= 0.0 {
        return 0.0;
    }
    let between = ((exact - 2.0 * both + lines) / exact).clamp(0.0, 1.0);
    1.0 - (1.0 - between).sqrt() + (lumped.sqrt() - lines.max(0.0).sqrt()).abs() / exact.sqrt()
}
