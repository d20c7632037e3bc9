//! What is printed of an indicator that is outside its usual range: what was measured, what that means, what to do.

use bsmpm::grid::extension::ExtendedSplines;
use bsmpm::model::Regime;
use bsmpm::model::WallVelocity;
use bsmpm::quadrature::Quadrature;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::step::mass::MassMatrix;
use bsmpm_scene::{Case, Geometry};

/// Poisson's ratio from which on material is nearly incompressible: the lid-driven square and the footing of
/// `cases/results/stabilisation.md`, for which remedies were measured, have 0.499 and more.
const NEARLY_INCOMPRESSIBLE: f64 = 0.49;

/// The text of an indicator of a case by its name, with places for the value, its range and the one that is meant;
/// empty for a name that is none.
pub(super) fn of(name: &str, case: &Case, value: f64) -> String {
    let noise = || against_noise(case);
    match name {
        "pressure-noise-average" => NOISE_ABOUT_AVERAGE.replace("{remedy}", noise()),
        "pressure-noise-plane" => NOISE_ABOUT_PLANE.replace("{remedy}", noise()),
        "energy-growth" => GROWTH.replace("{remedy}", against_growth(case.stabilisation)),
        "wall-velocity" => WALL.replace("{remedy}", against_sliding(case)),
        "energy-loss" if value < 0.0 => ENERGY_MADE.to_owned(),
        _ => constant(name, case).to_owned(),
    }
}

const NOISE_ABOUT_AVERAGE: &str = "I0001: pressure scatter of the material points about their local mean is {value} \
    ({range}). Stresses at single points are unreliable. {remedy}";
const NOISE_ABOUT_PLANE: &str = "I0002: pressure scatter of the material points about a local linear fit is {value} \
    ({range}). Stresses at single points are unreliable. {remedy}";
const ENERGY_MADE: &str = "I0012: numerical dissipation, relative to the peak energy, is {value} ({range}). The algorithm \
                           adds energy to the motion. Reduce `analysis.dt`.";
const GROWTH: &str = "I0013: energy created by the algorithm, relative to the peak energy, is {value} ({range}). The \
                      computed motion is too fast. {remedy}";
const WALL: &str = "I0019: excess kinetic energy of soil next to fixed boundaries, relative to the total, is {value} \
                    ({range}). The soil slides too far along these boundaries. {remedy}";

/// What makes material next to a fixed boundary stick to it.
fn against_sliding(case: &Case) -> &'static str {
    match case.analysis.wall_velocity {
        WallVelocity::Relaxed => "Use smaller cells, or a boundary with `friction_coefficient`.",
        WallVelocity::Own => "Set `analysis.wall_velocity = \"relaxed\"`, or use smaller cells.",
    }
}

/// What reduces the noise of the pressure under the method in use, as `cases/results/strip_footing.md`,
/// `column_collapse.md` and `stabilisation.md` have measured it.
fn against_noise(case: &Case) -> &'static str {
    let is_nearly_incompressible = case.bodies.iter().any(|body| {
        let named = &case.materials[body.material];
        named.material.elastic().poisson >= NEARLY_INCOMPRESSIBLE
    });
    let is_rubbery = is_nearly_incompressible && case.flow.is_none();
    let is_static = case.analysis.regime == Regime::QuasiStatic;
    match case.stabilisation {
        Stabilisation::None | Stabilisation::FBar | Stabilisation::FBarZhao => {
            "Set `stabilisation.method = \"consistent-f-bar\"`."
        }
        Stabilisation::ConsistentFBar if is_rubbery && is_static && case.geometry != Geometry::Solid => {
            "State the material as undrained soil (`drainage = \"undrained\"`), or set `stabilisation.method = \"subgrid-f-bar\"`."
        }
        Stabilisation::ConsistentFBar | Stabilisation::SubgridFBar if is_rubbery && is_static => {
            "State the material as undrained soil (`drainage = \"undrained\"`)."
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
        Stabilisation::FBar | Stabilisation::FBarZhao | Stabilisation::ModifiedFBar => {
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
            "I0003: RMS difference between the volumes of full cells and of the material points in them is {value} \
             ({range}). Stresses are wrong by a similar amount. Increase `body.points_per_cell`."
        }
        "quadrature-defect-largest" => {
            "I0004: largest difference between the volumes of a full cell and of the material points in it is {value} \
             ({range}). Stresses there are wrong by a similar amount. Increase `body.points_per_cell`."
        }
        "points-per-cell" => {
            "I0005: mean number of material points in filled cells is {value} ({range}). The integration is too coarse, and stresses \
             oscillate. Increase `body.points_per_cell`."
        }
        "compression" if may_fit(case) => {
            "I0006: volume reduction of the most compressed material is {value} ({range}). With few points per cell its \
             stress is wrong by up to 1 %. Set `solver.quadrature = \"fitted\"`, or `body.points_per_cell = 4`."
        }
        "compression" => {
            "I0006: volume reduction of the most compressed material is {value} ({range}). With few points per cell its \
             stress is wrong by up to 1 %. Set `body.points_per_cell = 4`."
        }
        "force-measure" => {
            "I0007: largest force residual of an accepted step is {value} ({range}). The program accepted a step that \
             had not converged, which is a defect of the program. Report this message."
        }
        "energy-measure" => {
            "I0008: largest energy residual of an accepted step is {value} ({range}). The program accepted a step \
             that had not converged, which is a defect of the program. Report this message."
        }
        "water-measure" => {
            "I0009: largest water residual of an accepted step is {value} ({range}). The program accepted a step that \
             had not converged, which is a defect of the program. Report this message."
        }
        "water-balance" => {
            "I0010: error of the water balance, relative to the water that moved, is {value} ({range}). Water was created or lost. \
             Reduce `solver.force_tolerance`."
        }
        "energy-closure" => {
            "I0011: error of the energy balance, relative to the peak energy, is {value} ({range}). The steps are not converged \
             well enough. Reduce `solver.tolerance`."
        }
        "energy-loss" => {
            "I0012: numerical dissipation, relative to the peak energy, is {value} ({range}). The motion is damped too strongly. \
             Reduce `analysis.dt`."
        }
        "smoothing-length" => {
            "I0014: length over which strains were smoothed is {value} ({range}). Details of the stress that are \
             smaller are lost. Use smaller cells, or another `stabilisation.method`."
        }
        "slip" => {
            "I0015: largest slip of soil along a rigid footing or segment, relative to its motion, is {value} \
             ({range}). The computed force is too small. Increase `analysis.steps`, or use smaller cells there."
        }
        "support-pull" => {
            "I0016: largest tension at a boundary, relative to the largest reaction, is {value} ({range}). Tension is \
             correct at a plane of symmetry only. Set other sides to `\"contact\"` in `[boundary]`."
        }
        "front-setback" => {
            "I0017: largest backward movement of the front is {value} ({range}). The tip is thinner than half a cell, \
             so the front is not the run-out distance. Use smaller cells, or `quantity = \"runout\"`."
        }
        "step-advance" => {
            "I0018: largest displacement of a material point in one step is {value} ({range}). The positions of \
             fronts and contacts are wrong by 5 to 10 %. Reduce `analysis.dt`."
        }
        "rigid-penetration" if is_dynamic => {
            "I0020: largest penetration of soil into a rigid body is {value} ({range}). The position of the contact \
             is wrong by this distance. Reduce `analysis.dt`."
        }
        "rigid-penetration" => {
            "I0020: largest penetration of soil into a rigid body is {value} ({range}). The position of the contact \
             is wrong by this distance. Increase `analysis.steps`."
        }
        "interface-shift" if may_fit(case) => {
            "I0021: distance of a material interface from the grid line where it began is {value} ({range}). Stresses \
             within three cells are wrong. Set `solver.quadrature = \"fitted\"`, or use larger cells there."
        }
        "interface-shift" => {
            "I0021: distance of a material interface from the grid line where it began is {value} ({range}). Stresses \
             within three cells are wrong. Use larger cells there."
        }
        "permeability-shift" => {
            "I0022: distance of an interface of permeabilities from the grid line where it began is {value} \
             ({range}). Flow there is wrong by up to a factor of 2. Use larger cells there."
        }
        "cells-across-footing" => {
            "I0023: number of cells across the footing is {value} ({range}). The failure load is more than 8 % too \
             large. Use smaller cells at the footing, or extrapolate with `bsmpm limit-load`."
        }
        "cells-across-opening" => {
            "I0024: number of cells across the hole or notch {which} is {value} ({range}). The stress at its edge is \
             wrong by more than 10 %. Refine `grid.knots` there."
        }
        "force-noise" => {
            "I0025: scatter of the force {which} from step to step, relative to its peak, is {value} ({range}). \
             Single values are uncertain. Use smaller cells there, or average the force over several steps."
        }
        "background-load-share" if case.solver.extended_splines == ExtendedSplines::Off => {
            "I0026: largest force of the artificial background stiffness, relative to the nodal forces, is {value} \
             ({range}). Soil in nearly empty cells creeps from step to step. Remove `solver.extension`."
        }
        "background-load-share" => {
            "I0026: largest force of the artificial background stiffness, relative to the nodal forces, is {value} \
             ({range}). Soil in nearly empty cells creeps from step to step. Increase `body.points_per_cell`."
        }
        "stiffness-loss" => {
            "I0027: largest ratio of the elastic to the actual stiffness of the ground{which} is {value} ({range}). \
             Displacements after failure are not reliable. Reduce the load, or use `bsmpm fos`."
        }
        "background-work" => {
            "I0028: work of the artificial background stiffness, relative to the internal work, is {value} ({range}). \
             Forces are too large by a similar amount. Reduce `solver.background`."
        }
        _ => "",
    }
}
