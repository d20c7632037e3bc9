//! Data of hydrostatic water.

use super::{Body, Case};
use crate::grid::GridSpec;
use bsmpm::field::pore_water::ambient::{Ambient, Span};

/// Still water.
#[derive(Clone, Debug, PartialEq)]
pub struct Water {
    /// N/m3  under the case's gravity
    pub unit_weight: f64,
    /// Where it is, heights and places in the case's coordinates.
    pub table: Ambient,
}

impl Water {
    /// The same with heights and places from the lower corner of a grid.
    pub(crate) fn from(&self, grid: &GridSpec) -> Ambient {
        let left = grid.lower()[0];
        let base = grid.lower()[grid.dims() - 1];
        let mut table = self.table.clone();
        if let Ambient::Line(places) = &mut table {
            places.iter_mut().for_each(|place| place.x -= left);
        }
        table.levels_mut().into_iter().flatten().for_each(|row| row.1 -= base);
        table
    }
}

impl Case {
    /// Whether some body's points carry a pore pressure of their own.
    pub fn carries_pressure(&self) -> bool {
        self.bodies.iter().any(|body| self.materials[body.material].ratio > 0.0)
    }

    /// m  height of the water table at time 0 at `x`, in the case's coordinates, if there is water.
    fn table(&self, x: f64) -> Option<f64> {
        Some(self.water.as_ref()?.table.table(x, 0.0)?.0)
    }

    /// kg/m3  of a point of a body's material at `at` (m, in the case's coordinates), of this volume (m^dimension):
    /// saturated as far as it lies below the water table of time 0.
    pub(crate) fn density_at(&self, body: &Body, at: [f64; 3], volume: f64) -> f64 {
        let named = &self.materials[body.material];
        let density = named.density.unwrap_or(0.0);
        let table = self.water.as_ref().and_then(|water| water.table.table(at[0], 0.0));
        let Some((saturated, (table, slope))) = named.saturated.zip(table) else {
            return density;
        };
        // Along every axis the lower side of its cell, and the length of its part of that.
        let mut lower = Vec::new();
        let mut lengths = Vec::new();
        for (axis, at) in self.grid.axes.iter().zip(at) {
            let cell = axis.first_cell(|cell| axis.lower() + axis.breakpoint(cell + 1) > at);
            let cell = cell.min(axis.cells() - 1);
            lower.push(axis.lower() + axis.breakpoint(cell));
            lengths.push(axis.cell(cell) / body.points_per_cell as f64);
        }
        let up = lengths.len() - 1;
        let filled = volume / lengths.iter().product::<f64>();
        let flows = self
            .flow
            .as_ref()
            .is_some_and(|flow| flow.soils[body.material].is_some());
        let span = if flows {
            Span::default()
        } else {
            Span::of(at[up] - lower[up], lengths[up], filled)
        };
        density + span.under(slope).share_below(table - at[up]) * (saturated - density)
    }

    /// Pa  weight of a body vertically above `at` (m, in the case's coordinates) under the acceleration `g` (m/s2),
    /// less the water's uplift.
    pub(super) fn weight_above(&self, body: &Body, at: [f64; 3], g: f64) -> f64 {
        let named = &self.materials[body.material];
        let all = body.region.above(at);
        let up = self.grid.dims() - 1;
        let Some((water, table)) = self.water.as_ref().zip(self.table(at[0])) else {
            return 0.0;
        };
        let mut surface = at;
        surface[up] = table;
        let dry = if table > at[up] {
            body.region.above(surface)
        } else {
            all
        };
        let density = named.density.unwrap_or(0.0);
        let saturated = named.saturated.unwrap_or(density);
        g * density * dry + (g * saturated - water.unit_weight) * (all - dry)
    }
}
