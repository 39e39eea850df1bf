//! Values of each sample, by its number.
//!
//! ```text
//! 0 .. N              A: points of Sobol's sequence
//! N .. 2N             B: points of as many further directions, if indices are requested
//! (2+i)N .. (3+i)N    A with the i-th number of B
//! ```

use crate::error::{Error, Result};
use crate::numerics::rng::Rng;
use crate::numerics::sobol::{self, Sobol};
use crate::study::sweep::designs::Designs;
use crate::study::sweep::vary::{Draw, VariedNumber};

/// Least number of samples: with fewer, there is no quantile of 2.5 %.
const FEWEST: usize = 16;
/// Largest number of samples.
const MOST: usize = 100_000;

/// Samples to be drawn.
#[derive(Clone, Debug)]
pub struct SamplePlan {
    inputs: Vec<VariedNumber>,
    samples: usize,
    seed: u64,
    indices: bool,
    /// Directions of the sequence, with the shifts of their bits.
    directions: Vec<(Sobol, u32)>,
}

impl SamplePlan {
    /// Plans `samples` samples of some numbers.
    ///
    /// # Errors
    /// [`Error::Usage`]: lists of values, numbers that contain each other, too many numbers, too few or too many
    /// samples.
    pub fn new(inputs: Vec<VariedNumber>, samples: usize, seed: u64, indices: bool) -> Result<Self> {
        let usage = |what: String| Err(Error::Usage(what));
        if let Some(listed) = inputs.iter().find(|one| !one.drawn()) {
            return usage(format!(
                "--uncertain {}={}: expected a distribution, uniform:LOW:HIGH or normal:MEAN:SD",
                listed.pointer, listed.spec
            ));
        }
        if !(FEWEST..=MOST).contains(&samples) {
            return usage(format!("--samples {samples}: expected from {FEWEST} to {MOST}"));
        }
        let wanted = inputs.len() * if indices { 2 } else { 1 };
        if wanted > sobol::MOST {
            let most = sobol::MOST * inputs.len() / wanted;
            let without = if indices { " with --indices" } else { "" };
            return usage(format!(
                "--uncertain: at most {most} numbers are possible{without}, but {} are given",
                inputs.len()
            ));
        }
        // rejects two of the same number, or one within another
        Designs::crossed(1, &inputs, Draw::Latin(1), None)?;
        let direction = |k: usize| (Sobol::along(k), Rng::new(seed, k as u64).bits());
        Ok(Self {
            directions: (0..wanted).map(direction).collect(),
            inputs,
            samples,
            seed,
            indices,
        })
    }

    /// Uncertain numbers.
    pub fn inputs(&self) -> &[VariedNumber] {
        &self.inputs
    }

    /// JSON pointers of the numbers.
    pub fn pointers(&self) -> Vec<String> {
        self.inputs.iter().map(|input| input.pointer.clone()).collect()
    }

    /// Number of samples from which a spread is computed.
    pub fn samples(&self) -> usize {
        self.samples * if self.indices { 2 } else { 1 }
    }

    /// Number of samples of each set that indices compare; `None` if no indices are requested.
    pub fn each(&self) -> Option<usize> {
        self.indices.then_some(self.samples)
    }

    /// The seed.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Number of cases to compute.
    pub fn count(&self) -> usize {
        self.samples * if self.indices { 2 + self.inputs.len() } else { 1 }
    }

    /// Returns the values of sample `number`, below [`Plan::count`], in the order of the inputs.
    pub fn values(&self, number: usize) -> Vec<f64> {
        let (set, point) = (number / self.samples, (number % self.samples) as u32);
        let own = self.inputs.len();
        let direction = |i: usize| match set {
            0 => i,
            1 => own + i,
            other if other - 2 == i => own + i,
            _ => i,
        };
        let inputs = self.inputs.iter().enumerate();
        let values = inputs.filter_map(|(i, input)| {
            let (sobol, shift) = &self.directions[direction(i)];
            input.values.at(sobol.share(point, *shift))
        });
        values.collect()
    }

    /// Returns sample `number` as arguments of `--set`.
    pub fn sets(&self, number: usize) -> Vec<String> {
        self.sets_of(&self.values(number))
    }

    /// Returns arguments of `--set` with the values that `value` computes from mean and standard deviation of each
    /// number.
    pub fn sets_at(&self, mut value: impl FnMut([f64; 2]) -> f64) -> Vec<String> {
        let values = self
            .inputs
            .iter()
            .filter_map(|input| Some(value(input.values.moments()?)));
        self.sets_of(&values.collect::<Vec<_>>())
    }

    fn sets_of(&self, values: &[f64]) -> Vec<String> {
        let pairs = self.inputs.iter().zip(values);
        pairs
            .map(|(input, value)| format!("{}={value:?}", input.pointer))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(all: &[&str], samples: usize, indices: bool) -> Result<SamplePlan> {
        SamplePlan::new(
            all.iter()
                .map(|text| VariedNumber::parse(text).expect("values"))
                .collect(),
            samples,
            1,
            indices,
        )
    }

    #[test]
    fn sets_differ_in_one_number_alone() {
        let plan = plan(&["/a=uniform:0:1", "/b=normal:0:1", "/c=uniform:2:3"], 32, true).expect("a plan");
        assert_eq!((plan.count(), plan.samples(), plan.each()), (5 * 32, 64, Some(32)));
        for k in 0..32 {
            let (a, b) = (plan.values(k), plan.values(32 + k));
            assert!(a.iter().zip(&b).all(|(a, b)| a != b));
            for i in 0..3 {
                let mixed = plan.values((2 + i) * 32 + k);
                assert!((0..3).all(|j| mixed[j] == if i == j { b[j] } else { a[j] }));
            }
        }
    }

    #[test]
    fn what_cannot_be_drawn_is_refused() {
        let eleven: Vec<String> = (0..11).map(|k| format!("/a{k}=uniform:0:1")).collect();
        let eleven: Vec<&str> = eleven.iter().map(String::as_str).collect();
        for (inputs, samples, indices, word) in [
            (vec!["/a=1,2"], 64, false, "expected a distribution"),
            (vec!["/a=uniform:0:1"], 8, false, "from 16"),
            (vec!["/a=uniform:0:1", "/a=normal:0:1"], 64, false, "twice"),
            (eleven, 64, true, "at most 10 numbers are possible with --indices"),
        ] {
            let why = plan(&inputs, samples, indices).expect_err("refused").to_string();
            assert!(why.contains(word), "{why}");
        }
    }
}
