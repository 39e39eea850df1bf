//! Polynomial for the section's energy beyond its quadratic part: smooth, conservative for any fit error, and cheap to evaluate.
//!
//! ```text
//! Omega(e, kappa, p) = Omega_2 + P(z)      y = (e - e_p, kappa - kappa_p, p_u, p_l)                        [F6]
//! P = sum over 3 <= |k| <= degree of P_k z^k, with mirrored rows those of even k_2 + k_4, with an upper row alone those of k_4 = 0
//! z = (y_1/g_1, y_2/g_2, (p_u + p_l)/2 g_3, (p_u - p_l)/2 g_3),      g_i the largest of its limits
//! ```
//!
//! Omega_2 is the quadratic part of [F5]; e_p and kappa_p are its strains by pressure, e the stretch of the neutral axis. y contains the strains by
//! loads, and the pressures. P is the least-squares fit of first and second derivatives on rays of the ellipsoid of
//! the limits. Its error is that of the first derivatives at states on the ellipsoid outside the fit. The limits are the widest with a
//! stable cell and a good fit: each axis is followed to its end, or to the validity limit of rubber laws. Then all axes are shortened
//! together.

use super::{Drive, FiniteCell, SectionState, State};
use crate::cell::Cell;
use crate::coefficients::Options;
use crate::dense;
use crate::error::Error;
use crate::input::{Row, Section};
use crate::mesh::Fineness;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{Builder, ScopedJoinHandle};

/// Largest strain of the outer fibre.
const LARGEST_STRAIN: f64 = 0.3;
/// Largest relative area change, by the linear law.
const LARGEST_SWELLING: f64 = 1.0;
/// Largest pressure over Young's modulus.
const LARGEST_PRESSURE: f64 = 0.2;
/// Largest Poisson's ratio for P; solids closer to incompressible cost many more steps and change P by up to 0.5 % of the quadratic part.
const NEARLY_INCOMPRESSIBLE: f64 = 0.49;
/// Number of steps along each axis, of increasing length.
const STEPS: u32 = 8;
/// Fractions of the axes tried as limits, in turn, until all states are found and the fit is accurate.
const PARTS: [f64; 6] = [0.75, 0.6, 0.45, 0.35, 0.25, 0.15];
/// Radii of the fitted states over that of the ellipsoid.
const RADII: [f64; 3] = [0.35, 0.7, 1.0];
/// Fit error below which the degree is kept, and the largest accepted error.
const GOOD: f64 = 2e-3;
const TAKEN: f64 = 1e-2;
/// Degrees of the polynomial, in trial order.
const DEGREES: std::ops::RangeInclusive<usize> = 4..=6;
/// Relative difference of the rows attributed to rounding errors or the mesh.
const ALIKE: f64 = 1e-3;
/// Weight of second derivatives relative to first derivatives.
const SECOND: f64 = 0.1;

/// P of [F6].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StrainEnergy {
    /// Ends of the axes of the ellipsoid in which it holds: stretch [1], curvature [1/m], pressure of the upper and of the lower row [Pa].
    pub limits: [[f64; 2]; 4],
    /// Degree of the polynomial.
    pub degree: usize,
    /// True if the terms are those of mirrored rows.
    #[serde(default = "yes", skip_serializing_if = "is_yes")]
    pub mirrored: bool,
    /// `P_k` [N], in the order of `monomials`.
    pub coefficients_n: Vec<f64>,
    /// Largest error of the first derivatives over the largest of their linear parts.
    pub error: f64,
}

fn yes() -> bool {
    true
}

fn is_yes(mirrored: &bool) -> bool {
    *mirrored
}

/// Exponents k of [F6], those of pressures outermost, pairs sorted by sum; coefficients of one pair of pressure exponents are adjacent.
pub fn monomials(degree: usize, mirrored: bool) -> impl Iterator<Item = [usize; 4]> {
    let pairs = |most: usize| (0..=most).flat_map(|sum| (0..=sum).map(move |second| [sum - second, second]));
    pairs(degree).flat_map(move |[s, d]| {
        let inner = pairs(degree - s - d).map(move |[e, k]| [e, k, s, d]);
        inner.filter(move |[e, k, s, d]| e + k + s + d >= 3 && (!mirrored || (k + d) % 2 == 0))
    })
}

/// Matrix of z by y; y_1, y_2 and both pressures are divided by g.
fn sizes(g: [f64; 3]) -> [[f64; 4]; 4] {
    let p = 0.5 / g[2];
    [
        [1.0 / g[0], 0.0, 0.0, 0.0],
        [0.0, 1.0 / g[1], 0.0, 0.0],
        [0.0, 0.0, p, p],
        [0.0, 0.0, p, -p],
    ]
}

impl Section {
    /// P of the section under the laws of its materials; None if its material has no law.
    pub fn strain_energy(&self) -> Result<Option<StrainEnergy>, Error> {
        let Some((softer, cell)) = self.nearly_incompressible(Options::default().fineness)? else {
            return Ok(None);
        };
        Experiment::new(&cell, &softer)?.fit().map(Some)
    }

    /// The section with materials of at most the largest Poisson's ratio for finite strain, and its cell; None without a law.
    pub(super) fn nearly_incompressible(&self, fineness: Fineness) -> Result<Option<(Section, FiniteCell)>, Error> {
        let Some(law) = self.material.law else {
            return Ok(None);
        };
        let meshes = self.meshes(&Options { fineness, meshes: 1 })?;
        let mut softer = self.clone();
        let materials = softer.regions.iter_mut().map(|region| &mut region.material);
        for material in materials.chain([&mut softer.material]) {
            let mu = material.shear_modulus();
            material.poisson_ratio = material.poisson_ratio.min(NEARLY_INCOMPRESSIBLE);
            material.young_modulus_pa = 2.0 * (1.0 + material.poisson_ratio) * mu;
        }
        let cell = FiniteCell::new(&softer, Cell::new(&softer, &meshes[0]), law)?;
        Ok(Some((softer, cell)))
    }
}

/// A state of the cell with the derivatives of P.
#[derive(Clone, Copy)]
struct Sample {
    y: [f64; 4],
    /// First and second derivatives of P by y.
    first: [f64; 4],
    second: [[f64; 4]; 4],
    /// First derivatives of Omega_2 by y.
    linear: [f64; 4],
}

impl Sample {
    /// Sample of the cell mirrored at the mid-plane.
    fn mirrored(&self) -> Self {
        const IMAGE: [(usize, f64); 4] = [(0, 1.0), (1, -1.0), (3, 1.0), (2, 1.0)];
        let turn = |v: &[f64; 4]| IMAGE.map(|(i, sign)| sign * v[i]);
        Self {
            y: turn(&self.y),
            first: turn(&self.first),
            second: IMAGE.map(|(i, sign)| turn(&self.second[i]).map(|v| sign * v)),
            linear: turn(&self.linear),
        }
    }
}

/// A cell with its data at rest.
struct Experiment<'a> {
    cell: &'a FiniteCell,
    /// True if the lower row mirrors the upper one.
    mirrored: bool,
    terms: Terms,
    /// Distance of the farthest fibre from the neutral axis [m].
    farthest: f64,
    modulus: f64,
    /// phi_b l_b.
    ratio: f64,
    /// Area of the bladders at rest [m^2].
    areas: [f64; 2],
    /// Second derivatives of Omega at rest.
    tangent: [[f64; 4]; 4],
    /// Matrix of (e, kappa, p_u, p_l) by y.
    turn: [[f64; 4]; 4],
}

impl<'a> Experiment<'a> {
    fn new(cell: &'a FiniteCell, section: &Section) -> Result<Self, Error> {
        let tangent = cell.equilibrium(Drive::Strain([0.0; 2]), [0.0; 2])?.tangent;
        let mut turn = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(i == j)));
        let neutral = -tangent[0][1] / tangent[0][0];
        if !is_mirrored(&tangent) {
            turn[0][1] = neutral;
        }
        for p in 2..4 {
            let block = [[tangent[0][0], tangent[0][1]], [tangent[1][0], tangent[1][1]]];
            let strain = dense::solve(block, [-tangent[0][p], -tangent[1][p]]).ok_or(Error::Singular)?;
            (0..2).for_each(|i| turn[i][p] = strain[i]);
        }
        Ok(Self {
            cell,
            mirrored: matches!(section.bladders.lower, Row::Mirrored) && section.regions.is_empty(),
            terms: Terms {
                mirrored: is_mirrored(&tangent),
                one_row: section.bladders.lower == Row::None,
            },
            farthest: 0.5 * section.height_m + turn[0][1].abs(),
            modulus: section.material.young_modulus_pa,
            ratio: section.bladders.length_m / section.pitch_m,
            areas: cell.areas,
            tangent,
            turn,
        })
    }

    /// Equilibrium of the cell at y, from a state at `before`; None if not found or unstable.
    fn follow(&self, state: &mut State, before: [f64; 4], y: [f64; 4]) -> Option<SectionState> {
        let x = self.turn.map(|row| dense::dot(&row, &y));
        let drive = Drive::Strain([x[0], x[1]]);
        let found = self
            .cell
            .follow(state, [before[2], before[3]], drive, [x[2], x[3]])
            .ok()?;
        is_stable(&found.tangent).then_some(found)
    }

    fn sample(&self, y: [f64; 4], at: &SectionState) -> Sample {
        let x = self.turn.map(|row| dense::dot(&row, &y));
        let [upper, lower] = at.areas_m2.map(|a| -self.ratio * a);
        let own = [at.resultants[0], at.resultants[1], upper, lower];
        let linear = self.tangent.map(|row| dense::dot(&row, &x));
        let by_y = |v: [f64; 4]| -> [f64; 4] { std::array::from_fn(|j| (0..4).map(|i| v[i] * self.turn[i][j]).sum()) };
        let half: [[f64; 4]; 4] =
            std::array::from_fn(|i| by_y(std::array::from_fn(|j| at.tangent[i][j] - self.tangent[i][j])));
        Sample {
            y,
            first: by_y(std::array::from_fn(|i| own[i] - linear[i])),
            second: std::array::from_fn(|j| by_y(std::array::from_fn(|i| half[i][j]))),
            linear: by_y(linear),
        }
    }

    /// Ends of the stable part of each axis.
    fn axes(&self) -> [[f64; 2]; 4] {
        let swelling = |row: usize| match self.areas[row] {
            area if area > 0.0 => {
                let doubled = LARGEST_SWELLING * area * self.ratio / -self.tangent[2 + row][2 + row];
                doubled.min(LARGEST_PRESSURE * self.modulus)
            }
            _ => 0.0,
        };
        let most = [LARGEST_STRAIN, LARGEST_STRAIN / self.farthest, swelling(0), swelling(1)];
        std::array::from_fn(|k| [-1.0, 1.0].map(|sense| sense * self.reach(k, sense * most[k]).abs()))
    }

    /// End of the stable part of one axis, up to `most`.
    fn reach(&self, axis: usize, most: f64) -> f64 {
        let (mut state, mut last) = (self.cell.rest(), [0.0; 4]);
        for step in 1..=STEPS {
            let mut y = [0.0; 4];
            y[axis] = most * (f64::from(step) / f64::from(STEPS)).powi(2);
            if self.follow(&mut state, last, y).is_none() {
                break;
            }
            last = y;
        }
        last[axis]
    }

    /// States on rays of the ellipsoid, in order. None if one is not found.
    fn states(&self, rays: &[[f64; 4]], radii: &[f64], limits: &[[f64; 2]; 4]) -> Option<Vec<Sample>> {
        let image = |ray: &[f64; 4]| [ray[0], -ray[1], ray[3], ray[2]];
        let spared = |ray: &[f64; 4]| self.mirrored && image(ray) < *ray && rays.contains(&image(ray));
        let own: Vec<&[f64; 4]> = rays.iter().filter(|ray| !spared(ray)).collect();
        let missed = AtomicBool::new(false);
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let some = &|rays: &[&[f64; 4]]| -> Option<Vec<Sample>> {
            let mut samples = vec![];
            for ray in rays {
                let found = self
                    .on_ray(ray, radii, limits)
                    .filter(|_| !missed.load(Ordering::Relaxed));
                missed.fetch_or(found.is_none(), Ordering::Relaxed);
                samples.extend(found?);
            }
            Some(samples)
        };
        let all = std::thread::scope(|scope| {
            let parts = own.chunks(own.len().div_ceil(threads).max(1));
            let begin = |part| (part, Builder::new().spawn_scoped(scope, move || some(part)).ok());
            let running: Vec<_> = parts.map(begin).collect();
            // parts without a granted thread run in this one
            let join = |(part, thread): (_, Option<ScopedJoinHandle<'_, _>>)| match thread {
                Some(thread) => thread.join().ok().flatten(),
                None => some(part),
            };
            running.into_iter().map(join).collect::<Option<Vec<_>>>()
        });
        all.map(|parts| parts.concat())
    }

    /// States on one ray, with their mirror images if the section is mirrored.
    fn on_ray(&self, ray: &[f64; 4], radii: &[f64], limits: &[[f64; 2]; 4]) -> Option<Vec<Sample>> {
        let (mut state, mut last) = (self.cell.rest(), [0.0; 4]);
        let mut samples = vec![];
        for radius in radii {
            let y = std::array::from_fn(|k| radius * ray[k] * limits[k][usize::from(ray[k] > 0.0)].abs());
            let sample = self.sample(y, &self.follow(&mut state, last, y)?);
            samples.push(sample);
            samples.extend(self.mirrored.then(|| sample.mirrored()));
            last = y;
        }
        Some(samples)
    }

    /// Accepted fit with the widest limits.
    fn fit(&self) -> Result<StrainEnergy, Error> {
        let axes = self.axes();
        for part in PARTS {
            let limits = axes.map(|axis| axis.map(|end| part * end));
            let Some(seen) = self.states(&rays(), &RADII, &limits) else {
                continue;
            };
            let Some(unseen) = self.states(&others(), &[1.0], &limits) else {
                continue;
            };
            let mut best: Option<StrainEnergy> = None;
            for degree in DEGREES {
                let found = least_squares(&seen, &unseen, limits, degree, self.terms)?;
                if best.as_ref().is_none_or(|best| found.error < best.error) {
                    best = Some(found);
                }
                if best.as_ref().is_some_and(|best| best.error < GOOD) {
                    break;
                }
            }
            if let Some(best) = best.filter(|best| best.error <= TAKEN) {
                return Ok(best);
            }
        }
        Err(Error::Energy)
    }
}

/// Terms of P.
#[derive(Clone, Copy, Debug)]
struct Terms {
    /// Only those of mirrored rows.
    mirrored: bool,
    /// Only those of an upper row.
    one_row: bool,
}

/// True if a linear response is mirror-symmetric.
fn is_mirrored(t: &[[f64; 4]; 4]) -> bool {
    let zero = |i: usize, j: usize, off: f64| off.abs() <= ALIKE * (t[i][i] * t[j][j]).abs().sqrt();
    zero(0, 1, t[0][1]) && zero(0, 2, t[0][2] - t[0][3]) && zero(1, 2, t[1][2] + t[1][3])
}

/// True if the energy is convex in the strains, and areas grow with pressures.
pub(super) fn is_stable(tangent: &[[f64; 4]; 4]) -> bool {
    let positive = |i: usize, sense: f64| {
        let own = [sense * tangent[i][i], sense * tangent[i + 1][i + 1]];
        let cross = tangent[i][i + 1];
        own[0] >= 0.0 && own[1] >= 0.0 && own[0] * own[1] >= cross * cross
    };
    positive(0, 1.0) && positive(2, -1.0)
}

/// Fits P to states, and determines its error at others.
fn least_squares(
    seen: &[Sample],
    unseen: &[Sample],
    limits: [[f64; 2]; 4],
    degree: usize,
    kind: Terms,
) -> Result<StrainEnergy, Error> {
    let largest = |of: &[[f64; 2]]| {
        of.iter()
            .flatten()
            .fold(f64::MIN_POSITIVE, |most, end| end.abs().max(most))
    };
    let z_by_y = sizes([largest(&limits[..1]), largest(&limits[1..2]), largest(&limits[2..])]);
    let z = |sample: &Sample| z_by_y.map(|row| dense::dot(&row, &sample.y));
    // Derivatives by y from those by z, by the chain rule; each is weighted relative to the largest of the quadratic part.
    let size: [f64; 4] = std::array::from_fn(|i| seen.iter().map(|s| s.linear[i].abs()).fold(0.0, f64::max));
    let terms: Vec<[usize; 4]> = monomials(degree, kind.mirrored).collect();
    let absent = |k: &[usize; 4]| kind.one_row && k[3] > 0;
    let by = |at: &[f64; 4], i: usize| -> Vec<f64> {
        let one = |k: &[usize; 4]| {
            if absent(k) {
                0.0
            } else {
                (0..4).map(|a| z_by_y[a][i] * derivative(k, at, &[a])).sum()
            }
        };
        terms.iter().map(one).collect()
    };
    let twice = |at: &[f64; 4], i: usize, j: usize| -> Vec<f64> {
        let pairs = || {
            (0..4)
                .flat_map(|a| (0..4).map(move |b| (a, b)))
                .filter(|(a, b)| z_by_y[*a][i] * z_by_y[*b][j] != 0.0)
        };
        let one = |k: &[usize; 4]| {
            if absent(k) {
                return 0.0;
            }
            pairs()
                .map(|(a, b)| z_by_y[a][i] * z_by_y[b][j] * derivative(k, at, &[a, b]))
                .sum()
        };
        terms.iter().map(one).collect()
    };
    let n = terms.len();
    let (mut normal, mut right) = (vec![0.0; n * n], vec![0.0; n]);
    let mut add = |row: &[f64], value: f64, weight: f64| {
        for (i, &a) in row.iter().enumerate().filter(|(_, a)| **a != 0.0) {
            right[i] += weight * a * value;
            for (entry, b) in normal[i * n..].iter_mut().zip(&row[..=i]) {
                *entry += weight * a * b;
            }
        }
    };
    let present = || (0..4).filter(|&i| size[i] > 0.0);
    for sample in seen {
        let at = z(sample);
        for i in present() {
            add(&by(&at, i), sample.first[i], size[i].powi(-2));
            for j in present().filter(|&j| j <= i) {
                let reach = limits[j][1].max(-limits[j][0]) / size[i];
                add(&twice(&at, i, j), sample.second[i][j], SECOND * reach * reach);
            }
        }
    }
    // set coefficients of missing bladders to zero
    (0..n).for_each(|i| normal[i * n + i] += f64::from(normal[i * n + i] == 0.0));
    let coefficients_n = dense::positive(&mut normal, right).ok_or(Error::Singular)?;
    let off = |sample: &Sample| {
        let at = z(sample);
        let one = |i: usize| (dense::dot(&by(&at, i), &coefficients_n) - sample.first[i]).abs() / size[i];
        present().map(one).fold(0.0, f64::max)
    };
    let error = unseen.iter().map(off).fold(0.0, f64::max);
    Ok(StrainEnergy {
        limits,
        degree,
        mirrored: kind.mirrored,
        coefficients_n,
        error,
    })
}

/// Derivative of z^k with respect to the variables in `by`.
fn derivative(k: &[usize; 4], z: &[f64; 4], by: &[usize]) -> f64 {
    let (mut k, mut factor) = (*k, 1.0);
    for &i in by {
        factor *= k[i] as f64;
        k[i] = k[i].saturating_sub(1);
    }
    if factor == 0.0 {
        return 0.0;
    }
    (0..4).map(|i| z[i].powi(k[i] as i32)).product::<f64>() * factor
}

/// 48 evenly spread directions: axes, diagonals of two axes and of all four.
fn rays() -> Vec<[f64; 4]> {
    let mut rays: Vec<[f64; 4]> = (0..16)
        .map(|bits| std::array::from_fn(|k| if bits >> k & 1 == 1 { 0.5 } else { -0.5 }))
        .collect();
    let half = 0.5_f64.sqrt();
    for k in 0..4 {
        for sense in [-1.0, 1.0] {
            rays.push(std::array::from_fn(|i| if i == k { sense } else { 0.0 }));
            for j in k + 1..4 {
                rays.extend([-half, half].map(|other| {
                    std::array::from_fn(|i| match i {
                        i if i == k => sense * half,
                        i if i == j => other,
                        _ => 0.0,
                    })
                }));
            }
        }
    }
    rays
}

/// 32 other directions, vertices of the 600-cell.
fn others() -> Vec<[f64; 4]> {
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let sizes = [golden / 2.0, 0.5, 0.5 / golden, 0.0];
    let signed = (0..8).map(|bits| -> [f64; 4] {
        std::array::from_fn(|k| {
            if k < 3 && bits >> k & 1 == 1 {
                -sizes[k]
            } else {
                sizes[k]
            }
        })
    });
    let turned = |v: [f64; 4]| (0..4).map(move |turn| std::array::from_fn(|k| v[(k + turn) % 4]));
    signed.flat_map(turned).collect()
}
