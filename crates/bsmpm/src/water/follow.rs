//! Reassembles the pressure matrix during a step, if seepage faces open or close, or saturation changes.

use crate::error::SolveError;
use crate::kinematics::Kinematics;
use crate::parallel::LinearSolver;
use crate::step::problem::Problem;
use crate::water::matrix;
use crate::water::nodes::PoreField;
use crate::water::split;

/// Iterations that pores which empty are followed for.
const FIRST: usize = 12;
/// Part of the water out of balance below which secants do better.
const NEAR: f64 = 1e-2;
/// Changes of open seepage faces that are followed in an iteration.
const CHANGES: usize = 40;

/// What the matrix of the pressures was assembled with last.
#[derive(Clone, Debug, Default)]
pub struct Follow {
    open: Vec<bool>, // seepage faces' points
    changes: usize,
    first: usize,
    tamed: bool, // the last direction was not taken as it was
}

impl Follow {
    /// Of the state behind the displacements of `x` that the matrix is assembled at.
    pub fn of<K, const D: usize>(problem: &Problem<'_, K, D>, x: &[f64]) -> Self {
        let open = problem.nodes.pores.as_ref().map_or_else(Vec::new, |pores| {
            let p = &x[problem.nodes.free.len()..];
            pores.drainage.open(if p.is_empty() { &pores.guess } else { p })
        });
        Self {
            open,
            changes: 0,
            first: 0,
            tamed: false,
        }
    }

    /// Holds a direction `dx` back where it would fill pores beyond full ones, or empty them to more than twice the
    /// suction and the air's entry, as long as the first iterations are followed.
    pub fn tame<K, const D: usize>(
        &mut self,
        problem: &Problem<'_, K, D>,
        pores: &PoreField<D>,
        x: &[f64],
        dx: &mut [f64],
        measure: f64,
    ) {
        let Some(water) = &problem.model.water else { return };
        let Some(flow) = water.flow.as_ref().filter(|flow| flow.retains()) else {
            return;
        };
        if self.first >= FIRST || measure <= NEAR {
            return;
        }
        let entry = flow.entry() * water.unit_weight;
        let start = problem.nodes.free.len();
        for (node, still) in pores.still.iter().enumerate().filter(|(node, _)| pores.free[*node]) {
            let whole = x[start + node] + still;
            let change = &mut dx[start + node];
            let held = if whole < 0.0 {
                change.clamp(whole - entry, -whole)
            } else {
                change.max(-whole - entry)
            };
            self.tamed |= held != *change;
            *change = held;
        }
    }

    /// Assembles the matrix again at `x` where that is due by the `measure` of the water; whether it has. One reduction
    /// where a seepage face is or pores may empty.
    pub fn up<K: Kinematics<D>, const D: usize>(
        &mut self,
        problem: &Problem<'_, K, D>,
        pores: &PoreField<D>,
        x: &[f64],
        measure: f64,
        solver: &mut dyn LinearSolver,
    ) -> Result<bool, SolveError> {
        let Some(flow) = problem.model.water.as_ref().and_then(|water| water.flow.as_ref()) else {
            return Ok(false);
        };
        if !flow.retains() && !flow.is_one_way() {
            return Ok(false);
        }
        let p = &x[problem.nodes.free.len()..];
        let open = pores.drainage.open(p);
        let mut changed = [open != self.open, self.tamed].map(|is| f64::from(u8::from(is)));
        problem.halo.all_reduce_max(&mut changed);
        let first = flow.retains() && self.first < FIRST && (measure > NEAR || changed[1] > 0.0);
        let change = changed[0] > 0.0 && self.changes < CHANGES;
        if !first && !change {
            return Ok(false);
        }
        self.first += usize::from(first);
        self.changes += usize::from(change);
        (self.open, self.tamed) = (open, false);
        matrix::assemble(problem, pores, p, split::system(solver)?)?;
        Ok(true)
    }
}
