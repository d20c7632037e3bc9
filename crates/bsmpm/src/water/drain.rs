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
use crate::schedule::TimeInterval;
use crate::tensor::Vector;
use crate::water::backward::Differences;
use crate::water::flow::{Drain, Flow, Given, Inflow, Motion};

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

/// A surface that water crosses in a step.
struct CrossedSurface<'a, const D: usize> {
    number: usize,
    drain: Option<&'a Drain<D>>,
    inflow: Option<&'a Inflow<D>>, // if it is no drain
    rate: f64,                     // m/s  of the inflow
    duration: f64,                 // s
    end: f64,                      // s
    unit_weight: f64,              // N/m3  of water
}

impl<'a, const D: usize> CrossedSurface<'a, D> {
    /// Of a number among the drains and then the inflows, in a step that takes these `differences`.
    fn of(
        flow: &'a Flow<D>,
        number: usize,
        unit_weight: f64,
        differences: Differences,
        interval: TimeInterval,
    ) -> Self {
        let of_inflows = number.checked_sub(flow.drains.len());
        let inflow = of_inflows.map(|number| &flow.inflows[number]);
        Self {
            number,
            drain: flow.drains.get(number),
            inflow,
            rate: inflow.map_or(0.0, |inflow| differences.of_rate(&inflow.rate, interval)),
            duration: differences.now * interval.dt,
            end: interval.end(),
            unit_weight,
        }
    }

    /// Of a point at a `place`, whose `area` is that at the start, m2.
    fn crossing(
        &self,
        grid: &Grid<D>,
        place: &SurfacePlace<D>,
        area: f64,
        attachment: Attachment,
        still: &impl Fn(&Vector<D>) -> f64,
    ) -> WaterCrossing {
        let through = self.duration * area * place.normal.norm();
        let conductance = through * CONDUCTANCE * place.leads(grid) / self.unit_weight;
        let closed = WaterCrossing {
            surface: self.number,
            attachment,
            conductance: 0.0,
            given: 0.0,
            inflow: through * self.rate,
            one_way: false,
        };
        if let Some(drain) = self.drain {
            return WaterCrossing {
                conductance,
                given: drain.given.excess(self.unit_weight, &place.x, self.end, still),
                inflow: 0.0,
                one_way: drain.given == Given::Seepage && still(&place.x) <= 0.0,
                ..closed
            };
        }
        if self.inflow.is_some_and(|inflow| inflow.runs_off) {
            return WaterCrossing {
                conductance,
                given: Given::Seepage.excess(self.unit_weight, &place.x, self.end, still),
                one_way: true,
                ..closed
            };
        }
        closed
    }
}

impl Drainage {
    /// Of a step that takes these `differences`, and the points at its start; by the functions of
    /// degree q - 1 that `counts` says. `still` is the pressure of the still water at the end, Pa. One reduction,
    /// before the first step three. Fails on all ranks where a surface is on material that lets no water through.
    pub fn at<K, const D: usize>(
        model: &Model<K, D>,
        points: &Points<D>,
        interval: TimeInterval,
        differences: Differences,
        counts: impl Fn(usize) -> bool,
        still: impl Fn(&Vector<D>) -> f64,
        halo: &dyn Halo,
    ) -> Result<Self, StepError> {
        let water = model.water.as_ref();
        let Some((water, flow)) = water.and_then(|water| Some((water, water.flow.as_ref()?))) else {
            return Ok(Self::default());
        };
        let of = [flow.drains.len(), flow.inflows.len()];
        if of == [0; 2] || flow.motion != Motion::Flows {
            return Ok(Self { of, ..Self::default() });
        }
        let grid = &model.grid;
        let offsets = model.grid.lowered_offsets();
        let anchors = Anchors::of(&model.surfaces(), &points.surface.anchors, points.anchored(), halo).water;
        let mut places = places(flow, points, &anchors, halo).into_iter();
        let mut outlets = Vec::new();
        let mut torn = vec![0.0; of[0] + of[1]];
        for ((surface, (starts, _)), acts) in flow.surfaces().enumerate().zip(flow.acting()) {
            let mut here: Vec<SurfacePlace<D>> = places.by_ref().take(starts.len()).collect();
            here.iter_mut()
                .for_each(|place| place.x = model.boundary.kept_in(grid, place.x));
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
            let surface = CrossedSurface::of(flow, surface, water.unit_weight, differences, interval);
            for (place, SurfacePoint { area, .. }) in here.iter().zip(starts) {
                let attachment = Attachment::lowered_at(grid, &offsets, &counts, &place.x);
                outlets.extend(attachment.map(|attachment| surface.crossing(grid, place, *area, attachment, &still)));
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
        let conducting = self.outlets.iter().filter(|outlet| outlet.conductance > 0.0);
        for outlet in conducting.filter(|outlet| outlet.is_open(&self.offsets, p)) {
            let N = outlet.attachment.N();
            let block: Vec<f64> = N
                .iter()
                .flat_map(|row| N.iter().map(move |column| outlet.conductance * row * column))
                .collect();
            solver.add_block(outlet.attachment.first_node(), &block);
        }
    }

    /// J  what the water that leaves under the excess pressures `p`, Pa, takes along, on this rank, `times` as often.
    pub fn work(&self, p: &[f64], times: f64) -> Exact {
        self.outlets
            .iter()
            .map(|outlet| times * outlet.attachment.value(&self.offsets, p) * outlet.out(&self.offsets, p))
            .collect()
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
        let totals = halo.reproducible_sum(&sums);
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
        let edges = edges_at(grid, &self.x);
        let along = (0..D).map(|axis| self.normal[axis].powi(2) * self.permeability[axis] / edges[axis]);
        along.sum::<f64>() / self.normal.norm_squared()
    }
}

/// The most cells that are now between points of a surface whose corners met at the start, or which were within a cell,
/// in the order of the surface: what the ground has laid bare between them is closed.
fn cells_apart<const D: usize>(grid: &Grid<D>, starts: &[SurfacePoint<D>], places: &[SurfacePlace<D>]) -> f64 {
    let edge = grid.smallest_edge();
    let mut most = 0.0_f64;
    for (starts, places) in starts.windows(2).zip(places.windows(2)) {
        if are_neighbours(&starts[0], &starts[1], edge) {
            let apart = (places[1].x - places[0].x).component_div(&edges_at(grid, &places[0].x));
            most = most.max(apart.norm());
        }
    }
    most
}

/// Whether two surface points have corners that meet, or are within an `edge` of each other, m.
fn are_neighbours<const D: usize>(a: &SurfacePoint<D>, b: &SurfacePoint<D>, edge: f64) -> bool {
    let mut pairs = a
        .corners
        .iter()
        .flat_map(|one| b.corners.iter().map(move |other| one - other));
    pairs.any(|apart| apart.norm() <= ON * edge) || (a.x - b.x).norm() < edge
}

/// Edges of the cell at `x`, m; outside the grid the smallest of all.
fn edges_at<const D: usize>(grid: &Grid<D>, x: &Vector<D>) -> Vector<D> {
    grid.locate(x).map_or_else(
        || Vector::from_element(grid.smallest_edge()),
        |cell| grid.cell_box(&cell).1,
    )
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
    let width = 3 * D + 1;
    let anchored = points.anchored();
    let mut numbers = vec![0.0; width * starts.len()];
    anchored.visit(anchors.iter().flatten(), |p, at| {
        let (start, normal) = starts[at];
        let F = points.F.at(p);
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
    halo.all_reduce_sum(&mut numbers);
    let places = numbers.chunks_exact(width).map(|numbers| {
        let [x, normal, permeability] = [0, 1, 2].map(|k| Vector::from_column_slice(&numbers[k * D..][..D]));
        SurfacePlace {
            x,
            normal,
            permeability,
            drained: numbers[3 * D] > 0.0,
        }
    });
    places.collect()
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
