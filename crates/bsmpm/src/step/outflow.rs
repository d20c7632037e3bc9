//! Removes material beyond outflow faces after a step.

use crate::energy::StoredEnergy;
use crate::exact::Exact;
use crate::kinematics::Kinematics;
use crate::model::Model;
use crate::parallel::Halo;
use crate::points::Points;
use std::collections::HashSet;

/// Material that has left the grid in a step, over all ranks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outflow {
    /// Number of points.
    pub points: u64,
    /// Mass (kg).
    pub mass: f64,
    /// Energy of the points with this material, and without it (J).
    pub stored: [StoredEnergy; 2],
}

impl Outflow {
    /// Removes the points that have left the grid by time `t` (s); `None` if there are none. One reduction in a model
    /// with outlets, and two more if points leave.
    pub fn of<K: Kinematics<D>, const D: usize>(
        model: &Model<K, D>,
        points: &mut Points<D>,
        t: f64,
        halo: &dyn Halo,
    ) -> Option<Self> {
        if model.boundary.outlets.is_empty() {
            return None;
        }
        let out: Vec<usize> = (0..points.len())
            .filter(|&p| model.boundary.lets_out(&model.grid, &points.x[p]))
            .collect();
        let mass: Exact = out.iter().map(|&p| points.mass[p]).collect();
        let sums = halo.reproducible_sum(&[[out.len() as f64].into_iter().collect(), mass]);
        if sums[0] == 0.0 {
            return None;
        }
        let before = StoredEnergy::of(model, points, t, halo);
        let gone: HashSet<u64> = out.iter().map(|&p| points.id[p]).collect();
        points.remove(|id| gone.contains(&id));
        let stored = [before, StoredEnergy::of(model, points, t, halo)];
        Some(Self {
            points: sums[0] as u64,
            mass: sums[1],
            stored,
        })
    }
}
