//! Source: heat equation on chains and rings, Kirchhoff's laws (`docs/exact-results.md` section 3).
//! Goal: exact decay rates of networks of equal bladders C and tubes R; steady networks against a dense solve.
//! The area of bladders depends on pressure alone here, so that the beam stays at rest. With one cell per bladder, C and R are exact: C =
//! a_p l_b, R = one tube and two half bladders. The remaining error is that in time: at rtol 1e-9, 1e-6.

use nalgebra::{DMatrix, DVector};

use super::common::{run, within, written};

const PI: f64 = std::f64::consts::PI;
const MU: f64 = 8.68e-4;
/// Resistance of a bladder [Pa s/m^3].
const BLADDER: f64 = MU * 0.046 / 1.55e-12;
/// Resistance of a tube of 0.020 m [Pa s/m^3].
const TUBE: f64 = MU * 0.02 / 6.72e-13;
/// Compliance of a bladder [m^3/Pa].
const C: f64 = 1.75e-10 * 0.046;

/// A beam at rest with a network, `network` and `start` as JSON.
fn still(per_row: usize, network: &str, pressures: &[(i64, f64)], end: f64) -> slcbeam::case::Case {
    let start: Vec<String> = pressures
        .iter()
        .map(|(b, p)| format!(r#"{{"bladders":[{b}],"pressure_pa":{p}}}"#))
        .collect();
    let text = format!(
        r#"{{"name":"network",
        "beam":{{"length_m":0.1,"height_m":0.0216,"width_m":0.05,"young_modulus_pa":2e6,"density_kg_m3":950,
            "damping":{{"bending_time_s":0.001,"axial_time_s":0.001}}}},
        "fluid":{{"density_kg_m3":1000,"viscosity_pa_s":{MU}}},
        "bladders":{{"per_row":{per_row},"length_m":0.046,"height_m":0.0078,"width_m":0.0078,"permeability_m4":1.55e-12,
            "area_per_pressure_m2_per_pa":1.75e-10,
            "area_per_moment_m2_per_n_m":{{"opening":0,"closing":0}},
            "area_per_force_m2_per_n":{{"tension":0,"compression":0}}}},
        "tubes":{{"length_m":0.02,"radius_m":0.001,"permeability_m4":6.72e-13}},
        "network":{network},
        "ends":{{"root":"clamped","tip":"free"}},
        "start":{{"pressures":[{}]}},
        "effects":{{"solid_inertia":"off","tube_inertia":"off","tube_losses":"off"}},
        "mesh":{{"cells_per_segment":1,"cells_per_bladder":1}},
        "time":{{"end_s":{end}}},
        "solver":{{"rtol":1e-9}}}}"#,
        start.join(",")
    );
    written::<&str>(&text, &[])
}

/// Bladders 1 to `n` start in the shape of a mode; asserts that it persists, and checks its decay rate [1/s] and the dissipated energy.
fn decay(what: &str, n: usize, network: &str, mode: impl Fn(usize) -> f64, rate: f64) {
    let pressures: Vec<(i64, f64)> = (1..=n).map(|j| (j as i64, 1000.0 * mode(j))).collect();
    let case = still(n, network, &pressures, 2.0 / rate);
    let run = run(&case);
    let expected = (-2.0_f64).exp();
    let mut worst = 0.0_f64;
    for (bladder, start) in &pressures {
        let end = *run.bladder_pressure(*bladder).last().unwrap();
        worst = worst.max((end - expected * start).abs() / 1000.0);
    }
    let (strongest, start) = pressures.iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).unwrap();
    let end = *run.bladder_pressure(*strongest).last().unwrap();
    let measured = -(end / start).ln() * 0.5 * rate;
    println!("{what}: rate {measured:.6} 1/s, exact {rate:.6}; worst bladder off by {worst:.1e} of the start");
    assert!((measured / rate - 1.0).abs() < 1e-6 && worst < 1e-6, "{what}");

    // Dissipation: sum q^2 R = -d/dt sum C p^2/2, closed networks.
    let energy = |p: &dyn Fn(&(i64, f64)) -> f64| pressures.iter().map(|x| 0.5 * C * p(x).powi(2)).sum::<f64>();
    let lost = energy(&|x| x.1) * (1.0 - expected * expected);
    let dissipated = run.last("dissipated_bladders") + run.last("dissipated_tubes") - run.last("work_ports");
    within(&format!("{what}: dissipated [J]"), dissipated, lost, 1e-6);
    assert!(run.summary.balances.closed_volume_residual_relative < 1e-12);
    assert_eq!(run.max_abs("tip_u1_m"), 0.0);
}

#[test]
fn two_bladders_meet_with_half_their_time() {
    let network = r#"{"tubes":[{"from":{"bladder":1,"end":"outlet"},"to":{"bladder":2,"end":"inlet"}}]}"#;
    let tau = 0.5 * (BLADDER + TUBE) * C;
    println!("R C/2 = {tau:.6e} s");
    decay("two bladders", 2, network, |j| 3.0 - 2.0 * j as f64, 1.0 / tau);
}

/// `(4/RC) sin^2(k pi/2N)`, mode `cos(k pi (j - 1/2)/N)`.
#[test]
fn a_closed_chain_decays_as_its_modes() {
    let network = r#"{"chains":[{"bladders":[1,2,3,4,5,6,7,8,9,10]}]}"#;
    for k in [1, 2, 5, 9] {
        let turn = PI * f64::from(k) / 20.0;
        let rate = 4.0 / ((BLADDER + TUBE) * C) * turn.sin().powi(2);
        let mode = |j: usize| (turn * (2 * j - 1) as f64).cos();
        decay(&format!("closed chain, mode {k}"), 10, network, mode, rate);
    }
}

/// `(4/RC) sin^2((2k - 1) pi/(2 (2N + 1)))`, open at the end of bladder 10: half a bladder and a tube, together one R, lead to a junction
/// at zero pressure.
#[test]
fn a_chain_with_one_open_end_decays_as_its_modes() {
    let length = 0.02 * (TUBE + 0.5 * BLADDER) / TUBE;
    let network = format!(
        r#"{{"chains":[{{"bladders":[1,2,3,4,5,6,7,8,9,10],"ends":["sealed","connected"]}}],"junctions":["out"],
        "tubes":[{{"from":{{"bladder":10,"end":"outlet"}},"to":{{"junction":"out"}},"length_m":{length}}}],
        "ports":[{{"at":{{"junction":"out"}},"pressure_pa":0}}]}}"#
    );
    for k in [1, 2, 6] {
        let turn = PI * f64::from(2 * k - 1) / 42.0;
        let rate = 4.0 / ((BLADDER + TUBE) * C) * turn.sin().powi(2);
        let mode = |j: usize| (turn * (2 * j - 1) as f64).cos();
        decay(&format!("open chain, mode {k}"), 10, &network, mode, rate);
    }
}

/// `(4/RC) sin^2(k pi/N)`, mode `cos(2 pi k j/N)`.
#[test]
fn a_ring_decays_as_its_modes() {
    let network = r#"{"chains":[{"bladders":[1,2,3,4,5,6,7,8,9,10],"ends":["connected","connected"]}],
        "tubes":[{"from":{"bladder":10,"end":"outlet"},"to":{"bladder":1,"end":"inlet"}}]}"#;
    for k in [1, 3, 5] {
        let turn = PI * f64::from(k) / 10.0;
        let rate = 4.0 / ((BLADDER + TUBE) * C) * turn.sin().powi(2);
        let mode = |j: usize| (2.0 * turn * j as f64).cos();
        decay(&format!("ring, mode {k}"), 10, network, mode, rate);
    }
}

/// Node of the resistor network: a bladder's middle, inlet and outlet, or one of two junctions.
#[derive(Clone, Copy)]
enum Point {
    Middle(usize),
    Inlet(usize),
    Outlet(usize),
    Tee(usize),
}

impl Point {
    const BLADDERS: usize = 6;

    fn index(self) -> usize {
        match self {
            Self::Middle(b) => b - 1,
            Self::Inlet(b) => Self::BLADDERS + b - 1,
            Self::Outlet(b) => 2 * Self::BLADDERS + b - 1,
            Self::Tee(j) => 3 * Self::BLADDERS + j,
        }
    }

    /// JSON form in a case; bladders 4 to 6 are the lower row's 1 to 3.
    fn json(self) -> String {
        let label = |b: usize| if b <= 3 { b as i64 } else { -(b as i64 - 3) };
        match self {
            Self::Inlet(b) => format!(r#"{{"bladder":{},"end":"inlet"}}"#, label(b)),
            Self::Outlet(b) => format!(r#"{{"bladder":{},"end":"outlet"}}"#, label(b)),
            Self::Tee(j) => format!(r#"{{"junction":"tee-{j}"}}"#),
            Self::Middle(_) => unreachable!("nothing attaches to the middle of a bladder"),
        }
    }
}

/// Goal: six bladders, two junctions, nine tubes (three of them meet at one bladder's end, one is half closed), a turbine, two pressure
/// ports and a flow port agree with a direct solution of Kirchhoff's equations at all nodes. After fifteen times the slowest time constant,
/// the state is steady to 1e-6.
#[test]
fn a_steady_network_obeys_kirchhoff() {
    use Point::{Inlet, Middle, Outlet, Tee};
    let tubes = [
        (Outlet(1), Tee(0), 0.02, 1.0),
        (Tee(0), Inlet(2), 0.01, 1.0),
        (Tee(0), Inlet(4), 0.05, 1.0),
        (Outlet(2), Inlet(3), 0.03, 0.5),
        (Outlet(2), Tee(1), 0.02, 1.0),
        (Outlet(4), Outlet(2), 0.04, 1.0),
        (Tee(1), Inlet(5), 0.02, 1.0),
        (Tee(1), Tee(0), 0.07, 1.0),
        (Outlet(5), Inlet(6), 0.02, 1.0),
    ];
    let turbine = (Outlet(3), Inlet(6), 1e-8);
    let ports = [(Inlet(1), 5000.0), (Outlet(6), -2000.0)];
    let (pump, flow) = (Outlet(5), 3e-6);

    let tube_texts: Vec<String> = tubes
        .iter()
        .map(|(a, b, length, opening)| {
            format!(
                r#"{{"from":{},"to":{},"length_m":{length},"opening":{opening}}}"#,
                a.json(),
                b.json()
            )
        })
        .collect();
    let network = format!(
        r#"{{"junctions":["tee-0","tee-1"],"tubes":[{}],
        "turbines":[{{"from":{},"to":{},"conductance":{{"m3_s_pa":{}}}}}],
        "ports":[{{"at":{},"pressure_pa":5000}},{{"at":{},"pressure_pa":-2000}},{{"at":{},"flow_m3_s":3e-6}}]}}"#,
        tube_texts.join(","),
        turbine.0.json(),
        turbine.1.json(),
        turbine.2,
        ports[0].0.json(),
        ports[1].0.json(),
        pump.json(),
    );
    let run = run(&still(3, &network, &[], 0.02));

    // all conductances with their kind: 0 bladders, 1 tubes, 2 turbine
    let mut branches: Vec<(Point, Point, f64, usize)> = vec![];
    for b in 1..=Point::BLADDERS {
        branches.push((Inlet(b), Middle(b), 2.0 / BLADDER, 0));
        branches.push((Middle(b), Outlet(b), 2.0 / BLADDER, 0));
    }
    for (a, b, length, opening) in tubes {
        branches.push((a, b, opening * 0.02 / (length * TUBE), 1));
    }
    branches.push((turbine.0, turbine.1, turbine.2, 2));
    let n = 3 * Point::BLADDERS + 2;
    let (mut matrix, mut right) = (DMatrix::<f64>::zeros(n, n), DVector::<f64>::zeros(n));
    for (a, b, g, _) in &branches {
        for (i, j) in [(a.index(), b.index()), (b.index(), a.index())] {
            matrix[(i, i)] += g;
            matrix[(i, j)] -= g;
        }
    }
    right[pump.index()] += flow;
    for (point, pressure) in ports {
        matrix.row_mut(point.index()).fill(0.0);
        matrix[(point.index(), point.index())] = 1.0;
        right[point.index()] = pressure;
    }
    let p = matrix.lu().solve(&right).unwrap();

    for b in 1..=Point::BLADDERS {
        let label = if b <= 3 { b as i64 } else { -(b as i64 - 3) };
        let measured = *run.bladder_pressure(label).last().unwrap();
        within(&format!("pressure of bladder {label} [Pa]"), measured, p[b - 1], 1e-6);
    }
    let mut power = [0.0; 3];
    for (a, b, g, kind) in &branches {
        power[*kind] += g * (p[a.index()] - p[b.index()]).powi(2);
    }
    let window = 0.002;
    for (k, column) in ["dissipated_bladders", "dissipated_tubes", "harvested"]
        .into_iter()
        .enumerate()
    {
        within(
            &format!("{column} [W]"),
            run.gained(column, window) / window,
            power[k],
            1e-6,
        );
    }
    within(
        "work of the ports [W]",
        run.gained("work_ports", window) / window,
        power.iter().sum(),
        1e-6,
    );
}

/// Goal: the bladders of a network without other ports contain exactly the volume that a pump injects, the integral of its flow to the
/// integration error. The history agrees.
#[test]
fn what_ports_let_in_is_told_and_stored() {
    let network = r#"{"chains":[{"bladders":[1,2,3],"ends":["connected","sealed"]}],"ports":[{"at":{"bladder":1,"end":"inlet"},
        "flow_m3_s":{"sine":{"amplitude":3e-6,"frequency_hz":2,"phase_rad":1.5707963267948966}}}]}"#;
    let run = run(&still(3, network, &[], 0.33));
    let held: Vec<f64> = run
        .field("area_change_m2")
        .iter()
        .map(|a| 0.046 * a.iter().sum::<f64>())
        .collect();
    let pumped = 3e-6 * (4.0 * PI * 0.33).sin() / (4.0 * PI);
    within("held [m^3]", *held.last().unwrap(), pumped, 1e-6);
    within("let in [m^3]", run.last("injected_volume"), pumped, 1e-6);
    within(
        "flow [m^3/s]",
        run.last("port_flow"),
        3e-6 * (4.0 * PI * 0.33).cos(),
        1e-6,
    );
}
