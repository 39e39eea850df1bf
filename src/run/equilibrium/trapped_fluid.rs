//! Fluid trapped behind valves that closed before the instant of the loads. Its volume depends on the loads at their closure.

use super::EquilibriumOptions;
use crate::case::schema::{BladderEnd, Case, EquilibriumStart};
use crate::error::numbers::rounded;
use crate::error::{Code, Error, Result};
use crate::functions::{Signal, SmoothTime};
use crate::model::network::{NetworkNode, ResolvedNetwork};
use crate::numerics::sets::Sets;

/// Opening at or below which a moving valve counts as closed: leakage through it takes longer than any simulation.
pub const TIGHT: f64 = 1e-9;
/// Samples of an opening between two of its breaks: least and largest number, and number in each of its shortest periods.
const LOOKS: [f64; 3] = [32.0, 4096.0, 16.0];
/// Fraction of a piece between two breaks, next to a break, in which an opening counts as closed.
const END: f64 = 1e-3;
/// Largest number of added stages.
const MOST: usize = 200;

impl EquilibriumOptions {
    /// Adds the stages that the valves of a case require. If a valve closes and traps fluid before the instant of the loads, the path
    /// first leads to the loads at its closure, with the openings before. It begins with the last state that does not depend on
    /// earlier ones. Requested stages ([`Options::via_s`]) remain unchanged.
    ///
    /// # Errors
    /// [`Error::Usage`] if valves close too often, or if the network is not valid.
    pub fn resolved(&self, case: &Case) -> Result<Self> {
        let mut resolved = self.clone();
        if !self.via_s.is_empty() || self.follows_valves() {
            return Ok(resolved);
        }
        let Some(history) = History::simulate(case, self.at_s)? else {
            return Ok(resolved);
        };
        let stages = history.stages();
        few(stages, self.at_s)?;
        (resolved.via_s, resolved.valves_s) = stages.iter().map(|span| (span.to, span.inside)).unzip();
        Ok(resolved)
    }
}

/// Fluid trapped behind valves that are closed in the long run.
pub struct TrappedFluid {
    /// Options of the path to the state in which the last of them closed.
    pub options: EquilibriumOptions,
    /// Warning about the trapped fluid.
    pub warning: String,
}

/// Fluid trapped in a case before an instant [s], once each valve has its long-run opening (`settled`); `None` if there is none.
///
/// # Errors
/// As [`Options::resolved`].
pub fn kept(case: &Case, at_s: f64, settled: &dyn Fn(&Signal) -> Signal) -> Result<Option<TrappedFluid>> {
    let Some(mut history) = History::simulate(case, at_s)? else {
        return Ok(None);
    };
    let lasting = history.valves.iter().map(|valve| match settled(&valve.opening) {
        rests if rests.is_constant() => rests.value(0.0) > least(&valve.opening),
        _ => true,
    });
    let open: Vec<bool> = lasting.collect();
    history.spans.pop_if(|span| span.open == open);
    history.spans.push(Span {
        to: at_s,
        inside: at_s,
        open,
        of_start: false,
    });
    let last = history.spans.len() - 1;
    let instants = history.owes(last).map(|(_, before)| before.to);
    let Some(shut) = instants.reduce(f64::max) else {
        return Ok(None);
    };
    let Some(end) = history.spans[..last].iter().position(|span| span.to == shut) else {
        return Ok(None);
    };
    let stages = &history.spans[history.first(end)..=end];
    few(stages, at_s)?;
    let mut via_s: Vec<f64> = stages.iter().map(|span| span.to).collect();
    via_s.pop();
    Ok(Some(TrappedFluid {
        options: EquilibriumOptions {
            via_s,
            valves_s: stages.iter().map(|span| span.inside).collect(),
            ..EquilibriumOptions::at(shut)
        },
        warning: history.describe(case).unwrap_or_default(),
    }))
}

fn few(stages: &[Span], at_s: f64) -> Result<()> {
    match stages.len() {
        0..=MOST => Ok(()),
        count => Err(Error::Usage(format!(
            "valves shut off fluid {count} times before t = {at_s} s (limit {MOST} stages of an equilibrium). The \
             trapped volumes depend on all of these closures. Use `slcbeam run`"
        ))),
    }
}

/// Warning about an equilibrium with fluid trapped behind valves that closed before.
///
/// # Errors
/// As [`Options::resolved`].
pub fn warning(case: &Case, options: &EquilibriumOptions) -> Result<Option<String>> {
    if options.via_s.is_empty() != options.valves_s.is_empty() {
        return Ok(None);
    }
    let history = History::simulate(case, options.at_s)?;
    Ok(history.and_then(|history| history.describe(case)))
}

/// A valve between two places of the network graph.
struct Valve {
    opening: Signal,
    ends: [usize; 2],
}

/// A span of time in which no valve opens or closes.
#[derive(Clone, Debug)]
struct Span {
    /// End [s].
    to: f64,
    /// An instant inside [s].
    inside: f64,
    /// True for each open valve.
    open: Vec<bool>,
    /// True if it is a state of the path to the start of a run.
    of_start: bool,
}

/// Connections of a network's parts, from the start to an instant.
struct History {
    valves: Vec<Valve>,
    /// Pairs of places that are always connected.
    joined: Vec<[usize; 2]>,
    /// Number of places: bladders, junctions, and one place for all prescribed pressures.
    places: usize,
    /// Places that store fluid.
    stores: Vec<usize>,
    spans: Vec<Span>,
}

impl History {
    /// History of the valves; `None` if no valve moves.
    fn simulate(case: &Case, at_s: f64) -> Result<Option<Self>> {
        let written = case.network.iter();
        let tubes = written.clone().flat_map(|n| n.tubes.iter().map(|tube| &tube.opening));
        let mut openings = written
            .flat_map(|n| n.chains.iter().map(|chain| &chain.opening))
            .chain(tubes);
        if openings.all(Signal::is_constant) {
            return Ok(None);
        }
        // a start in equilibrium has a past: the loads of its state and of earlier stages, but no instants between
        let start = case.start.equilibrium.as_ref();
        let past = start.filter(|start| at_s >= 0.0 || at_s == start.loads_at_s);
        let begin = match past {
            Some(_) => 0.0,
            None => start.map_or(0.0, |start| start.loads_at_s).min(0.0),
        };
        if at_s <= begin && past.is_none() {
            return Ok(None);
        }
        let Some(network) = ResolvedNetwork::from_case(case)? else {
            return Ok(None);
        };
        let bladders = network.component_of_bladder.len();
        let given = bladders + network.junctions.len();
        let place = |node: NetworkNode| match node {
            NetworkNode::Cell { bladder, end } => {
                let (BladderEnd::Inlet | BladderEnd::Outlet) = end;
                bladder
            }
            NetworkNode::Junction(junction) => bladders + junction,
            NetworkNode::Port(_) => given,
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
        let mut all: Vec<Span> = past.map_or(vec![], |start| of_start(&valves, start, at_s));
        all.extend(spans(&valves, begin, at_s));
        Ok(Some(Self {
            valves,
            joined,
            places: given + 1,
            stores,
            spans: all,
        }))
    }

    /// Spans whose last states the path passes, in order.
    fn stages(&self) -> &[Span] {
        let last = self.spans.len() - 1;
        &self.spans[self.first(last)..last]
    }

    /// Last span, up to `of`, that does not depend on earlier ones.
    fn first(&self, of: usize) -> usize {
        let mut first = of;
        while first > 0 && self.owes(first).next().is_some() {
            first -= 1;
        }
        first
    }

    /// Valves that are closed in a span, but were open before, and that separate fluid without prescribed pressure from other fluid.
    /// Each has the span in which it was last open.
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

    /// Describes the valves that trap fluid at the end, with their JSON pointers and times of closure; `None` without such valves.
    fn describe(&self, case: &Case) -> Option<String> {
        let (mut shut, mut flows) = (vec![], false);
        for (valve, before) in self.owes(self.spans.len() - 1) {
            let (place, t) = (pointer(case, &valve.opening), rounded(before.to, 6));
            flows |= !before.of_start;
            let one = match before.of_start {
                true => format!("{place} (open in the start equilibrium under the loads at t = {t} s, and shut since)"),
                false => format!("{place} (shut since t = {t} s)"),
            };
            if !shut.contains(&one) {
                shut.push(one);
            }
        }
        let still = if flows {
            " If fluid was still flowing then, only `slcbeam run` computes the trapped volume."
        } else {
            ""
        };
        (!shut.is_empty()).then(|| {
            Code::Trapped.warning(format!(
                "fluid is trapped behind {}: its volume is that of the equilibrium under the loads of that \
                 instant.{still}",
                shut.join(", ")
            ))
        })
    }
}

/// JSON pointer of an opening in the case.
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

/// States on the path to the start of a run, including the start if it is not the requested state.
fn of_start(valves: &[Valve], start: &EquilibriumStart, at_s: f64) -> Vec<Span> {
    let own = (at_s > 0.0 || at_s != start.loads_at_s).then_some(start.loads_at_s);
    let of = |t: f64| Span {
        to: t,
        inside: t,
        open: valves.iter().map(|valve| is_open(&valve.opening, t, t)).collect(),
        of_start: true,
    };
    start.via_s.iter().copied().chain(own).map(of).collect()
}

/// Spans between the switching times of valves; the last one is the final instant.
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
            spans.push(Span {
                to,
                inside,
                open,
                of_start: false,
            });
        }
        from = to;
    }
    let last = open(end);
    // the final instant belongs to the span before if nothing switches there
    spans.pop_if(|span| span.open == last);
    spans.push(Span {
        to: end,
        inside: end,
        open: last,
        of_start: false,
    });
    spans
}

fn is_open(opening: &Signal, t: f64, within: f64) -> bool {
    opening.jet(SmoothTime { t, within }).value > least(opening)
}

/// Largest opening at which a valve counts as closed.
fn least(opening: &Signal) -> f64 {
    if opening.is_constant() { 0.0 } else { TIGHT }
}

/// Times at which a valve opens or closes, between two instants.
fn switches(opening: &Signal, begin: f64, end: f64) -> Vec<f64> {
    if opening.is_constant() {
        return vec![];
    }
    let mut breaks = vec![begin, end];
    opening.breaks(end, &mut breaks);
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
                // bisected down to adjacent numbers
                loop {
                    let half = 0.5 * (low + high);
                    if half <= low || half >= high {
                        break;
                    }
                    *(if stands(half) == first { &mut low } else { &mut high }) = half;
                }
                // the end of a smooth ramp whose remainder counts as closed
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
