//! Whether places lie in the grid, and whether there is a body at them.

use crate::case::Body;
use crate::grid::GridSpec;

/// Parts of a cell by which a place may lie beyond the grid: rounding.
const ROUNDING: f64 = 1e-9;
/// Parts of a cell from a line within which a body counts as being at it.
const NEAR: f64 = 0.01;
/// Places along a line at which bodies are looked for.
const SAMPLES: usize = 101;

/// Says that a place lies outside the grid, if it does.
pub(super) fn beyond(grid: &GridSpec, at: [f64; 2]) -> Option<String> {
    let (lower, upper) = (grid.lower(), grid.upper());
    (0..2).find_map(|axis| {
        let spacing = f64::EPSILON * lower[axis].abs().max(upper[axis].abs());
        let slack = ROUNDING * grid.axes[axis].shortest() + 4.0 * spacing;
        let name = ["x", "y"][axis];
        if at[axis] < lower[axis] - slack {
            return Some(format!("{} is outside the grid, which starts at {name} = {}", at[axis], lower[axis]));
        }
        let past = at[axis] > upper[axis] + slack;
        past.then(|| format!("{} is outside the grid, which ends at {name} = {}", at[axis], upper[axis]))
    })
}

/// Whether some body lies at the line between two places, on either side of it.
pub(super) fn occupied(bodies: &[Body], grid: &GridSpec, [from, to]: [[f64; 2]; 2]) -> bool {
    let near = NEAR * grid.axes[0].shortest().min(grid.axes[1].shortest());
    let sides = [[0.0, near], [0.0, -near], [near, 0.0], [-near, 0.0]];
    let place = |k: usize| {
        let part = k as f64 / (SAMPLES - 1) as f64;
        [0, 1].map(|axis| from[axis] + part * (to[axis] - from[axis]))
    };
    let mut places = (0..SAMPLES).map(place).flat_map(|at| sides.map(|side| [at[0] + side[0], at[1] + side[1]]));
    places.any(|at| bodies.iter().any(|body| body.region.contains(at)))
}
