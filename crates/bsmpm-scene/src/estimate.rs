//! Estimates unknowns and memory of a case before its run, with coefficients fitted to measurements.

use crate::case::{Body, Case, Nonlinear};
use crate::grid::GridSpec;
use crate::words::{Geometry, LinearSolver};
use bsmpm::grid::room;
use bsmpm::model::Regime;
use bsmpm::step::adjoint::is_dilatant;
use std::ops::Range;

/// Largest number of cells, unknowns and matrix rows: PETSc's and MPI's counts are 32-bit here.
pub(crate) const MOST_UNKNOWNS: u128 = i32::MAX as u128;
/// Largest number of points: they are sorted by 32-bit numbers, and exact sums have room for 2^31 terms.
pub(crate) const MOST_POINTS: u128 = i32::MAX as u128;

/// Bytes of a point that are always there: its state in a plane (about 200), shape functions (96), trial states and
/// their answers. Measured, as all that follows, in the runs of `tests/shipped.rs`.
const POINT: u128 = 536;
/// The same in space: functions of 27 nodes by axes, whole tensors.
const POINT_IN_SPACE: u128 = 780;
/// Bytes of a point's functions of the degree below, which `consistent-f-bar` averages with.
const LOWERED: u128 = 64;
/// Bytes of a point that water flows through: pressure and gradient, shape functions of the degree below with their
/// derivatives, what it is at the start of the step.
const WET: u128 = 24 + 96 + 200;
/// Bytes of a point while a step is saved; not there while the system is built.
const SAVED: u128 = 380;
/// Bytes of a node's vectors: about a dozen, and twenty secants of three, all of two doubles.
const VECTORS: u128 = (12 + 20 * 3) * 16;
/// Bytes of an entry of the stiffness: matrix, value, place in the matrix and what the factorisation, or
/// another preconditioner, copies.
const ENTRY: u128 = 36;
/// Bytes of an entry while the system is built; not there while a step is saved.
const BUILT: u128 = 44;
/// Bytes of an entry where an incomplete factor is applied, or multigrid: rows, value, and the factor's half of them.
const ROUGH_ENTRY: u128 = 25;
/// Bytes of an entry on the coarser levels of multigrid over the grid's splines, and of an unknown in the factors of
/// the boxes of its smoother, which overlap: 192/2 numbers, times (4/3)^3, on all levels.
const COARSER: u128 = 2;
const PATCHES: u128 = 1100;
/// Bytes of an entry that every further rank holds where all factorise the whole system: it is sent, collected and
/// copied.
const REPEATED: u128 = 60;
/// Bytes of a symmetric factor per unknown and level of a nested dissection: 15 doubles with their workspace. A general
/// one has twice of it.
const LEVEL: u128 = 15 * 8;
/// The same of a factorisation by dissection, which holds nothing else of the system.
const FRONT: u128 = 12 * 8;
/// The same in space per unknown, cube root of their number and square of the reach: separators are planes so many
/// layers thick. Measured on 10,000 and 63,000 that reach two and three layers.
const DENSE: u128 = 85;
/// Bytes of a second rank per square of the unknowns of the layers at the cut: beside its front they are in the rims of
/// fronts of many levels below. Measured on the same.
const CUT: u128 = 48;
/// Bytes of a number.
const NUMBER: u128 = 8;
/// Bytes of an unknown in the Krylov space of Newton's directions: two doubles for each of a hundred products.
const KRYLOV: u128 = 100 * 16;
/// The same where water flows, of as many products as there may be.
const KRYLOV_OF_WATER: u128 = bsmpm::solve::fgmres::MOST as u128 * 16;
/// Bytes of a process that has next to nothing to solve: libraries and buffers of MPI and PETSc.
const PROCESS: u128 = 52_000_000;

/// Poisson's ratio up to which the stiffness that secants correct is without F-bar's coupling in space.
const LOCAL: f64 = 0.45;
/// The same of material that yields at rest: what flows is nearly incompressible.
const LOCAL_AT_REST: f64 = 0.4;

/// Unknowns of a rank below which it mostly waits for others, in two dimensions.
const FEWEST: u128 = 1000;

/// Sizes that follow from a case; unknowns are bounded from above, since empty cells have none. Vectors are held for
/// the nodes of the room that the bodies have, however large the grid is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Estimate {
    /// Cells of the grid.
    pub cells: u64,
    /// Nodes of the grid: functions of the tensor product.
    pub nodes: u64,
    /// Nodal components, supported ones included.
    pub unknowns: u64,
    /// Nodal components that the bodies' cells touch at the start.
    pub active: u64,
    /// Pore pressures that the bodies' cells touch at the start, unknowns besides; 0 where no water flows.
    pub pressures: u64,
    /// Entries of the stiffness among those.
    pub entries: u64,
    /// Material points.
    pub points: u64,
    /// Ranks that have something to do: at least a thousand unknowns each, and [`Case::most_ranks`] at most.
    pub useful_ranks: u64,
    /// Memory of all ranks together, bytes, their libraries and what each repeats included, where the bodies are at the
    /// start and as long as `auto` needs no Newton's method. Within 0.8 to 1.5 of the peaks that were measured on one
    /// to three ranks; bodies that spread take more.
    pub bytes: u64,
    /// The same once Newton's method is needed.
    pub bytes_with_newton: u64,
}

/// Linear systems of a step: the stiffness that the secants correct, and the general one of Newton's directions.
struct Systems {
    /// bytes
    held: u128,
    /// bytes that every further rank holds again
    repeated: u128,
    /// bytes while they are built
    built: u128,
    /// bytes of the general one, and those that every further rank holds again, where it is made only if a step needs
    /// it
    perhaps: [u128; 2],
}

/// Settings that the memory of linear systems depends on.
#[derive(Clone, Copy)]
struct SolverSettings {
    linear: LinearSolver,
    reproducible: bool,
    nonlinear: Nonlinear,
}

impl Systems {
    /// `entries` of the stiffness of so many `unknowns` along so many axes, which couples layers of nodes up to `reach`
    /// apart: separators are as wide, in which the constants are those of quadratic splines. By `nonlinear`.
    ///
    /// Where water `flows` Newton's directions are preconditioned by those of the secants, and have one unknown a node
    /// more.
    fn of(settings: SolverSettings, dims: usize, unknowns: u128, entries: u128, reach: u128, flows: bool) -> Self {
        let SolverSettings {
            linear,
            reproducible,
            nonlinear,
        } = settings;
        let direct = linear == LinearSolver::Direct;
        let levels = u128::from(unknowns.max(2).ilog2());
        let flat = unknowns * levels;
        let [factor, fronts] = match dims {
            2 => [flat * LEVEL * reach / 2, flat * FRONT * reach.pow(2) / 4],
            _ => [DENSE * reach.pow(2) * (unknowns as f64).powf(4.0 / 3.0) as u128; 2],
        };
        let factor = if direct { factor } else { 0 };
        let again = u128::from(direct && reproducible);
        let elastic = if direct {
            [fronts, 0, 0]
        } else if linear == LinearSolver::SplineMultigrid {
            [entries * COARSER + unknowns * PATCHES, 0, 0]
        } else if linear.is_rough() {
            [entries * ROUGH_ENTRY, 0, 0]
        } else {
            [entries * ENTRY, 0, entries * BUILT]
        };
        // Of water one number of every node more.
        let wet = (unknowns + unknowns / dims as u128) * KRYLOV_OF_WATER;
        // In space, and around a preconditioner that is applied in place of solutions, there is no general matrix.
        let around = linear.is_rough() || dims > 2;
        let krylov = unknowns * if around { KRYLOV_OF_WATER } else { KRYLOV };
        let repeated = again * (entries * REPEATED + 2 * factor);
        let general = match flows {
            true => [elastic[0] + wet, elastic[1], elastic[2]],
            false if around => [elastic[0] + krylov, elastic[1], elastic[2]],
            false => [entries * ENTRY + 2 * factor + krylov, repeated, entries * BUILT],
        };
        let [held, repeated, built] = if nonlinear == Nonlinear::Newton {
            general
        } else {
            elastic
        };
        let perhaps = match nonlinear {
            Nonlinear::Auto if flows => [wet, 0],
            Nonlinear::Auto if around => [krylov, 0],
            Nonlinear::Auto => [general[0], general[1]],
            _ => [0; 2],
        };
        Self {
            held,
            repeated,
            built,
            perhaps,
        }
    }
}

impl Case {
    /// Layers of nodes, beyond those of a cell, with which a node is coupled along an axis.
    pub(crate) fn beyond(&self) -> usize {
        // In space the coupled stiffness has 343 blocks a node instead of 125, which pays near incompressibility only.
        if self.grid.dims() == 3 && !self.is_nearly_incompressible() {
            return 0;
        }
        self.stabilisation.beyond(self.grid.order)
    }

    /// Whether some material is so nearly incompressible that in space the secants' stiffness has F-bar's coupling.
    pub(crate) fn is_nearly_incompressible(&self) -> bool {
        let is_at_rest = self.analysis.regime == Regime::QuasiStatic;
        self.materials.iter().map(|named| &named.material).any(|material| {
            let most = if is_at_rest && material.yields() {
                LOCAL_AT_REST
            } else {
                LOCAL
            };
            material.elastic().poisson > most
        })
    }

    /// Knot spans along each axis for which a run holds nodes at the start, see [`bsmpm::grid::room`]: at `least` so
    /// many columns, and rows in them.
    pub fn room(&self, least: [usize; 2]) -> Vec<Range<usize>> {
        if self.grid.dims() == 3 {
            self.room_in::<3>(least)
        } else {
            self.room_in::<2>(least)
        }
    }

    fn room_in<const D: usize>(&self, least: [usize; 2]) -> Vec<Range<usize>> {
        let cells: [usize; D] = std::array::from_fn(|axis| self.grid.spans(axis));
        let spans = self.bodies.iter().map(|body| -> [Range<usize>; D] {
            let cells = body.occupied(&self.grid);
            std::array::from_fn(|axis| self.grid.spans_of(axis, &cells[axis]))
        });
        let occupied = spans
            .reduce(|a, b| std::array::from_fn(|axis| a[axis].start.min(b[axis].start)..a[axis].end.max(b[axis].end)));
        let occupied = occupied.unwrap_or_else(|| cells.map(|cells| 0..cells));
        room::around(&occupied, cells, self.grid.order, self.beyond(), least).to_vec()
    }

    /// Pore pressures that the bodies' cells touch at the start, and entries of their matrix; `None` where no water
    /// flows.
    fn pressures(&self) -> Option<(u128, u128)> {
        self.flow.as_ref()?;
        let order = self.grid.order as u128 - 1;
        let pressures = occupied_nodes(self, order).min(nodes(&self.grid));
        Some((pressures, pressures * (2 * order + 1).pow(self.grid.dims() as u32)))
    }

    /// Bytes of a point in the derivative that Newton's directions are sought with: moduli, for every component of the
    /// gradient a gradient, under F-bar two gradients more, and its pressure's in dilatant material.
    fn linearised(&self) -> u128 {
        let components: u128 = match self.geometry {
            Geometry::PlaneStrain => 4,
            Geometry::Axisymmetric => 5,
            Geometry::Solid => 9,
        };
        let averaged = if self.stabilisation.averages() {
            2 * components
        } else {
            0
        };
        let dilates = self.materials.iter().any(|named| is_dilatant(&named.material));
        let adjoint = if self.stabilisation.lowers() && dilates {
            components + 2
        } else {
            0
        };
        (components.pow(2) + averaged + adjoint) * NUMBER
    }

    /// Bytes that another rank adds in space, where layers of nodes are large: those on both sides of the cut that rows
    /// reach, with so many `bytes` a node, and of a dissection what it has of the cut.
    fn ghosts(&self, occupied: u128, reach: u128, bytes: u128, dissects: bool) -> u128 {
        let longest = self
            .room([1; 2])
            .iter()
            .map(|spans| (spans.len() + self.grid.order) as u128)
            .max();
        let nodes = reach * (occupied / longest.unwrap_or(1));
        let separated = if dissects { 3 * nodes } else { 0 };
        2 * nodes * bytes + separated.pow(2) * CUT
    }

    /// Sizes of the case on so many ranks.
    pub fn estimate(&self, ranks: usize) -> Estimate {
        let nodes = nodes(&self.grid);
        let points = u128::from(self.points());
        let places = places(self);
        let dims = self.grid.dims() as u128;
        // The stencil of the stiffness: a double for each pair of components a place; of every node where it stands,
        // and of which kind it is.
        let stencil = places * dims.pow(2) * 8;
        let every = 8 + 2;
        let order = self.grid.order as u128;
        let occupied = occupied_nodes(self, order).min(nodes);
        let entries = dims * occupied * dims * places;
        let reach = order + self.beyond() as u128;
        let linear = self.solver.linear_on(ranks);
        let ranks = ranks as u128;
        let settings = SolverSettings {
            linear,
            reproducible: self.solver.reproducible,
            nonlinear: self.solver.nonlinear,
        };
        let flows = self.flow.is_some();
        let systems = Systems::of(settings, self.grid.dims(), dims * occupied, entries, reach, flows);
        let vectors = if dims == 3 { VECTORS * 3 / 2 } else { VECTORS };
        let (pressures, wet, wet_repeated) = self.water_system(settings).unwrap_or_default();
        let dissects = linear == LinearSolver::Direct;
        let ghosts = match dims {
            3 => self.ghosts(occupied, reach, stencil + every + vectors, dissects),
            _ => 0,
        };
        // Coordinates of entries, as rows are summed by several.
        let sums = ranks > 1 && linear.is_rough() && linear != LinearSolver::SplineMultigrid;
        let bytes = points * self.point_bytes()
            + occupied * stencil
            + room_nodes(self) * (every + vectors)
            + systems.held
            + systems.built.max(points * SAVED)
            + wet
            + ranks * PROCESS
            + (ranks - 1) * (systems.repeated + wet_repeated + ghosts)
            + if sums { entries * BUILT } else { 0 };
        let derivative = points * self.linearised();
        let [now, perhaps] = match self.solver.nonlinear {
            Nonlinear::Newton => [derivative, 0],
            Nonlinear::Auto => [0, derivative],
            _ => [0; 2],
        };
        let newton = perhaps + systems.perhaps[0] + (ranks - 1) * systems.perhaps[1];
        Estimate {
            cells: bounded(cells(&self.grid)),
            nodes: bounded(nodes),
            unknowns: bounded(dims * nodes),
            active: bounded(dims * occupied),
            pressures: bounded(pressures),
            entries: bounded(entries),
            points: self.points(),
            useful_ranks: bounded((dims * occupied / FEWEST).clamp(1, self.most_ranks() as u128)),
            bytes: bounded(bytes + now),
            bytes_with_newton: bounded(bytes + now + newton),
        }
    }

    /// Bytes of a point, its smoothing included.
    fn point_bytes(&self) -> u128 {
        let is_in_space = self.grid.dims() == 3;
        let point = if is_in_space { POINT_IN_SPACE } else { POINT };
        let lowered = if self.stabilisation.lowers() { LOWERED } else { 0 };
        let is_damped = self.materials.iter().any(|named| named.retardation > 0.0);
        let smoothing = if is_damped && self.stabilisation.smooths() {
            8 * if is_in_space { 6 } else { 4 }
        } else {
            0
        };
        point + lowered + smoothing
    }

    /// Number of the pore pressures, bytes of water that flows, and those that each further rank repeats; `None` where
    /// none flows.
    fn water_system(&self, settings: SolverSettings) -> Option<(u128, u128, u128)> {
        let (pressures, entries) = self.pressures()?;
        // Solved by itself, as a part of the directions.
        let settings = SolverSettings {
            nonlinear: Nonlinear::Broyden,
            ..settings
        };
        let reach = self.grid.order as u128 - 1;
        let system = Systems::of(settings, self.grid.dims(), pressures, entries, reach, true);
        // A third number of every node's vectors, secants included.
        let held = u128::from(self.points()) * WET + entries * 8 + room_nodes(self) * VECTORS / 2;
        Some((pressures, held + system.held, system.repeated))
    }
}

/// The number, or the largest one that can be given.
fn bounded(number: u128) -> u64 {
    u64::try_from(number).unwrap_or(u64::MAX)
}

/// Cells of the grid.
pub(crate) fn cells(grid: &GridSpec) -> u128 {
    grid.axes.iter().map(|axis| axis.cells() as u128).product()
}

/// Nodes of the grid.
pub(crate) fn nodes(grid: &GridSpec) -> u128 {
    (0..grid.dims())
        .map(|axis| (grid.spans(axis) + grid.order) as u128)
        .product()
}

/// Nodes with which a node is coupled: those of the cells around it, and of the layers beyond.
fn places(case: &Case) -> u128 {
    (2 * (case.grid.order as u128 + case.beyond() as u128) + 1).pow(case.grid.dims() as u32)
}

/// Nodes of the room that the bodies have at the start.
fn room_nodes(case: &Case) -> u128 {
    case.room([1; 2])
        .iter()
        .map(|cells| (cells.len() + case.grid.order) as u128)
        .product()
}

/// Functions of an order that the bodies' cells touch at the start: exact for boxes, and for shapes without holes or
/// bays.
fn occupied_nodes(case: &Case, order: u128) -> u128 {
    let bodies = case.bodies.iter();
    bodies.map(|body| nodes_of_body(&case.grid, body, order)).sum()
}

/// Functions of an order that a body's cells touch at the start.
fn nodes_of_body(grid: &GridSpec, body: &Body, order: u128) -> u128 {
    let cells = body.occupied(grid);
    let further = |axis: usize| grid.spans_of(axis, &cells[axis]).len() - cells[axis].len();
    if cells.len() == 3 {
        // Layers on all sides: of a cuboid exact.
        let within = body.cells(grid) as f64;
        let around = cells.iter().enumerate().map(|(axis, cells)| {
            (cells.len() + further(axis)) as f64 / cells.len().max(1) as f64 + order as f64 / cells.len().max(1) as f64
        });
        return (within * around.product::<f64>()).round() as u128;
    }
    let [columns, rows] = [0, 1].map(|axis| cells[axis].len() as u128);
    let repeated = further(0) as u128 * rows + further(1) as u128 * columns;
    body.cells(grid) + repeated + order * (columns + rows + order)
}
