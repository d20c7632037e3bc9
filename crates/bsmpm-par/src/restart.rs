//! Decides whether a run begins or continues, and from which checkpoint it continues.

mod there;

use crate::checkpoint::{self, CheckpointChoice, CheckpointState, OpenCheckpoint, Refusal, agree, broadcast, find};
use crate::cli::{Arguments, Restart};
use bsmpm::control::Stepper;
use bsmpm::dynamics::mass::MassMatrix;
use bsmpm::grid::Grid;
use bsmpm::interactions::state::{InteractionState, SoilColumn};
use bsmpm::kinematics::Kinematics;
use bsmpm::model::Model;
use bsmpm::points::Points;
use bsmpm::schedule::Schedule;
use bsmpm_io::checkpoint::{FOLDER, FoundCheckpoint};
use bsmpm_io::directory::{ExistingRunPolicy, OutputDirectory};
use bsmpm_io::exit;
use bsmpm_io::manifest;
use bsmpm_ranks::load;
use bsmpm_ranks::migrate;
use bsmpm_ranks::slab::{NodeBox, Slabs, common};
use bsmpm_ranks::traffic::Traffic;
use bsmpm_scene::{Case, Line};
use hdf5_collective::Hdf5;
use mpi::collective::{CommunicatorCollectives, SystemOperation};
use mpi::environment::Universe;
use mpi::topology::{Communicator, SimpleCommunicator};
use std::ops::Range;
use std::path::{Path, PathBuf};
use there::PriorRun;

/// How a run starts.
pub enum RunStart<'h> {
    /// From the case.
    New(FreshStart),
    /// From a checkpoint.
    Resumed(Box<ResumedRun<'h>>),
    /// Not at all: the case's end was reached before, with that exit code.
    Complete(u8),
}

impl RunStart<'_> {
    /// Adds a warning of this start, on the first rank.
    pub fn warn(&mut self, warning: Option<String>) {
        match self {
            Self::New(beginning) => beginning.warnings.extend(warning),
            Self::Resumed(resumed) => resumed.warnings.extend(warning),
            Self::Complete(_) => {}
        }
    }
}

/// What a run that starts from its case finds.
#[derive(Clone, Debug)]
pub struct FreshStart {
    /// What becomes of a run that is there.
    pub existing: ExistingRunPolicy,
    /// How often it has been started before, on the first rank.
    pub restarts: Vec<manifest::ManifestRestart>,
    /// What is to be reported, on the first rank.
    pub warnings: Vec<String>,
}

impl Default for FreshStart {
    fn default() -> Self {
        Self {
            existing: ExistingRunPolicy::Refuse,
            restarts: Vec::new(),
            warnings: Vec::new(),
        }
    }
}

/// State that a checkpoint holds, on this rank.
pub struct RestartedState<const D: usize> {
    /// Partition of the grid.
    pub slabs: Slabs,
    /// Points of this rank.
    pub points: Points<D>,
    /// State of the interactions.
    pub state: InteractionState<D>,
    /// State of the step control.
    pub stepper: Stepper,
}

/// A checkpoint from which a run goes on.
pub struct ResumedRun<'h> {
    /// It and its record.
    pub found: FoundCheckpoint,
    /// Everything that is no array.
    pub state: CheckpointState,
    /// Keys of the case that have changed since, with both values.
    pub changed: Vec<String>,
    /// What is to be reported, on the first rank.
    pub warnings: Vec<String>,
    /// Where the run went on before, on the first rank.
    pub restarts: Vec<manifest::ManifestRestart>,
    opened: OpenCheckpoint<'h>,
}

/// Decides how the run starts, with everything verified that it starts from. `held` is the first rank's. Collective.
///
/// # Errors
/// The same on all ranks: the checkpoint, or the run in the directory, is of another case, or damaged (76); the last
/// restarts came to nothing (72).
pub fn plan<'h>(
    hdf5: &'h Hdf5<'h>,
    universe: &Universe,
    held: Option<&OutputDirectory>,
    arguments: &Arguments,
    case: &Case,
) -> Result<RunStart<'h>, Refusal> {
    let world = universe.world();
    let Some(restart) = &arguments.restart else {
        let existing = if arguments.force {
            ExistingRunPolicy::Delete
        } else {
            ExistingRunPolicy::Refuse
        };
        return Ok(RunStart::New(FreshStart {
            existing,
            ..FreshStart::default()
        }));
    };
    let run = agree(
        &world,
        held.map_or(Ok(None), OutputDirectory::run).map_err(Refusal::from),
    )?;
    let auto = *restart == Restart::Auto;
    if auto {
        let there = agree(
            &world,
            held.map_or(Ok(PriorRun::Unfinished), |_| there::look(run.as_ref(), case)),
        )?;
        match PriorRun::of(broadcast(&world, 0, there.bytes())) {
            PriorRun::Nothing => return Ok(RunStart::New(FreshStart::default())),
            PriorRun::Complete(code) => return Ok(RunStart::Complete(code)),
            PriorRun::Unfinished => {}
        }
    }
    let folder = arguments.directory().join(FOLDER);
    let (found, passed_over) = match restart {
        Restart::From(file) => find(&world, CheckpointChoice::Named(file))?,
        Restart::Auto => find(&world, CheckpointChoice::Newest(&folder))?,
    };
    let Some(found) = found else {
        let afresh = held.map_or_else(
            || Ok(FreshStart::default()),
            |_| there::afresh(run.as_ref(), &passed_over, world.size()),
        );
        return agree(&world, afresh).map(RunStart::New);
    };
    let restarts = run.map_or_else(Vec::new, |run| run.restarts);
    agree(
        &world,
        if auto {
            there::futile(&restarts, found.record.step)
        } else {
            Ok(())
        },
    )?;
    resume(hdf5, universe, found, passed_over, restarts, case)
}

/// Opens a checkpoint that was found, `passed_over` what is wrong with newer ones, if it is of that case. Collective.
fn resume<'h>(
    hdf5: &'h Hdf5<'h>,
    universe: &Universe,
    found: FoundCheckpoint,
    passed_over: Vec<String>,
    restarts: Vec<manifest::ManifestRestart>,
    case: &Case,
) -> Result<RunStart<'h>, Refusal> {
    let opened = OpenCheckpoint::new(hdf5, universe.world(), &found)?;
    let state = CheckpointState::parse(&found.path, &opened.state()?)?;
    let past = &state.files.manifest;
    let changed = there::admissible(&format!("checkpoint `{}`", found.path.display()), past, case)?;
    let mut begun = case.stages.iter().filter(|stage| stage.at <= state.progress.t);
    if let Some(change) = changed.iter().find(|change| change.is_of_later_strength())
        && past.stages.iter().any(|stage| stage.strength_reduction.is_some())
            | begun.any(|stage| stage.strength_reduction.is_some())
    {
        let reason = format!(
            "E0722: the strength was already reduced before checkpoint `{}`, and the reduction has changed since: \
             {change}. The run cannot be continued. Start again with `--force`.",
            found.path.display()
        );
        return Err(Refusal::new(exit::CHECKPOINT, reason));
    }
    let changed: Vec<String> = changed.iter().map(ToString::to_string).collect();
    let t = state.progress.t;
    let end = case.analysis.end;
    if t > end {
        let reason = format!(
            "E0723: checkpoint `{}` is at t = {t}, after the end of the case (t = {end}). The run cannot be \
             continued. Increase `analysis.end`.",
            found.path.display()
        );
        return Err(Refusal::new(exit::CHECKPOINT, reason));
    }
    let mut warnings: Vec<String> = passed_over.iter().map(|bad| there::passed_over(bad)).collect();
    warnings.extend(there::other_machine(
        past,
        universe.world().size().unsigned_abs(),
        &found,
    ));
    warnings.extend(there::new_defaults(past, case));
    warnings.extend(changed.iter().map(|change| there::changed_since(change)));
    Ok(RunStart::Resumed(Box::new(ResumedRun {
        found,
        state,
        changed,
        warnings,
        restarts,
        opened,
    })))
}

impl ResumedRun<'_> {
    /// Whether the checkpoint is one of the run in that directory.
    pub fn is_in(&self, directory: &Path) -> bool {
        let own = self.found.path.parent().and_then(|folder| folder.canonicalize().ok());
        own.is_some_and(|own| directory.join(FOLDER).canonicalize().is_ok_and(|folder| folder == own))
    }

    /// The directory of the run that wrote the checkpoint, if it is still in its folder.
    pub fn directory(&self) -> Option<PathBuf> {
        let folder = self.found.path.parent()?;
        folder.ends_with(FOLDER).then(|| folder.parent().map(Path::to_owned))?
    }

    /// The repeated breakpoints of the run's grid: what the program places by itself may have been other, or nothing.
    ///
    /// # Errors
    /// The same on all ranks (76): they are not of this case.
    pub fn lines(&self, case: &Case) -> Result<[Vec<Line>; 3], Refusal> {
        self.state
            .lines(&case.grid)
            .ok_or_else(|| self.foreign("its grid lines are not those of the case"))
    }

    /// The run's mass matrix, whatever the program would choose today.
    pub fn mass(&self, case: &Case) -> MassMatrix {
        there::mass(&self.state.files.manifest, case)
    }

    /// Reads the points and the nodal displacement, each rank what lies in its slab; the model's grid gets the room
    /// that the run had. Collective.
    ///
    /// # Errors
    /// The same on all ranks (76): they are not those of this case.
    pub fn read<K: Kinematics<D>, const D: usize>(
        &self,
        universe: &Universe,
        case: &Case,
        model: &mut Model<K, D>,
        schedule: &Schedule,
    ) -> Result<RestartedState<D>, Refusal> {
        let world = universe.world();
        let mut points = self.points(universe, case, model)?;
        let held = self
            .state
            .within(&model.grid)
            .ok_or_else(|| self.foreign("its active domain is not one of the grid"))?;
        let past = self
            .cut(&held)
            .ok_or_else(|| self.foreign("its partition is not one of the grid"))?;
        let (grid, slabs) = self.slabs(universe, case, &held, &past, &points)?;
        model.grid = grid;
        let rank = world.rank().unsigned_abs() as usize;
        let window = model.grid.window_of(slabs.cells(rank, model.grid.room()));
        migrate::points(&world, &Traffic::default(), &slabs, &window, &mut points);
        let mut state = self
            .state
            .interactions()
            .filter(|state| fits(state, model))
            .ok_or_else(|| self.foreign("its surfaces are not those of the case"))?;
        state.columns = self
            .free_field(model, state_width(case))
            .ok_or_else(|| self.foreign("its free-field columns are not those of the case"))?;
        let guess = self.guess(&held, &past, &window)?;
        let is_finite = guess.iter().all(|value| value.is_finite());
        agree(
            &world,
            if is_finite {
                Ok(())
            } else {
                Err(self.foreign("a nodal displacement is not finite"))
            },
        )?;
        let stepper = Stepper::resume(guess, self.state.progress, schedule);
        Ok(RestartedState {
            slabs,
            points,
            state,
            stepper: stepper.ok_or_else(|| self.foreign("the state of its step control is invalid"))?,
        })
    }

    fn foreign(&self, what: &str) -> Refusal {
        Refusal::unusable(&self.found.path, what)
    }

    /// An equal share of the points, as the file has them. Collective.
    fn points<K: Kinematics<D>, const D: usize>(
        &self,
        universe: &Universe,
        case: &Case,
        model: &Model<K, D>,
    ) -> Result<Points<D>, Refusal> {
        let names: Vec<&str> = self
            .found
            .record
            .arrays
            .iter()
            .map(|array| array.name.as_str())
            .collect();
        let mut points = Points::holding(&names, state_width(case));
        self.opened.points(points.named_columns())?;
        let left = self.state.record.left.points;
        let present = (!case.stages.is_empty() || left > 0).then(|| case.ids_at(self.state.progress.t));
        checkpoint::require(
            &universe.world(),
            &self.found.path,
            &mut points,
            &model.grid,
            model.materials.len(),
            present.as_deref(),
            left,
        )?;
        Ok(points)
    }

    /// The free-field columns that follow faces of the model; `None` if they are not of this case.
    fn free_field<K: Kinematics<D>, const D: usize>(
        &self,
        model: &Model<K, D>,
        width: usize,
    ) -> Option<Vec<SoilColumn<D>>> {
        let mut columns = Vec::new();
        for column in &self.state.free_field {
            columns.push(column.column(width)?);
        }
        let mut laws = columns
            .iter()
            .flat_map(|column: &SoilColumn<D>| &column.points.material);
        let is_sound = laws.all(|&law| usize::from(law) < model.materials.len());
        let followers = model.boundary.absorbing().filter(|face| face.follows).count();
        let expected = if self.state.steps > 0 { followers } else { 0 };
        (is_sound && columns.len() == expected).then_some(columns)
    }

    /// The cut that the run had; `None` if it is not one of the grid that is `held`.
    fn cut<const D: usize>(&self, held: &Grid<D>) -> Option<Slabs> {
        let CheckpointState { slabs, parts, .. } = &self.state;
        let cut = Slabs::new(slabs.clone(), slabs.len().checked_sub(1)?, held.room()[0].clone())?;
        let cut = if parts.is_empty() {
            cut
        } else {
            cut.parted(parts.clone(), &held.room()[1])?
        };
        (cut.ranks() == self.found.record.ranks as usize).then(|| cut.reaching(held.beyond()))
    }

    /// The room, and its cut: as they were, or on another number of ranks one into about equal loads. Collective.
    fn slabs<const D: usize>(
        &self,
        universe: &Universe,
        case: &Case,
        held: &Grid<D>,
        past: &Slabs,
        points: &Points<D>,
    ) -> Result<(Grid<D>, Slabs), Refusal> {
        let world = universe.world();
        let ranks = world.size().unsigned_abs() as usize;
        if past.ranks() == ranks {
            return Ok((held.clone(), past.clone()));
        }
        cut_again(&world, case, held, points).ok_or_else(|| Refusal::new(exit::CASE, case.too_many(ranks)))
    }

    /// The displacement from which the next step starts, m, at the nodes of a `window`: zero where the room that was
    /// `held` under the cut `past` had none. Collective.
    fn guess<const D: usize>(&self, held: &Grid<D>, past: &Slabs, window: &Grid<D>) -> Result<Vec<f64>, Refusal> {
        let q = held.order();
        let layer = held.layer_nodes();
        let row = held.layer_nodes() / held.nodes_along(1);
        // The file's rows are the layers of all, or rank by rank the rows of nodes that it owned.
        let whole = past.parts().is_empty();
        let boxes: Vec<NodeBox> = match whole {
            true => vec![[held.layers(), held.room()[1].start..held.room()[1].end + q]],
            false => (0..past.ranks())
                .map(|rank| past.owned(rank, q, &held.room()[1]))
                .collect(),
        };
        let mut before = vec![0];
        before.extend(boxes.iter().scan(0, |sum, nodes| {
            *sum += nodes[0].len() * if whole { 1 } else { nodes[1].len() };
            Some(*sum)
        }));
        let seen: NodeBox = std::array::from_fn(|axis| {
            let start = window.cells_along()[axis].start;
            start..start + window.nodes_along(axis)
        });
        let needed: Vec<usize> = (0..boxes.len())
            .filter(|&at| !common(&boxes[at], &seen).iter().any(Range::is_empty))
            .collect();
        let first = needed.first().copied().unwrap_or(0);
        let last = needed.last().copied();
        let rows = match whole {
            true => {
                let own = last.map_or(held.layers().start..held.layers().start, |_| {
                    common(&boxes[0], &seen)[0].clone()
                });
                own.start - held.layers().start..own.end - held.layers().start
            }
            false => before[first]..last.map_or(before[first], |last| before[last + 1]),
        };
        let width = if whole { layer } else { row };
        let numbers = self.opened.guess(before[boxes.len()], width * D, rows.clone())?;
        let mut guess = vec![0.0; window.nodes() * D];
        for (node, values) in guess.chunks_exact_mut(D).enumerate() {
            let at = window.node_at(node);
            let Some(held) = held.node_index(&at) else { continue };
            let start = if whole {
                held - rows.start * layer
            } else {
                let owner = past.owner(&[at[0], at[1]]);
                let [layers, along] = &boxes[owner];
                let line = before[owner] + (at[0] - layers.start) * along.len() + at[1] - along.start;
                (line - rows.start) * row + held % row
            };
            values.copy_from_slice(&numbers[start * D..(start + 1) * D]);
        }
        Ok(guess)
    }

    /// Closes the checkpoint. Collective.
    ///
    /// # Errors
    /// The same on all ranks (76).
    pub fn close(self) -> Result<(), Refusal> {
        self.opened.close()
    }
}

/// The grid cut into about equal loads; `None` where it has no room for so many ranks. Collective.
fn cut_again<const D: usize>(
    world: &SimpleCommunicator,
    case: &Case,
    held: &Grid<D>,
    points: &Points<D>,
) -> Option<(Grid<D>, Slabs)> {
    let ranks = world.size().unsigned_abs() as usize;
    let parts = case.parts(ranks, [held.room()[0].len(), held.room()[1].len()])?;
    let grid = held.with_columns([ranks / parts, parts]);
    let counts = sum(world, &load::points_by_column(&grid, points));
    let slabs = load::cut(&grid, &counts, ranks / parts)?;
    if parts == 1 {
        return Some((grid, slabs));
    }
    let counts = sum(world, &load::points_by_row(&grid, &slabs, points));
    let slabs = load::parted(&grid, slabs, &counts, parts)?;
    Some((grid, slabs))
}

fn sum(world: &SimpleCommunicator, own: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; own.len()];
    world.all_reduce_into(own, &mut sum[..], SystemOperation::sum());
    sum
}

/// Numbers that the state of a material point needs.
fn state_width(case: &Case) -> usize {
    bsmpm::material::state_width(case.materials.iter().map(|named| &named.material))
}

fn lengths<T>(lists: &[Vec<T>]) -> Vec<usize> {
    lists.iter().map(Vec::len).collect()
}

/// Whether `read` has as many lists, and as long ones, as the initial state of the model.
fn fits<K: Kinematics<D>, const D: usize>(read: &InteractionState<D>, model: &Model<K, D>) -> bool {
    let start = model.boundary.initial_state();
    let is_same = lengths(&read.traction) == lengths(&start.traction)
        && lengths(&read.position) == lengths(&start.position)
        && lengths(&read.pressure) == lengths(&start.pressure)
        && read.bodies.len() == start.bodies.len()
        && model.boundary.fits(&model.grid, &read.held);
    let anchors = &read.anchors;
    let has_none = anchors.strips.is_empty() && anchors.loads.is_empty();
    let is_anchored = has_none
        || (lengths(&anchors.strips) == lengths(&start.traction)
            && lengths(&anchors.loads) == lengths(&start.position));
    let wet = model.surfaces().water;
    let wet: Vec<usize> = wet.iter().map(|points| points.len()).collect();
    is_same && is_anchored && (anchors.water.is_empty() || lengths(&anchors.water) == wet)
}
