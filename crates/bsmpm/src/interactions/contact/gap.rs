//! Computes the gap between the material and a face of the grid, theory-manual equation (T7.4).

use crate::boundary::Boundary;
use crate::grid::{Grid, digit};
use crate::parallel::Halo;
use crate::points::MappedPoints;

/// Length, in cell edges, below which a gap or a penetration is round-off.
pub(super) const ROUNDING: f64 = 1e-9;

/// Returns the edge of the cells at a face, normal to it (m).
pub(in crate::interactions) fn face_cell<const D: usize>(grid: &Grid<D>, axis: usize, upper: bool) -> f64 {
    let knots = &grid.axes()[axis];
    let cell = if upper { knots.cells() - 1 } else { 0 };
    knots.breakpoint(cell + 1) - knots.breakpoint(cell)
}

/// Returns, per local node, the distance of the nearest material from a face (m); infinite for nodes that are not on
/// the face or have no material in range. A material point extends to the boundary of its initial box, deformed by its
/// F. One ghost exchange.
pub(super) fn gaps<const D: usize>(
    boundary: &Boundary<D>,
    grid: &Grid<D>,
    mapped: MappedPoints<'_, D>,
    axis: usize,
    upper: bool,
    halo: &dyn Halo,
) -> Vec<f64> {
    let MappedPoints { shape, points } = mapped;
    let width = grid.order() + 1;
    let of_face = if upper { width - 1 } else { 0 };
    let offsets = shape.offsets().iter().enumerate();
    let on_face = offsets.filter(|(k, _)| digit::<D>(*k, axis, width) == of_face);
    let offsets: Vec<usize> = on_face.map(|(_, offset)| *offset).collect();
    let knots = &grid.axes()[axis];
    let last = if upper { knots.cells() - 1 } else { 0 };
    let mut near = vec![f64::NEG_INFINITY; grid.nodes()];
    for patch in shape.patches() {
        let cell = grid.cell_at(patch.cell);
        if cell[axis] != last {
            continue;
        }
        let mut least = f64::INFINITY;
        for p in patch.points.clone() {
            let x = points.x[p][axis];
            let from_face = if upper { knots.length() - x } else { x };
            least = least.min(from_face - boundary.reach_along(grid, points, p, axis));
        }
        let least = least.max(0.0);
        let least = if least < ROUNDING * face_cell(grid, axis, upper) {
            0.0
        } else {
            least
        };
        for offset in &offsets {
            let node = &mut near[patch.first_node + offset];
            *node = node.max(-least);
        }
    }
    halo.ghost_max(&mut near, 1);
    near.iter_mut().for_each(|gap| *gap = -*gap);
    near
}
