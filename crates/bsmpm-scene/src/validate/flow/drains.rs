//! Validates drains and inflows.

use super::is_permeable;
use crate::case::{ActiveLoads, Body, Drain, DrainSite, Face, Inflow, NamedMaterial, Plate, Site, Stage, Support};
use crate::grid::GridSpec;
use crate::nearest::hint;
use crate::record::{Field, KeyPlace, ListRow};
use crate::report::Report;
use crate::schema::{Draft, DrainTable, HistoryTable, InflowTable, SiteKey};
use crate::validate::course::increasing;
use crate::validate::load::circle;
use crate::validate::place;
use crate::validate::site::{AroundStrip, places, plate, segment};
use crate::words::Side;
use bsmpm::field::pore_water::flow::{Course, Given, Soil};
use bsmpm_shapes::{Region, skin};

/// Parts of a cell by which a body may be off a face that it lies at.
const AT: f64 = 1e-9;
/// Keys without which it is not known where permeable soil is.
const PERMEABLE: &[&str] = &["body", "material"];

/// The bodies that are there when something begins to act: at the start, or once a stage has applied it.
pub(super) fn there(what: ActiveLoads, stages: &[Stage], bodies: &[Body]) -> Vec<Body> {
    let first = stages.iter().position(|stage| stage.switches(what) != [false; 2]);
    let applied = first.filter(|&first| stages[first].switches(what)[1]);
    let begun = &stages[..applied.map_or(0, |first| first + 1)];
    let there = (0..bodies.len()).filter(|number| {
        let comes = adds(begun, *number) || !adds(stages, *number);
        comes && !begun.iter().any(|stage| stage.remove.contains(number))
    });
    there.map(|number| bodies[number].clone()).collect()
}

/// Whether one of the stages adds a body.
fn adds(stages: &[Stage], body: usize) -> bool {
    stages.iter().any(|stage| stage.add.contains(&body))
}

/// What a drain or an inflow lies at.
#[derive(Clone, Copy)]
pub(super) struct Ground<'a> {
    pub(super) soils: &'a [Option<Soil<3>>],
    pub(super) materials: &'a [NamedMaterial],
    pub(super) around: AroundStrip<'a>,
    pub(super) there: &'a [Body], // when it begins to act
}

impl Ground<'_> {
    /// Bodies of soil that lets water through.
    fn permeable(&self) -> Vec<Body> {
        let bodies = self.there.iter();
        bodies
            .filter(|body| is_permeable(self.soils, body.material))
            .cloned()
            .collect()
    }

    /// A segment, or of a solid a plate, of the surface of bodies that let water through.
    fn site(&self, key: SiteKey<'_>, report: &mut Report<'_>) -> Option<Site> {
        let grid = self.around.grid?;
        let site = match key {
            SiteKey::Plate(key) => Site::Plate(plate(key, grid, report)?),
            SiteKey::Segment(from, to) => {
                let [from, to] = segment([from, to], self.around, report)?;
                Site::Segment { from, to }
            }
            _ => return None,
        };
        let mut places = places(site, grid);
        places.retain(|at| place::is_beyond(grid, *at).is_none());
        self.lies_at(key.place(), places.into_iter(), report)?;
        Some(site)
    }

    /// Whether bodies that let water through are at all of these places, which a key gives.
    fn lies_at(
        &self,
        key: &KeyPlace,
        mut places: impl Iterator<Item = [f64; 3]>,
        report: &mut Report<'_>,
    ) -> Option<()> {
        let grid = self.around.grid?;
        let permeable = self.permeable();
        if let Some(at) = places.find(|at| !place::is_at(&permeable, grid, *at)) {
            let under = self
                .there
                .iter()
                .find(|body| place::is_at(std::slice::from_ref(*body), grid, at));
            let comes = place::is_at(self.around.bodies.unwrap_or_default(), grid, at);
            let at = &at[..grid.dims()];
            let message = match under {
                Some(body) => format!(
                    "E0510: the soil at {at:.3?} m consists of material `{}`, which has no pore-water flow. Give \
                     this material `drainage = \"coupled\"`, `porosity` and `permeability`.",
                    self.materials[body.material].name
                ),
                None if comes => format!(
                    "E0511: no body exists at {at:.3?} m when this drain or inflow begins to act. Give the drain or \
                     inflow a `name`, and list the name in `activate` of the stage that adds the body."
                ),
                None => format!(
                    "E0401: no soil lies at {at:.3?} m or within half a spacing of material points of it, so no water \
                     can pass there. Move the drain or inflow to the surface of the soil."
                ),
            };
            key.consequence(message, PERMEABLE, report);
            return None;
        }
        Some(())
    }
}

/// Names of drains, which are unique.
pub(super) fn named(draft: &Draft, report: &mut Report<'_>) {
    let drains = draft.drain.items();
    for (number, record) in drains.iter().enumerate() {
        let Some(name) = record.name.text() else { continue };
        if drains[..number].iter().any(|other| other.name.text() == Some(name)) {
            let message = format!(
                "E0421: another drain is also called `{name}`, so histories and stages cannot tell which one is \
                 meant. Give each drain its own `name`."
            );
            record.name.error(message, report);
        }
    }
}

pub(super) fn drain(record: &DrainTable, ground: Ground<'_>, report: &mut Report<'_>) -> Option<Drain> {
    let given = given(record, report);
    let site = if record.face.is_given() {
        DrainSite::Face(face(&record.face, ground, report)?)
    } else if record.surface.is_given() {
        if !record.surface.get()? {
            let message = "E0514: with `surface = false` the drain has no location. Set `surface = true`, or replace \
                 `surface` by `face`, by `circle`, or by `from` and `to`.";
            record.surface.error(message, report);
            return None;
        }
        // What is wrong with it in space is reported there.
        ground.around.grid.filter(|grid| grid.dims() == 2)?;
        DrainSite::Lines(surface(&record.surface, ground, report)?)
    } else if record.circle.is_given() {
        let (center, radius, places) = circle(&record.circle, ground.around, report)?;
        ground.lies_at(&record.circle, places.into_iter().map(|[x, y]| [x, y, 0.0]), report)?;
        DrainSite::Circle { center, radius }
    } else {
        match ground.site(record.site(), report)? {
            Site::Plate(plate) => DrainSite::Plate(plate),
            Site::Segment { from, to } => DrainSite::Lines(vec![[from, to]]),
            Site::Face(_) => return None,
        }
    };
    Some(Drain {
        name: record.name.text().map(str::to_owned),
        site,
        given: given?,
    })
}

/// The pressure at a drain.
fn given(record: &DrainTable, report: &mut Report<'_>) -> Option<Given> {
    if record.head_path.is_given() {
        return Some(Given::Head(course(&record.head_path, report)?));
    }
    if record.pressure_path.is_given() {
        return Some(Given::Pressure(course(&record.pressure_path, report)?));
    }
    if record.head.is_given() {
        return constant(&record.head).map(Given::Head);
    }
    if record.pressure.is_given() {
        return constant(&record.pressure).map(Given::Pressure);
    }
    if record.seepage.is_given() {
        if !record.seepage.get()? {
            let message = "E0514: `seepage = false` has no effect. Set `seepage = true` for a seepage face, or remove \
                 `seepage`.";
            record.seepage.error(message, report);
        }
        if record.face.is_given() {
            let message = "E0515: at a seepage face water can only leave the soil, but through a face of the grid \
                 water could also enter. Replace `face` by `from` and `to` on the surface of the body.";
            record.seepage.error(message, report);
        }
        return Some(Given::Seepage);
    }
    Some(Given::StillWater)
}

/// Rows of a number that follows time.
fn course(key: &Field<Vec<ListRow>>, report: &mut Report<'_>) -> Option<Course> {
    let rows = increasing(key, report)?;
    Some(Course(rows.map(|row| (row[0], row[1])).collect()))
}

/// A number that does not change in time.
fn constant(key: &Field<f64>) -> Option<Course> {
    Some(Course(vec![(0.0, key.get()?)]))
}

/// A face of the grid at which a body of permeable soil lies.
fn face(key: &Field<Side>, ground: Ground<'_>, report: &mut Report<'_>) -> Option<Face> {
    let grid = ground.around.grid?;
    let face = place::face(key, grid, report)?;
    let slack = AT * grid.axes[face.axis].shortest();
    let at = [grid.lower(), grid.upper()][usize::from(face.upper)][face.axis];
    let side = usize::from(face.upper);
    if !ground
        .permeable()
        .iter()
        .any(|body| (body.region.corners()[side][face.axis] - at).abs() <= slack)
    {
        let message = format!(
            "E0516: no body with pore-water flow touches this face of the grid ({} = {at} m). Choose another face, \
             or give the surface of the soil by `from` and `to` (3-D: `rectangle`).",
            ["x", "y", "z"][face.axis]
        );
        key.consequence(message, PERMEABLE, report);
        return None;
    }
    Some(face)
}

/// The surface of bodies of permeable soil, but for what lies at faces of the grid that hold it.
fn surface(key: &KeyPlace, ground: Ground<'_>, report: &mut Report<'_>) -> Option<Vec<[[f64; 2]; 2]>> {
    let grid = ground.around.grid?;
    let bodies = ground.there;
    let boundary = ground.around.boundary?;
    let all: Vec<&Region> = bodies.iter().map(|body| &body.region).collect();
    let lower = grid.lower();
    let pieces = bodies
        .iter()
        .filter(|body| is_permeable(ground.soils, body.material))
        .flat_map(|body| skin(&body.region, &all, &grid.axes));
    let free = pieces.filter(|piece| !is_held(piece, grid, &boundary));
    let pieces: Vec<[[f64; 2]; 2]> = free
        .map(|piece| piece.map(|at| [0, 1].map(|axis| lower[axis] + at[axis])))
        .collect();
    if pieces.is_empty() {
        let message = "E0517: `surface = true` needs a free surface, but the soil with pore-water flow has only edges \
             at restrained boundaries or other bodies. Replace `surface` by `face`, or by `from` and `to`.";
        key.consequence(message, PERMEABLE, report);
        return None;
    }
    let long: f64 = pieces.iter().map(|[p, q]| (q[0] - p[0]).hypot(q[1] - p[1])).sum();
    let reason = "free surface of permeable soil when the drain begins to act; surface that forms later is not drained";
    report.note(key.path(), format!("{long:.6} m in {} pieces", pieces.len()), reason);
    Some(pieces)
}

/// Whether a piece of a surface, in coordinates from the grid's lower corner (m), lies at a face that holds it.
fn is_held(piece: &[[f64; 2]; 2], grid: &GridSpec, boundary: &[[Support; 2]; 3]) -> bool {
    for axis in 0..2 {
        let slack = AT * grid.axes[axis].shortest();
        for (support, at) in boundary[axis].iter().zip([0.0, grid.axes[axis].length()]) {
            let lies = piece.iter().all(|end| (end[axis] - at).abs() <= slack);
            if lies && *support != Support::Free {
                return true;
            }
        }
    }
    false
}

pub(super) fn inflow(record: &InflowTable, ground: Ground<'_>, report: &mut Report<'_>) -> Option<Inflow> {
    let rate = match record.rate_path.is_given() {
        true => course(&record.rate_path, report),
        false => constant(&record.rate),
    };
    let runs_off = record.runoff.get()?;
    let site = match record.face.is_given() {
        true => along_face(&record.face, ground, report)?,
        false => ground.site(record.site(), report)?,
    };
    Some(Inflow {
        site,
        rate: rate?,
        runs_off,
    })
}

/// What of a face of the grid lies between the ends of the permeable bodies there.
fn along_face(key: &Field<Side>, ground: Ground<'_>, report: &mut Report<'_>) -> Option<Site> {
    let grid = ground.around.grid?;
    let face = face(key, ground, report)?;
    let slack = AT * grid.axes[face.axis].shortest();
    let at = if face.upper { grid.upper() } else { grid.lower() }[face.axis];
    let there = ground.permeable().into_iter().map(|body| body.region.corners());
    let there = there.filter(|corners| (corners[usize::from(face.upper)][face.axis] - at).abs() <= slack);
    let ends = there.reduce(|[lower, upper], [a, b]| {
        [
            [0, 1, 2].map(|axis| lower[axis].min(a[axis])),
            [0, 1, 2].map(|axis| upper[axis].max(b[axis])),
        ]
    });
    let [mut lower, mut upper] = ends?;
    (lower[face.axis], upper[face.axis]) = (at, at);
    Some(match grid.dims() {
        2 => Site::Segment {
            from: [lower[0], lower[1]],
            to: [upper[0], upper[1]],
        },
        _ => Site::Plate(Plate {
            lower,
            upper,
            round: false,
        }),
    })
}

/// The number of the drain that a history names, in the order of the file, by its name or its face; the outer option is
/// `None` after an error.
pub(in crate::validate) fn drain_of(
    record: &HistoryTable,
    draft: &Draft,
    report: &mut Report<'_>,
) -> Option<Option<usize>> {
    let drains = draft.drain.items();
    let (key, found): (&KeyPlace, _) = if record.drain.is_given() {
        let name = record.drain.text()?;
        let found = drains.iter().position(|drain| drain.name.text() == Some(name));
        (&record.drain, found)
    } else if record.face.is_given() {
        let side = record.face.get()?;
        let found = drains.iter().position(|drain| drain.face.get() == Some(side));
        (&record.face, found)
    } else {
        return Some(None);
    };
    if found.is_none() {
        let names = drains.iter().filter_map(|drain| drain.name.text());
        let near = record.drain.text().map(|name| hint(name, names)).unwrap_or_default();
        let end = if near.is_empty() { "." } else { &near };
        let message = format!(
            "E0518: no [[drain]] of the case has this name or face. Correct the name or face, or \
                               add a drain{end}"
        );
        key.consequence(message, &["drain"], report);
        return None;
    }
    Some(found)
}
