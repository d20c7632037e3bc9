//! Upper bounds of limit loads, by [`super::slips`].

use super::slips::{Edge, Ground};
use std::f64::consts::PI;

/// Edges of half a pipe; with 8 or 64 the bounds are others by 0.2 %.
const EDGES: usize = 32;

/// Force on a smooth pipe over c D, `depth` diameters from its centre to the surface of weightless clay, that is pulled
/// up; `nodes` to a diameter.
pub fn pipe(depth: f64, nodes: usize) -> f64 {
    let angle = |k: usize| PI * (k as f64 / EDGES as f64 - 0.5);
    let around = |k: usize| {
        if k.is_multiple_of(EDGES) {
            [0.0, angle(k).sin() / 2.0]
        } else {
            [angle(k).cos() / 2.0, angle(k).sin() / 2.0]
        }
    };
    body_in_clay(&(0..=EDGES).rev().map(around).collect::<Vec<_>>(), depth, nodes)
}

/// Force on a smooth plate over c B, its upper side `depth` widths deep and `thickness` widths thick, in the same way.
pub fn plate(depth: f64, thickness: f64, nodes: usize) -> f64 {
    body_in_clay(
        &[[0.0, 0.0], [0.5, 0.0], [0.5, -thickness], [0.0, -thickness]],
        depth,
        nodes,
    )
}

/// Half of a body by its corners from the top down, about which it is as wide as 1 m.
fn body_in_clay(body: &[[f64; 2]], depth: f64, nodes: usize) -> f64 {
    let [wide, deep] = [depth + 0.5, 1.0];
    let around = [
        ([0.0, -deep], Edge::Held),
        ([wide, -deep], Edge::Held),
        ([wide, depth], Edge::Free),
        ([0.0, depth], Edge::Axis),
    ];
    let mut corners = around.to_vec();
    corners.extend(body.iter().map(|&corner| (corner, Edge::Pushed([0.0, 1.0]))));
    corners.last_mut().expect("a body").1 = Edge::Axis;
    let layers = vec![(f64::NEG_INFINITY, 1.0)];
    2.0 * Ground {
        corners,
        layers,
        unit_weight: 0.0,
        longest: 2.0,
    }
    .least_work(1.0 / nodes as f64)
}

/// Pressure over c of a smooth strip, 2 m wide, on clay of c, 1 m thick, on clay of `ratio` c; `nodes` to its width.
pub fn strip(ratio: f64, nodes: usize) -> f64 {
    let pushed = Edge::Pushed([0.0, -1.0]);
    let corners = [
        ([0.0, -4.0], Edge::Held),
        ([6.0, -4.0], Edge::Held),
        ([6.0, 0.0], Edge::Free),
        ([1.0, 0.0], pushed),
        ([0.0, 0.0], Edge::Axis),
    ];
    let layers = vec![(-1.0, 1.0), (f64::NEG_INFINITY, ratio)];
    Ground {
        corners: corners.to_vec(),
        layers,
        unit_weight: 0.0,
        longest: 4.0,
    }
    .least_work(2.0 / nodes as f64)
}

/// Factor of safety of the pit of `excavation.toml` after its first or second stage; nodes so far apart, m.
pub fn pit(stage: usize, spacing: f64) -> f64 {
    let mut corners = vec![
        ([0.0, 0.0], Edge::Held),
        ([32.0, 0.0], Edge::Axis),
        ([32.0, 16.0], Edge::Free),
        ([14.0, 16.0], Edge::Free),
    ];
    corners.push(([14.0, 12.0], Edge::Free));
    match stage {
        1 => corners.push(([0.0, 12.0], Edge::Axis)),
        _ => corners.extend([
            ([8.0, 12.0], Edge::Free),
            ([8.0, 8.0], Edge::Free),
            ([0.0, 8.0], Edge::Axis),
        ]),
    }
    let layers = vec![(f64::NEG_INFINITY, 1.0)];
    Ground {
        corners,
        layers,
        unit_weight: 18.0 / 50.0,
        longest: 10.0 * spacing,
    }
    .least_work(spacing)
}
