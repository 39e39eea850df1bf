//! Mirror symmetry of a scene.

use super::EffectScene;
use crate::case::schema::BladderEnd;
use crate::model::network::{Link, NetworkNode};

impl EffectScene<'_> {
    /// True if upper and lower row are mirror images, with tubes, ports and start.
    pub fn mirrored(&self) -> bool {
        let Some(wet) = self.wet.filter(|wet| wet.per_row > 0) else {
            return true;
        };
        let network = &wet.network;
        let plain = network.junctions.is_empty() && network.bridges.is_empty() && network.sources.is_empty();
        let oriented = |link: &Link| link.check_valve.is_some() || link.pump.is_some();
        let plain = plain && !network.links.iter().any(oriented);
        let quiet_start = self.case.start.pressures.is_empty();
        let other = |bladder: usize| (bladder + wet.per_row) % (2 * wet.per_row);
        // key of a link that ignores the order of its two nodes
        let seen = |link: &Link, mirror: bool| {
            let end = |node: NetworkNode| match node {
                NetworkNode::Cell { bladder, end } => {
                    let bladder = if mirror { other(bladder) } else { bladder };
                    (0, bladder, usize::from(end == BladderEnd::Outlet), 0)
                }
                NetworkNode::Junction(j) => (1, j, 0, 0),
                NetworkNode::Port(p) => {
                    let signal = &network.ports[p].pressure;
                    let constant = if signal.is_constant() {
                        signal.value(0.0).to_bits()
                    } else {
                        u64::MAX
                    };
                    (2, 0, 0, constant)
                }
            };
            let mut ends = [end(link.from), end(link.to)];
            ends.sort_unstable();
            (ends, link.resistance.to_bits())
        };
        let sorted = |mirror: bool| {
            let mut all: Vec<_> = network.links.iter().map(|link| seen(link, mirror)).collect();
            all.sort_unstable();
            all
        };
        let steady = network.ports.iter().all(|p| p.pressure.is_constant());
        let fixed = network
            .links
            .iter()
            .all(|link| link.opening.is_none() && link.pilot.is_none());
        let equal = (0..wet.per_row).all(|j| {
            let [upper, lower] = wet.areas_of(j);
            let [above, below] = wet.pair(j).map(|bladder| wet.has(bladder));
            upper == lower && above == below
        });
        let centred = self.section.offset == 0.0;
        plain && equal && centred && quiet_start && steady && fixed && sorted(false) == sorted(true)
    }
}
