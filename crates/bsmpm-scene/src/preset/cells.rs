//! Chooses the cell sizes for a preset (key `accuracy`), with fine zones around footings, loads, rigid bodies, openings
//! and corners.

use super::Preset;
use super::axis::{Fine, MOST, ON_LINE, Spacing};
use super::scene::{GradedSegment, PresetScene, around};
use crate::rounding::brief;
use crate::schema::SupportTable;
use crate::validate::SQUARE;
use crate::words::{Side, Support};

/// What cells follow from.
pub(super) const CELLS: &str = "the bodies, footings and loads, the corners of the grid and [boundary]";

const NAMES: [&str; 2] = ["x", "y"];

/// Cells that a preset chooses.
pub(super) struct Cells {
    /// the key that says so, and its rival
    pub keys: [&'static str; 2],
    /// TOML
    pub value: String,
    /// m  the shortest edge; of cells of several sizes where they are small
    pub edge: f64,
    pub why: String,
    /// Of cells of several sizes: which where, and why.
    pub sizes: Vec<(String, String)>,
    /// m  breakpoints of the same along x and y
    breakpoints: Option<[Vec<f64>; 2]>,
}

impl Cells {
    /// Whether they are of several sizes.
    pub(super) fn is_graded(&self) -> bool {
        self.breakpoints.is_some()
    }

    /// m  the longest edge along an axis within a part of it
    pub(super) fn longest(&self, axis: usize, [lower, upper]: [f64; 2]) -> f64 {
        let Some(breakpoints) = &self.breakpoints else {
            return self.edge;
        };
        let cells = breakpoints[axis]
            .windows(2)
            .filter(|cell| cell[0] < upper && cell[1] > lower);
        cells.map(|cell| cell[1] - cell[0]).fold(0.0, f64::max)
    }

    /// m  the shorter side of the first body across which there are fewer than so many cells, and the edge of these
    pub(super) fn too_thin(&self, scene: &PresetScene<'_>, fewest: f64) -> Option<(f64, f64)> {
        let bodies = scene.draft.body.items().iter().filter_map(around);
        let sides = bodies.map(|[lower, upper]| {
            let [x, y] = [0, 1].map(|axis| upper[axis] - lower[axis]);
            let axis = usize::from(y < x);
            (x.min(y), self.longest(axis, [lower[axis], upper[axis]]))
        });
        sides
            .filter(|(side, edge)| *side < fewest * edge)
            .min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

/// Cells at a re-entrant corner that are as small, to either side of it.
const AT_CORNER: f64 = 4.0;

/// A rectangle in which cells are small.
struct Zone {
    /// m  per axis
    ranges: [Fine; 2],
    why: String,
    /// Whether something moves or loads the body there, so that steps follow its cells.
    acts: bool,
}

impl PresetScene<'_> {
    /// The cells.
    pub(super) fn cells(&self, preset: &Preset) -> Option<Cells> {
        let [lower, upper] = self.bounds()?;
        let side = (upper[0] - lower[0]).min(upper[1] - lower[1]);
        let size = side / preset.across;
        let why = format!("{} cells across the bodies ({side} m)", preset.across);
        let (size, why) = self.wave_cell(size).unwrap_or((size, why));
        let mut zones = self.zones(preset, size)?;
        zones.extend(self.at_openings(preset, size));
        if self.width_of_band().is_some() {
            let all = zones.iter();
            let smallest = all.min_by(|a, b| a.ranges[0].cell.total_cmp(&b.ranges[0].cell));
            let (size, why) = smallest.map_or((size, &why), |zone| (zone.ranges[0].cell, &zone.why));
            return self.squares(size, why);
        }
        zones.extend(self.at_corners(preset, size));
        if zones.is_empty() {
            self.equal(size, why)
        } else {
            self.graded(preset, size, &why, &zones)
        }
    }

    /// Equal cells of about `size` (m). Along an axis between two faces that stay they come out whole.
    fn equal(&self, size: f64, why: String) -> Option<Cells> {
        let ends = self.ends()?;
        let wanted = self.wanted();
        let mut edges = [size; 2];
        for (axis, edge) in edges.iter_mut().enumerate() {
            if self.stays(axis)? {
                *edge = whole(ends[axis], size);
            }
        }
        if !edges.iter().all(|edge| *edge > 0.0 && edge.is_finite()) {
            return None;
        }
        if self.on_lines(edges)? {
            return Some(of_edges(edges, why));
        }
        let mut breakpoints = [Vec::new(), Vec::new()];
        for (axis, breakpoints) in breakpoints.iter_mut().enumerate() {
            let spacing = Spacing {
                cell: edges[axis],
                growth: 1.0,
                fine: Vec::new(),
            };
            *breakpoints = spacing.breakpoints(ends[axis], &wanted[axis])?;
        }
        let why = format!("{why}, adjusted by up to half a cell to interfaces and to the ends of footings and loads");
        let mut cells = of_breakpoints(breakpoints, why)?;
        cells.breakpoints = None; // about equal ones
        Some(cells)
    }

    /// Equal squares of about `size` (m) or smaller ones, which come out whole between faces that stay: the softening
    /// of a material with a [`Self::width_of_band`] goes by their edge. Of those down to a quarter as long the first
    /// whose lines are where strips, loads and materials end, or if none are the first.
    fn squares(&self, size: f64, why: &str) -> Option<Cells> {
        let ends = self.ends()?;
        let stays = [self.stays(0)?, self.stays(1)?];
        let along = usize::from(!stays[0] && stays[1]);
        let length = ends[along][1] - ends[along][0];
        let fewest = (length / size).round().max(1.0);
        if !(1.0..=MOST).contains(&fewest) {
            return None;
        }
        let divided = (0..=3 * fewest as usize).map(|more| length / (fewest + more as f64));
        let given = (!stays[along]).then_some(size);
        let fitted = given
            .into_iter()
            .chain(divided)
            .map(|edge| [0, 1].map(|axis| if stays[axis] { whole(ends[axis], edge) } else { edge }));
        let all: Vec<[f64; 2]> = fitted.filter(|[x, y]| x.max(*y) <= SQUARE * x.min(*y)).collect();
        let edges = all
            .iter()
            .find(|edges| self.on_lines(**edges) == Some(true))
            .or(all.first())?;
        let key = self.width_of_band().unwrap_or("band_width");
        Some(of_edges(
            *edges,
            format!("{why}; equal squares, as a material has a {key}"),
        ))
    }

    /// The key of a material whose softening depends on the cell size.
    fn width_of_band(&self) -> Option<&str> {
        let bands = self.materials().map(|material| &material.band_width);
        let openings = self.materials().map(|material| &material.crack_opening);
        let mut keys = bands.chain(openings);
        keys.find(|key| key.is_given()).map(|key| key.name())
    }

    /// Whether both faces across an axis stay where they are.
    fn stays(&self, axis: usize) -> Option<bool> {
        let boundary = self.draft.boundary.value()?;
        let moved: Vec<Side> = self
            .draft
            .prescribed
            .items()
            .iter()
            .filter_map(|motion| motion.face.get())
            .collect();
        let mut sides = Side::ALL[axis].into_iter();
        Some(sides.all(|side| boundary.face(side).plain() != Some(Support::Free) || moved.contains(&side)))
    }

    /// Whether lines of equal cells with these edges (m) are at all places at which one is wanted.
    fn on_lines(&self, edges: [f64; 2]) -> Option<bool> {
        let ends = self.ends()?;
        let wanted = self.wanted();
        let are_on_lines = (0..2).all(|axis| {
            let [lower, upper] = ends[axis];
            let edge = edges[axis];
            let mut inside = wanted[axis].iter().filter(|at| (lower..=upper).contains(*at));
            inside.all(|at| ((at - lower) / edge - ((at - lower) / edge).round()).abs() <= ON_LINE)
        });
        Some(are_on_lines)
    }

    /// Small cells in the zones and growing ones away from them, up to the size (m) that the bodies want, which has a
    /// reason.
    fn graded(&self, preset: &Preset, size: f64, why: &str, zones: &[Zone]) -> Option<Cells> {
        let ends = self.ends()?;
        let mut wanted = self.wanted();
        let growth = preset.growth;
        for segment in self.segments().filter(|segment| !segment.is_rigid()) {
            // The surface under a strip, or the wall beside it.
            segment
                .along()
                .into_iter()
                .for_each(|along| wanted[1 - along].push(segment.ends[0][1 - along]));
        }
        let mut breakpoints = [Vec::new(), Vec::new()];
        for (axis, breakpoints) in breakpoints.iter_mut().enumerate() {
            let fine: Vec<Fine> = zones.iter().map(|zone| zone.ranges[axis]).collect();
            wanted[axis].extend(fine.iter().flat_map(|range| [range.lower, range.upper]));
            let spacing = Spacing {
                cell: size,
                growth,
                fine,
            };
            *breakpoints = spacing.breakpoints(ends[axis], &wanted[axis])?;
        }
        let around = match (zones.iter().any(|zone| zone.acts), zones.iter().all(|zone| zone.acts)) {
            (_, true) => "footings and loads",
            (true, false) => "footings, loads, holes, notches and re-entrant corners",
            (false, false) => "holes, notches and re-entrant corners",
        };
        let why =
            format!("{why}, smaller cells around {around}, each about {growth} times as long as the next smaller one");
        let mut cells = of_breakpoints(breakpoints, why)?;
        cells.edge = size;
        for Zone { ranges, why, acts } in zones {
            let edges = [0, 1].map(|axis| cells.longest(axis, [ranges[axis].lower, ranges[axis].upper]));
            if *acts {
                cells.edge = edges.into_iter().fold(cells.edge, f64::min);
            }
            let [x, y] = [0, 1].map(|axis| {
                let lower = brief(ranges[axis].lower.max(ends[axis][0]));
                let upper = brief(ranges[axis].upper.min(ends[axis][1]));
                format!("{} = {lower} to {upper}", NAMES[axis])
            });
            let value = format!("{} by {} m at {x}, {y}", brief(edges[0]), brief(edges[1]));
            cells.sizes.push((value, why.clone()));
        }
        let longest = [0, 1].map(|axis| brief(cells.longest(axis, ends[axis])));
        cells.sizes.push((
            format!("up to {} by {} m elsewhere", longest[0], longest[1]),
            String::new(),
        ));
        Some(cells)
    }

    /// Where strips, loaded segments and rigid bodies want cells smaller than `size` (m).
    fn zones(&self, preset: &Preset, size: f64) -> Option<Vec<Zone>> {
        let ends = self.ends()?;
        let mut zones = Vec::new();
        for segment in self.segments() {
            let (width, cut) = self.width(&segment, ends);
            let cell = (width / preset.along).min(segment.thinnest());
            if !(cell > 0.0 && cell < size) {
                continue;
            }
            let reach = preset.reach * width;
            let places = self.places(&segment);
            let ranges = [0, 1].map(|axis| {
                let along = places.iter().map(|place| place[axis]);
                let lower = along.clone().fold(f64::INFINITY, f64::min) - reach;
                let upper = along.fold(f64::NEG_INFINITY, f64::max) + reach;
                Fine { lower, upper, cell }
            });
            let half = if cut { ", half of it modelled" } else { "" };
            let why = format!(
                "{} cells across `{}` ({} m wide{half}), along its path and {} widths around it",
                brief(width / cell),
                segment.name,
                brief(width),
                preset.reach
            );
            let acts = true;
            zones.push(Zone { ranges, why, acts });
        }
        Some(zones)
    }

    /// Where holes and notches want cells smaller than `size` (m).
    fn at_openings(&self, preset: &Preset, size: f64) -> Vec<Zone> {
        let mut zones = Vec::new();
        for opening in self.openings() {
            let cell = opening.width / preset.opening;
            if !(cell > 0.0 && cell < size) {
                continue;
            }
            let reach = preset.reach * opening.width;
            let [lower, upper] = opening.bounds;
            let ranges = [0, 1].map(|axis| Fine {
                lower: lower[axis] - reach,
                upper: upper[axis] + reach,
                cell,
            });
            let across = preset.opening;
            let width = brief(opening.width);
            let why = format!(
                "{across} cells across the hole or notch {} ({width} m), and {} widths around it",
                opening.name, preset.reach
            );
            let acts = false;
            zones.push(Zone { ranges, why, acts });
        }
        zones
    }

    /// Where steep re-entrant corners want cells smaller than `size` (m).
    fn at_corners(&self, preset: &Preset, size: f64) -> Vec<Zone> {
        let cell = size / preset.corner;
        let reach = AT_CORNER * size / preset.corner;
        let mut zones = Vec::new();
        for at in self.re_entrant_corners() {
            let ranges = at.map(|at| Fine {
                lower: at - reach,
                upper: at + reach,
                cell,
            });
            let place = at.map(brief);
            let why = format!(
                "1/{} of the other cells, at the re-entrant corner {place:?}",
                preset.corner
            );
            let acts = false;
            zones.push(Zone { ranges, why, acts });
        }
        zones
    }

    /// m  Width of a strip, loaded segment or rigid body; whether it is twice what is there, which a roller cuts in its
    /// middle.
    fn width(&self, segment: &GradedSegment<'_>, ends: [[f64; 2]; 2]) -> (f64, bool) {
        let [from, to] = segment.ends;
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let boundary = self.draft.boundary.value();
        let cut = segment.along().is_some_and(|axis| {
            let [lower, upper] = [0, 1].map(|side| {
                let support = boundary.and_then(|boundary| boundary.face(Side::ALL[axis][side]).plain());
                support == Some(Support::Roller) && segment.ends.iter().any(|end| end[axis] == ends[axis][side])
            });
            lower != upper
        });
        (if cut { 2.0 * length } else { length }, cut)
    }

    /// m  lower and upper end of the grid per axis
    pub(super) fn ends(&self) -> Option<[[f64; 2]; 2]> {
        let grid = self.draft.grid.value()?;
        let lower = grid.lower.vector()?;
        let upper = grid.upper.vector()?;
        Some([0, 1].map(|axis| [lower[axis], upper[axis]]))
    }

    /// m  places along x and y at which a grid line is wanted: ends of strips and loaded segments, corners of rigid
    /// bodies, then sides of bodies, if these are of several materials.
    fn wanted(&self) -> [Vec<f64>; 2] {
        let mut wanted = [Vec::new(), Vec::new()];
        for segment in self.segments() {
            wanted
                .iter_mut()
                .zip(segment.lines())
                .for_each(|(wanted, lines)| wanted.extend(lines));
        }
        if self.materials().count() > 1 {
            for (a, b) in self.sides() {
                let across = [0, 1].into_iter().find(|&axis| a[axis] == b[axis]);
                across.into_iter().for_each(|axis| wanted[axis].push(a[axis]));
            }
        }
        wanted
    }
}

/// m  edge nearest to a size of cells that come out whole between two ends
fn whole([lower, upper]: [f64; 2], size: f64) -> f64 {
    (upper - lower) / ((upper - lower) / size).round().max(1.0)
}

/// Equal cells with these edges (m).
fn of_edges([x, y]: [f64; 2], why: String) -> Cells {
    let value = if x == y {
        format!("{x:?}")
    } else {
        format!("[{x:?}, {y:?}]")
    };
    Cells {
        keys: ["grid.cell", "grid.knots"],
        value,
        edge: x.min(y),
        why,
        sizes: Vec::new(),
        breakpoints: None,
    }
}

/// Cells with these breakpoints (m).
fn of_breakpoints(breakpoints: [Vec<f64>; 2], why: String) -> Option<Cells> {
    let [x, y] = breakpoints.each_ref().map(|along| {
        let edges = along.windows(2).map(|pair| pair[1] - pair[0]);
        edges.fold(f64::INFINITY, f64::min)
    });
    let edge = x.min(y);
    let value = format!("{{ x = {:?}, y = {:?} }}", breakpoints[0], breakpoints[1]);
    let cells = Cells {
        keys: ["grid.knots", "grid.cell"],
        value,
        edge,
        why,
        sizes: Vec::new(),
        breakpoints: Some(breakpoints),
    };
    (edge > 0.0).then_some(cells)
}
