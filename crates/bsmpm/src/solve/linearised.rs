//! Complete derivative of the out-of-balance force for Newton's method, theory-manual equation (T5.14): exact as a
//! matrix-vector product, partly approximated as an assembled matrix.

use crate::dynamics::inertia::Inertia;
use crate::error::SolveError;
use crate::field::{Field, FieldTangent};
use crate::grid::transfer;
use crate::kinematics::{Gradient, GradientModuli, Kinematics, Slope};
use crate::linear::{LinearSolver, MatrixAssembly, Symmetry};
use crate::material::Tangent;
use crate::step::adjoint::{Adjoint, Pressures, transposed, works};
use crate::step::blocks::{MOST, Pairs, add_mass, add_point, complete};
use crate::step::coupling::{Coupling, DilationForce, Dilations, Share};
use crate::step::problem::Problem;
use crate::step::reduced_matrix;
use crate::step::residual::Residual;
use crate::step::trial::DeformationIncrement;
use crate::tensor::{Tensor, Vector};
use std::borrow::Cow;

/// Derivative of the out-of-balance force at one displacement.
pub struct ForceTangent<'a, K: Kinematics<D>, const D: usize> {
    problem: &'a Problem<'a, K, D>,
    trial: &'a DeformationIncrement<K, D>,
    reaction: &'a [f64], // N
    /// V0 d(tau dF^-T)/d(grad v) (N m), one unit gradient after the other.
    moduli: Vec<GradientModuli<K, D>>,
    /// Contribution of F-bar, if used.
    dilation: Option<Vec<Dilation<K::Gradient>>>,
    /// Contribution of the adjoint force at all points, under consistent F-bar in dilatant material.
    adjoint: Option<(Adjoint, Vec<Pressure<K::Gradient>>)>,
    /// Contribution of the second field, if any.
    field: Option<FieldTangent<'a, D>>,
}

/// Contribution of the adjoint force at a point, whose pressure is an average.
struct Pressure<G> {
    /// d(V0 tau : I / dof) per displacement gradient (J).
    by_gradient: G,
    /// d(V0 tau : I / dof) per unit of d ln(dJ-bar/dJ) (J).
    by_rate: f64,
    /// V0 tau : I / dof of the point itself (J).
    own: f64,
}

/// A point whose stress changes with the displacement.
struct LinearisedPoint {
    tangent: Tangent,
    inverse: Tensor,       // dF^-1
    tau: Tensor,           // Pa
    volume: f64,           // m^D  V0
    pressure: Option<f64>, // of the adjoint force (J)
    field: Option<f64>,    // Kirchhoff pressure of the second field (Pa)
}

impl LinearisedPoint {
    /// Returns V0 d(tau dF^-T) for the unit gradient of a row and a column (N m).
    fn change<K: Kinematics<D>, const D: usize>(&self, row: usize, column: usize) -> K::Gradient {
        let l = K::gradient::<f64>(&K::Gradient::unit(row, column)) * self.inverse;
        let mut change = self.tangent.apply(&l) - self.tau * l.transpose();
        if let Some(pressure) = self.pressure {
            let pressure = pressure / self.volume;
            let own = works::<K, D>(&self.tau);
            change -= l.transpose() * (pressure - own);
            change += Tensor::identity() * (pressure * l.trace() - works::<K, D>(&self.tangent.apply(&l)));
        }
        if let Some(pressure) = self.field {
            change += (l.transpose() - Tensor::identity() * l.trace()) * pressure;
        }
        K::working(&(change * self.inverse.transpose())) * self.volume
    }

    /// Returns the contribution of F-bar. `viscous` gives the change of the viscous stress with a gradient, if the
    /// point has damping.
    fn dilation<K: Kinematics<D>, const D: usize>(
        &self,
        viscous: Option<&impl Fn(&Tensor) -> Tensor>,
    ) -> Dilation<K::Gradient> {
        let mut change = self.tangent.apply(&K::dilation());
        if self.pressure.is_some() {
            change -= Tensor::identity() * works::<K, D>(&change);
        }
        if let Some(viscous) = viscous {
            change += viscous(&K::dilation());
        }
        let change = change * self.inverse.transpose();
        Dilation {
            trace: K::working(&self.inverse.transpose()),
            flux: K::working(&change) * self.volume,
        }
    }
}

/// Contribution of F-bar at a point.
struct Dilation<G> {
    /// tr l per gradient: dF^-T (-).
    trace: G,
    /// V0 d(tau dF^-T) per unit of d ln(dJ-bar/dJ) (N m).
    flux: G,
}

impl<G> Pressure<G> {
    /// Differentiates the pressure of a point.
    fn of<K: Kinematics<D, Gradient = G>, const D: usize>(point: &LinearisedPoint) -> Self
    where
        G: Gradient<D, Of<f64> = G>,
    {
        let LinearisedPoint { tangent, volume, .. } = point;
        Self {
            by_gradient: G::from_fn(|k, l| {
                let unit = G::unit(k, l);
                volume * works::<K, D>(&tangent.apply(&(K::gradient::<f64>(&unit) * point.inverse)))
            }),
            by_rate: volume * works::<K, D>(&tangent.apply(&K::dilation())),
            own: volume * works::<K, D>(&point.tau),
        }
    }
}

impl<'a, K: Kinematics<D>, const D: usize> ForceTangent<'a, K, D> {
    /// Computes the derivative where `residual` was evaluated. No point may have inverted there.
    pub fn at(problem: &'a Problem<'a, K, D>, residual: &'a Residual<K, D>) -> Self {
        let trial = &residual.trial;
        let points = problem.points;
        let averaged = trial.is_averaged();
        let mut moduli = Vec::with_capacity(points.len());
        let mut dilation = averaged.then(|| Vec::with_capacity(points.len()));
        let pressures = Pressures::of(problem, trial);
        let mut adjoint = Adjoint::of(problem.model).map(|adjoint| (adjoint, Vec::with_capacity(points.len())));
        for (p, &volume) in problem.volume().iter().enumerate() {
            let dF = trial.dF(p);
            let inverse = dF.try_inverse();
            let response = trial.respond(problem.model, points, p).ok();
            let Some((response, inverse)) = response.zip(inverse) else {
                moduli.push(K::Gradient::moduli(|_, _| K::Gradient::zeros())); // unreachable: the residual rejects it
                continue;
            };
            let point = LinearisedPoint {
                tangent: response.tangent(),
                inverse,
                tau: response.tau().full(),
                volume,
                pressure: pressures.at(p),
                field: trial.field_pressure_at(p),
            };
            let viscous = trial.viscous(problem.model, points, p, &response);
            let viscous = viscous.map(|viscous| (viscous.tau.full(), viscous.tangent(response.change_of_returned())));
            moduli.push(K::Gradient::moduli(|k, l| match &viscous {
                Some((tau, change)) => {
                    point.change::<K, D>(k, l) + viscous_flux::<K, D>(tau, change, &inverse, k, l) * volume
                }
                None => point.change::<K, D>(k, l),
            }));
            if let Some(dilation) = &mut dilation {
                if let Some((_, at)) = &mut adjoint {
                    at.push(Pressure::of::<K, D>(&point));
                }
                dilation.push(point.dilation::<K, D>(viscous.as_ref().map(|(_, change)| change)));
            }
        }
        Self {
            problem,
            trial,
            reaction: &residual.balance.reaction,
            moduli,
            dilation,
            adjoint,
            field: None,
        }
    }

    /// Adds the second field to the derivative. In `x` its nodal values follow the displacements.
    pub fn with_field(mut self, x: &'a [f64]) -> Self {
        let Problem { nodes, .. } = *self.problem;
        let p = &x[nodes.constraints.free.len()..];
        let field = nodes.field.as_ref();
        self.field = field.map(|field| field.tangent(self.problem, self.trial, p));
        self
    }

    /// Computes K v for nodal arrays; `v` is zero where it is not free. One exchange with the neighbours, one more each
    /// under F-bar, for the adjoint force and with a second field.
    pub fn multiply(&self, v: &[f64], out: &mut [f64]) {
        let Problem {
            shape,
            nodes,
            points,
            halo,
            ..
        } = *self.problem;
        let (v, v_p) = v.split_at(nodes.constraints.free.len());
        let (out, out_p) = out.split_at_mut(nodes.constraints.free.len());
        let mut extended = Cow::Borrowed(v);
        if let Some(extension) = &nodes.constraints.extension {
            extension.extend(&self.problem.model.grid, extended.to_mut(), halo);
        }
        let v = &extended[..];
        let grad = transfer::gradients::<K, D, _>(shape, &points.x, v, |_, grad| grad);
        let rate = self.dilation.as_ref().and_then(|dilation| {
            let traces = dilation.iter().zip(&grad).map(|(at, grad)| at.trace.dot(grad));
            let trace: Vec<f64> = traces.collect();
            Some((dilation, self.trial.dilation_rate(self.problem, &trace)?))
        });
        let pressed = rate
            .as_ref()
            .and_then(|(dilation, rate)| Some((dilation, self.pressed(dilation, rate, &grad)?)));
        let field = self.field.as_ref().map(|field| (field, field.pressures(v_p)));
        if let Some((field, pressures)) = &field {
            let averaged = rate.as_ref().map(|(_, rate)| &rate[..]);
            out_p.copy_from_slice(&field.multiply(self.problem, &grad, averaged, pressures, v_p));
        }
        let volume = self.problem.volume();
        let moduli = &self.moduli;
        let mut force = transfer::divergence::<K, D>(shape, &points.x, |p| {
            let flux = contract::<K, D>(&moduli[p], &grad[p]);
            let flux = rate
                .as_ref()
                .map_or(flux, |(dilation, rate)| flux + dilation[p].flux * rate[p]);
            let flux = pressed
                .as_ref()
                .map_or(flux, |(dilation, pressed)| flux + dilation[p].trace * pressed[p]);
            field.as_ref().map_or(flux, |(field, changes)| {
                flux + field.pressed::<K>(p, changes[p].value) * volume[p]
            })
        });
        let context = self.problem.context();
        for interaction in nodes.interactions.iter() {
            interaction.add_product(&context, v, &mut force);
        }
        out.copy_from_slice(&halo.assemble_ghosts(&force));
        nodes.constraints.reduce(&mut [&mut *out], halo);
        if let Some(inertia) = &nodes.inertia {
            self.add_inertia(inertia, v, out);
        }
        for interaction in nodes.interactions.iter() {
            interaction.add_nodal_product(&context, self.reaction, v, out);
        }
        out.iter_mut()
            .zip(&nodes.constraints.free)
            .filter(|(_, free)| !**free)
            .for_each(|(out, _)| *out = 0.0);
    }

    /// Returns the change of the adjoint force's pressures at the points (J) for a gradient and the rate of
    /// ln(dJ-bar/dJ); `None` without such a force. One exchange with the neighbours.
    fn pressed(&self, dilation: &[Dilation<K::Gradient>], rate: &[f64], grad: &[K::Gradient]) -> Option<Vec<f64>> {
        let (adjoint, at) = self.adjoint.as_ref()?;
        Some(transposed(self.problem, adjoint, self.trial, |p| {
            let mean = self.trial.mean_dJ(p);
            let grown = at[p].own * (rate[p] + dilation[p].trace.dot(&grad[p]));
            (at[p].by_gradient.dot(&grad[p]) + at[p].by_rate * rate[p] - grown) / mean
        }))
    }

    /// Adds the resistance of inertia to a nodal displacement `v` (m) to `out` (N).
    fn add_inertia(&self, inertia: &Inertia, v: &[f64], out: &mut [f64]) {
        let factor = inertia.factor();
        let mut scaled = Cow::Borrowed(v);
        if !inertia.moving.is_empty() {
            for (c, v) in scaled.to_mut().iter_mut().enumerate() {
                *v *= inertia.factor_of(c) / factor;
            }
        }
        for (out, momentum) in out.iter_mut().zip(self.problem.mass().times(&scaled)) {
            *out += factor * momentum;
        }
    }

    /// Assembles and factorises the preconditioner of the product. It is the complete derivative except for the F-bar
    /// average where this couples nodes beyond the sparsity pattern. One exchange with the neighbours otherwise.
    pub fn factorise(&self, solver: &mut dyn LinearSolver) -> Result<(), SolveError> {
        self.assemble(solver.matrix());
        solver.factorise(Symmetry::General)
    }

    /// Assembles the matrix of [`ForceTangent::factorise`].
    pub fn assemble(&self, matrix: &mut dyn MatrixAssembly) {
        reduced_matrix::assemble(self.problem, matrix, |matrix| self.assemble_into(matrix));
    }

    fn assemble_into(&self, matrix: &mut dyn MatrixAssembly) {
        let Problem {
            shape, nodes, points, ..
        } = *self.problem;
        matrix.reinit(&nodes.constraints.free);
        let size = shape.offsets().len();
        let mut slopes = [K::Gradient::NO_SLOPE; MOST];
        let slopes = &mut slopes[..size];
        let mut block = vec![0.0; (size * D).pow(2)];
        let mut coupling = Coupling::of(self.problem.model, nodes, DilationForce::Own);
        for (number, patch) in shape.patches().iter().enumerate() {
            block.fill(0.0);
            let mut dilations = coupling.as_ref().map(Coupling::of_patch);
            for p in patch.points.clone() {
                transfer::slopes_of::<K, D>(shape, &points.x, p, slopes);
                match &mut dilations {
                    Some(dilations) => self.add_coupled(p, slopes, dilations, &mut block),
                    None => add_point::<K, D>(&self.narrow(p).0, slopes, Pairs::All, &mut block),
                }
            }
            if let (Some(coupling), Some(dilations)) = (&mut coupling, &dilations) {
                coupling.add(number, dilations);
            }
            for interaction in nodes.interactions.iter() {
                interaction.add_to_cell(number, &mut block);
            }
            add_mass(
                self.problem.model.mass,
                nodes,
                shape,
                patch,
                &self.problem.points.mass,
                &mut block,
            );
            matrix.add_block(patch.first_node, &block);
        }
        if let Some(coupling) = coupling {
            coupling.assemble(self.problem.halo, matrix);
        }
        complete(self.problem, matrix);
    }

    /// Returns the moduli of point `p` and its flux per unit of d ln(dJ-bar/dJ) for a local force in place of the
    /// adjoint force, which couples nodes twice as far apart as the matrix does.
    fn narrow(&self, p: usize) -> (GradientModuli<K, D>, K::Gradient) {
        let flux = self
            .dilation
            .as_ref()
            .map_or_else(K::Gradient::zeros, |dilation| dilation[p].flux);
        let pressures = self
            .adjoint
            .as_ref()
            .filter(|(adjoint, _)| adjoint.has(self.problem.model, self.problem.points, p));
        let Some(((_, at), dilation)) = pressures.zip(self.dilation.as_ref()) else {
            return (self.moduli[p], flux);
        };
        let Dilation { trace, .. } = &dilation[p];
        let Pressure {
            by_gradient, by_rate, ..
        } = &at[p];
        let moduli = K::Gradient::moduli(|k, l| self.moduli[p][(k, l)] + *trace * by_gradient[(k, l)]);
        (moduli, flux + *trace * *by_rate)
    }

    /// Adds point `p` with averaged dilation: its moduli and flux_p (S(w dJ tr l)_p / S(w dJ)_p - tr l_p).
    fn add_coupled(&self, p: usize, slopes: &[Slope<K, D>], dilations: &mut Dilations, block: &mut [f64]) {
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
        let [dilated, mean] = [self.trial.dJ(p), self.trial.mean_dJ(p)];
        let [mut dilation, mut force] = [[Vector::<D>::zeros(); MOST]; 2];
        for ((dilation, force), slope) in dilation.iter_mut().zip(&mut force).zip(slopes) {
            *dilation = trace.times(slope) * (weight * dilated);
            *force = flux.times(slope) / mean;
        }
        let dilation = &dilation[..slopes.len()];
        let force = &force[..slopes.len()];
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

/// Returns the change of the flux of a viscous stress for a unit gradient, per volume: (d tau_v - tau_v l^T) dF^-T
/// (Pa).
fn viscous_flux<K: Kinematics<D>, const D: usize>(
    tau: &Tensor,
    change: &impl Fn(&Tensor) -> Tensor,
    inverse: &Tensor,
    row: usize,
    column: usize,
) -> K::Gradient {
    let l = K::gradient::<f64>(&K::Gradient::unit(row, column)) * inverse;
    K::working(&((change(&l) - tau * l.transpose()) * inverse.transpose()))
}

/// Returns the change of the flux for a gradient: sum_kl moduli_kl grad_kl.
#[inline]
fn contract<K: Kinematics<D>, const D: usize>(moduli: &GradientModuli<K, D>, grad: &K::Gradient) -> K::Gradient {
    let mut flux = K::Gradient::zeros();
    for k in 0..D {
        for l in 0..K::Gradient::SLOPES {
            flux += moduli[(k, l)] * grad[(k, l)];
        }
    }
    flux
}
