//! Finds openings and re-entrant corners of bodies. A preset (key `accuracy`) refines cells there.

use super::scene::PresetScene;
use crate::openings::{self, GridFaces, PlaneBody, PlaneShape};
use crate::validate;

/// Directions around a corner in which material is looked for.
const DIRECTIONS: usize = 72;
/// Directions in which it is, from which on a corner counts: an interior angle of 240 degrees, the foot of a slope of
/// 60 degrees. At a flatter foot stress rises little.
const RE_ENTRANT: usize = 48;
/// Part of the shorter side at a corner as far as which material is looked for.
const NEAR: f64 = 1e-3;
/// Corners around which cells are small, at most: with more of them cells would be small everywhere.
const MOST_CORNERS: usize = 12;

/// A hole or notch.
pub(super) struct PresetOpening {
    /// The body and the shape that is cut out, as keys.
    pub name: String,
    /// m
    pub width: f64,
    /// m  lower and upper corner of the rectangle around it
    pub bounds: [[f64; 2]; 2],
}

impl PresetScene<'_> {
    /// Holes and notches of the bodies.
    pub(super) fn openings(&self) -> Vec<PresetOpening> {
        let Some(faces) = self.faces() else { return Vec::new() };
        let mut found = Vec::new();
        for openings::BodyOpening { body, cut, opening } in openings::in_plane(self.draft, &faces) {
            found.push(PresetOpening {
                name: match cut {
                    Some(cut) => format!("body.{body}.subtract.{cut}"),
                    None => format!("body.{body}"),
                },
                width: opening.width,
                bounds: opening.bounds.map(|[x, y, _]| [x, y]),
            });
        }
        found
    }

    /// m  Steep re-entrant corners of the material at the start and after every stage; none if there are too many.
    pub(super) fn re_entrant_corners(&self) -> Vec<[f64; 2]> {
        let Some(faces) = self.faces() else { return Vec::new() };
        let bodies: Vec<Option<PlaneBody>> = self.draft.body.items().iter().map(PlaneBody::of).collect();
        // What a rigid body touches is no free corner.
        let rigid: Vec<PlaneShape> = self
            .draft
            .rigid
            .items()
            .iter()
            .filter_map(|rigid| PlaneShape::of(rigid.shape()))
            .collect();
        let mut found: Vec<[f64; 2]> = Vec::new();
        for there in openings::phases(self.draft) {
            let there: Vec<&PlaneBody> = bodies
                .iter()
                .zip(&there)
                .filter_map(|(body, there)| body.as_ref().filter(|_| *there))
                .collect();
            for body in &there {
                let planes = faces.planes(body.bounds().map(|[x, y]| [x, y, 0.0]));
                for (at, side) in body
                    .shapes()
                    .filter(|shape| !shape.is_round)
                    .flat_map(|shape| shape.vertices())
                {
                    let material = places(at, NEAR * side).filter(|at| {
                        let [x, y, _] = openings::folded(&planes, [at[0], at[1], 0.0]);
                        there.iter().any(|body| body.contains([x, y]))
                    });
                    let around = material.count();
                    let is_held = places(at, NEAR * side).any(|at| rigid.iter().any(|body| body.contains(at)));
                    if (RE_ENTRANT..DIRECTIONS).contains(&around) && !is_held && !found.contains(&at) {
                        found.push(at);
                    }
                }
            }
        }
        if found.len() > MOST_CORNERS { Vec::new() } else { found }
    }

    /// The faces of the grid.
    fn faces(&self) -> Option<GridFaces> {
        let [x, y] = self.ends()?;
        let corners = [0, 1].map(|side| [x[side], y[side], 0.0]);
        Some(GridFaces {
            corners,
            supports: validate::boundary(self.draft)?,
            dims: 2,
        })
    }
}

/// m  Places around another one, in all directions.
fn places(at: [f64; 2], radius: f64) -> impl Iterator<Item = [f64; 2]> {
    (0..DIRECTIONS).map(move |k| {
        let (sin, cos) = ((k as f64 + 0.5) * std::f64::consts::TAU / DIRECTIONS as f64).sin_cos();
        [at[0] + radius * cos, at[1] + radius * sin]
    })
}
