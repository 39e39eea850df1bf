//! Frequency responses of small motions about the start.

use nalgebra::Complex;
use serde::{Deserialize, Serialize};

use super::derivatives::GatheredDerivatives;
use super::{Analysis, AnalysisOutcome, AnalysisRequest, FoundSlopes, RunCase, StopCheck, accurate};
use crate::case::Case;
use crate::case::parameter::Parameter;
use crate::discrete::System;
use crate::error::{Code, Error, Result};
use crate::run::early_warnings;
use crate::run::response;
use crate::study::refine::{self, ReferencedNumber, RefinedNumbers};
use crate::study::response::derivatives::{at_frequencies, differentiate};
use crate::study::response::{self as study, BandResponse, OutputResponse, Request, respond_on_mesh};

/// Number of peaks of an output with figures, those of lowest frequency.
const PEAKS: usize = 4;
/// Samples of the band among which peaks are found.
const POINTS: usize = 200;
/// Reference size of the error of a damping ratio.
const DAMPING: f64 = 0.01;

/// `slcbeam response` from an input to outputs, about the start: peaks in a band, and values at frequencies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ResponseAnalysis {
    /// JSON pointer of the input.
    pub input: String,
    /// Names of the outputs.
    pub outputs: Vec<String>,
    /// First and last frequency of the band [Hz].
    pub band: [f64; 2],
    /// Further frequencies with figures [Hz].
    pub frequencies: Vec<f64>,
}

/// A response with the values of each output at the frequencies.
struct Figures {
    found: BandResponse,
    values: Vec<Vec<Complex<f64>>>,
}

impl ResponseAnalysis {
    /// Words of a command line that request this analysis.
    pub fn options(&self) -> Vec<String> {
        let [from, to] = self.band.map(|hz| hz.to_string());
        let outputs = self.outputs.join(",");
        let mut all = vec![
            "--input",
            &self.input,
            "--output",
            &outputs,
            "--from",
            &from,
            "--to",
            &to,
        ];
        let frequencies = self
            .frequencies
            .iter()
            .map(f64::to_string)
            .collect::<Vec<_>>()
            .join(",");
        if !frequencies.is_empty() {
            all.extend(["--frequency", &frequencies]);
        }
        all.into_iter().map(str::to_owned).collect()
    }

    fn request(&self) -> Request {
        Request {
            input: self.input.clone(),
            outputs: self.outputs.clone(),
            at: None,
            band: self.band,
            points: POINTS,
        }
    }

    fn respond(&self, case: &Case) -> Result<Figures> {
        let request = self.request();
        self.with_values(respond_on_mesh(case, &request, request.compute(case)?)?)
    }

    fn with_values(&self, mut found: BandResponse) -> Result<Figures> {
        found.curves.iter_mut().for_each(|curve| curve.peaks.truncate(PEAKS));
        let jets = at_frequencies(&found.response, &self.frequencies, &[])?;
        let of = |place: usize| jets.iter().map(|all| all[place].value).collect();
        let values = (0..found.curves.len()).map(of).collect();
        Ok(Figures { found, values })
    }

    fn outcome(&self, case: &Case, all: &Figures) -> Result<AnalysisOutcome> {
        let mut outcome = AnalysisOutcome::finished();
        // without a complete search only a growing pole is certain
        if all.found.growing > 0 || all.found.unknown.is_empty() {
            outcome.put("stable", f64::from(u8::from(all.found.growing == 0)));
        }
        for (curve, values) in all.found.curves.iter().zip(&all.values) {
            for (name, peak) in peaks(curve) {
                outcome.put(format!("{name}.frequency_hz"), peak.frequency_hz);
                // that of an undamped peak is unbounded
                let amplitude = Some(peak.value.norm()).filter(|_| peak.damping_ratio() != Some(0.0));
                outcome.put(format!("{name}.amplitude"), amplitude);
                outcome.put(format!("{name}.damping_ratio"), peak.damping_ratio());
            }
            for (hz, value) in self.frequencies.iter().zip(values) {
                let name = at(&curve.output.key(), *hz);
                outcome.put(format!("{name}.amplitude"), value.norm());
                outcome.put(format!("{name}.phase_deg"), value.arg().to_degrees());
            }
        }
        let about = &all.found.response.about;
        outcome.warn(&early_warnings::at_rest(case, &System::new(case)?));
        outcome.warn(&study::cautions(all.found.growing, about.moving()));
        outcome.warn(&about.range);
        Ok(outcome)
    }

    /// Adds relative errors of figures by the meshes of beam and fluid, those of [`study::respond`].
    fn put_errors(&self, case: &Case, here: &RefinedNumbers, outcome: &mut AnalysisOutcome) -> Result<()> {
        let mut sums: Vec<f64> = vec![0.0; here.len()];
        for (other, factor) in study::meshes(case)? {
            let request = self.request();
            let there = request
                .compute(&other)
                .and_then(|linear| study::respond_roughly(&request, linear));
            let there = there
                .and_then(|found| self.with_values(found))
                .map(|all| self.numbers(&all));
            let there = match there {
                Err(interrupted @ Error::Interrupted(_)) => return Err(interrupted),
                there => there.unwrap_or_default(),
            };
            for ((name, own), sum) in here.iter().zip(&mut sums) {
                let apart = there
                    .get(name)
                    .map_or(f64::NAN, |there| (own.value - there.value).abs());
                *sum += factor * apart / own.counted();
            }
        }
        let errors = here.keys().zip(sums);
        errors.for_each(|(name, error)| outcome.put(format!("{name}.error"), error));
        Ok(())
    }

    /// Figures whose errors by meshes are known.
    fn numbers(&self, all: &Figures) -> RefinedNumbers {
        let mut numbers = RefinedNumbers::new();
        let mut put = |name: String, value: f64, size: f64| numbers.insert(name, ReferencedNumber::new(value, size));
        for (curve, values) in all.found.curves.iter().zip(&all.values) {
            for (name, peak) in peaks(curve) {
                put(format!("{name}.frequency_hz"), peak.frequency_hz, 0.0);
                put(format!("{name}.amplitude"), peak.value.norm(), 0.0);
                if let Some(ratio) = peak.damping_ratio() {
                    put(format!("{name}.damping_ratio"), ratio, DAMPING);
                }
            }
            for (hz, value) in self.frequencies.iter().zip(values) {
                put(format!("{}.amplitude", at(&curve.output.key(), *hz)), value.norm(), 0.0);
            }
        }
        numbers
    }
}

impl Analysis for ResponseAnalysis {
    fn check(&self, case: &Case) -> Result<()> {
        response::outputs(case, &self.input, &self.outputs).map(|_| ())
    }

    fn figures(&self, case: &Case, ask: AnalysisRequest, _: StopCheck, _: RunCase) -> Result<AnalysisOutcome> {
        let mut of = |case: &Case| self.respond(case).map(|all| self.numbers(&all));
        let Some(asked) = ask.accuracy else {
            let all = self.respond(case)?;
            let mut outcome = self.outcome(case, &all)?;
            if ask.meshes {
                self.put_errors(case, &self.numbers(&all), &mut outcome)?;
            }
            return Ok(outcome);
        };
        let (case, accuracy) = refine::refine(case, asked, false, &mut of)?;
        let mut outcome = self.outcome(&case, &self.respond(&case)?)?;
        accurate(&mut outcome, &accuracy, &str::to_owned);
        Ok(outcome)
    }

    fn names(&self, case: &Case) -> Result<Vec<String>> {
        let mut all = vec!["stable".to_owned()];
        for output in response::outputs(case, &self.input, &self.outputs)? {
            let key = output.key();
            for k in 1..=PEAKS {
                let of = |figure: &str| format!("{key}.peak_{k}.{figure}");
                all.extend(["frequency_hz", "amplitude", "damping_ratio"].map(of));
            }
            for hz in &self.frequencies {
                all.extend(["amplitude", "phase_deg"].map(|figure| format!("{}.{figure}", at(&key, *hz))));
            }
        }
        Ok(all)
    }

    fn derivatives(&self, case: &Case, parameters: &[Parameter], _: Option<&System>, _: StopCheck) -> FoundSlopes {
        let own = self.respond(case)?;
        let slopes = differentiate(case, None, &own.found, &self.frequencies, parameters)?;
        let mut all = GatheredDerivatives::new(parameters.len());
        for (k, slopes) in slopes.iter().enumerate() {
            for (place, curve) in own.found.curves.iter().enumerate() {
                for ((name, _), slope) in peaks(curve).zip(&slopes.peaks[place]) {
                    all.put(k, format!("{name}.frequency_hz"), slope.frequency_hz);
                    all.put(k, format!("{name}.amplitude"), slope.amplitude);
                    let damping_ratio = slope.damping_ratio.unwrap_or(f64::NAN);
                    all.put(k, format!("{name}.damping_ratio"), damping_ratio);
                }
                let values = own.values[place].iter().zip(&slopes.values[place]);
                for (hz, (value, slope)) in self.frequencies.iter().zip(values) {
                    let name = at(&curve.output.key(), *hz);
                    let relative = slope / value;
                    all.put(k, format!("{name}.amplitude"), relative.re * value.norm());
                    all.put(k, format!("{name}.phase_deg"), relative.im.to_degrees());
                }
            }
        }
        Ok((self.outcome(case, &own)?, all.whole()))
    }

    fn fault(&self) -> Code {
        Code::NoModes
    }

    fn is_in_time(&self) -> bool {
        false
    }
}

/// Peaks of an output with the beginning of the names of their figures.
fn peaks(curve: &OutputResponse) -> impl Iterator<Item = (String, &study::BandPeak)> {
    let key = curve.output.key();
    let numbered = (1..).zip(&curve.peaks);
    numbered.map(move |(k, peak)| (format!("{key}.peak_{k}"), peak))
}

/// Beginning of the names of figures at a frequency [Hz].
fn at(key: &str, hz: f64) -> String {
    format!("{key}.at_{hz}_hz")
}
