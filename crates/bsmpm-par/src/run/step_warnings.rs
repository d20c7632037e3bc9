//! Warnings about an accepted step.

use super::Run;
use crate::checkpoint::Outlet;
use bsmpm::control::AcceptedStep;
use bsmpm::field::pore_water::flow::Motion;
use bsmpm::kinematics::Kinematics;
use bsmpm::tensor::Vector;
use bsmpm_io::manifest::ManifestOutflow;
use bsmpm_ranks::simulation::Simulation;
use bsmpm_scene::{Face, GridSpec, Support};

/// Cells that a rigid body may move in a step at the soil that it touches.
const FASTEST: f64 = 0.5;
/// Cells that points may be in a rigid body.
const DEEPEST: f64 = 0.05;
/// Part of the ground at a drained face that may have moved off it.
const LEFT: f64 = 0.1;
/// Cells between neighbours on a drained surface above which it is torn.
const TORN: f64 = 1.0;

/// How far (m) a body of this `extent` (m, from the grid's lower corner, along the axis of `face`) is past the face.
fn past(grid: &GridSpec, face: Face, [least, most]: [f64; 2]) -> f64 {
    match face.upper {
        true => most - (grid.upper()[face.axis] - grid.lower()[face.axis]),
        false => -least,
    }
}

impl<K: Kinematics<D>, const D: usize> Run<'_, K, D> {
    /// Misspelt options of PETSc would do nothing in silence.
    pub(super) fn tell_unused_options(&mut self) {
        for name in self.simulation.unused_options() {
            let mut given = self.arguments.petsc.iter();
            if !given.any(|option| option.strip_prefix('-') == Some(&name)) {
                continue;
            }
            let warning = format!(
                "W0701: the linear solver did not use the PETSc option -{name}, which has no effect. Check its \
                 spelling, and whether this solver has the option."
            );
            self.warn(warning);
        }
    }

    /// A rigid body that comes so fast that points are met too late, or so light a penalty that they go into it.
    pub(super) fn tell_rigid(&mut self, accepted: &AcceptedStep) {
        for (number, report) in accepted.report.rigid.iter().enumerate() {
            let name = self.case.rigid[number].name.clone();
            let t = self.moment(accepted.t);
            let advance = report.advance;
            let depth = report.penetration;
            if advance > FASTEST {
                self.warn_once("W0702", &name, || {
                    format!(
                        "W0702: rigid body `{name}` moves by {advance:.2} cells in one step at t = {t} (limit: \
                         {FASTEST}). Contact with the soil is detected too late. Increase `analysis.steps`, or reduce \
                         `analysis.dt`."
                    )
                });
            }
            if depth > DEEPEST {
                self.warn_once("W0703", &name, || {
                    format!(
                        "W0703: rigid body `{name}` penetrates the soil by {depth:.2} cells at t = {t} (limit: \
                         {DEEPEST}). The force on the body is inaccurate. Increase `analysis.steps`, or reduce \
                         `analysis.dt`."
                    )
                });
            }
        }
    }

    /// Faces of the grid hold material, and let rigid bodies through.
    pub(super) fn tell_let_through(&mut self, accepted: &AcceptedStep) {
        for (number, report) in accepted.report.rigid.iter().enumerate() {
            let body = &self.simulation.model.boundary.rigid[number];
            if !(body.acts && body.is_free()) {
                continue;
            }
            let grid = &self.case.grid;
            let slack = DEEPEST * self.case.grid.shortest();
            let faces = self.case.faces_at(accepted.t).into_iter();
            let mut holding =
                faces.filter(|of| of.face.axis < D && !matches!(of.support, Support::Free | Support::Outflow));
            let through = holding.find(|of| {
                let extents = [Vector::zeros(), report.moved].map(|moved| body.extent(&moved, of.face.axis));
                let [start, now] = extents.map(|extent| extent.map(|extent| past(grid, of.face, extent)));
                start.zip(now).is_some_and(|(start, now)| now > start.max(0.0) + slack)
            });
            let Some(through) = through else {
                continue;
            };
            let name = self.case.rigid[number].name.clone();
            let side = through.face.side(self.case.geometry);
            let t = self.moment(accepted.t);
            self.warn_once("W0704", &name, || {
format!(
                "W0704: rigid body `{name}` passes through boundary `{side}` at t = {t}. Boundaries do not support rigid bodies. \
                 Place soil in front of the boundary, or change the motion of the body."
            )
});
        }
    }

    /// A strip that holds nothing, or no longer the material that it held, does nothing of what it is there for, which
    /// no other number shows.
    pub(super) fn tell_strips_without_material(&mut self, accepted: &AcceptedStep) {
        for (number, strip) in accepted.report.strips.iter().enumerate() {
            let on = &self.simulation.model.boundary.strips[number];
            if !on.acts() {
                continue;
            }
            let points = on.points.len();
            let name = bsmpm_scene::surfaces::name_of_strip(&self.case, number);
            let t = self.moment(accepted.t);
            if strip.held == 0 {
                self.warn_once("W0705", &name, || {
                    format!(
                    "W0705: `{name}` touches no soil at t = {t}, and carries no load. Check the position and the path \
                     of `{name}`."
                )
                });
            } else if 2 * strip.left_behind > points {
                self.warn_once("W0706", &name, || {
                    format!(
                    "W0706: `{name}` lost contact with the soil at t = {t}: most of it is more than half a cell away. \
                     The reaction is no longer valid. Use smaller cells, or reduce the uplift."
                )
                });
            } else if strip.moved_on > 0 {
                self.warn_once("W0707", &name, || {
                    format!(
                    "W0707: `{name}` returns to the soil at t = {t}, but not where it separated. The program assumes \
                     level ground between the two places. Let `{name}` return at the same place."
                )
                });
            }
        }
    }

    /// A drain or an inflow most of which has no ground near lets nothing through there.
    pub(super) fn tell_drains(&mut self, accepted: &AcceptedStep) {
        let Some(water) = &accepted.report.water else {
            return;
        };
        let t = self.moment(accepted.t);
        let model = &self.simulation.model;
        let flow = model.water.as_ref().and_then(|water| water.flow.as_ref());
        let Some(flow) = flow.filter(|flow| flow.motion == Motion::Flows) else {
            return;
        };
        let acts: Vec<bool> = flow.acting().collect();
        let wanted = self.simulation.model.surfaces().water;
        let points: Vec<usize> = wanted.iter().map(|points| points.len()).collect();
        for number in (0..points.len()).filter(|&number| acts[number] && 2 * water.held[number] < points[number]) {
            let name = bsmpm_scene::surfaces::name_of_drain(&self.case, number);
            self.warn_once("W0708", &name, || {
format!(
                "W0708: most of `{name}` has no soil nearby at t = {t}. No water flows there. If the surface heaves, \
                 extend the grid by one cell above the heaved surface."
            )
});
        }
        for number in (0..points.len()).filter(|&number| water.torn[number] > TORN) {
            let name = bsmpm_scene::surfaces::name_of_drain(&self.case, number);
            self.warn_once("W0709", &name, || {
format!(
                "W0709: `{name}` does not drain the faces of a gap of {:.1} cells that opened in the soil at t = {t}, \
                 so consolidation is too slow. Compare drainage = \"hydrostatic\" (no excess pore pressure).",
                water.torn[number]
            )
});
        }
        self.tell_drained_faces(accepted);
    }

    /// Ground that goes away from a drained face of the grid leaves its drain there.
    fn tell_drained_faces(&mut self, accepted: &AcceptedStep) {
        let Some(water) = &accepted.report.water else {
            return;
        };
        let t = self.moment(accepted.t);
        let flow = self
            .simulation
            .model
            .water
            .as_ref()
            .and_then(|water| water.flow.as_ref());
        let acts: Vec<bool> = flow.map_or_else(Vec::new, |flow| flow.faces.iter().map(|face| face.acts).collect());
        for (number, face) in water.faces.iter().enumerate().filter(|(number, _)| acts[*number]) {
            let sealed = face.held == 0;
            let off = face.off as f64 > LEFT * face.near as f64;
            if !(sealed || off) {
                continue;
            }
            let name = bsmpm_scene::surfaces::name_of_drained_face(&self.case, number);
            let share = 100.0 * face.off as f64 / face.near.max(1) as f64;
            if sealed {
                self.warn_once("W0710", &name, || {
                    format!(
                        "W0710: the soil has left the drained boundary of `{name}` at t = {t}. No water drains there. \
                         Define the drain by `surface`, or `from` and `to`, so that it moves with the soil."
                    )
                });
            } else {
                self.warn_once("W0711", &name, || {
                    format!(
                    "W0711: {share:.0} % of the soil has left the drained boundary of `{name}` at t = {t}. Too little \
                     water drains. Define the drain by `surface`, or `from` and `to`, so that it moves with the soil."
                )
                });
            }
        }
    }

    /// Boxes of histories that no point has come into.
    pub(super) fn tell_vacant(&mut self) {
        if let Some(names) = self.recorder.vacant() {
            self.warn(format!(
                "W0712: no material point entered the box of these histories: {names}. The values of these histories \
                 are 0. Move the box, which is fixed in space, to where the soil is."
            ));
        }
    }

    /// Material that leaves is reported when the first does, and counted in the manifest.
    pub(super) fn tell_outflow(&mut self, accepted: &AcceptedStep) {
        let Some(outflow) = &accepted.report.outflow else {
            return;
        };
        if self.recorder.left().points == 0 {
            let t = self.moment(accepted.t);
            let message = format!("Material leaves the grid from t = {t} on. Its amount is in run.json (`outflow`).");
            self.log.line("outflow", &message);
        }
        let Simulation { points, halo, .. } = &self.simulation;
        let lost = self.recorder.let_out(outflow, points, &**halo);
        let Outlet { points, mass } = self.recorder.left();
        if let Some(ledger) = &mut self.ledger {
            ledger.manifest().outflow = Some(ManifestOutflow {
                points,
                mass: mass * self.case.geometry.whole(),
            });
        }
        for name in lost {
            let t = self.moment(accepted.t);
            self.warn(format!(
                "W0713: the material point of history `{name}` left the grid at t = {t}. The values of the history \
                 are 0 from then on. Use a larger grid, or follow another point."
            ));
        }
    }
}
