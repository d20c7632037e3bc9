//! Reads the case of a search for the factor of safety.

use std::path::{Path, PathBuf};

use bsmpm::field::pore_water::flow::Motion;
use bsmpm_scene::observables::{HistorySubject, Observable};
use bsmpm_scene::words::{Geometry, Side, Support, Word};
use bsmpm_scene::{Case, NamedMaterial, PointSelection, Quantity, Rigid, RigidShape, Traction};
use serde::Serialize;

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
/// Strain by which a load may change the geometry: (weight of the body's height + traction)/E. Beyond, the branch after
/// failure, up to 20 times the elastic displacement, is flattened by the body's settling, and with it the factor.
const SMALL: f64 = 2e-3;
/// Stiffening by less is none.
const UNCHANGED: f64 = 1.01;
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

/// What belongs to a factor of safety.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Conditions {
    /// m  the largest size of a cell along each axis
    pub cell: Vec<f64>,
    /// of the B-splines
    pub order: usize,
    /// along each axis, of every body
    pub points_per_cell: Vec<usize>,
    pub stabilisation: String,
    /// of the artificial stiffness, over Young's modulus
    pub background: f64,
    /// of the energy
    pub tolerance: f64,
    /// of the forces
    pub force_tolerance: f64,
    /// nominal load steps
    pub steps: u64,
    /// Pa  of every material, where it depends on the height the largest
    pub young: Vec<f64>,
    /// by which the trials multiply all of them
    pub stiffness: f64,
}

impl Subject {
    /// The case at `path` with overrides, of which something is asked.
    ///
    /// # Errors
    /// [`Error::Missing`] for a file that cannot be read, [`Error::BadCase`] with all errors of the case,
    /// [`Error::NoFactor`] with all reasons why it has no factor of safety, [`Error::Usage`] for overrides of the
    /// factor.
    pub fn read(path: &Path, set: &[String], question: &FosQuestion<'_>) -> Result<Self, Error> {
        let FosQuestion {
            sought,
            from,
            stage,
            undrained,
            ..
        } = *question;
        if let Some(set) = set
            .iter()
            .map(|set| set.trim_start())
            .find(|set| set.starts_with("strength_reduction"))
        {
            let key = set.split('=').next().unwrap_or(set).trim_end();
            let reason = format!(
                "E0830: --set {key} changes the strength reduction, which `bsmpm fos` sets itself. Remove this --set. \
                 Choose a stage with --stage, and undrained failure with --undrained."
            );
            return Err(Error::Usage { reason });
        }
        let bytes = case::load(path)?;
        let mut set = set.to_vec();
        // As it is, which says what the trials set; then with the strength that the search begins with.
        let as_it_is = parsed(path, &bytes, &set)?;
        let from_the_start = if stage.is_none() {
            sought.overrides(&as_it_is, from, 1.0)
        } else {
            Vec::new()
        };
        let refused = sought.refusal(&as_it_is).map(|reason| vec![reason]);
        if let Some(reasons) = refused {
            return Err(Error::NoFactor {
                path: path.to_owned(),
                reasons,
            });
        }
        let case = parsed(path, &bytes, &[&set[..], &from_the_start].concat())?;
        let stage = match stage {
            Some(name) => Some((name.to_owned(), until(&case, name)?)),
            None => None,
        };
        let until = stage.as_ref().map(|(_, until)| *until);
        let reasons = refusals(&case, until);
        if !reasons.is_empty() {
            return Err(Error::NoFactor {
                path: path.to_owned(),
                reasons,
            });
        }
        let whole = Quantity::new(
            Observable::MaxDisplacement,
            HistorySubject::Part(PointSelection::default()),
        );
        let mut recorded: Vec<_> = case
            .histories
            .iter()
            .filter(|history| history.quantity == whole)
            .collect();
        recorded.sort_by_key(|history| history.scale == 1.0);
        let column = recorded.first().map_or(QUANTITY, |history| &history.name).to_owned();
        let scale = recorded.first().map_or(1.0, |history| history.scale);
        let counted = counted(&case, question.region)?;
        let sides = holding_sides(&case, until);
        let free_bodies = case
            .rigid
            .iter()
            .filter(|rigid| rigid.free.contains(&true))
            .map(|rigid| rigid.name.clone())
            .collect();
        let mut conditions = Conditions::of(&case, until);
        let is_whole = stage.is_none();
        let is_grown = is_whole && ramps(&case).any(|ramp| ramp == 0.0);
        if is_grown {
            set.push(format!("{UNLOADED}=true"));
        }
        if let Some((name, _)) = &stage {
            set.push(format!("{STAGE}={name:?}"));
        }
        if undrained {
            set.push(UNDRAINED.to_owned());
        }
        let [of_first, of_elastic] =
            [from, ELASTIC].map(|value| sought.overrides(&as_it_is, value, conditions.stiffness));
        let unloaded = if is_whole {
            Vec::new()
        } else {
            vec![format!("{UNLOADED}=true")]
        };
        let first = parsed(path, &bytes, &[&set[..], &of_first].concat())?;
        let elastic = parsed(path, &bytes, &[&set[..], &of_elastic, &unloaded].concat())?;
        let end = first.analysis.end;
        if let Some((_, until)) = &stage {
            // The first one is of the whole strength.
            conditions.steps = ((end - until) / case.analysis.dt).round() as u64 - 1;
        }
        let has_friction = case.has_interface_friction();
        let has_rigid = [
            !case.rigid.is_empty(),
            case.rigid.iter().any(Rigid::is_moved) || is_moved(&case),
        ];
        let softens = followed(&case, until).iter().any(|named| named.material.softens());
        let holds_water = first.flow.is_some_and(|flow| flow.at_rest == Motion::Held);
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
            sides,
            free_bodies,
            case: as_it_is,
            is_grown,
            is_stressed: is_whole && case.initial.is_some(),
            has_friction,
            has_rigid,
            holds_water,
            softens,
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
        let unloaded = self.stage.is_some() && factor == ELASTIC;
        let unloaded = if unloaded {
            vec![format!("{UNLOADED}=true")]
        } else {
            Vec::new()
        };
        [
            &self.set[..],
            &self.sought.overrides(&self.case, factor, self.conditions.stiffness),
            &unloaded,
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

/// What Young's moduli must be multiplied with so that the load strains no body by more than [`SMALL`], to three
/// digits.
fn stiffness(case: &Case, materials: &[NamedMaterial]) -> f64 {
    // What consolidates does so by its own stiffness, and what softens or has been compressed fails by it.
    let mut followed = (0..case.materials.len()).filter(|number| case.is_followed(*number));
    if case.flow.is_some() || followed.any(|number| case.materials[number].material.softens()) {
        return 1.0;
    }
    let up = case.grid.dims() - 1;
    let heights = case
        .bodies
        .iter()
        .map(|body| body.region.corners().map(|corner| corner[up]));
    let [low, high] = heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], [c, d]| {
        [a.min(c), b.max(d)]
    });
    let base = case.grid.lower()[up];
    let mut softest = f64::INFINITY;
    for body in &case.bodies {
        let material = &materials[body.material].material;
        for corner in body.region.corners() {
            softest = softest.min(material.at(corner[up] - base).elastic().young);
        }
    }
    let densities = case.bodies.iter().filter_map(|body| {
        let named = &case.materials[body.material];
        named.saturated.or(named.density)
    });
    let gravity = case.gravity.as_ref().map_or(0.0, |gravity| {
        gravity.acceleration.iter().fold(0.0, |length: f64, g| length.hypot(*g))
    });
    let weight = densities.fold(0.0, f64::max) * gravity * (high - low);
    let tractions = case.tractions.iter().map(Traction::largest);
    let driven = case.rigid.iter().map(|rigid| pressure(rigid, case.geometry, gravity));
    let needed = (weight + tractions.chain(driven).fold(0.0, f64::max)) / softest / SMALL;
    if needed < UNCHANGED {
        1.0
    } else {
        format!("{needed:.2e}").parse().unwrap_or(needed)
    }
}

/// Pa  what drives a rigid body, over its width.
fn pressure(rigid: &Rigid, geometry: Geometry, gravity: f64) -> f64 {
    let is_round = geometry == Geometry::Axisymmetric;
    let half = match &rigid.shape {
        RigidShape::Circle { radius, .. } => *radius,
        RigidShape::Polygon(corners) => {
            let [right, left] = [1.0, -1.0].map(|side| {
                let places = corners.iter().map(|corner| side * corner[0]);
                places.fold(f64::NEG_INFINITY, f64::max)
            });
            if is_round { right } else { 0.5 * (right + left) }
        }
        // Nothing moves freely in space.
        RigidShape::InSpace(_) => return 0.0,
    };
    let area = if is_round {
        std::f64::consts::PI * half * half
    } else {
        2.0 * half
    };
    (rigid.force[0].hypot(rigid.force[1]) + rigid.mass[0] * gravity) / area
}

/// When the stage of a name ends.
fn until(case: &Case, name: &str) -> Result<f64, Error> {
    case.end_of_stage(name).ok_or_else(|| {
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
    })
}

impl Conditions {
    fn of(case: &Case, until: Option<f64>) -> Self {
        let materials = case.materials_at(acting(case, until));
        let mut points_per_cell: Vec<usize> = case.bodies.iter().map(|body| body.points_per_cell).collect();
        points_per_cell.dedup();
        Self {
            cell: case.grid.axes.iter().map(bsmpm_scene::GridAxis::longest).collect(),
            order: case.grid.order,
            points_per_cell,
            stabilisation: case.stabilisation.word().to_owned(),
            background: case.solver.background,
            tolerance: case.solver.tolerance,
            force_tolerance: case.solver.force_tolerance,
            steps: (case.analysis.end / case.analysis.dt).round() as u64,
            young: followed(case, until)
                .iter()
                .map(|named| named.material.elastic().young)
                .collect(),
            stiffness: stiffness(case, &materials),
        }
    }

    /// Cells and points in words.
    pub fn mesh(&self) -> String {
        let mut sizes: Vec<String> = self.cell.iter().map(|size| format!("{} m", shown(*size))).collect();
        sizes.dedup();
        let cell = format!("h = {}", sizes.join(" x "));
        let points = self.points_per_cell.iter();
        let points: Vec<String> = points
            .map(|points| vec![points.to_string(); self.cell.len()].join(" x "))
            .collect();
        format!("{cell}, {} points a cell, order {}", points.join(" and "), self.order)
    }

    /// Everything in words.
    pub fn lines(&self) -> [String; 2] {
        let young: Vec<String> = self.young.iter().map(|young| shown(young * 1e-6)).collect();
        [
            format!(
                "{}; {}; background {:e} E",
                self.mesh(),
                self.stabilisation,
                self.background
            ),
            format!(
                "{} load steps; tolerances {:e} (energy), {:e} (forces); E = {} MPa{}",
                self.steps,
                self.tolerance,
                self.force_tolerance,
                young.join(", "),
                if self.stiffness == 1.0 {
                    String::new()
                } else {
                    format!(", times {}", self.stiffness)
                }
            ),
        ]
    }
}

/// A number without the noise that divisions leave at its end.
fn shown(number: f64) -> String {
    crate::record::short(number).to_string()
}
