//! Water in the ground.

use super::{Body, Case};
use bsmpm::water::ambient::Ambient;

/// Still water.
#[derive(Clone, Debug, PartialEq)]
pub struct Water {
    /// N/m3  under the case's gravity
    pub unit_weight: f64,
    /// Where it is, heights and places in the case's coordinates.
    pub table: Ambient,
}

impl Water {
    /// The same with heights and places from `lower`, m.
    pub(crate) fn from(&self, lower: [f64; 2]) -> Ambient {
        let lowered = |rows: &[(f64, f64)], by: f64| rows.iter().map(|row| (row.0 - by, row.1 - lower[1])).collect();
        match &self.table {
            Ambient::None => Ambient::None,
            Ambient::Level(rows) => Ambient::Level(lowered(rows, 0.0)),
            Ambient::Line(rows) => Ambient::Line(lowered(rows, lower[0])),
        }
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

    /// kg/m3  of a body's material at `at` (m, in the case's coordinates): saturated below the water table of time 0.
    pub(crate) fn density_at(&self, body: &Body, at: [f64; 2]) -> f64 {
        let named = &self.materials[body.material];
        let wet = named.saturated.filter(|_| self.table(at[0]).is_some_and(|table| at[1] < table));
        wet.or(named.density).unwrap_or(0.0)
    }

    /// Pa  weight of a body vertically above `at` (m, in the case's coordinates) under the acceleration `g` (m/s2),
    /// less the water's uplift.
    pub(super) fn weight_above(&self, body: &Body, at: [f64; 2], g: f64) -> f64 {
        let (named, all) = (&self.materials[body.material], body.region.above([at[0], at[1], 0.0]));
        let Some((water, table)) = self.water.as_ref().zip(self.table(at[0])) else { return 0.0 };
        let dry = if table > at[1] { body.region.above([at[0], table, 0.0]) } else { all };
        let density = named.density.unwrap_or(0.0);
        let saturated = named.saturated.unwrap_or(density);
        g * density * dry + (g * saturated - water.unit_weight) * (all - dry)
    }
}
