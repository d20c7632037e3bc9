//! Nodal pore pressures at the start of a step: unknowns, prescribed values and stabilisation, theory-manual equation
//! (T8.11).

use crate::error::StepError;
use crate::grid::transfer::scalars;
use crate::grid::{Grid, Shape};
use crate::kinematics::Kinematics;
use crate::model::{Model, Regime};
use crate::parallel::{Halo, over_layers};
use crate::points::Points;
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
pub struct Wet<const D: usize> {
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
pub struct Pores<const D: usize> {
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
    pub wet: Vec<Option<Wet<D>>>,
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

impl<const D: usize> Pores<D> {
    /// Of the step from `t` to `t + dt`; `None` where no water flows, or its pressures are held. Fails where a drain is
    /// on tight material.
    pub fn of<K: Kinematics<D>>(
        model: &Model<K, D>,
        (full, points): (&Shape<D>, &Points<D>),
        (t, dt): (f64, f64),
        halo: &dyn Halo,
    ) -> Result<Option<Self>, StepError> {
        let Some((water, flow)) = model
            .water
            .as_ref()
            .and_then(|water| Some((water, water.flow.as_ref()?)))
        else {
            return Ok(None);
        };
        if flow.motion == Motion::Held {
            return Ok(None);
        }
        let (shape, end) = (full.lowered_with_derivatives(&model.grid, points), t + dt);
        let differences = Differences::of(model, points, (t, end));
        let duration = differences.now * dt;
        let inertia = inertia(model, dt);
        let of_point = |p: usize| Wet::of(model, (water, flow), (points, p), (t, end), differences.last, inertia);
        let wet: Vec<Option<Wet<D>>> = (0..points.len()).map(of_point).collect();
        let pressure = points.pore_pressure.as_ref();
        let sums = halo.sum(&scalars::of_scalars(&shape, |p| {
            let volume = wet[p].as_ref().map_or(0.0, |wet| wet.volume);
            let takes = wet[p]
                .as_ref()
                .map_or(0.0, |wet| wet.takes(model, (water, flow), points.material[p], duration));
            let values = [
                volume,
                volume * pressure.map_or_else(|| water.excess_at_start(&points.x[p]), |pressure| pressure[p]),
                takes,
            ];
            values.map(|value| (value, Vector::zeros()))
        }));
        let mut largest = [sums.chunks_exact(SUMS).map(|of| of[0]).fold(0.0, f64::max)];
        halo.maximum(&mut largest);
        let seen: Vec<bool> = sums.chunks_exact(SUMS).map(|of| of[0] > UNSEEN * largest[0]).collect();
        let mut prescribed = vec![None; seen.len()];
        if flow.motion == Motion::Flows {
            given(&model.grid, (water, flow), end, &mut prescribed);
        }
        let free: Vec<bool> = seen
            .iter()
            .zip(&prescribed)
            .map(|(seen, given)| *seen && given.is_none())
            .collect();
        let mean = |node: usize| {
            if seen[node] {
                sums[SUMS * node + 1] / sums[SUMS * node]
            } else {
                0.0
            }
        };
        let guess = (0..seen.len())
            .map(|node| prescribed[node].unwrap_or_else(|| mean(node)))
            .collect();
        let still = |x: &Vector<D>| water.still_pressure(x, end);
        let at_nodes = (0..if flow.retains() { seen.len() } else { 0 }).map(|node| {
            let number = model.grid.node_at(node);
            let place = |axis: usize| {
                let axis_of = &model.grid.axes()[axis];
                axis_of.lowered_greville(number[axis].min(axis_of.functions() - 2))
            };
            still(&Vector::from_fn(|axis, _| place(axis)))
        });
        let at_nodes = at_nodes.collect();
        let drainage = Drainage::at(model, points, ((t, dt), differences), |node| seen[node], still, halo)?;
        let takes: Vec<f64> = sums.chunks_exact(SUMS).map(|of| of[2]).collect();
        let ties = Ties::of(&model.grid, &seen, &takes);
        let limit = |node: usize| {
            if free[node] {
                (ROUND_OFF * sums[SUMS * node]).powi(2)
            } else {
                0.0
            }
        };
        let round_off = halo.total(&[over_layers(halo, 1, limit)])[0].sqrt();
        let mut unknowns = [halo.owned().nodes().filter(|&node| free[node]).count() as f64];
        halo.reduce(&mut unknowns);
        let unknowns = unknowns[0] as usize;
        Ok(Some(Self {
            shape,
            seen,
            free,
            prescribed,
            guess,
            still: at_nodes,
            wet,
            drainage,
            ties,
            differences,
            duration,
            end,
            unknowns,
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

impl<const D: usize> Wet<D> {
    fn of<K: Kinematics<D>>(
        model: &Model<K, D>,
        (water, flow): (&Water<D>, &Flow<D>),
        (points, p): (&Points<D>, usize),
        (t, end): (f64, f64),
        last: f64,
        inertia: f64,
    ) -> Option<Self> {
        let material = usize::from(points.material[p]);
        let soil = flow.soils[material].as_ref()?;
        let law = &model.materials[material];
        let skeleton = law.elastic().oedometric() * law.relative_stiffness(points.height(p));
        let inertia = inertia * points.mass[p] / points.volume[p];
        let stiffness = skeleton + inertia;
        let (volume, J, x) = (points.volume[p], points.F.at(p).determinant(), &points.x[p]);
        let pressure = points
            .pore_pressure
            .as_ref()
            .map_or_else(|| water.excess_at_start(x), |pressure| pressure[p]);
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
        Some(Self {
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
            before: points
                .pressure_gradient
                .as_ref()
                .map_or_else(|| water.still_gradient(x, t), |before| before[p])
                + points
                    .gradient_change
                    .as_ref()
                    .map_or_else(Vector::zeros, |change| change[p] * last),
            still,
            drive: (still - water.weight(model, end)) * flows,
        })
    }
}

impl<const D: usize> Wet<D> {
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
    fn takes<K>(&self, model: &Model<K, D>, (water, flow): (&Water<D>, &Flow<D>), material: u16, duration: f64) -> f64 {
        let conductivity = flow.permeability(material, self.mean_J).unwrap_or_else(Vector::zeros);
        let flows = duration * conductivity.max() / (water.unit_weight * model.grid.smallest_edge().powi(2));
        self.volume * (self.content / flow.bulk + self.J.powi(2) / self.stiffness + self.J * flows)
    }
}

/// Puts the pressures that faces of the grid have in the place of their nodes.
fn given<const D: usize>(grid: &Grid<D>, (water, flow): (&Water<D>, &Flow<D>), t: f64, prescribed: &mut [Option<f64>]) {
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
}

/// Nodes of the functions of degree q - 1 that are not zero on a face.
pub fn face_functions<const D: usize>(grid: &Grid<D>, axis: usize, upper: bool) -> Vec<usize> {
    let wanted = if upper { grid.axes()[axis].functions() - 2 } else { 0 };
    (0..grid.nodes())
        .filter(|&node| grid.node_at(node)[axis] == wanted)
        .collect()
}
