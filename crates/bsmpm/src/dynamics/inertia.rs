//! Nodal velocity and acceleration at the start of a step, theory-manual equation (T2.4), and their integration (T5.3)
//! to (T5.5).

use crate::dynamics::mass::{Mass, MassMatrix};
use crate::dynamics::newmark::Newmark;
use crate::grid::transfer;
use crate::points::Points;
use crate::tensor::Vector;

/// Nodal velocity and acceleration at the start of the step, and their time integration.
#[derive(Clone, Debug)]
pub struct Inertia {
    /// Velocity (m/s), D numbers per node.
    pub v: Vec<f64>,
    /// Acceleration (m/s2), D numbers per node.
    pub a: Vec<f64>,
    /// Per component: work of a prescribed motion on material that arrives with another velocity (J), the velocity
    /// times the jump of momentum; empty without prescribed motion.
    pub struck: Vec<f64>,
    /// Change of nodal velocity by supports as the step begins (m/s), D numbers per node, for a consistent mass. The
    /// points share this change, so that material next to a support moves with its own velocity. Empty with the lumped
    /// mass: nodes of a support average over the points above them, whose velocity would be removed in every step.
    pub blow: Vec<f64>,
    /// Components that a face with contact may stop in this step. They are integrated by backward Euler, because
    /// Newmark's method would make stopped material rebound. Empty if there are none.
    pub moving: Vec<bool>,
    /// Those of the `moving` components that the face stops.
    pub stopped: Vec<bool>,
    /// Step size (s).
    pub dt: f64,
    /// Time integration.
    pub newmark: Newmark,
}

impl Inertia {
    /// Returns the factor of the mass in the tangent of the out-of-balance force (1/s2); 4/dt^2 without numerical
    /// damping.
    pub fn factor(&self) -> f64 {
        self.newmark.factor(self.dt)
    }

    /// Returns the acceleration of a component at the end (m/s2; steps 5b, 10a); 4/dt^2 u - 4/dt v - a without
    /// numerical damping.
    #[inline]
    pub fn acceleration(&self, component: usize, u: f64) -> f64 {
        if self.is_moving(component) {
            return if self.stopped[component] {
                0.0
            } else {
                self.gained_by(component, u) / self.dt
            };
        }
        self.newmark
            .acceleration(self.dt, u, self.v[component], self.a[component])
    }

    /// Returns the acceleration that enters the balance of forces (m/s2): times the mass it is the inertia of a
    /// component.
    #[inline]
    pub fn acting(&self, component: usize, u: f64) -> f64 {
        if self.is_moving(component) {
            return self.gained_by(component, u) / self.dt;
        }
        self.newmark.acting(self.a[component], self.acceleration(component, u))
    }

    /// Returns the velocity of a component at the end (m/s; step 10b).
    #[inline]
    pub fn velocity(&self, component: usize, u: f64) -> f64 {
        if self.is_moving(component) {
            return u / self.dt;
        }
        self.v[component]
            + self
                .newmark
                .gained(self.dt, self.a[component], self.acceleration(component, u))
    }

    /// Returns the factor of a component's mass in the tangent (1/s2).
    pub fn factor_of(&self, component: usize) -> f64 {
        if self.is_moving(component) {
            1.0 / (self.dt * self.dt)
        } else {
            self.factor()
        }
    }

    /// Returns the derivative of a component's velocity at the end with respect to its displacement (1/s).
    pub fn velocity_factor(&self, component: usize) -> f64 {
        if self.is_moving(component) {
            1.0 / self.dt
        } else {
            self.newmark.velocity_factor(self.dt)
        }
    }

    /// Returns the change of velocity of a component that a face stops (m/s), for lumped mass. The points gain their
    /// part of it at once.
    pub fn blow_of(&self, component: usize, u: f64) -> f64 {
        if self.stopped.get(component) == Some(&true) {
            self.gained_by(component, u)
        } else {
            0.0
        }
    }

    #[inline]
    fn is_moving(&self, component: usize) -> bool {
        self.moving.get(component) == Some(&true)
    }

    /// Returns the change of velocity by backward Euler (m/s).
    fn gained_by(&self, component: usize, u: f64) -> f64 {
        u / self.dt - self.v[component]
    }
}

/// Transfers v_I and a_I (steps 2b, 2c). A node with prescribed motion starts with its prescribed velocity; otherwise
/// Newmark's method would turn the points' velocity near a wall into an acceleration of the wall.
pub(crate) fn map<const D: usize>(
    mass: &Mass<'_, D>,
    points: &Points<D>,
    prescribed: &[Option<f64>],
    dt: f64,
    newmark: Newmark,
) -> Inertia {
    let zeros = vec![0.0; prescribed.len()];
    let nowhere = vec![None; prescribed.len()];
    let still = prescribed.iter().map(|v| v.map(|_| 0.0)).collect::<Vec<_>>();
    let mut inertia = Inertia {
        v: zeros.clone(),
        a: zeros,
        struck: Vec::new(),
        blow: Vec::new(),
        moving: Vec::new(),
        stopped: Vec::new(),
        dt,
        newmark,
    };
    let Some(motion) = &points.motion else { return inertia };
    let arriving = momentum(mass, points, &motion.v);
    inertia.a = mass.solve(momentum(mass, points, &motion.a), &still);
    inertia.v = mass.solve(arriving.clone(), prescribed);
    // On any rank: solutions are collective, and all nodes of one rank may be free.
    let flags = [
        prescribed.iter().flatten().any(|&velocity| velocity != 0.0),
        prescribed.iter().any(Option::is_some),
    ];
    let mut flags = flags.map(|flag| f64::from(u8::from(flag)));
    mass.halo.all_reduce_max(&mut flags);
    let [moves, holds] = flags.map(|flag| flag > 0.0);
    let consistent = mass.matrix == MassMatrix::Consistent;
    if moves || consistent && holds {
        let free = mass.solve(arriving, &nowhere);
        let jump: Vec<f64> = inertia.v.iter().zip(&free).map(|(held, free)| held - free).collect();
        if moves {
            let given = mass.times(&jump);
            inertia.struck = prescribed
                .iter()
                .zip(given)
                .map(|(v, given)| v.map_or(0.0, |v| v * given))
                .collect();
        }
        if consistent {
            inertia.blow = jump;
        }
    }
    inertia
}

/// Returns the nodal sums of m_p times a `field` of the points, D numbers per node.
fn momentum<const D: usize>(mass: &Mass<'_, D>, points: &Points<D>, field: &[Vector<D>]) -> Vec<f64> {
    mass.halo.assemble_ghosts(&transfer::to_nodes::<D, D>(mass.shape, |p| {
        (field[p] * points.mass[p]).into()
    }))
}
