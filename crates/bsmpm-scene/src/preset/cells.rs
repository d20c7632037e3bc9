//! Chooses the cell sizes for a preset (key `accuracy`), with fine zones around footings, loads, rigid bodies, openings
//! and corners.

use super::Preset;
use super::axis::{Fine, MOST, ON_LINE, Spacing};
use super::concentration::PresetOpening;
use super::scene::{GradedSegment, PresetScene, around};
use crate::report::brief;
use crate::validate::SQUARE;
use crate::words::{Side, Support, Word};

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
        let thin = |[lower, upper]: [[f64; 2]; 2]| {
            let [x, y] = [0, 1].map(|axis| upper[axis] - lower[axis]);
            let axis = usize::from(y < x);
            (x.min(y), self.longest(axis, [lower[axis], upper[axis]]))
        };
        let bodies = scene.root.records("body").iter().filter_map(around).map(thin);
        bodies
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
        let (size, why) = (
            side / preset.across,
            format!("{} cells across the bodies ({side} m)", preset.across),
        );
        let (size, why) = self.wave_cell(size).unwrap_or((size, why));
        let mut zones = self.zones(preset, size)?;
        zones.extend(self.at_openings(preset, size));
        if self.materials().any(|material| material.gives("band_width")) {
            let cell = |zone: &&Zone| zone.ranges[0].cell;
            let smallest = zones.iter().min_by(|a, b| cell(a).total_cmp(&cell(b)));
            let (size, why) = smallest.map_or((size, &why), |zone| (cell(&zone), &zone.why));
            return self.squares(size, why);
        }
        zones.extend(self.at_corners(preset, size));
        if zones.is_empty() {
            self.equal(size, why)
        } else {
            self.graded(preset, (size, &why), &zones)
        }
    }

    /// Equal cells of about `size` (m). Along an axis between two faces that stay they come out whole.
    fn equal(&self, size: f64, why: String) -> Option<Cells> {
        let (ends, wanted) = (self.ends()?, self.wanted());
        let edge = |axis: usize| {
            Some(if self.stays(axis)? {
                whole(ends[axis], size)
            } else {
                size
            })
        };
        let edges = [edge(0)?, edge(1)?];
        if !edges.iter().all(|edge| *edge > 0.0 && edge.is_finite()) {
            return None;
        }
        if self.on_lines(edges)? {
            return Some(of_edges(edges, why));
        }
        let along = |axis: usize| {
            let spacing = Spacing {
                cell: edges[axis],
                growth: 1.0,
                fine: Vec::new(),
            };
            spacing.breakpoints(ends[axis], &wanted[axis])
        };
        let why = format!("{why}, adjusted by up to half a cell to interfaces and to the ends of footings and loads");
        let mut cells = of_breakpoints([along(0)?, along(1)?], why)?;
        cells.breakpoints = None; // about equal ones
        Some(cells)
    }

    /// Equal squares of about `size` (m) or smaller ones, which come out whole between faces that stay: the softening
    /// of a material with a band_width goes by their edge. Of those down to a quarter as long the first whose lines are
    /// where strips, loads and materials end, or if none are the first.
    fn squares(&self, size: f64, why: &str) -> Option<Cells> {
        let (ends, stays) = (self.ends()?, [self.stays(0)?, self.stays(1)?]);
        let along = usize::from(!stays[0] && stays[1]);
        let length = ends[along][1] - ends[along][0];
        let fewest = (length / size).round().max(1.0);
        if !(1.0..=MOST).contains(&fewest) {
            return None;
        }
        let divided = (0..=3 * fewest as usize).map(|more| length / (fewest + more as f64));
        let given = (!stays[along]).then_some(size);
        let fitted = |edge: f64| [0, 1].map(|axis| if stays[axis] { whole(ends[axis], edge) } else { edge });
        let is_square = |[x, y]: &[f64; 2]| x.max(*y) <= SQUARE * x.min(*y);
        let all: Vec<[f64; 2]> = given.into_iter().chain(divided).map(fitted).filter(is_square).collect();
        let edges = all
            .iter()
            .find(|edges| self.on_lines(**edges) == Some(true))
            .or(all.first())?;
        Some(of_edges(
            *edges,
            format!("{why}; equal squares, as a material has a band_width"),
        ))
    }

    /// Whether both faces across an axis stay where they are.
    fn stays(&self, axis: usize) -> Option<bool> {
        let boundary = self.root.record("boundary")?;
        let moved: Vec<Side> = self
            .root
            .records("prescribed")
            .iter()
            .filter_map(|motion| motion.word("face"))
            .collect();
        let gives_way = |side: Side| boundary.word(side.word()) == Some(Support::Free) && !moved.contains(&side);
        Some(!Side::ALL[axis].into_iter().any(gives_way))
    }

    /// Whether lines of equal cells with these edges (m) are at all places at which one is wanted.
    fn on_lines(&self, edges: [f64; 2]) -> Option<bool> {
        let (ends, wanted) = (self.ends()?, self.wanted());
        let on_line = |axis: usize| {
            let ([lower, upper], edge) = (ends[axis], edges[axis]);
            let off = |at: &f64| ((at - lower) / edge - ((at - lower) / edge).round()).abs();
            let inside = |at: &&f64| (lower..=upper).contains(*at);
            wanted[axis].iter().filter(inside).all(|at| off(at) <= ON_LINE)
        };
        Some(on_line(0) && on_line(1))
    }

    /// Small cells in the zones and growing ones away from them, up to the size (m) that the bodies want, which has a
    /// reason.
    fn graded(&self, preset: &Preset, (size, why): (f64, &str), zones: &[Zone]) -> Option<Cells> {
        let (ends, mut wanted, growth) = (self.ends()?, self.wanted(), preset.growth);
        for segment in self.segments().filter(|segment| !segment.is_rigid()) {
            // The surface under a strip, or the wall beside it.
            segment
                .along()
                .into_iter()
                .for_each(|along| wanted[1 - along].push(segment.ends[0][1 - along]));
        }
        let along = |axis: usize| {
            let fine: Vec<Fine> = zones.iter().map(|zone| zone.ranges[axis]).collect();
            let edges = fine.iter().flat_map(|range| [range.lower, range.upper]);
            let wanted: Vec<f64> = wanted[axis].iter().copied().chain(edges).collect();
            Spacing {
                cell: size,
                growth,
                fine,
            }
            .breakpoints(ends[axis], &wanted)
        };
        let around = match (zones.iter().any(|zone| zone.acts), zones.iter().all(|zone| zone.acts)) {
            (_, true) => "footings and loads",
            (true, false) => "footings, loads, holes, notches and re-entrant corners",
            (false, false) => "holes, notches and re-entrant corners",
        };
        let why =
            format!("{why}, smaller cells around {around}, each about {growth} times as long as the next smaller one");
        let mut cells = of_breakpoints([along(0)?, along(1)?], why)?;
        cells.edge = size;
        for Zone { ranges, why, acts } in zones {
            let edges = [0, 1].map(|axis| cells.longest(axis, [ranges[axis].lower, ranges[axis].upper]));
            let range = |axis: usize| {
                let [lower, upper] = [
                    ranges[axis].lower.max(ends[axis][0]),
                    ranges[axis].upper.min(ends[axis][1]),
                ]
                .map(brief);
                format!("{} = {lower} to {upper}", NAMES[axis])
            };
            if *acts {
                cells.edge = edges.into_iter().fold(cells.edge, f64::min);
            }
            let value = format!(
                "{} by {} m at {}, {}",
                brief(edges[0]),
                brief(edges[1]),
                range(0),
                range(1)
            );
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
        let zone = |segment: GradedSegment<'_>| {
            let (width, cut) = self.width(&segment, ends);
            let cell = (width / preset.along).min(segment.thinnest());
            let (reach, places) = (preset.reach * width, self.places(&segment));
            let range = |axis: usize| {
                let along = || places.iter().map(|place| place[axis]);
                let lower = along().fold(f64::INFINITY, f64::min) - reach;
                Fine {
                    lower,
                    upper: along().fold(f64::NEG_INFINITY, f64::max) + reach,
                    cell,
                }
            };
            let half = if cut { ", half of it modelled" } else { "" };
            let why = format!(
                "{} cells across `{}` ({} m wide{half}), along its path and {} widths around it",
                brief(width / cell),
                segment.name,
                brief(width),
                preset.reach
            );
            (cell > 0.0 && cell < size).then(|| Zone {
                ranges: [range(0), range(1)],
                why,
                acts: true,
            })
        };
        Some(self.segments().filter_map(zone).collect())
    }

    /// Where holes and notches want cells smaller than `size` (m).
    fn at_openings(&self, preset: &Preset, size: f64) -> Vec<Zone> {
        let zone = |opening: PresetOpening| {
            let (cell, reach) = (opening.width / preset.opening, preset.reach * opening.width);
            let [lower, upper] = opening.bounds;
            let range = |axis: usize| Fine {
                lower: lower[axis] - reach,
                upper: upper[axis] + reach,
                cell,
            };
            let (across, width) = (preset.opening, brief(opening.width));
            let why = format!(
                "{across} cells across the hole or notch {} ({width} m), and {} widths around it",
                opening.name, preset.reach
            );
            (cell > 0.0 && cell < size).then(|| Zone {
                ranges: [range(0), range(1)],
                why,
                acts: false,
            })
        };
        self.openings().into_iter().filter_map(zone).collect()
    }

    /// Where steep re-entrant corners want cells smaller than `size` (m).
    fn at_corners(&self, preset: &Preset, size: f64) -> Vec<Zone> {
        let (cell, reach) = (size / preset.corner, AT_CORNER * size / preset.corner);
        let zone = |at: [f64; 2]| {
            let range = |axis: usize| Fine {
                lower: at[axis] - reach,
                upper: at[axis] + reach,
                cell,
            };
            let place = at.map(brief);
            let why = format!(
                "1/{} of the other cells, at the re-entrant corner {place:?}",
                preset.corner
            );
            Zone {
                ranges: [range(0), range(1)],
                why,
                acts: false,
            }
        };
        self.re_entrant_corners().into_iter().map(zone).collect()
    }

    /// m  Width of a strip, loaded segment or rigid body; whether it is twice what is there, which a roller cuts in its
    /// middle.
    fn width(&self, segment: &GradedSegment<'_>, ends: [[f64; 2]; 2]) -> (f64, bool) {
        let [from, to] = segment.ends;
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let at_roller = |axis: usize, side: usize| {
            let support = self
                .root
                .record("boundary")
                .and_then(|boundary| boundary.word(Side::ALL[axis][side].word()));
            support == Some(Support::Roller) && segment.ends.iter().any(|end| end[axis] == ends[axis][side])
        };
        let cut = segment
            .along()
            .is_some_and(|axis| at_roller(axis, 0) != at_roller(axis, 1));
        (if cut { 2.0 * length } else { length }, cut)
    }

    /// m  lower and upper end of the grid per axis
    pub(super) fn ends(&self) -> Option<[[f64; 2]; 2]> {
        let grid = self.root.record("grid")?;
        let (lower, upper) = (grid.pair("lower")?, grid.pair("upper")?);
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
        keys: ["cell", "knots"],
        value,
        edge: x.min(y),
        why,
        sizes: Vec::new(),
        breakpoints: None,
    }
}

/// Cells with these breakpoints (m).
fn of_breakpoints(breakpoints: [Vec<f64>; 2], why: String) -> Option<Cells> {
    let shortest = |of: &[f64]| {
        of.windows(2)
            .map(|pair| pair[1] - pair[0])
            .fold(f64::INFINITY, f64::min)
    };
    let edge = shortest(&breakpoints[0]).min(shortest(&breakpoints[1]));
    let value = format!("{{ x = {:?}, y = {:?} }}", breakpoints[0], breakpoints[1]);
    let cells = Cells {
        keys: ["knots", "cell"],
        value,
        edge,
        why,
        sizes: Vec::new(),
        breakpoints: Some(breakpoints),
    };
    (edge > 0.0).then_some(cells)
}
