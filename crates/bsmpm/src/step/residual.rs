//! Internal force, theory-manual equation (T5.1), inertia (T5.3) and out-of-balance force (T5.2), evaluated in each
//! iteration.

use crate::exact::Exact;
use crate::field::{Field, FieldBalance, SecondBalance};
use crate::grid::{Contributions, transfer};
use crate::interactions::{Interaction, NodalForces};
use crate::kinematics::{Gradient, GradientOf, Kinematics};
use crate::lanes::{self, Eight, InLanes, LANES, Lanes, Simd};
use crate::model::Model;
use crate::nodal::Nodal;
use crate::parallel::over_layers;
use crate::points::Points;
use crate::step::adjoint::Pressures;
use crate::step::nodes::GridState;
use crate::step::problem::Problem;
use crate::step::trial::DeformationIncrement;
use crate::tensor::Tensor;
use std::borrow::Cow;
use std::ops::Range;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::atomic::{AtomicU64, AtomicUsize};

/// Forces of the material points under a nodal displacement, balanced at the nodes.
#[derive(Clone, Debug)]
pub struct Residual<K: Kinematics<D>, const D: usize> {
    /// Deformation increment from which the forces follow.
    pub trial: DeformationIncrement<K, D>,
    /// Balance of forces at the nodes.
    pub balance: Balance,
    /// First point of this rank that inverted or is not finite.
    pub first_inverted: Option<usize>,
}

/// Step (5b): out-of-balance force at the nodes, with the norms for the convergence criteria.
#[derive(Clone, Debug)]
pub struct Balance {
    /// Out-of-balance force (N): f_ext + elastic supports + dashpots + friction - f_int - M a, with a from
    /// `Inertia::acting`; zero at components that are not free.
    pub f_oob: Vec<f64>,
    /// Force of the supports on the body (N); zero at components without a prescribed motion, friction or a dashpot.
    pub reaction: Vec<f64>,
    /// Norm |f_oob| (N).
    pub norm: f64,
    /// Reference force max(|f_ext|, |f_int|, |M a|, |reaction, elastic supports|) (N).
    pub scale: f64,
    /// `norm` and `scale` over the nodes that only one material touches (N), per material; empty in a case with one
    /// material.
    pub apart: Vec<[f64; 2]>,
    /// Sum of the magnitudes of the works f_int u over all nodes and components (J); 0 if no interaction needs it, see
    /// [`Interaction::needs_internal_work`].
    pub work: f64,
    /// Points inverted or not finite, over all ranks.
    pub inverted: u64,
    /// Balance of the second field, if there is one.
    pub field: Option<SecondBalance>,
    /// Whether no norm overflowed.
    finite: bool,
}

impl<K: Kinematics<D>, const D: usize> Residual<K, D> {
    /// Evaluates the forces under `x`: displacements (m), followed by the values of a second field, if there is
    /// one; missing values are zero. One exchange with the neighbours, one more each for F-bar, its adjoint, elastic
    /// supports and a second field, and one reduction (two with a second field).
    pub fn of(problem: &Problem<'_, K, D>, x: &[f64]) -> Self {
        let Problem {
            model,
            shape,
            nodes,
            points,
            halo,
            ..
        } = *problem;
        let (u, values) = x.split_at(nodes.constraints.free.len());
        let mut extended = Cow::Borrowed(u);
        if let Some(extension) = &nodes.constraints.extension {
            extension.extend(&model.grid, extended.to_mut(), halo);
        }
        let u = &extended[..];
        let mut trial = DeformationIncrement::of(model, shape, nodes, points, u, halo);
        let field = nodes.field.as_ref().map(|field| match values {
            [] => field.balance(problem, &mut trial, &vec![0.0; Field::<K, D>::unknowns(field).len()]),
            values => field.balance(problem, &mut trial, values),
        });
        let InternalForce {
            mut f_int,
            inverted,
            first_inverted,
        } = InternalForce::of(problem, &trial);
        let context = problem.context();
        for interaction in nodes.interactions.iter() {
            interaction.add_internal_force(&context, u, &mut f_int);
        }
        let balance = Balance {
            field,
            ..Balance::of(problem, u, &|p| trial.dF(p), halo.assemble_ghosts(&f_int), inverted)
        };
        Self {
            trial,
            balance,
            first_inverted,
        }
    }
}

/// Step (5a): nodal forces of the stresses of this rank's points.
pub struct InternalForce {
    /// Internal forces (N).
    pub f_int: Contributions,
    /// Points that inverted or are not finite.
    pub inverted: u64,
    /// First of these points.
    pub first_inverted: Option<usize>,
}

impl InternalForce {
    /// Integrates the stresses of a trial deformation. One exchange with the neighbours if a point has the adjoint
    /// force.
    pub fn of<K: Kinematics<D>, const D: usize>(
        problem: &Problem<'_, K, D>,
        trial: &DeformationIncrement<K, D>,
    ) -> Self {
        let Problem {
            model, shape, points, ..
        } = *problem;
        let inverted = &AtomicU64::new(0);
        let first_inverted = &AtomicUsize::new(usize::MAX);
        let pressures = &Pressures::of(problem, trial);
        let volume = problem.volume();
        let f_int = transfer::divergence_of::<K, D>(shape, &points.x, |range, fluxes| {
            lanes::run(Fluxes {
                model,
                points,
                trial,
                pressures,
                volume,
                inverted,
                first_inverted,
                range,
                fluxes,
            });
        });
        Self {
            f_int,
            inverted: inverted.load(Relaxed),
            first_inverted: Some(first_inverted.load(Relaxed)).filter(|&p| p < points.len()),
        }
    }
}

/// Computes the fluxes of consecutive points, eight at a time; one by one if the eight cannot be computed together.
struct Fluxes<'a, K: Kinematics<D>, const D: usize> {
    model: &'a Model<K, D>,
    points: &'a Points<D>,
    trial: &'a DeformationIncrement<K, D>,
    pressures: &'a Pressures,
    volume: &'a [f64],
    inverted: &'a AtomicU64,
    first_inverted: &'a AtomicUsize,
    range: Range<usize>,
    fluxes: &'a mut Vec<K::Gradient>,
}

impl<K: Kinematics<D>, const D: usize> InLanes for Fluxes<'_, K, D> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        for eight in lanes::eights(self.range.clone()) {
            let Some(flux) = self.of(simd, eight) else {
                for p in eight.points() {
                    let flux = self.of_point(p);
                    self.fluxes.push(flux);
                }
                continue;
            };
            let mut each = [K::Gradient::zeros(); LANES];
            for j in 0..K::Gradient::SLOPES {
                for i in 0..D {
                    let numbers = flux[(i, j)].numbers();
                    (0..LANES).for_each(|lane| each[lane][(i, j)] = numbers[lane]);
                }
            }
            self.fluxes.extend_from_slice(&each[..eight.points().len()]);
        }
    }
}

impl<K: Kinematics<D>, const D: usize> Fluxes<'_, K, D> {
    #[inline(always)]
    fn of<S: Simd>(&self, simd: S, eight: Eight) -> Option<GradientOf<K, Lanes<S>, D>> {
        if eight.points().any(|p| self.pressures.at(p).is_some()) {
            return None;
        }
        let (dF, tau) = self.trial.respond_in_lanes(self.model, self.points, simd, eight)?;
        let flux = K::flux(&tau, &dF);
        let volume = eight.of(self.volume);
        let volume = Lanes::from_fn(simd, |lane| *volume[lane]);
        Some(K::Gradient::of(|i, j| flux[(i, j)] * volume))
    }

    /// Computes the flux of one point (N m). An inverted point has zero flux and is counted. Not inlined, so that it is
    /// compiled once and not for each instruction set.
    #[inline(never)]
    fn of_point(&self, p: usize) -> K::Gradient {
        let Self {
            model, points, trial, ..
        } = *self;
        let Ok(response) = trial.respond(model, points, p) else {
            self.inverted.fetch_add(1, Relaxed);
            self.first_inverted.fetch_min(p, Relaxed);
            return K::Gradient::zeros();
        };
        let tau = self.pressures.acting::<K, D>(p, self.volume[p], response.tau());
        let tau = trial.pressed(p, trial.damped(model, points, p, &response, tau));
        K::flux(&tau, &trial.dF(p)) * self.volume[p]
    }
}

impl Balance {
    /// Balances an internal force that is summed over the ranks, with `inverted` points on this rank. `u` is the
    /// displacement including tied components (m); it deforms the points by `dF`.
    pub fn of<K: Kinematics<D>, const D: usize>(
        problem: &Problem<'_, K, D>,
        u: &[f64],
        dF: &dyn Fn(usize) -> Tensor,
        mut f_int: Vec<f64>,
        inverted: u64,
    ) -> Self {
        let GridState {
            constraints,
            interactions,
            ..
        } = problem.nodes;
        let context = &problem.context();
        let mut f_ext = Cow::Borrowed(&problem.nodes.f_ext[..]);
        interactions.add_external_forces(context, u, dF, &mut f_ext);
        let mut f_penalty = interactions.penalty_force(context, u);
        match f_penalty.is_empty() {
            true => constraints.reduce(&mut [&mut f_int], problem.halo),
            false => constraints.reduce(&mut [&mut f_int, &mut f_penalty], problem.halo),
        }
        let forces = Forces::of(problem, u, &f_ext, &f_int, &f_penalty);
        let soft = interactions.iter().any(Interaction::needs_internal_work);
        let supporting = |c: usize| forces.reaction[c].powi(2) + f_penalty.get(c).copied().unwrap_or(0.0).powi(2);
        let whole = [
            std::iter::once(inverted as f64).collect(),
            over_layers(problem.halo, D, |c| forces.f_oob[c].powi(2)),
            over_active(problem, |c| f_ext[c].powi(2)),
            over_active(problem, |c| f_int[c].powi(2)),
            over_layers(problem.halo, D, |c| forces.inertial_at(c).powi(2)),
            over_active(problem, supporting),
            over_active(problem, |c| if soft { (f_int[c] * u[c]).abs() } else { 0.0 }),
        ];
        let kinds = whole.len() - 2;
        // Per material: out-of-balance, external, internal, inertial forces, and those of rigid and elastic supports.
        let apart = constraints.apart.as_ref().map_or_else(Vec::new, |apart| {
            apart.sums(problem.halo, D, |c| {
                let forces = [forces.f_oob[c], f_ext[c], f_int[c], forces.inertial_at(c)];
                let [out, external, internal, inertial] = forces.map(|force| force.powi(2));
                [out, external, internal, inertial, supporting(c)]
            })
        });
        let sums = problem.halo.reproducible_sum(&[&whole[..], &apart].concat());
        let (sums, apart) = sums.split_at(whole.len());
        let [norm, scale] = norms(&sums[1..=kinds]);
        // If only stress acts on the nodes of a single material, its internal force equals the out-of-balance force and
        // cannot serve as a reference.
        let apart = apart.chunks_exact(kinds).map(|sums| {
            let acts = [sums[1], sums[3], sums[4]].into_iter().any(|sum| sum > 0.0);
            if acts { norms(sums) } else { [0.0; 2] }
        });
        Self {
            f_oob: forces.f_oob,
            reaction: forces.reaction,
            norm,
            scale,
            apart: apart.collect(),
            work: sums[kinds + 1],
            inverted: sums[0] as u64,
            field: None,
            finite: sums.iter().all(|sum| sum.is_finite()),
        }
    }

    /// Returns |f_oob| / largest force over all nodes (-); zero if no force acts.
    pub fn measure(&self) -> f64 {
        if self.norm == 0.0 { 0.0 } else { self.norm / self.scale }
    }

    /// Returns whether, on all ranks, no point inverted, every point has an admissible state of a
    /// second field, and no number overflowed.
    pub fn is_sound(&self) -> bool {
        let is_field_sound = self.field.as_ref().is_none_or(FieldBalance::is_sound);
        self.inverted == 0 && self.finite && is_field_sound
    }
}

/// Returns the norm of the out-of-balance force and the largest norm of the other forces, from the sums of their
/// squares.
fn norms(sums: &[f64]) -> [f64; 2] {
    [sums[0], sums[1..].iter().copied().fold(0.0, f64::max)].map(f64::sqrt)
}

/// Sums over the components of this rank's own active nodes.
fn over_active<K, const D: usize>(problem: &Problem<'_, K, D>, term: impl Fn(usize) -> f64) -> Exact {
    over_layers(problem.halo, D, |c| {
        if problem.nodes.constraints.active[Nodal::<D>::node(c)] {
            term(c)
        } else {
            0.0
        }
    })
}

/// Forces of step (5b) at the nodes of the window (N).
struct Forces {
    f_oob: Vec<f64>,
    reaction: Vec<f64>,
    inertial: Vec<f64>, // empty without inertia
}

impl Forces {
    fn of<K: Kinematics<D>, const D: usize>(
        problem: &Problem<'_, K, D>,
        u: &[f64],
        f_ext: &[f64],
        f_int: &[f64],
        f_penalty: &[f64],
    ) -> Self {
        let nodes = problem.nodes;
        let constraints = &nodes.constraints;
        let mut forces = Self {
            f_oob: vec![0.0; u.len()],
            reaction: vec![0.0; u.len()],
            inertial: Vec::new(),
        };
        if let Some(inertia) = &nodes.inertia {
            let mut acting = vec![0.0; u.len()];
            for c in (0..u.len()).filter(|&c| constraints.active[Nodal::<D>::node(c)]) {
                acting[c] = inertia.acting(c, u[c]);
            }
            forces.inertial = problem.mass().times(&acting);
        }
        for component in (0..u.len()).filter(|&component| constraints.active[Nodal::<D>::node(component)]) {
            let inertial = forces.inertial_at(component);
            let held = f_penalty.get(component).copied().unwrap_or(0.0);
            let balance = f_ext[component] + held - f_int[component] - inertial;
            if constraints.free[component] {
                forces.f_oob[component] = balance;
            } else if constraints.prescribed[component].is_some() {
                forces.reaction[component] = -balance;
            }
        }
        let context = problem.context();
        for interaction in nodes.interactions.iter() {
            let Self { f_oob, reaction, .. } = &mut forces;
            interaction.add_reaction(&context, u, NodalForces { f_oob, reaction });
        }
        forces
    }

    /// Returns the inertial force at a component (N); 0 without inertia.
    fn inertial_at(&self, component: usize) -> f64 {
        self.inertial.get(component).copied().unwrap_or(0.0)
    }
}
