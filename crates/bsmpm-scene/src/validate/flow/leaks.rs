//! Warns of interfaces and thin walls if the grid cannot resolve the change of pore pressure across them.

use super::is_permeable;
use crate::case::{Body, Case, Flow};
use crate::observables::{HistorySubject, Observable};
use crate::report::Report;
use crate::validate::gap::cell_at;
use crate::validate::lines;
use crate::validate::place::{beyond, is_beyond, is_in};
use crate::validate::site::normal;
use bsmpm::field::pore_water::flow::Soil;
use bsmpm_shapes::Edge;
use std::collections::BTreeMap;

/// Ratio of two permeabilities from which an interface inside cells is warned of. A layer of one cell, half a cell off
/// the grid's lines, let through 4, 11, 28 and 75 % too much with 2, 3, 5 and 10, and ten times as much with 100; of
/// two cells 1, 4, 9, 22 and 80 %.
const UNLIKE: f64 = 3.0;

/// Cells across which functions of the pressure reach from one side to the other.
const REACH: f64 = 2.0;
/// Cells beside an edge at which what lies there is looked for.
const BESIDE: f64 = 1e-3;
/// Places between the two sides that are looked at in a cell.
const LOOKS: usize = 10;

/// Warns of soils that meet where the pressure cannot follow what their permeabilities ask for, in a plane; and of
/// fluxes that are wanted where they jump.
pub(super) fn check(case: &Case, flow: &Flow, report: &mut Report<'_>) {
    at_surfaces(case, report);
    if case.grid.dims() != 2 {
        return;
    }
    let mut leaks = BTreeMap::new();
    for body in &case.bodies {
        for edge in body.region.edges(&case.grid.axes).0 {
            let is_on_line = lines::line_of(case, &edge).is_some();
            for (at, (a, b)) in lines::beside(case, &edge) {
                let Some((one, other)) = flow.soils[a].as_ref().zip(flow.soils[b].as_ref()) else {
                    continue;
                };
                let ratio = ratio(one, other);
                if ratio.is_infinite() || (!is_on_line && ratio >= UNLIKE) {
                    leaks.entry((a.min(b), a.max(b))).or_insert((ratio, at));
                }
            }
        }
    }
    for ((a, b), (ratio, at)) in leaks {
        let (wet, dry) = if is_permeable(&flow.soils, a) { (a, b) } else { (b, a) };
        let [a, b, wet, dry] = [a, b, wet, dry].map(|material| &case.materials[material].name);
        report.warn(match ratio.is_infinite() {
            true => format!(
                "W0533: `{a}` and `{b}` meet at {at:.3?} m, and the pressure of `{wet}` also acts on two cells of the \
                 undrained `{dry}`. Use at least 20 cells across `{dry}`."
            ),
            false => format!(
                "W0534: `{a}` and `{b}` meet inside cells at {at:.3?} m with a permeability ratio of {ratio:.0}, so \
                 too much water passes the tighter soil. Put a grid line there, or use smaller cells."
            ),
        });
    }
    thin(case, flow, report);
}

/// Warns of histories of the flux in the cells of a surface.
fn at_surfaces(case: &Case, report: &mut Report<'_>) {
    for history in &case.histories {
        let HistorySubject::Place { at, .. } = history.quantity.subject else {
            continue;
        };
        if history.quantity.observable == Observable::Flux && is_near_surface(case, at) {
            report.warn(format!(
                "W0532: history `{}`: the point {:.3?} m is less than a cell from a surface of the soil, where the \
                 flux is unreliable. Move the point into the soil, or record \"water-outflow\" of the drain.",
                history.name,
                &at[..case.grid.dims()]
            ));
        }
    }
}

/// Whether one of the places a cell aside of `at` (m), along any of the axes, lies in the grid but in no body.
fn is_near_surface(case: &Case, at: [f64; 3]) -> bool {
    let grid = &case.grid;
    // Of the cell of the place, which lies in the ground if it lies at its edge.
    let cells = (0..grid.dims()).map(|axis| cell_at(grid, axis, at[axis] - grid.axes[axis].lower()));
    let cells: Vec<f64> = cells.map(|cell| cell * (1.0 - 1e-9)).collect();
    (0..3_i32.pow(grid.dims() as u32)).any(|n| {
        let steps = [n % 3, n / 3 % 3, n / 9].map(|k| f64::from(k) - 1.0);
        let mut place = at;
        (0..grid.dims()).for_each(|axis| place[axis] += cells[axis] * steps[axis]);
        is_beyond(grid, place).is_none() && !case.bodies.iter().any(|body| is_in(body, grid, place))
    })
}

/// Warns of walls and gaps between bodies in which water flows that are so thin that it goes through them.
fn thin(case: &Case, flow: &Flow, report: &mut Report<'_>) {
    let cell = case.grid.shortest();
    let mut walls: BTreeMap<Option<usize>, (f64, [f64; 2])> = BTreeMap::new();
    for t in std::iter::once(0.0).chain(case.stages.iter().map(|stage| stage.at)) {
        let there: Vec<&Body> = (0..case.bodies.len())
            .filter(|k| case.is_there(*k, t))
            .map(|k| &case.bodies[k])
            .collect();
        for edge in there
            .iter()
            .filter(|body| is_permeable(&flow.soils, body.material))
            .flat_map(|body| body.region.edges(&case.grid.axes).0)
        {
            let start = places_along(case, &edge);
            let across = normal(edge.a, edge.b);
            for (start, side) in start.flat_map(|at| [(at, 1.0), (at, -1.0)]) {
                let beside = aside(start, across, side * BESIDE * cell);
                if flows_at(flow, &there, beside) {
                    continue;
                }
                let far = (1..(REACH * LOOKS as f64) as usize).map(|k| k as f64 / LOOKS as f64);
                let met = far
                    .map(|far| (far, aside(start, across, side * far * cell)))
                    .find(|(_, place)| flows_at(flow, &there, *place))
                    .filter(|(_, place)| beyond(&case.grid, *place).is_none());
                if let Some((far, _)) = met {
                    let wall = there.iter().find(|body| body.region.contains(beside));
                    let wall = wall.map(|body| body.material);
                    let least = walls.entry(wall).or_insert((far, start));
                    if far < least.0 {
                        *least = (far, start);
                    }
                }
            }
        }
    }
    for (wall, (far, at)) in walls {
        let what = match wall {
            Some(material) => format!("wall of `{}`", case.materials[material].name),
            None => "gap".into(),
        };
        report.warn(format!(
            "W0535: the {what} between permeable bodies at {at:.3?} m is {far:.1} cells wide (at least {REACH}), so \
             water flows through it. Use more cells across this place, or a smaller `grid.cell`."
        ));
    }
}

/// The place at a distance (m) from `start` along a direction.
fn aside(start: [f64; 2], direction: [f64; 2], distance: f64) -> [f64; 2] {
    [0, 1].map(|axis| start[axis] + distance * direction[axis])
}

/// Whether a body at a place lets water through.
fn flows_at(flow: &Flow, bodies: &[&Body], place: [f64; 2]) -> bool {
    let mut at = bodies.iter().filter(|body| body.region.contains(place));
    at.any(|body| is_permeable(&flow.soils, body.material))
}

/// Places along an edge.
fn places_along(case: &Case, edge: &Edge) -> impl Iterator<Item = [f64; 2]> + use<> {
    let lower = case.grid.lower();
    let edge = *edge;
    (0..LOOKS).map(move |k| {
        let part = (k as f64 + 0.5) / LOOKS as f64;
        let x = edge.a[0] + part * (edge.b[0] - edge.a[0]);
        let y = if edge.is_along(1) {
            edge.a[1] + part * (edge.b[1] - edge.a[1])
        } else {
            edge.y(x)
        };
        [lower[0] + x, lower[1] + y]
    })
}

/// How many times as permeable one of two soils is as the other, along the axis in which they differ most; without end
/// if water flows in one only.
fn ratio(a: &Soil<3>, b: &Soil<3>) -> f64 {
    match (&a.permeability, &b.permeability) {
        (None, None) => 1.0,
        (Some(a), Some(b)) => {
            let along = a.along.iter().zip(&b.along).map(|(a, b)| a.max(*b) / a.min(*b));
            along.fold(1.0, f64::max)
        }
        _ => f64::INFINITY,
    }
}
