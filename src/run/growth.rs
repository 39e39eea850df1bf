//! Does the response grow, and what drives it?

use serde::{Deserialize, Serialize};

use crate::discrete::ledger::Flow;
use crate::model::characteristic::Mathieu;

/// Windows into which a run is divided.
const WINDOWS: usize = 16;

/// The largest values in one window of the run, and cumulated works at its end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Window {
    deflection: f64,
    bending_energy: f64,
    reciprocity: f64,
    formulation: f64,
    residual: f64,
    samples: u32,
}

/// Follows the deflection window by window.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Growth {
    end: f64,
    windows: Vec<Window>,
    /// Largest compressive force seen [N].
    pub compression: f64,
}

/// What drives a growing response.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Driver {
    /// `parametric`, `buckling`, `coupling`, `formulation`, `integrator` or `loads`.
    pub name: String,
    /// The numbers that say so.
    pub evidence: String,
}

/// A growing response.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Growing {
    /// Growth rate of the largest deflection [1/s], fitted over the later three quarters of the run.
    pub rate_per_s: f64,
    /// Deflection at the end over that after the first quarter.
    pub factor: f64,
    /// What drives it, the strongest first.
    pub drivers: Vec<Driver>,
}

/// What is known about the scene from its linearisation.
#[derive(Clone, Copy, Debug, Default)]
pub struct Linear {
    /// Axial base motion.
    pub mathieu: Option<Mathieu>,
    /// Euler's load [N].
    pub euler_load: Option<f64>,
}

impl Growth {
    /// For a run until `end` [s].
    pub fn new(end: f64) -> Self {
        Self {
            end,
            windows: vec![Window::default(); WINDOWS],
            compression: 0.0,
        }
    }

    /// Takes a sample: deflection relative to the root [m], bending energy [J], most negative normal force [N].
    pub fn take(&mut self, t: f64, deflection: f64, bending: f64, least_force: f64, integrals: &[f64], residual: f64) {
        let k = ((t / self.end * WINDOWS as f64) as usize).min(WINDOWS - 1);
        self.compression = self.compression.max(-least_force);
        let Some(w) = self.windows.get_mut(k) else { return };
        w.deflection = w.deflection.max(deflection);
        w.bending_energy = w.bending_energy.max(bending);
        w.reciprocity = integrals[Flow::Reciprocity as usize];
        w.formulation = integrals[Flow::Formulation as usize];
        w.residual = residual;
        w.samples += 1;
    }

    /// Whether the deflection grows, exponentially and to the end, and why. `length` [m] is the beam's.
    pub fn judge(&self, length: f64, linear: &Linear) -> Option<Growing> {
        let seen: Vec<&Window> = self.windows.iter().take_while(|w| w.samples > 0).collect();
        if seen.len() < WINDOWS / 2 {
            return None;
        }
        let late = &seen[seen.len() / 4..];
        let last = late.last()?;
        if last.deflection < 1e-9 * length {
            return None;
        }
        let width = self.end / WINDOWS as f64;
        let (rate, straight) = fit(late, width)?;
        let factor = last.deflection / late[0].deflection.max(f64::MIN_POSITIVE);
        let quarter = late.len() / 3;
        let largest = |part: &[&Window]| part.iter().map(|w| w.deflection).fold(0.0, f64::max);
        let still =
            largest(&late[late.len() - quarter..]) / largest(&late[late.len() - 2 * quarter..late.len() - quarter]);
        // A factor of 3 over the span, along a straight line in the logarithm, and still going on.
        if factor < 3.0 || straight < 0.6 || still < 1.2 || rate <= 0.0 {
            return None;
        }
        Some(Growing {
            rate_per_s: rate,
            factor,
            drivers: self.drivers(late, rate, linear),
        })
    }

    /// A warning when a beam without inertia stayed straight although its compression passed Euler's load: an equilibrium,
    /// but no stable one, which nothing in the equations of a perfect column notices.
    pub fn straight_beyond_buckling(&self, length: f64, linear: &Linear) -> Option<String> {
        let euler = linear.euler_load?;
        let largest = self.windows.iter().map(|w| w.deflection).fold(0.0, f64::max);
        (self.compression > euler && largest < 1e-6 * length).then(|| {
            format!(
                "buckling: compression reached {:.3e} N, above Euler's load {euler:.3e} N, and the beam without inertia stayed \
                 straight, an unstable equilibrium; a load across of a thousandth would show the bent one",
                self.compression
            )
        })
    }

    fn drivers(&self, late: &[&Window], rate: f64, linear: &Linear) -> Vec<Driver> {
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
                    "axial shaking at {:.4} Hz lies in a Mathieu tongue of the first bending mode: predicted rate {:.3} 1/s \
                     (single undamped mode), seen {rate:.3} 1/s",
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
                    "compression reached {:.3e} N, above Euler's load {euler:.3e} N",
                    self.compression
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
                    format!("{what} added {work:.3e} J while the bending energy rose by {gained:.3e} J"),
                ));
            }
        }
        if all.is_empty() {
            all.push(driver(
                "loads",
                "no instability is known: loads and driven ends do the work".into(),
            ));
        }
        all
    }
}

/// Slope of the logarithm of the deflection against time, and the squared correlation.
fn fit(windows: &[&Window], width: f64) -> Option<(f64, f64)> {
    let points: Vec<(f64, f64)> = windows
        .iter()
        .enumerate()
        .filter(|(_, w)| w.deflection > 0.0)
        .map(|(k, w)| (k as f64 * width, w.deflection.ln()))
        .collect();
    let n = points.len() as f64;
    if points.len() < 4 {
        return None;
    }
    let mean = |f: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / n;
    let (mt, ml) = (mean(&|p| p.0), mean(&|p| p.1));
    let stt = mean(&|p| (p.0 - mt).powi(2));
    let sll = mean(&|p| (p.1 - ml).powi(2));
    let stl = mean(&|p| (p.0 - mt) * (p.1 - ml));
    (stt > 0.0 && sll > 0.0).then(|| (stl / stt, stl * stl / (stt * sll)))
}

impl Growing {
    /// As one warning.
    pub fn warning(&self) -> String {
        let drivers: Vec<String> = self
            .drivers
            .iter()
            .map(|d| format!("{} ({})", d.name, d.evidence))
            .collect();
        format!(
            "the deflection grows at {:.3} 1/s, by a factor {:.3} over the later three quarters of the run; driven by: {}",
            self.rate_per_s,
            self.factor,
            drivers.join("; ")
        )
    }
}
