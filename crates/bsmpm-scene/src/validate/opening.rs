//! Warns of holes and notches of bodies that have too few cells across.

use crate::case::{Case, NarrowestOpening};
use crate::openings::{self, BodyOpening, GridFaces};
use crate::record::CaseTable;
use crate::report::Report;
use crate::schema::Draft;
use crate::words::Geometry;

/// Part of the shortest cell by which the cell at a wall is looked for within the body.
const WITHIN: f64 = 1e-3;

/// Finds the opening of the bodies that has the fewest cells across, and warns of every one that has too few.
pub(super) fn check(case: &mut Case, draft: &Draft, report: &mut Report<'_>) {
    let corners = [case.grid.lower(), case.grid.upper()];
    let faces = GridFaces {
        corners,
        supports: case.boundary,
        dims: case.grid.dims(),
    };
    let all = match case.geometry {
        Geometry::Solid => openings::in_space(case, draft, &faces),
        Geometry::PlaneStrain | Geometry::Axisymmetric => openings::in_plane(draft, &faces),
    };
    let mut narrowest: Option<NarrowestOpening> = None;
    for opening in &all {
        let found = NarrowestOpening {
            path: path(draft, opening),
            width: opening.opening.width,
            cells: cells(case, &faces, opening),
            least: NarrowestOpening::enough(case.bodies[opening.body].points_per_cell),
        };
        if found.cells < found.least {
            report.warn(format!(
                "W0227: {}: the hole or notch, {} m wide, has {:.1} cells across, but needs at least {}. Stresses at \
                 its edge are off by more than 10 %. Use smaller cells there.",
                found.path,
                found.brief_width(),
                found.cells,
                found.least
            ));
        }
        if narrowest
            .as_ref()
            .is_none_or(|known| found.cells / found.least < known.cells / known.least)
        {
            narrowest = Some(found);
        }
    }
    case.opening = narrowest;
}

/// The keys of what an opening is of.
fn path(draft: &Draft, opening: &BodyOpening) -> String {
    let body = &draft.body.items()[opening.body];
    match opening.cut {
        Some(cut) => body.subtract.items()[cut].location().path.clone(),
        None => body.shape().place().path().to_owned(),
    }
}

/// Cells across an opening, each as large as the one in the body beside a wall: the fewest of all walls.
fn cells(case: &Case, faces: &GridFaces, opening: &BodyOpening) -> f64 {
    let planes = faces.planes(case.bodies[opening.body].region.corners());
    let within = WITHIN * case.grid.shortest();
    let across = opening.opening.walls.iter().map(|wall| {
        let at = openings::folded(&planes, (wall.at - wall.normal * within).into());
        let parts = (0..case.grid.dims()).map(|axis| wall.normal[axis] / edge(case, axis, at[axis]));
        wall.width * parts.map(|part| part * part).sum::<f64>().sqrt()
    });
    across.fold(f64::INFINITY, f64::min)
}

/// m  edge of the cell at a place along an axis
fn edge(case: &Case, axis: usize, at: f64) -> f64 {
    let along = &case.grid.axes[axis];
    let cell = along.first_cell(|cell| along.lower() + along.breakpoint(cell + 1) > at);
    along.cell(cell.min(along.cells() - 1))
}
