//! Reads the case of a search for the factor of safety.

use std::path::{Path, PathBuf};

use bsmpm::field::pore_water::flow::Motion;
use bsmpm_scene::observables::{HistorySubject, Observable};
use bsmpm_scene::words::{Geometry, Side, Support, Word};
use bsmpm_scene::{Case, PointSelection, Quantity, Rigid};

use super::conditions::Conditions;
use super::moved::{CountedPoints, HoldingSide};
use super::refusal::{acting, followed, is_moved, ramps, refusals};
use super::sought::{ELASTIC, Sought};
use crate::Error;
use crate::case::{self, parsed};

/// The key that lets a trial start without stress.
const UNLOADED: &str = "strength_reduction.unloaded";
/// The key that says at the end of which stage.
const STAGE: &str = "strength_reduction.stage";
/// Water that stays where it is.
const UNDRAINED: &str = "strength_reduction.drainage=undrained";
/// What ends a run there, with a checkpoint.
const UNTIL: [&str; 2] = ["strength_reduction.steps=0", "output.checkpoint.wall=\"15 min\""];
/// What the factor of strength that falls with strain is.
const SOFTENS: &str = "W0809: a material softens, so the result depends on the size of the cells and on the stiffness \
     of the soil. Repeat the analysis with another `grid.cell`, and use the smaller result.";
/// The largest displacement of all points, as a case may record it.
const QUANTITY: &str = "max-displacement";

/// A case that can be searched.
#[derive(Debug)]
pub(super) struct Subject {
    path: PathBuf,
    bytes: Vec<u8>,
    /// overrides of all trials
    set: Vec<String>,
    /// the stage at whose end the factor is wanted, and when that is
    stage: Option<(String, f64)>,
    pub title: String,
    /// pseudo-time
    pub end: f64,
    /// of the trial of the elastic body
    elastic_end: f64,
    /// what the case calls the largest displacement
    pub column: String,
    /// by which the case multiplies it
    pub scale: f64,
    /// what the trials differ by
    pub sought: Sought,
    /// its least value that is tried
    pub from: f64,
    /// which points are judged
    pub counted: CountedPoints,
    /// sides of the grid that hold the ground in both directions
    pub sides: Vec<HoldingSide>,
    /// rigid bodies that move freely
    pub free_bodies: Vec<String>,
    case: Case,
    /// whether loads that the case lets act at once grow over the run
    is_grown: bool,
    /// whether the case begins with a stress, which trials do not
    is_stressed: bool,
    /// whether any interface has friction
    has_friction: bool,
    /// rigid bodies that are there; these or strips that are moved
    has_rigid: [bool; 2],
    /// water flows until then; in the trials it rests, and has the pressures of that time
    holds_water: bool,
    /// whether strength follows plastic strain, so that the stiffness of the ground matters, and no branch after
    /// failure leads back to it
    pub softens: bool,
    pub conditions: Conditions,
}

/// What is asked of a case.
pub(super) struct FosQuestion<'a> {
    pub sought: Sought,
    /// the least value that is tried
    pub from: f64,
    /// the stage at whose end the factor is wanted; without: of the body as it is drawn
    pub stage: Option<&'a str>,
    /// whether the water of that time stays where it is
    pub undrained: bool,
    /// the ends of the box in which material must lie to count: the lower ones, then the upper ones, m
    pub region: &'a [f64],
}

impl Subject {
    /// The case at `path` with overrides, of which something is asked.
    ///
    /// # Errors
    /// [`Error::Missing`] for a file that cannot be read, [`Error::BadCase`] with all errors of the case,
    /// [`Error::NoFactor`] with all reasons why it has no factor of safety, [`Error::Usage`] for overrides of the
    /// factor.
    pub fn read(path: &Path, set: &[String], question: &FosQuestion<'_>) -> Result<Self, Error> {
        let FosQuestion { sought, from, .. } = *question;
        refuse_overrides(set)?;
        let bytes = case::load(path)?;
        // As it is, which says what the trials set; then with the strength that the search begins with.
        let as_it_is = parsed(path, &bytes, set)?;
        if let Some(reason) = sought.refusal(&as_it_is) {
            return Err(no_factor(path, vec![reason]));
        }
        let is_whole = question.stage.is_none();
        let from_the_start = is_whole.then(|| sought.overrides(&as_it_is, from, 1.0));
        let case = parsed(path, &bytes, &[set, &from_the_start.unwrap_or_default()].concat())?;
        let stage = question.stage.map(|name| stage_of(&case, name)).transpose()?;
        let until = stage.as_ref().map(|(_, until)| *until);
        let reasons = refusals(&case, until);
        if !reasons.is_empty() {
            return Err(no_factor(path, reasons));
        }
        let counted = counted(&case, question.region)?;
        let is_grown = is_whole && ramps(&case).any(|ramp| ramp == 0.0);
        let set = overrides_of_all(set, question, is_grown);
        let mut conditions = Conditions::of(&case, until);
        let first = sought.overrides(&as_it_is, from, conditions.stiffness);
        let first = parsed(path, &bytes, &[&set[..], &first].concat())?;
        let elastic = sought.overrides(&as_it_is, ELASTIC, conditions.stiffness);
        let elastic = parsed(path, &bytes, &[&set[..], &elastic, &unloaded(!is_whole)].concat())?;
        let end = first.analysis.end;
        if let Some(until) = until {
            // The first one is of the whole strength.
            conditions.steps = ((end - until) / case.analysis.dt).round() as u64 - 1;
        }
        let (column, scale) = recorded(&case);
        Ok(Self {
            path: path.to_owned(),
            bytes,
            set,
            stage,
            title: case.title.clone(),
            end,
            elastic_end: elastic.analysis.end,
            column,
            scale,
            sought,
            from,
            counted,
            sides: holding_sides(&case, until),
            free_bodies: free_bodies(&case),
            case: as_it_is,
            is_grown,
            is_stressed: is_whole && case.initial.is_some(),
            has_friction: case.has_interface_friction(),
            has_rigid: [
                !case.rigid.is_empty(),
                case.rigid.iter().any(Rigid::is_moved) || is_moved(&case),
            ],
            holds_water: first.flow.is_some_and(|flow| flow.at_rest == Motion::Held),
            softens: followed(&case, until).iter().any(|named| named.material.softens()),
            conditions,
        })
    }

    /// The name and the time of the end of the stage that is meant, if one is.
    pub fn stage(&self) -> Option<(&str, f64)> {
        self.stage.as_ref().map(|(name, until)| (name.as_str(), *until))
    }

    /// The overrides, and the case's text, of the run until then.
    pub fn until_the_stage(&self) -> Result<(Vec<String>, String), Error> {
        let set = [&self.overrides(1.0)[..], &UNTIL.map(str::to_owned)].concat();
        parsed(&self.path, &self.bytes, &set).map(|case| (set, case.text))
    }

    /// When a trial begins, and when it ends.
    pub fn times(&self, factor: f64) -> [f64; 2] {
        match &self.stage {
            Some((_, until)) if factor != ELASTIC => [*until, self.end],
            _ => [0.0, self.elastic_end],
        }
    }

    /// The overrides of a trial.
    pub fn overrides(&self, factor: f64) -> Vec<String> {
        [
            &self.set[..],
            &self.sought.overrides(&self.case, factor, self.conditions.stiffness),
            &unloaded(self.stage.is_some() && factor == ELASTIC),
        ]
        .concat()
    }

    /// The overrides, and the case's text, of the elastic body under the inertia that the search begins with; none
    /// where strength is divided, as its trials have one elastic body.
    pub fn pushed_elastic(&self) -> Result<Option<(Vec<String>, String)>, Error> {
        if !self.sought.is_seismic() {
            return Ok(None);
        }
        let set = [
            &self.set[..],
            &self
                .sought
                .pushed_elastic(&self.case, self.from, self.conditions.stiffness),
        ]
        .concat();
        let text = parsed(&self.path, &self.bytes, &set)?.text;
        Ok(Some((set, text)))
    }

    /// What was done to the case that its reader should know.
    pub fn notes(&self) -> Vec<String> {
        let stiffness = self.conditions.stiffness;
        let stiffened = (stiffness != 1.0).then(|| {
            format!(
                "the trials use {stiffness} times the stiffness of the case, so that the geometry stays as drawn; \
                 the reported displacements are those of its own stiffness"
            )
        });
        let grown = self.is_grown.then(|| {
            "a load acts at once in the case (ramp = 0); in the trials it increases over the whole run".to_owned()
        });
        let unstressed = self.is_stressed.then(|| {
            "the trials start without the initial stress of the case ([initial]), because the limit load does not \
             depend on it (exactly so for associated plasticity)"
                .to_owned()
        });
        let staged = self.stage.as_ref().map(|(name, until)| {
            format!(
                "the strength is reduced from the state at the end of the stage \"{name}\", t = {until}; \
                 displacements are those since then, added to the elastic displacement"
            )
        });
        let has_friction = self.has_friction.then(|| {
            "the friction coefficient of interfaces (boundaries, footings, prescribed segments, rigid bodies, \
             terrain) is reduced by the same factor as the strength"
                .to_owned()
        });
        let rigid = self.has_rigid[0].then(|| "rigid bodies themselves cannot fail".to_owned());
        let stopped = self.has_rigid[1].then(|| {
            "rigid bodies and footings with a prescribed motion are fixed at the end of the stage; their force on \
             the soil decreases with its strength"
                .to_owned()
        });
        let softens = self.softens.then(|| SOFTENS.to_owned());
        let held = self.holds_water.then(|| bsmpm_scene::HELD_WATER.to_owned());
        staged
            .into_iter()
            .chain(has_friction)
            .chain(rigid)
            .chain(stopped)
            .chain(held)
            .chain(softens)
            .chain(stiffened)
            .chain(grown)
            .chain(unstressed)
            .collect()
    }

    /// The text of a trial's case as its `run.json` has it.
    pub fn text(&self, factor: f64) -> Result<String, Error> {
        parsed(&self.path, &self.bytes, &self.overrides(factor)).map(|case| case.text)
    }

    /// The case's file.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

/// Refuses overrides of what the search itself sets.
fn refuse_overrides(set: &[String]) -> Result<(), Error> {
    let mut set = set.iter().map(|set| set.trim_start());
    let Some(set) = set.find(|set| set.starts_with("strength_reduction")) else {
        return Ok(());
    };
    let key = set.split('=').next().unwrap_or(set).trim_end();
    let reason = format!(
        "E0830: --set {key} changes the strength reduction, which `bsmpm fos` sets itself. Remove this --set. \
         Choose a stage with --stage, and undrained failure with --undrained."
    );
    Err(Error::Usage { reason })
}

/// Says that the case at `path` has no factor of safety.
fn no_factor(path: &Path, reasons: Vec<String>) -> Error {
    Error::NoFactor {
        path: path.to_owned(),
        reasons,
    }
}

/// The overrides `set` of the search, and those that all of its trials have in addition.
fn overrides_of_all(set: &[String], question: &FosQuestion<'_>, is_grown: bool) -> Vec<String> {
    let mut set = [set, &unloaded(is_grown)].concat();
    if let Some(name) = question.stage {
        set.push(format!("{STAGE}={name:?}"));
    }
    if question.undrained {
        set.push(UNDRAINED.to_owned());
    }
    set
}

/// The override that lets a trial start without stress, if it does.
fn unloaded(is_unloaded: bool) -> Vec<String> {
    is_unloaded.then(|| format!("{UNLOADED}=true")).into_iter().collect()
}

/// What the case calls the largest displacement of all points, and by which it multiplies it.
fn recorded(case: &Case) -> (String, f64) {
    let whole = Quantity::new(
        Observable::MaxDisplacement,
        HistorySubject::Part(PointSelection::default()),
    );
    let histories = case.histories.iter().filter(|history| history.quantity == whole);
    let recorded = histories.min_by_key(|history| history.scale == 1.0);
    let column = recorded.map_or(QUANTITY, |history| &history.name).to_owned();
    (column, recorded.map_or(1.0, |history| history.scale))
}

/// Names of the rigid bodies that move freely.
fn free_bodies(case: &Case) -> Vec<String> {
    let free = case.rigid.iter().filter(|rigid| rigid.free.contains(&true));
    free.map(|rigid| rigid.name.clone()).collect()
}

/// Which points of a case are judged, in a region of `[lower..., upper...]` or everywhere.
fn counted(case: &Case, region: &[f64]) -> Result<CountedPoints, Error> {
    let dims = case.grid.dims();
    let points_per_cell = case.bodies.iter().map(|body| body.points_per_cell).max().unwrap_or(1);
    let whole = CountedPoints {
        dims,
        points_per_cell,
        region: None,
    };
    if region.is_empty() {
        return Ok(whole);
    }
    let (lower, upper) = region.split_at(region.len() / 2);
    if region.len() != 2 * dims || lower.iter().zip(upper).any(|(low, high)| low >= high) {
        let reason = format!(
            "E0832: --region does not describe a box. Give the {dims} lower coordinates, then the {dims} upper \
             coordinates in m, separated by commas."
        );
        return Err(Error::Usage { reason });
    }
    let corners = [lower, upper].map(|corner| std::array::from_fn(|axis| corner.get(axis).copied().unwrap_or(0.0)));
    Ok(CountedPoints {
        region: Some(corners),
        ..whole
    })
}

/// The sides of the grid that hold the ground in both directions once the stages until the time `until` have begun.
fn holding_sides(case: &Case, until: Option<f64>) -> Vec<HoldingSide> {
    let names = Side::of(case.geometry);
    let faces = case.faces_at(acting(case, until)).into_iter();
    let mut sides = Vec::new();
    for of in faces.filter(|of| matches!(of.support, Support::Fixed | Support::Roller)) {
        let axis = of.face.axis;
        let upper = of.face.upper;
        if case.geometry == Geometry::Axisymmetric && axis == 0 && !upper {
            continue; // the axis of symmetry
        }
        let line = &case.grid.axes[axis];
        let cells = line.cells();
        let ends = if upper { [cells - 1, cells] } else { [0, 1] };
        sides.push(HoldingSide {
            name: names[axis][usize::from(upper)].word(),
            axis,
            cells: ends.map(|number| line.breakpoint(number)),
        });
    }
    sides
}

/// The stage of a name, and when it ends.
fn stage_of(case: &Case, name: &str) -> Result<(String, f64), Error> {
    let until = case.end_of_stage(name).ok_or_else(|| {
        let names = case
            .stages
            .iter()
            .filter_map(|stage| stage.name.as_ref())
            .map(|name| format!("{name:?}"));
        let names: Vec<String> = names.chain(["start", "end"].map(|name| format!("{name:?}"))).collect();
        Error::Usage {
            reason: format!(
                "E0833: the case has no stage {name:?}. Choose one of: {}.",
                names.join(", ")
            ),
        }
    })?;
    Ok((name.to_owned(), until))
}
