//! Start of a step: transfer from material points to nodes, theory-manual equations (T2.4), (T2.5), and choice of the
//! unknowns.

use crate::background::Blocks;
use crate::boundary::absorbing::Dashpots;
use crate::boundary::contact::Contacts;
use crate::boundary::load::{self, follower::FollowerLoads};
use crate::boundary::rigid::{RigidContacts, Surroundings};
use crate::boundary::strip;
use crate::error::StepError;
use crate::grid::{Grid, Shape, transfer};
use crate::kinematics::Kinematics;
use crate::model::{Model, Regime, Weighting};
use crate::nodal::Nodal;
use crate::parallel::Halo;
use crate::points::Points;
use crate::quadrature::{self, Quadrature};
use crate::stabilisation::Stabilisation;
use crate::step::apart::Apart;
use crate::step::extension::Extension;
use crate::step::inertia::{self, Inertia};
use crate::step::mass::Mass;
use crate::tensor::Vector;
use crate::water::carried;
use crate::water::nodes::Pores;
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
pub struct Nodes<const D: usize> {
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
    pub apart: Option<Apart>,
    /// pressures of the pore water, where it flows
    pub pores: Option<Pores<D>>,
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

impl<const D: usize> Nodes<D> {
    /// Maps the points to the nodes for the step from `t` to `t + dt`. Fails if a load has lost its material.
    pub fn map<K: Kinematics<D>>(
        model: &Model<K, D>,
        shape: &Shape<D>,
        points: &Points<D>,
        times: (f64, f64),
        halo: &dyn Halo,
    ) -> Result<Self, StepError> {
        Self::after(model, (shape, points), &[], times, halo)
    }

    /// The same after a step that had the displacement `last`, m, nodal, up to a factor: faces with contact go on as
    /// they were in it.
    pub fn after<K: Kinematics<D>>(
        model: &Model<K, D>,
        (shape, points): (&Shape<D>, &Points<D>),
        last: &[f64],
        (t, dt): (f64, f64),
        halo: &dyn Halo,
    ) -> Result<Self, StepError> {
        let nodes = model.grid.nodes();
        let weighting = model.inertial_weighting();
        let weight = scatter_weight(weighting, shape, points, halo);
        let threshold = threshold(&weight, halo);
        let velocities = model.boundary.velocities(&model.grid);
        let background = model
            .background
            .map(|soft| soft.blocks::<K, D>(&model.grid, shape, points, &model.materials));
        let fitted = (model.quadrature == Quadrature::Fitted)
            .then(|| quadrature::fitted::<K, D>((&model.grid, &model.boundary), shape, points, halo));
        let volume = fitted.as_deref().unwrap_or(&points.volume);
        let (active, stiff) = supported(shape, volume, background.is_some(), nodes, halo);
        let unknown = |node: usize| active[node] && (weight[node] > threshold || stiff[node]);
        let mut free: Vec<bool> = velocities
            .iter()
            .enumerate()
            .map(|(c, v)| v.is_none() && unknown(Nodal::<D>::node(c)))
            .collect();
        let pore_pressure = carried::pore_pressure(model, (shape, points), volume, t + dt, halo);
        let rigid = match model.boundary.rigid.is_empty() {
            true => RigidContacts::default(),
            false => {
                let around = Surroundings {
                    bodies: (&model.boundary.rigid, &points.surface.bodies),
                    reaching: model.reaching(points),
                    shape,
                    body_force: model.body_force(t + dt).unwrap_or_else(Vector::zeros),
                    free: &free,
                    newmark: (model.regime == Regime::Dynamic).then_some(model.newmark),
                    pore_pressure: pore_pressure.as_ref(),
                };
                let young = |p: usize| model.young(points, p);
                RigidContacts::of(&around, young, (t, dt), last, halo)?
            }
        };
        let mut at_bodies = rigid.touched_nodes(nodes, halo);
        strip::nodes_at(&model.boundary.strips, &model.grid, t)
            .into_iter()
            .for_each(|node| at_bodies[node] = true);
        let extension = Extension::of::<K>(model, shape, points, &active, &at_bodies, &mut free, halo);
        let prescribed = velocities.iter().map(|velocity| velocity.map(|v| v * dt)).collect();
        let contacts = match model.boundary.has_contact() {
            true => {
                let on_faces = |pores| carried::forces_on_faces(pores, model, (shape, points), volume, halo);
                let water = pore_pressure.as_ref().map(on_faces);
                let window = (&model.boundary, &model.grid);
                Contacts::of(window, (shape, points), &free, (t, last), water.as_deref(), halo)
            }
            false => Contacts::default(),
        };
        let dashpots = match model.boundary.absorbing().next() {
            Some(_) if model.regime == Regime::Dynamic => {
                let impedance = |p: usize| model.impedance(points, p);
                Dashpots::of::<K, D>((&model.boundary, &model.grid), (shape, points), impedance, &free, halo)
            }
            _ => Dashpots::default(),
        };
        let mut starting = velocities;
        contacts.rest(&mut starting);
        let mass = Mass {
            matrix: model.mass,
            shape,
            of_points: &points.mass,
            lumped: &weight,
            threshold,
            halo,
        };
        let mut inertia =
            (model.regime == Regime::Dynamic).then(|| inertia::map(&mass, points, &starting, (dt, model.newmark)));
        if let Some(inertia) = &mut inertia {
            inertia.moving = contacts.moving(&inertia.v, dt);
        }
        let mut f_ext = external_force((model, shape, points), t + dt, (weighting, &weight), halo);
        if let Some(force) = carried::force(model, (shape, points), volume, t + dt) {
            f_ext
                .iter_mut()
                .zip(halo.sum(&force))
                .for_each(|(all, force)| *all += force);
        }
        let window = (&model.grid, &active[..]);
        let surfaces = (&model.surfaces(), &points.surface);
        let followers = load::add_forces(surfaces, points.anchored(), window, t + dt, halo, &mut f_ext)?;
        if let Some(inertia) = inertia.as_mut().filter(|_| !rigid.moving.is_empty()) {
            inertia.moving.resize(rigid.moving.len(), false);
            inertia
                .moving
                .iter_mut()
                .zip(&rigid.moving)
                .for_each(|(moving, by_body)| *moving |= by_body);
        }
        let pores = Pores::of(model, (shape, points), (t, dt), halo)?;
        let averages = Averages::of(model, (shape, points), threshold, halo);
        let apart = Apart::of(model.materials.len(), shape, points, nodes, halo);
        let mut mapped = Self {
            apart,
            pores,
            contacts,
            rigid,
            pore_pressure,
            dashpots,
            f_ext,
            followers,
            prescribed,
            inertia,
            free,
            background,
            unresisted: None,
            extension,
            active_nodes: 0,
            unknowns: 0,
            massless_nodes: 0,
            background_cells: 0,
            threshold,
            weight,
            active,
            averages,
            fitted,
        };
        let mut f_ext = std::mem::take(&mut mapped.f_ext);
        mapped.reduce(&mut [&mut f_ext], halo);
        mapped.f_ext = f_ext;
        mapped.meet();
        mapped.count(halo);
        Ok(mapped)
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
    pub fn meet(&mut self) {
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
        (shape, points): (&Shape<D>, &Points<D>),
        halo: &dyn Halo,
        value: impl Fn(usize) -> [f64; C] + Sync,
        found: impl Fn(usize, [f64; C]) -> T + Sync,
    ) -> Vec<T> {
        let weight = self.averages.weight.as_ref().unwrap_or(&self.weight);
        let weights = weights(model.weighting, points);
        self.average_with(model, (shape, weight), (points, weights), halo, value, found)
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
        (shape, points): (&Shape<D>, &Points<D>),
        halo: &dyn Halo,
        value: impl Fn(usize) -> f64 + Sync,
    ) -> Vec<f64> {
        let (value, found) = (|p| [value(p)], |_, [mean]: [f64; 1]| mean);
        match &self.averages.lower {
            Some((lower, weight)) => {
                let weights = self.dilation_weights(model, points);
                self.average_with(model, (lower, weight), (points, weights), halo, value, found)
            }
            None => self.average(model, (shape, points), halo, value, found),
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

    /// With functions `shape` and their weights; zero where these are at most the threshold.
    fn average_with<K, const C: usize, T: Clone + Send>(
        &self,
        model: &Model<K, D>,
        (shape, weight): (&Shape<D>, &[f64]),
        (points, weights): (&Points<D>, &[f64]),
        halo: &dyn Halo,
        value: impl Fn(usize) -> [f64; C] + Sync,
        found: impl Fn(usize, [f64; C]) -> T + Sync,
    ) -> Vec<T> {
        let grouped = model.grouped(points);
        let weighted = |p: usize| value(p).map(|v| weights[p] * v);
        let mut nodal = halo.sum(&transfer::to_nodes_grouped(shape, grouped, weighted));
        transfer::divide(&mut nodal, weight, self.averages.threshold);
        transfer::to_points_grouped(shape, grouped, &nodal, found)
    }

    /// The mass matrix, in dynamics.
    pub fn mass<'a, K>(
        &'a self,
        model: &Model<K, D>,
        (shape, points): (&'a Shape<D>, &'a Points<D>),
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
        let count = |marks: &mut dyn Iterator<Item = bool>| marks.filter(|&mark| mark).count() as f64;
        let mut counts = [
            count(&mut owned.nodes().map(|node| self.active[node])),
            count(&mut owned.places::<D>().map(|place| self.free[place])),
            count(
                &mut owned
                    .nodes()
                    .map(|node| self.active[node] && self.weight[node] <= self.threshold),
            ),
            self.background.as_ref().map_or(0, Blocks::count) as f64,
        ];
        halo.reduce(&mut counts);
        [
            self.active_nodes,
            self.unknowns,
            self.massless_nodes,
            self.background_cells,
        ] = counts.map(|count| count as usize);
    }
}

impl<const D: usize> Averages<D> {
    /// `threshold` is that of the nodes' own weights.
    fn of<K>(model: &Model<K, D>, (shape, points): (&Shape<D>, &Points<D>), threshold: f64, halo: &dyn Halo) -> Self {
        let (weights, grouped) = (weights(model.weighting, points), model.grouped(points));
        let weight =
            |shape: &Shape<D>, weights: &[f64]| halo.sum(&transfer::to_nodes_grouped(shape, grouped, |p| [weights[p]]));
        let flows = model.water.as_ref().is_some_and(|water| water.flow.is_some());
        let of_points: Option<Vec<f64>> = (flows && model.stabilisation.lowers()).then(|| {
            weights
                .iter()
                .zip(points.F.iter())
                .map(|(weight, F)| weight * F.determinant())
                .collect()
        });
        let lowered = || {
            let lower = shape.lowered(&model.grid, points);
            let subgrid = model.stabilisation == Stabilisation::SubgridFBar;
            let lower = if subgrid {
                lower.merged(&model.grid, grouped, halo)
            } else {
                lower
            };
            let weight = weight(&lower, of_points.as_deref().unwrap_or(weights));
            (lower, weight)
        };
        let own = grouped.count() > 1 || model.weighting != model.inertial_weighting();
        let of_nodes = (model.stabilisation.averages() && own).then(|| weight(shape, weights));
        Self {
            threshold: of_nodes
                .as_ref()
                .map_or(threshold, |weight| self::threshold(weight, halo)),
            weight: of_nodes,
            lower: model.stabilisation.lowers().then(lowered),
            of_points,
        }
    }
}

fn weights<const D: usize>(weighting: Weighting, points: &Points<D>) -> &[f64] {
    match weighting {
        Weighting::Mass => &points.mass,
        Weighting::Volume => &points.volume,
    }
}

fn scatter_weight<const D: usize>(
    weighting: Weighting,
    shape: &Shape<D>,
    points: &Points<D>,
    halo: &dyn Halo,
) -> Vec<f64> {
    let weights = weights(weighting, points);
    halo.sum(&transfer::to_nodes(shape, |p| [weights[p]]))
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
    halo.max(&mut touched, 1);
    let touched: Vec<bool> = touched.into_iter().map(|mark| mark > 0.0).collect();
    let stiff = halo.sum(&transfer::squared_gradients(shape, |p| volume[p]));
    let mut stiffest = [stiff.iter().copied().fold(0.0, f64::max)];
    halo.maximum(&mut stiffest);
    let above = MASSLESS * stiffest[0];
    let is_stiff = |(&stiff, &touched): (&f64, &bool)| stiff > above || (has_background && touched);
    let stiff = stiff.iter().zip(&touched).map(is_stiff).collect();
    (touched, stiff)
}

/// Body force (step 2d): sum_p N_Ip m_p g(t + dt), and that of still water.
fn external_force<K: Kinematics<D>, const D: usize>(
    (model, shape, points): (&Model<K, D>, &Shape<D>, &Points<D>),
    t: f64,
    (weighting, weight): (Weighting, &[f64]),
    halo: &dyn Halo,
) -> Vec<f64> {
    let mut f_ext = vec![0.0; weight.len() * D];
    if let Some(g) = model.body_force(t) {
        let own;
        let mass = match weighting {
            Weighting::Mass => weight,
            Weighting::Volume => {
                own = scatter_weight(Weighting::Mass, shape, points, halo);
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
        let force = halo.sum(&transfer::to_nodes(shape, |p| {
            <[f64; D]>::from(water.force(points, (p, model.span(points, p)), model.follows_water(points, p)))
        }));
        f_ext.iter_mut().zip(force).for_each(|(all, force)| *all += force);
    }
    f_ext
}

/// Weight at and below which a node counts as massless.
fn threshold(weight: &[f64], halo: &dyn Halo) -> f64 {
    let mut heaviest = [weight.iter().copied().fold(0.0, f64::max)];
    halo.maximum(&mut heaviest);
    MASSLESS * heaviest[0]
}
