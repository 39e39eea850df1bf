//! Passivity and reciprocity of the coupling.

use nalgebra::{Matrix4, SymmetricEigen};

use super::{CouplingLaw, Model, ROWS, Wet};
use crate::error::numbers::quantity;

/// Passivity of the local law.
#[derive(Clone, Debug, PartialEq)]
pub struct Passivity {
    /// Smallest eigenvalue of the symmetric part; 1 without coupling. If positive, every small load does positive work
    /// on the section.
    pub least: f64,
    /// M [N m], N [N], p_u [Pa], p_d [Pa] of that eigenvalue, scaled to a larger pressure of 1 kPa.
    pub direction: [f64; 4],
    /// Antisymmetric part over the coupling: 0 if reciprocal, 1 if only one side acts on the other.
    pub defect: f64,
}

/// Multiple of the kink width at which the slope equals its limit.
const FAR: f64 = 1e6;

/// `[E35]` The law that maps `(M, N, p_u, p_d)` to `(α, λ - 1, a_u, a_d)`. Each quantity is scaled by the square root
/// of its compliance, so the work per length of each alone is half its square. With `r = φ_b l_b`:
///
/// ```text
/// M/√EI ... N/√EA ... p √(r a_p)         L = 1 + [0 C; D X]     X = a_x/√(a_p,u a_p,d) off the diagonal
/// C = [√EI ∂α_p/∂p; √EA ∂λ_p/∂p]/√(r a_p)       D = √(r/a_p) [√EI (R A_M)', √EA A_N']
/// passive: least eigenvalue of (L + Lᵀ)/2 > 0      reciprocal: L = Lᵀ      defect |L - Lᵀ|/|L + Lᵀ - 2|
/// ```
///
/// Evaluates both sides of each kink and returns the worst. None without bladders.
pub fn assess(model: &Model) -> Option<Passivity> {
    if !model.sections.is_empty() {
        let parts = model.uniform_parts().filter_map(|part| assess(&part));
        return parts.reduce(|a, b| if b.least < a.least { b } else { a });
    }
    let wet = model.wet.as_ref().filter(|wet| wet.per_row > 0)?;
    let signs = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
    let all = signs.map(|(m, n)| at(model, wet, m, n));
    all.into_iter().reduce(|a, b| if b.least < a.least { b } else { a })
}

fn at(model: &Model, wet: &Wet, moment_sign: f64, force_sign: f64) -> Passivity {
    let laws = &wet.area;
    let moment = moment_sign * FAR * laws[0].moment_width.max(f64::MIN_POSITIVE.sqrt());
    let force = force_sign * FAR * laws[0].force_width.max(f64::MIN_POSITIVE.sqrt());
    let (ei, ea) = (
        model.section.steepest_bending.sqrt(),
        model.section.axial_stiffness.sqrt(),
    );
    let ratio = wet.per_row as f64 / model.length * wet.bladder_length;
    let fluid = laws.map(|law| (ratio * law.per_pressure).sqrt());
    let there = wet.rows().map(|there| if there { 1.0 } else { 0.0 });
    let mut l = Matrix4::identity();
    for (k, (law, row)) in laws.iter().zip(ROWS).enumerate() {
        let [upper, lower] = [0, 1].map(|of| if of == k { there[k] } else { 0.0 });
        l[(0, 2 + k)] = ei * wet.coupling.curvature(&wet.strains, moment, upper, lower) / fluid[k];
        l[(1, 2 + k)] = ea * wet.coupling.stretch(&wet.strains, force, upper, lower) / fluid[k];
        l[(2 + k, 0)] = ei * law.moment_slope(moment, row) * there[k] * ratio / fluid[k];
        l[(2 + k, 1)] = ea * law.force_slope(force) * there[k] * ratio / fluid[k];
        l[(2 + k, 3 - k)] = wet.pressure_correlation();
    }
    let symmetric = (l + l.transpose()) * 0.5;
    let eigen = SymmetricEigen::new(symmetric);
    let least = eigen.eigenvalues.imin();
    let v = eigen.eigenvectors.column(least);
    // drop rounding errors
    let v = v.map(|x| if x.abs() < 1e-12 { 0.0 } else { x });
    let physical = [v[0] * ei, v[1] * ea, v[2] / fluid[0], v[3] / fluid[1]];
    let pressure = if physical[2].abs() >= physical[3].abs() {
        physical[2]
    } else {
        physical[3]
    };
    let by = if pressure == 0.0 { 1.0 } else { 1000.0 / pressure };
    let coupling = (symmetric - Matrix4::identity()).norm();
    let odd = (l - l.transpose()).norm() * 0.5;
    Passivity {
        least: eigen.eigenvalues[least],
        direction: physical.map(|x| x * by),
        defect: if odd > 0.0 { odd / coupling } else { 0.0 },
    }
}

impl Passivity {
    /// Antisymmetric parts below this limit are rounding errors.
    const ROUND_OFF: f64 = 1e-12;

    /// True if the law is reciprocal and its stored energy positive.
    pub fn passive(&self) -> bool {
        self.least > 0.0 && self.reciprocal()
    }

    /// True if strains and areas derive from one potential.
    pub fn reciprocal(&self) -> bool {
        self.defect <= Self::ROUND_OFF
    }

    /// Describes the result in words.
    pub fn describe(&self, coupling: &CouplingLaw) -> String {
        let name = match coupling {
            CouplingLaw::Published { .. } => "published",
            CouplingLaw::Reciprocal { .. } => "reciprocal",
        };
        let least = format!(
            "the smallest work of a load is {:.4} of its work without coupling",
            self.least
        );
        let [m, n, upper, lower] = self.direction;
        let size = |value: f64, unit: &str| quantity(value, unit, 4);
        let worst = format!(
            "at M {}, N {}, p_u {}, p_d {}",
            size(m, "N m"),
            size(n, "N"),
            size(upper, "Pa"),
            size(lower, "Pa")
        );
        match (self.least > 0.0, self.reciprocal()) {
            (true, true) => {
                format!("the {name} coupling is passive: no cycle of loads and pressures gains work; {least}, {worst}")
            }
            (true, false) => format!(
                "the {name} coupling is not passive: it is not reciprocal (defect {:.3}), so closed cycles of load and pressure gain or \
                 lose work; {least}, {worst}",
                self.defect
            ),
            (false, _) => {
                format!("the {name} coupling is not passive: {least}, {worst}; motion with sealed bladders grows")
            }
        }
    }
}
