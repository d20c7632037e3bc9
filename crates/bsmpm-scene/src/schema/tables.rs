//! The tables and keys of the language.

use super::Kind::*;
use super::Presence::{Default, Optional, Required, Retired};
use super::{
    Dimension as In, Kind, Range, Table, body, element, flow, key, laws, loads, one_of, output, rigid, stage, water,
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
    doc: "One case: everything that a run needs",
    keys: &[
        key("title", Text(200), Optional, "what the case is, in a line"),
        key("geometry", Choice(Geometry::WORDS), Required, "kind of the geometry"),
        key(
            "accuracy",
            Choice(Accuracy::WORDS),
            Optional,
            "cells, points, steps, tolerances that are not given; not in 3-D, which gives them",
        ),
        key("analysis", Kind::Table(&ANALYSIS), Required, "kind of the analysis and its time"),
        key("grid", Kind::Table(&GRID), Required, "the parametric grid"),
        key("material", Named(&laws::MATERIAL), Required, "materials by name"),
        key("body", Tables(&body::BODY), Required, "bodies made of material points"),
        key("gravity", Kind::Table(&GRAVITY), Optional, "body force; absent: none"),
        key("water", Kind::Table(&water::WATER), Optional, "water in the ground; absent: none"),
        key("drain", Tables(&flow::DRAIN), Optional, "a surface that lets water through"),
        key("inflow", Tables(&flow::INFLOW), Optional, "a surface through which water is put in"),
        key("shaking", Kind::Table(&loads::SHAKING), Optional, "motion of the ground; absent: none"),
        key("boundary", Kind::Table(&BOUNDARY), Default("{}"), "supports at the faces of the grid"),
        key("stabilisation", Kind::Table(&STABILISATION), Optional, "against locking and oscillation; absent: none"),
        key("solver", Kind::Table(&SOLVER), Default("{}"), "the non-linear iteration and the linear solver"),
        key("output", Kind::Table(&output::OUTPUT), Optional, "frames for ParaView; absent: none"),
        key("history", Tables(&output::HISTORY), Optional, "columns of history.csv"),
        key("check", Tables(&output::CHECK), Optional, "bounds that are verified at the end"),
        key("footing", Kind::Table(&loads::FOOTING), Optional, "a rigid strip that moves"),
        key("prescribed", Tables(&loads::PRESCRIBED), Optional, "motion of a face or segment"),
        key("rigid", Tables(&rigid::RIGID), Optional, "a rigid body in frictional contact with the soil"),
        key("traction", Tables(&loads::TRACTION), Optional, "stress on the body's surface"),
        key("point_load", Tables(&loads::POINT_LOAD), Optional, "a force at a point"),
        key("strength_reduction", Kind::Table(&loads::REDUCTION), Optional, "strength divided by a factor"),
        key("initial", Kind::Table(&loads::INITIAL), Optional, "stress at the start; absent: none"),
        key("element", Named(&element::ELEMENT), Optional, "tests of one point, for `bsmpm element`"),
        key("stage", Tables(&stage::STAGE), Optional, "what is removed, placed or exchanged at a time"),
        key("profile", Tables(&output::PROFILE), Optional, "fields along a line"),
    ],
    exclusive: &[],
};

static ANALYSIS: Table = Table {
    header: "[analysis]",
    doc: "Dynamic (Newmark 1/4, 1/2 unless damped), quasi-static (no inertia; time is a pseudo-time without unit), \
          quasi-static-rate (no inertia; in s, for strengths by the rate), or consolidation (no inertia; water flows in \
          real time)",
    keys: &[
        key("type", Choice(AnalysisType::WORDS), Required, "whether inertia acts, and what time is"),
        key("end", Quantity(In::Time, Range::POSITIVE), Optional, "end of the run; quasi-static: 1.0 unless given"),
        key("dt", Quantity(In::Time, Range::POSITIVE), Optional, "nominal step"),
        key("steps", Count(1, 1_000_000_000), Optional, "number of equal steps, instead of dt"),
        key(
            "growth",
            Quantity(In::Number, GROWTH),
            Optional,
            "a step over the one before it (consolidation), from dt on at the start and after every stage; 1 unless given",
        ),
        key(
            "dt_max",
            Quantity(In::Time, Range::POSITIVE),
            Optional,
            "the longest step to which they grow; no bound unless given",
        ),
        key(
            "spectral_radius",
            Quantity(In::Number, UP_TO_1),
            Optional,
            "numerical damping of second order (WBZ-alpha): what is left at infinite frequency; 1 unless given: none",
        ),
        key(
            "mass",
            Choice(MassMatrix::WORDS),
            Optional,
            "mass matrix of the nodes; consistent unless given, where nothing is in contact and either the ground shakes or all \
             materials are elastic; otherwise lumped",
        ),
        key(
            "wall_velocity",
            Choice(WallVelocity::WORDS),
            Optional,
            "velocity that material points within a cell of a fixed face keep; own unless given, but relaxed for mu-i \
             material with lumped mass",
        ),
        key(
            "purpose",
            Choice(Purpose::WORDS),
            Optional,
            "\"limit-load\" (quasi-static, under prescribed motion): chooses points, order, method, steps and tolerances that are \
             not given, and a raised stiffness, so that the geometry stays as drawn",
        ),
        key("newmark_gamma", Quantity(In::Number, GAMMA), Optional, "Newmark's gamma instead: damping of first order")
            .renamed_from(&["gamma"]),
    ],
    exclusive: &[one_of(&["dt", "steps"], true), one_of(&["spectral_radius", "newmark_gamma"], false)],
};

const GROWTH: Range = Range::of(Included(1.0), Included(10.0));
const GAMMA: Range =
    Range { lower: Included(0.5), upper: Included(1.0), why: "below 0.5 the time integration creates energy" };

static GRID: Table = Table {
    header: "[grid]",
    doc: "The background grid: open knot vectors, one patch per cell",
    keys: &[
        key("lower", Vector(In::Length, Range::ANY), Optional, "lower corner; cells start here"),
        key("upper", Vector(In::Length, Range::ANY), Optional, "upper corner; a free face moves out to a whole cell"),
        key("cell", Either(In::Length, Range::POSITIVE), Optional, "edge of the cells, or one along each axis"),
        key("knots", Kind::Table(&KNOTS), Optional, "explicit breakpoints instead of cell"),
        key("degree", Choice(Order::WORDS), Default("\"quadratic\""), "order of the B-splines")
            .renamed_from(&["order"]),
        key(
            "c0_lines",
            Choice(C0Lines::WORDS),
            Default("\"automatic\""),
            "grid lines across which strains may jump: where bodies of unlike stiffness or density meet, and at the ends of \
             strips and loaded segments; none: only breakpoints that knots repeats",
        ),
    ],
    exclusive: &[one_of(&["cell", "knots"], true)],
};

static KNOTS: Table = Table {
    header: "[grid.knots]",
    doc: "Breakpoints between the cells, increasing; one that stands m times has order - m continuous derivatives",
    keys: &[
        key("x", List(In::Length, Range::ANY), Required, "breakpoints along x"),
        key("y", List(In::Length, Range::ANY), Required, "breakpoints along y"),
        key("z", List(In::Length, Range::ANY), Optional, "in 3-D: breakpoints along z"),
    ],
    exclusive: &[],
};

static GRAVITY: Table = Table {
    header: "[gravity]",
    doc: "Body force per mass",
    keys: &[
        key(
            "acceleration",
            Vector(In::Acceleration, Range::ANY),
            Required,
            "when fully applied. A horizontal part in a quasi-static analysis is the inertia of a pseudo-static one: the \
             seismic coefficient times 9.81. Pore pressures and the stress of [initial] are those of the vertical part",
        ),
        key(
            "ramp",
            Quantity(In::Time, Range::NOT_NEGATIVE),
            Default("0.0"),
            "time over which it grows; 0: at once. With [initial] the horizontal part alone grows, as the vertical part \
             acts from the start",
        ),
    ],
    exclusive: &[],
};

static BOUNDARY: Table = Table {
    header: "[boundary]",
    doc: "Supports at the faces of the grid: fixed, roller, contact, absorbing, free field, outflow, or free",
    keys: &[
        key("left", loads::SUPPORT, Default("\"free\""), "face at the lowest x"),
        key("right", loads::SUPPORT, Default("\"free\""), "face at the highest x"),
        key("bottom", loads::SUPPORT, Default("\"free\""), "face at the lowest y, in 3-D z"),
        key("top", loads::SUPPORT, Default("\"free\""), "face at the highest y, in 3-D z"),
        key("front", loads::SUPPORT, Optional, "in 3-D: face at the lowest y; free unless given"),
        key("back", loads::SUPPORT, Optional, "in 3-D: face at the highest y; free unless given"),
    ],
    exclusive: &[],
};

static STABILISATION: Table = Table {
    header: "[stabilisation]",
    doc: "Section 2.3 of the paper",
    keys: &[key("method", Choice(Stabilisation::WORDS), Required, "what is averaged over the grid")],
    exclusive: &[],
};

static SOLVER: Table = Table {
    header: "[solver]",
    doc: "The non-linear iteration",
    keys: &[
        key(
            "nonlinear",
            Choice(Nonlinear::WORDS),
            Default("\"auto\""),
            "auto: all recent secants, newton where they stall (with water that flows: do not converge); broyden: the \
             paper's update; newton: the complete tangent",
        ),
        key("tolerance", Quantity(In::Number, FRACTION), Default("1e-8"), "energy measure"),
        key("force_tolerance", Quantity(In::Number, FRACTION), Default("1e-4"), "force measure; both must hold"),
        key("max_iterations", Count(1, 100_000), Default("200"), "iterations of one attempt"),
        key(
            "quadrature",
            Choice(Quadrature::WORDS),
            Optional,
            "what points weigh in integrals of the stress: their volumes, or (quasi-static, not cubic) volumes with which \
             splines inside bodies are integrated exactly; fitted where unlike materials meet on a C0 line and no water flows, \
             else points",
        ),
        key(
            "extension",
            Choice(ExtendedSplines::WORDS),
            Optional,
            "extended B-splines at the edge of bodies; linear unless dynamic or cubic, which are off",
        ),
        key(
            "background",
            Quantity(In::Number, UP_TO_1),
            Optional,
            "soft elastic background in occupied cells, part of the largest young in a cell; quasi-static 1e-4, dynamic 0; \
             above 1e-4 ground under dead load is too strong",
        ),
        key("background_kind", Choice(BACKGROUND_KIND), Retired, "the background always resists strain"),
        key("background_cells", Choice(BACKGROUND_CELLS), Retired, "all occupied cells always have the background"),
        key(
            "linear",
            ChoiceOr(LinearSolver::WORDS, &LINEAR),
            Default("{}"),
            "the linear solver, in a word or by PETSc's names; by size unless given; options after -- go before it",
        ),
        key(
            "reproducible",
            Flag,
            Default("true"),
            "the same bits in every run on as many ranks; PETSc's direct solvers then factorise the whole system on each",
        ),
    ],
    exclusive: &[],
};

const FRACTION: Range = Range::of(Excluded(0.0), Excluded(1.0));
const UP_TO_1: Range = Range::of(Included(0.0), Included(1.0));

static LINEAR: Table = Table {
    header: "linear = { ksp, pc, factor }",
    doc: "The linear solver, by PETSc's own names",
    keys: &[
        key("ksp", Choice(Option::<Ksp>::WORDS), Optional, "method; auto, unless given: what the preconditioner needs"),
        key(
            "pc",
            Choice(Option::<Pc>::WORDS),
            Optional,
            "preconditioner or direct solver; auto, unless given: cholesky, or gamg of very many unknowns",
        ),
        key(
            "factor",
            Choice(Factor::WORDS),
            Optional,
            "package of a direct solver; dissection (cholesky) or mumps unless given",
        ),
    ],
    exclusive: &[],
};
