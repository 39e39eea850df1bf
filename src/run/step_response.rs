//! Step responses: the transition of a value from an initial to a final one.
//!
//! Bands and limits are fractions of the change from the initial to the final value, which is known only at the end. Until then
//! only decisive pieces of the motion are stored: those with values beyond all earlier ones, and beyond all later ones.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::cubic::Cubic;
use super::readings::StepReadings;
use crate::error::numbers::quantity;

/// Fractions of the change between which the rise is timed.
const RISE: [f64; 2] = [0.1, 0.9];
/// Bands about the final value, as fractions of the change.
const BANDS: [f64; 2] = [0.02, 0.05];
/// Fraction of the observed time for which a value must stay in a band to count as settled.
const STAYS: f64 = 0.1;
/// Fraction of the largest excursion below which two values count as equal.
const SAME: f64 = 1e-6;

/// Step response in the usual terms; an undefined figure is null, and `reason` explains it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepResponse {
    /// Value at the start of the step.
    pub initial: f64,
    /// Value at the end of the run.
    #[serde(rename = "final")]
    pub last: f64,
    /// Time from the first crossing of 10 % of the change to the first of 90 % [s].
    pub rise_time_s: Option<f64>,
    /// Time from the step until the value stays within 2 % of the change about the final value [s].
    pub settling_time_2_percent_s: Option<f64>,
    /// Time from the step until the value stays within 5 % of the change about the final value [s].
    pub settling_time_5_percent_s: Option<f64>,
    /// Largest excursion beyond the final value, over the change [%].
    pub overshoot_percent: Option<f64>,
    /// Largest excursion beyond the initial value, away from the final one, over the change [%].
    pub undershoot_percent: Option<f64>,
    /// Extreme value in the direction from the initial to the final value.
    pub peak: Option<f64>,
    /// Time from the step to the peak [s].
    pub peak_time_s: Option<f64>,
    /// Reason why a figure is null.
    pub reason: Option<String>,
}

/// The part of a step from relative position `start` to 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Piece {
    /// Start and length of the step [s].
    t: f64,
    h: f64,
    cubic: Cubic,
    start: f64,
    /// Largest value, and its position.
    most: [f64; 2],
}

impl Piece {
    fn new([t, h]: [f64; 2], cubic: Cubic, start: f64) -> Self {
        let mut piece = Self {
            t,
            h,
            cubic,
            start,
            most: [f64::NEG_INFINITY, start],
        };
        for x in piece.places().into_iter().flatten() {
            let value = cubic.at(x);
            if value > piece.most[0] {
                piece.most = [value, x];
            }
        }
        piece
    }

    /// Ends of the piece and extrema between, in order.
    fn places(&self) -> [Option<f64>; 4] {
        let mut turns = self.cubic.turns().filter(|x| *x > self.start);
        let (a, b) = match (turns.next(), turns.next()) {
            (Some(a), Some(b)) => (Some(a.min(b)), Some(a.max(b))),
            other => other,
        };
        [Some(self.start), a, b, Some(1.0)]
    }

    fn time(&self, x: f64) -> f64 {
        self.t + x * self.h
    }

    /// Time [s] at which the value first exceeds `level` along the given positions, refined between two of them.
    fn above(&self, level: f64, places: impl Iterator<Item = f64>) -> Option<f64> {
        let mut below = None;
        for x in places {
            if self.cubic.at(x) > level {
                let passes = below.map_or(x, |below| self.cubic.between([below, x], level));
                return Some(self.time(passes));
            }
            below = Some(x);
        }
        None
    }
}

/// Decisive pieces of one value, or of its negative.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Side {
    /// Pieces with a value above all before.
    records: Vec<Piece>,
    /// Pieces with a value above all after.
    lasting: Vec<Piece>,
}

impl Side {
    fn take(&mut self, piece: Piece) {
        if self.records.last().is_none_or(|last| piece.most[0] > last.most[0]) {
            self.records.push(piece);
        }
        while self.lasting.last().is_some_and(|last| last.most[0] <= piece.most[0]) {
            self.lasting.pop();
        }
        self.lasting.push(piece);
    }

    /// First time at which the value exceeds a level [s].
    fn first_above(&self, level: f64) -> Option<f64> {
        let first = self.records.partition_point(|piece| piece.most[0] <= level);
        let piece = self.records.get(first)?;
        piece.above(level, piece.places().into_iter().flatten())
    }

    /// Last time at which the value exceeds a level [s].
    fn last_above(&self, level: f64) -> Option<f64> {
        let beyond = self.lasting.partition_point(|piece| piece.most[0] > level);
        let piece = self.lasting.get(beyond.checked_sub(1)?)?;
        piece.above(level, piece.places().into_iter().rev().flatten())
    }

    /// Largest value, and its time [s].
    fn most(&self) -> Option<[f64; 2]> {
        let piece = self.records.last()?;
        Some([piece.most[0], piece.time(piece.most[1])])
    }
}

/// Response of one value.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Way {
    initial: f64,
    last: f64,
    /// Pieces of the value, and of its negative.
    sides: [Side; 2],
}

/// Records the responses of values from a step on.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepResponses {
    names: Vec<String>,
    /// Time of the step, and time up to which the responses are recorded [s].
    at: f64,
    end: f64,
    ways: Vec<Way>,
}

impl StepResponses {
    /// Creates the record of named values from time `at` [s] on.
    pub fn new(names: Vec<String>, at: f64) -> Self {
        Self {
            names,
            at,
            end: at,
            ways: vec![],
        }
    }

    /// Adds a step of the run.
    pub fn step(&mut self, readings: &StepReadings) {
        let (span, cubics) = readings.step();
        self.take(span, cubics);
    }

    /// Adds the cubics of all values between two times [s].
    pub fn take(&mut self, [begin, end]: [f64; 2], cubics: impl Iterator<Item = Cubic>) {
        if end <= self.at {
            return;
        }
        let h = end - begin;
        let start = ((self.at - begin) / h).max(0.0);
        let first = self.ways.is_empty();
        for (k, cubic) in cubics.enumerate() {
            if first {
                self.ways.push(Way {
                    initial: cubic.at(start),
                    ..Way::default()
                });
            }
            let Some(way) = self.ways.get_mut(k) else { return };
            way.last = cubic.at(1.0);
            for (side, sign) in way.sides.iter_mut().zip([1.0, -1.0]) {
                side.take(Piece::new([begin, h], cubic.signed(sign), start));
            }
        }
        self.end = end;
    }

    /// Evaluates the step responses, by name; `finished` is true if the run reached its end.
    pub fn judge(&self, finished: bool) -> BTreeMap<String, StepResponse> {
        let all = self.names.iter().zip(&self.ways);
        all.map(|(name, way)| (name.clone(), self.one(way, finished))).collect()
    }

    fn one(&self, way: &Way, finished: bool) -> StepResponse {
        let Way { initial, last, sides } = way;
        let undefined = |reason: String| StepResponse {
            initial: *initial,
            last: *last,
            reason: Some(reason),
            ..StepResponse::default()
        };
        if !finished {
            return undefined("the run did not reach its end".into());
        }
        let (change, sign) = ((last - initial).abs(), if last > initial { 1.0 } else { -1.0 });
        let [up, down] = sides;
        let [along, against] = if sign > 0.0 { [up, down] } else { [down, up] };
        let (Some(peak), Some(back)) = (along.most(), against.most()) else {
            return undefined("no values were recorded".into());
        };
        let (from, to) = (sign * initial, sign * last);
        let farthest = (peak[0] - from).max(back[0] + from);
        if change <= SAME * farthest {
            return undefined("its final value equals its initial one: fractions of the change are undefined".into());
        }
        let settled = BANDS.map(|band| {
            let outside = [
                along.last_above(to + band * change),
                against.last_above(band * change - to),
            ];
            let left = outside.into_iter().flatten().fold(self.at, f64::max);
            let stays = self.end - left >= STAYS * (self.end - self.at);
            stays.then_some(left - self.at).ok_or_else(|| {
                format!(
                    "it leaves the band of {:.0} % about its final value {} before the end. A settled value stays in \
                     the band for the last tenth of the time",
                    100.0 * band,
                    quantity(self.end - left, "s", 4)
                )
            })
        });
        let [two, five] = settled;
        let five = match five {
            Ok(five) => five,
            Err(reason) => return undefined(reason),
        };
        let [begins, ends] = RISE.map(|share| along.first_above(from + share * change));
        StepResponse {
            initial: *initial,
            last: *last,
            rise_time_s: ends.zip(begins).map(|(b, a)| b - a),
            settling_time_2_percent_s: two.as_ref().ok().copied(),
            settling_time_5_percent_s: Some(five),
            overshoot_percent: Some(100.0 * ((peak[0] - to) / change).max(0.0)),
            undershoot_percent: Some(100.0 * ((back[0] + from) / change).max(0.0)),
            peak: Some(sign * peak[0]),
            peak_time_s: Some(peak[1] - self.at),
            reason: two.err(),
        }
    }
}
