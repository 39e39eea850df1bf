//! First gaps between the waves of a beam whose cells repeat.

use super::derivatives::GatheredDerivatives;
use super::{Analysis, AnalysisOutcome, AnalysisRequest, FoundSlopes, RunCase, StopCheck, accurate};
use crate::case::Case;
use crate::case::parameter::{Parameter, STEPS};
use crate::discrete::System;
use crate::error::{Code, Result};
use crate::run::bands::waves::Lattice;
use crate::study::bands::{self, BandGap, BandStructure, coupling_number};
use crate::study::refine::{self, ReferencedNumber, RefinedNumbers};

/// Number of gaps with figures, of bending and of stretch, those of lowest frequency.
const GAPS: usize = 2;
/// Relative change of a parameter in a difference: edges beside a resonance with small losses hardly move by as little.
const CHANGE: f64 = 1e-5;
/// Equally spaced samples of the band.
const POINTS: usize = 60;

/// `slcbeam bands` in the band that [`bands::lowest_band`] chooses, with edges on the mesh of the case.
pub struct BandsAnalysis;

impl Analysis for BandsAnalysis {
    fn check(&self, case: &Case) -> Result<()> {
        Lattice::new(case).map(|_| ())
    }

    fn figures(&self, case: &Case, ask: AnalysisRequest, _: StopCheck, _: RunCase) -> Result<AnalysisOutcome> {
        let Some(asked) = ask.accuracy else {
            return Ok(of_bands(&lowest(case, ask.meshes)?));
        };
        let mut edges = |case: &Case| lowest(case, false).map(|found| numbers(&found));
        let (case, accuracy) = refine::refine(case, asked, false, &mut edges)?;
        let mut found = of_bands(&lowest(&case, false)?);
        accurate(&mut found, &accuracy, &str::to_owned);
        Ok(found)
    }

    fn names(&self, _: &Case) -> Result<Vec<String>> {
        let gaps = [false, true].map(|stretch| (1..=GAPS).map(move |number| gap_name(stretch, number)));
        let figures = ["from_hz", "to_hz", "relative_width", "attenuation_db"];
        let of = |gap: String| figures.map(|figure| format!("{gap}.{figure}"));
        let all = gaps.into_iter().flatten().flat_map(of);
        Ok(all.chain(["coupling_number".to_owned()]).collect())
    }

    /// Edges of gaps at changed values of each parameter, differenced to fourth order; each edge is found again near the present one.
    fn derivatives(&self, case: &Case, parameters: &[Parameter], _: Option<&System>, _: StopCheck) -> FoundSlopes {
        let found = lowest(case, false)?;
        let gaps = named(&found);
        let mut all = GatheredDerivatives::new(parameters.len());
        for (k, parameter) in parameters.iter().enumerate() {
            let mut slopes = vec![[Some(0.0); 2]; gaps.len()];
            let mut coupling = coupling_number(&found.lattice).map(|_| 0.0);
            for (steps, weight) in STEPS {
                let changed = parameter.changed(case, parameter.value * (1.0 + steps * CHANGE))?;
                let lattice = Lattice::new(&changed)?;
                let weight = weight / (CHANGE * parameter.value);
                let add = |sum: &mut Option<f64>, value: Option<f64>| {
                    *sum = sum.zip(value).map(|(sum, value)| sum + weight * value);
                };
                add(&mut coupling, coupling_number(&lattice));
                for ((_, gap), slopes) in gaps.iter().zip(&mut slopes) {
                    let edges = gap.edges_in(&lattice);
                    slopes.iter_mut().zip(edges).for_each(|(sum, edge)| add(sum, edge));
                }
            }
            if let Some(slope) = coupling {
                all.put(k, "coupling_number".into(), slope);
            }
            for ((name, gap), slopes) in gaps.iter().zip(slopes) {
                for (figure, slope) in ["from_hz", "to_hz"].into_iter().zip(slopes) {
                    all.put(k, format!("{name}.{figure}"), slope.unwrap_or(f64::NAN));
                }
                if let [Some(from), Some(to)] = slopes {
                    // derivative of 2 (b - a)/(a + b)
                    let [a, b] = gap.edges_on_mesh();
                    let width = 4.0 * (a * to - b * from) / (a + b).powi(2);
                    all.put(k, format!("{name}.relative_width"), width);
                }
            }
        }
        Ok((of_bands(&found), all.whole()))
    }

    fn fault(&self) -> Code {
        Code::NoModes
    }

    fn is_in_time(&self) -> bool {
        false
    }
}

/// Waves of a case in its lowest band; without any if nothing oscillates.
fn lowest(case: &Case, compared: bool) -> Result<BandStructure> {
    let lattice = Lattice::new(case)?;
    let band = bands::lowest_band(&lattice).unwrap_or([1.0, 2.0]);
    bands::bands(case, lattice, band, POINTS, compared)
}

fn gap_name(stretch: bool, number: usize) -> String {
    format!("{}_gap_{number}", if stretch { "stretch" } else { "bending" })
}

/// The lowest gaps of each motion with their names.
fn named(found: &BandStructure) -> Vec<(String, &BandGap)> {
    let of = |stretch: bool| {
        let own = found.gaps.iter().filter(move |gap| gap.motion.stretch == stretch);
        (1..=GAPS)
            .zip(own)
            .map(move |(number, gap)| (gap_name(stretch, number), gap))
    };
    of(false).chain(of(true)).collect()
}

/// Edges of the lowest gaps.
fn numbers(found: &BandStructure) -> RefinedNumbers {
    let edges = named(found).into_iter().flat_map(|(name, gap)| {
        let [from, to] = gap.edges_on_mesh().map(|edge| ReferencedNumber::new(edge, 0.0));
        [(format!("{name}.from_hz"), from), (format!("{name}.to_hz"), to)]
    });
    edges.collect()
}

fn of_bands(found: &BandStructure) -> AnalysisOutcome {
    let mut all = AnalysisOutcome::finished();
    all.put("coupling_number", coupling_number(&found.lattice));
    for (name, gap) in named(found) {
        let edges = gap.edges_on_mesh();
        let [from, to] = edges;
        all.put(format!("{name}.from_hz"), from);
        all.put(format!("{name}.to_hz"), to);
        let errors = gap.errors.map(|error| error.unwrap_or(f64::NAN));
        for ((figure, edge), error) in ["from_hz", "to_hz"].into_iter().zip(edges).zip(gap.errors) {
            all.put(format!("{name}.{figure}.error"), error.map(|error| error / edge));
        }
        all.put(format!("{name}.relative_width"), 2.0 * (to - from) / (from + to));
        let width_error = (errors[0] + errors[1]) / (to - from);
        all.put(
            format!("{name}.relative_width.error"),
            Some(width_error).filter(|error| error.is_finite()),
        );
        all.put(format!("{name}.attenuation_db"), bands::decibel(gap.attenuation));
    }
    all
}
