//! A section pumped up at finite strain: free curvature and blocked moment, up to the limit point of the pressure.
//!
//! ```text
//! free:      N = 0, M = 0          blocked: N = 0, kappa = 0                                    [F7]
//! growth of x at p:   (x(p)/p) / lim (x/p) for p -> 0,     x = kappa or a (free), M (blocked)
//! limit point:        the largest pressure with a stable cell along the path from rest
//! ```
//!
//! The growths hardly depend on the mesh. They multiply the linear coefficients, which have their own error estimate and may be those in
//! three dimensions. Beyond the limit point chambers balloon: the model has no neighbouring state.

use super::energy::is_stable;
use super::{Drive, FiniteCell, SectionState, State};
use crate::coefficients::Options;
use crate::error::Error;
use crate::input::Section;
use crate::mesh::Fineness;

/// Pressure of the linear reference over Young's modulus. Growths differ by about this from those to the limit.
const SMALL: f64 = 2e-3;
/// Mesh of the growths, which hardly depend on it.
const COARSE: Fineness = Fineness {
    largest: 0.5,
    corner: 0.05,
    wall: 1.4,
    arc: 0.8,
    growth: 1.2,
};
/// Largest moment of the remaining axial force over the blocked moment.
const UNBALANCED: f64 = 1e-4;
/// Largest step of pressure over Young's modulus.
const STEP: f64 = 0.05;
/// Bisections of the step in which the limit point is.
const BISECTIONS: usize = 6;
/// Rounds for the stretch of the blocked section without axial force.
const ROUNDS: usize = 20;

/// Ratios to the linear law at one pressure of the upper row; None beyond the limit point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Growth {
    /// Pressure of the upper row [Pa].
    pub pressure_pa: f64,
    /// Free curvature over the linear one.
    pub curvature: Option<f64>,
    /// Free change of the upper bladder's area over the linear one.
    pub area: Option<f64>,
    /// Blocked moment over the linear one.
    pub moment: Option<f64>,
}

/// Growths at given pressures, and the limit points.
#[derive(Debug, Clone, PartialEq)]
pub struct Inflation {
    /// Growths at the pressures, in their order.
    pub growths: Vec<Growth>,
    /// Limit point of the free section [Pa]; None if it is above the largest pressure.
    pub limit_pa: Option<f64>,
    /// Limit point of the blocked section [Pa]; None if it is above the largest pressure.
    pub blocked_limit_pa: Option<f64>,
}

/// A section on its path from rest.
struct Path<'a> {
    cell: &'a FiniteCell,
    state: State,
    pressure: f64,
    blocked: bool,
    step: f64,
    /// Upper end of the step in which the limit point is, once it is met.
    limit: Option<f64>,
}

impl Path<'_> {
    /// Equilibrium at a larger pressure; None beyond the limit point.
    fn reach(&mut self, pressure: f64) -> Option<SectionState> {
        let mut found = None;
        while self.limit.is_none() && found.is_none() {
            let next = pressure.min(self.pressure + self.step);
            match self.advance(next) {
                Some(at) if next == pressure => found = Some(at),
                Some(_) => {}
                None => self.bisect(next),
            }
        }
        found
    }

    /// Equilibrium at a pressure, from the present state, which it replaces.
    fn advance(&mut self, pressure: f64) -> Option<SectionState> {
        let mut state = self.state.clone();
        let found = match self.blocked {
            true => self.block(&mut state, pressure),
            false => {
                let now = [pressure, 0.0];
                self.cell
                    .follow(&mut state, [self.pressure, 0.0], Drive::Load([0.0; 2]), now)
                    .ok()
            }
        }?;
        is_stable(&found.tangent).then(|| {
            (self.state, self.pressure) = (state, pressure);
            found
        })
    }

    /// Equilibrium without curvature and axial force.
    fn block(&self, state: &mut State, pressure: f64) -> Option<SectionState> {
        let (mut stretch, mut before) = (state.q[0], self.pressure);
        for _ in 0..ROUNDS {
            let drive = Drive::Strain([stretch, 0.0]);
            let found = self.cell.follow(state, [before, 0.0], drive, [pressure, 0.0]).ok()?;
            before = pressure;
            let [force, moment] = found.resultants;
            stretch -= force / found.tangent[0][0];
            if force.abs() * self.cell.cell.size[1] < UNBALANCED * moment.abs() {
                return Some(found);
            }
        }
        None
    }

    /// Closes in on the limit point between the present state and a pressure without equilibrium.
    fn bisect(&mut self, mut above: f64) {
        for _ in 0..BISECTIONS {
            let middle = (self.pressure + above) / 2.0;
            if self.advance(middle).is_none() {
                above = middle;
            }
        }
        self.limit = Some(above);
    }
}

impl Section {
    /// Growths at rising pressures of the upper row [Pa]; None if its material has no law.
    pub fn inflate(&self, pressures: &[f64]) -> Result<Option<Inflation>, Error> {
        // a coarse mesh may have a folded element beside an arc
        let coarse = self.nearly_incompressible(COARSE);
        let Some((softer, cell)) = coarse.or_else(|_| self.nearly_incompressible(Options::default().fineness))? else {
            return Ok(None);
        };
        let modulus = softer.material.young_modulus_pa;
        let path = |blocked| Path {
            cell: &cell,
            state: cell.rest(),
            pressure: 0.0,
            blocked,
            step: STEP * modulus,
            limit: None,
        };
        let (mut free, mut blocked) = (path(false), path(true));
        let small = SMALL * modulus;
        let unstable = || Error::Equilibrium {
            factor: 0.0,
            iterations: 0,
        };
        let linear = free.reach(small).ok_or_else(unstable)?;
        let held = blocked.reach(small).ok_or_else(unstable)?;
        let at = |&pressure: &f64| {
            let (bent, held_at) = (free.reach(pressure), blocked.reach(pressure));
            let growth = |of: Option<f64>, small_one: f64| of.map(|of| of / small_one * small / pressure);
            Growth {
                pressure_pa: pressure,
                curvature: growth(bent.as_ref().map(|at| at.strain[1]), linear.strain[1]),
                area: growth(bent.as_ref().map(|at| at.areas_m2[0]), linear.areas_m2[0]),
                moment: growth(held_at.map(|at| at.resultants[1]), held.resultants[1]),
            }
        };
        let growths = pressures.iter().map(at).collect();
        Ok(Some(Inflation {
            growths,
            limit_pa: free.limit,
            blocked_limit_pa: blocked.limit,
        }))
    }
}
