//! What creeping flow in tubes leaves out, in numbers.

use super::Scene;
use crate::model::Wet;
use crate::model::network::Link;

/// The largest of all tubes; none where there are no tubes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tubes {
    /// `ω I/R`: inertia over resistance.
    pub inertia: f64,
    /// `Wo⁴/1152`, `Wo² = ω r²/ν`: error that Poiseuille's profile makes of the impedance, to first order (Womersley 1955).
    pub memory: f64,
    /// `Δp_loss(q)/(R q)`, at the largest flow that is expected.
    pub losses: f64,
}

/// Margin of flows: resonance and what comes at once make them larger than what acts at rest.
const MARGIN: f64 = 3.0;

impl Scene<'_> {
    /// What tubes do at the fastest motion, and the fastest relaxation of a bladder into one where that is excited; by tolerance since
    /// vibrations below it do not count.
    pub fn tubes(&self, tolerance: f64) -> Tubes {
        *self.tubes.get_or_init(|| {
            let Some(wet) = self.wet else { return Tubes::default() };
            let fastest = self.fastest(wet, tolerance);
            let all = wet
                .network
                .links
                .iter()
                .map(|link| self.of(wet, link, fastest, tolerance));
            all.fold(Tubes::default(), Tubes::larger)
        })
    }

    fn of(&self, wet: &Wet, link: &Link, fastest: f64, tolerance: f64) -> Tubes {
        let Some(tube) = &link.tube else {
            return Tubes::default();
        };
        let compliance = wet.area.per_pressure * wet.bladder_length;
        let relaxation = 1.0 / (link.resistance * compliance);
        let rate = if self.inertia_ratio(relaxation) > tolerance {
            fastest.max(relaxation)
        } else {
            fastest
        };
        let flow = self.largest_flow(wet, link, rate * compliance);
        let womersley_squared = rate / tube.viscous_rate;
        Tubes {
            inertia: rate * tube.steady_inertance() / link.resistance,
            memory: womersley_squared * womersley_squared / 1152.0,
            losses: tube.loss(flow) / (link.resistance * flow).max(f64::MIN_POSITIVE),
        }
    }

    /// In a tube, at most [m^3/s]: what the largest pressure drives through it, or what all bladders give up at the fastest rate (C ω a
    /// bladder, [m^3/(s Pa)]), if that is less; with it what is pumped.
    fn largest_flow(&self, wet: &Wet, link: &Link, given_up: f64) -> f64 {
        let bladders = 2.0 * wet.per_row as f64;
        let end = self.case.time.end_s;
        let pumped: f64 = wet
            .network
            .sources
            .iter()
            .map(|source| source.flow.largest(end).value)
            .sum();
        MARGIN * self.scales.pressure * (1.0 / link.resistance).min(bladders * given_up) + pumped
    }
}

impl Tubes {
    fn larger(self, other: Self) -> Self {
        // NaN, where something is unknown, stays
        let larger = |a: f64, b: f64| if b > a || b.is_nan() { b } else { a };
        Self {
            inertia: larger(self.inertia, other.inertia),
            memory: larger(self.memory, other.memory),
            losses: larger(self.losses, other.losses),
        }
    }
}
