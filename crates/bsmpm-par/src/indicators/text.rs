//! Texts of indicators outside their usual range.

use bsmpm::dynamics::mass::MassMatrix;
use bsmpm::grid::extension::ExtendedSplines;
use bsmpm::model::Regime;
use bsmpm::model::WallVelocity;
use bsmpm::quadrature::Quadrature;
use bsmpm::stabilisation::Stabilisation;
use bsmpm_scene::{Case, Geometry};

/// Poisson's ratio from which on material is nearly incompressible: the lid-driven square and the strip
/// footing of the paper, for which remedies were measured, have 0.499 and more.
const NEARLY_INCOMPRESSIBLE: f64 = 0.49;

/// The text of an indicator of a case by its name, with places for the value, its range and the one that is meant;
/// empty for a name that is none.
pub(super) fn of(name: &str, case: &Case, value: f64) -> String {
    match name {
        "pressure-noise-average" => NOISE_ABOUT_AVERAGE.replace("{remedy}", against_noise(case)),
        "pressure-noise-plane" => NOISE_ABOUT_PLANE.replace("{remedy}", against_noise(case)),
        "energy-growth" => GROWTH.replace("{remedy}", against_growth(case.stabilisation)),
        "wall-velocity" => WALL.replace("{remedy}", against_sliding(case)),
        "interface-shift" => INTERFACE.replace("{remedy}", against_shift(case, value)),
        "energy-loss" if value < 0.0 && case.analysis.regime == Regime::Dynamic => ENERGY_MADE.to_owned(),
        _ => constant(name, case).to_owned(),
    }
}

const NOISE_ABOUT_AVERAGE: &str = "I0001: the mean stresses of neighbouring material points scatter by {value} of \
    their average ({range}). Do not use stresses of single points. {remedy}";
const NOISE_ABOUT_PLANE: &str = "I0002: the mean stresses of neighbouring material points differ from a linear trend \
    by {value} of their average ({range}). Do not use stresses of single points. {remedy}";
const ENERGY_MADE: &str = "I0012: numerical dissipation is {value} of the peak energy ({range}). The algorithm adds \
    energy to the motion. Reduce `analysis.dt`.";
const GROWTH: &str = "I0013: the algorithm has created {value} of the peak energy ({range}). The computed motion is \
    too fast. {remedy}";
const WALL: &str = "I0019: soil next to fixed boundaries has too much kinetic energy, by {value} of the total \
    ({range}). This soil slides too far. {remedy}";
const INTERFACE: &str = "I0021: an interface of two materials has moved {value} from the grid line where it was at \
    the start ({range}). Stresses within three cells of the interface are wrong. {remedy}";

/// Cells  Distance of an interface from its grid line from which on no reasonable cell is large enough.
const FAR: f64 = 1.0;

/// What keeps an interface in its cell.
fn against_shift(case: &Case, value: f64) -> &'static str {
    match (may_fit(case), value < FAR) {
        (true, true) => {
            "Set `solver.quadrature = \"fitted\"`, or use larger cells: it then moves by a smaller part of a cell."
        }
        (true, false) => "Set `solver.quadrature = \"fitted\"`, or do not use these stresses.",
        (false, true) => "Use larger cells: it then moves by a smaller part of a cell.",
        (false, false) => "Do not use these stresses. Smaller cells do not help.",
    }
}

/// What makes material next to a fixed boundary stick to it.
fn against_sliding(case: &Case) -> &'static str {
    match case.analysis.wall_velocity {
        WallVelocity::Relaxed => "Use smaller cells, or a boundary with `friction_coefficient`.",
        WallVelocity::Own => "Set `analysis.wall_velocity = \"relaxed\"`, or use smaller cells.",
    }
}

/// What reduces the noise of the pressure under the method in use, as
/// measured with the strip footing and the column collapse of the paper.
fn against_noise(case: &Case) -> &'static str {
    let is_nearly_incompressible = case.bodies.iter().any(|body| {
        let named = &case.materials[body.material];
        named.material.elastic().poisson >= NEARLY_INCOMPRESSIBLE
    });
    let is_rubbery = is_nearly_incompressible && case.flow.is_none();
    let is_static = case.analysis.regime == Regime::QuasiStatic;
    match case.stabilisation {
        Stabilisation::None | Stabilisation::FBar => "Set `stabilisation.method = \"consistent-f-bar\"`.",
        Stabilisation::ConsistentFBar if is_rubbery && is_static && case.geometry != Geometry::Solid => {
            "If the soil is undrained, set `drainage = \"undrained\"`, otherwise `stabilisation.method = \"subgrid-f-bar\"`."
        }
        Stabilisation::ConsistentFBar | Stabilisation::SubgridFBar if is_rubbery && is_static => {
            "If the soil is undrained, set `drainage = \"undrained\"`. Otherwise reduce `poisson` to 0.49."
        }
        Stabilisation::ConsistentFBar | Stabilisation::ModifiedFBar if may_fit(case) => {
            "Use smaller cells, or set `solver.quadrature = \"fitted\"`."
        }
        Stabilisation::ConsistentFBar
            if case.analysis.regime == Regime::Dynamic && case.analysis.mass == MassMatrix::Lumped =>
        {
            "Use smaller cells, or set `analysis.mass = \"consistent\"`."
        }
        Stabilisation::ConsistentFBar | Stabilisation::ModifiedFBar | Stabilisation::SubgridFBar => {
            "Use smaller cells."
        }
    }
}

/// What makes less energy than the method in use.
fn against_growth(method: Stabilisation) -> &'static str {
    match method {
        Stabilisation::None => "Reduce `analysis.dt`, or the dilation angle.",
        Stabilisation::ConsistentFBar | Stabilisation::SubgridFBar => {
            "Reduce `analysis.dt` or the dilation angle, or set `stabilisation.method = \"none\"`."
        }
        Stabilisation::FBar | Stabilisation::ModifiedFBar => {
            "Set `stabilisation.method = \"consistent-f-bar\"`, or reduce `analysis.dt` or the dilation angle."
        }
    }
}

/// Whether volumes may be fitted, and are not.
fn may_fit(case: &Case) -> bool {
    let is_allowed = case.analysis.regime == Regime::QuasiStatic && case.flow.is_none() && case.grid.order <= 2;
    is_allowed && case.solver.quadrature == Quadrature::Points
}

/// Texts that depend on nothing but the name, the type of the analysis, and whether volumes may be fitted.
fn constant(name: &str, case: &Case) -> &'static str {
    let is_dynamic = case.analysis.regime == Regime::Dynamic;
    match name {
        "quadrature-defect" => {
            "I0003: the volume of the material points in full cells differs from that of the cell by {value} on \
             average ({range}). Stresses are wrong by about as much. Increase `body.points_per_cell`."
        }
        "quadrature-defect-largest" => {
            "I0004: in a full cell the material points together differ by {value} from the volume of the cell \
             ({range}). The stress there is wrong by about as much. Increase `body.points_per_cell`."
        }
        "points-per-cell" => {
            "I0005: full cells have {value} material points on average ({range}). The integration is too coarse, and \
             stresses oscillate. Increase `body.points_per_cell`."
        }
        "compression" if may_fit(case) => {
            "I0006: the most compressed soil has lost {value} of its volume ({range}). With few points per cell its \
             stress is wrong by up to 1 %. Set `solver.quadrature = \"fitted\"`, or `body.points_per_cell = 4`."
        }
        "compression" => {
            "I0006: the most compressed soil has lost {value} of its volume ({range}). With few points per cell its \
             stress is wrong by up to 1 %. Set `body.points_per_cell = 4`."
        }
        "force-measure" => {
            "I0007: the program accepted a step with a force residual of {value} ({range}). This is a defect of the \
             program. Report this message."
        }
        "energy-measure" => {
            "I0008: the program accepted a step with an energy residual of {value} ({range}). This is a defect of \
             the program. Report this message."
        }
        "water-measure" => {
            "I0009: the program accepted a step with a water residual of {value} ({range}). This is a defect of the \
             program. Report this message."
        }
        "water-balance" => {
            "I0010: the water balance has an error of {value} of the water that moved ({range}). Water was created \
             or lost. Reduce `solver.force_tolerance`."
        }
        "energy-closure" => {
            "I0011: the energy balance has an error of {value} of the peak energy ({range}). The steps are not \
             converged well enough. Reduce `solver.tolerance`."
        }
        "energy-loss" if !is_dynamic => {
            "I0012: the algorithm removed {value} of the peak energy between the steps ({range}). The steps are too \
             long. Increase `analysis.steps`."
        }
        "energy-loss" => {
            "I0012: numerical dissipation is {value} of the peak energy ({range}). The motion is damped too \
             strongly. Reduce `analysis.dt`."
        }
        _ => of_motion(name, case),
    }
}

/// Those of smoothing, and of what moves.
fn of_motion(name: &str, case: &Case) -> &'static str {
    let is_dynamic = case.analysis.regime == Regime::Dynamic;
    match name {
        "smoothing-length" => {
            "I0014: strains were smoothed over a length of {value} ({range}). Details of the stress below this \
             length are lost. Use smaller cells, or set `stabilisation.method = \"consistent-f-bar\"`."
        }
        "slip" => {
            "I0015: slip of the soil along a rigid footing or segment is {value} of the motion of the latter \
             ({range}). The force is too small. Increase `analysis.steps`, or use smaller cells there."
        }
        "support-pull" => {
            "I0016: soil pulls on a fixed boundary, with {value} of the largest reaction ({range}). This is right at \
             a plane of symmetry only. Set any other side to `\"contact\"` in `[boundary]`."
        }
        "front-setback" => {
            "I0017: the measured front moved back by {value} ({range}), because it ignores a tip thinner than half a \
             cell. Do not take it as the run-out. Use smaller cells, or a history with `quantity = \"runout\"`."
        }
        "step-advance" => {
            "I0018: a material point moved by {value} in one step ({range}). The positions of fronts and contacts \
             are wrong by 5 to 10 %. Reduce `analysis.dt`."
        }
        "rigid-penetration" if is_dynamic => {
            "I0020: soil penetrates a rigid body by {value} ({range}). The position of the contact is wrong by this \
             distance. Reduce `analysis.dt`."
        }
        "rigid-penetration" => {
            "I0020: soil penetrates a rigid body by {value} ({range}). The position of the contact is wrong by this \
             distance. Increase `analysis.steps`."
        }
        _ => of_forces(name, case),
    }
}

/// Those of flow, of the resolution of footings and openings, of forces and of stiffnesses.
fn of_forces(name: &str, case: &Case) -> &'static str {
    match name {
        "permeability-shift" => {
            "I0022: an interface of two permeabilities has moved {value} from its grid line ({range}). Flow is wrong \
             by up to a factor of 2. Use larger cells, so that it moves less in units of cells."
        }
        "cells-across-footing" => {
            "I0023: the footing is {value} cells wide ({range}). The failure load is more than 8 % too large. Use \
             smaller cells at the footing, or extrapolate with `bsmpm limit-load`."
        }
        "cells-across-opening" => {
            "I0024: the hole or notch {which} is {value} cells wide ({range}). The stress at its edge is wrong by \
             more than 10 %. Refine `grid.knots` there."
        }
        "force-noise" => {
            "I0025: the force {which} scatters by {value} of its peak from step to step ({range}). Average it over \
             several steps, or use smaller cells where it acts."
        }
        "background-load-share" if case.solver.extended_splines == ExtendedSplines::Off => {
            "I0026: the artificial stiffness of nearly empty cells carries {value} of the nodal forces ({range}). It \
             yields in every step, so soil there moves too far. Remove `solver.extension`."
        }
        "background-load-share" => {
            "I0026: the artificial stiffness of nearly empty cells carries {value} of the nodal forces ({range}). It \
             yields in every step, so soil there moves too far. Increase `body.points_per_cell`."
        }
        "stiffness-loss" => {
            "I0027: {which}: the elastic stiffness is {value} times the tangent stiffness ({range}). Do not use \
             displacements after failure. Reduce the load, or use `bsmpm fos`."
        }
        "background-work" => {
            "I0028: the artificial stiffness of nearly empty cells does {value} of the internal work of the soil \
             ({range}). Forces are too large by about as much. Reduce `solver.background`."
        }
        _ => "",
    }
}
