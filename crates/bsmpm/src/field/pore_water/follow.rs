//! Reassembles the pressure matrix during a step, if seepage faces open or close, or saturation changes.

use crate::error::SolveError;
use crate::field::pore_water::matrix;
use crate::kinematics::Kinematics;
use crate::linear::LinearSolver;
use crate::step::problem::Problem;

/// Largest number of iterations with reassembly because of changes of saturation.
const FIRST: usize = 12;
/// Relative residual of the water balance below which quasi-Newton secants converge better than reassembly.
const NEAR: f64 = 1e-2;
/// Largest number of reassemblies because seepage faces open or close.
const CHANGES: usize = 40;

/// State with which the pressure matrix was last assembled.
#[derive(Clone, Debug, Default)]
pub struct Follow {
    open: Vec<bool>, // open points of seepage faces
    changes: usize,
    first: usize,
    tamed: bool, // whether the last direction was limited
}

impl Follow {
    /// Creates the state for a matrix that is assembled at the displacements and pressures `x`.
    pub fn of<K, const D: usize>(problem: &Problem<'_, K, D>, x: &[f64]) -> Self {
        let open = problem.nodes.field.as_ref().map_or_else(Vec::new, |pores| {
            let p = &x[problem.nodes.constraints.free.len()..];
            pores.drainage.open(if p.is_empty() { &pores.guess } else { p })
        });
        Self {
            open,
            changes: 0,
            first: 0,
            tamed: false,
        }
    }

    /// Limits the pressures of a direction `dx` in the first iterations. A step may not fill pores beyond saturation,
    /// nor more than double the suction plus the air-entry value.
    pub fn tame<K, const D: usize>(&mut self, problem: &Problem<'_, K, D>, x: &[f64], dx: &mut [f64], measure: f64) {
        let Some(pores) = &problem.nodes.field else { return };
        let Some(water) = &problem.model.water else { return };
        let Some(flow) = water.flow.as_ref().filter(|flow| flow.retains()) else {
            return;
        };
        if self.first >= FIRST || measure <= NEAR {
            return;
        }
        let entry = flow.entry() * water.unit_weight;
        let start = problem.nodes.constraints.free.len();
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

    /// Reassembles the matrix at `x` if saturation or seepage faces require it; `measure` is the relative residual of
    /// the water balance. Returns whether it did. One reduction if there are seepage faces or retention.
    pub fn up<K: Kinematics<D>, const D: usize>(
        &mut self,
        problem: &Problem<'_, K, D>,
        x: &[f64],
        measure: f64,
        solver: &mut dyn LinearSolver,
    ) -> Result<bool, SolveError> {
        let Some(pores) = &problem.nodes.field else {
            return Ok(false);
        };
        let Some(flow) = problem.model.water.as_ref().and_then(|water| water.flow.as_ref()) else {
            return Ok(false);
        };
        if !flow.retains() && !flow.is_one_way() {
            return Ok(false);
        }
        let p = &x[problem.nodes.constraints.free.len()..];
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
        matrix::factorise(problem, pores, p, solver)?;
        Ok(true)
    }
}
