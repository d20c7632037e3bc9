//! Nodal pore pressures at the start of a step: unknowns, prescribed values and stabilisation, theory-manual equation
//! (T8.11).

use crate::boundary::AnchoredPoints;
use crate::error::StepError;
use crate::field::pore_water::Water;
use crate::field::pore_water::backward::Differences;
use crate::field::pore_water::drain::Drainage;
use crate::field::pore_water::flow::{Flow, Motion, Soil};
use crate::field::pore_water::ties::Ties;
use crate::grid::transfer::scalars;
use crate::grid::{Contributions, Grid, Shape};
use crate::interactions::state::InteractionState;
use crate::kinematics::Kinematics;
use crate::model::{Model, Regime};
use crate::parallel::{Halo, over_layers};
use crate::points::Points;
use crate::schedule::TimeInterval;
use crate::tensor::Vector;

/// Factor of the stabilisation term, in units of h^2/M (T8.11). With 1/6, splines of degree q for displacements and q -
/// 1 for pressures are stable together; in one dimension the storage is then lumped.
const TAU: f64 = 1.0 / 6.0;
/// Square of the largest wave number that cells of the edge h resolve, in units of 1/h^2.
pub(super) const SHORTEST_WAVE: f64 = 10.0;
/// Smallest volume in the support of a pressure function relative to the largest one; below it the function has no
/// pressure.
const UNSEEN: f64 = 1e-14;
/// Round-off of the water balance, relative to the volume in the support of a function.
const ROUND_OFF: f64 = 1e-13;
/// Sums of a function over points: volume, volume times excess pressure, and capacity for storage and flow.
const SUMS: usize = 3;

/// State of a material point with pore-water flow at the start of a step.
#[derive(Clone, Copy, Debug)]
pub struct FlowPoint<const D: usize> {
    /// Reference volume (m^D).
    pub volume: f64,
    /// Volume ratio J at t (-).
    pub J: f64,
    /// Volume ratio J-bar at t, which determines the stress of the skeleton and the pore volume (-).
    pub mean_J: f64,
    /// Water content at t per reference volume (-).
    pub content: f64,
    /// Change of the water content that the second-order difference carries over from the last step (-), see
    /// [`Differences`].
    pub goes_on: f64,
    /// Whole pore pressure at t; the excess pressure if no soil retains water under suction (Pa).
    pub pressure: f64,
    /// Hydrostatic pressure at t + dt, to which the excess pressure is added; 0 if no soil retains water (Pa).
    pub ambient: f64,
    /// Part of `ambient` that acts as a separate nodal force, equation (T8.3) (Pa).
    pub borne: f64,
    /// Stiffness M against the shortest wave that cells resolve: lambda + 2 mu plus `inertia` (Pa).
    pub stiffness: f64,
    /// Inertia of the step at the wave number of the shortest wave; 0 in quasi-static analyses (Pa).
    pub inertia: f64,
    /// V0 J tau h_i^2 / M along the axes (m^D m2/Pa).
    pub tau: Vector<D>,
    /// Gradient of the whole pore pressure at t plus the carried-over part of its last change (Pa/m).
    pub before: Vector<D>,
    /// Gradient of the hydrostatic pressure at t + dt (Pa/m).
    pub still: Vector<D>,
    /// Gradient of the hydrostatic pressure less the unit weight of water: the driving term of Darcy's law besides the
    /// gradient of the excess pressure; zero without permeability (Pa/m).
    pub drive: Vector<D>,
}

/// Pore pressures of one step. Nodal arrays have one number per node and belong to the functions of degree q - 1.
#[derive(Clone, Debug)]
pub struct PorePressureField<const D: usize> {
    /// Functions of degree q - 1 at the points.
    pub shape: Shape<D>,
    /// Whether material points lie in the support, per node.
    pub seen: Vec<bool>,
    /// Whether the pressure is an unknown, per node.
    pub free: Vec<bool>,
    /// Prescribed excess pressure at t + dt, nodal (Pa).
    pub prescribed: Vec<Option<f64>>,
    /// Initial excess pressure of the iteration: the mean of the points, or the prescribed value, nodal (Pa).
    pub guess: Vec<f64>,
    /// Hydrostatic pressure at the Greville abscissae of the functions, nodal (Pa); empty if no soil retains water.
    pub still: Vec<f64>,
    /// States of the material points; `None` without pore-water flow.
    pub wet: Vec<Option<FlowPoint<D>>>,
    /// Drains and inflows of the step.
    pub drainage: Drainage,
    /// Couplings across C0 lines, where strains may jump.
    pub ties: Ties,
    /// Coefficients of the time integration.
    pub differences: Differences,
    /// Duration for which flows at the end of the step count (s).
    pub duration: f64,
    /// End of the step (s).
    pub end: f64,
    /// Number of unknown pressures over all ranks.
    pub unknowns: usize,
    /// Norm of the round-off of the water balance (m3).
    pub round_off: f64,
}

impl<const D: usize> PorePressureField<D> {
    /// Returns the pore pressures of the step `interval`; `None` without pore-water flow, or if pressures are kept
    /// constant. Fails if a drain lies on impermeable material.
    pub fn of<K: Kinematics<D>>(
        model: &Model<K, D>,
        full: &Shape<D>,
        points: &Points<D>,
        state: &InteractionState<D>,
        interval: TimeInterval,
        halo: &dyn Halo,
    ) -> Result<Option<Self>, StepError> {
        let Some(water) = &model.water else { return Ok(None) };
        let Some(flow) = water.flow.as_ref().filter(|flow| flow.motion != Motion::Held) else {
            return Ok(None);
        };
        let shape = full.lowered_with_derivatives(&model.grid, points);
        let end = interval.end();
        let differences = Differences::of(model, points, state.flowed.as_ref(), interval);
        let duration = differences.now * interval.dt;
        let ground = FlowingGround::of(model, water, flow, points, interval, differences.last);
        let wet: Vec<Option<FlowPoint<D>>> = (0..points.len()).map(|p| ground.wet(p)).collect();
        let sums = halo.assemble_ghosts(&ground.sums(&shape, &wet, duration));
        let mut largest = [sums.chunks_exact(SUMS).map(|of| of[0]).fold(0.0, f64::max)];
        halo.all_reduce_max(&mut largest);
        let seen: Vec<bool> = sums.chunks_exact(SUMS).map(|of| of[0] > UNSEEN * largest[0]).collect();
        let prescribed = given(&model.grid, water, flow, end);
        let free: Vec<bool> = (0..seen.len())
            .map(|node| seen[node] && prescribed[node].is_none())
            .collect();
        let drainage = Drainage::at(
            model,
            AnchoredPoints {
                points,
                anchors: &state.anchors,
            },
            interval,
            differences,
            |node| seen[node],
            |x| water.still_pressure(x, end),
            halo,
        )?;
        let takes: Vec<f64> = sums.chunks_exact(SUMS).map(|of| of[2]).collect();
        let ties = Ties::of(&model.grid, &seen, &takes);
        let round_off = round_off(&sums, &free, halo);
        let mut unknowns = [halo.owned().nodes().filter(|&node| free[node]).count() as f64];
        halo.all_reduce_sum(&mut unknowns);
        Ok(Some(Self {
            guess: guess(&sums, &seen, &prescribed),
            shape,
            seen,
            free,
            prescribed,
            still: still_at_nodes(&model.grid, water, flow, end),
            wet,
            drainage,
            ties,
            differences,
            duration,
            end,
            unknowns: unknowns[0] as usize,
            round_off,
        }))
    }
}

/// Returns the inertia per density at the wave number of the shortest wave in a step of length `dt` (s): the factor of
/// the mass matrix over the square of the wave number (m2/s2). It is 0 in quasi-static analyses.
fn inertia<K, const D: usize>(model: &Model<K, D>, dt: f64) -> f64 {
    match model.regime {
        Regime::QuasiStatic => 0.0,
        Regime::Dynamic => model.newmark.factor(dt) * model.grid.smallest_edge().powi(2) / SHORTEST_WAVE,
    }
}

/// Returns initial excess pressures, nodal (Pa): the values of `prescribed`, else the means of the points.
fn guess(sums: &[f64], seen: &[bool], prescribed: &[Option<f64>]) -> Vec<f64> {
    let nodes = sums.chunks_exact(SUMS).enumerate();
    let pressures = nodes.map(|(node, of)| match prescribed[node] {
        Some(given) => given,
        None if seen[node] => of[1] / of[0],
        None => 0.0,
    });
    pressures.collect()
}

/// Returns the norm of the round-off of the water balance over the functions that are `free` (m3). One reduction.
fn round_off(sums: &[f64], free: &[bool], halo: &dyn Halo) -> f64 {
    let squares = over_layers(halo, 1, |node| {
        if free[node] {
            (ROUND_OFF * sums[SUMS * node]).powi(2)
        } else {
            0.0
        }
    });
    halo.reproducible_sum(&[squares])[0].sqrt()
}

/// Returns hydrostatic pressures at the Greville abscissae of the functions of degree q - 1, nodal (Pa); empty if no
/// soil retains water.
fn still_at_nodes<const D: usize>(grid: &Grid<D>, water: &Water<D>, flow: &Flow<D>, t: f64) -> Vec<f64> {
    if !flow.retains() {
        return Vec::new();
    }
    let pressures = (0..grid.nodes()).map(|node| {
        let number = grid.node_at(node);
        let x = Vector::from_fn(|axis, _| {
            let knots = &grid.axes()[axis];
            knots.lowered_greville(number[axis].min(knots.functions() - 2))
        });
        water.still_pressure(&x, t)
    });
    pressures.collect()
}

/// Ground with pore-water flow in a step.
struct FlowingGround<'a, K, const D: usize> {
    model: &'a Model<K, D>,
    water: &'a Water<D>,
    flow: &'a Flow<D>,
    points: &'a Points<D>,
    interval: TimeInterval,
    last: f64,    // factor of the last change in the time integration (-)
    inertia: f64, // see `inertia` (m2/s2)
}

impl<'a, K: Kinematics<D>, const D: usize> FlowingGround<'a, K, D> {
    /// Creates the ground of a step whose time integration has the factor `last` of the last change.
    fn of(
        model: &'a Model<K, D>,
        water: &'a Water<D>,
        flow: &'a Flow<D>,
        points: &'a Points<D>,
        interval: TimeInterval,
        last: f64,
    ) -> Self {
        Self {
            model,
            water,
            flow,
            points,
            interval,
            last,
            inertia: inertia(model, interval.dt),
        }
    }

    /// Returns the sums of all functions over the points of this rank, see [`SUMS`].
    fn sums(&self, shape: &Shape<D>, wet: &[Option<FlowPoint<D>>], duration: f64) -> Contributions {
        let Self { model, water, flow, .. } = *self;
        scalars::of_scalars(shape, |p| {
            let wet = wet[p].as_ref();
            let volume = wet.map_or(0.0, |wet| wet.volume);
            let material = self.points.material[p];
            let takes = wet.map_or(0.0, |wet| wet.takes(model, water, flow, material, duration));
            [volume, volume * self.excess(p), takes].map(|value| (value, Vector::zeros()))
        })
    }

    /// Returns the excess pressure of point `p` at the start of the step (Pa).
    fn excess(&self, p: usize) -> f64 {
        match &self.points.pore_pressure {
            Some(pressure) => pressure[p],
            None => self.water.excess_at_start(&self.points.x[p]),
        }
    }

    /// Returns the gradient of the whole pore pressure at point `p` at the start of the step, plus the carried-over
    /// part of its last change (Pa/m).
    fn gradient(&self, p: usize) -> Vector<D> {
        let points = self.points;
        let before = match &points.pressure_gradient {
            Some(before) => before[p],
            None => self.water.still_gradient(&points.x[p], self.interval.start),
        };
        let change = points.gradient_change.as_ref();
        before + change.map_or_else(Vector::zeros, |change| change[p] * self.last)
    }

    /// Returns the state of point `p` at the start of the step; `None` if its material has no pore-water flow.
    fn wet(&self, p: usize) -> Option<FlowPoint<D>> {
        let Self {
            model,
            water,
            flow,
            points,
            last,
            inertia,
            ..
        } = *self;
        let t = self.interval.start;
        let end = self.interval.end();
        let material = usize::from(points.material[p]);
        let soil = flow.soils[material].as_ref()?;
        let law = &model.materials[material];
        let skeleton = law.elastic().oedometric() * law.relative_stiffness(points.height(p));
        let inertia = inertia * points.mass[p] / points.volume[p];
        let stiffness = skeleton + inertia;
        let volume = points.volume[p];
        let J = points.F.at(p).determinant();
        let x = &points.x[p];
        let pressure = self.excess(p);
        let edges = model
            .grid
            .locate(x)
            .map_or_else(Vector::zeros, |cell| model.grid.cell_box(&cell).1);
        let still = water.still_gradient(x, end);
        let holds = flow.retains();
        let whole = if holds {
            pressure + water.still_pressure(x, t)
        } else {
            pressure
        };
        let retained = soil.retained(whole, water.unit_weight);
        let flows = if flow.permeability(points.material[p], J).is_some() {
            1.0
        } else {
            0.0
        };
        Some(FlowPoint {
            volume,
            J,
            mean_J: J * points.dilation_of(p),
            content: soil.content(flow.bulk, J, whole) * retained.saturation,
            goes_on: points.content_change.as_ref().map_or(0.0, |change| last * change[p]),
            pressure: whole,
            ambient: if holds { water.still_pressure(x, end) } else { 0.0 },
            borne: model
                .still_water(end)
                .filter(|_| holds)
                .map_or(0.0, |still| still.pressure(x)),
            stiffness,
            inertia,
            tau: edges.component_mul(&edges) * (volume * J * TAU / stiffness),
            before: self.gradient(p),
            still,
            drive: (still - water.weight(model, end)) * flows,
        })
    }
}

impl<const D: usize> FlowPoint<D> {
    /// Returns the stabilisation term for the gradient of the excess pressure (Pa/m), before the factor `lumped` (m3
    /// m).
    pub fn tau_of(&self, gradient: Vector<D>) -> Vector<D> {
        self.tau.component_mul(&(gradient + self.still - self.before))
    }

    /// Returns the factor of the stabilisation term (-): 1 plus the lumped storage of pores whose saturation changes by
    /// `chord` (1/Pa).
    pub fn lumped(&self, soil: &Soil<D>, chord: f64) -> f64 {
        1.0 + self.lumps(soil) * chord
    }

    /// Returns the derivative of `lumped` with respect to the chord (Pa).
    pub fn lumps(&self, soil: &Soil<D>) -> f64 {
        self.stiffness / self.J * soil.pores(self.mean_J)
    }

    /// Returns the volume of water that the point stores, and that flows through a cell in `duration` (s), per pressure
    /// (m3/Pa).
    fn takes<K>(&self, model: &Model<K, D>, water: &Water<D>, flow: &Flow<D>, material: u16, duration: f64) -> f64 {
        let conductivity = flow.permeability(material, self.mean_J).unwrap_or_else(Vector::zeros);
        let flows = duration * conductivity.max() / (water.unit_weight * model.grid.smallest_edge().powi(2));
        self.volume * (self.content / flow.bulk + self.J.powi(2) / self.stiffness + self.J * flows)
    }
}

/// Returns the excess pressures that faces of the grid prescribe at time `t`, nodal (Pa).
fn given<const D: usize>(grid: &Grid<D>, water: &Water<D>, flow: &Flow<D>, t: f64) -> Vec<Option<f64>> {
    let mut prescribed = vec![None; grid.nodes()];
    if flow.motion != Motion::Flows {
        return prescribed;
    }
    for face in flow.faces.iter().filter(|face| face.acts) {
        for node in face_functions(grid, face.axis, face.upper) {
            let number = grid.node_at(node);
            // The grid has one more function per axis than the functions of degree q - 1; the last number is unused.
            if (0..D).any(|axis| number[axis] + 2 > grid.axes()[axis].functions()) {
                continue;
            }
            let x = Vector::from_fn(|axis, _| grid.axes()[axis].lowered_greville(number[axis]));
            prescribed[node] = Some(
                face.given
                    .excess(water.unit_weight, &x, t, |x| water.still_pressure(x, t)),
            );
        }
    }
    prescribed
}

/// Returns the nodes whose functions of degree q - 1 are not zero on a face of the grid.
pub fn face_functions<const D: usize>(grid: &Grid<D>, axis: usize, upper: bool) -> Vec<usize> {
    let wanted = if upper { grid.axes()[axis].functions() - 2 } else { 0 };
    (0..grid.nodes())
        .filter(|&node| grid.node_at(node)[axis] == wanted)
        .collect()
}
