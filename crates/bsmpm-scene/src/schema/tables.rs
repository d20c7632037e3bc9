//! Schema of the case file's main tables: analysis, grid, boundaries and solver.

use super::Kind::*;
use super::Presence::{Default, Optional, Required, Retired};
use super::{
    Dimension as In, Kind, Range, Table, body, element, flow, key, loads, material, one_of, one_of_or_preset, output,
    rigid, stage, water,
};
use crate::words::{
    Accuracy, AnalysisType, BACKGROUND_CELLS, BACKGROUND_KIND, C0Lines, Geometry, LinearSolver, Nonlinear, Order,
    Purpose, Word,
};
use bsmpm::dynamics::mass::MassMatrix;
use bsmpm::grid::extension::ExtendedSplines;
use bsmpm::model::WallVelocity;
use bsmpm::quadrature::Quadrature;
use bsmpm::stabilisation::Stabilisation;
use std::ops::Bound::{Excluded, Included};

/// The whole file.
pub static ROOT: Table = Table {
    header: "the file",
    doc: "One case: everything that a run needs.",
    keys: &[
        key("title", Text(200), Optional, "A short description of the case.")
            .example(r#""Slope with a phreatic line""#),
        key(
            "geometry",
            Choice(Geometry::WORDS),
            Required,
            "Geometry of the analysis.",
        )
        .example(r#""plane-strain""#),
        key(
            "accuracy",
            Choice(Accuracy::WORDS),
            Optional,
            "Chooses the cells, material points, steps and tolerances that the case does not give, by the [table of \
             presets](#presets-of-accuracy). Not available in 3-D.",
        )
        .example(r#""draft""#),
        key(
            "analysis",
            Kind::Table(&ANALYSIS),
            Required,
            "Type of the analysis and its duration.",
        )
        .example(r#"{ type = "dynamic", end = "5 s", dt = "5 ms" }"#),
        key("grid", Kind::Table(&GRID), Required, "The grid of B-splines.")
            .example(r#"{ lower = [0.0, 0.0], upper = [40.0, 12.0], cell = "0.5 m" }"#),
        key(
            "material",
            Named(&material::MATERIAL),
            Required,
            "Materials, each with a name.",
        )
        .example(r#"{ clay = { model = "tresca", young = "10 MPa", poisson = 0.49, cohesion = "30 kPa" } }"#),
        key(
            "body",
            Tables(&body::BODY),
            Required,
            "Bodies of soil, which are filled with material points.",
        )
        .example(r#"[{ material = "clay", box = { lower = [0.0, 0.0], upper = [20.0, 8.0] } }]"#),
        key(
            "gravity",
            Kind::Table(&GRAVITY),
            Optional,
            "Gravity. Without this table there is no gravity.",
        )
        .example(r#"{ acceleration = [0.0, -9.81] }"#),
        key(
            "water",
            Kind::Table(&water::WATER),
            Optional,
            "Water in the ground. Without this table there is no water.",
        )
        .example(r#"{ level = "4 m" }"#),
        key(
            "drain",
            Tables(&flow::DRAIN),
            Optional,
            "A surface through which water flows freely.",
        )
        .example(r#"[{ face = "bottom", head = "3 m" }]"#),
        key(
            "inflow",
            Tables(&flow::INFLOW),
            Optional,
            "A surface through which water enters the ground at a given rate.",
        )
        .example(r#"[{ from = [0.0, 8.0], to = [20.0, 8.0], rate = "10 mm/h", runoff = true }]"#),
        key(
            "shaking",
            Kind::Table(&loads::SHAKING),
            Optional,
            "Acceleration of the ground in an earthquake.",
        )
        .example(r#"{ acceleration = [[0.0, 0.0, 0.0], [0.5, "0.1 g", 0.0], [1.0, 0.0, 0.0]] }"#),
        key(
            "boundary",
            Kind::Table(&BOUNDARY),
            Default("{}"),
            "Supports at the faces of the grid.",
        )
        .example(r#"{ bottom = "fixed", left = "roller", right = "roller" }"#),
        key(
            "stabilisation",
            Kind::Table(&STABILISATION),
            Optional,
            "Method that prevents volumetric locking and oscillating stresses. Without this table no such method is \
             used.",
        )
        .example(r#"{ method = "consistent-f-bar" }"#),
        key(
            "solver",
            Kind::Table(&SOLVER),
            Default("{}"),
            "Nonlinear iteration and linear solver.",
        )
        .example(r#"{ nonlinear = "newton", linear = "direct" }"#),
        key(
            "output",
            Kind::Table(&output::OUTPUT),
            Optional,
            "Frames for ParaView. Without this table the run writes one frame at the start and one at the end.",
        )
        .example(r#"{ every = "0.5 s", fields = ["q", "yielding"] }"#),
        key(
            "history",
            Tables(&output::HISTORY),
            Optional,
            "A quantity that history.csv records at every step.",
        )
        .example(r#"[{ quantity = "runout", percentile = 99.0 }]"#),
        key(
            "check",
            Tables(&output::CHECK),
            Optional,
            "Bounds of a column of history.csv.",
        )
        .example(r#"[{ quantity = "max-displacement", max = "2 cm" }]"#),
        key(
            "footing",
            Kind::Table(&loads::FOOTING),
            Optional,
            "A rigid footing with a prescribed motion.",
        )
        .example(r#"{ from = [0.0, 8.0], to = [1.0, 8.0], displacement = [0.0, "-10 cm"] }"#),
        key(
            "prescribed",
            Tables(&loads::PRESCRIBED),
            Optional,
            "A prescribed motion of the soil at a face of the grid or at a segment.",
        )
        .example(r#"[{ face = "right", displacement = ["-5 cm", 0.0], components = "normal" }]"#),
        key(
            "rigid",
            Tables(&rigid::RIGID),
            Optional,
            "A rigid body in frictional contact with the soil.",
        )
        .example(r#"[{ name = "pipe", circle = { centre = [10.0, 6.0], radius = 0.3 }, displacement = [0.0, 0.2] }]"#),
        key(
            "traction",
            Tables(&loads::TRACTION),
            Optional,
            "A load per area on the surface of a body.",
        )
        .example(r#"[{ from = [0.0, 8.0], to = [5.0, 8.0], stress = [0.0, "-20 kPa"], ramp = "0.5 s" }]"#),
        key(
            "point_load",
            Tables(&loads::POINT_LOAD),
            Optional,
            "A force at a point of a body.",
        )
        .example(r#"[{ at = [5.0, 8.0], force = [0.0, "-10 kN/m"] }]"#),
        key(
            "strength_reduction",
            Kind::Table(&loads::REDUCTION),
            Optional,
            "Reduction of the strength of all materials.",
        )
        .example(r#"{ factor = 1.25 }"#),
        key(
            "initial",
            Kind::Table(&loads::INITIAL),
            Optional,
            "Initial stress. Without this table the bodies start without stress.",
        )
        .example(r#"{ k0 = 0.5 }"#),
        key(
            "element",
            Named(&element::ELEMENT),
            Optional,
            "Laboratory tests of one material point, which `bsmpm element` computes.",
        )
        .example(
            r#"{ test = { material = "clay", pressure = 1e5, stage = [{ test = "triaxial", compression = 0.1 }] } }"#,
        ),
        key(
            "stage",
            Tables(&stage::STAGE),
            Optional,
            "A change at a given time, for instance an excavation or a layer of fill.",
        )
        .example(r#"[{ name = "excavated", at = "0.5 s", remove = ["upper_layer"] }]"#),
        key(
            "profile",
            Tables(&output::PROFILE),
            Optional,
            "Values along a line, written to a file.",
        )
        .example(r#"[{ name = "wall", from = [2.0, 0.0], to = [2.0, 6.0], count = 25, quantities = ["stress"] }]"#),
    ],
    exclusive: &[],
};

static ANALYSIS: Table = Table {
    header: "[analysis]",
    doc: "Type and duration of the analysis. A dynamic analysis uses Newmark's method with beta = 1/4 and gamma = 1/2, \
          unless numerical damping is given. The time of a quasi-static analysis is a pseudo-time without unit.",
    keys: &[
        key(
            "type",
            Choice(AnalysisType::WORDS),
            Required,
            "Type of the analysis, which determines whether inertia acts and what the time means.",
        )
        .example(r#""dynamic""#),
        key(
            "end",
            Quantity(In::Time, Range::POSITIVE),
            Optional,
            "Time at which the run ends. Required, except in quasi-static analyses (default: 1.0).",
        )
        .example(r#""2 s""#),
        key(
            "dt",
            Quantity(In::Time, Range::POSITIVE),
            Optional,
            "Nominal time step. If neither `dt` nor `steps` is given, `accuracy` or `purpose` chooses the steps.",
        )
        .symbol("Δt")
        .example(r#""1 ms""#),
        key(
            "steps",
            Count(1, 1_000_000_000),
            Optional,
            "Alternative to `dt`: number of equal steps.",
        )
        .example("40"),
        key(
            "growth",
            Quantity(In::Number, GROWTH),
            Optional,
            "Ratio of the sizes of consecutive steps, in consolidation. The first step of the run and of every stage \
             has the size dt. Without this key the step size is constant.",
        )
        .example("1.2"),
        key(
            "dt_max",
            Quantity(In::Time, Range::POSITIVE),
            Optional,
            "Upper bound of the step size with `growth`. Without this key there is no bound.",
        )
        .example(r#""10 d""#),
        key(
            "spectral_radius",
            Quantity(In::Number, UP_TO_1),
            Optional,
            "Numerical damping, as the spectral radius of the time integration at infinite frequency (WBZ-alpha, \
             second-order accurate). Smaller values damp high frequencies more. Default: 1 (no damping).",
        )
        .symbol("ρ∞")
        .example("0.8"),
        key(
            "mass",
            Choice(MassMatrix::WORDS),
            Optional,
            "Mass matrix. Default: \"consistent\" with [shaking] or if all materials are elastic, unless something is \
             in contact; otherwise \"lumped\".",
        )
        .example(r#""consistent""#),
        key(
            "wall_velocity",
            Choice(WallVelocity::WORDS),
            Optional,
            "Velocity of the material points within a cell of a fixed face of the grid. Default: \"own\", or \
             \"relaxed\" for mu-i material with lumped mass.",
        )
        .example(r#""relaxed""#),
        key(
            "purpose",
            Choice(Purpose::WORDS),
            Optional,
            "Purpose of a quasi-static analysis under a prescribed displacement. \"limit-load\" chooses the material \
             points, degree, stabilisation, steps and tolerances that the case does not give. It also multiplies the \
             stiffness and divides the prescribed displacements by the same factor. The stresses stay the same, and \
             the geometry hardly changes.",
        )
        .example(r#""limit-load""#),
        key(
            "newmark_gamma",
            Quantity(In::Number, GAMMA),
            Optional,
            "Alternative to `spectral_radius`: Newmark's gamma. Values above 0.5 damp high frequencies and reduce the \
             accuracy to first order.",
        )
        .symbol("γ")
        .example("0.6")
        .renamed_from(&["gamma"]),
    ],
    exclusive: &[
        one_of_or_preset(&["dt", "steps"]),
        one_of(&["spectral_radius", "newmark_gamma"], false),
    ],
};

const GROWTH: Range = Range::of(Included(1.0), Included(10.0));
const GAMMA: Range = Range {
    lower: Included(0.5),
    upper: Included(1.0),
    why: "below 0.5 the time integration creates energy",
};

static GRID: Table = Table {
    header: "[grid]",
    doc: "The grid of B-splines. The knot vectors are open, and each cell is a knot span.",
    keys: &[
        key(
            "lower",
            Vector(In::Length, Range::ANY),
            Optional,
            "Corner with the smallest coordinates. Required without `knots`.",
        )
        .example("[0.0, 0.0]"),
        key(
            "upper",
            Vector(In::Length, Range::ANY),
            Optional,
            "Corner with the largest coordinates. Required without `knots`. If the length is not a whole number of \
             cells, the program enlarges the grid at a free face.",
        )
        .example("[40.0, 12.0]"),
        key(
            "cell",
            Either(In::Length, Range::POSITIVE),
            Optional,
            "Edge length of the cells: one value, or one along each axis. If neither `cell` nor `knots` is given, \
             `accuracy` chooses the cells.",
        )
        .symbol("h")
        .example(r#""0.5 m""#),
        key(
            "knots",
            Kind::Table(&KNOTS),
            Optional,
            "Alternative to `cell`: grid lines with any spacing.",
        )
        .example(r#"{ x = [0.0, 1.0, 2.0, 4.0], y = [0.0, 0.5, 1.0] }"#),
        key(
            "degree",
            Choice(Order::WORDS),
            Default("\"quadratic\""),
            "Degree of the B-splines.",
        )
        .symbol("q")
        .example(r#""quadratic""#)
        .renamed_from(&["order"]),
        key(
            "c0_lines",
            Choice(C0Lines::WORDS),
            Default("\"automatic\""),
            "Grid lines at which strains may jump. \"automatic\" chooses the lines where bodies with different \
             stiffness or density meet, at the ends of footings and loaded segments, and at corners of rigid bodies.",
        )
        .example(r#""automatic""#),
    ],
    exclusive: &[one_of_or_preset(&["cell", "knots"])],
};

static KNOTS: Table = Table {
    header: "[grid.knots]",
    doc: "Coordinates of the grid lines, in increasing order. A coordinate may be repeated. Where it is listed m \
          times, at most q, the B-splines of degree q have q - m continuous derivatives.",
    keys: &[
        key("x", List(In::Length, Range::ANY), Required, "Grid lines along x.").example("[0.0, 1.0, 2.0, 4.0]"),
        key("y", List(In::Length, Range::ANY), Required, "Grid lines along y.").example("[0.0, 0.5, 1.0]"),
        key(
            "z",
            List(In::Length, Range::ANY),
            Optional,
            "Grid lines along z, in 3-D.",
        )
        .example("[0.0, 0.5, 1.0]"),
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
            "Full acceleration of gravity. A dynamic analysis may incline it, for instance for a chute. In a \
             quasi-static analysis a horizontal component is a pseudo-static earthquake load: the seismic coefficient \
             times 9.81 m/s2. Pore pressures and the stress of [initial] follow from the vertical component only.",
        )
        .symbol("g")
        .example("[0.0, -9.81]"),
        key(
            "ramp",
            Quantity(In::Time, Range::NOT_NEGATIVE),
            Default("0.0"),
            "Time in which gravity grows from zero to its full value. With 0 full gravity acts at once. With [initial] \
             only the horizontal component grows; the vertical component acts from the start.",
        )
        .example("1.0"),
    ],
    exclusive: &[],
};

static BOUNDARY: Table = Table {
    header: "[boundary]",
    doc: "Supports at the faces of the grid.",
    keys: &[
        key(
            "left",
            loads::SUPPORT,
            Default("\"free\""),
            "Support at the face with the lowest x.",
        )
        .example(r#""roller""#),
        key(
            "right",
            loads::SUPPORT,
            Default("\"free\""),
            "Support at the face with the highest x.",
        )
        .example(r#""roller""#),
        key(
            "bottom",
            loads::SUPPORT,
            Default("\"free\""),
            "Support at the face with the lowest y (in 3-D: the lowest z).",
        )
        .example(r#""fixed""#),
        key(
            "top",
            loads::SUPPORT,
            Default("\"free\""),
            "Support at the face with the highest y (in 3-D: the highest z).",
        )
        .example(r#""free""#),
        key(
            "front",
            loads::SUPPORT,
            Optional,
            "Support at the face with the lowest y. Only in 3-D. Default: \"free\".",
        )
        .example(r#""roller""#),
        key(
            "back",
            loads::SUPPORT,
            Optional,
            "Support at the face with the highest y. Only in 3-D. Default: \"free\".",
        )
        .example(r#""roller""#),
    ],
    exclusive: &[],
};

static STABILISATION: Table = Table {
    header: "[stabilisation]",
    doc: "Method that prevents volumetric locking and oscillating stresses. The theory manual compares the methods.",
    keys: &[key(
        "method",
        Choice(Stabilisation::WORDS),
        Required,
        "Method. The F-bar methods average volume changes over the grid.",
    )
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
            "Method of the nonlinear iteration. With flowing water \"auto\" uses Newton's method also if the \
             quasi-Newton method does not converge.",
        )
        .example(r#""newton""#),
        key(
            "tolerance",
            Quantity(In::Number, FRACTION),
            Default("1e-8"),
            "Tolerance of the relative energy residual.",
        )
        .example("1e-8"),
        key(
            "force_tolerance",
            Quantity(In::Number, FRACTION),
            Default("1e-4"),
            "Tolerance of the relative force residual. A step must meet both tolerances.",
        )
        .example("1e-4"),
        key(
            "max_iterations",
            Count(1, 100_000),
            Default("200"),
            "Largest number of iterations in one attempt to solve a step.",
        )
        .example("200"),
        key(
            "quadrature",
            Choice(Quadrature::WORDS),
            Optional,
            "Integration weights of the material points. Fitted weights are available in quasi-static analyses without \
             cubic splines. Default: \"fitted\" if different materials meet at a C0 line and no water flows.",
        )
        .example(r#""fitted""#),
        key(
            "extension",
            Choice(ExtendedSplines::WORDS),
            Optional,
            "Extended B-splines, which stabilise nearly empty cells at the surface of bodies. Default: \"linear\", but \
             \"off\" in dynamic analyses and with cubic splines.",
        )
        .example(r#""linear""#),
        key(
            "background",
            Quantity(In::Number, UP_TO_1),
            Optional,
            "Artificial elastic stiffness of all cells with material, as a fraction of the largest Young's modulus in \
             the cell. Default: 1e-4 in quasi-static and 0 in dynamic analyses. Values above 1e-4 make ground under \
             permanent loads too strong.",
        )
        .example("1e-4"),
        key(
            "background_kind",
            Choice(BACKGROUND_KIND),
            Retired,
            "the artificial stiffness always resists strain",
        ),
        key(
            "background_cells",
            Choice(BACKGROUND_CELLS),
            Retired,
            "all occupied cells always have the artificial stiffness",
        ),
        key(
            "linear",
            Choice(LinearSolver::WORDS),
            Optional,
            "Linear solver. Without this key the program chooses by the number of unknowns. PETSc options after `--` on \
             the command line take precedence, for instance `-- -ksp_type cg -pc_type hypre`.",
        )
        .example(r#""direct""#),
        key(
            "reproducible",
            Flag,
            Default("true"),
            "With true, repeated runs on the same number of ranks have bitwise identical results. PETSc's direct \
             solvers then factorise the whole system on each rank.",
        ),
    ],
    exclusive: &[],
};

const FRACTION: Range = Range::of(Excluded(0.0), Excluded(1.0));
const UP_TO_1: Range = Range::of(Included(0.0), Included(1.0));
