//! Warns of histories of section forces that include a part of a nearby load.

use super::{place, stage};
use crate::case::{Case, RigidShape, RigidSolid};
use crate::observables::HistorySubject;
use crate::record::CaseTable;
use crate::report::Report;
use crate::schema::Draft;
use bsmpm::tensor::Vector;

/// Places along a section at which material is looked for, from one end of its lines to the other.
const PLACES: usize = 5;
/// Parts of a cell in which material beside a section is looked for.
const STEP: f64 = 0.25;

/// A section and the part of the grid that its forces are of.
struct Cut {
    middle: Vector<3>,
    along: Vec<(Vector<3>, f64)>, // unit vectors of its lines, and m: half of their lengths
    across: Vector<3>,
    cell: f64,  // m  of the grid, across
    reach: f64, // m  to either side within which what acts is in the section's forces by a part
}

impl Cut {
    fn of(case: &Case, lines: &[[[f64; 3]; 2]]) -> Option<Self> {
        let ends = lines.iter().map(|line| line.map(Vector::<3>::from));
        let mut middle = Vector::zeros();
        let mut along = Vec::new();
        for [from, to] in ends {
            middle += (from + to) / (2.0 * lines.len() as f64);
            along.push(((to - from).try_normalize(0.0)?, 0.5 * (to - from).norm()));
        }
        let second = along.get(1).map_or_else(Vector::z, |(line, _)| *line);
        let across = along.first()?.0.cross(&second).try_normalize(0.0)?;
        let axes = case.grid.axes.iter().enumerate();
        let cell = axes.map(|(axis, of)| across[axis].abs() * of.longest()).sum();
        // A function that is not zero at a place has its node within half of its support, and the cut is a cell wide.
        let reach = (0.5 * case.grid.order as f64 + 1.0) * cell;
        Some(Self {
            middle,
            along,
            across,
            cell,
            reach,
        })
    }

    /// Whether a place is within its ends and a cell beyond, and not far from it.
    fn is_near(&self, at: [f64; 3]) -> bool {
        let apart = Vector::from(at) - self.middle;
        apart.dot(&self.across).abs() < self.reach + self.cell
            && self
                .along
                .iter()
                .all(|(along, half)| apart.dot(along).abs() <= half + self.cell)
    }

    /// m  from the section along its normal to the least and the most of these places
    fn span(&self, places: &[[f64; 3]]) -> Option<[f64; 2]> {
        let across = places
            .iter()
            .map(|at| (Vector::from(*at) - self.middle).dot(&self.across));
        across.fold(None, |span, at| {
            span.map_or(Some([at; 2]), |[a, b]: [f64; 2]| Some([a.min(at), b.max(at)]))
        })
    }

    /// m  from the section along (1) or against (-1) its normal to the end of the material between its ends
    fn room(&self, case: &Case, side: f64) -> f64 {
        let steps = 0..=(2.0 * self.reach / (STEP * self.cell)) as usize;
        let away = steps.rev().map(|step| step as f64 * STEP * self.cell).find(|away| {
            let count = PLACES.pow(self.along.len() as u32);
            let mut places = (0..count).map(|k| (self.place(k) + self.across * (side * away)).into());
            places.any(|at| case.bodies.iter().any(|body| place::is_in(body, &case.grid, at)))
        });
        away.unwrap_or(0.0)
    }

    /// The place on it with a number, in the middle of one of equal pieces.
    fn place(&self, k: usize) -> Vector<3> {
        let lines = self.along.iter().enumerate();
        let off = lines.map(|(line, (along, half))| {
            let of = k / PLACES.pow(line as u32) % PLACES;
            let part = (2 * of + 1) as f64 / PLACES as f64 - 1.0;
            along * (part * *half)
        });
        self.middle + off.sum::<Vector<3>>()
    }

    /// Whether it has a part of the force of what acts at these places, and not all of it. What crosses it far to both
    /// sides, or as far as the material goes, acts on both alike, and what acts where the material ends is evaded.
    fn misses(&self, case: &Case, [least, most]: [f64; 2]) -> bool {
        if least >= self.reach || most <= -self.reach {
            return false;
        }
        let before = self.beside(case, -1.0, [-most, -least]);
        let beyond = self.beside(case, 1.0, [least, most]);
        let crosses = before.goes_on && beyond.goes_on;
        let is_evaded = before.ends && beyond.deep || beyond.ends && before.deep;
        !(crosses || is_evaded)
    }

    /// What acts between two distances (m) along (1) or against (-1) its normal, and the material there.
    fn beside(&self, case: &Case, side: f64, [nearest, farthest]: [f64; 2]) -> Beside {
        let slack = 1.01 * STEP * self.cell;
        let room = self.room(case, side);
        Beside {
            goes_on: farthest >= self.reach || room <= farthest + slack,
            ends: nearest > -slack && room <= nearest + slack,
            deep: room >= self.reach,
        }
    }
}

/// What acts, and the material, on one side of a section.
struct Beside {
    goes_on: bool, // whether it acts as far as the section reaches, or as the material goes
    ends: bool,    // whether the material ends at all of it
    deep: bool,    // whether there is material as far as the section reaches
}

/// Warns of section forces that have a part of the force of a strip, a rigid body or a load.
pub(super) fn warn_of_neighbours(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    for (history, record) in case.histories.iter().zip(draft.history.items()) {
        let HistorySubject::Section { lines, .. } = &history.quantity.subject else {
            continue;
        };
        let Some(cut) = Cut::of(case, lines) else { continue };
        let acting = stage::surfaces(case, draft)
            .into_iter()
            .map(|(_, key, places)| (key.table_path().to_owned(), places));
        let acting = acting.chain((0..case.rigid.len()).map(|k| (format!("rigid.{k}"), outline(case, k))));
        for (name, mut places) in acting {
            places.retain(|at| cut.is_near(*at) && place::is_at(&case.bodies, &case.grid, *at));
            if cut.span(&places).is_some_and(|span| cut.misses(case, span)) {
                let cells = cut.reach / cut.cell;
                report.warn(format!(
                    "W0428: {}: `{name}` acts within {cells} cells of this section, so the section forces include an \
                     arbitrary part of its force. Move the section {cells} cells away, or use smaller cells.",
                    record.location().path
                ));
            }
        }
    }
}

/// Places on a rigid body; of terrain none.
fn outline(case: &Case, number: usize) -> Vec<[f64; 3]> {
    match &case.rigid[number].shape {
        RigidShape::Polygon(corners) => {
            let sides = (0..corners.len()).map(|k| [corners[k], corners[(k + 1) % corners.len()]]);
            sides.flat_map(place::along).map(place::flat).collect()
        }
        RigidShape::Circle { center, radius } => place::ring(*center, *radius).map(place::flat).collect(),
        RigidShape::InSpace(RigidSolid::Terrain(_)) => Vec::new(),
        RigidShape::InSpace(solid) => place::over(solid.corners()).collect(),
    }
}
