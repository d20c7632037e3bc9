//! Derivatives of the water balance, theory-manual equation (T8.9), and of the pore pressure in (T8.6), for Newton's
//! method.
//!
//! A displacement v and a pressure change `δp` change the volume ratio J, the pressure gradient and the Darcy flux w as
//! follows. dF is the deformation gradient of the step, and l = (grad v) dF^-1:
//!
//! ```text
//! δJ = J tr l
//! δ(dF^-T grad p) = dF^-T grad δp - l^T dF^-T grad p
//! δ(J dF^-1 w) = J dF^-1 (tr l w - l w + δw)
//! ```

use crate::field::pore_water::nodes::{FlowPoint, PorePressureField};
use crate::field::pore_water::residual::{ExcessPressure, FlowState, pushed};
use crate::grid::transfer::scalars;
use crate::kinematics::{Gradient, Kinematics};
use crate::model::Model;
use crate::step::problem::Problem;
use crate::step::trial::DeformationIncrement;
use crate::tensor::{Tensor, Vector};

/// Tangent of the water balance at one state.
pub struct WaterTangent<'a, const D: usize> {
    pores: &'a PorePressureField<D>,
    p: &'a [f64], // nodal excess pressures (Pa)
    points: Vec<Option<Change<D>>>,
}

/// Derivatives at a point with pore-water flow.
#[derive(Clone)]
struct Change<const D: usize> {
    inverse: Tensor, // dF^-1
    J: f64,
    stored: (f64, f64),          // per reference volume, by tr l (-) and by the pressure (1/Pa)
    w: Vector<D>,                // Darcy flux (m/s)
    now: Vector<D>,              // dF^-T grad p (Pa/m)
    conducts: Vector<D>,         // k k_r/gamma_w (m/s per Pa/m)
    relative: (f64, f64),        // of w, by d ln J-bar (-) and by the pressure (1/Pa)
    tau: (Vector<D>, Vector<D>), // stabilisation, by the pressure gradient and by the pressure
    presses: f64,                // d(J chi p)/dp (-)
}

/// Changes of storage and flux at a point for a change of displacements and pressures.
pub struct FlowChange<const D: usize> {
    /// Change of the stored volume (m3).
    pub stored: f64,
    /// Change of the flow in the step and of the stabilisation term (m3 m).
    pub flux: Vector<D>,
}

impl<'a, const D: usize> WaterTangent<'a, D> {
    /// Linearises the balance at the nodal excess pressures `p` (Pa).
    pub fn at<K: Kinematics<D>>(
        problem: &Problem<'_, K, D>,
        pores: &'a PorePressureField<D>,
        trial: &DeformationIncrement<K, D>,
        p: &'a [f64],
    ) -> Self {
        let points = scalars::scalars(&pores.shape, p, |p, value, gradient| {
            let wet = pores.wet[p].as_ref()?;
            let dilation = trial.dilation(problem.points, p);
            let excess = ExcessPressure { value, gradient };
            let state = FlowState::at(problem.model, problem.points, p, wet, &trial.dF(p), dilation, excess)?;
            Change::at(
                problem.model,
                problem.points.material[p],
                wet,
                state,
                dilation,
                gradient,
            )
        });
        Self { pores, p, points }
    }

    /// Returns the change of the water balance (m3, nodal; zero where the pressure is not an unknown). `grad` are the
    /// gradients of the displacement change, `averaged` the resulting changes of ln(J-bar/J) with F-bar, `v` the change
    /// of the nodal pressures (Pa), and `pressures` its values at the points. One exchange with the neighbours.
    pub fn multiply<K: Kinematics<D>>(
        &self,
        problem: &Problem<'_, K, D>,
        grad: &[K::Gradient],
        averaged: Option<&[f64]>,
        pressures: &[ExcessPressure<D>],
        v: &[f64],
    ) -> Vec<f64> {
        let pores = self.pores;
        let mut sums = scalars::of_scalars(&pores.shape, |p| {
            let none = (0.0, Vector::zeros());
            let Some((change, wet)) = self.points[p].as_ref().zip(pores.wet[p].as_ref()) else {
                return [none];
            };
            let l = K::gradient::<f64>(&grad[p]) * change.inverse;
            let averaged = averaged.map_or(0.0, |rate| rate[p]);
            let FlowChange { stored, flux } = change.of(&l, averaged, pressures[p], wet, pores.duration);
            [(stored, flux)]
        });
        pores.drainage.add_changes(self.p, v, &mut sums);
        let mut sums = problem.halo.assemble_ghosts(&sums);
        pores.ties.add_to(v, &mut sums, |node| node);
        sums.iter_mut()
            .zip(&pores.free)
            .filter(|(_, free)| !**free)
            .for_each(|(sum, _)| *sum = 0.0);
        sums
    }

    /// Returns the changes of pressure and its gradient at the points for a change `v` of the nodal pressures (Pa).
    pub fn pressures(&self, v: &[f64]) -> Vec<ExcessPressure<D>> {
        scalars::scalars(&self.pores.shape, v, |_, value, gradient| ExcessPressure {
            value,
            gradient,
        })
    }

    /// Returns the change of stress, work-conjugate to the displacement gradient, per volume for the pressure `change`
    /// (Pa) at point `p`.
    pub fn pressed<K: Kinematics<D>>(&self, p: usize, change: f64) -> K::Gradient {
        self.points[p].as_ref().map_or_else(K::Gradient::zeros, |at| {
            K::working::<f64>(&at.inverse.transpose()) * (-at.presses * change)
        })
    }
}

impl<const D: usize> Change<D> {
    /// Linearises the `state` of a point of a material for the excess pressure gradient of the trial (Pa/m).
    fn at<K>(
        model: &Model<K, D>,
        material: u16,
        wet: &FlowPoint<D>,
        state: FlowState<D>,
        dilation: f64,
        gradient: Vector<D>,
    ) -> Option<Self> {
        let water = model.water.as_ref()?;
        let flow = water.flow.as_ref()?;
        let soil = flow.soils[usize::from(material)].as_ref()?;
        let FlowState {
            J,
            whole,
            retained,
            lumped,
            ..
        } = state;
        let change = soil.retained_change(wet.pressure, whole, water.unit_weight);
        let denser = (whole / flow.bulk).exp();
        let content = soil.content(flow.bulk, J, whole);
        let stored = (
            denser * retained.saturation * J,
            content * (retained.saturation / flow.bulk + retained.slope),
        );
        let by_volume = soil
            .permeability
            .as_ref()
            .map_or(0.0, |law| law.law.relative_change(soil.porosity, J * dilation));
        Some(Self {
            inverse: state.inverse,
            J,
            stored,
            w: state.w,
            now: state.gradient,
            conducts: state.permeability * (retained.permeability / water.unit_weight),
            relative: (by_volume, change.permeability / retained.permeability),
            tau: (
                wet.tau * lumped,
                wet.tau_of(gradient) * (wet.lumps(soil) * change.chord),
            ),
            presses: J * (retained.effective + change.effective * whole),
        })
    }

    fn of(
        &self,
        l: &Tensor,
        averaged: f64,
        excess: ExcessPressure<D>,
        wet: &FlowPoint<D>,
        duration: f64,
    ) -> FlowChange<D> {
        let ExcessPressure {
            value: pressure,
            gradient,
        } = excess;
        let trace = l.trace();
        // l^T dF^-T grad p, see the head of the module.
        let turned = Vector::from_fn(|i, _| (0..D).map(|j| l[(j, i)] * self.now[j]).sum::<f64>());
        let now = pushed(&self.inverse, &gradient) - turned;
        let relative = self.relative.0 * (trace + averaged) + self.relative.1 * pressure;
        // J dF^-1 (tr l w - l w + δw) with δw = w (δ ln k + δ ln k_r) - k k_r/gamma_w δ(dF^-T grad p).
        let w = self.w * (relative + trace) - now.component_mul(&self.conducts);
        let w = w - Vector::from_fn(|i, _| (0..D).map(|j| l[(i, j)] * self.w[j]).sum::<f64>());
        let flux = Vector::from_fn(|i, _| self.J * (0..D).map(|j| self.inverse[(i, j)] * w[j]).sum::<f64>());
        let stored = wet.volume * (self.stored.0 * trace + self.stored.1 * pressure);
        let tau = self.tau.0.component_mul(&gradient) + self.tau.1 * pressure;
        FlowChange {
            stored,
            flux: tau - flux * (duration * wet.volume),
        }
    }
}
