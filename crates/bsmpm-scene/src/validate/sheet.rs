//! Divides loaded curved surfaces in 3-D into small triangles.

use super::place::{at_volume, beyond};
use super::site::AroundStrip;
use crate::case::{Body, Triangle};
use crate::grid::GridSpec;
use crate::report::Report;
use crate::schema::{SiteKey, SurfaceTable};
use crate::surfaces::{area_of, normal_of};
use bsmpm::tensor::Vector;
use bsmpm_shapes::edges_of;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Longest edge of a sphere's triangles in parts of what an octant's arcs are divided by: corners at equal parts of the
/// flat octant lie farthest apart in its middle.
const STRETCHED: f64 = 2.5;
/// Least of these parts: where the grid cuts a sphere beside its middle seven were off by 2 % of the rim's area.
const FEWEST: usize = 16;
/// Largest area in squares of the spacing of points: a million pieces.
const LARGEST: f64 = 2e5;

/// The surface that a traction's `surface` or `sphere` gives, in pieces as small as the spacing of points: inside the
/// grid, at bodies everywhere, in one piece, turned alike.
pub(super) fn pieces(key: SiteKey<'_>, around: AroundStrip<'_>, report: &mut Report<'_>) -> Option<Arc<[Triangle]>> {
    let grid = around.grid.filter(|grid| grid.dims() == 3)?;
    let bodies = around.bodies?;
    let spacing = grid.shortest() / bodies.iter().map(|body| body.points_per_cell).max()? as f64;
    let found = match key {
        SiteKey::Sphere(key) => {
            let (center, radius) = key.value()?.sphere()?;
            let sound = countable(2.0 * TAU * radius * radius, spacing);
            let pieces = sound.map(|()| sphere_of(center, radius, spacing).into_iter());
            pieces.map(|pieces| pieces.flat_map(|of| inside(grid, of)).collect())
        }
        SiteKey::Surface(key) => {
            let all = given(key.value()?, report)?;
            let wrong = all.iter().flatten().find_map(|corner| beyond(grid, *corner));
            let wrong = wrong.map_or(Ok(()), |outside| Err(outside.into()));
            let sound = wrong.and_then(|()| in_one_piece(&all));
            let sound = sound.and_then(|()| countable(all.iter().map(area).sum(), spacing));
            sound.map(|()| all.iter().flat_map(|of| split(*of, spacing)).collect::<Vec<_>>())
        }
        _ => return None,
    };
    let found = found.and_then(|all| at_bodies(all, bodies, grid));
    found
        .map_err(|message| key.place().consequence(message, &["body"], report))
        .ok()
        .map(Arc::from)
}

/// The pieces of a surface if there are some, and all of them at bodies.
fn at_bodies(all: Vec<Triangle>, bodies: &[Body], grid: &GridSpec) -> Result<Vec<Triangle>, String> {
    match all.iter().map(middle).find(|at| !at_volume(bodies, grid, *at)) {
        Some(at) => Err(format!(
            "E0401: at the start of the analysis no body exists at the point {at:.3?} m of the loaded surface. Move \
             the loaded surface to the surface of a body."
        )),
        None if all.is_empty() => Err(
            "E0201: no part of the sphere is inside the grid. Move the sphere into the grid, or enlarge the grid."
                .into(),
        ),
        None => Ok(all),
    }
}

/// Whether an area, m², is not too large for the spacing of points, m.
fn countable(area: f64, spacing: f64) -> Result<(), String> {
    let squares = area / spacing.powi(2);
    if squares > LARGEST {
        return Err(format!(
            "E0216: the loaded surface is so large that it needs about {squares:.0} loaded points (at most \
             {LARGEST}). Use larger cells, or reduce points_per_cell."
        ));
    }
    Ok(())
}

/// The triangles of a table, m, without those that are a line or a place.
fn given(table: &SurfaceTable, report: &mut Report<'_>) -> Option<Vec<Triangle>> {
    let scale = table.scale.get()?;
    let rows = table
        .triangles
        .value()?
        .iter()
        .map(|row| [0, 1, 2].map(|k| [0, 1, 2].map(|axis| scale * row.numbers[3 * k + axis] + 0.0)));
    let all: Vec<Triangle> = rows.filter(|triangle| normal_of(triangle) != [0.0; 3]).collect();
    if all.is_empty() {
        table.triangles.error(
            "E0227: all triangles have zero area. Check the file and `scale`.",
            report,
        );
        return None;
    }
    Some(all)
}

/// m  where the corners are in the mean
pub(super) fn middle([a, b, c]: &Triangle) -> [f64; 3] {
    [0, 1, 2].map(|axis| (a[axis] + b[axis] + c[axis]) / 3.0)
}

/// m²
fn area(triangle: &Triangle) -> f64 {
    area_of(triangle).norm()
}

/// A triangle in pieces without a longer edge than this, m, that turn as it does; those of triangles that have an edge
/// in common have theirs in common.
fn split(triangle: Triangle, longest: f64) -> Vec<Triangle> {
    let mut whole = vec![triangle];
    let mut pieces = Vec::new();
    while let Some([a, b, c]) = whole.pop() {
        let turned = [[b, c, a], [c, a, b]].into_iter();
        let [a, b, c] = turned.fold([a, b, c], |most, edge| {
            if edge_length(&edge) > edge_length(&most) {
                edge
            } else {
                most
            }
        });
        if edge_length(&[a, b, c]) > longest {
            let middle = [0, 1, 2].map(|axis| 0.5 * (a[axis] + b[axis]));
            whole.extend([[a, middle, c], [middle, b, c]]);
        } else {
            pieces.push([a, b, c]);
        }
    }
    pieces
}

/// Length of the edge between the first two corners, m.
fn edge_length(triangle: &Triangle) -> f64 {
    (Vector::<3>::from(triangle[1]) - Vector::from(triangle[0])).norm()
}

/// What of a triangle is inside the grid, in triangles that turn as it does.
fn inside(grid: &GridSpec, triangle: Triangle) -> Vec<Triangle> {
    let mut corners = triangle.to_vec();
    for (axis, sign, face) in
        (0..3).flat_map(|axis| [(axis, 1.0, grid.lower()[axis]), (axis, -1.0, grid.upper()[axis])])
    {
        let mut kept = Vec::new();
        for (from, to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            let before = sign * (from[axis] - face);
            let after = sign * (to[axis] - face);
            if before >= 0.0 {
                kept.push(*from);
            }
            if (before < 0.0) != (after < 0.0) && before != 0.0 && after != 0.0 {
                let mut at = [0, 1, 2].map(|k| from[k] + (to[k] - from[k]) * before / (before - after));
                at[axis] = face;
                kept.push(at);
            }
        }
        corners = kept;
    }
    (2..corners.len())
        .map(|k| [corners[0], corners[k - 1], corners[k]])
        .filter(|of| area(of) > 0.0)
        .collect()
}

/// Whether triangles hang together by their edges and turn alike.
fn in_one_piece(all: &[Triangle]) -> Result<(), String> {
    let mut piece: Vec<usize> = (0..all.len()).collect();
    fn draft(piece: &mut [usize], mut of: usize) -> usize {
        while piece[of] != of {
            piece[of] = piece[piece[of]];
            of = piece[of];
        }
        of
    }
    for sides in edges_of(all).values() {
        let [from, to] = sides[0].ends;
        if sides.len() > 2 {
            return Err(format!(
                "E0227: {} triangles share the edge from {from:?} to {to:?} m, but at most 2 are allowed. Repair the \
                 surface with a mesh tool.",
                sides.len()
            ));
        }
        if let [one, other] = &sides[..] {
            if one.upwards == other.upwards {
                return Err(format!(
                    "E0227: the two triangles at the edge from {from:?} to {to:?} m have normals on opposite \
                     sides of the surface. Make the normals consistent with a mesh tool."
                ));
            }
            let [one, other] = [one.triangle, other.triangle].map(|of| draft(&mut piece, of));
            piece[one] = other;
        }
    }
    match (0..all.len()).filter(|of| piece[*of] == *of).count() {
        1 => Ok(()),
        pieces => Err(format!(
            "E0227: the loaded surface consists of {pieces} separate pieces, but must be in one piece. Weld the \
             vertices of the pieces with a mesh tool, or give each piece its own [[traction]]."
        )),
    }
}

/// A sphere's triangles, about as long as this at most, m, turned outwards, with the sphere's area and its symmetries:
/// an octant has its own.
fn sphere_of(center: [f64; 3], radius: f64, longest: f64) -> Vec<Triangle> {
    let parts = ((STRETCHED * radius / longest).ceil() as usize).max(FEWEST);
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
                    unit.push(places.map(|(i, j)| on_octant(sign, [i, j, parts - i - j])));
                }
            }
        }
    }
    let scale = radius * (2.0 * TAU / unit.iter().map(area).sum::<f64>()).sqrt();
    unit.iter()
        .map(|triangle| triangle.map(|at| [0, 1, 2].map(|axis| center[axis] + scale * at[axis])))
        .collect()
}

/// A place on the unit sphere in an octant, given by its signs: above the place of the flat octant with these parts.
fn on_octant(sign: [f64; 3], parts: [usize; 3]) -> [f64; 3] {
    let flat = parts.map(|part| part as f64);
    let length = flat.iter().map(|part| part * part).sum::<f64>().sqrt();
    [0, 1, 2].map(|axis| sign[axis] * flat[axis] / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sphere_of_triangles_has_its_area_is_closed_and_turns_outwards() {
        let all = sphere_of([1.0, 2.0, 3.0], 0.5, 0.1);
        assert!(in_one_piece(&all).is_ok() && edges_of(&all).values().all(|sides| sides.len() == 2));
        let normals = all.iter().map(|triangle| {
            let at = middle(triangle);
            let normal = normal_of(triangle);
            (at[0] - 1.0) * normal[0] + (at[1] - 2.0) * normal[1] + (at[2] - 3.0) * normal[2]
        });
        assert!(normals.into_iter().all(|outwards| (outwards - 0.5).abs() < 5e-3));
        let longest = all.iter().flat_map(|[a, b, c]| [(a, b), (b, c), (c, a)]);
        let longest = longest
            .map(|(a, b)| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt())
            .fold(0.0, f64::max);
        assert!(longest < 0.1, "{longest}");
    }

    /// In a quarter of the room, which cuts it beside its middle: what it presses with is the area of its rim.
    #[test]
    fn a_sphere_that_the_grid_cuts_has_the_area_of_its_rim() {
        let axes = [0; 3].map(|_| bsmpm_shapes::GridAxis::Uniform {
            lower: 0.0,
            cell: 0.1,
            cells: 20,
        });
        let grid = GridSpec {
            axes: axes.to_vec(),
            order: 2,
            lines: Default::default(),
        };
        let center = [0.03, -0.02, 1.0];
        let radius = 0.5_f64;
        let all = sphere_of(center, radius, 0.05)
            .into_iter()
            .flat_map(|of| inside(&grid, of));
        let all: Vec<Triangle> = all.collect();
        assert!(all.iter().flatten().all(|at| at[0] >= 0.0 && at[1] >= 0.0));
        let along = |axis: usize| -> f64 { all.iter().map(|of| area(of) * normal_of(of)[axis]).sum() };
        // Of the disc on a face what lies beyond the other one, d from its middle.
        let rim = |off: f64, d: f64| {
            let square: f64 = radius * radius - off * off;
            square * (d / square.sqrt()).acos() - d * (square - d * d).sqrt()
        };
        for (axis, exact) in [rim(0.03, 0.02), rim(0.02, -0.03), 0.0].into_iter().enumerate() {
            assert!(
                (along(axis) - exact).abs() < 2e-4,
                "{axis}: {} for {exact}",
                along(axis)
            );
        }
    }

    #[test]
    fn pieces_of_a_triangle_are_small_and_have_its_area() {
        let triangle = [[0.0, 0.0, 0.0], [3.0, 0.1, 0.0], [0.2, 1.0, 1.0]];
        let all = split(triangle, 0.25);
        let sum: f64 = all.iter().map(area).sum();
        assert!((sum / area(&triangle) - 1.0).abs() < 1e-13 && in_one_piece(&all).is_ok());
        let length = |of: &Triangle, k: usize| (Vector::<3>::from(of[k]) - Vector::from(of[(k + 1) % 3])).norm();
        assert!(all.iter().all(|of| (0..3).all(|k| length(of, k) <= 0.25)));
    }

    #[test]
    fn pieces_and_sides_of_triangles_are_reported() {
        let [o, x, y, z] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert_eq!(in_one_piece(&[[o, x, y], [o, y, z]]), Ok(()));
        let says = |all: &[Triangle]| in_one_piece(all).unwrap_err();
        assert!(says(&[[o, x, y], [o, z, y]]).contains("sides of the surface"));
        assert!(says(&[[o, x, y], [o, y, z], [y, o, [1.0; 3]]]).contains("3 triangles share the edge"));
        assert!(says(&[[o, x, y], [[5.0; 3], z, [6.0, 5.0, 5.0]]]).contains("2 separate pieces"));
    }
}
