//! Drains, seepage faces and inflows on surfaces of bodies, theory-manual equation (T8.13). They contribute to the
//! water balance and to the pressure matrix.

use crate::boundary::anchor::turned;
use crate::boundary::surface::Attachment;
use crate::boundary::{AnchoredPoints, Anchors, SurfacePoint};
use crate::error::StepError;
use crate::exact::Exact;
use crate::field::pore_water::backward::Differences;
use crate::field::pore_water::flow::{Drain, Flow, Given, Inflow, Motion};
use crate::grid::{Contributions, Grid};
use crate::linear::MatrixAssembly;
use crate::model::Model;
use crate::parallel::Halo;
use crate::points::Points;
use crate::schedule::TimeInterval;
use crate::tensor::Vector;

/// Conductance of a drain relative to that of the soil of a cell, k/(gamma_w h).
///
/// A larger value over-constrains the pressure functions at curved surfaces that cut cells. Errors of the flow through
/// a ring with an inner radius of 4, 8 and 16 cells are 0.5, 0.02 and 0.02 % with 1e2; 5.7, 1.0 and 0.4 % with 1e4; and
/// -1.7, -1.2 and -0.5 % with 1e1, where the drain itself resists.
const CONDUCTANCE: f64 = 1e2;
/// Tolerance for coinciding corners of neighbours, in cells.
const ON: f64 = 1e-9;

/// Result of a drain or an inflow in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DrainReport {
    /// Water volume out of a drain, or into the ground by an inflow (m3).
    pub through: f64,
    /// Number of surface points with material nearby.
    pub held: usize,
}

/// Drains and inflows of one step, with the surface points of this rank.
#[derive(Clone, Debug, Default)]
pub struct Drainage {
    offsets: Vec<usize>,
    of: [usize; 2], // numbers of drains and inflows
    outlets: Vec<WaterCrossing>,
    /// Largest distance between initially neighbouring points, per surface, in cells; 0 for inactive surfaces.
    pub torn: Vec<f64>,
}

/// Surface point through which water flows: a sink or a source.
#[derive(Clone, Debug)]
struct WaterCrossing {
    surface: usize, // drains first, then inflows
    attachment: Attachment,
    conductance: f64, // over the duration (m3/Pa)
    given: f64,       // prescribed excess pressure (Pa)
    inflow: f64,      // over the duration (m3)
    one_way: bool,    // outflow only, above the prescribed pressure
}

impl WaterCrossing {
    /// Returns the outflow over the duration for the nodal excess pressures `p` (Pa) (m3).
    fn out(&self, offsets: &[usize], p: &[f64]) -> f64 {
        if !self.is_open(offsets, p) {
            return -self.inflow;
        }
        self.conductance * (self.attachment.value(offsets, p) - self.given) - self.inflow
    }

    /// Returns whether the conductance is active.
    fn is_open(&self, offsets: &[usize], p: &[f64]) -> bool {
        !self.one_way || self.attachment.value(offsets, p) > self.given
    }
}

/// Surface of a body through which water flows in a step.
struct CrossedSurface<'a, const D: usize> {
    number: usize,
    drain: Option<&'a Drain<D>>,
    inflow: Option<&'a Inflow<D>>, // `None` for a drain
    rate: f64,                     // rate of the inflow (m/s)
    duration: f64,                 // s
    end: f64,                      // s
    unit_weight: f64,              // unit weight of water (N/m3)
}

impl<'a, const D: usize> CrossedSurface<'a, D> {
    /// Creates the surface with this number among the drains, followed by the inflows, for a step with these
    /// `differences`.
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

    /// Creates the surface point at a `place`, with its `area` at the start (m2).
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
    /// Creates the drains and inflows of a step with these `differences`; only functions of degree q - 1 for which
    /// `counts` is true are used. `still` returns the hydrostatic pressure at the end of the step (Pa). One reduction,
    /// three before the first step. Fails on all ranks if a surface lies on impermeable material.
    pub fn at<K, const D: usize>(
        model: &Model<K, D>,
        ground: AnchoredPoints<'_, D>,
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
        let AnchoredPoints { points, anchors } = ground;
        let anchors = Anchors::of(&model.surfaces(), anchors, points.anchored(), halo).water;
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

    /// Adds the outflow under the excess pressures `p` (Pa, nodal) to the water balance, as the last number of every
    /// node (m3). Contributions of other ranks are not yet included.
    pub fn add_to(&self, p: &[f64], out: &mut Contributions) {
        for outlet in &self.outlets {
            outlet
                .attachment
                .scatter_value(&self.offsets, outlet.out(&self.offsets, p), out);
        }
    }

    /// Adds the change of the outflow for a change `v` of the pressures `p` (Pa).
    pub fn add_changes(&self, p: &[f64], v: &[f64], out: &mut Contributions) {
        for outlet in self.outlets.iter().filter(|outlet| outlet.is_open(&self.offsets, p)) {
            let change = outlet.conductance * outlet.attachment.value(&self.offsets, v);
            outlet.attachment.scatter_value(&self.offsets, change, out);
        }
    }

    /// Returns whether each one-way surface point of this rank is open under the excess pressures `p` (Pa).
    pub fn open(&self, p: &[f64]) -> Vec<bool> {
        let one_way = self.outlets.iter().filter(|outlet| outlet.one_way);
        one_way.map(|outlet| outlet.is_open(&self.offsets, p)).collect()
    }

    /// Adds the derivative of the outflow to the pressure matrix (m3/Pa). One-way surface points contribute only if
    /// they are open under `p`.
    pub fn assemble(&self, p: &[f64], matrix: &mut dyn MatrixAssembly) {
        let conducting = self.outlets.iter().filter(|outlet| outlet.conductance > 0.0);
        for outlet in conducting.filter(|outlet| outlet.is_open(&self.offsets, p)) {
            let N = outlet.attachment.N();
            let block: Vec<f64> = N
                .iter()
                .flat_map(|row| N.iter().map(move |column| outlet.conductance * row * column))
                .collect();
            matrix.add_block(outlet.attachment.first_node(), &block);
        }
    }

    /// Returns `times` the work of the outflow against the excess pressures `p` (Pa) on this rank (J).
    pub fn work(&self, p: &[f64], times: f64) -> Exact {
        self.outlets
            .iter()
            .map(|outlet| times * outlet.attachment.value(&self.offsets, p) * outlet.out(&self.offsets, p))
            .collect()
    }

    /// Returns the results of all drains, and of all inflows, for the converged excess pressures `p` (Pa). One
    /// reduction.
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

/// Present state at a surface point.
struct SurfacePlace<const D: usize> {
    x: Vector<D>,            // position (m)
    normal: Vector<D>,       // normal times the ratio of present to initial area
    permeability: Vector<D>, // along the axes (m/s)
    drained: bool,           // whether the material is permeable
}

impl<const D: usize> SurfacePlace<D> {
    /// Returns the permeability normal to the surface, divided by the edges of the cell at the point (1/s).
    fn leads(&self, grid: &Grid<D>) -> f64 {
        let edges = edges_at(grid, &self.x);
        let along = (0..D).map(|axis| self.normal[axis].powi(2) * self.permeability[axis] / edges[axis]);
        along.sum::<f64>() / self.normal.norm_squared()
    }
}

/// Returns the largest present distance between initially neighbouring points of a surface, in cells. The surface is
/// closed where ground has been exposed in between.
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

/// Returns whether two surface points are neighbours: corners coincide, or the points are less than an `edge` (m)
/// apart.
fn are_neighbours<const D: usize>(a: &SurfacePoint<D>, b: &SurfacePoint<D>, edge: f64) -> bool {
    let mut pairs = a
        .corners
        .iter()
        .flat_map(|one| b.corners.iter().map(move |other| one - other));
    pairs.any(|apart| apart.norm() <= ON * edge) || (a.x - b.x).norm() < edge
}

/// Returns the edges of the cell at `x` (m); outside the grid the smallest edge of all cells.
fn edges_at<const D: usize>(grid: &Grid<D>, x: &Vector<D>) -> Vector<D> {
    grid.locate(x).map_or_else(
        || Vector::from_element(grid.smallest_edge()),
        |cell| grid.cell_box(&cell).1,
    )
}

/// Returns the present states at all surface points. One reduction.
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
    // Only one rank contributes to each number.
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
    /// Returns the excess pressure at `x` at time `t` (Pa). `still` returns the hydrostatic pressure, and `weight` is
    /// the unit weight of water (N/m3).
    pub(super) fn excess<const D: usize>(
        &self,
        weight: f64,
        x: &Vector<D>,
        t: f64,
        still: impl Fn(&Vector<D>) -> f64,
    ) -> f64 {
        match self {
            // A surface does not impose the suction above the water level, only zero pressure.
            Self::StillWater | Self::Seepage => {
                let still = still(x);
                if still < 0.0 { -still } else { 0.0 }
            }
            Self::Head(head) => weight * (head.at(t) - x[D - 1]) - still(x),
            Self::Pressure(pressure) => pressure.at(t) - still(x),
        }
    }
}
