//! Warnings about a step that was accepted, which no other number shows.

use super::Run;
use crate::checkpoint::Outlet;
use bsmpm::control::Accepted;
use bsmpm::kinematics::Kinematics;
use bsmpm::tensor::Vector;
use bsmpm::water::flow::Motion;
use bsmpm_io::manifest::ManifestOutflow;
use bsmpm_ranks::simulation::Simulation;
use bsmpm_scene::{Face, Support};

/// Cells that a rigid body may move in a step at the soil that it touches.
const FASTEST: f64 = 0.5;
/// Cells that points may be in a rigid body.
const DEEPEST: f64 = 0.05;
/// Part of the ground at a drained face that may have moved off it.
const LEFT: f64 = 0.1;
/// Cells between neighbours on a drained surface above which it is torn.
const TORN: f64 = 1.0;

impl<K: Kinematics<D>, const D: usize> Run<'_, K, D> {
    /// Misspelt options of PETSc would do nothing in silence.
    pub(super) fn tell_unused_options(&mut self) {
        let unused = self.simulation.unused_options();
        let given = |name: &String| self.arguments.petsc.iter().any(|option| option.strip_prefix('-') == Some(name));
        let misspelt: Vec<String> = unused.into_iter().filter(given).collect();
        for name in misspelt {
            let warning =
                format!("the PETSc option -{name} was not used: it is misspelt, or the solver has no such part");
            self.warn(warning);
        }
    }

    /// A rigid body that comes so fast that points are met too late, or so light a penalty that they go into it.
    pub(super) fn tell_rigid(&mut self, accepted: &Accepted) {
        for (number, report) in accepted.report.rigid.iter().enumerate() {
            let (name, t) = (self.case.rigid[number].name.clone(), accepted.t);
            let (advance, depth) = (report.advance, report.penetration);
            if advance > FASTEST && self.told_rigid.insert(2 * number) {
                self.warn(format!(
                    "rigid `{name}`: at t = {t} it moves {advance:.2} cells in a step at soil that it touches; points are met \
                     right up to {FASTEST}: more steps"
                ));
            }
            if depth > DEEPEST && self.told_rigid.insert(2 * number + 1) {
                self.warn(format!(
                    "rigid `{name}`: at t = {t} points are {depth:.2} cells in it, usually 1e-4: it was pushed over them, or \
                     its force is beyond what its penalty is made for; more steps"
                ));
            }
        }
    }

    /// Faces of the grid hold material, and let rigid bodies through.
    pub(super) fn tell_let_through(&mut self, accepted: &Accepted) {
        let count = self.case.rigid.len();
        for (number, report) in accepted.report.rigid.iter().enumerate() {
            let body = &self.simulation.model.boundary.rigid[number];
            let known = 2 * count + count * count + number;
            if !(body.acts && body.is_free()) || self.told_rigid.contains(&known) {
                continue;
            }
            let (grid, slack) = (&self.case.grid, DEEPEST * self.case.grid.shortest());
            let further = |face: Face| {
                let [start, now] = [Vector::zeros(), report.moved].map(|moved| body.extent(&moved, face.axis));
                let past = |[least, most]: [f64; 2]| match face.upper {
                    true => most - (grid.upper()[face.axis] - grid.lower()[face.axis]),
                    false => -least,
                };
                start.zip(now).is_some_and(|(start, now)| past(now) > past(start).max(0.0) + slack)
            };
            let faces = self.case.faces_at(accepted.t).into_iter();
            let mut holding = faces.filter(|of| !matches!(of.support, Support::Free | Support::Outflow));
            let Some(through) = holding.find(|of| of.face.axis < D && further(of.face)) else { continue };
            let (name, side) = (self.case.rigid[number].name.clone(), through.face.side(self.case.geometry));
            self.told_rigid.insert(known);
            self.warn(format!(
                "rigid `{name}`: at t = {} it goes through the face {side} of the grid: faces hold material, and no rigid \
                 bodies; what shall stop it is soil before that face",
                accepted.t
            ));
        }
    }

    /// A strip that holds nothing, or no longer the material that it held, does nothing of what it is there for, which
    /// no other number tells.
    pub(super) fn tell_strips_without_material(&mut self, accepted: &Accepted) {
        for (number, strip) in accepted.report.strips.iter().enumerate() {
            let on = &self.simulation.model.boundary.strips[number];
            if !on.acts() {
                continue;
            }
            let points = on.points.len();
            let (name, t) = (bsmpm_scene::surfaces::name_of_strip(&self.case, number), accepted.t);
            let mut kind = number;
            let told = if strip.held == 0 {
                format!("{name} holds nothing: at t = {t} no free material is at it")
            } else if 2 * strip.left_behind > points {
                kind += accepted.report.strips.len();
                format!(
                    "{name} has let go: at t = {t} most of it is more than half a cell ahead of the material that it held at the \
                     start, and its force is no longer that of a strip that holds; smaller cells and more points_per_cell \
                     hold longer, and soil that must not be pulled wants a motion without it"
                )
            } else if strip.moved_on > 0 {
                kind += 2 * accepted.report.strips.len();
                format!(
                    "{name} comes down at t = {t} more than half a cell from where it had come off: it meets the material as \
                     high as where it left it, which is right on a level surface only"
                )
            } else {
                continue;
            };
            if self.told_strips.insert(kind) {
                self.warn(told);
            }
        }
    }

    /// A drain or an inflow most of which has no ground near lets nothing through there.
    pub(super) fn tell_drains(&mut self, accepted: &Accepted) {
        let (Some(water), t) = (&accepted.report.water, accepted.t) else { return };
        let model = &self.simulation.model;
        let flow = model.water.as_ref().and_then(|water| water.flow.as_ref());
        let Some(flow) = flow.filter(|flow| flow.motion == Motion::Flows) else { return };
        let acts: Vec<bool> = flow.acting().collect();
        let wanted = self.simulation.model.surfaces().water;
        let points: Vec<usize> = wanted.iter().map(|points| points.len()).collect();
        let of_strips = 3 * self.simulation.model.boundary.strips.len();
        for number in (0..points.len()).filter(|&number| acts[number] && 2 * water.held[number] < points[number]) {
            let name = bsmpm_scene::surfaces::name_of_drain(&self.case, number);
            if self.told_strips.insert(of_strips + number) {
                self.warn(format!(
                    "{name}: at t = {t} most of it is out of the grid or has no ground near, and lets no water through; where the \
                     surface heaves, a grid that goes on a cell beyond it"
                ));
            }
        }
        for number in (0..points.len()).filter(|&number| water.torn[number] > TORN) {
            let name = bsmpm_scene::surfaces::name_of_drain(&self.case, number);
            if self.told_strips.insert(of_strips + points.len() + number) {
                self.warn(format!(
                    "{name}: at t = {t} points of it that were neighbours at the start are {:.1} cells apart: the ground has come \
                     apart or is stretched between them, and its new surface there is closed, so that no water seeps out of it or \
                     goes in; hold the result against that of drainage = \"hydrostatic\", the other bound",
                    water.torn[number]
                ));
            }
        }
        self.tell_drained_faces(accepted, of_strips + 2 * points.len());
    }

    /// Ground that goes away from a drained face of the grid leaves its drain there. `known`: of the first.
    fn tell_drained_faces(&mut self, accepted: &Accepted, known: usize) {
        let (Some(water), t) = (&accepted.report.water, accepted.t) else { return };
        let flow = self.simulation.model.water.as_ref().and_then(|water| water.flow.as_ref());
        let acts: Vec<bool> = flow.map_or_else(Vec::new, |flow| flow.faces.iter().map(|face| face.acts).collect());
        for (number, face) in water.faces.iter().enumerate().filter(|(number, _)| acts[*number]) {
            let (sealed, off) = (face.held == 0, face.off as f64 > LEFT * face.near as f64);
            if !(sealed || off) || !self.told_strips.insert(known + 2 * number + usize::from(sealed)) {
                continue;
            }
            let name = bsmpm_scene::surfaces::name_of_drained_face(&self.case, number);
            let share = 100.0 * face.off as f64 / face.near.max(1) as f64;
            let what = if sealed {
                "no ground is left at its face of the grid: it is sealed, and no water crosses it any more".into()
            } else {
                format!(
                    "{share:.0} % of the ground at its face of the grid have moved off by more than a fifth of a cell: too little \
                     water goes through it from there on, and none after a cell"
                )
            };
            self.warn(format!(
                "{name}: at t = {t} {what}; a face does not go with the ground: name the surface of the body instead, by \
                 surface = true or from and to (solid: a rectangle or disc)"
            ));
        }
    }

    /// Boxes of histories that no point has come into.
    pub(super) fn tell_vacant(&mut self) {
        if let Some(names) = self.recorder.vacant() {
            self.warn(format!(
                "no point was in the box of these histories in any step, and they tell nothing of the ground: {names}; a box stays \
                 where it is in space"
            ));
        }
    }

    /// Material that leaves is told when the first does, and counted in the manifest.
    pub(super) fn tell_outflow(&mut self, accepted: &Accepted) {
        let Some(outflow) = &accepted.report.outflow else { return };
        if self.recorder.left().points == 0 {
            let message = format!("material leaves the grid from t = {} on: run.json counts it", accepted.t);
            self.log.line("outflow", &message);
        }
        let Simulation { points, halo, .. } = &self.simulation;
        let lost = self.recorder.let_out(outflow, points, &**halo);
        let Outlet { points, mass } = self.recorder.left();
        if let Some(ledger) = &mut self.ledger {
            ledger.manifest().outflow = Some(ManifestOutflow { points, mass: mass * self.case.geometry.whole() });
        }
        for name in lost {
            let t = accepted.t;
            self.warn(format!(
                "history {name}: the point that it followed has left the grid at t = {t}; it reads 0 since"
            ));
        }
    }
}
