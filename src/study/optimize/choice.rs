//! What is chosen from several sets at once: all combinations of them, however many these are.

use super::wiring::{Alternative, Crossing, MOST, combinations};
use crate::error::Result;
use crate::numerics::chance::Chance;

/// What one option chooses from.
#[derive(Clone, Debug)]
pub enum Part {
    /// One of these.
    Of(Vec<Alternative>),
    /// Where two chains change sides.
    Crossovers(Crossing),
}

/// Combinations of one of each part, each as digits: of a list which of it, of crossovers a digit a place, 1 where chains change sides.
#[derive(Clone, Debug, Default)]
pub struct Choice(pub Vec<Part>);

impl Choice {
    /// How many there are.
    pub fn count(&self) -> f64 {
        let counts = self.0.iter().map(|part| match part {
            Part::Of(all) => all.len() as f64,
            Part::Crossovers(crossing) => crossing.count(),
        });
        counts.product()
    }

    /// Whether there are too many to compute all.
    pub fn is_large(&self) -> bool {
        self.count() > MOST as f64
    }

    /// All of them; none where nothing is chosen.
    ///
    /// # Errors
    /// There are too many.
    pub fn all(&self) -> Result<Vec<Alternative>> {
        let of = |part: &Part| match part {
            Part::Of(all) => Ok(all.clone()),
            Part::Crossovers(crossing) => crossing.all(),
        };
        combinations(self.0.iter().map(of).collect::<Result<_>>()?)
    }

    /// How many values each digit has.
    pub fn sizes(&self) -> Vec<usize> {
        let of = |part: &Part| match part {
            Part::Of(all) => vec![all.len()],
            Part::Crossovers(crossing) => vec![2; crossing.places()],
        };
        self.0.iter().flat_map(of).collect()
    }

    /// Each part with its digits.
    fn parts<'a>(&'a self, digits: &'a [usize]) -> impl Iterator<Item = (&'a Part, &'a [usize])> {
        let mut rest = digits;
        self.0.iter().map(move |part| {
            let count = match part {
                Part::Of(_) => 1,
                Part::Crossovers(crossing) => crossing.places(),
            };
            let (own, others) = rest.split_at(count.min(rest.len()));
            rest = others;
            (part, own)
        })
    }

    /// Whether digits are one of them.
    pub fn allows(&self, digits: &[usize]) -> bool {
        self.parts(digits).all(|(part, own)| match part {
            Part::Of(_) => true,
            Part::Crossovers(crossing) => own.iter().sum::<usize>() <= crossing.most(),
        })
    }

    /// The one with these digits.
    pub fn at(&self, digits: &[usize]) -> Alternative {
        let of = |(part, own): (&Part, &[usize])| match part {
            Part::Of(all) => own.first().and_then(|k| all.get(*k)).cloned().unwrap_or_default(),
            Part::Crossovers(crossing) => {
                let after: Vec<usize> = (1..=own.len()).filter(|k| own[k - 1] == 1).collect();
                crossing.wiring(&after)
            }
        };
        let join = |a: Alternative, b: Alternative| Alternative {
            name: format!("{}, {}", a.name, b.name),
            sets: [a.sets, b.sets].concat(),
        };
        self.parts(digits).map(of).reduce(join).unwrap_or_default()
    }

    /// The first of all parts.
    pub fn first(&self) -> Vec<usize> {
        vec![0; self.sizes().len()]
    }

    /// Digits by chance.
    pub fn drawn(&self, chance: &mut Chance) -> Vec<usize> {
        let mut digits = vec![];
        for part in &self.0 {
            match part {
                Part::Of(all) => digits.push(chance.below(all.len() as u64) as usize),
                Part::Crossovers(crossing) => {
                    let places = crossing.places();
                    let count = chance.below(crossing.most() as u64 + 1) as usize;
                    let order = chance.order(u32::try_from(places).unwrap_or(u32::MAX));
                    let mut own = vec![0; places];
                    order.iter().take(count).for_each(|k| own[*k as usize] = 1);
                    digits.extend(own);
                }
            }
        }
        digits
    }

    /// Digits that differ from the first ones in one place, every value of every digit among them: what has to be a case at least.
    pub fn singles(&self) -> Vec<Vec<usize>> {
        let first = self.first();
        let mut all = vec![first.clone()];
        for (k, size) in self.sizes().into_iter().enumerate() {
            for value in 1..size {
                let mut one = first.clone();
                one[k] = value;
                if self.allows(&one) {
                    all.push(one);
                }
            }
        }
        all
    }
}
