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

/// Of an indicator of a case by its name; empty for a name that is none.
pub(super) fn of(name: &str, case: &Case) -> String {
    match name {
        "pressure-noise-average" | "pressure-noise-plane" => format!(
            "the pressure jumps from point to point, so that stresses of single points mean little, though forces and \
             displacements may be right. {} For pictures set output.projected_pressure = true.",
            against_noise(case)
        ),
        "energy-growth" => format!(
            "motion and strain have more energy than they were given: dilatant or strengthless flow under an F-bar \
             makes some. {}",
            against_growth(case.stabilisation)
        ),
        "wall-velocity" => format!(
            "points there keep velocities that the grid holds, and are not braked by the wall as they should be: \
             layers of a cell slide too far. {}",
            match (case.analysis.wall_velocity, case.analysis.mass) {
                (WallVelocity::Relaxed, _) => "Use smaller cells, or a face with { friction_coefficient = ... }.",
                (WallVelocity::Own, MassMatrix::Lumped) => {
                    "Set analysis.wall_velocity = \"relaxed\", use smaller cells, or a face with { friction_coefficient = ... }."
                }
                (WallVelocity::Own, MassMatrix::Consistent) => {
                    "Set analysis.wall_velocity = \"relaxed\", or use smaller cells."
                }
            }
        ),
        "force-noise" => {
            "the force jumps from step to step, so that a single value is uncertain by about this part. Use \
                          smaller cells at what moves, or the mean over several steps."
                .to_owned()
        }
        "rigid-penetration" => {
            "the body was pushed over material points, or its force is beyond what its penalty is made \
                                for: its position is off by this part of a cell. Increase analysis.steps, or reduce \
                                analysis.dt."
                .to_owned()
        }
        _ => constant(name, case).to_owned(),
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
            "Set stabilisation.method = \"consistent-f-bar\"."
        }
        Stabilisation::ConsistentFBar if is_rubbery && is_static && case.geometry != Geometry::Solid => {
            "State the nearly incompressible material as undrained soil (drainage = \"undrained\", the same shear \
             modulus, poisson = 0.25, water.bulk), or set stabilisation.method = \"subgrid-f-bar\"."
        }
        Stabilisation::ConsistentFBar | Stabilisation::SubgridFBar if is_rubbery && is_static => {
            "State the nearly incompressible material as undrained soil (drainage = \"undrained\", the same shear \
             modulus, poisson = 0.25, water.bulk)."
        }
        Stabilisation::ConsistentFBar | Stabilisation::ModifiedFBar if may_fit(case) => {
            "Use smaller cells, or set solver.quadrature = \"fitted\"."
        }
        Stabilisation::ConsistentFBar
            if case.analysis.regime == Regime::Dynamic && case.analysis.mass == MassMatrix::Lumped =>
        {
            "Use smaller cells, or set analysis.mass = \"consistent\"."
        }
        Stabilisation::ConsistentFBar | Stabilisation::ModifiedFBar | Stabilisation::SubgridFBar => {
            "Use smaller cells."
        }
    }
}

/// What makes less energy than the method in use.
fn against_growth(method: Stabilisation) -> &'static str {
    match method {
        Stabilisation::None => "Reduce analysis.dt, or the dilation.",
        Stabilisation::ConsistentFBar | Stabilisation::SubgridFBar => {
            "Set stabilisation.method = \"none\", or reduce analysis.dt or the dilation."
        }
        Stabilisation::FBar | Stabilisation::FBarZhao | Stabilisation::ModifiedFBar => {
            "Set stabilisation.method = \"consistent-f-bar\" or \"none\", or reduce analysis.dt or the dilation."
        }
    }
}

/// Whether volumes may be fitted, and are not.
fn may_fit(case: &Case) -> bool {
    let is_allowed = case.analysis.regime == Regime::QuasiStatic && case.flow.is_none() && case.grid.order <= 2;
    is_allowed && case.solver.quadrature == Quadrature::Points
}

/// Advice that depends on nothing but the name, and whether volumes may be fitted.
fn constant(name: &str, case: &Case) -> &'static str {
    match name {
        "force-measure" | "energy-measure" | "water-measure" => {
            "a step was accepted above its tolerance, which is a fault of the program: report it"
        }
        "quadrature-defect" => {
            "points have crowded or thinned out, and integrals over cells are off by about as much; more points_per_cell"
        }
        "quadrature-defect-largest" => {
            "points have crowded or thinned out in single cells, whose stress is off by about as much; look at the last frame \
             there, and use more points_per_cell"
        }
        "points-per-cell" => {
            "so few points integrate a cell too coarsely, and stresses oscillate; more points_per_cell"
        }
        "compression" if may_fit(case) => {
            "with fewer than 4 points a cell and axis the stress of material that has lost so much of its volume is off by up to \
             1 %; quadrature = \"fitted\" in [solver], or points_per_cell = 4"
        }
        "compression" => {
            "with fewer than 4 points a cell and axis the stress of material that has lost so much of its volume is off by up to \
             1 %; points_per_cell = 4"
        }
        "energy-closure" => {
            "energy has gone that no account names: the steps are not converged well enough; a smaller [solver] tolerance and \
             force_tolerance"
        }
        "water-balance" => {
            "water was created or lost: the steps are not converged well enough, or material with pores has left; a \
             smaller [solver] force_tolerance"
        }
        "energy-loss" => {
            "the algorithm damps what should move on, or (negative) drives it: look at the history's parts for which one does; \
             smaller steps, another [stabilisation] method where integration is negative, less background or numerical damping"
        }
        "interface-shift" if may_fit(case) => {
            "stresses within three cells of the interface are wrong by 3 % (RMS) at 0.03 cells, 10 % at 0.1 and about 25 % at 0.2. \
             Use solver.quadrature = \"fitted\", or larger cells there"
        }
        "interface-shift" => {
            "stresses in the cells next to the interface are wrong: with fitted quadrature by 10 % at a shift of 0.25 cells and 20 % \
             at 0.64, with points by 56 % at 0.25. The error decays over three cells. Use larger cells there"
        }
        "permeability-shift" => {
            "the flow of water through the interface is wrong, by up to a factor of 2 once points have crossed their grid line. \
             Use larger cells there"
        }
        "slip" => {
            "material slides along or off a strip that should hold it, so that the strip's force is too small; more steps, or a \
             strip that covers more cells"
        }
        "smoothing-length" => {
            "the stress is smeared over a length that matters, and results belong to this number of steps; fewer steps, smaller \
             cells, or another [stabilisation] method"
        }
        "support-pull" => {
            "faces of the grid hold both ways: where the body is meant to hang on this one, or it is a plane of symmetry, all is \
             well, but a body that should come off a wall hangs on it; [boundary] \"contact\" lets it go"
        }
        "front-setback" => {
            "the tip has thinned out to less than half a cell, and the front is where the body is thicker: no front of this \
             grid; smaller cells, or quantity = \"runout\" with a percentile"
        }
        "step-advance" => {
            "points move so far in a step that motion and contact are integrated coarsely: fronts of flows are off by 5 to 10 % where \
             it is a cell; a smaller [analysis] dt"
        }
        "background-load-share" => {
            "material at that node has no stiffness of its own and creeps from step to step. Use the default of \
             solver.extension, increase points_per_cell, or reduce analysis.steps"
        }
        "cells-across-footing" => {
            "the load at failure is too large: with 8 cells by 9 % on level ground and 15 % at the crest of a slope, with 16 by 8 and \
             9 %. Use smaller cells at the footing, or analysis.purpose = \"limit-load\" with bsmpm limit-load, which extrapolates"
        }
        "cells-across-opening" => {
            "stress at the edge of the hole or notch is off by more than 10 %. Use smaller cells there (grid.knots), or accuracy = \
             \"standard\""
        }
        "stiffness-loss" => {
            "displacements from then on depend on the number of steps and on solver.background, not on equilibrium. Reduce \
             the load or the strength reduction, or find the factor of safety with `bsmpm fos`"
        }
        "background-work" => {
            "about this part of the forces is carried by the soft background and not by the body: it is stiffer and stronger \
             than its material; a smaller [solver] background"
        }
        _ => "",
    }
}
