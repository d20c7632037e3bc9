//! Measures the pressure, force and penetration of the footing of a case.

use super::{normal, unit};
use crate::grid::vector;
use crate::{Case, Geometry, Site};
use bsmpm::interactions::strip::{Path, StripReport};
use bsmpm::kinematics::{Axisymmetric, Kinematics};
use bsmpm::tensor::Vector;

/// What the footing's histories need.
#[derive(Clone, Debug)]
pub struct FootingMonitor {
    path: Path<3>,
    area: f64,           // m per metre of thickness, or m2 per radian, or m2
    pressing: Vector<3>, // unit normal of the base, towards the material
    moving: Vector<3>,   // unit direction of the whole motion
    height: usize,       // the vertical axis
}

impl FootingMonitor {
    /// The gauge of the case's footing, if there is one.
    pub fn of(case: &Case) -> Option<Self> {
        let footing = case.footing.as_ref()?;
        let rows = footing
            .path
            .rows
            .iter()
            .map(|(time, moved)| (*time, Vector::from(*moved)))
            .collect();
        let height = case.grid.dims() - 1;
        let path = Path { rows };
        let down = -unit::<3>(height);
        let whole = path.at(case.analysis.end);
        let moving = whole.try_normalize(0.0).unwrap_or(down);
        let (normal, area) = match footing.site {
            Site::Segment { from, to } => {
                let [from, to]: [Vector<3>; 2] = [from, to].map(|at| vector(case.grid.local(at)));
                let weight = match case.geometry {
                    Geometry::PlaneStrain | Geometry::Solid => 1.0,
                    Geometry::Axisymmetric => Axisymmetric::weight(&((from + to) * 0.5).fixed_rows::<2>(0).into()),
                };
                (normal(&from, &to), (to - from).norm() * weight)
            }
            Site::Plate(plate) => (unit(plate.normal()), plate.area([case.grid.lower(), case.grid.upper()])),
            Site::Face(_) => return None,
        };
        // A base that only slides along itself presses downwards.
        let side = if normal.dot(&moving).abs() > 1e-9 {
            normal.dot(&moving)
        } else {
            normal.dot(&down)
        };
        Some(Self {
            area,
            pressing: normal * side.signum(),
            moving,
            path,
            height,
        })
    }

    /// Mean normal pressure on the base, Pa, compression positive.
    pub fn pressure(&self, report: &StripReport) -> f64 {
        padded(&report.force).dot(&self.pressing) / self.area
    }

    /// Force of the soil against the motion, N per metre of thickness or per radian; of a solid N.
    pub fn force(&self, report: &StripReport) -> f64 {
        padded(&report.force).dot(&self.moving)
    }

    /// Downward motion until time `t`, m.
    pub fn penetration(&self, t: f64) -> f64 {
        -self.path.at(t)[self.height]
    }
}

/// A vector of a plane or of a solid.
fn padded(of: &[f64]) -> Vector<3> {
    Vector::from_fn(|axis, _| of.get(axis).copied().unwrap_or(0.0))
}
