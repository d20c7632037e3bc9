//! Warns of valid but implausible values in a case, such as a value in a wrong unit.

mod direction;
mod place;
mod slope;
mod support;
mod value;

use crate::case::Case;
use crate::report::Report;
use crate::rounding::brief;
use crate::schema::Draft;

/// Warns of what is possible, but probably not meant.
pub(super) fn check(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    let scale = Scale::of(case);
    for (number, (_, material)) in draft.material.items().iter().enumerate() {
        if case.is_followed(number) {
            value::material(material, &scale, report);
        }
    }
    value::loads(draft, &scale, report);
    direction::gravity(case, report);
    place::bodies(case, draft, report);
    place::histories(case, draft, report);
    support::bodies(case, draft, report);
    slope::bodies(case, draft, report);
}

/// What the stresses of a case are like.
struct Scale {
    /// m  height of all bodies together
    height: f64,
    /// Pa  weight of the heaviest material over that height, or the largest load if there is more of it
    stress: Option<f64>,
}

impl Scale {
    fn of(case: &Case) -> Self {
        let up = case.grid.dims() - 1;
        let corners = case.bodies.iter().map(|body| body.region.corners());
        let lowest = corners
            .clone()
            .map(|[lower, _]| lower[up])
            .fold(f64::INFINITY, f64::min);
        let highest = corners.map(|[_, upper]| upper[up]).fold(f64::NEG_INFINITY, f64::max);
        let height = highest - lowest;
        let size = case
            .gravity
            .as_ref()
            .map_or(0.0, |gravity| length(gravity.acceleration));
        let density = case
            .bodies
            .iter()
            .filter_map(|body| case.materials[body.material].density)
            .fold(0.0, f64::max);
        let load = case
            .tractions
            .iter()
            .map(|traction| traction.largest())
            .fold(0.0, f64::max);
        let stress = (density * size * height).max(load);
        Self {
            height,
            stress: (stress > 0.0).then_some(stress),
        }
    }

    /// The stress in words, if it is known.
    fn shown(&self) -> String {
        self.stress
            .map_or(String::new(), |stress| format!(" ({} kPa)", brief(1e-3 * stress)))
    }
}

fn length(vector: [f64; 3]) -> f64 {
    vector.iter().map(|along| along * along).sum::<f64>().sqrt()
}
