//! Pore water quantities of points for histories and frames.

use crate::error::StepError;
use crate::exact::Exact;
use crate::field::pore_water::Water;
use crate::field::pore_water::crossed::CrossedVolumes;
use crate::field::pore_water::flow::{Flow, Motion, Soil};
use crate::grid::shape::Patch;
use crate::grid::{Contributions, Grid, Shape};
use crate::kinematics::Kinematics;
use crate::model::Model;
use crate::observe::Part;
use crate::parallel::{Halo, agreed};
use crate::points::Points;
use crate::tensor::{Symmetric, Vector};

/// Volume relative to that of the pores below which the largest flow is considered round-off, as in ground at rest.
const NOTHING: f64 = 1e-9;

/// Pore water of a case and its points at one time.
#[derive(Clone, Copy)]
pub struct PoreWater<'a, const D: usize> {
    water: &'a Water<D>,
    points: &'a Points<D>,
    t: f64,
    weight: Vector<D>, // weight of water per volume (Pa/m)
    grown: f64,        // present fraction of gravity
}

impl<'a, const D: usize> PoreWater<'a, D> {
    /// Creates the view at time `t`; `None` without pore water.
    pub fn of<K>(model: &'a Model<K, D>, points: &'a Points<D>, t: f64) -> Option<Self> {
        let water = model.water.as_ref()?;
        let grown = model.gravity.as_ref().map_or(0.0, |gravity| gravity.grown(t));
        Some(Self {
            water,
            points,
            t,
            weight: water.weight(model, t),
            grown,
        })
    }

    fn flow(&self, p: usize) -> Option<(&'a Flow<D>, &'a Soil<D>)> {
        let flow = self.water.flow.as_ref()?;
        Some((flow, flow.soils[usize::from(self.points.material[p])].as_ref()?))
    }

    /// Returns the present volume of point `p` (m3, per metre in plane strain).
    fn volume(&self, p: usize) -> f64 {
        self.points.volume[p] * self.points.F.at(p).determinant()
    }

    /// Returns the volume ratio J-bar of point `p`.
    fn mean_J(&self, p: usize) -> f64 {
        self.points.F.at(p).determinant() * self.points.dilation_of(p)
    }

    /// Returns the hydrostatic pressure at point `p` (Pa).
    fn still(&self, p: usize) -> f64 {
        self.grown * self.water.still_pressure(&self.points.x[p], self.t)
    }

    /// Returns the excess pressure at point `p`; before the first step its initial value (Pa).
    pub fn excess(&self, p: usize) -> f64 {
        match &self.points.pore_pressure {
            Some(pressure) => pressure[p],
            None => self.water.excess_at_start(&self.points.x[p]),
        }
    }

    /// Returns the pore pressure at point `p`, positive in compression (Pa).
    pub fn pressure(&self, p: usize) -> f64 {
        let carried = self
            .points
            .carried_pressure
            .as_ref()
            .map_or(0.0, |carried| self.grown * carried[p]);
        self.still(p) + self.excess(p) + carried
    }

    /// Returns the volume-weighted mean, the smallest and the largest pore pressure of a part (Pa); 0 without points.
    /// Two reductions.
    pub fn range(&self, part: &Part, halo: &dyn Halo) -> [f64; 3] {
        let weighted = part.of(self.points).map(|p| self.volume(p) * self.pressure(p));
        let volumes = part.of(self.points).map(|p| self.volume(p));
        let sums = halo.reproducible_sum(&[weighted.collect(), volumes.collect()]);
        let mut ends = [f64::NEG_INFINITY; 2];
        for pressure in part.of(self.points).map(|p| self.pressure(p)) {
            ends = [ends[0].max(-pressure), ends[1].max(pressure)];
        }
        halo.all_reduce_max(&mut ends);
        if sums[1] > 0.0 {
            [sums[0] / sums[1], -ends[0], ends[1]]
        } else {
            [0.0; 3]
        }
    }

    /// Returns the contribution chi p of the pore pressure to the total stress (Pa).
    fn borne(&self, p: usize) -> f64 {
        let pressure = self.pressure(p);
        self.flow(p).map_or(1.0, |(_, soil)| {
            soil.retained(pressure, self.water.unit_weight).effective
        }) * pressure
    }

    /// Returns the saturation at point `p` (-); 1 without retention.
    pub fn saturation(&self, p: usize) -> f64 {
        self.flow(p).map_or(1.0, |(_, soil)| {
            soil.retained(self.pressure(p), self.water.unit_weight).saturation
        })
    }

    /// Returns the total Cauchy stress at point `p` (Pa).
    pub fn total_stress(&self, p: usize) -> Symmetric {
        let mut stress = self.points.sigma.at(p);
        stress.0[..3].iter_mut().for_each(|normal| *normal -= self.borne(p));
        stress
    }

    /// Returns the porosity at point `p` (-); 0 without pore-water flow.
    pub fn porosity(&self, p: usize) -> f64 {
        let J = self.mean_J(p);
        self.flow(p).map_or(0.0, |(_, soil)| soil.pores(J) / J)
    }

    /// Returns the Darcy flux relative to the grains at every point (m/s); zero without permeability, and before the
    /// first step.
    ///
    /// The balance determines the total flow through the points of a cell. If the points of a deformed cell overfill or
    /// underfill it, the pressure gradient is smaller or larger accordingly. In cells surrounded by ground the flux is
    /// therefore scaled to the volume of the cell, so that it does not jump with the number of points. The points must
    /// be sorted by cell. One exchange with the neighbours.
    pub fn fluxes<K: Kinematics<D>>(&self, grid: &Grid<D>, halo: &dyn Halo) -> Result<Vec<Vector<D>>, StepError> {
        let shape = agreed(halo, Shape::at(grid, self.points), StepError::OtherRank)?;
        let is_inside = inside(grid, &shape, halo);
        let mut fluxes: Vec<Vector<D>> = (0..self.points.len()).map(|p| self.flux(p)).collect();
        for patch in shape.patches().iter().filter(|patch| is_inside(patch)) {
            let volume: f64 = patch.points.clone().map(|p| self.volume(p)).sum();
            let filled = volume / grid.cell_volume::<K>(&grid.cell_at(patch.cell));
            fluxes[patch.points.clone()].iter_mut().for_each(|flux| *flux *= filled);
        }
        Ok(fluxes)
    }

    /// Returns the Darcy flux from the pressure gradient at point `p` (m/s).
    fn flux(&self, p: usize) -> Vector<D> {
        let J = self.mean_J(p);
        let conductivity = self
            .water
            .flow
            .as_ref()
            .and_then(|flow| flow.permeability(self.points.material[p], J));
        let Some((conductivity, gradient)) = conductivity.zip(self.points.pressure_gradient.as_ref()) else {
            return Vector::zeros();
        };
        let relative = self.flow(p).map_or(1.0, |(_, soil)| {
            soil.retained(self.pressure(p), self.water.unit_weight).permeability
        });
        -conductivity.component_mul(&(gradient[p] - self.weight)) * relative / self.water.unit_weight
    }

    /// Returns the relative error of the global water balance since the start: water gained by the points plus water
    /// that has `crossed` the surface or was removed, divided by the largest of outflow, inflow, removed water and the
    /// sum of the points' changes, at least 1e-9 of the pore volume. `None` without coupled flow or with constant
    /// pressures. One reduction.
    pub fn balance(&self, crossed: &CrossedVolumes, halo: &dyn Halo) -> Option<f64> {
        self.water.flow.as_ref().filter(|flow| flow.motion != Motion::Held)?;
        let pores: Exact = (0..self.points.len())
            .map(|p| {
                self.flow(p)
                    .map_or(0.0, |(_, soil)| self.points.volume[p] * soil.porosity)
            })
            .collect();
        let sums = halo.reproducible_sum(&[self.taken().collect(), self.taken().map(f64::abs).collect(), pores]);
        let out = crossed.out() + crossed.removed;
        let scale = sums[1]
            .max(crossed.through())
            .max(crossed.removed.abs())
            .max(NOTHING * sums[2]);
        Some(if scale > 0.0 { (sums[0] + out) / scale } else { 0.0 })
    }

    /// Returns the water volume that the points with the ids selected by `wanted` have taken in since the start (m3,
    /// per metre in plane strain); 0 without coupled flow. One reduction.
    pub fn taken_by(&self, wanted: impl Fn(u64) -> bool, halo: &dyn Halo) -> f64 {
        if self.water.flow.is_none() {
            return 0.0;
        }
        let own: Exact = self
            .points
            .id
            .iter()
            .zip(self.taken())
            .filter(|(id, _)| wanted(**id))
            .map(|of| of.1)
            .collect();
        halo.reproducible_sum(&[own])[0]
    }

    /// Returns the water volume that every point has taken in since the start, at its initial density (m3, per metre in
    /// plane strain).
    fn taken(&self) -> impl Iterator<Item = f64> {
        (0..self.points.len()).map(move |p| self.taken_at(p))
    }

    /// Returns the water volume that point `p` has taken in since the start, at its initial density (m3, per metre in
    /// plane strain).
    fn taken_at(&self, p: usize) -> f64 {
        let Some((flow, soil)) = self.flow(p) else { return 0.0 };
        let J = self.points.F.at(p).determinant();
        if !flow.retains() {
            return self.points.volume[p] * (soil.content(flow.bulk, J, self.excess(p)) - soil.porosity);
        }
        let weight = self.water.unit_weight;
        let x = self.points.x[p] - self.points.u[p];
        let start = self.water.still_pressure(&x, 0.0) + self.water.excess_at_start(&x);
        let before = soil.content(flow.bulk, 1.0, start) * soil.retained(start, weight).saturation;
        let pressure = self.pressure(p);
        let now = soil.content(flow.bulk, J, pressure) * soil.retained(pressure, weight).saturation;
        self.points.volume[p] * (now - before)
    }
}

/// Returns a predicate for cells that are surrounded by cells with ground, in the support of the functions at their
/// middle. One exchange with the neighbours.
fn inside<const D: usize>(grid: &Grid<D>, shape: &Shape<D>, halo: &dyn Halo) -> impl Fn(&&Patch) -> bool {
    let mut counts = Contributions::none(grid, 1, Vec::new());
    for patch in shape.patches() {
        let counts = counts.patch(patch.first_node);
        shape.offsets().iter().for_each(|&offset| counts[offset] += 1.0);
    }
    let counts = halo.assemble_ghosts(&counts);
    let is_full: Vec<bool> = counts
        .iter()
        .enumerate()
        .map(|(node, count)| *count >= cells_in_support(grid, node))
        .collect();
    let width = shape.width();
    let order = grid.order();
    let central = order / 2..=order.div_ceil(2);
    let middle: Vec<usize> = (0..shape.offsets().len())
        .filter(|k| (0..D).all(|axis| central.contains(&(k / width.pow(axis as u32) % width))))
        .map(|k| shape.offsets()[k])
        .collect();
    move |patch| middle.iter().all(|offset| is_full[patch.first_node + offset])
}

/// Returns the number of cells of nonzero length in the support of a node's function.
fn cells_in_support<const D: usize>(grid: &Grid<D>, node: usize) -> f64 {
    let number = grid.node_at(node);
    let counts = grid.axes().iter().zip(number).map(|(knots, number)| {
        let cells = number.saturating_sub(grid.order())..=number;
        cells
            .filter(|&cell| cell < knots.cells() && knots.has_length(cell))
            .count() as f64
    });
    counts.product()
}
