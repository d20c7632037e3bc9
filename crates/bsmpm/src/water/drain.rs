//! Drains, seepage faces and inflows on surfaces of bodies, theory-manual equation (T8.13). They contribute to the
//! water balance and to the pressure matrix.

use crate::boundary::anchor::turned;
use crate::boundary::surface::Attachment;
use crate::boundary::{Anchors, SurfacePoint};
use crate::error::StepError;
use crate::exact::Exact;
use crate::grid::{Contributions, Grid};
use crate::model::Model;
use crate::parallel::{Halo, LinearSolver};
use crate::points::Points;
use crate::tensor::Vector;
use crate::water::backward::Differences;
use crate::water::flow::{Flow, Given, Motion};

/// Conductance of a drain over that of the soil of a cell, k/(gamma_w h).
///
/// With more of it a curved surface that cuts the cells asks more of the pressure than its functions have. Flow through
/// a ring whose inner radius is 4, 8, 16 cells is off by 0.5, 0.02, 0.02 % with 1e2, by 5.7, 1.0, 0.4 % with 1e4, and
/// by
/// -1.7, -1.2, -0.5 % with 1e1, where the drain itself resists.
const CONDUCTANCE: f64 = 1e2;
/// Parts of a cell by which ends of neighbours may lie apart.
const ON: f64 = 1e-9;

/// What a drain or inflow did in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DrainReport {
    /// m3  of water that went through: out of a drain, into the ground by an inflow
    pub through: f64,
    /// points with material near
    pub held: usize,
}

/// Drains and inflows of one step: the points of this rank.
#[derive(Clone, Debug, Default)]
pub struct Drainage {
    offsets: Vec<usize>,
    of: [usize; 2], // drains, inflows
    outlets: Vec<WaterCrossing>,
    /// cells between points of every surface that were neighbours at the start: the most, 0 of those that do not act
    pub torn: Vec<f64>,
}

/// A surface point that water goes through: a sink, or a source.
#[derive(Clone, Debug)]
struct WaterCrossing {
    surface: usize, // of the drains, then of the inflows
    attachment: Attachment,
    conductance: f64, // m3/Pa  in that time
    given: f64,       // Pa  excess
    inflow: f64,      // m3  in that time
    one_way: bool,    // lets water out only, where the pressure is above the given one
}

impl WaterCrossing {
    /// m3  out of the ground in that time, under the excess pressures `p`, Pa, nodal.
    fn out(&self, offsets: &[usize], p: &[f64]) -> f64 {
        if !self.is_open(offsets, p) {
            return -self.inflow;
        }
        self.conductance * (self.attachment.value(offsets, p) - self.given) - self.inflow
    }

    /// Whether its conductance acts.
    fn is_open(&self, offsets: &[usize], p: &[f64]) -> bool {
        !self.one_way || self.attachment.value(offsets, p) > self.given
    }
}

impl Drainage {
    /// Of a step of `dt` from `t` that takes these `differences`, and the points at its start; by the functions of
    /// degree q - 1 that `counts` says. `still` is the pressure of the still water at the end, Pa. One reduction,
    /// before the first step three. Fails on all ranks where a surface is on material that lets no water through.
    pub fn at<K, const D: usize>(
        model: &Model<K, D>,
        points: &Points<D>,
        ((t, dt), differences): ((f64, f64), Differences),
        counts: impl Fn(usize) -> bool,
        still: impl Fn(&Vector<D>) -> f64,
        halo: &dyn Halo,
    ) -> Result<Self, StepError> {
        let Some((water, flow)) = model
            .water
            .as_ref()
            .and_then(|water| Some((water, water.flow.as_ref()?)))
        else {
            return Ok(Self::default());
        };
        let of = [flow.drains.len(), flow.inflows.len()];
        if of == [0; 2] || flow.motion != Motion::Flows {
            return Ok(Self { of, ..Self::default() });
        }
        let (grid, offsets) = (&model.grid, model.grid.lowered_offsets());
        let (end, duration) = (t + dt, differences.now * dt);
        let anchors = Anchors::of(&model.surfaces(), &points.surface.anchors, points.anchored(), halo).water;
        let mut places = places(flow, points, &anchors, halo).into_iter();
        let (mut outlets, mut torn) = (Vec::new(), vec![0.0; of[0] + of[1]]);
        for ((surface, (starts, _)), acts) in flow.surfaces().enumerate().zip(flow.acting()) {
            let kept = |place: SurfacePlace<D>| SurfacePlace {
                x: model.boundary.kept_in(grid, place.x),
                ..place
            };
            let here: Vec<SurfacePlace<D>> = places.by_ref().take(starts.len()).map(kept).collect();
            if !acts {
                continue;
            }
            let tight = here.iter().filter(|place| !place.drained).count();
            if tight > 0 {
                return Err(StepError::Undrained {
                    drain: surface,
                    points: tight,
                });
            }
            torn[surface] = cells_apart(grid, starts, &here);
            let inflow = surface
                .checked_sub(flow.drains.len())
                .map(|number| &flow.inflows[number]);
            let rate = inflow.map_or(0.0, |inflow| differences.of_rate(&inflow.rate, (t, dt)));
            for (place, SurfacePoint { area, .. }) in here.iter().zip(starts) {
                let attachment = Attachment::lowered_at(grid, &offsets, &counts, &place.x);
                let Some(attachment) = attachment else { continue };
                let through = duration * area * place.normal.norm();
                let none = WaterCrossing {
                    surface,
                    attachment,
                    conductance: 0.0,
                    given: 0.0,
                    inflow: 0.0,
                    one_way: false,
                };
                let conductance = through * CONDUCTANCE * place.leads(grid) / water.unit_weight;
                let dry = Given::Seepage.excess(water.unit_weight, &place.x, end, &still);
                outlets.push(match flow.drains.get(surface) {
                    Some(drain) => {
                        let given = drain.given.excess(water.unit_weight, &place.x, end, &still);
                        let one_way = drain.given == Given::Seepage && still(&place.x) <= 0.0;
                        WaterCrossing {
                            conductance,
                            given,
                            one_way,
                            ..none
                        }
                    }
                    None => {
                        let rain = WaterCrossing {
                            inflow: through * rate,
                            ..none
                        };
                        if inflow.is_some_and(|inflow| inflow.runs_off) {
                            WaterCrossing {
                                conductance,
                                given: dry,
                                one_way: true,
                                ..rain
                            }
                        } else {
                            rain
                        }
                    }
                });
            }
        }
        Ok(Self {
            offsets,
            of,
            outlets,
            torn,
        })
    }

    /// Adds what leaves the ground in the step under the excess pressures `p` (Pa, nodal, one number a node) to the
    /// balance of the water, m3, the last of the numbers of every node; other ranks' parts are not yet in it.
    pub fn add_to(&self, p: &[f64], out: &mut Contributions) {
        for outlet in &self.outlets {
            outlet
                .attachment
                .scatter_value(&self.offsets, outlet.out(&self.offsets, p), out);
        }
    }

    /// Adds what that changes by where the pressures `p` change by `v`, Pa.
    pub fn add_changes(&self, p: &[f64], v: &[f64], out: &mut Contributions) {
        for outlet in self.outlets.iter().filter(|outlet| outlet.is_open(&self.offsets, p)) {
            let change = outlet.conductance * outlet.attachment.value(&self.offsets, v);
            outlet.attachment.scatter_value(&self.offsets, change, out);
        }
    }

    /// Which of the surface points of this rank let water through under the excess pressures `p`, Pa: of those that let
    /// it out only.
    pub fn open(&self, p: &[f64]) -> Vec<bool> {
        let one_way = self.outlets.iter().filter(|outlet| outlet.one_way);
        one_way.map(|outlet| outlet.is_open(&self.offsets, p)).collect()
    }

    /// Adds the derivative of that to the matrix of the pressures, m3/Pa: of drains that let water out only where they
    /// are open under `p`.
    pub fn assemble(&self, p: &[f64], solver: &mut dyn LinearSolver) {
        let acts = |outlet: &&WaterCrossing| outlet.conductance > 0.0 && outlet.is_open(&self.offsets, p);
        for outlet in self.outlets.iter().filter(acts) {
            let N = outlet.attachment.N();
            let block: Vec<f64> = N
                .iter()
                .flat_map(|row| N.iter().map(move |column| outlet.conductance * row * column))
                .collect();
            solver.add(outlet.attachment.first_node(), &block);
        }
    }

    /// J  what the water that leaves under the excess pressures `p`, Pa, takes along, on this rank, `times` as often.
    pub fn work(&self, p: &[f64], times: f64) -> Exact {
        let of =
            |outlet: &WaterCrossing| times * outlet.attachment.value(&self.offsets, p) * outlet.out(&self.offsets, p);
        self.outlets.iter().map(of).collect()
    }

    /// What every drain, and every inflow, did under the converged excess pressures `p`, Pa. One reduction.
    pub fn report(&self, p: &[f64], halo: &dyn Halo) -> [Vec<DrainReport>; 2] {
        let surfaces: usize = self.of.iter().sum();
        if surfaces == 0 {
            return Default::default();
        }
        let mut sums = vec![Exact::default(); 2 * surfaces];
        for outlet in &self.outlets {
            let out = outlet.out(&self.offsets, p);
            sums[2 * outlet.surface].add(if outlet.surface < self.of[0] { out } else { -out });
            sums[2 * outlet.surface + 1].add(1.0);
        }
        let totals = halo.total(&sums);
        let mut each = totals.chunks_exact(2).map(|sums| DrainReport {
            through: sums[0],
            held: sums[1] as usize,
        });
        self.of.map(|count| each.by_ref().take(count).collect())
    }
}

/// What a surface point is at.
struct SurfacePlace<const D: usize> {
    x: Vector<D>,            // m
    normal: Vector<D>,       // of the length that the area is now over that of the start
    permeability: Vector<D>, // m/s  along the axes
    drained: bool,           // whether the material lets water through at all
}

impl<const D: usize> SurfacePlace<D> {
    /// 1/s  permeability across the surface over the edges of the cell that it is in.
    fn leads(&self, grid: &Grid<D>) -> f64 {
        let edges = grid.locate(&self.x).map(|cell| grid.cell_box(&cell).1);
        let edge = |axis: usize| edges.map_or(grid.smallest_edge(), |edges| edges[axis]);
        let along = |axis: usize| self.normal[axis].powi(2) * self.permeability[axis] / edge(axis);
        (0..D).map(along).sum::<f64>() / self.normal.norm_squared()
    }
}

/// The most cells that are now between points of a surface whose corners met at the start, or which were within a cell,
/// in the order of the surface: what the ground has laid bare between them is closed.
fn cells_apart<const D: usize>(grid: &Grid<D>, starts: &[SurfacePoint<D>], places: &[SurfacePlace<D>]) -> f64 {
    let edge = grid.smallest_edge();
    let meet = |a: &Vector<D>, b: &Vector<D>| (a - b).norm() <= ON * edge;
    let meets = |pair: &[SurfacePoint<D>]| {
        let ends = pair[0]
            .corners
            .iter()
            .any(|a| pair[1].corners.iter().any(|b| meet(a, b)));
        ends || (pair[0].x - pair[1].x).norm() < edge
    };
    let pairs = starts
        .windows(2)
        .zip(places.windows(2))
        .filter(|(starts, _)| meets(starts));
    let apart = |places: &[SurfacePlace<D>]| {
        let edges = grid
            .locate(&places[0].x)
            .map_or_else(|| Vector::from_element(edge), |cell| grid.cell_box(&cell).1);
        (places[1].x - places[0].x).component_div(&edges).norm()
    };
    pairs.map(|(_, places)| apart(places)).fold(0.0, f64::max)
}

/// Those of all surface points, now. One reduction.
fn places<const D: usize>(
    flow: &Flow<D>,
    points: &Points<D>,
    anchors: &[Vec<u64>],
    halo: &dyn Halo,
) -> Vec<SurfacePlace<D>> {
    let starts: Vec<(&SurfacePoint<D>, &Vector<D>)> = flow
        .surfaces()
        .flat_map(|(points, normals)| points.iter().zip(normals))
        .collect();
    let (width, anchored) = (3 * D + 1, points.anchored());
    let mut numbers = vec![0.0; width * starts.len()];
    anchored.visit(anchors.iter().flatten(), |p, at| {
        let ((start, normal), F) = (starts[at], points.F.at(p));
        let permeability = flow.permeability(points.material[p], F.determinant() * points.dilation_of(p));
        let vectors = [
            anchored.along(p, &start.x),
            turned(&F, normal),
            permeability.unwrap_or_else(Vector::zeros),
        ];
        let all = vectors
            .iter()
            .flatten()
            .copied()
            .chain([f64::from(u8::from(permeability.is_some()))]);
        numbers[width * at..]
            .iter_mut()
            .zip(all)
            .for_each(|(number, value)| *number = value);
    });
    // Each number is of one rank alone.
    halo.reduce(&mut numbers);
    let place = |numbers: &[f64]| {
        let vector = |k: usize| Vector::from_column_slice(&numbers[k * D..(k + 1) * D]);
        SurfacePlace {
            x: vector(0),
            normal: vector(1),
            permeability: vector(2),
            drained: numbers[3 * D] > 0.0,
        }
    };
    numbers.chunks_exact(width).map(place).collect()
}

impl Given {
    /// Pa  excess pressure at the place `x` at time `t`, where `still` is the pressure of the still water; `weight`:
    /// the water's, N/m3
    pub(super) fn excess<const D: usize>(
        &self,
        weight: f64,
        x: &Vector<D>,
        t: f64,
        still: impl Fn(&Vector<D>) -> f64,
    ) -> f64 {
        match self {
            // Suction above the level is of the ground, not of its surface.
            Self::StillWater | Self::Seepage => {
                let still = still(x);
                if still < 0.0 { -still } else { 0.0 }
            }
            Self::Head(head) => weight * (head.at(t) - x[D - 1]) - still(x),
            Self::Pressure(pressure) => pressure.at(t) - still(x),
        }
    }
}
