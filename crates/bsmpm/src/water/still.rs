//! Hydrostatic pressure, its gradient and the weight of water, which drive flow, theory-manual equation (T8.7).

use crate::model::{Gravity, Model, Regime};
use crate::points::Points;
use crate::tensor::Vector;
use crate::water::Water;
use crate::water::ambient::Ambient;

/// m/s2  by which a weight is a mass, where a model has no gravity
const GRAVITY: f64 = 9.81;

impl<const D: usize> Water<D> {
    /// Whether a soil may be partly saturated: the still water then goes on above its level, as suction.
    fn holds(&self) -> bool {
        self.flow.as_ref().is_some_and(|flow| flow.retains())
    }

    /// Pa  pressure of the still water at the place `x` at time `t`: 0 above its level, or suction where soils hold it
    pub fn still_pressure(&self, x: &Vector<D>, t: f64) -> f64 {
        let least = if self.holds() { f64::NEG_INFINITY } else { 0.0 };
        self.ambient
            .table(x[0], t)
            .map_or(0.0, |(height, _)| self.unit_weight * (height - x[D - 1]).max(least))
    }

    /// Pa  excess pressure at the place `x` before the first step: none, but where the suction above the level has its
    /// limit
    pub fn excess_at_start(&self, x: &Vector<D>) -> f64 {
        self.excess_at_rest(x, 0.0)
    }

    /// Pa  the same of ground that comes at time `t`
    fn excess_at_rest(&self, x: &Vector<D>, t: f64) -> f64 {
        let Some(flow) = self.flow.as_ref().filter(|flow| flow.retains()) else {
            return 0.0;
        };
        (-flow.suction - self.still_pressure(x, t)).max(0.0)
    }

    /// Gives the points from `first` on, which are placed at time `t`, the water that ground has before the first step:
    /// without excess, at the level of that time.
    pub fn fill(&self, points: &mut Points<D>, first: usize, t: f64) {
        for p in first..points.len() {
            let x = points.x[p];
            let flow = self.flow.as_ref();
            if flow.is_none_or(|flow| flow.soils[usize::from(points.material[p])].is_none()) {
                continue;
            }
            if let Some(excess) = &mut points.pore_pressure {
                excess[p] = self.excess_at_rest(&x, t);
            }
            if let Some(gradient) = &mut points.pressure_gradient {
                gradient[p] = self.still_gradient(&x, t);
            }
        }
    }

    /// Pa/m  its gradient
    pub fn still_gradient(&self, x: &Vector<D>, t: f64) -> Vector<D> {
        let Some((_, slope)) = self
            .ambient
            .table(x[0], t)
            .filter(|(height, _)| *height > x[D - 1] || self.holds())
        else {
            return Vector::zeros();
        };
        let mut gradient = Vector::zeros();
        gradient[0] += self.unit_weight * slope;
        gradient[D - 1] -= self.unit_weight;
        gradient
    }

    /// Pa/m  the water's own weight at time `t`: against the last axis where there is still water, which it holds in
    /// balance; else as the model's gravity acts, in a quasi-static analysis its vertical part
    pub fn weight<K>(&self, model: &Model<K, D>, t: f64) -> Vector<D> {
        if self.ambient != Ambient::None {
            let mut down = Vector::zeros();
            down[D - 1] = -self.unit_weight;
            return down;
        }
        let Some(gravity) = weighing(model) else {
            return Vector::zeros();
        };
        let whole = gravity.acceleration.norm();
        if whole > 0.0 {
            gravity.at(t) * (self.unit_weight / whole)
        } else {
            Vector::zeros()
        }
    }

    /// kg/m3
    pub fn density<K>(&self, model: &Model<K, D>) -> f64 {
        let whole = weighing(model).map_or(0.0, |gravity| gravity.acceleration.norm());
        self.unit_weight / if whole > 0.0 { whole } else { GRAVITY }
    }
}

/// What water weighs by: pseudo-static inertia, the horizontal part of gravity in a quasi-static analysis, leaves pore
/// pressures as they are.
fn weighing<K, const D: usize>(model: &Model<K, D>) -> Option<Gravity<D>> {
    let is_static = model.regime == Regime::QuasiStatic;
    model
        .gravity
        .map(|gravity| if is_static { gravity.vertical() } else { gravity })
}
