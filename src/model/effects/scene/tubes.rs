//! Delay of flow: along bladders by friction and inertia, in tubes by inertia, unsteady friction and losses.

use std::f64::consts::PI;

use super::EffectScene;
use super::free_flow::Circuit;
use crate::case::schema::BladderEnd;
use crate::model::Wet;
use crate::model::network::{Link, LinkKind, NetworkNode};

/// Largest values over all tubes; zero without tubes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tubes {
    /// `ω I/R`: inertia over resistance.
    pub inertia: f64,
    /// `Wo⁴/1152`, `Wo² = ω r²/ν`: first-order error of the impedance with Poiseuille's profile (Womersley 1955).
    pub memory: f64,
    /// `Δp_loss(q)/(R q)` at the largest expected flow.
    pub losses: f64,
}

/// Bound of angular frequencies, for tubes without storage next to them [1/s].
pub(super) const FASTEST: f64 = 1e100;

/// Safety factor for flows: resonance and sudden changes enlarge them.
const MARGIN: f64 = 3.0;

impl EffectScene<'_> {
    /// `τ ω`, with a bladder's time constant `τ = a_p l_b² μ/(π² q1b)` and the highest frequency ω of the drive. A
    /// vibration with the amplitude share i and the fluid's stiffness share χ gives `τ ω (1 + χ i ω T)`: flow along
    /// bladders damps it over the whole run T.
    pub fn lag_along_bladders(&self, tolerance: f64) -> f64 {
        let Some(wet) = self.wet else { return 0.0 };
        let emptying = 1.0
            / ((Self::least_resistance_between(wet) + 0.5 * self.bladder_resistance(wet))
                * (self.compliances(wet)[0] * wet.bladder_length));
        let released = if self.begins_pressed(true) { emptying } else { 0.0 };
        self.fastest(wet, tolerance).max(released) * self.compliances(wet)[1] * wet.bladder_length.powi(2)
            / (PI * PI * wet.network.bladder_mobility)
    }

    /// Inertia of the fluid along bladders over the storage that receives its flow. A bladder fed at one end has
    /// `(ω/ω_s)²`, `ω_s = (π/2)/√(I C)`; I and C are those of its whole length. A row of n bladders in series has at
    /// most n² times that, and at most `ω I/R` of the tubes between them.
    pub fn sloshing(&self, tolerance: f64) -> f64 {
        let Some(wet) = self.wet else { return 0.0 };
        let Some(along) = &wet.network.along_bladders else {
            return 0.0;
        };
        if wet.network.sealed().all(|sealed| sealed) {
            return 0.0;
        }
        let inertance = along.steady_inertance() * wet.bladder_length;
        let compliance = self.compliances(wet)[0] * wet.bladder_length;
        let tightest = Self::least_resistance_between(wet);
        let passed = self.most_in_a_row(wet);
        let of = |rate: f64| {
            let own = (2.0 * rate / PI).powi(2) * inertance * compliance;
            own.max((passed * passed * own).min(rate * inertance / tightest))
        };
        let relaxation = 1.0 / ((tightest + 0.5 * self.bladder_resistance(wet)) * compliance);
        let relaxing = if self.inertia_ratio(relaxation) > tolerance {
            of(relaxation)
        } else {
            0.0
        };
        relaxing.max(self.at_the_fastest(wet, tolerance, of))
    }

    /// `Wo⁴/1152` of bladders times their sloshing number.
    pub fn memory_of_bladders(&self, tolerance: f64) -> f64 {
        let along = self
            .wet
            .and_then(|wet| Some((wet, wet.network.along_bladders.as_ref()?)));
        along.map_or(0.0, |(wet, along)| {
            let womersley_squared = self.fastest(wet, tolerance) / along.viscous_rate;
            womersley_squared * womersley_squared / 1152.0 * self.sloshing(tolerance)
        })
    }

    /// Smallest resistance between bladders [Pa s/m^3].
    fn least_resistance_between(wet: &Wet) -> f64 {
        let between = wet.network.links.iter().filter(|link| link.kind != LinkKind::Opening);
        between.map(|link| link.resistance).fold(f64::INFINITY, f64::min)
    }

    /// Largest number of bladders in series: all bladders of a component in which a bladder is joined at both ends.
    fn most_in_a_row(&self, wet: &Wet) -> f64 {
        let network = &wet.network;
        let mut joined = vec![[false; 2]; network.component_of_bladder.len()];
        let links = network.links.iter().flat_map(|link| [link.from, link.to]);
        for node in links.chain(network.sources.iter().map(|source| source.into)) {
            if let NetworkNode::Cell { bladder, end } = node {
                joined[bladder][usize::from(end == BladderEnd::Outlet)] = true;
            }
        }
        let mut count = vec![0.0; network.components];
        let mut passed = vec![false; network.components];
        for (bladder, &component) in network.component_of_bladder.iter().enumerate() {
            count[component] += 1.0;
            passed[component] |= joined[bladder] == [true; 2];
        }
        let rows = count.into_iter().zip(passed).filter(|(_, passed)| *passed);
        rows.map(|(count, _)| count).fold(0.0, f64::max)
    }

    /// Highest angular frequency of the drive; vibrations count as ω (1 + χ i ω T) [1/s].
    fn fastest(&self, wet: &Wet, tolerance: f64) -> f64 {
        self.at_the_fastest(wet, tolerance, |rate| rate)
    }

    /// Largest value of an increasing function of ω over all motions; that of vibrations is multiplied by (1 + χ i
    /// ω T).
    fn at_the_fastest(&self, wet: &Wet, tolerance: f64, of: impl Fn(f64) -> f64) -> f64 {
        let end = self.case.time.end_s;
        let mut most = 0.0_f64;
        self.signals(|signal| {
            if let Some(period) = signal.shortest_time_s(end) {
                most = most.max(of(2.0 * PI / period));
            }
        });
        let [bent, stretched] = self.stiffness_of_fluid(wet);
        let waves = [
            (self.bending_inertia(), self.at_once(self.bending), bent),
            (self.axial_waves(), self.at_once(self.axial), stretched),
        ];
        for (inertia, free, fluid) in waves {
            if inertia > tolerance {
                most = most.max(of(free) * (1.0 + fluid * inertia * free * end));
            }
        }
        most
    }

    /// Upper bounds of the shares χ of curvature and stretch that the pressure of sealed bladders opposes:
    /// `EI (∂α_p/∂p_u - ∂α_p/∂p_d) A_M'/a_p` and `EA (∂λ_p/∂p_u + ∂λ_p/∂p_d) A_N'/a_p`.
    pub(super) fn stiffness_of_fluid(&self, wet: &Wet) -> [f64; 2] {
        let (area, coupling) = (&wet.area, &wet.coupling);
        // far from the kink on both sides, where slopes are largest
        let steepest = |slope: &dyn Fn(f64) -> f64| slope(1e100).abs().max(slope(-1e100).abs());
        let bent = steepest(&|m| coupling.curvature(area, m, 1.0, -1.0) * area[0].moment_slope(m, 1.0));
        let stretched = steepest(&|n| coupling.stretch(area, n, 1.0, 1.0) * area[0].force_slope(n));
        let stiffness = [self.section.bending_stiffness, self.section.axial_stiffness];
        [
            stiffness[0] * bent / self.compliances(wet)[0],
            stiffness[1] * stretched / self.compliances(wet)[0],
        ]
    }

    /// Numbers of tubes at the highest frequency, which includes the relaxation of a bladder through a tube if it is
    /// excited. Vibrations below the tolerance do not count.
    pub fn tubes(&self, tolerance: f64) -> Tubes {
        *self.tubes.get_or_init(|| {
            let Some(wet) = self.wet else { return Tubes::default() };
            let fastest = self.fastest(wet, tolerance);
            let end = self.case.time.end_s;
            let sources = wet.network.sources.iter();
            let pumped = sources.map(|source| source.feed.largest_flow(end)).sum();
            let circuits = self.circuits(wet);
            let circuit = |link: &Link| {
                let mut ends = [link.from, link.to].into_iter();
                let component = ends.find_map(|node| wet.network.component_of(node));
                component.map_or(Circuit::BETWEEN_PORTS, |component| circuits[component])
            };
            let links = wet.network.links.iter();
            let all = links.map(|link| self.assess_tube(wet, (link, circuit(link)), [fastest, pumped], tolerance));
            all.fold(Tubes::default(), Tubes::larger)
        })
    }

    fn assess_tube(
        &self,
        wet: &Wet,
        (link, circuit): (&Link, Circuit),
        [fastest, pumped]: [f64; 2],
        tolerance: f64,
    ) -> Tubes {
        let Some(tube) = &link.tube else {
            return Tubes::default();
        };
        let resistance = link.resistance;
        let relaxation = 1.0 / (resistance * circuit.least);
        // lowest natural frequency with the storage; changes within its period excite it
        let swing = 1.0 / (tube.steady_inertance() * circuit.most).sqrt();
        let rate = if self.departure_of_flow(relaxation.min(swing).min(FASTEST)) > tolerance {
            fastest.max(relaxation)
        } else {
            fastest
        };
        let bladders = match circuit.through || wet.per_row == 0 {
            true => f64::INFINITY,
            false => 2.0 * wet.per_row as f64 * rate * circuit.least,
        };
        let flow = MARGIN * self.scales.pressure * bladders.min(1.0 / resistance) + pumped;
        let womersley_squared = rate / tube.viscous_rate;
        Tubes {
            inertia: rate * tube.steady_inertance() / resistance,
            memory: womersley_squared * womersley_squared / 1152.0,
            losses: tube.law.loss(flow) / (resistance * flow).max(f64::MIN_POSITIVE),
        }
    }
}

impl Tubes {
    fn larger(self, other: Self) -> Self {
        // NaN marks an unknown value and is kept
        let larger = |a: f64, b: f64| if b > a || b.is_nan() { b } else { a };
        Self {
            inertia: larger(self.inertia, other.inertia),
            memory: larger(self.memory, other.memory),
            losses: larger(self.losses, other.losses),
        }
    }
}
