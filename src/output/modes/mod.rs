//! Output files of a modal analysis, `modes.csv`, `modes.json`, `modes.npz` and `modes.svg`, and its text.

mod completeness;
mod picture;
mod table;

use std::io;

use nalgebra::Complex;
use zip::ZipWriter;

use super::accuracy;
use super::arrays::write_array;
use super::folder::{ResultFolder, fault};
use super::numbers::{counted, significant};
use crate::case::schema::Effect;
use crate::discrete::quantities::FieldAxis;
use crate::error::{Code, Result};
use crate::model::passivity::{self, Passivity};
use crate::results;
use crate::results::modes::{self as kept, LinearisedState};
use crate::results::run::Bands;
use crate::run::modes::{Mode, ModeFilter, ModeOptions, ModeSensitivity, Modes, TimeBehavior};
use crate::run::summary::Accuracy;
use crate::study::refine;

pub use table::{csv, table};

/// One row per mode.
pub const CSV: &str = "modes.csv";
/// Complete result without shapes.
pub const JSON: &str = "modes.json";
/// Shapes.
pub const ARRAYS: &str = "modes.npz";
/// Shapes with pressures.
pub const PICTURE: &str = "modes.svg";

/// Difference of two modes, relative to their angular frequency, below which they are equal.
const ALIKE: f64 = 1e-6;

/// Modes with their case.
pub struct Report<'a> {
    /// Name of the case.
    pub case: &'a str,
    /// Requested search.
    pub plan: &'a ModeOptions,
    /// The only kind of modes requested, if any.
    pub sort: Option<ModeFilter>,
    /// Modes found.
    pub found: &'a Modes,
    /// State of linearization.
    pub state: LinearisedState,
    /// Derivatives with respect to numbers of the case.
    pub sensitivities: &'a [ModeSensitivity],
    /// Estimated errors, if an accuracy was requested.
    pub accuracy: Option<&'a Accuracy>,
    /// Warnings about the case itself.
    pub known: &'a [String],
    /// Uncertainty bands of the oscillating modes, by the rank of their frequencies.
    pub bands: &'a Bands,
}

impl Report<'_> {
    /// State of linearization as text: `the start`.
    pub fn about(&self) -> String {
        match self.state {
            LinearisedState::Start => "the start".into(),
            LinearisedState::Equilibrium => format!("the equilibrium under the loads at t = {} s", self.found.about.at),
            LinearisedState::Cycle => "the cycle".into(),
        }
    }

    /// Stability of the state, in one sentence.
    pub fn verdict(&self) -> String {
        let growing: Vec<String> = self
            .found
            .modes
            .iter()
            .enumerate()
            .filter(|(_, mode)| mode.kind.grows())
            .map(|(k, mode)| match mode.frequency_hz() {
                Some(f) => format!(
                    "mode {} by flutter at {f:.5} Hz, growing at {:.4e} 1/s",
                    k + 1,
                    mode.s.re
                ),
                None => format!("mode {} by divergence, growing at {:.4e} 1/s", k + 1, mode.s.re),
            })
            .collect();
        match growing.as_slice() {
            [] if self.found.modes.is_empty() => match self.sort {
                Some(sort) if self.found.clustered => format!("no modes of the kind {} were found", sort.word()),
                Some(sort) => format!("there are no modes of the kind {}", sort.word()),
                None => "there are no modes".into(),
            },
            [] => {
                let moving = self.found.modes.iter().filter(|mode| !mode.kind.stays()).count();
                let count = counted(moving as u64, "mode");
                let swings = self.found.modes.iter().any(|mode| mode.kind.swings());
                match self.sort {
                    None if !swings => format!(
                        "no growth and no oscillation in the {count} shown. Use --kind oscillation to find oscillating modes"
                    ),
                    _ => format!("no growth in the {count} shown"),
                }
            }
            all => format!("unstable: {}", all.join("; ")),
        }
    }

    /// All warnings about the modes.
    pub fn warnings(&self) -> Vec<String> {
        let still = (self.found.modes.is_empty() && self.sort.is_none()).then(|| {
            Code::Seldom.warning(
                "nothing can move: the case leaves out inertia of the solid (/effects/solid_inertia) and no bladder exchanges fluid",
            )
        });
        let short = self.accuracy.and_then(refine::warning);
        let mut all = self.known.to_vec();
        all.extend(still);
        all.extend(self.found.warnings(&self.about()));
        all.extend(self.uncertain().into_iter().chain(short));
        all
    }

    /// Change of each mode for a 1 % change of a number of the case: `mode 2: +0.0608 Hz, −1.2e-5 1/s`.
    fn derivatives(&self, s: &ModeSensitivity) -> String {
        let percent = 0.01 * s.parameter.value;
        let mut text = format!(
            "for 1 % of {} = {}:",
            s.parameter.pointer,
            significant(s.parameter.value, 6)
        );
        let moving = |(_, (mode, _)): &(usize, (&Mode, _))| !mode.kind.stays();
        for (k, (mode, ds)) in self.found.modes.iter().zip(&s.s).enumerate().filter(moving) {
            let growth = significant(percent * ds.re, 4);
            let swings = mode.frequency_hz().map_or(String::new(), |_| {
                format!("{} Hz, ", significant(percent * ds.im / std::f64::consts::TAU, 4))
            });
            text.push_str(&format!("\n  mode {}: {swings}growth {growth} 1/s", k + 1));
        }
        text
    }

    fn passivity(&self) -> Option<(Passivity, String)> {
        let model = &self.found.about.system().model;
        let found = passivity::assess(model)?;
        let words = found.describe(&model.wet.as_ref()?.coupling);
        Some((found, words))
    }

    /// Sentences below the table.
    pub fn sentences(&self) -> String {
        let coupling = self.passivity().map(|p| p.1);
        let mut all = vec![self.verdict()];
        all.extend(self.only().into_iter().chain(coupling));
        all.extend(self.warnings().into_iter().map(|w| format!("warning: {w}")));
        all.extend(self.sensitivities.iter().map(|s| self.derivatives(s)));
        all.extend(
            self.accuracy
                .map(|found| accuracy::describe(found).trim_end().to_string()),
        );
        all.join("\n")
    }
}

/// Text of `modes.json`; numbers that are not finite are null.
pub fn json(report: &Report) -> String {
    let found = report.found;
    let coupling = |(p, words): (Passivity, String)| kept::CouplingPassivity {
        passive: p.passive(),
        least_eigenvalue: p.least,
        reciprocity_defect: p.defect,
        direction: kept::LoadDirection {
            moment_n_m: p.direction[0],
            force_n: p.direction[1],
            upper_pressure_pa: p.direction[2],
            lower_pressure_pa: p.direction[3],
        },
        words,
    };
    let derivatives = |s: &ModeSensitivity| {
        let derivatives = kept::ModeDerivatives {
            value: s.parameter.value,
            growth_rate_1_s: s.s.iter().map(|ds| Some(ds.re)).collect(),
            frequency_hz: s.s.iter().map(|ds| Some(ds.im / std::f64::consts::TAU)).collect(),
        };
        (s.parameter.pointer.clone(), derivatives)
    };
    results::text(&kept::ModesRecord {
        case: report.case.into(),
        about: report.about(),
        state: Some(report.state),
        at_s: found.about.at,
        near_hz: report.plan.near_hz,
        of_kind: report.sort,
        unknowns: found.about.y.len(),
        finite_eigenvalues: found.finite,
        stable: !found.modes.iter().any(|m| m.kind.grows()),
        verdict: report.verdict(),
        modes: with_bands(found.modes.iter().map(mode).collect(), report.bands),
        coupling: report.passivity().map(coupling),
        sensitivities: report.sensitivities.iter().map(derivatives).collect(),
        solver: kept::SearchWork {
            factorizations: found.factorizations,
            solves: found.solves,
            all_at_once: found.dense,
        },
        left_out: found.left_out.iter().map(Effect::to_string).collect(),
        excluded: found.excluded.clone(),
        warnings: report.warnings(),
        accuracy: report.accuracy.cloned(),
    })
}

fn mode(mode: &Mode) -> kept::ModeRecord {
    kept::ModeRecord {
        kind: mode.kind,
        frequency_hz: mode.frequency_hz(),
        damping_ratio: mode.damping_ratio(),
        growth_per_s: mode.s.re,
        time_s: mode.time_s(),
        angular_frequency_per_s: mode.s.im,
        error_per_s: Some(mode.error),
        residual: Some(mode.residual),
        transverse_share: Some(mode.shape.transverse()),
        undrained: mode.undrained,
        drained: mode.drained,
        on_half_the_cells: mode.coarse,
        extrapolated_frequency_hz: mode.extrapolated_hz(),
        extrapolated_growth_per_s: mode.extrapolated().map(|s| s.re),
        mesh_error: mode.mesh_error(),
        rate_mesh_error: mode.rate_error(),
        effects_error: mode.effects_error(),
        rate_effects_error: mode.rate_effects_error(),
        bands: Bands::new(),
    }
}

/// Adds the bands of their own figures to modes. A rank counts all oscillating modes, of which some may be missing here, and equal modes
/// may be in another order. Modes are therefore matched by their values.
fn with_bands(mut modes: Vec<kept::ModeRecord>, bands: &Bands) -> Vec<kept::ModeRecord> {
    for rank in 1.. {
        let of = |figure: &str| bands.get(&format!("mode_{rank}.{figure}"));
        let Some(frequency) = of("frequency_hz") else {
            return modes;
        };
        let alike = |mode: &&mut kept::ModeRecord| {
            let near = |a: f64, b: f64| (a - b).abs() <= ALIKE * mode.angular_frequency_per_s;
            mode.bands.is_empty()
                && mode.frequency_hz.is_some_and(|hz| near(hz, frequency.value))
                && of("growth_per_s").is_none_or(|growth| near(mode.growth_per_s, growth.value))
        };
        if let Some(mode) = modes.iter_mut().find(alike) {
            let own = ["frequency_hz", "damping_ratio", "growth_per_s"];
            mode.bands = own
                .into_iter()
                .filter_map(|figure| Some((figure.to_owned(), *of(figure)?)))
                .collect();
        }
    }
    modes
}

/// Writes the files into a folder; other files in it stay.
pub fn write(folder: &mut ResultFolder, report: &Report) -> Result<()> {
    let arrays = pack(report.found).map_err(|e| fault("write", &folder.path(ARRAYS), e))?;
    let texts = [(CSV, csv(report)), (JSON, json(report))].map(|(name, text)| (name, text.into_bytes()));
    folder.fill(
        texts.into_iter().chain([(ARRAYS, arrays)]),
        [(PICTURE, picture::drawn(report))],
    )
}

/// Arrays mode × place. The displacement of a mode is `u1_amplitude_m cos(ω t + u1_phase_rad) e^{σ t}`.
fn pack(found: &Modes) -> io::Result<Vec<u8>> {
    let mut npz = ZipWriter::new(io::Cursor::new(Vec::new()));
    let system = found.about.system();
    let count = found.modes.len() as u64;
    let one = |f: fn(&Mode) -> f64| found.modes.iter().map(f);
    let nodes = system.mesh.nodes;
    let along = |axis: FieldAxis| axis.values(system, 0.0).into_iter();
    write_array(&mut npz, "theta_m", &[nodes as u64], along(FieldAxis::Nodes))?;
    if system.model.structure.is_some() {
        for axis in [
            FieldAxis::BeamOfNode,
            FieldAxis::RestX,
            FieldAxis::RestZ,
            FieldAxis::RestAngle,
        ] {
            write_array(&mut npz, axis.name(), &[nodes as u64], along(axis))?;
        }
    }
    write_array(&mut npz, "growth_per_s", &[count], one(|m| m.s.re))?;
    write_array(&mut npz, "angular_frequency_per_s", &[count], one(|m| m.s.im))?;
    type Field = fn(&Mode) -> &[Complex<f64>];
    let fields: [(&str, &str, Field); 3] = [
        ("u1", "m", |m| &m.shape.u1),
        ("u3", "m", |m| &m.shape.u3),
        ("pressure", "pa", |m| &m.shape.pressure),
    ];
    for (name, unit, field) in fields {
        let places = found.modes.first().map_or(0, |m| field(m).len()) as u64;
        if places == 0 {
            continue;
        }
        let all = || found.modes.iter().flat_map(field);
        let (shape, amplitude) = ([count, places], format!("{name}_amplitude_{unit}"));
        write_array(&mut npz, &amplitude, &shape, all().map(|x| x.norm()))?;
        write_array(&mut npz, &format!("{name}_phase_rad"), &shape, all().map(|x| x.arg()))?;
    }
    Ok(npz.finish()?.into_inner())
}

/// Part in which a mode moves.
fn moves(mode: &Mode) -> &'static str {
    let shape = &mode.shape;
    match shape.transverse() {
        _ if mode.kind == TimeBehavior::Volume || shape.displacement() == 0.0 => "fluid",
        share if share > 0.9 => "across",
        share if share < 0.1 => "along",
        _ => "both",
    }
}
