//! The best of many combinations, by going from one to the next as long as that is better.

use std::cmp::Ordering;

use super::chance::Chance;

/// What a combination is worth, the less the better: how far it breaks what it has to hold first, then the figure.
pub type Worth = [f64; 2];

/// The order of two, the better first.
pub fn order(a: &Worth, b: &Worth) -> Ordering {
    a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
}

/// What there is to choose: for every digit one of `0..size`.
pub struct Space<'a> {
    /// Sizes of the digits.
    pub sizes: &'a [usize],
    /// Whether a combination counts.
    pub allowed: &'a (dyn Fn(&[usize]) -> bool + Sync),
}

/// Where a search ended.
#[derive(Clone, Debug, PartialEq)]
pub struct End {
    /// The best combination that it has seen.
    pub at: Vec<usize>,
    /// What that is worth.
    pub worth: Worth,
    /// Whether nothing next to it is better; else the search was ended before it knew.
    pub local: bool,
}

/// A step to a combination next to another one.
#[derive(Clone, Copy)]
enum Step {
    /// A digit takes another value.
    Change(usize, usize),
    /// Two digits of one size change places.
    Exchange(usize, usize),
}

impl Space<'_> {
    /// Every step, whatever it leads to.
    fn steps(&self) -> Vec<Step> {
        let digits = 0..self.sizes.len();
        let changes = digits
            .clone()
            .flat_map(|k| (0..self.sizes[k]).map(move |value| Step::Change(k, value)));
        let pairs = digits
            .clone()
            .flat_map(|a| (0..a).map(move |b| (a, b)))
            .filter(|(a, b)| self.sizes[*a] == self.sizes[*b]);
        changes.chain(pairs.map(|(a, b)| Step::Exchange(a, b))).collect()
    }
}

/// Goes from a combination to the first better one among those next to it, these in an order by chance, until none is better: a digit changed, or two
/// digits exchanged. It ends early where `worth` has nothing to say. None where it has nothing to say of the first.
pub fn descend(
    space: &Space,
    start: Vec<usize>,
    chance: &mut Chance,
    worth: &mut dyn FnMut(&[usize]) -> Option<Worth>,
) -> Option<End> {
    let steps = space.steps();
    let mut end = End {
        worth: worth(&start)?,
        at: start,
        local: false,
    };
    let mut next = vec![];
    'better: loop {
        for k in chance.order(u32::try_from(steps.len()).unwrap_or(u32::MAX)) {
            next.clone_from(&end.at);
            match steps[k as usize] {
                Step::Change(digit, value) => next[digit] = value,
                Step::Exchange(a, b) => next.swap(a, b),
            }
            if next == end.at || !(space.allowed)(&next) {
                continue;
            }
            let Some(there) = worth(&next) else {
                return Some(end);
            };
            if order(&there, &end.worth).is_lt() {
                end.at.clone_from(&next);
                end.worth = there;
                continue 'better;
            }
        }
        end.local = true;
        return Some(end);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rugged figure of twelve bits: neighbours like to differ, some more than others.
    fn figure(digits: &[usize]) -> f64 {
        let pairs = digits.windows(2).enumerate();
        let rough: f64 = pairs
            .map(|(k, pair)| {
                let differ = if pair[0] == pair[1] { 1.0 } else { -1.0 };
                differ * (1.0 + (1.7 * k as f64).sin())
            })
            .sum();
        let ones = digits.iter().sum::<usize>() as f64;
        rough + 0.3 * (ones - 4.0).powi(2)
    }

    fn all() -> impl Iterator<Item = Vec<usize>> {
        (0..1_usize << 12).map(|n| (0..12).map(|k| n >> k & 1).collect())
    }

    /// Goal: where a search ends nothing next to it is better; several starts find the best of all 4096, with a part of them looked at; a
    /// limit is kept, a search that is told to stop has the best so far, and the same seed goes the same way.
    #[test]
    fn searches_end_where_nothing_near_is_better() {
        let allowed = |digits: &[usize]| digits.iter().sum::<usize>() <= 6;
        let space = Space {
            sizes: &[2; 12],
            allowed: &allowed,
        };
        let least = all()
            .filter(|d| allowed(d))
            .map(|d| figure(&d))
            .fold(f64::MAX, f64::min);
        let mut looked = std::collections::BTreeSet::new();
        let mut go = |stream: u64, most: usize| {
            let mut left = most;
            let mut chance = Chance::new(7, stream);
            descend(&space, vec![0; 12], &mut chance, &mut |digits| {
                assert!(allowed(digits));
                looked.insert(digits.to_vec());
                left = left.checked_sub(1)?;
                Some([0.0, figure(digits)])
            })
        };
        let ends: Vec<End> = (0..8).filter_map(|k| go(k, 10_000)).collect();
        assert_eq!(ends[3], go(3, 10_000).expect("an end"));
        let early = go(3, 20).expect("an end");
        assert!(!early.local && early.worth[1] < figure(&[0; 12]) && early.worth[1] >= ends[3].worth[1]);
        assert_eq!(go(3, 0), None);
        assert!(looked.len() < 2000, "{}", looked.len());
        assert!(ends.iter().any(|end| (end.worth[1] - least).abs() < 1e-12), "{ends:?}");
        for end in ends {
            assert!(end.local && (figure(&end.at) - end.worth[1]).abs() < 1e-12);
            for k in 0..12 {
                for j in 0..12 {
                    let mut next = end.at.clone();
                    next.swap(j, k);
                    assert!(figure(&next) >= end.worth[1]);
                }
                let mut next = end.at.clone();
                next[k] = 1 - next[k];
                assert!(!allowed(&next) || figure(&next) >= end.worth[1]);
            }
        }
    }

    /// Goal: what has to be held comes before the figure.
    #[test]
    fn limits_come_first() {
        let space = Space {
            sizes: &[5, 3],
            allowed: &|_| true,
        };
        let end = descend(&space, vec![0, 0], &mut Chance::new(1, 1), &mut |d| {
            Some([(d[0] as f64 - 3.0).max(0.0), -((d[0] * 3 + d[1]) as f64)])
        });
        assert_eq!(end.map(|end| end.at), Some(vec![3, 2]));
    }
}
