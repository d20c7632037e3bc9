//! Water balance at the nodes, theory-manual equation (T8.9), Darcy flux (T8.7), and pore pressure in the Kirchhoff
//! stress (T8.6).

use crate::grid::transfer::{self, scalars};
use crate::kinematics::{Gradient, Kinematics};
use crate::model::Model;
use crate::parallel::over_layers;
use crate::points::Points;
use crate::step::problem::Problem;
use crate::step::trial::DeformationIncrement;
use crate::tensor::{Tensor, Vector};
use crate::water::nodes::{PoreField, SaturatedPoint};
use crate::water::retention::RetentionState;
use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering::Relaxed;

/// Numbers of a node in the balance: what is stored, what flows, the tau term, and what drains and inflows let through.
const TERMS: usize = 4;
/// Place of what flows among them.
const FLOWS: usize = 1;

/// What is out of balance in the water, m3, nodal.
#[derive(Clone, Debug, Default)]
pub struct WaterBalance {
    /// R: more than came in; zero where the pressure is no unknown
    pub excess: Vec<f64>,
    /// what leaves where the pressure is given at a face: -R there, else zero
    pub out: Vec<f64>,
    /// |R|
    pub norm: f64,
    /// the largest of the norms of what is stored, flows, and leaves
    pub scale: f64,
    /// sum of R, which conservation is short of
    pub left: f64,
    /// points whose pores are closed, over all ranks
    pub closed: u64,
    /// no norm overflowed
    pub finite: bool,
}

impl WaterBalance {
    /// Of nodal excess pressures `p` (Pa; none: zero) under the deformation of `trial`, which then carries what the
    /// water presses with. One exchange with the neighbours and one reduction.
    pub fn of<K: Kinematics<D>, const D: usize>(
        problem: &Problem<'_, K, D>,
        pores: &PoreField<D>,
        trial: &mut DeformationIncrement<K, D>,
        p: &[f64],
    ) -> Self {
        let Problem {
            model, points, halo, ..
        } = *problem;
        let pressures = scalars::scalars(&pores.shape, p, |_, value, gradient| ExcessPressure { value, gradient });
        let closed = AtomicU64::new(0);
        let mut sums = scalars::of_scalars(&pores.shape, |p| {
            let Some(wet) = &pores.wet[p] else {
                return [(0.0, Vector::zeros()); TERMS];
            };
            let dilation = trial.dilation(model, points, p);
            let zero = Vector::zeros();
            let Some(state) = FlowState::at(model, points, p, wet, &trial.dF(p), dilation, pressures[p]) else {
                closed.fetch_add(1, Relaxed);
                return [(f64::NAN, zero); TERMS];
            };
            if state.pores.is_nan() || state.pores <= 0.0 {
                closed.fetch_add(1, Relaxed);
            }
            let stored = wet.volume * (state.content - wet.content - wet.goes_on);
            let tau = wet.tau_of(pressures[p].gradient) * state.lumped;
            [
                (stored, zero),
                (0.0, state.flux * -(pores.duration * wet.volume)),
                (0.0, tau),
                (0.0, zero),
            ]
        });
        pores.drainage.add_to(p, &mut sums);
        trial.pore = Some(of_points(problem, pores, trial, &pressures));
        let mut sums = halo.assemble_ghosts(&sums);
        pores.ties.add_to(p, &mut sums, |node| node * TERMS + FLOWS);
        Self::at_nodes(problem, pores, &sums, closed.into_inner())
    }

    fn at_nodes<K, const D: usize>(
        problem: &Problem<'_, K, D>,
        pores: &PoreField<D>,
        sums: &[f64],
        closed: u64,
    ) -> Self {
        let halo = problem.halo;
        let mut excess = vec![0.0; pores.free.len()];
        let mut out = vec![0.0; pores.free.len()];
        for (node, terms) in sums.chunks_exact(TERMS).enumerate() {
            let whole = terms.iter().sum::<f64>();
            if pores.free[node] {
                excess[node] = whole;
            } else if pores.prescribed[node].is_some() {
                out[node] = -whole;
            }
        }
        let term = |k: usize| over_layers(halo, 1, |node| sums[node * TERMS + k].powi(2));
        let totals = halo.reproducible_sum(&[
            over_layers(halo, 1, |node| excess[node].powi(2)),
            over_layers(halo, 1, |node| excess[node]),
            std::iter::once(closed as f64).collect(),
            term(0),
            term(1),
            term(3),
            over_layers(halo, 1, |node| out[node].powi(2)),
        ]);
        Self {
            norm: totals[0].sqrt(),
            scale: totals[3..].iter().copied().fold(0.0, f64::max).sqrt(),
            left: totals[1],
            closed: totals[2] as u64,
            finite: totals.iter().all(|total| total.is_finite()),
            excess,
            out,
        }
    }

    /// |R| over the largest of what is stored, flows and leaves; zero where it is no more than `round_off`, m3.
    pub fn measure(&self, round_off: f64) -> f64 {
        if self.norm <= round_off {
            0.0
        } else {
            self.norm / self.scale
        }
    }
}

/// J p of every point, Pa: what the water presses with, beside the Kirchhoff stress of the skeleton; of pores that it
/// does not fill chi p, less what acts as a force of its own.
fn of_points<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    pores: &PoreField<D>,
    trial: &DeformationIncrement<K, D>,
    pressures: &[ExcessPressure<D>],
) -> Vec<f64> {
    let of_points = pores.wet.iter().enumerate().map(|(p, wet)| {
        let Some(wet) = wet else { return 0.0 };
        let whole = pressures[p].value + wet.ambient;
        let chi = retained(problem.model, problem.points.material[p], whole).effective;
        wet.J * trial.dF(p).determinant() * (chi * whole - wet.borne)
    });
    of_points.collect()
}

/// The water of a material under the whole pore pressure `p`, Pa.
fn retained<K, const D: usize>(model: &Model<K, D>, material: u16, p: f64) -> RetentionState {
    let Some(water) = &model.water else {
        return RetentionState::FULL;
    };
    let flow = water.flow.as_ref();
    let soil = flow.and_then(|flow| flow.soils[usize::from(material)].as_ref());
    soil.map_or(RetentionState::FULL, |soil| soil.retained(p, water.unit_weight))
}

/// Excess pore pressure at a point, or a change of it.
#[derive(Clone, Copy)]
pub struct ExcessPressure<const D: usize> {
    /// Excess pore pressure, Pa.
    pub value: f64,
    /// Gradient with respect to the position at the start of the step, Pa/m.
    pub gradient: Vector<D>,
}

/// What water does at a point under a trial.
#[derive(Clone)]
pub struct FlowState<const D: usize> {
    /// -  pores per reference volume, by J-bar: those that the skeleton's stress has felt
    pub pores: f64,
    /// -  water per reference volume
    pub content: f64,
    /// m/s  J dF^-1 w: what flows, per area at the start of the step and J there
    pub flux: Vector<D>,
    /// m/s  w: what flows, relative to the skeleton
    pub w: Vector<D>,
    /// Pa/m  gradient of the excess pressure, now
    pub gradient: Vector<D>,
    /// -  share of the tau term: 1, and more where pores fill or empty, whose storage it lumps as well
    pub lumped: f64,
    /// m/s  permeability of full pores along the axes; zero where nothing flows
    pub permeability: Vector<D>,
    /// what the pores keep
    pub retained: RetentionState,
    /// Pa  whole pore pressure; of pores that stay full the excess alone
    pub whole: f64,
    /// -
    pub J: f64,
    /// dF^-1
    pub inverse: Tensor,
}

impl<const D: usize> FlowState<D> {
    /// Of a wet point with dF and J-bar/J at the end of the step, and with the excess pressure, Pa, and its gradient by
    /// the places at t, Pa/m; `None` where dF has no inverse.
    #[inline]
    pub fn at<K>(
        model: &Model<K, D>,
        points: &Points<D>,
        p: usize,
        wet: &SaturatedPoint<D>,
        dF: &Tensor,
        dilation: f64,
        excess: ExcessPressure<D>,
    ) -> Option<Self> {
        let water = model.water.as_ref()?;
        let flow = water.flow.as_ref()?;
        let soil = flow.soils[usize::from(points.material[p])].as_ref()?;
        let inverse = dF.try_inverse()?;
        let J = wet.J * dF.determinant();
        let gradient = pushed(&inverse, &excess.gradient);
        let permeability = flow
            .permeability(points.material[p], J * dilation)
            .unwrap_or_else(Vector::zeros);
        let whole = excess.value + wet.ambient;
        let weight = water.unit_weight;
        let retained = soil.retained(whole, weight);
        let w = (gradient + wet.drive).component_mul(&permeability) * (-retained.permeability / weight);
        let flux = Vector::from_fn(|i, _| J * (0..D).map(|j| inverse[(i, j)] * w[j]).sum::<f64>());
        let content = soil.content(flow.bulk, J, whole) * retained.saturation;
        let lumped = wet.lumped(soil, soil.chord(wet.pressure, whole, weight));
        let pores = soil.pores(J * dilation);
        Some(Self {
            pores,
            content,
            flux,
            w,
            gradient,
            lumped,
            permeability,
            retained,
            whole,
            J,
            inverse,
        })
    }
}

/// dF^-T times a gradient.
pub fn pushed<const D: usize>(inverse: &Tensor, gradient: &Vector<D>) -> Vector<D> {
    Vector::from_fn(|i, _| (0..D).map(|j| inverse[(j, i)] * gradient[j]).sum())
}

/// Sum over the points of V0 J p grad N with the shape functions of the displacement: the force of a nodal pressure at
/// t (Q p), N, of this rank's and the others' points.
pub fn pressing<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    pores: &PoreField<D>,
    p: &[f64],
) -> Vec<f64> {
    let at_points = scalars::scalars(&pores.shape, p, |_, value, _| value);
    let identity = K::working::<f64>(&Tensor::identity());
    let volume = problem.volume();
    let force = transfer::divergence::<K, D>(problem.shape, &problem.points.x, |p| {
        let Some(wet) = &pores.wet[p] else {
            return K::Gradient::zeros();
        };
        let chi = retained(problem.model, problem.points.material[p], wet.pressure).effective;
        identity * (volume[p] * wet.J * (chi * at_points[p]))
    });
    let mut force = problem.halo.assemble_ghosts(&force);
    problem.nodes.reduce(&mut [&mut force], problem.halo);
    force
        .iter_mut()
        .zip(&problem.nodes.free)
        .filter(|(_, free)| !**free)
        .for_each(|(force, _)| *force = 0.0);
    force
}
