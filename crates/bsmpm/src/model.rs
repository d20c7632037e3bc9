//! Data that do not change within a stage: grid, materials, loads, supports and convergence criteria.

use crate::background::Background;
use crate::boundary::Boundary;
use crate::boundary::anchor::Surfaces;
use crate::boundary::rigid::ParticleDomains;
use crate::grid::Grid;
use crate::grid::extension::ExtendedSplines;
use crate::kinematics::Kinematics;
use crate::material::Moduli;
use crate::material::{Material, MaterialError, Response};
use crate::method::{Criteria, Nonlinear};
use crate::points::Points;
use crate::quadrature::Quadrature;
use crate::schedule::between;
use crate::stabilisation::{GroupedPoints, Groups, Stabilisation};
use crate::step::mass::MassMatrix;
use crate::step::newmark::Newmark;
use crate::tensor::{Symmetric, Vector};
use crate::water::Water;
use crate::water::ambient::{Ambient, Span, StillWater};
use crate::water::flow::Motion;
use std::borrow::Cow;
use std::marker::PhantomData;

/// Whether inertia acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Regime {
    /// Inertia, integrated as the model's `newmark` says; time in s.
    Dynamic,
    /// No mass terms at all; time is a pseudo-time.
    QuasiStatic,
}

/// What the averages of Eqs 16-20 are weighted with.
///
/// Where the density is the same everywhere both are one; where it is not, dilations are averaged better by volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AverageWeight {
    /// The points' mass, as in the paper.
    Mass,
    /// The points' reference volume, where a scene has materials of different density, or weightless ones.
    Volume,
}

/// Which velocity points within a cell of a fixed face keep.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WallVelocity {
    /// Their own, by Newmark's formula: the paper's.
    #[default]
    Own,
    /// It relaxes to that of their motion, see [`walls`](crate::step::walls).
    Relaxed,
}

/// Body force per mass that grows linearly over a ramp: weight along the last axis, and across it in a pseudo-static
/// analysis the inertia of an earthquake (Terzaghi, 1950).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gravity<const D: usize> {
    /// m/s2  when fully applied
    pub acceleration: Vector<D>,
    /// s (or pseudo-time) over which it grows; 0: at once
    pub ramp: f64,
    /// Whether the vertical part acts in full from time 0, in equilibrium with a stress at the start. The ramp is then
    /// that of the horizontal part alone.
    pub starts_vertical: bool,
}

impl<const D: usize> Gravity<D> {
    /// Acceleration at time `t`, m/s2.
    pub fn at(&self, t: f64) -> Vector<D> {
        let mut acceleration = self.acceleration * self.ramped(t);
        acceleration[D - 1] = self.acceleration[D - 1] * self.grown(t);
        acceleration
    }

    /// The same without its horizontal part.
    pub fn vertical(&self) -> Self {
        let mut acceleration = Vector::zeros();
        acceleration[D - 1] = self.acceleration[D - 1];
        Self { acceleration, ..*self }
    }

    /// Part of the vertical acceleration that acts at time `t`.
    pub fn grown(&self, t: f64) -> f64 {
        if self.starts_vertical { 1.0 } else { self.ramped(t) }
    }

    /// Part of the ramp that is over at time `t`.
    fn ramped(&self, t: f64) -> f64 {
        if self.ramp > 0.0 {
            (t / self.ramp).clamp(0.0, 1.0)
        } else {
            1.0
        }
    }
}

/// Motion of the ground, in whose frame the scene is: every mass feels the opposite of its acceleration.
#[derive(Clone, Debug, PartialEq)]
pub struct Shaking<const D: usize> {
    /// s, increasing, and m/s2; linear between, from zero at time 0 to the first row, zero after the last
    pub rows: Vec<(f64, Vector<D>)>,
}

impl<const D: usize> Shaking<D> {
    /// Acceleration of the ground at time `t`, m/s2.
    pub fn at(&self, t: f64) -> Vector<D> {
        between(&self.rows, Vector::zeros(), t).unwrap_or_else(Vector::zeros)
    }
}

/// A scene, ready to be stepped.
#[derive(Clone, Debug)]
pub struct Model<K, const D: usize> {
    /// Grid, seen through this rank's window.
    pub grid: Grid<D>,
    /// Materials by the number that the points carry.
    pub materials: Vec<Material>,
    /// Dynamic or quasi-static.
    pub regime: Regime,
    /// Time integration in dynamics.
    pub newmark: Newmark,
    /// Mass matrix in dynamics.
    pub mass: MassMatrix,
    /// Which velocity points near fixed faces keep in dynamics.
    pub wall_velocity: WallVelocity,
    /// Weights of the averages.
    pub weighting: AverageWeight,
    /// Body force, if any.
    pub gravity: Option<Gravity<D>>,
    /// Motion of the ground, if any.
    pub shaking: Option<Shaking<D>>,
    /// Supports at the faces of the grid.
    pub boundary: Boundary<D>,
    /// Section 2.3.
    pub stabilisation: Stabilisation,
    /// Materials that averages may mix.
    pub groups: Groups,
    /// What points weigh in the integrals of the stress.
    pub quadrature: Quadrature,
    /// Whether functions of nearly empty cells are tied to those of full ones.
    pub extended_splines: ExtendedSplines,
    /// Soft background in occupied cells, if any.
    pub background: Option<Background>,
    /// Convergence.
    pub criteria: Criteria,
    /// s  retardation time of every material, in dynamics; empty: no damping
    pub damping: Vec<f64>,
    /// How equilibrium is sought.
    pub nonlinear: Nonlinear,
    /// Water in the ground, if any.
    pub water: Option<Water<D>>,
    /// Whether every step reports where its energy went.
    pub balances_energy: bool,
    /// The geometry, a type without data.
    pub kinematics: PhantomData<K>,
}

impl<K: Kinematics<D>, const D: usize> Model<K, D> {
    /// The constitution's answer to the trial b^e of point `p`, which is in the state of the last step.
    #[inline(always)]
    pub fn respond(&self, points: &Points<D>, p: usize, b_trial: &Symmetric) -> Result<Response, MaterialError> {
        match &self.materials[usize::from(points.material[p])] {
            Material::Graded(law) => law.respond(points.height(p), b_trial, points.state_of(p)),
            uniform => uniform.respond(b_trial, points.state_of(p)),
        }
    }

    /// Elastic energy of point `p` per reference volume in the state `b_e`, J/m3; not a number where that is no strain.
    pub fn elastic_energy(&self, points: &Points<D>, p: usize, b_e: &Symmetric) -> f64 {
        let material = self.materials[usize::from(points.material[p])].at(points.height(p));
        material.elastic_energy(b_e).unwrap_or(f64::NAN)
    }

    /// Force per mass at time `t`, m/s2: gravity less the ground's acceleration; `None` without either.
    pub fn body_force(&self, t: f64) -> Option<Vector<D>> {
        let gravity = self.gravity.map(|gravity| gravity.at(t));
        let shaking = self.shaking.as_ref();
        match (gravity, shaking.map(|shaking| shaking.at(t))) {
            (Some(gravity), Some(ground)) => Some(gravity - ground),
            (gravity, ground) => gravity.or(ground.map(|ground| -ground)),
        }
    }

    /// Still water at time `t`, if there is any: it weighs as much as gravity has grown, and nothing without.
    pub fn still_water(&self, t: f64) -> Option<StillWater<'_>> {
        let Water {
            unit_weight, ambient, ..
        } = self.water.as_ref().filter(|water| water.ambient != Ambient::None)?;
        let grown = self.gravity.as_ref().map_or(0.0, |gravity| gravity.grown(t));
        Some(StillWater::new(ambient, unit_weight * grown, t))
    }

    /// Whether the mass of point `p` follows the water in its pores: water that flows changes it by itself.
    pub fn follows_water(&self, points: &Points<D>, p: usize) -> bool {
        points.pore_pressure.is_some() && self.flows_at(points, p)
    }

    /// Whether water flows in the material of point `p`.
    fn flows_at(&self, points: &Points<D>, p: usize) -> bool {
        let flow = self.water.as_ref().and_then(|water| water.flow.as_ref());
        flow.is_some_and(|flow| flow.soils[usize::from(points.material[p])].is_some())
    }

    /// The model in a step of the length `dt`, s: another one only where a strength follows the rate.
    pub fn over(&self, dt: f64) -> Cow<'_, Self>
    where
        K: Clone,
    {
        if self
            .materials
            .iter()
            .all(|material| material.at_time_step(dt).is_none())
        {
            return Cow::Borrowed(self);
        }
        let materials = self.materials.iter();
        let materials = materials.map(|material| material.at_time_step(dt).unwrap_or_else(|| material.clone()));
        Cow::Owned(Self {
            materials: materials.collect(),
            ..self.clone()
        })
    }

    /// Largest Young's modulus, Pa.
    pub fn stiffest(&self) -> f64 {
        self.materials.iter().map(|m| m.elastic().young).fold(0.0, f64::max)
    }

    /// Young's modulus of point `p`, Pa.
    pub fn young(&self, points: &Points<D>, p: usize) -> f64 {
        self.materials[usize::from(points.material[p])].young_at(points.height(p))
    }

    /// kg m/s  mass of point `p` times the speed of compression waves, and of shear waves, of its elastic stiffness.
    pub fn impedance(&self, points: &Points<D>, p: usize) -> [f64; 2] {
        let material = &self.materials[usize::from(points.material[p])];
        let Moduli { lambda, mu } = material.elastic().moduli();
        let relative = material.relative_stiffness(points.height(p));
        [lambda + 2.0 * mu, mu].map(|modulus| (points.mass[p] * points.volume[p] * relative * modulus).sqrt())
    }

    /// The model as nothing moves yet, whatever the ground will do: quasi-static, absorbing faces hold.
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

    /// The model as at rest, with the pore pressures of the start: nothing flows before the first step, and ground does
    /// not hang from what lies on it.
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

    /// How far point `p`, as it is deformed, spans up and down for still water. With pressures of its own it has the
    /// still water's at its place, as their sum is what acts.
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

    /// What shows how far the points reach.
    pub fn reaching<'a>(&'a self, points: &'a Points<D>) -> ParticleDomains<'a, D> {
        ParticleDomains {
            grid: &self.grid,
            points,
            reach: &self.boundary.reach,
            weight: K::weight,
        }
    }

    /// Whether all points have one Young's modulus.
    pub fn is_uniformly_stiff(&self) -> bool {
        let mut materials = self.materials.iter();
        materials.all(|m| !matches!(m, Material::Graded(_)) && m.elastic().young == self.stiffest())
    }
}

impl<K, const D: usize> Model<K, D> {
    /// All that has points on surfaces of bodies.
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

    /// What the nodes' own weights are made of: mass in dynamics.
    pub fn inertial_weighting(&self) -> AverageWeight {
        if self.regime == Regime::Dynamic {
            AverageWeight::Mass
        } else {
            self.weighting
        }
    }

    /// The points in the groups that averages may mix.
    pub fn grouped<'a>(&'a self, points: &'a Points<D>) -> GroupedPoints<'a> {
        GroupedPoints::by(&self.groups, &points.material)
    }
}
