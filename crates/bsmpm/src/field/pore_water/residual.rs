//! Water balance at the nodes, theory-manual equation (T8.9), Darcy flux (T8.7), and pore pressure in the Kirchhoff
//! stress (T8.6).

use crate::field::pore_water::nodes::{FlowPoint, PorePressureField};
use crate::field::pore_water::retention::RetentionState;
use crate::grid::transfer::{self, scalars};
use crate::kinematics::{Gradient, Kinematics};
use crate::model::Model;
use crate::parallel::over_layers;
use crate::points::Points;
use crate::step::problem::Problem;
use crate::step::trial::DeformationIncrement;
use crate::tensor::{Tensor, Vector};
use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering::Relaxed;

/// Terms of the balance at a node: storage, flow, stabilisation, and drains with inflows.
const TERMS: usize = 4;
/// Index of the flow among the terms.
const FLOWS: usize = 1;

/// Out-of-balance water volume, nodal (m3).
#[derive(Clone, Debug, Default)]
pub struct WaterBalance {
    /// Residual R: stored volume less inflow; zero where the pressure is not an unknown.
    pub excess: Vec<f64>,
    /// Outflow -R at faces with a prescribed pressure; zero elsewhere.
    pub out: Vec<f64>,
    /// Norm |R|.
    pub norm: f64,
    /// Largest of the norms of storage, flow, and water through surfaces.
    pub scale: f64,
    /// Sum of R, the error in conservation of volume.
    pub left: f64,
    /// Number of points with closed pores, over all ranks.
    pub closed: u64,
    /// Whether all norms are finite.
    pub finite: bool,
}

impl WaterBalance {
    /// Computes the balance for nodal excess pressures `p` (Pa; empty: zero) and the deformation of `trial`, and stores
    /// the pore-pressure term J p of the Kirchhoff stress in `trial`. One exchange with the neighbours and one
    /// reduction.
    pub fn of<K: Kinematics<D>, const D: usize>(
        problem: &Problem<'_, K, D>,
        pores: &PorePressureField<D>,
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
            let dilation = trial.dilation(points, p);
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
        trial.field_pressure = Some(of_points(problem, pores, trial, &pressures));
        let mut sums = halo.assemble_ghosts(&sums);
        pores.ties.add_to(p, &mut sums, |node| node * TERMS + FLOWS);
        Self::at_nodes(problem, pores, &sums, closed.into_inner())
    }

    fn at_nodes<K, const D: usize>(
        problem: &Problem<'_, K, D>,
        pores: &PorePressureField<D>,
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
}

/// Returns the pore-pressure term of the Kirchhoff stress, J (chi p - p_b), of every point (Pa). p_b is the part of the
/// hydrostatic pressure that acts as a separate nodal force.
fn of_points<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    pores: &PorePressureField<D>,
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

/// Returns the retention state of a material under the whole pore pressure `p` (Pa).
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
    /// Excess pore pressure (Pa).
    pub value: f64,
    /// Gradient with respect to the position at the start of the step (Pa/m).
    pub gradient: Vector<D>,
}

/// Pore water of a point in the trial state.
#[derive(Clone)]
pub struct FlowState<const D: usize> {
    /// Pore volume per reference volume, computed with J-bar as the stress of the skeleton (-).
    pub pores: f64,
    /// Water content per reference volume (-).
    pub content: f64,
    /// Darcy flux J dF^-1 w pulled back to the start of the step and multiplied by J (m/s).
    pub flux: Vector<D>,
    /// Darcy flux w relative to the skeleton (m/s).
    pub w: Vector<D>,
    /// Gradient of the excess pressure with respect to the present position (Pa/m).
    pub gradient: Vector<D>,
    /// Factor of the stabilisation term: 1 plus the lumped storage of pores that fill or empty (-).
    pub lumped: f64,
    /// Saturated permeability along the axes; zero without flow (m/s).
    pub permeability: Vector<D>,
    /// Retention state of the pores.
    pub retained: RetentionState,
    /// Whole pore pressure; the excess pressure if no soil retains water (Pa).
    pub whole: f64,
    /// Volume ratio J at the end of the step (-).
    pub J: f64,
    /// Inverse dF^-1 of the deformation gradient of the step.
    pub inverse: Tensor,
}

impl<const D: usize> FlowState<D> {
    /// Computes the pore water of a point for the deformation gradient `dF` of the step, the ratio `dilation` = J-bar/J
    /// at the end of the step, and its excess pressure. Returns `None` if dF has no inverse.
    #[inline]
    pub fn at<K>(
        model: &Model<K, D>,
        points: &Points<D>,
        p: usize,
        wet: &FlowPoint<D>,
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

/// Returns dF^-T times a gradient.
pub fn pushed<const D: usize>(inverse: &Tensor, gradient: &Vector<D>) -> Vector<D> {
    Vector::from_fn(|i, _| (0..D).map(|j| inverse[(j, i)] * gradient[j]).sum())
}

/// Returns the nodal force Q p of nodal pressures `p` (Pa) at the start of the step (N), the sum over all ranks: sum
/// over points of V0 J chi p grad N with the functions N of the displacements. One exchange with the neighbours.
pub fn pressing<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    pores: &PorePressureField<D>,
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
    problem.nodes.constraints.reduce(&mut [&mut force], problem.halo);
    force
        .iter_mut()
        .zip(&problem.nodes.constraints.free)
        .filter(|(_, free)| !**free)
        .for_each(|(force, _)| *force = 0.0);
    force
}
