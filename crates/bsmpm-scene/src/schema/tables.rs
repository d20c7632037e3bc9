//! Schema of the case file's main tables: analysis, grid, boundaries and solver.

use super::Kind::*;
use super::Presence::{Default, Optional, Required, Retired};
use super::{
    Dimension as In, Kind, Range, Table, body, element, flow, key, loads, material, one_of, one_of_or_preset, output,
    rigid, stage, water,
};
use crate::words::{
    Accuracy, AnalysisType, BACKGROUND_CELLS, BACKGROUND_KIND, C0Lines, Factor, Geometry, Ksp, LinearSolver, Nonlinear,
    Order, Pc, Purpose, Word,
};
use bsmpm::grid::extension::ExtendedSplines;
use bsmpm::model::WallVelocity;
use bsmpm::quadrature::Quadrature;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::step::mass::MassMatrix;
use std::ops::Bound::{Excluded, Included};

/// The whole file.
pub static ROOT: Table = Table {
    header: "the file",
    doc: "One case: everything that a run needs.",
    keys: &[
        key("title", Text(200), Optional, "A short description of the case.")
            .example(r#""Slope with a phreatic line""#),
        key("geometry", Choice(Geometry::WORDS), Required, "Geometry of the analysis.").example(r#""plane-strain""#),
        key(
            "accuracy",
            Choice(Accuracy::WORDS),
            Optional,
            "Chooses the cells, material points, steps and tolerances that the case does not give. It is not \
             available in 3-D.",
        )
        .example(r#""draft""#),
        key("analysis", Kind::Table(&ANALYSIS), Required, "Type of the analysis and its duration."),
        key("grid", Kind::Table(&GRID), Required, "The background grid."),
        key("material", Named(&material::MATERIAL), Required, "Materials, each with a name."),
        key("body", Tables(&body::BODY), Required, "Bodies of soil, which are filled with material points."),
        key("gravity", Kind::Table(&GRAVITY), Optional, "Body force. Without this table there is none."),
        key("water", Kind::Table(&water::WATER), Optional, "Water in the ground. Without this table there is none."),
        key("drain", Tables(&flow::DRAIN), Optional, "A surface through which water flows freely."),
        key("inflow", Tables(&flow::INFLOW), Optional, "A surface through which water is put into the ground."),
        key(
            "shaking",
            Kind::Table(&loads::SHAKING),
            Optional,
            "Acceleration of the ground. Without this table the ground does not shake.",
        ),
        key("boundary", Kind::Table(&BOUNDARY), Default("{}"), "Supports at the faces of the grid."),
        key(
            "stabilisation",
            Kind::Table(&STABILISATION),
            Optional,
            "Method against volumetric locking and oscillating stresses. Without this table there is none.",
        ),
        key("solver", Kind::Table(&SOLVER), Default("{}"), "Nonlinear iteration and linear solver."),
        key(
            "output",
            Kind::Table(&output::OUTPUT),
            Optional,
            "Frames for ParaView. Without this table there is one at the start and one at the end of the run.",
        ),
        key("history", Tables(&output::HISTORY), Optional, "A column, or several, of history.csv."),
        key("check", Tables(&output::CHECK), Optional, "A bound of a history column."),
        key("footing", Kind::Table(&loads::FOOTING), Optional, "A rigid footing with a prescribed displacement."),
        key(
            "prescribed",
            Tables(&loads::PRESCRIBED),
            Optional,
            "A prescribed displacement of a face of the grid or of a segment.",
        ),
        key("rigid", Tables(&rigid::RIGID), Optional, "A rigid body in frictional contact with the soil."),
        key("traction", Tables(&loads::TRACTION), Optional, "A stress on the surface of a body."),
        key("point_load", Tables(&loads::POINT_LOAD), Optional, "A force at a point."),
        key(
            "strength_reduction",
            Kind::Table(&loads::REDUCTION),
            Optional,
            "Reduction of the strength of all materials.",
        ),
        key(
            "initial",
            Kind::Table(&loads::INITIAL),
            Optional,
            "Stress at the start. Without this table the bodies start without stress.",
        ),
        key(
            "element",
            Named(&element::ELEMENT),
            Optional,
            "Laboratory tests of one material point, which `bsmpm element` computes.",
        ),
        key(
            "stage",
            Tables(&stage::STAGE),
            Optional,
            "A change at a given time, for instance an excavation or a lift of fill.",
        ),
        key("profile", Tables(&output::PROFILE), Optional, "Fields along a line, written to a file."),
    ],
    exclusive: &[],
};

static ANALYSIS: Table = Table {
    header: "[analysis]",
    doc: "Type of the analysis. A dynamic analysis has inertia (Newmark's method with beta = 1/4 and gamma = 1/2, \
          unless it is damped). A quasi-static analysis has none, and its time is a pseudo-time without unit. A \
          quasi-static-rate analysis has no inertia either, but its time is real, for strengths that depend on the \
          strain rate. A consolidation analysis has no inertia, and water flows in real time.",
    keys: &[
        key("type", Choice(AnalysisType::WORDS), Required, "Whether inertia acts, and what the time means.")
            .example(r#""dynamic""#),
        key(
            "end",
            Quantity(In::Time, Range::POSITIVE),
            Optional,
            "End of the run. It is required, except in quasi-static analyses, which end at 1.0 without it.",
        )
        .example(r#""2 s""#),
        key(
            "dt",
            Quantity(In::Time, Range::POSITIVE),
            Optional,
            "Nominal time step. Without `dt` and `steps`, `accuracy` or `purpose` chooses the steps.",
        )
        .symbol("Δt")
        .example(r#""1 ms""#),
        key("steps", Count(1, 1_000_000_000), Optional, "Number of equal steps, instead of dt.").example("40"),
        key(
            "growth",
            Quantity(In::Number, GROWTH),
            Optional,
            "Ratio of a step to the one before it, in consolidation. The steps grow from dt at the start and after \
             every stage. Without this key they do not grow.",
        )
        .example("1.2"),
        key(
            "dt_max",
            Quantity(In::Time, Range::POSITIVE),
            Optional,
            "Largest step that growth may reach. Without this key there is no bound, and without `growth` it has no \
             effect.",
        )
        .example(r#""10 d""#),
        key(
            "spectral_radius",
            Quantity(In::Number, UP_TO_1),
            Optional,
            "Spectral radius at infinite frequency of the time integration (WBZ-alpha, second-order accurate). \
             Smaller values damp high frequencies more. Without this key it is 1, which is no damping.",
        )
        .symbol("ρ∞")
        .example("0.8"),
        key(
            "mass",
            Choice(MassMatrix::WORDS),
            Optional,
            "Mass matrix of the nodes. Without this key it is consistent in an earthquake, and if all materials are \
             elastic, as long as nothing is in contact. In all other cases it is lumped.",
        )
        .example(r#""consistent""#),
        key(
            "wall_velocity",
            Choice(WallVelocity::WORDS),
            Optional,
            "Velocity of the material points within a cell of a fixed face. Without this key it is \"own\", or \
             \"relaxed\" for mu-i material with lumped mass.",
        )
        .example(r#""relaxed""#),
        key(
            "purpose",
            Choice(Purpose::WORDS),
            Optional,
            "Purpose of the analysis. \"limit-load\" is for a quasi-static analysis under a prescribed displacement. \
             It chooses the material points, degree, method, steps and tolerances that the case does not give. It \
             multiplies the stiffness and divides the prescribed displacements by one factor, so that the geometry \
             stays as drawn.",
        )
        .example(r#""limit-load""#),
        key(
            "newmark_gamma",
            Quantity(In::Number, GAMMA),
            Optional,
            "Newmark's gamma, instead of spectral_radius. Values above 0.5 damp high frequencies and reduce the \
             accuracy to first order.",
        )
        .symbol("γ")
        .example("0.6")
        .renamed_from(&["gamma"]),
    ],
    exclusive: &[one_of_or_preset(&["dt", "steps"]), one_of(&["spectral_radius", "newmark_gamma"], false)],
};

const GROWTH: Range = Range::of(Included(1.0), Included(10.0));
const GAMMA: Range =
    Range { lower: Included(0.5), upper: Included(1.0), why: "below 0.5 the time integration creates energy" };

static GRID: Table = Table {
    header: "[grid]",
    doc: "The background grid. It has open knot vectors and one knot span per cell.",
    keys: &[
        key(
            "lower",
            Vector(In::Length, Range::ANY),
            Optional,
            "Lower corner, where the first cell begins. Required without `knots`.",
        )
        .example("[0.0, 0.0]"),
        key(
            "upper",
            Vector(In::Length, Range::ANY),
            Optional,
            "Upper corner. Required without `knots`. If the length is not a whole number of cells, a free face is \
             moved outwards.",
        )
        .example("[40.0, 12.0]"),
        key(
            "cell",
            Either(In::Length, Range::POSITIVE),
            Optional,
            "Edge length of the cells, or one length along each axis. Without `cell` and `knots`, `accuracy` chooses \
             the cells.",
        )
        .symbol("h")
        .example(r#""0.5 m""#),
        key("knots", Kind::Table(&KNOTS), Optional, "Grid lines, instead of cells of one size."),
        key("degree", Choice(Order::WORDS), Default("\"quadratic\""), "Degree of the B-splines.")
            .symbol("q")
            .example(r#""quadratic""#)
            .renamed_from(&["order"]),
        key(
            "c0_lines",
            Choice(C0Lines::WORDS),
            Default("\"automatic\""),
            "Grid lines at which strains may jump. \"automatic\" puts them where bodies with different stiffness or \
             density meet, at the ends of footings and loaded segments, and at corners of rigid bodies. \"none\" \
             leaves only the lines that knots repeats.",
        )
        .example(r#""automatic""#),
    ],
    exclusive: &[one_of_or_preset(&["cell", "knots"])],
};

static KNOTS: Table = Table {
    header: "[grid.knots]",
    doc: "Coordinates of the grid lines, in increasing order. At a line that is listed m times, at most q, the \
          B-splines of degree q have q - m continuous derivatives.",
    keys: &[
        key("x", List(In::Length, Range::ANY), Required, "Grid lines along x.").example("[0.0, 1.0, 2.0, 4.0]"),
        key("y", List(In::Length, Range::ANY), Required, "Grid lines along y.").example("[0.0, 0.5, 1.0]"),
        key("z", List(In::Length, Range::ANY), Optional, "Grid lines along z, in 3-D.").example("[0.0, 0.5, 1.0]"),
    ],
    exclusive: &[],
};

static GRAVITY: Table = Table {
    header: "[gravity]",
    doc: "Gravity, a force per mass.",
    keys: &[
        key(
            "acceleration",
            Vector(In::Acceleration, Range::ANY),
            Required,
            "Acceleration of gravity at its full value. A dynamic analysis may incline it, for instance for a chute. \
             In a quasi-static analysis a horizontal component is a pseudo-static earthquake load: the seismic \
             coefficient times 9.81 m/s2. Pore pressures and the stress of [initial] follow from the vertical \
             component alone.",
        )
        .symbol("g")
        .example("[0.0, -9.81]"),
        key(
            "ramp",
            Quantity(In::Time, Range::NOT_NEGATIVE),
            Default("0.0"),
            "Time over which gravity grows to its full value. With 0 it acts at once. With [initial] only the \
             horizontal component grows, as the vertical one acts from the start.",
        )
        .example("1.0"),
    ],
    exclusive: &[],
};

static BOUNDARY: Table = Table {
    header: "[boundary]",
    doc: "Supports at the faces of the grid.",
    keys: &[
        key("left", loads::SUPPORT, Default("\"free\""), "Support at the face with the lowest x.")
            .example(r#""roller""#),
        key("right", loads::SUPPORT, Default("\"free\""), "Support at the face with the highest x.")
            .example(r#""roller""#),
        key("bottom", loads::SUPPORT, Default("\"free\""), "Support at the face with the lowest y, in 3-D z.")
            .example(r#""fixed""#),
        key("top", loads::SUPPORT, Default("\"free\""), "Support at the face with the highest y, in 3-D z.")
            .example(r#""free""#),
        key(
            "front",
            loads::SUPPORT,
            Optional,
            "Support at the face with the lowest y, in 3-D. Without this key it is free.",
        )
        .example(r#""roller""#),
        key(
            "back",
            loads::SUPPORT,
            Optional,
            "Support at the face with the highest y, in 3-D. Without this key it is free.",
        )
        .example(r#""roller""#),
    ],
    exclusive: &[],
};

static STABILISATION: Table = Table {
    header: "[stabilisation]",
    doc: "Method against volumetric locking and oscillating stresses. The theory manual compares the methods.",
    keys: &[key("method", Choice(Stabilisation::WORDS), Required, "Which volume changes are averaged over the grid.")
        .example(r#""consistent-f-bar""#)
        .or_preset()],
    exclusive: &[],
};

static SOLVER: Table = Table {
    header: "[solver]",
    doc: "Nonlinear iteration and linear solver.",
    keys: &[
        key(
            "nonlinear",
            Choice(Nonlinear::WORDS),
            Default("\"auto\""),
            "Method of the nonlinear iteration. \"auto\" is a quasi-Newton method with multiple secants, and \
             Newton's method if that stalls or, with flowing water, does not converge. \"broyden\" is the paper's \
             rank-one update. \"newton\" uses the consistent tangent.",
        )
        .example(r#""newton""#),
        key(
            "tolerance",
            Quantity(In::Number, FRACTION),
            Default("1e-8"),
            "Tolerance of the energy measure of convergence.",
        )
        .example("1e-8"),
        key(
            "force_tolerance",
            Quantity(In::Number, FRACTION),
            Default("1e-4"),
            "Tolerance of the force measure of convergence. A step must meet both.",
        )
        .example("1e-4"),
        key(
            "max_iterations",
            Count(1, 100_000),
            Default("200"),
            "Largest number of iterations in one attempt of a step.",
        )
        .example("200"),
        key(
            "quadrature",
            Choice(Quadrature::WORDS),
            Optional,
            "Integration weights of the material points: their volumes, or volumes that integrate the splines inside \
             bodies exactly (quasi-static, not with cubic splines). Without this key they are fitted if different \
             materials meet at a C0 line and no water flows.",
        )
        .example(r#""fitted""#),
        key(
            "extension",
            Choice(ExtendedSplines::WORDS),
            Optional,
            "Extended B-splines in nearly empty cells at the surface of bodies. Without this key it is \"linear\", \
             but \"off\" in dynamic analyses and with cubic splines.",
        )
        .example(r#""linear""#),
        key(
            "background",
            Quantity(In::Number, UP_TO_1),
            Optional,
            "Artificial elastic stiffness of occupied cells, as a part of the largest Young's modulus in the cell. \
             Without this key it is 1e-4 in quasi-static and 0 in dynamic analyses. Values above 1e-4 make ground \
             under permanent loads too strong.",
        )
        .example("1e-4"),
        key("background_kind", Choice(BACKGROUND_KIND), Retired, "the background always resists strain"),
        key("background_cells", Choice(BACKGROUND_CELLS), Retired, "all occupied cells always have the background"),
        key(
            "linear",
            ChoiceOr(LinearSolver::WORDS, &LINEAR),
            Default("{}"),
            "The linear solver, by a word or by PETSc's names. Without this key the number of unknowns decides. \
             PETSc options after `--` on the command line take precedence.",
        )
        .example(r#""direct""#),
        key(
            "reproducible",
            Flag,
            Default("true"),
            "Whether every run on the same number of ranks gives the same result to the last bit. PETSc's direct \
             solvers then factorise the whole system on each rank.",
        ),
    ],
    exclusive: &[],
};

const FRACTION: Range = Range::of(Excluded(0.0), Excluded(1.0));
const UP_TO_1: Range = Range::of(Included(0.0), Included(1.0));

static LINEAR: Table = Table {
    header: "linear = { ksp, pc, factor }",
    doc: "The linear solver by PETSc's names.",
    keys: &[
        key(
            "ksp",
            Choice(Option::<Ksp>::WORDS),
            Optional,
            "Iterative method. Without this key, or with \"auto\", it is the one that the preconditioner needs.",
        )
        .example(r#""cg""#),
        key(
            "pc",
            Choice(Option::<Pc>::WORDS),
            Optional,
            "Preconditioner or direct solver. Without this key, or with \"auto\", it is \"cholesky\", or \"gamg\" \
             for very many unknowns.",
        )
        .example(r#""gamg""#),
        key(
            "factor",
            Choice(Factor::WORDS),
            Optional,
            "Package of a direct solver. Without this key it is \"dissection\" for \"cholesky\" and \"mumps\" for \
             other solvers.",
        )
        .example(r#""mumps""#),
    ],
    exclusive: &[],
};
