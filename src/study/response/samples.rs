//! Samples of a response over a band: a logarithmic grid, and more where the response changes.

use nalgebra::Complex;

/// Change of a response between two samples, relative to the larger one, above which a sample is added between them.
const CHANGE: f64 = 0.1;

/// Density of samples over a band [Hz].
#[derive(Clone, Copy, Debug)]
pub(super) struct Sampling {
    pub band: [f64; 2],
    /// Number of grid points, equally spaced in the logarithm; one if the band is a single frequency.
    pub points: usize,
    /// Part of the distance of the grid points in which at most one sample is added.
    pub narrow: f64,
    /// Largest number of samples with added ones.
    pub most: usize,
}

impl Sampling {
    /// Number of intervals of the grid.
    fn intervals(&self) -> f64 {
        (self.points.max(2) - 1) as f64
    }

    /// Frequencies of the grid [Hz].
    pub fn grid(&self) -> Vec<f64> {
        let [from, to] = self.band;
        let points = if from < to { self.points } else { 1 };
        let place = |k: usize| match k + 1 == points {
            true => to,
            false => from * (to / from).powf(k as f64 / self.intervals()),
        };
        (0..points).map(place).collect()
    }

    /// Evaluates a response at ascending frequencies, and between them where one of the values that `compared` returns changes.
    ///
    /// # Errors
    /// Those of `at`.
    pub fn refine<T, E>(
        &self,
        frequencies: &[f64],
        mut at: impl FnMut(f64) -> std::result::Result<T, E>,
        compared: impl Fn(&T) -> Vec<Complex<f64>>,
    ) -> std::result::Result<(Vec<f64>, Vec<T>), E> {
        let [from, to] = self.band;
        let narrow = self.narrow * (to / from).ln() / self.intervals();
        // samples still to be added, the next one last
        let mut ahead = vec![];
        for hz in frequencies.iter().rev() {
            ahead.push((*hz, at(*hz)?));
        }
        let (mut frequencies, mut samples): (Vec<f64>, Vec<T>) = (vec![], vec![]);
        while let Some((hz, sample)) = ahead.pop() {
            let middle = frequencies.last().zip(samples.last()).and_then(|(before, old)| {
                let changes = |(a, b): (Complex<f64>, Complex<f64>)| (a - b).norm() > CHANGE * a.norm().max(b.norm());
                let wide = (hz / before).ln() > narrow && frequencies.len() + ahead.len() < self.most;
                (wide && compared(old).into_iter().zip(compared(&sample)).any(changes)).then(|| (before * hz).sqrt())
            });
            if let Some(middle) = middle {
                ahead.extend([(hz, sample), (middle, at(middle)?)]);
            } else {
                frequencies.push(hz);
                samples.push(sample);
            }
        }
        Ok((frequencies, samples))
    }
}
