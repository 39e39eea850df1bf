//! Compressible fluid: gas, elastic liquid, or liquid with free gas.

use crate::case::schema::Fluid;
use crate::model::AreaLaw;
use crate::model::network::AccumulatorLaw;
use crate::numerics::Scalar;
use crate::numerics::gauss::Gauss;

/// Lowest absolute pressure over ambient pressure.
const VACUUM: f64 = 1e-9;
/// Quadrature points of Ψ for mixtures, which have no closed form.
const POINTS: usize = 16;
/// Relative density difference between two ends below which the mean is that at the mean pressure. The error is 1/24 of
/// its square.
const ALIKE: f64 = 1e-4;

/// `[E54]` Fluid with density as a function of pressure. p is the pressure above ambient, `P_0` the ambient pressure, x
/// the gas fraction of the volume at ambient pressure. K is the bulk modulus of the liquid, n the polytropic exponent
/// of the gas:
///
/// ```text
/// ρ = ρ_0 r(p)      1/r = (1 - x) e^(-p/K) + x (1 + p/P_0)^(-1/n)      gas: x = 1
/// c = r(p) (A_0 + a1) - A_0      a1 = a_p p + R A_M + A_N
/// ```
///
/// The state of a bladder cell is its content c: the area change of its fluid at ambient density. The pressure is the
/// unique root of `r(p) (A_0 + R A_M + A_N + a_p p) = A_0 + c`, a quadratic equation for isothermal gas. Incompressible
/// fluid has r = 1, c = a1.
#[derive(Clone, Debug)]
pub struct Compression {
    /// `x`.
    gas: f64,
    /// `1/K` [1/Pa].
    softness: f64,
    /// `P_0` [Pa].
    ambient: f64,
    /// `n`.
    exponent: f64,
    /// Quadrature of Ψ for mixtures.
    points: Option<Gauss>,
}

impl Compression {
    /// Compression of a fluid; none for incompressible fluid.
    pub fn new(fluid: &Fluid) -> Option<Self> {
        let softness = fluid.bulk_modulus_pa.map_or(0.0, f64::recip);
        let gas = fluid.gas();
        (gas > 0.0 || softness > 0.0).then(|| Self {
            gas,
            softness,
            ambient: fluid.ambient_pressure(),
            exponent: fluid.polytropic_exponent.unwrap_or(1.0),
            points: (gas > 0.0 && gas < 1.0).then(|| Gauss::new(POINTS)),
        })
    }

    /// Lowest pressure relative to ambient [Pa]; minus infinity for pure liquid.
    pub fn lowest(&self) -> f64 {
        match self.gas > 0.0 {
            true => self.ambient * (VACUUM - 1.0),
            false => f64::NEG_INFINITY,
        }
    }

    /// `ln(1 + p/P_0)`, 0 without gas.
    fn logarithm(&self, p: f64) -> f64 {
        match self.gas > 0.0 {
            true => (p / self.ambient).ln_1p(),
            false => 0.0,
        }
    }

    /// `1/r - 1` and its derivative [1/Pa].
    fn expansion(&self, p: f64) -> (f64, f64) {
        let liquid = (-p * self.softness).exp_m1();
        let gas = (-self.logarithm(p) / self.exponent).exp_m1();
        let slope = match self.gas > 0.0 {
            true => self.gas * (gas + 1.0) / (self.exponent * (self.ambient + p)),
            false => 0.0,
        };
        let rest = 1.0 - self.gas;
        (
            rest * liquid + self.gas * gas,
            -rest * self.softness * (liquid + 1.0) - slope,
        )
    }

    /// `r` and its derivative [1/Pa].
    pub fn density(&self, p: f64) -> (f64, f64) {
        let (expansion, slope) = self.expansion(p.max(self.lowest()));
        let density = 1.0 / (1.0 + expansion);
        (density, -slope * density * density)
    }

    /// Mean density between two ends of a duct over that at ambient pressure, [E64]: `r̄² = (Ψ_a - Ψ_b)/(h_a - h_b)`.
    #[inline]
    pub fn mean_density<T: Scalar>(&self, a: T, b: T) -> T {
        a.lift_with(b, |a, b| self.mean(a, b))
    }

    fn mean(&self, a: f64, b: f64) -> (f64, [f64; 2]) {
        let [a, b] = [a, b].map(|p| p.max(self.lowest()));
        let (density, slope) = self.density(0.5 * (a + b));
        if ((a - b) * slope).abs() <= ALIKE * density {
            return (density, [0.5 * slope; 2]);
        }
        let potential = self.integral(a) - self.integral(b);
        let enthalpy = self.enthalpy(a) - self.enthalpy(b);
        let mean = (potential / enthalpy).sqrt();
        let slope = |p: f64| {
            let (density, _) = self.density(p);
            0.5 * mean * (density / potential - 1.0 / (density * enthalpy))
        };
        (mean, [slope(a), -slope(b)])
    }

    /// `h` at a pressure as a scalar with derivatives, see [`Self::enthalpy`].
    #[inline]
    pub fn brought<T: Scalar>(&self, p: T) -> T {
        p.lift(|p| (self.enthalpy(p), 1.0 / self.density(p).0))
    }

    /// `h = ∫ dp/r` from ambient pressure [Pa]: energy carried per volume at ambient density.
    pub fn enthalpy(&self, p: f64) -> f64 {
        let p = p.max(self.lowest());
        let liquid = match self.softness {
            0.0 => p,
            softness => -(-p * softness).exp_m1() / softness,
        };
        if self.gas == 0.0 {
            return liquid;
        }
        let power = 1.0 - 1.0 / self.exponent;
        let gas = self.ambient * exponential(power, self.logarithm(p));
        (1.0 - self.gas) * liquid + self.gas * gas
    }

    /// `[E55]` `Ψ = ∫ r dp` from ambient pressure [Pa]. Its differences drive the flow, measured at ambient density.
    /// Along a duct of resistance R at ambient density, `dΨ = r dp = -q dR`. Series resistances thus add as for
    /// incompressible fluid:
    ///
    /// ```text
    /// q = g (Ψ(p_a) - Ψ(p_b))      isothermal gas: Ψ = p + p²/(2 P_0),   q ρ_0 = π r⁴/(16 μ l) (P_a² - P_b²)/(R_s T)
    /// ```
    ///
    /// Ducts with creeping flow store no fluid.
    #[inline]
    pub fn potential<T: Scalar>(&self, p: T) -> T {
        p.lift(|p| {
            let within = p.max(self.lowest());
            let (density, _) = self.density(within);
            (self.integral(within) + density * (p - within), density)
        })
    }

    fn integral(&self, p: f64) -> f64 {
        if self.gas == 0.0 {
            return exponential(self.softness, p);
        }
        let logarithm = self.logarithm(p);
        match &self.points {
            None => self.ambient * exponential(1.0 + 1.0 / self.exponent, logarithm),
            Some(points) => {
                let inner = |t: f64| {
                    let grown = self.ambient * t.exp();
                    grown / (1.0 + self.expansion(grown - self.ambient).0)
                };
                points.on(0.0, logarithm).map(|(t, weight)| weight * inner(t)).sum()
            }
        }
    }

    /// Pressure at a value of Ψ [Pa]. Ψ is convex and not below p.
    pub fn pressure_of_potential(&self, potential: f64) -> f64 {
        let mut p = potential.max(self.lowest());
        for _ in 0..60 {
            let step = (self.potential(p) - potential) / self.density(p).0;
            p -= step;
            if step.abs() <= 1e-10 * p.abs() {
                break;
            }
        }
        p
    }

    /// Pressure at a value of Ψ, with its derivative `1/r`. Ψ is the unknown of a junction: the flows there are linear
    /// in Ψ. In the pressure, their slope would vanish towards vacuum, and Newton's iteration would fail.
    #[inline]
    pub fn at_potential<T: Scalar>(&self, potential: T) -> T {
        potential.lift(|potential| {
            let p = self.pressure_of_potential(potential);
            (p, 1.0 / self.density(p).0)
        })
    }

    /// Pressure of a cell with content `content`, `[E54]`; `imposed` is the area caused by bending and force.
    #[inline]
    pub fn pressure<T: Scalar>(&self, law: &AreaLaw, content: T, imposed: T) -> T {
        content.lift_with(imposed, |content, imposed| self.root(law, content, imposed))
    }

    /// Solves `a_p p - (c - A) - (A_0 + c) (1/r - 1) = 0` for p by Newton's iteration; A is the imposed area. The
    /// function is concave and increasing. The initial guess is the root for isothermal gas of equal compressibility.
    /// Returns the root and its derivatives by c and A.
    fn root(&self, law: &AreaLaw, content: f64, imposed: f64) -> (f64, [f64; 2]) {
        let a_p = law.per_pressure;
        let amount = law.at_rest + content;
        let softness = -self.expansion(0.0).1;
        let (lacking, linear) = (content - imposed, a_p + (law.at_rest + imposed) * softness);
        let inside = linear * linear + 4.0 * a_p * softness * lacking;
        let begin = 2.0 * lacking / (linear + inside.max(0.0).sqrt());
        let found = match self.gas > 0.0 && amount <= 0.0 {
            true => None,
            false => self.filled(amount, begin, |p| (a_p * p - lacking, a_p)),
        };
        match found {
            None => (self.lowest(), [0.0; 2]),
            Some((p, stiffness)) => (p, [(1.0 + self.expansion(p).0) * stiffness, -stiffness]),
        }
    }

    /// Solves `swollen(p) = amount (1/r - 1)` for p; `swollen` is increasing, and linear or concave. Returns p and
    /// `1/d(swollen - amount/r)/dp` there. Returns none in absolute vacuum, or if the amount of fluid is negative.
    fn filled(&self, amount: f64, begin: f64, swollen: impl Fn(f64) -> (f64, f64)) -> Option<(f64, f64)> {
        let lowest = self.lowest();
        let mut p = begin;
        if p <= lowest {
            p = -0.9 * self.ambient;
        }
        for _ in 0..100 {
            let (expansion, slope) = self.expansion(p);
            let (swelling, steep) = swollen(p);
            let stiff = steep - amount * slope;
            if stiff <= 0.0 {
                return None;
            }
            let step = (swelling - amount * expansion) / stiff;
            let next = p - step;
            if next <= lowest {
                p = 0.1 * p - 0.9 * self.ambient;
                if p <= lowest {
                    return None;
                }
                continue;
            }
            p = next;
            if step.abs() <= 1e-10 * p.abs() {
                break;
            }
        }
        Some((p, 1.0 / (swollen(p).1 - amount * self.expansion(p).1)))
    }

    /// Pressure in a vessel as a function of its content beyond that at ambient pressure [m^3], [E67]: the root of
    /// `V(p) - c = (V_0 + c) (1/r - 1)`. A vessel without volume at rest may have a slightly negative content, as with
    /// incompressible fluid.
    pub fn in_vessel<T: Scalar>(&self, law: &AccumulatorLaw, content: T) -> T {
        content.lift(|content| {
            let walls = |p: f64| (law.volume(p) - content, law.compliance(p));
            let at_rest = law.volume_at_rest();
            let emptied = self.gas > 0.0 && at_rest > 0.0 && at_rest + content <= 0.0;
            match (!emptied).then(|| self.filled(at_rest + content, 0.0, walls)).flatten() {
                None => (self.lowest(), 0.0),
                Some((p, stiffness)) => (p, (1.0 + self.expansion(p).0) * stiffness),
            }
        })
    }

    /// Content c of a cell at a pressure and an area change, `[E54]`.
    #[inline]
    pub fn content<T: Scalar>(&self, law: &AreaLaw, p: T, area: T) -> T {
        let density = p.lift(|p| self.density(p));
        density * (area + law.at_rest) - law.at_rest
    }

    /// Rate of a cell's content from the rates of its pressure and area.
    pub fn content_rate(&self, law: &AreaLaw, [p, area]: [f64; 2], p_t: f64, area_t: f64) -> f64 {
        let (density, slope) = self.density(p);
        slope * (law.at_rest + area) * p_t + density * area_t
    }

    /// Rate of a cell's pressure from the rates of its content and of the imposed area.
    pub fn pressure_rate(&self, law: &AreaLaw, [p, area]: [f64; 2], content_t: f64, imposed_t: f64) -> f64 {
        let (density, slope) = self.density(p);
        (content_t - density * imposed_t) / (slope * (law.at_rest + area) + density * law.per_pressure)
    }

    /// `[E56]` Energy of the fluid in a cell per length, relative to ambient pressure:
    ///
    /// ```text
    /// E = V (r h - p)      dE/dt + p dV/dt = h d(r V)/dt      V = (A_0 + a1) Δs
    /// P_port = q h(p_port)      D = q (h(p_a) - h(p_b)) >= 0 along a link
    /// ```
    ///
    /// For isothermal gas, `E = V (P ln(P/P_0) - p)`, P the absolute pressure. Flow carries h; the loss along a link is
    /// the drop of h.
    pub fn energy(&self, law: &AreaLaw, p: f64, area: f64) -> f64 {
        (law.at_rest + area) * (self.density(p).0 * self.enthalpy(p) - p)
    }

    /// Compressibility `r'/r` at a pressure [1/Pa]; times `A_0` it adds to `a_p`.
    pub fn compressibility(&self, p: f64) -> f64 {
        let lowest = if self.gas > 0.0 { -0.9 * self.ambient } else { p };
        let (density, slope) = self.density(p.max(lowest));
        slope / density
    }
}

/// `(e^(k x) - 1)/k`.
fn exponential(k: f64, x: f64) -> f64 {
    match k.abs() < 1e-300 {
        true => x,
        false => (k * x).exp_m1() / k,
    }
}
