//! What the estimate says, and when it warns.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::Unstable;
use super::resonance::Near;
use super::strikes::Struck;
use super::turning::Turned;
use crate::discrete::quantities::Interest;
use crate::discrete::resolution;
use crate::error::Code;
use crate::error::numbers::{counted, significant};
use crate::run::summary::Estimate;

/// Above this a figure is warned of.
pub const LARGE: f64 = resolution::LIMIT;
/// From this factor on that compression softens a column it is told.
const SOFT: f64 = 10.0;
/// Finest mesh, in cells a segment, that is proposed.
const FINEST: f64 = 64.0;
/// Tightest tolerance that is proposed.
const TIGHTEST: f64 = 1e-9;

/// What the estimate says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimated {
    /// By steps, of the figure that is off most, relative to the largest value of its quantity.
    pub time: f64,
    /// By the mesh, likewise.
    pub space: f64,
    /// The quantity whose final value that is.
    pub of: String,
    /// Part of it that is phase of one vibration: it is in final values, and hardly in largest values or root mean squares.
    pub phase: f64,
    /// Vibrations gone, of the mode that is off most.
    pub vibrations: f64,
    /// By what angle mesh and steps have shifted it [rad].
    pub shift_rad: f64,
    /// By what factor the deflection grows by itself, and errors with it; absent where it does not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub growth: Option<f64>,
    /// How many times as much as a part of Euler's load a deflection changes, where compression came near it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub softened: Option<f64>,
    /// `N l²/(EI)` of a compression under which short waves grew; absent where there was none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub crushed: Option<f64>,
    /// How many times as large the square of the wave number is, of what an end has sent out by the end of the run, as that of the first
    /// vibration; absent where the run is longer than that takes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub young: Option<f64>,
    /// How far a beam has turned that nothing turns back, and by what angle steps may have turned it wrongly; absent where something does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turning: Option<Turned>,
    /// Strikes against walls that multiply errors; absent where they do not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub struck: Option<Struck>,
    /// What a rotational spring at an end whose moment is given does to the figure, of first order in the cells; absent where the mesh does more.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub couple: Option<f64>,
    /// A drive near a vibration that the mesh misplaces.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub near: Option<Near>,
    /// All quantities.
    pub quantities: BTreeMap<String, Estimate>,
}

/// One quantity as it is judged.
#[derive(Clone, Debug)]
pub struct Row {
    /// The quantity.
    pub name: Interest,
    /// Errors by steps and by the mesh, relative to its largest value.
    pub errors: [f64; 2],
    /// Part that is phase of one free vibration.
    pub phase: f64,
    /// Vibrations gone, and the angle of their shift [rad].
    pub vibrations: f64,
    /// See above.
    pub shift: f64,
    /// Of the error by the mesh, what is of first order in the cells: see [`Couple`](super::couple::Couple).
    pub couple: f64,
}

impl Row {
    /// With errors times a factor.
    pub fn times(self, factor: f64) -> Self {
        Self {
            errors: self.errors.map(|x| factor * x),
            phase: factor * self.phase,
            couple: factor * self.couple,
            ..self
        }
    }

    /// By steps and by the mesh.
    pub fn total(&self) -> f64 {
        self.errors[0] + self.errors[1]
    }
}

impl Estimated {
    /// Of all quantities that say something; none where there is none.
    pub fn of(rows: &[Row], unstable: &Unstable, near: Option<Near>, young: f64) -> Option<Self> {
        let worst = rows.iter().max_by(|a, b| a.total().total_cmp(&b.total()))?;
        let one = |row: &Row| {
            let [time, space] = row.errors;
            let estimate = Estimate {
                time: Some(time),
                space: Some(space),
                total: Some(time + space),
                ..Estimate::default()
            };
            (row.name.to_string(), estimate)
        };
        Some(Self {
            time: worst.errors[0],
            space: worst.errors[1],
            of: worst.name.to_string(),
            phase: worst.phase,
            vibrations: worst.vibrations,
            shift_rad: worst.shift,
            growth: beyond_one(unstable.grown),
            softened: beyond_one(unstable.softened).filter(|x| *x > SOFT),
            crushed: beyond_one(unstable.crushed),
            young: beyond_one(young),
            turning: None,
            struck: None,
            couple: (worst.couple > 0.5 * worst.errors[1]).then_some(worst.couple),
            near,
            quantities: rows.iter().map(one).collect(),
        })
    }

    /// What to know where it is large: which figures, why, and what to set. `cells` a segment, `rtol`: those of the run.
    pub fn warning(&self, rows: &[Row], cells: usize, rtol: f64) -> Option<String> {
        let mut large: Vec<&Row> = rows.iter().filter(|row| row.total() > LARGE).collect();
        large.sort_by(|a, b| b.total().total_cmp(&a.total()));
        let worst = *large.first()?;
        let names: Vec<String> = large
            .iter()
            .map(|r| format!("{} {}", r.name, size(r.total())))
            .collect();
        let phase = |row: &Row| row.total() - row.phase <= LARGE && row.phase > 0.5 * row.total();
        let struck = self.struck.map(|struck| struck.gain);
        let grows = self.growth.or(self.softened).or(self.crushed).or(self.young).or(struck);
        let by_phase = grows.is_none();
        let only_phase = by_phase && large.iter().all(|row| phase(row));
        let (figures, because) = match (only_phase, self.turned()) {
            (true, Some(turned)) => ("final values", format!("{turned}; largest values are hardly affected")),
            (true, None) => (
                "final values",
                format!(
                    "after {:.0} vibrations mesh and steps have shifted the phase by {:.2} rad; largest values and root mean \
                     squares are hardly affected",
                    worst.vibrations, worst.shift
                ),
            ),
            (false, _) => ("values", self.because(large.iter().any(|row| row.name.unit() == "J"))),
        };
        let [time, space] = worst.errors;
        let (by, other) = match time > space {
            true => (
                "by steps",
                format!("{} by the mesh), {}", size(space), tighter(time, rtol)),
            ),
            false => (
                "by the mesh",
                format!(
                    "{} by steps), {}",
                    size(time),
                    finer(
                        space.max(if only_phase { worst.shift } else { 0.0 }),
                        self.couple.map_or(2.0, |_| 1.0),
                        cells
                    )
                ),
            ),
        };
        Some(Code::ErrorEstimate.warning(format!(
            "estimate: {figures} may be off by about these parts of the largest: {}; mostly {by} ({} of {}, {other}: {because}; --accuracy \
             measures",
            names.join(", "),
            size(time.max(space)),
            worst.name,
        )))
    }

    /// What steps make of a beam that turns freely, where that counts.
    fn turned(&self) -> Option<String> {
        let turned = self.turning.filter(|turned| turned.off_rad > LARGE)?;
        Some(format!(
            "nothing turns the beam back, so that errors of steps add up: it has turned {:.0} rad in all, and may be off by {}",
            turned.turned_rad,
            match turned.off_rad >= TAU {
                true => "more than a turn".into(),
                false => format!("{:.2} rad", turned.off_rad),
            }
        ))
    }

    fn because(&self, energies: bool) -> String {
        let near = self.near.map(|near| {
            format!(
                "the drive at {:.4} Hz comes near a vibration at {:.4} Hz, which the mesh misplaces by {:.1} %",
                near.drive_hz,
                near.vibration_hz,
                100.0 * near.misplaced
            )
        });
        let growth = self.growth.map(|factor| {
            format!(
                "the deflection grows by a factor of {factor:.3}, and errors at least with it, so that this is a guess"
            )
        });
        let soft = self.softened.map(|factor| {
            format!("compression came so near Euler's load that what the mesh changes of that counts {factor:.0} times")
        });
        let crushed = self.crushed.map(|times| {
            let wave = TAU / times.sqrt();
            format!(
                "compression reached {times:.0} times EI/l^2, for long enough that waves of {wave:.2} l grow, which the mesh must carry"
            )
        });
        let young = self.young.map(|times| {
            let shorter = times.sqrt();
            format!("what an end sends out is still a wave when the run ends, {shorter:.1} times as short as the first vibration")
        });
        let couple = self.couple.map(|_| {
            "a rotational spring acts at an end whose moment is given: half a cell of it is bent wrongly, an error of first order in the cells".into()
        });
        let struck = self.struck.map(|struck| {
            format!(
                "{} against walls multiply errors of the motion by about {}, so that small changes of mesh, tolerance or case change \
                 what follows",
                counted(struck.strikes.into(), "strike"),
                significant(struck.gain, 1)
            )
        });
        let all: Vec<String> = [near, growth, soft, crushed, young, self.turned(), couple, struck]
            .into_iter()
            .flatten()
            .collect();
        let why = match all.is_empty() {
            true => "the mesh is coarse, or the tolerance loose, for what the beam does".into(),
            false => all.join("; "),
        };
        let most = if energies { ", energies most" } else { "" };
        format!("{why}; largest values are off as well{most}")
    }
}

fn beyond_one(factor: f64) -> Option<f64> {
    (factor > 1.0).then_some(factor)
}

/// An error in words.
fn size(x: f64) -> String {
    match x {
        x if x >= 1.0 => "all".into(),
        x if x < 0.005 => "0 %".into(),
        x => format!("{:.0} %", 100.0 * x),
    }
}

/// Cells a segment that leave half of what is warned of, of an error of an order on fewer.
fn finer(error: f64, order: f64, cells: usize) -> String {
    let doubled = ((2.0 * error / LARGE).log2() / order).ceil().max(1.0);
    let wanted = cells as f64 * doubled.exp2();
    match wanted <= FINEST {
        true => format!("/mesh/cells_per_segment={wanted:.0} in place of {cells}"),
        false => format!(
            "/mesh/cells_per_segment={:.0} or more in place of {cells}",
            FINEST.max(2.0 * cells as f64)
        ),
    }
}

/// The tolerance that leaves half of what is warned of, of an error at another one.
fn tighter(error: f64, rtol: f64) -> String {
    let tenths = (2.0 * error / LARGE).log10().ceil().max(1.0);
    let wanted = (rtol * 10.0_f64.powf(-tenths)).max(TIGHTEST);
    format!("/solver/rtol={wanted:.0e} in place of {rtol:.0e}")
}
