//! The validated case, in SI units and radians.

mod element;
mod flow;
mod history;
mod limit_load;
mod loads;
mod profile;
mod rigid;
mod stage;
mod water;

pub use crate::observables::{Face, HistorySubject, Made, PointSelection};
pub use crate::words::{Base, Format, Geometry, Nonlinear, Support, Word};
pub use element::{ElementStage, ElementTest};
pub use flow::{Drain, DrainSite, Flow, Inflow};
pub use history::{Check, Column, History, Quantity};
pub use limit_load::{LimitLoad, LoadWidth, SoughtLoad};
pub(crate) use loads::keeps_direction;
pub use loads::{
    Footing, Initial, LoadedLine, MotionPath, Plate, PointLoad, PrescribedMotion, Push, Shares, Site, Traction,
    Triangle,
};
pub use profile::Profile;
pub use rigid::{Rigid, RigidShape, RigidSolid};
pub use stage::{ActiveLoads, FaceSupport, Stage};
pub use water::Water;

use crate::error::Choice;
use crate::grid::{GridSpec, Line};
use crate::observables::FrameField;
use crate::words::{AnalysisType, LimitedIndicator, LinearSolver};
use bsmpm::dynamics::mass::MassMatrix;
use bsmpm::dynamics::newmark::Newmark;
use bsmpm::grid::extension::ExtendedSplines;
use bsmpm::interactions::coulomb::Contact;
use bsmpm::material::LayeredMaterial;
use bsmpm::model::Regime;
use bsmpm::model::WallVelocity;
use bsmpm::quadrature::Quadrature;
use bsmpm::stabilisation::Stabilisation;
use bsmpm_shapes::Region;

/// The key of the mass matrix.
pub const MASS: &str = "analysis.mass";

/// Everything that a run needs to know of what it solves.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// What the case is, in a line; empty if it does not say.
    pub title: String,
    /// Kind of the geometry.
    pub geometry: Geometry,
    /// Kind and time of the analysis.
    pub analysis: Analysis,
    /// The grid.
    pub grid: GridSpec,
    /// Materials in the order of the file; bodies name them by their number here.
    pub materials: Vec<NamedMaterial>,
    /// Bodies in the order of the file.
    pub bodies: Vec<Body>,
    /// What changes at a time, in the order of time.
    pub stages: Vec<Stage>,
    /// Body force, if any.
    pub gravity: Option<Gravity>,
    /// Water in the ground, if any.
    pub water: Option<Water>,
    /// Water that flows, if any does.
    pub flow: Option<Flow>,
    /// Motion of the ground, in whose frame the case is: s, increasing, and m/s2; empty without any.
    pub shaking: Vec<(f64, [f64; 3])>,
    /// Supports of the grid's faces: per axis the lower and the upper one; a plane has free ones along its third.
    pub boundary: [[Support; 2]; 3],
    /// What those of them do that are in contact with the material.
    pub contacts: [[Option<Contact>; 2]; 3],
    /// A rigid strip, if any.
    pub footing: Option<Footing>,
    /// Prescribed motions, in the order of the file.
    pub prescribed: Vec<PrescribedMotion>,
    /// Rigid bodies, in the order of the file.
    pub rigid: Vec<Rigid>,
    /// Tractions, in the order of the file.
    pub tractions: Vec<Traction>,
    /// Point loads, in the order of the file.
    pub point_loads: Vec<PointLoad>,
    /// -  factor by which the materials' strength is divided from the start on (section 3.2), if any
    pub strength_reduction: Option<f64>,
    /// Stress at the start, if any.
    pub initial: Option<Initial>,
    /// Whether that is led to equilibrium with the materials' own laws before the first step.
    pub settles: bool,
    /// Section 2.3 of the paper.
    pub stabilisation: Stabilisation,
    /// The non-linear iteration.
    pub solver: Solver,
    /// Frames.
    pub output: Output,
    /// What is recorded every step.
    pub histories: Vec<History>,
    /// The limit load that it seeks, if it seeks one.
    pub limit_load: Option<LimitLoad>,
    /// The hole or notch of the bodies that has the fewest cells across, if there is any.
    pub opening: Option<NarrowestOpening>,
    /// Fields along lines, in the order of the file.
    pub profiles: Vec<Profile>,
    /// Bounds that are verified at the end.
    pub checks: Vec<Check>,
    /// Tests of one point, which a run of the case leaves alone.
    pub elements: Vec<ElementTest>,
    /// What is doubtful but allowed.
    pub warnings: Vec<String>,
    /// Earlier names that the file or an override has, a sentence each with the name of now.
    pub renamings: Vec<String>,
    /// What the program chose by itself.
    pub notes: Vec<Choice>,
    /// The case as it is run: the file's text, or with overrides or a preset the same content, complete, written again.
    pub text: String,
}

impl Case {
    /// Whether any interface has friction: faces of the grid, a footing, prescribed segments or rigid bodies.
    pub fn has_interface_friction(&self) -> bool {
        let faces = self.contacts.iter().flatten().flatten().map(|law| law.friction);
        let footing = self.footing.iter().filter_map(|footing| footing.contact);
        let strips = footing.chain(self.prescribed.iter().filter_map(|prescribed| prescribed.contact));
        let rigid = self.rigid.iter().map(|rigid| rigid.friction);
        faces
            .chain(strips.map(|contact| contact.law.friction))
            .chain(rigid)
            .any(|friction| friction > 0.0)
    }

    /// Cells across the width of the footing in quasi-static analysis of ground that yields, of a half at a face of the
    /// grid across both halves; `None` for plates in 3-D, and where the case seeks a limit load, which is extrapolated.
    pub fn cells_across_footing(&self) -> Option<f64> {
        let yields = self
            .bodies
            .iter()
            .any(|body| self.materials[body.material].material.yields());
        let may_fail = yields && self.analysis.kind == AnalysisType::QuasiStatic && self.limit_load.is_none();
        let ends = self.footing.as_ref().filter(|_| may_fail)?.site.ends()?;
        let [from, to] = ends.map(|end| end[0]);
        let axis = &self.grid.axes[0];
        let is_half = [from, to]
            .into_iter()
            .any(|x| x == axis.lower() || x == axis.lower() + axis.length());
        let width = (to - from).abs() * if is_half { 2.0 } else { 1.0 };
        Some(width / axis.shortest())
    }

    /// Takes over the repeated breakpoints of a run that goes on, whatever the program would place today.
    pub fn keep_lines(&mut self, lines: [Vec<Line>; 3]) {
        if self.grid.lines == lines {
            return;
        }
        self.grid.lines = lines;
        self.notes.retain(|note| note.key != "grid.c0_lines");
        let number = self.grid.lines.each_ref().map(Vec::len);
        self.notes.push(Choice {
            key: "grid.c0_lines".to_owned(),
            value: ["x", "y", "z"][..self.geometry.dims()]
                .iter()
                .zip(number)
                .map(|(name, number)| format!("{number} along {name}"))
                .collect::<Vec<_>>()
                .join(", "),
            reason: "those of the run that is resumed".to_owned(),
        });
    }

    /// Takes over the mass matrix of a run that goes on, whatever the program would choose today.
    pub fn keep_mass(&mut self, mass: MassMatrix) {
        if self.analysis.mass == mass {
            return;
        }
        self.analysis.mass = mass;
        self.notes.retain(|note| note.key != MASS);
        self.notes.push(Choice {
            key: MASS.to_owned(),
            value: mass.word().to_owned(),
            reason: "that of the run that is resumed".to_owned(),
        });
    }
}

/// Kind and time of the analysis.
#[derive(Clone, Debug, PartialEq)]
pub struct Analysis {
    /// What it is called.
    pub kind: AnalysisType,
    /// Whether inertia acts.
    pub regime: Regime,
    /// s (quasi-static: pseudo-time)  end of the run
    pub end: f64,
    /// s (quasi-static: pseudo-time)  nominal step, the first one where steps grow; the step before a wanted time or
    /// the end is shortened
    pub dt: f64,
    /// -, s  a step over the one before it, and the longest to which they grow; `None`: all are alike
    pub growth: Option<(f64, f64)>,
    /// Time integration in dynamics.
    pub newmark: Newmark,
    /// Mass matrix of the nodes in dynamics.
    pub mass: MassMatrix,
    /// Which velocity points near fixed faces keep in dynamics.
    pub wall_velocity: WallVelocity,
}

/// A material and its name.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedMaterial {
    /// Name in the file.
    pub name: String,
    /// Law and parameters.
    pub material: LayeredMaterial,
    /// kg/m3; `None`: weightless
    pub density: Option<f64>,
    /// kg/m3  of points below the water table at the start; `None`: the same
    pub saturated: Option<f64>,
    /// -  pore pressure over the weight above at the start, r_u; 0: none
    pub ratio: f64,
    /// s  of its damping; 0: none
    pub retardation: f64,
}

/// A body of material points.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// What stages call it.
    pub name: Option<String>,
    /// Number of its material.
    pub material: usize,
    /// What it fills.
    pub region: Region,
    /// Points along each axis of a cell.
    pub points_per_cell: usize,
    /// m/s  at the start; `None`: at rest
    pub velocity: Option<[f64; 3]>,
    /// rad/s  rotation at the start, along its axis, and about which place, m
    pub spin: Option<[[f64; 3]; 2]>,
}

impl Body {
    /// Lower and upper corner of the smallest rectangle around it, m, in the case's coordinates; around the whole shape
    /// where something is cut out.
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        self.region.bounds()
    }

    /// Area, m².
    pub fn area(&self) -> f64 {
        self.region.area()
    }
}

impl Case {
    /// Whether a footing, a prescribed segment or face, or a rigid body moves along a path.
    pub fn has_prescribed_motion(&self) -> bool {
        let strips = self.footing.iter().map(|footing| &footing.path);
        let strips = strips.chain(self.prescribed.iter().map(|prescribed| &prescribed.path));
        let mut paths = strips.chain(self.rigid.iter().map(|rigid| &rigid.path));
        let turns = self
            .rigid
            .iter()
            .any(|rigid| rigid.rotation.iter().any(|(_, angle)| *angle != 0.0));
        turns || paths.any(MotionPath::moves)
    }

    /// Weight of all bodies that are there at the start vertically above `at` (m, in the case's coordinates) under the
    /// full gravity, Pa: `Σ ρ |g| l`, g its vertical component, l the length of the vertical ray inside a body. What
    /// lies beside each other is counted once: a body's left side belongs to it, its right side does not. With water
    /// less its uplift.
    pub fn overburden(&self, at: [f64; 3]) -> f64 {
        let Some(gravity) = &self.gravity else { return 0.0 };
        let g = gravity.acceleration[self.grid.dims() - 1].abs();
        if self.water.is_some() {
            return self.bodies_at_start().map(|body| self.weight_above(body, at, g)).sum();
        }
        let masses = self.bodies_at_start().map(|body| {
            let density = self.materials[body.material].density;
            density.map_or(0.0, |rho| rho * body.region.above(at))
        });
        g * masses.sum::<f64>()
    }
}

/// Body force per mass.
#[derive(Clone, Debug, PartialEq)]
pub struct Gravity {
    /// m/s2  when fully applied
    pub acceleration: [f64; 3],
    /// s (quasi-static: pseudo-time)  over which it grows linearly; 0: at once. With a stress at the start, whose
    /// vertical gravity acts from time 0, its horizontal part does.
    pub ramp: f64,
}

impl Gravity {
    /// Whether it acts along the last of the axes alone.
    pub(crate) fn is_straight(&self, dims: usize) -> bool {
        self.acceleration[..dims - 1].iter().all(|part| *part == 0.0)
    }

    /// Whether it acts downwards, along the last of the axes. In a quasi-static analysis it may have a horizontal part,
    /// the inertia of a pseudo-static one, which changes neither pore pressures nor the stress at the start.
    pub(crate) fn acts_down(&self, dims: usize, regime: Option<Regime>) -> bool {
        self.acceleration[dims - 1] < 0.0 && (self.is_straight(dims) || regime == Some(Regime::QuasiStatic))
    }
}

/// The non-linear iteration and the linear solver.
#[derive(Clone, Debug, PartialEq)]
pub struct Solver {
    /// Which iteration.
    pub nonlinear: Nonlinear,
    /// -  energy measure of convergence
    pub tolerance: f64,
    /// -  force measure of convergence; both must hold
    pub force_tolerance: f64,
    /// Iterations of one attempt.
    pub max_iterations: usize,
    /// What points weigh in integrals of the stress; fitted in quasi-static analysis with linear or quadratic splines
    /// only.
    pub quadrature: Quadrature,
    /// Whether functions of nearly empty cells are tied to those of full ones; in quasi-static analysis only.
    pub extended_splines: ExtendedSplines,
    /// -  coefficient of the artificial stiffness; 0: none
    pub background: f64,
    /// The linear solver.
    pub linear: LinearSolver,
    /// Whether the case leaves it to the program, which has taken what suits so many unknowns of a solid.
    pub by_size: bool,
    /// The same bits in every run on as many ranks.
    pub reproducible: bool,
}

impl Solver {
    /// The linear solver on so many ranks: of what the program takes by size, what repeats to the bit there if it must.
    pub fn linear_on(&self, ranks: usize) -> LinearSolver {
        match self.linear {
            LinearSolver::SplineMultigrid if ranks > 1 => LinearSolver::Direct,
            LinearSolver::MultigridCycles if self.by_size && self.reproducible && ranks > 1 => {
                LinearSolver::IncompleteCholesky
            }
            linear => linear,
        }
    }
}

/// What is written besides tables with a row a step; without `every` and `times` there are no frames.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Regular frames, if any.
    pub every: Option<Every>,
    /// s (quasi-static: pseudo-time)  further frames, increasing, within (0, end]; hit exactly
    pub times: Vec<f64>,
    /// Format of the frames.
    pub format: Format,
    /// Whether the measures of every iteration are kept.
    pub residuals: bool,
    /// Whether frames have the projected pressure besides the points' own.
    pub projected_pressure: bool,
    /// What frames show besides.
    pub fields: Vec<FrameField>,
    /// Indicators that may be beyond their limits.
    pub accept: Vec<LimitedIndicator>,
    /// When restart files are written.
    pub checkpoint: Checkpoint,
}

/// The hole or notch of the bodies that has the fewest cells across.
#[derive(Clone, Debug, PartialEq)]
pub struct NarrowestOpening {
    /// Keys of the shape.
    pub path: String,
    /// m  its least width
    pub width: f64,
    /// Cells across it, as large as those next to its walls.
    pub cells: f64,
    /// Cells across from which on the stress at the edge of a hole is within about 10 %, wherever its edge lies in a
    /// cell.
    pub least: f64,
}

impl NarrowestOpening {
    /// Its width to three digits, m.
    pub fn brief_width(&self) -> f64 {
        format!("{:.2e}", self.width).parse().unwrap_or(self.width)
    }

    /// Cells across that are enough, by the points along an axis of a cell: the RMS error is 6.5 % with 6 cells and 3
    /// points, 8.3 % with 8 cells and 2 points (trial `enough_cells_across_a_hole_find_the_stress_at_its_edge`).
    pub(crate) fn enough(points_per_cell: usize) -> f64 {
        if points_per_cell >= 3 { 6.0 } else { 8.0 }
    }
}

/// When restart files are written, besides where a run stops early.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checkpoint {
    /// s  by the clock between two
    pub wall: f64,
    /// Accepted steps between two, if they count at all.
    pub every_steps: Option<u64>,
    /// How many are kept, the newest ones.
    pub keep: u64,
    /// Whether one is written at the end of the case.
    pub at_end: bool,
}

impl Default for Checkpoint {
    /// Without a word of it in the case: nothing in short runs, at most a quarter of an hour is lost of long ones.
    fn default() -> Self {
        Self {
            wall: 900.0,
            every_steps: None,
            keep: 2,
            at_end: false,
        }
    }
}

/// Distance of regular frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Every {
    /// s (quasi-static: pseudo-time)  hit exactly
    Time(f64),
    /// Accepted steps.
    Steps(u64),
}
