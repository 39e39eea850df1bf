//! Source: issue: "total force and moment are right on every mesh"; statics of beams.
//! Goal: loads along the beam, and the start, enter the mesh by their integrals and not by samples at nodes.
//! Tolerance: rounding errors if a sum is exact on every mesh; a few per cent of the finest mesh if cells bend.

use std::f64::consts::{PI, TAU};

use proptest::prelude::*;
use slcbeam::case::Case;
use slcbeam::discrete::shapes::Cells;
use slcbeam::discrete::{System, TimeData, shapes, start};
use slcbeam::functions::SmoothTime;
use slcbeam::functions::profile::{Integrals, Profile};

use super::common::{EI, run, shipped, within};

pub fn profile(text: &str) -> Profile {
    serde_json::from_str(text).unwrap_or_else(|e| panic!("{text}: {e}"))
}

/// A quasi-static cantilever under a load of the given profile that grows within 1 s.
pub fn pressed(profile: &str, cells: usize, more: &[&str]) -> Case {
    let load =
        format!(r#"/loads=[{{"force_x_n_m":{{"signal":{{"ramp":{{"to":1,"duration_s":1}}}},"profile":{profile}}}}}]"#);
    let cells = format!("/mesh/cells_per_segment={cells}");
    let mut sets = vec![
        load.as_str(),
        r#"/effects={"solid_inertia":"off"}"#,
        r#"/beam/damping={"bending_time_s":0.001,"axial_time_s":0.001}"#,
        "/start={}",
        "/time/end_s=1.1",
        "/time/output_interval_s=0.05",
        &cells,
    ];
    sets.extend_from_slice(more);
    shipped("dry-cantilever", &sets)
}

/// A pad of the given value over 1 % of the length, with steep but continuous edges.
pub fn pad(middle: f64, value: f64) -> String {
    let (a, b) = (middle - 0.005, middle + 0.005);
    let places = [0.0, a - 1e-6, a, b, b + 1e-6, 1.0];
    format!(r#"{{"table":{{"positions":{places:?},"values":[0,0,{value},{value},0,0],"interpolation":"linear"}}}}"#)
}

/// -60 N/m on the pad beside 2 N/m everywhere.
pub fn beside(middle: f64) -> String {
    format!(r#"{{"sum":[2,{}]}}"#, pad(middle, -60.0))
}

#[test]
fn a_narrow_pad_is_right_on_every_mesh() {
    for middle in [0.5, 0.5125, 0.61] {
        let tip = |cells| run(&pressed(&beside(middle), cells, &[])).last("tip_u1");
        // 2 N/m, and -0.06 N at the place of the pad; small rotations.
        let (l, force, at) = (0.1, -60.0 * 0.001, middle * 0.1);
        let closed = 2.0 * f64::powi(l, 4) / (8.0 * EI) + force * at * at * (3.0 * l - at) / (6.0 * EI);
        let finest = tip(64);
        within(
            &format!("pad at {middle}: tip on the finest mesh"),
            finest,
            closed,
            5e-3,
        );
        for (cells, tolerance) in [(1, 0.02), (2, 0.01), (4, 0.005), (8, 0.002), (16, 0.002)] {
            within(
                &format!("tip on {cells} cells a segment"),
                tip(cells),
                finest,
                tolerance,
            );
        }
    }
}

/// Resultant force on the mesh, and its moment about the root.
fn resultants(case: &Case) -> (f64, f64) {
    let system = System::new(case).unwrap();
    let shape = &system.loads[0].shape;
    (0..system.mesh.nodes).fold((0.0, 0.0), |(force, moment), i| {
        let at_node = shape[i] * system.mesh.node_lengths[i];
        (force + at_node, moment + at_node * system.mesh.node_coordinate(i))
    })
}

#[test]
fn twenty_waves_over_ten_segments_do_not_alias() {
    for cells in [1, 2, 4, 8] {
        let (force, moment) = resultants(&pressed(r#"{"cosine":{"waves":20}}"#, cells, &[]));
        println!("{cells} cells: force {force:.1e} N, moment {moment:.1e} N m");
        assert!(force.abs() < 1e-15 && moment.abs() < 1e-16);
        let (force, moment) = resultants(&pressed(r#"{"sine":{"waves":20}}"#, cells, &[]));
        assert!(force.abs() < 1e-15);
        // ∫ x sin(40 π x) dx = -1/40π
        within("moment of a sine", moment, -0.01 / (40.0 * PI), 1e-11);
    }
}

#[test]
fn a_uniform_load_stays_exactly_what_it_was() {
    for text in [
        "1",
        r#"{"sum":[0.25,0.75]}"#,
        r#"{"polynomial":{"coefficients":[1,0]}}"#,
        r#"{"linear":[1,1]}"#,
    ] {
        for cells in [1, 3, 40] {
            let values = [shapes::at_nodes, shapes::in_cells, shapes::nearest]
                .map(|on| on(&profile(text), &Cells::equal(cells)));
            assert!(values.iter().flatten().all(|value| *value == 1.0), "{text}");
        }
    }
}

pub fn profiles() -> impl Strategy<Value = Profile> {
    let wave = (0.1..3.0, 0.0..60.0, -3.0..3.0)
        .prop_map(|(a, n, p)| format!(r#"{{"amplitude":{a},"waves":{n},"phase_rad":{p}}}"#));
    let table = (0.0..0.9, 1e-5..0.1, prop::collection::vec(-2.0..2.0, 4), any::<bool>()).prop_map(
        |(a, w, v, cubic): (f64, f64, Vec<f64>, bool)| {
            let places = [a, a + 0.1 * w, a + 0.9 * w, a + w];
            let kind = if cubic { "cubic" } else { "linear" };
            format!(r#"{{"table":{{"positions":{places:?},"values":{v:?},"interpolation":"{kind}"}}}}"#)
        },
    );
    let leaf = prop_oneof![
        wave.clone().prop_map(|w| format!(r#"{{"cosine":{w}}}"#)),
        wave.prop_map(|w| format!(r#"{{"sine":{w}}}"#)),
        table,
        prop::array::uniform2(-2.0..2.0).prop_map(|ends| format!(r#"{{"linear":{ends:?}}}"#)),
        prop::collection::vec(-2.0..2.0, 1..7).prop_map(|c| format!(r#"{{"polynomial":{{"coefficients":{c:?}}}}}"#)),
    ];
    let some = leaf.prop_recursive(3, 8, 3, |part| {
        prop_oneof![
            prop::collection::vec(part.clone(), 1..4).prop_map(|p| format!(r#"{{"sum":[{}]}}"#, p.join(","))),
            prop::collection::vec(part, 1..3).prop_map(|p| format!(r#"{{"product":[{}]}}"#, p.join(","))),
        ]
    });
    some.prop_map(|text| profile(&text))
}

/// `∫ f`, `∫ f x` and `∫ |f|` over [0, 1], by Simpson's rule with enough parts between knots to be practically exact.
fn by_simpson(f: &Profile) -> [f64; 3] {
    let integrals = Integrals::new(f);
    let mut knots = vec![0.0];
    knots.extend_from_slice(integrals.knots_in(0.0, 1.0));
    knots.push(1.0);
    let mut sum = [0.0; 3];
    for ends in knots.windows(2) {
        let (a, b) = (ends[0], ends[1]);
        let parts = (400.0 * (1.0 + integrals.half_waves(b - a))).ceil();
        let h = (b - a) / parts;
        for k in 0..parts as usize {
            let x = a + h * k as f64;
            for (at, weight) in [(0.0, 1.0), (0.5, 4.0), (1.0, 1.0)] {
                // Inside, where the ends of the piece belong to it.
                let x = (x + at * h).clamp(a + 1e-13 * (b - a), b - 1e-13 * (b - a));
                let value = f.value(x) * weight * h / 6.0;
                sum = [sum[0] + value, sum[1] + value * x, sum[2] + value.abs()];
            }
        }
    }
    sum
}

/// Cells of these lengths, in units of their sum.
fn unequal(lengths: &[f64]) -> Cells {
    let total: f64 = lengths.iter().sum();
    let ends = lengths.iter().scan(0.0, |end, length| {
        *end += length / total;
        Some(*end)
    });
    Cells {
        nodes: std::iter::once(0.0).chain(ends).collect(),
        lengths: lengths.iter().map(|length| length / total).collect(),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn random_loads_have_their_force_and_moment_on_every_mesh(f in profiles(), lengths in prop::collection::vec(0.2..5.0_f64, 1..70), equal: bool) {
        let [force, moment, size] = by_simpson(&f);
        let cells = lengths.len();
        let mesh = if equal { Cells::equal(cells) } else { unequal(&lengths) };
        let nodes = shapes::at_nodes(&f, &mesh);
        let h = |cell: usize| mesh.lengths.get(cell).copied().unwrap_or(0.0);
        let length = |i: usize| 0.5 * (h(i) + i.checked_sub(1).map_or(0.0, h));
        let total: f64 = nodes.iter().enumerate().map(|(i, v)| v * length(i)).sum();
        let turning: f64 = nodes.iter().enumerate().map(|(i, v)| v * length(i) * mesh.nodes[i]).sum();
        let couples: f64 = shapes::in_cells(&f, &mesh).iter().enumerate().map(|(c, v)| v * h(c)).sum();
        let velocity = shapes::nearest(&f, &mesh);
        let momentum: f64 = velocity.iter().enumerate().map(|(i, v)| v * length(i)).sum();
        for (what, found, exact) in [("force", total, force), ("moment", turning, moment), ("couple", couples, force), ("momentum", momentum, force)] {
            prop_assert!((found - exact).abs() <= 1e-9 * size + 1e-300, "{what} on {cells} cells: {found}, exact {exact}, size {size}");
        }
        // meshes agree with each other to rounding errors, independent of the error of Simpson's rule
        let one = shapes::at_nodes(&f, &Cells::equal(1));
        prop_assert!((total - 0.5 * (one[0] + one[1])).abs() <= 1e-13 * size.max(1e-300) * cells as f64);
        prop_assert!((turning - 0.5 * one[1]).abs() <= 1e-13 * size.max(1e-300) * cells as f64);
    }
}

/// [E46]: force and moment of a shape equal those of its integrals, on one cell and on many.
#[test]
fn a_load_has_its_force_and_moment_on_every_mesh() {
    let text = r#"{"product":[{"polynomial":{"coefficients":[0,0,1]}},{"polynomial":{"coefficients":[0,1]}}]}"#;
    for cells in [1, 2, 5, 40] {
        let (force, moment) = resultants(&pressed(text, 1, &[&format!("/mesh/segments={cells}")]));
        within("force of x^3", force, 0.1 / 4.0, 1e-13);
        within("moment of x^3", moment, 0.01 / 5.0, 1e-13);
    }
}

/// Goal: a billion waves cost no more than one, alone or in a product.
#[test]
fn very_many_waves_are_integrated_in_closed_form() {
    for waves in [1e3, 12_345.25, 1e7 + 0.25] {
        let k = TAU * waves;
        let sine = profile(&format!(r#"{{"sine":{{"waves":{waves}}}}}"#));
        let [whole, first, _] = Integrals::new(&sine).moments(0.0, 1.0);
        let exact = (1.0 - k.cos()) / k;
        let moment = k.sin() / (k * k) - k.cos() / k;
        assert!((whole - exact).abs() < 1e-14, "{waves}: {whole} instead of {exact}");
        assert!((first - moment).abs() < 1e-14, "{waves}: {first} instead of {moment}");
        // x sin² = x/2 - x cos(2 k x)/2
        let square = profile(&format!(
            r#"{{"product":[{{"sine":{{"waves":{waves}}}}},{{"polynomial":{{"coefficients":[0,1]}}}},{{"sine":{{"waves":{waves}}}}}]}}"#
        ));
        let mean = Integrals::new(&square).moments(0.0, 1.0)[0];
        let k = 2.0 * k;
        let exact = 0.25 - 0.5 * (k.sin() / k + (k.cos() - 1.0) / (k * k));
        assert!((mean - exact).abs() < 1e-13, "{waves}: {mean} instead of {exact}");
    }
}

#[test]
fn straight_velocities_stay_straight_and_jumps_do_not_overshoot() {
    let line = profile(r#"{"polynomial":{"coefficients":[0.3,-2]}}"#);
    let curve = profile(r#"{"polynomial":{"coefficients":[0,0,1]}}"#);
    let step = profile(r#"{"table":{"positions":[0.4999,0.5001],"values":[0,1],"interpolation":"linear"}}"#);
    let mut errors = vec![];
    for cells in [1, 2, 10, 20, 40] {
        let lengths: Vec<f64> = (0..cells).map(|c| 1.0 + 2.0 * (c % 3) as f64).collect();
        let (equal, unequal) = (Cells::equal(cells), unequal(&lengths));
        for mesh in [&equal, &unequal] {
            let nearest = shapes::nearest(&line, mesh);
            for (place, v) in mesh.nodes.iter().zip(&nearest) {
                assert!((v - (0.3 - 2.0 * place)).abs() < 1e-13);
            }
        }
        assert!(
            shapes::nearest(&step, &unequal)
                .iter()
                .all(|v| (-1e-14..=1.0 + 1e-14).contains(v))
        );
        let found = shapes::nearest(&curve, &equal);
        let off = |i: usize| (found[i] - (i as f64 / cells as f64).powi(2)).abs();
        errors.push((0..=cells).map(off).fold(0.0, f64::max));
    }
    println!(
        "errors of a parabola on 10, 20, 40 cells: {:.1e} {:.1e} {:.1e}",
        errors[2], errors[3], errors[4]
    );
    assert!(errors[2] / errors[3] > 3.5 && errors[3] / errors[4] > 3.5);
}

/// Goal: a start velocity has the same momentum on the mesh.
#[test]
fn a_start_has_its_momentum_on_every_mesh() {
    let velocity = format!("/start={{\"u1_rate_m_s\":{}}}", pad(0.61, 1.0));
    for cells in [1, 2, 4, 8] {
        let cells = format!("/mesh/cells_per_segment={cells}");
        let case = shipped("dry-cantilever", &[velocity.as_str(), &cells]);
        let system = System::new(&case).unwrap();
        let mut now = TimeData::new(&system);
        now.update(&system, SmoothTime { t: 0.0, within: 0.0 });
        let y = start::state(&system, &case, &now);
        let l = &system.layout;
        let velocities = l.lines[0].unknowns().filter_map(|(node, _, v)| Some((node, v?)));
        let sum: f64 = velocities
            .map(|(node, v)| y[v] * l.scales[v] * system.mesh.node_lengths[node])
            .sum();
        within("∫ v", sum, 0.1 * (0.01 + 1e-6), 1e-12);
    }
}

/// Goal: a start pressure along a bladder gives the volume of its mean.
#[test]
fn a_start_has_its_volume_on_any_number_of_cells() {
    let areas = |pressure: &str, cells: usize| {
        let pressure = format!(r#"/start/pressures=[{{"bladders":[1,-3],"pressure_pa":{pressure}}}]"#);
        let cells = format!("/mesh/cells_per_bladder={cells}");
        let case = shipped("wiring-2", &[pressure.as_str(), r#"/effects="full""#, &cells]);
        start::areas(&System::new(&case).unwrap(), &case)
    };
    let mean = 500.0 * (TAU * 0.3).sin() / (TAU * 0.3);
    let uniform = areas(&format!("{mean}"), 1);
    for cells in [1, 2, 3, 7] {
        let found = areas(r#"{"cosine":{"amplitude":500,"waves":0.3}}"#, cells);
        for bladder in [0, 12] {
            let sum: f64 = found[bladder * cells..(bladder + 1) * cells].iter().sum();
            within("mean area", sum / cells as f64, uniform[bladder], 1e-12);
        }
    }
}
