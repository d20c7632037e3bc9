//! Data that do not change within a stage: grid, materials, loads, supports and convergence criteria.

use crate::boundary::Boundary;
use crate::boundary::anchor::Surfaces;
use crate::dynamics::mass::MassMatrix;
use crate::dynamics::newmark::Newmark;
use crate::field::pore_water::Water;
use crate::field::pore_water::ambient::{Ambient, Span, StillWater};
use crate::field::pore_water::flow::Motion;
use crate::grid::Grid;
use crate::grid::extension::ExtendedSplines;
use crate::interactions::artificial_stiffness::ArtificialStiffness;
use crate::interactions::rigid::ParticleDomains;
use crate::kinematics::Kinematics;
use crate::material::Moduli;
use crate::material::{LayeredMaterial, MaterialError, Response};
use crate::method::{Criteria, Nonlinear};
use crate::points::Points;
use crate::quadrature::Quadrature;
use crate::schedule::between;
use crate::stabilisation::{GroupedPoints, Groups, Stabilisation};
use crate::tensor::{Symmetric, Vector};
use std::borrow::Cow;
use std::marker::PhantomData;

/// Whether inertia acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Regime {
    /// Inertia acts and is integrated with the parameters `newmark` of the model; time in s.
    Dynamic,
    /// No inertia; time is a pseudo-time.
    QuasiStatic,
}

/// Weights of the averages in Eqs 16-20 of Xie et al. (2023).
///
/// With uniform density both choices are equivalent; otherwise dilations are averaged more accurately by volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AverageWeight {
    /// Mass of the points, as in the paper.
    Mass,
    /// Reference volume of the points, for cases with different densities or massless materials.
    Volume,
}

/// Velocity of points within one cell of a fixed face.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WallVelocity {
    /// Velocity of the point by Newmark's formula, as in the paper.
    #[default]
    Own,
    /// Velocity that relaxes to the rate of the displacement, see [`walls`](crate::step::walls).
    Relaxed,
}

/// Body force per mass that grows linearly during a ramp: weight along the last axis; in pseudo-static analyses also
/// horizontal inertia of an earthquake (Terzaghi, 1950).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gravity<const D: usize> {
    /// Final acceleration (m/s2).
    pub acceleration: Vector<D>,
    /// Duration of the ramp (s or pseudo-time); 0: no ramp.
    pub ramp: f64,
    /// Whether the vertical part acts in full from time 0, in equilibrium with the initial stress. The ramp then
    /// applies to the horizontal part only.
    pub starts_vertical: bool,
}

impl<const D: usize> Gravity<D> {
    /// Returns the acceleration at time `t` (m/s2).
    pub fn at(&self, t: f64) -> Vector<D> {
        let mut acceleration = self.acceleration * self.ramped(t);
        acceleration[D - 1] = self.acceleration[D - 1] * self.grown(t);
        acceleration
    }

    /// Returns the same gravity without its horizontal part.
    pub fn vertical(&self) -> Self {
        let mut acceleration = Vector::zeros();
        acceleration[D - 1] = self.acceleration[D - 1];
        Self { acceleration, ..*self }
    }

    /// Returns the fraction of the vertical acceleration that acts at time `t`.
    pub fn grown(&self, t: f64) -> f64 {
        if self.starts_vertical { 1.0 } else { self.ramped(t) }
    }

    /// Returns the fraction of the ramp at time `t`.
    fn ramped(&self, t: f64) -> f64 {
        if self.ramp > 0.0 {
            (t / self.ramp).clamp(0.0, 1.0)
        } else {
            1.0
        }
    }
}

/// Prescribed ground motion. The case is described in the frame of the ground, so each mass is subject to the opposite
/// acceleration.
#[derive(Clone, Debug, PartialEq)]
pub struct Shaking<const D: usize> {
    /// Rows of time (s, increasing) and acceleration (m/s2): linear in between, from zero at time 0 to the first row,
    /// zero after the last.
    pub rows: Vec<(f64, Vector<D>)>,
}

impl<const D: usize> Shaking<D> {
    /// Returns the acceleration of the ground at time `t` (m/s2).
    pub fn at(&self, t: f64) -> Vector<D> {
        between(&self.rows, Vector::zeros(), t).unwrap_or_else(Vector::zeros)
    }
}

/// Case in the form that the steps use.
#[derive(Clone, Debug)]
pub struct Model<K, const D: usize> {
    /// Grid, restricted to the window of this rank.
    pub grid: Grid<D>,
    /// Materials, by the number that points store.
    pub materials: Vec<LayeredMaterial>,
    /// Dynamic or quasi-static.
    pub regime: Regime,
    /// Time integration in dynamics.
    pub newmark: Newmark,
    /// Mass matrix in dynamics.
    pub mass: MassMatrix,
    /// Velocity of points near fixed faces in dynamics.
    pub wall_velocity: WallVelocity,
    /// Weights of the averages.
    pub weighting: AverageWeight,
    /// Body force, if any.
    pub gravity: Option<Gravity<D>>,
    /// Motion of the ground, if any.
    pub shaking: Option<Shaking<D>>,
    /// Supports at the faces of the grid.
    pub boundary: Boundary<D>,
    /// Method against volumetric locking (section 2.3 of the paper).
    pub stabilisation: Stabilisation,
    /// Groups of materials that averages may mix.
    pub groups: Groups,
    /// Weights of the points in integrals of the stress.
    pub quadrature: Quadrature,
    /// Whether functions of nearly empty cells are extrapolated from those of full cells.
    pub extended_splines: ExtendedSplines,
    /// Artificial stiffness of occupied cells, if any.
    pub artificial_stiffness: Option<ArtificialStiffness>,
    /// Convergence criteria.
    pub criteria: Criteria,
    /// Retardation time of every material in dynamics (s); empty without damping.
    pub damping: Vec<f64>,
    /// Method of the equilibrium iteration.
    pub nonlinear: Nonlinear,
    /// Pore water, if any.
    pub water: Option<Water<D>>,
    /// Whether every step reports its energy balance.
    pub balances_energy: bool,
    /// Geometry, a type without data.
    pub kinematics: PhantomData<K>,
}

impl<K: Kinematics<D>, const D: usize> Model<K, D> {
    /// Computes the constitutive response of point `p` to the trial b^e, from the state of the last step.
    #[inline(always)]
    pub fn respond(&self, points: &Points<D>, p: usize, b_trial: &Symmetric) -> Result<Response, MaterialError> {
        match &self.materials[usize::from(points.material[p])] {
            LayeredMaterial::Uniform(law) => law.respond(b_trial, points.state_of(p)),
            LayeredMaterial::Graded(law) => law.respond(points.height(p), b_trial, points.state_of(p)),
        }
    }

    /// Returns the elastic energy of point `p` per reference volume for `b_e` (J/m3); NaN if `b_e` is no admissible
    /// strain.
    pub fn elastic_energy(&self, points: &Points<D>, p: usize, b_e: &Symmetric) -> f64 {
        let material = self.materials[usize::from(points.material[p])].at(points.height(p));
        material.elastic_energy(b_e).unwrap_or(f64::NAN)
    }

    /// Returns the force per mass at time `t`, gravity less ground acceleration (m/s2); `None` without either.
    pub fn body_force(&self, t: f64) -> Option<Vector<D>> {
        let gravity = self.gravity.map(|gravity| gravity.at(t));
        let shaking = self.shaking.as_ref();
        match (gravity, shaking.map(|shaking| shaking.at(t))) {
            (Some(gravity), Some(ground)) => Some(gravity - ground),
            (gravity, ground) => gravity.or(ground.map(|ground| -ground)),
        }
    }

    /// Returns the hydrostatic pressure field at time `t`, if any. Its unit weight grows with gravity, and is 0 without
    /// gravity.
    pub fn still_water(&self, t: f64) -> Option<StillWater<'_>> {
        let Water {
            unit_weight, ambient, ..
        } = self.water.as_ref().filter(|water| water.ambient != Ambient::None)?;
        let grown = self.gravity.as_ref().map_or(0.0, |gravity| gravity.grown(t));
        Some(StillWater::new(ambient, unit_weight * grown, t))
    }

    /// Returns whether the mass of point `p` follows its water content, as in coupled flow.
    pub fn follows_water(&self, points: &Points<D>, p: usize) -> bool {
        points.pore_pressure.is_some() && self.flows_at(points, p)
    }

    /// Returns whether the material of point `p` has pore-water flow.
    fn flows_at(&self, points: &Points<D>, p: usize) -> bool {
        let flow = self.water.as_ref().and_then(|water| water.flow.as_ref());
        flow.is_some_and(|flow| flow.soils[usize::from(points.material[p])].is_some())
    }

    /// Returns the model in a step of length `dt` (s); a modified copy only if a law depends on the strain rate.
    pub fn over(&self, dt: f64) -> Cow<'_, Self>
    where
        K: Clone,
    {
        if self
            .materials
            .iter()
            .all(|material| material.with_time_step(dt).is_none())
        {
            return Cow::Borrowed(self);
        }
        let materials = self.materials.iter();
        let materials = materials.map(|material| material.with_time_step(dt).unwrap_or_else(|| material.clone()));
        Cow::Owned(Self {
            materials: materials.collect(),
            ..self.clone()
        })
    }

    /// Returns the largest Young's modulus (Pa).
    pub fn stiffest(&self) -> f64 {
        self.materials.iter().map(|m| m.elastic().young).fold(0.0, f64::max)
    }

    /// Returns Young's modulus of point `p` (Pa).
    pub fn young(&self, points: &Points<D>, p: usize) -> f64 {
        self.materials[usize::from(points.material[p])].young_at(points.height(p))
    }

    /// Returns the mass of point `p` times the speed of its elastic compression and shear waves (kg m/s).
    pub fn impedance(&self, points: &Points<D>, p: usize) -> [f64; 2] {
        let material = &self.materials[usize::from(points.material[p])];
        let Moduli { lambda, mu } = material.elastic().moduli();
        let relative = material.relative_stiffness(points.height(p));
        [lambda + 2.0 * mu, mu].map(|modulus| (points.mass[p] * points.volume[p] * relative * modulus).sqrt())
    }

    /// Returns the model at rest: quasi-static, without ground motion, and with absorbing faces that carry static load.
    pub fn at_rest(&self) -> Self
    where
        K: Clone,
    {
        let boundary = self.boundary.at_rest(self.gravity.map(|gravity| gravity.acceleration));
        Self {
            regime: Regime::QuasiStatic,
            shaking: None,
            boundary,
            ..self.clone()
        }
    }

    /// Returns the model for the initial equilibrium: at rest, with constant pore pressures, and without the footings
    /// that rest on the ground, so that it cannot hang from them.
    pub fn settling(&self) -> Self
    where
        K: Clone,
    {
        let mut model = self.at_rest();
        let Boundary { strips, resting, .. } = &mut model.boundary;
        strips
            .iter_mut()
            .zip(resting)
            .filter(|(_, resting)| **resting)
            .for_each(|(strip, _)| strip.penalty = 0.0);
        model
            .water
            .iter_mut()
            .flat_map(|water| &mut water.flow)
            .for_each(|flow| flow.motion = Motion::Held);
        model
    }

    /// Returns the vertical extent of the deformed point `p` for hydrostatic pressure. With coupled flow it is zero:
    /// the hydrostatic pressure is evaluated at the point, as is the excess pressure added to it.
    pub fn span(&self, points: &Points<D>, p: usize) -> Span {
        if self.flows_at(points, p) {
            return Span::default();
        }
        let start = points.x[p] - points.u[p];
        let reach = self
            .boundary
            .reach
            .get(usize::from(points.material[p]))
            .zip(self.grid.locate(&start));
        let Some((share, cell)) = reach else {
            return Span::default();
        };
        let (lower, edges) = self.grid.cell_box(&cell);
        let parts = edges * (2.0 * share);
        let filled = points.volume[p] / (parts.product() * K::weight(&start));
        let span = Span::of(start[D - 1] - lower[D - 1], parts[D - 1], filled);
        let stretched = self.boundary.reach_along(&self.grid, points, p, D - 1) / (0.5 * parts[D - 1]);
        Span {
            reach: span.reach * stretched,
            ..span
        }
    }

    /// Returns the particle domains of the points.
    pub fn reaching<'a>(&'a self, points: &'a Points<D>) -> ParticleDomains<'a, D> {
        ParticleDomains {
            grid: &self.grid,
            points,
            reach: &self.boundary.reach,
            weight: K::weight,
        }
    }

    /// Returns whether all points have the same Young's modulus.
    pub fn is_uniformly_stiff(&self) -> bool {
        let mut materials = self.materials.iter();
        materials.all(|m| !m.is_graded() && m.elastic().young == self.stiffest())
    }
}

impl<K, const D: usize> Model<K, D> {
    /// Returns whether there is a second field: pore water flows.
    pub fn is_coupled(&self) -> bool {
        self.water.as_ref().is_some_and(|water| water.flow.is_some())
    }

    /// Returns all surfaces of bodies with surface points.
    pub fn surfaces(&self) -> Surfaces<'_, D> {
        let flow = self.water.as_ref().and_then(|water| water.flow.as_ref());
        let water = flow
            .into_iter()
            .flat_map(|flow| flow.surfaces().map(|(points, _)| points))
            .collect();
        let dry = flow.map_or_else(Vec::new, |flow| flow.soils.iter().map(Option::is_none).collect());
        Surfaces {
            boundary: &self.boundary,
            water,
            dry,
        }
    }

    /// Returns the weights of the nodes: mass in dynamics, else as `weighting`.
    pub fn inertial_weighting(&self) -> AverageWeight {
        if self.regime == Regime::Dynamic {
            AverageWeight::Mass
        } else {
            self.weighting
        }
    }

    /// Returns the points in the groups of materials that averages may mix.
    pub fn grouped<'a>(&'a self, points: &'a Points<D>) -> GroupedPoints<'a> {
        GroupedPoints::by(&self.groups, &points.material)
    }
}
