//! Time of one section's coefficients.

mod common;

use common::paper;
use slcbeam_section::coefficients::Options;
use std::time::{Duration, Instant};

#[test]
fn a_section_takes_less_than_half_a_second() {
    for fillet in [0.0, 0.0025] {
        let section = paper(0.49, fillet);
        // The best of five: the machine may be busy.
        let run = || {
            let start = Instant::now();
            let c = section.coefficients(&Options::default()).unwrap();
            (start.elapsed(), c)
        };
        let (time, c) = (0..5).map(|_| run()).min_by_key(|r| r.0).unwrap();
        println!("fillet {fillet}: {time:?}, {} unknowns, {:?}", c.unknowns, c.errors);
        assert!(cfg!(debug_assertions) || time < Duration::from_millis(500), "{time:?}");
    }
}
