//! Validates shapes of bodies and cut-outs.

mod solid;

pub(super) use solid::{cuboid, raster};

use super::place;
use crate::case::{Face, RigidShape, Support};
use crate::error::Origin;
use crate::grid::GridSpec;
use crate::record::{Field, ListRow};
use crate::report::Report;
use crate::schema::{BodyTable, ShapeKey};
use crate::shape_error;
use crate::words::Geometry;
use bsmpm::interactions::rigid;
use bsmpm_shapes::polygon::{self, PolygonFault};
use bsmpm_shapes::{Edge, MOST_EDGES, Outline, Region, left_of_box};

/// A shape as it is written, m in the case's coordinates.
#[derive(Clone, Debug)]
enum BodyShape {
    Box { lower: [f64; 2], upper: [f64; 2] },
    Polygon(Vec<[f64; 2]>),
    Circle { center: [f64; 2], radius: f64 },
}

impl BodyShape {
    fn bounds(&self) -> [[f64; 2]; 2] {
        match self {
            Self::Box { lower, upper } => [*lower, *upper],
            Self::Polygon(corners) => polygon::bounds(corners),
            Self::Circle { center, radius } => [-radius, *radius].map(|reach| center.map(|x| x + reach)),
        }
    }

    fn area(&self) -> f64 {
        match self {
            Self::Box { lower, upper } => (upper[0] - lower[0]) * (upper[1] - lower[1]),
            Self::Polygon(corners) => polygon::area(corners),
            Self::Circle { radius, .. } => std::f64::consts::PI * radius * radius,
        }
    }

    fn edges(&self, origin: [f64; 2], number: usize) -> Vec<Edge> {
        match self {
            Self::Box { lower, upper } => polygon::rectangle(*lower, *upper, origin, number),
            Self::Polygon(corners) => polygon::edges(corners, origin, number),
            Self::Circle { center, radius } => {
                Edge::circle([0, 1].map(|axis| center[axis] - origin[axis]), *radius, number).to_vec()
            }
        }
    }
}

/// What of a body is beyond planes of symmetry: faces with rollers in the middle of its bounds. It is cut off. A body
/// that reaches over a face by another distance is not symmetric about it, and refused.
struct BeyondSymmetry<const D: usize> {
    /// m  lower and upper corners of what is cut off
    boxes: Vec<[[f64; D]; 2]>,
    faces: Vec<Face>,
}

impl<const D: usize> BeyondSymmetry<D> {
    /// Of a shape with these bounds, and the bounds of what is left of it where the case itself cuts something off, m.
    fn of([lower, upper]: [[f64; D]; 2], left: [[f64; D]; 2], boundary: [[Support; 2]; 3], grid: &GridSpec) -> Self {
        let mut beyond = Self {
            boxes: Vec::new(),
            faces: Vec::new(),
        };
        let [grid_lower, grid_upper] = [grid.lower(), grid.upper()];
        for axis in 0..D {
            let slack = place::ROUNDING * grid.axes[axis].shortest();
            for (is_upper, limit) in [(false, grid_lower[axis]), (true, grid_upper[axis])] {
                let is_roller = boundary[axis][usize::from(is_upper)] == Support::Roller;
                let is_middle = (0.5 * (lower[axis] + upper[axis]) - limit).abs() <= slack;
                let reaches = if is_upper {
                    left[1][axis] > limit + slack
                } else {
                    left[0][axis] < limit - slack
                };
                if !(is_roller && is_middle && reaches) {
                    continue;
                }
                // Farther than the body, so that no edge of the box lies on one of the body but at the face.
                let size: [f64; D] = std::array::from_fn(|axis| upper[axis] - lower[axis]);
                let mut corners = [-1.0, 1.0].map(|sign| {
                    let bound = if sign < 0.0 { lower } else { upper };
                    std::array::from_fn(|axis| bound[axis] + sign * size[axis])
                });
                corners[usize::from(!is_upper)][axis] = limit;
                beyond.boxes.push(corners);
                beyond.faces.push(Face { axis, upper: is_upper });
            }
        }
        beyond
    }

    /// Notes the faces at which the body is cut.
    fn note(&self, body: &BodyTable, geometry: Geometry, report: &mut Report<'_>) {
        let sides: Vec<String> = self.faces.iter().map(|face| face.side(geometry).to_string()).collect();
        let value = format!("cut at {}", sides.join(", "));
        report.note(
            body.shape().place().path(),
            value,
            "the roller there is a plane of symmetry of the body, and the half beyond it is left out",
        );
    }
}

impl BeyondSymmetry<2> {
    /// Makes a box smaller; of another shape the boxes become further cut-outs.
    fn cut_off(&self, whole: &mut BodyShape, cut: &mut Vec<BodyShape>) {
        match whole {
            BodyShape::Box { lower, upper } => [*lower, *upper] = left_of_box([*lower, *upper], &self.boxes),
            _ => cut.extend(self.boxes.iter().map(|&[lower, upper]| BodyShape::Box { lower, upper })),
        }
    }
}

/// What a body fills, with `points_per_cell` along an axis; place and size are checked only if the grid is valid.
pub(super) fn region(
    body: &BodyTable,
    geometry: Geometry,
    grid: Option<&GridSpec>,
    points_per_cell: Option<usize>,
    boundary: Option<[[Support; 2]; 3]>,
    report: &mut Report<'_>,
) -> Option<Region> {
    if geometry == Geometry::Solid {
        return solid::region(body, grid, points_per_cell, boundary, report);
    }
    let whole = read(body.shape(), report);
    let cuts = body.subtract.items().iter();
    let cut: Option<Vec<BodyShape>> = cuts.map(|cut| read(cut.shape(), report)).collect();
    let mut whole = whole?;
    let mut cut = cut?;
    let grid = grid?;
    let left = left_of_box(whole.bounds(), &boxes_of(&cut));
    let beyond = BeyondSymmetry::of(whole.bounds(), left, boundary?, grid);
    if !beyond.boxes.is_empty() {
        beyond.cut_off(&mut whole, &mut cut);
        beyond.note(body, geometry, report);
    }
    let bounds = left_of_box(whole.bounds(), &boxes_of(&cut));
    inside(&whole, bounds, body.shape(), grid, report)?;
    if let (BodyShape::Box { lower, upper }, true) = (&whole, cut.is_empty()) {
        return Some(Region::Box {
            lower: *lower,
            upper: *upper,
        });
    }
    let shapes = std::iter::once(&whole).chain(&cut).enumerate();
    let edges = shapes
        .flat_map(|(number, shape)| shape.edges(grid.corner(), number))
        .collect();
    match Outline::new(
        edges,
        1 + cut.len(),
        bounds,
        whole.area(),
        &grid.axes,
        geometry.lattice(points_per_cell?),
    ) {
        Ok(outline) => Some(Region::Outline(outline)),
        Err(error) => {
            body.shape().place().error(shape_error::of_shape(&error), report);
            None
        }
    }
}

/// Lower and upper corners of the boxes among shapes.
fn boxes_of(shapes: &[BodyShape]) -> Vec<[[f64; 2]; 2]> {
    let boxes = shapes.iter().filter_map(|shape| match shape {
        BodyShape::Box { lower, upper } => Some([*lower, *upper]),
        BodyShape::Polygon(_) | BodyShape::Circle { .. } => None,
    });
    boxes.collect()
}

/// The shape of a rigid body, which may reach beyond the grid.
pub(super) fn rigid(key: ShapeKey<'_>, report: &mut Report<'_>) -> Option<RigidShape> {
    Some(match read(key, report)? {
        BodyShape::Circle { center, radius } => RigidShape::Circle { center, radius },
        BodyShape::Polygon(mut corners) => {
            let outline = rigid::Outline::Polygon(corners.iter().map(|&corner| corner.into()).collect());
            if outline.sizes().area < 0.0 {
                corners.reverse();
            }
            RigidShape::Polygon(corners)
        }
        BodyShape::Box { .. } => {
            key.place().error(
                "E0207: a rigid box is available in 3-D only. Use `polygon`, or geometry = \"3d\".",
                report,
            );
            return None;
        }
    })
}

fn read(key: ShapeKey<'_>, report: &mut Report<'_>) -> Option<BodyShape> {
    match key {
        ShapeKey::Polygon(key) => polygon(key, report),
        ShapeKey::Circle(key) => {
            let (center, radius) = key.value()?.circle()?;
            Some(BodyShape::Circle { center, radius })
        }
        ShapeKey::Box(key) => {
            let [lower, upper] = key.value()?.corners()?.map(|[x, y, _]| [x, y]);
            if lower[0] >= upper[0] || lower[1] >= upper[1] {
                key.value()?.upper.error(empty_box(&lower, &upper), report);
                return None;
            }
            Some(BodyShape::Box { lower, upper })
        }
        _ => None,
    }
}

/// Of a box without extent along some axis.
fn empty_box(lower: &[f64], upper: &[f64]) -> String {
    format!(
        "E0203: the upper corner {upper:?} m is not above the lower corner {lower:?} m along each axis, so the box is \
         empty. Exchange or correct the corners."
    )
}

fn polygon(key: &Field<Vec<ListRow>>, report: &mut Report<'_>) -> Option<BodyShape> {
    let rows = key.value()?;
    let mut corners = key.pairs()?;
    // Some close a polygon by its first corner once more.
    if corners.len() > 3 && corners.first() == corners.last() {
        corners.pop();
    }
    if corners.len() > MOST_EDGES {
        let message = format!(
            "E0216: the polygon has {} corners (at most {}). Use fewer corners.",
            corners.len(),
            MOST_EDGES
        );
        key.error(message, report);
        return None;
    }
    let Some(fault) = polygon::fault(&corners) else {
        return Some(BodyShape::Polygon(corners));
    };
    let (origin, message): (Origin, String) = match fault {
        PolygonFault::TooFew => {
            let message = format!(
                "E0222: the polygon has {} corners, but needs at least 3. Add corners.",
                corners.len()
            );
            (key.origin(), message)
        }
        PolygonFault::Repeated(one, other) => {
            let message = format!(
                "E0223: the polygon has the corner {:?} twice in a row. Delete one of them.",
                corners[one]
            );
            (rows[one.max(other)].origin, message)
        }
        PolygonFault::Flat => {
            let message =
                "E0222: all corners of the polygon lie on one line, so its area is zero. Correct the corners.";
            (key.origin(), message.to_owned())
        }
        PolygonFault::Crossing(i, j) => {
            let edges = [j, i].map(|k| format!("{:?} to {:?}", corners[k], corners[(k + 1) % corners.len()]));
            let message = format!(
                "E0223: the edge from {} crosses or touches the edge from {}. Correct the corners or their order.",
                edges[0], edges[1]
            );
            (rows[j].origin, message)
        }
    };
    report.error(origin, key.path(), message);
    None
}

/// Errors about what lies outside the grid: of a shape with what is left of its bounds.
fn inside(
    shape: &BodyShape,
    [lower, upper]: [[f64; 2]; 2],
    key: ShapeKey<'_>,
    grid: &GridSpec,
    report: &mut Report<'_>,
) -> Option<()> {
    if place::beyond(grid, lower).is_none() && place::beyond(grid, upper).is_none() {
        return Some(());
    }
    match (shape, key) {
        (BodyShape::Polygon(corners), ShapeKey::Polygon(key)) => {
            let mut corners = corners.iter().zip(key.items());
            let outside = corners.find_map(|(corner, row)| Some((row.origin, place::beyond(grid, *corner)?)));
            if let Some((origin, message)) = outside {
                report.error(origin, key.path(), message);
            }
        }
        (BodyShape::Box { lower, upper }, ShapeKey::Box(key)) => {
            let corners = key.value()?;
            for (key, corner) in [(&corners.lower, *lower), (&corners.upper, *upper)] {
                if let Some(message) = place::beyond(grid, corner) {
                    key.error(message, report);
                }
            }
        }
        _ => {
            if let Some(message) = place::beyond(grid, lower).or(place::beyond(grid, upper)) {
                key.place().error(message, report);
            }
        }
    }
    None
}
