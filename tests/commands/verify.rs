//! Exact results of beam and network theory, row by row through the function that `slcbeam verify` prints.
//!
//! Every row carries its own source, goal and reason for its tolerance, which the command prints; here each group repeats
//! what it is about. Where three meshes are computed, second order (1.8 to 2.2) and the limit are required as well.

use assert_cmd::Command;
use slcbeam::error::Error;
use slcbeam::study::verify::{self, ExactFigure};

/// Computes one row by its full name and requires all of its figures.
fn reproduces(name: &str) {
    let row = verify::rows()
        .into_iter()
        .find(|row| row.name == name)
        .expect("a row of this name");
    let figures = row.figures().unwrap();
    assert!(!figures.is_empty());
    for figure in figures {
        assert!(
            figure.passed(),
            "{name}: {figure:#?}\nerror {:.3e}; tolerance: {}",
            figure.error(),
            row.reason
        );
    }
}

macro_rules! rows {
    ($($test:ident: $name:literal,)*) => {
        /// Names of the rows of this group.
        pub const NAMES: &[&str] = &[$($name),*];
        $(#[test] fn $test() { super::reproduces($name) })*
    };
}

/// Source: constant curvature, `(sin k/k, (1 - cos k)/k) L`. Goal: finite rotations over any number of turns.
/// Tolerance: positions are a midpoint rule, `(k h)²/24`, twice that allowed; full turns and angles are exact.
mod roll_up_by_end_moment {
    rows! {
        quarter_circle: "end-moment-quarter",
        half_circle: "end-moment-half",
        closed_ring: "end-moment-ring",
        two_turns: "end-moment-two-turns",
    }
}

/// Source: Bisshopp & Drucker 1945; with stretch the extensible elastica, to which Exudyn's ANCFCable2D tends.
/// Goal: large deflection under a dead transverse tip load. Tolerance: twice `h²` of 160 cells; the limit 1e-6 for the
/// stretch that EA L²/EI = 1.2e8 leaves and `h⁴`.
mod bisshopp_drucker_tip_load {
    rows! {
        load_1: "tip-load-1",
        load_5: "tip-load-5",
        load_10: "tip-load-10",
        with_stretch: "tip-load-stretch",
    }
}

/// Source: Rohde 1953. Goal: large deflection under a dead uniform load, half a cell's share at each end.
/// Tolerance: three times `h²` of 160 cells; the limit 1e-6 for the nine digits given and the stretch.
mod rohde_uniform_load {
    rows! {
        load_1: "uniform-load-1",
        load_4: "uniform-load-4",
        load_10: "uniform-load-10",
    }
}

/// Source: Euler 1744, Greenhill 1881, Timoshenko & Gere 2.7. Goal: geometric stiffness and the buckled branch.
/// Tolerance: `h²` of the mesh; beyond buckling an error of the load is magnified by `4/angle²` in the angle.
mod buckling {
    rows! {
        euler: "euler-load",
        own_weight: "self-weight",
        elastica_at_20_degrees: "elastica-20-degrees",
        elastica_at_60_degrees: "elastica-60-degrees",
    }
}

/// Source: Beck 1952. Goal: follower loads, flutter instead of buckling, no growth below it.
/// Tolerance: `(π h)²` of 80 cells; the limit `(π h)⁴` of 40.
mod beck_follower_load {
    rows! {
        flutter: "beck-flutter",
        bounded_below: "beck-below",
    }
}

/// Source: Euler-Bernoulli beam (Blevins). Goal: stiffness, mass and ends of the mesh in free vibrations.
/// Tolerance: `(β h)²/10 + β h²/2` of 64 cells; the limit `(β h)⁴`. In time the phase that the integrator loses.
mod frequencies {
    rows! {
        clamped_free_1: "frequency-clamped-free-1",
        clamped_free_2: "frequency-clamped-free-2",
        clamped_free_3: "frequency-clamped-free-3",
        clamped_free_4: "frequency-clamped-free-4",
        clamped_clamped: "frequency-clamped-clamped",
        clamped_pinned: "frequency-clamped-pinned",
        in_time: "frequency-in-time",
    }
}

/// Source: Simo & Vu-Quoc 1986; single-mode theory of parametric resonance. Goal: large overall motion with an extension
/// of 5e-5 of the radius; growth inside and none outside the principal tongue under axial base motion.
/// Tolerance: `h²` and the reference's digits; what a single mode leaves out, `(ε ω1/ω2)²`.
mod driven_motion {
    rows! {
        simo_vu_quoc_spin_up: "spin-up",
        mathieu_growth: "mathieu-inside",
        mathieu_stable: "mathieu-outside",
        tongue_edges: "floquet-tongue-edges",
        damped_growth: "floquet-damped-growth",
        drained_tongue: "floquet-drained",
    }
}

/// Source: eigenvalues of paths and rings, Kirchhoff's equations, `Σ q² R = -d/dt Σ C p²/2`. Goal: volume balance, series
/// resistances, junctions, ports, sources, turbines, energy. Tolerance: one volume a bladder makes the lumped network
/// exact: round-off for rates by modes, 1e-6 for the integrator at rtol 1e-9.
mod networks {
    rows! {
        closed_chain: "network-closed-chain",
        open_chain: "network-open-chain",
        ring: "network-ring",
        two_bladders: "network-two-bladders",
        dissipation: "network-dissipation",
        kirchhoff: "network-kirchhoff",
    }
}

/// Source: Hagen-Poiseuille and integrals of known velocity fields; White, Viscous Fluid Flow. Goal: permeabilities of
/// cross-sections, through a tube of each. Tolerance: round-off; for the square the digits given.
mod ducts {
    rows! {
        circle: "duct-circle",
        square: "duct-square",
        slot: "duct-slot",
        ellipse: "duct-ellipse",
        triangle: "duct-triangle",
    }
}

/// Source: Saint-Venant, Lame, Hagen-Poiseuille, Boussinesq, Lamb, Maxwell and Betti. Goal: the cell from which coefficients of a section are
/// computed. Tolerance: round-off where elements hold the exact field, else a thousandth on coarse meshes with an order above
/// 3.3, covered by what the meshes show of their error; symmetry to 1e-12.
mod sections {
    rows! {
        layers: "section-layers",
        patch: "section-patch",
        tube: "section-tube",
        channels: "section-channels",
        finite_strain: "section-finite-strain",
        three_dimensions: "section-three-d",
        symmetry: "section-symmetry",
    }
}

/// Goal: no row without a test.
#[test]
fn every_row_is_tested() {
    let tested = [
        roll_up_by_end_moment::NAMES,
        bisshopp_drucker_tip_load::NAMES,
        rohde_uniform_load::NAMES,
        buckling::NAMES,
        beck_follower_load::NAMES,
        frequencies::NAMES,
        driven_motion::NAMES,
        networks::NAMES,
        ducts::NAMES,
        sections::NAMES,
    ]
    .concat();
    let names: Vec<String> = verify::rows().into_iter().map(|row| row.name).collect();
    assert_eq!(names, tested);
}

/// Goal: a figure passes only within its tolerance, at second order, with its limit; not a number never does.
#[test]
fn figures_judge() {
    let figure = |computed| ExactFigure::relative("x", computed, 2.0, 0.01);
    assert!(figure(2.019).passed() && !figure(2.021).passed() && !figure(f64::NAN).passed());
    assert!(ExactFigure::absolute("x", 0.009, 0.0, 0.01).passed());
    // Errors 0.16, 0.04, 0.01: second order, limit exact.
    assert!(figure(2.01).on_meshes([2.16, 2.04, 2.01], 1e-9).passed());
    // First order.
    assert!(!figure(2.01).on_meshes([2.04, 2.02, 2.01], 1.0).passed());
    // Errors that the meshes hide, but for round-off.
    let shown = |estimate| ExactFigure {
        estimate: Some((estimate, 1e-4)),
        ..figure(2.01)
    };
    assert!(shown(0.006).passed() && !shown(0.004).passed());
    // A limit beside the exact value.
    assert!(!figure(2.011).on_meshes([2.16, 2.041, 2.011], 1e-4).passed());
}

/// Goal: part of a name chooses, an unknown one names the nearest and is a usage error.
#[test]
fn names_choose_rows() {
    let chosen = verify::choose(verify::rows(), "tip-load").unwrap();
    assert_eq!(chosen.len(), 4);
    let error = verify::choose(verify::rows(), "spinup")
        .map(|rows| rows.len())
        .unwrap_err();
    assert!(
        matches!(&error, Error::Usage(text) if text.contains("nearest is \"spin-up\"")),
        "{error}"
    );
}

/// Goal: the command prints the table or JSON, nothing on stderr off a terminal, and exits with 0; 2 for unknown names.
#[test]
fn the_command_prints() {
    let slcbeam = || Command::new(env!("CARGO_BIN_EXE_slcbeam"));
    let table = slcbeam().args(["verify", "duct-circle"]).output().unwrap();
    let text = String::from_utf8(table.stdout).unwrap();
    assert!(table.status.success() && table.stderr.is_empty());
    assert!(
        text.starts_with("name") && text.contains("pass") && text.contains("1 of 1 exact results reproduced"),
        "{text}"
    );
    let json = slcbeam().args(["verify", "duct", "--json"]).output().unwrap();
    let rows: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    assert_eq!(rows.as_array().map(Vec::len), Some(5));
    assert_eq!(rows[0]["passed"], true);
    let unknown = slcbeam().args(["verify", "nothing-like-it"]).output().unwrap();
    assert_eq!(unknown.status.code(), Some(2));
}
