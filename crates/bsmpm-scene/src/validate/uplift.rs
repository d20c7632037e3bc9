//! Warns of rigid bodies below the water table, because the program does not compute their buoyancy.

use crate::case::{Case, RigidShape, Water};
use crate::report::Report;
use crate::words::Geometry;
use bsmpm::interactions::rigid::Outline;
use bsmpm::tensor::Vector;
use std::f64::consts::TAU;

/// Corners of the polygon that stands for a circle: its area is 0.2 % less.
const CORNERS: usize = 64;

/// Warns of rigid bodies, with the buoyancy that they lack where it is known.
pub(super) fn warn(case: &Case, water: &Water, report: &mut Report<'_>) {
    if case.rigid.is_empty() {
        return;
    }
    let heights = water.table.levels().into_iter().flatten().map(|row| row.1);
    let level = heights.fold(f64::NEG_INFINITY, f64::max);
    let lacking = case.rigid.iter().filter_map(|rigid| {
        let area = match case.geometry {
            Geometry::PlaneStrain => wet_area(&rigid.shape, level),
            Geometry::Axisymmetric | Geometry::Solid => 0.0,
        };
        (area > 0.0).then(|| format!("`{}` {:.4} kN/m", rigid.name, water.unit_weight * area * 1e-3))
    });
    let lacking: Vec<String> = lacking.collect();
    let missing = match lacking.is_empty() {
        true => String::new(),
        false => format!(" (at the start: {})", lacking.join(", ")),
    };
    report.warn(format!(
        "W0429: water: [water] exerts no pressure on rigid bodies, so their buoyancy is missing{missing}. Reduce \
         rigid.mass or rigid.force by the buoyancy, and add the water pressure to recorded forces."
    ));
}

/// m2  area of a shape in the plane below a level, m.
fn wet_area(shape: &RigidShape, level: f64) -> f64 {
    let corners: Vec<[f64; 2]> = match shape {
        RigidShape::Polygon(corners) => corners.clone(),
        RigidShape::Circle { center, radius } => {
            let angles = (0..CORNERS).map(|k| TAU * k as f64 / CORNERS as f64);
            angles
                .map(|angle| [center[0] + radius * angle.cos(), center[1] + radius * angle.sin()])
                .collect()
        }
        RigidShape::InSpace(_) => return 0.0,
    };
    let below = below(&corners, level);
    let polygon = Outline::Polygon(below.into_iter().map(Vector::from).collect());
    polygon.sizes().area.abs()
}

/// Corners of the part of a polygon below a level.
fn below(corners: &[[f64; 2]], level: f64) -> Vec<[f64; 2]> {
    let mut kept = Vec::new();
    for (number, &from) in corners.iter().enumerate() {
        let to = corners[(number + 1) % corners.len()];
        if from[1] <= level {
            kept.push(from);
        }
        if (from[1] <= level) != (to[1] <= level) {
            let share = (level - from[1]) / (to[1] - from[1]);
            kept.push([from[0] + share * (to[0] - from[0]), level]);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_wet_area_is_that_of_the_part_below_the_level() {
        let block = RigidShape::Polygon(vec![[1.0, 0.0], [3.0, 0.0], [3.0, 2.0], [1.0, 2.0]]);
        for (level, area) in [(-1.0, 0.0), (0.5, 1.0), (5.0, 4.0)] {
            assert!((wet_area(&block, level) - area).abs() < 1e-12, "{level}");
        }
        let half = wet_area(
            &RigidShape::Circle {
                center: [0.0, 1.0],
                radius: 2.0,
            },
            1.0,
        );
        assert!((half / TAU - 1.0).abs() < 3e-3, "{half}");
    }
}
