//! Distance that material interfaces have moved from their initial grid lines. Strains can jump only at these grid
//! lines.

use crate::field::pore_water::flow::Flow;
use crate::grid::KnotVector;
use crate::model::Model;
use crate::parallel::Halo;
use crate::points::Points;
use crate::tensor::Vector;
use std::collections::BTreeMap;

/// Ratio of two permeabilities above which the position of their interface affects the flow.
const UNLIKE: f64 = 3.0;

/// Largest distance between an interface and its initial grid line, in cells; `None` if there is no such interface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InterfaceShift {
    /// Interfaces of two materials on a C0 line (a repeated breakpoint).
    pub stress: Option<f64>,
    /// Interfaces on a grid line of two materials whose permeabilities differ by a factor of 3 or more.
    pub water: Option<f64>,
}

/// One side of a piece of a grid line as long as a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct LineSide {
    axis: usize,
    /// Cell below the line along the axis.
    below: usize,
    /// Combined number of the cells along the other axes.
    across: usize,
    is_above: bool,
}

/// Point of a material that was initially nearest to one side of a line piece.
#[derive(Clone, Copy, Debug)]
struct Neighbour {
    distance: f64, // m, initial distance from the line
    moved: f64,    // cells, displacement across the line
    is_c0: bool,
}

impl Neighbour {
    /// Returns the nearer of the two; between equal distances, the one with the larger displacement.
    fn nearer(self, other: Self) -> Self {
        let is_nearer = other.distance < self.distance;
        let is_as_near = other.distance == self.distance && other.moved > self.moved;
        if is_nearer || is_as_near { other } else { self }
    }
}

/// Nearest points by side of a line piece and number of the material.
type Neighbours = BTreeMap<(LineSide, usize), Neighbour>;

/// Returns the shift over the points of all ranks, which count for the cell in which they were initially. One gathering
/// over all ranks.
pub fn shift<K, const D: usize>(model: &Model<K, D>, points: &Points<D>, halo: &dyn Halo) -> InterfaceShift {
    let flow = model.water.as_ref().and_then(|water| water.flow.as_ref());
    let mut message = Vec::new();
    for ((side, material), of) in neighbours(model, points) {
        let numbers = [side.axis, side.below, side.across, usize::from(side.is_above), material];
        message.extend(numbers.map(|number| number as f64));
        message.extend([of.distance, of.moved, f64::from(u8::from(of.is_c0))]);
    }
    let mut all = Neighbours::new();
    for item in halo.gather(&message).chunks_exact(8) {
        let [axis, below, across, above, material] = [0, 1, 2, 3, 4].map(|at| item[at] as usize);
        let side = LineSide {
            axis,
            below,
            across,
            is_above: above == 1,
        };
        keep(
            &mut all,
            side,
            material,
            Neighbour {
                distance: item[5],
                moved: item[6],
                is_c0: item[7] == 1.0,
            },
        );
    }
    let mut found = InterfaceShift::default();
    for (&(side, lower), below) in all.iter().filter(|((side, _), _)| !side.is_above) {
        let above = LineSide { is_above: true, ..side };
        for (&(_, upper), above) in all.range((above, 0)..=(above, usize::MAX)) {
            let moved = below.moved.max(above.moved);
            if lower != upper && below.is_c0 {
                found.stress = Some(found.stress.map_or(moved, |so_far| so_far.max(moved)));
            }
            let permeabilities = [lower, upper].map(|material| permeability(flow, material, side.axis));
            let [Some(a), Some(b)] = permeabilities else { continue };
            if a.max(b) >= UNLIKE * a.min(b) {
                found.water = Some(found.water.map_or(moved, |so_far| so_far.max(moved)));
            }
        }
    }
    found
}

/// Returns the permeability of a material along an axis, if seepage is computed in it.
fn permeability<const D: usize>(flow: Option<&Flow<D>>, material: usize, axis: usize) -> Option<f64> {
    let soil = flow?.soils.get(material)?.as_ref()?;
    Some(soil.permeability.as_ref()?.along[axis])
}

fn keep(all: &mut Neighbours, side: LineSide, material: usize, neighbour: Neighbour) {
    let nearest = all
        .get(&(side, material))
        .map_or(neighbour, |known| known.nearer(neighbour));
    all.insert((side, material), nearest);
}

/// Returns the nearest points of this rank, which were within half a cell of their line.
fn neighbours<K, const D: usize>(model: &Model<K, D>, points: &Points<D>) -> Neighbours {
    let grid = &model.grid;
    let flows = model.is_coupled();
    let mut found = Neighbours::new();
    for p in 0..points.len() {
        let start: Vector<D> = points.x[p] - points.u[p];
        let Some(cell) = grid.locate(&start) else { continue };
        for axis in 0..D {
            let knots = &grid.axes()[axis];
            let [lower, upper] = [0, 1].map(|end| knots.breakpoint(cell[axis] + end));
            let is_upper = start[axis] > 0.5 * (lower + upper);
            let Some(line) = line_beside(knots, cell[axis], is_upper) else {
                continue;
            };
            if !line.is_c0 && !flows {
                continue;
            }
            let others = (0..D).filter(|other| *other != axis);
            let across = others.fold(0, |number, other| number * grid.axes()[other].cells() + cell[other]);
            let side = LineSide {
                axis,
                below: line.below,
                across,
                is_above: !is_upper,
            };
            let distance = if is_upper {
                upper - start[axis]
            } else {
                start[axis] - lower
            };
            let moved = points.u[p][axis].abs() / (upper - lower);
            let neighbour = Neighbour {
                distance,
                moved,
                is_c0: line.is_c0,
            };
            keep(&mut found, side, usize::from(points.material[p]), neighbour);
        }
    }
    found
}

/// Grid line inside the grid.
struct InnerLine {
    below: usize, // cell
    is_c0: bool,
}

/// Returns the line above or below a cell, if it is inside the grid. Between the cells at a C0 line there are q - 1 or
/// more cells of zero length.
fn line_beside(knots: &KnotVector, cell: usize, is_upper: bool) -> Option<InnerLine> {
    let [below, above] = if is_upper {
        let mut others = cell + 1..knots.cells();
        [cell, others.find(|&other| knots.has_length(other))?]
    } else {
        let mut others = (0..cell).rev();
        [others.find(|&other| knots.has_length(other))?, cell]
    };
    Some(InnerLine {
        below,
        is_c0: above - below >= knots.order(),
    })
}
