//! Draws the plan view of a 3-D run.

use bsmpm_io::frame::Frame;
use std::collections::HashMap;

use super::body::region_of;
use super::section;
use crate::Error;
use crate::picture::axes::{self, title};
use crate::picture::bar::{self, Bar};
use crate::picture::canvas::Canvas;
use crate::picture::colour::{self, Rgb};
use crate::picture::layout::{Layout, aspect};
use crate::picture::splat;
use crate::picture::ticks::range;
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
    fn of(frame: &Frame, (lower, part): ([f64; 2], [f64; 2]), above: f64) -> Self {
        let mut highest: HashMap<[i64; 2], f64> = HashMap::new();
        for at in &frame.position {
            let of = [0, 1].map(|axis| ((at[axis] - lower[axis]) / part[axis]).floor() as i64);
            let top = highest.entry(of).or_insert(f64::MIN);
            *top = top.max(at[2] + above);
        }
        // Where points were pulled apart one of a layer below is the highest: no pit, but a trench is deeper than that.
        let deepest = part[0].max(part[1]);
        let joined = |at: [i64; 2], by: &[i64; 2]| {
            let beside = |sign: i64| highest.get(&[0, 1].map(|axis| at[axis] + sign * by[axis]));
            Some(beside(-1)?.min(*beside(1)?))
        };
        let closed = |(at, top): (&[i64; 2], &f64)| {
            let raised = ACROSS.iter().filter_map(|by| joined(*at, by)).fold(*top, f64::max);
            (*at, if raised - top <= deepest { raised } else { *top })
        };
        Self {
            part,
            lower,
            top: highest.iter().map(closed).collect(),
        }
    }

    /// m  the middle of a part
    fn middle(&self, at: [i64; 2]) -> [f64; 3] {
        let [x, y] = [0, 1].map(|axis| self.lower[axis] + (at[axis] as f64 + 0.5) * self.part[axis]);
        [x, y, self.top[&at]]
    }

    /// Slope along an axis, by the neighbours that there are.
    fn slope(&self, at: [i64; 2], axis: usize) -> f64 {
        let beside = |by: i64| {
            let mut place = at;
            place[axis] += by;
            self.top.get(&place).copied()
        };
        let (here, length) = (self.top[&at], self.part[axis]);
        match (beside(-1), beside(1)) {
            (Some(before), Some(after)) => (after - before) / (2.0 * length),
            (Some(before), None) => (here - before) / length,
            (None, Some(after)) => (after - here) / length,
            (None, None) => 0.0,
        }
    }

    /// Share of the light that falls on a part.
    fn lit(&self, at: [i64; 2]) -> f64 {
        let normal = [-self.slope(at, 0), -self.slope(at, 1), 1.0];
        let size = normal.iter().map(|of| of * of).sum::<f64>().sqrt();
        let falls = normal.iter().zip(LIGHT).map(|(of, light)| of * light).sum::<f64>() / size;
        (AMBIENT + (1.0 - AMBIENT) * falls.max(0.0) / LIGHT[2]).min(1.0)
    }
}

/// Draws a picture for every frame of a solid, and returns their names; of a plane none.
pub(super) fn draw(record: &RunRecord, frames: &[Frame]) -> Result<Vec<String>, Error> {
    let grid = record.manifest.grid.as_ref().filter(|_| record.is_solid());
    let Some((&[from_x, from_y, ..], &[x, y, ..])) = grid.map(|grid| (&grid.lower[..], &grid.cell[..])) else {
        return Ok(Vec::new());
    };
    let parts = ([from_x, from_y], [x, y]);
    let of = |frame: &Frame| Heights::of(frame, parts, section::above(record, frame));
    let heights: Vec<Heights> = frames.iter().map(of).collect();
    let ends = range(heights.iter().flat_map(|of| of.top.values()).copied());
    let Some((low, high)) = ends else { return Ok(Vec::new()) };
    // A level surface is no relief of rounding.
    let room = (FLAT * x.min(y) - (high - low)).max(0.0) / 2.0;
    let ends = (low - room, high + room);
    let mut names = Vec::new();
    for (frame, heights) in frames.iter().zip(&heights) {
        let name = format!("height_{}.png", short(frame.time));
        let bar = Bar {
            range: ends,
            label: ("Height of the surface", "m"),
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
    let shade = |at: &[i64; 2]| -> Rgb {
        let lit = heights.lit(*at);
        colour::map(bar.share(heights.top[at])).map(|part| (f64::from(part) * lit).round() as u8)
    };
    let shades: Vec<Rgb> = parts.iter().map(shade).collect();
    let places: Vec<[f64; 3]> = parts.iter().map(|at| heights.middle(*at)).collect();
    let sizes = vec![heights.part[0].max(heights.part[1]); places.len()];
    let inside = splat::SplatWindow {
        ranges: window,
        walls: Default::default(),
        reach: REACH,
    };
    splat::draw(&mut canvas, &axes, &inside, (&places, &sizes), &shades);
    axes.draw(&mut canvas, Some(("x", "m")), ("y", "m"));
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
        let heights = Heights::of(&frame, ([0.0, 0.0], [1.0, 1.0]), 0.25);
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
        let heights = Heights::of(&frame, ([-3.0, 0.0], [1.0, 1.0]), 0.0);
        assert_eq!(
            [0, 1, 2, 3, 4, 5].map(|x| heights.top[&[x, 0]]),
            [2.0, 2.0, 3.0, 1.0, 3.0, 1.0]
        );
    }
}
