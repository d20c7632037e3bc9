//! Nodal pore pressures at the start of a step: unknowns, prescribed values and stabilisation, theory-manual equation
//! (T8.11).

use crate::error::StepError;
use crate::grid::transfer::scalars;
use crate::grid::{Contributions, Grid, Shape};
use crate::kinematics::Kinematics;
use crate::model::{Model, Regime};
use crate::parallel::{Halo, over_layers};
use crate::points::Points;
use crate::schedule::TimeInterval;
use crate::tensor::Vector;
use crate::water::Water;
use crate::water::backward::Differences;
use crate::water::drain::Drainage;
use crate::water::flow::{Flow, Motion, Soil};
use crate::water::ties::Ties;

/// Share of the tau term, of h^2/M: with it the pair of splines of degree q and q - 1 is stable, and in one dimension
/// the storage is lumped (T8.11).
const TAU: f64 = 1.0 / 6.0;
/// Square of the wave number of the shortest wave that cells hold, over 1/h^2.
pub(super) const SHORTEST_WAVE: f64 = 10.0;
/// Functions that see less than this part of the largest volume have no pressure.
const UNSEEN: f64 = 1e-14;
/// Round-off of the water's balance, of the volume that a function sees.
const ROUND_OFF: f64 = 1e-13;
/// Numbers of a function: the volume that it sees, that times the pressure, and what it stores and lets flow.
const SUMS: usize = 3;

/// A point that water flows through, at the start of a step.
#[derive(Clone, Copy, Debug)]
pub struct SaturatedPoint<const D: usize> {
    /// m^D  reference volume
    pub volume: f64,
    /// -  J at t
    pub J: f64,
    /// -  J-bar at t, which the skeleton's stress has felt, and the pores with it
    pub mean_J: f64,
    /// -  water per reference volume at t
    pub content: f64,
    /// -  as much as comes in because it came in before, see [`Differences`]
    pub goes_on: f64,
    /// Pa  whole pore pressure at t; of pores that stay full the excess alone
    pub pressure: f64,
    /// Pa  still water at t + dt, which with the excess is the whole pressure; 0 where all pores stay full
    pub ambient: f64,
    /// Pa  as much of it as acts on the ground as a force of its own
    pub borne: f64,
    /// Pa  what resists the shortest waves that cells hold: lambda + 2 mu, and in dynamics the inertia of a step
    pub stiffness: f64,
    /// Pa  as much of it as is inertia
    pub inertia: f64,
    /// m^D m2/Pa  V0 J tau h_i^2 over the stiffness, along the axes
    pub tau: Vector<D>,
    /// Pa/m  gradient of the whole pore pressure at t, and as much of it as goes on
    pub before: Vector<D>,
    /// Pa/m  of the still water at t + dt
    pub still: Vector<D>,
    /// Pa/m  what drives water against the excess pressure's gradient: that of the still water less the water's weight
    pub drive: Vector<D>,
}

/// The pore pressures of one step; nodal arrays of one number a node, by the functions of degree q - 1.
#[derive(Clone, Debug)]
pub struct PoreField<const D: usize> {
    /// those functions at the points
    pub shape: Shape<D>,
    /// per node: points see it
    pub seen: Vec<bool>,
    /// per node: an unknown
    pub free: Vec<bool>,
    /// Pa  excess pressure at t + dt where it is given
    pub prescribed: Vec<Option<f64>>,
    /// Pa  excess pressure to begin with: the points' mean, or what is given
    pub guess: Vec<f64>,
    /// Pa  still water at the functions' places, where pores may empty; else none
    pub still: Vec<f64>,
    /// per point: of those that water flows through
    pub wet: Vec<Option<SaturatedPoint<D>>>,
    /// drains and inflows
    pub drainage: Drainage,
    /// across lines where strains may jump
    pub ties: Ties,
    /// the step's differences in time
    pub differences: Differences,
    /// s  for which flows at the end of the step count
    pub duration: f64,
    /// s  end of the step
    pub end: f64,
    /// unknowns, over all ranks
    pub unknowns: usize,
    /// m3  norm of what is round-off in the balance
    pub round_off: f64,
}

impl<const D: usize> PoreField<D> {
    /// Of the step from `t` to `t + dt`; `None` where no water flows, or its pressures are held. Fails where a drain is
    /// on tight material.
    pub fn of<K: Kinematics<D>>(
        model: &Model<K, D>,
        full: &Shape<D>,
        points: &Points<D>,
        interval: TimeInterval,
        halo: &dyn Halo,
    ) -> Result<Option<Self>, StepError> {
        let Some(water) = &model.water else { return Ok(None) };
        let Some(flow) = water.flow.as_ref().filter(|flow| flow.motion != Motion::Held) else {
            return Ok(None);
        };
        let shape = full.lowered_with_derivatives(&model.grid, points);
        let end = interval.end();
        let differences = Differences::of(model, points, interval);
        let duration = differences.now * interval.dt;
        let ground = FlowingGround::of(model, water, flow, points, interval, differences.last);
        let wet: Vec<Option<SaturatedPoint<D>>> = (0..points.len()).map(|p| ground.wet(p)).collect();
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
            points,
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

/// m2/s2  what inertia resists the shortest waves with in a step of the length `dt`, s, per density: the factor of the
/// mass over the square of their wave number; 0 at rest.
fn inertia<K, const D: usize>(model: &Model<K, D>, dt: f64) -> f64 {
    match model.regime {
        Regime::QuasiStatic => 0.0,
        Regime::Dynamic => model.newmark.factor(dt) * model.grid.smallest_edge().powi(2) / SHORTEST_WAVE,
    }
}

/// Pa  excess pressures to begin with, nodal: what is `prescribed`, else the points' mean.
fn guess(sums: &[f64], seen: &[bool], prescribed: &[Option<f64>]) -> Vec<f64> {
    let nodes = sums.chunks_exact(SUMS).enumerate();
    let pressures = nodes.map(|(node, of)| match prescribed[node] {
        Some(given) => given,
        None if seen[node] => of[1] / of[0],
        None => 0.0,
    });
    pressures.collect()
}

/// m3  norm of what is round-off in the balance of the functions that are `free`.
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

/// Pa  pressure of the still water at the places of the functions of degree q - 1, nodal; none where all pores stay
/// full.
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

/// Ground through which water flows in a step.
struct FlowingGround<'a, K, const D: usize> {
    model: &'a Model<K, D>,
    water: &'a Water<D>,
    flow: &'a Flow<D>,
    points: &'a Points<D>,
    interval: TimeInterval,
    last: f64,    // -  factor of the last change in the difference in time
    inertia: f64, // m2/s2, see `inertia`
}

impl<'a, K: Kinematics<D>, const D: usize> FlowingGround<'a, K, D> {
    /// Of a step whose difference in time has the factor `last` of the last change.
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

    /// The numbers that every function sums up, see [`SUMS`].
    fn sums(&self, shape: &Shape<D>, wet: &[Option<SaturatedPoint<D>>], duration: f64) -> Contributions {
        let Self { model, water, flow, .. } = *self;
        scalars::of_scalars(shape, |p| {
            let wet = wet[p].as_ref();
            let volume = wet.map_or(0.0, |wet| wet.volume);
            let material = self.points.material[p];
            let takes = wet.map_or(0.0, |wet| wet.takes(model, water, flow, material, duration));
            [volume, volume * self.excess(p), takes].map(|value| (value, Vector::zeros()))
        })
    }

    /// Pa  excess pressure at point `p` at the start of the step.
    fn excess(&self, p: usize) -> f64 {
        match &self.points.pore_pressure {
            Some(pressure) => pressure[p],
            None => self.water.excess_at_start(&self.points.x[p]),
        }
    }

    /// Pa/m  gradient of the whole pore pressure at point `p` at the start of the step, and as much of it as goes on.
    fn gradient(&self, p: usize) -> Vector<D> {
        let points = self.points;
        let before = match &points.pressure_gradient {
            Some(before) => before[p],
            None => self.water.still_gradient(&points.x[p], self.interval.start),
        };
        let change = points.gradient_change.as_ref();
        before + change.map_or_else(Vector::zeros, |change| change[p] * self.last)
    }

    /// The state of point `p` at the start of the step; `None` if no water flows through its material.
    fn wet(&self, p: usize) -> Option<SaturatedPoint<D>> {
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
        Some(SaturatedPoint {
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

impl<const D: usize> SaturatedPoint<D> {
    /// m3 m  what the tau term makes of the gradient of the excess pressure, Pa/m, where nothing is lumped besides
    pub fn tau_of(&self, gradient: Vector<D>) -> Vector<D> {
        self.tau.component_mul(&(gradient + self.still - self.before))
    }

    /// -  share of the tau term whose pores fill by `chord`, 1/Pa: 1 and what it lumps of that storage
    pub fn lumped(&self, soil: &Soil<D>, chord: f64) -> f64 {
        1.0 + self.lumps(soil) * chord
    }

    /// Pa  what that changes by with the chord
    pub fn lumps(&self, soil: &Soil<D>) -> f64 {
        self.stiffness / self.J * soil.pores(self.mean_J)
    }

    /// m3/Pa  what the point stores and lets flow through a cell in `duration`, s, per pressure.
    fn takes<K>(&self, model: &Model<K, D>, water: &Water<D>, flow: &Flow<D>, material: u16, duration: f64) -> f64 {
        let conductivity = flow.permeability(material, self.mean_J).unwrap_or_else(Vector::zeros);
        let flows = duration * conductivity.max() / (water.unit_weight * model.grid.smallest_edge().powi(2));
        self.volume * (self.content / flow.bulk + self.J.powi(2) / self.stiffness + self.J * flows)
    }
}

/// Pa  excess pressures that faces of the grid give their nodes, nodal.
fn given<const D: usize>(grid: &Grid<D>, water: &Water<D>, flow: &Flow<D>, t: f64) -> Vec<Option<f64>> {
    let mut prescribed = vec![None; grid.nodes()];
    if flow.motion != Motion::Flows {
        return prescribed;
    }
    for face in flow.faces.iter().filter(|face| face.acts) {
        for node in face_functions(grid, face.axis, face.upper) {
            let number = grid.node_at(node);
            // One function more than there are of degree q - 1 has the last node's number.
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

/// Nodes of the functions of degree q - 1 that are not zero on a face.
pub fn face_functions<const D: usize>(grid: &Grid<D>, axis: usize, upper: bool) -> Vec<usize> {
    let wanted = if upper { grid.axes()[axis].functions() - 2 } else { 0 };
    (0..grid.nodes())
        .filter(|&node| grid.node_at(node)[axis] == wanted)
        .collect()
}
