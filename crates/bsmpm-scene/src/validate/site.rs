//! Validates positions of footings, plates and loads.

use super::place::{along, beyond, face, flat, is_at, over};
use crate::case::{Body, Plate, Site, Support};
use crate::grid::GridSpec;
use crate::record::{Field, KeyPlace};
use crate::report::Report;
use crate::schema::{DiscTable, PlateKey, SiteKey};

/// What the rest of the case says to a strip.
#[derive(Clone, Copy)]
pub(super) struct AroundStrip<'a> {
    pub(super) grid: Option<&'a GridSpec>,
    pub(super) bodies: Option<&'a [Body]>,
    pub(super) boundary: Option<[[Support; 2]; 3]>,
    /// of the strength reduction
    pub(super) factor: Option<f64>,
    pub(super) end: Option<f64>,
    /// of steps that may pass over rows
    pub(super) dt: Option<f64>,
}

/// A segment's ends inside the grid.
pub(super) fn segment(
    [from_key, to_key]: [&Field<[f64; 2]>; 2],
    around: AroundStrip<'_>,
    report: &mut Report<'_>,
) -> Option<[[f64; 2]; 2]> {
    let from = from_key.get()?;
    let to = to_key.get()?;
    if from == to {
        to_key.error(
            "E0232: `from` and `to` are the same place, so the length is zero. Move one of the two ends.",
            report,
        );
        return None;
    }
    let grid = around.grid?;
    let mut inside = true;
    for (key, at) in [(from_key, from), (to_key, to)] {
        if let Some(message) = beyond(grid, at) {
            key.error(message, report);
            inside = false;
        }
    }
    inside.then_some([from, to])
}

/// A strip starts at a body, if only with a part of it.
fn starts_at_body(key: &KeyPlace, site: Site, around: AroundStrip<'_>, report: &mut Report<'_>) {
    let Some(grid) = around.grid else { return };
    let Some(bodies) = around.bodies else { return };
    if !places(site, grid).into_iter().any(|at| is_at(bodies, grid, at)) {
        let [from, to] = corners(site, grid).map(|at| at[..grid.dims()].to_vec());
        let message = format!(
            "E0401: no body lies between {from:.3?} and {to:.3?} m at the start of the analysis, so this footing or \
             motion would not touch any soil. Move the footing or motion to the surface of a body."
        );
        key.consequence(message, &["body"], report);
    }
}

/// m  two opposite corners of what is held
pub(super) fn corners(site: Site, grid: &GridSpec) -> [[f64; 3]; 2] {
    match site {
        Site::Segment { from, to } => [from, to].map(flat),
        Site::Plate(plate) => [plate.lower, plate.upper],
        Site::Face(face) => {
            let mut lower = grid.lower();
            let mut upper = grid.upper();
            let at = if face.upper { upper[face.axis] } else { lower[face.axis] };
            lower[face.axis] = at;
            upper[face.axis] = at;
            [lower, upper]
        }
    }
}

/// Places of what is held, in the middles of equal pieces.
pub(super) fn places(site: Site, grid: &GridSpec) -> Vec<[f64; 3]> {
    let ends = corners(site, grid);
    if grid.dims() == 2 {
        return along(ends.map(|[x, y, _]| [x, y])).map(flat).collect();
    }
    over(ends)
        .filter(|at| !matches!(site, Site::Plate(plate) if !plate.covers(*at)))
        .collect()
}

/// Unit normal of what is held.
pub(crate) fn normal_of(site: Site) -> [f64; 3] {
    let axis = match site {
        Site::Segment { from, to } => return flat(normal(from, to)),
        Site::Plate(plate) => plate.normal(),
        Site::Face(face) => face.axis,
    };
    std::array::from_fn(|k| f64::from(u8::from(k == axis)))
}

/// A plate inside the grid; of a disc a part of it.
pub(super) fn plate(key: PlateKey<'_>, grid: &GridSpec, report: &mut Report<'_>) -> Option<Plate> {
    let key = match key {
        PlateKey::Disc(key) => return disc(key, grid, report),
        PlateKey::Rectangle(key) => key,
    };
    let [lower, upper] = key.value()?.corners()?;
    let flat = (0..3).filter(|&axis| lower[axis] == upper[axis]).count();
    if flat != 1 || (0..3).any(|axis| lower[axis] > upper[axis]) {
        let message = format!(
            "E0234: the corners {lower:?} and {upper:?} m do not form a rectangle. Make the corners equal along one \
             axis, and `upper` larger than `lower` along the other two."
        );
        key.error(message, report);
        return None;
    }
    if let Some(message) = [lower, upper].into_iter().find_map(|corner| beyond(grid, corner)) {
        key.error(message, report);
        return None;
    }
    Some(Plate {
        lower,
        upper,
        round: false,
    })
}

/// A disc, a part of which is inside the grid.
fn disc(key: &Field<DiscTable>, grid: &GridSpec, report: &mut Report<'_>) -> Option<Plate> {
    let disc = key.value()?;
    let center = disc.centre.vector()?;
    let radius = disc.radius.get()?;
    let normal = disc.normal.get()? as usize;
    let [lower, upper] =
        [-1.0, 1.0].map(|side| std::array::from_fn(|k| center[k] + if k == normal { 0.0 } else { side * radius }));
    let plate = Plate {
        lower,
        upper,
        round: true,
    };
    let bounds = [grid.lower(), grid.upper()];
    let is_inside = (0..3).all(|axis| bounds[0][axis] <= upper[axis] && lower[axis] <= bounds[1][axis]);
    if !is_inside || plate.area(bounds) == 0.0 {
        key.error(
            "E0201: no part of the disc is inside the grid. Move the disc into the grid, or enlarge the grid.",
            report,
        );
        return None;
    }
    Some(plate)
}

/// Where a footing or a prescribed motion holds.
pub(super) fn site(key: SiteKey<'_>, around: AroundStrip<'_>, report: &mut Report<'_>) -> Option<Site> {
    let site = match key {
        SiteKey::Plate(key) => Site::Plate(plate(key, around.grid?, report)?),
        SiteKey::Face(key) => {
            let side = key.get()?;
            let face = face(key, around.grid?, report)?;
            let support = around.boundary?[face.axis][usize::from(face.upper)];
            if support != Support::Free {
                let message = format!(
                    "E0236: this table and [boundary] both prescribe the motion of the face \"{side}\". Set \
                     boundary.{side} = \"free\"."
                );
                key.error(message, report);
                return None;
            }
            Site::Face(face)
        }
        SiteKey::Segment(from, to) => {
            let [from, to] = segment([from, to], around, report)?;
            Site::Segment { from, to }
        }
        _ => return None,
    };
    starts_at_body(key.place(), site, around, report);
    Some(site)
}

/// Unit normal of a segment.
pub(super) fn normal(from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
    let along = [to[0] - from[0], to[1] - from[1]];
    let length = along[0].hypot(along[1]);
    [-along[1] / length, along[0] / length]
}
