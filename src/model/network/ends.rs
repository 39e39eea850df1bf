//! Ends of tubes with inertia where only the compressed fluid of the tubes stores, and vessels.

use super::{AccumulatorLaw, Link, NetworkNode, ResolvedNetwork};

/// A vessel, or a group of junctions connected only by tubes with inertia.
#[derive(Clone, Debug, PartialEq)]
pub struct TubeEnd {
    /// Its junctions.
    pub junctions: Vec<usize>,
    /// Volume of the halves of tubes with inertia that end here [m^3].
    pub in_tubes: f64,
    /// Largest inertance of these tubes [kg/m^4]; 0 without one.
    pub inertance: f64,
    /// True if a check valve may shut one of them.
    pub check_valve: bool,
    /// Law of the vessel; none for a group of junctions.
    pub vessel: Option<AccumulatorLaw>,
}

impl ResolvedNetwork {
    /// Returns all tube ends.
    pub fn tube_ends(&self) -> Vec<TubeEnd> {
        let groups = self.adrift().into_iter().map(|group| (group, None));
        let vessels = self
            .accumulators
            .iter()
            .map(|one| (vec![one.junction], Some(one.law.clone())));
        let end = |(junctions, vessel): (Vec<usize>, _)| {
            let links = || junctions.iter().flat_map(|&junction| self.tubes_at(junction));
            TubeEnd {
                in_tubes: junctions.iter().map(|&junction| self.halves_of_tubes(junction)).sum(),
                inertance: links().map(Link::inertance).fold(0.0, f64::max),
                check_valve: links().any(|link| link.check_valve.is_some()),
                vessel,
                junctions,
            }
        };
        groups.chain(vessels).map(end).collect()
    }

    /// Tubes with inertia that end at a junction, including shut ones.
    pub fn tubes_at(&self, junction: usize) -> impl Iterator<Item = &Link> {
        let here = NetworkNode::Junction(junction);
        self.links
            .iter()
            .filter(move |link| link.inertance() > 0.0 && (link.from == here || link.to == here))
    }

    /// `[E65]` Volume of the halves of all tubes with inertia that end at a junction, including shut ones [m^3].
    /// Compressed fluid is stored there: either alone, so that its content determines the pressure, or in parallel to
    /// the walls of a vessel.
    pub fn halves_of_tubes(&self, junction: usize) -> f64 {
        let here = NetworkNode::Junction(junction);
        let volume = |link: &Link| {
            let ends = usize::from(link.from == here) + usize::from(link.to == here);
            0.5 * ends as f64 * link.tube.map_or(0.0, |tube| tube.volume)
        };
        self.tubes_at(junction).map(volume).sum()
    }
}
