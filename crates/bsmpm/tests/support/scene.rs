//! Small models for tests, in any dimension: a grid, and elastic bodies of whole cells with n^D points per cell.

use super::random::Random;
use super::solver::Skyline;
use bsmpm::boundary::{AnchoredPoints, Boundary, Support};
use bsmpm::control::{AcceptedStep, Failure, Stepper};
use bsmpm::dynamics::mass::MassMatrix;
use bsmpm::dynamics::newmark::Newmark;
use bsmpm::grid::extension::ExtendedSplines;
use bsmpm::grid::{Grid, KnotVector, Shape};
use bsmpm::interactions::artificial_stiffness::ArtificialStiffness;
use bsmpm::interactions::load::Load;
use bsmpm::interactions::rigid::RigidBody;
use bsmpm::interactions::state::InteractionState;
use bsmpm::interactions::strip::Strip;
use bsmpm::kinematics::Kinematics;
use bsmpm::linear::LinearSolver;
use bsmpm::material::{Elastic, Hencky, LayeredMaterial, Material};
use bsmpm::method::Criteria;
use bsmpm::method::Nonlinear;
use bsmpm::model::WallVelocity;
use bsmpm::model::{AverageWeight, Gravity, Model, Regime};
use bsmpm::parallel::{Alone, Halo};
use bsmpm::points::{Points, Seed};
use bsmpm::quadrature::Quadrature;
use bsmpm::schedule::{Schedule, TimeInterval};
use bsmpm::stabilisation::{Groups, Stabilisation};
use bsmpm::step::nodes::GridState;
use bsmpm::tensor::{Symmetric, Tensor, Vector};
use std::marker::PhantomData;
use std::ops::Range;

/// Every method of section 2.3.
pub const METHODS: [Stabilisation; 5] = [
    Stabilisation::None,
    Stabilisation::FBar,
    Stabilisation::ModifiedFBar,
    Stabilisation::ConsistentFBar,
    Stabilisation::SubgridFBar,
];

/// A model with its points.
#[derive(Clone)]
pub struct Scene<K, const D: usize> {
    /// What stays constant.
    pub model: Model<K, D>,
    /// The points.
    pub points: Points<D>,
    /// State of the interactions.
    pub state: InteractionState<D>,
}

/// `cells` equal cells of length `cell` and order `order`.
pub fn axis(cell: f64, cells: usize, order: usize) -> KnotVector {
    KnotVector::uniform(cell, cells, order).expect("a valid axis")
}

/// Hencky elasticity.
pub fn hencky(young: f64, poisson: f64) -> Material {
    Material::Hencky(Hencky {
        elastic: Elastic { young, poisson },
    })
}

impl<K: Kinematics<D>, const D: usize> Scene<K, D> {
    /// An empty grid: no load, no support, no stabilisation, tight tolerances.
    pub fn new(axes: [KnotVector; D], material: impl Into<LayeredMaterial>, regime: Regime) -> Self {
        let model = Model {
            grid: Grid::new(axes).expect("axes of one order"),
            materials: vec![material.into()],
            regime,
            newmark: Newmark::default(),
            mass: MassMatrix::default(),
            wall_velocity: WallVelocity::default(),
            weighting: AverageWeight::Mass,
            gravity: None,
            shaking: None,
            boundary: Boundary::default(),
            stabilisation: Stabilisation::None,
            groups: Groups::default(),
            quadrature: Quadrature::Points,
            extended_splines: ExtendedSplines::Off,
            artificial_stiffness: None,
            criteria: Criteria {
                energy: 1e-14,
                force: 1e-10,
                max_iterations: 200,
            },
            damping: Vec::new(),
            nonlinear: Nonlinear::default(),
            water: None,
            balances_energy: false,
            kinematics: PhantomData,
        };
        Self {
            model,
            points: Points::from_seeds([], regime == Regime::Dynamic),
            state: InteractionState::default(),
        }
    }

    /// Fills the cells of a box with `per_axis`^D points each, of `density` and with velocity `v(x)`.
    pub fn body(
        mut self,
        cells: [Range<usize>; D],
        per_axis: usize,
        density: f64,
        v: impl Fn(&Vector<D>) -> Vector<D>,
    ) -> Self {
        let along: Vec<Vec<(f64, f64)>> = (0..D)
            .map(|axis| {
                let knots = &self.model.grid.axes()[axis];
                let place = |k: usize| {
                    let lower = knots.breakpoint(k / per_axis);
                    let upper = knots.breakpoint(k / per_axis + 1);
                    let length = (upper - lower) / per_axis as f64;
                    let middle = lower + ((k % per_axis) as f64 + 0.5) * length;
                    let farther = K::spread(axis, [lower, upper], per_axis) - 1.0;
                    (middle + (middle - 0.5 * (lower + upper)) * farther, length)
                };
                (cells[axis].start * per_axis..cells[axis].end * per_axis)
                    .map(place)
                    .collect()
            })
            .collect();
        let held = self.points.len() as u64;
        let total: usize = along.iter().map(Vec::len).product();
        let seed = |mut index: usize| {
            let id = held + index as u64;
            let mut x = Vector::zeros();
            let mut volume = 1.0;
            for axis in (0..D).rev() {
                let (at, length) = along[axis][index % along[axis].len()];
                index /= along[axis].len();
                x[axis] = at;
                volume *= length;
            }
            let volume = volume * K::weight(&x);
            Seed {
                id,
                material: 0,
                x,
                volume,
                mass: density * volume,
                v: v(&x),
            }
        };
        let mut added = Points::from_seeds((0..total).map(seed), self.points.motion.is_some());
        append(&mut self.points, &mut added);
        self.model.boundary.reach = vec![0.5 / per_axis as f64];
        self.points.sort_by_cell(&self.model.grid);
        self
    }

    /// Gives the points that `stiff` names by their place a second material, whose dilation averages do not mix with
    /// the first.
    pub fn with(mut self, second: Material, stiff: impl Fn(&Vector<D>) -> bool) -> Self {
        self.model.materials.push(second.into());
        self.model.groups = Groups::of_alike(&[false, true]);
        for (material, x) in self.points.material.iter_mut().zip(&self.points.x) {
            *material = u16::from(stiff(x));
        }
        self
    }

    /// Keeps the points that `wanted` names by their place.
    pub fn cut(mut self, wanted: impl Fn(&Vector<D>) -> bool) -> Self {
        let kept: Vec<u32> = (0..self.points.len())
            .filter(|&p| wanted(&self.points.x[p]))
            .map(|p| p as u32)
            .collect();
        self.points
            .columns()
            .into_iter()
            .for_each(|column| column.reorder(&kept));
        self
    }

    /// With this mass matrix.
    pub fn with_mass(mut self, mass: MassMatrix) -> Self {
        self.model.mass = mass;
        self
    }

    /// Adds a support.
    pub fn support(mut self, support: Support<D>) -> Self {
        self.model.boundary.supports.push(support);
        self
    }

    /// Adds a rigid strip.
    pub fn strip(mut self, strip: Strip<D>) -> Self {
        self.model.boundary.strips.push(strip);
        self.state = self.model.boundary.initial_state();
        self
    }

    /// Adds a rigid body.
    pub fn rigid(mut self, body: RigidBody<D>) -> Self {
        self.model.boundary.rigid.push(body);
        self.state = self.model.boundary.initial_state();
        self
    }

    /// Adds a load.
    pub fn load(mut self, load: Load<D>) -> Self {
        self.model.boundary.loads.push(load);
        self.state = self.model.boundary.initial_state();
        self
    }

    /// Rollers at both ends of the axes.
    pub fn rollers(self, axes: impl IntoIterator<Item = usize>) -> Self {
        axes.into_iter().fold(self, |scene, axis| {
            scene
                .support(Support::roller(axis, false))
                .support(Support::roller(axis, true))
        })
    }

    /// Points out of their lattice by up to 2e-2 m, each with an elastic strain of its own, about 1e-2.
    pub fn scattered(mut self, random: &mut Random) -> Self {
        for p in 0..self.points.len() {
            self.points.x[p] += random.vector::<D>() * 0.02;
            let strain: Vec<f64> = random.array(6).iter().map(|r| 0.01 * r).collect();
            let strain = Symmetric(std::array::from_fn(|c| if D == 2 && c > 3 { 0.0 } else { strain[c] }));
            self.points.b_e.set(
                p,
                Symmetric::of(&(Tensor::from_diagonal_element(0.995) + strain.full())),
            );
        }
        self
    }

    /// Gravity `g` against the last axis, growing over `ramp`.
    pub fn gravity(mut self, g: f64, ramp: f64) -> Self {
        let mut acceleration = Vector::zeros();
        acceleration[D - 1] = -g;
        self.model.gravity = Some(Gravity {
            acceleration,
            ramp,
            starts_vertical: false,
        });
        self
    }

    /// With this artificial stiffness.
    pub fn artificial_stiffness(mut self, stiffness: Option<ArtificialStiffness>) -> Self {
        self.model.artificial_stiffness = stiffness;
        self
    }

    /// Another method of section 2.3, and a grid that reaches as far as its stiffness.
    pub fn stabilised(mut self, stabilisation: Stabilisation) -> Self {
        self.model.stabilisation = stabilisation;
        let grid = self.model.grid.clone();
        let beyond = stabilisation.beyond(grid.order());
        self.model.grid = grid.reaching(beyond);
        self
    }

    /// Volumes that integrate linear functions exactly over interior cells.
    pub fn fitted(mut self) -> Self {
        self.model.quadrature = Quadrature::Fitted;
        self
    }

    /// Functions of nearly empty cells are tied to those of full ones.
    pub fn extended(mut self) -> Self {
        self.model.extended_splines = ExtendedSplines::Linear;
        self
    }

    /// The halo of one rank.
    pub fn halo(&self) -> Alone {
        Alone {
            nodes: self.model.grid.nodes(),
        }
    }

    /// The nodes at the start of a step of `dt` (s), which begins at t = 0.
    pub fn nodes(&self, shape: &Shape<D>, dt: f64) -> GridState<D> {
        let interval = TimeInterval { start: 0.0, dt };
        GridState::from_points(&self.model, shape, &self.points, &self.state, interval, &self.halo())
            .expect("loads on material")
    }

    /// The points with the anchors of the surfaces.
    pub fn anchored(&self) -> AnchoredPoints<'_, D> {
        AnchoredPoints {
            points: &self.points,
            anchors: &self.state.anchors,
        }
    }

    /// Makes the next step of a schedule, if there is one.
    pub fn advance(
        &mut self,
        stepper: &mut Stepper,
        schedule: &Schedule,
        halo: &dyn Halo,
        solver: &mut dyn LinearSolver,
    ) -> Option<Result<AcceptedStep, Failure>> {
        stepper.advance(schedule, &self.model, &mut self.points, &mut self.state, halo, solver)
    }

    /// Steps to `end` with nominal steps `dt`; `watch` sees the points after every accepted one. Panics on a failure.
    pub fn march(&mut self, dt: f64, end: f64, mut watch: impl FnMut(&Points<D>, &AcceptedStep)) {
        self.march_watched(dt, end, |scene, accepted| watch(&scene.points, accepted));
    }

    /// Steps as [`Self::march`]; `watch` sees the scene.
    pub fn march_watched(&mut self, dt: f64, end: f64, mut watch: impl FnMut(&Self, &AcceptedStep)) {
        let halo = self.halo();
        let schedule = Schedule::new(dt, end, []);
        let mut solver = Skyline::new(&self.model.grid);
        let mut stepper = Stepper::new(self.model.grid.nodes() * D);
        while let Some(found) = self.advance(&mut stepper, &schedule, &halo, &mut solver) {
            let accepted = found.unwrap_or_else(|failure| panic!("{failure:?}"));
            self.points.sort_by_cell(&self.model.grid);
            watch(self, &accepted);
        }
    }

    /// Steps to `end`, and hands back the scene and its accepted steps.
    pub fn solved(mut self, dt: f64, end: f64) -> (Self, Vec<AcceptedStep>) {
        let mut steps = Vec::new();
        self.march(dt, end, |_, accepted| steps.push(accepted.clone()));
        (self, steps)
    }
}

/// Moves the rows of `from` to the end of `to`.
fn append<const D: usize>(to: &mut Points<D>, from: &mut Points<D>) {
    let rows = from.len();
    for (to, from) in to.columns().into_iter().zip(from.columns()) {
        let mut message = Vec::new();
        (0..rows).for_each(|p| from.put(p, &mut message));
        let mut rest = message.as_slice();
        (0..rows).for_each(|_| to.take(&mut rest));
    }
}

/// Indices of the points in the order of their ids.
pub fn by_id<const D: usize>(points: &Points<D>) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by_key(|&p| points.id[p]);
    order
}

/// Volume-weighted root mean square.
pub fn rms<const D: usize>(points: &Points<D>, value: impl Fn(usize) -> f64) -> f64 {
    let sum: f64 = (0..points.len()).map(|p| points.volume[p] * value(p).powi(2)).sum();
    (sum / points.volume.iter().sum::<f64>()).sqrt()
}
