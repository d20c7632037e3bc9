//! Nodal velocity and acceleration at the start of a step, theory-manual equation (T2.4), and their integration (T5.3)
//! to (T5.5).

use crate::grid::transfer;
use crate::points::Points;
use crate::step::mass::{Mass, MassMatrix};
use crate::step::newmark::Newmark;
use crate::tensor::Vector;

/// Nodal velocity and acceleration at the start of the step, and how they go on.
#[derive(Clone, Debug)]
pub struct Inertia {
    /// m/s, D numbers a node
    pub v: Vec<f64>,
    /// m/s2, D numbers a node
    pub a: Vec<f64>,
    /// J  per component, what a motion that is prescribed works on material that comes with another velocity: the
    /// velocity times the jump of the momentum; empty where nothing moves
    pub struck: Vec<f64>,
    /// m/s  by which supports change the velocity of the nodes as the step begins, D numbers a node, of a consistent
    /// mass; the points share in it, so that what lies beside a support moves as its velocity says. Empty where nothing
    /// does: with the lumped mass the nodes of a support see the velocity of the points above them, and would take it
    /// away in every step.
    pub blow: Vec<f64>,
    /// components that a face with contact may stop in this step, which go by backward Euler, as Newmark's formula
    /// would throw back what is stopped; empty where there is none
    pub moving: Vec<bool>,
    /// those of them that it holds
    pub stopped: Vec<bool>,
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

    /// m/s2  what the mass of a component resists with: times the mass, its inertia in the balance of forces.
    #[inline]
    pub fn acting(&self, component: usize, u: f64) -> f64 {
        if self.is_moving(component) {
            return self.gained_by(component, u) / self.dt;
        }
        self.newmark.acting(self.a[component], self.acceleration(component, u))
    }

    /// m/s  velocity of a component at the end (step 10b).
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

    /// 1/s2  the factor of a component's mass.
    pub fn factor_of(&self, component: usize) -> f64 {
        if self.is_moving(component) {
            1.0 / (self.dt * self.dt)
        } else {
            self.factor()
        }
    }

    /// 1/s  how a component's velocity at the end changes with its displacement.
    pub fn velocity_factor(&self, component: usize) -> f64 {
        if self.is_moving(component) {
            1.0 / self.dt
        } else {
            self.newmark.velocity_factor(self.dt)
        }
    }

    /// m/s  what a component gains as a face stops it, of lumped mass: the points gain their part of it at once.
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

    /// m/s  what a component gains that goes by backward Euler.
    fn gained_by(&self, component: usize, u: f64) -> f64 {
        u / self.dt - self.v[component]
    }
}

/// v_I and a_I (steps 2b, 2c). Where a motion is prescribed, the node already has it: else Newmark's formula would turn
/// the points' velocity near a wall into an acceleration of the wall.
pub(super) fn map<const D: usize>(
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
    // On any rank: solutions are collective, and the nodes of one rank may all be free.
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

/// Nodal sums of m_p times a `field` of the points, D numbers a node.
fn momentum<const D: usize>(mass: &Mass<'_, D>, points: &Points<D>, field: &[Vector<D>]) -> Vec<f64> {
    mass.halo.assemble_ghosts(&transfer::to_nodes::<D, D>(mass.shape, |p| {
        (field[p] * points.mass[p]).into()
    }))
}
