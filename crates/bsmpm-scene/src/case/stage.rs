//! Data of stages. A stage changes bodies, loads, boundaries and materials of a case.

use super::{Body, Case, DrainSite, Face, NamedMaterial, Shares, Support, keeps_direction};
use bsmpm::boundary::Idle;
use bsmpm::field::pore_water::flow::Motion;
use bsmpm::interactions::coulomb::Contact;
use bsmpm::tensor::Vector;
use std::ops::Range;

/// What changes at a time, between two steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// What it is called.
    pub name: Option<String>,
    /// s (quasi-static: pseudo-time)  when it begins; a step ends there
    pub at: f64,
    /// Numbers of the bodies that are taken away.
    pub remove: Vec<usize>,
    /// Numbers of the bodies that are placed.
    pub add: Vec<usize>,
    /// Names of what acts from here on, and what that is.
    pub apply: Vec<(String, ActiveLoads)>,
    /// The same of what acts no longer.
    pub release: Vec<(String, ActiveLoads)>,
    /// Faces of the grid that change.
    pub faces: Vec<FaceSupport>,
    /// Numbers of materials, and of those whose laws their bodies follow from here on.
    pub materials: Vec<(usize, usize)>,
    /// -  factor by which the strength that the file gives is divided from here on, if that changes
    pub strength_reduction: Option<f64>,
    /// Whether water that flows rests from here on.
    pub rests: bool,
    /// Whether displacements that are reported count from here.
    pub resets_displacements: bool,
    /// Numbers of the histories that follow a point of what is placed.
    pub follows: Vec<usize>,
}

impl Stage {
    /// Whether another model goes on from here: one with other loads, supports or laws.
    pub fn exchanges(&self) -> bool {
        let switches = !(self.apply.is_empty() && self.release.is_empty());
        let others = !(self.faces.is_empty() && self.materials.is_empty()) || self.strength_reduction.is_some();
        switches || others || self.rests
    }

    /// Whether the ground, what holds and what loads it stay as they are.
    pub fn only_resets(&self) -> bool {
        !self.exchanges() && self.remove.is_empty() && self.add.is_empty()
    }

    /// Whether it releases, and whether it applies something.
    pub fn switches(&self, what: ActiveLoads) -> [bool; 2] {
        [&self.release, &self.apply].map(|list| list.iter().any(|(_, other)| *other == what))
    }
}

/// What a face of the grid does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceSupport {
    /// The face.
    pub face: Face,
    /// Its support.
    pub support: Support,
    /// Its contact, if it is in any.
    pub contact: Option<Contact>,
}

/// What stages apply and release.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ActiveLoads {
    /// The number of a strip: the footing, then the prescribed motions in the order of the file.
    Strip(usize),
    /// The number of a load: tractions, then point loads, in the order of the file.
    Load(usize),
    /// The number of a rigid body, in the order of the file.
    Rigid(usize),
    /// The number of a drain, in the order of the file.
    Drain(usize),
    /// The number of an inflow, in the order of the file.
    Inflow(usize),
}

/// What is before the first stage, in the place of a stage's name.
const START: &str = "start";
/// The end of the run, in the place of a stage's name.
const END: &str = "end";
/// Parts of a step by which the time of a stage may be missed: what the schedule takes as the same time.
const SAME: f64 = 1e-6;

impl Case {
    /// The stages that begin at the time `t` at which a step has ended.
    pub fn stages_at(&self, t: f64) -> impl Iterator<Item = &Stage> {
        self.stages
            .iter()
            .filter(move |stage| (stage.at - t).abs() <= SAME * self.analysis.dt)
    }

    fn has_begun(&self, stage: &Stage, t: f64) -> bool {
        stage.at <= t + SAME * self.analysis.dt
    }

    /// Since when something that stages apply and release acts (s, or pseudo-time) once the stages until the time `t`
    /// have begun; `None` if it does not. What a stage applies before any has released it does not act at the start.
    pub fn acts_since(&self, what: ActiveLoads, t: f64) -> Option<f64> {
        let comes_later = self.stages.iter().find_map(|stage| {
            let named = stage.switches(what);
            (named != [false; 2]).then_some(!named[0])
        });
        let at_start = (comes_later != Some(true)).then_some(0.0);
        self.stages
            .iter()
            .filter(|stage| self.has_begun(stage, t))
            .fold(at_start, |since, stage| {
                let [releases, applies] = stage.switches(what);
                if applies {
                    Some(stage.at)
                } else {
                    since.filter(|_| !releases)
                }
            })
    }

    /// What does not act before a stage that begins at the time `t`: tractions, then point loads; drains on surfaces of
    /// bodies, then inflows.
    pub fn idle_before(&self, t: f64) -> Idle {
        let before = self.just_before(t);
        let is_idle = |what: ActiveLoads| self.acts_since(what, before).is_none();
        let (drains, inflows) = self
            .flow
            .as_ref()
            .map_or((&[][..], 0), |flow| (&flow.drains[..], flow.inflows.len()));
        let loads = 0..self.tractions.len() + self.point_loads.len();
        let surfaces = (0..drains.len()).filter(|&number| !matches!(drains[number].site, DrainSite::Face(_)));
        Idle {
            loads: loads
                .chain(self.turning_loads())
                .map(ActiveLoads::Load)
                .map(is_idle)
                .collect(),
            water: surfaces
                .map(ActiveLoads::Drain)
                .chain((0..inflows).map(ActiveLoads::Inflow))
                .map(is_idle)
                .collect(),
        }
    }

    /// Numbers of the loads whose direction changes, once for every axis but the first: the physics has a load of a
    /// steady direction for each, behind all others.
    pub(crate) fn turning_loads(&self) -> impl Iterator<Item = usize> {
        let tractions = self.tractions.iter().map(|of| &of.amplitude);
        let all = tractions
            .chain(self.point_loads.iter().map(|of| &of.amplitude))
            .enumerate();
        let turning = all.filter(|(_, shares)| !keeps_direction(shares));
        turning.flat_map(|(number, _)| std::iter::repeat_n(number, self.grid.dims() - 1))
    }

    /// What the file calls the loads that act in full from the start.
    pub fn sudden_loads(&self) -> Vec<String> {
        let tractions = self
            .tractions
            .iter()
            .enumerate()
            .map(|(k, of)| (format!("traction.{k}"), of.ramp, &of.amplitude));
        let forces = self.point_loads.iter().enumerate();
        let forces = forces.map(|(k, of)| (format!("point_load.{k}"), of.ramp, &of.amplitude));
        let all = tractions.chain(forces).enumerate();
        let sudden = all.filter(|(load, (_, ramp, amplitude))| {
            is_sudden(*ramp, amplitude) && self.acts_since(ActiveLoads::Load(*load), 0.0).is_some()
        });
        let pushes = self
            .gravity
            .iter()
            .filter(|gravity| gravity.ramp == 0.0 && !gravity.is_straight(self.grid.dims()));
        let inertia = pushes.map(|_| "the horizontal gravity".to_owned());
        sudden.map(|(_, (name, ..))| name).chain(inertia).collect()
    }

    /// Whether bodies that are there as long as a strip or load acts satisfy `holds`.
    pub(crate) fn is_held(&self, what: ActiveLoads, holds: impl Fn(&Body) -> bool) -> bool {
        let times = std::iter::once(0.0).chain(self.stages.iter().map(|stage| stage.at));
        let acting: Vec<f64> = times.filter(|t| self.acts_since(what, *t).is_some()).collect();
        (0..self.bodies.len())
            .filter(|body| acting.iter().all(|t| self.is_there(*body, *t)))
            .any(|body| holds(&self.bodies[body]))
    }

    /// What the strength of the start is divided by once the stages until the time `t` have begun.
    pub(crate) fn divided_at(&self, t: f64) -> f64 {
        let mut begun = self.stages.iter().rev().filter(|stage| self.has_begun(stage, t));
        let factor = begun.find_map(|stage| stage.strength_reduction);
        factor.map_or(1.0, |factor| factor / self.strength_reduction.unwrap_or(1.0))
    }

    /// What water that may flow does once the stages until the time `t` have begun.
    pub(crate) fn water_at(&self, t: f64) -> Motion {
        let rests = self.stages.iter().any(|stage| stage.rests && self.has_begun(stage, t));
        self.flow
            .as_ref()
            .map_or(Motion::Flows, |flow| if rests { flow.at_rest } else { flow.motion })
    }

    /// When the stage of a name ends (s, or pseudo-time): as the next one begins. `"start"`, of what is before the
    /// first stage; `"end"`, of the run.
    pub fn end_of_stage(&self, name: &str) -> Option<f64> {
        let next = match self.stages.iter().position(|stage| stage.name.as_deref() == Some(name)) {
            Some(number) => number + 1,
            None if name == START && self.stages.is_empty() => return Some(0.0),
            None if name == START => 0,
            None => return (name == END).then_some(self.analysis.end),
        };
        Some(self.stages.get(next).map_or(self.analysis.end, |stage| stage.at))
    }

    /// Whether gravity, or a load that acts until a time, does not act in full then, or changes later.
    pub(crate) fn still_grows(&self, until: f64) -> bool {
        let before = self.just_before(until);
        let tractions = self.tractions.iter().map(|load| (load.ramp, &load.amplitude));
        let loads = tractions.chain(self.point_loads.iter().map(|load| (load.ramp, &load.amplitude)));
        let acting = loads
            .map(|(ramp, amplitude)| ramp.max(rests_from(amplitude)))
            .enumerate()
            .filter_map(|(load, grows)| {
                self.acts_since(ActiveLoads::Load(load), before)
                    .map(|since| since + grows)
            });
        let rigid = self.rigid.iter().enumerate().filter(|(_, of)| of.force != [0.0; 3]);
        let rigid = rigid.filter_map(|(number, of)| {
            let since = self.acts_since(ActiveLoads::Rigid(number), before)?;
            Some(since + of.ramp.max(rests_from(&of.amplitude)))
        });
        let gravity = self.gravity.iter().map(|gravity| gravity.ramp);
        acting.chain(rigid).chain(gravity).any(|end| end > until * (1.0 + 1e-9))
    }

    /// Whether a load, by its number, is not whole as soon as it acts.
    pub(crate) fn grows_from(&self, load: usize) -> bool {
        let tractions = self.tractions.iter().map(|of| (of.ramp, &of.amplitude));
        let mut all = tractions.chain(self.point_loads.iter().map(|of| (of.ramp, &of.amplitude)));
        all.nth(load)
            .is_some_and(|(ramp, amplitude)| ramp > 0.0 || !amplitude.is_empty())
    }

    /// When the ground begins to shake, s; without end if it does not.
    pub(crate) fn shakes_from(&self) -> f64 {
        let first = self.shaking.iter().position(|(_, ground)| *ground != [0.0; 3]);
        // Linear between rows, from none at 0.
        first.map_or(
            f64::INFINITY,
            |first| if first == 0 { 0.0 } else { self.shaking[first - 1].0 },
        )
    }

    /// Whether a strip that acts until a time moves later.
    pub(crate) fn still_moves(&self, until: f64) -> bool {
        let before = self.just_before(until);
        let footing = self.footing.iter().map(|of| &of.path);
        let paths = footing.chain(self.prescribed.iter().map(|of| &of.path));
        let acting = paths
            .enumerate()
            .filter(|(strip, _)| self.acts_since(ActiveLoads::Strip(*strip), before).is_some());
        acting.map(|(_, path)| path).any(|path| {
            let next = path.rows.partition_point(|row| row.0 <= until * (1.0 + 1e-9));
            let last = next.checked_sub(1).map_or([0.0; 3], |last| path.rows[last].1);
            path.rows[next..].iter().any(|row| row.1 != last)
        })
    }

    /// A time at which nothing has begun that begins at the time `t`, and everything that began before.
    pub fn just_before(&self, t: f64) -> f64 {
        t - 1.5 * SAME * self.analysis.dt
    }

    /// What all faces of the grid do once the stages until the time `t` have begun.
    pub fn faces_at(&self, t: f64) -> Vec<FaceSupport> {
        let mut faces = Vec::new();
        let divided = self.divided_at(t);
        for (axis, upper) in (0..self.geometry.dims()).flat_map(|axis| [(axis, false), (axis, true)]) {
            let face = Face { axis, upper };
            let support = self.boundary[axis][usize::from(upper)];
            let contact = self.contacts[axis][usize::from(upper)];
            let mut begun = self.stages.iter().rev().filter(|stage| self.has_begun(stage, t));
            let changed = begun.find_map(|stage| stage.faces.iter().find(|of| of.face == face));
            let mut of = *changed.unwrap_or(&FaceSupport { face, support, contact });
            of.contact = of.contact.map(|contact| Contact {
                friction: contact.friction / divided,
                ..contact
            });
            faces.push(of);
        }
        faces
    }

    /// What a face of the grid is at some time of the run.
    pub fn is_ever(&self, support: Support) -> bool {
        let later = self.stages.iter().flat_map(|stage| &stage.faces);
        self.boundary.as_flattened().contains(&support) || later.into_iter().any(|face| face.support == support)
    }

    /// The materials once the stages until the time `t` have begun: each with the law that its bodies follow then, and
    /// with what goes with a law.
    pub fn materials_at(&self, t: f64) -> Vec<NamedMaterial> {
        let divided = self.divided_at(t);
        let mut followed: Vec<usize> = (0..self.materials.len()).collect();
        let exchanges = self
            .stages
            .iter()
            .filter(|stage| self.has_begun(stage, t))
            .flat_map(|stage| &stage.materials);
        exchanges.for_each(|&(from, to)| followed[from] = to);
        let mut materials: Vec<NamedMaterial> = followed.into_iter().map(|of| self.materials[of].clone()).collect();
        for (named, own) in materials.iter_mut().zip(&self.materials) {
            named.density = own.density;
            named.saturated = own.saturated;
            if divided != 1.0 {
                named.material = named.material.clone().reduced(divided);
            }
        }
        materials
    }

    /// The materials that bodies which are there follow once the stages until the time `t` have begun.
    pub fn followed_at(&self, t: f64) -> impl Iterator<Item = NamedMaterial> {
        let bodies = self.bodies.iter().enumerate();
        let there = bodies.filter(|(number, _)| self.is_there(*number, t));
        let there: Vec<usize> = there.map(|(_, body)| body.material).collect();
        let materials = self.materials_at(t).into_iter().enumerate();
        materials.filter_map(move |(number, named)| there.contains(&number).then_some(named))
    }

    /// Whether a face, a strip or a rigid body has friction once the stages until the time `t` have begun.
    pub fn has_friction_at(&self, t: f64) -> bool {
        let footing = self.footing.iter().map(|footing| footing.contact);
        let strips = footing
            .chain(self.prescribed.iter().map(|prescribed| prescribed.contact))
            .enumerate();
        let strips = strips.filter(|(number, _)| self.acts_since(ActiveLoads::Strip(*number), t).is_some());
        let strips = strips.filter_map(|(_, contact)| Some(contact?.law.friction));
        let rigid = self
            .rigid
            .iter()
            .enumerate()
            .filter(|(number, _)| self.acts_since(ActiveLoads::Rigid(*number), t).is_some());
        let faces = self
            .faces_at(t)
            .into_iter()
            .filter_map(|face| Some(face.contact?.friction));
        faces
            .chain(strips)
            .chain(rigid.map(|(_, rigid)| rigid.friction))
            .any(|friction| friction > 0.0)
    }

    /// Whether bodies follow the law of a material at some time.
    pub fn is_followed(&self, material: usize) -> bool {
        let is_made = |number: usize| self.bodies.iter().any(|body| body.material == number);
        let mut exchanges = self.stages.iter().flat_map(|stage| &stage.materials);
        is_made(material) || exchanges.any(|&(from, to)| to == material && is_made(from))
    }

    /// Whether a body is there once the stages until the time `t` have begun.
    pub fn is_there(&self, body: usize, t: f64) -> bool {
        let adds = |stage: &Stage| stage.add.contains(&body);
        let mut begun = self.stages.iter().filter(|stage| self.has_begun(stage, t));
        let came = !self.stages.iter().any(adds) || begun.clone().any(adds);
        came && !begun.any(|stage| stage.remove.contains(&body))
    }

    /// Whether a body is there from the start to the end.
    pub fn lasts(&self, body: usize) -> bool {
        self.stages
            .iter()
            .all(|stage| !stage.add.contains(&body) && !stage.remove.contains(&body))
    }

    /// The bodies that are there before the first step.
    pub fn bodies_at_start(&self) -> impl Iterator<Item = &Body> {
        self.bodies
            .iter()
            .enumerate()
            .filter(|(number, _)| self.is_there(*number, 0.0))
            .map(|(_, body)| body)
    }

    /// Ids of every body's points: they count body by body.
    pub fn ids(&self) -> Vec<Range<u64>> {
        let mut end = 0;
        let ids = self.bodies.iter().map(|body| {
            let start = end;
            end += body.points(&self.grid) as u64;
            start..end
        });
        ids.collect()
    }

    /// Whether a stage takes a point away, by its id.
    pub fn taken_by(&self, stage: &Stage) -> impl Fn(u64) -> bool + use<> {
        is_in(self.ids_of(|body| stage.remove.contains(&body)))
    }

    /// Whether a stage places a point, by its id.
    pub fn placed_by(&self, stage: &Stage) -> impl Fn(u64) -> bool + use<> {
        is_in(self.ids_of(|body| stage.add.contains(&body)))
    }

    /// Whether a point is of a body that is there from the start to the end, by its id.
    pub fn lasting(&self) -> impl Fn(u64) -> bool + use<> {
        is_in(self.ids_of(|body| self.lasts(body)))
    }

    fn ids_of(&self, wanted: impl Fn(usize) -> bool) -> Vec<Range<u64>> {
        let of = self.ids().into_iter().enumerate().filter(|(body, _)| wanted(*body));
        of.map(|(_, ids)| ids).collect()
    }

    /// Ids of the points of the bodies that are there once the stages until the time `t` have begun.
    pub fn ids_at(&self, t: f64) -> Vec<Range<u64>> {
        self.ids_of(|body| self.is_there(body, t))
    }
}

/// Whether a load of a ramp (s, or pseudo-time) and an amplitude acts in full from the start.
fn is_sudden(ramp: f64, amplitude: &Shares) -> bool {
    match amplitude.first() {
        Some((t, share)) => *t == 0.0 && *share != Vector::<3>::zeros(),
        None => ramp == 0.0,
    }
}

/// Returns when an amplitude changes for the last time (s, or pseudo-time): the last row before which it has another
/// value. It begins with none.
fn rests_from(rows: &Shares) -> f64 {
    let values = std::iter::once(Vector::zeros()).chain(rows.iter().map(|row| row.1));
    let changes = rows.iter().zip(values).filter(|(row, before)| row.1 != *before);
    changes.map(|(row, _)| row.0).fold(0.0, f64::max)
}

/// Whether an id lies in one of the ranges.
fn is_in(ids: Vec<Range<u64>>) -> impl Fn(u64) -> bool {
    move |id| ids.iter().any(|range| range.contains(&id))
}
