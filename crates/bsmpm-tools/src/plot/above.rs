//! Draws the plan view of a 3-D run.

use bsmpm_io::frame::Frame;
use std::collections::HashMap;

use super::body::region_of;
use super::section;
use super::space::slope;
use crate::Error;
use crate::picture::axes::{self, Label, title};
use crate::picture::bar::{self, Bar, PointedEnds};
use crate::picture::canvas::Canvas;
use crate::picture::colour::{self, Rgb};
use crate::picture::layout::{Layout, aspect};
use crate::picture::splat;
use crate::picture::ticks::{ValueRange, range};
use crate::record::{RunRecord, short};

const ABOVE: f64 = 130.0;
const RIGHT: f64 = 60.0;
/// How far a part's colour reaches, in its size: to its corners.
const REACH: f64 = 0.75;
/// Range of colours over the size of a cell at least.
const FLAT: f64 = 1e-3;
/// The sun, towards it: from the upper left, steeply.
const LIGHT: [f64; 3] = [-0.5, 0.5, 0.707];
/// Share of the light that comes from everywhere.
const AMBIENT: f64 = 0.7;

/// Ways to opposite neighbours.
const ACROSS: [[i64; 2]; 4] = [[1, 0], [0, 1], [1, 1], [1, -1]];

/// Where the material of a frame ends above, in parts of the plane.
struct Heights {
    /// m  edges of the parts: of the largest cell
    part: [f64; 2],
    /// m  where they begin
    lower: [f64; 2],
    /// m  by their numbers along x and y
    top: HashMap<[i64; 2], f64>,
}

impl Heights {
    /// Of a body that goes on so far `above` its highest points, m.
    fn of(frame: &Frame, lower: [f64; 2], part: [f64; 2], above: f64) -> Self {
        let mut highest: HashMap<[i64; 2], f64> = HashMap::new();
        for at in &frame.position {
            let of = [0, 1].map(|axis| ((at[axis] - lower[axis]) / part[axis]).floor() as i64);
            let top = highest.entry(of).or_insert(f64::MIN);
            *top = top.max(at[2] + above);
        }
        // Where points were pulled apart one of a layer below is the highest: no pit, but a trench is deeper than that.
        let deepest = part[0].max(part[1]);
        let mut top = HashMap::new();
        for (&at, &height) in &highest {
            let beside = ACROSS.iter().filter_map(|by| lower_neighbour(&highest, at, *by));
            let raised = beside.fold(height, f64::max);
            top.insert(at, if raised - height <= deepest { raised } else { height });
        }
        Self { part, lower, top }
    }

    /// m  the middle of a part
    fn middle(&self, at: [i64; 2]) -> [f64; 3] {
        let [x, y] = [0, 1].map(|axis| self.lower[axis] + (at[axis] as f64 + 0.5) * self.part[axis]);
        [x, y, self.top[&at]]
    }

    /// Slope along an axis, by the neighbours that there are.
    fn slope(&self, at: [i64; 2], axis: usize) -> f64 {
        let [before, after] = [-1, 1].map(|by| {
            let mut place = at;
            place[axis] += by;
            self.top.get(&place).copied()
        });
        slope(before, self.top[&at], after, self.part[axis])
    }

    /// Share of the light that falls on a part.
    fn lit(&self, at: [i64; 2]) -> f64 {
        let normal = [-self.slope(at, 0), -self.slope(at, 1), 1.0];
        let size = normal.iter().map(|of| of * of).sum::<f64>().sqrt();
        let falls = normal.iter().zip(LIGHT).map(|(of, light)| of * light).sum::<f64>() / size;
        (AMBIENT + (1.0 - AMBIENT) * falls.max(0.0) / LIGHT[2]).min(1.0)
    }
}

/// Height (m) of the lower one of the two neighbours of a part along `by`; none where one of them is missing.
fn lower_neighbour(highest: &HashMap<[i64; 2], f64>, at: [i64; 2], by: [i64; 2]) -> Option<f64> {
    let before = highest.get(&[at[0] - by[0], at[1] - by[1]])?;
    let after = highest.get(&[at[0] + by[0], at[1] + by[1]])?;
    Some(before.min(*after))
}

/// Draws a picture for every frame of a solid, and returns their names; of a plane none.
pub(super) fn draw(record: &RunRecord, frames: &[Frame]) -> Result<Vec<String>, Error> {
    let grid = record.manifest.grid.as_ref().filter(|_| record.is_solid());
    let Some((&[from_x, from_y, ..], &[x, y, ..])) = grid.map(|grid| (&grid.lower[..], &grid.cell[..])) else {
        return Ok(Vec::new());
    };
    let heights: Vec<Heights> = frames
        .iter()
        .map(|frame| Heights::of(frame, [from_x, from_y], [x, y], section::above(record, frame)))
        .collect();
    let Some(ends) = range(heights.iter().flat_map(|of| of.top.values()).copied()) else {
        return Ok(Vec::new());
    };
    // A level surface is no relief of rounding.
    let room = (FLAT * x.min(y) - ends.length()).max(0.0) / 2.0;
    let ends = ValueRange::of(ends.low - room, ends.high + room);
    let mut names = Vec::new();
    for (frame, heights) in frames.iter().zip(&heights) {
        let name = format!("height_{}.png", short(frame.time));
        let bar = Bar {
            range: ends,
            label: Label::of("Height of the surface", "m"),
            pointed: PointedEnds::default(),
        };
        picture(record, frame, heights, bar).save(&record.directory.join(&name))?;
        names.push(name);
    }
    Ok(names)
}

fn picture(record: &RunRecord, frame: &Frame, heights: &Heights, bar: Bar) -> Canvas {
    let [window, region] = region_of(record, std::slice::from_ref(frame), [0, 1]);
    let lying = aspect(region) < bar::LYING;
    let layout = Layout::of(region, if lying { RIGHT } else { bar::BESIDE }, 0.0);
    let axes = layout.axes(ABOVE);
    let mut canvas = Canvas::new(
        layout.width,
        axes.bottom + axes::BELOW + if lying { bar::BELOW } else { 0.0 },
    );
    let below = record.moment(frame.time) + ", from above";
    title(&mut canvas, layout.width, &record.manifest.case.title, &below);
    let mut parts: Vec<[i64; 2]> = heights.top.keys().copied().collect();
    parts.sort_unstable();
    let mut shades: Vec<Rgb> = Vec::new();
    for at in &parts {
        let lit = heights.lit(*at);
        let colour = colour::map(bar.share(heights.top[at]));
        shades.push(colour.map(|part| (f64::from(part) * lit).round() as u8));
    }
    let places: Vec<[f64; 3]> = parts.iter().map(|at| heights.middle(*at)).collect();
    let sizes = vec![heights.part[0].max(heights.part[1]); places.len()];
    let inside = splat::SplatWindow {
        ranges: window,
        walls: Default::default(),
        reach: REACH,
    };
    splat::draw(&mut canvas, &axes, &inside, &places, &sizes, &shades);
    axes.draw(&mut canvas, Some(Label::of("x", "m")), Label::of("y", "m"));
    if lying {
        bar.lying(&mut canvas, &axes);
    } else {
        bar.upright(&mut canvas, &axes);
    }
    canvas
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_highest_points_count_and_slopes_away_from_the_light_are_darker() {
        let row = |x: f64, z: f64| [[x, 0.5, z], [x, 0.5, z - 1.0]];
        let position = [row(0.5, 1.0), row(1.5, 3.0), row(2.5, 1.0)].concat();
        let frame = Frame {
            step: 0,
            time: 0.0,
            position,
            fields: Vec::new(),
        };
        let heights = Heights::of(&frame, [0.0, 0.0], [1.0, 1.0], 0.25);
        assert_eq!(heights.top.len(), 3);
        assert_eq!(heights.middle([1, 0]), [1.5, 0.5, 3.25]);
        assert_eq!(
            (
                heights.slope([0, 0], 0),
                heights.slope([1, 0], 0),
                heights.slope([1, 0], 1)
            ),
            (2.0, 0.0, 0.0)
        );
        assert!(heights.lit([0, 0]) > heights.lit([2, 0]));
        assert_eq!(heights.lit([1, 0]), 1.0);
    }

    #[test]
    fn a_lower_point_between_others_is_no_pit_but_a_trench_stays_and_one_beside_them_is_lower() {
        let position = [2.0, 1.0, 3.0, 1.0, 3.0, 1.0].into_iter().enumerate();
        let position = position.map(|(k, z)| [k as f64 - 2.5, 0.5, z]).collect();
        let frame = Frame {
            step: 0,
            time: 0.0,
            position,
            fields: Vec::new(),
        };
        let heights = Heights::of(&frame, [-3.0, 0.0], [1.0, 1.0], 0.0);
        assert_eq!(
            [0, 1, 2, 3, 4, 5].map(|x| heights.top[&[x, 0]]),
            [2.0, 2.0, 3.0, 1.0, 3.0, 1.0]
        );
    }
}
