//! Start of a step: transfer from material points to nodes, theory-manual equations (T2.4), (T2.5), and choice of the
//! unknowns.

use crate::background::Blocks;
use crate::boundary::absorbing::Dashpots;
use crate::boundary::contact::Contacts;
use crate::boundary::load::LoadForces;
use crate::boundary::load::{self, follower::FollowerLoads};
use crate::boundary::rigid::{RigidContacts, Surroundings};
use crate::boundary::strip;
use crate::error::StepError;
use crate::grid::{Grid, Shape, transfer};
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
use crate::step::inertia::{self, Inertia};
use crate::step::mass::Mass;
use crate::tensor::Vector;
use crate::water::carried;
use crate::water::nodes::PoreField;
use crate::water::pore_pressure::PorePressure;
use std::borrow::Cow;

/// Nodes lighter than this fraction of the heaviest one have no velocity, acceleration or average: 1/m is never formed.
const MASSLESS: f64 = 1e-14;

/// What averages run over: weights of every group of materials.
#[derive(Clone, Debug)]
struct Averages<const D: usize> {
    /// m^D (or kg)  of the nodes; `None`: those that the nodes have
    weight: Option<Vec<f64>>,
    /// weight at and below which a node has no average
    threshold: f64,
    /// of dilations under consistent and sub-grid F-bar: the splines of degree q - 1 at the points, and what they
    /// weigh; they are numbered within the nodes (see [`Shape::lowered`]), and those that no point touches weigh
    /// nothing
    lower: Option<(Shape<D>, Vec<f64>)>,
    /// m^D (or kg)  what the points weigh in averages of dilations; `None`: as in all averages
    of_points: Option<Vec<f64>>,
}

/// Nodal quantities of one step; flat arrays over the window's nodes, the same on every rank that shares a node.
#[derive(Clone, Debug)]
pub struct GridState<const D: usize> {
    /// kg (or m^D, see `Model::inertial_weighting`)  m_I = sum_p N_Ip m_p
    pub weight: Vec<f64>,
    /// present in dynamics; then `weight` is the mass
    pub inertia: Option<Inertia>,
    /// N  external force at t + dt, D numbers a node, reduced to inner functions, but for loads that follow the surface
    pub f_ext: Vec<f64>,
    /// those
    pub followers: FollowerLoads<D>,
    /// m  prescribed displacement of the step per component; `None` where it is not prescribed
    pub prescribed: Vec<Option<f64>>,
    /// per component: an unknown of the linear system
    pub free: Vec<bool>,
    /// per node: supported by an occupied cell
    pub active: Vec<bool>,
    /// nodes on faces with contact
    pub contacts: Contacts<D>,
    /// points near rigid bodies
    pub rigid: RigidContacts<D>,
    /// pore pressure that the soil carries, which friction does not act on; `None` without, or without friction
    pub pore_pressure: Option<PorePressure<D>>,
    /// of faces that absorb waves
    pub dashpots: Dashpots,
    /// nodes of one material alone, in a scene of several
    pub apart: Option<MaterialNodeSets>,
    /// pressures of the pore water, where it flows
    pub pores: Option<PoreField<D>>,
    /// soft background of the step
    pub background: Option<Blocks>,
    /// m  part of the step's displacement that the background does not resist, D numbers a node; `None`: it resists all
    pub unresisted: Option<Vec<f64>>,
    /// functions that are tied to others, where there are any
    pub extension: Option<Extension<D>>,
    /// active nodes, over all ranks
    pub active_nodes: usize,
    /// unknowns, over all ranks
    pub unknowns: usize,
    /// active nodes without mass, over all ranks
    pub massless_nodes: usize,
    /// cells with the soft background, over all ranks
    pub background_cells: usize,
    /// weight at and below which a node counts as massless
    threshold: f64,
    averages: Averages<D>,
    /// m^D  what the points weigh in the integrals of the stress; `None`: their volumes
    fitted: Option<Vec<f64>>,
}

impl<const D: usize> GridState<D> {
    /// Maps the points to the nodes for the step from `t` to `t + dt`. Fails if a load has lost its material.
    pub fn from_points<K: Kinematics<D>>(
        model: &Model<K, D>,
        shape: &Shape<D>,
        points: &Points<D>,
        interval: TimeInterval,
        halo: &dyn Halo,
    ) -> Result<Self, StepError> {
        Self::from_points_after(model, shape, points, &[], interval, halo)
    }

    /// The same after a step that had the displacement `last`, m, nodal, up to a factor: faces with contact go on as
    /// they were in it.
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
        nodes.pores = PoreField::of(model, shape, points, interval, halo)?;
        nodes.apply_contact_statuses();
        nodes.count(halo);
        Ok(nodes)
    }

    /// Nodes that the points give weight and stiffness, before bodies, faces and loads act on them.
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

    /// Points near rigid bodies in a step after one with the displacement `last`.
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

    /// Nodes on faces with contact in a step from `t`, in the statuses that the displacement `last` had.
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

    /// Dashpots of faces that absorb waves; none without inertia.
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

    /// Inertia at the start of a step of the length `dt`, s; `None` in quasi-static analysis.
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

    /// Sets the external forces at time `t`. Fails if a load has lost its material.
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

    /// The components that move: unknowns, those that statuses of contact decide, and those that are tied to others.
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

    /// Sets the tied components of a nodal displacement or its change, D numbers a node, see [`Extension::extend`].
    pub fn extend(&self, grid: &Grid<D>, u: &mut [f64], halo: &dyn Halo) {
        if let Some(extension) = &self.extension {
            extension.extend(grid, u, halo);
        }
    }

    /// Moves nodal forces, D numbers a node, from tied components to unknowns, see [`Extension::reduce`].
    pub fn reduce(&self, forces: &mut [&mut [f64]], halo: &dyn Halo) {
        if let Some(extension) = &self.extension {
            extension.reduce(forces, halo);
        }
    }

    /// Lets the background resist only what differs from the displacement `last`, D numbers a node. Outer functions
    /// take the displacement of their homes in it, since next to no stiffness holds their own.
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

    /// The part of a nodal displacement that the background resists.
    pub fn resisted<'a>(&self, u: &'a [f64]) -> Cow<'a, [f64]> {
        match &self.unresisted {
            Some(unresisted) => u.iter().zip(unresisted).map(|(u, unresisted)| u - unresisted).collect(),
            None => Cow::Borrowed(u),
        }
    }

    /// Holds, stops and frees the nodes on faces with contact as their statuses say.
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

    /// What `found` makes of S(a)_p = sum_I N_Ip a_I, for every point: a_I = 1/m_I sum_p N_Ip m_p a_p (Eqs 16, 17),
    /// zero at massless nodes, both sums over the points of one group of materials.
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

    /// What these points, which the nodes were mapped from, weigh in the integrals of the stress: m^D of the reference
    /// volume.
    #[inline]
    pub fn volume<'a>(&'a self, points: &'a Points<D>) -> &'a [f64] {
        self.fitted.as_deref().unwrap_or(&points.volume)
    }

    /// The splines of degree q - 1 that dilations are averaged with, under consistent F-bar.
    pub fn lowered(&self) -> Option<&Shape<D>> {
        self.averages.lower.as_ref().map(|(shape, _)| shape)
    }

    /// Mean of the points' dilations that F-bar puts into their place: S (Eqs 16-18), or S with the splines of degree
    /// q - 1 under consistent F-bar.
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

    /// What the points weigh in averages of dilations, m^D (or kg). Where water flows by their volumes now, as in its
    /// balance: so that the averages of ground that keeps its water are 1.
    pub fn dilation_weights<'a, K>(&'a self, model: &Model<K, D>, points: &'a Points<D>) -> &'a [f64] {
        self.averages
            .of_points
            .as_deref()
            .unwrap_or_else(|| weights(model.weighting, points))
    }

    /// The mass matrix, in dynamics.
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

    /// Counts what is reported of the nodes, over all ranks.
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
    threshold: f64, // of the weight, at and below which a projected value is zero
}

impl<const D: usize> Projection<'_, D> {
    /// Returns what `found` makes of the projected `value` at every point. `weights` are those of the points.
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
    /// `threshold` is that of the nodes' own weights.
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

/// Nodal sums of the points' `weights`, of every group of materials by itself.
fn scatter_grouped<const D: usize>(
    shape: &Shape<D>,
    grouped: GroupedPoints<'_>,
    weights: &[f64],
    halo: &dyn Halo,
) -> Vec<f64> {
    halo.assemble_ghosts(&transfer::to_nodes_grouped(shape, grouped, |p| [weights[p]]))
}

/// Per node: touched by an occupied cell, and: touched by a point with a gradient or by a background, so that its
/// stiffness is positive.
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

/// Body force (step 2d): sum_p N_Ip m_p g(t + dt), and that of still water.
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

/// Weight at and below which a node counts as massless.
fn threshold(weight: &[f64], halo: &dyn Halo) -> f64 {
    let mut heaviest = [weight.iter().copied().fold(0.0, f64::max)];
    halo.all_reduce_max(&mut heaviest);
    MASSLESS * heaviest[0]
}
