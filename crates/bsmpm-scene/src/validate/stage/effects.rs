//! Checks what stages do to the rest of the case.

use super::absorbing;
use crate::case::{ActiveLoads, Body, Case, LoadedLine, Site};
use crate::observables::HistorySubject;
use crate::record::KeyPlace;
use crate::report::Report;
use crate::schema::{Draft, ExchangeTable};
use crate::validate::{place, reduction, rigid, sheet, site, strip};

/// What only the whole case shows: something is always left, it can be there without stress, strips have a body under
/// them from the start to the end, and loads as long as they act.
pub(in crate::validate) fn check(case: &mut Case, draft: &Draft, report: &mut Report<'_>) {
    if case.stages.is_empty() {
        return;
    }
    let records = draft.stage.items();
    if case.bodies_at_start().next().is_none() {
        let message = "E0623: no body exists at the start, because stages add all bodies. Take at least one body out of the \
             `add` lists of the stages.";
        draft.body.error(message, report);
    }
    for (stage, record) in case.stages.iter().zip(records) {
        if !(0..case.bodies.len()).any(|body| case.is_there(body, stage.at)) {
            let message = "E0623: no body is left after this stage, so there is nothing to compute. Take at least one \
                body out of `remove`.";
            record.remove.error(message, report);
        }
        for (name, what) in &stage.apply {
            let has_moved = match *what {
                ActiveLoads::Strip(number) => strip::has_moved(case, number, stage.at),
                ActiveLoads::Rigid(number) => rigid::has_moved(&case.rigid[number], stage.at),
                ActiveLoads::Load(_) | ActiveLoads::Drain(_) | ActiveLoads::Inflow(_) => false,
            };
            if has_moved {
                let message = format!(
                    "E0624: the path of `{name}` begins before this stage activates the motion, so the position would \
                     jump at this stage. Begin the path of `{name}` at t = {}.",
                    stage.at
                );
                record.activate.error(message, report);
            }
        }
        for (&(from, to), pair) in stage.materials.iter().zip(record.materials.items()) {
            exchanged(case, from, to, pair, report);
        }
        if stage.strength_reduction.is_some() {
            let later = case.stages.iter().map(|later| later.at).filter(|at| *at >= stage.at);
            reduction::divisible(case, &later.collect::<Vec<f64>>(), &record.strength_reduction, report);
        }
        absorbing::check(case, stage, record, report);
        for &body in &stage.add {
            let named = &case.materials[case.bodies[body].material];
            if !named.material.is_linear() {
                let message = format!(
                    "E0625: the stage adds body.{body} without stress, but the stiffness of material.{} depends on \
                     the stress. Use a material with constant stiffness.",
                    named.name
                );
                record.add.error(message, report);
            }
        }
    }
    let lasting: Vec<Body> = (0..case.bodies.len())
        .filter(|&body| case.lasts(body))
        .map(|body| case.bodies[body].clone())
        .collect();
    follow(case, &lasting);
    check_surfaces(case, &lasting, draft, report);
}

/// Refuses strips, loads and drains that lose the body at one of their places; strips need one of those that are
/// `lasting`.
fn check_surfaces(case: &Case, lasting: &[Body], draft: &Draft, report: &mut Report<'_>) {
    let grid = &case.grid;
    for (what, key, places) in surfaces(case, draft) {
        let mut at_bodies = places.into_iter().filter(|at| place::is_at(&case.bodies, grid, *at));
        let (lost, duration) = match what {
            ActiveLoads::Strip(_) => (
                at_bodies.find(|at| !place::is_at(lasting, grid, *at)),
                "during the whole run",
            ),
            _ => (
                at_bodies.find(|at| !case.is_held(what, |body| place::is_at(std::slice::from_ref(body), grid, *at))),
                "while it is active",
            ),
        };
        if let Some(at) = lost {
            let message = format!(
                "E0626: this load, footing or drain needs the body at {:?} m {duration}, but a stage adds or removes \
                 that body. Use another position, or keep the body.",
                &at[..case.grid.dims()]
            );
            key.error(message, report);
        }
    }
}

/// A law can go on from the stress that another one has left, with the mass that is there.
fn exchanged(case: &Case, from: usize, to: usize, pair: &ExchangeTable, report: &mut Report<'_>) {
    let [from, to] = [from, to].map(|number| (number, &case.materials[number]));
    if !case.bodies.iter().any(|body| body.material == from.0) {
        let message = format!(
            "E0613: no body consists of material.{}, so the stage has nothing to replace. Name the \
            material of a body.",
            from.1.name
        );
        pair.from.error(message, report);
    }
    if from.1.density != to.1.density {
        let message = format!(
            "E0629: material.{} and material.{} differ in density, but a change of material cannot change the mass of \
             the soil. Give both the same `unit_weight`.",
            from.1.name, to.1.name
        );
        pair.to.error(message, report);
    }
    if !to.1.material.is_linear() {
        let message = format!(
            "E0625: the stiffness of material.{} depends on the stress history, which the replaced material has not \
             recorded. In a stage, change to a material with constant stiffness.",
            to.1.name
        );
        pair.to.error(message, report);
    }
}

/// Histories follow a point of a body that lasts, where one is at their place; where none of the start is, one of the
/// first body that comes there.
fn follow(case: &mut Case, lasting: &[Body]) {
    let first: Vec<Body> = case.bodies_at_start().cloned().collect();
    let mut places = Vec::new();
    for (number, history) in case.histories.iter_mut().enumerate() {
        if let HistorySubject::Place { at, .. } = history.quantity.subject {
            history.lasts = place::is_at(lasting, &case.grid, at);
            places.extend((!place::is_at(&first, &case.grid, at)).then_some((number, at)));
        }
    }
    for stage in &mut case.stages {
        let placed: Vec<Body> = stage.add.iter().map(|&body| case.bodies[body].clone()).collect();
        places.retain(|&(number, at)| {
            let comes = place::is_at(&placed, &case.grid, at);
            stage.follows.extend(comes.then_some(number));
            !comes
        });
    }
}

/// What acts: strips and loads with the keys of their places, and places along them.
pub(in crate::validate) fn surfaces<'a>(
    case: &Case,
    draft: &'a Draft,
) -> Vec<(ActiveLoads, &'a KeyPlace, Vec<[f64; 3]>)> {
    let mut found = Vec::new();
    let held = case.footing.iter().map(|footing| footing.site);
    let held = held.chain(case.prescribed.iter().map(|prescribed| prescribed.site));
    for (number, (site, strip)) in held.zip(draft.strips()).enumerate() {
        if !matches!(site, Site::Face(_)) {
            let places = site::places(site, &case.grid);
            found.push((ActiveLoads::Strip(number), strip.site.place(), places));
        }
    }
    for (number, (traction, record)) in case.tractions.iter().zip(draft.traction.items()).enumerate() {
        let places = match &traction.line {
            &LoadedLine::Segment { from, to } => site::places(Site::Segment { from, to }, &case.grid),
            &LoadedLine::Circle { center, radius } => place::ring(center, radius).map(place::flat).collect(),
            LoadedLine::Plate(plate) => site::places(Site::Plate(*plate), &case.grid),
            LoadedLine::Triangles(all) => all.iter().map(sheet::middle).collect(),
        };
        found.push((ActiveLoads::Load(number), record.site().place(), places));
    }
    for (number, (of, record)) in case.point_loads.iter().zip(draft.point_load.items()).enumerate() {
        let what = ActiveLoads::Load(case.tractions.len() + number);
        found.push((what, &record.at, vec![of.at]));
    }
    found
}
