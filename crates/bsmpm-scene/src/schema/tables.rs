//! Schema of the case file's main tables: analysis, grid, boundaries and solver.

use super::body::BodyTable;
use super::element::ElementTable;
use super::flow::{DrainTable, InflowTable};
use super::loads::{
    ContactTable, FootingTable, InitialTable, PointLoadTable, PrescribedTable, ReductionTable, ShakingTable,
    TractionTable,
};
use super::material::MaterialTable;
use super::output::{CheckTable, HistoryTable, OutputTable, ProfileTable};
use super::rigid::RigidTable;
use super::site::StripKeys;
use super::stage::StageTable;
use super::water::WaterTable;
use super::{Dimension as In, Kind, Range, Table};
use crate::document::DocumentTable;
use crate::record::{self, CaseTable};
use crate::report::Report;
use crate::words::{
    Accuracy, AnalysisType, BACKGROUND_CELLS, BACKGROUND_KIND, C0Lines, Geometry, LinearSolver, Nonlinear, Order,
    Purpose, Support,
};
use bsmpm::dynamics::mass::MassMatrix;
use bsmpm::grid::extension::ExtendedSplines;
use bsmpm::model::WallVelocity;
use bsmpm::quadrature::Quadrature;
use bsmpm::stabilisation::Stabilisation;
use std::ops::Bound::{Excluded, Included};

table! {
    /// One case: everything that a run needs.
    struct Draft = "the file" {
        /// A short description of the case.
        title: Text(200), Optional, example(r#""Slope with a phreatic line""#);
        /// Geometry of the analysis.
        geometry: Choice(Geometry), Required, example(r#""plane-strain""#);
        /// Chooses the cells, material points, steps and tolerances that the case does not give, by the [table of
        /// presets](#presets-of-accuracy). Not available in 3-D.
        accuracy: Choice(Accuracy), Optional, example(r#""draft""#);
        /// Type of the analysis and its duration.
        analysis: Table(AnalysisTable), Required, example(r#"{ type = "dynamic", end = "5 s", dt = "5 ms" }"#);
        /// The grid of B-splines.
        grid: Table(GridTable), Required, example(r#"{ lower = [0.0, 0.0], upper = [40.0, 12.0], cell = "0.5 m" }"#);
        /// Materials, each with a name.
        material: Named(MaterialTable), Required,
            example(r#"{ clay = { model = "tresca", young = "10 MPa", poisson = 0.49, cohesion = "30 kPa" } }"#);
        /// Bodies of soil, which are filled with material points.
        body: Tables(BodyTable), Required,
            example(r#"[{ material = "clay", box = { lower = [0.0, 0.0], upper = [20.0, 8.0] } }]"#);
        /// Gravity. Without this table there is no gravity.
        gravity: Table(GravityTable), Optional, example(r#"{ acceleration = [0.0, -9.81] }"#);
        /// Water in the ground. Without this table there is no water.
        water: Table(WaterTable), Optional, example(r#"{ level = "4 m" }"#);
        /// A surface through which water flows freely.
        drain: Tables(DrainTable), Optional, example(r#"[{ face = "bottom", head = "3 m" }]"#);
        /// A surface through which water enters the ground at a given rate.
        inflow: Tables(InflowTable), Optional,
            example(r#"[{ from = [0.0, 8.0], to = [20.0, 8.0], rate = "10 mm/h", runoff = true }]"#);
        /// Acceleration of the ground in an earthquake.
        shaking: Table(ShakingTable), Optional,
            example(r#"{ acceleration = [[0.0, 0.0, 0.0], [0.5, "0.1 g", 0.0], [1.0, 0.0, 0.0]] }"#);
        /// Supports at the faces of the grid.
        boundary: Table(BoundaryTable), Default("{}"),
            example(r#"{ bottom = "fixed", left = "roller", right = "roller" }"#);
        /// Method that prevents volumetric locking and oscillating stresses. Without this table no such method is
        /// used.
        stabilisation: Table(StabilisationTable), Optional, example(r#"{ method = "consistent-f-bar" }"#);
        /// Nonlinear iteration and linear solver.
        solver: Table(SolverTable), Default("{}"), example(r#"{ nonlinear = "newton", linear = "direct" }"#);
        /// Frames for ParaView. Without this table the run writes one frame at the start and one at the end.
        output: Table(OutputTable), Optional, example(r#"{ every = "0.5 s", fields = ["q", "yielding"] }"#);
        /// A quantity that history.csv records at every step.
        history: Tables(HistoryTable), Optional, example(r#"[{ quantity = "runout", percentile = 99.0 }]"#);
        /// Bounds of a column of history.csv.
        check: Tables(CheckTable), Optional, example(r#"[{ quantity = "max-displacement", max = "2 cm" }]"#);
        /// A rigid footing with a prescribed motion.
        footing: Table(FootingTable), Optional,
            example(r#"{ from = [0.0, 8.0], to = [1.0, 8.0], displacement = [0.0, "-10 cm"] }"#);
        /// A prescribed motion of the soil at a face of the grid or at a segment.
        prescribed: Tables(PrescribedTable), Optional,
            example(r#"[{ face = "right", displacement = ["-5 cm", 0.0], components = "normal" }]"#);
        /// A rigid body in frictional contact with the soil.
        rigid: Tables(RigidTable), Optional,
            example(r#"[{ name = "pipe", circle = { centre = [10.0, 6.0], radius = 0.3 }, displacement = [0.0, 0.2] }]"#);
        /// A load per area on the surface of a body.
        traction: Tables(TractionTable), Optional,
            example(r#"[{ from = [0.0, 8.0], to = [5.0, 8.0], stress = [0.0, "-20 kPa"], ramp = "0.5 s" }]"#);
        /// A force at a point of a body.
        point_load: Tables(PointLoadTable), Optional,
            example(r#"[{ at = [5.0, 8.0], force = [0.0, "-10 kN/m"] }]"#);
        /// Reduction of the strength of all materials.
        strength_reduction: Table(ReductionTable), Optional, example(r#"{ factor = 1.25 }"#);
        /// Initial stress. Without this table the bodies start without stress.
        initial: Table(InitialTable), Optional, example(r#"{ k0 = 0.5 }"#);
        /// Laboratory tests of one material point, which `bsmpm element` computes.
        element: Named(ElementTable), Optional,
            example(r#"{ test = { material = "clay", pressure = 1e5, stage = [{ test = "triaxial", compression = 0.1 }] } }"#);
        /// A change at a given time, for instance an excavation or a layer of fill.
        stage: Tables(StageTable), Optional,
            example(r#"[{ name = "excavated", at = "0.5 s", remove = ["upper_layer"] }]"#);
        /// Values along a line, written to a file.
        profile: Tables(ProfileTable), Optional,
            example(r#"[{ name = "wall", from = [2.0, 0.0], to = [2.0, 6.0], count = 25, quantities = ["stress"] }]"#);
    }
}

/// The table of the whole file.
pub const ROOT: &Table = Draft::TABLE;

impl Draft {
    /// Reads the whole file; errors go to `report`.
    pub(crate) fn read(document: &DocumentTable, report: &mut Report<'_>) -> Self {
        Self::from_record(record::read(ROOT, document, report))
    }

    /// The footing and the prescribed motions, in the order of their numbers.
    pub(crate) fn strips(&self) -> impl Iterator<Item = StripKeys<'_>> {
        let footing = self.footing.value().map(FootingTable::strip);
        let prescribed = self.prescribed.items().iter();
        footing.into_iter().chain(prescribed.map(PrescribedTable::strip))
    }
}

table! {
    /// Type and duration of the analysis. A dynamic analysis uses Newmark's method with beta = 1/4 and gamma = 1/2,
    /// unless numerical damping is given. The time of a quasi-static analysis is a pseudo-time without unit.
    struct AnalysisTable = "[analysis]" {
        /// Type of the analysis, which determines whether inertia acts and what the time means.
        r#type: Choice(AnalysisType), Required, example(r#""dynamic""#);
        /// Time at which the run ends. Required, except in quasi-static analyses (default: 1.0).
        end: Quantity(In::Time, Range::POSITIVE), Optional, example(r#""2 s""#);
        /// Nominal time step. If neither `dt` nor `steps` is given, `accuracy` or `purpose` chooses the steps.
        dt: Quantity(In::Time, Range::POSITIVE), Optional, symbol("Δt"), example(r#""1 ms""#);
        /// Alternative to `dt`: number of equal steps.
        steps: Count(1, 1_000_000_000), Optional, example("40");
        /// Ratio of the sizes of consecutive steps, in consolidation. The first step of the run and of every stage
        /// has the size dt. Without this key the step size is constant.
        growth: Quantity(In::Number, GROWTH), Optional, example("1.2");
        /// Upper bound of the step size with `growth`. Without this key there is no bound.
        dt_max: Quantity(In::Time, Range::POSITIVE), Optional, example(r#""10 d""#);
        /// Numerical damping, as the spectral radius of the time integration at infinite frequency (WBZ-alpha,
        /// second-order accurate). Smaller values damp high frequencies more. Default: 1 (no damping).
        spectral_radius: Quantity(In::Number, UP_TO_1), Optional, symbol("ρ∞"), example("0.8");
        /// Mass matrix. Default: "consistent" with [shaking] or if all materials are elastic, unless something is in
        /// contact; otherwise "lumped".
        mass: Choice(MassMatrix), Optional, example(r#""consistent""#);
        /// Velocity of the material points within a cell of a fixed face of the grid. Default: "own", or "relaxed"
        /// for mu-i material with lumped mass.
        wall_velocity: Choice(WallVelocity), Optional, example(r#""relaxed""#);
        /// Purpose of a quasi-static analysis under a prescribed displacement. "limit-load" chooses the material
        /// points, degree, stabilisation, steps and tolerances that the case does not give. It also multiplies the
        /// stiffness and divides the prescribed displacements by the same factor. The stresses stay the same, and the
        /// geometry hardly changes.
        purpose: Choice(Purpose), Optional, example(r#""limit-load""#);
        /// Alternative to `spectral_radius`: Newmark's gamma. Values above 0.5 damp high frequencies and reduce the
        /// accuracy to first order.
        newmark_gamma: Quantity(In::Number, GAMMA), Optional, symbol("γ"), example("0.6"), renamed_from(&["gamma"]);
    }
    one_of preset [dt, steps];
    one_of optional [spectral_radius, newmark_gamma];
}

const GROWTH: Range = Range::of(Included(1.0), Included(10.0));
const GAMMA: Range = Range {
    lower: Included(0.5),
    upper: Included(1.0),
    why: "below 0.5 the time integration creates energy",
};

table! {
    /// The grid of B-splines. The knot vectors are open, and each cell is a knot span.
    struct GridTable = "[grid]" {
        /// Corner with the smallest coordinates. Required without `knots`.
        lower: Vector(In::Length, Range::ANY), Optional, example("[0.0, 0.0]");
        /// Corner with the largest coordinates. Required without `knots`. If the length is not a whole number of
        /// cells, the program enlarges the grid at a free face.
        upper: Vector(In::Length, Range::ANY), Optional, example("[40.0, 12.0]");
        /// Edge length of the cells: one value, or one along each axis. If neither `cell` nor `knots` is given,
        /// `accuracy` chooses the cells.
        cell: Either(In::Length, Range::POSITIVE), Optional, symbol("h"), example(r#""0.5 m""#);
        /// Alternative to `cell`: grid lines with any spacing.
        knots: Table(KnotsTable), Optional, example(r#"{ x = [0.0, 1.0, 2.0, 4.0], y = [0.0, 0.5, 1.0] }"#);
        /// Degree of the B-splines.
        degree: Choice(Order), Default("\"quadratic\""),
            symbol("q"),
            example(r#""quadratic""#),
            renamed_from(&["order"]);
        /// Grid lines at which strains may jump. "automatic" chooses the lines where bodies with different stiffness
        /// or density meet, at the ends of footings and loaded segments, and at corners of rigid bodies.
        c0_lines: Choice(C0Lines), Default("\"automatic\""), example(r#""automatic""#);
    }
    one_of preset [cell, knots];
}

table! {
    /// Coordinates of the grid lines, in increasing order. A coordinate may be repeated. Where it is listed m times,
    /// at most q, the B-splines of degree q have q - m continuous derivatives.
    struct KnotsTable = "[grid.knots]" {
        /// Grid lines along x.
        x: List(In::Length, Range::ANY), Required, example("[0.0, 1.0, 2.0, 4.0]");
        /// Grid lines along y.
        y: List(In::Length, Range::ANY), Required, example("[0.0, 0.5, 1.0]");
        /// Grid lines along z, in 3-D.
        z: List(In::Length, Range::ANY), Optional, example("[0.0, 0.5, 1.0]");
    }
}

table! {
    /// Gravity, a force per mass.
    struct GravityTable = "[gravity]" {
        /// Full acceleration of gravity. A dynamic analysis may incline it, for instance for a chute. In a
        /// quasi-static analysis a horizontal component is a pseudo-static earthquake load: the seismic coefficient
        /// times 9.81 m/s2. Pore pressures and the stress of [initial] follow from the vertical component only.
        acceleration: Vector(In::Acceleration, Range::ANY), Required, symbol("g"), example("[0.0, -9.81]");
        /// Time in which gravity grows from zero to its full value. With 0 full gravity acts at once. With [initial]
        /// only the horizontal component grows; the vertical component acts from the start.
        ramp: Quantity(In::Time, Range::NOT_NEGATIVE), Default("0.0"), example("1.0");
    }
}

table! {
    /// Supports at the faces of the grid.
    struct BoundaryTable = "[boundary]" {
        /// Support at the face with the lowest x.
        left: ChoiceOr(Support, ContactTable), Default("\"free\""), example(r#""roller""#);
        /// Support at the face with the highest x.
        right: ChoiceOr(Support, ContactTable), Default("\"free\""), example(r#""roller""#);
        /// Support at the face with the lowest y (in 3-D: the lowest z).
        bottom: ChoiceOr(Support, ContactTable), Default("\"free\""), example(r#""fixed""#);
        /// Support at the face with the highest y (in 3-D: the highest z).
        top: ChoiceOr(Support, ContactTable), Default("\"free\""), example(r#""free""#);
        /// Support at the face with the lowest y. Only in 3-D. Default: "free".
        front: ChoiceOr(Support, ContactTable), Optional, example(r#""roller""#);
        /// Support at the face with the highest y. Only in 3-D. Default: "free".
        back: ChoiceOr(Support, ContactTable), Optional, example(r#""roller""#);
    }
}

support_table!(BoundaryTable);

table! {
    /// Method that prevents volumetric locking and oscillating stresses. The theory manual compares the methods.
    struct StabilisationTable = "[stabilisation]" {
        /// Method. The F-bar methods average volume changes over the grid.
        method: Choice(Stabilisation), Required, example(r#""consistent-f-bar""#), or_preset();
    }
}

table! {
    /// Nonlinear iteration and linear solver.
    struct SolverTable = "[solver]" {
        /// Method of the nonlinear iteration. With flowing water "auto" uses Newton's method also if the quasi-Newton
        /// method does not converge.
        nonlinear: Choice(Nonlinear), Default("\"auto\""), example(r#""newton""#);
        /// Tolerance of the relative energy residual.
        tolerance: Quantity(In::Number, FRACTION), Default("1e-8"), example("1e-8");
        /// Tolerance of the relative force residual. A step must meet both tolerances.
        force_tolerance: Quantity(In::Number, FRACTION), Default("1e-4"), example("1e-4");
        /// Largest number of iterations in one attempt to solve a step.
        max_iterations: Count(1, 100_000), Default("200"), example("200");
        /// Integration weights of the material points. Fitted weights are available in quasi-static analyses without
        /// cubic splines. Default: "fitted" if different materials meet at a C0 line and no water flows.
        quadrature: Choice(Quadrature), Optional, example(r#""fitted""#);
        /// Extended B-splines, which stabilise nearly empty cells at the surface of bodies. Default: "linear", but
        /// "off" in dynamic analyses and with cubic splines.
        extension: Choice(ExtendedSplines), Optional, example(r#""linear""#);
        /// Artificial elastic stiffness of all cells with material, as a fraction of the largest Young's modulus in
        /// the cell. Default: 1e-4 in quasi-static and 0 in dynamic analyses. Values above 1e-4 make ground under
        /// permanent loads too strong.
        background: Quantity(In::Number, UP_TO_1), Optional, example("1e-4");
        /// Linear solver. Without this key the program chooses by the number of unknowns. PETSc options after `--` on
        /// the command line take precedence, for instance `-- -ksp_type cg -pc_type hypre`.
        linear: Choice(LinearSolver), Optional, example(r#""direct""#);
        /// With true, repeated runs on the same number of ranks have bitwise identical results. PETSc's direct
        /// solvers then factorise the whole system on each rank.
        reproducible: Flag, Default("true");
    }
    retired {
        /// the artificial stiffness always resists strain
        background_kind: Kind::Choice(BACKGROUND_KIND);
        /// all occupied cells always have the artificial stiffness
        background_cells: Kind::Choice(BACKGROUND_CELLS);
    }
}

const FRACTION: Range = Range::of(Excluded(0.0), Excluded(1.0));
const UP_TO_1: Range = Range::of(Included(0.0), Included(1.0));
