//! Start of a step: transfer from material points to nodes, theory-manual equations (T2.4), (T2.5), and choice of the
//! unknowns.

use crate::dynamics::inertia::{self, Inertia};
use crate::dynamics::mass::Mass;
use crate::error::StepError;
use crate::field::{SecondField, add_forces, pore_pressure};
use crate::grid::{Shape, transfer};
use crate::interactions::state::InteractionState;
use crate::interactions::{Interactions, StepContext, StepInput, StepStart};
use crate::kinematics::Kinematics;
use crate::model::{AverageWeight, Model, Regime};
use crate::nodal::Nodal;
use crate::parallel::Halo;
use crate::points::{MappedPoints, Points};
use crate::quadrature::{self, Quadrature};
use crate::schedule::TimeInterval;
use crate::step::apart::MaterialNodeSets;
use crate::step::averages::{Averages, MASSLESS, Projection, threshold, weights};
use crate::step::constraints::Constraints;
use crate::step::extension::Extension;
use std::borrow::Cow;

/// Nodal quantities of one step: flat arrays over the nodes of the window, equal on all ranks that share a node.
#[derive(Debug)]
pub struct GridState<const D: usize> {
    /// Nodal mass m_I = sum_p N_Ip m_p (kg; or nodal volume in m^D, see `Model::inertial_weighting`).
    pub weight: Vec<f64>,
    /// Inertia, in dynamics; `weight` is then the mass.
    pub inertia: Option<Inertia>,
    /// External force at the end of the step (N), D numbers per node, reduced to inner splines, without follower loads.
    pub f_ext: Vec<f64>,
    /// Choice of the unknowns.
    pub constraints: Constraints<D>,
    /// Whatever acts on the nodes besides the stress of the material points.
    pub interactions: Interactions<D>,
    /// Second field, if there is one.
    pub field: Option<SecondField<D>>,
    averages: Averages<D>,
}

impl<const D: usize> GridState<D> {
    /// Transfers the points to the nodes for a step over `interval`, at whose start the interactions have the `state`.
    /// Fails if a load has lost its material.
    pub fn from_points<K: Kinematics<D>>(
        model: &Model<K, D>,
        shape: &Shape<D>,
        points: &Points<D>,
        state: &InteractionState<D>,
        interval: TimeInterval,
        halo: &dyn Halo,
    ) -> Result<Self, StepError> {
        Self::from_points_after(model, shape, points, StepInput::over(interval, state), halo)
    }

    /// Transfers the points as [`Self::from_points`], after what precedes the step. Faces with contact keep the
    /// statuses that follow from the last displacement, and the artificial stiffness resists the displacement or its
    /// change.
    pub fn from_points_after<K: Kinematics<D>>(
        model: &Model<K, D>,
        shape: &Shape<D>,
        points: &Points<D>,
        input: StepInput<'_, D>,
        halo: &dyn Halo,
    ) -> Result<Self, StepError> {
        let interval = input.interval;
        let mut nodes = Self::of_points(model, shape, points, interval, halo);
        let volume = nodes.volume(points);
        let pore_pressure = pore_pressure(model, shape, points, volume, interval.end(), halo);
        nodes.interactions = Interactions::begin(&StepStart {
            model,
            shape,
            points,
            volume,
            constraints: &nodes.constraints,
            pore_pressure: pore_pressure.as_ref(),
            input,
            halo,
        })?;
        nodes.tie(model, shape, points, input, halo);
        nodes.inertia = nodes.start_inertia(model, shape, points, interval.dt, halo);
        nodes.load(model, shape, points, interval.end(), halo);
        nodes.field = SecondField::of(model, shape, points, input.state, interval, halo)?;
        nodes.apply_statuses();
        nodes.count(halo);
        Ok(nodes)
    }

    /// Creates nodes with weight and active cells, before anything acts on them.
    fn of_points<K: Kinematics<D>>(
        model: &Model<K, D>,
        shape: &Shape<D>,
        points: &Points<D>,
        interval: TimeInterval,
        halo: &dyn Halo,
    ) -> Self {
        let weight = scatter_weight(model.inertial_weighting(), shape, points, halo);
        let massless = threshold(&weight, halo);
        let fitted = (model.quadrature == Quadrature::Fitted)
            .then(|| quadrature::fitted::<K, D>(&model.grid, &model.boundary, shape, points, halo));
        let volume = fitted.as_deref().unwrap_or(&points.volume);
        let (active, stiff) = supported(
            shape,
            volume,
            model.artificial_stiffness.is_some(),
            model.grid.nodes(),
            halo,
        );
        let velocities = model.boundary.velocities(&model.grid);
        let mut free = vec![false; velocities.len()];
        for (c, free) in free.iter_mut().enumerate() {
            let node = Nodal::<D>::node(c);
            *free = velocities[c].is_none() && active[node] && (weight[node] > massless || stiff[node]);
        }
        let prescribed = velocities.iter().map(|velocity| velocity.map(|v| v * interval.dt));
        let mut constraints = Constraints::new(active, prescribed.collect(), free);
        constraints.apart = MaterialNodeSets::of(model.materials.len(), shape, points, model.grid.nodes(), halo);
        let averages = Averages::of(model, shape, points, massless, halo);
        Self {
            averages: Averages { fitted, ..averages },
            constraints,
            interactions: Interactions::default(),
            field: None,
            f_ext: Vec::new(),
            inertia: None,
            weight,
        }
    }

    /// Ties splines of nearly empty cells to others, and lets the interactions take note of the unknowns.
    fn tie<K: Kinematics<D>>(
        &mut self,
        model: &Model<K, D>,
        shape: &Shape<D>,
        points: &Points<D>,
        input: StepInput<'_, D>,
        halo: &dyn Halo,
    ) {
        let mut untied = vec![false; model.grid.nodes()];
        let context = self.context(model, shape, points, halo);
        for interaction in self.interactions.iter() {
            interaction.mark_untied(&context, input.interval, &mut untied);
        }
        let Constraints { active, free, .. } = &mut self.constraints;
        let extension = Extension::of(model, shape, points, active, &untied, free, halo);
        self.constraints.extension = extension;
        let context = StepContext {
            boundary: &model.boundary,
            grid: &model.grid,
            shape,
            points,
            constraints: &self.constraints,
            inertia: None,
            halo,
        };
        for interaction in self.interactions.iter_mut() {
            interaction.note_unknowns(&context, input.last);
        }
    }

    /// Returns the data of the step that interactions use.
    pub fn context<'a, K>(
        &'a self,
        model: &'a Model<K, D>,
        shape: &'a Shape<D>,
        points: &'a Points<D>,
        halo: &'a dyn Halo,
    ) -> StepContext<'a, D> {
        StepContext {
            boundary: &model.boundary,
            grid: &model.grid,
            shape,
            points,
            constraints: &self.constraints,
            inertia: self.inertia.as_ref(),
            halo,
        }
    }

    /// Returns the inertia at the start of a step of size `dt` (s); `None` in quasi-static analysis.
    fn start_inertia<K>(
        &self,
        model: &Model<K, D>,
        shape: &Shape<D>,
        points: &Points<D>,
        dt: f64,
        halo: &dyn Halo,
    ) -> Option<Inertia> {
        if model.regime != Regime::Dynamic {
            return None;
        }
        let mut starting = model.boundary.velocities(&model.grid);
        for interaction in self.interactions.iter() {
            interaction.hold_at_rest(&mut starting);
        }
        let mass = self.mass(model, shape, points, halo);
        let mut inertia = inertia::map(&mass, points, &starting, dt, model.newmark);
        for interaction in self.interactions.iter() {
            interaction.mark_moving(&inertia.v, dt, &mut inertia.moving);
        }
        Some(inertia)
    }

    /// Sets the external forces at time `t` (s).
    fn load<K: Kinematics<D>>(
        &mut self,
        model: &Model<K, D>,
        shape: &Shape<D>,
        points: &Points<D>,
        t: f64,
        halo: &dyn Halo,
    ) {
        let mut f_ext = body_force(model, shape, points, t, &self.weight, halo);
        let mapped = MappedPoints { shape, points };
        add_forces(model, mapped, self.volume(points), t, &mut f_ext, halo);
        for interaction in self.interactions.iter() {
            let force = interaction.constant_force();
            f_ext.iter_mut().zip(force).for_each(|(all, force)| *all += force);
        }
        self.constraints.reduce(&mut [&mut f_ext], halo);
        let mut f_ext = Cow::Owned(f_ext);
        let context = self.context(model, shape, points, halo);
        self.interactions.add_forces_at_rest(&context, &mut f_ext);
        self.f_ext = f_ext.into_owned();
    }

    /// Fixes, stops or frees components according to the statuses of the interactions.
    pub fn apply_statuses(&mut self) {
        let Constraints { free, prescribed, .. } = &mut self.constraints;
        for interaction in self.interactions.iter() {
            interaction.apply_statuses(free, prescribed);
        }
        if let Some(inertia) = &mut self.inertia {
            let moving = inertia.moving.iter().zip(&self.constraints.free);
            inertia.stopped = moving.map(|(moving, free)| *moving && !free).collect();
            for interaction in self.interactions.iter() {
                interaction.mark_stopped(&mut inertia.stopped);
            }
        }
    }

    /// Projects the values of the points to nodes and back: S(a)_p = sum_I N_Ip a_I with a_I = 1/m_I sum_p N_Ip m_p a_p
    /// (Eqs 16, 17), a_I = 0 at massless nodes. Both sums run over one group of materials. Returns `found(p, S(a)_p)`
    /// for every point.
    pub fn average<K, const C: usize, T: Clone + Send>(
        &self,
        model: &Model<K, D>,
        shape: &Shape<D>,
        points: &Points<D>,
        halo: &dyn Halo,
        value: impl Fn(usize) -> [f64; C] + Sync,
        found: impl Fn(usize, [f64; C]) -> T + Sync,
    ) -> Vec<T> {
        let projection = Projection {
            shape,
            weight: self.averages.weight.as_ref().unwrap_or(&self.weight),
            threshold: self.averages.threshold,
        };
        let weights = weights(model.weighting, points);
        projection.average(model.grouped(points), weights, halo, value, found)
    }

    /// Returns the weights of `points` in the integrals of the stress (m^D of reference volume). The nodes must have
    /// been created from the same points.
    #[inline]
    pub fn volume<'a>(&'a self, points: &'a Points<D>) -> &'a [f64] {
        self.averages.fitted.as_deref().unwrap_or(&points.volume)
    }

    /// Returns the splines of degree q - 1 that average dilations under consistent and sub-grid F-bar.
    pub fn lowered(&self) -> Option<&Shape<D>> {
        self.averages.lower.as_ref().map(|(shape, _)| shape)
    }

    /// Returns the mean dilation that F-bar uses at every point: S (Eqs 16-18), under consistent and sub-grid F-bar
    /// with splines of degree q - 1.
    pub fn mean_dilation<K>(
        &self,
        model: &Model<K, D>,
        shape: &Shape<D>,
        points: &Points<D>,
        halo: &dyn Halo,
        value: impl Fn(usize) -> f64 + Sync,
    ) -> Vec<f64> {
        match &self.averages.lower {
            Some((shape, weight)) => {
                let projection = Projection {
                    shape,
                    weight,
                    threshold: self.averages.threshold,
                };
                let weights = self.dilation_weights(model, points);
                projection.average(model.grouped(points), weights, halo, |p| [value(p)], |_, [mean]| mean)
            }
            None => self.average(model, shape, points, halo, |p| [value(p)], |_, [mean]| mean),
        }
    }

    /// Returns the weights of the points in averages of dilations (m^D or kg). With a second field they are multiplied
    /// by J, as in its balance, so that the average is 1 for material that keeps its content.
    pub fn dilation_weights<'a, K>(&'a self, model: &Model<K, D>, points: &'a Points<D>) -> &'a [f64] {
        self.averages
            .of_points
            .as_deref()
            .unwrap_or_else(|| weights(model.weighting, points))
    }

    /// Returns the mass matrix (for dynamics).
    pub fn mass<'a, K>(
        &'a self,
        model: &Model<K, D>,
        shape: &'a Shape<D>,
        points: &'a Points<D>,
        halo: &'a dyn Halo,
    ) -> Mass<'a, D> {
        Mass {
            matrix: model.mass,
            shape,
            of_points: &points.mass,
            lumped: &self.weight,
            threshold: self.averages.massless,
            halo,
        }
    }

    /// Counts active nodes, unknowns and massless nodes over all ranks. One reduction.
    pub fn count(&mut self, halo: &dyn Halo) {
        let constraints = &mut self.constraints;
        let owned = halo.owned();
        let active = owned.nodes().filter(|&node| constraints.active[node]);
        let massless = active
            .clone()
            .filter(|&node| self.weight[node] <= self.averages.massless);
        let unknowns = owned.places::<D>().filter(|&place| constraints.free[place]);
        let mut counts = [active.count() as f64, unknowns.count() as f64, massless.count() as f64];
        halo.all_reduce_sum(&mut counts);
        [
            constraints.active_nodes,
            constraints.unknowns,
            constraints.massless_nodes,
        ] = counts.map(|count| count as usize);
    }
}

fn scatter_weight<const D: usize>(
    weighting: AverageWeight,
    shape: &Shape<D>,
    points: &Points<D>,
    halo: &dyn Halo,
) -> Vec<f64> {
    let weights = weights(weighting, points);
    halo.assemble_ghosts(&transfer::to_nodes(shape, |p| [weights[p]]))
}

/// Marks nodes that are touched by an occupied cell, and nodes with positive stiffness: touched by a point with a
/// gradient, or in a cell with the artificial stiffness.
fn supported<const D: usize>(
    shape: &Shape<D>,
    volume: &[f64],
    has_artificial_stiffness: bool,
    nodes: usize,
    halo: &dyn Halo,
) -> (Vec<bool>, Vec<bool>) {
    let mut touched = vec![0.0_f64; nodes];
    for patch in shape.patches() {
        shape
            .offsets()
            .iter()
            .for_each(|offset| touched[patch.first_node + offset] = 1.0);
    }
    halo.ghost_max(&mut touched, 1);
    let touched: Vec<bool> = touched.into_iter().map(|mark| mark > 0.0).collect();
    let stiff = halo.assemble_ghosts(&transfer::squared_gradients(shape, |p| volume[p]));
    let mut stiffest = [stiff.iter().copied().fold(0.0, f64::max)];
    halo.all_reduce_max(&mut stiffest);
    let above = MASSLESS * stiffest[0];
    let stiff = stiff
        .iter()
        .zip(&touched)
        .map(|(stiff, touched)| *stiff > above || (has_artificial_stiffness && *touched))
        .collect();
    (touched, stiff)
}

/// Computes the body force (step 2d), sum_p N_Ip m_p g(t + dt) (N).
fn body_force<K: Kinematics<D>, const D: usize>(
    model: &Model<K, D>,
    shape: &Shape<D>,
    points: &Points<D>,
    t: f64,
    weight: &[f64],
    halo: &dyn Halo,
) -> Vec<f64> {
    let mut f_ext = vec![0.0; weight.len() * D];
    if let Some(g) = model.body_force(t) {
        let own;
        let mass = match model.inertial_weighting() {
            AverageWeight::Mass => weight,
            AverageWeight::Volume => {
                own = scatter_weight(AverageWeight::Mass, shape, points, halo);
                &own
            }
        };
        for (force, mass) in f_ext.chunks_exact_mut(D).zip(mass) {
            for component in 0..D {
                force[component] = mass * g[component];
            }
        }
    }
    f_ext
}
