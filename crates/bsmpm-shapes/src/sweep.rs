//! Computes exact areas of body outlines with cut-outs, by division into vertical slices.

use crate::edge::{Bulge, Edge};

/// A rectangle (m from the lower corner of the grid).
#[derive(Clone, Copy, Debug)]
pub struct Window {
    /// Lower and upper end along x.
    pub x: [f64; 2],
    /// Lower and upper end along y.
    pub y: [f64; 2],
}

impl Window {
    pub(crate) fn area(&self) -> f64 {
        (self.x[1] - self.x[0]) * (self.y[1] - self.y[0])
    }
}

/// A part of a shape between two edges and two vertical lines.
#[derive(Clone, Copy, Debug)]
pub struct Slice {
    x: [f64; 2],
    bottom: [f64; 2],
    top: [f64; 2],
    bulge: Bulge, // by which arcs add to the trapezoid of the chords
    /// a place inside
    pub(crate) middle: [f64; 2],
}

impl Slice {
    /// Returns the area (m²).
    pub fn area(&self) -> f64 {
        let heights = (self.top[0] - self.bottom[0]) + (self.top[1] - self.bottom[1]);
        (0.5 * heights * (self.x[1] - self.x[0]) + self.bulge.area).max(0.0)
    }

    /// First moments of the area, m³.
    pub(crate) fn moment(&self) -> [f64; 2] {
        let width = self.x[1] - self.x[0];
        let heights = [self.top[0] - self.bottom[0], self.top[1] - self.bottom[1]];
        let about_left = width * width * (heights[0] + 2.0 * heights[1]) / 6.0;
        let [top, bottom] = [self.top, self.bottom].map(|[p, q]| p * p + p * q + q * q);
        let area = 0.5 * (heights[0] + heights[1]) * width;
        let chords = [self.x[0] * area + about_left, width * (top - bottom) / 6.0];
        [chords[0] + self.bulge.moment[0], chords[1] + self.bulge.moment[1]]
    }
}

/// Returns whether a position is filled: inside shape 0 and outside the other shapes.
pub fn is_filled(inside: &[bool]) -> bool {
    inside
        .split_first()
        .is_some_and(|(filled, cut)| *filled && !cut.contains(&true))
}

/// What shape 0 less the others covers of the vertical line at `x`, upwards.
pub(crate) fn intervals<'a>(edges: impl IntoIterator<Item = &'a Edge>, shapes: usize, x: f64) -> Vec<[f64; 2]> {
    let met = edges.into_iter().filter(|edge| edge.a[0] <= x && x < edge.b[0]);
    let mut crossings: Vec<(f64, usize)> = met.map(|edge| (edge.y(x), edge.shape)).collect();
    crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut inside = vec![false; shapes];
    let mut found: Vec<[f64; 2]> = Vec::new();
    let mut start = None;
    for (y, shape) in crossings {
        inside[shape] = !inside[shape];
        match (start, is_filled(&inside)) {
            (None, true) => start = Some(y),
            (Some(lower), false) => {
                start = None;
                found.push([lower, y]);
            }
            _ => {}
        }
    }
    found
}

/// Calls `visit` for every slice of the window that is filled, which `filled` decides by the shapes that contain it.
/// `edges` may lack those above the window, but not those below it.
pub fn sweep(
    edges: &[Edge],
    shapes: usize,
    window: &Window,
    filled: &dyn Fn(&[bool]) -> bool,
    visit: &mut dyn FnMut(Slice),
) {
    let mut below = Vec::new();
    let mut within = Vec::new();
    for edge in edges {
        match edge.span(window.x) {
            Some([_, high]) if high < window.y[0] => below.push(edge),
            Some([low, _]) if low <= window.y[1] => within.push(edge),
            _ => {}
        }
    }
    let mut inside = vec![false; shapes];
    let mut crossed: Vec<(f64, &Edge)> = Vec::new();
    for pair in events(&within, window).windows(2) {
        let x = [pair[0], pair[1]];
        let middle = 0.5 * (pair[0] + pair[1]);
        let here = |edge: &&&Edge| edge.a[0] <= middle && middle < edge.b[0];
        inside.fill(false);
        below
            .iter()
            .filter(here)
            .for_each(|edge| inside[edge.shape] = !inside[edge.shape]);
        crossed.clear();
        for edge in within.iter().filter(here) {
            match edge.y(middle) {
                y if y <= window.y[0] => inside[edge.shape] = !inside[edge.shape],
                y if y < window.y[1] => crossed.push((y, edge)),
                _ => {}
            }
        }
        crossed.sort_by(|a, b| a.0.total_cmp(&b.0));
        let line = |y: f64| ([y; 2], y, Bulge::default());
        let mut bottom = line(window.y[0]);
        let curves = crossed.iter().map(|(y, edge)| {
            let ends = x.map(|x| edge.y(x).clamp(window.y[0], window.y[1]));
            ((ends, *y, edge.bulge(x)), Some(edge.shape))
        });
        for (top, shape) in curves.chain(std::iter::once((line(window.y[1]), None))) {
            if filled(&inside) {
                let middle = [middle, 0.5 * (bottom.1 + top.1)];
                visit(Slice {
                    x,
                    bottom: bottom.0,
                    top: top.0,
                    bulge: top.2 - bottom.2,
                    middle,
                });
            }
            if let Some(shape) = shape {
                inside[shape] = !inside[shape];
            }
            bottom = top;
        }
    }
}

/// Increasing x from one side of the window to the other, between which edges neither end nor cross anything.
fn events(edges: &[&Edge], window: &Window) -> Vec<f64> {
    let mut events = Vec::new();
    for (number, edge) in edges.iter().enumerate() {
        events.extend([edge.a[0], edge.b[0]]);
        events.extend(window.y.into_iter().flat_map(|y| edge.levels(y)).flatten());
        let others = edges[number + 1..].iter().filter(|other| other.shape != edge.shape);
        events.extend(others.flat_map(|other| edge.crossings(other)).flatten());
    }
    events.retain(|x| window.x[0] < *x && *x < window.x[1]);
    events.extend(window.x);
    events.sort_by(f64::total_cmp);
    events.dedup();
    events
}
