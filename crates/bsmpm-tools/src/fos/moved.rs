//! Displacement by which `bsmpm fos` judges a trial run: the soil of 2^D cells (D axes) has moved at least as far.

use bsmpm_io::frame::Frame;
use serde::Serialize;

/// Cells along each axis whose material moves at least as far as the displacement that decides.
const BLOCK: usize = 2;
/// A side holds the mechanism back where tension makes more than this share of the normal stress on it: near the crest
/// some soil with cohesion is in tension in any case, 1 % of the force on a side that does not matter.
const TENSION: f64 = 0.1;
/// The mechanism is what has moved by more than this share of the displacement that decides.
const MOVING: f64 = 0.5;

/// The material points that count.
#[derive(Clone, Debug)]
pub(super) struct MovedGround {
    points: Vec<MovedPoint>,
    /// how many of them fill a block of cells
    block: usize,
}

#[derive(Clone, Debug)]
struct MovedPoint {
    id: u64,
    /// m  at the end
    place: [f64; 3],
    /// m
    displacement: [f64; 3],
    /// Pa  normal stress along each axis, positive in tension
    stress: [f64; 3],
}

/// Which material points count, and how many fill a cell.
#[derive(Clone, Debug)]
pub(super) struct CountedPoints {
    /// of the axes
    pub dims: usize,
    /// along each axis, of the body that has most
    pub points_per_cell: usize,
    /// the lower and the upper corner in which they must have been before they moved, m; everywhere without
    pub region: Option<[[f64; 3]; 2]>,
}

/// A side of the grid that holds material in both directions.
#[derive(Clone, Debug)]
pub(super) struct HoldingSide {
    pub name: &'static str,
    pub axis: usize,
    /// m  coordinates along the axis of the cells at it
    pub cells: [f64; 2],
}

/// Where the ground moves.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Mechanism {
    /// m  the corners of the box about it
    pub lower: Vec<f64>,
    pub upper: Vec<f64>,
    /// of all material points that count
    pub share: f64,
    /// sides of the grid at which it is in tension
    pub pulled: Vec<PulledSide>,
}

/// A side of the grid that the mechanism reaches and that carries tension there.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct PulledSide {
    pub side: &'static str,
    /// of the normal stress on it
    pub share: f64,
}

impl CountedPoints {
    /// How many points fill a block of cells.
    fn block(&self) -> usize {
        (BLOCK * self.points_per_cell).pow(self.dims as u32)
    }

    fn counts(&self, point: &MovedPoint) -> bool {
        let Some([lower, upper]) = self.region else { return true };
        (0..self.dims).all(|axis| {
            let start = point.place[axis] - point.displacement[axis];
            lower[axis] <= start && start <= upper[axis]
        })
    }
}

impl MovedGround {
    /// That of a frame; none where no point counts, or the frame has no displacements.
    pub fn of(frame: &Frame, counted: &CountedPoints) -> Option<Self> {
        let displacements = frame.real("displacement", 3)?;
        let stresses = frame.real("stress", 6);
        let ids = frame.numbers("id");
        let mut points = Vec::new();
        for (number, &place) in frame.position.iter().enumerate() {
            let point = MovedPoint {
                id: ids.map_or(number as u64, |ids| ids[number]),
                place,
                displacement: std::array::from_fn(|axis| displacements[3 * number + axis]),
                stress: std::array::from_fn(|axis| stresses.map_or(0.0, |stresses| stresses[6 * number + axis])),
            };
            if counted.counts(&point) {
                points.push(point);
            }
        }
        let block = counted.block();
        (!points.is_empty()).then_some(Self { points, block })
    }

    /// m  What the material of a block of cells has moved at least: the displacement that decides.
    pub fn displacement(&self) -> f64 {
        let mut sizes: Vec<f64> = self.points.iter().map(MovedPoint::size).collect();
        sizes.sort_by(|a, b| b.total_cmp(a));
        sizes[self.block.min(sizes.len()) - 1]
    }

    /// m  The largest displacement of any point, and where it is.
    pub fn farthest(&self) -> (f64, [f64; 3]) {
        let first = &self.points[0];
        let farthest = self
            .points
            .iter()
            .fold(first, |a, b| if b.size() > a.size() { b } else { a });
        (farthest.size(), farthest.place)
    }

    /// Where it moves by more than [`MOVING`] of the displacement that decides.
    pub fn mechanism(&self, dims: usize, sides: &[HoldingSide]) -> Mechanism {
        let least = MOVING * self.displacement();
        let moving: Vec<&MovedPoint> = self.points.iter().filter(|point| point.size() >= least).collect();
        let mut lower = vec![f64::INFINITY; dims];
        let mut upper = vec![f64::NEG_INFINITY; dims];
        for point in &moving {
            for axis in 0..dims {
                lower[axis] = lower[axis].min(point.place[axis]);
                upper[axis] = upper[axis].max(point.place[axis]);
            }
        }
        let mut pulled = Vec::new();
        for side in sides {
            let share = tension(&moving, side);
            if share > TENSION {
                pulled.push(PulledSide { side: side.name, share });
            }
        }
        Mechanism {
            lower,
            upper,
            share: moving.len() as f64 / self.points.len() as f64,
            pulled,
        }
    }

    /// The same ground with the displacements of both superposed: `u + times (other.u - u)` of each point.
    pub fn superposed(&self, other: &Self, times: f64) -> Self {
        let mut sorted: Vec<&MovedPoint> = other.points.iter().collect();
        sorted.sort_by_key(|point| point.id);
        let mut points = self.points.clone();
        for point in &mut points {
            let found = sorted.binary_search_by_key(&point.id, |other| other.id);
            let others = found.map_or(point.displacement, |index| sorted[index].displacement);
            for (u, other) in point.displacement.iter_mut().zip(others) {
                *u += times * (other - *u);
            }
        }
        let block = self.block;
        Self { points, block }
    }
}

/// Tension over the whole normal stress of the points that lie in the cells at a side of the grid.
fn tension(points: &[&MovedPoint], side: &HoldingSide) -> f64 {
    let [from, to] = side.cells;
    let at_it = points
        .iter()
        .filter(|point| from <= point.place[side.axis] && point.place[side.axis] <= to);
    let stresses: Vec<f64> = at_it.map(|point| point.stress[side.axis]).collect();
    let tension: f64 = stresses.iter().map(|stress| stress.max(0.0)).sum();
    tension / stresses.iter().map(|stress| stress.abs()).sum::<f64>()
}

impl MovedPoint {
    fn size(&self) -> f64 {
        self.displacement.iter().map(|part| part * part).sum::<f64>().sqrt()
    }
}

impl Mechanism {
    /// The box in words.
    pub fn words(&self) -> String {
        let axes = ["x", "y", "z"].iter().zip(self.lower.iter().zip(&self.upper));
        let ranges: Vec<String> = axes
            .map(|(name, (low, high))| format!("{name} = {low:.1} to {high:.1} m"))
            .collect();
        format!(
            "{}, {:.0} % of the material points",
            ranges.join(", "),
            100.0 * self.share
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of 10 x 10 cells with one point each, of which those from x = 7 on have moved by 1 m to the right.
    fn ground() -> MovedGround {
        let point = |index: u64| {
            let place = [(index % 10) as f64 + 0.5, (index / 10) as f64 + 0.5, 0.0];
            let displacement = [f64::from(u8::from(place[0] > 7.0)), 0.0, 0.0];
            MovedPoint {
                id: index,
                place,
                displacement,
                stress: [5.0, -1.0, 0.0],
            }
        };
        MovedGround {
            points: (0..100).map(point).collect(),
            block: 4,
        }
    }

    #[test]
    fn fewer_points_than_fill_a_block_of_cells_do_not_decide() {
        let mut ground = ground();
        for number in [0, 33, 55] {
            ground.points[number].displacement = [9.0, 0.0, 0.0];
        }
        assert_eq!((ground.displacement(), ground.farthest().0), (1.0, 9.0));
        ground.points[77].displacement = [9.0, 0.0, 0.0];
        assert_eq!(ground.displacement(), 9.0);
    }

    #[test]
    fn the_mechanism_is_where_material_moves_and_names_sides_in_tension() {
        let side = |name, cells| HoldingSide { name, axis: 0, cells };
        let sides = [side("left", [0.0, 1.0]), side("right", [9.0, 10.0])];
        let found = ground().mechanism(2, &sides);
        assert_eq!(
            (found.lower, found.upper, found.share),
            (vec![7.5, 0.5], vec![9.5, 9.5], 0.3)
        );
        assert_eq!(
            found.pulled,
            [PulledSide {
                side: "right",
                share: 1.0
            }]
        );
        let mut pressed = ground();
        pressed
            .points
            .iter_mut()
            .for_each(|point| point.stress = [-5.0, -1.0, 0.0]);
        assert!(pressed.mechanism(2, &sides).pulled.is_empty());
    }

    #[test]
    fn displacements_are_superposed_point_by_point_in_whatever_order() {
        let still = ground();
        let mut moved = ground();
        moved
            .points
            .iter_mut()
            .for_each(|point| point.displacement[1] = 2.0 * point.id as f64);
        moved.points.reverse();
        let half = still.superposed(&moved, 0.5);
        assert_eq!(half.points[40].displacement, [0.0, 40.0, 0.0]);
        assert_eq!(half.points[99].displacement, [1.0, 99.0, 0.0]);
    }
}
