//! What an unusual value of an indicator means, and what to do then.

use bsmpm::model::Regime;
use bsmpm::model::WallVelocity;
use bsmpm::quadrature::Quadrature;
use bsmpm::stabilisation::Stabilisation;
use bsmpm::step::mass::MassMatrix;
use bsmpm_scene::{Case, Geometry};

/// Poisson's ratio from which on material is nearly incompressible: the lid-driven square and the footing of
/// `cases/results/stabilisation.md`, for which remedies were measured, have 0.499 and more.
const NEARLY_INCOMPRESSIBLE: f64 = 0.49;

/// The consequence and the remedy of an indicator of a case by its name; empty for a name that is none.
pub(super) fn of(name: &str, case: &Case, value: f64) -> String {
    match name {
        "pressure-noise-average" | "pressure-noise-plane" => format!(
            "Stresses at single points are unreliable. {} For smooth pictures set `output.projected_pressure = true`.",
            against_noise(case)
        ),
        "energy-loss" if value < 0.0 => {
            "The algorithm adds energy to the motion. Reduce `analysis.dt`, or choose another `stabilisation.method`."
                .into()
        }
        "energy-growth" => format!("The motion is too fast. {}", against_growth(case.stabilisation)),
        "wall-velocity" => {
            format!("The boundary does not brake the material, which slides too far. {}", against_sliding(case))
        }
        _ => constant(name, case).to_owned(),
    }
}

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

/// Advice that depends on nothing but the name, the type of the analysis, and whether volumes may be fitted.
fn constant(name: &str, case: &Case) -> &'static str {
    let is_dynamic = case.analysis.regime == Regime::Dynamic;
    match name {
        "force-measure" | "energy-measure" | "water-measure" => {
            "A step was accepted before it converged, which is a defect of the program. Report it."
        }
        "quadrature-defect" => "Integrals over cells are off by about as much. Increase `body.points_per_cell`.",
        "quadrature-defect-largest" => {
            "Stresses in that cell are off by about as much. Look at the last frame, and increase `body.points_per_cell`."
        }
        "points-per-cell" => "The integration is too coarse, and stresses oscillate. Increase `body.points_per_cell`.",
        "compression" if may_fit(case) => {
            "Its stress is off by up to 1 %. Set `solver.quadrature = \"fitted\"`, or `body.points_per_cell = 4`."
        }
        "compression" => "Its stress is off by up to 1 %. Set `body.points_per_cell = 4`.",
        "energy-closure" => {
            "The steps are not converged well enough. Reduce `solver.tolerance` and `solver.force_tolerance`."
        }
        "water-balance" => {
            "Water was created or lost, or saturated soil left the grid. Reduce `solver.force_tolerance`."
        }
        "energy-loss" => {
            "The motion is damped too strongly. Reduce `analysis.dt`, or choose another `stabilisation.method`."
        }
        "interface-shift" if may_fit(case) => {
            "Stresses within three cells of it are wrong. Set `solver.quadrature = \"fitted\"`, or use larger cells there."
        }
        "interface-shift" => "Stresses within three cells of it are wrong. Use larger cells there.",
        "permeability-shift" => "Flow through the interface is wrong by up to a factor of 2. Use larger cells there.",
        "slip" => "Its reaction force is too small. Increase `analysis.steps`, or use smaller cells there.",
        "smoothing-length" => {
            "Smaller details of the stress are lost. Use smaller cells, or another `stabilisation.method`."
        }
        "support-pull" => {
            "This is correct at a plane of symmetry. If the material should separate, use `\"contact\"` in `[boundary]`."
        }
        "front-setback" => {
            "The tip is thinner than half a cell, so that the front is not the run-out. Use smaller cells, or \
             `quantity = \"runout\"`."
        }
        "step-advance" => "Motion and contact are inaccurate: fronts are off by 5 to 10 %. Reduce `analysis.dt`.",
        "background-load-share" => {
            "Material there creeps from step to step. Leave `solver.extension` at its default, or increase \
             `body.points_per_cell`."
        }
        "cells-across-footing" => {
            "The failure load is more than 8 % too large. Use smaller cells there, or extrapolate with `bsmpm limit-load`."
        }
        "cells-across-opening" => {
            "The stress at its edge is off by more than 10 %. Refine `grid.knots` there, or set `accuracy = \"standard\"`."
        }
        "stiffness-loss" => {
            "Displacements after failure depend on the number of steps. Reduce the load, or use `bsmpm fos`."
        }
        "background-work" => "Forces are too large by about this part. Reduce `solver.background`.",
        "force-noise" => {
            "A single value is uncertain by this part. Use smaller cells there, or the mean over several steps."
        }
        "rigid-penetration" if is_dynamic => "Its position is off by this distance. Reduce `analysis.dt`.",
        "rigid-penetration" => "Its position is off by this distance. Increase `analysis.steps`.",
        _ => "",
    }
}
