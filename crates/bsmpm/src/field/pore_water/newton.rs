//! Newton direction of displacements and pore pressures, by FGMRES with the fixed-stress split, theory-manual equation
//! (T8.16), as preconditioner.

use crate::error::SolveError;
use crate::field::FieldBalance;
use crate::field::pore_water::matrix;
use crate::field::pore_water::nodes::PorePressureField;
use crate::field::pore_water::residual::WaterBalance;
use crate::field::pore_water::split::Split;
use crate::kinematics::Kinematics;
use crate::linear::{Krylov, LinearSolver};
use crate::parallel::dot;
use crate::solve::fgmres;
use crate::solve::linearised::ForceTangent;
use crate::solve::unknowns::Unknowns;
use crate::step::problem::Problem;
use crate::step::residual::{Balance, Residual};
use crate::step::stiffness;

/// Scales that make out-of-balance forces and water volumes comparable.
#[derive(Clone, Copy, Debug)]
pub struct Scales {
    force: f64, // N
    water: f64, // m3
}

impl Scales {
    /// Returns the scales of a state: the largest force, and the largest norm of storage, flow and water through
    /// surfaces. The scale of water is at least the volume by which that force strains a cell of the stiffest material.
    pub fn of<K: Kinematics<D>, const D: usize>(problem: &Problem<'_, K, D>, balance: &Balance) -> Self {
        let materials = problem.model.materials.iter();
        let stiffest = materials
            .map(|material| material.elastic().oedometric())
            .fold(0.0, f64::max);
        let force = if balance.scale > 0.0 { balance.scale } else { 1.0 };
        let strained = force * problem.model.grid.smallest_edge() / stiffest;
        Self {
            force,
            water: balance.field.as_ref().map_or(0.0, |water| water.scale).max(strained),
        }
    }

    /// Returns the root of the sum of squares of both scaled norms.
    pub fn measure(&self, balance: &Balance) -> f64 {
        let water = balance.field.as_ref().map_or(0.0, |water| water.norm);
        (balance.norm / self.force).hypot(water / self.water)
    }
}

/// Newton direction, its energy, and the result of the Krylov method.
pub struct CoupledDirection {
    /// Displacements (m), followed by pressures (Pa), nodal.
    pub dx: Vec<f64>,
    /// Sum of the magnitudes of the works of skeleton and water in the direction (N m), in the measure of the
    /// quasi-Newton method.
    pub energy: f64,
    /// Krylov method: converged to the requested tolerance, or stopped before.
    pub krylov: Krylov,
}

/// Solves for the direction at the state `x` to the relative residual `relative`. The preconditioner is assembled at
/// that state.
pub fn direction<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    pores: &PorePressureField<D>,
    x: &[f64],
    residual: &Residual<K, D>,
    water: &WaterBalance,
    relative: f64,
    solver: &mut dyn LinearSolver,
) -> Result<CoupledDirection, SolveError> {
    let components = problem.nodes.constraints.free.len();
    let halo = problem.halo;
    let balance = &residual.balance;
    let linearised = ForceTangent::at(problem, residual).with_field(x);
    stiffness::factorise(problem, Some(&residual.trial), solver)?;
    matrix::factorise(problem, pores, &x[components..], solver)?;
    let scales = Scales::of(problem, balance);
    let unknowns = Unknowns::of::<D>(&problem.nodes.constraints.free, halo).with_field(components, &pores.free, halo);
    let divided = [1.0 / scales.force, 1.0 / scales.water];
    let back = [scales.force, scales.water];
    let mut f: Vec<f64> = balance.f_oob.iter().copied().chain(water.lacking()).collect();
    let first = Split::of(problem, pores, &f, solver)?;
    scale(&mut f, components, divided);
    let mut nodal = vec![0.0; x.len()];
    let mut image = vec![0.0; x.len()];
    let mut force = vec![0.0; x.len()];
    let (found, krylov) = fgmres::solve(
        &unknowns,
        halo,
        |v| {
            unknowns.unpack(v, &mut nodal);
            linearised.multiply(&nodal, &mut image);
            scale(&mut image, components, divided);
            unknowns.packed(&image)
        },
        |r| {
            unknowns.unpack(r, &mut force);
            scale(&mut force, components, back);
            Ok(unknowns.packed(&Split::of(problem, pores, &force, solver)?.z))
        },
        &unknowns.packed(&f),
        relative,
    )?;
    let mut dx = vec![0.0; x.len()];
    unknowns.unpack(&found, &mut dx);
    let (du, dp) = dx.split_at(components);
    let (f_u, f_p) = first.f.split_at(components);
    // Magnitudes are added, so that works of opposite sign do not cancel.
    let energy = dot(halo, D, du, f_u).abs() + dot(halo, 1, dp, f_p).abs();
    Ok(CoupledDirection { dx, energy, krylov })
}

/// Multiplies the first `components` numbers of a nodal array (forces) by `factors[0]` and the others (water) by
/// `factors[1]`.
fn scale(nodal: &mut [f64], components: usize, factors: [f64; 2]) {
    let (forces, volumes) = nodal.split_at_mut(components);
    forces.iter_mut().for_each(|force| *force *= factors[0]);
    volumes.iter_mut().for_each(|volume| *volume *= factors[1]);
}
