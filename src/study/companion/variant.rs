//! Cases beside a case: its companion, and those that differ from it in one setting.

use crate::case::Case;
use crate::case::schema::{Choice, Effect, Effects};
use crate::discrete::{BeamMesh, System, resolution};
use crate::error::Result;
use crate::run::summary::{CompanionRun, Summary};
use crate::study::accuracy::plan::unrecorded;
use crate::study::companion::error;
use crate::study::effects::choices::with;
use crate::study::effects::full_model::full;
use crate::study::refine::has_cells_along_bladders;

/// Loosest and tightest tolerance of a variant.
const TOLERANCES: [f64; 2] = [1e-13, 0.1];

/// Largest refinement of a mesh that does not resolve what the case gives, less one cell: waves that vanish on a mesh may also vanish on
/// its multiples.
const FINEST: usize = 4;

/// Cells a segment of a fourth-order mesh that are compared with twice as many: it may share a false peak with an even coarser one.
const FEW: usize = 4;

/// A case beside another.
pub struct Variant {
    /// The case.
    pub case: Case,
    /// Effects that the other leaves out.
    pub added: Vec<Effect>,
}

/// A setting of a case that makes an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ErrorCause {
    /// `/mesh/cells_per_segment`.
    BeamMesh,
    /// `/mesh/cells_per_bladder`.
    FluidMesh,
    /// `/solver/rtol`.
    TimeSteps,
    /// All effects that are left out.
    Effects,
    /// One of them.
    Effect(Effect),
}

impl ErrorCause {
    /// True if the cause at a pointer is an effect that is left out, or all of them.
    pub fn is_effect(pointer: &str) -> bool {
        pointer.starts_with(&Self::Effects.pointer())
    }

    /// The cause at a pointer.
    pub fn at(pointer: &str) -> Option<Self> {
        let settings = [Self::BeamMesh, Self::FluidMesh, Self::TimeSteps, Self::Effects];
        let effects = Effect::CHOSEN.iter().map(|effect| Self::Effect(*effect));
        settings
            .into_iter()
            .chain(effects)
            .find(|cause| cause.pointer() == pointer)
    }

    /// Error after a refinement over that before: twice the cells of the beam or of a bladder, or a decade of the tolerance. Boundary layers in
    /// bladders are of first order, and so are some figures of second on meshes of fourth order.
    pub fn falls(self, case: &Case) -> f64 {
        match self {
            Self::BeamMesh if case.mesh.order() == 4 => 0.125,
            Self::BeamMesh | Self::TimeSteps => 0.25,
            Self::FluidMesh => 0.5,
            Self::Effects | Self::Effect(_) => 1.0,
        }
    }

    /// Refinements of this setting from one case to another.
    fn refinements(self, from: &Case, to: &Case) -> f64 {
        let doublings = |from: usize, to: usize| (to as f64 / from as f64).log2();
        match self {
            Self::BeamMesh => doublings(from.mesh.cells_per_segment, to.mesh.cells_per_segment),
            Self::FluidMesh => doublings(from.mesh.cells_per_bladder, to.mesh.cells_per_bladder),
            Self::TimeSteps => (from.solver.rtol / to.solver.rtol).log10(),
            Self::Effects | Self::Effect(_) => 0.0,
        }
    }

    /// Expected error of a refined case over that of the case.
    pub fn left(self, from: &Case, to: &Case) -> f64 {
        self.falls(from).powf(self.refinements(from, to))
    }

    /// JSON pointer of the setting.
    pub fn pointer(self) -> String {
        match self {
            Self::BeamMesh => "/mesh/cells_per_segment".into(),
            Self::FluidMesh => "/mesh/cells_per_bladder".into(),
            Self::TimeSteps => "/solver/rtol".into(),
            Self::Effects => "/effects".into(),
            Self::Effect(effect) => format!("/effects/{effect}"),
        }
    }
}

impl Variant {
    /// The companion with all effects.
    ///
    /// # Errors
    /// As [`System::new`].
    pub fn with_all_effects(case: &Case) -> Result<Option<Self>> {
        Ok(Some(match full(case)? {
            Some(full) => Self::discretized(&full.case, full.left_out)?,
            None => Self::discretized(case, vec![])?,
        }))
    }

    /// The companion with the effects of the case, where it leaves out any.
    ///
    /// # Errors
    /// As [`System::new`].
    pub fn with_its_effects(case: &Case) -> Result<Option<Self>> {
        full(case)?.map(|_| Self::discretized(case, vec![])).transpose()
    }

    /// A companion with a tighter tolerance and a finer mesh, for cases that looser ones do not reach the end of.
    ///
    /// # Errors
    /// As [`System::new`].
    pub fn tighter(case: &Case) -> Result<Option<Self>> {
        let mut case = recorded_alike(case);
        case.solver.rtol = (0.1 * case.solver.rtol).max(TOLERANCES[0]);
        case.mesh.cells_per_segment *= 2;
        case.mesh.cells_per_bladder *= 2;
        Ok(Some(Self { case, added: vec![] }))
    }

    fn discretized(case: &Case, added: Vec<Effect>) -> Result<Self> {
        let mut case = recorded_alike(case);
        let unresolved = resolution::unresolved(&case, &System::new(&case)?);
        let finer = |setting: &str, cells: usize| resolution::finer(&unresolved, setting, cells, FINEST * cells - 1);
        case.solver.rtol = (10.0 * case.solver.rtol).min(TOLERANCES[1]);
        case.solver.max_step_s = case.solver.max_step_s.map(|step| 2.0 * step);
        let [along, in_bladders] = [case.mesh.cells_per_segment, case.mesh.cells_per_bladder];
        let other = match unresolved.is_empty() {
            true => other_cells(&case),
            false => 2 * along,
        };
        case.mesh.cells_per_segment = finer("/mesh/cells_per_segment", along).unwrap_or(other);
        case.mesh.cells_per_bladder = finer("/mesh/cells_per_bladder", in_bladders).unwrap_or(2 * in_bladders);
        Ok(Self { case, added })
    }

    /// The case with one setting changed, to beam cells, fluid cells or a tolerance so many times tighter, and the error of the case over the
    /// difference that this makes. Nothing where the setting does not apply.
    ///
    /// # Errors
    /// As [`System::new`].
    pub fn with_change(
        case: &Case,
        [beam, fluid]: [usize; 2],
        cause: ErrorCause,
        tighter: f64,
    ) -> Result<Option<(Self, f64)>> {
        let mut other = unrecorded(case);
        let mut added = vec![];
        let factor = match cause {
            ErrorCause::BeamMesh => {
                other.mesh.cells_per_segment = beam;
                // some quantities of a mesh of fourth order are of second
                let order = if case.mesh.order() == 4 { 3 } else { 2 };
                share(case.mesh.cells_per_segment, beam, order)
            }
            ErrorCause::FluidMesh => {
                if !has_cells_along_bladders(case)? {
                    return Ok(None);
                }
                other.mesh.cells_per_bladder = fluid;
                share(case.mesh.cells_per_bladder, fluid, 1)
            }
            ErrorCause::TimeSteps => {
                other.solver.rtol = (case.solver.rtol / tighter).max(TOLERANCES[0]);
                1.0
            }
            ErrorCause::Effects => {
                let Some(full) = full(case)? else {
                    return Ok(None);
                };
                (other, added) = (unrecorded(&full.case), full.left_out);
                1.0
            }
            ErrorCause::Effect(effect) => {
                let mut choices = case.effects.choices();
                choices.set(effect, Choice::On);
                other = with(&other, Effects::Chosen(choices));
                added.push(effect);
                1.0
            }
        };
        Ok(System::new(&other)
            .is_ok()
            .then_some((Self { case: other, added }, factor)))
    }

    /// Its settings and what it took.
    pub fn describe(&self, summary: &Summary) -> CompanionRun {
        let mesh = &self.case.mesh;
        CompanionRun {
            reason: None,
            cells_per_segment: mesh.cells_per_segment,
            cells_per_bladder: mesh.cells_per_bladder,
            rtol: self.case.solver.rtol,
            added_effects: self.added.iter().map(Effect::to_string).collect(),
            unknowns: summary.unknowns,
            steps: summary.solver.steps,
            residual_evaluations: summary.solver.residual_evaluations,
            wall_s: summary.wall_s.total,
            figures: error::figures(summary),
            causes: Default::default(),
            earlier_runs: vec![],
        }
    }
}

/// The case without checkpoints, with the rows of its history.
fn recorded_alike(case: &Case) -> Case {
    let mut alike = unrecorded(case);
    alike.time.history = case.time.history;
    alike
}

/// True for a fourth-order mesh so coarse that its error is measured on a finer one.
pub fn has_few_cells(case: &Case) -> bool {
    case.mesh.order() == 4 && case.mesh.cells_per_segment <= FEW
}

/// Other cells of a segment: half as many at second order, three quarters at fourth, twice as many where there can be no fewer.
fn other_cells(case: &Case) -> usize {
    let (cells, order) = (case.mesh.cells_per_segment, case.mesh.order());
    let fewer = if order == 4 {
        (3 * cells).div_ceil(4)
    } else {
        cells.div_ceil(2)
    };
    let possible = fewer < cells && fewer * case.segments() >= BeamMesh::fewest(case.mesh.order());
    if possible { fewer } else { 2 * cells }
}

/// The error on a mesh of so many cells over its difference to another mesh.
fn share(cells: usize, other: usize, order: u8) -> f64 {
    let ratio = (cells as f64 / other as f64).powi(i32::from(order));
    1.0 / (1.0 - ratio).abs()
}
