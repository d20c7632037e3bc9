//! Curved surfaces of a solid that are loaded: triangles, which need not enclose anything, and spheres.

use super::place::{at_volume, beyond};
use super::site::AroundStrip;
use crate::case::Triangle;
use crate::record::Record;
use crate::region::edges_of;
use crate::report::Report;
use std::sync::Arc;

/// Longest edge of a sphere's triangles in parts of what an octant's arcs are divided by: corners at equal parts of the
/// flat octant lie farthest apart in its middle.
const STRETCHED: f64 = 2.45;
/// Largest radius of a sphere in spacings of points: of more than two million triangles.
const LARGEST: f64 = 200.0;

/// The triangles that a traction's `surface` or `sphere` gives: inside the grid, at bodies, in one piece, turned alike.
pub(super) fn triangles(record: &Record, around: AroundStrip<'_>, report: &mut Report<'_>) -> Option<Arc<[Triangle]>> {
    let (grid, bodies) = (around.grid.filter(|grid| grid.dims() == 3)?, around.bodies?);
    let (key, found) = match record.gives("sphere") {
        true => {
            let sphere = record.record("sphere")?;
            let (center, radius) = (sphere.vector("center")?, sphere.number("radius")?);
            let spacing = grid.shortest() / bodies.iter().map(|body| body.points_per_cell).max()? as f64;
            if radius > LARGEST * spacing {
                let message = format!(
                    "its radius is {:.0} spacings of points; allowed: up to {LARGEST}; give the part of it in the grid as a \
                     surface",
                    radius / spacing
                );
                sphere.error("radius", message, report);
                return None;
            }
            let inside = |triangle: &Triangle| beyond(grid, middle(triangle)).is_none();
            ("sphere", sphere_of(center, radius, spacing).into_iter().filter(inside).collect())
        }
        false => ("surface", given(record, report)?),
    };
    let wrong = match &found[..] {
        [] if key == "sphere" => Some("no part of it is inside the grid".into()),
        [] => Some("it has no triangle".into()),
        all if key == "surface" => {
            all.iter().flatten().find_map(|corner| beyond(grid, *corner)).or_else(|| in_one_piece(all).err())
        }
        _ => None,
    };
    let away = || found.iter().flat_map(places).find(|at| !at_volume(bodies, grid, *at));
    let away = || Some(format!("no body is at {:?} at the start; allowed: half a spacing of points from one", away()?));
    if let Some(message) = wrong.or_else(away) {
        record.error(key, message, report);
        return None;
    }
    Some(found.into())
}

/// The triangles of a record's table, m, without those that are a line or a place.
fn given(record: &Record, report: &mut Report<'_>) -> Option<Vec<Triangle>> {
    let table = record.record("surface")?;
    let scale = table.number("scale")?;
    let corner = |row: &[f64], k: usize| [0, 1, 2].map(|axis| scale * row[3 * k + axis] + 0.0);
    let rows = table.rows("triangles")?.iter().map(|row| [0, 1, 2].map(|k| corner(&row.numbers, k)));
    let all: Vec<Triangle> = rows.filter(|triangle| crate::surfaces::normal_of(triangle) != [0.0; 3]).collect();
    if all.is_empty() {
        table.error("triangles", "none of them has an area", report);
        return None;
    }
    Some(all)
}

/// m  the middle of a triangle and of what is left at its corners
fn places(triangle: &Triangle) -> [[f64; 3]; 4] {
    let middle = middle(triangle);
    let at = |corner: usize| [0, 1, 2].map(|axis| 0.5 * (middle[axis] + triangle[corner][axis]));
    [middle, at(0), at(1), at(2)]
}

/// m  where the corners are in the mean
pub(super) fn middle([a, b, c]: &Triangle) -> [f64; 3] {
    [0, 1, 2].map(|axis| (a[axis] + b[axis] + c[axis]) / 3.0)
}

/// Whether triangles hang together by their edges and turn alike.
fn in_one_piece(all: &[Triangle]) -> Result<(), String> {
    let mut piece: Vec<usize> = (0..all.len()).collect();
    fn root(piece: &mut [usize], mut of: usize) -> usize {
        while piece[of] != of {
            piece[of] = piece[piece[of]];
            of = piece[of];
        }
        of
    }
    for sides in edges_of(all).values() {
        let [from, to] = sides[0].ends;
        if sides.len() > 2 {
            return Err(format!("{} triangles meet at the edge from {from:?} to {to:?}; allowed: two", sides.len()));
        }
        if let [one, other] = &sides[..] {
            if one.upwards == other.upwards {
                return Err(format!(
                    "the triangles at the edge from {from:?} to {to:?} do not turn alike; make normals consistent with a \
                     mesh tool"
                ));
            }
            let [one, other] = [one.triangle, other.triangle].map(|of| root(&mut piece, of));
            piece[one] = other;
        }
    }
    match (0..all.len()).filter(|of| piece[*of] == *of).count() {
        1 => Ok(()),
        pieces => Err(format!(
            "it is in {pieces} pieces that have no edge in common: weld its corners with a mesh tool, or give each a \
             traction of its own"
        )),
    }
}

/// A sphere's triangles, as long as this at most, m, turned outwards, with the sphere's area and its symmetries: an
/// octant has its own.
fn sphere_of(center: [f64; 3], radius: f64, longest: f64) -> Vec<Triangle> {
    let parts = (STRETCHED * radius / longest).ceil() as usize;
    let corner = |sign: [f64; 3], i: usize, j: usize| {
        let flat = [i, j, parts - i - j].map(|part| part as f64);
        let length = flat.iter().map(|part| part * part).sum::<f64>().sqrt();
        [0, 1, 2].map(|axis| sign[axis] * flat[axis] / length)
    };
    let mut unit: Vec<Triangle> = Vec::new();
    for octant in 0..8_u8 {
        let sign = [0, 1, 2].map(|axis| if octant >> axis & 1 == 0 { 1.0 } else { -1.0 });
        let outwards = sign.iter().product::<f64>() > 0.0;
        for i in 0..parts {
            for j in 0..parts - i {
                let up = [(i + 1, j), (i, j + 1), (i, j)];
                let down = (i + j + 2 <= parts).then_some([(i + 1, j), (i + 1, j + 1), (i, j + 1)]);
                for mut places in std::iter::once(up).chain(down) {
                    if !outwards {
                        places.swap(1, 2);
                    }
                    unit.push(places.map(|(i, j)| corner(sign, i, j)));
                }
            }
        }
    }
    let area = |[a, b, c]: &Triangle| {
        let [p, q] = [b, c].map(|end| [0, 1, 2].map(|axis| end[axis] - a[axis]));
        0.5 * [0, 1, 2]
            .map(|k| p[(k + 1) % 3] * q[(k + 2) % 3] - p[(k + 2) % 3] * q[(k + 1) % 3])
            .map(|n| n * n)
            .iter()
            .sum::<f64>()
            .sqrt()
    };
    let scale = radius * (2.0 * std::f64::consts::TAU / unit.iter().map(area).sum::<f64>()).sqrt();
    unit.iter().map(|triangle| triangle.map(|at| [0, 1, 2].map(|axis| center[axis] + scale * at[axis]))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sphere_of_triangles_has_its_area_is_closed_and_turns_outwards() {
        let all = sphere_of([1.0, 2.0, 3.0], 0.5, 0.1);
        assert!(in_one_piece(&all).is_ok() && edges_of(&all).values().all(|sides| sides.len() == 2));
        let normals = all.iter().map(|triangle| {
            let (at, normal) = (middle(triangle), crate::surfaces::normal_of(triangle));
            (at[0] - 1.0) * normal[0] + (at[1] - 2.0) * normal[1] + (at[2] - 3.0) * normal[2]
        });
        assert!(normals.into_iter().all(|outwards| (outwards - 0.5).abs() < 5e-3));
        let longest = all.iter().flat_map(|[a, b, c]| [(a, b), (b, c), (c, a)]);
        let longest =
            longest.map(|(a, b)| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()).fold(0.0, f64::max);
        assert!(longest < 0.1, "{longest}");
    }

    #[test]
    fn pieces_and_sides_of_triangles_are_told() {
        let [o, x, y, z] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert_eq!(in_one_piece(&[[o, x, y], [o, y, z]]), Ok(()));
        let says = |all: &[Triangle]| in_one_piece(all).unwrap_err();
        assert!(says(&[[o, x, y], [o, z, y]]).contains("do not turn alike"));
        assert!(says(&[[o, x, y], [o, y, z], [y, o, [1.0; 3]]]).contains("3 triangles meet"));
        assert!(says(&[[o, x, y], [[5.0; 3], z, [6.0, 5.0, 5.0]]]).contains("2 pieces"));
    }
}
