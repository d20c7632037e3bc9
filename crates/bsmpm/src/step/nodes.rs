//! Start of a step: transfer from material points to nodes, theory-manual equations (T2.4), (T2.5), and choice of the
//! unknowns.

use crate::dynamics::inertia::{self, Inertia};
use crate::dynamics::mass::Mass;
use crate::error::StepError;
use crate::field::pore_water::carried;
use crate::field::pore_water::nodes::PorePressureField;
use crate::field::pore_water::pore_pressure::PorePressure;
use crate::grid::{Grid, Shape, transfer};
use crate::interactions::absorbing::Dashpots;
use crate::interactions::background::Blocks;
use crate::interactions::contact::Contacts;
use crate::interactions::load::LoadForces;
use crate::interactions::load::{self, follower::FollowerLoads};
use crate::interactions::rigid::{RigidContacts, Surroundings};
use crate::interactions::strip;
use crate::kinematics::Kinematics;
use crate::model::{AverageWeight, Model, Regime};
use crate::nodal::Nodal;
use crate::parallel::Halo;
use crate::points::MappedPoints;
use crate::points::Points;
use crate::quadrature::{self, Quadrature};
use crate::schedule::TimeInterval;
use crate::stabilisation::GroupedPoints;
use crate::stabilisation::Stabilisation;
use crate::step::apart::MaterialNodeSets;
use crate::step::extension::Extension;
use crate::tensor::Vector;
use std::borrow::Cow;

/// Fraction of the largest nodal mass below which a node has no velocity, acceleration or average, so that 1/m stays
/// bounded.
const MASSLESS: f64 = 1e-14;

/// Weights of the averages over points, separate for each group of materials.
#[derive(Clone, Debug)]
struct Averages<const D: usize> {
    /// Weights of the nodes (m^D or kg); `None`: the weights in `GridState`.
    weight: Option<Vec<f64>>,
    /// Weight at and below which a node has no average.
    threshold: f64,
    /// Splines of degree q - 1 at the points and their nodal weights, for averages of dilations under consistent and
    /// sub-grid F-bar. Numbered like the nodes (see [`Shape::lowered`]); splines without points have zero weight.
    lower: Option<(Shape<D>, Vec<f64>)>,
    /// Weights of the points in averages of dilations (m^D or kg); `None`: as in all averages.
    of_points: Option<Vec<f64>>,
}

/// Nodal quantities of one step: flat arrays over the nodes of the window, equal on all ranks that share a node.
#[derive(Clone, Debug)]
pub struct GridState<const D: usize> {
    /// Nodal mass m_I = sum_p N_Ip m_p (kg; or nodal volume in m^D, see `Model::inertial_weighting`).
    pub weight: Vec<f64>,
    /// Inertia, in dynamics; `weight` is then the mass.
    pub inertia: Option<Inertia>,
    /// External force at the end of the step (N), D numbers per node, reduced to inner splines, without follower loads.
    pub f_ext: Vec<f64>,
    /// Follower loads.
    pub followers: FollowerLoads<D>,
    /// Prescribed displacement of the step per component (m); `None` where it is not prescribed.
    pub prescribed: Vec<Option<f64>>,
    /// Per component: whether it is an unknown of the linear system.
    pub free: Vec<bool>,
    /// Per node: whether its spline covers an occupied cell.
    pub active: Vec<bool>,
    /// Nodes on faces with contact.
    pub contacts: Contacts<D>,
    /// Material points near rigid bodies.
    pub rigid: RigidContacts<D>,
    /// Pore pressure that friction does not act on; `None` without pore pressure or without friction.
    pub pore_pressure: Option<PorePressure<D>>,
    /// Dashpots of absorbing faces.
    pub dashpots: Dashpots,
    /// Nodes that only one material touches, in a case with several materials.
    pub apart: Option<MaterialNodeSets>,
    /// Pressures of flowing pore water, if any.
    pub pores: Option<PorePressureField<D>>,
    /// Soft background of the step, if any.
    pub background: Option<Blocks>,
    /// Part of the step's displacement that the background does not resist (m), D numbers per node; `None`: it resists
    /// all.
    pub unresisted: Option<Vec<f64>>,
    /// Splines that are tied to others, if any.
    pub extension: Option<Extension<D>>,
    /// Active nodes, over all ranks.
    pub active_nodes: usize,
    /// Unknowns, over all ranks.
    pub unknowns: usize,
    /// Active nodes without mass, over all ranks.
    pub massless_nodes: usize,
    /// Cells with the artificial stiffness, over all ranks.
    pub background_cells: usize,
    /// Weight at and below which a node counts as massless.
    threshold: f64,
    averages: Averages<D>,
    /// Weights of the points in the integrals of the stress (m^D); `None`: their volumes.
    fitted: Option<Vec<f64>>,
}

impl<const D: usize> GridState<D> {
    /// Transfers the points to the nodes for a step over `interval`. Fails if a load has lost its material.
    pub fn from_points<K: Kinematics<D>>(
        model: &Model<K, D>,
        shape: &Shape<D>,
        points: &Points<D>,
        interval: TimeInterval,
        halo: &dyn Halo,
    ) -> Result<Self, StepError> {
        Self::from_points_after(model, shape, points, &[], interval, halo)
    }

    /// Transfers the points as [`Self::from_points`], after a step with the nodal displacement `last` (m, up to a
    /// factor). Faces with contact keep the statuses that follow from this displacement.
    pub fn from_points_after<K: Kinematics<D>>(
        model: &Model<K, D>,
        shape: &Shape<D>,
        points: &Points<D>,
        last: &[f64],
        interval: TimeInterval,
        halo: &dyn Halo,
    ) -> Result<Self, StepError> {
        let mut nodes = Self::of_points(model, shape, points, interval, halo);
        nodes.rigid = nodes.rigid_contacts(model, shape, points, last, interval, halo)?;
        let mut at_bodies = nodes.rigid.touched_nodes(model.grid.nodes(), halo);
        for node in strip::nodes_at(&model.boundary.strips, &model.grid, interval.start) {
            at_bodies[node] = true;
        }
        nodes.extension = Extension::of(model, shape, points, &nodes.active, &at_bodies, &mut nodes.free, halo);
        nodes.contacts = nodes.face_contacts(model, shape, points, last, interval.start, halo);
        nodes.dashpots = nodes.dashpots(model, shape, points, halo);
        nodes.inertia = nodes.start_inertia(model, shape, points, interval.dt, halo);
        nodes.load(model, shape, points, interval.end(), halo)?;
        nodes.pores = PorePressureField::of(model, shape, points, interval, halo)?;
        nodes.apply_contact_statuses();
        nodes.count(halo);
        Ok(nodes)
    }

    /// Creates nodes with weight and active cells, before bodies, faces and loads act on them.
    fn of_points<K: Kinematics<D>>(
        model: &Model<K, D>,
        shape: &Shape<D>,
        points: &Points<D>,
        interval: TimeInterval,
        halo: &dyn Halo,
    ) -> Self {
        let weight = scatter_weight(model.inertial_weighting(), shape, points, halo);
        let threshold = threshold(&weight, halo);
        let background = model
            .background
            .map(|soft| soft.blocks::<K, D>(&model.grid, shape, points, &model.materials));
        let fitted = (model.quadrature == Quadrature::Fitted)
            .then(|| quadrature::fitted::<K, D>(&model.grid, &model.boundary, shape, points, halo));
        let volume = fitted.as_deref().unwrap_or(&points.volume);
        let (active, stiff) = supported(shape, volume, background.is_some(), model.grid.nodes(), halo);
        let velocities = model.boundary.velocities(&model.grid);
        let mut free = vec![false; velocities.len()];
        for (c, free) in free.iter_mut().enumerate() {
            let node = Nodal::<D>::node(c);
            *free = velocities[c].is_none() && active[node] && (weight[node] > threshold || stiff[node]);
        }
        Self {
            apart: MaterialNodeSets::of(model.materials.len(), shape, points, model.grid.nodes(), halo),
            averages: Averages::of(model, shape, points, threshold, halo),
            pore_pressure: carried::pore_pressure(model, shape, points, volume, interval.end(), halo),
            prescribed: velocities
                .iter()
                .map(|velocity| velocity.map(|v| v * interval.dt))
                .collect(),
            pores: None,
            contacts: Contacts::default(),
            rigid: RigidContacts::default(),
            dashpots: Dashpots::default(),
            f_ext: Vec::new(),
            followers: FollowerLoads::default(),
            inertia: None,
            free,
            background,
            unresisted: None,
            extension: None,
            active_nodes: 0,
            unknowns: 0,
            massless_nodes: 0,
            background_cells: 0,
            threshold,
            weight,
            active,
            fitted,
        }
    }

    /// Finds the points near rigid bodies, in a step after one with the displacement `last` (m).
    fn rigid_contacts<K: Kinematics<D>>(
        &self,
        model: &Model<K, D>,
        shape: &Shape<D>,
        points: &Points<D>,
        last: &[f64],
        interval: TimeInterval,
        halo: &dyn Halo,
    ) -> Result<RigidContacts<D>, StepError> {
        if model.boundary.rigid.is_empty() {
            return Ok(RigidContacts::default());
        }
        let around = Surroundings {
            bodies: (&model.boundary.rigid, &points.surface.bodies),
            reaching: model.reaching(points),
            shape,
            body_force: model.body_force(interval.end()).unwrap_or_else(Vector::zeros),
            free: &self.free,
            newmark: (model.regime == Regime::Dynamic).then_some(model.newmark),
            pore_pressure: self.pore_pressure.as_ref(),
        };
        RigidContacts::of(&around, |p| model.young(points, p), interval, last, halo)
    }

    /// Finds the nodes on faces with contact in a step from `t` (s). Their statuses follow from the displacement `last`
    /// (m).
    fn face_contacts<K: Kinematics<D>>(
        &self,
        model: &Model<K, D>,
        shape: &Shape<D>,
        points: &Points<D>,
        last: &[f64],
        t: f64,
        halo: &dyn Halo,
    ) -> Contacts<D> {
        if !model.boundary.has_contact() {
            return Contacts::default();
        }
        let volume = self.volume(points);
        let water = self
            .pore_pressure
            .as_ref()
            .map(|pores| carried::forces_on_faces(pores, model, shape, points, volume, halo));
        let mapped = MappedPoints { shape, points };
        Contacts::of(model, mapped, &self.free, t, last, water.as_deref(), halo)
    }

    /// Creates the dashpots of absorbing faces; none without inertia.
    fn dashpots<K: Kinematics<D>>(
        &self,
        model: &Model<K, D>,
        shape: &Shape<D>,
        points: &Points<D>,
        halo: &dyn Halo,
    ) -> Dashpots {
        if model.regime != Regime::Dynamic || model.boundary.absorbing().next().is_none() {
            return Dashpots::default();
        }
        Dashpots::of::<K, D>(
            &model.boundary,
            &model.grid,
            shape,
            points,
            |p| model.impedance(points, p),
            &self.free,
            halo,
        )
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
        self.contacts.rest(&mut starting);
        let mass = self.mass(model, shape, points, halo);
        let mut inertia = inertia::map(&mass, points, &starting, dt, model.newmark);
        inertia.moving = self.contacts.moving(&inertia.v, dt);
        if !self.rigid.moving.is_empty() {
            inertia.moving.resize(self.rigid.moving.len(), false);
            for (moving, by_body) in inertia.moving.iter_mut().zip(&self.rigid.moving) {
                *moving |= by_body;
            }
        }
        Some(inertia)
    }

    /// Sets the external forces at time `t` (s). Fails if a load has lost its material.
    fn load<K: Kinematics<D>>(
        &mut self,
        model: &Model<K, D>,
        shape: &Shape<D>,
        points: &Points<D>,
        t: f64,
        halo: &dyn Halo,
    ) -> Result<(), StepError> {
        let mut f_ext = external_force(model, shape, points, t, &self.weight, halo);
        if let Some(force) = carried::force(model, shape, points, self.volume(points), t) {
            f_ext
                .iter_mut()
                .zip(halo.assemble_ghosts(&force))
                .for_each(|(all, force)| *all += force);
        }
        let LoadForces { dead, followers } = load::forces(
            &model.surfaces(),
            &points.surface,
            points.anchored(),
            &model.grid,
            &self.active,
            t,
            halo,
        )?;
        f_ext.iter_mut().zip(dead).for_each(|(all, force)| *all += force);
        self.reduce(&mut [&mut f_ext], halo);
        self.f_ext = f_ext;
        self.followers = followers;
        Ok(())
    }

    /// Marks components that can move: unknowns, those with a contact status, and those that are tied to others.
    pub fn movable(&self) -> Vec<bool> {
        let mut movable = self.contacts.movable(&self.free);
        if let Some(extension) = &self.extension {
            movable
                .iter_mut()
                .enumerate()
                .for_each(|(component, movable)| *movable |= extension.is_tied(component));
        }
        movable
    }

    /// Sets the tied components of a nodal displacement or its change, D numbers per node, see [`Extension::extend`].
    pub fn extend(&self, grid: &Grid<D>, u: &mut [f64], halo: &dyn Halo) {
        if let Some(extension) = &self.extension {
            extension.extend(grid, u, halo);
        }
    }

    /// Moves nodal forces, D numbers per node, from tied components to unknowns, see [`Extension::reduce`].
    pub fn reduce(&self, forces: &mut [&mut [f64]], halo: &dyn Halo) {
        if let Some(extension) = &self.extension {
            extension.reduce(forces, halo);
        }
    }

    /// Limits the background's resistance to the difference from the displacement `last` (m, D numbers per node). In
    /// `last`, outer splines take the values that their homes imply, because their own have next to no stiffness.
    pub fn resist_change_from(&mut self, last: &[f64], grid: &Grid<D>, halo: &dyn Halo) {
        let mut unresisted = last.to_vec();
        let inactive = self.active.iter().enumerate().filter(|(_, active)| !**active);
        inactive.for_each(|(node, _)| unresisted[Nodal::<D>::of(node)].fill(0.0));
        if let Some(extension) = &self.extension {
            extension.drop_loose(&mut unresisted);
            extension.extend(grid, &mut unresisted, halo);
        }
        self.unresisted = Some(unresisted);
    }

    /// Returns the part of a nodal displacement that the background resists (m).
    pub fn resisted<'a>(&self, u: &'a [f64]) -> Cow<'a, [f64]> {
        match &self.unresisted {
            Some(unresisted) => u.iter().zip(unresisted).map(|(u, unresisted)| u - unresisted).collect(),
            None => Cow::Borrowed(u),
        }
    }

    /// Fixes, stops or frees the nodes on faces with contact according to their statuses.
    pub fn apply_contact_statuses(&mut self) {
        self.contacts.apply(&mut self.free, &mut self.prescribed);
        if let Some(inertia) = &mut self.inertia {
            inertia.stopped = inertia
                .moving
                .iter()
                .zip(&self.free)
                .map(|(moving, free)| *moving && !free)
                .collect();
            inertia
                .stopped
                .iter_mut()
                .zip(&self.rigid.moving)
                .for_each(|(stopped, by_body)| *stopped |= by_body);
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
        self.fitted.as_deref().unwrap_or(&points.volume)
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

    /// Returns the weights of the points in averages of dilations (m^D or kg). With flowing water they are multiplied
    /// by J, as in the water balance, so that the average is 1 for soil that keeps its water.
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
        let Self { weight, threshold, .. } = self;
        Mass {
            matrix: model.mass,
            shape,
            of_points: &points.mass,
            lumped: weight,
            threshold: *threshold,
            halo,
        }
    }

    /// Counts active nodes, unknowns, massless nodes and background cells over all ranks. One reduction.
    pub fn count(&mut self, halo: &dyn Halo) {
        let owned = halo.owned();
        let active = owned.nodes().filter(|&node| self.active[node]);
        let massless = active.clone().filter(|&node| self.weight[node] <= self.threshold);
        let unknowns = owned.places::<D>().filter(|&place| self.free[place]);
        let mut counts = [
            active.count() as f64,
            unknowns.count() as f64,
            massless.count() as f64,
            self.background.as_ref().map_or(0, Blocks::count) as f64,
        ];
        halo.all_reduce_sum(&mut counts);
        [
            self.active_nodes,
            self.unknowns,
            self.massless_nodes,
            self.background_cells,
        ] = counts.map(|count| count as usize);
    }
}

/// Lumped L2 projection onto the splines of `shape` (Eqs 16, 17).
struct Projection<'a, const D: usize> {
    shape: &'a Shape<D>,
    weight: &'a [f64],
    threshold: f64, // weight at and below which a projected value is zero
}

impl<const D: usize> Projection<'_, D> {
    /// Returns `found(p, mean)` with the projected `value` at every point p. `weights` are those of the points.
    fn average<const C: usize, T: Clone + Send>(
        &self,
        grouped: GroupedPoints<'_>,
        weights: &[f64],
        halo: &dyn Halo,
        value: impl Fn(usize) -> [f64; C] + Sync,
        found: impl Fn(usize, [f64; C]) -> T + Sync,
    ) -> Vec<T> {
        let mut nodal = halo.assemble_ghosts(&transfer::to_nodes_grouped(self.shape, grouped, |p| {
            value(p).map(|v| weights[p] * v)
        }));
        transfer::divide(&mut nodal, self.weight, self.threshold);
        transfer::to_points_grouped(self.shape, grouped, &nodal, found)
    }
}

impl<const D: usize> Averages<D> {
    /// Computes the weights. `threshold` is that of the nodes' own weights.
    fn of<K>(model: &Model<K, D>, shape: &Shape<D>, points: &Points<D>, threshold: f64, halo: &dyn Halo) -> Self {
        let weights = weights(model.weighting, points);
        let grouped = model.grouped(points);
        let flows = model.water.as_ref().is_some_and(|water| water.flow.is_some());
        let of_points: Option<Vec<f64>> = (flows && model.stabilisation.lowers()).then(|| {
            weights
                .iter()
                .zip(points.F.iter())
                .map(|(weight, F)| weight * F.determinant())
                .collect()
        });
        let lower = model.stabilisation.lowers().then(|| {
            let mut lower = shape.lowered(&model.grid, points);
            if model.stabilisation == Stabilisation::SubgridFBar {
                lower = lower.merged(&model.grid, grouped, halo);
            }
            let weight = scatter_grouped(&lower, grouped, of_points.as_deref().unwrap_or(weights), halo);
            (lower, weight)
        });
        let own = grouped.count() > 1 || model.weighting != model.inertial_weighting();
        let of_nodes = (model.stabilisation.averages() && own).then(|| scatter_grouped(shape, grouped, weights, halo));
        Self {
            threshold: of_nodes
                .as_ref()
                .map_or(threshold, |weight| self::threshold(weight, halo)),
            weight: of_nodes,
            lower,
            of_points,
        }
    }
}

fn weights<const D: usize>(weighting: AverageWeight, points: &Points<D>) -> &[f64] {
    match weighting {
        AverageWeight::Mass => &points.mass,
        AverageWeight::Volume => &points.volume,
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

/// Sums the points' `weights` at the nodes, separately for each group of materials.
fn scatter_grouped<const D: usize>(
    shape: &Shape<D>,
    grouped: GroupedPoints<'_>,
    weights: &[f64],
    halo: &dyn Halo,
) -> Vec<f64> {
    halo.assemble_ghosts(&transfer::to_nodes_grouped(shape, grouped, |p| [weights[p]]))
}

/// Marks nodes that are touched by an occupied cell, and nodes with positive stiffness: touched by a point with a
/// gradient, or by a background.
fn supported<const D: usize>(
    shape: &Shape<D>,
    volume: &[f64],
    has_background: bool,
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
        .map(|(stiff, touched)| *stiff > above || (has_background && *touched))
        .collect();
    (touched, stiff)
}

/// Computes the body force (step 2d), sum_p N_Ip m_p g(t + dt), and the force of hydrostatic water (N).
fn external_force<K: Kinematics<D>, const D: usize>(
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
    if let Some(water) = model.still_water(t) {
        let force = halo.assemble_ghosts(&transfer::to_nodes(shape, |p| {
            <[f64; D]>::from(water.force(points, p, model.span(points, p), model.follows_water(points, p)))
        }));
        f_ext.iter_mut().zip(force).for_each(|(all, force)| *all += force);
    }
    f_ext
}

/// Returns the weight at and below which a node counts as massless.
fn threshold(weight: &[f64], halo: &dyn Halo) -> f64 {
    let mut heaviest = [weight.iter().copied().fold(0.0, f64::max)];
    halo.all_reduce_max(&mut heaviest);
    MASSLESS * heaviest[0]
}
