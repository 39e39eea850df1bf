//! Problems for all peers: the beam without its ledger, its initial state, and its readings.

use slcbeam::case::{self, Case};
use slcbeam::dae::{BeamDae, Dae, EvaluationError, Seeds, RotatedVectors};
use slcbeam::discrete::{System, start};
use slcbeam::integrate::start::{StartOptions, consistent_start};
use slcbeam::model::AreaLaw;
use slcbeam::numerics::Planar;
use slcbeam::run::max_step::StepLimits;
use slcbeam::sparse::Pattern;

/// Equations of the beam without the energy ledger.
pub struct Bare(pub BeamDae);

impl Dae for Bare {
    fn len(&self) -> usize {
        self.0.len()
    }
    fn differential(&self) -> &[bool] {
        self.0.differential()
    }
    fn pattern(&self) -> &Pattern {
        self.0.pattern()
    }
    fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), EvaluationError> {
        self.0.enter_smooth_interval(t);
        self.0.residual(t, y, yp, r)
    }
    fn jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        seeds: Seeds<'_>,
        values: &mut [f64],
    ) -> Result<(), EvaluationError> {
        self.0.enter_smooth_interval(t);
        self.0.jacobian(t, y, yp, seeds, values)
    }
    fn vectors(&self) -> Vec<RotatedVectors> {
        self.0.vectors()
    }
    fn directions(&self, out: &mut [Planar<f64>]) {
        self.0.directions(out);
    }
    fn name(&self, unknown: usize) -> String {
        self.0.name(unknown)
    }
}

/// Position of the pressure of the last cell of the upper row among the unknowns.
#[derive(Clone, Debug)]
pub struct PressureAt {
    pub area: usize,
    pub moment: Option<usize>,
    pub force: Option<usize>,
    pub law: AreaLaw,
}

/// Readings of a state: tip deflection [m] and pressure at the tip end of the upper row [Pa].
#[derive(Clone, Debug)]
pub struct Readings {
    pub tip: usize,
    pub pressure: Option<PressureAt>,
    scales: Vec<f64>,
}

impl Readings {
    fn new(system: &System) -> Self {
        let l = &system.layout;
        let across = &l.lines[0];
        let pressure = system
            .model
            .wet
            .as_ref()
            .zip(system.fluid.as_ref())
            .map(|(wet, fluid)| {
                let bladder = wet.per_row - 1;
                let place = fluid
                    .flowing
                    .iter()
                    .position(|&b| b == bladder)
                    .expect("its area is unknown");
                let last = |of: &std::ops::Range<usize>| of.clone().next_back();
                PressureAt {
                    area: l.network.area.start + (place + 1) * fluid.cells_per_bladder - 1,
                    moment: last(&l.coupling.mean_moment),
                    force: last(&l.coupling.mean_force),
                    law: wet.area[0],
                }
            });
        Self {
            tip: across.u.end - 1,
            pressure,
            scales: l.scales.clone(),
        }
    }

    /// Readings from scaled unknowns; the pressure is 0 without fluid.
    pub fn read(&self, y: &[f64]) -> [f64; 2] {
        let si = |k: usize| y[k] * self.scales[k];
        let pressure = self.pressure.as_ref().map_or(0.0, |at| {
            let law = &at.law;
            let of = |k: Option<usize>| k.map_or(0.0, si);
            law.pressure(
                si(at.area),
                law.of_force(of(at.force)) + law.of_moment(of(at.moment), 1.0),
            )
        });
        [si(self.tip), pressure]
    }
}

/// A case and its consistent start.
pub struct Scene {
    pub case: Case,
    pub y: Vec<f64>,
    pub yp: Vec<f64>,
    pub times: Vec<f64>,
    pub readings: Readings,
    pub largest_step: f64,
    equations: BeamDae,
}

/// A run: readings at the output times, number of steps, and seconds without setup of the equations.
#[derive(Clone, Debug, Default)]
pub struct Ran {
    pub seconds: f64,
    pub readings: Vec<[f64; 2]>,
    pub steps: usize,
}

/// Root folder of the repository.
pub fn root() -> std::path::PathBuf {
    concat!(env!("CARGO_MANIFEST_DIR"), "/../..").into()
}

/// The case of a scene. It omits rotary inertia, so that `F(t, y, y') = M y' - f(t, y)` with a constant diagonal `M`, as most peers
/// require. `name:cells` sets the cells per segment, `name*segments` that number of segments with one cell, a final `/4` fourth order,
/// `name@end` the end time. `dry-cantilever-sheared` has shear and rotary inertia; `swing` is the dry cantilever released to fall.
pub fn case_of(name: &str) -> Case {
    let cut = |name, at| match str::split_once(name, at) {
        Some((name, value)) => (name, Some(value)),
        None => (name, None),
    };
    let (name, end) = cut(name, '@');
    let (name, order) = cut(name, '/');
    let (name, segments) = cut(name, '*');
    let (name, cells) = cut(name, ':');
    let plain = r#"/effects={"rotary_inertia":"off","finite_rotation":"on","axial_stretch":"on","axial_inertia":"on"}"#;
    let (file, sets): (&str, Vec<&str>) = match name {
        "shaken-sealed" => ("shaken-sealed", vec![plain]),
        "wiring-2" => (
            "wiring-2",
            vec![plain, "/ends/root/clamped/u3_m/sine/ramp_cycles=1", "/time/end_s=0.2"],
        ),
        "dry-cantilever" => ("dry-cantilever", vec![plain, "/time/end_s=0.1"]),
        "dry-cantilever-sheared" => (
            "dry-cantilever",
            vec![
                r#"/effects={"rotary_inertia":"on","finite_rotation":"on","axial_stretch":"on","axial_inertia":"on","shear":"on"}"#,
                "/beam/shear_stiffness_n=300",
                "/time/end_s=0.1",
            ],
        ),
        "swing" => (
            "dry-cantilever",
            vec![
                plain,
                "/start={}",
                r#"/loads=[{"gravity":{"x_m_s2":-100}}]"#,
                "/time/end_s=0.1",
            ],
        ),
        other => panic!("no scene {other}"),
    };
    let mut sets: Vec<String> = sets.into_iter().map(str::to_owned).collect();
    sets.extend(cells.map(|cells| format!("/mesh/cells_per_segment={cells}")));
    let of_one_cell = |segments| [format!("/mesh/segments={segments}"), "/mesh/cells_per_segment=1".to_owned()];
    sets.extend(segments.into_iter().flat_map(of_one_cell));
    sets.extend(order.map(|order| format!("/mesh/order={order}")));
    let times = |end| [format!("/time/end_s={end}"), format!("/time/window_s={end}")];
    sets.extend(end.into_iter().flat_map(times));
    let path = root().join(format!("cases/{file}.json"));
    case::load(&path, &sets).expect("a case")
}

impl Scene {
    pub fn named(name: &str) -> Self {
        Self::from_case(case_of(name))
    }

    pub fn from_case(case: Case) -> Self {
        let mut dae = BeamDae::new(System::new(&case).expect("a system"));
        dae.enter_smooth_interval(0.0);
        let (system, now) = dae.instant(0.0);
        let mut y = start::state(system, &case, now);
        let mut yp = vec![0.0; y.len()];
        consistent_start(&mut dae, 0.0, &mut y, &mut yp, &StartOptions::default()).expect("a start");
        let (end, interval) = (case.time.end_s, case.time.output_interval());
        let times = (1..=(end / interval).round() as usize)
            .map(|k| k as f64 * interval)
            .collect();
        let largest_step = StepLimits::new(&case, dae.system()).least();
        let readings = Readings::new(dae.system());
        Self {
            case,
            y,
            yp,
            times,
            readings,
            largest_step,
            equations: dae,
        }
    }

    pub fn dae(&self) -> Bare {
        Bare(self.equations.clone())
    }

    pub fn end(&self) -> f64 {
        *self.times.last().expect("times")
    }

    /// `M` from the change of the residual with all rates at once, since `M` is diagonal.
    pub fn mass(&self) -> Vec<f64> {
        let n = self.y.len();
        let (mut with, mut without) = (vec![0.0; n], vec![0.0; n]);
        let mut dae = self.dae();
        let mut at = |rate: f64, out: &mut [f64]| dae.residual(0.0, &self.y, &vec![rate; n], out).expect("a residual");
        at(1.0, &mut with);
        at(0.0, &mut without);
        with.iter().zip(&without).map(|(w, o)| w - o).collect()
    }
}
