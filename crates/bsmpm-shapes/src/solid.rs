//! Shapes of 3-D bodies. Each shape returns the intervals of a vertical line that are inside it.

use crate::edge::Edge;
use crate::polygon::{self, area, bounds};
use crate::raster::Raster;
use crate::surface::Surface;
use crate::sweep::intervals;
use std::f64::consts::PI;

/// Shape 0 of the outlines here, which have no other.
const OUTLINE: usize = 1;

/// A shape in 3-D; axis 2 is the vertical. Lengths and coordinates are in m.
#[derive(Clone, Debug, PartialEq)]
pub enum SolidShape {
    /// A cuboid along the axes.
    Box {
        /// Lower and upper corner.
        corners: [[f64; 3]; 2],
    },
    /// An outline, extruded along an axis.
    Prism {
        /// The outline in the plane of the other two axes, in their order.
        outline: Section,
        /// The axis.
        along: usize,
        /// Lower and upper end along the axis.
        ends: [f64; 2],
    },
    /// A sphere.
    Sphere {
        /// Its centre.
        center: [f64; 3],
        /// Its radius.
        radius: f64,
    },
    /// A body of revolution about a vertical.
    Revolved {
        /// The outline in the plane of radius and height; no radius is negative.
        outline: Section,
        /// Position of the vertical.
        about: [f64; 2],
    },
    /// A body between a top and a base.
    Terrain(Box<Raster>),
    /// A body inside a surface of triangles.
    Surface(Box<Surface>),
}

/// An outline in a plane: a polygon or a circle.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// Its edges, as those of shape 0.
    pub edges: Vec<Edge>,
    /// Lower and upper corner of the rectangle around it (m).
    pub bounds: [[f64; 2]; 2],
    /// Its area (m²).
    pub area: f64,
    /// m³  of a turn about the line at 0 of its first axis
    turned: f64,
}

impl Section {
    /// Returns the outline of a polygon.
    pub fn polygon(corners: &[[f64; 2]]) -> Self {
        // Pappus: 2 pi times the first moment, a sum of trapezoids beside the axis.
        let beside = (0..corners.len()).map(|k| {
            let [r, z] = corners[k];
            let [s, w] = corners[(k + 1) % corners.len()];
            (w - z) * (r * r + r * s + s * s)
        });
        let turned = PI / 3.0 * beside.sum::<f64>().abs();
        Self {
            edges: polygon::edges(corners, [0.0; 2], 0),
            bounds: bounds(corners),
            area: area(corners),
            turned,
        }
    }

    /// Returns the outline of a circle.
    pub fn circle(center: [f64; 2], radius: f64) -> Self {
        let area = PI * radius * radius;
        Self {
            edges: Edge::circle(center, radius, 0).to_vec(),
            bounds: [-radius, radius].map(|reach| center.map(|x| x + reach)),
            area,
            turned: 2.0 * PI * center[0].abs() * area,
        }
    }

    fn moved(self, by: [f64; 2]) -> Self {
        let edges = self.edges.into_iter().map(|edge| edge.moved(by)).collect();
        Self {
            edges,
            bounds: self.bounds.map(|at| [at[0] + by[0], at[1] + by[1]]),
            ..self
        }
    }

    /// What it covers of the line at `x`, upwards.
    pub(super) fn at(&self, x: f64) -> Vec<[f64; 2]> {
        intervals(&self.edges, OUTLINE, x)
    }
}

impl SolidShape {
    /// Returns the shape, translated by a vector (m).
    pub fn moved(self, by: [f64; 3]) -> Self {
        let moved = |at: [f64; 3]| [0, 1, 2].map(|axis| at[axis] + by[axis]);
        match self {
            Self::Box { corners } => Self::Box {
                corners: corners.map(moved),
            },
            Self::Prism { outline, along, ends } => {
                let [across, up] = plane(along);
                let outline = outline.moved([by[across], by[up]]);
                Self::Prism {
                    outline,
                    along,
                    ends: ends.map(|end| end + by[along]),
                }
            }
            Self::Sphere { center, radius } => Self::Sphere {
                center: moved(center),
                radius,
            },
            Self::Revolved { outline, about } => Self::Revolved {
                outline: outline.moved([0.0, by[2]]),
                about: [about[0] + by[0], about[1] + by[1]],
            },
            Self::Terrain(raster) => Self::Terrain(Box::new(raster.moved(by))),
            Self::Surface(surface) => Self::Surface(Box::new(surface.moved(by))),
        }
    }

    /// Returns the lower and upper corner of the smallest cuboid around the shape (m).
    pub fn bounds(&self) -> [[f64; 3]; 2] {
        match self {
            Self::Box { corners } => *corners,
            Self::Prism { outline, along, ends } => [0, 1].map(|side| {
                let [across, up] = plane(*along);
                let mut corner = [0.0; 3];
                (corner[across], corner[up]) = (outline.bounds[side][0], outline.bounds[side][1]);
                corner[*along] = ends[side];
                corner
            }),
            Self::Sphere { center, radius } => [-radius, *radius].map(|reach| center.map(|x| x + reach)),
            Self::Revolved { outline, about } => {
                let far = outline.bounds[1][0];
                [(0, -far), (1, far)].map(|(side, reach)| [about[0] + reach, about[1] + reach, outline.bounds[side][1]])
            }
            Self::Terrain(raster) => raster.bounds(),
            Self::Surface(surface) => surface.bounds(),
        }
    }

    /// Returns the volume (m³).
    pub fn volume(&self) -> f64 {
        match self {
            Self::Box {
                corners: [lower, upper],
            } => (0..3).map(|axis| upper[axis] - lower[axis]).product(),
            Self::Prism { outline, ends, .. } => outline.area * (ends[1] - ends[0]),
            Self::Sphere { radius, .. } => 4.0 / 3.0 * PI * radius.powi(3),
            Self::Revolved { outline, .. } => outline.turned,
            Self::Terrain(raster) => raster.volume(),
            Self::Surface(surface) => surface.volume(),
        }
    }

    /// Returns the intervals of the vertical line at a position that are inside the shape, upwards. Lower sides belong
    /// to the shape and upper sides do not.
    pub fn vertical(&self, [x, y]: [f64; 2]) -> Vec<[f64; 2]> {
        let within = |[lower, upper]: [f64; 2], at: f64| lower <= at && at < upper;
        match self {
            Self::Box {
                corners: [lower, upper],
            } => {
                let there = within([lower[0], upper[0]], x) && within([lower[1], upper[1]], y);
                if there { vec![[lower[2], upper[2]]] } else { Vec::new() }
            }
            Self::Prism {
                outline,
                along: 0,
                ends,
            } if within(*ends, x) => outline.at(y),
            Self::Prism {
                outline,
                along: 1,
                ends,
            } if within(*ends, y) => outline.at(x),
            Self::Prism {
                outline,
                along: 2,
                ends,
            } if outline.at(x).iter().any(|line| within(*line, y)) => vec![*ends],
            Self::Prism { .. } => Vec::new(),
            Self::Sphere { center, radius } => {
                let away = (x - center[0]).hypot(y - center[1]);
                let half = ((radius - away) * (radius + away)).max(0.0).sqrt();
                if half > 0.0 {
                    vec![[center[2] - half, center[2] + half]]
                } else {
                    Vec::new()
                }
            }
            Self::Revolved { outline, about } => outline.at((x - about[0]).hypot(y - about[1])),
            Self::Terrain(raster) => raster.vertical([x, y]).into_iter().collect(),
            Self::Surface(surface) => surface.vertical([x, y]),
        }
    }

    /// The outline and the ends of the same shape along an axis, if it is a prism or cuboid there.
    pub(crate) fn along(&self, axis: usize) -> Option<(Section, [f64; 2])> {
        match self {
            Self::Box {
                corners: [lower, upper],
            } => {
                let [across, up] = plane(axis);
                let [a, b] = [lower[across], lower[up]];
                let [c, d] = [upper[across], upper[up]];
                Some((
                    Section::polygon(&[[a, b], [c, b], [c, d], [a, d]]),
                    [lower[axis], upper[axis]],
                ))
            }
            Self::Prism { outline, along, ends } if *along == axis => Some((outline.clone(), *ends)),
            _ => None,
        }
    }
}

/// Returns the two axes other than `along`, in their order.
pub const fn plane(along: usize) -> [usize; 2] {
    [[1, 2], [0, 2], [0, 1]][along]
}

/// What is left of intervals, which ascend, where others are cut out.
pub(crate) fn less(of: Vec<[f64; 2]>, cut: &[[f64; 2]]) -> Vec<[f64; 2]> {
    cut.iter().fold(of, |left, [from, to]| {
        let pieces = left
            .into_iter()
            .flat_map(|[lower, upper]| [[lower, upper.min(*from)], [lower.max(*to), upper]]);
        pieces.filter(|[lower, upper]| lower < upper).collect()
    })
}
