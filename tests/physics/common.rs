//! Cases, runs, and readers of their results.

use std::path::Path;

use slcbeam::case::{self, Case};
use slcbeam::run::dynamics;
use slcbeam::run::record::Memory;
use slcbeam::run::summary::{Status, Summary};

/// The paper's coupling, `--set` argument.
pub const PUBLISHED: &str =
    r#"/bladders/coupling={"published":{"slope_per_pressure_rad":0.00381467,"length_per_pressure_m":0.01}}"#;
/// Strains and areas from one potential: the reciprocal coupling, `--set` argument.
pub const RECIPROCAL: &str = r#"/bladders/coupling="reciprocal""#;
/// The reciprocal coupling with kinked slopes, `--set` argument.
pub const KINKED: &str = r#"/bladders/coupling="reciprocal_kinked""#;
/// The conservative form of the momentum balance, `--set` argument.
pub const CONSERVATIVE: &str = r#"/formulation="conservative""#;
/// The paper's form, `--set` argument.
pub const AS_PUBLISHED: &str = r#"/formulation="published""#;
/// Creeping flow in tubes, as in the paper, `--set` argument.
pub const CREEPING: &str = r#"/effects={"tube_inertia":"off","tube_losses":"off"}"#;
/// No inertia of fluid along bladders, which coarse meshes would treat as one mass, `--set` argument.
pub const STEADY: &str = r#"/effects={"bladder_inertia":"off"}"#;
/// Young's modulus of the paper's beam [Pa].
pub const E: f64 = 2e6;
/// Length of the paper's beam [m].
pub const LENGTH: f64 = 0.1;
/// Bending stiffness of the paper's beam [N m^2].
pub const EI: f64 = 0.0503885;

/// Five segments with every network element, load and damping; ends are placeholders.
pub const EVERYTHING: &str = r#"{
  "name": "everything",
  "beam": {"length_m": 0.1, "height_m": 0.0216, "width_m": 0.05, "young_modulus_pa": 2e6, "density_kg_m3": 950,
           "axial_stiffness_factor": 0.53, "bending_stiffness_factor": 0.6,
           "damping": {"axial_time_s": 2e-4, "bending_time_s": 3e-4, "drag_n_s_m2": 8}},
  "fluid": {"density_kg_m3": 1000, "viscosity_pa_s": 8.68e-4},
  "bladders": {"per_row": 5, "length_m": 0.046, "height_m": 0.0078, "width_m": 0.0078, "permeability_m4": 1.55e-12,
               "area_per_pressure_m2_per_pa": 1.75e-10,
               "area_per_moment_m2_per_n_m": {"opening": 3.75e-6, "closing": 6.54e-6},
               "area_per_force_m2_per_n": {"tension": 3.64e-8, "compression": 6.31e-8},
               "coupling": "reciprocal", "kink_width": 0.05},
  "tubes": {"length_m": 0.02, "radius_m": 0.001, "permeability_m4": 6.72e-13},
  "network": {
    "chains": [
      {"bladders": [1, 2, 3, 4], "ends": [{"pressure_pa": {"sine": {"amplitude": 3000, "frequency_hz": 70}}}, "connected"]},
      {"bladders": [-1, -2, -3], "ends": ["connected", {"flow_m3_s": {"sine": {"amplitude": 2e-6, "frequency_hz": 90}}}]}
    ],
    "junctions": ["tee"],
    "tubes": [
      {"from": {"bladder": 4, "end": "outlet"}, "to": {"junction": "tee"},
       "opening": {"sum": [0.5, {"sine": {"amplitude": 0.4, "frequency_hz": 60}}]}},
      {"from": {"junction": "tee"}, "to": {"bladder": 5, "end": "inlet"}, "length_m": 0.01},
      {"from": {"junction": "tee"}, "to": {"bladder": -1, "end": "inlet"}, "length_m": 0.03}
    ],
    "turbines": [
      {"from": {"bladder": 5, "end": "outlet"}, "to": {"bladder": -5, "end": "inlet"}, "conductance": {"m3_s_pa": 1e-8}},
      {"from": {"bladder": -5, "end": "outlet"}, "to": {"bladder": -4, "end": "inlet"}, "conductance": {"m3_s_pa": 1e-8},
       "rectifier": {"check_valves": {"cracking_pressure_pa": 10, "forward_conductance_m3_s_pa": 2e-8,
                                      "reverse_conductance_m3_s_pa": 1e-10, "smoothing_pa": 20}}}
    ]
  },
  "loads": [
    {"force_x_n_m": {"signal": {"sine": {"amplitude": 200, "frequency_hz": 50}}, "profile": {"polynomial": {"coefficients": [0, 1]}}}},
    {"force_z_n_m": {"signal": {"sine": {"amplitude": 300, "frequency_hz": 40}}}},
    {"moment_z_n": {"signal": {"sine": {"amplitude": 3, "frequency_hz": 45}}, "profile": {"cosine": {"waves": 1}}}},
    {"moment_x_n": {"signal": {"sine": {"amplitude": 2, "frequency_hz": 55}}}},
    {"gravity": {"x_m_s2": 3, "z_m_s2": -9.81}}
  ],
  "ends": {"root": "clamped", "tip": "free"},
  "start": {"u1_rate_m_s": {"polynomial": {"coefficients": [0, 0, 0.3]}}, "pressures": [{"bladders": [2, -4], "pressure_pa": 1000}]},
  "time": {"end_s": 0.004, "output_interval_s": 1e-4},
  "solver": {"rtol": 1e-11, "max_order": 5}
}"#;

/// A run that reached its end.
pub struct Run {
    pub summary: Summary,
    pub memory: Memory,
}

/// A shipped case with changes.
pub fn shipped<S: AsRef<str>>(name: &str, sets: &[S]) -> Case {
    let path = format!("cases/{name}.json");
    let sets: Vec<String> = sets.iter().map(|s| s.as_ref().to_string()).collect();
    case::load(Path::new(&path), &sets).unwrap_or_else(|e| panic!("{name} with {sets:?}: {}", told(&e)))
}

/// A case from its text, with changes.
pub fn written<S: AsRef<str>>(text: &str, sets: &[S]) -> Case {
    let sets: Vec<String> = sets.iter().map(|s| s.as_ref().to_string()).collect();
    case::parse(text, Path::new("test.json"), Path::new("cases"), &sets)
        .unwrap_or_else(|e| panic!("{}\nwith {sets:?}: {}", text, told(&e)))
}

fn told(error: &slcbeam::error::Error) -> String {
    match error {
        slcbeam::error::Error::Case(fault) => format!("{:#?}", fault.violations),
        other => other.to_string(),
    }
}

/// Runs a case to its end.
pub fn run(case: &Case) -> Run {
    let mut memory = Memory::default();
    let outcome = dynamics::run(case, &mut memory).unwrap();
    assert_eq!(
        outcome.summary.status,
        Status::Finished,
        "{}: {:?}",
        case.name,
        outcome.summary.reason
    );
    Run {
        summary: outcome.summary,
        memory,
    }
}

/// Runs a shipped case with changes.
pub fn run_shipped<S: AsRef<str>>(name: &str, sets: &[S]) -> Run {
    run(&shipped(name, sets))
}

impl Run {
    /// A column of the history.
    pub fn column(&self, name: &str) -> Vec<f64> {
        self.memory.column(name).unwrap_or_else(|| panic!("no column {name}"))
    }

    /// The last value of a column.
    pub fn last(&self, name: &str) -> f64 {
        *self.column(name).last().unwrap()
    }

    /// Increment of a column over the last `window` seconds.
    pub fn gained(&self, name: &str, window: f64) -> f64 {
        let (t, values) = (self.column("t"), self.column(name));
        let end = *t.last().unwrap();
        let first = t.iter().position(|t| *t >= end - window * (1.0 + 1e-9)).unwrap();
        values.last().unwrap() - values[first]
    }

    /// A field, an array for each recorded time.
    pub fn field(&self, name: &str) -> &[Vec<f64>] {
        self.memory.field(name).unwrap_or_else(|| panic!("no field {name}"))
    }

    /// An axis of the fields.
    pub fn axis(&self, name: &str) -> &[f64] {
        let axis = self.memory.header.axes.iter().find(|a| a.name == name);
        &axis.unwrap_or_else(|| panic!("no axis {name}")).values
    }

    /// Mean pressure of one bladder `R j` at every recorded time [Pa].
    pub fn bladder_pressure(&self, bladder: i64) -> Vec<f64> {
        let cells: Vec<usize> = (0..self.axis("bladder").len())
            .filter(|&k| self.axis("bladder")[k] == bladder as f64)
            .collect();
        let mean = |row: &Vec<f64>| cells.iter().map(|&k| row[k]).sum::<f64>() / cells.len() as f64;
        self.field("pressure_pa").iter().map(mean).collect()
    }

    /// Largest absolute value of a quantity over the run.
    pub fn max_abs(&self, quantity: &str) -> f64 {
        self.summary.quantities[quantity].max_abs.unwrap()
    }

    /// Largest absolute value of a quantity in the window at the end.
    pub fn window_max_abs(&self, quantity: &str) -> f64 {
        self.summary.quantities[quantity].window_max_abs.unwrap()
    }
}

/// Largest absolute value.
pub fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| m.max(v.abs()))
}

/// Formats numbers with three digits each.
pub fn listed(values: &[f64]) -> String {
    let texts: Vec<String> = values.iter().map(|v| format!("{v:.2e}")).collect();
    texts.join(" ")
}

/// Largest difference of two series over the largest value of the second.
pub fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let difference: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    largest(&difference) / largest(b)
}

/// Fails unless `value` is within `relative` of `expected`.
pub fn within(what: &str, value: f64, expected: f64, relative: f64) {
    let error = value / expected - 1.0;
    println!("{what}: {value:.6e}, expected {expected:.6e}, off by {error:.1e}");
    assert!(error.abs() <= relative, "{what}: {value} is not {expected}");
}
