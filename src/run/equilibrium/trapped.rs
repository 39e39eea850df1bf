//! Fluid behind valves that shut before the instant of the loads: how much is there depends on the loads under which they shut.

use super::Options;
use crate::case::schema::{BladderEnd, Case};
use crate::error::{Code, Error, Result};
use crate::functions::{Clock, Signal};
use crate::model::network::{Network, Node};
use crate::numerics::sets::Sets;

/// Opening at or below which a valve that moves counts as shut: what leaks through it takes longer than anything that is simulated.
pub(super) const TIGHT: f64 = 1e-9;
/// Instants at which an opening is looked at between two of its breaks, at least and at most, and in its shortest time.
const LOOKS: [f64; 3] = [32.0, 4096.0, 16.0];
/// Part of a piece between two breaks, next to one of these, in which an opening is as good as shut.
const END: f64 = 1e-3;
/// Stages that are added, at most.
const MOST: usize = 200;

impl Options {
    /// With the stages that the valves of a case ask for: where one shuts off before the instant of the loads what was open before, the
    /// path goes first to the loads of the instant at which it shuts, with valves as they stand until then. Back from there it begins with
    /// the last state that owes nothing to the time before. Stages that are asked for ([`Options::via_s`]) stay as they are.
    ///
    /// # Errors
    /// [`Error::Usage`]: valves that shut too often; a network that cannot be told.
    pub fn resolved(&self, case: &Case) -> Result<Self> {
        let mut resolved = self.clone();
        if !self.via_s.is_empty() {
            return Ok(resolved);
        }
        let Some(history) = History::of(case, self.at_s)? else {
            return Ok(resolved);
        };
        let stages = history.stages();
        if stages.len() > MOST {
            return Err(Error::Usage(format!(
                "valves shut off fluid {} times before t = {} s, and what is behind them then owes to all of these: more than the {MOST} stages that \
                 an equilibrium goes through; `slcbeam run` follows it",
                stages.len(),
                self.at_s
            )));
        }
        (resolved.via_s, resolved.valves_s) = stages.iter().map(|span| (span.to, span.inside)).unzip();
        Ok(resolved)
    }
}

/// What is said of an equilibrium behind valves that have shut before.
///
/// # Errors
/// As [`Options::resolved`].
pub fn warning(case: &Case, options: &Options) -> Result<Option<String>> {
    if options.via_s.is_empty() != options.valves_s.is_empty() {
        return Ok(None);
    }
    let history = History::of(case, options.at_s)?;
    let shut: Vec<String> = history.iter().flat_map(|history| history.shut(case)).collect();
    Ok((!shut.is_empty()).then(|| {
        Code::Trapped.warning(format!(
            "fluid is kept behind {}, as much as rests there under the loads of that instant: where it was still flowing then, only a run tells \
             how much there is",
            shut.join(", ")
        ))
    }))
}

/// A valve between two places of the graph.
struct Valve {
    opening: Signal,
    ends: [usize; 2],
}

/// A span of time in which no valve opens or shuts.
#[derive(Clone, Debug)]
struct Span {
    /// When it ends [s].
    to: f64,
    /// An instant inside [s].
    inside: f64,
    /// Which valves are open.
    open: Vec<bool>,
}

/// How the parts of a network were joined, from the start to an instant.
struct History {
    valves: Vec<Valve>,
    /// Places that nothing parts: pairs.
    joined: Vec<[usize; 2]>,
    /// Bladders, junctions, then one place for every prescribed pressure.
    places: usize,
    /// Places that store fluid.
    stores: Vec<usize>,
    spans: Vec<Span>,
}

impl History {
    /// None where no valve moves.
    fn of(case: &Case, at_s: f64) -> Result<Option<Self>> {
        let written = case.network.iter();
        let tubes = written.clone().flat_map(|n| n.tubes.iter().map(|tube| &tube.opening));
        let mut openings = written
            .flat_map(|n| n.chains.iter().map(|chain| &chain.opening))
            .chain(tubes);
        // a run that starts in equilibrium has a past
        let begin = case.start.equilibrium.as_ref().map_or(0.0, |start| start.loads_at_s);
        let begin = begin.min(0.0);
        if at_s <= begin || openings.all(Signal::is_constant) {
            return Ok(None);
        }
        let Some(network) = Network::of(case)? else {
            return Ok(None);
        };
        let bladders = network.component_of_bladder.len();
        let given = bladders + network.junctions.len();
        let place = |node: Node| match node {
            Node::Cell { bladder, end } => {
                let (BladderEnd::Inlet | BladderEnd::Outlet) = end;
                bladder
            }
            Node::Junction(junction) => bladders + junction,
            Node::Port(_) => given,
        };
        let mut joined: Vec<[usize; 2]> = network.bridges.iter().map(|b| [place(b.from), place(b.to)]).collect();
        let mut valves = vec![];
        for link in &network.links {
            let ends = [place(link.from), place(link.to)];
            match &link.opening {
                None => joined.push(ends),
                Some(opening) => valves.push(Valve {
                    opening: opening.clone(),
                    ends,
                }),
            }
        }
        let vessels = network.accumulators.iter().map(|one| bladders + one.junction);
        let stores = (0..bladders).chain(vessels).collect();
        let spans = spans(&valves, begin, at_s);
        Ok(Some(Self {
            valves,
            joined,
            places: given + 1,
            stores,
            spans,
        }))
    }

    /// The spans whose last states the path goes through, in order.
    fn stages(&self) -> &[Span] {
        let last = self.spans.len() - 1;
        let mut first = last;
        while first > 0 && self.owes(first).next().is_some() {
            first -= 1;
        }
        &self.spans[first..last]
    }

    /// Valves that are shut in a span, were open before, and part fluid then that no prescribed pressure reaches from other fluid; with the span in which each
    /// was open last.
    fn owes(&self, span: usize) -> impl Iterator<Item = (&Valve, &Span)> {
        let now = &self.spans[span];
        let mut sets = Sets::new(self.places);
        self.joined.iter().for_each(|[a, b]| sets.join(*a, *b));
        for (valve, _) in self.valves.iter().zip(&now.open).filter(|(_, open)| **open) {
            sets.join(valve.ends[0], valve.ends[1]);
        }
        let roots: Vec<usize> = (0..self.places).map(|place| sets.root(place)).collect();
        let given = roots[self.places - 1];
        let kept: Vec<usize> = self.stores.iter().map(|store| roots[*store]).collect();
        let parts = move |valve: &Valve| {
            let [a, b] = valve.ends.map(|end| roots[end]);
            a != b && [a, b].iter().any(|side| *side != given && kept.contains(side))
        };
        let shut = self.valves.iter().enumerate().filter(move |(k, _)| !now.open[*k]);
        shut.filter_map(move |(k, valve)| {
            let before = self.spans[..span].iter().rfind(|before| before.open[k])?;
            parts(valve).then_some((valve, before))
        })
    }

    /// The valves behind which fluid is kept in the end, as the case has them, with the instant at which each shut.
    fn shut(&self, case: &Case) -> Vec<String> {
        let mut all: Vec<String> = self
            .owes(self.spans.len() - 1)
            .map(|(valve, before)| {
                format!(
                    "{}, shut since t = {} s",
                    pointer(case, &valve.opening),
                    short(before.to)
                )
            })
            .collect();
        all.dedup();
        all
    }
}

/// Where the case has an opening.
fn pointer(case: &Case, opening: &Signal) -> String {
    let Some(network) = &case.network else {
        return "a valve".into();
    };
    let tube = network.tubes.iter().position(|tube| tube.opening == *opening);
    let chain = || network.chains.iter().position(|chain| chain.opening == *opening);
    tube.map(|k| format!("/network/tubes/{k}/opening"))
        .or_else(|| chain().map(|k| format!("/network/chains/{k}/opening")))
        .unwrap_or_else(|| "a valve".into())
}

/// Six digits.
fn short(t: f64) -> f64 {
    format!("{t:.5e}").parse().unwrap_or(t)
}

/// The spans between the switching of valves, and the instant at the end as the last of them.
fn spans(valves: &[Valve], begin: f64, end: f64) -> Vec<Span> {
    let mut times: Vec<f64> = valves
        .iter()
        .flat_map(|valve| switches(&valve.opening, begin, end))
        .collect();
    times.push(end);
    times.sort_by(f64::total_cmp);
    times.dedup();
    let open = |t: f64| valves.iter().map(|valve| is_open(&valve.opening, t, t)).collect();
    let mut spans: Vec<Span> = vec![];
    let mut from = begin;
    for to in times {
        let inside = 0.5 * (from + to);
        if inside > from && inside < to {
            let open = open(inside);
            spans.push(Span { to, inside, open });
        }
        from = to;
    }
    let last = open(end);
    // the last instant belongs to the span before where nothing switches in it
    spans.pop_if(|span| span.open == last);
    spans.push(Span {
        to: end,
        inside: end,
        open: last,
    });
    spans
}

fn is_open(opening: &Signal, t: f64, within: f64) -> bool {
    let value = opening.jet(Clock { t, within }).value;
    value > if opening.is_constant() { 0.0 } else { TIGHT }
}

/// When a valve opens or shuts, between two instants.
fn switches(opening: &Signal, begin: f64, end: f64) -> Vec<f64> {
    if opening.is_constant() {
        return vec![];
    }
    let mut breaks = vec![begin, end];
    opening.breaks(&mut breaks);
    breaks.retain(|t| (begin..=end).contains(t));
    breaks.sort_by(f64::total_cmp);
    breaks.dedup();
    let [least, most, each] = LOOKS;
    let mut found = vec![];
    let mut before = None;
    for piece in breaks.windows(2) {
        let [from, to] = [piece[0], piece[1]];
        let middle = 0.5 * (from + to);
        let stands = |t: f64| is_open(opening, t, middle);
        let times = opening.fastest_period_s().map_or(0.0, |period| (to - from) / period);
        let looks = (each * times).clamp(least, most).ceil();
        let at = |k: f64| from + (to - from) * k / looks;
        if before.is_some_and(|before| before != stands(from)) {
            found.push(from);
        }
        let mut k = 0.0;
        while k < looks {
            let (mut low, mut high) = (at(k), at(k + 1.0).min(to));
            let first = stands(low);
            if first != stands(high) {
                // halved down to neighbours
                loop {
                    let half = 0.5 * (low + high);
                    if half <= low || half >= high {
                        break;
                    }
                    *(if stands(half) == first { &mut low } else { &mut high }) = half;
                }
                // the end of a smooth ramp, of which the rest is shut too
                let near = END * (to - from);
                found.push(match first {
                    true if to - high < near && !stands(to) => to,
                    false if high - from < near && !stands(from) => from,
                    _ => high,
                });
            }
            k += 1.0;
        }
        before = Some(stands(to));
    }
    found
}
