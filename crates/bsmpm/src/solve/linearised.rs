//! Complete derivative of the out-of-balance force for Newton's method, theory-manual equation (T5.14): exact as a
//! matrix-vector product, partly approximated as an assembled matrix.

use crate::error::SolveError;
use crate::grid::transfer;
use crate::kinematics::{Gradient, Kinematics, Moduli, Slope};
use crate::material::Tangent;
use crate::parallel::{LinearSolver, Symmetry};
use crate::step::adjoint::{Adjoint, Pressures, transposed, works};
use crate::step::blocks::{MOST, Pairs, add_mass, add_point, complete};
use crate::step::coupling::{Coupling, Dilations, Raised, Share};
use crate::step::problem::Problem;
use crate::step::reduced_system::ReducedSystem;
use crate::step::residual::Residual;
use crate::step::trial::Trial;
use crate::tensor::{Tensor, Vector};
use crate::water::linearised::LinearisedWater;
use std::borrow::Cow;

/// The derivative at one displacement.
pub struct Linearised<'a, K: Kinematics<D>, const D: usize> {
    problem: &'a Problem<'a, K, D>,
    trial: &'a Trial<K, D>,
    reaction: &'a [f64], // N
    /// N m  V0 d(tau dF^-T)/d(grad v), one unit gradient after the other
    moduli: Vec<Moduli<K, D>>,
    /// under F-bar
    dilation: Option<Vec<Dilation<K::Gradient>>>,
    /// under consistent F-bar in dilatant material; of all points
    adjoint: Option<(Adjoint, Vec<Pressure<K::Gradient>>)>,
    /// where water flows
    water: Option<LinearisedWater<'a, D>>,
}

/// What the adjoint force adds at a point: its pressure is that of an average.
struct Pressure<G> {
    /// J  d(V0 tau : I / dof) per gradient, and per unit of d ln(dJ-bar/dJ)
    raised: (G, f64),
    /// J  V0 tau : I / dof of the point itself
    own: f64,
}

/// What F-bar adds at a point.
struct Dilation<G> {
    /// -  tr l per gradient: dF^-T
    trace: G,
    /// N m  V0 d(tau dF^-T) per unit of d ln(dJ-bar/dJ)
    flux: G,
}

impl<G> Pressure<G> {
    /// Of a point with a tangent, dF^-1 and tau.
    fn of<K: Kinematics<D, Gradient = G>, const D: usize>(
        (tangent, inverse): (&Tangent, &Tensor),
        tau: &Tensor,
        volume: f64,
    ) -> Self
    where
        G: Gradient<D, Of<f64> = G>,
    {
        let by_gradient = G::from_fn(|k, l| {
            let unit = G::unit(k, l);
            volume * works::<K, D>(&tangent.apply(&(K::gradient::<f64>(&unit) * inverse)))
        });
        let by_rate = volume * works::<K, D>(&tangent.apply(&K::dilation()));
        Self {
            raised: (by_gradient, by_rate),
            own: volume * works::<K, D>(tau),
        }
    }
}

impl<'a, K: Kinematics<D>, const D: usize> Linearised<'a, K, D> {
    /// The derivative where `residual` was evaluated; no point of it may have inverted.
    pub fn at(problem: &'a Problem<'a, K, D>, residual: &'a Residual<K, D>) -> Self {
        let (trial, points) = (&residual.trial, problem.points);
        let averaged = trial.is_averaged();
        let mut moduli = Vec::with_capacity(points.len());
        let mut dilation = averaged.then(|| Vec::with_capacity(points.len()));
        let pressures = Pressures::of(problem, trial);
        let mut adjoint = Adjoint::of(problem.model).map(|adjoint| (adjoint, Vec::with_capacity(points.len())));
        for (p, &volume) in problem.volume().iter().enumerate() {
            let dF = trial.dF(p);
            let inverse = dF.try_inverse();
            let (Ok(response), Some(inverse)) = (trial.respond(problem.model, points, p), inverse) else {
                moduli.push(K::Gradient::moduli(|_, _| K::Gradient::zeros())); // cannot be: the residual has refused such a point
                continue;
            };
            let (tau, tangent) = (response.tau().full(), response.tangent());
            let unit = |k: usize, l: usize| {
                let l = K::gradient::<f64>(&K::Gradient::unit(k, l)) * inverse;
                let mut change = tangent.apply(&l) - tau * l.transpose();
                if let Some(pressure) = pressures.at(p) {
                    let (pressure, own) = (pressure / volume, works::<K, D>(&tau));
                    change -= l.transpose() * (pressure - own);
                    change += Tensor::identity() * (pressure * l.trace() - works::<K, D>(&tangent.apply(&l)));
                }
                if let Some(pore) = trial.pore_at(p) {
                    change += (l.transpose() - Tensor::identity() * l.trace()) * pore;
                }
                K::working(&(change * inverse.transpose())) * volume
            };
            let viscous = trial.viscous(problem.model, points, p, &response);
            let viscous = viscous.map(|viscous| (viscous.tau.full(), viscous.tangent(response.change_of_returned())));
            moduli.push(K::Gradient::moduli(|k, l| match &viscous {
                Some((tau, change)) => unit(k, l) + viscous_flux::<K, D>((tau, change), &inverse, (k, l)) * volume,
                None => unit(k, l),
            }));
            if let Some(dilation) = &mut dilation {
                let mut change = tangent.apply(&K::dilation());
                if let Some((_, at)) = &mut adjoint {
                    at.push(Pressure::of::<K, D>((&tangent, &inverse), &tau, volume));
                }
                if pressures.at(p).is_some() {
                    change -= Tensor::identity() * works::<K, D>(&change);
                }
                if let Some((_, viscous)) = &viscous {
                    change += viscous(&K::dilation());
                }
                let change = change * inverse.transpose();
                let flux = K::working(&change) * volume;
                dilation.push(Dilation {
                    trace: K::working(&inverse.transpose()),
                    flux,
                });
            }
        }
        Self {
            problem,
            trial,
            reaction: &residual.balance.reaction,
            moduli,
            dilation,
            adjoint,
            water: None,
        }
    }

    /// The same with the water that flows, where `x` has the nodal excess pressures behind the displacements, Pa.
    pub fn with_water(mut self, x: &'a [f64]) -> Self {
        let Problem { nodes, .. } = *self.problem;
        let p = &x[nodes.free.len()..];
        let of = |pores: &'a _| LinearisedWater::at((self.problem, pores), self.trial, p);
        self.water = nodes.pores.as_ref().map(of);
        self
    }

    /// K v on nodal arrays, `v` zero where it is not free: one exchange with the neighbours, one more under F-bar and
    /// one with water.
    pub fn multiply(&self, v: &[f64], out: &mut [f64]) {
        let Problem {
            shape,
            nodes,
            points,
            halo,
            ..
        } = *self.problem;
        let ((v, v_p), (out, out_p)) = (v.split_at(nodes.free.len()), out.split_at_mut(nodes.free.len()));
        let mut extended = Cow::Borrowed(v);
        if let Some(extension) = &nodes.extension {
            extension.extend(&self.problem.model.grid, extended.to_mut(), halo);
        }
        let v = &extended[..];
        let grad = transfer::gradients::<K, D, _>((shape, &points.x), v, |_, grad| grad);
        let rate = self.dilation.as_ref().and_then(|dilation| {
            let trace: Vec<f64> = dilation
                .iter()
                .zip(&grad)
                .map(|(at, grad)| at.trace.dot(grad))
                .collect();
            Some((dilation, self.trial.dilation_rate(self.problem, &trace)?))
        });
        let moduli = &self.moduli;
        let pressed = rate.as_ref().and_then(|(dilation, rate)| {
            let (adjoint, at) = self.adjoint.as_ref()?;
            let raised = |p: usize| {
                let Pressure {
                    raised: (by_gradient, by_rate),
                    own,
                } = &at[p];
                let (_, mean) = self.trial.means(self.problem.model, self.problem.points, p);
                let grown = own * (rate[p] + dilation[p].trace.dot(&grad[p]));
                (by_gradient.dot(&grad[p]) + by_rate * rate[p] - grown) / mean
            };
            Some((dilation, transposed(self.problem, adjoint, self.trial, raised)))
        });
        let water = self.water.as_ref().map(|water| (water, water.pressures(v_p)));
        if let Some((water, pressures)) = &water {
            let averaged = rate.as_ref().map(|(_, rate)| &rate[..]);
            out_p.copy_from_slice(&water.multiply(self.problem, (&grad, averaged), pressures, v_p));
        }
        let volume = self.problem.volume();
        let mut force = transfer::divergence::<K, D>((shape, &points.x), |p| {
            let flux = contract::<K, D>(&moduli[p], &grad[p]);
            let flux = rate
                .as_ref()
                .map_or(flux, |(dilation, rate)| flux + dilation[p].flux * rate[p]);
            let flux = pressed
                .as_ref()
                .map_or(flux, |(dilation, pressed)| flux + dilation[p].trace * pressed[p]);
            water.as_ref().map_or(flux, |(water, changes)| {
                flux + water.pressed::<K>(p, changes[p].0) * volume[p]
            })
        });
        if let Some(background) = &nodes.background {
            background.multiply::<D>(shape, v, &mut force);
        }
        self.problem.attachments.multiply(v, &mut force);
        nodes.rigid.multiply(v, &mut force, halo);
        out.copy_from_slice(&halo.sum(&force));
        nodes.reduce(&mut [&mut *out], halo);
        if let Some(inertia) = &nodes.inertia {
            let (factor, moved) = (inertia.factor(), v);
            let alike = inertia.moving.is_empty();
            let scaled = |(c, v): (usize, &f64)| inertia.factor_of(c) / factor * v;
            let scaled: Vec<f64> = if alike {
                Vec::new()
            } else {
                v.iter().enumerate().map(scaled).collect()
            };
            let v = if alike { v } else { &scaled };
            for (out, momentum) in out.iter_mut().zip(self.problem.mass().times(v)) {
                *out += factor * momentum;
            }
            nodes
                .dashpots
                .stiffness(inertia)
                .for_each(|(c, stiffness)| out[c] += stiffness * moved[c]);
        }
        nodes.contacts.add_derivative(self.reaction, v, out);
        out.iter_mut()
            .zip(&nodes.free)
            .filter(|(_, free)| !**free)
            .for_each(|(out, _)| *out = 0.0);
    }

    /// Assembles and factorises the matrix that preconditions the product: all of it, but for F-bar's average where
    /// that reaches farther than the matrix. One exchange with the neighbours where it does not.
    pub fn factorise(&self, solver: &mut dyn LinearSolver) -> Result<(), SolveError> {
        let Problem { model, nodes, halo, .. } = *self.problem;
        let Some(extension) = &nodes.extension else {
            return self.factorise_in(solver);
        };
        self.factorise_in(&mut ReducedSystem::new(solver, extension, &model.grid, halo))
    }

    fn factorise_in(&self, solver: &mut dyn LinearSolver) -> Result<(), SolveError> {
        let Problem {
            shape, nodes, points, ..
        } = *self.problem;
        solver.begin(&nodes.free);
        let size = shape.offsets().len();
        let mut slopes = [K::Gradient::NO_SLOPE; MOST];
        let slopes = &mut slopes[..size];
        let mut block = vec![0.0; (size * D).pow(2)];
        let mut coupling = Coupling::of(self.problem.model, nodes, Raised::Own);
        for (number, patch) in shape.patches().iter().enumerate() {
            block.fill(0.0);
            let mut dilations = coupling.as_ref().map(Coupling::of_patch);
            for p in patch.points.clone() {
                transfer::slopes_of::<K, D>((shape, &points.x), p, slopes);
                match &mut dilations {
                    Some(dilations) => self.add_coupled(p, slopes, (dilations, &mut block)),
                    None => add_point::<K, D>(&self.narrow(p).0, slopes, Pairs::All, &mut block),
                }
            }
            if let (Some(coupling), Some(dilations)) = (&mut coupling, &dilations) {
                coupling.add(number, dilations);
            }
            if let Some(background) = &nodes.background {
                background.add_to(number, &mut block);
            }
            add_mass(
                (self.problem.model.mass, nodes),
                (shape, patch),
                &self.problem.points.mass,
                &mut block,
            );
            solver.add(patch.first_node, &block);
        }
        if let Some(coupling) = coupling {
            coupling.assemble(self.problem.halo, solver);
        }
        complete(self.problem, solver, Symmetry::General)
    }

    /// Moduli of point `p`, and its flux per unit of d ln(dJ-bar/dJ), of a force that is not the adjoint: that one
    /// reaches twice as far as a matrix.
    fn narrow(&self, p: usize) -> (Moduli<K, D>, K::Gradient) {
        let flux = self
            .dilation
            .as_ref()
            .map_or_else(K::Gradient::zeros, |dilation| dilation[p].flux);
        let has = |(adjoint, _): &&(Adjoint, _)| adjoint.has(self.problem.model, self.problem.points, p);
        let (Some((_, at)), Some(dilation)) = (self.adjoint.as_ref().filter(has), &self.dilation) else {
            return (self.moduli[p], flux);
        };
        let (
            Dilation { trace, .. },
            Pressure {
                raised: (by_gradient, by_rate),
                ..
            },
        ) = (&dilation[p], &at[p]);
        let unit = |k: usize, l: usize| self.moduli[p][(k, l)] + *trace * by_gradient[(k, l)];
        (K::Gradient::moduli(unit), flux + *trace * *by_rate)
    }

    /// Adds point `p`, whose dilation is averaged: flux_p (S(w dJ tr l)_p / S(w dJ)_p - tr l_p) besides its moduli.
    fn add_coupled(&self, p: usize, slopes: &[Slope<K, D>], (dilations, block): (&mut Dilations, &mut [f64])) {
        let Problem {
            model, nodes, points, ..
        } = *self.problem;
        let Some(Dilation { trace, .. }) = self.dilation.as_ref().map(|dilation| &dilation[p]) else {
            return;
        };
        let (narrow, flux) = self.narrow(p);
        let moduli = K::Gradient::moduli(|k, l| narrow[(k, l)] - flux * trace[(k, l)]);
        add_point::<K, D>(&moduli, slopes, Pairs::All, block);
        let weight = nodes.dilation_weights(model, points)[p];
        let (dilated, mean) = self.trial.means(model, points, p);
        let [mut dilation, mut force] = [[Vector::<D>::zeros(); MOST]; 2];
        for ((dilation, force), slope) in dilation.iter_mut().zip(&mut force).zip(slopes) {
            *dilation = trace.times(slope) * (weight * dilated);
            *force = flux.times(slope) / mean;
        }
        let (dilation, force) = (&dilation[..slopes.len()], &force[..slopes.len()]);
        let group = model.groups.of(points.material[p]);
        dilations.add(
            nodes,
            p,
            &Share {
                group,
                weight,
                bulk: 0.0,
                dilation,
                force,
            },
        );
    }
}

/// Change of the flux of a viscous stress for a unit gradient, per volume: (d tau_v - tau_v l^T) dF^-T.
fn viscous_flux<K: Kinematics<D>, const D: usize>(
    (tau, change): (&Tensor, &impl Fn(&Tensor) -> Tensor),
    inverse: &Tensor,
    (row, column): (usize, usize),
) -> K::Gradient {
    let l = K::gradient::<f64>(&K::Gradient::unit(row, column)) * inverse;
    K::working(&((change(&l) - tau * l.transpose()) * inverse.transpose()))
}

/// Change of the flux for a gradient: sum_kl moduli_kl grad_kl.
#[inline]
fn contract<K: Kinematics<D>, const D: usize>(moduli: &Moduli<K, D>, grad: &K::Gradient) -> K::Gradient {
    let mut flux = K::Gradient::zeros();
    for k in 0..D {
        for l in 0..K::Gradient::SLOPES {
            flux += moduli[(k, l)] * grad[(k, l)];
        }
    }
    flux
}
