//! The state in a checkpoint besides the arrays.

mod flowed;
mod free_field;

pub use flowed::FlowedState;
pub use free_field::FreeFieldState;

use super::Refusal;
use super::issued::{IssuedWarning, SurfaceCounts, numbered};
use bsmpm::boundary::Anchors;
use bsmpm::control::Progress;
use bsmpm::energy::{EnergyAccounts, EnergyBound, Flows};
use bsmpm::field::pore_water::crossed::CrossedVolumes;
use bsmpm::grid::Grid;
use bsmpm::interactions::rigid::RigidState;
use bsmpm::interactions::state::InteractionState;
use bsmpm::tensor::Vector;
use bsmpm_io::exit;
use bsmpm_io::frames::Entry;
use bsmpm_io::manifest::Manifest;
use bsmpm_io::table::TableMark;
use bsmpm_scene::{Case, GridSpec, Line};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::path::Path;

/// Components of a vector.
pub type Row = Vec<f64>;

/// The state of a run between two steps, besides the arrays; the same on all ranks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CheckpointState {
    /// Accepted steps.
    pub steps: u64,
    /// Where the slabs begin, and where the columns of the grid's room end.
    pub slabs: Vec<usize>,
    /// Where the parts of each slab begin along y, and where the rows of the room end; none where a slab is one rank's.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub parts: Vec<Vec<usize>>,
    /// The room, cells from and to along each axis; none of a run by a version that kept the whole grid, which then
    /// stays.
    #[serde(default)]
    pub room: Option<Vec<[usize; 2]>>,
    /// Repeated breakpoints along each axis, with how often they stand; none of a run by a version that had none.
    #[serde(default)]
    pub lines: Vec<Vec<[usize; 2]>>,
    /// The step control.
    #[serde(with = "ProgressForm")]
    pub progress: Progress,
    /// Pa  traction of every strip at its points.
    pub traction: Vec<Vec<Row>>,
    /// m  position of every load's points.
    pub position: Vec<Vec<Row>>,
    /// Pa  traction of loads that follow the surface; none of a run by a version that had none. Behind it what older
    /// versions had, its rate.
    #[serde(default, skip_serializing_if = "follow_nothing")]
    pub pressure: [Vec<Vec<Row>>; 2],
    /// Ids of the points that the points of strips, and those of loads, are anchored to; none of a run by a version
    /// that had none, or before the first step.
    #[serde(default)]
    pub anchors: [Vec<Vec<u64>>; 2],
    /// The same of drains and then inflows; none of a run without any, or before the first step.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub water_anchors: Vec<Vec<u64>>,
    /// Water that has gone through drains and inflows.
    #[serde(default, skip_serializing_if = "CrossedState::is_none")]
    pub crossed: CrossedState,
    /// What flowed in the last step; none of a run in which the next step does not go on with it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flowed: Option<FlowedState>,
    /// N  of every node of every absorbing face what holds the state of the start; none of a run without any.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub held: Vec<Vec<Row>>,
    /// The columns of the free field; none of a run without any, or before the first step.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub free_field: Vec<FreeFieldState>,
    /// Of every rigid body its motions (m, m, rad), their velocities, the way of the material along it, m, and its
    /// work, J; none of a run without any.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rigid: Vec<[f64; 8]>,
    /// Of every rigid body the accelerations (m/s2, m/s2, rad/s2) that the next step starts with; none where it starts
    /// without, and of a run by a version that had none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rigid_accelerations: Vec<Option<[f64; 3]>>,
    /// What the histories go on from.
    pub record: RecordState,
    /// Warnings that are given once, and were given.
    #[serde(default, skip_serializing_if = "BTreeSet::is_empty")]
    pub issued: BTreeSet<IssuedWarning>,
    /// Warnings about footings and drains by number; of a run by a version that kept no names.
    #[serde(rename = "told_strips", default, skip_serializing)]
    pub numbered_surfaces: BTreeSet<usize>,
    /// The same about rigid bodies.
    #[serde(rename = "told_rigid", default, skip_serializing)]
    pub numbered_bodies: BTreeSet<usize>,
    /// The step of the newest frame.
    pub last_frame: Option<u64>,
    /// The files.
    pub files: Files,
}

/// Water that has gone through surfaces of the ground, m3 per metre; nothing of a run without any.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CrossedState {
    /// Out of every drain.
    pub drains: Vec<f64>,
    /// Out of every drained face.
    pub faces: Vec<f64>,
    /// In by every inflow.
    pub inflows: Vec<f64>,
    /// Taken in by ground that stages took away.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub removed: f64,
}

impl CrossedState {
    pub(crate) fn of(
        CrossedVolumes {
            drains,
            faces,
            inflows,
            removed,
        }: &CrossedVolumes,
    ) -> Self {
        Self {
            drains: drains.clone(),
            faces: faces.clone(),
            inflows: inflows.clone(),
            removed: *removed,
        }
    }

    fn volumes(&self) -> CrossedVolumes {
        let Self {
            drains,
            faces,
            inflows,
            removed,
        } = self.clone();
        CrossedVolumes {
            drains,
            faces,
            inflows,
            removed,
        }
    }

    fn is_none(&self) -> bool {
        self.drains.is_empty() && self.faces.is_empty() && self.inflows.is_empty() && is_zero(&self.removed)
    }
}

fn is_zero(number: &f64) -> bool {
    *number == 0.0
}

/// Points that histories follow, and the books of energy.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordState {
    /// For every history the number of the point that it follows, if it does.
    pub followed: Vec<Option<u64>>,
    /// Numbers of the histories in whose box no point has been yet.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub vacant: Vec<usize>,
    /// J  kinetic and elastic energy at the start, and all flows since; none without an energy history.
    pub books: Option<BooksForm>,
    /// Points that have left the grid, and their mass, kg/m.
    #[serde(default, skip_serializing_if = "Outlet::is_closed")]
    pub left: Outlet,
    /// J/m  work of every strip since the start; empty where no history wants it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub work: Vec<f64>,
    /// m, deg  displacement of every history when displacements were last set to zero; empty if they never were.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub datum: Vec<Row>,
}

/// What has left the grid since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Outlet {
    /// Points.
    pub points: u64,
    /// kg/m
    pub mass: f64,
}

impl Outlet {
    fn is_closed(&self) -> bool {
        self.points == 0
    }
}

/// How far the files of a run have come.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Files {
    /// The manifest.
    pub manifest: Manifest,
    /// `history.csv`.
    pub history: TableMark,
    /// `steps.csv`.
    pub steps: TableMark,
    /// `residuals.csv`, if there is one.
    pub residuals: Option<TableMark>,
    /// The profiles in the order of the case; none of a run without any.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub profiles: Vec<TableMark>,
    /// The frames.
    pub frames: Vec<Entry>,
}

impl CheckpointState {
    /// As text, if it reads back as it is: a number that is not finite would not.
    ///
    /// # Errors
    /// The number that is not finite, or none was found and the text is wrong (81).
    pub fn text(&self) -> Result<Vec<u8>, Refusal> {
        let text = serde_json::to_vec(self).map_err(|error| error.to_string());
        let whole = text.and_then(|text| match serde_json::from_slice::<Self>(&text) {
            Ok(read) if read == *self => Ok(text),
            Ok(_) => Err("the state that is read back differs".into()),
            Err(error) => Err(error.to_string()),
        });
        whole.map_err(|reason| {
            let reason = format!(
                "E0725: the checkpoint of step {} cannot be written: {reason}. The run ends. Continue from the last \
                 checkpoint with smaller steps.",
                self.steps
            );
            Refusal::new(exit::LEFT, reason)
        })
    }

    /// Warnings that are given once, and were given, of all versions.
    pub fn issued(&self, case: &Case, counts: SurfaceCounts) -> BTreeSet<IssuedWarning> {
        let mut issued = numbered(case, counts, &self.numbered_surfaces, &self.numbered_bodies);
        issued.extend(self.issued.iter().cloned());
        issued
    }

    /// What a checkpoint's text says.
    ///
    /// # Errors
    /// It is no such text (76).
    pub fn parse(path: &Path, text: &[u8]) -> Result<Self, Refusal> {
        serde_json::from_slice(text).map_err(|error| Refusal::unusable(path, &error.to_string()))
    }

    /// The repeated breakpoints of the run's grid; `None` if they are not of a grid like this one.
    pub fn lines(&self, grid: &GridSpec) -> Option<[Vec<Line>; 3]> {
        let mut all: [Vec<Line>; 3] = Default::default();
        for (axis, lines) in self.lines.iter().enumerate() {
            let all = all.get_mut(axis)?;
            if !lines.is_sorted_by(|a, b| a[0] < b[0]) {
                return None;
            }
            for &[breakpoint, multiplicity] in lines {
                let inner = 1..grid.axes.get(axis)?.cells();
                if !inner.contains(&breakpoint) || !(2..=grid.order).contains(&multiplicity) {
                    return None;
                }
                all.push(Line {
                    breakpoint,
                    multiplicity,
                });
            }
        }
        Some(all)
    }

    /// The grid with the room that the run had; `None` if it is no part of that grid.
    pub fn within<const D: usize>(&self, grid: &Grid<D>) -> Option<Grid<D>> {
        let Some(room) = &self.room else {
            return Some(grid.clone());
        };
        let room: [[usize; 2]; D] = room.as_slice().try_into().ok()?;
        let mut along = room.iter().zip(grid.axes());
        let fits = along.all(|([start, end], axis)| start < end && *end <= axis.cells());
        fits.then(|| grid.within(room.map(|[start, end]| start..end)))
    }

    /// The state of the interactions without the columns of the free field; `None` if it is of another dimension.
    pub fn interactions<const D: usize>(&self) -> Option<InteractionState<D>> {
        let [strips, loads] = self.anchors.clone();
        let anchors = Anchors {
            strips,
            loads,
            water: self.water_anchors.clone(),
        };
        // Without any, as many empty lists as there are loads.
        let pressure = if self.pressure[0].is_empty() {
            vec![Vec::new(); self.position.len()]
        } else {
            vectors(&self.pressure[0])?
        };
        Some(InteractionState {
            traction: vectors(&self.traction)?,
            position: vectors(&self.position)?,
            pressure,
            anchors,
            held: vectors(&self.held)?,
            bodies: (0..self.rigid.len()).map(|body| self.rigid_state(body)).collect(),
            crossed: self.crossed.volumes(),
            flowed: self.flowed.as_ref().map(FlowedState::flow),
            columns: Vec::new(),
        })
    }

    /// The state of a rigid body.
    fn rigid_state(&self, body: usize) -> RigidState {
        let [x, y, angle, vx, vy, spin, slipped, work] = self.rigid[body];
        let acceleration = self.rigid_accelerations.get(body).copied().flatten().map(Vector::from);
        RigidState {
            moved: [x, y, angle].into(),
            velocity: [vx, vy, spin].into(),
            acceleration,
            slipped,
            work,
        }
    }
}

/// The numbers of a rigid body's state.
pub(crate) fn rigid_numbers(state: &RigidState) -> [f64; 8] {
    let [x, y, angle]: [f64; 3] = state.moved.into();
    let [vx, vy, spin]: [f64; 3] = state.velocity.into();
    [x, y, angle, vx, vy, spin, state.slipped, state.work]
}

/// The accelerations of rigid bodies that the next step starts with; empty where there are none.
pub(crate) fn rigid_accelerations(states: &[RigidState]) -> Vec<Option<[f64; 3]>> {
    match states.iter().any(|state| state.acceleration.is_some()) {
        true => states.iter().map(|state| state.acceleration.map(Into::into)).collect(),
        false => Vec::new(),
    }
}

/// Whether no load follows the surface.
fn follow_nothing(pressure: &[Vec<Vec<Row>>; 2]) -> bool {
    pressure.iter().all(Vec::is_empty)
}

/// The components of the vectors of all strips or loads.
pub(crate) fn rows<const D: usize>(lists: &[Vec<Vector<D>>]) -> Vec<Vec<Row>> {
    lists
        .iter()
        .map(|list| list.iter().map(|vector| vector.as_slice().to_vec()).collect())
        .collect()
}

/// The vectors again; `None` if one has another number of components.
pub(crate) fn vectors<const D: usize>(lists: &[Vec<Row>]) -> Option<Vec<Vec<Vector<D>>>> {
    let mut all = Vec::with_capacity(lists.len());
    for list in lists {
        let rows = list.iter().map(|row| <[f64; D]>::try_from(row.as_slice()));
        all.push(rows.map(|row| row.map(Vector::from)).collect::<Result<_, _>>().ok()?);
    }
    Some(all)
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Progress", deny_unknown_fields)]
struct ProgressForm {
    t: f64,
    guess_dt: f64,
    nominal: Option<(f64, f64)>,
    tick: u32,
    cuts: u32,
    easy: u32,
    #[serde(default, with = "budget")]
    budget: Option<EnergyBound>,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "EnergyBound", deny_unknown_fields)]
struct BudgetFields {
    start: f64,
    external: f64,
    plastic: f64,
    #[serde(default)]
    damped: f64,
    largest: f64,
    growth: f64,
}

/// [`EnergyBound`] in a checkpoint; none in quasi-static analysis, and of a version that kept none.
mod budget {
    use super::{BudgetFields, EnergyBound};
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[derive(Serialize, Deserialize)]
    #[serde(transparent)]
    struct StateForm(#[serde(with = "BudgetFields")] EnergyBound);

    pub(super) fn serialize<S: Serializer>(budget: &Option<EnergyBound>, serializer: S) -> Result<S::Ok, S::Error> {
        budget.map(StateForm).serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<EnergyBound>, D::Error> {
        Ok(Option::<StateForm>::deserialize(deserializer)?.map(|StateForm(budget)| budget))
    }
}

/// [`EnergyAccounts`] in a checkpoint.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct BooksForm(#[serde(with = "BooksFields")] pub EnergyAccounts);

#[derive(Serialize, Deserialize)]
#[serde(remote = "EnergyAccounts", deny_unknown_fields)]
struct BooksFields {
    start: f64,
    #[serde(with = "FlowsFields")]
    flows: Flows,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Flows", deny_unknown_fields)]
struct FlowsFields {
    external: f64,
    plastic: f64,
    transfer: f64,
    integration: f64,
    smoothing: f64,
    #[serde(rename = "background")]
    artificial_stiffness: f64,
    penalty: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    #[serde(transparent)]
    struct StateForm(#[serde(with = "ProgressForm")] Progress);

    #[test]
    fn step_control_reads_back_and_that_of_a_version_without_a_budget_is_read() {
        let budget = EnergyBound {
            start: 0.1,
            external: 1.0 / 3.0,
            plastic: 2e-17,
            damped: 0.7,
            largest: 1e3,
            growth: 0.01,
        };
        let kept = StateForm(Progress {
            t: 0.3,
            budget: Some(budget),
            ..Progress::default()
        });
        let text = serde_json::to_string(&kept).unwrap();
        assert_eq!(serde_json::from_str::<StateForm>(&text).unwrap(), kept);
        let old = r#"{"t":0.3,"guess_dt":0.0,"nominal":null,"tick":0,"cuts":0,"easy":0}"#;
        assert_eq!(
            serde_json::from_str::<StateForm>(old).unwrap(),
            StateForm(Progress {
                t: 0.3,
                ..Progress::default()
            })
        );
        let unknown = old.replace("easy", "hard");
        assert!(serde_json::from_str::<StateForm>(&unknown).is_err());
    }
}
