//! The nodes' motion at the start of a step (2b, 2c), and how it goes on in it (10a, 10b).

use crate::grid::{Shape, transfer};
use crate::points::Points;
use crate::seam::Halo;
use crate::step::newmark::Newmark;
use crate::step::nodes::divide;

/// Nodal velocity and acceleration at the start of the step, and how they go on.
#[derive(Clone, Debug)]
pub struct Inertia {
    /// m/s, D numbers a node
    pub v: Vec<f64>,
    /// m/s2, D numbers a node
    pub a: Vec<f64>,
    /// m2/s2  per component and mass, what a motion that is prescribed works on material that comes with another velocity:
    /// the velocity times its jump; empty where nothing moves
    pub struck: Vec<f64>,
    /// s  length of the step
    pub dt: f64,
    /// time integration
    pub newmark: Newmark,
}

impl Inertia {
    /// 1/s2  factor of the mass in the tangent of the out-of-balance force; 4/dt^2 without numerical damping.
    pub fn factor(&self) -> f64 {
        self.newmark.factor(self.dt)
    }

    /// m/s2  acceleration of a component at the end (steps 5b, 10a); 4/dt^2 u - 4/dt v - a without numerical damping.
    #[inline]
    pub fn acceleration(&self, component: usize, u: f64) -> f64 {
        self.newmark.acceleration(self.dt, u, (self.v[component], self.a[component]))
    }

    /// m/s2  what the mass of a component resists with: times the mass, its inertia in the balance of forces.
    #[inline]
    pub fn acting(&self, component: usize, u: f64) -> f64 {
        self.newmark.acting(self.a[component], self.acceleration(component, u))
    }

    /// m/s  velocity of a component at the end (step 10b).
    #[inline]
    pub fn velocity(&self, component: usize, u: f64) -> f64 {
        self.v[component] + self.newmark.gained(self.dt, self.a[component], self.acceleration(component, u))
    }
}

/// v_I and a_I (steps 2b, 2c). Where a motion is prescribed, the node already has it: else Newmark's formula would turn
/// the points' velocity near a wall into an acceleration of the wall.
pub(super) fn map<const D: usize>(
    shape: &Shape<D>,
    points: &Points<D>,
    (mass, threshold): (&[f64], f64),
    prescribed: &[Option<f64>],
    (dt, newmark): (f64, Newmark),
    halo: &dyn Halo,
) -> Inertia {
    let mut inertia =
        Inertia { v: vec![0.0; mass.len() * D], a: vec![0.0; mass.len() * D], struck: Vec::new(), dt, newmark };
    if let Some(motion) = &points.motion {
        for (field, nodal) in [(&motion.v, &mut inertia.v), (&motion.a, &mut inertia.a)] {
            *nodal = halo.sum(&transfer::to_nodes::<D, D>(shape, |p| (field[p] * points.mass[p]).into()));
            divide(nodal, mass, threshold);
        }
    }
    if prescribed.iter().flatten().any(|&velocity| velocity != 0.0) {
        let jump = |(prescribed, v): (&Option<f64>, &f64)| prescribed.map_or(0.0, |velocity| velocity * (velocity - v));
        inertia.struck = prescribed.iter().zip(&inertia.v).map(jump).collect();
    }
    for (component, velocity) in prescribed.iter().enumerate() {
        if let Some(velocity) = velocity {
            inertia.v[component] = *velocity;
            inertia.a[component] = 0.0;
        }
    }
    inertia
}
