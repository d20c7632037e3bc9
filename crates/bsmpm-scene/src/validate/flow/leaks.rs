//! Where soils of unlike permeability meet, and what tight ones let through there.

use crate::case::{Case, Flow};
use crate::report::Report;
use crate::validate::lines;
use bsmpm::water::flow::Soil;
use std::collections::BTreeMap;

/// Ratio of two permeabilities from which an interface inside cells is warned of. A layer of one cell, half a cell off
/// the grid's lines, let through 4, 11, 28 and 75 % too much with 2, 3, 5 and 10, and ten times as much with 100; of
/// two cells 1, 4, 9, 22 and 80 %.
const UNLIKE: f64 = 3.0;

/// Warns of soils that meet where the pressure cannot follow what their permeabilities ask for; in a plane.
pub(super) fn check(case: &Case, flow: &Flow, report: &mut Report<'_>) {
    if case.grid.dims() != 2 {
        return;
    }
    let mut told = BTreeMap::new();
    for body in &case.bodies {
        for edge in body.region.edges(&case.grid).0 {
            let is_on_line = lines::line_of(case, &edge).is_some();
            for (at, (a, b)) in lines::beside(case, &edge) {
                let Some((one, other)) = flow.soils[a].as_ref().zip(flow.soils[b].as_ref()) else { continue };
                if let Some(message) = leak(ratio(one, other), is_on_line, at) {
                    told.entry((a.min(b), a.max(b))).or_insert(message);
                }
            }
        }
    }
    for ((a, b), message) in told {
        let [a, b] = [a, b].map(|material| &case.materials[material].name);
        report.warn(format!("material.{a} and material.{b} {message}"));
    }
}

/// What two soils do to the water where they meet, if their permeabilities have this ratio.
fn leak(ratio: f64, is_on_line: bool, at: [f64; 2]) -> Option<String> {
    if ratio.is_infinite() {
        return Some(format!(
            "meet at {at:.3?}, and water flows in one of them only: its pressure goes on into the other, which drains or swells \
             over a cell or two there (water from below lifted a layer of 4, 8, 20 cells by 40, 20, 8 % too much, one that is \
             cut inside cells lets water through); take many cells across the other one"
        ));
    }
    let told = || {
        format!(
            "meet inside cells, first at {at:.3?}, one {ratio:.3e} times as permeable as the other: what is tight leaks there (a \
             layer of one cell let through 1.7 times too much at 1 : 10, ten times at 1 : 100; of two cells 1.2 and 1.8 times); \
             where they meet along an axis put a grid line there, else give what is tight many cells, and compare two sizes"
        )
    };
    (!is_on_line && ratio >= UNLIKE).then(told)
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
