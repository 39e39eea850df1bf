//! Statistics of the figures of all samples.

use std::collections::BTreeMap;

use super::indices::indices;
use super::rounding_errors::without_round_off;
use super::{FigureSpread, FirstOrder, FirstOrderSlopes, SamplePlan, UncertainInput, Uncertainty};
use crate::error::Code;
use crate::error::numbers::counted;
use crate::run::summary::Status;
use crate::study::analysis::{AnalysisOutcome, word};

/// Suffixes of results that are not figures, such as errors.
const NO_FIGURES: [&str; 7] = [
    "error",
    "_at_s",
    "residual_relative",
    "_bound",
    "_bound_hz",
    "modes",
    "strongly_damped",
];
/// Names of results that are not figures.
const NO_FIGURE: [&str; 3] = ["stable", "period_s", "load_factor"];
/// Difference between first order and samples, in standard errors, above which there is a warning.
const APART: f64 = 3.0;
/// Share of a spread above which the numerical error is significant.
const MATTERS: f64 = 1.0 / 3.0;
/// Distance of a number from its mean, in standard deviations, above which the case is not in the middle of the spread.
const ELSEWHERE: f64 = 0.1;
/// Spread, relative to the largest value, below which it is a rounding error.
const ROUND_OFF: f64 = 1e-12;
/// Distance of bands, relative to the frequency, below which they meet.
const MEET: f64 = 1e-3;
/// Largest number of figures named in a warning.
const NAMED: usize = 4;

/// True if a result is a figure, and not an error of one.
pub fn is_figure(name: &str) -> bool {
    !NO_FIGURES.iter().any(|end| name.ends_with(end)) && !NO_FIGURE.contains(&name)
}

/// Evaluates the samples of a case whose own figures are `own`. `own_values` contains the case's own value of each uncertain number, if it
/// has one. `found` is in the order of the plan; the case is given by its name and the length [m] of its beam.
pub fn judge(
    (case, length): (&str, f64),
    what: &str,
    plan: &SamplePlan,
    own: &AnalysisOutcome,
    own_values: &[Option<f64>],
    found: &[AnalysisOutcome],
    slopes: FirstOrderSlopes,
) -> Uncertainty {
    let inputs: Vec<UncertainInput> = plan
        .inputs()
        .iter()
        .filter_map(|one| {
            let [mean, sd] = one.values.moments()?;
            let (pointer, distribution) = (one.pointer.clone(), one.spec.clone());
            Some(UncertainInput {
                pointer,
                distribution,
                mean,
                sd,
            })
        })
        .collect();
    let samples = &found[..plan.samples().min(found.len())];
    let mut unfinished = BTreeMap::new();
    for one in samples.iter().filter(|one| one.status != Status::Finished) {
        let why = one.reason.clone().unwrap_or_else(|| word(one.status).into());
        *unfinished.entry(why).or_default() += 1;
    }
    let (slopes, no_first_order) = match slopes {
        Ok(slopes) => (slopes, None),
        Err(why) => (BTreeMap::new(), Some(why)),
    };
    let figures = own.figures.iter().filter(|(name, _)| is_figure(name));
    let figures: BTreeMap<String, FigureSpread> = figures
        .filter_map(|(name, value)| {
            let values: Vec<f64> = samples.iter().filter_map(|one| figure_named(one, name)).collect();
            let first_order = slopes.get(name).map(|slopes| first_order(slopes, &inputs));
            let mut spread = spread(*value, values)?;
            spread.numerical_error = numerical_error(own, name, *value);
            spread.first_order = first_order;
            spread.indices = plan.each().and_then(|n| {
                let sets = 2 + inputs.len();
                let row = |k: usize| {
                    (0..sets)
                        .map(|set| figure_named(found.get(set * n + k)?, name))
                        .collect()
                };
                let rows: Vec<Vec<f64>> = (0..n).filter_map(row).collect();
                indices(&rows, inputs.len(), plan.seed())
            });
            Some((name.clone(), spread))
        })
        .collect();
    let figures = without_round_off(figures, own, length);
    Uncertainty {
        case: case.into(),
        command: what.into(),
        samples: samples.len(),
        finished: samples.len() - unfinished.values().sum::<usize>(),
        unfinished,
        seed: plan.seed(),
        warnings: warnings(&figures, &inputs, own_values, samples),
        inputs,
        figures,
        no_first_order,
    }
}

/// Returns a figure of a finished sample.
fn figure_named(found: &AnalysisOutcome, name: &str) -> Option<f64> {
    found.figure(name).filter(|_| found.status == Status::Finished)
}

/// Estimated absolute error of a figure: its own, or that of its quantity, which is relative to the largest figure of the quantity.
fn numerical_error(own: &AnalysisOutcome, name: &str, value: f64) -> Option<f64> {
    let largest = |quantity: &str| {
        let of_it = own.figures.iter().filter(|(other, _)| {
            is_figure(other) && other.rsplit_once('.').is_some_and(|(other, _)| other == quantity)
        });
        of_it.map(|(_, x)| x.abs()).fold(0.0, f64::max)
    };
    let (quantity, figure) = name.rsplit_once('.').unzip();
    if let Some(error) = own.figure(&format!("{name}.error")) {
        // the error of a figure over a cycle is relative to the largest figure of its quantity
        return Some(
            match quantity.filter(|_| figure.is_some_and(|own| own.starts_with("window"))) {
                Some(quantity) => error * largest(quantity),
                None => error * value.abs(),
            },
        );
    }
    let error = own.figure(&format!("{}.error", quantity?))?;
    Some(error * largest(quantity?))
}

fn first_order(slopes: &[f64], inputs: &[UncertainInput]) -> FirstOrder {
    let parts: Vec<f64> = slopes
        .iter()
        .zip(inputs)
        .map(|(slope, one)| (slope * one.sd).powi(2))
        .collect();
    let variance: f64 = parts.iter().sum();
    let share = |part: &f64| if variance > 0.0 { part / variance } else { 0.0 };
    FirstOrder {
        sd: variance.sqrt(),
        shares: parts.iter().map(share).collect(),
    }
}

/// Computes moments and quantiles; `None` for fewer than two values.
fn spread(value: f64, mut all: Vec<f64>) -> Option<FigureSpread> {
    let n = all.len() as f64;
    if all.len() < 2 {
        return None;
    }
    all.sort_by(f64::total_cmp);
    let mean = all.iter().sum::<f64>() / n;
    let moment = |power: i32| all.iter().map(|x| (x - mean).powi(power)).sum::<f64>();
    let variance = moment(2) / (n - 1.0);
    // squared standard error of the variance: (m4 - (n-3)/(n-1) s^4)/n
    let of_variance = (moment(4) / n - (n - 3.0) / (n - 1.0) * variance * variance) / n;
    let largest = all.iter().map(|x| x.abs()).fold(0.0, f64::max);
    let sd = match variance.sqrt() {
        sd if sd > ROUND_OFF * largest => sd,
        _ => 0.0,
    };
    let sd_error = if sd > 0.0 {
        of_variance.max(0.0).sqrt() / (2.0 * sd)
    } else {
        0.0
    };
    let quantile = |share: f64| {
        let place = share * (n - 1.0);
        let k = (place as usize).min(all.len() - 2);
        all[k] + (place - k as f64) * (all[k + 1] - all[k])
    };
    Some(FigureSpread {
        value,
        numerical_error: None,
        first_order: None,
        samples: all.len(),
        mean,
        sd,
        sd_error,
        low: quantile(0.025),
        high: quantile(0.975),
        indices: None,
    })
}

fn warnings(
    figures: &BTreeMap<String, FigureSpread>,
    inputs: &[UncertainInput],
    own_values: &[Option<f64>],
    samples: &[AnalysisOutcome],
) -> Vec<String> {
    let mut all = vec![];
    let lost = samples.iter().filter(|one| one.status != Status::Finished).count();
    if lost > 0 {
        all.push(format!(
            "{lost} of {} did not finish. Spreads are those of the others and may be too narrow",
            counted(samples.len() as u64, "sample")
        ));
    }
    for (input, own) in inputs.iter().zip(own_values) {
        if let Some(own) = own.filter(|own| (own - input.mean).abs() > ELSEWHERE * input.sd) {
            all.push(format!(
                "{} is {own:?} in the case, but its mean is {:?}. The figures of the case itself are not in the \
                 middle of the spread",
                input.pointer, input.mean
            ));
        }
    }
    for (k, input) in inputs.iter().enumerate() {
        let mut shares = figures.values().filter_map(|one| one.first_order.as_ref()).peekable();
        if shares.peek().is_some() && shares.all(|first| first.shares[k] == 0.0) {
            all.push(format!(
                "no figure with derivatives depends on {} to first order",
                input.pointer
            ));
        }
    }
    let mut named = |which: &dyn Fn(&FigureSpread) -> bool, what: &str| {
        let names: Vec<&str> = figures
            .iter()
            .filter(|(_, one)| which(one))
            .map(|(name, _)| name.as_str())
            .collect();
        let more = match names.len().saturating_sub(NAMED) {
            0 => String::new(),
            n => format!(" and {n} more"),
        };
        if !names.is_empty() {
            let listed = names[..names.len().min(NAMED)].join(", ");
            all.push(format!("{listed}{more}: {what}"));
        }
    };
    named(
        &|one| one.samples + lost < samples.len(),
        "not all samples have this figure. Its meaning varies between samples (modes change their order, another part \
         of the motion dominates), and its band mixes several quantities",
    );
    named(
        &|one| {
            let first = one.first_order.as_ref();
            first.is_some_and(|first| (first.sd - one.sd).abs() > APART * one.sd_error.max(1e-3 * one.sd))
        },
        "first order and samples differ significantly. Either the figure is not linear in the uncertain numbers, and \
         the samples are right, or its numerical error varies from run to run, and both are wrong",
    );
    named(
        &|one| {
            one.numerical_error
                .is_some_and(|error| error > MATTERS * one.sd && one.sd > 0.0)
        },
        "the numerical error is not small compared with the spread. Use --accuracy, a finer mesh or a smaller \
         tolerance",
    );
    all.extend(crossed(figures));
    all
}

/// Warns of successive modes whose frequency bands meet: they may have changed places in some samples.
fn crossed(figures: &BTreeMap<String, FigureSpread>) -> Option<String> {
    let frequency = |k: usize| figures.get(&format!("mode_{k}.frequency_hz"));
    let pairs = (1..).map_while(|k| Some((k, frequency(k)?, frequency(k + 1)?)));
    let meet = |(_, one, next): &(usize, &FigureSpread, &FigureSpread)| {
        let spreads = one.sd.max(next.sd) > 0.0;
        spreads && one.high >= next.low * (1.0 - MEET)
    };
    let names: Vec<String> = pairs
        .filter(meet)
        .map(|(k, ..)| format!("mode_{k} and mode_{}", k + 1))
        .collect();
    (!names.is_empty()).then(|| {
        Code::ModesExchanged.warning(format!(
            "{}: their bands overlap, so their order may differ between samples. Each band then belongs to the lower \
             or the higher frequency, not to one mode shape",
            names.join(", ")
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::sweep::vary::VariedNumber;

    fn found(q: f64) -> AnalysisOutcome {
        AnalysisOutcome {
            figures: vec![("q.final".into(), q), ("q.error".into(), 1e-3)],
            ..AnalysisOutcome::finished()
        }
    }

    fn plan() -> SamplePlan {
        let inputs = ["/a=normal:2:0.1", "/b=uniform:0:6"].map(|text| VariedNumber::parse(text).expect("values"));
        SamplePlan::new(inputs.into(), 256, 1, true).expect("a plan")
    }

    /// Goal: for a straight line, first order and samples agree with the exact spread, 3 sd(a), sd(b) = 6/√12.
    #[test]
    fn a_straight_line_spreads_as_its_derivatives_say() {
        let plan = plan();
        let q = |x: &[f64]| 3.0 * x[0] + 0.1 * x[1];
        let all: Vec<AnalysisOutcome> = (0..plan.count()).map(|k| found(q(&plan.values(k)))).collect();
        let slopes = Ok(BTreeMap::from([("q.final".to_owned(), vec![3.0, 0.1])]));
        let own = found(q(&[2.0, 3.0]));
        let result = judge(("case", 0.1), "run", &plan, &own, &[Some(2.0), None], &all, slopes);
        assert_eq!(result.warnings, Vec::<String>::new());
        assert_eq!((result.samples, result.finished), (512, 512));
        let spread = &result.figures["q.final"];
        let exact = (0.09 + 0.03_f64).sqrt();
        let first = spread.first_order.as_ref().expect("first order");
        assert!((first.sd - exact).abs() < 1e-12 && (first.shares[0] - 0.75).abs() < 1e-12);
        assert!((spread.sd - exact).abs() < 3.0 * spread.sd_error, "{spread:?}");
        assert!((spread.numerical_error.expect("an error") - 6.3e-3).abs() < 1e-12);
        let indices = spread.indices.as_ref().expect("indices");
        assert!(
            (indices[0].first - 0.75).abs() < 0.05 && (indices[1].total - 0.25).abs() < 0.05,
            "{indices:?}"
        );
        assert!(result.figures.len() == 1);
    }

    /// Goal: an error relative to the largest figure of a quantity, as for cycles, is not smaller for a smaller figure of that quantity.
    #[test]
    fn errors_are_of_what_they_are_relative_to() {
        let own = AnalysisOutcome {
            figures: [
                ("q_m.window_max_abs", 2.0),
                ("q_m.window_rms", 1.0),
                ("q_m.window_rms.error", 0.01),
                ("mode_1.frequency_hz", 9.0),
                ("mode_1.damping_ratio", 0.1),
                ("mode_1.damping_ratio.error", 0.01),
            ]
            .map(|(name, x)| (name.to_owned(), x))
            .into(),
            ..found(0.0)
        };
        assert_eq!(numerical_error(&own, "q_m.window_rms", 1.0), Some(0.02));
        assert_eq!(numerical_error(&own, "mode_1.damping_ratio", 0.1), Some(0.001));
        assert_eq!(numerical_error(&own, "mode_1.frequency_hz", 9.0), None);
    }

    #[test]
    fn what_is_no_line_what_is_lost_and_what_is_elsewhere_is_told() {
        let plan = plan();
        let mut all: Vec<AnalysisOutcome> = (0..plan.count())
            .map(|k| found((plan.values(k)[1] - 3.0).powi(2)))
            .collect();
        all[3] = AnalysisOutcome {
            status: Status::Failed,
            reason: Some("E041 no".into()),
            ..found(1e9)
        };
        let slopes = Ok(BTreeMap::from([("q.final".to_owned(), vec![0.0, 0.0])]));
        let result = judge(
            ("case", 0.1),
            "run",
            &plan,
            &found(0.0),
            &[Some(2.1), Some(3.0)],
            &all,
            slopes,
        );
        let words = result.warnings.join("\n");
        for part in [
            "1 of 512 samples did not finish",
            "/a is 2.1 in the case, but its mean is 2.0",
            "not linear in the uncertain numbers",
            "no figure with derivatives depends on /b to first order",
        ] {
            assert!(words.contains(part), "{words}");
        }
        assert_eq!((result.finished, result.unfinished["E041 no"]), (511, 1));
        assert!(result.figures["q.final"].high < 10.0);
    }
}
