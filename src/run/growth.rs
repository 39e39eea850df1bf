//! Growth of the response, and its causes.

use serde::{Deserialize, Serialize};

use super::drives::{self, KINDS};
use super::fit;
use crate::discrete::TimeData;
use crate::discrete::ledger::EnergyRate;
use crate::error::numbers::quantity;
use crate::model::characteristic::MathieuTongue;

/// Number of windows into which a run is divided.
const WINDOWS: usize = 16;

/// Factor by which the growth of a response must exceed that of its drive.
const OUTGROWN: f64 = 2.0;
/// Least growth factor over the later part of a run that counts as growth.
const GROWN: f64 = 3.0;

/// Fraction of the first deflection below which a minimum counts as a reversal.
const FALLEN: f64 = 0.5;

/// Least squared correlation of the logarithm of the deflection with time that counts as exponential growth.
const STRAIGHT: f64 = 0.6;

/// Largest values in one window of the run, and cumulative works at its end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Window {
    deflection: f64,
    bending_energy: f64,
    reciprocity: f64,
    formulation: f64,
    residual: f64,
    /// Work of loads, ends and ports: sum of magnitudes.
    work: f64,
    /// Largest magnitude of each kind of excitation, in its own unit.
    drive: [f64; KINDS],
    samples: u32,
    /// Time of the works [s].
    t: f64,
}

/// Records the deflection window by window.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Growth {
    end: f64,
    windows: Vec<Window>,
    /// Largest compressive force seen [N].
    compression: f64,
}

/// Cause of a growing response.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Driver {
    /// `parametric`, `buckling`, `coupling`, `formulation`, `integrator`, `loads` or `unknown`.
    pub name: String,
    /// Numbers that support the cause.
    pub evidence: String,
}

impl Driver {
    /// Drivers with their evidence, as one list for a message.
    pub fn list(drivers: &[Self]) -> String {
        let all = drivers.iter().map(|d| format!("{} ({})", d.name, d.evidence));
        all.collect::<Vec<_>>().join("; ")
    }
}

/// A growing response.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GrowingResponse {
    /// Growth rate of the largest deflection [1/s], fitted over the later three quarters of the run.
    pub rate_per_s: f64,
    /// Deflection at the end over that after the first quarter.
    pub factor: f64,
    /// Causes, in the order in which they are checked.
    pub drivers: Vec<Driver>,
}

/// Properties of the scene from its linearization.
#[derive(Clone, Copy, Debug, Default)]
pub struct LinearProperties {
    /// Axial base motion.
    pub mathieu: Option<MathieuTongue>,
    /// Euler's load [N].
    pub euler_load: Option<f64>,
}

impl Growth {
    /// Creates the record of a run until `end` [s].
    pub fn new(end: f64) -> Self {
        Self {
            end,
            windows: vec![Window::default(); WINDOWS],
            ..Self::default()
        }
    }

    /// Adds a state, in any order of time: deflection relative to the root [m], bending energy [J], most negative normal force
    /// [N].
    pub fn take(
        &mut self,
        now: &TimeData,
        t: f64,
        [deflection, bending, least_force]: [f64; 3],
        integrals: &[f64],
        residual: f64,
    ) {
        let k = ((t / self.end * WINDOWS as f64) as usize).min(WINDOWS - 1);
        self.compression = self.compression.max(-least_force);
        let Some(w) = self.windows.get_mut(k) else { return };
        w.deflection = w.deflection.max(deflection);
        w.bending_energy = w.bending_energy.max(bending);
        for (seen, size) in w.drive.iter_mut().zip(drives::sizes(now)) {
            *seen = seen.max(size);
        }
        w.samples += 1;
        if t >= w.t {
            w.t = t;
            w.reciprocity = integrals[EnergyRate::Reciprocity as usize];
            w.formulation = integrals[EnergyRate::Formulation as usize];
            w.residual = residual;
            w.work = [EnergyRate::Loads, EnergyRate::Ends, EnergyRate::Ports]
                .map(|f| integrals[f as usize].abs())
                .iter()
                .sum();
        }
    }

    /// Returns growth and causes if the deflection grows exponentially until the end. `length` [m] is the length of the beam.
    pub fn judge(&self, length: f64, linear: &LinearProperties) -> Option<GrowingResponse> {
        let seen: Vec<&Window> = self.windows.iter().take_while(|w| w.samples > 0).collect();
        if seen.len() < WINDOWS / 2 {
            return None;
        }
        let late = rising(&seen[seen.len() / 4..]);
        let last = late.last()?;
        if last.deflection < 1e-9 * length {
            return None;
        }
        let width = self.end / WINDOWS as f64;
        let first = seen.len() - late.len();
        let points: Vec<(f64, f64)> = late
            .iter()
            .enumerate()
            .filter(|(_, w)| w.deflection > 0.0)
            .map(|(k, w)| ((first + k) as f64 * width + 0.5 * width, w.deflection))
            .collect();
        let (rate, straight) = fit::exponential(&points)?;
        let factor = last.deflection / late[0].deflection.max(f64::MIN_POSITIVE);
        let quarter = late.len() / 3;
        let largest = |part: &[&Window]| part.iter().map(|w| w.deflection).fold(0.0, f64::max);
        let still =
            largest(&late[late.len() - quarter..]) / largest(&late[late.len() - 2 * quarter..late.len() - quarter]);
        // Growth needs a factor over the span, a straight line in the logarithm, and an increase that continues.
        if factor < GROWN || straight < STRAIGHT || still < 1.2 || rate <= 0.0 {
            return None;
        }
        // Self-excited growth increases the bending energy; a beam that moves away as a load falls does not.
        if last.bending_energy < OUTGROWN * late[0].bending_energy {
            return None;
        }
        // There is no instability if a straight line or a power of time fits as well, or if the response follows its drive.
        if !fit::is_exponential(&points) || follows(late) {
            return None;
        }
        Some(GrowingResponse {
            rate_per_s: rate,
            factor,
            drivers: self.drivers(late, rate, linear),
        })
    }

    /// Warns if a beam without inertia stayed straight although its compression exceeded Euler's load. This equilibrium is
    /// unstable, but the equations of a perfect column do not detect it.
    pub fn straight_beyond_buckling(&self, length: f64, linear: &LinearProperties) -> Option<String> {
        let euler = linear.euler_load?;
        let largest = self.windows.iter().map(|w| w.deflection).fold(0.0, f64::max);
        (self.compression > euler && largest < 1e-6 * length).then(|| {
            format!(
                "buckling: compression reached {}, above Euler's load {}. The beam without inertia stayed straight, \
                 in an unstable equilibrium. Add a transverse load of a thousandth of the axial load to obtain the \
                 bent state.",
                quantity(self.compression, "N", 4),
                quantity(euler, "N", 4)
            )
        })
    }

    fn drivers(&self, late: &[&Window], rate: f64, linear: &LinearProperties) -> Vec<Driver> {
        let (first, last) = (late[0], late[late.len() - 1]);
        let gained = (last.bending_energy - first.bending_energy).max(f64::MIN_POSITIVE);
        let driver = |name: &str, evidence: String| Driver {
            name: name.into(),
            evidence,
        };
        let mut all = Vec::new();
        let parametric = linear.mathieu.filter(|m| m.growth_rate > 0.0);
        if let Some(m) = parametric {
            all.push(driver(
                "parametric",
                format!(
                    "axial shaking at {:.4} Hz lies in a Mathieu tongue of the first bending mode: predicted rate \
                     {:.3} 1/s (single undamped mode), observed {rate:.3} 1/s",
                    m.frequency, m.growth_rate
                ),
            ));
        }
        if let Some(euler) = linear.euler_load
            && parametric.is_none()
            && self.compression > euler
        {
            all.push(driver(
                "buckling",
                format!(
                    "compression reached {}, above Euler's load {}",
                    quantity(self.compression, "N", 4),
                    quantity(euler, "N", 4)
                ),
            ));
        }
        for (name, work, what) in [
            (
                "coupling",
                last.reciprocity - first.reciprocity,
                "the coupling without reciprocity (P_reciprocity)",
            ),
            (
                "formulation",
                last.formulation - first.formulation,
                "the published momentum balance (P_formulation)",
            ),
            (
                "integrator",
                last.residual - first.residual,
                "the integrator (energy residual)",
            ),
        ] {
            if work > 0.3 * gained {
                all.push(driver(
                    name,
                    format!(
                        "{what} added {} while the bending energy rose by {}",
                        quantity(work, "J", 4),
                        quantity(gained, "J", 4)
                    ),
                ));
            }
        }
        if all.is_empty() && last.work > 0.3 * gained {
            all.push(driver(
                "loads",
                format!(
                    "no known instability: loads, driven ends and ports did {} of work",
                    quantity(last.work, "J", 4)
                ),
            ));
        }
        if all.is_empty() {
            all.push(driver(
                "unknown",
                "no known instability, and nothing does work: the initial energy is redistributed".into(),
            ));
        }
        all
    }
}

/// Returns the windows from the least deflection on, if the deflection fell before. It passes through zero where a load falls,
/// and only the later part can be growth.
fn rising<'a>(late: &'a [&'a Window]) -> &'a [&'a Window] {
    let least = (0..late.len()).min_by(|a, b| late[*a].deflection.total_cmp(&late[*b].deflection));
    let least = least.filter(|least| late[*least].deflection < FALLEN * late[0].deflection);
    &late[least.unwrap_or(0)..]
}

/// True if a drive explains the growth: from the first window in which it acts, the response does not outgrow it.
fn follows(late: &[&Window]) -> bool {
    let last = late[late.len() - 1];
    (0..KINDS).any(|kind| {
        let Some(first) = late.iter().find(|w| w.drive[kind] > 0.0) else {
            return false;
        };
        let drive = last.drive[kind] / first.drive[kind];
        let response = last.deflection / first.deflection.max(f64::MIN_POSITIVE);
        response < GROWN.max(OUTGROWN * drive)
    })
}

impl GrowingResponse {
    /// Formats the growth as one warning; `periodic` is true for a periodic drive.
    pub fn warning(&self, periodic: bool) -> String {
        let driven_by = |name: &str| self.drivers.iter().any(|driver| driver.name == name);
        let action = if periodic {
            "Check with `slcbeam floquet CASE`"
        } else if driven_by("coupling") || driven_by("formulation") {
            "Use the reciprocal coupling and the conservative formulation"
        } else if driven_by("integrator") {
            "Reduce /solver/rtol"
        } else {
            "Run longer"
        };
        format!(
            "the deflection grows at {:.3} 1/s, by a factor {:.3} over the later three quarters of the run; driven by: \
             {}. {action}.",
            self.rate_per_s,
            self.factor,
            Driver::list(&self.drivers)
        )
    }
}
