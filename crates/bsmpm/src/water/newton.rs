//! Newton direction of displacements and pore pressures, by FGMRES with the fixed-stress split, theory-manual equation
//! (T8.16), as preconditioner.

use crate::error::SolveError;
use crate::kinematics::Kinematics;
use crate::material::Material;
use crate::parallel::{Krylov, LinearSolver, dots};
use crate::solve::fgmres;
use crate::solve::linearised::Linearised;
use crate::solve::unknowns::Unknowns;
use crate::step::problem::Problem;
use crate::step::residual::{Balance, Residual};
use crate::step::stiffness;
use crate::water::matrix;
use crate::water::nodes::Pores;
use crate::water::residual::WaterBalance;
use crate::water::split::{Split, system};

/// By what both out-of-balance vectors are measured.
#[derive(Clone, Copy, Debug)]
pub struct Scales {
    force: f64, // N
    water: f64, // m3
}

impl Scales {
    /// Of a state: the largest force, and the largest of what is stored, flows and leaves, or of what such forces would
    /// strain of the stiffest material.
    pub fn of<K: Kinematics<D>, const D: usize>(problem: &Problem<'_, K, D>, balance: &Balance) -> Self {
        let material = |material: &Material| material.elastic().oedometric();
        let stiffest = problem.model.materials.iter().map(material).fold(0.0, f64::max);
        let force = if balance.scale > 0.0 { balance.scale } else { 1.0 };
        let strained = force * problem.model.grid.smallest_edge() / stiffest;
        Self {
            force,
            water: balance.water.as_ref().map_or(0.0, |water| water.scale).max(strained),
        }
    }

    /// Root of the sum of the squares of what is out of balance in both.
    pub fn measure(&self, balance: &Balance) -> f64 {
        let water = balance.water.as_ref().map_or(0.0, |water| water.norm);
        (balance.norm / self.force).hypot(water / self.water)
    }
}

/// A direction, m and behind it Pa; the work of it that energies are measured by, N m, that of the secants, by its
/// magnitude in the skeleton and in the water; and how the Krylov method ended.
pub struct Exact {
    /// m, and Pa behind them; nodal
    pub dx: Vec<f64>,
    /// N m
    pub energy: f64,
    /// to the tolerance asked for, or as far as it came
    pub krylov: Krylov,
}

/// The direction at the state `x` to the residual `relative`, by systems that are assembled there.
pub fn direction<K: Kinematics<D>, const D: usize>(
    (problem, pores): (&Problem<'_, K, D>, &Pores<D>),
    (x, residual, water): (&[f64], &Residual<K, D>, &WaterBalance),
    relative: f64,
    solver: &mut dyn LinearSolver,
) -> Result<Exact, SolveError> {
    let (components, halo, balance) = (problem.nodes.free.len(), problem.halo, &residual.balance);
    let linearised = Linearised::at(problem, residual).with_water(x);
    stiffness::assemble(problem, Some(&residual.trial), solver)?;
    matrix::assemble(problem, pores, &x[components..], system(solver)?)?;
    let scales = Scales::of(problem, balance);
    let unknowns = Unknowns::of::<D>(&problem.nodes.free, halo).with_pressures(components, &pores.free, halo);
    let weighted = |nodal: &mut [f64], by: [f64; 2]| {
        nodal[..components].iter_mut().for_each(|force| *force *= by[0]);
        nodal[components..].iter_mut().for_each(|volume| *volume *= by[1]);
    };
    let (divided, back) = ([1.0 / scales.force, 1.0 / scales.water], [scales.force, scales.water]);
    let mut f: Vec<f64> = balance
        .f_oob
        .iter()
        .copied()
        .chain(water.excess.iter().map(|excess| -excess))
        .collect();
    let first = Split::of(problem, (pores, &f), solver)?;
    weighted(&mut f, divided);
    let (mut nodal, mut image) = (vec![0.0; x.len()], vec![0.0; x.len()]);
    let product = |v: &[f64]| {
        unknowns.unpack(v, &mut nodal);
        linearised.multiply(&nodal, &mut image);
        weighted(&mut image, divided);
        unknowns.packed(&image)
    };
    let mut force = vec![0.0; x.len()];
    let precondition = |r: &[f64]| {
        unknowns.unpack(r, &mut force);
        weighted(&mut force, back);
        Ok(unknowns.packed(&Split::of(problem, (pores, &force), solver)?.z))
    };
    let (found, krylov) = fgmres::solve(
        (&unknowns, halo),
        product,
        precondition,
        (&unknowns.packed(&f), relative),
    )?;
    let mut dx = vec![0.0; x.len()];
    unknowns.unpack(&found, &mut dx);
    let ((du, dp), (f_u, f_p)) = (dx.split_at(components), first.f.split_at(components));
    // Of either sign by itself: what one lacks must not hide what the other does.
    let energy = dots(halo, D, &[(du, f_u)])[0].abs() + dots(halo, 1, &[(dp, f_p)])[0].abs();
    Ok(Exact { dx, energy, krylov })
}
