//! Validates drains and inflows.

use super::is_permeable;
use crate::case::{ActiveLoads, Body, Drain, DrainSite, Face, Inflow, NamedMaterial, Plate, Site, Stage, Support};
use crate::grid::GridSpec;
use crate::nearest::hint;
use crate::record::Record;
use crate::report::Report;
use crate::schema::Draft;
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
    fn site(&self, record: &Record, report: &mut Report<'_>) -> Option<Site> {
        let grid = self.around.grid?;
        let (key, site) = match ["rectangle", "disc"].into_iter().find(|key| record.gives(key)) {
            Some(key) => (key, Site::Plate(plate(record, grid, report)?)),
            None => {
                let [from, to] = segment(record, self.around, report)?;
                ("from", Site::Segment { from, to })
            }
        };
        let mut places = places(site, grid);
        places.retain(|at| place::is_beyond(grid, *at).is_none());
        self.lies_at(record, key, places.into_iter(), report)?;
        Some(site)
    }

    /// Whether bodies that let water through are at all of these places, which a key gives.
    fn lies_at(
        &self,
        record: &Record,
        key: &str,
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
            record.consequence(key, message, PERMEABLE, report);
            return None;
        }
        Some(())
    }
}

/// Names of drains, which are unique.
pub(super) fn named(draft: &Draft, report: &mut Report<'_>) {
    let drains = draft.drain.items();
    for (number, record) in drains.iter().enumerate() {
        let Some(name) = record.text("name") else { continue };
        if drains[..number].iter().any(|other| other.text("name") == Some(name)) {
            let message = format!(
                "E0421: another drain is also called `{name}`, so histories and stages cannot tell which one is \
                 meant. Give each drain its own `name`."
            );
            record.error("name", message, report);
        }
    }
}

pub(super) fn drain(record: &Record, ground: Ground<'_>, report: &mut Report<'_>) -> Option<Drain> {
    let given = given(record, report);
    let site = if record.gives("face") {
        DrainSite::Face(face(record, ground, report)?)
    } else if record.gives("surface") {
        if !record.flag("surface")? {
            let message = "E0514: with `surface = false` the drain has no location. Set `surface = true`, or replace \
                 `surface` by `face`, by `circle`, or by `from` and `to`.";
            record.error("surface", message, report);
            return None;
        }
        // What is wrong with it in space is reported there.
        ground.around.grid.filter(|grid| grid.dims() == 2)?;
        DrainSite::Lines(surface(record, ground, report)?)
    } else if record.gives("circle") {
        let (center, radius, places) = circle(record, ground.around, report)?;
        ground.lies_at(record, "circle", places.into_iter().map(|[x, y]| [x, y, 0.0]), report)?;
        DrainSite::Circle { center, radius }
    } else {
        match ground.site(record, report)? {
            Site::Plate(plate) => DrainSite::Plate(plate),
            Site::Segment { from, to } => DrainSite::Lines(vec![[from, to]]),
            Site::Face(_) => return None,
        }
    };
    Some(Drain {
        name: record.text("name").map(str::to_owned),
        site,
        given: given?,
    })
}

/// The pressure at a drain.
fn given(record: &Record, report: &mut Report<'_>) -> Option<Given> {
    if record.gives("head_path") {
        return Some(Given::Head(course(record, "head_path", report)?));
    }
    if record.gives("pressure_path") {
        return Some(Given::Pressure(course(record, "pressure_path", report)?));
    }
    if record.gives("head") {
        return constant(record, "head").map(Given::Head);
    }
    if record.gives("pressure") {
        return constant(record, "pressure").map(Given::Pressure);
    }
    if record.gives("seepage") {
        if !record.flag("seepage")? {
            let message = "E0514: `seepage = false` has no effect. Set `seepage = true` for a seepage face, or remove \
                 `seepage`.";
            record.error("seepage", message, report);
        }
        if record.gives("face") {
            let message = "E0515: at a seepage face water can only leave the soil, but through a face of the grid \
                 water could also enter. Replace `face` by `from` and `to` on the surface of the body.";
            record.error("seepage", message, report);
        }
        return Some(Given::Seepage);
    }
    Some(Given::StillWater)
}

/// Rows of a number that follows time.
fn course(record: &Record, key: &str, report: &mut Report<'_>) -> Option<Course> {
    Some(Course(
        increasing(&record.rows_field(key), report)?
            .map(|row| (row[0], row[1]))
            .collect(),
    ))
}

/// A number that does not change in time.
fn constant(record: &Record, key: &str) -> Option<Course> {
    Some(Course(vec![(0.0, record.number(key)?)]))
}

/// A face of the grid at which a body of permeable soil lies.
fn face(record: &Record, ground: Ground<'_>, report: &mut Report<'_>) -> Option<Face> {
    let grid = ground.around.grid?;
    let face = place::face(record, grid, report)?;
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
        record.consequence("face", message, PERMEABLE, report);
        return None;
    }
    Some(face)
}

/// The surface of bodies of permeable soil, but for what lies at faces of the grid that hold it.
fn surface(record: &Record, ground: Ground<'_>, report: &mut Report<'_>) -> Option<Vec<[[f64; 2]; 2]>> {
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
        record.consequence("surface", message, PERMEABLE, report);
        return None;
    }
    let long: f64 = pieces.iter().map(|[p, q]| (q[0] - p[0]).hypot(q[1] - p[1])).sum();
    let reason = "free surface of permeable soil when the drain begins to act; surface that forms later is not drained";
    report.note(
        record.path_of("surface"),
        format!("{long:.6} m in {} pieces", pieces.len()),
        reason,
    );
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

pub(super) fn inflow(record: &Record, ground: Ground<'_>, report: &mut Report<'_>) -> Option<Inflow> {
    let rate = match record.gives("rate_path") {
        true => course(record, "rate_path", report),
        false => constant(record, "rate"),
    };
    let runs_off = record.flag("runoff")?;
    let site = if record.gives("face") {
        along_face(record, ground, report)?
    } else {
        ground.site(record, report)?
    };
    Some(Inflow {
        site,
        rate: rate?,
        runs_off,
    })
}

/// What of a face of the grid lies between the ends of the permeable bodies there.
fn along_face(record: &Record, ground: Ground<'_>, report: &mut Report<'_>) -> Option<Site> {
    let grid = ground.around.grid?;
    let face = face(record, ground, report)?;
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
pub(in crate::validate) fn drain_of(record: &Record, draft: &Draft, report: &mut Report<'_>) -> Option<Option<usize>> {
    let drains = draft.drain.items();
    let (key, found) = if record.gives("drain") {
        let name = record.text("drain")?;
        (
            "drain",
            drains.iter().position(|drain| drain.text("name") == Some(name)),
        )
    } else if record.gives("face") {
        let side: Side = record.word("face")?;
        (
            "face",
            drains
                .iter()
                .position(|drain| drain.gives("face") && drain.word("face") == Some(side)),
        )
    } else {
        return Some(None);
    };
    if found.is_none() {
        let names = drains.iter().filter_map(|drain| drain.text("name"));
        let near = record.text("drain").map(|name| hint(name, names)).unwrap_or_default();
        let end = if near.is_empty() { "." } else { &near };
        let message = format!(
            "E0518: no [[drain]] of the case has this name or face. Correct the name or face, or \
                               add a drain{end}"
        );
        record.consequence(key, message, &["drain"], report);
        return None;
    }
    Some(found)
}
