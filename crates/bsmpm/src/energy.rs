//! Energy bookkeeping: what a step takes in, stores, dissipates and loses, each measured by itself, so that what is left
//! over tells whether the books are right.
//!
//! Over any number of steps, with T and E the kinetic and elastic energy of the points,
//!
//! `external = ΔT + ΔE + plastic + transfer + integration + smoothing + background + penalty + closure`.
//!
//! In a step from t (0) to t + dt (1) with the nodal displacement u, M the nodal mass, v_I and a_I the nodes' motion:
//!
//! - **external**: `Σ_p m_p (g0 + g1)/2 · Δu_p` of gravity, `Σ A (q0 + q1)/2 · Δx` of tractions and point loads, `Σ A (p0 + p1)/2 ·
//!   motion` of rigid strips, and `r1 · u` of supports of the grid that move. The mean force of a step: its work is exact for
//!   dead loads and of second order in dt else.
//! - **plastic**: `Σ_p V0 τ : (ε_trial - εᵉ)`, backward Euler like the return.
//! - **transfer** between points and nodes: `(T0 - ½ v_I0 · M v_I0) + (½ v_I1 · M v_I1 - T1)`, what PIC/FLIP loses on the way
//!   there and back; it can be negative, as the points' velocity grows by the accelerations that they keep for themselves,
//!   the nodes' by the mapped ones.
//! - **integration**: `(Σ_p V0 τ : (∇u dF⁻¹) - ΔE' - plastic) + (M ã · u - Δ(½ v_I · M v_I)) - ½ (f1 - f0) · u`: the work of the
//!   internal forces less what became of it, the work of the inertia less the nodes' kinetic energy, and the difference
//!   between the forces at the end, which are in balance, and the mean ones, by which external work is counted (gravity,
//!   loads, strips). ΔE' is the change of E before the smoothing, ã the acceleration that the mass resists with. With
//!   Newmark's 1/4, 1/2 `M (a0 + a1)/2 · u` is exactly the nodes' change: elastic and without remapping, this part is of
//!   second order in dt. Numerical damping, F-bar, backward Euler, and the difference between the forces at t on the new
//!   grid and the mapped `M a0` appear here; in quasi-static analysis also what a load that is applied at once does more
//!   than the body stores.
//! - **smoothing**: E before less E after bᵉ is changed once the step has converged.
//! - **background**: `u · B u`; the background forgets it after every step.
//! - **penalty**: `Σ A (p0 + p1)/2 · (motion - u)`, by which material slips from strips.
//!
//! **closure** is then the work of what is out of balance, `f_oob · u`, that of the iteration's tolerance, and round-off.
//! Supports that do not move, and strips at rest, do no work. In J (plane strain: per metre).

use crate::boundary::{Surface, load};
use crate::grid::transfer;
use crate::kinematics::Kinematics;
use crate::model::Model;
use crate::points::Points;
use crate::seam::Halo;
use crate::step::equilibrium::{Found, Scene};
use crate::step::nodes::Nodes;
use crate::tensor::{Square, Vector};
use std::ops::{AddAssign, Range};

/// Energy that went somewhere in a step, or in all steps so far, J; see the module.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Flows {
    /// work of gravity, loads and what moves
    pub external: f64,
    /// dissipated by plastic flow
    pub plastic: f64,
    /// lost between points and nodes
    pub transfer: f64,
    /// lost by integration in time and along the strain
    pub integration: f64,
    /// lost by the smoothing of the elastic strain
    pub smoothing: f64,
    /// lost to the soft background
    pub background: f64,
    /// lost between strips and material
    pub penalty: f64,
}

impl Flows {
    /// Loss of the algorithm, all its parts together.
    pub fn numerical(&self) -> f64 {
        self.transfer + self.integration + self.smoothing + self.background + self.penalty
    }

    fn each(&mut self) -> [&mut f64; 7] {
        let Self { external, plastic, transfer, integration, smoothing, background, penalty } = self;
        [external, plastic, transfer, integration, smoothing, background, penalty]
    }
}

impl AddAssign for Flows {
    fn add_assign(&mut self, mut other: Self) {
        self.each().into_iter().zip(other.each()).for_each(|(sum, step)| *sum += *step);
    }
}

/// Energy in the points, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stored {
    /// `Σ ½ m |v|²`
    pub kinetic: f64,
    /// `Σ V0 (½ λ tr(ε)² + μ ε : ε)`, ε = ½ ln bᵉ
    pub elastic: f64,
}

impl Stored {
    /// Of the points of all ranks.
    pub fn of<K: Kinematics<D>, const D: usize>(model: &Model<K, D>, points: &Points<D>, halo: &dyn Halo) -> Self {
        let mut sums = [kinetic(points), elastic(model, points)];
        halo.reduce(&mut sums);
        Self { kinetic: sums[0], elastic: sums[1] }
    }
}

/// The books of a run: all that must be kept to go on with them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Books {
    /// J  kinetic and elastic energy when they were opened
    pub start: f64,
    /// all flows since
    pub flows: Flows,
}

impl Books {
    /// Opened in a state.
    pub fn open(stored: Stored) -> Self {
        Self { start: stored.kinetic + stored.elastic, flows: Flows::default() }
    }

    /// What is left over in a state: `external - Δ(T + E) - plastic - numerical`.
    pub fn closure(&self, now: Stored) -> f64 {
        let spent = self.flows.plastic + self.flows.numerical();
        (self.flows.external - spent) - ((now.kinetic + now.elastic) - self.start)
    }
}

/// The flows of a step on this rank, before its state is saved into the points.
#[derive(Clone, Copy, Debug)]
pub struct Draft {
    flows: Flows,
    t: f64,
    dt: f64,
}

impl Draft {
    /// Everything but what the points are in the end. A point without response leaves no number: its step fails.
    pub fn of<K: Kinematics<D>, const D: usize>(scene: &Scene<'_, K, D>, found: &Found, (t, dt): (f64, f64)) -> Self {
        let Scene { model, shape, nodes, grips, points, halo } = *scene;
        let u = &found.u[..];
        let owned = halo.owned().start * D..halo.owned().end * D;
        let supports: f64 = owned.clone().map(|c| found.reaction[c] * u[c]).sum();
        let (gravity, gravity_grown) = gravity_work(scene, u, (t, dt));
        let strips = grips.work(u);
        let internal = internal_work(scene, found);
        let inertia = inertia_work::<D>(nodes, u, owned);
        let background = nodes.background.as_ref().map_or(0.0, |blocks| {
            let mut force = vec![0.0; u.len()];
            blocks.multiply::<D>(shape, u, &mut force);
            force.iter().zip(u).map(|(f, u)| f * u).sum()
        });
        let flows = Flows {
            external: gravity + strips.given + supports,
            plastic: internal.plastic,
            transfer: kinetic(points) + (inertia.after - inertia.before),
            integration: (internal.work - (internal.elastic - elastic(model, points)) - internal.plastic)
                + (inertia.work - (inertia.after - inertia.before))
                - (gravity_grown + strips.grown),
            smoothing: internal.elastic,
            background,
            penalty: strips.given - strips.taken,
        };
        Self { flows, t, dt }
    }

    /// The flows of the step on all ranks, whose state is now in the points; `surface` is that of the end of the step, the
    /// points still have that of its start.
    pub fn close<K: Kinematics<D>, const D: usize>(
        self,
        model: &Model<K, D>,
        points: &Points<D>,
        surface: &Surface<D>,
        halo: &dyn Halo,
    ) -> Flows {
        let Self { mut flows, t, dt } = self;
        flows.transfer -= kinetic(points);
        flows.smoothing -= elastic(model, points);
        let mut sums = flows.each().map(|flow| *flow);
        halo.reduce(&mut sums);
        flows.each().into_iter().zip(sums).for_each(|(flow, sum)| *flow = sum);
        // The loads' points are the same on every rank.
        let (loads, loads_grown) = load::work(&model.boundary.loads, (&points.surface, surface), (t, dt));
        flows.external += loads;
        flows.integration -= loads_grown;
        flows
    }
}

fn kinetic<const D: usize>(points: &Points<D>) -> f64 {
    let Some(motion) = &points.motion else { return 0.0 };
    motion.v.iter().zip(&points.mass).map(|(v, mass)| 0.5 * mass * v.norm_squared()).sum()
}

/// A state that is no strain has no energy: not a number, like the step that led to it.
fn elastic<K: Kinematics<D>, const D: usize>(model: &Model<K, D>, points: &Points<D>) -> f64 {
    (0..points.len()).map(|p| points.volume[p] * model.elastic_energy(points, p, &points.b_e[p])).sum()
}

/// Work of gravity by its mean, and half of what it has grown times u.
fn gravity_work<K: Kinematics<D>, const D: usize>(
    scene: &Scene<'_, K, D>,
    u: &[f64],
    (t, dt): (f64, f64),
) -> (f64, f64) {
    let Some(gravity) = &scene.model.gravity else { return (0.0, 0.0) };
    let mut moved = Vector::<D>::zeros(); // kg m
    transfer::to_points::<D, D>(scene.shape, u, |p, du| moved += Vector::from(du) * scene.points.mass[p]);
    let (before, after) = (gravity.at(t), gravity.at(t + dt));
    (0.5 * (before + after).dot(&moved), 0.5 * (after - before).dot(&moved))
}

/// Work of the points' stress, and what became of it before any smoothing.
struct Internal {
    work: f64,
    plastic: f64,
    elastic: f64,
}

fn internal_work<K: Kinematics<D>, const D: usize>(scene: &Scene<'_, K, D>, found: &Found) -> Internal {
    let Scene { model, shape, points, .. } = *scene;
    let mut sums = Internal { work: 0.0, plastic: 0.0, elastic: 0.0 };
    transfer::gradients(shape, &found.u, |p, grad: Square<D>| {
        let volume = points.volume[p];
        let Ok(response) = found.trial.respond(model, points, p) else {
            sums.work = f64::NAN;
            return;
        };
        sums.work += volume * K::flux(&response.tau(), &found.trial.dF[p]).dot(&grad);
        sums.plastic += volume * response.dissipation();
        sums.elastic += volume * model.elastic_energy(points, p, &response.b_e());
    });
    sums
}

/// Work of the inertia, and the kinetic energy of this rank's own nodes at both ends of the step.
#[derive(Default)]
struct Inertial {
    work: f64,
    before: f64,
    after: f64,
}

fn inertia_work<const D: usize>(nodes: &Nodes<D>, u: &[f64], owned: Range<usize>) -> Inertial {
    let mut sums = Inertial::default();
    let Some(inertia) = &nodes.inertia else { return sums };
    for component in owned {
        let (mass, u) = (nodes.weight[component / D], u[component]);
        sums.work += mass * inertia.acting(component, u) * u;
        sums.before += 0.5 * mass * inertia.v[component].powi(2);
        sums.after += 0.5 * mass * inertia.velocity(component, u).powi(2);
    }
    sums
}
