//! Updates the material points from the converged state, theory-manual equations (T2.6), (T2.7), (T3.8), (T4.3).
//! Smoothing, (T3.5) or (T3.7), changes the elastic tensor b^e, not the Cauchy stress.

use crate::boundary::AnchoredPoints;
use crate::dynamics::inertia::Inertia;
use crate::dynamics::mass::MassMatrix;
use crate::error::StepError;
use crate::field::Field;
use crate::grid::{Shape, transfer};
use crate::kinematics::Kinematics;
use crate::material::{LayeredMaterial, MaterialError, Response, Separation};
use crate::model::{Model, Regime};
use crate::parallel::{Halo, agreed};
use crate::points::{Points, Rows};
use crate::solve::found::StepSolution;
use crate::stabilisation::Stabilisation;
use crate::step::nodes::GridState;
use crate::step::smooth;
use crate::step::trial::DeformationIncrement;
use crate::step::walls;
use crate::tensor::{Symmetric, Tensor, Vector};
use crate::threads;
use rayon::prelude::*;
use std::sync::Mutex;

/// Rejects a displacement that moves a point out of the grid other than through an outlet. At an outlet, it rejects the
/// loss of a point to which a strip, load or drain is anchored, and of the last point. All ranks agree.
pub fn check_inside<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    shape: &Shape<D>,
    ground: AnchoredPoints<'_, D>,
    u: &[f64],
    halo: &dyn Halo,
) -> Result<(), StepError> {
    let AnchoredPoints { points, anchors } = ground;
    let leaves = transfer::to_points::<D, D, _>(shape, u, |p, du| {
        let x = points.x[p] + Vector::from(du);
        model
            .grid
            .locate(&x)
            .is_none()
            .then(|| (p, x, model.boundary.lets_out(&model.grid, &x)))
    });
    let acting = anchors.acting(&model.boundary);
    let mut leaves: Vec<_> = leaves.into_iter().flatten().collect();
    let mut counts = [(points.len() - leaves.len()) as f64, 0.0, leaves.len() as f64];
    leaves.retain(|(p, _, out)| !out || acting.iter().any(|ids| ids.contains(&points.id[*p])));
    counts[1] = leaves.len() as f64;
    halo.all_reduce_sum(&mut counts);
    if counts[1] > 0.0 {
        let first = leaves
            .into_iter()
            .next()
            .map(|(p, x, _)| (points.id[p], x.as_slice().to_vec()));
        return Err(StepError::Left {
            count: counts[1] as u64,
            first,
        });
    }
    if counts[0] == 0.0 {
        return Err(StepError::Emptied {
            count: counts[2] as u64,
        });
    }
    Ok(())
}

/// Quantities of a saved step that are not stored in the points.
pub struct CommitReport {
    /// Nodal displacement (m).
    pub u: Vec<f64>,
    /// Smoothing of the elastic state as a fraction of one pass of S, mean over the points (-); 0 without smoothing.
    pub smoothed: f64,
    /// Largest displacement of a point, over all ranks (m).
    pub advance: f64,
    /// How much of the second field the points took in, over all ranks.
    pub content: f64,
    /// Kinetic energy of points near fixed faces in excess of that of their displacement, over all ranks (J). Only in
    /// dynamics with such a face.
    pub beside_fixed: Option<f64>,
}

/// Response of the constitutive law at a point in the converged state.
#[derive(Clone, Copy, Debug, Default)]
pub struct PointUpdate {
    /// Kirchhoff stress (Pa).
    pub tau: Symmetric,
    /// Elastic left Cauchy-Green tensor (-).
    pub b_e: Symmetric,
    /// Increment of equivalent plastic strain (-).
    pub plastic_increment: f64,
    /// Open gap, as a logarithm of volume (-).
    pub gap: f64,
    /// Plastic dissipation per reference volume (J/m3).
    pub dissipation: f64,
    /// Elastic energy per reference volume (J/m3).
    pub elastic_energy: f64,
    /// Second-order works per reference volume (J/m3): for elastic soil, and the actual one; zero if they are not
    /// needed.
    pub second_order_works: [f64; 2],
    flow: smooth::PlasticFlow,
}

impl PointUpdate {
    /// Copies the data of a `response`; `gap` is the gap before the step.
    fn of(response: &Response, gap: f64) -> Self {
        Self {
            tau: response.tau(),
            b_e: response.b_e(),
            plastic_increment: response.plastic_increment(),
            gap: response.gap(),
            dissipation: response.dissipation(),
            elastic_energy: response.elastic_energy(),
            second_order_works: [0.0; 2],
            flow: smooth::PlasticFlow::of(response, gap),
        }
    }
}

/// Responses of the constitutive laws to a converged step.
pub struct ConstitutiveUpdate {
    /// Response of every point.
    pub answers: Vec<PointUpdate>,
    /// State variables of the laws after the step, if they have any.
    pub state: Option<Rows>,
}

/// Evaluates the constitutive laws for the converged step. Fails on all ranks if a law rejects a state that it accepted
/// during the iteration.
pub fn constitutive_update<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    trial: &DeformationIncrement<K, D>,
    points: &Points<D>,
    halo: &dyn Halo,
) -> Result<ConstitutiveUpdate, StepError> {
    let mut state = points.state.clone();
    let laws = LawsOfPoints {
        model,
        trial,
        points,
        asks: has_second_order_works(model),
        refused: Mutex::new(None),
    };
    let answers: Vec<PointUpdate> = match &mut state {
        Some(state) => state
            .par_rows_mut()
            .enumerate()
            .map(|(p, row)| laws.answer(p, Some(row)))
            .collect(),
        None => threads::each(points.len(), |p| laws.answer(p, None)),
    };
    let answers = match laws.refused.into_inner().expect("no thread panicked") {
        Some((p, source)) => Err(StepError::Material {
            id: points.id[p],
            source,
        }),
        None => Ok(answers),
    };
    Ok(ConstitutiveUpdate {
        answers: agreed(halo, answers, StepError::OtherRank)?,
        state,
    })
}

/// Evaluates the laws of the points at a converged state.
struct LawsOfPoints<'a, K: Kinematics<D>, const D: usize> {
    model: &'a Model<K, D>,
    trial: &'a DeformationIncrement<K, D>,
    points: &'a Points<D>,
    asks: bool,                                     // whether second-order works are needed
    refused: Mutex<Option<(usize, MaterialError)>>, // first point that a law rejected, and why
}

impl<K: Kinematics<D>, const D: usize> LawsOfPoints<'_, K, D> {
    /// Returns the response at point `p` and updates its state variables `row`, if its law has any. Records a rejected
    /// state.
    fn answer(&self, p: usize, row: Option<&mut [f64]>) -> PointUpdate {
        let response = match self.trial.respond(self.model, self.points, p) {
            Ok(response) => response,
            Err(source) => {
                let mut refused = self.refused.lock().expect("no thread panicked");
                if refused.as_ref().is_none_or(|(first, _)| p < *first) {
                    *refused = Some((p, source));
                }
                return PointUpdate::default();
            }
        };
        row.into_iter().for_each(|row| response.advance(row));
        let gap = self.points.gap_of(p);
        let mut answer = PointUpdate::of(&response, gap);
        if self.asks
            && let Some(strain) = self.trial.strain(p)
        {
            answer.second_order_works = response.second_order_works(&strain, gap);
        }
        answer
    }
}

/// Returns whether second-order works measure the distance from failure: in quasi-static analysis with yielding
/// materials and without a second field, which changes the load on the material over time.
fn has_second_order_works<K, const D: usize>(model: &Model<K, D>) -> bool {
    model.regime == Regime::QuasiStatic && !model.is_coupled() && model.materials.iter().any(LayeredMaterial::yields)
}

/// Returns the second-order works of a step over all points of all ranks (J): `Σ V0 Δε : D : Δε` for elastic soil, and
/// the actual `Σ V0 Δε : D : Δεᵉ`, the work of the load increment on the displacement increment. `None` where they are
/// not meaningful. One reduction.
pub fn second_order_works<K, const D: usize>(
    model: &Model<K, D>,
    points: &Points<D>,
    answers: &[PointUpdate],
    halo: &dyn Halo,
) -> Option<[f64; 2]> {
    if !has_second_order_works(model) {
        return None;
    }
    let sums = threads::sums(points.len(), |p| {
        answers[p].second_order_works.map(|dense| points.volume[p] * dense)
    });
    let total = halo.reproducible_sum(&sums);
    Some([total[0], total[1]])
}

/// Returns `Σ V0 |τ : Δε|`, the magnitudes of the works of the points' stresses in a step over all ranks (J). Unlike
/// the works of nodal forces, these do not vanish where internal forces balance at each node. One reduction.
pub fn stress_work<K: Kinematics<D>, const D: usize>(
    trial: &DeformationIncrement<K, D>,
    points: &Points<D>,
    answers: &[PointUpdate],
    halo: &dyn Halo,
) -> f64 {
    let sum = threads::sum(points.len(), |p| {
        let strain = Symmetric::of(&(trial.dF(p) - Tensor::identity()));
        points.volume[p] * answers[p].tau.double_dot(&strain).abs()
    });
    halo.reproducible_sum(&[sum])[0]
}

/// Saves the converged step and the responses of the laws into the points.
pub fn update_points<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    shape: &Shape<D>,
    nodes: &GridState<D>,
    found: StepSolution<K, D>,
    update: ConstitutiveUpdate,
    points: &mut Points<D>,
    halo: &dyn Halo,
) -> CommitReport {
    let ConstitutiveUpdate { answers, state } = update;
    let StepSolution {
        u, p: values, trial, ..
    } = found;
    if let Some(inertia) = &nodes.inertia {
        move_with_inertia(shape, model.mass, inertia, &u, points);
    }
    let du = transfer::to_points::<D, D, _>(shape, &u, |_, du| Vector::from(du));
    let mut advance = [threads::largest(du.len(), |p| du[p].norm_squared()).sqrt()];
    halo.all_reduce_max(&mut advance);
    let beside_fixed = nodes.inertia.as_ref().and_then(|inertia| {
        walls::relax(model, points, &du, inertia.dt);
        walls::excess(model, points, &du, inertia.dt, halo)
    });
    threads::change(&mut points.x, 1, |p, x| x[0] += du[p]); // (11a)
    threads::change(&mut points.u, 1, |p, u| u[0] += du[p]); // (11b)
    points.state = state;
    keep(model, &trial, &answers, points);
    let content = nodes
        .field
        .as_ref()
        .map_or(0.0, |field| field.save(model, &trial, &values, points, halo));
    let damped = nodes.inertia.is_some() && !model.damping.is_empty();
    let before = (damped && model.stabilisation.smooths()).then(|| points.b_e.clone());
    let smoothed = match model.stabilisation {
        Stabilisation::ModifiedFBar => {
            smooth::average_b_e(model, shape, nodes, points, halo);
            1.0
        }
        Stabilisation::ConsistentFBar | Stabilisation::SubgridFBar => {
            let flow = threads::each(answers.len(), |p| answers[p].flow);
            smooth::filter_dilation(model, shape, nodes, points, &flow, halo)
        }
        Stabilisation::None | Stabilisation::FBar => 0.0,
    };
    points.smoothing = before.map(|before| smooth::change(&before, &points.b_e));
    points.gap = gaps(model, points, &answers);
    CommitReport {
        u,
        advance: advance[0],
        smoothed,
        content,
        beside_fixed,
    }
}

/// Saves deformation, stress, elastic and plastic strain of every point.
fn keep<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    trial: &DeformationIncrement<K, D>,
    answers: &[PointUpdate],
    points: &mut Points<D>,
) {
    let averages = model.stabilisation.averages();
    let dilation = averages.then(|| threads::each(points.len(), |p| trial.dilation(points, p)));
    let damped = (!model.damping.is_empty())
        .then(|| threads::each(points.len(), |p| trial.damped_at(model, points, p, answers[p].tau)));
    let [mut sigma, mut b_e] = [&mut points.sigma, &mut points.b_e].map(std::mem::take);
    let mut F = std::mem::take(&mut points.F);
    let mut eps_p = std::mem::take(&mut points.eps_p);
    let sigmas = sigma.apart();
    let elastic = b_e.apart();
    let Fs = F.apart();
    let plastic = threads::apart(&mut eps_p, 1);
    threads::by_chunks(points.len(), &|chunk, range| {
        let only = "the chunk's only thread";
        let mut sigma = sigmas[chunk].lock().expect(only);
        let mut b_e = elastic[chunk].lock().expect(only);
        let mut F = Fs[chunk].lock().expect(only);
        let mut eps_p = plastic[chunk].lock().expect(only);
        for (k, p) in range.enumerate() {
            let answer = &answers[p];
            let deformed = trial.dF(p) * F.at(k);
            let tau = damped.as_ref().map_or(answer.tau, |damped| damped[p]);
            let dilation = dilation
                .as_ref()
                .map_or_else(|| points.dilation_of(p), |dilation| dilation[p]);
            sigma.set(k, tau.scaled(1.0 / (deformed.determinant() * dilation)));
            F.set(k, deformed);
            b_e.set(k, answer.b_e);
            eps_p[k] += answer.plastic_increment;
        }
    });
    drop((sigmas, elastic, Fs, plastic));
    (points.sigma, points.b_e, points.F, points.eps_p) = (sigma, b_e, F, eps_p);
    points.dilation = dilation.or(points.dilation.take());
}

/// Returns the gap of every point after the step, if some material has closing gaps.
fn gaps<K, const D: usize>(model: &Model<K, D>, points: &Points<D>, answers: &[PointUpdate]) -> Option<Vec<f64>> {
    let closes: Vec<bool> = model
        .materials
        .iter()
        .map(|law| law.separation() == Separation::Closing)
        .collect();
    if !closes.contains(&true) {
        return None;
    }
    let gaps = answers.iter().zip(&points.material).map(|(answer, material)| {
        if closes[usize::from(*material)] {
            answer.gap
        } else {
            0.0
        }
    });
    Some(gaps.collect())
}

/// Updates velocities and accelerations, steps (10a), (11c), (11d): a_I by Newmark, a_p = sum_I N_Ip a_I, v_p += dt ((1
/// - gamma) a_p(t) + gamma a_p(t+dt)).
///
/// With a consistent mass, v_p += sum_I N_Ip (v_I(t+dt) - v_I(t)) instead, where v_I(t) is the velocity before supports
/// changed it. The points then gain the same momentum as the nodes; with point accelerations they would gain more.
fn move_with_inertia<const D: usize>(
    shape: &Shape<D>,
    matrix: MassMatrix,
    inertia: &Inertia,
    u: &[f64],
    points: &mut Points<D>,
) {
    let Some(motion) = &mut points.motion else { return };
    if matrix == MassMatrix::Consistent {
        let gained: Vec<f64> = (0..u.len())
            .map(|c| inertia.velocity(c, u[c]) - inertia.v[c] + inertia.blow.get(c).copied().unwrap_or(0.0))
            .collect();
        let gained = transfer::to_points::<D, D, _>(shape, &gained, |_, v| Vector::from(v));
        threads::change(&mut motion.v, 1, |p, v| v[0] += gained[p]);
    }
    if matrix == MassMatrix::Lumped && !inertia.stopped.is_empty() {
        let blows: Vec<f64> = u.iter().enumerate().map(|(c, &u)| inertia.blow_of(c, u)).collect();
        let blows = transfer::to_points::<D, D, _>(shape, &blows, |_, v| Vector::from(v));
        threads::change(&mut motion.v, 1, |p, v| v[0] += blows[p]);
    }
    let a: Vec<f64> = u.iter().enumerate().map(|(c, &u)| inertia.acceleration(c, u)).collect();
    let a = transfer::to_points::<D, D, _>(shape, &a, |_, a| Vector::from(a));
    if matrix == MassMatrix::Lumped {
        threads::change(&mut motion.v, 1, |p, v| {
            v[0] += motion.a[p].zip_map(&a[p], |before, after| inertia.newmark.gained(inertia.dt, before, after));
        });
    }
    motion.a = a;
}
