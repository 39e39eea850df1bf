//! Values of each design by its number. Designs are not stored; each is computed on request.

use serde_json::Value;

use super::table::DesignTable;
use super::vary;
use super::vary::{Draw, VariedNumber, VariedValues};
use crate::case::is_below;
use crate::error::{Error, Result};
use crate::numerics::rng::Rng;
use crate::numerics::sobol::{self, Sobol};

/// Largest number of designs.
pub const MOST: usize = 1_000_000;

/// One design.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// Its number, from 0.
    pub number: usize,
    /// Index of its case in the list of cases.
    pub case: usize,
    /// Values of the varied numbers, in the order of the axes.
    pub values: Vec<Value>,
}

impl Design {
    /// Returns the arguments of `--set`.
    pub fn sets<'a>(&'a self, pointers: &'a [String]) -> impl Iterator<Item = String> + 'a {
        pointers
            .iter()
            .zip(&self.values)
            .map(|(pointer, value)| format!("{pointer}={value}"))
    }

    /// Describes the design: `/a = 1, /b = 2`.
    pub fn describe(&self, pointers: &[String]) -> String {
        pairs(pointers, &self.values)
    }
}

/// Lists pointers with their values.
pub fn pairs(pointers: &[String], values: &[Value]) -> String {
    let pairs = pointers.iter().zip(values);
    let all: Vec<String> = pairs.map(|(pointer, value)| format!("{pointer} = {value}")).collect();
    all.join(", ")
}

/// All designs of a sweep.
#[derive(Clone, Debug)]
pub struct Designs {
    cases: usize,
    pointers: Vec<String>,
    count: usize,
    made: Made,
}

#[derive(Clone, Debug)]
enum Made {
    Table(Vec<Vec<Value>>),
    /// Values of each axis, with samples if they are drawn; and the number of samples.
    Crossed(Vec<(VariedValues, Samples)>, usize),
}

#[derive(Clone, Debug)]
enum Samples {
    None,
    Latin(Vec<u32>, Rng),
    Sobol(Sobol, u32),
}

impl Designs {
    /// Creates the designs of a table, with each of `cases` cases.
    ///
    /// # Errors
    /// [`Error::Usage`] for two columns of the same number, and for too many designs.
    pub fn listed(cases: usize, table: DesignTable) -> Result<Self> {
        apart("--designs", &table.pointers)?;
        Ok(Self {
            count: bounded(cases, [table.rows.len()])?,
            cases,
            pointers: table.pointers,
            made: Made::Table(table.rows),
        })
    }

    /// Returns the option that defines the designs.
    pub fn option(&self) -> &'static str {
        match self.made {
            Made::Table(_) => "--designs",
            Made::Crossed(..) => "--vary",
        }
    }

    /// Combines every listed value with every other one and with every drawn sample, for each of `cases` cases.
    ///
    /// # Errors
    /// [`Error::Usage`] if distributions and draw do not match, for numbers that contain each other, for too many
    /// designs.
    pub fn crossed(cases: usize, varied: &[VariedNumber], draw: Draw, seed: Option<u64>) -> Result<Self> {
        let pointers: Vec<String> = varied.iter().map(|vary| vary.pointer.clone()).collect();
        apart("--vary", &pointers)?;
        let drawn = varied.iter().filter(|vary| vary.drawn()).count();
        match draw {
            Draw::Grid if drawn > 0 => {
                let one = varied.iter().find(|vary| vary.drawn());
                return Err(Error::Usage(format!(
                    "--vary {}={}: a distribution needs the number of drawn designs. Use --design latin:N or sobol:N",
                    one.map_or("", |vary| &vary.pointer),
                    one.map_or("", |vary| &vary.spec),
                )));
            }
            Draw::Latin(_) | Draw::Sobol(_) if drawn == 0 => {
                return Err(Error::Usage(format!(
                    "--design {}: no number has a distribution. Use --vary POINTER=uniform:LOW:HIGH or \
                     normal:MEAN:SD, or omit --design",
                    draw.describe()
                )));
            }
            Draw::Sobol(_) if drawn > sobol::MOST => {
                return Err(Error::Usage(format!(
                    "--design {}: the Sobol sequence has at most {} dimensions, but {drawn} numbers are drawn. Use \
                     latin:N",
                    draw.describe(),
                    sobol::MOST
                )));
            }
            _ => {}
        }
        let lengths = varied.iter().filter_map(|vary| match &vary.values {
            VariedValues::Listed(values) => Some(values.len()),
            _ => None,
        });
        let count = bounded(cases, lengths.chain([draw.count()]))?;
        let mut direction = 0;
        let axes = varied.iter().map(|vary| {
            let samples = match draw {
                _ if !vary.drawn() => Samples::None,
                Draw::Grid => Samples::None,
                Draw::Latin(n) => {
                    let stream = 2 * direction as u64;
                    let order = Rng::new(seed.unwrap_or(1), stream).order(n as u32);
                    Samples::Latin(order, Rng::new(seed.unwrap_or(1), stream + 1))
                }
                Draw::Sobol(_) => {
                    let shift = seed.map_or(0, |seed| Rng::new(seed, direction as u64).bits());
                    Samples::Sobol(Sobol::along(direction), shift)
                }
            };
            direction += usize::from(vary.drawn());
            (vary.values.clone(), samples)
        });
        Ok(Self {
            made: Made::Crossed(axes.collect(), draw.count()),
            cases,
            pointers,
            count,
        })
    }

    /// Number of designs.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Pointers of the varied numbers.
    pub fn pointers(&self) -> &[String] {
        &self.pointers
    }

    /// Returns design number `number`. The last axis varies faster than the other axes, samples faster still, cases
    /// slowest.
    pub fn design(&self, number: usize) -> Design {
        let each = self.count / self.cases.max(1);
        let (case, mut left) = (number / each, number % each);
        let values = match &self.made {
            Made::Table(rows) => rows[left].clone(),
            Made::Crossed(axes, samples) => {
                let sample = left % samples;
                left /= samples;
                let mut values: Vec<Value> = axes
                    .iter()
                    .rev()
                    .map(|(values, samples)| match values {
                        VariedValues::Listed(all) => {
                            let value = all[left % all.len()].clone();
                            left /= all.len();
                            value
                        }
                        drawn => drawn.at(share(samples, sample)).map_or(Value::Null, vary::number),
                    })
                    .collect();
                values.reverse();
                values
            }
        };
        Design { number, case, values }
    }
}

/// Position of a sample between 0 and 1.
fn share(samples: &Samples, sample: usize) -> f64 {
    match samples {
        Samples::None => 0.5,
        Samples::Latin(order, chance) => {
            let within = chance.clone().at(sample as u64);
            (f64::from(order[sample]) + within) / order.len() as f64
        }
        Samples::Sobol(sobol, shift) => sobol.share(sample as u32, *shift),
    }
}

/// Returns the number of designs; rejects too many.
fn bounded(cases: usize, lengths: impl IntoIterator<Item = usize>) -> Result<usize> {
    let product = lengths.into_iter().try_fold(cases, usize::checked_mul);
    product.filter(|n| *n <= MOST).ok_or_else(|| {
        Error::Usage(format!(
            "more than {MOST} designs. Vary fewer numbers at once, or draw with --design latin:N"
        ))
    })
}

/// Rejects numbers that are varied twice, or that are part of another one.
fn apart(option: &str, pointers: &[String]) -> Result<()> {
    for (k, one) in pointers.iter().enumerate() {
        for other in &pointers[..k] {
            if one == other {
                return Err(Error::Usage(format!("{option}: {one} is varied twice")));
            }
            if is_below(one, other) || is_below(other, one) {
                return Err(Error::Usage(format!(
                    "{option}: one of {one} and {other} contains the other. Vary only the outer one, with complete \
                     values"
                )));
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::normal::quantile;

    fn varied(all: &[&str]) -> Vec<VariedNumber> {
        all.iter()
            .map(|text| VariedNumber::parse(text).expect("values"))
            .collect()
    }

    fn column(designs: &Designs, k: usize) -> Vec<f64> {
        let value = |n| designs.design(n).values[k].as_f64().expect("a number");
        (0..designs.count()).map(value).collect()
    }

    #[test]
    fn grids_have_every_combination_once() {
        let designs = Designs::crossed(2, &varied(&["/a=1,2", "/b=lin:0:1:3"]), Draw::Grid, None).expect("designs");
        assert_eq!(designs.count(), 12);
        assert_eq!(column(&designs, 0)[..6], [1.0, 1.0, 1.0, 2.0, 2.0, 2.0]);
        assert_eq!(column(&designs, 1)[..6], [0.0, 0.5, 1.0, 0.0, 0.5, 1.0]);
        assert_eq!((designs.design(5).case, designs.design(6).case), (0, 1));
        assert_eq!(designs.design(1).describe(designs.pointers()), "/a = 1, /b = 0.5");
    }

    #[test]
    fn logarithmic_ranges_have_constant_ratios_and_exact_ends() {
        let designs = Designs::crossed(1, &varied(&["/a=log:0.01:1:5"]), Draw::Grid, None).expect("designs");
        let all = column(&designs, 0);
        assert_eq!((all[0], all[4]), (0.01, 1.0));
        assert!(all.windows(2).all(|w| (w[1] / w[0] - 10_f64.sqrt()).abs() < 1e-12));
    }

    /// Goal: each of N equally likely strata of each number contains one design; another seed draws others.
    #[test]
    fn a_latin_hypercube_fills_every_stratum_once() {
        const N: usize = 50;
        let of = |seed| {
            let axes = varied(&["/a=uniform:2:4", "/b=normal:10:2"]);
            Designs::crossed(1, &axes, Draw::Latin(N), Some(seed)).expect("designs")
        };
        let designs = of(7);
        let mut strata: Vec<usize> = column(&designs, 0)
            .iter()
            .map(|x| ((x - 2.0) / 2.0 * N as f64) as usize)
            .collect();
        strata.sort_unstable();
        assert_eq!(strata, (0..N).collect::<Vec<_>>());
        let mut normal = column(&designs, 1);
        normal.sort_by(f64::total_cmp);
        for (k, x) in normal.iter().enumerate() {
            let low = if k == 0 {
                f64::NEG_INFINITY
            } else {
                10.0 + 2.0 * quantile(k as f64 / N as f64)
            };
            let high = if k + 1 == N {
                f64::INFINITY
            } else {
                10.0 + 2.0 * quantile((k + 1) as f64 / N as f64)
            };
            assert!((low..=high).contains(x), "{x} of stratum {k}");
        }
        assert_eq!(column(&of(7), 0), column(&designs, 0));
        assert_ne!(column(&of(8), 0), column(&designs, 0));
    }

    #[test]
    fn sobol_begins_in_the_middle() {
        let axes = varied(&["/a=uniform:0:1", "/b=uniform:0:1"]);
        let designs = Designs::crossed(1, &axes, Draw::Sobol(3), None).expect("designs");
        let near = |a: Vec<f64>, b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
        assert!(near(column(&designs, 0), [0.5, 0.75, 0.25]));
        assert!(near(column(&designs, 1), [0.5, 0.25, 0.75]));
    }

    #[test]
    fn what_does_not_go_together_is_refused() {
        for (axes, draw, word) in [
            (vec!["/a=uniform:0:1"], Draw::Grid, "latin:N or sobol:N"),
            (vec!["/a=1,2"], Draw::Latin(3), "no number has a distribution"),
            (vec!["/a=1,2", "/a=3"], Draw::Grid, "varied twice"),
            (vec!["/a=1", "/a/b=3"], Draw::Grid, "contains the other"),
            (vec!["/a=lin:0:1:2000", "/b=lin:0:1:2000"], Draw::Grid, "more than"),
        ] {
            let why = Designs::crossed(1, &varied(&axes), draw, None)
                .expect_err("refused")
                .to_string();
            assert!(why.contains(word), "{why}");
        }
        for (text, word) in [
            ("/a=uniform:4:2", "not below"),
            ("/a=lin:4:2:3", "not below"),
            ("/a=log:0:2:3", "no logarithm"),
            ("/a=normal:1:0", "above 0"),
            ("/a=normal:1:nan", "not a finite number"),
            ("/a=NaN", "JSON values"),
            ("/a=", "no values"),
            ("/a_m=0.1 m", "0.1 m is 0.1 here"),
            ("/a=unifrom:1:2", "did you mean uniform"),
            ("/a=lin:1:2", "lin:LOW:HIGH:COUNT"),
            ("a=1", "starts with `/`"),
            ("/a", "pointer and its values"),
        ] {
            let why = VariedNumber::parse(text).expect_err("refused").to_string();
            assert!(why.contains(word), "{text}: {why}");
        }
    }
}
