//! Hydrostatic pressure, its gradient and the weight of water, which drive flow, theory-manual equation (T8.7).

use crate::field::pore_water::Water;
use crate::field::pore_water::ambient::Ambient;
use crate::model::{Gravity, Model, Regime};
use crate::points::Points;
use crate::tensor::Vector;

/// Gravity that converts the unit weight of water to a density in models without gravity (m/s2).
const GRAVITY: f64 = 9.81;

impl<const D: usize> Water<D> {
    /// Returns whether any soil may be partly saturated. The hydrostatic pressure then continues above its level as
    /// suction.
    fn holds(&self) -> bool {
        self.flow.as_ref().is_some_and(|flow| flow.retains())
    }

    /// Returns the hydrostatic pressure at `x` at time `t`; above its level 0, or suction if soils retain water (Pa).
    pub fn still_pressure(&self, x: &Vector<D>, t: f64) -> f64 {
        let least = if self.holds() { f64::NEG_INFINITY } else { 0.0 };
        self.ambient
            .table(x[0], t)
            .map_or(0.0, |(height, _)| self.unit_weight * (height - x[D - 1]).max(least))
    }

    /// Returns the excess pressure at `x` before the first step: 0 unless the hydrostatic suction exceeds its limit
    /// (Pa).
    pub fn excess_at_start(&self, x: &Vector<D>) -> f64 {
        self.excess_at_rest(x, 0.0)
    }

    /// Returns the initial excess pressure at `x` of ground that is placed at time `t` (Pa).
    fn excess_at_rest(&self, x: &Vector<D>, t: f64) -> f64 {
        let Some(flow) = self.flow.as_ref().filter(|flow| flow.retains()) else {
            return 0.0;
        };
        (-flow.suction - self.still_pressure(x, t)).max(0.0)
    }

    /// Sets the initial pore pressure of the points from `first` on, which are placed at time `t`: hydrostatic at the
    /// level of that time, with limited suction.
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

    /// Returns the gradient of the hydrostatic pressure at `x` at time `t` (Pa/m).
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

    /// Returns the weight of water per volume at time `t` (Pa/m). With a water level it acts against the last axis, in
    /// equilibrium with the hydrostatic pressure; else along the gravity of the model, of which quasi-static analyses
    /// use the vertical part.
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

    /// Returns the density of water (kg/m3).
    pub fn density<K>(&self, model: &Model<K, D>) -> f64 {
        let whole = weighing(model).map_or(0.0, |gravity| gravity.acceleration.norm());
        self.unit_weight / if whole > 0.0 { whole } else { GRAVITY }
    }
}

/// Returns the gravity that acts on water. Pseudo-static inertia, the horizontal part of gravity in quasi-static
/// analyses, does not change pore pressures.
fn weighing<K, const D: usize>(model: &Model<K, D>) -> Option<Gravity<D>> {
    let is_static = model.regime == Regime::QuasiStatic;
    model
        .gravity
        .map(|gravity| if is_static { gravity.vertical() } else { gravity })
}
