//! Cycles along one parameter: requested values on every passage of the branch, points between, and special points.

use std::time::Instant;

use serde::{Deserialize, Serialize};

use super::branch::BranchFollower;
use super::special_points::SpecialPoint;
use crate::case::schema::Case;
use crate::error::{Code, Result};
use crate::run::early_warnings;
use crate::run::floquet::{self, Floquet};
use crate::run::periodic::balanced_cycle::TighterCycle;
use crate::run::periodic::family::{CycleFamily, FamilyMember, FamilyState};
use crate::run::periodic::parameter_scale::ParameterScale;
use crate::run::periodic::{Cycle, PeriodicScene, Settled, ShootingRecord, record, scene, settle, shoot};
use crate::run::record::{Control, Unrecorded};
use crate::run::stop::{INTERRUPTED, StopFlag};
use crate::run::summary::{Quantity, Status};
use crate::study::evaluations::Evaluations;

/// Number of multipliers computed.
const COUNT: usize = 4;

/// Reason why a cycle is a member of a path.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MemberKind {
    /// Its value was requested.
    #[default]
    Requested,
    /// A step along the branch between requested values.
    Between,
    /// A special point.
    Special,
}

/// Cycle at one value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CycleMember {
    /// Value of the parameter.
    pub value: f64,
    /// Reason why it is a member.
    #[serde(default)]
    pub kind: MemberKind,
    /// Number of the branch, from 0; a further one begins at a value that the branches before do not reach.
    #[serde(default)]
    pub branch: usize,
    /// Kind and accuracy of a special point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub special: Option<SpecialPoint>,
    /// Frequency of the drive at the resonance [Hz], for a backbone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub resonance_hz: Option<f64>,
    /// Number of unknowns.
    pub unknowns: usize,
    /// Search for the cycle.
    pub search: ShootingRecord,
    /// Stability of the cycle.
    pub floquet: Floquet,
    /// Quantities over the period.
    pub quantities: std::collections::BTreeMap<String, Quantity>,
    /// Reason why the tolerance of the cycle is not the case's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refined: Option<TighterCycle>,
    /// Wall time of search and stability [s].
    pub wall_s: f64,
}

impl CycleMember {
    /// Description of its kind.
    pub fn kind_name(&self) -> &'static str {
        match (self.kind, self.special) {
            (_, Some(special)) => special.kind.describe(),
            (MemberKind::Between, _) => "between",
            _ => "requested",
        }
    }
}

/// Cycles at all values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CyclePath {
    /// Name of the case.
    pub case: String,
    /// JSON pointer of the parameter.
    pub pointer: String,
    /// True if the values are evenly spaced in their logarithms.
    pub logarithmic: bool,
    /// JSON pointer of the frequency that is that of the resonance at each value, for a backbone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub resonance: Option<String>,
    /// Cycles in the order of the branches.
    pub members: Vec<CycleMember>,
    /// Values without a cycle, with reasons.
    pub missing: Vec<(f64, String)>,
    /// Warnings about the first case.
    pub warnings: Vec<String>,
}

impl CyclePath {
    /// Path without members.
    pub(super) fn begin(request: &PathRequest) -> Result<Self> {
        let first = request.cases.first().map(|(_, case)| case);
        Ok(Self {
            case: first.map_or(String::new(), |case| case.name.clone()),
            pointer: request.pointer.into(),
            logarithmic: request.logarithmic,
            resonance: None,
            members: vec![],
            missing: vec![],
            warnings: match first {
                Some(case) => early_warnings::without_outputs(case, &scene::system(case)?),
                None => vec![],
            },
        })
    }

    /// Adds a warning that the energies at some values do not add up.
    pub(super) fn warn_open(&mut self, open: &[(f64, String)]) {
        if let Some((value, warning)) = open.first() {
            let others = match open.len() - 1 {
                0 => String::new(),
                n => format!("; similar at {n} of the other values"),
            };
            let at = format!("(at {} = {value}{others})", self.pointer);
            self.warnings.push(format!("{warning} {at}"));
        }
    }
}

/// Requested cycles along a parameter.
pub struct PathRequest<'a> {
    /// JSON pointer of the parameter.
    pub pointer: &'a str,
    /// True if the values are evenly spaced in their logarithms.
    pub logarithmic: bool,
    /// Values, ascending or descending, each with its case.
    pub cases: &'a [(f64, Case)],
    /// Returns the case for any value between.
    pub case_at: &'a dyn Fn(f64) -> Result<Case>,
}

/// A point of a branch, with the state that the next one needs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct PathPoint {
    /// The cycle, or the reason why its period could not be recorded.
    pub found: std::result::Result<CycleMember, String>,
    /// Warning that its energies do not add up.
    pub open: Option<String>,
    /// State of its cycle.
    pub state: FamilyState,
}

/// First point of a branch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct BranchStart {
    found: std::result::Result<CycleMember, String>,
    open: Option<String>,
    /// State of its cycle.
    y: Option<Vec<f64>>,
    /// Position on the branch; `None` if the cycle has no neighbours that could be followed.
    state: Option<FamilyState>,
}

/// Finds the cycles at all values and follows their branches through folds; `report` is called with the number of finished values.
/// Values not finished at a stop are missing. If turbines harvest, tolerances are tightened until the energies of each cycle add up,
/// as for one cycle. Cycles stored in `evaluations` are not searched again.
///
/// A branch begins at the first value and ends where it leaves the range of values. It has a member at every requested value, on every
/// passage. If values remain that no branch reaches, a further branch begins at the first of them. It is followed in both directions if
/// values before it have no cycle of their own.
///
/// # Errors
/// A case without a period, a beam that nothing holds.
pub fn along(
    request: &PathRequest,
    evaluations: &Evaluations,
    stop: &StopFlag,
    report: &dyn Fn(usize),
) -> Result<CyclePath> {
    let cases = request.cases;
    let mut found = CyclePath::begin(request)?;
    let values: Vec<f64> = cases.iter().map(|(value, _)| *value).collect();
    let mut finished = vec![false; values.len()];
    let mut before: Option<(PeriodicScene, Vec<f64>)> = None;
    let mut open: Vec<(f64, String)> = vec![];
    let mut branch = 0;
    while let Some(k) = finished.iter().position(|done| !done) {
        finished[k] = true;
        let (value, case) = &cases[k];
        if stop.raised() {
            found.missing.push((*value, INTERRUPTED.into()));
            continue;
        }
        let begin = Instant::now();
        let scene = PeriodicScene::new(case, None)?.heeding(stop);
        scene.held(&case.name)?;
        if k == 0 {
            found.warnings.extend(scene.trapped.clone());
        }
        let from = before.as_ref().and_then(|(old, y)| scene.take_over(old, y));
        let family = (values.len() > 1).then(|| CycleFamily {
            reference: scene.clone(),
            case_at: request.case_at,
            scale: ParameterScale::new(&values, request.logarithmic),
        });
        let compute = || start((k, *value, case), &scene, from.as_deref(), family.as_ref(), begin);
        let start = evaluations.try_get(&(k, value), &|| stop.raised(), compute)?;
        open.extend(start.open.map(|warning| (*value, warning)));
        match start.found {
            Ok(member) => found.members.push(CycleMember { branch, ..member }),
            Err(why) => found.missing.push((*value, why)),
        }
        report(finished.iter().filter(|done| **done).count());
        let Some(mut y) = start.y else { continue };
        if let (Some(family), Some(state), Some(floquet)) = (
            family,
            start.state,
            found.members.last().map(|member| member.floquet.clone()),
        ) {
            let follower = |way: &str| BranchFollower {
                family: family.clone(),
                values: &values,
                evaluations: evaluations.scoped(&format!("{way} {k}")),
                stop,
            };
            let number = found.members.last().map_or(0, |member| member.branch);
            let numbered = |member: CycleMember| CycleMember {
                branch: number,
                ..member
            };
            // values before that have no cycle of their own may be on the other side of this branch
            if found.missing.iter().any(|(value, _)| values[..k].contains(value)) {
                let followed =
                    follower("back from").follow((state.reversed(), floquet.clone()), &mut finished, report)?;
                open.extend(followed.open);
                let reached = |value: &f64| {
                    let requested = |member: &CycleMember| member.kind == MemberKind::Requested;
                    followed
                        .members
                        .iter()
                        .any(|member| requested(member) && member.value == *value)
                };
                found.missing.retain(|(value, _)| !reached(value));
                found.missing.extend(followed.missing);
                let place = found.members.len() - 1;
                let members = followed.members.into_iter().rev().map(numbered);
                found.members.splice(place..place, members);
            }
            let followed = follower("from").follow((state, floquet), &mut finished, report)?;
            y = followed.last;
            open.extend(followed.open);
            found.missing.extend(followed.missing);
            branch += usize::from(followed.ended);
            found.members.extend(followed.members.into_iter().map(numbered));
        }
        before = Some((scene, y));
    }
    found.warn_open(&open);
    Ok(found)
}

/// First cycle of a branch.
fn start(
    (k, value, case): (usize, f64, &Case),
    scene: &PeriodicScene,
    from: Option<&[f64]>,
    family: Option<&CycleFamily>,
    begin: Instant,
) -> Result<BranchStart> {
    let mut cycle = match shoot(scene, from) {
        Ok(cycle) => cycle,
        Err(impasse) => {
            return Ok(BranchStart {
                found: Err(impasse.what),
                open: None,
                y: None,
                state: None,
            });
        }
    };
    let state = family.and_then(|family| family.position(scene, &mut cycle, k as f64, None).ok());
    let y = Some(cycle.y.clone());
    let (found, open) = describe((value, case.clone(), scene.clone(), cycle), begin)?;
    Ok(BranchStart { found, open, y, state })
}

/// Point of a branch from a cycle of a family.
pub(super) fn point(value: f64, of: FamilyMember, begin: Instant) -> Result<PathPoint> {
    let state = of.state;
    let (found, open) = describe((value, of.case, of.scene, of.cycle), begin)?;
    Ok(PathPoint { found, open, state })
}

type Described = (std::result::Result<CycleMember, String>, Option<String>);

/// Stability and quantities of a cycle, and a warning that its energies do not add up.
fn describe((value, case, scene, cycle): (f64, Case, PeriodicScene, Cycle), begin: Instant) -> Result<Described> {
    let harvests = case.network.as_ref().is_some_and(|n| !n.turbines.is_empty());
    let Settled {
        case,
        scene,
        mut cycle,
        refined,
    } = match harvests {
        true => settle(&case, scene, cycle)?,
        false => Settled::as_found(&case, scene, cycle),
    };
    let floquet = multipliers(&scene, &mut cycle);
    let wall_s = begin.elapsed().as_secs_f64();
    let summary = record::record(&case, &scene, &cycle, &mut Unrecorded(|_| Control::Continue))?.summary;
    let finished = summary.status == Status::Finished;
    let mark = Code::EnergyFigure.id();
    let open = summary.warnings.into_iter();
    let open = open.into_iter().find(|warning| finished && warning.starts_with(mark));
    let found = match finished {
        true => Ok(CycleMember {
            value,
            kind: MemberKind::Requested,
            branch: 0,
            special: None,
            resonance_hz: None,
            unknowns: scene.system.layout.len,
            search: cycle.search,
            floquet,
            quantities: summary.quantities,
            refined,
            wall_s,
        }),
        false => Err(summary.reason.unwrap_or_default()),
    };
    Ok((found, open))
}

/// Multipliers of a cycle of a path.
pub(super) fn multipliers(scene: &PeriodicScene, cycle: &mut Cycle) -> Floquet {
    floquet::multipliers(scene, cycle, COUNT)
}
